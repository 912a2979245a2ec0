//! Refutations: one machine, one point, one obligation that fails there.

mod far;
mod same;
mod singular;
mod violated;

use crate::arithmetic::{Arithmetic, Enclosure};
use crate::certificate::{Failure, Witness, PRECISIONS};
use crate::claim::Workspace;
use crate::fixed::{Fixed, Interval};
use crate::formula::{Formula, Op, Values};
use crate::input::{ordered, sign, ClaimError};
use crate::number::Expression;
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::Slopes;
use num_bigint::BigInt;
use std::borrow::Cow;
use thiserror::Error;
use violated::At;

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

/// A machine's formulas at a point.
type AtPoint<'a> = At<'a, Fixed<BigInt>>;

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
        is_between(x, min, max).then_some(()).ok_or(WitnessError::OutsideTolerance)?;
    }
    if machine.next().is_some() {
        return Err(WitnessError::OutsideTolerance);
    }
    let at = AtPoint::new(problem, workspace, witness, &witness.point)?;
    let violated = match &witness.fails {
        Failure::Reach => at.is_undefined(),
        Failure::Obligation(number, directions) => {
            let obligation = problem.obligations.get(*number);
            let test = &obligation.ok_or(WitnessError::NoSuchObligation)?.test;
            match (test, &directions[..]) {
                (Test::Accuracy(test), [v]) => at.is_positive(at.far(test, v)),
                _ => at.fails(test, directions)?,
            }
        }
        Failure::Same { obligation, least, greatest, inverse } => {
            let test = problem.obligations.get(*obligation).map(|obligation| &obligation.test);
            if !matches!(test, Some(Test::OneToOne(_))) {
                return Err(WitnessError::NoSuchObligation);
            }
            let other = [least.as_slice(), greatest];
            same::is_beside(problem, workspace, &witness.point, other)?;
            at.has_the_joints_of(other, inverse).is_some()
        }
        Failure::Row(number, leg) => at.exceeds(*number, *leg),
        Failure::Singular(other) => {
            let other = AtPoint::new(problem, workspace, witness, other)?;
            at.opposite(&other)
        }
        Failure::Dependent => singular::is_singular(problem, witness) == Some(true),
    };
    if violated || fails_by_names(problem, witness) == Some(true) {
        Ok(())
    } else {
        Err(WitnessError::NotViolated)
    }
}

/// Whether a witness over a cell of an atlas fails in slopes in the names, in which its point is
/// enclosed also: what several numbers share cancels. What is asked of two points is not seen.
fn fails_by_names(problem: &Problem, witness: &Witness) -> Option<bool> {
    if problem.names.is_empty() {
        return None;
    }
    let bits = witness.precision;
    let arithmetic = Fixed::<BigInt>::new(bits);
    let slopes = Slopes::new(&arithmetic, problem.dimension() + problem.names.len());
    let parameters = problem.parameters(bits, &witness.machine).ok()?;
    let varying = problem.varying(bits);
    let values = problem.tape.run(&slopes, |op| match op {
        Op::Coordinate(k) => {
            let x = witness.point.get(k)?;
            let fixed = || slopes.constant(problem.point(std::slice::from_ref(x), bits)?.pop()?);
            problem.sloped(x, problem.scale, bits).or_else(fixed)
        }
        Op::Parameter(j) => match varying.get(j)? {
            Some(slope) => Some(slope.clone()),
            None => slopes.constant(parameters.get(j)?.clone()),
        },
        _ => None,
    });
    Some(fails_throughout(problem, slopes, &values, &witness.fails))
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
        witness: &Witness,
        point: &[Expression],
    ) -> Result<Self, WitnessError> {
        if !contains(problem, workspace, point) {
            return Err(WitnessError::Outside);
        }
        let bits = witness.precision;
        let arithmetic = Fixed::new(bits);
        let parameters: Vec<Number> = problem.parameters(bits, &witness.machine)?;
        let point = problem.point(point, bits).ok_or(WitnessError::Outside)?;
        let values = Cow::Owned(values_at(problem, &arithmetic, &point, &parameters));
        let at = At { problem, arithmetic, values, point, parameters };
        if at.is_turned(&at.point, |g| at.values.of(g)) {
            Ok(at)
        } else {
            Err(WitnessError::Outside)
        }
    }

    /// Whether coordinates of orientation, of a point or a box, are certainly those of the claim's;
    /// `value` encloses its inequality there.
    fn is_turned<'v>(
        &self,
        point: &[Number],
        value: impl Fn(Formula) -> Option<&'v Number>,
    ) -> bool {
        let c = point.iter().skip(self.problem.corners[0].len());
        let bits = self.arithmetic.bits();
        let in_box = c.zip(&self.problem.orientation).all(|(c, [min, max])| {
            let ends = min.enclose(bits, None).zip(max.enclose(bits, None));
            ends.is_some_and(|(min, max)| min.hi <= c.lo && c.hi <= max.lo)
        });
        let g = self.problem.turned.map(value);
        in_box && g.is_none_or(|g| g.is_some_and(|g| self.arithmetic.is_nonnegative(g)))
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
        let signs = |at: &Self| {
            let det = at.determinant();
            let negative = det.as_ref().and_then(|det| at.arithmetic.neg(det));
            [at.is_positive(det), at.is_positive(negative)]
        };
        matches!((signs(self), signs(other)), ([true, _], [_, true]) | ([_, true], [true, _]))
    }
}
