//! The answer for people.

use super::rows::Row;
use crate::cli::interrupt;
use crate::design::Design;
use crate::exact::decimal::{approximate, outward, rounded, Toward};
use crate::exact::Exact;
use crate::report::text::{duration, labelled, wrap, WIDTH};
use crate::report::{placed, point_text, pose_text, Counterexample};
use crate::search::solver::value::{coordinates, in_length, listed, with_unit};
use num_rational::BigRational;
use std::fmt::Write;
use std::time::Instant;

/// Significant digits of ends: two more than the narrowest width leaves certain.
const DIGITS: u32 = 14;
/// Significant digits of places.
const PLACE_DIGITS: u32 = 6;

/// A line of the table: rows that say the same, each with its name.
struct Line<'a> {
    names: Vec<&'a str>,
    row: &'a Row,
    from: String,
    to: String,
}

/// The lines: joints with the same ends share one.
fn lines(rows: &[Row]) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for row in rows {
        let end = |x: &Option<Exact>, toward| x.as_ref().map(|x| outward(x, DIGITS, toward));
        let from = end(&row.min, Toward::Below).unwrap_or_default();
        let to = end(&row.max, Toward::Above).unwrap_or_default();
        let same = |line: &&mut Line<'_>| {
            let own = (&line.from, &line.to, line.row.end, line.row.unit);
            own == (&from, &to, row.end, row.unit) && !from.is_empty() && row.unit.is_some()
        };
        match lines.iter_mut().find(same) {
            Some(line) => line.names.push(&row.name),
            None => lines.push(Line { names: vec![&row.name], row, from, to }),
        }
    }
    lines
}

/// The table, where each extreme is reached, and what its columns are.
pub(super) fn text(
    (rows, singular): (&[Row], Option<&Counterexample>),
    design: &Design,
    asked: &BigRational,
    quiet: bool,
    started: Instant,
) -> String {
    let coordinates = coordinates(&design.claim);
    let lines = lines(rows);
    let name = |line: &Line<'_>| {
        let name = with_unit(&listed(&line.names), line.row.unit);
        in_length(&name, line.row.unit, design.unit)
    };
    let names: Vec<String> = lines.iter().map(name).collect();
    let width = |title: &str, texts: &mut dyn Iterator<Item = &str>| {
        texts.map(|text| text.chars().count()).max().unwrap_or(0).max(title.len())
    };
    let first = width("quantity", &mut names.iter().map(String::as_str));
    let second = width("from", &mut lines.iter().map(|line| line.from.as_str()));
    let third = width("to", &mut lines.iter().map(|line| line.to.as_str()));
    let mut out = String::new();
    let mut line = |[name, extreme, from, to, at]: [&str; 5], wide: Option<&str>| {
        let mut values = format!("  {name:first$}  {extreme:8}  {from:second$}  {to:third$}");
        if let Some(width) = wide {
            let _ = write!(values, "  * width {width}");
        }
        let text = match values.chars().count() + 2 + at.chars().count() {
            0..=WIDTH => format!("{values}  {at}"),
            _ if at.is_empty() => values,
            _ => {
                let mut place = String::new();
                wrap(&mut place, &placed(at), 6);
                format!("{}\n{}", values.trim_end(), place.trim_end())
            }
        };
        let _ = writeln!(out, "{}", text.trim_end());
    };
    if !quiet {
        line(["quantity", "extreme", "from", "to", "at"], None);
    }
    for (own, name) in lines.iter().zip(&names) {
        let row = own.row;
        if let Some(reason) = &row.not_enclosed {
            line([name, row.end, reason, "", ""], None);
            continue;
        }
        let point = row.point.iter().flatten().map(approximate).collect::<Option<Vec<f64>>>();
        let point = point.filter(|point| !point.is_empty() && !quiet);
        let at = point.map_or_else(String::new, |point| match design.claim.orientation.is_some() {
            true => pose_text(&point, &coordinates, PLACE_DIGITS),
            false => point_text(&point, PLACE_DIGITS),
        });
        let wide = row.relative.as_deref().filter(|_| row.wide);
        line([name, row.end, &own.from, &own.to, &at], wide);
    }
    if interrupt::is_cancelled() {
        let _ = writeln!(out, "\n  {}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    out.push('\n');
    if let Some(found) = singular {
        labelled(&mut out, "inside", &found.value);
        labelled(&mut out, "at P", &found.at());
    }
    if rows.iter().any(|row| row.not_enclosed.is_none()) {
        let asked = rounded(asked, 2, Toward::Above);
        let text = format!(
            "An extreme lies between its two decimals, relatively {asked} apart or less where no width \
             is named: one is refuted, as a bound, at the place named, the other is certified."
        );
        wrap(&mut out, &text, 2);
    }
    // The joint speed of a unit of tool speed says so in its name.
    let said = |(name, text): (&str, &'static str)| {
        let of_units = |row: &Row| !row.is_asked && row.not_enclosed.is_none();
        rows.iter().any(|row| of_units(row) && row.name.starts_with(name)).then_some(text)
    };
    let units = [
        ("stiffness", "stiffness is of joints with a stiffness of 1 each"),
        ("joint force", "joint force is that of a tool force of 1"),
    ];
    let units: Vec<&str> = units.into_iter().filter_map(said).collect();
    for (is_nearer, of) in [
        (false, "Of what the design names"),
        (true, "With a tighter bound on the other part than the design has"),
    ] {
        let own = rows.iter().filter(|row| row.is_nearer == is_nearer);
        let given: Vec<String> = own.filter_map(given).collect();
        if !given.is_empty() {
            wrap(&mut out, &format!("{of}: {}.", given.join("; ")), 2);
        }
    }
    if !units.is_empty() {
        wrap(&mut out, &format!("Of what the design does not name: {}.", listed(&units)), 2);
    }
    if rows.iter().any(|row| row.wide) {
        wrap(&mut out, "* wider than asked for: no narrower proof was found", 2);
    }
    let _ = writeln!(out, "\n  {}", duration(started.elapsed().as_secs_f64()));
    out
}

/// What a row is for, by the design's keys; a direction is its leg's own, and a unit of tool speed is in the name.
fn given(row: &Row) -> Option<String> {
    let number = |(key, all): (&String, &Vec<String>)| {
        (key != "axis").then(|| format!("{key} {}", all.join(", ")))
    };
    let all: Vec<String> = row.given.iter().filter_map(number).collect();
    let is_told = row.is_asked && row.not_enclosed.is_none() && !row.name.contains("/tool");
    (is_told && !all.is_empty()).then(|| format!("{} is for {}", row.name, all.join(", ")))
}
