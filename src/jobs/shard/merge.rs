//! From the results of all shards to the whole.

use super::file::{
    read_job, read_result, read_text, sha256, FileError, Job, JobTop, Part, ShardResult,
};
use super::name::{name_of, Name, JOB_FILE};
use super::paving::{self, Stretches};
use super::task::Task;
use crate::files::read::Named;
use crate::files::shown::Shown;
use crate::questions::atlas::{assemble, Top};
use orthocert_kernel::certificate::{AtlasCell, Node};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;

/// Most problems that are named one by one.
const NAMED: usize = 8;

/// What was merged.
#[derive(Clone, Debug)]
pub struct Merged {
    /// What was to be done.
    pub task: Task,
    /// What was found.
    pub whole: Whole,
}

/// The whole of what the shards found.
#[derive(Clone, Debug)]
pub enum Whole {
    /// The cells of an atlas.
    Cells(Vec<AtlasCell>),
    /// The tree of a design.
    Tree {
        /// In preorder.
        nodes: Vec<Node>,
        /// Boxes on which something is open.
        open: usize,
        /// Boxes tried.
        boxes: usize,
    },
    /// The tree of a paving, which is in the shards' files.
    Paving(Stretches),
}

/// Why there is no whole.
#[derive(Debug)]
#[non_exhaustive]
pub enum MergeError {
    /// The job's own file is of no use.
    Job(FileError),
    /// The folder cannot be listed.
    Folder(String),
    /// These files are no results of the job's shards, or altered; each with its reason.
    Bad(Vec<String>),
    /// Nothing is wrong, but these shards have no result yet.
    Missing(Vec<usize>),
    /// The parts do not make a tree.
    NotATree,
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let more = |f: &mut fmt::Formatter<'_>, count: usize| match count.checked_sub(NAMED) {
            Some(rest) if rest > 0 => write!(f, "; and {rest} more"),
            _ => Ok(()),
        };
        match self {
            MergeError::Job(error) => error.fmt(f),
            MergeError::Folder(reason) => f.write_str(reason),
            MergeError::Bad(problems) => {
                let first: Vec<_> =
                    problems.iter().take(NAMED).map(|why| Shown(why).to_string()).collect();
                write!(f, "nothing was merged: {}", first.join("; "))?;
                more(f, problems.len())
            }
            MergeError::Missing(shards) => {
                let first: Vec<String> = shards.iter().take(NAMED).map(usize::to_string).collect();
                let (noun, verb) = match shards.len() {
                    1 => ("shard", "has"),
                    _ => ("shards", "have"),
                };
                write!(f, "nothing was merged: {noun} {} {verb} no result", first.join(", "))?;
                more(f, shards.len())?;
                write!(f, "; orthocert run-shard makes them")
            }
            MergeError::NotATree => write!(f, "the parts do not make one tree of cells"),
        }
    }
}

impl std::error::Error for MergeError {}

/// Puts the results in a job's folder together: exactly one for each shard, as written, and
/// nothing else in the folder.
///
/// # Errors
/// [`MergeError`], with everything that is wrong.
pub fn merge(folder: &Path) -> Result<Merged, MergeError> {
    let job = read_job(&folder.join(JOB_FILE)).map_err(MergeError::Job)?;
    let mut problems = Vec::new();
    let mut results: BTreeMap<usize, Vec<(String, ShardResult)>> = BTreeMap::new();
    let in_nodes = matches!(job.task, Task::Pave(_));
    for (name, kind) in listed(folder, &mut problems)? {
        match kind {
            Some(Name::Shard(n)) if n > job.shards.len() => {
                problems.push(format!("{name} is no shard of this job"));
            }
            Some(Name::Nodes(n)) if !in_nodes || n > job.shards.len() => {
                problems.push(format!("{name} is a foreign file"));
            }
            Some(Name::Result(_)) => match read_result(&folder.join(&name)) {
                Err(error) => problems.push(error.to_string()),
                Ok(result) => match objection(&job, &result) {
                    Some(why) => problems.push(format!("{name} {why}")),
                    None => results.entry(result.shard).or_default().push((name, result)),
                },
            },
            Some(_) => {}
            None => problems.push(format!("{name} is a foreign file")),
        }
    }
    unaltered(folder, &job, &mut problems);
    for (shard, found) in &results {
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        if names.len() > 1 {
            problems.push(format!("shard {shard} is there twice: {}", names.join(" and ")));
        } else if names != [name_of(Name::Result(*shard))] {
            problems.push(format!("{} is the result of shard {shard}", names.join("")));
        }
    }
    if in_nodes {
        altered_nodes(folder, &results, &mut problems);
    }
    let missing: Vec<usize> =
        (1..=job.shards.len()).filter(|shard| !results.contains_key(shard)).collect();
    if !problems.is_empty() {
        problems.extend(missing.iter().map(|shard| format!("shard {shard} has no result")));
        return Err(MergeError::Bad(problems));
    }
    if !missing.is_empty() {
        return Err(MergeError::Missing(missing));
    }
    let parts = results.into_values().flatten().map(|(_, result)| result.parts).collect();
    whole(folder, job, parts)
}

