//! The files of a job in parts, and reading them.

use super::task::Task;
use crate::files::digest;
use crate::files::read;
use crate::files::read::Named;
use crate::files::shown::Shown;
use crate::questions::atlas::Top;
use crate::search::solver::search::Branch;
use orthocert_kernel::certificate::{AtlasCell, Node};
use orthocert_kernel::paving::{Cell, Edge};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Most shards of a job.
pub const MAX_SHARDS: u64 = 10_000;
/// Most bytes of one of these files.
pub(super) const MAX_FILE: u64 = 1 << 30;

const JOB: &str = "orthocert-job/1";
const SHARD: &str = "orthocert-shard/1";
const RESULT: &str = "orthocert-result/1";

/// A cell in a file: index and level of its edges.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    pub(super) edges: [(u64, u32); 3],
    /// Of a paving, what is open by its number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) left: Vec<usize>,
}

/// Deepest level of an edge in a file.
const MAX_LEVEL: u32 = 60;

impl Place {
    /// The place of a cell; `None` beyond the depth of files.
    pub fn of(cell: &Cell) -> Option<Self> {
        let mut edges = [(0, 0); 3];
        for (place, edge) in edges.iter_mut().zip(&cell.edges) {
            *place = (edge.index(), edge.level());
        }
        let place = Place { edges, left: Vec::new() };
        place.cell().is_some().then_some(place)
    }

    /// The place of a cell of an atlas.
    pub fn of_part(part: &[(u64, u32)]) -> Self {
        let mut edges = [(0, 0); 3];
        edges.iter_mut().zip(part).for_each(|(edge, own)| *edge = *own);
        Place { edges, left: Vec::new() }
    }

    /// The cell of an atlas of so many parameters.
    pub fn part(&self, parameters: usize) -> orthocert_kernel::atlas::Part {
        self.edges.iter().take(parameters).copied().collect()
    }

    /// The cell; `None` if it is not within the box.
    pub fn cell(&self) -> Option<Cell> {
        let edge = |(index, level): (u64, u32)| {
            let within = level <= MAX_LEVEL && index < 1 << level;
            within.then(|| Edge(index + (1 << level)))
        };
        let [x, y, z] = self.edges;
        Some(Cell { edges: [edge(x)?, edge(y)?, edge(z)?], ..Cell::ROOT })
    }
}

/// What was found of a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Part {
    /// The cells of parameters below it.
    Cells(Vec<AtlasCell>),
    /// The nodes of the tree below it.
    Tree {
        /// In preorder.
        nodes: Vec<Node>,
        /// Boxes on which something is open: none in a proof.
        open: usize,
        /// Boxes tried.
        boxes: usize,
    },
    /// The nodes of a paving below it, which are in the [`Name::Nodes`](super::Name::Nodes) beside the result, those of
    /// one cell after those of the other.
    Nodes(Nodes),
}

impl Part {
    /// The bytes that it has in the file beside the result.
    pub fn bytes(&self) -> u64 {
        match self {
            Part::Nodes(nodes) => nodes.bytes,
            Part::Cells(_) | Part::Tree { .. } => 0,
        }
    }
}

/// A stretch of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nodes {
    /// Its length.
    pub bytes: u64,
    /// The SHA-256 of the bytes.
    pub sha256: String,
}

/// A stretch of the top of a paving's tree.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Stretch {
    /// Nodes, as in a paving, in hexadecimal.
    Nodes(String),
    /// A cell that is dealt out.
    Waiting,
}

/// The top of a job's tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JobTop {
    /// Of an atlas.
    Cells(Vec<Top>),
    /// Of a design to be proved.
    Tree {
        /// In preorder.
        nodes: Vec<Node>,
        /// The positions of the cells that are dealt out, ascending.
        waiting: Vec<usize>,
        /// Boxes tried.
        boxes: usize,
    },
    /// Of a paving.
    Paving(Vec<Stretch>),
}

impl JobTop {
    /// How many cells are dealt out.
    pub fn waiting(&self) -> usize {
        match self {
            JobTop::Cells(top) => top.iter().filter(|node| **node == Top::Waiting).count(),
            JobTop::Tree { waiting, .. } => waiting.len(),
            JobTop::Paving(top) => top.iter().filter(|part| **part == Stretch::Waiting).count(),
        }
    }
}

/// The job as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    format: String,
    /// [`Task::identity`].
    pub job: String,
    /// What is to be done.
    pub task: Task,
    /// The top of the tree; its waiting cells are dealt out to the shards in turn.
    pub top: JobTop,
    /// The SHA-256 of every shard's file, in order.
    pub shards: Vec<String>,
}

/// A part of a job, complete in itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    format: String,
    /// [`Task::identity`].
    pub job: String,
    /// The number of the shard, from one.
    pub shard: usize,
    /// How many there are.
    pub of: usize,
    /// What is to be done.
    pub task: Task,
    /// The cells to be grown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cells: Vec<Place>,
    /// Of a design to be proved, the branches of its tree to be grown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<Branch>,
}

/// What a shard found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShardResult {
    format: String,
    /// [`Task::identity`].
    pub job: String,
    /// The number of the shard.
    pub shard: usize,
    /// The SHA-256 of the shard's file.
    pub answers: String,
    /// The SHA-256 of the parts' text.
    pub sha256: String,
    /// What was found of each of the shard's cells.
    pub parts: Vec<Part>,
}

