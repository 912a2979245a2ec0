//! RepRapFirmware's configurations: what is read of them, and the designs against its kinematics.

use crate::configurations::{compare, sections, Compared, Figures, Towers};
use crate::oracle::Firmware;
use crate::support::{claim, exactly, file, files, ignoring, import, legs, number};
use crate::support::{Leg, Workspace};
use orthocert::import::{reprap, ImportError, Imported};
use orthocert_kernel::claim::{Bound, Requirement};
use std::collections::BTreeMap;

/// `LinearDeltaKinematics::ForwardTransform`, without tilt.
fn forward_transform(towers: &Towers, [ha, hb, hc]: [f64; 3]) -> [f64; 3] {
    let [[ax, ay], [bx, by], [cx, cy]] = towers.at;
    let [da, db, dc] = towers.rod2;
    let (xbc, xca, xab) = (cx - bx, ax - cx, bx - ax);
    let (ybc, yca, yab) = (cy - by, ay - cy, by - ay);
    let q = (xab * cy + xca * by + xbc * ay) * 2.0;
    let [fa, fb, fc] = [ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy];
    let r = (xbc * ha + xca * hb + xab * hc) * 2.0;
    let u = (ybc * ha + yca * hb + yab * hc) * 2.0;
    let ka = (db - dc) + (fc - fb) + (hc * hc - hb * hb);
    let kb = (dc - da) + (fa - fc) + (ha * ha - hc * hc);
    let kc = (da - db) + (fb - fa) + (hb * hb - ha * ha);
    let s = ka * ay + kb * by + kc * cy;
    let t = ka * ax + kb * bx + kc * cx;
    let a = u * u + r * r + q * q;
    let minus_half_b = q * q * ha + q * (u * ax - r * ay) - (r * t + u * s);
    let c = (ax * q - s).powi(2) + (ay * q + t).powi(2) + (ha * ha - da) * q * q;
    let z = (minus_half_b - (minus_half_b * minus_half_b - a * c).sqrt()) / a;
    [(u * z + s) / q, -(r * z + t) / q, z]
}

/// A linear Delta of `M665`: `LinearDeltaKinematics::Recalc`.
struct Linear {
    towers: Towers,
    homed: [f64; 3],
    print_radius: f64,
    lowest: f64,
}

/// Each parameter's last value, by command and letter.
fn parameters(figures: &Figures<'_>) -> BTreeMap<(String, char), Vec<f64>> {
    let mut found = BTreeMap::new();
    for line in figures.files.iter().flat_map(|(_, text)| text.lines()) {
        let mut words = line.split(' ');
        let code = words.next().unwrap_or_default();
        let lower = code == "M208" && line.contains("S1");
        for word in words {
            let numbers: Option<Vec<f64>> =
                word[1..].split(':').map(|number| number.parse().ok()).collect();
            let code = if lower { "M208 S1" } else { code };
            if let (Some(letter), Some(numbers)) = (word.chars().next(), numbers) {
                found.insert((code.to_owned(), letter), numbers);
            }
        }
    }
    found
}

fn linear(found: &BTreeMap<(String, char), Vec<f64>>) -> Linear {
    let all = |code: &str, letter: char| found.get(&(code.to_owned(), letter)).cloned();
    let one = |code: &str, letter: char| all(code, letter).map_or(0.0, |numbers| numbers[0]);
    let rods = all("M665", 'L').unwrap();
    let rod = |i: usize| rods.get(i).copied().unwrap_or(rods[0]);
    let (radius, height) = (one("M665", 'R'), one("M665", 'H'));
    let [a, b, c] = ['X', 'Y', 'Z'].map(|letter| one("M665", letter));
    let [ra, rb, rc] = [30.0 + a, 30.0 - b, c].map(f64::to_radians);
    let at = [
        [-(radius * ra.cos()), -(radius * ra.sin())],
        [radius * rb.cos(), -(radius * rb.sin())],
        [-(radius * rc.sin()), radius * rc.cos()],
    ];
    let rod2 = [0, 1, 2].map(|i| rod(i) * rod(i));
    let adjusted = ['X', 'Y', 'Z'].map(|letter| one("M666", letter));
    let homed = [0, 1, 2].map(|i| height + (rod2[i] - radius * radius).sqrt() + adjusted[i]);
    Linear {
        towers: Towers { at, rod2, forward: forward_transform },
        homed,
        print_radius: one("M665", 'B'),
        lowest: one("M208 S1", 'Z'),
    }
}

