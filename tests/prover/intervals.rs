//! Intervals of doubles: the oracle's values and exact values inside every enclosure.

use super::machines::{self, random_cell, random_lambda, reference, within_cell, REFERENCE_BITS};
use super::random::Random;
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert::exact::Exact;
use orthocert::interval::Interval;
use orthocert_checker::claim::{MachineClaim, Workspace};
use orthocert_checker::definite::is_positive_definite;
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint, Region};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{determinant, Symmetric};
use orthocert_checker::model::Model;
use serde_json::Value;

/// Whether an interval of finite doubles contains all of an exact enclosure, up to the width of
/// the latter.
fn holds(x: &Interval, exact: &Fixed) -> bool {
    let end = |x: f64| BigRational::from_float(x).expect("a finite end");
    end(x.inf()) <= exact.sup() && exact.inf() <= end(x.sup())
}

fn number(text: &Value) -> BigRational {
    let exact = Exact::parse(text.as_str().unwrap(), 1000).unwrap();
    exact.as_rational().unwrap().clone()
}

/// The oracle's points for one mechanism of [`machines`], whose legs are the oracle's.
fn oracle_points(name: &str, of: impl Fn([Exact; 3]) -> MachineClaim) -> usize {
    let text = include_str!("../../proofs/checker/tests/oracle/points.json");
    let file: Value = serde_json::from_str(text).unwrap();
    let case = file["cases"].as_array().unwrap().iter().find(|case| case["name"] == name).unwrap();
    let mut reached = 0;
    for entry in case["points"].as_array().unwrap() {
        let point = std::array::from_fn(|k| Exact::Rational(number(&entry["point"][k])));
        let claim = of(point.clone());
        let model = Model::at_point(&claim, None, &point, 192).unwrap();
        let unit = BigInt::from(1) << model.unit_exponent.unwrap();
        let model = model.map(&Interval::from_fixed);
        let states = [0, 1, 2].map(|i| model.legs[i].at(&model.origin[i]));
        let [Some(a), Some(b), Some(c)] = states else {
            assert_eq!(entry["reachable"], false, "{name}: {entry}");
            continue;
        };
        assert_eq!(entry["reachable"], true, "{name}: {entry}");
        reached += 1;
        let digits = BigRational::new(1.into(), BigInt::from(10).pow(36));
        let near = |x: &Interval, value: &BigRational| {
            let end = |x: f64| BigRational::from_float(x).unwrap();
            assert!(end(x.inf()) <= value + &digits && value - &digits <= end(x.sup()), "{entry}");
            assert!(x.sup() - x.inf() < 1e-12, "{entry}: wide");
        };
        for (i, state) in [&a, &b, &c].into_iter().enumerate() {
            near(&state.eta, &(number(&entry["eta"][i]) / &unit));
            near(state.rho.length().unwrap(), &(number(&entry["rho"][i]) / &unit));
        }
        near(&determinant(&[a.row, b.row, c.row]), &number(&entry["det"]));
    }
    reached
}

#[test]
fn oracle_values_are_inside_the_enclosures() {
    let at = |claim: MachineClaim, point: [Exact; 3]| {
        let workspace = Workspace::Box { min: point.clone(), max: point };
        MachineClaim { workspace, ..claim }
    };
    let ortho = |length: &'static str| move |p| at(machines::orthoglide(length, "0", "0"), p);
    assert_eq!(oracle_points("orthoglide unit length", ortho("1")), 118);
    assert_eq!(oracle_points("orthoglide 310.25 mm", ortho("310.25")), 40);
    let delta = |p| at(machines::linear_delta(), p);
    assert_eq!(oracle_points("linear delta 333 / 174.75 mm", delta), 60);
    assert_eq!(oracle_points("skew guides", |p| at(machines::skew_guides(), p)), 60);
}

#[test]
fn expansions_in_doubles_enclose_m_and_rho() {
    let mut random = Random::new(50);
    for (name, claim) in machines::all() {
        let model = Model::new(&claim, 192).unwrap().map(&Interval::from_fixed);
        let (mut expanded, mut missed_elsewhere) = (0, 0);
        for _ in 0..100 {
            let cell = random_cell(&mut random, 14);
            let Ok(expansion) = Expansion::new(&model, &cell, ExpansionPoint::Centre) else {
                continue;
            };
            expanded += 1;
            let lambda = random_lambda(&mut random);
            let exact = reference(&claim, &within_cell(&cell, &lambda)).unwrap();
            let misses = |lambda: [i64; 3]| {
                let part = lambda.map(|x| Interval::new(x as f64 / 256.0, x as f64 / 256.0));
                let mut misses = 0;
                for (i, state) in exact.iter().enumerate() {
                    for j in 0..3 {
                        let entry = (0..3).fold(expansion.matrix[i][j], |sum, k| {
                            sum.add(&part[k].mul(&expansion.slopes[k][i][j]))
                        });
                        misses += i32::from(!holds(&entry, &state.row[j]));
                    }
                    let (at, slopes) = expansion.rho[i].unwrap();
                    let rho = (0..3).fold(at, |sum, k| sum.add(&part[k].mul(&slopes[k])));
                    misses += i32::from(!holds(&rho, state.rho.length().unwrap()));
                }
                misses
            };
            assert_eq!(misses(lambda), 0, "{name}: {cell} {lambda:?}");
            missed_elsewhere += i32::from(misses(lambda.map(|x| -x)) > 0);
            for (leg, state) in exact.iter().enumerate() {
                let over = Region::new(&model, &cell, ExpansionPoint::Centre).over;
                let natural = model.legs[leg].at(&over[leg]).unwrap();
                let (rho, exact) = (natural.rho.length().unwrap(), state.rho.length().unwrap());
                assert!(holds(rho, exact), "{name}: {cell}: natural rho of leg {leg}");
            }
        }
        assert!(expanded >= 30 && 4 * missed_elsewhere >= 3 * expanded, "{name}: {expanded}");
    }
}

