//! `kinematics: rotary_delta`, after klippy/kinematics/rotary_delta.py and
//! klippy/chelper/kin_rotary_delta.c.

use super::file::key;
use super::{angles, of_steppers, volume, ENDSTOP, PRINTER, STEPPERS};
use crate::import::settings::Settings;
use crate::import::toml::{factors_per_radian, greatest, least, less};
use crate::import::toml::{Arm, Machine, Number};
use crate::import::ImportError;

const SOURCE: &str = "klippy/kinematics/rotary_delta.py";

pub(super) fn machine(settings: &mut Settings) -> Result<Machine, ImportError> {
    let radius = key(PRINTER, "shoulder_radius");
    let radius = settings.required(&radius, "the shoulders' distance from the axis")?;
    let height = settings.required(&key(PRINTER, "shoulder_height"), "the shoulders' height")?;
    let upper = of_steppers(settings, "upper_arm_length", "an arm's length", SOURCE)?;
    let lower = of_steppers(settings, "lower_arm_length", "a rod's length", SOURCE)?;
    let angles = angles(settings, ["30", "150", "270"], SOURCE)?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let arm = Arm {
            label: &format!("{}, at {} degrees", STEPPERS[i], angles[i].text),
            degrees: &angles[i],
            radius: &radius,
            height: &height.text,
            upper: &upper[i].text,
            lower: &lower[i].text,
            foot: None,
            downwards: false,
        };
        let turn = || settings.bad(&key(STEPPERS[i], "angle"), "degrees within a turn");
        *leg = arm.leg().ok_or_else(turn)?;
    }
    let workspace = workspace(settings, [&radius, &height], &upper, &lower)?;
    settings.note(
        "The arms' ranges: the firmware bounds z and the radius, not the arms' angles; it has one \
         endstop for each, at the top.",
    );
    settings.note(
        "The workspace above the height at which the firmware narrows it to a cone: a design has \
         cylinders, no cones.",
    );
    let requirements = factors_per_radian(&upper[0]);
    Ok(Machine {
        title: "Rotary Delta",
        kind: "translational",
        unit: Some("mm"),
        legs: legs.into(),
        workspace,
        requirements,
    })
}

/// The cylinder of the full radius, `RotaryDeltaKinematics.check_move`.
fn workspace(
    settings: &mut Settings,
    [radius, height]: [&Number; 2],
    upper: &[Number; 3],
    lower: &[Number; 3],
) -> Result<String, ImportError> {
    let nothing = "leaves no workspace that can be told from none";
    let r = &radius.text;
    let mut radii: Vec<String> = upper.iter().map(|arm| format!("{r}+{}", arm.text)).collect();
    radii.extend(lower.iter().map(|rod| format!("{}-{r}", rod.text)));
    let (full, value) = least(&radii).ok_or_else(|| settings.refused(nothing))?;
    if value.sign() != Some(1) {
        return Err(settings.refused("shoulder_radius leaves the lower arms no radius to print in"));
    }
    let ends = of_steppers(settings, "position_endstop", ENDSTOP, SOURCE)?;
    let lower_ends: Vec<String> = ends.iter().map(|end| end.text.clone()).collect();
    let (top, _) = least(&lower_ends).ok_or_else(|| settings.refused(nothing))?;
    let mut cones = Vec::new();
    for i in 0..3 {
        if !less(&ends[i].text, &height.text) {
            let endstop = key(STEPPERS[i], "position_endstop");
            return Err(settings.bad(&endstop, "a height below shoulder_height"));
        }
        let elbow = elbow(r, &height.text, [&upper[i], &lower[i]], &ends[i]);
        cones.push(format!("{elbow}-{}", lower[i].text));
    }
    let (cone, value) = least(&cones).ok_or_else(|| settings.refused(nothing))?;
    if value.sign().is_none() {
        return Err(settings.refused("an endstop is where its arm does not reach"));
    }
    // Above the cone's foot the radius is the distance below the top.
    let (high, _) =
        greatest(&[cone, format!("{top}-({full})")]).ok_or_else(|| settings.refused(nothing))?;
    volume(settings, SOURCE, &full, &high)
}

/// The height of an elbow with the platform on the axis at the endstop's height: the outer one of
/// the points at `upper` from the shoulder and `lower` from the platform.
fn elbow(radius: &str, height: &str, [upper, lower]: [&Number; 2], end: &Number) -> String {
    let (a, l) = (&upper.text, &lower.text);
    // With d = (-radius, end - height) from the shoulder to the platform, both elbows are
    // k d +- t (-d_y, d_x), k = (d^2 + a^2 - l^2) / (2 d^2), t^2 = a^2/d^2 - k^2.
    let y = format!("({}-{height})", end.text);
    let square = format!("({radius}*{radius}+{y}*{y})");
    let k = format!("({square}+{a}*{a}-{l}*{l})/(2*{square})");
    // The outer one has the greater x, for d_y < 0.
    format!("{height}+{k}*{y}-{radius}*sqrt({a}*{a}/{square}-({k})*({k}))")
}
