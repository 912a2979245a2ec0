//! Statements of theorems, in lines for a terminal.

use super::text::WIDTH;

/// A text for a terminal: long lines go on in the next, indented by four more, after a comma outside
/// parentheses, and where these are too far apart, after a word.
pub fn wrapped(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let blanks = line.len() - line.trim_start().len();
        let (mut column, mut piece) = (0, String::new());
        let mut place = |out: &mut String, piece: &mut String| {
            let is_long = blanks + 4 + piece.trim_end().chars().count() > WIDTH;
            for part in piece.split_inclusive(|c| is_long && c == ' ') {
                let length = part.trim_end().chars().count();
                if column > blanks && column + length > WIDTH {
                    out.truncate(out.trim_end_matches(' ').len());
                    out.push('\n');
                    out.push_str(&" ".repeat(blanks + 4));
                    column = blanks + 4;
                }
                column += part.chars().count();
                out.push_str(part);
            }
            piece.clear();
        };
        let mut open = 0u32;
        for c in line.chars() {
            piece.push(c);
            match c {
                '(' | '[' => open += 1,
                ')' | ']' => open = open.saturating_sub(1),
                ' ' if open == 0 && piece.ends_with(", ") => place(&mut out, &mut piece),
                _ => {}
            }
        }
        place(&mut out, &mut piece);
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_in_the_next_with_nothing_lost() {
        let long = format!("  leg 1: slider, {}anchor (0, 0, 0), eta > 0", "length 1, ".repeat(7));
        let wrapped = wrapped(&long);
        let lines: Vec<&str> = wrapped.lines().collect();
        assert!(lines[0].len() <= WIDTH && lines[0].ends_with("length 1,"), "{wrapped}");
        assert_eq!(lines[1], "      length 1, anchor (0, 0, 0), eta > 0");
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&wrapped), words(&long));
        assert_eq!(super::wrapped("a\n\n  b\n"), "a\n\n  b\n");
    }
}
