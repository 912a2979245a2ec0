//! Pavings: what is accepted, what is rejected and why, and the volumes that are counted.

use orthocert_checker::cell::{Axis, Cell, Edge};
use orthocert_checker::certificate::{Direction, LegNumber, Provenance, Step, Violation};
use orthocert_checker::claim::{
    Claim, Leg, MachineClaim, Mechanism, Quantity, Range, Requirements, Sign, Workspace,
};
use orthocert_checker::number::Exact;
use orthocert_checker::paving::{
    check, is_mirrored, is_paving, is_symmetric, six_ordered, Extent, Header, Item, Judge, Kind,
    Reader, Rejected, Symmetry, FORMAT, MAX_LINE, SHARE_BITS,
};
use orthocert_checker::rule::Rotation;

fn exact(text: &str) -> Exact {
    Exact::parse(text, 1000).unwrap()
}

/// The Orthoglide with `L = 1` and `1/2 <= psi <= 2` over `[low, high]^3`.
fn orthoglide(low: &str, high: &str) -> MachineClaim {
    let unit =
        |i: usize| std::array::from_fn(|k| Quantity::exactly(Exact::integer(i64::from(i == k))));
    let zero = || std::array::from_fn(|_| Quantity::exactly(Exact::integer(0)));
    let leg = |i| Leg::Slider {
        direction: unit(i),
        anchor: zero(),
        platform: zero(),
        length: Quantity::exactly(Exact::integer(1)),
        mode: Sign::Plus,
    };
    let range = Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    MachineClaim {
        mechanism: Mechanism::Translational([leg(0), leg(1), leg(2)]),
        workspace: Workspace::Box {
            min: [(); 3].map(|()| exact(low)),
            max: [(); 3].map(|()| exact(high)),
        },
        requirements: Requirements { transmission: Some(range), ..Requirements::default() },
    }
}

fn header(symmetric: bool) -> Header {
    Header {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(orthoglide("-7/10", "7/10")),
        precision: 36,
        depth: 10,
        symmetry: symmetric.then_some(Symmetry::Permutations),
        provenance: Provenance { tool: "test".into(), version: "1".into() },
    }
}

/// What becomes of a cell, by trying a few pieces of evidence.
fn item(judge: &Judge, symmetric: bool, cell: &Cell, depth: u32, limit: u32) -> Item {
    let bare = |kind| Item { steps: Vec::new(), kind };
    if symmetric && is_mirrored(cell) {
        return bare(Kind::Mirrored);
    }
    let steps = vec![Step::Lower(Rotation::IDENTITY), Step::Upper];
    if judge.steps(cell, &steps).is_ok() {
        return Item { steps, kind: Kind::Inner };
    }
    let directions = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1], [1, -1, 0], [0, 1, -1]];
    let direction = |vector| Direction { vector };
    let violations = directions
        .iter()
        .flat_map(|&v| [Violation::SigmaMin(direction(v)), Violation::SigmaMax(direction(v))])
        .chain([1, 2, 3].map(|leg| Violation::Row(LegNumber { leg })));
    for violation in violations {
        if judge.violation(cell, &violation).is_ok() {
            return bare(Kind::Outer(violation));
        }
    }
    if depth == limit {
        return bare(Kind::Boundary);
    }
    let axis = *Axis::ALL.iter().min_by_key(|axis| cell.edges[axis.index()].level).unwrap();
    bare(Kind::Split(axis))
}

/// A paving of few cells, and its items.
fn paving(header: &Header) -> (Vec<u8>, Vec<Item>) {
    let judge = Judge::new(header).unwrap();
    let (mut items, mut waiting) = (Vec::new(), vec![(Cell::ROOT, 0)]);
    while let Some((cell, depth)) = waiting.pop() {
        let item = item(&judge, header.symmetry.is_some(), &cell, depth, header.depth);
        if let Kind::Split(axis) = item.kind {
            let (lower, upper) = cell.halves(axis).unwrap();
            waiting.extend([(upper, depth + 1), (lower, depth + 1)]);
        }
        items.push(item);
    }
    (written(header, &items), items)
}

