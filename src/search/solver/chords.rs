//! The one `Y` of a machine that is to be one to one.

use super::doubles::{middle, Pair, Single};
use super::rows::{above, are_moderate, rounded};
use nalgebra::{DMatrix, SymmetricEigen};
use orthocert_kernel::formula::{Formula, Values};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Multiplier;

/// Points of the grid along each coordinate, by their number.
const GRID: [usize; 6] = [33, 9, 5, 3, 2, 2];
/// The same of orientations, and of positions where rows are not affine in these.
const TURNED: [usize; 6] = [9, 7, 5, 3, 3, 3];
/// A point off the orientations of the claim is brought so much nearer to the middle at a time.
const NEARER: f64 = 0.95;
/// How often at most.
const MOST_NEARER: usize = 100;
/// Steps along subgradients.
const STEPS: u32 = 400;
/// The first step, of `Y` of norm one.
const FIRST: f64 = 0.3;
/// Bits of the greatest entry; of platforms that turn, whose columns differ in size.
const FINE: [i32; 2] = [14, 24];

/// `Y` with the least eigenvalue of `sym(Y^T A)` over a grid as great as is found; none unless a
/// machine is to be one to one.
pub fn common(problem: &Problem, root: &[Pair], parameters: &[Pair]) -> Option<Multiplier> {
    let rows = problem.obligations.iter().find_map(|o| match &o.test {
        Test::OneToOne(rows) => Some(rows),
        _ => None,
    })?;
    let (m, n, lengths) = (root.len(), rows.len(), problem.corners[0].len());
    let turns = problem.weight.is_some();
    let run = |x: &[f64]| {
        problem.tape.run(&Single, |k| x.get(k).copied(), |j| parameters.get(j).map(middle))
    };
    let matrix = |mut x: Vec<f64>| {
        let mut values = run(&x);
        let off = |values: &Values<f64>, g: Option<Formula>| {
            g.is_some_and(|g| values.of(g).is_none_or(|&g| g < 0.0))
        };
        let inside = problem.inside.as_ref().map(|inside| inside.g);
        if off(&values, inside) && !turns {
            return None;
        }
        // Sets of orientations contain, with each, those on the way to none.
        while off(&values, problem.turned) && x[lengths..].iter().any(|c| c.abs() > f64::EPSILON) {
            x[lengths..].iter_mut().for_each(|c| *c *= NEARER);
            values = run(&x);
        }
        // So do cylinders, on the way to their axis.
        for _ in 0..MOST_NEARER {
            if !off(&values, inside) {
                break;
            }
            for (x, (lo, hi)) in x[..lengths].iter_mut().zip(root).take(2) {
                let middle = 0.5 * (lo + hi);
                *x = middle + NEARER * (*x - middle);
            }
            values = run(&x);
        }
        let all = rows.iter().flat_map(|row| &row.a).map(|&f| values.of(f).copied());
        let all = all.collect::<Option<Vec<f64>>>().filter(|all| are_moderate(all))?;
        Some(DMatrix::from_row_slice(n, m, &all))
    };
    let affine = problem.legs.iter().all(|leg| leg.scaled.is_some());
    let points = |k: usize| match (turns, affine && k < lengths) {
        (false, _) => GRID.get(m - 1).copied(),
        (true, true) => Some(2),
        (true, false) => TURNED.get(m - 1).copied(),
    };
    let mut all = vec![Vec::new()];
    for (k, (lo, hi)) in root.iter().enumerate() {
        let points = points(k)?;
        let end = |i: usize| lo + i as f64 / (points - 1) as f64 * (hi - lo);
        let with = |x: Vec<f64>| (0..points).map(move |i| [x.as_slice(), &[end(i)]].concat());
        all = all.into_iter().flat_map(with).collect();
    }
    let mut all: Vec<DMatrix<f64>> = all.into_iter().filter_map(matrix).collect();
    if !turns {
        let y = best(&all)?;
        return rounded(&y, FINE[0] + above(&y));
    }
    // A^T A becomes I of the mean A, for columns of one size; Y is sought of these.
    let mean = all.iter().skip(1).fold(all.first()?.clone(), |sum, a| sum + a) / all.len() as f64;
    let inner = SymmetricEigen::new(mean.transpose() * mean);
    let size = inner.eigenvalues.map(|e| e.max(f64::MIN_POSITIVE).sqrt().recip());
    let even = &inner.eigenvectors * DMatrix::from_diagonal(&size) * inner.eigenvectors.transpose();
    all.iter_mut().for_each(|a| *a *= &even);
    let y = best(&all)? * even.try_inverse()?;
    rounded(&y, FINE[1] + above(&y))
}

fn best(all: &[DMatrix<f64>]) -> Option<DMatrix<f64>> {
    let mean = all.iter().skip(1).fold(all.first()?.clone(), |sum, a| sum + a);
    let mut y = mean.pseudo_inverse(1e-9).ok()?.transpose().normalize();
    let (mut best, mut value) = (y.clone(), f64::MIN);
    for step in 1..STEPS {
        // There is none along nothing.
        if !are_moderate(&y) {
            break;
        }
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
