//! What fails for certain, of formulas that are enclosed at a point or over a cell.

use super::WitnessError;
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::certificate::Failure;
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{Formula, Op, Values, Vector};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::apart::Apart;
use crate::test::curvature::Curvature;
use crate::test::solve::Solve;
use crate::test::Row;
use std::borrow::Cow;

/// Signs that are those of all numbers that are enclosed.
pub(super) trait Signs: Arithmetic {
    fn surely_positive(&self, x: &Self::Number) -> bool;
    fn surely_nonnegative(&self, x: &Self::Number) -> bool;
}

impl<Z: Integer> Signs for Fixed<Z> {
    fn surely_positive(&self, x: &Interval<Z>) -> bool {
        Enclosure::is_positive(self, x)
    }

    fn surely_nonnegative(&self, x: &Interval<Z>) -> bool {
        Enclosure::is_nonnegative(self, x)
    }
}

impl<E: Enclosure> Signs for Slopes<'_, E> {
    fn surely_positive(&self, x: &Slope<E::Number>) -> bool {
        self.all(x, |x| self.arithmetic.is_positive(x))
    }

    fn surely_nonnegative(&self, x: &Slope<E::Number>) -> bool {
        self.all(x, |x| self.arithmetic.is_nonnegative(x))
    }
}

/// A machine's formulas at a point, or over a cell; the point and the parameters are known of a point alone.
pub(super) struct At<'a, A: Arithmetic> {
    pub problem: &'a Problem,
    pub arithmetic: A,
    pub values: Cow<'a, Values<A::Number>>,
    pub point: Vec<A::Number>,
    pub parameters: Vec<A::Number>,
}

/// Whether a claim fails in this way at every point of a cell, for every machine: the formulas are
/// enclosed over the cell, and what is certain of an enclosure is true of all that it holds.
pub fn fails_throughout<E: Enclosure>(
    problem: &Problem,
    slopes: Slopes<'_, E>,
    values: &Values<Slope<E::Number>>,
    failure: &Failure,
) -> bool {
    let (values, point, parameters) = (Cow::Borrowed(values), Vec::new(), Vec::new());
    let at = At { problem, arithmetic: slopes, values, point, parameters };
    match failure {
        Failure::Reach => at.is_undefined(),
        Failure::Obligation(number, directions) => problem
            .obligations
            .get(*number)
            .is_some_and(|obligation| at.fails(&obligation.test, directions) == Ok(true)),
        Failure::Row(number, leg) => at.exceeds(*number, *leg),
        // Of one or two points.
        Failure::Same { .. } | Failure::Singular(_) | Failure::Dependent => false,
    }
}

