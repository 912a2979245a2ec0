//! The claims of a cell of parameters: one that implies that of every design in it, and one that
//! that of every design in it implies.

use super::role::Role;
use super::AtlasError;
use crate::claim::{Leg, MachineClaim, Mechanism, Quantity};
use crate::number::{Exact, NumberErrorKind};
use std::cmp::Ordering;

/// A range of values: `[min, max]`, `min <= max`.
pub type Ends = (Exact, Exact);

/// Which claim of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The strictest one.
    Strictest,
    /// The loosest one.
    Loosest,
}

/// The claim of a cell on one side; `values` are the ranges of the parameters there.
///
/// **Lemma.** For parameters `theta`, let `C(theta)` be the design's claim with the numbers that its
/// expressions have there, each of which is in its range over the cell ([`range`]); a parameter of
/// its machines takes every value between the two numbers that its ends have, whichever is the
/// lesser. *Strictest*: if this claim is true, so is `C(theta)` for every `theta` of the cell.
/// *Proof.* Every parameter of a machine of `C(theta)` is in the interval that it has here, the hull
/// of the ranges of its ends; so every such machine, and there is one, is one of this claim's. A
/// number that strengthens the claim has its greatest value here, one that weakens it its least: the
/// workspace here contains that of `C(theta)`, and every bound here implies that of `C(theta)`. ∎
/// *Loosest*: the machines are the same, the other numbers have their opposite ends: the workspace
/// here is within that of `C(theta)`, and what violates a bound here violates that of `C(theta)`. So
/// if **every** machine of this claim violates it at one point of its workspace, `C(theta)` is false
/// for every `theta` of the cell, as it has a machine. ∎
///
/// # Errors
/// If a range cannot be told, a name is unknown, or a number that is neither varies.
pub fn instance(
    design: &MachineClaim,
    values: &[(&str, Ends)],
    side: Side,
) -> Result<MachineClaim, AtlasError> {
    let mut claim = design.try_map(&mut |x, role| {
        if !x.is_open() || matches!(role, Role::Least | Role::Greatest) {
            return Ok(x.clone());
        }
        let (least, greatest) = range(x, values)?;
        let (upper, lower) = match side {
            Side::Strictest => (Role::Strengthens, Role::Weakens),
            Side::Loosest => (Role::Weakens, Role::Strengthens),
        };
        match role {
            _ if role == upper => Ok(greatest),
            _ if role == lower => Ok(least),
            _ if least == greatest => Ok(least),
            _ => Err(AtlasError::Varies(x.to_string())),
        }
    })?;
    if let Mechanism::Translational(legs) = &mut claim.mechanism {
        for quantity in legs.iter_mut().flat_map(Leg::parameters_mut) {
            *quantity = hull(quantity, values)?;
        }
    }
    Ok(claim)
}

/// The hull of the ranges of both ends, where one is open.
fn hull(quantity: &Quantity, values: &[(&str, Ends)]) -> Result<Quantity, AtlasError> {
    if !quantity.min.is_open() && !quantity.max.is_open() {
        return Ok(quantity.clone());
    }
    let (a, b) = range(&quantity.min, values)?;
    if quantity.is_exact() {
        return Ok(Quantity { min: a, max: b });
    }
    let (c, d) = range(&quantity.max, values)?;
    let (min, max) =
        (chosen(Some(a), &c, Ordering::Less)?, chosen(Some(b), &d, Ordering::Greater)?);
    Ok(Quantity { min, max })
}

/// The range of an expression: every value that it has for parameters in their ranges is between
/// its ends (natural interval extension, in exact arithmetic: nothing is rounded).
///
/// # Errors
/// If a name has no range, an order is not decided, or a divisor or radicand is not provably
/// admissible over the whole range.
pub fn range(x: &Exact, values: &[(&str, Ends)]) -> Result<Ends, AtlasError> {
    let of = |x: &Exact| range(x, values);
    Ok(match x {
        Exact::Rational(_) => (x.clone(), x.clone()),
        Exact::Name(name) => {
            let known = values.iter().find(|(known, _)| **known == **name);
            known
                .map(|(_, ends)| ends.clone())
                .ok_or_else(|| AtlasError::Unknown(name.to_string()))?
        }
        Exact::Neg(x) => {
            let (least, greatest) = of(x)?;
            (greatest.negated(), least.negated())
        }
        Exact::Add(x, y) => {
            let ((a, b), (c, d)) = (of(x)?, of(y)?);
            pair((a, c), (b, d), Exact::plus)?
        }
        Exact::Sub(x, y) => {
            let ((a, b), (c, d)) = (of(x)?, of(y)?);
            pair((a, d), (b, c), Exact::minus)?
        }
        Exact::Mul(x, y) => bilinear(of(x)?, of(y)?, times)?,
        Exact::Div(x, y) => {
            let (c, d) = of(y)?;
            // One strict sign at both ends: no zero between.
            match (c.sign(), d.sign()) {
                (Some(1), Some(1)) | (Some(-1), Some(-1)) => bilinear(of(x)?, (c, d), Exact::over)?,
                _ => return Err(AtlasError::Number(NumberErrorKind::DivisorMayBeZero)),
            }
        }
        Exact::Sqrt(x) => {
            let (least, greatest) = of(x)?;
            (least.root()?, greatest.root()?)
        }
    })
}

type Operation = fn(Exact, Exact) -> Result<Exact, NumberErrorKind>;

fn pair(lower: Ends, upper: Ends, operation: Operation) -> Result<Ends, AtlasError> {
    let least = operation(lower.0.clone(), lower.1.clone())?;
    if lower == upper {
        return Ok((least.clone(), least));
    }
    Ok((least, operation(upper.0, upper.1)?))
}

/// `x y`, where a rational zero makes a rational zero.
fn times(x: Exact, y: Exact) -> Result<Exact, NumberErrorKind> {
    let zero = Exact::integer(0);
    if x == zero || y == zero {
        Ok(zero)
    } else {
        x.times(y)
    }
}

/// The least and greatest of an operation that is monotone in each operand (for fixed others): they
/// are among its values at the four pairs of ends.
fn bilinear(x: Ends, y: Ends, operation: Operation) -> Result<Ends, AtlasError> {
    let mut least: Option<Exact> = None;
    let mut greatest: Option<Exact> = None;
    let distinct =
        |(a, b): &Ends| if a == b { vec![a.clone()] } else { vec![a.clone(), b.clone()] };
    for a in distinct(&x) {
        for b in distinct(&y) {
            let value = operation(a.clone(), b)?;
            least = Some(chosen(least, &value, Ordering::Less)?);
            greatest = Some(chosen(greatest, &value, Ordering::Greater)?);
        }
    }
    // Both have at least one value.
    least.zip(greatest).ok_or(AtlasError::Order)
}

/// The better of two numbers in the sense of `order`.
fn chosen(best: Option<Exact>, value: &Exact, order: Ordering) -> Result<Exact, AtlasError> {
    let Some(best) = best else {
        return Ok(value.clone());
    };
    match value.compare(&best) {
        None => Err(AtlasError::Order),
        Some(found) if found == order => Ok(value.clone()),
        Some(_) => Ok(best),
    }
}
