//! Atlases against what is known otherwise: the closed form for Orthoglides on diagonal cubes, and
//! single designs.

use num_traits::ToPrimitive;
use orthocert::design::AtlasDesign;
use orthocert::exact::Exact;
use orthocert::questions::atlas::{
    assemble, certify, decide, ends, grow, waiting, Decision, Growing, Top,
};
use orthocert::search::solver::margin::margin;
use orthocert::search::solver::{verify, Answer};
use orthocert::search::{Budget, Control};
use orthocert_checker::certificate::{Proof, Verdict};
use orthocert_kernel::atlas::{walk, Part};
use orthocert_kernel::certificate::{AtlasCell, Claim};
use orthocert_kernel::number::Expression;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Maps in which no cell of those tried here is refuted.
const REFUTED_NOWHERE: [&str; 1] = ["delta-clearance"];

fn atlas(name: &str, resolution: u32) -> AtlasDesign {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/atlases");
    let mut design = AtlasDesign::read(&folder.join(format!("{name}.toml"))).unwrap();
    design.resolution = resolution;
    design
}

fn grown(design: &AtlasDesign, root: Part, enough: Option<usize>) -> Vec<Top> {
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    grow(&mut Growing::new(design, &mut control), root, enough).unwrap()
}

fn map(design: &AtlasDesign) -> Vec<AtlasCell> {
    assemble(grown(design, design.whole(), None), Vec::new()).unwrap()
}

fn approximate(x: &Exact) -> f64 {
    x.as_rational().and_then(|x| x.to_f64()).unwrap()
}

/// How far the Orthoglide of leg length 1 is within its bounds on the cube of this side, by the
/// closed form of proofs/README.md, section 3; negative beyond them.
fn closed_form(psi_max: f64, side: f64) -> f64 {
    let tangent = |c: f64| c / (1.0 - 2.0 * c * c).sqrt();
    let root = 3f64.sqrt();
    let (t, u) = (tangent(side * (root - 1.0) / 2.0), tangent(side * (3.0 - root) / 2.0));
    if !(t.is_finite() && u.is_finite() && 2.0 * t < 1.0 && u < 1.0) {
        return -1.0;
    }
    let least = 1.0 - f64::max(2.0 * t, u);
    f64::min(least - 1.0 / psi_max, psi_max - (1.0 + 2.0 * u))
}

#[test]
fn margins_agree_with_the_closed_form() {
    let design = atlas("orthoglide", 1);
    for (psi_max, side) in [("2", "0.2"), ("2", "0.6"), ("3", "0.7"), ("1.3", "0.25"), ("4", "0.1")]
    {
        let number = |text| Exact::parse(text, 10).unwrap();
        let found = margin(&design.at(&[number(psi_max), number(side)]), 14);
        let (psi_max, side): (f64, f64) = (psi_max.parse().unwrap(), side.parse().unwrap());
        let fails = |m: f64| closed_form(psi_max / (1.0 + m), side) < 0.0;
        assert!(!fails(found - 1e-4) && fails(found + 1e-4), "{psi_max} {side}: {found}");
    }
}

#[test]
fn orthoglides_agree_with_the_closed_form() {
    let design = atlas("orthoglide", 6);
    let cells = map(&design);
    let (certificate, ..) = certify(&design, cells.clone()).unwrap();
    assert_eq!(certificate.verdict, Verdict::Certified);
    let (mut certified, mut refuted) = (0, 0);
    let shares = walk(&cells, 2, |_, part, said| {
        let ranges = ends(&design, part).unwrap();
        let ends = |i: usize| (approximate(&ranges[i][0]), approximate(&ranges[i][1]));
        let ((psi_low, psi_high), (small, large)) = (ends(0), ends(1));
        // The most demanding and the least demanding design of the cell.
        match said {
            AtlasCell::Certified(_) => {
                assert!(closed_form(psi_low, large) > -1e-12, "{psi_low} {large}");
                certified += 1;
            }
            AtlasCell::Refuted(_) => {
                assert!(closed_form(psi_high, small) < 1e-12, "{psi_high} {small}");
                refuted += 1;
            }
            // Only where the border is, or near.
            _ => {
                let near = 0.02;
                assert!(closed_form(psi_low - near, large + near) < 0.0);
                assert!(closed_form(psi_high + near, small - near) > 0.0);
            }
        }
        Ok(())
    });
    assert!(certified > 50 && refuted > 50, "{certified} {refuted}");
    let shares = shares.unwrap();
    let decided = (shares.certified + shares.refuted).to_f64().unwrap();
    assert!(decided > 0.97, "{decided}");
}

