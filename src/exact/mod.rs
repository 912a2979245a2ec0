//! Exact real numbers as they are written: decimals, fractions, and expressions with square roots.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = "-" unary | literal | "(" sum ")" | "sqrt" "(" sum ")"
//! literal = digits [ "." digits ] [ ("e" | "E") [ "+" | "-" ] digits ]
//! ```
//!
//! In the design of an atlas, which is no certificate, a `unary` may also be a name, of a parameter:
//! `letter { letter | digit | "_" }`, small letters only. An expression with names is *open*
//! ([`Exact::is_open`]): it has no sign, order or enclosure, so that nothing is proved of it.
//!
//! Rational parts are folded, so `0.5 + 1/3` is the rational `5/6`; square roots of squares are
//! rational; `-(-x)` is `x`. What remains is a tree whose value is enclosed by [`Exact::enclose`].
//! [`Exact`]'s text form parses back to the same tree. Every divisor is proved non-zero and every radicand non-negative when a tree is built.
//!
//! The work that a text asks for is bounded by construction: folding makes at most [`MAX_FOLDED`]
//! binary digits, roots are at most [`MAX_ROOTS`], each operand is enclosed at most once at each of
//! three precisions, and clones share its enclosures.

pub mod arithmetic;
pub mod decimal;
pub mod monomial;
mod operand;
mod read;

use num_bigint::BigInt;
use num_integer::Integer as _;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use orthocert_kernel::arithmetic::Arithmetic as _;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::number::Expression;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

pub use operand::Operand;

/// Most bytes of one number's text.
pub const MAX_TEXT: usize = 8192;
/// Most literals of one number's text.
pub const MAX_LITERALS: usize = 256;
/// Most nested parentheses, roots and signs of one number's text.
pub const MAX_NESTING: usize = 64;
/// Most digits of one literal of a canonical text (a decimal of 1,000 digits times `10^-1000`
/// makes a denominator of up to 2,000 digits).
pub const MAX_DIGITS: usize = 2100;
/// Most bytes of a name.
pub const MAX_NAME: usize = 32;
/// Largest exponent of ten of a literal, either way.
pub const MAX_EXPONENT: i64 = 1000;
/// Most square roots of one number's text.
pub const MAX_ROOTS: usize = 16;
/// Most bits of a numerator or denominator of a folded rational: 2,466 digits.
const MAX_RATIONAL_BITS: u64 = 1 << 13;
/// Most bits of all numerators and denominators together that reading one text makes.
pub const MAX_FOLDED: u64 = 1 << 15;
/// Fractional bits in which irrational numbers are enclosed: those tried before a sign is given up
/// as undecidable.
const PRECISIONS: [u32; 4] = [128, 512, 2048, 8192];

/// An exact real number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exact {
    /// A rational number in lowest terms.
    Rational(BigRational),
    /// `-x`, `x` neither rational nor of this form.
    Neg(Operand),
    /// `x + y`, not both rational.
    Add(Operand, Operand),
    /// `x - y`, not both rational.
    Sub(Operand, Operand),
    /// `x y`, not both rational.
    Mul(Operand, Operand),
    /// `x / y`, not both rational, `y != 0`.
    Div(Operand, Operand),
    /// `sqrt(x)`, `x >= 0` and not the square of a rational number.
    Sqrt(Operand),
    /// A parameter of an atlas.
    Name(Box<str>),
}

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Exact::parse_canonical(&text).map_err(D::Error::custom)
    }
}

/// Why a text is not a number; `at` is a byte offset into the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberError {
    /// Byte offset of the defect.
    pub at: usize,
    /// What is wrong there.
    pub kind: NumberErrorKind,
}

