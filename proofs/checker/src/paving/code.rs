//! The bytes of a node: its steps, then its kind. Integers are little-endian.

use super::reader::bytes;
use super::Rejected;
use crate::cell::Axis;
use crate::certificate::{
    ConditioningEvidence, Direction, LegNumber, Step, TwoDirections, Violation,
};
use crate::claim::Sign;
use crate::rule::Rotation;
use std::io::Read;

/// A node: what is shown of its cell, and what becomes of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The steps that discharge obligations on the whole cell, of a node that is split or inner.
    pub steps: Vec<Step>,
    /// What it is.
    pub kind: Kind,
}

/// What a node is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Halved along this axis.
    Split(Axis),
    /// The claim holds at every point.
    Inner,
    /// The claim fails at every point, for every machine.
    Outer(Violation),
    /// Undecided.
    Boundary,
    /// Left out by symmetry.
    Mirrored,
}

const SPLIT: u8 = 0x00;
const INNER: u8 = 0x03;
const BOUNDARY: u8 = 0x04;
const MIRRORED: u8 = 0x05;
const LOWER_IDENTITY: u8 = 0x10;
const LOWER_SHORT: u8 = 0x11;
const LOWER_LONG: u8 = 0x12;
const UPPER: u8 = 0x13;
const RANGE: u8 = 0x14;
const SERIAL_MARGIN: u8 = 0x15;
const PARALLEL_MARGIN: u8 = 0x16;
const LEG_ANGLE: u8 = 0x17;
const SPEED: u8 = 0x18;
const CONDITIONING: u8 = 0x19;
const SIGMA_MIN_SHORT: u8 = 0x20;
const SIGMA_MIN_LONG: u8 = 0x21;
const SIGMA_MAX_SHORT: u8 = 0x22;
const SIGMA_MAX_LONG: u8 = 0x23;
const ILL_CONDITIONED: u8 = 0x24;
const NEAR_SINGULAR: u8 = 0x25;
/// With the next two: legs 1, 2, 3; so are those below.
const ROW: u8 = 0x30;
const REACH: u8 = 0x33;
const JOINT_RANGE: u8 = 0x36;
const OBLIQUE: u8 = 0x39;
const BEYOND_ANGLE: u8 = 0x3c;
const TOO_FAST: u8 = 0x3f;

impl Item {
    /// Reads an item, the node's number being `node`.
    pub fn read(input: &mut impl Read, node: u64) -> Result<Self, Rejected> {
        let mut steps = Vec::new();
        loop {
            let [code] = bytes(input, node)?;
            if let Some(kind) = read_kind(input, node, code)? {
                return Ok(Item { steps, kind });
            }
            // There are eight obligations, and none is discharged twice.
            if steps.len() == 8 {
                return Err(Rejected::BadCode(node, code));
            }
            steps.push(read_step(input, node, code)?);
        }
    }

    /// Appends the item's bytes; `None` if it has none (a step or violation that pavings do not
    /// know).
    pub fn write(&self, out: &mut Vec<u8>) -> Option<()> {
        self.steps.iter().try_for_each(|step| write_step(out, step))?;
        match &self.kind {
            Kind::Split(axis) => out.push(SPLIT + u8::try_from(axis.index()).ok()?),
            Kind::Inner => out.push(INNER),
            Kind::Boundary => out.push(BOUNDARY),
            Kind::Mirrored => out.push(MIRRORED),
            Kind::Outer(violation) => write_violation(out, violation)?,
        }
        Some(())
    }
}

fn read_kind(input: &mut impl Read, node: u64, code: u8) -> Result<Option<Kind>, Rejected> {
    let leg = |first: u8| LegNumber { leg: usize::from(code - first) + 1 };
    let outer = match code {
        SPLIT..INNER => return Ok(Some(Kind::Split(Axis::ALL[usize::from(code - SPLIT)]))),
        INNER => return Ok(Some(Kind::Inner)),
        BOUNDARY => return Ok(Some(Kind::Boundary)),
        MIRRORED => return Ok(Some(Kind::Mirrored)),
        SIGMA_MIN_SHORT => Violation::SigmaMin(Direction { vector: short(input, node)? }),
        SIGMA_MIN_LONG => Violation::SigmaMin(Direction { vector: long(input, node)? }),
        SIGMA_MAX_SHORT => Violation::SigmaMax(Direction { vector: short(input, node)? }),
        SIGMA_MAX_LONG => Violation::SigmaMax(Direction { vector: long(input, node)? }),
        ILL_CONDITIONED => {
            let (u, v) = (long(input, node)?, long(input, node)?);
            Violation::Conditioning(TwoDirections { u, v })
        }
        NEAR_SINGULAR => Violation::ParallelMargin,
        ROW..REACH => Violation::Row(leg(ROW)),
        REACH..JOINT_RANGE => Violation::Reach(leg(REACH)),
        JOINT_RANGE..OBLIQUE => Violation::JointRange(leg(JOINT_RANGE)),
        OBLIQUE..BEYOND_ANGLE => Violation::SerialMargin(leg(OBLIQUE)),
        BEYOND_ANGLE..TOO_FAST => Violation::LegAngle(leg(BEYOND_ANGLE)),
        TOO_FAST..=0x41 => Violation::JointSpeed(leg(TOO_FAST)),
        _ => return Ok(None),
    };
    Ok(Some(Kind::Outer(outer)))
}

