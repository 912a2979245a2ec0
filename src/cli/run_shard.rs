//! `orthocert run-shard`.

use super::effort::Work;
use super::{print, Failure, Status};
use crate::cli::progress::Bar;
use crate::files::read::{identity, Named};
use crate::files::shown::Shown;
use crate::jobs::shard::{self, Ran, RunError};
use crate::search::Control;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The shard; its result is written beside it
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    work: Work,
}

/// What was done.
#[derive(Serialize)]
struct Answer {
    job: String,
    shard: usize,
    of: usize,
    cells: usize,
    resumed: usize,
    already_done: bool,
    result: String,
    seconds: f64,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let (shard, answers) = shard::read_shard(&arguments.file).map_err(Failure::input)?;
    let file = identity(&arguments.file);
    if shard::written(&arguments.file, &shard).iter().any(|written| identity(written) == file) {
        let path = arguments.file.shown();
        return Err(Failure::Input(format!(
            "{path}: is named as what is found of it is; accepted: the name that orthocert split gave"
        )));
    }
    arguments.work.start_threads()?;
    let run = |control: &mut Control<'_>| shard::run(&arguments.file, &shard, &answers, control);
    let ran = Bar::new("boxes", arguments.work.quiet).run("", 1, run);
    let ran = ran.map_err(|error| match error {
        RunError::Interrupted => Failure::Interrupted,
        RunError::Output(error) => Failure::from(error),
        other => Failure::input(other),
    })?;
    let resumed = match ran {
        Ran::AlreadyDone => shard.parts(),
        Ran::Done { resumed } => resumed,
    };
    let answer = Answer {
        result: shard::result_file(&arguments.file, &shard).to_string_lossy().into_owned(),
        shard: shard.shard,
        of: shard.of,
        cells: shard.parts(),
        resumed,
        already_done: ran == Ran::AlreadyDone,
        seconds: started.elapsed().as_secs_f64(),
        job: shard.job,
    };
    print::told(arguments.work.format, &answer, || text(&answer))?;
    Ok(Status::Done)
}

fn text(answer: &Answer) -> String {
    let Answer { shard, of, cells, resumed, result, .. } = answer;
    let how = match (answer.already_done, resumed) {
        (true, _) => "was done already".to_owned(),
        (false, 0) => format!("done, {cells} cells"),
        (false, _) => format!("done, {cells} cells, {resumed} of them by earlier runs"),
    };
    format!("SHARD  {shard} of {of} {how}: {}\n", Shown(result))
}
