//! Numbers that formulas depend on, enclosed; what a claim's numbers have to be.

use crate::arithmetic::{Arithmetic as _, Enclosure as _};
use crate::claim::Quantity;
use crate::fixed::{Fixed, Integer, Interval};
use crate::number::Expression;
use crate::slope::{Slope, Slopes};
use crate::trig::{cos_sin, pi, shortened};
use crate::vary::{self, MOST_PARAMETERS};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use thiserror::Error;

/// Bits in which a claim is held to be well formed.
pub(crate) const SIGN_BITS: u32 = 512;

/// Why a claim is not well formed: what something in it has to be, and is not or not certainly.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{place}: has to be {expected}")]
pub struct ClaimError {
    /// Where it stands.
    pub place: String,
    /// What it has to be.
    pub expected: &'static str,
}

pub(crate) fn malformed(place: &str, expected: &'static str) -> ClaimError {
    ClaimError { place: place.to_owned(), expected }
}

/// A number that formulas depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Where it stands in the claim.
    pub place: String,
    /// Its value, or what is made of it.
    pub value: Value,
    /// Formulas have it divided by `2^scale`.
    pub scale: i64,
}

/// What an input is.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A quantity of the claim.
    Quantity(Quantity),
    /// The cosine of an angle in degrees.
    Cosine(Expression),
    /// The sine of an angle in degrees.
    Sine(Expression),
    /// An angle in degrees, in radians.
    Radians(Expression),
    /// The tangent of half an angle in degrees, between -180 and 180.
    HalfTangent(Expression),
    /// `t sqrt(1 + s^2)`, `t` and `s` the tangents of half of these.
    TiltReach(Expression, Expression),
}

/// Encloses a number with `bits` fractional bits, for every value of its names.
fn of_all(number: &Expression, bits: u32) -> Option<Interval<BigInt>> {
    if number.varies() {
        vary::enclose(number, bits)
    } else {
        number.enclose(bits)
    }
}

/// What is found with more bits, after division by `2^scale` with `bits` fractional bits: 64 are left after the
/// division, which rounds outward.
fn scaled<T>(
    scale: i64,
    bits: u32,
    of: impl FnOnce(u32, &dyn Fn(&Interval<BigInt>) -> Interval<BigInt>) -> Option<T>,
) -> Option<T> {
    let guard = 64 + u32::try_from((-scale).max(0)).ok()?;
    // x / 2^working / 2^scale 2^bits = x / 2^(guard + scale), with guard + scale >= 64.
    let places = u32::try_from(i64::from(guard) + scale).ok()?;
    of(bits.checked_add(guard)?, &|x| shortened(x, places))
}

/// Encloses a number with `bits` fractional bits, after division by `2^scale`.
pub(crate) fn enclosed(number: &Expression, scale: i64, bits: u32) -> Option<Interval<BigInt>> {
    scaled(scale, bits, |working, by| Some(by(&of_all(number, working)?)))
}

/// The same in slopes in an atlas's parameters.
pub(crate) fn sloped(
    number: &Expression,
    scale: i64,
    bits: u32,
) -> Option<Slope<Interval<BigInt>>> {
    scaled(scale, bits, |working, by| {
        let x = vary::sloped(number, &Slopes::new(&Fixed::new(working), MOST_PARAMETERS))?;
        let (at_centre, range) = (by(&x.at_centre), by(&x.range));
        Some(Slope { at_centre, range, slopes: x.slopes.map(|x| by(&x)) })
    })
}

impl Input {
    /// Whether it has a least and a greatest value.
    pub fn has_two_ends(&self) -> bool {
        matches!(self.value, Value::Quantity(Quantity::Between { .. }))
    }

    /// How far its ends are apart.
    pub fn width(&self) -> Option<Expression> {
        match &self.value {
            Value::Quantity(Quantity::Between { min, max }) => Some(max - min),
            _ => None,
        }
    }

    /// Whether machines differ by it: so, or by a name of an atlas.
    pub fn differs(&self) -> bool {
        use Expression::Varying;
        let is_name = matches!(self.value, Value::Quantity(Quantity::Exactly(Varying(_))));
        is_name || self.has_two_ends()
    }

