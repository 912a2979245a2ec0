//! The surface of the inner part of a paving, as quadrilaterals that fit together.
//!
//! The *inner part* is the union of the inner cells; with symmetry, of all images of what they have
//! with `u_x <= u_y <= u_z`. Its volume is the paving's certified inner volume.
//!
//! All inner cells are unions of the cells of one grid, that of their finest edges. The surface
//! consists of the grid's faces that have the inner part on one side alone, turned so that their
//! corners run counterclockwise seen from without.
//!
//! **Lemma.** Each edge of the grid belongs to none, two or four of these faces, and runs as often in
//! one direction as in the other: the surface is closed. *Proof.* Four cells of the grid, or fewer at
//! the box's sides, go round an edge, and a face lies between neighbours. Going round, one enters the
//! inner part as often as one leaves it, through faces that run along the edge in opposite
//! directions. ∎ Four faces meet where parts touch in an edge only.

use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::claim::Workspace;
use orthocert_checker::number::Exact;
use orthocert_checker::paving::{Header, Kind, Reader, Rejected};
use std::fmt;
use std::io::BufRead;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most faces of a surface.
const MOST_FACES: usize = 1 << 24;
/// Most faces of the grid that are looked at, of all inner cells.
const MOST_LOOKED_AT: u128 = 1 << 30;
/// Most nodes of the tree without what has no inner cell.
const MOST_NODES: usize = 1 << 26;
/// Bits of a coordinate in the grid: `0..=2^40`.
const BITS: u32 = 41;

/// What lies beyond a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Outer cells.
    Outer,
    /// Cells some of which are undecided.
    Undecided,
    /// What is outside the box that is paved.
    OutsideBox,
}

/// A face of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Its corners, as positions in [`Surface::points`].
    pub corners: [u32; 4],
    /// What it separates the inner part from.
    pub beyond: Beyond,
    /// Splits above the inner cell whose face it is part of.
    pub depth: u32,
}

/// The surface of the inner part.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// How often each axis of the box is halved in the grid.
    pub levels: [u32; 3],
    /// The corners in the grid, sorted by the last coordinate first, no two the same.
    pub points: Vec<[u64; 3]>,
    /// The faces, in the tree's order.
    pub faces: Vec<Face>,
    /// The ends of the box, nearly.
    ends: [[f64; 2]; 3],
}

/// Why there is no surface.
#[derive(Debug)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The paving is malformed.
    Rejected(Rejected),
    /// No cell is inner.
    Empty,
    /// There would be too many faces, or too many to look at.
    TooFine,
    /// The box's ends are beyond floating point, or corners would coincide there.
    TooClose,
    /// The work was cancelled.
    Cancelled,
}

impl From<Rejected> for SurfaceError {
    fn from(reason: Rejected) -> Self {
        SurfaceError::Rejected(reason)
    }
}

impl fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SurfaceError::Rejected(reason) => write!(f, "REJECTED: {reason}"),
            SurfaceError::Empty => write!(f, "no box is inner: there is no surface"),
            SurfaceError::TooFine => write!(
                f,
                "the surface is too fine; accepted: at most {MOST_FACES} faces, {MOST_LOOKED_AT} of \
                 the grid to be looked at, and {MOST_NODES} nodes"
            ),
            SurfaceError::TooClose => write!(
                f,
                "corners that differ would have the same coordinates; accepted: coordinates that \
                 the file's numbers tell apart"
            ),
            SurfaceError::Cancelled => write!(f, "cancelled"),
        }
    }
}

impl std::error::Error for SurfaceError {}

/// A node of the tree, without what has no inner cell.
#[derive(Clone, Copy)]
enum Node {
    Split(Axis, u32, u32),
    Inner(u32),
    Undecided,
    Outer,
}

/// Where the nodes without inner cells are.
const OUTER: u32 = 0;
const UNDECIDED: u32 = 1;

