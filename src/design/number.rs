//! Exact numbers of design files, and tolerances.
//!
//! A TOML number means the number that is written: `310.25`, `0.1` and `1e-3` are taken digit by
//! digit from the text, never by way of a floating-point number. TOML's underscores between digits
//! have no meaning; hexadecimal, octal and binary integers are converted exactly. A string is an
//! expression ([`Exact::parse`]), or two with `±` or `+/-` between them: nominal value and
//! tolerance. What may be read as either is refused ([`notation`](super::notation)).

use super::document::{Names, Value};
use super::error::{Defect, DesignError};
use super::leg::Quantity;
use super::names::{self, NoValue};
use super::notation::{is_plain_tolerance, may_be_tolerance, parts_of_tolerance};
use super::suggestion;
use super::variable::half_width;
use crate::exact::{Exact, NumberError, NumberErrorKind};
use std::cmp::Ordering;
use toml::de::{DeFloat, DeInteger, DeValue};

/// Most digits of a literal.
const MAX_DIGITS: usize = 1000;

const NUMBER: &str = r#"a number: 310.25, "1/3", "174.75*sqrt(3)/2""#;
const QUANTITY: &str =
    r#"a number or a tolerance: 310.25, "1/3", "310.25 ± 0.02", { min = 310.2, max = 310.3 }"#;
const FINITE: &str = "a finite number";
pub(super) const WITHIN_LIMITS: &str = "a number of at most 1,000 digits, exponents within ±1,000";
const NEITHER_SUM_NOR_TOLERANCE: &str = r#""310.25 ± 0.02" for a tolerance, { min = 310.23, max = 310.3 } for unequal deviations, or, as arithmetic, blanks on both sides of a sign or on neither, and parentheses: "310.25 + 0.02", "310 + (5 - 2)", "310 ± (1/50)""#;
const NO_TOLERANCE: &str =
    "one exact number: a machine's parameters may carry a tolerance, workspace and requirements not";

/// The single exact number that `value` is.
pub(super) fn exact(value: &Value<'_>) -> Result<Exact, DesignError> {
    let tolerance = match value.inner {
        DeValue::String(text) => parts_of_tolerance(text).is_some(),
        DeValue::Table(table) => table.contains_key("min") || table.contains_key("max"),
        _ => false,
    };
    if tolerance {
        let found = match value.inner {
            DeValue::Table(_) => "a tolerance { min, max }".to_owned(),
            _ => format!("the tolerance {}", value.found()),
        };
        return Err(value.error(Defect::Tolerance, found, NO_TOLERANCE));
    }
    scalar(value, NUMBER)
}

/// The parameter of a machine, with or without tolerance, that `value` is.
pub(super) fn quantity(value: &Value<'_>) -> Result<Quantity, DesignError> {
    match value.inner {
        DeValue::Table(_) => {
            let table = value.table(QUANTITY)?;
            table.only(&["min", "max"])?;
            let (least, greatest) = (table.require("min", NUMBER)?, table.require("max", NUMBER)?);
            let (min, max) = (exact(&least)?, exact(&greatest)?);
            ordered((&least, &min), (&greatest, &max))?;
            Ok(Quantity { min, max })
        }
        DeValue::String(text) => match parts_of_tolerance(text) {
            Some(parts) if is_plain_tolerance(&parts) => around(value, text, parts),
            Some(_) => Err(ambiguous(value)),
            None => scalar(value, QUANTITY).map(Quantity::exactly),
        },
        _ => scalar(value, QUANTITY).map(Quantity::exactly),
    }
}

/// The middle of the number or the tolerance that `value` is, and the tolerance's own text.
pub(super) fn centred(value: &Value<'_>) -> Result<(Exact, Option<String>), DesignError> {
    let Quantity { min, max } = quantity(value)?;
    match value.inner {
        DeValue::String(text) => match parts_of_tolerance(text) {
            Some([nominal, (_, tolerance)]) => {
                let nominal = expression(value, text, nominal, QUANTITY)?;
                Ok((nominal, Some(tolerance.trim().to_owned())))
            }
            None => Ok((min, None)),
        },
        DeValue::Table(_) => {
            let halved = |x: Result<Exact, NumberErrorKind>| x?.over(Exact::integer(2));
            let too_long = |_| value.error(Defect::NotANumber, value.found(), WITHIN_LIMITS);
            let middle = halved(min.clone().plus(max.clone())).map_err(too_long)?;
            let half = halved(max.minus(min)).map_err(too_long)?;
            Ok((middle, Some(half_width(&half))))
        }
        _ => Ok((min, None)),
    }
}

