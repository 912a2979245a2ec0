//! Why a proof is not accepted.

use crate::document::Unreadable;
use crate::input::ClaimError;
use crate::witness::WitnessError;
use thiserror::Error;

/// Why a certificate is not accepted. Nodes and cells are counted from zero.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Rejected {
    /// There is no certificate.
    #[error("not a certificate: {0}")]
    Unreadable(#[from] Unreadable),
    /// The claim is not well formed.
    #[error("the claim is not well formed: {0}")]
    Claim(#[from] ClaimError),
    /// The verdict and the proof do not go together.
    #[error("verdict and proof do not go together")]
    Verdict,
    /// The precision is not admissible.
    #[error("a precision of {0} bits is not admissible")]
    Precision(u32),
    /// The tree has too many nodes, too few, or cannot be split as it says.
    #[error("node {0}: the tree is not complete there")]
    Shape(usize),
    /// The tree has more nodes, or asks for more work, than is admissible.
    #[error("the proof is longer than is admissible")]
    Work,
    /// A step does not show what it says.
    #[error("node {0}: obligation {1} is not certainly met on the cell")]
    Step(usize, usize),
    /// An obligation that is discharged already, or that there is not.
    #[error("node {0}: obligation {1} is not open")]
    Repeated(usize, usize),
    /// A leaf on which an obligation is not discharged.
    #[error("node {0}: obligation {1} is not discharged")]
    Open(usize, usize),
    /// A leaf on which the claim does not certainly fail as it says.
    #[error("node {0}: it does not certainly fail throughout")]
    Holds(usize),
    /// The shares of an atlas are not those of its cells.
    #[error("the cells do not have the shares that are claimed")]
    Shares,
    /// Of an atlas, a cell, and why it is not as it says.
    #[error("cell {0}: {1}")]
    Cell(usize, Box<Rejected>),
    /// The witness shows nothing.
    #[error("the witness shows nothing: {0}")]
    Witness(#[from] WitnessError),
}