/// A rotary Delta of `M669 K10`, in the firmware's defaults: `RotaryDeltaKinematics::Recalc`.
struct Rotary {
    radius: f64,
    arms: [f64; 3],
    rods: [f64; 3],
    heights: [f64; 3],
    angles: [f64; 3],
}

impl Firmware for Rotary {
    /// `RotaryDeltaKinematics::Transform`.
    fn joints(&self, [px, py, pz]: [f64; 3]) -> Option<[f64; 3]> {
        let joint = |i: usize| {
            let (sine, cosine) = self.angles[i].to_radians().sin_cos();
            let x = px * cosine + py * sine;
            let y = py * cosine - px * sine;
            let (r_minus_x, h_minus_z) = (self.radius - x, self.heights[i] - pz);
            let a = 2.0 * self.arms[i] * r_minus_x;
            let b = 2.0 * self.arms[i] * h_minus_z;
            let c = self.rods[i].powi(2)
                - self.arms[i].powi(2)
                - (h_minus_z.powi(2) + r_minus_x.powi(2) + y * y);
            ((b * c - a * (a * a + b * b - c * c).sqrt()) / (a * a + b * b)).asin().to_degrees()
        };
        Some([0, 1, 2].map(joint)).filter(|joints| joints.iter().all(|joint| joint.is_finite()))
    }

    /// `RotaryDeltaKinematics::ForwardTransform`.
    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        let end = |i: usize| {
            let (sine, cosine) = joints[i].to_radians().sin_cos();
            let (s, c) = self.angles[i].to_radians().sin_cos();
            let out = self.radius + self.arms[i] * cosine;
            // Of the first arm's length, for all of them.
            [out * c, out * s, self.heights[i] + self.arms[0] * sine]
        };
        let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [end(0), end(1), end(2)];
        let [ra, rb, rc] = self.rods.map(|rod| rod * rod);
        let da = ax * ax + ay * ay + az * az;
        let db = bx * bx + by * by + bz * bz;
        let dc = cx * cx + cy * cy + cz * cz;
        let p = (bx * cy - ax * cy - cx * by + ax * by + cx * ay - bx * ay) * 2.0;
        let q = ((by - ay) * cz + (ay - cy) * bz + (cy - by) * az) * 2.0;
        let r = ((bx - ax) * cz + (ax - cx) * bz + (cx - bx) * az) * 2.0;
        let (ab, ca, bc) = (ra - rb + db - da, rc - ra + da - dc, rb - rc + dc - db);
        let s = ab * cy + ca * by + bc * ay;
        let t = ab * cx + ca * bx + bc * ax;
        let a = p * p + q * q + r * r;
        let half_b = p * r * ay - p * p * az - p * q * ax + r * t + q * s;
        let c = s * s + t * t + (t * ay - s * ax) * p * 2.0 + (da - ra) * p * p;
        let z = (-half_b - (half_b * half_b - a * c).sqrt()) / a;
        Some([(q * z + s) / p, -(r * z + t) / p, z]).filter(|p| p.iter().all(|x| x.is_finite()))
    }
}

