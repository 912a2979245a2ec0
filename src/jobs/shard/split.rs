//! From a job to its shards.

use super::file::{sha256, text, Job, JobTop, Place, Shard};
use super::paving;
use super::task::{Task, Verify};
use crate::design::AtlasDesign;
use crate::questions::atlas::{grow, waiting, Growing, Stopped};
use crate::search::solver;
use crate::search::solver::search::Branch;
use crate::search::{Control, Stop};

/// Cells that a shard has at least, where the tree has as many: dealt out in turn, so that costly
/// regions are shared out.
const CELLS_A_SHARD: usize = 4;

/// Why there is nothing to be dealt out.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SplitError {
    /// It was cancelled.
    #[error("interrupted")]
    Interrupted,
    /// The claim is not well formed.
    #[error("{0}")]
    Claim(String),
    /// The design is refuted by a single point.
    #[error(
        "the design is refuted by a single point, so that there is nothing to be shared out; \
         orthocert verify writes the certificate"
    )]
    Refuted,
    /// The map would not fit into a certificate.
    #[error("{}", Stopped::TooLarge)]
    TooLarge,
    /// The design's box cannot be paved.
    #[error("{0}")]
    Paving(String),
    /// A box near the top cannot be closed by splitting it.
    #[error("a box near the top of the tree cannot be closed; orthocert verify says why")]
    Hopeless,
}

/// The job and the texts of its shards, in order.
///
/// # Errors
/// If it was cancelled, or there is nothing to be dealt out.
pub fn split(
    task: &Task,
    shards: usize,
    control: &mut Control<'_>,
) -> Result<(Job, Vec<String>), SplitError> {
    let enough = shards.saturating_mul(CELLS_A_SHARD);
    let (top, cells, branches) = match task {
        Task::Atlas(design) => {
            let (top, cells) = of_atlas(design, enough, control)?;
            (top, cells, Vec::new())
        }
        Task::Verify(task) => {
            let (top, branches) = of_design(task, enough, control)?;
            (top, Vec::new(), branches)
        }
        Task::Pave(task) => {
            let (top, cells) = paving::top(task, shards, control.cancel)?;
            (top, cells, Vec::new())
        }
    };
    let texts: Vec<String> = (0..shards)
        .map(|shard| {
            let own = cells.iter().skip(shard).step_by(shards).cloned().collect();
            let below = branches.iter().skip(shard).step_by(shards).cloned().collect();
            text(&Shard::new(task.clone(), shard + 1, shards, own, below)) + "\n"
        })
        .collect();
    let job = Job::new(task.clone(), top, texts.iter().map(|text| sha256(text)).collect());
    Ok((job, texts))
}

fn of_atlas(
    design: &AtlasDesign,
    enough: usize,
    control: &mut Control<'_>,
) -> Result<(JobTop, Vec<Place>), SplitError> {
    let mut growing = Growing::new(design, control);
    let top =
        grow(&mut growing, design.whole(), Some(enough)).map_err(|stopped| match stopped {
            Stopped::Cancelled => SplitError::Interrupted,
            Stopped::TooLarge | Stopped::Time | Stopped::Unkept(_) => SplitError::TooLarge,
        })?;
    let cells = waiting(&top, design.whole()).unwrap_or_default();
    let places = cells.iter().map(|part| Place::of_part(part)).collect();
    Ok((JobTop::Cells(top), places))
}

fn of_design(
    task: &Verify,
    enough: usize,
    control: &mut Control<'_>,
) -> Result<(JobTop, Vec<Branch>), SplitError> {
    let found = solver::top(&task.claim, enough, control)
        .map_err(|error| SplitError::Claim(error.to_string()))?;
    let found = found.ok_or(SplitError::Refuted)?;
    if found.stop == Stop::Cancelled {
        return Err(SplitError::Interrupted);
    }
    if found.open.len() > found.waiting.len() {
        return Err(SplitError::Hopeless);
    }
    let (waiting, branches) = found.waiting.into_iter().unzip();
    Ok((JobTop::Tree { nodes: found.nodes, waiting, boxes: found.boxes }, branches))
}
