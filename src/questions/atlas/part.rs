//! Growing the tree of cells, from the whole box or from cells of it.

use super::decide::{decide, Decision};
use super::kept::{Kept, KeptError};
use crate::design::AtlasDesign;
use crate::search::{is_over, Control, Progress};
use orthocert_checker::certificate::MOST_BYTES;
use orthocert_kernel::atlas::{halves, Part};
use orthocert_kernel::certificate::AtlasCell;
use orthocert_kernel::claim::AtlasClaim;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Why a tree was not grown.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The time was up.
    #[error("the time was up")]
    Time,
    /// What was decided could not be kept.
    #[error("{0}")]
    Unkept(String),
    /// Its cells would not fit into a certificate.
    #[error(
        "the map has more cells or longer proofs than a certificate holds ({MOST_BYTES} bytes); \
         accepted: a lower atlas.resolution"
    )]
    TooLarge,
}

/// Bytes of the certificate that are taken.
#[derive(Default)]
struct Room(usize);

/// Bytes kept for what is not cells.
const REST: usize = 1 << 16;

impl Room {
    /// Takes the room of a cell, if there is.
    fn take(&mut self, cell: &AtlasCell) -> Result<(), Stopped> {
        self.0 += serde_json::to_string(cell).map_or(MOST_BYTES, |text| text.len() + 1);
        (self.0 + REST <= MOST_BYTES).then_some(()).ok_or(Stopped::TooLarge)
    }
}

/// A tree of cells that grows.
pub struct Growing<'a, 'c> {
    design: &'a AtlasDesign,
    claim: AtlasClaim,
    control: &'a mut Control<'c>,
    kept: Option<&'a mut Kept>,
    deadline: Option<Instant>,
}

/// A node of a tree of cells that may not be grown to its end, in preorder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Top {
    /// As in an atlas.
    Cell(AtlasCell),
    /// A cell that was not tried yet.
    Waiting,
}

impl<'a, 'c> Growing<'a, 'c> {
    /// The growth of a design's tree.
    pub fn new(design: &'a AtlasDesign, control: &'a mut Control<'c>) -> Self {
        Growing { design, claim: design.claim(), control, kept: None, deadline: None }
    }

    /// The same until a deadline, from what is kept, which grows with it.
    pub fn keeping(self, kept: &'a mut Kept, deadline: Option<Instant>) -> Self {
        Growing { kept: Some(kept), deadline, ..self }
    }
}

/// The axis of a cell that was halved least, the first of these, if less than `finest` times.
pub(super) fn least_halved(part: &[(u64, u32)], finest: u32) -> Option<usize> {
    let (level, axis) = part.iter().enumerate().map(|(axis, (_, level))| (*level, axis)).min()?;
    (level < finest).then_some(axis)
}

/// The halvings above a cell.
pub(super) fn depth(part: &[(u64, u32)]) -> u32 {
    part.iter().map(|(_, level)| level).sum()
}

/// The share of cells that a border has halved, in two dimensions, and the cells after which as much is
/// seen of a level itself.
const BORDER: f64 = 0.7;
const SEEN: f64 = 16.0;

/// What is done of a tree of cells.
#[derive(Default)]
struct Done {
    cells: usize,
    share: f64,
    /// Of the level that is under way: its cells, those tried, those open, and the levels below it.
    level: [usize; 3],
    below: u32,
}

impl Done {
    /// With one more cell: each level is expected to grow as this one does, down to the last, and before
    /// much is seen of it, as a border does.
    fn with(&mut self, open: bool) -> Progress {
        let [all, tried, halved] = &mut self.level;
        (*tried, *halved) = (*tried + 1, *halved + usize::from(open));
        self.cells += 1;
        let growth = 2.0 * (*halved as f64 + SEEN * BORDER) / (*tried as f64 + SEEN);
        let deeper: f64 = (1..=self.below).map(|level| growth.powf(f64::from(level))).sum();
        let left = (*all - *tried) as f64 + *all as f64 * deeper;
        self.share = self.share.max(self.cells as f64 / (self.cells as f64 + left));
        Progress { boxes: self.cells, share: self.share }
    }
}

