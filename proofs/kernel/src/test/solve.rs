//! Columns of the inverse of `M`.

use super::tolerances::{less_changes, Change, Directions};
use super::{AtVertex, Over, Row, Varied};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{is_positive_definite, Triangle, Vector};
use crate::formula::Formula;
use crate::test::Multiplier;

/// `|M^-1 e_i| <= 1/k`, `M` with as many rows as columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Solve {
    /// `i`, counted from zero.
    pub joint: usize,
    /// `k^2`.
    pub square: Formula,
}

impl<E: Enclosure> Over<'_, E> {
    /// **Column of the inverse.** If all `D_j > 0` on the cell, and `T = A Y^T + Y A^T - Y Y^T - k^2 D_i e_i e_i^T`
    /// (with the workspace's own inequality, less `t_v I`) is positive definite at the vertices, for any one
    /// matrix `Y`, then `M` is regular on the cell and `|M^-1 e_i| < 1/k`.
    ///
    /// *Proof.* `T` is affine in `(A, D_i)`, so it is positive definite at `x`. From
    /// `(A - Y)(A - Y)^T >= 0` follows `A A^T >= A Y^T + Y A^T - Y Y^T`, so `A A^T - k^2 b b^T` is positive
    /// definite too, with `b = B_i e_i`: `A A^T` is, and `k^2 b^T (A A^T)^-1 b < 1`, where
    /// `b^T (A A^T)^-1 b = |A^-1 b|^2` and `A^-1 b = A^-1 B e_i = M^-1 e_i`. ∎ `T` decreases with `D_i`, which
    /// is taken at its upper end. With `A_v A_v^T` in the place of its bound it would be unsound: the inverse
    /// of a convex combination may be greater than those of all its parts (`A = -1` and `1`).
    ///
    /// Of scaled rows `(w A, w D)` it is `w T = (w A) Y^T + Y (w A)^T - w Y Y^T - k^2 (w D_i) e_i e_i^T`, affine
    /// in them and in the weight `w`; else `w = 1`.
    ///
    /// Where tolerances are apart, row `j` changes `T` by `e_j s^T + s e_j^T`, `s = Y a` of the change `(a, d)`,
    /// less `k^2 d/2` in component `i` if `j = i`.
    pub fn solve(
        &self,
        rows: &[Row<Formula>],
        test: &Solve,
        weight: AtVertex<'_, E::Number>,
        evidence: &Multiplier,
    ) -> bool {
        let e = self.slopes.arithmetic;
        let n = rows.len();
        let holds = |v: Vertex| {
            let start = self.less_inside(e.integer(0)?, v)?;
            let own: Vec<Varied<_>> = rows
                .iter()
                .enumerate()
                .map(|(i, row)| self.row(i, row, v))
                .collect::<Option<_>>()?;
            let a: Vec<&[E::Number]> = own.iter().map(|(row, _)| &row[..n]).collect();
            let mut t = below_square(e, &a, (&weight(v)?, &start), evidence)?;
            let square = &self.of(test.square)?.range;
            let [_, greatest] = e.ends(own.get(test.joint)?.0.last()?);
            t.change(|i, j, entry| match i == j && i == test.joint {
                true => e.sub(entry, &e.mul(square, &greatest)?),
                false => Some(entry.clone()),
            })?;
            self.less_changed(&mut t, &own, (test.joint, square), evidence)?;
            Some(is_positive_definite(e, &t))
        };
        let is_square = rows.iter().all(|row| row.a.len() == n);
        evidence.is_of(n, n) && is_square && self.at_vertices(rows, holds)
    }

    /// `T` less what tolerances change of it.
    fn less_changed(
        &self,
        t: &mut Triangle<E::Number>,
        rows: &[Varied<E::Number>],
        (joint, square): (usize, &E::Number),
        Multiplier { y, places }: &Multiplier,
    ) -> Option<()> {
        if self.tolerances.is_none() {
            return Some(());
        }
        let e = self.slopes.arithmetic;
        let direction = self.toward(<[_]>::first)?.direction;
        for (j, (_, changes)) in rows.iter().enumerate() {
            let change = |change: &Change<E::Number>| {
                let (d, a) = change.s.split_last()?;
                let all = y.iter().map(|y| along(e, y, *places, a));
                let mut s: Vector<E::Number> = all.collect::<Option<_>>()?;
                if j == joint {
                    let own = s.get_mut(j)?;
                    *own = e.sub(own, &e.halve(&e.mul(square, d)?)?)?;
                }
                change.of(s, |_| None)
            };
            let changes: Vec<_> = changes.iter().map(change).collect::<Option<_>>()?;
            let fixed = (0..y.len()).map(|k| e.integer((k == j).into()));
            let fixed: Vector<E::Number> = fixed.collect::<Option<_>>()?;
            let directions = Directions { along: &direction, across: None, first: 0 };
            less_changes(e, t, &fixed, &changes, &directions)?;
        }
        Some(())
    }
}

/// `A Y^T + Y A^T - w Y Y^T + c I`, as `(Y Z^T + Z Y^T)/2 + c I`, `Z = 2 A - w Y`.
pub(super) fn below_square<E: Enclosure>(
    e: &E,
    a: &[&[E::Number]],
    (weight, start): (&E::Number, &E::Number),
    Multiplier { y, places }: &Multiplier,
) -> Option<Triangle<E::Number>> {
    let residual =
        |(a, &y): (&E::Number, &i64)| e.sub(&e.add(a, a)?, &e.dyadic(y, *places, weight)?);
    let row = |(a, y): (&&[E::Number], &Vec<i64>)| a.iter().zip(y).map(residual).collect();
    let z: Vec<Vector<E::Number>> = a.iter().zip(y).map(row).collect::<Option<_>>()?;
    let product = |i: usize, j: usize| along(e, &y[i], places + 1, &z[j]);
    let mut t = Triangle::scalar(e, a.len(), start)?;
    t.change(|i, j, entry| e.add(entry, &e.add(&product(j, i)?, &product(i, j)?)?))?;
    Some(t)
}

/// `Y_i . x`.
fn along<E: Enclosure>(e: &E, y: &[i64], places: u32, x: &[E::Number]) -> Option<E::Number> {
    e.sum(y.iter().zip(x).map(|(&y, x)| e.dyadic(y, places, x)))
}
