//! How well struts keep the platform from turning.

use super::{Context, Quantity, Test};
use crate::input::ClaimError;

pub(super) const CONSTRAINT_MARGIN: Quantity = Quantity {
    key: "constraint_margin",
    symbol: "the least singular value of the matrix of unit couples c_i/|c_i|",
    words:
        "distance from constraint singularities, c_i = w_i - (k_i . w_i) k_i for the base axis k_i",
    ..Quantity::of_machine(tests)
};

/// `sigma_min >= b`, for `b > 0`, of the rows `c_i` with `|c_i|^2` in place of `D_i`: the platform can
/// turn where these couples do not span all couples. No `c_i` is zero where it is shown.
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    let bound = context.positive(context.least()?)?;
    if context.legs.iter().any(|leg| leg.row.a.len() != 3) {
        return context.refused("of legs in space");
    }
    let rows: Option<Vec<_>> = context.legs.iter().map(|leg| leg.couple.clone()).collect();
    let Some(rows) = rows else { return context.refused("of struts with a base axis") };
    let kappa = context.number(bound, 0);
    Ok(vec![Test::Least(rows, context.tape().sqr(kappa))])
}
