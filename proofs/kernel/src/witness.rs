//! Refutations: one machine, one point, one obligation that fails there.

use crate::arithmetic::{Arithmetic, Enclosure};
use crate::certificate::{Failure, Witness, PRECISIONS};
use crate::claim::Workspace;
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{Formula, Op, Values};
use crate::input::{binary, ordered, sign, ClaimError};
use crate::number::{Expression, Operator};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use num_bigint::BigInt;
use std::fmt;

/// Why a witness refutes nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WitnessError {
    /// The precision is not admissible.
    Precision(u32),
    /// The point is not certainly in the workspace.
    Outside,
    /// The machine is not certainly one of the claim's.
    OutsideTolerance,
    /// A number cannot be enclosed.
    Claim(ClaimError),
    /// There is no such obligation, or the directions are not of its kind.
    NoSuchObligation,
    /// What it names is not certainly violated there.
    NotViolated,
}

impl fmt::Display for WitnessError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WitnessError::Precision(bits) => write!(f, "{bits} bits are not admissible"),
            WitnessError::Outside => write!(f, "the point is not certainly in the workspace"),
            WitnessError::OutsideTolerance => {
                write!(f, "the machine is not certainly within the tolerances")
            }
            WitnessError::Claim(e) => write!(f, "{e}"),
            WitnessError::NoSuchObligation => write!(f, "there is no such obligation"),
            WitnessError::NotViolated => write!(f, "nothing is certainly violated at the point"),
        }
    }
}

/// Numbers at a point.
type Number = Interval<BigInt>;

/// Signs that are those of all numbers that are enclosed.
trait Signs: Arithmetic {
    fn is_positive(&self, x: &Self::Number) -> bool;
    fn is_nonnegative(&self, x: &Self::Number) -> bool;
}

impl<Z: Integer> Signs for Fixed<Z> {
    fn is_positive(&self, x: &Interval<Z>) -> bool {
        Enclosure::is_positive(self, x)
    }

    fn is_nonnegative(&self, x: &Interval<Z>) -> bool {
        Enclosure::is_nonnegative(self, x)
    }
}

impl<E: Enclosure> Signs for Slopes<'_, E> {
    fn is_positive(&self, x: &Slope<E::Number>) -> bool {
        self.arithmetic.is_positive(&x.range)
    }

    fn is_nonnegative(&self, x: &Slope<E::Number>) -> bool {
        self.arithmetic.is_nonnegative(&x.range)
    }
}

/// A machine's formulas at a point, or over a cell.
struct At<'a, A: Arithmetic> {
    problem: &'a Problem,
    arithmetic: A,
    values: Values<A::Number>,
}

/// Whether a claim fails in this way at every point of a cell, for every machine: the formulas are
/// enclosed over the cell, and what is certain of an enclosure is true of all that it holds.
pub(crate) fn fails_throughout<E: Enclosure>(
    problem: &Problem,
    slopes: Slopes<'_, E>,
    values: Values<Slope<E::Number>>,
    failure: &Failure,
) -> bool {
    let at = At { problem, arithmetic: slopes, values };
    match failure {
        Failure::Reach => at.is_undefined(),
        Failure::Obligation(number, directions) => problem
            .obligations
            .get(*number)
            .is_some_and(|obligation| at.fails(obligation.test, directions) == Ok(true)),
        Failure::Row(number, leg) => at.exceeds(*number, *leg),
        // Of two points.
        Failure::Singular(_) => false,
    }
}

/// Accepts a witness: at a point of the workspace, for a machine of the claim, an obligation fails.
///
/// *Proof.* The formulas are enclosed at that point for that machine; a sign that is certain is that
/// of the value. ∎ The claim is well formed, for all of its machines, before this is asked.
///
/// # Errors
/// If it shows nothing.
pub fn check(
    problem: &Problem,
    workspace: &Workspace,
    witness: &Witness,
) -> Result<(), WitnessError> {
    if !PRECISIONS.contains(&witness.precision) {
        return Err(WitnessError::Precision(witness.precision));
    }
    let mut machine = witness.machine.iter();
    for (_, min, max) in problem.tolerances() {
        let x = machine.next().ok_or(WitnessError::OutsideTolerance)?;
        let within = ordered("", min, x, false).and_then(|()| ordered("", x, max, false));
        within.map_err(|_| WitnessError::OutsideTolerance)?;
    }
    if machine.next().is_some() {
        return Err(WitnessError::OutsideTolerance);
    }
    let at = At::new(problem, workspace, witness, &witness.point)?;
    let violated = match &witness.fails {
        Failure::Reach => at.is_undefined(),
        Failure::Obligation(number, directions) => {
            let test = problem.obligations.get(*number).ok_or(WitnessError::NoSuchObligation)?.test;
            at.fails(test, directions)?
        }
        Failure::Row(number, leg) => at.exceeds(*number, *leg),
        Failure::Singular(other) => {
            let other = At::new(problem, workspace, witness, other)?;
            at.opposite(&other)
        }
    };
    if violated {
        Ok(())
    } else {
        Err(WitnessError::NotViolated)
    }
}

