//! Refutations: one machine, one point, one obligation that fails there.

use crate::arithmetic::{Arithmetic, Enclosure};
use crate::cell::evaluate;
use crate::certificate::{Failure, Witness, PRECISIONS};
use crate::claim::Workspace;
use crate::fixed::{Fixed, Interval};
use crate::formula::{Formula, Op, Values, Vector};
use crate::input::{binary, ordered, sign, ClaimError};
use crate::machine::{Joint, Leg};
use crate::number::{Expression, Operator};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::Slopes;
use crate::test::accuracy::{inflated, spread, Accuracy};
use crate::test::apart::Apart;
use crate::test::curvature::Curvature;
use crate::test::solve::Solve;
use crate::test::{Over, Row};
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

/// A machine's formulas at a point.
fn values_at(
    problem: &Problem,
    arithmetic: &Fixed<BigInt>,
    point: &[Number],
    parameters: &[Number],
) -> Values<Number> {
    problem.tape.run(arithmetic, |op| match op {
        Op::Coordinate(k) => point.get(k).cloned(),
        Op::Parameter(j) => parameters.get(j).cloned(),
        _ => None,
    })
}

/// A machine's formulas at a point, and what they are of.
struct At<'a> {
    problem: &'a Problem,
    arithmetic: Fixed<BigInt>,
    point: Vec<Number>,
    parameters: Vec<Number>,
    values: Values<Number>,
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
            let obligation =
                problem.obligations.get(*number).ok_or(WitnessError::NoSuchObligation)?;
            at.fails(&obligation.test, directions)?
        }
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

