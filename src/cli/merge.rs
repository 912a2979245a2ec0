//! `orthocert merge`.

use super::effort::Work;
use super::{atlas, certify, print, Failure, Format, Status};
use orthocert::decimal::counted;
use orthocert::output;
use orthocert::report::{text, Report};
use orthocert::shard::{self, MergeError, Task, Verify, Whole};
use orthocert::verify::concluded;
use orthocert_checker::certificate::Node;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder of the shards and their results
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Where the whole is written: the folder of a map, made if it is not there, or the
    /// certificate of a design
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
    match (merged.task, merged.whole) {
        (Task::Atlas(design), Whole::Cells(cells)) => {
            atlas::made(&arguments.output)?;
            let name = arguments.folder.display().to_string();
            let report = atlas::publish(&design, name, cells, &arguments.output, started)?;
            atlas::answer(&report, &arguments.work)
        }
        (Task::Verify(task), Whole::Tree { nodes, open: 0, boxes }) => {
            proved(arguments, &task, nodes, boxes, started)
        }
        (Task::Verify(_), Whole::Tree { open, .. }) => undecided(arguments, open),
        _ => Err(Failure::Input(MergeError::NotATree.to_string())),
    }
}

/// The certificate that `verify` would have written, and its report.
fn proved(
    arguments: &Arguments,
    task: &Verify,
    nodes: Vec<Node>,
    boxes: usize,
    started: Instant,
) -> Result<Status, Failure> {
    output::probe(&arguments.output)?;
    let mut found = concluded(&task.claim, nodes, boxes).map_err(Failure::input)?;
    let decision = certify::decide(&mut found.answer)?;
    let mut report = Report::new(&task.claim, &found, started.elapsed()).ok_or_else(|| {
        Failure::Input("the design's numbers exceed what can be reported".to_owned())
    })?;
    report.title.clone_from(&task.title);
    let status = match decision {
        Some(decision) => {
            report.certificate = Some(certify::store(&arguments.output, &decision.text)?);
            Status::Decided(decision.verdict)
        }
        None => Status::Undecided,
    };
    let work = &arguments.work;
    match work.format {
        Format::Json => print::json(&report)?,
        Format::Text if work.quiet => {
            print::answer(&(text::headline(&report, print::style()) + "\n"))?;
        }
        Format::Text => print::answer(&text::report(&report, print::style()))?,
    }
    Ok(status)
}

/// Boxes remain: no certificate.
fn undecided(arguments: &Arguments, open: usize) -> Result<Status, Failure> {
    let remain = counted(open, "box remains", "boxes remain");
    match arguments.work.format {
        Format::Json => print::json(&Remaining { verdict: "undecided", open })?,
        Format::Text => {
            print::answer(&format!("UNDECIDED  {remain}, no certificate is written\n"))?
        }
    }
    Ok(Status::Undecided)
}

/// The answer for scripts where boxes remain.
#[derive(Serialize)]
struct Remaining {
    verdict: &'static str,
    open: usize,
}
