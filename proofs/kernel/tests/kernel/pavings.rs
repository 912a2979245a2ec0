//! Pavings: what is accepted, what is rejected and why, and the volumes that are counted.

use crate::certificates::claim;
use orthocert_kernel::certificate::{Evidence, Failure, Provenance};
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::paving::{
    bit, check, is_mirrored, is_paving, is_symmetric, six_ordered, About, Accepted, Axis, Cell,
    Edge, Header, Item, Judge, Kind, Outer, Reader, Rejected, Step, Subject, Symmetry, Visited,
    FORMAT, SHARE_BITS,
};
use orthocert_kernel::prover::{check_sample, write_pair};
use orthocert_kernel::test::Multiplier;

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

/// The Orthoglide with `L = 1` and `1/2 <= psi <= 2` over `[low, high]^3`.
fn orthoglide(low: &str, high: &str) -> MachineClaim {
    let leg = |i: usize| {
        let direction = [0, 1, 2].map(|k| if k == i { r#""1""# } else { r#""0""# }).join(",");
        format!(
            r#"{{"drive":"slider","direction":[{direction}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":"1","mode":"+"}}"#
        )
    };
    let legs = [0, 1, 2].map(leg).join(",");
    let corner = |x: &str| format!(r#"["{x}","{x}","{x}"]"#);
    claim(&format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":{},"max":{}}}}},"require":[{{"quantity":"transmission","end":"min","bound":"1/2"}},{{"quantity":"transmission","end":"max","bound":"2"}}]}}"#,
        corner(low),
        corner(high)
    ))
}

/// Three joints, the third of which keeps to a quarter of a disc of area `pi/8`, told by `x` and `y`.
const DISC: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[],"definitions":[],"joints":[{"rho":"x"},{"rho":"y"},{"rho":"x^2+y^2"}]}},"workspace":{"box":{"min":["0","0"],"max":["1","1"]}},"require":[{"quantity":"joint_range","leg":3,"end":"max","bound":"1/2"}]}"#;

pub fn header_of(claim: MachineClaim, depth: u32) -> Header {
    Header {
        format: FORMAT.to_owned(),
        claim: About { machine: claim },
        coordinates: None,
        precision: 36,
        depth,
        symmetry: None,
        provenance: Provenance { tool: "test".into(), version: "1".into() },
    }
}

fn header(symmetric: bool) -> Header {
    let symmetry = symmetric.then_some(Symmetry::Permutations);
    Header { symmetry, ..header_of(orthoglide("-0.7", "0.7"), 10) }
}

pub fn bare(kind: Kind) -> Item {
    Item { steps: Vec::new(), kind }
}

/// What becomes of a cell, by trying a few pieces of evidence.
fn item(judge: &Judge<'_>, subject: &Subject, cell: &Cell, depth: u32) -> Item {
    if subject.header.symmetry.is_some() && is_mirrored(cell) {
        return bare(Kind::Mirrored);
    }
    let obligations = subject.problem.obligations.len();
    let outer = (0..obligations).map(|o| Kind::Outer(Outer::Own(o)));
    let mut kinds = std::iter::once(Kind::Inner).chain(outer).map(bare);
    if let Some(found) = kinds.find(|item| judge.confirms(cell, 0, item)) {
        return found;
    }
    if depth == subject.header.depth {
        return bare(Kind::Boundary);
    }
    let axes = Axis::ALL.iter().take(subject.order[0].len());
    let axis = *axes.min_by_key(|axis| cell.edges[axis.index()].level()).unwrap();
    bare(Kind::Split(axis))
}

/// A paving of few cells, and its items.
pub fn paving(header: &Header) -> (Vec<u8>, Vec<Item>) {
    let subject = Subject::new(header).unwrap();
    let judge = Judge::new(&subject).unwrap();
    let (mut items, mut waiting) = (Vec::new(), vec![(Cell::ROOT, 0)]);
    while let Some((cell, depth)) = waiting.pop() {
        let item = item(&judge, &subject, &cell, depth);
        if let Kind::Split(axis) = item.kind {
            let (lower, upper) = cell.halves(axis).unwrap();
            waiting.extend([(upper, depth + 1), (lower, depth + 1)]);
        }
        items.push(item);
    }
    (written(header, &items), items)
}

