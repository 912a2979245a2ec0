//! Running one shard: again and again, from where it was stopped.
//!
//! The tree of every cell that is done is appended, with its SHA-256, to a file beside the result.
//! A run that is stopped, by whatever, loses the cell that it was at. What it left half-written, or
//! two runs of one shard at the same time wrote into each other, has no right sum and is done again.

use super::file::{read_result, sha256, text, FileError, Part, Shard, ShardResult, MAX_FILE};
use super::name::{name_of, Name};
use super::paving;
use super::task::Task;
use crate::files::output::{self, OutputError};
use crate::files::read;
use crate::files::read::Named;
use crate::questions::atlas::{grow, Growing, Stopped, Top};
use crate::search::paving::Cancelled;
use crate::search::solver;
use crate::search::solver::search::Outcome;
use crate::search::{Budget, Control, Stop};
use orthocert_kernel::certificate::AtlasCell;
use serde::{Deserialize, Serialize};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A cell that is done, a line of the progress file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    /// The shard's SHA-256.
    answers: String,
    cell: usize,
    sha256: String,
    part: Part,
}

/// What a run did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ran {
    /// The result was there already.
    AlreadyDone,
    /// The result was written; so many cells had been done by an earlier run.
    Done {
        /// Cells taken over.
        resumed: usize,
    },
}

/// Why a shard was not finished.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A file could not be read.
    #[error(transparent)]
    File(FileError),
    /// A file could not be written: what is done stays.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The place of the result holds that of another job.
    #[error("{}: is the result of a shard of another job", .0.shown())]
    OtherJob(PathBuf),
    /// The claim has no model, or what is found is too large.
    #[error("{0}")]
    Claim(String),
    /// It was cancelled.
    #[error("interrupted")]
    Interrupted,
}

impl From<Cancelled> for RunError {
    fn from(_: Cancelled) -> Self {
        RunError::Interrupted
    }
}

/// The files that a run of the shard in the file `path` writes.
pub fn written(path: &Path, shard: &Shard) -> [PathBuf; 3] {
    [result_file(path, shard), progress_file(path, shard), nodes_file(path, shard)]
}

/// Where the result of the shard in the file `path` goes.
pub fn result_file(path: &Path, shard: &Shard) -> PathBuf {
    path.with_file_name(name_of(Name::Result(shard.shard)))
}

/// Where a run of the shard in the file `path` keeps what is done.
fn progress_file(path: &Path, shard: &Shard) -> PathBuf {
    path.with_file_name(name_of(Name::Progress(shard.shard)))
}

/// Where a run of the shard in the file `path` writes the nodes of a paving.
fn nodes_file(path: &Path, shard: &Shard) -> PathBuf {
    path.with_file_name(name_of(Name::Nodes(shard.shard)))
}

/// Runs a shard, the text of whose file at `path` has the SHA-256 `answers`, unless that was done.
///
/// # Errors
/// [`RunError`]; what is done stays done.
pub fn run(
    path: &Path,
    shard: &Shard,
    answers: &str,
    control: &mut Control<'_>,
) -> Result<Ran, RunError> {
    let [target, progress, nodes] = written(path, shard);
    let in_nodes = matches!(shard.task, Task::Pave(_));
    output::probe(&target)?;
    // Before the work: a link among them would lead to a file of somebody else.
    [&target, &progress, &nodes].into_iter().try_for_each(|path| output::own(path))?;
    if target.exists() {
        match read_result(&target) {
            Ok(result) if result.job != shard.job => return Err(RunError::OtherJob(target)),
            Ok(result)
                if result.answers == answers
                    && result.is_whole()
                    && !(in_nodes && paving::objection(&nodes, &result.parts).is_some()) =>
            {
                remove(&progress);
                return Ok(Ran::AlreadyDone);
            }
            // Half a result, or that of another split: it is done again.
            _ => {}
        }
    }
    let mut parts = resumed(&progress, shard, answers);
    if in_nodes {
        paving::keep_written(&nodes, &mut parts);
    }
    let resumed = parts.iter().flatten().count();
    let mut at = 0;
    for (number, part) in parts.iter_mut().enumerate() {
        let found = match part.take() {
            Some(found) => found,
            None => {
                let share = |number: usize| number as f64 / shard.parts() as f64;
                let found = control.part([share(number), share(number + 1)], |control| {
                    grown(shard, number, (&nodes, at), control)
                })?;
                append(&progress, answers, number, &found)?;
                found
            }
        };
        at += found.bytes();
        *part = Some(found);
    }
    if in_nodes {
        paving::close(&nodes, at)?;
    }
    let parts = parts.into_iter().flatten().collect();
    let result = text(&ShardResult::new(shard, answers.to_owned(), parts)) + "\n";
    output::write(&target, result.as_bytes())?;
    remove(&progress);
    Ok(Ran::Done { resumed })
}

