//! The paper's cube: what a claim about it says is what the paper's Steps 1 to 3 construct.

use super::machines::{self, cube, exact, reference, REFERENCE_BITS};
use super::random::Random;
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Quantity, Sign, Workspace};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::number::Exact;
use std::array::from_fn;

fn constants(psi_max: &str, side: &str) -> CubeConstants {
    CubeConstants::new(&exact(psi_max), &exact(side)).unwrap()
}

fn assert_near(found: &Fixed, printed: &str) {
    let value = exact(printed).as_rational().unwrap().clone();
    // Half a unit of the digits printed, and a little more.
    let digits = printed.split('.').nth(1).map_or(0, str::len);
    let half = BigRational::new(BigInt::from(51), BigInt::from(10).pow(digits as u32 + 2));
    assert!(found.inf() - &half <= value && value <= found.sup() + &half, "{printed}");
}

#[test]
fn the_prototype_has_its_published_dimensions() {
    let c = constants("2", "200");
    let length = exact("1").over(c.inverse_length.clone()).unwrap();
    let times_length = |q: &Exact| q.clone().times(length.clone()).unwrap();
    let enclosed = |x: &Exact| x.enclose(0, REFERENCE_BITS).unwrap();
    assert_near(&enclosed(&length), "310.582854123025");
    assert_near(&enclosed(&times_length(&c.q1)), "-73.2050807568877");
    assert_near(&enclosed(&times_length(&c.q2)), "126.794919243112");
    assert_eq!((c.t1, c.t2), (exact("1/4"), exact("1/2")));
}

#[test]
fn joint_coordinates_start_at_zero_on_an_axis_and_end_at_q2() {
    let claim = cube("2", "200");
    let unit = |rho: &Fixed| rho.inf() / inverse_length(&claim);
    // rho_1 = 0 at (q_1, 0, 0) and L_workspace + L - s(Q_2) = 256.993 at Q_2, the greatest.
    let zero = BigRational::from_integer(0.into());
    let at_axis = exact("0");
    let (min, _) = machines::ends(&claim);
    let point = [min[0].clone(), at_axis.clone(), at_axis];
    let model = Model::at_point(&claim, None, &point, REFERENCE_BITS).unwrap();
    let rho = machines::states(&model).unwrap()[0].rho.length().unwrap().clone();
    assert!(rho.inf() <= zero && zero <= rho.sup());
    let ones = from_fn(|_| BigRational::from_integer(1.into()));
    let at_q2 = reference(&claim, &ones).unwrap();
    for state in &at_q2 {
        let rho = Fixed::rational(&unit(state.rho.length().unwrap()), 0, REFERENCE_BITS);
        assert_near(&rho, "256.9930156368");
    }
}

fn inverse_length(claim: &MachineClaim) -> BigRational {
    let Workspace::Cube { side } = &claim.workspace else { panic!("not a cube") };
    let psi_max = claim.requirements.transmission.as_ref().unwrap().max.as_ref().unwrap();
    let constants = CubeConstants::new(psi_max, side).unwrap();
    constants.inverse_length.enclose(0, REFERENCE_BITS).unwrap().inf()
}

/// The Orthoglide of the cube, leg by leg: length `L`, anchors `a e_i` with `a = q_1 - e - L`,
/// platform offsets `-e e_i`.
fn leg_by_leg(psi_max: &str, side: &str, e: &Exact) -> [Leg; 3] {
    let c = constants(psi_max, side);
    let length = exact("1").over(c.inverse_length).unwrap();
    let q1 = c.q1.times(length.clone()).unwrap();
    let base = q1.minus(e.clone()).unwrap().minus(length.clone()).unwrap();
    let along = |i: usize, x: &Exact| {
        from_fn(|k| Quantity::exactly(if i == k { x.clone() } else { Exact::integer(0) }))
    };
    from_fn(|i| Leg::Slider {
        direction: along(i, &Exact::integer(1)),
        anchor: along(i, &base),
        platform: along(i, &e.clone().negated()),
        length: Quantity::exactly(length.clone()),
        mode: Sign::Plus,
    })
}

#[test]
fn the_cube_s_machine_is_the_same_leg_by_leg() {
    let mut random = Random::new(80);
    for (psi_max, side, offset) in
        [("2", "200", "0"), ("2", "200", "35.5"), ("1.1", "7/3", "-1"), ("17", "1e-9", "1e-10")]
    {
        let mut claim = cube(psi_max, side);
        let e = exact(offset);
        claim.mechanism = Mechanism::Orthoglide { offset: e.clone() };
        let legs = leg_by_leg(psi_max, side, &e);
        let scale = inverse_length(&claim);
        for _ in 0..10 {
            let u = from_fn(|_| random.rational(0, 64, 64));
            let point = machines::point(&claim, &u);
            let here = Workspace::Box { min: point.clone(), max: point.clone() };
            let explicit = MachineClaim {
                mechanism: Mechanism::Translational(legs.clone()),
                workspace: here,
                requirements: claim.requirements.clone(),
            };
            let model = Model::at_point(&explicit, None, &point, REFERENCE_BITS).unwrap();
            let exponent = i32::try_from(model.unit_exponent.unwrap()).unwrap();
            let unit = BigRational::from_integer(2.into()).pow(exponent) * &scale;
            let (cube, legs) = (reference(&claim, &u).unwrap(), machines::states(&model).unwrap());
            let close = BigRational::new(1.into(), BigInt::from(1) << 180);
            let apart = |x: &Fixed, y: BigRational| (x.inf() - y).pow(2) > &close * &close;
            for (one, other) in cube.iter().zip(&legs) {
                let rows = one.row.iter().zip(&other.row);
                assert!(!rows.into_iter().any(|(x, y)| apart(x, y.inf())), "{psi_max} {offset}");
                let [one_rho, other_rho] = [one, other].map(|state| state.rho.length().unwrap());
                assert!(!apart(one_rho, other_rho.inf() * &unit), "{psi_max} {offset}");
                assert!(!apart(&one.eta, other.eta.inf() * &unit), "{psi_max} {offset}");
            }
        }
    }
}
