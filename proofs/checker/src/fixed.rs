//! Fixed-point intervals over big integers: the only arithmetic a proof rests on.
//!
//! `Fixed { lo, hi, bits }` is the closed interval `[lo / 2^bits, hi / 2^bits]`, never empty.
//! Addition and subtraction are exact; multiplication, division and square root round outward to
//! the next multiple of `2^-bits`. Operands of one operation carry the same `bits`, which every
//! build asserts: one proof has one precision, so that no certificate can violate it.
//!
//! Two inequalities carry every rounding in this file, for integers `n` and `k >= 0`, `d > 0`:
//!
//! ```text
//! floor(n / d) <= n / d <= ceil(n / d)        ceil(n / d) = -floor(-n / d)
//! r = isqrt(n)  =>  r^2 <= n < (r + 1)^2
//! ```

use crate::enclosure::{Enclosure, Scalar};
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// A closed interval with endpoints that are multiples of `2^-bits`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fixed {
    lo: BigInt,
    hi: BigInt,
    bits: u32,
}

/// `floor(n / 2^k)` for `k >= 0`, and `n * 2^-k` for `k < 0`.
fn shift_floor(n: &BigInt, k: i64) -> BigInt {
    // BigInt's right shift rounds towards minus infinity, also for negative numbers.
    if k >= 0 {
        n >> k
    } else {
        n << -k
    }
}

/// `ceil(n / 2^k)` for `k >= 0`, and `n * 2^-k` for `k < 0`: `ceil(x) = -floor(-x)`.
fn shift_ceil(n: &BigInt, k: i64) -> BigInt {
    -shift_floor(&-n, k)
}

impl Fixed {
    /// The interval `[lo / 2^bits, hi / 2^bits]`; `None` if `lo > hi`.
    pub fn new(lo: BigInt, hi: BigInt, bits: u32) -> Option<Self> {
        (lo <= hi).then_some(Fixed { lo, hi, bits })
    }

    /// `[centre - error, centre + error] / 2^bits`, for `error >= 0`.
    pub(crate) fn around(centre: &BigInt, error: &BigInt, bits: u32) -> Self {
        Fixed { lo: centre - error, hi: centre + error, bits }
    }

    /// The integer `n`, exactly.
    pub fn integer(n: i64, bits: u32) -> Self {
        let n = BigInt::from(n) << bits;
        Fixed { lo: n.clone(), hi: n, bits }
    }

    /// The tightest enclosure of `x / 2^scale` with `bits` fractional bits.
    pub fn rational(x: &BigRational, scale: i64, bits: u32) -> Self {
        // x / 2^scale * 2^bits = numer / (denom * 2^k) with k = scale - bits.
        let k = scale - i64::from(bits);
        let numer = if k < 0 { x.numer() << -k } else { x.numer().clone() };
        let denom = if k > 0 { x.denom() << k } else { x.denom().clone() };
        let (floor, rest) = numer.div_mod_floor(&denom);
        let ceil = if rest.is_zero() { floor.clone() } else { &floor + 1 };
        Fixed { lo: floor, hi: ceil, bits }
    }

    /// The same interval divided by `2^scale`, rounded outward to `bits` fractional bits.
    pub fn rescale(&self, scale: i64, bits: u32) -> Self {
        // lo / 2^self.bits / 2^scale * 2^bits = lo / 2^k.
        let k = i64::from(self.bits) + scale - i64::from(bits);
        Fixed { lo: shift_floor(&self.lo, k), hi: shift_ceil(&self.hi, k), bits }
    }

    /// The smallest interval that contains both.
    pub fn hull(&self, other: &Self) -> Self {
        assert_eq!(self.bits, other.bits);
        Fixed {
            lo: (&self.lo).min(&other.lo).clone(),
            hi: (&self.hi).max(&other.hi).clone(),
            bits: self.bits,
        }
    }

    /// The points in both; `None` if there is none.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        assert_eq!(self.bits, other.bits);
        let lo = (&self.lo).max(&other.lo).clone();
        let hi = (&self.hi).min(&other.hi).clone();
        Fixed::new(lo, hi, self.bits)
    }

    /// Fractional bits of the endpoints.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Lower endpoint times `2^bits`.
    pub fn lo(&self) -> &BigInt {
        &self.lo
    }

    /// Upper endpoint times `2^bits`.
    pub fn hi(&self) -> &BigInt {
        &self.hi
    }

    /// Lower endpoint, exactly.
    pub fn inf(&self) -> BigRational {
        BigRational::new(self.lo.clone(), BigInt::one() << self.bits)
    }

    /// Upper endpoint, exactly.
    pub fn sup(&self) -> BigRational {
        BigRational::new(self.hi.clone(), BigInt::one() << self.bits)
    }
}

impl Scalar for Fixed {
    fn integer_like(&self, n: i64) -> Self {
        Fixed::integer(n, self.bits)
    }

