//! `orthocert tolerance`.
//!
//! | module | does                                                                      |
//! |--------|---------------------------------------------------------------------------|
//! | `rows` | what each row widens, their search side by side, and what they tell       |
//! | `text` | the answer for people                                                     |

mod rows;
mod text;

use super::ends::gap;
use super::{effort, input, interrupt, print, Failure, Format, Status};
use crate::design::Design;
use crate::exact::decimal::exact;
use crate::questions::tolerance::{Kind, Scheme};
use crate::report::counterexample;
use crate::search::solver::{proof, refutation};
use crate::search::Budget;
use num_rational::BigRational;
use orthocert_checker::certificate::{Proof, Verdict};
use orthocert_kernel::claim::{MachineClaim, Mechanism};
use rows::Question;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;
use text::text;

/// Boxes after which a tolerance counts as not certified: what closes at all mostly closes in a few
/// hundred, or in a few times as many as without tolerances.
const BOXES: (usize, usize) = (2_000, 4);

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// The kinds of parameters: leg_length, anchor, direction, platform, axis, reference, arm
    /// [default: all that the mechanism has]
    #[arg(long, value_name = "KIND,...", value_delimiter = ',')]
    on: Vec<String>,
    /// Relative distance of the certified and the refuted tolerance to stop at
    #[arg(long, value_name = "WIDTH", default_value = "0.1", allow_hyphen_values = true)]
    gap: String,
    /// Time for each row of the answer, by the clock; rows that are searched side by side share the cores [default: no
    /// limit]: seconds, or a number with ms, s, min or h
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    each: Option<String>,
    /// Widen the parameters of one leg at a time, too, and rank the legs
    #[arg(long)]
    by_leg: bool,
    /// Tell the tolerances of directions as those of their components, as the design writes them
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,
    /// Write the certificates of both ends into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let width = gap(&arguments.gap, ["1e-6", "0.5"])?;
    let design = input::design(Some(&arguments.design), effort.quiet)?;
    let claim = &design.claim;
    let kinds = named(&arguments.on, &design)?;
    if let Some(folder) = &arguments.output {
        input::probe_in(folder, "tolerance.cert.json", Some(&arguments.design))?;
    }
    let each = arguments.each.as_deref().map(|text| effort::time("--each", text)).transpose()?;
    let budget = effort.budget(started)?;
    effort.start_threads()?;
    let nominal = Scheme::common(&kinds).claim(claim, &BigRational::from_integer(0.into()));
    let nodes = match nodes_or_status(&nominal, arguments, budget)? {
        Ok(nodes) => nodes,
        Err(status) => return Ok(status),
    };
    let enough = BOXES.0.max(BOXES.1.saturating_mul(nodes));
    let budget = effort.budget_or(enough as u64, started)?;
    let legs = if arguments.by_leg { claim.mechanism.legs().len() } else { 0 };
    interrupt::grant();
    let question = Question { claim, width, each, budget, arguments, design: &design };
    let rows = question.rows(&kinds, legs)?;
    match effort.format {
        Format::Json => {
            let each = &arguments.each;
            let mut answer =
                serde_json::json!({ "nominal": "certified", "each": each, "tolerances": rows });
            if interrupt::is_cancelled() {
                answer["interrupted"] = true.into();
            }
            print::json(&answer)?;
        }
        Format::Text => print::answer(&text(&rows, arguments, &design, started))?,
    }
    let complete = rows.iter().all(|row| row.gap_reached);
    let status = if complete { Status::Done } else { Status::Undecided };
    rows.into_iter().try_for_each(|row| row.unwritten.told())?;
    interrupt::unless_cancelled(status)
}

/// The kinds that are asked for, in the order of [`Kind::ALL`].
fn named(on: &[String], design: &Design) -> Result<Vec<Kind>, Failure> {
    let claim = &design.claim;
    let there = Kind::of(&claim.mechanism);
    if let Mechanism::Orthoglide { .. } = &claim.mechanism {
        return Err(Failure::Input(design.refused(
            "workspace.cube",
            "the Orthoglide that meets its bounds with equality, which leaves no room for tolerances",
            "of tolerance, a design with leg_length, min and max",
        )));
    }
    if there.is_empty() {
        return Err(Failure::Input(design.refused(
            "mechanism.kind",
            "a machine by formulas, whose parameters are of no kinds",
            "of tolerance, a machine of legs; limit says how far any number of a design goes",
        )));
    }
    for name in on {
        if !there.iter().any(|kind| kind.name() == name.trim()) {
            let names: Vec<&str> = there.iter().map(|kind| kind.name()).collect();
            return Err(Failure::Input(format!(
                "--on: found \"{}\"; accepted, as this mechanism has them: {}",
                input::quoted(name),
                names.join(", ")
            )));
        }
    }
    let wanted = |kind: &Kind| on.is_empty() || on.iter().any(|name| kind.name() == name.trim());
    Ok(there.into_iter().filter(wanted).collect())
}

/// The nodes of the proof of the design with nominal values. If it is not certified, says so and
/// gives the status.
fn nodes_or_status(
    nominal: &MachineClaim,
    arguments: &Arguments,
    budget: Budget,
) -> Result<Result<usize, Status>, Failure> {
    let effort = &arguments.effort;
    let refuted = refutation(nominal);
    let counterexample = refuted.as_deref().and_then(counterexample);
    if refuted.is_none() {
        let found = effort.run(|control| proof(nominal, budget, control));
        interrupt::unless_cancelled(())?;
        if let Ok(Proof::Tree(tree)) = found.map(|certificate| certificate.proof) {
            return Ok(Ok(tree.nodes.len()));
        }
    }
    let (word, status, known) = match refuted {
        Some(_) => (
            "refuted",
            Status::Decided(Verdict::Refuted),
            "There is no tolerance with which it could be certified.",
        ),
        None => (
            "undecided",
            Status::Undecided,
            "Nothing is known of tolerances: the nominal design is undecided within the budget;\n\
             raise --max-boxes or --timeout.",
        ),
    };
    match effort.format {
        Format::Json => print::json(&serde_json::json!({
            "nominal": word, "counterexample": counterexample, "each": &arguments.each,
            "tolerances": [],
        }))?,
        Format::Text => {
            let mut out = format!(
                "{}  the design without tolerances on the parameters named.\n{known}\n",
                word.to_uppercase()
            );
            if let Some(found) = counterexample {
                let _ = writeln!(out, "\n  {}", found.value);
                let point: Vec<String> = found.point.iter().map(exact).collect();
                let _ = writeln!(out, "  at P = ({})", point.join(", "));
            }
            print::answer(&out)?;
        }
    }
    Ok(Err(status))
}
