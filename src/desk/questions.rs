//! What the page asks, and what is answered.

use crate::limit::limit;
use crate::machines::MACHINES;
use orthocert::design::{Design, ReadError, Variable, MAX_FILE};
use orthocert::exact::decimal::{approximate, exact, significant};
use orthocert::exact::Exact;
use orthocert::questions::decide::{as_written, by_proof_of};
use orthocert::questions::limit::Place;
use orthocert::questions::summary::signed;
use orthocert::report::page::{machine, File, Page};
use orthocert::report::Report;
use orthocert::search::accepted::{check, Accepted};
use orthocert::search::solver::{self, Verification};
use orthocert::search::{Budget, Control};
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_checker::read;
use orthocert_checker::statement::statement;
use orthocert_kernel::claim::MachineClaim;
use serde::Deserialize;
use serde_json::{json, Value};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Boxes after which a search gives up, as on the command line.
const MOST_BOXES: usize = 500_000;
/// Longest design of which the numbers are listed, in bytes.
const LISTED: usize = 1 << 16;
/// Significant digits of a number that is no short decimal.
const DIGITS: u32 = 9;

/// A question.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "lowercase")]
enum Question {
    /// The machines to choose from.
    Machines,
    /// The numbers of a design that can be moved.
    Numbers { text: String, file: String },
    /// A design's verdict; certificates of designs before it, by the proofs of which it may hold too.
    Verdict { text: String, file: String, before: Vec<String> },
    /// The sections of a certificate's report with these anchors.
    Sections { certificate: String, file: String, title: String, anchors: Vec<String> },
    /// A certificate's report.
    Report { certificate: String, file: String, title: String },
    /// How far one number of a design goes.
    Limit { text: String, file: String, key: String },
}

/// The answer to a question: an object, with a sentence `refused` where there is no other.
pub fn answered(question: &[u8]) -> String {
    let answer = match serde_json::from_slice(question) {
        Ok(Question::Machines) => Ok(machines()),
        Ok(Question::Numbers { text, file }) => Ok(numbers(&text, &file)),
        Ok(Question::Verdict { text, file, before }) => verdict(&text, &file, &before),
        Ok(Question::Sections { certificate, file, title, anchors }) => {
            page(&certificate, &file, &title, |page| {
                let section = |anchor: &String| page.section(anchor).unwrap_or_default();
                json!({ "sections": anchors.iter().map(section).collect::<Vec<_>>() })
            })
        }
        Ok(Question::Report { certificate, file, title }) => page(
            &certificate,
            &file,
            &title,
            |page| json!({ "html": page.signing(|claim| signed(claim, None)).html() }),
        ),
        Ok(Question::Limit { text, file, key }) => limit(&text, &file, &key),
        Err(error) => Err(error.to_string()),
    };
    answer.unwrap_or_else(refused).to_string()
}

fn refused(reason: String) -> Value {
    json!({ "refused": reason })
}

fn machines() -> Value {
    let machine = |(name, file, text): &(&str, &str, &str)| json!({ "name": name, "file": file, "text": text });
    json!({ "machines": MACHINES.iter().map(machine).collect::<Vec<_>>() })
}

/// The design of a text, or the sentence with which the command line refuses it.
pub fn design(text: &str, file: &str) -> Result<Design, String> {
    let path = Path::new(file);
    if text.len() as u64 > MAX_FILE {
        return Err(ReadError::TooLarge(path.to_owned()).to_string());
    }
    Design::of(text.as_bytes(), path).map_err(|error| error.to_string())
}

/// Runs a search that nothing cancels but the end of the worker that it is in.
pub fn run<T>(search: impl FnOnce(&mut Control<'_>) -> T) -> T {
    let cancel = AtomicBool::new(false);
    search(&mut Control { cancel: &cancel, progress: &mut |_| {} })
}

fn verdict(text: &str, file: &str, before: &[String]) -> Result<Value, String> {
    let design = design(text, file)?;
    let notes = design.notes();
    let Design { title, claim, .. } = design;
    let mut found = decided(&claim, before)?;
    let written = found.decided().map(|(certificate, _)| as_written(certificate));
    let mut answer = match (written, found.decided()) {
        (Some(Ok(text)), Some((certificate, accepted))) => decision(certificate, accepted, text),
        (Some(Err(objection)), _) => {
            found.object(objection);
            remains(&claim, &found)
        }
        _ => remains(&claim, &found),
    };
    let proof = found.decided().map(|(certificate, _)| &certificate.proof);
    answer["drawing"] = json!(machine(&claim, proof).map(|picture| picture.inline()));
    answer["title"] = json!(title);
    answer["notes"] = json!(notes);
    Ok(answer)
}

/// Decides a claim, by a proof that is there if that will do.
fn decided(claim: &MachineClaim, before: &[String]) -> Result<Verification, String> {
    let known = before.iter().filter_map(|text| read(text.as_bytes()).ok());
    if let Some(found) = known.filter_map(|other| by_proof_of(claim, &other)).next() {
        return Ok(found);
    }
    let budget = Budget { max_boxes: MOST_BOXES, deadline: None };
    run(|control| solver::verify(claim, budget, control)).map_err(|error| error.to_string())
}

/// What the checker has accepted, and what that says.
fn decision(certificate: &Certificate, accepted: &Accepted, text: String) -> Value {
    let size = match &certificate.proof {
        Proof::Tree(tree) => json!({
            "leaves": accepted.size.leaves,
            "boxes": accepted.size.nodes,
            "bits": tree.precision,
        }),
        _ => Value::Null,
    };
    json!({
        "verdict": accepted.verdict,
        "statement": statement(&certificate.claim, accepted.verdict),
        "size": size,
        "counterexample": Place::of(certificate),
        "certificate": text,
    })
}

/// What is left open.
fn remains(claim: &MachineClaim, found: &Verification) -> Value {
    let remains = Report::new(claim, found, Duration::ZERO).and_then(|report| report.undecided);
    json!({ "verdict": "undecided", "remains": remains })
}

/// Where the numbers of a design stand, in units of UTF-16, and what they are; none of a text that is
/// not TOML, or a very long one.
fn numbers(text: &str, file: &str) -> Value {
    let all = match text.len() {
        0..=LISTED => Variable::all(text, file).unwrap_or_default(),
        _ => Vec::new(),
    };
    let units = |end: usize| text.get(..end).map_or(0, |part| part.encode_utf16().count());
    let number = |(key, variable): &(String, Variable<'_>)| {
        let places = variable.places().iter().map(|at| [units(at.start), units(at.end)]);
        let own = exact(variable.own());
        let is_decimal = own.bytes().all(|b| b.is_ascii_digit() || b == b'.' || b == b'-');
        let near = approximate(variable.own()).map(|x| significant(x, DIGITS));
        json!({
            "key": key,
            "places": places.collect::<Vec<_>>(),
            "value": if is_decimal { Some(own) } else { near },
            "tolerance": variable.tolerance(),
            "size": approximate(&Exact::Rational(variable.size().clone())),
        })
    };
    json!({ "numbers": all.iter().map(number).collect::<Vec<_>>() })
}

/// What is on the page of a certificate, once the checker has accepted it.
fn page(
    certificate: &str,
    file: &str,
    title: &str,
    then: impl FnOnce(Page<'_>) -> Value,
) -> Result<Value, String> {
    let bytes = certificate.as_bytes();
    let certificate = read(bytes).map_err(|reason| reason.to_string())?;
    let accepted = check(&certificate).map_err(|reason| reason.to_string())?;
    let file = File { name: file, bytes };
    Ok(then(Page::new(&certificate, &accepted, file, Some(title), None)))
}
