//! The joint force that a force on the platform asks for.

use super::{Context, Quantity, Test};
use crate::input::{binary, positive, ClaimError};
use crate::machine::Leg;
use crate::number::Operator;
use crate::test::solve::Solve;

pub(super) const JOINT_FORCE: Quantity = Quantity {
    key: "joint_force",
    symbol: "|column i of M^-1| tool",
    words: "joint force, of arms torque, by static forces up to the one given on the platform, in any direction",
    of_legs: true,
    given: &["tool"],
    tests,
};

/// `|z_i| <= max/tool` for `M z_i = e_i`, that is `A z_i = B_i e_i`, `B_i = sqrt(D_i)` up to a sign.
///
/// *Proof.* By virtual work a force `F` on the platform is held by the joint forces `tau` with
/// `F = M^T tau`, so `tau_i = e_i . M^-T F = z_i . F`, at most `|z_i| |F|`, and that for `F` along
/// `z_i`. ∎ With more joints than coordinates forces are not determined. Arms: `z_i` is a length.
fn tests(context: &mut Context<'_>, leg: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    context.not_redundant()?;
    let max = context.greatest()?.clone();
    let tool = context.given("tool")?.clone();
    positive(context.place, &max)?;
    positive(context.place, &tool)?;
    let Some(leg) = leg else { return context.refused("of a leg") };
    let units = if context.is_angular() { 1 } else { 0 };
    let ratio = context.number(&binary(Operator::Div, &max, &tool), units);
    let legs = context.legs;
    let tape = context.tape();
    let (zero, square) = (tape.integer(0), tape.sqr(ratio));
    let own = tape.sqrt(leg.row.d);
    let entry = |other: &Leg| if std::ptr::eq(other, leg) { own } else { zero };
    let a = legs.iter().map(|leg| leg.row.a.clone()).collect();
    Ok(vec![Test::Solve(Solve { a, b: legs.iter().map(entry).collect(), square })])
}
