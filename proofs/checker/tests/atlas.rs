//! Atlases: what is derived of a cell, and what is rejected.

use num_rational::BigRational;
use orthocert_checker::atlas::{instance, range, AtlasError, Ends, Side};
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::{Atlas, AtlasCell, Certificate, Node, Proof, Tree, Verdict};
use orthocert_checker::claim::{
    AtlasClaim, Claim, ClaimError, Leg, Mechanism, Quantity, Workspace,
};
use orthocert_checker::number::Exact;
use orthocert_checker::witness::WitnessError;
use orthocert_checker::{check, check_part, read, statement, Rejected};
use std::num::NonZeroUsize;

/// Orthoglides, parameters `psi_max` and `side`, resolution `2^-3`.
const ATLAS: &[u8] = include_bytes!("../../certificates/orthoglide-atlas.cert.json");

fn number(text: &str) -> Exact {
    Exact::parse_open(text, 100).unwrap()
}

fn good() -> Certificate {
    read(ATLAS).unwrap()
}

fn parts(certificate: &mut Certificate) -> (&mut AtlasClaim, &mut Vec<AtlasCell>) {
    match (&mut certificate.claim, &mut certificate.proof) {
        (Claim::Atlas(claim), Proof::Atlas(Atlas { cells })) => (claim, cells),
        _ => panic!("not an atlas"),
    }
}

/// Why the atlas is rejected after an edit.
fn rejected(edit: impl FnOnce(&mut AtlasClaim, &mut Vec<AtlasCell>)) -> Rejected {
    let mut certificate = good();
    let (claim, cells) = parts(&mut certificate);
    edit(claim, cells);
    check(&certificate).expect_err("accepted")
}

/// The reason that is given for a cell.
fn of_a_cell(reason: Rejected) -> Rejected {
    match reason {
        Rejected::Cell { reason, .. } => *reason,
        other => panic!("{other}"),
    }
}

fn find(cells: &[AtlasCell], wanted: fn(&AtlasCell) -> bool) -> usize {
    cells.iter().position(wanted).unwrap()
}

fn is_certified(cell: &AtlasCell) -> bool {
    matches!(cell, AtlasCell::Certified(_))
}

fn is_refuted(cell: &AtlasCell) -> bool {
    matches!(cell, AtlasCell::Refuted(_))
}

#[test]
fn the_committed_atlas_is_accepted_and_told_in_words() {
    let certificate = good();
    assert_eq!(check(&certificate).unwrap().verdict, Verdict::Certified);
    let words = statement::statement(&certificate.claim, certificate.verdict).unwrap();
    for part in ["6/5 <= psi_max <= 4", "1/psi_max <= psi_i(P) <= psi_max", "certified", "refuted"]
    {
        assert!(words.contains(part), "{words}");
    }
}

#[test]
fn the_parts_of_a_check_are_the_whole() {
    let whole = check(&good()).unwrap().size;
    for of in [1, 2, 7, 1000].map(|of| NonZeroUsize::new(of).unwrap()) {
        let part = |part| check_part(&good(), part, of).unwrap().nodes;
        assert_eq!((0..of.get()).map(part).sum::<usize>(), whole.nodes, "{of}");
    }
    // Whatever cell is wrong, one of the parts rejects it; what is of no cell, all of them.
    let of = NonZeroUsize::new(3).unwrap();
    let rejecting = |certificate: &Certificate| {
        (0..3).filter(|part| check_part(certificate, *part, of).is_err()).collect::<Vec<_>>()
    };
    let mut wrong = good();
    for number in 0..parts(&mut wrong).1.len() {
        let mut wrong = good();
        if let AtlasCell::Certified(tree) = &mut parts(&mut wrong).1[number] {
            tree.nodes = vec![Node::default()];
            assert_eq!(rejecting(&wrong), [number % 3]);
        }
    }
    parts(&mut wrong).0.refuted = number("1/2");
    assert_eq!(rejecting(&wrong), [0, 1, 2]);
}

#[test]
fn shares_are_the_sums_of_the_cells() {
    let more = |x: &mut Exact| *x = x.clone().plus(number("1/1048576")).unwrap();
    assert_eq!(rejected(|claim, _| more(&mut claim.certified)), Rejected::Shares);
    assert_eq!(rejected(|claim, _| more(&mut claim.refuted)), Rejected::Shares);
    let undecide = |_: &mut AtlasClaim, cells: &mut Vec<AtlasCell>| {
        let at = find(cells, is_certified);
        cells[at] = AtlasCell::Undecided;
    };
    assert_eq!(rejected(undecide), Rejected::Shares);
}

