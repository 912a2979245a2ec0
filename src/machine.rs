//! The machine's search problem: its obligations and the rules that may discharge them.

use crate::interval::Interval;
use crate::rotation;
use crate::search::{self, by_weight, Problem, Trial};
use nalgebra::Matrix3;
use orthocert_checker::cell::{Axis, Cell, Edge};
use orthocert_checker::certificate::{ConditioningEvidence, Step};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::expansion::{Expansion, ExpansionPoint, OutOfReach};
use orthocert_checker::linear::Matrix;
use orthocert_checker::model::Model;
use orthocert_checker::rule::{self, Failure, Obligation, TightCorner};

impl Problem for Model<Interval> {
    fn obligations(&self) -> Vec<Obligation> {
        orthocert_checker::obligations(self)
    }

    fn try_box(&self, cell: &Cell, open: &[Obligation]) -> Trial {
        try_box(self, cell, open)
    }
}

/// Tries every rule that may discharge what is open on a box.
fn try_box(model: &Model<Interval>, cell: &Cell, open: &[Obligation]) -> Trial {
    if rule::outside(model, cell).is_ok() {
        let axes = Axis::ALL;
        return Trial { steps: vec![Step::Outside], failures: Vec::new(), axes, hopeless: false };
    }
    let expansion = Expansion::new(model, cell, ExpansionPoint::Centre);
    let mut trial = Trial {
        steps: Vec::new(),
        failures: Vec::new(),
        axes: match &expansion {
            Ok(expansion) => axes_by_slopes(expansion),
            Err(out) => axes_by_clearance(model, cell, out.leg),
        },
        hopeless: false,
    };
    for &obligation in open {
        match discharge(model, cell, &expansion, obligation) {
            Ok(step) => trial.steps.push(step),
            Err(failure) => trial.failures.push((obligation, failure)),
        }
    }
    if search::worth_asking_whether_hopeless(cell) && centre_is_asked_about(model, cell) {
        let centre = around_centre(cell);
        let expansion = Expansion::new(model, &centre, ExpansionPoint::Centre);
        trial.hopeless = trial
            .failures
            .iter()
            .any(|&(obligation, _)| discharge(model, &centre, &expansion, obligation).is_err());
    }
    trial
}

/// The step that discharges an obligation on a cell, if one does.
fn discharge(
    model: &Model<Interval>,
    cell: &Cell,
    expansion: &Result<Expansion<Interval>, OutOfReach>,
    obligation: Obligation,
) -> Result<Step, Failure> {
    let about_centre = || expansion.as_ref().map_err(|&out| Failure::from(out));
    match obligation {
        Obligation::SigmaMin => {
            let about_centre = about_centre().and_then(|expansion| {
                lower_step(model, expansion)
                    .or_else(|failure| entrywise_step(model, expansion).ok_or(failure))
            });
            about_centre.or_else(|failure| corner_step(model, cell).ok_or(failure))
        }
        Obligation::SigmaMax if model.is_cube => Ok(Step::Cube),
        Obligation::SigmaMax => rule::upper(model, about_centre()?).map(|()| Step::Upper),
        Obligation::JointRange => rule::range(model, cell, about_centre()?).map(|()| Step::Range),
        Obligation::Conditioning => conditioning_step(model, about_centre()?),
        Obligation::SerialMargin => rule::serial_margin(model, cell).map(|()| Step::SerialMargin),
        Obligation::ParallelMargin => {
            rule::parallel_margin(model, cell).map(|()| Step::ParallelMargin)
        }
        Obligation::LegAngle => rule::leg_angle(model, cell).map(|()| Step::LegAngle),
        Obligation::JointSpeed => rule::speed(model, about_centre()?).map(|()| Step::Speed),
        _ => Err(Failure::NoSuchBound),
    }
}

/// The shortest evidence with which the lower vertex rule holds.
fn lower_step(model: &Model<Interval>, expansion: &Expansion<Interval>) -> Result<Step, Failure> {
    let candidates = rotation::candidates(&centre_of(&expansion.matrix));
    let mut failure = Failure::BadRotation;
    if let Some(first) = candidates.first().filter(|r| **r == rule::Rotation::IDENTITY) {
        if rule::lower(model, expansion, first).is_ok() {
            return Ok(Step::Lower(*first));
        }
    }
    // The last candidate is the best; where it fails, none is expected to hold.
    if let Some(best) = candidates.last() {
        match rule::lower(model, expansion, best) {
            Err(reason) => failure = reason,
            Ok(()) => {
                let holds = |r: &&rule::Rotation| rule::lower(model, expansion, r).is_ok();
                return Ok(Step::Lower(*candidates.iter().find(holds).unwrap_or(best)));
            }
        }
    }
    Err(failure)
}

