//! Velocity transmission factors, `psi_i = 1/xi_i`, `xi_i` the singular values of `M`.

use super::{Context, Quantity, Test};
use crate::claim::Bound;
use crate::input::{positive, ClaimError};
use crate::number::Expression;

pub(super) const TRANSMISSION: Quantity = Quantity {
    key: "transmission",
    symbol: "psi_i",
    words: "velocity transmission factors",
    ..Quantity::of_machine(tests)
};

/// `psi_i <= b` for all `i` is `sigma_min(M) >= 1/b`; `psi_i >= b` is `sigma_max(M) <= 1/b`.
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    let bound = match &context.requirement.bound {
        Bound::Min(bound) | Bound::Max(bound) => bound,
        Bound::Within(_) | Bound::Holds => return context.refused("a least or a greatest value"),
    };
    positive(context.place, bound)?;
    let one = Expression::integer(1);
    let inverse = &one / bound;
    // M is an angle per length for arms.
    let units = if context.is_angular() { -1 } else { 0 };
    let sigma = context.number(&inverse, units);
    let square = context.tape().sqr(sigma);
    Ok(vec![match &context.requirement.bound {
        Bound::Min(_) => Test::SigmaMax(square),
        _ => Test::SigmaMin(square),
    }])
}