/// The design at values of the parameters, decided by itself.
fn alone(design: &AtlasDesign, at: &[Exact]) -> Option<Verdict> {
    let claim = design.at(at);
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let budget = Budget { max_boxes: 20_000, deadline: None };
    match verify(&claim, budget, &mut control).unwrap().answer {
        Answer::Decided { accepted, .. } => Some(accepted.verdict),
        _ => None,
    }
}

#[test]
fn single_designs_are_what_their_cell_says() {
    for (name, resolution) in [
        ("linear-delta-2", 3),
        ("linear-delta-3", 3),
        ("rpr", 3),
        ("spherical", 2),
        ("hexapod", 2),
        ("delta-clearance", 2),
        ("orthoglide-accuracy", 3),
    ] {
        let design = AtlasDesign { boxes: 40, ..atlas(name, resolution) };
        let [mut certified, mut refuted] = [0; 2];
        walk(&map(&design), 2, |_, part, said| {
            let expected = match said {
                AtlasCell::Certified(_) => Verdict::Certified,
                AtlasCell::Refuted(_) => Verdict::Refuted,
                _ => return Ok(()),
            };
            certified += usize::from(expected == Verdict::Certified);
            refuted += usize::from(expected == Verdict::Refuted);
            let ranges = ends(&design, part).unwrap();
            let third = |[min, max]: &[Exact; 2]| {
                let width = max.clone().minus(min.clone()).unwrap();
                min.clone().plus(width.over(Exact::integer(3)).unwrap()).unwrap()
            };
            let at: Vec<Exact> = ranges.iter().map(third).collect();
            assert_eq!(alone(&design, &at), Some(expected), "{name}: {at:?}");
            Ok(())
        })
        .unwrap();
        assert!(certified > 0, "{name}");
        assert!(refuted > 0 || REFUTED_NOWHERE.contains(&name), "{name}");
    }
}

#[test]
fn parts_put_in_their_places_are_the_whole() {
    let design = atlas("orthoglide", 5);
    let whole = map(&design);
    for enough in [2, 7, 10_000] {
        let top = grown(&design, design.whole(), Some(enough));
        let cells = waiting(&top, design.whole()).unwrap();
        let parts = cells
            .iter()
            .map(|cell| assemble(grown(&design, cell.clone(), None), Vec::new()).unwrap());
        let parts: Vec<_> = parts.collect();
        assert_eq!(assemble(top.clone(), parts.clone()), Some(whole.clone()), "{enough}");
        if !parts.is_empty() {
            assert_eq!(assemble(top, parts[1..].to_vec()), None);
        }
    }
}

#[test]
fn a_cell_with_both_kinds_of_designs_stays_open() {
    let design = atlas("orthoglide", 3);
    let cancel = AtomicBool::new(false);
    let decision = decide(&design, &design.claim(), &design.whole(), &cancel);
    assert_eq!(decision, Decision::Open);
}

