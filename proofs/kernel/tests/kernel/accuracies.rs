//! Accuracy against machines that are built and positioned in doubles.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::prover::{certify, double, Prover};
use crate::quantities::{about, number, rounded, Asked, End, SLAB, TWO_SLIDERS};
use crate::rough::{Pair, Rough};
use nalgebra::{DMatrix, DVector};
use num_bigint::BigInt;
use orthocert_kernel::certificate::{Evidence, Failure, Proof, Step};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Bound, Leg, MachineClaim, Mechanism, Quantity};
use orthocert_kernel::formula::Op;
use orthocert_kernel::machine::Joint;
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::test::Multiplier;

/// The machine with a tolerance of so much either way on each length and, but for arms, on each
/// coordinate of the anchors.
fn toleranced(machine: &MachineClaim, half: f64) -> MachineClaim {
    let wide = |x: &mut Quantity| {
        let Quantity::Exactly(middle) = x.clone() else { return };
        let end = |operator| {
            Expression::Binary(operator, Box::new(middle.clone()), Box::new(number(half)))
        };
        *x = Quantity::Between { min: end(Operator::Sub), max: end(Operator::Add) };
    };
    let mut machine = machine.clone();
    if let Mechanism::Translational(legs) = &mut machine.mechanism {
        for leg in legs {
            match leg {
                Leg::Slider { anchor, length, .. } => {
                    wide(length);
                    anchor.iter_mut().for_each(wide);
                }
                Leg::Strut { anchor, .. } => anchor.iter_mut().for_each(wide),
                Leg::Arm { arm, length, .. } => {
                    wide(arm);
                    wide(length);
                }
                Leg::Planar { .. } => {}
            }
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

    fn at(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let values = self.problem.tape.run(&Rough, |op| match op {
            Op::Coordinate(k) => Some((x[k], x[k])),
            Op::Parameter(j) => Some(self.parameters[j]),
            _ => None,
        });
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
        let middle: Vec<Expression> = problem
            .tolerances()
            .map(|(_, min, max)| {
                let sum =
                    Expression::Binary(Operator::Add, Box::new(min.clone()), Box::new(max.clone()));
                Expression::Binary(Operator::Div, Box::new(sum), Box::new(Expression::integer(2)))
            })
            .collect();
        let nominal = Built::new(&problem, &middle);
        let error = if angular { error.to_radians() } else { error / unit };
        // Sensitivities as differences over the machine's values.
        let ends: Vec<[Expression; 2]> =
            problem.tolerances().map(|(_, min, max)| [min.clone(), max.clone()]).collect();
        let single: Vec<[Built; 2]> = (0..ends.len())
            .map(|j| {
                [0, 1].map(|end| {
                    let mut values = middle.clone();
                    values[j] = ends[j][end].clone();
                    Built::new(&problem, &values)
                })
            })
            .collect();
        let changes = |x: &[f64]| -> Vec<DVector<f64>> {
            single.iter().map(|[low, high]| turned(high.at(x).0 - low.at(x).0) / 2.0).collect()
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
            if let Evidence::Accuracy(y, kappa) = evidence {
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

#[test]
fn the_spread_of_rows_about_a_cell() {
    use orthocert_kernel::slope::Slopes;
    use orthocert_kernel::test::accuracy::{inflated, spread};
    use orthocert_kernel::test::Over;
    let mut random = Random(21);
    for machine in [linear_delta(SLAB), struts(), rotary(), claim(TWO_SLIDERS)] {
        let problem = Problem::new(&machine).expect("a claim");
        let prover = Prover::new(&problem);
        let rows: Vec<_> = problem.legs.iter().map(|leg| leg.divided.a.clone()).collect();
        let points = prover.grid(3);
        for part in [0.02, 0.005] {
            let centre = &points[points.len() / 2 + random.below(2) as usize];
            let (half, d) = (part / 4.0, part);
            let edge = |&c: &f64| [(c, c), (c - half, c + half), (half, half)];
            let edges: Vec<[Pair; 3]> = centre.iter().map(edge).collect();
            let edges = inflated(&Rough, &edges, &(d, d)).expect("edges");
            let values = prover.checker.evaluate(&edges);
            let slopes = Slopes { arithmetic: &Rough, m: edges.len() };
            let far = Over::new(slopes, &values);
            let bound = spread(&far, &rows).expect("defined").1 / d;
            let mut greatest = 0f64;
            for _ in 0..400 {
                let mut near = |half: f64| half * (random.below(2_001) as f64 / 1_000.0 - 1.0);
                let p: Vec<f64> = centre.iter().map(|c| c + near(half)).collect();
                let u: Vec<f64> = centre.iter().map(|_| near(d)).collect();
                let q: Vec<f64> = p.iter().zip(&u).map(|(p, u)| p + u).collect();
                let change =
                    prover.matrix(&q).expect("defined") - prover.matrix(&p).expect("defined");
                let size = u.iter().map(|u| u * u).sum::<f64>().sqrt();
                greatest = greatest.max(change.singular_values().max() / size);
            }
            assert!(greatest <= bound, "{greatest} {bound}");
            assert!(bound < 2.5 * greatest, "{greatest} {bound}");
        }
    }
}
