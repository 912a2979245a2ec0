//! Klipper's configurations: what is read of them, and the designs against klippy's kinematics.

use crate::oracle::{
    same_as_compiled, same_extremes, same_joints, Extremes, Firmware, Random, Region,
};
use crate::support::{claim, exactly, file, files, folder, ignoring, import, legs, number};
use crate::support::{Leg, Workspace};
use orthocert::import::{klipper, Disk, ImportError, Imported};
use std::path::PathBuf;

/// A configuration on the disk, with what it includes.
fn on_disk(name: &str) -> Result<Imported, ImportError> {
    klipper(&Disk, &[folder().join("klipper").join(name)], &[])
}

/// A configuration in memory.
fn text(text: &str) -> Result<Imported, ImportError> {
    import(klipper, &[("printer.cfg", text)])
}

fn delta() -> String {
    file("klipper/delta.cfg").replace("[include macros.cfg]", "")
}

/// klippy/mathutil.py, `trilateration`: the lower of the two points with these distances.
fn trilateration(centers: [[f64; 3]; 3], radius2: [f64; 3]) -> Option<[f64; 3]> {
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let scaled = |a: [f64; 3], s: f64| a.map(|x| x * s);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let [c1, c2, c3] = centers;
    let (s21, s31) = (sub(c2, c1), sub(c3, c1));
    let d = dot(s21, s21).sqrt();
    let ex = scaled(s21, 1.0 / d);
    let i = dot(ex, s31);
    let vect_ey = sub(s31, scaled(ex, i));
    let ey = scaled(vect_ey, 1.0 / dot(vect_ey, vect_ey).sqrt());
    let ez = cross(ex, ey);
    let j = dot(ey, s31);
    let x = (radius2[0] - radius2[1] + d * d) / (2.0 * d);
    let y = (radius2[0] - radius2[2] - x * x + (x - i) * (x - i) + j * j) / (2.0 * j);
    let z = -(radius2[0] - x * x - y * y).sqrt();
    let at = |k: usize| c1[k] + ex[k] * x + ey[k] * y + ez[k] * z;
    Some([at(0), at(1), at(2)]).filter(|p| p.iter().all(|x| x.is_finite()))
}

/// klippy/chelper/kin_delta.c, `delta_stepper_calc_position`, and klippy/kinematics/delta.py,
/// `_actuator_to_cartesian` and `check_move`.
struct Linear {
    radius: f64,
    arms: [f64; 3],
    angles: [f64; 3],
    volume: Volume,
}

/// What `check_move` bounds.
#[derive(Clone, Copy, Default)]
struct Volume {
    max_xy: f64,
    limit_z: f64,
    min_z: f64,
    max_z: f64,
}

impl Linear {
    fn towers(&self) -> [[f64; 2]; 3] {
        self.angles
            .map(|a| [a.to_radians().cos() * self.radius, a.to_radians().sin() * self.radius])
    }
}

fn reached(joints: [f64; 3]) -> Option<[f64; 3]> {
    Some(joints).filter(|joints| joints.iter().all(|x| x.is_finite()))
}

impl Firmware for Linear {
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let towers = self.towers();
        reached(std::array::from_fn(|i| {
            let (dx, dy) = (towers[i][0] - x, towers[i][1] - y);
            (self.arms[i] * self.arms[i] - dx * dx - dy * dy).sqrt() + z
        }))
    }

    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        let towers = self.towers();
        let centers = std::array::from_fn(|i| [towers[i][0], towers[i][1], joints[i]]);
        trilateration(centers, self.arms.map(|arm| arm * arm))
    }

    fn allows(&self, [x, y, z]: [f64; 3]) -> bool {
        let Volume { max_xy, limit_z, min_z, max_z } = self.volume;
        let min_arm = self.arms.iter().copied().fold(f64::INFINITY, f64::min);
        let mut limit = max_xy * max_xy;
        if z > limit_z {
            let above = z - limit_z;
            let allowed = self.radius - (min_arm * min_arm - (min_arm - above).powi(2)).sqrt();
            limit = limit.min(allowed * allowed);
        }
        x * x + y * y <= limit && z >= min_z && z <= max_z
    }
}

