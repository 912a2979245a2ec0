//! In-toto statements: what the exact checker says of a design and its certificate, in the form
//! that signing tools and policies take.
//!
//! The statement is of type `https://in-toto.io/Statement/v1`, its predicate of type
//! `https://in-toto.io/attestation/test-result/v0.1`. Its subjects are the two files by their
//! SHA-256. It is a function of them and of the checker's version alone: there is no time in it.

use crate::design::Design;
use crate::files::digest::sha256;
use crate::report::counterexample;
use crate::report::requirement::{requirements, Known, Standing};
use crate::search::accepted::Accepted;
use orthocert_checker::certificate::{Certificate, Verdict};
use serde::Serialize;
use serde_json::{json, Value};

/// The type of statements.
pub const STATEMENT: &str = "https://in-toto.io/Statement/v1";
/// The type of the predicate.
pub const PREDICATE: &str = "https://in-toto.io/attestation/test-result/v0.1";

/// A design and a certificate of its claim that the checker has accepted.
pub struct Evidence<'a> {
    /// The design.
    pub design: &'a Design,
    /// The name and the bytes that it was read from.
    pub design_file: (&'a str, &'a [u8]),
    /// The certificate.
    pub certificate: &'a Certificate,
    /// The name and the bytes that it was read from.
    pub certificate_file: (&'a str, &'a [u8]),
    /// What the checker says of it.
    pub accepted: &'a Accepted,
}

/// A statement about two files.
#[derive(Clone, Debug, Serialize)]
pub struct Statement {
    /// [`STATEMENT`].
    #[serde(rename = "_type")]
    kind: &'static str,
    subject: Vec<Value>,
    #[serde(rename = "predicateType")]
    predicate_type: &'static str,
    predicate: Predicate,
}

/// The result of a test run; the tests are the rules of [`crate::report::requirement`].
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Predicate {
    /// `PASSED` for a proof, `FAILED` for a counterexample.
    result: &'static str,
    configuration: Vec<Value>,
    passed_tests: Vec<&'static str>,
    warned_tests: Vec<&'static str>,
    failed_tests: Vec<&'static str>,
}

/// The statement that the evidence supports. Of a refuted design only the requirement that fails at
/// the counterexample is listed: nothing is proved of the others.
pub fn statement(evidence: &Evidence<'_>) -> Statement {
    let Evidence { design, design_file, certificate, certificate_file, accepted } = evidence;
    let subject = |(name, bytes): &(&str, &[u8])| json!({ "name": name, "digest": { "sha256": sha256(bytes) } });
    let known = match accepted.verdict {
        Verdict::Certified => Known::Certified,
        Verdict::Refuted => {
            counterexample(certificate).map_or(Known::Nothing, |found| Known::Refuted(found.rule))
        }
    };
    let all = requirements(design, known);
    let of =
        |standing| all.iter().filter(|one| one.standing == standing).map(|one| one.rule).collect();
    let checker = json!({
        "name": "orthocert-checker",
        "uri": concat!("pkg:cargo/orthocert-checker@", env!("CARGO_PKG_VERSION")),
        "annotations": {
            "version": env!("CARGO_PKG_VERSION"),
            "certificateFormat": certificate.format,
            "verdict": accepted.verdict,
        },
    });
    Statement {
        kind: STATEMENT,
        subject: vec![subject(design_file), subject(certificate_file)],
        predicate_type: PREDICATE,
        predicate: Predicate {
            result: match accepted.verdict {
                Verdict::Certified => "PASSED",
                Verdict::Refuted => "FAILED",
            },
            configuration: vec![checker],
            passed_tests: of(Standing::Holds),
            warned_tests: Vec::new(),
            failed_tests: of(Standing::Fails),
        },
    }
}