#[test]
fn configurations_are_reprapfirmwares() {
    let mut compared = Compared::default();
    let text = file("reprap.txt");
    for figures in sections(&text) {
        let found = parameters(&figures);
        if found.contains_key(&("M669".to_owned(), 'K')) {
            let firmware = Rotary {
                radius: 50.0,
                arms: [100.0; 3],
                rods: [200.0; 3],
                heights: [250.0; 3],
                angles: [-150.0, -30.0, 90.0],
            };
            let region = compare(reprap, &figures, &firmware, &mut compared);
            assert_eq!(region.cylinder(), (80.0, [0.0, 90.0]));
            continue;
        }
        let firmware = linear(&found);
        let region = compare(reprap, &figures, &firmware.towers, &mut compared);
        let (radius, [low, high]) = region.cylinder();
        assert_eq!((radius, low), (firmware.print_radius, firmware.lowest), "{}", figures.origin);
        // LimitPosition: up to `high` no carriage is above its homed height at the edge next to its
        // tower; a little above, one is.
        let over = |z: f64| {
            (0..3).any(|i| {
                let [x, y] = firmware.towers.at[i];
                let inside = (radius / x.hypot(y)).min(1.0);
                let joints = firmware.towers.joints([x * inside, y * inside, z]);
                joints.is_some_and(|joints| joints[i] > firmware.homed[i])
            })
        };
        assert!(!over(high - 1e-6) && over(high + 1e-6), "{}: {high}", figures.origin);
    }
    println!("{compared:?}");
    assert!(compared.configurations >= 24);
}

const PLAIN: &str = "M665 L215 R105.6 B80 H240 ; a linear Delta\n";

fn text(text: &str) -> Result<Imported, ImportError> {
    import(reprap, &[("config.g", text)])
}

