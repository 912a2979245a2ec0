//! The `[mechanism]` table: kinds of machines.
//!
//! A kind of machine is a row of [`KINDS`]: a name and the function that reads what goes with it.

use super::bodies;
use super::description::{Demand, Leg, Mechanism, Motion};
use super::document::{Table, Value};
use super::drive::{self, LENGTH};
use super::error::{Defect, DesignError};
use super::formulas;
use super::independence;
use super::leg::{self, Quantity, WorkingMode};
use super::number::{exact, negated, positive, quantity};
use crate::exact::Exact;
use orthocert_kernel::claim::Body;

/// Most legs or joints.
pub(super) const MOST_LEGS: usize = 12;

/// What the rest of the design says that decides how a mechanism is read.
pub(super) struct Setting<'a> {
    /// `workspace.cube`, which determines all of an Orthoglide but its offset.
    pub cube: Option<Value<'a>>,
    /// `requirements.joint_range`, which needs to know where the joint coordinates are zero.
    pub joint_range: Option<Value<'a>>,
    /// Whether there is `workspace.orientation`: a platform in the plane turns where there is.
    pub turns: bool,
}

/// What `[mechanism]` says.
pub(super) struct Machine {
    pub mechanism: Mechanism,
    pub characteristic_length: Option<Exact>,
    pub bodies: Vec<Body>,
    /// What legs say of their joints.
    pub demands: Vec<Demand>,
}

impl Machine {
    fn of(mechanism: Mechanism) -> Self {
        Machine { mechanism, characteristic_length: None, bodies: Vec::new(), demands: Vec::new() }
    }
}

struct Kind {
    name: &'static str,
    keys: &'static [&'static str],
    read: fn(&Table<'_>, &Setting<'_>) -> Result<Machine, DesignError>,
}

const OF_LEGS: &[&str] = &["kind", "legs", "bodies"];
const TURNING: &[&str] = &["kind", "characteristic_length", "legs", "bodies"];

const KINDS: &[Kind] = &[
    Kind {
        name: "orthoglide",
        keys: &["kind", "leg_length", "base", "offset", "bodies"],
        read: orthoglide,
    },
    Kind { name: "translational", keys: OF_LEGS, read: |t, _| legs(t, Motion::Translational) },
    Kind { name: "planar", keys: TURNING, read: |t, s| legs(t, Motion::Planar { turns: s.turns }) },
    Kind { name: "spatial", keys: TURNING, read: |t, _| legs(t, Motion::Spatial) },
    Kind { name: "spherical", keys: TURNING, read: |t, _| legs(t, Motion::Spherical) },
    Kind { name: "formulas", keys: formulas::KEYS, read: by_formulas },
];

/// Reads `[mechanism]`.
pub(super) fn mechanism(table: &Table<'_>, setting: &Setting<'_>) -> Result<Machine, DesignError> {
    let kind = word(table, "kind", KINDS, |kind| kind.name)?;
    table.only_here(kind.keys, |key| {
        let with = KINDS.iter().filter(|kind| kind.keys.contains(&key));
        let names: Vec<String> = with.map(|kind| format!("{:?}", kind.name)).collect();
        (!names.is_empty()).then(|| format!("kind = {}", names.join(", ")))
    })?;
    if let (Some(cube), true) = (&setting.cube, kind.name != "orthoglide") {
        let accepted = "min and max, or cylinder: workspace.cube goes with mechanism.kind = \
                        \"orthoglide\" only";
        return Err(cube.error(Defect::Conflict, "a cube, next to another machine", accepted));
    }
    (kind.read)(table, setting)
}

/// The Orthoglide: guides along the axes, `a_i = a e_i`, `d_i = -e e_i`, `L_i = L`, `eta_i > 0`.
fn orthoglide(table: &Table<'_>, setting: &Setting<'_>) -> Result<Machine, DesignError> {
    let bodies = bodies::bodies(table, Motion::Translational)?;
    if setting.cube.is_some() {
        let mechanism = orthoglide_of_cube(table)?;
        return Ok(Machine { bodies, ..Machine::of(mechanism) });
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
            let accepted = "joint_range together with mechanism.base: where rho = 0 on each axis, such as -384";
            return Err(range.error(Defect::Conflict, found, accepted));
        }
    };
    let leg = |axis: usize| {
        let drive = leg::Leg::Slider {
            direction: along(axis, &Quantity::exactly(Exact::integer(1))),
            anchor: along(axis, &base),
            platform: along(axis, &offset),
            length: length.clone(),
            mode: WorkingMode::Plus,
        };
        Leg { drive, base_axis: None }
    };
    let legs = vec![leg(0), leg(1), leg(2)];
    let mechanism = Mechanism::Legs { motion: Motion::Translational, legs };
    Ok(Machine { bodies, ..Machine::of(mechanism) })
}

