//! Trees of fewer leaves, by a look at what becomes of halves.

use super::search::{halved, search, Boxes, Cell, Ends, Trial};
use crate::search::{Budget, Control};
use orthocert_kernel::certificate::Node;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Nodes of the trees for which it is worth it. Of greater ones it would take seconds.
const NODES: std::ops::Range<usize> = 32..300;
/// Most coordinates: each asks for two boxes more.
const MOST_COORDINATES: usize = 3;
/// How many halves that are closed the greatest gain is worth.
const WORTH: f64 = 2.0;

/// A problem whose boxes are halved along the coordinate that closes most of the halves, if that is not one along which
/// far less is gained.
struct Ahead<'a, P> {
    problem: &'a P,
    boxes: AtomicUsize,
}

impl<P: Boxes> Ahead<'_, P> {
    fn tried(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial {
        self.boxes.fetch_add(1, Ordering::Relaxed);
        self.problem.trial(cell, open, asked)
    }

    /// How many of the halves along a coordinate are closed.
    fn closed(&self, cell: &Cell, k: usize, open: &[usize]) -> usize {
        let is_closed = |half: &Cell| self.tried(half, open, false).open.is_empty();
        halved(cell, k).into_iter().flatten().filter(is_closed).count()
    }
}

impl<P: Boxes> Boxes for Ahead<'_, P> {
    fn root(&self) -> &Cell {
        self.problem.root()
    }

    fn obligations(&self) -> usize {
        self.problem.obligations()
    }

    fn trial(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial {
        let mut trial = self.tried(cell, open, asked);
        let greatest = trial.weights.iter().fold(0.0, |most: f64, &weight| most.max(weight));
        if !trial.open.is_empty() && !trial.hopeless {
            for (k, weight) in trial.weights.iter_mut().enumerate() {
                let closed = self.closed(cell, k, &trial.open);
                *weight = WORTH * *weight / greatest + closed as f64;
            }
        }
        trial
    }

    fn is_costly(&self) -> bool {
        self.problem.is_costly()
    }
}

/// A tree of fewer nodes than one of moderate size, or that one, where none is found until a deadline; and how many
/// boxes were tried for it.
pub(super) fn fewer(
    problem: &impl Boxes,
    nodes: Vec<Node>,
    deadline: Option<Instant>,
    cancel: &AtomicBool,
) -> (Vec<Node>, usize) {
    if !NODES.contains(&nodes.len()) || problem.root().len() > MOST_COORDINATES {
        return (nodes, 0);
    }
    let ahead = Ahead { problem, boxes: AtomicUsize::new(0) };
    let budget = Budget { max_boxes: nodes.len() - 1, deadline };
    let ends = Ends { hopeless: true, ..Ends::default() };
    let control = &mut Control { cancel, progress: &mut |_| {} };
    let found = search(&ahead, ends, budget, control).proof();
    (found.unwrap_or(nodes), ahead.boxes.into_inner())
}
