//! What remains of an undecided claim: how much, where, why, and what would help.

use super::facts::Facts;
use super::share::sum_above;
use crate::exact::decimal::boxes;
use crate::search::solver::sample::{At, Quality, Worst};
use crate::search::solver::search::Open;
use crate::search::solver::{self, Undecided};
use crate::search::Stop;
use orthocert_checker::Rejected;
use orthocert_kernel::claim::{Bound, Orientation, Workspace};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Margins below this are ties, as far as doubles can tell.
const TIE: f64 = 1e-9;
/// Relative margin of an accuracy beyond which its bound is what makes it hard.
const AMPLE: f64 = 0.75;
/// Regions that are described one by one.
const REGIONS: usize = 12;
/// Boxes that are brought together; more are left out of the regions.
const MOST_BOXES: usize = 2000;

/// What is open.
#[derive(Clone, Debug, Serialize)]
pub struct Remains {
    /// Why the search ended.
    pub reason: String,
    /// Boxes on which something is open.
    pub boxes: usize,
    /// Their volume, of all coordinates; at most the workspace's.
    pub volume: f64,
    /// Their share of the workspace, rounded up.
    pub share: f64,
    /// Boxes that are neighbours, merged; the largest ones.
    pub regions: Vec<OpenRegion>,
    /// How many regions there are.
    pub region_count: usize,
    /// The remaining box at whose centre a requirement is closest to its bound, or beyond.
    pub worst_box: Option<WorstBox>,
    /// For every requirement that is open, where and why.
    pub open: Vec<OpenRequirement>,
}

/// Neighbouring open boxes.
#[derive(Clone, Debug, Serialize)]
pub struct OpenRegion {
    /// How many.
    pub boxes: usize,
    /// Their share of the workspace, rounded up.
    pub share: f64,
    /// The least coordinates of their hull, in the design's unit.
    pub min: Vec<f64>,
    /// The greatest.
    pub max: Vec<f64>,
}

/// The box of most concern.
#[derive(Clone, Debug, Serialize)]
pub struct WorstBox {
    /// Least coordinates, in the design's unit.
    pub min: Vec<f64>,
    /// Greatest coordinates.
    pub max: Vec<f64>,
    /// The requirement that is closest to being violated at its centre.
    pub requirement: String,
    /// Margin there, relative to the bound; negative where it is violated.
    pub margin: f64,
}

/// A requirement that is not shown everywhere.
#[derive(Clone, Debug, Serialize)]
pub struct OpenRequirement {
    /// The obligation's name in certificates.
    pub obligation: String,
    /// What it says.
    pub requirement: String,
    /// Boxes on which it is open.
    pub boxes: usize,
    /// Their share of the workspace, rounded up.
    pub share: f64,
    /// Why it is open there.
    pub reason: &'static str,
    /// What would help.
    pub help: &'static str,
}

/// Why a search that tried so many boxes ended without an answer.
pub fn reason(objection: Option<&Rejected>, stop: Stop, tried: usize) -> String {
    if let Some(Rejected::Work) = objection {
        return format!(
            "after {}, the proof that was found is longer than is admissible; fewer requirements at a time, a smaller \
             workspace or wider bounds have shorter ones",
            boxes(tried)
        );
    }
    if let Some(objection) = objection {
        return format!("what was found is not accepted by the exact checker: {objection}");
    }
    let tried = boxes(tried);
    match stop {
        Stop::Boxes => format!("the budget of {tried} is used up"),
        Stop::Time => format!("the time is used up, after {tried}"),
        Stop::Exhausted | Stop::Hopeless => {
            format!("after {tried}, splitting the remaining ones further cannot close them")
        }
        Stop::Cancelled => "it was interrupted".to_owned(),
    }
}