/// Whether a point is certainly in a workspace whose box has these corners.
fn contains(problem: &Problem, workspace: &Workspace, point: &[Expression]) -> bool {
    let [min, max] = &problem.corners;
    let in_box = point.len() == min.len()
        && point.iter().zip(min).zip(max).all(|((x, min), max)| {
            ordered("", min, x, false).and_then(|()| ordered("", x, max, false)).is_ok()
        });
    let Workspace::Cylinder { center, radius, .. } = workspace else { return in_box };
    let square = |x: &Expression| binary(Operator::Mul, x, x);
    let start = square(radius);
    let rest = point.iter().zip(center).fold(start, |rest, (x, center)| {
        binary(Operator::Sub, &rest, &square(&binary(Operator::Sub, x, center)))
    });
    in_box && matches!(sign(&rest), Some([_, true]))
}

impl<'a> At<'a, Fixed<BigInt>> {
    fn new(
        problem: &'a Problem,
        workspace: &Workspace,
        witness: &Witness,
        point: &[Expression],
    ) -> Result<Self, WitnessError> {
        if !contains(problem, workspace, point) {
            return Err(WitnessError::Outside);
        }
        let bits = witness.precision;
        let arithmetic = Fixed::new(bits);
        let parameters: Vec<Number> =
            problem.parameters(bits, &witness.machine).map_err(WitnessError::Claim)?;
        let point = problem.point(point, bits).ok_or(WitnessError::Outside)?;
        let values = problem.tape.run(&arithmetic, |op| match op {
            Op::Coordinate(k) => point.get(k).cloned(),
            Op::Parameter(j) => parameters.get(j).cloned(),
            _ => None,
        });
        Ok(At { problem, arithmetic, values })
    }
}

