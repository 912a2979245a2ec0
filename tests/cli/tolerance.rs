//! `tolerance`: both ends, each kind and all together, and what is refused.

use crate::support::Folder;
use serde_json::Value;

const DESIGN: &str = "orthoglide-312.toml";

fn widened(folder: &Folder, arguments: &[&str]) -> Value {
    answer(folder, &[&[DESIGN, "--gap", "1e-2"], arguments].concat())
}

/// The answer, whose exit code says whether every gap was reached.
fn answer(folder: &Folder, arguments: &[&str]) -> Value {
    let run = folder.run(&[&["tolerance"], arguments, &["--format", "json"]].concat());
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    let rows = value["tolerances"].as_array().unwrap();
    let reached = rows.iter().all(|row| row["gap_reached"] == true);
    run.exits(if reached { 0 } else { 3 });
    value
}

fn end(value: &Value) -> f64 {
    let text = value.as_str().unwrap();
    match text.split_once('/') {
        Some((p, q)) => p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap(),
        None => text.parse().unwrap(),
    }
}

#[test]
fn both_ends_are_what_verify_says_of_them() {
    let folder = Folder::with(&[DESIGN]);
    let value = widened(&folder, &["--on", "leg_length", "-o", "."]);
    let row = &value["tolerances"][0];
    let (certified, refuted) = (end(&row["certified"]), end(&row["refuted"]));
    assert!(0.5 < certified && certified < refuted && refuted < 1.5, "{certified} {refuted}");
    assert_eq!(row["counterexample"]["machine"].as_array().unwrap().len(), 3);
    folder.run(&["check", "tolerance-leg_length-certified.cert.json"]).exits(0);
    folder.run(&["check", "tolerance-leg_length-refuted.cert.json"]).exits(1);
    let design = String::from_utf8(folder.read(DESIGN)).unwrap();
    for (name, t, code) in [("in.toml", &row["certified"], 0), ("out.toml", &row["refuted"], 1)] {
        let length = format!("leg_length = \"312 ± ({})\"", t.as_str().unwrap());
        folder.write(name, design.replace("leg_length = 312", &length));
        let stem = name.trim_end_matches(".toml");
        folder.run(&["verify", name]).exits(code);
        // The certificate is of that very design.
        let side = if code == 0 { "certified" } else { "refuted" };
        let certificate = format!("tolerance-leg_length-{side}.cert.json");
        folder.run(&["check", &certificate, "--design", name]).exits(code);
        assert!(folder.path(&format!("{stem}.cert.json")).is_file());
    }
}

#[test]
fn kinds_together_admit_less_than_each_alone() {
    let folder = Folder::with(&[DESIGN]);
    let value = widened(&folder, &["--on", "direction,leg_length,anchor", "--max-boxes", "100"]);
    let rows = value["tolerances"].as_array().unwrap();
    let measures: Vec<&str> = rows.iter().map(|row| row["measure"].as_str().unwrap()).collect();
    assert_eq!(measures, ["length", "length", "component", "length", "share"]);
    let certified: Vec<f64> = rows.iter().map(|row| end(&row["certified"])).collect();
    assert!(certified[3] < certified[0] && certified[3] < certified[1], "{certified:?}");
    assert!(certified[4] < 1.0, "{certified:?}");
    for row in rows {
        assert!(end(&row["certified"]) < end(&row["refuted"]));
        let reached = end(&row["refuted"]) / end(&row["certified"]) - 1.0 <= 0.01;
        assert_eq!(row["gap_reached"], reached);
    }
    assert_eq!(rows[4]["weights"]["anchor"], rows[1]["certified"]);
}

#[test]
fn the_answer_does_not_depend_on_the_threads() {
    let folder = Folder::with(&[DESIGN]);
    let asked = ["--on", "anchor,leg_length", "--by-leg", "--max-boxes", "100", "--threads"];
    let one = widened(&folder, &[&asked[..], &["1"]].concat());
    assert_eq!(one["tolerances"].as_array().map(Vec::len), Some(3 + 2 * 3));
    assert_eq!(one, widened(&folder, &[&asked[..], &["4"]].concat()));
    let short = ["--on", "anchor", "--gap", "0.0001", "--max-boxes", "60"];
    let text = folder.run(&[&["tolerance", DESIGN], &short[..]].concat()).exits(3).stdout;
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("exit code"), "{text}");
    assert!(text.contains("  limited by\n") && text.contains("greatest psi <= 2"), "{text}");
}

/// The leg that allows least comes first, and all of them together allow less.
#[test]
fn legs_are_ranked() {
    let folder = Folder::with(&["skew-guides.toml"]);
    let arguments = ["--on", "leg_length", "--gap", "0.1", "--max-boxes", "100"];
    let value = answer(&folder, &[&["skew-guides.toml", "--by-leg"], &arguments[..]].concat());
    let rows = value["tolerances"].as_array().unwrap();
    let of_legs: Vec<&Value> = rows.iter().filter(|row| row.get("leg").is_some()).collect();
    assert_eq!((rows.len(), of_legs.len()), (4, 3));
    let certified: Vec<f64> = of_legs.iter().map(|row| end(&row["certified"])).collect();
    assert!(certified.is_sorted(), "{certified:?}");
    assert!(end(&rows[0]["certified"]) < certified[0], "{rows:?}");
    let mut legs: Vec<u64> = of_legs.iter().filter_map(|row| row["leg"].as_u64()).collect();
    legs.sort_unstable();
    assert_eq!(legs, [1, 2, 3]);
}

