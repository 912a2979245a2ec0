//! The postulate: what its rules and its certificates accept, and what they must reject.

use num_rational::BigRational;
use orthocert_checker::cell::{Axis, Cell, Edge};
use orthocert_checker::certificate::{
    Certificate, FacePart, Faces, Node, Proof, Provenance, Step, Tree, Verdict, FORMAT,
};
use orthocert_checker::claim::{Claim, PostulateClaim, PsiMax, Quantity};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::number::Exact;
use orthocert_checker::postulate::{
    blow_up, edge, mirror, on_cube, on_face, BlowUp, Face, Half, Part,
};
use orthocert_checker::rule::{Failure, TightCorner};
use orthocert_checker::{check, parts_needed, Rejected};

const BITS: u32 = 64;

fn number(text: &str) -> Exact {
    Exact::parse(text, 100).unwrap()
}

fn rational(numer: i64, denom: i64) -> Fixed {
    Fixed::rational(&BigRational::new(numer.into(), denom.into()), 0, BITS)
}

fn claim(psi_max: &str) -> PostulateClaim {
    let psi_max = match psi_max.split_once("..") {
        _ if psi_max == "all" => PsiMax::All,
        Some((min, max)) => PsiMax::Range(Quantity { min: number(min), max: number(max) }),
        None => PsiMax::Range(Quantity::exactly(number(psi_max))),
    };
    PostulateClaim { psi_max }
}

fn certificate(psi_max: &str, proof: Proof) -> Certificate {
    Certificate {
        format: FORMAT.into(),
        claim: Claim::Postulate(claim(psi_max)),
        verdict: Verdict::Certified,
        proof,
        provenance: Provenance { tool: "test".into(), version: "0".into() },
    }
}

/// The first rule that holds, splitting on the axis whose halves close most often: a plain search,
/// enough to make trees for these tests.
fn grow(
    rules: &dyn Fn(&Cell) -> Option<Step>,
    axes: [Axis; 3],
    cell: &Cell,
    nodes: &mut Vec<Node>,
) {
    if let Some(step) = rules(cell) {
        nodes.push(Node { by: vec![step], split: None });
        return;
    }
    let closing = |axis: &Axis| {
        let (a, b) = cell.halves(*axis).unwrap();
        let level: u32 = cell.edges[axis.index()].level;
        let closed = [a, b].iter().filter(|half| rules(half).is_some()).count();
        (closed, std::cmp::Reverse(level))
    };
    let axis = axes.into_iter().max_by_key(closing).unwrap();
    nodes.push(Node { by: Vec::new(), split: Some(axis) });
    let (lower, upper) = cell.halves(axis).unwrap();
    grow(rules, axes, &lower, nodes);
    grow(rules, axes, &upper, nodes);
}

fn first_rule(blow: &BlowUp<Fixed>) -> Option<Step> {
    if blow_up(blow).is_ok() {
        return Some(Step::BlowUp);
    }
    let corners = [TightCorner::Q1, TightCorner::Q2];
    corners.into_iter().find(|&c| edge(blow, c).is_ok()).map(Step::Edge)
}

/// A proof by faces for `psi_max`, made in exact arithmetic.
fn faces(psi_max: &str) -> Faces {
    let needed = parts_needed(&claim(psi_max)).unwrap();
    let parts = needed.iter().map(|part| {
        let (least, width) = part.range(BITS).unwrap();
        let rules = |cell: &Cell| {
            let blow = on_face(&least, &width, part.half, part.face, cell)?;
            mirror(cell).ok().map(|()| Step::Mirror).or_else(|| first_rule(&blow))
        };
        let mut nodes = Vec::new();
        grow(&rules, Axis::FACE, &Cell::ROOT, &mut nodes);
        FacePart { face: part.face, half: part.half, nodes }
    });
    Faces { precision: BITS, parts: parts.collect() }
}

/// A proof over one cube for a single `psi_max`.
fn one_cube(kappa: &Fixed, half: Half) -> Tree {
    let rules = |cell: &Cell| first_rule(&on_cube(kappa, half, cell)?);
    let mut nodes = Vec::new();
    grow(&rules, Axis::ALL, &Cell::ROOT, &mut nodes);
    nodes[0].by.insert(0, Step::Cube);
    Tree { precision: BITS, nodes }
}

#[test]
fn one_psi_a_range_and_all_are_accepted() {
    for psi_max in ["all", "6/5..13/2", "11/10..19/10", "2", "1000"] {
        let accepted = check(&certificate(psi_max, Proof::Faces(faces(psi_max)))).unwrap();
        assert_eq!(accepted.verdict, Verdict::Certified, "{psi_max}");
        assert!(accepted.size.leaves <= 120, "{psi_max}: {} leaves", accepted.size.leaves);
    }
    for (psi_max, kappa, half) in [
        ("2", (1, 2), Half::Low),
        ("7/3", (3, 7), Half::Low),
        ("137/100", (100, 137), Half::High),
        ("1000000000", (1, 1_000_000_000), Half::Low),
        ("1000000001/1000000000", (1_000_000_000, 1_000_000_001), Half::High),
    ] {
        let tree = one_cube(&rational(kappa.0, kappa.1), half);
        assert!(tree.nodes.len() <= 40, "{psi_max}");
        assert!(check(&certificate(psi_max, Proof::Tree(tree))).is_ok(), "{psi_max}");
    }
}

