//! What a macro is worth: C's arithmetic on constants, exactly. The compiler computes in binary
//! floating point and stores a `float`; the number that is written is the one that is meant.

use super::source::Token;
use crate::exact::Exact;
use crate::import::toml::Number;
use crate::import::towers::written;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// What is accepted as a value.
pub(super) const EXPECTED: &str = "decimal numbers and macros of such, with + - * / ( )";

/// Most bits of a numerator or denominator.
const MOST_BITS: u64 = 4096;
/// Greatest `int` of 8-bit boards.
const MOST_INT: i64 = i16::MAX as i64;

/// A constant, and whether C holds it for an integer: `5 / 2` is 2.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Constant {
    value: BigRational,
    integral: bool,
}

/// The number that an expression of constants is.
pub(super) fn number(tokens: &[Token]) -> Option<Number> {
    if let [Token::Number(text)] = tokens {
        return literal(text).map(|(number, _)| number);
    }
    let mut parser = Parser { tokens, at: 0, depth: 0 };
    let constant = parser.sum()?;
    (parser.at == tokens.len()).then(|| written(&constant.value)).flatten()
}

/// The numbers of `{ a, b, ... }`; C fills up with zeros, and `count` is all there are.
pub(super) fn numbers(tokens: &[Token], count: usize) -> Option<Vec<Number>> {
    let [Token::Sign("{"), inner @ .., Token::Sign("}")] = tokens else { return None };
    let mut parts: Vec<&[Token]> = inner.split(|token| *token == Token::Sign(",")).collect();
    if parts.last().is_some_and(|part| part.is_empty()) {
        parts.pop();
    }
    let mut found: Vec<Number> = parts.into_iter().map(number).collect::<Option<_>>()?;
    if found.len() > count {
        return None;
    }
    found.resize(count, Number { text: "0".to_owned(), value: Exact::integer(0) });
    Some(found)
}

/// A constant as C writes it. An octal or hexadecimal one is none here.
fn literal(text: &str) -> Option<(Number, bool)> {
    let integral = !text.contains(['.', 'e', 'E']);
    let suffix: &[char] = if integral { &['u', 'U', 'l', 'L'] } else { &['f', 'F', 'l', 'L'] };
    let digits = text.trim_end_matches(suffix);
    let octal = integral && digits.len() > 1 && digits.starts_with('0');
    if octal
        || text.len() - digits.len() > 3
        || !digits.starts_with(['.', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'])
    {
        return None;
    }
    Number::parse(digits).map(|number| (number, integral))
}

struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn sign(&mut self, among: &[&str]) -> Option<&'static str> {
        match self.tokens.get(self.at) {
            Some(Token::Sign(sign)) if among.contains(sign) => {
                self.at += 1;
                Some(sign)
            }
            _ => None,
        }
    }

    fn sum(&mut self) -> Option<Constant> {
        let mut left = self.product()?;
        while let Some(sign) = self.sign(&["+", "-"]) {
            let right = self.product()?;
            left = combined(&left, sign, &right)?;
        }
        Some(left)
    }

    fn product(&mut self) -> Option<Constant> {
        let mut left = self.signed()?;
        while let Some(sign) = self.sign(&["*", "/"]) {
            let right = self.signed()?;
            left = combined(&left, sign, &right)?;
        }
        Some(left)
    }

    fn signed(&mut self) -> Option<Constant> {
        let mut negative = false;
        while let Some(sign) = self.sign(&["-", "+"]) {
            negative ^= sign == "-";
        }
        let mut constant = match self.tokens.get(self.at)? {
            Token::Number(text) => {
                self.at += 1;
                let (number, integral) = literal(text)?;
                Constant { value: number.value.as_rational()?.clone(), integral }
            }
            _ => {
                self.sign(&["("])?;
                self.depth += 1;
                if self.depth > 64 {
                    return None;
                }
                let constant = self.sum()?;
                self.depth -= 1;
                self.sign(&[")"])?;
                constant
            }
        };
        if negative {
            constant.value = -constant.value;
        }
        Some(constant)
    }
}

/// The value of an operation; none if it divides by zero, or overflows the `int` of some board.
fn combined(a: &Constant, sign: &str, b: &Constant) -> Option<Constant> {
    let integral = a.integral && b.integral;
    let value = match sign {
        "+" => &a.value + &b.value,
        "-" => &a.value - &b.value,
        "*" => &a.value * &b.value,
        _ if b.value.is_zero() => return None,
        _ if integral => (&a.value / &b.value).trunc(),
        _ => &a.value / &b.value,
    };
    let overflows = integral && value.abs() > BigRational::from_integer(MOST_INT.into());
    let long = value.numer().bits() > MOST_BITS || value.denom().bits() > MOST_BITS;
    (!overflows && !long).then_some(Constant { value, integral })
}

#[cfg(test)]
mod tests {
    use super::super::source::tokens;
    use super::{number, numbers};

    #[test]
    fn constants_are_exact_and_integers_are_those_of_c() {
        for (text, expected) in [
            ("250.00", Some("250.00")),
            ("(186-(31)-(20.6))", Some("134.4")),
            ("-(140.0)", Some("-140.0")),
            ("+.5f", Some("0.5")),
            ("5 / 2", Some("2")),
            ("-5 / 2", Some("-2")),
            ("5 / 2.0", Some("2.5")),
            ("1.0/3", Some("(1/3)")),
            ("0.1 + 0.2", Some("0.3")),
            ("1e2L", Some("1e2")),
            ("1.5 / 0", None),
            ("300 * 200", None),
            ("300.0 * 200", Some("60000")),
            ("010", None),
            ("0x10", None),
            ("1 2", None),
            ("sin(1)", None),
            ("", None),
        ] {
            let found = number(&tokens(text)).map(|number| number.text);
            let same = match (&found, expected) {
                (Some(found), Some(expected)) => found.parse::<f64>() == expected.parse::<f64>(),
                (found, expected) => found.is_none() && expected.is_none(),
            };
            assert!(same, "{text}: {found:?}");
        }
        assert_eq!(number(&tokens("1.0/3")).map(|n| n.text).as_deref(), Some("(1/3)"));
        let texts = |text: &str| {
            let found = numbers(&tokens(text), 3)?;
            Some(found.into_iter().map(|number| number.text).collect::<Vec<_>>())
        };
        assert_eq!(texts("{ +0.13, -0.18, 0.05 }").unwrap(), ["0.13", "-0.18", "0.05"]);
        assert_eq!(texts("{ 1, }").unwrap(), ["1", "0", "0"]);
        assert_eq!(texts("{ 1, 2, 3, 4 }"), None);
        assert_eq!(texts("1, 2, 3"), None);
    }
}