#[test]
fn later_commands_override() {
    for commands in [
        "M665 L215 R105.6 B80 H240",
        "m665 l215 r105.6 b80 h240",
        "M669 K3\nM665 R105.6 B80 H240\nM665 L215",
        "M665 L1 R2\nM665 R105.6 L215:215:215 B80 H240 M117 M665 R1",
        "M669 K10 R1 B1\nM665 L215 R105.6 B80 H240\nM669 S100",
        "; M665 R1\nM117 \"; M665 R1\" ; M665 R1\nM665 L215R105.6B80H240",
        "if {true}\n  M117 x\nvar a = 1\nM665 L215 R105.6 B80 H240",
        "M665 L215\nM208 Z{global.a} S0\nM208 Z0 S1\nM579 X1.0 Y1\nM556 X0 Y0 Z0\nM564 S0\nM564 S1",
    ] {
        let commands = format!("{commands}\n");
        let imported = text(&commands).unwrap_or_else(|error| panic!("{commands}: {error}"));
        let claim = claim(&imported);
        let Leg::Slider { anchor, length, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
        assert_eq!((&anchor[1], length), (&exactly("105.6"), &exactly("215")), "{commands}");
        let Workspace::Cylinder { radius, z, .. } = &claim.workspace else { panic!("{claim:?}") };
        assert_eq!((radius, &z[0]), (&number("80"), &number("0")), "{commands}");
    }
}

#[test]
fn what_is_called_is_read() {
    let config = format!("{PLAIN}M98 P\"geometry.g\"\nM501\n");
    let geometry = ("geometry.g", "M665 R110\n");
    let saved = ("config-override.g", "M665 R120\n");
    let radius = |files: &[(&str, &str)]| {
        let claim = claim(&import(reprap, files).unwrap());
        let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
        anchor[1].clone()
    };
    assert_eq!(radius(&[("config.g", &config), geometry, saved]), exactly("120"));
    assert_eq!(
        radius(&[("config.g", &format!("{config}M665 R100\n")), geometry, saved]),
        exactly("100")
    );
    for (missing, told) in
        [(vec![geometry], "M501 = config-override.g"), (vec![saved], "M98 = geometry.g")]
    {
        let mut all = vec![("config.g", config.as_str())];
        all.extend(missing);
        let error = import(reprap, &all).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
    let disk = files(&[("config.g", PLAIN), saved]);
    let paths = ["config.g", "config-override.g"];
    let error = ignoring(reprap, &disk, &paths, &[]).unwrap_err().to_string();
    assert!(error.contains("config-override.g is not called"), "{error}");
    let again = format!("M98 P\"config.g\"\n{PLAIN}");
    let error = text(&again).unwrap_err();
    assert!(error.to_string().contains("M98"), "{error}");
}

#[test]
fn what_cannot_be_imported_is_refused() {
    for (commands, told) in [
        ("M666 A0.1", "config.g: M666 A tilts the bed"),
        ("M666 B-0.1", "M666 B tilts the bed"),
        ("if {sensors.a}\n  M665 R100", "M665 in a block = M665 R100"),
        ("while true\n  if x\n    M117 a\n  M208 Z5 S1", "M208 in a block"),
        ("M665 R{global.radius}", "M665 R: found \"{global.radius}\""),
        ("M665 R", "M665 R: found \"\""),
        ("M665 R(5)", "M665 = M665 R(5)"),
        ("M665 R216", "less than the rods' length"),
        ("M665 L215:214", "with colons between them"),
        ("M665 L1:2:3:4", "with colons between them"),
        ("M665 R0", "M665 R"),
        ("M665 X400", "within a turn"),
        ("M665 H-300", "homed carriages"),
        ("M665 V3", "M665 V = 3: not understood"),
        ("M666 U1", "M666 U = 1: not understood"),
        ("M669 X5 Y5", "M669 X = 5: not understood"),
        ("M669 K0", "found kinematics \"M669 K0\""),
        ("M579 X1.01", "M579 X = 1.01: not understood"),
        ("M556 S100 X0.5", "M556 X = 0.5: not understood"),
        ("M564 S0", "M564 S"),
        ("M505 P\"other\"", "M505"),
        ("M667 S1", "M667"),
        ("if x\n  abort", "abort in a block"),
    ] {
        let error = text(&format!("{PLAIN}{commands}\n")).expect_err(commands).to_string();
        assert!(error.contains(told), "{commands}: {error}");
    }
    let error = text("M667 S1\n").unwrap_err().to_string();
    assert!(error.contains("found kinematics \"M669 K0, the firmware's default\""), "{error}");
    let error = text("M669 K10 U100:90\n").unwrap_err().to_string();
    assert!(error.contains("M669 U"), "{error}");
}

#[test]
fn a_rotary_delta_has_its_arms() {
    let imported =
        text("M669 K10 U110 L210:220:230 H260 R40 B70 A-30:60 X1 M208 Z-5:50\n").unwrap();
    let claim = claim(&imported);
    let firmware = Rotary {
        radius: 40.0,
        arms: [110.0; 3],
        rods: [210.0, 220.0, 230.0],
        heights: [260.0; 3],
        angles: [-149.0, -30.0, 90.0],
    };
    assert_eq!(crate::oracle::same_joints("config.g", &claim, &firmware, 300), 300);
    let ranges = claim.joint_ranges();
    let ends_at_60 = |range: &&Requirement| match &range.bound {
        Bound::Within([_, max]) => max.to_string() == "60",
        Bound::Min(_) | Bound::Max(_) | Bound::Holds => false,
    };
    assert!(!ranges.is_empty() && ranges.iter().all(ends_at_60));
}

#[test]
fn no_script_makes_the_importer_panic() {
    let text =
        format!("{PLAIN}M666 X0.1 A0\nif {{a}}\n  M98 P\"b.g\"\nM208 Z-1:2 S1\nM669 K10 U1:2:3\n");
    for (at, c) in text.char_indices() {
        for new in ["", "\n", ";", "\"", "{", "}", "M", "g", ":", "-", "9", " ", "\u{0}", "±", "'"]
        {
            let mutant = format!("{}{new}{}", &text[..at], &text[at + c.len_utf8()..]);
            let _ = import(reprap, &[("config.g", &mutant)]);
        }
    }
}
