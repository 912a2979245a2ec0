//! A summary for people: the verdict, the requirement nearest to its limit, then the table.

use super::shares::named;
use super::{Nearest, Shares, Summary, Value};
use crate::exact::decimal::{briefly, outward, percent, significant, Toward};
use crate::exact::Exact;
use crate::report::text::{describe_counterexample, headline_of, labelled, meaning, wrap, Style};
use crate::report::{machine_at_ends, placed, pose_text};
use crate::search::solver::value::{in_length, Coordinates};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::fmt::Write;

/// Significant digits of numbers that are longer.
const DIGITS: u32 = 6;
/// Digits of places, and of margins.
const FEW: u32 = 4;
/// Requirements that are named beside the nearest.
const OTHERS: usize = 3;
/// Rows of shares; what is more is one row.
const ROWS: usize = 12;

/// The first line.
pub fn headline(summary: &Summary, style: Style) -> String {
    let name = summary.title.as_deref().or(summary.design.as_deref()).unwrap_or("design");
    headline_of(summary.verdict, name, style)
}

/// The whole answer.
pub fn text(summary: &Summary, style: Style) -> String {
    let mut out = headline(summary, style);
    out.push('\n');
    meaning(&mut out, summary.verdict, summary.toleranced);
    if let Some(counterexample) = &summary.counterexample {
        describe_counterexample(&mut out, counterexample, &summary.coordinates, false);
    }
    if let Some(reason) = &summary.undecided {
        labelled(&mut out, "why", reason);
    }
    if let Some(found) = &summary.nearest {
        out.push('\n');
        nearest(&mut out, found, &summary.coordinates, summary.length_unit);
    }
    table(&mut out, &summary.values, summary.length_unit);
    if let Some(found) = &summary.accuracy {
        shares(&mut out, found);
    }
    if !summary.left_out.is_empty() {
        out.push('\n');
    }
    for sentence in &summary.left_out {
        wrap(&mut out, sentence, 2);
    }
    let _ = writeln!(out, "\n  {:.1} s", summary.seconds);
    out
}

fn nearest(out: &mut String, found: &Nearest, coordinates: &Coordinates, length: Option<&str>) {
    let part = |x: &Exact, toward| {
        let x = x.as_rational().cloned().unwrap_or_default();
        percent(&x, FEW - 1, toward)
    };
    let least = found.margin_at_least.as_rational().cloned().unwrap_or_default();
    let violated = found.margin_at_most.as_ref().and_then(Exact::as_rational);
    let margin = match (&found.margin_at_most, violated.is_some_and(Signed::is_negative)) {
        (Some(most), true) => {
            let most = most.as_rational().map_or_else(BigRational::default, |x| -x);
            format!("exceeded by {} or more", percent(&most, FEW - 1, Toward::Below))
        }
        (Some(most), false) if *most == found.margin_at_least => {
            format!("exactly {} left", part(most, Toward::Above))
        }
        (Some(most), false) if least.is_negative() => format!(
            "between exceeded by {} and {} left",
            percent(&-least, FEW - 1, Toward::Above),
            part(most, Toward::Above)
        ),
        (Some(most), false) => format!(
            "{} to {} left",
            part(&found.margin_at_least, Toward::Below),
            part(most, Toward::Above)
        ),
        (None, _) if least.is_zero() => "it holds; how much is left is not known".to_owned(),
        (None, _) => format!("at least {} left", part(&found.margin_at_least, Toward::Below)),
    };
    let name = in_length(&found.requirement, found.unit, length);
    let name = format!("{name} {}", found.bound_text);
    let label = if found.unknown.is_empty() { "nearest limit" } else { "nearest known" };
    labelled(out, label, &format!("{name}: {margin}"));
    let value = found.worst_seen.map(|x| format!("{} ", significant(x, DIGITS)));
    let seen = format!(
        "{}{}",
        value.unwrap_or_default(),
        placed(&pose_text(&found.seen_at, coordinates, DIGITS))
    );
    labelled(out, "seen", &seen);
    machine_at_ends(out, &found.machine);
    if !found.or.is_empty() {
        let mut names: Vec<String> = found.or.iter().take(OTHERS).cloned().collect();
        match found.or.len() - names.len() {
            0 => {}
            more => names.push(format!("{more} more")),
        }
        labelled(out, "or as near", &names.join(", "));
    }
    if !found.unknown.is_empty() {
        labelled(out, "not enclosed", &found.unknown.join(", "));
    }
}

