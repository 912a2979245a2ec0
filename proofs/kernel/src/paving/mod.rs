//! Pavings: a search box cut into cells, each shown to be within or outside the region where a
//! claim holds, or left undecided. `FORMAT.md` is normative.
//!
//! | module     | holds                                                                 |
//! |------------|-----------------------------------------------------------------------|
//! | `cell`     | cells, as exact parts of the box                                      |
//! | `code`     | the bytes of a node                                                   |
//! | `cut`      | cells that planes cut, and the shares of both sides                   |
//! | `judge`    | what is shown of a cell, in exact arithmetic                          |
//! | `reader`   | the nodes of a paving, one by one, and their cells                    |
//! | `symmetry` | machines that look the same from permuted axes                        |
//!
//! A claim about a box is true or false of each point of it: the *region* is the set of the points
//! at which it is true for every machine of the claim. A paving is a bisection tree of the
//! box; nothing of it is kept in memory but the path to the node that is read.
//!
//! A paving may be of some of the coordinates, for all values of the others: see [`Header::order`].

mod cell;
pub(crate) mod code;
mod cut;
mod judge;
mod reader;
mod symmetry;

use crate::certificate::{Provenance, PRECISIONS};
use crate::claim::{MachineClaim, Mechanism, Orientation, Workspace};
use crate::document::Unreadable;
use crate::input::ClaimError;
use num_bigint::BigInt;
use num_rational::BigRational;
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;
use std::io::{self, BufRead};
use thiserror::Error;

pub use cell::{Axis, Cell, Edge, MAX_AXIS_LEVEL, MOST_OTHERS};
pub use code::{Item, Kind, Outer, Step};
pub use cut::Cut;
pub use judge::{bit, discharged, Judge, Subject, AT_BITS};
pub use reader::{header, Reader, Root, Visited};
pub use symmetry::{is_mirrored, is_symmetric, six_ordered};

/// The format that this version reads and writes.
pub const FORMAT: &str = "orthocert-paving/3";
/// Most bytes of the header's and of the last line.
pub const MAX_LINE: usize = 1 << 20;
/// Shares of the box's volume are multiples of `2^-SHARE_BITS`.
pub const SHARE_BITS: u32 = 120;
/// Most obligations of a claim.
pub const MOST_OBLIGATIONS: usize = 128;

/// The first line of a paving.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// [`FORMAT`].
    pub format: String,
    /// The claim whose region is paved: about a box.
    pub claim: About,
    /// The coordinates that are paved, for all values of the others; none if there are no others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinates: Option<Vec<String>>,
    /// Fractional bits of the arithmetic.
    pub precision: u32,
    /// Most splits on a path.
    pub depth: u32,
    /// Present if cells are left out by symmetry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<Symmetry>,
    /// Who wrote the paving. Never trusted, never needed.
    pub provenance: Provenance,
}

/// A claim about a machine, as it is in certificates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// The claim.
    pub machine: MachineClaim,
}

/// A symmetry of the claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Symmetry {
    /// Every permutation of the coordinates, see [`is_symmetric`].
    Permutations,
}

/// The names of a claim's coordinates: positions, then orientations, these as angles in degrees; none of
/// one that cannot be paved for all values of the others.
///
/// **Lemma (product).** The workspace is the product of the ranges of the coordinates with names and a
/// set, which is not empty, of values of all others. *Proof.* Of a box and of ranges of angles that is
/// so. A cylinder binds x and y alone, and has its axis. An angle, or tilt and torsion, bind the
/// coordinates of orientation alone, and 0 is among these. ∎
pub fn names(claim: &MachineClaim) -> Vec<Option<String>> {
    let named = |names: &str| -> Vec<Option<String>> {
        names.split(' ').map(|name| Some(name.to_owned()).filter(|name| name != "-")).collect()
    };
    let mut all = match (&claim.mechanism, &claim.workspace) {
        (Mechanism::Formulas(formulas), _) => {
            formulas.coordinates.iter().cloned().map(Some).collect()
        }
        (_, Workspace::Cube { .. }) => named("- - -"),
        (_, Workspace::Cylinder { .. }) => named("- - z"),
        (Mechanism::Planar(_), _) => named("x y"),
        (Mechanism::Spherical(_), _) => Vec::new(),
        _ => named("x y z"),
    };
    all.extend(match &claim.orientation {
        None => Vec::new(),
        Some(Orientation::Range(_)) => named("angle"),
        Some(Orientation::RollPitchYaw { .. }) => named("roll pitch yaw"),
        Some(Orientation::Angle(_) | Orientation::Tilt { .. }) => named("- - -"),
    });
    all
}

