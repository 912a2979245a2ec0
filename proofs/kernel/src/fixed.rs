//! Intervals with ends in multiples of `2^-bits`: the arithmetic that a proof rests on.
//!
//! Addition and subtraction are exact; products, quotients and roots round outward to the next
//! multiple of `2^-bits`. Two inequalities carry every rounding, for integers `n`, `d > 0`, `k >= 0`:
//!
//! ```text
//! floor(n/d) <= n/d <= ceil(n/d)                 ceil(x) = -floor(-x)
//! r = isqrt(n)  =>  r^2 <= n < (r + 1)^2
//! ```
//!
//! The ends are integers of any size, or machine words. Words give what the others give or, where a
//! number does not fit, nothing: an evaluation in words that succeeds is the evaluation.

use crate::arithmetic::{Arithmetic, Enclosure};
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_traits::{Signed, ToPrimitive};
use std::ops::Shr;

/// Ends of intervals; `None` where a result does not fit.
pub trait Integer: Clone + Default + Ord + Shr<u32, Output = Self> + ToPrimitive {
    /// The time of an operation, in that of one on words.
    const WORK: usize;
    /// The same of a change by a tolerance.
    const CHANGE: usize;
    /// This integer.
    fn of(n: &BigInt) -> Option<Self>;
    /// `n 2^bits`.
    fn scaled(n: i64, bits: u32) -> Option<Self>;
    /// `self + other`.
    fn plus(&self, other: &Self) -> Option<Self>;
    /// `self - other`.
    fn minus(&self, other: &Self) -> Option<Self>;
    /// `-self`.
    fn negated(&self) -> Option<Self>;
    /// `floor(n self / 2^places)`.
    fn dyadic(&self, n: i64, places: u32) -> Option<Self>;
    /// `floor(self other / 2^bits)`.
    fn product(&self, other: &Self, bits: u32) -> Option<Self>;
    /// `floor(self other / divisor)`, for `divisor > 0`.
    fn ratio(&self, other: &Self, divisor: &Self) -> Option<Self>;
    /// `floor(sqrt(self 2^bits))` and whether that is the root exactly, for `self >= 0`.
    fn root(&self, bits: u32) -> Option<(Self, bool)>;
    /// `floor(self / 2)`.
    fn half(&self) -> Self {
        self.clone() >> 1
    }
    /// `-1`, `0` or `1`.
    fn sign(&self) -> i8 {
        self.cmp(&Self::default()) as i8
    }
}

/// Most bits of an end: more than any claim needs, and a bound on what an operation costs.
const MOST_BITS: u64 = 1 << 14;

fn moderate(x: BigInt) -> Option<BigInt> {
    (x.bits() <= MOST_BITS).then_some(x)
}

impl Integer for BigInt {
    const WORK: usize = 128;
    const CHANGE: usize = 64;

    fn of(n: &BigInt) -> Option<Self> {
        Some(n.clone())
    }

    fn scaled(n: i64, bits: u32) -> Option<Self> {
        Some(BigInt::from(n) << bits)
    }

    fn plus(&self, other: &Self) -> Option<Self> {
        moderate(self + other)
    }

    fn minus(&self, other: &Self) -> Option<Self> {
        moderate(self - other)
    }

    fn negated(&self) -> Option<Self> {
        Some(-self)
    }

    fn dyadic(&self, n: i64, places: u32) -> Option<Self> {
        moderate((self * n) >> places)
    }

    fn product(&self, other: &Self, bits: u32) -> Option<Self> {
        // A right shift of a BigInt rounds towards minus infinity.
        moderate((self * other) >> bits)
    }

    fn ratio(&self, other: &Self, divisor: &Self) -> Option<Self> {
        divisor.is_positive().then(|| (self * other).div_floor(divisor)).and_then(moderate)
    }

    fn root(&self, bits: u32) -> Option<(Self, bool)> {
        if self.is_negative() {
            return None;
        }
        let n = self << bits;
        let root = n.sqrt();
        let exact = &root * &root == n;
        Some((root, exact))
    }
}

/// Products of two words have 127 bits at most and fit into `i128`.
impl Integer for i64 {
    const WORK: usize = 1;
    const CHANGE: usize = 4;

    fn of(n: &BigInt) -> Option<Self> {
        n.to_i64()
    }

    fn scaled(n: i64, bits: u32) -> Option<Self> {
        let factor = 1i64.checked_shl(bits).filter(|&factor| factor > 0)?;
        n.checked_mul(factor)
    }

    fn plus(&self, other: &Self) -> Option<Self> {
        self.checked_add(*other)
    }

