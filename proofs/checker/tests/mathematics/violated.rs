//! The rule for violations over a cell: what it accepts, what it rejects, and that it is right.

use super::approximate::{Approximate, Approximation};
use super::machines::{
    all, exact, linear_delta, orthoglide, random_cell, random_lambda, reference, within_cell,
};
use super::random::Random;
use orthocert_checker::cell::{Cell, Edge};
use orthocert_checker::certificate::{Direction, LegNumber, SecondPoint, TwoDirections, Violation};
use orthocert_checker::claim::{
    AtLeast, AtMost, JointSpeed, Leg, MachineClaim, Mechanism, Quantity, Range, Sign, Workspace,
};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::Leg as Kinematics;
use orthocert_checker::linear::norm_squared;
use orthocert_checker::model::Model;
use orthocert_checker::rule::{violated, Failure};

const BITS: u32 = 64;

fn model(claim: &MachineClaim) -> Model<Fixed> {
    Model::new(claim, BITS).unwrap()
}

/// The Orthoglide with `L = 1` and `1/2 <= psi <= 2` over a box.
fn bounded(low: &str, high: &str) -> MachineClaim {
    let mut claim = orthoglide("1", low, high);
    let range = Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    claim.requirements.transmission = Some(range);
    claim
}

fn sigma_min(vector: [i64; 3]) -> Violation {
    Violation::SigmaMin(Direction { vector })
}

fn sigma_max(vector: [i64; 3]) -> Violation {
    Violation::SigmaMax(Direction { vector })
}

fn leg(leg: usize) -> LegNumber {
    LegNumber { leg }
}

const NOT: Result<(), Failure> = Err(Failure::NotViolated);

#[test]
fn transmission_at_single_points_of_the_diagonal() {
    // At (c, c, c): sigma_min = 1 + 2m along (1, 1, 1) for m < 0, sigma_max = 1 + 2m for m > 0,
    // m = c/sqrt(1 - 2 c^2): the bounds 1/2 and 2 are met at m = -1/4 and m = 1/2, that is at
    // c = -1/sqrt(18) = -0.23570 and c = 1/sqrt(6) = 0.40824.
    let diagonal = [1, 1, 1];
    for (row, point, violation, expected) in [
        ("just beyond", "-2358/10000", sigma_min(diagonal), Ok(())),
        ("just within", "-2357/10000", sigma_min(diagonal), NOT),
        ("met with equality", "-1/sqrt(18)", sigma_min(diagonal), NOT),
        ("another direction", "-2358/10000", sigma_min([1, -1, 0]), NOT),
        ("the other bound", "-2358/10000", sigma_max(diagonal), NOT),
        ("zero vector", "-2358/10000", sigma_min([0; 3]), Err(Failure::ZeroVector)),
        ("just beyond", "4083/10000", sigma_max(diagonal), Ok(())),
        ("just beyond, long vector", "4083/10000", sigma_max([-(1 << 40); 3]), Ok(())),
        ("just within", "4082/10000", sigma_max(diagonal), NOT),
        ("met with equality", "1/sqrt(6)", sigma_max(diagonal), NOT),
        ("double singular value", "4083/10000", sigma_min([1, -1, 0]), Ok(())),
        ("zero vector", "4083/10000", sigma_max([0; 3]), Err(Failure::ZeroVector)),
        ("out of reach", "3/4", sigma_max(diagonal), Err(Failure::OutOfReach(0))),
        ("out of reach", "3/4", Violation::Reach(leg(1)), Ok(())),
        ("out of reach", "3/4", Violation::Row(leg(1)), Ok(())),
        ("serially singular", "1/sqrt(2)", Violation::Row(leg(3)), Ok(())),
        ("row at its bound", "sqrt(3/8)", Violation::Row(leg(2)), NOT),
        ("row just beyond", "sqrt(3/8)+1/100000", Violation::Row(leg(2)), Ok(())),
        ("row just within", "sqrt(3/8)-1/100000", Violation::Row(leg(2)), NOT),
        ("no such leg", "3/4", Violation::Reach(leg(0)), Err(Failure::NoSuchLeg(0))),
        ("no such leg", "3/4", Violation::Row(leg(4)), Err(Failure::NoSuchLeg(4))),
    ] {
        let claim = bounded(point, point);
        let found = violated(&model(&claim), &Cell::ROOT, &violation);
        assert_eq!(found, expected, "{row} at {point}: {violation:?}");
    }
}