/// Machines that maps were not made of by the rules: more legs, the plane, users' own formulas.
#[test]
fn maps_of_every_kind_of_machine() {
    let head = "[atlas]\nresolution = 3\nboxes = 200\n";
    let strut =
        |anchor: &str| format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = {anchor}\n");
    let a = "[parameters]\na = { min = 1, max = 3 }\n";
    let four =
        [r#"["a", 0, 0]"#, r#"[0, "a", 0]"#, r#"["-a", 0, 0]"#, r#"[0, "-a", 0]"#].map(strut);
    let wide = "[workspace]\nmin = [-0.2, -0.2, 2]\nmax = [0.2, 0.2, 2.2]\n";
    let bounded = "[requirements]\nconditioning = { max = 2 }\n";
    let four =
        format!("{a}{head}[mechanism]\nkind = \"translational\"\n{}{wide}{bounded}", four.concat());
    let two = [r#"["-a", 0]"#, r#"["a", 0]"#].map(strut);
    let flat = "[workspace]\nmin = [-0.2, 2]\nmax = [0.2, 2.2]\n";
    let wider = "[parameters]\na = { min = 1, max = 4 }\n";
    let two = format!("{wider}{head}[mechanism]\nkind = \"planar\"\n{}{flat}[requirements]\nconditioning = {{ max = \"3/2\" }}\n", two.concat());
    let own = "[mechanism]\nkind = \"formulas\"\ncoordinates = [\"x\", \"y\"]\n\
               [mechanism.parameters]\nl = \"3 ± tol\"\n\
               [[mechanism.joints]]\nrho = \"x - sqrt(l^2 - y^2)\"\n\
               [[mechanism.joints]]\nrho = \"y - sqrt(9 - (x/w)^2)\"\n";
    let box_of = "[workspace]\nmin = [-1, -1]\nmax = [\"w\", 1]\n";
    let w = "[parameters]\nw = { min = 1, max = 3 }\ntol = { min = 0, max = 0.1 }\n";
    let own = format!("{w}{head}{own}{box_of}{bounded}");
    for (name, text) in [("four", four), ("two", two), ("own", own)] {
        let design = AtlasDesign::parse(&text, name).unwrap_or_else(|error| panic!("{error}"));
        let cells = map(&design);
        let (_, accepted, _) = certify(&design, cells.clone()).unwrap();
        assert!(accepted.size.leaves > 0, "{name}");
        let (mut certified, mut refuted) = (0, 0);
        walk(&cells, design.parameters.len(), |_, part, said| {
            let expected = match said {
                AtlasCell::Certified(_) => Verdict::Certified,
                AtlasCell::Refuted(_) => Verdict::Refuted,
                _ => return Ok(()),
            };
            certified += usize::from(expected == Verdict::Certified);
            refuted += usize::from(expected == Verdict::Refuted);
            for end in 0..2 {
                let at: Vec<Exact> = ends(&design, part)
                    .unwrap()
                    .into_iter()
                    .map(|ends| ends[end].clone())
                    .collect();
                if at.iter().all(|x| *x != Exact::integer(0)) {
                    assert_eq!(alone(&design, &at), Some(expected), "{name}: {at:?}");
                }
            }
            Ok(())
        })
        .unwrap();
        assert!(certified > 0, "{name}");
        assert!(refuted > 0 || name == "own", "{name}");
    }
}

/// The checker refuses a cell that asks for too much work: it is left undecided, and the others stay as they are.
#[test]
fn a_cell_that_asks_for_too_much_costs_no_other() {
    let design = atlas("orthoglide", 5);
    let mut cells = map(&design);
    let (whole, _, none) = certify(&design, cells.clone()).unwrap();
    assert_eq!(none, 0);
    let is_refuted = |cell: &AtlasCell| matches!(cell, AtlasCell::Refuted(_));
    let at = cells.iter().position(is_refuted).unwrap();
    let AtlasCell::Refuted(witness) = &mut cells[at] else { unreachable!() };
    let roots = Expression::try_from(vec!["sqrt(side)"; 400].join("+")).unwrap();
    witness.machine = vec![roots; 200];
    let (certificate, accepted, too_long) = certify(&design, cells).unwrap();
    assert_eq!((too_long, accepted.verdict), (1, Verdict::Certified));
    let (Proof::Atlas(cells), Claim::Atlas(claim)) = (&certificate.proof, &certificate.claim)
    else {
        unreachable!()
    };
    assert!(matches!(cells[at], AtlasCell::Undecided));
    let Claim::Atlas(before) = &whole.claim else { unreachable!() };
    assert_eq!(claim.certified, before.certified);
    assert!(claim.refuted.rational() < before.refuted.rational());
}