pub fn body(header: &Header, items: &[Item]) -> Vec<u8> {
    let mut bytes = serde_json::to_vec(header).unwrap();
    bytes.push(b'\n');
    for item in items {
        item.write(&mut bytes).unwrap();
    }
    bytes
}

/// The bytes of a paving with the summary that its tree has.
pub fn written(header: &Header, items: &[Item]) -> Vec<u8> {
    let mut bytes = body(header, items);
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while let Ok(Some(_)) = reader.next() {}
    let summary = serde_json::to_vec(&reader.summary).unwrap();
    bytes.extend(summary);
    bytes.push(b'\n');
    bytes
}

pub fn checked(bytes: &[u8]) -> Result<Accepted, Rejected> {
    check(bytes)
}

/// The reason for which these bytes are rejected.
pub fn reason(bytes: &[u8]) -> String {
    checked(bytes).expect_err("rejected").to_string()
}

#[test]
fn with_and_without_symmetry_the_same_volume_is_found() {
    let deep = |symmetric| Header { depth: 12, ..header(symmetric) };
    let (plain, _) = paving(&deep(false));
    let (mirrored, _) = paving(&deep(true));
    assert!(is_paving(&plain) && !is_paving(b"{\n\"format\":\"orthocert/2\""));
    let (plain, mirrored) = (checked(&plain).unwrap(), checked(&mirrored).unwrap());
    assert!(plain.summary.inner > 20 && plain.summary.outer > 20, "{:?}", plain.summary);
    assert!(mirrored.summary.mirrored > 0);
    // Undecided cells differ, for the axes take their turns; the volumes have to overlap.
    let ends = |a: &Accepted| {
        (a.summary.inner_share.0, a.summary.inner_share.0 + a.summary.boundary_share.0)
    };
    let ((a, b), (c, d)) = (ends(&plain), ends(&mirrored));
    assert!(a <= d && c <= b && b < 1 << SHARE_BITS);
    // Two million random points, in doubles, by another program: 0.5865, standard error 0.0004.
    let share = |x: u128| x as f64 / (SHARE_BITS as f64).exp2();
    assert!(share(a) < 0.588 && share(b) > 0.585 && share(a) > 0.2);
    assert_eq!(plain.checked, plain.summary.inner + plain.summary.outer);
}

#[test]
fn every_shorter_file_and_every_changed_byte_is_rejected_or_says_the_same() {
    let header = Header { depth: 8, ..header(true) };
    let (bytes, _) = paving(&header);
    let whole = checked(&bytes).unwrap();
    let start = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
    for length in (0..bytes.len()).step_by(7).chain(bytes.len() - 300..bytes.len()) {
        assert!(checked(&bytes[..length]).is_err(), "{length} bytes");
    }
    assert!(checked(&[&bytes[..], b" "].concat()).is_err());
    assert!(checked(&[&bytes[..], &bytes[..]].concat()).is_err());
    let (mut rejected, mut kept) = (0, 0);
    for at in (start..bytes.len()).step_by(3) {
        for change in [1, 0x10, 0x80] {
            let mut changed = bytes.clone();
            changed[at] ^= change;
            match checked(&changed) {
                Err(_) => rejected += 1,
                Ok(found) => {
                    assert_eq!(found.summary, whole.summary.clone());
                    kept += 1;
                }
            }
        }
    }
    // Directions leave room; nothing else does.
    assert!(rejected > 100 && kept < rejected / 2, "{rejected} {kept}");
}

/// A failure of singular values in a direction.
fn along(obligation: usize, v: &[i64]) -> Kind {
    Kind::Outer(Outer::Given(Failure::Obligation(obligation, vec![v.to_vec()]).into()))
}

