//! What it costs to check something, estimated before it is done: an atlas compiles its claim in every
//! cell, and a short text may ask for much.
//!
//! A unit is a tenth of a microsecond or so. The estimates are of the dearest inputs that were found;
//! that they are not exceeded by much is measured, not proved, and nothing that is accepted rests on
//! it.

use crate::certificate::{Tree, MOST_WORK};
use crate::formula::Op;
use crate::input::{Input, Value};
use crate::number::{Expression, Operator};
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::vary::Numbers;
use serde::Serialize;

/// What the tree of a single machine, or of a cube, may ask for.
pub(crate) const OF_ONE: usize = 8 * MOST_WORK;
/// Units of work for each byte of an atlas: twice [`LEAST_BYTES`] take a second or so.
pub const WORK_A_BYTE: usize = 36;
/// Work of a tree (`step/work.rs`) that is a unit.
pub(crate) const OF_TREES: usize = 96;
/// It may ask for the work of so many bytes, however short it is.
pub const LEAST_BYTES: usize = 100_000;

/// The bytes of a text.
pub(crate) fn bytes(part: &impl Serialize) -> usize {
    serde_json::to_string(part).map_or(0, |text| text.len())
}

/// Takes so many units of what is left.
///
/// # Errors
/// If there are not so many.
pub(crate) fn spend(left: &mut usize, units: usize) -> Result<(), Rejected> {
    *left = left.checked_sub(units).ok_or(Rejected::Work)?;
    Ok(())
}

/// What numbers cost, each of which is evaluated several times: an operation on rational numbers of `b` bits
/// the square of `b`; one on slopes in parameters eight times as much as another.
pub(crate) fn of_each(of: &mut impl Numbers) -> usize {
    let each = of.numbers_mut().into_iter().map(|x| 2usize.saturating_mul(size(x).0));
    each.fold(0, usize::saturating_add)
}

/// What an expression costs, the bits that it has as a rational number, and whether it varies.
fn size(x: &Expression) -> (usize, usize, bool) {
    let both = |(work, bits, varies): (usize, usize, bool), part: &Expression| {
        let own = size(part);
        (work.saturating_add(own.0), bits.saturating_add(own.1), varies || own.2)
    };
    let (parts, bits, varies) = x.parts().fold((0, 0, matches!(x, Expression::Varying(_))), both);
    let (each, bits) = match x {
        Expression::Literal { digits, places } => {
            let bits = usize::try_from(digits.bits()).unwrap_or(usize::MAX);
            (2, bits.saturating_add(4 * *places as usize))
        }
        Expression::Name(_) | Expression::Varying(_) | Expression::Neg(_) => (2, bits),
        Expression::Sqrt(_) => (60, bits),
        Expression::Power(_, n) => (4 * *n as usize, bits.saturating_mul(*n as usize)),
        Expression::Binary(Operator::Div, ..) => (8, bits),
        Expression::Binary(..) => (4, bits),
    };
    let each = if varies { 8 * each } else { each };
    let each = each.saturating_add(bits.saturating_mul(bits) >> 14);
    (parts.saturating_add(each), bits, varies)
}

/// The operations of a problem's tape, of which roots and quotients cost more.
fn weight(problem: &Problem) -> usize {
    let weight = |op: &Op| match op {
        Op::Sqrt(_) => 10,
        Op::Elbow(..) => 40,
        Op::Div(..) => 3,
        _ => 1,
    };
    problem.tape.ops().iter().map(weight).sum()
}

/// What the formulas cost of which a problem is made, and its angles.
pub(crate) fn of_problem(problem: &Problem) -> usize {
    4 * weight(problem) + of_angles(problem)
}

/// What angles cost, at any precision.
fn of_angles(problem: &Problem) -> usize {
    let of = |input: &Input| match input.value {
        Value::Quantity(_) => 1,
        Value::Cosine(_) | Value::Sine(_) | Value::Radians(_) | Value::HalfTangent(_) => 300,
        Value::TiltReach(..) => 600,
    };
    problem.inputs.iter().map(of).sum()
}

/// Numbers of more bits cost more.
fn words(precision: u32) -> usize {
    1 + precision as usize / 256
}

/// What the angles of a tree cost, beside its own work (`step/work.rs`).
pub(crate) fn of_numbers(problem: &Problem, tree: &Tree) -> usize {
    of_angles(problem).saturating_mul(words(tree.precision))
}

/// What a witness costs.
pub(crate) fn of_witness(problem: &Problem, precision: u32) -> usize {
    let all = 4 * weight(problem) + problem.work() + of_angles(problem);
    all.saturating_mul(words(precision))
}
