//! What a decision about a machine amounts to.

use crate::report::Report;
use crate::search::Stop;
use crate::solver::{self, Answer, Undecided, Verification};
use orthocert_checker::certificate::Certificate;
use orthocert_checker::{Accepted, Rejected};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use std::time::Duration;

/// What an accepted certificate of a claim amounts to; with the worst values that sampling finds, where
/// they are asked for.
///
/// # Errors
/// If the claim is not well formed.
pub fn recalled(
    claim: &MachineClaim,
    certificate: Certificate,
    accepted: Accepted,
    sampled: bool,
) -> Result<Verification, ClaimError> {
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
    pub fn report(&self, claim: &MachineClaim, elapsed: Duration) -> Option<Report> {
        Report::new(claim, self, elapsed)
    }
}
