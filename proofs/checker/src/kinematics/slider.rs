//! Legs of fixed length on linear guides.

use super::{
    map_matrix, map_vector, normalised, projector, JointCoordinate, LegExpansion, LegState,
    UnitExpansion,
};
use crate::claim::Sign;
use crate::enclosure::Scalar;
use crate::linear::{add, apply, dot, norm_squared, scale, Matrix, Vector};
use std::array::from_fn;

/// A leg of fixed length `L` on a linear guide of unit direction `n` (the paper's inverse
/// kinematics):
///
/// ```text
/// r   = w - (n . w) n          s = sqrt(L^2 - |r|^2)      eta = mode s
/// rho = n . w - eta            c - b = r + eta n           row of M = (c - b)^T / eta = n + r / eta
/// ```
#[derive(Clone, Debug)]
pub struct Slider<S> {
    /// Unit direction `n` of the guide.
    n: Vector<S>,
    /// `I - n n^T`.
    projector: Matrix<S>,
    /// `L`.
    length: S,
    /// `L^2`.
    length_squared: S,
    /// The sign of `eta`, +1 or -1.
    mode: S,
}

impl<S: Scalar> Slider<S> {
    /// The leg with this guide direction (of any length but zero) and leg length; `None` if the
    /// direction may be zero.
    pub fn new(direction: &Vector<S>, length: &S, mode: Sign) -> Option<Self> {
        let n = normalised(direction)?;
        let projector = projector(&n);
        let mode = length.integer_like(mode.as_integer());
        let (length, length_squared) = (length.clone(), length.sqr());
        Some(Slider { n, projector, length, length_squared, mode })
    }

    fn r(&self, w: &Vector<S>) -> Vector<S> {
        apply(&self.projector, w)
    }

    fn s_squared(&self, r: &Vector<S>) -> S {
        self.length_squared.sub(&norm_squared(r))
    }

    /// `s^2 = L^2 - |r|^2`.
    pub(super) fn clearance(&self, w: &Vector<S>) -> S {
        self.s_squared(&self.r(w))
    }

    /// `1 - |r|^2 / L^2`.
    pub(super) fn cosine_squared(&self, w: &Vector<S>) -> Option<S> {
        let part = norm_squared(&self.r(w)).div(&self.length_squared)?;
        Some(part.integer_like(1).sub(&part))
    }

    fn state(&self, w: &Vector<S>, r: &Vector<S>, s: &S) -> Option<LegState<S>> {
        let eta = self.mode.mul(s);
        let row = add(&self.n, &scale(&eta.recip()?, r));
        let rho = JointCoordinate::Length(dot(&self.n, w).sub(&eta));
        Some(LegState { row, rho, eta })
    }

    pub(super) fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        let r = self.r(w);
        let s = self.s_squared(&r).sqrt()?;
        self.state(w, &r, &s)
    }

    /// With subscript `c` at the expansion point and `K = s s_c (s + s_c)`:
    ///
    /// ```text
    /// 1/s - 1/s_c = (s_c^2 - s^2) / K = (|r|^2 - |r_c|^2) / K = (r + r_c) . (P - c) / K
    /// r/s - r_c/s_c = (r - r_c)/s + r_c (1/s - 1/s_c)
    /// =>  S         = mode (Pi / s + r_c (r + r_c)^T / K)        Pi = I - n n^T
    ///     rho_slope = n + mode (r + r_c) / (s + s_c)
    /// ```
    ///
    /// since `r - r_c = Pi (P - c)` and `Pi (r + r_c) = r + r_c`. One identity per entry; none is
    /// intersected with another.
    pub(super) fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        let (r_c, r) = (self.r(centre), self.r(over));
        let s_c = self.s_squared(&r_c).sqrt()?;
        let s = self.s_squared(&r).sqrt()?;
        let eta_c = self.mode.mul(&s_c);
        let row = add(&self.n, &scale(&eta_c.recip()?, &r_c));
        let rho_c = dot(&self.n, centre).sub(&eta_c);
        let s_sum = s.add(&s_c);
        let r_sum = add(&r, &r_c);
        let inverse_s = self.mode.mul(&s.recip()?);
        let inverse_k = self.mode.mul(&s.mul(&s_c).mul(&s_sum).recip()?);
        let slope = from_fn(|j| {
            let factor = r_c[j].mul(&inverse_k);
            from_fn(|k| self.projector[j][k].mul(&inverse_s).add(&factor.mul(&r_sum[k])))
        });
        let rho_slope = add(&self.n, &scale(&self.mode.mul(&s_sum.recip()?), &r_sum));
        Some(LegExpansion { row, slope, rho: Some((rho_c, rho_slope)) })
    }

    /// `(r + eta n) / L`, with
    /// `eta - eta_c = -mode (r + r_c) . (P - c) / (s + s_c)`, so that its slope matrix is
    /// `(Pi - mode n (r + r_c)^T / (s + s_c)) / L`.
    pub(super) fn expand_unit(
        &self,
        centre: &Vector<S>,
        over: &Vector<S>,
    ) -> Option<UnitExpansion<S>> {
        let (r_c, r) = (self.r(centre), self.r(over));
        let s_c = self.s_squared(&r_c).sqrt()?;
        let s = self.s_squared(&r).sqrt()?;
        let by = scale(&self.mode.mul(&s.add(&s_c).recip()?), &add(&r, &r_c));
        let inverse = self.length.recip()?;
        let unit = scale(&inverse, &add(&r_c, &scale(&self.mode.mul(&s_c), &self.n)));
        let slope = from_fn(|j| {
            from_fn(|k| inverse.mul(&self.projector[j][k].sub(&self.n[j].mul(&by[k]))))
        });
        Some((unit, slope))
    }
}

impl<S> Slider<S> {
    pub(super) fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Slider<T> {
        Slider {
            n: map_vector(&self.n, convert),
            projector: map_matrix(&self.projector, convert),
            length: convert(&self.length),
            length_squared: convert(&self.length_squared),
            mode: convert(&self.mode),
        }
    }
}
