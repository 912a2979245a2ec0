//! The Q1/Q2 postulate: proved, and what is rejected.

use crate::rough::{Pair, Rough};
use nalgebra::{Matrix3, SymmetricEigen};
use orthocert_kernel::arithmetic::Enclosure;
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::{
    Certificate, Claim, Corner, Evidence, Failure, Node, Proof, Provenance, Step, Tree, Verdict,
    Witness, FORMAT,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::PostulateClaim;
use orthocert_kernel::fixed::Interval;
use orthocert_kernel::postulate::{parts, statement, Part};
use orthocert_kernel::rejected::Rejected;
use std::cell::RefCell;
use std::collections::HashMap;

/// Fractional bits of a proof.
const BITS: u32 = 52;

/// Proposes the trees of parts, in an arithmetic over which `number` gives an interval of doubles.
struct Search<'a, E: Enclosure> {
    part: &'a Part,
    arithmetic: &'a E,
    number: fn([f64; 2]) -> E::Number,
    /// What closes the cells that have been tried: each is met in several orders.
    tried: RefCell<HashMap<Vec<[i64; 2]>, Option<Evidence>>>,
}

impl<E: Enclosure> Search<'_, E> {
    /// What closes a cell.
    fn closing(&self, cell: &Cell<i64>) -> Option<Evidence> {
        let key: Vec<[i64; 2]> = cell.0.iter().map(|edge| [edge.lo, edge.hi]).collect();
        if let Some(known) = self.tried.borrow().get(&key) {
            return known.clone();
        }
        let found = self.found(cell);
        self.tried.borrow_mut().insert(key, found.clone());
        found
    }

    fn found(&self, cell: &Cell<i64>) -> Option<Evidence> {
        let scale = (-f64::from(BITS)).exp2();
        let number = |x: &Interval<i64>| (self.number)([x.lo as f64 * scale, x.hi as f64 * scale]);
        let edges: Vec<[E::Number; 3]> =
            cell.edges()?.iter().map(|edge| edge.each_ref().map(number)).collect();
        // Away from the face's own corner, what is shown about it is no more than what is shown about
        // the centre.
        let corner = Evidence::Corner(self.part.face);
        let end = |edge: &Interval<i64>| match self.part.face {
            Corner::Q1 => edge.lo == 0,
            Corner::Q2 => edge.hi == 1 << BITS,
        };
        let touches = cell.0.iter().take(2).all(end);
        let tried = [Some(Evidence::Mirror), Some(Evidence::Test), touches.then_some(corner)];
        tried
            .into_iter()
            .flatten()
            .find(|evidence| self.part.shows(self.arithmetic, &edges, evidence))
    }

    /// What halving a cell along `k` is worth: a half that closes 4, else for each of its own halves
    /// that then closes 1, along its best coordinate.
    fn worth(&self, cell: &Cell<i64>, k: usize, each: u32) -> u32 {
        let of = |half: Cell<i64>| match self.closing(&half) {
            Some(_) => each,
            None if each == 1 => 0,
            None => (0..3).map(|k| self.worth(&half, k, 1)).max().unwrap_or(0),
        };
        cell.halves(k).into_iter().flatten().map(of).sum()
    }

    /// The tree over a cell: halved along the coordinate along which most of it closes.
    fn grow(&self, nodes: &mut Vec<Node>, cell: &Cell<i64>, left: &mut usize) -> Option<()> {
        *left = left.checked_sub(1)?;
        if let Some(evidence) = self.closing(cell) {
            nodes.push(Node { by: vec![Step(0, evidence)], ..Node::default() });
            return Some(());
        }
        // On a tie the first of y, z, kappa.
        let k = (0..3).rev().max_by_key(|&k| self.worth(cell, k, 4))?;
        nodes.push(Node { split: Some(k), ..Node::default() });
        cell.halves(k)?.iter().try_for_each(|half| self.grow(nodes, half, left))
    }
}

