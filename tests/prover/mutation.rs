//! Altered certificates: each is rejected, or what it says is still true.

use super::{cube, orthoglide, verified};
use orthocert::design::written;
use orthocert::exact::Exact;
use orthocert::search::accepted::{check, Accepted};
use orthocert::search::solver::sample::{At, Sampler};
use orthocert::search::solver::Answer;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_checker::read;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;
use serde_json::{json, Value};

/// Margins within this of zero are rounding errors of the sampling.
const NOISE: f64 = 1e-9;
/// Larger certificates are not mutated, and of those that are, one mutant in so many is tried.
const MOST_BYTES: usize = 2_100;
const STRIDE: usize = 19;

fn certificate_of(claim: &MachineClaim) -> Value {
    match verified(claim, 10_000).answer {
        Answer::Decided { certificate, .. } => {
            serde_json::from_str(&certificate.to_text().unwrap()).unwrap()
        }
        other => panic!("{other:?}"),
    }
}

fn checked(mutant: &Value) -> Option<(Certificate, Accepted)> {
    // Keys in the order of certificates.
    let typed: kernel::Certificate = serde_json::from_value(mutant.clone()).ok()?;
    let certificate = read(typed.to_text().ok()?.as_bytes()).ok()?;
    let accepted = check(&certificate).ok()?;
    Some((certificate, accepted))
}

/// Paths to every value of a JSON document.
fn paths(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                paths(item, &format!("{at}/{i}"), found);
            }
        }
        Value::Object(fields) => {
            for (key, item) in fields {
                paths(item, &format!("{at}/{key}"), found);
            }
        }
        _ => {}
    }
}

/// What one value may be altered to.
fn alternatives(value: &Value) -> Vec<Value> {
    let mut all = vec![Value::Null, json!([]), json!({}), json!(""), json!(1.5)];
    match value {
        Value::Number(n) => {
            let n = n.as_i64().unwrap();
            all.extend([n + 1, n - 1, -n, 0, 1, 2 * n, 40 * n, i64::MAX].map(|n| json!(n)));
        }
        Value::String(text) => {
            let words = ["x", "min", "max", "Q1", "Q2", "test", "corner", "outside", "+", "-"];
            let words = words.iter().chain(&["certified", "refuted", "orthocert/2", "0", "1"]);
            all.extend(words.map(|word| json!(word)));
            if let Ok(number) = Exact::parse(text, 1000) {
                for change in ["+1", "-1", "+1/1000000", "-1/1000000", "*2", "/2", "*(-1)"] {
                    let altered = Exact::parse(&format!("({number}){change}"), 1000).unwrap();
                    all.push(json!(written(&altered).unwrap().to_string()));
                }
            }
        }
        Value::Array(items) if !items.is_empty() => {
            let without = |i: usize| {
                let mut less = items.clone();
                less.remove(i);
                Value::Array(less)
            };
            all.extend([without(0), without(items.len() - 1)]);
            let mut more = items.clone();
            more.push(items[0].clone());
            all.push(Value::Array(more));
            all.push(Value::Array(items.iter().rev().cloned().collect()));
        }
        Value::Object(fields) => {
            for key in fields.keys() {
                let mut less = fields.clone();
                less.remove(key);
                all.push(Value::Object(less));
            }
            let mut more = fields.clone();
            more.insert("extra".to_owned(), json!(1));
            all.push(Value::Object(more));
        }
        _ => {}
    }
    all.retain(|other| other != value);
    all
}

/// Every value of a certificate replaced by every alternative, one at a time; exchanged nodes.
fn mutants(certificate: &Value) -> Vec<(String, Value)> {
    let (mut all, mut mutants) = (Vec::new(), Vec::new());
    paths(certificate, "", &mut all);
    for path in all {
        let value = certificate.pointer(&path).unwrap();
        for alternative in alternatives(value) {
            let mut mutant = certificate.clone();
            let name = format!("{path} = {alternative}");
            *mutant.pointer_mut(&path).unwrap() = alternative;
            mutants.push((name, mutant));
        }
    }
    if let Some(nodes) = certificate.pointer("/proof/tree/nodes").and_then(Value::as_array) {
        for (i, j) in (0..nodes.len()).flat_map(|j| (0..j).map(move |i| (i, j))) {
            let mut exchanged = nodes.clone();
            exchanged.swap(i, j);
            let mut mutant = certificate.clone();
            *mutant.pointer_mut("/proof/tree/nodes").unwrap() = Value::Array(exchanged);
            mutants.push((format!("nodes {i} and {j} exchanged"), mutant));
        }
    }
    mutants
}

