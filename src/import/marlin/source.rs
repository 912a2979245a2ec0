//! C source before preprocessing: logical lines without comments, and their tokens.

/// A line as the preprocessor sees it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    /// Where it begins, counted from 1.
    pub number: usize,
    /// What is left of it: spliced at backslashes, a blank for every comment.
    pub text: String,
}

/// Whether nothing but blanks is before the end of the line.
fn ends_the_line(mut rest: impl Iterator<Item = char>) -> bool {
    rest.find(|c| !matches!(c, ' ' | '\t' | '\u{b}' | '\u{c}')) == Some('\n')
}

/// The logical lines of `text` that are not blank.
pub(super) fn lines(text: &str) -> Vec<Line> {
    let mut lines = Vec::new();
    let (mut line, mut now) = (String::new(), 1);
    let mut start = 1;
    let mut chars = text.strip_prefix('\u{feff}').unwrap_or(text).chars().peekable();
    let mut inside = Inside::Code;
    while let Some(c) = chars.next() {
        if c == '\\' && ends_the_line(chars.clone()) {
            // The compiler joins the lines with blanks between, too.
            let _ = chars.by_ref().find(|&c| c == '\n');
            now += 1;
            continue;
        }
        if c == '\n' {
            now += 1;
            if inside == Inside::Block {
                continue;
            }
            inside = Inside::Code;
            if !line.trim().is_empty() {
                lines.push(Line { number: start, text: std::mem::take(&mut line) });
            }
            line.clear();
            start = now;
            continue;
        }
        let next = chars.peek().copied();
        match (inside, c) {
            (Inside::Comment, _) => {}
            (Inside::Block, '*') if next == Some('/') => {
                chars.next();
                inside = Inside::Code;
            }
            (Inside::Block, _) => {}
            (Inside::Code, '/') if next == Some('/') => inside = Inside::Comment,
            (Inside::Code, '/') if next == Some('*') => {
                chars.next();
                line.push(' ');
                inside = Inside::Block;
            }
            (Inside::Code, '"' | '\'') => {
                line.push(c);
                inside = Inside::Quotes(c);
            }
            (Inside::Quotes(quote), _) => {
                line.push(c);
                match c {
                    '\\' => line.extend(chars.next_if(|&c| c != '\n')),
                    c if c == quote => inside = Inside::Code,
                    _ => {}
                }
            }
            (Inside::Code, _) => line.push(c),
        }
    }
    if !line.trim().is_empty() {
        lines.push(Line { number: start, text: line });
    }
    lines
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Inside {
    Code,
    Quotes(char),
    Comment,
    Block,
}

/// A preprocessing token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// An identifier.
    Name(String),
    /// What begins as a number does.
    Number(String),
    /// A punctuator.
    Sign(&'static str),
    /// Anything else: a string, a character.
    Other(String),
}

const SIGNS: [&str; 34] = [
    "&&", "||", "==", "!=", "<=", ">=", "<<", ">>", "##", "(", ")", "{", "}", "[", "]", ",", "+",
    "-", "*", "/", "%", "!", "~", "<", ">", "&", "|", "^", "?", ":", ";", ".", "=", "#",
];

/// The tokens of a line's part.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(c) = rest.chars().next() {
        let digits = rest.strip_prefix('.').unwrap_or(rest);
        let length = if c.is_ascii_alphabetic() || c == '_' {
            rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if digits.starts_with(|c: char| c.is_ascii_digit()) {
            number_length(rest)
        } else if c == '"' || c == '\'' {
            string_length(rest, c)
        } else {
            let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
            if let Some(sign) = sign {
                found.push(Token::Sign(sign));
                rest = rest[sign.len()..].trim_start();
                continue;
            }
            c.len_utf8()
        };
        let (token, left) = rest.split_at(length);
        found.push(match c {
            'a'..='z' | 'A'..='Z' | '_' => Token::Name(token.to_owned()),
            '0'..='9' | '.' => Token::Number(token.to_owned()),
            _ => Token::Other(token.to_owned()),
        });
        rest = left.trim_start();
    }
    found
}

/// A preprocessing number: digits, letters, points, and signs of exponents.
fn number_length(text: &str) -> usize {
    let mut before = '0';
    for (at, c) in text.char_indices() {
        let exponent = matches!(before, 'e' | 'E') && matches!(c, '+' | '-');
        if !(c.is_ascii_alphanumeric() || c == '_' || c == '.' || exponent) {
            return at;
        }
        before = c;
    }
    text.len()
}

fn string_length(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            c if c == quote && !escaped => return at + 1,
            c => escaped = c == '\\' && !escaped,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::{lines, tokens, Token};

    #[test]
    fn comments_and_splices_are_as_in_c() {
        let text = "#define A 1 // one\n#define B \"//\" /* two\n2 */ 3\n\n#define C 4 \\\n  + 5\n//\\\n6\n";
        let found: Vec<(usize, String)> =
            lines(text).into_iter().map(|line| (line.number, line.text)).collect();
        let expected = [(1, "#define A 1 "), (2, "#define B \"//\"   3"), (5, "#define C 4   + 5")];
        assert_eq!(found, expected.map(|(number, text)| (number, text.to_owned())));
    }

    #[test]
    fn numbers_names_and_signs() {
        let number = |text: &str| Token::Number(text.into());
        let expected = vec![
            Token::Sign("-"),
            Token::Sign("("),
            number("1.5e-3f"),
            Token::Sign("-"),
            number(".5"),
        ];
        assert_eq!(tokens("-(1.5e-3f-.5"), expected);
        let expected =
            vec![Token::Name("A_1".into()), Token::Sign("&&"), Token::Other("\"a\\\"b\"".into())];
        assert_eq!(tokens(" A_1&& \"a\\\"b\""), expected);
    }
}
