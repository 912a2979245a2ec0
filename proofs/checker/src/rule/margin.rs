//! Distances to singularities: `eta_i / L_i` and `det A / (L_1 L_2 L_3)`.

use super::Failure;
use crate::cell::Cell;
use crate::enclosure::Enclosure;
use crate::expansion::{ExpansionPoint, Region};
use crate::hull::Hull;
use crate::kinematics::Leg;
use crate::linear::{determinant, Matrix};
use crate::model::Model;
use std::array::from_fn;

/// **Serial margin.** `(eta_i / L_i)^2` is at least the square of its bound on the cell, for every
/// leg. *Proof.* For an arm, fix `P`: it is affine in `delta` by the slope identity of `D`, so at
/// least its least value at the vertices. For a slider it is `1 - |r_i|^2 / L_i^2`, concave in `P`
/// as `r_i` is affine: the same. ∎
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
    let Region { at, over, extent, hull } = Region::new(model, cell, ExpansionPoint::Centre);
    let zero = extent[0].integer_like(0);
    let along = |k: usize, axis: usize| if k == axis { &extent[k] } else { &zero };
    for (i, leg) in model.legs.iter().enumerate() {
        let at_least = |cosine: Option<S>| {
            let enough = cosine.ok_or(Failure::OutOfReach(i))?.sub(bound).is_nonnegative();
            enough.then_some(()).ok_or(Failure::OutOfRange(i))
        };
        for vertex in hull.vertices() {
            let cosine = match leg {
                Leg::Slider(_) => {
                    let w = from_fn(|j| vertex.affine(&at[i][j], from_fn(|k| along(k, j))));
                    leg.cosine_squared(&w)
                }
                _ => leg.expand_cosine_squared(&at[i], &over[i]).map(|(cosine, slope)| {
                    let [x, y, z] = from_fn(|k| extent[k].mul(&slope[k]));
                    vertex.affine(&cosine, [&x, &y, &z])
                }),
            };
            at_least(cosine)?;
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
/// with `u_i` in `c_i + sum_k [-1, 1] h_k e_ik`. The sum, affine in `delta`, is enclosed at the
/// vertices, and their hull compared with the bound on either side of zero. ∎
pub fn parallel_margin<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    let bound = model.bounds.parallel_margin.as_ref().ok_or(Failure::NoSuchBound)?;
    let region = Region::new(model, cell, ExpansionPoint::Centre);
    let varied = unit_determinant(model, &region, &region.hull)?;
    let beyond = varied.sub(bound).is_nonnegative() || varied.neg().sub(bound).is_nonnegative();
    if beyond {
        Ok(())
    } else {
        Err(Failure::NearSingular)
    }
}

/// `det U` over the part of a cell in `hull`, as in [`parallel_margin`]; `region` is about the
/// cell's centre.
pub(super) fn unit_determinant<S: Enclosure>(
    model: &Model<S>,
    region: &Region<S>,
    hull: &Hull,
) -> Result<S, Failure> {
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
    let slope = |k: usize| {
        let first = determinant(&[e[0][k].clone(), u[1].clone(), u[2].clone()]);
        let second = determinant(&[c[0].clone(), e[1][k].clone(), u[2].clone()]);
        let third = determinant(&[c[0].clone(), c[1].clone(), e[2][k].clone()]);
        first.add(&second).add(&third)
    };
    let (at, [x, y, z]) = (determinant(&c), [slope(0), slope(1), slope(2)]);
    let ends = hull.vertices().map(|v| v.affine(&at, [&x, &y, &z]));
    Ok(ends.reduce(|a, b| a.join(&b)).unwrap_or(at))
}

/// `[-1, 1] x`.
pub(super) fn either_way<S: Enclosure>(x: &S) -> S {
    x.join(&x.neg())
}