    fn minus(&self, other: &Self) -> Option<Self> {
        self.checked_sub(*other)
    }

    fn negated(&self) -> Option<Self> {
        self.checked_neg()
    }

    fn dyadic(&self, n: i64, places: u32) -> Option<Self> {
        // Most products by few digits fit into a word.
        match self.checked_mul(n) {
            Some(product) => Some(product >> places.min(63)),
            None => self.product(&n, places),
        }
    }

    fn product(&self, other: &Self, bits: u32) -> Option<Self> {
        let floor = (i128::from(*self) * i128::from(*other)) >> (bits & 63);
        i64::try_from(floor).ok().filter(|_| bits < 64)
    }

    fn ratio(&self, other: &Self, divisor: &Self) -> Option<Self> {
        let divisor = u64::try_from(*divisor).ok().filter(|&divisor| divisor > 0)?;
        let product = i128::from(*self) * i128::from(*other);
        // floor(-s/d) = -1 - floor((s - 1)/d): of a negative product all bits are turned, and those of the quotient.
        let sign = product >> 127;
        let size = (product ^ sign) as u128;
        let quotient =
            by_digits(size, divisor).map_or_else(|| size / u128::from(divisor), u128::from);
        Some(i64::try_from(quotient).ok()? ^ sign as i64)
    }

    fn root(&self, bits: u32) -> Option<(Self, bool)> {
        let n = u128::try_from(*self).ok()?;
        let n = n.checked_mul(1u128.checked_shl(bits)?)?;
        let root = n.isqrt();
        Some((root.try_into().ok()?, root * root == n))
    }
}

/// `floor(size / divisor)` by two digits of 32 bits; only where no instruction divides 128 bits, as in WebAssembly.
/// However the digits are found, `q` is the floor if `0 <= size - q divisor < divisor`.
fn by_digits(size: u128, divisor: u64) -> Option<u64> {
    if !cfg!(any(test, target_family = "wasm")) || (size >> 64) as u64 >= divisor {
        return None;
    }
    let (shifted, by) = (size << divisor.leading_zeros(), divisor << divisor.leading_zeros());
    let (high, low) = (by >> 32, by & 0xffff_ffff);
    // A digit of the quotient from the upper half of the divisor is at most two too great.
    let digit = |rest: u64, next: u64| {
        let (mut digit, mut over) = (rest / high, rest - rest / high * high);
        while over >> 32 == 0 && (digit >> 32 != 0 || digit * low > (over << 32 | next)) {
            (digit, over) = (digit - 1, over + high);
        }
        (digit, (rest << 32 | next).wrapping_sub(digit.wrapping_mul(by)))
    };
    let (upper, rest) = digit((shifted >> 64) as u64, (shifted >> 32) as u64 & 0xffff_ffff);
    let (lower, _) = digit(rest, shifted as u64 & 0xffff_ffff);
    let quotient = upper << 32 | lower;
    let rest = size.checked_sub(u128::from(quotient) * u128::from(divisor))?;
    (rest < u128::from(divisor)).then_some(quotient)
}

/// `[lo, hi] / 2^bits`, with `lo <= hi`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Interval<Z> {
    /// Lower end.
    pub lo: Z,
    /// Upper end.
    pub hi: Z,
}

impl<Z: Clone> Interval<Z> {
    /// The interval of one number.
    pub fn point(x: Z) -> Self {
        Interval { lo: x.clone(), hi: x }
    }
}

/// The arithmetic with this many fractional bits, on ends of type `Z`.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<Z> {
    bits: u32,
    ends: std::marker::PhantomData<Z>,
}

impl<Z: Integer> Fixed<Z> {
    /// The arithmetic with `bits` fractional bits.
    pub fn new(bits: u32) -> Self {
        Fixed { bits, ends: std::marker::PhantomData }
    }

    /// The fractional bits.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// `floor(a b)`.
    fn down(&self, a: &Z, b: &Z) -> Option<Z> {
        a.product(b, self.bits)
    }

    /// `ceil(a b) = -floor(-a b)`.
    fn up(&self, a: &Z, b: &Z) -> Option<Z> {
        a.negated()?.product(b, self.bits)?.negated()
    }
}

