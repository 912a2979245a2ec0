//! Proofs of the postulate by faces: the smallest search that finds one, and what of it can be
//! spared. Nothing can.

use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{
    Certificate, FacePart, Faces, Node, Proof, Provenance, Step, Verdict, FORMAT,
};
use orthocert_checker::claim::{Claim, PostulateClaim, PsiMax, Quantity};
use orthocert_checker::number::Exact;
use orthocert_checker::postulate;
use orthocert_checker::rule::TightCorner;
use orthocert_checker::{check, parts_needed, PartNeeded, Rejected};

const PRECISION: u32 = 64;

/// Closes a cell by the first rule that holds, or splits it on the axes in turn.
fn prove(part: &PartNeeded, cell: &Cell, depth: usize, nodes: &mut Vec<Node>) {
    assert!(depth < 40, "no proof at {cell}");
    let (least, width) = part.range(PRECISION).expect("enclosed");
    let blow_up = postulate::on_face(&least, &width, part.half, part.face, cell);
    let edge = |corner| {
        let holds = postulate::edge(blow_up.as_ref()?, corner).is_ok();
        holds.then_some(Step::Edge(corner))
    };
    let inside = || postulate::blow_up(blow_up.as_ref()?).is_ok().then_some(Step::BlowUp);
    let step = postulate::mirror(cell).is_ok().then_some(Step::Mirror);
    let step = step.or_else(|| edge(TightCorner::Q1)).or_else(|| edge(TightCorner::Q2));
    let step = step.or_else(inside);
    if let Some(step) = step {
        nodes.push(Node { by: vec![step], split: None });
        return;
    }
    let axis = Axis::FACE[depth % 3];
    nodes.push(Node { by: vec![], split: Some(axis) });
    let (lower, upper) = cell.halves(axis).expect("not too deep");
    prove(part, &lower, depth + 1, nodes);
    prove(part, &upper, depth + 1, nodes);
}

fn claim(psi_max: PsiMax) -> PostulateClaim {
    PostulateClaim { psi_max }
}

fn range(min: i64, max: i64) -> PsiMax {
    let tenth = |n: i64| Exact::Rational(BigRational::new(BigInt::from(n), BigInt::from(10)));
    PsiMax::Range(Quantity { min: tenth(min), max: tenth(max) })
}

fn certificate(psi_max: PsiMax, parts: Vec<FacePart>) -> Certificate {
    Certificate {
        format: FORMAT.into(),
        claim: Claim::Postulate(claim(psi_max)),
        verdict: Verdict::Certified,
        proof: Proof::Faces(Faces { precision: PRECISION, parts }),
        provenance: Provenance { tool: "test".into(), version: "0".into() },
    }
}

fn parts(psi_max: &PsiMax) -> Vec<FacePart> {
    let needed = parts_needed(&claim(psi_max.clone())).expect("comparable");
    let part = |part: &PartNeeded| {
        let mut nodes = Vec::new();
        prove(part, &Cell::ROOT, 0, &mut nodes);
        FacePart { face: part.face, half: part.half, nodes }
    };
    needed.iter().map(part).collect()
}

#[test]
fn a_proof_by_faces_covers_every_kappa_up_to_one() {
    // Whatever the least psi_max is, kappa runs up to 1: "faces suffice" needs it.
    for (psi_max, count) in [(range(30, 40), 4), (range(20, 20), 2), (range(12, 15), 2)] {
        let needed = parts_needed(&claim(psi_max)).expect("comparable");
        assert_eq!(needed.len(), count);
        let one = Exact::integer(1);
        assert_eq!(needed.iter().filter(|part| part.greatest == one).count(), 2);
        for pair in needed.windows(2).filter(|pair| pair[0].face == pair[1].face) {
            assert_eq!(pair[0].greatest, pair[1].least);
        }
    }
}

#[test]
fn nothing_of_a_proof_for_every_psi_max_can_be_spared() {
    let whole = parts(&PsiMax::All);
    assert!(check(&certificate(PsiMax::All, whole.clone())).is_ok());
    for i in 0..4 {
        let mut without = whole.clone();
        without.remove(i);
        assert_eq!(check(&certificate(PsiMax::All, without)), Err(Rejected::Parts));
        let mut twice = whole.clone();
        twice[i] = whole[(i + 1) % 4].clone();
        assert_eq!(check(&certificate(PsiMax::All, twice)), Err(Rejected::Parts));
        // The nodes of another part under this part's name.
        let mut exchanged = whole.clone();
        exchanged[i].nodes.clone_from(&whole[(i + 2) % 4].nodes);
        assert!(check(&certificate(PsiMax::All, exchanged)).is_err(), "part {i}");
        // Every step counts, and so does every node.
        let leaves = (0..whole[i].nodes.len()).filter(|&n| !whole[i].nodes[n].by.is_empty());
        for n in leaves.step_by(7) {
            let mut open = whole.clone();
            open[i].nodes[n].by.clear();
            let result = check(&certificate(PsiMax::All, open));
            assert!(matches!(result, Err(Rejected::Open { .. })), "{result:?}");
            let mut missing = whole.clone();
            missing[i].nodes.remove(n);
            assert!(check(&certificate(PsiMax::All, missing)).is_err());
        }
        // Steps of other trees.
        for step in [Step::Cube, Step::Outside, Step::Upper, Step::SerialMargin] {
            let mut foreign = whole.clone();
            foreign[i].nodes[0].by.push(step);
            assert!(matches!(
                check(&certificate(PsiMax::All, foreign)),
                Err(Rejected::Step { .. })
            ));
        }
    }
    // A mirror alone proves nothing: its image has to be proved.
    for i in 0..4 {
        let mut mirrored = whole.clone();
        mirrored[i].nodes = vec![Node { by: vec![Step::Mirror], split: None }];
        assert!(check(&certificate(PsiMax::All, mirrored)).is_err());
    }
}

#[test]
fn a_range_of_psi_max_is_proved_by_its_own_parts() {
    let low = range(12, 15);
    let high = range(15, 35);
    let (low_parts, high_parts) = (parts(&low), parts(&high));
    assert!(check(&certificate(low.clone(), low_parts.clone())).is_ok());
    assert!(check(&certificate(high.clone(), high_parts.clone())).is_ok());
    assert_eq!(check(&certificate(high, low_parts)), Err(Rejected::Parts));
    assert_eq!(check(&certificate(low, high_parts)), Err(Rejected::Parts));
}
