//! Refutation: a place where an obligation seems to fail as an exact witness.

use super::sample::{At, Place, Quality, Sampler, Worst};
use super::violation;
use crate::exact::arithmetic::number;
use nalgebra::DVector;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed, ToPrimitive, Zero};
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::claim::{MachineClaim, Orientation, Workspace};
use orthocert_kernel::input::Input;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::witness;

/// Precisions in which witnesses are evaluated, lowest first.
const PRECISIONS: [u32; 2] = [64, 160];
/// Fractional bits of a number that is not rational.
const NUMBER_BITS: u32 = 256;
/// Margins above this are rounding errors of the sampling.
const NOISE: f64 = -1e-13;
/// Of a point next to a singular one, at most: a determinant, and the least singular value over the greatest.
const NEARLY_SINGULAR: f64 = 1e-9;
/// Points at which a machine that is nearly singular is tried to be so exactly.
const SINGULAR_POINTS: usize = 8;
/// Decimal places tried for the coordinates of a witness, relative to the range's width.
const DIGITS: [i32; 5] = [3, 6, 9, 12, 15];
/// Bits tried for the components of a direction.
const DIRECTION_BITS: [i32; 5] = [4, 8, 14, 24, 40];

/// A witness of the obligation that fails most, if one fails.
pub fn refutation(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    worst: &[Worst],
) -> Option<Witness> {
    let mut failing: Vec<&Worst> = worst.iter().filter(|found| found.margin < NOISE).collect();
    failing.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    let found = failing.into_iter().find_map(|found| witness_at(claim, problem, sampler, found));
    found.or_else(|| singular(claim, problem, sampler, worst))
}

/// A witness that the machine is singular at the middle of the workspace, or at another point of the grid:
/// where it is so everywhere, its determinant has no signs.
fn singular(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    worst: &[Worst],
) -> Option<Witness> {
    let tells = |found: &Worst| match found.quality {
        Quality::Determinant => true,
        Quality::Obligation(number) => problem.obligations[number].requirement.is_none(),
        Quality::Reach => false,
    };
    if !worst.iter().any(|found| tells(found) && found.margin < NEARLY_SINGULAR) {
        return None;
    }
    let is_near = |place: &Place| {
        let xi = sampler.xi(&sampler.at(place));
        xi.is_some_and(|[least, greatest]| least <= NEARLY_SINGULAR * greatest)
    };
    let all = [sampler.centre()].into_iter().chain(sampler.grid());
    all.filter(is_near).take(SINGULAR_POINTS).find_map(|place| {
        let point = point(claim, problem, sampler, &place.u, DIGITS[0])?;
        let machine = machine(problem, &place.t, DIGITS[0])?;
        let witness =
            Witness { precision: PRECISIONS[0], point, machine, fails: Failure::Dependent };
        witness::check(problem, &claim.workspace, &witness).is_ok().then_some(witness)
    })
}

/// An exact witness next to a place, if the kernel accepts one: of the shortest numbers tried.
pub fn witness_at(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    found: &Worst,
) -> Option<Witness> {
    DIGITS.iter().find_map(|&digits| {
        let point = point(claim, problem, sampler, &found.place.u, digits)?;
        let machine = machine(problem, &found.place.t, digits)?;
        let failures = failures(claim, problem, sampler, found, digits);
        failures.into_iter().find_map(|fails| {
            PRECISIONS.into_iter().find_map(|precision| {
                let (point, machine, fails) = (point.clone(), machine.clone(), fails.clone());
                let witness = Witness { precision, point, machine, fails };
                witness::check(problem, &claim.workspace, &witness).is_ok().then_some(witness)
            })
        })
    })
}

/// What may fail at a place, shortest first.
pub(crate) fn failures(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    found: &Worst,
    digits: i32,
) -> Vec<Failure> {
    let values = sampler.at(&found.place);
    let is_defined = sampler.matrix(&values).is_some();
    match found.quality {
        _ if !is_defined || found.quality == Quality::Reach => vec![Failure::Reach],
        Quality::Reach => Vec::new(),
        Quality::Determinant => {
            let other = opposite(sampler, &found.place);
            let other = other.and_then(|other| point(claim, problem, sampler, &other.u, digits));
            other.map(Failure::Singular).into_iter().collect()
        }
        Quality::Obligation(number) => {
            let of = |directions| Failure::Obligation(number, directions);
            directions(&problem.obligations[number].test, problem, sampler, &values)
                .into_iter()
                .map(of)
                .collect()
        }
    }
}

