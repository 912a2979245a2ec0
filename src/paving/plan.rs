//! How deep a paving has to go, from a sample of its subtrees.

use super::tree::{Cancelled, Grower, Segment, Tally};
use super::Goal;
use orthocert_kernel::paving::{Root, SHARE_BITS};
use rayon::prelude::*;

/// One subtree of this many is looked into.
const SAMPLE: usize = 32;
/// By how many splits each look is deeper than the last.
const STEP: u32 = 3;
/// What is aimed at, relative to the gap that is asked for: the sample errs.
const AIM: f64 = 0.985;

/// The depth at which `goal` is expected to be reached, at least `coarse`. `grower` goes to the
/// greatest depth that may be chosen, `segments` are its tree down to `coarse`, whose tally is
/// `above`.
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
    let sample: Vec<Root> = roots.iter().step_by(SAMPLE).copied().collect();
    if sample.is_empty() {
        return Ok(coarse);
    }
    let scale = roots.len() as f64 / sample.len() as f64;
    let mut reach = coarse;
    while reach < grower.depth {
        reach = (reach + STEP).min(grower.depth);
        let shallow = Grower { depth: reach, ..*grower };
        let found = sample
            .par_iter()
            .map(|root| {
                let mut tally = Tally::up_to(reach);
                shallow.grow(*root, &mut Vec::new(), &mut tally).map(|()| tally)
            })
            .try_reduce(
                || Tally::up_to(reach),
                |mut a, b| {
                    a.add(&b);
                    Ok(a)
                },
            )?;
        if let Some(depth) = chosen(&found, above, scale, coarse..reach + 1, goal) {
            return Ok(depth);
        }
    }
    Ok(grower.depth)
}

/// The least depth of a range at which the goal is expected to be reached, or the greatest at which
/// the boxes are expected to be within their number; `None` where neither is seen.
fn chosen(
    found: &Tally,
    above: &Tally,
    scale: f64,
    depths: std::ops::Range<u32>,
    goal: &Goal,
) -> Option<u32> {
    let unit = (-f64::from(SHARE_BITS)).exp2();
    let sum = |x: &[u128]| x.iter().sum::<u128>() as f64 * unit;
    let mut inner = sum(&above.inner_at);
    let mut boxes = above.boxes as f64;
    for depth in depths.clone() {
        let at = depth as usize;
        inner += found.inner_at[at] as f64 * unit * scale;
        boxes += found.boxes_at[at] as f64 * scale;
        if boxes > goal.max_boxes as f64 && depth > depths.start {
            return Some(depth - 1);
        }
        let open = found.open_at[at] as f64 * unit * scale;
        if goal.gap.is_some_and(|gap| open <= AIM * gap * inner) {
            return Some(depth);
        }
    }
    None
}
