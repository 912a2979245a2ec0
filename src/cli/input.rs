//! Reading what commands are given: designs, certificates and numbers.

use super::{print, Failure};
use crate::design::{may_be_tolerance, Design};
use crate::exact::Exact;
use crate::files::open::reader;
use crate::files::output::{self, OutputError};
use crate::files::read::{identity, meant, Named};
use num_rational::BigRational;
use orthocert_checker::certificate::MOST_BYTES;
use std::cmp::Ordering;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Take};
use std::ops::RangeInclusive;
use std::path::Path;

/// Most digits of a literal on the command line, as in design files.
const MAX_DIGITS: usize = 1000;
/// Most characters of what was given in a message.
const MOST_QUOTED: usize = 60;

/// The design of a file; without one, the prototype of the paper. What its claim leaves out is told,
/// unless `quiet`.
pub fn design(path: Option<&Path>, quiet: bool) -> Result<Design, Failure> {
    let design = match path {
        Some(path) => Design::read(path).map_err(Failure::input)?,
        None => Design::prototype(),
    };
    tell_notes(&design, path, quiet);
    Ok(design)
}

/// Tells what a design has and its claim has not.
pub fn tell_notes(design: &Design, path: Option<&Path>, quiet: bool) {
    let Some(path) = path.filter(|_| !quiet) else { return };
    design.notes().iter().for_each(|note| print::diagnostic(&format!("{}: {note}", path.shown())));
}

/// The bytes of a certificate, one more than are admissible at most: the checker refuses those.
pub fn certificate(path: &Path) -> Result<Vec<u8>, Failure> {
    Ok(Begun::new(path, "a certificate (a JSON file)")?.start)
}

/// A file of which the beginning was read, as much as a certificate may have and a byte more; what
/// follows is read from the same file, whatever its name stands for by then.
pub struct Begun {
    /// The beginning.
    pub start: Vec<u8>,
    rest: BufReader<Take<File>>,
}

impl Begun {
    /// Reads the beginning of what is accepted.
    pub fn new(path: &Path, accepted: &str) -> Result<Self, Failure> {
        let unreadable = |reason: &dyn std::fmt::Display| {
            Failure::Input(format!("{}: cannot be read: {reason}", path.shown()))
        };
        if path.is_dir() {
            return Err(unreadable(&format!("it is a folder; accepted: {accepted}")));
        }
        let mut start = Vec::new();
        let mut rest = reader(meant(path)).map_err(|error| unreadable(&error))?;
        let read = rest.by_ref().take(MOST_BYTES as u64 + 1).read_to_end(&mut start);
        read.map_err(|error| unreadable(&error))?;
        Ok(Begun { start, rest })
    }

    /// All of it, from the beginning.
    pub fn whole(self) -> impl Read {
        io::Cursor::new(self.start).chain(self.rest)
    }
}

/// From where to where lengths, speeds and forces of options are.
pub const SIZES: [&str; 2] = ["1e-100", "1e100"];

/// The exact number that an option's value is.
pub fn number(option: &str, text: &str) -> Result<Exact, Failure> {
    let shown = quoted(text);
    if may_be_tolerance(text) {
        return Err(Failure::Input(format!(
            "{option}: found \"{shown}\", which may be read as a tolerance; accepted: one number such as \
             2, 1.5, 3/2 or sqrt(2), in a sum blanks on both sides of a sign or on neither"
        )));
    }
    Exact::parse(text, MAX_DIGITS).map_err(|error| {
        let number = text.starts_with(|c: char| c.is_ascii_digit());
        let with_unit = number && text.ends_with(|c: char| c.is_alphabetic());
        let hint =
            if with_unit { "; numbers carry no unit: lengths are in the design's" } else { "" };
        Failure::Input(format!(
            "{option}: found \"{shown}\", which is not a number: {error}; accepted: a number such \
             as 2, 1.5, 3/2 or sqrt(2){hint}"
        ))
    })
}

