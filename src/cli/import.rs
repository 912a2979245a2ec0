//! `orthocert import`.

use super::{input, print, Failure, Status};
use clap::Subcommand;
use orthocert::import::{klipper, linuxcnc, Imported};
use orthocert::output;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    controller: Controller,
}

#[derive(Debug, Subcommand)]
enum Controller {
    /// A linear or rotary Delta of Klipper's printer.cfg
    Klipper {
        /// The configuration file
        #[arg(value_name = "FILE")]
        file: PathBuf,
        #[command(flatten)]
        target: Target,
    },
    /// A linear or rotary Delta of LinuxCNC: its .ini and .hal files, of which later ones override
    Linuxcnc {
        /// The configuration files
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        #[command(flatten)]
        target: Target,
    },
}

#[derive(Debug, clap::Args)]
struct Target {
    /// Where the design file is written; without it, on standard output
    #[arg(short, long, value_name = "DESIGN.toml")]
    output: Option<PathBuf>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let (files, target) = match &arguments.controller {
        Controller::Klipper { file, target } => (std::slice::from_ref(file), target),
        Controller::Linuxcnc { files, target } => (&files[..], target),
    };
    if let Some(output) = &target.output {
        input::apart(output, files)?;
    }
    let (imported, target) = match &arguments.controller {
        Controller::Klipper { file, target } => (klipper(&input::text(file)?, &name(file)), target),
        Controller::Linuxcnc { files, target } => {
            let texts: Vec<String> =
                files.iter().map(|file| input::text(file)).collect::<Result<_, _>>()?;
            let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
            let names: Vec<String> = files.iter().map(|file| name(file)).collect();
            (linuxcnc(&texts, &names.join(", ")), target)
        }
    };
    let imported: Imported = imported.map_err(Failure::input)?;
    for sentence in &imported.not_carried_over {
        print::diagnostic(&format!("not carried over: {sentence}"));
    }
    match &target.output {
        Some(path) => output::write(path, imported.design.as_bytes())?,
        None => print::answer(&imported.design)?,
    }
    Ok(Status::Done)
}

/// A file's name, without its folders.
fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
