//! No cube: of some side, wherever its centre is in a box, none lies where a claim holds.

use crate::certificate::Tree;
use crate::claim::NoCubeClaim;
use crate::input::{malformed, positive};
use crate::number::Expression;
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::statement::{box_of, holds};
use crate::tree::{self, OFFSET_PARTS};

/// Accepts a proof of a claim whose machine is compiled, or says why not.
///
/// **Lemma (no cube).** If every leaf fails at an offset of at most [`OFFSET_PARTS`] either way, the
/// claim is true. *Proof.* A centre `C` with a machine is in a leaf, and `C + o` is in the cube about it, for
/// the leaf's offset `o`, as `|o_k| <= side/2`. It is one of the cell's points moved by `o`, at all of
/// which the claim of the machine fails, for every machine of the leaf. ∎ With an orientation, a "cube" would be of
/// coordinates of other kinds too.
pub(crate) fn check(claim: &NoCubeClaim, problem: Problem, tree: &Tree) -> Result<(), Rejected> {
    let is_box =
        problem.inside.is_none() && problem.cube_kappa.is_none() && problem.turned.is_none();
    if !is_box || claim.machine.orientation.is_some() {
        let expected = "a box of centres, without orientations";
        return Err(malformed("workspace", expected).into());
    }
    positive("side", &claim.side)?;
    let part = Some(&claim.side / &Expression::integer(2 * OFFSET_PARTS));
    tree::check(&Problem { offset: part, ..problem }, tree)
}

/// What an accepted claim establishes.
pub fn statement(NoCubeClaim { machine, side }: &NoCubeClaim) -> String {
    let (centres, all) = (box_of(machine), holds(machine, ""));
    format!(
        "\
It is proved:
No axis-aligned cube of side {side} with its centre in the box
{centres}
is such that all of the following holds at every point P of the cube.
{all}(With tolerances, none of the machines has such a cube.)
"
    )
}
