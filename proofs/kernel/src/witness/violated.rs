//! What is computed of a machine at a point, for one test each.

use super::{At, Number};
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::formula::{Formula, Vector};
use crate::test::apart::Apart;
use crate::test::curvature::Curvature;
use crate::test::solve::Solve;
use crate::test::Row;

impl At<'_> {
    /// A direction of so many entries, not all zero.
    pub(super) fn direction(&self, v: &[i64], m: usize) -> Option<Vec<Number>> {
        let is = v.len() == m && v.iter().any(|&v| v != 0);
        is.then(|| v.iter().map(|&v| self.arithmetic.integer(v)).collect())?
    }

    fn all(&self, formulas: &[Formula]) -> Option<Vec<Number>> {
        formulas.iter().map(|&f| self.values.of(f).cloned()).collect()
    }

    fn dot(&self, u: &[Number], v: &[Number]) -> Option<Number> {
        let e = &self.arithmetic;
        u.iter().zip(v).try_fold(e.integer(0)?, |sum, (u, v)| e.add(&sum, &e.mul(u, v)?))
    }

    /// `|v|^2`.
    pub(super) fn square(&self, v: &[Number]) -> Option<Number> {
        let e = &self.arithmetic;
        v.iter().try_fold(e.integer(0)?, |sum, v| e.add(&sum, &e.sqr(v)?))
    }

    /// `A^T v`.
    pub(super) fn transposed(&self, a: &[Vec<Formula>], v: &[Number]) -> Option<Vec<Number>> {
        let entry = |k: usize| {
            let column: Option<Vec<Formula>> = a.iter().map(|row| row.get(k).copied()).collect();
            self.dot(&self.all(&column?)?, v)
        };
        (0..self.problem.dimension()).map(entry).collect()
    }

    /// `|v|^2` and `|M v|^2 = sum_i (A_i . v)^2/D_i`; `v` is not zero.
    pub(super) fn stretched<'b>(
        &self,
        mut rows: impl Iterator<Item = &'b Row<Formula>>,
        v: &[i64],
    ) -> Option<[Number; 2]> {
        let e = &self.arithmetic;
        let v = self.direction(v, self.problem.dimension())?;
        let image = rows.try_fold(e.integer(0)?, |sum, row| {
            let product = self.dot(&self.all(&row.a)?, &v)?;
            let d = self.values.of(row.d).filter(|d| e.is_positive(d))?;
            e.add(&sum, &e.div(&e.sqr(&product)?, d)?)
        })?;
        Some([self.square(&v)?, image])
    }

    /// `2 (a |row| |v|^2 + b |v^T H v| - |v|^2)`: positive only if `a |row| + b |H| > 1`.
    pub(super) fn curved(&self, test: &Curvature, v: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let of = |f: Formula| self.values.of(f);
        let v = self.direction(v, test.row.len())?;
        let (zero, two) = (e.integer(0)?, e.integer(2)?);
        // Of 2 v^T H v, an entry above the diagonal counts twice.
        let mut twice = zero;
        for (i, entries) in test.twice.iter().enumerate() {
            for (j, &f) in (i..).zip(entries) {
                let product = e.mul(of(f)?, &e.mul(v.get(i)?, v.get(j)?)?)?;
                let product = if i == j { product } else { e.mul(&two, &product)? };
                twice = e.add(&twice, &product)?;
            }
        }
        // Either sign gives at most the absolute value.
        let twice = if e.is_positive(&twice) { twice } else { e.neg(&twice)? };
        let row = e.sqrt(&self.square(&self.all(&test.row)?)?)?;
        let rest = e.sub(&e.mul(of(test.a)?, &row)?, &e.integer(1)?)?;
        let rest = e.mul(&two, &e.mul(&rest, &self.square(&v)?)?)?;
        e.add(&rest, &e.mul(of(test.b)?, &twice)?)
    }

    /// `(v . b)^2 - c^2 |A^T v|^2`: positive only if no `z` with `A z = b` has `|z| <= c`, as then
    /// `v . b = (A^T v) . z <= |A^T v| c`.
    pub(super) fn unsolved(&self, test: &Solve, v: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let v = self.direction(v, test.b.len())?;
        let along = self.dot(&self.all(&test.b)?, &v)?;
        let image = self.square(&self.transposed(&test.a, &v)?)?;
        e.sub(&e.sqr(&along)?, &e.mul(self.values.of(test.square)?, &image)?)
    }

    /// `n^2 R^2 - |n (p - q)|^2` for the points `p = p_1 + (s/n)(p_2 - p_1)` and
    /// `q = q_1 + (t/n)(q_2 - q_1)` of the segments, of weights `s, t, n`.
    pub(super) fn nearer(&self, test: &Apart, weights: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let [s, t, n] = *weights else { return None };
        if n <= 0 || ![s, t].iter().all(|part| (0..=n).contains(part)) {
            return None;
        }
        let point = |ends: &[Vector; 2], part: i64| -> Option<Vec<Number>> {
            let weights = [e.integer(n - part)?, e.integer(part)?];
            (0..3).map(|k| self.dot(&self.all(&[ends[0][k], ends[1][k]])?, &weights)).collect()
        };
        let (p, q) = (point(&test.ends[0], s)?, point(&test.ends[1], t)?);
        let between = p.iter().zip(&q).map(|(p, q)| e.sub(p, q)).collect::<Option<Vec<_>>>()?;
        let least = e.mul(&e.integer(n)?, self.values.of(test.distance)?)?;
        e.sub(&e.sqr(&least)?, &self.square(&between)?)
    }
}
