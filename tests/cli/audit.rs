//! `check` of a folder, and `attest`.

use crate::support::Folder;
use serde_json::Value;
use std::fs;

const PROVED: &str = "tripteron.toml";
const FALSE: &str = "orthoglide-310.toml";

/// Two designs in `designs` and their certificates in `proofs`.
fn proved() -> Folder {
    let folder = Folder::with(&[PROVED, FALSE]);
    fs::create_dir_all(folder.path("designs/sub")).unwrap();
    fs::rename(folder.path(PROVED), folder.path("designs/sub/a.toml")).unwrap();
    fs::rename(folder.path(FALSE), folder.path("designs/b.toml")).unwrap();
    folder.run(&["verify", "designs", "--out", "proofs"]).exits(1);
    folder
}

#[test]
fn a_folder_is_checked_against_its_designs() {
    let folder = proved();
    let run = folder.run(&["check", "proofs", "--designs", "designs"]).exits(1);
    let run = run.says(&["ACCEPTED: refuted proofs/b.cert.json"]);
    run.says(&["ACCEPTED: certified proofs/sub/a.cert.json", "1 certified, 1 refuted"]);
    let quiet = folder.run(&["check", "-q", "proofs", "--designs", "designs"]).exits(1).stdout;
    assert_eq!(quiet.lines().count(), 1, "{quiet}");
    folder.run(&["verify", "designs"]).exits(1);
    folder.run(&["check", "designs", "--jobs", "1"]).exits(1);
    fs::remove_file(folder.path("designs/b.toml")).unwrap();
    fs::remove_file(folder.path("designs/b.cert.json")).unwrap();
    folder.run(&["check", "designs"]).exits(0);
}

#[test]
fn orphans_and_forgeries_are_rejected() {
    let arguments = ["check", "proofs", "--designs", "designs"];
    let folder = proved();
    fs::remove_file(folder.path("designs/b.toml")).unwrap();
    folder.run(&arguments).exits(5).says(&["proofs/b.cert.json: a certificate without a design"]);
    let folder = proved();
    fs::remove_file(folder.path("proofs/sub/a.cert.json")).unwrap();
    folder.run(&arguments).exits(5).says(&["designs/sub/a.toml: a design without a certificate"]);
    let folder = proved();
    fs::copy(folder.path("proofs/b.cert.json"), folder.path("proofs/sub/a.cert.json")).unwrap();
    folder.run(&arguments).exits(5).says(&["REJECTED proofs/sub/a.cert.json: it is about another"]);
    folder.write("designs/b.toml", "title = 3");
    let run = folder.run(&[&arguments[..], &["--format", "json"]].concat()).exits(2);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["accepted"], false);
    assert_eq!(value["pairs"][0]["verdict"], "bad_input");
    assert_eq!(value["pairs"][1]["verdict"], "rejected");
}

#[test]
fn misplaced_options_and_empty_folders_are_refused() {
    let folder = proved();
    fs::create_dir(folder.path("empty")).unwrap();
    for (arguments, part) in [
        (vec!["check", "proofs", "--design", "designs/b.toml"], "--designs FOLDER"),
        (vec!["check", "proofs/b.cert.json", "--designs", "designs"], "is no folder"),
        (vec!["check", "empty"], "without certificates"),
        (vec!["check", "proofs", "--designs", "missing"], "missing"),
    ] {
        folder.run(&arguments).exits(2).complains(&[part]);
    }
}

#[test]
fn an_attestation_names_both_files_by_what_is_in_them() {
    let folder = proved();
    let arguments = ["attest", "proofs/sub/a.cert.json", "--design", "designs/sub/a.toml"];
    let run = folder.run(&arguments).exits(0);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["_type"], "https://in-toto.io/Statement/v1");
    assert_eq!(value["predicateType"], "https://in-toto.io/attestation/test-result/v0.1");
    for (subject, file) in
        [("a.toml", "designs/sub/a.toml"), ("a.cert.json", "proofs/sub/a.cert.json")]
    {
        let subjects = value["subject"].as_array().unwrap();
        let found = subjects.iter().find(|one| one["name"] == subject).unwrap();
        assert_eq!(found["digest"]["sha256"], sha256(&folder.read(file)));
    }
    let predicate = &value["predicate"];
    assert_eq!(predicate["result"], "PASSED");
    assert_eq!(predicate["passedTests"][0], "singularity");
    assert_eq!(predicate["failedTests"], serde_json::json!([]));
    assert_eq!(predicate["configuration"][0]["name"], "orthocert-checker");
    assert_eq!(predicate["configuration"][0]["annotations"]["verdict"], "certified");
    folder.run(&[&arguments[..], &["-o", "x.json"]].concat()).exits(0);
    assert_eq!(folder.read("x.json"), run.stdout.as_bytes());
}

fn sha256(bytes: &[u8]) -> String {
    use sha2::{Digest, Sha256};
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn a_refutation_is_attested_as_failed_and_nothing_is_said_of_the_rest() {
    let folder = proved();
    let run = folder.run(&["attest", "proofs/b.cert.json", "--design", "designs/b.toml"]).exits(1);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["predicate"]["result"], "FAILED");
    assert_eq!(value["predicate"]["failedTests"], serde_json::json!(["transmission"]));
    assert_eq!(value["predicate"]["passedTests"], serde_json::json!([]));
}

#[test]
fn nothing_is_attested_of_another_claim_or_of_a_rejected_certificate() {
    let folder = proved();
    let design = ["--design", "designs/b.toml", "-o", "x.json"];
    let run = folder.run(&[&["attest", "proofs/sub/a.cert.json"][..], &design].concat()).exits(5);
    run.complains(&["REJECTED", "another claim"]);
    folder.write("bad.json", "{}");
    folder.run(&[&["attest", "bad.json"][..], &design].concat()).exits(5).complains(&["REJECTED"]);
    assert!(!folder.path("x.json").exists());
    let arguments = ["attest", "proofs/b.cert.json", "--design", "designs/b.toml", "-o"];
    for output in ["./proofs/b.cert.json", "designs/sub/../b.toml"] {
        let run = folder.run(&[&arguments[..], &[output]].concat()).exits(2);
        run.complains(&["is a file that is read"]);
    }
}