fn body(header: &Header, items: &[Item]) -> Vec<u8> {
    let mut bytes = serde_json::to_vec(header).unwrap();
    bytes.push(b'\n');
    for item in items {
        item.write(&mut bytes).unwrap();
    }
    bytes
}

/// The bytes of a paving with the summary that its tree has.
fn written(header: &Header, items: &[Item]) -> Vec<u8> {
    let mut bytes = body(header, items);
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while let Ok(Some(_)) = reader.next() {}
    let summary = serde_json::to_vec(&reader.summary()).unwrap();
    bytes.extend(summary);
    bytes.push(b'\n');
    bytes
}

fn checked(bytes: &[u8]) -> Result<orthocert_checker::paving::Accepted, Rejected> {
    check(bytes, Extent::All)
}

/// The reason for which these bytes are rejected.
fn reason(bytes: &[u8]) -> String {
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
    let ends = |a: &orthocert_checker::paving::Accepted| {
        (a.shares.inner, a.shares.inner + a.shares.boundary)
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
                    assert_eq!(
                        (found.summary, found.shares),
                        (whole.summary.clone(), whole.shares)
                    );
                    kept += 1;
                }
            }
        }
    }
    // Directions leave room; nothing else does.
    assert!(rejected > 100 && kept < rejected / 2, "{rejected} {kept}");
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
    let bare = |kind| Item { steps: Vec::new(), kind };
    let inner = first(|k| matches!(k, Kind::Inner));
    let outer = first(|k| matches!(k, Kind::Outer(_)));
    let boundary = first(|k| matches!(k, Kind::Boundary));
    let sigma_min = |vector| Kind::Outer(Violation::SigmaMin(Direction { vector }));
    let (lower, upper) = (Step::Lower(Rotation::IDENTITY), Step::Upper);
    let turned = Step::Lower(Rotation { q: [1, 0, 0, 1], ..Rotation::IDENTITY });
    let both = |kind| Item { steps: vec![lower.clone(), upper.clone()], kind };
    for (row, at, item, expected) in [
        ("outer without truth", inner, bare(sigma_min([1, 1, 1])), "is not outer"),
        ("outer by the zero vector", outer, bare(sigma_min([0; 3])), "the vector is zero"),
        ("inner without steps", inner, bare(Kind::Inner), "sigma_min is not discharged"),
        ("undecided as inner", boundary, bare(Kind::Inner), "sigma_min is not discharged"),
        ("undecided as inner, with steps", boundary, both(Kind::Inner), "does not apply"),
        ("undecided as outer", boundary, bare(sigma_min([1, 1, 1])), "is not outer"),
        ("outer as inner", outer, both(Kind::Inner), "does not apply"),
        ("mirrored without symmetry", inner, bare(Kind::Mirrored), "left out by symmetry"),
        ("steps of a boundary cell", boundary, both(Kind::Boundary), "neither split nor inner"),
        (
            "half of the steps",
            inner,
            Item { steps: vec![lower.clone()], kind: Kind::Inner },
            "sigma_max is not discharged",
        ),
        (
            "a step twice",
            inner,
            Item { steps: vec![lower.clone(), lower.clone()], kind: Kind::Inner },
            "already discharged",
        ),
        (
            "another rotation",
            inner,
            Item { steps: vec![turned, upper.clone()], kind: Kind::Inner },
            "does not apply",
        ),
        (
            "a leg that is none",
            outer,
            bare(Kind::Outer(Violation::JointRange(LegNumber { leg: 1 }))),
            "no such requirement",
        ),
        ("split without halves", boundary, bare(Kind::Split(Axis::X)), "split too often"),
    ] {
        let found = with(at, item);
        assert!(found.contains(expected), "{row}: {found}");
    }
    // A step on an ancestor has to hold on all of it.
    let mut early = items.clone();
    early[0].steps = vec![Step::Upper];
    assert!(reason(&written(&plain, &early)).contains("does not apply"));
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
    let mut claim = orthoglide("-7/10", "7/10");
    let Workspace::Box { max, .. } = &mut claim.workspace else { panic!("not a box") };
    max[2] = exact("8/10");
    header.claim = Claim::Machine(claim);
    assert!(reason(&written(&header, &items)).contains("in every permutation"));
}

