//! A kernel claim in words and tables: machine, workspace, requirements, parameters.

use crate::exact::decimal::begun;
use crate::exact::Exact;
use crate::report::escape::xml;
use crate::report::facts::parameter;
use crate::search::solver::value::name_of;
use orthocert_kernel::claim::{
    Bound, Leg, MachineClaim, Mechanism, Orientation, Quantity, Requirement, Workspace,
};
use orthocert_kernel::number::Expression;
use orthocert_kernel::quantity::TABLE;
use std::fmt::Write;

/// Longest name of a requirement in a table.
const SHORT: usize = 48;

/// Most digits of a number that is shown whole; the statement has all of it.
pub const LONGEST: u32 = 20;

/// A number as a decimal; where that has too many digits, those that it begins with, and an ellipsis.
pub fn number(x: &Expression) -> String {
    Exact::of(x).map_or_else(|| x.to_string(), |x| begun(&x, LONGEST))
}

fn numbers(all: &[Expression]) -> String {
    all.iter().map(number).collect::<Vec<_>>().join(", ")
}

fn range(min: &Expression, max: &Expression) -> String {
    format!("[{}, {}]", number(min), number(max))
}

/// The machine, on a line.
pub fn machine(claim: &MachineClaim) -> String {
    let kind = match &claim.mechanism {
        Mechanism::Translational(_) => "translational machine",
        Mechanism::Orthoglide { .. } => {
            return "The Orthoglide of the paper's Steps 1 to 3".to_owned()
        }
        Mechanism::Planar(_) if claim.orientation.is_some() => "planar machine",
        Mechanism::Planar(_) => "machine that moves a point in the plane",
        Mechanism::Spatial(_) => "machine with six degrees of freedom",
        Mechanism::Spherical(_) => "spherical machine",
        Mechanism::Formulas(formulas) => {
            let tolerances = formulas.parameters.iter().filter(|(_, q)| is_interval(q)).count();
            let (names, joints) = (formulas.coordinates.join(", "), formulas.joints.len());
            let every = if tolerances == 0 { "The mechanism" } else { "Every mechanism" };
            return format!(
                "{every} with the coordinates {names} and the inverse kinematics of {joints} joints{}",
                within(tolerances)
            );
        }
    };
    let legs = claim.mechanism.legs();
    let mut drives: Vec<(&str, usize)> = Vec::new();
    for leg in legs {
        let name = drive(leg);
        match drives.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => drives.push((name, 1)),
        }
    }
    let of = |(name, count): &(&str, usize)| match count {
        1 => format!("one {name}"),
        _ => format!("{} {name}s", count_in_words(*count)),
    };
    let drives: Vec<String> = drives.iter().map(of).collect();
    let quantities = legs.iter().flat_map(Leg::quantities).flat_map(|(_, _, all)| all);
    let tolerances = quantities.filter(|q| is_interval(q)).count();
    let every = if tolerances == 0 { "A" } else { "Every" };
    format!("{every} {kind} of {}{}", drives.join(" and "), within(tolerances))
}

fn within(tolerances: usize) -> String {
    match tolerances {
        0 => String::new(),
        1 => " within one tolerance".to_owned(),
        n => format!(" within {n} tolerances"),
    }
}

fn is_interval(quantity: &Quantity) -> bool {
    matches!(quantity, Quantity::Between { .. })
}

fn drive(leg: &Leg) -> &'static str {
    match leg {
        Leg::Slider { .. } => "slider",
        Leg::Strut { .. } => "strut",
        Leg::Arm { .. } => "arm",
        Leg::Planar { .. } => "planar leg",
    }
}

fn count_in_words(n: usize) -> String {
    let small = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"];
    small.get(n).map_or_else(|| n.to_string(), ToString::to_string)
}

