//! What fails for certain, of formulas that are enclosed at a point or over a cell.

use super::WitnessError;
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::certificate::Failure;
use crate::formula::{Formula, Op, Values, Vector};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::apart::Apart;
use crate::test::curvature::Curvature;
use crate::test::solve::Solve;
use crate::test::Row;

/// A claim's formulas over a cell, or its part.
pub(super) struct Enclosed<'a, E: Enclosure> {
    pub problem: &'a Problem,
    pub slopes: Slopes<'a, E>,
    pub values: &'a Values<Slope<E::Number>>,
}

/// Whether a claim fails in this way at every point of a cell, for every machine: the formulas are
/// enclosed over the cell, and what is certain of an enclosure is true of all that it holds.
pub fn fails_throughout<E: Enclosure>(
    problem: &Problem,
    slopes: Slopes<'_, E>,
    values: &Values<Slope<E::Number>>,
    failure: &Failure,
) -> bool {
    Enclosed { problem, slopes, values }.fail(failure) == Ok(true)
}

type Number<E> = Slope<<E as Arithmetic>::Number>;
type Missed<E> = Result<Option<Number<E>>, WitnessError>;

impl<E: Enclosure> Enclosed<'_, E> {
    pub(super) fn fail(&self, failure: &Failure) -> Result<bool, WitnessError> {
        let rest = match failure {
            Failure::Reach => return Ok(self.is_undefined()),
            Failure::Obligation(number, directions) => {
                let obligation = self.problem.obligations.get(*number);
                let test = &obligation.ok_or(WitnessError::NoSuchObligation)?.test;
                self.missed(test, directions)?
            }
            Failure::Row(number, leg) => self.exceeds(*number, *leg),
            // Of one or two points.
            Failure::Same { .. } | Failure::Singular(_) | Failure::Dependent => None,
        };
        Ok(rest.is_some_and(|rest| self.is_positive(&rest)))
    }

    fn is_positive(&self, x: &Number<E>) -> bool {
        self.slopes.all(x, |x| self.slopes.arithmetic.is_positive(x))
    }

    fn is_nonnegative(&self, x: &Number<E>) -> bool {
        self.slopes.all(x, |x| self.slopes.arithmetic.is_nonnegative(x))
    }

    /// A formula of the claim is certainly not defined: a radicand is not positive, or a divisor zero.
    fn is_undefined(&self) -> bool {
        let at_most_zero =
            |x: &Number<E>| self.slopes.neg(x).is_some_and(|less| self.is_nonnegative(&less));
        let is_zero = |x: &_| at_most_zero(x) && self.is_nonnegative(x);
        self.problem.tape.ops().iter().any(|op| match op {
            Op::Sqrt(radicand) => self.values.of(*radicand).is_some_and(at_most_zero),
            Op::Div(_, divisor) => self.values.of(*divisor).is_some_and(is_zero),
            _ => false,
        })
    }

    /// **Lemma (row).** If `|A_i|^2 > k^2 D_i`, then `sigma_max(M) > k`, or leg `i` does not reach
    /// without a serial singularity. *Proof.* If it does, `D_i > 0`, and
    /// `sigma_max(M) >= |M^T e_i| = |A_i|/sqrt(D_i) > k`. ∎ Of a leg with a length whose platform does
    /// not turn, `|A_i|` is that, and defined where `A_i` is not. (The row of a platform that turns has
    /// a moment beside the leg's vector, or is the moment alone, which may be shorter.)
    fn exceeds(&self, number: usize, leg: usize) -> Option<Number<E>> {
        let e = self.slopes;
        let Test::SigmaMax(k_squared) = self.problem.obligations.get(number)?.test else {
            return None;
        };
        let leg = self.problem.legs.get(leg)?;
        let square = match leg.length {
            Some(length) if self.problem.orientation.is_empty() => {
                e.sqr(self.values.of(length)?)?
            }
            _ => e.sum(leg.row.a.iter().map(|&a| e.sqr(self.values.of(a)?)))?,
        };
        e.sub(&square, &e.mul(self.values.of(k_squared)?, self.values.of(leg.row.d)?)?)
    }

    /// What is positive only where a test fails; of singular values and the like, in these directions. What needs
    /// more than the formulas' values is left to witnesses.
    fn missed(&self, test: &Test, directions: &[Vec<i64>]) -> Missed<E> {
        let e = self.slopes;
        let of = |f: &Formula| self.values.of(*f);
        let stretched = |v: &[i64]| match test.others() {
            Some(rows) => self.stretched(rows.iter(), v),
            None => self.stretched(self.problem.legs.iter().map(|leg| &leg.row), v),
        };
        Ok(match (test, directions) {
            // kappa^2 |v|^2 - |M v|^2.
            (Test::SigmaMin(kappa) | Test::Least(_, kappa), [v]) => {
                stretched(v).and_then(|[length, image]| e.sub(&e.mul(of(kappa)?, &length)?, &image))
            }
            // |M v|^2 - k^2 |v|^2.
            (Test::SigmaMax(k) | Test::Greatest(_, k), [v]) => {
                stretched(v).and_then(|[length, image]| e.sub(&image, &e.mul(of(k)?, &length)?))
            }
            // |M u|^2 |v|^2 > c^2 |M v|^2 |u|^2.
            (Test::Conditioning(c), [u, v]) => {
                stretched(u).zip(stretched(v)).and_then(|([length, image], [other, small])| {
                    let least = e.mul(of(c)?, &e.mul(&small, &length)?)?;
                    e.sub(&e.mul(&image, &other)?, &least)
                })
            }
            (Test::Solve(test), [v]) => self.unsolved(test, v),
            (Test::Apart(test), [weights]) => self.nearer(test, weights),
            (Test::Curvature(test), [v]) => self.curved(test, v),
            (Test::AtLeast(f), []) => of(f).and_then(|f| e.neg(f)),
            (Test::Beyond(f, b), []) => {
                let both = of(f).zip(of(b));
                let above = both.and_then(|(f, b)| e.sub(b, f));
                both.and_then(|(f, b)| e.add(b, f))
                    .filter(|_| above.is_some_and(|x| self.is_positive(&x)))
            }
            _ => return Err(WitnessError::NoSuchObligation),
        })
    }

    /// A direction of so many entries, not all zero.
    pub(super) fn direction(&self, v: &[i64], m: usize) -> Option<Vec<Number<E>>> {
        let is = v.len() == m && v.iter().any(|&v| v != 0);
        is.then(|| v.iter().map(|&v| self.slopes.integer(v)).collect())?
    }

    fn all(&self, formulas: &[Formula]) -> Option<Vec<Number<E>>> {
        formulas.iter().map(|&f| self.values.of(f).cloned()).collect()
    }

    /// `A^T v`.
    pub(super) fn transposed(&self, a: &[Vec<Formula>], v: &[Number<E>]) -> Option<Vec<Number<E>>> {
        let e = self.slopes;
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
    ) -> Option<[Number<E>; 2]> {
        let e = self.slopes;
        let numbers = self.direction(v, rows.clone().next()?.a.len())?;
        let term = |row: &Row<Formula>| {
            let entry = |(&a, &v): (&Formula, &i64)| e.times(v, self.values.of(a)?);
            let product = e.sum(row.a.iter().zip(v).map(entry))?;
            let d = self.values.of(row.d).filter(|d| self.is_positive(d))?;
            e.div(&e.sqr(&product)?, d)
        };
        let image = e.sum(rows.map(term))?;
        Some([e.square(&numbers)?, image])
    }

    /// `2 (a |row| |v|^2 + b |v^T H v| - |v|^2)`: positive only if `a |row| + b |H| > 1`.
    fn curved(&self, test: &Curvature, v: &[i64]) -> Option<Number<E>> {
        let e = self.slopes;
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
        let twice = if self.is_positive(&twice) { twice } else { e.neg(&twice)? };
        let row = e.sqrt(&e.square(&self.all(&test.row)?)?)?;
        let rest = e.sub(&e.mul(of(test.a)?, &row)?, &e.integer(1)?)?;
        let rest = e.mul(&two, &e.mul(&rest, &e.square(&v)?)?)?;
        e.add(&rest, &e.mul(of(test.b)?, &twice)?)
    }

    /// `k^2 D_i v_i^2 - |A^T v|^2`: positive only if no `z` with `M z = e_i`, that is `A z = B_i e_i`, has
    /// `|z| <= 1/k`, as then `B_i v_i = (A^T v) . z <= |A^T v|/k`.
    fn unsolved(&self, test: &Solve, v: &[i64]) -> Option<Number<E>> {
        let e = self.slopes;
        let legs = &self.problem.legs;
        let v = self.direction(v, legs.len())?;
        let d = self.values.of(legs.get(test.joint)?.row.d).filter(|d| self.is_positive(d))?;
        let along = e.mul(d, &e.sqr(v.get(test.joint)?)?)?;
        let a: Vec<Vec<Formula>> = legs.iter().map(|leg| leg.row.a.clone()).collect();
        let image = e.square(&self.transposed(&a, &v)?)?;
        e.sub(&e.mul(self.values.of(test.square)?, &along)?, &image)
    }

    /// `n^2 R^2 - |n (p - q)|^2` for the points `p = p_1 + (s/n)(p_2 - p_1)` and
    /// `q = q_1 + (t/n)(q_2 - q_1)` of the segments, of weights `s, t, n`.
    fn nearer(&self, test: &Apart, weights: &[i64]) -> Option<Number<E>> {
        let e = self.slopes;
        let [s, t, n] = *weights else { return None };
        if n <= 0 || ![s, t].iter().all(|part| (0..=n).contains(part)) {
            return None;
        }
        let point = |ends: &[Vector; 2], part: i64| -> Option<Vec<Number<E>>> {
            let weights = [e.integer(n - part)?, e.integer(part)?];
            (0..3).map(|k| e.dot(&self.all(&[ends[0][k], ends[1][k]])?, &weights)).collect()
        };
        let (p, q) = (point(&test.ends[0], s)?, point(&test.ends[1], t)?);
        let between = p.iter().zip(&q).map(|(p, q)| e.sub(p, q)).collect::<Option<Vec<_>>>()?;
        let least = e.mul(&e.integer(n)?, self.values.of(test.distance)?)?;
        e.sub(&e.sqr(&least)?, &e.square(&between)?)
    }
}
