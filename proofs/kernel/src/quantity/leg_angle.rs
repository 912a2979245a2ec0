//! The angle between leg and guide.

use super::serial_margin::at_least_of_length;
use super::{Context, Quantity, Test};
use crate::input::{ordered, ClaimError, Value};
use crate::machine::Leg;
use crate::number::Expression;

pub(super) const LEG_ANGLE: Quantity = Quantity {
    key: "leg_angle",
    symbol: "angle(leg_i, n_i)",
    words: "angle between leg and guide, degrees",
    ..Quantity::of_legs(tests)
};

/// `|eta_i|/L_i >= cos(b)`, for `0 < b <= 90`.
fn tests(context: &mut Context<'_>, (_, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    let bound = context.positive(context.greatest()?)?;
    ordered(context.place, bound, &Expression::integer(90), false)?;
    if leg.is_angular() {
        return context.refused("of sliders");
    }
    let cos = context.input(Value::Cosine(bound.clone()));
    at_least_of_length(context, leg, cos)
}
