//! Altered certificates: each is rejected, or what it says is still true.

use super::machines::{self, REFERENCE_BITS};
use super::random::Random;
use super::verified;
use num_rational::BigRational;
use orthocert::verify::Answer;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_checker::claim::{Claim, MachineClaim, Workspace};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{determinant, Matrix, Symmetric};
use orthocert_checker::model::Model;
use orthocert_checker::{check, read, Accepted};
use serde_json::{json, Value};

fn certificate_of(claim: &MachineClaim) -> Value {
    match verified(claim, 10_000).answer {
        Answer::Decided { certificate, .. } => {
            serde_json::from_str(&certificate.to_text().unwrap()).unwrap()
        }
        other => panic!("{other:?}"),
    }
}

fn checked(mutant: &Value) -> Option<(Certificate, Accepted)> {
    let certificate = read(mutant.to_string().as_bytes()).ok()?;
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
            let words = ["x", "y", "z", "Q1", "Q2", "upper", "cube", "range", "+", "-"];
            let words = words.iter().chain(&["certified", "refuted", "orthocert/2", "0", "1"]);
            all.extend(words.map(|word| json!(word)));
            if let Ok(number) = orthocert::exact::Exact::parse(text, 1000) {
                for change in ["+1", "-1", "+1/1000000", "-1/1000000", "*2", "/2", "*(-1)"] {
                    let altered = format!("({number}){change}");
                    let altered = orthocert::exact::Exact::parse(&altered, 1000).unwrap();
                    all.push(json!(altered.to_string()));
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

/// Looks for a point at which a claim certainly fails: corners, middles and random points.
fn certainly_false(claim: &MachineClaim, random: &mut Random) -> bool {
    let grid = [0, 1, 2].map(|i| BigRational::new(i.into(), 2.into()));
    let coarse = (0..27).map(|n| [n % 3, n / 3 % 3, n / 9].map(|i| grid[i].clone()));
    let fine = (0..10).map(|_| std::array::from_fn(|_| random.rational(0, 64, 64)));
    let points: Vec<[BigRational; 3]> = coarse.chain(fine).collect();
    points.iter().any(|u| fails_at(claim, u))
}

fn fails_at(claim: &MachineClaim, u: &[BigRational; 3]) -> bool {
    let model = Model::at_point(claim, None, &machines::point(claim, u), REFERENCE_BITS).unwrap();
    let Some(states) = machines::states(&model) else { return true };
    let gram = Symmetric::gram_of(&states.map(|state| state.row));
    let low = gram.minus_identity(&model.bounds.kappa.sqr());
    let high = model.bounds.k.as_ref().map(|k| gram.subtracted_from(&k.sqr()));
    certainly_indefinite(&low) || high.is_some_and(|high| certainly_indefinite(&high))
}

/// Some principal minor is certainly negative.
fn certainly_indefinite(t: &Symmetric<Fixed>) -> bool {
    let Symmetric { diagonal: [a, b, c], off: [x, y, z] } = t;
    let second = |p: &Fixed, q: &Fixed, r: &Fixed| p.mul(q).sub(&r.sqr());
    let row = |p: &Fixed, q: &Fixed, r: &Fixed| [p.clone(), q.clone(), r.clone()];
    let full: Matrix<Fixed> = [row(a, x, y), row(x, b, z), row(y, z, c)];
    let others = [second(a, b, x), second(a, c, y), second(b, c, z), determinant(&full)];
    t.diagonal.iter().chain(&others).any(|minor| minor.neg().is_positive())
}

/// Checks every mutant; returns how many were rejected and how many accepted.
fn judge(certificate: &Value, random: &mut Random) -> (usize, usize) {
    assert!(checked(certificate).is_some(), "the certificate itself");
    let (mut rejected, mut accepted) = (0, 0);
    for (name, mutant) in mutants(certificate) {
        let Some((found, verdict)) = checked(&mutant) else {
            rejected += 1;
            continue;
        };
        accepted += 1;
        let Claim::Machine(claim) = &found.claim else { panic!("{name}") };
        match (verdict.verdict, &found.proof) {
            (Verdict::Certified, _) => assert!(!certainly_false(claim, random), "{name}"),
            (Verdict::Refuted, Proof::Witness(witness)) => {
                // A witness is its own evidence: the claim must fail at its point.
                let Workspace::Box { min, .. } = &claim.workspace else { panic!("{name}") };
                assert_eq!(min.len(), witness.point.len());
                let here =
                    Workspace::Box { min: witness.point.clone(), max: witness.point.clone() };
                let there = MachineClaim { workspace: here, ..claim.clone() };
                let u = [0, 0, 0].map(|n| BigRational::from_integer(n.into()));
                assert!(fails_at(&there, &u), "{name}");
            }
            (verdict, proof) => panic!("{name}: {verdict} by {proof:?}"),
        }
    }
    (rejected, accepted)
}

#[test]
fn the_test_of_truth_is_not_blind() {
    let mut random = Random::new(70);
    let mut claim = machines::orthoglide("310", "-73.2", "126.8");
    let bounds = |psi: &str| {
        let exact = machines::exact;
        let range = orthocert_checker::claim::Range {
            min: Some(exact(&format!("1/({psi})"))),
            max: Some(exact(psi)),
        };
        Some(range)
    };
    claim.requirements.transmission = bounds("2");
    assert!(certainly_false(&claim, &mut random), "the rounded machine");
    claim.requirements.transmission = bounds("2.01");
    assert!(!certainly_false(&claim, &mut random), "with room");
    let reach = machines::orthoglide("1", "-3/4", "3/4");
    assert!(certainly_false(&reach, &mut random), "out of reach at the corners");
}

#[test]
fn mutants_of_the_prototype_s_certificate_are_rejected_or_true() {
    let mut random = Random::new(71);
    let certificate = certificate_of(&machines::cube("2", "200"));
    let (rejected, accepted) = judge(&certificate, &mut random);
    // Accepted are other words in the provenance, another side or offset, a precision above what
    // is needed, some larger psi_max, evidence that also serves, and equal nodes exchanged.
    assert!(rejected > 600 && accepted > 20, "{rejected} {accepted}");
}

#[test]
fn mutants_of_a_box_s_certificate_are_rejected_or_true() {
    let mut random = Random::new(72);
    let mut claim = machines::orthoglide("312", "-73.2", "126.8");
    let exact = machines::exact;
    let range = orthocert_checker::claim::Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    claim.requirements.transmission = Some(range);
    let (rejected, accepted) = judge(&certificate_of(&claim), &mut random);
    assert!(rejected > 1500 && accepted > 100, "{rejected} {accepted}");
}

#[test]
fn mutants_of_a_refutation_are_rejected_or_true() {
    let mut random = Random::new(73);
    let mut claim = machines::orthoglide("310", "-73.2", "126.8");
    let exact = machines::exact;
    let range = orthocert_checker::claim::Range { min: Some(exact("1/2")), max: Some(exact("2")) };
    claim.requirements.transmission = Some(range);
    let certificate = certificate_of(&claim);
    assert_eq!(certificate["verdict"], "refuted");
    let (rejected, accepted) = judge(&certificate, &mut random);
    assert!(rejected > 500 && accepted > 20, "{rejected} {accepted}");
}
