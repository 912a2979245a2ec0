//! `orthocert summary`.

use super::effort::{self, Effort};
use super::{input, interrupt, print, Failure, Format, Status};
use crate::exact::arithmetic::number;
use crate::questions::summary::{summary, text, Question};
use crate::report::text::headline_of;
use crate::report::Outcome;
use crate::search::solver::verify;
use num_rational::BigRational;
use orthocert_kernel::number::Expression;
use std::path::PathBuf;
use std::time::Instant;

/// Boxes after which a width is given up for a looser one; a third of that for each coordinate of
/// orientation.
const BOXES: u64 = 5_000;

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The verdict is that of the design's own requirements, and so is the exit code. Then follow the strokes of
the joints, the transmission factors, what the options ask for, and every quantity that the design
requires: never beyond the certified value, and somewhere as far as the other one, which is certified,
too. \"Seen\" is sampled, not certified. `verify` writes the certificate of the verdict, `bounds -o` those of
quantities.

Units are those of the design: V is in lengths per unit of time, F in forces, A in lengths per unit of
time squared; joint speeds and accelerations of arms are in degrees.")]
pub struct Arguments {
    /// The design file; without it, the prototype of the paper
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// The tool's greatest speed: how fast joints have to be
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    speed: Option<String>,
    /// The greatest force on the platform: how strong joints have to be
    #[arg(long, value_name = "F", allow_hyphen_values = true)]
    force: Option<String>,
    /// The tool's greatest acceleration, at a speed of up to V or, without --speed, at rest
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    acceleration: Option<String>,
    /// Relative distance of the two values of a quantity, looser where no proof is found [default: 0.001;
    /// of platforms that turn 0.01]
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    gap: Option<String>,
    #[command(flatten)]
    effort: Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let asked = |option, text: &Option<String>| -> Result<Option<Expression>, Failure> {
        let rational = |text| input::rational_within(option, text, input::SIZES);
        Ok(text.as_deref().map(rational).transpose()?.as_ref().map(number))
    };
    let speed = asked("--speed", &arguments.speed)?;
    let force = asked("--force", &arguments.force)?;
    let acceleration = asked("--acceleration", &arguments.acceleration)?;
    let gap = |text| input::rational_within("--gap", text, ["1e-9", "0.1"]);
    let gap = arguments.gap.as_deref().map(gap).transpose()?;
    let budget = effort.budget(started)?;
    let design = input::design(arguments.design.as_deref(), effort.quiet)?;
    let claim = &design.claim;
    let turns = claim.orientation.is_some();
    let of_widths = effort.budget_or(effort::boxes_of(claim, BOXES), started)?;
    effort.start_threads()?;
    let of_size = || BigRational::new(1.into(), if turns { 100 } else { 1000 }.into());
    let key = "mechanism.characteristic_length";
    let question = Question {
        speed,
        force,
        acceleration,
        one_unit: !turns || design.sources.position(key).is_some(),
        gap: gap.unwrap_or_else(of_size),
    };
    interrupt::grant();
    let mut bar = effort.bar();
    let found =
        bar.run("verdict", 5, |control| verify(claim, budget, control)).map_err(Failure::input)?;
    if found.is_cancelled() {
        return Err(Failure::Interrupted);
    }
    if effort.quiet && effort.format == Format::Text {
        let verdict = found
            .decided()
            .map_or(Outcome::Undecided, |(_, accepted)| Outcome::Decided(accepted.verdict));
        let name = arguments.design.as_ref().map(|path| path.to_string_lossy());
        let name = design.title.as_deref().or(name.as_deref()).unwrap_or_default();
        print::answer(&(headline_of(verdict, name, print::style()) + "\n"))?;
        return Ok(status(verdict));
    }
    let summary = bar.run("quantities", 1, |control| {
        summary(claim, &found, &question, of_widths, started, control)
    });
    drop(bar);
    let mut summary = summary?.ok_or_else(Failure::too_large)?;
    summary.title.clone_from(&design.title);
    summary.length_unit = design.unit;
    summary.design = arguments.design.as_ref().map(|path| path.to_string_lossy().into_owned());
    match effort.format {
        Format::Json => print::json(&summary)?,
        Format::Text if summary.interrupted => {
            let text = text::text(&summary, print::style());
            print::answer(&format!("{text}\n  {}\n", interrupt::PARTIAL))?;
        }
        Format::Text => print::answer(&text::text(&summary, print::style()))?,
    }
    interrupt::unless_cancelled(status(summary.verdict))
}

fn status(verdict: Outcome) -> Status {
    match verdict {
        Outcome::Decided(verdict) => Status::Decided(verdict),
        Outcome::Undecided => Status::Undecided,
    }
}
