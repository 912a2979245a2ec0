//! `orthocert init`.

use super::{print, Failure, Status};
use clap::builder::PossibleValuesParser;
use orthocert::design::{template, TEMPLATES};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The kind of design
    #[arg(long, default_value = TEMPLATES[0].0, value_parser = kinds())]
    kind: String,
}

fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(TEMPLATES.iter().map(|(name, _)| *name))
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let text = template(&arguments.kind)
        .ok_or_else(|| Failure::Input(format!("--kind: there is no kind {}", arguments.kind)))?;
    print::document(text)?;
    Ok(Status::Done)
}