/// klippy/chelper/kin_rotary_delta.c, `rotary_two_arm_calc`, and
/// klippy/kinematics/rotary_delta.py, `elbow_coord`, `actuator_to_cartesian`, `check_move`.
struct Rotary {
    radius: f64,
    height: f64,
    upper: [f64; 3],
    lower: [f64; 3],
    angles: [f64; 3],
    volume: Volume,
}

impl Firmware for Rotary {
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        reached(std::array::from_fn(|i| {
            let (sin, cos) = self.angles[i].to_radians().sin_cos();
            let sjz = y * cos - x * sin;
            let dx = x * cos + y * sin - self.radius;
            let dy = z - self.height;
            let upper2 = self.upper[i] * self.upper[i];
            let lower2 = self.lower[i] * self.lower[i] - sjz * sjz;
            let c1 = 0.5 / dy * (dx * dx + dy * dy + upper2 - lower2);
            let c2 = dx / dy;
            let scale = c2 * c2 + 1.0;
            let elbow_x = c1 * c2 + (scale * upper2 - c1 * c1).sqrt();
            let elbow_y = c1 * scale - c2 * elbow_x;
            elbow_y.atan2(elbow_x).to_degrees()
        }))
    }

    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        let elbows = std::array::from_fn(|i| {
            let (sin, cos) = joints[i].to_radians().sin_cos();
            let (out, up) = (self.upper[i] * cos + self.radius, self.upper[i] * sin + self.height);
            let angle = self.angles[i].to_radians();
            [out * angle.cos(), out * angle.sin(), up]
        });
        trilateration(elbows, self.lower.map(|arm| arm * arm))
    }

    fn allows(&self, [x, y, z]: [f64; 3]) -> bool {
        let Volume { max_xy, limit_z, min_z, max_z } = self.volume;
        let mut limit = max_xy * max_xy;
        if z > limit_z {
            limit = limit.min((max_z - z).powi(2));
        }
        x * x + y * y <= limit && z >= min_z && z <= max_z
    }
}

/// The figures of figures.txt, as klippy itself reads the configuration beside it: the file, then by
/// name `radius`, `arms`, `angles`, ... and what `check_move` bounds.
fn firmware(line: &str) -> (String, Box<dyn Firmware>) {
    let mut words = line.split_whitespace();
    let name = words.next().expect("a name").to_owned();
    let kind = words.next().expect("a kind");
    let numbers: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
    let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
    let volume = |at: usize| Volume {
        max_xy: numbers[at],
        limit_z: numbers[at + 1],
        min_z: numbers[at + 2],
        max_z: numbers[at + 3],
    };
    let firmware: Box<dyn Firmware> = match kind {
        "delta" => Box::new(Linear {
            radius: numbers[0],
            arms: three(1),
            angles: three(4),
            volume: volume(7),
        }),
        _ => Box::new(Rotary {
            radius: numbers[0],
            height: numbers[1],
            upper: three(2),
            lower: three(5),
            angles: three(8),
            volume: volume(11),
        }),
    };
    (name, firmware)
}

/// That the imported cylinder is what the firmware allows, and no larger one is.
fn the_volume_is_the_firmwares(name: &str, region: &Region, firmware: &dyn Firmware) {
    let (radius, [low, high]) = region.cylinder();
    let at = |r: f64, z: f64, turn: f64| [r * turn.cos(), r * turn.sin(), z];
    let inside = 1.0 - 1e-9;
    let (up, down) = (high - (high - low) * 1e-9, low + (high - low) * 1e-9);
    let mut random = Random(7);
    for _ in 0..200 {
        let [r, z, turn] = random.three();
        let point = at(radius * inside * r.sqrt(), low + (high - low) * z, turn * 6.3);
        assert!(firmware.allows(point), "{name} {point:?}");
    }
    assert!(firmware.allows(at(radius * inside, up, 1.0)), "{name}");
    assert!(firmware.allows(at(radius * inside, down, 1.0)), "{name}");
    assert!(!firmware.allows(at(radius * (1.0 + 1e-6), (low + high) / 2.0, 1.0)), "{name}");
    assert!(!firmware.allows(at(radius * inside, high + (high - low) * 1e-6, 1.0)), "{name}");
    assert!(!firmware.allows(at(0.0, low - (high - low) * 1e-6, 1.0)), "{name}");
}

