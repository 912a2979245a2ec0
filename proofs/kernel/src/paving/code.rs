//! The bytes of a node: its steps, then its kind.

use super::cell::Axis;
use super::cut::Cut;
use super::reader::bytes;
use super::{Rejected, MOST_OBLIGATIONS};
use crate::certificate::{Evidence, Failure};
use crate::test::Multiplier;
use std::io::Read;

/// A node: what is shown of its cell, and what becomes of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The steps that discharge obligations on the whole cell, of a node that is split or inner.
    pub steps: Vec<Step>,
    /// What it is.
    pub kind: Kind,
}

/// An obligation, by its number, and what it is discharged by: by its own evidence where none is given
/// (`own.rs`).
#[derive(Clone, Debug, PartialEq)]
pub struct Step(pub usize, pub Option<Evidence>);

/// What a node is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Halved along this axis.
    Split(Axis),
    /// Halved along this other coordinate: inner if both parts are, or outside.
    Part(usize),
    /// The claim holds at every point: what no step on the path discharges, its own evidence does.
    Inner,
    /// Of a part: no point of it is in the workspace.
    Outside,
    /// The claim fails at every point, for every machine.
    Outer(Outer),
    /// It fails so where each other coordinate, in its order, has the value `min + (max - min) n/2^16`.
    At(Vec<i64>, Outer),
    /// Inner on one side, outer on the other, undecided between.
    Cut(Cut),
    /// Undecided.
    Boundary,
    /// Left out by symmetry.
    Mirrored,
}

impl Kind {
    /// Whether it is shown what the claim is on the cell, or on parts of it.
    pub fn is_decided(&self) -> bool {
        matches!(self, Kind::Inner | Kind::Outer(_) | Kind::At(..) | Kind::Cut(_))
    }
}

/// How a claim fails.
#[derive(Clone, Debug, PartialEq)]
pub enum Outer {
    /// In this obligation, in its own directions (`own.rs`).
    Own(usize),
    /// As is said.
    Given(Box<Failure>),
}

pub(crate) const INNER: u8 = 0x03;
pub(crate) const BOUNDARY: u8 = 0x04;
pub(crate) const MIRRORED: u8 = 0x05;
pub(crate) const REACH: u8 = 0x06;
pub(crate) const ROW: u8 = 0x07;
pub(crate) const FAILS: u8 = 0x08;
pub(crate) const STEP: u8 = 0x09;
/// Before an outer kind: where it fails.
pub(crate) const AT: u8 = 0x0a;
pub(crate) const OUTSIDE: u8 = 0x0b;
/// Followed by the normal and the ends, each in a list, and an obligation.
pub(crate) const CUT: u8 = 0x0c;
/// With the 15 that follow: the own step of this obligation.
pub(crate) const OWN_STEP: u8 = 0x10;
/// With the four that follow: halved along this other coordinate.
pub(crate) const PART: u8 = 0x20;
/// With the 63 that follow: outer in this obligation.
pub(crate) const OUTER: u8 = 0x40;
/// With the 74 that follow: split, with halves of the kinds of [`plain`]. `25 axis + 5 lower + upper`.
pub(crate) const PAIR: u8 = 0x80;

pub(crate) const TEST: u8 = 0;
pub(crate) const DIVIDED: u8 = 1;
pub(crate) const LOWER: u8 = 2;
pub(crate) const LOWER_DIVIDED: u8 = 3;
pub(crate) const RANK: u8 = 4;
pub(crate) const CONDITIONING: u8 = 5;
pub(crate) const ACCURACY: u8 = 6;
pub(crate) const DIRECTION: u8 = 7;
pub(crate) const NEGATIVE: u8 = 8;
/// About evidence with a greater tag, or none of these three.
pub(crate) const CONTROL: u8 = 9;
pub(crate) const TURNED: u8 = 10;
pub(crate) const INSIDE: u8 = 11;

/// Most rows of a matrix, most entries of a row, most directions: more than any claim has.
pub(crate) const MOST: u8 = 16;

/// The kinds that halves within one byte may have.
pub(crate) fn plain(n: u8) -> Option<Kind> {
    match n {
        0 => Some(Kind::Inner),
        1 => Some(Kind::Boundary),
        2 => Some(Kind::Mirrored),
        3 | 4 => Some(Kind::Outer(Outer::Own(usize::from(n) - 3))),
        _ => None,
    }
}

