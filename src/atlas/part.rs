//! Growing the tree of cells, from the whole box or from cells of it.

use super::decide::{decide, Decision};
use crate::design::AtlasDesign;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::AtlasCell;
use orthocert_checker::claim::AtlasClaim;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// The work was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interrupted;

/// A tree of cells that grows.
pub struct Growing<'a> {
    design: &'a AtlasDesign,
    claim: AtlasClaim,
    /// Cells decided, and the share of the box that they are, for progress.
    pub done: &'a mut dyn FnMut(usize, f64),
    /// Set to make the work end.
    pub cancel: &'a AtomicBool,
}

/// A grown tree, in preorder.
#[derive(Clone, Debug, PartialEq)]
pub enum Grown {
    /// A cell that is not split.
    Leaf(AtlasCell),
    /// A cell that is not decided yet, and not tried either.
    Waiting(Cell),
    /// A split along the axis of this number, from zero.
    Split(usize, Box<[Grown; 2]>),
}

impl<'a> Growing<'a> {
    /// The growth of a design's tree.
    pub fn new(
        design: &'a AtlasDesign,
        cancel: &'a AtomicBool,
        done: &'a mut dyn FnMut(usize, f64),
    ) -> Self {
        Growing { design, claim: design.claim(), done, cancel }
    }

    /// The axis on which a cell is split: the one that was halved least, the first of these; `None`
    /// at the finest resolution.
    fn axis(&self, cell: &Cell) -> Option<usize> {
        let levels = cell.edges.iter().map(|edge| edge.level).take(self.claim.parameters.len());
        let (level, axis) = levels.enumerate().map(|(axis, level)| (level, axis)).min()?;
        (level < self.design.resolution).then_some(axis)
    }
}

/// Grows the tree below `root` level by level, until nothing is open or, at the end of a level, at
/// least `enough` cells wait.
///
/// # Errors
/// If it was cancelled.
pub fn grow(
    growing: &mut Growing<'_>,
    root: Cell,
    enough: Option<usize>,
) -> Result<Grown, Interrupted> {
    // Positions in `nodes`: leaves, or splits with the positions of both halves.
    enum Node {
        Cell(Cell, Option<AtlasCell>),
        Split(usize, [usize; 2]),
    }
    let mut nodes = vec![Node::Cell(root, None)];
    let mut level = vec![(0, root)];
    let (mut decided, mut closed) = (0, 0.0);
    while !level.is_empty() && enough.is_none_or(|enough| level.len() < enough) {
        let (design, claim, cancel) = (growing.design, &growing.claim, growing.cancel);
        let mut next = Vec::new();
        for batch in level.chunks(64) {
            if cancel.load(Ordering::Relaxed) {
                return Err(Interrupted);
            }
            let decisions: Vec<Decision> =
                batch.par_iter().map(|(_, cell)| decide(design, claim, cell, cancel)).collect();
            for ((at, cell), decision) in batch.iter().zip(decisions) {
                let leaf = match (decision, growing.axis(cell)) {
                    (Decision::Cancelled, _) => return Err(Interrupted),
                    (Decision::Decided(leaf), _) => leaf,
                    (Decision::Open, None) => AtlasCell::Undecided,
                    (Decision::Open, Some(axis)) => {
                        let (lower, upper) = cell.halves(Axis::ALL[axis]).ok_or(Interrupted)?;
                        let first = nodes.len();
                        for (i, half) in [lower, upper].into_iter().enumerate() {
                            nodes.push(Node::Cell(half, None));
                            next.push((first + i, half));
                        }
                        nodes[*at] = Node::Split(axis, [first, first + 1]);
                        continue;
                    }
                };
                let depth: u32 = cell.edges.iter().map(|edge| edge.level).sum();
                decided += 1;
                closed += (-f64::from(depth)).exp2();
                nodes[*at] = Node::Cell(*cell, Some(leaf));
            }
            (growing.done)(decided, closed);
        }
        level = next;
    }
    fn grown(nodes: &mut [Node], at: usize) -> Grown {
        match std::mem::replace(&mut nodes[at], Node::Split(0, [0, 0])) {
            Node::Cell(_, Some(leaf)) => Grown::Leaf(leaf),
            Node::Cell(cell, None) => Grown::Waiting(cell),
            Node::Split(axis, [lower, upper]) => {
                Grown::Split(axis, Box::new([grown(nodes, lower), grown(nodes, upper)]))
            }
        }
    }
    Ok(grown(&mut nodes, 0))
}

/// The cells of a tree in preorder; what waits is given by `part`, in order.
pub fn assemble<E>(
    tree: &Grown,
    part: &mut dyn FnMut(&Cell) -> Result<Vec<AtlasCell>, E>,
) -> Result<Vec<AtlasCell>, E> {
    let mut cells = Vec::new();
    let mut waiting = vec![tree];
    while let Some(node) = waiting.pop() {
        match node {
            Grown::Leaf(leaf) => cells.push(leaf.clone()),
            Grown::Waiting(cell) => cells.extend(part(cell)?),
            Grown::Split(axis, halves) => {
                cells.push(AtlasCell::Split(axis + 1));
                waiting.extend([&halves[1], &halves[0]]);
            }
        }
    }
    Ok(cells)
}
