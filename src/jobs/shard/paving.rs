//! The nodes of a paving's subtrees, in files beside the results.
//!
//! A paving may be larger than memory: its nodes are written, summed up and put together stretch by
//! stretch. What is to be at a place of such a file is a function of the shard, so that runs which
//! write it again, even at the same time, write the same.

use super::file::{JobTop, Nodes, Part, Place, Stretch};
use super::name::{name_of, Name};
use super::run::RunError;
use super::split::SplitError;
use super::task::Pave;
use crate::files::open::open;
use crate::files::output::{self, OutputError};
use crate::search::paving::{Cancelled, Parts, PaveError, Paved, Segment, TreeWriter};
use data_encoding::HEXLOWER;
use orthocert_kernel::paving::Cell;
use sha2::{Digest, Sha256};
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Cells that a shard has at least, where the tree has as many: what is below one takes no time or
/// much, and a cell that is dealt out costs little.
const CELLS_A_SHARD: usize = 16;

/// The top of a paving's tree, and the cells that are left of it.
pub(super) fn top(
    task: &Pave,
    shards: usize,
    cancel: &AtomicBool,
) -> Result<(JobTop, Vec<Place>), SplitError> {
    let parts =
        Parts::new(&task.claim, task.depth).map_err(|e| SplitError::Paving(e.to_string()))?;
    let enough = shards.saturating_mul(CELLS_A_SHARD);
    let decider = parts.decider().map_err(|e| SplitError::Paving(e.to_string()))?;
    let segments =
        parts.top(&decider, enough, cancel).map_err(|Cancelled| SplitError::Interrupted)?;
    let mut places = Vec::new();
    let mut top = Vec::new();
    for segment in segments {
        top.push(match segment {
            Segment::Known(bytes) => Stretch::Nodes(HEXLOWER.encode(&bytes)),
            Segment::Subtree(root) => {
                // No axis of a paving is split more often than files can tell.
                let place = Place::of(&root.cell);
                places.extend(place.map(|place| Place { left: parts.open(&root), ..place }));
                Stretch::Waiting
            }
        });
    }
    Ok((JobTop::Paving(top), places))
}

/// Writes the nodes below a cell, on which these obligations are open, to the file at `path`, from
/// its byte `at` on.
pub(super) fn grown(
    (path, at): (&Path, u64),
    task: &Pave,
    (cell, open): (Cell, &[usize]),
    cancel: &AtomicBool,
) -> Result<Nodes, RunError> {
    let io = |error| RunError::Output(OutputError::Io(path.to_owned(), error));
    let parts = Parts::new(&task.claim, task.depth).map_err(|e| RunError::Claim(e.to_string()))?;
    let mut file = opened(path)?;
    file.seek(SeekFrom::Start(at)).map_err(io)?;
    let (mut sum, mut bytes) = (Sha256::new(), 0);
    let decider = parts.decider().map_err(|e| RunError::Claim(e.to_string()))?;
    parts.grow(&decider, parts.root(cell, open), cancel, |stretch| {
        sum.update(stretch);
        bytes += stretch.len() as u64;
        file.write_all(stretch).map_err(io)
    })?;
    file.sync_data().map_err(io)?;
    Ok(Nodes { bytes, sha256: HEXLOWER.encode(&sum.finalize()) })
}

/// The file, as it is if it is there.
fn opened(path: &Path) -> Result<File, OutputError> {
    output::open_own(path, OpenOptions::new().write(true).create(true).truncate(false))
}

/// Forgets of what is done, in order, all from the first cell on whose nodes are not in the file.
pub(super) fn keep_written(path: &Path, done: &mut [Option<Part>]) {
    let mut written = open(path).ok();
    for part in done {
        let is_there = match (&mut written, &part) {
            (Some(file), Some(Part::Nodes(nodes))) => follow(file, nodes),
            _ => false,
        };
        if !is_there {
            (written, *part) = (None, None);
        }
    }
}

/// Ends the file there.
pub(super) fn close(path: &Path, end: u64) -> Result<(), OutputError> {
    let file = opened(path)?;
    let ended = file.set_len(end).and_then(|()| file.sync_all());
    ended.map_err(|error| OutputError::Io(path.to_owned(), error))
}

/// Why the file is not that of these parts.
pub(super) fn objection(path: &Path, parts: &[Part]) -> Option<String> {
    let mut file = match open(path) {
        Ok(file) => file,
        Err(error) => return Some(format!("cannot be read: {error}")),
    };
    let bytes = parts.iter().map(Part::bytes).fold(0, u64::saturating_add);
    let whole = file.metadata().is_ok_and(|found| found.len() == bytes)
        && parts.iter().all(|part| matches!(part, Part::Nodes(nodes) if follow(&mut file, nodes)));
    (!whole).then(|| "was altered: its content does not have its SHA-256".to_owned())
}

