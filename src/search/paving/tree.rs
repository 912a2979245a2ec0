//! The tree of a paving: written depth first, cut into subtrees for the threads.

use super::decide::{Decider, Fate};
use orthocert_kernel::paving::{discharged, Axis, Item, Kind, Root};
use orthocert_kernel::prover::{write_pair, write_steps};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// A stretch of a tree in preorder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Segment {
    /// Nodes that are known.
    Known(Vec<u8>),
    /// A subtree.
    Subtree(Root),
}

/// The bytes of a segment, and the boxes that were tried for them.
pub type Grown = (Vec<u8>, u64);

/// What a growing tree has come to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Cells tried.
    pub boxes: u64,
    /// The share of inner cells, in units of `2^-SHARE_BITS`.
    pub inner: u128,
}

/// Whether something of a cell is left undecided.
pub(super) fn is_left(kind: &Kind) -> bool {
    matches!(kind, Kind::Boundary | Kind::Cut(_))
}

/// Grows trees of one claim down to one depth.
pub struct Grower<'a> {
    /// Decides the cells.
    pub decider: &'a Decider<'a>,
    /// Most splits on a path.
    pub depth: u32,
    /// Set to give up.
    pub cancel: &'a AtomicBool,
}

/// The tree cannot be finished: it was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl Grower<'_> {
    /// Appends a subtree's nodes to `out`.
    pub fn grow(&self, root: Root, out: &mut Vec<u8>, tally: &mut Tally) -> Result<(), Cancelled> {
        let mut waiting = vec![root];
        while let Some(root) = waiting.pop() {
            // A box for all values of other coordinates may take a second.
            let is_asked = tally.boxes.is_multiple_of(256) || self.decider.is_for_all();
            if is_asked && self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            self.node(&root, out, tally, &mut waiting);
        }
        Ok(())
    }

    /// The bytes of segments, which are grown side by side, and the cells tried for each.
    pub fn grow_all(&self, segments: &[Segment]) -> Result<Vec<Grown>, Cancelled> {
        let grown = |segment: &Segment| match segment {
            Segment::Known(bytes) => Ok((bytes.clone(), 0)),
            Segment::Subtree(root) => {
                let mut bytes = Vec::new();
                let mut tally = Tally::default();
                self.grow(*root, &mut bytes, &mut tally)?;
                Ok((bytes, tally.boxes))
            }
        };
        segments.par_iter().with_max_len(1).map(grown).collect()
    }

    /// The tree below `root`, with the subtrees below `coarse` left to be grown.
    pub fn segments(
        &self,
        root: Root,
        coarse: u32,
        tally: &mut Tally,
    ) -> Result<Vec<Segment>, Cancelled> {
        let mut segments = Vec::new();
        let mut known = Vec::new();
        let mut waiting = vec![root];
        while let Some(root) = waiting.pop() {
            if self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            if root.depth == coarse && self.depth > coarse {
                if !known.is_empty() {
                    segments.push(Segment::Known(std::mem::take(&mut known)));
                }
                segments.push(Segment::Subtree(root));
            } else {
                self.node(&root, &mut known, tally, &mut waiting);
            }
        }
        if !known.is_empty() {
            segments.push(Segment::Known(known));
        }
        Ok(segments)
    }

    /// Decides cells of one depth; returns those that are split, each with its halves.
    pub(super) fn level(
        &self,
        roots: &[Root],
        tally: &mut Tally,
    ) -> Result<Vec<(Root, [Root; 2])>, Cancelled> {
        let of_root = |root: &Root| {
            if self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            let mut own = Tally::default();
            let (item, _) = self.decided(root, &mut own);
            Ok((own, halves(root, &item).map(|(_, halves)| (*root, halves))))
        };
        let all: Vec<_> = roots.par_iter().map(of_root).collect::<Result<_, _>>()?;
        tally.boxes += all.len() as u64;
        tally.inner += all.iter().map(|(own, _)| own.inner).sum::<u128>();
        Ok(all.into_iter().filter_map(|(_, split)| split).collect())
    }

    /// Decides a node and appends it; its halves, if it is split, wait. Halves that may not be split
    /// are appended with it, in one byte where that does for them.
    fn node(&self, root: &Root, out: &mut Vec<u8>, tally: &mut Tally, waiting: &mut Vec<Root>) {
        let (item, parts) = self.decided(root, tally);
        let Some((axis, [lower, upper])) = halves(root, &item) else {
            // Every step and failure that a decision makes has a code.
            let written = [&item].into_iter().chain(&parts).try_for_each(|item| item.write(out));
            debug_assert!(written.is_some());
            return;
        };
        if root.depth + 1 < self.depth {
            let written = item.write(out);
            debug_assert!(written.is_some());
            waiting.extend([upper, lower]);
            return;
        }
        let (lower, of_lower) = self.decided(&lower, tally);
        let (upper, of_upper) = self.decided(&upper, tally);
        let steps = write_steps(&item.steps, out);
        debug_assert!(steps.is_some());
        let is_bare = lower.steps.is_empty() && upper.steps.is_empty();
        if is_bare && write_pair(out, axis, [&lower.kind, &upper.kind]).is_some() {
            return;
        }
        let split = Item { steps: Vec::new(), kind: Kind::Split(axis) };
        let of_lower = [&split, &lower].into_iter().chain(&of_lower);
        let mut items = of_lower.chain([&upper]).chain(&of_upper);
        let written = items.try_for_each(|item| item.write(out));
        debug_assert!(written.is_some());
    }

    /// A node, and the nodes of its parts.
    fn decided(&self, root: &Root, tally: &mut Tally) -> (Item, Vec<Item>) {
        let decision = self.decider.decide(&root.cell, root.inherited);
        tally.boxes += 1;
        let kind = match decision.fate {
            Fate::Closed(kind) => kind,
            Fate::Open(Some(axis)) if root.depth < self.depth => Kind::Split(axis),
            Fate::Open(_) => {
                self.decider.cut(&root.cell, root.inherited).map_or(Kind::Boundary, Kind::Cut)
            }
        };
        if matches!(kind, Kind::Inner | Kind::Part(_)) {
            tally.inner += self.decider.share(&root.cell);
        }
        let steps = if is_left(&kind) { Vec::new() } else { decision.steps };
        (Item { steps, kind }, decision.parts)
    }
}

/// The axis along which a node is split, and its halves.
fn halves(root: &Root, item: &Item) -> Option<(Axis, [Root; 2])> {
    let Kind::Split(axis) = item.kind else { return None };
    let (lower, upper) = root.cell.halves(axis)?;
    let inherited = discharged(root.inherited, &item.steps);
    Some((axis, [lower, upper].map(|cell| Root { cell, inherited, depth: root.depth + 1 })))
}
