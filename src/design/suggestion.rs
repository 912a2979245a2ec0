//! "Did you mean": the nearest accepted word to a misspelt one, and what other slips seem to mean.

use super::UNITS;

/// What is called otherwise here: the names that others have for it.
const OTHERWISE: [(&str, &[&str]); 20] = [
    ("slider", &["prismatic", "linear", "guide", "rail", "prs", "pus", "puu"]),
    ("arm", &["rotary", "revolute", "crank", "motor", "rss", "rus"]),
    ("strut", &["extensible", "actuator", "cylinder", "jack", "ups", "sps", "upu"]),
    ("in", &["inch", "inches", "zoll"]),
    ("mm", &["millimetre", "millimeter", "millimetres", "millimeters"]),
    ("cm", &["centimetre", "centimeter", "centimetres", "centimeters"]),
    ("m", &["metre", "meter", "metres", "meters"]),
    ("um", &["µm", "μm", "micron", "microns", "micrometre", "micrometer"]),
    ("radius", &["diameter"]),
    ("length", &["leg_length", "rod_length", "arm_length"]),
    ("arm", &["crank_length", "arm_length"]),
    ("transmission", &["psi", "velocity", "transmission_factor", "transmission_factors"]),
    ("conditioning", &["condition", "condition_number"]),
    ("joint_range", &["stroke", "strokes", "joint_limits", "rho"]),
    ("clearance", &["collision", "collisions"]),
    ("mechanism", &["machine", "robot"]),
    ("requirements", &["constraints", "limits", "bounds"]),
    ("z", &["height"]),
    ("min", &["minimum", "least"]),
    ("max", &["maximum", "greatest"]),
];

/// The word of `accepted` that a word in small letters is another name of.
fn otherwise<'a>(word: &str, accepted: &[&'a str]) -> Option<&'a str> {
    let is_of =
        |name: &&&str| OTHERWISE.iter().any(|(known, all)| known == *name && all.contains(&word));
    accepted.iter().find(is_of).copied()
}

/// `"; did you mean ...?"` for the word of `accepted` that `word` is another name of, or else is nearest to
/// it, as `show` writes it; empty if there is none.
pub(super) fn hint(word: &str, accepted: &[&str], show: impl Fn(&str) -> String) -> String {
    let word = word.to_lowercase();
    if let Some(name) = otherwise(&word, accepted) {
        let half = if word == "diameter" { ", half of it" } else { "" };
        return format!("; did you mean {}{half}?", show(name));
    }
    let ranked = accepted.iter().map(|name| (distance(&word, name), *name));
    let near =
        |(edits, name): &(usize, &str)| *edits <= name.len().div_ceil(3) && *edits < name.len();
    match ranked.filter(near).min() {
        Some((_, name)) => format!("; did you mean {}?", show(name)),
        None => String::new(),
    }
}

/// What a number with a unit behind it could be instead: `"333 mm"`, where it ceases to be a number at `at`.
pub(super) fn without_unit(text: &str, at: usize) -> Option<String> {
    let rest = text.get(at..)?.trim_start();
    let end = rest.find(|c: char| !c.is_alphabetic() && c != '°').unwrap_or(rest.len());
    let written = &rest[..end];
    if written.is_empty() || text.get(..at)?.trim().is_empty() {
        return None;
    }
    // The tolerance may have the unit, too.
    let number = text.split(written).map(|part| match part.strip_prefix('/') {
        // Of a quotient of units what it is divided by goes, too.
        Some(by) => by.trim_start_matches(|c: char| !c.is_whitespace()).trim(),
        None => part.trim(),
    });
    let number: Vec<&str> = number.collect();
    let number = number.join(" ").trim_end().to_owned();
    let unit = UNITS.into_iter().find(|unit| *unit == written);
    match unit.or_else(|| otherwise(&written.to_lowercase(), &UNITS)) {
        Some(unit) => Some(format!(
            "{number:?}, and unit = {unit:?} above the tables to name the unit of all lengths"
        )),
        None if ["deg", "°", "degree", "degrees"].contains(&written) => {
            Some(format!("{number:?}, in degrees where a key says so"))
        }
        None => None,
    }
}

/// How a number is written that is written otherwise from character `at` on: with a decimal comma, a share, a
/// power, a function.
pub(super) fn notation(text: &str, at: usize) -> Option<&'static str> {
    let rest = text.get(at..)?.trim_start();
    match rest.chars().next()? {
        ',' => Some("a point begins the decimals: 333.5"),
        '%' => Some("tolerances have the unit of their number: \"333 ± 0.1\""),
        '^' | '*' => Some("a power is a product: \"18*18\""),
        c if c.is_alphabetic() && !rest.starts_with("sqrt") => {
            Some("of names and functions there is sqrt alone: of others, the decimals")
        }
        _ => None,
    }
}

