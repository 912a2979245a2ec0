//! A weighted sum of the norms of a row and of a symmetric matrix.

use super::Over;
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{is_positive_definite, Triangle};
use crate::formula::Formula;

/// `a |row| + b |H| <= 1`, with `a, b >= 0` that depend on no coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Curvature {
    /// The row.
    pub row: Vec<Formula>,
    /// The upper triangle of `2 H`.
    pub twice: Vec<Vec<Formula>>,
    /// `a`.
    pub a: Formula,
    /// `b`.
    pub b: Formula,
}

impl<E: Enclosure> Over<'_, E> {
    /// **Row and matrix.** If `(1 - a |row_v|) I + b H_v` and `(1 - a |row_v|) I - b H_v` are positive
    /// definite at the vertices `v`, then `a |row| + b |H| < 1` on the cell.
    ///
    /// *Proof.* At each vertex `a |row_v| + b |H_v| < 1`, `|H_v|` the greatest absolute value of an
    /// eigenvalue. Both norms are convex, so with the weights of [`Vertex`],
    /// `a |row(x)| + b |H(x)| <= sum_v w_v (a |row_v| + b |H_v|) < 1`. ∎ With the workspace's own
    /// inequality `t`, less `t_v` at each. One of the two matrices alone would bound one end of the
    /// eigenvalues of `H` only.
    pub fn curvature(&self, test: &Curvature) -> bool {
        let e = self.slopes.arithmetic;
        let at = |v: Vertex, f: &Formula| self.slopes.at(self.of(*f)?, v);
        let holds = |v: Vertex| {
            let row = e.greatest_root(&e.sum(test.row.iter().map(|f| e.sqr(&at(v, f)?)))?)?;
            let rest = e.sub(&e.integer(1)?, &e.mul(&self.of(test.a)?.range, &row)?)?;
            let start = Triangle::scalar(e, test.row.len(), &self.less_inside(rest, v)?)?;
            let b = e.halve(&self.of(test.b)?.range)?;
            let is_definite = |b: &E::Number| {
                let mut t = start.clone();
                t.change(|i, j, t| e.add(t, &e.mul(b, &at(v, test.twice.get(i)?.get(j - i)?)?)?))?;
                Some(is_positive_definite(e, &t))
            };
            Some(is_definite(&b)? && is_definite(&e.neg(&b)?)?)
        };
        self.vertices().all(|v| holds(v) == Some(true))
    }
}
