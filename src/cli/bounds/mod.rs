//! `orthocert bounds`.
//!
//! | module   | does                                                       |
//! |----------|------------------------------------------------------------|
//! | `search` | what is enclosed, and the time of each                     |
//! | `rows`   | what is told of each extreme, with its certificates        |
//! | `text`   | the answer for people                                      |

mod rows;
mod search;
mod text;

use super::{effort, input, interrupt, print, Failure, Format, Status};
use std::path::PathBuf;
use std::time::Instant;

/// Boxes after which a width is given up for a looser one: what closes at all mostly closes in a
/// few hundred; the condition number of the rotary Delta takes 40,000. A third of that for each coordinate
/// of orientation.
const BOXES: u64 = 100_000;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file; without it, the prototype of the paper
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Relative width of every enclosure
    #[arg(long, value_name = "WIDTH", default_value = "1e-6", allow_hyphen_values = true)]
    relative: String,
    /// Write both certificates of every bound into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let relative = input::rational_within("--relative", &arguments.relative, ["1e-12", "0.1"])?;
    let design = input::design(arguments.design.as_deref(), effort.quiet)?;
    if let Some(folder) = &arguments.output {
        input::probe_in(folder, "bounds.cert.json", arguments.design.as_deref())?;
    }
    effort.start_threads()?;
    let claim = &design.claim;
    let budget = effort.budget_or(effort::boxes_of(claim, BOXES), started)?;
    interrupt::grant();
    let (rows, singular) = search::rows(claim, &relative, arguments, budget)?;
    match effort.format {
        Format::Json => {
            let mut answer = serde_json::json!({ "bounds": rows });
            if let Some(unit) = design.unit {
                answer["length_unit"] = unit.into();
            }
            if let Some(found) = &singular {
                answer["counterexample"] = serde_json::to_value(found).map_err(Failure::input)?;
            }
            if interrupt::is_cancelled() {
                answer["interrupted"] = true.into();
            }
            print::json(&answer)?;
        }
        Format::Text => {
            let table = (&rows[..], singular.as_ref());
            print::answer(&text::text(table, &design, &relative, effort.quiet, started))?
        }
    }
    let complete = rows.iter().all(|row| row.not_enclosed.is_none());
    let status = if complete { Status::Done } else { Status::Undecided };
    rows.into_iter().try_for_each(|row| row.unwritten.told())?;
    interrupt::unless_cancelled(status)
}
