//! Handing the shards of a job to an engine that runs on many machines: Slurm or HyperQueue.
//!
//! Nothing here schedules anything. The scripts, in the folder `engine` of the job's folder, are
//! plain and can be read, changed and submitted by hand.

mod hyperqueue;
mod slurm;

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What is to be run where.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The program, by its absolute path.
    pub program: PathBuf,
    /// The job's folder, absolute: every machine has to see it under this name.
    pub folder: PathBuf,
    /// Where the merge writes the whole, absolute.
    pub result: PathBuf,
    /// The job's identity.
    pub job: String,
    /// The number of shards.
    pub shards: usize,
    /// Further options for the engine's command.
    pub options: Vec<String>,
}

/// A job that the engine has taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Submitted {
    /// The engine's number of the shards' job.
    pub shards: String,
    /// The engine's number of the merge that follows; the same where it is a task of that job.
    pub merge: String,
}

/// An engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// A Slurm job array, and a job that depends on it.
    Slurm,
    /// A HyperQueue job with a task for each shard and one that depends on them.
    HyperQueue,
}

/// Why nothing was submitted.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The command is not there.
    #[error("nothing was submitted: {command} is not installed here; {help}")]
    NotInstalled {
        /// What was looked for.
        command: &'static str,
        /// How it gets there.
        help: &'static str,
    },
    /// The command could not be started.
    #[error("nothing was submitted: {0} cannot be started: {1}")]
    Start(&'static str, io::Error),
    /// The engine does not answer, or refused; its last words.
    #[error("nothing was submitted: {0} says: {1}")]
    Refused(&'static str, String),
}

/// A script of an engine: its name in the folder `engine`, and its text.
pub type Script = (&'static str, String);

impl Engine {
    /// The scripts of a submission.
    pub fn scripts(self, submission: &Submission) -> Vec<Script> {
        let mut scripts = vec![("task.sh", task(submission))];
        scripts.extend(match self {
            Engine::Slurm => slurm::scripts(submission),
            Engine::HyperQueue => hyperqueue::scripts(submission),
        });
        scripts
    }

    /// Submits the scripts, which have been written.
    ///
    /// # Errors
    /// If the engine is not there or does not take them.
    pub fn submit(self, submission: &Submission) -> Result<Submitted, EngineError> {
        match self {
            Engine::Slurm => slurm::submit(submission),
            Engine::HyperQueue => hyperqueue::submit(submission),
        }
    }
}

/// The script that runs one shard, whoever calls it.
fn task(submission: &Submission) -> String {
    let (program, folder) = (quoted(&submission.program), quoted(&submission.folder));
    format!(
        "#!/bin/bash\n\
         # Runs shard $1 of orthocert job {job}. A shard that was stopped goes on where it was;\n\
         # one that is done does nothing.\n\
         set -u\n\
         shard=$(printf '%s/shard-%04d.json' {folder} \"$1\")\n\
         for attempt in 1 2 3; do\n\
         \x20 {program} run-shard \"$shard\" --threads 1 --quiet\n\
         \x20 code=$?\n\
         \x20 # 2: the shard itself is wrong, and would be again. What else goes wrong, such as a\n\
         \x20 # killed process or a full disk, may pass.\n\
         \x20 if [ $code -eq 0 ] || [ $code -eq 2 ]; then break; fi\n\
         \x20 sleep 1\n\
         done\n\
         exit $code\n",
        job = submission.job
    )
}

/// The folder of the scripts.
pub fn folder(job: &Path) -> PathBuf {
    job.join("engine")
}

/// A path as a word of a shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.to_string_lossy().into_owned().replace('\'', "'\\''"))
}

/// Runs a command to its end; what it printed if it succeeded.
fn answer_of(
    command: &mut Command,
    name: &'static str,
    help: &'static str,
) -> Result<String, EngineError> {
    let Output { status, stdout, stderr } =
        command.output().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => EngineError::NotInstalled { command: name, help },
            _ => EngineError::Start(name, error),
        })?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if status.success() {
        return Ok(text(&stdout));
    }
    let words = text(&stderr);
    let last = words.lines().rev().find(|line| !line.trim().is_empty());
    let last: String = last.unwrap_or("nothing").chars().take(200).collect();
    Err(EngineError::Refused(name, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_single_words() {
        assert_eq!(quoted(Path::new("/a b/it's")), "'/a b/it'\\''s'");
    }
}
