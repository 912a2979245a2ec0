//! The best place for a cube in the region where a claim holds, in doubles: nothing rests on it.

use crate::exact::arithmetic::{apply, number};
use crate::questions::frontier::NoAnswer;
use crate::search::solver::sample::{Quality, Sampler};
use crate::search::{Budget, Control, Progress};
use num_rational::BigRational;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use std::array::from_fn;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// Points of a coarse grid along each axis of the workspace; where the platform turns, of which each point
/// of a cube is tried in so many orientations.
const GRID: [usize; 2] = [9, 3];
/// Grid points from which the search goes on.
const STARTS: [usize; 2] = [4, 1];
/// Finest relative precision of a side where the platform turns.
const TURNING_FINEST: f64 = 1e-4;
/// Pseudo-random directions of a round, beside the 26 of axes and diagonals.
const RANDOM: usize = 32;
/// What a step that leads nowhere is shortened by.
const SHORTER: f64 = 0.6;
/// A cube this many times as large as the workspace has no end.
const ENDLESS: f64 = 1e6;
/// Finest relative precision of a side.
const FINEST: f64 = 1e-13;

/// Where a cube's centre may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centres {
    /// In the workspace.
    Workspace,
    /// Anywhere: the workspace is where the search begins.
    Anywhere,
    /// Anywhere on `x = y = z`.
    Diagonal,
}

/// A centre, and the greatest side at which every requirement seems to hold in the cube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    /// The centre, in the claim's unit.
    pub centre: [f64; 3],
    /// The side.
    pub side: f64,
}

/// The best place found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The cube.
    pub cube: Cube,
    /// Whether with more time there may be a better one.
    pub out_of_time: bool,
}

struct Cubes<'a> {
    sampler: Sampler<'a>,
    qualities: Vec<Quality>,
    centres: Centres,
    min: [f64; 3],
    width: [f64; 3],
    /// The greatest edge.
    size: f64,
    /// Coordinates of orientation that are tried at each point; one list of none where nothing turns.
    turns: Vec<Vec<f64>>,
    /// Points of a cube, from -1/2 to 1/2, with one of these: those at which something failed last come first.
    tried: RefCell<VecDeque<([f64; 3], usize)>>,
}

