//! Refutations: one machine, one point, one provably violated requirement.

use crate::cell::Cell;
use crate::certificate::{Violation, Witness, PRECISIONS};
use crate::claim::{ClaimError, Leg, MachineClaim, Mechanism, Workspace};
use crate::enclosure::{Enclosure, Scalar};
use crate::fixed::Fixed;
use crate::kinematics::LegState;
use crate::linear::{determinant, Matrix};
use crate::model::{CubeConstants, Model};
use crate::number::Exact;
use crate::rule::{self, Failure};
use std::cmp::Ordering;
use std::fmt;

/// Why a witness does not refute its claim.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WitnessError {
    /// The precision is not admissible.
    Precision(u32),
    /// A point is not provably in the workspace.
    OutsideWorkspace,
    /// A machine is given where the claim has no tolerance, or the reverse.
    MachineMismatch,
    /// The machine's leg (from one) is not provably within the claim's tolerances.
    OutsideTolerance(usize),
    /// The numbers cannot be enclosed.
    Claim(ClaimError),
    /// A leg number that is not 1, 2 or 3.
    NoSuchLeg(usize),
    /// A direction that is zero.
    ZeroVector,
    /// The claim has no such requirement.
    NoSuchBound,
    /// The requirement is not provably violated there.
    NotViolated,
}

impl From<ClaimError> for WitnessError {
    fn from(error: ClaimError) -> Self {
        WitnessError::Claim(error)
    }
}

impl From<Failure> for WitnessError {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::NoSuchBound => WitnessError::NoSuchBound,
            Failure::NoSuchLeg(leg) => WitnessError::NoSuchLeg(leg),
            Failure::ZeroVector => WitnessError::ZeroVector,
            _ => WitnessError::NotViolated,
        }
    }
}

impl fmt::Display for WitnessError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WitnessError::Precision(bits) => write!(f, "precision {bits} is not admissible"),
            WitnessError::OutsideWorkspace => {
                write!(f, "a point is not provably in the workspace")
            }
            WitnessError::MachineMismatch => write!(
                f,
                "a machine is to be given exactly if the claim has tolerances, with the same drives"
            ),
            WitnessError::OutsideTolerance(leg) => {
                write!(f, "leg {leg} of the machine is not provably within its tolerances")
            }
            WitnessError::Claim(error) => error.fmt(f),
            WitnessError::NoSuchLeg(leg) => write!(f, "there is no leg {leg}"),
            WitnessError::ZeroVector => write!(f, "the vector is zero"),
            WitnessError::NoSuchBound => write!(f, "the claim has no such requirement"),
            WitnessError::NotViolated => {
                write!(f, "the requirement is not provably violated at the point")
            }
        }
    }
}

/// Accepts a witness that proves `claim` false.
pub fn check(claim: &MachineClaim, witness: &Witness) -> Result<(), WitnessError> {
    if !PRECISIONS.contains(&witness.precision) {
        return Err(WitnessError::Precision(witness.precision));
    }
    claim.validate()?;
    admit_machine(claim, witness.machine.as_ref())?;
    violated_at_the_point(claim, witness)
}

/// Accepts a witness, without a machine, that proves the claim false of **every** machine within
/// its tolerances: at one point, every one of them violates the same requirement.
///
/// **Lemma.** The evaluation below without a machine is that of [`check`] with every parameter
/// enclosed by its whole interval. An enclosure that is certainly beyond a bound is so for the value
/// of every machine. ∎
///
/// # Errors
/// If it does not.
pub fn check_every_machine(claim: &MachineClaim, witness: &Witness) -> Result<(), WitnessError> {
    if !PRECISIONS.contains(&witness.precision) {
        return Err(WitnessError::Precision(witness.precision));
    }
    if witness.machine.is_some() {
        return Err(WitnessError::MachineMismatch);
    }
    claim.validate()?;
    violated_at_the_point(claim, witness)
}

fn violated_at_the_point(claim: &MachineClaim, witness: &Witness) -> Result<(), WitnessError> {
    let model = model_at(claim, witness, &witness.point)?;
    match &witness.violates {
        Violation::Singular(second) => {
            opposite_signs(&model, &model_at(claim, witness, &second.other)?)
        }
        // The model has no width: every cell of it is the point.
        violation => Ok(rule::violated(&model, &Cell::ROOT, violation)?),
    }
}