/// What is found of one of the shard's cells; nodes of pavings go to a file, from a byte of it on.
fn grown(
    shard: &Shard,
    number: usize,
    nodes: (&Path, u64),
    control: &mut Control<'_>,
) -> Result<Part, RunError> {
    if let Task::Verify(task) = &shard.task {
        let branch = shard.branches.get(number).ok_or(RunError::Interrupted)?;
        let budget = Budget { max_boxes: task.boxes, deadline: None };
        let found = solver::below(&task.claim, branch, budget, control)
            .map_err(|error| RunError::Claim(error.to_string()))?;
        let found = found.ok_or_else(|| RunError::Claim("a branch that is none".to_owned()))?;
        return match found.stop {
            Stop::Cancelled => Err(RunError::Interrupted),
            _ => {
                let Outcome { nodes, open, boxes, .. } = found;
                Ok(Part::Tree { nodes, open: open.len(), boxes })
            }
        };
    }
    // Every place was seen to be a cell when the shard was read.
    let place = shard.cells.get(number).ok_or(RunError::Interrupted)?;
    let root = place.cell().ok_or(RunError::Interrupted)?;
    match &shard.task {
        Task::Verify(_) => Err(RunError::Interrupted),
        Task::Atlas(design) => {
            let mut growing = Growing::new(design, control);
            let tree = grow(&mut growing, place.part(design.parameters.len()), None).map_err(
                |stopped| match stopped {
                    Stopped::Cancelled => RunError::Interrupted,
                    other => RunError::Claim(other.to_string()),
                },
            )?;
            let cells = tree.into_iter().map(|node| match node {
                Top::Cell(cell) => cell,
                // Grown to its end, a tree has none.
                Top::Waiting => AtlasCell::Undecided,
            });
            Ok(Part::Cells(cells.collect()))
        }
        Task::Pave(task) => {
            paving::grown(nodes, task, (root, &place.left), control.cancel).map(Part::Nodes)
        }
    }
}

/// What earlier runs have done.
fn resumed(progress: &Path, shard: &Shard, answers: &str) -> Vec<Option<Part>> {
    let mut parts = vec![None; shard.parts()];
    let written = read::read(progress, MAX_FILE).unwrap_or_default();
    for line in written.split(|byte| *byte == b'\n') {
        let Ok(line) = serde_json::from_slice::<Line>(line) else {
            continue;
        };
        let whole = line.answers == answers && line.sha256 == sha256(&text(&line.part));
        if let (true, Some(part)) = (whole, parts.get_mut(line.cell)) {
            *part = Some(line.part);
        }
    }
    parts
}

fn append(progress: &Path, answers: &str, cell: usize, part: &Part) -> Result<(), OutputError> {
    let (answers, part) = (answers.to_owned(), part.clone());
    let line = Line { answers, cell, sha256: sha256(&text(&part)), part };
    // A line feed first: it ends what a killed run may have left of a line.
    let line = format!("\n{}\n", text(&line));
    let mut file = output::open_own(progress, OpenOptions::new().create(true).append(true))?;
    let written = file.write_all(line.as_bytes()).and_then(|()| file.sync_data());
    written.map_err(|error| OutputError::Io(progress.to_owned(), error))
}

/// Removes what is of no more use; where that fails, it is in nobody's way.
fn remove(path: &Path) {
    let _ = fs::remove_file(path);
}