fn read_step(input: &mut impl Read, node: u64, code: u8) -> Result<Step, Rejected> {
    Ok(match code {
        LOWER_IDENTITY => Step::Lower(Rotation::IDENTITY),
        LOWER_SHORT => {
            let sign = sign(input, node)?;
            let q: [u8; 4] = bytes(input, node)?;
            Step::Lower(Rotation { q: q.map(|x| i64::from(x.cast_signed())), sign })
        }
        LOWER_LONG => Step::Lower(rotation(input, node)?),
        UPPER => Step::Upper,
        RANGE => Step::Range,
        SERIAL_MARGIN => Step::SerialMargin,
        PARALLEL_MARGIN => Step::ParallelMargin,
        LEG_ANGLE => Step::LegAngle,
        SPEED => Step::Speed,
        CONDITIONING => {
            let rotation = rotation(input, node)?;
            Step::Conditioning(ConditioningEvidence { rotation, mu: long(input, node)? })
        }
        _ => return Err(Rejected::BadCode(node, code)),
    })
}

fn sign(input: &mut impl Read, node: u64) -> Result<Sign, Rejected> {
    match bytes(input, node)? {
        [0] => Ok(Sign::Plus),
        [1] => Ok(Sign::Minus),
        [other] => Err(Rejected::BadCode(node, other)),
    }
}

fn rotation(input: &mut impl Read, node: u64) -> Result<Rotation, Rejected> {
    let sign = sign(input, node)?;
    Ok(Rotation { q: long(input, node)?, sign })
}

/// Components of eight bits.
fn short(input: &mut impl Read, node: u64) -> Result<[i64; 3], Rejected> {
    let components: [u8; 3] = bytes(input, node)?;
    Ok(components.map(|x| i64::from(x.cast_signed())))
}

/// Components of 64 bits.
fn long<const N: usize>(input: &mut impl Read, node: u64) -> Result<[i64; N], Rejected> {
    let mut components = [0; N];
    for component in &mut components {
        *component = i64::from_le_bytes(bytes(input, node)?);
    }
    Ok(components)
}

fn put_long(out: &mut Vec<u8>, components: &[i64]) {
    components.iter().for_each(|x| out.extend(x.to_le_bytes()));
}

/// The components in eight bits each, if they fit.
fn eight_bits<const N: usize>(components: &[i64; N]) -> Option<[u8; N]> {
    let mut bytes = [0; N];
    for (byte, &x) in bytes.iter_mut().zip(components) {
        *byte = i8::try_from(x).ok()?.cast_unsigned();
    }
    Some(bytes)
}

fn put_sign(out: &mut Vec<u8>, sign: Sign) {
    out.push(u8::from(sign == Sign::Minus));
}

fn write_step(out: &mut Vec<u8>, step: &Step) -> Option<()> {
    match step {
        Step::Lower(rotation) if *rotation == Rotation::IDENTITY => out.push(LOWER_IDENTITY),
        Step::Lower(rotation) => match eight_bits(&rotation.q) {
            Some(q) => {
                out.push(LOWER_SHORT);
                put_sign(out, rotation.sign);
                out.extend(q);
            }
            None => {
                out.push(LOWER_LONG);
                put_sign(out, rotation.sign);
                put_long(out, &rotation.q);
            }
        },
        Step::Upper => out.push(UPPER),
        Step::Range => out.push(RANGE),
        Step::SerialMargin => out.push(SERIAL_MARGIN),
        Step::ParallelMargin => out.push(PARALLEL_MARGIN),
        Step::LegAngle => out.push(LEG_ANGLE),
        Step::Speed => out.push(SPEED),
        Step::Conditioning(evidence) => {
            out.push(CONDITIONING);
            put_sign(out, evidence.rotation.sign);
            put_long(out, &evidence.rotation.q);
            put_long(out, &evidence.mu);
        }
        _ => return None,
    }
    Some(())
}

fn write_violation(out: &mut Vec<u8>, violation: &Violation) -> Option<()> {
    let mut direction = |v: &[i64; 3], codes: [u8; 2]| match eight_bits(v) {
        Some(v) => {
            out.push(codes[0]);
            out.extend(v);
        }
        None => {
            out.push(codes[1]);
            put_long(out, v);
        }
    };
    let numbered = |first: u8, leg: &LegNumber| match leg.leg {
        1..=3 => Some(first + u8::try_from(leg.leg - 1).ok()?),
        _ => None,
    };
    let code = match violation {
        Violation::SigmaMin(v) => {
            direction(&v.vector, [SIGMA_MIN_SHORT, SIGMA_MIN_LONG]);
            return Some(());
        }
        Violation::SigmaMax(v) => {
            direction(&v.vector, [SIGMA_MAX_SHORT, SIGMA_MAX_LONG]);
            return Some(());
        }
        Violation::Conditioning(both) => {
            out.push(ILL_CONDITIONED);
            put_long(out, &both.u);
            put_long(out, &both.v);
            return Some(());
        }
        Violation::ParallelMargin => NEAR_SINGULAR,
        Violation::Row(leg) => numbered(ROW, leg)?,
        Violation::Reach(leg) => numbered(REACH, leg)?,
        Violation::JointRange(leg) => numbered(JOINT_RANGE, leg)?,
        Violation::SerialMargin(leg) => numbered(OBLIQUE, leg)?,
        Violation::LegAngle(leg) => numbered(BEYOND_ANGLE, leg)?,
        Violation::JointSpeed(leg) => numbered(TOO_FAST, leg)?,
        Violation::Singular(_) => return None,
    };
    out.push(code);
    Some(())
}