/// The least value that `down` and the greatest that `up` takes at the ends between which all
/// products of numbers in `a` and `b` lie; both increase with the product.
///
/// | `a` \ `b` | `b >= 0`           | `b <= 0`           | mixed                                |
/// |-----------|--------------------|--------------------|--------------------------------------|
/// | `a >= 0`  | `[lo lo', hi hi']` | `[hi lo', lo hi']` | `[hi lo', hi hi']`                   |
/// | `a <= 0`  | `[lo hi', hi lo']` | `[hi hi', lo lo']` | `[lo hi', lo lo']`                   |
/// | mixed     | `[lo hi', hi hi']` | `[hi lo', lo lo']` | least of `lo hi'`, `hi lo'`, greatest of `lo lo'`, `hi hi'` |
#[inline]
fn over_ends<Z: Integer>(
    a: &Interval<Z>,
    b: &Interval<Z>,
    down: impl Fn(&Z, &Z) -> Option<Z>,
    up: impl Fn(&Z, &Z) -> Option<Z>,
) -> Option<Interval<Z>> {
    let ((lo, hi), (lo_b, hi_b)) = ((&a.lo, &a.hi), (&b.lo, &b.hi));
    // Of either factor, the end that the lower and the upper product take.
    let (below, above) = match ((lo.sign(), hi.sign()), (lo_b.sign(), hi_b.sign())) {
        ((0.., _), (0.., _)) => ((lo, lo_b), (hi, hi_b)),
        ((0.., _), (_, ..=0)) => ((hi, lo_b), (lo, hi_b)),
        ((0.., _), _) => ((hi, lo_b), (hi, hi_b)),
        ((_, ..=0), (0.., _)) => ((lo, hi_b), (hi, lo_b)),
        ((_, ..=0), (_, ..=0)) => ((hi, hi_b), (lo, lo_b)),
        ((_, ..=0), _) => ((lo, hi_b), (lo, lo_b)),
        (_, (0.., _)) => ((lo, hi_b), (hi, hi_b)),
        (_, (_, ..=0)) => ((hi, lo_b), (lo, lo_b)),
        _ => {
            let least = down(lo, hi_b)?.min(down(hi, lo_b)?);
            return Some(Interval { lo: least, hi: up(lo, lo_b)?.max(up(hi, hi_b)?) });
        }
    };
    Some(Interval { lo: down(below.0, below.1)?, hi: up(above.0, above.1)? })
}

/// The greatest absolute value in an interval.
fn magnitude<Z: Integer>(a: &Interval<Z>) -> Option<Z> {
    Some(a.hi.clone().max(a.lo.negated()?))
}

impl<Z: Integer> Arithmetic for Fixed<Z> {
    type Number = Interval<Z>;

    fn integer(&self, n: i64) -> Option<Interval<Z>> {
        Some(Interval::point(Z::scaled(n, self.bits)?))
    }

    fn add(&self, a: &Interval<Z>, b: &Interval<Z>) -> Option<Interval<Z>> {
        Some(Interval { lo: a.lo.plus(&b.lo)?, hi: a.hi.plus(&b.hi)? })
    }

    fn sub(&self, a: &Interval<Z>, b: &Interval<Z>) -> Option<Interval<Z>> {
        Some(Interval { lo: a.lo.minus(&b.hi)?, hi: a.hi.minus(&b.lo)? })
    }

    fn neg(&self, a: &Interval<Z>) -> Option<Interval<Z>> {
        Some(Interval { lo: a.hi.negated()?, hi: a.lo.negated()? })
    }

    fn mul(&self, a: &Interval<Z>, b: &Interval<Z>) -> Option<Interval<Z>> {
        over_ends(a, b, |x, y| self.down(x, y), |x, y| self.up(x, y))
    }

    fn div(&self, a: &Interval<Z>, b: &Interval<Z>) -> Option<Interval<Z>> {
        self.mul(a, &self.recip(b)?)
    }

    fn sqr(&self, a: &Interval<Z>) -> Option<Interval<Z>> {
        let (least, greatest) = match (a.lo.sign(), a.hi.sign()) {
            (0.., _) => (a.lo.clone(), a.hi.clone()),
            (_, ..=0) => (a.hi.negated()?, a.lo.negated()?),
            _ => (Z::default(), magnitude(a)?),
        };
        Some(Interval { lo: self.down(&least, &least)?, hi: self.up(&greatest, &greatest)? })
    }

    /// `sqrt(x/2^bits) 2^bits = sqrt(x 2^bits)`, which is at most `isqrt + 1` where `isqrt` is not it.
    fn sqrt(&self, a: &Interval<Z>) -> Option<Interval<Z>> {
        if a.lo.sign() <= 0 {
            return None;
        }
        let (lo, _) = a.lo.root(self.bits)?;
        let (root, exact) = a.hi.root(self.bits)?;
        let hi = if exact { root } else { root.plus(&Z::scaled(1, 0)?)? };
        Some(Interval { lo, hi })
    }
}

impl<Z: Integer> Enclosure for Fixed<Z> {
    const EXACT_SUMS: bool = true;

