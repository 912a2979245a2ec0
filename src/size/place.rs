//! The best placement of a cube, in doubles: nothing rests on it.

use crate::decimal::approximate;
use crate::frontier::NoAnswer;
use crate::largest_cube::direction;
use crate::sample::{Place, Quality, Sampler};
use crate::verify::MODEL_PRECISION;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::claim::{MachineClaim, Workspace};
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use std::array::from_fn;

/// Points of a coarse grid along each axis of the workspace.
const GRID: usize = 7;
/// Grid points from which the search goes on.
const STARTS: usize = 3;
/// Pseudo-random directions of a round, beside the 26 of axes and diagonals.
const RANDOM: usize = 32;
/// A cube this many times as large as the workspace has no end.
const ENDLESS: f64 = 1e6;

/// A centre, and the greatest side at which every requirement seems to hold in the cube.
#[derive(Clone, Copy, Debug)]
pub struct Cube {
    /// The centre.
    pub centre: [f64; 3],
    /// The side.
    pub side: f64,
}

struct Cubes {
    sampler: Sampler,
    qualities: Vec<Quality>,
    /// The middle of the workspace, and its greatest edge.
    middle: [f64; 3],
    width: f64,
    precision: f64,
}

/// The best place found for a cube in the region where `claim` holds, searched from the claim's
/// workspace; `diagonal` keeps the centre on `x = y = z`.
///
/// # Errors
/// If no centre is found, or there is no greatest cube.
pub fn best_place(claim: &MachineClaim, diagonal: bool, precision: f64) -> Result<Cube, NoAnswer> {
    let cubes = Cubes::new(claim, precision)
        .ok_or_else(|| NoAnswer::Claim("the design's numbers are too large".to_owned()))?;
    let mut starts: Vec<Cube> = if diagonal { cubes.diagonal() } else { cubes.grid() };
    starts.sort_by(|a, b| b.side.total_cmp(&a.side));
    if starts.iter().any(|cube| cube.side > ENDLESS * cubes.width) {
        return Err(NoAnswer::Claim(
            "the requirements hold in cubes of any size: there is no smallest machine".to_owned(),
        ));
    }
    let found = starts.into_iter().filter(|cube| cube.side > 0.0).take(STARTS);
    let best = found.map(|start| cubes.ascend(start, diagonal));
    best.max_by(|a, b| a.side.total_cmp(&b.side)).ok_or_else(|| {
        NoAnswer::Claim(
            "no point of the workspace was found at which every requirement holds, to put a cube \
             there; accepted: a design whose workspace holds such a point"
                .to_owned(),
        )
    })
}

impl Cubes {
    fn new(claim: &MachineClaim, precision: f64) -> Option<Self> {
        let (min, max) = claim.workspace.bounding_box().ok()?;
        let mut ends = [[0.0; 2]; 3];
        for k in 0..3 {
            ends[k] = [approximate(&min[k])?, approximate(&max[k])?];
        }
        let middle = ends.map(|[low, high]| (low + high) / 2.0);
        let width = ends.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let width = if width > 0.0 { width } else { 1.0 };
        let end = |x: f64| BigRational::from_f64(x).map(Exact::Rational);
        let corner = |half: f64| -> Option<[Exact; 3]> {
            Some([end(middle[0] + half)?, end(middle[1] + half)?, end(middle[2] + half)?])
        };
        let workspace = Workspace::Box { min: corner(-width / 2.0)?, max: corner(width / 2.0)? };
        let claim = MachineClaim { workspace, ..claim.clone() };
        let model = Model::new(&claim, MODEL_PRECISION).ok()?;
        let sampler = Sampler::new(&claim, &model)?;
        let qualities = sampler.qualities();
        Some(Cubes { sampler, qualities, middle, width, precision })
    }

    fn at(&self, centre: [f64; 3]) -> Cube {
        Cube { centre, side: self.side(&centre, 0.0, 1e-3) }
    }

    fn grid(&self) -> Vec<Cube> {
        let part = |i: usize| ((i % GRID) as f64 + 0.5) / GRID as f64 - 0.5;
        (0..GRID * GRID * GRID)
            .map(|n| [part(n / GRID / GRID), part(n / GRID), part(n)])
            .map(|u| self.at(from_fn(|k| self.middle[k] + self.width * u[k])))
            .collect()
    }

    fn diagonal(&self) -> Vec<Cube> {
        let middle = self.middle.iter().sum::<f64>() / 3.0;
        let part = |i: usize| (i as f64 + 0.5) / GRID as f64 - 0.5;
        let centres = (0..GRID).map(|i| middle + self.width * part(i));
        centres.chain([0.0]).map(|c| self.at([c; 3])).collect()
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
        let u = from_fn(|k| (point[k] - self.middle[k]) / self.width + 0.5);
        let values = self.sampler.at(&Place { u, t: vec![0.5; self.sampler.parameters()] });
        let within = |quality: &Quality| {
            self.sampler.margin(*quality, &values).is_none_or(|margin| margin >= 0.0)
        };
        values.reached.is_some() && self.qualities.iter().all(within)
    }

    /// The greatest side that fits, from `least`, which fits or is zero.
    fn side(&self, centre: &[f64; 3], least: f64, precision: f64) -> f64 {
        let mut low = least;
        let mut step = if low > 0.0 { low * precision } else { self.width / 64.0 };
        while low <= ENDLESS * self.width && self.fits(centre, low + step) {
            low += step;
            step *= 2.0;
        }
        let mut high = low + step;
        while high - low > precision * high && high > 1e-9 * self.width {
            let middle = (low + high) / 2.0;
            if self.fits(centre, middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// A pattern search over the centre for the greatest side, which has ridges: hence directions
    /// other than the axes.
    fn ascend(&self, start: Cube, diagonal: bool) -> Cube {
        let mut best = start;
        let fine = (self.precision * 0.1).max(1e-13);
        best.side = self.side(&best.centre, best.side, fine);
        let mut step = self.width / GRID as f64;
        let mut state = 1;
        while step > best.side * fine {
            let mut moved = false;
            for n in 0..if diagonal { 2 } else { 26 + RANDOM } {
                let along =
                    if diagonal { [1.0 - 2.0 * n as f64; 3] } else { direction(n, &mut state) };
                let centre = from_fn(|k| best.centre[k] + step * along[k]);
                let better = best.side * (1.0 + fine);
                if self.fits(&centre, better) {
                    best = Cube { centre, side: self.side(&centre, better, fine) };
                    moved = true;
                }
            }
            if !moved {
                step /= 2.0;
            }
        }
        best
    }
}
