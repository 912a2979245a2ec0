//! Writes a paving, subtree by subtree, to a file that can be taken up again.

use super::tree::{is_left, Cancelled, Grower, Grown, Segment, Tally};
use super::{header, plan, Decider, Goal};
use crate::files::digest::{hexadecimal, Summed};
use crate::files::output::{self, OutputError};
use crate::files::read::Named;
use crate::search::{Control, Progress, Steps};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::paving::{self, Header, Reader, Rejected, Root, Subject, Summary};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Greatest depth of the subtrees' roots: some thousands of them.
const COARSE: u32 = 20;
/// The same of some coordinates for all values of the others, where a cell takes far more.
const COARSE_FOR_ALL: u32 = 6;
/// The same where cells are cut, of which fewer are needed.
const COARSE_WITH_CUTS: u32 = 11;
const WINDOW_FOR_ALL: usize = 8;
/// Subtrees that are grown together and wait in memory for their turn to be written.
pub(super) const WINDOW: usize = 128;
/// Deepest tree that is searched for.
pub const DEEPEST: u32 = 90;

/// Why there is no paving.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PaveError {
    /// It was cancelled; what is written can be taken up again. The share of the parts of the tree that are, if it is known.
    #[error("interrupted")]
    Cancelled(Option<f64>),
    /// It was cancelled before anything was written.
    #[error("interrupted")]
    NotBegun,
    /// The claim cannot be paved.
    #[error("{0}")]
    Claim(Rejected),
    /// There is nothing to take up again, or it is of another paving.
    #[error("{path}: cannot be taken up again: {1}", path = .0.shown())]
    Resume(PathBuf, String),
    /// The unfinished file cannot be had.
    #[error(transparent)]
    Output(OutputError),
    /// A file cannot be written or read.
    #[error("{path}: {1}", path = .0.shown())]
    Io(PathBuf, io::Error),
    /// The checker does not accept what was written.
    #[error("the checker does not accept the paving: {0}")]
    Defect(Rejected),
    /// What was written is not what is there.
    #[error(
        "{}: was changed by another program while it was written; nothing is said of it",
        .0.shown()
    )]
    Changed(PathBuf),
    /// A box is left undecided at this depth, above that of the paving.
    #[error("a box is left undecided after {0} splits, fewer than were asked for")]
    Coarse(u32),
}

impl From<Cancelled> for PaveError {
    fn from(_: Cancelled) -> Self {
        PaveError::Cancelled(None)
    }
}

/// Whether a paving is begun or taken up again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resume {
    /// Begun; what was there is replaced.
    No,
    /// Taken up again where it was interrupted.
    Yes,
}

/// A paving that is complete.
#[derive(Clone, Debug)]
pub struct Paved {
    /// Its first line.
    pub header: Header,
    /// Its last line, as the checker's reader recomputes it.
    pub summary: Summary,
    /// Splits above the largest undecided box; `None` where nothing is undecided.
    pub coarsest: Option<u32>,
    /// Boxes tried by this run.
    pub boxes: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// Their SHA-256: of what was confirmed, whatever the file holds by now.
    pub sha256: String,
}

impl Paved {
    /// Whether every undecided box has so many splits above it.
    pub fn reaches(&self, depth: u32) -> bool {
        self.coarsest.is_none_or(|coarsest| coarsest >= depth)
    }
}

/// The unfinished file of a paving.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

