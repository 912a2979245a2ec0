//! Refutations: one machine, one point, one obligation that fails there.

mod far;
mod same;
mod singular;
mod violated;

use crate::arithmetic::{Arithmetic as _, Enclosure as _};
use crate::certificate::{Failure, Witness, PRECISIONS};
use crate::claim::{Quantity, Workspace};
use crate::fixed::{Fixed, Interval};
use crate::formula::{Formula, Tape, Values};
use crate::input::{ordered, sign, sloped, ClaimError, Value};
use crate::machine::Joint;
use crate::number::Expression;
use crate::problem::Problem;
use crate::quantity::{determinant, Test};
use crate::slope::{evaluate, Slope, Slopes};
use crate::vary::MOST_PARAMETERS;
use num_bigint::BigInt;
use thiserror::Error;
use violated::Enclosed;

pub use violated::fails_throughout;

/// Why a witness refutes nothing.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WitnessError {
    /// The precision is not admissible.
    #[error("{0} bits are not admissible")]
    Precision(u32),
    /// The point is not certainly in the workspace.
    #[error("the point is not certainly in the workspace")]
    Outside,
    /// The machine is not certainly one of the claim's.
    #[error("the machine is not certainly within the tolerances")]
    OutsideTolerance,
    /// A number cannot be enclosed.
    #[error(transparent)]
    Claim(#[from] ClaimError),
    /// There is no such obligation, or the directions are not of its kind.
    #[error("there is no such obligation")]
    NoSuchObligation,
    /// What it names is not certainly violated there.
    #[error("nothing is certainly violated at the point")]
    NotViolated,
}

/// Numbers at a point.
type Number = Interval<BigInt>;

/// A machine's formulas at a point: over a cell without coordinates, whose values are its range.
struct AtPoint<'a> {
    problem: &'a Problem,
    slopes: Slopes<'a, Fixed<BigInt>>,
    point: Vec<Number>,
    parameters: Vec<Number>,
    values: Values<Slope<Number>>,
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
    let mut machine = problem.tolerances().zip(&witness.machine);
    if witness.machine.len() != problem.tolerances().count()
        || !machine.all(|((_, min, max), x)| is_between(x, min, max))
    {
        return Err(WitnessError::OutsideTolerance);
    }
    let arithmetic = Fixed::new(witness.precision);
    let at = AtPoint::new(problem, workspace, (witness, &witness.point), &arithmetic)?;
    let test = |number: &usize| problem.obligations.get(*number).map(|obligation| &obligation.test);
    let violated = match &witness.fails {
        Failure::Obligation(number, directions) => match (test(number), &directions[..]) {
            (Some(Test::Accuracy(test)), [v]) => {
                at.far(test, v).is_some_and(|rest| arithmetic.is_positive(&rest))
            }
            _ => at.formulas().fail(&witness.fails)?,
        },
        Failure::Same { obligation, least, greatest, inverse } => {
            if !matches!(test(obligation), Some(Test::OneToOne(_))) {
                return Err(WitnessError::NoSuchObligation);
            }
            let other = [least.as_slice(), greatest];
            same::is_beside(problem, workspace, &witness.point, other)?;
            at.has_the_joints_of(other, inverse).is_some()
        }
        Failure::Singular(other) => {
            let other = AtPoint::new(problem, workspace, (witness, other), &arithmetic)?;
            at.opposite(&other)
        }
        Failure::Dependent => singular::is_singular(problem, witness) == Some(true),
        Failure::Reach | Failure::Row(..) => at.formulas().fail(&witness.fails)?,
    };
    let violated = violated || fails_by_names(&at, witness);
    violated.then_some(()).ok_or(WitnessError::NotViolated)
}

/// Whether a witness over a cell of an atlas fails in slopes in its names, in which its point is
/// enclosed also: what several numbers share cancels. What is asked of two points is not seen.
fn fails_by_names(at: &AtPoint<'_>, witness: &Witness) -> bool {
    let (problem, bits) = (at.problem, witness.precision);
    let slopes = Slopes::new(at.slopes.arithmetic, MOST_PARAMETERS);
    let either = |x: &Expression, scale: i64, range: &Number| match x.varies() {
        true => sloped(x, scale, bits),
        false => slopes.constant(range.clone()),
    };
    let coordinate = |k| either(witness.point.get(k)?, problem.scale_of(k), at.point.get(k)?);
    let parameter = |j: usize| {
        let (input, range) = (problem.inputs.get(j)?, at.parameters.get(j)?);
        match &input.value {
            Value::Quantity(Quantity::Exactly(x)) => either(x, input.scale, range),
            _ => slopes.constant(range.clone()),
        }
    };
    let values = problem.tape.run(&slopes, coordinate, parameter);
    fails_throughout(problem, slopes, &values, &witness.fails)
}

fn is_between(x: &Expression, min: &Expression, max: &Expression) -> bool {
    ordered("", min, x, false).is_ok() && ordered("", x, max, false).is_ok()
}

