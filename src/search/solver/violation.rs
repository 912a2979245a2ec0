//! How far from holding a test is at a place, and along which direction.

use super::directions::{ends, nearest};
use super::sample::At;
use nalgebra::{DMatrix, DVector, DVectorView, SymmetricEigen, Vector3};
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::test::accuracy::Accuracy;
use orthocert_kernel::test::apart::Apart;
use orthocert_kernel::test::curvature::Curvature;
use orthocert_kernel::test::solve::Solve;
use orthocert_kernel::test::Row;

fn matrix(at: &At, rows: &[Vec<Formula>]) -> Option<DMatrix<f64>> {
    let all: Option<Vec<f64>> = rows.iter().flatten().map(|&f| at.of(f)).collect();
    let columns = rows.first().map_or(0, Vec::len);
    let m = DMatrix::from_row_slice(rows.len(), columns, &all?);
    m.iter().all(|x| x.is_finite()).then_some(m)
}

/// `D^(-1/2) A`, where all of it is defined.
pub fn divided<'r>(
    at: &At,
    rows: impl ExactSizeIterator<Item = &'r Row<Formula>>,
) -> Option<DMatrix<f64>> {
    let (n, mut all, mut m) = (rows.len(), Vec::new(), 0);
    for row in rows {
        let root = at.of(row.d).filter(|&d| d > 0.0)?.sqrt();
        m = row.a.len();
        for &a in &row.a {
            all.push(at.of(a).map(|a| a / root).filter(|x| x.is_finite())?);
        }
    }
    Some(DMatrix::from_row_slice(n, m, &all))
}

/// Rotations of all pairs of columns after which they are orthogonal, nearly always.
const SWEEPS: usize = 12;