/// Paves the claim's box and writes the paving to `path`, which holds what it held before until the
/// paving is complete. From when its unfinished file is opened until it has taken its place, no other
/// run can have that file; what another program writes to it is noticed, for nothing is said of bytes
/// but those that this run has confirmed.
///
/// # Errors
/// [`PaveError`].
pub fn pave(
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
    goal: &Goal,
    path: &Path,
    mut resume: Resume,
    control: &mut Control<'_>,
) -> Result<Paved, PaveError> {
    let part = unfinished(path);
    let subject = Subject::new(&header(claim, coordinates, DEEPEST)).map_err(PaveError::Claim)?;
    // Where a volume is asked for, undecided boxes are cut.
    let decider = Decider::new(&subject).map_err(PaveError::Claim)?.with_cuts(goal.depth.is_none());
    let mut held = match resume {
        Resume::Yes => Some(taken_up(&part)?),
        Resume::No => None,
    };
    let not_begun = |error| match error {
        PaveError::Cancelled(_) => PaveError::NotBegun,
        error => error,
    };
    let mut known = None;
    let mut depth = match &held {
        Some(file) => {
            let depth = earlier_depth(claim, coordinates, file, &part)?;
            if goal.depth.is_some_and(|asked| depth > asked) {
                let reason =
                    "it was begun with a smaller --precision; accepted: the same".to_owned();
                return Err(PaveError::Resume(part, reason));
            }
            depth
        }
        None => {
            let (depth, segments) = planned(&decider, goal, control).map_err(not_begun)?;
            known = segments;
            depth
        }
    };
    // The plan mostly holds.
    let mut steps = Steps::default();
    loop {
        let header = header(claim, coordinates, depth);
        let pass = Pass::new(&decider, header, &part, control.cancel, known.take());
        let mut pass = if held.is_none() { pass.map_err(not_begun)? } else { pass? };
        let file = match held {
            Some(ref file) => file,
            None => held.insert(output::open_locked(&part, true).map_err(PaveError::Output)?),
        };
        steps.next(control, 2, |control| pass.run(file, resume, control))?;
        let paved = finish(file, &part, pass.sum, pass.boxes)?;
        let gap = paved.summary.boundary_share.0 as f64 / paved.summary.inner_share.0 as f64;
        let wanted = goal.gap.filter(|_| goal.depth.is_none());
        // The plan is an estimate: where it fell short, the next depth is taken.
        let short = wanted.is_some_and(|wanted| gap > wanted);
        let affordable = paved.boxes.saturating_mul(2) < goal.max_boxes;
        if short && affordable && depth < DEEPEST {
            depth += 1;
            resume = Resume::No;
            continue;
        }
        std::fs::rename(&part, path).map_err(|error| PaveError::Io(path.to_owned(), error))?;
        return Ok(paved);
    }
}

/// The unfinished file, which has to be there.
fn taken_up(part: &Path) -> Result<File, PaveError> {
    output::open_locked(part, false).map_err(|error| match error {
        OutputError::Io(path, error) => PaveError::Resume(path, error.to_string()),
        other => PaveError::Output(other),
    })
}

/// The depth in the first line of an unfinished paving of the same claim.
fn earlier_depth(
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
    file: &File,
    part: &Path,
) -> Result<u32, PaveError> {
    let fails = |reason: String| PaveError::Resume(part.to_owned(), reason);
    let found =
        paving::header(&mut BufReader::new(file)).map_err(|reason| fails(reason.to_string()))?;
    if found == header(claim, coordinates, found.depth) {
        Ok(found.depth)
    } else {
        Err(fails("it is the beginning of another design's paving".to_owned()))
    }
}

/// The tree down to the roots of its subtrees, and the boxes tried for it.
type Top = (Vec<Segment>, u64);

/// The depth, and the top of the tree where it was found from that.
fn planned(
    decider: &Decider<'_>,
    goal: &Goal,
    control: &Control<'_>,
) -> Result<(u32, Option<Top>), PaveError> {
    let deepest = goal.depth.unwrap_or(DEEPEST);
    // What is cut may end above the roots of subtrees.
    let grower = Grower { decider, depth: deepest, cancel: control.cancel };
    let coarse = if decider.cuts() { 0 } else { grower.seen(coarse(decider)) };
    let mut above = Tally::default();
    let segments = grower.segments(Root::WHOLE, coarse, &mut above)?;
    let depth = plan::depth(&grower, &segments, above, coarse, goal)?;
    let is_top = depth == deepest && depth > coarse && !decider.cuts();
    Ok((depth, is_top.then_some((segments, above.boxes))))
}

