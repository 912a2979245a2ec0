//! `orthocert merge`.

use super::effort::Work;
use super::{atlas, certify, interrupt, pave, print, Failure, Status};
use crate::exact::decimal::counted;
use crate::files::output;
use crate::files::read::{identity, Named};
use crate::jobs::shard::{self, MergeError, Pave, Stretches, Task, Verify, Whole};
use crate::report::paving::PavingReport;
use crate::search::paving::PaveError;
use crate::search::solver::{concluded, Answer, Undecided};
use orthocert_kernel::certificate::{Node, MOST_NODES};
use serde::Serialize;
use std::path::{Path, PathBuf};
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
    match merged(arguments) {
        Err(Failure::Rejected(reason)) => {
            let reason = format!("nothing was merged: {reason}");
            print::rejected(arguments.work.format, &arguments.folder, &reason, "")
        }
        other => other,
    }
}

fn merged(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    outside(&arguments.folder, &arguments.output)?;
    arguments.work.start_threads()?;
    let merged = shard::merge(&arguments.folder).map_err(|error| match error {
        MergeError::Missing(_) => Failure::Output(error.to_string()),
        MergeError::NotATree => Failure::Rejected(error.to_string()),
        error => Failure::Input(format!("{}: {error}", arguments.folder.shown())),
    })?;
    match (merged.task, merged.whole) {
        (Task::Atlas(design), Whole::Cells(cells)) => {
            atlas::probe(&arguments.output)?;
            let name = arguments.folder.to_string_lossy().into_owned();
            let report = atlas::publish(&design, name, cells, &arguments.output, started)?;
            atlas::answer(&report, &arguments.work)
        }
        (Task::Verify(task), Whole::Tree { nodes, open: 0, boxes }) => {
            proved(arguments, &task, nodes, boxes, started)
        }
        (Task::Verify(_), Whole::Tree { open, .. }) => undecided(arguments, open),
        (Task::Pave(task), Whole::Paving(tree)) => paved(arguments, *task, &tree, started),
        _ => Err(Failure::Rejected(MergeError::NotATree.to_string())),
    }
}

/// Refuses a result in the job's own folder, where it would be a foreign file.
pub fn outside(folder: &Path, output: &Path) -> Result<(), Failure> {
    let (folder, result) = (identity(folder), identity(output));
    if result == folder || result.parent() == Some(folder.as_path()) {
        let path = output.shown();
        return Err(Failure::Input(format!(
            "--output: {path} is in the folder of the shards; accepted: a path outside it"
        )));
    }
    Ok(())
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
    let too_many = nodes.len() > MOST_NODES;
    let mut found =
        concluded(&task.claim, nodes, boxes).map_err(|error| Failure::Input(error.to_string()))?;
    if let (Answer::Undecided(Undecided { objection: Some(reason), .. }), false) =
        (&found.answer, too_many)
    {
        return Err(Failure::Rejected(format!("the proof was not accepted: {reason}")));
    }
    let decision = certify::decided(&mut found)?;
    let mut report = found.report(&task.claim, started.elapsed()).ok_or_else(Failure::too_large)?;
    report.title.clone_from(&task.title);
    let status = match decision {
        Some(decision) => {
            report.certificate = Some(certify::store(None, &arguments.output, &decision.text)?);
            Status::Decided(decision.verdict)
        }
        None => Status::Undecided,
    };
    print::report(&report, arguments.work.format, arguments.work.quiet, false)?;
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
            PaveError::Cancelled(_) => Failure::Interrupted,
            PaveError::Defect(_) | PaveError::Coarse(_) => Failure::Rejected(error.to_string()),
            error => Failure::Output(error.to_string()),
        })?;
    let elapsed = started.elapsed();
    let found = pave::connected(&target, &paved.sha256, pave::MEMORY)?;
    let mut report = PavingReport::new(&task.claim, &paved, found.as_ref(), &target);
    report.design = arguments.folder.to_string_lossy().into_owned();
    report.title = task.title;
    report.seconds = elapsed.as_secs_f64();
    pave::answer(&report, arguments.work.format, arguments.work.quiet)
}

/// Boxes remain: no certificate.
fn undecided(arguments: &Arguments, open: usize) -> Result<Status, Failure> {
    let remain = counted(open, "box remains", "boxes remain");
    print::told(arguments.work.format, &Remaining { verdict: "undecided", open }, || {
        format!("UNDECIDED  {remain}, no certificate is written\n")
    })?;
    Ok(Status::Undecided)
}

/// The answer for scripts where boxes remain.
#[derive(Serialize)]
struct Remaining {
    verdict: &'static str,
    open: usize,
}