#[test]
fn the_cells_are_one_tree_over_the_parameters() {
    assert_eq!(rejected(|_, cells| drop(cells.pop())), Rejected::MissingNode);
    assert_eq!(rejected(|_, cells| cells.clear()), Rejected::MissingNode);
    assert_eq!(rejected(|_, cells| cells.push(AtlasCell::Undecided)), Rejected::TrailingNodes(1));
    for axis in [0, 3, usize::MAX] {
        let reason = rejected(|_, cells| cells[0] = AtlasCell::Split(axis));
        assert_eq!(reason, Rejected::NoSuchAxis(0));
    }
    let endless = |_: &mut AtlasClaim, cells: &mut Vec<AtlasCell>| {
        *cells = vec![AtlasCell::Split(1); 200];
    };
    assert!(matches!(rejected(endless), Rejected::TooDeep(_)));
}

#[test]
fn what_is_said_of_a_cell_is_proved_of_that_cell() {
    // A proof where another cell's should be, in both directions.
    let moved = rejected(|_, cells| {
        let (good, bad) = (find(cells, is_certified), find(cells, is_refuted));
        cells[bad] = cells[good].clone();
    });
    assert!(matches!(of_a_cell(moved), Rejected::Step { .. } | Rejected::Open { .. }));
    let moved = rejected(|_, cells| {
        let (good, bad) = (find(cells, is_certified), find(cells, is_refuted));
        cells[good] = cells[bad].clone();
    });
    assert!(matches!(of_a_cell(moved), Rejected::Witness(_)));
    let bare = rejected(|_, cells| {
        let at = find(cells, is_certified);
        cells[at] = AtlasCell::Certified(Tree { precision: 64, nodes: vec![Node::default()] });
    });
    assert!(matches!(of_a_cell(bare), Rejected::Open { .. }));
    let imprecise = rejected(|_, cells| {
        let at = find(cells, is_certified);
        cells[at] = AtlasCell::Certified(Tree { precision: 4, nodes: vec![Node::default()] });
    });
    assert_eq!(of_a_cell(imprecise), Rejected::Precision(4));
}

#[test]
fn a_wider_box_needs_other_proofs() {
    // The same cells of a box that reaches to smaller psi_max, or to larger cubes.
    let wider = rejected(|claim, _| claim.parameters[0].min = number("1"));
    assert!(matches!(
        of_a_cell(wider),
        Rejected::Step { .. } | Rejected::AtlasClaim(_) | Rejected::Claim(_)
    ));
    let wider = rejected(|claim, _| claim.parameters[1].max = number("3/2"));
    assert!(matches!(of_a_cell(wider), Rejected::Step { .. }));
    // And refutations those of a box with smaller cubes.
    let wider = rejected(|claim, cells| {
        claim.parameters[1].min = number("1/1000");
        cells.iter_mut().filter(|c| is_certified(c)).for_each(|c| *c = AtlasCell::Undecided);
    });
    assert!(matches!(of_a_cell(wider), Rejected::Witness(_)));
}

#[test]
fn a_witness_serves_every_design_of_its_cell() {
    let edited = |edit: fn(&mut orthocert_checker::certificate::Witness)| {
        of_a_cell(rejected(|_, cells| {
            let at = find(cells, is_refuted);
            if let AtlasCell::Refuted(witness) = &mut cells[at] {
                edit(witness);
            }
        }))
    };
    // A point that only the larger workspaces of the cell have.
    let outside = edited(|witness| witness.point = [number("9/10"), number("0"), number("0")]);
    assert_eq!(outside, Rejected::Witness(WitnessError::OutsideWorkspace));
    let harmless = edited(|witness| witness.point = [number("0"), number("0"), number("0")]);
    assert_eq!(harmless, Rejected::Witness(WitnessError::NotViolated));
    let open = edited(|witness| witness.point = [number("side"), number("0"), number("0")]);
    assert_eq!(open, Rejected::Witness(WitnessError::OutsideWorkspace));
    // One machine of the cell is not all of them.
    let single = edited(|witness| {
        let mut certificate = good();
        let (claim, _) = parts(&mut certificate);
        if let Mechanism::Translational(legs) = &claim.design.mechanism {
            witness.machine = Some(legs.clone());
        }
    });
    assert_eq!(single, Rejected::Witness(WitnessError::MachineMismatch));
}

