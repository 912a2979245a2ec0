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

/// How a claim fails.
#[derive(Clone, Debug, PartialEq)]
pub enum Outer {
    /// In this obligation, in its own directions (`own.rs`).
    Own(usize),
    /// As is said.
    Given(Failure),
}

const INNER: u8 = 0x03;
const BOUNDARY: u8 = 0x04;
const MIRRORED: u8 = 0x05;
const REACH: u8 = 0x06;
const ROW: u8 = 0x07;
const FAILS: u8 = 0x08;
const STEP: u8 = 0x09;
/// Before an outer kind: where it fails.
const AT: u8 = 0x0a;
const OUTSIDE: u8 = 0x0b;
/// Followed by the normal and the ends, each in a list, and an obligation.
const CUT: u8 = 0x0c;
/// With the 15 that follow: the own step of this obligation.
const OWN_STEP: u8 = 0x10;
/// With the four that follow: halved along this other coordinate.
const PART: u8 = 0x20;
/// With the 63 that follow: outer in this obligation.
const OUTER: u8 = 0x40;
/// With the 74 that follow: split, with halves of the kinds of [`plain`]. `25 axis + 5 lower + upper`.
const PAIR: u8 = 0x80;

const TEST: u8 = 0;
const DIVIDED: u8 = 1;
const LOWER: u8 = 2;
const LOWER_DIVIDED: u8 = 3;
const RANK: u8 = 4;
const CONDITIONING: u8 = 5;
const ACCURACY: u8 = 6;
const DIRECTION: u8 = 7;
const NEGATIVE: u8 = 8;
/// About evidence with a greater tag, or none of these three.
const CONTROL: u8 = 9;
const TURNED: u8 = 10;
const INSIDE: u8 = 11;

/// Most rows of a matrix, most entries of a row, most directions: more than any claim has.
const MOST: u8 = 16;

/// The kinds that halves within one byte may have.
fn plain(n: u8) -> Option<Kind> {
    match n {
        0 => Some(Kind::Inner),
        1 => Some(Kind::Boundary),
        2 => Some(Kind::Mirrored),
        3 | 4 => Some(Kind::Outer(Outer::Own(usize::from(n) - 3))),
        _ => None,
    }
}

/// Appends a split and both of its halves, if a byte does for them.
pub fn write_pair(out: &mut Vec<u8>, axis: Axis, halves: [&Kind; 2]) -> Option<()> {
    let number = |kind: &Kind| (0..5).find(|&n| plain(n).as_ref() == Some(kind));
    out.push(PAIR + 25 * axis as u8 + 5 * number(halves[0])? + number(halves[1])?);
    Some(())
}

impl Item {
    /// Reads an item, the node's number being `node`, and the kinds of its halves where these follow in
    /// the same byte.
    pub fn read(input: &mut impl Read, node: u64) -> Result<(Self, Option<[Kind; 2]>), Rejected> {
        let mut source = Source { input, node };
        let (mut steps, mut at) = (Vec::new(), None);
        loop {
            let code = source.byte()?;
            // None is discharged twice, and there are no more than so many.
            if steps.len() > MOST_OBLIGATIONS {
                return Err(Rejected::BadCode(node, code));
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
                    let Ok(ends) = source.integers()?.try_into() else {
                        return Err(Rejected::BadCode(node, code));
                    };
                    let fails = usize::from(source.byte()?);
                    (Kind::Cut(Cut { normal, ends, fails }), None)
                }
                PART..0x25 => (Kind::Part(usize::from(code - PART)), None),
                0..INNER => (Kind::Split(Axis::ALL[usize::from(code)]), None),
                INNER => (Kind::Inner, None),
                BOUNDARY => (Kind::Boundary, None),
                MIRRORED => (Kind::Mirrored, None),
                REACH => (Kind::Outer(Outer::Given(Failure::Reach)), None),
                ROW => {
                    let [obligation, leg] = [source.byte()?, source.byte()?].map(usize::from);
                    (Kind::Outer(Outer::Given(Failure::Row(obligation, leg))), None)
                }
                FAILS => {
                    let obligation = usize::from(source.byte()?);
                    let count = source.count()?;
                    let directions =
                        (0..count).map(|_| source.integers()).collect::<Result<_, _>>()?;
                    let failure = Failure::Obligation(obligation, directions);
                    (Kind::Outer(Outer::Given(failure)), None)
                }
                OUTER..PAIR => (Kind::Outer(Outer::Own(usize::from(code - OUTER))), None),
                _ => {
                    let number = code.checked_sub(PAIR).filter(|number| *number < 75);
                    let pair = number.and_then(|n| {
                        let axis = Axis::ALL[usize::from(n / 25)];
                        Some((Kind::Split(axis), Some([plain(n / 5 % 5)?, plain(n % 5)?])))
                    });
                    pair.ok_or(Rejected::BadCode(node, code))?
                }
            };
            let kind = match (at, kind) {
                (None, kind) => kind,
                (Some(at), Kind::Outer(outer)) => Kind::At(at, outer),
                _ => return Err(Rejected::BadCode(node, code)),
            };
            return Ok((Item { steps, kind }, halves));
        }
    }

    /// Appends the item's bytes; `None` if it has none.
    pub fn write(&self, out: &mut Vec<u8>) -> Option<()> {
        write_steps(&self.steps, out)?;
        let small = |n: usize| u8::try_from(n).ok();
        match &self.kind {
            Kind::Split(axis) => out.push(*axis as u8),
            Kind::Part(other) => out.push(PART + small(*other).filter(|k| *k < 5)?),
            Kind::Outside => out.push(OUTSIDE),
            Kind::At(at, outer) => {
                out.push(AT);
                put(out, at)?;
                Item { steps: Vec::new(), kind: Kind::Outer(outer.clone()) }.write(out)?;
            }
            Kind::Cut(Cut { normal, ends, fails }) => {
                out.push(CUT);
                put(out, normal)?;
                put(out, ends)?;
                out.push(small(*fails)?);
            }
            Kind::Inner => out.push(INNER),
            Kind::Boundary => out.push(BOUNDARY),
            Kind::Mirrored => out.push(MIRRORED),
            Kind::Outer(Outer::Own(obligation)) => {
                out.push(OUTER + small(*obligation).filter(|n| *n < PAIR - OUTER)?);
            }
            Kind::Outer(Outer::Given(Failure::Reach)) => out.push(REACH),
            Kind::Outer(Outer::Given(Failure::Row(obligation, leg))) => {
                out.extend([ROW, small(*obligation)?, small(*leg)?]);
            }
            Kind::Outer(Outer::Given(Failure::Obligation(obligation, directions))) => {
                out.extend([FAILS, small(*obligation)?, count(directions.len())?]);
                directions.iter().try_for_each(|v| put(out, v))?;
            }
            Kind::Outer(Outer::Given(Failure::Same { .. } | Failure::Singular(_))) => return None,
        }
        Some(())
    }
}

