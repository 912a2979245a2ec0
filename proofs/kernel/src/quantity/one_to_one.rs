//! Unique direct kinematics: no two poses of the workspace have the same joint coordinates.

use super::{Context, Quantity, Test};
use crate::claim::{Bound, Mechanism};
use crate::formula::{Formula, Tape};
use crate::input::ClaimError;
use crate::machine::Leg;
use crate::orientation::is_less_than_half_a_turn;
use crate::test::Row;

pub(super) const ONE_TO_ONE: Quantity = Quantity {
    key: "one_to_one",
    symbol: "no two poses of the workspace have the same joint coordinates",
    words: "unique direct kinematics in the working modes named",
    ..Quantity::of_machine(tests)
};

const APART: &str = "of orientations that differ by less than half a turn: angle, or tilt and torsion \
                     together, below 90 degrees; pitch within 90 degrees, roll and yaw together over \
                     less than 180";

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
///
/// **Lemma (chords of poses).** Let the platform turn, and no two orientations of the workspace differ
/// by half a turn. Let `C_i = P + R b_i` be the platform end of leg `i`, and row `i` be
/// `[A_i, C_i x A_i]`: moments are about the *origin*. If its sum over the poses `(P, R)` and `(P', R')`
/// is `[F_i, G_i]`, and they have the same joint coordinates in one machine, there is one vector `(t, k)`
/// for all `i`, zero only if the poses are the same, with `F_i . t + G_i . k = 0`.
///
/// *Proof.* As `R' R^T` is not half a turn, it is `(I - [h]x)^-1 (I + [h]x)` for one `h`, zero only if
/// `R' = R`. So `R' - R = [h]x (R' + R)`, and with `(R' + R) b_i = C_i + C_i' - P - P'`
///
/// ```text
/// C_i' - C_i = P' - P + h x (R' + R) b_i = t + h x (C_i + C_i'),     t = P' - P - h x (P + P')
/// ```
///
/// The base end is the same point `B_i` as above, so `A_i' - A_i = C_i' - C_i`, `|A_i'| = |A_i|`, and
/// `C_i + C_i' = 2 B_i + F_i`. Hence
///
/// ```text
/// 0 = F_i . (A_i' - A_i) = F_i . t + ((C_i + C_i') x F_i) . h = F_i . t + (2 B_i x F_i) . h
/// G_i = C_i x A_i + C_i' x A_i' = B_i x A_i + B_i x A_i' = B_i x F_i
/// ```
///
/// With `k = 2 h`: if it is zero, so is `h`, and `t = P' - P`. ∎ So `sym(Y^T A) > 0` of these rows with one
/// `Y` shows it, of positions and orientations convex or not. The row of `M`, with moments about `P`,
/// will not do: its `P` is another one at either pose. In the plane the components are x, y and z, as
/// `t` is in it and `h` normal to it; about a fixed point `P = t = 0`.
///
/// Of a strut `C_i x A_i = a_i x A_i`. Where all legs have them, the rows are the scaled ones, `w` times
/// these: with `w >= 1`, of the same sign at each pose. One leg's row scaled alone would not be.
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    if context.requirement.bound != Bound::Holds {
        return context.refused("without a bound");
    }
    let apart = |set| !is_less_than_half_a_turn(set);
    if context.claim.orientation.as_ref().is_some_and(apart) {
        return context.refused(APART);
    }
    if context.legs.iter().any(|leg| leg.rho.is_none()) {
        return context.refused("of joints whose coordinates the claim gives");
    }
    let (claim, legs) = (context.claim, context.legs);
    let turns = claim.orientation.is_some();
    let scaled = legs.iter().all(|leg| leg.scaled.is_some());
    let mut row = |leg: &Leg| match &claim.mechanism {
        Mechanism::Formulas(_) => Some(leg.divided.clone()),
        Mechanism::Planar(_) | Mechanism::Spatial(_) if turns => {
            about_origin(context.tape(), leg, scaled)
        }
        // About the origin already.
        Mechanism::Spherical(_) => leg.scaled.clone(),
        _ => Some(leg.row.clone()),
    };
    let rows = legs.iter().map(&mut row).collect::<Option<_>>();
    rows.map_or_else(
        || context.refused("of legs with two ends"),
        |rows| Ok(vec![Test::OneToOne(rows)]),
    )
}

/// `[A, C x A]`, and its `D`; of a strut, if wanted, times `w`.
fn about_origin(tape: &mut Tape, leg: &Leg, scaled: bool) -> Option<Row<Formula>> {
    let row = leg.scaled.as_ref().filter(|_| scaled).unwrap_or(&leg.row);
    let (from, zero) = (leg.ends.map(|[a, _]| a).or(leg.tip)?, tape.integer(0));
    let a = match *row.a.as_slice() {
        [x, y, _] => {
            let moment = tape.cross(&from, &[x, y, zero]);
            vec![x, y, moment[2]]
        }
        [x, y, z, ..] => {
            let a = [x, y, z];
            [a, tape.cross(&from, &a)].concat()
        }
        _ => return None,
    };
    Some(Row { a, d: row.d })
}
