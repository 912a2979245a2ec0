//! Linear matrix inequalities: the greatest value of one unknown for which all matrices are positive definite.

use nalgebra::{DMatrix, DVector};

/// By how much the weight of the unknown grows once its matrices are centred, and most steps of Newton's method.
const GROWTH: f64 = 10.0;
const MOST_STEPS: usize = 120;
/// How much of what it should a barrier falls, how often a step is halved for it, and how short one is at the centre.
const ARMIJO: f64 = 0.1;
const MOST_HALVINGS: usize = 20;
const CENTRED: f64 = 0.5;
/// Of what is gained beyond what is enough, so much may be left to be gained.
const LEFT: f64 = 4.0;

/// A symmetric matrix that is affine in the unknowns.
pub struct Affine {
    /// Where all are zero.
    pub constant: DMatrix<f64>,
    /// By an unknown, so much of it in entry `(i, j)`, and in `(j, i)`.
    by: Vec<(usize, (usize, usize), f64)>,
}

impl Affine {
    /// `n` rows and columns of zeros.
    pub fn new(n: usize) -> Self {
        Affine { constant: DMatrix::zeros(n, n), by: Vec::new() }
    }

    /// Adds so much of an unknown to entry `(i, j)`, and to `(j, i)`.
    pub fn add(&mut self, unknown: usize, at: (usize, usize), part: f64) {
        self.by.push((unknown, at, part));
    }

    /// Where the unknowns are `x`.
    pub fn at(&self, x: &DVector<f64>) -> DMatrix<f64> {
        let mut sum = self.constant.clone();
        for (unknown, (i, j), part) in &self.by {
            sum[(*i, *j)] += part * x[*unknown];
            if i != j {
                sum[(*j, *i)] += part * x[*unknown];
            }
        }
        sum
    }

    /// Adds the derivatives of `-log det F`, and the second ones; `None` where `F` is not positive definite.
    fn derive(
        &self,
        x: &DVector<f64>,
        slope: &mut DVector<f64>,
        hessian: &mut DMatrix<f64>,
    ) -> Option<()> {
        // `-tr(W F_a)` and `tr(W F_a W F_b)`, W the inverse of F, of one or two entries at a time.
        let w = self.at(x).cholesky()?.inverse();
        for (number, &(a, (i, j), part)) in self.by.iter().enumerate() {
            let twice = |x: f64, (i, j): (usize, usize)| if i == j { x } else { 2.0 * x };
            slope[a] -= part * twice(w[(i, j)], (i, j));
            for &(b, (k, l), other) in &self.by[..=number] {
                let one = w[(k, i)] * w[(j, l)];
                let both = if i == j { one } else { one + w[(k, j)] * w[(i, l)] };
                let second = part * other * twice(both, (k, l));
                hessian[(a, b)] += second;
                hessian[(b, a)] += second;
            }
            let (one, other) = (w[(i, i)] * w[(j, j)], w[(i, j)] * w[(j, i)]);
            let own = if i == j { one } else { 2.0 * (one + other) };
            hessian[(a, a)] -= part * part * own;
        }
        Some(())
    }
}

/// From unknowns for which all are positive definite, others for which they are and the last unknown is more than enough;
/// `None` where that seems not to be. The first matrices are looked at alone, then those of the others too that are not
/// positive definite there.
pub fn more_than(
    [first, others]: [&[Affine]; 2],
    start: &DVector<f64>,
    enough: f64,
) -> Option<DVector<f64>> {
    let [mut active, mut others] = [first, others].map(|all| all.iter().collect::<Vec<_>>());
    loop {
        let x = centred(&active, start.clone(), enough)?;
        let (fail, hold): (Vec<&Affine>, Vec<&Affine>) =
            others.into_iter().partition(|f| f.at(&x).cholesky().is_none());
        if fail.is_empty() {
            return Some(x);
        }
        active.extend(fail);
        others = hold;
    }
}

