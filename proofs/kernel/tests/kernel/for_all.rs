//! Pavings of some coordinates for all values of the others: what is accepted, and what is rejected.

use crate::certificates::claim;
use crate::pavings::{bare, body, checked, header_of, paving, reason, written};
use crate::turning::{hexapod_legs, on_circle, planar, spatial, strut};
use orthocert_kernel::certificate::{Evidence, Failure};
use orthocert_kernel::paving::{
    names, Axis, Header, Item, Kind, Outer, Reader, Rejected, Step, Subject, Symmetry, SHARE_BITS,
};
use orthocert_kernel::prover::check_sample;
use orthocert_kernel::test::Multiplier;

/// `x^2 + y^2 <= 1/2` for all `y` of `[-1/2, 1/2]`: if and only if `x <= 1/2`.
const DISC: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[],"definitions":[],"joints":[{"rho":"x"},{"rho":"y"},{"rho":"x^2+y^2"}]}},"workspace":{"box":{"min":["0","-1/2"],"max":["1","1/2"]}},"require":[{"quantity":"joint_range","leg":3,"end":"max","bound":"1/2"}]}"#;

fn of(coordinates: &[&str], text: &str, depth: u32) -> Header {
    let coordinates = coordinates.iter().map(|&name| name.to_owned()).collect();
    Header { coordinates: Some(coordinates), ..header_of(claim(text), depth) }
}

fn at(place: &[i64]) -> Kind {
    Kind::At(place.to_vec(), Outer::Own(1))
}

const FIRST_PART: usize = 3;
const OPEN: usize = 8;
const OUTER: usize = 9;

/// Inner, in two parts, to 1/4; undecided to 5/8; outer from there, at `y = 1/2`.
fn items() -> Vec<Item> {
    use Kind::{Boundary, Inner, Part, Split};
    let x = || Split(Axis::X);
    let low = [x(), x(), Part(0), Inner, Inner, Boundary];
    let high = [x(), x(), Boundary, at(&[1 << 16]), at(&[1 << 16])];
    low.into_iter().chain(high).map(bare).collect()
}

#[test]
fn what_holds_for_all_values_of_the_others_is_inner() {
    let header = of(&["x"], DISC, 3);
    let bytes = written(&header, &items());
    let found = checked(&bytes).unwrap();
    let whole = 1u128 << SHARE_BITS;
    assert_eq!(
        (found.summary.inner_share.0, found.summary.boundary_share.0),
        (whole / 4, whole * 3 / 8)
    );
    let summary = &found.summary;
    assert_eq!((summary.splits, summary.inner, summary.outer, summary.boundary), (4, 1, 2, 2));
    // Two parts and two outer cells.
    assert_eq!(found.checked, 4);
    let text = orthocert_kernel::statement::paving(&found);
    assert!(text.contains("the values of (x) at which, for all values of the other coordinates"));
    assert!(text.contains("It is proved: the volume of R"), "{text}");
    // Three are as many as there are cells, and fewer than there is evidence.
    let sampled = check_sample(bytes.as_slice(), 3, 1).unwrap();
    assert_eq!((sampled.accepted.checked, sampled.decided), (3, 4));
    let text = sampled.statement();
    assert!(text.contains("The evidence of 3 of the 4 boxes") && !text.contains("It is proved"));
}

