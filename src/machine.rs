//! The machine's search problem: its obligations and the rules that may discharge them.

use crate::interval::Interval;
use crate::rotation;
use crate::search::{by_weight, Problem, Trial};
use nalgebra::Matrix3;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::Step;
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
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
        let step = match (obligation, &expansion) {
            (Obligation::SigmaMax, _) if model.is_cube => Ok(Step::Cube),
            (Obligation::SigmaMin, expansion) => {
                let about_centre = match expansion {
                    Ok(expansion) => lower_step(model, expansion),
                    Err(out) => Err(Failure::from(*out)),
                };
                about_centre.or_else(|failure| corner_step(model, cell).ok_or(failure))
            }
            (Obligation::SigmaMax, Ok(expansion)) => {
                rule::upper(model, expansion).map(|()| Step::Upper)
            }
            (Obligation::JointRange, Ok(expansion)) => {
                rule::range(model, cell, expansion).map(|()| Step::Range)
            }
            (_, Err(out)) => Err(Failure::from(*out)),
            _ => Err(Failure::NoSuchBound),
        };
        match step {
            Ok(step) => trial.steps.push(step),
            Err(failure) => trial.failures.push((obligation, failure)),
        }
    }
    if let (Ok(expansion), false) = (&expansion, trial.failures.is_empty()) {
        trial.hopeless =
            trial.failures.iter().any(|&(o, _)| defeated_at_centre(model, expansion, o));
    }
    trial
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

/// Whether the rule fails already on the centre alone: the box contains a point at which it cannot
/// succeed, because the requirement fails there, holds with equality, or because the parameters'
/// tolerances are too wide.
fn defeated_at_centre(
    model: &Model<Interval>,
    expansion: &Expansion<Interval>,
    obligation: Obligation,
) -> bool {
    let zero = Interval::new(0.0, 0.0);
    let mut at_centre = expansion.clone();
    at_centre.slopes = [[[zero; 3]; 3]; 3];
    match obligation {
        Obligation::SigmaMin => lower_step(model, &at_centre).is_err(),
        Obligation::SigmaMax => rule::upper(model, &at_centre).is_err(),
        Obligation::JointRange => {
            let ranges = model.bounds.joint_range.iter().flatten();
            ranges.zip(&at_centre.rho).any(|((min, max), rho)| {
                let above = min.as_ref().is_none_or(|min| rho.sub(min).is_nonnegative());
                let below = max.as_ref().is_none_or(|max| max.sub(rho).is_nonnegative());
                !(above && below)
            })
        }
        _ => false,
    }
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
