//! Decimal notation of exact numbers, and of enclosures with every digit certified.

use crate::exact::arithmetic::decimal_places;
use crate::exact::Exact;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// Longest text of an exact number that is shown to people as it stands.
const READABLE: u32 = 12;
/// Most decimal places of a number in full; beyond, it is a fraction.
const EXACT_PLACES: u32 = 40;
/// Digits shown of a number that is not.
const SHORTENED: u32 = 9;
/// Fractional bits of an enclosure that is only to be shown.
const SHOWN_BITS: u32 = 128;

/// Which neighbour on the grid of decimals is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toward {
    /// The greatest decimal that is at most the number.
    Below,
    /// The least decimal that is at least the number.
    Above,
}

/// `x` rounded to `digits` significant digits (at least one), outward as `toward` says:
/// positional for exponents of ten from -5 to 15, with an exponent otherwise.
pub fn rounded(x: &BigRational, digits: u32, toward: Toward) -> String {
    if x.is_zero() {
        return "0".to_owned();
    }
    let digits = i64::from(digits.max(1));
    let mut exponent = order(x);
    let mut mantissa = on_grid(x, digits - 1 - exponent, toward);
    if mantissa.abs() == power_of_ten(digits) {
        // Rounding has reached the next power of ten: 9.99... became 10.00...
        mantissa /= 10;
        exponent += 1;
    }
    written(&mantissa, exponent, digits)
}

/// `e` with `10^e <= |x| < 10^(e + 1)`, `x != 0`.
pub fn order(x: &BigRational) -> i64 {
    let bits = |n: &BigInt| i64::try_from(n.bits()).unwrap_or(i64::MAX / 4);
    // |x| = 2^(b + r), b the difference of bit lengths, |r| < 1: off by one at most.
    let estimate = (bits(x.numer()) - bits(x.denom())) as f64 * std::f64::consts::LOG10_2;
    let mut exponent = estimate.floor() as i64;
    let magnitude = x.abs();
    while magnitude < scaled(&BigRational::one(), exponent) {
        exponent -= 1;
    }
    while magnitude >= scaled(&BigRational::one(), exponent + 1) {
        exponent += 1;
    }
    exponent
}

/// `x * 10^places`, rounded to an integer.
fn on_grid(x: &BigRational, places: i64, toward: Toward) -> BigInt {
    let x = scaled(x, places);
    match toward {
        Toward::Below => x.numer().div_floor(x.denom()),
        Toward::Above => x.numer().div_ceil(x.denom()),
    }
}

/// `x * 10^places`.
fn scaled(x: &BigRational, places: i64) -> BigRational {
    match places.cmp(&0) {
        Ordering::Less => x / power_of_ten(-places),
        _ => x * power_of_ten(places),
    }
}

fn power_of_ten(exponent: i64) -> BigInt {
    BigInt::from(10).pow(u32::try_from(exponent).unwrap_or(0))
}

/// `mantissa * 10^(exponent - digits + 1)`, the mantissa having `digits` digits.
fn written(mantissa: &BigInt, exponent: i64, digits: i64) -> String {
    let sign = if mantissa.is_negative() { "-" } else { "" };
    let text = mantissa.abs().to_string();
    let zeros = |n: i64| "0".repeat(usize::try_from(n).unwrap_or(0));
    let split = |at: i64| text.split_at(usize::try_from(at).unwrap_or(0).min(text.len()));
    if (-5..0).contains(&exponent) {
        return format!("{sign}0.{}{text}", zeros(-exponent - 1));
    }
    if (0..=15).contains(&exponent) {
        let (whole, fraction) = split(exponent + 1);
        let padding = zeros(exponent + 1 - digits);
        return match fraction {
            "" => format!("{sign}{whole}{padding}"),
            _ => format!("{sign}{whole}.{fraction}"),
        };
    }
    match split(1) {
        (first, "") => format!("{sign}{first}e{exponent}"),
        (first, rest) => format!("{sign}{first}.{rest}e{exponent}"),
    }
}

