//! Quantities against sampling: a bound one per cent beyond the worst that is found is proved, one per
//! cent short of it refuted, and what proves the one proves nothing of the other.

use crate::certificates::claim;
use crate::false_claims::never_shown;
use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::prover::{certificate, certify, Prover};
use orthocert_kernel::certificate::{Certificate, Claim, Failure, Proof, Verdict, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Multiplier;
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
        let Failure::Obligation(obligation, _) = fails else { panic!("an obligation") };
        let tried = never_shown(&problem, point, *obligation, 5);
        assert!(tried > 100, "{}: {tried}", self.quantity);
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
pub const TWO_SLIDERS: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[],"definitions":[["s","sqrt(200^2-y^2)"]],"joints":[{"rho":"x-s"},{"rho":"x+s"}]}},"workspace":{"box":{"min":["-50","80"],"max":["50","160"]}},"require":[]}"#;

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

#[test]
fn load() {
    for (machine, leg, angular, force, most) in [
        (linear_delta(SLAB), 1, false, &[20.0, -30.0, -100.0][..], 40),
        (orthoglide(), 2, false, &[0.0, 0.0, -100.0], 60),
        (struts(), 3, false, &[-50.0, 0.0, 1.0], 120),
        (rotary(), 1, true, &[0.0, 0.0, -100.0], 900),
        (claim(TWO_SLIDERS), 1, false, &[3.0, -4.0], 30),
    ] {
        let given: &[(&str, &[f64])] = &[("force", force)];
        let asked = Asked { quantity: "load", leg: Some(leg), given, end: End::Max };
        let problem = Problem::new(&asked.of(&machine, 1e3)).expect("a claim");
        let prover = Prover::new(&problem);
        let unit = if angular { (problem.scale as f64).exp2() } else { 1.0 };
        let force = nalgebra::DVector::from_row_slice(force);
        let held = |x: &[f64]| {
            let transposed = prover.matrix(x).expect("defined").transpose();
            transposed.lu().solve(&force).expect("regular")[leg - 1]
        };
        let (worst, at) = prover.greatest(|x| held(x).abs());
        asked.is_proved(&machine, worst * unit, most);
        let short = Problem::new(&asked.of(&machine, worst * unit * 0.99)).expect("a claim");
        let prover = Prover::new(&short);
        let values = prover.values(&at);
        let value = |f| values.of(f).expect("defined").0;
        // Each sign of the load has its own test.
        let number = short.obligations.iter().position(|own| match own.test {
            Test::Beyond(det, b) => value(det).abs() < value(b),
            _ => false,
        });
        let fails = Failure::Obligation(number.expect("one of the two"), Vec::new());
        asked.is_refuted(&machine, worst * unit, &at, &[], &fails);
    }
    let refused = |machine: &MachineClaim, force: &[f64], bound: f64| {
        let given: &[(&str, &[f64])] = &[("force", force)];
        let asked = Asked { quantity: "load", leg: None, given, end: End::Max };
        assert!(Problem::new(&asked.of(machine, bound)).is_err(), "{force:?} {bound}");
    };
    refused(&linear_delta(SLAB), &[0.0, 0.0, 0.0], 1.0);
    refused(&linear_delta(SLAB), &[1.0, 0.0], 1.0);
    refused(&linear_delta(SLAB), &[1.0, 0.0, 0.0], 0.0);
    let mut redundant = linear_delta(SLAB);
    if let orthocert_kernel::claim::Mechanism::Translational(legs) = &mut redundant.mechanism {
        legs.push(legs[0].clone());
    }
    refused(&redundant, &[1.0, 0.0, 0.0], 1.0);
}

