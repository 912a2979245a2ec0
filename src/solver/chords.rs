//! The one `Y` of a machine that is to be one to one.

use super::doubles::{middle, Pair, Single};
use super::rows::{above, rounded};
use nalgebra::{DMatrix, SymmetricEigen};
use orthocert_kernel::formula::Op;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Multiplier;

/// Points of the grid along each coordinate, by their number.
const GRID: [usize; 6] = [33, 9, 5, 3, 2, 2];
/// Steps along subgradients.
const STEPS: u32 = 400;
/// The first step, of `Y` of norm one.
const FIRST: f64 = 0.3;
/// Bits of the greatest entry.
const FINE: i32 = 14;

/// `Y` with the least eigenvalue of `sym(Y^T A)` over a grid as great as is found; none unless a
/// machine is to be one to one.
pub fn common(problem: &Problem, root: &[Pair], parameters: &[Pair]) -> Option<Multiplier> {
    let rows = problem.obligations.iter().find_map(|o| match &o.test {
        Test::OneToOne(rows) => Some(rows),
        _ => None,
    })?;
    let (m, n) = (root.len(), rows.len());
    let matrix = |x: &[f64]| {
        let values = problem.tape.run(&Single, |op| match op {
            Op::Coordinate(k) => x.get(k).copied(),
            Op::Parameter(j) => parameters.get(j).map(middle),
            _ => None,
        });
        let inside = problem.inside.as_ref().map(|inside| inside.g);
        if inside.is_some_and(|g| values.of(g).is_none_or(|&g| g < 0.0)) {
            return None;
        }
        let all = rows.iter().flat_map(|row| &row.a).map(|&f| values.of(f).copied());
        Some(DMatrix::from_row_slice(n, m, &all.collect::<Option<Vec<f64>>>()?))
    };
    let points = *GRID.get(m.checked_sub(1)?)?;
    let part = |i: usize, k: u32| (i / points.pow(k) % points) as f64 / (points - 1) as f64;
    let at = |i: usize| -> Vec<f64> {
        let edges = root.iter().zip(0..);
        edges.map(|((lo, hi), k)| lo + part(i, k) * (hi - lo)).collect()
    };
    let all: Vec<DMatrix<f64>> = (0..points.pow(m as u32)).filter_map(|i| matrix(&at(i))).collect();
    let y = best(&all)?;
    rounded(&y, FINE + above(&y))
}

fn best(all: &[DMatrix<f64>]) -> Option<DMatrix<f64>> {
    let mean = all.iter().skip(1).fold(all.first()?.clone(), |sum, a| sum + a);
    let mut y = mean.pseudo_inverse(1e-9).ok()?.transpose().normalize();
    let (mut best, mut value) = (y.clone(), f64::MIN);
    for step in 1..STEPS {
        let eigen = |a: &DMatrix<f64>| {
            let t = y.transpose() * a;
            SymmetricEigen::new(&t + t.transpose())
        };
        let each = all.iter().map(|a| (eigen(a), a));
        let (e, a) = each.min_by(|p, q| p.0.eigenvalues.min().total_cmp(&q.0.eigenvalues.min()))?;
        if e.eigenvalues.min() > value {
            (best, value) = (y.clone(), e.eigenvalues.min());
        }
        let v = e.eigenvectors.column(e.eigenvalues.imin());
        y += (a * v * v.transpose()).normalize() * (FIRST / f64::from(step));
        y = y.normalize();
    }
    Some(best)
}