impl<'a> At<'a> {
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
        let values = values_at(problem, &arithmetic, &point, &parameters);
        Ok(At { problem, arithmetic, point, parameters, values })
    }

    fn is_positive(&self, x: Option<Number>) -> bool {
        x.is_some_and(|x| self.arithmetic.is_positive(&x))
    }

    /// A formula of the claim is certainly not defined: a radicand is not positive, or a divisor zero.
    fn is_undefined(&self) -> bool {
        let e = &self.arithmetic;
        let at_most_zero =
            |x: &Number| e.neg(x).is_some_and(|negative| e.is_nonnegative(&negative));
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
    fn stretched<'b>(
        &self,
        mut rows: impl Iterator<Item = &'b Row<Formula>>,
        v: &[i64],
    ) -> Option<[Number; 2]> {
        let e = &self.arithmetic;
        let v = self.direction(v, self.problem.dimension())?;
        let zero = e.integer(0)?;
        let length = v.iter().try_fold(zero.clone(), |sum, v| e.add(&sum, &e.sqr(v)?))?;
        let image = rows.try_fold(zero.clone(), |sum, row| {
            let product = row.a.iter().zip(&v).try_fold(zero.clone(), |sum, (&a, v)| {
                e.add(&sum, &e.mul(self.values.of(a)?, v)?)
            })?;
            let d = self.values.of(row.d).filter(|d| e.is_positive(d))?;
            e.add(&sum, &e.div(&e.sqr(&product)?, d)?)
        })?;
        Some([length, image])
    }

    fn fails(&self, test: &Test, directions: &[Vec<i64>]) -> Result<bool, WitnessError> {
        let e = &self.arithmetic;
        let of = |f: &Formula| self.values.of(*f);
        let stretched = |v: &[i64]| self.stretched(self.problem.legs.iter().map(|leg| &leg.row), v);
        let positive = match (test, directions) {
            // |M v|^2 < kappa^2 |v|^2.
            (Test::SigmaMin(kappa), [v]) => {
                let rest = || {
                    let [length, image] = stretched(v)?;
                    e.sub(&e.mul(of(kappa)?, &length)?, &image)
                };
                self.is_positive(rest())
            }
            (Test::SigmaMax(k), [v]) => {
                let rest = || {
                    let [length, image] = stretched(v)?;
                    e.sub(&image, &e.mul(of(k)?, &length)?)
                };
                self.is_positive(rest())
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
            (Test::Least(rows, kappa), [v]) => {
                let rest = || {
                    let [length, image] = self.stretched(rows.iter(), v)?;
                    e.sub(&e.mul(of(kappa)?, &length)?, &image)
                };
                self.is_positive(rest())
            }
            (Test::Solve(test), [v]) => self.is_positive(self.unsolved(test, v)),
            (Test::Accuracy(test), [v]) => self.is_positive(self.far(test, v)),
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

    /// `2 (a |row| |v|^2 + b |v^T H v| - |v|^2)`: positive only if `a |row| + b |H| > 1`.
    fn curved(&self, test: &Curvature, v: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let of = |f: &Formula| self.values.of(*f);
        let v = self.direction(v, test.row.len())?;
        let (zero, two) = (e.integer(0)?, e.integer(2)?);
        let square = |sum: Number, f: &Formula| e.add(&sum, &e.sqr(of(f)?)?);
        let row = e.sqrt(&test.row.iter().try_fold(zero.clone(), square)?)?;
        let length = v.iter().try_fold(zero.clone(), |sum, v| e.add(&sum, &e.sqr(v)?))?;
        // Of 2 v^T H v, an entry above the diagonal counts twice.
        let mut twice = zero;
        for (i, entries) in test.twice.iter().enumerate() {
            for (j, f) in (i..).zip(entries) {
                let product = e.mul(of(f)?, &e.mul(v.get(i)?, v.get(j)?)?)?;
                let product = if i == j { product } else { e.mul(&two, &product)? };
                twice = e.add(&twice, &product)?;
            }
        }
        let twice = if e.is_positive(&twice) { twice } else { e.neg(&twice)? };
        let rest = e.sub(&e.mul(of(&test.a)?, &row)?, &e.integer(1)?)?;
        e.add(&e.mul(&two, &e.mul(&rest, &length)?)?, &e.mul(of(&test.b)?, &twice)?)
    }

    /// `(v . b)^2 - c^2 |A^T v|^2`: positive only if no `z` with `A z = b` has `|z| <= c`, as then
    /// `v . b = (A^T v) . z <= |A^T v| c`.
    fn unsolved(&self, test: &Solve, v: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let v = self.direction(v, test.b.len())?;
        let zero = e.integer(0)?;
        let along = |of: &dyn Fn(usize) -> Option<Formula>| {
            v.iter().enumerate().try_fold(zero.clone(), |sum, (i, v)| {
                e.add(&sum, &e.mul(self.values.of(of(i)?)?, v)?)
            })
        };
        let rest = e.sqr(&along(&|i| test.b.get(i).copied())?)?;
        let image = (0..self.problem.dimension()).try_fold(zero.clone(), |sum, k| {
            e.add(&sum, &e.sqr(&along(&|i| test.a.get(i)?.get(k).copied())?)?)
        });
        e.sub(&rest, &e.mul(self.values.of(test.square)?, &image?)?)
    }

    /// `v . b/d - |M^T v| - (d Gamma/2) |v|` for the worst joint errors, at most.
    ///
    /// **Lemma.** If it is positive, the machine has no position within `d` with the joint coordinates
    /// that these errors give. *Proof.* For one, `b = f(P + u) - f(P)` with `|u| <= d` (see
    /// [`accuracy`](crate::test::accuracy::accuracy)), so `v . b <= |M^T v| d + |v| Gamma d^2/2`. Of
    /// `b_i = delta_i + eps_i` the error may be `e_i` with the sign of `v_i`. ∎ A position beyond `d` would
    /// show nothing: there may be another one within.
    fn far(&self, test: &Accuracy, v: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let direction = self.direction(v, test.joints.len())?;
        let d = self.values.of(test.distance)?;
        let zero = e.integer(0)?;
        let mut rest = zero.clone();
        for ((v, delta), (error, _)) in direction.iter().zip(self.off_nominal()?).zip(&test.joints)
        {
            let size = if e.is_nonnegative(v) { v.clone() } else { e.neg(v)? };
            rest = e.add(&rest, &e.mul(v, &e.div(&delta, d)?)?)?;
            rest = e.add(&rest, &e.mul(&size, self.values.of(*error)?)?)?;
        }
        let edges: Vec<_> =
            self.point.iter().map(|x| [x.clone(), x.clone(), zero.clone()]).collect();
        let slopes = Slopes { arithmetic: e, m: edges.len() };
        let edges = inflated(e, &edges, d)?;
        let values = evaluate(&self.problem.tape, &self.parameters, slopes, &edges);
        let far = Over { slopes, values: &values, inside: None };
        let defined = self.problem.partial.iter().all(|&f| far.of(f).is_some());
        let spread = e.halve(&spread(&far, &test.rows).filter(|_| defined)?)?;
        let norm = |square: Option<Number>| {
            let [_, square] = e.ends(&square?);
            if e.is_positive(&square) {
                e.sqrt(&square)
            } else {
                Some(square)
            }
        };
        let add_square = |sum: Number, x: &Number| e.add(&sum, &e.sqr(x)?);
        let length = norm(direction.iter().try_fold(zero.clone(), add_square))?;
        let image = norm((0..self.point.len()).try_fold(zero.clone(), |sum, k| {
            let mut terms = direction.iter().zip(&test.rows);
            let entry = terms.try_fold(zero.clone(), |sum, (v, row)| {
                e.add(&sum, &e.mul(v, self.values.of(*row.get(k)?)?)?)
            });
            add_square(sum, &entry?)
        }))?;
        e.sub(&rest, &e.add(&image, &e.mul(&spread, &length)?)?)
    }

    /// `rho_i` of the machine in the middle of the tolerance, less `rho_i`, at this point. Of angles,
    /// which count their turns: if for all machines of the tolerance the cosine of the difference is
    /// positive, it is within a quarter of a turn on the way from one to the other, and between its sine
    /// and its tangent.
    fn off_nominal(&self) -> Option<Vec<Number>> {
        let (e, problem) = (&self.arithmetic, self.problem);
        let middle = |(_, min, max): (&str, &Expression, &Expression)| {
            binary(Operator::Div, &binary(Operator::Add, min, max), &Expression::integer(2))
        };
        let middle: Vec<Expression> = problem.tolerances().map(middle).collect();
        let with = |machine: &[Expression]| {
            let parameters = problem.parameters(e.bits(), machine).ok()?;
            Some(values_at(problem, e, &self.point, &parameters))
        };
        let (nominal, all) = (with(&middle)?, with(&[])?);
        let off = |leg: &Leg| match leg.rho? {
            Joint::Length(rho) => e.sub(nominal.of(rho)?, self.values.of(rho)?),
            Joint::Angle { cos, sin } => {
                let turned = |other: &Values<Number>| {
                    let (c, s) = (nominal.of(cos)?, nominal.of(sin)?);
                    let (c2, s2) = (other.of(cos)?, other.of(sin)?);
                    let along = e.add(&e.mul(c, c2)?, &e.mul(s, s2)?)?;
                    let across = e.sub(&e.mul(s, c2)?, &e.mul(c, s2)?)?;
                    Some((along, across)).filter(|(along, _)| e.is_positive(along))
                };
                turned(&all)?;
                let (cos, sin) = turned(&self.values)?;
                Some(e.hull(&sin, &e.div(&sin, &cos)?))
            }
        };
        problem.legs.iter().map(off).collect()
    }

    /// `n^2 R^2 - |n (p - q)|^2` for the points `p = p_1 + (s/n)(p_2 - p_1)` and
    /// `q = q_1 + (t/n)(q_2 - q_1)` of the segments, of weights `s, t, n`.
    fn nearer(&self, test: &Apart, weights: &[i64]) -> Option<Number> {
        let e = &self.arithmetic;
        let [s, t, n] = *weights else { return None };
        let between = |part: &i64| (0..=n).contains(part);
        if n <= 0 || ![s, t].iter().all(between) {
            return None;
        }
        let [n_less_s, n_less_t, s, t, n] = [n - s, n - t, s, t, n].map(|n| e.integer(n));
        let (s, t, n, n_less_s, n_less_t) = (s?, t?, n?, n_less_s?, n_less_t?);
        let [first, second] = &test.ends;
        let square = (0..3).try_fold(e.integer(0)?, |sum, k| {
            let at = |ends: &[Vector; 2], [p, q]: [&Number; 2]| {
                let [one, other] = [self.values.of(ends[0][k])?, self.values.of(ends[1][k])?];
                e.add(&e.mul(p, one)?, &e.mul(q, other)?)
            };
            let difference = e.sub(&at(first, [&n_less_s, &s])?, &at(second, [&n_less_t, &t])?)?;
            e.add(&sum, &e.sqr(&difference)?)
        });
        e.sub(&e.sqr(&e.mul(&n, self.values.of(test.distance)?)?)?, &square?)
    }

    /// A direction of so many entries, not all zero.
    fn direction(&self, v: &[i64], m: usize) -> Option<Vec<Number>> {
        let is = v.len() == m && v.iter().any(|&v| v != 0);
        is.then(|| v.iter().map(|&v| self.arithmetic.integer(v)).collect())?
    }

    /// `det M`, of as many rows as coordinates.
    fn determinant(&self) -> Option<Number> {
        let legs = &self.problem.legs;
        let row = |a: &Vec<Formula>| a.iter().map(|&a| self.values.of(a).cloned()).collect();
        let rows: Vec<Vec<Number>> =
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
fn determinant(e: &Fixed<BigInt>, rows: &[Vec<Number>]) -> Option<Number> {
    let Some((first, below)) = rows.split_first() else { return e.integer(1) };
    let mut sum = e.integer(0)?;
    for (j, a) in first.iter().enumerate() {
        let without = |row: &Vec<Number>| {
            let mut row = row.clone();
            row.remove(j);
            row
        };
        let minor: Vec<Vec<Number>> = below.iter().map(without).collect();
        let term = e.mul(a, &determinant(e, &minor)?)?;
        sum = if j % 2 == 0 { e.add(&sum, &term)? } else { e.sub(&sum, &term)? };
    }
    Some(sum)
}
