//! The `[requirements]` table: what must hold at every point of the workspace.
//!
//! A requirement is a row of [`REQUIREMENTS`]: its key, and the function that reads its value.

use super::description::{Bound, Demand, Leg, Mechanism, Motion};
use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::leg;
use super::mechanism::Machine;
use super::number::{exact, less_than_half_a_turn, not_negative, ordered, positive};
use crate::exact::Exact;
use std::cmp::Ordering;
use toml::de::DeValue;

/// `min <= x <= max`; one of them is there.
#[derive(Clone)]
struct Range {
    min: Option<Exact>,
    max: Option<Exact>,
}

struct Requirement {
    key: &'static str,
    read: fn(&Value<'_>, &Machine, &'static str) -> Result<Vec<Demand>, DesignError>,
}

const REQUIREMENTS: &[Requirement] = &[
    Requirement { key: "transmission", read: transmission },
    Requirement { key: "joint_range", read: joint_range },
    Requirement { key: "conditioning", read: conditioning },
    Requirement { key: "serial_margin", read: serial_margin },
    Requirement { key: "parallel_margin", read: parallel_margin },
    Requirement { key: "leg_angle", read: leg_angle },
    Requirement { key: "joint_speed", read: joint_speed },
    Requirement { key: "joint_acceleration", read: joint_acceleration },
    Requirement { key: "joint_force", read: joint_force },
    Requirement { key: "load", read: load },
    Requirement { key: "stiffness", read: stiffness },
    Requirement { key: "accuracy", read: accuracy },
    Requirement { key: "one_to_one", read: one_to_one },
    Requirement { key: "clearance", read: clearance },
    Requirement { key: "constraint_margin", read: constraint_margin },
];

/// Keys that stand on legs, and are requirements as well.
const ON_LEGS: [&str; 2] = ["base_joint", "platform_joint"];

/// The place of a requirement in the order of the format, for those of no other order.
pub(super) fn position(key: &str) -> usize {
    let keys = REQUIREMENTS.iter().map(|requirement| requirement.key).chain(ON_LEGS);
    keys.take_while(|known| *known != key).count()
}

/// Whether `[requirements]` may have a key.
pub(super) fn is_key(key: &str) -> bool {
    REQUIREMENTS.iter().any(|requirement| requirement.key == key)
}

const BOUNDS: &str = r#"{ min = "1/2", max = 2 }, or one of min and max"#;
const CUBE_BOUND: &str =
    "transmission = { max = 2 }, or another number greater than 1: workspace.cube needs it";
const ANGLES: &str =
    "{ min = -45, max = 90 } in degrees, both ends, within ±360 and less than 180 apart";
const LENGTHS: &str = "{ min = 0, max = 257 }";

/// Reads the `[requirements]` on a machine.
pub(super) fn requirements(
    table: &Table<'_>,
    machine: &Machine,
) -> Result<Vec<Demand>, DesignError> {
    let keys: Vec<&str> = REQUIREMENTS.iter().map(|requirement| requirement.key).collect();
    table.only_here(&keys, |key| {
        ON_LEGS.contains(&key).then(|| "a leg, in its [[mechanism.legs]] table".to_owned())
    })?;
    let mut demands = Vec::new();
    for requirement in REQUIREMENTS {
        if let Some(value) = table.find(requirement.key) {
            demands.extend((requirement.read)(&value, machine, requirement.key)?);
        }
    }
    let is_asked = |key: &str| demands.iter().any(|demand| demand.quantity == key);
    if of_cube(machine) && !is_asked("transmission") {
        return Err(table.lacks("transmission", CUBE_BOUND));
    }
    if demands.is_empty() && machine.demands.is_empty() {
        let accepted = format!("at least one requirement: {}", keys.join(", "));
        return Err(table.lacks("transmission", accepted));
    }
    Ok(demands)
}

/// The first requirement that depends on the unit of `M`, in which a turning platform's velocity has
/// two parts.
pub(super) fn of_unit(demands: &[Demand]) -> Option<&'static str> {
    const OF_UNIT: [&str; 6] = [
        "transmission",
        "conditioning",
        "stiffness",
        "joint_speed",
        "joint_acceleration",
        "joint_force",
    ];
    OF_UNIT.into_iter().find(|key| demands.iter().any(|demand| demand.quantity == *key))
}

