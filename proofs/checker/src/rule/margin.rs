//! Distances to singularities: `eta_i / L_i` and `det A / (L_1 L_2 L_3)`.

use super::Failure;
use crate::cell::Cell;
use crate::enclosure::Enclosure;
use crate::expansion::{ExpansionPoint, Region};
use crate::linear::{determinant, Matrix};
use crate::model::Model;
use std::array::from_fn;

/// **Serial margin.** `(eta_i / L_i)^2` is at least the square of its bound on the cell, for every
/// leg. *Proof.* It is in the value of its formula over the cell. ∎
pub fn serial_margin<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    cosines_at_least(model, cell, model.bounds.serial_margin.as_ref())
}

/// **Leg angle.** The angle between leg and guide is at most its bound, which is at most 90
/// degrees, on the cell, for every leg. *Proof.* Its cosine is `|eta_i| / L_i >= 0`; the cosine of
/// the bound is not negative, and cosines decrease on `[0, 90]` degrees. ∎
pub fn leg_angle<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    cosines_at_least(model, cell, model.bounds.leg_angle.as_ref())
}

fn cosines_at_least<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    bound: Option<&S>,
) -> Result<(), Failure> {
    let bound = bound.ok_or(Failure::NoSuchBound)?;
    let over = Region::new(model, cell, ExpansionPoint::Centre).over;
    for (i, leg) in model.legs.iter().enumerate() {
        let cosine = leg.cosine_squared(&over[i]).ok_or(Failure::OutOfReach(i))?;
        if !cosine.sub(bound).is_nonnegative() {
            return Err(Failure::OutOfRange(i));
        }
    }
    Ok(())
}

/// **Parallel margin.** `|det U| >= bound` on the cell, where the rows `u_i` of `U` are the unit leg
/// vectors, so that `det U = det A / (L_1 L_2 L_3)`.
///
/// *Proof.* With `c_i` the value of `u_i` at the expansion point and
/// `u_i - c_i = sum_k delta_k e_ik` by the slope identity, the determinant, linear in each row, has
///
/// ```text
/// det(u_1, u_2, u_3) - det(c_1, c_2, c_3)
///   = det(u_1 - c_1, u_2, u_3) + det(c_1, u_2 - c_2, u_3) + det(c_1, c_2, u_3 - c_3)
///   = sum_k delta_k [det(e_1k, u_2, u_3) + det(c_1, e_2k, u_3) + det(c_1, c_2, e_3k)]
/// ```
///
/// with `u_i` in `c_i + sum_k [-1, 1] h_k e_ik`. The sum is enclosed, and the result compared with
/// the bound on either side of zero. ∎
pub fn parallel_margin<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    let bound = model.bounds.parallel_margin.as_ref().ok_or(Failure::NoSuchBound)?;
    let varied = unit_determinant(model, cell)?;
    let beyond = varied.sub(bound).is_nonnegative() || varied.neg().sub(bound).is_nonnegative();
    if beyond {
        Ok(())
    } else {
        Err(Failure::NearSingular)
    }
}

/// `det U` over the cell, as in [`parallel_margin`].
pub(super) fn unit_determinant<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<S, Failure> {
    let region = Region::new(model, cell, ExpansionPoint::Centre);
    let unit = |i: usize| {
        let leg = &model.legs[i];
        leg.expand_unit(&region.at[i], &region.over[i]).ok_or(Failure::OutOfReach(i))
    };
    let units = [unit(0)?, unit(1)?, unit(2)?];
    // e[i][k] is h_k times the slope of u_i along coordinate k.
    let e: [Matrix<S>; 3] =
        from_fn(|i| from_fn(|k| from_fn(|j| region.extent[k].mul(&units[i].1[j][k]))));
    let c: Matrix<S> = from_fn(|i| units[i].0.clone());
    let u: Matrix<S> = from_fn(|i| {
        from_fn(|j| (0..3).fold(c[i][j].clone(), |sum, k| sum.add(&either_way(&e[i][k][j]))))
    });
    Ok((0..3).fold(determinant(&c), |sum, k| {
        let first = determinant(&[e[0][k].clone(), u[1].clone(), u[2].clone()]);
        let second = determinant(&[c[0].clone(), e[1][k].clone(), u[2].clone()]);
        let third = determinant(&[c[0].clone(), c[1].clone(), e[2][k].clone()]);
        sum.add(&either_way(&first.add(&second).add(&third)))
    }))
}

/// `[-1, 1] x`.
fn either_way<S: Enclosure>(x: &S) -> S {
    x.join(&x.neg())
}
