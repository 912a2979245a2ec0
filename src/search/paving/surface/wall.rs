//! Walls: rectangles with the inner part on one side alone.

use super::tree::{Node, Tree, INNER, OUTER, UNDECIDED};
use super::{Beyond, SurfaceError};
use orthocert_kernel::paving::MAX_AXIS_LEVEL;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most walls.
pub(super) const MOST_WALLS: usize = 1 << 24;
/// The box's edges, in the unit of coordinates.
pub const EDGE: u64 = 1 << MAX_AXIS_LEVEL;
/// The node of what is outside the box.
const OUTSIDE: Node = Node::MAX;

/// A rectangle of the surface. Coordinates are parts of the box's edges, in units of
/// `1/`[`EDGE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Wall {
    /// The axis that it is orthogonal to.
    pub axis: u8,
    /// Its coordinate on that axis.
    pub plane: u64,
    /// Whether the inner part is below.
    pub upward: bool,
    /// What is on the other side.
    pub beyond: Beyond,
    /// Its ends along the next axis, and along the one after that, cyclically.
    pub sides: [[u64; 2]; 2],
}

/// A cell, by its ends.
#[derive(Clone, Copy)]
struct Block {
    ends: [[u64; 2]; 3],
}

impl Block {
    const ROOT: Block = Block { ends: [[0, EDGE]; 3] };

    fn halves(self, axis: usize) -> [Block; 2] {
        let [low, high] = self.ends[axis];
        // A cell's edge has at most MAX_AXIS_LEVEL levels above it: what is split has an even one.
        let middle = low + (high - low) / 2;
        [[low, middle], [middle, high]].map(|ends| {
            let mut half = self;
            half.ends[axis] = ends;
            half
        })
    }
}

/// The walls of a tree, in order; two that have a side in common are joined where they are alike.
///
/// # Errors
/// [`SurfaceError::TooFine`] and [`SurfaceError::Cancelled`].
pub fn walls(tree: &Tree, cancel: &AtomicBool) -> Result<Vec<Wall>, SurfaceError> {
    let mut walls = Vec::new();
    let whole = (tree.root, Block::ROOT);
    let outside = (OUTSIDE, Block::ROOT);
    for axis in 0..3 {
        across(tree, axis, whole, outside, &mut walls)?;
        across(tree, axis, outside, whole, &mut walls)?;
    }
    let mut waiting = vec![whole];
    while let Some((node, block)) = waiting.pop() {
        if cancel.load(Ordering::Relaxed) {
            return Err(SurfaceError::Cancelled);
        }
        if let Some((axis, lower, upper)) = tree.split(node) {
            let [below, above] = block.halves(axis.index());
            let (lower, upper) = ((lower, below), (upper, above));
            waiting.extend([upper, lower]);
            across(tree, axis.index(), lower, upper, &mut walls)?;
        }
    }
    for side in [0, 1, 0] {
        join(&mut walls, side);
    }
    walls.sort_unstable();
    Ok(walls)
}

/// The walls on a plane orthogonal to `axis`, with `low` next to it from below and `high` from above.
/// A cell is split no further than its neighbour needs.
fn across(
    tree: &Tree,
    axis: usize,
    low: (Node, Block),
    high: (Node, Block),
    walls: &mut Vec<Wall>,
) -> Result<(), SurfaceError> {
    let mut waiting = vec![(low, high)];
    while let Some((low, high)) = waiting.pop() {
        let sides = [1, 2].map(|next| {
            let k = (axis + next) % 3;
            let ([a, b], [c, d]) = (low.1.ends[k], high.1.ends[k]);
            [a.max(c), b.min(d)]
        });
        if sides.iter().any(|[from, to]| from >= to) {
            continue;
        }
        if let Some((along, lower, upper)) = tree.split(low.0) {
            let [below, above] = low.1.halves(along.index());
            waiting.push(((upper, above), high));
            if along.index() != axis {
                waiting.push(((lower, below), high));
            }
        } else if let Some((along, lower, upper)) = tree.split(high.0) {
            let [below, above] = high.1.halves(along.index());
            waiting.push((low, (lower, below)));
            if along.index() != axis {
                waiting.push((low, (upper, above)));
            }
        } else if (low.0 == INNER) != (high.0 == INNER) {
            if walls.len() >= MOST_WALLS {
                return Err(SurfaceError::TooFine);
            }
            let upward = low.0 == INNER;
            let beyond = match if upward { high.0 } else { low.0 } {
                OUTER => Beyond::Outer,
                UNDECIDED => Beyond::Undecided,
                _ => Beyond::OutsideBox,
            };
            // Of the box and what is outside, the end that is looked at is the box's.
            let plane = if low.0 == OUTSIDE { high.1.ends[axis][0] } else { low.1.ends[axis][1] };
            walls.push(Wall { axis: axis as u8, plane, upward, beyond, sides });
        }
    }
    Ok(())
}

/// Joins walls that have the same ends on one of their axes and meet on the other, `side`.
fn join(walls: &mut Vec<Wall>, side: usize) {
    walls.sort_unstable_by_key(|wall| {
        let Wall { axis, plane, upward, beyond, sides } = *wall;
        (axis, plane, upward, beyond, sides[1 - side], sides[side])
    });
    let alike = |wall: &Wall| Wall { sides: [wall.sides[1 - side]; 2], ..*wall };
    walls.dedup_by(|next, wall| {
        let joined = alike(next) == alike(wall) && wall.sides[side][1] == next.sides[side][0];
        if joined {
            wall.sides[side][1] = next.sides[side][1];
        }
        joined
    });
}