impl<A: Signs> At<'_, A> {
    fn is_positive(&self, x: Option<A::Number>) -> bool {
        x.is_some_and(|x| self.arithmetic.is_positive(&x))
    }

    /// A formula of the claim is certainly not defined: a radicand is not positive, or a divisor zero.
    fn is_undefined(&self) -> bool {
        let e = &self.arithmetic;
        let at_most_zero =
            |x: &A::Number| e.neg(x).is_some_and(|negative| e.is_nonnegative(&negative));
        self.problem.tape.ops().iter().any(|op| match op {
            Op::Sqrt(radicand) => self.values.of(*radicand).is_some_and(at_most_zero),
            Op::Div(_, divisor) => self
                .values
                .of(*divisor)
                .is_some_and(|divisor| at_most_zero(divisor) && e.is_nonnegative(divisor)),
            _ => false,
        })
    }

    /// `|v|^2` and `|M v|^2 = sum_i (A_i . v)^2/D_i`; `v` is not zero.
    fn stretched(&self, v: &[i64]) -> Option<[A::Number; 2]> {
        let e = &self.arithmetic;
        if v.len() != self.problem.dimension() || v.iter().all(|&v| v == 0) {
            return None;
        }
        let v: Vec<A::Number> = v.iter().map(|&v| e.integer(v)).collect::<Option<_>>()?;
        let zero = e.integer(0)?;
        let length = v.iter().try_fold(zero.clone(), |sum, v| e.add(&sum, &e.sqr(v)?))?;
        let image = self.problem.legs.iter().try_fold(zero.clone(), |sum, leg| {
            let product = leg.row.a.iter().zip(&v).try_fold(zero.clone(), |sum, (&a, v)| {
                e.add(&sum, &e.mul(self.values.of(a)?, v)?)
            })?;
            let d = self.values.of(leg.row.d).filter(|d| e.is_positive(d))?;
            e.add(&sum, &e.div(&e.sqr(&product)?, d)?)
        })?;
        Some([length, image])
    }

    /// **Lemma (row).** If `|A_i|^2 > k^2 D_i`, then `sigma_max(M) > k`, or leg `i` does not reach
    /// without a serial singularity. *Proof.* If it does, `D_i > 0`, and
    /// `sigma_max(M) >= |M^T e_i| = |A_i|/sqrt(D_i) > k`. ∎ Of a leg with a length, `|A_i|` is that (or
    /// more, but never less: a row that is a part of the leg's vector would be unsound here), and
    /// defined where `A_i` is not.
    fn exceeds(&self, number: usize, leg: usize) -> bool {
        let e = &self.arithmetic;
        let rest = || {
            let obligation = self.problem.obligations.get(number)?;
            let Test::SigmaMax(k_squared) = obligation.test else { return None };
            let leg = self.problem.legs.get(leg)?;
            let square =
                match leg.length {
                    Some(length) => e.sqr(self.values.of(length)?)?,
                    None => leg.row.a.iter().try_fold(e.integer(0)?, |sum, &a| {
                        e.add(&sum, &e.sqr(self.values.of(a)?)?)
                    })?,
                };
            e.sub(&square, &e.mul(self.values.of(k_squared)?, self.values.of(leg.row.d)?)?)
        };
        self.is_positive(rest())
    }

    fn fails(&self, test: Test, directions: &[Vec<i64>]) -> Result<bool, WitnessError> {
        let e = &self.arithmetic;
        let of = |f: Formula| self.values.of(f);
        let positive = match (test, directions) {
            // |M v|^2 < kappa^2 |v|^2.
            (Test::SigmaMin(kappa), [v]) => {
                let rest = || {
                    let [length, image] = self.stretched(v)?;
                    e.sub(&e.mul(of(kappa)?, &length)?, &image)
                };
                self.is_positive(rest())
            }
            (Test::SigmaMax(k), [v]) => {
                let rest = || {
                    let [length, image] = self.stretched(v)?;
                    e.sub(&image, &e.mul(of(k)?, &length)?)
                };
                self.is_positive(rest())
            }
            // |M u|^2 |v|^2 > c^2 |M v|^2 |u|^2.
            (Test::Conditioning(c), [u, v]) => {
                let rest = || {
                    let ([length, image], [other, small]) =
                        (self.stretched(u)?, self.stretched(v)?);
                    let least = e.mul(of(c)?, &e.mul(&small, &length)?)?;
                    e.sub(&e.mul(&image, &other)?, &least)
                };
                self.is_positive(rest())
            }
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

    /// `det M`, of as many rows as coordinates.
    fn determinant(&self) -> Option<A::Number> {
        let legs = &self.problem.legs;
        let row = |a: &Vec<Formula>| a.iter().map(|&a| self.values.of(a).cloned()).collect();
        let rows: Vec<Vec<A::Number>> =
            legs.iter().map(|leg| row(&leg.divided.a)).collect::<Option<_>>()?;
        (rows.len() == self.problem.dimension()).then(|| determinant(&self.arithmetic, &rows))?
    }

    /// **Lemma.** If `det M` of one machine has opposite signs at two points of a convex workspace, as
    /// all are here, the claim is false. *Proof.* If every formula is defined, and every leg reaches
    /// without a serial singularity, on the segment between them, `det M` is continuous there and
    /// vanishes somewhere: a parallel singularity. Otherwise some point has no such leg. ∎ (A divisor of
    /// the rows that changes its sign is zero somewhere, and a formula of the claim not defined there.)
    fn opposite(&self, other: &Self) -> bool {
        let signs = |at: &Self| {
            let det = at.determinant();
            let negative = det.as_ref().and_then(|det| at.arithmetic.neg(det));
            [at.is_positive(det), at.is_positive(negative)]
        };
        matches!((signs(self), signs(other)), ([true, _], [_, true]) | ([_, true], [true, _]))
    }
}

/// By the first row.
fn determinant<A: Arithmetic>(e: &A, rows: &[Vec<A::Number>]) -> Option<A::Number> {
    let Some((first, below)) = rows.split_first() else { return e.integer(1) };
    let mut sum = e.integer(0)?;
    for (j, a) in first.iter().enumerate() {
        let without = |row: &Vec<A::Number>| {
            let mut row = row.clone();
            row.remove(j);
            row
        };
        let minor: Vec<Vec<A::Number>> = below.iter().map(without).collect();
        let term = e.mul(a, &determinant(e, &minor)?)?;
        sum = if j % 2 == 0 { e.add(&sum, &term)? } else { e.sub(&sum, &term)? };
    }
    Some(sum)
}
