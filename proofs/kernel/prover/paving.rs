//! What is written in a paving: the bytes of nodes whose evidence holds.

use crate::certificate::{Evidence, Failure};
use crate::paving::code::*;
use crate::paving::{Axis, Cell, Cut, Item, Judge, Kind, Outer, Step};
use crate::test::Multiplier;

impl Judge<'_> {
    /// Whether an item's evidence holds on a cell, as far as it takes to say so in machine words where
    /// the precision is one for these: what does not is no more than undecided.
    pub fn confirms(&self, cell: &Cell, inherited: u128, item: &Item) -> bool {
        let place = (0, cell, inherited);
        match &self.words {
            Some(words) => words.item(self.subject, place, item).is_ok(),
            None => self.any_size.item(self.subject, place, item).is_ok(),
        }
    }
}

/// Appends a split and both of its halves, if a byte does for them.
pub fn write_pair(out: &mut Vec<u8>, axis: Axis, halves: [&Kind; 2]) -> Option<()> {
    let number = |kind: &Kind| (0..5).find(|&n| plain(n).as_ref() == Some(kind));
    out.push(PAIR + 25 * axis as u8 + 5 * number(halves[0])? + number(halves[1])?);
    Some(())
}

impl Item {
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
            Kind::Outer(Outer::Given(failure)) => match &**failure {
                Failure::Reach => out.push(REACH),
                Failure::Row(obligation, leg) => {
                    out.extend([ROW, small(*obligation)?, small(*leg)?]);
                }
                Failure::Obligation(obligation, directions) => {
                    out.extend([FAILS, small(*obligation)?, count(directions.len())?]);
                    directions.iter().try_for_each(|v| put(out, v))?;
                }
                Failure::Same { .. } | Failure::Singular(_) | Failure::Dependent => return None,
            },
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
