//! What remains of an undecided claim: how much, where, why, and what would help.

use super::place::{point_text, Frame};
use super::regions::{ends, regions, share, sum_above, Region};
use super::worst::{bound, obligation};
use crate::decimal::{boxes, exact, significant};
use crate::sample::{Place, Quality, Sampler};
use crate::search::{OpenBox, Stop};
use crate::verify::{Undecided, Worst};
use orthocert_checker::claim::MachineClaim;
use orthocert_checker::rule::{Failure, Obligation};
use orthocert_checker::Rejected;
use serde::Serialize;
use std::collections::BTreeMap;

/// Regions that are described one by one.
const REGIONS: usize = 12;
/// Open boxes of which the worst is looked for.
const LOOKED_AT: usize = 4096;
/// What the vertex rules object, whichever vertex it is.
const NOT_DEFINITE: &str = "the vertex rule's matrix is not certainly positive definite";
/// Relative margins below this are ties, as far as doubles can tell.
const TIE: f64 = 1e-9;

/// What is open.
#[derive(Clone, Debug, Serialize)]
pub struct Remains {
    /// Why the search ended.
    pub reason: String,
    /// Boxes on which something is open.
    pub boxes: usize,
    /// Their volume, in cubes of the design's unit.
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
    /// Why the rules did not close them, and how many; most frequent first.
    pub reasons: Vec<(String, usize)>,
    /// What would help.
    pub help: String,
}

/// What a report about open boxes draws from.
pub struct Remaining<'a> {
    /// The claim.
    pub claim: &'a MachineClaim,
    /// Its sampler.
    pub sampler: &'a Sampler,
    /// Its frame.
    pub frame: &'a Frame,
    /// The worst values found.
    pub worst: &'a [Worst],
    /// Boxes tried.
    pub boxes: usize,
}

