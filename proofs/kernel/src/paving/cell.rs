//! Cells: the boxes of a bisection tree, as exact dyadic parts of the box that is paved.
//!
//! The box is the image of `[0, 1]^m` under `u -> min + (max - min) u`, coordinate by coordinate,
//! `m <= 3`. A cell is `prod_k [index_k / 2^level_k, (index_k + 1) / 2^level_k]`: integers, so that two
//! halves cover their parent by construction, whatever the box's numbers are. Axes beyond the `m`
//! coordinates are whole in every cell.

use crate::fixed::{Fixed, Integer, Interval};
use crate::{arithmetic::Arithmetic, arithmetic::Enclosure};
use std::fmt;

/// Deepest bisection of one axis: three of them are [`SHARE_BITS`](super::SHARE_BITS).
pub const MAX_AXIS_LEVEL: u32 = 40;

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

/// One edge of a cell: `[index / 2^level, (index + 1) / 2^level]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Edge {
    /// Number of equal parts before this one.
    pub index: u128,
    /// How often the axis was halved.
    pub level: u32,
}

/// A box of the bisection tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// The edges along x, y and z.
    pub edges: [Edge; 3],
}

impl Cell {
    /// The whole box.
    pub const ROOT: Cell = Cell { edges: [Edge { index: 0, level: 0 }; 3] };

    /// The lower and the upper half along `axis`; `None` beyond [`MAX_AXIS_LEVEL`].
    ///
    /// `[i, i+1] / 2^l = [2i, 2i+1] / 2^(l+1) u [2i+1, 2i+2] / 2^(l+1)`.
    pub fn halves(&self, axis: Axis) -> Option<(Cell, Cell)> {
        let k = axis.index();
        let Edge { index, level } = self.edges[k];
        if level >= MAX_AXIS_LEVEL {
            return None;
        }
        let half = |index| {
            let mut cell = *self;
            cell.edges[k] = Edge { index, level: level + 1 };
            cell
        };
        Some((half(2 * index), half(2 * index + 1)))
    }

    /// The splits above it.
    pub fn depth(&self) -> u32 {
        self.edges.iter().map(|edge| edge.level).sum()
    }

    /// For each coordinate of a box whose corners are enclosed, the cell's expansion point, range and
    /// half-width, as of [`crate::cell::Cell::edges`].
    ///
    /// **Lemma.** The cell's points are in the ranges. *Proof.* They lie between those with the
    /// coordinates `((2^l - j) min + j max)/2^l` for `j = i` and `j = i + 1`, of which this encloses
    /// both: `j` and `2^l - j` are not negative. ∎
    pub(super) fn within<Z: Integer>(
        &self,
        e: &Fixed<Z>,
        corners: &[Vec<Interval<Z>>; 2],
    ) -> Option<Vec<[Interval<Z>; 3]>> {
        let range = |((edge, min), max): ((&Edge, &Interval<Z>), &Interval<Z>)| {
            let (parts, index) = (1i64.checked_shl(edge.level)?, i64::try_from(edge.index).ok()?);
            let at = |j: i64| {
                let least = e.dyadic(parts.checked_sub(j)?, edge.level, min)?;
                e.add(&least, &e.dyadic(j, edge.level, max)?)
            };
            Some(Interval { lo: at(index)?.lo, hi: at(index.checked_add(1)?)?.hi })
        };
        let [min, max] = corners;
        let ranges = self.edges.iter().zip(min).zip(max).map(range).collect::<Option<_>>()?;
        crate::cell::Cell(ranges).edges()
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.edges.map(|e| format!("{}/2^{}", e.index, e.level));
        write!(f, "u = ({x}, {y}, {z}) + one part each")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_share_the_midpoint_and_the_outer_ends() {
        let (_, upper) = Cell::ROOT.halves(Axis::Y).unwrap();
        let (lower, upper) = upper.halves(Axis::Y).unwrap();
        // [1/2, 1] splits into [2/4, 3/4] and [3/4, 4/4].
        assert_eq!(lower.edges[1], Edge { index: 2, level: 2 });
        assert_eq!(upper.edges[1], Edge { index: 3, level: 2 });
        assert_eq!(upper.edges[0], Cell::ROOT.edges[0]);
        let mut cell = upper;
        while let Some((_, next)) = cell.halves(Axis::Z) {
            cell = next;
        }
        assert_eq!(cell.depth(), 2 + MAX_AXIS_LEVEL);
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
        let corners = [vec![around(-1, 3)], vec![around(10, 7)]];
        for level in [0, 1, 5, 20, MAX_AXIS_LEVEL] {
            let parts = 1u128 << level;
            for index in [0, parts / 3, parts / 2, parts - 1] {
                let edge = Edge { index, level };
                let cell = Cell { edges: [edge, Cell::ROOT.edges[1], Cell::ROOT.edges[2]] };
                let found = cell.within(&e, &corners).unwrap();
                let [[centre, range, half]] = &found[..] else { panic!("one coordinate") };
                // 21 2^level (min + (max - min) j/2^level) = -7 2^level + 37 j.
                let end = |j: u128| (37 * j as i128 - 7 * parts as i128) * i128::from(unit);
                let scaled = |x: i64| 21 * parts as i128 * i128::from(x);
                assert!(scaled(range.lo) <= end(index) && end(index + 1) <= scaled(range.hi));
                assert!(scaled(range.hi - range.lo - 8) <= end(index + 1) - end(index));
                assert!(centre.lo - half.hi <= range.lo && centre.hi + half.hi == range.hi);
            }
        }
    }
}
