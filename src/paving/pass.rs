//! Writes a paving, subtree by subtree, to a file that can be taken up again.

use super::decide::discharged;
use super::tree::{Cancelled, Grower, Grown, Root, Segment, Tally};
use super::{header, plan, Decider, Goal};
use crate::output::{self, OutputError};
use crate::search::{Control, Progress};
use orthocert_checker::claim::MachineClaim;
use orthocert_checker::paving::{Header, Item, Kind, Reader, Rejected, Shares, Summary, Visited};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Depth of the subtrees' roots: some thousands of them.
const COARSE: u32 = 18;
/// Subtrees that are grown together and wait in memory for their turn to be written.
pub(super) const WINDOW: usize = 128;
/// Deepest tree that is searched for.
pub const DEEPEST: u32 = 90;

/// Why there is no paving.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PaveError {
    /// It was cancelled; what is written can be taken up again.
    #[error("interrupted")]
    Cancelled,
    /// The claim cannot be paved.
    #[error("{0}")]
    Claim(Rejected),
    /// There is nothing to take up again, or it is of another paving.
    #[error("{0}: cannot be taken up again: {1}")]
    Resume(PathBuf, String),
    /// The unfinished file cannot be had.
    #[error(transparent)]
    Output(OutputError),
    /// A file cannot be written or read.
    #[error("{0}: {1}")]
    Io(PathBuf, io::Error),
    /// The checker does not accept what was written.
    #[error("the checker does not accept the paving: {0}")]
    Defect(Rejected),
}

impl From<Cancelled> for PaveError {
    fn from(_: Cancelled) -> Self {
        PaveError::Cancelled
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
    /// The shares of the volume.
    pub shares: Shares,
    /// Boxes tried by this run.
    pub boxes: u64,
    /// Bytes of the file.
    pub bytes: u64,
}

/// The unfinished file of a paving.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

/// Paves the claim's box and writes the paving to `path`, which holds what it held before until the
/// paving is complete. From when its unfinished file is opened until it has taken its place, no other
/// run can have that file.
///
/// # Errors
/// [`PaveError`].
pub fn pave(
    claim: &MachineClaim,
    goal: &Goal,
    path: &Path,
    mut resume: Resume,
    control: &mut Control<'_>,
) -> Result<Paved, PaveError> {
    let part = unfinished(path);
    let decider = Decider::new(&header(claim, DEEPEST)).map_err(PaveError::Claim)?;
    let mut held = match resume {
        Resume::Yes => Some(taken_up(&part)?),
        Resume::No => None,
    };
    let mut depth = match &held {
        Some(file) => {
            let depth = earlier_depth(claim, file, &part)?;
            if goal.depth.is_some_and(|asked| depth > asked) {
                let reason =
                    "it was begun with a smaller --precision; accepted: the same".to_owned();
                return Err(PaveError::Resume(part, reason));
            }
            depth
        }
        None => planned(&decider, claim, goal, control)?,
    };
    loop {
        let mut pass = Pass::new(&decider, header(claim, depth), &part, control.cancel)?;
        let file = match held {
            Some(ref file) => file,
            None => held.insert(output::open_locked(&part, true).map_err(PaveError::Output)?),
        };
        pass.run(file, resume, control)?;
        let paved = finish(file, &part, pass.boxes)?;
        let gap = paved.shares.boundary as f64 / paved.shares.inner as f64;
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
fn earlier_depth(claim: &MachineClaim, file: &File, part: &Path) -> Result<u32, PaveError> {
    let fails = |reason: String| PaveError::Resume(part.to_owned(), reason);
    let found = orthocert_checker::paving::header(&mut BufReader::new(file))
        .map_err(|reason| fails(reason.to_string()))?;
    if found == header(claim, found.depth) {
        Ok(found.depth)
    } else {
        Err(fails("it is the beginning of another design's paving".to_owned()))
    }
}

fn planned(
    decider: &Decider,
    claim: &MachineClaim,
    goal: &Goal,
    control: &Control<'_>,
) -> Result<u32, PaveError> {
    let symmetric = header(claim, 0).symmetry.is_some();
    let deepest = goal.depth.unwrap_or(DEEPEST);
    let coarse = COARSE.min(deepest);
    let grower = Grower { decider, symmetric, depth: deepest, cancel: control.cancel };
    let mut above = Tally::up_to(deepest);
    let segments = grower.segments(Root::WHOLE, coarse, &mut above)?;
    Ok(plan::depth(&grower, &segments, &above, coarse, goal)?)
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
}

impl<'a> Pass<'a> {
    fn new(
        decider: &'a Decider,
        header: Header,
        part: &Path,
        cancel: &'a AtomicBool,
    ) -> Result<Self, PaveError> {
        let symmetric = header.symmetry.is_some();
        let grower = Grower { decider, symmetric, depth: header.depth, cancel };
        let mut above = Tally::up_to(header.depth);
        let segments = grower.segments(Root::WHOLE, COARSE.min(header.depth), &mut above)?;
        Ok(Pass { grower, header, part: part.to_owned(), segments, boxes: above.boxes })
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
                file.write_all(&self.first_line()?).map_err(|e| self.io(e))?;
                0
            }
            Resume::Yes => self.take_up(file)?,
        };
        // What is grown waits for the disk while the next is grown.
        let mut grown: Vec<Grown> = Vec::new();
        while done < self.segments.len() || !grown.is_empty() {
            let window = &self.segments[done..self.segments.len().min(done + WINDOW)];
            let (written, next) = std::thread::scope(|scope| {
                let writer = scope.spawn(|| written(file, &grown));
                let next = self.grower.grow_all(window);
                (writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), next)
            });
            written.map_err(|e| self.io(e))?;
            grown = next?;
            done += window.len();
            self.boxes += grown.iter().map(|(_, boxes)| boxes).sum::<u64>();
            let closed = done as f64 / self.segments.len() as f64;
            let boxes = usize::try_from(self.boxes).unwrap_or(usize::MAX);
            (control.progress)(Progress { boxes, closed });
        }
        Ok(())
    }