    /// Encloses it with `bits` fractional bits. `machine` replaces an interval.
    pub fn enclose(&self, bits: u32, machine: Option<&Expression>) -> Option<Interval<BigInt>> {
        match &self.value {
            Value::Quantity(Quantity::Exactly(x)) => enclosed(x, self.scale, bits),
            Value::Quantity(Quantity::Between { min, max }) => {
                if let Some(x) = machine {
                    return enclosed(x, self.scale, bits);
                }
                let (min, max) =
                    (enclosed(min, self.scale, bits)?, enclosed(max, self.scale, bits)?);
                Some(Interval { lo: min.lo, hi: max.hi })
            }
            Value::Cosine(degrees) => {
                cos_sin(|bits| degrees.enclose(bits), bits).map(|[cos, _]| cos)
            }
            Value::Sine(degrees) => cos_sin(|bits| degrees.enclose(bits), bits).map(|[_, sin]| sin),
            Value::Radians(degrees) => {
                let fixed = Fixed::<BigInt>::new(bits);
                let x = enclosed(degrees, self.scale, bits)?;
                fixed.div(&fixed.mul(&x, &pi(bits)?)?, &fixed.integer(180)?)
            }
            Value::HalfTangent(degrees) => half_tangent(degrees, self.scale, bits),
            Value::TiltReach(tilt, torsion) => {
                let fixed = Fixed::<BigInt>::new(bits);
                let of = |degrees| half_tangent(degrees, 0, bits);
                let [t, s] = [of(tilt)?, of(torsion)?];
                let square = fixed.add(&fixed.integer(1)?, &fixed.sqr(&s)?)?;
                fixed.mul(&t, &fixed.sqrt(&square)?)
            }
        }
    }
}

/// `tan(x/2) = sin x/(1 + cos x)` divided by `2^scale`, which of 0 is exactly 0; with 64 guard bits. It increases
/// between -180 and 180: for all values of names, it lies between those of the ends of an enclosure in there.
pub(crate) fn half_tangent(
    degrees: &Expression,
    scale: i64,
    bits: u32,
) -> Option<Interval<BigInt>> {
    if degrees.rational().is_some_and(|x| x.is_zero()) {
        return Some(Interval::point(BigInt::from(0)));
    }
    let of = |part: fn(Interval<BigInt>) -> Interval<BigInt>| {
        let angle = |bits: u32| {
            let (x, most) = (degrees.enclose(bits)?, BigInt::from(180) << bits);
            (-&most < x.lo && x.hi < most).then(|| part(x))
        };
        scaled(scale, bits, |working, by| {
            let fixed = Fixed::<BigInt>::new(working);
            let [cos, sin] = cos_sin(angle, working)?;
            let over = fixed.recip(&fixed.add(&fixed.integer(1)?, &cos)?)?;
            Some(by(&fixed.mul(&sin, &over)?))
        })
    };
    if !degrees.varies() {
        return of(|x| x);
    }
    let ends = of(|x| Interval::point(x.lo)).zip(of(|x| Interval::point(x.hi)));
    ends.map(|(least, greatest)| Interval { lo: least.lo, hi: greatest.hi })
}

/// The exponent of the power of two that is at most the greatest absolute value; 0 if all are zero. A
/// choice of unit, with no effect on what is true.
pub(crate) fn magnitude<'a>(numbers: impl Iterator<Item = &'a Expression>) -> Option<i64> {
    let (mut greatest, mut last) = (None, None);
    for x in numbers {
        // Both ends of an exact number, and equal legs.
        if last.replace(x) == Some(x) {
            continue;
        }
        let x = x.enclose(SIGN_BITS)?;
        let bits = x.lo.abs().max(x.hi.abs()).bits();
        if bits > 0 {
            greatest = greatest.max(Some(i64::try_from(bits).ok()? - 1 - i64::from(SIGN_BITS)));
        }
    }
    Some(greatest.unwrap_or(0))
}

/// Whether a number is certainly greater than zero, or not less. As a fraction, which costs more, only
/// where an enclosure does not tell.
pub(crate) fn sign(x: &Expression) -> Option<[bool; 2]> {
    let signs = |x: &Interval<BigInt>| [x.lo.is_positive(), !x.lo.is_negative()];
    let enclosed = of_all(x, SIGN_BITS);
    match &enclosed {
        Some(x) if x.lo.is_positive() || x.hi.is_negative() => Some(signs(x)),
        _ => match x.rational() {
            Some(x) => Some([x.is_positive(), !x.is_negative()]),
            None => enclosed.as_ref().map(signs),
        },
    }
}

/// `x > 0`, or an error.
pub(crate) fn positive(place: &str, x: &Expression) -> Result<(), ClaimError> {
    match sign(x) {
        Some([true, _]) => Ok(()),
        _ => Err(malformed(place, "greater than zero")),
    }
}

/// `min <= max`, or, where `strictly`, `min < max`; or an error.
pub(crate) fn ordered(
    place: &str,
    min: &Expression,
    max: &Expression,
    strictly: bool,
) -> Result<(), ClaimError> {
    // Of the same number twice, as most are, all that is asked is whether it is defined.
    let difference = match min == max {
        true => sign(max).map(|_| [false, true]),
        false => sign(&(max - min)),
    };
    let [more, not_less] = difference.ok_or_else(|| malformed(place, "a number"))?;
    if more || (!strictly && not_less) {
        Ok(())
    } else {
        Err(malformed(place, "a range whose end is not before its beginning"))
    }
}

pub(crate) fn narrowed<Z: Integer>(x: &Interval<BigInt>) -> Option<Interval<Z>> {
    Some(Interval { lo: Z::of(&x.lo)?, hi: Z::of(&x.hi)? })
}
