//! Design files: machines, workspaces and requirements as people write them, in TOML.
//!
//! A design is read into a [`MachineClaim`](kernel::MachineClaim) of exact numbers. Nothing is defaulted silently, clamped or
//! rounded, and whatever is wrong with a file is said in one message ([`DesignError`]).
//!
//! ```
//! # use orthocert::design::Design;
//! let text = r#"
//!     [mechanism]
//!     kind = "orthoglide"
//!     leg_length = "310.25 ± 0.02"
//!     [workspace]
//!     min = [-73, -73, -73]
//!     max = [126, 126, 126]
//!     [requirements]
//!     transmission = { min = "1/2", max = 2 }
//! "#;
//! let design = Design::parse(text, "prototype.toml")?;
//! assert_eq!(design.sources.position("requirements.transmission").map(|at| at.line), Some(9));
//! # Ok::<(), orthocert::design::DesignError>(())
//! ```

mod atlas;
mod bodies;
mod description;
mod document;
mod drive;
mod error;
mod exactly;
mod expression;
mod formulas;
mod independence;
mod leg;
mod margin;
mod mechanism;
mod names;
mod notation;
mod number;
mod orientation;
mod refusal;
mod requirements;
mod sources;
mod suggestion;
mod template;
#[cfg(test)]
mod tests;
mod variable;
mod workspace;

pub use atlas::{is_atlas, AtlasDesign, Mark, Objective, Parameter, MAX_RESOLUTION};
pub use error::{Defect, DesignError, Position, ReadError};
pub use exactly::written;
pub use margin::without_margin;
pub(crate) use margin::{joint_range, JOINT_RANGE};
pub use notation::may_be_tolerance;
pub use sources::Sources;
pub use template::{template, OTHER_NAMES, TEMPLATES};
pub use variable::Variable;

use crate::exact::decimal::readable;
use crate::exact::Exact;
use crate::files::read;
use description::{Bound, Demand, Description, Mechanism};
use document::{Document, Names, Table};
use mechanism::Setting;
use orthocert_kernel::claim as kernel;
use orthocert_kernel::number::Expression;
use std::cmp::Ordering;
use std::path::Path;
use toml::de::DeTable;

/// The units of length that a design may name.
pub const UNITS: [&str; 5] = ["um", "mm", "cm", "m", "in"];

/// Most bytes of a design file.
pub const MAX_FILE: u64 = 1 << 20;

/// A design: what is claimed about a machine, and where its file says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Design {
    /// The title that the file gives it.
    pub title: Option<String>,
    /// Its unit of length, one of [`UNITS`], for people: no number depends on it.
    pub unit: Option<&'static str>,
    /// The claim, well formed and with a model
    /// ([`Problem`](orthocert_kernel::problem::Problem)).
    pub claim: kernel::MachineClaim,
    /// Where each key stands in the file; empty for [`Design::prototype`].
    pub sources: Sources,
}

/// Whether a text is one line, without characters that control a terminal.
pub fn is_line(text: &str) -> bool {
    !text.chars().any(char::is_control)
}

impl Design {
    /// Reads the text of a design file; `file_name` is for messages only.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, DesignError> {
        let document = Document { file: file_name, text, names: Names::None };
        let tree = DeTable::parse(text).map_err(|error| document.syntax_error(&error))?;
        let root = document.root(tree.get_ref());
        let keys = ["title", "unit", "mechanism", "workspace", "requirements"];
        root.only_here(&keys, |key| suggestion::file_with(key).map(str::to_owned))?;
        let title = root.find("title").map(|title| title.text("a text in quotes")).transpose()?;
        let unit = unit(&root)?;
        let description = description(&root)?;
        let sources = Sources::of((file_name, text), tree.get_ref());
        let claim = description.kernel().ok_or_else(|| too_long(&root))?;
        refusal::compiled(&root, &claim)?;
        let title = title.map(str::to_owned);
        Ok(Design { title, unit, claim, sources })
    }

    /// Reads a design file.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        Design::of(&Design::bytes(path)?, path)
    }

    /// The bytes of a design file.
    pub fn bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
        let unreadable = |error| ReadError::Unreadable(path.to_owned(), error);
        if path.is_dir() {
            return Err(ReadError::Directory(path.to_owned()));
        }
        let bytes = read::read(path, MAX_FILE).map_err(unreadable)?;
        if bytes.len() as u64 > MAX_FILE {
            return Err(ReadError::TooLarge(path.to_owned()));
        }
        Ok(bytes)
    }

    /// Reads the bytes of a design file; `path` is for messages only.
    pub fn of(bytes: &[u8], path: &Path) -> Result<Self, ReadError> {
        Ok(Design::parse(text_of(bytes, path)?, &path.to_string_lossy())?)
    }

    /// What is said of this design where a question does not fit it: the sentence of one that is not
    /// well formed, with file, line and key.
    pub fn refused(&self, key: &str, found: &str, accepted: &str) -> String {
        match self.sources.refused(key, found, accepted) {
            Some(error) => error.to_string(),
            None => format!("{key}: found {found}; accepted: {accepted}"),
        }
    }

    /// What the file has and its claim has not, because no requirement is about it; and coordinates along
    /// which its workspace has no extent.
    pub fn notes(&self) -> Vec<String> {
        let note = |(requirement, keys, about): &(&str, &[&str], &str)| {
            let there = keys.iter().filter_map(|key| {
                let key = self.sources.first("mechanism", key)?;
                Some((self.sources.position(key)?.line, key))
            });
            let is_asked = self.sources.position(&format!("requirements.{requirement}")).is_some();
            let (line, key) = there.min().filter(|_| !is_asked)?;
            Some(format!(
                "{key}, line {line}: nothing is claimed of {about}, as [requirements] has no {requirement}"
            ))
        };
        let (min, max) = match &self.claim.workspace {
            kernel::Workspace::Box { min, max } => (&min[..], &max[..]),
            _ => (&[][..], &[][..]),
        };
        let flat = min.iter().zip(max).enumerate().filter(|(_, (min, max))| min == max);
        let flat = flat.filter_map(|(at, _)| {
            let key = format!("workspace.min.{at}");
            let line = self.sources.position(&key)?.line;
            Some(format!(
                "{key}, line {line}: the same as workspace.max.{at}, so that the workspace is flat"
            ))
        });
        let small = |(key, degrees): (&str, &Expression)| {
            let degrees = Exact::of(degrees)?;
            let is_small = degrees.sign() == Some(1)
                && degrees.compare(&Exact::integer(1)) == Some(Ordering::Less);
            let key = format!("workspace.orientation.{key}");
            let line = self.sources.position(&key)?.line;
            let text = readable(&degrees);
            is_small.then(|| format!("{key}, line {line}: {text} degrees, less than one"))
        };
        let angles = match &self.claim.orientation {
            Some(kernel::Orientation::Angle(angle)) => vec![("angle", angle)],
            Some(kernel::Orientation::Tilt { tilt, torsion }) => {
                vec![("tilt", tilt), ("torsion", torsion)]
            }
            Some(_) | None => Vec::new(),
        };
        let small = angles.into_iter().filter_map(small);
        UNASKED.iter().filter_map(note).chain(flat).chain(small).collect()
    }

    /// The paper's prototype: the Orthoglide of a cube of side 200 with `psi_max = 2`.
    pub fn prototype() -> Self {
        let description = Description {
            mechanism: Mechanism::OfCube { offset: Exact::integer(0) },
            characteristic_length: None,
            workspace: description::Workspace::Cube { side: Exact::integer(200) },
            orientation: None,
            bodies: Vec::new(),
            demands: vec![Demand::of("transmission", Bound::Max(Exact::integer(2)))],
        };
        Design {
            title: Some("Orthoglide prototype".to_owned()),
            unit: Some("mm"),
            claim: description.kernel().expect("short numbers"),
            sources: Sources::default(),
        }
    }
}

