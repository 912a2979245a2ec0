//! Intervals of doubles whose ends are rounded to nearest, not outward: proposals at the price of
//! plain arithmetic.
//!
//! Nothing that is found with them holds until it is confirmed in exact arithmetic; they err by a
//! few units in the last place.

use crate::interval::Interval;
use orthocert_checker::enclosure::{Bound, Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;

/// `[lo, hi]`, nearly. Ends that are not numbers make every test fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rough {
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

/// An end of a [`Rough`] interval.
#[derive(Clone, Copy, Debug)]
pub struct End(f64);

/// The less of two doubles, by one comparison.
fn least(a: f64, b: f64) -> f64 {
    if a < b {
        a
    } else {
        b
    }
}

/// The greater of two doubles, by one comparison.
fn greatest(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}

impl Rough {
    fn point(x: f64) -> Self {
        Rough { lo: x, hi: x }
    }

    /// A double near the middle.
    pub fn mid(&self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    /// Greatest absolute value.
    pub fn mag(&self) -> f64 {
        greatest(self.lo.abs(), self.hi.abs())
    }
}

impl Scalar for Rough {
    #[inline]
    fn integer_like(&self, n: i64) -> Self {
        Rough::point(n as f64)
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        Rough { lo: self.lo + other.lo, hi: self.hi + other.hi }
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        Rough { lo: self.lo - other.hi, hi: self.hi - other.lo }
    }

    #[inline]
    fn neg(&self) -> Self {
        Rough { lo: -self.hi, hi: -self.lo }
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let (a, b) = (self.lo * other.lo, self.lo * other.hi);
        let (c, d) = (self.hi * other.lo, self.hi * other.hi);
        Rough { lo: least(least(a, b), least(c, d)), hi: greatest(greatest(a, b), greatest(c, d)) }
    }

    #[inline]
    fn sqr(&self) -> Self {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let straddles = self.lo < 0.0 && self.hi > 0.0;
        Rough { lo: if straddles { 0.0 } else { least(a, b) }, hi: greatest(a, b) }
    }

    #[inline]
    fn recip(&self) -> Option<Self> {
        let one_sign = self.lo > 0.0 || self.hi < 0.0;
        one_sign.then(|| Rough { lo: 1.0 / self.hi, hi: 1.0 / self.lo })
    }

    #[inline]
    fn sqrt(&self) -> Option<Self> {
        (self.lo > 0.0).then(|| Rough { lo: self.lo.sqrt(), hi: self.hi.sqrt() })
    }
}

impl Enclosure for Rough {
    type Bound = End;

    fn from_fixed(x: &Fixed) -> Self {
        let near = Interval::from_fixed(x);
        Rough { lo: near.inf(), hi: near.sup() }
    }

    #[inline]
    fn dyadic_like(&self, index: u128, level: u32) -> Self {
        // Levels are at most 41: a shift of the exponent.
        Rough::point(index as u64 as f64 / (1u64 << level.min(63)) as f64)
    }

    #[inline]
    fn join(&self, other: &Self) -> Self {
        Rough { lo: least(self.lo, other.lo), hi: greatest(self.hi, other.hi) }
    }

    #[inline]
    fn meet(&self, other: &Self) -> Option<Self> {
        let both = Rough { lo: greatest(self.lo, other.lo), hi: least(self.hi, other.hi) };
        (both.lo <= both.hi).then_some(both)
    }

    fn ends(&self) -> [Self; 2] {
        [Rough::point(self.lo), Rough::point(self.hi)]
    }

    #[inline]
    fn lower(&self) -> End {
        End(self.lo)
    }

    #[inline]
    fn upper(&self) -> End {
        End(self.hi)
    }

    #[inline]
    fn is_positive(&self) -> bool {
        self.lo > 0.0
    }

    #[inline]
    fn is_nonnegative(&self) -> bool {
        self.lo >= 0.0
    }
}

impl Bound for End {
    #[inline]
    fn add(&self, other: &Self) -> Self {
        End(self.0 + other.0)
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        End(self.0 - other.0)
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        End(self.0 * other.0)
    }

    #[inline]
    fn is_positive(&self) -> bool {
        self.0 > 0.0
    }
}
