//! Why a configuration is not imported.

use std::fmt;

/// Why a configuration could not be imported. Files are named relative to the folder of the first
/// one; lines count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImportError {
    /// A file that cannot be read, or more of them than are read.
    Unreadable {
        /// The file.
        file: String,
        /// The reason.
        reason: String,
    },
    /// More or fewer files than the importer reads.
    Files {
        /// How many were given.
        found: usize,
        /// What is accepted.
        expected: &'static str,
    },
    /// A line that the firmware itself would not read.
    Syntax {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// What is accepted.
        expected: &'static str,
    },
    /// A setting that the firmware demands is not there.
    Missing {
        /// The file.
        file: String,
        /// The setting, with its section.
        setting: String,
        /// What it is of the machine, where that is known.
        is: Option<String>,
    },
    /// A setting whose value is not of the kind that is needed.
    BadValue {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// The setting, with its section.
        setting: String,
        /// What it is.
        found: String,
        /// What it has to be.
        expected: String,
    },
    /// A setting that may change the geometry and is not understood.
    NotUnderstood {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// The key, as `--ignore` takes it.
        key: String,
        /// What it is set to.
        found: String,
    },
    /// A key to be ignored that no such setting has.
    NothingToIgnore {
        /// The key.
        key: String,
    },
    /// A kind of machine that is not among those imported.
    OtherMachine {
        /// The file.
        file: String,
        /// What it is.
        found: String,
        /// What could be imported.
        expected: &'static str,
    },
    /// A machine or volume that a design cannot express, or none at all.
    Refused {
        /// The file.
        file: String,
        /// Why, in a sentence without its full stop.
        reason: String,
    },
}

/// `text` without what a terminal or a comment would take for more than a character.
pub(super) fn printable(text: &str) -> String {
    const MOST: usize = 80;
    let mut shown = String::new();
    for c in text.trim().chars().take(MOST) {
        match c {
            '"' | '\'' | '\\' => shown.push(c),
            c => shown.extend(c.escape_debug()),
        }
    }
    if text.trim().chars().nth(MOST).is_some() {
        shown.push_str("...");
    }
    shown
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let p = printable;
        match self {
            ImportError::Unreadable { file, reason } => {
                write!(f, "{}: cannot be read: {}", p(file), p(reason))
            }
            ImportError::Files { found, expected } => {
                write!(f, "found {found} files; accepted: {expected}")
            }
            ImportError::Syntax { file, line, expected } => {
                write!(f, "{}:{line}: found a line that the firmware would not read; accepted: {expected}", p(file))
            }
            ImportError::Missing { file, setting, is } => {
                write!(f, "{}: {}: not set", p(file), p(setting))?;
                is.iter().try_for_each(|is| write!(f, "; it is {is}"))
            }
            ImportError::BadValue { file, line, setting, found, expected } => write!(
                f,
                "{}:{line}: {}: found \"{}\"; accepted: {expected}",
                p(file),
                p(setting),
                p(found)
            ),
            ImportError::NotUnderstood { file, line, key, found } => write!(
                f,
                "{0}:{line}: {1} = {2}: not understood, and may change the geometry; accepted: a \
                 configuration without it, or --ignore \"{1}\" where it does not",
                p(file),
                p(key),
                p(found)
            ),
            ImportError::NothingToIgnore { key } => write!(
                f,
                "--ignore \"{}\": found no setting of that key that is not understood; accepted: \
                 a key that an import was refused for",
                p(key)
            ),
            ImportError::OtherMachine { file, found, expected } => {
                write!(f, "{}: found kinematics \"{}\"; accepted: {expected}", p(file), p(found))
            }
            ImportError::Refused { file, reason } => write!(f, "{}: {reason}", p(file)),
        }
    }
}

impl std::error::Error for ImportError {}
