//! `orthocert import`.

use super::{input, print, Failure, Status};
use crate::files::output;
use crate::import::{klipper, linuxcnc, marlin, reprap, smoothieware, Disk, Importer};
use clap::Subcommand;
use std::path::PathBuf;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    controller: Controller,
}

#[derive(Debug, Subcommand)]
enum Controller {
    /// A linear or rotary Delta of Klipper: its printer.cfg, with what that includes
    Klipper(Configuration),
    /// A linear or rotary Delta, a tripod or a hexapod of LinuxCNC: its .ini, with the HAL files that it names,
    /// then those of them that are elsewhere; or HAL files alone, in order
    Linuxcnc(Configuration),
    /// A linear Delta of Marlin 2: its Configuration.h, and further headers in order
    Marlin(Configuration),
    /// A linear or rotary Delta of RepRapFirmware: its config.g; config-override.g and macros that it
    /// calls are read beside it, or given as well
    Reprap(Configuration),
    /// A linear or rotary Delta of Smoothieware: its config; what it includes and config-override are
    /// read beside it, or given as well
    Smoothieware(Configuration),
}

#[derive(Debug, clap::Args)]
struct Configuration {
    /// The configuration files
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// A setting that is not understood and, as you know, does not change the geometry; repeatable
    #[arg(long, value_name = "KEY")]
    ignore: Vec<String>,
    /// Where the design file is written; without it, on standard output
    #[arg(short, long, value_name = "DESIGN.toml")]
    output: Option<PathBuf>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let (importer, configuration): (Importer, _) = match &arguments.controller {
        Controller::Klipper(configuration) => (klipper, configuration),
        Controller::Linuxcnc(configuration) => (linuxcnc, configuration),
        Controller::Marlin(configuration) => (marlin, configuration),
        Controller::Reprap(configuration) => (reprap, configuration),
        Controller::Smoothieware(configuration) => (smoothieware, configuration),
    };
    let Configuration { files, ignore, output } = configuration;
    if let Some(output) = output {
        input::apart(output, files)?;
    }
    let imported = importer(&Disk, files, ignore).map_err(Failure::input)?;
    if let Some(output) = output {
        input::apart(output, &imported.files)?;
    }
    imported.used.iter().for_each(|used| print::diagnostic(&format!("used: {used}")));
    imported.defaults.iter().for_each(|taken| print::diagnostic(&format!("default: {taken}")));
    imported.ignored.iter().for_each(|setting| print::diagnostic(&format!("ignored: {setting}")));
    for sentence in &imported.not_carried_over {
        print::diagnostic(&format!("not carried over: {sentence}"));
    }
    match output {
        Some(path) => output::write(path, imported.design.as_bytes())?,
        None => print::answer(&imported.design)?,
    }
    Ok(Status::Done)
}
