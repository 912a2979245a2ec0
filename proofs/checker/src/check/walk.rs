//! The walk over a tree, and what every tree is held to.

use super::{Rejected, TreeSize};
use crate::cell::Cell;
use crate::certificate::{Node, Step, MAX_STEPS, PRECISIONS};
use crate::rule::{Failure, Obligation};

/// A set of obligations, as a bit for each.
pub(crate) type Discharged = u32;
const _: () = assert!(Obligation::ALL.len() <= Discharged::BITS as usize);

pub(crate) fn bit(obligation: Obligation) -> Discharged {
    1 << obligation as u8
}

/// What a step discharges.
pub(crate) fn discharges(step: &Step) -> Discharged {
    match step.rule().1 {
        Some(obligation) => bit(obligation),
        None => Discharged::MAX,
    }
}

impl Step {
    /// The rule's name and what it discharges; `None` for everything.
    pub fn rule(&self) -> (&'static str, Option<Obligation>) {
        let (name, obligation) = match self {
            Step::Lower(_) => ("lower", Obligation::SigmaMin),
            Step::Entrywise(_) => ("entrywise", Obligation::SigmaMin),
            Step::Corner(_) => ("corner", Obligation::SigmaMin),
            Step::Upper => ("upper", Obligation::SigmaMax),
            Step::Cube => ("cube", Obligation::SigmaMax),
            Step::Range => ("range", Obligation::JointRange),
            Step::Conditioning(_) => ("conditioning", Obligation::Conditioning),
            Step::SerialMargin => ("serial_margin", Obligation::SerialMargin),
            Step::ParallelMargin => ("parallel_margin", Obligation::ParallelMargin),
            Step::LegAngle => ("leg_angle", Obligation::LegAngle),
            Step::Speed => ("speed", Obligation::JointSpeed),
            Step::Outside => return ("outside", None),
        };
        (name, Some(obligation))
    }
}

pub(super) fn admit_precision(bits: u32) -> Result<(), Rejected> {
    if PRECISIONS.contains(&bits) {
        Ok(())
    } else {
        Err(Rejected::Precision(bits))
    }
}

/// A tree to be walked: its nodes, and what every leaf has to end with.
pub(super) struct Walk<'a> {
    pub nodes: &'a [Node],
    pub obligations: &'a [Obligation],
}

impl Walk<'_> {
    /// Walks the tree in preorder with a stack of cells that wait for their node, each with what
    /// its ancestors have discharged: what holds on a cell holds on its halves. `step` checks one
    /// node's steps on its cell and returns what they discharge.
    ///
    /// **Lemma.** If the walk ends without complaint, every obligation holds at every point of the
    /// root. *Proof.* By induction the leaves below a cell cover it, as its halves do; on each leaf
    /// every obligation is discharged on it or on a cell that contains it. ∎
    pub fn run(
        &self,
        size: &mut TreeSize,
        mut steps: impl FnMut(&Cell, &Node, usize, &mut TreeSize) -> Result<Discharged, Rejected>,
    ) -> Result<(), Rejected> {
        let mut waiting: Vec<(Cell, Discharged, usize)> = vec![(Cell::ROOT, 0, 0)];
        for (index, node) in self.nodes.iter().enumerate() {
            let Some((cell, inherited, depth)) = waiting.pop() else {
                return Err(Rejected::TrailingNodes(self.nodes.len() - index));
            };
            if node.by.len() > MAX_STEPS {
                return Err(Rejected::TooManySteps(index));
            }
            refuse_repetition(inherited, node, index)?;
            let discharged = inherited | steps(&cell, node, index, size)?;
            size.nodes += 1;
            size.depth = size.depth.max(depth);
            if let Some(axis) = node.split {
                let (lower, upper) = cell.halves(axis).ok_or(Rejected::TooDeep(index))?;
                waiting.push((upper, discharged, depth + 1));
                waiting.push((lower, discharged, depth + 1));
                continue;
            }
            size.leaves += 1;
            if let Some(&obligation) = self.obligations.iter().find(|&&o| discharged & bit(o) == 0)
            {
                return Err(Rejected::Open { node: index, obligation });
            }
        }
        if waiting.is_empty() {
            Ok(())
        } else {
            Err(Rejected::MissingNode)
        }
    }
}

/// Every step discharges something that its path has not discharged: that bounds the work for a tree by its
/// leaves, whatever the file.
fn refuse_repetition(mut done: Discharged, node: &Node, index: usize) -> Result<(), Rejected> {
    for step in &node.by {
        let new = discharges(step) & !done;
        if new == 0 {
            let (rule, _) = step.rule();
            return Err(Rejected::Step { node: index, rule, failure: Failure::Repeated });
        }
        done |= new;
    }
    Ok(())
}
