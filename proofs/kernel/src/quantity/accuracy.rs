//! How far joint errors and manufacturing tolerances together put the platform from where it should be.

use super::{Context, Quantity, Test};
use crate::claim::{self, Mechanism};
use crate::formula::{formula, Formula, Op, Term};
use crate::input::{magnitude, malformed, ordered, ClaimError, Value};
use crate::machine::{motion::Motion, Joint, Leg};
use crate::number::Expression;
use crate::test::accuracy::Accuracy;

pub(super) const ACCURACY: Quantity = Quantity {
    key: "accuracy",
    symbol: "|P' - P|",
    words: "for joint coordinates within joint_error (each; of arms degrees, counted with their turns) of \
            those that the machine in the middle of all intervals has at P, every machine has exactly \
            one position P' so near to P with these joint coordinates, in the working modes named; \
            where the platform turns, exactly one pose so near, turned from the one at P by at most \
            max_angle degrees",
    given: &["joint_error"],
    given_turning: &["max_angle"],
    ..Quantity::of_machine(tests)
};

/// One [`Accuracy`] for all joints, and each part of what the platform is off by. Nothing is claimed of
/// joint limits, which an error may pass, nor of positions farther than the bound; `P'` need not be in the
/// workspace. With more joints than coordinates, joint coordinates near those commanded belong to no
/// position.
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    context.not_redundant()?;
    let max = context.positive(context.greatest()?)?;
    let error = context.given("joint_error")?;
    ordered(context.place, &Expression::integer(0), error, false)?;
    let error = error / max;
    let tolerances = half_widths(context, max);
    let by: Vec<Op> = tolerances.iter().map(|&(op, _)| op).collect();
    let mut joints = Vec::new();
    for leg in context.legs {
        let (error, slopes) = match leg.rho {
            Some(Joint::Length(rho)) => (context.number(&error, 0), context.derivatives(rho, &by)?),
            Some(Joint::Angle { cos, sin }) => {
                let scale = -context.builder.scale;
                let error = Value::Radians(error.clone());
                let error = context.builder.input(context.place, error, scale);
                (error, turned(context, [cos, sin], &by)?)
            }
            None => return context.refused("of joints whose coordinates the claim gives"),
        };
        let zero = context.tape().integer(0);
        let changes = match &leg.scaled {
            Some(row) => context.derivatives(row.d, &by)?,
            None => slopes.clone(),
        };
        let each = tolerances.iter().zip(slopes).zip(changes);
        let each = each.filter(|&((_, slope), _)| slope != zero);
        joints.push((error, each.map(|((&(_, half), slope), by)| [half, slope, by]).collect()));
    }
    let mut rows: Vec<_> = context.legs.iter().map(|leg| leg.divided.a.clone()).collect();
    let distance = context.number(max, 1);
    let scaled = context.legs.iter().map(|leg| leg.scaled.clone()).collect::<Option<_>>();
    let (mut scaled, weight): (Vec<_>, _) = (scaled.unwrap_or_default(), context.weight);
    let (turn, far) = match context.claim.orientation {
        None => (None, rows.clone()),
        Some(_) => {
            let all = rows.iter_mut().chain(scaled.iter_mut().map(|row| &mut row.a));
            let (tau, far) = turned_on(context, max, all)?;
            (Some((tau, context.motion.velocity.len())), far)
        }
    };
    let whole = Accuracy { part: 0..0, rows, far, scaled, weight, joints, distance, turn };
    let parts = whole.parts(whole.rows.len()).into_iter();
    Ok(parts.map(|part| Test::Accuracy(Accuracy { part, ..whole.clone() })).collect())
}

/// `tau`, and the far rows; columns of rows in `ell omega` become those in `u_c`: `omega = 2 c'` at `c = 0`,
/// and `c = tau u_c`.
fn turned_on<'r>(
    context: &mut Context<'_>,
    max: &Expression,
    rows: impl Iterator<Item = &'r mut Vec<Formula>>,
) -> Result<(Formula, Vec<Vec<Formula>>), ClaimError> {
    let angle = context.positive(context.given("max_angle")?)?;
    ordered(context.place, angle, &Expression::integer(180), true)?;
    let tau = context.input(Value::HalfTangent(angle.clone()));
    // tau/d, of the order of one, of two numbers of that order.
    let own = magnitude([max].into_iter());
    let own = own.ok_or_else(|| malformed(context.place, "a distance"))?;
    let of_one = Value::HalfTangent(angle.clone());
    let of_one = context.builder.input(context.place, of_one, own - context.builder.scale);
    let by = context.builder.number(context.place, max, own);
    let unit = context.tape().div(of_one, by);
    let (Mechanism::Planar(of) | Mechanism::Spatial(of) | Mechanism::Spherical(of)) =
        &context.claim.mechanism
    else {
        return context.refused("of legs with two ends");
    };
    let (motion, first) = (context.motion, context.motion.velocity.len());
    let Some(turn) = &motion.turn else { return context.refused("of a platform that turns") };
    let m = first + turn.spin.len();
    let tape = context.tape();
    let twice = formula!(tape; (2 * { turn.length }) * unit);
    let in_plane = m == first + 1;
    let c = std::array::from_fn(|k| match k {
        k if !in_plane => tape.coordinate(m + k),
        2 => tape.coordinate(m),
        _ => tape.integer(0),
    });
    for row in rows {
        row.iter_mut().skip(first).for_each(|entry| *entry = tape.mul(*entry, twice));
    }
    let motion = Motion { moved: Some(c), ..motion.clone() };
    let legs = context.builder.moved(&motion, &of.legs)?;
    let tape = context.tape();
    let far = |leg: &Leg| {
        let mut row = motion.onward(tape, &leg.driven?);
        row.iter_mut().skip(first).for_each(|entry| *entry = tape.mul(*entry, unit));
        Some(row)
    };
    let far: Option<Vec<_>> = legs.iter().map(far).collect();
    far.map_or_else(|| context.refused("of legs with two ends"), |far| Ok((tau, far)))
}

/// Of each toleranced parameter its half-width over `d`, in the units of formulas. With names of an atlas it is one
/// input: as a formula of these it would be as wide as if its two ends had different ones.
fn half_widths(context: &mut Context<'_>, d: &Expression) -> Vec<(Op, Formula)> {
    let two_d = &Expression::integer(2) * d;
    let width = |(j, input): (usize, &crate::input::Input)| {
        Some((Op::Parameter(j), &input.width()? / &two_d, input.scale))
    };
    let all: Vec<_> = context.builder.inputs.iter().enumerate().filter_map(width).collect();
    let (place, scale) = (context.place, context.builder.scale);
    let number = |(op, half, own): (Op, Expression, i64)| match half.varies() {
        true => {
            let half = Value::Quantity(claim::Quantity::Exactly(half));
            (op, context.builder.input(place, half, own - scale))
        }
        false => (op, context.builder.number(place, &half, own - scale)),
    };
    all.into_iter().map(number).collect()
}

/// `theta' = cos theta (sin theta)' - sin theta (cos theta)'`.
fn turned(
    context: &mut Context<'_>,
    [cos, sin]: [Formula; 2],
    by: &[Op],
) -> Result<Vec<Formula>, ClaimError> {
    let (d_cos, d_sin) = (context.derivatives(cos, by)?, context.derivatives(sin, by)?);
    let tape = context.tape();
    let each = |(c, s): (Formula, Formula)| formula!(tape; (cos * s) - (sin * c));
    Ok(d_cos.into_iter().zip(d_sin).map(each).collect())
}