    /// `1/(x/2^bits) 2^bits = 2^(2 bits)/x` decreases on either side of zero, and is odd; there is no ratio by
    /// what is not positive.
    #[inline]
    fn recip(&self, a: &Interval<Z>) -> Option<Interval<Z>> {
        if a.hi.sign() < 0 {
            return self.neg(&self.recip(&self.neg(a)?)?);
        }
        let one = Z::scaled(1, self.bits)?;
        let hi = one.negated()?.ratio(&one, &a.lo)?.negated()?;
        Some(Interval { lo: one.ratio(&one, &a.hi)?, hi })
    }

    fn halve(&self, a: &Interval<Z>) -> Option<Interval<Z>> {
        Some(Interval { lo: a.lo.half(), hi: a.hi.negated()?.half().negated()? })
    }

    /// A product divided by `[c, d]`: a lower end by `d` where it is not negative, else by `c`; an
    /// upper one the other way round.
    #[inline]
    fn ratio(&self, a: &Interval<Z>, b: &Interval<Z>, c: &Interval<Z>) -> Option<Interval<Z>> {
        let negative = |x: &Z, y: &Z| x.sign() * y.sign() < 0;
        let down = |x: &Z, y: &Z| x.ratio(y, if negative(x, y) { &c.lo } else { &c.hi });
        let up = |x: &Z, y: &Z| {
            let divisor = if negative(x, y) { &c.hi } else { &c.lo };
            x.negated()?.ratio(y, divisor)?.negated()
        };
        over_ends(a, b, down, up)
    }

    #[inline]
    fn dyadic(&self, n: i64, places: u32, a: &Interval<Z>) -> Option<Interval<Z>> {
        let (lo, hi) = if n >= 0 { (&a.lo, &a.hi) } else { (&a.hi, &a.lo) };
        let hi = hi.negated()?.dyadic(n, places)?.negated()?;
        Some(Interval { lo: lo.dyadic(n, places)?, hi })
    }

    #[inline]
    fn within(
        &self,
        range: &Interval<Z>,
        centre: &Interval<Z>,
        slopes: &[Interval<Z>],
    ) -> Option<Interval<Z>> {
        let reach = slopes.iter().try_fold(Z::default(), |sum, s| sum.plus(&magnitude(s)?))?;
        let lo = range.lo.clone().max(centre.lo.minus(&reach)?);
        let hi = range.hi.clone().min(centre.hi.plus(&reach)?);
        (lo <= hi).then_some(Interval { lo, hi })
    }

    fn hull(&self, a: &Interval<Z>, b: &Interval<Z>) -> Interval<Z> {
        Interval { lo: a.lo.clone().min(b.lo.clone()), hi: a.hi.clone().max(b.hi.clone()) }
    }

    fn ends(&self, a: &Interval<Z>) -> [Interval<Z>; 2] {
        [Interval::point(a.lo.clone()), Interval::point(a.hi.clone())]
    }

    fn is_positive(&self, a: &Interval<Z>) -> bool {
        a.lo.sign() > 0
    }

    fn is_nonnegative(&self, a: &Interval<Z>) -> bool {
        a.lo.sign() >= 0
    }

    /// The middle; precisions are 32 bits or more, places fewer.
    fn rounded(&self, a: &Interval<Z>, places: u32) -> Option<i64> {
        a.lo.plus(&a.hi)?.half().dyadic(1, self.bits.checked_sub(places)?)?.to_i64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_divided_by_digits_is_the_floor() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let (size, kind) = (state >> 58, state >> 32 & 7);
            match kind {
                0 => [0, 1, -1, i64::MAX, i64::MIN][size as usize % 5],
                1 => 1i64.wrapping_shl(size as u32),
                _ => {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    (state as i64).wrapping_mul(0x9e37_79b9_7f4a_7c15_u64 as i64) >> size
                }
            }
        };
        let mut found = 0;
        for n in 0..200_000 {
            let (a, b, divisor) = (next(), next(), next().max(1));
            // Some quotients are integers.
            let a = if n % 4 == 0 { (a % 1000).saturating_mul(divisor) } else { a };
            let [big, other, by] = [a, b, divisor].map(BigInt::from);
            let floor = (big * other).div_floor(&by).to_i64();
            assert_eq!(a.ratio(&b, &divisor), floor, "{a} {b} {divisor}");
            let (size, by) = ((i128::from(a) * i128::from(b)).unsigned_abs(), divisor as u64);
            if let Some(own) = by_digits(size, by) {
                assert_eq!(u128::from(own), size / u128::from(by), "{a} {b} {divisor}");
                found += 1;
            }
        }
        assert!(found > 80_000, "{found}");
    }
}
