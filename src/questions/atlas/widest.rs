//! The design of the widest margin in a map, and how much wider none in it is.
//!
//! The design is looked for by sampling, from the middles of the certified cells on; its margin is
//! certified from below by a tree for its claim, tightened. That no design of the whole box has a
//! margin that is much wider is certified as an atlas is: the tightened claim is refuted in every
//! cell of the box.

use super::certify;
use super::decide::{middle, refuted, FINEST};
use super::part::{assemble, in_order, least_halved, Node};
use crate::design::{without_margin, AtlasDesign, MAX_RESOLUTION};
use crate::exact::Exact;
use crate::questions::frontier::{decimal, NoAnswer};
use crate::search::solver;
use crate::search::solver::margin::{margin, tightened};
use crate::search::{Budget, Control, Stop};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::atlas::{halves, walk, Part};
use orthocert_kernel::certificate::AtlasCell;
use orthocert_kernel::claim::AtlasClaim;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Halvings of a parameter's range down to the grid on which designs are looked for.
const LEVEL: u32 = 24;
/// Certified cells from whose middles is climbed.
const STARTS: usize = 4;
/// Most moves with one length of step.
const MOVES: usize = 16;
/// Halvings of the step while climbing, beyond the map's resolution.
const FINER: u32 = 6;
/// By how much, relatively, the margin that is certified may fall short of the sampled one: the
/// first that is proved is taken.
const SHORT: [f64; 5] = [1e-4, 1e-3, 1e-2, 0.1, 0.5];
/// By how much, relatively, the margin that no design has may be beyond it: the least that is
/// proved is taken.
const BEYOND: [f64; 7] = [1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0];
/// The first of these that is tried.
const FIRST: usize = 3;
/// Relative accuracy of a margin's decimal.
const ACCURACY: f64 = 1e-4;
/// Most cells tried for a bound, and how many side by side.
const TRIES: usize = 6_000;
const BATCH: usize = 32;

/// A design with a wide margin.
#[derive(Clone, Debug)]
pub struct Widest {
    /// Its parameters.
    pub at: Vec<Exact>,
    /// Its claim holds tightened by one more than this.
    pub margin: Exact,
    /// The certificate of that.
    pub certificate: Box<Certificate>,
    /// What no design of the box has, if that was proved of anything.
    pub bound: Option<Bound>,
}

/// A margin that no design of the box has.
#[derive(Clone, Debug)]
pub struct Bound {
    /// No design's claim holds tightened by one more than this.
    pub margin: Exact,
    /// The certificate of that: an atlas all of whose cells are refuted.
    pub certificate: Box<Certificate>,
}

/// The design of the widest margin that is found and certified, if margins are defined and the map
/// has a certified cell.
///
/// # Errors
/// If it was cancelled.
pub fn widest(
    design: &AtlasDesign,
    cells: &[AtlasCell],
    cancel: &AtomicBool,
) -> Result<Option<Widest>, NoAnswer> {
    if without_margin(&design.machine).is_some() {
        return Ok(None);
    }
    let mut starts: Vec<Vec<u64>> = Vec::new();
    // The tree's shape was checked with the certificate.
    let _ = walk(cells, design.parameters.len(), |_, part, said| {
        if matches!(said, AtlasCell::Certified(_)) {
            starts.push(in_grid(part));
        }
        Ok(())
    });
    let mut starts: Vec<(f64, Vec<u64>)> =
        starts.into_par_iter().map(|at| (margin_at(design, &at), at)).collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best: Option<(f64, Vec<u64>)> = None;
    for start in starts.into_iter().take(STARTS) {
        let found = climb(design, start, cancel)?;
        if best.as_ref().is_none_or(|best| found.0 > best.0) {
            best = Some(found);
        }
    }
    let Some((sampled, at)) = best.filter(|best| best.0 > 0.0 && best.0.is_finite()) else {
        return Ok(None);
    };
    let Some(mut widest) = certified(design, &at, sampled, cancel)? else {
        return Ok(None);
    };
    widest.bound = bound(design, sampled, cancel)?;
    Ok(Some(widest))
}

