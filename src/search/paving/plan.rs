//! How deep a paving has to go, from a sample of its subtrees.

use super::tree::{Cancelled, Grower, Segment, Tally};
use super::Goal;
use orthocert_kernel::paving::{Root, SHARE_BITS};
use rayon::prelude::*;

/// So many splits below their roots, all subtrees are looked into; deeper, one of so many that are still
/// undecided there, and of few of them more.
const STEP: u32 = 3;
const SAMPLE: usize = 32;
const LEAST: usize = 8;
/// How many boxes the planes of one that is cut take as long as, about.
const CUT: f64 = 20.0;
/// What is aimed at, relative to the gap that is asked for: the sample errs.
const AIM: f64 = 0.99;

/// The depth at which `goal` is expected to be reached, at least `coarse`. `grower` goes to the
/// greatest depth that may be chosen, `segments` are its tree down to `coarse`, whose tally is
/// `above`. What becomes of the undecided volume of all subtrees deeper down is expected to be what
/// becomes of that of the sample.
pub fn depth(
    grower: &Grower<'_>,
    segments: &[Segment],
    above: &Tally,
    coarse: u32,
    goal: &Goal,
) -> Result<u32, Cancelled> {
    let subtree = |segment: &Segment| match segment {
        Segment::Subtree(root) => Some(*root),
        Segment::Known(_) => None,
    };
    let roots: Vec<Root> = segments.iter().filter_map(subtree).collect();
    if roots.is_empty() {
        return Ok(coarse);
    }
    // No tree has more boxes: nothing is to be chosen.
    let most = roots.len() as f64 * f64::from(grower.depth + 1 - coarse).exp2();
    if goal.gap.is_none() && most < goal.max_boxes as f64 {
        return Ok(grower.depth);
    }
    let known = (coarse + STEP).min(grower.depth);
    let (mut all, undecided) = grown(grower, &roots, known)?;
    if let Some(depth) = chosen(&all, above, 1.0, (coarse, coarse..known + 1), goal) {
        return Ok(depth);
    }
    let open = all.open_at[known as usize] as f64;
    all.add(above);
    let one_of = (undecided.len() / LEAST).clamp(1, SAMPLE);
    let sample: Vec<Root> = undecided.into_iter().step_by(one_of).collect();
    let mut reach = known;
    while reach < grower.depth {
        reach = (reach + STEP).min(grower.depth);
        let (found, _) = grown(grower, &sample, reach)?;
        let scale = open / found.open_at[known as usize] as f64;
        let below = (coarse, known + 1..reach + 1);
        if let Some(depth) = chosen(&found, &all, scale, below, goal) {
            return Ok(depth);
        }
    }
    Ok(grower.depth)
}

/// What subtrees come to down to a depth, and those of them that are undecided there.
fn grown(grower: &Grower<'_>, roots: &[Root], depth: u32) -> Result<(Tally, Vec<Root>), Cancelled> {
    let shallow = Grower { depth, ..*grower };
    let tally = |root: &Root| {
        let mut tally = Tally::up_to(grower.depth);
        shallow.grow(*root, &mut Vec::new(), &mut tally)?;
        let is_undecided = tally.open_at[depth as usize] > 0;
        Ok((tally, Vec::from_iter(is_undecided.then_some(*root))))
    };
    let sum = |(mut a, mut of_a): (Tally, Vec<Root>), (b, of_b)| {
        a.add(&b);
        of_a.extend(of_b);
        Ok((a, of_a))
    };
    roots.par_iter().map(tally).try_reduce(|| (Tally::up_to(grower.depth), Vec::new()), sum)
}

/// The least depth of a range at which the goal is expected to be reached, or the greatest at which
/// the boxes are expected to be within their number; `None` where neither is seen. `above` is what is known
/// down to the range, `found` what is found in it of one part of `scale`.
fn chosen(
    found: &Tally,
    above: &Tally,
    scale: f64,
    (coarse, depths): (u32, std::ops::Range<u32>),
    goal: &Goal,
) -> Option<u32> {
    let unit = (-f64::from(SHARE_BITS)).exp2();
    let sum = |x: &[u128]| x.iter().sum::<u128>() as f64 * unit;
    let mut inner = sum(&above.inner_at);
    let mut boxes = above.boxes as f64;
    for depth in depths {
        let at = depth as usize;
        inner += found.inner_at[at] as f64 * unit * scale;
        let cut = found.cut_at[at] as f64 * unit * scale;
        boxes += found.boxes_at[at] as f64 * scale;
        let planes = CUT * found.cuts_at[at] as f64 * scale;
        if boxes + planes > goal.max_boxes as f64 && depth > coarse {
            return Some(depth - 1);
        }
        let left = found.left_at[at] as f64 * unit * scale;
        if goal.gap.is_some_and(|gap| left <= AIM * gap * (inner + cut)) {
            return Some(depth);
        }
    }
    None
}
