//! The walk over a tree: every obligation on every path, and nothing else.

use super::machines::{cube, exact, orthoglide};
use orthocert_checker::cell::{Axis, MAX_LEVEL};
use orthocert_checker::certificate::{
    Certificate, Node, Proof, Provenance, Step, Tree, Verdict, FORMAT, MAX_STEPS,
};
use orthocert_checker::check;
use orthocert_checker::claim::{Claim, MachineClaim, Range};
use orthocert_checker::rule::{Failure, Obligation, Rotation, TightCorner};
use orthocert_checker::{Rejected, TreeSize};

const LOWER: Step = Step::Lower(Rotation::IDENTITY);

fn node(by: &[Step], split: Option<Axis>) -> Node {
    Node { by: by.to_vec(), split }
}

fn leaf(by: &[Step]) -> Node {
    node(by, None)
}

fn certificate(claim: &MachineClaim, precision: u32, nodes: Vec<Node>) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(claim.clone()),
        verdict: Verdict::Certified,
        proof: Proof::Tree(Tree { precision, nodes }),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}

fn checked(claim: &MachineClaim, nodes: Vec<Node>) -> Result<TreeSize, Rejected> {
    check(&certificate(claim, 64, nodes)).map(|accepted| accepted.size)
}

/// A box on which the root alone can be closed: `[1/2, 2]` on `[-1/10, 1/10]^3` for `L = 1`.
fn easy() -> MachineClaim {
    let mut claim = orthoglide("1", "-1/10", "1/10");
    let range = Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    claim.requirements.transmission = Some(range);
    claim
}