/// Whether this is the Orthoglide of a cube, all of which follows from `psi_max`.
fn of_cube(machine: &Machine) -> bool {
    matches!(machine.mechanism, Mechanism::OfCube { .. })
}

/// Refuses a requirement on legs that are not all such, as the three sliders of a cube are.
fn all_legs(
    value: &Value<'_>,
    machine: &Machine,
    are: fn(&Leg) -> bool,
    [found, accepted]: [&str; 2],
) -> Result<(), DesignError> {
    match of_cube(machine) || machine.mechanism.all_legs(are) {
        true => Ok(()),
        false => Err(value.error(Defect::Conflict, found, accepted)),
    }
}

/// Refuses a requirement of a machine with more joints than coordinates.
fn not_redundant(value: &Value<'_>, machine: &Machine, key: &str) -> Result<(), DesignError> {
    let (joints, coordinates) =
        (machine.mechanism.joints(), machine.mechanism.coordinates().iter().sum::<usize>());
    if joints == coordinates {
        return Ok(());
    }
    let found = format!("{joints} joints of {coordinates} coordinates");
    let accepted = format!("{key} of machines with as many joints as coordinates");
    Err(value.error(Defect::Conflict, found, accepted))
}

/// `psi_min <= psi_i <= psi_max`.
fn transmission(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let cube = of_cube(machine);
    let table = value.table(if cube { CUBE_BOUND } else { BOUNDS })?;
    let (least, greatest, range) = bounds(&table)?;
    for (bound, number) in [(&least, &range.min), (&greatest, &range.max)] {
        if let (Some(bound), Some(number)) = (bound, number) {
            positive(bound, number, "a transmission factor")?;
        }
    }
    if cube {
        psi_max_alone(&table, &range)?;
    }
    if let (Some(min), Some(max), Some(greatest)) = (&range.min, &range.max, &greatest) {
        if greatest.document.demands() && min.compare(max) != Some(Ordering::Less) {
            let found = format!("{}, not (provably) above min", greatest.found());
            let accepted = "max greater than min";
            return Err(greatest.error(Defect::Reversed, found, accepted));
        }
    }
    Ok(ends(key, None, range))
}

/// The demands that a range comes to.
fn ends(key: &'static str, leg: Option<usize>, range: Range) -> Vec<Demand> {
    let bounds = range.min.map(Bound::Min).into_iter().chain(range.max.map(Bound::Max));
    bounds.map(|bound| Demand { leg, ..Demand::of(key, bound) }).collect()
}

/// The only bound that the paper's cube leaves free: `psi_max > 1`.
fn psi_max_alone(table: &Table<'_>, range: &Range) -> Result<(), DesignError> {
    if let Some(least) = table.find("min") {
        let found = format!("{}, next to workspace.cube", least.found());
        let accepted = "max alone: with workspace.cube, min is 1/max by definition";
        return Err(least.error(Defect::Conflict, found, accepted));
    }
    let greatest = table.require("max", CUBE_BOUND)?;
    let above_one = range.max.as_ref().and_then(|max| max.compare(&Exact::integer(1)));
    if greatest.document.demands() && above_one != Some(Ordering::Greater) {
        return Err(greatest.error(Defect::OutOfDomain, greatest.found(), CUBE_BOUND));
    }
    Ok(())
}

