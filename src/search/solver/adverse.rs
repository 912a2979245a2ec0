//! The machine within the tolerances that makes a requirement worst, and the point for it: nothing
//! rests on it.
//!
//! To first order a requirement is worst at an end of every tolerance. So each parameter in turn
//! is put at the end that is worse, the others as they are, and then the point is moved, until
//! neither helps. Where singular values coincide a first choice may be a wrong one: hence several
//! starts.

use super::sample::{Place, Quality, Sampler, Worst};
use super::violation;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::{Joint, Leg};
use std::f64::consts::TAU;

/// Places from which the search goes on, of those of the grid.
const STARTS: usize = 4;
/// Machines at pseudo-random ends of the tolerances, from which it is begun too.
const MACHINES: usize = 8;
/// Most alternations of machine and point.
const ROUNDS: usize = 8;
/// Most times that every parameter is looked at in one of them.
const SWEEPS: usize = 4;

impl Sampler<'_> {
    /// Of an accuracy, the machine that is farthest off at a point, to first order: each tolerance at the end
    /// that, by differences of the joint coordinates, goes with the worst signs. One end after the other
    /// would stop at other signs.
    pub(super) fn farthest_off(&self, quality: Quality, place: &Place) -> Option<Place> {
        let test = self.accuracy(quality).filter(|_| !self.free.is_empty())?;
        let rho = |t: &[f64]| -> Option<Vec<f64>> {
            let values = self.at_machine(quality, &Place { t: t.to_vec(), ..place.clone() });
            let joint = |leg: &Leg| match leg.rho? {
                Joint::Length(rho) => values.of(rho),
                Joint::Angle { cos, sin } => Some(values.of(sin)?.atan2(values.of(cos)?)),
            };
            self.problem().legs.iter().map(joint).collect()
        };
        let change = |j: usize| {
            let [low, high] = [0.0, 1.0].map(|end| {
                let mut t = place.t.clone();
                t[j] = end;
                rho(&t)
            });
            // Angles, to whole turns.
            let turned = |x: f64| if x.abs() > 3.0 { x - TAU * (x / TAU).round() } else { x };
            // Of a name of an atlas, which is the same in the machine in the middle, nothing.
            let part = self.tolerance_of(j);
            Some(high?.iter().zip(low?).map(|(high, low)| turned(high - low) * part).collect())
        };
        let changes: Vec<Vec<f64>> = (0..self.free.len()).map(change).collect::<Option<_>>()?;
        let at = self.at_machine(quality, place);
        let d = at.of(test.distance)?;
        let beta = |(i, (error, _)): (usize, &(Formula, _))| {
            let all: f64 = changes.iter().map(|change| change[i].abs()).sum();
            Some(at.of(*error)? + all / (2.0 * d))
        };
        let beta: Vec<f64> = test.joints.iter().enumerate().map(beta).collect::<Option<_>>()?;
        let signs = violation::farthest(&at, test, &beta)?;
        let mut found = place.clone();
        for (j, (t, change)) in found.t.iter_mut().zip(&changes).enumerate() {
            if self.tolerance_of(j) == 0.0 {
                continue;
            }
            let along: f64 = change.iter().zip(&signs).map(|(x, sign)| x * sign).sum();
            // What the joint has less than the machine in the middle, it is off by.
            *t = if along > 0.0 { 0.0 } else { 1.0 };
        }
        Some(found)
    }

    /// The worst value of every quality over the points and the machines, as far as it was found,
    /// down to steps of `2^-finest`.
    pub fn worst_machines(&self, finest: i32) -> Vec<Worst> {
        let qualities = self.qualities().into_iter();
        qualities.filter_map(|quality| self.worst_machine(quality, finest)).collect()
    }

    fn worst_machine(&self, quality: Quality, finest: i32) -> Option<Worst> {
        let mut starts = self.at_worse_ends(quality, self.grid());
        starts.truncate(STARTS);
        let first = starts.first()?.place.clone();
        let others = machines(first.t.len()).map(|t| Place { t, ..first.clone() });
        starts.extend(others.map(|place| self.worst_at(quality, place)));
        let found = starts.into_iter().map(|start| self.alternate(start, finest));
        let best = found.min_by(|a, b| a.margin.total_cmp(&b.margin))?;
        Some(self.inward(best, finest))
    }

    /// The same, of each quality from one place alone: from where machines of other tolerances were worst.
    pub fn worst_machines_from(&self, places: &[Worst], finest: i32) -> Vec<Worst> {
        let from = |known: &Worst| {
            let start = self.worst_at(known.quality, known.place.clone());
            self.inward(self.alternate(start, finest), finest)
        };
        places.iter().map(from).collect()
    }

    /// Where the worst is not at the ends after all.
    fn inward(&self, worst: Worst, finest: i32) -> Worst {
        let inner = self.descend(worst.quality, &worst.place, finest);
        if inner.margin < worst.margin {
            inner
        } else {
            worst
        }
    }

    /// Worsens the machine and the point in turn.
    fn alternate(&self, mut found: Worst, finest: i32) -> Worst {
        for _ in 0..ROUNDS {
            let before = found.margin;
            let worsened = |_: &usize| self.to_ends(&mut found);
            (0..SWEEPS).take_while(worsened).count();
            self.to_point(&mut found, finest);
            if found.margin >= before {
                break;
            }
        }
        found
    }
}

/// Machines at pseudo-random ends of the tolerances, always the same ones.
fn machines(parameters: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut state = 1u64;
    let mut end = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 63) as f64
    };
    (0..MACHINES).map(move |_| (0..parameters).map(|_| end()).collect())
}
