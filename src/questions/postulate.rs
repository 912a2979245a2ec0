//! Proofs of the Q1/Q2 postulate for one `psi_max`, a range of them, or every one: a tree over `kappa`
//! and two coordinates for each face and half. What closes a box is tried in doubles, by the tests of
//! [`orthocert_kernel::postulate`]; the exact checker decides.

use crate::search::solver::doubles::{Doubles, Pair};
use crate::search::solver::{confirmed, Answer, Undecided, Verification, PRECISIONS};
use crate::search::{is_over, Budget, Control, Progress, Stop};
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::{Claim, Corner, Evidence, Node, Step, Tree};
use orthocert_kernel::claim::PostulateClaim;
use orthocert_kernel::fixed::Interval;
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::postulate::{parts, Part};
use std::collections::HashMap;
use std::sync::atomic::Ordering;

/// Fractional bits of the search's boxes.
const BITS: u32 = PRECISIONS[0];

/// Proves the postulate for the claim's `psi_max`.
///
/// # Errors
/// If the claim is not well formed.
pub fn prove(
    claim: &PostulateClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Verification, ClaimError> {
    let parts = parts(claim)?;
    let share = 1.0 / parts.len() as f64;
    let mut growing = Growing { nodes: Vec::new(), closed: 0.0, budget, control };
    for part in &parts {
        let mut search = Search { part, tried: HashMap::new() };
        let grown = search.grow(&mut growing, &part.root(BITS)?, share);
        let Err(stop) = grown else { continue };
        let answer = match stop {
            Stop::Cancelled => Answer::Cancelled,
            stop => Answer::Undecided(Undecided { open: Vec::new(), stop, objection: None }),
        };
        return Ok(Verification { answer, worst: Vec::new(), boxes: growing.nodes.len() });
    }
    let boxes = growing.nodes.len();
    let tree = Tree { precision: BITS, chords: None, nodes: growing.nodes };
    let answer = confirmed(Claim::Postulate(claim.clone()), tree, PRECISIONS).into();
    Ok(Verification { answer, worst: Vec::new(), boxes })
}

/// The trees so far.
struct Growing<'a, 'c> {
    nodes: Vec<Node>,
    /// The share of the parts' volume on which nothing is open.
    closed: f64,
    budget: Budget,
    control: &'a mut Control<'c>,
}

impl Growing<'_, '_> {
    fn interrupted(&self) -> Option<Stop> {
        let Budget { max_boxes, deadline } = self.budget;
        if self.control.cancel.load(Ordering::Relaxed) {
            Some(Stop::Cancelled)
        } else if is_over(deadline) {
            Some(Stop::Time)
        } else {
            (self.nodes.len() >= max_boxes).then_some(Stop::Boxes)
        }
    }
}

/// The search for the tree of a part.
struct Search<'a> {
    part: &'a Part,
    /// What closes the boxes that have been tried: each is met in several orders.
    tried: HashMap<Vec<[i64; 2]>, Option<Evidence>>,
}

impl Search<'_> {
    /// What closes a box.
    fn closing(&mut self, cell: &Cell<i64>) -> Option<Evidence> {
        let key: Vec<[i64; 2]> = cell.0.iter().map(|edge| [edge.lo, edge.hi]).collect();
        if let Some(known) = self.tried.get(&key) {
            return known.clone();
        }
        let found = self.found(cell);
        self.tried.insert(key, found.clone());
        found
    }

    fn found(&self, cell: &Cell<i64>) -> Option<Evidence> {
        let scale = (-f64::from(BITS)).exp2();
        let pair = |x: &Interval<i64>| -> Pair { (x.lo as f64 * scale, x.hi as f64 * scale) };
        let edges = cell.edges()?;
        let edges: Vec<[Pair; 3]> = edges.iter().map(|edge| edge.each_ref().map(pair)).collect();
        // Away from the face's own corner, what is shown about it is no more than what is shown about
        // the centre.
        let at_end = |edge: &Interval<i64>| match self.part.face {
            Corner::Q1 => edge.lo == 0,
            Corner::Q2 => edge.hi == 1 << BITS,
        };
        let touches = cell.0.iter().take(2).all(at_end);
        let corner = touches.then_some(Evidence::Corner(self.part.face));
        let mut tried =
            [Some(Evidence::Mirror), Some(Evidence::Test), corner].into_iter().flatten();
        tried.find(|evidence| self.part.shows(&Doubles, &edges, evidence))
    }

    /// What halving a box along `k` is worth: a half that closes 4, else for each of its own halves
    /// that then closes 1, along its best coordinate.
    fn worth(&mut self, cell: &Cell<i64>, k: usize, each: u32) -> u32 {
        let halves = cell.halves(k).into_iter().flatten();
        let of = |half: Cell<i64>| match self.closing(&half) {
            Some(_) => each,
            None if each == 1 => 0,
            None => (0..3).map(|k| self.worth(&half, k, 1)).max().unwrap_or(0),
        };
        halves.map(of).sum()
    }

    /// The tree over a box, which is halved along the coordinate along which most of it closes.
    fn grow(
        &mut self,
        growing: &mut Growing<'_, '_>,
        cell: &Cell<i64>,
        share: f64,
    ) -> Result<(), Stop> {
        growing.interrupted().map_or(Ok(()), Err)?;
        if let Some(evidence) = self.closing(cell) {
            growing.nodes.push(Node { by: vec![Step(0, evidence)], ..Node::default() });
            growing.closed += share;
            let progress = Progress { boxes: growing.nodes.len(), share: growing.closed };
            (growing.control.progress)(progress);
            return Ok(());
        }
        // On a tie the first of y, z, kappa.
        let k = (0..3).rev().max_by_key(|&k| self.worth(cell, k, 4)).unwrap_or(0);
        let halves = cell.halves(k).ok_or(Stop::Exhausted)?;
        growing.nodes.push(Node { split: Some(k), ..Node::default() });
        halves.iter().try_for_each(|half| self.grow(growing, half, 0.5 * share))
    }
}
