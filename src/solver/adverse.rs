//! The machine within the tolerances that makes a requirement worst, and the point for it: nothing
//! rests on it.
//!
//! To first order a requirement is worst at an end of every tolerance. So each parameter in turn
//! is put at the end that is worse, the others as they are, and then the point is moved, until
//! neither helps. Where singular values coincide a first choice may be a wrong one: hence several
//! starts.

use super::sample::{Place, Quality, Sampler, Worst};

/// Places from which the search goes on, of those of the grid.
const STARTS: usize = 4;
/// Machines at pseudo-random ends of the tolerances, from which it is begun too.
const MACHINES: usize = 8;
/// Most alternations of machine and point.
const ROUNDS: usize = 8;
/// Most times that every parameter is looked at in one of them.
const SWEEPS: usize = 4;

impl Sampler<'_> {
    /// The worst value of every quality over the points and the machines, as far as it was found,
    /// down to steps of `2^-finest`.
    pub fn worst_machines(&self, finest: i32) -> Vec<Worst> {
        let qualities = self.qualities().into_iter();
        qualities.filter_map(|quality| self.worst_machine(quality, finest)).collect()
    }

    fn worst_machine(&self, quality: Quality, finest: i32) -> Option<Worst> {
        let at = |place: Place| {
            let margin = self.margin_at(quality, &place);
            Worst { quality, place, margin }
        };
        let mut starts: Vec<Worst> = Vec::new();
        for place in self.grid() {
            let mut start = at(place);
            self.to_ends(&mut start);
            starts.push(start);
        }
        starts.sort_by(|a, b| a.margin.total_cmp(&b.margin));
        starts.truncate(STARTS);
        let first = starts.first()?.place.clone();
        starts.extend(machines(first.t.len()).map(|t| at(Place { t, ..first.clone() })));
        let found = starts.into_iter().map(|start| self.alternate(start, finest));
        let best = found.min_by(|a, b| a.margin.total_cmp(&b.margin))?;
        // Where the worst is not at the ends after all.
        let inner = self.descend(quality, &best.place, finest);
        Some(if inner.margin < best.margin { inner } else { best })
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