    /// Ends the unfinished file after the last segment that it holds whole; returns how many it
    /// does. Every node that is kept is checked again.
    fn take_up(&self, mut file: &File) -> Result<usize, PaveError> {
        let fails = |reason: String| PaveError::Resume(self.part.clone(), reason);
        let open = |e: io::Error| fails(e.to_string());
        file.rewind().map_err(open)?;
        let mut input = Counting { input: BufReader::new(file), count: 0 };
        let mut first = vec![0; self.first_line()?.len()];
        input.read_exact(&mut first).map_err(open)?;
        if first != self.first_line()? {
            return Err(fails("its first line is another".to_owned()));
        }
        let (mut whole, mut kept) = (input.count, 0);
        for segment in &self.segments {
            if self.follows(segment, &mut input).is_err() {
                break;
            }
            (whole, kept) = (input.count, kept + 1);
        }
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::End(0))).map_err(open)?;
        Ok(kept)
    }

    /// Reads a segment, whose evidence has to hold.
    fn follows(&self, segment: &Segment, input: &mut impl Read) -> Result<(), Rejected> {
        let root = match segment {
            Segment::Known(bytes) => {
                let mut found = vec![0; bytes.len()];
                input.read_exact(&mut found)?;
                return if found == *bytes { Ok(()) } else { Err(Rejected::Truncated(0)) };
            }
            Segment::Subtree(root) => *root,
        };
        let mut waiting = vec![root];
        while let Some(Root { cell, inherited, depth }) = waiting.pop() {
            let item = Item::read(input, 0)?;
            let done = discharged(inherited, &item.steps);
            if let Kind::Split(axis) = item.kind {
                let halves = cell.halves(axis).filter(|_| depth < self.header.depth);
                let (lower, upper) = halves.ok_or(Rejected::TooDeep(0))?;
                let half = |cell| Root { cell, inherited: done, depth: depth + 1 };
                waiting.extend([half(upper), half(lower)]);
            }
            let visited = Visited { cell, inherited, depth, node: 0, item };
            self.grower.decider.judge().check(&visited)?;
        }
        Ok(())
    }
}

/// The bytes of the first line.
pub(super) fn first_line(header: &Header) -> io::Result<Vec<u8>> {
    Ok((serde_json::to_string(header)? + "\n").into_bytes())
}

/// Appends the summary to a tree, as the checker's reader finds it. `boxes` were tried for it.
pub(super) fn finish(mut file: &File, path: &Path, boxes: u64) -> Result<Paved, PaveError> {
    let io = |error: io::Error| PaveError::Io(path.to_owned(), error);
    file.rewind().map_err(io)?;
    let mut reader = Reader::new(BufReader::new(file)).map_err(PaveError::Defect)?;
    while reader.next().map_err(PaveError::Defect)?.is_some() {}
    let text = serde_json::to_string(&reader.summary()).map_err(|e| io(e.into()))?;
    file.seek(SeekFrom::End(0))
        .and_then(|_| file.write_all((text + "\n").as_bytes()))
        .and_then(|()| file.sync_all())
        .map_err(io)?;
    let bytes = file.metadata().map_err(io)?.len();
    let (shares, summary) = (reader.shares(), reader.summary());
    Ok(Paved { header: reader.header().clone(), summary, shares, boxes, bytes })
}

/// Counts the bytes that are read.
struct Counting<R> {
    input: R,
    count: u64,
}

impl<R: BufRead> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.input.read(buffer)?;
        self.count += read as u64;
        Ok(read)
    }
}
