//! How a reader repeats the check, and the digests of what is repeated.

use crate::exact::decimal::grouped;
use crate::files::digest::sha256;
use crate::report::escape::{shell, xml};
use orthocert_kernel::prover::SOURCES;
use std::fmt::Write;

/// The command, in the folder `proofs`, whose answer is [`checker_sha256`].
pub const CHECKER_COMMAND: &str =
    "find checker/src kernel/src -type f | LC_ALL=C sort | xargs sha256sum | sha256sum";

/// The sources of the checker and its kernel with which this program was built, in the order of their
/// paths.
fn sources() -> impl Iterator<Item = (String, &'static [u8])> {
    let checker = orthocert_checker::SOURCES.iter().map(|(path, bytes)| ("checker", path, *bytes));
    let kernel = SOURCES.iter().map(|(path, bytes)| ("kernel", path, *bytes));
    checker.chain(kernel).map(|(package, path, bytes)| (format!("{package}/src/{path}"), bytes))
}

/// The SHA-256 of the list of the SHA-256 of the checker's sources: one line a file, its digest, two
/// blanks, its path, in the order of the paths' bytes.
pub fn checker_sha256() -> String {
    let mut list = String::new();
    for (path, bytes) in sources() {
        let _ = writeln!(list, "{}  {path}", sha256(bytes));
    }
    sha256(list.as_bytes())
}

/// The section about a certificate.
pub fn section(file_name: &str, certificate: &[u8], version: &str) -> String {
    let codes = "Exit code 0: certified; 1: refuted; 5: the certificate proves nothing.";
    of("certificate", codes, file_name, certificate, version)
}

/// The section about a paving.
pub fn of_paving(file_name: &str, paving: &[u8], version: &str) -> String {
    let codes = "Exit code 0: accepted; 5: the paving proves nothing.";
    of("paving", codes, file_name, paving, version)
}

fn of(kind: &str, codes: &str, file_name: &str, certificate: &[u8], version: &str) -> String {
    let file = xml(&shell(file_name));
    let (digest, checker) = (sha256(certificate), checker_sha256());
    let bytes = grouped(certificate.len() as u64);
    format!(
        "<section id=\"recheck\"><h2>Check it again</h2>\
         <p>This page is a picture of the {kind} and proves nothing by itself. The {kind} \
         ({bytes} bytes) is the proof; its check needs the checker alone, a Rust program of integer \
         arithmetic that shares nothing with the search that found the proof.</p>\
         <h3>1. The {kind} is the one that this page is about</h3>\
         <pre>sha256sum {file}\n<span id=\"sha-certificate\">{digest}</span></pre>\
         <h3>2. The checker is the one that accepted it (orthocert {version})</h3>\
         <pre>cd proofs\n{command}\n<span id=\"sha-checker\">{checker}</span></pre>\
         <p class=\"note\">In a clone of orthocert: the digest of the list of digests of every file of the source of \
         the checker and its kernel, by path.</p>\
         <h3>3. The checker accepts it</h3>\
         <pre>cargo run --release -p orthocert-checker -- {file}</pre>\
         <p>or, where orthocert is installed, <code>orthocert check {file}</code>. {codes} It prints the claim in words: \
         compare it with the one above. <code>orthocert-verified {file}</code>, where it is built, is the formally verified \
         checker, for the claims that it covers: <code>proofs/rocq/README.md</code>. The theorems and the format are in <code>proofs/README.md</code> and \
         <code>proofs/FORMAT.md</code>.</p></section>\n",
        command = xml(CHECKER_COMMAND),
        version = xml(version),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::{Path, PathBuf};
    use std::process::Command;

    fn proofs() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs")
    }

    fn files(folder: &Path, under: &str, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let entry = entry.unwrap();
            let name = format!("{under}/{}", entry.file_name().into_string().unwrap());
            if entry.path().is_dir() {
                files(&entry.path(), &name, found);
            } else {
                found.push(name);
            }
        }
    }

    #[test]
    fn every_source_of_the_checker_is_in_the_digest() {
        let mut found = Vec::new();
        for name in ["checker", "kernel"] {
            let under = format!("{name}/src");
            files(&proofs().join(&under), &under, &mut found);
        }
        found.sort();
        let known: Vec<String> = sources().map(|(path, _)| path).collect();
        assert_eq!(known, found);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_command_shown_gives_the_digest_shown() {
        let run = Command::new("sh").args(["-c", CHECKER_COMMAND]).current_dir(proofs()).output();
        let answer = String::from_utf8(run.unwrap().stdout).unwrap();
        assert_eq!(answer.split_whitespace().next(), Some(checker_sha256().as_str()));
    }
}