impl Facts<'_> {
    /// What an undecided claim leaves open.
    pub fn remains(&self, undecided: &Undecided, worst: &[Worst], tried: usize) -> Remains {
        let open = &undecided.open;
        let [min, max] = &self.sampler.ends();
        let volume: f64 = min.iter().zip(max).map(|(min, max)| max - min).product();
        let total = self.of_workspace(open.iter().map(share).fold(0.0, sum_above));
        let all = regions(open);
        let region = |region: &Region| {
            let [min, max] = self.extent(&region.cell);
            OpenRegion { boxes: region.boxes, share: self.of_workspace(region.share), min, max }
        };
        Remains {
            reason: reason(undecided.objection.as_ref(), undecided.stop, tried),
            boxes: open.len(),
            volume: total * volume / self.box_of_workspace(),
            share: total,
            region_count: all.len(),
            regions: all.iter().take(REGIONS).map(region).collect(),
            worst_box: self.worst_box(open),
            open: self.open(undecided, worst),
        }
    }

    /// The box around the workspace, in parts of it: boxes of a cylinder are parts of that box. With a set of
    /// orientations, which is a part of its box that is not known, shares are of the box around all.
    fn box_of_workspace(&self) -> f64 {
        match (&self.claim.workspace, &self.claim.orientation) {
            (Workspace::Cylinder { .. }, None | Some(Orientation::Range(_))) => {
                std::f64::consts::FRAC_PI_4.recip().next_up()
            }
            _ => 1.0,
        }
    }

    /// The share of the workspace of a share of the box around it, or more.
    fn of_workspace(&self, share: f64) -> f64 {
        match self.box_of_workspace() {
            1.0 => share,
            part => (share * part).next_up().min(1.0),
        }
    }

    fn extent(&self, cell: &[(f64, f64)]) -> [Vec<f64>; 2] {
        let end = |of: fn(&(f64, f64)) -> f64| {
            let edges = cell.iter().enumerate();
            edges.map(|(k, edge)| of(edge) * self.sampler.unit_of(k)).collect()
        };
        [end(|x| x.0), end(|x| x.1)]
    }

    fn worst_box(&self, open: &[Open]) -> Option<WorstBox> {
        let stride = open.len().div_ceil(MOST_BOXES).max(1);
        let at_centre = |item: &Open| {
            let values = self.sampler.at(&self.sampler.place_in(&item.cell));
            let all = item.obligations.iter().map(|&number| Quality::Obligation(number));
            let margins = all.map(|quality| (self.relative_margin(quality, &values), quality));
            margins.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let boxes = open.iter().step_by(stride).filter_map(|item| Some((item, at_centre(item)?)));
        let (item, (margin, quality)) = boxes.min_by(|a, b| a.1 .0.total_cmp(&b.1 .0))?;
        let [min, max] = self.extent(&item.cell);
        Some(WorstBox { min, max, requirement: self.words(quality), margin })
    }

    /// Tests of one requirement that are told in the same words are one.
    fn open(&self, undecided: &Undecided, worst: &[Worst]) -> Vec<OpenRequirement> {
        let mut all = BTreeMap::new();
        let numbers: BTreeSet<usize> =
            undecided.open.iter().flat_map(|item| item.obligations.iter().copied()).collect();
        for number in numbers {
            let requirement = self.problem.obligations[number].requirement;
            let told = (requirement, self.words(Quality::Obligation(number)));
            all.entry(told).or_insert_with(Vec::new).push(number);
        }
        let of = |((_, requirement), numbers): ((_, _), Vec<usize>)| {
            let is_open =
                |item: &&Open| numbers.iter().any(|number| item.obligations.contains(number));
            let boxes = || undecided.open.iter().filter(is_open);
            let margins = numbers.iter().map(|&number| {
                let quality = Quality::Obligation(number);
                let found = worst.iter().find(|found| found.quality == quality);
                let at = |found: &Worst| self.sampler.at(&found.place);
                (found.map(|found| self.relative_margin(quality, &at(found))), quality)
            });
            let far = |margin: Option<f64>| margin.unwrap_or(f64::INFINITY);
            let (margin, quality) = margins.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
            let rule =
                self.bounded(quality).map_or("singularity".to_owned(), |b| b.requirement.quantity);
            let reason = match undecided.stop {
                Stop::Exhausted | Stop::Hopeless => "the test does not hold",
                Stop::Boxes | Stop::Time | Stop::Cancelled => "not shown within the budget",
            };
            Some(OpenRequirement {
                obligation: rule,
                requirement,
                boxes: boxes().count(),
                share: self.of_workspace(boxes().map(share).fold(0.0, sum_above)),
                reason,
                help: self.help((quality, worst), undecided.stop, margin),
            })
        };
        all.into_iter().filter_map(of).collect()
    }

    /// The margin relative to the bound, which that of a joint speed's test, a product of several quantities, is not.
    fn relative_margin(&self, quality: Quality, values: &At<'_>) -> f64 {
        let of_speed = || {
            let bounded = self.bounded(quality)?;
            match (bounded.requirement.quantity.as_str(), &bounded.requirement.bound) {
                ("joint_speed", Bound::Max(max)) => {
                    let value = bounded.known(self.problem, &self.sampler, values)?;
                    Some(1.0 - value / solver::approximate(max)?)
                }
                _ => None,
            }
        };
        let of_speed = of_speed().filter(|margin| margin.is_finite());
        of_speed.unwrap_or_else(|| self.sampler.margin(quality, values))
    }

    fn help(
        &self,
        (quality, worst): (Quality, &[Worst]),
        stop: Stop,
        margin: Option<f64>,
    ) -> &'static str {
        let is_accuracy = |quality| {
            self.bounded(quality).is_some_and(|own| own.requirement.quantity == "accuracy")
        };
        // Of the distance or of the angle.
        let is_ample = || {
            let mut parts = worst.iter().filter(|found| is_accuracy(found.quality));
            parts.any(|found| found.margin > AMPLE)
        };
        let is_wide = |margin| margin > TIE && is_accuracy(quality) && is_ample();
        match (stop, margin) {
            (Stop::Exhausted | Stop::Hopeless, Some(margin)) if is_wide(margin) => {
                "smaller bounds: within them there is to be no second pose, which is the harder to show \
                 the more room they leave"
            }
            (_, Some(margin)) if is_wide(margin) => {
                "a larger budget: --max-boxes, --timeout; or smaller bounds: within them there is to be no \
                 second pose, which is the harder to show the more room they leave"
            }
            (_, Some(margin)) if margin.abs() <= TIE => {
                "it holds with equality, or nearly, somewhere; no splitting decides a tie: give the \
                 bound or the workspace a little more room"
            }
            (Stop::Exhausted | Stop::Hopeless, _) if self.problem.tolerances().next().is_some() => {
                "narrower tolerances, or more room in the bounds: no test covers all machines within \
                 the tolerances at once"
            }
            (Stop::Exhausted | Stop::Hopeless, _) => {
                "more room in the bounds, or a smaller workspace: even the centres of the remaining \
                 boxes are too close to the bound for the tests"
            }
            (Stop::Boxes | Stop::Time | Stop::Cancelled, _) => {
                "a larger budget: --max-boxes, --timeout"
            }
        }
    }
}

