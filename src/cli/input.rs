//! Reading what commands are given: designs, certificates and numbers.

use super::Failure;
use orthocert::design::Design;
use orthocert_checker::certificate::MAX_BYTES;
use orthocert_checker::number::Exact;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Most digits of a literal on the command line, as in design files.
const MAX_DIGITS: usize = 1000;

/// The design of a file; without one, the prototype of the paper.
pub fn design(path: Option<&Path>) -> Result<Design, Failure> {
    match path {
        Some(path) => Design::read(path).map_err(Failure::input),
        None => Ok(Design::prototype()),
    }
}

/// The bytes of a certificate, one more than are admissible at most: the checker refuses those.
pub fn certificate(path: &Path) -> Result<Vec<u8>, Failure> {
    let unreadable =
        |reason: String| Failure::Input(format!("{}: cannot be read: {reason}", path.display()));
    if path.is_dir() {
        return Err(unreadable("it is a folder; accepted: a certificate (a JSON file)".to_owned()));
    }
    let mut bytes = Vec::new();
    let limit = MAX_BYTES as u64 + 1;
    let read = File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes));
    read.map_err(|error| unreadable(error.to_string()))?;
    Ok(bytes)
}

/// The exact number that an option's value is.
pub fn number(option: &str, text: &str) -> Result<Exact, Failure> {
    Exact::parse(text, MAX_DIGITS).map_err(|error| {
        let text: String = text.chars().take(60).collect();
        Failure::Input(format!(
            "{option}: found \"{text}\", which is not a number: {error}; accepted: a number such \
             as 2, 1.5, 3/2 or sqrt(2)"
        ))
    })
}

/// Refuses an output that is one of the files that are read: it would be lost.
pub fn apart(output: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let Ok(found) = fs::canonicalize(output) else { return Ok(()) };
    let is_read = |input: &PathBuf| fs::canonicalize(input).is_ok_and(|input| input == found);
    if inputs.iter().any(is_read) {
        let path = output.display();
        let refused = format!("--output: {path} is a file that is read; accepted: another path");
        return Err(Failure::Input(refused));
    }
    Ok(())
}
