//! Branch and bound: a bisection tree on whose leaves every obligation is discharged.
//!
//! The tree grows level by level, and what becomes of a box depends on the box and on what is open
//! there alone: it is the same for every number of threads.

use super::doubles::Pair;
use crate::search::{Budget, Control, Progress, Stop};
use orthocert_kernel::certificate::Node;
use rayon::prelude::*;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// A box, in the problem's unit.
pub type Cell = Vec<Pair>;

/// Most halvings of one coordinate.
const MOST_HALVINGS: u32 = 40;
/// Halvings a coordinate down to which a box is followed although its centre defeats every proposal.
const HOPELESS_HALVINGS: u32 = 4;
/// Boxes of a level from which on the thread pool takes them.
const PARALLEL_FROM: usize = 32;
/// Boxes between two looks at the clock.
const BATCH: usize = 1024;

/// A box on which something is open.
#[derive(Clone, Debug)]
pub struct Open {
    /// The box.
    pub cell: Cell,
    /// Halvings from the root's box to it.
    pub depth: u32,
    /// What is open.
    pub obligations: Vec<usize>,
}

/// The end of a search.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The tree in preorder; a proof if nothing is open.
    pub nodes: Vec<Node>,
    /// What remains.
    pub open: Vec<Open>,
    /// Boxes tried.
    pub boxes: usize,
    /// Why it ended.
    pub stop: Stop,
}

impl Outcome {
    /// Whether the tree is a proof.
    pub fn is_proof(&self) -> bool {
        self.open.is_empty() && self.stop == Stop::Exhausted
    }
}

/// What became of a box.
pub struct Trial {
    /// What is shown of all of it.
    pub node: Node,
    /// What stays open.
    pub open: Vec<usize>,
    /// How much is gained by halving a coordinate.
    pub weights: Vec<f64>,
    /// Not even next to the centre is a test passed.
    pub hopeless: bool,
}

/// What a search is about.
pub trait Boxes: Sync {
    /// The box to be covered, in the problem's unit.
    fn root(&self) -> &Cell;
    /// How many obligations there are.
    fn obligations(&self) -> usize;
    /// What becomes of a box on which these are open; where `asked`, whether it is hopeless.
    fn trial(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial;
}

struct Growing {
    item: Open,
    halvings: Vec<u32>,
    node: Node,
    halves: Option<[usize; 2]>,
}

/// Searches for a proof of every obligation; where `whole`, what is hopeless is an account of what
/// remains, else the end.
pub fn search(
    problem: &impl Boxes,
    whole: bool,
    budget: Budget,
    control: &mut Control<'_>,
) -> Outcome {
    let root = problem.root();
    let (m, all) = (root.len(), (0..problem.obligations()).collect());
    let root = Open { cell: root.clone(), depth: 0, obligations: all };
    let mut tree = vec![growing(root, vec![0; m])];
    let mut level = vec![0];
    let (mut boxes, mut closed, mut stop) = (0, 0.0, Stop::Exhausted);
    while !level.is_empty() && stop == Stop::Exhausted {
        let affordable = level.len().min(budget.max_boxes.saturating_sub(boxes));
        let mut next = Vec::new();
        for batch in level[..affordable].chunks(BATCH) {
            if let Some(reason) = interrupted(&budget, control) {
                stop = reason;
                break;
            }
            let trials = tried(problem, &tree, batch);
            let hopeless = trials.iter().any(|trial| trial.hopeless);
            for (&at, trial) in batch.iter().zip(trials) {
                closed += settle(&mut tree, at, trial, &mut next);
            }
            boxes += batch.len();
            if hopeless && !whole {
                stop = Stop::Hopeless;
                break;
            }
            (control.progress)(Progress { boxes, closed });
        }
        if stop == Stop::Exhausted && affordable < level.len() {
            stop = Stop::Boxes;
        }
        level = next;
    }
    let (nodes, open) = in_preorder(tree);
    Outcome { nodes, open, boxes, stop }
}

fn growing(item: Open, halvings: Vec<u32>) -> Growing {
    Growing { item, halvings, node: Node::default(), halves: None }
}

fn interrupted(budget: &Budget, control: &Control<'_>) -> Option<Stop> {
    if control.cancel.load(Ordering::Relaxed) {
        return Some(Stop::Cancelled);
    }
    budget.deadline.is_some_and(|deadline| Instant::now() >= deadline).then_some(Stop::Time)
}

fn tried(problem: &impl Boxes, tree: &[Growing], batch: &[usize]) -> Vec<Trial> {
    let one = |&at: &usize| {
        let Open { cell, depth, obligations } = &tree[at].item;
        let asked = *depth >= HOPELESS_HALVINGS * cell.len() as u32;
        problem.trial(cell, obligations, asked)
    };
    if batch.len() < PARALLEL_FROM {
        batch.iter().map(one).collect()
    } else {
        batch.par_iter().map(one).collect()
    }
}

/// Records a trial, and halves the box if something is open there; the volume that is closed.
fn settle(tree: &mut Vec<Growing>, at: usize, trial: Trial, next: &mut Vec<usize>) -> f64 {
    let grown = &mut tree[at];
    grown.node = trial.node;
    grown.item.obligations = trial.open;
    let Open { cell, depth, obligations } = grown.item.clone();
    if obligations.is_empty() {
        return (-f64::from(depth)).exp2();
    }
    let halvings = grown.halvings.clone();
    let splittable = (0..cell.len()).filter(|&k| {
        let (lo, hi) = cell[k];
        let middle = 0.5 * (lo + hi);
        halvings[k] < MOST_HALVINGS && lo < middle && middle < hi
    });
    // Of equal weights the first coordinate's.
    let greatest = |best: Option<usize>, k: usize| match best {
        Some(best) if trial.weights[best] >= trial.weights[k] => Some(best),
        _ => Some(k),
    };
    let axis = splittable.fold(None, greatest);
    let Some(k) = axis.filter(|_| !trial.hopeless) else { return 0.0 };
    grown.node.split = Some(k);
    let first = tree.len();
    tree[at].halves = Some([first, first + 1]);
    let middle = 0.5 * (cell[k].0 + cell[k].1);
    for edge in [(cell[k].0, middle), (middle, cell[k].1)] {
        let mut half =
            Open { cell: cell.clone(), depth: depth + 1, obligations: obligations.clone() };
        half.cell[k] = edge;
        let mut halvings = halvings.clone();
        halvings[k] += 1;
        next.push(tree.len());
        tree.push(growing(half, halvings));
    }
    0.0
}

fn in_preorder(tree: Vec<Growing>) -> (Vec<Node>, Vec<Open>) {
    let (mut nodes, mut open) = (Vec::with_capacity(tree.len()), Vec::new());
    let mut waiting = vec![0];
    while let Some(at) = waiting.pop() {
        let grown = &tree[at];
        nodes.push(grown.node.clone());
        match grown.halves {
            Some([lower, upper]) => waiting.extend([upper, lower]),
            None if grown.item.obligations.is_empty() => {}
            None => open.push(grown.item.clone()),
        }
    }
    (nodes, open)
}