/// The restated kinematics against klippy's own.
#[test]
fn the_restated_kinematics_is_the_firmwares() {
    let (reference, volume) = (file("klipper/reference.txt"), Volume::default());
    let mut lines = 0;
    for line in reference.lines().filter(|line| !line.starts_with('#')) {
        let (kind, numbers) = line.split_once(' ').expect("a kind");
        let numbers: Vec<f64> = numbers.split(' ').map(|word| word.parse().unwrap()).collect();
        let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
        let (firmware, at): (Box<dyn Firmware>, usize) = match kind {
            "delta" => {
                let (radius, arms, angles) = (numbers[0], three(1), three(4));
                (Box::new(Linear { radius, arms, angles, volume }), 7)
            }
            _ => {
                let (radius, height) = (numbers[0], numbers[1]);
                let (upper, lower, angles) = (three(2), three(5), three(8));
                (Box::new(Rotary { radius, height, upper, lower, angles, volume }), 11)
            }
        };
        same_as_compiled(line, &*firmware, [three(at), three(at + 3), three(at + 6)]);
        lines += 1;
    }
    assert_eq!(lines, 80);
}

/// Those whose extremes are enclosed in every run. Of the others three are not enclosed within the
/// budget: both rotary Deltas, whose rim is where the determinant of `M` vanishes, and the Rostock.
const ENCLOSED: [&str; 6] = [
    "example-delta.cfg",
    "printer-anet-a4-2018.cfg",
    "aieie78-1.cfg",
    "greg-35170-1.cfg",
    "razorcopter-1.cfg",
    "eeichhorn-1.cfg",
];

/// Every configuration beside figures.txt; the extremes of a few, and of all of them where
/// `ORTHOCERT_ALL` is set.
#[test]
fn real_configurations_are_the_firmwares_machines() {
    let all = std::env::var_os("ORTHOCERT_ALL").is_some();
    let figures = file("klipper/figures.txt");
    let lines: Vec<&str> = figures.lines().filter(|line| !line.starts_with('#')).collect();
    let mut points = 0;
    for line in &lines {
        let (name, firmware) = firmware(line);
        let imported = on_disk(&name).unwrap_or_else(|e| panic!("{name}: {e}"));
        let claim = claim(&imported);
        points += same_joints(&name, &claim, &*firmware, 100);
        the_volume_is_the_firmwares(&name, &Region::of(&claim), &*firmware);
        if all || ENCLOSED.contains(&name.as_str()) {
            let told = same_extremes(&name, &claim, &*firmware);
            println!("{name}: {told:?}");
            assert!(all || told == Extremes::Agree, "{name}: {told:?}");
        }
    }
    println!("{} configurations, {points} points within reach", lines.len());
}

#[test]
fn a_linear_delta() {
    let imported = on_disk("delta.cfg").unwrap();
    let claim = claim(&imported);
    // Towers at 210, 330 and 90 degrees.
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[0] else { panic!("{claim:?}") };
    assert_eq!(anchor[0], exactly("-174.75*sqrt(3)/2"));
    assert_eq!((&anchor[1], length), (&exactly("-174.75/2"), &exactly("333.0")));
    let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("174.75")));
    let Workspace::Cylinder { radius, z, .. } = &claim.workspace else { panic!("{claim:?}") };
    assert_eq!((radius, &z[0]), (&number("80"), &number("-2")));
    // Where the cone of the tower feet reaches the print radius.
    let top = "297.05+sqrt(333.0*333.0-174.75*174.75)-333.0+333.0\
               -sqrt(333.0*333.0-(174.75-(80))*(174.75-(80)))";
    assert_eq!(z[1], number(top));
    assert!(claim.joint_ranges().is_empty());
    let keys: Vec<&str> = imported.used.iter().map(|used| used.setting.key.as_str()).collect();
    assert!(keys.contains(&"[printer] delta_radius"), "{keys:?}");
    let taken: Vec<String> = imported.defaults.iter().map(ToString::to_string).collect();
    assert!(
        taken.contains(&"[stepper_b] arm_length = 333.0, after klippy/kinematics/delta.py".into()),
        "{taken:?}"
    );
    let told = imported.not_carried_over.join("\n");
    assert!(told.contains("transmission factors") && told.contains("cone"), "{told}");
}

