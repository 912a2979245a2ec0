//! `orthocert verify` of several designs.

use super::{
    effort::Effort, github, input, interrupt, print, prove::Task, Failure, Format, Status,
};
use crate::design::{Design, ReadError};
use crate::files::output;
use crate::files::read::{identity, Named};
use crate::jobs::batch::plan::{plan, Planned};
use crate::jobs::batch::run::{run as run_jobs, Outcome};
use crate::jobs::batch::{junit::junit, sarif::sarif, summary, Batch, Ending, Entry};
use crate::report::escape;
use crate::report::requirement::{requirements, Known};
use crate::report::Report;
use crate::search::solver;
use crate::search::{cores, Budget, Control, Progress};
use orthocert_checker::certificate::Verdict;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The flags of a batch.
#[derive(Debug, clap::Args)]
pub struct Flags {
    /// Write all certificates below this folder, which is made if need be [default: each beside
    /// its design]
    #[arg(long, value_name = "FOLDER", conflicts_with = "output")]
    out: Option<PathBuf>,
    /// Designs at a time [default: one for each core]; no certificate depends on it
    #[arg(long, value_name = "N", value_parser = input::whole(1..=1024), allow_hyphen_values = true)]
    jobs: Option<u64>,
    /// Write a JUnit report: failure = refuted, error = undecided, bad input or tool trouble,
    /// skipped = not run
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    /// Write a SARIF 2.1.0 log: one result a requirement, at its line of the design
    #[arg(long, value_name = "FILE.sarif")]
    sarif: Option<PathBuf>,
    /// Write the table as Markdown
    #[arg(long, value_name = "FILE.md")]
    summary: Option<PathBuf>,
}

impl Flags {
    /// Whether any is given.
    pub fn any(&self) -> bool {
        self.out.is_some() || self.jobs.is_some() || self.reports().next().is_some()
    }

    /// The reports, by option and file.
    fn reports(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        [("--junit", &self.junit), ("--sarif", &self.sarif), ("--summary", &self.summary)]
            .into_iter()
            .filter_map(|(option, path)| Some((option, path.as_ref()?)))
    }

    /// Refuses reports that cannot be written, or that would take the place of something else.
    fn probe(&self, planned: &[Planned]) -> Result<(), Failure> {
        let paths = planned.iter().flat_map(|one| [&one.design, &one.certificate]);
        let mut taken: BTreeSet<PathBuf> = paths.map(|path| identity(path)).collect();
        for (option, path) in self.reports() {
            output::probe(path)?;
            if !taken.insert(identity(path)) {
                let path = path.shown();
                return Err(Failure::Input(format!(
                    "{option}: {path} is a design, a certificate or another report of this run; \
                     accepted: a path of its own"
                )));
            }
        }
        Ok(())
    }
}

/// The number of workers for `--jobs`.
pub fn workers(jobs: Option<u64>) -> usize {
    match jobs {
        Some(jobs) => usize::try_from(jobs).unwrap_or(1),
        None => cores(),
    }
}

/// Runs it.
pub fn run(
    arguments: &[PathBuf],
    flags: &Flags,
    reprove: bool,
    effort: &Effort,
) -> Result<Status, Failure> {
    let started = Instant::now();
    // What cannot be right is refused before the work.
    effort.budget(started)?;
    let planned = plan(arguments, flags.out.as_deref()).map_err(Failure::input)?;
    flags.probe(&planned)?;
    effort.start_threads()?;
    interrupt::grant();
    let jobs: Arc<[Planned]> = planned.into();
    let bar = Arc::new(Mutex::new(effort.bar()));
    let shown = {
        let (bar, one) = (Arc::clone(&bar), 1.0 / jobs.len().max(1) as f64);
        // A design's share of the whole, for what of it was done since.
        move |since: f64| bar.lock().unwrap_or_else(PoisonError::into_inner).add(one * since)
    };
    let work = {
        let budget = effort.clone();
        move |one: &Planned| prove(one, reprove, &budget, &shown)
    };
    let tell = |index: usize, outcome: &Outcome<Entry>| {
        let Some(entry) = jobs.get(index).map(|one| entry(one, outcome)) else { return };
        let trouble = matches!(entry.verdict, Ending::BadInput | Ending::NotFinished);
        // What is wrong is said also where nothing else is.
        if trouble || !effort.quiet {
            print::line(&summary::line(&entry, print::error_style()));
        }
    };
    let workers = workers(flags.jobs);
    let outcomes = run_jobs(Arc::clone(&jobs), workers, interrupt::cancelled(), work, tell);
    bar.lock().unwrap_or_else(PoisonError::into_inner).end();
    let interrupted = interrupt::is_cancelled();
    let entries = jobs.iter().zip(&outcomes).map(|(one, outcome)| entry(one, outcome)).collect();
    let batch = Batch::new(entries, interrupted, started.elapsed().as_secs_f64());
    report(&batch, flags, effort)?;
    match interrupted {
        true => Err(Failure::Interrupted),
        false => Ok(Status::Worst(batch.exit_code)),
    }
}

