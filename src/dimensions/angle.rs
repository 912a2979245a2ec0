//! The arctangent, enclosed.

use num_bigint::BigInt;
use num_traits::Signed;
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::trig::pi;

/// Bits beyond those of the result, against the rounding of some hundred operations.
const GUARD_BITS: u32 = 32;
/// Halvings of the angle before the series: its argument is then below 1/8.
const HALVINGS: u32 = 4;

/// An enclosure of `atan(x)`, in the precision of `x`; `None` never for sensible precisions, but a
/// division might fail.
///
/// `atan` grows, so the arctangents of the two ends enclose those of everything between.
pub fn atan(x: &Fixed) -> Option<Fixed> {
    let bits = x.bits();
    let working = bits.checked_add(GUARD_BITS)?;
    let end = |n: &BigInt| {
        let n = n << GUARD_BITS;
        atan_of_point(&Fixed::new(n.clone(), n, working)?)
    };
    let (lower, upper) = (end(x.lo())?, end(x.hi())?);
    Some(lower.hull(&upper).rescale(0, bits))
}

/// `atan(x)` for a degenerate interval.
///
/// ```text
/// atan(-x) = -atan(x)
/// atan(x)  = pi/2 - atan(1/x)                        x > 1
/// atan(x)  = 2 atan(x / (1 + sqrt(1 + x^2)))         half the angle
/// ```
fn atan_of_point(x: &Fixed) -> Option<Fixed> {
    let bits = x.bits();
    if x.lo().is_negative() {
        return Some(atan_of_point(&x.neg())?.neg());
    }
    let one = Fixed::integer(1, bits);
    if x.sub(&one).is_positive() {
        let half_pi = pi(bits).mul(&Fixed::integer(1, bits).div(&Fixed::integer(2, bits))?);
        return Some(half_pi.sub(&atan_small(&x.recip()?)?));
    }
    atan_small(x)
}

/// `atan(x)` for `x` within `[0, 1]`.
fn atan_small(x: &Fixed) -> Option<Fixed> {
    let one = Fixed::integer(1, x.bits());
    let mut reduced = x.clone();
    for _ in 0..HALVINGS {
        let hypotenuse = one.add(&reduced.sqr()).sqrt()?;
        reduced = reduced.div(&one.add(&hypotenuse))?;
    }
    let factor = Fixed::integer(1 << HALVINGS, x.bits());
    series(&reduced).map(|angle| angle.mul(&factor))
}

/// `atan(x) = x - x^3/3 + x^5/5 - ...` for `x` within `[0, 1)`.
///
/// The terms alternate and decrease, so that the rest after any of them lies between zero and the
/// next term.
fn series(x: &Fixed) -> Option<Fixed> {
    let bits = x.bits();
    let square = x.sqr();
    let zero = Fixed::integer(0, bits);
    let (mut sum, mut power) = (zero.clone(), x.clone());
    for n in 0.. {
        let term = power.div(&Fixed::integer(2 * n + 1, bits))?;
        let signed = if n % 2 == 0 { term.clone() } else { term.neg() };
        // One unit in the last place: from here on the terms are within [0, 2^-bits].
        if *term.hi() <= BigInt::from(1) {
            return Some(sum.add(&zero.hull(&signed)));
        }
        sum = sum.add(&signed);
        power = power.mul(&square);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Exact;
    use num_rational::BigRational;

    /// 50 decimal places of pi, rounded down.
    const PI: &str = "3.14159265358979323846264338327950288419716939937510";

    fn exact(text: &str) -> BigRational {
        Exact::parse(text, 1000).unwrap().as_rational().unwrap().clone()
    }

    #[test]
    fn pi_is_enclosed_tightly() {
        let pi = pi(150);
        assert!(pi.inf() <= exact(PI) && pi.sup() >= exact(PI));
        assert!(pi.sup() - pi.inf() <= exact("1e-44"));
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
            let x = Fixed::rational(&exact(x), 0, 120);
            let found = atan(&x).unwrap();
            // The digits are good to 50 places; the enclosure is of 120 bits.
            let angle = exact(angle);
            assert!(found.inf() <= angle && angle <= found.sup(), "{angle}");
            assert!(found.sup() - found.inf() <= exact("1e-34"));
            let mirrored = atan(&x.neg()).unwrap();
            assert_eq!(mirrored, found.neg());
        }
    }

    #[test]
    fn arctangents_agree_with_floating_point() {
        for n in -400i64..400 {
            let x = BigRational::new((n * n * n).into(), 8000.into());
            let found = atan(&Fixed::rational(&x, 0, 128)).unwrap();
            let middle = ((found.lo() + found.hi()) >> 65u32).to_string().parse::<f64>().unwrap();
            let middle = middle / 2f64.powi(64);
            let float = ((n * n * n) as f64 / 8000.0).atan();
            assert!((middle - float).abs() < 1e-14, "{n}");
        }
    }

    #[test]
    fn an_arctangent_of_an_interval_encloses_those_of_its_ends() {
        let (lo, hi) = (exact("-1/3"), exact("5/2"));
        let x = Fixed::rational(&lo, 0, 96).hull(&Fixed::rational(&hi, 0, 96));
        let whole = atan(&x).unwrap();
        for end in [lo, hi] {
            let at_end = atan(&Fixed::rational(&end, 0, 96)).unwrap();
            assert!(whole.inf() <= at_end.inf() && at_end.sup() <= whole.sup());
        }
    }
}
