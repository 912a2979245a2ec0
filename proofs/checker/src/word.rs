//! Fixed-point intervals over machine words: [`Fixed`] where its numbers are small, and faster.
//!
//! `Word` holds the interval `[lo / 2^bits, hi / 2^bits]` with `|lo|, |hi| <= 2^62`, or nothing: the
//! *unknown*, which stands for the whole line. **Every operation gives the same interval as that of
//! [`Fixed`] with the same `bits`, or the unknown**; whatever meets the unknown becomes it, and no
//! sign of it is certain. A rule accepts by certain signs alone, so what a rule accepts in this
//! arithmetic it accepts in that of [`Fixed`]: this one can only fail to accept. All products are
//! formed in 128 bits, all sums are checked, and the inequalities of [`crate::fixed`] carry the
//! roundings.

use crate::enclosure::{Bound, Enclosure, Scalar};
use crate::fixed::Fixed;
use num_traits::ToPrimitive;

/// Most fractional bits: squares of `2^bits` then fit where they are formed.
pub const MAX_BITS: u32 = 38;

/// Greatest absolute value of an endpoint times `2^bits`.
const LIMIT: i128 = 1 << 62;

/// A closed interval with endpoints that are multiples of `2^-bits`, or the unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    lo: i64,
    hi: i64,
    bits: u32,
    known: bool,
}

/// `ceil(n / 2^k)`: `ceil(x) = -floor(-x)`, and a right shift is a floor.
fn shift_ceil(n: i128, k: u32) -> i128 {
    -(-n >> k)
}

fn floor_div(n: i128, d: i128) -> i128 {
    n.div_euclid(d)
}

fn ceil_div(n: i128, d: i128) -> i128 {
    -((-n).div_euclid(d))
}

impl Word {
    fn unknown(bits: u32) -> Self {
        Word { lo: 0, hi: 0, bits, known: false }
    }

    /// `[lo, hi] / 2^bits`; the unknown beyond the limit.
    fn within_limit(lo: i128, hi: i128, bits: u32) -> Self {
        match (i64::try_from(lo), i64::try_from(hi)) {
            (Ok(l), Ok(h)) if lo >= -LIMIT && hi <= LIMIT && l <= h => {
                Word { lo: l, hi: h, bits, known: true }
            }
            _ => Word::unknown(bits),
        }
    }

    fn wide(&self) -> (i128, i128) {
        (self.lo.into(), self.hi.into())
    }

    /// The interval, unless one of the operands is the unknown.
    fn joint(&self, other: &Self, lo: i128, hi: i128) -> Self {
        assert_eq!(self.bits, other.bits);
        if self.known && other.known {
            Word::within_limit(lo, hi, self.bits)
        } else {
            Word::unknown(self.bits)
        }
    }

    /// The same interval as a [`Fixed`]; `None` for the unknown.
    pub fn to_fixed(&self) -> Option<Fixed> {
        self.known.then(|| Fixed::new(self.lo.into(), self.hi.into(), self.bits)).flatten()
    }
}

impl Scalar for Word {
    fn integer_like(&self, n: i64) -> Self {
        // At most 2^63 2^38 = 2^101.
        let n = if self.bits <= MAX_BITS { i128::from(n) << self.bits } else { LIMIT + 1 };
        Word::within_limit(n, n, self.bits)
    }

    fn add(&self, other: &Self) -> Self {
        let ((a, b), (c, d)) = (self.wide(), other.wide());
        self.joint(other, a + c, b + d)
    }

    fn sub(&self, other: &Self) -> Self {
        let ((a, b), (c, d)) = (self.wide(), other.wide());
        self.joint(other, a - d, b - c)
    }

    fn neg(&self) -> Self {
        // -LIMIT <= lo <= hi <= LIMIT is symmetric.
        Word { lo: -self.hi, hi: -self.lo, ..*self }
    }

    /// The least and the greatest of the four products, rounded outward: the table of
    /// [`Fixed::mul`](crate::fixed::Fixed) picks the same.
    fn mul(&self, other: &Self) -> Self {
        if !(self.known && other.known) {
            return Word::unknown(self.bits);
        }
        let ((a, b), (c, d)) = (self.wide(), other.wide());
        let (ac, ad, bc, bd) = (a * c, a * d, b * c, b * d);
        let lo = ac.min(ad).min(bc.min(bd));
        let hi = ac.max(ad).max(bc.max(bd));
        self.joint(other, lo >> self.bits, shift_ceil(hi, self.bits))
    }

    fn sqr(&self) -> Self {
        if !self.known {
            return *self;
        }
        let (a, b) = self.wide();
        let (least, greatest) = ((a * a).min(b * b), (a * a).max(b * b));
        let least = if a < 0 && b > 0 { 0 } else { least };
        self.joint(self, least >> self.bits, shift_ceil(greatest, self.bits))
    }

    fn recip(&self) -> Option<Self> {
        if !self.known || (self.lo <= 0 && self.hi >= 0) || self.bits > MAX_BITS {
            return None;
        }
        // 1 / (x / 2^bits) * 2^bits = 2^(2 bits) / x, decreasing on either side of zero. Euclid's
        // quotient is the floor for positive divisors: for negative x, n / x = -n / -x.
        let one = 1i128 << (2 * self.bits);
        let quotients = |x: i64| {
            let (n, d) = if x > 0 { (one, i128::from(x)) } else { (-one, -i128::from(x)) };
            (floor_div(n, d), ceil_div(n, d))
        };
        Some(Word::within_limit(quotients(self.hi).0, quotients(self.lo).1, self.bits))
    }