/// The middle of a cell, in the grid.
fn in_grid(part: &[(u64, u32)]) -> Vec<u64> {
    // n < 2^level, level <= MAX_RESOLUTION < LEVEL.
    part.iter().map(|(n, level)| (2 * n + 1) << (LEVEL - level - 1)).collect()
}

/// The values of the parameters at a place of the grid.
fn values(design: &AtlasDesign, at: &[u64]) -> Option<Vec<Exact>> {
    let part = |n: &u64| BigRational::new(BigInt::from(*n), BigInt::from(1) << LEVEL);
    design.parameters.iter().zip(at).map(|(parameter, n)| parameter.at(&part(n))).collect()
}

fn margin_at(design: &AtlasDesign, at: &[u64]) -> f64 {
    values(design, at).map_or(-1.0, |values| margin(&design.at(&values), FINEST))
}

/// Moves to the best neighbour, diagonal ones among them, while that is better, with steps of half
/// the length each time.
fn climb(
    design: &AtlasDesign,
    start: (f64, Vec<u64>),
    cancel: &AtomicBool,
) -> Result<(f64, Vec<u64>), NoAnswer> {
    let mut best = start;
    for halving in 1..=(design.resolution + FINER).min(LEVEL) {
        let step = 1i64 << (LEVEL - halving);
        for _ in 0..MOVES {
            if cancel.load(Ordering::Relaxed) {
                return Err(NoAnswer::Cancelled);
            }
            let found: Vec<(f64, Vec<u64>)> = neighbours(&best.1, step)
                .into_par_iter()
                .map(|at| (margin_at(design, &at), at))
                .collect();
            let better = found.into_iter().filter(|found| found.0 > best.0);
            // The first of equals.
            match better.reduce(|a, b| if b.0 > a.0 { b } else { a }) {
                Some(better) => best = better,
                None => break,
            }
        }
    }
    Ok(best)
}

/// The places a step away, along axes and diagonals, within the box.
fn neighbours(at: &[u64], step: i64) -> Vec<Vec<u64>> {
    let moves = 3usize.pow(at.len() as u32);
    let place = |number: usize| -> Option<Vec<u64>> {
        let along = |(axis, x): (usize, &u64)| {
            let sign = (number / 3usize.pow(axis as u32) % 3) as i64 - 1;
            let moved = i64::try_from(*x).ok()? + sign * step;
            u64::try_from(moved).ok().filter(|x| *x <= 1 << LEVEL)
        };
        at.iter().enumerate().map(along).collect()
    };
    (0..moves).filter_map(place).filter(|place| place != at).collect()
}

/// The design there, with the greatest margin of some near the sampled one that is proved.
fn certified(
    design: &AtlasDesign,
    at: &[u64],
    sampled: f64,
    cancel: &AtomicBool,
) -> Result<Option<Widest>, NoAnswer> {
    let Some(at) = values(design, at) else { return Ok(None) };
    let claim = design.at(&at);
    for short in SHORT {
        let Some(margin) = decimal(sampled * (1.0 - short), ACCURACY) else {
            continue;
        };
        let Some(claim) = tightened(&claim, &margin) else {
            continue;
        };
        // As for a cell, and some more: there is nothing else to fall back on.
        let budget = Budget { max_boxes: 10 * design.boxes, deadline: None };
        let mut control = Control { cancel, progress: &mut |_| {} };
        match solver::proof(&claim, budget, &mut control) {
            Ok(certificate) => {
                let margin = Exact::Rational(margin);
                return Ok(Some(Widest { at, margin, certificate, bound: None }));
            }
            Err(Stop::Cancelled) => return Err(NoAnswer::Cancelled),
            Err(_) => {}
        }
    }
    Ok(None)
}

