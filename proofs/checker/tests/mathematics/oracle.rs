//! Against values that another program computed: `oracle/make.py`, by mpmath, to 40 digits.

use super::machines::{exact, states, REFERENCE_BITS};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use orthocert_checker::claim::{
    Leg, MachineClaim, Mechanism, Quantity, Requirements, Sign, Workspace,
};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{determinant, Matrix, Symmetric};
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use serde_json::Value;

/// One point of the oracle.
pub struct Point {
    /// The mechanism's name and the point's position in its list.
    pub name: String,
    /// The machine; its workspace is the point.
    pub claim: MachineClaim,
    pub point: [Exact; 3],
    /// Absent where some leg does not reach the point.
    pub values: Option<Values>,
}

/// What the oracle says of a point, in the machine's unit of length.
pub struct Values {
    pub singular_values: [BigRational; 3],
    pub det: BigRational,
    pub eta: [BigRational; 3],
    pub rho: [BigRational; 3],
}

/// Half a unit in the last of 40 digits of numbers below 1000, and room for it.
pub fn tolerance() -> BigRational {
    BigRational::new(BigInt::one(), BigInt::from(10).pow(36))
}

pub fn points() -> Vec<Point> {
    let file: Value = serde_json::from_str(include_str!("../oracle/points.json")).unwrap();
    file["cases"].as_array().unwrap().iter().flat_map(points_of).collect()
}

fn points_of(case: &Value) -> Vec<Point> {
    let legs: Vec<Leg> = case["legs"].as_array().unwrap().iter().map(leg).collect();
    let legs: [Leg; 3] = legs.try_into().unwrap();
    let points = case["points"].as_array().unwrap();
    let point = |(i, value): (usize, &Value)| {
        let point = three(&value["point"]).map(|x| exact(&x));
        Point {
            name: format!("{} {i}", case["name"]),
            claim: MachineClaim {
                mechanism: Mechanism::Translational(legs.clone()),
                workspace: Workspace::Box { min: point.clone(), max: point.clone() },
                requirements: Requirements::default(),
            },
            point,
            values: value["reachable"].as_bool().unwrap().then(|| Values {
                singular_values: three(&value["singular_values"]).map(|x| decimal(&x)),
                det: decimal(value["det"].as_str().unwrap()),
                eta: three(&value["eta"]).map(|x| decimal(&x)),
                rho: three(&value["rho"]).map(|x| decimal(&x)),
            }),
        }
    };
    points.iter().enumerate().map(point).collect()
}

fn leg(value: &Value) -> Leg {
    let vector = |key: &str| three(&value[key]).map(|x| Quantity::exactly(exact(&x)));
    Leg::Slider {
        direction: vector("direction"),
        anchor: vector("anchor"),
        platform: vector("platform"),
        length: Quantity::exactly(exact(value["length"].as_str().unwrap())),
        mode: if value["mode"] == "+" { Sign::Plus } else { Sign::Minus },
    }
}

fn three(value: &Value) -> [String; 3] {
    std::array::from_fn(|k| value[k].as_str().unwrap().to_owned())
}

fn decimal(text: &str) -> BigRational {
    exact(text).as_rational().unwrap().clone()
}

/// The claim's unit of length in the model's: lengths are to be divided by it.
pub fn unit(model: &Model<Fixed>) -> BigRational {
    let exponent = i32::try_from(model.unit_exponent.unwrap()).unwrap();
    BigRational::from_integer(2.into()).pow(exponent)
}

fn assert_near(enclosure: &Fixed, value: &BigRational, what: &str) {
    let (inf, sup) = (enclosure.inf(), enclosure.sup());
    assert!(inf - tolerance() <= *value && *value <= sup + tolerance(), "{what}");
    // The enclosure is no wider than the oracle is exact.
    assert!(enclosure.sup() - enclosure.inf() < tolerance(), "{what}: wide");
}

#[test]
fn every_point_has_the_oracle_s_kinematics() {
    let (mut reached, mut unreached) = (0, 0);
    for Point { name, claim, point, values } in points() {
        let model = Model::at_point(&claim, None, &point, REFERENCE_BITS).unwrap();
        let Some(values) = values else {
            assert!(states(&model).is_none(), "{name}");
            let beyond =
                |i: usize| model.legs[i].clearance(&model.origin[i]).neg().is_nonnegative();
            assert!((0..3).any(beyond), "{name}: no leg is certainly out of reach");
            unreached += 1;
            continue;
        };
        let unit = unit(&model);
        let states = states(&model).unwrap_or_else(|| panic!("{name}: out of reach"));
        for (i, state) in states.iter().enumerate() {
            assert_near(&state.eta, &(&values.eta[i] / &unit), &format!("{name}: eta {i}"));
            assert_near(
                state.rho.length().unwrap(),
                &(&values.rho[i] / &unit),
                &format!("{name}: rho {i}"),
            );
        }
        let m = states.map(|state| state.row);
        assert_near(&determinant(&m), &values.det, &format!("{name}: det"));
        reached += 1;
    }
    assert_eq!((reached, unreached), (278, 2));
}

#[test]
fn every_point_has_the_oracle_s_singular_values() {
    let eps = BigRational::new(BigInt::one(), BigInt::from(10).pow(30));
    for Point { name, claim, point, values } in points() {
        let Some(values) = values else { continue };
        let model = Model::at_point(&claim, None, &point, REFERENCE_BITS).unwrap();
        let m = states(&model).unwrap().map(|state| state.row);
        for (k, sigma) in values.singular_values.iter().enumerate() {
            let signs = [sigma - &eps, sigma + &eps].map(|x| characteristic_sign(&m, &x));
            assert_eq!(signs[0] * signs[1], -1, "{name}: xi {k} = {sigma}");
            // Twice as far out on one side there is no root: the test tells values apart.
            let beside = [sigma + &eps, sigma + &eps + &eps].map(|x| characteristic_sign(&m, &x));
            assert_eq!(beside[0] * beside[1], 1, "{name}: xi {k} + 1e-30");
        }
    }
}

/// The certain sign of `det(M^T M - sigma^2 I)`; zero if it is not certain.
fn characteristic_sign(m: &Matrix<Fixed>, sigma: &BigRational) -> i32 {
    let square = Fixed::rational(&(sigma * sigma), 0, REFERENCE_BITS);
    let Symmetric { diagonal: [a, b, c], off: [x, y, z] } =
        Symmetric::gram_of(m).minus_identity(&square);
    let full = [[a, x.clone(), y.clone()], [x, b, z.clone()], [y, z, c]];
    let det = determinant(&full);
    if det.is_positive() {
        1
    } else {
        -i32::from(det.neg().is_positive())
    }
}
