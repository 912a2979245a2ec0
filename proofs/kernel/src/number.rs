//! Numbers of a claim: expressions that denote one real number exactly.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = factor { ("*" | "/") factor }
//! factor  = "-" factor | power
//! power   = atom [ "^" digits ]
//! atom    = digits [ "." digits ] | name | "sqrt" "(" sum ")" | "(" sum ")"
//! name    = letter { letter | digit | "_" }
//! ```
//!
//! with the usual meaning, operators of one level from left to right. Each expression has one text:
//! no blanks, no parentheses that are not needed, no zeros that are not needed in a literal. A text
//! that is not what its expression prints is refused.

use crate::arithmetic::{Arithmetic, Enclosure};
use crate::fixed::{Fixed, Interval};
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Most bytes of an expression.
pub const MOST_BYTES: usize = 8192;
/// Most parentheses, roots and signs that are open at once while it is read.
pub const MOST_DEPTH: usize = 64;
/// Most operations.
pub const MOST_OPERATIONS: usize = 512;
/// Most bits of a number on the way.
pub const MOST_BITS: u64 = 1 << 13;
/// Most bits of a fraction that is compared exactly: its gcd costs their square.
pub const MOST_EXACT: u64 = 1 << 12;
/// Greatest exponent.
pub const MOST_POWER: u32 = 64;
/// Most bytes of a name.
pub const MOST_NAME: usize = 32;

/// An expression.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum Expression {
    /// `digits / 10^places`; `digits` is no multiple of ten where `places > 0`.
    Literal {
        /// The digits.
        digits: BigInt,
        /// How many of them are decimals.
        places: u32,
    },
    /// What the context says.
    Name(String),
    /// A name that stands for every number of a range; read from no text.
    Varying(Box<Range>),
    /// `-a`.
    Neg(Arc<Expression>),
    /// `a + b`, `a - b`, `a b`, `a / b`.
    Binary(Operator, Arc<Expression>, Arc<Expression>),
    /// `a^n`, `n >= 2`.
    Power(Arc<Expression>, u32),
    /// `sqrt(a)`.
    Sqrt(Arc<Expression>),
}

/// A name, and the values that it stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Range {
    /// Which of the parameters it is, counted from zero.
    pub parameter: usize,
    /// Its name.
    pub name: String,
    /// From the one to the other.
    pub ends: [BigRational; 2],
}

impl Range {
    /// Its centre `c`, itself, and its half-width `h`, each rounded outward to `bits` fractional bits.
    ///
    /// A value is `c + lambda h` with the exact `c` and `h`: its `lambda` is the same with any number of
    /// bits. Were `c` and `h` the rounded ones, slopes of inputs with different units would be of
    /// different `lambda`.
    pub(crate) fn edge(&self, bits: u32) -> [Interval<BigInt>; 3] {
        let [least, greatest] = &self.ends;
        // Over twice the common denominator.
        let whole = (least.denom() * greatest.denom()) << 1u32;
        let lo = least.numer() * greatest.denom();
        let hi = greatest.numer() * least.denom();
        let (centre, half) = (&lo + &hi, &hi - &lo);
        [[&centre, &centre], [&(&lo << 1u32), &(&hi << 1u32)], [&half, &half]].map(|[lo, hi]| {
            let lo = (lo << bits).div_floor(&whole);
            Interval { lo, hi: -(-hi << bits).div_floor(&whole) }
        })
    }
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
}

impl Operator {
    /// The operation, in an arithmetic.
    pub fn of<A: Arithmetic>(self, e: &A, a: &A::Number, b: &A::Number) -> Option<A::Number> {
        match self {
            Operator::Add => e.add(a, b),
            Operator::Sub => e.sub(a, b),
            Operator::Mul => e.mul(a, b),
            Operator::Div => e.div(a, b),
        }
    }

    const ALL: [Operator; 4] = [Operator::Add, Operator::Sub, Operator::Mul, Operator::Div];

    fn strength(self) -> u8 {
        match self {
            Operator::Add | Operator::Sub => 1,
            Operator::Mul | Operator::Div => 2,
        }
    }

