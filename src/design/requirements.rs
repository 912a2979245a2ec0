//! The `[requirements]` table: what must hold at every point of the workspace.
//!
//! A requirement is a row of [`REQUIREMENTS`]: its key, and the function that reads its value.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::number::{exact, ordered, positive};
use orthocert_checker::claim::{AtLeast, AtMost, JointSpeed, Leg, Mechanism, Range, Requirements};
use orthocert_checker::number::Exact;
use std::cmp::Ordering;
use toml::de::DeValue;

struct Requirement {
    key: &'static str,
    read: fn(&Value<'_>, &Mechanism, &mut Requirements) -> Result<(), DesignError>,
}

const REQUIREMENTS: &[Requirement] = &[
    Requirement { key: "transmission", read: transmission },
    Requirement { key: "joint_range", read: joint_range },
    Requirement { key: "conditioning", read: conditioning },
    Requirement { key: "serial_margin", read: serial_margin },
    Requirement { key: "parallel_margin", read: parallel_margin },
    Requirement { key: "leg_angle", read: leg_angle },
    Requirement { key: "joint_speed", read: joint_speed },
];

const BOUNDS: &str = r#"{ min = "1/2", max = 2 }, or one of min and max"#;
const CUBE_BOUND: &str =
    "transmission = { max = psi_max }, greater than 1: workspace.cube needs it";
const ANGLES: &str =
    "{ min = -45, max = 90 } in degrees, both ends, within ±360 and less than 180 \
                      apart, or an array of three such tables";
const JOINT_RANGE: &str = "{ min = 0, max = 257 }, or an array of three such tables";

/// Reads the `[requirements]` on a mechanism.
pub(super) fn requirements(
    table: &Table<'_>,
    mechanism: &Mechanism,
) -> Result<Requirements, DesignError> {
    let keys: Vec<&str> = REQUIREMENTS.iter().map(|requirement| requirement.key).collect();
    table.only(&keys)?;
    let mut requirements = Requirements::default();
    for requirement in REQUIREMENTS {
        if let Some(value) = table.find(requirement.key) {
            (requirement.read)(&value, mechanism, &mut requirements)?;
        }
    }
    if of_cube(mechanism) && requirements.transmission.is_none() {
        return Err(table.lacks("transmission", CUBE_BOUND));
    }
    if table.is_empty() {
        let accepted = format!("at least one requirement: {}", keys.join(", "));
        return Err(table.lacks("transmission", accepted));
    }
    Ok(requirements)
}

/// Whether this is the Orthoglide of a cube, all of which follows from `psi_max`.
fn of_cube(mechanism: &Mechanism) -> bool {
    matches!(mechanism, Mechanism::Orthoglide { .. })
}

fn all_legs(mechanism: &Mechanism, have: fn(&Leg) -> bool) -> bool {
    match mechanism {
        Mechanism::Translational(legs) => legs.iter().all(have),
        // Three sliders.
        Mechanism::Orthoglide { .. } => true,
    }
}

/// `psi_min <= psi_i <= psi_max`.
fn transmission(
    value: &Value<'_>,
    mechanism: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let cube = of_cube(mechanism);
    let table = value.table(if cube { CUBE_BOUND } else { BOUNDS })?;
    let (least, greatest, range) = bounds(&table)?;
    for (bound, number) in [(&least, &range.min), (&greatest, &range.max)] {
        if let (Some(bound), Some(number)) = (bound, number) {
            positive(bound, number, "a transmission factor")?;
        }
    }
    if cube {
        return psi_max_alone(&table, &range).map(|()| requirements.transmission = Some(range));
    }
    if let (Some(min), Some(max), Some(greatest)) = (&range.min, &range.max, &greatest) {
        if greatest.document.demands() && min.compare(max) != Some(Ordering::Less) {
            let found = format!("{}, not (provably) above psi_min", greatest.found());
            let accepted = "psi_max greater than psi_min";
            return Err(greatest.error(Defect::Reversed, found, accepted));
        }
    }
    requirements.transmission = Some(range);
    Ok(())
}

/// The only bound that the paper's cube leaves free: `psi_max > 1`.
fn psi_max_alone(table: &Table<'_>, range: &Range) -> Result<(), DesignError> {
    if let Some(least) = table.find("min") {
        let found = format!("{}, next to workspace.cube", least.found());
        let accepted = "max alone: with workspace.cube, psi_min = 1/psi_max by definition";
        return Err(least.error(Defect::Conflict, found, accepted));
    }
    let greatest = table.require("max", CUBE_BOUND)?;
    let above_one = range.max.as_ref().and_then(|max| max.compare(&Exact::integer(1)));
    if greatest.document.demands() && above_one != Some(Ordering::Greater) {
        return Err(greatest.error(Defect::OutOfDomain, greatest.found(), CUBE_BOUND));
    }
    Ok(())
}

/// `rho_min <= rho_i <= rho_max`, common to the legs or one range for each; for arms in degrees.
fn joint_range(
    value: &Value<'_>,
    mechanism: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let angular = mechanism.is_angular();
    let accepted = if angular { ANGLES } else { JOINT_RANGE };
    let range = |value: &Value<'_>| {
        let table = value.table(accepted)?;
        let (least, greatest, range) = bounds(&table)?;
        if let (Some(least), Some(greatest), Some(min), Some(max)) =
            (&least, &greatest, &range.min, &range.max)
        {
            ordered((least, min), (greatest, max))?;
        }
        if angular {
            angles(&table, &range)?;
        }
        Ok(range)
    };
    requirements.joint_range = Some(match value.inner {
        DeValue::Array(_) => {
            let [first, second, third] = value.three(accepted)?;
            [range(&first)?, range(&second)?, range(&third)?]
        }
        _ => {
            let common = range(value)?;
            [common.clone(), common.clone(), common]
        }
    });
    Ok(())
}