#[test]
fn each_kind_is_rejected_where_it_is_not_true() {
    let plain = header(false);
    let (_, items) = paving(&plain);
    let first = |wanted: fn(&Kind) -> bool| items.iter().position(|i| wanted(&i.kind)).unwrap();
    let with = |at: usize, item: Item| {
        let mut items = items.clone();
        items[at] = item;
        reason(&written(&plain, &items))
    };
    let inner = first(|k| matches!(k, Kind::Inner));
    let outer = first(|k| matches!(k, Kind::Outer(_)));
    let boundary = first(|k| matches!(k, Kind::Boundary));
    let own = |steps: &[usize], kind| Item {
        steps: steps.iter().map(|&o| Step(o, None)).collect(),
        kind,
    };
    let lower = |y: [[i64; 3]; 3]| {
        let y = y.iter().map(|row| row.to_vec()).collect();
        let step = Step(0, Some(Evidence::Lower(Multiplier { y, places: 1 })));
        Item { steps: vec![step], kind: Kind::Inner }
    };
    let of_two = Evidence::Lower(Multiplier { y: vec![vec![1, 0, 0], vec![0, 1, 0]], places: 1 });
    let flat = Item { steps: vec![Step(0, Some(of_two))], kind: Kind::Inner };
    let outer_in = |o: usize| bare(Kind::Outer(Outer::Own(o)));
    let row = |o, leg| bare(Kind::Outer(Outer::Given(Failure::Row(o, leg).into())));
    for (name, at, item, expected) in [
        ("outer without truth", inner, bare(along(0, &[1, 1, 1])), "is not outer"),
        ("the same, of its own", inner, outer_in(0), "is not outer"),
        ("outer by the zero vector", outer, bare(along(0, &[0; 3])), "is not outer"),
        ("outer by a short vector", outer, bare(along(0, &[1, 1])), "is not outer"),
        ("outer by no vector", outer, bare(along(0, &[])), "is not outer"),
        ("in an obligation that is none", outer, outer_in(9), "is not outer"),
        ("in no obligation", outer, bare(along(9, &[1, 1, 1])), "is not outer"),
        ("by a row of another obligation", outer, row(0, 0), "is not outer"),
        ("by the row of no leg", outer, row(1, 3), "is not outer"),
        (
            "out of reach",
            inner,
            bare(Kind::Outer(Outer::Given(Failure::Reach.into()))),
            "is not outer",
        ),
        ("undecided as inner", boundary, bare(Kind::Inner), "is not certainly met"),
        (
            "undecided as inner, with steps",
            boundary,
            own(&[0, 1], Kind::Inner),
            "not certainly met",
        ),
        ("undecided as outer", boundary, bare(along(0, &[1, 1, 1])), "is not outer"),
        ("outer as inner", outer, bare(Kind::Inner), "is not certainly met"),
        ("mirrored without symmetry", inner, bare(Kind::Mirrored), "left out by symmetry"),
        (
            "steps of a boundary cell",
            boundary,
            own(&[0], Kind::Boundary),
            "neither split nor inner",
        ),
        ("a step twice", inner, own(&[0, 0], Kind::Inner), "already discharged"),
        ("a step for nothing", inner, own(&[2], Kind::Inner), "is not certainly met"),
        ("another Y", inner, lower([[0, 1, 0], [1, 0, 0], [0, 0, 1]]), "is not certainly met"),
        ("Y of another shape", inner, flat, "is not certainly met"),
        ("split without halves", boundary, bare(Kind::Split(Axis::X)), "split too often"),
    ] {
        let found = with(at, item);
        assert!(found.contains(expected), "{name}: {found}");
    }
    // A step on an ancestor has to hold on all of it.
    let mut early = items.clone();
    early[0].steps = vec![Step(1, None)];
    assert!(reason(&written(&plain, &early)).contains("obligation 1 is not certainly met"));
}

#[test]
fn given_evidence_shows_what_own_evidence_shows() {
    let plain = header(false);
    let (_, mut items) = paving(&plain);
    let y = vec![vec![1, 0, 0], vec![0, 1, 0], vec![0, 0, 1]];
    let given = Step(0, Some(Evidence::Lower(Multiplier { y, places: 1 })));
    let mut accepted = 0;
    for at in 0..items.len() {
        if items[at].kind == Kind::Inner {
            items[at].steps = vec![given.clone(), Step(1, Some(Evidence::Test))];
            accepted += u64::from(checked(&written(&plain, &items)).is_ok());
            items[at].steps.clear();
        }
    }
    assert!(accepted > 5, "{accepted}");
}