#[test]
fn reach_at_a_serial_singularity() {
    // L = 5/4, r = (0, 3/4, 1): s_1 = 0 exactly, which is a serial singularity, so violated.
    let over = |z: &str| {
        let mut claim = orthoglide("5/4", "0", "1");
        let Workspace::Box { min, max } = &mut claim.workspace else { panic!("not a box") };
        *min = [exact("0"), exact("3/4"), exact(z)];
        *max = [exact("1/64"), exact("7/8"), exact("9/8")];
        claim
    };
    let reach = |z, n| violated(&model(&over(z)), &Cell::ROOT, &Violation::Reach(leg(n)));
    assert_eq!(reach("1", 1), Ok(()));
    assert_eq!(reach("1", 2), NOT);
    assert_eq!(reach("1023/1024", 1), NOT, "one corner within reach");
}

#[test]
fn one_good_point_in_the_cell_is_enough_to_reject() {
    // Cells along the diagonal, of edge 1/1024, on both sides of where sigma_max = 2 and
    // sigma_min = 1/2.
    let claim = bounded("-1/2", "1/2");
    let model = model(&claim);
    let cell = |n: u128| Cell { edges: [Edge { index: n, level: 10 }; 3] };
    let diagonal = [1, 1, 1];
    // -1/sqrt(18) is in cell 270, 1/sqrt(6) in cell 930.
    for (n, violation, expected) in [
        (269, sigma_min(diagonal), Ok(())),
        (270, sigma_min(diagonal), NOT),
        (271, sigma_min(diagonal), NOT),
        (929, sigma_max(diagonal), NOT),
        (930, sigma_max(diagonal), NOT),
        (931, sigma_max(diagonal), Ok(())),
    ] {
        assert_eq!(violated(&model, &cell(n), &violation), expected, "cell {n}");
    }
}

#[test]
fn bounds_that_the_claim_does_not_have_are_not_violated() {
    let mut claim = linear_delta();
    claim.requirements.transmission = None;
    let model = model(&claim);
    for violation in [
        sigma_min([1, 0, 0]),
        sigma_max([1, 0, 0]),
        Violation::Row(leg(1)),
        Violation::JointRange(leg(1)),
        Violation::Conditioning(TwoDirections { u: [1, 0, 0], v: [0, 0, 1] }),
        Violation::SerialMargin(leg(1)),
        Violation::LegAngle(leg(1)),
        Violation::ParallelMargin,
        Violation::JointSpeed(leg(1)),
    ] {
        let found = violated(&model, &Cell::ROOT, &violation);
        assert_eq!(found, Err(Failure::NoSuchBound), "{violation:?}");
    }
    let other = [exact("0"), exact("0"), exact("0")];
    let singular = Violation::Singular(SecondPoint { other });
    assert_eq!(violated(&model, &Cell::ROOT, &singular), Err(Failure::OtherKind));
}

#[test]
fn every_machine_of_the_tolerance_has_to_violate() {
    let mut claim = bounded("4083/10000", "4084/10000");
    let diagonal = sigma_max([1, 1, 1]);
    assert_eq!(violated(&model(&claim), &Cell::ROOT, &diagonal), Ok(()));
    let Mechanism::Translational(legs) = &mut claim.mechanism else { panic!("no legs") };
    for leg in legs {
        let Leg::Slider { length, .. } = leg else { panic!("not a slider") };
        *length = Quantity { min: exact("1"), max: exact("101/100") };
    }
    // With legs of 1.01 the point is within the bounds.
    assert_eq!(violated(&model(&claim), &Cell::ROOT, &diagonal), NOT);
}