#[test]
fn claims_that_are_not_well_formed_are_rejected() {
    use AtlasError::{BadName, BadRange, Count, Cube, Unknown, Unused};
    let claim = |edit: fn(&mut AtlasClaim)| match rejected(|claim, _| edit(claim)) {
        Rejected::AtlasClaim(error) => error,
        other => panic!("{other}"),
    };
    assert_eq!(claim(|c| c.parameters.clear()), Count(0));
    assert_eq!(claim(|c| drop(c.parameters.pop())), Unknown("side".into()));
    for name in ["sqrt", "Side", "2", "side/2", "", "a b", "psi_max"] {
        let mut certificate = good();
        parts(&mut certificate).0.parameters[1].name = name.into();
        let bad = Rejected::AtlasClaim(BadName(name.into()));
        assert_eq!(check(&certificate), Err(bad));
    }
    assert_eq!(claim(|c| c.parameters[1].min = number("1")), BadRange("side".into()));
    assert_eq!(claim(|c| c.parameters[1].max = number("sqrt(2)")), BadRange("side".into()));
    assert_eq!(claim(|c| c.parameters[1].max = number("psi_max")), BadRange("side".into()));
    let unused = claim(|c| {
        let point = || [number("0"), number("0"), number("0")];
        c.design.workspace = Workspace::Box { min: point(), max: point() };
    });
    assert_eq!(unused, Unused("side".into()));
    // More than is evaluated in every cell.
    let radius = |text: &str| {
        let radius = number(text);
        rejected(|claim, _| {
            let z = [number("0"), number("1")];
            let center = [number("0"), number("0")];
            claim.design.workspace = Workspace::Cylinder { center, radius, z };
        })
    };
    for text in [["side"; 7].join("*"), format!("side+1/{}", "7".repeat(99))] {
        let reason = radius(&text);
        assert!(matches!(reason, Rejected::AtlasClaim(AtlasError::TooLong(_))), "{reason}");
    }
    assert!(matches!(radius(&["side"; 6].join("*")), Rejected::Cell { .. }));
    let cube = claim(|c| {
        c.design.workspace = Workspace::Cube { side: number("side") };
        c.design.mechanism = Mechanism::Orthoglide { offset: number("0") };
    });
    assert_eq!(cube, Cube);
}

#[test]
fn an_atlas_goes_with_its_own_kind_of_proof_and_verdict() {
    let mut refuted = good();
    refuted.verdict = Verdict::Refuted;
    assert_eq!(check(&refuted), Err(Rejected::VerdictMismatch));
    let mut tree = good();
    tree.proof = Proof::Tree(Tree { precision: 64, nodes: vec![Node::default()] });
    assert_eq!(check(&tree), Err(Rejected::VerdictMismatch));
}

#[test]
fn names_are_numbers_in_atlases_only() {
    let mut certificate = good();
    let design = parts(&mut certificate).0.design.clone();
    assert!(matches!(design.validate(), Err(ClaimError::Open(_))));
    certificate.claim = Claim::Machine(design);
    certificate.proof = Proof::Tree(Tree { precision: 64, nodes: vec![Node::default()] });
    assert!(matches!(check(&certificate), Err(Rejected::Claim(ClaimError::Open(_)))));
    let x = number("radius/2");
    assert!(x.is_open() && x.sign().is_none() && x.enclose(0, 64).is_none());
    assert!(Exact::parse("radius/2", 100).is_err());
}

#[test]
fn what_the_workspace_is_cut_to_is_not_empty() {
    // For large parameters the box is reversed; the strictest claim, from -1/2 to 1, is not.
    let reversed = rejected(|claim, cells| {
        if let Workspace::Box { min, .. } = &mut claim.design.workspace {
            min[0] = number("2*side-1/2");
        }
        cells.iter_mut().filter(|c| is_refuted(c)).for_each(|c| *c = AtlasCell::Undecided);
    });
    assert!(matches!(of_a_cell(reversed), Rejected::Claim(_) | Rejected::Step { .. }));
}

/// Every value of an expression is in its range: exact arithmetic at points of the cell.
#[test]
fn ranges_hold_every_value() {
    let part = |n: i64| Exact::Rational(BigRational::new(n.into(), 7.into()));
    for text in [
        "a",
        "-a",
        "a+b",
        "a-b",
        "a*b",
        "a*a-b",
        "a/b",
        "1/b",
        "-a/(b+1)",
        "sqrt(b)",
        "a*sqrt(3)/2",
        "(a-b)*(a+b)",
        "sqrt(b)*a",
        "2/(1/b+1/(b+a*a))",
        "(a+1)/2*-sqrt(2)",
    ] {
        let x = number(text);
        let values: [(&str, Ends); 2] = [("a", (part(-5), part(4))), ("b", (part(3), part(19)))];
        let (least, greatest) = range(&x, &values).unwrap();
        let bounds = Quantity { min: least, max: greatest };
        for a in -5..=4 {
            for b in 3..=19 {
                let at = [("a", (part(a), part(a))), ("b", (part(b), part(b)))];
                let (value, same) = range(&x, &at).unwrap();
                assert_eq!(value, same, "{text}");
                assert!(bounds.admits(&value), "{text} at {a}/7, {b}/7: {value}");
            }
        }
    }
}