/// The ways in which a text can fail to be a number.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NumberErrorKind {
    /// Something else was expected.
    Expected(&'static str),
    /// The text goes on after the number.
    TrailingText,
    /// A literal of more digits than the limit.
    TooManyDigits(usize),
    /// An exponent of ten beyond the limit.
    ExponentTooLarge,
    /// The text, its nesting or a folded value is too large.
    TooLarge,
    /// More square roots than [`MAX_ROOTS`].
    TooManyRoots,
    /// A divisor that is zero, or not provably different from zero.
    DivisorMayBeZero,
    /// The square root of a number that is negative, or not provably non-negative.
    RadicandMayBeNegative,
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let column = self.at + 1;
        match &self.kind {
            NumberErrorKind::Expected(what) => write!(f, "expected {what} at character {column}"),
            NumberErrorKind::TrailingText => write!(f, "unexpected text at character {column}"),
            NumberErrorKind::TooManyDigits(limit) => {
                write!(f, "more than {limit} digits at character {column}")
            }
            NumberErrorKind::ExponentTooLarge => {
                write!(f, "exponent beyond ±{MAX_EXPONENT} at character {column}")
            }
            NumberErrorKind::TooLarge => write!(f, "number too large at character {column}"),
            NumberErrorKind::TooManyRoots => {
                write!(f, "more than {MAX_ROOTS} square roots at character {column}")
            }
            NumberErrorKind::DivisorMayBeZero => {
                write!(f, "division by something that is or may be zero at character {column}")
            }
            NumberErrorKind::RadicandMayBeNegative => write!(
                f,
                "square root of something that is or may be negative at character {column}"
            ),
        }
    }
}

impl std::error::Error for NumberError {}

impl Exact {
    /// The integer `n`.
    pub fn integer(n: i64) -> Self {
        Exact::Rational(BigRational::from_integer(n.into()))
    }

    /// A number of a claim; none that is larger than is admissible there.
    pub fn of(x: &Expression) -> Option<Self> {
        Exact::parse(&x.to_string(), MAX_DIGITS).ok()
    }

    /// Parses an expression; literals have at most `max_digits` digits.
    pub fn parse(text: &str, max_digits: usize) -> Result<Self, NumberError> {
        read::expression(text, max_digits, false)
    }

    /// Parses an expression that may have names.
    pub fn parse_open(text: &str, max_digits: usize) -> Result<Self, NumberError> {
        read::expression(text, max_digits, true)
    }

    /// Parses a canonical text: exactly what [`Exact`] prints.
    pub fn parse_canonical(text: &str) -> Result<Self, NumberError> {
        let value = Exact::parse(text, MAX_DIGITS)?;
        if value.to_string() != text {
            return Err(NumberError { at: 0, kind: NumberErrorKind::Expected("canonical form") });
        }
        Ok(value)
    }

    /// The rational value, if the number was folded to one.
    pub fn as_rational(&self) -> Option<&BigRational> {
        match self {
            Exact::Rational(x) => Some(x),
            _ => None,
        }
    }

    /// Whether the expression has a name, so that it is not a number.
    pub fn is_open(&self) -> bool {
        match self {
            Exact::Rational(_) => false,
            Exact::Name(_) => true,
            Exact::Neg(x) | Exact::Sqrt(x) => x.has_name(),
            Exact::Add(x, y) | Exact::Sub(x, y) | Exact::Mul(x, y) | Exact::Div(x, y) => {
                x.has_name() || y.has_name()
            }
        }
    }

    /// An enclosure with `bits` fractional bits; the tightest one for rationals. `None` where 8,192
    /// bits do not suffice to divide or take a root, or for what is asked for, and for what is open.
    pub fn enclose(&self, bits: u32) -> Option<Interval<BigInt>> {
        if let Exact::Rational(x) = self {
            return Some(rational(x, bits));
        }
        // 64 guard bits.
        let needed = bits.checked_add(64)?;
        let level = PRECISIONS.iter().position(|&bits| bits >= needed)?;
        let x = self.enclosure(level)?;
        let beyond = PRECISIONS[level] - bits;
        // A shift of a big integer rounds down, so that of its negative rounds up.
        Some(Interval { lo: x.lo >> beyond, hi: -(-x.hi >> beyond) })
    }

