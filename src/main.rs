//! `orthocert`: the command line.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

mod cli;

use clap::Parser;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

fn main() -> ExitCode {
    // A defect of this program is not a verdict, and a backtrace is no sentence.
    panic::set_hook(Box::new(|_| {}));
    panic::catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| cli::Failure::Defect.report())
}

fn run() -> ExitCode {
    let arguments = match cli::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(message) => return cli::usage(message),
    };
    match cli::run(&arguments) {
        Ok(status) => status.into(),
        Err(failure) => failure.report(),
    }
}