/// Appends steps.
pub fn write_steps(steps: &[Step], out: &mut Vec<u8>) -> Option<()> {
    steps.iter().try_for_each(|Step(obligation, evidence)| {
        let obligation = u8::try_from(*obligation).ok()?;
        match evidence {
            None => out.push(OWN_STEP + Some(obligation).filter(|o| *o < 16)?),
            Some(evidence) => {
                out.extend([STEP, obligation]);
                write_evidence(out, evidence)?;
            }
        }
        Some(())
    })
}

fn write_evidence(out: &mut Vec<u8>, evidence: &Evidence) -> Option<()> {
    let (tag, y) = match evidence {
        Evidence::Test => (TEST, None),
        Evidence::Divided => (DIVIDED, None),
        Evidence::Negative => (NEGATIVE, None),
        Evidence::Lower(y) => (LOWER, Some(y)),
        Evidence::LowerDivided(y) => (LOWER_DIVIDED, Some(y)),
        Evidence::Rank(y) => (RANK, Some(y)),
        Evidence::Direction(y) => (DIRECTION, Some(y)),
        Evidence::Conditioning(y, _) => (CONDITIONING, Some(y)),
        Evidence::Accuracy(y, ..) => (ACCURACY, Some(y)),
        Evidence::Control(of) => return write_about(out, CONTROL, &[], of),
        Evidence::Turned(of, n, p) => return write_about(out, TURNED, &[*n, (*p).into()], of),
        Evidence::Inside(of, n, p) => return write_about(out, INSIDE, &[*n, (*p).into()], of),
        _ => return None,
    };
    out.push(tag);
    if let Some(Multiplier { y, places }) = y {
        out.extend([u8::try_from(*places).ok()?, count(y.len())?]);
        y.iter().try_for_each(|row| put(out, row))?;
    }
    match evidence {
        Evidence::Conditioning(_, mu) => put(out, mu),
        Evidence::Accuracy(_, kappa, 0) => put(out, &[*kappa]),
        Evidence::Accuracy(_, kappa, p) => put(out, &[*kappa, i64::from(*p)]),
        _ => Some(()),
    }
}

/// Evidence about other evidence.
fn write_about(out: &mut Vec<u8>, tag: u8, numbers: &[i64], of: &Evidence) -> Option<()> {
    out.push(tag);
    put(out, numbers)?;
    write_evidence(out, of)
}

fn count(n: usize) -> Option<u8> {
    u8::try_from(n).ok().filter(|n| *n <= MOST)
}

/// A count, and integers: seven bits a byte, the least first, the eighth bit set in all but the last; of
/// `n` those of `2 n`, or `-2 n - 1` for a negative one.
fn put(out: &mut Vec<u8>, integers: &[i64]) -> Option<()> {
    out.push(count(integers.len())?);
    for &n in integers {
        let mut rest = (n << 1 ^ n >> 63).cast_unsigned();
        while rest >= 0x80 {
            out.push(rest as u8 | 0x80);
            rest >>= 7;
        }
        out.push(rest as u8);
    }
    Some(())
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