/// The place of the grid at which `det M` of the same machine has the other sign, and is greatest.
pub(crate) fn opposite(sampler: &Sampler<'_>, found: &Place) -> Option<Place> {
    let det = |place: &Place| sampler.determinant(&sampler.at(place)).unwrap_or(0.0);
    let sign = det(found).signum();
    let with = |u: Vec<f64>| Place { u, t: found.t.clone() };
    let grid = [sampler.centre()].into_iter().chain(sampler.grid()).map(|place| with(place.u));
    let mut others: Vec<(f64, Place)> =
        grid.map(|place| (sign * det(&place), place)).filter(|(det, _)| *det < 0.0).collect();
    others.sort_by(|a, b| a.0.total_cmp(&b.0));
    others.into_iter().next().map(|(_, other)| other)
}

/// Directions in which a test fails, shortest first; none of a test on signs.
pub(crate) fn directions(
    test: &Test,
    problem: &Problem,
    sampler: &Sampler<'_>,
    at: &At,
) -> Vec<Vec<Vec<i64>>> {
    let own = |greatest| sampler.matrix(at).and_then(|m| violation::singular(&m, greatest));
    let one = |v: Option<DVector<f64>>| v.map_or_else(Vec::new, |v| roundings(&v)).into_iter();
    let each = |v| one(v).map(|v| vec![v]).collect();
    match test {
        Test::SigmaMin(_) => each(own(false)),
        Test::SigmaMax(_) => each(own(true)),
        Test::Conditioning(_) => {
            one(own(true)).zip(one(own(false))).map(|(u, v)| vec![u, v]).collect()
        }
        Test::Least(rows, _) | Test::Greatest(rows, _) => {
            let greatest = matches!(test, Test::Greatest(..));
            let m = violation::divided(at, rows.iter());
            each(m.and_then(|m| violation::singular(&m, greatest)))
        }
        Test::Solve(solve) => each(violation::unsolved(at, &problem.legs, solve)),
        Test::Accuracy(test) => each(violation::far(at, &problem.legs, test)),
        Test::Curvature(test) => each(violation::curved(test, |f| at.of(f)).map(|(_, v)| v)),
        Test::Apart(test) => violation::between(at, test).map_or_else(Vec::new, |([s, t], _)| {
            let weights = |bits: i32| {
                let n = f64::from(bits).exp2();
                vec![vec![(s * n).round() as i64, (t * n).round() as i64, n as i64]]
            };
            DIRECTION_BITS.into_iter().map(weights).collect()
        }),
        Test::AtLeast(_) | Test::Beyond(..) => vec![Vec::new()],
        // Of two points.
        Test::OneToOne(_) => Vec::new(),
    }
}

/// Roundings of a direction.
fn roundings(v: &DVector<f64>) -> Vec<Vec<i64>> {
    let v = v.normalize();
    let rounded = |bits: i32| {
        let scale = f64::from(bits).exp2();
        let v: Vec<i64> = v.iter().map(|x| (x * scale).round() as i64).collect();
        let gcd = v.iter().fold(0i64, |a, b| num_integer::gcd(a, *b));
        (gcd > 0).then(|| v.into_iter().map(|x| x / gcd).collect())
    };
    DIRECTION_BITS.into_iter().filter_map(rounded).collect()
}

/// A point of short numbers near a place, within the workspace.
pub fn point(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    u: &[f64],
    digits: i32,
) -> Option<Vec<Expression>> {
    let [min, max] = &problem.corners;
    let inside = sampler.parts(u);
    let coordinate = |k: usize| {
        // Rounded toward the middle of a curved set, a point does not leave it.
        let toward = match claim.workspace {
            Workspace::Cylinder { .. } if k < 2 => Toward::Middle,
            Workspace::Cylinder { .. } | Workspace::Box { .. } | Workspace::Cube { .. } => {
                Toward::Nearest
            }
        };
        between([&min[k], &max[k]], inside[k], digits, toward)
    };
    let turned = (0..problem.orientation.len())
        .map(|j| turned(claim, problem, j, inside[min.len() + j], digits));
    (0..min.len()).map(coordinate).chain(turned).collect()
}

