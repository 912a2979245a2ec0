//! How deep a paving has to go, from samples of its cells.

use super::tree::{Cancelled, Grower, Open, Segment, Tally};
use super::Goal;
use orthocert_kernel::paving::{Cut, Root, SHARE_BITS};
use rayon::prelude::*;

/// Most cells of one depth that are decided; of the undecided ones below more, one of so many. The same
/// where a cell takes far longer.
const MOST: usize = 1024;
const MOST_FOR_ALL: usize = 64;
/// So many of them are cut to see what that leaves, or, first, so few.
const LOOKED: [usize; 2] = [8, 96];
/// What the few find has to be within this of what is aimed at.
const PLAUSIBLE: f64 = 1.5;
/// How many boxes the planes of one that is cut take as long as, about.
const CUT: f64 = 12.0;
/// What is aimed at, relative to the gap that is asked for: the samples err.
const AIM: f64 = 0.99;

/// The least depth at which `goal` is expected to be reached, at least `coarse`, or the greatest at which the
/// boxes are expected to be within their number. `grower` goes to the greatest depth that may be chosen,
/// `segments` are its tree down to `coarse`, whose tally is `above`.
pub fn depth(
    grower: &Grower<'_>,
    segments: &[Segment],
    above: Tally,
    coarse: u32,
    goal: &Goal,
) -> Result<u32, Cancelled> {
    let subtree = |segment: &Segment| match segment {
        Segment::Subtree(root) => Some((*root, None)),
        Segment::Known(_) => None,
    };
    let mut roots: Vec<Open> = segments.iter().filter_map(subtree).collect();
    // No tree has more boxes: nothing is to be chosen.
    let most = roots.len() as f64 * f64::from(grower.depth + 1 - coarse).exp2();
    if goal.gap.is_none() && most < goal.max_boxes as f64 {
        return Ok(if roots.is_empty() { coarse } else { grower.depth });
    }
    let most = if grower.decider.is_for_all() { MOST_FOR_ALL } else { MOST };
    let (mut inner, mut boxes) = (above.inner as f64 * UNIT, above.boxes as f64);
    // How many cells each of the sample stands for.
    let mut scale = 1.0;
    for depth in coarse..grower.depth {
        let mut tally = Tally::default();
        let open = grower.level(&roots, &mut tally)?;
        boxes += tally.boxes as f64 * scale;
        inner += tally.inner as f64 * UNIT * scale;
        let planes = if grower.decider.cuts() { CUT * open.len() as f64 * scale } else { 0.0 };
        if boxes + planes > goal.max_boxes as f64 && depth > coarse {
            return Ok(depth - 1);
        }
        let cells: Vec<Root> = open.iter().map(|(root, _)| *root).collect();
        if open.is_empty()
            || goal.gap.is_some_and(|gap| is_within(grower, &cells, (inner, scale), gap))
        {
            return Ok(depth);
        }
        let one_of = open.len().div_ceil(most);
        let kept = open.iter().step_by(one_of);
        scale *= open.len() as f64 / kept.len() as f64;
        roots = kept.flat_map(|(_, halves)| halves.clone()).collect();
    }
    Ok(grower.depth)
}

const UNIT: f64 = 1.0 / (1u128 << SHARE_BITS) as f64;

/// Whether what is undecided of these cells, each for `scale`, is within the gap once they are cut, beside `inner`.
fn is_within(grower: &Grower<'_>, cells: &[Root], (inner, scale): (f64, f64), gap: f64) -> bool {
    let decider = grower.decider;
    let share = |root: &Root| decider.share(&root.cell);
    let open = cells.iter().map(share).sum::<u128>() as f64 * UNIT * scale;
    if !decider.cuts() || open <= AIM * gap * inner {
        return open <= AIM * gap * inner;
    }
    let looked = LOOKED.into_iter().zip([PLAUSIBLE, 1.0]);
    looked.into_iter().all(|(looked, factor)| {
        let sample: Vec<&Root> = cells.iter().step_by(cells.len().div_ceil(looked)).collect();
        let shares = |root: &&Root| {
            let cut = decider.cut(&root.cell, root.inherited);
            cut.map_or([0, 0], |cut: Cut| cut.shares(share(root)))
        };
        let found: Vec<[u128; 2]> = sample.par_iter().map(shares).collect();
        let of_all = open / sample.iter().map(|root| share(root)).sum::<u128>() as f64;
        let [more, outer] = [0, 1].map(|side| found.iter().map(|x| x[side]).sum::<u128>() as f64);
        let (more, outer) = (more * of_all, outer * of_all);
        open - more - outer <= factor * AIM * gap * (inner + more)
    })
}
