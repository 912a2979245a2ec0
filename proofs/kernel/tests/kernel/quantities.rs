//! Quantities against sampling: a bound one per cent beyond the worst that is found is proved, one per
//! cent short of it refuted, and what proves the one proves nothing of the other.

use crate::certificates::claim;
use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::prover::{certificate, certify, Prover};
use orthocert_kernel::certificate::{Certificate, Claim, Failure, Proof, Verdict, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use std::collections::BTreeMap;

pub const SLAB: &str = r#"{"box":{"min":["-60","-60","0"],"max":["60","60","1"]}}"#;

/// Ends of a bound.
#[derive(Clone, Copy, PartialEq)]
pub enum End {
    Min,
    Max,
}

/// A number in decimals.
pub fn number(x: f64) -> Expression {
    let text = format!("{x:.12}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    let text = if text == "-0" { "0" } else { text };
    Expression::try_from(text.to_owned()).expect("a number")
}

/// A quantity that is asked for.
#[derive(Clone)]
pub struct Asked<'a> {
    pub quantity: &'a str,
    pub leg: Option<usize>,
    pub given: &'a [(&'a str, &'a [f64])],
    pub end: End,
}

impl Asked<'_> {
    pub fn of(&self, machine: &MachineClaim, bound: f64) -> MachineClaim {
        let given: BTreeMap<String, Vec<Expression>> = self
            .given
            .iter()
            .map(|(name, x)| ((*name).to_owned(), x.iter().map(|&x| number(x)).collect()))
            .collect();
        let bound = match self.end {
            End::Min => Bound::Min(number(bound)),
            End::Max => Bound::Max(number(bound)),
        };
        let (quantity, leg) = (self.quantity.to_owned(), self.leg);
        let mut claim = machine.clone();
        claim.require = vec![Requirement { quantity, leg, given, bound }];
        claim
    }

    /// Proves the bound one per cent beyond the worst, with at most so many leaves, refutes it one
    /// per cent short of it by the witness, and finds that the proof proves nothing of that.
    pub fn is_decided(
        &self,
        machine: &MachineClaim,
        worst: f64,
        most: usize,
        fails: impl Fn(&Problem) -> (Vec<f64>, Failure),
    ) {
        self.is_proved(machine, worst, most);
        let problem = Problem::new(&self.of(machine, worst)).expect("well formed");
        let (point, fails) = fails(&problem);
        self.is_refuted(machine, worst, &point, &[], &fails);
    }

    /// Proves the bound one per cent beyond the worst; the proof proves nothing of the bound one per
    /// cent short of it.
    pub fn is_proved(&self, machine: &MachineClaim, worst: f64, most: usize) -> MachineClaim {
        self.is_proved_within(0.01, machine, worst, most)
    }

    /// The same, so much beyond the worst.
    pub fn is_proved_within(
        &self,
        part: f64,
        machine: &MachineClaim,
        worst: f64,
        most: usize,
    ) -> MachineClaim {
        let sign = if self.end == End::Max { 1.0 } else { -1.0 };
        let by = 0.01 * sign;
        let true_claim = self.of(machine, worst * (1.0 + part * sign));
        let proof = certify(&true_claim, 4 * most).expect("a proof");
        check(&proof).expect("accepted");
        let Proof::Tree(tree) = &proof.proof else { panic!("a tree") };
        let leaves = tree.nodes.iter().filter(|node| node.split.is_none()).count();
        println!("{}: {leaves} leaves", self.quantity);
        assert!(leaves <= most, "{}: {leaves} leaves", self.quantity);
        let false_claim = self.of(machine, worst * (1.0 - by));
        assert!(check(&about(&proof, &false_claim)).is_err(), "{}: false", self.quantity);
        true_claim
    }

    /// Refutes the bound one per cent short of the worst; the witness shows nothing of the bound one
    /// per cent beyond it.
    pub fn is_refuted(
        &self,
        machine: &MachineClaim,
        worst: f64,
        point: &[f64],
        values: &[Expression],
        fails: &Failure,
    ) {
        let by = if self.end == End::Max { 0.01 } else { -0.01 };
        let false_claim = self.of(machine, worst * (1.0 - by));
        let problem = Problem::new(&false_claim).expect("well formed");
        let witness = refutation(&problem, &false_claim, point, values, fails);
        check(&witness).expect("refuted");
        let true_claim = self.of(machine, worst * (1.0 + by));
        check(&about(&witness, &true_claim)).expect_err("a refutation of what is true");
    }
}

