//! `orthocert design`.

use super::{Failure, Status};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {}

/// Runs it.
pub fn run(_: &Arguments) -> Result<Status, Failure> {
    Ok(Status::Done)
}
