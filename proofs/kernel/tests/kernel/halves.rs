//! Trees that halve tolerances: what is shown of each half, and what is rejected.

use crate::certificates::claim;
use crate::prover::{certificate, certify};
use orthocert_kernel::certificate::{
    Certificate, Claim, Evidence, Failure, Node, Proof, Step, Tree, Verdict,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{MachineClaim, NoCubeClaim, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::rejected::Rejected;
use orthocert_kernel::test::Multiplier;

/// A machine with these joints in `x` and `y` from 0 to 1, and parameters.
fn machine(parameters: &str, joints: [&str; 2], require: &str) -> MachineClaim {
    let [first, second] = joints;
    claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y"],"parameters":[{parameters}],"definitions":[],"joints":[{first},{second}]}}}},"workspace":{{"box":{{"min":["0","0"],"max":["1","1"]}}}},"require":[{require}]}}"#
    ))
}

/// The plane turned by twice the angle whose tangent is `a`, and stretched by `1 + a^2`: one `Y` does for
/// turns within a right angle of it.
fn turned() -> MachineClaim {
    machine(
        r#"["l","2"],["a",{"min":"-2","max":"2"}],["b",{"min":"1","max":"1.5"}]"#,
        [r#"{"row":["l/2-a^2","2*a"]}"#, r#"{"row":["-2*a","l/2-a^2+b*0"]}"#],
        r#"{"quantity":"transmission","end":"max","bound":"2"}"#,
    )
}

fn halved(k: usize) -> Node {
    Node { split: Some(k), ..Node::default() }
}

fn leaf(steps: impl IntoIterator<Item = Evidence>) -> Node {
    let by = steps.into_iter().enumerate().map(|(at, by)| Step(at, by)).collect();
    Node { by, ..Node::default() }
}

fn of(claim: &MachineClaim, nodes: Vec<Node>) -> Certificate {
    let tree = Tree { precision: 40, chords: None, nodes };
    certificate(claim, Verdict::Certified, Proof::Tree(tree))
}

/// The same `Y` for the turn in the middle of a range of `a`, `1/(1 + a^2)` times what it is there.
fn about(low: f64, high: f64) -> Evidence {
    let a = (low + high) / 2.0;
    let scale = f64::from(1 << 20) / (1.0 + a * a);
    let [c, s] =
        [(1.0 - a * a) * scale, 2.0 * a * scale].map(|x| (x / (1.0 + a * a)).round() as i64);
    Evidence::Lower(Multiplier { y: vec![vec![c, s], vec![-s, c]], places: 20 })
}

/// The range of `a` halved so often everywhere, each leaf with its own `Y`.
fn uniform(nodes: &mut Vec<Node>, [low, high]: [f64; 2], levels: usize) {
    if levels == 0 {
        return nodes.push(leaf([about(low, high)]));
    }
    nodes.push(halved(2));
    let middle = (low + high) / 2.0;
    uniform(nodes, [low, middle], levels - 1);
    uniform(nodes, [middle, high], levels - 1);
}

#[test]
fn each_half_has_evidence_of_its_own() {
    let own = turned();
    assert!(certify(&own, 500).is_none(), "no one matrix does for all turns");
    let mut nodes = Vec::new();
    uniform(&mut nodes, [-2.0, 2.0], 5);
    let good = of(&own, nodes.clone());
    check(&good).expect("accepted");
    assert_eq!(Certificate::read(&good.to_text().expect("a text")).as_ref(), Ok(&good));
    let with = |change: &dyn Fn(&mut Vec<Node>)| {
        let mut own = nodes.clone();
        change(&mut own);
        check(&of(&turned(), own))
    };
    let last = nodes.len() - 1;
    let mut lower = Vec::new();
    uniform(&mut lower, [-2.0, 0.0], 4);
    let only = [vec![halved(2)], lower.clone()].concat();
    for (defect, found) in [
        ("one half only", check(&of(&own, only))),
        ("the lower half twice", with(&|all| all.splice(32.., lower.clone()).for_each(drop))),
        ("the halves exchanged", {
            let upper = nodes[32..].to_vec();
            check(&of(&own, [vec![halved(2)], upper, lower.clone()].concat()))
        }),
        ("nothing shown of one leaf", with(&|all| all[last].by.clear())),
        ("a leaf too many", with(&|all| all.push(leaf([about(1.5, 2.0)])))),
        ("the evidence of another half", with(&|all| all[last].by = all[5].by.clone())),
        ("halved along a coordinate", with(&|all| all[1].split = Some(0))),
        ("another number halved", with(&|all| all[1].split = Some(3))),
        ("no such number: l has no two ends", with(&|all| all[0].split = Some(4))),
        ("no such number at all", with(&|all| all[0].split = Some(usize::MAX))),
        ("a half with a failure", with(&|all| all[0].fails = Some(Failure::Reach))),
    ] {
        assert!(found.is_err(), "{defect}");
    }
    // The other number may be halved as well, whatever for.
    let twice = [vec![halved(3)], nodes.clone(), nodes.clone()].concat();
    check(&of(&own, twice)).expect("accepted");
    assert_eq!(
        check(&of(&own, [vec![halved(4)], nodes.clone(), nodes].concat())),
        Err(Rejected::Shape(0))
    );
}

/// A joint coordinate that some machines of `a` in `[1, 3]` have at most so great.
fn coordinate(max: &str) -> MachineClaim {
    machine(
        r#"["a",{"min":"1","max":"3"}]"#,
        [r#"{"rho":"x-a+a^2/8"}"#, r#"{"rho":"y"}"#],
        &format!(r#"{{"quantity":"joint_range","leg":1,"end":"max","bound":"{max}"}}"#),
    )
}

#[test]
fn what_is_true_of_one_half_alone_is_not_shown() {
    let y = Evidence::Lower(Multiplier { y: vec![vec![1, 0], vec![0, 1]], places: 0 });
    let top = Node { split: Some(2), ..leaf([y]) };
    let shown = Node { by: vec![Step(1, Evidence::Test)], ..Node::default() };
    let once = |max: &str, halves: &[&Node]| {
        let all = [&top].into_iter().chain(halves.iter().copied());
        check(&of(&coordinate(max), all.cloned().collect()))
    };
    // Over [1, 3] it is found to be at most 9/8, over [1, 2] 1/2, over [2, 3] 1/8; it is 1/8 at most.
    let both = [&shown, &shown];
    once("0.51", &both).expect("accepted");
    assert_eq!(once("0.49", &both), Err(Rejected::Step(1, 1)));
    // Of [2, 3] it is true that it is at most 1/8 - 1/2; of all it is false.
    for max in ["0.12", "0", "-0.2"] {
        assert_eq!(once(max, &both), Err(Rejected::Step(1, 1)), "{max}");
        assert_eq!(once(max, &[&Node::default(), &shown]), Err(Rejected::Open(1, 1)), "{max}");
        assert_eq!(once(max, &[&shown]), Err(Rejected::Step(1, 1)), "{max}");
    }
    assert_eq!(once("0.51", &[&shown]), Err(Rejected::Shape(2)));
    // What is shown of one half is not shown of the other, or of the half of another node.
    assert_eq!(once("0.51", &[&shown, &Node::default()]), Err(Rejected::Open(2, 1)));
    let deep = Node { split: Some(2), ..Node::default() };
    once("0.3", &[&deep, &shown, &shown, &shown]).expect("accepted");
    assert_eq!(once("0.3", &[&shown, &deep, &shown, &shown]), Err(Rejected::Step(1, 1)));
    // After a half, what is no part of it is of all machines again.
    let across = Node { split: Some(0), ..top.clone() };
    let beside = |upper: &[&Node]| {
        let all = [&across, &deep, &shown, &shown].into_iter().chain(upper.iter().copied());
        check(&of(&coordinate("0.51"), all.cloned().collect()))
    };
    beside(&[&deep, &shown, &shown]).expect("accepted");
    assert_eq!(beside(&[&shown]), Err(Rejected::Step(4, 1)));
}

#[test]
fn a_range_of_one_unit_has_no_halves() {
    let y = Evidence::Lower(Multiplier { y: vec![vec![1, 0], vec![0, 1]], places: 0 });
    let narrow = machine(
        r#"["a",{"min":"1","max":"1.0000000000001"}]"#,
        [r#"{"rho":"x*a"}"#, r#"{"rho":"y"}"#],
        "",
    );
    let all = vec![halved(2), leaf([y.clone()]), leaf([y.clone()])];
    assert_eq!(check(&of(&narrow, all)), Err(Rejected::Shape(0)));
    check(&of(&narrow, vec![leaf([y.clone()])])).expect("accepted");
    // From 1 to 3 are 2^41 units: in 41 halvings one is reached, and no further one is accepted.
    let path = |levels: usize| {
        let mut all = vec![halved(2); levels];
        all.extend(vec![leaf([y.clone()]); levels + 1]);
        check(&of(&coordinate("2"), all))
    };
    assert_eq!(path(42), Err(Rejected::Shape(41)));
    assert_eq!(path(41), Err(Rejected::Open(41, 1)));
}

#[test]
fn halvings_are_counted_as_work() {
    // As many halvings as a tree may have, each with less to evaluate than a node with steps.
    let names: Vec<String> =
        (0..60).map(|i| format!(r#"["a{i}",{{"min":"1","max":"3"}}]"#)).collect();
    let sum: Vec<String> = (0..60).map(|i| format!("a{i}")).collect();
    let joints = [format!(r#"{{"rho":"x*({})"}}"#, sum.join("+")), r#"{"rho":"y"}"#.to_owned()];
    let own = machine(&names.join(","), [&joints[0], &joints[1]], "");
    let deep = |levels: usize| {
        let mut all: Vec<Node> = (0..levels).map(|at| halved(2 + at % 60)).collect();
        all.extend(vec![Node::default(); levels + 1]);
        check(&of(&own, all))
    };
    assert_eq!(deep(1000), Err(Rejected::Open(1000, 0)));
    assert_eq!(deep(200_000), Err(Rejected::Work));
}

#[test]
fn an_accuracy_is_of_the_whole_tolerance() {
    let own = |max: &str| {
        machine(
            r#"["a",{"min":"0","max":"1"}]"#,
            [r#"{"rho":"x+(a-1)^2/4"}"#, r#"{"rho":"y"}"#],
            &format!(
                r#"{{"quantity":"accuracy","given":{{"joint_error":["0"]}},"end":"max","bound":"{max}"}}"#
            ),
        )
    };
    // At a = 0 it is off by 3/16, at a = 1 by 1/16; its derivative says at most 1/4.
    let good = certify(&own("0.3"), 50).expect("a proof");
    let Proof::Tree(tree) = &good.proof else { panic!("a tree") };
    let [Node { by, .. }] = &tree.nodes[..] else { panic!("one node") };
    let of_nodes = |nodes: Vec<Node>| {
        let tree = Tree { nodes, ..tree.clone() };
        check(&certificate(&own("0.3"), Verdict::Certified, Proof::Tree(tree)))
    };
    let node = |by: &Vec<Step>| Node { by: by.clone(), ..Node::default() };
    let parts = |top: &Vec<Step>, halves: &Vec<Step>| {
        vec![Node { split: Some(2), ..node(top) }, node(halves), node(halves)]
    };
    let at = |top: Vec<Step>, halves: Vec<Step>| of_nodes(parts(&top, &halves));
    let (accuracy, rest): (Vec<Step>, Vec<Step>) =
        by.iter().cloned().partition(|Step(_, by)| matches!(by, Evidence::Accuracy(..)));
    let number = accuracy[0].0;
    at(by.clone(), Vec::new()).expect("accepted");
    at(accuracy.clone(), rest.clone()).expect("accepted");
    assert_eq!(at(rest.clone(), accuracy.clone()), Err(Rejected::Step(1, number)));
    assert_eq!(at(Vec::new(), by.clone()), Err(Rejected::Step(1, number)));
    // Beside halves it is of the whole again.
    let across = |lower: Vec<Node>| [vec![halved(0)], lower, vec![node(by)]].concat();
    of_nodes(across(parts(by, &Vec::new()))).expect("accepted");
    assert_eq!(of_nodes(across(parts(&rest, &accuracy))), Err(Rejected::Step(2, number)));
}

#[test]
fn no_machine_has_a_cube_though_none_fails_them_all() {
    // x + a is within 1/2 on no cube of side 2, of a < 0 for its least x, of others for its greatest.
    let mut own = machine(
        r#"["a",{"min":"-0.5","max":"0.5"}]"#,
        [r#"{"rho":"x+a"}"#, r#"{"rho":"y"}"#],
        r#"{"quantity":"joint_range","leg":1,"end":"min","bound":"-0.9"},{"quantity":"joint_range","leg":1,"end":"max","bound":"0.9"}"#,
    );
    let zero = || Expression::integer(0);
    own.workspace = Workspace::Box { min: vec![zero(), zero()], max: vec![zero(), zero()] };
    let claim = NoCubeClaim { machine: own.clone(), side: Expression::integer(2) };
    let proved = |nodes: Vec<Node>| {
        let tree = Tree { precision: 40, chords: None, nodes };
        let own = certificate(&own, Verdict::Certified, Proof::Tree(tree));
        check(&Certificate { claim: Claim::NoCube(claim.clone()), ..own })
    };
    let fails = |obligation: usize, x: i64| Node {
        fails: Some(Failure::Obligation(obligation, Vec::new())),
        at: vec![x, 0],
        ..Node::default()
    };
    let [low, high] = [fails(1, -8), fails(2, 8)];
    proved(vec![halved(2), low.clone(), high.clone()]).expect("accepted");
    for nodes in [
        vec![low.clone()],
        vec![high.clone()],
        vec![halved(2), high.clone(), low.clone()],
        vec![halved(2), low.clone(), low.clone()],
        vec![halved(2), low],
    ] {
        assert!(proved(nodes).is_err());
    }
}
