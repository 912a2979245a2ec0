//! The only ways in which text gets into a page.

/// Text as it stands between tags or in a quoted attribute. What is not printable becomes a blank.
pub fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' => out.push('\n'),
            c if c.is_control() => out.push(' '),
            // Marks that reverse or reorder what is read.
            '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                out.push(' ');
            }
            c => out.push(c),
        }
    }
    out
}

/// A JSON text as it stands in a data block: nothing in it can end the block.
pub fn data(json: &str) -> String {
    json.replace('&', "\\u0026").replace('<', "\\u003c").replace('>', "\\u003e")
}

/// A word of a POSIX shell's command line.
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
            html("<script>\"'&</script>\u{202e}\u{7}"),
            "&lt;script&gt;&quot;&#39;&amp;&lt;/script&gt;  "
        );
        assert_eq!(data(r#"{"a":"</script>&"}"#), r#"{"a":"\u003c/script\u003e\u0026"}"#);
        let read: serde_json::Value = serde_json::from_str(&data(r#"{"a":"</script>&"}"#)).unwrap();
        assert_eq!(read["a"], "</script>&");
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
