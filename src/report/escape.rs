//! The only ways in which text gets into documents: of each, nothing can leave its place, reorder
//! what is around it, or be taken for anything but text.

use crate::files::shown::{is_unseen, Shown};
use serde::Serialize;
use std::fmt::Write;

/// Text as it stands between tags of XML or HTML, or in a quoted attribute. Lines stay; what else is
/// not seen, or is no character of XML, is escaped as on a terminal.
pub fn xml(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' => out.push('\n'),
            c => {
                let _ = write!(out, "{}", Shown(c));
            }
        }
    }
    out
}

/// The same of one line, for attributes in which a reader turns a line feed into a blank.
pub fn attribute(text: &str) -> String {
    xml(&Shown(text).to_string())
}

/// Text as Markdown shows it literally, also in a cell of a table: as code, in which no address, name,
/// formula or tag is one.
pub fn markdown(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    for c in Shown(text).to_string().chars() {
        match c {
            // A second backslash would undo the one that keeps the cell whole.
            '|' if code.ends_with('\\') => code.push_str("\\u{7c}"),
            '|' => code.push_str("\\|"),
            c => code.push(c),
        }
    }
    if code.trim().is_empty() {
        return String::new();
    }
    let longest = code.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let blank = if code.starts_with(['`', ' ']) || code.ends_with(['`', ' ']) { " " } else { "" };
    format!("{fence}{blank}{code}{blank}{fence}")
}

/// A value as a JSON text of some lines. Its strings are what they are; what is not seen is escaped,
/// and nothing in it is a command to a runner of GitHub.
///
/// # Errors
/// If it cannot be written.
pub fn json(value: &impl Serialize) -> serde_json::Result<String> {
    Ok(seen(&serde_json::to_string_pretty(value)?) + "\n")
}

/// A JSON text with what is not seen escaped; but for line feeds, that is only in strings.
fn seen(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        match c {
            c if is_unseen(c) && c != '\n' => {
                for unit in c.encode_utf16(&mut [0; 2]) {
                    let _ = write!(out, "\\u{unit:04x}");
                }
            }
            '[' if out.ends_with("##") => out.push_str("\\u005b"),
            c => out.push(c),
        }
    }
    out
}

/// A JSON text as it stands in a data block: nothing in it can end the block.
pub fn data(json: &str) -> String {
    seen(json).replace('&', "\\u0026").replace('<', "\\u003c").replace('>', "\\u003e")
}

/// A word of a POSIX shell's command line, for people to copy.
pub fn shell(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/+=@%".contains(c);
    if !word.is_empty() && !word.starts_with('-') && word.chars().all(plain) {
        return word.to_owned();
    }
    let dashed = if word.starts_with('-') { "./" } else { "" };
    format!("'{dashed}{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_text_stays_text() {
        assert_eq!(
            xml("<script>\"'&</script>\u{202e}\u{7}\u{ffff}\n"),
            "&lt;script&gt;&quot;&#39;&amp;&lt;/script&gt;\\u{202e}\\u{7}\\u{ffff}\n"
        );
        assert_eq!(attribute("a\n\"b\""), "a\\n&quot;b&quot;");
        assert_eq!(data(r#"{"a":"</script>&"}"#), r#"{"a":"\u003c/script\u003e\u0026"}"#);
        let read: serde_json::Value = serde_json::from_str(&data(r#"{"a":"</script>&"}"#)).unwrap();
        assert_eq!(read["a"], "</script>&");
    }

    #[test]
    fn markdown_is_code_that_ends_where_it_should() {
        for (text, code) in [
            ("https://a.b @name $x$ #1 a@b.c", "`https://a.b @name $x$ #1 a@b.c`"),
            ("a|b\\|c\nd", "`a\\|b\\\\u{7c}c\\nd`"),
            ("``x`", "``` ``x` ```"),
            (" ", ""),
        ] {
            assert_eq!(markdown(text), code);
        }
    }

    #[test]
    fn json_is_of_characters_that_are_seen_and_says_the_same() {
        let hostile = "a\n\u{1b}\u{202e}\u{9b}\u{ffff}\u{e0041}\\##[x]\"";
        let text = json(&serde_json::json!({ hostile: [hostile, "##[x]"] })).unwrap();
        assert!(!text.chars().any(|c| is_unseen(c) && c != '\n') && !text.contains("##["));
        let read: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(read[hostile], serde_json::json!([hostile, "##[x]"]));
    }

    #[test]
    fn words_of_a_shell_are_quoted_where_they_need_it() {
        for (word, quoted) in [
            ("a.cert.json", "a.cert.json"),
            ("my design.json", "'my design.json'"),
            ("it's;rm", "'it'\\''s;rm'"),
            ("-x", "'./-x'"),
            ("", "''"),
        ] {
            assert_eq!(shell(word), quoted);
        }
    }
}