/// Reads a paving to its end and finds the surface of its inner part.
///
/// The shape of the tree and its summary are checked, the evidence is not.
///
/// # Errors
/// [`SurfaceError`].
pub fn surface<R: BufRead>(
    mut reader: Reader<R>,
    cancel: &AtomicBool,
) -> Result<Surface, SurfaceError> {
    let mut tree = Tree::read(&mut reader, cancel)?;
    let header = reader.header().clone();
    reader.finish()?;
    if header.symmetry.is_some() {
        tree.symmetric = true;
        tree.levels = [tree.levels.into_iter().max().unwrap_or(0); 3];
    }
    let ends = ends(&header).ok_or(SurfaceError::TooClose)?;
    let faces = tree.faces(cancel)?;
    if faces.is_empty() {
        return Err(SurfaceError::Empty);
    }
    Ok(assembled(tree.levels, ends, &faces))
}

/// The ends of the box that is paved, nearly.
fn ends(header: &Header) -> Option<[[f64; 2]; 3]> {
    let Workspace::Box { min, max } = &header.machine_claim().ok()?.workspace else {
        return None;
    };
    let near = |x: &Exact| crate::decimal::approximate(x).filter(|x| x.is_finite());
    let mut ends = [[0.0; 2]; 3];
    for (end, (min, max)) in ends.iter_mut().zip(min.iter().zip(max)) {
        *end = [near(min)?, near(max)?];
    }
    Some(ends)
}

/// The tree, down to the cells that are inner or have no inner cell within.
struct Tree {
    nodes: Vec<Node>,
    root: u32,
    /// The greatest level of an inner cell's edge along each axis; with symmetry, of all.
    levels: [u32; 3],
    symmetric: bool,
}

/// A face of the grid between a cell of it that is inner and one that is not.
#[derive(Clone, Copy, PartialEq)]
struct Wall {
    cell: [u64; 3],
    axis: usize,
    /// Whether the inner part is below.
    upward: bool,
    beyond: Beyond,
    depth: u32,
}

impl Tree {
    fn read<R: BufRead>(reader: &mut Reader<R>, cancel: &AtomicBool) -> Result<Self, SurfaceError> {
        let mut tree = Tree {
            nodes: vec![Node::Outer, Node::Undecided],
            root: OUTER,
            levels: [0; 3],
            symmetric: false,
        };
        // Splits that wait for their halves: the axis, and the lower half once it is known.
        let mut waiting: Vec<(Axis, Option<u32>)> = Vec::new();
        while let Some(visited) = reader.next()? {
            if tree.nodes.len() > MOST_NODES {
                return Err(SurfaceError::TooFine);
            }
            if cancel.load(Ordering::Relaxed) {
                return Err(SurfaceError::Cancelled);
            }
            let mut done = match visited.item.kind {
                Kind::Split(axis) => {
                    waiting.push((axis, None));
                    continue;
                }
                Kind::Inner => {
                    for (level, edge) in tree.levels.iter_mut().zip(visited.cell.edges) {
                        *level = edge.level.max(*level);
                    }
                    tree.add(Node::Inner(visited.depth))
                }
                Kind::Boundary => UNDECIDED,
                Kind::Outer(_) | Kind::Mirrored => OUTER,
            };
            while let Some((axis, lower)) = waiting.pop() {
                let Some(lower) = lower else {
                    waiting.push((axis, Some(done)));
                    break;
                };
                done = match (lower, done) {
                    (OUTER, OUTER) => OUTER,
                    (OUTER | UNDECIDED, OUTER | UNDECIDED) => UNDECIDED,
                    _ => tree.add(Node::Split(axis, lower, done)),
                };
            }
            tree.root = done;
        }
        Ok(tree)
    }

    fn add(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1 // At most MOST_NODES and a path's.
    }

    fn node(&self, at: u32) -> Node {
        self.nodes.get(at as usize).copied().unwrap_or(Node::Outer)
    }

