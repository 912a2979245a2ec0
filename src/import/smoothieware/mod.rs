//! Smoothieware: `config`, with what it includes, and the `config-override` that `M500` saved.
//!
//! The towers of a linear Delta are those of `LinearDeltaSolution::init`, at 210, 330 and 90 degrees
//! and their corrections, with rods of lengths of their own. The arms of a rotary Delta are those of
//! `delta_calcAngleYZ` in RotaryDeltaSolution.cpp: at 270, 30 and 150 degrees, with the sides of two
//! triangles for radii and angles that count downwards. Of the volume the firmware enforces the soft
//! endstops, where they are enabled, and nothing else.

mod file;

use super::files::{Files, Reading};
use super::settings::Settings;
use super::toml::{cylinder, factors_per_radian, quoted, Arm, Machine, Number, FACTORS};
use super::towers::{difference, highest, legs, sum, Tower, TOWERS};
use super::{ImportError, Imported};
use crate::exact::Exact;
use std::cmp::Ordering;
use std::path::PathBuf;

/// The firmware's files with the defaults.
const LINEAR: &str = "src/modules/robot/arm_solutions/LinearDeltaSolution.cpp";
const ROTARY: &str = "src/modules/robot/arm_solutions/RotaryDeltaSolution.cpp";
const ENDSTOPS: &str = "src/modules/tools/endstops/Endstops.cpp";

/// Some revisions take it for true, others do not know it.
const UNSAID: &str =
    "delta_mirror_xy is not set, and whether x and y are mirrored then depends on the \
                      firmware's revision; accepted: a configuration that sets it";

/// The design that Smoothieware's `config` describes. Included files and `config-override` are
/// looked for among the other paths, then beside it.
///
/// # Errors
/// If a file cannot be read, or is not called for; if the settings make no linear or rotary Delta;
/// if they set what is not understood and not in `ignore`.
pub fn smoothieware(
    files: &dyn Files,
    paths: &[PathBuf],
    ignore: &[String],
) -> Result<Imported, ImportError> {
    let expected = "config, files that it includes, config-override";
    let first = paths.first().ok_or(ImportError::Files { found: 0, expected })?;
    let mut reading = Reading::new(files, first);
    let mut settings = Settings::new(reading.shown(first));
    let overridden = file::read(&mut reading, &mut settings, paths)?;
    let solution = settings.text("arm_solution", "the kinematics").map(|setting| setting.value);
    let machine = match solution.as_deref() {
        Some("rostock" | "kossel" | "delta" | "linear_delta") => {
            file::override_linear(&mut settings, &overridden);
            linear(&mut settings)?
        }
        Some("rotary_delta") => {
            file::override_rotary(&mut settings, &overridden);
            rotary(&mut settings)?
        }
        other => {
            return Err(ImportError::OtherMachine {
                file: reading.shown(first),
                found: other.unwrap_or("cartesian, the firmware's default").to_owned(),
                expected: "linear_delta, delta, kossel, rostock, rotary_delta",
            });
        }
    };
    if overridden.is_empty() {
        settings.note(
            "Values that M500 saved in config-override: there is none beside the configuration; \
             if the machine has one, give it as well.",
        );
    }
    settings.finish(&machine, file::is_harmless, ignore, reading)
}

fn linear(settings: &mut Settings) -> Result<Machine, ImportError> {
    let rod = settings.positive_or("arm_length", "the rods' length", ("250.0", LINEAR))?;
    let became = "the towers' distance from the centre";
    let radius = settings.positive_or("arm_radius", became, ("124.0", LINEAR))?;
    let mut towers = Vec::new();
    for (i, (label, degrees)) in TOWERS.into_iter().enumerate() {
        let [offset, angle] =
            ["offset", "angle"].map(|what| format!("delta_tower{}_{what}", i + 1));
        let trim = format!("arm{}_trim", i + 1);
        let further =
            settings.number_or(&offset, "added to the tower's distance", ("0", LINEAR))?;
        let turned = settings.number_or(&angle, "added to the tower's angle", ("0", LINEAR))?;
        let longer = settings.number_or(&trim, "added to the rods' length", ("0", LINEAR))?;
        let degrees = Number::parse(degrees).and_then(|base| sum(&base, &turned));
        let rod = match longer.value.sign() {
            Some(0) => Some(rod.clone()),
            _ => sum(&rod, &longer).filter(Number::is_positive),
        };
        towers.push(Tower {
            label,
            degrees: degrees.ok_or_else(|| settings.bad(&angle, "degrees"))?,
            radius: sum(&radius, &further).ok_or_else(|| settings.bad(&offset, "a length"))?,
            rod: rod.ok_or_else(|| settings.bad(&trim, "rods longer than 0"))?,
        });
    }
    let reach = "a radius less than the rods' length, corrections within a turn";
    let legs = legs(&towers).ok_or_else(|| settings.bad("arm_radius", reach))?;
    let workspace = match soft_endstops(settings)? {
        Some(workspace) => workspace,
        None => unlimited_linear(settings, &towers, &radius)?,
    };
    Ok(Machine {
        title: "Linear Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace,
        requirements: FACTORS.to_owned(),
    })
}

