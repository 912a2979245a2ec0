//! The search for worst places: compass searches from the worst points of a grid.

use super::sample::{Place, Quality, Sampler, Worst};

/// Halvings of the first, coarse descents.
const COARSE: i32 = 7;
/// Axes up to which descents go along diagonals at every step; of more, the last ones alone, at coarse steps.
const MOST_AXES: usize = 3;
/// Starts of coarse descents, and of more than [`MOST_AXES`] coordinates where the worst found holds by
/// at most this: searches there cost far more.
const STARTS: usize = 3;
const MORE_STARTS: usize = 16;
const CLOSE: f64 = 0.02;
/// Values that are looked at for more starts, with the tolerances at their worse ends.
const VALUES_AT_ENDS: usize = 2000;
/// What starts differ by, at least, in some coordinate.
const APART: f64 = 0.3;

/// The greatest difference of coordinates.
fn distance(one: &Place, other: &Place) -> f64 {
    one.u.iter().zip(&other.u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Adds the first of the places that are apart from all others, until there are so many.
fn add_apart<'a>(apart: &mut Vec<&'a Place>, places: impl Iterator<Item = &'a Place>, most: usize) {
    for place in places {
        if apart.len() < most && apart.iter().all(|other| distance(other, place) > APART) {
            apart.push(place);
        }
    }
}

impl Sampler<'_> {
    /// The place near `start` at which a quality has its least margin, down to steps of `2^-finest` of
    /// the workspace: a compass search for the point, and for the machine first the tolerances' ends.
    pub fn descend(&self, quality: Quality, start: &Place, finest: i32) -> Worst {
        let mut worst = self.descended(quality, start, finest);
        if self.across(&mut worst, COARSE.min(finest)) {
            self.compass(&mut worst, 0..self.box_.len(), COARSE + 1..=finest);
        }
        worst
    }

    /// The same, of more than [`MOST_AXES`] coordinates without diagonals.
    fn descended(&self, quality: Quality, start: &Place, finest: i32) -> Worst {
        let (m, p) = (self.box_.len(), self.frees());
        let mut worst = self.worst_at(quality, start.clone());
        self.to_ends(&mut worst);
        self.compass(&mut worst, 0..m, 1..=COARSE.min(finest));
        if p > 0 {
            self.to_ends(&mut worst);
            self.compass(&mut worst, m..m + p, 2..=COARSE.min(finest));
            self.compass(&mut worst, 0..m, 4..=COARSE.min(finest));
        }
        self.compass(&mut worst, 0..m, COARSE + 1..=finest);
        if p > 0 && self.to_ends(&mut worst) {
            self.compass(&mut worst, 0..m, 4..=finest);
        }
        worst
    }

    /// Of more than [`MOST_AXES`] coordinates, moves the point along diagonals too.
    fn across(&self, worst: &mut Worst, finest: i32) -> bool {
        let (m, before) = (self.box_.len(), worst.margin);
        if m > MOST_AXES {
            self.steps(worst, 0..m, 1..=finest, true);
        }
        worst.margin < before
    }

    /// Takes the place at these parts if it is worse than the worst known.
    fn considered(&self, worst: &mut Worst, parts: &[(usize, f64)]) -> bool {
        let mut place = worst.place.clone();
        for &(axis, part) in parts {
            *place.part(axis) = part.clamp(0.0, 1.0);
        }
        if place == worst.place {
            return false;
        }
        self.taken(worst, place)
    }

    /// Takes a place if it is worse than the worst known.
    fn taken(&self, worst: &mut Worst, place: Place) -> bool {
        let margin = self.margin_at(worst.quality, &place);
        let worse = margin < worst.margin;
        if worse {
            (worst.place, worst.margin) = (place, margin);
        }
        worse
    }

    fn stepped(&self, worst: &mut Worst, steps: &[(usize, f64)]) -> bool {
        let parts: Vec<(usize, f64)> =
            steps.iter().map(|&(axis, step)| (axis, *worst.place.part(axis) + step)).collect();
        self.considered(worst, &parts)
    }

    /// Moves the point alone.
    pub(super) fn to_point(&self, worst: &mut Worst, finest: i32) {
        self.compass(worst, 0..self.box_.len(), 1..=finest);
    }

    /// Puts each parameter in turn at the worse end of its tolerance.
    pub(super) fn to_ends(&self, worst: &mut Worst) -> bool {
        if let Some(place) = self.farthest_off(worst.quality, &worst.place) {
            self.taken(worst, place);
        }
        let m = self.box_.len();
        let axes = m..m + self.frees();
        let ends = axes.flat_map(|axis| [(axis, 0.0), (axis, 1.0)]);
        ends.fold(false, |moved, (axis, end)| self.considered(worst, &[(axis, end)]) || moved)
    }

    /// Steps along the axes; where they are few along diagonals too, whose number is the square of theirs.
    fn compass(
        &self,
        worst: &mut Worst,
        axes: std::ops::Range<usize>,
        exponents: std::ops::RangeInclusive<i32>,
    ) {
        let few = axes.len() <= MOST_AXES;
        self.steps(worst, axes, exponents, few);
    }

    /// Steps along the axes, and, where all of them are up, along the diagonals of pairs.
    fn steps(
        &self,
        worst: &mut Worst,
        axes: std::ops::Range<usize>,
        exponents: std::ops::RangeInclusive<i32>,
        diagonals: bool,
    ) {
        for exponent in exponents {
            let step = f64::from(-exponent).exp2();
            // A few rounds a step: the next, finer one takes over what is left.
            for _ in 0..4 {
                let mut moved = false;
                for axis in axes.clone() {
                    for signed in [step, -step] {
                        moved |= self.stepped(worst, &[(axis, signed)]);
                    }
                }
                let pairs = axes.clone().flat_map(|i| (axes.start..i).map(move |j| (i, j)));
                for (i, j) in pairs.filter(|_| diagonals) {
                    for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                        moved = moved || self.stepped(worst, &[(i, a * step), (j, b * step)]);
                    }
                }
                if !moved {
                    break;
                }
            }
        }
    }

    /// The worst point of the grid for every quality.
    pub fn worst_on_grid(&self) -> Vec<Worst> {
        let grid: Vec<_> = self.grid().into_iter().map(|p| (self.at(&p), p)).collect();
        let worst = |quality| {
            let margins = grid.iter().map(|(values, p)| (self.margin(quality, values), p));
            let (margin, place) = margins.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(Worst { quality, place: place.clone(), margin })
        };
        self.qualities().into_iter().filter_map(worst).collect()
    }

    /// The corners of the workspace, and the middles of its edges and faces, with each tolerance at its worse end, worst
    /// first: where the middle machine is far from failing, another may be near.
    fn corners_at_worse_ends(&self, quality: Quality, grid: &[(f64, &Place)]) -> Vec<Worst> {
        let Some(most) = VALUES_AT_ENDS.checked_div(2 * self.frees()) else { return Vec::new() };
        let is_coarse = |place: &&Place| place.u.iter().all(|u| [0.0, 0.5, 1.0].contains(u));
        let coarse = grid.iter().map(|(_, place)| *place).filter(is_coarse).take(most);
        self.at_worse_ends(quality, coarse.cloned())
    }

    /// Places with each tolerance at its worse end, worst first.
    pub(super) fn at_worse_ends(
        &self,
        quality: Quality,
        places: impl IntoIterator<Item = Place>,
    ) -> Vec<Worst> {
        let at_ends = |place| {
            let mut worst = self.worst_at(quality, place);
            self.to_ends(&mut worst);
            worst
        };
        let mut all: Vec<Worst> = places.into_iter().map(at_ends).collect();
        all.sort_by(|a, b| a.margin.total_cmp(&b.margin));
        all
    }

    /// A place with its margin.
    pub(super) fn worst_at(&self, quality: Quality, place: Place) -> Worst {
        let margin = self.margin_at(quality, &place);
        Worst { quality, place, margin }
    }

    /// The worst place found of every quality, from the worst points of the grid.
    pub fn worst_values(&self, finest: i32) -> Vec<Worst> {
        let grid: Vec<_> = self.grid().into_iter().map(|p| (self.at(&p), p)).collect();
        let worst = |quality| {
            // Tolerances are the most of what an accuracy is.
            let margin = |values, p: &Place| match self.farthest_off(quality, p) {
                Some(worse) => self.margin_at(quality, &worse),
                None => self.margin(quality, values),
            };
            let mut starts: Vec<(f64, &Place)> =
                grid.iter().map(|(values, p)| (margin(values, p), p)).collect();
            starts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let most = if self.box_.len() > MOST_AXES { MORE_STARTS } else { STARTS };
            let at_ends = self.corners_at_worse_ends(quality, &starts);
            let mut apart = Vec::new();
            add_apart(&mut apart, at_ends.iter().map(|worst| &worst.place), STARTS);
            let [always, most] = [STARTS, most].map(|own| apart.len() + own);
            add_apart(&mut apart, starts.into_iter().map(|(_, start)| start), most);
            let mut worst: Option<Worst> = None;
            for (number, start) in apart.into_iter().enumerate() {
                let is_close = |worst: &Worst| (0.0..CLOSE).contains(&worst.margin);
                if number >= always && !worst.as_ref().is_some_and(is_close) {
                    break;
                }
                let found = self.descended(quality, start, COARSE);
                if worst.as_ref().is_none_or(|worst| found.margin < worst.margin) {
                    worst = Some(found);
                }
            }
            let mut worst = worst?;
            self.across(&mut worst, COARSE);
            self.compass(&mut worst, 0..self.box_.len(), COARSE + 1..=finest);
            Some(worst)
        };
        self.qualities().into_iter().filter_map(worst).collect()
    }
}
