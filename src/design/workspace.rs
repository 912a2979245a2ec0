//! The `[workspace]` table: sets of points.
//!
//! A form of workspace is a row of [`FORMS`]: the keys that describe it, and the function that reads
//! them. The first key present decides which form is meant.

use super::description::{Mechanism, Motion, Workspace};
use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::number::{exact, ordered, positive};

struct Form {
    keys: &'static [&'static str],
    read: fn(&Table<'_>, &Mechanism) -> Result<Workspace, DesignError>,
}

const FORMS: &[Form] = &[
    Form { keys: &["cube"], read: cube },
    Form { keys: &["min", "max"], read: axis_aligned_box },
    Form { keys: &["cylinder"], read: cylinder },
];

const ANY: &str = "min = [x, y, z] and max = [x, y, z], or cylinder, or cube (the side)";
const CYLINDER: &str = "{ center = [0, 0], radius = 85, z = [0, 200] }, its axis parallel to z";
const SIDE: &str = "a length greater than 0: the cube's side";

/// Demands that there is a workspace of some form, before the mechanism that it may decide is read.
pub(super) fn some(table: &Table<'_>) -> Result<(), DesignError> {
    let keys: Vec<&str> = forms().chain(["orientation"]).collect();
    table.only(&keys)?;
    match keys.iter().any(|key| table.find(key).is_some()) {
        true => Ok(()),
        false => Err(table.lacks("min", ANY)),
    }
}

/// The keys of all forms.
fn forms() -> impl Iterator<Item = &'static str> {
    FORMS.iter().flat_map(|form| form.keys).copied()
}

/// Reads `[workspace]`, but for its orientations.
pub(super) fn workspace(
    table: &Table<'_>,
    mechanism: &Mechanism,
) -> Result<Workspace, DesignError> {
    let all: Vec<&str> = forms().collect();
    let first = |key: &&str| table.find(key);
    if let Mechanism::Legs { motion: Motion::Spherical, .. } = mechanism {
        if let Some(other) = all.iter().filter_map(first).min_by_key(|v| v.at.start) {
            let found = format!("{}, of a platform that turns about the origin", other.found());
            return Err(other.error(Defect::Conflict, found, "orientation alone"));
        }
        return Ok(Workspace::Box { min: Vec::new(), max: Vec::new() });
    }
    let given = |form: &&Form| form.keys.iter().any(|key| table.find(key).is_some());
    let Some(form) = FORMS.iter().find(given) else {
        return Err(table.lacks("min", any(mechanism)));
    };
    let others = all.iter().filter(|key| !form.keys.contains(key));
    if let Some(other) = others.filter_map(first).min_by_key(|v| v.at.start) {
        let found = format!("{}, next to {}", other.found(), table.path(form.keys[0]));
        let accepted = format!("one workspace: {}", any(mechanism));
        return Err(other.error(Defect::Conflict, found, accepted));
    }
    (form.read)(table, mechanism)
}

/// The forms that a machine's workspace can have.
fn any(mechanism: &Mechanism) -> String {
    match mechanism {
        Mechanism::OfCube { .. } | Mechanism::Legs { motion: Motion::Translational, .. } => {
            ANY.to_owned()
        }
        Mechanism::Legs { motion: Motion::Spatial, .. } => {
            "min = [x, y, z] and max = [x, y, z], or cylinder".to_owned()
        }
        _ => format!("min and max = {}", corner(mechanism)),
    }
}

/// How a point is written.
fn corner(mechanism: &Mechanism) -> String {
    match mechanism {
        Mechanism::Formulas(formulas) => {
            format!("[{}]: exact numbers, one a coordinate", formulas.coordinates.join(", "))
        }
        Mechanism::Legs { motion: Motion::Planar { .. }, .. } => {
            "[x, y]: two exact numbers".to_owned()
        }
        _ => "[x, y, z]: three exact numbers".to_owned(),
    }
}

/// `min_k <= P_k <= max_k`.
fn axis_aligned_box(table: &Table<'_>, mechanism: &Mechanism) -> Result<Workspace, DesignError> {
    let accepted = corner(mechanism);
    let (least, greatest) = (table.require("min", &accepted)?, table.require("max", &accepted)?);
    let [coordinates, _] = mechanism.coordinates();
    let points = (least.list(&accepted)?, greatest.list(&accepted)?);
    for (value, elements) in [(&least, &points.0), (&greatest, &points.1)] {
        if elements.len() != coordinates {
            return Err(value.wrong_type(&accepted));
        }
    }
    let (least, greatest) = points;
    let numbers = |point: &[Value<'_>]| point.iter().map(exact).collect::<Result<Vec<_>, _>>();
    let (min, max) = (numbers(&least)?, numbers(&greatest)?);
    for (lower, upper) in least.iter().zip(&min).zip(greatest.iter().zip(&max)) {
        ordered(lower, upper)?;
    }
    Ok(Workspace::Box { min, max })
}

/// A cylinder whose axis is parallel to z.
fn cylinder(table: &Table<'_>, mechanism: &Mechanism) -> Result<Workspace, DesignError> {
    let value = table.require("cylinder", CYLINDER)?;
    let in_space = match mechanism {
        Mechanism::Formulas(_) => false,
        Mechanism::Legs { motion, .. } => motion.coordinates()[0] == 3,
        Mechanism::OfCube { .. } => true,
    };
    if !in_space {
        let found = "a cylinder, of a machine without x, y and z";
        return Err(value.error(Defect::Conflict, found, any(mechanism)));
    }
    let table = value.table(CYLINDER)?;
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
fn cube(table: &Table<'_>, _: &Mechanism) -> Result<Workspace, DesignError> {
    let value = table.require("cube", SIDE)?;
    let side = exact(&value)?;
    positive(&value, &side, "a length")?;
    Ok(Workspace::Cube { side })
}
