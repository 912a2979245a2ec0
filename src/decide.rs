//! Decides a claim about a machine.

use crate::report::Report;
use crate::search::{Budget, Control, Stop};
use crate::solver::{self, Answer, Undecided, Verification};
use orthocert_checker::certificate::Certificate;
use orthocert_checker::claim::Claim;
use orthocert_checker::{Accepted, Rejected};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use std::time::Duration;

/// Why a claim is not decided.
#[derive(Debug, thiserror::Error)]
pub enum NotDecided {
    /// It is not well formed.
    #[error("{0}")]
    Claim(ClaimError),
    /// It is about something else.
    #[error("a design is about a machine")]
    Other,
}

impl From<ClaimError> for NotDecided {
    fn from(error: ClaimError) -> Self {
        NotDecided::Claim(error)
    }
}

fn of_machine(claim: &Claim) -> Result<&MachineClaim, NotDecided> {
    match claim {
        Claim::Kernel(claim) => Ok(claim),
        _ => Err(NotDecided::Other),
    }
}

/// Decides a claim within a budget.
///
/// # Errors
/// If the claim is not well formed, or not about a machine.
pub fn decide(
    claim: &Claim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Verification, NotDecided> {
    Ok(solver::verify(of_machine(claim)?, budget, control)?)
}

/// What an accepted certificate of a claim amounts to; with the worst values that sampling finds, where
/// they are asked for.
///
/// # Errors
/// If the claim is not well formed, or not about a machine.
pub fn recalled(
    certificate: Certificate,
    accepted: Accepted,
    sampled: bool,
) -> Result<Verification, NotDecided> {
    let claim = of_machine(&certificate.claim)?;
    let worst = if sampled { solver::sampled(claim)? } else { Vec::new() };
    let answer = Answer::Decided { certificate: Box::new(certificate), accepted };
    Ok(Verification { answer, worst, boxes: 0 })
}

impl Verification {
    /// The accepted certificate.
    pub fn decided(&self) -> Option<(&Certificate, &Accepted)> {
        match &self.answer {
            Answer::Decided { certificate, accepted } => Some((certificate, accepted)),
            Answer::Undecided(_) | Answer::Cancelled => None,
        }
    }

    /// Whether it was cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self.answer, Answer::Cancelled)
    }

    /// Makes it undecided, for this reason.
    pub fn object(&mut self, objection: Rejected) {
        let (stop, objection) = (Stop::Exhausted, Some(objection));
        self.answer = Answer::Undecided(Undecided { open: Vec::new(), stop, objection });
    }

    /// The facts about it; `None` if it was cancelled, or if the claim's numbers exceed what can be
    /// shown.
    pub fn report(&self, claim: &Claim, elapsed: Duration) -> Option<Report> {
        Report::new(of_machine(claim).ok()?, self, elapsed)
    }
}
