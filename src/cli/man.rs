//! `orthocert man`.

use super::{Failure, Status, EXIT_CODES};
use crate::files::output;
use clap::{Command, CommandFactory};
use clap_mangen::roff::{roman, Roff};
use clap_mangen::Man;
use std::io;
use std::path::{Path, PathBuf};

/// Where the pages come from, in their last lines.
const SOURCE: &str = concat!("orthocert ", env!("CARGO_PKG_VERSION"));

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder of the pages; it is made if it is not there
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let mut command = super::Arguments::command().disable_help_subcommand(true);
    command.build();
    write(&arguments.folder, &command)?;
    Ok(Status::Done)
}

/// Writes the page of a command, and those of the commands below it.
fn write(folder: &Path, command: &Command) -> Result<(), Failure> {
    let page = Man::new(command.clone()).source(SOURCE).manual("orthocert");
    let name = page.get_filename();
    let page = page.title(name.trim_end_matches(".1").to_uppercase());
    let text = render(&page, command, &name).map_err(|error| Failure::Output(error.to_string()))?;
    output::write_below(folder, &folder.join(name), &text)?;
    command.get_subcommands().try_for_each(|below| write(folder, below))
}

/// What `--help` says, in the sections of a manual page.
fn render(page: &Man, command: &Command, name: &str) -> io::Result<Vec<u8>> {
    let mut text = Vec::new();
    page.render_title(&mut text)?;
    page.render_name_section(&mut text)?;
    page.render_synopsis_section(&mut text)?;
    page.render_description_section(&mut text)?;
    page.render_options_section(&mut text)?;
    if command.has_subcommands() {
        page.render_subcommands_section(&mut text)?;
    }
    let mut end = Roff::new();
    exit_status(&mut end);
    // The checker's own program and the command of the same name share a page.
    if name == "orthocert-check.1" {
        the_checker_alone(&mut end);
    }
    if command.get_name() != "orthocert" {
        end.control("SH", ["SEE ALSO"]).text([roman("orthocert(1)")]);
    }
    end.to_writer(&mut text)?;
    Ok(text)
}

fn exit_status(page: &mut Roff) {
    let mut lines = EXIT_CODES.lines();
    page.control("SH", ["EXIT STATUS"]);
    page.text(lines.next().map(roman).into_iter().collect::<Vec<_>>());
    for (code, meaning) in lines.filter_map(|line| line.trim().split_once("  ")) {
        page.control("TP", []).text([roman(code)]).text([roman(meaning)]);
    }
}

fn the_checker_alone(page: &mut Roff) {
    page.control("SH", ["THE CHECKER ALONE"]);
    page.text([roman("The program orthocert-check has nothing of the prover:")]);
    page.control("PP", []).control("nf", []);
    for line in orthocert_checker::USAGE.lines() {
        page.text([roman(line)]);
    }
    page.control("fi", []);
}
