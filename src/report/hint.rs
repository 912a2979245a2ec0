//! What may have gone wrong in the design of a claim that is refuted.

use super::Counterexample;
use crate::exact::decimal::significant;
use crate::report::requirement::SINGULARITY;
use crate::search::solver::approximate;
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_kernel::number::Expression;

/// A workspace that is so many times as long as a leg is not meant.
const OUT_OF_PROPORTION: f64 = 20.0;

/// Legs that are far too short for the workspace: a number in another unit.
pub fn hint(claim: &MachineClaim, found: &Counterexample) -> Option<String> {
    let legs = match &claim.mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Planar(machine) | Mechanism::Spatial(machine) => &machine.legs,
        Mechanism::Orthoglide { .. } | Mechanism::Spherical(_) | Mechanism::Formulas(_) => {
            return None;
        }
    };
    let across = across(&claim.workspace)?;
    let lengths = legs.iter().map(reach).enumerate();
    let (leg, length) = lengths
        .filter_map(|(leg, length)| Some((leg + 1, length?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (found.rule == SINGULARITY && across > OUT_OF_PROPORTION * length).then(|| {
        format!(
            "leg {leg} reaches {} from its joint, and the workspace is {} across: are all lengths in \
             one unit?",
            significant(length, 4),
            significant(across, 4)
        )
    })
}

/// How far a leg of fixed length reaches.
fn reach(leg: &Leg) -> Option<f64> {
    let greatest = |x: &Quantity| match x {
        Quantity::Exactly(x) | Quantity::Between { max: x, .. } => approximate(x),
    };
    match leg {
        Leg::Slider { length, .. } => greatest(length),
        Leg::Arm { arm, length, .. } => Some(greatest(arm)? + greatest(length)?),
        _ => None,
    }
}

/// The diagonal of the box around a workspace.
fn across(workspace: &Workspace) -> Option<f64> {
    let edges: Vec<f64> = match workspace {
        Workspace::Box { min, max } => {
            let edge = |(min, max): (&Expression, &Expression)| {
                Some(approximate(max)? - approximate(min)?)
            };
            min.iter().zip(max).map(edge).collect::<Option<_>>()?
        }
        Workspace::Cylinder { radius, z, .. } => {
            let across = 2.0 * approximate(radius)?;
            vec![across, across, approximate(&z[1])? - approximate(&z[0])?]
        }
        Workspace::Cube { .. } => return None,
    };
    Some(edges.iter().map(|edge| edge * edge).sum::<f64>().sqrt())
}
