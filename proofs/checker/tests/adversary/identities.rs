//! The slope identities, to far more digits than any single case could meet by accident, and
//! kinematics against geometry.

use super::random::Random;
use super::truth::{self, exact, V};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::claim::{MachineClaim, Mechanism, Requirements, Workspace};
use orthocert_checker::enclosure::Scalar;
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::JointCoordinate;
use orthocert_checker::linear::{add, apply, dot, sub, Vector};
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use orthocert_checker::trig::cos_sin;

const BITS: u32 = 360;

/// Both enclose one number, tightly.
fn same(x: &Fixed, y: &Fixed) -> bool {
    let difference = x.sub(y);
    let zero = BigInt::from(0);
    let width = difference.hi() - difference.lo();
    *difference.lo() <= zero && zero <= *difference.hi() && width < BigInt::from(1) << (BITS - 260)
}

fn all_same(x: &Vector<Fixed>, y: &Vector<Fixed>) -> bool {
    x.iter().zip(y).all(|(x, y)| same(x, y))
}

/// The number is in the enclosure, up to the digits of a double.
fn near(x: &Fixed, value: f64) -> bool {
    let slack = BigRational::from_float(1e-9 * value.abs().max(1.0)).expect("finite");
    let value = BigRational::from_float(value).expect("finite");
    x.inf() - &slack <= value && value <= x.sup() + slack
}

fn all_near(x: &Vector<Fixed>, values: &V) -> bool {
    x.iter().zip(values).all(|(x, &value)| near(x, value))
}

fn at_point(legs: &[truth::Leg; 3], p: V) -> Model<Fixed> {
    let point = p.map(exact);
    let claim = MachineClaim {
        mechanism: Mechanism::Translational(legs.map(|leg| leg.claimed())),
        workspace: Workspace::Box { min: point.clone(), max: point.clone() },
        requirements: Requirements::default(),
    };
    Model::at_point(&claim, None, &point, BITS).expect("enclosed")
}

#[test]
fn every_leg_meets_its_slope_identities_and_geometry() {
    let mut random = Random::new(6);
    let mut tried = 0;
    for _ in 0..600 {
        let (legs, p) = truth::machine(&mut random, 1e-4);
        let c = random.vector(0.5);
        if !legs.iter().all(|leg| leg.reach(c) > 1e-4) {
            continue;
        }
        let (here, there) = (at_point(&legs, c), at_point(&legs, p));
        let unit = (here.unit_exponent.expect("a power of two") as f64).exp2();
        let angular = matches!(legs[0], truth::Leg::Arm { .. });
        for (i, numbers) in legs.iter().enumerate() {
            let (w_c, w) = (&here.origin[i], &there.origin[i]);
            let delta = sub(w, w_c);
            let leg = &here.legs[i];
            let expansion = leg.expand(w_c, w).expect("within reach");
            let (state, state_c) = (leg.at(w).expect("reach"), leg.at(w_c).expect("reach"));
            let moved = add(&expansion.row, &apply(&expansion.slope, &delta));
            assert!(all_same(&expansion.row, &state_c.row), "{numbers:?}");
            assert!(all_same(&moved, &state.row), "{numbers:?}");
            let (unit_c, unit_slope) = leg.expand_unit(w_c, w).expect("reach");
            let (unit_p, _) = leg.expand_unit(w, w).expect("reach");
            assert!(all_same(&add(&unit_c, &apply(&unit_slope, &delta)), &unit_p));

            let truth = numbers.at(p);
            let rate = if angular { unit } else { 1.0 };
            let row = truth.row.map(|x| x * rate);
            assert!(all_near(&state.row, &row) && all_near(&unit_p, &truth.unit), "{numbers:?}");
            match (&state.rho, &expansion.rho) {
                (JointCoordinate::Length(rho), Some((rho_c, slope))) => {
                    assert!(same(rho, &rho_c.add(&dot(slope, &delta))));
                    assert!(near(rho, truth.rho / unit));
                }
                (JointCoordinate::Angle { cos, sin }, None) => {
                    let (expected_sin, expected_cos) = truth.rho.to_radians().sin_cos();
                    assert!(near(cos, expected_cos) && near(sin, expected_sin));
                    assert!(same(&cos.sqr().add(&sin.sqr()), &cos.integer_like(1)));
                }
                _ => panic!("a joint coordinate of the wrong kind"),
            }
            match (leg.cosine_squared(w), truth.cosine) {
                (Some(x), Some(cosine)) => assert!(near(&x, cosine * cosine)),
                (None, None) => {}
                _ => panic!("a cosine exactly for legs with a length"),
            }
            tried += 1;
        }
    }
    assert!(tried > 600, "{tried}");
}

#[test]
fn cosines_and_sines_agree_at_every_precision() {
    let mut random = Random::new(7);
    for round in 0..200 {
        let size = if round % 4 == 0 { 1e-3 } else { 360.0 };
        let degrees = random.between(-size, size);
        let fine = cos_sin(&exact(degrees), 1024).expect("within a turn");
        for bits in [32, 40, 64, 100, 256] {
            let coarse = cos_sin(&exact(degrees), bits).expect("within a turn");
            for (coarse, fine) in [(&coarse.0, &fine.0), (&coarse.1, &fine.1)] {
                assert!(coarse.inf() <= fine.inf() && fine.sup() <= coarse.sup());
                assert!(coarse.hi() - coarse.lo() <= BigInt::from(2));
            }
        }
        let (sin, cos) = degrees.to_radians().sin_cos();
        let slack = 1e-13;
        for (x, value) in [(&fine.0, cos), (&fine.1, sin)] {
            let (low, high) = (value - slack, value + slack);
            assert!(BigRational::from_float(low).expect("finite") <= x.inf());
            assert!(x.sup() <= BigRational::from_float(high).expect("finite"));
        }
    }
    // cos 36 = (1 + sqrt 5)/4, an exact value that no symmetry of the series gives.
    let golden = Exact::parse("(1+sqrt(5))/4", 100).map(|x| x.enclose(0, 1024));
    let golden = golden.expect("a number").expect("enclosed");
    let (cos, _) = cos_sin(&Exact::integer(36), 1024).expect("within a turn");
    assert!(cos.intersection(&golden).is_some());
}
