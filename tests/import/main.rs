//! Configurations of motion controllers, imported: what the designs say, and what is refused.
//! The inputs in tests/import are written after the public documentation of both formats.

use orthocert::design::Design;
use orthocert::import::{klipper, linuxcnc, ImportError, Imported};
use orthocert::sample::{Place, Sampler};
use orthocert_checker::claim::{Claim, Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use std::path::Path;

fn file(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import");
    std::fs::read_to_string(folder.join(name)).expect("an input")
}

/// The claim of an imported design, whose lines are short and which repeats what is not in it.
fn claim(imported: &Imported) -> MachineClaim {
    let text = &imported.design;
    let design = Design::parse(text, "imported.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    let comments: String = text.lines().take_while(|line| line.starts_with('#')).collect();
    let squeezed = |s: &str| s.replace(['#', ' '], "");
    for sentence in &imported.not_carried_over {
        assert!(squeezed(&comments).contains(&squeezed(sentence)), "{sentence}\n{text}");
    }
    match design.claim {
        Claim::Machine(claim) => claim,
        _ => panic!("not about a machine"),
    }
}

fn legs(claim: &MachineClaim) -> &[Leg; 3] {
    match &claim.mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Orthoglide { .. } => panic!("an Orthoglide"),
    }
}

fn number(text: &str) -> Exact {
    Exact::parse(text, 1000).expect("a number")
}

fn exactly(text: &str) -> Quantity {
    Quantity::exactly(number(text))
}

/// The joint coordinates at the middle of a workspace that is one point.
fn joints_at(claim: &MachineClaim, point: [&str; 3]) -> [f64; 3] {
    let mut claim = claim.clone();
    let point = point.map(number);
    claim.workspace = Workspace::Box { min: point.clone(), max: point };
    let model = Model::new(&claim, 192).expect("a model");
    let unit = match legs(&claim)[0].is_angular() {
        true => 1.0,
        false => (model.unit_exponent.expect("a unit") as f64).exp2(),
    };
    let sampler = Sampler::new(&claim, &model).expect("a sampler");
    let place = Place { u: [0.5; 3], t: vec![0.5; sampler.parameters()] };
    sampler.at(&place).reached.expect("within reach").rho.map(|rho| rho * unit)
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn a_linear_delta_of_klipper() {
    let imported = klipper(&file("klipper-delta.cfg"), "klipper-delta.cfg").unwrap();
    let claim = claim(&imported);
    // Towers at 210, 330 and 90 degrees.
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[0] else { panic!("{claim:?}") };
    assert_eq!(anchor[0], exactly("-174.75*sqrt(3)/2"));
    assert_eq!((&anchor[1], length), (&exactly("-174.75/2"), &exactly("333")));
    let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("174.75")));
    let Workspace::Cylinder { radius, z, .. } = &claim.workspace else { panic!("{claim:?}") };
    assert_eq!(*radius, number("80"));
    assert_eq!(z[0], number("-2"));
    assert_eq!(z[1], number("297.05+sqrt(333.0*333.0-174.75*174.75)-333.0"));
    let ranges = claim.requirements.joint_range.as_ref().expect("ranges");
    let top = number("297.05+sqrt(333.0*333.0-174.75*174.75)");
    assert!(ranges.iter().all(|range| range.max == Some(top.clone())));
    // The carriages are above the platform: z + sqrt(L^2 - distance^2).
    let at = (333.0f64.powi(2) - 174.75f64.powi(2)).sqrt();
    near(joints_at(&claim, ["0", "0", "7"]), [at + 7.0; 3]);
    let told = imported.not_carried_over.join("\n");
    assert!(told.contains("macros.cfg") && told.contains("transmission factors"), "{told}");
}

#[test]
fn calibrated_angles_become_enclosures() {
    let text = file("klipper-delta-calibrated.cfg");
    let claim = claim(&klipper(&text, "calibrated.cfg").unwrap());
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[0] else { panic!("{claim:?}") };
    assert!(!anchor[0].is_exact() && !anchor[1].is_exact());
    assert_eq!(*length, exactly("333.12"));
    let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("174.812345")));
    let angle = 209.87321f64.to_radians();
    let (x, y) = (174.812345 * angle.cos(), 174.812345 * angle.sin());
    let at = (333.12f64.powi(2) - (10.0 - x).powi(2) - (20.0 - y).powi(2)).sqrt();
    let found = joints_at(&claim, ["10", "20", "0"]);
    assert!((found[0] - at).abs() < 1e-6, "{found:?} {at}");
}

