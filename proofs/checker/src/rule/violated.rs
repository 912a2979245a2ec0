//! Violations that hold on all of a cell: the opposite of what the other rules show.

use super::joints::{coordinate, difference};
use super::margin::{either_way, unit_determinant};
use super::Failure;
use crate::cell::Cell;
use crate::certificate::{TwoDirections, Violation};
use crate::enclosure::Enclosure;
use crate::expansion::{natural, Expansion, ExpansionPoint, Region};
use crate::hull::Hull;
use crate::kinematics::JointCoordinate;
use crate::linear::{apply, dot, norm_squared, Matrix, Vector};
use crate::model::{JointRange, Model};
use std::array::from_fn;

/// **Violated.** At every point `P` of the cell, and for every machine of the claim, the claim's
/// theorem fails: some leg does not reach `P`, or `P` is singular, or the requirement that
/// `violation` names does not hold at `P`. The cell may be a single point.
///
/// *Proof.* By the tests below, each for a fixed machine and a fixed `P` of the cell. Enclosures
/// over the cell hold the values at `P`, so a sign that is certain is that of the value. With `y`,
/// `e_k` as in `square`, `M` at `P` is defined: the expansion (where it is not defined,
/// [`natural`] in its place) exists only where every leg reaches the cell with `s_i > 0`.
///
/// | violation         | test                                           | then                                  |
/// |-------------------|------------------------------------------------|---------------------------------------|
/// | `sigma_min` `v`   | `kappa > 0`, `kappa^2 abs(v)^2 > abs(M v)^2`   | `sigma_min(M) < kappa`                |
/// | `sigma_max` `v`   | `abs(M v)^2 > k^2 abs(v)^2`                    | `sigma_max(M) > k`                    |
/// | `row` `i`         | `k^2 c_i < 1`                                  | `sigma_max(M) > k`, or out of reach   |
/// | `reach` `i`       | clearance `<= 0`                               | out of reach, or serially singular    |
/// | `joint_range` `i` | `rho_i < min` or `rho_i > max`                 | outside its range                     |
/// | `conditioning`    | `abs(M u)^2 abs(v)^2 > c^2 abs(M v)^2 abs(u)^2`| `sigma_max(M) > c sigma_min(M)`       |
/// | `serial_margin`, `leg_angle` `i` | `(eta_i / L_i)^2 < bound`       | margin less, angle greater, or out of reach |
/// | `parallel_margin` | `-bound < det U < bound`                       | the margin is less                    |
/// | `joint_speed` `i` | `abs(row_i)^2 > V^2`, or `V^2 c_i < 1`         | too fast, or out of reach             |
///
/// `|M v| >= sigma_min |v|` and `|M v| <= sigma_max |v|` give the first two and `conditioning`.
/// `c_i` is [`inverse_row_squared`](crate::kinematics::Leg::inverse_row_squared): where the leg
/// reaches `P` with `s_i > 0`, `c_i = 1/|row_i|^2 > 0` and `|row_i| = |M^T e_i| <= sigma_max(M)`;
/// elsewhere the claim fails at `P` anyway. An angle has a negative `sin(theta - min)` or
/// `sin(max - theta)` only outside its range, see [`super::range`]. ∎
///
/// `singular` is about two points and is refused here.
pub fn violated<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    violation: &Violation,
) -> Result<(), Failure> {
    let about_centre =
        || Expansion::new(model, cell, ExpansionPoint::Centre).or_else(|_| natural(model, cell));
    let over = || Region::new(model, cell, ExpansionPoint::Centre).over;
    match violation {
        Violation::SigmaMin(v) => shrunk(model, &about_centre()?, &v.vector),
        Violation::SigmaMax(v) => stretched(model, &about_centre()?, &v.vector),
        Violation::Row(leg) => {
            let k = model.bounds.k.as_ref().ok_or(Failure::NoSuchBound)?;
            row_beyond(model, &over(), position(leg.leg)?, k)
        }
        Violation::Reach(leg) => unreachable(model, &over(), position(leg.leg)?),
        Violation::JointRange(leg) => beyond_range(model, cell, position(leg.leg)?),
        Violation::Conditioning(directions) => ill_conditioned(model, &about_centre()?, directions),
        Violation::SerialMargin(leg) => {
            oblique(model, &over(), position(leg.leg)?, model.bounds.serial_margin.as_ref())
        }
        Violation::LegAngle(leg) => {
            oblique(model, &over(), position(leg.leg)?, model.bounds.leg_angle.as_ref())
        }
        Violation::ParallelMargin => near_singular(model, cell),
        Violation::JointSpeed(leg) => {
            let speed = model.bounds.joint_speed.as_ref().ok_or(Failure::NoSuchBound)?;
            let leg = position(leg.leg)?;
            row_beyond(model, &over(), leg, speed)
                .or_else(|_| too_fast(&about_centre()?, leg, speed))
        }
        Violation::Singular(_) => Err(Failure::OtherKind),
    }
}