/// A row of the table.
pub struct Row {
    words: String,
    joint: Option<usize>,
    unit: Option<&'static str>,
    /// What is certified.
    pub certified: String,
    reached: String,
}

/// What marks a bound that is the design's own.
fn own_bound(value: &Value) -> &'static str {
    if value.own_bound {
        "*"
    } else {
        ""
    }
}

/// The rows: both ends of a quantity on one.
fn rows(values: &[Value]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut rest = values;
    while let [first, others @ ..] = rest {
        let second = others.first().filter(|other| {
            other.quantity == first.quantity && other.joint == first.joint && other.end != first.end
        });
        rest = if second.is_some() { &others[1..] } else { others };
        let row = |certified: String, reached: String| Row {
            words: first.words.clone(),
            joint: first.joint.filter(|_| first.quantity == "joint_range"),
            unit: first.unit,
            certified,
            reached,
        };
        let inner = |value: &Value| match (&value.reached, value.end) {
            (Some(x), "least") => outward(x, DIGITS, Toward::Above),
            (Some(x), _) => outward(x, DIGITS, Toward::Below),
            (None, _) => "not found".to_owned(),
        };
        let outer = |value: &Value| match (&value.certified, value.end) {
            (Some(x), "least") => Ok(outward(x, DIGITS, Toward::Below) + own_bound(value)),
            (Some(x), _) => Ok(outward(x, DIGITS, Toward::Above) + own_bound(value)),
            (None, _) => Err(value.not_enclosed.clone().unwrap_or_default()),
        };
        rows.push(match (outer(first), second.map(|second| (outer(second), inner(second)))) {
            (Ok(least), Some((Ok(greatest), top))) => {
                row(format!("{least} to {greatest}"), format!("{} to {top}", inner(first)))
            }
            (Ok(one), None) => {
                let relation = if first.end == "least" { "at least" } else { "at most" };
                row(format!("{relation} {one}"), inner(first))
            }
            (Ok(least), Some((Err(reason), _))) => {
                row(format!("at least {least}; greatest {reason}"), inner(first))
            }
            (Err(reason), Some((Ok(greatest), top))) => {
                row(format!("at most {greatest}; least {reason}"), top)
            }
            (Err(reason), _) => row(reason, String::new()),
        });
    }
    rows
}

/// The rows by their names.
pub fn lines(values: &[Value], length: Option<&str>) -> Vec<(String, Row)> {
    // Joints with the same stroke are one row.
    let mut all: Vec<(Row, Vec<usize>)> = Vec::new();
    for row in rows(values) {
        let same = |(other, joints): &&mut (Row, Vec<usize>)| {
            let same = (&other.certified, &other.reached) == (&row.certified, &row.reached);
            same && !joints.is_empty() && row.joint.is_some()
        };
        match all.iter_mut().find(same) {
            Some((_, joints)) => joints.extend(row.joint),
            None => {
                let joints = row.joint.into_iter().collect();
                all.push((row, joints));
            }
        }
    }
    let name = |(row, joints): &(Row, Vec<usize>)| {
        let words = match &joints[..] {
            [] | [_] => row.words.clone(),
            joints => {
                let all: Vec<String> = joints.iter().map(usize::to_string).collect();
                format!("strokes of joints {}", all.join(", "))
            }
        };
        let is_told = |unit: &&str| {
            (!unit.starts_with("length") || unit.ends_with("rad"))
                && !matches!(*unit, "force" | "torque")
        };
        let words = match row.unit.filter(is_told) {
            Some(unit) => format!("{words}, {unit}"),
            None => words,
        };
        // What the question gave in lengths per time is answered so.
        in_length(&words, row.unit.filter(|unit| !unit.contains("time")), length)
    };
    all.into_iter().map(|named| (name(&named), named.0)).collect()
}