/// The names in a folder with what they stand for, sorted.
fn listed(
    folder: &Path,
    problems: &mut Vec<String>,
) -> Result<Vec<(String, Option<Name>)>, MergeError> {
    let unlisted =
        |error| MergeError::Folder(format!("{}: cannot be listed: {error}", folder.shown()));
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(unlisted)? {
        match entry.map_err(unlisted)?.file_name().into_string() {
            Ok(name) => names.push((name.clone(), Name::parse(&name))),
            Err(name) => problems.push(format!("{} is a foreign file", name.shown())),
        }
    }
    names.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(names)
}

/// Why a result is not one of the job's.
fn objection(job: &Job, result: &ShardResult) -> Option<String> {
    let shard = result.shard.checked_sub(1).and_then(|i| job.shards.get(i));
    if result.job != job.job {
        Some("is of another job".to_owned())
    } else if shard != Some(&result.answers) {
        Some(format!("answers another split of this job (as shard {})", result.shard))
    } else if !result.is_whole() {
        Some("was altered: its content does not have its SHA-256".to_owned())
    } else {
        None
    }
}

/// Every shard's file is there as it was written.
fn unaltered(folder: &Path, job: &Job, problems: &mut Vec<String>) {
    for (i, wanted) in job.shards.iter().enumerate() {
        let name = name_of(Name::Shard(i + 1));
        match read_text(&folder.join(&name)) {
            Err(error) => problems.push(error.to_string()),
            Ok(text) if sha256(&text) != *wanted => {
                problems.push(format!("{name} was altered, or is of another job"));
            }
            Ok(_) => {}
        }
    }
}

/// The nodes of a paving are there as they were written.
fn altered_nodes(
    folder: &Path,
    results: &BTreeMap<usize, Vec<(String, ShardResult)>>,
    problems: &mut Vec<String>,
) {
    let found: Vec<&ShardResult> = results.values().flatten().map(|(_, result)| result).collect();
    let altered = found.par_iter().filter_map(|result| {
        let name = name_of(Name::Nodes(result.shard));
        let why = paving::objection(&folder.join(&name), &result.parts)?;
        Some(format!("{name} {why}"))
    });
    problems.extend(altered.collect::<Vec<_>>());
}

/// The tree with all parts in their places: waiting cell `k` is cell `k / n` of shard `k mod n`.
fn whole(folder: &Path, job: Job, parts: Vec<Vec<Part>>) -> Result<Merged, MergeError> {
    if let JobTop::Paving(top) = &job.top {
        let whole = Stretches::new(folder, top, &parts).ok_or(MergeError::NotATree)?;
        return Ok(Merged { task: job.task, whole: Whole::Paving(whole) });
    }
    let shards = parts.len().max(1);
    let count = parts.iter().map(Vec::len).sum();
    let mut dealt: Vec<_> = parts.into_iter().map(Vec::into_iter).collect();
    let next = |k: usize| dealt.get_mut(k % shards).and_then(Iterator::next);
    let in_order: Option<Vec<Part>> = (0..count).map(next).collect();
    let in_order = in_order.ok_or(MergeError::NotATree)?;
    let whole = match job.top {
        JobTop::Cells(top) => cells(top, in_order),
        JobTop::Tree { nodes, waiting, boxes } => tree(nodes, &waiting, boxes, in_order),
        JobTop::Paving(_) => None,
    };
    Ok(Merged { task: job.task, whole: whole.ok_or(MergeError::NotATree)? })
}

fn cells(top: Vec<Top>, parts: Vec<Part>) -> Option<Whole> {
    let of_atlas = |part| match part {
        Part::Cells(cells) => Some(cells),
        Part::Tree { .. } | Part::Nodes(_) => None,
    };
    let parts: Option<Vec<_>> = parts.into_iter().map(of_atlas).collect();
    assemble(top, parts?).map(Whole::Cells)
}

fn tree(top: Vec<Node>, waiting: &[usize], boxes: usize, parts: Vec<Part>) -> Option<Whole> {
    let (mut nodes, mut open, mut boxes) = (Vec::new(), 0, boxes);
    let mut parts = parts.into_iter();
    for (position, node) in top.into_iter().enumerate() {
        if waiting.binary_search(&position).is_err() {
            nodes.push(node);
            continue;
        }
        match parts.next()? {
            Part::Tree { nodes: below, open: left, boxes: tried } => {
                nodes.extend(below);
                // Numbers of a file: any.
                open = usize::saturating_add(open, left);
                boxes = usize::saturating_add(boxes, tried);
            }
            Part::Cells(_) | Part::Nodes(_) => return None,
        }
    }
    parts.next().is_none().then_some(Whole::Tree { nodes, open, boxes })
}