#[test]
fn machines_that_look_different_from_permuted_axes_are_refused() {
    assert!(is_symmetric(&orthoglide("-1/2", "1/2")));
    let change = |change: fn(&mut MachineClaim)| {
        let mut claim = orthoglide("-1/2", "1/2");
        change(&mut claim);
        is_symmetric(&claim)
    };
    fn legs(claim: &mut MachineClaim) -> &mut [Leg; 3] {
        match &mut claim.mechanism {
            Mechanism::Translational(legs) => legs,
            Mechanism::Orthoglide { .. } => panic!("no legs"),
        }
    }
    let ranges = |x: [&str; 3]| Some(x.map(|max| Range { min: None, max: Some(exact(max)) }));
    assert!(change(|c| legs(c).iter_mut().enumerate().for_each(|(i, leg)| {
        let Leg::Slider { anchor, .. } = leg else { panic!("not a slider") };
        anchor[i] = Quantity { min: exact("1/10"), max: exact("2/10") };
    })));
    assert!(!change(|c| *legs(c)[1].parameters_mut()[9] = Quantity::exactly(exact("2"))));
    assert!(!change(|c| *legs(c)[1].parameters_mut()[3] = Quantity::exactly(exact("1"))));
    assert!(!change(|c| legs(c).swap(0, 1)));
    assert!(!change(|c| *legs(c)[2].parameters_mut()[0] = Quantity::exactly(exact("1/9"))));
    // Cyclic alone is not enough: the anchors turn one way.
    assert!(!change(|c| legs(c).iter_mut().enumerate().for_each(|(i, leg)| {
        let Leg::Slider { anchor, .. } = leg else { panic!("not a slider") };
        anchor[(i + 1) % 3] = Quantity::exactly(exact("1/10"));
    })));
    let mut claim = orthoglide("-1/2", "1/2");
    claim.requirements.joint_range = ranges(["2", "2", "2"]);
    assert!(is_symmetric(&claim));
    claim.requirements.joint_range = ranges(["2", "2", "3"]);
    assert!(!is_symmetric(&claim));
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
            Edge { index: random(1 << level).into(), level }
        });
        let cell = Cell { edges };
        // Count on the grid of level 3: of a cube on the diagonal a sixth is ordered, of one on a
        // plane a half.
        let mut count = 0;
        let range = |e: Edge| (e.index << (3 - e.level))..((e.index + 1) << (3 - e.level));
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
        assert_eq!(six_ordered(&cell), count << (SHARE_BITS - 9), "{cell}");
        assert!(!is_mirrored(&cell) || count == 0, "{cell}");
        for axis in Axis::ALL {
            let (lower, upper) = cell.halves(axis).unwrap();
            assert_eq!(six_ordered(&lower) + six_ordered(&upper), six_ordered(&cell));
        }
    }
    // The deepest cells, far from the diagonal and on it.
    let deep = |index: u128| Edge { index, level: 40 };
    let last = (1 << 40) - 1;
    let whole = Edge { index: 0, level: 0 };
    assert_eq!(six_ordered(&Cell { edges: [deep(5); 3] }), 1);
    assert_eq!(six_ordered(&Cell { edges: [deep(0), deep(7), deep(last)] }), 6);
    assert_eq!(six_ordered(&Cell { edges: [deep(8), deep(7), deep(last)] }), 0);
    assert!(six_ordered(&Cell { edges: [whole, deep(last / 3), whole] }) > 0);
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
        (with(|h| h.format = "orthocert-paving/3".into()), "is not known"),
        (with(|h| h.precision = 31), "is not within"),
        (with(|h| h.precision = 1025), "is not within"),
        (with(|h| h.depth = 121), "more than 120"),
        (with(|h| h.depth = 9), "split too often"),
        (with(|h| h.claim = Claim::Machine(orthoglide("1/2", "1/2"))), "positive volume"),
        (with(|h| h.claim = Claim::Machine(orthoglide("1/2", "0"))), "not well formed"),
        (with(|_| ()), "not the summary"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
    for text in ["", "\n", "{}\n", "[]\n", "null\n", "{\"format\":\"orthocert-paving/2\"}\n"] {
        assert!(matches!(checked(text.as_bytes()), Err(Rejected::Header(_))), "{text:?}");
    }
}

