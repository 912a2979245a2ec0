//! The worst values found of every requirement, as rows of a table.

use super::place::{machine_at, Frame, FreeParameter};
use crate::decimal::readable;
use crate::sample::{Quality, Reached, Sampler, Values};
use crate::verify::Worst;
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Range, Workspace};
use orthocert_checker::number::Exact;
use orthocert_checker::rule::Obligation;
use serde::Serialize;

/// Relative violations below this are rounding errors of the sampling.
const NOISE: f64 = 1e-12;

/// A requirement, its bound, and the worst value that sampling has found of it: not a proof.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The requirement's name.
    pub requirement: String,
    /// The bound, for people.
    #[serde(skip)]
    pub bound_text: String,
    /// The bound, exact: a relation and a number.
    pub bound: String,
    /// The worst value found; `None` where some leg does not reach the point.
    pub worst_found: Option<f64>,
    /// Where it was found, in the design's unit.
    pub at: [f64; 3],
    /// The machine for which it was found: parameters with a tolerance.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<FreeParameter>,
    /// Whether the value found is on the wrong side of the bound.
    pub seems_violated: bool,
}

/// The rows of a verification's worst values.
pub fn rows(claim: &MachineClaim, sampler: &Sampler, frame: &Frame, worst: &[Worst]) -> Vec<Row> {
    let row = |found: &Worst| {
        let values = sampler.at(&found.place);
        let Bound { requirement, relation, number } = bound(claim, found.quality)?;
        Some(Row {
            requirement,
            bound_text: format!("{relation} {}", readable(&number)),
            bound: format!("{relation} {number}"),
            worst_found: value(claim, found.quality, &values, frame),
            at: frame.point(&found.place.u),
            machine: machine_at(claim, &found.place),
            seems_violated: found.margin < -NOISE,
        })
    };
    worst.iter().filter_map(row).collect()
}

/// A requirement in words and numbers: `greatest psi`, `<=`, `2`.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Its name.
    pub requirement: String,
    /// `<=`, `>=` or `>`, or `!=`.
    pub relation: &'static str,
    /// The other side.
    pub number: Exact,
}

/// What a claim demands of a quality; `None` if nothing.
pub fn bound(claim: &MachineClaim, quality: Quality) -> Option<Bound> {
    let transmission = claim.requirements.transmission.as_ref();
    let joint_range =
        |leg: usize| -> Option<&Range> { claim.requirements.joint_range.as_ref()?.get(leg) };
    let new = |requirement: String, relation, number| Some(Bound { requirement, relation, number });
    match quality {
        Quality::Clearance => new(clearance_name(claim).into(), ">", Exact::integer(0)),
        Quality::Determinant => new("|det M|".into(), ">", Exact::integer(0)),
        Quality::GreatestPsi => new("greatest psi".into(), "<=", transmission?.max.clone()?),
        Quality::LeastPsi => {
            let Range { min, max } = transmission?;
            let psi_min = match (&claim.workspace, min, max) {
                (Workspace::Cube { .. }, None, Some(psi_max)) => {
                    Exact::integer(1).over(psi_max.clone()).ok()?
                }
                _ => min.clone()?,
            };
            new("least psi".into(), ">=", psi_min)
        }
        Quality::LeastRho(leg) => {
            new(format!("least rho_{}", leg + 1), ">=", joint_range(leg)?.min.clone()?)
        }
        Quality::GreatestRho(leg) => {
            new(format!("greatest rho_{}", leg + 1), "<=", joint_range(leg)?.max.clone()?)
        }
    }
}

/// Whether every leg is a slider, whose clearance is `s_i^2`.
fn all_sliders(claim: &MachineClaim) -> bool {
    match &claim.mechanism {
        Mechanism::Orthoglide { .. } => true,
        Mechanism::Translational(legs) => legs.iter().all(|leg| matches!(leg, Leg::Slider { .. })),
    }
}

fn clearance_name(claim: &MachineClaim) -> &'static str {
    if all_sliders(claim) {
        "least s"
    } else {
        "least clearance"
    }
}

/// The value of a quality, in the design's unit.
fn value(claim: &MachineClaim, quality: Quality, values: &Values, frame: &Frame) -> Option<f64> {
    let Reached { matrix, xi, rho } = values.reached.as_ref()?;
    Some(match quality {
        Quality::Clearance if all_sliders(claim) => values.clearance.max(0.0).sqrt() * frame.unit,
        Quality::Clearance => values.clearance,
        Quality::Determinant => matrix.determinant().abs(),
        Quality::GreatestPsi => xi[0].recip(),
        Quality::LeastPsi => xi[2].recip(),
        Quality::LeastRho(leg) | Quality::GreatestRho(leg) => rho[leg] * frame.unit,
    })
}

/// The obligation that a quality belongs to.
pub fn obligation(quality: Quality) -> Obligation {
    match quality {
        Quality::Clearance | Quality::Determinant | Quality::GreatestPsi => Obligation::SigmaMin,
        Quality::LeastPsi => Obligation::SigmaMax,
        Quality::LeastRho(_) | Quality::GreatestRho(_) => Obligation::JointRange,
    }
}
