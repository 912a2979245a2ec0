//! Formulas as people write them, read into the kernel's expressions.
//!
//! The grammar is the kernel's ([`orthocert_kernel::number`]), with blanks anywhere between symbols,
//! parentheses that are not needed, the exponent 1, and decimals with a power of ten, `1e-3`. What
//! depends on no coordinate is enclosed on the way, for every value of the parameters: divisors that
//! may be zero and radicands that may be negative are refused where they stand. Of what depends on
//! coordinates the claim demands that it is defined, which is for the proof.

use super::error::Defect;
use super::exactly::written;
use super::names::put_in;
use super::suggestion;
use crate::exact::Exact;
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::number::{
    Expression, Operator, MOST_BITS, MOST_BYTES, MOST_DEPTH, MOST_NAME, MOST_OPERATIONS, MOST_POWER,
};
use std::collections::BTreeSet;
use std::ops::Range;

/// Fractional bits in which what depends on no coordinate is enclosed.
const BITS: u32 = 512;
/// Most digits of a number, and of its decimals.
const MOST_DIGITS: usize = 1000;

const OPERAND: &str = "a number, a name, sqrt(...) or (...)";
const EXPONENT: &str = "a whole exponent from 1 to 64, in digits";

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Meaning {
    /// A coordinate, or what depends on one.
    Varying,
    /// A number, enclosed for every value of the parameters.
    Constant(Interval<BigInt>),
}

/// What names stand for, and which of them were used.
#[derive(Debug, Default)]
pub(super) struct Known {
    pub names: Vec<(String, Meaning)>,
    /// Names that are given further down.
    pub later: Vec<String>,
    pub used: BTreeSet<String>,
}

/// A formula, and what it comes to.
pub(super) struct Formula {
    pub expression: Expression,
    pub meaning: Meaning,
}

/// Why a text is no formula.
#[derive(Debug)]
pub(super) struct FormulaError {
    /// The bytes of the text that are at fault.
    pub at: Range<usize>,
    pub defect: Defect,
    pub found: String,
    pub accepted: String,
}

type Read = Result<Formula, FormulaError>;

/// Reads a formula.
pub(super) fn formula(text: &str, known: &mut Known) -> Read {
    let mut reader = Reader { text, at: 0, depth: 0, operations: 0, known };
    if text.len() > MOST_BYTES {
        return reader.refuse(0..text.len(), "a formula too long", "at most 8,192 bytes");
    }
    let formula = reader.sum()?;
    reader.blanks();
    if reader.at < text.len() {
        let accepted = "an operator: +, -, *, /, ^";
        return Err(reader.unexpected(accepted));
    }
    let written = formula.expression.to_string();
    if Expression::try_from(written).as_ref() != Ok(&formula.expression) {
        return reader.refuse(0..text.len(), "a formula too long", "fewer and shorter numbers");
    }
    Ok(formula)
}

/// The interval of the numbers between `min` and `max`, at values of their names.
pub(super) fn enclosed(
    min: &Expression,
    max: &Expression,
    values: &[(String, Exact)],
) -> Option<Interval<BigInt>> {
    let values: Vec<(&str, Expression)> =
        values.iter().filter_map(|(name, x)| Some((name.as_str(), written(x)?))).collect();
    let end = |x: &Expression| {
        let mut x = x.clone();
        put_in(&mut x, &values);
        x.enclose(BITS)
    };
    Some(Interval { lo: end(min)?.lo, hi: end(max)?.hi })
}

struct Reader<'a, 'k> {
    text: &'a str,
    at: usize,
    depth: usize,
    operations: usize,
    known: &'k mut Known,
}

impl Reader<'_, '_> {
    fn refuse<T>(
        &self,
        at: Range<usize>,
        found: impl Into<String>,
        accepted: impl Into<String>,
    ) -> Result<T, FormulaError> {
        let (found, accepted) = (found.into(), accepted.into());
        Err(FormulaError { at, defect: Defect::NotANumber, found, accepted })
    }

