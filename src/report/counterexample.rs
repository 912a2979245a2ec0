//! A refutation's witness in words, with certified digits of the value that violates the claim.

use super::place::named_parameters;
use super::worst::{bound, Bound};
use crate::decimal::{exact, rounded, Toward};
use crate::sample::Quality;
use num_rational::BigRational;
use orthocert_checker::certificate::{Violation, Witness};
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Workspace};
use orthocert_checker::enclosure::Scalar;
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{apply, determinant, norm_squared, Matrix, Vector};
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::number::Exact;
use serde::Serialize;

/// Digits of a violating value: as few as show the violation, within these limits.
const DIGITS: std::ops::RangeInclusive<u32> = 6..=40;
/// Fractional bits in which a bound is compared with the digits shown.
const BOUND_BITS: u32 = 256;

/// The point, the machine and the requirement that is provably violated there.
#[derive(Clone, Debug, Serialize)]
pub struct Counterexample {
    /// What is violated: `greatest psi <= 2`.
    pub violated: String,
    /// The value there, with certified digits: `greatest psi >= 2.0050`.
    pub value: String,
    /// `P`, exact.
    pub point: [Exact; 3],
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_point: Option<[Exact; 3]>,
    /// The parameters with a tolerance, exact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<Setting>,
    /// The direction of motion that is transmitted too fast or too slowly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[i64; 3]>,
}

/// The value that a witness gives to a parameter with a tolerance.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// The leg, counted from one.
    pub leg: usize,
    /// The parameter's name.
    pub parameter: String,
    /// Its value, exact.
    pub value: Exact,
}

impl Counterexample {
    /// The words for a witness that refutes `claim`.
    pub fn new(claim: &MachineClaim, witness: &Witness) -> Self {
        let (violated, value) = violation(claim, witness)
            .unwrap_or_else(|| ("a requirement".to_owned(), "beyond the bound".to_owned()));
        let (other_point, direction) = match &witness.violates {
            Violation::Singular(second) => (Some(second.other.clone()), None),
            Violation::SigmaMin(d) | Violation::SigmaMax(d) => (None, Some(d.vector)),
            _ => (None, None),
        };
        let machine = settings(claim, witness);
        Counterexample {
            violated,
            value,
            point: witness.point.clone(),
            other_point,
            machine,
            direction,
        }
    }
}

fn settings(claim: &MachineClaim, witness: &Witness) -> Vec<Setting> {
    let (Some(machine), Mechanism::Translational(claimed)) = (&witness.machine, &claim.mechanism)
    else {
        return Vec::new();
    };
    let of_leg = |(i, (given, claimed)): (usize, (&Leg, &Leg))| {
        let pairs = named_parameters(given).into_iter().zip(named_parameters(claimed));
        pairs
            .filter(|(_, (_, claimed))| !claimed.is_exact())
            .map(|((parameter, q), _)| Setting { leg: i + 1, parameter, value: q.min })
            .collect::<Vec<_>>()
    };
    machine.iter().zip(claimed).enumerate().flat_map(of_leg).collect()
}

/// What is violated, and the value that violates it.
fn violation(claim: &MachineClaim, witness: &Witness) -> Option<(String, String)> {
    let at =
        |point| Model::at_point(claim, witness.machine.as_ref(), point, witness.precision).ok();
    let model = at(&witness.point)?;
    match &witness.violates {
        Violation::SigmaMin(d) => {
            let psi = speed(&matrix(&model)?, &d.vector)?;
            beyond(claim, Quality::GreatestPsi, &psi)
        }
        Violation::SigmaMax(d) => {
            let psi = speed(&matrix(&model)?, &d.vector)?;
            beyond(claim, Quality::LeastPsi, &psi)
        }
        Violation::Reach(leg) => {
            let violated = format!("leg {} reaches P with s > 0", leg.leg);
            Some((
                violated,
                format!("leg {} cannot reach P, or is serially singular there", leg.leg),
            ))
        }
        Violation::JointRange(leg) => {
            let i = leg.leg.checked_sub(1)?;
            let rho = in_design_unit(claim, &model, &model.legs.get(i)?.at(&model.origin[i])?.rho)?;
            beyond(claim, Quality::LeastRho(i), &rho)
                .or_else(|| beyond(claim, Quality::GreatestRho(i), &rho))
        }
        Violation::Singular(second) => {
            let (one, other) =
                (determinant(&matrix(&model)?), determinant(&matrix(&at(&second.other)?)?));
            let digits = |x: &Fixed| rounded(&x.inf(), *DIGITS.start(), Toward::Below);
            Some((
                "no parallel singularity".to_owned(),
                format!("det M is about {} at P and {} at P'", digits(&one), digits(&other)),
            ))
        }
    }
}

fn matrix(model: &Model<Fixed>) -> Option<Matrix<Fixed>> {
    let row = |i: usize| Some(model.legs[i].at(&model.origin[i])?.row);
    Some([row(0)?, row(1)?, row(2)?])
}

/// `|v| / |M v|`: a velocity transmission factor between the least and the greatest.
fn speed(m: &Matrix<Fixed>, v: &[i64; 3]) -> Option<Fixed> {
    let v: Vector<Fixed> = v.map(|x| Fixed::integer(x, m[0][0].bits()));
    norm_squared(&v).sqrt()?.div(&norm_squared(&apply(m, &v)).sqrt()?)
}

/// A length of the model in the design's unit.
fn in_design_unit(claim: &MachineClaim, model: &Model<Fixed>, x: &Fixed) -> Option<Fixed> {
    if let Some(scale) = model.unit_exponent {
        return Some(x.rescale(-scale, x.bits()));
    }
    let Workspace::Cube { side } = &claim.workspace else {
        return None;
    };
    let psi_max = claim.requirements.transmission.as_ref()?.max.as_ref()?;
    let inverse = CubeConstants::new(psi_max, side).ok()?.inverse_length;
    x.div(&inverse.enclose(0, x.bits())?)
}

/// The quality's bound and its value in as few digits as show on which side of it the value is;
/// `None` unless it is provably on the wrong side.
fn beyond(claim: &MachineClaim, quality: Quality, value: &Fixed) -> Option<(String, String)> {
    let Bound { requirement, relation, number } = bound(claim, quality)?;
    let limit = number.enclose(0, BOUND_BITS)?;
    let parsed = |text: &str| -> Option<BigRational> {
        Exact::parse(text, 1000).ok()?.as_rational().cloned()
    };
    // Rounded towards the bound, so that what is printed is true of the value.
    let (towards, reverse): (Toward, &str) = match relation {
        "<=" => (Toward::Below, ">="),
        _ => (Toward::Above, "<="),
    };
    let text = DIGITS.into_iter().find_map(|digits| {
        let (text, shows) = match towards {
            Toward::Below => {
                let text = rounded(&value.inf(), digits, towards);
                let shows = parsed(&text)? > limit.sup();
                (text, shows)
            }
            Toward::Above => {
                let text = rounded(&value.sup(), digits, towards);
                let shows = parsed(&text)? < limit.inf();
                (text, shows)
            }
        };
        shows.then_some(text)
    })?;
    Some((
        format!("{requirement} {relation} {}", exact(&number)),
        format!("{requirement} {reverse} {text}"),
    ))
}
