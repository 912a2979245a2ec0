//! Which claims are well formed.

use super::{
    AtLeast, AtMost, JointSpeed, Leg, MachineClaim, Mechanism, Range, Requirements, Workspace,
};
use crate::number::Exact;
use std::cmp::Ordering;
use std::fmt;

/// Why a claim is not well formed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ClaimError {
    /// A lower end is not provably at most its upper end.
    Reversed(String),
    /// A number that must be positive is not provably so.
    NotPositive(String),
    /// A direction that is not provably different from zero.
    ZeroDirection(String),
    /// `psi_min < psi_max` is not provable.
    EmptyTransmission,
    /// A range without a bound.
    NoBound(String),
    /// A cube without the Orthoglide that it defines, or the reverse.
    CubeNeedsOrthoglide,
    /// A cube without `psi_max`, or with `psi_max <= 1`.
    CubeNeedsPsiMax,
    /// A number that is not provably greater than this one.
    NotAbove(String, i64),
    /// Arms beside other drives: the transmission factors have no common unit.
    MixedUnits,
    /// A requirement on `eta_i / L_i` of legs without a length.
    NeedsLegLengths,
    /// A requirement on the angle between leg and guide of legs without a guide.
    NeedsGuides,
    /// A range of angles without both ends, beyond a turn, or of half a turn or more.
    AngleRange,
    /// A cube with a `psi_min` of its own.
    CubeFixesPsiMin,
    /// The numbers cannot be enclosed at the precision of the proof.
    Precision(String),
}

impl fmt::Display for ClaimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClaimError::Reversed(what) => write!(f, "{what}: min is not (provably) at most max"),
            ClaimError::NotPositive(what) => write!(f, "{what} is not (provably) positive"),
            ClaimError::ZeroDirection(what) => write!(f, "{what} is or may be the zero vector"),
            ClaimError::EmptyTransmission => {
                write!(f, "transmission: psi_min is not (provably) less than psi_max")
            }
            ClaimError::NoBound(what) => write!(f, "{what}: neither min nor max is given"),
            ClaimError::CubeNeedsOrthoglide => write!(
                f,
                "a workspace \"cube\" goes with the mechanism \"orthoglide\", and only with it"
            ),
            ClaimError::CubeNeedsPsiMax => {
                write!(f, "a workspace \"cube\" needs transmission.max (psi_max) greater than 1")
            }
            ClaimError::NotAbove(what, least) => {
                write!(f, "{what} is not (provably) greater than {least}")
            }
            ClaimError::MixedUnits => write!(
                f,
                "arms beside other drives: the transmission factors have no common unit"
            ),
            ClaimError::NeedsLegLengths => {
                write!(f, "serial_margin needs legs with a length: sliders or arms")
            }
            ClaimError::NeedsGuides => write!(f, "leg_angle needs legs with a guide: sliders"),
            ClaimError::AngleRange => write!(
                f,
                "joint_range of arms, in degrees, needs min and max within ±360 and less than 180 apart"
            ),
            ClaimError::CubeFixesPsiMin => {
                write!(f, "with a workspace \"cube\", psi_min = 1/psi_max is not free")
            }
            ClaimError::Precision(what) => {
                write!(f, "{what} cannot be enclosed at the precision of the proof")
            }
        }
    }
}

impl std::error::Error for ClaimError {}

impl MachineClaim {
    /// Proves the claim well formed: ordered ranges, positive lengths, admissible bounds.
    pub fn validate(&self) -> Result<(), ClaimError> {
        match (&self.mechanism, &self.workspace) {
            (Mechanism::Translational(legs), Workspace::Box { min, max }) => {
                self.validate_legs(legs)?;
                for ((axis, min), max) in ["x", "y", "z"].iter().zip(min).zip(max) {
                    ordered(min, max, || format!("workspace along {axis}"))?;
                }
            }
            (Mechanism::Translational(legs), Workspace::Cylinder { radius, z, .. }) => {
                self.validate_legs(legs)?;
                positive(radius, || "workspace.cylinder.radius".into())?;
                ordered(&z[0], &z[1], || "workspace.cylinder.z".into())?;
            }
            (Mechanism::Orthoglide { .. }, Workspace::Cube { side }) => {
                positive(side, || "workspace.cube".into())?;
                let Some(range) = &self.requirements.transmission else {
                    return Err(ClaimError::CubeNeedsPsiMax);
                };
                if range.min.is_some() {
                    return Err(ClaimError::CubeFixesPsiMin);
                }
                let above_one = range.max.as_ref().and_then(|max| max.compare(&Exact::integer(1)));
                if above_one != Some(Ordering::Greater) {
                    return Err(ClaimError::CubeNeedsPsiMax);
                }
            }
            _ => return Err(ClaimError::CubeNeedsOrthoglide),
        }
        self.requirements.validate()
    }

