//! Trees about a machine over its workspace.

use super::evaluate::Evaluator;
use super::walk::{admit_precision, Walk};
use super::{obligations, Rejected, TreeSize};
use crate::certificate::Tree;
use crate::claim::MachineClaim;
use crate::enclosure::Enclosure;
use crate::model::Model;
use crate::word::{Word, MAX_BITS};

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
