//! `orthocert postulate`.

use super::{certify, effort::Effort, input, print, Failure, Format, Status};
use crate::design::written;
use crate::files::output;
use crate::questions::postulate::prove;
use crate::report::{text, PostulateReport};
use clap::ArgGroup;
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{Every, PostulateClaim, PsiMax, Quantity};
use orthocert_kernel::number::Expression;
use orthocert_kernel::postulate::parts;
use std::path::PathBuf;
use std::time::Instant;

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(group = ArgGroup::new("for").required(true).args(["psi", "psi_range", "all"]))]
pub struct Arguments {
    /// Prove it for this psi_max
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    psi: Option<String>,
    /// Prove it for every psi_max from A to B
    #[arg(long, value_name = "A..B", allow_hyphen_values = true)]
    psi_range: Option<String>,
    /// Prove it for every psi_max > 1
    #[arg(long)]
    all: bool,
    /// Where the certificate is written; without it, nowhere
    #[arg(short, long, value_name = "CERT.json")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let Arguments { effort, output: target, .. } = arguments;
    let budget = effort.budget(started)?;
    let claim = PostulateClaim { psi_max: arguments.psi_max()? };
    parts(&claim).map_err(|_| arguments.refused())?;
    target.as_deref().map_or(Ok(()), output::probe)?;
    effort.start_threads()?;
    let mut found = effort.run(|control| prove(&claim, budget, control)).map_err(Failure::input)?;
    let decision = certify::decided(&mut found)?;
    let report = PostulateReport::new(&claim, &found, started.elapsed());
    let mut report = report.ok_or(Failure::Interrupted)?;
    let status = match (decision, target) {
        (Some(decision), Some(target)) => {
            report.certificate = Some(certify::store(None, target, &decision.text)?);
            Status::Decided(decision.verdict)
        }
        (Some(decision), None) => Status::Decided(decision.verdict),
        (None, target) => {
            let claim = Claim::Postulate(claim);
            report.earlier_certificate = target
                .as_ref()
                .and_then(|target| certify::earlier(target, |own| own.claim == claim));
            Status::Undecided
        }
    };
    let style = print::style();
    match effort.format {
        Format::Json => print::json(&report)?,
        Format::Text if effort.quiet => {
            print::answer(&(text::postulate_headline(&report, style) + "\n"))?;
        }
        Format::Text => print::answer(&text::postulate(&report, style))?,
    }
    Ok(status)
}

impl Arguments {
    fn refused(&self) -> Failure {
        let (flag, text, accepted) = match (&self.psi, &self.psi_range) {
            (Some(psi), _) => ("--psi", psi.as_str(), "a number greater than 1"),
            (None, range) => {
                let text = range.as_deref().unwrap_or_default();
                ("--psi-range", text, "two numbers greater than 1, the lesser first")
            }
        };
        input::refused(flag, text, accepted)
    }

    fn psi_max(&self) -> Result<PsiMax, Failure> {
        let psi_max = match (&self.psi, &self.psi_range) {
            (Some(psi), _) => Quantity::Exactly(number("--psi", psi)?),
            (None, Some(range)) => {
                let (min, max) = range.split_once("..").ok_or_else(|| {
                    input::refused("--psi-range", range, "two numbers, such as 1.5..3")
                })?;
                let (min, max) = (number("--psi-range", min)?, number("--psi-range", max)?);
                match min == max {
                    true => Quantity::Exactly(max),
                    false => Quantity::Between { min, max },
                }
            }
            (None, None) => return Ok(PsiMax::Every(Every::All)),
        };
        Ok(PsiMax::Of(psi_max))
    }
}

fn number(option: &str, text: &str) -> Result<Expression, Failure> {
    written(&input::number(option, text)?).ok_or_else(|| {
        Failure::Input(format!(
            "{option}: found \"{}\", whose exact value is too long; accepted: a shorter number",
            input::quoted(text)
        ))
    })
}