/// The Orthoglide of the paper's Steps 1 to 3.
fn orthoglide_of_cube(table: &Table<'_>) -> Result<Mechanism, DesignError> {
    for key in ["leg_length", "base"] {
        if let Some(value) = table.find(key) {
            let found = format!("{}, next to workspace.cube", value.found());
            let accepted = format!(
                "no {key} here: with workspace.cube it follows from requirements.transmission.max"
            );
            return Err(value.error(Defect::Conflict, found, accepted));
        }
    }
    let Some(value) = table.find("offset") else {
        return Ok(Mechanism::OfCube { offset: Exact::integer(0) });
    };
    let offset = quantity(&value)?;
    if !offset.is_exact() {
        let accepted = "one exact number: with workspace.cube the bounds are met with equality, \
                        which leaves no room for tolerances";
        return Err(value.error(Defect::Tolerance, "a tolerance", accepted));
    }
    Ok(Mechanism::OfCube { offset: offset.min })
}

/// Legs, each with its own drive.
fn legs(table: &Table<'_>, motion: Motion) -> Result<Machine, DesignError> {
    let accepted = match motion {
        Motion::Translational => "three [[mechanism.legs]] tables, or more, up to twelve",
        Motion::Planar { turns: false } => {
            "two [[mechanism.legs]] tables, or more, up to twelve (of a platform that turns, three: \
             workspace.orientation says that it does)"
        }
        Motion::Planar { turns: true } | Motion::Spherical => {
            "three [[mechanism.legs]] tables, or more, up to twelve"
        }
        Motion::Spatial => "six [[mechanism.legs]] tables, or more, up to twelve",
    };
    let characteristic_length = characteristic_length(table, motion)?;
    let value = table.require("legs", accepted)?;
    let values = value.list(accepted)?;
    let coordinates = motion.coordinates().iter().sum::<usize>();
    if !(coordinates..=MOST_LEGS).contains(&values.len()) {
        return Err(value.wrong_type(accepted));
    }
    let (mut legs, mut bodies, mut demands) = (Vec::new(), Vec::new(), Vec::new());
    for (i, value) in values.iter().enumerate() {
        legs.push(drive::leg(value, motion)?);
        let table = value.table("a [[mechanism.legs]] table")?;
        bodies.extend(bodies::rods(&table, i + 1, motion)?);
        demands.extend(bodies::joints(&table, i + 1, motion)?);
    }
    drive::one_unit(&values, &legs)?;
    let drives: Vec<&leg::Leg> = legs.iter().map(|leg| &leg.drive).collect();
    if legs.len() == coordinates {
        independence::different(&values, &drives)?;
    }
    if let (Motion::Translational, [first, second, third]) = (motion, drives.as_slice()) {
        independence::independent(&values, [first, second, third])?;
    }
    bodies.extend(bodies::bodies(table, motion)?);
    let mechanism = Mechanism::Legs { motion, legs };
    Ok(Machine { mechanism, characteristic_length, bodies, demands })
}

/// `l > 0`, of a platform that turns.
fn characteristic_length(table: &Table<'_>, motion: Motion) -> Result<Option<Exact>, DesignError> {
    let Some(value) = table.find("characteristic_length") else {
        return Ok(None);
    };
    if !motion.turns() {
        let found = format!("{}, of a platform that does not turn", value.found());
        let accepted = "no characteristic_length, or workspace.orientation = { angle = [-20, 20] }";
        return Err(value.error(Defect::Conflict, found, accepted));
    }
    let length = exact(&value)?;
    positive(&value, &length, "a length")?;
    Ok(Some(length))
}

/// Inverse kinematics.
fn by_formulas(table: &Table<'_>, _: &Setting<'_>) -> Result<Machine, DesignError> {
    Ok(Machine::of(Mechanism::Formulas(formulas::formulas(table)?)))
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
