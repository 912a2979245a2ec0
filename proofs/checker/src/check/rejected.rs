//! Why certificates are rejected.

use crate::certificate::{FORMAT, MAX_BYTES, MAX_STEPS, PRECISIONS};
use crate::claim::ClaimError;
use crate::rule::{Failure, Obligation};
use crate::witness::WitnessError;
use std::fmt;

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rejected {
    /// More bytes than [`MAX_BYTES`].
    TooLarge(usize),
    /// Not a JSON text of the format's shape.
    Syntax(String),
    /// Another format or version.
    Format(String),
    /// The claim is not well formed.
    Claim(ClaimError),
    /// A tree cannot refute, and a witness cannot certify.
    VerdictMismatch,
    /// The precision is not admissible.
    Precision(u32),
    /// The tree ends where a node is needed.
    MissingNode,
    /// Nodes are left over.
    TrailingNodes(usize),
    /// A node has too many steps.
    TooManySteps(usize),
    /// A cell is split beyond the deepest level.
    TooDeep(usize),
    /// A node is split on an axis that its tree does not have.
    NoSuchAxis(usize),
    /// A step does not discharge its obligation.
    Step {
        /// The node, counted from zero in preorder.
        node: usize,
        /// The rule's name.
        rule: &'static str,
        /// Why.
        failure: Failure,
    },
    /// A leaf leaves an obligation open.
    Open {
        /// The node, counted from zero in preorder.
        node: usize,
        /// What is not discharged on its path.
        obligation: Obligation,
    },
    /// The witness does not refute the claim.
    Witness(WitnessError),
    /// The kernel does not accept it.
    Kernel(orthocert_kernel::check::Rejected),
}

impl From<ClaimError> for Rejected {
    fn from(error: ClaimError) -> Self {
        Rejected::Claim(error)
    }
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::TooLarge(bytes) => {
                write!(f, "the file has {bytes} bytes; at most {MAX_BYTES} are accepted")
            }
            Rejected::Syntax(message) => write!(f, "not a certificate: {message}"),
            Rejected::Format(found) => {
                write!(f, "format {found:?} is not known; this checker reads {FORMAT:?}")
            }
            Rejected::Claim(error) => write!(f, "the claim is not well formed: {error}"),
            Rejected::Kernel(reason) => write!(f, "{reason}"),
            Rejected::VerdictMismatch => write!(
                f,
                "the verdict does not go with the proof: a tree certifies, a witness refutes"
            ),
            Rejected::Precision(bits) => {
                write!(f, "precision {bits} is not within {PRECISIONS:?}")
            }
            Rejected::MissingNode => write!(f, "the tree ends where a node is needed"),
            Rejected::TrailingNodes(count) => {
                write!(f, "{count} nodes are left over after the tree")
            }
            Rejected::TooManySteps(node) => {
                write!(f, "node {node} has more than {MAX_STEPS} steps")
            }
            Rejected::TooDeep(node) => write!(f, "node {node} is split too often"),
            Rejected::NoSuchAxis(node) => {
                write!(f, "node {node} is split on an axis that its tree does not have")
            }
            Rejected::Step { node, rule, failure } => {
                write!(f, "node {node}: rule \"{rule}\" does not apply: {failure}")
            }
            Rejected::Open { node, obligation } => {
                write!(f, "node {node} is a leaf, but {obligation} is not discharged on its path")
            }
            Rejected::Witness(error) => write!(f, "the witness does not refute: {error}"),
        }
    }
}

impl std::error::Error for Rejected {}
