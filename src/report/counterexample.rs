//! A refutation's witness in words, with certified digits of the value that violates the claim.

use super::place::named_parameters;
use super::worst::{bound, Bound};
use crate::batch::requirement::broken;
use crate::decimal::{exact, rounded, significant, Toward};
use crate::dimensions::{atan, pi};
use crate::exact::Exact;
use crate::interval::Approx;
use crate::sample::Quality;
use orthocert_checker::certificate::{LegNumber, Violation, Witness};
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Workspace};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::JointCoordinate;
use orthocert_checker::linear::{apply, determinant, norm_squared, Matrix, Vector};
use orthocert_checker::model::{CubeConstants, Model};
use serde::Serialize;

/// Digits of a violating value: as few as show the violation, within these limits.
const DIGITS: std::ops::RangeInclusive<u32> = 6..=40;
/// Fractional bits in which a bound is compared with the digits shown.
const BOUND_BITS: u32 = 256;

/// The point, the machine and the requirement that is provably violated there.
#[derive(Clone, Debug, Serialize)]
pub struct Counterexample {
    /// The rule that is broken ([`crate::batch::requirement`]).
    #[serde(skip)]
    pub rule: &'static str,
    /// What is violated: `greatest psi <= 2`.
    pub violated: String,
    /// The value there, with certified digits: `greatest psi >= 2.0050`.
    pub value: String,
    /// `P`, exact.
    pub point: Vec<Exact>,
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_point: Option<Vec<Exact>>,
    /// The parameters with a tolerance, exact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<Setting>,
    /// The direction of motion that is transmitted too fast or too slowly, or both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<i64>>,
}

/// The value that a witness gives to a parameter with a tolerance.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// The leg, counted from one; none of a mechanism that its user gives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
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
        let other_point = match &witness.violates {
            Violation::Singular(second) => Some(second.other.to_vec()),
            _ => None,
        };
        let directions = match &witness.violates {
            Violation::SigmaMin(d) | Violation::SigmaMax(d) => vec![d.vector.to_vec()],
            Violation::Conditioning(both) => vec![both.u.to_vec(), both.v.to_vec()],
            _ => Vec::new(),
        };
        let machine = settings(claim, witness);
        let (rule, point) = (broken(&witness.violates), witness.point.to_vec());
        Counterexample { rule, violated, value, point, other_point, machine, directions }
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
            .map(|((parameter, q), _)| Setting { leg: Some(i + 1), parameter, value: q.min })
            .collect::<Vec<_>>()
    };
    machine.iter().zip(claimed).enumerate().flat_map(of_leg).collect()
}

/// What is violated, and the value that violates it.
fn violation(claim: &MachineClaim, witness: &Witness) -> Option<(String, String)> {
    let at = |point| Model::at_point(claim, witness.machine.as_ref(), point, witness.precision);
    let model = at(&witness.point).ok()?;
    let place = At { claim, model: &model };
    match &witness.violates {
        Violation::SigmaMin(d) => {
            beyond(claim, Quality::GreatestPsi, &place.psi_at_least(&d.vector)?)
        }
        Violation::SigmaMax(d) => beyond(claim, Quality::LeastPsi, &place.psi(&d.vector)?),
        Violation::Row(leg) => {
            let i = leg.leg.checked_sub(1)?;
            let inverse = model.legs.get(i)?.inverse_row_squared(&model.origin[i])?;
            beyond(claim, Quality::LeastPsi, &inverse.sqrt()?)
        }
        Violation::Reach(LegNumber { leg }) => Some((
            format!("leg {leg} reaches P and is not serially singular there"),
            format!("leg {leg} cannot reach P, or is serially singular there"),
        )),
        Violation::JointRange(leg) => place.joint_range(leg.leg.checked_sub(1)?),
        Violation::Conditioning(both) => {
            let value = place.psi(&both.v)?.div(&place.psi(&both.u)?)?;
            beyond(claim, Quality::Conditioning, &value)
        }
        Violation::SerialMargin(leg) => {
            let i = leg.leg.checked_sub(1)?;
            beyond(claim, Quality::SerialMargin(i), &place.cosine_squared(i)?.sqrt()?)
        }
        Violation::ParallelMargin => {
            let det = place.unit_determinant()?;
            let size = if det.is_positive() { det } else { det.neg() };
            beyond(claim, Quality::ParallelMargin, &size)
        }
        Violation::LegAngle(leg) => {
            let i = leg.leg.checked_sub(1)?;
            beyond(claim, Quality::LegAngle(i), &place.leg_angle(i)?)
        }
        Violation::JointSpeed(leg) => {
            let i = leg.leg.checked_sub(1)?;
            beyond(claim, Quality::JointSpeed(i), &place.joint_speed(i)?)
        }
        Violation::Singular(second) => {
            let other = at(&second.other).ok()?;
            let (one, other) = (determinant(&matrix(&model)?), determinant(&matrix(&other)?));
            let sign = |x: &Fixed| if x.is_positive() { "positive" } else { "negative" };
            Some((
                "no parallel singularity".to_owned(),
                format!("det M is {} at P and {} at P'", sign(&one), sign(&other)),
            ))
        }
    }
}

/// A machine at a point.
struct At<'a> {
    claim: &'a MachineClaim,
    model: &'a Model<Fixed>,
}