/// Requirements that alone are about some keys of a mechanism, and what those describe.
const UNASKED: [(&str, &[&str], &str); 2] = [
    ("clearance", &["rod", "bodies"], "rods and bodies"),
    ("constraint_margin", &["base_axis"], "what keeps the platform from turning"),
];

/// The text of a file; `path` is for messages only.
pub fn text_of<'a>(bytes: &'a [u8], path: &Path) -> Result<&'a str, ReadError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let valid = bytes.iter().take(error.valid_up_to());
        ReadError::NotUtf8(path.to_owned(), 1 + valid.filter(|&&b| b == b'\n').count())
    })
}

/// The unit of length that a file names.
fn unit(root: &Table<'_>) -> Result<Option<&'static str>, DesignError> {
    let unit = root.find("unit").map(|unit| unit.choose(&UNITS, |name| name).copied());
    unit.transpose()
}

fn too_long(root: &Table<'_>) -> DesignError {
    let accepted = "numbers of at most 8,192 characters and 512 operations";
    refusal::of_table(root, "mechanism", "numbers too long to be written", accepted)
}

/// Reads the claim of a design of which maps are made.
fn mapped_claim(root: &Table<'_>) -> Result<kernel::MachineClaim, DesignError> {
    let claim = description(root)?.kernel().ok_or_else(|| too_long(root))?;
    let has_cube = matches!(claim.workspace, kernel::Workspace::Cube { .. });
    if has_cube {
        let found = "a machine that maps are not made of";
        let accepted = "a machine with numbers of its own, no \"cube\"";
        return Err(refusal::of_table(root, "mechanism", found, accepted));
    }
    Ok(claim)
}

/// Reads the three tables of a design.
fn description(root: &Table<'_>) -> Result<Description, DesignError> {
    let table = |name: &str| {
        let accepted = format!("a table [{name}]");
        root.require(name, &accepted)?.table(&accepted)
    };
    let (machine, points, demands) =
        (table("mechanism")?, table("workspace")?, table("requirements")?);
    workspace::some(&points)?;
    let setting = Setting {
        cube: points.find("cube"),
        joint_range: demands.find("joint_range"),
        turns: points.find("orientation").is_some(),
    };
    // The form of the workspace decides what the mechanism needs, and both decide what can be asked.
    let read = mechanism::mechanism(&machine, &setting)?;
    let workspace = workspace::workspace(&points, &read.mechanism)?;
    let motion = match &read.mechanism {
        Mechanism::Legs { motion, .. } => Some(*motion),
        Mechanism::OfCube { .. } | Mechanism::Formulas(_) => None,
    };
    let orientation = orientation::orientation(&points, motion)?;
    let asked = requirements::requirements(&demands, &read)?;
    if orientation.is_some() && read.characteristic_length.is_none() {
        if let Some(key) = requirements::of_unit(&asked) {
            let accepted = format!(
                "a length greater than 0, which {key} of a platform that turns needs: M maps the \
                 velocity of P and that length times the angular velocity to the joint rates"
            );
            return Err(machine.lacks("characteristic_length", accepted));
        }
    }
    let mechanism::Machine { mechanism, characteristic_length, bodies, demands: of_legs } = read;
    let demands = asked.into_iter().chain(of_legs).collect();
    Ok(Description { mechanism, characteristic_length, workspace, orientation, bodies, demands })
}
