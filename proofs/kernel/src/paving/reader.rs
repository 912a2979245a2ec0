//! The nodes of a paving, one by one, and their cells.

use super::cell::{Axis, Cell};
use super::code::{Item, Kind};
use super::cut::Cut;
use super::judge::bit;
use super::{symmetry, Header, Rejected, Summary, FORMAT, MAX_LINE, SHARE_BITS};
use crate::document::{read, written};
use std::io::{self, BufRead, Read};

/// A node with its place in the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Visited {
    /// Its cell.
    pub cell: Cell,
    /// What its ancestors discharge, as a bit for each obligation.
    pub inherited: u128,
    /// Splits above it.
    pub depth: u32,
    /// Its number in preorder, from zero.
    pub node: u64,
    /// Its kind and evidence.
    pub item: Item,
}

/// The root of a subtree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Root {
    /// Its cell.
    pub cell: Cell,
    /// What is discharged above it.
    pub inherited: u128,
    /// Splits above it.
    pub depth: u32,
}

impl Root {
    /// The whole box.
    pub const WHOLE: Root = Root { cell: Cell::ROOT, inherited: 0, depth: 0 };
}

/// Reads a paving in one pass, in memory bounded by its depth.
pub struct Reader<R> {
    input: R,
    header: Header,
    order: [Vec<usize>; 2],
    /// What is to be read, and what is read already of a node whose byte has its halves.
    waiting: Vec<(Root, Option<Kind>)>,
    /// The nodes read so far.
    pub nodes: u64,
    /// Of the nodes read so far, but for those of parts.
    pub summary: Summary,
}

/// Reads the first line of a paving: the text that its header has.
///
/// # Errors
/// If it is none.
pub fn header<R: BufRead>(input: &mut R) -> Result<Header, Rejected> {
    let mut bytes = Vec::new();
    input.take(MAX_LINE as u64).read_until(b'\n', &mut bytes)?;
    let header: Header = read(&bytes, FORMAT, MAX_LINE)?;
    if header.depth > SHARE_BITS {
        return Err(Rejected::Depth(header.depth));
    }
    Ok(header)
}

impl<R: BufRead> Reader<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// If it is none.
    pub fn new(mut input: R) -> Result<Self, Rejected> {
        let header = header(&mut input)?;
        Self::below(input, &header, Root::WHOLE)
    }
}

impl<R: Read> Reader<R> {
    /// Reads the subtree of a paving with this header.
    ///
    /// # Errors
    /// If the header's claim cannot be paved.
    pub fn below(input: R, header: &Header, root: Root) -> Result<Self, Rejected> {
        Ok(Reader {
            input,
            order: header.order()?,
            header: header.clone(),
            waiting: vec![(root, None)],
            nodes: 0,
            summary: Summary::default(),
        })
    }

    /// The first line.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The next node in preorder, of which the place in the tree alone is checked; `None` after the
    /// last.
    ///
    /// # Errors
    /// If it is none.
    #[allow(clippy::should_implement_trait)] // It fails, and a failure is the end.
    pub fn next(&mut self) -> Result<Option<Visited>, Rejected> {
        let Some((Root { cell, inherited, depth }, known)) = self.waiting.pop() else {
            return Ok(None);
        };
        let node = self.nodes;
        let (item, halves) = match known {
            Some(kind) => (Item { steps: Vec::new(), kind }, None),
            None => Item::read(&mut self.input, node)?,
        };
        self.nodes += 1;
        let refused = |why| Err(Rejected::Node(node, why));
        let done = refuse_repetition(inherited, &item, node)?;
        let is_of_part = matches!(item.kind, Kind::Part(_) | Kind::Inner | Kind::Outside);
        if cell.is_part() && !is_of_part || item.kind == Kind::Outside && !cell.is_part() {
            return refused(
                ": parts of a cell, and they alone, are inner, in parts, or outside the workspace",
            );
        }
        let halved = match item.kind {
            Kind::Split(axis) => Some((self.halves(&cell, axis, depth), depth + 1)),
            Kind::Part(k) => Some((cell.parts(k).filter(|_| k < self.order[1].len()), depth)),
            _ => None,
        };
        let is_cut = |cut: &Cut| cut.is_of(self.order[0].len()) && self.header.may_cut(&cell);
        if matches!(&item.kind, Kind::Cut(cut) if !is_cut(cut)) {
            return refused(
                " is cut by no plane, or is no cell of all coordinates that stands for itself alone, or for \
                 five images",
            );
        }
        if let Some((cells, depth)) = halved {
            let (lower, upper) = cells.ok_or(Rejected::Node(node, " is split too often"))?;
            let below = |cell| Root { cell, inherited: done, depth };
            let [first, second] = halves.map_or([None, None], |halves| halves.map(Some));
            self.waiting.push((below(upper), second));
            self.waiting.push((below(lower), first));
        }
        self.count(&cell, &item.kind);
        Ok(Some(Visited { cell, inherited, depth, node, item }))
    }

