//! Refutation: turns a place where a requirement seems to fail into an exact witness.

use crate::exact::Exact;
use crate::sample::{Place, Quality, Sampler};
use nalgebra::Matrix3;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::certificate::{
    Direction, LegNumber, SecondPoint, TwoDirections, Violation, Witness,
};
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::witness;

/// Fractional bits in which witnesses are evaluated.
const PRECISION: u32 = 128;
/// Relative violations below this are rounding errors of the sampling.
const NOISE: f64 = 1e-13;
/// Decimal places tried for the coordinates of a witness, relative to the workspace's size.
const DIGITS: [i32; 5] = [3, 6, 9, 12, 15];
/// Bits tried for the components of a direction.
const DIRECTION_BITS: [i32; 5] = [4, 8, 14, 24, 40];

/// An exact witness at `place` for the violation of `quality`, if the checker accepts one. Its
/// numbers are the shortest of those tried.
pub fn witness_at(
    claim: &MachineClaim,
    sampler: &Sampler,
    quality: Quality,
    place: &Place,
) -> Option<Witness> {
    let values = sampler.at(place);
    if sampler.margin(quality, &values)? >= -NOISE {
        return None;
    }
    let workspace = Ends::new(claim)?;
    DIGITS.iter().find_map(|&digits| {
        let point = workspace.point(&sampler.within(place.u), digits)?;
        let machine = machine_at(claim, &place.t, digits)?;
        violations(claim, quality, &point, machine.as_ref())?.into_iter().find_map(|violates| {
            let witness = Witness {
                precision: PRECISION,
                point: point.clone(),
                machine: machine.clone(),
                violates,
            };
            witness::check(claim, &witness).is_ok().then_some(witness)
        })
    })
}

/// An exact witness for a parallel singularity between two places with determinants of opposite
/// signs.
pub fn singular_between(
    claim: &MachineClaim,
    sampler: &Sampler,
    one: &Place,
    other: &Place,
) -> Option<Witness> {
    let sign = |place| Some(sampler.at(place).reached?.matrix.determinant() > 0.0);
    if sign(one)? == sign(other)? {
        return None;
    }
    let workspace = Ends::new(claim)?;
    DIGITS.iter().find_map(|&digits| {
        let witness = Witness {
            precision: PRECISION,
            point: workspace.point(&sampler.within(one.u), digits)?,
            machine: machine_at(claim, &one.t, digits)?,
            violates: Violation::Singular(SecondPoint {
                other: workspace.point(&sampler.within(other.u), digits)?,
            }),
        };
        witness::check(claim, &witness).is_ok().then_some(witness)
    })
}

/// What may be violated at an exact point, most economical evidence first.
fn violations(
    claim: &MachineClaim,
    quality: Quality,
    point: &[Exact; 3],
    machine: Option<&[Leg; 3]>,
) -> Option<Vec<Violation>> {
    let model = Model::at_point(claim, machine, point, PRECISION).ok()?;
    let every_leg = [1, 2, 3].map(|leg| Violation::Reach(LegNumber { leg }));
    let Some(matrix) = matrix(&model) else {
        return Some(every_leg.to_vec());
    };
    let leg_number = |leg: usize| Violation::JointRange(LegNumber { leg: leg + 1 });
    Some(match quality {
        Quality::GreatestPsi => {
            let direction = |d| Violation::SigmaMin(d);
            directions(&matrix, 2).map(direction).collect()
        }
        Quality::LeastPsi => {
            let direction = |d| Violation::SigmaMax(d);
            directions(&matrix, 0).map(direction).collect()
        }
        Quality::LeastRho(leg) | Quality::GreatestRho(leg) => vec![leg_number(leg)],
        Quality::Conditioning => directions(&matrix, 0)
            .zip(directions(&matrix, 2))
            .map(|(u, v)| Violation::Conditioning(TwoDirections { u: u.vector, v: v.vector }))
            .collect(),
        Quality::SerialMargin(leg) => vec![Violation::SerialMargin(LegNumber { leg: leg + 1 })],
        Quality::ParallelMargin => vec![Violation::ParallelMargin],
        Quality::LegAngle(leg) => vec![Violation::LegAngle(LegNumber { leg: leg + 1 })],
        Quality::JointSpeed(leg) => vec![Violation::JointSpeed(LegNumber { leg: leg + 1 })],
        Quality::Clearance | Quality::Determinant => Vec::new(),
    })
}

fn matrix(model: &Model<Fixed>) -> Option<Matrix3<f64>> {
    let row = |i: usize| Some(model.legs[i].at(&model.origin[i])?.row);
    let rows = [row(0)?, row(1)?, row(2)?];
    Some(Matrix3::from_fn(|i, j| crate::interval::Approx::from_fixed(&rows[i][j]).0))
}

