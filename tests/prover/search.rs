//! The search: the same tree for every number of threads, nothing lost, budgets kept.

use super::machines::{cube, linear_delta, orthoglide, skew_guides};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert::interval::Interval;
use orthocert::search::{search, Budget, Control, Outcome, Stop};
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::Node;
use orthocert_checker::claim::{MachineClaim, Range};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::model::Model;
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

fn searched(claim: &MachineClaim, max_boxes: usize) -> Outcome {
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let model = Model::new(claim, 192).unwrap().map(&Interval::from_fixed);
    search(&model, Budget { max_boxes, deadline: None }, &mut control)
}

fn with_bounds(mut claim: MachineClaim, min: &str, max: &str) -> MachineClaim {
    let exact = super::machines::exact;
    let range = Range { min: Some(exact(min)), max: Some(exact(max)) };
    claim.requirements.transmission = Some(range);
    claim
}

/// Claims with trees from a few boxes to a few thousand; the last one is false in places.
fn claims() -> Vec<(&'static str, MachineClaim)> {
    let mut narrow = linear_delta();
    if let orthocert_checker::claim::Workspace::Box { min, max } = &mut narrow.workspace {
        for k in 0..2 {
            (min[k], max[k]) = (super::machines::exact("-60"), super::machines::exact("60"));
        }
    }
    vec![
        ("prototype", cube("2", "200")),
        ("cube, psi_max = 1000", cube("1000", "200")),
        ("linear delta", with_bounds(narrow, "0.5129", "1.5134")),
        ("box", with_bounds(orthoglide("310.6", "-73.2", "126.7"), "0.4999", "2.0001")),
        ("skew guides, false", with_bounds(skew_guides(), "1/2", "2")),
    ]
}

/// The leaves of a tree in preorder.
fn leaves(nodes: &[Node]) -> Vec<Cell> {
    let (mut waiting, mut leaves) = (vec![Cell::ROOT], Vec::new());
    for node in nodes {
        let cell = waiting.pop().expect("no node after the tree");
        match node.split {
            Some(axis) => {
                let (lower, upper) = cell.halves(axis).unwrap();
                waiting.extend([upper, lower]);
            }
            None => leaves.push(cell),
        }
    }
    assert!(waiting.is_empty(), "{} boxes without a node", waiting.len());
    leaves
}

fn volume(cell: &Cell) -> BigRational {
    let depth: u32 = cell.edges.iter().map(|edge| edge.level).sum();
    BigRational::new(1.into(), BigInt::from(1) << depth)
}

/// The interior of both cells has a point in common.
fn overlap(a: &Cell, b: &Cell) -> bool {
    a.edges.iter().zip(&b.edges).all(|(a, b)| {
        let level = a.level.max(b.level);
        let (low, high) = (a.index << (level - a.level), (a.index + 1) << (level - a.level));
        let (least, most) = (b.index << (level - b.level), (b.index + 1) << (level - b.level));
        low < most && least < high
    })
}

#[test]
fn leaves_tile_the_workspace() {
    for (name, claim) in claims() {
        let outcome = searched(&claim, 3000);
        let leaves = leaves(&outcome.nodes);
        let one = BigRational::from_integer(1.into());
        assert_eq!(leaves.iter().map(volume).sum::<BigRational>(), one, "{name}");
        if leaves.len() < 400 {
            for (i, a) in leaves.iter().enumerate() {
                assert!(leaves[..i].iter().all(|b| !overlap(a, b)), "{name}: {a}");
            }
        }
        // What is open are leaves, and every leaf without a way out is among them.
        let all: BTreeSet<String> = leaves.iter().map(Cell::to_string).collect();
        assert!(outcome.open.iter().all(|open| all.contains(&open.cell.to_string())), "{name}");
        assert!(outcome.open.iter().all(|open| !open.open.is_empty()), "{name}");
        assert_eq!(outcome.open.is_empty(), name != "skew guides, false", "{name}");
    }
}

#[test]
fn the_tree_is_the_same_for_every_number_of_threads() {
    for (name, claim) in claims() {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| searched(&claim, 2500))
        };
        let one = on(1);
        for threads in [2, 4, 16] {
            let many = on(threads);
            assert_eq!(many.nodes, one.nodes, "{name}: {threads} threads");
            assert_eq!((many.boxes, many.stop), (one.boxes, one.stop), "{name}: {threads} threads");
            let cells = |outcome: &Outcome| -> Vec<Cell> {
                outcome.open.iter().map(|open| open.cell).collect()
            };
            assert_eq!(cells(&many), cells(&one), "{name}: {threads} threads");
        }
    }
}

#[test]
fn budgets_are_kept_and_return_what_is_left() {
    let (_, claim) = claims().swap_remove(2);
    let full = searched(&claim, usize::MAX);
    assert!(full.open.is_empty() && full.stop == Stop::Exhausted && full.boxes > 60);
    for max_boxes in [0, 1, 2, 3, 10, full.boxes - 1] {
        let part = searched(&claim, max_boxes);
        assert_eq!((part.boxes, part.stop), (max_boxes, Stop::Boxes));
        assert!(!part.open.is_empty(), "{max_boxes}");
        // Closed and open leaves together are the workspace still.
        let total: BigRational = leaves(&part.nodes).iter().map(volume).sum();
        assert_eq!(total, BigRational::from_integer(1.into()), "{max_boxes}");
        let tried = part.open.iter().flat_map(|open| &open.open).filter(|(_, f)| f.is_some());
        assert!(max_boxes > 0 || tried.count() == 0, "nothing was tried, nothing can have failed");
    }
    assert_eq!(searched(&claim, full.boxes).stop, Stop::Exhausted);
}

#[test]
fn deadlines_and_cancellation_end_the_search_with_everything_left() {
    let claim = cube("2", "200");
    let model = Model::new(&claim, 192).unwrap().map(&Interval::from_fixed);
    for (cancelled, deadline, stop) in
        [(true, None, Stop::Cancelled), (false, Some(Instant::now()), Stop::Time)]
    {
        let cancel = AtomicBool::new(cancelled);
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let outcome = search(&model, Budget { max_boxes: 1000, deadline }, &mut control);
        assert_eq!((outcome.stop, outcome.boxes), (stop, 0));
        assert_eq!(outcome.open.len(), 1);
        assert_eq!(outcome.open[0].cell, Cell::ROOT);
    }
}

#[test]
fn progress_never_falls_and_ends_at_the_whole() {
    let claim = cube("20", "200");
    let model = Model::new(&claim, 192).unwrap().map(&Interval::from_fixed);
    let mut seen = Vec::new();
    let cancel = AtomicBool::new(false);
    let mut note = |progress: orthocert::search::Progress| seen.push(progress);
    let mut control = Control { cancel: &cancel, progress: &mut note };
    let outcome = search(&model, Budget { max_boxes: 1000, deadline: None }, &mut control);
    assert!(seen.windows(2).all(|w| w[0].boxes < w[1].boxes && w[0].closed <= w[1].closed));
    let last = seen.last().unwrap();
    assert_eq!(last.boxes, outcome.boxes);
    assert!((last.closed - 1.0).abs() < 1e-12);
}