#[test]
fn a_sample_is_drawn_by_its_seed_and_finds_what_is_wrong() {
    let plain = header(false);
    let (bytes, mut items) = paving(&plain);
    let sampled = |bytes: &[u8], size, seed| check(bytes, Extent::Sample { size, seed });
    let whole = checked(&bytes).unwrap();
    let few = sampled(&bytes, 10, 1).unwrap();
    assert_eq!((few.checked, &few.summary), (10, &whole.summary));
    assert_eq!(sampled(&bytes, u64::MAX, 1).unwrap().checked, whole.checked);
    // One wrong cell: found by the share of the seeds that the sample has of the cells.
    let wrong = items.iter().rposition(|i| matches!(i.kind, Kind::Outer(_))).unwrap();
    items[wrong].kind = Kind::Outer(Violation::Reach(LegNumber { leg: 1 }));
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
        let accepted = check(bytes.as_slice(), Extent::Sample { size, seed: 3 }).unwrap();
        assert_eq!(accepted.checked, size.min(cells));
    }
}

#[test]
fn cells_that_are_not_drawn_claim_what_they_have_to() {
    let plain = header(false);
    let items = paving(&plain).1;
    let position = |wanted: fn(&Kind) -> bool| items.iter().position(|i| wanted(&i.kind)).unwrap();
    let inner = position(|kind| *kind == Kind::Inner);
    let outer = position(|kind| matches!(kind, Kind::Outer(_)));
    let with = |at: usize, steps: &[Step], kind: Kind| {
        let mut items = items.clone();
        items[at] = Item { steps: steps.to_vec(), kind };
        written(&plain, &items)
    };
    let (lower, upper) = (Step::Lower(Rotation::IDENTITY), Step::Upper);
    let leg = LegNumber { leg: 1 };
    for (bytes, why) in [
        (with(inner, &[], Kind::Inner), "is not discharged"),
        (with(inner, std::slice::from_ref(&lower), Kind::Inner), "is not discharged"),
        (with(inner, &[lower, upper, Step::Range], Kind::Inner), "\"range\" does not apply"),
        (with(outer, &[], Kind::Inner), "is not discharged"),
        (with(outer, &[], Kind::Outer(Violation::JointRange(leg))), "is not outer"),
        (with(outer, &[], Kind::Outer(Violation::ParallelMargin)), "is not outer"),
    ] {
        for seed in 0..20 {
            let sampled = check(bytes.as_slice(), Extent::Sample { size: 1, seed });
            let reason = sampled.expect_err("rejected").to_string();
            assert!(reason.contains(why), "{reason}");
        }
    }
}

#[test]
fn nothing_hides_behind_a_line_of_the_greatest_length() {
    let header = header(true);
    let whole = written(&header, &paving(&header).1);
    // The last line as long as a line may be, by blanks.
    let start = whole.windows(9).rposition(|part| part == b"{\"splits\"").unwrap();
    let mut padded = whole[..whole.len() - 1].to_vec();
    padded.resize(start + MAX_LINE - 1, b' ');
    padded.push(b'\n');
    checked(&padded).unwrap();
    for behind in [&b"\n"[..], b" ", b"\n{\"inner\":0}\n"] {
        for file in [&whole, &padded] {
            let longer = [&file[..], behind].concat();
            assert!(reason(&longer).contains("does not end the file"), "{}", reason(&longer));
        }
    }
}
