//! Design files, written: numbers as the configuration has them, coordinates of angles, tables.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use orthocert_checker::number::Exact;
use orthocert_checker::shown::Shown;
use orthocert_checker::trig::cos_sin;

/// A decimal number, as text that a design reads exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Number {
    /// The literal.
    pub text: String,
    /// Its value.
    pub value: Exact,
}

/// Most digits of a literal.
const MAX_DIGITS: usize = 1000;
/// Decimal places of enclosures of cosines and sines.
const PLACES: u32 = 18;
/// Fractional bits in which they are computed.
const BITS: u32 = 96;

impl Number {
    /// The number that a controller reads: a decimal, perhaps `.5`, `5.` or `+5`.
    pub fn parse(text: &str) -> Option<Number> {
        let text = text.trim();
        let (sign, digits) = match text.strip_prefix('-') {
            Some(digits) => ("-", digits),
            None => ("", text.strip_prefix('+').unwrap_or(text)),
        };
        let (mantissa, exponent) = match digits.find(['e', 'E']) {
            Some(at) => digits.split_at(at),
            None => (digits, ""),
        };
        let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if (whole.is_empty() && part.is_empty())
            || !digits.starts_with(['.', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'])
        {
            return None;
        }
        let whole = if whole.is_empty() { "0" } else { whole };
        let point = if part.is_empty() { "" } else { "." };
        let text = format!("{sign}{whole}{point}{part}{exponent}");
        let value = Exact::parse(&text, MAX_DIGITS).ok()?;
        value.as_rational()?;
        Some(Number { text, value })
    }

    /// Whether the number is greater than zero.
    pub fn is_positive(&self) -> bool {
        self.value.sign() == Some(1)
    }
}

/// A cosine or sine.
enum Component {
    /// An expression.
    Exactly(&'static str),
    /// Decimals around it.
    Between(String, String),
}

/// `(cos, sin)` of an angle in degrees as values of a design, times `radius`, which is positive, or
/// one. `None` beyond a turn.
pub(super) fn polar(degrees: &Number, radius: Option<&Number>) -> Option<[String; 2]> {
    let components = components(&degrees.value)?;
    Some(components.map(|component| value(&component, radius)))
}

/// `(sin, -cos)`, likewise: horizontal axes for which arms count upwards.
pub(super) fn axis(degrees: &Number) -> Option<[String; 2]> {
    let right = degrees.value.clone().minus(Exact::integer(90)).ok()?;
    let components = components(&right)?;
    Some(components.map(|component| value(&component, None)))
}

fn components(degrees: &Exact) -> Option<[Component; 2]> {
    const COSINES: [&str; 12] = [
        "1",
        "sqrt(3)/2",
        "1/2",
        "0",
        "-1/2",
        "-sqrt(3)/2",
        "-1",
        "-sqrt(3)/2",
        "-1/2",
        "0",
        "1/2",
        "sqrt(3)/2",
    ];
    let steps = degrees.as_rational()? / BigRational::from_integer(30.into());
    if steps.is_integer() {
        let step = steps.to_integer().mod_floor(&BigInt::from(12)).to_usize()?;
        let sine = (step + 9) % 12;
        return Some([Component::Exactly(COSINES[step]), Component::Exactly(COSINES[sine])]);
    }
    let (cos, sin) = cos_sin(degrees, BITS)?;
    let ten = BigInt::from(10).pow(PLACES);
    let decimal = |n: &BigInt, up: bool| {
        let one = BigInt::from(1) << BITS;
        let (floor, rest) = (n * &ten).div_mod_floor(&one);
        let digits = if up && !rest.is_zero() { floor + 1 } else { floor };
        let sign = if digits < BigInt::zero() { "-" } else { "" };
        let (whole, part) = digits.magnitude().div_rem(ten.magnitude());
        format!("{sign}{whole}.{part:0>18}")
    };
    let around = |x: &orthocert_checker::fixed::Fixed| {
        Component::Between(decimal(x.lo(), false), decimal(x.hi(), true))
    };
    Some([around(&cos), around(&sin)])
}

fn value(component: &Component, radius: Option<&Number>) -> String {
    match (component, radius) {
        (Component::Exactly("0"), _) => "0".to_owned(),
        (Component::Exactly(x @ ("1" | "-1")), None) => (*x).to_owned(),
        (Component::Exactly(x), None) => quoted(x),
        (Component::Exactly("1"), Some(r)) => r.text.clone(),
        (Component::Exactly("-1"), Some(r)) => format!("-{}", r.text),
        (Component::Exactly(x), Some(r)) => {
            let (sign, rest) = x.strip_prefix('-').map_or(("", *x), |rest| ("-", rest));
            let product = match rest.strip_prefix("1/") {
                Some(divisor) => format!("{sign}{}/{divisor}", r.text),
                None => format!("{sign}{}*{rest}", r.text),
            };
            quoted(&product)
        }
        (Component::Between(min, max), None) => format!("{{ min = {min}, max = {max} }}"),
        (Component::Between(min, max), Some(r)) => {
            format!("{{ min = \"{0}*{min}\", max = \"{0}*{max}\" }}", r.text)
        }
    }
}

/// `text` in quotes; it has none itself.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

/// The least of some numbers written as expressions; the first of those that cannot be told apart.
pub(super) fn least(expressions: &[String]) -> Option<(String, Exact)> {
    let mut parsed = expressions
        .iter()
        .filter_map(|text| Exact::parse(text, MAX_DIGITS).ok().map(|value| (text.clone(), value)));
    let first = parsed.next()?;
    Some(parsed.fold(first, |best, next| match next.1.compare(&best.1) {
        Some(std::cmp::Ordering::Less) => next,
        _ => best,
    }))
}

/// A design file with these parts. Notes become comments; `name` is of the configuration.
pub(super) fn design(
    name: &str,
    machine: &str,
    legs: &[String; 3],
    workspace: &str,
    requirements: &str,
    notes: &[String],
) -> String {
    let mut text = String::new();
    comment(&mut text, &format!("{machine}, imported from {name}."));
    if !notes.is_empty() {
        comment(&mut text, "Not in the configuration, or not expressible here:");
    }
    for note in notes {
        comment(&mut text, &format!("- {note}"));
    }
    let [first, second, third] = legs;
    text.push_str(&format!(
        "\ntitle = \"{machine}\"\n\n[mechanism]\nkind = \"translational\"\n\n\
         {first}\n{second}\n{third}\n[workspace]\n{workspace}\n[requirements]\n{requirements}"
    ));
    text
}

/// Appends a comment, in lines of at most 100 characters.
fn comment(text: &mut String, sentence: &str) {
    let mut line = String::from("#");
    let one_line = Shown(sentence).to_string();
    for word in one_line.split(' ').filter(|word| !word.is_empty()) {
        if line.chars().count() + 1 + word.chars().count() > 100 {
            text.push_str(&line);
            text.push('\n');
            line = String::from("#  ");
        }
        line.push(' ');
        line.push_str(word);
    }
    text.push_str(&line);
    text.push('\n');
}
