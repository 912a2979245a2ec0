//! SARIF 2.1.0: one result a requirement, at the line of the design that demands it.
//!
//! `kind` is `pass` where the accepted certificate proves the requirement, `fail` where it has a
//! point at which the requirement fails, and `open` where nothing is proved of it. A file that is
//! no design is a failure of the rule `bad-input`. Work that did not end is a notification of the
//! invocation, which then was not successful.

use super::{Batch, Ending, Entry};
use crate::report::requirement::{Requirement, Rule, Standing, BAD_INPUT, RULES};
use serde_json::{json, Value};
use std::fmt::Write;

/// The published schema.
const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";
/// Where the rules are explained.
const HELP: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "#proofs-in-ci");

/// The log. `locate` gives the path of a design from the root of its repository.
pub fn sarif(batch: &Batch, locate: impl Fn(&str) -> String) -> Value {
    let uri = |entry: &Entry| uri(&locate(&entry.design));
    let results = batch.designs.iter().flat_map(|entry| results(entry, &uri(entry)));
    let results: Vec<Value> = results.collect();
    let troubled = batch
        .designs
        .iter()
        .filter(|entry| matches!(entry.verdict, Ending::NotFinished | Ending::NotRun));
    let notifications: Vec<Value> = troubled
        .map(|entry| {
            json!({
                "level": "error",
                "message": { "text": message(&entry.remark(), entry.verdict.word()) },
                "locations": [location(&uri(entry), None)],
            })
        })
        .collect();
    let rule = |rule: &Rule| json!({ "id": rule.id, "shortDescription": { "text": rule.says }, "helpUri": HELP });
    let rules: Vec<Value> = RULES.iter().map(rule).collect();
    json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": env!("CARGO_PKG_NAME"),
                "version": env!("CARGO_PKG_VERSION"),
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "informationUri": env!("CARGO_PKG_REPOSITORY"),
                "rules": rules,
            } },
            "invocations": [{
                "executionSuccessful": notifications.is_empty() && !batch.interrupted,
                "exitCode": batch.exit_code,
                "toolExecutionNotifications": notifications,
            }],
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    })
}

fn results(entry: &Entry, uri: &str) -> Vec<Value> {
    if entry.verdict == Ending::BadInput {
        return vec![result(
            BAD_INPUT,
            ("fail", "error"),
            &message(&entry.remark(), "not a design"),
            location(uri, entry.line),
        )];
    }
    let one = |requirement: &Requirement| {
        let demands = &requirement.demands;
        let (standing, text) = match requirement.standing {
            Standing::Holds => {
                (("pass", "none"), format!("Proved at every point of the workspace: {demands}."))
            }
            Standing::Fails => (("fail", "error"), format!("Refuted: {}.", entry.remark())),
            Standing::Open => (("open", "none"), format!("Not decided: {demands}.")),
        };
        result(requirement.rule, standing, &text, location(uri, requirement.line))
    };
    entry.requirements.iter().map(one).collect()
}

fn result(rule: &str, (kind, level): (&str, &str), text: &str, location: Value) -> Value {
    json!({
        "ruleId": rule,
        "ruleIndex": RULES.iter().position(|known| known.id == rule),
        "kind": kind,
        "level": level,
        "message": { "text": text },
        "locations": [location],
    })
}

fn location(uri: &str, line: Option<usize>) -> Value {
    json!({ "physicalLocation": {
        "artifactLocation": { "uri": uri },
        "region": { "startLine": line.unwrap_or(1) },
    } })
}

/// A message is never empty.
fn message(text: &str, otherwise: &str) -> String {
    if text.trim().is_empty() { otherwise } else { text }.to_owned()
}

/// A path as a reference (RFC 3986): relative, or of the scheme `file` if it is absolute.
fn uri(path: &str) -> String {
    let path = path.strip_prefix("./").unwrap_or(path);
    let mut out = if path.starts_with('/') { "file://".to_owned() } else { String::new() };
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                out.push(char::from(byte));
            }
            _ => {
                let _ = write!(out, "%{byte:02X}");
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::uri;

    #[test]
    fn paths_are_references() {
        for (path, reference) in [
            ("a/b.toml", "a/b.toml"),
            ("./a.toml", "a.toml"),
            ("/a b.toml", "file:///a%20b.toml"),
            ("ä#?%:.toml", "%C3%A4%23%3F%25%3A.toml"),
        ] {
            assert_eq!(uri(path), reference);
        }
    }
}