/// Demands both ends of a range of angles, within a turn and less than half a turn apart.
fn angles(table: &Table<'_>, range: &Range) -> Result<(), DesignError> {
    let (least, greatest) = (table.require("min", ANGLES)?, table.require("max", ANGLES)?);
    let (Some(min), Some(max)) = (&range.min, &range.max) else {
        return Err(table.lacks("max", ANGLES));
    };
    if !least.document.demands() {
        return Ok(());
    }
    let at_most =
        |x: &Exact, y: &Exact| matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal));
    if !at_most(&Exact::integer(-360), min) {
        return Err(least.error(Defect::OutOfDomain, least.found(), ANGLES));
    }
    let span = max.clone().minus(min.clone()).ok();
    let narrow = span.and_then(|span| span.compare(&Exact::integer(180))) == Some(Ordering::Less);
    if !narrow || !at_most(max, &Exact::integer(360)) {
        return Err(greatest.error(Defect::OutOfDomain, greatest.found(), ANGLES));
    }
    Ok(())
}

/// `sigma_max / sigma_min <= max`.
fn conditioning(
    value: &Value<'_>,
    _: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let accepted = "{ max = 3 }, greater than 1";
    let (bound, max) = single(value, "max", accepted)?;
    if bound.document.demands() && max.compare(&Exact::integer(1)) != Some(Ordering::Greater) {
        return Err(bound.error(Defect::OutOfDomain, bound.found(), accepted));
    }
    requirements.conditioning = Some(AtMost { max });
    Ok(())
}

/// `|eta_i| / L_i >= min`.
fn serial_margin(
    value: &Value<'_>,
    mechanism: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let (bound, min) = single(value, "min", r#"{ min = "1/5" }, a part of the leg's length"#)?;
    positive(&bound, &min, "a part of the leg's length")?;
    if !all_legs(mechanism, Leg::has_length) {
        let accepted = "serial_margin for sliders and arms: other legs have no length";
        return Err(value.error(Defect::Conflict, "legs without a length", accepted));
    }
    requirements.serial_margin = Some(AtLeast { min });
    Ok(())
}

/// `|det A| / (L_1 L_2 L_3) >= min`.
fn parallel_margin(
    value: &Value<'_>,
    _: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let (bound, min) = single(value, "min", r#"{ min = "1/10" }, the volume of unit legs"#)?;
    positive(&bound, &min, "a volume")?;
    requirements.parallel_margin = Some(AtLeast { min });
    Ok(())
}

/// The angle between leg and guide is at most `max` degrees.
fn leg_angle(
    value: &Value<'_>,
    mechanism: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let accepted = "{ max = 60 }, in degrees, greater than 0 and at most 90";
    let (bound, max) = single(value, "max", accepted)?;
    let up_to_90 = max.compare(&Exact::integer(90));
    let within =
        max.sign() == Some(1) && matches!(up_to_90, Some(Ordering::Less | Ordering::Equal));
    if bound.document.demands() && !within {
        return Err(bound.error(Defect::OutOfDomain, bound.found(), accepted));
    }
    if !all_legs(mechanism, |leg| matches!(leg, Leg::Slider { .. })) {
        let accepted = "leg_angle for sliders: other legs have no guide";
        return Err(value.error(Defect::Conflict, "legs without a guide", accepted));
    }
    requirements.leg_angle = Some(AtMost { max });
    Ok(())
}

/// No tool velocity of magnitude `tool` demands a joint speed beyond `max`, of arms in degrees per
/// unit of time.
fn joint_speed(
    value: &Value<'_>,
    mechanism: &Mechanism,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let accepted = match mechanism.is_angular() {
        true => "{ tool = 100, max = 1000 }: the tool's speed and the arms' limit, degrees per unit of time",
        false => "{ tool = 1200, max = 2000 }: the tool's speed and the joints' limit, lengths per unit of time",
    };
    let table = value.table(accepted)?;
    table.only(&["tool", "max"])?;
    let speed = |key: &str| {
        let value = table.require(key, accepted)?;
        let speed = exact(&value)?;
        positive(&value, &speed, "a speed").map(|()| speed)
    };
    requirements.joint_speed = Some(JointSpeed { tool: speed("tool")?, max: speed("max")? });
    Ok(())
}

/// The number at `key`, the only one of a table.
fn single<'a>(
    value: &Value<'a>,
    key: &str,
    accepted: &str,
) -> Result<(Value<'a>, Exact), DesignError> {
    let table = value.table(accepted)?;
    table.only(&[key])?;
    let bound = table.require(key, accepted)?;
    let number = exact(&bound)?;
    Ok((bound, number))
}

type Bounds<'a> = (Option<Value<'a>>, Option<Value<'a>>, Range);

/// `min`, `max` or both.
fn bounds<'a>(table: &Table<'a>) -> Result<Bounds<'a>, DesignError> {
    table.only(&["min", "max"])?;
    let (least, greatest) = (table.find("min"), table.find("max"));
    if least.is_none() && greatest.is_none() {
        return Err(table.lacks("max", "min, max or both"));
    }
    let min = least.as_ref().map(exact).transpose()?;
    let max = greatest.as_ref().map(exact).transpose()?;
    Ok((least, greatest, Range { min, max }))
}