/// The best place found for a cube in the region where `claim` holds, whose side is found to the
/// relative `precision`; `None` where no centre of a grid fulfils the claim.
///
/// Where the platform turns, they are to hold in every orientation of the claim's set. At the budget's
/// deadline, or if it is cancelled, it has the best that was found, and says so.
///
/// # Errors
/// If the claim is not well formed, or its workspace is not a box with a volume, of three
/// coordinates of length.
pub fn best_place(
    claim: &MachineClaim,
    centres: Centres,
    precision: f64,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Placed>, NoAnswer> {
    let problem = Problem::new(claim)?;
    let cubes = Cubes::new(Sampler::new(claim, &problem)?, centres)?;
    let mut starts = cubes.starts();
    starts.sort_by(|a, b| b.side.total_cmp(&a.side));
    starts.retain(|cube| cube.side > 0.0);
    starts.truncate(STARTS[cubes.turning()]);
    let finest = [FINEST, TURNING_FINEST][cubes.turning()];
    let (all, mut out_of_time) = (starts.len() as f64, false);
    let best = starts.into_iter().enumerate().map(|(number, start)| {
        let found = match cubes.is_endless(&start) {
            true => start,
            false => cubes.ascend(start, precision.max(finest), &mut || {
                out_of_time |= budget.is_over() || control.is_cancelled();
                out_of_time
            }),
        };
        (control.progress)(Progress { boxes: 0, share: (number + 1) as f64 / all });
        found
    });
    let best = best.max_by(|a, b| a.side.total_cmp(&b.side));
    Ok(best.map(|cube| Placed { cube, out_of_time }))
}

/// Whether a cube that [`best_place`] has found in a workspace of this size only ends where the
/// search did.
pub fn is_endless(cube: &Cube, size: f64) -> bool {
    cube.side > ENDLESS * size
}

/// The cube of this side about a centre, as a workspace.
pub fn cube_about(centre: &[BigRational; 3], side: &Expression) -> Workspace {
    let half = apply(Operator::Div, side, &Expression::integer(2));
    let end = |operator| centre.iter().map(|x| apply(operator, &number(x), &half)).collect();
    Workspace::Box { min: end(Operator::Sub), max: end(Operator::Add) }
}

impl<'a> Cubes<'a> {
    fn new(sampler: Sampler<'a>, centres: Centres) -> Result<Self, NoAnswer> {
        let refused = || {
            let (found, accepted) =
                ("no box with a volume", "min and max in three coordinates of length");
            NoAnswer::unfit("workspace", found, accepted)
        };
        let claim = sampler.claim();
        if !matches!(claim.workspace, Workspace::Box { .. }) || sampler.lengths() != 3 {
            return Err(refused());
        }
        let [min, max] = sampler.ends().map(|end| from_fn(|k| end[k]));
        let width: [f64; 3] = from_fn(|k| max[k] - min[k]);
        if !width.iter().all(|width| *width > 0.0) {
            return Err(refused());
        }
        let size = width.iter().fold(0.0, |a: f64, &b| a.max(b));
        let turns = turns(&sampler);
        // Where the platform turns, not the middles of edges.
        let point = |n: usize| [n % 3, n / 3 % 3, n / 9].map(|i| [-0.5, 0.5, 0.0][i]);
        let is_tried =
            |x: &[f64; 3]| turns.len() == 1 || x.iter().filter(|x| **x != 0.0).count() != 2;
        let points = (0..27).map(point).filter(is_tried);
        let tried = points.flat_map(|x| (0..turns.len()).map(move |turn| (x, turn))).collect();
        let qualities = sampler.qualities();
        let tried = RefCell::new(tried);
        Ok(Cubes { qualities, sampler, centres, min, width, size, turns, tried })
    }

    /// Which of two numbers is for this machine: one that turns its platform has the second.
    fn turning(&self) -> usize {
        usize::from(self.turns.len() > 1)
    }

    /// The greatest cubes about the points of a coarse grid.
    fn starts(&self) -> Vec<Cube> {
        let grid = GRID[self.turning()];
        let part = |i: usize| ((i % grid) as f64 + 0.5) / grid as f64;
        let at = |u: [f64; 3]| from_fn(|k| self.min[k] + self.width[k] * u[k]);
        let cube = |centre| Cube { centre, side: self.side(&centre, 0.0, 1e-3) };
        if self.centres == Centres::Diagonal {
            let mean = |point: [f64; 3]| [point.iter().sum::<f64>() / 3.0; 3];
            return (0..grid)
                .map(|i| cube(mean(at([part(i); 3]))))
                .chain([cube([0.0; 3])])
                .collect();
        }
        let points = (0..grid * grid * grid).map(|n| [n / grid / grid, n / grid, n].map(part));
        points.map(|u| cube(at(u))).collect()
    }

    fn is_endless(&self, cube: &Cube) -> bool {
        is_endless(cube, self.size)
    }

    /// Whether every requirement seems to hold at the corners, the middles of edges and faces, and
    /// the centre of a cube.
    fn fits(&self, centre: &[f64; 3], side: f64) -> bool {
        let fails = |(offset, turn): &([f64; 3], usize)| {
            !self.holds(from_fn(|k| centre[k] + side * offset[k]), &self.turns[*turn])
        };
        let mut tried = self.tried.borrow_mut();
        let Some(failed) = tried.iter().position(fails) else { return true };
        let failed = tried.remove(failed);
        failed.into_iter().for_each(|failed| tried.push_front(failed));
        false
    }

    fn holds(&self, point: [f64; 3], turn: &[f64]) -> bool {
        let point = point.map(|x| x / self.sampler.unit());
        let values = self.sampler.at_point(&[&point, turn].concat());
        let mut qualities = self.qualities.iter();
        qualities.all(|&quality| self.sampler.margin(quality, &values) >= 0.0)
    }

    /// The greatest side that fits, from `least` (which fits, or is zero), to a relative precision.
    fn side(&self, centre: &[f64; 3], least: f64, precision: f64) -> f64 {
        let mut low = least;
        let mut step = if low > 0.0 { low * precision } else { self.size / 64.0 };
        while low <= ENDLESS * self.size && self.fits(centre, low + step) {
            low += step;
            step *= 2.0;
        }
        let mut high = low + step;
        while high - low > precision * high && high > 1e-12 * self.size {
            let middle = 0.5 * (low + high);
            if self.fits(centre, middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// A pattern search over the centre: axes, diagonals and pseudo-random directions, for the
    /// greatest side has ridges.
    fn ascend(&self, start: Cube, precision: f64, is_over: &mut dyn FnMut() -> bool) -> Cube {
        let mut best = start;
        best.side = self.side(&best.centre, best.side, precision);
        let mut step = self.size / GRID[0] as f64;
        let mut state = 1;
        while step > best.side * precision * 0.1 {
            let mut moved = false;
            for n in 0..self.directions() {
                if is_over() {
                    return best;
                }
                let along = self.direction(n, &mut state);
                let centre = from_fn(|k| best.centre[k] + step * along[k]);
                let better = best.side * (1.0 + precision);
                if self.is_centre(&centre) && self.fits(&centre, better) {
                    best = Cube { centre, side: self.side(&centre, better, precision) };
                    moved = true;
                }
            }
            if !moved {
                step *= SHORTER;
            }
        }
        best
    }

    fn is_centre(&self, point: &[f64; 3]) -> bool {
        self.centres != Centres::Workspace
            || (0..3).all(|k| (self.min[k]..=self.min[k] + self.width[k]).contains(&point[k]))
    }

    fn directions(&self) -> usize {
        match self.centres {
            Centres::Diagonal => 2,
            Centres::Workspace | Centres::Anywhere => 26 + RANDOM,
        }
    }

    /// Direction `n`: the 26 of `{-1, 0, 1}^3`, then pseudo-random ones.
    fn direction(&self, n: usize, state: &mut u64) -> [f64; 3] {
        if self.centres == Centres::Diagonal {
            return [1.0 - 2.0 * n as f64; 3];
        }
        if n < 26 {
            let n = if n < 13 { n } else { n + 1 };
            return [n % 3, n / 3 % 3, n / 9].map(|i| i as f64 - 1.0);
        }
        from_fn(|_| {
            *state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
    }
}

/// Coordinates of orientation of the middle, the corners and the faces of a set: one list of none where
/// nothing turns.
fn turns(sampler: &Sampler<'_>) -> Vec<Vec<f64>> {
    let (still, all) = (sampler.lengths(), sampler.centre().u.len());
    let turn = |n: u32| {
        let digit = |k: u32| [0.5, 0.0, 1.0][(n / 3u32.pow(k) % 3) as usize];
        let turned = (0..(all - still) as u32).map(digit);
        let u: Vec<f64> = std::iter::repeat_n(0.5, still).chain(turned).collect();
        let off = u.iter().filter(|u| **u != 0.5).count();
        (off <= 1 || off == all - still).then(|| sampler.point(&u).split_off(still))
    };
    let mut turns: Vec<Vec<f64>> = (0..3u32.pow((all - still) as u32)).filter_map(turn).collect();
    turns.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
    turns.dedup();
    turns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use std::sync::atomic::AtomicBool;
    use std::time::Instant;

    #[test]
    fn a_search_that_is_cut_short_says_so() {
        let text = include_str!("../../tests/designs/urane-sx-type.toml");
        let claim = Design::parse(text, "urane-sx-type.toml").expect("a design").claim;
        let cancel = AtomicBool::new(false);
        let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
        let mut placed = |deadline| {
            let budget = Budget { max_boxes: 1, deadline };
            let found = best_place(&claim, Centres::Workspace, 1e-6, budget, control);
            found.expect("a box").expect("a place")
        };
        let (best, cut) = (placed(None), placed(Some(Instant::now())));
        assert!(!best.out_of_time && cut.out_of_time);
        assert!(cut.cube.side > 0.0 && cut.cube.side < best.cube.side);
    }
}