/// `rho_min <= rho_i <= rho_max`, common to the joints or one range for each; for arms in degrees.
fn joint_range(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let angular = machine.mechanism.is_angular();
    let joints = machine.mechanism.joints();
    let one = if angular { ANGLES } else { LENGTHS };
    let accepted = &format!(
        "{one}, or an array of {} such tables, {{}} for a joint of which nothing is claimed",
        in_words(joints)
    );
    if let Mechanism::Formulas(formulas) = &machine.mechanism {
        use orthocert_kernel::claim::JointFormula::Row;
        if formulas.joints.iter().any(|joint| matches!(joint, Row(_))) {
            let found = "a joint without rho: the design gives its row of M alone";
            let accepted = "joint_range where every joint has a rho";
            return Err(value.error(Defect::Conflict, found, accepted));
        }
    }
    let range = |value: &Value<'_>, leg: Option<usize>| {
        let table = value.table(accepted)?;
        let (least, greatest, range) = bounds(&table)?;
        if let (Some(least), Some(greatest), Some(min), Some(max)) =
            (&least, &greatest, &range.min, &range.max)
        {
            ordered((least, min), (greatest, max))?;
        }
        if !angular {
            return Ok(ends(key, leg, range));
        }
        angles(&table, &range, accepted)?;
        let Range { min: Some(min), max: Some(max) } = range else {
            return Err(table.lacks("max", accepted));
        };
        Ok(vec![Demand { leg, ..Demand::of(key, Bound::Within([min, max])) }])
    };
    let DeValue::Array(_) = value.inner else {
        return range(value, None);
    };
    let values = value.list(accepted)?;
    if values.len() != joints {
        return Err(value.wrong_type(accepted));
    }
    let mut demands = Vec::new();
    let tables = values.iter().map(|value| value.table(accepted)).collect::<Result<Vec<_>, _>>()?;
    let is_asked = |i: &usize| !tables[*i].entries().is_empty();
    // Of none at all the first lacks its ends.
    let asked: Vec<usize> = (0..joints).filter(is_asked).collect();
    for i in if asked.is_empty() { vec![0] } else { asked } {
        demands.extend(range(&values[i], Some(i + 1))?);
    }
    Ok(demands)
}

/// A number of joints.
fn in_words(n: usize) -> &'static str {
    const WORDS: [&str; 12] = [
        "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
        "twelve",
    ];
    n.checked_sub(1).and_then(|i| WORDS.get(i).copied()).unwrap_or("as many")
}

/// Demands both ends of a range of angles, within a turn and less than half a turn apart.
fn angles(table: &Table<'_>, range: &Range, accepted: &str) -> Result<(), DesignError> {
    let (least, greatest) = (table.require("min", accepted)?, table.require("max", accepted)?);
    let (Some(min), Some(max)) = (&range.min, &range.max) else {
        return Err(table.lacks("max", accepted));
    };
    if !least.document.demands() {
        return Ok(());
    }
    let at_most =
        |x: &Exact, y: &Exact| matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal));
    if !at_most(&Exact::integer(-360), min) {
        return Err(least.error(Defect::OutOfDomain, least.found(), accepted));
    }
    let span = max.clone().minus(min.clone()).ok();
    let narrow = span.and_then(|span| span.compare(&Exact::integer(180))) == Some(Ordering::Less);
    if !narrow || !at_most(max, &Exact::integer(360)) {
        return Err(greatest.error(Defect::OutOfDomain, greatest.found(), accepted));
    }
    Ok(())
}

/// `sigma_max / sigma_min <= max`.
fn conditioning(
    value: &Value<'_>,
    _: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "{ max = 3 }, greater than 1";
    let (bound, max) = single(value, "max", accepted)?;
    if bound.document.demands() && max.compare(&Exact::integer(1)) != Some(Ordering::Greater) {
        return Err(bound.error(Defect::OutOfDomain, bound.found(), accepted));
    }
    Ok(vec![Demand::of(key, Bound::Max(max))])
}