/// Whether a file goes on with this stretch.
fn follow(file: &mut File, nodes: &Nodes) -> bool {
    let mut sum = Sha256::new();
    let read = hand_on(
        file,
        nodes.bytes,
        |error| error,
        |chunk| {
            sum.update(chunk);
            Ok(())
        },
    );
    read.is_ok() && HEXLOWER.encode(&sum.finalize()) == nodes.sha256
}

/// Reads so many bytes and hands them on; what cannot be read, or is not there, `unread` explains.
fn hand_on<E>(
    file: &mut File,
    bytes: u64,
    unread: impl Fn(io::Error) -> E,
    mut to: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    let mut input = BufReader::with_capacity(1 << 16, file.take(bytes));
    let mut read = 0;
    while read < bytes {
        let chunk = input.fill_buf().map_err(&unread)?;
        if chunk.is_empty() {
            return Err(unread(io::ErrorKind::UnexpectedEof.into()));
        }
        to(chunk)?;
        let length = chunk.len();
        read += length as u64;
        input.consume(length);
    }
    Ok(())
}

/// The nodes of a paving's tree, in order.
#[derive(Clone, Debug)]
pub struct Stretches(Vec<Held>);

/// Nodes, and where they are.
#[derive(Clone, Debug)]
enum Held {
    InHand(Vec<u8>),
    InFile { path: PathBuf, at: u64, bytes: u64 },
}

impl Stretches {
    /// The parts, in their places: waiting cell `k` is cell `k / n` of shard `k mod n`. `None` if
    /// there are more or fewer of them, or the top is none.
    pub(super) fn new(folder: &Path, top: &[Stretch], parts: &[Vec<Part>]) -> Option<Self> {
        let mut dealt: Vec<_> = parts.iter().map(|parts| (0, parts.iter())).collect();
        let mut shards = (0..parts.len()).cycle();
        let mut next = || {
            let shard = shards.next()?;
            let (at, parts) = dealt.get_mut(shard)?;
            let Part::Nodes(Nodes { bytes, .. }) = *parts.next()? else { return None };
            let path = folder.join(name_of(Name::Nodes(shard + 1)));
            let held = Held::InFile { path, at: *at, bytes };
            *at = u64::checked_add(*at, bytes)?;
            Some(held)
        };
        let held = top.iter().map(|stretch| match stretch {
            Stretch::Nodes(text) => HEXLOWER.decode(text.as_bytes()).ok().map(Held::InHand),
            Stretch::Waiting => next(),
        });
        let held = held.collect::<Option<_>>()?;
        let all = dealt.iter_mut().all(|(_, parts)| parts.next().is_none());
        all.then_some(Stretches(held))
    }

    /// Writes the paving to `path`, once the checker accepts every node.
    ///
    /// # Errors
    /// [`PaveError`]; then `path` holds what it held before.
    pub fn write(&self, task: &Pave, path: &Path, cancel: &AtomicBool) -> Result<Paved, PaveError> {
        let parts = Parts::new(&task.claim, task.depth)?;
        parts.write(path, cancel, |out| {
            for held in &self.0 {
                if cancel.load(Ordering::Relaxed) {
                    return Err(PaveError::Cancelled(None));
                }
                held.copy(out)?;
            }
            Ok(())
        })
    }
}

impl Held {
    fn copy(&self, out: &mut TreeWriter<'_>) -> Result<(), PaveError> {
        let (path, at, bytes) = match self {
            Held::InHand(bytes) => return out.write(bytes),
            Held::InFile { path, at, bytes } => (path, *at, *bytes),
        };
        let unread = |error| PaveError::Io(path.clone(), error);
        let mut file = open(path).map_err(unread)?;
        file.seek(SeekFrom::Start(at)).map_err(unread)?;
        hand_on(&mut file, bytes, unread, |chunk| out.write(chunk))
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use crate::design::Design;
    use std::process::Command;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn a_pipe_in_the_place_of_nodes_is_not_waited_for() {
        let text = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
                    min = [0, 0, 0]\nmax = [1, 1, 1]\n[requirements]\ntransmission = { max = 2 }\n";
        let claim = Design::parse(text, "d.toml").unwrap().claim;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("result-0001.nodes");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let (done, ended) = mpsc::channel();
        let target = folder.path().join("merged");
        std::thread::spawn(move || {
            let task = Pave { title: None, claim, depth: 3 };
            let held = Held::InFile { path: pipe, at: 0, bytes: 1 };
            let merged = Stretches(vec![held]).write(&task, &target, &AtomicBool::new(false));
            done.send(merged.map_err(|error| error.to_string()).err())
        });
        let error = ended.recv_timeout(Duration::from_secs(20)).unwrap().unwrap();
        assert!(error.ends_with("result-0001.nodes: no regular file"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