/// Roundings of the right singular vector at `position` in descending order of singular values.
fn directions(matrix: &Matrix3<f64>, position: usize) -> impl Iterator<Item = Direction> {
    let mut svd = matrix.svd(false, true);
    svd.sort_by_singular_values();
    let v = svd.v_t.map(|v_t| v_t.row(position).transpose());
    DIRECTION_BITS.into_iter().filter_map(move |bits| {
        let scale = f64::from(bits).exp2();
        let vector: [i64; 3] = v?.map(|x| (x * scale).round() as i64).into();
        let gcd = vector.iter().fold(0i64, |a, b| num_integer::gcd(a, *b));
        (gcd > 0).then(|| Direction { vector: vector.map(|x| x / gcd) })
    })
}

/// The workspace's ends in the claim's unit, as exact numbers and enclosed.
struct Ends {
    min: [Exact; 3],
    max: [Exact; 3],
}

impl Ends {
    fn new(claim: &MachineClaim) -> Option<Self> {
        match &claim.workspace {
            Workspace::Box { .. } | Workspace::Cylinder { .. } => {
                let (min, max) = claim.workspace.bounding_box().ok()?;
                Some(Ends { min, max })
            }
            Workspace::Cube { side } => {
                let psi_max = claim.requirements.transmission.as_ref()?.max.as_ref()?;
                let cube = CubeConstants::new(psi_max, side).ok()?;
                let end = |q: &Exact| q.clone().over(cube.inverse_length.clone()).ok();
                let (min, max) = (end(&cube.q1)?, end(&cube.q2)?);
                Some(Ends {
                    min: [min.clone(), min.clone(), min],
                    max: [max.clone(), max.clone(), max],
                })
            }
        }
    }

    /// A rational point near `min + (max - min) u`, within the ends.
    fn point(&self, u: &[f64; 3], digits: i32) -> Option<[Exact; 3]> {
        let coordinate = |k: usize| {
            let range = Quantity { min: self.min[k].clone(), max: self.max[k].clone() };
            between(&range, u[k], digits)
        };
        Some([coordinate(0)?, coordinate(1)?, coordinate(2)?])
    }
}

/// The claim's machine with these parts of its tolerances; `Some(None)` where it has none.
fn machine_at(claim: &MachineClaim, t: &[f64], digits: i32) -> Option<Option<[Leg; 3]>> {
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return Some(None);
    };
    if !legs.iter().any(Leg::has_tolerance) {
        return Some(None);
    }
    let mut machine = legs.clone();
    let mut parts = t.iter();
    for quantity in machine.iter_mut().flat_map(Leg::parameters_mut) {
        if !quantity.is_exact() {
            *quantity = Quantity::exactly(between(quantity, *parts.next()?, digits)?);
        }
    }
    Some(Some(machine))
}

/// A short number of `[min, max]` near `min + part (max - min)`: an end itself for parts 0 and 1
/// (for a rational end), else a decimal with `digits` places relative to the range's width.
fn between(range: &Quantity, part: f64, digits: i32) -> Option<Exact> {
    if range.is_exact() || (part <= 0.0 && range.min.as_rational().is_some()) {
        return Some(range.min.clone());
    }
    if part >= 1.0 && range.max.as_rational().is_some() {
        return Some(range.max.clone());
    }
    let rational = |x: &Exact, inner: fn(&Fixed) -> BigRational| match x.as_rational() {
        Some(x) => Some(x.clone()),
        None => Some(inner(&x.enclose(0, 2 * PRECISION)?)),
    };
    let (min, max) = (rational(&range.min, Fixed::sup)?, rational(&range.max, Fixed::inf)?);
    let width = &max - &min;
    let value = &min + &width * BigRational::from_f64(part.clamp(0.0, 1.0))?;
    // The power of ten at `digits` places below the width's leading digit.
    let size =
        i32::try_from(width.numer().bits()).ok()? - i32::try_from(width.denom().bits()).ok()?;
    let places = digits - (f64::from(size) * std::f64::consts::LOG10_2).floor() as i32;
    let ten = BigRational::from_integer(BigInt::from(10));
    let grid = ten.pow(places);
    let rounded = |x: BigRational| x / &grid;
    let nearest = rounded((&value * &grid).round());
    let candidates =
        [nearest, rounded((&value * &grid).floor()), rounded((&value * &grid).ceil()), value];
    candidates.into_iter().find(|x| min <= *x && *x <= max).map(Exact::Rational)
}
