//! Solutions of linear equations.

use super::tolerances::less_changes;
use super::{scalar, Multiplier, Over};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{is_positive_definite, Triangle};
use crate::formula::Formula;

/// `|A^-1 b| <= c`, `A` with as many rows as columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Solve {
    /// The rows of `A`.
    pub a: Vec<Vec<Formula>>,
    /// `b`.
    pub b: Vec<Formula>,
    /// `c^2`.
    pub square: Formula,
}

/// **Solution.** If `T = [[A Y^T + Y A^T - Y Y^T, b], [b^T, c^2]]` is positive definite at the vertices,
/// for any one matrix `Y`, then `A` is regular on the cell and `|A^-1 b| < c`.
///
/// *Proof.* `T` is affine in `(A, b)`, so it is positive definite at `x`. From
/// `(A - Y)(A - Y)^T >= 0` follows `A A^T >= A Y^T + Y A^T - Y Y^T`, so `[[A A^T, b], [b^T, c^2]]` is
/// positive definite too: `A A^T` is, and `c^2 - b^T (A A^T)^-1 b = c^2 - |A^-1 b|^2 > 0`. ∎ With
/// `A_v A_v^T` in the place of its bound it would be unsound: the inverse of a convex combination may
/// be greater than those of all its parts (`A = -1` and `1`).
///
/// Where tolerances are apart, row `i` of `(A, b)` changes `T` by `e_i s^T + s e_i^T`, `s = (Y a, b)` of
/// the change `(a, b)`.
pub fn solve<E: Enclosure>(over: &Over<'_, E>, test: &Solve, evidence: &Multiplier) -> bool {
    let e = over.slopes.arithmetic;
    let matrix = |v: Vertex| {
        let at = |f: &Formula| over.at(*f, v);
        let b: Vec<E::Number> = test.b.iter().map(at).collect::<Option<_>>()?;
        let start = over.less_inside(e.integer(0)?, v)?;
        let square = e.add(&over.of(test.square)?.range, &start)?;
        let below = below_square(over, &test.a, v, evidence)?;
        less_changed(over, bordered(below, &b, square), test, (v, evidence))
    };
    let n = test.a.len();
    test.b.len() == n
        && evidence.is_of(n, n)
        && test.a.iter().all(|row| row.len() == n)
        && Vertex::all(over.slopes.m).all(|v| matrix(v).is_some_and(|t| is_positive_definite(e, t)))
}

/// `A Y^T + Y A^T - Y Y^T`, less the workspace's own inequality, at a vertex: as `(Y Z^T + Z Y^T)/2`,
/// `Z = 2 A - Y`.
pub(super) fn below_square<E: Enclosure>(
    over: &Over<'_, E>,
    a: &[Vec<Formula>],
    vertex: Vertex,
    Multiplier { y, places }: &Multiplier,
) -> Option<Triangle<E::Number>> {
    let e = over.slopes.arithmetic;
    let (zero, one) = (e.integer(0)?, e.integer(1)?);
    let residual = |(f, &y): (&Formula, &i64)| {
        let a = over.at(*f, vertex)?;
        e.sub(&e.add(&a, &a)?, &e.dyadic(y, *places, &one)?)
    };
    let row = |(a, y): (&Vec<Formula>, &Vec<i64>)| a.iter().zip(y).map(residual).collect();
    let z: Vec<Vec<E::Number>> = a.iter().zip(y).map(row).collect::<Option<_>>()?;
    let product = |y: &[i64], z: &[E::Number]| {
        y.iter()
            .zip(z)
            .try_fold(zero.clone(), |sum, (&y, z)| e.add(&sum, &e.dyadic(y, places + 1, z)?))
    };
    let mut t = scalar(e, a.len(), &over.less_inside(zero.clone(), vertex)?)?;
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
    test: &Solve,
    (vertex, Multiplier { y, places }): (Vertex, &Multiplier),
) -> Option<Triangle<E::Number>> {
    let e = over.slopes.arithmetic;
    if over.tolerances.is_none() {
        return Some(t);
    }
    let zero = e.integer(0)?;
    let direction = over.direction(<[_]>::first)?;
    for (i, (row, &b)) in test.a.iter().zip(&test.b).enumerate() {
        let formulas: Vec<Formula> = row.iter().copied().chain([b]).collect();
        let change = |mut s: Vec<E::Number>| {
            let b = s.pop()?;
            let along = |y: &Vec<i64>| {
                let mut terms = y.iter().zip(&s);
                terms.try_fold(zero.clone(), |sum, (&y, a)| e.add(&sum, &e.dyadic(y, *places, a)?))
            };
            y.iter().map(along).chain([Some(b)]).collect::<Option<Vec<_>>>()
        };
        let changes = over.changes(&formulas, vertex)?.into_iter().map(change);
        let changes: Vec<_> = changes.collect::<Option<_>>()?;
        let mut fixed = vec![zero.clone(); y.len() + 1];
        *fixed.get_mut(i)? = e.integer(1)?;
        t = less_changes(e, t, &fixed, &changes, &direction)?;
    }
    Some(t)
}

/// `[[T, b], [b^T, c]]`.
pub(super) fn bordered<N: Clone>(mut t: Triangle<N>, b: &[N], c: N) -> Triangle<N> {
    t.iter_mut().zip(b).for_each(|(row, b)| row.push(b.clone()));
    t.push(vec![c]);
    t
}