#[test]
fn two_halves_in_a_byte_are_what_they_are_in_three() {
    let header = header(true);
    let (bytes, items) = paving(&header);
    let mut short = serde_json::to_vec(&header).unwrap();
    short.push(b'\n');
    let mut at = 0;
    while at < items.len() {
        let pair = match &items[at..] {
            [Item { kind: Kind::Split(axis), .. }, lower, upper, ..] => {
                let length = short.len();
                let written = write_pair(&mut short, *axis, [&lower.kind, &upper.kind]);
                short.truncate(length + usize::from(written.is_some()));
                written.is_some()
            }
            _ => false,
        };
        if !pair {
            items[at].write(&mut short).unwrap();
        }
        at += if pair { 3 } else { 1 };
    }
    let summary = bytes.windows(9).rposition(|part| part == b"{\"splits\"").unwrap();
    short.extend(&bytes[summary..]);
    assert!(short.len() < bytes.len() - 100);
    let (long, short) = (checked(&bytes).unwrap(), checked(&short).unwrap());
    assert_eq!((long.summary, long.checked), (short.summary, short.checked));
}

#[test]
fn a_box_of_two_coordinates_is_paved_and_split_along_no_third() {
    let header = header_of(claim(DISC), 12);
    let (bytes, mut items) = paving(&header);
    let accepted = checked(&bytes).unwrap();
    let share = |x: u128| x as f64 / (SHARE_BITS as f64).exp2();
    let (least, open) =
        (share(accepted.summary.inner_share.0), share(accepted.summary.boundary_share.0));
    let area = std::f64::consts::PI / 8.0;
    assert!(least <= area && area <= least + open && open < 0.06, "{least} {open}");
    let boundary = items.iter().position(|item| item.kind == Kind::Boundary).unwrap();
    items[0].kind = Kind::Split(Axis::Z);
    assert!(reason(&written(&header, &items)).contains("split too often"));
    items[0].kind = Kind::Split(Axis::X);
    items[boundary] = bare(Kind::Outer(Outer::Own(1)));
    assert!(reason(&written(&header, &items)).contains("is not outer"));
}

#[test]
fn what_is_inherited_need_not_be_shown_again() {
    let plain = header(false);
    let subject = Subject::new(&plain).unwrap();
    let judge = Judge::new(&subject).unwrap();
    // Off the region by sigma_min alone.
    let edge = |index: u64| Edge(16 + index);
    let cell = Cell { edges: [edge(4), edge(4), edge(4)], ..Cell::ROOT };
    let visited = |inherited, item| Visited { cell, inherited, depth: 12, node: 7, item };
    let of = |inherited| judge.check(&visited(inherited, bare(Kind::Inner)));
    assert!(matches!(of(0), Err(Rejected::Step(7, 0))), "{:?}", of(0));
    assert!(matches!(of(bit(1)), Err(Rejected::Step(7, 0))));
    of(bit(0)).expect("sigma_max is no obstacle");
    of(subject.all()).expect("nothing is left");
}

#[test]
fn symmetry_leaves_out_only_what_is_out_of_order() {
    let symmetric = header(true);
    let (_, items) = paving(&symmetric);
    let inner = items.iter().position(|i| i.kind == Kind::Inner).unwrap();
    let mut wrong = items.clone();
    wrong[inner] = Item { steps: Vec::new(), kind: Kind::Mirrored };
    assert!(reason(&written(&symmetric, &wrong)).contains("has points with u_x < u_y < u_z"));
    // The same bytes for a box that is not symmetric.
    let mut header = symmetric;
    let Workspace::Box { max, .. } = &mut header.claim.machine.workspace else {
        panic!("not a box")
    };
    max[2] = number("0.8");
    assert!(reason(&written(&header, &items)).contains("in every permutation"));
}

