//! What GitHub's runner takes from a step: annotations, and the summary of the step.

use super::{print, Failure};
use crate::files::output::{self, OutputError};
use crate::jobs::batch::annotations::annotations;
use crate::jobs::batch::{summary, Batch};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Whether this process runs in a step of GitHub Actions.
fn is_here() -> bool {
    std::env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true")
}

/// A path of the environment, if this is a step.
fn path(name: &str) -> Option<PathBuf> {
    let value = is_here().then(|| std::env::var_os(name))??;
    (!value.is_empty()).then(|| PathBuf::from(value))
}

/// A design's path from the root of its repository, where the runner tells the root; otherwise the
/// path as it was named.
pub fn locate(design: &str) -> String {
    let below_root = || {
        let root = path("GITHUB_WORKSPACE")?;
        let absolute = std::path::absolute(Path::new(design)).ok()?;
        let below = absolute.strip_prefix(root).ok()?;
        Some(below.to_string_lossy().into_owned())
    };
    below_root().unwrap_or_else(|| design.to_owned())
}

/// Prints the annotations and appends to the step's summary.
pub fn tell(batch: &Batch) -> Result<(), Failure> {
    if !is_here() {
        return Ok(());
    }
    print::commands(&annotations(batch, locate));
    let Some(path) = path("GITHUB_STEP_SUMMARY") else {
        return Ok(());
    };
    let text = summary::markdown(batch);
    let file = output::open_own(&path, OpenOptions::new().append(true).create(true));
    let appended = file.and_then(|mut file| {
        file.write_all(text.as_bytes()).map_err(|error| OutputError::Io(path, error))
    });
    appended.map_err(|error| Failure::Output(format!("GITHUB_STEP_SUMMARY: {error}")))
}
