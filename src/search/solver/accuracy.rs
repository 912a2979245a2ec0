//! Accuracies: evidence, and along which coordinates they vary.
//!
//! With `kappa` given, what has to be positive definite is concave in `Y`, and a maximum of its least eigenvalue is
//! where `Y` is best for the vectors of the least ones together: see [`improved`].

use super::doubles::{middle, Pair};
use super::evidence::{At, Over};
use super::less::best;
use super::propose::FINE;
use super::rows::{above, exponent, in_places};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::accuracy::{self, Accuracy, Joint};

/// Weights that are tried.
const WEIGHTS: [u32; 5] = [0, 1, 2, 3, 5];
/// Parts of the least singular value tried as `kappa`.
const PARTS: [f64; 3] = [0.95, 0.8, 0.5];
/// Part of `b z^T/|z|^2` in the first `Y`.
const OWN: f64 = 0.3;
/// Sign vectors whose least eigenvalues are found: those of greatest `b^T T^-1 b`.
const WORST: usize = 2;
/// Part of `z^2` up to which an eigenvalue is near zero.
const NEAR: f64 = 0.5;
/// What is left of a `Y` that needs no improvement: of enclosures, more is lost.
const EASY: f64 = 0.1;
/// Steps in which `Y` is improved.
const STEPS: usize = 10;
/// How far the first step goes, by how much eigenvalues differ that count alike there, and what becomes of
/// both from step to step.
const STEP: [f64; 2] = [0.5, 0.9];
const ALIKE: [f64; 2] = [0.02, 0.8];
/// Weight of the first `Y` in later ones.
const FIRST: f64 = 1e-3;

/// What a test is about at a vertex, or control point: `V`, its weight, `D`, and `b`.
struct Point {
    v: DMatrix<f64>,
    weight: f64,
    d: DVector<f64>,
    b: DVector<f64>,
}

/// A first `Y`, and what it leaves at vertices or control points.
struct Start {
    p: u32,
    points: Vec<Point>,
    /// `V` at the centre, at control points `A`, and the least singular value of `V`.
    plain: DMatrix<f64>,
    least: f64,
    y: DMatrix<f64>,
    z: f64,
    margins: Vec<f64>,
    most: f64,
}

/// Evidence, and what it leaves.
struct Found {
    y: DMatrix<f64>,
    kappa: f64,
    margins: Vec<f64>,
    most: f64,
}

impl Point {
    fn t(&self, y: &DMatrix<f64>) -> DMatrix<f64> {
        let t = &self.v * y.transpose();
        &t + t.transpose() - y * y.transpose() * self.weight
    }

    /// The greatest `kappa^2` with which `T - kappa^2 D` is not negative.
    fn square(&self, y: &DMatrix<f64>) -> f64 {
        let mut t = self.t(y);
        for (i, d) in self.d.iter().enumerate() {
            t.row_mut(i).scale_mut(d.sqrt().recip());
            t.column_mut(i).scale_mut(d.sqrt().recip());
        }
        t.symmetric_eigenvalues().min()
    }

    /// `b` with the signs for which `b^T Q b` is greatest, these first.
    fn worst(&self, q: &DMatrix<f64>) -> Vec<DVector<f64>> {
        let n = self.b.len();
        let sign = |signs: usize, i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
        let value = |signs: usize| {
            let row = |i: usize| {
                let along = (0..n).map(|j| q[(i, j)] * sign(signs, j) * self.b[j]);
                sign(signs, i) * self.b[i] * along.sum::<f64>()
            };
            ((0..n).map(row).sum::<f64>(), signs)
        };
        let mut all: Vec<_> = (0..1usize << n.saturating_sub(1)).map(value).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let signed = |(_, signs)| DVector::from_fn(n, |i, _| sign(signs, i) * self.b[i]);
        all.into_iter().take(WORST).map(signed).collect()
    }