fn table(out: &mut String, values: &[Value], length: Option<&str>) {
    let all = lines(values, length);
    let width = |texts: &mut dyn Iterator<Item = usize>| texts.max().unwrap_or(0);
    let first = width(&mut all.iter().map(|(name, _)| name.chars().count()));
    let second = width(&mut all.iter().map(|(_, row)| row.certified.len())).clamp(9, 24);
    let _ = writeln!(out, "\n  {:first$}  {:second$}  reaches", "quantity", "certified");
    for (name, row) in &all {
        let line = format!("  {name:first$}  {:second$}  {}", row.certified, row.reached);
        let _ = writeln!(out, "{}", line.trim_end());
    }
    if values.iter().any(|value| value.certified.is_some()) {
        let text = "What is certified holds everywhere; and some pose is certified to reach the last column.";
        wrap(out, text, 2);
    }
    if values.iter().any(|value| value.own_bound) {
        wrap(out, "* The design's own bound, and nothing narrower: see bounds.", 2);
    }
}

fn shares(out: &mut String, found: &Shares) {
    let Shares { alone, sum, together, not_enclosed } = found;
    out.push('\n');
    if alone.is_empty() {
        let names = not_enclosed.join(", ");
        return wrap(
            out,
            &format!("off by: no bound was found with one deviation alone ({names})"),
            2,
        );
    }
    let total = sum.as_ref().map(|sum| sum.as_rational().cloned().unwrap_or_default());
    let part = if total.is_some() { "; its part of their sum" } else { "" };
    wrap(out, &format!("off by at most, with one deviation alone and all else exact{part}"), 2);
    let name = |number: usize| {
        let own = &alone[number];
        named(&(own.leg, own.parameter.clone()))
    };
    let mut lines: Vec<(String, BigRational)> = Vec::new();
    for (number, own) in alone.iter().enumerate() {
        let bound = own.certified.as_rational().cloned().unwrap_or_default();
        match lines.last_mut() {
            Some((_, rest)) if number >= ROWS => *rest += bound,
            _ => lines.push((name(number), bound)),
        }
    }
    if alone.len() > ROWS {
        lines[ROWS - 1].0 = format!("{} others together", alone.len() - ROWS + 1);
    }
    let width = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    for (name, bound) in &lines {
        let text = briefly(bound, FEW, Toward::Above);
        let part = total.as_ref().map_or_else(String::new, |total| {
            let part =
                if total.is_positive() { (bound / total) * hundred() } else { total.clone() };
            format!("{:>3} %", part.round().to_integer())
        });
        let _ = writeln!(out, "{}", format!("    {name:width$}  {text:<10}  {part}").trim_end());
    }
    let whole = together.as_ref().and_then(Exact::as_rational);
    let whole = whole.map(|x| format!("all at once: {}", briefly(x, FEW, Toward::Above)));
    let sum = |total| format!("{:width$}  {}", "sum", briefly(total, FEW, Toward::Above));
    let sum = total.as_ref().map(sum);
    let both: Vec<String> = sum.into_iter().chain(whole).collect();
    if !both.is_empty() {
        let _ = writeln!(out, "    {}", both.join("; "));
    }
    if !not_enclosed.is_empty() {
        let (named, more) = not_enclosed.split_at(not_enclosed.len().min(OTHERS));
        let more = if more.is_empty() { String::new() } else { format!(", {} more", more.len()) };
        wrap(out, &format!("no bound was found for: {}{more}", named.join(", ")), 4);
    }
}

fn hundred() -> BigRational {
    BigRational::from_integer(100.into())
}

#[cfg(test)]
mod tests {
    use super::super::Share;
    use super::*;

    /// Of two rows of which one is missing, the other is not all of their sum.
    #[test]
    fn rows_that_are_missing_leave_no_parts_and_no_sum() {
        let shown = |share, sum: Option<i64>, not_enclosed: &[&str]| {
            let certified = Exact::integer(3);
            let row = Share { leg: Some(1), parameter: "length".to_owned(), certified, share };
            let not_enclosed = not_enclosed.iter().map(|name| (*name).to_owned()).collect();
            let (sum, together) = (sum.map(Exact::integer), Some(Exact::integer(4)));
            let mut out = String::new();
            shares(&mut out, &Shares { alone: vec![row], sum, together, not_enclosed });
            out
        };
        let whole = shown(Some(1.0), Some(3), &[]);
        assert!(
            whole.contains("100 %") && whole.contains("sum") && whole.contains("all at once: 4")
        );
        let part = shown(None, None, &["length of leg 2"]);
        assert!(!part.contains('%') && !part.contains("sum"), "{part}");
        assert!(
            part.contains("all at once: 4")
                && part.contains("no bound was found for: length of leg 2")
        );
    }
}
