//! RepRapFirmware: `config.g`, with the `config-override.g` and the macros that it calls.
//!
//! The towers of a linear Delta are those of `LinearDeltaKinematics::Recalc`, at 210, 330 and 90
//! degrees and their corrections; a carriage is at most at its homed height, to which
//! `LimitPosition` holds every move. The arms of a rotary Delta are those of
//! `RotaryDeltaKinematics::Transform`, at the same angles; theirs count upwards. Coordinates are the
//! machine's: offsets of tools and of the workplace move the user's, not the limits.

mod script;

use super::files::{Files, Reading};
use super::settings::Settings;
use super::toml::{cylinder, factors_per_radian, Arm, Machine, Number, FACTORS};
use super::towers::{highest, legs, sum, Tower, TOWERS};
use super::{ImportError, Imported, Setting};
use crate::exact::Exact;
use script::{Kinematics, Script};
use std::cmp::Ordering;
use std::path::PathBuf;

/// The firmware's files with the defaults.
const LINEAR: &str = "src/Movement/Kinematics/LinearDeltaKinematics.h";
const ROTARY: &str = "src/Movement/Kinematics/RotaryDeltaKinematics.h";
const LIMITS: &str = "src/Config/Configuration.h";

/// The design that RepRapFirmware's `config.g` describes. What it calls is looked for among the
/// other paths, then beside it.
///
/// # Errors
/// If a file cannot be read, or is not called; if the commands make no linear or rotary Delta, or
/// one that a design cannot express; if they set what is not understood and not in `ignore`.
pub fn reprap(
    files: &dyn Files,
    paths: &[PathBuf],
    ignore: &[String],
) -> Result<Imported, ImportError> {
    let expected = "config.g, and files that it calls";
    let first = paths.first().ok_or(ImportError::Files { found: 0, expected })?;
    let mut reading = Reading::new(files, first);
    let mut settings = Settings::new(reading.shown(first));
    let mut script = Script::new(&mut reading, &mut settings, paths);
    script.run(first, 0)?;
    let kinematics = script.finished(first)?;
    let machine = match kinematics {
        Kinematics::Linear => linear(&mut settings)?,
        Kinematics::Rotary => rotary(&mut settings)?,
    };
    settings.note(
        "Offsets: the workspace is in the machine's coordinates, without those of tools (G10), of \
         the workplace (G10 L2, M206) and of bed compensation (G29).",
    );
    let harmless = |setting: &Setting| {
        matches!(
            (setting.key.as_str(), kinematics),
            ("M669 S" | "M669 T" | "M669 K", _)
                | ("M208 Z max", Kinematics::Linear)
                | ("M666 X" | "M666 Y" | "M666 Z", Kinematics::Rotary)
        )
    };
    settings.finish(&machine, harmless, ignore, reading)
}

const CORRECTION: &str = "added to the tower's angle";

/// Where tower `i` stands.
fn degrees(
    settings: &mut Settings,
    code: &str,
    i: usize,
    source: &'static str,
) -> Result<Number, ImportError> {
    let key = format!("{code} {}", ["X", "Y", "Z"][i]);
    let correction = settings.number_or(&key, CORRECTION, ("0", source))?;
    let base = Number::parse(TOWERS[i].1);
    base.and_then(|base| sum(&base, &correction)).ok_or_else(|| settings.bad(&key, "degrees"))
}