/// Whether the claim fails at a point, in doubles, where it is not too close to call.
fn fails(claim: &MachineClaim, at: Option<&Approximation>, bounds: (f64, f64)) -> Option<bool> {
    let Some(at) = at else { return Some(true) };
    let margins = [at.xi[0] - bounds.0, bounds.1 - at.xi[2]];
    let least = margins.into_iter().fold(f64::INFINITY, f64::min);
    assert!(claim.requirements.transmission.is_some());
    (least.abs() > 1e-9).then_some(least < 0.0)
}

#[test]
fn whatever_is_accepted_fails_at_every_point_tried() {
    let mut random = Random::new(7);
    let (mut accepted, mut rejected) = (0, 0);
    for (name, mut claim) in all().into_iter().filter(|(_, c)| !is_cube(c)) {
        let range = Range { min: Some(exact("4/5")), max: Some(exact("5/4")) };
        claim.requirements.transmission = Some(range);
        let model = model(&claim);
        let approximate = Approximate::new(&model);
        for _ in 0..400 {
            let cell = random_cell(&mut random, 6);
            let vector = std::array::from_fn(|_| random.within(-3, 3));
            let number = leg(usize::try_from(random.within(1, 3)).unwrap());
            let candidates = [
                sigma_min(vector),
                sigma_max(vector),
                Violation::Row(number.clone()),
                Violation::Reach(number),
            ];
            if !candidates.iter().any(|v| violated(&model, &cell, v).is_ok()) {
                rejected += 1;
                continue;
            }
            accepted += 1;
            for _ in 0..20 {
                let lambda = random_lambda(&mut random);
                let at = approximate.at(&cell, &lambda.map(|x| x as f64 / 256.0));
                let failing = fails(&claim, at.as_ref(), (0.8, 1.25));
                assert_ne!(failing, Some(false), "{name}: {cell} at {lambda:?}");
            }
        }
    }
    assert!(accepted > 200 && rejected > 200, "{accepted} {rejected}");
}

fn is_cube(claim: &MachineClaim) -> bool {
    matches!(claim.workspace, Workspace::Cube { .. })
}

#[test]
fn other_requirements_over_a_cell() {
    // On [2/5, 2/5 + 1/100]^3 of the Orthoglide with L = 1: 1/cos^2 = L^2/s^2, s^2 = 0.68 .. 0.6638.
    let mut claim = bounded("2/5", "41/100");
    let at_most = |x: &str| Some(AtMost { max: exact(x) });
    let at_least = |x: &str| Some(AtLeast { min: exact(x) });
    let check = |claim: &MachineClaim, v: &Violation| violated(&model(claim), &Cell::ROOT, v);
    // (eta/L)^2 = s^2 is at most 0.68 = 0.8246^2, and at least 0.6638 = 0.8147^2.
    for (bound, expected) in [("83/100", Ok(())), ("82/100", NOT)] {
        claim.requirements.serial_margin = at_least(bound);
        assert_eq!(check(&claim, &Violation::SerialMargin(leg(2))), expected, "{bound}");
    }
    // acos(0.8246) = 34.45 degrees, acos(0.8147) = 35.44.
    for (bound, expected) in [("34", Ok(())), ("35", NOT)] {
        claim.requirements.leg_angle = at_most(bound);
        assert_eq!(check(&claim, &Violation::LegAngle(leg(1))), expected, "{bound}");
    }
    // |row| = 1/s: from 1.2127 to 1.2274.
    for (bound, expected) in [("121/100", Ok(())), ("122/100", NOT), ("123/100", NOT)] {
        claim.requirements.joint_speed = Some(JointSpeed { tool: exact("1"), max: exact(bound) });
        assert_eq!(check(&claim, &Violation::JointSpeed(leg(3))), expected, "{bound}");
    }
    // M = (1 - m) I + m 11^T, m from 0.4851 to 0.5032: sigma_max/sigma_min from 3.83 to 4.04.
    for (bound, expected) in [("37/10", Ok(())), ("39/10", NOT)] {
        claim.requirements.conditioning = at_most(bound);
        let both = TwoDirections { u: [1, 1, 1], v: [1, -1, 0] };
        assert_eq!(check(&claim, &Violation::Conditioning(both)), expected, "{bound}");
        let exchanged = TwoDirections { v: [1, 1, 1], u: [1, -1, 0] };
        assert_eq!(check(&claim, &Violation::Conditioning(exchanged)), NOT, "{bound}");
        let zero = TwoDirections { u: [1, 1, 1], v: [0; 3] };
        let found = check(&claim, &Violation::Conditioning(zero));
        assert_eq!(found, Err(Failure::ZeroVector), "{bound}");
    }
    // det U = s^3 (1 - m)^2 (1 + 2m): from 0.293 to 0.269.
    for (bound, expected) in [("32/100", Ok(())), ("28/100", NOT), ("1/10", NOT)] {
        claim.requirements.parallel_margin = at_least(bound);
        assert_eq!(check(&claim, &Violation::ParallelMargin), expected, "{bound}");
    }
    // rho = c - s: from -0.4247 to -0.4047.
    let range =
        |min: Option<&str>, max: Option<&str>| Range { min: min.map(exact), max: max.map(exact) };
    for (range, expected) in [
        (range(Some("-2/5"), None), Ok(())),
        (range(Some("-41/100"), None), NOT),
        (range(None, Some("-43/100")), Ok(())),
        (range(None, Some("-42/100")), NOT),
        (range(Some("-1"), Some("1")), NOT),
    ] {
        claim.requirements.joint_range = Some([range.clone(), range.clone(), range.clone()]);
        assert_eq!(check(&claim, &Violation::JointRange(leg(1))), expected, "{range:?}");
    }
}

