//! Branch and bound: finds a bisection tree whose leaves discharge every obligation.
//!
//! A box is tried with every rule that may discharge what is still open on it; what stays open is
//! passed on to its two halves. The tree grows level by level, and what happens to a box depends on
//! the box alone, so the tree is the same for every number of threads. The rules themselves are the
//! [`Problem`]'s business: the checker's own rule functions, in floating-point intervals.

use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{Node, Step};
use orthocert_checker::rule::{Failure, Obligation};
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
    /// A box cannot be closed by splitting it further ([`prove`] only).
    Hopeless,
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
    /// Its position among the nodes.
    pub node: usize,
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
#[derive(Clone, Debug)]
pub struct Trial {
    /// The steps that discharge obligations on it.
    pub steps: Vec<Step>,
    /// What stays open, and why.
    pub failures: Vec<(Obligation, Failure)>,
    /// The axes on which to split, most promising first.
    pub axes: [Axis; 3],
    /// Not even the centre satisfies a rule: splitting cannot close all of the box. Looked at only
    /// where it is [worth asking](worth_asking_whether_hopeless).
    pub hopeless: bool,
}

/// Whether a box is so small that it is not split if it is hopeless.
pub fn worth_asking_whether_hopeless(cell: &Cell) -> bool {
    depth(cell) >= HOPELESS_DEPTH
}

fn depth(cell: &Cell) -> u32 {
    cell.edges.iter().map(|e| e.level).sum()
}

/// What a search is about.
pub trait Problem: Sync {
    /// What is to be discharged on every box.
    fn obligations(&self) -> Vec<Obligation>;
    /// Tries every rule that may discharge what is open on a box; depends on nothing else.
    fn try_box(&self, cell: &Cell, open: &[Obligation]) -> Trial;
}

/// Searches for a proof that every obligation of `problem` holds on the root cell.
pub fn search(problem: &impl Problem, budget: Budget, control: &mut Control<'_>) -> Outcome {
    run(problem, false, budget, control)
}

/// As [`search`], but ends with the first box that splitting cannot close: for callers who want a
/// proof or nothing, and no account of what remains.
pub fn prove(problem: &impl Problem, budget: Budget, control: &mut Control<'_>) -> Outcome {
    run(problem, true, budget, control)
}

/// Ends with a hopeless box if `hopeless` says so.
fn run(
    problem: &impl Problem,
    hopeless: bool,
    budget: Budget,
    control: &mut Control<'_>,
) -> Outcome {
    let mut tree = vec![growing(Cell::ROOT, problem.obligations())];
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
            let trials = try_all(problem, &tree, batch);
            let is_hopeless = trials.iter().any(|trial| trial.hopeless);
            for (&at, trial) in batch.iter().zip(trials) {
                settle(&mut tree, at, trial, &mut next, &mut closed);
            }
            boxes += batch.len();
            if is_hopeless && hopeless {
                stop = Stop::Hopeless;
                break;
            }
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
            None => {
                let (cell, node) = (grown.cell, nodes.len() - 1);
                open.push(OpenBox { cell, node, open: grown.failures.clone() });
            }
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

fn try_all(problem: &impl Problem, tree: &[Growing], batch: &[usize]) -> Vec<Trial> {
    let one = |&at: &usize| problem.try_box(&tree[at].cell, &tree[at].open);
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
    if trial.failures.is_empty() {
        *closed += (-f64::from(depth(&cell))).exp2();
        return;
    }
    if trial.hopeless && worth_asking_whether_hopeless(&cell) {
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

/// The axes by descending weight; the given order breaks ties.
pub fn by_weight(axes: [Axis; 3], weights: [f64; 3]) -> [Axis; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    order.map(|k| axes[k])
}
