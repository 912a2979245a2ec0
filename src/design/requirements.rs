//! The `[requirements]` table: what must hold at every point of the workspace.
//!
//! A requirement is a row of [`REQUIREMENTS`]: its key, and the function that reads its value.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::number::{exact, ordered, positive};
use orthocert_checker::claim::{Range, Requirements};
use orthocert_checker::number::Exact;
use std::cmp::Ordering;
use toml::de::DeValue;

struct Requirement {
    key: &'static str,
    read: fn(&Value<'_>, cube: bool, &mut Requirements) -> Result<(), DesignError>,
}

const REQUIREMENTS: &[Requirement] = &[
    Requirement { key: "transmission", read: transmission },
    Requirement { key: "joint_range", read: joint_range },
];

const BOUNDS: &str = r#"{ min = "1/2", max = 2 }, or one of min and max"#;
const CUBE_BOUND: &str =
    "transmission = { max = psi_max }, greater than 1: workspace.cube needs it";
const JOINT_RANGE: &str = "{ min = 0, max = 257 }, or an array of three such tables";

/// Reads `[requirements]`; with `cube`, everything follows from `psi_max`.
pub(super) fn requirements(table: &Table<'_>, cube: bool) -> Result<Requirements, DesignError> {
    let keys: Vec<&str> = REQUIREMENTS.iter().map(|requirement| requirement.key).collect();
    table.only(&keys)?;
    let mut requirements = Requirements::default();
    for requirement in REQUIREMENTS {
        if let Some(value) = table.find(requirement.key) {
            (requirement.read)(&value, cube, &mut requirements)?;
        }
    }
    if cube && requirements.transmission.is_none() {
        return Err(table.lacks("transmission", CUBE_BOUND));
    }
    if table.is_empty() {
        let accepted = format!("at least one requirement: {}", keys.join(", "));
        return Err(table.lacks("transmission", accepted));
    }
    Ok(requirements)
}

/// `psi_min <= psi_i <= psi_max`.
fn transmission(
    value: &Value<'_>,
    cube: bool,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
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
        if min.compare(max) != Some(Ordering::Less) {
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
    if above_one != Some(Ordering::Greater) {
        return Err(greatest.error(Defect::OutOfDomain, greatest.found(), CUBE_BOUND));
    }
    Ok(())
}

/// `rho_min <= rho_i <= rho_max`, common to the legs or one range for each.
fn joint_range(
    value: &Value<'_>,
    _cube: bool,
    requirements: &mut Requirements,
) -> Result<(), DesignError> {
    let range = |value: &Value<'_>| {
        let table = value.table(JOINT_RANGE)?;
        let (least, greatest, range) = bounds(&table)?;
        if let (Some(least), Some(greatest), Some(min), Some(max)) =
            (&least, &greatest, &range.min, &range.max)
        {
            ordered((least, min), (greatest, max))?;
        }
        Ok(range)
    };
    requirements.joint_range = Some(match value.inner {
        DeValue::Array(_) => {
            let [first, second, third] = value.three(JOINT_RANGE)?;
            [range(&first)?, range(&second)?, range(&third)?]
        }
        _ => {
            let common = range(value)?;
            [common.clone(), common.clone(), common]
        }
    });
    Ok(())
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