    /// The ends of an enclosure with `bits` fractional bits; of a rational number, itself.
    pub fn ends(&self, bits: u32) -> Option<[BigRational; 2]> {
        if let Exact::Rational(x) = self {
            return Some([x.clone(), x.clone()]);
        }
        let Interval { lo, hi } = self.enclose(bits)?;
        Some([lo, hi].map(|x| BigRational::new(x, BigInt::one() << bits)))
    }

    /// The lower of [`Exact::ends`].
    pub fn below(&self, bits: u32) -> Option<BigRational> {
        let [least, _] = self.ends(bits)?;
        Some(least)
    }

    /// An enclosure with `PRECISIONS[level]` fractional bits.
    fn enclosure(&self, level: usize) -> Option<Interval<BigInt>> {
        let bits = *PRECISIONS.get(level)?;
        let e = Fixed::<BigInt>::new(bits);
        match self {
            Exact::Rational(x) => Some(rational(x, bits)),
            Exact::Neg(x) => e.neg(x.enclosure(level)?),
            Exact::Add(x, y) => e.add(x.enclosure(level)?, y.enclosure(level)?),
            Exact::Sub(x, y) => e.sub(x.enclosure(level)?, y.enclosure(level)?),
            Exact::Mul(x, y) => e.mul(x.enclosure(level)?, y.enclosure(level)?),
            Exact::Div(x, y) => e.div(x.enclosure(level)?, y.enclosure(level)?),
            Exact::Sqrt(x) => e.sqrt(x.enclosure(level)?),
            Exact::Name(_) => None,
        }
    }

    /// The sign (-1, 0, 1), or `None` where no precision tried decides it. Zero is recognised for
    /// rationals only.
    pub fn sign(&self) -> Option<i32> {
        if let Exact::Rational(x) = self {
            return Some(if x.is_zero() {
                0
            } else if x.is_positive() {
                1
            } else {
                -1
            });
        }
        (0..PRECISIONS.len()).find_map(|level| sign_of_all(&self.enclosure(level)?))
    }

    /// The order of two numbers, or `None` where no precision tried decides it. Equality is
    /// recognised for rationals and for identical trees.
    pub fn compare(&self, other: &Exact) -> Option<std::cmp::Ordering> {
        if self == other {
            return Some(std::cmp::Ordering::Equal);
        }
        if let (Exact::Rational(x), Exact::Rational(y)) = (self, other) {
            // Denominators are positive.
            return Some((x.numer() * y.denom()).cmp(&(y.numer() * x.denom())));
        }
        let difference = self.clone().minus(other.clone()).ok()?;
        difference.sign().map(|sign| sign.cmp(&0))
    }

    /// `-self`.
    pub fn negated(self) -> Self {
        match self {
            Exact::Rational(x) => Exact::Rational(-x),
            Exact::Neg(x) => Exact::clone(&x),
            x => Exact::Neg(Operand::new(x)),
        }
    }

    /// `self + other`.
    pub fn plus(self, other: Exact) -> Result<Self, NumberErrorKind> {
        fold(self, other, |x, y| x + y, Exact::Add)
    }

    /// `self - other`.
    pub fn minus(self, other: Exact) -> Result<Self, NumberErrorKind> {
        fold(self, other, |x, y| x - y, Exact::Sub)
    }

    /// `self * other`.
    pub fn times(self, other: Exact) -> Result<Self, NumberErrorKind> {
        fold(self, other, |x, y| x * y, Exact::Mul)
    }

    /// `self / other`; refused unless `other` is open or provably not zero.
    pub fn over(self, other: Exact) -> Result<Self, NumberErrorKind> {
        match other.sign() {
            None if other.is_open() => fold(self, other, |x, y| x / y, Exact::Div),
            None | Some(0) => Err(NumberErrorKind::DivisorMayBeZero),
            Some(_) => fold(self, other, |x, y| x / y, Exact::Div),
        }
    }

