//! `orthocert attest`.

use super::check::examine;
use super::{input, print, Failure, Format, Status};
use crate::design::Design;
use crate::files::output;
use crate::jobs::attestation::{statement, Evidence};
use crate::report::escape;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The certificate
    #[arg(value_name = "CERT.json")]
    certificate: PathBuf,
    /// The design that the certificate is about
    #[arg(long, value_name = "DESIGN.toml")]
    design: PathBuf,
    /// Write the statement into this file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let Arguments { certificate: path, design: design_path, output } = arguments;
    if let Some(output) = output {
        output::probe(output)?;
        input::apart(output, [path, design_path])?;
    }
    // What is hashed is what is read: the bytes are taken once.
    let design_bytes = Design::bytes(design_path).map_err(Failure::input)?;
    let design = Design::of(&design_bytes, design_path).map_err(Failure::input)?;
    input::tell_notes(&design, Some(design_path), false);
    let certificate_bytes = input::certificate(path)?;
    let (certificate, accepted) = match examine(&certificate_bytes, Some(&design)) {
        Ok(examined) => examined,
        Err(reason) => return print::rejected(Format::Text, path, &reason, ""),
    };
    let statement = statement(&Evidence {
        design: &design,
        design_file: (&name(design_path), &design_bytes),
        certificate: &certificate,
        certificate_file: (&name(path), &certificate_bytes),
        accepted: &accepted,
    });
    match output {
        None => print::json(&statement)?,
        Some(output) => {
            let text = escape::json(&statement).map_err(|_| Failure::Defect)?;
            output::write(output, text.as_bytes())?;
        }
    }
    Ok(Status::Decided(accepted.verdict))
}

/// The name of a file, without the folders of this machine.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