    fn symbol(self) -> u8 {
        match self {
            Operator::Add => b'+',
            Operator::Sub => b'-',
            Operator::Mul => b'*',
            Operator::Div => b'/',
        }
    }
}

/// Why a text is no number.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("at byte {at} of a number: expected {expected}")]
pub struct NumberError {
    /// The byte at which it goes wrong.
    pub at: usize,
    /// What was expected there.
    pub expected: &'static str,
}

/// The text being read.
struct Reader<'a> {
    text: &'a [u8],
    at: usize,
    depth: usize,
    operations: usize,
}

type Read = Result<Expression, NumberError>;

impl Reader<'_> {
    fn error<T>(&self, expected: &'static str) -> Result<T, NumberError> {
        Err(NumberError { at: self.at, expected })
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    /// The bytes from here on that `are` so.
    fn span(&mut self, are: impl Fn(&u8) -> bool) -> &[u8] {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest.iter().take_while(|byte| are(byte)).count();
        self.at += length;
        &rest[..length]
    }

    /// Operators of this strength, from left to right.
    fn chain(&mut self, strength: u8) -> Read {
        if strength > 2 {
            return self.factor();
        }
        let mut left = self.chain(strength + 1)?;
        loop {
            let here = |operator: &Operator| {
                operator.strength() == strength && self.peek() == Some(operator.symbol())
            };
            let Some(operator) = Operator::ALL.into_iter().find(here) else {
                return Ok(left);
            };
            self.at += 1;
            self.operations += 1;
            if self.operations > MOST_OPERATIONS {
                return self.error("fewer operations");
            }
            let right = self.chain(strength + 1)?;
            left = Expression::Binary(operator, left.into(), right.into());
        }
    }

    fn deeper(&mut self, read: impl Fn(&mut Self) -> Read) -> Read {
        if self.depth == MOST_DEPTH {
            return self.error("fewer nested parentheses, roots and signs");
        }
        self.depth += 1;
        let inner = read(self);
        self.depth -= 1;
        inner
    }

    fn factor(&mut self) -> Read {
        if self.take(b'-') {
            return Ok(Expression::Neg(self.deeper(Self::factor)?.into()));
        }
        let atom = self.atom()?;
        if !self.take(b'^') {
            return Ok(atom);
        }
        let digits = std::str::from_utf8(self.span(u8::is_ascii_digit)).unwrap_or_default();
        match digits.parse::<u32>() {
            Ok(n) if (2..=MOST_POWER).contains(&n) => Ok(Expression::Power(atom.into(), n)),
            _ => self.error("an exponent from 2 to 64"),
        }
    }

    fn atom(&mut self) -> Read {
        match self.peek() {
            Some(b'(') => self.parenthesised(),
            Some(byte) if byte.is_ascii_digit() => self.literal(),
            Some(byte) if byte.is_ascii_alphabetic() => {
                let name = self.span(|b| b.is_ascii_alphanumeric() || *b == b'_').to_vec();
                let name = String::from_utf8(name).unwrap_or_default();
                match name.as_str() {
                    "sqrt" => Ok(Expression::Sqrt(self.parenthesised()?.into())),
                    _ if name.len() <= MOST_NAME => Ok(Expression::Name(name)),
                    _ => self.error("a shorter name"),
                }
            }
            _ => self.error("a number, a name, sqrt(...) or (...)"),
        }
    }

    fn parenthesised(&mut self) -> Read {
        if !self.take(b'(') {
            return self.error("(");
        }
        let inner = self.deeper(|reader| reader.chain(1))?;
        if self.take(b')') {
            Ok(inner)
        } else {
            self.error(")")
        }
    }

    fn literal(&mut self) -> Read {
        let mut digits = self.span(u8::is_ascii_digit).to_vec();
        let mut places = 0;
        if self.take(b'.') {
            let decimals = self.span(u8::is_ascii_digit);
            places = decimals.len() as u32;
            digits.extend_from_slice(decimals);
        }
        match BigInt::parse_bytes(&digits, 10) {
            Some(digits) => Ok(Expression::Literal { digits, places }),
            None => self.error("digits"),
        }
    }
}

