//! Doubles, to find out where bounds are nearly met. Nothing is asserted of them.

use num_traits::ToPrimitive;
use orthocert_checker::enclosure::Scalar;
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{Matrix, Vector};
use orthocert_checker::model::Model;
use orthocert_checker::rule::Rotation;
use orthocert_checker::{cell::Cell, claim::Sign};
use std::array::from_fn;

#[derive(Clone, Copy)]
pub struct Double(pub f64);

impl Scalar for Double {
    fn integer_like(&self, n: i64) -> Self {
        Double(n as f64)
    }
    fn add(&self, other: &Self) -> Self {
        Double(self.0 + other.0)
    }
    fn sub(&self, other: &Self) -> Self {
        Double(self.0 - other.0)
    }
    fn neg(&self) -> Self {
        Double(-self.0)
    }
    fn mul(&self, other: &Self) -> Self {
        Double(self.0 * other.0)
    }
    fn sqr(&self) -> Self {
        Double(self.0 * self.0)
    }
    fn recip(&self) -> Option<Self> {
        (self.0 != 0.0).then_some(Double(1.0 / self.0))
    }
    fn sqrt(&self) -> Option<Self> {
        (self.0 > 0.0).then(|| Double(self.0.sqrt()))
    }
}

pub fn double(x: &Fixed) -> f64 {
    ((x.inf() + x.sup()) / num_bigint::BigInt::from(2)).to_f64().unwrap()
}

/// What a machine does at a point.
pub struct Approximation {
    /// Singular values of `M`, ascending.
    pub xi: [f64; 3],
    pub rho: [f64; 3],
}

/// A machine in doubles.
pub struct Approximate(Model<Double>);

impl Approximate {
    pub fn new(model: &Model<Fixed>) -> Self {
        Approximate(model.map(&|x| Double(double(x))))
    }

    /// The machine at `lambda` in `[-1, 1]^3` of a cell; `None` where some leg does not reach it.
    pub fn at(&self, cell: &Cell, lambda: &[f64; 3]) -> Option<Approximation> {
        let displacement: Vector<Double> = from_fn(|k| {
            let edge = cell.edges[k];
            let u = (edge.index as f64 + (1.0 + lambda[k]) / 2.0) / f64::from(edge.level).exp2();
            Double(self.0.width[k].0 * u)
        });
        let [a, b, c] = self.0.leg_vectors(&displacement);
        let legs = &self.0.legs;
        let states = [legs[0].at(&a)?, legs[1].at(&b)?, legs[2].at(&c)?];
        let matrix = from_fn(|i| from_fn(|j| states[i].row[j].0));
        let rho = from_fn(|i| states[i].rho.length().map_or(f64::NAN, |rho| rho.0));
        Some(Approximation { xi: singular_values(&matrix), rho })
    }

    /// The `lambda` (in 256ths) among corners, middles and neighbours of what is best so far at
    /// which `value` is least, with that least value. `None` if a point tried is out of reach.
    pub fn least(
        &self,
        cell: &Cell,
        value: impl Fn(&Approximation) -> f64,
    ) -> Option<([i64; 3], f64)> {
        let at =
            |lambda: &[i64; 3]| Some(value(&self.at(cell, &lambda.map(|x| x as f64 / 256.0))?));
        let ends = [-256, 0, 256];
        let mut best = ([0; 3], at(&[0; 3])?);
        for lambda in ends.iter().flat_map(|&x| ends.map(|y| ends.map(|z| [x, y, z]))).flatten() {
            let found = at(&lambda)?;
            if found < best.1 {
                best = (lambda, found);
            }
        }
        for step in [128i64, 64, 32, 16, 8, 4, 2, 1] {
            for (k, sign) in (0..3).flat_map(|k| [(k, -1), (k, 1)]) {
                let mut lambda = best.0;
                lambda[k] = (lambda[k] + sign * step).clamp(-256, 256);
                let found = at(&lambda)?;
                if found < best.1 {
                    best = (lambda, found);
                }
            }
        }
        Some(best)
    }
}

/// Singular values, ascending: roots of the eigenvalues of `M^T M`, by Jacobi rotations.
pub fn singular_values(m: &[[f64; 3]; 3]) -> [f64; 3] {
    let mut a: [[f64; 3]; 3] = from_fn(|i| from_fn(|j| (0..3).map(|k| m[k][i] * m[k][j]).sum()));
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(30) {
        if a[p][q] == 0.0 {
            continue;
        }
        let theta = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
        let (s, c) = theta.sin_cos();
        for row in &mut a {
            (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
        }
        let (rp, rq) = (a[p], a[q]);
        a[p] = from_fn(|k| c * rp[k] - s * rq[k]);
        a[q] = from_fn(|k| s * rp[k] + c * rq[k]);
    }
    let mut xi: [f64; 3] = from_fn(|i| a[i][i].max(0.0).sqrt());
    xi.sort_by(f64::total_cmp);
    xi
}

/// Evidence for `M`: the transposed polar factor, by Newton's iteration `X <- (X + X^-T) / 2`, as
/// a quaternion with components of up to `2^14`.
pub fn polar_rotation(m: &Matrix<Fixed>) -> Rotation {
    let mut x: [[f64; 3]; 3] = from_fn(|i| from_fn(|j| double(&m[i][j])));
    for _ in 0..40 {
        // Rows of the cofactor matrix: X^-T = cof(X) / det(X).
        let cof: [[f64; 3]; 3] = from_fn(|i| cross(&x[(i + 1) % 3], &x[(i + 2) % 3]));
        let det: f64 = (0..3).map(|j| x[0][j] * cof[0][j]).sum();
        x = from_fn(|i| from_fn(|j| 0.5 * (x[i][j] + cof[i][j] / det)));
    }
    let det: f64 = (0..3).map(|j| x[0][j] * cross(&x[1], &x[2])[j]).sum();
    let (sign, s) = if det < 0.0 { (Sign::Minus, -1.0) } else { (Sign::Plus, 1.0) };
    // W = X^T, made proper.
    let r = |i: usize, j: usize| s * x[j][i];
    let squares = [
        1.0 + r(0, 0) + r(1, 1) + r(2, 2),
        1.0 + r(0, 0) - r(1, 1) - r(2, 2),
        1.0 - r(0, 0) + r(1, 1) - r(2, 2),
        1.0 - r(0, 0) - r(1, 1) + r(2, 2),
    ];
    let (v, w) = (
        [r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)],
        [r(0, 1) + r(1, 0), r(0, 2) + r(2, 0), r(1, 2) + r(2, 1)],
    );
    let greatest = (0..4).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap();
    let q = match greatest {
        0 => [squares[0], v[0], v[1], v[2]],
        1 => [v[0], squares[1], w[0], w[1]],
        2 => [v[1], w[0], squares[2], w[2]],
        _ => [v[2], w[1], w[2], squares[3]],
    };
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    Rotation { q: q.map(|x| (x / norm * 16384.0).round() as i64), sign }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}
