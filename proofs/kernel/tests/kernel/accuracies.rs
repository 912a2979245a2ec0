//! Accuracy against machines that are built and positioned in doubles.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::false_claims::never_shown;
use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::motions::{product, rotation};
use crate::prover::{certify, double, Prover, BITS};
use crate::quantities::{about, number, rounded, Asked, End, SLAB, TWO_SLIDERS};
use crate::rough::{Pair, Rough};
use crate::turning::{hexapod_legs, on_circle, planar, spatial, spherical, strut};
use nalgebra::{DMatrix, DVector};
use num_bigint::BigInt;
use orthocert_kernel::cell::{Cell, Vertex};
use orthocert_kernel::certificate::{Evidence, Failure, Proof, Step};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Bound, Leg, MachineClaim, Mechanism, Quantity};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::Joint;
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::step::Checker;
use orthocert_kernel::test::accuracy::{near, spread, Accuracy, Shown};
use orthocert_kernel::test::{Multiplier, Over, Place};

/// The machine with a tolerance of so much either way on each length and, but for arms, on each
/// coordinate of the anchors; of struts of platforms that turn, of the platform also.
fn toleranced(machine: &MachineClaim, half: f64) -> MachineClaim {
    let wide = |x: &mut Quantity| {
        let Quantity::Exactly(middle) = x.clone() else { return };
        let end =
            |operator| Expression::Binary(operator, middle.clone().into(), number(half).into());
        *x = Quantity::Between { min: end(Operator::Sub), max: end(Operator::Add) };
    };
    let mut machine = machine.clone();
    let turns = machine.orientation.is_some();
    let legs = match &mut machine.mechanism {
        Mechanism::Translational(legs) => legs.iter_mut(),
        Mechanism::Planar(own) | Mechanism::Spatial(own) | Mechanism::Spherical(own) => {
            own.legs.iter_mut()
        }
        _ => [].iter_mut(),
    };
    for leg in legs {
        match leg {
            Leg::Slider { anchor, length, .. } => {
                wide(length);
                anchor.iter_mut().for_each(wide);
            }
            Leg::Strut { anchor, platform, .. } => {
                anchor.iter_mut().for_each(wide);
                platform.iter_mut().filter(|_| turns).for_each(wide);
            }
            Leg::Arm { arm, length, .. } => {
                wide(arm);
                wide(length);
            }
            Leg::Planar { .. } => {}
        }
    }
    // As read from a certificate: canonical.
    let text = serde_json::to_string(&machine).expect("a text");
    claim(&text)
}

/// Small differences of joint coordinates, of which angles are up to whole turns.
fn turned(difference: DVector<f64>) -> DVector<f64> {
    let turn = std::f64::consts::TAU;
    difference.map(|x| if x.abs() > 3.0 { x - turn * (x / turn).round() } else { x })
}

/// The values of the machine in the middle of the tolerance.
fn middle(problem: &Problem) -> Vec<Expression> {
    let all = problem.tolerances().map(|(_, min, max)| {
        let sum = Expression::Binary(Operator::Add, min.clone().into(), max.clone().into());
        Expression::Binary(Operator::Div, sum.into(), Expression::integer(2).into())
    });
    all.collect()
}

/// A machine of the tolerance, in doubles, by its values.
struct Built<'a> {
    problem: &'a Problem,
    parameters: Vec<Pair>,
}

impl<'a> Built<'a> {
    fn new(problem: &'a Problem, values: &[Expression]) -> Self {
        let parameters = problem.parameters::<BigInt>(96, values).expect("a machine");
        let middle = |x| {
            let (lo, hi): (f64, f64) = double(x, 96);
            ((lo + hi) / 2.0, (lo + hi) / 2.0)
        };
        Built { problem, parameters: parameters.iter().map(middle).collect() }
    }

