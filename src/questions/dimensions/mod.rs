//! Dimensions of the Orthoglide of a cube: the paper's Steps 1 to 3, every number enclosed.
//!
//! `psi_max`, the side of the cube and the offset are exact real numbers; so are the leg length and
//! the rest, which are enclosed in integers with outward rounding, in as many bits as the digits
//! that are asked for need.

mod angle;

pub use angle::atan;

use crate::exact::Exact;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Signed;
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::trig::pi;
use std::cmp::Ordering;

/// Fractional bits tried, fewest first.
const PRECISIONS: [u32; 6] = [256, 512, 1024, 2048, 4096, 8000];
/// Bits by which every enclosure is finer than the digits that are shown of it.
const GUARD_BITS: u64 = 8;

/// The symbol of the base point.
const BASE: &str = "a";

/// What a quantity is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The unit of the cube's side.
    Length,
    /// Degrees.
    Degree,
}

/// A dimension of the machine, or a limit of its joints.
#[derive(Clone, Debug)]
pub struct Dimension {
    /// The symbol of the paper, in letters of ASCII.
    pub symbol: &'static str,
    /// What it is.
    pub name: &'static str,
    /// What it is measured in.
    pub unit: Unit,
    /// An interval that contains it, in units of `2^-bits`.
    pub value: Interval<BigInt>,
    /// Fractional bits.
    pub bits: u32,
}

impl Dimension {
    /// A number that it is not less than.
    pub fn inf(&self) -> BigRational {
        BigRational::new(self.value.lo.clone(), BigInt::from(1) << self.bits)
    }

    /// A number that it is not greater than.
    pub fn sup(&self) -> BigRational {
        BigRational::new(self.value.hi.clone(), BigInt::from(1) << self.bits)
    }
}

/// Why there is no machine, or none that can be enclosed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DimensionError {
    /// `psi_max` is not provably greater than 1.
    #[error("psi_max is not (provably) greater than 1; accepted: a number greater than 1")]
    PsiMaxNotAboveOne,
    /// The side of the cube is not provably positive.
    #[error("the side of the cube is not (provably) positive; accepted: a number greater than 0")]
    CubeNotPositive,
    /// The numbers are too large, or too close to a limit, to be enclosed.
    #[error("the numbers are too large, or too close to their limits, to be enclosed")]
    Precision,
}

/// The dimensions for `psi_max > 1`, a cube of side `cube > 0` and a platform offset `e`, each
/// enclosed to `digits` significant digits: with `kappa = 1/psi_max`, `t_1 = (1 - kappa)/2` and
/// `t_2 = 1 - kappa` for `kappa <= 1/2`, `(1/kappa - 1)/2` above,
///
/// ```text
/// q_k / L  = sin(beta_Qk) = -+ t_k / sqrt(1 + 2 t_k^2)          L = cube / (q_2/L - q_1/L)
/// a        = q_1 - e - L                                        rho_max = cube + L - s(Q_2)
/// s(Q_2)   = sqrt(L^2 - 2 q_2^2) = L / sqrt(1 + 2 t_2^2)        tan(theta_Qk) = -+ t_k
/// ```
///
/// and over the whole cube, where `tan(theta) = y / sqrt(L^2 - y^2 - z^2)` grows with `y`, and with
/// `|z|` away from zero, and `|q_1| <= q_2`: its least value is at `y = q_1`, `z = q_2`, its greatest
/// is `t_2`; `sin(beta) = z / L` ranges from `q_1/L` to `q_2/L`.
///
/// # Errors
/// [`DimensionError`]
pub fn dimensions(
    psi_max: &Exact,
    cube: &Exact,
    offset: &Exact,
    digits: u32,
) -> Result<Vec<Dimension>, DimensionError> {
    if psi_max.compare(&Exact::integer(1)) != Some(Ordering::Greater) {
        return Err(DimensionError::PsiMaxNotAboveOne);
    }
    if cube.sign() != Some(1) {
        return Err(DimensionError::CubeNotPositive);
    }
    let below_two = match psi_max.compare(&Exact::integer(2)) {
        Some(order) => order == Ordering::Less,
        None => return Err(DimensionError::Precision),
    };
    let enclosed = |bits: &u32| enclose((psi_max, below_two), cube, offset, *bits);
    let fine = |all: &Vec<Dimension>| all.iter().all(|dimension| is_fine(dimension, digits));
    PRECISIONS.iter().filter_map(enclosed).find(fine).ok_or(DimensionError::Precision)
}