    /// The least eigenvalues of `[[T, b], [b^T, z^2]]` for the worst signs, near zero to first order, and the first parts
    /// of their vectors.
    fn bordered(&self, y: &DMatrix<f64>, z: f64) -> Vec<(f64, DVector<f64>)> {
        let t = self.t(y);
        let n = t.nrows();
        let corner = self.weight * z * z;
        let least = |b: DVector<f64>| {
            let entry = |i, j| match (i < n, j < n) {
                (true, true) => t[(i, j)],
                (false, false) => corner,
                _ => b[i.min(j)],
            };
            let eigen = SymmetricEigen::new(DMatrix::from_fn(n + 1, n + 1, entry));
            let k = eigen.eigenvalues.imin();
            (eigen.eigenvalues[k], eigen.eigenvectors.column(k).rows(0, n).into_owned())
        };
        let Some(own) = t.clone().cholesky() else {
            return self.worst(&DMatrix::identity(n, n)).into_iter().map(least).collect();
        };
        let near = |b: DVector<f64>| {
            let own = own.solve(&b);
            let rest = corner - own.dot(&b);
            let square = 1.0 + own.norm_squared();
            match rest.abs() < NEAR * corner {
                true => (rest / square, own / square.sqrt()),
                false => least(b),
            }
        };
        self.worst(&own.inverse()).into_iter().map(near).collect()
    }

    /// The least eigenvalue of all that has to be positive definite.
    fn margin(&self, y: &DMatrix<f64>, kappa: f64, z: f64) -> f64 {
        let least = self.t(y) - DMatrix::from_diagonal(&self.d) * kappa.powi(2);
        let least = least.symmetric_eigenvalues().min();
        self.bordered(y, z).iter().fold(least, |least, (x, _)| least.min(*x))
    }
}

/// `Y` with which the least eigenvalue, less `t_v`, is greater. For vectors `y` with weights `w` the sum of
/// `w y^T T y` is greatest with `(sum w y y^T) Y = sum w y y^T V`: steps go towards that, with weights that fall off from
/// the least eigenvalue on.
fn improved(points: &[Point], t: &[f64], first: &DMatrix<f64>, z: f64) -> DMatrix<f64> {
    let n = first.nrows();
    let (mut y, mut greatest) = (first.clone(), (f64::NEG_INFINITY, first.clone()));
    let ([mut step, slower], [mut alike, finer]) = (STEP, ALIKE);
    for _ in 0..STEPS {
        let mut all = Vec::new();
        for (point, t) in points.iter().zip(t) {
            let own = point.bordered(&y, z).into_iter();
            all.extend(own.map(|(x, vector)| (x - t, vector, point)));
        }
        let least = all.iter().fold(f64::INFINITY, |least, x| least.min(x.0));
        if least > greatest.0 {
            greatest = (least, y.clone());
        }
        let (mut left, mut right) = (DMatrix::identity(n, n) * FIRST, first * FIRST);
        for (x, vector, point) in &all {
            let square = vector * vector.transpose() * ((least - x) / alike).exp();
            left += &square * point.weight;
            right += square * &point.v;
        }
        let Some(target) = left.cholesky().map(|left| left.solve(&right)) else { break };
        y += (target - &y) * step;
        (step, alike) = (step * slower, alike * finer);
    }
    greatest.1
}

/// The greatest `kappa` with which no `T - kappa^2 D` is negative.
fn least(points: &[Point], y: &DMatrix<f64>) -> f64 {
    let squares = points.iter().map(|point| point.square(y));
    squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt()
}

