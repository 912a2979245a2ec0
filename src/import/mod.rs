//! Geometry from the configuration files of motion controllers, as design files.
//!
//! An importer reads what its controller's public documentation says of a parallel machine and
//! writes a commented design file ([`Imported::design`]). What the file does not say, or a design
//! cannot express, is listed ([`Imported::not_carried_over`]); the requirements are always such,
//! since no controller knows of transmission factors.
//!
//! Angles that are not multiples of 30 degrees have no exact coordinates in a design's numbers;
//! they are written as enclosures, so that a claim about them includes the machine itself.

mod klipper;
mod linuxcnc;
mod toml;

pub use klipper::klipper;
pub use linuxcnc::linuxcnc;

use std::fmt;

/// A design file made from a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The design file: commented TOML.
    pub design: String,
    /// What the configuration does not determine, or a design cannot express: one sentence each.
    /// They are also comments of the design.
    pub not_carried_over: Vec<String>,
}

/// Why a configuration could not be imported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImportError {
    /// A line that is neither a section, a setting nor a comment; counted from 1.
    Syntax {
        /// The file, as it was named.
        file: String,
        /// The line.
        line: usize,
    },
    /// A setting that is needed is not there.
    Missing {
        /// The file, as it was named.
        file: String,
        /// The setting, with its section.
        setting: String,
    },
    /// A setting whose value is not of the kind that is needed.
    BadValue {
        /// The file, as it was named.
        file: String,
        /// The setting, with its section.
        setting: String,
        /// What it is.
        found: String,
        /// What it has to be.
        expected: &'static str,
    },
    /// A kind of machine that is no linear or rotary Delta.
    OtherMachine {
        /// The file, as it was named.
        file: String,
        /// What it is.
        found: String,
        /// What could be imported.
        expected: &'static str,
    },
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ImportError::Syntax { file, line } => {
                write!(f, "{file}:{line}: found neither a section, a setting nor a comment")
            }
            ImportError::Missing { file, setting } => write!(f, "{file}: {setting}: not set"),
            ImportError::BadValue { file, setting, found, expected } => {
                write!(f, "{file}: {setting}: found {found:?}; accepted: {expected}")
            }
            ImportError::OtherMachine { file, found, expected } => {
                write!(f, "{file}: found kinematics {found:?}; accepted: {expected}")
            }
        }
    }
}

impl std::error::Error for ImportError {}
