//! `genhexkins`: six struts between points of the base and of the platform.
//!
//! ```text
//! rho_i = |P + R platform_i - base_i|       R = R_z(C) R_y(B) R_x(A)
//! ```
//!
//! The spindle's and the tool's offset are added to the heights of the points on both. With the lead of a screw
//! the length that is commanded also depends on how the joints turn: no strut of a design.

use super::hal::Hal;
use super::machine::{axes, joint_range, limits, pin, workspace};
use crate::import::settings::Settings;
use crate::import::toml::{cylinder, less, quoted, Machine, Number};
use crate::import::{ImportError, Setting};

const SOURCE: &str = "src/emc/kinematics/genhexkins.c";
const HEADER: &str = "src/emc/kinematics/genhexkins.h";

const BASE: [[&str; 3]; 6] = [
    ["-22.950", "13.250", "0.000"],
    ["22.950", "13.250", "0.000"],
    ["22.950", "13.250", "0.000"],
    ["0.000", "-26.500", "0.000"],
    ["0.000", "-26.500", "0.000"],
    ["-22.950", "13.250", "0.000"],
];
const PLATFORM: [[&str; 3]; 6] = [
    ["-1.000", "11.500", "0.000"],
    ["1.000", "11.500", "0.000"],
    ["10.459", "-4.884", "0.000"],
    ["9.459", "-6.616", "0.000"],
    ["-9.459", "-6.616", "0.000"],
    ["-10.459", "-4.884", "0.000"],
];

/// The machine of the module that `named` loads.
pub(super) fn hexapod(
    settings: &mut Settings,
    hal: &mut Hal,
    named: &Setting,
) -> Result<Machine, ImportError> {
    let alone = |word: &str| word.eq_ignore_ascii_case("coordinates=xyzabc");
    if !named.value.split_whitespace().skip(1).all(alone) {
        let expected = "genhexkins, alone or with coordinates=xyzabc";
        return Err(settings.bad("[KINS]KINEMATICS", expected));
    }
    let lead = pin(settings, hal, "genhexkins.screw-lead", "no correction", ("0.0", HEADER))?;
    if lead.value.sign() != Some(0) {
        let expected =
            "0: with the lead of a screw the lengths also depend on how the joints turn \
                        (base-n, platform-n), which no strut of a design does";
        return Err(settings.bad("genhexkins.screw-lead", expected));
    }
    let mut offset = |name: &str| {
        let became = "added to the heights of all joints";
        pin(settings, hal, &format!("genhexkins.{name}"), became, ("0.0", SOURCE))
    };
    let offsets = [offset("spindle-offset")?, offset("tool-offset")?];
    let (mut legs, mut across) = (Vec::new(), Vec::new());
    for (i, (base, platform)) in BASE.iter().zip(&PLATFORM).enumerate() {
        let mut point = |end: &str, became, defaults: &[&str; 3]| {
            let mut coordinate = |k: usize| {
                let name = format!("genhexkins.{end}.{i}.{}", ["x", "y", "z"][k]);
                pin(settings, hal, &name, became, (defaults[k], HEADER))
            };
            Ok([coordinate(0)?, coordinate(1)?, coordinate(2)?])
        };
        let base = point("base", "where a strut stands", base)?;
        let platform = point("platform", "where a strut ends", platform)?;
        let size = |x: &Number| x.text.trim_start_matches('-').to_owned();
        across.extend(base[..2].iter().filter(|x| x.value.sign() != Some(0)).map(size));
        let shown =
            |[x, y, z]: &[Number; 3]| format!("[{}, {}, {}]", x.text, y.text, raised(z, &offsets));
        legs.push(format!(
            "[[mechanism.legs]]                 # joint {i}\ndrive = \"strut\"\nanchor = {}\n\
             platform = {}\n",
            shown(&base),
            shown(&platform)
        ));
    }
    if across.is_empty() {
        return Err(settings.refused("all struts of genhexkins stand on one line"));
    }
    let axes = axes(settings)?;
    let sum = across.join("+");
    let height = format!("({sum})/12");
    let guess = cylinder(&format!("({sum})/60"), [&height, &height]);
    let points = workspace(settings, axes.as_ref(), guess);
    let (orientation, is_narrow) = orientation(settings)?;
    settings.note("Other kinematics than that of switchkins-type 0: they are no hexapod's.");
    let ranges = joint_range(settings, 6, false)?;
    let requirements = match (is_narrow, ranges.is_empty()) {
        (true, _) => format!("one_to_one = true\n{ranges}"),
        (false, false) => ranges,
        (false, true) => "joint_range = { min = 0 }\n".to_owned(),
    };
    let workspace = format!("{points}{orientation}");
    Ok(Machine { title: "Hexapod", kind: "spatial", unit: None, legs, workspace, requirements })
}

/// A height with what is added to it.
pub(super) fn raised(z: &Number, offsets: &[Number]) -> String {
    let added = offsets.iter().filter(|offset| offset.value.sign() != Some(0));
    let added: String = added.map(|offset| format!("+({})", offset.text)).collect();
    if added.is_empty() {
        z.text.clone()
    } else {
        quoted(&format!("{}{added}", z.text))
    }
}

/// The limits of A, B and C, or a guess; and whether any two differ by less than half a turn.
fn orientation(settings: &mut Settings) -> Result<(String, bool), ImportError> {
    let all = limits(settings, ["AXIS_A", "AXIS_B", "AXIS_C"])?;
    let within = |[min, max]: &[Number; 2], most: &str| {
        less(&format!("-{most}"), &min.text) && less(&max.text, most)
    };
    match all {
        Some([a, b, c]) if [&a, &b, &c].into_iter().all(|x| within(x, "180")) => {
            let span = |[min, max]: &[Number; 2]| format!("({})-({})", max.text, min.text);
            let turned = format!("{}+{}", span(&a), span(&c));
            let range = |[min, max]: &[Number; 2]| format!("[{}, {}]", min.text, max.text);
            let [roll, pitch, yaw] = [&a, &b, &c].map(range);
            let text = format!("orientation = {{ roll = {roll}, pitch = {pitch}, yaw = {yaw} }}\n");
            Ok((text, within(&b, "90") && less(&turned, "180")))
        }
        _ => {
            settings.note(
                "The orientations: MIN_LIMIT and MAX_LIMIT of AXIS_A, AXIS_B and AXIS_C are not all \
                 given between -180 and 180 degrees; what is below is a guess to be changed.",
            );
            Ok(("orientation = { angle = 15 }\n".to_owned(), true))
        }
    }
}