    fn add(&self, other: &Self) -> Self {
        assert_eq!(self.bits, other.bits);
        Fixed { lo: &self.lo + &other.lo, hi: &self.hi + &other.hi, bits: self.bits }
    }

    fn sub(&self, other: &Self) -> Self {
        assert_eq!(self.bits, other.bits);
        Fixed { lo: &self.lo - &other.hi, hi: &self.hi - &other.lo, bits: self.bits }
    }

    fn neg(&self) -> Self {
        Fixed { lo: -&self.hi, hi: -&self.lo, bits: self.bits }
    }

    /// | `self` \ `other`  | `other >= 0`       | `other <= 0`       | mixed                              |
    /// |-------------------|--------------------|--------------------|------------------------------------|
    /// | `self >= 0`       | `[lo lo', hi hi']` | `[hi lo', lo hi']` | `[hi lo', hi hi']`                 |
    /// | `self <= 0`       | `[lo hi', hi lo']` | `[hi hi', lo lo']` | `[lo hi', lo lo']`                 |
    /// | mixed             | `[lo hi', hi hi']` | `[hi lo', lo lo']` | min(lo hi', hi lo'), max(lo lo', hi hi') |
    fn mul(&self, other: &Self) -> Self {
        assert_eq!(self.bits, other.bits);
        let (a, b, c, d) = (&self.lo, &self.hi, &other.lo, &other.hi);
        let (lo, hi) = if !a.is_negative() {
            match (c.is_negative(), d.is_positive()) {
                (false, _) => (a * c, b * d),
                (true, false) => (b * c, a * d),
                (true, true) => (b * c, b * d),
            }
        } else if !b.is_positive() {
            match (c.is_negative(), d.is_positive()) {
                (false, _) => (a * d, b * c),
                (true, false) => (b * d, a * c),
                (true, true) => (a * d, a * c),
            }
        } else {
            match (c.is_negative(), d.is_positive()) {
                (false, _) => (a * d, b * d),
                (true, false) => (b * c, a * c),
                (true, true) => ((a * d).min(b * c), (a * c).max(b * d)),
            }
        };
        // (lo / 2^bits^2, hi / 2^bits^2) to multiples of 2^-bits: floor below, ceil above.
        let k = i64::from(self.bits);
        Fixed { lo: shift_floor(&lo, k), hi: shift_ceil(&hi, k), bits: self.bits }
    }

    fn sqr(&self) -> Self {
        let k = i64::from(self.bits);
        let (a, b) = (&self.lo * &self.lo, &self.hi * &self.hi);
        let (lo, hi) = if a <= b { (a, b) } else { (b, a) };
        let straddles = self.lo.is_negative() && self.hi.is_positive();
        let lo = if straddles { BigInt::zero() } else { shift_floor(&lo, k) };
        Fixed { lo, hi: shift_ceil(&hi, k), bits: self.bits }
    }

    fn recip(&self) -> Option<Self> {
        if !self.lo.is_positive() && !self.hi.is_negative() {
            return None;
        }
        // 1 / (x / 2^bits) * 2^bits = 2^(2 bits) / x, decreasing on either side of zero.
        let one = BigInt::one() << (2 * u64::from(self.bits));
        Some(Fixed { lo: one.div_floor(&self.hi), hi: one.div_ceil(&self.lo), bits: self.bits })
    }

    fn sqrt(&self) -> Option<Self> {
        if !self.lo.is_positive() {
            return None;
        }
        // sqrt(x / 2^bits) * 2^bits = sqrt(x * 2^bits); isqrt(n) <= sqrt(n), and sqrt(n) is at
        // most isqrt(n) where n is a square, isqrt(n) + 1 elsewhere.
        let lo = (&self.lo << self.bits).sqrt();
        let n = &self.hi << self.bits;
        let root = n.sqrt();
        let hi = if &root * &root == n { root } else { root + 1 };
        Some(Fixed { lo, hi, bits: self.bits })
    }
}

impl Enclosure for Fixed {
    type Bound = BigInt;

    fn from_fixed(x: &Fixed) -> Self {
        x.clone()
    }

    fn dyadic_like(&self, index: u128, level: u32) -> Self {
        let x = Fixed { lo: index.into(), hi: index.into(), bits: 0 };
        x.rescale(i64::from(level), self.bits)
    }

    fn join(&self, other: &Self) -> Self {
        self.hull(other)
    }

    fn meet(&self, other: &Self) -> Option<Self> {
        self.intersection(other)
    }

    fn ends(&self) -> [Self; 2] {
        let point = |x: &BigInt| Fixed { lo: x.clone(), hi: x.clone(), bits: self.bits };
        [point(&self.lo), point(&self.hi)]
    }

    fn lower(&self) -> BigInt {
        self.lo.clone()
    }

    fn upper(&self) -> BigInt {
        self.hi.clone()
    }

    fn is_positive(&self) -> bool {
        self.lo.is_positive()
    }

    fn is_nonnegative(&self) -> bool {
        !self.lo.is_negative()
    }
}