/// The numbers of `L1:2:3`, or of one that stands for three.
fn three(
    settings: &mut Settings,
    key: &str,
    became: &str,
    default: (&str, &'static str),
) -> Result<Vec<Number>, ImportError> {
    let text = match settings.text(key, became) {
        Some(setting) => setting.value,
        None => settings.defaulted(key, default.0, default.1),
    };
    let numbers: Option<Vec<Number>> = text.split(':').map(Number::parse).collect();
    match numbers {
        Some(one) if one.len() == 1 => Ok(vec![one[0].clone(), one[0].clone(), one[0].clone()]),
        Some(three) if three.len() == 3 => Ok(three),
        _ => Err(settings.bad(key, "one decimal number, or three with colons between them")),
    }
}

fn linear(settings: &mut Settings) -> Result<Machine, ImportError> {
    for key in ["M666 A", "M666 B"] {
        let tilt = settings.number(key, "the bed's tilt")?;
        if tilt.is_some_and(|tilt| tilt.value.sign() != Some(0)) {
            return Err(settings.refused(format!(
                "{key} tilts the bed: carriages then move by more than the platform does, which \
                 no leg of a design expresses; accepted: a tilt of 0"
            )));
        }
    }
    let rods = three(settings, "M665 L", "the rods' lengths", ("215.0", LINEAR))?;
    let became = "the towers' distance from the centre";
    let radius = settings.positive_or("M665 R", became, ("105.6", LINEAR))?;
    let mut towers = Vec::new();
    for (i, rod) in rods.into_iter().enumerate() {
        let degrees = degrees(settings, "M665", i, LINEAR)?;
        towers.push(Tower { label: TOWERS[i].0, degrees, radius: radius.clone(), rod });
    }
    let reach = "a radius less than the rods' length, corrections within a turn";
    let legs = legs(&towers).ok_or_else(|| settings.bad("M665 R", reach))?;
    let print = settings.positive_or("M665 B", "the workspace's radius", ("80.0", LINEAR))?;
    let homed = "in the height at which a carriage is at its endstop";
    let height = settings.number_or("M665 H", homed, ("240.0", LINEAR))?;
    let mut tops = Vec::new();
    for (i, tower) in towers.iter().enumerate() {
        let key = format!("M666 {}", ["X", "Y", "Z"][i]);
        let adjusted = settings.number_or(&key, homed, ("0", LINEAR))?;
        tops.push(format!("{}+{}+({})", height.text, tower.centred(), adjusted.text));
    }
    let low = settings.number_or("M208 Z min", "the least height", ("0", LIMITS))?;
    let high = highest(&towers, &tops, &print).and_then(|high| {
        let value = Exact::parse(&high, 10_000).ok()?;
        (low.value.compare(&value)? == Ordering::Less).then_some(high)
    });
    let low_enough = "homed carriages above those of the full radius at the least height";
    let high = high.ok_or_else(|| settings.bad("M665 H", low_enough))?;
    settings.note(
        "The volume above the workspace: there the firmware lets the platform no nearer to a tower \
         than the carriage's endstop allows; a design has cylinders, no cones.",
    );
    settings.note("The carriages' lower ends: the firmware knows of none.");
    Ok(Machine {
        title: "Linear Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace: cylinder(&print.text, [&low.text, &high]),
        requirements: FACTORS.to_owned(),
    })
}

fn rotary(settings: &mut Settings) -> Result<Machine, ImportError> {
    let arms = three(settings, "M669 U", "the arms' lengths", ("100.0", ROTARY))?;
    let rods = three(settings, "M669 L", "the rods' lengths", ("200.0", ROTARY))?;
    let heights = three(settings, "M669 H", "the heights of the arms' axes", ("250.0", ROTARY))?;
    let became = "the distance of the arms' axes from the centre, less the platform's own";
    let radius = settings.positive_or("M669 R", became, ("50.0", ROTARY))?;
    let mut legs = Vec::new();
    for i in 0..3 {
        let degrees = degrees(settings, "M669", i, ROTARY)?;
        let positive = arms[i].is_positive() && rods[i].is_positive();
        let leg = Arm {
            label: TOWERS[i].0,
            degrees: &degrees,
            radius: &radius,
            height: &heights[i].text,
            upper: &arms[i].text,
            lower: &rods[i].text,
            foot: None,
            downwards: false,
        };
        let expected = "lengths greater than 0, corrections within a turn";
        let leg = leg.leg().filter(|_| positive);
        legs.push(leg.ok_or_else(|| settings.bad("M669 U", expected))?);
    }
    let legs = <[String; 3]>::try_from(legs).map_err(|_| settings.missing("M669 U"))?;
    let print = settings.positive_or("M669 B", "the workspace's radius", ("80.0", ROTARY))?;
    let low = settings.number_or("M208 Z min", "the least height", ("0", LIMITS))?;
    let high = settings.number_or("M208 Z max", "the greatest height", ("200", LIMITS))?;
    if low.value.compare(&high.value) == Some(Ordering::Greater) {
        return Err(settings.bad("M208 Z max", "a height above the least one"));
    }
    let range = match settings.text("M669 A", "the arms' range") {
        Some(setting) => {
            let ends: Option<Vec<Number>> = setting.value.split(':').map(Number::parse).collect();
            let ends = ends.filter(|ends| ends.len() == 2);
            let ends = ends.ok_or_else(|| settings.bad("M669 A", "two angles, least:greatest"))?;
            format!(
                "joint_range = {{ min = \"{}\", max = \"{}\" }} # degrees\n",
                ends[0].text, ends[1].text
            )
        }
        None => String::new(),
    };
    settings.note(
        "Arms beyond the vertical: the firmware takes the arc sine of an angle; for a platform that \
         asks for more than 90 degrees it turns the arm elsewhere.",
    );
    Ok(Machine {
        title: "Rotary Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace: cylinder(&print.text, [&low.text, &high.text]),
        requirements: format!("{}{range}", factors_per_radian(&arms[0])),
    })
}