#[test]
fn what_one_value_of_the_others_refutes_is_not_inner() {
    let header = of(&["x"], DISC, 3);
    let with = |place: usize, new: &[Kind]| {
        let mut items = items();
        items.splice(place..=place, new.iter().cloned().map(bare));
        reason(&written(&header, &items))
    };
    use Kind::{Boundary, Inner, Outside, Part, Split};
    let parts = [Part(0), Inner, Inner];
    let deeper = [Part(0), Part(0), Inner, Inner, Part(0), Inner, Inner];
    for (name, place, new, expected) in [
        ("undecided as inner", OPEN, &[Inner][..], "obligation 1 is not certainly met"),
        ("inner in parts, of which one has a failure", OUTER, &parts, "is not certainly met"),
        ("in more parts", OUTER, &deeper, "is not certainly met"),
        ("an undecided part", FIRST_PART, &[Boundary], "parts of a cell"),
        ("a part split along what is paved", FIRST_PART, &[Split(Axis::X)], "parts of a cell"),
        ("an outer part", FIRST_PART, &[at(&[0])], "parts of a cell"),
        ("a part that is not outside", FIRST_PART, &[Outside], "is not outer"),
        ("a cell that is outside", OPEN, &[Outside], "parts of a cell"),
        ("a part along no coordinate", OPEN, &[Part(1), Inner, Inner], "split too often"),
        ("a value at which it holds", OUTER, &[at(&[1 << 15])], "is not outer"),
        ("a value beyond the range", OUTER, &[at(&[(1 << 16) + 1])], "is not outer"),
        ("a value below it", OUTER, &[at(&[-1])], "is not outer"),
        ("no value", OUTER, &[at(&[])], "is not outer"),
        ("a value too many", OUTER, &[at(&[1 << 16, 0])], "is not outer"),
        ("no value, but all", OUTER, &[Kind::Outer(Outer::Own(1))], "is not outer"),
        ("a value where some of the cell is in", OPEN, &[at(&[1 << 16])], "is not outer"),
        ("by no obligation", OUTER, &[Kind::At(vec![1 << 16], Outer::Own(2))], "is not outer"),
    ] {
        let found = with(place, new);
        assert!(found.contains(expected), "{name}: {found}");
    }
    // A step above the parts has to hold on all of them.
    let mut early = items();
    early[OPEN] = Item { steps: vec![Step(1, None)], kind: Kind::Part(0) };
    early.splice(OPEN + 1..OPEN + 1, [Inner, Inner].map(bare));
    assert!(reason(&written(&header, &early)).contains("obligation 1 is not certainly met"));
    // Nor may one be sampled away that claims nothing it could show.
    let mut none = items();
    none[OUTER].kind = Kind::At(vec![1 << 16], Outer::Own(9));
    let sampled = check_sample(&*written(&header, &none), 1, 0);
    assert!(sampled.unwrap_err().to_string().contains("is not outer"));
}

#[test]
fn bytes_of_values_stand_before_outer_kinds_alone() {
    let header = of(&["x"], DISC, 3);
    // 0a, a list of one, 2^16; then a kind.
    let value = [0x0a, 1, 0x80, 0x80, 8];
    for kinds in [&[3u8][..], &[4], &[5], &[0], &[0x20], &[0x0b], &[0x0a, 0, 0x41], &[0x80]] {
        let bytes = [&body(&header, &[])[..], &value, kinds].concat();
        let found = reason(&bytes);
        assert!(found.contains("has no meaning there"), "{kinds:?}: {found}");
    }
    let bytes = [&body(&header, &[])[..], &value, &[0x41]].concat();
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    assert_eq!(reader.next().unwrap().unwrap().item, bare(at(&[1 << 16])));
    assert!(reason(&[&body(&header, &[])[..], &[0x25]].concat()).contains("no meaning there"));
}

