//! The joint forces that one force on the platform asks for.

use super::{determinant, Context, Quantity, Test};
use crate::formula::{formula, Formula, Term};
use crate::input::{sign, ClaimError};
use crate::machine::Leg;

pub(super) const LOAD: Quantity = Quantity {
    key: "load",
    symbol: "|e_i . M^-T force|",
    words: "joint force, of arms torque, that holds the force given on the platform at rest",
    given: &["force"],
    ..Quantity::of_legs(tests)
};

/// `|tau_i| <= T` for `M^T tau = F`, as `|det A| >= b` and `|det A| >= -b`, `b = B_i det(A with F/T in row i)`.
///
/// *Proof.* The power of `F` is that of the joint forces, `F . x' = tau . rho'`, for every `x'`, so
/// `F = M^T tau`. By Cramer's rule `tau_i` is `det M` with `F` in row `i`, divided by `det M`. Row `j` of `M` is
/// `A_j/B_j`, so both determinants are those of `A` divided by the `B_j`, but that `B_i` is missing in the
/// first: `tau_i = B_i det(A with F in row i)/det A`. `B_i` is taken positive, which changes no `|tau_i|`. ∎
/// With one of the two tests alone a load of the other sign would pass, however great. With more joints than
/// coordinates forces are not determined. Arms: `tau_i/F_j` is a length.
fn tests(context: &mut Context<'_>, (joint, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    context.not_redundant()?;
    let max = context.positive(context.greatest()?)?;
    let force = context.all_given("force")?;
    let is_zero = |x| sign(x) == Some([false, true]);
    if force.len() != context.legs.len() || force.iter().all(is_zero) {
        return context.refused("given a force, not zero, of a number for each coordinate");
    }
    let units = if context.is_angular() { -1 } else { 0 };
    let ratio = |x| context.number(&(x / max), units);
    let force: Vec<Formula> = force.iter().map(ratio).collect();
    let own: Vec<_> = context.legs.iter().map(|leg| leg.row.a.clone()).collect();
    let mut replaced = own.clone();
    replaced[joint] = force;
    let tape = context.tape();
    let (det, replaced) = (determinant(tape, &own), determinant(tape, &replaced));
    let b = formula!(tape; (sqrt { leg.row.d }) * replaced);
    let opposite = tape.neg(b);
    Ok(vec![Test::Beyond(det, b), Test::Beyond(det, opposite)])
}
