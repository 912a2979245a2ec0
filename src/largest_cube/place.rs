//! The best centre of a cube, in doubles: nothing rests on it.

use super::NoAnswer;
use crate::sample::{self, Quality, Sampler};
use crate::verify::MODEL_PRECISION;
use orthocert_checker::claim::{MachineClaim, Workspace};
use orthocert_checker::model::Model;

/// Points of a coarse grid along each axis of the box of centres.
const GRID: usize = 9;
/// Grid points from which the search goes on.
const STARTS: usize = 4;

/// A centre, and the greatest side at which the cube seems to lie in the region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The centre, in the claim's unit.
    pub centre: [f64; 3],
    /// The side.
    pub side: f64,
}

struct Cubes {
    sampler: Sampler,
    qualities: Vec<Quality>,
    min: [f64; 3],
    width: [f64; 3],
    middle: Vec<f64>,
}

/// The best place found for a cube with its centre in the workspace of `claim`, a box; `None` where
/// no centre of a grid fulfils the claim.
///
/// # Errors
/// If the claim is not well formed, or its workspace is not a box with a volume.
pub fn best_place(claim: &MachineClaim, gap: f64) -> Result<Option<Place>, NoAnswer> {
    let refused = || NoAnswer::Claim("the workspace is not a box with a volume".to_owned());
    let Workspace::Box { min, max } = &claim.workspace else {
        return Err(refused());
    };
    let model = Model::new(claim, MODEL_PRECISION)?;
    let sampler = Sampler::new(claim, &model).ok_or_else(refused)?;
    let end = |x: &orthocert_checker::number::Exact| crate::decimal::approximate(x);
    let mut cubes = Cubes {
        qualities: sampler.qualities(),
        middle: vec![0.5; sampler.parameters()],
        sampler,
        min: [0.0; 3],
        width: [0.0; 3],
    };
    for k in 0..3 {
        let (low, high) = end(&min[k]).zip(end(&max[k])).ok_or_else(refused)?;
        (cubes.min[k], cubes.width[k]) = (low, high - low);
        if high <= low {
            return Err(refused());
        }
    }
    let mut starts: Vec<Place> = cubes.grid().collect();
    starts.sort_by(|a, b| b.side.total_cmp(&a.side));
    let ascended = starts.into_iter().take(STARTS).map(|start| cubes.ascend(start, gap));
    Ok(ascended.max_by(|a, b| a.side.total_cmp(&b.side)).filter(|place| place.side > 0.0))
}

impl Cubes {
    fn grid(&self) -> impl Iterator<Item = Place> + '_ {
        let part = |i: usize| (i as f64 + 0.5) / GRID as f64;
        (0..GRID * GRID * GRID).map(move |n| {
            let u = [part(n / GRID / GRID), part(n / GRID % GRID), part(n % GRID)];
            let centre = std::array::from_fn(|k| self.min[k] + self.width[k] * u[k]);
            Place { centre, side: self.side(&centre, 0.0, 1e-3) }
        })
    }

    /// Whether every requirement seems to hold at the corners, the middles of the edges and of the
    /// faces of a cube.
    fn fits(&self, centre: &[f64; 3], side: f64) -> bool {
        let half = side / 2.0;
        let ends = [-half, half, 0.0];
        ends.iter()
            .all(|x| ends.iter().all(|y| ends.iter().all(|z| self.holds(centre, &[*x, *y, *z]))))
    }

    fn holds(&self, centre: &[f64; 3], offset: &[f64; 3]) -> bool {
        let u = std::array::from_fn(|k| (centre[k] + offset[k] - self.min[k]) / self.width[k]);
        let values = self.sampler.at(&sample::Place { u, t: self.middle.clone() });
        self.qualities.iter().all(|&quality| {
            self.sampler.margin(quality, &values).is_none_or(|margin| margin >= 0.0)
        })
    }

    /// The greatest side that fits, from `least` (which fits, or is zero), to a relative precision.
    fn side(&self, centre: &[f64; 3], least: f64, precision: f64) -> f64 {
        let mut low = least;
        let mut step = if low > 0.0 { low * precision } else { self.width[0] / 64.0 };
        while self.fits(centre, low + step) && step < 1e9 * self.width[0] {
            low += step;
            step *= 2.0;
        }
        let mut high = low + step;
        while high - low > precision * high && high > 1e-12 * self.width[0] {
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
    fn ascend(&self, start: Place, gap: f64) -> Place {
        let mut best = start;
        let fine = (gap * 1e-3).max(1e-13);
        best.side = self.side(&best.centre, best.side, fine);
        let mut step = self.width.iter().fold(0.0f64, |a, &b| a.max(b)) / GRID as f64;
        let mut state = 1u64;
        while step > best.side * fine * 0.1 && best.side > 0.0 {
            let mut moved = false;
            for n in 0..58 {
                let along = direction(n, &mut state);
                let centre: [f64; 3] = std::array::from_fn(|k| best.centre[k] + step * along[k]);
                let within = (0..3)
                    .all(|k| (self.min[k]..=self.min[k] + self.width[k]).contains(&centre[k]));
                if within && self.fits(&centre, best.side * (1.0 + fine)) {
                    let side = self.side(&centre, best.side * (1.0 + fine), fine);
                    (best, moved) = (Place { centre, side }, true);
                }
            }
            if !moved {
                step *= 0.6;
            }
        }
        best
    }
}

/// Direction `n`: the 26 of `{-1, 0, 1}^3`, then pseudo-random ones.
pub(crate) fn direction(n: usize, state: &mut u64) -> [f64; 3] {
    if n < 26 {
        let n = if n < 13 { n } else { n + 1 };
        return [n % 3, n / 3 % 3, n / 9].map(|i| i as f64 - 1.0);
    }
    std::array::from_fn(|_| {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    })
}