    fn halves(&self, cell: &Cell, axis: Axis, depth: u32) -> Option<(Cell, Cell)> {
        let may = depth < self.header.depth && axis.index() < self.order[0].len();
        may.then(|| cell.halves(axis)).flatten()
    }

    fn count(&mut self, cell: &Cell, kind: &Kind) {
        if cell.is_part() {
            return;
        }
        let (header, summary) = (&self.header, &mut self.summary);
        match kind {
            Kind::Split(_) => summary.splits += 1,
            // All parts are shown to be inner, or outside, or the paving is rejected.
            Kind::Part(_) | Kind::Outside | Kind::Inner => {
                summary.inner_share.0 += header.share(cell);
                summary.inner += 1;
            }
            Kind::Outer(_) | Kind::At(..) => summary.outer += 1,
            Kind::Cut(_) | Kind::Boundary => {
                let share = header.share(cell);
                let cut = if let Kind::Cut(cut) = kind { Some(cut.shares(share)) } else { None };
                let [inner, outer] = cut.unwrap_or_default();
                summary.inner_share.0 += inner;
                summary.boundary_share.0 += share - inner - outer;
                summary.boundary += 1;
            }
            Kind::Mirrored => summary.mirrored += 1,
        }
    }

    /// After the last node: reads the summary, which has to be that of the tree and the last of the
    /// bytes.
    ///
    /// # Errors
    /// If it is not.
    pub fn finish(self) -> Result<Summary, Rejected> {
        if !self.waiting.is_empty() {
            return Err(Rejected::Truncated(self.nodes));
        }
        let wanted = written(&self.summary).map_err(|e| Rejected::Io(e.into()))?;
        let mut bytes = Vec::new();
        // One byte more than there may be, lest anything hide behind it.
        self.input.take(wanted.len() as u64 + 1).read_to_end(&mut bytes)?;
        (bytes == wanted.as_bytes()).then_some(self.summary).ok_or(Rejected::Whole(
            "the last line is not the summary of the tree, or does not end the file",
        ))
    }
}

impl Header {
    /// The share of the box that a cell stands for, in units of `2^-`[`SHARE_BITS`].
    pub fn share(&self, cell: &Cell) -> u128 {
        match self.symmetry {
            Some(_) => symmetry::six_ordered(cell),
            // Three levels of at most 40.
            None => 1 << (SHARE_BITS - cell.depth()),
        }
    }

    /// Whether a cell may be cut: its shares are those of places, and all of it is taken.
    pub fn may_cut(&self, cell: &Cell) -> bool {
        let images = if self.symmetry.is_some() { 6 } else { 1 };
        let is_whole = self.share(cell) == images << (SHARE_BITS - cell.depth());
        self.coordinates.is_none() && is_whole
    }
}

/// Every step discharges something that its path has not discharged: that bounds the work for a
/// tree by its nodes. Returns what is then discharged.
fn refuse_repetition(inherited: u128, item: &Item, node: u64) -> Result<u128, Rejected> {
    let mut done = inherited;
    for step in &item.steps {
        let new = bit(step.0) & !done;
        if new == 0 {
            return Err(Rejected::Repeated(node, step.0));
        }
        done |= new;
    }
    match item.kind {
        Kind::Split(_) | Kind::Part(_) | Kind::Inner => Ok(done),
        _ if item.steps.is_empty() => Ok(done),
        _ => Err(Rejected::Node(node, " has steps but is neither split nor inner")),
    }
}

/// The bytes of an item, one after the other.
pub(super) fn bytes<const N: usize>(input: &mut impl Read, node: u64) -> Result<[u8; N], Rejected> {
    let mut bytes = [0; N];
    match input.read_exact(&mut bytes) {
        Ok(()) => Ok(bytes),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            Err(Rejected::Truncated(node))
        }
        Err(error) => Err(Rejected::Io(error)),
    }
}
