//! Sliders against values that another program computed: `oracle/make.py`, by mpmath, to 40 digits.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed};
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{Formula, Values};
use orthocert_kernel::machine::Joint;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use serde_json::{json, Value};

const BITS: u32 = 320;

type Number = Interval<BigInt>;

/// The machine, and a point as its workspace.
fn claim(case: &Value, point: &Value) -> MachineClaim {
    let of = |leg: &Value| {
        json!({
            "drive": "slider", "direction": leg["direction"], "anchor": leg["anchor"],
            "platform": leg["platform"], "length": leg["length"], "mode": leg["mode"],
        })
    };
    let legs: Vec<Value> = case["legs"].as_array().unwrap().iter().map(of).collect();
    let workspace = json!({ "box": { "min": point["point"], "max": point["point"] } });
    let claim = json!({
        "mechanism": { "translational": legs }, "workspace": workspace, "require": [],
    });
    serde_json::from_value(claim).unwrap()
}

/// A machine's formulas at its point.
struct At {
    problem: Problem,
    values: Values<Number>,
}

impl At {
    fn new(claim: &MachineClaim) -> Self {
        let problem = Problem::new(claim).unwrap();
        let parameters = problem.parameters::<BigInt>(BITS, &[]).unwrap();
        let point = problem.root::<BigInt>(BITS).unwrap().0;
        let values = problem.tape.run(
            &Fixed::<BigInt>::new(BITS),
            |k| point.get(k).cloned(),
            |j| parameters.get(j).cloned(),
        );
        At { problem, values }
    }

    fn of(&self, formula: Formula) -> Option<Number> {
        self.values.of(formula).cloned()
    }

    /// `M`; none where some leg does not reach the point.
    fn matrix(&self) -> Option<Vec<Vec<Number>>> {
        let row = |a: &Vec<Formula>| a.iter().map(|&a| self.of(a)).collect();
        self.problem.legs.iter().map(|leg| row(&leg.divided.a)).collect()
    }

    /// A length in the claim's unit.
    fn length(&self, formula: Formula) -> [BigRational; 2] {
        let x = self.of(formula).unwrap();
        let unit = BigRational::from_integer(2.into()).pow(self.problem.scale as i32);
        ends(&x).map(|x| x * &unit)
    }
}

fn ends(x: &Number) -> [BigRational; 2] {
    [&x.lo, &x.hi].map(|x| BigRational::new(x.clone(), BigInt::one() << BITS))
}

fn exact(text: &Value) -> BigRational {
    Expression::try_from(text.as_str().unwrap().to_owned()).unwrap().rational().unwrap()
}

fn assert_near([least, greatest]: [BigRational; 2], value: &BigRational, what: &str) {
    // Half a unit in the last of 40 digits of numbers below 1000, and room for it.
    let room = BigRational::new(BigInt::one(), BigInt::from(10).pow(36));
    assert!(&least - &room <= *value && *value <= &greatest + &room, "{what}");
    // The enclosure is no wider than the oracle is exact.
    assert!(greatest - least < room, "{what}: wide");
}

fn determinant(m: &[Vec<Number>]) -> Number {
    let e = Fixed::<BigInt>::new(BITS);
    let minor = |j: usize, k: usize| {
        let (p, q) = (e.mul(&m[1][j], &m[2][k]), e.mul(&m[1][k], &m[2][j]));
        e.sub(&p.unwrap(), &q.unwrap()).unwrap()
    };
    let term = |i: usize, j, k| e.mul(&m[0][i], &minor(j, k)).unwrap();
    let sum = e.add(&term(0, 1, 2), &term(1, 2, 0)).unwrap();
    e.add(&sum, &term(2, 0, 1)).unwrap()
}

/// The certain sign of `det(M^T M - sigma^2 I)`; zero if it is not certain.
fn characteristic_sign(m: &[Vec<Number>], sigma: &BigRational) -> i32 {
    let e = Fixed::<BigInt>::new(BITS);
    let square = sigma * sigma;
    let lo = (square.clone() * BigRational::from_integer(BigInt::one() << BITS)).floor();
    let square = Interval { lo: lo.to_integer(), hi: lo.to_integer() + 1 };
    let entry = |i: usize, j: usize| {
        let terms = m.iter().map(|row| e.mul(&row[i], &row[j]).unwrap());
        let sum = terms.reduce(|a, b| e.add(&a, &b).unwrap()).unwrap();
        if i == j {
            e.sub(&sum, &square).unwrap()
        } else {
            sum
        }
    };
    let t: Vec<Vec<Number>> = (0..3).map(|i| (0..3).map(|j| entry(i, j)).collect()).collect();
    let det = determinant(&t);
    i32::from(det.lo.is_positive()) - i32::from(det.hi.is_negative())
}

#[test]
fn every_point_has_the_oracle_s_kinematics_and_singular_values() {
    let file: Value = serde_json::from_str(include_str!("../oracle/points.json")).unwrap();
    let eps = BigRational::new(BigInt::one(), BigInt::from(10).pow(30));
    let (mut reached, mut unreached) = (0, 0);
    for case in file["cases"].as_array().unwrap() {
        for (n, point) in case["points"].as_array().unwrap().iter().enumerate() {
            let name = format!("{} {n}", case["name"]);
            let at = At::new(&claim(case, point));
            let Some(m) = at.matrix() else {
                assert_eq!(point["reachable"], false, "{name}");
                unreached += 1;
                continue;
            };
            assert_eq!(point["reachable"], true, "{name}");
            for (i, leg) in at.problem.legs.iter().enumerate() {
                let Some(Joint::Length(rho)) = leg.rho else { panic!("{name}: a length") };
                assert_near(at.length(rho), &exact(&point["rho"][i]), &format!("{name}: rho {i}"));
                // eta^2, of which the sign is that of the mode.
                let unit = BigRational::from_integer(4.into()).pow(at.problem.scale as i32);
                let eta = exact(&point["eta"][i]);
                let [lo, hi] = ends(&at.of(leg.eta_squared.unwrap()).unwrap());
                let room = BigRational::new(BigInt::one(), BigInt::from(10).pow(30));
                let off = &eta * &eta / unit;
                assert!(&lo - &room <= off && off <= &hi + &room, "{name}: eta {i}");
                assert_eq!(eta.is_positive(), case["legs"][i]["mode"] == "+", "{name}: eta {i}");
            }
            assert_near(ends(&determinant(&m)), &exact(&point["det"]), &format!("{name}: det"));
            for k in 0..3 {
                let sigma = exact(&point["singular_values"][k]);
                let signs = [&sigma - &eps, &sigma + &eps].map(|x| characteristic_sign(&m, &x));
                assert_eq!(signs[0] * signs[1], -1, "{name}: xi {k}");
                // Twice as far out on one side there is no root: the test tells values apart.
                let beside = [&sigma + &eps, &sigma + &eps + &eps];
                let beside = beside.map(|x| characteristic_sign(&m, &x));
                assert_eq!(beside[0] * beside[1], 1, "{name}: xi {k} + 1e-30");
            }
            reached += 1;
        }
    }
    assert_eq!((reached, unreached), (278, 2));
}
