//! Design files: machines, workspaces and requirements as people write them, in TOML.
//!
//! A design is read into a [`Claim`] of exact numbers. Nothing is defaulted silently, clamped or
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
mod document;
mod drive;
mod error;
mod independence;
mod mechanism;
mod notation;
mod number;
mod requirements;
mod sources;
mod suggestion;
mod template;
#[cfg(test)]
mod tests;
mod variable;
mod workspace;

pub use atlas::{is_atlas, AtlasDesign, Mark, Objective, MAX_RESOLUTION};
pub use error::{Defect, DesignError, Position, ReadError};
pub use notation::may_be_tolerance;
pub use sources::Sources;
pub use template::{template, TEMPLATES};
pub use variable::Variable;

use crate::verify::MODEL_PRECISION;
use document::{Document, Names, Table};
use mechanism::Setting;
use orthocert_checker::claim::{Claim, ClaimError};
use orthocert_checker::claim::{MachineClaim, Mechanism, Range, Requirements, Workspace};
use orthocert_checker::file;
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use std::path::Path;
use toml::de::DeTable;

/// Most bytes of a design file.
pub const MAX_FILE: u64 = 1 << 20;

/// A design: what is claimed about a machine, and where its file says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Design {
    /// The title that the file gives it.
    pub title: Option<String>,
    /// The claim, well formed ([`MachineClaim::validate`]) and with a model ([`Model::new`]).
    pub claim: Claim,
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
        root.only(&["title", "mechanism", "workspace", "requirements"])?;
        let title = root.find("title").map(|title| title.text("a text in quotes")).transpose()?;
        let claim = machine_claim(&root)?;
        let sources = Sources::of(text, tree.get_ref());
        modelled(&root, &claim)?;
        Ok(Design { title: title.map(str::to_owned), claim: Claim::Machine(claim), sources })
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
        let bytes = file::read(path, MAX_FILE).map_err(unreadable)?;
        if bytes.len() as u64 > MAX_FILE {
            return Err(ReadError::TooLarge(path.to_owned()));
        }
        Ok(bytes)
    }

    /// Reads the bytes of a design file; `path` is for messages only.
    pub fn of(bytes: &[u8], path: &Path) -> Result<Self, ReadError> {
        Ok(Design::parse(text_of(bytes, path)?, &path.to_string_lossy())?)
    }

    /// The paper's prototype: the Orthoglide of a cube of side 200 with `psi_max = 2`.
    pub fn prototype() -> Self {
        let transmission = Range { min: None, max: Some(Exact::integer(2)) };
        let claim = MachineClaim {
            mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
            workspace: Workspace::Cube { side: Exact::integer(200) },
            requirements: Requirements {
                transmission: Some(transmission),
                ..Requirements::default()
            },
        };
        Design {
            title: Some("Orthoglide prototype".to_owned()),
            claim: Claim::Machine(claim),
            sources: Sources::default(),
        }
    }
}

/// The text of a file; `path` is for messages only.
pub fn text_of<'a>(bytes: &'a [u8], path: &Path) -> Result<&'a str, ReadError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let valid = bytes.iter().take(error.valid_up_to());
        ReadError::NotUtf8(path.to_owned(), 1 + valid.filter(|&&b| b == b'\n').count())
    })
}

/// Demands a claim that is well formed and has a model.
fn modelled(root: &Table<'_>, claim: &MachineClaim) -> Result<(), DesignError> {
    Model::new(claim, MODEL_PRECISION).map(drop).map_err(|error| ill_formed(root, &error))
}

/// Reads the three tables of a design.
fn machine_claim(root: &Table<'_>) -> Result<MachineClaim, DesignError> {
    let table = |name: &str| {
        let accepted = format!("a table [{name}]");
        root.require(name, &accepted)?.table(&accepted)
    };
    let (machine, points, demands) =
        (table("mechanism")?, table("workspace")?, table("requirements")?);
    let setting = Setting { cube: points.find("cube"), joint_range: demands.find("joint_range") };
    // The form of the workspace decides what the mechanism needs, and both decide what can be asked.
    let workspace = workspace::workspace(&points)?;
    let mechanism = mechanism::mechanism(&machine, &setting)?;
    let requirements = requirements::requirements(&demands, &mechanism)?;
    Ok(MachineClaim { mechanism, workspace, requirements })
}

/// A claim that is not well formed for a reason that no single key shows.
fn ill_formed(root: &Table<'_>, error: &ClaimError) -> DesignError {
    let table = match error {
        ClaimError::EmptyTransmission
        | ClaimError::CubeNeedsPsiMax
        | ClaimError::CubeFixesPsiMin => "requirements",
        ClaimError::CubeNeedsOrthoglide => "workspace",
        ClaimError::Reversed(what)
        | ClaimError::NotPositive(what)
        | ClaimError::NoBound(what)
        | ClaimError::Precision(what) => match what {
            _ if what.starts_with("workspace") => "workspace",
            _ if what.starts_with("transmission") => "requirements",
            _ if what.starts_with("joint_range") => "requirements",
            _ => "mechanism",
        },
        _ => "mechanism",
    };
    let (found, accepted) = (error.to_string(), "a well-formed claim");
    match root.find(table) {
        Some(value) => value.error(Defect::Claim, found, accepted),
        None => root.lacks(table, accepted),
    }
}
