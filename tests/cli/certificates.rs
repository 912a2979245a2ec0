//! `check` and `show`: accepted, refused, about another design.

use crate::support::Folder;

/// A folder with a certified and a refuted design, and their certificates.
fn verified() -> Folder {
    let folder = Folder::with(&["orthoglide-312.toml", "orthoglide-310.toml"]);
    folder.run(&["verify", "orthoglide-312.toml", "-o", "good.json"]).exits(0);
    folder.run(&["verify", "orthoglide-310.toml", "-o", "refuted.json"]).exits(1);
    folder
}

#[test]
fn check_repeats_the_verdict_and_states_the_theorem() {
    let folder = verified();
    let run = folder.run(&["check", "good.json"]).exits(0);
    assert_eq!(run.stderr, "");
    run.says(&["ACCEPTED: certified", "It is proved:", "length 312", "psi_i >= 0.5", "psi_i <= 2"]);
    let run = folder.run(&["check", "refuted.json"]).exits(1);
    run.says(&["ACCEPTED: refuted", "FALSE", "length 310"]);
    let quiet = |file| folder.run(&["check", "-q", file]);
    assert_eq!(quiet("good.json").exits(0).stdout, "ACCEPTED: certified\n");
    assert_eq!(quiet("refuted.json").exits(1).stdout, "ACCEPTED: refuted\n");
    folder.run(&["check", "-q", "good.json", "--formulas"]).exits(2);
}

#[test]
fn check_demands_the_design_that_it_is_given() {
    let folder = verified();
    folder.run(&["check", "good.json", "--design", "orthoglide-312.toml"]).exits(0);
    folder.run(&["check", "refuted.json", "--design", "orthoglide-310.toml"]).exits(1);
    let run = folder.run(&["check", "good.json", "--design", "orthoglide-310.toml"]).exits(5);
    run.complains(&["another claim", "mechanism.legs.0.length is 312 in the certificate and 310"]);
    folder.run(&["verify"]).exits(0);
    let prototype = "orthoglide-prototype.cert.json";
    let run = folder.run(&["check", prototype, "--design", "orthoglide-310.toml"]).exits(5);
    run.complains(&["mechanism", "orthoglide", "translational"]);
}

#[test]
fn what_proves_nothing_is_rejected() {
    let folder = verified();
    let good = String::from_utf8(folder.read("good.json")).unwrap();
    let half = &good[..good.len() / 2];
    for (name, content) in [
        ("empty", String::new()),
        ("not-json", "certified".to_owned()),
        ("truncated", half.to_owned()),
        ("other-version", good.replace("orthocert/2", "orthocert/3")),
        ("other-claim", good.replace("\"length\":\"312\"", "\"length\":\"310\"")),
        ("unknown-key", good.replace("\"verdict\"", "\"extra\":1,\"verdict\"")),
        ("other-verdict", good.replace("\"certified\"", "\"refuted\"")),
        ("deep", "[".repeat(100_000)),
    ] {
        assert_ne!(content, good, "{name}");
        folder.write("bad.json", content);
        let run = folder.run(&["check", "bad.json"]).exits(5);
        run.complains(&["bad.json: REJECTED: "]);
    }
    folder.write("bad.json", b"\xff\xfe{}");
    folder.run(&["check", "bad.json"]).exits(5).complains(&["bad.json: REJECTED: "]);
}

#[test]
fn what_cannot_be_read_is_bad_input() {
    let folder = verified();
    for command in ["check", "show"] {
        folder
            .run(&[command, "missing.json"])
            .exits(2)
            .complains(&["missing.json", "cannot be read"]);
        folder.run(&[command]).exits(2);
    }
    folder.run(&["show", "."]).exits(2).complains(&["it is a folder"]);
    folder.run(&["check", "good.json", "--design", "missing.toml"]).exits(2);
}

#[test]
fn show_tells_the_claim_and_the_shape_but_proves_nothing() {
    let folder = verified();
    let run = folder.run(&["show", "good.json"]).exits(0);
    let run =
        run.says(&["NOT CHECKED", "certified", "length 312", "leaves", "rules used", "bytes"]);
    assert!(!run.stdout.contains("It is proved"));
    let run = folder.run(&["show", "refuted.json"]).exits(0);
    run.says(&["NOT CHECKED", "refuted", "a counterexample at P = (126.8, 126.8, 126.8)"]);
    folder.write("bad.json", "{}");
    folder.run(&["show", "bad.json"]).exits(5).complains(&["REJECTED"]);
}

#[test]
fn show_does_not_notice_a_wrong_proof_and_check_does() {
    let folder = verified();
    let good = String::from_utf8(folder.read("good.json")).unwrap();
    folder.write("wrong.json", good.replace("\"length\":\"312\"", "\"length\":\"309\""));
    folder.run(&["show", "wrong.json"]).exits(0).says(&["length 309"]);
    folder.run(&["check", "wrong.json"]).exits(5).complains(&["not certainly met on the cell"]);
}