    fn sqrt(&self) -> Option<Self> {
        if !self.known || self.lo <= 0 || self.bits > MAX_BITS {
            return None;
        }
        // sqrt(x / 2^bits) * 2^bits = sqrt(x 2^bits); isqrt is the floor, and the ceiling is one
        // more unless the number is a square.
        let root = |x: i64| (i128::from(x) << self.bits).isqrt();
        let (low, high) = (root(self.lo), root(self.hi));
        let exact = high * high == i128::from(self.hi) << self.bits;
        Some(Word::within_limit(low, if exact { high } else { high + 1 }, self.bits))
    }
}

impl Enclosure for Word {
    type Bound = Wide;

    fn from_fixed(x: &Fixed) -> Self {
        match (x.lo().to_i128(), x.hi().to_i128()) {
            (Some(lo), Some(hi)) if x.bits() <= MAX_BITS => Word::within_limit(lo, hi, x.bits()),
            _ => Word::unknown(x.bits()),
        }
    }

    fn dyadic_like(&self, index: u128, level: u32) -> Self {
        let (bits, most) = (self.bits, 1 << 62);
        if index > most || level > 62 || bits > MAX_BITS {
            return Word::unknown(bits);
        }
        // At most 2^62 2^38 = 2^100.
        let numerator = (index << bits).cast_signed();
        Word::within_limit(numerator >> level, shift_ceil(numerator, level), bits)
    }

    fn join(&self, other: &Self) -> Self {
        self.joint(other, self.lo.min(other.lo).into(), self.hi.max(other.hi).into())
    }

    fn meet(&self, other: &Self) -> Option<Self> {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        if self.known && other.known && lo > hi {
            return None;
        }
        Some(self.joint(other, lo.into(), hi.into()))
    }

    fn ends(&self) -> [Self; 2] {
        [Word { hi: self.lo, ..*self }, Word { lo: self.hi, ..*self }]
    }

    fn lower(&self) -> Wide {
        Wide(self.known.then(|| Limbs::from(i128::from(self.lo))))
    }

    fn upper(&self) -> Wide {
        Wide(self.known.then(|| Limbs::from(i128::from(self.hi))))
    }

    fn is_positive(&self) -> bool {
        self.known && self.lo > 0
    }

    fn is_nonnegative(&self) -> bool {
        self.known && self.lo >= 0
    }
}

/// An integer of 256 bits in two's complement; none where a factor has more than 128 bits, or the
/// number comes from the unknown.
///
/// Products of two endpoints have at most 124 bits and sign, so that the minors of a matrix, of
/// degree three, are formed exactly: a factor of degree two, a sum of two products, fits 128 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wide(Option<Limbs>);

/// `high 2^128 + low`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Limbs {
    high: i128,
    low: u128,
}

impl From<i128> for Limbs {
    fn from(x: i128) -> Self {
        Limbs { high: x >> 127, low: x.cast_unsigned() }
    }
}

impl Limbs {
    /// The number, if it has 128 bits at most.
    fn narrow(self) -> Option<i128> {
        let x = self.low.cast_signed();
        (x >> 127 == self.high).then_some(x)
    }

    fn plus(self, other: Self) -> Option<Self> {
        let (low, carry) = self.low.overflowing_add(other.low);
        let high = self.high.checked_add(other.high)?.checked_add(carry.into())?;
        Some(Limbs { high, low })
    }

    fn negated(self) -> Option<Self> {
        let (low, carry) = (!self.low).overflowing_add(1);
        Some(Limbs { high: (!self.high).checked_add(carry.into())?, low })
    }

    fn times(self, other: Self) -> Option<Self> {
        let (x, y) = (self.narrow()?, other.narrow()?);
        if let (Ok(x), Ok(y)) = (i64::try_from(x), i64::try_from(y)) {
            return Some((i128::from(x) * i128::from(y)).into());
        }
        // |x|, |y| <= 2^127: the product is at most 2^254.
        let product = Limbs::product(x.unsigned_abs(), y.unsigned_abs());
        if (x < 0) == (y < 0) {
            Some(product)
        } else {
            product.negated()
        }
    }

    /// `x y` for `x`, `y` of at most 2^127, by halves: with `x = a 2^64 + b`, `y = c 2^64 + d`,
    /// `x y = ac 2^128 + (ad + bc) 2^64 + bd`, where `ad + bc < 2^128`.
    fn product(x: u128, y: u128) -> Self {
        const HALF: u128 = u64::MAX as u128;
        let (a, b, c, d) = (x >> 64, x & HALF, y >> 64, y & HALF);
        let middle = a * d + b * c;
        let (low, carry) = (b * d).overflowing_add(middle << 64);
        let high = a * c + (middle >> 64) + u128::from(carry);
        Limbs { high: high.cast_signed(), low }
    }
}

impl Bound for Wide {
    fn add(&self, other: &Self) -> Self {
        Wide(self.0.zip(other.0).and_then(|(x, y)| x.plus(y)))
    }
    fn sub(&self, other: &Self) -> Self {
        Wide(self.0.zip(other.0).and_then(|(x, y)| x.plus(y.negated()?)))
    }
    fn mul(&self, other: &Self) -> Self {
        Wide(self.0.zip(other.0).and_then(|(x, y)| x.times(y)))
    }
    fn is_positive(&self) -> bool {
        self.0.is_some_and(|x| x.high > 0 || (x.high == 0 && x.low > 0))
    }
}
