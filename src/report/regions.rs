//! Open boxes brought together: neighbours become one region.

use crate::search::OpenBox;
use orthocert_checker::cell::Cell;
use std::collections::BTreeMap;

/// Level of the grid on which neighbourhood is decided: boxes of cells that touch, on a grid of
/// `2^GRID` cells along every axis, belong to one region.
const GRID: u32 = 6;
const CELLS: usize = 1 << GRID;

/// A connected set of open boxes.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// How many boxes.
    pub boxes: usize,
    /// Their share of the workspace's bounding box, rounded up.
    pub share: f64,
    /// Least parts `u` of the workspace along every axis.
    pub min: [f64; 3],
    /// Greatest parts.
    pub max: [f64; 3],
}

/// The ends of a cell along every axis, as parts of the workspace.
pub fn ends(cell: &Cell) -> ([f64; 3], [f64; 3]) {
    let part = |k: usize, index: u128| index as f64 * (-f64::from(cell.edges[k].level)).exp2();
    let end = |offset: u128| [0, 1, 2].map(|k| part(k, cell.edges[k].index + offset));
    (end(0), end(1))
}

/// The share of the workspace's bounding box that a cell takes.
pub fn share(cell: &Cell) -> f64 {
    let halvings: u32 = cell.edges.iter().map(|edge| edge.level).sum();
    (-f64::from(halvings)).exp2()
}

/// The least double, or the next, that is at least `a + b`, of shares.
///
/// **Lemma.** With `s` the double nearest to `a + b`, `a >= b >= 0`, the double `b - (s - a)` is exactly
/// `a + b - s` (Dekker's Fast2Sum): where it is not positive `s` is at least the sum. Else the sum is
/// less than the double after `s`, which is nearer than it. ∎
pub fn sum_above(a: f64, b: f64) -> f64 {
    let (a, b) = (a.max(b), a.min(b));
    let sum = a + b;
    if b - (sum - a) > 0.0 {
        return sum.next_up();
    }
    sum
}

/// The regions of a set of boxes, greatest share first.
pub fn regions(open: &[OpenBox]) -> Vec<Region> {
    let mut grid = Grid::new();
    for item in open {
        grid.occupy(&item.cell);
    }
    grid.connect();
    let mut found: BTreeMap<usize, Region> = BTreeMap::new();
    for item in open {
        let [x, _] = covered(&item.cell, 0);
        let [y, _] = covered(&item.cell, 1);
        let [z, _] = covered(&item.cell, 2);
        let (min, max) = ends(&item.cell);
        let empty = Region { boxes: 0, share: 0.0, min, max };
        let region = found.entry(grid.root(at([x, y, z]))).or_insert(empty);
        region.boxes += 1;
        region.share = sum_above(region.share, share(&item.cell));
        for k in 0..3 {
            region.min[k] = region.min[k].min(min[k]);
            region.max[k] = region.max[k].max(max[k]);
        }
    }
    let mut all: Vec<Region> = found.into_values().collect();
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}

/// First and last grid cell that a box meets along an axis.
fn covered(cell: &Cell, axis: usize) -> [usize; 2] {
    let edge = cell.edges[axis];
    let [first, last] = if edge.level >= GRID {
        [edge.index >> (edge.level - GRID); 2]
    } else {
        let width = 1u128 << (GRID - edge.level);
        [edge.index * width, (edge.index + 1) * width - 1]
    };
    [first, last].map(|i| usize::try_from(i).unwrap_or(0).min(CELLS - 1))
}

fn at([x, y, z]: [usize; 3]) -> usize {
    (x * CELLS + y) * CELLS + z
}

/// Occupied grid cells as a forest: every one points to another of its region, or to itself.
struct Grid {
    parent: Vec<Option<usize>>,
}

impl Grid {
    fn new() -> Self {
        Grid { parent: vec![None; CELLS * CELLS * CELLS] }
    }

    fn occupy(&mut self, cell: &Cell) {
        let [[x0, x1], [y0, y1], [z0, z1]] = [0, 1, 2].map(|axis| covered(cell, axis));
        for x in x0..=x1 {
            for y in y0..=y1 {
                for z in z0..=z1 {
                    self.parent[at([x, y, z])] = Some(at([x, y, z]));
                }
            }
        }
    }

    /// Joins every occupied cell with the occupied ones among its 26 neighbours; the 13 that
    /// precede it in the order of positions suffice.
    fn connect(&mut self) {
        for position in 0..self.parent.len() {
            if self.parent[position].is_none() {
                continue;
            }
            let [x, y, z] = [position / CELLS / CELLS, position / CELLS % CELLS, position % CELLS];
            let near = |i: usize| i.saturating_sub(1)..=(i + 1).min(CELLS - 1);
            for nx in near(x) {
                for ny in near(y) {
                    for nz in near(z) {
                        let other = at([nx, ny, nz]);
                        if other < position && self.parent[other].is_some() {
                            self.join(position, other);
                        }
                    }
                }
            }
        }
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.parent[one.max(other)] = Some(one.min(other));
    }

    /// The cell that stands for the region; paths are halved on the way.
    fn root(&mut self, mut position: usize) -> usize {
        while let Some(parent) = self.parent[position].filter(|&parent| parent != position) {
            self.parent[position] = self.parent[parent];
            position = parent;
        }
        position
    }
}

#[cfg(test)]
mod tests {
    use super::sum_above;

    #[test]
    fn sums_of_shares_are_not_below_them() {
        let (large, small) = (0.125, (-80f64).exp2());
        assert_eq!(large + small, large);
        assert!(sum_above(large, small) > large && sum_above(small, large) > large);
        assert_eq!(sum_above(0.125, 0.25), 0.375);
        assert_eq!(sum_above(0.0, small), small);
    }

    use super::*;
    use orthocert_checker::cell::Edge;

    fn open(edges: [(u128, u32); 3]) -> OpenBox {
        let edges = edges.map(|(index, level)| Edge { index, level });
        OpenBox { cell: Cell { edges }, node: 0, open: Vec::new() }
    }

    #[test]
    fn boxes_that_touch_in_a_corner_are_one_region() {
        let boxes = [open([(0, 1), (0, 1), (0, 1)]), open([(1, 1), (1, 1), (1, 1)])];
        let found = regions(&boxes);
        assert_eq!(found, [Region { boxes: 2, share: 0.25, min: [0.0; 3], max: [1.0; 3] }]);
    }

    #[test]
    fn distant_boxes_are_regions_of_their_own_largest_first() {
        let small = open([(0, 20), (0, 20), (0, 20)]);
        let neighbour = open([(1, 20), (0, 20), (0, 20)]);
        let large = open([(3, 2), (3, 2), (3, 2)]);
        let found = regions(&[small, neighbour, large]);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].boxes, found[0].share), (1, 1.0 / 64.0));
        assert_eq!((found[1].boxes, found[1].max[0]), (2, 2.0 / 1_048_576.0));
    }

    #[test]
    fn the_whole_workspace_is_one_region_and_nothing_is_none() {
        assert_eq!(regions(&[open([(0, 0); 3])]).len(), 1);
        assert!(regions(&[]).is_empty());
    }
}
