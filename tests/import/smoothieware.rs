//! Smoothieware's configurations: what is read of them, and the designs against its kinematics.

use crate::configurations::{compare, sections, Compared, Figures, Towers};
use crate::oracle::{same_joints, Firmware};
use crate::support::{claim, exactly, file, files, ignoring, import, legs, number};
use crate::support::{Leg, Workspace};
use orthocert::import::{smoothieware, ImportError, Imported};
use std::collections::BTreeMap;

/// `LinearDeltaSolution::actuator_to_cartesian`, without its rounding.
fn actuator_to_cartesian(towers: &Towers, actuators: [f64; 3]) -> [f64; 3] {
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [t1, t2, t3] = [0, 1, 2].map(|i| [towers.at[i][0], towers.at[i][1], actuators[i]]);
    let (s12, s23, s13) = (sub(t1, t2), sub(t2, t3), sub(t1, t3));
    let normal = [
        s12[1] * s23[2] - s12[2] * s23[1],
        s12[2] * s23[0] - s12[0] * s23[2],
        s12[0] * s23[1] - s12[1] * s23[0],
    ];
    let (m12, m23, m13) = (dot(s12, s12), dot(s23, s23), dot(s13, s13));
    let inv_nmag_sq = 1.0 / dot(normal, normal);
    let q = 0.5 * inv_nmag_sq;
    let a = q * m23 * dot(s12, s13);
    let b = -q * m13 * dot(s12, s23);
    let c = q * m12 * dot(s13, s23);
    let r_sq = 0.5 * q * m12 * m23 * m13;
    let dist = (inv_nmag_sq * (towers.rod2[0] - r_sq)).sqrt();
    std::array::from_fn(|k| t1[k] * a + t2[k] * b + t3[k] * c - normal[k] * dist)
}

/// RotaryDeltaSolution.cpp.
struct Rotary {
    e: f64,
    f: f64,
    re: f64,
    rf: f64,
    z_calc_offset: f64,
    mirrored: bool,
}

impl Rotary {
    /// `delta_calcAngleYZ`.
    fn angle(&self, [x0, y0, z0]: [f64; 3]) -> f64 {
        let tan30 = 1.0 / 3f64.sqrt();
        let y1 = -0.5 * tan30 * self.f;
        let y0 = y0 - 0.5 * tan30 * self.e;
        let a = (x0 * x0 + y0 * y0 + z0 * z0 + self.rf * self.rf - self.re * self.re - y1 * y1)
            / (2.0 * z0);
        let b = (y1 - y0) / z0;
        let d = -(a + b * y1) * (a + b * y1) + self.rf * (b * b * self.rf + self.rf);
        let yj = (y1 - a * b - d.sqrt()) / (b * b + 1.0);
        let zj = a + b * yj;
        (-zj / (y1 - yj)).atan().to_degrees() + if yj > y1 { 180.0 } else { 0.0 }
    }
}

impl Firmware for Rotary {
    /// `cartesian_to_actuator`.
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let (x0, y0) = if self.mirrored { (-x, -y) } else { (x, y) };
        let z0 = z + self.z_calc_offset;
        let (sin120, cos120) = (0.75f64.sqrt(), -0.5);
        let joints = [
            self.angle([x0, y0, z0]),
            self.angle([x0 * cos120 + y0 * sin120, y0 * cos120 - x0 * sin120, z0]),
            self.angle([x0 * cos120 - y0 * sin120, y0 * cos120 + x0 * sin120, z0]),
        ];
        Some(joints).filter(|joints| joints.iter().all(|joint| joint.is_finite()))
    }

    /// `delta_calcForward`.
    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        let (sin30, tan60) = (0.5, 3f64.sqrt());
        let t = (self.f - self.e) / 3f64.sqrt() / 2.0;
        let [a1, a2, a3] = joints.map(f64::to_radians);
        let (y1, z1) = (-(t + self.rf * a1.cos()), -self.rf * a1.sin());
        let (y2, z2) = ((t + self.rf * a2.cos()) * sin30, -self.rf * a2.sin());
        let (y3, z3) = ((t + self.rf * a3.cos()) * sin30, -self.rf * a3.sin());
        let (x2, x3) = (y2 * tan60, -y3 * tan60);
        let dnm = (y2 - y1) * x3 - (y3 - y1) * x2;
        let w1 = y1 * y1 + z1 * z1;
        let w2 = x2 * x2 + y2 * y2 + z2 * z2;
        let w3 = x3 * x3 + y3 * y3 + z3 * z3;
        let p1 = (z2 - z1) * (y3 - y1) - (z3 - z1) * (y2 - y1);
        let q1 = -((w2 - w1) * (y3 - y1) - (w3 - w1) * (y2 - y1)) / 2.0;
        let p2 = -(z2 - z1) * x3 + (z3 - z1) * x2;
        let q2 = ((w2 - w1) * x3 - (w3 - w1) * x2) / 2.0;
        let a = p1 * p1 + p2 * p2 + dnm * dnm;
        let b = 2.0 * (p1 * q1 + p2 * (q2 - y1 * dnm) - z1 * dnm * dnm);
        let c = (q2 - y1 * dnm).powi(2) + q1 * q1 + dnm * dnm * (z1 * z1 - self.re * self.re);
        let z = -0.5 * (b + (b * b - 4.0 * a * c).sqrt()) / a;
        let (x, y) = ((p1 * z + q1) / dnm, (p2 * z + q2) / dnm);
        let (x, y) = if self.mirrored { (-x, -y) } else { (x, y) };
        Some([x, y, z - self.z_calc_offset]).filter(|p| p.iter().all(|x| x.is_finite()))
    }
}

