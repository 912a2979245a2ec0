//! The joint acceleration that a platform's acceleration and speed ask for.

use super::{Context, Quantity, Test};
use crate::formula::{coordinates, formula, Formula, Term};
use crate::input::{ordered, ClaimError, Value};
use crate::machine::{Joint, Leg};
use crate::number::Expression;
use crate::test::curvature::Curvature;

pub(super) const JOINT_ACCELERATION: Quantity = Quantity {
    key: "joint_acceleration",
    symbol: "|row_i of M| acceleration + |H_i| speed^2",
    words:
        "joint acceleration, H_i the second derivatives of rho_i; of arms, degrees per time squared; where \
         the platform turns, speed bounds |(v, ell omega)|, acceleration |(a, ell alpha)| of its motion",
    given: &["acceleration", "speed"],
    ..Quantity::of_legs(tests)
};

/// `rho'' = M_i . x'' + x'^T H_i x'`, of which the greatest absolute value for `|x''| <= a`,
/// `|x'| <= v` is `|M_i| a + |H_i| v^2`, `|H_i|` the spectral norm: both terms are attained, with one
/// sign, independently of each other. Divided by the bound, for `s = |eta_i|`, `t = L/s`, `l = |w|`:
///
/// ```text
/// slider   H = m (I - n n^T + r r^T/s^2)/s    |M_i| = L/s    |H| = (1 + |r|^2/s^2)/s = t^3/L
/// strut    H = (I - u u^T)/l                  |M_i| = 1      |H| = 1/l
/// ```
///
/// so that a sign shows it; of others, `H` is the derivative of the row. Where the platform turns, `x'` and
/// `x''` are `(v, ell omega)` and `(a, ell alpha)`, and `H` is [`Motion`](crate::machine::motion)'s.
/// There the row of a strut is `[u, (r x u)/ell]`, or the second part alone about a point, and with `q = 1` or `0` for the first
/// part, `|row|^2 = q + (|b|^2 - (r . u)^2)/ell^2`, as `|r| = |b|` and `|u| = 1`: its lever.
fn tests(context: &mut Context<'_>, (_, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    let max = context.positive(context.greatest()?)?;
    let zero = Expression::integer(0);
    let (acceleration, speed) = (context.given("acceleration")?, context.given("speed")?);
    for given in [acceleration, speed] {
        ordered(context.place, &zero, given, false)?;
    }
    let square = speed * speed;
    let mut over_max = |x: &Expression, units: i64| {
        let ratio = x / max;
        if !leg.is_angular() {
            return context.number(&ratio, units);
        }
        let ratio = context.number(&ratio, units + 1);
        let degree = context.input(Value::Radians(Expression::integer(1)));
        context.tape().div(ratio, degree)
    };
    let (a, b) = (over_max(acceleration, 0), over_max(&square, 1));
    if context.claim.orientation.is_some() {
        let motion = context.motion;
        let curved = leg
            .driven
            .zip(leg.tip)
            .map(|(driven, tip)| motion.curved(context.tape(), &driven, &tip));
        let Some(twice) = curved.flatten() else {
            return context.refused("of a leg that is driven");
        };
        let lever = leg.ends.zip(leg.driven).zip(motion.turn.as_ref());
        let tape = context.tape();
        let lever = lever.map(|(([_, at], [r, u]), turn)| {
            let q = tape.integer(i64::from(!motion.velocity.is_empty()));
            [
                formula!(tape; q + ((at . at) / ({ turn.length } ^ 2))),
                formula!(tape; (r . u) / { turn.length }),
            ]
        });
        context.builder.few()?;
        let row = leg.divided.a.clone();
        return Ok(vec![Test::Curvature(Curvature { row, twice, a, b, lever })]);
    }
    let rest = match (leg.rho, leg.length, leg.eta_squared) {
        (Some(Joint::Length(_)), Some(length), Some(square)) => {
            let tape = context.tape();
            let t = formula!(tape; length / (sqrt square));
            formula!(tape; 1 - (t * (a + ((b / length) * (t ^ 2)))))
        }
        (Some(Joint::Length(rho)), Some(length), None) if rho == length => {
            let tape = context.tape();
            formula!(tape; (1 - a) - (b / length))
        }
        _ => return Ok(vec![Test::Curvature(curvature(context, leg, [a, b])?)]),
    };
    Ok(vec![Test::AtLeast(rest)])
}

/// Of `|x'^T H x'|` only the symmetric part of `H` matters: twice that is what is held.
fn curvature(
    context: &mut Context<'_>,
    leg: &Leg,
    [a, b]: [Formula; 2],
) -> Result<Curvature, ClaimError> {
    let row = leg.divided.a.clone();
    let by = coordinates(row.len());
    let h = row.iter().map(|&f| context.derivatives(f, &by)).collect::<Result<Vec<_>, _>>()?;
    let tape = context.tape();
    let mut twice = Vec::new();
    for (j, own) in h.iter().enumerate() {
        let entry = |(&f, other): (&Formula, &Vec<Formula>)| tape.add(f, other[j]);
        twice.push(own.iter().zip(&h).skip(j).map(entry).collect());
    }
    Ok(Curvature { row, twice, a, b, lever: None })
}
