//! Joint coordinates `rho_i`.

use super::{Context, Quantity, Test};
use crate::claim::{Bound, Mechanism};
use crate::formula::{formula, Term};
use crate::input::{ordered, sign, ClaimError, Value};
use crate::machine::{Joint, Leg};
use crate::number::Expression;

pub(super) const JOINT_RANGE: Quantity = Quantity {
    key: "joint_range",
    symbol: "rho_i",
    words: "joint coordinates",
    ..Quantity::of_legs(tests)
};

/// A length has `rho - min >= 0` or `max - rho >= 0`, the first on the paper's cube by its lemma (joint
/// coordinates) where `min <= 0`; of a strut of a platform that turns, with bounds
/// that are not negative, `w D - w min^2 >= 0` or `w max^2 - w D >= 0`, polynomials, as `rho^2 = D` and
/// `w > 0`. An angle `theta` is in `[min, max]`, less than
/// 180 degrees wide, up to whole turns, if and only if `sin(theta - min) >= 0` and
/// `sin(max - theta) >= 0`: these are two half-planes through the axis, whose intersection is the
/// sector from `min` to `max`.
fn tests(context: &mut Context<'_>, (_, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    Ok(match (leg.rho, &context.requirement.bound) {
        (Some(Joint::Length(rho)), bound @ (Bound::Min(end) | Bound::Max(end))) => {
            let is_least = matches!(bound, Bound::Min(_));
            let is_nonnegative = |x: &Expression| matches!(sign(x), Some([_, true]));
            let scaled = leg.scaled.as_ref().zip(context.weight).filter(|_| is_nonnegative(end));
            let is_reached = matches!(context.claim.mechanism, Mechanism::Orthoglide { .. })
                && is_least
                && is_nonnegative(&Expression::Neg(end.clone().into()));
            let end = context.number(end, 1);
            let tape = context.tape();
            let (rho, end) = match scaled {
                None => (rho, end),
                Some((row, weight)) => (row.d, formula!(tape; (end ^ 2) * weight)),
            };
            let rest = if is_least { tape.sub(rho, end) } else { tape.sub(end, rho) };
            context.builder.reached.extend(Some(rest).filter(|_| is_reached));
            vec![Test::AtLeast(rest)]
        }
        (Some(Joint::Angle { cos, sin }), Bound::Within([min, max])) => {
            ordered(context.place, min, max, true)?;
            let half_turn = min + &Expression::integer(180);
            ordered(context.place, max, &half_turn, true)?;
            let mut end = |x: &Expression| {
                let cos = context.input(Value::Cosine(x.clone()));
                (cos, context.input(Value::Sine(x.clone())))
            };
            let ((cos_min, sin_min), (cos_max, sin_max)) = (end(min), end(max));
            let tape = context.tape();
            let after = formula!(tape; (sin * cos_min) - (cos * sin_min));
            let before = formula!(tape; (sin_max * cos) - (cos_max * sin));
            vec![Test::AtLeast(after), Test::AtLeast(before)]
        }
        (Some(Joint::Length(_)), Bound::Within(_) | Bound::Holds) => {
            return context.refused("one end of a length");
        }
        (Some(Joint::Angle { .. }), _) => return context.refused("both ends of an angle"),
        (None, _) => return context.refused("of a joint whose coordinate the claim gives"),
    })
}
