//! The legs of a machine, each with its own drive.
//!
//! A drive is a row of [`DRIVES`]: its name, and the function that reads the leg.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::independence::{not_parallel, product, sign_within};
use super::mechanism::{word, zero};
use super::number::{positive, quantity};
use orthocert_checker::claim::{Leg, Quantity, WorkingMode};
use orthocert_checker::number::Exact;

struct Drive {
    name: &'static str,
    read: fn(&Table<'_>) -> Result<Leg, DesignError>,
}

const DRIVES: &[Drive] = &[
    Drive { name: "slider", read: slider },
    Drive { name: "strut", read: strut },
    Drive { name: "arm", read: arm },
    Drive { name: "planar", read: planar },
];

pub(super) const LENGTH: &str = r#"a length greater than 0, such as 310.25 or "310.25 ± 0.02""#;

/// Reads a `[[mechanism.legs]]` table.
pub(super) fn leg(value: &Value<'_>) -> Result<Leg, DesignError> {
    let table = value.table("a [[mechanism.legs]] table")?;
    let drive = word(&table, "drive", DRIVES, |drive| drive.name)?;
    (drive.read)(&table)
}

/// A leg of fixed length on a linear guide.
fn slider(table: &Table<'_>) -> Result<Leg, DesignError> {
    table.only(&["drive", "direction", "anchor", "platform", "length", "mode"])?;
    let direction = table.require("direction", "[x, y, z]: the guide's direction")?;
    let anchor = table.require("anchor", "[x, y, z]: the point of the guide where rho = 0")?;
    let length = table.require("length", LENGTH)?;
    Ok(Leg::Slider {
        direction: self::direction(&direction)?,
        anchor: vector(&anchor)?,
        platform: platform(table)?,
        length: self::length(&length)?,
        mode: mode(table)?,
    })
}

/// An extensible leg.
fn strut(table: &Table<'_>) -> Result<Leg, DesignError> {
    table.only(&["drive", "anchor", "platform"])?;
    let anchor = table.require("anchor", "[x, y, z]: the leg's joint on the base")?;
    Ok(Leg::Strut { anchor: vector(&anchor)?, platform: platform(table)? })
}

/// A leg of fixed length on an arm that a motor turns.
fn arm(table: &Table<'_>) -> Result<Leg, DesignError> {
    let keys = ["drive", "anchor", "axis", "reference", "arm", "length", "platform", "mode"];
    table.only(&keys)?;
    let anchor = table.require("anchor", "[x, y, z]: a point of the motor's axis")?;
    let axis = table.require("axis", "[x, y, z]: the direction of the motor's axis")?;
    let reference = table.require("reference", REFERENCE)?;
    let arm = table.require("arm", "a length greater than 0: from the axis to the elbow")?;
    let length = table.require("length", LENGTH)?;
    let leg = Leg::Arm {
        axis: direction(&axis)?,
        reference: direction(&reference)?,
        anchor: vector(&anchor)?,
        platform: platform(table)?,
        arm: self::length(&arm)?,
        length: self::length(&length)?,
        mode: mode(table)?,
    };
    if let Leg::Arm { axis, reference: vector, .. } = &leg {
        orthogonal(&reference, axis, vector)?;
    }
    Ok(leg)
}

/// A leg that constrains the platform to a plane.
fn planar(table: &Table<'_>) -> Result<Leg, DesignError> {
    table.only(&["drive", "direction"])?;
    let direction = table.require("direction", "[x, y, z]: the normal of the plane")?;
    Ok(Leg::Planar { direction: self::direction(&direction)? })
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
pub(super) fn one_unit(values: &[Value<'_>; 3], legs: &[Leg; 3]) -> Result<(), DesignError> {
    let [first, rest @ ..] = legs;
    let differs = rest.iter().position(|leg| leg.is_angular() != first.is_angular());
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
fn platform(table: &Table<'_>) -> Result<[Quantity; 3], DesignError> {
    match table.find("platform") {
        Some(platform) => vector(&platform),
        None => Ok([zero(), zero(), zero()]),
    }
}

/// Three coordinates.
fn vector(value: &Value<'_>) -> Result<[Quantity; 3], DesignError> {
    let [x, y, z] = value.three("[x, y, z]: three numbers or tolerances")?;
    Ok([quantity(&x)?, quantity(&y)?, quantity(&z)?])
}

/// A vector that is not zero for any admissible values: some coordinate is of one strict sign,
/// since the coordinates vary independently.
fn direction(value: &Value<'_>) -> Result<[Quantity; 3], DesignError> {
    let direction = vector(value)?;
    let strict = |x: &Quantity| x.min.sign() == Some(1) || x.max.sign() == Some(-1);
    if !value.document.demands() || direction.iter().any(strict) {
        return Ok(direction);
    }
    let found = "a vector that is, or may be, zero";
    Err(value.error(Defect::OutOfDomain, found, "a direction: any vector that is not zero"))
}
