//! What a design file is refused for: one message that names file, line, key, what was found there
//! and what is accepted.

use super::MAX_FILE;
use crate::files::read::Named;
use crate::files::shown::{is_unseen, Shown};
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// The class of a defect of a design file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Defect {
    /// The text is not TOML; duplicated keys and excessive nesting are of this class.
    Syntax,
    /// A key that the format does not have at this place.
    UnknownKey,
    /// A key that the format demands at this place.
    MissingKey,
    /// A key or value that another key excludes or makes meaningless.
    Conflict,
    /// A value of another type than the key takes, or an array of another length.
    WrongType,
    /// A word that is not among those the key takes.
    UnknownWord,
    /// Not an exact finite number within the limits of the format.
    NotANumber,
    /// A tolerance where a single exact number is needed, or a negative one.
    Tolerance,
    /// A lower end that is not provably at most its upper end.
    Reversed,
    /// A number outside of the key's domain, such as a length that is not positive.
    OutOfDomain,
    /// The claim as a whole is not well formed.
    Claim,
}

/// Why a design file was refused, and where.
///
/// Its [`Display`](fmt::Display) form is `FILE:LINE:COLUMN: KEY: found ...; accepted: ...`, followed
/// by the line and a caret under the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DesignError {
    report: Box<Report>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Report {
    file: String,
    position: Position,
    key: String,
    defect: Defect,
    found: String,
    accepted: String,
    excerpt: Excerpt,
}

impl DesignError {
    /// The error about `text[at]`, which is the value of `key` or the place where it should be.
    pub(super) fn new(
        (file, text): (&str, &str),
        at: Range<usize>,
        (key, defect): (&str, Defect),
        found: String,
        accepted: String,
    ) -> Self {
        let position = Position::of(text, at.start);
        let excerpt = Excerpt::of(text, at);
        let (file, key) = (file.to_owned(), key.to_owned());
        DesignError {
            report: Box::new(Report { file, position, key, defect, found, accepted, excerpt }),
        }
    }

    /// The name of the file, as it was given.
    pub fn file(&self) -> &str {
        &self.report.file
    }

    /// Where in the file.
    pub fn position(&self) -> Position {
        self.report.position
    }

    /// The key, with the tables that it is in: `mechanism.legs.1.length`. Elements are counted
    /// from 0, as in the keys of `limit`: `legs.0` is leg 1, and `min.0` belongs to x. For
    /// [`Defect::Syntax`] it is the key that the place seems to belong to, or empty.
    pub fn key(&self) -> &str {
        &self.report.key
    }

    /// The class of the defect.
    pub fn defect(&self) -> Defect {
        self.report.defect
    }

    /// What is there.
    pub fn found(&self) -> &str {
        &self.report.found
    }

    /// What could be there.
    pub fn accepted(&self) -> &str {
        &self.report.accepted
    }
}

impl fmt::Display for DesignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Report { file, position, key, found, accepted, excerpt, .. } = &*self.report;
        write!(f, "{}:{position}: ", Shown(file))?;
        if !key.is_empty() {
            write!(f, "{}: ", Shown(key))?;
        }
        writeln!(f, "found {}; accepted: {accepted}", Shown(found))?;
        let line = position.line.to_string();
        let gutter = " ".repeat(line.len());
        writeln!(f, "  {line} | {}", excerpt.line)?;
        write!(f, "  {gutter} | {}{}", " ".repeat(excerpt.caret), "^".repeat(excerpt.width))
    }
}

impl std::error::Error for DesignError {}

/// A place in a file: line and column in characters, both counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl Position {
    /// The place of byte `offset`, or of the end of `text` if it lies beyond.
    pub(super) fn of(text: &str, offset: usize) -> Self {
        let before = before(text, offset);
        let line = 1 + before.bytes().filter(|&b| b == b'\n').count();
        let column = 1 + before.rsplit('\n').next().map_or(0, width);
        Position { line, column }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// One line of a file, fit for a terminal, and the part of it that an error is about.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Excerpt {
    line: String,
    caret: usize,
    width: usize,
}

/// Most characters of a line that are shown, and of those before the caret.
const SHOWN: usize = 100;
const SHOWN_BEFORE: usize = 60;

impl Excerpt {
    fn of(text: &str, at: Range<usize>) -> Self {
        let before = before(text, at.start);
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = text.get(start..).unwrap_or_default().lines().next().unwrap_or_default();
        let column = width(before.get(start..).unwrap_or_default());
        let marked = text.get(at).unwrap_or_default().lines().next().map_or(0, width);
        // Of a line that is short enough, all is shown.
        let skipped = match width(line) + marked {
            0..=SHOWN => 0,
            _ => column.saturating_sub(SHOWN_BEFORE),
        };
        let line: String = line
            .strip_prefix(BYTE_ORDER_MARK)
            .unwrap_or(line)
            .chars()
            .skip(skipped)
            .take(SHOWN)
            .map(|c| if is_unseen(c) { ' ' } else { c })
            .collect();
        let caret = column - skipped;
        let room = line.chars().count().saturating_sub(caret);
        Excerpt { line, caret, width: marked.min(room).max(1) }
    }
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// `text` up to byte `offset`, to the next character's start where that splits one.
fn before(text: &str, offset: usize) -> &str {
    let end = (offset..text.len()).find(|&i| text.is_char_boundary(i)).unwrap_or(text.len());
    text.get(..end).unwrap_or(text)
}

/// Characters that take a column.
fn width(text: &str) -> usize {
    text.chars().filter(|&c| c != BYTE_ORDER_MARK).count()
}

const DESIGN: &str = "a design file (TOML text in UTF-8)";

/// Why a design could not be read from a path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The path is a directory.
    #[error("{}: found a directory; accepted: {DESIGN}", .0.shown())]
    Directory(PathBuf),
    /// The operating system's reason.
    #[error("{path}: cannot be read: {1}; accepted: {DESIGN}", path = .0.shown())]
    Unreadable(PathBuf, #[source] std::io::Error),
    /// The file has more bytes than [`MAX_FILE`].
    #[error(
        "{}: found more than {MAX_FILE} bytes; accepted: {DESIGN} of at most that size", .0.shown()
    )]
    TooLarge(PathBuf),
    /// The file is not UTF-8, as TOML is; the line on which it stops being so.
    #[error("{path}:{1}: found bytes that are not UTF-8; accepted: {DESIGN}", path = .0.shown())]
    NotUtf8(PathBuf, usize),
    /// The file was read, but is not a design.
    #[error(transparent)]
    Design(#[from] DesignError),
}
