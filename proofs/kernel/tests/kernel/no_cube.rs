//! Claims that no cube of some side fits: proved, and what is rejected.

use crate::certificates::claim;
use crate::rough::Rough;
use nalgebra::DMatrix;
use orthocert_kernel::certificate::{
    Certificate, Claim, Evidence, Failure, Node, Proof, Provenance, Step, Tree, Verdict, Witness,
    FORMAT,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::NoCubeClaim;
use orthocert_kernel::no_cube::statement;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::rejected::Rejected;
use orthocert_kernel::tree::OFFSET_PARTS;
use orthocert_kernel::witness::{self, WitnessError};

/// The Orthoglide with `L = 1`, `1/2 <= psi <= 2`, and centres in `[low, high]^3`.
fn orthoglide(low: &str, high: &str, side: &str) -> NoCubeClaim {
    let leg = |n: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":"1","mode":"+"}}"#
        )
    };
    let legs = [leg(r#""1","0","0""#), leg(r#""0","1","0""#), leg(r#""0","0","1""#)].join(",");
    let machine = format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["{low}","{low}","{low}"],"max":["{high}","{high}","{high}"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"2"}},{{"quantity":"transmission","end":"min","bound":"1/2"}}]}}"#
    );
    NoCubeClaim { machine: claim(&machine), side: number(side) }
}

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

fn certificate(claim: NoCubeClaim, nodes: Vec<Node>) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::NoCube(claim),
        verdict: Verdict::Certified,
        proof: Proof::Tree(Tree { precision: 52, chords: None, nodes }),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}

/// `M` of the Orthoglide, from the paper; none where a leg does not reach.
fn matrix([x, y, z]: [f64; 3]) -> Option<DMatrix<f64>> {
    let s = |a: f64, b: f64| (1.0 - a * a - b * b).max(0.0).sqrt();
    let (s1, s2, s3) = (s(y, z), s(x, z), s(x, y));
    let reaches = s1.min(s2).min(s3) > 0.0;
    let entries = [1.0, y / s1, z / s1, x / s2, 1.0, z / s2, x / s3, y / s3, 1.0];
    reaches.then(|| DMatrix::from_row_slice(3, 3, &entries))
}

/// How the claim fails at a point, if it does.
fn failure(x: [f64; 3]) -> Option<Failure> {
    let Some(m) = matrix(x) else { return Some(Failure::Reach) };
    let svd = m.svd(false, true);
    let rows = svd.v_t?;
    let (least, greatest) = (svd.singular_values.imin(), svd.singular_values.imax());
    let along = |i: usize| vec![rows.row(i).iter().map(|v| (v * 1024.0).round() as i64).collect()];
    if svd.singular_values[least] < 0.5 {
        Some(Failure::Obligation(0, along(least)))
    } else if svd.singular_values[greatest] > 2.0 {
        Some(Failure::Obligation(1, along(greatest)))
    } else {
        None
    }
}

/// Offsets that are tried: the cube's vertices.
fn offsets() -> impl Iterator<Item = [i64; 3]> {
    (0..8).map(|v| {
        std::array::from_fn(|k| if v >> k & 1 == 1 { OFFSET_PARTS } else { -OFFSET_PARTS })
    })
}

fn leaf(fails: Failure, at: [i64; 3]) -> Node {
    Node { fails: Some(fails), at: at.to_vec(), ..Node::default() }
}

/// Leaves are tried one by one in a certificate over their own cell.
fn grow(nodes: &mut Vec<Node>, low: [f64; 3], high: [f64; 3], side: f64, depth: usize) -> bool {
    let text = |x: f64| number(&x.to_string());
    let centre: [f64; 3] = std::array::from_fn(|k| (low[k] + high[k]) / 2.0);
    for at in offsets() {
        let x = std::array::from_fn(|k| centre[k] + at[k] as f64 * side / 16.0);
        let Some(fails) = failure(x) else { continue };
        let mut own = orthoglide("0", "0", &side.to_string());
        own.machine.workspace = orthocert_kernel::claim::Workspace::Box {
            min: low.map(text).to_vec(),
            max: high.map(text).to_vec(),
        };
        if check(&certificate(own, vec![leaf(fails.clone(), at)])).is_ok() {
            nodes.push(leaf(fails, at));
            return true;
        }
    }
    if depth == 18 {
        return false;
    }
    let k = depth % 3;
    nodes.push(Node { split: Some(k), ..Node::default() });
    let (mut below, mut above) = (high, low);
    below[k] = centre[k];
    above[k] = centre[k];
    grow(nodes, low, below, side, depth + 1) && grow(nodes, above, high, side, depth + 1)
}

