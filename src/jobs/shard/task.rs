//! What is to be done in shards.

use super::file::{sha256, text};
use crate::design::{is_line, AtlasDesign, MAX_RESOLUTION};
use crate::search::paving::{Parts, DEEPEST};
use orthocert_kernel::paving::{Cell, MAX_AXIS_LEVEL};
use orthocert_kernel::problem::Problem;
use serde::{Deserialize, Serialize};

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// The map of an atlas.
    Atlas(Box<AtlasDesign>),
    /// The proof of a design.
    Verify(Box<Verify>),
    /// The paving of a design's box.
    Pave(Box<Pave>),
}

/// A box to be paved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pave {
    /// The design's title.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What is claimed of the region's points.
    pub claim: orthocert_kernel::claim::MachineClaim,
    /// Most splits on a path.
    pub depth: u32,
}

/// A design to be proved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Verify {
    /// Its title.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What is claimed.
    pub claim: orthocert_kernel::claim::MachineClaim,
    /// Most boxes tried below one of the cells that are dealt out.
    pub boxes: usize,
}

impl Task {
    /// The SHA-256 of the task's text: what identifies the job.
    pub fn identity(&self) -> String {
        sha256(&text(self))
    }

    /// The texts that a file gives and reports repeat.
    fn texts(&self) -> Vec<&String> {
        match self {
            Task::Atlas(design) => {
                let marks = design.marks.iter().map(|mark| &mark.label);
                design.title.iter().chain(&design.labels).chain(marks).collect()
            }
            Task::Verify(task) => task.title.iter().collect(),
            Task::Pave(task) => task.title.iter().collect(),
        }
    }

    /// Demands that these texts are lines.
    ///
    /// # Errors
    /// What there is instead.
    pub fn legible(&self) -> Result<(), String> {
        if self.texts().into_iter().all(|text| is_line(text)) {
            return Ok(());
        }
        Err("a title or label with line breaks or control characters".to_owned())
    }

    /// Demands texts and settings that a task may have.
    pub(super) fn validate(&self) -> Result<(), String> {
        self.legible()?;
        let design = match self {
            Task::Atlas(design) => design,
            Task::Verify(task) => {
                return Problem::new(&task.claim).map(drop).map_err(|error| error.to_string());
            }
            Task::Pave(task) if task.depth > DEEPEST => {
                return Err(format!("{} splits; pavings have at most {DEEPEST}", task.depth));
            }
            Task::Pave(task) => {
                let parts = Parts::new(&task.claim, task.depth);
                return parts.map(|_| ()).map_err(|error| error.to_string());
            }
        };
        design.well_formed()?;
        let known = u32::try_from(MAX_RESOLUTION).unwrap_or(0);
        if design.resolution > known || design.labels.len() != design.parameters.len() {
            return Err("the settings are not those of an atlas".to_owned());
        }
        Ok(())
    }

    /// Whether a cell may be one of the task's.
    pub(super) fn has(&self, cell: &Cell) -> bool {
        match self {
            Task::Pave(task) => {
                let deepest = cell.edges.iter().all(|edge| edge.level() <= MAX_AXIS_LEVEL);
                deepest && cell.depth() <= task.depth
            }
            Task::Atlas(_) | Task::Verify(_) => true,
        }
    }
}
