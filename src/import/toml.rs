//! Design files, written: numbers as the configuration has them, coordinates of angles, tables.

use super::error::printable;
use super::Imported;
use crate::exact::Exact;
use crate::files::shown::Shown;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use orthocert_kernel::fixed::Interval;
use orthocert_kernel::trig::cos_sin;
use std::cmp::Ordering;

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
    /// The number that a controller reads: a decimal, perhaps `.5`, `5.` or `+5`; no expression.
    pub fn parse(text: &str) -> Option<Number> {
        let text = text.trim();
        let (sign, digits) = match text.strip_prefix('-') {
            Some(digits) => ("-", digits),
            None => ("", text.strip_prefix('+').unwrap_or(text)),
        };
        let (mantissa, exponent) = match digits.find(['e', 'E']) {
            Some(at) => (&digits[..at], Some(&digits[at + 1..])),
            None => (digits, None),
        };
        let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let are_digits = |text: &str| text.chars().all(|c| c.is_ascii_digit());
        let power = exponent.map(|text| text.strip_prefix(['-', '+']).unwrap_or(text));
        if (whole.is_empty() && part.is_empty())
            || !are_digits(whole)
            || !are_digits(part)
            || power.is_some_and(|power| power.is_empty() || !are_digits(power))
        {
            return None;
        }
        // TOML has no leading zeros.
        let whole = whole.trim_start_matches('0');
        let whole = if whole.is_empty() { "0" } else { whole };
        let point = if part.is_empty() { "" } else { "." };
        let exponent = exponent.map(|text| format!("e{text}")).unwrap_or_default();
        let text = format!("{sign}{whole}{point}{part}{exponent}");
        let value = Exact::parse(&text, MAX_DIGITS).ok()?;
        value.as_rational()?;
        Some(Number { text, value })
    }

    /// A whole number.
    pub fn whole(n: i64) -> Number {
        Number { text: n.to_string(), value: Exact::integer(n) }
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

/// Decimals around the tangent of half of an angle in degrees, which is between -180 and 180.
pub(super) fn half_tangent(degrees: &Number) -> Option<[String; 2]> {
    if degrees.value.sign() == Some(0) {
        return Some(["0".to_owned(), "0".to_owned()]);
    }
    let half = degrees.value.clone().over(Exact::integer(2)).ok()?;
    let [cos, sin] = cos_sin(|bits| half.enclose(bits), BITS)?;
    let quotient = |sin: &BigInt, up: bool| {
        // The smaller divisor gives the greater quotient in size.
        let cos = if up == (*sin > BigInt::zero()) { &cos.lo } else { &cos.hi };
        (*cos > BigInt::zero()).then(|| decimal(sin, cos, up))
    };
    Some([quotient(&sin.lo, false)?, quotient(&sin.hi, true)?])
}

/// `n/d` in [`PLACES`] places, rounded down or up.
fn decimal(n: &BigInt, d: &BigInt, up: bool) -> String {
    let ten = BigInt::from(10).pow(PLACES);
    let (floor, rest) = (n * &ten).div_mod_floor(d);
    let digits = if up && !rest.is_zero() { floor + 1 } else { floor };
    let sign = if digits < BigInt::zero() { "-" } else { "" };
    let (whole, part) = digits.magnitude().div_rem(ten.magnitude());
    format!("{sign}{whole}.{part:0>18}")
}

/// `(sin, -cos)`, likewise: horizontal axes for which arms count upwards; negated, downwards.
fn axis(degrees: &Number, downwards: bool) -> Option<[String; 2]> {
    let quarter = Exact::integer(if downwards { 270 } else { 90 });
    let right = degrees.value.clone().minus(quarter).ok()?;
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
    let [cos, sin] = cos_sin(|bits| degrees.enclose(bits), BITS)?;
    let one = BigInt::from(1) << BITS;
    let around = |x: &Interval<BigInt>| {
        Component::Between(decimal(&x.lo, &one, false), decimal(&x.hi, &one, true))
    };
    Some([around(&cos), around(&sin)])
}

fn value(component: &Component, radius: Option<&Number>) -> String {
    match (component, radius) {
        (Component::Exactly("0"), _) => "0".to_owned(),
        (Component::Exactly(x @ ("1" | "-1")), None) => (*x).to_owned(),
        (Component::Exactly(x), None) => quoted(x),
        (Component::Exactly("1"), Some(r)) => quoted(&r.text),
        (Component::Exactly("-1"), Some(r)) => quoted(&format!("-{}", r.text)),
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

/// The least of some numbers written as expressions, and its value; the first of those that cannot
/// be told apart. `None` if one of them is no number.
pub(super) fn least(expressions: &[String]) -> Option<(String, Exact)> {
    outermost(expressions, Ordering::Less)
}

/// The greatest, likewise.
pub(super) fn greatest(expressions: &[String]) -> Option<(String, Exact)> {
    outermost(expressions, Ordering::Greater)
}

fn outermost(expressions: &[String], order: Ordering) -> Option<(String, Exact)> {
    let parse = |text: &String| Some((text.clone(), Exact::parse(text, MAX_DIGITS).ok()?));
    let parsed = expressions.iter().map(parse).collect::<Option<Vec<_>>>()?;
    parsed.into_iter().reduce(|best, next| match next.1.compare(&best.1) {
        Some(found) if found == order => next,
        _ => best,
    })
}

/// Whether the number that `a` is, as an expression, is provably less than `b`.
pub(super) fn less(a: &str, b: &str) -> bool {
    let [a, b] = [a, b].map(|text| Exact::parse(text, MAX_DIGITS).ok());
    a.zip(b).and_then(|(a, b)| a.compare(&b)) == Some(Ordering::Less)
}

/// What an importer makes of a configuration.
pub(super) struct Machine {
    /// What it is, for the title.
    pub title: &'static str,
    /// How its platform moves.
    pub kind: &'static str,
    /// Its unit of length, where that is known.
    pub unit: Option<&'static str>,
    /// The legs' tables, in the order of the firmware's joints.
    pub legs: Vec<String>,
    /// The lines of `[workspace]`.
    pub workspace: String,
    /// Those of `[requirements]`.
    pub requirements: String,
}

/// A rod on a vertical guide whose foot is at `(x, y)`, values of a design; the carriage is above
/// the platform and `rho` its height, less `base`.
pub(super) fn slider(label: &str, [x, y]: &[String; 2], base: &str, length: &str) -> String {
    format!(
        "[[mechanism.legs]]                 # {label}\ndrive = \"slider\"\ndirection = [0, 0, 1]\n\
         anchor = [{x}, {y}, {base}]\nlength = {length}\nmode = \"-\"\n"
    )
}

/// An arm of a rotary Delta: all but its angle as values of a design.
pub(super) struct Arm<'a> {
    /// A comment.
    pub label: &'a str,
    /// Where it stands, in degrees about z.
    pub degrees: &'a Number,
    /// Distance of its axis from z, greater than 0.
    pub radius: &'a Number,
    /// Height of its axis.
    pub height: &'a str,
    /// Length of the arm.
    pub upper: &'a str,
    /// Length of the rod.
    pub lower: &'a str,
    /// Distance of the rod's lower end from the controlled point; `None` is 0.
    pub foot: Option<&'a Number>,
    /// Whether angles count downwards from the horizontal, not upwards.
    pub downwards: bool,
}

impl Arm<'_> {
    /// Its leg, with the elbow outside and the platform below; `None` beyond a turn.
    pub fn leg(&self) -> Option<String> {
        let [x, y] = polar(self.degrees, Some(self.radius))?;
        let [e_x, e_y] = polar(self.degrees, None)?;
        let [k_x, k_y] = axis(self.degrees, self.downwards)?;
        let foot = match self.foot {
            Some(foot) => {
                let [d_x, d_y] = polar(self.degrees, Some(foot))?;
                format!("platform = [{d_x}, {d_y}, 0]\n")
            }
            None => String::new(),
        };
        let mode = if self.downwards { "+" } else { "-" };
        Some(format!(
            "[[mechanism.legs]]                 # {}\ndrive = \"arm\"\nanchor = [{x}, {y}, {}]\n\
             axis = [{k_x}, {k_y}, 0]\nreference = [{e_x}, {e_y}, 0]\narm = {}\nlength = {}\n\
             {foot}mode = \"{mode}\"\n",
            self.label, self.height, self.upper, self.lower
        ))
    }
}

/// An extensible leg from `(x, y, 0)`; `rho` is its length.
pub(super) fn strut(label: &str, x: &str, y: &str) -> String {
    format!(
        "[[mechanism.legs]]                 # {label}\ndrive = \"strut\"\nanchor = [{x}, {y}, 0]\n"
    )
}

/// Bounds on the factors of sliders and struts, to be changed.
pub(super) const FACTORS: &str = "transmission = { min = \"1/4\", max = 4 }\n";

/// The same of arms of length `arm`.
pub(super) fn factors_per_radian(arm: &Number) -> String {
    let arm = &arm.text;
    format!("transmission = {{ min = \"{arm}/4\", max = \"{arm}*4\" }} # length per radian\n")
}

/// A cylinder about z; `radius` and the heights are expressions.
pub(super) fn cylinder(radius: &str, [low, high]: [&str; 2]) -> String {
    let [radius, low, high] = [radius, low, high].map(quoted);
    format!("cylinder = {{ center = [0, 0], radius = {radius}, z = [{low}, {high}] }}\n")
}

/// The design file, with all that is to be said of the import as comments; `name` is of the
/// configuration.
pub(super) fn document(name: &str, machine: &Machine, imported: &Imported) -> String {
    let mut text = String::new();
    let title = machine.title;
    comment(&mut text, &format!("{title}, imported from {}.", printable(name)));
    let mut list = |heading: &str, items: Vec<String>| {
        if !items.is_empty() {
            comment(&mut text, heading);
        }
        items.iter().for_each(|item| comment(&mut text, &format!("- {item}")));
    };
    list("Read:", imported.used.iter().map(ToString::to_string).collect());
    list("The firmware's defaults:", imported.defaults.iter().map(ToString::to_string).collect());
    list(
        "Not understood, and ignored:",
        imported.ignored.iter().map(ToString::to_string).collect(),
    );
    list("Not in the configuration, or not expressible here:", imported.not_carried_over.clone());
    let unit = machine.unit.map_or_else(String::new, |unit| format!("unit = \"{unit}\"\n"));
    text.push_str(&format!(
        "\ntitle = \"{title}\"\n{unit}\n[mechanism]\nkind = \"{}\"\n\n{}\n[workspace]\n{}\n\
         [requirements]\n{}",
        machine.kind,
        machine.legs.join("\n"),
        machine.workspace,
        machine.requirements
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