/// Centres in `[0, 1/4]^3`: the largest cube on the diagonal has the side 0.644.
fn proved() -> (NoCubeClaim, Vec<Node>) {
    let mut nodes = Vec::new();
    assert!(grow(&mut nodes, [0.0; 3], [0.25; 3], 0.75, 0));
    (orthoglide("0", "0.25", "0.75"), nodes)
}

#[test]
fn no_cube_of_three_quarters_of_the_leg() {
    let (claim, nodes) = proved();
    let certificate = certificate(claim.clone(), nodes);
    let text = certificate.to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    assert_eq!(read, certificate);
    check(&read).expect("accepted");
    let words = statement(&claim);
    for sentence in ["No axis-aligned cube of side 0.75", "from (0, 0, 0) to (0.25, 0.25, 0.25)"] {
        assert!(words.contains(sentence), "{words}");
    }
}

#[test]
fn proofs_that_show_less() {
    let with = |change: &dyn Fn(&mut NoCubeClaim, &mut Vec<Node>)| {
        let (mut claim, mut nodes) = proved();
        change(&mut claim, &mut nodes);
        check(&certificate(claim, nodes))
    };
    with(&|_, _| {}).expect("accepted");
    let (own, nodes) = proved();
    let mut wide = certificate(own, nodes.clone());
    wide.proof = Proof::Tree(Tree { precision: 80, chords: None, nodes: nodes.clone() });
    check(&wide).expect("accepted beyond words");
    let last = nodes.len() - 1;
    // A point beyond the cube, however far the claim fails there.
    let beyond = with(&|_, nodes| nodes[last] = leaf(Failure::Reach, [9, 9, 9]));
    assert_eq!(beyond, Err(Rejected::Holds(last)));
    let least = with(&|_, nodes| nodes[last] = leaf(Failure::Reach, [i64::MIN, 8, 8]));
    assert_eq!(least, Err(Rejected::Holds(last)));
    // A point that is good, an offset of two coordinates, and none.
    for at in [vec![0, 0, 0], vec![8, 8], vec![], vec![8; 6]] {
        let found = with(&|_, nodes| nodes[last].at.clone_from(&at));
        assert_eq!(found, Err(Rejected::Holds(last)), "{at:?}");
    }
    // A leaf that is open, and one that holds of itself.
    let open = with(&|_, nodes| nodes[last] = Node::default());
    assert_eq!(open, Err(Rejected::Holds(last)));
    // An offset where nothing fails.
    let split = with(&|_, nodes| nodes[0].at = vec![0; 3]);
    assert_eq!(split, Err(Rejected::Shape(0)));
    // A smaller cube, more centres, a half missing, one too many.
    assert!(with(&|claim, _| claim.side = number("0.5")).is_err());
    assert!(with(&|claim, _| claim.machine = orthoglide("-0.25", "0.25", "1").machine).is_err());
    assert!(matches!(with(&|_, nodes| drop(nodes.pop())), Err(Rejected::Shape(_))));
    assert!(matches!(with(&|_, nodes| nodes.push(Node::default())), Err(Rejected::Shape(_))));
    // A side of zero, or less: of a point, or of nothing.
    for side in ["0", "-0.75"] {
        let claim = with(&|claim, _| claim.side = number(side));
        assert!(matches!(claim, Err(Rejected::Claim(_))), "{side}");
    }
    let cube = with(&|claim, _| {
        claim.machine.workspace = orthocert_kernel::claim::Workspace::Cylinder {
            center: [number("0"), number("0")],
            radius: number("0.1"),
            z: [number("0"), number("0.1")],
        };
    });
    assert!(matches!(cube, Err(Rejected::Claim(_))));
    // The offsets mean nothing to other claims.
    let (claim, nodes) = proved();
    let mut other = certificate(claim.clone(), nodes);
    other.claim = Claim::Machine(claim.machine);
    assert!(check(&other).is_err());
}

