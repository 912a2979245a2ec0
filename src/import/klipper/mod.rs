//! Klipper: `printer.cfg` with `kinematics: delta` or `kinematics: rotary_delta`, after
//! klippy/kinematics/delta.py and rotary_delta.py.
//!
//! Tower `i` of a linear Delta stands at `delta_radius (cos angle_i, sin angle_i)`; its carriage is
//! at the height `z + sqrt(arm_length^2 - distance^2)`, so that the leg points down from it. Shoulder
//! `i` of a rotary Delta is at `shoulder_radius (cos angle_i, sin angle_i)` and the height
//! `shoulder_height`; angles of arms count upwards from the horizontal. The workspace is the
//! cylinder of the greatest radius to which the firmware moves, as high as it moves there.

mod file;
mod linear;
mod rotary;

use super::files::Reading;
use super::settings::Settings;
use super::toml::{cylinder, less, Number};
use super::{Files, ImportError, Imported, Setting};
use file::key;
use std::path::PathBuf;

const STEPPERS: [&str; 3] = ["stepper_a", "stepper_b", "stepper_c"];
const PRINTER: &str = "printer";

/// The design that a Klipper configuration describes: one file, and what it includes.
///
/// # Errors
/// If the firmware would not read it, if it is not of a linear or rotary Delta, or if a setting of
/// the printer or its three steppers is not understood.
pub fn klipper(
    files: &dyn Files,
    paths: &[PathBuf],
    ignore: &[String],
) -> Result<Imported, ImportError> {
    let [path] = paths else {
        let expected = "one printer.cfg; it names the others with [include]";
        return Err(ImportError::Files { found: paths.len(), expected });
    };
    let mut reading = Reading::new(files, path);
    let mut settings = file::read(&mut reading, path)?;
    let kinematics = key(PRINTER, "kinematics");
    let kind = settings.text(&kinematics, "the kind of machine");
    let kind = kind.ok_or_else(|| settings.missing(&kinematics))?;
    let machine = match kind.value.as_str() {
        "delta" => linear::machine(&mut settings)?,
        "rotary_delta" => rotary::machine(&mut settings)?,
        _ => {
            let expected = "delta, rotary_delta";
            return Err(ImportError::OtherMachine { file: kind.file, found: kind.value, expected });
        }
    };
    settings.note(
        "Corrections of the commanded position (bed_mesh, bed_tilt, skew_correction and the like), \
         speeds and limits of acceleration.",
    );
    settings.finish(&machine, cannot_matter, ignore, reading)
}

/// Only [printer] and the three steppers' sections reach the kinematics; of those, these keys are
/// speeds, pins and homing, or say how long a step is. A section named nearly like one of them is
/// none of the firmware's.
fn cannot_matter(setting: &Setting) -> bool {
    const OF_STEPPERS: [&str; 16] = [
        "step_pin",
        "dir_pin",
        "enable_pin",
        "step_pulse_duration",
        "rotation_distance",
        "step_distance",
        "microsteps",
        "full_steps_per_rotation",
        "gear_ratio",
        "homing_speed",
        "second_homing_speed",
        "homing_retract_speed",
        "homing_retract_dist",
        "homing_positive_dir",
        "position_min",
        "position_max",
    ];
    const OF_PRINTER: [&str; 8] = [
        "max_velocity",
        "max_accel",
        "max_accel_to_decel",
        "minimum_cruise_ratio",
        "square_corner_velocity",
        "max_z_velocity",
        "max_z_accel",
        "buffer_time_low",
    ];
    let (section, option) = setting.key.split_once("] ").unwrap_or_default();
    let bare: String = section.chars().filter(char::is_ascii_alphanumeric).collect();
    match bare.to_lowercase().as_str() {
        "printer" => section == "[printer" && OF_PRINTER.contains(&option),
        "steppera" | "stepperb" | "stepperc" => {
            STEPPERS.contains(&section.trim_start_matches('['))
                && (OF_STEPPERS.contains(&option)
                    || option == "endstop_pin" && !setting.value.contains("z_virtual_endstop"))
        }
        // Its settings stand in every section.
        "default" => false,
        _ => true,
    }
}

/// What `position_endstop` is for.
const ENDSTOP: &str = "the endstop's height, which bounds the workspace's";

/// A length of each stepper; that of the first where another has none.
fn of_steppers(
    settings: &mut Settings,
    option: &str,
    became: &str,
    source: &'static str,
) -> Result<[Number; 3], ImportError> {
    let first = settings.required(&key(STEPPERS[0], option), became)?;
    let mut other =
        |stepper: &str| settings.positive_or(&key(stepper, option), became, (&first.text, source));
    Ok([other(STEPPERS[0])?, other(STEPPERS[1])?, other(STEPPERS[2])?])
}

fn angles(
    settings: &mut Settings,
    defaults: [&str; 3],
    source: &'static str,
) -> Result<[Number; 3], ImportError> {
    let mut angle = |i: usize| {
        let became = "where the leg stands, in degrees";
        settings.number_or(&key(STEPPERS[i], "angle"), became, (defaults[i], source))
    };
    Ok([angle(0)?, angle(1)?, angle(2)?])
}

/// The firmware's volume of the full radius: from `minimum_z_position` to `high`, and not empty.
fn volume(
    settings: &mut Settings,
    source: &'static str,
    full: &str,
    high: &str,
) -> Result<String, ImportError> {
    let became = "the lowest height of the workspace";
    let low = key(PRINTER, "minimum_z_position");
    let low = settings.number_or(&low, became, ("0", source))?.text;
    if !less(&low, high) {
        return Err(settings.refused(format!(
            "at minimum_z_position, {low}, the firmware has narrowed its volume already; accepted: \
             endstops that leave a cylinder of the full radius, {full}"
        )));
    }
    Ok(cylinder(full, [&low, high]))
}
