//! Pavings: the region of a search box where a claim holds, from within and from without.
//!
//! | module     | does                                                              |
//! |------------|-------------------------------------------------------------------|
//! | `decide`   | what becomes of one cell                                          |
//! | `margin`   | by how much a test holds at its centre, to first order            |
//! | `cut`      | where one is cut that is neither inner nor outer                  |
//! | `seen`     | how far from a test's end the judge sees it decided               |
//! | `flat`     | formulas over cells, in doubles                                   |
//! | `others`   | the same of some coordinates, for all values of the others        |
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
mod cut;
mod decide;
mod flat;
mod isotropy;
mod margin;
mod others;
mod parts;
mod pass;
mod plan;
mod search_box;
mod seen;
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

use crate::search::solver::doubles::Pair;
use crate::search::solver::evidence::{Prover, BITS};
use crate::search::solver::refute::approximate;
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_kernel::certificate::Provenance;
use orthocert_kernel::claim::{MachineClaim, Orientation, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::paving::{is_symmetric, names, About, Header, Symmetry, FORMAT};
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

/// The first line of a paving of a claim: of all of its coordinates, or of these alone.
pub fn header(claim: &MachineClaim, coordinates: Option<&[String]>, depth: u32) -> Header {
    Header {
        format: FORMAT.to_owned(),
        claim: About { machine: claim.clone() },
        coordinates: coordinates.map(<[String]>::to_vec),
        precision: precision(claim),
        depth,
        symmetry: (coordinates.is_none() && is_symmetric(claim)).then_some(Symmetry::Permutations),
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

/// The ends of the coordinates that are paved: of all of a claim's box, or of those that are named, angles
/// in degrees. `None` where these are none.
pub fn ranges<'a>(
    claim: &'a MachineClaim,
    coordinates: Option<&[String]>,
) -> Option<Vec<[&'a Expression; 2]>> {
    let mut all: Vec<[&Expression; 2]> = match &claim.workspace {
        Workspace::Box { min, max } => min.iter().zip(max).map(|(min, max)| [min, max]).collect(),
        // That of z; the others have no name.
        Workspace::Cylinder { z: [min, max], .. } if coordinates.is_some() => vec![[min, max]; 3],
        Workspace::Cylinder { .. } | Workspace::Cube { .. } => return None,
    };
    let Some(coordinates) = coordinates else { return Some(all) };
    match &claim.orientation {
        Some(Orientation::Range([min, max])) => all.push([min, max]),
        Some(Orientation::RollPitchYaw { roll, pitch, yaw }) => {
            all.extend([roll, pitch, yaw].map(|[min, max]| [min, max]));
        }
        Some(Orientation::Angle(_) | Orientation::Tilt { .. }) | None => {}
    }
    let names = names(claim);
    let range =
        |own: &String| all.get(names.iter().position(|name| name.as_ref() == Some(own))?).copied();
    coordinates.iter().map(range).collect()
}

/// Whether all coordinates that are paved are of places, or of formulas: these are in one unit.
pub fn are_places(claim: &MachineClaim, coordinates: Option<&[String]>) -> bool {
    let is_angle = |name: &String| ["angle", "roll", "pitch", "yaw"].contains(&name.as_str());
    let turned = claim.orientation.is_some();
    !turned || !coordinates.is_some_and(|names| names.iter().any(is_angle))
}

/// The volume of the box that is paved, where it is rational, and in one unit.
pub fn box_volume(claim: &MachineClaim, coordinates: Option<&[String]>) -> Option<BigRational> {
    let edges = ranges(claim, coordinates).filter(|_| are_places(claim, coordinates))?;
    let edges = edges.iter().map(|[min, max]| Some(max.rational()? - min.rational()?));
    edges.product()
}

/// The ends of the box that is paved along each of its axes, nearly.
pub fn box_ends(claim: &MachineClaim, coordinates: Option<&[String]>) -> Option<Vec<Pair>> {
    let ends = ranges(claim, coordinates)?;
    ends.iter().map(|[min, max]| Some((approximate(min)?, approximate(max)?))).collect()
}

/// The names of the axes of a paving.
pub fn axes(header: &Header) -> [String; 3] {
    let names = header.coordinates.clone().unwrap_or_default();
    let or = |(k, other): (usize, &str)| match &header.coordinates {
        Some(_) => names.get(k).cloned().unwrap_or_default(),
        None => other.to_owned(),
    };
    [(0, "x"), (1, "y"), (2, "z")].map(or)
}

/// The depth at which boxes have edges of at most `edge` in the geometric mean: the volume of the
/// workspace's box is at most `2^depth edge^m`. `None` if the workspace is not a box, or the depth
/// is beyond what pavings have.
pub fn depth_for_edge(
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
    edge: &Expression,
) -> Option<u32> {
    let enclosed = |x: &Expression| {
        let x = x.enclose(4 * BITS)?;
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
    for [min, max] in ranges(claim, coordinates)? {
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