/// The number that an option's value is, from one end to the other.
pub fn within(option: &str, text: &str, ends: [&str; 2]) -> Result<Exact, Failure> {
    let found = number(option, text)?;
    let (least, greatest) = (number(option, ends[0])?, number(option, ends[1])?);
    let is_within = found.compare(&least).is_some_and(Ordering::is_ge)
        && found.compare(&greatest).is_some_and(Ordering::is_le);
    match is_within {
        true => Ok(found),
        false => Err(refused(option, text, &format!("a number from {} to {}", ends[0], ends[1]))),
    }
}

/// The same, if it is rational.
pub fn rational_within(option: &str, text: &str, ends: [&str; 2]) -> Result<BigRational, Failure> {
    let found = within(option, text, ends)?.as_rational().cloned();
    let accepted = || format!("a rational number from {} to {}", ends[0], ends[1]);
    found.ok_or_else(|| refused(option, text, &accepted()))
}

/// That an option's value is not one of those accepted.
pub fn refused(option: &str, found: &str, accepted: &str) -> Failure {
    Failure::Input(format!("{option}: found \"{}\"; accepted: {accepted}", quoted(found)))
}

/// What messages show of a text that was given.
pub fn quoted(text: &str) -> String {
    text.chars().take(MOST_QUOTED).collect()
}

/// Reads an option's value that is a whole number of this range; what begins with a sign is a value, too.
pub fn whole(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<u64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        let (first, last) = (range.start(), range.end());
        number.ok_or_else(|| format!("accepted: a whole number from {first} to {last}"))
    }
}

/// Refuses an output that is one of the files that are read: it would be lost.
pub fn apart<P: AsRef<Path>>(
    output: &Path,
    inputs: impl IntoIterator<Item = P>,
) -> Result<(), Failure> {
    let own = identity(output);
    // Nothing is lost of a terminal or a pipe.
    if own.exists() && !own.is_file() {
        return Ok(());
    }
    if inputs.into_iter().any(|input| identity(meant(input.as_ref())) == own) {
        let path = output.shown();
        let refused = format!("--output: {path} is a file that is read; accepted: another path");
        return Err(Failure::Input(refused));
    }
    Ok(())
}

/// Says so where an earlier run left an unfinished paving or map, which begins like this; anything else stays.
pub fn not_taken_up(part: &Path, begins: &[u8], what: &str) -> Result<(), Failure> {
    if fs::symlink_metadata(part).is_err() {
        return Ok(());
    }
    let mut start = Vec::new();
    // Where another run is writing it, that is all there is to say.
    let read = output::open_locked(part, false)?.take(begins.len() as u64).read_to_end(&mut start);
    read.map_err(|error| Failure::from(OutputError::Io(part.to_owned(), error)))?;
    let part = part.shown();
    if !begins.starts_with(&start) {
        return Err(Failure::Input(format!(
            "--output: {part} is in the way, which is no unfinished {what}; accepted: another path"
        )));
    }
    if !start.is_empty() {
        print::diagnostic(&format!(
            "{part}, which another run left, is not taken up: --resume would"
        ));
    }
    Ok(())
}

/// Refuses a folder into which certificates, one of this name, cannot be written, or in which one might take the place of
/// the design.
pub fn probe_in(folder: &Path, name: &str, design: Option<&Path>) -> Result<(), Failure> {
    output::probe(&folder.join(name))?;
    design.map_or(Ok(()), |design| apart_in(folder, design))
}

fn apart_in(folder: &Path, design: &Path) -> Result<(), Failure> {
    let is_certificate = design.to_string_lossy().ends_with(".cert.json");
    match design.file_name().filter(|_| is_certificate) {
        Some(name) => apart(&folder.join(name), [design]),
        None => Ok(()),
    }
}

/// What to do with a file that is no certificate, but named as designs are.
pub fn design_hint(path: &Path) -> String {
    match path.extension().is_some_and(|extension| extension == "toml") {
        true => format!(
            "; this is a design: `orthocert verify {}` proves or refutes it, and writes a certificate",
            path.shown()
        ),
        false => String::new(),
    }
}