/// The decimal that a rational is exactly, if it has one of at most `places` decimal places.
pub fn terminating(x: &BigRational, places: u32) -> Option<String> {
    let (needed, rest) = decimal_places(x.denom());
    if needed > places || !rest.is_one() {
        return None;
    }
    let digits = (x * BigInt::from(10).pow(needed)).to_integer().abs().to_string();
    let sign = if x.is_negative() { "-" } else { "" };
    let width = needed as usize + 1;
    let digits = format!("{digits:0>width$}");
    let (whole, fraction) = digits.split_at(digits.len() - needed as usize);
    Some(if fraction.is_empty() {
        format!("{sign}{whole}")
    } else {
        format!("{sign}{whole}.{fraction}")
    })
}

/// The decimal that a rational is exactly, if it has one of at most so many characters.
fn short(x: &BigRational, most: u32) -> Option<String> {
    terminating(x, most).filter(|text| text.len() <= most as usize)
}

/// The decimal of the fewest places from `min` to `max`, `min < max`: of those the nearest to the
/// middle.
pub fn shortest(min: &BigRational, max: &BigRational) -> BigRational {
    let middle = (min + max) / BigRational::from_integer(2.into());
    if max <= min {
        return middle;
    }
    // From a step that is greater than the interval; of one at most half as long as it there is a
    // multiple in it: the nearest to the middle is.
    let mut places = -1 - order(&(max - min));
    loop {
        let value = scaled(&scaled(&middle, places).round(), -places);
        if *min <= value && value <= *max {
            return value;
        }
        places += 1;
    }
}

/// An exact number for people: itself where that is short, as a decimal if it is one; else nine
/// digits after a `~`.
pub fn readable(x: &Exact) -> String {
    if let Some(decimal) = x.as_rational().and_then(|x| short(x, READABLE)) {
        return decimal;
    }
    let text = x.to_string();
    if text.len() <= READABLE as usize {
        return text;
    }
    // Beyond the doubles, too, the order of magnitude is what is to be seen.
    let enclosed = || x.below(SHOWN_BITS).map(|x| rounded(&x, SHORTENED, Toward::Below));
    match approximate(x).filter(|value| *value != 0.0) {
        Some(value) => format!("~{}", significant(value, SHORTENED)),
        None => enclosed().filter(|text| text != "0").map_or(text, |text| format!("~{text}")),
    }
}

/// An exact number as a decimal; where that has more than so many characters, the nine digits that it begins
/// with, and an ellipsis.
pub fn begun(x: &Exact, most: u32) -> String {
    if let Some(text) = x.as_rational().and_then(|x| short(x, most)) {
        return text;
    }
    match x.ends(SHOWN_BITS).map(|ends| ends.map(|end| first_digits(&end))) {
        Some([least, most]) if least == most && least != "0" => least,
        _ => x.to_string(),
    }
}

fn first_digits(x: &BigRational) -> String {
    let text = rounded(x, SHORTENED, if x.is_negative() { Toward::Above } else { Toward::Below });
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{mantissa}\u{2026}e{exponent}"),
        None => text + "\u{2026}",
    }
}

/// An exact number for people, never on its other side: itself where that is a decimal of so many digits,
/// sign and point, and three more; else rounded outward.
pub fn outward(x: &Exact, digits: u32, toward: Toward) -> String {
    let Some(x) = x.as_rational() else { return x.to_string() };
    short(x, digits + 3).unwrap_or_else(|| briefly(x, digits, toward))
}

/// [`rounded`] to at most so many digits, without trailing zeros.
pub fn briefly(x: &BigRational, digits: u32, toward: Toward) -> String {
    let text = rounded(x, digits, toward);
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
        None => trimmed(&text).to_owned(),
    }
}

/// An exact number in full: as a decimal, if it is one of at most forty places; a whole number with more
/// than fifteen zeros at its end with an exponent.
pub fn exact(x: &Exact) -> String {
    let decimal = x.as_rational().and_then(|x| terminating(x, EXACT_PLACES));
    decimal.map_or_else(|| x.to_string(), with_exponent)
}

