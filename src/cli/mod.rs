//! Commands: one module each. Flags are parsed here; every command resolves its own settings and
//! ends in a [`Status`] or a [`Failure`], which alone decide the exit code.

mod atlas;
mod attest;
mod audit;
mod batch;
mod bounds;
mod certify;
mod check;
mod completions;
mod design;
mod effort;
mod ends;
mod export;
mod github;
mod import;
mod init;
mod input;
mod interrupt;
mod largest_cube;
mod limit;
mod man;
mod merge;
mod paper;
mod pave;
mod postulate;
mod print;
mod progress;
mod prove;
mod report;
mod run_shard;
mod schema;
mod show;
mod size;
mod split;
mod submit;
mod summary;
mod tolerance;
mod verify;

use crate::files::output::{self, OutputError};
use crate::files::shown::Shown;
use crate::search::solver::enclose::NotEnclosed;
use clap::error::{ContextKind, ContextValue};
use clap::{Parser, Subcommand, ValueEnum};
use orthocert_checker::certificate::Verdict;
use std::error::Error;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

const EXIT_CODES: &str = "\
Exit codes, the same for every command:
  0  certified (proved), or the command did its work
  1  refuted (proved)
  2  bad usage or bad input
  3  undecided within the budget
  4  could not finish (input/output failed, interrupted)
  5  certificate rejected";

/// Certified workspace verification of parallel machines.
///
/// Proves that a machine keeps its velocity transmission factors within their bounds and stays free
/// of singularities at every point of a workspace, or proves that it does not.
#[derive(Debug, Parser)]
#[command(name = "orthocert", version, after_help = EXIT_CODES, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Where files are written, follow symbolic links, which are refused without it
    #[arg(long, global = true)]
    follow_links: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Prove or refute a design, or many of them, and write the certificates.
    Verify(verify::Arguments),
    /// Re-prove a certificate, or all of a folder, in exact arithmetic and print what it establishes.
    Check(check::Arguments),
    /// Write an in-toto statement about a design and its certificate, for signing.
    Attest(attest::Arguments),
    /// Print a certificate's claim, verdict and size, without checking it.
    Show(show::Arguments),
    /// Compute the machine that the paper's Steps 1 to 3 give for a cube, with certified digits.
    Design(design::Arguments),
    /// Print a commented design file to start from.
    Init(init::Arguments),
    /// Prove the Q1/Q2 postulate for one psi_max, a range, or every psi_max > 1.
    Postulate(postulate::Arguments),
    /// Write a certificate or a paving, once re-proved, as an HTML page with its figures, to read and
    /// to file.
    Report(report::Arguments),
    /// Print the seed paper's claims, and what is proved of each.
    Paper(paper::Arguments),
    /// Enclose the side of the largest axis-aligned cube in which all requirements hold.
    LargestCube(largest_cube::Arguments),
    /// Find how far one number of a design can go: a certified and a refuted value beside each other.
    Limit(limit::Arguments),
    /// Pave a box: where all requirements hold, where some fails, and the volume between.
    Pave(pave::Arguments),
    /// Print what a designer reads first, certified: how far joints, speeds, forces and the rest go, and
    /// which requirement is nearest to its limit.
    Summary(summary::Arguments),
    /// Enclose the least and greatest of every quantity over a design's workspace.
    Bounds(bounds::Arguments),
    /// Map which designs of a box of parameters meet their requirements, and which fail.
    Atlas(atlas::Arguments),
    /// Cut a long job into shards that any machine can run.
    Split(split::Arguments),
    /// Run a shard, or what is left of it.
    RunShard(run_shard::Arguments),
    /// Hand the shards to Slurm or HyperQueue, with a merge that follows.
    Submit(submit::Arguments),
    /// Put the results of all shards together.
    Merge(merge::Arguments),
    /// Enclose the widest tolerances with which a design is still certified.
    Tolerance(tolerance::Arguments),
    /// Enclose the smallest machine for a cube of a given side, its edges along the axes.
    Size(size::Arguments),
    /// Make a design file of a motion controller's configuration.
    Import(import::Arguments),
    /// Write a certificate for another checker, or a paving's surface as a mesh.
    Export(export::Arguments),
    /// Print a completion script for a shell.
    Completions(completions::Arguments),
    /// Write the manual pages, one a command, of what --help says.
    Man(man::Arguments),
    /// Print the JSON schema of what the commands answer with --format json.
    Schema(schema::Arguments),
}

/// The form of the answer on standard output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Text for people.
    #[default]
    Text,
    /// One JSON object for scripts.
    Json,
}

/// How a command ended that did its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It did what it is for, without a verdict to give.
    Done,
    /// A verdict that the exact checker has accepted.
    Decided(Verdict),
    /// No verdict within the budget.
    Undecided,
    /// The certificate proves nothing.
    Rejected,
    /// Several endings, the worst of which has this exit code.
    Worst(u8),
}

impl Status {
    /// The exit code.
    fn code(self) -> u8 {
        match self {
            Status::Done | Status::Decided(Verdict::Certified) => 0,
            Status::Decided(Verdict::Refuted) => 1,
            Status::Undecided => 3,
            Status::Rejected => 5,
            Status::Worst(code) => code,
        }
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status.code())
    }
}

/// Why a command did not do its work.
#[derive(Debug)]
pub enum Failure {
    /// Bad usage or bad input: exit 2.
    Input(String),
    /// A file or standard output could not be written: exit 4.
    Output(String),
    /// A signal asked to end: exit 4.
    Interrupted,
    /// What was to be accepted proves nothing: exit 5.
    Rejected(String),
    /// Something could not be written, as was said already: exit 4.
    Reported,
    /// This program is wrong: exit 4.
    Defect,
}