#[test]
fn constraint_margin() {
    use nalgebra::{Matrix3, Vector3};
    let strut = |anchor: &str, axis: &str| {
        format!(
            r#"{{"drive":"strut","anchor":[{anchor}],"platform":["0","0","0"],"base_axis":[{axis}]}}"#
        )
    };
    let legs = [
        strut(r#""-300","-180","0""#, r#""-180","300","0""#),
        strut(r#""310","-170","10""#, r#""-170","-310","0""#),
        strut(r#""5","340","-5""#, r#""1","0","1/4""#),
    ];
    let space = r#"{"box":{"min":["-60","-60","180"],"max":["60","60","260"]}}"#;
    let machine = crate::leaves::machine(&legs, space);
    let asked = Asked { quantity: "constraint_margin", leg: None, given: &[], end: End::Min };
    let problem = Problem::new(&asked.of(&machine, 0.1)).expect("a claim");
    let prover = Prover::new(&problem);
    let unit = (problem.scale as f64).exp2();
    let (anchors, axes) = (
        [[-300.0, -180.0, 0.0], [310.0, -170.0, 10.0], [5.0, 340.0, -5.0]],
        [[-180.0, 300.0, 0.0], [-170.0, -310.0, 0.0], [1.0, 0.0, 0.25]],
    );
    let couples = |x: &[f64]| {
        let rows = [0, 1, 2].map(|i| {
            let u = (Vector3::from_row_slice(x) * unit - Vector3::from(anchors[i])).normalize();
            let k = Vector3::from(axes[i]).normalize();
            (u - k * k.dot(&u)).normalize().transpose()
        });
        Matrix3::from_rows(&rows)
    };
    let (worst, at) = prover.greatest(|x| -couples(x).singular_values().min());
    let svd = couples(&at).svd(false, true);
    let v = svd.v_t.expect("right vectors").row(svd.singular_values.imin()).into_owned();
    asked.is_decided(&machine, -worst, 60, |_| {
        (at.clone(), Failure::Obligation(1, vec![rounded(v.iter().copied())]))
    });
    assert!(Problem::new(&asked.of(&struts(), 0.1)).is_err(), "struts without an axis");
    assert!(Problem::new(&asked.of(&machine, 0.0)).is_err(), "a bound of zero");
    // An axis along the leg leaves no couple.
    let along = legs[2].replace(r#""1","0","1/4""#, r#""-5","-340","225""#);
    let singular = crate::leaves::machine(&[legs[0].clone(), legs[1].clone(), along], space);
    assert!(certify(&asked.of(&singular, 0.001), 400).is_none());
}

#[test]
fn two_points_with_the_same_joint_coordinates() {
    let strut = |a: &str| format!(r#"{{"drive":"strut","anchor":[{a}],"platform":["0","0","0"]}}"#);
    let legs = [r#""-300","-180","0""#, r#""310","-170","0""#, r#""5","340","0""#].map(strut);
    let space = r#"{"box":{"min":["-60","-60","-50"],"max":["60","60","50"]}}"#;
    let mirrored = one_to_one(&crate::leaves::machine(&legs, space));
    let root = 3f64.sqrt();
    for (name, claim, point, other, half) in [
        ("a cube", one_to_one(&cube("1/2", "2")), vec![1.0, root], vec![1.0, -root], 1e-3),
        ("struts", mirrored, vec![3.0, -5.0, 40.0], vec![3.0, -5.0, -40.0], 0.5),
    ] {
        let problem = Problem::new(&claim).expect("well formed");
        let unit = (problem.scale as f64).exp2();
        let scaled = |x: &[f64]| x.iter().map(|x| x / unit).collect::<Vec<_>>();
        let m = Prover::new(&problem).matrix(&scaled(&other)).expect("defined");
        let inverse = m.try_inverse().expect("regular");
        let row = |i: usize| rounded(inverse.row(i).iter().copied());
        let y = Multiplier { y: (0..other.len()).map(row).collect(), places: 20 };
        let moved = |by: f64| other.iter().map(|x| number(x + by)).collect::<Vec<_>>();
        let good = (1, moved(-half), moved(half), y);
        let refuted = |(obligation, least, greatest, inverse)| {
            let fails = Failure::Same { obligation, least, greatest, inverse };
            let point = point.iter().map(|&x| number(x)).collect();
            let witness = Witness { precision: 96, point, machine: vec![], fails };
            check(&certificate(&claim, Verdict::Refuted, Proof::Witness(witness))).is_ok()
        };
        assert!(refuted(good.clone()), "{name}");
        let (_, least, greatest, y) = good.clone();
        let with = |y| (1, least.clone(), greatest.clone(), y);
        let places = |places| with(Multiplier { places, ..y.clone() });
        let rows = |y| with(Multiplier { y, places: 20 });
        let mut wide = y.y.clone();
        wide[0].push(0);
        let outside = moved(100.0);
        let own: Vec<Expression> = point.iter().map(|x| number(x - half)).collect();
        let about: Vec<Expression> = point.iter().map(|x| number(x + half)).collect();
        for (defect, proposed) in [
            ("another obligation", (0, least.clone(), greatest.clone(), y.clone())),
            ("no obligation", (2, least.clone(), greatest.clone(), y.clone())),
            ("a box about the point", (1, own, about, y.clone())),
            ("a box beside the solution", (1, moved(half / 2.0), moved(half * 2.0), y.clone())),
            ("a box of one point", (1, least.clone(), least.clone(), y.clone())),
            ("ends that cross", (1, greatest.clone(), least.clone(), y.clone())),
            ("beyond the workspace", (1, least.clone(), outside, y.clone())),
            ("a coordinate too few", (1, least[1..].to_vec(), greatest[1..].to_vec(), y.clone())),
            ("Y of zero", rows(y.y.iter().map(|row| vec![0; row.len()]).collect())),
            ("Y negated", rows(y.y.iter().map(|r| r.iter().map(|y| -y).collect()).collect())),
            ("Y of four times", places(18)),
            ("too many places", places(64)),
            ("Y with a row too few", rows(y.y[1..].to_vec())),
            ("Y with an entry too many", rows(wide)),
        ] {
            assert!(!refuted(proposed), "{name}: {defect}");
        }
    }
}

#[test]
fn in_a_cylinder() {
    let machine = linear_delta(r#"{"cylinder":{"center":["0","0"],"radius":"80","z":["0","1"]}}"#);
    let asked = |quantity, given| Asked { quantity, leg: None, given, end: End::Max };
    let force: &[(&str, &[f64])] = &[("tool", &[1.0])];
    let error: &[(&str, &[f64])] = &[("joint_error", &[0.01])];
    let problem = Problem::new(&asked("joint_force", force).of(&machine, 2.0)).expect("a claim");
    let prover = Prover::new(&problem);
    let inverse = |x: &[f64]| prover.matrix(x).and_then(|m| m.try_inverse()).expect("regular");
    let columns = |x: &[f64]| {
        let norm = |k: usize| (inverse(x).column(k).norm(), k);
        (0..3).map(norm).max_by(|a, b| a.0.total_cmp(&b.0)).expect("columns")
    };
    let (worst, at) = prover.greatest(|x| columns(x).0);
    asked("joint_force", force).is_proved(&machine, worst, 60);
    let claim = asked("joint_force", force).of(&machine, worst * 0.99);
    let problem = Problem::new(&claim).expect("a claim");
    assert!(never_shown(&problem, &at, 1 + columns(&at).1, 3) > 100);
    // Joint errors alone: to first order |M^-1 s| for signs s.
    let signs = [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]];
    let off = |x: &[f64]| {
        let inverse = inverse(x);
        let norm = |s: &[f64; 3]| (&inverse * nalgebra::DVector::from_row_slice(s)).norm();
        signs.iter().map(norm).fold(0.0, f64::max)
    };
    let (worst, at) = prover.greatest(off);
    asked("accuracy", error).is_proved(&machine, worst * 0.01, 90);
    let claim = asked("accuracy", error).of(&machine, worst * 0.0099);
    let problem = Problem::new(&claim).expect("a claim");
    assert!(never_shown(&problem, &at, 1, 3) > 100);
}

#[test]
fn planes_and_more_legs_than_coordinates() {
    let plane = |n: [&str; 3]| format!(r#"{{"drive":"planar","direction":{n:?}}}"#);
    let legs = [plane(["1", "0", "0"]), plane(["0", "1", "0"]), plane(["3/5", "0", "4/5"])];
    let planes = crate::leaves::machine(&legs, SLAB);
    let given: &[(&str, &[f64])] = &[("acceleration", &[10.0]), ("speed", &[100.0])];
    let asked = Asked { quantity: "joint_acceleration", leg: None, given, end: End::Max };
    // Rows are unit vectors and do not vary.
    check(&certify(&asked.of(&planes, 10.01), 4).expect("a proof")).expect("accepted");
    assert!(certify(&asked.of(&planes, 9.99), 40).is_none());
    check(&certify(&one_to_one(&planes), 4).expect("a proof")).expect("accepted");
    let mut four = linear_delta(SLAB);
    if let orthocert_kernel::claim::Mechanism::Translational(legs) = &mut four.mechanism {
        legs.push(legs[0].clone());
    }
    check(&certify(&one_to_one(&four), 20).expect("a proof")).expect("accepted");
    let given: &[(&str, &[f64])] = &[("joint", &[1.0, 1.0, 1.0, 1e-9])];
    let asked = |given| Asked { quantity: "stiffness", leg: None, given, end: End::Min };
    let alone = asked(&[("joint", &[1.0])]);
    // A fourth leg that is soft adds nothing; one as stiff as the others does.
    let problem = Problem::new(&alone.of(&linear_delta(SLAB), 0.1)).expect("a claim");
    let prover = Prover::new(&problem);
    let singular = |x: &[f64]| prover.matrix(x).expect("within reach").singular_values().min();
    let (least, _) = prover.greatest(|x| -singular(x).powi(2));
    let bound = -least * 1.01;
    assert!(certify(&alone.of(&linear_delta(SLAB), bound), 400).is_none());
    assert!(certify(&asked(given).of(&four, bound), 400).is_none());
    check(&certify(&asked(given).of(&four, -least * 0.98), 400).expect("a proof"))
        .expect("accepted");
}