fn coarse(decider: &Decider<'_>) -> u32 {
    match (decider.is_for_all(), decider.cuts()) {
        (true, _) => COARSE_FOR_ALL,
        (false, true) => COARSE_WITH_CUTS,
        (false, false) => COARSE,
    }
}

/// Writes segments so that they stay.
fn written(mut file: &File, segments: &[Grown]) -> io::Result<()> {
    segments.iter().try_for_each(|(bytes, _)| file.write_all(bytes))?;
    file.sync_data()
}

/// The writing of one tree.
struct Pass<'a> {
    grower: Grower<'a>,
    header: Header,
    part: PathBuf,
    segments: Vec<Segment>,
    boxes: u64,
    /// Of all bytes that were confirmed.
    sum: Sha256,
}

impl<'a> Pass<'a> {
    fn new(
        decider: &'a Decider<'a>,
        header: Header,
        part: &Path,
        cancel: &'a AtomicBool,
        known: Option<Top>,
    ) -> Result<Self, PaveError> {
        let grower = Grower { decider, depth: header.depth, cancel };
        let mut above = Tally::default();
        let coarse = grower.seen(coarse(decider));
        let (segments, boxes) = match known {
            Some(known) => known,
            None => (grower.segments(Root::WHOLE, coarse, &mut above)?, above.boxes),
        };
        let (part, sum) = (part.to_owned(), Sha256::new());
        Ok(Pass { grower, header, part, segments, boxes, sum })
    }

    fn io(&self, error: io::Error) -> PaveError {
        PaveError::Io(self.part.clone(), error)
    }

    fn first_line(&self) -> Result<Vec<u8>, PaveError> {
        first_line(&self.header).map_err(|e| self.io(e))
    }

    fn run(
        &mut self,
        mut file: &File,
        resume: Resume,
        control: &mut Control<'_>,
    ) -> Result<(), PaveError> {
        let mut done = match resume {
            Resume::No => {
                file.set_len(0).and_then(|()| file.rewind()).map_err(|e| self.io(e))?;
                let first = self.first_line()?;
                file.write_all(&first).map_err(|e| self.io(e))?;
                self.sum.update(&first);
                0
            }
            Resume::Yes => self.take_up(file)?,
        };
        // What is grown waits for the disk while the next is grown.
        let mut grown: Vec<Grown> = Vec::new();
        let most = if self.grower.decider.is_for_all() { WINDOW_FOR_ALL } else { WINDOW };
        while done < self.segments.len() || !grown.is_empty() {
            let window = &self.segments[done..self.segments.len().min(done + most)];
            let (before, (next, ended)) = std::thread::scope(|scope| {
                let writer = scope.spawn(|| written(file, &grown));
                let next = self.grower.grow_all(window);
                (writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), next)
            });
            before.map_err(|e| self.io(e))?;
            grown = next;
            grown.iter().for_each(|(bytes, _)| self.sum.update(bytes));
            done += grown.len();
            self.boxes += grown.iter().map(|(_, boxes)| boxes).sum::<u64>();
            let share = done as f64 / self.segments.len() as f64;
            let boxes = usize::try_from(self.boxes).unwrap_or(usize::MAX);
            (control.progress)(Progress { boxes, share });
            if ended.is_err() {
                written(file, &grown).map_err(|e| self.io(e))?;
                return Err(PaveError::Cancelled(Some(share)));
            }
        }
        Ok(())
    }

    /// Ends the unfinished file after the last segment that it holds whole; returns how many it
    /// does. Every node that is kept is checked again.
    fn take_up(&mut self, mut file: &File) -> Result<usize, PaveError> {
        let fails = |reason: String| PaveError::Resume(self.part.clone(), reason);
        let open = |e: io::Error| fails(e.to_string());
        file.rewind().map_err(open)?;
        let mut input = Summed::new(BufReader::new(file));
        let wanted = self.first_line()?;
        let mut first = vec![0; wanted.len()];
        input.read_exact(&mut first).map_err(open)?;
        if first != wanted {
            return Err(fails("its first line is another".to_owned()));
        }
        let ((mut sum, mut whole), mut kept) = (input.so_far(), 0);
        for segment in &self.segments {
            if self.follows(segment, &mut input).is_err() {
                break;
            }
            ((sum, whole), kept) = (input.so_far(), kept + 1);
        }
        self.sum = sum;
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::End(0))).map_err(open)?;
        Ok(kept)
    }

    /// Reads a segment, whose evidence has to hold and whose undecided boxes have the depth.
    fn follows(&self, segment: &Segment, input: &mut impl Read) -> Result<(), Rejected> {
        let root = match segment {
            Segment::Known(bytes) => {
                let mut found = vec![0; bytes.len()];
                input.read_exact(&mut found)?;
                return if found == *bytes { Ok(()) } else { Err(Rejected::Truncated(0)) };
            }
            Segment::Subtree(root) => *root,
        };
        let mut reader = Reader::below(input, &self.header, root)?;
        while let Some(visited) = reader.next()? {
            if is_left(&visited.item.kind) && visited.depth < self.header.depth {
                return Err(Rejected::Truncated(0));
            }
            self.grower.decider.judge().check(&visited)?;
        }
        Ok(())
    }
}

