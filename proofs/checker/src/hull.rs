//! Hulls: few points whose convex combinations hold every point of a cell that is asked about.
//!
//! In the terms of [`crate::expansion`], a point of the cell is `c + sum_k lambda_k h_k`. A
//! condition that is convex in `lambda` and holds at the vertices of a hull holds at every point in
//! question. For a box the hull is the cell itself; for a cylinder, whose boundary is curved, it is
//! the cell less what lies beyond one tangent plane, which leaves no more than the square of the
//! cell's size in excess.

use crate::cell::{Cell, Edge};
use crate::enclosure::Enclosure;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

/// Binary places of the components of a [`Vertex`].
pub const LAMBDA_BITS: u32 = 16;
/// `lambda = 1`.
const ONE: i64 = 1 << LAMBDA_BITS;
/// A rectangle cut by one line has no more corners.
const MOST_CORNERS: usize = 5;

/// A vertex of a hull.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vertex {
    /// Its place in [`Hull::vertices`]; of a whole cell, bit `k` is set where `lambda_k` is 1.
    pub number: u8,
    /// `2^16 lambda`.
    pub lambda: [i64; 3],
}

impl Vertex {
    /// `a + sum_k lambda_k b_k`.
    pub fn affine<S: Enclosure>(&self, a: &S, b: [&S; 3]) -> S {
        self.lambda.iter().zip(b).fold(a.clone(), |sum, (&lambda, b)| match lambda {
            0 => sum,
            ONE => sum.add(b),
            _ if lambda == -ONE => sum.sub(b),
            part => {
                let term = b.mul(&b.dyadic_like(part.unsigned_abs().into(), LAMBDA_BITS));
                if part > 0 {
                    sum.add(&term)
                } else {
                    sum.sub(&term)
                }
            }
        })
    }
}

/// The vertices: corners of a polygon in `lambda_x`, `lambda_y`, at both ends of `lambda_z`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hull {
    polygon: [[i64; 2]; MOST_CORNERS],
    corners: usize,
    z: [i64; 2],
}

/// The corners of the square `[low, 1]^2`.
const fn square(low: i64) -> [[i64; 2]; MOST_CORNERS] {
    [[low, low], [ONE, low], [low, ONE], [ONE, ONE], [0, 0]]
}

impl Hull {
    /// A whole cell about its centre: `lambda` in `[-1, 1]^3`.
    pub const CELL: Hull = Hull { polygon: square(-ONE), corners: 4, z: [-ONE, ONE] };
    /// A whole cell about one of its corners: `lambda` in `[0, 1]^3`; the first vertex is the corner.
    pub const ABOUT_CORNER: Hull = Hull { polygon: square(0), corners: 4, z: [0, ONE] };

    /// The part of `cell`, about its centre, that holds every point of the cylinder in it.
    ///
    /// The cylinder is `|p| <= 1` for `p = (2 u_x - 1, 2 u_y - 1)`. With `n` the direction of the
    /// cell's centre, `n . p <= |n|` there: what lies beyond this tangent plane is cut off the
    /// cell's rectangle.
    ///
    /// **Lemma.** The polygon returned holds every `p` of the rectangle with `n . p <= |n|`.
    /// *Proof.* With `l >= |n|`, `f(p) = n . p - l` is affine; the part of the rectangle with
    /// `f <= 0` is the convex hull of the corners with `f <= 0` and the zeros of `f` on the edges
    /// between such a corner `a` and one with `f > 0`, `b`. The zero, at the part
    /// `-f(a)/(f(b) - f(a))` of the edge, is moved towards `b`, to the next multiple of `2^-16`:
    /// the hull only grows. ∎
    pub fn in_cylinder(cell: &Cell) -> Hull {
        let [x, y, _] = cell.edges;
        let bits = x.level.max(y.level);
        // 2^bits p at both ends of an edge.
        let ends = |edge: Edge| {
            let whole = BigInt::one() << edge.level;
            [0u8, 2].map(|end| (BigInt::from(edge.index) * 2 + end - &whole) << (bits - edge.level))
        };
        let (x, y) = (ends(x), ends(y));
        // 2^(bits + 17) times the centre: enough digits for its length to be an integer.
        let normal = ((&x[0] + &x[1]) << LAMBDA_BITS, (&y[0] + &y[1]) << LAMBDA_BITS);
        let square_of_length: BigInt = &normal.0 * &normal.0 + &normal.1 * &normal.1;
        let mut length = square_of_length.sqrt();
        if &length * &length < square_of_length {
            length += 1;
        }
        let length = length << bits;
        let corner = |i: usize, j: usize| &normal.0 * &x[i] + &normal.1 * &y[j] - &length;
        let f: [BigInt; 4] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        if f.iter().all(Signed::is_positive) || !f.iter().any(Signed::is_positive) {
            return Hull::CELL;
        }
        let square = Hull::CELL.polygon;
        let mut hull = Hull { corners: 0, ..Hull::CELL };
        let mut push = |corner: [i64; 2]| {
            if let Some(place) = hull.polygon.get_mut(hull.corners) {
                *place = corner;
                hull.corners += 1;
            }
        };
        for (corner, f) in square.into_iter().zip(&f) {
            if !f.is_positive() {
                push(corner);
            }
        }
        for (a, b, axis) in [(0, 1, 0), (2, 3, 0), (0, 2, 1), (1, 3, 1)] {
            let (kept, cut) = match (f[a].is_positive(), f[b].is_positive()) {
                (false, true) => (a, b),
                (true, false) => (b, a),
                _ => continue,
            };
            let mut crossing = square[kept];
            crossing[axis] -= crossing[axis].signum() * 2 * part(&-&f[kept], &(&f[cut] - &f[kept]));
            push(crossing);
        }
        hull
    }