/// `|y|^2` for `y = y_c + sum_k lambda_k e_k` with `lambda_k` in `[-1, 1]`, in three parts.
struct Square<S> {
    /// `|y_c|^2`.
    at_centre: S,
    /// `2 y_c . e_k`, the factor of `lambda_k`.
    linear: [S; 3],
    /// Encloses `|sum_k lambda_k e_k|^2`; not negative.
    rest: S,
}

/// **Lemma.** `|y|^2 = |y_c|^2 + sum_k lambda_k 2 y_c . e_k + |sum_k lambda_k e_k|^2`, and
/// component `j` of the last sum is in `sum_k [-1, 1] e_kj`. *Proof.* Expand. ∎
fn square<S: Enclosure>(y: &Vector<S>, e: &[Vector<S>; 3]) -> Square<S> {
    let spread: Vector<S> =
        from_fn(|j| either_way(&e[0][j]).add(&either_way(&e[1][j])).add(&either_way(&e[2][j])));
    Square {
        at_centre: norm_squared(y),
        linear: from_fn(|k| {
            let product = dot(y, &e[k]);
            product.add(&product)
        }),
        rest: norm_squared(&spread),
    }
}

impl<S: Enclosure> Square<S> {
    /// `c |y|^2`, for `c >= 0`.
    fn times(&self, c: &S) -> Self {
        Square {
            at_centre: self.at_centre.mul(c),
            linear: from_fn(|k| self.linear[k].mul(c)),
            rest: self.rest.mul(c),
        }
    }

    /// `|y|^2 - |z|^2` at the same `lambda`.
    fn minus(&self, other: &Self) -> Self {
        Square {
            at_centre: self.at_centre.sub(&other.at_centre),
            linear: from_fn(|k| self.linear[k].sub(&other.linear[k])),
            rest: self.rest.sub(&other.rest),
        }
    }

    /// An enclosure for all `lambda`.
    fn over_the_cell(&self) -> S {
        let varied = |sum: S, linear: &S| sum.add(&either_way(linear));
        self.linear.iter().fold(self.at_centre.add(&self.rest), varied)
    }
}

/// `|M v|^2` over the cell, and `|v|^2`, for `v` not zero.
fn image<S: Enclosure>(expansion: &Expansion<S>, v: &[i64; 3]) -> Result<(Square<S>, S), Failure> {
    if *v == [0; 3] {
        return Err(Failure::ZeroVector);
    }
    let v: Vector<S> = v.map(|x| expansion.matrix[0][0].integer_like(x));
    let along = |a: &Matrix<S>| apply(a, &v);
    let slopes = from_fn(|k| along(&expansion.slopes[k]));
    Ok((square(&along(&expansion.matrix), &slopes), norm_squared(&v)))
}

/// **Violated, `sigma_min`**: see [`violated`]. `expansion` is about the cell's centre.
pub fn shrunk<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    v: &[i64; 3],
) -> Result<(), Failure> {
    if !model.bounds.kappa.is_positive() {
        return Err(Failure::NoSuchBound);
    }
    let (image, length) = image(expansion, v)?;
    let greatest = model.bounds.kappa.sqr().mul(&length);
    certainly(greatest.sub(&image.over_the_cell()).is_positive())
}

/// **Violated, `sigma_max`**: see [`violated`]. `expansion` is about the cell's centre.
pub fn stretched<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    v: &[i64; 3],
) -> Result<(), Failure> {
    let k = model.bounds.k.as_ref().ok_or(Failure::NoSuchBound)?;
    let (image, length) = image(expansion, v)?;
    certainly(image.over_the_cell().sub(&k.sqr().mul(&length)).is_positive())
}

