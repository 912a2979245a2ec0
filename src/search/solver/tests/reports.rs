//! What is reported of the kernel's claims, for people and for scripts.

use super::extremes::of_file;
use super::*;
use crate::report::{text, Report, Row};
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

/// Every row of the paper's cube has its value: its other bounds are of the same cube.
#[test]
fn values_on_the_papers_cube() {
    let report = report(&of_file("orthoglide-cube-all"), 1000);
    let row = |name: &str| report.requirements.iter().find(|row| row.requirement == name);
    let value = |name: &str| row(name).expect("a row").worst_found.expect("a value");
    assert!(report.requirements.iter().all(|row| row.worst_found.is_some()));
    // At Q2.
    assert!((value("parallel margin") - 2f64.sqrt() / 27f64.sqrt()).abs() < 1e-9);
}

/// What a joint has to hold is greatest at one place, whatever its bound is; a determinant less a far bound times another
/// is least elsewhere, where it is 63.8 in place of 97.4.
#[test]
fn the_worst_load_does_not_depend_on_its_bound() {
    let mut claim = linear_delta(SLAB);
    let force = ["30", "0", "-100"].map(|x| Expression::try_from(x.to_owned()).expect("a number"));
    let found = [150.0, 1e4].map(|bound| {
        let given = [("force".to_owned(), force.to_vec())].into();
        claim.require = vec![Requirement { given, ..require("load", Bound::Max(decimal(bound))) }];
        let rows = report(&claim, 1000).requirements;
        let loads = rows.iter().filter(|row| row.requirement.starts_with("load"));
        loads.filter_map(|row| row.worst_found).fold(0.0, f64::max)
    });
    assert!(found[0] > 50.0 && (found[0] - found[1]).abs() < 1e-6 * found[0], "{found:?}");
}

/// Of legs of which one is longer, the angle of the other may be the greater: margins of squares are of the length.
#[test]
fn of_what_is_demanded_of_all_legs_the_worst_value_is_shown() {
    let row = |value, margin, relation| Row {
        requirement: "leg angle 1".to_owned(),
        of_all: Some("leg angle".to_owned()),
        margin,
        unit: Some("deg"),
        relation,
        bound_text: format!("{relation} 45"),
        bound: format!("{relation} 45"),
        worst_found: value,
        at: Vec::new(),
        machine: Vec::new(),
        seems_violated: false,
    };
    assert!(row(Some(25.0), 9.0, "<=").is_worse_than(&row(Some(24.0), 8.0, "<=")));
    assert!(!row(Some(25.0), 9.0, ">=").is_worse_than(&row(Some(24.0), 8.0, ">=")));
    assert!(row(None, -1e3, "<=").is_worse_than(&row(Some(24.0), 8.0, "<=")));
    assert!(row(Some(0.0), 8.0, "in").is_worse_than(&row(Some(9.0), 9.0, "in")));
}
