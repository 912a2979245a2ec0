//! Evidence of every kind for cells that hold a point at which the claim is false: none is accepted.

use crate::arithmetic::Random;
use crate::prover::{Prover, BITS};
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::step::Checker;
use orthocert_kernel::test::{Multiplier, Over, Place};

/// One entry changed by up to a part of itself, or by a few units.
fn change(y: &mut Multiplier, random: &mut Random) {
    let rows = y.y.len() as u64;
    let row = &mut y.y[random.below(rows) as usize];
    let entries = row.len() as u64;
    let entry = &mut row[random.below(entries) as usize];
    let most = (entry.unsigned_abs() >> random.below(12)) + 16;
    *entry += random.below(2 * most + 1) as i64 - most as i64;
}

fn changed(evidence: &Evidence, random: &mut Random) -> Evidence {
    let mut evidence = evidence.clone();
    match &mut evidence {
        Evidence::Lower(y) | Evidence::LowerDivided(y) | Evidence::Direction(y) => {
            change(y, random);
        }
        Evidence::Control(inner) => **inner = changed(inner, random),
        Evidence::Accuracy(y, kappa, p) => {
            change(y, random);
            *p = random.below(2) as u32;
            *kappa = *kappa * (50 + random.below(80) as i64) / 100;
        }
        _ => {}
    }
    evidence
}

/// Cells about a point (in the problem's unit) at which the obligation fails for some machine: whatever
/// is proposed for them, and what is near it, shows nothing. Gives how much was tried.
pub fn never_shown(problem: &Problem, at: &[f64], obligation: usize, seed: u64) -> usize {
    let prover = Prover::new(problem);
    let fixed = Fixed::<i64>::new(BITS);
    let parameters = problem.parameters(BITS, &[]).expect("parameters");
    let exact = Checker::new(problem, &fixed, parameters, None).with_chords(prover.chords.clone());
    let test = &problem.obligations[obligation].test;
    let root = problem.root::<i64>(BITS).expect("a box");
    let mut random = Random(seed);
    let mut tried = 0;
    for _ in 0..24 {
        let scale = f64::from(BITS).exp2();
        let most = 1u64 << (BITS - 3 - random.below(30) as u32);
        let edge = |(x, root): (&f64, &Interval<i64>)| {
            let x = ((x * scale) as i64).clamp(root.lo, root.hi);
            let (below, above) = (random.below(most) as i64, random.below(most) as i64 + 1);
            Interval { lo: x - below, hi: x + above }
        };
        let cell = Cell(at.iter().zip(&root.0).map(edge).collect());
        let edges = cell.edges().expect("edges");
        let pair = |x: &Interval<i64>| (x.lo as f64 / scale, x.hi as f64 / scale);
        let rough: Vec<_> = edges.iter().map(|edge| edge.each_ref().map(pair)).collect();
        let values = prover.checker.evaluate(&rough);
        let slopes = Slopes::new(&crate::rough::Rough, rough.len());
        let place = Place::new(&rough, [false; 2]);
        let over = Over::new(&place, slopes, &values);
        let Some(proposals) = prover.proposals(&over, test) else { continue };
        let place = Place::new(&edges, [false; 2]);
        let values = exact.evaluate(&edges);
        let slopes = Slopes::new(&fixed, edges.len());
        let over = Over::new(&place, slopes, &values);
        for evidence in &proposals {
            let mut near: Vec<_> = (0..5).map(|_| changed(evidence, &mut random)).collect();
            if problem.inside.is_some() {
                let multiple = 1 << random.below(20);
                near.push(Evidence::Inside(Box::new(evidence.clone()), multiple, 12));
            }
            for evidence in std::iter::once(evidence).chain(&near) {
                assert!(!exact.shows(&over, test, evidence), "{evidence:?} {cell:?}");
                tried += 1;
            }
        }
    }
    tried
}