/// `1 > bound^2 c_i`: then `|row_i| > bound`, or the leg is out of reach or serially singular.
fn row_beyond<S: Enclosure>(
    model: &Model<S>,
    over: &[Vector<S>; 3],
    leg: usize,
    bound: &S,
) -> Result<(), Failure> {
    let inverse = model.legs[leg].inverse_row_squared(&over[leg]).ok_or(Failure::NoSuchBound)?;
    certainly(inverse.integer_like(1).sub(&bound.sqr().mul(&inverse)).is_positive())
}

/// The leg's clearance is certainly `<= 0`.
fn unreachable<S: Enclosure>(
    model: &Model<S>,
    over: &[Vector<S>; 3],
    leg: usize,
) -> Result<(), Failure> {
    certainly(model.legs[leg].clearance(&over[leg]).neg().is_nonnegative())
}

/// The leg's joint coordinate is certainly outside its range.
fn beyond_range<S: Enclosure>(model: &Model<S>, cell: &Cell, leg: usize) -> Result<(), Failure> {
    let ranges = model.bounds.joint_range.as_ref().ok_or(Failure::NoSuchBound)?;
    let region = Region::new(model, cell, ExpansionPoint::Centre);
    let expansion = model.legs[leg].expand(&region.at[leg], &region.over[leg]);
    let slope = expansion.and_then(|expansion| expansion.rho).map(|(at, slope)| {
        let slope: Vector<S> = from_fn(|k| region.extent[k].mul(&slope[k]));
        (at, slope)
    });
    let rho = coordinate(&model.legs[leg], &region.over[leg], slope.as_ref(), &Hull::CELL);
    certainly(match (rho.ok_or(Failure::OutOfReach(leg))?, &ranges[leg]) {
        (JointCoordinate::Length(rho), JointRange::Length { min, max }) => {
            min.as_ref().is_some_and(|min| min.sub(&rho).is_positive())
                || max.as_ref().is_some_and(|max| rho.sub(max).is_positive())
        }
        (JointCoordinate::Angle { cos, sin }, JointRange::Angle { min, max }) => {
            let theta = (cos, sin);
            let (above, _) = difference(&theta, min);
            let (below, _) = difference(max, &theta);
            above.neg().is_positive() || below.neg().is_positive()
        }
        _ => false,
    })
}

/// `|M u|^2 |v|^2 - c^2 |M v|^2 |u|^2`, with both squares at the same `lambda`.
fn ill_conditioned<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    directions: &TwoDirections,
) -> Result<(), Failure> {
    let c = model.bounds.conditioning.as_ref().ok_or(Failure::NoSuchBound)?;
    let (image_u, length_u) = image(expansion, &directions.u)?;
    let (image_v, length_v) = image(expansion, &directions.v)?;
    let excess = image_u.times(&length_v).minus(&image_v.times(&c.sqr().mul(&length_u)));
    certainly(excess.over_the_cell().is_positive())
}

/// `(eta_i / L_i)^2` is certainly less than `bound`.
fn oblique<S: Enclosure>(
    model: &Model<S>,
    over: &[Vector<S>; 3],
    leg: usize,
    bound: Option<&S>,
) -> Result<(), Failure> {
    let bound = bound.ok_or(Failure::NoSuchBound)?;
    let cosine = model.legs[leg].cosine_squared(&over[leg]).ok_or(Failure::NoSuchBound)?;
    certainly(bound.sub(&cosine).is_positive())
}

/// `|det A| / (L_1 L_2 L_3)` is certainly less than its bound.
fn near_singular<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    let bound = model.bounds.parallel_margin.as_ref().ok_or(Failure::NoSuchBound)?;
    let region = Region::new(model, cell, ExpansionPoint::Centre);
    let det = unit_determinant(model, &region, &Hull::CELL)?;
    certainly(bound.sub(&det).is_positive() && bound.add(&det).is_positive())
}

/// `|row_i of M|` is certainly greater than `bound`.
fn too_fast<S: Enclosure>(expansion: &Expansion<S>, leg: usize, bound: &S) -> Result<(), Failure> {
    let slopes: [Vector<S>; 3] = from_fn(|k| expansion.slopes[k][leg].clone());
    let row = square(&expansion.matrix[leg], &slopes);
    certainly(row.over_the_cell().sub(&bound.sqr()).is_positive())
}

fn certainly(violated: bool) -> Result<(), Failure> {
    if violated {
        Ok(())
    } else {
        Err(Failure::NotViolated)
    }
}

fn position(leg: usize) -> Result<usize, Failure> {
    match leg {
        1..=3 => Ok(leg - 1),
        _ => Err(Failure::NoSuchLeg(leg)),
    }
}
