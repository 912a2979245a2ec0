//! The joint force that a force on the platform asks for.

use super::{Context, Quantity, Test};
use crate::input::ClaimError;
use crate::machine::Leg;
use crate::test::solve::Solve;

pub(super) const JOINT_FORCE: Quantity = Quantity {
    key: "joint_force",
    symbol: "|column i of M^-1| tool",
    words: "joint force, of arms torque, by static forces up to the one given on the platform, in any direction; \
            where it turns, by forces F at P and couples C with |F|^2 + |C/ell|^2 up to its square",
    given: &["tool"],
    ..Quantity::of_legs(tests)
};

/// `|z_i| <= 1/k` for `M z_i = e_i`, `k = tool/max`.
///
/// *Proof.* By virtual work a force `F` on the platform, where it turns `(F, C/ell)`, with the power
/// `F . v + C . omega`, is held by the joint forces `tau` with `F = M^T tau`, so `tau_i = e_i . M^-T F = z_i . F`, at most `|z_i| |F|`, and that for `F` along
/// `z_i`. ∎ With more joints than coordinates forces are not determined. Arms: `z_i` is a length.
fn tests(context: &mut Context<'_>, (joint, _): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    context.not_redundant()?;
    let max = context.positive(context.greatest()?)?;
    let tool = context.positive(context.given("tool")?)?;
    let units = if context.is_angular() { -1 } else { 0 };
    let k = context.number(&(tool / max), units);
    let square = context.tape().sqr(k);
    Ok(vec![Test::Solve(Solve { joint, square })])
}
