//! `orthocert submit`.

use super::{merge, print, Failure, Format, Status};
use crate::files::output;
use crate::files::read::Named;
use crate::files::shown::{is_unseen, Shown};
use crate::jobs::engine::{self, Submission};
use crate::jobs::shard::{read_job, JOB_FILE};
use clap::ValueEnum;
use serde::Serialize;
use std::path::{self, Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder of the shards, which every machine of the engine has to see
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// What runs the shards
    #[arg(long, value_enum)]
    engine: Engine,
    /// Where the merge that follows writes the whole
    #[arg(short, long, value_name = "RESULT")]
    output: PathBuf,
    /// Write the scripts into DIR/engine, and submit nothing
    #[arg(long)]
    scripts_only: bool,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Further options for sbatch, such as --partition=NAME
    #[arg(last = true, value_name = "OPTION")]
    options: Vec<String>,
}

/// The engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// A Slurm job array and a dependent merge job, by sbatch
    Slurm,
    /// A HyperQueue job, by the Python package hyperqueue
    Hyperqueue,
}

/// What was submitted.
#[derive(Serialize)]
struct Answer {
    job: String,
    shards: usize,
    scripts: String,
    engine_job: Option<String>,
    engine_merge: Option<String>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let engine = match arguments.engine {
        Engine::Slurm => engine::Engine::Slurm,
        Engine::Hyperqueue => engine::Engine::HyperQueue,
    };
    if engine == engine::Engine::HyperQueue && !arguments.options.is_empty() {
        let message = "options after -- are for sbatch; with --engine hyperqueue there are none";
        return Err(Failure::Input(message.to_owned()));
    }
    merge::outside(&arguments.folder, &arguments.output)?;
    let job = read_job(&arguments.folder.join(JOB_FILE)).map_err(Failure::input)?;
    let submission = Submission {
        program: absolute(
            &std::env::current_exe()
                .map_err(|error| Failure::Output(format!("this program has no path: {error}")))?,
        )?,
        folder: absolute(&arguments.folder)?,
        result: absolute(&arguments.output)?,
        job: job.job.clone(),
        shards: job.shards.len(),
        options: arguments.options.clone(),
    };
    let folder = engine::folder(&submission.folder);
    // The engine's own logs go there too, and it would follow links.
    output::folder(&submission.folder, &folder)?.has_no_links(&folder)?;
    for (name, text) in engine.scripts(&submission) {
        output::write_below(&submission.folder, &folder.join(name), text.as_bytes())?;
    }
    let submitted = match arguments.scripts_only {
        true => None,
        false => {
            Some(engine.submit(&submission).map_err(|error| Failure::Output(error.to_string()))?)
        }
    };
    let answer = Answer {
        job: job.job,
        shards: submission.shards,
        scripts: folder.to_string_lossy().into_owned(),
        engine_job: submitted.as_ref().map(|submitted| submitted.shards.clone()),
        engine_merge: submitted.map(|submitted| submitted.merge),
    };
    print::told(arguments.format, &answer, || text(&answer))?;
    Ok(Status::Done)
}

fn text(answer: &Answer) -> String {
    let Answer { job, shards, scripts, .. } = answer;
    let scripts = Shown(scripts);
    match (&answer.engine_job, &answer.engine_merge) {
        (Some(array), Some(merge)) => format!(
            "SUBMITTED  {shards} shards of job {job:.12} as {array}, the merge as {merge}\n\
             Scripts and logs are in {scripts}\n"
        ),
        _ => format!("SCRIPTS  for {shards} shards of job {job:.12} are in {scripts}\n"),
    }
}

/// The path as every machine is to know it. What is not seen is in no script, nor what would end the
/// quotes of Slurm's options.
fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let absolute = path::absolute(path)
        .map_err(|error| Failure::Input(format!("{}: {error}", path.shown())))?;
    match absolute.to_str() {
        Some(text) if !text.contains(|c| is_unseen(c) || c == '"' || c == '\\') => Ok(absolute),
        _ => Err(Failure::Input(format!(
            "{}: accepted: a path in UTF-8 without quotation marks, backslashes, control characters and \
             marks of direction",
            path.shown()
        ))),
    }
}
