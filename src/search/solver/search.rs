//! Branch and bound: a bisection tree on whose leaves every obligation is discharged.
//!
//! The tree grows level by level, and what becomes of a box depends on the box and on what is open
//! there alone: it is the same for every number of threads, and grown in parts.

use super::doubles::Pair;
use crate::search::{Budget, Control, Progress, Stop};
use orthocert_kernel::certificate::Node;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// A box, in the problem's unit.
pub type Cell = Vec<Pair>;

/// Most halvings of one coordinate.
const MOST_HALVINGS: u32 = 40;
/// Halvings a coordinate down to which a box is followed although its centre defeats every proposal.
const HOPELESS_HALVINGS: u32 = 4;
/// Boxes of a level from which on the thread pool takes them, where each costs little.
const PARALLEL_FROM: usize = 32;
/// Boxes between two looks at how far it is.
const BATCH: usize = 128;

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

/// A box of a tree by the way to it, and what is open there: where a part of the tree begins.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Branch {
    /// From the root on: the coordinate that is halved, and whether to the upper half.
    pub path: Vec<(usize, bool)>,
    /// The obligations that are open.
    pub open: Vec<usize>,
}

impl Branch {
    /// The box, with the halvings of each coordinate; none beyond what trees have.
    fn begin(&self, problem: &impl Boxes) -> Option<Growing> {
        let mut cell = problem.root().clone();
        let mut halvings = vec![0; cell.len()];
        for &(k, is_upper) in &self.path {
            let halves = halves(*cell.get(k)?).filter(|_| halvings[k] < MOST_HALVINGS)?;
            cell[k] = halves[usize::from(is_upper)];
            halvings[k] += 1;
        }
        let known = self.open.iter().all(|&o| o < problem.obligations());
        let depth = halvings.iter().sum();
        let item = Open { cell, depth, obligations: self.open.clone() };
        known.then(|| growing(item, halvings))
    }
}

/// The halves of an edge, unless it is too short for doubles.
pub(super) fn halves((lo, hi): Pair) -> Option<[Pair; 2]> {
    let middle = 0.5 * (lo + hi);
    (lo < middle && middle < hi).then_some([(lo, middle), (middle, hi)])
}

/// The halves of a box along a coordinate, unless its edge is too short.
pub(super) fn halved(cell: &Cell, k: usize) -> Option<[Cell; 2]> {
    let half = |edge| {
        let mut half = cell.clone();
        half[k] = edge;
        half
    };
    Some(halves(*cell.get(k)?)?.map(half))
}

/// The end of a search.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The tree in preorder; a proof if nothing is open.
    pub nodes: Vec<Node>,
    /// What remains.
    pub open: Vec<Open>,
    /// Boxes that were not tried, by their positions among the nodes: where a search of parts stopped.
    pub waiting: Vec<(usize, Branch)>,
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

    /// Whether nothing else is to be tried: it is a proof, or was cancelled.
    pub(super) fn is_final(&self) -> bool {
        self.is_proof() || self.stop == Stop::Cancelled
    }

    /// The tree if it is a proof; why the search ended, if not.
    pub(super) fn proof(self) -> Result<Vec<Node>, Stop> {
        match self.is_proof() {
            true => Ok(self.nodes),
            false => Err(self.stop),
        }
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
    /// Whether each box costs far more than to give it to another thread: of platforms that turn it does.
    fn is_costly(&self) -> bool {
        self.root().len() > 3
    }
}

struct Growing {
    item: Open,
    halvings: Vec<u32>,
    node: Node,
    halves: Option<[usize; 2]>,
    tried: bool,
}

/// What ends a search, beside its budget.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ends {
    /// A box that is hopeless: for those who want a proof or nothing, and no account of what remains.
    pub hopeless: bool,
    /// A level of so many boxes.
    pub enough: Option<usize>,
}

/// Searches for a proof of all there is.
pub fn search(
    problem: &impl Boxes,
    ends: Ends,
    budget: Budget,
    control: &mut Control<'_>,
) -> Outcome {
    grow(problem, (vec![root(problem)], vec![0]), &[], ends, budget, control)
}

/// Searches for a proof of what is open on a branch; none of a branch that no tree has.
pub fn search_below(
    problem: &impl Boxes,
    branch: &Branch,
    ends: Ends,
    budget: Budget,
    control: &mut Control<'_>,
) -> Option<Outcome> {
    let tree = vec![branch.begin(problem)?];
    Some(grow(problem, (tree, vec![0]), &branch.path, ends, budget, control))
}

