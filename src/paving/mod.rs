//! Pavings: the region of a search box where a claim holds, from within and from without.
//!
//! | module     | does                                                              |
//! |------------|-------------------------------------------------------------------|
//! | `decide`   | what becomes of one cell                                          |
//! | `spectrum` | extreme singular values of a matrix                               |
//! | `tree`     | grows the tree, cut into subtrees                                 |
//! | `plan`     | how deep the tree has to go                                       |
//! | `search_box` | a claim with another box in the place of its workspace          |
//! | `pass`     | writes the tree to a file that can be taken up again              |
//! | `parts`    | the tree in parts that are made anywhere                          |
//! | `components` | connected components of the inner part                          |
//! | `isotropy` | the best conditioned point of the inner part                      |
//! | `surface`  | the surface of the inner part                                     |
//!
//! The tree is grown depth first down to one depth, and what becomes of a cell depends on the cell
//! and its ancestors alone: the bytes are the same for every number of threads and after every
//! interruption. Every inner and every outer cell is confirmed by the checker's exact
//! [`Judge`](orthocert_checker::paving::Judge) before it is written.

mod components;
mod decide;
mod isotropy;
mod parts;
mod pass;
mod plan;
mod search_box;
mod spectrum;
mod surface;
mod tree;

pub use components::{components, Component, Components};
pub use decide::{Decider, Decision, Fate};
pub use parts::{Parts, TreeWriter};
pub use pass::{pave, unfinished, PaveError, Paved, Resume, DEEPEST};
pub use search_box::{in_box, SearchBoxError};
pub use surface::{
    ends, surface, walls, Beyond, Detail, Face, Node, Surface, SurfaceError, Tree, Wall, EDGE,
    INNER, OUTER, UNDECIDED,
};
pub use tree::{Cancelled, Grower, Root, Segment, Tally};

use num_rational::BigRational;
use orthocert_checker::certificate::Provenance;
use orthocert_checker::claim::{Claim, MachineClaim, Workspace};
use orthocert_checker::number::Exact;
use orthocert_checker::paving::{is_symmetric, Header, Symmetry, FORMAT};

/// Fractional bits of the exact check: the most for which it can be done in machine words.
const PRECISION: u32 = 36;

/// How fine a paving is to be.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The depth, where it is given.
    pub depth: Option<u32>,
    /// The greatest volume of the undecided boxes relative to that of the inner ones.
    pub gap: Option<f64>,
    /// Most boxes to be tried.
    pub max_boxes: u64,
}

/// The first line of a paving of a claim.
pub fn header(claim: &MachineClaim, depth: u32) -> Header {
    Header {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(claim.clone()),
        precision: PRECISION,
        depth,
        symmetry: is_symmetric(claim).then_some(Symmetry::Permutations),
        provenance: Provenance {
            tool: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        },
    }
}

/// The volume of a claim's box, where it is rational.
pub fn box_volume(claim: &MachineClaim) -> Option<BigRational> {
    let Workspace::Box { min, max } = &claim.workspace else {
        return None;
    };
    let edges = min.iter().zip(max).map(|(min, max)| Some(max.as_rational()? - min.as_rational()?));
    edges.product()
}

/// The depth at which boxes have edges of at most `edge` in the geometric mean: the volume of the
/// workspace's box is at most `2^depth edge^3`. `None` if the workspace is not a box, or the depth
/// is beyond what pavings have.
pub fn depth_for_edge(claim: &MachineClaim, edge: &Exact) -> Option<u32> {
    let Workspace::Box { min, max } = &claim.workspace else {
        return None;
    };
    let mut volume = Exact::integer(1);
    let mut cube = Exact::integer(1);
    for (min, max) in min.iter().zip(max) {
        volume = volume.times(max.clone().minus(min.clone()).ok()?).ok()?;
        cube = cube.times(edge.clone()).ok()?;
    }
    let two = Exact::integer(2);
    for depth in 0..=pass::DEEPEST {
        if volume.compare(&cube)?.is_le() {
            return Some(depth);
        }
        cube = cube.times(two.clone()).ok()?;
    }
    None
}
