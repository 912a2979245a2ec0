//! Bodies do not collide.

use super::{Context, Quantity, Test};
use crate::claim::{Body, Mechanism};
use crate::formula::{formula, Formula, Term, Vector};
use crate::input::{ordered, positive, ClaimError};
use crate::number::Expression;
use crate::test::apart::Apart;

pub(super) const CLEARANCE: Quantity = Quantity {
    key: "clearance",
    symbol: "the distance of any two of the bodies that are not fixed to each other",
    words:
        "fixed to each other are two bodies on the base, two on the platform, and two on one leg, unless \
         one is beside it: then the distance is that of the lines along them",
    ..Quantity::of_machine(tests)
};

/// Most bodies.
const MOST_BODIES: usize = 24;

/// A body's segment, its radius, and what it is fixed to.
struct Capsule<'a> {
    ends: [Vector; 2],
    radius: &'a Expression,
    fixed_to: FixedTo,
    /// Beside the leg.
    offset: Option<Vector>,
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
/// Two bodies of one leg, of which one or both are beside it, are parallel: see [`beside`].
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    let gap = context.least()?;
    ordered(context.place, &Expression::integer(0), gap, false)?;
    let bodies = &context.claim.bodies;
    let legs = !matches!(context.claim.mechanism, Mechanism::Formulas(_));
    if !legs || bodies.len() > MOST_BODIES {
        return context.refused("of legs with two ends, and of 24 bodies at most");
    }
    let is_single = |body: &Body| !matches!(body, Body::Leg { offset: Some(_), .. });
    if context.claim.orientation.is_some() && !bodies.iter().all(is_single) {
        return context.refused("of single rods, where the platform turns");
    }
    let all = bodies.iter().map(|body| capsule(context, body));
    let all: Vec<Capsule<'_>> = all.collect::<Result<_, _>>()?;
    let mut tests = Vec::new();
    for (i, one) in all.iter().enumerate() {
        for (j, other) in all.iter().enumerate().take(i) {
            let apart = other.fixed_to != one.fixed_to;
            if !apart && one.offset.or(other.offset).is_none() {
                continue;
            }
            let radii = one.radius + other.radius;
            let distance = context.number(&(&radii + gap), 1);
            let (bodies, ends) = ([i + 1, j + 1], [one.ends, other.ends]);
            tests.push(match one.fixed_to {
                FixedTo::Leg(leg) if !apart => beside(context, leg, [one, other], distance)?,
                _ => Test::Apart(Apart { bodies, ends, distance }),
            });
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
    let mut beside = None;
    let (ends, fixed_to) = match body {
        Body::Leg { leg, trim, offset, .. } => {
            let mut ends = trimmed(context, *leg, trim)?;
            if let Some(offset) = offset {
                let offset = *beside.insert(at(context, offset));
                let tape = context.tape();
                ends = ends.map(|end| formula!(tape; end + offset));
            }
            (ends, FixedTo::Leg(*leg))
        }
        Body::Base { from, to, .. } => ([from, to].map(|end| at(context, end)), FixedTo::Base),
        Body::Platform { from, to, .. } => {
            let on_platform = |end| {
                let (end, motion) = (at(context, end), context.motion);
                let tape = context.tape();
                let end = motion.turned(tape, &end);
                formula!(tape; { motion.position } + end)
            };
            ([from, to].map(on_platform), FixedTo::Platform)
        }
    };
    Ok(Capsule { ends, radius, fixed_to, offset: beside })
}

fn at(context: &mut Context<'_>, point: &[Expression; 3]) -> Vector {
    std::array::from_fn(|k| context.number(&point[k], 1))
}

/// A leg's platform end, length and vector.
fn parts(context: &Context<'_>, leg: usize) -> Result<(Vector, Formula, Vector), ClaimError> {
    let leg = leg.checked_sub(1).and_then(|leg| context.legs.get(leg));
    let parts = leg.and_then(|leg| Some((leg.tip?, leg.rod()?, leg.vector?)));
    parts.map_or_else(|| context.refused("of a leg that there is, with two ends"), Ok)
}

/// `|d|^2 - (d . A)^2/L^2 - R^2 >= 0`, for two bodies along the leg's vector `A`, of length `L`, that are
/// `d` beside each other: the lines along them have the distance
/// `|d - (d . A) A/L^2| = sqrt(|d|^2 - (d . A)^2/L^2)`, and the bodies no smaller one.
fn beside(
    context: &mut Context<'_>,
    leg: usize,
    both: [&Capsule<'_>; 2],
    distance: Formula,
) -> Result<Test, ClaimError> {
    let (_, length, a) = parts(context, leg)?;
    let tape = context.tape();
    let zero = tape.integer(0);
    let [d, other] = both.map(|body| body.offset.unwrap_or([zero; 3]));
    let d = formula!(tape; d - other);
    let square = formula!(tape; (d . d) - (((d . a) ^ 2) / (length ^ 2)));
    Ok(Test::AtLeast(formula!(tape; square - (distance ^ 2))))
}

/// From `C - A + (trim_1/L) A` to `C - (trim_2/L) A`, `C` the leg's platform end, `A` its vector. Of a strut
/// `C - A` is its own base end, which no slope widens.
fn trimmed(
    context: &mut Context<'_>,
    leg: usize,
    trim: &[Expression; 2],
) -> Result<[Vector; 2], ClaimError> {
    for trim in trim {
        ordered(context.place, &Expression::integer(0), trim, false)?;
    }
    let (tip, length, a) = parts(context, leg)?;
    let [from, to] = [&trim[0], &trim[1]].map(|trim| context.number(trim, 1));
    let (own, tape) = (context.legs[leg - 1].ends, context.tape());
    let from = match own {
        Some([base, _]) => formula!(tape; base + ((from / length) * a)),
        None => formula!(tape; tip - ((1 - (from / length)) * a)),
    };
    Ok([from, formula!(tape; tip - ((to / length) * a))])
}
