//! The tree of a paving: written depth first, cut into subtrees for the threads.

use super::decide::{Decider, Fate, Margins};
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

/// Of so many depths, cells of one are looked at by themselves; what is next of the others is foreseen from these.
pub(super) const FORESEEN: u32 = 3;

/// A node that waits, and what is foreseen of it.
pub(super) type Open = (Root, Option<Margins>);

/// The same to be decided.
type Node<'a> = (&'a Root, Option<&'a Margins>);

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
        let mut waiting = vec![(root, None)];
        while let Some((root, foreseen)) = waiting.pop() {
            // A box for all values of other coordinates may take a second.
            let is_asked = tally.boxes.is_multiple_of(256) || self.decider.is_for_all();
            if is_asked && self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            self.node((&root, foreseen.as_ref()), out, tally, &mut waiting);
        }
        Ok(())
    }

    /// The bytes of segments, which are grown side by side, and the cells tried for each; cancelled, of
    /// those before the first that is not whole.
    pub fn grow_all(&self, segments: &[Segment]) -> (Vec<Grown>, Result<(), Cancelled>) {
        let grown = |segment: &Segment| match segment {
            Segment::Known(bytes) => Ok((bytes.clone(), 0)),
            Segment::Subtree(root) => {
                let mut bytes = Vec::new();
                let mut tally = Tally::default();
                self.grow(*root, &mut bytes, &mut tally)?;
                Ok((bytes, tally.boxes))
            }
        };
        let all: Vec<Result<Grown, Cancelled>> =
            segments.par_iter().with_max_len(1).map(grown).collect();
        let count = all.len();
        let whole: Vec<Grown> = all.into_iter().map_while(Result::ok).collect();
        let ended = if whole.len() == count { Ok(()) } else { Err(Cancelled) };
        (whole, ended)
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
        let mut waiting = vec![(root, None)];
        while let Some((root, foreseen)) = waiting.pop() {
            if self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            if root.depth == coarse && self.depth > coarse {
                if !known.is_empty() {
                    segments.push(Segment::Known(std::mem::take(&mut known)));
                }
                segments.push(Segment::Subtree(root));
            } else {
                self.node((&root, foreseen.as_ref()), &mut known, tally, &mut waiting);
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
        roots: &[Open],
        tally: &mut Tally,
    ) -> Result<Vec<(Root, [Open; 2])>, Cancelled> {
        let of_root = |(root, foreseen): &Open| {
            if self.cancel.load(Ordering::Relaxed) {
                return Err(Cancelled);
            }
            let mut own = Tally::default();
            let (item, _, margins) = self.decided((root, foreseen.as_ref()), &mut own);
            let split = halves(root, &item).map(|(axis, [lower, upper])| {
                let [of_lower, of_upper] = self.foreseen(root.depth + 1, axis, margins);
                (*root, [(lower, of_lower), (upper, of_upper)])
            });
            Ok((own, split))
        };
        let all: Vec<_> = roots.par_iter().map(of_root).collect::<Result<_, _>>()?;
        tally.boxes += all.len() as u64;
        tally.inner += all.iter().map(|(own, _)| own.inner).sum::<u128>();
        Ok(all.into_iter().filter_map(|(_, split)| split).collect())
    }

    /// Decides a node and appends it; its halves, if it is split, wait. Halves that may not be split
    /// are appended with it, in one byte where that does for them.
    fn node(&self, root: Node<'_>, out: &mut Vec<u8>, tally: &mut Tally, waiting: &mut Vec<Open>) {
        let (item, parts, margins) = self.decided(root, tally);
        let (root, _) = root;
        let Some((axis, [lower, upper])) = halves(root, &item) else {
            // Every step and failure that a decision makes has a code.
            let written = [&item].into_iter().chain(&parts).try_for_each(|item| item.write(out));
            debug_assert!(written.is_some());
            return;
        };
        let [of_lower, of_upper] = self.foreseen(root.depth + 1, axis, margins);
        if root.depth + 1 < self.depth {
            let written = item.write(out);
            debug_assert!(written.is_some());
            waiting.extend([(upper, of_upper), (lower, of_lower)]);
            return;
        }
        let (lower, of_lower, _) = self.decided((&lower, of_lower.as_ref()), tally);
        let (upper, of_upper, _) = self.decided((&upper, of_upper.as_ref()), tally);
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

    /// The margins that are foreseen of a node's halves, of the depth `depth`.
    fn foreseen(&self, depth: u32, axis: Axis, margins: Option<Margins>) -> [Option<Margins>; 2] {
        let Some(margins) = margins.filter(|_| !self.is_seen(depth)) else { return [None, None] };
        let (mut lower, mut upper) = (margins.clone(), margins);
        for ((_, lower), (_, upper)) in lower.iter_mut().zip(upper.iter_mut()) {
            [*lower, *upper] = lower.halves(axis.index());
        }
        [Some(lower), Some(upper)]
    }

    /// Whether nothing is foreseen of cells of a depth: subtrees from there are what they are whoever grows them.
    fn is_seen(&self, depth: u32) -> bool {
        (self.depth - depth) % FORESEEN == FORESEEN - 1
    }

    /// The greatest depth up to `most` of which nothing is foreseen; 0 if there is none.
    pub fn seen(&self, most: u32) -> u32 {
        let most = most.min(self.depth);
        (0..=most).rev().find(|&depth| self.is_seen(depth)).unwrap_or(0)
    }

    /// A node, the nodes of its parts, and the margins that it rests on.
    fn decided(
        &self,
        (root, foreseen): Node<'_>,
        tally: &mut Tally,
    ) -> (Item, Vec<Item>, Option<Margins>) {
        let decision = self.decider.decide(&root.cell, root.inherited, foreseen);
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
        (Item { steps, kind }, decision.parts, decision.margins)
    }
}

/// The axis along which a node is split, and its halves.
fn halves(root: &Root, item: &Item) -> Option<(Axis, [Root; 2])> {
    let Kind::Split(axis) = item.kind else { return None };
    let (lower, upper) = root.cell.halves(axis)?;
    let inherited = discharged(root.inherited, &item.steps);
    let below = |cell| Root { cell, inherited, depth: root.depth + 1 };
    Some((axis, [below(lower), below(upper)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::search::paving::header;
    use orthocert_kernel::paving::Subject;

    /// The cells tried for a claim, the share of inner ones, and what its subtrees at a depth of which nothing is foreseen
    /// are when they are grown by themselves.
    fn grown(text: &str, depth: u32, at: Option<u32>) -> (Vec<u8>, Tally) {
        let claim = Design::parse(text, "test").unwrap().claim;
        let subject = Subject::new(&header(&claim, None, depth)).unwrap();
        let decider = Decider::new(&subject).unwrap();
        let cancel = AtomicBool::new(false);
        let grower = Grower { decider: &decider, depth, cancel: &cancel };
        let (mut bytes, mut tally) = (Vec::new(), Tally::default());
        let Some(at) = at else {
            grower.grow(Root::WHOLE, &mut bytes, &mut tally).unwrap();
            return (bytes, tally);
        };
        let segments = grower.segments(Root::WHOLE, grower.seen(at), &mut tally).unwrap();
        for (own, boxes) in grower.grow_all(&segments).0 {
            bytes.extend(own);
            tally.boxes += boxes;
        }
        (bytes, tally)
    }

    #[test]
    fn what_is_foreseen_is_the_same_from_wherever_subtrees_are_grown() {
        let text = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
                    min = [-0.7, -0.6, -0.5]\nmax = [0.6, 0.7, 0.4]\n[requirements]\n\
                    transmission = { min = \"1/2\", max = 2 }\nserial_margin = { min = 0.1 }\n";
        for depth in [13, 14, 15] {
            let (whole, tally) = grown(text, depth, None);
            for at in [4, 7, 9] {
                let (parts, sum) = grown(text, depth, Some(at));
                assert_eq!(parts, whole, "{depth}, {at}");
                assert_eq!(sum.boxes, tally.boxes);
            }
        }
    }
}
