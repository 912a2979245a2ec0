//! False claims of platforms that turn: evidence of every nesting, on cells that hold a pose at which
//! the claim fails, is refused.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::motions::{decimal, rotation};
use crate::prover::{Prover, BITS};
use crate::turning::{planar, spatial, spherical, strut};
use nalgebra::DMatrix;
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::step::Checker;
use orthocert_kernel::test::{Multiplier, Over, Place};

const PLACES: u32 = 20;

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.below(1_000_001) as f64 / 1e6
}

/// Struts between points at random, of so many coordinates.
fn struts(random: &mut Random, n: usize, m: usize) -> Vec<String> {
    let mut point = |reach: f64| {
        let x: Vec<String> = (0..m)
            .map(|_| {
                format!("\"{}\"", decimal((between(random, -reach, reach) * 1e3).round() / 1e3))
            })
            .collect();
        x.join(",")
    };
    (0..n).map(|_| strut(&point(1.5), &point(1.0))).collect()
}

/// A machine at random, with these requirements.
fn machine(kind: u64, random: &mut Random) -> Box<dyn Fn(&str) -> String> {
    let angle = |random: &mut Random, most: f64| decimal(between(random, 1.0, most).round());
    let set = match random.below(3) {
        0 => format!(r#"{{"angle":"{}"}}"#, angle(random, 150.0)),
        1 => format!(
            r#"{{"tilt":{{"tilt":"{}","torsion":"{}"}}}}"#,
            angle(random, 120.0),
            angle(random, 150.0)
        ),
        _ => {
            let mut range = || {
                let a = angle(random, 170.0);
                format!(r#"["-{}","{a}"]"#, angle(random, 170.0))
            };
            format!(
                r#"{{"roll_pitch_yaw":{{"roll":{},"pitch":{},"yaw":{}}}}}"#,
                range(),
                range(),
                range()
            )
        }
    };
    match kind {
        0 => {
            let n = 3 + random.below(2) as usize;
            let legs = struts(random, n, 2);
            let range = format!(r#""-{}","{}""#, angle(random, 170.0), angle(random, 170.0));
            Box::new(move |require| {
                planar(&legs, [r#""-0.5","-0.5""#, r#""0.5","0.5""#], &range, require)
            })
        }
        1 => Box::new(move |require| spherical(&set, require)),
        _ => {
            let n = 6 + random.below(2) as usize;
            let legs = struts(random, n, 3);
            let round = random.below(2) == 0;
            Box::new(move |require| {
                let text = spatial(&legs, &set, require);
                let square = r#"{"box":{"min":["-0.2","-0.2","0.8"],"max":["0.2","0.2","1.2"]}}"#;
                let disc =
                    r#"{"cylinder":{"center":["0.01","-0.02"],"radius":"0.25","z":["0.8","1.2"]}}"#;
                if round {
                    text.replace(square, disc)
                } else {
                    text
                }
            })
        }
    }
}

/// `a |M_1| + b |H_1|` at a pose, by the formulas of an acceleration.
fn curved(text: &str, x: &[f64]) -> f64 {
    let stated = claim(text);
    let problem = Problem::new(&stated).expect("a claim");
    let prover = Prover::new(&problem);
    let values = prover.values(x);
    let of = |f| values.of(f).expect("defined").0;
    let Some(Test::Curvature(test)) = problem.obligations.last().map(|own| &own.test) else {
        panic!("an acceleration");
    };
    let n = test.row.len();
    let entry = |i: usize, j: usize| 0.5 * of(test.twice[i.min(j)][i.abs_diff(j)]);
    let h = nalgebra::SymmetricEigen::new(DMatrix::from_fn(n, n, entry));
    let square: f64 = test.row.iter().map(|&f| of(f).powi(2)).sum();
    of(test.a) * square.sqrt() + of(test.b) * h.eigenvalues.amax()
}

/// The angles of the first leg, in degrees, with an axis in the base and on the platform: the last one
/// that there is.
fn joints(problem: &Problem, x: &[f64]) -> [f64; 2] {
    let prover = Prover::new(problem);
    let values = prover.values(x);
    let leg = &problem.legs[0];
    let vector = leg.vector.expect("a strut").map(|f| values.of(f).expect("defined").0);
    let (m, kind) = (problem.dimension(), problem.orientation.len());
    let r = match (kind, problem.turned) {
        (1, _) => rotation("range", &x[m - 1..]),
        (_, None) => rotation("roll_pitch_yaw", &x[m - 3..]),
        _ => rotation("angle", &x[m - 3..]),
    };
    let last = if kind == 1 { 1 } else { 2 };
    let axes = [[0, 1, 2].map(|k| f64::from(u8::from(k == last))), r.map(|row| row[last])];
    let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    axes.map(|axis| {
        let along: f64 = axis.iter().zip(vector).map(|(a, b)| a * b).sum();
        (along / norm).acos().to_degrees()
    })
}

/// `A_i/D_i` at a pose, of columns of the inverse `A_i`, scaled by a part of it: the best `Y` is near.
fn multiplier(
    prover: &Prover<'_>,
    x: &[f64],
    (divided, column): (bool, bool),
    random: &mut Random,
) -> Option<Multiplier> {
    let values = prover.values(x);
    let part = between(random, 0.5, 1.1);
    let scale = f64::from(PLACES).exp2() * part;
    let row = |leg: &orthocert_kernel::machine::Leg| {
        let row = if divided { &leg.divided } else { &leg.row };
        let d = if column { 1.0 } else { values.of(row.d)?.0 };
        row.a.iter().map(|&a| Some((values.of(a)?.0 / d * scale) as i64)).collect::<Option<_>>()
    };
    let y = prover.problem.legs.iter().map(row).collect::<Option<_>>()?;
    Some(Multiplier { y, places: PLACES })
}

fn nested(plain: &Evidence, random: &mut Random) -> Evidence {
    let mut mu = |e: Evidence, wrap: fn(Box<Evidence>, i64, u32) -> Evidence| {
        let most = 1 << random.below(24);
        wrap(Box::new(e), random.below(most) as i64, 18)
    };
    let inside = mu(plain.clone(), Evidence::Inside);
    let turned = mu(plain.clone(), Evidence::Turned);
    let both = mu(inside.clone(), Evidence::Turned);
    let all = [plain.clone(), inside, turned, both];
    let one = all[random.below(4) as usize].clone();
    if random.below(2) == 0 {
        Evidence::Control(Box::new(one))
    } else {
        one
    }
}

#[test]
fn nothing_shows_what_fails_at_a_pose_of_the_cell() {
    let mut random = Random(77);
    let (mut tried, mut shown, mut columns) = (0, [0usize; 2], [0usize; 3]);
    let (mut others, mut cones_shown) = ([0usize; 2], [0usize; 2]);
    for round in 0..18 {
        let text = machine(round % 3, &mut random);
        let free = claim(&text(""));
        let problem = Problem::new(&free).expect("a claim");
        let prover = Prover::new(&problem);
        let ranges = prover.ranges();
        let pose = |random: &mut Random| -> Vec<f64> {
            ranges.iter().map(|&(l, h)| between(random, l, h)).collect()
        };
        let Some(x) = (0..200).map(|_| pose(&mut random)).find(|x| prover.is_inside(x)) else {
            continue;
        };
        let Some(m) = prover.matrix(&x) else { continue };
        let m: DMatrix<f64> = m;
        let sigma = m.singular_values();
        let (least, greatest) = (sigma.min(), sigma.max());
        if least < 1e-3 {
            continue;
        }
        let unit = (problem.scale as f64).exp2();
        let rho = prover.values(&x);
        let length = rho.of(problem.legs[0].length.expect("a strut")).expect("defined").0 * unit;
        let acceleration = |bound: &str| {
            format!(
                r#"{{"quantity":"joint_acceleration","leg":1,"given":{{"acceleration":["1"],"speed":["1"]}},"end":"max","bound":"{bound}"}}"#
            )
        };
        let curved = curved(&text(&acceleration("1")), &x);
        let inverse = m.is_square().then(|| m.clone().try_inverse()).flatten();
        let column = inverse.map(|inverse| inverse.column(0).norm());
        let joints = joints(&problem, &x);
        // `part < 1`: false at the pose; `part > 1`: true there, and shown on small cells.
        for part in [0.999, 1.3] {
            let require = format!(
                r#"{{"quantity":"transmission","end":"max","bound":"{}"}},{{"quantity":"transmission","end":"min","bound":"{}"}},{{"quantity":"conditioning","end":"max","bound":"{}"}},{{"quantity":"joint_range","leg":1,"end":"max","bound":"{}"}},{{"quantity":"joint_range","leg":1,"end":"min","bound":"{}"}}"#,
                decimal(part / least),
                decimal(1.0 / part / greatest),
                decimal((part * greatest / least).max(1.0001)),
                decimal(part * length),
                decimal(length / part),
            );
            let mut require = format!("{require},{}", acceleration(&decimal(part * curved)));
            let row = m.row(0).norm();
            require += &format!(
                r#",{{"quantity":"joint_speed","leg":1,"given":{{"tool":["1"]}},"end":"max","bound":"{}"}},{{"quantity":"stiffness","given":{{"joint":["2"]}},"end":"min","bound":"{}"}}"#,
                decimal(part * row),
                decimal(2.0 * least * least / part),
            );
            if let Some(column) = column {
                require += &format!(
                    r#",{{"quantity":"joint_force","leg":1,"given":{{"tool":["1"]}},"end":"max","bound":"{}"}}"#,
                    decimal(part * column)
                );
            }
            let bounds = joints.map(|angle| (part * angle).min(179.0));
            let axis = if round % 3 == 0 { r#""0","1""# } else { r#""0","0","1""# };
            for (key, bound) in ["base_joint", "platform_joint"].into_iter().zip(bounds) {
                require += &format!(
                    r#",{{"quantity":"{key}","leg":1,"given":{{"axis":[{axis}]}},"end":"max","bound":"{}"}}"#,
                    decimal(bound)
                );
            }
            if part < 1.0 && greatest / least < 1.002 {
                continue;
            }
            let stated = claim(&text(&require));
            let problem = Problem::new(&stated).expect("a claim");
            let prover = Prover::new(&problem);
            let fixed = Fixed::<i64>::new(BITS);
            let parameters = problem.parameters(BITS, &[]).expect("parameters");
            let exact = Checker::new(&problem, &fixed, parameters, None);
            let root = problem.root::<i64>(BITS).expect("a box");
            let scale = f64::from(BITS).exp2();
            for _ in 0..6 {
                let size = (-1.0 - random.below(9) as f64).exp2();
                let edge = |(x, root): (&f64, &Interval<i64>)| {
                    let below = between(&mut random, 0.0, size) * scale;
                    let above = between(&mut random, 0.0, size) * scale;
                    let end = |x: f64| x as i64;
                    Interval {
                        lo: end(x * scale - below).max(root.lo),
                        hi: end(x * scale + above + 1.0).min(root.hi),
                    }
                };
                let cell = Cell(x.iter().zip(&root.0).map(edge).collect());
                let edges = cell.edges().expect("edges");
                let values = exact.evaluate(&edges);
                let slopes = Slopes::new(&fixed, edges.len());
                let place = Place::new(&edges, [false; 2]);
                let over = Over::new(&place, slopes, &values);
                assert!(!exact.is_outside(&over), "{cell:?}");
                for obligation in &problem.obligations {
                    // The sign that goes with a cone may be right where the angle is not.
                    let joint = obligation.requirement.map(|r| &stated.require[r].quantity);
                    let joint = joint.is_some_and(|quantity| quantity.ends_with("_joint"));
                    let cones = bounds.iter().any(|&bound| bound <= 90.0);
                    if joint && cones && matches!(obligation.test, Test::AtLeast(_)) {
                        continue;
                    }
                    for _ in 0..6 {
                        let divided = random.below(4) == 0;
                        let column = matches!(obligation.test, Test::Solve(_));
                        let form = (divided && !column, column);
                        let Some(y) = multiplier(&prover, &x, form, &mut random) else {
                            continue;
                        };
                        let plain = match &obligation.test {
                            Test::SigmaMin(_) if divided => Evidence::LowerDivided(y),
                            Test::SigmaMin(_) | Test::Solve(_) | Test::Least(..) => {
                                Evidence::Lower(y)
                            }
                            Test::SigmaMax(_) if divided => Evidence::Divided,
                            Test::Conditioning(_) => {
                                let mu = least * least * f64::from(PLACES).exp2();
                                let mut mu = vec![(mu * between(&mut random, 0.6, 1.0)) as i64];
                                for _ in &x {
                                    let most = mu[0] as f64 * between(&mut random, 0.0, 0.2);
                                    mu.push((most * between(&mut random, -1.0, 1.0)) as i64);
                                }
                                Evidence::Conditioning(y, mu)
                            }
                            _ => Evidence::Test,
                        };
                        let evidence = nested(&plain, &mut random);
                        let is = exact.shows(&over, &obligation.test, &evidence);
                        let at = usize::from(matches!(evidence, Evidence::Control(_)));
                        tried += 1;
                        shown[at] += usize::from(is);
                        columns[at] += usize::from(is && column);
                        cones_shown[at] += usize::from(is && joint);
                        let other = matches!(obligation.test, Test::Least(..) | Test::Greatest(..));
                        others[at] += usize::from(is && other);
                        columns[2] +=
                            usize::from(is && matches!(obligation.test, Test::Curvature(_)));
                        assert!(!is || part > 1.0, "{} {evidence:?} {cell:?}", text(&require));
                    }
                }
            }
        }
    }
    assert!(shown.iter().all(|&n| n > 100), "{tried} {shown:?}");
    assert!(others.iter().all(|&n| n > 10), "{others:?}");
    assert!(cones_shown.iter().all(|&n| n > 10), "{cones_shown:?}");
    assert!(columns.iter().all(|&n| n > 10), "{columns:?}");
}