/// The same proof, of another claim.
pub fn about(proof: &Certificate, claim: &MachineClaim) -> Certificate {
    Certificate { claim: Claim::Machine(claim.clone()), ..proof.clone() }
}

/// A refutation at a point in the problem's unit, pulled a little into the workspace.
pub fn refutation(
    problem: &Problem,
    claim: &MachineClaim,
    point: &[f64],
    values: &[Expression],
    fails: &Failure,
) -> Certificate {
    let unit = (problem.scale as f64).exp2();
    let root = problem.root::<i64>(40).expect("a box");
    let inward = |(x, range): (&f64, &orthocert_kernel::fixed::Interval<i64>)| {
        let middle = (range.lo + range.hi) as f64 / 2.0 * (-40f64).exp2();
        number((middle + (x - middle) * (1.0 - 1e-7)) * unit)
    };
    let point = point.iter().zip(&root.0).map(inward).collect();
    let witness = Witness { precision: 128, point, machine: values.to_vec(), fails: fails.clone() };
    certificate(claim, Verdict::Refuted, Proof::Witness(witness))
}

/// A direction in integers.
pub fn rounded(v: impl Iterator<Item = f64>) -> Vec<i64> {
    v.map(|x| (x * 1_048_576.0).round() as i64).collect()
}

#[test]
fn stiffness() {
    use nalgebra::{DMatrix, DVector, SymmetricEigen};
    let k = [50.0, 60.0, 75.0];
    let asked = Asked { quantity: "stiffness", leg: None, given: &[("joint", &k)], end: End::Min };
    for (machine, angular, most) in [
        (linear_delta(SLAB), false, 26),
        (orthoglide(), false, 60),
        (struts(), false, 60),
        (rotary(), true, 900),
    ] {
        let problem = Problem::new(&asked.of(&machine, 1.0)).expect("a claim");
        let prover = Prover::new(&problem);
        let eigen = |x: &[f64]| {
            let m = prover.matrix(x).expect("within reach");
            let k = DMatrix::from_diagonal(&DVector::from_row_slice(&k));
            SymmetricEigen::new(m.transpose() * k * m)
        };
        let (worst, at) = prover.greatest(|x| -eigen(x).eigenvalues.min());
        let eigen = eigen(&at);
        let direction = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
        let unit = if angular { (-2.0 * problem.scale as f64).exp2() } else { 1.0 };
        asked.is_decided(&machine, -worst * unit, most, |_| {
            (at.clone(), Failure::Obligation(1, vec![rounded(direction.iter().copied())]))
        });
        let asked = |given| Asked { given, ..asked.clone() }.of(&machine, 0.01);
        for given in [&[("joint", &k[..2])][..], &[("joint", &[0.0])], &[("force", &k)]] {
            assert!(Problem::new(&asked(given)).is_err(), "{given:?}");
        }
    }
}

/// A user's own machine: two sliders along x on either side, in the plane.
const TWO_SLIDERS: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[],"definitions":[["s","sqrt(200^2-y^2)"]],"joints":[{"rho":"x-s"},{"rho":"x+s"}]}},"workspace":{"box":{"min":["-50","80"],"max":["50","160"]}},"require":[]}"#;

