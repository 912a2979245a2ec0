//! No cube of a side fits: a tree over the centres.

use super::violated::Violations;
use crate::frontier::NoAnswer;
use crate::search::{by_weight, search, Budget, Control, Problem, Stop, Trial};
use crate::verify::{accepted, Answer};
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{Certificate, Proof, Step, Tree, Violated};
use orthocert_checker::claim::{Claim, MachineClaim, NoCubeClaim, Workspace, OFFSET_PARTS};
use orthocert_checker::number::Exact;
use orthocert_checker::rule::{Failure, Obligation};

/// The search for a violated point of the cube in every cell of centres.
struct Centres {
    /// Points of the cube, and what decides the claim moved there: corners first, then the middles
    /// of edges and faces, then the centre.
    points: Vec<([i64; 3], Violations)>,
    /// Edges of the box of centres.
    width: [f64; 3],
}

impl Problem for Centres {
    fn obligations(&self) -> Vec<Obligation> {
        vec![Obligation::SigmaMin]
    }

    fn try_box(&self, cell: &Cell, _open: &[Obligation]) -> Trial {
        let weights =
            std::array::from_fn(|k| self.width[k] * (-f64::from(cell.edges[k].level)).exp2());
        let axes = by_weight(Axis::ALL, weights);
        let found = self
            .points
            .iter()
            .find_map(|(at, decider)| decider.violated(cell).map(|violates| (*at, violates)));
        let (steps, failures) = match found {
            Some((at, violates)) => {
                (vec![Step::Violated(Box::new(Violated { at, violates }))], Vec::new())
            }
            None => (Vec::new(), vec![(Obligation::SigmaMin, Failure::NotViolated)]),
        };
        Trial { steps, failures, axes, hopeless: false }
    }
}

/// A certificate that no cube of this side fits with its centre in the workspace of `claim`, a box;
/// `None` where there is none within the budget.
///
/// # Errors
/// [`NoAnswer`].
pub fn exclude(
    claim: &MachineClaim,
    side: &Exact,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Box<Certificate>>, NoAnswer> {
    let claim = NoCubeClaim { machine: claim.clone(), side: side.clone() };
    claim.validate()?;
    let problem = centres(&claim)?;
    let found = search(&problem, budget, control);
    if found.stop == Stop::Cancelled {
        return Err(NoAnswer::Cancelled);
    }
    if found.stop != Stop::Exhausted || !found.open.is_empty() {
        return Ok(None);
    }
    let answer = accepted(Claim::NoCube(claim), |precision| {
        Proof::Tree(Tree { precision, nodes: found.nodes.clone() })
    });
    match answer {
        Answer::Decided { certificate, .. } => Ok(Some(certificate)),
        _ => Ok(None),
    }
}

fn centres(claim: &NoCubeClaim) -> Result<Centres, NoAnswer> {
    let refused = |reason: String| NoAnswer::Claim(reason);
    let Workspace::Box { min, max } = &claim.machine.workspace else {
        return Err(refused("the workspace is not a box".to_owned()));
    };
    let mut offsets: Vec<[i64; 3]> = Vec::new();
    for n in 0..27 {
        offsets.push([n % 3, n / 3 % 3, n / 9].map(|i| (i - 1) * OFFSET_PARTS));
    }
    offsets.sort_by_key(|offset| offset.iter().filter(|n| **n == 0).count());
    let mut points = Vec::with_capacity(offsets.len());
    for offset in offsets {
        let too_large = || refused("its numbers exceed what can be reported".to_owned());
        let moved = moved(claim, &offset).ok_or_else(too_large)?;
        let decider = Violations::new(&moved).map_err(|e| refused(e.to_string()))?;
        points.push((offset, decider));
    }
    let edge = |k: usize| {
        let width = max[k].clone().minus(min[k].clone()).ok()?;
        crate::decimal::approximate(&width)
    };
    let width = [edge(0), edge(1), edge(2)].map(|edge| edge.unwrap_or(1.0));
    Ok(Centres { points, width })
}

/// The claim about the points `C + offset side / (2 OFFSET_PARTS)`, `C` in the box of centres.
fn moved(claim: &NoCubeClaim, offset: &[i64; 3]) -> Option<MachineClaim> {
    let Workspace::Box { mut min, mut max } = claim.machine.workspace.clone() else {
        return None;
    };
    let part = claim.side.clone().over(Exact::integer(2 * OFFSET_PARTS)).ok()?;
    for (k, &n) in offset.iter().enumerate() {
        let by = part.clone().times(Exact::integer(n)).ok()?;
        min[k] = min[k].clone().plus(by.clone()).ok()?;
        max[k] = max[k].clone().plus(by).ok()?;
    }
    Some(MachineClaim { workspace: Workspace::Box { min, max }, ..claim.machine.clone() })
}
