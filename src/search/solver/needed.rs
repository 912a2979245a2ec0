//! Which entries of a problem's tape a quality is made of: a look at one of them need not run the
//! others.

use super::sample::Quality;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Row;

/// Of each of these qualities, for each entry of the tape up to the last one whether it is needed.
pub fn needed(
    problem: &Problem,
    radicands: &[Formula],
    qualities: &[Quality],
) -> Vec<(Quality, Vec<bool>)> {
    let of = |quality: &Quality| {
        let formulas = match quality {
            Quality::Reach => radicands.to_vec(),
            Quality::Determinant => {
                problem.legs.iter().flat_map(|leg| leg.divided.a.iter().copied()).collect()
            }
            Quality::Obligation(number) => formulas(problem, &problem.obligations[*number].test),
        };
        (*quality, problem.tape.parts(&formulas))
    };
    qualities.iter().map(of).collect()
}

/// What the margin of a test is computed from.
fn formulas(problem: &Problem, test: &Test) -> Vec<Formula> {
    fn rows<'r>(rows: impl Iterator<Item = &'r Row<Formula>>) -> Vec<Formula> {
        rows.flat_map(|row| row.a.iter().chain([&row.d]).copied()).collect()
    }
    let legs = || rows(problem.legs.iter().map(|leg| &leg.row));
    let with = |mut all: Vec<Formula>, other: &[Formula]| {
        all.extend(other);
        all
    };
    match test {
        Test::SigmaMin(f) | Test::SigmaMax(f) | Test::Conditioning(f) => with(legs(), &[*f]),
        Test::Least(own, bound) | Test::Greatest(own, bound) => with(rows(own.iter()), &[*bound]),
        Test::OneToOne(_) => legs(),
        Test::AtLeast(f) => vec![*f],
        Test::Beyond(f, b) => vec![*f, *b],
        Test::Solve(solve) => with(legs(), &[solve.square]),
        Test::Accuracy(test) => {
            let joints = problem.legs.iter().flat_map(|leg: &Leg| match leg.rho {
                None => Vec::new(),
                Some(Joint::Length(rho)) => vec![rho],
                Some(Joint::Angle { cos, sin }) => vec![cos, sin],
            });
            let errors = test.joints.iter().map(|(error, _)| *error);
            let rows = test.rows.iter().flatten().copied();
            rows.chain(errors).chain(joints).chain([test.distance]).collect()
        }
        Test::Apart(test) => {
            with(test.ends.iter().flatten().flatten().copied().collect(), &[test.distance])
        }
        Test::Curvature(test) => {
            let all = test.row.iter().chain(test.twice.iter().flatten());
            with(all.copied().collect(), &[test.a, test.b])
        }
    }
}
