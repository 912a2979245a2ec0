//! The legs of a machine, each with its own drive.
//!
//! A drive is a row of [`DRIVES`]: its name, its keys, and the function that reads the leg.

use super::description::{Leg, Motion};
use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::independence::{not_parallel, product, sign_within};
use super::leg::{self, Quantity, WorkingMode};
use super::mechanism::{word, zero};
use super::number::{positive, quantity};
use crate::exact::Exact;

struct Drive {
    name: &'static str,
    keys: &'static [&'static str],
    read: fn(&Table<'_>, Motion) -> Result<leg::Leg, DesignError>,
}

const DRIVES: &[Drive] = &[
    Drive {
        name: "slider",
        keys: &["drive", "direction", "anchor", "platform", "length", "mode"],
        read: slider,
    },
    Drive { name: "strut", keys: &["drive", "anchor", "platform"], read: strut },
    Drive {
        name: "arm",
        keys: &["drive", "anchor", "axis", "reference", "arm", "length", "platform", "mode"],
        read: arm,
    },
    Drive { name: "planar", keys: &["drive", "direction"], read: planar },
];

/// Keys of legs that are about their joints and bodies.
const OF_JOINTS: [&str; 3] = ["rod", "base_joint", "platform_joint"];

pub(super) const LENGTH: &str = r#"a length greater than 0, such as 310.25 or "310.25 ± 0.02""#;

/// Reads a `[[mechanism.legs]]` table, but for what it says of joints and bodies.
pub(super) fn leg(value: &Value<'_>, motion: Motion) -> Result<Leg, DesignError> {
    let table = value.table("a [[mechanism.legs]] table")?;
    let drive = word(&table, "drive", DRIVES, |drive| drive.name)?;
    let drives = drives(motion);
    if !drives.contains(&drive.name) {
        let value = table.require("drive", "a drive")?;
        let found = format!("{}, in a machine of kind {:?}", value.found(), motion.kind());
        let accepted: Vec<String> = drives.iter().map(|drive| format!("{drive:?}")).collect();
        return Err(value.error(Defect::Conflict, found, accepted.join(", ")));
    }
    let mut keys = drive.keys.to_vec();
    keys.retain(|key| *key != "axis" || !in_plane(motion));
    if drive.name != "planar" {
        keys.extend(OF_JOINTS);
    }
    let may_have_axis = motion == Motion::Translational && drive.name == "strut";
    if may_have_axis {
        keys.push("base_axis");
    }
    table.only_here(&keys, |key| elsewhere(key, motion))?;
    let base_axis = table.find("base_axis").map(|axis| direction(&axis, motion)).transpose()?;
    Ok(Leg { drive: (drive.read)(&table, motion)?, base_axis })
}

/// The drives of a kind of machine.
fn drives(motion: Motion) -> &'static [&'static str] {
    match motion {
        Motion::Translational => &["slider", "strut", "arm", "planar"],
        Motion::Planar { .. } | Motion::Spatial => &["slider", "strut", "arm"],
        Motion::Spherical => &["strut"],
    }
}

/// The drives that have a key.
fn elsewhere(key: &str, motion: Motion) -> Option<String> {
    if key == "base_axis" {
        return Some("drive = \"strut\" of kind \"translational\"".to_owned());
    }
    if key == "axis" && in_plane(motion) {
        return Some("legs in space: in the plane motors turn about +z".to_owned());
    }
    let with = DRIVES.iter().filter(|drive| drive.keys.contains(&key));
    let names: Vec<String> = with.map(|drive| format!("drive = {:?}", drive.name)).collect();
    (!names.is_empty()).then(|| names.join(", "))
}

fn in_plane(motion: Motion) -> bool {
    matches!(motion, Motion::Planar { .. })
}

/// How a vector is written.
pub(super) fn axes(motion: Motion) -> &'static str {
    if in_plane(motion) {
        "[x, y]"
    } else {
        "[x, y, z]"
    }
}

/// The vector at `key`, which has to be there; `meaning` says what it is.
fn vector_at<'a>(
    table: &Table<'a>,
    key: &str,
    meaning: &str,
    motion: Motion,
) -> Result<Value<'a>, DesignError> {
    table.require(key, &format!("{}: {meaning}", axes(motion)))
}

/// A leg of fixed length on a linear guide.
fn slider(table: &Table<'_>, motion: Motion) -> Result<leg::Leg, DesignError> {
    let direction = vector_at(table, "direction", "the guide's direction", motion)?;
    let anchor = vector_at(table, "anchor", "the point of the guide where rho = 0", motion)?;
    let length = table.require("length", LENGTH)?;
    Ok(leg::Leg::Slider {
        direction: self::direction(&direction, motion)?,
        anchor: vector(&anchor, motion)?,
        platform: platform(table, motion)?,
        length: self::length(&length)?,
        mode: mode(table)?,
    })
}

/// An extensible leg.
fn strut(table: &Table<'_>, motion: Motion) -> Result<leg::Leg, DesignError> {
    let anchor = vector_at(table, "anchor", "the leg's joint on the base", motion)?;
    let anchor = vector(&anchor, motion)?;
    Ok(leg::Leg::Strut { anchor, platform: platform(table, motion)? })
}

