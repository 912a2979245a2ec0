//! Trees about a machine: over a workspace, or over the centres of cubes.

use super::evaluate::Evaluator;
use super::walk::{admit_precision, discharges, Walk};
use super::{obligations, Rejected, TreeSize};
use crate::certificate::{Step, Tree, Violated};
use crate::claim::{ClaimError, MachineClaim, NoCubeClaim, OFFSET_PARTS};
use crate::enclosure::{Enclosure, Scalar};
use crate::fixed::Fixed;
use crate::model::Model;
use crate::number::Exact;
use crate::rule::{self, Failure, Obligation};
use crate::word::{Word, MAX_BITS};
use std::array::from_fn;

/// Checks that a tree proves a machine claim.
pub(crate) fn check_tree(
    claim: &MachineClaim,
    tree: &Tree,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    admit_precision(tree.precision)?;
    let model = Model::new(claim, tree.precision)?;
    let obligations = obligations(&model);
    let walk = Walk { nodes: &tree.nodes, obligations: &obligations };
    let coarse = Model::new(claim, MAX_BITS).ok().map(|model| model.map(&Word::from_fixed));
    let evaluator = Evaluator::new(model, coarse);
    walk.run(size, |cell, node, index, size| {
        let failed = |(rule, failure)| Rejected::Step { node: index, rule, failure };
        let discharged = evaluator.steps(cell, &node.by).map_err(failed)?;
        for step in &node.by {
            *size.steps.entry(step.rule().0).or_default() += 1;
        }
        Ok(discharged)
    })
}

/// No cube: a tree over the box of the centres, each of whose leaves has a step `violated`.
///
/// **Lemma.** Then no cube of that side with its centre in the box lies in the region where the
/// claim of `machine` holds, for any machine described. *Proof.* A centre `C` lies in a leaf, which
/// or an ancestor of which has a step with the offset `o`. Every `w_i` has `P` as a summand, so the
/// model with `o` added to them is that of the workspace moved by `o`. Its cell contains `C + o`, a
/// point of the cube, and by [`rule::violated`] the claim fails at each of its points for every
/// machine. ∎
pub(super) fn check_no_cube(
    claim: &NoCubeClaim,
    tree: &Tree,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    admit_precision(tree.precision)?;
    claim.validate()?;
    let model = Model::new(&claim.machine, tree.precision)?;
    let too_small = || ClaimError::Precision("side".to_owned());
    let part = claim.side.clone().over(Exact::integer(2 * OFFSET_PARTS)).ok();
    let part = part.and_then(|x| x.enclose(model.unit_exponent?, tree.precision));
    let part = part.ok_or_else(too_small)?;
    let obligations = [Obligation::SigmaMin];
    let walk = Walk { nodes: &tree.nodes, obligations: &obligations };
    walk.run(size, |cell, node, index, size| {
        let mut discharged = 0;
        for step in &node.by {
            let (rule, _) = step.rule();
            let failed = |failure| Rejected::Step { node: index, rule, failure };
            let Step::Violated(evidence) = step else {
                return Err(failed(Failure::OtherKind));
            };
            let Violated { at, violates } = evidence.as_ref();
            if !at.iter().all(|n| (-OFFSET_PARTS..=OFFSET_PARTS).contains(n)) {
                return Err(failed(Failure::NotOfTheCube));
            }
            let offset = from_fn(|k| Fixed::integer(at[k], tree.precision).mul(&part));
            let moved = Model { origin: model.leg_vectors(&offset), ..model.clone() };
            rule::violated(&moved, cell, violates).map_err(failed)?;
            discharged |= discharges(step);
            *size.steps.entry(rule).or_default() += 1;
        }
        Ok(discharged)
    })
}
