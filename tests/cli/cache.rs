//! Certificates that are there are re-checked instead of searched for again.

use crate::support::Folder;
use serde_json::Value;
use std::fs;

const DESIGN: &str = "orthoglide-312.toml";
const CERTIFICATE: &str = "orthoglide-312.cert.json";

fn answer(folder: &Folder, arguments: &[&str], code: i32) -> Value {
    let arguments = [&["verify", DESIGN, "--format", "json"][..], arguments].concat();
    serde_json::from_str(&folder.run(&arguments).exits(code).stdout).unwrap()
}

fn edit(folder: &Folder, from: &str, to: &str) {
    let text = String::from_utf8(folder.read(DESIGN)).unwrap();
    assert!(text.contains(from), "{from}");
    folder.write(DESIGN, text.replace(from, to));
}

#[test]
fn the_second_run_re_checks_and_has_the_same_facts() {
    let folder = Folder::with(&[DESIGN]);
    let mut first = answer(&folder, &[], 0);
    let bytes = folder.read(CERTIFICATE);
    let mut second = answer(&folder, &[], 0);
    assert_eq!((&first["cached"], &second["cached"]), (&false.into(), &true.into()));
    assert_eq!(folder.read(CERTIFICATE), bytes);
    for value in [&mut first, &mut second] {
        for key in ["cached", "seconds", "boxes_tried"] {
            value[key] = Value::Null;
        }
    }
    assert_eq!(first, second);
    let run = folder.run(&["verify", DESIGN]).exits(0);
    run.says(&["re-checked, not searched for", "--reprove proves anew"]);
    assert_eq!(answer(&folder, &["--reprove"], 0)["cached"], false);
}

#[test]
fn a_refutation_is_kept_too() {
    let folder = Folder::with(&[DESIGN]);
    edit(&folder, "leg_length = 312", "leg_length = 310");
    assert_eq!(answer(&folder, &[], 1)["cached"], false);
    let second = answer(&folder, &[], 1);
    assert_eq!(second["cached"], true);
    assert!(second["counterexample"]["value"].is_string());
}

#[test]
fn titles_and_comments_invalidate_nothing_and_numbers_do() {
    let folder = Folder::with(&[DESIGN]);
    answer(&folder, &[], 0);
    edit(&folder, "title = \"", "# Another comment\ntitle = \"Renamed ");
    let renamed = answer(&folder, &[], 0);
    assert_eq!(renamed["cached"], true);
    assert!(renamed["title"].as_str().unwrap().starts_with("Renamed "));
    // The same number in another notation is the same claim.
    edit(&folder, "leg_length = 312", "leg_length = \"624/2\"");
    assert_eq!(answer(&folder, &[], 0)["cached"], true);
    edit(&folder, "\"624/2\"", "312.0001");
    assert_eq!(answer(&folder, &[], 0)["cached"], false);
    edit(&folder, "312.0001", "\"312.0001 +/- 0.0001\"");
    assert_eq!(answer(&folder, &[], 0)["cached"], false);
}

#[test]
fn a_certificate_that_proves_nothing_is_replaced_and_that_is_said() {
    let folder = Folder::with(&[DESIGN]);
    answer(&folder, &[], 0);
    let good = String::from_utf8(folder.read(CERTIFICATE)).unwrap();
    // A false verdict, and a tree without its rules: the claim is still the design's.
    let start = good.find("\"nodes\":[").unwrap();
    let end = good.find("\"provenance\"").unwrap();
    for forged in [
        good.replace("\"verdict\":\"certified\"", "\"verdict\":\"refuted\""),
        format!("{}\"nodes\":[{{}}]}}}},{}", &good[..start], &good[end..]),
    ] {
        assert_ne!(forged, good);
        folder.write(CERTIFICATE, &forged);
        let run = folder.run(&["verify", DESIGN]).exits(0);
        assert!(run.stderr.contains("is not accepted"), "{}", run.stderr);
        assert_eq!(folder.read(CERTIFICATE), good.as_bytes());
    }
    folder.write(CERTIFICATE, "{");
    assert_eq!(answer(&folder, &[], 0)["cached"], false);
}

#[test]
fn an_undecided_run_leaves_nothing_to_be_found() {
    let folder = Folder::with(&[DESIGN]);
    answer(&folder, &["--max-boxes", "1"], 3);
    assert_eq!(folder.names(), [DESIGN]);
    assert_eq!(answer(&folder, &[], 0)["cached"], false);
}

#[test]
fn a_read_only_certificate_is_good_enough_to_be_re_checked() {
    let folder = Folder::with(&[DESIGN]);
    answer(&folder, &[], 0);
    let mut permissions = fs::metadata(folder.path(CERTIFICATE)).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.path(CERTIFICATE), permissions).unwrap();
    assert_eq!(answer(&folder, &[], 0)["cached"], true);
    folder.run(&["verify", DESIGN, "--reprove"]).exits(4);
}