#[test]
fn machines_that_look_different_from_permuted_axes_are_refused() {
    let exactly = |text| Quantity::Exactly(number(text));
    assert!(is_symmetric(&orthoglide("-0.5", "0.5")));
    // Sets, for each leg, an entry of its anchor, direction, or length.
    type Change<'a> = &'a dyn Fn(usize, &mut Vec<Quantity>, &mut Vec<Quantity>, &mut Quantity);
    let change = |change: Change<'_>| {
        let mut claim = orthoglide("-0.5", "0.5");
        let Mechanism::Translational(legs) = &mut claim.mechanism else { panic!("no legs") };
        for (i, leg) in legs.iter_mut().enumerate() {
            let Leg::Slider { direction, anchor, length, .. } = leg else { panic!("no slider") };
            change(i, direction, anchor, length);
        }
        is_symmetric(&claim)
    };
    let tolerance = || Quantity::Between { min: number("0.1"), max: number("0.2") };
    assert!(change(&|i, _, anchor, _| anchor[i] = tolerance()));
    assert!(!change(&|i, _, _, length| if i == 1 {
        *length = exactly("2")
    }));
    assert!(!change(&|i, _, anchor, _| if i == 1 {
        anchor[0] = exactly("1")
    }));
    assert!(!change(&|i, direction, _, _| if i == 2 {
        direction[0] = exactly("1/9")
    }));
    // Cyclic alone is not enough: the anchors turn one way.
    assert!(!change(&|i, _, anchor, _| anchor[(i + 1) % 3] = exactly("0.1")));
    let swapped = |claim: &mut MachineClaim| {
        let Mechanism::Translational(legs) = &mut claim.mechanism else { panic!("no legs") };
        legs.swap(0, 1);
    };
    let with = |change: &dyn Fn(&mut MachineClaim)| {
        let mut claim = orthoglide("-0.5", "0.5");
        change(&mut claim);
        is_symmetric(&claim)
    };
    assert!(!with(&swapped));
    let range = |leg: usize, max: &str| {
        let text =
            format!(r#"{{"quantity":"joint_range","leg":{leg},"end":"max","bound":"{max}"}}"#);
        serde_json::from_str(&text).unwrap()
    };
    let ranges = |all: [&str; 3]| {
        with(&|claim| claim.require.extend((1..4).map(|leg| range(leg, all[leg - 1]))))
    };
    assert!(ranges(["2", "2", "2"]));
    assert!(!ranges(["2", "2", "3"]));
    assert!(!with(&|claim| claim.require.push(range(2, "2"))));
    // Whose direction does not turn with the axes.
    let other = r#"{"quantity":"joint_force","given":{"tool":["1"]},"end":"max","bound":"2"}"#;
    assert!(!with(&|claim| claim.require.push(serde_json::from_str(other).unwrap())));
}

#[test]
fn ordered_volumes_add_up_and_agree_with_counting() {
    assert_eq!(six_ordered(&Cell::ROOT), 1 << SHARE_BITS);
    let mut state = 1u64;
    let mut random = move |n: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % n
    };
    for _ in 0..500 {
        let edges: [Edge; 3] = std::array::from_fn(|_| {
            let level = random(4) as u32;
            Edge(random(1 << level) + (1 << level))
        });
        let cell = Cell { edges, ..Cell::ROOT };
        // Count on the grid of level 3: of a cube on the diagonal a sixth is ordered, of one on a
        // plane a half.
        let mut count = 0;
        let range = |e: Edge| (e.index() << (3 - e.level()))..((e.index() + 1) << (3 - e.level()));
        for x in range(edges[0]) {
            for y in range(edges[1]) {
                for z in range(edges[2]) {
                    count += match (x.cmp(&y), y.cmp(&z)) {
                        (std::cmp::Ordering::Greater, _) | (_, std::cmp::Ordering::Greater) => 0,
                        (std::cmp::Ordering::Equal, std::cmp::Ordering::Equal) => 1,
                        (std::cmp::Ordering::Less, std::cmp::Ordering::Less) => 6,
                        _ => 3,
                    };
                }
            }
        }
        assert_eq!(six_ordered(&cell), count << (SHARE_BITS - 9), "{cell:?}");
        assert!(!is_mirrored(&cell) || count == 0, "{cell:?}");
        for axis in Axis::ALL {
            let (lower, upper) = cell.halves(axis).unwrap();
            assert_eq!(six_ordered(&lower) + six_ordered(&upper), six_ordered(&cell));
        }
    }
    // The deepest cells, far from the diagonal and on it.
    let deep = |index: u64| Edge(index + (1 << 40));
    let last = (1 << 40) - 1;
    let whole = Cell::ROOT.edges[0];
    assert_eq!(six_ordered(&Cell { edges: [deep(5); 3], ..Cell::ROOT }), 1);
    assert_eq!(six_ordered(&Cell { edges: [deep(0), deep(7), deep(last)], ..Cell::ROOT }), 6);
    assert_eq!(six_ordered(&Cell { edges: [deep(8), deep(7), deep(last)], ..Cell::ROOT }), 0);
    assert!(six_ordered(&Cell { edges: [whole, deep(last / 3), whole], ..Cell::ROOT }) > 0);
}

