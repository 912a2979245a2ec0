//! Shares of a box: where a claim holds, where it fails, what is left open.

use crate::certificates::claim;
use orthocert_kernel::certificate::{
    Certificate, Claim, Evidence, Failure, Node, Proof, Provenance, Step, Tree, Verdict, FORMAT,
};
use orthocert_kernel::check::{check, Rejected};
use orthocert_kernel::claim::RegionClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::test::Multiplier;

/// Three joints, the third of which keeps to a quarter of a disc of area `pi/8`.
const DISC: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[],"definitions":[],"joints":[{"rho":"x"},{"rho":"y"},{"rho":"x^2+y^2"}]}},"workspace":{"box":{"min":["0","0"],"max":["1","1"]}},"require":[{"quantity":"joint_range","leg":3,"end":"max","bound":"1/2"}]}"#;

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

/// What shows both obligations, where they hold: `Y = (I, 0)` has `Y^T A = I`.
fn steps() -> Vec<Step> {
    let y = Multiplier { y: vec![vec![1, 0], vec![0, 1], vec![0, 0]], places: 0 };
    vec![Step(0, Evidence::Lower(y)), Step(1, Evidence::Test)]
}

fn fails() -> Node {
    Node { fails: Some(Failure::Obligation(1, Vec::new())), ..Node::default() }
}

/// The disc's tree below a cell `[x, x + 1/2^depth] x [y, y + 1/2^depth]`, down to `left` more levels.
fn grow(nodes: &mut Vec<Node>, [x, y]: [f64; 2], size: f64, left: u32) {
    let (least, greatest) = (x * x + y * y, (x + size).powi(2) + (y + size).powi(2));
    if greatest <= 0.5 {
        return nodes.push(Node { by: steps(), ..Node::default() });
    }
    if least > 0.5 {
        return nodes.push(fails());
    }
    if left == 0 {
        return nodes.push(Node::default());
    }
    nodes.push(Node { split: Some(0), ..Node::default() });
    for x in [x, x + size / 2.0] {
        nodes.push(Node { split: Some(1), ..Node::default() });
        for y in [y, y + size / 2.0] {
            grow(nodes, [x, y], size / 2.0, left - 1);
        }
    }
}

fn certificate(inner: &str, outer: &str, nodes: Vec<Node>) -> Certificate {
    let (inner, outer) = (number(inner), number(outer));
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Region(RegionClaim { machine: claim(DISC), inner, outer }),
        verdict: Verdict::Certified,
        proof: Proof::Tree(Tree { precision: 40, nodes }),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}

fn disc() -> Vec<Node> {
    let mut nodes = Vec::new();
    grow(&mut nodes, [0.0, 0.0], 1.0, 6);
    nodes
}

#[test]
fn shares_are_those_of_the_leaves() {
    // pi/8 = 0.3927, and a boundary of 2 x 64 - 1 cells of 1/4096 at most.
    let certificate = |inner, outer| certificate(inner, outer, disc());
    check(&certificate("0.37", "0.59")).expect("accepted");
    let text = certificate("0.37", "0.59").to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    check(&read).expect("accepted");
    assert_eq!(check(&certificate("0.3927", "0.59")), Err(Rejected::Shares));
    assert_eq!(check(&certificate("0.37", "0.6073")), Err(Rejected::Shares));
    assert_eq!(check(&certificate("-0.37", "0.59")), Err(Rejected::Shares));
}

#[test]
fn leaves_show_what_they_say() {
    let with = |change: &dyn Fn(&mut Vec<Node>)| {
        let mut nodes = disc();
        change(&mut nodes);
        check(&certificate("0", "0", nodes))
    };
    let first = |nodes: &[Node], wanted: &dyn Fn(&Node) -> bool| nodes.iter().position(wanted);
    let holds = |node: &Node| !node.by.is_empty();
    with(&|_| {}).expect("accepted");
    // A leaf that holds is said to fail.
    let at = first(&disc(), &holds).expect("one");
    assert_eq!(with(&|nodes| nodes[at] = fails()), Err(Rejected::Holds(at)));
    // One that fails is said to hold.
    let at = first(&disc(), &|node| node.fails.is_some()).expect("one");
    let step = Err(Rejected::Step { node: at, obligation: 1 });
    assert_eq!(with(&|nodes| nodes[at] = Node { by: steps(), ..Node::default() }), step);
    // It fails in another way than it does.
    for other in
        [Failure::Reach, Failure::Obligation(0, vec![vec![1, 0]]), Failure::Obligation(9, vec![])]
    {
        let node = Node { fails: Some(other), ..Node::default() };
        assert_eq!(with(&|nodes| nodes[at] = node.clone()), Err(Rejected::Holds(at)));
    }
    // An open leaf is said to fail.
    let at = first(&disc(), &|node| *node == Node::default()).expect("one");
    assert_eq!(with(&|nodes| nodes[at] = fails()), Err(Rejected::Holds(at)));
    // A node both fails and is split.
    let both = Node { split: Some(0), ..fails() };
    assert_eq!(with(&|nodes| nodes[0] = both.clone()), Err(Rejected::Shape(0)));
    // A tree with leaves that fail, or are open, certifies nothing.
    let mut whole = certificate("0", "0", disc());
    whole.claim = Claim::Machine(claim(DISC));
    assert!(matches!(check(&whole), Err(Rejected::Open { .. })));
}

#[test]
fn regions_are_of_boxes_with_a_volume() {
    for (from, to) in [
        (r#""max":["1","1"]"#, r#""max":["1","0"]"#),
        (r#"{"box":{"min":["0","0"],"max":["1","1"]}}"#, r#"{"cube":{"side":"1"}}"#),
    ] {
        let mut whole = certificate("0", "0", vec![Node::default()]);
        let machine = claim(&DISC.replace(from, to));
        let zero = number("0");
        whole.claim = Claim::Region(RegionClaim { machine, inner: zero.clone(), outer: zero });
        assert!(matches!(check(&whole), Err(Rejected::Claim(_))), "{to}");
    }
}
