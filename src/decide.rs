//! Decides a claim about a machine: by the rules for three translating legs, or by the kernel.

use crate::report::Report;
use crate::search::{Budget, Control, Stop};
use crate::{solver, verify};
use orthocert_checker::certificate::Certificate;
use orthocert_checker::claim::{self, Claim};
use orthocert_checker::{Accepted, Rejected};
use orthocert_kernel::input;
use std::time::Duration;

/// What was found of a claim.
#[derive(Clone, Debug)]
pub enum Found {
    /// Of a claim of the rules.
    Machine(verify::Verification),
    /// Of a claim of the kernel.
    Kernel(solver::Verification),
}

/// Why a claim is not decided.
#[derive(Debug, thiserror::Error)]
pub enum NotDecided {
    /// A claim of the rules is not well formed.
    #[error(transparent)]
    Machine(#[from] claim::ClaimError),
    /// A claim of the kernel is not well formed.
    #[error("{0}")]
    Kernel(input::ClaimError),
    /// It is about something else.
    #[error("a design is about a machine")]
    Other,
}

impl From<input::ClaimError> for NotDecided {
    fn from(error: input::ClaimError) -> Self {
        NotDecided::Kernel(error)
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
) -> Result<Found, NotDecided> {
    match claim {
        Claim::Machine(claim) => Ok(Found::Machine(verify::verify(claim, budget, control)?)),
        Claim::Kernel(claim) => Ok(Found::Kernel(solver::verify(claim, budget, control)?)),
        Claim::Postulate(_) | Claim::NoCube(_) | Claim::Atlas(_) => Err(NotDecided::Other),
    }
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
) -> Result<Found, NotDecided> {
    let claim = certificate.claim.clone();
    let certificate = Box::new(certificate);
    match &claim {
        Claim::Machine(claim) => {
            let worst = if sampled { verify::sampled(claim)? } else { Vec::new() };
            let answer = verify::Answer::Decided { certificate, accepted };
            Ok(Found::Machine(verify::Verification { answer, worst, boxes: 0 }))
        }
        Claim::Kernel(claim) => {
            let worst = if sampled { solver::sampled(claim)? } else { Vec::new() };
            let answer = solver::Answer::Decided { certificate, accepted };
            Ok(Found::Kernel(solver::Verification { answer, worst, boxes: 0 }))
        }
        Claim::Postulate(_) | Claim::NoCube(_) | Claim::Atlas(_) => Err(NotDecided::Other),
    }
}

impl Found {
    /// The accepted certificate.
    pub fn decided(&self) -> Option<(&Certificate, &Accepted)> {
        match self {
            Found::Machine(verify::Verification {
                answer: verify::Answer::Decided { certificate, accepted },
                ..
            })
            | Found::Kernel(solver::Verification {
                answer: solver::Answer::Decided { certificate, accepted },
                ..
            }) => Some((certificate, accepted)),
            Found::Machine(_) | Found::Kernel(_) => None,
        }
    }

    /// Whether it was cancelled.
    pub fn is_cancelled(&self) -> bool {
        match self {
            Found::Machine(found) => matches!(found.answer, verify::Answer::Cancelled),
            Found::Kernel(found) => matches!(found.answer, solver::Answer::Cancelled),
        }
    }

    /// Makes it undecided, for this reason.
    pub fn object(&mut self, objection: Rejected) {
        let (stop, objection) = (Stop::Exhausted, Some(objection));
        match self {
            Found::Machine(found) => {
                let undecided = verify::Undecided { open: Vec::new(), stop, objection };
                found.answer = verify::Answer::Undecided(undecided);
            }
            Found::Kernel(found) => {
                let undecided = solver::Undecided { open: Vec::new(), stop, objection };
                found.answer = solver::Answer::Undecided(undecided);
            }
        }
    }

    /// The facts about it; `None` if it was cancelled, or if the claim's numbers exceed what can be
    /// shown.
    pub fn report(&self, claim: &Claim, elapsed: Duration) -> Option<Report> {
        match (self, claim) {
            (Found::Machine(found), Claim::Machine(claim)) => Report::new(claim, found, elapsed),
            (Found::Kernel(found), Claim::Kernel(claim)) => {
                Report::of_kernel(claim, found, elapsed)
            }
            _ => None,
        }
    }
}
