//! LinuxCNC's configurations: what is read of them, and the designs against its kinematics.

use crate::oracle::{same_as_compiled, same_extremes, same_joints, Extremes, Firmware};
use crate::support::{claim, exactly, file, files, folder, ignoring, import, legs, number};
use crate::support::{Leg, Workspace};
use orthocert::import::{linuxcnc, Disk, ImportError, Imported};
use orthocert_kernel::claim::Bound;
use orthocert_kernel::number::Expression;
use std::path::PathBuf;

fn on_disk(names: &[&str]) -> Result<Imported, ImportError> {
    let paths: Vec<PathBuf> =
        names.iter().map(|name| folder().join("linuxcnc").join(name)).collect();
    linuxcnc(&Disk, &paths, &[])
}

pub fn hal(text: &str) -> Result<Imported, ImportError> {
    import(linuxcnc, &[("machine.hal", text)])
}

fn finite(joints: [f64; 3]) -> Option<[f64; 3]> {
    Some(joints).filter(|joints| joints.iter().all(|x| x.is_finite()))
}

pub fn sq(x: f64) -> f64 {
    x * x
}

/// src/emc/kinematics/lineardeltakins-common.h, `set_geometry`, `kinematics_inverse`,
/// `kinematics_forward`.
struct Linear {
    r: f64,
    l: f64,
}

impl Linear {
    fn towers(&self) -> [[f64; 2]; 3] {
        let sin_60 = 3f64.sqrt() / 2.0;
        [[0.0, self.r], [-sin_60 * self.r, -0.5 * self.r], [sin_60 * self.r, -0.5 * self.r]]
    }
}

impl Firmware for Linear {
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let towers = self.towers();
        finite(towers.map(|[ax, ay]| z + (sq(self.l) - sq(ax - x) - sq(ay - y)).sqrt()))
    }

    fn point(&self, [q1, q2, q3]: [f64; 3]) -> Option<[f64; 3]> {
        let [[_, ay], [bx, by], [cx, cy]] = self.towers();
        let den = (by - ay) * cx - (cy - ay) * bx;
        let w1 = ay * ay + q1 * q1;
        let w2 = bx * bx + by * by + q2 * q2;
        let w3 = cx * cx + cy * cy + q3 * q3;
        let a1 = (q2 - q1) * (cy - ay) - (q3 - q1) * (by - ay);
        let b1 = -((w2 - w1) * (cy - ay) - (w3 - w1) * (by - ay)) / 2.0;
        let a2 = -(q2 - q1) * cx + (q3 - q1) * bx;
        let b2 = ((w2 - w1) * cx - (w3 - w1) * bx) / 2.0;
        let a = a1 * a1 + a2 * a2 + den * den;
        let b = 2.0 * (a1 * b1 + a2 * (b2 - ay * den) - q1 * den * den);
        let c = sq(b2 - ay * den) + b1 * b1 + den * den * (q1 * q1 - sq(self.l));
        let discr = b * b - 4.0 * a * c;
        let z = -0.5 * (b + discr.sqrt()) / a;
        finite([(a1 * z + b1) / den, (a2 * z + b2) / den, z])
    }
}

/// src/emc/kinematics/rotarydeltakins-common.h, `inverse_j0`, `kinematics_inverse`,
/// `kinematics_forward`.
struct Rotary {
    pfr: f64,
    tl: f64,
    sl: f64,
    fr: f64,
}

impl Rotary {
    fn inverse_j0(&self, x: f64, y: f64, z: f64) -> f64 {
        let a =
            0.5 * (sq(x) + sq(y - self.fr) + sq(z) + sq(self.tl) - sq(self.sl) - sq(self.pfr)) / z;
        let b = (self.fr - self.pfr - y) / z;
        let d = sq(self.tl) * (sq(b) + 1.0) - sq(a - b * self.pfr);
        let knee_y = (self.pfr + a * b + d.sqrt()) / (sq(b) + 1.0);
        let knee_z = b * knee_y - a;
        knee_z.atan2(knee_y - self.pfr).to_degrees()
    }
}