/// The workspace, on a line.
pub fn workspace(claim: &MachineClaim) -> String {
    let positions = match &claim.workspace {
        Workspace::Cube { side } => Some(format!("the closed cube of side {}", number(side))),
        Workspace::Box { min, max } if !min.is_empty() => {
            let edges: Vec<String> =
                min.iter().zip(max).map(|(min, max)| range(min, max)).collect();
            let what = match edges.len() {
                1 => "the interval",
                2 => "the rectangle",
                _ => "the box",
            };
            Some(format!("{what} {}", edges.join(" \u{d7} ")))
        }
        Workspace::Box { .. } => None,
        Workspace::Cylinder { center, radius, z: [low, high] } => Some(format!(
            "the cylinder of radius {} about ({}), {} \u{2264} z \u{2264} {}",
            number(radius),
            numbers(center),
            number(low),
            number(high)
        )),
    };
    let orientations = claim.orientation.as_ref().map(|orientation| match orientation {
        Orientation::Angle(angle) => format!("turned by at most {}\u{b0} about any axis", number(angle)),
        Orientation::Tilt { tilt, torsion } => format!(
            "tilted by at most {}\u{b0} in any direction, with a torsion of at most {}\u{b0} either way",
            number(tilt),
            number(torsion)
        ),
        Orientation::RollPitchYaw { roll, pitch, yaw } => {
            let [roll, pitch, yaw] = [roll, pitch, yaw].map(|[min, max]| range(min, max));
            format!("roll in {roll}, pitch in {pitch}, yaw in {yaw}, in degrees")
        }
        Orientation::Range([min, max]) => {
            format!("turned by an angle in {}, in degrees", range(min, max))
        }
    });
    [positions, orientations].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// What is bounded, in words: the quantity, its symbol, the leg and what it is for.
pub fn quantity(requirement: &Requirement) -> String {
    let known = TABLE.iter().find(|known| known.key == requirement.quantity);
    let mut out = match known {
        Some(known) => {
            let words = match known.key {
                margin @ ("serial_margin" | "parallel_margin") => name_of(margin),
                _ => known.words.to_owned(),
            };
            format!("{words}: {}", known.symbol)
        }
        None => requirement.quantity.clone(),
    };
    if let Some(leg) = requirement.leg {
        let _ = write!(out, ", leg {leg}");
    }
    for (name, given) in &requirement.given {
        let _ = write!(out, ", {name} = {}", numbers(given));
    }
    out
}

/// The same where it is short, else by its key.
pub fn short(requirement: &Requirement) -> String {
    let words = quantity(requirement);
    if words.chars().count() <= SHORT {
        return words;
    }
    let mut out = name_of(&requirement.quantity);
    for (name, given) in &requirement.given {
        let _ = write!(out, ", {} = {}", name.replace('_', " "), numbers(given));
    }
    out
}

/// The bound, in words.
pub fn bound(bound: &Bound) -> String {
    match bound {
        Bound::Min(bound) => format!("at least {}", number(bound)),
        Bound::Max(bound) => format!("at most {}", number(bound)),
        Bound::Within([min, max]) => format!("from {} to {}", number(min), number(max)),
        Bound::Holds => "holds".to_owned(),
    }
}

/// The requirement as a formula: `psi_i <= 2`.
pub fn formula(requirement: &Requirement) -> String {
    let known = TABLE.iter().find(|known| known.key == requirement.quantity);
    let symbol = known.map_or(requirement.quantity.as_str(), |known| known.symbol);
    let of = requirement.leg.map_or(String::new(), |leg| format!(", leg {leg}"));
    let text = match &requirement.bound {
        Bound::Min(bound) => format!("{symbol} \u{2265} {}", number(bound)),
        Bound::Max(bound) => format!("{symbol} \u{2264} {}", number(bound)),
        Bound::Within([min, max]) => {
            format!("{} \u{2264} {symbol} \u{2264} {}", number(min), number(max))
        }
        Bound::Holds => symbol.to_owned(),
    };
    text + &of
}

/// Letters by their names: first those that have one for each leg.
pub const LETTERS: [(&str, char); 8] = [
    ("psi", '\u{3c8}'),
    ("rho", '\u{3c1}'),
    ("eta", '\u{3b7}'),
    ("kappa", '\u{3ba}'),
    ("theta", '\u{3b8}'),
    ("omega", '\u{3c9}'),
    ("sigma", '\u{3c3}'),
    ("ell", '\u{2113}'),
];

/// The table's symbols of a leg, and how the paper writes them.
fn of_legs_letters() -> impl Iterator<Item = (String, char)> {
    LETTERS.into_iter().take(3).map(|(name, letter)| (format!("{name}_i"), letter))
}

/// A formula in Greek letters, with this index.
pub fn greek(formula: &str, index: &str) -> String {
    let written = |text: String, (name, letter): (String, char)| {
        text.replace(&name, &format!("{letter}{index}"))
    };
    of_legs_letters().fold(formula.to_owned(), written)
}

/// A requirement over a picture: its name, and its formula where that has a letter for it.
pub fn heading(requirement: &Requirement) -> String {
    let known = TABLE.iter().find(|known| known.key == requirement.quantity);
    let name = name_of(&requirement.quantity);
    let formula = formula(requirement);
    match known {
        Some(known) if is_letter(known.symbol) => typeset(&format!("{name}: {formula}")),
        Some(known) => formula.replacen(known.symbol, &name, 1),
        None => formula,
    }
}

/// Whether a symbol is one of a leg, that papers have a letter for.
fn is_letter(symbol: &str) -> bool {
    of_legs_letters().any(|(name, _)| name == symbol)
}

/// A requirement in letters and signs as papers have them: `greatest psi <= 2`, `rho_1`.
pub fn typeset(text: &str) -> String {
    let text = greek(text, "\u{1d62}").replace("<=", "\u{2264}").replace(">=", "\u{2265}");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once("rho_") {
        let digits = after.chars().take_while(char::is_ascii_digit).count();
        out.push_str(before);
        out.push_str(if digits > 0 { "\u{3c1}" } else { "rho_" });
        out.push_str(&subscript(&after[..digits]));
        rest = &after[digits..];
    }
    out.push_str(rest);
    let letter = |word: &str| match word {
        "psi" => "\u{3c8}".to_owned(),
        "psi," => "\u{3c8},".to_owned(),
        other => other.to_owned(),
    };
    out.split(' ').map(letter).collect::<Vec<_>>().join(" ")
}

/// Digits below the line.
pub fn subscript(digits: &str) -> String {
    let below = |digit: char| char::from_u32(0x2080 + digit.to_digit(10)?);
    digits.chars().filter_map(below).collect()
}

/// The machine's numbers, exactly.
pub fn parameters(claim: &MachineClaim) -> String {
    match &claim.mechanism {
        Mechanism::Formulas(formulas) => {
            let rows = formulas.parameters.iter().map(|(name, q)| (name.clone(), vec![value(q)]));
            table(&["value".to_owned()], &rows.collect::<Vec<_>>())
        }
        mechanism => of_legs(mechanism.legs()),
    }
}

fn of_legs(legs: &[Leg]) -> String {
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    let mut put = |name: &str, leg: usize, text: String| {
        let at = rows.iter().position(|(known, _)| known == name).unwrap_or_else(|| {
            rows.push((name.to_owned(), vec![String::new(); legs.len()]));
            rows.len() - 1
        });
        rows[at].1[leg] = text;
    };
    for (i, leg) in legs.iter().enumerate() {
        put("drive", i, drive(leg).to_owned());
        // An arm in the plane has no axis.
        for (key, _, quantities) in leg.quantities().into_iter().filter(|(.., all)| !all.is_empty())
        {
            put(key, i, quantities.iter().map(value).collect::<Vec<_>>().join(", "));
        }
        if let Leg::Slider { mode, .. } | Leg::Arm { mode, .. } = leg {
            put("mode", i, if mode.as_integer() > 0 { "+" } else { "\u{2212}" }.to_owned());
        }
    }
    let heads: Vec<String> = (1..=legs.len()).map(|i| format!("leg {i}")).collect();
    table(&heads, &rows)
}

/// The machine of a counterexample, leg by leg: places as the kernel names them (`leg 1: direction.0`), and
/// their values.
pub fn of_witness<'a>(legs: usize, all: impl Iterator<Item = (&'a str, String)>) -> String {
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    let mut is_of_legs = false;
    for (place, value) in all {
        let (leg, name) = parameter(place);
        let leg = leg.filter(|leg| (1..=legs).contains(leg)).unwrap_or(0);
        is_of_legs |= leg > 0;
        let at = rows.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
            rows.push((name, vec![String::new(); legs.max(1)]));
            rows.len() - 1
        });
        rows[at].1[leg.saturating_sub(1)] = value;
    }
    let heads: Vec<String> = match is_of_legs {
        true => (1..=legs).map(|i| format!("leg {i}")).collect(),
        false => {
            rows.iter_mut().for_each(|(_, values)| values.truncate(1));
            vec!["value".to_owned()]
        }
    };
    table(&heads, &rows)
}