/// The same of all of them.
///
/// By barriers: where `-eta t - sum log det F` is least, the greatest `t` is at most `n/eta` away, `n` all rows.
fn centred(all: &[&Affine], mut x: DVector<f64>, enough: f64) -> Option<DVector<f64>> {
    let (last, rows) = (x.len() - 1, all.iter().map(|f| f.constant.nrows()).sum::<usize>() as f64);
    let mut eta = rows / (enough - x[last]).abs().max(f64::MIN_POSITIVE);
    for _ in 0..MOST_STEPS {
        let mut slope = DVector::zeros(x.len());
        let mut hessian = DMatrix::zeros(x.len(), x.len());
        slope[last] = -eta;
        for f in all {
            f.derive(&x, &mut slope, &mut hessian)?;
        }
        let step = hessian.cholesky()?.solve(&-&slope);
        let size = -slope.dot(&step);
        if !(size >= 0.0 && size.is_finite()) {
            return None;
        }
        // The longest part of the step by which the barrier falls as it should.
        let now = barrier(all, &x, eta)?;
        let falls = |part: &f64| {
            let next = barrier(all, &(&x + &step * *part), eta);
            next.is_some_and(|next| next < now - ARMIJO * part * size)
        };
        let mut parts = std::iter::successors(Some(1.0), |part| Some(0.5 * part));
        let part = parts.by_ref().take(MOST_HALVINGS).find(falls);
        let size = size.sqrt();
        match part {
            Some(part) => x += step * part,
            None if size < CENTRED => (),
            None => return None,
        }
        if size < CENTRED {
            let left = rows / eta;
            if x[last] - enough > LEFT * left {
                return Some(x);
            }
            if x[last] + left < enough {
                return None;
            }
            eta *= GROWTH;
        }
    }
    None
}

/// `-eta t - sum log det F`, where all are positive definite.
fn barrier(all: &[&Affine], x: &DVector<f64>, eta: f64) -> Option<f64> {
    let logs = all.iter().map(|f| {
        let root = f.at(x).cholesky()?;
        Some(2.0 * root.l_dirty().diagonal().iter().map(|d| d.ln()).sum::<f64>())
    });
    Some(-eta * x[x.len() - 1] - logs.sum::<Option<f64>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `t I < [[2, 1], [1, 2]]` where `t < 1`, and `t < x`, `x < most`.
    fn below(most: f64) -> [Affine; 3] {
        let mut all = [Affine::new(2), Affine::new(1), Affine::new(1)];
        all[0].constant = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
        all[0].add(1, (0, 0), -1.0);
        all[0].add(1, (1, 1), -1.0);
        all[1].add(0, (0, 0), 1.0);
        all[1].add(1, (0, 0), -1.0);
        all[2].constant[(0, 0)] = most;
        all[2].add(0, (0, 0), -1.0);
        all
    }

    #[test]
    fn the_greatest_value_is_found() {
        let start = DVector::from_vec(vec![-1.0, -2.0]);
        for (most, greatest) in [(3.0, 1.0), (0.5, 0.5)] {
            for first in [1, 2, 3] {
                let all = below(most);
                let (own, others) = all.split_at(first);
                let found = more_than([own, others], &start, greatest - 0.01);
                if first == 3 {
                    let found = found.expect("enough");
                    assert!(found[0] < most && found[1] > greatest - 0.01, "{found}");
                }
                let more = more_than([own, others], &start, greatest + 0.01);
                assert!(more.is_none(), "{more:?}");
            }
        }
    }

    /// Entries of one unknown in several places, and of several in one.
    #[test]
    fn derivatives_are_those_of_the_barrier() {
        let mut own = Affine::new(3);
        own.constant = DMatrix::identity(3, 3) * 4.0;
        for (unknown, at, part) in [
            (0, (0, 0), 1.0),
            (0, (0, 1), -2.0),
            (0, (1, 2), 0.5),
            (1, (1, 2), 1.0),
            (1, (2, 2), 3.0),
        ] {
            own.add(unknown, at, part);
        }
        let all = [&own];
        let at =
            |x: [f64; 2]| barrier(&all, &DVector::from_vec(x.to_vec()), 0.0).expect("positive");
        let (x, h) = ([0.3, -0.2], 1e-4);
        let (mut slope, mut hessian) = (DVector::zeros(2), DMatrix::zeros(2, 2));
        own.derive(&DVector::from_vec(x.to_vec()), &mut slope, &mut hessian).expect("positive");
        let moved = |i: usize, j: usize, a: f64, b: f64| {
            let mut x = x;
            x[i] += a * h;
            x[j] += b * h;
            at(x)
        };
        for i in 0..2 {
            let first = (moved(i, i, 1.0, 0.0) - moved(i, i, -1.0, 0.0)) / (2.0 * h);
            assert!((first - slope[i]).abs() < 1e-6, "{first} {}", slope[i]);
            for j in 0..2 {
                let ends = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
                let [a, b, c, d] = ends.map(|(a, b)| moved(i, j, a, b));
                let second = (a - b - c + d) / (4.0 * h * h);
                let close = (second - hessian[(i, j)]).abs() < 1e-5;
                assert!(close, "{second} {}", hessian[(i, j)]);
            }
        }
    }
}