/// Evidence with which the entrywise rule holds, where it is worth looking for: where `M` at the
/// centre is as wide, for the machines' tolerances, as what the cell adds. Else splitting does more.
fn entrywise_step(model: &Model<Interval>, expansion: &Expansion<Interval>) -> Option<Step> {
    let width = |entry: &Interval| entry.sup() - entry.inf();
    let machines: f64 = expansion.matrix.iter().flatten().map(width).sum();
    let cell: f64 = expansion.slopes.iter().flatten().flatten().map(Interval::mag).sum();
    if machines < cell {
        return None;
    }
    // Eight bits lose a few millionths of the bound, and fit the checker's machine words.
    let short = |rotation: &rule::Rotation| rotation.q.iter().all(|x| x.abs() <= 1 << 8);
    let rotation = rotation::candidates(&centre_of(&expansion.matrix)).into_iter().rfind(short)?;
    rule::entrywise(model, expansion, &rotation).is_ok().then_some(Step::Entrywise(rotation))
}

fn corner_step(model: &Model<Interval>, cell: &Cell) -> Option<Step> {
    let corners = [TightCorner::Q1, TightCorner::Q2];
    let corner = corners.into_iter().find(|corner| {
        model.is_cube
            && corner.touches(cell)
            && Expansion::new(model, cell, corner.expansion_point())
                .is_ok_and(|expansion| rule::corner(model, &expansion).is_ok())
    })?;
    Some(Step::Corner(corner))
}

/// The shortest evidence with which the conditioning rule holds. `mu` is put half-way between what
/// both vertex rules allow: at the centre, and, by differences, along each axis.
pub(crate) fn conditioning_step(
    model: &Model<Interval>,
    expansion: &Expansion<Interval>,
) -> Result<Step, Failure> {
    let c = model.bounds.conditioning.as_ref().ok_or(Failure::NoSuchBound)?.mid();
    let matrix = centre_of(&expansion.matrix);
    let middle = |m: Matrix3<f64>| {
        let xi = m.singular_values();
        (xi.min() + xi.max() / c) / 2.0
    };
    let scale = f64::from(rule::MU_BITS).exp2();
    let mut mu = [(middle(matrix) * scale) as i64, 0, 0, 0];
    for k in 0..3 {
        let slope = centre_of(&expansion.slopes[k]);
        mu[k + 1] = ((middle(matrix + slope) - middle(matrix - slope)) / 2.0 * scale) as i64;
    }
    let holds = |rotation: &rule::Rotation| rule::conditioning(model, expansion, rotation, &mu);
    let candidates = rotation::candidates(&matrix);
    let best = candidates.last().ok_or(Failure::BadRotation)?;
    holds(best)?;
    let rotation = *candidates.iter().find(|r| holds(r).is_ok()).unwrap_or(best);
    Ok(Step::Conditioning(ConditioningEvidence { rotation, mu }))
}

/// Whether the cell's centre is in the workspace: where it is not, what fails there need not fail
/// on the part of the cell that matters.
fn centre_is_asked_about(model: &Model<Interval>, cell: &Cell) -> bool {
    let from_axis = |k: usize| {
        let edge = cell.edges[k];
        (2.0 * edge.index as f64 + 1.0) * (-f64::from(edge.level)).exp2() - 1.0
    };
    !model.is_cylinder || from_axis(0).hypot(from_axis(1)) <= 1.0
}

/// A cell so small, next to the cell's centre, that a rule that fails on it fails on account of the
/// centre itself: the requirement fails there, holds with equality, or the parameters' tolerances
/// are too wide.
fn around_centre(cell: &Cell) -> Cell {
    /// Halvings from the cell's edges to the small cell's.
    const FINER: u32 = 20;
    let middle =
        |edge: Edge| Edge { index: (2 * edge.index + 1) << (FINER - 1), level: edge.level + FINER };
    Cell { edges: cell.edges.map(middle) }
}

/// The midpoints of an interval matrix.
fn centre_of(matrix: &Matrix<Interval>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| matrix[i][j].mid())
}

/// The axes by how much `M` varies along them: `h_k sum_ij mag(E_k)_ij`, greatest first.
fn axes_by_slopes(expansion: &Expansion<Interval>) -> [Axis; 3] {
    let weight = |k: usize| expansion.slopes[k].iter().flatten().map(Interval::mag).sum();
    by_weight(Axis::ALL, [weight(0), weight(1), weight(2)])
}

/// The axes by how much a leg's clearance gains in width from them, greatest first.
fn axes_by_clearance(model: &Model<Interval>, cell: &Cell, leg: usize) -> [Axis; 3] {
    let weight =
        |k: usize| {
            let ends = |parts: [(u128, u32); 3]| model.displacement(parts);
            let low = ends(cell.edges.map(|e| (e.index, e.level)));
            let high = ends(cell.edges.map(|e| (e.index + 1, e.level)));
            let centre = ends(cell.edges.map(|e| (2 * e.index + 1, e.level + 1)));
            let along: [Interval; 3] = std::array::from_fn(|axis| {
                if axis == k {
                    low[axis].join(&high[axis])
                } else {
                    centre[axis]
                }
            });
            let clearance = model.legs[leg].clearance(&model.leg_vectors(&along)[leg]);
            clearance.sup() - clearance.inf()
        };
    by_weight(Axis::ALL, [weight(0), weight(1), weight(2)])
}
