//! `orthocert pave`.

use super::{input, interrupt, print, progress::Bar, Failure, Format, Status};
use orthocert::design::Design;
use orthocert::paving::{depth_for_edge, pave, Goal, PaveError, Resume};
use orthocert::search::Control;
use orthocert_checker::claim::Claim;
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// gap
    #[arg(long)]
    volume_gap: Option<String>,
    /// edge
    #[arg(long)]
    precision: Option<String>,
    /// boxes
    #[arg(long, default_value_t = 1_000_000_000)]
    max_boxes: u64,
    /// out
    #[arg(short, long)]
    output: PathBuf,
    /// resume
    #[arg(long)]
    resume: bool,
    /// threads
    #[arg(long)]
    threads: Option<usize>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let design = Design::read(&arguments.design).map_err(Failure::input)?;
    let Claim::Machine(claim) = &design.claim else { return Err(Failure::Defect) };
    if let Some(n) = arguments.threads {
        let _ = rayon::ThreadPoolBuilder::new().num_threads(n).build_global();
    }
    let gap = arguments.volume_gap.as_ref().map(|t| t.parse::<f64>().unwrap());
    let depth = match &arguments.precision {
        Some(edge) => depth_for_edge(claim, &input::number("--precision", edge)?),
        None => None,
    };
    let goal = Goal { depth, gap, max_boxes: arguments.max_boxes };
    let mut bar = Bar::new(false);
    let mut progress = |now| bar.show(now);
    let mut control = Control { cancel: interrupt::cancelled(), progress: &mut progress };
    let resume = if arguments.resume { Resume::Yes } else { Resume::No };
    let paved = pave(claim, &goal, &arguments.output, resume, &mut control);
    bar.clear();
    let paved = paved.map_err(|e| match e {
        PaveError::Cancelled => Failure::Interrupted,
        other => Failure::Output(other.to_string()),
    })?;
    let one = 2f64.powi(120);
    print::answer(&format!(
        "{:?}\ninner {} boundary {} gap {} boxes {} bytes {} time {:?}\n",
        paved.summary,
        paved.shares.inner as f64 / one,
        paved.shares.boundary as f64 / one,
        paved.shares.boundary as f64 / paved.shares.inner as f64,
        paved.boxes,
        paved.bytes,
        started.elapsed()
    ))?;
    Ok(Status::Done)
}
