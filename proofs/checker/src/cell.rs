//! Cells: the boxes of a bisection tree, as exact dyadic parts of the workspace.
//!
//! The workspace is the image of `[0, 1]^3` under `u -> min + width * u` (coordinate by
//! coordinate). A cell is `prod_k [index_k / 2^level_k, (index_k + 1) / 2^level_k]`: integers, so
//! that two halves cover their parent by construction, whatever the workspace's numbers are.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Deepest bisection of one axis. An index then fits 128 bits with room for the centre's.
pub const MAX_LEVEL: u32 = 120;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
    /// The third coordinate.
    Z,
}

impl Axis {
    /// The axes of a machine's workspace, in order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// Position in a vector, from zero.
    pub fn index(self) -> usize {
        match self {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        }
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
    /// The whole workspace.
    pub const ROOT: Cell = Cell { edges: [Edge { index: 0, level: 0 }; 3] };

    /// The lower and the upper half along `axis`; `None` beyond [`MAX_LEVEL`].
    ///
    /// `[i, i+1] / 2^l = [2i, 2i+1] / 2^(l+1) u [2i+1, 2i+2] / 2^(l+1)`.
    pub fn halves(&self, axis: Axis) -> Option<(Cell, Cell)> {
        let k = axis.index();
        let Edge { index, level } = self.edges[k];
        if level >= MAX_LEVEL {
            return None;
        }
        let half = |index| {
            let mut cell = *self;
            cell.edges[k] = Edge { index, level: level + 1 };
            cell
        };
        Some((half(2 * index), half(2 * index + 1)))
    }

    /// Whether the cell has the vertex `u = (0, 0, 0)`.
    pub fn touches_lower_corner(&self) -> bool {
        self.edges.iter().all(|e| e.index == 0)
    }

    /// Whether the cell has the vertex `u = (1, 1, 1)`.
    pub fn touches_upper_corner(&self) -> bool {
        self.edges.iter().all(|e| e.index + 1 == 1u128 << e.level)
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
        assert_eq!(upper.edges[2], Cell::ROOT.edges[2]);
    }

    #[test]
    fn only_corner_cells_touch_the_corners() {
        assert!(Cell::ROOT.touches_lower_corner() && Cell::ROOT.touches_upper_corner());
        let (lower, upper) = Cell::ROOT.halves(Axis::X).unwrap();
        assert!(lower.touches_lower_corner() && !lower.touches_upper_corner());
        assert!(!upper.touches_lower_corner() && upper.touches_upper_corner());
    }

    #[test]
    fn bisection_stops_at_the_deepest_level() {
        let mut cell = Cell::ROOT;
        for _ in 0..MAX_LEVEL {
            cell = cell.halves(Axis::Z).unwrap().1;
        }
        assert!(cell.touches_upper_corner());
        assert_eq!(cell.halves(Axis::Z), None);
    }
}