impl TryFrom<String> for Expression {
    type Error = NumberError;

    /// The expression that prints this very text.
    fn try_from(text: String) -> Read {
        let mut reader = Reader { text: text.as_bytes(), at: 0, depth: 0, operations: 0 };
        if text.len() > MOST_BYTES {
            return reader.error("at most 8192 bytes");
        }
        let expression = reader.chain(1)?;
        if reader.at < text.len() {
            return reader.error("an operator");
        }
        if expression.to_string() != text {
            return reader.error("the canonical text of the same number");
        }
        Ok(expression)
    }
}

impl From<Expression> for String {
    fn from(expression: Expression) -> String {
        expression.to_string()
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// `inner`, in parentheses unless its strength is enough.
        fn part(f: &mut fmt::Formatter<'_>, inner: &Expression, enough: u8) -> fmt::Result {
            if inner.strength() >= enough {
                write!(f, "{inner}")
            } else {
                write!(f, "({inner})")
            }
        }
        match self {
            Expression::Literal { digits, places: 0 } => write!(f, "{digits}"),
            Expression::Literal { digits, places } => {
                let (whole, decimals) = digits.div_rem(&BigInt::from(10).pow(*places));
                let text = format!("{decimals:0>width$}", width = *places as usize);
                let text = text.trim_end_matches('0');
                let point = if text.is_empty() { "" } else { "." };
                write!(f, "{whole}{point}{text}")
            }
            Expression::Name(name) => f.write_str(name),
            Expression::Varying(range) => write!(f, "<{}>", range.name),
            Expression::Neg(inner) => {
                f.write_str("-")?;
                part(f, inner, 3)
            }
            Expression::Binary(operator, left, right) => {
                part(f, left, operator.strength())?;
                write!(f, "{}", char::from(operator.symbol()))?;
                part(f, right, operator.strength() + 1)
            }
            Expression::Power(base, n) => {
                part(f, base, 5)?;
                write!(f, "^{n}")
            }
            Expression::Sqrt(inner) => write!(f, "sqrt({inner})"),
        }
    }
}

/// `a + b` and the like.
macro_rules! operators {
    ($($operator:ident $method:ident),*) => { $(
        impl std::ops::$operator for &Expression {
            type Output = Expression;

            fn $method(self, other: Self) -> Expression {
                Expression::Binary(Operator::$operator, self.clone().into(), other.clone().into())
            }
        }
    )* };
}
operators!(Add add, Sub sub, Mul mul, Div div);

/// Whether the ends of an interval have few digits.
fn is_moderate(x: &Interval<BigInt>) -> bool {
    x.lo.bits().max(x.hi.bits()) <= MOST_BITS
}

impl Expression {
    /// The integer `n`.
    pub fn integer(n: i64) -> Self {
        let literal = Expression::Literal { digits: n.unsigned_abs().into(), places: 0 };
        if n < 0 {
            Expression::Neg(literal.into())
        } else {
            literal
        }
    }

    /// Whether a text is a name.
    pub fn is_name(text: &str) -> bool {
        matches!(Expression::try_from(text.to_owned()), Ok(Expression::Name(_)))
    }

    fn strength(&self) -> u8 {
        match self {
            Expression::Binary(operator, _, _) => operator.strength(),
            Expression::Neg(_) => 3,
            Expression::Power(_, _) => 4,
            Expression::Literal { .. }
            | Expression::Name(_)
            | Expression::Varying(_)
            | Expression::Sqrt(_) => 5,
        }
    }

    /// Encloses the number with `bits` fractional bits; `None` where an operation is undefined, or it has a name.
    /// A root of an interval that reaches below zero is that of its part from zero on, provided that
    /// is not empty: a number of a claim may be zero. Not so of names that stand for many numbers, some
    /// of which may have no root.
    pub fn enclose(&self, bits: u32) -> Option<Interval<BigInt>> {
        self.enclose_once(&Fixed::new(bits), &mut HashMap::new())
    }

