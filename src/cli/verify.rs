//! `orthocert verify`.

use super::{certify, effort::Effort, print, Failure, Format, Status};
use orthocert::design::Design;
use orthocert::output;
use orthocert::report::{text, Report};
use orthocert::verify::verify;
use orthocert_checker::claim::Claim;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The certificate of the built-in prototype, in the current folder.
const PROTOTYPE: &str = "orthoglide-prototype.cert.json";

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design; without it, the paper's prototype (cube of 200 mm, psi_max = 2)
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Where the certificate is written [default: NAME.cert.json beside NAME.toml]
    #[arg(short, long, value_name = "CERT.json")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: Effort,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let Arguments { design: path, effort, .. } = arguments;
    let budget = effort.budget(started)?;
    let design = match path {
        Some(path) => Design::read(path).map_err(Failure::input)?,
        None => Design::prototype(),
    };
    let target = arguments.target()?;
    output::probe(&target)?;
    effort.start_threads()?;
    let Claim::Machine(claim) = &design.claim else {
        return Err(Failure::Input("a design is about a machine".to_owned()));
    };
    let mut found = effort.run(|control| verify(claim, budget, control)).map_err(Failure::input)?;
    let decision = certify::decide(&mut found.answer)?;
    let mut report = Report::new(claim, &found, started.elapsed()).ok_or_else(|| {
        Failure::Input("the design's numbers exceed what can be reported".to_owned())
    })?;
    report.title.clone_from(&design.title);
    report.design = path.as_ref().map(|path| path.display().to_string());
    let status = match decision {
        Some(decision) => {
            report.certificate = Some(certify::store(&target, &decision.text)?);
            Status::Decided(decision.verdict)
        }
        None => {
            report.earlier_certificate = certify::earlier(&target, &design.claim);
            Status::Undecided
        }
    };
    match effort.format {
        Format::Json => print::json(&report)?,
        Format::Text if effort.quiet => {
            print::answer(&(text::headline(&report, print::style()) + "\n"))?;
        }
        Format::Text => print::answer(&text::report(&report, print::style()))?,
    }
    Ok(status)
}

impl Arguments {
    /// Where the certificate goes: never over the design.
    fn target(&self) -> Result<PathBuf, Failure> {
        let target = match (&self.output, &self.design) {
            (Some(output), _) => output.clone(),
            (None, Some(design)) => beside(design),
            (None, None) => PathBuf::from(PROTOTYPE),
        };
        if self.design.as_deref().is_some_and(|design| same_file(design, &target)) {
            let path = target.display();
            let message = format!("--output: {path} is the design itself; accepted: another path");
            return Err(Failure::Input(message));
        }
        Ok(target)
    }
}

/// `NAME.cert.json` beside `NAME.toml`.
fn beside(design: &Path) -> PathBuf {
    let toml = design.extension().is_some_and(|extension| extension == "toml");
    let name = if toml { design.file_stem() } else { design.file_name() };
    let mut name = name.unwrap_or_default().to_owned();
    name.push(".cert.json");
    design.with_file_name(name)
}

fn same_file(one: &Path, other: &Path) -> bool {
    match (fs::canonicalize(one), fs::canonicalize(other)) {
        (Ok(one), Ok(other)) => one == other,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn certificates_stand_beside_their_designs() {
        for (design, certificate) in [
            ("a.toml", "a.cert.json"),
            ("x/y/delta.v2.toml", "x/y/delta.v2.cert.json"),
            ("x/plain", "x/plain.cert.json"),
        ] {
            assert_eq!(beside(Path::new(design)), Path::new(certificate));
        }
    }
}
