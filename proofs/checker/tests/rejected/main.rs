//! Broken certificates, those of `tests/rejected`: each is rejected for its own defect, by the
//! library and by the binary.

mod broken;

use broken::{all, Broken};
use orthocert_checker::{check, read, Rejected};
use orthocert_kernel::check::Rejected as of_kernel;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

fn rejection(broken: &Broken) -> Rejected {
    match read(&broken.bytes).and_then(|certificate| check(&certificate)) {
        Ok(accepted) => panic!("{}: {accepted:?}", broken.name),
        Err(reason) => reason,
    }
}

/// Not a text of the format; another format or version; a claim that is not well formed; a kind of
/// proof that does not go with it; a step that does not discharge its obligation; a leaf that leaves
/// one open; a witness that does not refute; a limit or the shape of a tree.
fn kind(reason: &Rejected) -> &'static str {
    match reason {
        Rejected::Syntax(_) => "Syntax",
        Rejected::Format(_) => "Format",
        Rejected::Claim(_) | Rejected::Kernel(of_kernel::Claim(_)) => "Claim",
        Rejected::VerdictMismatch | Rejected::Kernel(of_kernel::Verdict) => "Proof",
        Rejected::Step { .. } | Rejected::Kernel(of_kernel::Step { .. }) => "Step",
        Rejected::Open { .. } | Rejected::Kernel(of_kernel::Open { .. }) => "Open",
        Rejected::Witness(_) => "Witness",
        _ => "Tree",
    }
}

#[test]
fn every_one_is_rejected_for_its_defect() {
    let all = all();
    for broken in &all {
        let Broken { name, kind: expected, words: fragment, .. } = broken;
        let reason = rejection(broken);
        let words = reason.to_string();
        assert_eq!(kind(&reason), *expected, "{name}: {words}");
        assert!(words.contains(fragment), "{name}: {words}");
    }
    let names: BTreeSet<_> = all.iter().map(|broken| broken.name).collect();
    assert_eq!(names.len(), all.len(), "two have the same name");
}

/// The files stay in the target folder: fuzzing starts from them.
#[test]
fn the_binary_exits_with_5() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rejected");
    std::fs::create_dir_all(&folder).unwrap();
    for broken in all() {
        let path = folder.join(broken.name).with_extension("json");
        std::fs::write(&path, &broken.bytes).unwrap();
        let output =
            Command::new(env!("CARGO_BIN_EXE_orthocert-check")).arg(path).output().unwrap();
        assert_eq!(output.status.code(), Some(5), "{}", broken.name);
        assert!(output.stdout.is_empty(), "{}", broken.name);
        assert_eq!(
            String::from_utf8(output.stderr).unwrap().trim_end(),
            format!("REJECTED: {}", rejection(&broken)),
            "{}",
            broken.name
        );
    }
}