#[test]
fn joint_acceleration() {
    use nalgebra::DMatrix;
    const A: f64 = 9_000.0;
    const V: f64 = 1_300.0;
    let given: &[(&str, &[f64])] = &[("acceleration", &[A]), ("speed", &[V])];
    let pi = std::f64::consts::PI;
    for (machine, leg, angular, most) in [
        (linear_delta(SLAB), 1, false, 10),
        (orthoglide(), 2, false, 10),
        (struts(), 3, false, 10),
        (rotary(), 1, true, 200),
        (claim(TWO_SLIDERS), 1, false, 30),
        (claim(TWO_SLIDERS), 2, false, 30),
    ] {
        let (v, a) = if angular { (10.0, 40.0) } else { (V, A) };
        let own: &[(&str, &[f64])] = &[("acceleration", &[a]), ("speed", &[v])];
        let given = if angular { own } else { given };
        let end = End::Max;
        let asked = Asked { quantity: "joint_acceleration", leg: Some(leg), given, end };
        let problem = Problem::new(&asked.of(&machine, 1.0)).expect("a claim");
        let prover = Prover::new(&problem);
        let unit = (problem.scale as f64).exp2();
        let m = problem.dimension();
        let row = |x: &[f64]| prover.matrix(x).expect("within reach").row(leg - 1).into_owned();
        // Second derivatives as differences of rows, in the problem's unit.
        let hessian = |x: &[f64]| {
            DMatrix::from_fn(m, m, |j, k| {
                let at = |h: f64| {
                    let mut x = x.to_vec();
                    x[k] += h;
                    row(&x)[j]
                };
                (at(1e-5 * unit.recip().max(1.0)) - at(-1e-5 * unit.recip().max(1.0)))
                    / (2e-5 * unit.recip().max(1.0))
            })
        };
        let (first, second) =
            if angular { (180.0 / pi / unit, 180.0 / pi / unit / unit) } else { (1.0, 1.0 / unit) };
        let value = |x: &[f64]| {
            let h = hessian(x);
            let h = nalgebra::SymmetricEigen::new((&h + h.transpose()) / 2.0);
            row(x).norm() * a * first + h.eigenvalues.amax() * v * v * second
        };
        let (worst, at) = prover.greatest(value);
        let h = hessian(&at);
        let h = nalgebra::SymmetricEigen::new((&h + h.transpose()) / 2.0);
        let direction = h.eigenvectors.column(h.eigenvalues.iamax()).into_owned();
        asked.is_decided(&machine, worst, most, |problem| {
            let test = &problem.obligations[1].test;
            let general = matches!(test, orthocert_kernel::quantity::Test::Curvature(_));
            let v = general.then(|| rounded(direction.iter().copied()));
            (at.clone(), Failure::Obligation(1, v.into_iter().collect()))
        });
    }
    let asked = |given| {
        let claim = Asked { quantity: "joint_acceleration", leg: None, given, end: End::Max };
        Problem::new(&claim.of(&orthoglide(), 1e6))
    };
    asked(given).expect("well formed");
    asked(&[("acceleration", &[0.0]), ("speed", &[1.0])]).expect("no acceleration");
    for given in [
        &[("acceleration", &[-1.0][..]), ("speed", &[1.0])][..],
        &[("speed", &[1.0])],
        &[("acceleration", &[1.0, 2.0]), ("speed", &[1.0])],
    ] {
        assert!(asked(given).is_err(), "{given:?}");
    }
}

fn one_to_one(machine: &MachineClaim) -> MachineClaim {
    let mut claim = machine.clone();
    claim.require = vec![Requirement {
        quantity: "one_to_one".to_owned(),
        leg: None,
        given: BTreeMap::new(),
        bound: Bound::Holds,
    }];
    claim
}

/// The cube of a complex number, nowhere singular but at 0: of 1 + i sqrt(3) and 1 - i sqrt(3) it is
/// the same, -8.
fn cube(x: &str, y: &str) -> MachineClaim {
    claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y"],"parameters":[],"definitions":[],"joints":[{{"rho":"x^3-3*x*y^2"}},{{"rho":"3*x^2*y-y^3"}}]}}}},"workspace":{{"box":{{"min":["{x}","-{y}"],"max":["2","{y}"]}}}},"require":[]}}"#
    ))
}

#[test]
fn one_to_one_by_one_matrix() {
    for (name, machine, most) in [
        ("linear Delta", linear_delta(SLAB), 2),
        ("Orthoglide", orthoglide(), 6),
        ("struts", struts(), 2),
        ("rotary Delta", rotary(), 40),
        ("two sliders", claim(TWO_SLIDERS), 4),
        ("a cube", cube("1", "1/2"), 8),
    ] {
        let proof = certify(&one_to_one(&machine), 20 * most).expect(name);
        check(&proof).expect(name);
        let Proof::Tree(tree) = &proof.proof else { panic!("a tree") };
        let with = tree.nodes.iter().filter(|node| {
            node.by.iter().any(|step| step.1 == orthocert_kernel::certificate::Evidence::Chords)
        });
        let leaves = with.count();
        println!("{name}: {leaves} leaves");
        assert!(leaves <= most, "{name}: {leaves} leaves");
        for change in [
            (|tree| tree.chords = None) as fn(&mut orthocert_kernel::certificate::Tree),
            |tree| tree.chords.as_mut().expect("Y").y.iter_mut().flatten().for_each(|y| *y = -*y),
            |tree| tree.chords.as_mut().expect("Y").y.iter_mut().flatten().for_each(|y| *y = 0),
            |tree| drop(tree.chords.as_mut().expect("Y").y.pop()),
            |tree| tree.chords.as_mut().expect("Y").places = 64,
        ] {
            let mut changed = proof.clone();
            let Proof::Tree(tree) = &mut changed.proof else { panic!("a tree") };
            change(tree);
            check(&changed).expect_err(name);
        }
    }
}

