//! How far joint errors and manufacturing tolerances together put the platform from where it should be.

use super::{Context, Quantity, Test};
use crate::claim;
use crate::formula::{Formula, Op};
use crate::input::{binary, ordered, positive, ClaimError, Value};
use crate::machine::{Joint, Leg};
use crate::number::{Expression, Operator};
use crate::test::accuracy::Accuracy;

pub(super) const ACCURACY: Quantity = Quantity {
    key: "accuracy",
    symbol: "|P' - P|",
    words: "for joint coordinates within joint_error (each; of arms degrees, counted with their turns) of \
            those that the machine in the middle of all intervals has at P, every machine has exactly \
            one position P' so near to P with these joint coordinates, in the working modes named",
    of_legs: false,
    given: &["joint_error"],
    tests,
};

/// One [`Accuracy`] for all joints. Nothing is claimed of joint limits, which an error may pass, nor of
/// positions farther than the bound; `P'` need not be in the workspace. With more joints than
/// coordinates, joint coordinates near those commanded belong to no position.
fn tests(context: &mut Context<'_>, _: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    context.not_redundant()?;
    let max = context.greatest()?.clone();
    positive(context.place, &max)?;
    let error = context.given("joint_error")?.clone();
    ordered(context.place, &Expression::integer(0), &error, false)?;
    let error = binary(Operator::Div, &error, &max);
    let tolerances = half_widths(context, &max);
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
        let each = tolerances.iter().zip(slopes).filter(|&(_, slope)| slope != zero);
        joints.push((error, each.map(|(&(_, half), slope)| [half, slope]).collect()));
    }
    let rows = context.legs.iter().map(|leg| leg.divided.a.clone()).collect();
    let distance = context.number(&max, 1);
    Ok(vec![Test::Accuracy(Accuracy { rows, joints, distance })])
}

/// Of each toleranced parameter its half-width over `d`, in the units of formulas.
fn half_widths(context: &mut Context<'_>, d: &Expression) -> Vec<(Op, Formula)> {
    let two_d = binary(Operator::Mul, &Expression::integer(2), d);
    let width = |(j, input): (usize, &crate::input::Input)| match &input.value {
        Value::Quantity(claim::Quantity::Between { min, max }) => {
            let width = binary(Operator::Sub, max, min);
            Some((Op::Parameter(j), binary(Operator::Div, &width, &two_d), input.scale))
        }
        _ => None,
    };
    let all: Vec<_> = context.builder.inputs.iter().enumerate().filter_map(width).collect();
    let (place, scale) = (context.place, context.builder.scale);
    let number = |(op, half, own)| (op, context.builder.number(place, &half, own - scale));
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
    let each = |(c, s): (Formula, Formula)| {
        let (p, q) = (tape.mul(cos, s), tape.mul(sin, c));
        tape.sub(p, q)
    };
    Ok(d_cos.into_iter().zip(d_sin).map(each).collect())
}