    /// What lies at a cell of the grid, with its coordinates in order where there is symmetry; `None`
    /// if that is inner.
    fn beyond(&self, cell: [u64; 3]) -> Option<Beyond> {
        let mut at = self.root;
        let mut left = self.levels;
        loop {
            match self.node(at) {
                Node::Split(axis, lower, upper) => {
                    let k = axis.index();
                    // A node that is split has an inner cell within, whose edges the grid has.
                    left[k] = left[k].saturating_sub(1);
                    at = if cell[k] >> left[k] & 1 == 0 { lower } else { upper };
                }
                Node::Inner(_) => return None,
                Node::Undecided => return Some(Beyond::Undecided),
                Node::Outer => return Some(Beyond::Outer),
            }
        }
    }

    /// The inner cells, with their depths.
    fn inner(&self) -> impl Iterator<Item = (Cell, u32)> + '_ {
        let mut waiting = vec![(self.root, Cell::ROOT)];
        std::iter::from_fn(move || loop {
            let (at, cell) = waiting.pop()?;
            match self.node(at) {
                Node::Split(axis, lower, upper) => {
                    if let Some((below, above)) = cell.halves(axis) {
                        waiting.extend([(upper, above), (lower, below)]);
                    }
                }
                Node::Inner(depth) => return Some((cell, depth)),
                Node::Undecided | Node::Outer => {}
            }
        })
    }

    /// A cell's first and last part along each axis in the grid.
    fn range(&self, cell: &Cell) -> [[u64; 2]; 3] {
        std::array::from_fn(|k| {
            let edge = cell.edges[k];
            let finer = self.levels[k] - edge.level;
            // index < 2^level, level + finer <= 40.
            [(edge.index as u64) << finer, ((edge.index as u64 + 1) << finer) - 1]
        })
    }

    fn faces(&self, cancel: &AtomicBool) -> Result<Vec<Wall>, SurfaceError> {
        let mut looked_at: u128 = 0;
        for (cell, _) in self.inner() {
            let [x, y, z] = self.range(&cell).map(|[first, last]| u128::from(last - first + 1));
            looked_at = looked_at.saturating_add(2 * (x * y + y * z + x * z));
        }
        if looked_at > MOST_LOOKED_AT {
            return Err(SurfaceError::TooFine);
        }
        let mut walls = Vec::new();
        for (cell, depth) in self.inner() {
            let range = self.range(&cell);
            for axis in 0..3 {
                for upward in [false, true] {
                    if cancel.load(Ordering::Relaxed) {
                        return Err(SurfaceError::Cancelled);
                    }
                    self.side(&range, axis, upward, depth, &mut walls);
                    if walls.len() > MOST_FACES {
                        return Err(SurfaceError::TooFine);
                    }
                }
            }
        }
        Ok(walls)
    }

    /// The walls on one side of a cell, and their images.
    ///
    /// With symmetry, those are taken of which the cells of the grid on both sides have their
    /// coordinates in order. **Lemma.** Each wall is an image of exactly one such, and that is found.
    /// *Proof.* Put the inner cell's coordinates in order; of axes with the same coordinate, the last
    /// can go up, and the first down, with the order kept, and a wall on another of them is an image
    /// of that. A cell of the tree is a box: what is next to a part of it and not within lies beyond
    /// the side. ∎
    fn side(
        &self,
        range: &[[u64; 2]; 3],
        axis: usize,
        upward: bool,
        depth: u32,
        walls: &mut Vec<Wall>,
    ) {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut cell = [0; 3];
        cell[axis] = range[axis][usize::from(upward)];
        let at_the_end = cell[axis] == if upward { (1 << self.levels[axis]) - 1 } else { 0 };
        for along in range[b][0]..=range[b][1] {
            cell[b] = along;
            for across in range[c][0]..=range[c][1] {
                cell[c] = across;
                let repeated = if upward {
                    axis < 2 && cell[axis + 1] == cell[axis]
                } else {
                    axis > 0 && cell[axis - 1] == cell[axis]
                };
                if self.symmetric && (!cell.is_sorted() || repeated) {
                    continue;
                }
                let beyond = if at_the_end {
                    Some(Beyond::OutsideBox)
                } else {
                    let mut next = cell;
                    next[axis] = if upward { cell[axis] + 1 } else { cell[axis] - 1 };
                    self.beyond(next)
                };
                if let Some(beyond) = beyond {
                    self.images(Wall { cell, axis, upward, beyond, depth }, walls);
                }
            }
        }
    }

    fn images(&self, wall: Wall, walls: &mut Vec<Wall>) {
        let first = walls.len();
        let permutations = if self.symmetric { &PERMUTATIONS[..] } else { &PERMUTATIONS[..1] };
        for p in permutations {
            let mut image = Wall { axis: p[wall.axis], ..wall };
            for (k, at) in p.iter().enumerate() {
                image.cell[*at] = wall.cell[k];
            }
            if !walls[first..].contains(&image) {
                walls.push(image);
            }
        }
    }
}