    /// `sqrt(self)`; refused unless `self` is open or provably not negative.
    pub fn root(self) -> Result<Self, NumberErrorKind> {
        match self.sign() {
            None if self.is_open() => {}
            None | Some(-1) => return Err(NumberErrorKind::RadicandMayBeNegative),
            Some(_) => {}
        }
        if let Exact::Rational(x) = &self {
            // In lowest terms p/q is a square exactly if p and q are.
            let (p, q) = (x.numer().sqrt(), x.denom().sqrt());
            if &(&p * &p) == x.numer() && &(&q * &q) == x.denom() {
                return Ok(Exact::Rational(BigRational::new(p, q)));
            }
        }
        Ok(Exact::Sqrt(Operand::new(self)))
    }

    /// How tightly the printed form binds: 1 sum, 2 product or fraction, 3 sign, 4 atom.
    fn precedence(&self) -> u8 {
        match self {
            Exact::Rational(x) if !x.denom().is_one() => 2,
            Exact::Rational(x) if x.is_negative() => 3,
            Exact::Rational(_) | Exact::Sqrt(_) | Exact::Name(_) => 4,
            Exact::Add(..) | Exact::Sub(..) => 1,
            Exact::Mul(..) | Exact::Div(..) => 2,
            Exact::Neg(_) => 3,
        }
    }
}

/// The tightest enclosure of a rational number.
fn rational(x: &BigRational, bits: u32) -> Interval<BigInt> {
    let (lo, rest) = (x.numer() << bits).div_mod_floor(x.denom());
    let hi = if rest.is_zero() { lo.clone() } else { &lo + 1 };
    Interval { lo, hi }
}

/// The sign that all values of an enclosure have, if none is zero.
fn sign_of_all(x: &Interval<BigInt>) -> Option<i32> {
    if x.lo.is_positive() {
        Some(1)
    } else if x.hi.is_negative() {
        Some(-1)
    } else {
        None
    }
}

fn fold(
    x: Exact,
    y: Exact,
    rational: impl Fn(&BigRational, &BigRational) -> BigRational,
    tree: impl Fn(Operand, Operand) -> Exact,
) -> Result<Exact, NumberErrorKind> {
    match (x, y) {
        (Exact::Rational(x), Exact::Rational(y)) => {
            let value = rational(&x, &y);
            if value.numer().bits().max(value.denom().bits()) > MAX_RATIONAL_BITS {
                return Err(NumberErrorKind::TooLarge);
            }
            Ok(Exact::Rational(value))
        }
        (x, y) => Ok(tree(Operand::new(x), Operand::new(y))),
    }
}

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // An operand that binds less tightly than `least` needs parentheses.
        fn operand(f: &mut fmt::Formatter<'_>, x: &Exact, least: u8) -> fmt::Result {
            if x.precedence() < least {
                write!(f, "({x})")
            } else {
                write!(f, "{x}")
            }
        }
        let (x, sign, y, left, right) = match self {
            Exact::Rational(x) => return write!(f, "{x}"),
            Exact::Sqrt(x) => return write!(f, "sqrt({})", **x),
            Exact::Name(name) => return f.write_str(name),
            Exact::Neg(x) => {
                f.write_str("-")?;
                return operand(f, x, 3);
            }
            Exact::Add(x, y) => (x, "+", y, 1, 2),
            Exact::Sub(x, y) => (x, "-", y, 1, 2),
            Exact::Mul(x, y) => (x, "*", y, 2, 3),
            Exact::Div(x, y) => (x, "/", y, 2, 3),
        };
        operand(f, x, left)?;
        f.write_str(sign)?;
        operand(f, y, right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enclosures_contain_the_value_and_shrink_with_precision() {
        let root = Exact::parse("sqrt(2)", 1000).unwrap();
        for bits in [8u32, 64, 200] {
            let x = root.enclose(bits).unwrap();
            let (low, high) = (&x.lo * &x.lo, &x.hi * &x.hi);
            let two = BigInt::from(2) << (2 * bits);
            assert!(low <= two && two <= high);
            assert!(x.hi - x.lo <= BigInt::from(1));
        }
    }
}
