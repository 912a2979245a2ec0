//! `orthocert split`.

use super::effort::Work;
use super::{input, pave, print, Failure, Status};
use crate::cli::progress::Bar;
use crate::design::{is_atlas, AtlasDesign, Design};
use crate::exact::decimal::{counted, grouped};
use crate::files::output;
use crate::files::read::Named;
use crate::files::shown::Shown;
use crate::jobs::shard::{
    self, name_of, Name, Pave, SplitError, Task, Verify, JOB_FILE, MAX_SHARDS,
};
use orthocert_kernel::certificate::MOST_NODES;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A paving in shards has a precision: whether a box is split then depends on the box alone. The number of
boxes and the gap that is reached are known of the whole only: merge says what they are, and
orthocert pave has flags for them.")]
pub struct Arguments {
    /// The job: an atlas file, a design that takes long to prove, or one whose box is to be paved
    #[arg(value_name = "JOB")]
    job: PathBuf,
    /// How many shards
    #[arg(long, value_name = "N", value_parser = input::whole(1..=MAX_SHARDS), allow_hyphen_values = true)]
    shards: u64,
    /// The folder of the shards: a new one, or an empty one
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Of a design: boxes tried below one of the cells that are dealt out
    #[arg(long, value_name = "N", default_value_t = MOST_NODES as u64,
        value_parser = input::whole(1..=MOST_NODES as u64), allow_hyphen_values = true)]
    max_boxes: u64,
    /// Pave the design's box, to the precision given
    #[arg(long, requires = "precision", conflicts_with = "max_boxes")]
    pave: bool,
    /// Of a paving: split undecided boxes until the geometric mean of their edges is at most E
    #[arg(long, value_name = "E", requires = "pave", allow_hyphen_values = true)]
    precision: Option<String>,
    /// Of a paving: the box that is searched, in the place of the design's workspace
    #[arg(
        long = "box",
        value_name = "X0,X1,Y0,Y1,Z0,Z1",
        requires = "pave",
        allow_hyphen_values = true
    )]
    search_box: Option<String>,
    #[command(flatten)]
    work: Work,
}

/// What was written.
#[derive(Serialize)]
struct Answer {
    job: String,
    folder: String,
    shards: usize,
    cells: usize,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let task = arguments.task()?;
    task.legible().map_err(|why| {
        let job = arguments.job.shown();
        Failure::Input(format!("{job}: found {why}; accepted: texts of one line"))
    })?;
    let folder = &arguments.out;
    empty(folder)?;
    arguments.work.start_threads()?;
    let count = usize::try_from(arguments.shards).unwrap_or(1);
    let split = Bar::new("boxes", arguments.work.quiet)
        .run("", 1, |control| shard::split(&task, count, control));
    let (job, texts) = split.map_err(|error| match error {
        SplitError::Interrupted => Failure::Interrupted,
        error => Failure::Input(format!("{}: {error}", arguments.job.shown())),
    })?;
    for (i, text) in texts.iter().enumerate() {
        output::write(&folder.join(name_of(Name::Shard(i + 1))), text.as_bytes())?;
    }
    // Last: a folder with it is complete.
    let text = serde_json::to_string(&job).map_err(|error| Failure::Output(error.to_string()))?;
    output::write(&folder.join(JOB_FILE), (text + "\n").as_bytes())?;
    let cells = job.top.waiting();
    let answer = Answer {
        job: job.job,
        folder: folder.to_string_lossy().into_owned(),
        shards: count,
        cells,
    };
    print::told(arguments.work.format, &answer, || text_of(&answer))?;
    Ok(Status::Done)
}

impl Arguments {
    fn task(&self) -> Result<Task, Failure> {
        if is_atlas(&self.job).map_err(Failure::input)? {
            if self.pave {
                let refused = "--pave: found an atlas; accepted: a design";
                return Err(Failure::Input(refused.to_owned()));
            }
            let design = AtlasDesign::read(&self.job).map_err(Failure::input)?;
            return Ok(Task::Atlas(Box::new(design)));
        }
        let design = input::design(Some(&self.job), self.work.quiet)?;
        if let Some(precision) = &self.precision {
            let claim = pave::searched(&design.claim, self.search_box.as_deref())?;
            let depth = pave::depth(&design, &claim, precision)?;
            return Ok(Task::Pave(Box::new(Pave { title: design.title, claim, depth })));
        }
        let boxes = usize::try_from(self.max_boxes).unwrap_or(MOST_NODES);
        let Design { title, claim, .. } = design;
        Ok(Task::Verify(Box::new(Verify { title, claim, boxes })))
    }
}

fn text_of(answer: &Answer) -> String {
    format!(
        "SPLIT  job {:.12} into {} of {} in all, in {}\n",
        answer.job,
        counted(answer.shards, "shard", "shards"),
        grouped(answer.cells as u64) + " cells",
        Shown(&answer.folder)
    )
}

/// The folder, made if it is not there; it has to be empty, so that nothing is lost or mixed.
fn empty(folder: &Path) -> Result<(), Failure> {
    output::folder(folder, folder)?;
    let unlisted =
        |error| Failure::Output(format!("{}: cannot be listed: {error}", folder.shown()));
    match fs::read_dir(folder).map_err(unlisted)?.next() {
        None => Ok(()),
        Some(_) => Err(Failure::Input(format!(
            "--out: {} has files in it; accepted: a new folder, or an empty one",
            folder.shown()
        ))),
    }
}
