//! Pairs of doubles and single ones, rounded to nearest: what proposals are computed in.
//!
//! Nothing that is found with them holds until the kernel confirms it in exact arithmetic.

use num_bigint::BigInt;
use num_traits::ToPrimitive;
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::fixed::Interval;

/// `(lo, hi)`, nearly. Ends that are not numbers make every test fail.
pub type Pair = (f64, f64);

/// Intervals without outward rounding.
#[derive(Clone, Copy, Debug)]
pub struct Doubles;

/// What ranges that are equal but for rounding may differ by, relative to their size.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The interval with `bits` fractional bits as a pair.
pub fn pair(x: &Interval<BigInt>, bits: u32) -> Pair {
    let end = |x: &BigInt| x.to_f64().unwrap_or(f64::NAN) * (-f64::from(bits)).exp2();
    (end(&x.lo), end(&x.hi))
}

/// The middle of a pair.
#[inline]
pub fn middle(x: &Pair) -> f64 {
    0.5 * (x.0 + x.1)
}

/// Half of how far its ends are apart.
pub fn half_width((low, high): &Pair) -> f64 {
    0.5 * (high - low)
}

/// The greatest absolute value in a pair.
#[inline]
pub fn magnitude(x: &Pair) -> f64 {
    x.0.abs().max(x.1.abs())
}

#[inline]
pub(crate) fn least(a: f64, b: f64) -> f64 {
    if a < b {
        a
    } else {
        b
    }
}

#[inline]
pub(crate) fn greatest(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}

impl Arithmetic for Doubles {
    type Number = Pair;

    #[inline]
    fn integer(&self, n: i64) -> Option<Pair> {
        Some((n as f64, n as f64))
    }

    #[inline]
    fn add(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        Some((a.0 + b.0, a.1 + b.1))
    }

    #[inline]
    fn sub(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        Some((a.0 - b.1, a.1 - b.0))
    }

    #[inline]
    fn neg(&self, a: &Pair) -> Option<Pair> {
        Some((-a.1, -a.0))
    }

    #[inline]
    fn mul(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        let (p, q) = (a.0 * b.0, a.0 * b.1);
        let (r, s) = (a.1 * b.0, a.1 * b.1);
        Some((least(least(p, q), least(r, s)), greatest(greatest(p, q), greatest(r, s))))
    }

    #[inline]
    fn div(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        self.mul(a, &self.recip(b)?)
    }

    #[inline]
    fn sqr(&self, a: &Pair) -> Option<Pair> {
        let (p, q) = (a.0 * a.0, a.1 * a.1);
        let straddles = a.0 < 0.0 && a.1 > 0.0;
        Some((if straddles { 0.0 } else { least(p, q) }, greatest(p, q)))
    }

    #[inline]
    fn sqrt(&self, a: &Pair) -> Option<Pair> {
        (a.0 > 0.0).then(|| (a.0.sqrt(), a.1.sqrt()))
    }
}

impl Enclosure for Doubles {
    const EXACT_SUMS: bool = false;

    #[inline]
    fn recip(&self, a: &Pair) -> Option<Pair> {
        (a.0 > 0.0 || a.1 < 0.0).then(|| (1.0 / a.1, 1.0 / a.0))
    }

    #[inline]
    fn halve(&self, a: &Pair) -> Option<Pair> {
        Some((0.5 * a.0, 0.5 * a.1))
    }

    #[inline]
    fn dyadic(&self, n: i64, places: u32, a: &Pair) -> Option<Pair> {
        let n = n as f64 / (1u64 << places.min(63)) as f64;
        Some(if n >= 0.0 { (n * a.0, n * a.1) } else { (n * a.1, n * a.0) })
    }

    #[inline]
    fn ratio(&self, a: &Pair, b: &Pair, c: &Pair) -> Option<Pair> {
        self.div(&self.mul(a, b)?, c)
    }

    #[inline]
    fn within(&self, range: &Pair, centre: &Pair, slopes: &[Pair]) -> Option<Pair> {
        let reach: f64 = slopes.iter().map(magnitude).sum();
        let cut = (greatest(range.0, centre.0 - reach), least(range.1, centre.1 + reach));
        (cut.0 <= cut.1 + ROUNDING * (1.0 + reach)).then_some(cut)
    }

    #[inline]
    fn hull(&self, a: &Pair, b: &Pair) -> Pair {
        (least(a.0, b.0), greatest(a.1, b.1))
    }

    #[inline]
    fn ends(&self, a: &Pair) -> [Pair; 2] {
        [(a.0, a.0), (a.1, a.1)]
    }

    #[inline]
    fn is_positive(&self, a: &Pair) -> bool {
        a.0 > 0.0
    }

    #[inline]
    fn is_nonnegative(&self, a: &Pair) -> bool {
        a.0 >= 0.0
    }

    #[inline]
    fn rounded(&self, a: &Pair, places: u32) -> Option<i64> {
        let x = (middle(a) * f64::from(places).exp2()).round();
        (x.abs() < 2f64.powi(62)).then_some(x as i64)
    }
}

/// One double a number.
#[derive(Clone, Copy, Debug)]
pub struct Single;

impl Arithmetic for Single {
    type Number = f64;

    fn integer(&self, n: i64) -> Option<f64> {
        Some(n as f64)
    }

    fn add(&self, a: &f64, b: &f64) -> Option<f64> {
        Some(a + b)
    }

    fn sub(&self, a: &f64, b: &f64) -> Option<f64> {
        Some(a - b)
    }

    fn neg(&self, a: &f64) -> Option<f64> {
        Some(-a)
    }

    fn mul(&self, a: &f64, b: &f64) -> Option<f64> {
        Some(a * b)
    }

    fn div(&self, a: &f64, b: &f64) -> Option<f64> {
        (*b != 0.0).then(|| a / b)
    }

    fn sqr(&self, a: &f64) -> Option<f64> {
        Some(a * a)
    }

    fn sqrt(&self, a: &f64) -> Option<f64> {
        (*a > 0.0).then(|| a.sqrt())
    }
}
