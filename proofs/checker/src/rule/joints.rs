//! Joints: ranges of their coordinates, and the speeds that they are asked for.

use super::Failure;
use crate::cell::Cell;
use crate::enclosure::Enclosure;
use crate::expansion::{Expansion, ExpansionPoint, Region};
use crate::hull::Hull;
use crate::kinematics::{JointCoordinate, Leg};
use crate::linear::{norm_squared, Vector};
use crate::model::{JointRange, Model};

/// **Joint range.** Each `rho_i` lies in its range on the cell.
///
/// *Proof.* A length `rho_i` on the cell is in the value of its formula over the cell, and in
/// the hull of `rho_i(c) + sum_k lambda_k h_k g_k` at the vertices, by the slope identity, as it is
/// affine in `lambda`; both enclose the same numbers, so their intersection does. It is compared
/// with the range, ends included.
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
        let slope = expansion.rho[leg].as_ref();
        let rho = coordinate(&model.legs[leg], &over[leg], slope, &expansion.hull);
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
/// (`slope`: `rho_i(c)` and `h_k g_k`) at the vertices of `hull`, so in their intersection. `None`
/// unless the leg certainly reaches `over`.
pub(super) fn coordinate<S: Enclosure>(
    leg: &Leg<S>,
    over: &Vector<S>,
    slope: Option<&(S, Vector<S>)>,
    hull: &Hull,
) -> Option<JointCoordinate<S>> {
    match (leg.at(over)?.rho, slope) {
        (JointCoordinate::Length(rho), Some((at, [x, y, z]))) => {
            let ends = hull.vertices().map(|v| v.affine(at, [x, y, z]));
            let spread = ends.reduce(|a, b| a.join(&b)).unwrap_or_else(|| rho.clone());
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
/// *Proof.* The row of a strut is a unit vector by definition. For other legs fix `P`. Row `i` of
/// `M(P) = A(delta)` is affine in `delta`, and a norm is convex: it is at most its greatest value at
/// the vertices. ∎
pub fn speed<S: Enclosure>(model: &Model<S>, expansion: &Expansion<S>) -> Result<(), Failure> {
    let bound = model.bounds.joint_speed.as_ref().ok_or(Failure::NoSuchBound)?.sqr();
    let within = |square: &S| bound.sub(square).is_nonnegative();
    for (i, leg) in model.legs.iter().enumerate() {
        let holds = match leg {
            Leg::Strut(_) => within(&bound.integer_like(1)),
            _ => expansion.hull.vertices().all(|v| within(&norm_squared(&expansion.row_at(i, &v)))),
        };
        if !holds {
            return Err(Failure::OutOfRange(i));
        }
    }
    Ok(())
}