#[test]
fn operations_on_doubles_enclose_the_exact_ones() {
    let mut random = Random::new(51);
    for _ in 0..4000 {
        let mut pick = || {
            let (n, d) = (random.within(-999, 999), random.pick(&[1, 3, 7, 1 << 30, 1_000_003]));
            let low = BigRational::new(n.into(), d.into());
            let high = &low + random.rational(0, 9, 7);
            let both = Fixed::rational(&low, 0, REFERENCE_BITS);
            both.hull(&Fixed::rational(&high, 0, REFERENCE_BITS))
        };
        let (x, y) = (pick(), pick());
        let (a, b) = (Interval::from_fixed(&x), Interval::from_fixed(&y));
        // Both ends of the exact result, rounded inward by less than the doubles' rounding.
        let within = |found: Interval, exact: Fixed| {
            let end = |x: f64| BigRational::from_float(x).unwrap();
            let slack = BigRational::new(1.into(), BigInt::from(1) << 220);
            assert!(end(found.inf()) <= exact.inf() + &slack, "{x:?} {y:?}");
            assert!(exact.sup() - &slack <= end(found.sup()), "{x:?} {y:?}");
        };
        within(a.add(&b), x.add(&y));
        within(a.sub(&b), x.sub(&y));
        within(a.mul(&b), x.mul(&y));
        within(a.sqr(), x.sqr());
        within(a.neg(), x.neg());
        assert!(a.recip().is_none() || x.recip().is_some());
        assert!(a.sqrt().is_none() || x.sqrt().is_some());
        if let (Some(found), Some(exact)) = (a.recip(), x.recip()) {
            within(found, exact);
        }
        if let (Some(found), Some(exact)) = (a.sqrt(), x.sqrt()) {
            within(found, exact);
        }
    }
}

#[test]
fn definite_in_doubles_means_definite_in_integers() {
    // The search may give up a definite matrix; it must not take up an indefinite one.
    let mut random = Random::new(52);
    let (mut accepted, mut given_up) = (0, 0);
    for _ in 0..4000 {
        let mut entry = |least: i64, greatest: i64| {
            let lo = random.within(least, greatest);
            Fixed::new(lo.into(), (lo + random.within(0, 60)).into(), 8).unwrap()
        };
        let exact = Symmetric {
            diagonal: [entry(20, 300), entry(20, 300), entry(20, 300)],
            off: [entry(-150, 120), entry(-150, 120), entry(-150, 120)],
        };
        let doubles = Symmetric {
            diagonal: exact.diagonal.each_ref().map(Interval::from_fixed),
            off: exact.off.each_ref().map(Interval::from_fixed),
        };
        match (is_positive_definite(&doubles), is_positive_definite(&exact)) {
            (true, false) => panic!("{exact:?}"),
            (false, true) => given_up += 1,
            (both, _) => accepted += i32::from(both),
        }
    }
    assert!(accepted > 500 && given_up < 20, "{accepted} {given_up}");
}

#[test]
fn two_singular_values_near_a_bound_together_are_told_from_beyond_it() {
    // T = s I + 11^T / 2 has the eigenvalues s, s and s + 3/2; its determinant is of order s^2.
    let definite = |s: f64| {
        let entry = |x: f64| Interval::new(x, x);
        is_positive_definite(&Symmetric { diagonal: [entry(0.5 + s); 3], off: [entry(0.5); 3] })
    };
    for exponent in 2..=48 {
        let s = f64::from(-exponent).exp2();
        assert!(definite(s), "s = 2^-{exponent}");
        assert!(!definite(-s), "s = -2^-{exponent}");
    }
    assert!(!definite(0.0) && !definite(-0.0) && !definite(f64::NAN) && !definite(f64::INFINITY));
    // Beyond the range of doubles nothing is certain.
    let huge = Interval::new(1e200, 1e200);
    let zero = Interval::new(0.0, 0.0);
    assert!(!is_positive_definite(&Symmetric { diagonal: [huge; 3], off: [zero; 3] }));
    let tiny = Interval::new(1e-200, 1e-200);
    assert!(!is_positive_definite(&Symmetric { diagonal: [tiny; 3], off: [zero; 3] }));
}