/// `|eta_i| / L_i >= min`.
fn serial_margin(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let (bound, min) = single(value, "min", r#"{ min = "1/5" }, a part of the leg's length"#)?;
    positive(&bound, &min, "a part of the leg's length")?;
    let of =
        ["legs without a length", "serial_margin for sliders and arms: other legs have no length"];
    all_legs(value, machine, |leg| leg.drive.has_length(), of)?;
    Ok(vec![Demand::of(key, Bound::Min(min))])
}

/// `|det A| / (L_1 .. L_n) >= min`.
fn parallel_margin(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let (bound, min) = single(value, "min", r#"{ min = "1/10" }, the volume of unit legs"#)?;
    positive(&bound, &min, "a volume")?;
    let of = ["joints without legs", "parallel_margin of machines with legs"];
    all_legs(value, machine, |_| true, of)?;
    not_redundant(value, machine, key)?;
    Ok(vec![Demand::of(key, Bound::Min(min))])
}

/// The angle between leg and guide is at most `max` degrees.
fn leg_angle(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "{ max = 60 }, in degrees, greater than 0 and at most 90";
    let (bound, max) = single(value, "max", accepted)?;
    let up_to_90 = max.compare(&Exact::integer(90));
    let within =
        max.sign() == Some(1) && matches!(up_to_90, Some(Ordering::Less | Ordering::Equal));
    if bound.document.demands() && !within {
        return Err(bound.error(Defect::OutOfDomain, bound.found(), accepted));
    }
    let of = ["legs without a guide", "leg_angle for sliders: other legs have no guide"];
    all_legs(value, machine, |leg| matches!(leg.drive, leg::Leg::Slider { .. }), of)?;
    Ok(vec![Demand::of(key, Bound::Max(max))])
}

/// No tool velocity of magnitude `tool` demands a joint speed beyond `max`, of arms in degrees per
/// unit of time.
fn joint_speed(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = match machine.mechanism.is_angular() {
        true => "{ tool = 100, max = 1000 }: the tool's speed and the arms' limit, degrees per unit of time",
        false => "{ tool = 1200, max = 2000 }: the tool's speed and the joints' limit, lengths per unit of time",
    };
    let [tool, max] = positives(value, ["tool", "max"], "a speed", accepted)?;
    Ok(vec![Demand { given: vec![("tool", vec![tool])], ..Demand::of(key, Bound::Max(max)) }])
}

/// No platform motion up to a speed and an acceleration demands a joint acceleration beyond `max`.
fn joint_acceleration(
    value: &Value<'_>,
    _: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "{ speed = 1200, acceleration = 14000, max = 40000 }: the platform's, and the joints' limit";
    let table = value.table(accepted)?;
    table.only(&["speed", "acceleration", "max"])?;
    let of_platform = |key: &str| {
        let value = table.require(key, accepted)?;
        let number = exact(&value)?;
        not_negative(&value, &number, "a magnitude")?;
        Ok(vec![number])
    };
    let given =
        vec![("acceleration", of_platform("acceleration")?), ("speed", of_platform("speed")?)];
    let bound = table.require("max", accepted)?;
    let max = exact(&bound)?;
    positive(&bound, &max, "an acceleration")?;
    Ok(vec![Demand { given, ..Demand::of(key, Bound::Max(max)) }])
}

/// No force on the platform up to `tool` asks more than `max` of a joint.
fn joint_force(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "{ tool = 100, max = 250 }: the force on the platform and the joints' limit, of arms a torque";
    let [tool, max] = positives(value, ["tool", "max"], "a force", accepted)?;
    not_redundant(value, machine, key)?;
    Ok(vec![Demand { given: vec![("tool", vec![tool])], ..Demand::of(key, Bound::Max(max)) }])
}

/// Holding one force on the platform asks no more than `max` of a joint.
fn load(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let [coordinates, turns] = machine.mechanism.coordinates();
    let accepted = match coordinates {
        2 => "{ force = [0, -100], max = 250 }: the force on the platform, not zero, and the joints' limit, of arms a torque",
        _ => "{ force = [0, 0, -100], max = 250 }: the force on the platform, not zero, a number for each coordinate, and the joints' limit, of arms a torque",
    };
    if turns > 0 {
        let found = "a platform that turns";
        return Err(value.error(Defect::Conflict, found, "load where it does not; joint_force"));
    }
    not_redundant(value, machine, key)?;
    let table = value.table(accepted)?;
    table.only(&["force", "max"])?;
    let of_platform = table.require("force", accepted)?;
    let numbers = of_platform.list(accepted)?;
    let force = numbers.iter().map(exact).collect::<Result<Vec<_>, _>>()?;
    let is_zero = |x: &Exact| x.sign() == Some(0);
    if force.len() != coordinates || force.iter().all(is_zero) {
        return Err(of_platform.error(Defect::OutOfDomain, of_platform.found(), accepted));
    }
    let bound = table.require("max", accepted)?;
    let max = exact(&bound)?;
    positive(&bound, &max, "a force")?;
    Ok(vec![Demand { given: vec![("force", force)], ..Demand::of(key, Bound::Max(max)) }])
}

/// With joints of a stiffness, one or one a leg, the platform's least stiffness is at least `min`.
fn stiffness(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "{ joint = 50, min = 20 }: the joints' stiffness, a number or one a leg, and the platform's";
    let table = value.table(accepted)?;
    table.only(&["joint", "min"])?;
    let of_joints = table.require("joint", accepted)?;
    let one = |value: &Value<'_>| {
        let number = exact(value)?;
        positive(value, &number, "a stiffness").map(|()| number)
    };
    let joint = match of_joints.inner {
        DeValue::Array(_) => {
            let joints = machine.mechanism.joints();
            let values = of_joints.list(accepted)?;
            if values.len() != joints {
                let accepted = format!("a number, or an array of {} numbers", in_words(joints));
                return Err(of_joints.wrong_type(&accepted));
            }
            values.iter().map(one).collect::<Result<Vec<_>, _>>()?
        }
        _ => vec![one(&of_joints)?],
    };
    let min = one(&table.require("min", accepted)?)?;
    Ok(vec![Demand { given: vec![("joint", joint)], ..Demand::of(key, Bound::Min(min)) }])
}

/// Joint coordinates within `joint_error` of those commanded put the platform within `max` of the
/// position commanded.
fn accuracy(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let turns = machine.mechanism.coordinates()[1] > 0;
    let (accepted, keys): (_, &[&str]) = match turns {
        true => (
            "{ joint_error = 0.01, max = 0.05, max_angle = 0.1 }",
            &["joint_error", "max", "max_angle"],
        ),
        false => ("{ joint_error = 0.01, max = 0.05 }", &["joint_error", "max"]),
    };
    let table = value.table(accepted)?;
    table.only(keys)?;
    let error = table.require("joint_error", accepted)?;
    let joint_error = exact(&error)?;
    not_negative(&error, &joint_error, "an error of the joints")?;
    let mut given = vec![("joint_error", vec![joint_error])];
    let bound = table.require("max", accepted)?;
    let max = exact(&bound)?;
    positive(&bound, &max, "a distance")?;
    if turns {
        let bound = table.require("max_angle", accepted)?;
        let angle = exact(&bound)?;
        less_than_half_a_turn(&bound, &angle)?;
        given.push(("max_angle", vec![angle]));
    }
    not_redundant(value, machine, key)?;
    Ok(vec![Demand { given, ..Demand::of(key, Bound::Max(max)) }])
}

/// No two points of the workspace have the same joint coordinates.
fn one_to_one(
    value: &Value<'_>,
    _: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let accepted = "true, or nothing: the key is missing";
    match value.inner {
        DeValue::Boolean(true) => Ok(vec![Demand::of(key, Bound::Holds)]),
        DeValue::Boolean(false) => Err(value.error(Defect::OutOfDomain, value.found(), accepted)),
        _ => Err(value.wrong_type(accepted)),
    }
}

/// Rods and bodies keep a distance.
fn clearance(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let (bound, min) = single(value, "min", "{ min = 2 }, a distance between rods and bodies")?;
    not_negative(&bound, &min, "a distance")?;
    if machine.bodies.len() < 2 {
        let found = match machine.bodies.len() {
            0 => "clearance of a machine without rods and bodies",
            _ => "clearance of one body alone",
        };
        let accepted = "rod = { radius = 8, trim = [20, 30] } on legs, and [[mechanism.bodies]]";
        return Err(value.error(Defect::Conflict, found, accepted));
    }
    Ok(vec![Demand::of(key, Bound::Min(min))])
}

/// The least singular value of the matrix of unit constraint couples.
fn constraint_margin(
    value: &Value<'_>,
    machine: &Machine,
    key: &'static str,
) -> Result<Vec<Demand>, DesignError> {
    let (bound, min) = single(value, "min", "{ min = 0.1 }, a least singular value")?;
    positive(&bound, &min, "a singular value")?;
    let in_translation = |leg: &Leg| leg.base_axis.is_some();
    let translational =
        matches!(machine.mechanism, Mechanism::Legs { motion: Motion::Translational, .. });
    if !translational || !machine.mechanism.all_legs(in_translation) {
        let accepted =
            "constraint_margin of kind \"translational\", every leg a strut with base_axis";
        return Err(value.error(Defect::Conflict, "legs without a base_axis", accepted));
    }
    Ok(vec![Demand::of(key, Bound::Min(min))])
}

/// Two positive numbers, the only ones of a table.
fn positives(
    value: &Value<'_>,
    keys: [&str; 2],
    what: &str,
    accepted: &str,
) -> Result<[Exact; 2], DesignError> {
    let table = value.table(accepted)?;
    table.only(&keys)?;
    let one = |key: &str| {
        let value = table.require(key, accepted)?;
        let number = exact(&value)?;
        positive(&value, &number, what).map(|()| number)
    };
    let [first, second] = keys;
    Ok([one(first)?, one(second)?])
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