/// Centres in `[0, 1/10]^3`, side 9/10: the corner `C + (s/2) (1, 1, 1)` is at least `s/2` along each
/// axis, and `sigma_max` is 2 at `1/sqrt(6) = 0.408248`.
#[test]
fn one_corner_excludes_a_cube_and_what_excludes_none() {
    let stretched = |v: [i64; 3]| Failure::Obligation(1, vec![v.to_vec()]);
    let with =
        |side: &str, nodes: Vec<Node>| check(&certificate(orthoglide("0", "1/10", side), nodes));
    let corner = || leaf(stretched([1; 3]), [8; 3]);
    with("9/10", vec![corner()]).expect("accepted");
    assert_eq!(with("8/10", vec![corner()]), Err(Rejected::Holds(0)));
    // The halves of a cell may have different points.
    let split = Node { split: Some(1), ..Node::default() };
    with("9/10", vec![split, corner(), leaf(stretched([2; 3]), [8; 3])]).expect("accepted");
    let singular = Failure::Singular(vec![number("0"), number("0"), number("0")]);
    let by = |evidence: Evidence| Node { by: vec![Step(0, evidence)], ..Node::default() };
    let held = |evidence: Evidence| Node { by: vec![Step(0, evidence)], ..corner() };
    for (defect, nodes) in [
        ("the opposite corner", vec![leaf(stretched([1; 3]), [-8; 3])]),
        ("a point within", vec![leaf(stretched([1; 3]), [7; 3])]),
        ("another direction", vec![leaf(stretched([1, -1, 0]), [8; 3])]),
        ("no direction", vec![leaf(stretched([0; 3]), [8; 3])]),
        ("two directions", vec![leaf(Failure::Obligation(1, vec![vec![1; 3]; 2]), [8; 3])]),
        ("another obligation", vec![leaf(Failure::Obligation(0, vec![vec![1; 3]]), [8; 3])]),
        ("no such obligation", vec![leaf(Failure::Obligation(2, vec![vec![1; 3]]), [8; 3])]),
        ("no such leg", vec![leaf(Failure::Row(1, 3), [8; 3])]),
        ("within reach", vec![leaf(Failure::Reach, [8; 3])]),
        ("two points", vec![leaf(singular, [8; 3])]),
        ("what holds", vec![by(Evidence::Test)]),
        ("what is outside", vec![by(Evidence::Outside)]),
        ("a mirror image", vec![by(Evidence::Mirror)]),
        ("a step beside the point", vec![held(Evidence::Test)]),
        ("an open leaf", vec![Node::default()]),
        ("no nodes", Vec::new()),
    ] {
        assert!(with("9/10", nodes).is_err(), "{defect}");
    }
    let reversed = check(&certificate(orthoglide("1", "0", "1"), vec![corner()]));
    assert!(matches!(reversed, Err(Rejected::Claim(_))));
    let good = certificate(orthoglide("0", "1/10", "9/10"), vec![corner()]);
    let refuted = Certificate { verdict: Verdict::Refuted, ..good.clone() };
    assert_eq!(check(&refuted), Err(Rejected::Verdict));
    let point = vec![number("0"), number("0"), number("0")];
    let fails = stretched([1; 3]);
    let witness = Witness { precision: 52, point, machine: Vec::new(), fails };
    for verdict in [Verdict::Certified, Verdict::Refuted] {
        let proof = Proof::Witness(witness.clone());
        assert_eq!(check(&Certificate { verdict, proof, ..good.clone() }), Err(Rejected::Verdict));
    }
}

/// A leaf with a wide cell is accepted only if every point of it, moved, is bad.
#[test]
fn leaves_are_true_of_every_point() {
    let mut accepted = 0;
    let mut state = 7u64;
    let mut random = |n: i64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as i64 % n
    };
    for _ in 0..400 {
        let (low, width, side) = (random(40) - 20, 1 + random(6), 8 + random(60));
        let at = [0; 3].map(|_| random(17) - 8);
        let corner = |t: f64| {
            at.map(|o| (low as f64 + t * width as f64) / 64.0 + o as f64 * side as f64 / 1024.0)
        };
        let Some(fails) = failure(corner(0.5)) else { continue };
        let text = |n: i64| format!("{n}/64");
        let claim = orthoglide(&text(low), &text(low + width), &text(side));
        if check(&certificate(claim, vec![leaf(fails, at)])).is_err() {
            continue;
        }
        accepted += 1;
        for i in 0..125 {
            let t = [i % 5, i / 5 % 5, i / 25].map(|i| i as f64 / 4.0);
            let x = std::array::from_fn(|k| corner(t[k])[k]);
            assert!(failure(x).is_some(), "{x:?}");
        }
    }
    assert!(accepted > 40, "{accepted}");
}

