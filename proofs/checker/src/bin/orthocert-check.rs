//! `orthocert-check FILE`: exit 0 for an accepted certificate that certifies and for an accepted
//! paving, 1 for an accepted refutation, 5 for a file that proves nothing, 2 for bad usage.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

use orthocert_checker::certificate::{Verdict, MOST_BYTES};
use orthocert_checker::paving;
use orthocert_checker::{check, read, statement, Rejected, USAGE};
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<std::ffi::OsString> = std::env::args_os().skip(1).collect();
    let [path] = arguments.as_slice() else {
        return usage();
    };
    match path.to_str() {
        Some("-h" | "--help") => return print(USAGE, ExitCode::SUCCESS),
        Some("-V" | "--version") => {
            let version = concat!("orthocert-check ", env!("CARGO_PKG_VERSION"));
            return print(version, ExitCode::SUCCESS);
        }
        Some(option) if option.starts_with('-') && option != "-" => return usage(),
        _ => {}
    }
    let path = Path::new(path);
    let mut bytes = Vec::new();
    let limit = MOST_BYTES as u64 + 1;
    let file = open(path).and_then(|mut file| {
        Read::by_ref(&mut file).take(limit).read_to_end(&mut bytes)?;
        Ok(BufReader::new(file))
    });
    let rest = match file {
        Ok(rest) => rest,
        Err(error) => {
            complain(&format_args!("orthocert-check: {}: {error}", path.to_string_lossy()));
            return ExitCode::from(2);
        }
    };
    let accepted = match paving::is_paving(&bytes) {
        // What was read is not read again: the file may be a pipe, or another one by now.
        true => of_paving(bytes.as_slice().chain(rest)).map_err(|reason| reason.to_string()),
        false => of_certificate(&bytes).map_err(|reason| reason.to_string()),
    };
    match accepted {
        Ok((what, words, code)) => print(&format!("ACCEPTED: {what}\n{words}"), code),
        Err(reason) => {
            complain(&format_args!("REJECTED: {reason}"));
            ExitCode::from(5)
        }
    }
}

/// A regular file, also at the end of a link, since a pipe may never begin and a device never end; or what is named as the
/// system's, such as `/dev/stdin`.
fn open(path: &Path) -> io::Result<File> {
    if fs::metadata(path)?.is_file() || path.starts_with("/dev") {
        return File::open(path);
    }
    Err(io::Error::other("no regular file"))
}

/// What is accepted, what it establishes, and the exit code.
type Accepted = (String, String, ExitCode);

fn of_certificate(bytes: &[u8]) -> Result<Accepted, Rejected> {
    let certificate = read(bytes)?;
    let verdict = check(&certificate)?;
    let code = match verdict {
        Verdict::Certified => ExitCode::SUCCESS,
        Verdict::Refuted => ExitCode::from(1),
    };
    Ok((verdict.to_string(), statement::established(&certificate), code))
}

fn of_paving(input: impl BufRead) -> Result<Accepted, paving::Rejected> {
    let words = orthocert_kernel::statement::paving(&paving::check(input)?);
    Ok(("paving".to_owned(), words, ExitCode::SUCCESS))
}

/// A sentence on standard error, on one line.
fn complain(sentence: &dyn Display) {
    let sentence = plain(&sentence.to_string()).replace('\n', "?");
    let _ = writeln!(std::io::stderr().lock(), "{sentence}");
}

/// In printable ASCII and without `#`: what is quoted of a file reorders or hides nothing, and commands
/// neither terminals nor runners, as our own words begin each line.
fn plain(text: &str) -> String {
    let is_plain = |c: char| matches!(c, '\n' | ' '..='~') && c != '#';
    text.chars().map(|c| if is_plain(c) { c } else { '?' }).collect()
}

fn usage() -> ExitCode {
    let _ = writeln!(std::io::stderr().lock(), "{USAGE}");
    ExitCode::from(2)
}

/// Prints `text`; a closed or full output is an I/O failure, not a verdict.
fn print(text: &str, code: ExitCode) -> ExitCode {
    match writeln!(std::io::stdout().lock(), "{}", plain(text.trim_end())) {
        Ok(()) => code,
        Err(_) => ExitCode::from(4),
    }
}
