//! Numbers of designs as the kernel writes them: the same real numbers, in another text.

use super::document::Value;
use super::error::{Defect, DesignError};
use super::leg;
use super::number::{self, WITHIN_LIMITS};
use crate::exact::arithmetic;
use crate::exact::Exact;
use orthocert_kernel::claim::Quantity;
use orthocert_kernel::number::{Expression, Operator};

/// The exact number that `value` is.
pub(super) fn number(value: &Value<'_>) -> Result<Expression, DesignError> {
    of(value, &number::exact(value)?)
}

/// The quantity that `value` is.
pub(super) fn quantity(value: &Value<'_>) -> Result<Quantity, DesignError> {
    let read = number::quantity(value)?;
    between(&read).ok_or_else(|| too_long(value))
}

/// A number that `value` is about.
pub(super) fn of(value: &Value<'_>, number: &Exact) -> Result<Expression, DesignError> {
    written(number).ok_or_else(|| too_long(value))
}

pub(super) fn too_long(value: &Value<'_>) -> DesignError {
    let found = format!("{}, whose exact value is too long to be written", value.found());
    value.error(Defect::NotANumber, found, WITHIN_LIMITS)
}

/// The quantity with the same ends.
pub(super) fn between(quantity: &leg::Quantity) -> Option<Quantity> {
    let min = written(&quantity.min)?;
    Some(match quantity.is_exact() {
        true => Quantity::Exactly(min),
        false => Quantity::Between { min, max: written(&quantity.max)? },
    })
}

/// The expression of the same number: every operation is that of `number`, and rational numbers are
/// decimals or fractions in lowest terms. `None` where its text is beyond the kernel's limits.
pub fn written(number: &Exact) -> Option<Expression> {
    let expression = translated(number);
    let read = Expression::try_from(expression.to_string());
    (read.as_ref() == Ok(&expression)).then_some(expression)
}

fn translated(number: &Exact) -> Expression {
    let of = |x: &Exact| translated(x).into();
    let binary = |operator, x: &Exact, y: &Exact| Expression::Binary(operator, of(x), of(y));
    match number {
        Exact::Rational(x) => arithmetic::number(x),
        Exact::Neg(x) => Expression::Neg(of(x)),
        Exact::Sqrt(x) => Expression::Sqrt(of(x)),
        Exact::Add(x, y) => binary(Operator::Add, x, y),
        Exact::Sub(x, y) => binary(Operator::Sub, x, y),
        Exact::Mul(x, y) => binary(Operator::Mul, x, y),
        Exact::Div(x, y) => binary(Operator::Div, x, y),
        Exact::Name(name) => Expression::Name(name.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;

    /// Texts, and how the kernel writes their numbers.
    const WRITTEN: &[(&str, &str)] = &[
        ("0", "0"),
        ("310.25", "310.25"),
        ("-0.50", "-0.5"),
        ("1/3", "1/3"),
        ("-7/3", "-7/3"),
        ("4/8", "0.5"),
        ("1e3", "1000"),
        ("1e-3", "0.001"),
        ("0.1+1/3", "13/30"),
        ("174.75*sqrt(3)/2", "174.75*sqrt(3)/2"),
        ("-174.75*sqrt(3)/2", "-174.75*sqrt(3)/2"),
        ("sqrt(2)/(1/3)", "sqrt(2)/(1/3)"),
        ("1-(sqrt(2)-3)", "1-(sqrt(2)-3)"),
        ("sqrt(2)--1.5", "sqrt(2)--1.5"),
        ("-(sqrt(2)+1)", "-(sqrt(2)+1)"),
        ("sqrt(0.1-1/10)", "0"),
        ("1/1024", "0.0009765625"),
        ("1-1e-50", "0.99999999999999999999999999999999999999999999999999"),
        ("1e-30/7", "0.000000000000000000000000000001/7"),
        ("-1e-12/7", "-1/7000000000000"),
    ];

    #[test]
    fn the_text_is_canonical() {
        for (text, expected) in WRITTEN {
            let exact = Exact::parse(text, 1000).unwrap();
            let expression = written(&exact).unwrap();
            assert_eq!(expression.to_string(), *expected, "{text}");
            assert_eq!(Expression::try_from((*expected).to_owned()), Ok(expression), "{text}");
        }
    }

    /// Both enclosures are of one number: rational values agree, and other enclosures, whose widths
    /// are below `2^-380`, overlap.
    #[test]
    fn both_texts_denote_the_same_number() {
        let long = ["1e1000", "1e-1000", "2/3*1e-900", "1e-40", "1e-41", "3/2*sqrt(1e-50)"];
        let nested = "sqrt(2+sqrt(3+sqrt(5/7)))*(1-sqrt(11)/13)-0.125";
        let texts = WRITTEN.iter().map(|(text, _)| *text).chain(long).chain([nested]);
        for text in texts {
            let exact = Exact::parse(text, 1000).unwrap();
            let expression = written(&exact).unwrap();
            let canonical = Exact::parse_canonical(&exact.to_string()).unwrap();
            assert_eq!(canonical, exact, "{text}");
            let read = Exact::parse(&expression.to_string(), 2100).unwrap();
            assert_eq!(read, exact, "{text}");
            if let (Some(x), Some(y)) = (exact.as_rational(), expression.rational()) {
                assert_eq!(*x, y, "{text}");
            }
            let (old, new) = (exact.enclose(400).unwrap(), { expression.enclose(400).unwrap() });
            assert!(old.lo <= new.hi && new.lo <= old.hi, "{text}");
            let least = BigInt::from(1) << 20;
            if exact.as_rational().is_none() {
                assert!(&new.hi - &new.lo < least, "{text}");
            }
        }
    }

    #[test]
    fn small_numbers_are_known_to_the_bits_that_are_asked_for() {
        for text in ["312-1e-300", "1e-41", "1e-310/3", "(2/3+1e-250)/7", "1e-1000", "2/3*1e-900"] {
            let expression = written(&Exact::parse(text, 1000).unwrap()).unwrap();
            let x = expression.enclose(64).unwrap();
            assert!(&x.hi - &x.lo <= BigInt::from(4), "{text}");
        }
    }

    #[test]
    fn what_is_too_long_for_the_kernel_is_refused() {
        let terms = |n: usize| vec!["sqrt(2)/3"; n].join("+");
        let exact = |text: &str| Exact::parse(text, 1000);
        assert!(exact(&terms(20)).is_err(), "more roots than a design may have");
        assert!(written(&exact(&terms(15)).unwrap()).is_some());
        let deep = Exact::Name("x".repeat(33).into());
        assert_eq!(written(&deep), None);
    }
}