/// The last value of each key, and of each saved parameter.
fn settings(figures: &Figures<'_>) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for (name, text) in &figures.files {
        for line in text.lines() {
            let mut words = line.split(' ');
            let key = words.next().unwrap_or_default();
            for word in words {
                match *name {
                    "config" => found.insert(key.to_owned(), word.to_owned()),
                    _ => found.insert(format!("{key} {}", &word[..1]), word[1..].to_owned()),
                };
            }
        }
    }
    found
}

fn firmware(figures: &Figures<'_>) -> Box<dyn Firmware> {
    let found = settings(figures);
    let of = |saved: &str, key: &str, default: f64| {
        let value = found.get(saved).or_else(|| found.get(key));
        value.map_or(default, |value| value.parse().unwrap())
    };
    if found["arm_solution"] == "rotary_delta" {
        let height = of("M665 E", "delta_z_offset", 290.7);
        let below = of("M665 I", "delta_ee_offs", 15.0) + of("M665 H", "delta_tool_offset", 30.5);
        return Box::new(Rotary {
            e: of("M665 A", "delta_e", 131.636),
            f: of("M665 B", "delta_f", 190.526),
            re: of("M665 C", "delta_re", 270.0),
            rf: of("M665 D", "delta_rf", 90.0),
            z_calc_offset: -(height - below),
            mirrored: found["delta_mirror_xy"] == "true",
        });
    }
    let rod = of("M665 L", "arm_length", 250.0);
    let radius = of("M665 R", "arm_radius", 124.0);
    let tower = |i: usize| {
        let key = |what: &str| format!("delta_tower{}_{what}", i + 1);
        let further = of(["M665 A", "M665 B", "M665 C"][i], &key("offset"), 0.0);
        let turned = of(["M665 D", "M665 E", "M665 H"][i], &key("angle"), 0.0);
        let angle = ([210.0, 330.0, 90.0][i] + turned).to_radians();
        [(radius + further) * angle.cos(), (radius + further) * angle.sin()]
    };
    let at = [tower(0), tower(1), tower(2)];
    let trim = |i: usize| of(["M665 I", "M665 J", "M665 K"][i], &format!("arm{}_trim", i + 1), 0.0);
    let rod2 = [0, 1, 2].map(|i| (rod + trim(i)).powi(2));
    Box::new(Towers { at, rod2, forward: actuator_to_cartesian })
}

#[test]
fn configurations_are_smoothiewares() {
    let mut compared = Compared::default();
    let text = file("smoothieware.txt");
    for figures in sections(&text) {
        compare(smoothieware, &figures, &*firmware(&figures), &mut compared);
    }
    println!("{compared:?}");
    assert!(compared.configurations >= 13);
}

const PLAIN: &str =
    "arm_solution linear_delta\narm_length 250.0 # hinge to hinge\narm_radius 124.0\n";

fn text(text: &str) -> Result<Imported, ImportError> {
    import(smoothieware, &[("config", text)])
}

