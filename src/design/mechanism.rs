//! The `[mechanism]` table: kinds of machines.
//!
//! A kind of machine is a row of [`KINDS`]: a name and the function that reads what goes with it.

use super::document::{Table, Value};
use super::drive::{self, LENGTH};
use super::error::{Defect, DesignError};
use super::independence;
use super::number::{negated, quantity};
use orthocert_checker::claim::{Leg, Mechanism, Quantity, WorkingMode};
use orthocert_checker::number::Exact;

/// What the rest of the design says that decides how a mechanism is read.
pub(super) struct Setting<'a> {
    /// `workspace.cube`, which determines all of an Orthoglide but its offset.
    pub cube: Option<Value<'a>>,
    /// `requirements.joint_range`, which needs to know where the joint coordinates are zero.
    pub joint_range: Option<Value<'a>>,
}

struct Kind {
    name: &'static str,
    read: fn(&Table<'_>, &Setting<'_>) -> Result<Mechanism, DesignError>,
}

const KINDS: &[Kind] = &[
    Kind { name: "orthoglide", read: orthoglide },
    Kind { name: "translational", read: translational },
];

/// Reads `[mechanism]`.
pub(super) fn mechanism(
    table: &Table<'_>,
    setting: &Setting<'_>,
) -> Result<Mechanism, DesignError> {
    let kind = word(table, "kind", KINDS, |kind| kind.name)?;
    (kind.read)(table, setting)
}

/// The Orthoglide: guides along the axes, `a_i = a e_i`, `d_i = -e e_i`, `L_i = L`, `eta_i > 0`.
fn orthoglide(table: &Table<'_>, setting: &Setting<'_>) -> Result<Mechanism, DesignError> {
    table.only(&["kind", "leg_length", "base", "offset"])?;
    if setting.cube.is_some() {
        return orthoglide_of_cube(table);
    }
    let length = table.require("leg_length", LENGTH)?;
    let length = drive::length(&length)?;
    let offset = match table.find("offset") {
        Some(offset) => negated(&offset, &quantity(&offset)?)?,
        None => zero(),
    };
    let base = match (table.find("base"), &setting.joint_range) {
        (Some(base), _) => quantity(&base)?,
        // Only joint coordinates depend on the anchor's place along its guide.
        (None, None) => zero(),
        (None, Some(range)) => {
            let found = "a joint range without mechanism.base";
            let accepted = "joint_range together with mechanism.base: where rho = 0 on each axis";
            return Err(range.error(Defect::Conflict, found, accepted));
        }
    };
    let leg = |axis: usize| Leg::Slider {
        direction: along(axis, &Quantity::exactly(Exact::integer(1))),
        anchor: along(axis, &base),
        platform: along(axis, &offset),
        length: length.clone(),
        mode: WorkingMode::Plus,
    };
    Ok(Mechanism::Translational([leg(0), leg(1), leg(2)]))
}

/// The Orthoglide of the paper's Steps 1 to 3.
fn orthoglide_of_cube(table: &Table<'_>) -> Result<Mechanism, DesignError> {
    for key in ["leg_length", "base"] {
        if let Some(value) = table.find(key) {
            let found = format!("{}, next to workspace.cube", value.found());
            let accepted = format!(
                "no {key} here: with workspace.cube it follows from transmission.max (psi_max)"
            );
            return Err(value.error(Defect::Conflict, found, accepted));
        }
    }
    let Some(value) = table.find("offset") else {
        return Ok(Mechanism::Orthoglide { offset: Exact::integer(0) });
    };
    let offset = quantity(&value)?;
    if !offset.is_exact() {
        let accepted = "one exact number: with workspace.cube the bounds are met with equality, \
                        which leaves no room for tolerances";
        return Err(value.error(Defect::Tolerance, "a tolerance", accepted));
    }
    Ok(Mechanism::Orthoglide { offset: offset.min })
}

/// Three legs, each with its own drive.
fn translational(table: &Table<'_>, setting: &Setting<'_>) -> Result<Mechanism, DesignError> {
    table.only(&["kind", "legs"])?;
    if let Some(cube) = &setting.cube {
        let accepted = "min and max, or cylinder: workspace.cube goes with mechanism.kind = \
                        \"orthoglide\" only";
        return Err(cube.error(Defect::Conflict, "a cube, next to another machine", accepted));
    }
    let accepted = "three [[mechanism.legs]] tables";
    let values = table.require("legs", accepted)?.three(accepted)?;
    let [first, second, third] = &values;
    let legs = [drive::leg(first)?, drive::leg(second)?, drive::leg(third)?];
    drive::one_unit(&values, &legs)?;
    independence::independent(&values, &legs)?;
    Ok(Mechanism::Translational(legs))
}

/// The row of `rows` that the word at `key` names.
pub(super) fn word<'r, T>(
    table: &Table<'_>,
    key: &str,
    rows: &'r [T],
    name: impl Fn(&T) -> &'static str,
) -> Result<&'r T, DesignError> {
    let names: Vec<String> = rows.iter().map(|row| format!("{:?}", name(row))).collect();
    table.require(key, &names.join(", "))?.choose(rows, name)
}

/// `quantity` times the unit vector along `axis`.
fn along(axis: usize, quantity: &Quantity) -> [Quantity; 3] {
    std::array::from_fn(|k| if k == axis { quantity.clone() } else { zero() })
}

pub(super) fn zero() -> Quantity {
    Quantity::exactly(Exact::integer(0))
}
