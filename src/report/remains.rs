//! What remains of an undecided claim: how much, where, why, and what would help.

use crate::exact::decimal::boxes;
use crate::search::Stop;
use orthocert_checker::Rejected;
use serde::Serialize;

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
