//! The tree of a paving: written depth first, cut into subtrees for the threads.

use super::decide::{Decider, Fate};
use orthocert_kernel::paving::{discharged, Item, Kind, Root};
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
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Cells tried.
    pub boxes: u64,
    /// Shares that became inner at each depth, in units of `2^-SHARE_BITS`.
    pub inner_at: Vec<u128>,
    /// Shares that are undecided at each depth.
    pub open_at: Vec<u128>,
    /// Cells tried at each depth.
    pub boxes_at: Vec<u64>,
    /// Cells for which planes are looked for at each depth.
    pub cuts_at: Vec<u64>,
    /// Shares of undecided cells at each depth that would be inner if these were cut.
    pub cut_at: Vec<u128>,
    /// Shares of them that would still be undecided.
    pub left_at: Vec<u128>,
}

impl Tally {
    /// Room for depths up to `depth`.
    pub fn up_to(depth: u32) -> Self {
        let length = depth as usize + 1;
        Tally {
            boxes: 0,
            inner_at: vec![0; length],
            open_at: vec![0; length],
            boxes_at: vec![0; length],
            cuts_at: vec![0; length],
            cut_at: vec![0; length],
            left_at: vec![0; length],
        }
    }

    /// Adds another tally.
    pub fn add(&mut self, other: &Tally) {
        self.boxes += other.boxes;
        let sum = |to: &mut Vec<u128>, from: &Vec<u128>| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        };
        sum(&mut self.inner_at, &other.inner_at);
        sum(&mut self.open_at, &other.open_at);
        sum(&mut self.cut_at, &other.cut_at);
        sum(&mut self.left_at, &other.left_at);
        self.boxes_at.iter_mut().zip(&other.boxes_at).for_each(|(to, from)| *to += from);
        self.cuts_at.iter_mut().zip(&other.cuts_at).for_each(|(to, from)| *to += from);
    }
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
    /// Whether cells that may be split are cut also, to see at which depth that would do.
    pub is_plan: bool,
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
                let mut tally = Tally::up_to(self.depth);
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

    /// Decides a node and appends it; its halves, if it is split, wait. Halves that may not be split
    /// are appended with it, in one byte where that does for them.
    fn node(&self, root: &Root, out: &mut Vec<u8>, tally: &mut Tally, waiting: &mut Vec<Root>) {
        let (item, parts) = self.decided(root, tally);
        let halves = match item.kind {
            Kind::Split(axis) => root.cell.halves(axis).map(|halves| (axis, halves)),
            _ => None,
        };
        let Some((axis, (lower, upper))) = halves else {
            // Every step and failure that a decision makes has a code.
            let written = [&item].into_iter().chain(&parts).try_for_each(|item| item.write(out));
            debug_assert!(written.is_some());
            return;
        };
        let inherited = discharged(root.inherited, &item.steps);
        let half = |cell| Root { cell, inherited, depth: root.depth + 1 };
        if root.depth + 1 < self.depth {
            let written = item.write(out);
            debug_assert!(written.is_some());
            waiting.push(half(upper));
            waiting.push(half(lower));
            return;
        }
        let (lower, of_lower) = self.decided(&half(lower), tally);
        let (upper, of_upper) = self.decided(&half(upper), tally);
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
        let at = root.depth as usize;
        tally.boxes += 1;
        tally.boxes_at[at] += 1;
        let mut kind = match decision.fate {
            Fate::Closed(kind) => kind,
            Fate::Open(Some(axis)) if root.depth < self.depth => Kind::Split(axis),
            Fate::Open(_) => Kind::Boundary,
        };
        let share = || self.decider.share(&root.cell);
        match kind {
            Kind::Inner | Kind::Part(_) => tally.inner_at[at] += share(),
            Kind::Split(_) | Kind::Boundary => {
                let whole = share();
                tally.open_at[at] += whole;
                let may_be_cut = self.decider.cuts() && (self.is_plan || kind == Kind::Boundary);
                tally.cuts_at[at] += u64::from(may_be_cut);
                let cut =
                    may_be_cut.then(|| self.decider.cut(&root.cell, root.inherited)).flatten();
                let [inner, outer] = cut.as_ref().map_or([0, 0], |cut| cut.shares(whole));
                tally.cut_at[at] += inner;
                tally.left_at[at] += whole - inner - outer;
                if let Some(cut) = cut.filter(|_| kind == Kind::Boundary) {
                    kind = Kind::Cut(cut);
                }
            }
            Kind::Outer(_) | Kind::At(..) | Kind::Outside | Kind::Mirrored | Kind::Cut(_) => {}
        }
        let steps = if is_left(&kind) { Vec::new() } else { decision.steps };
        (Item { steps, kind }, decision.parts)
    }
}
