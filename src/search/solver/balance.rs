//! A condition number at control points: what stands between its two bounds, so that most is left of both.
//!
//! With `Y` given, both tests are of matrices less a multiple of the identity, and that is affine in `mu` and in the multiples
//! of the workspace's inequalities: what is left at a control point is an eigenvalue less an affine function, and the best
//! of these are a linear program, of few unknowns.

use super::evidence::{At, Over};
use super::less::With;
use super::rows::{between, Form};
use nalgebra::{DMatrix, DVector};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;

/// Steps of Newton's method at most.
const STEPS: usize = 60;
/// A step stays within so much of what is allowed.
const WITHIN: f64 = 0.95;
/// By how much the barrier is lessened once its least point is near.
const LESSENED: f64 = 10.0;
/// How much of what is left may be lost to multiples of few places.
const LOST: f64 = 0.5;

/// A control point.
struct Point {
    vertex: Vertex,
    /// Of `mu`: the weight, that at the centre being 1, and the coordinates between -1 and 1.
    terms: Vec<f64>,
    /// The inequalities, of greatest absolute value 1.
    g: Vec<f64>,
    /// The square of the greatest singular value of the scaled rows, over `c^2`.
    upper: f64,
    /// Whether the square of no coordinate of position is less than between the ends: there the lower bound is hardest.
    at_ends: bool,
}

/// What does not depend on `Y`.
pub struct Balance {
    points: Vec<Point>,
    c_squared: f64,
    /// At the centre.
    weight: f64,
    /// About the size of all.
    size: f64,
    less: Vec<(With, f64)>,
}

/// Of both bounds most is left with these.
pub struct Best {
    /// `mu_0, .., mu_m`.
    pub mu: Vec<f64>,
    multiples: Vec<(With, [f64; 2])>,
}

impl Best {
    /// The evidence with what is taken of the inequalities.
    pub fn less(&self, evidence: Evidence) -> Option<Evidence> {
        self.multiples.iter().try_fold(evidence, |evidence, &(with, [low, high])| {
            let (n, places) = between(low, high)?;
            Some(if n == 0 { evidence } else { with(Box::new(evidence), n, places) })
        })
    }
}

impl Balance {
    /// At the control points of a box, about a first `mu` at the centre.
    pub fn new(over: &Over<'_>, c_squared: f64, mu: f64) -> Option<Self> {
        let weight = over.problem().weight?;
        let centre = over.centre(weight)?;
        let less = over.less();
        let sizes: Vec<f64> = less
            .iter()
            .map(|(_, g)| g.iter().fold(0.0, |size: f64, g| size.max(g.abs())))
            .collect();
        let lengths = over.problem().corners[0].len();
        let point = |vertex| {
            let at = At::Vertex(vertex);
            let places: Vec<_> = (0..over.m()).map(|k| over.formulas.place(k, vertex)).collect();
            let own = places.iter().map(|place| place.unwrap_or(0) as f64);
            let terms = [over.at(weight, at)? / centre].into_iter().chain(own).collect();
            let g =
                less.iter().zip(&sizes).map(|((_, g), size)| g[vertex.index()] / size).collect();
            let upper =
                over.own(Form::Scaled, at)?.square().symmetric_eigenvalues().max() / c_squared;
            let at_ends = places.iter().take(lengths).all(|&place| place != Some(0));
            Some(Point { vertex, terms, g, upper, at_ends })
        };
        let points = over.formulas.vertices().map(point).collect::<Option<Vec<_>>>()?;
        let less = less.into_iter().zip(sizes).map(|((with, _), size)| (with, size)).collect();
        Some(Balance { points, c_squared, weight: centre, size: mu * centre, less })
    }

    /// With one `Y`; `None` where nothing would be left.
    pub fn best(&self, over: &Over<'_>, y: &DMatrix<f64>) -> Option<Best> {
        let terms = self.points.first()?.terms.len();
        let part = |point: &Point, sign: f64, by: f64| {
            let own = point.terms.iter().map(|t| sign * t);
            own.chain(point.g.iter().map(|g| -by * g)).collect::<Vec<f64>>()
        };
        let mut rows = Vec::new();
        for point in &self.points {
            rows.push((-point.upper / self.size, part(point, 1.0, self.c_squared.recip())));
            if point.at_ends {
                let rows_there = over.own(Form::Scaled, At::Vertex(point.vertex))?;
                let lower = rows_there.minorant(y).symmetric_eigenvalues().min();
                rows.push((lower / self.size, part(point, -1.0, 1.0)));
            }
        }
        let (p, left) = most(&rows, terms)?;
        let mut mu: Vec<f64> = p.iter().take(terms).map(|p| self.size * p).collect();
        mu[0] /= self.weight;
        let lost = LOST * left / self.less.len().max(1) as f64;
        let multiple = |(&p, &(with, size)): (&f64, &(With, f64))| {
            let at = |p: f64| p.max(0.0) * self.size / size;
            (with, [at(p - lost), at(p + lost)])
        };
        let multiples = p.iter().skip(terms).zip(&self.less).map(multiple).collect();
        Some(Best { mu, multiples })
    }
}

/// `p` that makes the least of all `b + a . p` positive, and about half as great as it can be, and that least: by a
/// barrier. All `p` after the first `free` ones are positive.
fn most(rows: &[(f64, Vec<f64>)], free: usize) -> Option<(Vec<f64>, f64)> {
    let n = rows.first()?.1.len();
    let signs = n - free;
    let total = rows.len() + signs;
    // The last unknown is the least.
    let a = DMatrix::from_fn(total, n + 1, |j, k| match rows.get(j) {
        Some((_, a)) => a.get(k).copied().unwrap_or(-1.0),
        None => f64::from(u8::from(k == free + j - rows.len())),
    });
    let b = DVector::from_fn(total, |j, _| rows.get(j).map_or(0.0, |(b, _)| *b));
    let mut x = DVector::zeros(n + 1);
    x.rows_mut(free, signs).fill(1e-3);
    x[0] = 1.0;
    x[n] = (&b + &a * &x).rows(0, rows.len()).min() - 1.0;
    let mut sharp = total as f64;
    for _ in 0..STEPS {
        let inverse = (&b + &a * &x).map(f64::recip);
        let mut gradient = a.tr_mul(&inverse);
        gradient[n] += sharp;
        let mut scaled = a.clone();
        scaled.column_iter_mut().for_each(|mut column| column.component_mul_assign(&inverse));
        let mut hessian = scaled.tr_mul(&scaled);
        (0..=n).for_each(|k| hessian[(k, k)] = hessian[(k, k)] * (1.0 + 1e-12) + 1e-12);
        let step = hessian.cholesky()?.solve(&gradient);
        let slower = (&a * &step).component_mul(&inverse).min();
        x += &step * if slower < -WITHIN { -WITHIN / slower } else { 1.0 };
        if gradient.dot(&step) < 1.0 {
            // The greatest there is, is at most so much more.
            let more = total as f64 / sharp;
            if x[n] + more < 0.0 {
                return None;
            }
            if x[n] > more {
                break;
            }
            sharp *= LESSENED;
        }
    }
    let left = x[n];
    (left > 0.0).then(|| (x.iter().take(n).copied().collect(), left))
}
