//! `orthocert merge`.

use super::effort::Work;
use super::{atlas, certify, interrupt, pave, print, Failure, Format, Status};
use orthocert::decimal::counted;
use orthocert::output;
use orthocert::paving::PaveError;
use orthocert::report::paving::PavingReport;
use orthocert::report::{text, Report};
use orthocert::shard::{self, MergeError, Pave, Stretches, Task, Verify, Whole};
use orthocert::verify::concluded;
use orthocert_checker::certificate::Node;
use orthocert_checker::shown::Named;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder of the shards and their results
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Where the whole is written: the folder of a map, made if it is not there, the certificate of
    /// a design, or the paving
    #[arg(short, long, value_name = "RESULT")]
    output: PathBuf,
    #[command(flatten)]
    work: Work,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    arguments.work.start_threads()?;
    let merged = shard::merge(&arguments.folder).map_err(|error| match error {
        MergeError::Missing(_) => Failure::Output(error.to_string()),
        error => Failure::Input(format!("{}: {error}", arguments.folder.shown())),
    })?;
    match (merged.task, merged.whole) {
        (Task::Atlas(design), Whole::Cells(cells)) => {
            atlas::made(&arguments.output)?;
            let name = arguments.folder.to_string_lossy().into_owned();
            let report = atlas::publish(&design, name, cells, &arguments.output, started)?;
            atlas::answer(&report, &arguments.work)
        }
        (Task::Verify(task), Whole::Tree { nodes, open: 0, boxes }) => {
            proved(arguments, &task, nodes, boxes, started)
        }
        (Task::Verify(_), Whole::Tree { open, .. }) => undecided(arguments, open),
        (Task::Pave(task), Whole::Paving(tree)) => paved(arguments, *task, &tree, started),
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
            report.certificate = Some(certify::store(None, &arguments.output, &decision.text)?);
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

/// The paving that `pave` would have written, and its report.
fn paved(
    arguments: &Arguments,
    task: Pave,
    tree: &Stretches,
    started: Instant,
) -> Result<Status, Failure> {
    let target = pave::regular(&arguments.output)?;
    output::probe(&target)?;
    let paved =
        tree.write(&task, &target, interrupt::cancelled()).map_err(|error| match error {
            PaveError::Cancelled => Failure::Interrupted,
            error => Failure::Output(error.to_string()),
        })?;
    let elapsed = started.elapsed();
    let found = pave::connected(&target, pave::MEMORY)?;
    let mut report = PavingReport::new(&task.claim, &paved, found.as_ref(), &target);
    report.design = arguments.folder.to_string_lossy().into_owned();
    report.title = task.title;
    report.seconds = elapsed.as_secs_f64();
    pave::answer(&report, arguments.work.format, arguments.work.quiet)
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
