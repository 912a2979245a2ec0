//! The `[workspace]` table: sets of points.
//!
//! A form of workspace is a row of [`FORMS`]: the keys that describe it, and the function that reads
//! them. The first key present decides which form is meant.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::number::{exact, ordered, positive};
use orthocert_checker::claim::Workspace;
use orthocert_checker::number::Exact;

struct Form {
    keys: &'static [&'static str],
    read: fn(&Table<'_>) -> Result<Workspace, DesignError>,
}

const FORMS: &[Form] = &[
    Form { keys: &["cube"], read: cube },
    Form { keys: &["min", "max"], read: axis_aligned_box },
    Form { keys: &["cylinder"], read: cylinder },
];

const ANY: &str = "min = [x, y, z] and max = [x, y, z], or cylinder, or cube (the side)";
const CYLINDER: &str = "{ center = [0, 0], radius = 85, z = [0, 200] }, its axis parallel to z";
const CORNER: &str = "[x, y, z]: three exact numbers";
const SIDE: &str = "a length greater than 0: the cube's side";

/// Reads `[workspace]`.
pub(super) fn workspace(table: &Table<'_>) -> Result<Workspace, DesignError> {
    let all: Vec<&str> = FORMS.iter().flat_map(|form| form.keys).copied().collect();
    table.only(&all)?;
    let given = |form: &&Form| form.keys.iter().any(|key| table.find(key).is_some());
    let Some(form) = FORMS.iter().find(given) else {
        return Err(table.lacks("min", ANY));
    };
    let others = all.iter().filter(|key| !form.keys.contains(key));
    if let Some(other) = others.filter_map(|key| table.find(key)).min_by_key(|v| v.at.start) {
        let found = format!("{}, next to {}", other.found(), table.path(form.keys[0]));
        return Err(other.error(Defect::Conflict, found, format!("one workspace: {ANY}")));
    }
    (form.read)(table)
}

/// `min_k <= P_k <= max_k`.
fn axis_aligned_box(table: &Table<'_>) -> Result<Workspace, DesignError> {
    let (least, greatest) = (table.require("min", CORNER)?, table.require("max", CORNER)?);
    let (least, greatest) = (least.three(CORNER)?, greatest.three(CORNER)?);
    let (min, max) = (point(&least)?, point(&greatest)?);
    for k in 0..3 {
        ordered((&least[k], &min[k]), (&greatest[k], &max[k]))?;
    }
    Ok(Workspace::Box { min, max })
}

/// A cylinder whose axis is parallel to z.
fn cylinder(table: &Table<'_>) -> Result<Workspace, DesignError> {
    let table = table.require("cylinder", CYLINDER)?.table(CYLINDER)?;
    table.only(&["center", "radius", "z"])?;
    let [x, y] = table.require("center", CENTER)?.elements(CENTER)?;
    let center = [exact(&x)?, exact(&y)?];
    let value = table.require("radius", RADIUS)?;
    let radius = exact(&value)?;
    positive(&value, &radius, "a radius")?;
    let [least, greatest] = table.require("z", HEIGHTS)?.elements(HEIGHTS)?;
    let (low, high) = (exact(&least)?, exact(&greatest)?);
    ordered((&least, &low), (&greatest, &high))?;
    Ok(Workspace::Cylinder { center, radius, z: [low, high] })
}

const CENTER: &str = "[x, y]: where the axis crosses the plane z = 0";
const RADIUS: &str = "a radius greater than 0";
const HEIGHTS: &str = "[least z, greatest z]";

/// The paper's cube, by its side.
fn cube(table: &Table<'_>) -> Result<Workspace, DesignError> {
    let value = table.require("cube", SIDE)?;
    let side = exact(&value)?;
    positive(&value, &side, "a length")?;
    Ok(Workspace::Cube { side })
}

fn point([x, y, z]: &[Value<'_>; 3]) -> Result<[Exact; 3], DesignError> {
    Ok([exact(x)?, exact(y)?, exact(z)?])
}
