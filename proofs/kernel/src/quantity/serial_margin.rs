//! How far a leg is from a serial singularity: `|eta_i|/L_i`.

use super::{Context, Quantity, Test};
use crate::formula::{formula, Formula, Term};
use crate::input::ClaimError;
use crate::machine::Leg;

pub(super) const SERIAL_MARGIN: Quantity = Quantity {
    key: "serial_margin",
    symbol: "|eta_i|/L_i",
    words: "distance from serial singularities",
    ..Quantity::of_legs(tests)
};

/// `eta_i^2 - b^2 L_i^2 >= 0`, for `b > 0`.
fn tests(context: &mut Context<'_>, (_, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    let bound = context.positive(context.least()?)?;
    let bound = context.number(bound, 0);
    at_least_of_length(context, leg, bound)
}

/// `eta_i^2 - c^2 L_i^2 >= 0`.
pub(super) fn at_least_of_length(
    context: &mut Context<'_>,
    leg: &Leg,
    c: Formula,
) -> Result<Vec<Test>, ClaimError> {
    let Some((eta_squared, length)) = leg.eta_squared.zip(leg.length) else {
        return context.refused("of legs of fixed length");
    };
    let tape = context.tape();
    Ok(vec![Test::AtLeast(formula!(tape; eta_squared - ((c ^ 2) * (length ^ 2))))])
}