/// The proof of a claim, if each part has one of at most so many boxes.
pub fn prove(claim: &PostulateClaim, most: usize) -> Option<Tree> {
    let mut nodes = Vec::new();
    for part in &parts(claim).ok()? {
        let number = |[lo, hi]: [f64; 2]| -> Pair { (lo, hi) };
        let search = Search { part, arithmetic: &Rough, number, tried: RefCell::default() };
        search.grow(&mut nodes, &part.root(BITS).ok()?, &mut most.clone())?;
    }
    Some(Tree { precision: BITS, chords: None, nodes })
}

fn claim(psi_max: &str) -> PostulateClaim {
    serde_json::from_str(&format!(r#"{{"psi_max":{psi_max}}}"#)).expect("a claim")
}

fn certificate(claim: PostulateClaim, tree: Tree) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Postulate(claim),
        verdict: Verdict::Certified,
        proof: Proof::Tree(tree),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}

/// Its proof, which is accepted.
pub fn accepted(psi_max: &str) -> Certificate {
    let tree = prove(&claim(psi_max), 500).expect("a proof");
    let certificate = certificate(claim(psi_max), tree);
    let text = certificate.to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    assert_eq!(read, certificate);
    check(&read).unwrap_or_else(|e| panic!("{psi_max}: {e}"));
    read
}

#[test]
fn for_one_for_a_range_and_for_every_psi_max() {
    for psi in ["1.000000001", "1.37", "2", "7/3", "sqrt(5)", "1000000000"] {
        accepted(&format!("\"{psi}\""));
    }
    accepted(r#"{"min":"1.2","max":"6.5"}"#);
    let all = accepted(r#""all""#);
    assert!(all.to_text().expect("a text").len() < 1100);
    // Beyond words too.
    let mut tree = prove(&claim(r#""all""#), 500).expect("a proof");
    tree.precision = 80;
    check(&certificate(claim(r#""all""#), tree.clone())).expect("accepted");
    tree.precision = 31;
    let found = check(&certificate(claim(r#""all""#), tree));
    assert_eq!(found, Err(Rejected::Precision(31)));
}

#[test]
fn in_words() {
    for (psi, sentence) in [
        (r#""all""#, "For every psi_max > 1,"),
        (r#""2""#, "For psi_max = 2,"),
        (r#"{"min":"1.2","max":"6.5"}"#, "For every psi_max from 1.2 to 6.5,"),
    ] {
        let words = statement(&claim(psi));
        assert!(words.contains(sentence) && words.contains("1/psi_max <= psi_i <= psi_max"));
    }
}

#[test]
fn claims_that_are_not_well_formed() {
    let all = prove(&claim(r#""all""#), 500).expect("a proof");
    for psi in [
        r#""1""#,
        r#""0.5""#,
        r#""-2""#,
        r#"{"min":"0","max":"2"}"#,
        r#""every""#,
        r#""sqrt(-1)""#,
        r#"{"min":"1","max":"2"}"#,
        r#"{"min":"2","max":"2"}"#,
        r#"{"min":"3","max":"2"}"#,
        // Not told from 2.
        r#""sqrt(2)*sqrt(2)""#,
    ] {
        let found = check(&certificate(claim(psi), all.clone()));
        assert!(matches!(found, Err(Rejected::Claim(_))), "{psi}: {found:?}");
    }
}

#[test]
fn proofs_that_show_less() {
    let good = prove(&claim(r#""all""#), 500).expect("a proof");
    let with = |psi: &str, change: &dyn Fn(&mut Vec<Node>)| {
        let mut tree = good.clone();
        change(&mut tree.nodes);
        check(&certificate(claim(psi), tree))
    };
    let every = |change: &dyn Fn(&mut Vec<Node>)| with(r#""all""#, change);
    every(&|_| {}).expect("accepted");
    // Other trees than the parts that are needed.
    assert!(with(r#""2""#, &|_| {}).is_err());
    let two = prove(&claim(r#""2""#), 500).expect("a proof");
    assert!(check(&certificate(claim(r#""3""#), two)).is_err());
    let last = good.nodes.len() - 1;
    assert_eq!(every(&|nodes| drop(nodes.pop())), Err(Rejected::Shape(last)));
    let one_more = every(&|nodes| nodes.push(Node::default()));
    assert_eq!(one_more, Err(Rejected::Shape(last + 1)));
    assert_eq!(every(&Vec::clear), Err(Rejected::Shape(1)));
    let mirrors = good.nodes.iter().filter(|node| node.by == [Step(0, Evidence::Mirror)]);
    assert!(mirrors.count() > 0);
    for (at, node) in good.nodes.iter().enumerate() {
        let of = |by: Vec<Step>| every(&|nodes| nodes[at].by.clone_from(&by));
        if node.by.is_empty() {
            continue;
        }
        let step = Err(Rejected::Step(at, 0));
        assert_eq!(of(Vec::new()), Err(Rejected::Open(at, 0)));
        if node.by != [Step(0, Evidence::Mirror)] {
            assert_eq!(of(vec![Step(0, Evidence::Mirror)]), step);
        }
        // About a tight corner no vertex may be the corner itself.
        if matches!(node.by[..], [Step(0, Evidence::Corner(_))]) {
            assert_eq!(of(vec![Step(0, Evidence::Test)]), step);
        }
        let is_first = at < good.nodes.len() / 4;
        let other = if is_first { Corner::Q2 } else { Corner::Q1 };
        let faces = of(vec![Step(0, Evidence::Corner(other))]);
        assert!(faces == step || !is_first && at < last / 2);
        for evidence in [Evidence::Cube, Evidence::Outside, Evidence::Divided] {
            assert_eq!(of(vec![Step(0, evidence)]), step);
        }
        let mut twice = node.by.clone();
        twice.extend(node.by.clone());
        let repeated = Err(Rejected::Repeated(at, 0));
        assert_eq!(of(twice), repeated);
        let repeated = Err(Rejected::Repeated(at, 1));
        assert_eq!(of(vec![Step(1, node.by[0].1.clone())]), repeated);
        let fails = every(&|nodes| nodes[at].fails = Some(Failure::Reach));
        assert_eq!(fails, Err(Rejected::Shape(at)));
        let moved = every(&|nodes| nodes[at].at = vec![0; 3]);
        assert_eq!(moved, Err(Rejected::Shape(at)));
    }
}

/// The nodes of each tree.
fn trees(nodes: &[Node]) -> Vec<Vec<Node>> {
    let (mut all, mut open) = (vec![Vec::new()], 1);
    for node in nodes {
        if open == 0 {
            all.push(Vec::new());
            open = 1;
        }
        open = if node.split.is_some() { open + 1 } else { open - 1 };
        all.last_mut().expect("a tree").push(node.clone());
    }
    all
}

#[test]
fn every_part_is_needed_and_in_its_place() {
    let good = prove(&claim(r#""all""#), 500).expect("a proof");
    let all = trees(&good.nodes);
    assert_eq!(all.len(), 4);
    let with = |psi: &str, trees: &[Vec<Node>]| {
        check(&certificate(claim(psi), Tree { nodes: trees.concat(), ..good.clone() }))
    };
    with(r#""all""#, &all).expect("accepted");
    for i in 0..4 {
        let mut without = all.clone();
        without.remove(i);
        assert!(with(r#""all""#, &without).is_err(), "without part {i}");
        let mut doubled = all.clone();
        doubled.insert(i, all[i].clone());
        assert!(with(r#""all""#, &doubled).is_err(), "part {i} twice");
        for j in 0..i {
            let mut exchanged = all.clone();
            exchanged.swap(i, j);
            assert!(with(r#""all""#, &exchanged).is_err(), "parts {i} and {j}");
        }
        // A mirror alone proves nothing: its image has to be proved.
        let mut mirrored = all.clone();
        mirrored[i] = vec![Node { by: vec![Step(0, Evidence::Mirror)], ..Node::default() }];
        let at = all[..i].iter().map(Vec::len).sum();
        let step = Err(Rejected::Step(at, 0));
        assert_eq!(with(r#""all""#, &mirrored), step, "part {i}");
        // There are three coordinates.
        let mut split = all.clone();
        let node = split[i].iter().position(|node| node.split.is_some()).expect("a split");
        split[i][node].split = Some(3);
        assert_eq!(with(r#""all""#, &split), Err(Rejected::Shape(at + node)), "part {i}");
    }
    // For psi_max up to 2 there is no part below kappa = 1/2; the least psi_max does not matter.
    let range = |min: &str, max: &str| format!(r#"{{"min":"{min}","max":"{max}"}}"#);
    for (psi, count) in [
        (range("1.5", "2"), 2),
        (range("1.2", "1.5"), 2),
        (range("1.5", "2.5"), 4),
        (range("3", "4"), 4),
    ] {
        let own = parts(&claim(&psi)).expect("well formed");
        assert_eq!(own.len(), count, "{psi}");
        for pair in own.windows(2).filter(|pair| pair[0].face == pair[1].face) {
            assert_eq!(pair[0].greatest, pair[1].least, "{psi}");
        }
        let to_one = own.iter().filter(|part| part.greatest.to_string() == "1");
        assert_eq!(to_one.count(), 2, "{psi}");
    }
    let narrow = prove(&claim(&range("1.2", "1.5")), 500).expect("a proof");
    for psi in [range("1.5", "3.5"), range("1.2", "2"), r#""all""#.to_owned()] {
        assert!(check(&certificate(claim(&psi), narrow.clone())).is_err(), "{psi}");
    }
}

#[test]
fn verdicts_and_claims_of_another_kind() {
    let good = prove(&claim(r#""2""#), 500).expect("a proof");
    let whole = certificate(claim(r#""2""#), good);
    let refuted = Certificate { verdict: Verdict::Refuted, ..whole.clone() };
    assert_eq!(check(&refuted), Err(Rejected::Verdict));
    let fails = Failure::Reach;
    let witness = Witness { precision: 52, point: Vec::new(), machine: Vec::new(), fails };
    for verdict in [Verdict::Certified, Verdict::Refuted] {
        let proof = Proof::Witness(witness.clone());
        assert_eq!(check(&Certificate { verdict, proof, ..whole.clone() }), Err(Rejected::Verdict));
    }
    let cube = r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},"require":[{"quantity":"transmission","end":"max","bound":"2"}]}"#;
    let machine = Claim::Machine(serde_json::from_str(cube).expect("a claim"));
    let of_machine = |nodes: Vec<Node>| {
        let proof = Proof::Tree(Tree { precision: 52, chords: None, nodes });
        check(&Certificate { claim: machine.clone(), proof, ..whole.clone() })
    };
    let Proof::Tree(tree) = &whole.proof else { panic!("a tree") };
    assert!(of_machine(tree.nodes.clone()).is_err());
    let mirror = Node { by: vec![Step(0, Evidence::Mirror)], ..Node::default() };
    assert_eq!(of_machine(vec![mirror]), Err(Rejected::Step(0, 0)));
}

#[test]
fn mirrored_is_what_is_nowhere_beyond_the_diagonal() {
    let part = &parts(&claim(r#""all""#)).expect("well formed")[0];
    let edge = |index: u32, level: u32| {
        let ends = [index, index + 1].map(|i| f64::from(i) / f64::from(1u32 << level));
        let centre = (ends[0] + ends[1]) / 2.0;
        [(centre, centre), (ends[0], ends[1]), (centre - ends[0], centre - ends[0])]
    };
    for (a, b) in [(0, 0), (1, 3), (3, 1), (2, 2), (4, 3)] {
        for (y, z) in (0..1 << a).flat_map(|y| (0..1 << b).map(move |z| (y, z))) {
            let edges = [edge(y, a), edge(z, b), edge(0, 1)];
            let mirrored = part.shows(&Rough, &edges, &Evidence::Mirror);
            assert_eq!(mirrored, edges[0][1].0 >= edges[1][1].1, "{y}/2^{a} {z}/2^{b}");
        }
    }
}

/// `sym(M) - kappa I` of the paper's formulas, at `u` of a face.
fn least_eigenvalue(face: Corner, kappa: f64, [y, z]: [f64; 2]) -> Option<f64> {
    let (t1, t2) = ((1.0 - kappa) / 2.0, (1.0 - kappa).min((1.0 / kappa - 1.0) / 2.0));
    let c = |t: f64| t / (1.0 + 2.0 * t * t).sqrt();
    let (q1, q2) = (-c(t1), c(t2));
    let at = |u: f64| q1 + u * (q2 - q1);
    let x = if face == Corner::Q1 { q1 } else { q2 };
    let p = [x, at(y), at(z)];
    let s: Vec<f64> =
        (0..3).map(|i| 1.0 - p[(i + 1) % 3].powi(2) - p[(i + 2) % 3].powi(2)).collect();
    let m = Matrix3::from_fn(|i, j| if i == j { 1.0 } else { p[j] / s[i].sqrt() });
    let shifted = (m + m.transpose()) / 2.0 - Matrix3::identity() * kappa;
    s.iter().all(|&s| s > 0.0).then(|| SymmetricEigen::new(shifted).eigenvalues.min())
}

/// Whatever is shown of a random cell, within the face or beyond, is true of its points.
#[test]
fn what_is_shown_is_true() {
    let all = parts(&claim(r#""all""#)).expect("well formed");
    let mut state = 3u64;
    let mut random = |from: f64, to: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        from + (to - from) * ((state >> 11) as f64 / (1u64 << 53) as f64)
    };
    let mut shown = [0; 2];
    for (number, part) in all.iter().enumerate() {
        let is_low = number % 2 == 0;
        for _ in 0..3000 {
            let mut edge = |from: f64, to: f64, widest: f64| {
                let (centre, half) = (random(from, to), random(0.0, widest));
                [centre - half, centre + half]
            };
            let (y, z) = (edge(-0.2, 1.2, 0.3), edge(-0.2, 1.2, 0.3));
            let kappa = if is_low { edge(0.0, 0.5, 0.2) } else { edge(0.5, 1.0, 0.2) };
            let bounds = if is_low { [0.001, 0.5] } else { [0.5, 0.999] };
            let kappa = kappa.map(|k| k.clamp(bounds[0], bounds[1]));
            let pair = |[lo, hi]: [f64; 2]| {
                let centre = (lo + hi) / 2.0;
                [(centre, centre), (lo, hi), (hi - centre, hi - centre)]
            };
            let edges = [pair(y), pair(z), pair(kappa)];
            for (which, evidence) in
                [Evidence::Test, Evidence::Corner(part.face)].into_iter().enumerate()
            {
                if !part.shows(&Rough, &edges, &evidence) {
                    continue;
                }
                shown[which] += 1;
                for i in 0..27 {
                    let at = |[lo, hi]: [f64; 2], i: i32| lo + (hi - lo) * f64::from(i % 3) / 2.0;
                    let (u, k) = ([at(y, i), at(z, i / 3)], at(kappa, i / 9));
                    // About a corner nothing is said of what is beyond it.
                    if which == 1 && u.iter().any(|u| !(0.0..=1.0).contains(u)) {
                        continue;
                    }
                    let least = least_eigenvalue(part.face, k, u).expect("within reach");
                    assert!(least >= -1e-9, "{:?} {k} {u:?}: {least}", part.face);
                }
            }
        }
    }
    assert!(shown.iter().all(|&shown| shown > 500), "{shown:?}");
}

/// At points, what is definite is shown, and nothing else: `F` is the paper's matrix.
#[test]
fn the_matrix_is_the_papers() {
    let all = parts(&claim(r#""all""#)).expect("well formed");
    let mut found = [0; 2];
    for (number, part) in all.iter().enumerate() {
        for i in 0..1000 {
            let u = [f64::from(i % 10), f64::from(i / 10 % 10)].map(|u| u * 0.2 - 0.4);
            let kappa = f64::from(i / 100) * 0.05 + if number % 2 == 0 { 0.02 } else { 0.51 };
            let edges = [u[0], u[1], kappa].map(|x| [(x, x), (x, x), (0.0, 0.0)]);
            let least = least_eigenvalue(part.face, kappa, u);
            if least.is_some_and(|least| least.abs() < 1e-9) {
                continue;
            }
            let is_definite = least.is_some_and(|least| least > 0.0);
            assert_eq!(part.shows(&Rough, &edges, &Evidence::Test), is_definite, "{kappa} {u:?}");
            found[usize::from(is_definite)] += 1;
        }
    }
    assert!(found.iter().all(|&found| found > 200), "{found:?}");
}
