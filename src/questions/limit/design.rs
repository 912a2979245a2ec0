//! The family of a design file and one of its numbers.

use super::Family;
use crate::design::{Design, Variable};
use crate::questions::frontier::NoAnswer;
use crate::search::solver;
use crate::search::{Budget, Control};
use num_rational::BigRational;
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::MachineClaim;
use std::time::Instant;

/// A design file, one number of which is varied.
pub struct DesignFamily<'a, 'c> {
    /// The number.
    pub variable: &'a Variable<'a>,
    /// For each value.
    pub max_boxes: usize,
    /// Their progress, and how they are cancelled.
    pub control: &'a mut Control<'c>,
}

impl Family for DesignFamily<'_, '_> {
    type Claim = MachineClaim;
    type Proof = Box<Certificate>;

    fn claim(&self, value: &BigRational) -> Result<MachineClaim, String> {
        let design = Design::parse(&self.variable.with(value), "design");
        design.map(|design| design.claim).map_err(|error| {
            format!("{}: found {}; accepted: {}", error.key(), error.found(), error.accepted())
        })
    }

    fn decide(
        &mut self,
        claim: &MachineClaim,
        part: [f64; 2],
        deadline: Option<Instant>,
    ) -> Result<Option<(Verdict, Box<Certificate>)>, NoAnswer> {
        let budget = Budget { max_boxes: self.max_boxes, deadline };
        let found = self.control.part(part, |control| solver::verify(claim, budget, control));
        let certificate = match found.map_err(|error| NoAnswer::Claim(error.to_string()))?.answer {
            solver::Answer::Decided { certificate, .. } => Some(certificate),
            solver::Answer::Undecided { .. } => None,
            solver::Answer::Cancelled => return Err(NoAnswer::Cancelled),
        };
        Ok(certificate.map(|certificate| (certificate.verdict, certificate)))
    }
}