impl Job {
    /// A job.
    pub fn new(task: Task, top: JobTop, shards: Vec<String>) -> Self {
        Job { format: JOB.to_owned(), job: task.identity(), task, top, shards }
    }
}

impl Shard {
    /// A shard.
    pub fn new(
        task: Task,
        shard: usize,
        of: usize,
        cells: Vec<Place>,
        branches: Vec<Branch>,
    ) -> Self {
        Shard { format: SHARD.to_owned(), job: task.identity(), shard, of, task, cells, branches }
    }

    /// How many parts there are of it.
    pub fn parts(&self) -> usize {
        self.cells.len() + self.branches.len()
    }
}

impl ShardResult {
    /// The result of a shard with this file.
    pub fn new(shard: &Shard, answers: String, parts: Vec<Part>) -> Self {
        let (job, shard) = (shard.job.clone(), shard.shard);
        let sha256 = sha256(&text(&parts));
        ShardResult { format: RESULT.to_owned(), job, shard, answers, sha256, parts }
    }

    /// Whether the content is what was written.
    pub fn is_whole(&self) -> bool {
        self.format == RESULT && self.sha256 == sha256(&text(&self.parts))
    }
}

/// Why a file is of no use.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system's reason.
    #[error("{path}: cannot be read: {1}", path = .0.shown())]
    Unreadable(PathBuf, std::io::Error),
    /// Not a file of the kind, or not of this version; why.
    #[error("{path}: found {why}; accepted: {1}", path = .0.shown(), why = Shown(.2))]
    Malformed(PathBuf, &'static str, String),
    /// What the file calls its job is not its task's identity.
    #[error("{}: was altered: its task is not the one that its \"job\" identifies", .0.shown())]
    Altered(PathBuf),
}

/// The lower-case hexadecimal SHA-256 of a text.
pub fn sha256(text: &str) -> String {
    digest::sha256(text.as_bytes())
}

/// The text of a value, a function of the value; these values have one.
pub(super) fn text(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

/// The text of a file of a job.
pub(super) fn read_text(path: &Path) -> Result<String, FileError> {
    let unreadable = |error| FileError::Unreadable(path.to_owned(), error);
    let malformed =
        |why: &str| FileError::Malformed(path.to_owned(), "a file of a job", why.to_owned());
    let bytes = read::read(path, MAX_FILE).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE {
        return Err(malformed("more than 1 GiB"));
    }
    String::from_utf8(bytes).map_err(|_| malformed("no UTF-8 text"))
}

fn parse<T: DeserializeOwned>(path: &Path, text: &str, kind: &'static str) -> Result<T, FileError> {
    serde_json::from_slice(text.as_bytes())
        .map_err(|error| FileError::Malformed(path.to_owned(), kind, format!("{error}")))
}

fn identified(
    path: &Path,
    (task, job): (&Task, &str),
    (found, wanted): (&str, &str),
    kind: &'static str,
) -> Result<(), FileError> {
    let malformed = |why| FileError::Malformed(path.to_owned(), kind, why);
    if found != wanted {
        return Err(malformed(format!("the format {found:?}")));
    }
    if task.identity() != job {
        return Err(FileError::Altered(path.to_owned()));
    }
    task.validate().map_err(malformed)
}

/// Reads a job's file.
///
/// # Errors
/// If it is none.
pub fn read_job(path: &Path) -> Result<Job, FileError> {
    let kind = "the job.json that orthocert split wrote";
    let job: Job = parse(path, &read_text(path)?, kind)?;
    identified(path, (&job.task, &job.job), (&job.format, JOB), kind)?;
    Ok(job)
}

/// Reads a shard's file; also returns the SHA-256 of its text.
///
/// # Errors
/// If it is none.
pub fn read_shard(path: &Path) -> Result<(Shard, String), FileError> {
    let kind = "a shard that orthocert split wrote";
    let text = read_text(path)?;
    let shard: Shard = parse(path, &text, kind)?;
    identified(path, (&shard.task, &shard.job), (&shard.format, SHARD), kind)?;
    let malformed = |why: &str| FileError::Malformed(path.to_owned(), kind, why.to_owned());
    if shard.shard == 0 || shard.shard > shard.of {
        return Err(malformed("a shard's number that is not one of its job's"));
    }
    let foreign = |place: &Place| place.cell().is_none_or(|cell| !shard.task.has(&cell));
    if shard.cells.iter().any(foreign) {
        return Err(malformed("a cell that is not within the box"));
    }
    Ok((shard, sha256(&text)))
}

/// Reads a result's file; whether it is whole is for the reader to ask.
pub(super) fn read_result(path: &Path) -> Result<ShardResult, FileError> {
    parse(path, &read_text(path)?, "a result that orthocert run-shard wrote")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_beyond_the_box_are_no_cells() {
        let root = Place::of(&Cell::ROOT);
        assert_eq!(root.and_then(|place| place.cell()), Some(Cell::ROOT));
        for edge in [(1, 0), (2, 1), (0, 61), (u64::MAX, 20)] {
            let place = Place { edges: [(0, 0), edge, (0, 0)], left: Vec::new() };
            assert_eq!(place.cell(), None);
        }
    }
}