/// The witness's machine is one that the claim is about.
fn admit_machine(claim: &MachineClaim, machine: Option<&[Leg; 3]>) -> Result<(), WitnessError> {
    let legs: &[Leg] = match &claim.mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Orthoglide { .. } => &[],
    };
    let toleranced = legs.iter().any(Leg::has_tolerance);
    let machine = match (machine, toleranced) {
        (None, false) => return Ok(()),
        (Some(machine), true) => machine,
        _ => return Err(WitnessError::MachineMismatch),
    };
    for (i, (given, claimed)) in machine.iter().zip(legs).enumerate() {
        if !given.same_kind(claimed) {
            return Err(WitnessError::MachineMismatch);
        }
        let within = given
            .parameters()
            .iter()
            .zip(claimed.parameters())
            .all(|((_, x), (_, range))| x.is_exact() && range.admits(&x.min));
        if !within {
            return Err(WitnessError::OutsideTolerance(i + 1));
        }
    }
    Ok(())
}

fn model_at(
    claim: &MachineClaim,
    witness: &Witness,
    point: &[Exact; 3],
) -> Result<Model<Fixed>, WitnessError> {
    if !contains(claim, point)? {
        return Err(WitnessError::OutsideWorkspace);
    }
    Ok(Model::at_point(claim, witness.machine.as_ref(), point, witness.precision)?)
}

/// Whether `point` is provably in the workspace.
fn contains(claim: &MachineClaim, point: &[Exact; 3]) -> Result<bool, WitnessError> {
    let at_most =
        |x: &Exact, y: &Exact| matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal));
    let (min, max) = match &claim.workspace {
        Workspace::Box { min, max } => (min.clone(), max.clone()),
        Workspace::Cylinder { center, radius, z } => {
            let squared = |x: Exact| x.clone().times(x);
            let from_axis = |k: usize| squared(point[k].clone().minus(center[k].clone())?);
            let distance = || from_axis(0)?.plus(from_axis(1)?);
            let (Ok(distance), Ok(radius)) = (distance(), squared(radius.clone())) else {
                return Ok(false);
            };
            return Ok(at_most(&distance, &radius)
                && at_most(&z[0], &point[2])
                && at_most(&point[2], &z[1]));
        }
        Workspace::Cube { side } => {
            let psi_max = claim.requirements.transmission.as_ref().and_then(|t| t.max.as_ref());
            let psi_max = psi_max.ok_or(ClaimError::CubeNeedsPsiMax)?;
            let cube = CubeConstants::new(psi_max, side)?;
            let in_length_units = |q: Exact| {
                q.over(cube.inverse_length.clone())
                    .map_err(|_| ClaimError::Precision("workspace.cube".into()))
            };
            let q1 = in_length_units(cube.q1.clone())?;
            let q2 = in_length_units(cube.q2.clone())?;
            ([q1.clone(), q1.clone(), q1], [q2.clone(), q2.clone(), q2])
        }
    };
    Ok((0..3).all(|k| at_most(&min[k], &point[k]) && at_most(&point[k], &max[k])))
}

fn states(model: &Model<Fixed>) -> Option<[LegState<Fixed>; 3]> {
    let [a, b, c] = &model.origin;
    Some([model.legs[0].at(a)?, model.legs[1].at(b)?, model.legs[2].at(c)?])
}

fn matrix(model: &Model<Fixed>) -> Result<Matrix<Fixed>, WitnessError> {
    let states = states(model).ok_or(WitnessError::NotViolated)?;
    Ok(states.map(|state| state.row))
}

fn violated(provably: bool) -> Result<(), WitnessError> {
    if provably {
        Ok(())
    } else {
        Err(WitnessError::NotViolated)
    }
}

/// **Lemma.** If one machine's `det M` has opposite signs at two points of a convex workspace, as
/// boxes and cylinders are, the workspace has a singularity or a point out of reach. *Proof.* If
/// every leg reaches every point of the segment between them with `s_i > 0`, then `det M` is
/// continuous on it and vanishes somewhere: a parallel singularity. Otherwise some point is out of
/// reach or serially singular. ∎
fn opposite_signs(one: &Model<Fixed>, other: &Model<Fixed>) -> Result<(), WitnessError> {
    let (one, other) = (determinant(&matrix(one)?), determinant(&matrix(other)?));
    violated(
        (one.is_positive() && other.neg().is_positive())
            || (one.neg().is_positive() && other.is_positive()),
    )
}