impl Over<'_> {
    /// Evidence with the weight of the other part with which a first `Y` leaves most.
    pub(super) fn accuracy(&self, test: &Test, accuracy: &Accuracy) -> Option<Evidence> {
        let g = self.spread(accuracy, self.formulas.place.edges)?;
        let greatest = self.formulas.greatest(accuracy)?;
        let parts = accuracy.parts(accuracy.rows.len()).len();
        let weights = WEIGHTS.into_iter().take_while(|&p| p == 0 || parts == 2);
        let starts = weights.filter_map(|p| self.start(accuracy, (p, g), greatest.as_ref()));
        let starts: Vec<Start> = starts.collect();
        let shown = |p: u32, Found { y, kappa, margins, .. }: Found| {
            let with = |bits: i32| {
                // As many bits for kappa as for the greatest entry.
                let y = in_places(&y, (bits + above(&y)).max(bits - exponent(kappa)))?;
                let kappa = (kappa * f64::from(y.places).exp2()).floor();
                Some(Evidence::Accuracy(y, kappa as i64, p))
            };
            let margin = |v: Vertex| margins.get(v.index()).copied();
            let found = self.shown_with(test, &with(FINE)?, &margin)?;
            Some(self.shortened(test, found, with))
        };
        let most = starts.iter().max_by(|a, b| a.most.total_cmp(&b.most))?;
        let Start { p, points, y, z, margins, .. } = most;
        let first = self.found(points, y, g).filter(|found| found.most > EASY);
        let better = || {
            let mut t = vec![0.0; points.len()];
            for (_, g) in self.less() {
                if let Some((_, [low, high])) = best(margins, &g, 0.9) {
                    t = g.iter().map(|g| 0.5 * (low + high) * g).collect();
                }
            }
            self.found(points, &improved(points, &t, y, *z), g)
        };
        let found = first.or_else(better).filter(|found| found.most > 0.0);
        // `V` itself may be better where tolerances are wide.
        let plain = || {
            let mut each =
                starts.iter().take(parts).flat_map(|start| PARTS.map(|part| (start, part)));
            each.find_map(|(start, part)| {
                let found = self.with(&start.points, &start.plain, (part * start.least, g))?;
                (found.most > 0.0).then(|| shown(start.p, found))?
            })
        };
        found.and_then(|found| shown(*p, found)).or_else(plain)
    }

    /// `Y` between `V` at the centre, and at control points `A`, and `b z^T/|z|^2`, which loses nothing along the `b`
    /// that put the platform farthest there; none where that is too far.
    fn start(
        &self,
        test: &Accuracy,
        (p, g): (u32, f64),
        greatest: Option<&[Vec<Pair>; 2]>,
    ) -> Option<Start> {
        let (mut v, n) = (self.matrix(&test.rows, At::Centre)?, test.rows.len());
        let others = (0..n).filter(|k| !test.part.contains(k));
        others.for_each(|k| v.column_mut(k).scale_mut(f64::from(p).exp2()));
        let beta = |(error, all): &Joint| {
            let slope =
                |[half, by, _]: &[Formula; 3]| Some(self.centre(*half)? * self.centre(*by)?.abs());
            Some(self.centre(*error)? + all.iter().map(slope).sum::<Option<f64>>()?)
        };
        let b: Vec<f64> = test.joints.iter().map(beta).collect::<Option<_>>()?;
        let (d, b) = (DVector::repeat(n, 1.0), DVector::from_vec(b));
        let centre = Point { v, weight: 1.0, d, b };
        let b = centre.worst(&centre.t(&centre.v).try_inverse()?).into_iter().next()?;
        let z = centre.v.clone().lu().solve(&b).filter(|z| z.norm() < 1.0)?;
        let least_of_v = centre.v.singular_values().min();
        let mut y = &centre.v * (1.0 - OWN) + &b * z.transpose() * (OWN / z.norm_squared());
        let mut plain = centre.v;
        if self.formulas.controls.is_some() {
            for (i, leg) in self.problem().legs.iter().enumerate() {
                let root = self.centre(leg.row.d)?.sqrt();
                y.row_mut(i).scale_mut(root);
                plain.row_mut(i).scale_mut(root);
            }
        }
        let points = self.points(test, p, greatest)?;
        let z = 1.0 - 0.5 * g / least(&points, &y).max(g);
        let margins: Vec<f64> = points.iter().map(|point| point.margin(&y, 0.0, z)).collect();
        let most = self.most(&margins);
        Some(Start { p, points, plain, least: least_of_v, y, z, margins, most })
    }

    /// With the best of some `kappa`.
    fn found(&self, points: &[Point], y: &DMatrix<f64>, g: f64) -> Option<Found> {
        let least = least(points, y);
        let all = PARTS.into_iter().filter_map(|part| self.with(points, y, (part * least, g)));
        all.max_by(|a, b| a.most.total_cmp(&b.most))
    }

    fn with(&self, points: &[Point], y: &DMatrix<f64>, (kappa, g): (f64, f64)) -> Option<Found> {
        if kappa <= g {
            return None;
        }
        let z = 1.0 - 0.5 * g / kappa;
        let margins: Vec<f64> = points.iter().map(|point| point.margin(y, kappa, z)).collect();
        Some(Found { y: y.clone(), kappa, most: self.most(&margins), margins })
    }

    fn points(
        &self,
        test: &Accuracy,
        p: u32,
        greatest: Option<&[Vec<Pair>; 2]>,
    ) -> Option<Vec<Point>> {
        let point = |v| {
            let (rows, weight, d, b) = self.formulas.shown(test, (v, p), greatest)?;
            let n = rows.len();
            let entries = rows.iter().flat_map(|row| row.iter().map(middle));
            Some(Point {
                v: DMatrix::from_row_iterator(n, n, entries),
                weight: middle(&weight),
                d: DVector::from_iterator(n, d.iter().map(middle)),
                b: DVector::from_iterator(n, b.iter().map(|b| b.1)),
            })
        };
        self.formulas.vertices().map(point).collect()
    }

    /// By how much an accuracy's rows vary along each coordinate, and by how much less their spread near the box is
    /// of its halves, in proportion to what either loses. A spread is that of ranges, and may depend on a
    /// coordinate along which the rows do not vary: of a slider's, along its guide.
    pub(super) fn with_spread(&self, test: &Accuracy, rows: &[f64]) -> Option<Vec<f64>> {
        if test.turn.is_some() {
            return None;
        }
        let kappa = self.matrix(&test.rows, At::Centre)?.singular_values().min();
        let total = |all: &[f64]| Some(all.iter().sum::<f64>()).filter(|sum| *sum > 0.0);
        let along = total(rows)?;
        // Of the second order.
        let lost = 0.5 * (along / (kappa * rows.len() as f64)).powi(2);
        let edges = self.formulas.place.edges;
        // Undefined is worse than any spread.
        let spread = |edges: &[[Pair; 3]]| self.spread(test, edges).unwrap_or(2.0 * kappa);
        let at = |k: usize, by: f64| {
            let [centre, _, half] = edges[k];
            let half = (half.0 * by, half.1 * by);
            [centre, (centre.0 - half.1, centre.1 + half.1), half]
        };
        let with = |k: usize| {
            let mut halved = edges.to_vec();
            halved[k] = at(k, 0.5);
            halved
        };
        let own = spread(edges);
        let point: Vec<[Pair; 3]> = (0..edges.len()).map(|k| at(k, 0.0)).collect();
        let less: Vec<f64> = (0..edges.len()).map(|k| (own - spread(&with(k))).max(0.0)).collect();
        let wide = (own - spread(&point)).max(0.0) / (2.0 * kappa);
        let Some(sum) = total(&less) else { return Some(rows.to_vec()) };
        let both = rows.iter().zip(&less);
        Some(both.map(|(rows, less)| rows / along * lost + less / sum * wide).collect())
    }

    /// The spread of an accuracy near a box.
    fn spread(&self, test: &Accuracy, edges: &[[Pair; 3]]) -> Option<f64> {
        let (tape, slopes) = (&self.problem().tape, self.formulas.slopes);
        let of = |f| self.formulas.of(f).map(|slope| slope.range);
        let values = accuracy::near(tape, self.prover.parameters(), slopes, edges, test, of)?;
        accuracy::spread(slopes, &values, test).map(|g| g.1)
    }
}
