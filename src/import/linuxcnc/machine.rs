//! The machines of src/emc/kinematics, from the pins of their modules.

use super::hal::{Hal, MODULES};
use super::hexapod::hexapod;
use super::pentapod::pentapod;
use crate::import::settings::Settings;
use crate::import::toml::{
    cylinder, factors_per_radian, less, polar, slider, strut, Arm, Machine, Number, FACTORS,
};
use crate::import::ImportError;

const LINEAR: &str = "src/emc/kinematics/lineardeltakins-common.h";
const ROTARY: &str = "src/emc/kinematics/rotarydeltakins-common.h";
const TRIPOD: &str = "src/emc/kinematics/tripodkins.c";

/// The machine whose module is named in [KINS], or loaded.
pub(super) fn machine(settings: &mut Settings, hal: &mut Hal) -> Result<Machine, ImportError> {
    let named = settings.text("[KINS]KINEMATICS", "the kind of machine");
    let named = named.or_else(|| hal.modules.last().cloned());
    let named = named.ok_or_else(|| settings.missing("[KINS]KINEMATICS"))?;
    let module = named.value.split_whitespace().next().unwrap_or_default();
    let other = |found: &str| ImportError::OtherMachine {
        file: named.file.clone(),
        found: found.to_owned(),
        expected: "lineardeltakins, rotarydeltakins, tripodkins, genhexkins, pentakins",
    };
    let Some(module) = MODULES.into_iter().find(|known| *known == module) else {
        return Err(other(module));
    };
    if let Some(loaded) = hal.modules.iter().find(|loaded| loaded.value != module) {
        return Err(other(&format!("{module} and {}", loaded.value)));
    }
    let unit = settings.text("[TRAJ]LINEAR_UNITS", "the unit of all lengths");
    if let Some(unit) = &unit {
        settings.note(format!("The unit of length: the design is in the file's, {}.", unit.value));
    }
    // As emcIniFile.cc names them, in either case.
    let unit = unit.and_then(|unit| match unit.value.to_ascii_lowercase().as_str() {
        "mm" | "metric" => Some("mm"),
        "in" | "inch" | "imperial" => Some("in"),
        _ => None,
    });
    let machine = match module {
        "lineardeltakins" => linear_delta(settings, hal),
        "rotarydeltakins" => rotary_delta(settings, hal),
        "genhexkins" => hexapod(settings, hal, &named),
        "pentakins" => pentapod(settings, hal),
        _ => tripod(settings, hal),
    };
    machine.map(|machine| Machine { unit, ..machine })
}