#[test]
fn headers_that_are_none_are_rejected() {
    let good = header(false);
    let (_, items) = paving(&good);
    let with = |change: fn(&mut Header)| {
        let mut header = good.clone();
        change(&mut header);
        let mut bytes = body(&header, &items);
        bytes.extend(b"{}\n");
        reason(&bytes)
    };
    for (found, expected) in [
        (with(|h| h.format = "orthocert-paving/2".into()), "is not known"),
        (with(|h| h.precision = 31), "is not within"),
        (with(|h| h.precision = 1025), "is not within"),
        (with(|h| h.depth = 121), "more than 120"),
        (with(|h| h.depth = 9), "split too often"),
        (with(|h| h.claim.machine = orthoglide("0.5", "0.5")), "positive volume"),
        (with(|h| h.claim.machine = orthoglide("0.5", "0")), "not well formed"),
        (with(|_| ()), "not the summary"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
    for text in ["", "\n", "{}\n", "[]\n", "null\n", "{\"format\":\"orthocert-paving/3\"}\n"] {
        assert!(matches!(checked(text.as_bytes()), Err(Rejected::Header(_))), "{text:?}");
    }
}

#[test]
fn a_sample_is_drawn_by_its_seed_and_finds_what_is_wrong() {
    let plain = header(false);
    let (bytes, mut items) = paving(&plain);
    let sampled = |bytes: &[u8], size, seed| check_sample(bytes, size, seed);
    let whole = checked(&bytes).unwrap();
    let few = sampled(&bytes, 10, 1).unwrap();
    assert_eq!((few.accepted.checked, &few.accepted.summary), (10, &whole.summary));
    assert_eq!(sampled(&bytes, u64::MAX, 1).unwrap().accepted.checked, whole.checked);
    // One wrong cell: found by the share of the seeds that the sample has of the cells.
    let wrong = items.iter().rposition(|i| matches!(i.kind, Kind::Outer(_))).unwrap();
    items[wrong].kind = Kind::Outer(Outer::Given(Failure::Reach.into()));
    let bytes = written(&plain, &items);
    assert!(checked(&bytes).is_err());
    let half = whole.checked / 2;
    let found = (0..20).filter(|seed| sampled(&bytes, half, *seed).is_err()).count();
    assert!((4..=16).contains(&found), "{found} of 20");
}

#[test]
fn every_subset_of_a_size_is_drawn() {
    let header = header(true);
    let bytes = paving(&header).0;
    let cells = checked(&bytes).unwrap().checked;
    for size in [1, 2, cells - 1, cells, cells + 1] {
        let accepted = check_sample(bytes.as_slice(), size, 3).unwrap();
        assert_eq!(accepted.accepted.checked, size.min(cells));
    }
}

#[test]
fn cells_that_are_not_drawn_claim_what_they_have_to() {
    let plain = header(false);
    let items = paving(&plain).1;
    let position = |wanted: fn(&Kind) -> bool| items.iter().position(|i| wanted(&i.kind)).unwrap();
    let inner = position(|kind| *kind == Kind::Inner);
    let outer = position(|kind| matches!(kind, Kind::Outer(_)));
    for (at, item, why) in [
        (inner, Item { steps: vec![Step(7, None)], kind: Kind::Inner }, "not certainly met"),
        (inner, bare(Kind::Mirrored), "left out by symmetry"),
        (outer, bare(Kind::Outer(Outer::Own(7))), "is not outer"),
    ] {
        let mut items = items.clone();
        items[at] = item;
        let bytes = written(&plain, &items);
        for seed in 0..20 {
            let sampled = check_sample(bytes.as_slice(), 1, seed);
            let reason = sampled.expect_err("rejected").to_string();
            assert!(reason.contains(why), "{reason}");
        }
    }
}

#[test]
fn nothing_hides_behind_the_last_line() {
    let header = header(true);
    let whole = written(&header, &paving(&header).1);
    checked(&whole).unwrap();
    let mut padded = whole[..whole.len() - 1].to_vec();
    padded.extend(b" \n");
    for file in [padded, [&whole[..], b"\n"].concat(), [&whole[..], b"{\"inner\":0}\n"].concat()] {
        assert!(reason(&file).contains("does not end the file"), "{}", reason(&file));
    }
}

#[test]
fn claims_that_have_no_region_are_refused() {
    let refused = |claim: MachineClaim| {
        let found = Subject::new(&header_of(claim, 3)).err().expect("refused");
        found.to_string()
    };
    let cylinder = r#"{"cylinder":{"center":["0","0"],"radius":"1","z":["0","1"]}}"#;
    let workspace: Workspace = serde_json::from_str(cylinder).unwrap();
    let round = MachineClaim { workspace, ..orthoglide("-0.5", "0.5") };
    assert!(refused(round).contains("not a box of positive volume"));
    let mut of_two_points = orthoglide("-0.5", "0.5");
    let one_to_one = r#"{"quantity":"one_to_one","end":"holds"}"#;
    of_two_points.require.push(serde_json::from_str(one_to_one).unwrap());
    assert!(refused(of_two_points).contains("two points"));
}

/// Of a turning strut's speed the own direction is one number: code 41 is that of obligation 1.
#[test]
fn a_joint_is_too_fast_in_its_own_direction() {
    let text = |bound: &str| {
        let claim = r#"{"format":"orthocert-paving/3","claim":{"machine":{"mechanism":{"planar":{"legs":[{"drive":"strut","anchor":["0","0"],"platform":["-1","0"]},{"drive":"strut","anchor":["10","0"],"platform":["1","0"]},{"drive":"strut","anchor":["5","10"],"platform":["0","1"]}],"characteristic_length":"1/2"}},"workspace":{"box":{"min":["4.9","3.9"],"max":["5.1","4.1"]}},"orientation":{"range":["-1","1"]},"require":[{"quantity":"joint_speed","leg":1,"given":{"tool":["1"]},"end":"max","bound":"BOUND"}]}},"coordinates":["x"],"precision":36,"depth":2,"provenance":{"tool":"hand","version":"1"}}"#;
        let sums = r#"{"splits":0,"inner":0,"outer":1,"boundary":0,"mirrored":0,"inner_share":"0","boundary_share":"0"}"#;
        format!("{}\nA{sums}\n", claim.replace("BOUND", bound))
    };
    checked(text("1/2").as_bytes()).expect("faster at every pose");
    checked(text("0.9").as_bytes()).expect("as the first part alone is");
    assert!(checked(text("3").as_bytes()).is_err());
}

/// A hundred thousand nodes of any bytes: read to an end, or refused, in no more memory than a path has.
#[test]
fn any_bytes_are_read_without_harm() {
    let header = header(false);
    let mut state = 7u64;
    for _ in 0..200 {
        let mut bytes = serde_json::to_vec(&header).unwrap();
        bytes.push(b'\n');
        for _ in 0..500 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            // Mostly splits, so that something is read.
            let byte = (state >> 40) as u8;
            bytes.push(if byte < 150 { byte % 5 } else { (state >> 33) as u8 });
        }
        assert!(checked(&bytes).is_err());
    }
}
