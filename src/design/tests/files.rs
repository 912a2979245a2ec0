//! Files: those of `tests/designs`, and paths that cannot be read.

use super::*;
use crate::design::{ReadError, MAX_FILE};
use orthocert_kernel::claim as kernel;
use std::path::{Path, PathBuf};

fn designs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs")
}

#[test]
fn every_design_of_the_test_suite_is_read() {
    let mut read = 0;
    for entry in std::fs::read_dir(designs()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(text.starts_with("# Source: "), "{}", path.display());
            let design = Design::read(&path).unwrap_or_else(|error| panic!("{error}"));
            assert!(design.title.is_some(), "{}", path.display());
            read += 1;
        }
    }
    assert!(read >= 11, "{read}");
}

/// Machines of every kind: each is read into a claim of the kernel that is written and read back.
#[test]
fn every_design_of_another_kind_is_read() {
    let mut read = 0;
    for entry in std::fs::read_dir(designs().join("kernel")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("# Source: "), "{}", path.display());
        assert!(text.contains("\n# Verdict: "), "{}", path.display());
        let claim = super::kinds::kernel(&text);
        let written = serde_json::to_string(&claim).unwrap();
        let again: orthocert_kernel::claim::MachineClaim = serde_json::from_str(&written).unwrap();
        assert_eq!(again, claim, "{}", path.display());
        read += 1;
    }
    assert!(read >= 16, "{read}");
}

#[test]
fn relaxed_bounds_are_exact_expressions() {
    let design = Design::read(&designs().join("orthoglide-relaxed-1e-9.toml")).unwrap();
    let bounds: Vec<_> = design.claim.require.iter().map(|own| &own.bound).collect();
    let number =
        |text: &str| orthocert_kernel::number::Expression::try_from(text.to_owned()).unwrap();
    let (min, max) = (number("500000000/1000000001"), number("2.000000002"));
    assert_eq!(bounds, [&kernel::Bound::Min(min), &kernel::Bound::Max(max)]);
}

#[test]
fn the_prototype_is_the_file_of_that_name() {
    let design = Design::read(&designs().join("orthoglide-prototype.toml")).unwrap();
    assert_eq!(design.claim, Design::prototype().claim);
    assert_eq!(design.title, Design::prototype().title);
}

#[test]
fn what_is_no_text_file_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("design.toml");
    let message = |error: ReadError| {
        let message = error.to_string();
        assert!(message.starts_with(&format!("{}", folder.path().display())), "{message}");
        message
    };

    let directory = Design::read(folder.path()).unwrap_err();
    assert!(matches!(directory, ReadError::Directory(_)));
    assert!(message(directory).contains("found a directory"));

    let missing = Design::read(&path).unwrap_err();
    assert!(matches!(missing, ReadError::Unreadable(..)));
    assert!(message(missing).contains("cannot be read"));

    std::fs::write(&path, b"title = \"a\"\n# caf\xe9\n").unwrap();
    let latin = Design::read(&path).unwrap_err();
    assert!(matches!(latin, ReadError::NotUtf8(_, 2)));
    assert!(message(latin).contains("design.toml:2: found bytes that are not UTF-8"));

    let size = usize::try_from(MAX_FILE).unwrap();
    std::fs::write(&path, " ".repeat(size + 1)).unwrap();
    let large = Design::read(&path).unwrap_err();
    assert!(matches!(large, ReadError::TooLarge(_)));
    assert!(message(large).contains("1048576 bytes"));

    std::fs::write(&path, format!("{}#{}", CUBE, " ".repeat(size - CUBE.len() - 1))).unwrap();
    assert!(Design::read(&path).is_ok());

    std::fs::write(&path, "[mechanism]\n").unwrap();
    let incomplete = Design::read(&path).unwrap_err();
    assert!(matches!(incomplete, ReadError::Design(_)));
    assert!(message(incomplete)
        .contains("design.toml:1:12: workspace: found nothing: the key is missing"));
}
