//! Maps of parameters: certified, refuted and undecided cells, and what is rejected.

use crate::prover::Prover;
use num_traits::ToPrimitive;
use orthocert_kernel::atlas::{check_part, statement, walk, Part};
use orthocert_kernel::certificate::{
    AtlasCell, Certificate, Claim, Evidence, Failure, Node, Proof, Provenance, Step, Tree, Verdict,
    Witness, FORMAT,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{AtlasClaim, Quantity, Workspace};
use orthocert_kernel::input::{Input, Value};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::prover::check_cell;
use orthocert_kernel::rejected::Rejected;
use orthocert_kernel::test::Multiplier;
use orthocert_kernel::witness::WitnessError;

pub fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

/// The Orthoglide with `L = 1`, and a cube of the side `side` at its best place for `psi_max = 2`.
fn orthoglide(certified: &str, refuted: &str) -> String {
    let leg = |n: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":"1","mode":"+"}}"#
        )
    };
    let legs = [leg(r#""1","0","0""#), leg(r#""0","1","0""#), leg(r#""0","0","1""#)].join(",");
    let (low, high) = (r#""-side*(sqrt(3)-1)/2""#, r#""side*(3-sqrt(3))/2""#);
    format!(
        r#"{{"parameters":[{{"name":"psi_max","min":"6/5","max":"4"}},{{"name":"side","min":"1/10","max":"1"}}],"machine":{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":[{low},{low},{low}],"max":[{high},{high},{high}]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"psi_max"}},{{"quantity":"transmission","end":"min","bound":"1/psi_max"}}]}},"certified":"{certified}","refuted":"{refuted}"}}"#
    )
}

pub fn claim(text: &str) -> AtlasClaim {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

pub fn certificate(claim: AtlasClaim, cells: Vec<AtlasCell>) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Atlas(claim),
        verdict: Verdict::Certified,
        proof: Proof::Atlas(cells),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}

/// The map of a claim, with cells of up to so many halvings; `witnesses` are tried in their order.
fn map(claim: &AtlasClaim, witnesses: &[Witness], depth: u32) -> Vec<AtlasCell> {
    let mut cells = Vec::new();
    let mut waiting: Vec<Part> = vec![vec![(0, 0); claim.parameters.len()]];
    while let Some(part) = waiting.pop() {
        let over = claim.over(&part).expect("parameters");
        let refutes = |witness: &&Witness| {
            let mut whole =
                certificate(claim.clone(), vec![AtlasCell::Refuted((*witness).clone())]);
            let Claim::Atlas(own) = &mut whole.claim else { return false };
            (own.certified, own.refuted) = (number("0"), number("1"));
            for (parameter, (n, level)) in own.parameters.iter_mut().zip(&part) {
                let (min, max) = (parameter.min.to_string(), parameter.max.to_string());
                let end = |n: u64| number(&format!("{min}+({max}-{min})*{n}/{}", 1u64 << level));
                (parameter.min, parameter.max) = (end(*n), end(n + 1));
            }
            check(&whole).is_ok()
        };
        let levels: u32 = part.iter().map(|(_, level)| level).sum();
        if let Some(tree) = Problem::new(&over).ok().and_then(|p| Prover::new(&p).tree(60)) {
            cells.push(AtlasCell::Certified(tree));
        } else if let Some(witness) = witnesses.iter().find(refutes) {
            cells.push(AtlasCell::Refuted(witness.clone()));
        } else if levels == depth {
            cells.push(AtlasCell::Undecided);
        } else {
            let k = levels as usize % part.len();
            cells.push(AtlasCell::Split(k));
            let (n, level) = part[k];
            for n in [2 * n + 1, 2 * n] {
                let mut half = part.clone();
                half[k] = (n, level + 1);
                waiting.push(half);
            }
        }
    }
    cells
}

/// At the greatest corner, as it is for each side.
fn corner(obligation: usize, direction: [i64; 3]) -> Witness {
    Witness {
        precision: 96,
        point: vec![number("side*(3-sqrt(3))/2"); 3],
        machine: Vec::new(),
        fails: Failure::Obligation(obligation, vec![direction.to_vec()]),
    }
}

fn witnesses() -> Vec<Witness> {
    let mut all = vec![corner(1, [1, 1, 1]), corner(0, [1, -1, 0]), corner(0, [1, 1, 1])];
    let mut reach = corner(0, [1, 1, 1]);
    reach.fails = Failure::Reach;
    all.push(reach);
    all
}

/// The cells that are no splits, each with its part.
fn leaves(claim: &AtlasClaim, cells: &[AtlasCell]) -> Vec<(usize, Part)> {
    let mut found = Vec::new();
    walk(cells, claim.parameters.len(), |at, part, _| {
        found.push((at, part.clone()));
        Ok(())
    })
    .expect("a tree");
    found
}

/// Whether the claim holds, with a margin that tells: on `[-c_1, c_2]^3` the least singular value of `M` is
/// `1 - max(2 T, U)` and the greatest `1 + 2 U`, with `c = t/sqrt(1 + 2 t^2)` for `T` of `c_1`, `U` of `c_2`.
fn holds(psi: f64, side: f64) -> Option<bool> {
    let tan = |c: f64| c / (1.0 - 2.0 * c * c).sqrt();
    let root = 3f64.sqrt();
    let (t, u) = (tan(side * (root - 1.0) / 2.0), tan(side * (3.0 - root) / 2.0));
    if !(t.is_finite() && u.is_finite()) {
        return Some(false);
    }
    let margin = (1.0 - (2.0 * t).max(u) - 1.0 / psi).min(psi - 1.0 - 2.0 * u);
    (margin.abs() > 1e-9).then_some(margin > 0.0)
}

fn shares(cells: &[AtlasCell], claim: &AtlasClaim) -> [i64; 2] {
    let mut found = [0; 2];
    for (at, part) in leaves(claim, cells) {
        let share = 1 << (20 - part.iter().map(|(_, level)| level).sum::<u32>());
        match cells[at] {
            AtlasCell::Certified(_) => found[0] += share,
            AtlasCell::Refuted(_) => found[1] += share,
            AtlasCell::Split(_) | AtlasCell::Undecided => {}
        }
    }
    found
}

/// A map with all kinds of cells, and the shares that it has of `2^20`.
fn mapped() -> Certificate {
    let mut own = claim(&orthoglide("0", "0"));
    let cells = map(&own, &witnesses(), 5);
    let [good, bad] = shares(&cells, &own);
    assert!(good > 1 << 18 && bad > 1 << 14, "{good} {bad}");
    own.certified = number(&format!("{good}/1048576"));
    own.refuted = number(&format!("{bad}/1048576"));
    certificate(own, cells)
}

pub fn parts(certificate: &Certificate) -> (AtlasClaim, Vec<AtlasCell>) {
    match (&certificate.claim, &certificate.proof) {
        (Claim::Atlas(claim), Proof::Atlas(cells)) => (claim.clone(), cells.clone()),
        _ => panic!("an atlas"),
    }
}

#[test]
fn a_map_says_what_is_true() {
    let whole = mapped();
    let text = whole.to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    assert_eq!(read, whole);
    check(&read).expect("accepted");
    let (own, cells) = parts(&whole);
    for (at, part) in leaves(&own, &cells) {
        let at_cell = |k: usize, i: i32| {
            let (n, level) = part[k];
            (n as f64 + f64::from(i) / 4.0) / f64::from(1 << level)
        };
        for i in 0..25 {
            let (psi, side) = (1.2 + 2.8 * at_cell(0, i % 5), 0.1 + 0.9 * at_cell(1, i / 5));
            let Some(holds) = holds(psi, side) else { continue };
            match cells[at] {
                AtlasCell::Certified(_) => assert!(holds, "cell {at}: {psi} {side}"),
                AtlasCell::Refuted(_) => assert!(!holds, "cell {at}: {psi} {side}"),
                AtlasCell::Split(_) | AtlasCell::Undecided => {}
            }
        }
    }
    let words = statement(&own);
    for sentence in ["<psi_max> in [6/5, 4]", "to (<side>*(3-sqrt(3))/2, ", "psi_i <= <psi_max>"] {
        assert!(words.contains(sentence), "{words}");
    }
    // Of a parameter with the name of a coordinate: "z <= z <= z" would be said of every z.
    let mut own = own;
    own.parameters[1].name = "z".to_owned();
    let [z, radius] = ["z", "1/2"].map(number);
    let center = [number("0"), number("0")];
    own.machine.workspace = Workspace::Cylinder { center, radius, z: [z.clone(), z] };
    let words = statement(&own);
    assert!(words.contains("<z> in [1/10, 1]") && words.contains("<z> <= z <= <z>"), "{words}");
}

#[test]
fn maps_that_show_less() {
    let (own, cells) = parts(&mapped());
    let with = |change: &dyn Fn(&mut AtlasClaim, &mut Vec<AtlasCell>)| {
        let (mut own, mut cells) = (own.clone(), cells.clone());
        change(&mut own, &mut cells);
        check(&certificate(own, cells))
    };
    with(&|_, _| {}).expect("accepted");
    // More than the cells have, or less than nothing.
    let more = |x: &Expression| number(&format!("{x}+1/1000000000"));
    assert_eq!(with(&|own, _| own.certified = more(&own.certified)), Err(Rejected::Shares));
    assert_eq!(with(&|own, _| own.refuted = more(&own.refuted)), Err(Rejected::Shares));
    assert_eq!(with(&|own, _| own.refuted = number("-1")), Err(Rejected::Shares));
    assert_eq!(with(&|own, _| own.refuted = number("psi_max")), Err(Rejected::Shares));
    assert_eq!(with(&|_, cells| cells[0] = AtlasCell::Split(2)), Err(Rejected::Shape(0)));
    assert_eq!(with(&|_, cells| drop(cells.pop())), Err(Rejected::Shape(cells.len() - 1)));
    let one_more = with(&|_, cells| cells.push(AtlasCell::Undecided));
    assert_eq!(one_more, Err(Rejected::Shape(cells.len())));
    let long = with(&|_, cells| *cells = vec![AtlasCell::Split(0); 100]);
    assert_eq!(long, Err(Rejected::Shape(60)));
    // What is said of one cell is said of another.
    let all = leaves(&own, &cells);
    let good = all.iter().find(|(at, _)| matches!(cells[*at], AtlasCell::Certified(_)));
    let bad = all.iter().find(|(at, _)| matches!(cells[*at], AtlasCell::Refuted(_)));
    let (good, bad) = (good.expect("one").0, bad.expect("one").0);
    for (at, _) in &all {
        let moved = |from: usize| with(&|_, cells| cells[*at] = cells[from].clone());
        if !matches!(cells[*at], AtlasCell::Certified(_)) {
            assert!(matches!(moved(good), Err(Rejected::Cell(cell, _)) if cell == *at));
        }
        if matches!(cells[*at], AtlasCell::Certified(_)) {
            assert!(matches!(moved(bad), Err(Rejected::Cell(cell, _)) if cell == *at));
        }
    }
    // An open tree, one that fails, and one without precision.
    let fails = Node { fails: Some(Failure::Reach), ..Node::default() };
    for (precision, node) in [(52, Node::default()), (52, fails), (4, Node::default())] {
        let tree = Tree { precision, chords: None, nodes: vec![node] };
        let found = with(&|_, cells| cells[good] = AtlasCell::Certified(tree.clone()));
        assert!(matches!(found, Err(Rejected::Cell(..))));
    }
}

/// Whatever cell is wrong, one of the parts rejects it; what is of no cell, all of them.
#[test]
fn the_parts_of_a_check_are_the_whole() {
    let (own, cells) = parts(&mapped());
    let rejecting = |own: &AtlasClaim, cells: &[AtlasCell]| {
        let part = |part: &usize| check_part(own, cells, |number| number % 3 == *part).is_err();
        (0..3).filter(part).collect::<Vec<_>>()
    };
    assert_eq!(rejecting(&own, &cells), [0; 0]);
    let open = Tree { precision: 52, chords: None, nodes: vec![Node::default()] };
    for (at, _) in leaves(&own, &cells) {
        if matches!(cells[at], AtlasCell::Certified(_)) {
            let mut wrong = cells.clone();
            wrong[at] = AtlasCell::Certified(open.clone());
            assert_eq!(rejecting(&own, &wrong), [at % 3]);
        }
    }
    let more = AtlasClaim { refuted: number("1"), ..own };
    assert_eq!(rejecting(&more, &cells), [0, 1, 2]);
}

/// The same cells of a box that reaches to smaller `psi_max`, or to larger cubes; refuted, of one with small ones only.
#[test]
fn a_wider_box_needs_other_proofs() {
    let (own, cells) = parts(&mapped());
    let of_box = |k: usize, end: &str, to: &str, all: &dyn Fn(&AtlasCell) -> bool| {
        let mut own = own.clone();
        let parameter = &mut own.parameters[k];
        *(if end == "min" { &mut parameter.min } else { &mut parameter.max }) = number(to);
        let kept = |cell: &AtlasCell| match cell {
            AtlasCell::Split(_) => cell.clone(),
            _ if all(cell) => cell.clone(),
            _ => AtlasCell::Undecided,
        };
        check(&certificate(own, cells.iter().map(kept).collect()))
    };
    let certified = |cell: &AtlasCell| matches!(cell, AtlasCell::Certified(_));
    let refuted = |cell: &AtlasCell| matches!(cell, AtlasCell::Refuted(_));
    assert!(matches!(of_box(0, "min", "1", &certified), Err(Rejected::Cell(..))));
    assert!(matches!(of_box(1, "max", "3/2", &certified), Err(Rejected::Cell(..))));
    assert!(matches!(of_box(1, "max", "1/5", &refuted), Err(Rejected::Cell(..))));
}

/// What a witness shows, it shows of every design of its cell.
#[test]
fn witnesses_that_show_less() {
    let (own, cells) = parts(&mapped());
    let at = cells.iter().position(|cell| matches!(cell, AtlasCell::Refuted(_))).expect("one");
    let with = |change: &dyn Fn(&mut Witness)| {
        let mut cells = cells.clone();
        if let AtlasCell::Refuted(witness) = &mut cells[at] {
            change(witness);
        }
        match check(&certificate(own.clone(), cells)) {
            Err(Rejected::Cell(found, why)) if found == at => match *why {
                Rejected::Witness(why) => why,
                why => panic!("{why}"),
            },
            other => panic!("{other:?}"),
        }
    };
    let at_point = |point: [&str; 3]| with(&|witness| witness.point = point.map(number).to_vec());
    assert_eq!(at_point(["0", "0", "0"]), WitnessError::NotViolated);
    // In none of the workspaces, or in the larger ones only; beyond them by a number with a name.
    assert_eq!(at_point(["9/10", "0", "0"]), WitnessError::Outside);
    assert_eq!(at_point(["side", "0", "0"]), WitnessError::Outside);
    // No parameter's name.
    assert_eq!(at_point(["size/2", "0", "0"]), WitnessError::Outside);
    // A machine, where none is to be chosen.
    let machine = with(&|witness| witness.machine = vec![number("1")]);
    assert_eq!(machine, WitnessError::OutsideTolerance);
    assert_eq!(with(&|witness| witness.precision = 4), WitnessError::Precision(4));
    let none = with(&|witness| witness.fails = Failure::Obligation(9, Vec::new()));
    assert_eq!(none, WitnessError::NoSuchObligation);
}

#[test]
fn an_atlas_goes_with_its_own_kind_of_proof_and_verdict() {
    let good = mapped();
    let (own, cells) = parts(&good);
    let refuted = Certificate { verdict: Verdict::Refuted, ..good.clone() };
    assert_eq!(check(&refuted), Err(Rejected::Verdict));
    let tree = cells.iter().find_map(|cell| match cell {
        AtlasCell::Certified(tree) => Some(tree.clone()),
        _ => None,
    });
    let tree = Proof::Tree(tree.expect("one"));
    assert_eq!(check(&Certificate { proof: tree.clone(), ..good.clone() }), Err(Rejected::Verdict));
    // Names are numbers in atlases only.
    let claim = Claim::Machine(own.machine);
    let map = Certificate { claim: claim.clone(), ..good.clone() };
    assert_eq!(check(&map), Err(Rejected::Verdict));
    let named = Certificate { claim, proof: tree, ..good };
    assert!(matches!(check(&named), Err(Rejected::Claim(_))));
}

#[test]
fn claims_that_are_not_well_formed() {
    let good = orthoglide("0", "0");
    let found = |text: &str| check(&certificate(claim(text), vec![AtlasCell::Undecided]));
    found(&good).expect("accepted");
    let side = r#"{"name":"side","min":"1/10","max":"1"}"#;
    for (defect, from, to) in [
        ("the same name", r#""name":"side""#, r#""name":"psi_max""#),
        ("no name", r#""name":"side""#, r#""name":"sqrt""#),
        ("two names", r#""name":"side""#, r#""name":"a-b""#),
        ("an empty range", r#""min":"1/10""#, r#""min":"1""#),
        ("a range the wrong way round", r#""min":"1/10""#, r#""min":"2""#),
        ("an end that is not rational", r#""min":"1/10""#, r#""min":"sqrt(1/10)""#),
        ("an end that is a name", r#""min":"1/10""#, r#""min":"psi_max""#),
        ("a long end", r#""min":"1/10""#, r#""min":"1/3^64/3^64""#),
        ("four parameters", side, &[side, side, side].map(String::from).join(",")),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{defect}");
        assert!(matches!(found(&text), Err(Rejected::Claim(_))), "{defect}");
    }
    let none = good.replacen(&good[good.find('[').unwrap()..=good.find(']').unwrap()], "[]", 1);
    assert!(matches!(found(&none), Err(Rejected::Claim(_))));
    let legs =
        &good[good.find(r#"{"translational""#).unwrap()..good.find(r#","workspace""#).unwrap()];
    let cube = good.replacen(legs, r#"{"orthoglide":{"offset":"side"}}"#, 1);
    assert!(matches!(found(&cube), Err(Rejected::Claim(_))));
}

/// A claim of a mechanism `rho_i = x_i`, on `[0, 1]`, with one parameter and a length `a`.
fn plain(p: [&str; 2], a: &str, max: &str) -> String {
    let parameters =
        ["p", "q"].map(|name| format!(r#"{{"name":"{name}","min":"{}","max":"{}"}}"#, p[0], p[1]));
    format!(
        r#"{{"parameters":[{}],"machine":{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[["a",{a}]],"definitions":[],"joints":[{{"rho":"a*x"}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["{max}"]}}}},"require":[]}},"certified":"1","refuted":"0"}}"#,
        parameters.join(",")
    )
}

fn certified(text: &str) -> Result<(), Rejected> {
    let own = claim(text);
    let over = own.over(&[(0, 0), (0, 0)]).expect("parameters");
    let problem = Problem::new(&over).map_err(Rejected::Claim)?;
    let tree = Prover::new(&problem).tree(8).ok_or(Rejected::Shares)?;
    check(&certificate(own, vec![AtlasCell::Certified(tree)]))
}

#[test]
fn numbers_are_decided_for_every_value() {
    let tolerance = |min: &str, max: &str| format!(r#"{{"min":"{min}","max":"{max}"}}"#);
    for (a, max) in [
        (r#""1+p""#.to_owned(), "1"),
        // What cancels does.
        (tolerance("1+p-0.01", "1+p+0.01"), "1"),
        (tolerance("1+p*q", "2+q*p"), "1"),
        // None, for some.
        (tolerance("2-p", "2+p"), "1"),
        (r#""1""#.to_owned(), "p+2-p"),
        // The same expression is the same number.
        (r#""1""#.to_owned(), "p"),
    ] {
        certified(&plain(["0", "1"], &a, max)).unwrap_or_else(|e| panic!("{a} {max}: {e}"));
    }
    for (a, max) in [
        // Zero, or negative, for some.
        (r#""p-1/2""#.to_owned(), "1"),
        (r#""1""#.to_owned(), "p-1/1000"),
        // Not the same number, though the same range.
        (tolerance("1+p", "1+q"), "1"),
        // From the greater to the lesser for some, or for all: no machine would be meant.
        (tolerance("1+p", "3/2"), "1"),
        (tolerance("2+p", "1"), "1"),
        (r#""1""#.to_owned(), "p-q"),
        // Not defined for some.
        (r#""1+sqrt(p-1/2)""#.to_owned(), "1"),
        (r#""1+1/(p-1/2)^2""#.to_owned(), "1"),
        (r#""1+1/(p-q)^2""#.to_owned(), "1"),
        // No parameter's name.
        (r#""r""#.to_owned(), "1"),
        (r#""1""#.to_owned(), "r"),
    ] {
        assert!(certified(&plain(["0", "1"], &a, max)).is_err(), "{a} {max}");
    }
    // A name of the mechanism's own.
    let clash = plain(["0", "1"], r#""1""#, "1").replace(r#""name":"q""#, r#""name":"x""#);
    assert!(matches!(
        check(&certificate(claim(&clash), vec![AtlasCell::Undecided])),
        Err(Rejected::Claim(_))
    ));
}

/// What two numbers share cancels between them; what they do not share does not.
#[test]
fn a_name_is_one_number_wherever_it_stands() {
    // By one step with names apart, from these ends, and with `Y = y/1024`.
    let with = |joint: &str, parameters: &str, bound: &str, (ends, y): (&str, i64)| {
        let require = format!(r#"[{{"quantity":"transmission","end":"max","bound":"{bound}"}}]"#);
        let text = plain(["0", "1"], r#""1""#, "1")
            .replace(r#"["a","1"]"#, parameters)
            .replace("a*x", joint)
            .replace(r#""require":[]"#, &format!(r#""require":{require}"#));
        let lower = Evidence::Lower(Multiplier { y: vec![vec![y]], places: 10 });
        let by = Evidence::Tolerances(lower.into(), ends.to_owned(), vec![vec![1]]);
        let nodes = vec![Node { by: vec![Step(0, by)], ..Node::default() }];
        let tree = Tree { precision: 64, chords: None, nodes };
        check(&certificate(claim(&text), vec![AtlasCell::Certified(tree)]))
    };
    let same = r#"["a","2+p"],["b","1+p"]"#;
    let other = r#"["a","2+p"],["b","1+q"]"#;
    with("a*x-b*x", same, "1.01", ("-", 1024)).expect("a - b = 1");
    for ends in ["--", "-+", "+-", "++"] {
        assert!(with("a*x-b*x", other, "1.01", (ends, 1024)).is_err());
    }
    assert!(with("a*x-b*x", same, "1", ("-", 1024)).is_err());
    assert!(with("a*x-b*x", same, "1.01", ("", 1024)).is_err(), "no end of a name");
    let with_p = r#"["a","4+p/64"],["b","4+p/64"]"#;
    with("a*x/b", with_p, "1.001", ("-", 256)).expect("a/b = 1");
    let with_q = r#"["a","4+p/64"],["b","4+q/64"]"#;
    for ends in ["--", "-+", "+-", "++"] {
        assert!(with("a*x/b", with_q, "1.001", (ends, 256)).is_err());
    }
    // psi is up to 1/(1 - 1/8).
    for end in ["-", "0", "+"] {
        with("a*x", r#"["a","1-p/8"]"#, "8/7+1/1000", (end, 896)).expect("up to 8/7");
        assert!(with("a*x", r#"["a","1-p/8"]"#, "8/7-1/1000", (end, 896)).is_err());
    }
}

/// `rho = a x` with an error of 0.1 is off by `0.1/a`: for `a` from 1 to 2, by 0.05 at least. A tolerance puts it off by
/// more, or by less, and is of the machine.
#[test]
fn a_name_is_the_same_in_the_machine_that_joints_are_commanded_for() {
    let with = |a: &str, max: &str, machine: &[&str]| {
        let require = format!(
            r#"[{{"quantity":"accuracy","given":{{"joint_error":["0.1"]}},"end":"max","bound":"{max}"}}]"#
        );
        let text = plain(["0", "1"], a, "1")
            .replace(r#""require":[]"#, &format!(r#""require":{require}"#));
        let text =
            text.replace(r#""certified":"1","refuted":"0""#, r#""certified":"0","refuted":"1""#);
        let witness = Witness {
            point: vec![number("1")],
            machine: machine.iter().map(|x| number(x)).collect(),
            precision: 64,
            fails: Failure::Obligation(1, vec![vec![1]]),
        };
        check(&certificate(claim(&text), vec![AtlasCell::Refuted(witness)]))
    };
    with(r#""1+p""#, "0.049", &[]).expect("by 0.05 at least");
    assert!(with(r#""1+p""#, "0.051", &[]).is_err());
    let tolerance = r#"{"min":"1.9","max":"2.1"}"#;
    // rho is 2 in the middle, 1.9 of this machine.
    with(tolerance, "0.1", &["1.9"]).expect("by 0.2/1.9");
    assert!(with(tolerance, "0.106", &["1.9"]).is_err());
    assert!(with(tolerance, "0.05", &["2.1"]).is_err(), "by 0 for this error");
    // Both ends have the name: what cancels between the two machines is not seen, and nothing shown.
    let both = r#"{"min":"1+p-0.1","max":"1+p+0.1"}"#;
    assert!(with(both, "0.049", &["1+p+0.1"]).is_err(), "by 0 for this error");
}

/// Cells of linear Deltas whose guides' radius and workspace have names are certified only where all of
/// them are good, by their own formulas at single points.
#[test]
fn certified_cells_hold_good_machines_alone() {
    let legs = [("0", "r"), ("-r*sqrt(3)/2", "-r/2"), ("r*sqrt(3)/2", "-r/2")].map(|(x, y)| {
        format!(
            r#"{{"drive":"slider","direction":["0","0","1"],"anchor":["{x}","{y}","0"],"platform":["0","0","0"],"length":"1","mode":"-"}}"#
        )
    });
    let text = format!(
        r#"{{"parameters":[{{"name":"r","min":"0.3","max":"0.6"}},{{"name":"s","min":"0.02","max":"0.3"}}],"machine":{{"mechanism":{{"translational":[{}]}},"workspace":{{"cylinder":{{"center":["0","s/10"],"radius":"s","z":["0","1"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"2"}},{{"quantity":"transmission","end":"min","bound":"1/2"}}]}},"certified":"0","refuted":"0"}}"#,
        legs.join(",")
    );
    let own = claim(&text);
    let (mut certified, mut closest) = (0, f64::INFINITY);
    for number in 0..64 {
        let part = [(number % 8, 3), (number / 8, 3)];
        let over = own.over(&part).expect("parameters");
        let problem = Problem::new(&over).expect("well formed");
        let Some(tree) = Prover::new(&problem).tree(60) else { continue };
        check_cell(&own, &part, &AtlasCell::Certified(tree)).expect("accepted");
        certified += 1;
        let at = |k: usize, end: u64, [min, max]: [f64; 2]| {
            min + (max - min) * (part[k].0 + end) as f64 / 8.0
        };
        for sample in 0..4 * 24 {
            let (r, s) = (at(0, sample & 1, [0.3, 0.6]), at(1, sample >> 1 & 1, [0.02, 0.3]));
            let turn = std::f64::consts::TAU * (sample >> 2) as f64 / 24.0;
            let (x, y) = (s * turn.cos(), s / 10.0 + s * turn.sin());
            let row = |leg: usize| {
                let angle = std::f64::consts::TAU * (0.25 + leg as f64 / 3.0);
                let (u, v) = (x - r * angle.cos(), y - r * angle.sin());
                let w = (1.0 - u * u - v * v).sqrt();
                [u / w, v / w, -1.0]
            };
            let m = nalgebra::Matrix3::from_fn(|i, j| row(i)[j]);
            let xi = m.singular_values();
            let room = (xi.min() - 0.5).min(2.0 - xi.max());
            assert!(room > -1e-9, "{part:?}: {r} {s} {x} {y}: {xi}");
            closest = closest.min(room);
        }
    }
    assert!(certified > 8 && closest < 0.1, "{certified} {closest}");
}

/// The enclosure of a number over a cell has its values there.
#[test]
fn enclosures_have_every_value() {
    type Function = fn(f64, f64) -> f64;
    let numbers: [(&str, Function); 7] = [
        ("3+p-q", |p, q| 3.0 + p - q),
        ("p*q-p^2+5", |p, q| p * q - p * p + 5.0),
        ("(p-q)*(p-q)+1", |p, q| (p - q) * (p - q) + 1.0),
        ("(1+p)^5/(2+q)", |p, q| (1.0 + p).powi(5) / (2.0 + q)),
        ("sqrt(1+p*q)-q/(1+p)+2", |p, q| (1.0 + p * q).sqrt() - q / (1.0 + p) + 2.0),
        ("-(p-q)^3*sqrt(2)+4", |p, q| -(p - q).powi(3) * 2f64.sqrt() + 4.0),
        ("1/(1+p)+1/(1+q)", |p, q| 1.0 / (1.0 + p) + 1.0 / (1.0 + q)),
    ];
    for (text, value) in numbers {
        let own = claim(&plain(["0", "1"], "\"1\"", "1"));
        let mut widths = Vec::new();
        for part in [[(0, 0), (0, 0)], [(1, 1), (0, 2)], [(5, 4), (5, 4)], [(200, 8), (17, 8)]] {
            let varied = own.varied(&part, &number(text)).expect("parameters");
            let value_of = Value::Quantity(Quantity::Exactly(varied));
            let input = Input { place: String::new(), value: value_of, scale: 0 };
            let ends = input.enclose(40, None).map(|x| [x.lo, x.hi]).expect("a number");
            let [lo, hi] = ends.map(|x| x.to_f64().expect("a double") * (-40f64).exp2());
            for i in 0..81 {
                let at = |(n, level): (u64, u32), i: i32| {
                    (n as f64 + f64::from(i) / 8.0) / f64::from(1 << level)
                };
                let x = value(at(part[0], i % 9), at(part[1], i / 9));
                assert!(lo - 1e-9 <= x && x <= hi + 1e-9, "{text}: {x} in [{lo}, {hi}]");
            }
            widths.push(hi - lo);
        }
        assert!(widths[3] < 0.2 && widths[3] < widths[0] / 8.0, "{text}: {widths:?}");
    }
}

/// Files that ask for more than their bytes are worth are refused before they cost it.
#[test]
fn work_is_linear_in_the_file() {
    let tree = |a: &str| {
        let own = claim(&plain(["0", "1"], a, "1"));
        let problem = Problem::new(&own.over(&[(0, 0), (0, 0)]).expect("parameters"));
        let leaf = Prover::new(&problem.expect("well formed")).tree(1).expect("a proof");
        let mut cells = Vec::new();
        // In preorder: the lower half has no tree of its own but one cell, the upper one the rest.
        for level in 0..60 {
            cells.extend([AtlasCell::Split(level % 2), AtlasCell::Certified(leaf.clone())]);
        }
        cells.push(AtlasCell::Certified(leaf));
        check(&certificate(own, cells))
    };
    let is_work = |found: Result<(), Rejected>| match found {
        Err(Rejected::Cell(_, why)) => *why == Rejected::Work,
        _ => false,
    };
    tree(r#""1+p""#).expect("accepted");
    let roots = |n: usize| format!(r#""{}3{}""#, "sqrt(".repeat(n), ")".repeat(n));
    tree(&roots(8)).expect("accepted");
    let many = |n: usize| format!(r#""{}""#, vec![roots(60).replace('"', ""); n].join("+"));
    assert!(is_work(tree(&many(20))));
    let fractions: Vec<String> = (1..200).map(|i| format!("1/{}^20", 2 * i + 1)).collect();
    assert!(is_work(tree(&format!("\"1+{}\"", fractions.join("+")))));
    let powers = ["(1+p)^64/(3+p)^64+(2+p)^64/(5+p)^64+(1+q)^64/(3+p)^64"; 6].join("+");
    assert!(is_work(tree(&format!("\"1+{powers}\""))));
    // So much work that its sum is beyond the machine's numbers.
    let dear = format!("{}1{}^64", "(".repeat(60), "^64)".repeat(60));
    let all: Vec<String> = (0..60).map(|i| format!(r#"["a{i}","{dear}"]"#)).collect();
    let text = plain(["0", "1"], r#""1""#, "1")
        .replace(r#"[["a","1"]]"#, &format!(r#"[["a","1"],{}]"#, all.join(",")));
    let tree = Tree { precision: 32, chords: None, nodes: vec![Node::default()] };
    assert!(is_work(check(&certificate(claim(&text), vec![AtlasCell::Certified(tree)]))));
    // A tape that takes too much memory is no claim's.
    let definitions: Vec<String> =
        (1..300).map(|i| format!(r#"["d{i}","(d{}+1)^63"]"#, i - 1)).collect();
    let text = plain(["0", "1"], r#""1""#, "1")
        .replace(
            r#""definitions":[]"#,
            &format!(r#""definitions":[["d0","x"],{}]"#, definitions.join(",")),
        )
        .replace("a*x", "d299");
    let tree = Tree { precision: 1024, chords: None, nodes: vec![Node::default()] };
    let refused = check(&certificate(claim(&text), vec![AtlasCell::Certified(tree)]));
    let Err(Rejected::Cell(0, why)) = &refused else { panic!("{refused:?}") };
    assert!(matches!(**why, Rejected::Claim(_)), "{why}");
}
