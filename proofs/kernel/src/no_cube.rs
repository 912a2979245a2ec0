//! No cube: of some side, wherever its centre is in a box, none lies where a claim holds.

use crate::arithmetic::Arithmetic as _;
use crate::certificate::Tree;
use crate::check::{is_box, walk, Leaf, Rejected};
use crate::claim::MachineClaim;
use crate::fixed::{Fixed, Integer, Interval};
use crate::input::{binary, enclosed, narrowed, number_error, positive, shape_error};
use crate::number::{Expression, Operator};
use crate::problem::Problem;
use crate::statement::{machine, requirements};
use serde::{Deserialize, Serialize};
use std::fmt;

/// "For every machine, and every point `C` of the box that is the workspace of `machine`, the closed
/// cube of this side with the centre `C` and edges along the axes has a point at which the claim of
/// `machine` fails."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoCubeClaim {
    /// The machine, the requirements, and the box of the centres.
    pub machine: MachineClaim,
    /// Positive.
    pub side: Expression,
}

/// Half of the side is divided in so many parts, in which offsets are counted.
pub const OFFSET_PARTS: i64 = 8;

/// **Lemma (no cube).** If every leaf fails at an offset of at most [`OFFSET_PARTS`] either way, the
/// claim is true. *Proof.* A centre `C` is in a leaf's cell, and `C + o` is in the cube about it, for
/// the leaf's offset `o`, as `|o_k| <= side/2`. It is one of the cell's points moved by `o`, at all of
/// which the claim of the machine fails, for every machine. ∎ With an orientation, a "cube" would be of
/// coordinates of other kinds too.
pub(crate) fn holds<Z: Integer>(
    problem: &Problem,
    claim: &NoCubeClaim,
    tree: &Tree,
) -> Result<(), Rejected> {
    if !is_box(problem) || claim.machine.orientation.is_some() {
        let expected = "a box of centres, without orientations";
        return Err(Rejected::Claim(shape_error("workspace", expected)));
    }
    positive("side", &claim.side).map_err(Rejected::Claim)?;
    let part = binary(Operator::Div, &claim.side, &Expression::integer(2 * OFFSET_PARTS));
    let part = enclosed(&part, problem.scale, tree.precision).and_then(|part| narrowed(&part));
    let part = part.ok_or_else(|| Rejected::Claim(number_error("side", "a number")))?;
    walk::<Z>(problem, tree, Some(&part), |node, leaf, _| match leaf {
        Leaf::Fails => Ok(()),
        Leaf::Holds | Leaf::Open(_) => Err(Rejected::Holds(node)),
    })
}

/// A cell's edges moved by an offset in parts of half the side: for each value of the part, every
/// point `c + lambda h` of the cell is moved to `(c + o) + lambda h`.
pub(crate) fn moved<Z: Integer>(
    arithmetic: &Fixed<Z>,
    edges: Vec<[Interval<Z>; 3]>,
    offset: &[i64],
    part: &Interval<Z>,
) -> Option<Vec<[Interval<Z>; 3]>> {
    let within = offset.iter().all(|n| (-OFFSET_PARTS..=OFFSET_PARTS).contains(n));
    let edge = |([centre, range, half], &n): ([Interval<Z>; 3], &i64)| {
        let by = arithmetic.mul(&arithmetic.integer(n)?, part)?;
        Some([arithmetic.add(&centre, &by)?, arithmetic.add(&range, &by)?, half])
    };
    let shape = within && offset.len() == edges.len();
    shape.then(|| edges.into_iter().zip(offset).map(edge).collect())?
}

/// What an accepted claim establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn statement(claim: &NoCubeClaim) -> Result<String, fmt::Error> {
    use fmt::Write;
    let NoCubeClaim { machine: claim, side } = claim;
    let mut out = String::new();
    writeln!(out, "It is proved:")?;
    writeln!(out, "No axis-aligned cube of side {side} with its centre in the box")?;
    writeln!(out, "{}", crate::statement::box_of(claim))?;
    writeln!(out, "is such that all of the following holds at every point P of the cube.")?;
    machine(&mut out, claim)?;
    requirements(&mut out, claim)?;
    writeln!(
        out,
        "(With tolerances, the cube has a point at which it does not for every machine:"
    )?;
    writeln!(out, "none of them has the cube.)")?;
    Ok(out)
}
