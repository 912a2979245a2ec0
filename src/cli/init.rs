//! `orthocert init`.

use super::{print, Failure, Status};
use crate::design::{template, OTHER_NAMES, TEMPLATES};
use clap::builder::{PossibleValue, PossibleValuesParser};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The kind of design; `hexapod` is spatial, `delta` a linear Delta
    #[arg(long, default_value = TEMPLATES[0].0, value_parser = kinds())]
    kind: String,
}

fn kinds() -> PossibleValuesParser {
    let kind = |(name, _): &(&'static str, _)| {
        let others = OTHER_NAMES.iter().filter(|(_, own)| own == name).map(|(other, _)| *other);
        PossibleValue::new(*name).aliases(others)
    };
    PossibleValuesParser::new(TEMPLATES.iter().map(kind))
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let text = template(&arguments.kind)
        .ok_or_else(|| Failure::Input(format!("--kind: there is no kind {}", arguments.kind)))?;
    print::document(text)?;
    Ok(Status::Done)
}