/// The bytes of the first line.
pub(super) fn first_line(header: &Header) -> io::Result<Vec<u8>> {
    Ok((serde_json::to_string(header)? + "\n").into_bytes())
}

/// Appends the summary to a tree, as the checker's reader finds it. The tree's bytes were confirmed
/// one by one and have the sum `confirmed`; `boxes` were tried for it.
pub(super) fn finish(
    mut file: &File,
    path: &Path,
    mut confirmed: Sha256,
    boxes: u64,
) -> Result<Paved, PaveError> {
    let io = |error: io::Error| PaveError::Io(path.to_owned(), error);
    file.rewind().map_err(io)?;
    let mut input = BufReader::new(Summed::new(file));
    let found = read_back(&mut input);
    let (sum, bytes) = input.into_inner().finish().map_err(io)?;
    if sum != hexadecimal(&confirmed.clone().finalize()) {
        return Err(PaveError::Changed(path.to_owned()));
    }
    let paved = found.map_err(|reason| refused(path, reason))?;
    let text = serde_json::to_string(&paved.summary).map_err(|e| io(e.into()))? + "\n";
    file.seek(SeekFrom::End(0))
        .and_then(|_| file.write_all(text.as_bytes()))
        .and_then(|()| file.sync_all())
        .map_err(io)?;
    confirmed.update(&text);
    let (bytes, sha256) = (bytes + text.len() as u64, hexadecimal(&confirmed.finalize()));
    Ok(Paved { boxes, bytes, sha256, ..paved })
}

/// What a tree without its summary holds.
fn read_back(input: impl BufRead) -> Result<Paved, Rejected> {
    let mut reader = Reader::new(input)?;
    let mut coarsest: Option<u32> = None;
    while let Some(visited) = reader.next()? {
        if is_left(&visited.item.kind) {
            coarsest = Some(coarsest.map_or(visited.depth, |least| least.min(visited.depth)));
        }
    }
    let (header, summary) = (reader.header().clone(), reader.summary.clone());
    Ok(Paved { header, summary, coarsest, boxes: 0, bytes: 0, sha256: String::new() })
}

/// What is wrong with a file's content, or with reading it.
pub(super) fn refused(path: &Path, reason: Rejected) -> PaveError {
    match reason {
        Rejected::Io(error) => PaveError::Io(path.to_owned(), error),
        reason => PaveError::Defect(reason),
    }
}