    /// Of each quantity with two ends, the machines that have these and else the middle.
    fn changes(&self) -> Vec<Both<'a>> {
        let middle = middle(self.problem);
        let ends = self.problem.tolerances().map(|(_, min, max)| [min.clone(), max.clone()]);
        let both = |(j, ends): (usize, [Expression; 2])| {
            let built = ends.each_ref().map(|end| {
                let mut values = middle.clone();
                values[j] = end.clone();
                Built::new(self.problem, &values)
            });
            Both { ends, built }
        };
        ends.enumerate().map(both).collect()
    }

    fn at(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let values = self.problem.tape.run(
            &Rough,
            |k| x.get(k).map(|&x| (x, x)),
            |j| Some(self.parameters[j]),
        );
        let of = |f| values.of(f).expect("within reach").0;
        let n = x.len();
        let rho = |i: usize| match self.problem.legs[i].rho.expect("a joint") {
            Joint::Length(rho) => of(rho),
            Joint::Angle { cos, sin } => of(sin).atan2(of(cos)),
        };
        let entry = |i: usize, k: usize| of(self.problem.legs[i].divided.a[k]);
        (DVector::from_fn(n, |i, _| rho(i)), DMatrix::from_fn(n, n, entry))
    }

    /// Where the machine is with these joint coordinates, by Newton's method from `x`.
    fn position(&self, x: &[f64], rho: &DVector<f64>) -> Vec<f64> {
        let mut y = x.to_vec();
        for _ in 0..30 {
            let (own, m) = self.at(&y);
            let step = m.lu().solve(&turned(rho - own)).expect("regular");
            y.iter_mut().zip(step.iter()).for_each(|(y, s)| *y += s);
        }
        y
    }
}

/// Two machines that differ in one quantity.
struct Both<'a> {
    ends: [Expression; 2],
    built: [Built<'a>; 2],
}

impl Both<'_> {
    /// What joint coordinates differ by.
    fn at(&self, x: &[f64]) -> DVector<f64> {
        let [low, high] = self.built.each_ref().map(|built| built.at(x).0);
        turned(high - low)
    }
}

#[test]
fn accuracy() {
    for (name, machine, half, error, angular, most) in [
        ("linear Delta", linear_delta(SLAB), 0.02, 0.01, false, 70),
        ("Orthoglide", orthoglide(), 0.02, 0.01, false, 60),
        ("struts", struts(), 0.02, 0.0, false, 130),
        ("rotary Delta", rotary(), 0.0005, 0.01, true, 3_000),
        ("two sliders", claim(TWO_SLIDERS), 0.0, 0.01, false, 60),
    ] {
        let machine = if half > 0.0 { toleranced(&machine, half) } else { machine };
        let given: &[(&str, &[f64])] = &[("joint_error", &[error])];
        let asked = Asked { quantity: "accuracy", leg: None, given, end: End::Max };
        let problem = Problem::new(&asked.of(&machine, 1.0)).expect("a claim");
        let unit = (problem.scale as f64).exp2();
        let n = problem.dimension();
        let middle = middle(&problem);
        let nominal = Built::new(&problem, &middle);
        let error = if angular { error.to_radians() } else { error / unit };
        let single = nominal.changes();
        let ends: Vec<[Expression; 2]> = single.iter().map(|both| both.ends.clone()).collect();
        let changes = |x: &[f64]| -> Vec<DVector<f64>> {
            single.iter().map(|both| both.at(x) / 2.0).collect()
        };
        let first_order = |x: &[f64]| {
            let (changes, m) = (changes(x), nominal.at(x).1.lu());
            let beta = |i: usize| error + changes.iter().map(|c| c[i].abs()).sum::<f64>();
            let all = (0..1u32 << (n - 1)).map(|signs| {
                let s = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
                let b = DVector::from_fn(n, |i, _| s(i) * beta(i));
                (m.solve(&b).expect("regular").norm(), DVector::from_fn(n, |i, _| s(i)))
            });
            all.max_by(|a, b| a.0.total_cmp(&b.0)).expect("signs")
        };
        let prover = Prover::new(&problem);
        let (_, at) = prover.greatest(|x| first_order(x).0);
        // The worst machine there, and the one with all signs the other way.
        let (_, signs) = first_order(&at);
        let own = changes(&at);
        let found = [1.0, -1.0].map(|sign: f64| {
            let values: Vec<Expression> = own
                .iter()
                .zip(&ends)
                .map(|(change, end)| {
                    let i = change.iamax();
                    end[usize::from(sign * signs[i] * change[i] < 0.0)].clone()
                })
                .collect();
            let built = Built::new(&problem, &values);
            let rho = nominal.at(&at).0 + signs.clone() * sign * error;
            let there = built.position(&at, &rho);
            let u = DVector::from_fn(n, |k, _| there[k] - at[k]);
            let y = built.at(&at).1.transpose().lu().solve(&u).expect("regular").normalize();
            (u.norm() * unit, values, rounded(y.iter().copied()))
        });
        let (worst, values, y) =
            found.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("both");
        println!("{name}: worst {worst}");
        asked.is_refuted(&machine, worst, &at, &values, &Failure::Obligation(1, vec![y]));
        let part = if angular { 0.05 } else { 0.01 };
        let proved = asked.is_proved_within(part, &machine, worst, most);
        // Machines, points and errors at random are within what is proved.
        let Bound::Max(bound) = &proved.require[0].bound else { panic!("a bound") };
        let bound: f64 = bound.to_string().parse().expect("a decimal");
        let mut random = Random(11);
        let points = prover.grid(4);
        for _ in 0..60 {
            let values: Vec<Expression> =
                ends.iter().map(|end| end[random.below(2) as usize].clone()).collect();
            let x = &points[random.below(points.len() as u64) as usize];
            let eps = DVector::from_fn(n, |_, _| error * (random.below(201) as f64 / 100.0 - 1.0));
            let there = Built::new(&problem, &values).position(x, &(nominal.at(x).0 + eps));
            let off: f64 = there.iter().zip(x).map(|(y, x)| (y - x).powi(2)).sum();
            assert!(off.sqrt() * unit <= bound, "{name}");
        }
    }
}

