//! `orthocert verify`.

use super::{batch, effort::Effort, input, print, prove::Task, Failure, Format, Status};
use crate::jobs::batch::plan::certificate_of;
use crate::report::{Margin, Report};
use crate::search::solver;
use crate::search::solver::enclose::enclose;
use crate::search::solver::extremes::Extreme;
use crate::search::Budget;
use num_rational::BigRational;
use orthocert_kernel::claim::{MachineClaim, Orientation};
use orthocert_kernel::problem::Problem;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The certificate of the built-in prototype, in the current folder.
const PROTOTYPE: &str = "orthoglide-prototype.cert.json";

/// Most boxes of a proof that leaves time for margins: of one machine, and of those of a tolerance by what they differ
/// by, of which each takes longer.
const SHORT_PROOF: [usize; 2] = [200, 50];

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A design, or several, or folders of them; without any, the paper's prototype (cube of
    /// 200 mm, psi_max = 2)
    #[arg(value_name = "DESIGN.toml|FOLDER")]
    designs: Vec<PathBuf>,
    /// Where the certificate of a single design is written [default: NAME.cert.json beside
    /// NAME.toml]
    #[arg(short, long, value_name = "CERT.json")]
    output: Option<PathBuf>,
    /// Search for a proof even where a certificate of the very claim is there; without it, that
    /// certificate is re-checked exactly
    #[arg(long)]
    reprove: bool,
    /// Print every leg's row, every machine and every open region, with exact numbers
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,
    #[command(flatten)]
    batch: batch::Flags,
    #[command(flatten)]
    effort: Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let Arguments { designs, output, reprove, batch: flags, effort, .. } = arguments;
    match designs.as_slice() {
        [] if !flags.any() => single(arguments, None),
        [design] if !flags.any() && !design.is_dir() => single(arguments, Some(design)),
        _ if output.is_some() => {
            let message = "--output: found in a run of several designs, or with its options; accepted: --out FOLDER";
            Err(Failure::Input(message.to_owned()))
        }
        [] => {
            let message = "no design is given; accepted: design files and folders of them";
            Err(Failure::Input(message.to_owned()))
        }
        designs => batch::run(designs, flags, *reprove, effort),
    }
}

fn single(arguments: &Arguments, path: Option<&PathBuf>) -> Result<Status, Failure> {
    let started = Instant::now();
    let Arguments { output, reprove, verbose, effort, .. } = arguments;
    let budget = effort.budget(started)?;
    // Its report has the notes.
    let design = input::design(path.map(PathBuf::as_path), true)?;
    let target = target(output.as_deref(), path.map(PathBuf::as_path))?;
    effort.start_threads()?;
    let task = Task {
        design: &design,
        file: path.map(PathBuf::as_path),
        target: &target,
        below: None,
        reprove: *reprove,
        table: !effort.quiet || effort.format == Format::Json,
        started,
    };
    let (mut report, status) =
        task.run(|claim| effort.run(|control| solver::verify(claim, budget, control)))?;
    if task.table {
        report.margins = margins(&report, &design.claim, effort, budget);
    }
    print::report(&report, effort.format, effort.quiet, *verbose)?;
    Ok(status)
}

/// The certified margins of a certified design, where its proof was short, and as far as there is time.
fn margins(
    report: &Report,
    claim: &MachineClaim,
    effort: &Effort,
    Budget { deadline, .. }: Budget,
) -> Vec<Margin> {
    let short = report.proof.as_ref().is_some_and(|proof| {
        proof.nodes <= SHORT_PROOF[usize::from(proof.rules.contains_key("tolerances"))]
    });
    // In space, where a platform turns, margins take many times as long as the proof: `summary` has them.
    let turns = claim.orientation.as_ref().is_some_and(|o| !matches!(o, Orientation::Range(_)));
    if !short || turns {
        return Vec::new();
    }
    let budget = Budget { max_boxes: 4 * SHORT_PROOF[0], deadline };
    let width = BigRational::new(1.into(), 1000.into());
    let Ok(problem) = Problem::new(claim) else { return Vec::new() };
    let angular = problem.legs.iter().any(orthocert_kernel::machine::Leg::is_angular);
    let all = Extreme::required(claim, problem.legs.len());
    let name = |extreme: &Extreme| format!("margin of {}", extreme.name());
    let names: Vec<String> = all.iter().map(name).collect();
    let found = effort.bar().at_once(&names, 0, |number, turns, control| {
        let (one, budget) = (&all[number], budget.shared(turns));
        let found = enclose((claim, true), one, &width, budget, control).ok()?;
        one.is_margin(claim, &found.outer).then(|| Margin::of(one, found.outer, angular))
    });
    found.into_iter().flatten().collect()
}

/// Where the certificate goes: never over the design.
fn target(output: Option<&Path>, design: Option<&Path>) -> Result<PathBuf, Failure> {
    let target = match (output, design) {
        (Some(output), _) => output.to_owned(),
        (None, Some(design)) => certificate_of(design),
        (None, None) => PathBuf::from(PROTOTYPE),
    };
    input::apart(&target, design)?;
    Ok(target)
}
