//! What is decided of a map that is not complete: a file that grows with it, for a run that takes it up.
//!
//! Its first line names the map, and each other one has a cell and its decision, with their SHA-256: what a
//! run that was killed left half-written has no right sum, and is done again. What is taken up is checked
//! with the rest of the map.

use super::decide::Decision;
use crate::design::AtlasDesign;
use crate::files::digest::sha256;
use crate::files::output::{self, OutputError};
use crate::files::read::Named;
use orthocert_kernel::atlas::Part;
use orthocert_kernel::certificate::AtlasCell;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What the file begins with.
pub const FORMAT: &str = "{\"format\":\"orthocert-atlas-part/1\"";

/// The first line.
#[derive(Serialize, Deserialize, PartialEq, Eq)]
struct Header {
    format: String,
    /// Of which cells become what: the SHA-256 of what the map is of, and of this program's version.
    map: String,
}

/// A cell: `None` where it is to be split.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    sha256: String,
    cell: Part,
    found: Option<AtlasCell>,
}

/// Why an unfinished map is not taken up, or not kept.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// It cannot be taken up.
    #[error("--resume: {}: {}", .0.shown(), .1)]
    Resume(PathBuf, String),
}

/// The decisions of an unfinished map, on the disk.
pub struct Kept {
    path: PathBuf,
    file: File,
    /// Of earlier runs.
    known: HashMap<Part, Decision>,
    /// Cells that it has, and the share of the box that is certified or refuted, as far as doubles tell.
    pub cells: usize,
    /// See [`Kept::cells`].
    pub share: f64,
}

impl Kept {
    /// An empty file.
    ///
    /// # Errors
    /// If it cannot be written, or another run has it.
    pub fn begin(path: &Path, design: &AtlasDesign) -> Result<Self, KeptError> {
        let file = output::open_locked(path, true)?;
        let mut kept =
            Kept { path: path.to_owned(), file, known: HashMap::new(), cells: 0, share: 0.0 };
        let first = text(&header(design)) + "\n";
        let emptied = kept.file.set_len(0).and_then(|()| kept.file.write_all(first.as_bytes()));
        emptied.map_err(|error| kept.io(error))?;
        Ok(kept)
    }

    /// What another run of the same map left.
    ///
    /// # Errors
    /// If it is of another map, is not there, or another run has it.
    pub fn take_up(path: &Path, design: &AtlasDesign) -> Result<Self, KeptError> {
        let refused = |reason: String| KeptError::Resume(path.to_owned(), reason);
        let file = output::open_locked(path, false).map_err(|error| match error {
            OutputError::Io(_, error) => refused(error.to_string()),
            other => KeptError::Output(other),
        })?;
        let mut kept =
            Kept { path: path.to_owned(), file, known: HashMap::new(), cells: 0, share: 0.0 };
        let mut input = BufReader::new(&kept.file);
        let mut first = String::new();
        let begins = input.by_ref().take(1024).read_line(&mut first).is_ok();
        if !begins || !first.starts_with(FORMAT) {
            return Err(refused("it is no unfinished map".to_owned()));
        }
        if serde_json::from_slice::<Header>(first.as_bytes()).ok() != Some(header(design)) {
            let other = "it is the beginning of the map of another design, resolution or number of \
                         boxes, or by another version of this program; accepted: the same as it was";
            return Err(refused(other.to_owned()));
        }
        let (mut whole, mut known, mut line) = (first.len() as u64, HashMap::new(), Vec::new());
        while input.read_until(b'\n', &mut line).is_ok_and(|bytes| bytes > 0) {
            let Some((cell, decision)) = decided(&line) else { break };
            known.insert(cell, decision);
            whole += line.len() as u64;
            line.clear();
        }
        let ended = kept.file.set_len(whole).and_then(|()| kept.file.seek(SeekFrom::End(0)));
        ended.map_err(|error| kept.io(error))?;
        known.iter().for_each(|(cell, decision)| kept.count(cell, decision));
        kept.known = known;
        Ok(kept)
    }

    fn count(&mut self, cell: &Part, decision: &Decision) {
        self.cells += 1;
        if matches!(decision, Decision::Decided(_)) {
            self.share += (-f64::from(super::part::depth(cell))).exp2();
        }
    }

    /// What was decided of a cell.
    pub(super) fn known(&self, cell: &Part) -> Option<&Decision> {
        self.known.get(cell)
    }

    /// Keeps what was decided of a cell.
    pub(super) fn keep(&mut self, cell: &Part, decision: &Decision) -> Result<(), KeptError> {
        let found = match decision {
            Decision::Decided(found) => Some(found.clone()),
            Decision::Open => None,
            Decision::Cancelled => return Ok(()),
        };
        let sha256 = sum(cell, &found);
        let line = text(&Line { sha256, cell: cell.clone(), found }) + "\n";
        let written = self.file.write_all(line.as_bytes());
        written.map_err(|error| self.io(error))?;
        self.count(cell, decision);
        Ok(())
    }

    /// Removes the file: the map is complete.
    pub fn remove(self) {
        // Where that fails, it is in nobody's way.
        let _ = std::fs::remove_file(&self.path);
    }

    fn io(&self, error: std::io::Error) -> KeptError {
        KeptError::Output(OutputError::Io(self.path.clone(), error))
    }
}

fn header(design: &AtlasDesign) -> Header {
    let AtlasDesign { parameters, machine, resolution, boxes, .. } = design;
    let map = text(&(env!("CARGO_PKG_VERSION"), parameters, machine, resolution, boxes));
    Header { format: "orthocert-atlas-part/1".to_owned(), map: sha256(map.as_bytes()) }
}

/// A line that is whole.
fn decided(line: &[u8]) -> Option<(Part, Decision)> {
    let Line { sha256, cell, found } = serde_json::from_slice(line.strip_suffix(b"\n")?).ok()?;
    (sha256 == sum(&cell, &found)).then_some(())?;
    Some((cell, found.map_or(Decision::Open, Decision::Decided)))
}

fn sum(cell: &Part, found: &Option<AtlasCell>) -> String {
    sha256(text(&(cell, found)).as_bytes())
}

fn text(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("numbers, texts and lists of them")
}