/// Demands that `min <= max` is provable.
pub(super) fn ordered(
    (least, min): (&Value<'_>, &Exact),
    (greatest, max): (&Value<'_>, &Exact),
) -> Result<(), DesignError> {
    if !least.document.demands() {
        return Ok(());
    }
    let relation = match min.compare(max) {
        Some(Ordering::Less | Ordering::Equal) => return Ok(()),
        Some(Ordering::Greater) => "below",
        None => "not provably at least",
    };
    let found = format!("{}, {relation} the lower end {}", greatest.found(), least.found());
    let accepted = "an upper end that is at least the lower one";
    Err(greatest.error(Defect::Reversed, found, accepted))
}

/// Demands that `number`, which `value` is, is provably not negative; `what` names it.
pub(super) fn not_negative(
    value: &Value<'_>,
    number: &Exact,
    what: &str,
) -> Result<(), DesignError> {
    if !value.document.demands() || matches!(number.sign(), Some(0 | 1)) {
        return Ok(());
    }
    Err(value.error(Defect::OutOfDomain, value.found(), format!("{what}, 0 or greater")))
}

/// Demands that `number`, which `value` is or begins with, is provably positive; `what` names it.
pub(super) fn positive(value: &Value<'_>, number: &Exact, what: &str) -> Result<(), DesignError> {
    if !value.document.demands() {
        return Ok(());
    }
    let found = match number.sign() {
        Some(1) => return Ok(()),
        Some(_) => value.found(),
        None => format!("{}, which is not provably positive", value.found()),
    };
    let is_range = match value.inner {
        DeValue::String(text) => parts_of_tolerance(text).is_some(),
        other => matches!(other, DeValue::Table(_)),
    };
    let whole = if is_range { ", over its whole tolerance" } else { "" };
    Err(value.error(Defect::OutOfDomain, found, format!("{what} greater than 0{whole}")))
}

/// Demands that an angle in degrees is between 0 and 180.
pub(super) fn less_than_half_a_turn(value: &Value<'_>, angle: &Exact) -> Result<(), DesignError> {
    let below = angle.compare(&Exact::integer(180)) == Some(Ordering::Less);
    if !value.document.demands() || (angle.sign() == Some(1) && below) {
        return Ok(());
    }
    let accepted = "an angle in degrees, greater than 0 and less than 180";
    Err(value.error(Defect::OutOfDomain, value.found(), accepted))
}

/// `-quantity`.
pub(super) fn negated(value: &Value<'_>, quantity: &Quantity) -> Result<Quantity, DesignError> {
    let end = |x: &Exact| writable(value, x.clone().negated());
    Ok(Quantity { min: end(&quantity.max)?, max: end(&quantity.min)? })
}

fn scalar(value: &Value<'_>, accepted: &str) -> Result<Exact, DesignError> {
    match value.inner {
        DeValue::Integer(integer) => whole(value, integer),
        DeValue::Float(float) => decimal(value, float),
        DeValue::String(text) if may_be_tolerance(text) => Err(ambiguous(value)),
        DeValue::String(text) => writable(value, expression(value, text, (0, text), accepted)?),
        _ => Err(value.wrong_type(accepted)),
    }
}

fn ambiguous(value: &Value<'_>) -> DesignError {
    let found = format!("{}, which may be read as a tolerance or as arithmetic", value.found());
    value.error(Defect::Tolerance, found, NEITHER_SUM_NOR_TOLERANCE)
}

/// The number that `part`, at this offset of the value's `text`, denotes.
fn expression(
    value: &Value<'_>,
    text: &str,
    (offset, part): (usize, &str),
    accepted: &str,
) -> Result<Exact, DesignError> {
    let refused = |NumberError { at, kind }| {
        not_a_number(value, text, &NumberError { at: at + offset, kind }, accepted)
    };
    let (known, keep) = match value.document.names {
        Names::None => return Exact::parse(part, MAX_DIGITS).map_err(refused),
        Names::Values(known) => (known, false),
        Names::Kept(known) => (known, true),
    };
    let open = Exact::parse_open(part, MAX_DIGITS).map_err(refused)?;
    match names::value(&open, known) {
        Ok(number) => Ok(if keep { open } else { number }),
        Err(NoValue::Unknown(name)) => {
            let names: Vec<&str> = known.iter().map(|(name, _)| name.as_str()).collect();
            let hint = suggestion::hint(&name, &names, |word| word.to_owned());
            let found = format!("{}, with the name {name}", value.found());
            let accepted = format!("the names of [parameters]: {}{hint}", names.join(", "));
            Err(value.error(Defect::UnknownWord, found, accepted))
        }
        Err(error) => {
            let at: Vec<String> = known.iter().map(|(name, x)| format!("{name} = {x}")).collect();
            let found = format!("{}; for {} {error}", value.found(), at.join(", "));
            Err(value.error(Defect::NotANumber, found, accepted))
        }
    }
}

fn decimal(value: &Value<'_>, float: &DeFloat<'_>) -> Result<Exact, DesignError> {
    let text = float.as_str();
    if matches!(text.trim_start_matches(['+', '-']), "inf" | "nan") {
        return Err(value.error(Defect::NotANumber, value.found(), FINITE));
    }
    literal(value, text)
}

/// A decimal literal of TOML, its underscores removed.
fn literal(value: &Value<'_>, text: &str) -> Result<Exact, DesignError> {
    // The grammar of expressions has no unary plus.
    let digits = text.strip_prefix('+').unwrap_or(text);
    let number = Exact::parse(digits, MAX_DIGITS).map_err(|NumberError { at, kind }| {
        let error = NumberError { at: at + text.len() - digits.len(), kind };
        not_a_number(value, text, &error, NUMBER)
    });
    writable(value, number?)
}

fn whole(value: &Value<'_>, integer: &DeInteger<'_>) -> Result<Exact, DesignError> {
    let text = integer.as_str();
    let radix = integer.radix();
    if radix == 10 {
        return literal(value, text);
    }
    let too_large = || value.error(Defect::NotANumber, value.found(), WITHIN_LIMITS);
    if text.len() > MAX_DIGITS {
        return Err(too_large());
    }
    let base = Exact::integer(radix.into());
    let mut number = Exact::integer(0);
    for digit in text.chars() {
        let digit = digit.to_digit(radix).ok_or_else(|| value.wrong_type(NUMBER))?;
        let shifted = number.times(base.clone());
        let next = shifted.and_then(|number| number.plus(Exact::integer(digit.into())));
        number = next.map_err(|_| too_large())?;
    }
    writable(value, number)
}

/// `nominal ± tolerance`.
fn around(
    value: &Value<'_>,
    text: &str,
    parts: [(usize, &str); 2],
) -> Result<Quantity, DesignError> {
    let part = |part| expression(value, text, part, QUANTITY);
    let [nominal, tolerance] = parts;
    let (nominal, tolerance) = (part(nominal)?, part(tolerance)?);
    match tolerance.sign() {
        Some(0) => return Ok(Quantity::exactly(writable(value, nominal)?)),
        Some(1) => {}
        None if !value.document.demands() => {}
        _ => {
            let accepted = "a tolerance that is (provably) not negative";
            return Err(value.error(Defect::Tolerance, value.found(), accepted));
        }
    }
    let end = |end: Result<Exact, NumberErrorKind>| match end {
        Ok(end) => writable(value, end),
        Err(_) => Err(value.error(Defect::NotANumber, value.found(), WITHIN_LIMITS)),
    };
    let min = end(nominal.clone().minus(tolerance.clone()))?;
    Ok(Quantity { min, max: end(nominal.plus(tolerance))? })
}

/// `number`, if its canonical text is within the limits of certificates: those of the parser.
fn writable(value: &Value<'_>, number: Exact) -> Result<Exact, DesignError> {
    let text = number.to_string();
    let same = match number.is_open() {
        true => Exact::parse_open(&text, MAX_DIGITS),
        false => Exact::parse_canonical(&text),
    };
    match same {
        Ok(same) if same == number => Ok(number),
        _ => {
            let found = format!("{}, whose exact value is too long to be written", value.found());
            Err(value.error(Defect::NotANumber, found, WITHIN_LIMITS))
        }
    }
}

/// The error that `text`, the value's content, is no number, with the caret where it ceases to be.
fn not_a_number(value: &Value<'_>, text: &str, error: &NumberError, accepted: &str) -> DesignError {
    use NumberErrorKind::{ExponentTooLarge, TooLarge, TooManyDigits, TooManyRoots};
    let accepted = match error.kind {
        TooManyDigits(_) | ExponentTooLarge | TooLarge => WITHIN_LIMITS,
        TooManyRoots => "a number of at most 16 square roots",
        _ => accepted,
    };
    let before = text.get(..error.at).unwrap_or(text);
    let at_character = NumberError { at: before.chars().count(), kind: error.kind.clone() };
    let found = format!("{} ({at_character})", value.found());
    let unit = suggestion::without_unit(text, error.at);
    let hint = unit.map(|number| format!("; numbers carry no unit: {number}"));
    let other = || suggestion::notation(text, error.at).map(|how| format!("; {how}"));
    let accepted = format!("{accepted}{}", hint.or_else(other).unwrap_or_default());
    let at = value.place(text, before.len()..before.len() + 1);
    value.document.error(at, (&value.key, Defect::NotANumber), found, accepted)
}
