//! `orientation` in `[workspace]`: how the platform is turned there.
//!
//! A form is a row of [`FORMS`]: its keys, and the function that reads them.

use super::description::Motion;
use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::exactly;
use super::number::{exact, ordered};
use crate::exact::Exact;
use orthocert_kernel::claim::Orientation;
use orthocert_kernel::number::Expression;
use std::cmp::Ordering;

struct Form {
    keys: &'static [&'static str],
    read: fn(&Table<'_>) -> Result<Orientation, DesignError>,
}

const IN_SPACE: &[Form] = &[
    Form { keys: &["angle"], read: angle },
    Form { keys: &["tilt", "torsion"], read: tilt },
    Form { keys: &["roll", "pitch", "yaw"], read: roll_pitch_yaw },
];

const SPACE: &str =
    "{ angle = 15 }, { tilt = 20, torsion = 40 } or { roll = [-5, 5], pitch = [-5, 5], \
                     yaw = [0, 0] }, in degrees";
const PLANE: &str = "{ angle = [-20, 20] }, in degrees";
const ONE_ANGLE: &str = "an angle in degrees, from 0 to less than 180";
const TWO_ANGLES: &str =
    "[-5, 5]: the least and the greatest angle in degrees, between -180 and 180";

/// Reads the orientations of a machine that moves so.
pub(super) fn orientation(
    workspace: &Table<'_>,
    motion: Option<Motion>,
) -> Result<Option<Orientation>, DesignError> {
    let found = workspace.find("orientation");
    match (motion, found) {
        (Some(Motion::Planar { .. }), Some(value)) => {
            let table = value.table(PLANE)?;
            table.only_here(&["angle"], elsewhere)?;
            Ok(Some(Orientation::Range(range(&table, "angle")?)))
        }
        (Some(Motion::Spatial | Motion::Spherical), Some(value)) => in_space(&value).map(Some),
        (Some(Motion::Spatial | Motion::Spherical), None) => {
            Err(workspace.lacks("orientation", SPACE))
        }
        (_, None) => Ok(None),
        (_, Some(value)) => {
            let found = "orientations, of a machine that does not turn its platform";
            let accepted = "kind = \"spatial\", \"planar\" or \"spherical\", or no orientation";
            Err(value.error(Defect::Conflict, found, accepted))
        }
    }
}

/// Of a key that other machines have.
fn elsewhere(key: &str) -> Option<String> {
    let is_there = IN_SPACE.iter().any(|form| form.keys.contains(&key));
    is_there.then(|| "kind = \"spatial\" or \"spherical\"".to_owned())
}

fn in_space(value: &Value<'_>) -> Result<Orientation, DesignError> {
    let table = value.table(SPACE)?;
    let all: Vec<&str> = IN_SPACE.iter().flat_map(|form| form.keys).copied().collect();
    table.only(&all)?;
    let given = |form: &&Form| form.keys.iter().any(|key| table.find(key).is_some());
    let Some(form) = IN_SPACE.iter().find(given) else {
        return Err(table.lacks("angle", SPACE));
    };
    let others = all.iter().filter(|key| !form.keys.contains(key));
    if let Some(other) = others.filter_map(|key| table.find(key)).min_by_key(|v| v.at.start) {
        let found = format!("{}, next to {}", other.found(), table.path(form.keys[0]));
        return Err(other.error(Defect::Conflict, found, format!("one of {SPACE}")));
    }
    (form.read)(&table)
}

/// Every rotation by at most an angle.
fn angle(table: &Table<'_>) -> Result<Orientation, DesignError> {
    one(table, "angle").map(Orientation::Angle)
}

/// Tilt and torsion angles.
fn tilt(table: &Table<'_>) -> Result<Orientation, DesignError> {
    Ok(Orientation::Tilt { tilt: one(table, "tilt")?, torsion: one(table, "torsion")? })
}

/// Angles about x, y and z.
fn roll_pitch_yaw(table: &Table<'_>) -> Result<Orientation, DesignError> {
    let [roll, pitch, yaw] = ["roll", "pitch", "yaw"].map(|key| range(table, key));
    Ok(Orientation::RollPitchYaw { roll: roll?, pitch: pitch?, yaw: yaw? })
}

/// An angle from 0 to less than half a turn.
fn one(table: &Table<'_>, key: &str) -> Result<Expression, DesignError> {
    let value = table.require(key, ONE_ANGLE)?;
    if value.inner.is_array() {
        return Err(value.wrong_type(ONE_ANGLE));
    }
    let angle = exact(&value)?;
    let below = angle.compare(&Exact::integer(180)) == Some(Ordering::Less);
    if value.document.demands() && !(below && matches!(angle.sign(), Some(0 | 1))) {
        return Err(value.error(Defect::OutOfDomain, value.found(), ONE_ANGLE));
    }
    exactly::of(&value, &angle)
}

/// A range of angles within less than half a turn either way.
fn range(table: &Table<'_>, key: &str) -> Result<[Expression; 2], DesignError> {
    let [least, greatest] = table.require(key, TWO_ANGLES)?.elements(TWO_ANGLES)?;
    let (min, max) = (exact(&least)?, exact(&greatest)?);
    ordered((&least, &min), (&greatest, &max))?;
    for (value, angle) in [(&least, &min), (&greatest, &max)] {
        let above = angle.compare(&Exact::integer(-180)) == Some(Ordering::Greater);
        let below = angle.compare(&Exact::integer(180)) == Some(Ordering::Less);
        if value.document.demands() && !(above && below) {
            return Err(value.error(Defect::OutOfDomain, value.found(), TWO_ANGLES));
        }
    }
    Ok([exactly::of(&least, &min)?, exactly::of(&greatest, &max)?])
}
