//! Stiffness at the platform, of elastic joints and rigid legs.

use super::{Context, Quantity, Test};
use crate::input::{positive, ClaimError};

pub(super) const STIFFNESS: Quantity = Quantity {
    key: "stiffness",
    symbol: "the least eigenvalue of M^T diag(joint) M",
    words: "stiffness of the platform, with joints of the stiffness given and rigid legs, without preload",
    given: &["joint"],
    ..Quantity::of_machine(tests)
};

/// `M^T diag(k) M >= b I`, for `b, k_i > 0`, is `sigma_min >= 1` of the rows `A_i` with `D_i b/k_i` in
/// place of `D_i`, which are `sqrt(k_i/b)` times those of `M`; scaled, `sigma_min^2 >= w`. One `k`, or one a leg; of arms `k` is a
/// torque per radian.
///
/// *Proof.* A displacement `x` of the platform displaces joint `i` by `M_i . x`, which it resists with
/// the force `k_i M_i . x`; by virtual work the platform feels `M^T diag(k) M x`. ∎
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    let bound = context.positive(context.least()?)?;
    let given = context.all_given("joint")?;
    let units = if context.is_angular() { -2 } else { 0 };
    let (mut rows, weight) = context.own_rows();
    if given.len() != 1 && given.len() != rows.len() {
        return context.refused("given one number, or one a leg");
    }
    for (row, k) in rows.iter_mut().zip(given.iter().cycle()) {
        positive(context.place, k)?;
        let ratio = context.number(&(bound / k), units);
        row.d = context.tape().mul(row.d, ratio);
    }
    Ok(vec![Test::Least(rows, weight)])
}