/// Why a search that tried so many boxes ended without an answer.
pub fn reason(objection: Option<&Rejected>, stop: Stop, tried: usize) -> String {
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

impl Remaining<'_> {
    /// The report.
    pub fn report(&self, undecided: &Undecided) -> Remains {
        let open = &undecided.open;
        let total: f64 = open.iter().map(|item| share(&item.cell)).fold(0.0, sum_above);
        let all = regions(open);
        Remains {
            reason: reason(undecided.objection.as_ref(), undecided.stop, self.boxes),
            boxes: open.len(),
            volume: total * self.frame.volume(),
            share: total,
            region_count: all.len(),
            regions: all.iter().take(REGIONS).map(|region| self.region(region)).collect(),
            worst_box: self.worst_box(open),
            open: self.requirements(undecided),
        }
    }

    fn region(&self, region: &Region) -> OpenRegion {
        OpenRegion {
            boxes: region.boxes,
            share: region.share,
            min: self.frame.point(&region.min).to_vec(),
            max: self.frame.point(&region.max).to_vec(),
        }
    }

    /// Looks at the centres of the open boxes, with the middle machine.
    fn worst_box(&self, open: &[OpenBox]) -> Option<WorstBox> {
        let t = vec![0.5; self.sampler.parameters()];
        let stride = open.len().div_ceil(LOOKED_AT).max(1);
        let at_centre = |item: &OpenBox| -> Option<(f64, Quality)> {
            let (min, max) = ends(&item.cell);
            let u = [0, 1, 2].map(|k| 0.5 * (min[k] + max[k]));
            let values = self.sampler.at(&Place { u, t: t.clone() });
            let is_open = |q: &Quality| item.open.iter().any(|(o, _)| *o == obligation(*q));
            let qualities = self.sampler.qualities().into_iter().filter(is_open);
            qualities
                .filter(|quality| bound(self.claim, *quality).is_some())
                .filter_map(|quality| Some((self.sampler.margin(quality, &values)?, quality)))
                .min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let (item, (margin, quality)) = open
            .iter()
            .step_by(stride)
            .filter_map(|item| Some((item, at_centre(item)?)))
            .min_by(|a, b| a.1 .0.total_cmp(&b.1 .0))?;
        let (min, max) = ends(&item.cell);
        let [min, max] = [min, max].map(|end| self.frame.point(&end).to_vec());
        Some(WorstBox { min, max, requirement: self.words(quality), margin })
    }

    fn words(&self, quality: Quality) -> String {
        bound(self.claim, quality)
            .map(|b| format!("{} {} {}", b.requirement, b.relation, exact(&b.number)))
            .unwrap_or_default()
    }

    fn requirements(&self, undecided: &Undecided) -> Vec<OpenRequirement> {
        let of = |obligation: Obligation| {
            let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
            let (mut boxes, mut open_share) = (0, 0.0);
            for item in &undecided.open {
                let Some((_, failure)) = item.open.iter().find(|(o, _)| *o == obligation) else {
                    continue;
                };
                let reason = match failure {
                    Some(Failure::NotDefinite { .. }) => NOT_DEFINITE.to_owned(),
                    Some(failure) => failure.to_string(),
                    None => "not tried within the budget".to_owned(),
                };
                *reasons.entry(reason).or_default() += 1;
                boxes += 1;
                open_share = sum_above(open_share, share(&item.cell));
            }
            let mut reasons: Vec<_> = reasons.into_iter().collect();
            reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
            (boxes > 0).then(|| OpenRequirement {
                obligation: obligation.to_string(),
                requirement: self.demands(obligation),
                boxes,
                share: open_share,
                reasons,
                help: self.help(obligation, undecided),
            })
        };
        Obligation::ALL.into_iter().filter_map(of).collect()
    }

    /// Everything that an obligation demands.
    fn demands(&self, of: Obligation) -> String {
        let qualities = self.sampler.qualities().into_iter().filter(|q| obligation(*q) == of);
        let words: Vec<String> =
            qualities.map(|q| self.words(q)).filter(|words| !words.is_empty()).collect();
        words.join(", ")
    }

    /// What would help: the tightest requirement of the obligation tells.
    fn help(&self, of: Obligation, undecided: &Undecided) -> String {
        let bounded =
            |w: &&Worst| obligation(w.quality) == of && !matches!(w.quality, Quality::Clearance);
        let tightest =
            self.worst.iter().filter(bounded).min_by(|a, b| a.margin.total_cmp(&b.margin));
        let budget = "a larger budget: --max-boxes, --timeout";
        if let Some(tie) = tightest.filter(|w| w.margin.abs() <= TIE) {
            let tied = self.words(tie.quality);
            let place = point_text(&self.frame.point(&tie.place.u), 9);
            return format!(
                "{tied} holds with equality, or nearly, at P = {place} (relative margin {}); no \
                 splitting decides a tie: give the bound or the workspace a little more room",
                significant(tie.margin, 2)
            );
        }
        match (undecided.stop, tightest) {
            (Stop::Exhausted | Stop::Hopeless, Some(w)) if self.sampler.parameters() > 0 => format!(
                "narrower tolerances, or more room in the bounds: no violation was found ({} keeps \
                 a relative margin of {}), but no rule covers all machines within the tolerances at \
                 once",
                self.words(w.quality),
                significant(w.margin, 2)
            ),
            (Stop::Exhausted | Stop::Hopeless, _) => {
                "more room in the bounds, or a smaller workspace: even the centres of the remaining \
                 boxes are too close to the bound for the rules"
                    .to_owned()
            }
            (_, Some(w)) => {
                let also = if self.sampler.parameters() > 0 { " or narrower tolerances" } else { "" };
                format!(
                    "{budget}; the worst value found keeps a relative margin of {}, so more room \
                     in the bounds{also} would need fewer boxes",
                    significant(w.margin, 2)
                )
            }
            _ => budget.to_owned(),
        }
    }
}
