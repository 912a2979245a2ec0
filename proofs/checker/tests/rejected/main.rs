//! Broken certificates, one file a defect, in `tests/rejected` of the repository: each is rejected
//! for its own defect, by the library and by the binary.

mod table;

use orthocert_checker::{check, read, Rejected};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use table::{Kind, TABLE};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/rejected")
}

fn path(name: &str) -> PathBuf {
    folder().join(format!("{name}.json"))
}

fn rejection(name: &str) -> Rejected {
    let bytes = fs::read(path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    match read(&bytes).and_then(|certificate| check(&certificate)) {
        Ok(accepted) => panic!("{name}: {accepted:?}"),
        Err(reason) => reason,
    }
}

fn kind(reason: &Rejected) -> Kind {
    match reason {
        Rejected::Syntax(_) => Kind::Syntax,
        Rejected::Format(_) => Kind::Format,
        Rejected::Claim(_) => Kind::Claim,
        Rejected::VerdictMismatch | Rejected::OneCubeOnly | Rejected::Parts => Kind::Proof,
        Rejected::Step { .. } => Kind::Step,
        Rejected::Open { .. } => Kind::Open,
        Rejected::Witness(_) => Kind::Witness,
        _ => Kind::Tree,
    }
}

#[test]
fn every_file_is_rejected_for_its_defect() {
    for (name, expected, fragment) in TABLE {
        let reason = rejection(name);
        let words = reason.to_string();
        assert_eq!(kind(&reason), expected, "{name}: {words}");
        assert!(words.contains(fragment), "{name}: {words}");
    }
}

#[test]
fn every_file_has_its_row() {
    let files: BTreeSet<_> =
        fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let rows: BTreeSet<_> = TABLE.iter().map(|(name, ..)| path(name)).collect();
    assert_eq!(files, rows);
    assert_eq!(TABLE.len(), rows.len(), "a file has two rows");
}

#[test]
fn the_binary_exits_with_5() {
    for (name, ..) in TABLE {
        let output =
            Command::new(env!("CARGO_BIN_EXE_orthocert-check")).arg(path(name)).output().unwrap();
        assert_eq!(output.status.code(), Some(5), "{name}");
        assert!(output.stdout.is_empty(), "{name}");
        assert_eq!(
            String::from_utf8(output.stderr).unwrap().trim_end(),
            format!("REJECTED: {}", rejection(name)),
            "{name}"
        );
    }
}