/// Whether an enclosure is narrow enough for so many significant digits: exact, or of a width below
/// `10^-digits 2^-GUARD_BITS` of its magnitude. The base point, which an offset may bring to zero
/// where no precision tells, is fine in the highest.
fn is_fine(Dimension { symbol, value: x, bits, .. }: &Dimension, digits: u32) -> bool {
    if crosses_zero(x) {
        return x.lo == x.hi || (*symbol == BASE && Some(bits) == PRECISIONS.last());
    }
    let width = &x.hi - &x.lo;
    let magnitude = x.lo.bits().min(x.hi.bits());
    // 10^d < 2^(10 d / 3 + 1), since 10 < 2^(10/3).
    let needed = u64::from(digits) * 10 / 3 + 1 + GUARD_BITS;
    width.bits() == 0 || magnitude >= needed + width.bits()
}

fn crosses_zero(x: &Interval<BigInt>) -> bool {
    !x.lo.is_positive() && !x.hi.is_negative()
}

/// Every dimension at a precision of `bits`; `None` where that does not suffice.
fn enclose(
    (psi_max, below_two): (&Exact, bool),
    cube: &Exact,
    offset: &Exact,
    bits: u32,
) -> Option<Vec<Dimension>> {
    let f = Fixed::<BigInt>::new(bits);
    let (one, cube, offset) = (f.integer(1)?, cube.enclose(bits)?, offset.enclose(bits)?);
    let psi_max = psi_max.enclose(bits)?;
    let rest = f.sub(&one, &f.recip(&psi_max)?)?;
    let t1 = f.halve(&rest)?;
    let t2 = if below_two { f.halve(&f.sub(&psi_max, &one)?)? } else { rest };
    // sqrt(1 + 2 t^2), and t over it.
    let root = |t: &Interval<BigInt>| f.sqrt(&f.add(&one, &f.mul(&f.integer(2)?, &f.sqr(t)?)?)?);
    let sine = |t: &Interval<BigInt>| f.div(t, &root(t)?);
    let (sin1, sin2) = (f.neg(&sine(&t1)?)?, sine(&t2)?);
    let length = f.div(&cube, &f.sub(&sin2, &sin1)?)?;
    let (q1, q2) = (f.mul(&length, &sin1)?, f.mul(&length, &sin2)?);
    let base = f.sub(&f.sub(&q1, &offset)?, &length)?;
    let s_q2 = f.div(&length, &root(&t2)?)?;
    let rho_max = f.sub(&f.add(&cube, &length)?, &s_q2)?;
    let cos_corner = f.sqrt(&f.sub(&f.sub(&one, &f.sqr(&sin1)?)?, &f.sqr(&sin2)?)?)?;
    let least_tangent = f.div(&sin1, &cos_corner)?;
    let degrees = f.div(&f.integer(180)?, &pi(bits)?)?;
    let angle = |tangent: &Interval<BigInt>| f.mul(&atan(tangent, bits)?, &degrees);
    // beta is in (-90, 90) degrees: tan(beta) = sin(beta) / sqrt(1 - sin^2(beta)).
    let arcsine =
        |sine: &Interval<BigInt>| angle(&f.div(sine, &f.sqrt(&f.sub(&one, &f.sqr(sine)?)?)?)?);
    let new = |symbol, name, unit, value| Dimension { symbol, name, unit, value, bits };
    let (mm, degree) = (Unit::Length, Unit::Degree);
    Some(vec![
        new("L", "leg length", mm, length),
        new("q1", "corner Q1 = (q1, q1, q1)", mm, q1),
        new("q2", "corner Q2 = (q2, q2, q2)", mm, q2),
        new(BASE, "base point of each guide", mm, base),
        new("rho_max", "joint range, from 0", mm, rho_max),
        new("theta_Q1", "theta at Q1", degree, angle(&f.neg(&t1)?)?),
        new("theta_Q2", "theta at Q2", degree, angle(&t2)?),
        new("theta_min", "least theta in the cube", degree, angle(&least_tangent)?),
        new("theta_max", "greatest theta in the cube", degree, angle(&t2)?),
        new("beta_Q1", "beta at Q1, the least", degree, arcsine(&sin1)?),
        new("beta_Q2", "beta at Q2, the greatest", degree, arcsine(&sin2)?),
    ])
}

#[cfg(test)]
mod tests;