/// Writes and prints everything, what can be, also where something else cannot.
fn report(batch: &Batch, flags: &Flags, effort: &Effort) -> Result<(), Failure> {
    let mut written = Ok(());
    let mut keep = |result: Result<(), Failure>| {
        if let Err(failure) = result {
            failure.report();
            written = Err(Failure::Reported);
        }
    };
    let write = |path: &Path, text: &str| -> Result<(), Failure> {
        Ok(output::write(path, text.as_bytes())?)
    };
    if let Some(path) = &flags.junit {
        keep(write(path, &junit(batch)));
    }
    if let Some(path) = &flags.sarif {
        let log = escape::json(&sarif(batch, github::locate));
        keep(log.map_err(|_| Failure::Defect).and_then(|log| write(path, &log)));
    }
    if let Some(path) = &flags.summary {
        keep(write(path, &summary::markdown(batch)));
    }
    keep(github::tell(batch));
    keep(match effort.format {
        Format::Json => print::json(batch),
        Format::Text if effort.quiet => print::answer(&(summary::totals(batch) + "\n")),
        Format::Text => print::answer(&summary::table(batch, print::style())),
    });
    written
}

/// Proves one design; whatever goes wrong with it is told of it alone.
fn prove(one: &Planned, reprove: bool, effort: &Effort, shown: &(dyn Fn(f64) + Sync)) -> Entry {
    let started = Instant::now();
    let mut done = 0.0;
    let mut show = |share: f64| {
        shown(share - done);
        done = share;
    };
    let mut entry = attempt(one, reprove, (effort, &mut show), started).unwrap_or_else(
        |(ending, line, message)| {
            let name = one.design.to_string_lossy().into_owned();
            Entry { line, ..Entry::without_verdict(name, ending, message) }
        },
    );
    show(1.0);
    entry.seconds = started.elapsed().as_secs_f64();
    entry
}

/// The ending, the line of the design and the message of what went wrong.
type Wrong = (Ending, Option<usize>, String);

fn attempt(
    one: &Planned,
    reprove: bool,
    (effort, show): (&Effort, &mut (dyn FnMut(f64) + Send)),
    started: Instant,
) -> Result<Entry, Wrong> {
    let design = Design::read(&one.design).map_err(|error| {
        let line = match &error {
            ReadError::Design(error) => Some(error.position().line),
            ReadError::NotUtf8(_, line) => Some(*line),
            _ => None,
        };
        (Ending::BadInput, line, error.to_string())
    })?;
    let wrong = |failure: Failure| match failure {
        Failure::Input(message) => (Ending::BadInput, None, message),
        failure => (Ending::NotFinished, None, failure.message().to_owned()),
    };
    if let Some(folder) = &one.below {
        output::folder(folder, output::folder_of(&one.certificate))
            .map_err(|error| wrong(error.into()))?;
    }
    let file = Some(one.design.as_path());
    let (target, below) = (&*one.certificate, one.below.as_deref());
    let task = Task { design: &design, file, target, below, reprove, table: false, started };
    let budget: Budget = effort.budget(started).map_err(wrong)?;
    let search = |claim: &_| {
        let mut progress = |now: Progress| show(now.share);
        let cancel = interrupt::cancelled();
        solver::verify(claim, budget, &mut Control { cancel, progress: &mut progress })
    };
    let (report, status) = task.run(search).map_err(wrong)?;
    Ok(known(&design, report, status))
}

/// What a report says, as an entry.
fn known(design: &Design, report: Report, status: Status) -> Entry {
    let (verdict, message) = match status {
        Status::Decided(verdict) => {
            (verdict.into(), Some(report.notes.join("; ")).filter(|notes| !notes.is_empty()))
        }
        _ => (Ending::Undecided, Some(undecided(&report))),
    };
    let known = match (status, &report.counterexample) {
        (Status::Decided(Verdict::Certified), _) => Known::Certified,
        (Status::Decided(Verdict::Refuted), Some(found)) => Known::Refuted(found.rule),
        _ => Known::Nothing,
    };
    let requirements = requirements(design, known);
    Entry {
        design: report.design.unwrap_or_default(),
        verdict,
        title: report.title,
        cached: report.cached,
        seconds: report.seconds,
        boxes_tried: report.boxes_tried,
        requirements,
        counterexample: report.counterexample,
        message,
        line: None,
        certificate: report.certificate,
    }
}

/// Why a design is undecided, in a sentence.
fn undecided(report: &Report) -> String {
    let Some(remains) = &report.undecided else {
        return "undecided".to_owned();
    };
    let open: Vec<&str> = remains.open.iter().map(|open| open.requirement.as_str()).collect();
    match open.is_empty() {
        true => remains.reason.clone(),
        false => format!("{}; open: {}", remains.reason, open.join("; ")),
    }
}

/// The entry of a job, also of one that did not end.
fn entry(one: &Planned, outcome: &Outcome<Entry>) -> Entry {
    let name = one.design.to_string_lossy().into_owned();
    let without =
        |ending, message: &str| Entry::without_verdict(name.clone(), ending, message.to_owned());
    match outcome {
        Outcome::Ended(entry) => entry.clone(),
        Outcome::Defect => without(Ending::NotFinished, Failure::Defect.message()),
        Outcome::Abandoned => without(Ending::NotFinished, "interrupted"),
        Outcome::NotRun => without(Ending::NotRun, "interrupted before its turn"),
    }
}
