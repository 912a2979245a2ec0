//! Columns of the inverse of `M`.

use super::tolerances::less_changes;
use super::{scalar, AtVertex, Over, Row, Varied};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{is_positive_definite, Triangle};
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
pub fn solve<E: Enclosure>(
    over: &Over<'_, E>,
    rows: &[Row<Formula>],
    test: &Solve,
    weight: AtVertex<'_, E::Number>,
    evidence: &Multiplier,
) -> bool {
    let e = over.slopes.arithmetic;
    let matrix = |v: Vertex, rows: &[Varied<E::Number>]| {
        let start = over.less_inside(e.integer(0)?, v)?;
        let a: Vec<&[E::Number]> = rows.iter().map(|(row, _)| row.a.as_slice()).collect();
        let mut t = below_square(e, &a, (&weight(v)?, &start), evidence)?;
        let square = &over.of(test.square)?.range;
        let [_, greatest] = e.ends(&rows.get(test.joint)?.0.d);
        let own = t.get_mut(test.joint)?.first_mut()?;
        *own = e.sub(own, &e.mul(square, &greatest)?)?;
        less_changed(over, t, rows, (test.joint, square), evidence)
    };
    let n = rows.len();
    evidence.is_of(n, n)
        && rows.iter().all(|row| row.a.len() == n)
        && over.at_vertices(rows, |v, rows| {
            matrix(v, &rows).is_some_and(|t| is_positive_definite(e, t))
        })
}

/// `A Y^T + Y A^T - w Y Y^T + c I`, as `(Y Z^T + Z Y^T)/2 + c I`, `Z = 2 A - w Y`.
pub(super) fn below_square<E: Enclosure>(
    e: &E,
    a: &[&[E::Number]],
    (weight, start): (&E::Number, &E::Number),
    Multiplier { y, places }: &Multiplier,
) -> Option<Triangle<E::Number>> {
    let zero = e.integer(0)?;
    let residual =
        |(a, &y): (&E::Number, &i64)| e.sub(&e.add(a, a)?, &e.dyadic(y, *places, weight)?);
    let row = |(a, y): (&&[E::Number], &Vec<i64>)| a.iter().zip(y).map(residual).collect();
    let z: Vec<Vec<E::Number>> = a.iter().zip(y).map(row).collect::<Option<_>>()?;
    let product = |y: &[i64], z: &[E::Number]| {
        y.iter()
            .zip(z)
            .try_fold(zero.clone(), |sum, (&y, z)| e.add(&sum, &e.dyadic(y, places + 1, z)?))
    };
    let mut t = scalar(e, a.len(), start)?;
    for ((i, entries), (z_i, y_i)) in t.iter_mut().enumerate().zip(z.iter().zip(y)) {
        for (entry, (z_j, y_j)) in entries.iter_mut().zip(z.iter().zip(y).skip(i)) {
            *entry = e.add(entry, &e.add(&product(y_j, z_i)?, &product(y_i, z_j)?)?)?;
        }
    }
    Some(t)
}

/// `T` less what tolerances change of it.
fn less_changed<E: Enclosure>(
    over: &Over<'_, E>,
    mut t: Triangle<E::Number>,
    rows: &[Varied<E::Number>],
    (joint, square): (usize, &E::Number),
    Multiplier { y, places }: &Multiplier,
) -> Option<Triangle<E::Number>> {
    let e = over.slopes.arithmetic;
    if over.tolerances.is_none() {
        return Some(t);
    }
    let zero = e.integer(0)?;
    let direction = over.direction(<[_]>::first)?;
    for (j, (_, changes)) in rows.iter().enumerate() {
        let change = |Row { a, d }: &Row<E::Number>| {
            let along = |y: &Vec<i64>| {
                let mut terms = y.iter().zip(a);
                terms.try_fold(zero.clone(), |sum, (&y, a)| e.add(&sum, &e.dyadic(y, *places, a)?))
            };
            let mut s: Vec<E::Number> = y.iter().map(along).collect::<Option<_>>()?;
            if j == joint {
                let own = s.get_mut(j)?;
                *own = e.sub(own, &e.halve(&e.mul(square, d)?)?)?;
            }
            Some(s)
        };
        let changes: Vec<_> = changes.iter().map(change).collect::<Option<_>>()?;
        let mut fixed = vec![zero.clone(); y.len()];
        *fixed.get_mut(j)? = e.integer(1)?;
        t = less_changes(e, t, &fixed, &changes, &direction)?;
    }
    Some(t)
}
