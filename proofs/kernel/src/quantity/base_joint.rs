//! The angle between a leg and an axis of its joint in the base.

use super::{Context, Quantity, Test};
use crate::formula::{formula, Term};
use crate::input::{ordered, ClaimError, Value};
use crate::machine::Leg;
use crate::number::Expression;
use crate::test::Row;

pub(super) const BASE_JOINT: Quantity = Quantity {
    key: "base_joint",
    symbol: "angle(leg_i, axis)",
    words: "angle between the leg, from base to platform, and the axis in the base, degrees",
    given: &["axis"],
    ..Quantity::of_legs(|context, (_, leg)| tests(context, leg, false))
};

/// `A . j - cos(b) |j| |A| >= 0` for the axis `j` and `0 < b <= 180`: the leg's vector `A`, from the base
/// end, has a length greater than 0, and cosines decrease. Of the cosine's enclosure the upper end decides
/// in a proof and the lower end in a refutation, as of all that is enclosed. Squares alone would lose the
/// sign, and let a leg pass that points the other way.
///
/// Of struts of platforms that turn, and `b <= 90`, it is `f = U . j >= 0` and, unless certainly `b >= 90`,
/// `c^2 |U|^2 <= f^2` for `c = cos(b) |j|` and any positive multiple `U` of `A`. The second is
/// `sigma_max <= sqrt(f)` of the one row `c U/sqrt(f)`: a test that is affine in `U`, and so decided at
/// control points, where `w A` is a polynomial. With `|w A|^2` as another polynomial in place of the square
/// of the vector there, it would be unsound.
pub(super) fn tests(
    context: &mut Context<'_>,
    leg: &Leg,
    on_platform: bool,
) -> Result<Vec<Test>, ClaimError> {
    let bound = context.positive(context.greatest()?)?;
    ordered(context.place, bound, &Expression::integer(180), false)?;
    let Some((vector, length)) = leg.vector.zip(leg.rod()) else {
        return context.refused("of a leg with two ends");
    };
    let axis = context.all_given("axis")?;
    let (motion, turns) = (context.motion, context.claim.orientation.is_some());
    let in_plane = motion.velocity.len() == 2;
    if axis.len() != if in_plane { 2 } else { 3 } {
        return context.refused("given an axis of two numbers in the plane, or three in space");
    }
    let mut axis = context.direction(axis)?;
    let cos = context.input(Value::Cosine(bound.clone()));
    let tape = context.tape();
    axis.resize(3, tape.integer(0));
    let axis = [axis[0], axis[1], axis[2]];
    let least = formula!(tape; cos * (sqrt (axis . axis)));
    let right = Expression::integer(90);
    if let Some(ends) = leg.ends.filter(|_| turns && ordered("", bound, &right, false).is_ok()) {
        let u = motion.vector(tape, &ends, on_platform);
        let along = tape.dot(&u, &axis);
        let mut tests = vec![Test::AtLeast(along)];
        if ordered("", &right, bound, false).is_err() {
            let a = formula!(tape; least * u).to_vec();
            tests.push(Test::Greatest(vec![Row { a, d: along }], along));
        }
        return Ok(tests);
    }
    let axis = if on_platform { motion.turned(tape, &axis) } else { axis };
    Ok(vec![Test::AtLeast(formula!(tape; (vector . axis) - (least * length)))])
}
