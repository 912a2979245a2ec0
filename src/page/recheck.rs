//! How a reader repeats the check, and the digests of what is repeated.

use crate::decimal::grouped;
use crate::digest::sha256;
use crate::escape::{shell, xml};
use std::fmt::Write;

/// The command, in the folder `proofs`, whose answer is [`checker_sha256`].
pub const CHECKER_COMMAND: &str =
    "find checker/Cargo.toml checker/src kernel/Cargo.toml kernel/src -type f | LC_ALL=C sort | \
     xargs sha256sum | sha256sum";

macro_rules! checker_sources {
    ($($path:literal),* $(,)?) => {
        [$(($path, include_bytes!(concat!("../../proofs/", $path)))),*]
    };
}

/// The sources of the checker and its kernel with which this program was built, in the order of their
/// paths.
const SOURCES: &[(&str, &[u8])] = &checker_sources![
    "checker/Cargo.toml",
    "checker/src/bin/orthocert-check.rs",
    "checker/src/check.rs",
    "checker/src/file.rs",
    "checker/src/lib.rs",
    "checker/src/shown.rs",
    "checker/src/statement.rs",
    "kernel/Cargo.toml",
    "kernel/src/arithmetic.rs",
    "kernel/src/atlas.rs",
    "kernel/src/cell.rs",
    "kernel/src/certificate.rs",
    "kernel/src/check/corner.rs",
    "kernel/src/check/inside.rs",
    "kernel/src/check/mod.rs",
    "kernel/src/check/own.rs",
    "kernel/src/claim.rs",
    "kernel/src/compile.rs",
    "kernel/src/control.rs",
    "kernel/src/cube.rs",
    "kernel/src/definite.rs",
    "kernel/src/fixed.rs",
    "kernel/src/formula.rs",
    "kernel/src/input.rs",
    "kernel/src/lib.rs",
    "kernel/src/machine/mod.rs",
    "kernel/src/machine/motion.rs",
    "kernel/src/no_cube.rs",
    "kernel/src/number.rs",
    "kernel/src/orientation.rs",
    "kernel/src/paving/cell.rs",
    "kernel/src/paving/code.rs",
    "kernel/src/paving/judge.rs",
    "kernel/src/paving/mod.rs",
    "kernel/src/paving/reader.rs",
    "kernel/src/paving/symmetry.rs",
    "kernel/src/postulate.rs",
    "kernel/src/problem.rs",
    "kernel/src/quantity/accuracy.rs",
    "kernel/src/quantity/base_joint.rs",
    "kernel/src/quantity/clearance.rs",
    "kernel/src/quantity/conditioning.rs",
    "kernel/src/quantity/constraint_margin.rs",
    "kernel/src/quantity/joint_acceleration.rs",
    "kernel/src/quantity/joint_force.rs",
    "kernel/src/quantity/joint_range.rs",
    "kernel/src/quantity/joint_speed.rs",
    "kernel/src/quantity/leg_angle.rs",
    "kernel/src/quantity/mod.rs",
    "kernel/src/quantity/one_to_one.rs",
    "kernel/src/quantity/parallel_margin.rs",
    "kernel/src/quantity/platform_joint.rs",
    "kernel/src/quantity/serial_margin.rs",
    "kernel/src/quantity/stiffness.rs",
    "kernel/src/quantity/transmission.rs",
    "kernel/src/slope.rs",
    "kernel/src/statement.rs",
    "kernel/src/test.rs",
    "kernel/src/test/accuracy.rs",
    "kernel/src/test/apart.rs",
    "kernel/src/test/curvature.rs",
    "kernel/src/test/solve.rs",
    "kernel/src/trig.rs",
    "kernel/src/vary.rs",
    "kernel/src/witness.rs",
    "kernel/src/witness/far.rs",
    "kernel/src/witness/same.rs",
    "kernel/src/witness/violated.rs",
    "kernel/src/work.rs",
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
            found.push(format!("{name}/Cargo.toml"));
            let under = format!("{name}/src");
            files(&proofs().join(&under), &under, &mut found);
        }
        found.sort();
        let known: Vec<&str> = SOURCES.iter().map(|(path, _)| *path).collect();
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