/// What the machines of other names are here.
pub(super) fn kind_of(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase().replace(['_', ' '], "-");
    let is_of = |names: &[&str]| names.contains(&word.as_str());
    if is_of(&["delta", "linear-delta", "rotary-delta", "tripod", "3-upu", "tripteron", "linapod"])
    {
        Some("translational")
    } else if is_of(&["hexapod", "stewart", "gough-stewart", "stewart-platform", "hexaglide"]) {
        Some("spatial")
    } else if is_of(&["five-bar", "3-rpr", "3-rrr", "3-prr"]) {
        Some("planar")
    } else {
        None
    }
}

/// Keys of a mechanism that are lists of tables.
pub(super) const LISTS: [&str; 3] = ["legs", "joints", "bodies"];

/// The table that a key belongs to, of those that are in one alone.
pub(super) fn home_of(key: &str) -> Option<&'static str> {
    const MECHANISM: [&str; 7] =
        ["kind", "legs", "leg_length", "characteristic_length", "coordinates", "joints", "bodies"];
    match key {
        "cylinder" | "cube" | "orientation" => Some("[workspace]"),
        _ if MECHANISM.contains(&key) => Some("[mechanism]"),
        _ => super::requirements::is_key(key).then_some("[requirements]"),
    }
}

/// Which command reads the files that have such a table.
pub(super) fn file_with(table: &str) -> Option<&'static str> {
    matches!(table, "parameters" | "atlas").then_some("maps: `orthocert atlas` reads them")
}

/// Longest word, in characters, that is compared.
const LONGEST: usize = 40;

/// The least number of insertions, deletions, replacements and exchanges of neighbours that turn
/// `from` into `to` (optimal string alignment).
fn distance(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    if from.len() > LONGEST || to.len() > LONGEST {
        return usize::MAX;
    }
    // rows[i][j]: from the first i characters of `from` to the first j of `to`.
    let mut rows = vec![vec![0; to.len() + 1]; from.len() + 1];
    for i in 0..=from.len() {
        for j in 0..=to.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = rows[i - 1][j - 1] + usize::from(from[i - 1] != to[j - 1]);
                let least = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
                let exchanged =
                    i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
                if exchanged {
                    least.min(rows[i - 2][j - 2] + 1)
                } else {
                    least
                }
            };
        }
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_edits() {
        for (from, to, edits) in [
            ("", "", 0),
            ("", "abc", 3),
            ("base", "base", 0),
            ("lenght", "length", 1),
            ("leg-length", "leg_length", 1),
            ("kitten", "sitting", 3),
        ] {
            assert_eq!(distance(from, to), edits, "{from} {to}");
            assert_eq!(distance(to, from), edits, "{to} {from}");
        }
    }

    #[test]
    fn only_near_words_are_suggested() {
        let hint = |word| hint(word, &["min", "max", "leg_length"], |w| w.to_owned());
        assert_eq!(hint("leg_lenght"), "; did you mean leg_length?");
        assert_eq!(hint("LegLength"), "; did you mean leg_length?");
        assert_eq!(hint("mx"), "; did you mean max?");
        assert_eq!(hint("speed"), "");
        assert_eq!(hint(&"m".repeat(1000)), "");
    }

    #[test]
    fn other_names_are_known() {
        let hint = |word, accepted: &[&str]| hint(word, accepted, |w| w.to_owned());
        assert_eq!(hint("Prismatic", &["slider", "strut"]), "; did you mean slider?");
        assert_eq!(hint("inch", &["mm", "in"]), "; did you mean in?");
        assert_eq!(hint("psi", &["transmission", "stiffness"]), "; did you mean transmission?");
        assert_eq!(hint("leg_length", &["drive", "length"]), "; did you mean length?");
        assert_eq!(hint("leg_length", &["drive", "mode"]), "");
        assert_eq!(hint("diameter", &["center", "radius"]), "; did you mean radius, half of it?");
    }

    #[test]
    fn units_are_left_out_of_tolerances_too() {
        for (text, at, number) in [
            ("333 mm", 4, "\"333\", and unit = \"mm\""),
            ("333mm ± 0.05mm", 3, "\"333 ± 0.05\", and unit = \"mm\""),
            ("333 mm ± 0.05", 4, "\"333 ± 0.05\", and unit = \"mm\""),
            ("333 millimeters", 4, "\"333\", and unit = \"mm\""),
            ("5 µm", 2, "\"5\", and unit = \"um\""),
            ("1000 mm/s", 5, "\"1000\", and unit = \"mm\""),
            ("1000 mm/s ± 5e-1 mm/s", 5, "\"1000 ± 5e-1\", and unit = \"mm\""),
            ("sqrt(2) mm/s", 8, "\"sqrt(2)\", and unit = \"mm\""),
            ("45°", 2, "\"45\", in degrees"),
        ] {
            let found = without_unit(text, at).unwrap_or_default();
            assert!(found.starts_with(number), "{text}: {found}");
        }
        for (text, at) in [("mm", 0), ("3 pi", 2), ("333,5", 3)] {
            assert_eq!(without_unit(text, at), None, "{text}");
        }
    }
}
