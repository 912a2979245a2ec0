//! Floating-point arithmetic for the search: intervals (inari) and plain approximations.
//!
//! The search evaluates the checker's own formulas in these types. Whatever it concludes is only a
//! proposal: the checker redoes it in integers.

use inari::Interval as Inari;
use num_bigint::BigInt;
use num_traits::ToPrimitive;
use orthocert_checker::enclosure::{Bound, Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;

/// A closed, non-empty, bounded interval of doubles; operations round outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval(Inari);

/// The whole line: what remains where an operation over- or underflows. No rule accepts it.
const UNKNOWN: Interval = Interval(Inari::ENTIRE);

/// A double below (`down`) or above `n / 2^bits`; the double itself where it is one.
fn outward(n: &BigInt, bits: u32, down: bool) -> f64 {
    let infinite = if down { f64::NEG_INFINITY } else { f64::INFINITY };
    let nearest = n.to_f64().unwrap_or(infinite);
    let mantissa = if <BigInt as num_traits::FromPrimitive>::from_f64(nearest).as_ref() == Some(n) {
        nearest
    } else if down {
        nearest.next_down()
    } else {
        nearest.next_up()
    };
    // Scaling by a power of two is exact unless the result is subnormal: one step more is outward.
    let scaled = mantissa * (-f64::from(bits)).exp2();
    if scaled.abs() >= f64::MIN_POSITIVE || mantissa == 0.0 {
        scaled
    } else if down {
        scaled.next_down()
    } else {
        scaled.next_up()
    }
}

impl Interval {
    /// `[lo, hi]`; the whole line where that is not an interval of finite doubles.
    pub fn new(lo: f64, hi: f64) -> Self {
        Inari::try_from((lo, hi)).map_or(UNKNOWN, Interval)
    }

    /// Greatest absolute value.
    pub fn mag(&self) -> f64 {
        self.0.mag()
    }

    /// A double near the middle.
    pub fn mid(&self) -> f64 {
        self.0.mid()
    }

    /// Lower end.
    pub fn inf(&self) -> f64 {
        self.0.inf()
    }

    /// Upper end.
    pub fn sup(&self) -> f64 {
        self.0.sup()
    }

    fn of(x: Inari) -> Self {
        if x.is_empty() {
            UNKNOWN
        } else {
            Interval(x)
        }
    }
}

impl Scalar for Interval {
    fn integer_like(&self, n: i64) -> Self {
        let x = n as f64;
        if x.abs() <= (1u64 << f64::MANTISSA_DIGITS) as f64 {
            Interval::new(x, x)
        } else {
            Interval::new(x.next_down(), x.next_up())
        }
    }

    fn add(&self, other: &Self) -> Self {
        Self::of(self.0 + other.0)
    }

    fn sub(&self, other: &Self) -> Self {
        Self::of(self.0 - other.0)
    }

    fn neg(&self) -> Self {
        Interval(-self.0)
    }

    fn mul(&self, other: &Self) -> Self {
        Self::of(self.0 * other.0)
    }

    fn sqr(&self) -> Self {
        Self::of(self.0.sqr())
    }

    fn recip(&self) -> Option<Self> {
        (!self.0.contains(0.0)).then(|| Self::of(self.0.recip()))
    }

    fn sqrt(&self) -> Option<Self> {
        self.is_positive().then(|| Self::of(self.0.sqrt()))
    }
}

impl Enclosure for Interval {
    type Bound = Endpoint;

    fn from_fixed(x: &Fixed) -> Self {
        Interval::new(outward(x.lo(), x.bits(), true), outward(x.hi(), x.bits(), false))
    }

    fn dyadic_like(&self, index: u128, level: u32) -> Self {
        // Up to 53 significant bits the double is exact; beyond, it is enclosed.
        if index <= 1 << f64::MANTISSA_DIGITS && level <= 1000 {
            let x = index as f64 * (-f64::from(level)).exp2();
            return Interval::new(x, x);
        }
        Fixed::new(index.into(), index.into(), level).map_or(UNKNOWN, |x| Self::from_fixed(&x))
    }

    fn join(&self, other: &Self) -> Self {
        Interval(self.0.convex_hull(other.0))
    }

    fn meet(&self, other: &Self) -> Option<Self> {
        let both = self.0.intersection(other.0);
        (!both.is_empty()).then_some(Interval(both))
    }

    fn ends(&self) -> [Self; 2] {
        [self.0.inf(), self.0.sup()].map(|x| Interval::new(x, x))
    }

    fn lower(&self) -> Endpoint {
        Endpoint::new(self.0.inf())
    }

    fn upper(&self) -> Endpoint {
        Endpoint::new(self.0.sup())
    }

    fn is_positive(&self) -> bool {
        self.0.inf() > 0.0
    }

    fn is_nonnegative(&self) -> bool {
        self.0.inf() >= 0.0
    }
}

/// An endpoint, or a polynomial of endpoints, as a sum of two doubles with a bound on its error:
/// the number is within `high + low ± error`.
///
/// Where two singular values come near a bound together, a determinant is of the order of their
/// distance squared, and half of a double's digits are lost in it; hence twice the digits.
#[derive(Clone, Copy, Debug)]
pub struct Endpoint {
    high: f64,
    low: f64,
    error: f64,
}

/// Bounds what is lost by rounding three or four times, relative to the terms' absolute values,
/// and what is lost below the least normal double.
const LOSS: f64 = 4.0 * f64::EPSILON;
const UNDERFLOW: f64 = 4.0 * f64::MIN_POSITIVE;

/// `x + y` as the nearest double and the rest, exactly (Knuth).
fn two_sum(x: f64, y: f64) -> (f64, f64) {
    let sum = x + y;
    let part = sum - x;
    (sum, (x - (sum - part)) + (y - part))
}

impl Endpoint {
    fn new(x: f64) -> Self {
        Endpoint { high: x, low: 0.0, error: 0.0 }
    }

    /// `high + (a + b + c)`, with what is lost in the inner sum added to `error`.
    fn of(high: f64, [a, b, c]: [f64; 3], error: f64) -> Self {
        let lost = LOSS * (a.abs() + b.abs() + c.abs() + error) + UNDERFLOW;
        let (high, low) = two_sum(high, a + b + c);
        Endpoint { high, low, error: error + lost }
    }

    fn mag(&self) -> f64 {
        self.high.abs() + self.low.abs()
    }
}

impl Bound for Endpoint {
    fn add(&self, other: &Self) -> Self {
        let (high, rest) = two_sum(self.high, other.high);
        Self::of(high, [self.low, other.low, rest], self.error + other.error)
    }

    fn sub(&self, other: &Self) -> Self {
        self.add(&Endpoint { high: -other.high, low: -other.low, error: other.error })
    }

    fn mul(&self, other: &Self) -> Self {
        let high = self.high * other.high;
        let rest = self.high.mul_add(other.high, -high);
        let error = self.mag() * other.error
            + self.error * (other.mag() + other.error)
            + (self.low * other.low).abs();
        Self::of(high, [self.high * other.low, self.low * other.high, rest], error)
    }

    fn is_positive(&self) -> bool {
        let error = self.error + LOSS * (self.error + self.low.abs());
        self.high + (self.low - error) > 0.0
    }
}

/// A double that stands for a real number, without any guarantee: for looking around.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Approx(pub f64);

impl Approx {
    /// The middle of an exact enclosure.
    pub fn from_fixed(x: &Fixed) -> Self {
        Approx(Interval::from_fixed(x).mid())
    }
}

impl Scalar for Approx {
    fn integer_like(&self, n: i64) -> Self {
        Approx(n as f64)
    }

    fn add(&self, other: &Self) -> Self {
        Approx(self.0 + other.0)
    }

    fn sub(&self, other: &Self) -> Self {
        Approx(self.0 - other.0)
    }

    fn neg(&self) -> Self {
        Approx(-self.0)
    }

    fn mul(&self, other: &Self) -> Self {
        Approx(self.0 * other.0)
    }

    fn sqr(&self) -> Self {
        Approx(self.0 * self.0)
    }

    fn recip(&self) -> Option<Self> {
        (self.0 != 0.0).then_some(Approx(1.0 / self.0))
    }

    fn sqrt(&self) -> Option<Self> {
        (self.0 > 0.0).then_some(Approx(self.0.sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;

    fn contains(x: &Interval, value: &BigRational) -> bool {
        let end = |x: f64| BigRational::from_float(x);
        end(x.inf()).is_none_or(|lo| lo <= *value) && end(x.sup()).is_none_or(|hi| *value <= hi)
    }

    #[test]
    fn conversion_from_fixed_encloses_and_is_tight() {
        for (numer, denom) in [(1i64, 3i64), (-1, 3), (1, 1 << 30), (7, 1), (0, 1), (-5, 7)] {
            let value = BigRational::new(numer.into(), denom.into());
            for bits in [40u32, 64, 128, 300] {
                let fixed = Fixed::rational(&value, 0, bits);
                let x = Interval::from_fixed(&fixed);
                assert!(contains(&x, &fixed.inf()) && contains(&x, &fixed.sup()), "{value} {bits}");
                let width = x.sup() - x.inf();
                assert!(width <= 4.0 * f64::EPSILON * x.mag() + 1e-11, "{value} {bits}");
            }
        }
        let exact = Interval::from_fixed(&Fixed::integer(3, 200));
        assert_eq!((exact.inf(), exact.sup()), (3.0, 3.0));
    }

    #[test]
    fn unrepresentable_values_become_the_whole_line() {
        let huge = Fixed::new(BigInt::from(1) << 2000, BigInt::from(1) << 2000, 0);
        let x = Interval::from_fixed(&huge.unwrap());
        assert!(!x.is_positive() || x.sup().is_infinite());
        assert!(!Interval::new(f64::NAN, 1.0).is_nonnegative());
    }

    #[test]
    fn dyadics_are_exact() {
        let one = Interval::new(1.0, 1.0);
        let x = one.dyadic_like(5, 3);
        assert_eq!((x.inf(), x.sup()), (0.625, 0.625));
    }
}
