//! Texts of strangers, such as file names, as people are shown them: they stay on their line, in
//! their order, and visible.

use std::fmt::{self, Display, Write};

/// Whether a character does something else than stand there: controls, breaks of lines, marks that
/// reverse, hide or annotate what is around them, and what is no character.
pub fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{61c}' | '\u{180e}' | '\u{200b}' | '\u{200e}' | '\u{200f}'
            | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
            | '\u{fdd0}'..='\u{fdef}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}')
        || u32::from(c) & 0xfffe == 0xfffe
}

/// What is displayed, on one line: unseen characters are escaped as in Rust (`\n`, `\u{202e}`).
#[derive(Clone, Copy, Debug)]
pub struct Shown<T>(pub T);

impl<T: Display> Display for Shown<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(Escaping(f), "{}", self.0)
    }
}

/// Escapes what is written through it.
struct Escaping<'a, 'b>(&'a mut fmt::Formatter<'b>);

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|c| match is_unseen(c) {
            // `escape_debug` leaves some of them as they are.
            true if matches!(c, '\n' | '\r' | '\t') => write!(self.0, "{}", c.escape_debug()),
            true => write!(self.0, "{}", c.escape_unicode()),
            false => self.0.write_char(c),
        })
    }
}

/// A text of several lines as it may go to a terminal or a log, whatever is in it: `marks`, which
/// set off words, stay; other unseen characters are escaped, and nothing is a command to a runner of
/// GitHub (`::` at the start of a line, `##[` anywhere).
pub fn lines(text: &str, marks: &[&str]) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut rest, mut begins) = (text, true);
    while let Some(c) = rest.chars().next() {
        let length = match marks.iter().find(|mark| rest.starts_with(**mark)) {
            Some(mark) => {
                out.push_str(mark);
                mark.len()
            }
            None => {
                match c {
                    '\n' | '\t' => out.push(c),
                    ':' if begins && rest.starts_with("::") => out.push_str("\\u{3a}"),
                    '[' if out.ends_with("##") => out.push_str("\\u{5b}"),
                    c => out.push_str(&Shown(c).to_string()),
                }
                begins = c == '\n' || begins && c.is_whitespace();
                c.len_utf8()
            }
        };
        rest = rest.get(length..).unwrap_or_default();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_on_their_line_and_in_their_order() {
        let name = Shown("a\n\u{1b}[2J\u{202e}\u{2028}\u{ffff}\u{9b}é ±\\.toml");
        assert_eq!(name.to_string(), "a\\n\\u{1b}[2J\\u{202e}\\u{2028}\\u{ffff}\\u{9b}é ±\\.toml");
    }

    #[test]
    fn texts_keep_their_lines_and_marks_and_command_nothing() {
        for (text, shown) in [
            ("a\n\tb\r\n", "a\n\tb\\r\n"),
            ("\u{1b}[1;32mOK\u{1b}[0m\u{1b}[2J", "\u{1b}[1;32mOK\u{1b}[0m\\u{1b}[2J"),
            ("  ::error::x\na::b", "  \\u{3a}:error::x\na::b"),
            ("x ##[add-mask]y # #[", "x ##\\u{5b}add-mask]y # #["),
        ] {
            assert_eq!(lines(text, &["\u{1b}[1;32m", "\u{1b}[0m"]), shown);
        }
    }
}