#[test]
fn the_body_comes_before_what_calibration_saved() {
    let claim = claim(&on_disk("calibrated.cfg").unwrap());
    // Both have delta_radius and stepper_a's arm_length; the body counts.
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("174.75")));
    assert_eq!(*length, exactly("333.01"));
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[0] else { panic!("{claim:?}") };
    assert_eq!(*length, exactly("333.0"));
    // The angle is in the block alone, and has no exact cosine.
    assert!(!anchor[0].is_exact() && !anchor[1].is_exact());
    let (x, y) =
        (174.75 * 209.87321f64.to_radians().cos(), 174.75 * 209.87321f64.to_radians().sin());
    let mid = |q: &crate::support::Quantity| {
        q.min.as_rational().map(|r| {
            use num_traits::ToPrimitive;
            r.to_f64().unwrap_or(f64::NAN)
        })
    };
    assert!(
        (mid(&anchor[0]).unwrap() - x).abs() < 1e-9 && (mid(&anchor[1]).unwrap() - y).abs() < 1e-9
    );
}

#[test]
fn a_block_that_was_edited_is_skipped_as_the_firmware_does() {
    let text_of = file("klipper/calibrated.cfg");
    let edited = text_of.replace("#*# [stepper_b]", "\n#*# [stepper_b]");
    let imported = text(&edited).unwrap();
    assert!(imported.not_carried_over.iter().any(|note| note.contains("SAVE_CONFIG")));
    let claim = claim(&imported);
    let Leg::Slider { length, .. } = &legs(&claim)[1] else { panic!("no slider") };
    assert_eq!(*length, exactly("333.0"));
}

#[test]
fn includes_are_read_in_their_place() {
    let body = delta();
    let late = format!("{body}\n[include parts/*.cfg]\n");
    let early = format!("[include parts/*.cfg]\n{body}");
    let parts = [
        ("parts/a.cfg", "[printer]\ndelta_radius = 150 ; a\n"),
        ("parts/b.cfg", "[printer]\ndelta_radius: 151.5\n[include deep/c.cfg]\n"),
        ("parts/deep/c.cfg", "[fan]\npin: PA1\n"),
        ("parts/.hidden.cfg", "[printer]\ndelta_radius: 1\n"),
    ];
    for (main, radius) in [(&late, "151.5"), (&early, "174.75")] {
        let mut texts = vec![("printer.cfg", main.as_str())];
        texts.extend(parts);
        let imported = import(klipper, &texts).unwrap();
        let claim = claim(&imported);
        let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("no slider") };
        assert_eq!(anchor[1], exactly(radius));
        assert_eq!(imported.files.len(), 4);
    }
    let refused = |texts: &[(&str, &str)]| import(klipper, texts).unwrap_err().to_string();
    let error = refused(&[("printer.cfg", &format!("[include gone.cfg]\n{body}"))]);
    assert!(error.starts_with("gone.cfg: cannot be read"), "{error}");
    let circle = [("printer.cfg", "[include a.cfg]\n"), ("a.cfg", "[include printer.cfg]\n")];
    let error = refused(&circle);
    assert!(error.contains("includes itself"), "{error}");
    // None is fine for a pattern.
    assert!(text(&format!("[include none/*.cfg]\n{body}")).is_ok());
    // Two dozen levels that double would be sixteen million files.
    let names: Vec<String> = (0..24).map(|i| format!("{i}.cfg")).collect();
    let doubling: Vec<String> =
        (1..25).map(|i| format!("[include {i}.cfg]\n[include {i}.cfg]\n")).collect();
    let mut texts: Vec<(&str, &str)> =
        names.iter().zip(&doubling).map(|(a, b)| (a.as_str(), b.as_str())).collect();
    texts.push(("24.cfg", ""));
    let error = refused(&texts);
    assert!(error.contains("1 MiB"), "{error}");
}

