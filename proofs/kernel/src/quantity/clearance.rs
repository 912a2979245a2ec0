//! Bodies do not collide.

use super::{Context, Quantity, Test};
use crate::claim::{Body, Mechanism};
use crate::formula::Vector;
use crate::input::{binary, ordered, positive, ClaimError};
use crate::machine::Leg;
use crate::number::{Expression, Operator};
use crate::test::apart::Apart;

pub(super) const CLEARANCE: Quantity = Quantity {
    key: "clearance",
    symbol: "the distance of any two of the bodies that are not fixed to each other",
    words:
        "fixed to each other are two bodies on one leg, two on the base, and two on the platform",
    of_legs: false,
    given: &[],
    tests,
};

/// Most bodies.
const MOST_BODIES: usize = 24;

/// A body's segment, its radius, and what it is fixed to.
struct Capsule<'a> {
    ends: [Vector; 2],
    radius: &'a Expression,
    fixed_to: FixedTo,
}

#[derive(PartialEq)]
enum FixedTo {
    Base,
    Platform,
    Leg(usize),
}

/// Bodies `i` and `j` are nowhere nearer than `b >= 0` if their segments are farther apart than
/// `R = r_i + r_j + b`.
///
/// Every two bodies are meant that are not fixed to the same link: not those of one leg, of the base, of
/// the platform, whose distance does not change with the position. A rod and a body on the base or the
/// platform that it is joined to are meant: where they touch by design, the trim ends the rod before
/// that. Where trims are longer than the leg, the rod is still the segment between the two points.
fn tests(context: &mut Context<'_>, _: Option<&Leg>) -> Result<Vec<Test>, ClaimError> {
    context.without_rotation()?;
    let gap = context.least()?.clone();
    ordered(context.place, &Expression::integer(0), &gap, false)?;
    let bodies = &context.claim.bodies;
    let legs = &context.claim.mechanism;
    let legs = matches!(legs, Mechanism::Translational(_) | Mechanism::Orthoglide { .. });
    if !legs || bodies.len() > MOST_BODIES {
        return context.refused("of legs in space, and of 24 bodies at most");
    }
    let all = bodies.iter().map(|body| capsule(context, body));
    let all: Vec<Capsule<'_>> = all.collect::<Result<_, _>>()?;
    let mut tests = Vec::new();
    for (i, one) in all.iter().enumerate() {
        let others = all.iter().enumerate().take(i);
        for (j, other) in others.filter(|(_, other)| other.fixed_to != one.fixed_to) {
            let radii = binary(Operator::Add, one.radius, other.radius);
            let distance = context.number(&binary(Operator::Add, &radii, &gap), 1);
            let (bodies, ends) = ([i + 1, j + 1], [one.ends, other.ends]);
            tests.push(Test::Apart(Apart { bodies, ends, distance }));
        }
    }
    if tests.is_empty() {
        return context.refused("of two bodies that are not fixed to each other");
    }
    Ok(tests)
}

fn capsule<'a>(context: &mut Context<'_>, body: &'a Body) -> Result<Capsule<'a>, ClaimError> {
    let (Body::Leg { radius, .. } | Body::Base { radius, .. } | Body::Platform { radius, .. }) =
        body;
    positive(context.place, radius)?;
    let (ends, fixed_to) = match body {
        Body::Leg { leg, trim, .. } => (trimmed(context, *leg, trim)?, FixedTo::Leg(*leg)),
        Body::Base { from, to, .. } => ([from, to].map(|end| at(context, end)), FixedTo::Base),
        Body::Platform { from, to, .. } => {
            let on_platform = |end| {
                let end = at(context, end);
                let tape = context.tape();
                let p = std::array::from_fn(|k| tape.coordinate(k));
                tape.plus(&p, &end)
            };
            ([from, to].map(on_platform), FixedTo::Platform)
        }
    };
    Ok(Capsule { ends, radius, fixed_to })
}

fn at(context: &mut Context<'_>, point: &[Expression; 3]) -> Vector {
    std::array::from_fn(|k| context.number(&point[k], 1))
}

/// From `C - A + (trim_1/L) A` to `C - (trim_2/L) A`, `C` the leg's platform end, `A` its vector.
fn trimmed(
    context: &mut Context<'_>,
    leg: usize,
    trim: &[Expression; 2],
) -> Result<[Vector; 2], ClaimError> {
    for trim in trim {
        ordered(context.place, &Expression::integer(0), trim, false)?;
    }
    let leg = leg.checked_sub(1).and_then(|leg| context.legs.get(leg));
    let parts =
        leg.and_then(|leg| Some((leg.tip?, leg.rod()?, leg.row.a.as_slice().try_into().ok()?)));
    let Some((tip, length, a)) = parts else {
        return context.refused("of a leg that there is, with two ends");
    };
    let a: Vector = a;
    let [from, to] = [&trim[0], &trim[1]].map(|trim| context.number(trim, 1));
    let tape = context.tape();
    let (from, to) = (tape.div(from, length), tape.div(to, length));
    let one = tape.integer(1);
    let rest = tape.sub(one, from);
    let [from, to] = [rest, to].map(|part| tape.scaled(part, &a));
    Ok([tape.minus(&tip, &from), tape.minus(&tip, &to)])
}