const PERMUTATIONS: [[usize; 3]; 6] =
    [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Wall {
    /// The corners, counterclockwise seen from without.
    fn corners(&self) -> [u128; 4] {
        let (b, c) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let mut corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(along, across)| {
            let mut corner = self.cell;
            corner[self.axis] += u64::from(self.upward);
            corner[b] += along;
            corner[c] += across;
            packed(corner)
        });
        if !self.upward {
            corners.reverse();
        }
        corners
    }
}

fn packed([x, y, z]: [u64; 3]) -> u128 {
    u128::from(z) << (2 * BITS) | u128::from(y) << BITS | u128::from(x)
}

fn unpacked(key: u128) -> [u64; 3] {
    [0, BITS, 2 * BITS].map(|shift| (key >> shift) as u64 & ((1 << BITS) - 1))
}

fn assembled(levels: [u32; 3], ends: [[f64; 2]; 3], walls: &[Wall]) -> Surface {
    let mut keys: Vec<u128> = walls.iter().flat_map(Wall::corners).collect();
    keys.sort_unstable();
    keys.dedup();
    // Each key is found: they are all there. At most 4 MOST_FACES of them.
    let position = |key: u128| keys.partition_point(|other| *other < key) as u32;
    let face = |wall: &Wall| Face {
        corners: wall.corners().map(position),
        beyond: wall.beyond,
        depth: wall.depth,
    };
    let faces = walls.iter().map(face).collect();
    Surface { levels, points: keys.iter().map(|key| unpacked(*key)).collect(), faces, ends }
}

impl Surface {
    /// The corners in the design's frame and unit, nearly, as `number` makes them of doubles.
    ///
    /// # Errors
    /// [`SurfaceError::TooClose`] if planes of corners that differ would coincide.
    pub fn coordinates<T: Copy + PartialOrd>(
        &self,
        number: impl Fn(f64) -> T,
    ) -> Result<Vec<[T; 3]>, SurfaceError> {
        let along = |k: usize, index: u64| {
            // Exact: index <= 2^40.
            let part = index as f64 * (-f64::from(self.levels[k])).exp2();
            number(self.ends[k][0] * (1.0 - part) + self.ends[k][1] * part)
        };
        for k in 0..3 {
            let mut planes: Vec<u64> = self.points.iter().map(|point| point[k]).collect();
            planes.sort_unstable();
            planes.dedup();
            if !planes.windows(2).all(|pair| along(k, pair[0]) < along(k, pair[1])) {
                return Err(SurfaceError::TooClose);
            }
        }
        Ok(self.points.iter().map(|p| [along(0, p[0]), along(1, p[1]), along(2, p[2])]).collect())
    }

    /// The enclosed volume as a number of cells of the grid, by the divergence theorem: the sum of
    /// `x n_x` over the faces.
    pub fn cells(&self) -> i128 {
        let x_normal = |face: &Face| {
            let [a, b, _, d] = face.corners.map(|at| self.points[at as usize]);
            let side = |q: [u64; 3], k: usize| i128::from(q[k]) - i128::from(a[k]);
            i128::from(a[0]) * (side(b, 1) * side(d, 2) - side(b, 2) * side(d, 1))
        };
        self.faces.iter().map(x_normal).sum()
    }
}

#[cfg(test)]
mod tests;