    /// The same; parts that several have are enclosed once.
    fn enclose_once<'a>(
        &'a self,
        arithmetic: &Fixed<BigInt>,
        known: &mut HashMap<*const Expression, Option<Interval<BigInt>>>,
    ) -> Option<Interval<BigInt>> {
        let mut of = |inner: &'a Arc<Expression>| {
            if let Some(known) = known.get(&Arc::as_ptr(inner)) {
                return known.clone();
            }
            let value = inner.enclose_once(arithmetic, known).filter(is_moderate);
            if Arc::strong_count(inner) > 1 {
                known.insert(Arc::as_ptr(inner), value.clone());
            }
            value
        };
        match self {
            Expression::Literal { digits, places } => {
                let ten = BigInt::from(10).pow(*places);
                let (lo, rest) = (digits << arithmetic.bits()).div_mod_floor(&ten);
                let hi = if rest.is_zero() { lo.clone() } else { &lo + 1 };
                Some(Interval { lo, hi })
            }
            Expression::Name(_) => None,
            Expression::Varying(range) => {
                let [_, range, _] = range.edge(arithmetic.bits());
                Some(range)
            }
            Expression::Neg(inner) => arithmetic.neg(&of(inner)?),
            Expression::Binary(operator, left, right) => {
                operator.of(arithmetic, &of(left)?, &of(right)?)
            }
            Expression::Power(base, n) => {
                let base = of(base)?;
                let mut power = base.clone();
                for bit in (0..n.checked_ilog2()?).rev() {
                    power = arithmetic.sqr(&power).filter(is_moderate)?;
                    if n >> bit & 1 == 1 {
                        power = arithmetic.mul(&power, &base).filter(is_moderate)?;
                    }
                }
                Some(power)
            }
            Expression::Sqrt(inner) => {
                let radicand = of(inner)?;
                if arithmetic.is_positive(&radicand) {
                    return arithmetic.sqrt(&radicand);
                }
                // Dear to ask whether it is negative, and never so of what is enclosed by positive numbers.
                let is_none = radicand.lo.is_negative() && inner.varies()
                    || inner.rational().is_some_and(|x| x.is_negative())
                    || radicand.hi.is_negative();
                let hi = match radicand.hi.is_zero() {
                    _ if is_none => return None,
                    true => BigInt::zero(),
                    false => arithmetic.sqrt(&Interval::point(radicand.hi))?.hi,
                };
                Some(Interval { lo: BigInt::zero(), hi })
            }
        }
    }

    /// The number, if it is rational by its shape, and of moderate size.
    pub fn rational(&self) -> Option<BigRational> {
        let value = match self {
            Expression::Literal { digits, places } => {
                BigRational::new(digits.clone(), BigInt::from(10).pow(*places))
            }
            Expression::Neg(inner) => -inner.rational()?,
            Expression::Binary(operator, left, right) => {
                let (left, right) = (left.rational()?, right.rational()?);
                match operator {
                    Operator::Add => left + right,
                    Operator::Sub => left - right,
                    Operator::Mul => left * right,
                    Operator::Div if right.is_zero() => return None,
                    Operator::Div => left / right,
                }
            }
            Expression::Power(base, n) => {
                let base = base.rational()?;
                let bits = base.numer().bits().max(base.denom().bits());
                if bits * u64::from(*n) > MOST_EXACT {
                    return None;
                }
                num_traits::pow(base, *n as usize)
            }
            Expression::Name(_) | Expression::Varying(_) | Expression::Sqrt(_) => return None,
        };
        (value.numer().bits().max(value.denom().bits()) <= MOST_EXACT).then_some(value)
    }

    /// The expressions that it is made of.
    pub fn parts(&self) -> impl Iterator<Item = &Expression> {
        let [left, right] = match self {
            Expression::Literal { .. } | Expression::Name(_) | Expression::Varying(_) => [None; 2],
            Expression::Neg(inner) | Expression::Power(inner, _) | Expression::Sqrt(inner) => {
                [Some(inner), None]
            }
            Expression::Binary(_, left, right) => [Some(left), Some(right)],
        };
        left.into_iter().chain(right).map(|part| &**part)
    }

    /// Whether it has names that stand for ranges.
    pub fn varies(&self) -> bool {
        matches!(self, Expression::Varying(_)) || self.parts().any(Expression::varies)
    }
}