/// Whether a point is certainly in a workspace whose box has these corners. What is said of its
/// orientation is decided with its formulas.
fn contains(problem: &Problem, workspace: &Workspace, point: &[Expression]) -> bool {
    let [min, max] = &problem.corners;
    let in_box = point.len() == problem.dimension()
        && point.iter().zip(min).zip(max).all(|((x, min), max)| is_between(x, min, max));
    let Workspace::Cylinder { center, radius, .. } = workspace else { return in_box };
    let square = |x: &Expression| x * x;
    let start = square(radius);
    let rest =
        point.iter().zip(center).fold(start, |rest, (x, center)| &rest - &square(&(x - center)));
    in_box && matches!(sign(&rest), Some([_, true]))
}

impl<'a> AtPoint<'a> {
    fn new(
        problem: &'a Problem,
        workspace: &Workspace,
        (witness, point): (&Witness, &[Expression]),
        arithmetic: &'a Fixed<BigInt>,
    ) -> Result<Self, WitnessError> {
        if !contains(problem, workspace, point) {
            return Err(WitnessError::Outside);
        }
        let (bits, slopes) = (witness.precision, Slopes::new(arithmetic, 0));
        let parameters = problem.parameters(bits, &witness.machine)?;
        let point = problem.point(point, bits).ok_or(WitnessError::Outside)?;
        let mut at = AtPoint { problem, slopes, point, parameters, values: Values::default() };
        at.values = at.values_of(&problem.tape, &at.parameters);
        at.is_turned(&at.point, &at.values).then_some(at).ok_or(WitnessError::Outside)
    }

    /// The formulas of a tape, of the machine with these parameters.
    fn values_of(&self, tape: &Tape, parameters: &[Number]) -> Values<Slope<Number>> {
        let edge = |x: &Number| [x.clone(), x.clone(), Number::default()];
        let edges: Vec<_> = self.point.iter().map(edge).collect();
        evaluate(tape, parameters, self.slopes, &edges)
    }

    /// A joint's coordinate by the one values less that by the other; of angles the sine of this, and its
    /// cosine, which is positive.
    fn off(
        e: Slopes<'_, Fixed<BigInt>>,
        joint: Joint,
        [one, other]: [&Values<Slope<Number>>; 2],
    ) -> Option<(Slope<Number>, Option<Slope<Number>>)> {
        Some(match joint {
            Joint::Length(rho) => (e.sub(one.of(rho)?, other.of(rho)?)?, None),
            Joint::Angle { cos, sin } => {
                let (c, s, c2, s2) = (one.of(cos)?, one.of(sin)?, other.of(cos)?, other.of(sin)?);
                let along = e.add(&e.mul(c, c2)?, &e.mul(s, s2)?)?;
                let across = e.sub(&e.mul(s, c2)?, &e.mul(c, s2)?)?;
                e.arithmetic.is_positive(&along.range).then_some((across, Some(along)))?
            }
        })
    }

    fn formulas(&self) -> Enclosed<'_, Fixed<BigInt>> {
        Enclosed { problem: self.problem, slopes: self.slopes, values: &self.values }
    }

    /// The value of a formula.
    fn of(&self, f: Formula) -> Option<&Number> {
        Some(&self.values.of(f)?.range)
    }

    /// Whether coordinates of orientation, of a point or a box, are certainly those of the claim's,
    /// given the values of formulas there.
    fn is_turned(&self, point: &[Number], values: &Values<Slope<Number>>) -> bool {
        let (e, c) = (self.slopes.arithmetic, point.iter().skip(self.problem.corners[0].len()));
        let in_box = c.zip(&self.problem.orientation).all(|(c, [min, max])| {
            let ends = min.enclose(e.bits(), None).zip(max.enclose(e.bits(), None));
            ends.is_some_and(|(min, max)| min.hi <= c.lo && c.hi <= max.lo)
        });
        let holds = |g: Formula| values.of(g).is_some_and(|g| e.is_nonnegative(&g.range));
        in_box && self.problem.turned.is_none_or(holds)
    }

    /// **Lemma.** If `det M` of one machine has opposite signs at two points of a path-connected
    /// workspace, as all are here, the claim is false. *Proof.* If every formula is defined, and every
    /// leg reaches without a serial singularity, on a path between them, `det M` is continuous there and
    /// vanishes somewhere: a parallel singularity. Otherwise some point has no such leg. ∎ (A divisor of
    /// the rows that changes its sign is zero somewhere, and a formula of the claim not defined there.)
    ///
    /// Boxes, cylinders, and `|c| <= t` are convex, and products of convex sets are. The orientations
    /// `c_1^2 + c_2^2 <= t^2 (1 + c_3^2)`, `|c_3| <= s` are not, but connected: those with one `c_3` are a
    /// disc, in which a segment leads to `(0, 0, c_3)`, and these are a segment of the set.
    fn opposite(&self, other: &Self) -> bool {
        let rows: Vec<Vec<Formula>> =
            self.problem.legs.iter().map(|leg| leg.divided.a.clone()).collect();
        let mut tape = self.problem.tape.clone();
        let is_square = rows.len() == self.problem.dimension();
        let det = is_square.then(|| determinant(&mut tape, &rows));
        let signs = |at: &Self| {
            let (e, values) = (at.slopes.arithmetic, at.values_of(&tape, &at.parameters));
            let det = &values.of(det?)?.range;
            Some([e.is_positive(det), e.is_positive(&e.neg(det)?)])
        };
        matches!(
            (signs(self), signs(other)),
            (Some([true, _]), Some([_, true])) | (Some([_, true]), Some([true, _]))
        )
    }
}