impl Item {
    /// Reads an item, the node's number being `node`, and the kinds of its halves where these follow in
    /// the same byte.
    pub fn read(input: &mut impl Read, node: u64) -> Result<(Self, Option<[Kind; 2]>), Rejected> {
        let mut source = Source { input, node };
        let bad = |code| Rejected::BadCode(node, code);
        let (mut steps, mut at) = (Vec::new(), None);
        loop {
            let code = source.byte()?;
            // None is discharged twice, and there are no more than so many.
            if steps.len() > MOST_OBLIGATIONS {
                return Err(bad(code));
            }
            let (kind, halves) = match code {
                OWN_STEP..0x20 => {
                    steps.push(Step(usize::from(code - OWN_STEP), None));
                    continue;
                }
                STEP => {
                    steps.push(Step(usize::from(source.byte()?), Some(source.evidence(0)?)));
                    continue;
                }
                AT if at.is_none() => {
                    at = Some(source.integers()?);
                    continue;
                }
                OUTSIDE => (Kind::Outside, None),
                CUT => {
                    let normal = source.integers()?;
                    let ends = source.integers()?.try_into().map_err(|_| bad(code))?;
                    let fails = usize::from(source.byte()?);
                    (Kind::Cut(Cut { normal, ends, fails }), None)
                }
                PART..0x25 => (Kind::Part(usize::from(code - PART)), None),
                0..INNER => (Kind::Split(Axis::ALL[usize::from(code)]), None),
                INNER => (Kind::Inner, None),
                BOUNDARY => (Kind::Boundary, None),
                MIRRORED => (Kind::Mirrored, None),
                REACH => (Kind::Outer(Outer::Given(Failure::Reach.into())), None),
                ROW => {
                    let [obligation, leg] = [source.byte()?, source.byte()?].map(usize::from);
                    (Kind::Outer(Outer::Given(Failure::Row(obligation, leg).into())), None)
                }
                FAILS => {
                    let obligation = usize::from(source.byte()?);
                    let directions = (0..source.count()?).map(|_| source.integers());
                    let directions = directions.collect::<Result<_, _>>()?;
                    let failure = Failure::Obligation(obligation, directions);
                    (Kind::Outer(Outer::Given(failure.into())), None)
                }
                OUTER..PAIR => (Kind::Outer(Outer::Own(usize::from(code - OUTER))), None),
                PAIR..0xcb => {
                    let n = code - PAIR;
                    let halves = plain(n / 5 % 5).zip(plain(n % 5)).map(<[Kind; 2]>::from);
                    (Kind::Split(Axis::ALL[usize::from(n / 25)]), halves)
                }
                _ => return Err(bad(code)),
            };
            let kind = match (at, kind) {
                (None, kind) => kind,
                (Some(at), Kind::Outer(outer)) => Kind::At(at, outer),
                _ => return Err(bad(code)),
            };
            return Ok((Item { steps, kind }, halves));
        }
    }
}

struct Source<'a, R> {
    input: &'a mut R,
    node: u64,
}

impl<R: Read> Source<'_, R> {
    fn byte(&mut self) -> Result<u8, Rejected> {
        bytes::<1>(self.input, self.node).map(|[byte]| byte)
    }

    fn count(&mut self) -> Result<u8, Rejected> {
        match self.byte()? {
            n if n <= MOST => Ok(n),
            n => Err(Rejected::BadCode(self.node, n)),
        }
    }

    fn integers(&mut self) -> Result<Vec<i64>, Rejected> {
        (0..self.count()?).map(|_| self.integer()).collect()
    }

    fn integer(&mut self) -> Result<i64, Rejected> {
        let mut n = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            let part = u64::from(byte & 0x7f);
            if part << shift >> shift != part || (byte == 0 && shift > 0) {
                return Err(Rejected::BadCode(self.node, byte));
            }
            n |= part << shift;
            if byte < 0x80 {
                return Ok((n >> 1).cast_signed() ^ -(n & 1).cast_signed());
            }
        }
        Err(Rejected::BadCode(self.node, 0x80))
    }

    fn multiplier(&mut self) -> Result<Multiplier, Rejected> {
        let places = u32::from(self.byte()?);
        let y = (0..self.count()?).map(|_| self.integers()).collect::<Result<_, _>>()?;
        Ok(Multiplier { y, places })
    }

    /// Evidence; about others with tags from `least` on alone.
    fn evidence(&mut self, least: u8) -> Result<Evidence, Rejected> {
        Ok(match self.byte()? {
            tag @ CONTROL..=INSIDE if tag >= least => {
                let numbers = self.integers()?;
                let of = Box::new(self.evidence(tag + 1)?);
                match (tag, &numbers[..]) {
                    (CONTROL, []) => Evidence::Control(of),
                    (TURNED, &[n, places @ 0..=255]) => Evidence::Turned(of, n, places as u32),
                    (INSIDE, &[n, places @ 0..=255]) => Evidence::Inside(of, n, places as u32),
                    _ => return Err(Rejected::BadCode(self.node, tag)),
                }
            }
            TEST => Evidence::Test,
            DIVIDED => Evidence::Divided,
            NEGATIVE => Evidence::Negative,
            LOWER => Evidence::Lower(self.multiplier()?),
            LOWER_DIVIDED => Evidence::LowerDivided(self.multiplier()?),
            RANK => Evidence::Rank(self.multiplier()?),
            DIRECTION => Evidence::Direction(self.multiplier()?),
            CONDITIONING => Evidence::Conditioning(self.multiplier()?, self.integers()?),
            ACCURACY => {
                let y = self.multiplier()?;
                match self.integers()?[..] {
                    [kappa] => Evidence::Accuracy(y, kappa, 0),
                    [kappa, p @ 1..=255] => Evidence::Accuracy(y, kappa, p as u32),
                    _ => return Err(Rejected::BadCode(self.node, ACCURACY)),
                }
            }
            other => return Err(Rejected::BadCode(self.node, other)),
        })
    }
}