#[test]
fn accuracy_is_existence_and_uniqueness() {
    // x^2 within 0.001 of what it is at x >= 0.1: one solution within 0.00514 of x, and another
    // within 0.2052.
    let square = claim(
        r#"{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[],"definitions":[],"joints":[{"rho":"x^2"}]}},"workspace":{"box":{"min":["0.1"],"max":["1"]}},"require":[]}"#,
    );
    let asked = |given, bound| {
        Asked { quantity: "accuracy", leg: None, given, end: End::Max }.of(&square, bound)
    };
    let small: &[(&str, &[f64])] = &[("joint_error", &[0.001])];
    let proof = certify(&asked(small, 0.006), 200).expect("a proof");
    check(&proof).expect("accepted");
    for (defect, bound) in [("none within", 0.00512), ("two within", 0.21), ("out of reach", 3.0)] {
        assert!(certify(&asked(small, bound), 400).is_none(), "{defect}");
        assert!(check(&about(&proof, &asked(small, bound))).is_err(), "{defect}");
    }
    for (defect, change) in [
        ("Y of zero", (|y, _| y.y[0][0] = 0) as fn(&mut Multiplier, &mut i64)),
        ("Y without rows", |y, _| y.y.clear()),
        ("Y with an entry too many", |y, _| y.y[0].push(0)),
        ("too many places", |y, _| y.places = 64),
        ("kappa of zero", |_, kappa| *kappa = 0),
        ("kappa less than zero", |_, kappa| *kappa = -*kappa),
        ("kappa twice", |_, kappa| *kappa *= 2),
        ("kappa too small for Banach", |_, kappa| *kappa = 1),
    ] {
        let mut changed = proof.clone();
        let Proof::Tree(tree) = &mut changed.proof else { panic!("a tree") };
        for Step(_, evidence) in tree.nodes.iter_mut().flat_map(|node| &mut node.by) {
            if let Evidence::Accuracy(y, kappa, _) = evidence {
                change(y, kappa);
            }
        }
        assert!(check(&changed).is_err(), "{defect}");
    }
    // What is claimed of more joints than coordinates, or of none that are known.
    for (defect, given, bound) in [
        ("bound of zero", small, 0.0),
        ("error less than zero", &[("joint_error", &[-0.1][..])][..], 0.1),
        ("two errors", &[("joint_error", &[0.1, 0.1])], 0.1),
        ("no error", &[], 0.1),
    ] {
        assert!(Problem::new(&asked(given, bound)).is_err(), "{defect}");
    }
    let asked = Asked { quantity: "accuracy", leg: None, given: small, end: End::Max };
    let mut redundant = linear_delta(SLAB);
    if let Mechanism::Translational(legs) = &mut redundant.mechanism {
        legs.push(legs[0].clone());
    }
    assert!(Problem::new(&asked.of(&redundant, 1.0)).is_err(), "a joint too many");
    let rows = TWO_SLIDERS.replace(r#"{"rho":"x-s"}"#, r#"{"row":["1","y/s"]}"#);
    assert!(Problem::new(&asked.of(&claim(&rows), 1.0)).is_err(), "a joint by its row");
}

/// The accuracy of a claim, its first part, with what it asks for.
fn asked_of(problem: &Problem, obligation: usize) -> &Accuracy {
    match &problem.obligations[obligation].test {
        Test::Accuracy(test) => test,
        other => panic!("{other:?}"),
    }
}

/// A claim with these numbers of `accuracy`.
fn accurate(text: &dyn Fn(&str) -> String, [error, max, angle]: [f64; 3]) -> MachineClaim {
    let [error, max, angle] = [error, max, angle].map(|x| number(x).to_string());
    claim(&text(&format!(
        r#"{{"quantity":"accuracy","given":{{"joint_error":["{error}"],"max_angle":["{angle}"]}},"end":"max","bound":"{max}"}}"#
    )))
}

/// A machine's text with requirements.
type Text = Box<dyn Fn(&str) -> String>;

/// Machines that turn their platforms: in the plane, about a point and in space.
fn turning() -> [(&'static str, Text, [usize; 2]); 4] {
    let rpr = |at: f64| strut(&on_circle(4.0, at), &on_circle(1.0, at - 60.0));
    let plane: Vec<String> = [90.0, 210.0, 330.0].map(rpr).to_vec();
    let hexapod = hexapod_legs();
    let box_ = [r#""-0.5","-0.5""#, r#""0.5","0.5""#];
    [
        ("range", Box::new(move |r| planar(&plane, box_, r#""-20","20""#, r)), [2, 1]),
        ("angle", Box::new(|r| spherical(r#"{"angle":"15"}"#, r)), [0, 3]),
        ("angle", Box::new(move |r| spatial(&hexapod, r#"{"angle":"5"}"#, r)), [3, 3]),
        ("range", Box::new(three_prr), [2, 1]),
    ]
}

/// Three sliders in the plane that turn a platform.
fn three_prr(require: &str) -> String {
    let leg = |at: f64| {
        format!(
            r#"{{"drive":"slider","direction":[{}],"anchor":[{}],"platform":[{}],"length":"3","mode":"-"}}"#,
            on_circle(1.0, at + 30.0),
            on_circle(4.0, at),
            on_circle(1.0, at - 60.0)
        )
    };
    let legs = [90.0, 210.0, 330.0].map(leg);
    planar(&legs, [r#""-0.2","-0.2""#, r#""0.2","0.2""#], r#""-5","5""#, require)
}

/// What displaces a pose, `t` and then `c`, in the units of coordinates.
fn displaced(x: &[f64], u: &[f64], (kind, [first, spin]): (&str, [usize; 2])) -> Vec<f64> {
    let whole = |c: &[f64]| match *c {
        [c] => rotation("range", &[c]),
        _ if c.iter().all(|&c| c == 0.0) => rotation("none", c),
        _ => rotation("angle", c),
    };
    let r = product(&whole(&u[first..]), &rotation_of(kind, &x[first..]));
    let q0 = (1.0 + r[0][0] + r[1][1] + r[2][2]).sqrt() / 2.0;
    let c = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|x| x / (4.0 * q0 * q0));
    let moved = x.iter().zip(u).take(first).map(|(x, u)| x + u);
    moved.chain(c[3 - spin..].iter().copied()).collect()
}

fn rotation_of(kind: &str, c: &[f64]) -> [[f64; 3]; 3] {
    rotation(if c.iter().all(|&c| c == 0.0) { "none" } else { kind }, c)
}

#[test]
fn far_rows_are_derivatives_by_what_displaces_a_pose() {
    let mut random = Random(23);
    for (kind, text, split) in turning() {
        let (d, angle) = (0.05, 4.0);
        let stated = accurate(&text, [0.001, d, angle]);
        let problem = Problem::new(&stated).expect("a claim");
        let test = asked_of(&problem, 1);
        let prover = Prover::new(&problem);
        let m = problem.dimension();
        let unit = (problem.scale as f64).exp2();
        let tau = (angle / 2.0f64).to_radians().tan();
        let parameters = problem.parameters::<BigInt>(96, &[]).expect("numbers");
        let rho = |x: &[f64], i: usize| {
            let Some(Joint::Length(rho)) = problem.legs[i].rho else { panic!("a length") };
            prover.values(x).of(rho).expect("within reach").0 * unit
        };
        for _ in 0..40 {
            let mut between = |(l, h): (f64, f64)| l + (h - l) * random.below(1001) as f64 / 1e3;
            let x: Vec<f64> = prover.ranges().into_iter().map(&mut between).collect();
            let u: Vec<f64> = (0..m).map(|_| between((-1.0, 1.0))).collect();
            let by = |u: &[f64]| -> Vec<f64> {
                let scale = |(k, u): (usize, &f64)| u * if k < split[0] { d / unit } else { tau };
                u.iter().enumerate().map(scale).collect()
            };
            // Coordinates from m on are those of the rotation.
            let rows = |u: &[f64]| -> Vec<Vec<f64>> {
                let by = by(u);
                let coordinate = |k: usize| match k {
                    _ if k < split[0] => Some((x[k] + by[k], x[k] + by[k])),
                    _ if k < m => Some((x[k], x[k])),
                    _ => Some(by[k - m + split[0]]).map(|c| (c, c)),
                };
                let values =
                    problem.tape.run(&Rough, coordinate, |j| Some(double(&parameters[j], 96)));
                let of = |f: &Formula| values.of(*f).expect("defined").0;
                test.far.iter().map(|row| row.iter().map(of).collect()).collect()
            };
            let h = 1e-5;
            for (i, row) in rows(&u).iter().enumerate() {
                for (k, found) in row.iter().enumerate() {
                    let [after, before] = [h, -h].map(|h| {
                        let mut u = u.clone();
                        u[k] += h;
                        rho(&displaced(&x, &by(&u), (kind, split)), i)
                    });
                    let expected = (after - before) / (2.0 * h) / d;
                    assert!((found - expected).abs() < 1e-4, "{kind} {i} {k}: {found} {expected}");
                }
            }
            // Those of the cell are the same where nothing is displaced.
            let values = prover.values(&x);
            let still = rows(&vec![0.0; m]);
            for (row, far) in test.rows.iter().zip(&still) {
                for (&f, far) in row.iter().zip(far) {
                    assert!((values.of(f).expect("defined").0 - far).abs() < 1e-9);
                }
            }
        }
    }
}

#[test]
fn the_spread_of_rows_near_a_cell() {
    let mut random = Random(21);
    let translating = [linear_delta(SLAB), struts(), rotary(), claim(TWO_SLIDERS)].map(|machine| {
        let given: &[(&str, &[f64])] = &[("joint_error", &[0.0])];
        let asked = Asked { quantity: "accuracy", leg: None, given, end: End::Max };
        let problem = Problem::new(&machine).expect("a claim");
        let unit = (problem.scale as f64).exp2();
        [0.02, 0.005].map(|part| asked.of(&machine, part * unit))
    });
    let turning = turning().map(|(_, text, _)| {
        [[0.05, 3.0], [0.01, 0.5]].map(|[d, angle]| accurate(&text, [0.0, d, angle]))
    });
    for stated in translating.iter().chain(&turning).flatten() {
        let problem = Problem::new(stated).expect("a claim");
        let test = asked_of(&problem, 1);
        let prover = Prover::new(&problem);
        let m = problem.dimension();
        let first = test.turn.map_or(m, |(_, first)| first);
        let points = prover.grid(3);
        let centre = &points[points.len() / 2 + random.below(2) as usize];
        let of = |f| prover.values(centre).of(f).copied();
        let (d, tau) =
            (of(test.distance).expect("d").0, test.turn.map(|t| of(t.0).expect("tau").0));
        let half = |k: usize| if k < first { d / 4.0 } else { tau.expect("it turns") / 4.0 };
        let edge =
            |(k, &c): (usize, &f64)| [(c, c), (c - half(k), c + half(k)), (half(k), half(k))];
        let edges: Vec<[Pair; 3]> = centre.iter().enumerate().map(edge).collect();
        let parameters = &prover.checker.parameters;
        let slopes = Slopes::new(&Rough, m);
        let values = near(&problem.tape, parameters, slopes, &edges, test, of).expect("defined");
        let bound = spread(slopes, &values, test).expect("defined").1;
        let mut greatest = 0f64;
        for _ in 0..400 {
            let mut one = || random.below(2_001) as f64 / 1_000.0 - 1.0;
            let p: Vec<f64> = centre.iter().enumerate().map(|(k, c)| c + half(k) * one()).collect();
            let u: Vec<f64> = centre.iter().map(|_| one()).collect();
            let rows = |u: &[f64]| {
                let coordinate = |k: usize| match k {
                    _ if k < first => Some(p[k] + d * u[k]).map(|x| (x, x)),
                    _ if k < m => Some((p[k], p[k])),
                    _ => Some(tau? * u[k - m + first]).map(|c| (c, c)),
                };
                let values = problem.tape.run(&Rough, coordinate, |j| Some(parameters[j]));
                let all = test.far.iter().flatten().map(|&f| values.of(f).expect("defined").0);
                DMatrix::from_row_iterator(m, m, all)
            };
            let change = rows(&u) - rows(&vec![0.0; m]);
            let norm = |part| DVector::from_column_slice(&u[part]).norm();
            let size = test.parts(m).into_iter().map(norm).fold(0.0, f64::max);
            greatest = greatest.max(change.singular_values().max() / size);
        }
        assert!(greatest <= bound, "{greatest} {bound}");
        let loose = if first < m { 6.0 } else { 2.5 };
        assert!(bound < loose * greatest, "{greatest} {bound}");
    }
}

/// Where joint errors, and tolerances in two rounds of three, put a platform that turns, by Newton's method,
/// against what is shown on cells about the pose.
#[test]
fn nothing_is_shown_of_a_pose_that_is_off_by_more() {
    let mut random = Random(29);
    let (mut shown, mut weighted, mut controls) = ([0; 2], 0, 0);
    for round in 0..26 {
        // Of hexapods two, as each takes ten times as long.
        let which = if round < 2 { 2 } else { [0, 1, 3][round % 3] };
        let (kind, text, split) = &turning()[which];
        let half = if round % 3 == 0 { 0.0 } else { 0.003 };
        let free = claim(&text(""));
        let free = if half > 0.0 { toleranced(&free, half) } else { free };
        let problem = Problem::new(&free).expect("a claim");
        let prover = Prover::new(&problem);
        let m = problem.dimension();
        let unit = (problem.scale as f64).exp2();
        let mut between = |(l, h): (f64, f64)| l + (h - l) * random.below(1001) as f64 / 1e3;
        let x: Vec<f64> = prover.ranges().into_iter().map(&mut between).collect();
        if !prover.is_inside(&x) {
            continue;
        }
        let error = if round % 8 < 4 { 0.002 } else { 0.02 };
        let nominal = Built::new(&problem, &middle(&problem));
        let changes = nominal.changes();
        let changes: Vec<_> = changes.iter().map(|both| (&both.ends, both.at(&x))).collect();
        // The machine of the tolerance that adds most to these errors.
        let worst = |errors: &DVector<f64>| {
            let end = |(ends, change): &(&[Expression; 2], DVector<f64>)| {
                let i = change.iamax();
                ends[usize::from(errors[i] * change[i] < 0.0)].clone()
            };
            Built::new(&problem, &changes.iter().map(end).collect::<Vec<_>>())
        };
        // Off by (t, c) with these errors; the columns of derivatives as differences.
        let off = |errors: &DVector<f64>| {
            let target = nominal.at(&x).0 * unit + errors;
            let mut u = vec![0.0; m];
            let built = worst(errors);
            let at = |u: &[f64]| built.at(&displaced(&x, u, (kind, *split))).0 * unit;
            for _ in 0..12 {
                let own = at(&u);
                let mut j = DMatrix::zeros(m, m);
                for k in 0..m {
                    let mut v = u.clone();
                    v[k] += 1e-7;
                    j.set_column(k, &((at(&v) - &own) / 1e-7));
                }
                let step = j.lu().solve(&(&target - own)).expect("regular");
                u.iter_mut().zip(step.iter()).for_each(|(u, s)| *u += s);
            }
            let norm = |u: &[f64]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
            [norm(&u[..split[0]]) * unit, 2.0 * norm(&u[split[0]..]).atan().to_degrees()]
        };
        let all = (0..1u32 << m).map(|signs| {
            off(&DVector::from_fn(m, |i, _| if signs >> i & 1 == 1 { -error } else { error }))
        });
        let [most, angle] = all.fold([0f64; 2], |[a, b], [c, d]: [f64; 2]| [a.max(c), b.max(d)]);
        let most = if split[0] == 0 { 1.0 } else { most };
        // Too little of the one, of the other, or enough of both.
        for (parts, fails) in
            [([0.98, 1.5], [true, false]), ([1.5, 0.98], [false, true]), ([1.15, 1.15], [false; 2])]
        {
            let stated = accurate(text, [error, parts[0] * most, parts[1] * angle]);
            let stated = if half > 0.0 { toleranced(&stated, half) } else { stated };
            let problem = Problem::new(&stated).expect("a claim");
            let prover = Prover::new(&problem);
            let fixed = Fixed::<i64>::new(BITS);
            let parameters = problem.parameters(BITS, &[]).expect("parameters");
            let exact = Checker::new(&problem, &fixed, parameters, None);
            for obligation in 1..problem.obligations.len() {
                let test = asked_of(&problem, obligation);
                // About a point there is an angle alone.
                let false_there = fails[usize::from(test.is_of_angle())];
                if false_there {
                    never_shown(&problem, &x, obligation, round as u64);
                    continue;
                }
                let scale = f64::from(BITS).exp2();
                let edge =
                    |x: &f64| Interval { lo: (x * scale) as i64 - 8, hi: (x * scale) as i64 + 8 };
                let cell = Cell(x.iter().map(edge).collect());
                let edges = cell.edges().expect("edges");
                let pair = |x: &Interval<i64>| (x.lo as f64 / scale, x.hi as f64 / scale);
                let rough: Vec<_> = edges.iter().map(|edge| edge.each_ref().map(pair)).collect();
                let values = prover.checker.evaluate(&rough);
                let slopes = Slopes::new(&Rough, m);
                let test = &problem.obligations[obligation].test;
                let place = Place::new(&rough, [false; 2]);
                let proposals = prover.proposals(&Over::new(&place, slopes, &values), test);
                let place = Place::new(&edges, [false; 2]);
                let values = exact.evaluate(&edges);
                let over = Over::new(&place, Slopes::new(&fixed, m), &values);
                let holds = |e: &&Evidence| exact.shows(&over, test, e);
                let found: Vec<&Evidence> = proposals.iter().flatten().filter(holds).collect();
                shown[usize::from(fails == [false; 2])] += usize::from(!found.is_empty());
                let first = found.first();
                weighted += usize::from(matches!(first, Some(Evidence::Accuracy(_, _, 1..))));
                let is_control = |e: &&Evidence| matches!(e, Evidence::Control(_));
                controls += usize::from(found.iter().any(is_control));
            }
        }
    }
    assert!(shown.iter().all(|&n| n > 8), "{shown:?}");
    assert!(weighted > 3 && controls > 8, "{weighted} {controls}");
}

/// At poses of cells, with the weights of control points, against joint coordinates of machines of wide tolerances:
/// `w rho_i |b_i|` is at most the sum of the `b_i` there, and nearly so for small cells.
#[test]
fn joints_are_off_by_no_more_than_at_control_points() {
    let mut random = Random(31);
    let struts = turning();
    let cases = struts.iter().take(3).zip([0.2, 0.05, 0.05]);
    let wide = cases.clone().map(|(own, half)| (own, half, 0.1, 0.0));
    let narrow = cases.map(|(own, half)| (own, half / 20.0, 0.001, 0.95));
    for ((kind, text, _), half, size, closeness) in wide.chain(narrow) {
        let (error, max) = (0.01, 0.2);
        let stated = toleranced(&accurate(text, [error, max, 10.0]), half);
        let problem = Problem::new(&stated).expect("a claim");
        let unit = (problem.scale as f64).exp2();
        let prover = Prover::new(&problem);
        let nominal = Built::new(&problem, &middle(&problem));
        let ends: Vec<[Expression; 2]> =
            problem.tolerances().map(|(_, min, max)| [min.clone(), max.clone()]).collect();
        let m = problem.dimension();
        let test = asked_of(&problem, 1);
        let ranges = prover.ranges();
        let centre: Vec<f64> = ranges.iter().map(|(l, h)| (3.0 * l + 2.0 * h) / 5.0).collect();
        let edges: Vec<[Pair; 3]> =
            centre.iter().map(|&c| [(c, c), (c - size, c + size), (size, size)]).collect();
        let values = prover.checker.evaluate(&edges);
        let place = Place::new(&edges, [false; 2]);
        let over = Over::new(&place, Slopes::new(&Rough, m), &values);
        let own = &problem.obligations[1].test;
        let found = prover.checker.at_controls(&over, own, |there| {
            let greatest = there.greatest(test).expect("enclosed");
            let controls = there.controls.expect("control points");
            let at = |v: Vertex| {
                let nodes: Vec<_> = (0..m).map(|k| controls.place(k, v.index())).collect();
                (nodes, there.shown(test, (v, 0), greatest.as_ref()).expect("enclosed"))
            };
            there.vertices().map(at).collect::<Vec<_>>()
        });
        let found = found.expect("control points");
        let changes = nominal.changes();
        let changes: Vec<DVector<f64>> = changes.iter().map(|both| both.at(&centre)).collect();
        let three = |k: usize| found.iter().any(|(nodes, _)| nodes[k] == Some(0));
        let mut closest = 0f64;
        for round in 0..200 {
            let t: Vec<f64> = (0..m).map(|_| random.below(1001) as f64 / 1e3).collect();
            let x: Vec<f64> =
                centre.iter().zip(&t).map(|(c, t)| c + size * (2.0 * t - 1.0)).collect();
            let part = |(k, node): (usize, &Option<i64>)| match (node, three(k)) {
                (Some(-1), true) => (1.0 - t[k]).powi(2),
                (Some(0), _) => 2.0 * t[k] * (1.0 - t[k]),
                (Some(_), true) => t[k].powi(2),
                (Some(-1), false) => 1.0 - t[k],
                (Some(_), false) => t[k],
                (None, _) => 1.0,
            };
            let weight = |nodes: &[Option<i64>]| nodes.iter().enumerate().map(part).product();
            let weights: Vec<f64> = found.iter().map(|(nodes, _)| weight(nodes)).collect();
            let sum = |of: &dyn Fn(&Shown<Pair>) -> f64| -> f64 {
                weights.iter().zip(&found).map(|(weight, (_, shown))| weight * of(shown)).sum()
            };
            let w = sum(&|(_, w, ..)| w.0);
            // Every second machine is one that makes a joint longest or shortest.
            let own = random.below(m as u64) as usize;
            let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
            let worst = round % 2 == 0;
            let end = |(change, end): (&DVector<f64>, &[Expression; 2])| match worst {
                true => end[usize::from(sign * change[own] > 0.0)].clone(),
                false => end[random.below(2) as usize].clone(),
            };
            let values: Vec<Expression> = changes.iter().zip(&ends).map(end).collect();
            let (rho, intended) = (Built::new(&problem, &values).at(&x).0, nominal.at(&x).0);
            for i in 0..rho.len() {
                let off = (intended[i] - rho[i]).abs() + error / unit;
                let b = sum(&|(.., b)| b[i].1);
                let part = w * rho[i] * off / (max / unit) / b;
                assert!(part <= 1.0 + 1e-9, "{kind} {i}: {part}");
                closest = closest.max(part);
            }
        }
        assert!(closest > closeness, "{kind}: {closest}");
    }
}
