//! What is reported of the kernel's claims, for people and for scripts.

use super::*;
use crate::report::{text, Report};
use std::time::Duration;

fn report(claim: &MachineClaim, boxes: usize) -> Report {
    let found = with_boxes(claim, boxes);
    Report::new(claim, &found, Duration::from_millis(5)).expect("a report")
}

fn objection(report: &Report) -> Option<String> {
    let mut schema: serde_json::Value =
        serde_json::from_str(include_str!("../../../answers.schema.json")).expect("JSON");
    schema["$ref"] = serde_json::json!("#/$defs/verify");
    let validator = jsonschema::draft202012::new(&schema).expect("a schema");
    let answer = serde_json::to_value(report).expect("JSON");
    let objection = validator.iter_errors(&answer).next();
    objection.map(|error| format!("at {}: {error:.300}", error.instance_path()))
}

#[test]
fn a_certified_claim() {
    let claim = beyond(&five_bar(), 1e-2);
    let report = report(&claim, 1000);
    assert_eq!(objection(&report), None);
    assert_eq!(report.coordinates[..], ["x", "y"]);
    let text = text::report(&report, text::Style::Plain, true);
    assert!(text.starts_with("CERTIFIED  design\n"), "{text}");
    assert!(text.contains("at P = (x, y)"), "{text}");
    let row = report.requirements.iter().find(|row| row.requirement == "greatest psi");
    let row = row.expect("a row");
    assert_eq!(row.at.len(), 2);
    let [_, greatest] = psi(&claim);
    assert!((row.worst_found.expect("a value") - greatest).abs() < 1e-9);
    assert!(!row.seems_violated);
}

#[test]
fn a_refuted_claim() {
    let length = r#"{"min":"310","max":"311"}"#;
    let mut claim = orthoglide(length, CUBE);
    claim.require = vec![
        require("transmission", Bound::Max(decimal(1.9))),
        require("joint_range", Bound::Min(decimal(-400.0))),
    ];
    let report = report(&claim, 1000);
    assert_eq!(objection(&report), None);
    let found = report.counterexample.as_ref().expect("a counterexample");
    assert_eq!(found.rule, "transmission");
    assert_eq!(found.violated, "greatest psi <= 1.9");
    assert!(found.value.starts_with("greatest psi >= 1.9"), "{}", found.value);
    assert_eq!((found.point.len(), found.machine.len(), found.directions.len()), (3, 3, 1));
    assert_eq!((found.machine[0].leg, &*found.machine[0].parameter), (Some(1), "length"));
    let text = text::report(&report, text::Style::Plain, true);
    assert!(text.contains("! greatest psi"), "{text}");
    assert!(text.contains("machine         leg 1   leg 2   leg 3\n"), "{text}");
    let brief = text::report(&report, text::Style::Plain, false);
    assert!(brief.contains("least rho_1 of 3") && !brief.contains("least rho_2"), "{brief}");
    assert!(brief.lines().count() < text.lines().count(), "{brief}");
}

#[test]
fn an_undecided_claim() {
    let report = report(&beyond(&linear_delta(CYLINDER), 1e-4), 10);
    assert_eq!(objection(&report), None);
    let remains = report.undecided.as_ref().expect("remains");
    assert!(remains.boxes > 0 && remains.share > 0.0 && remains.share <= 1.0);
    assert!(remains.regions.iter().all(|region| region.min.len() == 3));
    assert!(remains.regions.iter().map(|region| region.boxes).sum::<usize>() == remains.boxes);
    let text = text::report(&report, text::Style::Plain, true);
    assert!(text.starts_with("UNDECIDED"), "{text}");
    assert!(text.contains("the budget of 10 boxes is used up"), "{text}");
}