#[test]
fn lines_are_read_as_configparser_reads_them() {
    let body = delta();
    for (from, to, radius) in [
        ("delta_radius: 174.75", "delta_radius: 150#mm", "150"),
        ("delta_radius: 174.75", "DELTA_RADIUS = 150 ; mm", "150"),
        ("delta_radius: 174.75", "delta_radius: 1\ndelta_radius: 150", "150"),
        ("delta_radius: 174.75", "delta_radius:\n  150", "150"),
        ("delta_radius: 174.75", "delta_radius: 150\n[printer] ; again\nmax_accel: 1", "150"),
        ("delta_radius: 174.75", "delta_radius: 0150.", "150"),
    ] {
        let imported = text(&body.replace(from, to)).unwrap_or_else(|e| panic!("{to}: {e}"));
        let claim = claim(&imported);
        let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("no slider") };
        assert_eq!(anchor[1], exactly(radius), "{to}");
    }
    // A whole file may be indented, if every setting is alike.
    let indented: String =
        body.lines().filter(|line| !line.is_empty()).map(|line| format!("  {line}\n")).collect();
    assert!(text(&indented).is_ok());
    // The firmware refuses a byte order mark, and settings before any section.
    assert!(text(&format!("\u{feff}[mcu]\n{body}")).is_err());
    assert!(text(&format!("a: 1\n{body}")).is_err());
}

#[test]
fn a_rotary_delta() {
    let claim = claim(&on_disk("rotary-delta.cfg").unwrap());
    let Leg::Arm { anchor, arm, length, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("-33.900")));
    assert_eq!((&anchor[2], arm, length), (&exactly("412.900"), &exactly("170"), &exactly("320")));
}

#[test]
fn what_may_matter_is_refused_by_file_line_and_key() {
    let body = delta();
    for (from, to, told) in [
        ("kinematics: delta", "kinematics: corexy", "found kinematics \"corexy\""),
        ("kinematics: delta", "", "[printer] kinematics: not set"),
        ("delta_radius: 174.75", "", "[printer] delta_radius: not set"),
        ("delta_radius: 174.75", "delta_radius: wide", "found \"wide\""),
        ("delta_radius: 174.75", "delta_radius: 170+4.75", "found \"170+4.75\""),
        ("delta_radius: 174.75", "delta_radius: -1", "greater than 0"),
        ("delta_radius: 174.75", "delta_radius: 400", "greater than 400"),
        ("arm_length: 333.0", "", "[stepper_a] arm_length: not set"),
        ("arm_length: 333.0", "angle: 999.5\narm_length: 333", "degrees"),
        ("position_endstop: 297.05", "", "[stepper_a] position_endstop: not set"),
        ("position_endstop: 297.05", "position_endstop: 1", "narrowed its volume"),
        ("print_radius: 80", "print_radius: 80\ndelta_offset: 3", "[printer] delta_offset = 3"),
        ("print_radius: 80", "print_radius: 80\n[DEFAULT]\narm_length: 3", "[DEFAULT] arm_length"),
        ("print_radius: 80", "print_radius: 80\n[stepper_A]\narm_length: 3", "[stepper_A] arm_len"),
        ("step_pin: PL3", "trim: 0.2", "[stepper_c] trim = 0.2"),
        ("microsteps: 16\nendstop_pin", "endstop_pin", "[stepper_a] microsteps: not set; it is the length of a step, in the workspace's radius"),
        ("endstop_pin: PE4", "endstop_pin: probe:z_virtual_endstop", "endstop_pin"),
        ("rotation_distance = 40", "nothing", "would not read"),
        ("rotation_distance = 40", "", "[stepper_c] rotation_distance: not set"),
    ] {
        assert!(body.contains(from), "{from}");
        let error = text(&body.replace(from, to)).expect_err(to).to_string();
        assert!(error.starts_with("printer.cfg") && error.contains(told), "{error}");
    }
    let more = body.replace("step_pin: PL3", "step_pin: PL3\ntrim: 0.2");
    let error = text(&more).unwrap_err();
    let ImportError::NotUnderstood { line, .. } = &error else { panic!("{error}") };
    assert_eq!(more.lines().nth(line - 1), Some("trim: 0.2"));
    let files = files(&[("printer.cfg", &more)]);
    let named = ["printer.cfg"];
    let imported = ignoring(klipper, &files, &named, &["[stepper_c] trim"]).unwrap();
    assert!(imported.design.contains("[stepper_c] trim = 0.2"), "{}", imported.design);
    let error = ignoring(klipper, &files, &named, &["[stepper_c] trim", "nothing"]).unwrap_err();
    assert!(error.to_string().contains("\"nothing\""), "{error}");
    let error = klipper(&files, &[PathBuf::from("a"), PathBuf::from("b")], &[]).unwrap_err();
    assert!(error.to_string().contains("one printer.cfg"), "{error}");
}
