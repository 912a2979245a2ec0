//! Two points with the same joint coordinates: by Newton's method from point to point of a grid.

use super::refute::point;
use super::rows::{above, rounded};
use super::sample::{At, Place, Sampler};
use crate::exact::arithmetic::number;
use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::machine::Joint;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::witness;

/// Precisions in which witnesses are evaluated, lowest first.
const PRECISIONS: [u32; 2] = [64, 160];
/// Points of the grid that are tried, and from each of them so many others.
const TRIED: [usize; 2] = [40, 12];
/// Steps of Newton's method.
const STEPS: usize = 12;
/// Half-width of the box about the second point, in parts of the workspace.
const HALF: f64 = 1e-6;
/// What the points differ by at least, in parts.
const APART: f64 = 1e-2;
/// Part of the workspace, about its middle, in which a platform that turns has the first pose.
const INNER: f64 = 0.9;
/// Steps of differences, in parts.
const STEP: f64 = 1e-5;
/// Decimal places of the first point's parts.
const DIGITS: i32 = 3;

/// A witness that some obligation to be one to one fails, if the kernel accepts one.
pub fn refutation(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
) -> Option<Witness> {
    let is_asked = |o: &orthocert_kernel::quantity::Obligation| matches!(o.test, Test::OneToOne(_));
    let obligation = problem.obligations.iter().position(is_asked)?;
    if problem.legs.len() != problem.dimension() {
        return None;
    }
    let grid = sampler.grid();
    let spread = |n: usize| grid.iter().step_by(grid.len().div_ceil(n).max(1));
    spread(TRIED[0]).find_map(|start| {
        // What has the joint coordinates of a pose at an edge is often at another one.
        let off = |u: &f64| 0.5 + if problem.weight.is_some() { INNER } else { 1.0 } * (u - 0.5);
        let u: Vec<f64> = start.u.iter().map(off).collect();
        let first = point(claim, problem, sampler, &u, DIGITS)?;
        let machine = super::refute::machine(problem, &start.t, DIGITS)?;
        let place = sampler.place_of(&first, &machine)?;
        let at = sampler.at(&place);
        // Many machines have mirror images near these.
        let mirrored = (0..place.u.len()).map(|k| {
            let mut other = place.clone();
            other.u[k] = 1.0 - other.u[k];
            other
        });
        mirrored.chain(spread(TRIED[1]).cloned()).find_map(|other| {
            let found = newton(problem, sampler, &at, &other)?;
            let apart = found.u.iter().zip(&place.u).any(|(a, b)| (a - b).abs() > APART);
            let witness = apart.then(|| {
                let fails = failure(problem, sampler, obligation, &found)?;
                let (point, machine) = (first.clone(), machine.clone());
                Some(Witness { precision: PRECISIONS[0], point, machine, fails })
            })??;
            PRECISIONS.into_iter().find_map(|precision| {
                let witness = Witness { precision, ..witness.clone() };
                witness::check(problem, &claim.workspace, &witness).is_ok().then_some(witness)
            })
        })
    })
}

/// A place, well within the workspace, with the joint coordinates of another.
fn newton(problem: &Problem, sampler: &Sampler<'_>, like: &At, start: &Place) -> Option<Place> {
    let mut place = start.clone();
    for _ in 0..STEPS {
        let off = off(problem, &sampler.at(&place), like)?;
        let step = derivative(problem, sampler, &place)?.lu().solve(&off)?;
        let point: Vec<f64> =
            sampler.point(&place.u).iter().zip(step.iter()).map(|(x, step)| x - step).collect();
        place.u = sampler.parts_of(&point);
    }
    let again = sampler.parts(&place.u);
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 0.0;
    let inner = place.u.iter().all(|u| (4.0 * HALF..=1.0 - 4.0 * HALF).contains(u));
    (inner && again.iter().zip(&place.u).all(near)).then_some(place)
}

/// By how much joint coordinates differ.
fn off(problem: &Problem, at: &At, like: &At) -> Option<DVector<f64>> {
    let off = |leg: &orthocert_kernel::machine::Leg| match leg.rho? {
        Joint::Length(rho) => Some(at.of(rho)? - like.of(rho)?),
        Joint::Angle { cos, sin } => {
            let (c, s, c2, s2) = (at.of(cos)?, at.of(sin)?, like.of(cos)?, like.of(sin)?);
            Some((s * c2 - c * s2).atan2(c * c2 + s * s2))
        }
    };
    let off: Vec<f64> = problem.legs.iter().map(off).collect::<Option<_>>()?;
    Some(DVector::from_vec(off))
}

/// The derivative of the joint coordinates: `M`, or, by half-angle tangents, differences.
fn derivative(problem: &Problem, sampler: &Sampler<'_>, place: &Place) -> Option<DMatrix<f64>> {
    if problem.weight.is_none() {
        return sampler.jacobian(&sampler.at(place));
    }
    let width = |k: usize| sampler.box_[k].1 * 2.0 * STEP;
    let column = |k: usize| {
        let at = |sign: f64| {
            let mut place = place.clone();
            place.u[k] += sign * STEP;
            sampler.at(&place)
        };
        Some(off(problem, &at(1.0), &at(-1.0))? / width(k))
    };
    let columns: Vec<_> = (0..problem.dimension()).map(column).collect::<Option<_>>()?;
    Some(DMatrix::from_columns(&columns))
}

/// A small box about the place, and the inverse of the derivative there.
fn failure(
    problem: &Problem,
    sampler: &Sampler<'_>,
    obligation: usize,
    place: &Place,
) -> Option<Failure> {
    let inverse = derivative(problem, sampler, place)?.try_inverse()?;
    let inverse = rounded(&inverse, 24 + above(&inverse))?;
    let end = |sign: f64| -> Option<Vec<Expression>> {
        let u: Vec<f64> = place.u.iter().map(|u| u + sign * HALF).collect();
        let point = sampler.point(&u).into_iter().enumerate();
        // Decimals of a hundredth of the box.
        let width = sampler.ends();
        let short = |(k, x): (usize, f64)| {
            let width = (width[1][k] - width[0][k]) * HALF;
            let places = (2.0 - width.log10()).ceil() as i32;
            let grid = BigRational::from_integer(10.into()).pow(places);
            let x = BigRational::from_f64(x * sampler.unit_of(k))?;
            Some(number(&((x * &grid).round() / grid)))
        };
        point.map(short).collect()
    };
    Some(Failure::Same { obligation, least: end(-1.0)?, greatest: end(1.0)?, inverse })
}