#[test]
fn a_rotary_delta_of_klipper() {
    let text = file("klipper-rotary-delta.cfg");
    let claim = claim(&klipper(&text, "rotary.cfg").unwrap());
    let Leg::Arm { anchor, arm, length, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("-33.9")));
    assert_eq!((&anchor[2], arm, length), (&exactly("412.9"), &exactly("170"), &exactly("320")));
    // The elbow is outside: 33.9 + 170 cos(theta) from the axis, 412.9 + 170 sin(theta) high.
    for theta in joints_at(&claim, ["0", "0", "100"]) {
        let (out, up) =
            (33.9 + 170.0 * theta.to_radians().cos(), 412.9 + 170.0 * theta.to_radians().sin());
        assert!(((up - 100.0).hypot(out) - 320.0).abs() < 1e-6 && out > 33.9, "{theta}");
    }
}

#[test]
fn a_linear_delta_of_linuxcnc() {
    let (ini, hal) = (file("lineardelta.ini"), file("lineardelta.hal"));
    for texts in [[ini.as_str(), hal.as_str()], [hal.as_str(), ini.as_str()]] {
        let claim = claim(&linuxcnc(&texts, "lineardelta.ini").unwrap());
        let Leg::Slider { anchor, length, .. } = &legs(&claim)[1] else { panic!("{claim:?}") };
        // 120 degrees clockwise of (0, R).
        assert_eq!(anchor[0], exactly("130.5*sqrt(3)/2"));
        assert_eq!((&anchor[1], length), (&exactly("-130.5/2"), &exactly("269.5")));
        let corner = |x: &str, y: &str, z: &str| [number(x), number(y), number(z)];
        let (min, max) = (corner("-50", "-50", "0"), corner("50", "50", "100"));
        assert_eq!(claim.workspace, Workspace::Box { min, max });
        assert!(claim.requirements.joint_range.is_some());
    }
}

#[test]
fn a_rotary_delta_of_linuxcnc() {
    let imported = linuxcnc(&[&file("rotarydelta.hal")], "rotarydelta.hal").unwrap();
    let told = imported.not_carried_over.join("\n");
    assert!(told.contains("footradius is not set: 6.0 is LinuxCNC's default"), "{told}");
    let claim = claim(&imported);
    let at = joints_at(&claim, ["1", "2", "-12"]);
    near(at, [-22.0438537870017, -44.36188342791985, -35.032998436194845]);
}

#[test]
fn what_cannot_be_imported_is_refused() {
    let text = file("klipper-delta.cfg");
    for (from, to, told) in [
        ("kinematics: delta", "kinematics: corexy", "found kinematics \"corexy\""),
        ("kinematics: delta", "", "[printer] kinematics: not set"),
        ("delta_radius: 174.75", "", "[printer] delta_radius: not set"),
        ("delta_radius: 174.75", "delta_radius: wide", "found \"wide\""),
        ("delta_radius: 174.75", "delta_radius: -1", "greater than 0"),
        ("delta_radius: 174.75", "delta_radius: 400", "less than the arms' length"),
        ("arm_length: 333.0", "", "[stepper_a] arm_length: not set"),
        ("arm_length: 333.0", "angle: 999.5\narm_length: 333", "degrees"),
        ("rotation_distance = 40", "nothing", "found neither"),
    ] {
        let error = klipper(&text.replace(from, to), "printer.cfg").expect_err(to).to_string();
        assert!(error.starts_with("printer.cfg") && error.contains(told), "{error}");
    }
    let ini = file("lineardelta.ini");
    let alone = ini.replace("HALCMD = setp", "#");
    let error = linuxcnc(&[&alone], "machine.ini").unwrap_err();
    assert!(matches!(error, ImportError::Missing { .. }), "{error}");
    assert!(error.to_string().contains("lineardelta.hal"), "{error}");
    let error = linuxcnc(&[&file("lineardelta.hal")], "machine.hal").unwrap_err();
    assert!(error.to_string().contains("[DELTA]ROD"), "{error}");
    let error = linuxcnc(&["loadrt trivkins"], "machine.hal").unwrap_err();
    assert!(error.to_string().contains("\"trivkins\""), "{error}");
    let error = linuxcnc(&["setp lineardeltakins.R no"], "machine.hal").unwrap_err();
    assert!(error.to_string().contains("\"no\""), "{error}");
}

#[test]
fn no_configuration_makes_an_importer_panic() {
    for name in ["klipper-delta.cfg", "klipper-rotary-delta.cfg", "lineardelta.ini"] {
        let text = file(name);
        for (at, c) in text.char_indices() {
            for new in ["", "\n", "[", "]", "=", "-", "#", "\u{0}", "±"] {
                let text = format!("{}{new}{}", &text[..at], &text[at + c.len_utf8()..]);
                let _ = klipper(&text, name);
                let _ = linuxcnc(&[&text], name);
            }
        }
    }
}
