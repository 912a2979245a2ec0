//! The tree of a paving, for its shape alone: what is inner, outer and undecided.

use super::SurfaceError;
use orthocert_kernel::paving::{Axis, Cell, Cut, Header, Kind, Reader};
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most nodes that are split.
pub(super) const MOST_NODES: usize = 1 << 25;

/// A node of a [`Tree`].
pub type Node = u32;
/// The node of an outer cell.
pub const OUTER: Node = 0;
/// The node of an undecided cell.
pub const UNDECIDED: Node = 1;
/// The node of an inner cell.
pub const INNER: Node = 2;
/// How often a cell that is cut is halved, so that its inner part is seen; the unit of its half-widths
/// has as many halves.
const CUT_LEVELS: u32 = 6;
const CUT_UNIT: i64 = 1 << CUT_LEVELS;
/// The first node that is split.
const FIRST: Node = 3;

/// How much of a paving is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// All of its inner part; outer cells beside undecided ones count as undecided.
    InnerPart,
    /// The tree down to a depth: cells of that depth that are split count as undecided, unless all
    /// that they are split into is inner, or all is outer.
    Depth(u32),
}

/// A bisection tree whose leaves are inner, outer or undecided. No node has two halves that are the
/// same leaf.
#[derive(Clone, Debug)]
pub struct Tree {
    splits: Vec<(Axis, Node, Node)>,
    /// The whole box.
    pub root: Node,
}

impl Tree {
    fn new() -> Self {
        Tree { splits: Vec::new(), root: OUTER }
    }

    /// The axis and the halves of a node that is split.
    pub fn split(&self, node: Node) -> Option<(Axis, Node, Node)> {
        self.splits.get(node.checked_sub(FIRST)? as usize).copied()
    }

    /// The node with these halves.
    fn joined(
        &mut self,
        axis: Axis,
        lower: Node,
        upper: Node,
        detail: Detail,
    ) -> Result<Node, SurfaceError> {
        if lower == upper && lower < FIRST {
            return Ok(lower);
        }
        if detail == Detail::InnerPart && lower.max(upper) <= UNDECIDED {
            return Ok(UNDECIDED);
        }
        if self.splits.len() >= MOST_NODES {
            return Err(SurfaceError::TooFine);
        }
        self.splits.push((axis, lower, upper));
        Ok(FIRST + (self.splits.len() - 1) as Node) // At most MOST_NODES.
    }

    /// What a part of a cell that is cut is: inner before the first plane, outer beyond the second. It is
    /// halved so many times where they pass, along the axis that moves them most.
    fn of_cut(
        &mut self,
        cut: &Cut,
        part: [[i64; 2]; 3],
        levels: u32,
        detail: Detail,
    ) -> Result<Node, SurfaceError> {
        let terms = || cut.normal.iter().zip(&part);
        let least: i64 = terms().map(|(n, [lo, hi])| (n * lo).min(n * hi)).sum();
        let most: i64 = terms().map(|(n, [lo, hi])| (n * lo).max(n * hi)).sum();
        let [inner, outer] = cut.ends.map(|end| end * CUT_UNIT);
        if most <= inner {
            return Ok(INNER);
        }
        if least >= outer || levels == 0 {
            return Ok(if least >= outer { OUTER } else { UNDECIDED });
        }
        let moved = |axis: &Axis| {
            let [lo, hi] = part[axis.index()];
            cut.normal.get(axis.index()).map_or(0, |n| n.abs() * (hi - lo))
        };
        let axis = Axis::ALL.into_iter().max_by_key(moved).unwrap_or(Axis::X);
        let [lo, hi] = part[axis.index()];
        let mut halves = [part; 2];
        halves[0][axis.index()] = [lo, (lo + hi) / 2];
        halves[1][axis.index()] = [(lo + hi) / 2, hi];
        let [lower, upper] = halves.map(|half| self.of_cut(cut, half, levels - 1, detail));
        self.joined(axis, lower?, upper?, detail)
    }