/// Where the firmware has no limits: a cylinder that the carriages' endstops leave, of a radius that
/// is to be changed.
fn unlimited_linear(
    settings: &mut Settings,
    towers: &[Tower],
    radius: &Number,
) -> Result<String, ImportError> {
    settings.note(
        "The workspace: without soft endstops in x, y and z the firmware enforces none; half the \
         towers' distance is a guess to be changed.",
    );
    let half = format!("{}/2", radius.text);
    let half = Exact::parse(&half, 1000).map(|value| Number { text: half, value });
    let half = half.map_err(|_| settings.bad("arm_radius", "a length"))?;
    let tops = tops(settings, towers)?;
    let high = tops
        .and_then(|tops| highest(towers, &tops, &half))
        .filter(|high| Exact::parse(high, 10_000).is_ok_and(|value| value.sign() == Some(1)));
    let high = match high {
        Some(high) => {
            settings.note(
                "The workspace's height: that at which a carriage would be at its endstop; the \
                 firmware stops none there but when it homes.",
            );
            high
        }
        None => {
            settings.note(
                "The workspace's height: endstops that leave one above 0 are not set; it is flat. \
                 The factors of a linear Delta do not depend on z.",
            );
            "0".to_owned()
        }
    };
    Ok(cylinder(&half.text, ["0", &high]))
}

/// Where each carriage is at its endstop, `Endstops::process_home_command`; none if the machine does
/// not home there, or not over the centre.
fn tops(settings: &mut Settings, towers: &[Tower]) -> Result<Option<Vec<String>>, ImportError> {
    let homes = settings.peek("delta_homing").is_some_and(|s| file::is_true(&s.value));
    if !homes {
        return Ok(None);
    }
    let mut home = Vec::new();
    for axis in ["alpha", "beta", "gamma"] {
        let Some(position) = homed(settings, axis)? else { return Ok(None) };
        home.push(position);
    }
    settings.text("delta_homing", "all carriages home at once, to their endstops");
    let centred = home[..2].iter().all(|position| position.value.sign() == Some(0));
    if !centred {
        return Ok(None);
    }
    let raised =
        settings.number_or("M206 Z", "added to the height at the endstops", ("0", ENDSTOPS))?;
    let mut tops = Vec::new();
    for (tower, axis) in towers.iter().zip(["alpha", "beta", "gamma"]) {
        let key = format!("{axis}_trim_mm");
        let trim = settings.number_or(&key, "how far a carriage is lower", ("0", ENDSTOPS))?;
        let (home, raised, trim) = (&home[2].text, &raised.text, &trim.text);
        tops.push(format!("{home}+({raised})+{}-({trim})", tower.centred()));
    }
    Ok(Some(tops))
}

/// The coordinate at which an axis is homed.
fn homed(settings: &mut Settings, axis: &str) -> Result<Option<Number>, ImportError> {
    let old = settings.peek("endstops_enable").is_some_and(|s| file::is_true(&s.value));
    if !old {
        return Ok(None);
    }
    settings.text("endstops_enable", "the endstops are used");
    let key = format!("{axis}_homing_direction");
    let upwards = settings.text(&key, "the end at which it is homed");
    const BECAME: &str = "where it is homed";
    match upwards.is_some_and(|setting| setting.value == "home_to_max") {
        true => settings.number_or(&format!("{axis}_max"), BECAME, ("200", ENDSTOPS)).map(Some),
        false => settings.number_or(&format!("{axis}_min"), BECAME, ("0", ENDSTOPS)).map(Some),
    }
}

