//! Standard output and standard error: every byte that this program prints passes through here.

use super::{progress, Failure, Format, Status};
use crate::files::read::Named;
use crate::files::shown::lines;
use crate::report::escape;
use crate::report::text::{self, Style};
use crate::report::Report;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::Path;

/// Prints a command's answer; a closed or full standard output is a failure, never a panic.
pub fn answer(text: &str) -> Result<(), Failure> {
    document(&lines(text, marks(style())))
}

/// Prints a command's answer as one JSON object.
pub fn json(value: &impl Serialize) -> Result<(), Failure> {
    let text = escape::json(value)
        .map_err(|error| Failure::Output(format!("the answer cannot be written: {error}")))?;
    document(&text)
}

/// Prints a command's answer in the form that is asked for.
pub fn told(
    format: Format,
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    match format {
        Format::Json => json(value),
        Format::Text => answer(&text()),
    }
}

/// Prints what became of a design.
pub fn report(report: &Report, format: Format, quiet: bool, verbose: bool) -> Result<(), Failure> {
    told(format, report, || match quiet {
        true => text::headline(report, style()) + "\n",
        false => text::report(report, style(), verbose),
    })
}

/// The answer for scripts that a file proves nothing.
#[derive(Serialize)]
struct Rejected<'a> {
    accepted: bool,
    reason: &'a str,
}

/// Tells that a file proves nothing, and why; the hint is for people alone.
pub fn rejected(
    format: Format,
    path: &Path,
    reason: &impl Display,
    hint: &str,
) -> Result<Status, Failure> {
    match format {
        Format::Json => json(&Rejected { accepted: false, reason: &reason.to_string() })?,
        Format::Text => diagnostic(&format!("{}: REJECTED: {reason}{hint}", path.shown())),
    }
    Ok(Status::Rejected)
}

/// Prints a text of this program's own as it is.
pub fn document(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| Failure::Output(format!("standard output cannot be written: {error}")))
}

/// A sentence on standard error, perhaps with indented lines after it: what it quotes begins no line
/// of its own. Where even that is closed, there is nobody to tell.
pub fn diagnostic(message: &str) {
    let mut text = "orthocert: ".to_owned();
    for (number, part) in message.split('\n').enumerate() {
        text.push_str(match number {
            0 => "",
            _ if part.starts_with("  ") => "\n",
            _ => "\\n",
        });
        text.push_str(part);
    }
    line(&text);
}

/// Lines about work under way, on standard error.
pub fn line(text: &str) {
    progress::beside(|| {
        let _ = writeln!(io::stderr().lock(), "{}", lines(text, marks(error_style())));
    });
}

/// Commands to the runner of GitHub, which it reads from standard error too, where they leave the
/// answer alone.
pub fn commands(text: &str) {
    progress::beside(|| {
        let _ = write!(io::stderr().lock(), "{text}");
    });
}

/// What sets words off.
fn marks(style: Style) -> &'static [&'static str] {
    match style {
        Style::Plain => &[],
        Style::Colour => &Style::MARKS,
    }
}

/// Colour on a terminal, unless `NO_COLOR` is set or the terminal has none.
pub fn style() -> Style {
    style_of(&io::stdout())
}

/// The same for standard error.
pub fn error_style() -> Style {
    style_of(&io::stderr())
}

fn style_of(stream: &impl IsTerminal) -> Style {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb");
    if stream.is_terminal() && !set("NO_COLOR") && !dumb {
        Style::Colour
    } else {
        Style::Plain
    }
}
