//! Expected digits: computed with mpmath in 60 digits, from the formulas of the paper; those for
//! `psi_max = 2` and a cube of 200 also stand in the literature.

use super::*;
use crate::exact::decimal::{rounded, Toward};
use num_rational::BigRational;
use num_traits::Signed;

fn exact(text: &str) -> Exact {
    Exact::parse(text, 1000).unwrap()
}

/// The values, in the order of [`dimensions`], to 25 digits.
const EXPECTED: &[(&str, &str, &str, [&str; 11])] = &[
    (
        "2",
        "200",
        "0",
        [
            "310.5828541230249148186786",
            "-73.20508075688772935274463",
            "126.7949192431122706472554",
            "-383.7879348799126441714232",
            "256.9930156368003735241679",
            "-14.03624346792647858289232",
            "26.56505117707798935157219",
            "-14.96321743330712186999694",
            "26.56505117707798935157219",
            "-13.63302222536640990233994",
            "24.09484255211070096707104",
        ],
    ),
    (
        "1.5",
        "1",
        "0",
        [
            "2.513044702854562972944453",
            "-0.4076696830622020656710946",
            "0.5923303169377979343289054",
            "-2.920714385916765038615547",
            "1.143723435103371235628831",
            "-9.462322208025617391140071",
            "14.03624346792647858289232",
            "-9.609048852195655995443063",
            "14.03624346792647858289232",
            "-9.335859032003938161805130",
            "13.63302222536640990233994",
        ],
    ),
    (
        "3",
        "200",
        "12.5",
        [
            "254.2644616855313678601271",
            "-76.66361972114582457143948",
            "123.3363802788541754285605",
            "-343.4280814066771924315666",
            "269.2598912672501047172863",
            "-18.43494882292201064842781",
            "33.69006752597978691352549",
            "-20.16906340042452039926643",
            "33.69006752597978691352549",
            "-17.54840061379229806435204",
            "29.01714062460152000210355",
        ],
    ),
    (
        "1.000001",
        "200",
        "0",
        [
            "200000100.0000000000000000",
            "-99.99995000002500001249997",
            "100.0000499999749999875000",
            "-200000199.9999500000250001",
            "200.0000500000249999812500",
            "-0.00002864786110867766444136290",
            "0.00002864788975653877311425270",
            "-0.00002864786110867766444852485",
            "0.00002864788975653877311425270",
            "-0.00002864786110867408346588627",
            "0.00002864788975653519212803313",
        ],
    ),
    (
        "1000",
        "0.001",
        "-3",
        [
            "0.001015090729262326941798625",
            "-0.0004141326440167671520242886",
            "0.0005858673559832328479757114",
            "2.998570776626720905906177",
            "0.001428636919469301067949064",
            "-26.54212828191652304617198",
            "44.97133778152393370981318",
            "-29.97242681857122998818942",
            "44.97133778152393370981318",
            "-24.07775284757493317707427",
            "35.25087255009321231110699",
        ],
    ),
];

#[test]
fn every_enclosure_holds_the_expected_digits() {
    for (psi_max, cube, offset, expected) in EXPECTED {
        let found = dimensions(&exact(psi_max), &exact(cube), &exact(offset), 15).unwrap();
        assert_eq!(found.len(), expected.len());
        for (dimension, expected) in found.iter().zip(expected) {
            let expected = exact(expected).as_rational().unwrap().clone();
            // The expected digits themselves are rounded.
            let uncertain = BigRational::new(1.into(), 10.into()).pow(23) * expected.abs();
            let (a, b) = (&expected - &uncertain, &expected + &uncertain);
            let (inf, sup) = (dimension.inf(), dimension.sup());
            assert!(inf <= b && a <= sup, "{} for {psi_max}", dimension.symbol);
            let [lower, upper] =
                [rounded(&inf, 15, Toward::Below), rounded(&sup, 15, Toward::Above)]
                    .map(|text| exact(&text).as_rational().unwrap().clone());
            assert!(lower <= b && a <= upper, "{} for {psi_max}", dimension.symbol);
        }
    }
}

#[test]
fn fifteen_digits_are_certified() {
    for psi_max in ["1.000001", "1.01", "sqrt(2)", "2", "3", "1000", "1e300", "1 + 1e-300"] {
        for cube in ["1e-9", "200", "100*sqrt(3)", "1e12"] {
            let all = dimensions(&exact(psi_max), &exact(cube), &exact("0"), 15).unwrap();
            for dimension in all {
                let (symbol, inf, sup) = (dimension.symbol, dimension.inf(), dimension.sup());
                let unit = BigRational::from_integer(10.into());
                let width = (&sup - &inf) * unit.pow(16);
                assert!(width <= inf.abs(), "{symbol} for {psi_max}, {cube}");
            }
        }
    }
}

#[test]
fn the_two_forms_of_the_greatest_theta_agree() {
    // theta_max = atan(q2 / s(Q2)), from lengths alone.
    let all = dimensions(&exact("3/2"), &exact("200"), &exact("0"), 15).unwrap();
    let of = |symbol: &str| &all.iter().find(|d| d.symbol == symbol).unwrap().value;
    let (length, q2, bits) = (of("L"), of("q2"), all[0].bits);
    let f = Fixed::<BigInt>::new(bits);
    let degrees = || {
        let twice = f.mul(&f.integer(2)?, &f.sqr(q2)?)?;
        let s = f.sqrt(&f.sub(&f.sqr(length)?, &twice)?)?;
        let angle = atan(&f.div(q2, &s)?, bits)?;
        f.div(&f.mul(&angle, &f.integer(180)?)?, &pi(bits)?)
    };
    let (degrees, theta_max) = (degrees().unwrap(), of("theta_max"));
    assert!(degrees.lo <= theta_max.hi && theta_max.lo <= degrees.hi);
}

#[test]
fn an_offset_may_bring_the_base_point_to_zero() {
    // psi_max = 2: q1 - L = -L (1 + sin(beta_Q1)), of which only an enclosure is known.
    let offset = exact("(-1/sqrt(18)-1)*200/(1/sqrt(18)+1/sqrt(6))");
    let all = dimensions(&exact("2"), &exact("200"), &offset, 15).unwrap();
    let base = all.iter().find(|d| d.symbol == BASE).unwrap();
    let most = BigRational::new(1.into(), 10.into()).pow(1000);
    assert!(crosses_zero(&base.value) && base.sup() - base.inf() < most);
}

#[test]
fn what_is_no_machine_is_refused() {
    let of = |psi_max, cube| dimensions(&exact(psi_max), &exact(cube), &exact("0"), 15).map(|_| ());
    for psi_max in ["1", "1/2", "0", "-2", "sqrt(2)/sqrt(2)"] {
        assert_eq!(of(psi_max, "200"), Err(DimensionError::PsiMaxNotAboveOne), "{psi_max}");
    }
    for cube in ["0", "-200", "sqrt(2) - sqrt(2)"] {
        assert_eq!(of("2", cube), Err(DimensionError::CubeNotPositive), "{cube}");
    }
}
