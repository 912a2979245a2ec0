//! Claims that no cube of some side fits: what is accepted, and what is rejected and why.

use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{
    Certificate, Direction, LegNumber, Node, Proof, Provenance, SecondPoint, Step, Tree, Verdict,
    Violated, Violation, FORMAT,
};
use orthocert_checker::claim::{
    Claim, Leg, MachineClaim, Mechanism, NoCubeClaim, Quantity, Range, Requirements, Sign,
    Workspace,
};
use orthocert_checker::number::Exact;
use orthocert_checker::rule::Rotation;
use orthocert_checker::{check, read, statement};

fn exact(text: &str) -> Exact {
    Exact::parse(text, 1000).unwrap()
}

/// The Orthoglide with `L = 1`, centres in `[low, high]^3`, `1/2 <= psi <= 2`.
fn claim(low: &str, high: &str, side: &str) -> NoCubeClaim {
    let zero = || std::array::from_fn(|_| Quantity::exactly(Exact::integer(0)));
    let leg = |i: usize| Leg::Slider {
        direction: std::array::from_fn(|k| Quantity::exactly(Exact::integer(i64::from(i == k)))),
        anchor: zero(),
        platform: zero(),
        length: Quantity::exactly(Exact::integer(1)),
        mode: Sign::Plus,
    };
    let range = Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    let machine = MachineClaim {
        mechanism: Mechanism::Translational([leg(0), leg(1), leg(2)]),
        workspace: Workspace::Box {
            min: [(); 3].map(|()| exact(low)),
            max: [(); 3].map(|()| exact(high)),
        },
        requirements: Requirements { transmission: Some(range), ..Requirements::default() },
    };
    NoCubeClaim { machine, side: exact(side) }
}

fn certificate(claim: NoCubeClaim, nodes: Vec<Node>) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::NoCube(claim),
        verdict: Verdict::Certified,
        proof: Proof::Tree(Tree { precision: 64, nodes }),
        provenance: Provenance { tool: "test".into(), version: "1".into() },
    }
}

fn violated(at: [i64; 3], violates: Violation) -> Step {
    Step::Violated(Box::new(Violated { at, violates }))
}

fn leaf(step: Step) -> Node {
    Node { by: vec![step], split: None }
}

fn sigma_max(vector: [i64; 3]) -> Violation {
    Violation::SigmaMax(Direction { vector })
}

/// Centres in `[0, 1/10]^3`: the corner `C + (s/2) (1, 1, 1)` is at least `s/2` along each axis, and
/// `sigma_max` is 2 at `1/sqrt(6) = 0.408248`.
fn small(side: &str) -> NoCubeClaim {
    claim("0", "1/10", side)
}

#[test]
fn one_corner_excludes_a_cube() {
    let corner = || vec![leaf(violated([8, 8, 8], sigma_max([1, 1, 1])))];
    // (0.4, ..) is within the bounds, (0.45, ..) is not.
    let accepted = certificate(small("9/10"), corner());
    let found = check(&accepted).unwrap();
    assert_eq!((found.size.leaves, found.size.steps["violated"]), (1, 1));
    assert!(check(&certificate(small("8/10"), corner())).is_err());
    let text = accepted.to_text().unwrap();
    assert_eq!(read(text.as_bytes()).unwrap(), accepted);
    let words = statement::statement(&accepted.claim, accepted.verdict).unwrap();
    assert!(words.contains("No axis-aligned cube of side 9/10 with its centre in the box below"));
    // The halves of a cell may have different points.
    let split = vec![
        Node { by: Vec::new(), split: Some(Axis::Y) },
        leaf(violated([8, 8, 8], sigma_max([1, 1, 1]))),
        leaf(violated([8, 8, 8], sigma_max([2, 2, 2]))),
    ];
    assert!(check(&certificate(small("9/10"), split)).is_ok());
}

#[test]
fn what_excludes_nothing_is_rejected() {
    let good = || violated([8, 8, 8], sigma_max([1, 1, 1]));
    let reject = |claim: NoCubeClaim, nodes: Vec<Node>| {
        check(&certificate(claim, nodes)).expect_err("rejected").to_string()
    };
    let one = |step: Step| reject(small("9/10"), vec![leaf(step)]);
    let singular = Violation::Singular(SecondPoint { other: [(); 3].map(|()| exact("0")) });
    for (row, found, expected) in [
        ("the opposite corner", one(violated([-8; 3], sigma_max([1; 3]))), "not provably violated"),
        ("a point within", one(violated([7; 3], sigma_max([1; 3]))), "not provably violated"),
        (
            "another direction",
            one(violated([8; 3], sigma_max([1, -1, 0]))),
            "not provably violated",
        ),
        ("no direction", one(violated([8; 3], sigma_max([0; 3]))), "the vector is zero"),
        ("beyond the cube", one(violated([9, 8, 8], sigma_max([1; 3]))), "not a point of the cube"),
        ("far beyond", one(violated([i64::MIN; 3], sigma_max([1; 3]))), "not a point of the cube"),
        ("no such leg", one(violated([8; 3], Violation::Row(LegNumber { leg: 0 }))), "no leg 0"),
        ("within reach", one(violated([8; 3], Violation::Reach(LegNumber { leg: 1 }))), "violated"),
        ("no such bound", one(violated([8; 3], Violation::ParallelMargin)), "no such requirement"),
        ("two points", one(violated([8; 3], singular)), "another kind of tree"),
        ("a machine's rule", one(Step::Lower(Rotation::IDENTITY)), "another kind of tree"),
        ("a rule without evidence", one(Step::Outside), "another kind of tree"),
        ("an open leaf", reject(small("9/10"), vec![Node::default()]), "is not discharged"),
        ("no nodes", reject(small("9/10"), Vec::new()), "ends where a node is needed"),
        (
            "a second step",
            reject(small("9/10"), vec![Node { by: vec![good(), good()], split: None }]),
            "already discharged",
        ),
        ("no side", reject(small("0"), vec![leaf(good())]), "not well formed"),
        ("a negative side", reject(small("-1"), vec![leaf(good())]), "not well formed"),
        ("centres reversed", reject(claim("1", "0", "1"), vec![leaf(good())]), "not well formed"),
    ] {
        assert!(found.contains(expected), "{row}: {found}");
    }
    let mut cylinder = small("9/10");
    cylinder.machine.workspace = Workspace::Cylinder {
        center: [exact("0"), exact("0")],
        radius: exact("1"),
        z: [exact("0"), exact("1")],
    };
    assert!(reject(cylinder, vec![leaf(good())]).contains("are not given as a box"));
    let mut refuted = certificate(small("9/10"), vec![leaf(good())]);
    refuted.verdict = Verdict::Refuted;
    assert!(check(&refuted).unwrap_err().to_string().contains("the verdict does not go"));
}

#[test]
fn the_step_is_of_no_other_claim() {
    let machine = small("9/10").machine;
    let nodes = vec![leaf(violated([8; 3], sigma_max([1; 3])))];
    let certificate =
        Certificate { claim: Claim::Machine(machine), ..certificate(small("9/10"), nodes) };
    assert!(check(&certificate).unwrap_err().to_string().contains("another kind of tree"));
}