impl Header {
    /// The coordinates that are paved, and the others, by their places among the claim's.
    ///
    /// **Lemma (others).** Let the *region* be the set of the values of the paved coordinates at which
    /// the claim is true for every machine and all values of the others that are in the workspace with
    /// them. A cell is in it if the claim holds at all points of its parts that are in the workspace; it
    /// does not meet it if at one value of the others in the workspace, or at all, the claim fails on
    /// all of the cell. *Proof.* The parts of a cell cover its product with the box of the others. By
    /// the lemma *product*, the values of the others are the same for all of the cell. ∎
    ///
    /// # Errors
    /// If they are none.
    pub fn order(&self) -> Result<[Vec<usize>; 2], Rejected> {
        let names = names(&self.claim.machine);
        let place = |own: &String| names.iter().position(|name| name.as_ref() == Some(own));
        let paved: Option<Vec<usize>> = match &self.coordinates {
            Some(own) => own.iter().map(place).collect(),
            None if self.claim.machine.orientation.is_none() => {
                names.iter().flatten().map(place).collect()
            }
            None => None,
        };
        let paved = paved.filter(|paved| (1..=3).contains(&paved.len()));
        let paved = paved.ok_or(NOT_A_BOX)?;
        let others: Vec<usize> = (0..names.len()).filter(|k| !paved.contains(k)).collect();
        // None stands there twice, and none is left over where it is not said which are paved.
        let is_order = paved.len() + others.len() == names.len()
            && (others.is_empty() || self.coordinates.is_some());
        is_order.then_some([paved, others]).ok_or(NOT_A_BOX)
    }
}

/// The last line of a paving: how many nodes of each kind there are, and what they cover.
///
/// **Lemma.** The volume of the region is at least that of the inner cells, and at most that of the
/// inner and the undecided cells. *Proof.* Cells of a tree overlap in faces only; the region
/// contains the inner cells and meets no outer one. With symmetry: let `D` be the points with
/// `u_x <= u_y <= u_z`. The region and the box are invariant under the six permutations of the
/// coordinates, whose images of `D` cover the box and overlap in planes only: volumes are six times
/// those within `D`, which mirrored cells meet in no inner point. Of a cell that is cut, the inner points
/// are in the region and the outer points are not, and it is in `D`. ∎
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Nodes that are split.
    pub splits: u64,
    /// Cells on which the claim holds.
    pub inner: u64,
    /// Cells on which it fails everywhere.
    pub outer: u64,
    /// Undecided cells, and cells that are cut.
    pub boundary: u64,
    /// Cells that are left out by symmetry.
    pub mirrored: u64,
    /// The inner cells' share of the box's volume, and that of the inner points of cells that are cut; with
    /// symmetry, of all their images.
    pub inner_share: Share,
    /// The share of what is undecided, likewise.
    pub boundary_share: Share,
}

/// A share of the box's volume, in units of `2^-SHARE_BITS`; written as a reduced fraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Share(pub u128);

impl Share {
    /// The share as a number.
    pub fn fraction(self) -> BigRational {
        BigRational::new(BigInt::from(self.0), BigInt::from(1) << SHARE_BITS)
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.fraction())
    }
}

impl Serialize for Share {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Why a paving is rejected.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Rejected {
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    /// The first line is not a header.
    #[error("the first line is not a header: {0}")]
    Header(#[from] Unreadable),
    /// The claim is not well formed.
    #[error("the claim is not well formed: {0}")]
    Claim(#[from] ClaimError),
    /// What the header says cannot be so, or the last line.
    #[error("{0}")]
    Whole(&'static str),
    /// The precision is not admissible.
    #[error("precision {0} is not within {PRECISIONS:?}")]
    Precision(u32),
    /// The header's depth is too great.
    #[error("depth {0} is more than {SHARE_BITS}")]
    Depth(u32),
    /// The bytes end within the tree.
    #[error("the bytes end within node {0}")]
    Truncated(u64),
    /// A byte that no node begins with, or evidence that is none.
    #[error("node {0}: byte {1:#04x} has no meaning there")]
    BadCode(u64, u8),
    /// A step does not discharge its obligation, or the cell is inner and nothing does.
    #[error("node {0}: obligation {1} is not certainly met on the cell")]
    Step(u64, usize),
    /// A step discharges what is discharged already.
    #[error("node {0}: obligation {1} is already discharged")]
    Repeated(u64, usize),
    /// A node that cannot be there, or is not shown to be what it says.
    #[error("node {0}{1}")]
    Node(u64, &'static str),
}

const NOT_A_BOX: Rejected = Rejected::Whole(
    "what is paved is not a box of positive volume, of one to three coordinates without orientations, \
     or of one to three different ones that are named",
);

/// Whether a file that begins with these bytes is meant as a paving.
pub fn is_paving(bytes: &[u8]) -> bool {
    let name = b"\"orthocert-paving/";
    let start = bytes.get(..64).unwrap_or(bytes);
    start.windows(name.len()).any(|window| window == name)
}

/// What an accepted paving establishes.
#[derive(Clone, Debug, PartialEq)]
pub struct Accepted {
    /// The first line.
    pub header: Header,
    /// The last line, recomputed.
    pub summary: Summary,
    /// Inner and outer cells, and inner parts of cells, whose evidence was evaluated.
    pub checked: u64,
}

/// Checks a paving, in one pass over its bytes.
///
/// # Errors
/// If it is rejected.
pub fn check<R: BufRead>(input: R) -> Result<Accepted, Rejected> {
    let mut reader = Reader::new(input)?;
    let subject = Subject::new(reader.header())?;
    let judge = Judge::new(&subject)?;
    let mut checked = 0;
    while let Some(visited) = reader.next()? {
        judge.check(&visited)?;
        checked += u64::from(visited.item.kind.is_decided());
    }
    Ok(Accepted { header: reader.header().clone(), summary: reader.finish()?, checked })
}
