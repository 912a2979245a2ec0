//! Joints: ranges of their coordinates, and the speeds that they are asked for.

use super::vertex::matrix_at_vertex;
use super::Failure;
use crate::cell::Cell;
use crate::enclosure::Enclosure;
use crate::expansion::{Expansion, ExpansionPoint, Region};
use crate::kinematics::{JointCoordinate, Leg};
use crate::linear::{norm_squared, Vector};
use crate::model::{JointRange, Model};

/// **Joint range.** Each `rho_i` lies in its range on the cell.
///
/// *Proof.* A length `rho_i` on the cell is in the value of its formula over the cell, and in
/// `rho_i(c) + sum_k [-1, 1] h_k g_k` by the slope identity; both enclose the same numbers, so
/// their intersection does. It is compared with the range, ends included.
///
/// An angle is given by its cosine and sine over the cell, and its range spans less than half a
/// turn. Let `x = theta - min` in `[0, 360)` degrees. `sin(x) >= 0` gives `x <= 180`; then
/// `sin(max - theta) >= 0` gives `x <= max - min`, or `max = min` and `x = 180`, which
/// `cos(x) > 0` or `cos(max - theta) > 0` excludes: so `theta` is in `[min, max]` up to whole
/// turns. ∎
pub fn range<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    expansion: &Expansion<S>,
) -> Result<(), Failure> {
    let ranges = model.bounds.joint_range.as_ref().ok_or(Failure::NoSuchBound)?;
    let over = Region::new(model, cell, ExpansionPoint::Centre).over;
    for (leg, range) in ranges.iter().enumerate() {
        let rho = coordinate(&model.legs[leg], &over[leg], expansion.rho[leg].as_ref());
        let within = match (rho.ok_or(Failure::OutOfReach(leg))?, range) {
            (JointCoordinate::Length(rho), JointRange::Length { min, max }) => {
                min.as_ref().is_none_or(|min| rho.sub(min).is_nonnegative())
                    && max.as_ref().is_none_or(|max| max.sub(&rho).is_nonnegative())
            }
            (JointCoordinate::Angle { cos, sin }, JointRange::Angle { min, max }) => {
                angle_within(&(cos, sin), min, max)
            }
            _ => false,
        };
        if !within {
            return Err(Failure::OutOfRange(leg));
        }
    }
    Ok(())
}

/// `rho_i` for `w` in `over`: a length is in the value of its formula and in its slope form
/// (`slope`: `rho_i(c)` and `h_k g_k`), so in their intersection. `None` unless the leg certainly
/// reaches `over`.
pub(super) fn coordinate<S: Enclosure>(
    leg: &Leg<S>,
    over: &Vector<S>,
    slope: Option<&(S, Vector<S>)>,
) -> Option<JointCoordinate<S>> {
    match (leg.at(over)?.rho, slope) {
        (JointCoordinate::Length(rho), Some((at, slopes))) => {
            let spread = slopes.iter().fold(at.clone(), |sum, h| sum.add(&h.join(&h.neg())));
            rho.meet(&spread).map(JointCoordinate::Length)
        }
        (rho, _) => Some(rho),
    }
}

/// `sin(a - b)` and `cos(a - b)` of angles given by `(cos, sin)`.
pub(super) fn difference<S: Enclosure>(a: &(S, S), b: &(S, S)) -> (S, S) {
    let sin = a.1.mul(&b.0).sub(&a.0.mul(&b.1));
    let cos = a.0.mul(&b.0).add(&a.1.mul(&b.1));
    (sin, cos)
}

fn angle_within<S: Enclosure>(theta: &(S, S), min: &(S, S), max: &(S, S)) -> bool {
    let (above_sin, above_cos) = difference(theta, min);
    let (below_sin, below_cos) = difference(max, theta);
    above_sin.is_nonnegative()
        && below_sin.is_nonnegative()
        && (above_cos.is_positive() || below_cos.is_positive())
}

/// **Joint speed.** `|row_i of M|` is at most its bound on the cell, for every leg; the speed of
/// joint `i` for a tool velocity `v` is `row_i . v`, at most `|row_i| |v|`.
///
/// *Proof.* Fix `P`. Row `i` of `M(P) = A(delta)` is affine in `delta`, and a norm is convex: it is
/// at most its greatest value at the 8 vertices. ∎
pub fn speed<S: Enclosure>(model: &Model<S>, expansion: &Expansion<S>) -> Result<(), Failure> {
    let bound = model.bounds.joint_speed.as_ref().ok_or(Failure::NoSuchBound)?.sqr();
    for vertex in 0..8 {
        let at_vertex = matrix_at_vertex(expansion, vertex);
        for (leg, row) in at_vertex.iter().enumerate() {
            if !bound.sub(&norm_squared(row)).is_nonnegative() {
                return Err(Failure::OutOfRange(leg));
            }
        }
    }
    Ok(())
}