#[test]
fn what_is_not_defined_on_all_of_a_cell_has_no_range() {
    let values = [("a", (number("-1"), number("1")))];
    let error = |text| range(&number(text), &values).expect_err(text).to_string();
    assert!(error("1/a").contains("divisor"));
    assert!(error("sqrt(a)").contains("radicand"));
    assert!(error("1/(a*a)").contains("divisor"));
    assert!(error("b").contains("not the name of a parameter"));
}

#[test]
fn every_design_of_a_cell_is_between_its_two_claims() {
    let mut certificate = good();
    let claim = parts(&mut certificate).0.clone();
    let (lower, upper) = Cell::ROOT.halves(orthocert_checker::cell::Axis::Y).unwrap();
    for cell in [Cell::ROOT, lower, upper] {
        let [strict, loose] =
            [Side::Strictest, Side::Loosest].map(|s| claim.cell(&cell, s).unwrap());
        for (_, (min, max)) in claim.ranges(&cell).unwrap() {
            assert_eq!(min.compare(&max), Some(std::cmp::Ordering::Less));
        }
        let at = claim.ranges(&cell).unwrap();
        let corner: Vec<(&str, Ends)> =
            at.iter().map(|(name, (min, _))| (*name, (min.clone(), min.clone()))).collect();
        let design = instance(&claim.design, &corner, Side::Strictest).unwrap();
        let at_most = |x: &Exact, y: &Exact| {
            matches!(x.compare(y), Some(std::cmp::Ordering::Less | std::cmp::Ordering::Equal))
        };
        let boxed = |w: &Workspace| match w {
            Workspace::Box { min, max } => (min[0].clone(), max[2].clone()),
            _ => panic!("not a box"),
        };
        let [outer, inner, of_one] =
            [&strict, &loose, &design].map(|claim| boxed(&claim.workspace));
        assert!(at_most(&outer.0, &of_one.0) && at_most(&of_one.0, &inner.0));
        assert!(at_most(&inner.1, &of_one.1) && at_most(&of_one.1, &outer.1));
        let bounds = |claim: &orthocert_checker::claim::MachineClaim| {
            let range = claim.requirements.transmission.clone().unwrap();
            (range.min.unwrap(), range.max.unwrap())
        };
        let [hard, easy, own] = [&strict, &loose, &design].map(bounds);
        assert!(at_most(&easy.0, &own.0) && at_most(&own.0, &hard.0));
        assert!(at_most(&hard.1, &own.1) && at_most(&own.1, &easy.1));
    }
}

#[test]
fn a_number_with_no_stricter_side_may_not_vary() {
    let mut certificate = good();
    let design = &mut parts(&mut certificate).0.design;
    design.workspace = Workspace::Cylinder {
        center: [number("side"), number("0")],
        radius: number("1/10"),
        z: [number("0"), number("1/10")],
    };
    let values =
        [("side", (number("1/4"), number("1/2"))), ("psi_max", (number("2"), number("3")))];
    let varies = AtlasError::Varies("side".into());
    assert_eq!(instance(design, &values, Side::Strictest), Err(varies));
}

#[test]
fn a_quantity_takes_every_value_between_its_ends_in_either_order() {
    let mut certificate = good();
    let design = &mut parts(&mut certificate).0.design;
    let mut length = |min: &str, max: &str| {
        let Mechanism::Translational(legs) = &mut design.mechanism else { panic!("legs") };
        let Leg::Slider { length, .. } = &mut legs[0] else { panic!("a slider") };
        *length = Quantity { min: number(min), max: number(max) };
        let values =
            [("side", (number("1/10"), number("9/10"))), ("psi_max", (number("2"), number("3")))];
        let claim = instance(design, &values, Side::Loosest)?;
        let Mechanism::Translational(legs) = claim.mechanism else { panic!("legs") };
        let Leg::Slider { length, .. } = &legs[0] else { panic!("a slider") };
        Ok::<_, AtlasError>([length.min.to_string(), length.max.to_string()])
    };
    assert_eq!(length("1-side", "1+side").unwrap(), ["1/10", "19/10"]);
    // From the greater to the lesser, everywhere: were the ends taken in their order, no machine
    // would be meant, and anything could be said of it.
    assert_eq!(length("1+side", "1+side*side").unwrap(), ["101/100", "19/10"]);
    assert_eq!(length("1+side", "1").unwrap(), ["1", "19/10"]);
    assert_eq!(length("1+side", "1+side").unwrap(), ["11/10", "19/10"]);
    // Numbers stay as they are: the claim is then not well formed.
    assert_eq!(length("2", "1").unwrap(), ["2", "1"]);
}
