//! The machine within the tolerances that makes a requirement worst, and the point for it: nothing
//! rests on it.
//!
//! To first order a requirement is worst at an end of every tolerance. So each parameter in turn
//! is put at the end that is worse, the others as they are, and then the point is moved, until
//! neither helps. Where singular values coincide a first choice may be a wrong one: hence several
//! starts.

use crate::sample::{Place, Quality, Sampler};
use crate::verify::Worst;

/// Places from which the search goes on, of those of the grid.
const STARTS: usize = 4;
/// Machines at pseudo-random ends of the tolerances, from which it is begun too.
const MACHINES: usize = 8;
/// Most alternations of machine and point.
const ROUNDS: usize = 8;
/// Most times that every parameter is looked at in one of them.
const SWEEPS: usize = 4;

/// The worst value of every requirement over the points and the machines, as far as it was found,
/// down to steps of `2^-finest`.
pub fn worst_machines(sampler: &Sampler, finest: i32) -> Vec<Worst> {
    let qualities = sampler.qualities().into_iter();
    qualities.filter_map(|quality| worst_machine(sampler, quality, finest)).collect()
}

fn worst_machine(sampler: &Sampler, quality: Quality, finest: i32) -> Option<Worst> {
    let search = Search { sampler, quality, finest };
    let mut starts: Vec<Found> = Vec::new();
    for place in sampler.grid() {
        starts.push(search.swept(search.at(place)));
    }
    starts.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    starts.truncate(STARTS);
    let point = starts.first()?.place.u;
    starts.extend(machines(sampler.parameters()).map(|t| search.at(Place { u: point, t })));
    let found = starts.into_iter().map(|start| search.alternate(start));
    let best = found.min_by(|a, b| a.margin.total_cmp(&b.margin))?;
    // Where the worst is not at the ends after all.
    let (margin, place) = sampler.descend(quality, &best.place, finest);
    Some(Worst { quality, place, margin })
}

/// Machines at pseudo-random ends of the tolerances, always the same ones.
fn machines(parameters: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut state = 1u64;
    let mut end = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        if state >> 63 == 1 {
            1.0
        } else {
            0.0
        }
    };
    (0..MACHINES).map(move |_| (0..parameters).map(|_| end()).collect())
}

struct Search<'a> {
    sampler: &'a Sampler,
    quality: Quality,
    finest: i32,
}

/// A place, and how far the requirement is from being violated there.
struct Found {
    margin: f64,
    place: Place,
}

impl Search<'_> {
    fn margin(&self, place: &Place) -> f64 {
        self.sampler.margin(self.quality, &self.sampler.at(place)).unwrap_or(f64::MAX)
    }

    fn at(&self, place: Place) -> Found {
        Found { margin: self.margin(&place), place }
    }

    /// Puts each parameter in turn at the worse end of its tolerance.
    fn swept(&self, mut found: Found) -> Found {
        for k in 0..found.place.t.len() {
            let before = found.place.t[k];
            let mut best = before;
            for end in [0.0, 1.0] {
                if end == before {
                    continue;
                }
                found.place.t[k] = end;
                let margin = self.margin(&found.place);
                if margin < found.margin {
                    (found.margin, best) = (margin, end);
                }
            }
            found.place.t[k] = best;
        }
        found
    }

    /// Worsens the machine and the point in turn.
    fn alternate(&self, mut found: Found) -> Found {
        for _ in 0..ROUNDS {
            let before = found.margin;
            for _ in 0..SWEEPS {
                let last = found.margin;
                found = self.swept(found);
                if found.margin >= last {
                    break;
                }
            }
            let (margin, place) =
                self.sampler.descend_to_point(self.quality, &found.place, self.finest);
            found = Found { margin, place };
            if found.margin >= before {
                break;
            }
        }
        found
    }
}