/// A pin's value; where nothing sets it, the module's default.
pub(super) fn pin(
    settings: &mut Settings,
    hal: &mut Hal,
    name: &str,
    became: &str,
    default: (&str, &'static str),
) -> Result<Number, ImportError> {
    match hal.pin(name) {
        Ok(Some(setting)) => settings.set(setting),
        Ok(None) => {}
        Err(link) => {
            return Err(ImportError::BadValue {
                file: link.file,
                line: link.line,
                setting: link.key,
                found: link.value,
                expected: "a signal that setp, before, or sets, afterwards, gives a value"
                    .to_owned(),
            });
        }
    }
    hal.not_understood.extend(hal.strangers(name));
    settings.number_or(name, became, default)
}

/// A length, greater than 0.
fn length(
    settings: &mut Settings,
    hal: &mut Hal,
    name: &str,
    became: &str,
    default: (&str, &'static str),
) -> Result<Number, ImportError> {
    let number = pin(settings, hal, name, became, default)?;
    match number.is_positive() {
        true => Ok(number),
        false => Err(settings.bad(name, "a decimal number greater than 0")),
    }
}

/// `MIN_LIMIT` and `MAX_LIMIT` of these sections, if all are given.
pub(super) fn limits<const N: usize>(
    settings: &mut Settings,
    sections: [&str; N],
) -> Result<Option<[[Number; 2]; N]>, ImportError> {
    let keys = sections.map(|section| ["MIN", "MAX"].map(|end| format!("[{section}]{end}_LIMIT")));
    if keys.iter().flatten().any(|key| settings.peek(key).is_none()) {
        return Ok(None);
    }
    let mut all = Vec::new();
    for [min, max] in &keys {
        let mut limit = |key| settings.number(key, "an end of the workspace");
        all.extend(limit(min)?.zip(limit(max)?).map(|(min, max)| [min, max]));
    }
    Ok(all.try_into().ok())
}

/// The box of the axes' limits, if all are given.
pub(super) fn axes(settings: &mut Settings) -> Result<Option<[[Number; 2]; 3]>, ImportError> {
    limits(settings, ["AXIS_X", "AXIS_Y", "AXIS_Z"])
}

/// The workspace: the box of the axes' limits, or a guess.
pub(super) fn workspace(
    settings: &mut Settings,
    axes: Option<&[[Number; 2]; 3]>,
    guess: String,
) -> String {
    let Some(axes) = axes else {
        settings.note(
            "The workspace: MIN_LIMIT and MAX_LIMIT of AXIS_X, AXIS_Y and AXIS_Z are not all given \
             (what is, is left out), and the firmware has no bounds then; what is below is a guess to be changed.",
        );
        return guess;
    };
    settings
        .note("The workspace is the box of the axes' limits, all of which need not be in reach.");
    let corner = |end: usize| axes.each_ref().map(|axis| axis[end].text.clone()).join(", ");
    format!("min = [{}]\nmax = [{}]\n", corner(0), corner(1))
}

/// The joints' limits that are given: of arms both ends or none.
pub(super) fn joint_range(
    settings: &mut Settings,
    joints: usize,
    is_of_arms: bool,
) -> Result<String, ImportError> {
    let (mut ranges, mut without) = (String::new(), Vec::new());
    for joint in 0..joints {
        let (mut ends, mut other) = (Vec::new(), None);
        for end in ["min", "max"] {
            let key = format!("[JOINT_{joint}]{}_LIMIT", end.to_uppercase());
            match settings.number(&key, "an end of a joint's range")? {
                Some(number) => ends.push(format!("{end} = {}", number.text)),
                None => other = Some(key),
            }
        }
        if let (1, true, Some(other)) = (ends.len(), is_of_arms, &other) {
            return Err(settings.lacks(other, "the other end of an arm's range"));
        }
        match other {
            None => {}
            Some(_) if ends.is_empty() => without.push(format!("JOINT_{joint}")),
            Some(other) => {
                settings.note(format!("The joints' ranges: no {other}: that end is open."))
            }
        }
        ranges.push_str(&format!("  {{ {} }},\n", ends.join(", ")).replace("{  }", "{}"));
    }
    if !without.is_empty() {
        let names = without.join(", ");
        settings.note(format!("The joints' ranges: no MIN_LIMIT and MAX_LIMIT of {names}."));
    }
    let is_given = without.len() < joints;
    Ok(if is_given { format!("joint_range = [\n{ranges}]\n") } else { String::new() })
}

fn linear_delta(settings: &mut Settings, hal: &mut Hal) -> Result<Machine, ImportError> {
    let became = "the towers' distance from the axis";
    let radius = length(settings, hal, "lineardeltakins.R", became, ("130.25", LINEAR))?;
    let rod = length(settings, hal, "lineardeltakins.L", "the legs' length", ("269.0", LINEAR))?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let foot = polar(&Number::whole([90, 210, 330][i]), Some(&radius));
        let foot = foot.ok_or_else(|| settings.missing("angle"))?;
        *leg = slider(&format!("joint {i}"), &foot, "0", &rod.text);
    }
    let axes = axes(settings)?;
    let guess = cylinder(&format!("{}/2", radius.text), ["0", "0"]);
    let workspace = workspace(settings, axes.as_ref(), guess);
    let requirements = format!("{FACTORS}{}", joint_range(settings, 3, false)?);
    Ok(Machine {
        title: "Linear Delta",
        kind: "translational",
        unit: None,
        legs: legs.into(),
        workspace,
        requirements,
    })
}

fn rotary_delta(settings: &mut Settings, hal: &mut Hal) -> Result<Machine, ImportError> {
    let mut pin = |name: &str, became, default| {
        length(settings, hal, &format!("rotarydeltakins.{name}"), became, (default, ROTARY))
    };
    let hip = pin("platformradius", "the hips' distance from the axis", "10.0")?;
    let thigh = pin("thighlength", "the arms' length", "10.0")?;
    let shin = pin("shinlength", "the rods' length", "14.0")?;
    let foot = pin("footradius", "the feet's distance from the controlled point", "6.0")?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let arm = Arm {
            label: &format!("joint {i}"),
            degrees: &Number::whole([270, 30, 150][i]),
            radius: &hip,
            height: "0",
            upper: &thigh.text,
            lower: &shin.text,
            foot: Some(&foot),
            downwards: true,
        };
        *leg = arm.leg().ok_or_else(|| settings.missing("angle"))?;
    }
    let axes = axes(settings)?;
    if let Some([_, _, [_, top]]) = &axes {
        if !less(&top.text, "0") {
            return Err(settings.bad(
                "[AXIS_Z]MAX_LIMIT",
                "a height below 0, the hips' plane, in which rotarydeltakins divides by zero",
            ));
        }
    }
    let low = format!("-{}", shin.text);
    let guess = cylinder(&format!("{}/4", thigh.text), [&low, &low]);
    let workspace = workspace(settings, axes.as_ref(), guess);
    let requirements = format!("{}{}", factors_per_radian(&thigh), joint_range(settings, 3, true)?);
    Ok(Machine {
        title: "Rotary Delta",
        kind: "translational",
        unit: None,
        legs: legs.into(),
        workspace,
        requirements,
    })
}

fn tripod(settings: &mut Settings, hal: &mut Hal) -> Result<Machine, ImportError> {
    let mut pin = |name: &str, became| {
        pin(settings, hal, &format!("tripodkins.{name}"), became, ("1.0", TRIPOD))
    };
    let b_x = pin("Bx", "where the second strut stands")?;
    let c_x = pin("Cx", "where the third strut stands")?;
    let c_y = pin("Cy", "where the third strut stands")?;
    for (name, coordinate) in [("tripodkins.Bx", &b_x), ("tripodkins.Cy", &c_y)] {
        if coordinate.value.sign() == Some(0) {
            return Err(settings.bad(name, "a coordinate other than 0"));
        }
    }
    let legs = [
        strut("joint 0", "0", "0"),
        strut("joint 1", &b_x.text, "0"),
        strut("joint 2", &c_x.text, &c_y.text),
    ];
    let axes = axes(settings)?;
    let at = [&b_x.text, &c_x.text, &c_y.text].map(|text| text.trim_start_matches('-'));
    let high = format!("({}+{}+{})/2", at[0], at[1], at[2]);
    let guess = cylinder(&format!("{}/10", at[2]), [&high, &high]);
    let workspace = workspace(settings, axes.as_ref(), guess);
    let requirements = format!("{FACTORS}{}", joint_range(settings, 3, false)?);
    Ok(Machine {
        title: "Tripod",
        kind: "translational",
        unit: None,
        legs: legs.into(),
        workspace,
        requirements,
    })
}
