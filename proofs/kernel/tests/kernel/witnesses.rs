//! Refutations: accepted where the claim is false, rejected elsewhere.

use crate::certificates::claim;
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::witness::{check, WitnessError};

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

fn orthoglide(length: &str, require: &str) -> String {
    let leg = |n: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{length},"mode":"+"}}"#
        )
    };
    let legs = [leg(r#""1","0","0""#), leg(r#""0","1","0""#), leg(r#""0","0","1""#)].join(",");
    format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-72","-72","-72"],"max":["125","125","125"]}}}},"require":[{require}]}}"#
    )
}

fn try_witness(
    text: &str,
    point: [&str; 3],
    machine: &[&str],
    fails: Failure,
) -> Result<(), WitnessError> {
    let claim = claim(text);
    let problem = Problem::new(&claim).expect("well formed");
    let witness = Witness {
        precision: 128,
        point: point.map(number).to_vec(),
        machine: machine.iter().map(|x| number(x)).collect(),
        fails,
    };
    check(&problem, &claim.workspace, &witness)
}

#[test]
fn false_claims_are_refuted_and_true_ones_are_not() {
    let corner = ["125", "125", "125"];
    let diagonal = || vec![vec![1, 1, 1]];
    let psi = |end: &str, bound: &str| {
        format!(r#"{{"quantity":"transmission","end":"{end}","bound":"{bound}"}}"#)
    };
    // At (c, c, c), M = (1 - m) I + m 11^T with m = c/sqrt(L^2 - 2 c^2) = 0.48876 for L = 310.7.
    let greatest = |bound: &str| orthoglide("\"310.7\"", &psi("min", bound));
    let fails = || Failure::Obligation(1, diagonal());
    assert_eq!(try_witness(&greatest("0.51"), corner, &[], fails()), Ok(()));
    let not = Err(WitnessError::NotViolated);
    assert_eq!(try_witness(&greatest("0.5"), corner, &[], fails()), not);
    let least = |bound: &str| orthoglide("\"310.7\"", &psi("max", bound));
    let across = || Failure::Obligation(0, vec![vec![1, -1, 0]]);
    assert_eq!(try_witness(&least("1.9"), corner, &[], across()), Ok(()));
    assert_eq!(try_witness(&least("2"), corner, &[], across()), not);
    // The wrong direction, none, zero, of another length; no such obligation.
    assert_eq!(try_witness(&least("1.9"), corner, &[], Failure::Obligation(0, diagonal())), not);
    let none = Err(WitnessError::NoSuchObligation);
    assert_eq!(try_witness(&least("1.9"), corner, &[], Failure::Obligation(0, vec![])), none);
    for v in [vec![0, 0, 0], vec![1, -1]] {
        let fails = Failure::Obligation(0, vec![v]);
        assert_eq!(try_witness(&least("1.9"), corner, &[], fails), not);
    }
    assert_eq!(try_witness(&least("1.9"), corner, &[], Failure::Obligation(7, diagonal())), none);
    // Outside the workspace.
    let beyond = ["125.001", "125", "125"];
    assert_eq!(try_witness(&least("1.9"), beyond, &[], across()), Err(WitnessError::Outside));
    assert_eq!(try_witness(&least("1.9"), corner, &[], Failure::Reach), not);
}

#[test]
fn the_machine_is_one_of_the_claims() {
    let text = orthoglide(
        r#"{"min":"310","max":"311"}"#,
        r#"{"quantity":"transmission","end":"max","bound":"1.96"}"#,
    );
    let corner = ["125", "125", "125"];
    let across = || Failure::Obligation(0, vec![vec![1, -1, 0]]);
    assert_eq!(try_witness(&text, corner, &["310", "310", "310"], across()), Ok(()));
    let outside = Err(WitnessError::OutsideTolerance);
    for machine in [&["309.9", "310", "310"][..], &["310", "310"], &["310"; 4], &[]] {
        assert_eq!(try_witness(&text, corner, machine, across()), outside, "{machine:?}");
    }
}

#[test]
fn reach_and_singularities() {
    let short = orthoglide("\"170\"", "");
    let corner = ["125", "125", "125"];
    assert_eq!(try_witness(&short, corner, &[], Failure::Reach), Ok(()));
    // Two points on either side of a singular one: linear joints along x, y and x + (z - 1) z.
    let text = r#"{"mechanism":{"formulas":{"coordinates":["x","y","z"],"parameters":[],"definitions":[],"joints":[{"rho":"x"},{"rho":"y"},{"rho":"z*(z-1)"}]}},"workspace":{"box":{"min":["0","0","0"],"max":["1","1","1"]}},"require":[]}"#;
    let other = |z: &str| Failure::Singular(vec![number("0"), number("0"), number(z)]);
    assert_eq!(try_witness(text, ["0", "0", "0"], &[], other("1")), Ok(()));
    let not = Err(WitnessError::NotViolated);
    assert_eq!(try_witness(text, ["0", "0", "0"], &[], other("0.1")), not);
    assert_eq!(try_witness(text, ["0", "0", "0"], &[], other("1.1")), Err(WitnessError::Outside));
}
