//! LinuxCNC's hexapods and pentapods, whose platforms turn: the designs against its kinematics.

use crate::linuxcnc::{hal, sq};
use crate::oracle::Random;
use crate::support::{files, ignoring, import};
use num_bigint::BigInt;
use orthocert::design::Design;
use orthocert::import::{linuxcnc, Imported};
use orthocert_kernel as kernel;

/// src/emc/kinematics/genhexkins.c, `genhex_read_hal_pins`, `genhexKinematicsInverse` without a screw's
/// lead; src/libposemath/_posemath.c, `pmRpyMatConvert`.
struct Hexapod {
    base: [[f64; 3]; 6],
    platform: [[f64; 3]; 6],
    spindle_offset: f64,
    tool_offset: f64,
}

impl Hexapod {
    fn joints(&self, tran: [f64; 3], [a, b, c]: [f64; 3]) -> [f64; 6] {
        let ((sg, cg), (sb, cb), (sa, ca)) =
            (a.to_radians().sin_cos(), b.to_radians().sin_cos(), c.to_radians().sin_cos());
        let x = [ca * cb, sa * cb, -sb];
        let y = [ca * sb * sg - sa * cg, sa * sb * sg + ca * cg, cb * sg];
        let z = [ca * sb * cg + sa * sg, sa * sb * cg - ca * sg, cb * cg];
        let added = self.spindle_offset + self.tool_offset;
        std::array::from_fn(|i| {
            let (mut b, mut a) = (self.base[i], self.platform[i]);
            b[2] += added;
            a[2] += added;
            let of = |k: usize| x[k] * a[0] + y[k] * a[1] + z[k] * a[2];
            let off: [f64; 3] = std::array::from_fn(|k| tran[k] + of(k) - b[k]);
            off.iter().map(|x| sq(*x)).sum::<f64>().sqrt()
        })
    }
}

fn shipped_hexapod() -> Hexapod {
    Hexapod {
        base: [
            [-22.950, 13.250, 0.0],
            [22.950, 13.250, 0.0],
            [22.950, 13.250, 0.0],
            [0.0, -26.500, 0.0],
            [0.0, -26.500, 0.0],
            [-22.950, 13.250, 0.0],
        ],
        platform: [
            [-1.0, 11.500, 0.0],
            [1.0, 11.500, 0.0],
            [10.459, -4.884, 0.0],
            [9.459, -6.616, 0.0],
            [-9.459, -6.616, 0.0],
            [-10.459, -4.884, 0.0],
        ],
        spindle_offset: 0.0,
        tool_offset: 0.0,
    }
}