/// Across the border of the third leg's reach, `x^2 + y^2 = 1`, its row is long or it does not reach.
#[test]
fn long_rows_across_the_border_of_reach() {
    let fails = |low: &str, high: &str, fails: Failure| {
        check(&certificate(orthoglide(low, high, "1/64"), vec![leaf(fails, [0; 3])]))
    };
    // |row_3| = 1/s_3 > 2 where 2 c^2 > 3/4: beyond 0.6124.
    fails("0.62", "0.75", Failure::Row(1, 2)).expect("accepted");
    let not = Err(Rejected::Holds(0));
    assert_eq!(fails("0.62", "0.75", Failure::Reach), not);
    assert_eq!(fails("0.61", "0.75", Failure::Row(1, 2)), not);
    // Of another obligation, of none, of another leg than there is.
    for (obligation, leg) in [(0, 2), (2, 2), (1, 3), (usize::MAX, usize::MAX)] {
        assert_eq!(fails("0.62", "0.75", Failure::Row(obligation, leg)), not);
    }
}

/// At a point of a machine's workspace as well.
#[test]
fn a_long_row_refutes() {
    let claim = orthoglide("-1", "1", "1").machine;
    let problem = Problem::new(&claim).expect("well formed");
    let found = |x: &str, fails: Failure| {
        let point = vec![number(x), number(x), number("0")];
        let witness = Witness { precision: 64, point, machine: Vec::new(), fails };
        witness::check(&problem, &claim.workspace, &witness)
    };
    found("0.6124", Failure::Row(1, 2)).expect("accepted");
    found("1", Failure::Row(1, 2)).expect("accepted");
    for (x, row) in [("0.6123", Failure::Row(1, 2)), ("1", Failure::Row(0, 2))] {
        assert_eq!(found(x, row), Err(WitnessError::NotViolated));
    }
}

/// What the lemma (row) rests on: the length of a leg is not more than that of its row of `A`.
#[test]
fn rows_are_as_long_as_their_legs() {
    let arm = r#""drive":"arm","axis":["0","1","0"],"reference":["1","0","0"],"platform":["0.1","0","0"],"arm":"1","length":"2","mode":"+""#;
    let strut = r#""drive":"strut","platform":["0.5","0.1","-0.2"]"#;
    let three = |leg: &str| {
        let leg = |anchor: &str| format!(r#"{{{leg},"anchor":[{anchor}]}}"#);
        [leg(r#""0","0","2""#), leg(r#""0.3","0","2""#), leg(r#""0","0.5","2.1""#)].join(",")
    };
    let boxed = r#""workspace":{"box":{"min":["0","0","0"],"max":["1","1","1"]}},"require":[]"#;
    let turned =
        r#""workspace":{"box":{"min":[],"max":[]}},"orientation":{"angle":"15"},"require":[]"#;
    let mut checked = 0;
    for text in [
        serde_json::to_string(&orthoglide("-1", "1", "1").machine).expect("a text"),
        format!(r#"{{"mechanism":{{"translational":[{}]}},{boxed}}}"#, three(arm)),
        format!(r#"{{"mechanism":{{"translational":[{}]}},{boxed}}}"#, three(strut)),
        format!(r#"{{"mechanism":{{"spherical":{{"legs":[{}]}}}},{turned}}}"#, three(strut)),
    ] {
        // A kind of machine without a motion is refused.
        let Ok(problem) = Problem::new(&claim(&text)) else { continue };
        let parameters = problem.parameters::<i64>(40, &[]).expect("parameters");
        let double = |x: i64| x as f64 * (-40f64).exp2();
        let values = problem.tape.run(
            &Rough,
            |k| Some([0.1, -0.05, 0.02][k]).map(|x| (x, x)),
            |j| Some((double(parameters[j].lo), double(parameters[j].hi))),
        );
        for leg in &problem.legs {
            let Some(length) = leg.length.and_then(|length| values.of(length)) else { continue };
            let square: f64 =
                leg.row.a.iter().map(|&a| values.of(a).expect("within reach").0.powi(2)).sum();
            assert!(square >= length.0.powi(2) - 1e-6, "{text}");
            checked += 1;
        }
    }
    assert!(checked >= 9, "{checked}");
}