/// Goes on with the whole tree of a search that its budget ended, where it stopped; none of another tree.
/// What is closed stays so, though the problem may now be an easier one.
pub fn resume(
    problem: &impl Boxes,
    before: &Outcome,
    ends: Ends,
    budget: Budget,
    control: &mut Control<'_>,
) -> Option<Outcome> {
    let waiting = before.waiting.iter().map(|(position, branch)| (*position, &branch.open));
    let waiting: HashMap<usize, &Vec<usize>> = waiting.collect();
    let mut tree = vec![root(problem)];
    let (mut level, mut ahead) = (Vec::new(), vec![0]);
    for (position, node) in before.nodes.iter().enumerate() {
        let at = ahead.pop()?;
        if let Some(&open) = waiting.get(&position) {
            tree[at].item.obligations.clone_from(open);
            level.push(at);
            continue;
        }
        let obligations = std::mem::take(&mut tree[at].item.obligations);
        tree[at].node = Node { split: None, ..node.clone() };
        tree[at].tried = true;
        if let Some(k) = node.split {
            tree[at].item.obligations = obligations;
            let cells = halved(&tree[at].item.cell, k)?;
            ahead.extend(halve(&mut tree, at, k, cells).into_iter().rev());
        }
    }
    let grown = grow(problem, (tree, level), &[], ends, budget, control);
    Some(Outcome { boxes: before.boxes + grown.boxes, ..grown })
}

/// Grows a tree from the boxes of a level on.
fn grow(
    problem: &impl Boxes,
    (mut tree, mut level): (Vec<Growing>, Vec<usize>),
    path: &[(usize, bool)],
    ends: Ends,
    budget: Budget,
    control: &mut Control<'_>,
) -> Outcome {
    let (mut boxes, mut share, mut stop) = (0, 0.0f64, Stop::Exhausted);
    let cancel = control.cancel;
    let few = |level: &[usize]| ends.enough.is_none_or(|enough| level.len() < enough);
    while !level.is_empty() && few(&level) && stop == Stop::Exhausted {
        let affordable = level.len().min(budget.max_boxes.saturating_sub(boxes));
        let (mut next, mut tried_here) = (Vec::new(), 0);
        for batch in level[..affordable].chunks(BATCH) {
            let trials = tried(problem, &tree, batch, || interrupted(&budget, cancel));
            let mut hopeless = false;
            for (&at, trial) in batch.iter().zip(trials) {
                match trial {
                    Ok(trial) => {
                        hopeless |= trial.hopeless;
                        settle(&mut tree, at, trial, &mut next);
                        (boxes, tried_here) = (boxes + 1, tried_here + 1);
                    }
                    Err(reason) => stop = reason,
                }
            }
            if stop != Stop::Exhausted {
                break;
            }
            if hopeless && ends.hopeless {
                stop = Stop::Hopeless;
                break;
            }
            let growth = next.len() as f64 / tried_here as f64;
            let waiting = level.len() - tried_here + next.len();
            let most = budget.max_boxes.saturating_sub(boxes);
            share = share.max(done(boxes, waiting, growth, most));
            (control.progress)(Progress { boxes, share });
        }
        if stop == Stop::Exhausted && affordable < level.len() {
            stop = Stop::Boxes;
        }
        level = next;
    }
    let (nodes, open, waiting) = in_preorder(tree, path);
    Outcome { nodes, open, waiting, boxes, stop }
}

/// All that is to be covered, and shown there.
fn root(problem: &impl Boxes) -> Growing {
    let (cell, obligations) = (problem.root().clone(), (0..problem.obligations()).collect());
    let halvings = vec![0; cell.len()];
    growing(Open { cell, depth: 0, obligations }, halvings)
}

fn growing(item: Open, halvings: Vec<u32>) -> Growing {
    Growing { item, halvings, node: Node::default(), halves: None, tried: false }
}

fn interrupted(budget: &Budget, cancel: &AtomicBool) -> Result<(), Stop> {
    if cancel.load(Ordering::Relaxed) {
        return Err(Stop::Cancelled);
    }
    if budget.is_over() {
        Err(Stop::Time)
    } else {
        Ok(())
    }
}

