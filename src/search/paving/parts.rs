//! A paving in parts that are made anywhere: the top of its tree, the subtrees below, and all of
//! them in one file.

use super::pass::{finish, first_line, refused, WINDOW};
use super::tree::{Cancelled, Grower, Segment, Tally, FORESEEN};
use super::{header, Decider, PaveError, Paved};
use crate::files::digest::Summed;
use crate::files::output::{self, Pending};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::paving::{bit, Cell, Judge, Reader, Root, Subject};
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufReader, BufWriter, Seek, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Least depth of the subtrees that are left to be grown: of a region's boxes about one in
/// `2^(2/3 BELOW)`, 64, is then in the top.
const BELOW: u32 = 3 * FORESEEN;
/// Nodes that are checked side by side.
const BATCH: usize = 1 << 14;

/// The paving of one claim to one depth.
pub struct Parts {
    subject: Subject,
}

impl Parts {
    /// The paving of a claim's box to a depth.
    ///
    /// # Errors
    /// If the claim cannot be paved.
    pub fn new(claim: &MachineClaim, depth: u32) -> Result<Self, PaveError> {
        let subject = Subject::new(&header(claim, None, depth)).map_err(PaveError::Claim)?;
        Decider::new(&subject).map_err(PaveError::Claim)?;
        Ok(Parts { subject })
    }

    /// What decides its cells.
    ///
    /// # Errors
    /// None: the parts would not be there.
    pub fn decider(&self) -> Result<Decider<'_>, PaveError> {
        Decider::new(&self.subject).map_err(PaveError::Claim)
    }

    fn grower<'a>(&self, decider: &'a Decider<'a>, cancel: &'a AtomicBool) -> Grower<'a> {
        Grower { decider, depth: self.subject.header.depth, cancel }
    }

    /// The tree with subtrees left to be grown: at least `enough`, all of one depth, where the tree
    /// is so deep that its top is a small part of the work.
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn top(
        &self,
        decider: &Decider<'_>,
        enough: usize,
        cancel: &AtomicBool,
    ) -> Result<Vec<Segment>, Cancelled> {
        let grower = self.grower(decider, cancel);
        let deepest = grower.seen(self.subject.header.depth.saturating_sub(BELOW));
        // At most 2^depth cells have a depth.
        let mut depth = grower.seen(enough.next_power_of_two().ilog2().min(deepest));
        loop {
            let mut tally = Tally::default();
            let top = grower.segments(Root::WHOLE, depth, &mut tally)?;
            let left = top.iter().filter(|segment| matches!(segment, Segment::Subtree(_))).count();
            if left >= enough || depth >= deepest {
                return Ok(top);
            }
            depth += FORESEEN;
        }
    }

    /// What is not discharged above a subtree.
    pub fn open(&self, root: &Root) -> Vec<usize> {
        let all = 0..self.subject.problem.obligations.len();
        all.filter(|o| root.inherited & bit(*o) == 0).collect()
    }

    /// The root of a subtree above which all but `open` is discharged.
    pub fn root(&self, cell: Cell, open: &[usize]) -> Root {
        let open = open.iter().fold(0, |open, &o| open | bit(o));
        Root { cell, inherited: self.subject.all() & !open, depth: cell.depth() }
    }

    /// Grows a subtree and hands its bytes on, in order.
    ///
    /// # Errors
    /// If it was cancelled, or the bytes are refused.
    pub fn grow<E: From<Cancelled>>(
        &self,
        decider: &Decider<'_>,
        root: Root,
        cancel: &AtomicBool,
        mut to: impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        let grower = self.grower(decider, cancel);
        let depth = root.depth + BELOW;
        let segments = grower.segments(root, depth, &mut Tally::default())?;
        for window in segments.chunks(WINDOW) {
            let (grown, ended) = grower.grow_all(window);
            ended?;
            for (bytes, _) in grown {
                to(&bytes)?;
            }
        }
        Ok(())
    }

    /// Writes the paving to `path`, with the tree as `tree` writes it, once every node is accepted by
    /// the checker: until then, and if it is not, `path` holds what it held before.
    ///
    /// # Errors
    /// [`PaveError`].
    pub fn write(
        &self,
        path: &Path,
        cancel: &AtomicBool,
        tree: impl FnOnce(&mut TreeWriter<'_>) -> Result<(), PaveError>,
    ) -> Result<Paved, PaveError> {
        let io = |error| PaveError::Io(path.to_owned(), error);
        let pending = Pending::beside(path).map_err(io)?;
        let file = pending.file();
        let mut out = TreeWriter { file: BufWriter::new(file), path, sum: Sha256::new() };
        out.write(&first_line(&self.subject.header).map_err(io)?)?;
        tree(&mut out)?;
        out.file.flush().map_err(io)?;
        let sum = out.sum.clone();
        drop(out);
        let mut paved = finish(file, path, sum, 0)?;
        if let Some(coarsest) = paved.coarsest.filter(|_| !paved.reaches(self.subject.header.depth))
        {
            return Err(PaveError::Coarse(coarsest));
        }
        paved.boxes = checked(file, path, &paved.sha256, cancel)?;
        let _writing = output::hold();
        pending.persist(path).map_err(io)?;
        Ok(paved)
    }
}

/// A paving that is being written.
pub struct TreeWriter<'a> {
    file: BufWriter<&'a File>,
    path: &'a Path,
    sum: Sha256,
}

impl TreeWriter<'_> {
    /// Appends nodes.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, nodes: &[u8]) -> Result<(), PaveError> {
        self.sum.update(nodes);
        self.file.write_all(nodes).map_err(|error| PaveError::Io(self.path.to_owned(), error))
    }
}

/// Has every node of a paving that has this SHA-256 accepted by the checker, many side by side, then
/// its summary; returns how many there are.
fn checked(
    mut file: &File,
    path: &Path,
    sha256: &str,
    cancel: &AtomicBool,
) -> Result<u64, PaveError> {
    let io = |error| PaveError::Io(path.to_owned(), error);
    let defect = |reason| refused(path, reason);
    file.rewind().map_err(io)?;
    let mut input = BufReader::new(Summed::new(file));
    let mut reader = Reader::new(&mut input).map_err(defect)?;
    let subject = Subject::new(reader.header()).map_err(defect)?;
    let judge = Judge::new(&subject).map_err(defect)?;
    loop {
        let mut batch = Vec::with_capacity(BATCH);
        while batch.len() < BATCH {
            match reader.next().map_err(defect)? {
                Some(visited) => batch.push(visited),
                None => break,
            }
        }
        if batch.is_empty() {
            break;
        }
        if cancel.load(Ordering::Relaxed) {
            return Err(PaveError::Cancelled(None));
        }
        let first = batch.par_iter().map(|visited| judge.check(visited)).find_first(Result::is_err);
        first.unwrap_or(Ok(())).map_err(defect)?;
    }
    let nodes = reader.nodes;
    reader.finish().map_err(defect)?;
    match input.into_inner().finish().map_err(io)?.0 == sha256 {
        true => Ok(nodes),
        false => Err(PaveError::Changed(path.to_owned())),
    }
}
