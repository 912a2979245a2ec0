//! `kinematics: delta`, after klippy/kinematics/delta.py and klippy/stepper.py.

use super::file::key;
use super::{angles, of_steppers, volume, ENDSTOP, PRINTER, STEPPERS};
use crate::import::settings::Settings;
use crate::import::toml::{least, less, polar, slider, Machine, Number, FACTORS};
use crate::import::ImportError;

const SOURCE: &str = "klippy/kinematics/delta.py";
const STEPPER: &str = "klippy/stepper.py";

pub(super) fn machine(settings: &mut Settings) -> Result<Machine, ImportError> {
    let delta_radius = key(PRINTER, "delta_radius");
    let radius = settings.required(&delta_radius, "the towers' distance from the axis")?;
    let arms = of_steppers(settings, "arm_length", "a leg's length", SOURCE)?;
    let angles = angles(settings, ["210", "330", "90"], SOURCE)?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let arm = key(STEPPERS[i], "arm_length");
        if !less(&radius.text, &arms[i].text) {
            return Err(settings.bad(&arm, format!("a length greater than {}", radius.text)));
        }
        let turn = || settings.bad(&key(STEPPERS[i], "angle"), "degrees within a turn");
        let foot = polar(&angles[i], Some(&radius)).ok_or_else(turn)?;
        let label = format!("{}, at {} degrees", STEPPERS[i], angles[i].text);
        *leg = slider(&label, &foot, "0", &arms[i].text);
    }
    let workspace = workspace(settings, &radius.text, &arms)?;
    settings.note(
        "The carriages' range: the firmware bounds z and the radius, not the carriages; its volume \
         ends where they reach their endstops.",
    );
    settings.note(
        "The workspace above the height at which the firmware narrows it to a cone: a design has \
         cylinders, no cones.",
    );
    Ok(Machine {
        title: "Linear Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace,
        requirements: FACTORS.to_owned(),
    })
}

/// The cylinder of the full radius, `DeltaKinematics.check_move`.
fn workspace(
    settings: &mut Settings,
    radius: &str,
    arms: &[Number; 3],
) -> Result<String, ImportError> {
    let lengths = arms.each_ref().map(|arm| arm.text.clone());
    let nothing = "leaves no workspace that can be told from none";
    let (arm, _) = least(&lengths).ok_or_else(|| settings.refused(nothing))?;
    let print_radius = key(PRINTER, "print_radius");
    let print_radius =
        settings.positive_or(&print_radius, "the workspace's radius", (radius, SOURCE))?;
    let h = half_step(settings)?;
    let radii = [
        print_radius.text,
        format!("{arm}-{radius}"),
        format!("12*sqrt({arm}*{arm}/145-{h}*{h})+{h}-{radius}"),
    ];
    let (full, value) = least(&radii).ok_or_else(|| settings.refused(nothing))?;
    if value.sign() != Some(1) {
        return Err(settings.refused("delta_radius leaves the arms no radius to print in"));
    }
    let ends = of_steppers(settings, "position_endstop", ENDSTOP, SOURCE)?;
    // The lowest of the heights at which a carriage is at its endstop right above the platform.
    let cones = ends.iter().zip(arms).map(|(end, Number { text: l, .. })| {
        format!("{}+sqrt({l}*{l}-{radius}*{radius})-{l}", end.text)
    });
    let cones: Vec<String> = cones.collect();
    let (cone, _) = least(&cones).ok_or_else(|| settings.refused(nothing))?;
    let full_up_to = match less(&full, radius) {
        true => {
            let from_tower = format!("({radius}-({full}))");
            format!("{cone}+{arm}-sqrt({arm}*{arm}-{from_tower}*{from_tower})")
        }
        false => cone,
    };
    let mut heights = vec![full_up_to];
    heights.extend(ends.iter().map(|end| end.text.clone()));
    let (high, _) = least(&heights).ok_or_else(|| settings.refused(nothing))?;
    volume(settings, SOURCE, &full, &high)
}

/// Half of the least distance that a step moves a carriage, `half_min_step_dist`.
fn half_step(settings: &mut Settings) -> Result<String, ImportError> {
    let mut steps = Vec::new();
    for stepper in STEPPERS {
        steps.push(step(settings, stepper)?);
    }
    let nothing = || settings.refused("the length of a step cannot be told");
    let (least, _) = least(&steps).ok_or_else(nothing)?;
    Ok(format!("({least})/2"))
}

/// `parse_step_distance`; older firmwares were told the distance itself.
fn step(settings: &mut Settings, stepper: &str) -> Result<String, ImportError> {
    const BECAME: &str = "the length of a step, in the workspace's radius";
    let rotation_distance = key(stepper, "rotation_distance");
    if settings.peek(&rotation_distance).is_none() {
        let distance = settings.positive(&key(stepper, "step_distance"), BECAME)?;
        return distance.map(|d| d.text).ok_or_else(|| settings.missing(&rotation_distance));
    }
    let distance = settings.required(&rotation_distance, BECAME)?.text;
    let microsteps = settings.required(&key(stepper, "microsteps"), BECAME)?.text;
    let steps = key(stepper, "full_steps_per_rotation");
    let steps = settings.positive_or(&steps, BECAME, ("200", STEPPER))?.text;
    let gears = gears(settings, &key(stepper, "gear_ratio"))?;
    Ok(format!("{distance}/({steps}*{microsteps}{gears})"))
}

/// The factors of `gear_ratio`, `107:16, 60:16`.
fn gears(settings: &mut Settings, gear_ratio: &str) -> Result<String, ImportError> {
    let Some(setting) = settings.text(gear_ratio, "the gears of a step") else {
        return Ok(String::new());
    };
    let mut factors = String::new();
    for pair in setting.value.split(',').filter(|pair| !pair.trim().is_empty()) {
        let ratio = pair.split_once(':').and_then(|(a, b)| {
            let positive = |text| Number::parse(text).filter(Number::is_positive);
            positive(a).zip(positive(b))
        });
        let (a, b) = ratio.ok_or_else(|| settings.bad(gear_ratio, "ratios such as 57:11, 2:1"))?;
        factors.push_str(&format!("*{}/{}", a.text, b.text));
    }
    Ok(factors)
}
