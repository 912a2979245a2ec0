//! `orthocert merge`.

use super::effort::Work;
use super::{atlas, Failure, Status};
use orthocert::shard::{self, MergeError, Task};
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder of the shards and their results
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Where the whole is written: the folder of the map, made if it is not there
    #[arg(short, long, value_name = "RESULT")]
    output: PathBuf,
    #[command(flatten)]
    work: Work,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let merged = shard::merge(&arguments.folder).map_err(|error| match error {
        MergeError::Missing(_) => Failure::Output(error.to_string()),
        error => Failure::Input(format!("{}: {error}", arguments.folder.display())),
    })?;
    arguments.work.start_threads()?;
    let Task::Atlas(design) = merged.task;
    atlas::made(&arguments.output)?;
    let name = arguments.folder.display().to_string();
    let report = atlas::publish(&design, name, merged.cells, &arguments.output, started)?;
    atlas::answer(&report, &arguments.work)
}
