//! One line a design, and the table at the end: for terminals, and as Markdown.

use super::{counts, Batch, Ending, Entry};
use crate::exact::decimal::counted;
use crate::files::shown::Shown;
use crate::report::escape;
use crate::report::text::{duration, Style};
use crate::report::Outcome;
use orthocert_checker::certificate::Verdict;
use std::fmt::Write;

/// Columns of the verdict.
const VERDICT: usize = 12;
/// Columns of the design, unless all are shorter.
const DESIGN: usize = 48;

/// The line of a design as it ends.
pub fn line(entry: &Entry, style: Style) -> String {
    let remark = match entry.remark_beside_name() {
        text if text.is_empty() => String::new(),
        text => format!(": {text}"),
    };
    let how = if entry.cached { "re-checked, " } else { "" };
    let time = duration(entry.seconds);
    let verdict = verdict(entry.verdict, style);
    format!("{verdict}  {} ({how}{time}){remark}", Shown(&entry.design))
}

/// The table of all designs, in the order of the plan, and the counts.
pub fn table(batch: &Batch, style: Style) -> String {
    let mut out = String::new();
    let names: Vec<String> =
        batch.designs.iter().map(|entry| Shown(&entry.design).to_string()).collect();
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).min(DESIGN);
    for (entry, name) in batch.designs.iter().zip(&names) {
        let _ = write!(out, "{}  {name:longest$}  ", verdict(entry.verdict, style));
        let remark = match entry.remark_beside_name() {
            text if !entry.cached || entry.counterexample.is_some() => text,
            text if text.is_empty() => "re-checked".to_owned(),
            text => format!("re-checked; {text}"),
        };
        let _ = writeln!(out, "{:>8}  {remark}", duration(entry.seconds));
    }
    // Lines without a remark end in blanks otherwise.
    let mut out: String = out.lines().map(|line| format!("{}\n", line.trim_end())).collect();
    let _ = writeln!(out, "\n{}", totals(batch));
    out
}

/// `43 designs: 28 certified, ...; 10 by certificates that were there; 2.1 s`.
pub fn totals(batch: &Batch) -> String {
    let designs = counted(batch.designs.len(), "design", "designs");
    let cached = batch.designs.iter().filter(|entry| entry.cached).count();
    let mut text = format!("{designs}: {}", counts(batch.designs.iter().map(|e| e.verdict)));
    if cached > 0 {
        let _ = write!(text, "; {cached} by re-checking the certificate that was there");
    }
    if batch.interrupted {
        text.push_str("; interrupted");
    }
    let _ = write!(text, "; {}", duration(batch.seconds));
    text
}

/// The same as Markdown.
pub fn markdown(batch: &Batch) -> String {
    let mut out = "## orthocert\n\n".to_owned();
    let _ = writeln!(out, "{}\n", totals(batch));
    out.push_str("| design | verdict | title | remark | time |\n|---|---|---|---|---:|\n");
    for entry in &batch.designs {
        let how = if entry.cached { ", re-checked" } else { "" };
        let _ = writeln!(
            out,
            "| {} | {}{how} | {} | {} | {} |",
            escape::markdown(&entry.design),
            marked(entry.verdict),
            escape::markdown(entry.title.as_deref().unwrap_or_default()),
            escape::markdown(&entry.remark_beside_name()),
            duration(entry.seconds)
        );
    }
    out
}

fn marked(verdict: Ending) -> String {
    match verdict {
        Ending::Certified => verdict.word().to_owned(),
        _ => format!("**{}**", verdict.word()),
    }
}

/// A verdict in a column of its own.
fn verdict(ending: Ending, style: Style) -> String {
    let outcome = match ending {
        Ending::Certified => Some(Outcome::Decided(Verdict::Certified)),
        Ending::Refuted => Some(Outcome::Decided(Verdict::Refuted)),
        Ending::Undecided => Some(Outcome::Undecided),
        _ => None,
    };
    let word = match outcome {
        Some(outcome) => style.verdict(outcome),
        None => ending.word().to_uppercase(),
    };
    format!("{word}{}", " ".repeat(VERDICT.saturating_sub(ending.word().len())))
}