#[test]
fn other_coordinates_are_another_theorem() {
    let items = items();
    let all = body(&of(&["x"], DISC, 3), &items);
    let start = all.iter().position(|byte| *byte == b'\n').unwrap();
    let under = |header: Header| {
        let mut bytes = serde_json::to_vec(&header).unwrap();
        bytes.extend(&all[start..]);
        reason(&bytes)
    };
    let not_a_box = "not a box of positive volume";
    for (coordinates, expected) in [
        (&["y"][..], "is not certainly met"),
        (&["x", "y"], "split too often"),
        (&["y", "x"], "split too often"),
        (&["z"], not_a_box),
        (&["x", "x"], not_a_box),
        (&[], not_a_box),
        (&["x", "y", "y", "x"], not_a_box),
    ] {
        let found = under(of(coordinates, DISC, 3));
        assert!(found.contains(expected), "{coordinates:?}: {found}");
    }
    let none = Header { coordinates: None, ..of(&["x"], DISC, 3) };
    assert!(under(none).contains("split too often"));
    let symmetric = Header { symmetry: Some(Symmetry::Permutations), ..of(&["x"], DISC, 3) };
    assert!(under(symmetric).contains("permutation"));
    let flat = DISC.replace(r#""min":["0""#, r#""min":["1""#);
    assert!(under(of(&["x"], &flat, 3)).contains(not_a_box));
}

#[test]
fn coordinates_that_are_bound_to_others_have_no_name() {
    let named = |text: &str| {
        let names = names(&claim(text));
        names.into_iter().map(|name| name.unwrap_or("-".to_owned())).collect::<Vec<_>>().join(" ")
    };
    let require = r#"{"quantity":"joint_range","end":"max","bound":"2"}"#;
    let set = |set: &str| spatial(&hexapod_legs(), set, require);
    assert_eq!(named(&set(r#"{"angle":"5"}"#)), "x y z - - -");
    let ranges = r#"{"roll_pitch_yaw":{"roll":["0","1"],"pitch":["0","1"],"yaw":["0","1"]}}"#;
    assert_eq!(named(&set(ranges)), "x y z roll pitch yaw");
    let round = set(ranges).replace(
        r#"{"box":{"min":["-0.2","-0.2","0.8"],"max":["0.2","0.2","1.2"]}}"#,
        r#"{"cylinder":{"center":["0","0"],"radius":"0.2","z":["0.8","1.2"]}}"#,
    );
    assert_eq!(named(&round), "- - z roll pitch yaw");
    assert!(Subject::new(&of(&["z"], &round, 3)).is_ok());
    for other in ["x", "-", ""] {
        assert!(Subject::new(&of(&[other], &round, 3)).is_err(), "{other}");
    }
    assert_eq!(named(DISC), "x y");
}

/// The document's instance, byte for byte.
#[test]
fn the_instance_of_the_document_is_accepted() {
    let document = include_str!("../../../FORMAT.md");
    let at = document.find(r#"{"format":"orthocert-paving/3""#).unwrap();
    let mut lines = document[at..].lines();
    let [first, nodes, last] = [(); 3].map(|()| lines.next().unwrap());
    let nodes = nodes.split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap());
    let nodes: Vec<u8> = nodes.collect();
    let bytes = [first.as_bytes(), b"\n", &nodes, last.as_bytes(), b"\n"].concat();
    let found = checked(&bytes).unwrap();
    assert_eq!(found.checked, 4);
    for at in first.len() + 1..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        assert!(checked(&changed).is_err(), "byte {at}");
    }
}

/// Struts of at most 1/10 fail wherever the platform is, but only orientations of the set count.
#[test]
fn values_off_the_set_of_orientations_refute_nothing() {
    let require = r#"{"quantity":"joint_range","end":"max","bound":"0.1"}"#;
    let text = spatial(&hexapod_legs(), r#"{"angle":"15"}"#, require);
    let header = of(&["x", "y", "z"], &text, 3);
    let of = |place: &[i64]| checked(&written(&header, &[bare(at(place))]));
    let middle = 1 << 15;
    of(&[middle, middle, middle]).expect("no turn");
    of(&[middle, 65_000, middle]).expect("nearly 15 degrees about y");
    for corner in [[0, 0, 0], [1 << 16, 1 << 16, middle], [60_000, 60_000, 5_000]] {
        let found = of(&corner).expect_err("off the ball").to_string();
        assert!(found.contains("is not outer"), "{found}");
    }
    // A part in a corner is outside; its neighbour is not.
    let outside = |depth: usize| {
        let mut items: Vec<Item> = (0..3 * depth).map(|k| bare(Kind::Part(k % 3))).collect();
        items.push(bare(Kind::Outside));
        reason(&written(&header, &items))
    };
    // [-t, 0]^3 holds points of the ball, [-t, -t/2]^3 holds points, [-t, -3t/4]^3 none.
    assert!(outside(1).contains("is not outer"), "{}", outside(1));
    assert!(outside(2).contains("is not outer"));
    // After that, the last line is no node.
    assert!(outside(3).starts_with("node 10: parts of a cell"), "{}", outside(3));
}

/// The first strut from (0, 1) to a joint at 1/2, 80 degrees on, has the square length
/// `5/4 - cos(80 + phi)` at `P = 0`: it is at most that of 85 degrees for 25 of 40 degrees.
#[test]
fn angles_are_paved_in_degrees() {
    let legs: Vec<String> = [90.0, 210.0, 330.0]
        .map(|at| strut(&on_circle(1.0, at), &on_circle(0.5, at + 80.0)))
        .to_vec();
    let bound = (1.25 - 85f64.to_radians().cos()).sqrt();
    let require =
        format!(r#"{{"quantity":"joint_range","leg":1,"end":"max","bound":"{bound:.9}"}}"#);
    let text = planar(&legs, [r#""0","0""#; 2], r#""-20","20""#, &require);
    let (bytes, items) = paving(&of(&["angle"], &text, 14));
    let found = checked(&bytes).unwrap();
    let share = |x: u128| x as f64 / f64::from(SHARE_BITS).exp2();
    let (least, most) = (
        share(found.summary.inner_share.0),
        share(found.summary.inner_share.0 + found.summary.boundary_share.0),
    );
    assert!(least < 0.62501 && 0.62499 < most && most - least < 0.001, "{least} {most}");
    assert!(items.len() < 100, "{}", items.len());
    // Each node asks for multiples of both ends, which long numbers would make dear.
    for (end, is_short) in
        [("-sqrt(400)", false), ("-20-1/3^64/3^64/3^64", false), ("-20-1/3^64/3^64", true)]
    {
        let of_end = text.replace(r#""-20""#, &format!("\"{end}\""));
        let found = Subject::new(&of(&["angle"], &of_end, 14)).map(drop);
        let is_refused = matches!(found, Err(Rejected::Whole(why)) if why.contains("256 bits"));
        assert_eq!(is_refused, !is_short, "{end}: {found:?}");
    }
}

/// Evidence about evidence is read as it is written, in its order alone.
#[test]
fn evidence_at_control_points_has_bytes() {
    let y = || Multiplier { y: vec![vec![1, -300], vec![0, i64::MIN]], places: 7 };
    let lower = || Box::new(Evidence::Lower(y()));
    let inside = || Evidence::Inside(lower(), -5, 255);
    let turned = || Evidence::Turned(Box::new(inside()), 1 << 40, 0);
    let control = |of| Evidence::Control(Box::new(of));
    let header = of(&["x"], DISC, 3);
    let read = |evidence: Evidence| {
        let item = Item { steps: vec![Step(0, Some(evidence))], kind: Kind::Inner };
        let bytes = body(&header, std::slice::from_ref(&item));
        let found = Reader::new(bytes.as_slice()).unwrap().next();
        found.map(|found| assert_eq!(found.unwrap().item, item)).map_err(|e| e.to_string())
    };
    for evidence in [
        control(Evidence::Test),
        control(turned()),
        control(inside()),
        turned(),
        inside(),
        Evidence::Accuracy(y(), 9, 3),
        control(Evidence::Accuracy(y(), 9, 0)),
    ] {
        read(evidence).unwrap();
    }
    for evidence in [
        control(control(Evidence::Test)),
        Evidence::Turned(Box::new(turned()), 1, 1),
        Evidence::Inside(Box::new(turned()), 1, 1),
        Evidence::Inside(Box::new(control(Evidence::Test)), 1, 1),
    ] {
        assert!(read(evidence).unwrap_err().contains("no meaning there"));
    }
    let given = Kind::At(vec![0], Outer::Given(Failure::Reach.into()));
    assert!(Item { steps: Vec::new(), kind: given }.write(&mut Vec::new()).is_some());
}