impl At<'_> {
    /// `|M v|` and `|v|`, squared.
    fn stretched(&self, v: &[i64; 3]) -> Option<(Fixed, Fixed)> {
        let m = matrix(self.model)?;
        let v: Vector<Fixed> = v.map(|x| Fixed::integer(x, m[0][0].bits()));
        Some((norm_squared(&apply(&m, &v)), norm_squared(&v)))
    }

    /// `|v| / |M v|`: a velocity transmission factor between the least and the greatest.
    fn psi(&self, v: &[i64; 3]) -> Option<Fixed> {
        let (image, length) = self.stretched(v)?;
        self.speed(&image, &length)
    }

    /// The same, or, where `M v` may be zero, a number that is certainly below it.
    fn psi_at_least(&self, v: &[i64; 3]) -> Option<Fixed> {
        self.psi(v).or_else(|| {
            let (image, length) = self.stretched(v)?;
            let one_more: num_bigint::BigInt = image.hi() + 1;
            let image = Fixed::new(one_more.clone(), one_more, image.bits())?;
            self.speed(&image, &length)
        })
    }

    /// The square root of `length / image` in the design's unit.
    fn speed(&self, image: &Fixed, length: &Fixed) -> Option<Fixed> {
        let psi = length.sqrt()?.div(&image.sqrt()?)?;
        if self.claim.mechanism.is_angular() {
            self.length(&psi)
        } else {
            Some(psi)
        }
    }

    /// A length of the model in the design's unit.
    fn length(&self, x: &Fixed) -> Option<Fixed> {
        if let Some(scale) = self.model.unit_exponent {
            return Some(x.rescale(-scale, x.bits()));
        }
        let Workspace::Cube { side } = &self.claim.workspace else {
            return None;
        };
        let psi_max = self.claim.requirements.transmission.as_ref()?.max.as_ref()?;
        let inverse = CubeConstants::new(psi_max, side).ok()?.inverse_length;
        x.div(&inverse.enclose(0, x.bits())?)
    }

    fn joint_range(&self, leg: usize) -> Option<(String, String)> {
        let rho = match self.model.legs.get(leg)?.at(&self.model.origin[leg])?.rho {
            JointCoordinate::Length(rho) => self.length(&rho)?,
            JointCoordinate::Angle { cos, sin } => {
                let [cos, sin] = [cos, sin].map(|x| Approx::from_fixed(&x).0);
                let angle = significant(sin.atan2(cos).to_degrees(), *DIGITS.start());
                let name = format!("rho_{}", leg + 1);
                let value = format!("{name} is about {angle} degrees, up to full turns");
                return Some((format!("{name} within its range"), value));
            }
        };
        beyond(self.claim, Quality::LeastRho(leg), &rho)
            .or_else(|| beyond(self.claim, Quality::GreatestRho(leg), &rho))
    }

    /// `(eta_i / L_i)^2`.
    fn cosine_squared(&self, leg: usize) -> Option<Fixed> {
        self.model.legs.get(leg)?.cosine_squared(&self.model.origin[leg])
    }

    /// The angle between leg and guide: `tan^2 = 1/cos^2 - 1`.
    fn leg_angle(&self, leg: usize) -> Option<Fixed> {
        let inverse = self.cosine_squared(leg)?.recip()?;
        let bits = inverse.bits();
        let tangent = inverse.sub(&Fixed::integer(1, bits)).sqrt()?;
        atan(&tangent)?.mul(&Fixed::integer(180, bits)).div(&pi(bits))
    }

    fn unit_determinant(&self) -> Option<Fixed> {
        let unit = |i: usize| {
            let w = &self.model.origin[i];
            self.model.legs[i].expand_unit(w, w).map(|(unit, _)| unit)
        };
        Some(determinant(&[unit(0)?, unit(1)?, unit(2)?]))
    }

    /// `|row_i of M| tool`; of arms in degrees per time.
    fn joint_speed(&self, leg: usize) -> Option<Fixed> {
        let row = self.model.legs.get(leg)?.at(&self.model.origin[leg])?.row;
        let norm = norm_squared(&row).sqrt()?;
        let bits = norm.bits();
        let norm = match self.model.unit_exponent {
            Some(scale) if self.claim.mechanism.is_angular() => {
                norm.rescale(scale, bits).mul(&Fixed::integer(180, bits)).div(&pi(bits))?
            }
            _ => norm,
        };
        let tool = &self.claim.requirements.joint_speed.as_ref()?.tool;
        Some(norm.mul(&tool.enclose(0, bits)?))
    }
}

fn matrix(model: &Model<Fixed>) -> Option<Matrix<Fixed>> {
    let row = |i: usize| Some(model.legs[i].at(&model.origin[i])?.row);
    Some([row(0)?, row(1)?, row(2)?])
}

/// The quality's bound and its value in as few digits as show on which side of it the value is;
/// `None` unless it is provably on the wrong side.
fn beyond(claim: &MachineClaim, quality: Quality, value: &Fixed) -> Option<(String, String)> {
    let Bound { requirement, relation, number } = bound(claim, quality)?;
    let limit = number.enclose(0, BOUND_BITS)?;
    // Rounded towards the bound, so that what is printed is true of the value.
    let (towards, reverse, end, limit) = match relation {
        "<=" => (Toward::Below, ">=", value.inf(), limit.sup()),
        _ => (Toward::Above, "<=", value.sup(), limit.inf()),
    };
    let shows = |digits: u32| {
        let number = Exact::parse(&rounded(&end, digits, towards), 1000).ok();
        number.as_ref().and_then(Exact::as_rational).is_some_and(|number| match towards {
            Toward::Below => *number > limit,
            Toward::Above => *number < limit,
        })
    };
    // More digits are nearer to the value: where some show it, more do.
    let all: Vec<u32> = DIGITS.collect();
    let digits = *all.get(all.partition_point(|&digits| !shows(digits)))?;
    let text = rounded(&end, digits, towards);
    Some((
        format!("{requirement} {relation} {}", exact(&number)),
        format!("{requirement} {reverse} {text}"),
    ))
}