/// Grows the tree below `root` level by level, until nothing is open or, at the end of a level, at
/// least `enough` cells wait.
///
/// # Errors
/// If it was cancelled, or is too large for a certificate.
pub fn grow(
    growing: &mut Growing<'_, '_>,
    root: Part,
    enough: Option<usize>,
) -> Result<Vec<Top>, Stopped> {
    let mut room = Room::default();
    let mut nodes = vec![Node::Waiting];
    let (design, claim, cancel) = (growing.design, &growing.claim, growing.control.cancel);
    let finest = design.resolution * root.len() as u32;
    let mut level = vec![(0, root)];
    let deadline = growing.deadline;
    let done = Mutex::new((Done::default(), &mut *growing.control.progress, &mut growing.kept));
    let lock = || done.lock().unwrap_or_else(PoisonError::into_inner);
    let is_over = || is_over(deadline);
    let unkept = |error: KeptError| Stopped::Unkept(error.to_string());
    while !level.is_empty() && enough.is_none_or(|enough| level.len() < enough) {
        let mut next = Vec::new();
        {
            let (done, ..) = &mut *lock();
            done.level = [level.len(), 0, 0];
            done.below = level.iter().map(|(_, cell)| finest - depth(cell)).max().unwrap_or(0);
        }
        for batch in level.chunks(64) {
            let decided = |(_, cell): &(usize, Part)| {
                let known = lock().2.as_ref().and_then(|kept| kept.known(cell).cloned());
                let decision = match known {
                    Some(ref decision) => decision.clone(),
                    None if cancel.load(Ordering::Relaxed) => Decision::Cancelled,
                    None if is_over() => return Err(Stopped::Time),
                    None => decide(design, claim, cell, cancel),
                };
                let (now, tell, kept) = &mut *lock();
                if let (Some(kept), None) = (kept, known) {
                    kept.keep(cell, &decision).map_err(unkept)?;
                }
                tell(now.with(decision == Decision::Open && depth(cell) < finest));
                Ok(decision)
            };
            let decisions: Vec<Result<Decision, Stopped>> = batch.par_iter().map(decided).collect();
            for ((at, cell), decision) in batch.iter().zip(decisions) {
                let leaf = match (decision?, least_halved(cell, design.resolution)) {
                    (Decision::Cancelled, _) => return Err(Stopped::Cancelled),
                    (Decision::Decided(leaf), _) => leaf,
                    (Decision::Open, None) => AtlasCell::Undecided,
                    (Decision::Open, Some(axis)) => {
                        let [lower, upper] = halves(cell, axis).ok_or(Stopped::TooLarge)?;
                        let first = nodes.len();
                        nodes.extend([Node::Waiting, Node::Waiting]);
                        next.extend([(first, lower), (first + 1, upper)]);
                        nodes[*at] = Node::Split(axis, [first, first + 1]);
                        room.take(&AtlasCell::Split(axis))?;
                        continue;
                    }
                };
                room.take(&leaf)?;
                nodes[*at] = Node::Leaf(leaf);
            }
        }
        level = next;
    }
    Ok(in_order(nodes))
}

/// A node of the growing tree.
pub(super) enum Node {
    /// It was not tried yet.
    Waiting,
    /// It is decided, or not to be split.
    Leaf(AtlasCell),
    /// The axis, and the positions of both halves.
    Split(usize, [usize; 2]),
}

/// The nodes of a tree whose root is the first, in preorder.
pub(super) fn in_order(mut nodes: Vec<Node>) -> Vec<Top> {
    let mut top = Vec::with_capacity(nodes.len());
    let mut waiting = vec![0];
    while let Some(at) = waiting.pop() {
        match nodes[at].take() {
            Node::Waiting => top.push(Top::Waiting),
            Node::Leaf(leaf) => top.push(Top::Cell(leaf)),
            Node::Split(axis, [lower, upper]) => {
                top.push(Top::Cell(AtlasCell::Split(axis)));
                waiting.extend([upper, lower]);
            }
        }
    }
    top
}

impl Node {
    fn take(&mut self) -> Node {
        std::mem::replace(self, Node::Waiting)
    }
}

/// The cells that wait in a tree below a cell, in order; `None` if it is not a tree.
pub fn waiting(top: &[Top], root: Part) -> Option<Vec<Part>> {
    let mut found = Vec::new();
    let mut below = vec![root];
    for node in top {
        let part = below.pop()?;
        match node {
            Top::Waiting => found.push(part),
            Top::Cell(AtlasCell::Split(axis)) => {
                let [lower, upper] = halves(&part, *axis)?;
                below.extend([upper, lower]);
            }
            Top::Cell(_) => {}
        }
    }
    below.is_empty().then_some(found)
}

/// The cells of a tree in preorder, with these parts, in order, in the places of the cells that
/// wait; `None` if there are more or fewer of them.
pub fn assemble(top: Vec<Top>, parts: Vec<Vec<AtlasCell>>) -> Option<Vec<AtlasCell>> {
    let mut cells = Vec::new();
    let mut parts = parts.into_iter();
    for node in top {
        match node {
            Top::Cell(cell) => cells.push(cell),
            Top::Waiting => cells.extend(parts.next()?),
        }
    }
    parts.next().is_none().then_some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orthocert_kernel::certificate::{Node as Box, Tree};

    #[test]
    fn there_is_room_for_what_a_certificate_holds() {
        let small = AtlasCell::Undecided;
        assert_eq!(Room::default().take(&small), Ok(()));
        assert_eq!(Room(MOST_BYTES - REST).take(&small), Err(Stopped::TooLarge));
        let tree =
            Tree { precision: 64, chords: None, nodes: vec![Box::default(); MOST_BYTES / 2] };
        let large = Room::default().take(&AtlasCell::Certified(tree));
        assert_eq!(large, Err(Stopped::TooLarge));
    }
}
