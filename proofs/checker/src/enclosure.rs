//! The arithmetic that kinematics and rules are written in, once for every number type.
//!
//! [`Scalar`] is a number or an interval with `+ - *`, squares, reciprocals and square roots;
//! [`Enclosure`] adds what a proof needs: endpoints and certain signs. The checker instantiates
//! both with [`Fixed`], exact integers with outward rounding. A program that searches for proofs
//! may instantiate the same formulas with faster arithmetic; nothing it computes is believed.

use crate::fixed::Fixed;
use num_bigint::BigInt;
use num_traits::Signed;

/// A real number, its approximation, or an interval around it.
///
/// For interval types every operation encloses: if `x` is in `a` and `y` in `b`, then `x op y` is
/// in `a op b`. Partial operations return `None` unless they are defined on all of the operand.
pub trait Scalar: Clone {
    /// The integer `n`, exactly, in the precision of `self`.
    fn integer_like(&self, n: i64) -> Self;
    /// `x + y`.
    fn add(&self, other: &Self) -> Self;
    /// `x - y`.
    fn sub(&self, other: &Self) -> Self;
    /// `-x`.
    fn neg(&self) -> Self;
    /// `x y`.
    fn mul(&self, other: &Self) -> Self;
    /// `x^2`; tighter than `mul` with itself, and never below zero.
    fn sqr(&self) -> Self;
    /// `1 / x`; `None` where `x` may be zero.
    fn recip(&self) -> Option<Self>;
    /// `sqrt(x)`; `None` unless `x` is certainly positive.
    fn sqrt(&self) -> Option<Self>;
    /// `x / y`; `None` where `y` may be zero.
    fn div(&self, other: &Self) -> Option<Self> {
        other.recip().map(|r| self.mul(&r))
    }
}

/// A closed, non-empty interval of real numbers.
pub trait Enclosure: Scalar {
    /// The type of an endpoint; sign tests on polynomials of endpoints are sound in it.
    type Bound: Bound;
    /// An enclosure of everything that `x` encloses.
    fn from_fixed(x: &Fixed) -> Self;
    /// `index / 2^level`, in the precision of `self`.
    fn dyadic_like(&self, index: u128, level: u32) -> Self;
    /// The interval hull of both.
    fn join(&self, other: &Self) -> Self;
    /// The intersection; `None` if it is empty.
    fn meet(&self, other: &Self) -> Option<Self>;
    /// Both endpoints, each as an interval.
    fn ends(&self) -> [Self; 2];
    /// Lower endpoint.
    fn lower(&self) -> Self::Bound;
    /// Upper endpoint.
    fn upper(&self) -> Self::Bound;
    /// Every element is `> 0`.
    fn is_positive(&self) -> bool;
    /// Every element is `>= 0`.
    fn is_nonnegative(&self) -> bool;
}

/// The endpoint of an interval, as an element of a ring in which "certainly positive" is decidable
/// in one direction: where `is_positive` answers true, the real number is positive.
///
/// All endpoints of one matrix carry the same positive unit (`2^-bits` for [`Fixed`]); a
/// homogeneous polynomial of them has the sign that it has without the unit.
pub trait Bound: Clone {
    /// `x + y`.
    fn add(&self, other: &Self) -> Self;
    /// `x - y`.
    fn sub(&self, other: &Self) -> Self;
    /// `x y`.
    fn mul(&self, other: &Self) -> Self;
    /// Certainly `> 0`.
    fn is_positive(&self) -> bool;
}

impl Bound for BigInt {
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn is_positive(&self) -> bool {
        Signed::is_positive(self)
    }
}
