//! Branch and bound: finds a bisection tree whose leaves discharge every obligation.
//!
//! A box is tried with every rule that may discharge what is still open on it, with the checker's
//! own rule functions in floating-point intervals; what stays open is passed on to its two halves.
//! The tree grows level by level, and what happens to a box depends on the box alone, so the tree
//! is the same for every number of threads.

use crate::interval::Interval;
use crate::rotation;
use nalgebra::Matrix3;
use orthocert_checker::cell::{Axis, Cell};
pub use orthocert_checker::certificate::Node as TreeNode;
use orthocert_checker::certificate::{Node, Step};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::linear::Matrix;
use orthocert_checker::model::Model;
use orthocert_checker::obligations;
use orthocert_checker::rule::{self, Failure, Obligation, TightCorner};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Deepest bisection of one axis: beyond it, doubles no longer separate a box's faces.
const MAX_LEVEL: u32 = 46;
/// Splits down to which a box is followed although its centre already defeats the rules.
const HOPELESS_DEPTH: u32 = 12;
/// Boxes of one level from which on they are handed to the thread pool.
const PARALLEL_FROM: usize = 32;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Most boxes to be tried.
    pub max_boxes: usize,
    /// The moment at which to give up.
    pub deadline: Option<Instant>,
}

/// How far a search is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Boxes tried.
    pub boxes: usize,
    /// Share of the workspace's volume on which nothing is open.
    pub closed: f64,
}

/// The outside's hold on a search.
pub struct Control<'a> {
    /// Set to make the search end with [`Stop::Cancelled`].
    pub cancel: &'a AtomicBool,
    /// Called now and then, from the thread that started the search.
    pub progress: &'a mut dyn FnMut(Progress),
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Every box was either closed or cannot be closed by splitting it further.
    Exhausted,
    /// `max_boxes` were tried.
    Boxes,
    /// The deadline passed.
    Time,
    /// It was cancelled.
    Cancelled,
}

/// A box on which something is still open.
#[derive(Clone, Debug)]
pub struct OpenBox {
    /// The box.
    pub cell: Cell,
    /// What is open, and why the last rule tried did not close it; no reason where none was tried.
    pub open: Vec<(Obligation, Option<Failure>)>,
}

/// The end of a search.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The tree in preorder; a proof if `open` is empty.
    pub nodes: Vec<Node>,
    /// What remains.
    pub open: Vec<OpenBox>,
    /// Boxes tried.
    pub boxes: usize,
    /// Why the search ended.
    pub stop: Stop,
}

/// A node of the growing tree.
struct Growing {
    cell: Cell,
    open: Vec<Obligation>,
    node: Node,
    /// Positions of the halves, if it was split.
    halves: Option<(usize, usize)>,
    failures: Vec<(Obligation, Option<Failure>)>,
}

/// What became of one box.
struct Trial {
    steps: Vec<Step>,
    failures: Vec<(Obligation, Failure)>,
    /// The axes, most promising first.
    axes: [Axis; 3],
    /// Not even the centre satisfies the rule: splitting cannot close all of the box.
    hopeless: bool,
}

/// Searches for a proof that every obligation of `model` holds on its workspace.
pub fn search(model: &Model<Interval>, budget: Budget, control: &mut Control<'_>) -> Outcome {
    let mut tree = vec![growing(Cell::ROOT, obligations(model))];
    let mut level = vec![0];
    let mut boxes = 0;
    let mut closed = 0.0;
    let mut stop = Stop::Exhausted;
    while !level.is_empty() && stop == Stop::Exhausted {
        let affordable = level.len().min(budget.max_boxes - boxes);
        let (now, later) = level.split_at(affordable);
        let mut next = Vec::new();
        for batch in now.chunks(4096) {
            if let Some(reason) = interrupted(&budget, control.cancel) {
                stop = reason;
                break;
            }
            let trials = try_all(model, &tree, batch);
            for (&at, trial) in batch.iter().zip(trials) {
                settle(&mut tree, at, trial, &mut next, &mut closed);
            }
            boxes += batch.len();
            (control.progress)(Progress { boxes, closed });
        }
        if stop == Stop::Exhausted && !later.is_empty() {
            stop = Stop::Boxes;
        }
        level = next;
    }
    let mut nodes = Vec::with_capacity(tree.len());
    let mut open = Vec::new();
    let mut waiting = vec![0];
    while let Some(at) = waiting.pop() {
        let grown = &tree[at];
        nodes.push(grown.node.clone());
        match grown.halves {
            Some((lower, upper)) => waiting.extend([upper, lower]),
            None if grown.failures.is_empty() => {}
            None => open.push(OpenBox { cell: grown.cell, open: grown.failures.clone() }),
        }
    }
    Outcome { nodes, open, boxes, stop }
}

