//! What is shown of a cell, in exact arithmetic.

use super::code::Kind;
use super::reader::Visited;
use super::{symmetry, Header, Rejected};
use crate::cell::Cell;
use crate::certificate::{Step, Violation, PRECISIONS};
use crate::check::{bit, discharges, obligations, Discharged, Evaluator};
use crate::enclosure::Enclosure;
use crate::model::Model;
use crate::rule::{Failure, Obligation};
use crate::word::{Word, MAX_BITS};

/// Checks the evidence of cells.
pub struct Judge {
    obligations: Vec<Obligation>,
    evaluator: Evaluator,
    symmetric: bool,
}

impl Judge {
    /// For the pavings that begin with this header, which is checked.
    pub fn new(header: &Header) -> Result<Self, Rejected> {
        let claim = header.machine_claim()?;
        if !PRECISIONS.contains(&header.precision) {
            return Err(Rejected::Precision(header.precision));
        }
        let symmetric = header.symmetry.is_some();
        if symmetric && !symmetry::is_symmetric(claim) {
            return Err(Rejected::NotSymmetric);
        }
        let fixed = Model::new(claim, header.precision)?;
        let word = (header.precision <= MAX_BITS).then(|| fixed.map(&Word::from_fixed));
        let obligations = obligations(&fixed);
        Ok(Judge { obligations, evaluator: Evaluator::new(fixed, word), symmetric })
    }

    /// What is to be shown of an inner cell.
    pub fn obligations(&self) -> &[Obligation] {
        &self.obligations
    }

    /// Whether the steps discharge their obligations on the cell; else which does not, and why.
    pub fn steps(&self, cell: &Cell, steps: &[Step]) -> Result<(), (&'static str, Failure)> {
        self.evaluator.steps(cell, steps).map(|_| ())
    }

    /// Whether the violation holds on all of the cell.
    pub fn violation(&self, cell: &Cell, violation: &Violation) -> Result<(), Failure> {
        self.evaluator.violation(cell, violation)
    }

    /// Checks a node without evaluating its evidence: an inner one has steps on its path for every
    /// obligation and for nothing else, an outer one names a bound that the claim has.
    pub fn claims(&self, visited: &Visited) -> Result<(), Rejected> {
        let Visited { inherited, item, node, .. } = visited;
        match &item.kind {
            Kind::Inner => {
                let wanted = self.obligations.iter().fold(0, |wanted, &o| wanted | bit(o));
                let idle = item.steps.iter().find(|step| discharges(step) & !wanted != 0);
                if let Some(step) = idle {
                    return Err(Rejected::Step(*node, step.rule().0, Failure::NoSuchBound));
                }
                let done = inherited | discharged(&item.steps);
                match self.obligations.iter().find(|&&o| done & bit(o) == 0) {
                    Some(&open) => Err(Rejected::Open(*node, open)),
                    None => Ok(()),
                }
            }
            Kind::Outer(violation) if !self.evaluator.has_bound(violation) => {
                Err(Rejected::Outer(*node, Failure::NoSuchBound))
            }
            _ => Ok(()),
        }
    }

    /// Checks a node: what it claims, and its evidence.
    pub fn check(&self, visited: &Visited) -> Result<(), Rejected> {
        let Visited { cell, item, node, .. } = visited;
        self.claims(visited)?;
        match &item.kind {
            Kind::Split(_) | Kind::Inner => self
                .steps(cell, &item.steps)
                .map_err(|(rule, failure)| Rejected::Step(*node, rule, failure)),
            Kind::Outer(violation) => {
                self.violation(cell, violation).map_err(|failure| Rejected::Outer(*node, failure))
            }
            Kind::Mirrored if self.symmetric && symmetry::is_mirrored(cell) => Ok(()),
            Kind::Mirrored => Err(Rejected::NotMirrored(*node)),
            Kind::Boundary => Ok(()),
        }
    }
}

/// What steps discharge, as a bit for each obligation.
pub(super) fn discharged(steps: &[Step]) -> Discharged {
    steps.iter().fold(0, |done, step| done | discharges(step))
}
