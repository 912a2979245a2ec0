//! True claims are not refuted.

use orthocert_checker::certificate::{
    Certificate, LegNumber, Node, Proof, Provenance, Step, Tree, Verdict, Violation, Witness,
    FORMAT,
};
use orthocert_checker::check;
use orthocert_checker::claim::{
    Claim, Leg, MachineClaim, Mechanism, Quantity, Requirements, Sign, Workspace,
};
use orthocert_checker::number::Exact;
use orthocert_checker::rule::Rotation;

fn vector(x: [i64; 3]) -> [Quantity; 3] {
    x.map(|x| Quantity::exactly(Exact::integer(x)))
}

/// Legs of length 1 on arms of `10^-30`, stretched out along the axes, at the single point `O`.
/// `D = 1 - r^2/4 > 0` for each, and `M` is nearly `I/r`.
pub fn tiny_arms() -> MachineClaim {
    let r = Exact::parse("1e-30", 100).unwrap();
    let leg = |axis, anchor| Leg::Arm {
        axis: vector(axis),
        reference: vector([1, 1, 1]),
        anchor: vector(anchor),
        platform: vector([0, 0, 0]),
        arm: Quantity::exactly(r.clone()),
        length: Quantity::exactly(Exact::integer(1)),
        mode: Sign::Plus,
    };
    let legs = [leg([0, 0, 1], [-1, 0, 0]), leg([1, 0, 0], [0, -1, 0]), leg([0, 1, 0], [0, 0, -1])];
    let origin = || [Exact::integer(0), Exact::integer(0), Exact::integer(0)];
    MachineClaim {
        mechanism: Mechanism::Translational(legs),
        workspace: Workspace::Box { min: origin(), max: origin() },
        requirements: Requirements::default(),
    }
}

fn certificate(claim: MachineClaim, verdict: Verdict, proof: Proof) -> Certificate {
    Certificate {
        format: FORMAT.into(),
        claim: Claim::Machine(claim),
        verdict,
        proof,
        provenance: Provenance { tool: "test".into(), version: "0".into() },
    }
}

#[test]
fn a_leg_whose_arm_the_precision_does_not_resolve_is_not_out_of_reach() {
    let by = vec![Step::Lower(Rotation::IDENTITY)];
    let tree = Tree { precision: 512, nodes: vec![Node { by, split: None }] };
    let certified = certificate(tiny_arms(), Verdict::Certified, Proof::Tree(tree));
    assert!(check(&certified).is_ok(), "the claim is true: {:?}", check(&certified));
    for precision in [32, 64, 96, 128, 512] {
        for leg in 1..=3 {
            let point = [Exact::integer(0), Exact::integer(0), Exact::integer(0)];
            let violates = Violation::Reach(LegNumber { leg });
            let witness = Box::new(Witness { precision, point, machine: None, violates });
            let refuted = certificate(tiny_arms(), Verdict::Refuted, Proof::Witness(witness));
            assert!(check(&refuted).is_err(), "refuted at {precision} bits");
        }
    }
}
