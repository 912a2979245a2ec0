//! Why a proof is not accepted.

use crate::input::ClaimError;
use crate::witness::WitnessError;
use std::fmt;

/// Why a certificate is not accepted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rejected {
    /// The claim is not well formed.
    Claim(ClaimError),
    /// The verdict and the proof do not go together.
    Verdict,
    /// The precision is not admissible.
    Precision(u32),
    /// The tree has too many nodes, too few, or cannot be split as it says.
    Shape(usize),
    /// The tree has more nodes, or asks for more work, than is admissible.
    Work,
    /// A step does not show what it says.
    Step {
        /// The node, counted from zero.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// An obligation that is discharged already, or that there is not.
    Repeated {
        /// The node.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// A leaf on which an obligation is not discharged.
    Open {
        /// The node.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// A leaf on which the claim does not certainly fail as it says.
    Holds(usize),
    /// The shares of an atlas are not those of its cells.
    Shares,
    /// Of an atlas, a cell, counted from zero, and why it is not as it says.
    Cell(usize, Box<Rejected>),
    /// The witness shows nothing.
    Witness(WitnessError),
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::Claim(e) => write!(f, "the claim is not well formed: {e}"),
            Rejected::Verdict => write!(f, "verdict and proof do not go together"),
            Rejected::Precision(bits) => write!(f, "a precision of {bits} bits is not admissible"),
            Rejected::Shape(node) => write!(f, "node {node}: the tree is not complete there"),
            Rejected::Work => write!(f, "the proof is longer than is admissible"),
            Rejected::Step { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not certainly met on the cell")
            }
            Rejected::Repeated { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not open")
            }
            Rejected::Open { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not discharged")
            }
            Rejected::Holds(node) => {
                write!(f, "node {node}: it does not certainly fail throughout")
            }
            Rejected::Shares => write!(f, "the cells do not have the shares that are claimed"),
            Rejected::Cell(cell, why) => write!(f, "cell {cell}: {why}"),
            Rejected::Witness(e) => write!(f, "the witness shows nothing: {e}"),
        }
    }
}

impl std::error::Error for Rejected {}
