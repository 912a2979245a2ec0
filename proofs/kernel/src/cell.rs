//! Boxes of the bisection tree, and the points between which a formula's values on them lie.

use crate::fixed::{Integer, Interval};

/// A box: for each coordinate a range with ends in multiples of `2^-bits`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell<Z>(pub Vec<Interval<Z>>);

impl<Z: Integer> Interval<Z> {
    /// Both halves, at `floor((lo + hi)/2)`: together they are it, whatever is rounded. `None` if there is nothing to
    /// halve.
    pub fn halves(&self) -> Option<[Self; 2]> {
        let middle = self.lo.plus(&self.hi)?.half();
        let of = |lo: &Z, hi: &Z| Interval { lo: lo.clone(), hi: hi.clone() };
        (middle != self.lo).then(|| [of(&self.lo, &middle), of(&middle, &self.hi)])
    }
}

impl<Z: Integer> Cell<Z> {
    /// Whether it touches the least, and the greatest corner of another.
    pub fn touches(&self, root: &Self) -> [bool; 2] {
        let all = |same: fn(&Interval<Z>, &Interval<Z>) -> bool| {
            self.0.iter().zip(&root.0).all(|(own, root)| same(own, root))
        };
        [all(|own, root| own.lo == root.lo), all(|own, root| own.hi == root.hi)]
    }

    /// For each coordinate its centre, range and half-width.
    ///
    /// Coordinate `k` is `c_k + lambda_k h_k` with `c_k = floor((lo + hi)/2)`, `h_k = hi - c_k`, so
    /// that `lambda_k` in `[-1, 1]` gives all of the range, as `c_k - h_k <= lo`.
    pub fn edges(&self) -> Option<Vec<[Interval<Z>; 3]>> {
        let edge = |range: &Interval<Z>| {
            let centre = range.lo.plus(&range.hi)?.half();
            let half = range.hi.plus(&centre.negated()?)?;
            Some([Interval::point(centre), range.clone(), Interval::point(half)])
        };
        self.0.iter().map(edge).collect()
    }
}

/// A vertex of a cell: bit `k` is set where `lambda_k = 1`, else `lambda_k = -1`.
///
/// **Lemma (vertices).** Fix a point `x` of the cell and the parameters. There are weights
/// `w_v >= 0`, `sum_v w_v = 1`, the same for all formulas, with `f(x) = sum_v w_v f_v`, where
/// `f_v = f(c) + sum_k v_k S_k` and the `S_k` are those of `f` at `x`. *Proof.* `lambda` is a convex
/// combination of the vertices of `[-1, 1]^m`, and for fixed `x` what is summed is affine in it. ∎
///
/// Of a part of the cell, the hull of its corners, the vertices are these: what is said of the cell is true of
/// the part, by the same proof.
///
/// About a corner, `lambda` is in `[0, 1]^m`: of that part the vertices are [`unit_corners`].
///
/// So where a set of matrices is convex, and holds the matrices of all `f_v` in their enclosures
/// [`Slopes::at`](crate::slope::Slopes::at), it holds that of `f(x)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vertex(u32);

/// Binary places of the corners of a part of a cell.
pub const CORNER_PLACES: u32 = 16;

/// The corners of `[0, 1]^m`, in units of `2^-CORNER_PLACES`: bit `k` is set where `lambda_k = 1`.
pub fn unit_corners(m: usize) -> Vec<Vec<i64>> {
    let corner = |v: Vertex| (0..m).map(|k| i64::from(v.has(k)) << CORNER_PLACES).collect();
    Vertex::all(m).map(corner).collect()
}

impl Vertex {
    /// The vertices of a cell with `m` coordinates.
    pub fn all(m: usize) -> impl Iterator<Item = Vertex> {
        Vertex::first(1 << m)
    }

    /// The first `n`.
    pub fn first(n: usize) -> impl Iterator<Item = Vertex> {
        (0..n as u32).map(Vertex)
    }

    /// Its number.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// Whether bit `k` is set.
    pub fn has(self, k: usize) -> bool {
        self.0 >> k & 1 == 1
    }
}