fn decided(imported: &Imported) -> kernel::claim::MachineClaim {
    let text = &imported.design;
    let design = Design::parse(text, "imported.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    design.claim
}

/// The joint coordinates of the claim's own formulas, with roll, pitch and yaw about a pose.
fn same_lengths(imported: &Imported, firmware: &Hexapod, wide: bool) {
    let mut claim = decided(imported);
    // The formulas are to be in roll, pitch and yaw.
    if !wide {
        let range = r#"{"roll_pitch_yaw":{"roll":["-9","9"],"pitch":["-9","9"],"yaw":["-9","9"]}}"#;
        claim.orientation = serde_json::from_str(range).expect("orientations");
    }
    let problem = kernel::problem::Problem::new(&claim).expect("a claim");
    let unit = (problem.scale as f64).exp2();
    let mut random = Random(7);
    for _ in 0..50 {
        let [x, y, z] = random.three();
        let (tran, turned) = (
            [20.0 * x - 10.0, 20.0 * y - 10.0, 15.0 + 15.0 * z],
            random.three().map(|u| 60.0 * u - 30.0),
        );
        let coordinates: Vec<f64> = tran
            .iter()
            .map(|x| x / unit)
            .chain(turned.iter().map(|angle| (angle.to_radians() / 2.0).tan()))
            .collect();
        let length = lengths_at(&problem, &coordinates);
        for (i, (leg, theirs)) in problem.legs.iter().zip(firmware.joints(tran, turned)).enumerate()
        {
            let ours = length(leg.length.expect("a strut"));
            assert!(
                (ours - theirs).abs() < 1e-9,
                "joint {i} at {tran:?} {turned:?}: {ours} {theirs}"
            );
        }
    }
}

#[test]
fn hexapods() {
    let module = "loadrt genhexkins\n";
    let plain = hal(module).unwrap();
    same_lengths(&plain, &shipped_hexapod(), false);
    assert_eq!(plain.defaults.len(), 36 + 3);
    assert!(decided(&plain).require.iter().any(|r| r.quantity == "one_to_one"));
    let mut other = shipped_hexapod();
    (other.base[3], other.platform[5]) = ([0.5, -25.0, 1.25], [-11.0, -5.5, -2.0]);
    (other.spindle_offset, other.tool_offset) = (-3.5, 1.0);
    let pins = "setp genhexkins.base.3.x .5\nsetp genhexkins.base.3.y -25\n\
                setp genhexkins.base.3.z 1.25\nsetp genhexkins.platform.5.x -11.0\n\
                setp genhexkins.platform.5.y -5.5\nsetp genhexkins.platform.5.z -2.0\n\
                setp genhexkins.spindle-offset -3.5\nsetp genhexkins.tool-offset 1\n\
                setp genhexkins.screw-lead 0\nsetp genhexkins.base-n.0.x 1\n\
                setp genhexkins.convergence-criterion 1e-9\n\
                net :last-iter <= genhexkins.last-iterations => pyvcp.last-iter\n\
                loadusr -W ./hexagui.py\n";
    same_lengths(&hal(&format!("{module}{pins}")).unwrap(), &other, false);
    for (lines, told) in [
        ("setp genhexkins.screw-lead 0.2", "depend on how the joints turn (base-n, platform-n)"),
        ("setp genhexkins.base.6.x 1", "machine.hal:2: found a line"),
        ("setp genhexkins.base.0.w 1", "machine.hal:2: found a line"),
        ("setp genhexkins.base.0.x [HEX]X", "found \"[HEX]X\""),
        ("net tool-offset genhexkins.tool-offset motion.tooloffset.z", "motion.tooloffset.z"),
        ("loadrt pentakins", "pentakins and genhexkins"),
    ] {
        let error = hal(&format!("{module}{lines}\n")).expect_err(lines).to_string();
        assert!(error.contains(told), "{lines}: {error}");
    }
    let linked = "loadrt genhexkins\nnet t genhexkins.tool-offset motion.tooloffset.z\n";
    let files = files(&[("m.hal", linked)]);
    let imported = ignoring(linuxcnc, &files, &["m.hal"], &["motion.tooloffset.z"]).unwrap();
    same_lengths(&imported, &shipped_hexapod(), false);
}

#[test]
fn the_limits_of_a_hexapod() {
    let ini = |a: &str, parameters: &str| {
        let mut text = format!("[KINS]\nKINEMATICS = genhexkins{parameters}\nJOINTS = 6\n");
        for (axis, least, greatest) in [
            ("X", "-4", "4"),
            ("Y", "-4", "4"),
            ("Z", "16", "24"),
            ("A", &format!("-{a}"), a),
            ("B", "-30", "30"),
            ("C", "-31", "31"),
        ] {
            text.push_str(&format!("[AXIS_{axis}]\nMIN_LIMIT = {least}\nMAX_LIMIT = {greatest}\n"));
        }
        for joint in 0..6 {
            text.push_str(&format!("[JOINT_{joint}]\nMIN_LIMIT = 10\nMAX_LIMIT = 60.5\n"));
        }
        import(linuxcnc, &[("m.ini", &text)])
    };
    let imported = ini("30", "").unwrap();
    same_lengths(&imported, &shipped_hexapod(), true);
    let claim = decided(&imported);
    let shown = serde_json::to_value(&claim).expect("a value");
    assert_eq!(shown["workspace"]["box"]["max"], serde_json::json!(["4", "4", "24"]));
    let range = &shown["orientation"]["roll_pitch_yaw"];
    assert_eq!(range["yaw"], serde_json::json!(["-31", "31"]));
    let asked: Vec<&str> = claim.require.iter().map(|r| r.quantity.as_str()).collect();
    assert_eq!(asked.iter().filter(|q| **q == "one_to_one").count(), 1);
    assert!(asked.contains(&"joint_range"));
    // Roll and yaw together over half a turn: two poses may differ by that.
    let wide = decided(&ini("60", " coordinates=XYZABC").unwrap());
    assert!(wide.require.iter().all(|r| r.quantity == "joint_range"));
    let unbounded = ini("1000", "").unwrap();
    assert!(unbounded.not_carried_over.iter().any(|note| note.contains("a guess to be changed")));
    same_lengths(&unbounded, &shipped_hexapod(), false);
    let error = ini("30", " sparm=identityfirst").unwrap_err().to_string();
    assert!(error.contains("coordinates=xyzabc"), "{error}");
}

/// src/emc/kinematics/pentakins.c, `pentakins_read_hal_pins`, `InvKins`; src/libposemath/_posemath.c,
/// `pmRpyMatConvert` of no yaw.
struct Pentapod {
    base: [[f64; 3]; 5],
    effector: [[f64; 2]; 5],
    tool_offset: f64,
}

impl Pentapod {
    fn joints(&self, tran: [f64; 3], [a, b]: [f64; 2]) -> [f64; 5] {
        let ((sa, ca), (sb, cb)) = (a.to_radians().sin_cos(), b.to_radians().sin_cos());
        let columns = [[cb, 0.0, -sb], [sb * sa, ca, cb * sa], [sb * ca, -sa, cb * ca]];
        std::array::from_fn(|i| {
            let mut base = self.base[i];
            base[2] += self.tool_offset;
            let [radius, height] = self.effector[i];
            let [x, y, z] =
                columns.map(|column| (0..3).map(|k| column[k] * (base[k] - tran[k])).sum::<f64>());
            let across = (sq(x) + sq(y)).sqrt() - radius;
            (sq(z - height - self.tool_offset) + sq(across)).sqrt()
        })
    }
}

fn shipped_pentapod() -> Pentapod {
    let height = 895.56;
    Pentapod {
        base: [
            [-418.03, 324.56, height],
            [417.96, 324.56, height],
            [-418.03, -325.44, height],
            [417.96, -325.44, height],
            [-0.06, -492.96, height],
        ],
        effector: [-185.50, -159.50, -67.50, -41.50, -14.00].map(|z| [80.32, z]),
        tool_offset: 0.0,
    }
}

/// Lengths at a point of the claim's box, in the claim's own unit.
fn lengths_at<'a>(
    problem: &'a kernel::problem::Problem,
    coordinates: &[f64],
) -> impl Fn(kernel::formula::Formula) -> f64 + 'a {
    let fixed = kernel::fixed::Fixed::<BigInt>::new(96);
    let parameters = problem.parameters::<BigInt>(96, &[]).expect("numbers");
    let coordinate = |k: usize| {
        let x = (coordinates[k] * 52f64.exp2()).round() as i64;
        Some(kernel::fixed::Interval::point(BigInt::from(x) << 44))
    };
    let values = problem.tape.run(&fixed, coordinate, |j| parameters.get(j).cloned());
    let unit = (problem.scale as f64).exp2();
    move |formula| {
        let length = &values.of(formula).expect("defined").lo;
        length.to_string().parse::<f64>().expect("a number") * (-96f64).exp2() * unit
    }
}

