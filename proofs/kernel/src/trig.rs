//! Cosines and sines of angles in degrees, and `pi`, enclosed.

use crate::arithmetic::Arithmetic;
use crate::fixed::{Fixed, Interval};
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_traits::Signed;

/// Guard bits: terms of the series below are less than `e^7 < 2^11` and lose a unit in the last place
/// each, and there are fewer than `2^11` of them for up to 1152 bits.
const GUARD: u32 = 24;

/// `[centre - error, centre + error]`.
fn around(centre: &BigInt, error: u64) -> Interval<BigInt> {
    Interval { lo: centre - error, hi: centre + error }
}

/// `x / 2^places` rounded outward.
pub(crate) fn shortened(x: &Interval<BigInt>, places: u32) -> Interval<BigInt> {
    Interval { lo: &x.lo >> places, hi: -(-&x.hi >> places) }
}

/// `atan(1/n)`, for `n >= 5`.
///
/// `atan(1/n) = sum_j (-1)^j/((2j + 1) n^(2j + 1))`: terms alternate and decrease, so what is left out
/// is at most the first term left out, less than a unit where the loop ends. Each term is rounded down
/// twice, by less than a unit.
fn atan_inverse(n: u32, bits: u32) -> Interval<BigInt> {
    let mut power = (BigInt::from(1) << bits) / n;
    let mut sum = BigInt::from(0);
    let mut terms = 0u32;
    while power.is_positive() {
        let term = &power / (2 * terms + 1);
        sum = if terms.is_multiple_of(2) { sum + term } else { sum - term };
        power /= n * n;
        terms += 1;
    }
    around(&sum, 2 * u64::from(terms) + 2)
}

/// `pi = 16 atan(1/5) - 4 atan(1/239)` (Machin).
pub fn pi(bits: u32) -> Option<Interval<BigInt>> {
    let working = bits.checked_add(GUARD)?;
    let fixed = Fixed::new(working);
    let part = |factor: i64, n: u32| fixed.mul(&fixed.integer(factor)?, &atan_inverse(n, working));
    Some(shortened(&fixed.sub(&part(16, 5)?, &part(4, 239)?)?, GUARD))
}

/// `(cos, sin)` of an angle in degrees, whose enclosure `degrees(bits)` gives; `None` where that
/// fails, or is beyond 360 degrees either way.
///
/// `|x| <= 2 pi < 7`: `cos x = sum (-1)^j x^(2j)/(2j)!`, `sin x` likewise. What is left out after the
/// term `x^n/n!` with `n >= 14` is at most twice the next term, since the terms then halve at least;
/// the loop ends where that is below a unit, up to its own rounding of at most 2.
pub fn cos_sin(
    degrees: impl Fn(u32) -> Option<Interval<BigInt>>,
    bits: u32,
) -> Option<[Interval<BigInt>; 2]> {
    let working = bits.checked_add(2 * GUARD)?;
    let fixed = Fixed::<BigInt>::new(working);
    let degrees = degrees(working)?;
    let limit = fixed.integer(360)?.hi;
    if degrees.hi > limit || degrees.lo < -limit {
        return None;
    }
    let x = fixed.div(&fixed.mul(&degrees, &pi(working)?)?, &fixed.integer(180)?)?;
    let mut term = fixed.integer(1)?;
    let mut sums = [fixed.integer(0)?, fixed.integer(0)?];
    for n in 0i64.. {
        let part = (n % 2) as usize;
        let sum =
            if n % 4 < 2 { fixed.add(&sums[part], &term) } else { fixed.sub(&sums[part], &term) };
        sums[part] = sum?;
        let Interval { lo, hi } = fixed.mul(&term, &x)?;
        let divisor = BigInt::from(n + 1);
        term = Interval { lo: lo.div_floor(&divisor), hi: -(-hi).div_floor(&divisor) };
        if n >= 13 && term.lo.bits().max(term.hi.bits()) <= 2 {
            break;
        }
    }
    // At most twice the next term, of at most 4 units.
    let error = around(&BigInt::from(0), 8);
    let [cos, sin] = sums.map(|sum| fixed.add(&sum, &error).map(|x| shortened(&x, 2 * GUARD)));
    Some([cos?, sin?])
}