impl Firmware for Rotary {
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let turned =
            |theta: f64| (x * theta.cos() - y * theta.sin(), x * theta.sin() + y * theta.cos());
        let third = 2.0 * std::f64::consts::PI / 3.0;
        finite([0.0, -third, third].map(|theta| {
            let (x, y) = turned(theta);
            self.inverse_j0(x, y, z)
        }))
    }

    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        let Rotary { pfr, tl, sl, fr } = *self;
        let [(s0, c0), (s1, c1), (s2, c2)] = joints.map(|joint| joint.to_radians().sin_cos());
        let (y1, z1) = (-(pfr - fr + tl * c0), -tl * s0);
        let (y2, z2) = ((pfr - fr + tl * c1) * 0.5, -tl * s1);
        let x2 = y2 * 3f64.sqrt();
        let (y3, z3) = ((pfr - fr + tl * c2) * 0.5, -tl * s2);
        let x3 = -y3 * 3f64.sqrt();
        let denom = x3 * (y2 - y1) - x2 * (y3 - y1);
        let w1 = sq(y1) + sq(z1);
        let w2 = sq(x2) + sq(y2) + sq(z2);
        let w3 = sq(x3) + sq(y3) + sq(z3);
        let a1 = (z2 - z1) * (y3 - y1) - (z3 - z1) * (y2 - y1);
        let b1 = -((w2 - w1) * (y3 - y1) - (w3 - w1) * (y2 - y1)) / 2.0;
        let a2 = -(z2 - z1) * x3 + (z3 - z1) * x2;
        let b2 = ((w2 - w1) * x3 - (w3 - w1) * x2) / 2.0;
        let a = sq(a1) + sq(a2) + sq(denom);
        let b = 2.0 * (a1 * b1 + a2 * (b2 - y1 * denom) - z1 * sq(denom));
        let c = sq(b2 - y1 * denom) + sq(b1) + sq(denom) * (sq(z1) - sq(sl));
        let d = sq(b) - 4.0 * a * c;
        let z = (-b - d.sqrt()) / (2.0 * a);
        finite([(a1 * z + b1) / denom, (a2 * z + b2) / denom, z])
    }
}

/// src/emc/kinematics/tripodkins.c, `kinematicsInverse`, `kinematicsForward` above the base.
struct Tripod {
    bx: f64,
    cx: f64,
    cy: f64,
}

impl Firmware for Tripod {
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        finite([
            (sq(x) + sq(y) + sq(z)).sqrt(),
            (sq(x - self.bx) + sq(y) + sq(z)).sqrt(),
            (sq(x - self.cx) + sq(y - self.cy) + sq(z)).sqrt(),
        ])
    }

    fn point(&self, [ad, bd, cd]: [f64; 3]) -> Option<[f64; 3]> {
        let p = sq(ad);
        let q = sq(bd) - sq(self.bx);
        let r = sq(cd) - sq(self.cx) - sq(self.cy);
        let (s, t, u) = (-2.0 * self.bx, -2.0 * self.cx, -2.0 * self.cy);
        let x = (q - p) / s;
        let y = (r - q - (t - s) * x) / u;
        finite([x, y, (p - sq(x) - sq(y)).sqrt()])
    }
}

/// The restated kinematics against LinuxCNC's own.
#[test]
fn the_restated_kinematics_is_the_firmwares() {
    let reference = file("linuxcnc/reference.txt");
    let mut lines = 0;
    for line in reference.lines().filter(|line| !line.starts_with('#')) {
        let (kind, numbers) = line.split_once(' ').expect("a kind");
        let n: Vec<f64> = numbers.split(' ').map(|word| word.parse().unwrap()).collect();
        let (firmware, at): (Box<dyn Firmware>, usize) = match kind {
            "linear" => (Box::new(Linear { r: n[0], l: n[1] }), 2),
            "rotary" => (Box::new(Rotary { pfr: n[0], tl: n[1], sl: n[2], fr: n[3] }), 4),
            _ => (Box::new(Tripod { bx: n[0], cx: n[1], cy: n[2] }), 3),
        };
        let three = |at: usize| [n[at], n[at + 1], n[at + 2]];
        same_as_compiled(line, &*firmware, [three(at), three(at + 3), three(at + 6)]);
        lines += 1;
    }
    assert_eq!(lines, 120);
}

