//! The answer for people.

use super::rows::{Measure, Row};
use super::Arguments;
use crate::cli::interrupt;
use crate::design::Design;
use crate::exact::decimal::{outward, Toward};
use crate::exact::Exact;
use crate::questions::tolerance::{squares, ROOT_BITS};
use crate::report::text::{duration, wrap, WIDTH};
use num_rational::BigRational;
use std::fmt::Write;
use std::time::Instant;

/// Significant digits of tolerances.
const DIGITS: u32 = 6;

/// The unit of a direction's tolerance for people: thousandths of its length.
const PER_METRE: &str = "mm/m";
/// The same as the design writes it.
const COMPONENT: &str = "component";

/// A tolerance of the components of a vector, of which the square of the length is known, in thousandths of
/// that; rounded as asked for. The same where it is not known.
fn per_metre(t: Exact, square: Option<BigRational>, toward: Toward) -> Option<Exact> {
    let Some(square) = square else { return Some(t) };
    let thousandths = t.as_rational()? * BigRational::from_integer(1000.into());
    let ratio = Exact::Rational(&thousandths * &thousandths / square).root().ok()?;
    let [least, most] = ratio.ends(ROOT_BITS)?;
    Some(Exact::Rational(if matches!(toward, Toward::Below) { least } else { most }))
}

/// The table, and what it says.
pub(super) fn text(
    rows: &[Row],
    arguments: &Arguments,
    design: &Design,
    started: Instant,
) -> String {
    let name = |row: &Row| match (&row.on[..], row.measure, row.leg) {
        ([name], _, Some(leg)) => format!("{name} of leg {leg}"),
        ([name], ..) => (*name).to_owned(),
        (_, Measure::Length, _) => "all lengths, coordinates".to_owned(),
        (_, Measure::Component, _) => "all directions".to_owned(),
        (_, Measure::Share, _) => "all, at a common share".to_owned(),
    };
    let limit =
        |row: &Row| row.counterexample.as_ref().map_or(String::new(), |it| it.limit.clone());
    let names: Vec<String> = rows.iter().map(name).collect();
    let head = "widest tolerance ± t of";
    let width = |texts: &mut dyn Iterator<Item = usize>, head: &str| {
        texts.max().unwrap_or(0).max(head.chars().count())
    };
    let first = width(&mut names.iter().map(|name| name.chars().count()), head);
    // What is told of a row: its unit, and both ends in it.
    let told = |row: &Row| {
        let in_lengths = row.measure == Measure::Component && !arguments.verbose;
        let leg = row.leg.map(|leg| leg - 1);
        let sizes = in_lengths.then(|| squares(&design.claim.mechanism, &row.on, leg)).flatten();
        let unit = match row.measure {
            Measure::Length => design.unit.unwrap_or("length"),
            Measure::Component if sizes.is_some() => PER_METRE,
            Measure::Component => COMPONENT,
            Measure::Share => "share",
        };
        let [least, most] = sizes.map_or([None, None], |ends| ends.map(Some));
        let end = |t: &Option<Exact>, square, toward| {
            let t = t.clone().and_then(|t| per_metre(t, square, toward));
            t.map_or("not found".into(), |t| outward(&t, DIGITS, toward))
        };
        let certified = end(&row.certified, most, Toward::Below);
        (unit, [certified, end(&row.refuted, least, Toward::Above)])
    };
    let told: Vec<(&str, [String; 2])> = rows.iter().map(told).collect();
    let second = width(&mut told.iter().map(|(unit, _)| unit.len()), "in");
    let lengths = told.iter().flat_map(|(_, ends)| ends).map(String::len);
    let third = width(&mut { lengths }, "certified");
    let mut out = String::new();
    let quiet = arguments.effort.quiet;
    if !quiet {
        let _ = writeln!(
            out,
            "  {head:first$}  {:second$}  {:>third$}  {:>third$}  {:>7}  limited by",
            "in", "certified", "refuted", "gap"
        );
    }
    for ((row, name), (unit, [certified, refuted])) in rows.iter().zip(&names).zip(&told) {
        let gap = row.gap.as_deref().unwrap_or("-");
        let mark = if row.out_of_time { " *" } else { "" };
        let line = format!(
            "  {name:first$}  {unit:second$}  {certified:>third$}  {refuted:>third$}  {gap:>7}{mark}"
        );
        let limit = limit(row);
        let line = match line.chars().count() + 2 + limit.chars().count() {
            0..=WIDTH => format!("{line}  {limit}"),
            _ => format!("{line}\n      {limit}"),
        };
        let _ = writeln!(out, "{}", line.trim_end());
    }
    if interrupt::is_cancelled() {
        let _ = writeln!(out, "\n  {}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    out.push('\n');
    wrap(
        &mut out,
        "Every parameter of the kinds named lies within ± t of its nominal value, independently of all \
         others. The design is certified for the t on the left, and refuted, by one machine and point, \
         for the t on the right, which is greater by the gap, a part of the left one.",
        2,
    );
    if rows.iter().any(|row| row.out_of_time) {
        wrap(
            &mut out,
            "* The time was up, or it was interrupted: with more time the ends may be nearer to each other.",
            2,
        );
        if rows.iter().any(|row| row.out_of_time && row.leg.is_some()) {
            wrap(
                &mut out,
                "Legs are ranked by what was found: their order may be that of time alone.",
                2,
            );
        }
    }
    if let Some(each) = &arguments.each {
        // Without a unit, seconds.
        let mut each: String = each.trim().chars().take(20).collect();
        if each.ends_with(|c: char| c.is_ascii_digit() || c == '.') {
            each.push('s');
        }
        wrap(&mut out, &format!("Each row had at most {each} of time."), 2);
    }
    let is_told_in = |one: &str| told.iter().any(|(unit, _)| *unit == one);
    if is_told_in(PER_METRE) {
        wrap(
            &mut out,
            "A direction's t is that of each component of its unit vector: 1 mm/m, across it, is 0.0573 \
             degrees. --verbose tells components as the design writes them.",
            2,
        );
    }
    if is_told_in(COMPONENT) {
        wrap(
            &mut out,
            "A direction's t is that of its components as the design writes them: of a unit vector, \
             0.001 is 1 mm per metre across it, or 0.0573 degrees.",
            2,
        );
    }
    if rows.iter().any(|row| row.measure == Measure::Share) {
        wrap(&mut out, "A share widens every kind by this part of its own certified t above.", 2);
    }
    if rows.iter().any(|row| !row.gap_reached) {
        wrap(
            &mut out,
            "Where the gap is wider than asked for, or an end not found, the tolerances between, or \
             beyond, are undecided: no proof was found, and no machine that fails; the exit code is 3 for \
             that.",
            2,
        );
    }
    if !arguments.by_leg {
        wrap(&mut out, "--by-leg widens one leg at a time, and ranks the legs.", 2);
    }
    let _ = writeln!(out, "\n  {}", duration(started.elapsed().as_secs_f64()));
    out
}