    fn validate_legs(&self, legs: &[Leg; 3]) -> Result<(), ClaimError> {
        for (i, leg) in legs.iter().enumerate() {
            leg.validate(i)?;
        }
        let angular = legs.iter().filter(|leg| leg.is_angular()).count();
        if angular % 3 != 0 {
            return Err(ClaimError::MixedUnits);
        }
        let requirements = &self.requirements;
        if requirements.serial_margin.is_some() && !legs.iter().all(Leg::has_length) {
            return Err(ClaimError::NeedsLegLengths);
        }
        if requirements.leg_angle.is_some()
            && !legs.iter().all(|leg| matches!(leg, Leg::Slider { .. }))
        {
            return Err(ClaimError::NeedsGuides);
        }
        if angular > 0 {
            requirements.joint_range.iter().flatten().try_for_each(Range::validate_angle)?;
        }
        Ok(())
    }
}

impl Leg {
    fn validate(&self, index: usize) -> Result<(), ClaimError> {
        let leg = index + 1;
        for (parameter, quantity) in self.parameters() {
            ordered(&quantity.min, &quantity.max, || format!("leg {leg}: {parameter}"))?;
            if parameter.is_length() {
                positive(&quantity.min, || format!("leg {leg}: {parameter}"))?;
            }
        }
        Ok(())
    }
}

impl Requirements {
    fn validate(&self) -> Result<(), ClaimError> {
        if let Some(range) = &self.transmission {
            range.validate(|| "transmission".into())?;
            for (bound, name) in [(&range.min, "min"), (&range.max, "max")] {
                if let Some(psi) = bound {
                    positive(psi, || format!("transmission.{name}"))?;
                }
            }
            if let (Some(min), Some(max)) = (&range.min, &range.max) {
                if min.compare(max) != Some(Ordering::Less) {
                    return Err(ClaimError::EmptyTransmission);
                }
            }
        }
        for (i, range) in self.joint_range.iter().flatten().enumerate() {
            range.validate(|| format!("joint_range of leg {}", i + 1))?;
        }
        if let Some(AtMost { max }) = &self.conditioning {
            above(max, 1, "conditioning.max")?;
        }
        for (bound, name) in
            [(&self.serial_margin, "serial_margin"), (&self.parallel_margin, "parallel_margin")]
        {
            if let Some(AtLeast { min }) = bound {
                positive(min, || format!("{name}.min"))?;
            }
        }
        if let Some(AtMost { max }) = &self.leg_angle {
            positive(max, || "leg_angle.max".into())?;
            ordered(max, &Exact::integer(90), || "leg_angle up to 90 degrees".into())?;
        }
        if let Some(JointSpeed { tool, max }) = &self.joint_speed {
            positive(tool, || "joint_speed.tool".into())?;
            positive(max, || "joint_speed.max".into())?;
        }
        Ok(())
    }
}

impl Range {
    fn validate(&self, name: impl Fn() -> String) -> Result<(), ClaimError> {
        match (&self.min, &self.max) {
            (None, None) => Err(ClaimError::NoBound(name())),
            (Some(min), Some(max)) => ordered(min, max, name),
            _ => Ok(()),
        }
    }

    /// Angles, in degrees: both ends are given, within a turn and less than half a turn apart, so
    /// that two signs decide membership.
    fn validate_angle(&self) -> Result<(), ClaimError> {
        let (Some(min), Some(max)) = (&self.min, &self.max) else {
            return Err(ClaimError::AngleRange);
        };
        let at_most =
            |x: &Exact, y: &Exact| matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal));
        let span = max.clone().minus(min.clone()).map_err(|_| ClaimError::AngleRange)?;
        let within = span.compare(&Exact::integer(180)) == Some(Ordering::Less)
            && at_most(&Exact::integer(-360), min)
            && at_most(max, &Exact::integer(360));
        within.then_some(()).ok_or(ClaimError::AngleRange)
    }
}

fn above(x: &Exact, least: i64, name: &str) -> Result<(), ClaimError> {
    match x.compare(&Exact::integer(least)) {
        Some(Ordering::Greater) => Ok(()),
        _ => Err(ClaimError::NotAbove(name.into(), least)),
    }
}

fn ordered(min: &Exact, max: &Exact, name: impl Fn() -> String) -> Result<(), ClaimError> {
    match min.compare(max) {
        Some(Ordering::Less | Ordering::Equal) => Ok(()),
        _ => Err(ClaimError::Reversed(name())),
    }
}

fn positive(x: &Exact, name: impl Fn() -> String) -> Result<(), ClaimError> {
    match x.sign() {
        Some(1) => Ok(()),
        _ => Err(ClaimError::NotPositive(name())),
    }
}
