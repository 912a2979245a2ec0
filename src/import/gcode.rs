//! G-code as configurations have it: commands of a letter and a number with lettered parameters.

/// A command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Command {
    /// Its letter and number, `M665`.
    pub name: String,
    /// The command as it is written.
    pub text: String,
    /// Its parameters: upper-case letters with what follows them.
    words: Vec<(char, String)>,
}

/// A line that is not blank.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    /// The line, counted from 1.
    pub number: usize,
    /// The blanks before it: blocks are indented.
    pub indent: usize,
    /// What it says.
    pub content: Content,
}

/// What a line says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// Commands, one after another.
    Commands(Vec<Command>),
    /// A word such as `if`, with the line.
    Word(String, String),
}

/// Commands whose parameter may be a text without quotes, which ends with the line.
const TEXTS: [&str; 24] = [
    "M20", "M23", "M28", "M30", "M32", "M36", "M37", "M38", "M98", "M117", "M118", "M470", "M471",
    "M540", "M550", "M551", "M552", "M553", "M554", "M559", "M587", "M588", "M589", "M929",
];

impl Command {
    /// What follows the first such letter.
    pub fn word(&self, letter: char) -> Option<&str> {
        self.words.iter().find(|(found, _)| *found == letter).map(|(_, value)| value.as_str())
    }

    /// Its parameters, the first of each letter.
    pub fn words(&self) -> impl Iterator<Item = (char, &str)> {
        let first = |at: &usize| !self.words[..*at].iter().any(|(c, _)| *c == self.words[*at].0);
        (0..self.words.len()).filter(first).map(|at| (self.words[at].0, self.words[at].1.as_str()))
    }
}

/// The lines of a text, without comments.
pub(super) fn lines(text: &str) -> Vec<Line> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    text.lines().enumerate().filter_map(|(at, line)| read(at + 1, line)).collect()
}

fn read(number: usize, line: &str) -> Option<Line> {
    let line = without_comment(line);
    let body = line.trim_start_matches([' ', '\t']);
    // A tab goes on to the next multiple of four (src/GCodes/GCodeBuffer/StringParser.cpp, `Put`).
    let blanks = line[..line.len() - body.len()].chars();
    let indent = blanks.fold(0, |at, c| if c == '\t' { (at + 4) & !3 } else { at + 1 });
    let body = body.trim();
    let end = body.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(body.len());
    let content = match end {
        _ if body.is_empty() => return None,
        // A command has a number right after its letter.
        2.. => Content::Word(body[..end].to_ascii_lowercase(), body.to_owned()),
        _ => Content::Commands(commands(body)),
    };
    Some(Line { number, indent, content })
}

/// The line up to its comment: a semicolon outside quotes.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ';' if !quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

/// The commands of a line: each begins at a `G` or `M` outside quotes and braces.
fn commands(line: &str) -> Vec<Command> {
    let mut starts = vec![0];
    let (mut quoted, mut braces) = (false, 0usize);
    for (at, c) in line.char_indices().skip(1) {
        match c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '{' => braces += 1,
            '}' => braces = braces.saturating_sub(1),
            'G' | 'M' | 'g' | 'm' if braces == 0 => starts.push(at),
            _ => {}
        }
    }
    let mut found = Vec::new();
    for (i, &start) in starts.iter().enumerate() {
        let end = starts.get(i + 1).copied().unwrap_or(line.len());
        let command = command(line[start..end].trim());
        if TEXTS.contains(&command.name.as_str()) {
            found.push(Command { text: line[start..].to_owned(), ..command });
            break;
        }
        found.push(command);
    }
    found
}

fn command(text: &str) -> Command {
    let mut chars = text.chars();
    let letter = chars.next().map(|c| c.to_ascii_uppercase());
    let rest = chars.as_str();
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    let (number, rest) = rest.split_at(end);
    let number = match number.trim_start_matches('0') {
        "" if !number.is_empty() => "0",
        number => number,
    };
    let name = format!("{}{number}", letter.unwrap_or_default());
    Command { name, text: text.to_owned(), words: words(rest) }
}

fn words(text: &str) -> Vec<(char, String)> {
    let mut words: Vec<(char, String)> = Vec::new();
    let (mut quoted, mut braces, mut before) = (false, 0usize, ' ');
    for c in text.chars() {
        let exponent = matches!(c, 'e' | 'E') && before.is_ascii_digit();
        let starts = !quoted && braces == 0 && c.is_ascii_alphabetic() && !exponent;
        match c {
            '"' => quoted = !quoted,
            '{' if !quoted => braces += 1,
            '}' if !quoted => braces = braces.saturating_sub(1),
            _ => {}
        }
        match words.last_mut() {
            _ if starts => words.push((c.to_ascii_uppercase(), String::new())),
            Some((_, value)) => value.push(c),
            None => {}
        }
        before = c;
    }
    words.iter_mut().for_each(|(_, value)| *value = value.trim().to_owned());
    words
}

#[cfg(test)]
mod tests {
    use super::{lines, Content};

    #[test]
    fn commands_and_words() {
        let text = "; M1\nm665 r10 L1:2 x-1e-3 ; M2\n  if {var.M3}\nM98 P\"a;M4\" M5\nM208 S1 Z0 M0208 Z{a+b}\n";
        let shown: Vec<String> = lines(text)
            .iter()
            .map(|line| match &line.content {
                Content::Word(word, _) => format!("{} {} {word}", line.number, line.indent),
                Content::Commands(commands) => {
                    let words = |c: &super::Command| {
                        c.words().map(|(l, v)| format!(" {l}={v}")).collect::<String>()
                    };
                    commands.iter().map(|c| format!("{}{};", c.name, words(c))).collect()
                }
            })
            .collect();
        let expected =
            ["M665 R=10 L=1:2 X=-1e-3;", "3 2 if", "M98 P=\"a;M4\";", "M208 S=1 Z=0;M208 Z={a+b};"];
        assert_eq!(shown, expected);
    }
}
