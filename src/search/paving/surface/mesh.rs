//! Walls cut so that they fit together.
//!
//! Where a corner of a wall lies on the side of another, that side is cut there. A wall whose sides
//! are not cut stays a quadrilateral; one whose sides are is cut into triangles.
//!
//! **Lemma.** Each edge of the pieces runs as often in one direction as in the other: the surface is
//! closed. *Proof.* A cut within a wall is an edge of the two pieces beside it. Any other edge lies on
//! a side of a wall, and has no corner of a wall within. Going round it, one enters the inner part as
//! often as one leaves it. A wall that is met has the edge on a side, for its sides end in corners, or
//! within: then it is met twice, once in either way. So the walls that have it on a side are entered
//! as often as they are left, and their edges run in opposite directions. ∎

use super::wall::{Wall, EDGE};
use super::{Face, Surface};
use orthocert_kernel::paving::MAX_AXIS_LEVEL;

/// Bits of a coordinate: `0..=EDGE`.
const BITS: u32 = MAX_AXIS_LEVEL + 1;

/// The pieces of the walls.
pub(super) fn assembled(walls: &[Wall], ends: [[f64; 2]; 3]) -> Surface {
    let grid = Grid::new(walls);
    let (mut quads, mut triangles) = (Vec::new(), Vec::new());
    let mut polygon = Vec::new();
    for wall in walls {
        let [_, b, c, d] = grid.polygon(wall, &mut polygon);
        if let Ok(corners) = <[u32; 4]>::try_from(&polygon[..]) {
            quads.push(Face { corners, beyond: wall.beyond });
        } else {
            let cut = fans(polygon.len(), [b, c, d]).map(|corners| corners.map(|i| polygon[i]));
            triangles.extend(cut.map(|corners| Face { corners, beyond: wall.beyond }));
        }
    }
    let points = grid.keys.iter().map(|key| unpacked(*key)).collect();
    Surface { points, quads, triangles, ends }
}

/// The triangles of a rectangle of which the vertices `0`, `b`, `c` and `d` are the corners, and the
/// others, up to `count`, are on the sides; counterclockwise as the vertices are.
///
/// **Lemma.** They cover it, and none is flat. *Proof.* Let `n` be the vertex after `b`, and `m` the
/// one before `d`; `n <= c <= m`. From `n`, which is not on the side from `0` to `b`, the parts of that
/// side are seen at the triangle `0 b n`; from `m`, which is not on the side from `d` to `0`, the
/// parts of that side at the triangle `m d 0`. What is left is the convex polygon `0 n .. c .. m`: from
/// `0`, which is on neither of the sides at `c`, their parts are seen at it. ∎
fn fans(count: usize, [b, _, d]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let (n, m) = (b + 1, d - 1);
    let first = (0..b).map(move |i| [n, i, i + 1]);
    let second = (d..count).map(move |i| [m, i, (i + 1) % count]);
    first.chain(second).chain((n..m).map(|i| [0, i, i + 1]))
}

fn packed([x, y, z]: [u64; 3]) -> u128 {
    u128::from(z) << (2 * BITS) | u128::from(y) << BITS | u128::from(x)
}

fn unpacked(key: u128) -> [u64; 3] {
    [0, BITS, 2 * BITS].map(|shift| (key >> shift) as u64 & (2 * EDGE - 1))
}

/// The corners of all walls, and their order along each axis.
struct Grid {
    /// Sorted by z, then y, then x; no two the same.
    keys: Vec<u128>,
    /// For y and z: their positions, so that those of a line along the axis follow each other.
    order: [Vec<u32>; 2],
    /// For y and z: where in the order each of them is.
    rank: [Vec<u32>; 2],
}

impl Grid {
    fn new(walls: &[Wall]) -> Self {
        let mut keys: Vec<u128> = Vec::with_capacity(4 * walls.len());
        keys.extend(walls.iter().flat_map(corners).map(packed));
        keys.sort_unstable();
        keys.dedup();
        keys.shrink_to_fit();
        // At most 4 MOST_WALLS of them.
        let order = [1, 2].map(|axis: usize| {
            let mut order: Vec<u32> = (0..keys.len() as u32).collect();
            order.sort_unstable_by_key(|at| {
                let mut point = unpacked(keys[*at as usize]);
                // What is packed last is compared first: the axis is to be compared last.
                point.swap(0, axis);
                packed(point)
            });
            order
        });
        let rank = order.each_ref().map(|order| {
            let mut rank = vec![0; order.len()];
            for (position, at) in (0..).zip(order) {
                rank[*at as usize] = position;
            }
            rank
        });
        Grid { keys, order, rank }
    }

    /// The vertices of a wall, counterclockwise seen from without, from a corner; and where in them
    /// the corners are.
    fn polygon(&self, wall: &Wall, polygon: &mut Vec<u32>) -> [usize; 4] {
        // Each key is found: they are all there.
        let at = corners(wall).map(|c| {
            let key = packed(c);
            self.keys.partition_point(|other| *other < key) as u32
        });
        let mut starts = [0; 4];
        polygon.clear();
        for i in 0..4 {
            starts[i] = polygon.len();
            // The first and the third side go along the next axis.
            let along = usize::from(wall.axis) + 1 + i % 2;
            self.side(along % 3, at[i], at[(i + 1) % 4], polygon);
        }
        starts
    }

    /// The points on a line along an axis from one to before another.
    fn side(&self, axis: usize, from: u32, to: u32, polygon: &mut Vec<u32>) {
        let rank = |at: u32| if axis == 0 { at } else { self.rank[axis - 1][at as usize] };
        let point = |rank: u32| if axis == 0 { rank } else { self.order[axis - 1][rank as usize] };
        let (first, last) = (rank(from), rank(to));
        if first < last {
            polygon.extend((first..last).map(point));
        } else {
            polygon.extend((last + 1..=first).rev().map(point));
        }
    }
}

/// The corners of a wall, counterclockwise seen from without.
fn corners(wall: &Wall) -> [[u64; 3]; 4] {
    let axis = usize::from(wall.axis);
    let [[a, b], [c, d]] = wall.sides;
    let mut corners = [[a, c], [b, c], [b, d], [a, d]].map(|[along, across]| {
        let mut corner = [wall.plane; 3];
        (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (along, across);
        corner
    });
    if !wall.upward {
        corners.reverse();
    }
    corners
}