/// The joint coordinates of the claim's own formulas, about a pose.
fn same_joints_of_a_pentapod(imported: &Imported, firmware: &Pentapod) {
    let claim = decided(imported);
    let problem = kernel::problem::Problem::new(&claim).expect("a claim");
    let unit = (problem.scale as f64).exp2();
    let mut random = Random(7);
    for _ in 0..50 {
        let tran = random.three().map(|u| 600.0 * u - 300.0);
        let [a, b, _] = random.three().map(|u| 60.0 * u - 30.0);
        let half = [a, b].map(|angle| (angle.to_radians() / 2.0).tan());
        let coordinates: Vec<f64> = tran.into_iter().chain(half).map(|x| x / unit).collect();
        let length = lengths_at(&problem, &coordinates);
        for (i, (leg, theirs)) in problem.legs.iter().zip(firmware.joints(tran, [a, b])).enumerate()
        {
            let Some(kernel::machine::Joint::Length(rho)) = leg.rho else { panic!("a length") };
            let ours = length(rho);
            assert!((ours - theirs).abs() < 1e-9, "joint {i} at {tran:?} {a} {b}: {ours} {theirs}");
        }
    }
}

#[test]
fn pentapods() {
    let module = "loadrt pentakins\n";
    let plain = hal(module).unwrap();
    same_joints_of_a_pentapod(&plain, &shipped_pentapod());
    assert_eq!(plain.defaults.len(), 25 + 1);
    let mut other = shipped_pentapod();
    (other.base[3], other.effector[4]) = ([0.5, -250.0, 901.25], [75.5, -20.0]);
    other.tool_offset = 120.5;
    let pins = "setp pentakins.base.3.x .5\nsetp pentakins.base.3.y -250\n\
                setp pentakins.base.3.z 901.25\nsetp pentakins.effector.4.r 75.5\n\
                setp pentakins.effector.4.z -20.0\nsetp pentakins.tool-offset 120.5\n\
                setp pentakins.max-error 50\n";
    same_joints_of_a_pentapod(&hal(&format!("{module}{pins}")).unwrap(), &other);
    for (lines, told) in [
        ("setp pentakins.base.5.x 1", "machine.hal:2: found a line"),
        ("setp pentakins.effector.0.x 1", "machine.hal:2: found a line"),
        ("setp pentakins.effector.0.r [HEX]R", "found \"[HEX]R\""),
        ("net tool-offset pentakins.tool-offset motion.tooloffset.z", "motion.tooloffset.z"),
    ] {
        let error = hal(&format!("{module}{lines}\n")).expect_err(lines).to_string();
        assert!(error.contains(told), "{lines}: {error}");
    }
    let mut text = String::from("[KINS]\nKINEMATICS = pentakins\nJOINTS = 5\n");
    for (axis, least, greatest) in [
        ("X", "-20", "20"),
        ("Y", "-20", "20"),
        ("Z", "430", "470"),
        ("A", "-3", "2"),
        ("B", "0", "90"),
    ] {
        text.push_str(&format!("[AXIS_{axis}]\nMIN_LIMIT = {least}\nMAX_LIMIT = {greatest}\n"));
    }
    for joint in 0..5 {
        text.push_str(&format!("[JOINT_{joint}]\nMIN_LIMIT = 400\nMAX_LIMIT = 1200\n"));
    }
    let limited = import(linuxcnc, &[("m.ini", &text)]).unwrap();
    same_joints_of_a_pentapod(&limited, &shipped_pentapod());
    let claim = serde_json::to_value(decided(&limited)).expect("a value");
    // tan(-1.5 degrees) from below; tan(45 degrees) = 1 from above.
    let [min, max] = ["min", "max"].map(|end| claim["workspace"]["box"][end].clone());
    assert_eq!(min, serde_json::json!(["-20", "-20", "430", "-0.026185921569186929", "0"]));
    assert_eq!(max[4], "1.000000000000000001");
    let asked = claim["require"].as_array().expect("some");
    assert!(!asked.is_empty() && asked.iter().all(|r| r["quantity"] == "joint_range"), "{asked:?}");
}
