//! How a reader repeats the check, and the digests of what is repeated.

use crate::decimal::grouped;
use crate::digest::sha256;
use crate::escape::{shell, xml};
use std::fmt::Write;

/// The command, in the folder `proofs/checker`, whose answer is [`checker_sha256`].
pub const CHECKER_COMMAND: &str =
    "find Cargo.toml src -type f | LC_ALL=C sort | xargs sha256sum | sha256sum";

macro_rules! checker_sources {
    ($($path:literal),* $(,)?) => {
        [$(($path, include_bytes!(concat!("../../proofs/checker/", $path)))),*]
    };
}

/// The sources of the checker with which this program was built, in the order of their paths.
const SOURCES: &[(&str, &[u8])] = &checker_sources![
    "Cargo.toml",
    "src/atlas/instance.rs",
    "src/atlas/mod.rs",
    "src/atlas/role.rs",
    "src/bin/orthocert-check.rs",
    "src/cell.rs",
    "src/certificate.rs",
    "src/check/evaluate.rs",
    "src/check/machine.rs",
    "src/check/mod.rs",
    "src/check/postulate.rs",
    "src/check/rejected.rs",
    "src/check/walk.rs",
    "src/claim/form.rs",
    "src/claim/leg.rs",
    "src/claim/mod.rs",
    "src/claim/validate.rs",
    "src/definite.rs",
    "src/enclosure.rs",
    "src/expansion.rs",
    "src/file.rs",
    "src/fixed.rs",
    "src/hull.rs",
    "src/kinematics/arm.rs",
    "src/kinematics/mod.rs",
    "src/kinematics/planar.rs",
    "src/kinematics/slider.rs",
    "src/kinematics/strut.rs",
    "src/lib.rs",
    "src/linear.rs",
    "src/model.rs",
    "src/number/mod.rs",
    "src/number/operand.rs",
    "src/number/read.rs",
    "src/paving/code.rs",
    "src/paving/judge.rs",
    "src/paving/mod.rs",
    "src/paving/reader.rs",
    "src/paving/symmetry.rs",
    "src/postulate.rs",
    "src/rule/conditioning.rs",
    "src/rule/joints.rs",
    "src/rule/margin.rs",
    "src/rule/mod.rs",
    "src/rule/outside.rs",
    "src/rule/vertex.rs",
    "src/rule/violated.rs",
    "src/shown.rs",
    "src/statement.rs",
    "src/strict.rs",
    "src/trig.rs",
    "src/witness.rs",
    "src/word.rs",
];

/// The SHA-256 of the list of the SHA-256 of the checker's sources: one line a file, its digest, two
/// blanks, its path, in the order of the paths' bytes.
pub fn checker_sha256() -> String {
    let mut list = String::new();
    for (path, bytes) in SOURCES {
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
         <pre>cd proofs/checker\n{command}\n<span id=\"sha-checker\">{checker}</span></pre>\
         <p class=\"note\">In a clone of orthocert: the digest of the list of digests of every file of the checker's \
         source, by path.</p>\
         <h3>3. The checker accepts it</h3>\
         <pre>cargo run --release -p orthocert-checker -- {file}</pre>\
         <p>or, where orthocert is installed, <code>orthocert check {file}</code>. {codes} It prints the claim in words: \
         compare it with the one above. The theorems and the format are in <code>proofs/README.md</code> and \
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

    fn checker() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs/checker")
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
        let mut found = vec!["Cargo.toml".to_owned()];
        files(&checker().join("src"), "src", &mut found);
        found.sort();
        let known: Vec<&str> = SOURCES.iter().map(|(path, _)| *path).collect();
        assert_eq!(known, found);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_command_shown_gives_the_digest_shown() {
        let run = Command::new("sh").args(["-c", CHECKER_COMMAND]).current_dir(checker()).output();
        let answer = String::from_utf8(run.unwrap().stdout).unwrap();
        assert_eq!(answer.split_whitespace().next(), Some(checker_sha256().as_str()));
    }
}
