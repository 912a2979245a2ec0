//! The best place for a cube in the region where a claim holds, in doubles: nothing rests on it.

use crate::decimal::approximate;
use crate::frontier::NoAnswer;
use crate::sample::{Place, Quality, Sampler};
use crate::verify::MODEL_PRECISION;
use orthocert_checker::claim::{MachineClaim, Workspace};
use orthocert_checker::model::Model;
use orthocert_checker::number::{Exact, NumberErrorKind};
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

struct Cubes {
    sampler: Sampler,
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
/// If the claim is not well formed, or its workspace is not a box with a volume.
pub fn best_place(
    claim: &MachineClaim,
    centres: Centres,
    precision: f64,
) -> Result<Option<Cube>, NoAnswer> {
    let cubes = Cubes::new(claim, centres)?;
    let mut starts = cubes.starts();
    starts.sort_by(|a, b| b.side.total_cmp(&a.side));
    let found = starts.into_iter().filter(|cube| cube.side > 0.0).take(STARTS);
    let best = found.map(|start| match cubes.is_endless(&start) {
        true => start,
        false => cubes.ascend(start, precision.max(FINEST)),
    });
    Ok(best.max_by(|a, b| a.side.total_cmp(&b.side)))
}

/// Whether a cube that [`best_place`] has found in a workspace of this size only ends where the
/// search did.
pub fn is_endless(cube: &Cube, size: f64) -> bool {
    cube.side > ENDLESS * size
}

/// The cube of this side about a centre, as a workspace.
///
/// # Errors
/// If its numbers exceed what can be written.
pub fn cube_about(centre: &[Exact; 3], side: &Exact) -> Result<Workspace, NumberErrorKind> {
    let half = side.clone().over(Exact::integer(2))?;
    let (mut min, mut max) = (centre.clone(), centre.clone());
    for k in 0..3 {
        min[k] = centre[k].clone().minus(half.clone())?;
        max[k] = centre[k].clone().plus(half.clone())?;
    }
    Ok(Workspace::Box { min, max })
}

impl Cubes {
    fn new(claim: &MachineClaim, centres: Centres) -> Result<Self, NoAnswer> {
        let refused = || NoAnswer::Claim("the workspace is not a box with a volume".to_owned());
        let Workspace::Box { min, max } = &claim.workspace else {
            return Err(refused());
        };
        let model = Model::new(claim, MODEL_PRECISION)?;
        let sampler = Sampler::new(claim, &model).ok_or_else(refused)?;
        let qualities = sampler.qualities();
        let (mut least, mut width) = ([0.0; 3], [0.0; 3]);
        for k in 0..3 {
            let ends = approximate(&min[k]).zip(approximate(&max[k]));
            let (low, high) = ends.filter(|(low, high)| low < high).ok_or_else(refused)?;
            (least[k], width[k]) = (low, high - low);
        }
        let size = width.iter().fold(0.0, |a: f64, &b| a.max(b));
        Ok(Cubes { sampler, qualities, centres, min: least, width, size })
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
        let u = from_fn(|k| (point[k] - self.min[k]) / self.width[k]);
        let values = self.sampler.at(&Place { u, t: vec![0.5; self.sampler.parameters()] });
        self.qualities.iter().all(|&quality| {
            self.sampler.margin(quality, &values).is_none_or(|margin| margin >= 0.0)
        })
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