fn with_exponent(decimal: String) -> String {
    let digits = decimal.trim_start_matches('-');
    let mantissa = digits.trim_end_matches('0');
    if digits.contains('.') || digits.len() - mantissa.len() <= 15 || mantissa.is_empty() {
        return decimal;
    }
    let sign = if decimal.starts_with('-') { "-" } else { "" };
    let (first, rest) = mantissa.split_at(1);
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{first}{point}{rest}e{}", digits.len() - 1)
}

/// A double near `x`; `None` where there is none.
pub fn approximate(x: &Exact) -> Option<f64> {
    let value = match x.as_rational() {
        Some(x) => x.to_f64()?,
        None => x.below(SHOWN_BITS)?.to_f64()?,
    };
    value.is_finite().then_some(value)
}

/// A double with so many significant digits, positional or with an exponent like [`rounded`],
/// without trailing zeros. Of what no double is, words.
pub fn significant(value: f64, digits: u32) -> String {
    if value == 0.0 || !value.is_finite() {
        let words = match value {
            0.0 => "0",
            f64::INFINITY => "over 1e308",
            f64::NEG_INFINITY => "under -1e308",
            _ => "not computed",
        };
        return words.to_owned();
    }
    let scientific = format!("{value:.*e}", digits.max(1) as usize - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-5..=15).contains(&exponent) {
        let places = (digits as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.places$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// A share in per cent, of at most so many significant digits, without trailing zeros: what is proved
/// of a part is rounded down, what is open up, so that no more is shown than is proved.
pub fn percent(share: &BigRational, digits: u32, toward: Toward) -> String {
    format!("{} %", briefly(&scaled(share, 2), digits, toward))
}

fn trimmed(decimal: &str) -> &str {
    if decimal.contains('.') {
        decimal.trim_end_matches('0').trim_end_matches('.')
    } else {
        decimal
    }
}

/// An integer with commas between groups of three digits.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A number of boxes, in words.
pub fn boxes(n: usize) -> String {
    counted(n, "box", "boxes")
}

/// A number of things, in words.
pub fn counted(n: usize, one: &str, many: &str) -> String {
    match n {
        1 => format!("1 {one}"),
        n => format!("{} {many}", grouped(n as u64)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(text: &str) -> BigRational {
        Exact::parse(text, 1000).unwrap().as_rational().unwrap().clone()
    }

    #[test]
    fn rounding_is_outward_on_either_side_of_zero() {
        for (text, below, above) in [
            ("1/3", "0.3333", "0.3334"),
            ("-1/3", "-0.3334", "-0.3333"),
            ("2/3*1e20", "6.666e19", "6.667e19"),
            ("1/3e30", "3.333e-31", "3.334e-31"),
            ("99999", "99990", "100000"),
            ("-99999", "-100000", "-99990"),
            ("0.99999", "0.9999", "1.000"),
            ("200", "200.0", "200.0"),
            ("0", "0", "0"),
            ("0.00001", "0.00001000", "0.00001000"),
            ("12345678901234567", "1.234e16", "1.235e16"),
        ] {
            let x = exact(text);
            assert_eq!(rounded(&x, 4, Toward::Below), below, "{text}");
            assert_eq!(rounded(&x, 4, Toward::Above), above, "{text}");
        }
    }

    #[test]
    fn long_whole_numbers_have_an_exponent_and_stay_exact() {
        for (text, shown) in [
            ("3.107e162", "3.107e162"),
            ("-7e400", "-7e400"),
            ("1e16", "1e16"),
            ("1e15", "1000000000000000"),
            ("120000000000000001", "120000000000000001"),
            ("0", "0"),
        ] {
            let x = Exact::parse(text, 1000).unwrap();
            assert_eq!(super::exact(&x), shown);
            assert_eq!(exact(shown), exact(text));
        }
        for (x, shown) in [(f64::INFINITY, "over 1e308"), (f64::NAN, "not computed")] {
            assert_eq!(significant(x, 3), shown);
        }
    }

    #[test]
    fn briefly_there_are_no_zeros_behind() {
        for (text, below, above) in [
            ("0.000326429", "0.0003264", "0.0003265"),
            ("0.00999999", "0.009999", "0.01"),
            ("2.00001e-30", "2e-30", "2.001e-30"),
            ("1999999", "1999000", "2000000"),
        ] {
            let x = exact(text);
            assert_eq!(briefly(&x, 4, Toward::Below), below, "{text}");
            assert_eq!(briefly(&x, 4, Toward::Above), above, "{text}");
        }
    }

    #[test]
    fn rounded_decimals_enclose() {
        for n in 1..400i64 {
            for d in [3i64, 7, 9, 11, 1000, 999_983] {
                let x = BigRational::new((n * n - 20_000).into(), d.into());
                for digits in [1, 2, 5, 15] {
                    let below = exact(&rounded(&x, digits, Toward::Below));
                    let above = exact(&rounded(&x, digits, Toward::Above));
                    assert!(below <= x && x <= above, "{x} {digits}");
                }
            }
        }
    }

    #[test]
    fn numbers_are_shown_as_they_are_where_that_is_short() {
        for (text, shown) in [
            ("2", "2"),
            ("-73.2", "-73.2"),
            ("1/2", "0.5"),
            ("1/3", "1/3"),
            ("500/1001", "500/1001"),
            ("sqrt(2)", "sqrt(2)"),
            ("100*sqrt(3)/(1+sqrt(2))", "~71.7438935"),
            ("310.582854123025", "~310.582854"),
            ("1e-30", "~1e-30"),
            ("7e400", "~7.00000000e400"),
        ] {
            assert_eq!(readable(&Exact::parse(text, 1000).unwrap()), shown);
        }
    }

    #[test]
    fn what_begins_with_digits_goes_on_with_them() {
        for (text, shown) in [
            ("1/2", "0.5"),
            ("1/3", "0.333333333\u{2026}"),
            ("-2/3", "-0.666666666\u{2026}"),
            ("174.75*sqrt(3)/2", "151.337939\u{2026}"),
            ("-sqrt(2)*1e30", "-1.41421356\u{2026}e30"),
            ("0.12345678901234567891234567", "0.123456789\u{2026}"),
            ("sqrt(2)*1e-60", "sqrt(2)/1e60"),
        ] {
            let x = Exact::parse(text, 1000).unwrap();
            let found = begun(&x, 20);
            assert!(
                found == shown || shown.starts_with("sqrt") && found == x.to_string(),
                "{found}"
            );
        }
    }

    #[test]
    fn no_share_is_shown_that_is_more_than_proved() {
        for (text, below, above) in [
            ("65533/65536", "99.99 %", "100 %"),
            ("3/65536", "0.004577 %", "0.004578 %"),
            ("9/16", "56.25 %", "56.25 %"),
            ("1", "100 %", "100 %"),
            ("0", "0 %", "0 %"),
            ("1/1000000000", "1e-7 %", "1e-7 %"),
            ("1/3000000000", "3.333e-8 %", "3.334e-8 %"),
        ] {
            assert_eq!(percent(&exact(text), 4, Toward::Below), below, "{text}");
            assert_eq!(percent(&exact(text), 4, Toward::Above), above, "{text}");
        }
    }

    #[test]
    fn doubles_are_shown_without_trailing_zeros() {
        for (value, shown) in [
            (2.0, "2"),
            (2.000_000_000_1, "2"),
            (2.005_041_23, "2.00504123"),
            (-73.205_080_756_9, "-73.2050808"),
            (1.5e-7, "1.5e-7"),
            (0.00012, "0.00012"),
            (0.0, "0"),
        ] {
            assert_eq!(significant(value, 9), shown);
        }
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(grouped(999), "999");
    }
}
