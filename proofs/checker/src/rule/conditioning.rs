//! The condition number of `M` over a cell.

use super::vertex::{symmetric_at, twice_rotated, Rotation};
use super::Failure;
use crate::definite::is_positive_definite;
use crate::enclosure::Enclosure;
use crate::expansion::Expansion;
use crate::hull::LAMBDA_BITS;
use crate::linear::Symmetric;
use crate::model::Model;
use std::array::from_fn;

/// Binary places of the components of [`Mu`].
pub const MU_BITS: u32 = 40;
/// Largest absolute value of a component of [`Mu`].
const MAX_MU: i64 = 1 << 60;

/// An affine function on the cell, as evidence: `mu = (m_0 + sum_k lambda_k m_k) / 2^40` with
/// `lambda_k` in `[-1, 1]` from the lower to the upper end of axis `k`.
pub type Mu = [i64; 4];

/// **Conditioning.** With `A(v)` as in [`crate::rule::lower`], `W` orthogonal and `mu` affine: if at
/// the vertices `mu(v) > 0`, `sym(W A(v)) - mu(v) I` is positive definite, and so is
/// `(c mu(v))^2 I - A(v)^T A(v)`, then `sigma_max(M) < c sigma_min(M)` on the cell.
///
/// *Proof.* Fix `P`. As in the vertex rules, by convexity: `sym(W M) - mu I` is positive definite
/// for the value `mu` of the affine function there, so `sigma_min(M) > mu > 0`; and
/// `||A|| - c mu` is convex and negative at the vertices, so `sigma_max(M) < c mu`. ∎
pub fn conditioning<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    rotation: &Rotation,
    mu: &Mu,
) -> Result<(), Failure> {
    let c = model.bounds.conditioning.as_ref().ok_or(Failure::NoSuchBound)?;
    let (w, norm) = rotation.numerators().ok_or(Failure::BadRotation)?;
    if mu.iter().any(|m| !(-MAX_MU..=MAX_MU).contains(m)) {
        return Err(Failure::BadMu);
    }
    let at_centre = twice_rotated(&w, &expansion.matrix);
    let slopes: [Symmetric<S>; 3] = from_fn(|k| twice_rotated(&w, &expansion.slopes[k]));
    for vertex in expansion.hull.vertices() {
        // 2^16 mu(v) 2^40: the sum of four products of at most 2^76 fits i128.
        let terms = mu[1..].iter().zip(vertex.lambda).map(|(&m, l)| i128::from(m) * i128::from(l));
        let value = (i128::from(mu[0]) << LAMBDA_BITS) + terms.sum::<i128>();
        if value <= 0 {
            return Err(Failure::BadMu);
        }
        let mu = c.dyadic_like(value.unsigned_abs(), MU_BITS + LAMBDA_BITS);
        let symmetric = symmetric_at(&at_centre, &slopes, &vertex);
        let lower = symmetric.minus_identity(&mu.mul(&mu.integer_like(2 * norm)));
        let upper =
            Symmetric::gram_of(&expansion.matrix_at(&vertex)).subtracted_from(&c.mul(&mu).sqr());
        if !(is_positive_definite(&lower) && is_positive_definite(&upper)) {
            return Err(Failure::NotDefinite { vertex: vertex.number });
        }
    }
    Ok(())
}
