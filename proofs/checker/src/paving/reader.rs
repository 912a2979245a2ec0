//! The nodes of a paving, one by one, and their cells.

use super::code::{Item, Kind};
use super::judge::discharged;
use super::{
    symmetry, Header, Judge, Rejected, Shares, Summary, FORMAT, MAX_AXIS_LEVEL, MAX_LINE,
    SHARE_BITS,
};
use crate::cell::{Axis, Cell};
use crate::check::quoted;
use crate::rule::Failure;
use crate::strict::{foreign_byte, Strict};
use serde::de::DeserializeOwned;
use std::io::{self, BufRead, Read};

/// A node with its place in the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Visited {
    /// Its cell.
    pub cell: Cell,
    /// What its ancestors discharge, as a bit for each obligation.
    pub inherited: u32,
    /// Splits above it.
    pub depth: u32,
    /// Its number in preorder, from zero.
    pub node: u64,
    /// Its kind and evidence.
    pub item: Item,
}

/// Reads a paving in one pass, in memory bounded by its depth.
pub struct Reader<R> {
    input: R,
    header: Header,
    waiting: Vec<(Cell, u32, u32)>,
    nodes: u64,
    /// Nodes of each kind: split, inner, outer, boundary, mirrored.
    counts: [u64; 5],
    shares: Shares,
}

/// Reads the first line of a paving.
pub fn header<R: BufRead>(input: &mut R) -> Result<Header, Rejected> {
    let mut bytes = Vec::new();
    input.take(MAX_LINE as u64).read_until(b'\n', &mut bytes)?;
    if bytes.pop() != Some(b'\n') {
        return Err(Rejected::Header("there is no line of at most a megabyte".to_owned()));
    }
    let header: Header = line(&bytes).map_err(Rejected::Header)?;
    if header.format != FORMAT {
        return Err(Rejected::Format(quoted(&header.format)));
    }
    if header.depth > SHARE_BITS {
        return Err(Rejected::Depth(header.depth));
    }
    Ok(header)
}

/// A line of the format: a JSON object without fractions, exponents and literals.
fn line<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
    if let Some((at, c)) = foreign_byte(text) {
        return Err(quoted(&format!("{c:?} at byte {at}, outside a string")));
    }
    let Strict(value) = serde_json::from_str(text).map_err(|e| quoted(&e.to_string()))?;
    Ok(value)
}

impl<R: BufRead> Reader<R> {
    /// Reads the header.
    pub fn new(mut input: R) -> Result<Self, Rejected> {
        let header = header(&mut input)?;
        header.machine_claim()?;
        let waiting = vec![(Cell::ROOT, 0, 0)];
        let shares = Shares::default();
        Ok(Reader { input, header, waiting, nodes: 0, counts: [0; 5], shares })
    }

    /// The first line.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The nodes read so far.
    pub fn nodes(&self) -> u64 {
        self.nodes
    }

    /// What can check the nodes' evidence.
    pub fn judge(&self) -> Result<Judge, Rejected> {
        Judge::new(&self.header)
    }

    /// The next node in preorder, of which the place in the tree alone is checked; `None` after the
    /// last.
    #[allow(clippy::should_implement_trait)] // It fails, and a failure is the end.
    pub fn next(&mut self) -> Result<Option<Visited>, Rejected> {
        let Some((cell, inherited, depth)) = self.waiting.pop() else {
            return Ok(None);
        };
        let node = self.nodes;
        let item = Item::read(&mut self.input, node)?;
        self.nodes += 1;
        let done = refuse_repetition(inherited, &item, node)?;
        if let Kind::Split(axis) = item.kind {
            let (lower, upper) = self.halves(&cell, axis, depth).ok_or(Rejected::TooDeep(node))?;
            self.waiting.push((upper, done, depth + 1));
            self.waiting.push((lower, done, depth + 1));
        }
        self.count(&cell, &item.kind);
        Ok(Some(Visited { cell, inherited, depth, node, item }))
    }

    fn halves(&self, cell: &Cell, axis: Axis, depth: u32) -> Option<(Cell, Cell)> {
        let shallow = depth < self.header.depth && cell.edges[axis.index()].level < MAX_AXIS_LEVEL;
        shallow.then(|| cell.halves(axis)).flatten()
    }

    fn count(&mut self, cell: &Cell, kind: &Kind) {
        let share = || match self.header.symmetry {
            Some(_) => symmetry::six_ordered(cell),
            // Three levels of at most 40.
            None => 1 << (SHARE_BITS - cell.edges.iter().map(|e| e.level).sum::<u32>()),
        };
        let position = match kind {
            Kind::Split(_) => 0,
            Kind::Inner => {
                self.shares.inner += share();
                1
            }
            Kind::Outer(_) => 2,
            Kind::Boundary => {
                self.shares.boundary += share();
                3
            }
            Kind::Mirrored => 4,
        };
        self.counts[position] += 1;
    }

    /// The tree's summary so far.
    pub fn summary(&self) -> Summary {
        let [splits, inner, outer, boundary, mirrored] = self.counts;
        Summary {
            splits,
            inner,
            outer,
            boundary,
            mirrored,
            inner_share: Shares::fraction(self.shares.inner),
            boundary_share: Shares::fraction(self.shares.boundary),
        }
    }

    /// The shares of the volume so far.
    pub fn shares(&self) -> Shares {
        self.shares
    }

    /// After the last node: reads the summary, which has to be that of the tree and the last of the
    /// bytes.
    pub fn finish(self) -> Result<(Summary, Shares), Rejected> {
        if !self.waiting.is_empty() {
            return Err(Rejected::Truncated(self.nodes));
        }
        let summary = self.summary();
        let mut bytes = Vec::new();
        // One byte more than there may be, lest anything hide behind it.
        self.input.take(MAX_LINE as u64 + 1).read_to_end(&mut bytes)?;
        let one_line = bytes.pop() == Some(b'\n') && !bytes.contains(&b'\n');
        if bytes.len() >= MAX_LINE || !one_line {
            return Err(Rejected::Summary("it does not end the file".to_owned()));
        }
        let found: Summary = line(&bytes).map_err(Rejected::Summary)?;
        if found == summary {
            Ok((summary, self.shares))
        } else {
            Err(Rejected::Summary("the numbers differ".to_owned()))
        }
    }
}

/// Every step discharges something that its path has not discharged: that bounds the work for a
/// tree by its nodes. Returns what is then discharged.
fn refuse_repetition(inherited: u32, item: &Item, node: u64) -> Result<u32, Rejected> {
    let mut done = inherited;
    for (at, step) in item.steps.iter().enumerate() {
        let new = discharged(&item.steps[at..=at]) & !done;
        if new == 0 {
            return Err(Rejected::Step(node, step.rule().0, Failure::Repeated));
        }
        done |= new;
    }
    match item.kind {
        Kind::Split(_) | Kind::Inner => Ok(done),
        _ if item.steps.is_empty() => Ok(done),
        _ => Err(Rejected::IdleSteps(node)),
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
