//! Joint coordinates `rho_i`.

use super::{Context, Quantity, Test};
use crate::claim::{Bound, Mechanism};
use crate::input::{binary, ordered, sign, ClaimError, Value};
use crate::machine::{Joint, Leg};
use crate::number::{Expression, Operator};

pub(super) const JOINT_RANGE: Quantity = Quantity {
    key: "joint_range",
    symbol: "rho_i",
    words: "joint coordinates",
    of_legs: true,
    given: &[],
    given_turning: &[],
    tests,
};

/// A length has `rho - min >= 0` or `max - rho >= 0`, the first on the paper's cube by its lemma (joint
/// coordinates) where `min <= 0`; of a strut of a platform that turns, with bounds
/// that are not negative, `w D - w min^2 >= 0` or `w max^2 - w D >= 0`, polynomials, as `rho^2 = D` and
/// `w > 0`. An angle `theta` is in `[min, max]`, less than
/// 180 degrees wide, up to whole turns, if and only if `sin(theta - min) >= 0` and
/// `sin(max - theta) >= 0`: these are two half-planes through the axis, whose intersection is the
/// sector from `min` to `max`.
fn tests(context: &mut Context<'_>, leg: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    let rho = leg.and_then(|leg| leg.rho);
    let scaled = leg.and_then(|leg| leg.scaled.as_ref()).map(|row| row.d).zip(context.weight);
    if let (Some((d, weight)), Bound::Min(b) | Bound::Max(b)) = (scaled, &context.requirement.bound)
    {
        if matches!(sign(b), Some([_, true])) {
            let b = context.number(b, 1);
            let tape = context.tape();
            let square = tape.sqr(b);
            let bound = tape.mul(square, weight);
            return Ok(vec![Test::AtLeast(match context.requirement.bound {
                Bound::Min(_) => context.tape().sub(d, bound),
                _ => context.tape().sub(bound, d),
            })]);
        }
    }
    Ok(match (rho, &context.requirement.bound) {
        (Some(Joint::Length(rho)), Bound::Min(min)) => {
            let is_cube = matches!(context.claim.mechanism, Mechanism::Orthoglide { .. });
            let least = Expression::Neg(min.clone().into());
            let min = context.number(min, 1);
            let rest = context.tape().sub(rho, min);
            if is_cube && matches!(sign(&least), Some([_, true])) {
                context.builder.reached.push(rest);
            }
            vec![Test::AtLeast(rest)]
        }
        (Some(Joint::Length(rho)), Bound::Max(max)) => {
            let max = context.number(max, 1);
            vec![Test::AtLeast(context.tape().sub(max, rho))]
        }
        (Some(Joint::Angle { cos, sin }), Bound::Within([min, max])) => {
            ordered(context.place, min, max, true)?;
            let half_turn = binary(Operator::Add, min, &Expression::integer(180));
            ordered(context.place, max, &half_turn, true)?;
            let mut end = |x: &Expression| {
                let cos = context.input(Value::Cosine(x.clone()));
                (cos, context.input(Value::Sine(x.clone())))
            };
            let ((cos_min, sin_min), (cos_max, sin_max)) = (end(min), end(max));
            let tape = context.tape();
            let mut turned = |a, b, c, d| {
                let (p, q) = (tape.mul(a, b), tape.mul(c, d));
                Test::AtLeast(tape.sub(p, q))
            };
            vec![turned(sin, cos_min, cos, sin_min), turned(sin_max, cos, cos_max, sin)]
        }
        (Some(Joint::Length(_)), Bound::Within(_) | Bound::Holds) => {
            return context.refused("one end of a length");
        }
        (Some(Joint::Angle { .. }), _) => return context.refused("both ends of an angle"),
        (None, _) => return context.refused("of a joint whose coordinate the claim gives"),
    })
}