fn growing(cell: Cell, open: Vec<Obligation>) -> Growing {
    let failures = open.iter().map(|&o| (o, None)).collect();
    Growing { cell, open, node: Node::default(), halves: None, failures }
}

fn interrupted(budget: &Budget, cancel: &AtomicBool) -> Option<Stop> {
    if cancel.load(Ordering::Relaxed) {
        return Some(Stop::Cancelled);
    }
    budget.deadline.is_some_and(|deadline| Instant::now() >= deadline).then_some(Stop::Time)
}

fn try_all(model: &Model<Interval>, tree: &[Growing], batch: &[usize]) -> Vec<Trial> {
    let one = |&at: &usize| try_box(model, &tree[at].cell, &tree[at].open);
    if batch.len() < PARALLEL_FROM {
        batch.iter().map(one).collect()
    } else {
        batch.par_iter().map(one).collect()
    }
}

/// Records a trial in the tree and splits the box if something is open on it.
fn settle(
    tree: &mut Vec<Growing>,
    at: usize,
    trial: Trial,
    next: &mut Vec<usize>,
    closed: &mut f64,
) {
    let cell = tree[at].cell;
    tree[at].node.by = trial.steps;
    tree[at].failures = trial.failures.iter().map(|&(o, f)| (o, Some(f))).collect();
    let depth: u32 = cell.edges.iter().map(|e| e.level).sum();
    if trial.failures.is_empty() {
        *closed += (-f64::from(depth)).exp2();
        return;
    }
    if trial.hopeless && depth >= HOPELESS_DEPTH {
        return;
    }
    let splittable = |axis: &Axis| cell.edges[axis.index()].level < MAX_LEVEL;
    let Some(axis) = trial.axes.into_iter().find(splittable) else {
        return;
    };
    let Some((lower, upper)) = cell.halves(axis) else {
        return;
    };
    let open: Vec<Obligation> = trial.failures.iter().map(|&(o, _)| o).collect();
    let first = tree.len();
    tree.push(growing(lower, open.clone()));
    tree.push(growing(upper, open));
    next.extend([first, first + 1]);
    tree[at].node.split = Some(axis);
    tree[at].halves = Some((first, first + 1));
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
                use orthocert_checker::enclosure::Scalar;
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
    by_weight(|k| expansion.slopes[k].iter().flatten().map(Interval::mag).sum())
}

/// The axes by how much a leg's clearance gains in width from them, greatest first.
fn axes_by_clearance(model: &Model<Interval>, cell: &Cell, leg: usize) -> [Axis; 3] {
    by_weight(|k| {
        let ends = |parts: [(u128, u32); 3]| model.displacement(parts);
        let low = ends(cell.edges.map(|e| (e.index, e.level)));
        let high = ends(cell.edges.map(|e| (e.index + 1, e.level)));
        let centre = ends(cell.edges.map(|e| (2 * e.index + 1, e.level + 1)));
        let along: [Interval; 3] =
            std::array::from_fn(
                |axis| {
                    if axis == k {
                        low[axis].join(&high[axis])
                    } else {
                        centre[axis]
                    }
                },
            );
        let clearance = model.legs[leg].clearance(&model.leg_vectors(&along)[leg]);
        clearance.sup() - clearance.inf()
    })
}

fn by_weight(weight: impl Fn(usize) -> f64) -> [Axis; 3] {
    let weights: [f64; 3] = std::array::from_fn(weight);
    let mut axes = Axis::ALL;
    axes.sort_by(|a, b| weights[b.index()].total_cmp(&weights[a.index()]));
    axes
}
