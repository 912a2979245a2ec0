//! Rows in the twist, and accelerations, against differences of the joint coordinate, of every motion and
//! drive, by rotations that are computed with cosines and sines.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::prover::double;
use crate::rough::Rough;
use num_bigint::BigInt;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::Joint;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, Test};
use orthocert_kernel::test::curvature::Curvature;
use orthocert_kernel::test::Row;

type V = [f64; 3];
type R = [V; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn times(r: &R, b: V) -> V {
    [dot(r[0], b), dot(r[1], b), dot(r[2], b)]
}

pub fn product(a: &R, b: &R) -> R {
    let column = |k: usize| [b[0][k], b[1][k], b[2][k]];
    std::array::from_fn(|i| std::array::from_fn(|k| dot(a[i], column(k))))
}

/// By an angle about a unit axis, column by column.
fn about(axis: V, angle: f64) -> R {
    let column = |e: V| {
        let (c, s, k) = (angle.cos(), angle.sin(), dot(axis, e) * (1.0 - angle.cos()));
        let across = cross(axis, e);
        [0, 1, 2].map(|i| c * e[i] + s * across[i] + k * axis[i])
    };
    let columns = [column([1.0, 0.0, 0.0]), column([0.0, 1.0, 0.0]), column([0.0, 0.0, 1.0])];
    std::array::from_fn(|i| std::array::from_fn(|k| columns[k][i]))
}

const AXES: [V; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The rotation with these half-angle tangents.
pub fn rotation(kind: &str, c: &[f64]) -> R {
    match kind {
        "none" => AXES,
        "range" => about(AXES[2], 2.0 * c[0].atan()),
        "roll_pitch_yaw" => {
            let [x, y, z] = [0, 1, 2].map(|k| about(AXES[k], 2.0 * c[k].atan()));
            product(&z, &product(&y, &x))
        }
        _ => {
            let length = (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt();
            about([c[0], c[1], c[2]].map(|x| x / length), 2.0 * length.atan())
        }
    }
}

/// A leg's drive, with its numbers.
#[derive(Clone, Copy)]
enum Drive {
    Strut,
    Slider { n: V, length: f64, mode: f64 },
    Arm { k: V, e: V, arm: f64, length: f64, mode: f64 },
}

impl Drive {
    /// The joint coordinate, by geometry.
    fn rho(&self, w: V) -> Option<f64> {
        match *self {
            Drive::Strut => Some(dot(w, w).sqrt()),
            Drive::Slider { n, length, mode } => {
                let along = dot(n, w);
                let d = length * length - dot(w, w) + along * along;
                (d > 0.01).then(|| along - mode * d.sqrt())
            }
            Drive::Arm { k, e, arm, length, mode } => {
                let f = cross(k, e);
                let (alpha, beta) = (dot(w, e), dot(w, f));
                let reach = (dot(w, w) + arm * arm - length * length) / (2.0 * arm);
                let off = (reach / alpha.hypot(beta)).clamp(-1.0, 1.0).acos();
                if !(0.1..3.0).contains(&off) {
                    return None;
                }
                [off, -off].into_iter().map(|off| beta.atan2(alpha) + off).find(|theta| {
                    let motion = [0, 1, 2].map(|i| theta.cos() * f[i] - theta.sin() * e[i]);
                    dot(w, motion) * mode > 0.0
                })
            }
        }
    }
}

fn number(random: &mut Random, from: f64, to: f64) -> f64 {
    from + (to - from) * (random.below(1001) as f64 / 1000.0)
}

fn texts(x: &[f64]) -> String {
    let texts: Vec<String> = x.iter().map(|&x| format!("\"{}\"", decimal(x))).collect();
    texts.join(",")
}

/// Nine decimals at most.
pub fn decimal(x: f64) -> String {
    let text = format!("{x:.9}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

fn unit(a: V) -> V {
    a.map(|x| x / dot(a, a).sqrt())
}

/// A motion, by the coordinates that it has.
struct Motion {
    mechanism: &'static str,
    orientation: &'static str,
    velocity: &'static [usize],
    spin: &'static [usize],
    text: &'static str,
}

static MOTIONS: [Motion; 6] = [
    Motion { mechanism: "planar", orientation: "none", velocity: &[0, 1], spin: &[], text: "" },
    Motion {
        mechanism: "planar",
        orientation: "range",
        velocity: &[0, 1],
        spin: &[2],
        text: r#","orientation":{"range":["-80","80"]}"#,
    },
    Motion {
        mechanism: "spatial",
        orientation: "angle",
        velocity: &[0, 1, 2],
        spin: &[0, 1, 2],
        text: r#","orientation":{"angle":"120"}"#,
    },
    Motion {
        mechanism: "spatial",
        orientation: "tilt",
        velocity: &[0, 1, 2],
        spin: &[0, 1, 2],
        text: r#","orientation":{"tilt":{"tilt":"60","torsion":"60"}}"#,
    },
    Motion {
        mechanism: "spatial",
        orientation: "roll_pitch_yaw",
        velocity: &[0, 1, 2],
        spin: &[0, 1, 2],
        text: r#","orientation":{"roll_pitch_yaw":{"roll":["-50","80"],"pitch":["-50","80"],"yaw":["-80","50"]}}"#,
    },
    Motion {
        mechanism: "spherical",
        orientation: "angle",
        velocity: &[],
        spin: &[0, 1, 2],
        text: r#","orientation":{"angle":"120"}"#,
    },
];

/// A motion from a pose, with these velocities and accelerations at time 0.
struct Moved {
    p: V,
    r: R,
    velocity: [V; 2],
    acceleration: [V; 2],
}

impl Moved {
    fn random(random: &mut Random, motion: &Motion, (p, r): (V, R)) -> Self {
        let mut vector = |components: &[usize]| {
            let mut v = [0.0; 3];
            components.iter().for_each(|&k| v[k] = number(random, -1.0, 1.0));
            v
        };
        let mut both = || [vector(motion.velocity), vector(motion.spin)];
        Moved { p, r, velocity: both(), acceleration: both() }
    }

    fn at(&self, t: f64) -> (V, R) {
        let [by, angles] = [0, 1].map(|i| {
            [0, 1, 2].map(|k| self.velocity[i][k] * t + self.acceleration[i][k] * t * t / 2.0)
        });
        let angle = dot(angles, angles).sqrt();
        let turned = match angle > 0.0 {
            true => product(&about(angles.map(|x| x / angle), angle), &self.r),
            false => self.r,
        };
        ([0, 1, 2].map(|k| self.p[k] + by[k]), turned)
    }

    /// `M_i . x' + x^T H x`, in the problem's unit.
    fn asked(
        &self,
        motion: &Motion,
        test: &Curvature,
        of: impl Fn(Formula) -> f64,
        unit: f64,
    ) -> f64 {
        let twist = |[linear, angular]: &[V; 2]| -> Vec<f64> {
            let linear = motion.velocity.iter().map(|&k| linear[k] / unit);
            linear.chain(motion.spin.iter().map(|&k| 1.5 / unit * angular[k])).collect()
        };
        let (x, x_dot) = (twist(&self.velocity), twist(&self.acceleration));
        let first: f64 = test.row.iter().zip(&x_dot).map(|(&f, x)| of(f) * x).sum();
        let mut twice = 0.0;
        for (i, entries) in test.twice.iter().enumerate() {
            for (j, &f) in (i..).zip(entries) {
                twice += of(f) * x[i] * x[j] * if i == j { 1.0 } else { 2.0 };
            }
        }
        first + twice / 2.0
    }
}

/// A leg of a motion, its text and its numbers.
fn leg(random: &mut Random, motion: &Motion, which: usize) -> Drawn {
    let plane = motion.mechanism == "planar";
    let mut vector = |size: f64| -> V {
        let v = [0; 3].map(|_: i64| number(random, -size, size));
        if plane {
            [v[0], v[1], 0.0]
        } else {
            v
        }
    };
    let components = if plane { 2 } else { 3 };
    let (a, b, n, e) = (vector(1.5), vector(0.8), unit(vector(1.0)), vector(1.0));
    let ends = format!(
        r#""anchor":[{}],"platform":[{}]"#,
        texts(&a[..components]),
        texts(&b[..components])
    );
    let sign = random.below(2) == 0;
    let (mode, text) = if sign { (1.0, "+") } else { (-1.0, "-") };
    let length = number(random, 1.5, 3.0);
    let (drive, own) = match which {
        0 => (Drive::Strut, r#""drive":"strut""#.to_owned()),
        1 => {
            let n_text = texts(&n[..components]);
            let own = format!(
                r#""drive":"slider","direction":[{n_text}],"length":"{}","mode":"{text}""#,
                decimal(length)
            );
            (Drive::Slider { n, length, mode }, own)
        }
        _ => {
            let k = if plane { AXES[2] } else { n };
            let axis = if plane { String::new() } else { texts(&k) };
            let across = [0, 1, 2].map(|i| e[i] - dot(k, e) * k[i]);
            let own = format!(
                r#""drive":"arm","axis":[{axis}],"reference":[{}],"arm":"1","length":"{}","mode":"{text}""#,
                texts(&e[..components]),
                decimal(length)
            );
            (Drive::Arm { k, e: unit(across), arm: 1.0, length, mode }, own)
        }
    };
    let (drive_text, rest) = own.split_once(',').map_or((own.as_str(), ""), |(d, r)| (d, r));
    let comma = if rest.is_empty() { "" } else { "," };
    (format!("{{{drive_text},{ends}{comma}{rest}}}"), [a, b], drive)
}

/// A leg, its text, its ends and its drive.
type Drawn = (String, [V; 2], Drive);

/// A motion with as many legs of one drive as it has coordinates; which drive that is.
fn machine(random: &mut Random, round: usize) -> (&'static Motion, usize, Vec<Drawn>) {
    let motion = &MOTIONS[round % MOTIONS.len()];
    let which = if motion.mechanism == "spherical" { 0 } else { round / MOTIONS.len() % 3 };
    let m = motion.velocity.len() + motion.spin.len();
    (motion, which, (0..m).map(|_| leg(random, motion, which)).collect())
}

/// The texts of legs, and what follows them.
fn written(motion: &Motion, legs: &[Drawn]) -> (String, &'static str) {
    let text: Vec<&str> = legs.iter().map(|leg| leg.0.as_str()).collect();
    let ell = if motion.spin.is_empty() { "" } else { r#","characteristic_length":"3/2""# };
    (text.join(","), ell)
}

#[test]
fn rows_are_derivatives_in_the_twist() {
    let mut random = Random(11);
    let (mut reached, mut curved) = (0, 0);
    for round in 0..360 {
        let (motion, which, legs) = machine(&mut random, round);
        let m = legs.len();
        let (text, ell) = written(motion, &legs);
        let stroke = match which {
            0 => {
                r#"{"quantity":"joint_range","end":"min","bound":"1/2"},{"quantity":"joint_speed","given":{"tool":["2"]},"end":"max","bound":"3"},"#
            }
            _ => "",
        };
        let require = format!(
            r#"{stroke}{{"quantity":"joint_acceleration","given":{{"acceleration":["1"],"speed":["1"]}},"end":"max","bound":"1"}}"#
        );
        let corner = |x: &str| vec![format!("\"{x}\""); motion.velocity.len()].join(",");
        let claim = claim(&format!(
            r#"{{"mechanism":{{"{}":{{"legs":[{}]{ell}}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}}{},"require":[{require}]}}"#,
            motion.mechanism,
            text,
            corner("-1"),
            corner("1"),
            motion.text
        ));
        let problem = Problem::new(&claim).expect("a claim");
        assert_eq!(problem.dimension(), m);
        let unit = (problem.scale as f64).exp2();
        let parameters = problem.parameters::<BigInt>(96, &[]).expect("numbers");
        let mut p = [0.0; 3];
        motion.velocity.iter().for_each(|&k| p[k] = number(&mut random, -1.0, 1.0));
        let c: Vec<f64> = motion.spin.iter().map(|_| number(&mut random, -0.7, 0.7)).collect();
        let coordinate = |k: usize| {
            let x = *motion.velocity.get(k).map(|&k| &p[k]).unwrap_or(&0.0) / unit;
            let x = if k < motion.velocity.len() { x } else { c[k - motion.velocity.len()] };
            Some((x, x))
        };
        let values = problem.tape.run(&Rough, coordinate, |j| Some(double(&parameters[j], 96)));
        let of = |f: Formula| values.of(f).map(|x| x.0);
        let r = rotation(motion.orientation, &c);
        for (i, (own, (_, [a, b], drive))) in problem.legs.iter().zip(&legs).enumerate() {
            let rho = |p: V, r: &R| {
                let b = times(r, *b);
                drive.rho([0, 1, 2].map(|k| p[k] + b[k] - a[k]))
            };
            let Some(expected) = rho(p, &r) else { continue };
            let (found, per) = match own.rho.expect("a joint") {
                Joint::Length(rho) => (of(rho).expect("reached") * unit, 1.0),
                Joint::Angle { cos, sin } => {
                    (of(sin).expect("reached").atan2(of(cos).expect("reached")), unit)
                }
            };
            let turns = ((found - expected) / std::f64::consts::TAU).round();
            let turns = if per == 1.0 { 0.0 } else { turns * std::f64::consts::TAU };
            assert!((found - expected - turns).abs() < 1e-6, "{found} {expected}");
            let row: Vec<f64> = own.divided.a.iter().map(|&f| of(f).expect("a row")).collect();
            assert_eq!(row.len(), m);
            let h = 1e-6;
            let change = |move_by: &dyn Fn(f64) -> (V, R)| {
                let [(p, r), (q, s)] = [move_by(h), move_by(-h)];
                Some((rho(p, &r)? - rho(q, &s)?) / (2.0 * h))
            };
            let mut changes = Vec::new();
            for &k in motion.velocity {
                changes.push(change(&|h| {
                    let mut p = p;
                    p[k] += h;
                    (p, r)
                }));
            }
            for &k in motion.spin {
                // Of a twist whose second part is ell omega.
                changes.push(change(&|h| (p, product(&about(AXES[k], h / 1.5), &r))));
            }
            for (found, expected) in row.iter().zip(&changes) {
                let Some(expected) = expected else { continue };
                assert!(
                    expected.abs() > 1e5
                        || (found / per - expected).abs() < 1e-5 * (1.0 + expected.abs()),
                    "{found} {expected}"
                );
            }
            let test = problem.obligations.iter().find_map(|o| match &o.test {
                Test::Curvature(test) if o.leg == Some(i) => Some(test),
                _ => None,
            });
            assert_eq!(test.is_some(), !motion.spin.is_empty() || which == 2);
            if let Some(test) = test.filter(|_| !motion.spin.is_empty()) {
                assert_eq!(test.lever.is_some(), which == 0);
                if let Some(lever) = test.lever {
                    let [square, s] = lever.map(|f| of(f).expect("a lever"));
                    let length: f64 = row.iter().map(|x| x * x).sum();
                    assert!((square - s * s - length).abs() < 1e-9 * (1.0 + length), "{length}");
                }
                let moved = Moved::random(&mut random, motion, (p, r));
                let at = |t: f64| moved.at(t);
                let h = 1e-4;
                let all = [-h, 0.0, h].map(|t| rho(at(t).0, &at(t).1));
                if let [Some(before), Some(now), Some(after)] = all {
                    let expected = (before - 2.0 * now + after) / (h * h);
                    let found = moved.asked(motion, test, |f| of(f).expect("H"), unit);
                    let found = if per == 1.0 { found * unit } else { found };
                    if expected.abs() < 100.0 {
                        assert!(
                            (found - expected).abs() < 1e-3 * (1.0 + expected.abs()),
                            "{found} {expected}"
                        );
                        curved += 1;
                    }
                }
            }
            let d = of(own.row.d).expect("D");
            for (k, &a) in own.row.a.iter().enumerate() {
                let quotient = of(a).expect("A").powi(2) / d;
                assert!((quotient - row[k].powi(2)).abs() < 1e-9 * (1.0 + quotient), "A and D");
            }
            if let Some(scaled) = &own.scaled {
                let w = of(problem.weight.expect("a weight")).expect("w");
                for (&f, &a) in scaled.a.iter().zip(&own.row.a) {
                    assert!((of(f).expect("w A") - w * of(a).expect("A")).abs() < 1e-9);
                }
                assert!((of(scaled.d).expect("w D") - w * d).abs() < 1e-9);
                // Of the strokes: w (rho^2 - min^2), in the problem's unit.
                let Test::AtLeast(f) = problem.obligations[1 + i].test else { panic!("a sign") };
                let most = w * (expected.powi(2) - 0.25) / unit.powi(2);
                assert!((of(f).expect("a stroke") - most).abs() < 1e-6, "{most}");
                // Of the speeds: w ell^2 (k^2 - |row|^2), whatever that is.
                let Test::Least(rows, bound) = &problem.obligations[1 + m + i].test else {
                    panic!("a lever")
                };
                let [Row { a, d }] = rows.as_slice() else { panic!("one row") };
                let along = of(a[0]).expect("w r . A").powi(2) / of(*d).expect("w D");
                let square: f64 = row.iter().map(|x| x * x).sum();
                let expected = w * (1.5 / unit).powi(2) * (1.5f64.powi(2) - square);
                let found = along - of(*bound).expect("w c");
                assert!(
                    (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                    "{found} {expected}"
                );
            }
            assert_eq!(own.scaled.is_some(), which == 0 && !motion.spin.is_empty());
            reached += 1;
        }
    }
    assert!(reached > 900 && curved > 700, "{reached} {curved}");
}

/// Where joints and bodies are, against the pose itself, of every motion and drive.
#[test]
fn joints_and_bodies_are_where_the_pose_puts_them() {
    let mut random = Random(17);
    let (mut angles, mut segments) = ([0; 3], 0);
    for round in 0..360 {
        let (motion, _, legs) = machine(&mut random, round);
        let (text, ell) = written(motion, &legs);
        let plane = motion.mechanism == "planar";
        let mut vector = || {
            let v: V = [0; 3].map(|_: i64| number(&mut random, -1.0, 1.0));
            if plane {
                [v[0], v[1], 0.0]
            } else {
                v
            }
        };
        let (axis, from, to) = (vector(), vector(), vector());
        let bound = [70.0, 90.0, 120.0][round / 18 % 3];
        let axis_text = texts(&axis[..if plane { 2 } else { 3 }]);
        let joint = |key: &str| {
            format!(
                r#"{{"quantity":"{key}","leg":1,"given":{{"axis":[{axis_text}]}},"end":"max","bound":"{}"}}"#,
                decimal(bound)
            )
        };
        let corner = |x: &str| vec![format!("\"{x}\""); motion.velocity.len()].join(",");
        let claim = claim(&format!(
            r#"{{"mechanism":{{"{}":{{"legs":[{}]{ell}}}}},"bodies":[{{"on":"leg","leg":1,"radius":"1/8","trim":["1/8","1/4"]}},{{"on":"platform","from":[{}],"to":[{}],"radius":"1/8"}}],"workspace":{{"box":{{"min":[{}],"max":[{}]}}}}{},"require":[{},{},{{"quantity":"clearance","end":"min","bound":"1/4"}}]}}"#,
            motion.mechanism,
            text,
            texts(&from),
            texts(&to),
            corner("-1"),
            corner("1"),
            motion.text,
            joint("base_joint"),
            joint("platform_joint"),
        ));
        let problem = Problem::new(&claim).expect("a claim");
        let unit = (problem.scale as f64).exp2();
        let mut p = [0.0; 3];
        motion.velocity.iter().for_each(|&k| p[k] = number(&mut random, -1.0, 1.0));
        let c: Vec<f64> = motion.spin.iter().map(|_| number(&mut random, -0.7, 0.7)).collect();
        let x: Vec<f64> = motion.velocity.iter().map(|&k| p[k] / unit).chain(c.clone()).collect();
        let parameters = problem.parameters::<BigInt>(96, &[]).expect("numbers");
        let values = problem.tape.run(
            &Rough,
            |k| x.get(k).map(|&x| (x, x)),
            |j| Some(double(&parameters[j], 96)),
        );
        let of = |f: Formula| values.of(f).map(|x| (x.0 + x.1) / 2.0);
        let r = rotation(motion.orientation, &c);
        let (_, [a, b], drive) = &legs[0];
        let plus = |a: V, s: f64, b: V| [0, 1, 2].map(|k| a[k] + s * b[k]);
        let tip = plus(p, 1.0, times(&r, *b));
        let w = plus(tip, -1.0, *a);
        let Some(rho) = drive.rho(w) else { continue };
        let own = match *drive {
            Drive::Strut => w,
            Drive::Slider { n, .. } => plus(w, -rho, n),
            Drive::Arm { k, e, arm, .. } => {
                plus(plus(w, -arm * rho.cos(), e), -arm * rho.sin(), cross(k, e))
            }
        };
        let length = dot(own, own).sqrt();
        let back: R = std::array::from_fn(|i| std::array::from_fn(|k| r[k][i]));
        let seen = [own, times(&back, own)];
        for (requirement, seen) in seen.into_iter().enumerate() {
            let cos = dot(seen, axis) / length / dot(axis, axis).sqrt();
            let expected = cos.clamp(-1.0, 1.0).acos().to_degrees();
            let tests = problem.obligations.iter().filter(|o| o.requirement == Some(requirement));
            let mut holds = true;
            for Obligation { test, .. } in tests {
                holds &= match test {
                    Test::AtLeast(f) => of(*f).expect("a sign") >= 0.0,
                    Test::Greatest(rows, k) => {
                        angles[1] += 1;
                        let [row] = rows.as_slice() else { panic!("one row") };
                        let square: f64 =
                            row.a.iter().map(|&a| of(a).expect("a row").powi(2)).sum();
                        square <= of(row.d).expect("D") * of(*k).expect("a bound")
                    }
                    other => panic!("{other:?}"),
                };
            }
            if (expected - bound).abs() > 1e-3 {
                assert_eq!(holds, expected < bound, "{expected} {bound}");
                angles[if holds { 0 } else { 2 }] += 1;
            }
        }
        let Some(Test::Apart(test)) = problem.obligations.last().map(|o| &o.test) else {
            panic!("a distance")
        };
        let expected = [
            [plus(p, 1.0, times(&r, from)), plus(p, 1.0, times(&r, to))],
            [plus(plus(tip, -1.0, own), 0.125 / length, own), plus(tip, -0.25 / length, own)],
        ];
        for (ends, expected) in test.ends.iter().zip(expected) {
            for (end, expected) in ends.iter().zip(expected) {
                for (&f, expected) in end.iter().zip(expected) {
                    let found = of(f).expect("an end") * unit;
                    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
                }
            }
        }
        segments += 1;
    }
    assert!(angles.iter().all(|&n| n > 50) && segments > 150, "{angles:?} {segments}");
}

#[test]
fn tilt_sets_are_tilts_and_torsions() {
    // R_z(a) R_y(b) R_z(s - a) has c_1^2 + c_2^2 = tan(b/2)^2 (1 + c_3^2) and c_3 = tan(s/2).
    let mut random = Random(13);
    for _ in 0..200 {
        let a = number(&mut random, -3.0, 3.0);
        let (b, s) = (number(&mut random, 0.1, 2.0), number(&mut random, -2.0, 2.0));
        let r = product(&about(AXES[2], a), &product(&about(AXES[1], b), &about(AXES[2], s - a)));
        let q0 = (1.0 + r[0][0] + r[1][1] + r[2][2]).sqrt() / 2.0;
        let c =
            [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|x| x / (4.0 * q0 * q0));
        let most = (b / 2.0).tan().powi(2) * (1.0 + c[2] * c[2]);
        assert!((c[0] * c[0] + c[1] * c[1] - most).abs() < 1e-9 * (1.0 + most));
        assert!((c[2] - (s / 2.0).tan()).abs() < 1e-9 * (1.0 + c[2].abs()));
    }
}

/// Its cosine is not 0, which the sign alone would take it for.
#[test]
fn an_angle_at_a_joint_of_nearly_90_degrees_has_both_tests() {
    let tests = |bound: &str| {
        let strut = |x: &str| {
            format!(r#"{{"drive":"strut","anchor":["{x}","-2"],"platform":["{x}","0"]}}"#)
        };
        let claim = claim(&format!(
            r#"{{"mechanism":{{"planar":{{"legs":[{},{},{}],"characteristic_length":"1"}}}},"workspace":{{"box":{{"min":["0","0"],"max":["1","1"]}}}},"orientation":{{"range":["-1","1"]}},"require":[{{"quantity":"base_joint","leg":1,"given":{{"axis":["0","1"]}},"end":"max","bound":"{bound}"}}]}}"#,
            strut("-1"),
            strut("0"),
            strut("1"),
        ));
        Problem::new(&claim).expect("a claim").obligations.len()
    };
    let nearly = "90-sqrt(2)/10^64/10^64/10^64";
    assert_eq!(["89", nearly, "90", "91"].map(tests), [3, 3, 2, 2]);
}