/// The least bound of those beyond `sampled` that is found to be proved.
fn bound(
    design: &AtlasDesign,
    sampled: f64,
    cancel: &AtomicBool,
) -> Result<Option<Bound>, NoAnswer> {
    let mut found = bounded(design, sampled * (1.0 + BEYOND[FIRST]), cancel)?;
    if found.is_some() {
        for beyond in BEYOND[..FIRST].iter().rev() {
            match bounded(design, sampled * (1.0 + beyond), cancel)? {
                None => break,
                better => found = better,
            }
        }
        return Ok(found);
    }
    for beyond in &BEYOND[FIRST + 1..] {
        found = bounded(design, sampled * (1.0 + beyond), cancel)?;
        if found.is_some() {
            break;
        }
    }
    Ok(found)
}

/// The proof that no design of the box has this margin.
fn bounded(
    design: &AtlasDesign,
    margin: f64,
    cancel: &AtomicBool,
) -> Result<Option<Bound>, NoAnswer> {
    let Some(margin) = decimal(margin, ACCURACY) else {
        return Ok(None);
    };
    let Some(machine) = tightened(&design.machine, &margin) else {
        return Ok(None);
    };
    let margin = Exact::Rational(margin);
    let design = AtlasDesign { machine, ..design.clone() };
    let Some(cells) = all_refuted(&design, cancel)? else {
        return Ok(None);
    };
    let certificate = certify(&design, cells).ok().map(|(certificate, ..)| Box::new(certificate));
    Ok(certificate.map(|certificate| Bound { margin, certificate }))
}

/// A tree every cell of which is refuted; `None` if one is not at the finest resolution, or there
/// are too many. The halves in whose middle the margin is wider come first: what will not do is
/// seen early.
fn all_refuted(
    design: &AtlasDesign,
    cancel: &AtomicBool,
) -> Result<Option<Vec<AtlasCell>>, NoAnswer> {
    let claim = design.claim();
    let finest = (design.resolution + FINER).min(u32::try_from(MAX_RESOLUTION).unwrap_or(0));
    let mut nodes = vec![Node::Waiting];
    let mut waiting = vec![(0, design.whole())];
    let mut tries = 0;
    while !waiting.is_empty() {
        if cancel.load(Ordering::Relaxed) {
            return Err(NoAnswer::Cancelled);
        }
        let batch = waiting.split_off(waiting.len().saturating_sub(BATCH));
        tries += batch.len();
        if tries > TRIES {
            return Ok(None);
        }
        let tried: Vec<Tried> =
            batch.par_iter().map(|(_, cell)| tried(design, &claim, cell, finest)).collect();
        for ((at, _), tried) in batch.into_iter().zip(tried) {
            match tried {
                Tried::Refuted(cell) => nodes[at] = Node::Leaf(cell),
                Tried::Split(axis, first_upper, [lower, upper]) => {
                    let first = nodes.len();
                    nodes.extend([Node::Waiting, Node::Waiting]);
                    nodes[at] = Node::Split(axis, [first, first + 1]);
                    let mut halves = [(first, lower), (first + 1, upper)];
                    if !first_upper {
                        halves.reverse();
                    }
                    waiting.extend(halves);
                }
                Tried::Open => return Ok(None),
            }
        }
    }
    Ok(assemble(in_order(nodes), Vec::new()))
}

/// What became of a cell.
enum Tried {
    Refuted(AtlasCell),
    /// The axis along which it is split, whether the upper half comes first, and both.
    Split(usize, bool, [Part; 2]),
    Open,
}

