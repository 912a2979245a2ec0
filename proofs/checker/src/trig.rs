//! Cosines and sines of angles in degrees, enclosed: for joint ranges of arms and leg angles.

use crate::enclosure::Scalar;
use crate::fixed::Fixed;
use crate::number::Exact;
use num_bigint::BigInt;

/// Guard bits: terms of the series below `e^7 < 2^11` lose a unit in the last place each, and there
/// are fewer than `2^9` of them.
const GUARD: u32 = 24;

/// `atan(1/n) 2^bits`, enclosed, for `n >= 5`.
///
/// `atan(1/n) = sum_j (-1)^j / ((2j + 1) n^(2j + 1))`; the terms alternate and decrease, so what is
/// left out is at most the first term left out, which is less than `2^-bits` where the loop ends.
/// Each term is rounded down, by less than one unit.
fn atan_inverse(n: u32, bits: u32) -> Fixed {
    let mut power = (BigInt::from(1) << bits) / n;
    let square = BigInt::from(n) * n;
    let mut sum = BigInt::from(0);
    let mut terms = 0u32;
    while power > BigInt::from(0) {
        let term = &power / (2 * terms + 1);
        sum = if terms.is_multiple_of(2) { sum + term } else { sum - term };
        power /= &square;
        terms += 1;
    }
    // Two roundings a term (power and quotient), and the remainder.
    let error = BigInt::from(2 * terms + 2);
    Fixed::around(&sum, &error, bits)
}

/// `pi`, enclosed: Machin's `pi = 16 atan(1/5) - 4 atan(1/239)`.
pub fn pi(bits: u32) -> Fixed {
    let working = bits + GUARD;
    let sixteen = Fixed::integer(16, working).mul(&atan_inverse(5, working));
    let four = Fixed::integer(4, working).mul(&atan_inverse(239, working));
    sixteen.sub(&four).rescale(0, bits)
}

/// `(cos, sin)` of an angle in degrees, enclosed; `None` where the angle cannot be, or is beyond
/// 360 degrees either way.
///
/// With `|x| <= 2 pi < 7`, `cos x = sum (-1)^j x^(2j)/(2j)!` and `sin x` likewise. What is left out
/// after the term `x^n/n!` with `n >= 14` is at most twice the next term, since the terms then
/// halve at least; the loop ends where that is below `2^-working`.
pub fn cos_sin(degrees: &Exact, bits: u32) -> Option<(Fixed, Fixed)> {
    let working = bits.checked_add(2 * GUARD)?;
    let degrees = degrees.enclose(0, working)?;
    let limit = Fixed::integer(360, working);
    if limit.lo() < degrees.hi() || degrees.lo() < limit.neg().lo() {
        return None;
    }
    let x = degrees.mul(&pi(working)).div(&Fixed::integer(180, working))?;
    let mut term = Fixed::integer(1, working);
    let mut sums = [Fixed::integer(0, working), Fixed::integer(0, working)];
    let mut n = 0i64;
    loop {
        let part = (n % 2) as usize;
        sums[part] = if n % 4 < 2 { sums[part].add(&term) } else { sums[part].sub(&term) };
        n += 1;
        term = term.mul(&x).div(&Fixed::integer(n, working))?;
        // |term| <= 2^-working up to its rounding: at most 2 units.
        if n >= 14 && term.lo().magnitude().bits().max(term.hi().magnitude().bits()) <= 2 {
            break;
        }
    }
    // At most twice the next term, of at most 4 units.
    let error = Fixed::around(&BigInt::from(0), &BigInt::from(8), working);
    let [cos, sin] = sums.map(|sum| sum.add(&error).rescale(0, bits));
    Some((cos, sin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;

    fn contains(x: &Fixed, value: &BigRational) -> bool {
        x.inf() <= *value && *value <= x.sup()
    }

    fn decimal(text: &str) -> BigRational {
        Exact::parse(text, 1000).unwrap().as_rational().unwrap().clone()
    }

    #[test]
    fn pi_is_enclosed_tightly() {
        // 60 digits of pi, truncated: the true value lies above.
        let low = decimal("3.14159265358979323846264338327950288419716939937510582097494");
        for bits in [32, 64, 128, 180] {
            let x = pi(bits);
            assert!(x.inf() <= low && low <= x.sup());
            assert!(x.hi() - x.lo() <= BigInt::from(3));
        }
    }

    #[test]
    fn exact_cosines_and_sines_are_enclosed_tightly() {
        let half = decimal("0.5");
        let zero = decimal("0");
        let one = decimal("1");
        for bits in [32u32, 64, 256] {
            let at = |degrees: &str| {
                cos_sin(&Exact::parse(degrees, 99).unwrap(), bits).expect("within range")
            };
            for (degrees, cos, sin) in [
                ("0", &one, &zero),
                ("90", &zero, &one),
                ("180", &-one.clone(), &zero),
                ("-90", &zero, &-one.clone()),
                ("360", &one, &zero),
            ] {
                let (c, s) = at(degrees);
                assert!(contains(&c, cos) && contains(&s, sin), "{degrees}");
                assert!(c.hi() - c.lo() <= BigInt::from(3) && s.hi() - s.lo() <= BigInt::from(3));
            }
            assert!(contains(&at("60").0, &half) && contains(&at("30").1, &half));
            assert!(contains(&at("-30").1, &-half.clone()));
        }
    }

    #[test]
    fn angles_beyond_a_turn_are_refused() {
        assert!(cos_sin(&Exact::integer(361), 64).is_none());
        assert!(cos_sin(&Exact::integer(-361), 64).is_none());
    }
}