impl From<NotEnclosed> for Failure {
    fn from(error: NotEnclosed) -> Self {
        match error {
            NotEnclosed::Cancelled => Failure::Interrupted,
            error => Failure::input(error),
        }
    }
}

impl Failure {
    /// Bad input, from anything that explains itself.
    fn input(error: impl fmt::Display) -> Self {
        Failure::Input(error.to_string())
    }

    /// Input beyond what answers are made of.
    fn too_large() -> Self {
        Failure::Input("the design's numbers exceed what can be reported".to_owned())
    }

    /// Says why on standard error; returns the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            Failure::Interrupted => return interrupt::end(),
            Failure::Reported => {}
            _ => print::diagnostic(self.message()),
        }
        ExitCode::from(match self {
            Failure::Input(_) => 2,
            Failure::Rejected(_) => 5,
            _ => 4,
        })
    }

    /// Why, in a sentence.
    fn message(&self) -> &str {
        match self {
            Failure::Input(message) | Failure::Output(message) | Failure::Rejected(message) => {
                message
            }
            Failure::Interrupted => "interrupted",
            Failure::Reported => "could not finish",
            Failure::Defect => {
                "stopped by a defect of this program; no verdict is given. Please report it"
            }
        }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Failure::Output(error.to_string())
    }
}

/// Runs the program: its arguments are those of the process.
pub fn main() -> ExitCode {
    // A defect of this program is not a verdict, and a backtrace is no sentence.
    panic::set_hook(Box::new(|_| {}));
    panic::catch_unwind(AssertUnwindSafe(parsed)).unwrap_or_else(|_| Failure::Defect.report())
}

fn parsed() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(message) => return usage(message),
    };
    match run(&arguments) {
        Ok(status) => status.into(),
        Err(failure) => failure.report(),
    }
}

/// Prints what the parser of the command line has to say: help, the version, or an error, which
/// quotes arguments.
fn usage(mut message: clap::Error) -> ExitCode {
    if !message.use_stderr() {
        return message.print().map_or(ExitCode::from(4), |()| ExitCode::SUCCESS);
    }
    if let Some(refused) = refused_value(&message) {
        return refused.report();
    }
    let quoted: Vec<(ContextKind, ContextValue)> = message
        .context()
        .filter(|(kind, _)| *kind != ContextKind::Usage)
        .map(|(kind, value)| (kind, on_one_line(value)))
        .collect();
    for (kind, value) in quoted {
        message.insert(kind, value);
    }
    if let Some(tip) = command_for(&message) {
        message.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    print::line(message.render().to_string().trim_end());
    ExitCode::from(u8::try_from(message.exit_code()).unwrap_or(2))
}

/// What a file may be meant for that stands where a command does.
fn command_for(message: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = message.get(ContextKind::InvalidSubcommand) else {
        return None;
    };
    let (_, extension) = word.rsplit_once('.')?;
    let command = match extension {
        "toml" => "verify",
        "json" | "paving" => "check",
        _ => return None,
    };
    Some(format!("a command comes first: orthocert {command} {word}"))
}

/// What is said of a value that an option does not take, as of those that are read later.
fn refused_value(message: &clap::Error) -> Option<Failure> {
    let of = |kind| match message.get(kind) {
        Some(ContextValue::String(text)) => Some(Shown(text).to_string()),
        _ => None,
    };
    let (argument, found) = (of(ContextKind::InvalidArg)?, of(ContextKind::InvalidValue)?);
    let option = argument.split(' ').next()?;
    let accepted = message.source()?;
    Some(Failure::Input(format!("{option}: found \"{found}\"; {accepted}")))
}

/// What an error of the parser tells of an argument, each on one line.
fn on_one_line(value: &ContextValue) -> ContextValue {
    let shown = |text: &dyn fmt::Display| Shown(text).to_string();
    match value {
        ContextValue::String(text) => ContextValue::String(shown(text)),
        ContextValue::Strings(texts) => {
            ContextValue::Strings(texts.iter().map(|text| shown(text)).collect())
        }
        ContextValue::StyledStr(text) => ContextValue::StyledStr(shown(text).into()),
        ContextValue::StyledStrs(texts) => {
            ContextValue::StyledStrs(texts.iter().map(|text| shown(text).into()).collect())
        }
        other => other.clone(),
    }
}

/// Runs the command.
fn run(arguments: &Arguments) -> Result<Status, Failure> {
    interrupt::listen();
    if arguments.follow_links {
        output::follow_links();
    }
    match &arguments.command {
        Command::Verify(arguments) => verify::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Attest(arguments) => attest::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Design(arguments) => design::run(arguments),
        Command::Init(arguments) => init::run(arguments),
        Command::Postulate(arguments) => postulate::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Paper(arguments) => paper::run(arguments),
        Command::LargestCube(arguments) => largest_cube::run(arguments),
        Command::Limit(arguments) => limit::run(arguments),
        Command::Pave(arguments) => pave::run(arguments),
        Command::Summary(arguments) => summary::run(arguments),
        Command::Bounds(arguments) => bounds::run(arguments),
        Command::Atlas(arguments) => atlas::run(arguments),
        Command::Split(arguments) => split::run(arguments),
        Command::RunShard(arguments) => run_shard::run(arguments),
        Command::Submit(arguments) => submit::run(arguments),
        Command::Merge(arguments) => merge::run(arguments),
        Command::Tolerance(arguments) => tolerance::run(arguments),
        Command::Size(arguments) => size::run(arguments),
        Command::Import(arguments) => import::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
        Command::Completions(arguments) => completions::run(arguments),
        Command::Man(arguments) => man::run(arguments),
    }
}