/// What becomes of each box of a batch, or why it was not tried any more.
fn tried(
    problem: &impl Boxes,
    tree: &[Growing],
    batch: &[usize],
    interrupted: impl Fn() -> Result<(), Stop> + Sync,
) -> Vec<Result<Trial, Stop>> {
    let one = |&at: &usize| {
        interrupted()?;
        let Open { cell, depth, obligations } = &tree[at].item;
        let asked = *depth >= HOPELESS_HALVINGS * cell.len() as u32;
        Ok(problem.trial(cell, obligations, asked))
    };
    if batch.len() >= PARALLEL_FROM || (batch.len() > 1 && problem.is_costly()) {
        batch.par_iter().map(one).collect()
    } else {
        batch.iter().map(one).collect()
    }
}

/// The share that is done once so many boxes are tried and others wait, of which at most `most` can be: a
/// box below which levels grow by a factor `g < 1` has `1/(1 - g)` below it, with itself. While they do
/// not become smaller, nothing tells how many there will be: as many digits of them as of the most are done.
fn done(boxes: usize, waiting: usize, growth: f64, most: usize) -> f64 {
    let (boxes, most) = (boxes as f64, most as f64);
    if growth < 1.0 {
        return boxes / (boxes + (waiting as f64 / (1.0 - growth)).min(most));
    }
    0.8 * boxes.ln_1p() / (boxes + most).ln_1p()
}

/// Records a trial, and halves the box if something is open there.
fn settle(tree: &mut Vec<Growing>, at: usize, trial: Trial, next: &mut Vec<usize>) {
    let grown = &mut tree[at];
    grown.tried = true;
    grown.node = trial.node;
    grown.item.obligations = trial.open;
    if grown.item.obligations.is_empty() {
        return;
    }
    let (cell, halvings) = (&grown.item.cell, &grown.halvings);
    let splittable =
        (0..cell.len()).filter(|&k| halvings[k] < MOST_HALVINGS && halves(cell[k]).is_some());
    // Of equal weights the first coordinate's.
    let greatest = |best: Option<usize>, k: usize| match best {
        Some(best) if trial.weights[best] >= trial.weights[k] => Some(best),
        _ => Some(k),
    };
    let axis = splittable.fold(None, greatest);
    let axis = axis.filter(|_| !trial.hopeless);
    let Some((k, cells)) = axis.and_then(|k| Some((k, halved(cell, k)?))) else { return };
    next.extend(halve(tree, at, k, cells));
}

/// Adds the halves of a box, on which the same is open.
fn halve(tree: &mut Vec<Growing>, at: usize, k: usize, cells: [Cell; 2]) -> [usize; 2] {
    let grown = &mut tree[at];
    grown.node.split = Some(k);
    let (depth, obligations) = (grown.item.depth + 1, grown.item.obligations.clone());
    let mut halvings = grown.halvings.clone();
    halvings[k] += 1;
    let halves = [tree.len(), tree.len() + 1];
    tree[at].halves = Some(halves);
    for cell in cells {
        let half = Open { cell, depth, obligations: obligations.clone() };
        tree.push(growing(half, halvings.clone()));
    }
    halves
}

type InPreorder = (Vec<Node>, Vec<Open>, Vec<(usize, Branch)>);

fn in_preorder(tree: Vec<Growing>, path: &[(usize, bool)]) -> InPreorder {
    let (mut nodes, mut open) = (Vec::with_capacity(tree.len()), Vec::new());
    let mut untried = Vec::new();
    // Of each node how long the path above it is, and the half that it is.
    let (mut path, mut waiting) = (path.to_vec(), vec![(0, path.len(), None)]);
    while let Some((at, above, half)) = waiting.pop() {
        path.truncate(above);
        path.extend(half);
        let grown = &tree[at];
        nodes.push(grown.node.clone());
        match (grown.halves, grown.node.split) {
            (Some([lower, upper]), Some(k)) => {
                let to = |half, is_upper| (half, path.len(), Some((k, is_upper)));
                waiting.extend([to(upper, true), to(lower, false)]);
            }
            _ if grown.item.obligations.is_empty() => {}
            _ if grown.tried => open.push(grown.item.clone()),
            _ => {
                open.push(grown.item.clone());
                let branch = Branch { path: path.clone(), open: grown.item.obligations.clone() };
                untried.push((nodes.len() - 1, branch));
            }
        }
    }
    (nodes, open, untried)
}