fn tried(design: &AtlasDesign, claim: &AtlasClaim, part: &Part, finest: u32) -> Tried {
    if let Some(refuted) = refuted(design, claim, part) {
        return Tried::Refuted(refuted);
    }
    let axis = least_halved(part, finest);
    let Some((axis, both)) = axis.and_then(|axis| Some((axis, halves(part, axis)?))) else {
        return Tried::Open;
    };
    let [below, above] = both.each_ref().map(|half| {
        middle(design, half).map_or(-1.0, |values| margin(&design.at(&values), FINEST))
    });
    if below.max(above) > 0.0 {
        // Some design of the cell seems to have the margin.
        return Tried::Open;
    }
    Tried::Split(axis, above > below, both)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::questions::atlas::{grow, Growing};
    use orthocert_checker::certificate::Verdict;

    /// Orthoglides on the cube of the paper's place, by its side; psi within [1/2, 2].
    fn orthoglides() -> AtlasDesign {
        let text = "[parameters]\nside = { min = \"0.3\", max = \"0.7\" }\n[atlas]\nresolution = 4\n\
                    boxes = 300\nobjective = \"widest margin\"\n[mechanism]\nkind = \"orthoglide\"\n\
                    leg_length = 1\n[workspace]\n\
                    min = [\"-side*(sqrt(3)-1)/2\", \"-side*(sqrt(3)-1)/2\", \"-side*(sqrt(3)-1)/2\"]\n\
                    max = [\"side*(3-sqrt(3))/2\", \"side*(3-sqrt(3))/2\", \"side*(3-sqrt(3))/2\"]\n\
                    [requirements]\ntransmission = { min = \"1/2\", max = 2 }\n";
        AtlasDesign::parse(text, "test").unwrap()
    }

    #[test]
    fn the_widest_margin_is_between_its_two_certificates() {
        let (design, cancel) = (orthoglides(), AtomicBool::new(false));
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let top = grow(&mut Growing::new(&design, &mut control), design.whole(), None).unwrap();
        let cells = assemble(top, Vec::new()).unwrap();
        let Widest { at, margin, certificate, bound } =
            widest(&design, &cells, &cancel).unwrap().unwrap();
        // The smallest cube: at one of its corners c = side (3 - sqrt 3)/2 and t = c/sqrt(1 - 2c^2),
        // the greatest singular value is 1 + 2t, at most 2.
        let c = 0.3 * (3.0 - 3f64.sqrt()) / 2.0;
        let widest = 2.0 / (1.0 + 2.0 * c / (1.0 - 2.0 * c * c).sqrt()) - 1.0;
        let bound = bound.unwrap();
        let near = |x: &Exact| crate::exact::decimal::approximate(x).unwrap();
        assert_eq!(at, [Exact::parse("3/10", 10).unwrap()]);
        assert!((0.999 * widest..=widest).contains(&near(&margin)), "{margin}");
        assert!((widest..=1.02 * widest).contains(&near(&bound.margin)), "{}", bound.margin);
        for certificate in [certificate, bound.certificate] {
            let accepted = crate::search::accepted::check(&certificate).unwrap();
            assert_eq!(accepted.verdict, Verdict::Certified);
        }
    }

    #[test]
    fn a_margin_that_some_design_has_is_no_bound() {
        let (design, cancel) = (orthoglides(), AtomicBool::new(false));
        for had in [0.01, 0.1, 0.3] {
            assert!(bounded(&design, had, &cancel).unwrap().is_none(), "{had}");
        }
        assert!(bounded(&design, 0.8, &cancel).unwrap().is_some());
        cancel.store(true, Ordering::Relaxed);
        assert!(matches!(bounded(&design, 0.8, &cancel), Err(NoAnswer::Cancelled)));
    }

    #[test]
    fn neighbours_stay_within_the_box() {
        let end = 1 << LEVEL;
        assert_eq!(neighbours(&[0], 4), [vec![4]]);
        assert_eq!(neighbours(&[end], 4), [vec![end - 4]]);
        assert_eq!(neighbours(&[8, 8], 4).len(), 8);
        assert_eq!(neighbours(&[0, end], 4).len(), 3);
    }
}
