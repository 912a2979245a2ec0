//! Reading and checking a certificate: the only way to an accepted verdict.

use crate::shown::Shown;
use orthocert_kernel::atlas::{self, AtlasCell};
use orthocert_kernel::certificate::{
    Certificate, Claim, Node, Proof, Tree, Unreadable, Verdict, FORMAT, MOST_BYTES,
};
use orthocert_kernel::check as kernel;
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroUsize;

/// Most characters of a message that quotes the file.
const MAX_MESSAGE: usize = 300;

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

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rejected {
    /// More bytes than [`MOST_BYTES`].
    TooLarge(usize),
    /// Not a text of the format.
    Syntax(String),
    /// Another format or version.
    Format(String),
    /// The claim is not well formed, or the proof does not show it.
    Kernel(kernel::Rejected),
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::TooLarge(bytes) => {
                write!(f, "the file has {bytes} bytes; at most {MOST_BYTES} are accepted")
            }
            Rejected::Syntax(message) => write!(f, "not a certificate: {message}"),
            Rejected::Format(found) => {
                write!(f, "format {found:?} is not known; this checker reads {FORMAT:?}")
            }
            Rejected::Kernel(reason) => write!(f, "{reason}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// Reads a certificate.
///
/// # Errors
/// If it is none, or too large.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    if bytes.len() > MOST_BYTES {
        return Err(Rejected::TooLarge(bytes.len()));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| syntax(&error))?;
    Certificate::read(text).map_err(|unreadable| match unreadable {
        Unreadable::TooLong(bytes) => Rejected::TooLarge(bytes),
        Unreadable::Format(format) => Rejected::Format(quoted(&format)),
        Unreadable::Malformed(message) => syntax(&message),
        Unreadable::NotCanonical { at } => {
            syntax(&format_args!("the same certificate is written otherwise, from byte {at} on"))
        }
    })
}

fn syntax(message: &dyn fmt::Display) -> Rejected {
    Rejected::Syntax(quoted(&message.to_string()))
}

/// The beginning of a text that may quote the file, fit for a terminal.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(MAX_MESSAGE).collect();
    Shown(start).to_string().chars().take(MAX_MESSAGE).collect()
}

/// Checks a certificate: recomputes everything that its proof uses from its claim.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<Accepted, Rejected> {
    let size = check_part(certificate, 0, NonZeroUsize::MIN)?;
    Ok(Accepted { verdict: certificate.verdict, size })
}

/// Checks all of a certificate but, of an atlas, the cells whose number is not `part` modulo `of`;
/// returns the size of what was checked. Each cell is of exactly one part: a certificate of which
/// the parts `0..of` are admitted, say by as many threads, is accepted by [`check`](fn@check).
///
/// # Errors
/// As [`check`](fn@check).
pub fn check_part(
    certificate: &Certificate,
    part: usize,
    of: NonZeroUsize,
) -> Result<TreeSize, Rejected> {
    let is_wanted = |number: usize| number % of == part;
    match (&certificate.claim, certificate.verdict, &certificate.proof) {
        (Claim::Atlas(claim), Verdict::Certified, Proof::Atlas(cells)) => {
            atlas::check_part(claim, cells, is_wanted)
        }
        _ => kernel::check(certificate),
    }
    .map_err(Rejected::Kernel)?;
    let mut size = TreeSize::default();
    match &certificate.proof {
        Proof::Tree(tree) => size = size_of(tree),
        Proof::Witness(_) => {}
        Proof::Atlas(cells) => {
            for (_, cell) in cells.iter().enumerate().filter(|(number, _)| is_wanted(*number)) {
                if let AtlasCell::Certified(tree) = cell {
                    size.add(size_of(tree));
                }
            }
        }
    }
    Ok(size)
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
