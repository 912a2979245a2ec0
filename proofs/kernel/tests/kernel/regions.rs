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
        proof: Proof::Tree(Tree { precision: 40, chords: None, nodes }),
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
        // Of two points, not of one.
        (r#""require":["#, r#""require":[{"quantity":"one_to_one","end":"holds"},"#),
    ] {
        let mut whole = certificate("0", "0", vec![Node::default()]);
        let machine = claim(&DISC.replace(from, to));
        let zero = number("0");
        whole.claim = Claim::Region(RegionClaim { machine, inner: zero.clone(), outer: zero });
        assert!(matches!(check(&whole), Err(Rejected::Claim(_))), "{to}");
    }
}

/// The certificate of the disc's shape with another machine, and a tree of one leaf or more.
fn other(machine: &str, inner: &str, nodes: Vec<Node>) -> Certificate {
    let mut certificate = certificate(inner, "0", nodes);
    let (inner, outer) = (number(inner), number("0"));
    certificate.claim = Claim::Region(RegionClaim { machine: claim(machine), inner, outer });
    certificate
}

/// The box is `[0, 1]`, but a corner of it is written so that few bits enclose it in a range a
/// million times as long. Its points do not pass `x >= 2`; the rest of that range does.
#[test]
fn shares_are_of_the_box_and_not_of_its_enclosure() {
    let machine = r#"{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[],"definitions":[],"joints":[{"rho":"x"}]}},"workspace":{"box":{"min":["0"],"max":["1+(sqrt(2)^2-2)*10^40"]}},"require":[{"quantity":"joint_range","leg":1,"end":"min","bound":"2"}]}"#;
    let y = Multiplier { y: vec![vec![1]], places: 0 };
    let by = vec![Step(0, Evidence::Lower(y)), Step(1, Evidence::Test)];
    let mut nodes = Vec::new();
    for _ in 0..20 {
        nodes.push(Node { split: Some(0), ..Node::default() });
    }
    nodes.push(Node::default());
    nodes.extend((0..20).map(|_| Node { by: by.clone(), ..Node::default() }));
    assert_eq!(check(&other(machine, "1/2", nodes.clone())), Err(Rejected::Shares));
    check(&other(machine, "0", nodes)).expect("no share at all");
}

/// No point of the box is good for each orientation; half of the pairs of both are.
#[test]
fn regions_are_not_of_orientations() {
    let machine = r#"{"mechanism":{"planar":{"legs":[{"drive":"strut","anchor":["0","0"],"platform":["0","0"]},{"drive":"strut","anchor":["10","0"],"platform":["0","0"]},{"drive":"strut","anchor":["0","10"],"platform":["1","0"]}],"characteristic_length":"1"}},"workspace":{"box":{"min":["4","4"],"max":["5","5"]}},"orientation":{"range":["-60","60"]},"require":[]}"#;
    let rejected = check(&other(machine, "0", vec![Node::default()]));
    assert!(matches!(rejected, Err(Rejected::Claim(_))), "{rejected:?}");
}

/// That a machine is one to one is no property of a point: each of `[-1, 1]` but zero has a partner
/// with the joint coordinate `x^2`, and the leaf `[1/2, 1]` has none within itself.
#[test]
fn regions_are_not_of_pairs_of_points() {
    let machine = r#"{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[],"definitions":[],"joints":[{"rho":"x^2"}]}},"workspace":{"box":{"min":["-1"],"max":["1"]}},"require":[{"quantity":"one_to_one","end":"holds"}]}"#;
    let y = Multiplier { y: vec![vec![1]], places: 0 };
    let by = vec![Step(0, Evidence::Lower(y.clone())), Step(1, Evidence::Chords)];
    let split = Node { split: Some(0), ..Node::default() };
    let open = Node::default;
    let nodes = vec![split.clone(), open(), split, open(), Node { by, ..open() }];
    let mut certificate = other(machine, "0.2", nodes);
    if let Proof::Tree(tree) = &mut certificate.proof {
        tree.chords = Some(y);
    }
    let rejected = check(&certificate);
    assert!(matches!(rejected, Err(Rejected::Claim(_))), "{rejected:?}");
}
