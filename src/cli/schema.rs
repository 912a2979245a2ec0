//! `orthocert schema`.

use super::{print, Failure, Status};

/// What the commands print with `--format json`, a definition for each.
const SCHEMA: &str = include_str!("../answers.schema.json");

/// Its flags: none.
#[derive(Debug, clap::Args)]
pub struct Arguments {}

/// Runs it.
pub fn run(_: &Arguments) -> Result<Status, Failure> {
    print::document(SCHEMA)?;
    Ok(Status::Done)
}
