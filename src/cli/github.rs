//! What GitHub's runner takes from a step: annotations, and the summary of the step.

use super::{print, Failure};
use orthocert::batch::annotations::annotations;
use orthocert::batch::{summary, Batch};
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

/// Prints the annotations and appends to the step's summary. The runner reads annotations from
/// standard error too, where they leave the answer alone.
pub fn tell(batch: &Batch) -> Result<(), Failure> {
    if !is_here() {
        return Ok(());
    }
    for line in annotations(batch, locate).lines() {
        print::line(line);
    }
    let Some(path) = path("GITHUB_STEP_SUMMARY") else {
        return Ok(());
    };
    let text = summary::markdown(batch);
    let appended = OpenOptions::new()
        .append(true)
        .create(true)
        .open(&path)
        .and_then(|mut file| file.write_all(text.as_bytes()));
    appended.map_err(|error| {
        let path = path.display();
        Failure::Output(format!("GITHUB_STEP_SUMMARY: {path} cannot be written: {error}"))
    })
}
