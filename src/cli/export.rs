//! `orthocert export`.

use super::{input, print, Failure, Status};
use clap::Subcommand;
use orthocert::{export, output};
use orthocert_checker::read;
use std::path::PathBuf;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    language: Language,
}

#[derive(Debug, Subcommand)]
enum Language {
    /// A Rocq file that states the claim and proves it by the certificate.
    Rocq {
        /// The certificate
        #[arg(value_name = "CERT.json")]
        certificate: PathBuf,
        /// Where the file is written; without it, on standard output
        #[arg(short, long, value_name = "FILE.v")]
        output: Option<PathBuf>,
    },
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let Language::Rocq { certificate: path, output } = &arguments.language;
    let bytes = input::certificate(path)?;
    let certificate = match read(&bytes) {
        Ok(certificate) => certificate,
        Err(reason) => {
            print::diagnostic(&format!("{}: REJECTED: {reason}", path.display()));
            return Ok(Status::Rejected);
        }
    };
    let text = export::rocq::rocq(&certificate)
        .map_err(|error| Failure::Input(format!("{}: not exported: {error}", path.display())))?;
    match output {
        Some(file) => output::write(file, text.as_bytes())?,
        None => print::answer(&text)?,
    }
    Ok(Status::Done)
}
