//! From a job to its shards.

use super::file::{sha256, text, Job, Place, Shard, Task};
use crate::atlas::{grow, waiting, Growing, Interrupted};
use orthocert_checker::cell::Cell;
use std::sync::atomic::AtomicBool;

/// Cells that a shard has at least, where the tree has as many: dealt out in turn, so that costly
/// regions are shared out.
const CELLS_A_SHARD: usize = 4;

/// The job and the texts of its shards, in order.
///
/// # Errors
/// If it was cancelled.
pub fn split(
    task: &Task,
    shards: usize,
    cancel: &AtomicBool,
    done: &mut dyn FnMut(usize, f64),
) -> Result<(Job, Vec<String>), Interrupted> {
    let Task::Atlas(design) = task;
    let mut growing = Growing::new(design, cancel, done);
    let top = grow(&mut growing, Cell::ROOT, Some(shards.saturating_mul(CELLS_A_SHARD)))?;
    let cells = waiting(&top).unwrap_or_default();
    let texts: Vec<String> = (0..shards)
        .map(|shard| {
            let own = cells.iter().skip(shard).step_by(shards).filter_map(Place::of);
            text(&Shard::new(task.clone(), shard + 1, shards, own.collect())) + "\n"
        })
        .collect();
    let job = Job::new(task.clone(), top, texts.iter().map(|text| sha256(text)).collect());
    Ok((job, texts))
}