#[test]
fn settings_are_read_as_the_firmware_reads_them() {
    for config in [
        PLAIN.to_owned(),
        format!("#arm_radius 1\n{PLAIN}#arm_radius 2\n"),
        format!("arm_radius 1\n{PLAIN}"),
        PLAIN.replace("arm_radius 124.0", "  arm_radius\t124.0#1"),
        PLAIN.replace("linear_delta", "kossel").replace("arm_length 250.0", ""),
        PLAIN.replace('\n', "\r\n"),
        format!("{PLAIN}alpha_trim 0\ndelta_current 1.5\nzprobe.enable false\n"),
    ] {
        let claim = claim(&text(&config).unwrap_or_else(|error| panic!("{config}: {error}")));
        let Leg::Slider { anchor, length, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
        assert_eq!((&anchor[1], length), (&exactly("124"), &exactly("250")), "{config}");
    }
    let imported = text("arm_solution rotary_delta\ndelta_mirror_xy false\n").unwrap();
    let told: Vec<String> = imported.defaults.iter().map(ToString::to_string).collect();
    let expected =
        "delta_e = 131.636, after src/modules/robot/arm_solutions/RotaryDeltaSolution.cpp";
    assert!(told.iter().any(|line| line == expected), "{told:?}");
}

#[test]
fn what_is_included_and_saved_is_read() {
    let config = format!("{PLAIN}include more.config\n");
    let more = ("more.config", "arm_radius 130\n");
    let saved = ("config-override", "M665 R140.5 Z200.000\nM666 X0 Y-1 Z0\nM92 E140\n");
    let radius = |files: &[(&str, &str)]| {
        let claim = claim(&import(smoothieware, files).unwrap());
        let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
        anchor[1].clone()
    };
    assert_eq!(radius(&[("config", &config), more]), exactly("130"));
    assert_eq!(radius(&[("config", &config), more, saved]), exactly("140.5"));
    let error = text(&config).unwrap_err().to_string();
    assert!(error.contains("include = more.config: not understood"), "{error}");
    let disk = files(&[("config", PLAIN), more]);
    let error = ignoring(smoothieware, &disk, &["config", "more.config"], &[]).unwrap_err();
    assert!(error.to_string().contains("is not included"), "{error}");
}

#[test]
fn soft_endstops_and_endstops_bound_the_workspace() {
    let soft = "soft_endstop.enable true\nsoft_endstop.x_min -50\nsoft_endstop.x_max 50\n\
                soft_endstop.y_min -60\nsoft_endstop.y_max 60\nsoft_endstop.z_min 0\n\
                soft_endstop.z_max 100\n";
    let claim_of = |text: &str| claim(&import(smoothieware, &[("config", text)]).unwrap());
    let corner = |x: &str, y: &str, z: &str| [number(x), number(y), number(z)];
    let (min, max) = (corner("-50", "-60", "0"), corner("50", "60", "100"));
    assert_eq!(claim_of(&format!("{PLAIN}{soft}")).workspace, Workspace::Box { min, max });
    let homing = "endstops_enable true\ndelta_homing true\ngamma_homing_direction home_to_max\n\
                  gamma_max 300\nbeta_trim_mm 1.5\n";
    let Workspace::Cylinder { radius, z, .. } = &claim_of(&format!("{PLAIN}{homing}")).workspace
    else {
        panic!("no cylinder")
    };
    assert_eq!(*radius, number("124.0/2"));
    let top =
        "300+(0)+sqrt(250.0*250.0-124*124)-(1.5)-sqrt(250.0*250.0-(124-(124.0/2))*(124-(124.0/2)))";
    assert_eq!(*z, [number("0"), number(top)]);
    let partly = format!("{PLAIN}soft_endstop.enable true\nsoft_endstop.x_max 50\n");
    let error = text(&partly).unwrap_err().to_string();
    assert!(error.contains("soft_endstop.x_max = 50: not understood"), "{error}");
}

/// By `cartesian_to_actuator_offs` of LinearDeltaSolution.cpp: at its rod's length and its trim from the platform.
#[test]
fn rods_have_lengths_of_their_own() {
    let trimmed = format!("{PLAIN}arm1_trim 2.5\narm2_trim -1.0\narm3_trim 7\n");
    for (config, saved) in [
        (trimmed.replace("arm3_trim 7", "arm3_trim 0.75"), ""),
        (trimmed, "M665 L250.0 R124.0 A0 B0 C0 D0 E0 H0 I2.5 J-1.0 K0.75\n"),
    ] {
        let claim = claim(
            &import(smoothieware, &[("config", &config), ("config-override", saved)]).unwrap(),
        );
        let lengths = legs(&claim).iter().map(|leg| match leg {
            Leg::Slider { length, .. } => length.clone(),
            other => panic!("{other:?}"),
        });
        let expected = ["252.5", "249", "250.75"].map(exactly);
        assert_eq!(lengths.collect::<Vec<_>>(), expected, "{config} {saved}");
    }
    // What `LinearDeltaSolution::set_optional` makes of corrections that it does not find depends on its revision.
    let config = format!("{PLAIN}arm2_trim 2.5\n");
    let saved = "M665 L250.0 R124.0 A0 B0 C0 D0.3 E0 H0\n";
    let mixed = import(smoothieware, &[("config", &config), ("config-override", saved)]);
    let told = "config-override:1: M665 = no J, where arm2_trim is set: not understood";
    assert!(mixed.unwrap_err().to_string().contains(told));
}

#[test]
fn a_rotary_delta_has_its_arms() {
    for mirrored in [false, true] {
        let config = format!(
            "arm_solution rotary_delta\ndelta_e 120.5\ndelta_f 200\ndelta_re 280\ndelta_rf 95\n\
             delta_z_offset 280.5\ndelta_ee_offs 10\ndelta_tool_offset 20.25\ndelta_mirror_xy {mirrored}\n"
        );
        let saved = "M665 A121.5 B201 C281 D96 E281.5 I11 H21.25\n";
        let imported = import(smoothieware, &[("config", &config), ("config-override", saved)]);
        let claim = claim(&imported.unwrap());
        let firmware =
            Rotary { e: 121.5, f: 201.0, re: 281.0, rf: 96.0, z_calc_offset: -249.25, mirrored };
        assert_eq!(same_joints("config", &claim, &firmware, 300), 300);
    }
}

#[test]
fn what_cannot_be_imported_is_refused() {
    for (line, told) in [
        ("arm_solution cartesian", "found kinematics \"cartesian\""),
        ("arm_length long", "arm_length: found \"long\""),
        ("arm_length -1", "greater than 0"),
        ("arm_radius 251", "less than the rods' length"),
        ("delta_tower1_angle 500", "less than the rods' length"),
        ("delta_tower4_offset 1", "delta_tower4_offset = 1: not understood"),
        ("arm_width 3", "arm_width = 3: not understood"),
        ("arm1_trim -250", "rods longer than 0"),
        ("arm_solution rotary_delta", "delta_mirror_xy is not set"),
        ("alpha_trim -1", "alpha_trim = -1: not understood"),
    ] {
        let error = text(&format!("{PLAIN}{line}\n")).expect_err(line).to_string();
        assert!(error.contains(told), "{line}: {error}");
    }
    let long = format!("{PLAIN}arm_radius {}124.5\n", " ".repeat(115));
    let error = text(&long).unwrap_err().to_string();
    assert!(error.contains("arm_radius = 124"), "{error}");
    let disk = files(&[("config", PLAIN), ("config-override", "M665 Q3\n")]);
    let error = ignoring(smoothieware, &disk, &["config"], &[]).unwrap_err().to_string();
    assert!(error.contains("config-override:1: M665 Q = 3: not understood"), "{error}");
}

#[test]
fn no_configuration_makes_the_importer_panic() {
    let config =
        format!("{PLAIN}endstops_enable true\ndelta_homing true\ngamma_max 30\ninclude b\n");
    let saved = "M665 L250 R124 A0.1 Z200\nM666 X1\nM206 Z1\n";
    let both = [config.as_str(), saved];
    for (which, text) in both.into_iter().enumerate() {
        for (at, c) in text.char_indices() {
            for new in ["", "\n", "#", " ", "\t", ".", "-", "9", "M", "\"", "{", "\u{0}", "±"] {
                let mutant = format!("{}{new}{}", &text[..at], &text[at + c.len_utf8()..]);
                let mut texts = both;
                texts[which] = &mutant;
                let _ =
                    import(smoothieware, &[("config", texts[0]), ("config-override", texts[1])]);
            }
        }
    }
}
