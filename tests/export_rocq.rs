//! What is exported to Rocq, and what is refused. That the files prove what they state is for Rocq to
//! say, and that no more is refused than the verified checker does not cover: `proofs/rocq/instances`,
//! `proofs/rocq/program/check.js`.

use orthocert::report::export::rocq::{rocq, ExportError};
use orthocert_checker::read;
use std::fs::read_to_string;

fn exported(text: &str) -> Result<String, ExportError> {
    rocq(&read(text.as_bytes()).expect("a certificate"))
}

/// The certificate with something else in it.
fn with(text: &str, from: &str, to: &str) -> String {
    let other = text.replacen(from, to, 1);
    assert_ne!(text, other, "{from}");
    other
}

#[test]
fn every_committed_certificate_is_exported() {
    let mut count = 0;
    for file in std::fs::read_dir("proofs/certificates").expect("a folder") {
        let text = read_to_string(file.expect("a file").path()).expect("a certificate");
        exported(&text).expect("exported");
        count += 1;
    }
    assert!(count >= 40);
}

/// With `ORTHOCERT_WRITE` set, they are written first.
#[test]
fn instances_of_the_formal_development_are_what_is_exported() {
    let script = read_to_string("proofs/rocq/instances/regenerate.sh").expect("committed");
    let mut count = 0;
    let beside = |name: &str| format!("proofs/rocq/instances/{name}.cert.json");
    let names = script.split_once("for name in ").and_then(|(_, rest)| rest.split_once(';'));
    let own = names.expect("names").0.split(' ').map(|name| (name, beside(name)));
    let (_, table) = script.split_once("<<END\n").expect("a table");
    let others = table.lines().filter_map(|line| line.split_once(' '));
    let others = others.map(|(name, from)| (name, format!("proofs/certificates/{from}.cert.json")));
    for (name, certificate) in own.chain(others) {
        let text = exported(&read_to_string(certificate).expect("committed")).expect("exported");
        let file = format!("proofs/rocq/instances/{name}.v");
        if std::env::var_os("ORTHOCERT_WRITE").is_some() {
            std::fs::write(&file, &text).expect("written");
        }
        assert_eq!(text, read_to_string(&file).expect("committed"), "{name}");
        count += 1;
    }
    assert_eq!(count, 16);
}

const FOUR: &str = include_str!("../proofs/rocq/instances/FourSliders.cert.json");
const BOX: &str = r#""min":["-60","-60","0"]"#;

#[test]
fn numbers_stand_as_in_the_certificate() {
    for (number, written) in [
        ("-0.5", "(-0.5)"),
        ("1/3", "(1/3)"),
        ("-2*sqrt(3)^2/5", "(-2*sqrt(3)^2/5)"),
        // `--` and `*-` might be read as one symbol.
        ("1--2*-3", "(1- -2* -3)"),
    ] {
        let text = exported(&with(FOUR, BOX, &format!(r#""min":["{number}","-60","0"]"#)));
        assert!(text.expect("exported").contains(&format!("Box_ (Triple {written} (-60) 0)")));
    }
    let formulas = read_to_string("proofs/certificates/five-bar-formulas.cert.json");
    let text = exported(&formulas.expect("committed")).expect("exported");
    assert!(text.contains("(\"p\", ((1+(Name \"r\"^2-Name \"l\"^2)/Name \"n\")/2))"), "{text}");
}

/// What ends a string would be read as Rocq's.
#[test]
fn no_string_ends_before_its_end() {
    let text = exported(&with(FOUR, r#""tool":"test""#, r#""tool":"t\" x""#)).expect("exported");
    assert!(text.contains(" the_proof \"t\"\" x\" \"0\"."), "{text}");
}

#[test]
fn what_the_verified_checker_does_not_cover_is_refused_in_its_words() {
    let step = r#"[2,"test"]"#;
    let range = r#""quantity":"joint_range","leg":1,"end":"min","bound":"200""#;
    for (from, to, what) in [
        (
            range,
            r#""quantity":"base_joint","end":"max","bound":"9""#,
            "the quantity \"base_joint\"",
        ),
        (step, r#"[2,{"turned":["test",1,1]}]"#, "the evidence \"turned\""),
        (step, r#"[2,{"fan":[[[1,0,0],0,0,"negative"]]}]"#, "this evidence \"fan\""),
        (
            step,
            r#"[2,{"fan":[[[1,0,0],0,0,"divided"],[[0,1,0],0,0,"test"]]}]"#,
            "evidence \"fan\" about \"divided\" and other rows",
        ),
        (step, r#"[2,{"control":"divided"}]"#, "this evidence at control points"),
        (r#","split":1}"#, r#","split":1,"fails":"reach"}"#, "a leaf that fails"),
    ] {
        let refused = exported(&with(FOUR, from, to)).expect_err("refused");
        assert_eq!(refused.to_string(), format!("{what} is not covered by the verified checker"));
    }
    // Written out, the last definition of fifty has the first one 2^50 times.
    let definitions: Vec<String> =
        (1..51).map(|i| format!(r#"["d{i}","d{}*d{}"]"#, i - 1, i - 1)).collect();
    let formulas = read_to_string("proofs/certificates/five-bar-formulas.cert.json");
    let many = format!(r#""definitions":[["d0","x"],{},"#, definitions.join(","));
    let refused = exported(&with(&formulas.expect("committed"), r#""definitions":["#, &many));
    assert!(refused
        .expect_err("refused")
        .to_string()
        .starts_with("a mechanism of more than 32768"));
    let refuted = exported(&with(FOUR, r#""verdict":"certified""#, r#""verdict":"refuted""#));
    assert_eq!(refuted, Err(ExportError::Verdict));
}