impl<A: Signs> At<'_, A> {
    pub(super) fn is_positive(&self, x: Option<A::Number>) -> bool {
        x.is_some_and(|x| self.arithmetic.surely_positive(&x))
    }

    /// A formula of the claim is certainly not defined: a radicand is not positive, or a divisor zero.
    pub(super) fn is_undefined(&self) -> bool {
        let e = &self.arithmetic;
        let at_most_zero =
            |x: &A::Number| e.neg(x).is_some_and(|negative| e.surely_nonnegative(&negative));
        self.problem.tape.ops().iter().any(|op| match op {
            Op::Sqrt(radicand) => self.values.of(*radicand).is_some_and(at_most_zero),
            Op::Div(_, divisor) => self
                .values
                .of(*divisor)
                .is_some_and(|divisor| at_most_zero(divisor) && e.surely_nonnegative(divisor)),
            _ => false,
        })
    }

    /// **Lemma (row).** If `|A_i|^2 > k^2 D_i`, then `sigma_max(M) > k`, or leg `i` does not reach
    /// without a serial singularity. *Proof.* If it does, `D_i > 0`, and
    /// `sigma_max(M) >= |M^T e_i| = |A_i|/sqrt(D_i) > k`. ∎ Of a leg with a length whose platform does
    /// not turn, `|A_i|` is that, and defined where `A_i` is not. (The row of a platform that turns has
    /// a moment beside the leg's vector, or is the moment alone, which may be shorter.)
    pub(super) fn exceeds(&self, number: usize, leg: usize) -> bool {
        let e = &self.arithmetic;
        let rest = || {
            let obligation = self.problem.obligations.get(number)?;
            let Test::SigmaMax(k_squared) = obligation.test else { return None };
            let leg = self.problem.legs.get(leg)?;
            let square = match leg.length {
                Some(length) if self.problem.orientation.is_empty() => {
                    e.sqr(self.values.of(length)?)?
                }
                _ => e.sum(leg.row.a.iter().map(|&a| e.sqr(self.values.of(a)?)))?,
            };
            e.sub(&square, &e.mul(self.values.of(k_squared)?, self.values.of(leg.row.d)?)?)
        };
        self.is_positive(rest())
    }

    /// Whether a test certainly fails; of singular values and the like, in these directions. What needs
    /// more than the formulas' values is left to [`AtPoint`](super::AtPoint).
    pub(super) fn fails(&self, test: &Test, directions: &[Vec<i64>]) -> Result<bool, WitnessError> {
        let e = &self.arithmetic;
        let of = |f: &Formula| self.values.of(*f);
        let stretched = |v: &[i64]| match test.others() {
            Some(rows) => self.stretched(rows.iter(), v),
            None => self.stretched(self.problem.legs.iter().map(|leg| &leg.row), v),
        };
        let positive = match (test, directions) {
            // kappa^2 |v|^2 - |M v|^2.
            (Test::SigmaMin(kappa) | Test::Least(_, kappa), [v]) => {
                let short = |[length, image]: [_; 2]| e.sub(&e.mul(of(kappa)?, &length)?, &image);
                self.is_positive(stretched(v).and_then(short))
            }
            // |M v|^2 - k^2 |v|^2.
            (Test::SigmaMax(k) | Test::Greatest(_, k), [v]) => {
                let long = |[length, image]: [_; 2]| e.sub(&image, &e.mul(of(k)?, &length)?);
                self.is_positive(stretched(v).and_then(long))
            }
            // |M u|^2 |v|^2 > c^2 |M v|^2 |u|^2.
            (Test::Conditioning(c), [u, v]) => {
                let rest = || {
                    let ([length, image], [other, small]) = (stretched(u)?, stretched(v)?);
                    let least = e.mul(of(c)?, &e.mul(&small, &length)?)?;
                    e.sub(&e.mul(&image, &other)?, &least)
                };
                self.is_positive(rest())
            }
            (Test::Solve(test), [v]) => self.is_positive(self.unsolved(test, v)),
            (Test::Apart(test), [weights]) => self.is_positive(self.nearer(test, weights)),
            (Test::Curvature(test), [v]) => self.is_positive(self.curved(test, v)),
            (Test::AtLeast(f), []) => self.is_positive(of(f).and_then(|f| e.neg(f))),
            (Test::Beyond(f, b), []) => {
                let both = || Some((of(f)?, of(b)?));
                self.is_positive(both().and_then(|(f, b)| e.sub(b, f)))
                    && self.is_positive(both().and_then(|(f, b)| e.add(b, f)))
            }
            _ => return Err(WitnessError::NoSuchObligation),
        };
        Ok(positive)
    }

    /// A direction of so many entries, not all zero.
    pub(super) fn direction(&self, v: &[i64], m: usize) -> Option<Vec<A::Number>> {
        let is = v.len() == m && v.iter().any(|&v| v != 0);
        is.then(|| v.iter().map(|&v| self.arithmetic.integer(v)).collect())?
    }

    fn all(&self, formulas: &[Formula]) -> Option<Vec<A::Number>> {
        formulas.iter().map(|&f| self.values.of(f).cloned()).collect()
    }

    /// The sum of terms of which there is one.
    fn sum(&self, mut terms: impl Iterator<Item = Option<A::Number>>) -> Option<A::Number> {
        let first = terms.next()??;
        terms.try_fold(first, |sum, term| self.arithmetic.add(&sum, &term?))
    }

    /// `A^T v`.
    pub(super) fn transposed(&self, a: &[Vec<Formula>], v: &[A::Number]) -> Option<Vec<A::Number>> {
        let e = &self.arithmetic;
        let entry = |k: usize| {
            let column: Option<Vec<Formula>> = a.iter().map(|row| row.get(k).copied()).collect();
            e.dot(&self.all(&column?)?, v)
        };
        (0..self.problem.dimension()).map(entry).collect()
    }

    /// `|v|^2` and `|M v|^2 = sum_i (A_i . v)^2/D_i`; `v` is not zero.
    fn stretched<'b>(
        &self,
        rows: impl Iterator<Item = &'b Row<Formula>> + Clone,
        v: &[i64],
    ) -> Option<[A::Number; 2]> {
        let e = &self.arithmetic;
        let numbers = self.direction(v, rows.clone().next()?.a.len())?;
        let term = |row: &Row<Formula>| {
            let entry = |(&a, &v): (&Formula, &i64)| e.times(v, self.values.of(a)?);
            let product = self.sum(row.a.iter().zip(v).map(entry))?;
            let d = self.values.of(row.d).filter(|d| e.surely_positive(d))?;
            e.div(&e.sqr(&product)?, d)
        };
        let image = self.sum(rows.map(term))?;
        Some([e.square(&numbers)?, image])
    }

    /// `2 (a |row| |v|^2 + b |v^T H v| - |v|^2)`: positive only if `a |row| + b |H| > 1`.
    pub(super) fn curved(&self, test: &Curvature, v: &[i64]) -> Option<A::Number> {
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
        let twice = if e.surely_positive(&twice) { twice } else { e.neg(&twice)? };
        let row = e.sqrt(&e.square(&self.all(&test.row)?)?)?;
        let rest = e.sub(&e.mul(of(test.a)?, &row)?, &e.integer(1)?)?;
        let rest = e.mul(&two, &e.mul(&rest, &e.square(&v)?)?)?;
        e.add(&rest, &e.mul(of(test.b)?, &twice)?)
    }

    /// `k^2 D_i v_i^2 - |A^T v|^2`: positive only if no `z` with `M z = e_i`, that is `A z = B_i e_i`, has
    /// `|z| <= 1/k`, as then `B_i v_i = (A^T v) . z <= |A^T v|/k`.
    pub(super) fn unsolved(&self, test: &Solve, v: &[i64]) -> Option<A::Number> {
        let e = &self.arithmetic;
        let legs = &self.problem.legs;
        let v = self.direction(v, legs.len())?;
        let d = self.values.of(legs.get(test.joint)?.row.d).filter(|d| e.surely_positive(d))?;
        let along = e.mul(d, &e.sqr(v.get(test.joint)?)?)?;
        let a: Vec<Vec<Formula>> = legs.iter().map(|leg| leg.row.a.clone()).collect();
        let image = e.square(&self.transposed(&a, &v)?)?;
        e.sub(&e.mul(self.values.of(test.square)?, &along)?, &image)
    }

    /// `n^2 R^2 - |n (p - q)|^2` for the points `p = p_1 + (s/n)(p_2 - p_1)` and
    /// `q = q_1 + (t/n)(q_2 - q_1)` of the segments, of weights `s, t, n`.
    pub(super) fn nearer(&self, test: &Apart, weights: &[i64]) -> Option<A::Number> {
        let e = &self.arithmetic;
        let [s, t, n] = *weights else { return None };
        if n <= 0 || ![s, t].iter().all(|part| (0..=n).contains(part)) {
            return None;
        }
        let point = |ends: &[Vector; 2], part: i64| -> Option<Vec<A::Number>> {
            let weights = [e.integer(n - part)?, e.integer(part)?];
            (0..3).map(|k| e.dot(&self.all(&[ends[0][k], ends[1][k]])?, &weights)).collect()
        };
        let (p, q) = (point(&test.ends[0], s)?, point(&test.ends[1], t)?);
        let between = p.iter().zip(&q).map(|(p, q)| e.sub(p, q)).collect::<Option<Vec<_>>>()?;
        let least = e.mul(&e.integer(n)?, self.values.of(test.distance)?)?;
        e.sub(&e.sqr(&least)?, &e.square(&between)?)
    }

    /// `det M`, of as many rows as coordinates.
    pub(super) fn determinant(&self) -> Option<A::Number> {
        let legs = &self.problem.legs;
        let row = |a: &Vec<Formula>| a.iter().map(|&a| self.values.of(a).cloned()).collect();
        let rows: Vec<Vec<A::Number>> =
            legs.iter().map(|leg| row(&leg.divided.a)).collect::<Option<_>>()?;
        (rows.len() == self.problem.dimension()).then(|| determinant(&self.arithmetic, &rows))?
    }
}

/// By the first row.
fn determinant<A: Arithmetic>(e: &A, rows: &[Vec<A::Number>]) -> Option<A::Number> {
    let Some((first, below)) = rows.split_first() else { return e.integer(1) };
    let mut sum = e.integer(0)?;
    for (j, a) in first.iter().enumerate() {
        let without = |row: &Vec<A::Number>| [&row[..j], &row[j + 1..]].concat();
        let minor: Vec<Vec<A::Number>> = below.iter().map(without).collect();
        let term = e.mul(a, &determinant(e, &minor)?)?;
        sum = if j % 2 == 0 { e.add(&sum, &term)? } else { e.sub(&sum, &term)? };
    }
    Some(sum)
}