#[test]
fn a_proof_for_some_psi_is_not_one_for_more() {
    // Made for psi_max up to 2: kappa runs over [1/2, 1] only.
    let narrow = || Proof::Faces(faces("3/2..2"));
    assert!(check(&certificate("3/2..2", narrow())).is_ok());
    for wider in ["3/2..3", "all", "2..1000"] {
        let rejected = check(&certificate(wider, narrow())).unwrap_err();
        assert_eq!(rejected, Rejected::Parts, "{wider}");
    }
    // One cube's tree proves one psi_max: here the tree for 2 is not one for 1000, 3.. or all.
    let tree = one_cube(&rational(1, 2), Half::Low);
    for other in ["all", "2..3"] {
        let rejected = check(&certificate(other, Proof::Tree(tree.clone()))).unwrap_err();
        assert_eq!(rejected, Rejected::OneCubeOnly, "{other}");
    }
    let rejected = check(&certificate("1000", Proof::Tree(tree))).unwrap_err();
    assert!(matches!(rejected, Rejected::Step { .. }), "{rejected}");
}

#[test]
fn missing_exchanged_or_doubled_parts_are_rejected() {
    let whole = faces("all");
    assert_eq!(whole.parts.len(), 4);
    for missing in 0..4 {
        let mut faces = whole.clone();
        faces.parts.remove(missing);
        let rejected = check(&certificate("all", Proof::Faces(faces))).unwrap_err();
        assert_eq!(rejected, Rejected::Parts, "without part {missing}");
    }
    let mut exchanged = whole.clone();
    exchanged.parts.swap(0, 1);
    assert_eq!(check(&certificate("all", Proof::Faces(exchanged))), Err(Rejected::Parts));
    let mut doubled = whole.clone();
    doubled.parts[1] = doubled.parts[0].clone();
    assert_eq!(check(&certificate("all", Proof::Faces(doubled))), Err(Rejected::Parts));
    // The right names on the wrong trees: a face's tree does not close the other face.
    let mut renamed = whole.clone();
    renamed.parts[0].nodes = whole.parts[2].nodes.clone();
    renamed.parts[2].nodes = whole.parts[0].nodes.clone();
    assert!(check(&certificate("all", Proof::Faces(renamed))).is_err());
}

#[test]
fn every_leaf_is_needed_and_every_step_in_its_place() {
    let whole = faces("all");
    for (p, part) in whole.parts.iter().enumerate() {
        for (n, node) in part.nodes.iter().enumerate() {
            let mut open = whole.clone();
            open.parts[p].nodes[n].by.clear();
            if node.split.is_none() {
                let rejected = check(&certificate("all", Proof::Faces(open))).unwrap_err();
                assert!(
                    matches!(rejected, Rejected::Open { .. }),
                    "part {p}, node {n}: {rejected}"
                );
            }
        }
        let mut short = whole.clone();
        short.parts[p].nodes.pop();
        let rejected = check(&certificate("all", Proof::Faces(short))).unwrap_err();
        assert_eq!(rejected, Rejected::MissingNode);
        let mut long = whole.clone();
        long.parts[p].nodes.push(Node { by: vec![Step::Mirror], split: None });
        let rejected = check(&certificate("all", Proof::Faces(long))).unwrap_err();
        assert_eq!(rejected, Rejected::TrailingNodes(1));
    }
}

#[test]
fn steps_of_other_trees_are_rejected() {
    let alone = |step: Step| Node { by: vec![Step::Cube, step], split: None };
    for step in
        [Step::Mirror, Step::Upper, Step::Range, Step::Outside, Step::Corner(TightCorner::Q1)]
    {
        let tree = Tree { precision: BITS, nodes: vec![alone(step)] };
        let rejected = check(&certificate("2", Proof::Tree(tree))).unwrap_err();
        let other_kind = matches!(
            rejected,
            Rejected::Step { failure: Failure::OtherKind | Failure::Repeated, .. }
        );
        assert!(other_kind, "{rejected}");
    }
    // x is no axis of a face's tree, kappa none of a cube's.
    let mut faces = faces("all");
    faces.parts[0].nodes[0].split = Some(Axis::X);
    assert_eq!(check(&certificate("all", Proof::Faces(faces))), Err(Rejected::NoSuchAxis(0)));
    let split = Node { by: vec![Step::Cube], split: Some(Axis::Kappa) };
    let tree = Tree { precision: BITS, nodes: vec![split] };
    assert_eq!(check(&certificate("2", Proof::Tree(tree))), Err(Rejected::NoSuchAxis(0)));
}