#[test]
fn the_row_of_a_leg_is_as_long_as_its_formula_says() {
    let mut random = Random::new(3);
    for (name, claim) in all() {
        let model = model(&claim);
        for _ in 0..20 {
            let cell = random_cell(&mut random, 4);
            let u = within_cell(&cell, &random_lambda(&mut random));
            let Some(states) = reference(&claim, &u) else { continue };
            let point = super::machines::point(&claim, &u);
            let exactly = Model::at_point(&claim, None, &point, 256).unwrap();
            for (i, state) in states.iter().enumerate() {
                let inverse = exactly.legs[i].inverse_row_squared(&exactly.origin[i]);
                let (Some(inverse), true) =
                    (inverse, matches!(model.legs[i], Kinematics::Slider(_)))
                else {
                    continue;
                };
                let product = super::approximate::double(&norm_squared(&state.row))
                    * super::approximate::double(&inverse);
                assert!((product - 1.0).abs() < 1e-9, "{name}: leg {i}: {product}");
            }
        }
    }
}

#[test]
fn the_row_of_an_arm_is_as_long_as_its_formula_says() {
    let quantities = |texts: [&str; 3]| texts.map(|t| Quantity::exactly(exact(t)));
    let arm = Leg::Arm {
        axis: quantities(["0", "1", "0"]),
        reference: quantities(["1", "0", "0"]),
        anchor: quantities(["100", "0", "0"]),
        platform: quantities(["30", "0", "0"]),
        arm: Quantity::exactly(exact("120")),
        length: Quantity::exactly(exact("260")),
        mode: Sign::Plus,
    };
    let mut claim = linear_delta();
    claim.mechanism = Mechanism::Translational([arm.clone(), arm.clone(), arm]);
    let mut seen = 0;
    for point in
        [["0", "0", "-250"], ["31", "-17", "-200"], ["-40", "22", "-299"], ["0", "0", "-900"]]
    {
        let model = Model::at_point(&claim, None, &point.map(exact), 128).unwrap();
        let inverse = model.legs[0].inverse_row_squared(&model.origin[0]).unwrap();
        let inverse = super::approximate::double(&inverse);
        match model.legs[0].at(&model.origin[0]) {
            Some(state) => {
                let product = super::approximate::double(&norm_squared(&state.row)) * inverse;
                assert!((product - 1.0).abs() < 1e-9, "{point:?}: {product}");
                seen += 1;
            }
            None => assert!(inverse <= 0.0, "{point:?}"),
        }
    }
    assert_eq!(seen, 3);
}