/// The box of the soft endstops, if they are enabled and all set.
fn soft_endstops(settings: &mut Settings) -> Result<Option<String>, ImportError> {
    let enabled = settings.text("soft_endstop.enable", "whether moves are held to soft endstops");
    if !enabled.is_some_and(|setting| file::is_true(&setting.value)) {
        return Ok(None);
    }
    let mut corners = [Vec::new(), Vec::new()];
    let keys = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];
    if keys.iter().any(|key| settings.peek(&format!("soft_endstop.{key}")).is_none()) {
        return Ok(None);
    }
    for axis in ["x", "y", "z"] {
        let mut end = |end: &str| {
            let key = format!("soft_endstop.{axis}_{end}");
            let number = settings.number(&key, "the workspace's box")?;
            number.ok_or_else(|| settings.missing(&key))
        };
        let (low, high) = (end("min")?, end("max")?);
        if low.value.compare(&high.value) == Some(Ordering::Greater) {
            let key = format!("soft_endstop.{axis}_max");
            return Err(settings.bad(&key, "a number not below that of the other end"));
        }
        corners[0].push(quoted(&low.text));
        corners[1].push(quoted(&high.text));
    }
    Ok(Some(format!("min = [{}]\nmax = [{}]\n", corners[0].join(", "), corners[1].join(", "))))
}

fn rotary(settings: &mut Settings) -> Result<Machine, ImportError> {
    let mut length = |key: &str, became: &str, default: &'static str| {
        settings.positive_or(key, became, (default, ROTARY))
    };
    let platform = length("delta_e", "the side of the platform's triangle", "131.636")?;
    let base = length("delta_f", "the side of the base's triangle", "190.526")?;
    let rod = length("delta_re", "the rods' length", "270.000")?;
    let arm = length("delta_rf", "the arms' length", "90.000")?;
    let mut offset = |key: &str, became: &str, default: &'static str| {
        settings.number_or(key, became, (default, ROTARY))
    };
    let height = offset("delta_z_offset", "the height of the arms' axes above the bed", "290.700")?;
    let flange = offset("delta_ee_offs", "taken from the height", "15.000")?;
    let tool = offset("delta_tool_offset", "taken from the height", "30.500")?;
    let height = difference(&height, &tool).and_then(|height| difference(&height, &flange));
    let height = height.ok_or_else(|| settings.bad("delta_z_offset", "a length"))?;
    let text = format!("({}-{})/(2*sqrt(3))", base.text, platform.text);
    let radius = Exact::parse(&text, 10_000).map(|value| Number { text, value });
    let radius = radius.map_err(|_| settings.bad("delta_f", "a length"))?;
    let mirrored = settings.text("delta_mirror_xy", "whether x and y are mirrored");
    let mirrored = mirrored.ok_or_else(|| settings.refused(UNSAID))?;
    let mirrored = file::is_true(&mirrored.value);
    let stand = if mirrored { ["90", "210", "330"] } else { ["270", "30", "150"] };
    let mut legs = Vec::new();
    for (label, degrees) in ["alpha", "beta", "gamma"].into_iter().zip(stand) {
        let leg = Number::parse(degrees).and_then(|degrees| {
            let leg = Arm {
                label,
                degrees: &degrees,
                radius: &radius,
                height: &height.text,
                upper: &arm.text,
                lower: &rod.text,
                foot: None,
                downwards: true,
            };
            leg.leg()
        });
        legs.push(leg.ok_or_else(|| settings.bad("delta_f", "a length"))?);
    }
    let legs = <[String; 3]>::try_from(legs).map_err(|_| settings.missing("delta_f"))?;
    let workspace = match soft_endstops(settings)? {
        Some(workspace) => workspace,
        None => {
            settings.note(
                "The workspace: without soft endstops in x, y and z the firmware enforces none; the \
                 disc of half the arms' length at z = 0 is a guess to be changed.",
            );
            cylinder(&format!("{}/2", arm.text), ["0", "0"])
        }
    };
    settings.note("The arms' ranges: the firmware knows of none but where it homes.");
    let requirements = factors_per_radian(&arm);
    Ok(Machine {
        title: "Rotary Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace,
        requirements,
    })
}