/// A short number at a part of coordinate `j` of orientation, within the set of the claim; over a cell of an atlas
/// within that of each machine. `None` where there is none.
pub(crate) fn turned(
    claim: &MachineClaim,
    problem: &Problem,
    j: usize,
    part: f64,
    digits: i32,
) -> Option<Expression> {
    let toward = match claim.orientation {
        Some(Orientation::Angle(_)) => Toward::Middle,
        Some(Orientation::Tilt { .. }) if j < 2 => Toward::Middle,
        _ => Toward::Nearest,
    };
    let inner = |end: &Input| {
        let x = end.enclose(NUMBER_BITS, None)?;
        Some([x.lo, x.hi].map(|x| BigRational::new(x, BigInt::from(1) << NUMBER_BITS)))
    };
    let [min, max] = problem.orientation.get(j)?;
    let ([_, least], [greatest, _]) = (inner(min)?, inner(max)?);
    (least <= greatest).then(|| short([&least, &greatest], part, digits, toward))?
}

/// Short numbers near the parts of the tolerances.
pub fn machine(problem: &Problem, t: &[f64], digits: i32) -> Option<Vec<Expression>> {
    let value = |((_, min, max), &t): ((&str, &Expression, &Expression), &f64)| {
        between([min, max], t, digits, Toward::Nearest)
    };
    problem.tolerances().zip(t).map(value).collect()
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Toward {
    Nearest,
    Middle,
}

/// A short number of `[min, max]` near `min + part (max - min)`: an end for parts 0 and 1, else a
/// decimal of so many places relative to the width.
fn between(
    [min, max]: [&Expression; 2],
    part: f64,
    digits: i32,
    toward: Toward,
) -> Option<Expression> {
    // Whether a point with an irrational end is in a curved set may not be told: within it, then.
    let told = toward == Toward::Nearest || [min, max].iter().all(|x| x.rational().is_some());
    if min == max || told && part <= 0.0 {
        return Some(min.clone());
    }
    if told && part >= 1.0 {
        return Some(max.clone());
    }
    // Within the range also where its ends are not rational: the enclosures' inner ends.
    let (least, greatest) = (enclosed(min)?.1, enclosed(max)?.0);
    if least >= greatest {
        return Some(min.clone());
    }
    short([&least, &greatest], part, digits, toward)
}

/// A short rational of `[least, greatest]` near `least + part (greatest - least)`.
pub(crate) fn short(
    [least, greatest]: [&BigRational; 2],
    part: f64,
    digits: i32,
    toward: Toward,
) -> Option<Expression> {
    let width = greatest - least;
    if !width.is_positive() {
        return Some(number(least));
    }
    let value = least + &width * BigRational::from_f64(part.clamp(0.0, 1.0))?;
    let size =
        i32::try_from(width.numer().bits()).ok()? - i32::try_from(width.denom().bits()).ok()?;
    let places = digits - (f64::from(size) * std::f64::consts::LOG10_2).floor() as i32;
    let grid = BigRational::from_integer(10.into()).pow(places);
    let (floor, ceil) = ((&value * &grid).floor() / &grid, (&value * &grid).ceil() / &grid);
    let nearest = (&value * &grid).round() / &grid;
    let candidates = match toward {
        Toward::Nearest => [nearest, floor, ceil],
        Toward::Middle if part < 0.5 => [ceil.clone(), ceil.clone(), ceil],
        Toward::Middle => [floor.clone(), floor.clone(), floor],
    };
    let within = |x: &BigRational| least <= x && x <= greatest;
    candidates.into_iter().chain([value]).find(within).map(|x| number(&x))
}

/// A number as it is, or, of one that is not rational, rationals on both sides.
fn enclosed(x: &Expression) -> Option<(BigRational, BigRational)> {
    if let Some(x) = x.rational() {
        return Some((x.clone(), x));
    }
    let x = x.enclose(NUMBER_BITS)?;
    let end = |x: BigInt| BigRational::new(x, BigInt::from(1) << NUMBER_BITS);
    Some((end(x.lo), end(x.hi)))
}

/// A double near a number of a claim.
pub fn approximate(x: &Expression) -> Option<f64> {
    let (x, _) = enclosed(x)?;
    if x.is_zero() {
        Some(0.0)
    } else {
        x.to_f64()
    }
}
