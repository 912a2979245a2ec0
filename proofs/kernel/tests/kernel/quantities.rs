//! Quantities against sampling: a bound one per cent beyond the worst that is found is proved, one per
//! cent short of it refuted, and what proves the one proves nothing of the other.

use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::prover::{certificate, certify, Prover};
use orthocert_kernel::certificate::{Certificate, Claim, Failure, Proof, Verdict, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
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
        let by = if self.end == End::Max { 0.01 } else { -0.01 };
        let true_claim = self.of(machine, worst * (1.0 + by));
        let proof = certify(&true_claim, 4 * most).expect("a proof");
        check(&proof).expect("accepted");
        let Proof::Tree(tree) = &proof.proof else { panic!("a tree") };
        let leaves = tree.nodes.iter().filter(|node| node.split.is_none()).count();
        println!("{}: {leaves} leaves", self.quantity);
        assert!(leaves <= most, "{}: {leaves} leaves", self.quantity);
        let false_claim = self.of(machine, worst * (1.0 - by));
        assert!(check(&about(&proof, &false_claim)).is_err(), "{}: false", self.quantity);
        let problem = Problem::new(&false_claim).expect("well formed");
        let (point, fails) = fails(&problem);
        let witness = refutation(&problem, &false_claim, &point, &fails);
        check(&witness).expect("refuted");
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
    fails: &Failure,
) -> Certificate {
    let unit = (problem.scale as f64).exp2();
    let root = problem.root::<i64>(40).expect("a box");
    let inward = |(x, range): (&f64, &orthocert_kernel::fixed::Interval<i64>)| {
        let middle = (range.lo + range.hi) as f64 / 2.0 * (-40f64).exp2();
        number((middle + (x - middle) * (1.0 - 1e-7)) * unit)
    };
    let point = point.iter().zip(&root.0).map(inward).collect();
    let machine = problem.tolerances().map(|(_, min, _)| min.clone()).collect();
    let witness = Witness { precision: 128, point, machine, fails: fails.clone() };
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
        let claim = |given| Asked { given, ..asked.clone() }.of(&machine, 0.01);
        for given in [&[("joint", &k[..2])][..], &[("joint", &[0.0])], &[("force", &k)]] {
            assert!(Problem::new(&claim(given)).is_err(), "{given:?}");
        }
    }
}