    /// The vertices.
    pub fn vertices(&self) -> impl Iterator<Item = Vertex> + '_ {
        let corners = self.polygon.iter().take(self.corners);
        let numbered = |[x, y]: [i64; 2], z| [x, y, z];
        self.z
            .iter()
            .flat_map(move |&z| corners.clone().map(move |&corner| numbered(corner, z)))
            .zip(0u8..)
            .map(|(lambda, number)| Vertex { number, lambda })
    }
}

/// `a / b` in parts of `2^16`, rounded up; for `0 <= a < b`.
fn part(a: &BigInt, b: &BigInt) -> i64 {
    let scaled = a << LAMBDA_BITS;
    let (whole, rest) = (&scaled / b, &scaled % b);
    let whole = i64::try_from(whole).unwrap_or(ONE).min(ONE);
    if rest.is_zero() {
        whole
    } else {
        (whole + 1).min(ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Axis;

    fn cell(x: (u128, u32), y: (u128, u32)) -> Cell {
        let edge = |(index, level)| Edge { index, level };
        Cell { edges: [edge(x), edge(y), edge((0, 0))] }
    }

    /// Whether `lambda` is left of, or on, every edge of the polygon's convex hull: checked with the
    /// support function in many directions.
    fn holds(hull: &Hull, lambda: [f64; 2]) -> bool {
        (0..720).all(|step| {
            let (sin, cos) = (f64::from(step) * std::f64::consts::PI / 360.0).sin_cos();
            let along = |p: [f64; 2]| p[0] * cos + p[1] * sin;
            let support = hull
                .vertices()
                .map(|v| along([v.lambda[0] as f64 / ONE as f64, v.lambda[1] as f64 / ONE as f64]))
                .fold(f64::MIN, f64::max);
            along(lambda) <= support + 1e-12
        })
    }

    #[test]
    fn the_whole_cell_is_numbered_by_bits() {
        for vertex in Hull::CELL.vertices() {
            for k in 0..3 {
                let expected = if vertex.number >> k & 1 == 1 { ONE } else { -ONE };
                assert_eq!(vertex.lambda[k], expected);
            }
        }
        assert_eq!(Hull::CELL.vertices().count(), 8);
        assert_eq!(Hull::ABOUT_CORNER.vertices().next().unwrap().lambda, [0, 0, 0]);
    }

    #[test]
    fn every_point_of_the_cylinder_stays_in_the_hull() {
        let mut cut = 0;
        for level in 1..6u32 {
            let count = 1u128 << level;
            for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
                for other in [level, level + 2] {
                    let cell = cell((i, level), (j << (other - level), other));
                    let hull = Hull::in_cylinder(&cell);
                    cut += usize::from(hull != Hull::CELL);
                    for (a, b) in (0..=8).flat_map(|a| (0..=8).map(move |b| (a, b))) {
                        let lambda = [f64::from(a) / 4.0 - 1.0, f64::from(b) / 4.0 - 1.0];
                        let p = |edge: Edge, lambda: f64| {
                            let centre = 2.0 * edge.index as f64 + 1.0;
                            (centre + lambda) / f64::from(edge.level).exp2() - 1.0
                        };
                        let at = [p(cell.edges[0], lambda[0]), p(cell.edges[1], lambda[1])];
                        if at[0].hypot(at[1]) <= 1.0 {
                            assert!(holds(&hull, lambda), "{cell}: {lambda:?}");
                        }
                    }
                }
            }
        }
        assert!(cut > 100, "{cut} cells are cut");
    }

    #[test]
    fn the_excess_shrinks_with_the_square_of_the_cell() {
        // Cells on the diagonal direction, on the circle.
        let mut cut = 0;
        for level in 3..20u32 {
            let size = f64::from(level).exp2().recip() * 2.0;
            let reach = ((1.0 + std::f64::consts::FRAC_1_SQRT_2) / size).floor() as u128;
            let cell = cell((reach, level), (reach, level));
            let hull = Hull::in_cylinder(&cell);
            cut += usize::from(hull != Hull::CELL);
            for vertex in hull.vertices() {
                let p = |edge: Edge, lambda: i64| {
                    let centre = 2.0 * edge.index as f64 + 1.0;
                    (centre + lambda as f64 / ONE as f64) * size / 2.0 - 1.0
                };
                let [x, y, _] = cell.edges;
                let radius = p(x, vertex.lambda[0]).hypot(p(y, vertex.lambda[1]));
                assert!(radius <= 1.0 + size * size + size * 1e-4, "level {level}: {radius}");
            }
        }
        assert!(cut > 10, "{cut} cells are cut");
    }

    #[test]
    fn cells_inside_and_cells_beyond_are_left_whole() {
        assert_eq!(Hull::in_cylinder(&Cell::ROOT), Hull::CELL);
        assert_eq!(Hull::in_cylinder(&cell((3, 3), (3, 3))), Hull::CELL);
        assert_eq!(Hull::in_cylinder(&cell((0, 5), (0, 5))), Hull::CELL);
        let (_, deep) = Cell::ROOT.halves(Axis::X).unwrap();
        assert_eq!(Hull::in_cylinder(&deep).vertices().count() % 2, 0);
    }
}
