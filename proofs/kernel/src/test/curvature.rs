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
    /// `K^2`, that depends on no coordinate, and `s` with `|row|^2 = K^2 - s^2`, where these are known.
    pub lever: Option<[Formula; 2]>,
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
    ///
    /// **Lever.** Where `|row|^2 = K^2 - s^2`, the same holds with `(K^2 - s_0 s_v)/sqrt(K^2 - s_0^2)` in the place of `|row_v|` at
    /// all vertices, for any number `s_0` with `s_0^2 < K^2`: here, of `s` at the centre. *Proof.*
    /// `(K^2 - s_0 s)^2 - (K^2 - s^2)(K^2 - s_0^2) = K^2 (s - s_0)^2 >= 0`, and `K^2 - s_0 s > 0`, so that `|row| sqrt(K^2 - s_0^2) <= K^2 - s_0 s`,
    /// of which the right-hand side is affine in `s`. ∎ Where a row is longest `s` is 0, and nothing is lost. At each vertex the
    /// lesser of both would be unsound: the first is convex, the second is above `|row|` by as much as it is affine.
    pub fn curvature(&self, test: &Curvature) -> bool {
        let e = self.slopes.arithmetic;
        let at = |v: Vertex, f: &Formula| self.slopes.at(self.of(*f)?, v);
        let longest = |v: Vertex, lever: Option<[Formula; 2]>| {
            let Some([square, s]) = lever else {
                return e.greatest_root(&e.sum(test.row.iter().map(|f| e.sqr(&at(v, f)?)))?);
            };
            let [square, centre] = [&self.of(square)?.range, &self.of(s)?.at_centre];
            let [centre, _] = e.ends(centre);
            let root = e.sqrt(&e.sub(square, &e.sqr(&centre)?)?)?;
            e.div(&e.sub(square, &e.mul(&centre, &at(v, &s)?)?)?, &root)
        };
        let holds = |v: Vertex, lever| {
            let row = longest(v, lever)?;
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
        let all = |lever| self.vertices().all(|v| holds(v, lever) == Some(true));
        all(None) || (test.lever.is_some() && all(test.lever))
    }
}
