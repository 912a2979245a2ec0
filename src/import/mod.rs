//! Geometry from the configuration files of motion controllers, as design files.
//!
//! An importer reads a configuration as its controller does, after the controller's own source, and
//! writes a commented design file ([`Imported::design`]). Every setting ends in one of five places:
//! it is *used*; a *default* of the firmware stands for it; it *cannot matter* to the geometry
//! (heaters, fans, pins); it was *ignored* because its key was named; or it is *refused*
//! ([`ImportError::NotUnderstood`]), for the design would be another machine's. What a design cannot
//! express is said ([`Imported::not_carried_over`]); the requirements are always such, since no
//! controller knows of transmission factors.
//!
//! Angles that are not multiples of 30 degrees have no exact coordinates in a design's numbers;
//! they are written as enclosures, so that a claim about them includes the machine itself.

mod error;
mod files;
mod gcode;
mod klipper;
mod linuxcnc;
mod marlin;
mod reprap;
mod settings;
mod smoothieware;
mod toml;
mod towers;

pub use error::ImportError;
pub use files::{Disk, Files};
pub use klipper::klipper;
pub use linuxcnc::linuxcnc;
pub use marlin::marlin;
pub use reprap::reprap;
pub use smoothieware::smoothieware;

use std::fmt;
use std::path::PathBuf;

/// An importer: the design that the configuration in `paths` describes, read through `files`;
/// settings whose key is in `ignore` may be such that are not understood.
pub type Importer =
    fn(files: &dyn Files, paths: &[PathBuf], ignore: &[String]) -> Result<Imported, ImportError>;

/// A design file made from a configuration, and what became of its settings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The design file: commented TOML. Its comments repeat all that follows.
    pub design: String,
    /// The settings that are in the design, in the order in which they were read.
    pub used: Vec<Used>,
    /// What the configuration leaves to the firmware.
    pub defaults: Vec<DefaultTaken>,
    /// What the configuration does not determine, or a design cannot express: one sentence each.
    pub not_carried_over: Vec<String>,
    /// Settings that were not understood and that the caller told to ignore.
    pub ignored: Vec<Setting>,
    /// The files that were read.
    pub files: Vec<PathBuf>,
}

/// A setting of a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The file, relative to the folder of the first one.
    pub file: String,
    /// The line, counted from 1.
    pub line: usize,
    /// The key as the firmware's manual writes it, with its section: `[printer] delta_radius`.
    pub key: String,
    /// What it is set to.
    pub value: String,
}

/// A setting that is in the design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Used {
    /// The setting.
    pub setting: Setting,
    /// What it became.
    pub became: String,
}

/// A value that the firmware takes where its configuration sets none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DefaultTaken {
    /// The key that is not set.
    pub key: String,
    /// The firmware's value.
    pub value: String,
    /// The firmware's source file that says so.
    pub source: &'static str,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = error::printable(&self.value);
        write!(f, "{}:{}: {} = {value}", error::printable(&self.file), self.line, self.key)
    }
}

impl fmt::Display for Used {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.setting, self.became)
    }
}

impl fmt::Display for DefaultTaken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}, after {}", self.key, self.value, self.source)
    }
}
