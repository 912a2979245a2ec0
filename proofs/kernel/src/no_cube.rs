//! No cube: of some side, wherever its centre is in a box, none lies where a claim holds.

use crate::certificate::Tree;
use crate::claim::NoCubeClaim;
use crate::fixed::Integer;
use crate::input::{binary, enclosed, narrowed, number_error, positive, shape_error};
use crate::number::{Expression, Operator};
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::statement::{machine, requirements};
use crate::tree::{self, Theorem, OFFSET_PARTS};
use std::fmt;

/// A claim, compiled.
struct NoCube {
    problem: Problem,
    /// One of the parts of half the side.
    part: Expression,
}

/// **Lemma (no cube).** If every leaf fails at an offset of at most [`OFFSET_PARTS`] either way, the
/// claim is true. *Proof.* A centre `C` is in a leaf's cell, and `C + o` is in the cube about it, for
/// the leaf's offset `o`, as `|o_k| <= side/2`. It is one of the cell's points moved by `o`, at all of
/// which the claim of the machine fails, for every machine. ∎ With an orientation, a "cube" would be of
/// coordinates of other kinds too.
impl Theorem for NoCube {
    fn is_proved<Z: Integer>(&self, tree: &Tree) -> Result<(), Rejected> {
        let part = enclosed(&self.part, self.problem.scale, tree.precision);
        let part = part.and_then(|part| narrowed(&part));
        let part = part.ok_or_else(|| Rejected::Claim(number_error("side", "a number")))?;
        tree::prove::<Z>(&self.problem, tree, Some(&part))
    }
}

/// Accepts a proof of a claim whose machine is compiled, or says why not.
pub(crate) fn check(claim: &NoCubeClaim, problem: Problem, tree: &Tree) -> Result<(), Rejected> {
    let is_box =
        problem.inside.is_none() && problem.cube_kappa.is_none() && problem.turned.is_none();
    if !is_box || claim.machine.orientation.is_some() {
        let expected = "a box of centres, without orientations";
        return Err(Rejected::Claim(shape_error("workspace", expected)));
    }
    positive("side", &claim.side).map_err(Rejected::Claim)?;
    let part = binary(Operator::Div, &claim.side, &Expression::integer(2 * OFFSET_PARTS));
    tree::check(&NoCube { problem, part }, tree)
}

/// What an accepted claim establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn statement(claim: &NoCubeClaim) -> Result<String, fmt::Error> {
    use fmt::Write;
    let NoCubeClaim { machine: claim, side } = claim;
    let mut out = String::new();
    let centres = crate::statement::box_of(claim);
    write!(
        out,
        "\
It is proved:
No axis-aligned cube of side {side} with its centre in the box
{centres}
is such that all of the following holds at every point P of the cube.
"
    )?;
    machine(&mut out, claim)?;
    requirements(&mut out, claim)?;
    write!(
        out,
        "\
(With tolerances, the cube has a point at which it does not for every machine:
none of them has the cube.)
"
    )?;
    Ok(out)
}
