//! Standard output and standard error.

use super::Failure;
use orthocert::report::text::Style;
use serde::Serialize;
use std::io::{self, IsTerminal, Write};

/// Prints a command's answer; a closed or full standard output is a failure, never a panic.
pub fn answer(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| Failure::Output(format!("standard output cannot be written: {error}")))
}

/// Prints a command's answer as one JSON object.
pub fn json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::Output(format!("the answer cannot be written: {error}")))?;
    answer(&(text + "\n"))
}

/// A sentence on standard error; where even that is closed, there is nobody to tell.
pub fn diagnostic(message: &str) {
    let _ = writeln!(io::stderr().lock(), "orthocert: {message}");
}

/// A line about work under way, on standard error as it is.
pub fn line(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
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
