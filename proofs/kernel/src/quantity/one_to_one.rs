//! Unique direct kinematics: no two points of the workspace have the same joint coordinates.

use super::{Context, Quantity, Test};
use crate::claim::{Bound, Mechanism};
use crate::input::ClaimError;
use crate::machine::Leg;

pub(super) const ONE_TO_ONE: Quantity = Quantity {
    key: "one_to_one",
    symbol: "no two points of the workspace have the same joint coordinates",
    words: "unique direct kinematics in the working modes named",
    of_legs: false,
    given: &[],
    tests,
};

/// **Lemma (chords).** Let `A_i(P)` be the vector of leg `i`, from its base end to its platform end, or
/// the constant normal of a plane. If `P` and `P'` have the same joint coordinates in one machine,
/// `(A_i(P) + A_i(P')) . (P' - P) = 0` for each `i`. *Proof.* The base end of leg `i` is the same: the
/// anchor, the point `a + rho n` of the guide, or the elbow, which an angle gives up to whole turns. So
/// `A_i(P') - A_i(P) = P' - P`, and the product is `|A_i(P')|^2 - |A_i(P)|^2`, which is zero: both are
/// `L_i^2`, or `rho_i^2` of a strut. Of a plane `n . (P' - P) = rho' - rho = 0`. ∎ So if `sym(Y^T A)` is
/// positive definite at every point of a set, convex or not, with *one* `Y`, no two of its points have
/// the same joint coordinates: for `x = P' - P != 0`, `0 = x^T Y^T (A(P) + A(P')) x > 0`. With a `Y` of
/// each cell it would prove nothing of two points in different cells. The rows of `M`, which are those
/// of `A` divided by what depends on `P`, do not have this identity.
///
/// **Lemma (metric).** Users' joint coordinates `f` have another: the workspace is convex, and `f` is
/// defined on it with derivative `M`. If `sym(Y^T M) > 0` there with one `Y`, then
/// `x^T Y^T (f(P') - f(P)) = int_0^1 x^T Y^T M(P + t x) x dt > 0`, so that `f(P') != f(P)`. ∎ Of joints
/// given by rows alone nothing is said: an angle returns after a turn.
fn tests(context: &mut Context<'_>, _: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    if context.requirement.bound != Bound::Holds {
        return context.refused("without a bound");
    }
    let users = matches!(context.claim.mechanism, Mechanism::Formulas(_));
    if context.legs.iter().any(|leg| leg.rho.is_none()) {
        return context.refused("of joints whose coordinates the claim gives");
    }
    let row = |leg: &Leg| if users { leg.divided.clone() } else { leg.row.clone() };
    Ok(vec![Test::OneToOne(context.legs.iter().map(row).collect())])
}