/// The least margin of a claim at one of the places.
fn least_margin<'a>(sampler: &Sampler<'_>, at: impl Iterator<Item = At<'a>>) -> f64 {
    let of = |at: At| {
        let all = sampler.qualities().into_iter().map(|quality| sampler.margin(quality, &at));
        all.fold(f64::INFINITY, f64::min)
    };
    at.map(of).fold(f64::INFINITY, f64::min)
}

/// Whether a claim fails at a point of a grid.
fn seems_false(claim: &MachineClaim) -> bool {
    let problem = Problem::new(claim).unwrap();
    let sampler = Sampler::new(claim, &problem).unwrap();
    least_margin(&sampler, sampler.grid().iter().step_by(4).map(|place| sampler.at(place))) < -NOISE
}

/// Whether a claim fails at the place of a witness, which is in the workspace.
fn fails_at(claim: &MachineClaim, witness: &kernel::Witness) -> bool {
    let problem = Problem::new(claim).unwrap();
    let sampler = Sampler::new(claim, &problem).unwrap();
    let place = sampler.place_of(&witness.point, &witness.machine).unwrap();
    least_margin(&sampler, [sampler.at(&place)].into_iter()) < NOISE
}

/// Checks every mutant; returns how many were rejected and how many accepted.
fn judge(certificate: &Value) -> (usize, usize) {
    judge_some(certificate, 1)
}

/// The same of one in so many.
fn judge_some(certificate: &Value, stride: usize) -> (usize, usize) {
    assert!(checked(certificate).is_some(), "the certificate itself");
    let (mut rejected, mut accepted) = (0, 0);
    for (name, mutant) in mutants(certificate).into_iter().step_by(stride) {
        let Some((found, verdict)) = checked(&mutant) else {
            rejected += 1;
            continue;
        };
        accepted += 1;
        let claim = match &found.claim {
            Claim::Machine(claim) => claim,
            // True of every psi_max > 1.
            Claim::Postulate(_) => continue,
            Claim::NoCube(_) | Claim::Atlas(_) => panic!("{name}"),
        };
        match (verdict.verdict, &found.proof) {
            (Verdict::Certified, _) => assert!(!seems_false(claim), "{name}"),
            (Verdict::Refuted, Proof::Witness(witness)) => {
                assert!(fails_at(claim, witness), "{name}");
            }
            (verdict, proof) => panic!("{name}: {verdict} by {proof:?}"),
        }
    }
    (rejected, accepted)
}

const PSI: &str = "min = \"1/2\", max = 2";
const CUBE: [&str; 2] = ["-73.2", "126.8"];

#[test]
fn the_test_of_truth_is_not_blind() {
    assert!(seems_false(&orthoglide("310", CUBE, PSI)), "the rounded machine");
    let with_room = orthoglide("310", CUBE, "min = \"1/2.01\", max = 2.01");
    assert!(!seems_false(&with_room));
    let reach = orthoglide("1", ["-3/4", "3/4"], PSI);
    assert!(seems_false(&reach), "out of reach at the corners");
}

#[test]
fn mutants_of_the_prototype_s_certificate_are_rejected_or_true() {
    let (rejected, accepted) = judge(&certificate_of(&cube("2", "200")));
    // Accepted are other words in the provenance, another side or offset, a precision above what
    // is needed, some larger psi_max, evidence that also serves, and equal nodes exchanged.
    assert!(rejected > 600 && accepted > 20, "{rejected} {accepted}");
}

#[test]
fn mutants_of_a_box_s_certificate_are_rejected_or_true() {
    let (rejected, accepted) = judge(&certificate_of(&orthoglide("312", CUBE, PSI)));
    assert!(rejected > 1500 && accepted > 100, "{rejected} {accepted}");
}

#[test]
fn mutants_of_a_refutation_are_rejected_or_true() {
    let certificate = certificate_of(&orthoglide("310", CUBE, PSI));
    assert_eq!(certificate["verdict"], "refuted");
    let (rejected, accepted) = judge(&certificate);
    assert!(rejected > 500 && accepted > 20, "{rejected} {accepted}");
}

#[test]
fn mutants_of_the_committed_certificates_are_rejected_or_true() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs/certificates");
    let (mut judged, mut rejected, mut accepted) = (0, 0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        if text.len() < MOST_BYTES {
            let (of_these, others) = judge_some(&serde_json::from_str(&text).unwrap(), STRIDE);
            (judged, rejected, accepted) = (judged + 1, rejected + of_these, accepted + others);
        }
    }
    println!("{judged} certificates: {rejected} mutants rejected, {accepted} true");
    assert!(judged > 20 && rejected > 2_000 && accepted > 100, "{rejected} {accepted}");
}