#[test]
fn complete_trees_are_accepted_with_their_size() {
    let x = Some(Axis::X);
    for (name, nodes, leaves, depth) in [
        ("root alone", vec![leaf(&[LOWER, Step::Upper])], 1, 0),
        (
            "both halves",
            vec![node(&[], x), leaf(&[LOWER, Step::Upper]), leaf(&[Step::Upper, LOWER])],
            2,
            1,
        ),
        (
            "inherited from the root",
            vec![node(&[LOWER, Step::Upper], x), leaf(&[]), leaf(&[])],
            2,
            1,
        ),
        (
            "one inherited, one not",
            vec![node(&[LOWER], x), leaf(&[Step::Upper]), leaf(&[Step::Upper])],
            2,
            1,
        ),
        (
            "preorder, lower half split again",
            vec![
                node(&[Step::Upper], x),
                node(&[], Some(Axis::Z)),
                leaf(&[LOWER]),
                leaf(&[LOWER]),
                leaf(&[LOWER]),
            ],
            3,
            2,
        ),
    ] {
        let count = nodes.len();
        let size = checked(&easy(), nodes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((size.nodes, size.leaves, size.depth), (count, leaves, depth), "{name}");
    }
}

#[test]
fn incomplete_and_overfull_trees_are_rejected() {
    let x = Some(Axis::X);
    let both = [LOWER, Step::Upper];
    let open = |node, obligation| Rejected::Open { node, obligation };
    let (min, max) = (Obligation::SigmaMin, Obligation::SigmaMax);
    for (name, nodes, expected) in [
        ("no node", vec![], Rejected::MissingNode),
        ("missing upper half", vec![node(&both, x), leaf(&[])], Rejected::MissingNode),
        ("missing both halves", vec![node(&both, x)], Rejected::MissingNode),
        ("node after the root", vec![leaf(&both), leaf(&both)], Rejected::TrailingNodes(1)),
        (
            "third half",
            vec![node(&[], x), leaf(&both), leaf(&both), leaf(&both)],
            Rejected::TrailingNodes(1),
        ),
        ("nothing shown", vec![leaf(&[])], open(0, min)),
        ("upper bound only", vec![leaf(&[Step::Upper])], open(0, min)),
        ("lower bound only", vec![leaf(&[LOWER])], open(0, max)),
        ("lower half open", vec![node(&[], x), leaf(&[LOWER]), leaf(&both)], open(1, max)),
        ("upper half open", vec![node(&[], x), leaf(&both), leaf(&[Step::Upper])], open(2, min)),
        (
            "shown on the sibling",
            vec![node(&[LOWER], x), leaf(&[Step::Upper]), leaf(&[])],
            open(2, max),
        ),
        (
            "shown below the sibling's sibling",
            vec![node(&[], x), node(&[Step::Upper], x), leaf(&[LOWER]), leaf(&[]), leaf(&both)],
            open(3, min),
        ),
        ("too many steps", vec![leaf(&vec![LOWER; MAX_STEPS + 1])], Rejected::TooManySteps(0)),
    ] {
        assert_eq!(checked(&easy(), nodes), Err(expected), "{name}");
    }
}

#[test]
fn steps_that_do_not_apply_are_rejected_where_they_stand() {
    let claim = easy();
    let prototype = cube("2", "200");
    let nearly_isotropic = cube("1.01", "200");
    let x = Some(Axis::X);
    let corner = Step::Corner;
    let (q1, q2) = (corner(TightCorner::Q1), corner(TightCorner::Q2));
    for (name, claim, nodes, at, rule, failure) in [
        ("cube rule on a box", &claim, vec![leaf(&[Step::Cube])], 0, "cube", Failure::NotTheCube),
        (
            "corner rule on a box",
            &claim,
            vec![leaf(&[Step::Corner(TightCorner::Q1)])],
            0,
            "corner",
            Failure::NotTheCube,
        ),
        (
            "range without a requirement",
            &claim,
            vec![leaf(&[LOWER, Step::Range])],
            0,
            "range",
            Failure::NoSuchBound,
        ),
        (
            "the same step twice",
            &claim,
            vec![leaf(&[LOWER, LOWER, Step::Upper])],
            0,
            "lower",
            Failure::Repeated,
        ),
        (
            "shown again below",
            &claim,
            vec![node(&[Step::Upper], x), leaf(&[LOWER]), leaf(&[LOWER, Step::Upper])],
            2,
            "upper",
            Failure::Repeated,
        ),
        (
            "Q1 on the half away from it",
            &nearly_isotropic,
            vec![
                node(&[Step::Cube], x),
                leaf(std::slice::from_ref(&q1)),
                leaf(std::slice::from_ref(&q1)),
            ],
            2,
            "corner",
            Failure::NotAtCorner,
        ),
        (
            "Q2 on the half away from it",
            &prototype,
            vec![node(&[Step::Cube], x), leaf(&[q2]), leaf(&[])],
            1,
            "corner",
            Failure::NotAtCorner,
        ),
    ] {
        let expected = Rejected::Step { node: at, rule, failure };
        assert_eq!(checked(claim, nodes), Err(expected), "{name}");
    }
}

#[test]
fn limits_are_limits() {
    let nodes = || vec![leaf(&[LOWER, Step::Upper])];
    for (precision, holds) in [(31, false), (32, true), (1024, true), (1025, false), (0, false)] {
        let result = check(&certificate(&easy(), precision, nodes()));
        assert_eq!(result.is_ok(), holds, "{precision}");
        assert!(holds || result == Err(Rejected::Precision(precision)));
    }
    // Splitting on after everything is shown is allowed, down to the deepest level.
    let chain = |splits: u32| {
        let mut all = vec![node(&[LOWER, Step::Upper], Some(Axis::Y))];
        for _ in 1..splits {
            all.extend([leaf(&[]), node(&[], Some(Axis::Y))]);
        }
        all.extend([leaf(&[]), leaf(&[])]);
        all
    };
    assert_eq!(checked(&easy(), chain(MAX_LEVEL)).unwrap().depth, MAX_LEVEL as usize);
    let deepest = 2 * MAX_LEVEL as usize;
    assert_eq!(checked(&easy(), chain(MAX_LEVEL + 1)), Err(Rejected::TooDeep(deepest)));
    let mut refuted = certificate(&easy(), 64, nodes());
    refuted.verdict = Verdict::Refuted;
    assert_eq!(check(&refuted), Err(Rejected::VerdictMismatch));
}
