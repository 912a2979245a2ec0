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
//! [`Judge`](orthocert_kernel::paving::Judge) before it is written.

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
pub use search_box::in_box;
pub use spectrum::Spectrum;
pub use surface::{
    ends, surface, walls, Beyond, Detail, Face, Node, Surface, SurfaceError, Tree, Wall, EDGE,
    INNER, OUTER, UNDECIDED,
};
pub use tree::{Cancelled, Grower, Segment, Tally};

use crate::solver::doubles::Pair;
use crate::solver::evidence::{Prover, BITS};
use crate::solver::refute::approximate;
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_kernel::certificate::Provenance;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::paving::{is_symmetric, Header, Symmetry, FORMAT};
use orthocert_kernel::problem::Problem;

/// Fractional bits of the exact check: most of those for which it can be done in machine words, and
/// those where it cannot.
const PRECISIONS: std::ops::RangeInclusive<u32> = 32..=36;
const BEYOND_WORDS: u32 = 64;
/// Bits of a machine word that are not for a number's fraction, beside those of its greatest values.
const GUARD: u32 = 25;

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
        claim: claim.clone(),
        precision: precision(claim),
        depth,
        symmetry: is_symmetric(claim).then_some(Symmetry::Permutations),
        provenance: Provenance {
            tool: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        },
    }
}

/// The precision in which the judge is fast, if there is one.
fn precision(claim: &MachineClaim) -> u32 {
    let greatest = Problem::new(claim).and_then(|problem| Ok(Prover::new(&problem)?.greatest()));
    let bits = greatest.unwrap_or(1.0).log2().ceil().clamp(0.0, 64.0) as u32;
    match (63 - GUARD).saturating_sub(bits) {
        words if words < *PRECISIONS.start() => BEYOND_WORDS,
        words => words.min(*PRECISIONS.end()),
    }
}

/// The corners of a claim's box.
fn corners(claim: &MachineClaim) -> Option<[&[Expression]; 2]> {
    match &claim.workspace {
        Workspace::Box { min, max } => Some([min, max]),
        Workspace::Cylinder { .. } | Workspace::Cube { .. } => None,
    }
}

/// The volume of a claim's box, where it is rational.
pub fn box_volume(claim: &MachineClaim) -> Option<BigRational> {
    let [min, max] = corners(claim)?;
    let edges = min.iter().zip(max).map(|(min, max)| Some(max.rational()? - min.rational()?));
    edges.product()
}

/// The ends of a claim's box along each of its axes, nearly.
pub fn box_ends(claim: &MachineClaim) -> Option<Vec<Pair>> {
    let [min, max] = corners(claim)?;
    min.iter().zip(max).map(|(min, max)| Some((approximate(min)?, approximate(max)?))).collect()
}

/// The depth at which boxes have edges of at most `edge` in the geometric mean: the volume of the
/// workspace's box is at most `2^depth edge^m`. `None` if the workspace is not a box, or the depth
/// is beyond what pavings have.
pub fn depth_for_edge(claim: &MachineClaim, edge: &Expression) -> Option<u32> {
    let [min, max] = corners(claim)?;
    let enclosed = |x: &Expression| {
        let x = x.enclose(&orthocert_kernel::fixed::Fixed::<BigInt>::new(4 * BITS), &|_| None)?;
        let end = |x| BigRational::new(x, BigInt::from(1) << (4 * BITS));
        Some([end(x.lo), end(x.hi)])
    };
    let number = |x: &Expression| match x.rational() {
        Some(x) => Some([x.clone(), x]),
        None => enclosed(x),
    };
    let mut volume = BigRational::from_integer(1.into());
    let mut cube = volume.clone();
    let [least, _] = number(edge)?;
    for (min, max) in min.iter().zip(max) {
        let ([low, _], [_, high]) = (number(min)?, number(max)?);
        volume *= high - low;
        cube *= &least;
    }
    (0..=pass::DEEPEST).find(|_| {
        let is = volume <= cube;
        cube = &cube * BigRational::from_integer(2.into());
        is
    })
}
