//! Extensible legs, as in Tsai's 3-UPU.

use super::{JointCoordinate, LegExpansion, LegState};
use crate::enclosure::Scalar;
use crate::linear::{add, norm_squared, scale, Vector};
use std::array::from_fn;
use std::marker::PhantomData;

/// An extensible leg: `l = |w|`, row of `M` = `w^T / l`, `rho = l`; singular at `l = 0`.
#[derive(Clone, Debug)]
pub struct Strut<S>(PhantomData<S>);

impl<S: Scalar> Strut<S> {
    /// The leg: it has no parameters but those of `w`.
    pub fn new(_like: &S) -> Self {
        Strut(PhantomData)
    }

    pub(super) fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        let length = norm_squared(w).sqrt()?;
        let row = scale(&length.recip()?, w);
        Some(LegState { row, eta: length.clone(), rho: JointCoordinate::Length(length) })
    }

    /// With subscript `c` at the expansion point:
    ///
    /// ```text
    /// w/l - w_c/l_c = (w - w_c)/l + w_c (l_c - l)/(l l_c)
    /// l - l_c       = (l^2 - l_c^2)/(l + l_c) = (w + w_c) . (P - c)/(l + l_c)
    /// =>  S         = I/l - w_c (w + w_c)^T / (l l_c (l + l_c))
    ///     rho_slope = (w + w_c)/(l + l_c)
    /// ```
    pub(super) fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        let l_c = norm_squared(centre).sqrt()?;
        let l = norm_squared(over).sqrt()?;
        let inverse = l.recip()?;
        let inverse_sum = l.add(&l_c).recip()?;
        let sum = add(over, centre);
        let unit_c = scale(&l_c.recip()?, centre);
        let rho_slope = scale(&inverse_sum, &sum);
        let slope = from_fn(|j| {
            let factor = unit_c[j].mul(&inverse);
            from_fn(|k| {
                let identity = if j == k { inverse.clone() } else { l.integer_like(0) };
                identity.sub(&factor.mul(&rho_slope[k]))
            })
        });
        Some(LegExpansion { row: unit_c, slope, rho: Some((l_c, rho_slope)) })
    }

    /// `|w|^2`.
    pub(super) fn clearance(&self, w: &Vector<S>) -> S {
        norm_squared(w)
    }
}

impl<S> Strut<S> {
    pub(super) fn map<T>(&self, _convert: &impl Fn(&S) -> T) -> Strut<T> {
        Strut(PhantomData)
    }
}
