//! The worst values found of every requirement, as rows of a table.

use super::place::{machine_at, Frame, FreeParameter};
use crate::decimal::{approximate, readable};
use crate::exact::Exact;
use crate::sample::{with_unit, Quality, Reached, Sampler, Values};
use crate::verify::Worst;
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Range, Workspace};
use serde::Serialize;

/// Relative violations below this are rounding errors of the sampling.
const NOISE: f64 = 1e-12;

/// A requirement, its bound, and the worst value that sampling has found of it: not a proof.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The requirement's name.
    pub requirement: String,
    /// The unit of the bound and of the value, where they have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// The bound, for people.
    #[serde(skip)]
    pub bound_text: String,
    /// The bound, exact: a relation and a number.
    pub bound: String,
    /// The worst value found; `None` where some leg does not reach the point.
    pub worst_found: Option<f64>,
    /// Where it was found, in the design's unit.
    pub at: Vec<f64>,
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
        let unit = found.quality.unit(claim.mechanism.is_angular());
        Some(Row {
            requirement,
            unit,
            bound_text: format!("{relation} {}", readable(&number)),
            bound: format!("{relation} {number}"),
            worst_found: value(claim, found.quality, &values, frame),
            at: frame.place(&sampler.within(found.place.u)).to_vec(),
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
    let demands = &claim.requirements;
    let transmission = demands.transmission.as_ref();
    let joint_range = |leg: usize| -> Option<&Range> { demands.joint_range.as_ref()?.get(leg) };
    let (requirement, relation, number) = match quality {
        Quality::Clearance => (clearance_name(claim).to_owned(), ">", Exact::integer(0)),
        Quality::Determinant => ("least |det M|".to_owned(), ">", Exact::integer(0)),
        Quality::GreatestPsi => ("greatest psi".to_owned(), "<=", transmission?.max.clone()?),
        Quality::LeastPsi => ("least psi".to_owned(), ">=", psi_min(claim)?),
        Quality::LeastRho(leg) => {
            (format!("least rho_{}", leg + 1), ">=", joint_range(leg)?.min.clone()?)
        }
        Quality::GreatestRho(leg) => {
            (format!("greatest rho_{}", leg + 1), "<=", joint_range(leg)?.max.clone()?)
        }
        Quality::Conditioning => {
            ("condition number".to_owned(), "<=", demands.conditioning.as_ref()?.max.clone())
        }
        Quality::SerialMargin(leg) => {
            let min = demands.serial_margin.as_ref()?.min.clone();
            (format!("serial margin {}", leg + 1), ">=", min)
        }
        Quality::ParallelMargin => {
            ("parallel margin".to_owned(), ">=", demands.parallel_margin.as_ref()?.min.clone())
        }
        Quality::LegAngle(leg) => {
            let max = demands.leg_angle.as_ref()?.max.clone();
            (format!("leg angle {}", leg + 1), "<=", max)
        }
        Quality::JointSpeed(leg) => {
            let max = demands.joint_speed.as_ref()?.max.clone();
            (format!("joint speed {}", leg + 1), "<=", max)
        }
    };
    let requirement = with_unit(&requirement, quality.unit(claim.mechanism.is_angular()));
    Some(Bound { requirement, relation, number })
}

/// `psi_min`; on the paper's cube it is `1/psi_max`.
fn psi_min(claim: &MachineClaim) -> Option<Exact> {
    let Range { min, max } = claim.requirements.transmission.as_ref()?;
    match (&claim.workspace, max) {
        (Workspace::Cube { .. }, Some(psi_max)) => Exact::integer(1).over(psi_max.clone()).ok(),
        _ => min.clone(),
    }
}

fn legs(claim: &MachineClaim) -> &[Leg] {
    match &claim.mechanism {
        Mechanism::Orthoglide { .. } => &[],
        Mechanism::Translational(legs) => legs,
    }
}

/// Whether every leg is a slider, whose clearance is `s_i^2`.
fn all_sliders(claim: &MachineClaim) -> bool {
    legs(claim).iter().all(|leg| matches!(leg, Leg::Slider { .. }))
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
    let Reached { matrix, xi, rho, cosine, unit_determinant } = values.reached.as_ref()?;
    // Rows of M are without unit, or inverse lengths for angular joints.
    let (length, joint) =
        if claim.mechanism.is_angular() { (frame.unit, 1.0) } else { (1.0, frame.unit) };
    Some(match quality {
        Quality::Clearance if all_sliders(claim) => values.clearance.max(0.0).sqrt() * frame.unit,
        Quality::Clearance => values.clearance,
        Quality::Determinant => matrix.determinant().abs() / length.powi(3),
        Quality::GreatestPsi => length / xi[0],
        Quality::LeastPsi => length / xi[2],
        Quality::LeastRho(leg) | Quality::GreatestRho(leg) => rho[leg] * joint,
        Quality::Conditioning => xi[2] / xi[0],
        Quality::SerialMargin(leg) => cosine[leg]?,
        Quality::ParallelMargin => unit_determinant.abs(),
        Quality::LegAngle(leg) => cosine[leg]?.min(1.0).acos().to_degrees(),
        Quality::JointSpeed(leg) => {
            let tool = approximate(&claim.requirements.joint_speed.as_ref()?.tool)?;
            let angle = if claim.mechanism.is_angular() { 1f64.to_degrees() } else { 1.0 };
            matrix.row(leg).norm() / length * angle * tool
        }
    })
}
