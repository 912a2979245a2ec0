//! `orthocert completions`.

use super::{print, Failure, Status};
use clap::CommandFactory;
use clap_complete::Shell;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let mut command = super::Arguments::command();
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "orthocert", &mut script);
    print::document(&String::from_utf8_lossy(&script))?;
    Ok(Status::Done)
}