#[test]
fn the_tight_edge_holds_at_its_corner_only() {
    let part = |index, level| Part::Edge(Edge { index, level });
    let at = |kappa: &Fixed, half, parts| BlowUp::new(kappa, half, TightCorner::Q2, parts).unwrap();
    let third = rational(1, 3);
    let near = at(&third, Half::Low, [Part::AtQ2, part(15, 4), part(15, 4)]);
    assert_eq!(edge(&near, TightCorner::Q2), Ok(()));
    for parts in [
        [Part::AtQ2, part(14, 4), part(15, 4)],
        [Part::AtQ2, part(15, 4), part(0, 4)],
        [Part::AtQ1, part(15, 4), part(15, 4)],
    ] {
        let away = at(&third, Half::Low, parts);
        assert_eq!(edge(&away, TightCorner::Q2), Err(Failure::NotAtCorner));
    }
    assert_eq!(edge(&near, TightCorner::Q1), Err(Failure::NotAtCorner));
}

#[test]
fn the_tight_edge_is_rejected_where_f_at_the_corner_is_not_semidefinite() {
    // With the formula of kappa >= 1/2, F(Q2) has the eigenvalue 4 kappa - 2, negative below 1/2.
    let part = |index, level| Part::Edge(Edge { index, level });
    let parts = [Part::AtQ2, part(15, 4), part(15, 4)];
    let corner = |kappa: &Fixed| {
        let blow = BlowUp::new(kappa, Half::High, TightCorner::Q2, parts).unwrap();
        edge(&blow, TightCorner::Q2)
    };
    assert_eq!(corner(&rational(1, 2)), Ok(()));
    assert_eq!(corner(&rational(3, 4)), Ok(()));
    assert_eq!(corner(&rational(49, 100)), Err(Failure::NotDefinite { vertex: 0 }));
    let crossing = rational(49, 100).hull(&rational(51, 100));
    assert_eq!(corner(&crossing), Err(Failure::NotDefinite { vertex: 0 }));
}

#[test]
fn mirror_needs_the_whole_cell_on_one_side() {
    let cell = |y: (u128, u32), z: (u128, u32)| Cell {
        edges: [(0, 0), y, z].map(|(index, level)| Edge { index, level }),
    };
    assert_eq!(mirror(&cell((1, 1), (0, 1))), Ok(()));
    assert_eq!(mirror(&cell((3, 2), (0, 1))), Ok(()));
    for (y, z) in [((0, 1), (1, 1)), ((0, 1), (0, 1)), ((1, 1), (1, 1)), ((0, 0), (0, 1))] {
        assert_eq!(mirror(&cell(y, z)), Err(Failure::NotMirrored), "{y:?} {z:?}");
    }
}

#[test]
fn claims_without_an_admissible_psi_are_rejected() {
    let proof = || Proof::Faces(faces("2"));
    for psi_max in ["1", "1/2", "-3", "3..2", "1..2", "0..2"] {
        let rejected = check(&certificate(psi_max, proof())).unwrap_err();
        assert!(matches!(rejected, Rejected::Claim(_)), "{psi_max}: {rejected}");
    }
}

#[test]
fn blow_up_agrees_with_the_matrix_itself() {
    // F = (2/tau) (I + sym(N)), sym(M) - kappa I = delta (I + sym(N)): compare entries at centres
    // for many kappa and cells with an evaluation of M in doubles.
    for k in 1..40i64 {
        let kappa = k as f64 / 40.0;
        let half = if 2 * k <= 40 { Half::Low } else { Half::High };
        let exact = rational(k, 40);
        let delta = 1.0 - kappa;
        let t2 = if kappa <= 0.5 { delta } else { (1.0 / kappa - 1.0) / 2.0 };
        let t1 = delta / 2.0;
        let (q1, q2) = (-t1 / (1.0 + 2.0 * t1 * t1).sqrt(), t2 / (1.0 + 2.0 * t2 * t2).sqrt());
        for (i, j, l) in [(0, 3, 5), (7, 7, 7), (2, 0, 6), (4, 1, 3)] {
            let cell = Cell { edges: [i, j, l].map(|index| Edge { index, level: 3 }) };
            let expansion = on_cube(&exact, half, &cell).unwrap().expand(None).unwrap();
            let p = [i, j, l].map(|n| q1 + (q2 - q1) * (n as f64 + 0.5) / 8.0);
            let s = |a: usize, b: usize| (1.0 - p[a] * p[a] - p[b] * p[b]).sqrt();
            let (s1, s2, s3) = (s(1, 2), s(0, 2), s(0, 1));
            let sums = [p[1] / s1 + p[0] / s2, p[2] / s1 + p[0] / s3, p[2] / s2 + p[1] / s3];
            for (found, sum) in expansion.off.iter().zip(sums) {
                let expected = sum / t2;
                let scale = (BITS as f64).exp2();
                let lo: f64 = found.lo().to_string().parse::<f64>().unwrap() / scale;
                let hi: f64 = found.hi().to_string().parse::<f64>().unwrap() / scale;
                assert!(lo - 1e-9 <= expected && expected <= hi + 1e-9, "{k} {cell}");
                assert!(hi - lo < 1e-9);
            }
        }
    }
}

#[test]
fn face_names_are_those_of_the_format() {
    let text = serde_json::to_string(&(Face::Q1, Face::Q2, Half::Low, Half::High)).unwrap();
    assert_eq!(text, r#"["q1","q2","low","high"]"#);
}
