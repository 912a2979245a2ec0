//! `orthocert`: the command line.

mod cli;

use clap::Parser;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match cli::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(message) => return cli::usage(&message),
    };
    // A defect of this program is not a verdict, and a backtrace is no sentence.
    panic::set_hook(Box::new(|_| {}));
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| cli::run(&arguments)));
    match outcome.unwrap_or(Err(cli::Failure::Defect)) {
        Ok(status) => status.into(),
        Err(failure) => failure.report(),
    }
}