/// Open boxes that touch.
struct Region {
    boxes: usize,
    share: f64,
    cell: Vec<(f64, f64)>,
}

fn share(item: &Open) -> f64 {
    (-f64::from(item.depth)).exp2()
}

/// The regions of the largest boxes, greatest share first.
fn regions(open: &[Open]) -> Vec<Region> {
    let mut largest: Vec<&Open> = open.iter().collect();
    largest.sort_by_key(|item| item.depth);
    let mut all: Vec<Region> = Vec::new();
    let mut members: Vec<Vec<&Open>> = Vec::new();
    for item in largest.into_iter().take(MOST_BOXES) {
        let touch = |other: &&Open| {
            let mut both = item.cell.iter().zip(&other.cell);
            both.all(|(a, b)| a.0 <= b.1 && b.0 <= a.1)
        };
        let (near, far) =
            members.into_iter().partition(|region: &Vec<&Open>| region.iter().any(touch));
        let near: Vec<Vec<&Open>> = near;
        members = far;
        members.push(near.into_iter().flatten().chain([item]).collect());
    }
    for region in members {
        let mut cell = region[0].cell.clone();
        for other in &region {
            for (hull, edge) in cell.iter_mut().zip(&other.cell) {
                *hull = (hull.0.min(edge.0), hull.1.max(edge.1));
            }
        }
        let share = region.iter().map(|item| share(item)).fold(0.0, sum_above);
        all.push(Region { boxes: region.len(), share, cell });
    }
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}