/// The files, their kinematics, and a box: x, y and z, least and greatest.
type Row = (&'static [&'static str], Box<dyn Firmware>, [&'static str; 6]);

/// The configurations of ORIGIN.md, each in its own form, with what the files say, and a box within
/// their workspace that holds no singularity.
#[test]
fn real_configurations_are_the_firmwares_machines() {
    let linear = |r, l| Box::new(Linear { r, l });
    let shipped: [Row; 6] = [
        (&["ldelta.ini"], linear(130.25, 269.0), ["-95", "95", "-95", "95", "-5", "35"]),
        (&["ldelta_demo.ini"], linear(130.25, 269.0), ["0", "20", "-95", "0", "-5", "-5"]),
        (
            &["rdelta.ini"],
            Box::new(Rotary { pfr: 10.0, tl: 10.0, sl: 18.0, fr: 5.0 }),
            ["-4", "4", "-4", "4", "-18", "-10"],
        ),
        (
            &["tripod.ini", "hallib/tripodsim.hal"],
            Box::new(Tripod { bx: 10.0, cx: 5.0, cy: 7.071 }),
            ["-1", "20", "-1", "20", "1", "20"],
        ),
        (&["umk_delta.ini"], linear(100.0, 183.0), ["-50", "50", "-50", "50", "-365", "-125"]),
        (&["lineardelta.ini"], linear(130.5, 269.5), ["-50", "50", "-50", "50", "0", "100"]),
    ];
    for (names, firmware, [x0, x1, y0, y1, z0, z1]) in shipped {
        let imported = on_disk(names).unwrap_or_else(|e| panic!("{names:?}: {e}"));
        let whole = claim(&imported);
        let claim = claim(&imported).on_a_box([[x0, y0, z0], [x1, y1, z1]].map(|x| x.map(number)));
        assert_eq!(same_joints(names[0], &claim, &*firmware, 400), 400, "{names:?}");
        assert_eq!(same_extremes(names[0], &claim, &*firmware), Extremes::Agree, "{names:?}");
        if whole.workspace != claim.workspace {
            let told = same_extremes(names[0], &whole, &*firmware);
            assert_eq!(told, Extremes::Singular, "{names:?}");
        }
    }
}

/// As src/emc/ini/emcIniFile.cc has them; what it does not know names no unit.
#[test]
fn the_unit_of_length_is_the_files() {
    let unit = |text: &str| {
        let ini = format!("[TRAJ]\nLINEAR_UNITS = {text}\n[KINS]\nKINEMATICS = lineardeltakins\n");
        let hal = "loadrt lineardeltakins\nsetp lineardeltakins.L 3\nsetp lineardeltakins.R 1\n";
        let ini = format!("{ini}[HAL]\nHALFILE = machine.hal\n");
        let files = [("machine.ini", ini.as_str()), ("machine.hal", hal)];
        let design = import(linuxcnc, &files).unwrap_or_else(|e| panic!("{e}")).design;
        design.lines().find(|line| line.starts_with("unit")).map(str::to_owned)
    };
    for (text, expected) in [("mm", "mm"), ("METRIC", "mm"), ("in", "in"), ("Imperial", "in")] {
        assert_eq!(unit(text), Some(format!("unit = \"{expected}\"")), "{text}");
    }
    assert_eq!(unit("furlong"), None);
}

#[test]
fn a_linear_delta() {
    let imported = on_disk(&["lineardelta.ini"]).unwrap();
    let claim = claim(&imported);
    let Leg::Slider { anchor, length, .. } = &legs(&claim)[1] else { panic!("{claim:?}") };
    // Joint 1 stands at 210 degrees, joint 2 at 330.
    assert_eq!(anchor[0], exactly("-130.5*sqrt(3)/2"));
    assert_eq!((&anchor[1], length), (&exactly("-130.5/2"), &exactly("269.5")));
    let corner = |x: &str, y: &str, z: &str| [number(x), number(y), number(z)];
    let (min, max) = (corner("-50", "-50", "0"), corner("50", "50", "100"));
    assert_eq!(claim.workspace, Workspace::Box { min, max });
    assert!(!claim.joint_ranges().is_empty());
}

/// Limits that are not set are 1e99 there; of arms a range has both ends.
#[test]
fn some_joints_have_limits() {
    let joints = |kins: &str, limits: &str| {
        let ini = format!("[KINS]\nKINEMATICS = {kins}\n{limits}");
        import(linuxcnc, &[("machine.ini", &ini)])
    };
    let limits = "[JOINT_0]\nMIN_LIMIT = 5\nMAX_LIMIT = 260\n[JOINT_2]\nMAX_LIMIT = 250\n";
    let imported = joints("lineardeltakins", limits).unwrap();
    let read = claim(&imported);
    let ranges = read.joint_ranges().into_iter().cloned();
    let ranges: Vec<_> = ranges.map(|own| (own.leg, own.bound)).collect();
    let number = |text: &str| Expression::try_from(text.to_owned()).unwrap();
    let (min, max) = (Bound::Min(number("5")), Bound::Max(number("260")));
    let expected = [(Some(1), min), (Some(1), max), (Some(3), Bound::Max(number("250")))];
    assert_eq!(ranges, expected);
    assert!(imported.not_carried_over.iter().any(|note| note.ends_with("of JOINT_1.")));
    let arms = joints("rotarydeltakins", "[JOINT_0]\nMIN_LIMIT = -30\n");
    assert!(matches!(arms, Err(ImportError::Missing { .. })), "{arms:?}");
    let arms = joints("rotarydeltakins", "[JOINT_1]\nMIN_LIMIT = -30\nMAX_LIMIT = 60\n").unwrap();
    assert_eq!(claim(&arms).joint_ranges().len(), 1);
}

#[test]
fn a_rotary_delta_counts_downwards_and_says_its_defaults() {
    let imported = on_disk(&["rotarydelta.hal"]).unwrap();
    let taken: Vec<String> = imported.defaults.iter().map(ToString::to_string).collect();
    let expected = "rotarydeltakins.footradius = 6.0, after \
                    src/emc/kinematics/rotarydeltakins-common.h";
    assert_eq!(taken, [expected]);
    let claim = claim(&imported);
    let Leg::Arm { anchor, mode, .. } = &legs(&claim)[0] else { panic!("{claim:?}") };
    assert_eq!((&anchor[0], &anchor[1]), (&exactly("0"), &exactly("-10")));
    assert!(format!("{mode:?}").contains("Plus"), "{mode:?}");
}

#[test]
fn signals_give_pins_their_values_as_in_hal() {
    let module = "loadrt lineardeltakins\n";
    for (lines, radius) in [
        ("setp lineardeltakins.R 99", "99"),
        ("lineardeltakins.R = 99", "99"),
        ("net r lineardeltakins.R => lineardelta.R\nsets r 99", "99"),
        ("newsig r float\nlinksp r => lineardeltakins.R\nsets r 99", "99"),
        ("newsig r float\nlinkps lineardeltakins.R => r\nsets r 98\nsets r 99", "99"),
        // The first pin of a signal gives it its own value.
        ("newsig r float\nsets r 5\nnet r lineardeltakins.R", "130.25"),
        ("setp lineardeltakins.R 99\nnet r lineardeltakins.R", "99"),
        ("setp lineardeltakins.R 98\nnet r lineardeltakins.R\nsets r 99 # mm", "99"),
        ("setp lineardeltakins.R \\\n99", "99"),
    ] {
        let imported =
            hal(&format!("{module}{lines}\n")).unwrap_or_else(|e| panic!("{lines}: {e}"));
        let claim = claim(&imported);
        let Leg::Slider { anchor, .. } = &legs(&claim)[0] else { panic!("no slider") };
        assert_eq!(anchor[1], exactly(radius), "{lines}");
    }
}

#[test]
fn what_may_set_a_pin_unseen_is_refused() {
    let module = "loadrt lineardeltakins\n";
    for (lines, told) in [
        ("net r sensor.out => lineardeltakins.R\nsets r 5", "machine.hal:2: sensor.out = net r"),
        ("net r lineardelta.R lineardeltakins.R", "lineardeltakins.R: found \"net r\""),
        ("setp lineardeltakins.R 130+5", "found \"130+5\""),
        ("setp lineardeltakins.R -5", "greater than 0"),
        ("setp lineardeltakins.R [DELTA]R", "found \"[DELTA]R\""),
        ("setp lineardeltakins.R $RADIUS", "found \"$RADIUS\""),
        ("net r lineardeltakins.R\nsetp lineardeltakins.R 5", "machine.hal:3: found a line"),
        ("loadusr -W ./calibrate.py", "loadusr calibrate.py"),
        ("loadusr halcmd setp lineardeltakins.R 5", "loadusr halcmd"),
        ("loadusr -w sim_pin lineardeltakins.R", "loadusr sim_pin"),
        ("alias pin lineardeltakins.R r\nsetp r 5", "alias"),
        ("sett lineardeltakins.R 5", "machine.hal:2: found a line"),
        ("setp lineardeltakins.R 5 6", "machine.hal:2: found a line"),
        ("loadrt trivkins", "trivkins"),
        ("source other.hal", "other.hal: cannot be read"),
        ("source machine.hal", "sourced at most"),
    ] {
        let error = hal(&format!("{module}{lines}\n")).expect_err(lines).to_string();
        assert!(error.contains(told), "{lines}: {error}");
    }
    let files = files(&[("m.hal", "loadrt lineardeltakins\nloadusr -W ./calibrate.py\n")]);
    let imported = ignoring(linuxcnc, &files, &["m.hal"], &["loadusr calibrate.py"]).unwrap();
    assert!(imported.design.contains("calibrate.py"), "{}", imported.design);
    let error = ignoring(linuxcnc, &files, &["m.hal"], &["loadusr calibrate"]).unwrap_err();
    assert!(error.to_string().contains("loadusr calibrate.py"), "{error}");
    assert!(hal("loadrt trivkins").unwrap_err().to_string().contains("\"trivkins\""));
    assert!(hal("").unwrap_err().to_string().contains("[KINS]KINEMATICS: not set"));
}

#[test]
fn ini_files_name_what_is_run_and_in_which_order() {
    let (ini, hal) = (file("linuxcnc/lineardelta.ini"), file("linuxcnc/lineardelta.hal"));
    let run = |ini: &str| import(linuxcnc, &[("m.ini", ini), ("lineardelta.hal", &hal)]);
    let radius = |imported: Imported| {
        let claim = claim(&imported);
        let Leg::Slider { anchor, .. } = &legs(&claim)[0] else { panic!("no slider") };
        anchor[1].clone()
    };
    assert_eq!(radius(run(&ini).unwrap()), exactly("130.5"));
    // HAL files come before commands, wherever they stand; of equal keys the first counts.
    let late = ini.replace("[HAL]\n", "[HAL]\nHALCMD = setp lineardeltakins.R 7\n");
    assert_eq!(radius(run(&late).unwrap()), exactly("130.5"));
    let twice = format!("{ini}\n[AXIS_X]\nMAX_LIMIT = 7\n");
    let Workspace::Box { max, .. } = &claim(&run(&twice).unwrap()).workspace else { panic!() };
    assert_eq!(max[0], number("50"));
    for (from, to, told) in [
        ("[HAL]\n", "[HAL]\nHALFILE = more.tcl\n", "[HAL]HALFILE = more.tcl"),
        ("[HAL]\n", "[HAL]\nHALFILE = gone.hal\n", "[HAL]HALFILE = gone.hal"),
        ("[HAL]\n", "[HAL]\nTWOPASS = on\n", "[HAL]TWOPASS = on"),
        ("[HAL]\n", "[HAL]\nPOSTGUI_HALFILE = post.tcl\n", "[HAL]POSTGUI_HALFILE"),
        ("[HAL]\n", "[APPLICATIONS]\nAPP = ./tune.sh\n[HAL]\n", "[APPLICATIONS]APP = ./tune.sh"),
        ("MAX_LIMIT = 100", "MAX_LIMIT = 100 # mm", "found \"100 # mm\""),
        ("[DELTA]", "DELTA]", "m.ini:5: found a line"),
        ("KINEMATICS = lineardeltakins", "KINEMATICS = trivkins", "found kinematics \"trivkins\""),
    ] {
        assert!(ini.contains(from), "{from}");
        let error = run(&ini.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(error.contains(told), "{to}: {error}");
    }
    let library = ini.replace("[HAL]\n", "[HAL]\nHALFILE = core_sim.hal\n");
    let imported = run(&library).unwrap();
    assert!(imported.not_carried_over.iter().any(|note| note.contains("core_sim.hal")));
    let included = ini.replace("[DELTA]\nROD = 269.5", "#INCLUDE delta.inc");
    let texts = [
        ("m.ini", included.as_str()),
        ("delta.inc", "[DELTA]\nROD = 300\n"),
        ("lineardelta.hal", hal.as_str()),
    ];
    let imported = claim(&import(linuxcnc, &texts).unwrap());
    let Leg::Slider { length, .. } = &legs(&imported)[0] else { panic!("no slider") };
    assert_eq!(*length, exactly("300"));
}

#[test]
fn the_plane_of_the_hips_is_refused() {
    let ini = file("linuxcnc/rdelta.ini").replace("MAX_LIMIT = -10", "MAX_LIMIT = 10");
    let hal = file("linuxcnc/sim_rdelta.hal");
    let error = import(linuxcnc, &[("rdelta.ini", &ini), ("sim_rdelta.hal", &hal)]).unwrap_err();
    assert!(error.to_string().contains("divides by zero"), "{error}");
}

#[test]
fn no_configuration_makes_an_importer_panic() {
    for name in ["linuxcnc/lineardelta.ini", "linuxcnc/sim_rdelta.hal", "klipper/calibrated.cfg"] {
        let text = file(name);
        for (at, c) in text.char_indices() {
            for new in ["", "\n", "[", "]", "=", "-", "#", "\\", "\u{0}", "±"] {
                let text = format!("{}{new}{}", &text[..at], &text[at + c.len_utf8()..]);
                let _ = import(orthocert::import::klipper, &[("printer.cfg", &text)]);
                let hal = file("linuxcnc/lineardelta.hal");
                let _ = import(linuxcnc, &[(name, &text), ("linuxcnc/lineardelta.hal", &hal)]);
            }
        }
    }
}