    /// The error that something else was expected here.
    fn unexpected(&self, accepted: &str) -> FormulaError {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let word = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        let length = word.max(rest.chars().next().map_or(0, char::len_utf8));
        let (found, defect) = match rest.get(..length).unwrap_or_default() {
            "" => ("the end of the formula".to_owned(), Defect::NotANumber),
            "±" => ("a tolerance in a formula".to_owned(), Defect::Tolerance),
            text => (format!("{text} in a formula"), Defect::NotANumber),
        };
        let accepted = match defect {
            Defect::Tolerance => "the name of a parameter: those may carry tolerances",
            _ => accepted,
        };
        FormulaError { at: self.at..self.at + length, defect, found, accepted: accepted.to_owned() }
    }

    fn blanks(&mut self) {
        self.at += self.span(|c| c.is_ascii_whitespace()).len();
    }

    /// What is here of characters that `are` so.
    fn span(&self, are: impl Fn(char) -> bool) -> &str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        rest.get(..rest.find(|c| !are(c)).unwrap_or(rest.len())).unwrap_or_default()
    }

    fn take(&mut self, symbol: char) -> bool {
        self.blanks();
        let found = self.text.get(self.at..).is_some_and(|rest| rest.starts_with(symbol));
        self.at += usize::from(found);
        found
    }

    fn deeper(&mut self, read: impl Fn(&mut Self) -> Read) -> Read {
        if self.depth == MOST_DEPTH {
            let accepted = "at most 64 parentheses, roots and signs within each other";
            return self.refuse(self.at..self.at + 1, "a formula too deep", accepted);
        }
        self.depth += 1;
        let inner = read(self);
        self.depth -= 1;
        inner
    }

    fn operation(&mut self, at: usize) -> Result<(), FormulaError> {
        self.operations += 1;
        if self.operations > MOST_OPERATIONS {
            let accepted = "at most 512 operations; definitions name parts of a formula";
            return self.refuse(at..at + 1, "a formula too long", accepted);
        }
        Ok(())
    }

    fn sum(&mut self) -> Read {
        let mut left = self.product()?;
        loop {
            self.blanks();
            let at = self.at;
            let operator = if self.take('+') {
                Operator::Add
            } else if self.take('-') {
                Operator::Sub
            } else {
                return Ok(left);
            };
            self.operation(at)?;
            let right = self.product()?;
            left = self.combined(operator, left, right, at..at + 1)?;
        }
    }

    fn product(&mut self) -> Read {
        let mut left = self.factor()?;
        loop {
            self.blanks();
            let at = self.at;
            let operator = if self.take('*') {
                Operator::Mul
            } else if self.take('/') {
                Operator::Div
            } else {
                return Ok(left);
            };
            self.operation(at)?;
            self.blanks();
            let start = self.at;
            let right = self.factor()?;
            left = self.combined(operator, left, right, start..self.at)?;
        }
    }

    /// The result of an operation; `at` is where its right operand, or its sign, stands.
    fn combined(
        &self,
        operator: Operator,
        left: Formula,
        right: Formula,
        at: Range<usize>,
    ) -> Read {
        let arithmetic = Fixed::<BigInt>::new(BITS);
        if let (Operator::Div, Meaning::Constant(divisor)) = (operator, &right.meaning) {
            let exact = right.expression.rational();
            let apart = divisor.lo.is_positive() || divisor.hi.is_negative();
            if exact.as_ref().map_or(!apart, Zero::is_zero) {
                let found = format!("{}, a divisor that is or may be zero", self.part(&at));
                return self.refuse(at, found, "a divisor other than zero");
            }
        }
        let meaning = match (&left.meaning, &right.meaning) {
            (Meaning::Constant(a), Meaning::Constant(b)) => {
                let value = match operator {
                    Operator::Add => arithmetic.add(a, b),
                    Operator::Sub => arithmetic.sub(a, b),
                    Operator::Mul => arithmetic.mul(a, b),
                    Operator::Div => arithmetic.div(a, b),
                };
                Meaning::Constant(self.moderate(value, &at)?)
            }
            _ => Meaning::Varying,
        };
        let (left, right) = (left.expression.into(), right.expression.into());
        Ok(Formula { expression: Expression::Binary(operator, left, right), meaning })
    }

    /// A value of moderate size.
    fn moderate(
        &self,
        value: Option<Interval<BigInt>>,
        at: &Range<usize>,
    ) -> Result<Interval<BigInt>, FormulaError> {
        match value.filter(|x| x.lo.bits().max(x.hi.bits()) <= MOST_BITS) {
            Some(value) => Ok(value),
            None => self.refuse(at.clone(), "a number too large or too small", "moderate numbers"),
        }
    }

    fn part(&self, at: &Range<usize>) -> &str {
        self.text.get(at.clone()).unwrap_or_default().trim()
    }

    fn factor(&mut self) -> Read {
        if self.take('-') {
            let inner = self.deeper(Self::factor)?;
            let meaning = match inner.meaning {
                Meaning::Constant(x) => Meaning::Constant(Interval { lo: -x.hi, hi: -x.lo }),
                Meaning::Varying => Meaning::Varying,
            };
            return Ok(Formula { expression: Expression::Neg(inner.expression.into()), meaning });
        }
        self.blanks();
        let start = self.at;
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        self.blanks();
        let digits = self.span(|c| c.is_ascii_digit()).to_owned();
        let n = digits.parse::<u32>().ok().filter(|n| (1..=MOST_POWER).contains(n));
        let Some(n) = n else { return Err(self.unexpected(EXPONENT)) };
        self.at += digits.len();
        if self.text.get(self.at..).is_some_and(|rest| rest.starts_with('.')) {
            return Err(self.unexpected(EXPONENT));
        }
        if n == 1 {
            return Ok(base);
        }
        let arithmetic = Fixed::<BigInt>::new(BITS);
        let meaning = match base.meaning {
            Meaning::Varying => Meaning::Varying,
            Meaning::Constant(x) => {
                let mut power = x.clone();
                for _ in 1..n {
                    power = self.moderate(arithmetic.mul(&power, &x), &(start..self.at))?;
                }
                // An even power is not negative.
                if n % 2 == 0 && power.lo.is_negative() {
                    power.lo = BigInt::zero();
                }
                Meaning::Constant(power)
            }
        };
        Ok(Formula { expression: Expression::Power(base.expression.into(), n), meaning })
    }

    fn atom(&mut self) -> Read {
        let rest = self.text.get(self.at..).unwrap_or_default();
        match rest.chars().next() {
            Some('(') => self.parenthesised(),
            Some(c) if c.is_ascii_digit() => self.literal(),
            Some(c) if c.is_ascii_alphabetic() => {
                let name = self.span(|c| c.is_ascii_alphanumeric() || c == '_').to_owned();
                let at = self.at..self.at + name.len();
                self.at = at.end;
                self.blanks();
                let opens = self.text.get(self.at..).is_some_and(|rest| rest.starts_with('('));
                match (name.as_str(), opens) {
                    ("sqrt", _) => self.root(),
                    (_, true) => {
                        let accepted = match name.as_str() {
                            "sin" | "cos" | "tan" => {
                                "sqrt, +, -, *, /, ^; of an angle take t = tan(angle/2) as the \
                                 coordinate: its sine is 2*t/(1 + t^2), its cosine (1 - t^2)/(1 + t^2)"
                            }
                            _ => "sqrt, +, -, *, /, ^",
                        };
                        self.refuse(at, format!("the function {name}"), accepted)
                    }
                    (_, false) => self.name(name, at),
                }
            }
            _ => Err(self.unexpected(OPERAND)),
        }
    }

    fn parenthesised(&mut self) -> Read {
        if !self.take('(') {
            return Err(self.unexpected("("));
        }
        let inner = self.deeper(Self::sum)?;
        if self.take(')') {
            Ok(inner)
        } else {
            Err(self.unexpected("an operator, or )"))
        }
    }

    fn root(&mut self) -> Read {
        let start = self.at;
        let inner = self.parenthesised()?;
        let at = start..self.at;
        let meaning = match &inner.meaning {
            Meaning::Varying => Meaning::Varying,
            Meaning::Constant(radicand) => {
                let exact = inner.expression.rational();
                if exact.as_ref().map_or(radicand.lo.is_negative(), Signed::is_negative) {
                    let found =
                        format!("the root of {}, which is or may be negative", self.part(&at));
                    return self.refuse(at, found, "a radicand that is not negative");
                }
                Meaning::Constant(root(radicand))
            }
        };
        Ok(Formula { expression: Expression::Sqrt(inner.expression.into()), meaning })
    }

    fn name(&mut self, name: String, at: Range<usize>) -> Read {
        let found = self.known.names.iter().find(|(known, _)| *known == name);
        if let Some((_, meaning)) = found {
            self.known.used.insert(name.clone());
            return Ok(Formula { meaning: meaning.clone(), expression: Expression::Name(name) });
        }
        let names: Vec<&str> = self.known.names.iter().map(|(name, _)| name.as_str()).collect();
        let (found, hint) = match self.known.later.contains(&name) {
            true => (format!("{name}, which is given further down"), String::new()),
            false => {
                let hint = suggestion::hint(&name, &names, |name| name.to_owned());
                (format!("the unknown name {name}"), hint)
            }
        };
        let accepted = format!("{}{hint}", names.join(", "));
        Err(FormulaError { at, defect: Defect::UnknownWord, found, accepted })
    }

    fn literal(&mut self) -> Read {
        let start = self.at;
        let digit = |c: char| c.is_ascii_digit();
        let mut digits = self.span(digit).to_owned();
        self.at += digits.len();
        let mut places = 0i64;
        if self.take_here('.') {
            let decimals = self.span(digit).to_owned();
            if decimals.is_empty() {
                return Err(self.unexpected("digits after the point"));
            }
            self.at += decimals.len();
            places = decimals.len() as i64;
            digits += &decimals;
        }
        let exponent = self.exponent();
        let value = BigInt::parse_bytes(digits.as_bytes(), 10);
        let (Some(mut value), Some(exponent)) =
            (value.filter(|_| digits.len() <= MOST_DIGITS), exponent)
        else {
            let accepted = "a number of at most 1,000 digits, exponents within ±1,000";
            return self.refuse(start..self.at, "a number too long", accepted);
        };
        places -= exponent;
        let ten = BigInt::from(10);
        while places > 0 && (&value % &ten).is_zero() {
            value /= &ten;
            places -= 1;
        }
        if places < 0 {
            value *= ten.pow(places.unsigned_abs() as u32);
        }
        let places = u32::try_from(places).unwrap_or(0);
        let expression = Expression::Literal { digits: value, places };
        let value = enclosed(&expression, &expression, &[]);
        let meaning = Meaning::Constant(self.moderate(value, &(start..self.at))?);
        Ok(Formula { expression, meaning })
    }

    fn take_here(&mut self, symbol: char) -> bool {
        let found = self.text.get(self.at..).is_some_and(|rest| rest.starts_with(symbol));
        self.at += usize::from(found);
        found
    }

    /// The power of ten that ends a literal, if one does; `None` where it is beyond the limits.
    fn exponent(&mut self) -> Option<i64> {
        let before = self.at;
        if !self.take_here('e') && !self.take_here('E') {
            return Some(0);
        }
        let negative = self.take_here('-');
        if !negative {
            self.take_here('+');
        }
        let digits = self.span(|c| c.is_ascii_digit()).to_owned();
        if digits.is_empty() {
            self.at = before;
            return Some(0);
        }
        self.at += digits.len();
        let exponent: i64 = digits.parse().ok().filter(|n| *n <= 1000)?;
        Some(if negative { -exponent } else { exponent })
    }
}

/// The roots of an interval's numbers that are not negative.
fn root(radicand: &Interval<BigInt>) -> Interval<BigInt> {
    let arithmetic = Fixed::<BigInt>::new(BITS);
    let of = |x: &BigInt| arithmetic.sqrt(&Interval::point(x.clone()));
    let zero = Interval::point(BigInt::zero());
    let (lo, hi) = (of(&radicand.lo), of(&radicand.hi));
    Interval { lo: lo.unwrap_or_else(|| zero.clone()).lo, hi: hi.unwrap_or(zero).hi }
}

/// Why a text cannot be a name, if it cannot.
pub(super) fn misnamed(name: &str) -> Option<&'static str> {
    if name == "sqrt" {
        return Some("a name other than sqrt, which is the square root");
    }
    let is = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let well = name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is);
    (!well || name.len() > MOST_NAME)
        .then_some("a name of at most 32 letters, digits and _, a letter first")
}