#[test]
fn the_worst_machine_is_found() {
    let folder = Folder::with(&["linear-delta-linuxcnc-box.toml"]);
    // What is certified is not looked at here.
    let arguments = ["--on", "anchor,direction", "--gap", "1e-2", "--max-boxes", "60"];
    let value = answer(&folder, &[&["linear-delta-linuxcnc-box.toml"], &arguments[..]].concat());
    // Flipping the ends of all tolerances one by one, over grids of points, from many starts: no
    // machine fails below 2.926 and 0.009480.
    for (row, least) in [(0, 2.926), (1, 0.009_480)] {
        let refuted = end(&value["tolerances"][row]["refuted"]);
        assert!(least * 0.999 < refuted && refuted < least * 1.004, "{row}: {refuted}");
    }
}

#[test]
fn wide_tolerances_of_a_turned_machine_are_certified() {
    let folder = Folder::with(&["linear-delta-linuxcnc-box.toml"]);
    let arguments = ["--on", "leg_length", "--gap", "1e-2", "-o", "."];
    let value = answer(&folder, &[&["linear-delta-linuxcnc-box.toml"], &arguments[..]].concat());
    let row = &value["tolerances"][0];
    // With M in place of A and D it would end near 3.04, where the widths of three entries meet in each
    // of W M; in ranges of A and D near 6.02.
    assert!(end(&row["certified"]) > 9.0, "{row}");
    let certificate = "tolerance-leg_length-certified.cert.json";
    folder.run(&["check", certificate]).exits(0).says(&["ACCEPTED"]);
    folder.run(&["show", certificate]).exits(0).says(&["tolerances"]);
}

#[test]
fn a_row_s_time_is_kept_and_stated() {
    let folder = Folder::with(&[DESIGN]);
    let arguments = ["tolerance", DESIGN, "--on", "anchor", "--each"];
    let text = folder.run(&[&arguments[..], &["0"]].concat()).exits(3);
    text.says(&["*", "Each row had at most 0s of time"]);
    let ample = [&arguments[..], &["5min", "--gap", "0.5", "--format", "json"]].concat();
    let value: Value = serde_json::from_str(&folder.run(&ample).exits(0).stdout).unwrap();
    assert_eq!(
        (&value["each"], &value["tolerances"][0]["out_of_time"]),
        (&"5min".into(), &false.into())
    );
    let bad = folder.run(&[&arguments[..], &["soon"]].concat()).exits(2);
    bad.complains(&["--each", "accepted"]);
}

#[test]
fn a_design_that_is_not_certified_has_no_tolerance() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    let run = folder.run(&["tolerance", "orthoglide-310.toml"]).exits(1);
    run.says(&["REFUTED", "no tolerance with which it could be certified"]);
    let arguments = ["tolerance", "orthoglide-310.toml", "--format", "json"];
    let value: Value = serde_json::from_str(&folder.run(&arguments).exits(1).stdout).unwrap();
    assert_eq!(value["nominal"], "refuted");
    assert_eq!(value["tolerances"], serde_json::json!([]));
}

#[test]
fn of_a_design_that_is_undecided_nothing_is_claimed() {
    let folder = Folder::with(&[DESIGN]);
    let arguments = ["tolerance", DESIGN, "--on", "leg_length", "--max-boxes", "1"];
    let run = folder.run(&arguments).exits(3);
    let run = run.says(&["UNDECIDED", "undecided within the budget", "raise --max-boxes"]);
    assert!(!run.stdout.contains("no tolerance"), "{}", run.stdout);
    let json = folder.run(&[&arguments[..], &["--format", "json"]].concat()).exits(3);
    let value: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(
        (&value["nominal"], &value["tolerances"]),
        (&"undecided".into(), &Value::Array(vec![]))
    );
}

#[test]
fn kinds_that_the_mechanism_lacks_are_refused() {
    let folder = Folder::with(&[DESIGN, "orthoglide-prototype.toml"]);
    for kind in ["arm", "axis", "legs", ""] {
        let run = folder.run(&["tolerance", DESIGN, "--on", kind]).exits(2);
        run.complains(&["--on", "leg_length, anchor, direction, platform"]);
    }
    let cube = folder.run(&["tolerance", "orthoglide-prototype.toml"]).exits(2);
    cube.complains(&["workspace.cube", "accepted"]);
    let gap = folder.run(&["tolerance", DESIGN, "--gap", "-1"]).exits(2);
    gap.complains(&["--gap", "accepted"]);
}