    /// Reads a paving to its end. The shape of the tree and its summary are checked, the evidence is
    /// not. What is left out by symmetry counts as outer.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn read<R: Read>(
        mut reader: Reader<R>,
        detail: Detail,
        cancel: &AtomicBool,
    ) -> Result<(Header, Self), SurfaceError> {
        let mut tree = Tree::new();
        // Splits that wait for their halves: the axis, and the lower half once it is known.
        let mut waiting: Vec<(Axis, Option<Node>)> = Vec::new();
        while let Some(visited) = reader.next()? {
            if cancel.load(Ordering::Relaxed) {
                return Err(SurfaceError::Cancelled);
            }
            if visited.cell.is_part() {
                continue;
            }
            let mut done = match visited.item.kind {
                Kind::Split(axis) => {
                    waiting.push((axis, None));
                    continue;
                }
                Kind::Inner | Kind::Part(_) => INNER,
                Kind::Boundary => UNDECIDED,
                Kind::Cut(cut) => {
                    let levels = match detail {
                        Detail::InnerPart => CUT_LEVELS,
                        Detail::Depth(depth) => {
                            depth.saturating_sub(waiting.len() as u32).min(CUT_LEVELS)
                        }
                    };
                    tree.of_cut(&cut, [[-CUT_UNIT, CUT_UNIT]; 3], levels, detail)?
                }
                Kind::Outer(_) | Kind::At(..) | Kind::Outside | Kind::Mirrored => OUTER,
            };
            while let Some((axis, lower)) = waiting.pop() {
                let Some(lower) = lower else {
                    waiting.push((axis, Some(done)));
                    break;
                };
                // As many splits wait as are above the node.
                done = match detail {
                    Detail::Depth(depth) if waiting.len() >= depth as usize && lower != done => {
                        UNDECIDED
                    }
                    _ => tree.joined(axis, lower, done, detail)?,
                };
            }
            tree.root = done;
        }
        let header = reader.header().clone();
        reader.finish()?;
        if header.symmetry.is_some() {
            tree = tree.unfolded(detail, cancel)?;
        }
        Ok((header, tree))
    }

    /// Most splits on a path.
    pub fn depth(&self) -> u32 {
        let (mut deepest, mut waiting) = (0, vec![(self.root, 0)]);
        while let Some((node, depth)) = waiting.pop() {
            deepest = depth.max(deepest);
            if let Some((_, lower, upper)) = self.split(node) {
                waiting.extend([(lower, depth + 1), (upper, depth + 1)]);
            }
        }
        deepest
    }

    /// The tree down to a depth, as [`Detail::Depth`] has it.
    pub fn to_depth(&self, depth: u32) -> Self {
        let mut tree = Tree::new();
        tree.root = self.copied(self.root, depth, &mut tree);
        tree
    }

    /// Calls itself no deeper than `depth` or the tree, whose depth is at most 120.
    fn copied(&self, node: Node, depth: u32, to: &mut Tree) -> Node {
        let Some((axis, lower, upper)) = self.split(node) else {
            return node;
        };
        if depth == 0 {
            return UNDECIDED; // It is split: not all is inner, and not all outer.
        }
        let (lower, upper) = (self.copied(lower, depth - 1, to), self.copied(upper, depth - 1, to));
        if lower == upper && lower < FIRST {
            return lower;
        }
        to.splits.push((axis, lower, upper));
        FIRST + (to.splits.len() - 1) as Node // No more than there are here.
    }

    /// The tree of all images of what this one has with `u_x <= u_y <= u_z`.
    ///
    /// It is grown over *ordered* regions: any two edges are equal, or one lies wholly before the
    /// other, in the axes' order. Where a cell of this tree is larger than the region, the half that
    /// has the region is entered. Otherwise the axis of its split is halved, together with all that
    /// have the same edge: the parts are images of ordered ones by permutations of those axes.
    ///
    /// **Lemma.** A leaf that contains an ordered region makes all of it what the leaf is. *Proof.*
    /// Permuting axes with equal edges maps the region to itself, and takes each of its points to one
    /// with `u_x <= u_y <= u_z`, which is in the leaf. ∎
    fn unfolded(&self, detail: Detail, cancel: &AtomicBool) -> Result<Self, SurfaceError> {
        let mut unfolding = Unfolding { from: self, to: Tree::new(), detail, cancel };
        unfolding.to.root = unfolding.region(self.root, [0; 3], Cell::ROOT, Axis::ALL)?;
        Ok(unfolding.to)
    }
}

struct Unfolding<'a> {
    from: &'a Tree,
    to: Tree,
    detail: Detail,
    cancel: &'a AtomicBool,
}

impl Unfolding<'_> {
    /// An ordered region within the node `at`, whose cell has these `levels`. Its axes are the axes
    /// `to` of the image. Calls itself no deeper than the tree's depth, at most 120, times two.
    fn region(
        &mut self,
        mut at: Node,
        mut levels: [u32; 3],
        region: Cell,
        to: [Axis; 3],
    ) -> Result<Node, SurfaceError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(SurfaceError::Cancelled);
        }
        loop {
            let Some((axis, lower, upper)) = self.from.split(at) else {
                return Ok(at);
            };
            let edge = region.edges[axis.index()];
            let Some(finer) = edge.level().checked_sub(levels[axis.index()] + 1) else {
                let same = |k: &usize| region.edges[*k] == edge;
                let axes: Vec<usize> = (0..3).filter(same).collect();
                return self.parts(&axes, at, levels, region, to);
            };
            at = if edge.index() >> finer & 1 == 0 { lower } else { upper };
            levels[axis.index()] += 1;
        }
    }

    /// The halves of a region along axes whose edges were equal.
    fn parts(
        &mut self,
        axes: &[usize],
        at: Node,
        levels: [u32; 3],
        mut region: Cell,
        mut to: [Axis; 3],
    ) -> Result<Node, SurfaceError> {
        let Some((&k, rest)) = axes.split_first() else {
            for (a, b) in [(0, 1), (1, 2), (0, 1)] {
                let [lower, upper] = [region.edges[a], region.edges[b]];
                // Edges of different levels are of different axes of the region, and in order.
                if lower.level() == upper.level() && lower.index() > upper.index() {
                    region.edges.swap(a, b);
                    to.swap(a, b);
                }
            }
            return self.region(at, levels, region, to);
        };
        let halves = region.halves(Axis::ALL[k]);
        let (below, above) = halves.ok_or(SurfaceError::TooFine)?;
        let lower = self.parts(rest, at, levels, below, to)?;
        let upper = self.parts(rest, at, levels, above, to)?;
        self.to.joined(to[k], lower, upper, self.detail)
    }
}