fn table(heads: &[String], rows: &[(String, Vec<String>)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut out = "<div class=\"table\"><table><thead><tr><th>parameter</th>".to_owned();
    for head in heads {
        let _ = write!(out, "<th>{head}</th>");
    }
    out.push_str("</tr></thead><tbody>");
    for (name, values) in rows {
        let _ = write!(out, "<tr><td>{}</td>", xml(name));
        for value in values {
            let _ = write!(out, "<td>{}</td>", xml(value));
        }
        out.push_str("</tr>");
    }
    out + "</tbody></table></div>"
}

fn value(quantity: &Quantity) -> String {
    match quantity {
        Quantity::Exactly(x) => number(x),
        Quantity::Between { min, max } => format!("{} to {}", number(min), number(max)),
    }
}

/// The drives that a claim's legs have, as rules of their kinematics name them.
pub fn drives(claim: &MachineClaim) -> Vec<&'static str> {
    match &claim.mechanism {
        Mechanism::Orthoglide { .. } => vec!["slider"],
        mechanism => mechanism.legs().iter().map(drive).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requirements_have_the_letters_of_papers() {
        assert_eq!(typeset("greatest psi <= 2"), "greatest \u{3c8} \u{2264} 2");
        assert_eq!(typeset("least psi, length/rad >= 5"), "least \u{3c8}, length/rad \u{2265} 5");
        assert_eq!(typeset("rho_12, deg in [0, 62]"), "\u{3c1}\u{2081}\u{2082}, deg in [0, 62]");
        assert_eq!(typeset("the end of rho_"), "the end of rho_");
    }

    #[test]
    fn the_machine_of_a_counterexample_is_told_leg_by_leg() {
        let all = [("leg 1: anchor.0", "7"), ("leg 3: anchor.0", "8"), ("leg 3: length", "9")];
        let found = of_witness(3, all.into_iter().map(|(place, x)| (place, x.to_owned())));
        assert!(found.contains("<td>anchor x</td><td>7</td><td></td><td>8</td>"), "{found}");
        assert!(found.contains("<td>length</td><td></td><td></td><td>9</td>"), "{found}");
        let found = of_witness(0, [("l", "5".to_owned())].into_iter());
        assert!(found.contains("<th>value</th>") && found.contains("<td>l</td><td>5</td>"));
        assert_eq!(of_witness(3, std::iter::empty()), "");
    }
}