/// A leg of fixed length on an arm that a motor turns.
fn arm(table: &Table<'_>, motion: Motion) -> Result<leg::Leg, DesignError> {
    let anchor = vector_at(table, "anchor", "a point of the motor's axis", motion)?;
    let axis = match in_plane(motion) {
        true => [zero(), zero(), one()],
        false => {
            let axis = table.require("axis", "[x, y, z]: the direction of the motor's axis")?;
            direction(&axis, motion)?
        }
    };
    let reference = match table.find("reference") {
        None if in_plane(motion) => None,
        _ => Some(table.require("reference", REFERENCE)?),
    };
    let arm = table.require("arm", "a length greater than 0: from the axis to the elbow")?;
    let length = table.require("length", LENGTH)?;
    let directed = match &reference {
        Some(reference) => direction(reference, motion)?,
        None => [one(), zero(), zero()],
    };
    if let Some(reference) = reference.filter(|_| !in_plane(motion)) {
        orthogonal(&reference, &axis, &directed)?;
    }
    Ok(leg::Leg::Arm {
        axis,
        reference: directed,
        anchor: vector(&anchor, motion)?,
        platform: platform(table, motion)?,
        arm: self::length(&arm)?,
        length: self::length(&length)?,
        mode: mode(table)?,
    })
}

/// A leg that constrains the platform to a plane.
fn planar(table: &Table<'_>, motion: Motion) -> Result<leg::Leg, DesignError> {
    let direction = vector_at(table, "direction", "the normal of the plane", motion)?;
    Ok(leg::Leg::Planar { direction: self::direction(&direction, motion)? })
}

/// Fractional bits in which a product that is not zero shows.
const ORTHOGONAL: u32 = 512;

const REFERENCE: &str = "[x, y, z]: the arm's direction at angle 0, orthogonal to the axis";

/// Demands a reference that determines the angle's zero: not parallel to the axis for any
/// admissible values and, where all of them are exact, orthogonal to it.
fn orthogonal(
    value: &Value<'_>,
    axis: &[Quantity; 3],
    reference: &[Quantity; 3],
) -> Result<(), DesignError> {
    if !value.document.demands() {
        return Ok(());
    }
    let refused = |found: &str| Err(value.error(Defect::OutOfDomain, found, REFERENCE));
    if !not_parallel(axis, reference) {
        return refused("a reference that is, or may be, parallel to the axis");
    }
    if axis.iter().chain(reference).all(Quantity::is_exact) {
        // A zero made of roots shows no sign, however fine its enclosure, and one this fine is dear
        // enough. Nothing rests on it: of the reference, its part orthogonal to the axis counts.
        let component = |k: usize| product(&axis[k].min, &reference[k].min);
        let dot = || component(0)?.plus(component(1)?)?.plus(component(2)?);
        if dot().ok().and_then(|dot: Exact| sign_within(&dot, ORTHOGONAL)).is_some() {
            return refused("a reference that is not orthogonal to the axis");
        }
    }
    Ok(())
}

/// Refuses arms beside other drives: an arm's row of `M` is an angle per length, a slider's has no
/// unit, and singular values of both together have none.
pub(super) fn one_unit(values: &[Value<'_>], legs: &[Leg]) -> Result<(), DesignError> {
    let is_angular = |leg: &Leg| leg.drive.is_angular();
    let differs = legs.windows(2).position(|two| is_angular(&two[0]) != is_angular(&two[1]));
    let Some(value) = differs.and_then(|i| values.get(i + 1)) else {
        return Ok(());
    };
    let drive = value.table("a table")?.require("drive", "a drive")?;
    let found = format!("{}, next to another kind of drive", drive.found());
    let accepted =
        "arms on all legs or on none: an arm's factors are lengths per radian, those of \
                    other drives have no unit, so that a mixed machine's have no common one";
    Err(drive.error(Defect::Conflict, found, accepted))
}

/// `mode`: the sign of `eta_i`.
fn mode(table: &Table<'_>) -> Result<WorkingMode, DesignError> {
    let modes = [("+", WorkingMode::Plus), ("-", WorkingMode::Minus)];
    word(table, "mode", &modes, |(sign, _)| sign).map(|(_, mode)| *mode)
}

/// A length that is positive for every admissible value.
pub(super) fn length(value: &Value<'_>) -> Result<Quantity, DesignError> {
    let length = quantity(value)?;
    positive(value, &length.min, "a length")?;
    Ok(length)
}

/// `platform`: `d_i`, the origin where it is not given.
fn platform(table: &Table<'_>, motion: Motion) -> Result<[Quantity; 3], DesignError> {
    match table.find("platform") {
        Some(platform) => vector(&platform, motion),
        None => Ok([zero(), zero(), zero()]),
    }
}

/// Three coordinates; in the plane two, and 0.
fn vector(value: &Value<'_>, motion: Motion) -> Result<[Quantity; 3], DesignError> {
    if in_plane(motion) {
        let [x, y] = value.elements("[x, y]: two numbers or tolerances, in the plane")?;
        return Ok([quantity(&x)?, quantity(&y)?, zero()]);
    }
    let [x, y, z] = value.three("[x, y, z]: three numbers or tolerances")?;
    Ok([quantity(&x)?, quantity(&y)?, quantity(&z)?])
}

/// A vector that is not zero for any admissible values: some coordinate is of one strict sign,
/// since the coordinates vary independently.
fn direction(value: &Value<'_>, motion: Motion) -> Result<[Quantity; 3], DesignError> {
    let direction = vector(value, motion)?;
    let strict = |x: &Quantity| x.min.sign() == Some(1) || x.max.sign() == Some(-1);
    if !value.document.demands() || direction.iter().any(strict) {
        return Ok(direction);
    }
    let found = "a vector that is, or may be, zero";
    Err(value.error(Defect::OutOfDomain, found, "a direction: any vector that is not zero"))
}

fn one() -> Quantity {
    Quantity::exactly(Exact::integer(1))
}
