//! Cells: the boxes of a bisection tree, as exact dyadic parts of the box that is paved.
//!
//! The box is the image of `[0, 1]^m` under `u -> min + (max - min) u`, coordinate by coordinate,
//! `m <= 3`. A cell is `prod_k [index_k / 2^level_k, (index_k + 1) / 2^level_k]`: integers, so that two
//! halves cover their parent by construction, whatever the box's numbers are. Axes beyond the `m`
//! coordinates are whole in every cell. Of a paving of some coordinates for all values of the others, a
//! cell has parts, in which the others are halved in the same way.

use crate::fixed::{Fixed, Integer, Interval};
use crate::slope::MOST_COORDINATES;
use crate::{arithmetic::Arithmetic, arithmetic::Enclosure};

/// Deepest bisection of one axis: three of them are [`SHARE_BITS`](super::SHARE_BITS).
pub const MAX_AXIS_LEVEL: u32 = 40;
/// Most coordinates beside those that are paved.
pub const MOST_OTHERS: usize = MOST_COORDINATES - 1;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
    /// The third coordinate.
    Z,
}

impl Axis {
    /// In order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// Position in a vector, from zero.
    pub fn index(self) -> usize {
        self as usize
    }
}

/// One edge of a cell, `[index / 2^level, (index + 1) / 2^level]`, as the number `2^level + index`: its halves are
/// twice that, and one more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Edge(pub u64);

impl Edge {
    const WHOLE: Edge = Edge(1);

    /// How often the axis was halved.
    pub fn level(self) -> u32 {
        self.0.ilog2()
    }

    /// Number of equal parts before this one.
    pub fn index(self) -> u64 {
        self.0 ^ 1 << self.level()
    }

    /// The values `((2^level - j) min + j max)/2^level` for `j` from `from` to `to`, of ends that are
    /// enclosed.
    ///
    /// **Lemma.** They are in this range. *Proof.* They lie between those of both `j`, of which it
    /// encloses the least and the greatest: `j` and `2^level - j` are not negative. ∎
    pub(super) fn range<Z: Integer>(
        e: &Fixed<Z>,
        level: u32,
        [from, to]: [i64; 2],
        [min, max]: [&Interval<Z>; 2],
    ) -> Option<Interval<Z>> {
        let at = |j: i64| {
            let rest =
                1i64.checked_shl(level)?.checked_sub(j).filter(|rest| j >= 0 && *rest >= 0)?;
            e.add(&e.dyadic(rest, level, min)?, &e.dyadic(j, level, max)?)
        };
        Some(Interval { lo: at(from)?.lo, hi: at(to)?.hi })
    }

    /// Its parts before it, and those before its end.
    pub(super) fn ends(self) -> [i64; 2] {
        let before = self.index() as i64;
        [before, before + 1]
    }
}

/// A box of the bisection tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// The edges along x, y and z: of the coordinates that are paved.
    pub edges: [Edge; 3],
    /// The edges of the other coordinates.
    pub others: [Edge; MOST_OTHERS],
}

impl Cell {
    /// The whole box.
    pub const ROOT: Cell = Cell { edges: [Edge::WHOLE; 3], others: [Edge::WHOLE; MOST_OTHERS] };

    /// The lower and the upper half along `axis`; `None` beyond [`MAX_AXIS_LEVEL`].
    ///
    /// `[i, i+1] / 2^l = [2i, 2i+1] / 2^(l+1) u [2i+1, 2i+2] / 2^(l+1)`.
    pub fn halves(&self, axis: Axis) -> Option<(Cell, Cell)> {
        self.halved(|cell| Some(&mut cell.edges[axis.index()]))
    }

    /// The same along another coordinate.
    pub fn parts(&self, other: usize) -> Option<(Cell, Cell)> {
        self.halved(|cell| cell.others.get_mut(other))
    }

    fn halved(&self, edge: impl Fn(&mut Cell) -> Option<&mut Edge>) -> Option<(Cell, Cell)> {
        let (mut lower, mut upper) = (*self, *self);
        let (low, high) = (edge(&mut lower)?, edge(&mut upper)?);
        (low.0, high.0) = (2 * low.0, 2 * low.0 + 1);
        (low.level() <= MAX_AXIS_LEVEL).then_some((lower, upper))
    }

    /// Whether it is part of a cell: some other coordinate is halved.
    pub fn is_part(&self) -> bool {
        self.others != Cell::ROOT.others
    }

    /// The splits above it.
    pub fn depth(&self) -> u32 {
        self.edges.iter().map(|edge| edge.level()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(index: u64, level: u32) -> Edge {
        let edge = Edge(index + (1 << level));
        assert_eq!((edge.index(), edge.level()), (index, level));
        edge
    }

    #[test]
    fn halves_share_the_midpoint_and_the_outer_ends() {
        let (_, upper) = Cell::ROOT.halves(Axis::Y).unwrap();
        let (lower, upper) = upper.halves(Axis::Y).unwrap();
        // [1/2, 1] splits into [2/4, 3/4] and [3/4, 4/4].
        assert_eq!(lower.edges[1], edge(2, 2));
        assert_eq!(upper.edges[1], edge(3, 2));
        assert_eq!(upper.edges[0], Cell::ROOT.edges[0]);
        let mut cell = upper;
        while let Some((_, next)) = cell.halves(Axis::Z) {
            cell = next;
        }
        assert_eq!(cell.depth(), 2 + MAX_AXIS_LEVEL);
    }

    #[test]
    fn edges_of_others_are_told_apart_down_to_the_last_level() {
        let mut cell = Cell::ROOT;
        let mut expected = Edge::WHOLE;
        while let Some((lower, upper)) = cell.parts(4) {
            assert_ne!(lower.others, upper.others);
            assert!(lower.is_part() && upper.is_part());
            let index = 2 * expected.index();
            let halves = [0, 1].map(|part| edge(index + part, expected.level() + 1));
            assert_eq!([lower.others[4], upper.others[4]], halves);
            (cell, expected) = (upper, halves[1]);
        }
        assert_eq!(expected.level(), MAX_AXIS_LEVEL);
        assert_eq!(cell.parts(MOST_OTHERS), None);
        assert_eq!(Cell { others: Cell::ROOT.others, ..cell }, Cell::ROOT);
    }

    #[test]
    fn ranges_hold_the_cells_points_whatever_is_rounded() {
        let e = Fixed::<i64>::new(32);
        // Enclosures of -1/3 and 10/7.
        let unit = 1i64 << 32;
        let around = |n: i64, d: i64| Interval {
            lo: (n * unit).div_euclid(d),
            hi: (n * unit).div_euclid(d) + 1,
        };
        for level in [0, 1, 5, 20, MAX_AXIS_LEVEL] {
            let parts = 1u64 << level;
            for index in [0, parts / 3, parts / 2, parts - 1] {
                let ends = edge(index, level).ends();
                let range = Edge::range(&e, level, ends, [&around(-1, 3), &around(10, 7)]).unwrap();
                // 21 2^level (min + (max - min) j/2^level) = -7 2^level + 37 j.
                let end = |j: u64| (37 * j as i128 - 7 * parts as i128) * i128::from(unit);
                let scaled = |x: i64| 21 * parts as i128 * i128::from(x);
                assert!(scaled(range.lo) <= end(index) && end(index + 1) <= scaled(range.hi));
                assert!(scaled(range.hi - range.lo - 8) <= end(index + 1) - end(index));
            }
        }
    }
}