/// The least and the greatest singular value, by rotations that make columns orthogonal (Hestenes).
pub fn extremes(mut m: DMatrix<f64>) -> [f64; 2] {
    let (n, columns) = m.shape();
    let all = m.as_mut_slice();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for q in 1..columns {
            for p in 0..q {
                let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
                for i in 0..n {
                    let (x, y) = (all[p * n + i], all[q * n + i]);
                    (a, b, c) = (a + x * x, b + y * y, c + x * y);
                }
                if c * c <= f64::EPSILON * f64::EPSILON * a * b {
                    continue;
                }
                rotated = true;
                let zeta = (b - a) / (2.0 * c);
                let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let cos = 1.0 / (1.0 + t * t).sqrt();
                let sin = cos * t;
                for i in 0..n {
                    let (x, y) = (all[p * n + i], all[q * n + i]);
                    (all[p * n + i], all[q * n + i]) = (cos * x - sin * y, sin * x + cos * y);
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let norm = |column: &[f64]| column.iter().map(|x| x * x).sum::<f64>().sqrt();
    let norms = all.chunks(n.max(1)).map(norm);
    norms.fold([f64::INFINITY, 0.0], |[least, most], x| [least.min(x), most.max(x)])
}

/// The right singular vector of the greatest, or the least singular value.
pub fn singular(m: &DMatrix<f64>, greatest: bool) -> Option<DVector<f64>> {
    let svd = m.clone().svd(false, true);
    let xi = svd.singular_values;
    let at = if greatest { xi.imax() } else { xi.imin() };
    Some(svd.v_t?.row(at).transpose())
}

/// `M^-1 e_i`.
pub fn solved(at: &At, legs: &[Leg], solve: &Solve) -> Option<DVector<f64>> {
    let mut unit = DVector::zeros(legs.len());
    *unit.get_mut(solve.joint)? = 1.0;
    divided(at, legs.iter().map(|leg| &leg.row))?.lu().solve(&unit)
}

/// `v = A^-T z` for `z = M^-1 e_i`: `B_i v_i = |z|^2`, and `|A^T v| = |z|`.
pub fn unsolved(at: &At, legs: &[Leg], solve: &Solve) -> Option<DVector<f64>> {
    let a: Vec<Vec<Formula>> = legs.iter().map(|leg| leg.row.a.clone()).collect();
    matrix(at, &a)?.transpose().lu().solve(&solved(at, legs, solve)?)
}

/// `W^-1 b` for the joint errors with which a test's part of it is longest, to first order: `b_i` is what the joint of
/// the machine in the middle of the tolerances has more than this one's, and the error.
pub fn displaced(at: &At, legs: &[Leg], test: &Accuracy) -> Option<DVector<f64>> {
    let inverse = matrix(at, &test.rows)?.try_inverse()?;
    let d = at.of(test.distance)?;
    let off = |leg: &Leg| {
        let by = match leg.rho? {
            Joint::Length(rho) => at.nominal(rho)? - at.of(rho)?,
            Joint::Angle { cos, sin } => {
                let (c, s) = (at.nominal(cos)?, at.nominal(sin)?);
                let (c2, s2) = (at.of(cos)?, at.of(sin)?);
                (s * c2 - c * s2).atan2(c * c2 + s * s2)
            }
        };
        Some(by / d)
    };
    let off: Vec<f64> = legs.iter().map(off).collect::<Option<_>>()?;
    let errors = test.joints.iter().map(|(error, _)| at.of(*error));
    let errors: Vec<f64> = errors.collect::<Option<_>>()?;
    let n = errors.len();
    let with = |signs: usize| {
        let b = |i: usize| off[i] + if signs >> i & 1 == 1 { errors[i] } else { -errors[i] };
        &inverse * DVector::from_fn(n, |i, _| b(i))
    };
    let all = (0..1usize << n).map(with);
    let own = |u: &DVector<f64>| part(u, test).norm();
    all.max_by(|a, b| own(a).total_cmp(&own(b)))
}

/// The signs with which joint coordinates off by `beta` put a test's part farthest, to first order.
pub fn farthest(at: &At, test: &Accuracy, beta: &[f64]) -> Option<Vec<f64>> {
    let inverse = matrix(at, &test.rows)?.try_inverse()?;
    let n = beta.len();
    let signs = |signs: usize| -> Vec<f64> {
        (0..n).map(|i| if signs >> i & 1 == 1 { -1.0 } else { 1.0 }).collect()
    };
    let off = |signs: &Vec<f64>| {
        let u = &inverse * DVector::from_fn(n, |i, _| signs[i] * beta[i]);
        part(&u, test).norm()
    };
    // All signs the other way are as far.
    let all = (0..1usize << n.checked_sub(1)?).map(signs);
    all.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// The part of `u` that a test is about.
pub fn part<'u>(u: &'u DVector<f64>, test: &Accuracy) -> DVectorView<'u, f64> {
    u.rows(test.part.start, test.part.len())
}

/// `v = W^-T u` for `u` along that part: `v . b` is its length, and `|W^T v| = 1`.
pub fn far(at: &At, legs: &[Leg], test: &Accuracy) -> Option<DVector<f64>> {
    let mut u = displaced(at, legs, test)?;
    u.iter_mut().enumerate().filter(|(k, _)| !test.part.contains(k)).for_each(|(_, u)| *u = 0.0);
    matrix(at, &test.rows)?.transpose().lu().solve(&u)
}

/// The weights of the nearest points of two segments, and the vector between them.
pub fn between(at: &At, test: &Apart) -> Option<([f64; 2], Vector3<f64>)> {
    let [p, q] = ends(test, |f| at.of(f))?;
    Some(nearest(p, q))
}

/// The nearest points themselves.
pub fn nearest_points(at: &At, test: &Apart) -> Option<[Vector3<f64>; 2]> {
    let [p, q] = ends(test, |f| at.of(f))?;
    let ([s, t], _) = nearest(p, q);
    Some([p[0] + (p[1] - p[0]) * s, q[0] + (q[1] - q[0]) * t])
}

/// `a |row| + b |H|`, and the eigenvector of `H` of greatest absolute eigenvalue.
pub fn curved(
    test: &Curvature,
    of: impl Fn(Formula) -> Option<f64>,
) -> Option<(f64, DVector<f64>)> {
    let row: Vec<f64> = test.row.iter().map(|&f| of(f)).collect::<Option<_>>()?;
    let n = row.len();
    let mut h = DMatrix::zeros(n, n);
    for (i, entries) in test.twice.iter().enumerate() {
        for (j, &f) in (i..).zip(entries) {
            let half = 0.5 * of(f)?;
            (h[(i, j)], h[(j, i)]) = (half, half);
        }
    }
    if !h.iter().all(|x: &f64| x.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::new(h);
    let greatest = eigen.eigenvalues.iamax();
    let sum = of(test.a)? * DVector::from_vec(row).norm()
        + of(test.b)? * eigen.eigenvalues[greatest].abs();
    Some((sum, eigen.eigenvectors.column(greatest).into_owned()))
}
