//! The arctangent, enclosed.

use num_bigint::BigInt;
use num_traits::Signed;
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::trig::pi;

/// Bits beyond those of the result, against the rounding of some hundred operations.
const GUARD_BITS: u32 = 32;
/// Halvings of the angle before the series: its argument is then below 1/8.
const HALVINGS: u32 = 4;

type Ends = Interval<BigInt>;

/// An enclosure of `atan(x)`, with `bits` fractional bits as `x`; `None` never for sensible precisions,
/// but a division might fail.
///
/// `atan` grows, so the arctangents of the two ends enclose those of everything between.
pub fn atan(x: &Ends, bits: u32) -> Option<Ends> {
    let f = Fixed::new(bits.checked_add(GUARD_BITS)?);
    let end = |n: &BigInt| atan_of_point(&f, &Interval::point(n << GUARD_BITS));
    let (lower, upper) = (end(&x.lo)?, end(&x.hi)?);
    Some(Interval { lo: lower.lo >> GUARD_BITS, hi: -(-upper.hi >> GUARD_BITS) })
}

/// `atan(x)` for a degenerate interval.
///
/// ```text
/// atan(-x) = -atan(x)
/// atan(x)  = pi/2 - atan(1/x)                        x > 1
/// atan(x)  = 2 atan(x / (1 + sqrt(1 + x^2)))         half the angle
/// ```
fn atan_of_point(f: &Fixed<BigInt>, x: &Ends) -> Option<Ends> {
    if x.lo.is_negative() {
        return f.neg(&atan_of_point(f, &f.neg(x)?)?);
    }
    if f.is_positive(&f.sub(x, &f.integer(1)?)?) {
        return f.sub(&f.halve(&pi(f.bits())?)?, &atan_small(f, &f.recip(x)?)?);
    }
    atan_small(f, x)
}

/// `atan(x)` for `x` within `[0, 1]`.
fn atan_small(f: &Fixed<BigInt>, x: &Ends) -> Option<Ends> {
    let one = f.integer(1)?;
    let mut reduced = x.clone();
    for _ in 0..HALVINGS {
        let hypotenuse = f.sqrt(&f.add(&one, &f.sqr(&reduced)?)?)?;
        reduced = f.div(&reduced, &f.add(&one, &hypotenuse)?)?;
    }
    f.mul(&series(f, &reduced)?, &f.integer(1 << HALVINGS)?)
}

/// `atan(x) = x - x^3/3 + x^5/5 - ...` for `x` within `[0, 1)`.
///
/// The terms alternate and decrease, so that the rest after any of them lies between zero and the
/// next term.
fn series(f: &Fixed<BigInt>, x: &Ends) -> Option<Ends> {
    let (square, zero) = (f.sqr(x)?, f.integer(0)?);
    let (mut sum, mut power) = (zero.clone(), x.clone());
    for n in 0.. {
        let term = f.div(&power, &f.integer(2 * n + 1)?)?;
        let signed = if n % 2 == 0 { term.clone() } else { f.neg(&term)? };
        // One unit in the last place: from here on the terms are within [0, 2^-bits].
        if term.hi <= BigInt::from(1) {
            return f.add(&sum, &f.hull(&zero, &signed));
        }
        sum = f.add(&sum, &signed)?;
        power = f.mul(&power, &square)?;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Exact;
    use num_rational::BigRational;

    fn exact(text: &str) -> Exact {
        Exact::parse(text, 1000).unwrap()
    }

    fn ends(x: &Ends, bits: u32) -> [BigRational; 2] {
        [&x.lo, &x.hi].map(|end| BigRational::new(end.clone(), BigInt::from(1) << bits))
    }

    fn rational(text: &str) -> BigRational {
        exact(text).as_rational().unwrap().clone()
    }

    #[test]
    fn arctangents_enclose_known_values() {
        // Computed to 50 digits with another program.
        for (x, angle) in [
            ("1", "0.78539816339744830961566084581987572104929234984378"),
            ("1/2", "0.46364760900080611621425623146121440202853705428612"),
            ("2", "1.1071487177940905030170654601785370400700476454014"),
            ("1/1000", "0.00099999966666686666652380963492054401162093455426801"),
            ("1000000", "1.5707953267948966195646550249728847754319181758780"),
        ] {
            let f = Fixed::new(120);
            let x = exact(x).enclose(120).unwrap();
            let found = atan(&x, 120).unwrap();
            // The digits are good to 50 places; the enclosure is of 120 bits.
            let ([inf, sup], angle) = (ends(&found, 120), rational(angle));
            assert!(inf <= angle && angle <= sup, "{angle}");
            assert!(sup - inf <= rational("1e-34"));
            let mirrored = atan(&f.neg(&x).unwrap(), 120);
            assert_eq!(mirrored, f.neg(&found));
        }
    }

    #[test]
    fn arctangents_agree_with_floating_point() {
        for n in -400i64..400 {
            let x = Exact::Rational(BigRational::new((n * n * n).into(), 8000.into()));
            let found = atan(&x.enclose(128).unwrap(), 128).unwrap();
            let middle = ((found.lo + found.hi) >> 65u32).to_string().parse::<f64>().unwrap();
            let middle = middle / 2f64.powi(64);
            let float = ((n * n * n) as f64 / 8000.0).atan();
            assert!((middle - float).abs() < 1e-14, "{n}");
        }
    }

    #[test]
    fn an_arctangent_of_an_interval_encloses_those_of_its_ends() {
        let [lo, hi] = ["-1/3", "5/2"].map(|x| exact(x).enclose(96).unwrap());
        let whole = atan(&Fixed::new(96).hull(&lo, &hi), 96).unwrap();
        for end in [lo, hi] {
            let at_end = atan(&end, 96).unwrap();
            assert!(whole.lo <= at_end.lo && at_end.hi <= whole.hi);
        }
    }
}
