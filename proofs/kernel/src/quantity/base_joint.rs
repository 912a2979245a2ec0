//! The angle between a leg and an axis of its joint in the base.

use super::{Context, Quantity, Test};
use crate::formula::Formula;
use crate::input::{ordered, positive, ClaimError, Value};
use crate::machine::Leg;
use crate::number::Expression;

pub(super) const BASE_JOINT: Quantity = Quantity {
    key: "base_joint",
    symbol: "angle(leg_i, axis)",
    words: "angle between the leg, from base to platform, and the axis in the base, degrees",
    of_legs: true,
    given: &["axis"],
    tests,
};

/// `A . axis - cos(b) |axis| L >= 0`, for `0 < b <= 180`: the leg's vector `A`, from the base end, has
/// the length `L > 0`, and cosines decrease. Of the cosine's enclosure the upper end decides in a proof
/// and the lower end in a refutation, as of all that is enclosed. Squares would lose the sign, and let
/// a leg pass that points the other way.
pub(super) fn tests(context: &mut Context<'_>, leg: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    let bound = context.greatest()?.clone();
    positive(context.place, &bound)?;
    ordered(context.place, &bound, &Expression::integer(180), false)?;
    let Some((leg, length)) = leg.and_then(|leg| Some((leg, leg.rod()?))) else {
        return context.refused("of a leg with two ends");
    };
    let axis = context.all_given("axis")?.to_vec();
    if axis.len() != leg.row.a.len() {
        return context.refused("given an axis with a number for each coordinate");
    }
    let axis = context.direction(&axis)?;
    let cos = context.input(Value::Cosine(bound));
    let tape = context.tape();
    let zero = tape.integer(0);
    let mut sum = |of: &[Formula]| {
        let products = of.iter().zip(&axis);
        products.fold(zero, |sum, (&a, &b)| {
            let product = tape.mul(a, b);
            tape.add(sum, product)
        })
    };
    let (along, square) = (sum(&leg.row.a), sum(&axis));
    let norm = tape.sqrt(square);
    let least = tape.mul(cos, norm);
    let least = tape.mul(least, length);
    Ok(vec![Test::AtLeast(tape.sub(along, least))])
}