#[test]
fn one_to_one_is_not_shown_by_a_matrix_for_each_cell() {
    // Nowhere singular, so that every small cell has a Y; but not one to one.
    let machine = cube("1/2", "2");
    let mut nonsingular = machine.clone();
    nonsingular.require.clear();
    check(&certify(&nonsingular, 400).expect("nowhere singular")).expect("accepted");
    assert!(certify(&one_to_one(&machine), 2_000).is_none());
    // Rows alone say nothing of an angle's turns; a bound is none.
    let rows = TWO_SLIDERS.replace(r#"{"rho":"x-s"}"#, r#"{"row":["1","y/s"]}"#);
    assert!(Problem::new(&one_to_one(&claim(&rows))).is_err());
    let mut bounded = one_to_one(&machine);
    bounded.require[0].bound = Bound::Max(number(1.0));
    assert!(Problem::new(&bounded).is_err());
}

#[test]
fn angles_at_joints() {
    let axis = [1.0, -2.0, 3.0];
    let given: &[(&str, &[f64])] = &[("axis", &axis)];
    for (quantity, machine, leg, most) in [
        ("base_joint", linear_delta(SLAB), 1, 20),
        ("platform_joint", orthoglide(), 2, 40),
        ("base_joint", struts(), 3, 20),
        ("platform_joint", rotary(), 2, 200),
    ] {
        let asked = Asked { quantity, leg: Some(leg), given, end: End::Max };
        let problem = Problem::new(&asked.of(&machine, 90.0)).expect("a claim");
        let prover = Prover::new(&problem);
        // The row of A is the leg's vector.
        let angle = |x: &[f64]| {
            let values = prover.values(x);
            let a = problem.legs[leg - 1].row.a.iter().map(|&f| values.of(f).expect("defined").0);
            let a = nalgebra::Vector3::from_iterator(a);
            let axis = nalgebra::Vector3::from_row_slice(&axis);
            (a.dot(&axis) / a.norm() / axis.norm()).acos().to_degrees()
        };
        let (worst, at) = prover.greatest(angle);
        asked.is_decided(&machine, worst, most, |_| (at.clone(), Failure::Obligation(1, vec![])));
        fn with(
            given: &[(&str, &[f64])],
            max: f64,
            asked: &Asked,
            of: &MachineClaim,
        ) -> MachineClaim {
            let Asked { quantity, leg, end, .. } = *asked;
            Asked { quantity, leg, given, end }.of(of, max)
        }
        let asked = |axis: &[f64], max| with(&[("axis", axis)], max, &asked, &machine);
        for (axis, max) in
            [(&[0.0, 0.0, 0.0][..], 45.0), (&[0.0, 1.0], 45.0), (&axis, 0.0), (&axis, 181.0)]
        {
            assert!(Problem::new(&asked(axis, max)).is_err(), "{axis:?} {max}");
        }
        // A leg that points the other way has the same squares.
        let other = angle(&at) - 180.0;
        let opposite = axis.map(|x| -x);
        let flipped = asked(&opposite, other.abs() * 0.99);
        assert!(certify(&flipped, 40).is_none());
    }
    let plane = r#"{"drive":"planar","direction":["0","0","1"]}"#;
    let machine =
        crate::leaves::machine(&[plane.to_owned(), plane.to_owned(), plane.to_owned()], SLAB);
    let asked = Asked { quantity: "base_joint", leg: Some(1), given, end: End::Max };
    assert!(Problem::new(&asked.of(&machine, 90.0)).is_err(), "a plane has no leg");
}

#[test]
fn joint_force() {
    let given: &[(&str, &[f64])] = &[("tool", &[100.0])];
    for (machine, leg, angular, most) in [
        (linear_delta(SLAB), 1, false, 20),
        (orthoglide(), 2, false, 40),
        (struts(), 3, false, 20),
        (rotary(), 1, true, 900),
        (claim(TWO_SLIDERS), 1, false, 30),
    ] {
        let asked = Asked { quantity: "joint_force", leg: Some(leg), given, end: End::Max };
        let problem = Problem::new(&asked.of(&machine, 1e3)).expect("a claim");
        let prover = Prover::new(&problem);
        let unit = if angular { (problem.scale as f64).exp2() } else { 1.0 };
        let inverse = |x: &[f64]| prover.matrix(x).and_then(|m| m.try_inverse()).expect("regular");
        let (worst, at) = prover.greatest(|x| inverse(x).column(leg - 1).norm());
        // A^T v along z, so that v = A^-T z.
        let (values, n) = (prover.values(&at), problem.legs.len());
        let a = nalgebra::DMatrix::from_fn(n, n, |i, k| {
            values.of(problem.legs[i].row.a[k]).expect("defined").0
        });
        let z = inverse(&at).column(leg - 1).into_owned();
        let v = a.transpose().lu().solve(&z).expect("regular").normalize();
        asked.is_decided(&machine, worst * unit * 100.0, most, |_| {
            (at.clone(), Failure::Obligation(1, vec![rounded(v.iter().copied())]))
        });
    }
    let mut redundant = linear_delta(SLAB);
    if let orthocert_kernel::claim::Mechanism::Translational(legs) = &mut redundant.mechanism {
        legs.push(legs[0].clone());
    }
    let asked = Asked { quantity: "joint_force", leg: None, given, end: End::Max };
    Problem::new(&asked.of(&linear_delta(SLAB), 1e3)).expect("well formed");
    assert!(Problem::new(&asked.of(&redundant, 1e3)).is_err(), "forces are not determined");
}

/// The machine with a tolerance of so much either way on each length and, but for arms, on each
/// coordinate of the anchors.
fn toleranced(machine: &MachineClaim, half: f64) -> MachineClaim {
    use orthocert_kernel::claim::{Leg, Mechanism, Quantity};
    use orthocert_kernel::number::Operator;
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
fn turned(difference: nalgebra::DVector<f64>) -> nalgebra::DVector<f64> {
    let turn = std::f64::consts::TAU;
    difference.map(|x| if x.abs() > 3.0 { x - turn * (x / turn).round() } else { x })
}

/// A machine of the tolerance, in doubles, by its values.
struct Built<'a> {
    problem: &'a Problem,
    parameters: Vec<crate::rough::Pair>,
}

impl<'a> Built<'a> {
    fn new(problem: &'a Problem, values: &[Expression]) -> Self {
        let parameters = problem.parameters::<num_bigint::BigInt>(96, values).expect("a machine");
        let middle = |x| {
            let (lo, hi): (f64, f64) = crate::prover::double(x, 96);
            ((lo + hi) / 2.0, (lo + hi) / 2.0)
        };
        Built { problem, parameters: parameters.iter().map(middle).collect() }
    }

    fn at(&self, x: &[f64]) -> (nalgebra::DVector<f64>, nalgebra::DMatrix<f64>) {
        use orthocert_kernel::formula::Op;
        use orthocert_kernel::machine::Joint;
        let values = self.problem.tape.run(&crate::rough::Rough, |op| match op {
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
        (nalgebra::DVector::from_fn(n, |i, _| rho(i)), nalgebra::DMatrix::from_fn(n, n, entry))
    }

    /// Where the machine is with these joint coordinates, by Newton's method from `x`.
    fn position(&self, x: &[f64], rho: &nalgebra::DVector<f64>) -> Vec<f64> {
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
    use crate::arithmetic::Random;
    use nalgebra::DVector;
    use orthocert_kernel::quantity::Test;
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
                use orthocert_kernel::number::Operator;
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
        assert!(matches!(problem.obligations[1].test, Test::Accuracy(_)));
    }
}

#[test]
fn accuracy_is_existence_and_uniqueness() {
    use orthocert_kernel::certificate::{Evidence, Step};
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
        (
            "Y of zero",
            (|y, _| y.y[0][0] = 0) as fn(&mut orthocert_kernel::test::Multiplier, &mut i64),
        ),
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
    if let orthocert_kernel::claim::Mechanism::Translational(legs) = &mut redundant.mechanism {
        legs.push(legs[0].clone());
    }
    assert!(Problem::new(&asked.of(&redundant, 1.0)).is_err(), "a joint too many");
    let rows = TWO_SLIDERS.replace(r#"{"rho":"x-s"}"#, r#"{"row":["1","y/s"]}"#);
    assert!(Problem::new(&asked.of(&claim(&rows), 1.0)).is_err(), "a joint by its row");
}
