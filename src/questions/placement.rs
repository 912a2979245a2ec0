//! The best place for a cube in the region where a claim holds, in doubles: nothing rests on it.

use crate::exact::arithmetic::apply;
use crate::questions::frontier::NoAnswer;
use crate::search::solver::number;
use crate::search::solver::sample::{Quality, Sampler};
use crate::search::{Control, Progress};
use num_rational::BigRational;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use std::array::from_fn;

/// Points of a coarse grid along each axis of the workspace.
const GRID: usize = 9;
/// Grid points from which the search goes on.
const STARTS: usize = 4;
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

struct Cubes<'a> {
    sampler: Sampler<'a>,
    qualities: Vec<Quality>,
    centres: Centres,
    min: [f64; 3],
    width: [f64; 3],
    /// The greatest edge.
    size: f64,
}

/// The best place found for a cube in the region where `claim` holds, whose side is found to the
/// relative `precision`; `None` where no centre of a grid fulfils the claim.
///
/// # Errors
/// If the claim is not well formed, or its workspace is not a box with a volume, of three
/// coordinates.
pub fn best_place(
    claim: &MachineClaim,
    centres: Centres,
    precision: f64,
    control: &mut Control<'_>,
) -> Result<Option<Cube>, NoAnswer> {
    let problem = Problem::new(claim)?;
    let cubes = Cubes::new(Sampler::new(claim, &problem)?, centres)?;
    let mut starts = cubes.starts();
    starts.sort_by(|a, b| b.side.total_cmp(&a.side));
    starts.retain(|cube| cube.side > 0.0);
    starts.truncate(STARTS);
    let all = starts.len() as f64;
    let best = starts.into_iter().enumerate().map(|(number, start)| {
        let found = match cubes.is_endless(&start) {
            true => start,
            false => cubes.ascend(start, precision.max(FINEST)),
        };
        (control.progress)(Progress { boxes: 0, share: (number + 1) as f64 / all });
        found
    });
    Ok(best.max_by(|a, b| a.side.total_cmp(&b.side)))
}

/// Whether a cube that [`best_place`] has found in a workspace of this size only ends where the
/// search did.
pub fn is_endless(cube: &Cube, size: f64) -> bool {
    cube.side > ENDLESS * size
}

/// The cube of this side about a centre, as a workspace; `None` if its numbers are too long for a
/// claim.
pub fn cube_about(centre: &[BigRational; 3], side: &Expression) -> Option<Workspace> {
    let half = apply(Operator::Div, side, &Expression::integer(2))?;
    let end = |operator| {
        let ends = centre.iter().map(|x| apply(operator, &number(x)?, &half));
        ends.collect::<Option<Vec<_>>>()
    };
    Some(Workspace::Box { min: end(Operator::Sub)?, max: end(Operator::Add)? })
}

impl<'a> Cubes<'a> {
    fn new(sampler: Sampler<'a>, centres: Centres) -> Result<Self, NoAnswer> {
        let refused = || {
            let why = "the workspace is not a box with a volume, of three coordinates of length";
            NoAnswer::Claim(why.to_owned())
        };
        let claim = sampler.claim();
        if !matches!(claim.workspace, Workspace::Box { .. }) || claim.orientation.is_some() {
            return Err(refused());
        }
        let three = |x: Vec<f64>| <[f64; 3]>::try_from(x).map_err(|_| refused());
        let [min, max] = sampler.ends();
        let (min, max) = (three(min)?, three(max)?);
        let width: [f64; 3] = from_fn(|k| max[k] - min[k]);
        if !width.iter().all(|width| *width > 0.0) {
            return Err(refused());
        }
        let size = width.iter().fold(0.0, |a: f64, &b| a.max(b));
        Ok(Cubes { qualities: sampler.qualities(), sampler, centres, min, width, size })
    }

    /// The greatest cubes about the points of a coarse grid.
    fn starts(&self) -> Vec<Cube> {
        let part = |i: usize| ((i % GRID) as f64 + 0.5) / GRID as f64;
        let at = |u: [f64; 3]| from_fn(|k| self.min[k] + self.width[k] * u[k]);
        let cube = |centre| Cube { centre, side: self.side(&centre, 0.0, 1e-3) };
        if self.centres == Centres::Diagonal {
            let mean = |point: [f64; 3]| [point.iter().sum::<f64>() / 3.0; 3];
            return (0..GRID)
                .map(|i| cube(mean(at([part(i); 3]))))
                .chain([cube([0.0; 3])])
                .collect();
        }
        let points = (0..GRID * GRID * GRID).map(|n| [n / GRID / GRID, n / GRID, n].map(part));
        points.map(|u| cube(at(u))).collect()
    }

    fn is_endless(&self, cube: &Cube) -> bool {
        is_endless(cube, self.size)
    }

    /// Whether every requirement seems to hold at the corners, the middles of edges and faces, and
    /// the centre of a cube.
    fn fits(&self, centre: &[f64; 3], side: f64) -> bool {
        (0..27).all(|n| {
            let offset = [n % 3, n / 3 % 3, n / 9].map(|i| side * [-0.5, 0.5, 0.0][i]);
            self.holds(from_fn(|k| centre[k] + offset[k]))
        })
    }

    fn holds(&self, point: [f64; 3]) -> bool {
        let values = self.sampler.at_point(&point.map(|x| x / self.sampler.unit()));
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
    fn ascend(&self, start: Cube, precision: f64) -> Cube {
        let mut best = start;
        best.side = self.side(&best.centre, best.side, precision);
        let mut step = self.size / GRID as f64;
        let mut state = 1;
        while step > best.side * precision * 0.1 {
            let mut moved = false;
            for n in 0..self.directions() {
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
