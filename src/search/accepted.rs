//! Accepted certificates, and the size of their proofs.
//!
//! That they are accepted is what [`orthocert_checker`] says; sizes are for reports.

use orthocert_checker::certificate::{Certificate, Node, Proof, Tree, Verdict};
use orthocert_checker::Rejected;
use orthocert_kernel::certificate::AtlasCell;
use std::collections::BTreeMap;

/// What an accepted certificate establishes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// The claim is a theorem (`Certified`), or it is false (`Refuted`).
    pub verdict: Verdict,
    /// The size of the proof's trees; all zero for a witness.
    pub size: TreeSize,
}

/// The size and shape of trees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeSize {
    /// Nodes, split or not.
    pub nodes: usize,
    /// Nodes that are not split: the boxes that cover the workspace.
    pub leaves: usize,
    /// Most splits on one path.
    pub depth: usize,
    /// Uses of each rule.
    pub steps: BTreeMap<&'static str, usize>,
}

impl TreeSize {
    /// Adds those of another tree.
    pub fn add(&mut self, other: TreeSize) {
        self.nodes += other.nodes;
        self.leaves += other.leaves;
        self.depth = self.depth.max(other.depth);
        for (rule, uses) in other.steps {
            *self.steps.entry(rule).or_default() += uses;
        }
    }
}

/// Checks a certificate, and measures its proof.
///
/// # Errors
/// If the checker does not accept it.
pub fn check(certificate: &Certificate) -> Result<Accepted, Rejected> {
    let verdict = orthocert_checker::check(certificate)?;
    Ok(Accepted { verdict, size: size_of_all(&certificate.proof) })
}

/// The size and shape of all trees of a proof.
pub fn size_of_all(proof: &Proof) -> TreeSize {
    let mut size = TreeSize::default();
    match proof {
        Proof::Tree(tree) => size = size_of(tree),
        Proof::Witness(_) => {}
        Proof::Atlas(cells) => {
            for cell in cells {
                if let AtlasCell::Certified(tree) = cell {
                    size.add(size_of(tree));
                }
            }
        }
    }
    size
}

/// The nodes of each tree of a proof.
pub fn trees(mut nodes: &[Node]) -> Vec<&[Node]> {
    let mut trees = Vec::new();
    while !nodes.is_empty() {
        let mut open = 1;
        let last = nodes.iter().position(|node| {
            open = if node.split.is_some() { open + 1 } else { open - 1 };
            open == 0
        });
        let (tree, rest) = nodes.split_at(last.map_or(nodes.len(), |last| last + 1));
        trees.push(tree);
        nodes = rest;
    }
    trees
}

/// The size and shape of trees together.
pub fn size_of(tree: &Tree) -> TreeSize {
    let mut size = TreeSize { nodes: tree.nodes.len(), ..TreeSize::default() };
    let mut waiting = vec![0];
    for node in &tree.nodes {
        let depth = waiting.pop().unwrap_or(0);
        size.depth = size.depth.max(depth);
        match node.split {
            Some(_) => waiting.extend([depth + 1, depth + 1]),
            None => size.leaves += 1,
        }
        for step in &node.by {
            *size.steps.entry(step.1.name()).or_default() += 1;
        }
        if node.fails.is_some() {
            *size.steps.entry("fails").or_default() += 1;
        }
    }
    size
}
