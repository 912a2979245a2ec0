//! `limit`: both ends of every kind of number are what `verify` says of them; what is refused.

use crate::support::{number, Folder, Run};
use serde_json::Value;

const BOX: &str = "orthoglide-312.toml";
const DELTA: &str = "linear-delta-klipper-cylinder.toml";

fn answer(run: &Run) -> Value {
    serde_json::from_str(&run.stdout).unwrap()
}

/// The limits of a number, as `--format json` tells them; `edit` writes the number into the design
/// by hand: `verify` and `check --design` have to say the same of it.
fn limits(
    (design, key): (&str, &str),
    options: &[&str],
    code: i32,
    edit: impl Fn(&str, &str) -> String,
) -> Value {
    let folder = Folder::with(&[design]);
    let text = String::from_utf8(folder.read(design)).unwrap();
    let all = [&["limit", design, key, "--format", "json"], options].concat();
    let answer = answer(&folder.run(&all).exits(code));
    for limit in answer["limits"].as_array().unwrap() {
        for (end, code) in [("certified", 0), ("refuted", 1)] {
            let Some(value) = limit[end]["value"].as_str() else { continue };
            let certificate = limit[end]["certificate"]["path"].as_str().unwrap();
            folder.write("edited.toml", edit(&text, value));
            folder.run(&["verify", "edited.toml"]).exits(code);
            folder.run(&["check", certificate, "--design", "edited.toml"]).exits(code);
        }
    }
    // The design is only read.
    assert_eq!(folder.read(design), text.as_bytes());
    answer
}

/// Replaces `old`, in which `#` stands for the number of the design, by the same with another.
fn written<'a>(own: &'a str, pattern: &'a str) -> impl Fn(&str, &str) -> String + 'a {
    move |text, value| {
        let old = pattern.replace('#', own);
        assert!(text.contains(&old), "{old}");
        text.replace(&old, &pattern.replace('#', &format!("\"{value}\"")))
    }
}

/// The certified and the refuted end of a limit that was found to the gap.
fn ends(answer: &Value, side: &str) -> (f64, f64) {
    let limits = answer["limits"].as_array().unwrap();
    let limit = limits.iter().find(|limit| limit["side"] == side).unwrap();
    assert_eq!((&limit["gap_reached"], &limit["open"]), (&true.into(), &false.into()));
    let ends = (number(&limit["certified"]["value"]), number(&limit["refuted"]["value"]));
    assert_eq!(side == "upper", ends.0 < ends.1, "{ends:?}");
    ends
}

#[test]
fn a_leg_length_is_limited_by_a_transmission_factor() {
    let edit = written("312", "leg_length = #");
    let answer = limits((BOX, "mechanism.leg_length"), &[], 0, edit);
    let (certified, refuted) = ends(&answer, "lower");
    // At (c, c, c) the greatest factor is 2 where c/(L^2 - 2c^2)^(1/2) = 1/4: L = c 6^(1/2).
    let exact = 126.8 * 6f64.sqrt();
    assert!(refuted < exact && exact < certified, "{refuted} {exact} {certified}");
    assert!(certified - refuted <= 1e-6 * certified, "{certified} {refuted}");
    let limit = &answer["limits"][0];
    assert_eq!(limit["limited_by"]["violated"], "greatest psi <= 2");
    assert_eq!(limit["limited_by"]["point"], serde_json::json!(["126.8", "126.8", "126.8"]));
    assert_eq!((&answer["own"], &answer["verdict"]), (&"312".into(), &"certified".into()));
}

#[test]
fn a_cylinder_is_limited_where_a_joint_range_ends() {
    let key = (DELTA, "workspace.cylinder.radius");
    let answer = limits(key, &["--gap", "1e-4"], 0, written("80", "radius = #"));
    let (certified, refuted) = ends(&answer, "upper");
    // At (0, r, 200): rho_1 = 200 + (333^2 - (174.75 - r)^2)^(1/2) <= 520.
    let exact = 174.75 - (333f64.powi(2) - 320f64.powi(2)).sqrt();
    assert!(certified <= exact && exact < refuted, "{certified} {exact} {refuted}");
    let [down, up] = &answer["limits"].as_array().unwrap()[..] else { panic!("{answer}") };
    assert_eq!(up["limited_by"]["violated"], "greatest rho_1 <= 520");
    // Downward all is certified, until there is no cylinder any more.
    assert_eq!((&down["refuted"], &down["gap"]), (&Value::Null, &Value::Null));
    assert_eq!(down["ends"]["value"], "0");
    assert!(down["ends"]["reason"].as_str().unwrap().contains("a radius greater than 0"));
}

#[test]
fn a_bound_is_limited_by_what_it_bounds() {
    let key = (BOX, "requirements.transmission.max");
    let answer = limits(key, &["--direction", "down"], 0, written("2", "max = # }"));
    let (certified, refuted) = ends(&answer, "lower");
    let (c, d) = (126.8 / 312.0, 73.2 / 312.0);
    // 1/(1 - t) and 1/(1 - 2t) with t as far as both corners go; the greater one limits.
    let t = |c: f64| c / (1.0 - 2.0 * c * c).sqrt();
    let exact = (1.0 / (1.0 - 2.0 * t(d))).max(1.0 / (1.0 - t(c)));
    assert!(refuted < exact && exact < certified, "{refuted} {exact} {certified}");
    assert_eq!(answer["limits"].as_array().unwrap().len(), 1);
}

#[test]
fn equal_legs_are_varied_together_and_one_by_itself() {
    let options = ["--gap", "1e-3"];
    let all = limits((DELTA, "mechanism.legs.*.length"), &options, 0, written("333", "length = #"));
    let one = limits((DELTA, "mechanism.legs.0.length"), &options, 0, |text, value| {
        text.replacen("length = 333", &format!("length = \"{value}\""), 1)
    });
    // The joint range of the first leg ends both.
    let (certified, refuted) = ends(&all, "upper");
    let exact = (320f64.powi(2) + (174.75f64 - 80.0).powi(2)).sqrt();
    assert!(certified <= exact && exact < refuted, "{certified} {exact} {refuted}");
    let (certified, refuted) = ends(&one, "upper");
    assert!(certified <= exact && exact < refuted, "{certified} {exact} {refuted}");
}

#[test]
fn of_a_tolerance_the_middle_is_varied() {
    let design = "orthoglide-tolerance.toml";
    let key = (design, "mechanism.leg_length");
    let answer = limits(key, &["--gap", "1e-3"], 0, |text, value| {
        text.replace("\"311.5 ± 0.2\"", &format!("\"{value} ± 0.2\""))
    });
    let (certified, refuted) = ends(&answer, "lower");
    // With every leg 0.2 shorter the cube's corner (126.8, 126.8, 126.8) asks for 310.7953.
    assert!(310.0 < refuted && refuted < 310.7954, "{refuted}");
    assert!(310.7953 < certified && certified < 311.3, "{certified}");
    assert_eq!((&answer["own"], &answer["tolerance"]), (&"623/2".into(), &"0.2".into()));
    assert_eq!(answer["limits"][0]["limited_by"]["machine"].as_object().unwrap().len(), 3);
}

#[test]
fn a_gap_that_is_not_reached_leaves_the_nearest_ends() {
    let design = "orthoglide-tolerance.toml";
    let folder = Folder::with(&[design]);
    let all = ["limit", design, "mechanism.leg_length", "--direction", "down", "--max-boxes", "30"];
    let run = folder.run(&all).exits(3);
    let run = run.says(&["lower limit", "more than asked for", "undecided 310.", "may help"]);
    // Paths are not broken.
    let mut lines = run.stdout.lines().filter(|line| !line.starts_with("  certificate "));
    assert!(lines.all(|line| line.chars().count() <= 80), "{}", run.stdout);
    folder.run(&["check", "orthoglide-tolerance.limit-lower-certified.cert.json"]).exits(0);
    folder.run(&["check", "orthoglide-tolerance.limit-lower-refuted.cert.json"]).exits(1);
}

#[test]
fn a_quiet_answer_is_a_line_for_each_limit() {
    let folder = Folder::with(&[BOX]);
    let all = ["limit", BOX, "mechanism.leg_length", "--gap", "0.01", "-q"];
    let text = folder.run(&all).exits(0).stdout;
    let lines: Vec<&str> = text.lines().collect();
    let [lower, upward] = &lines[..] else { panic!("{text}") };
    assert!(lower.starts_with("lower limit: certified 31") && lower.contains(", refuted 3"));
    assert!(upward.starts_with("upward: certified") && upward.ends_with(", refuted none"));
}

#[test]
fn a_coordinate_that_is_zero_is_measured_by_those_beside_it() {
    let key = (DELTA, "mechanism.legs.0.anchor.0");
    let answer = limits(key, &["--gap", "1e-3"], 0, written("0", "anchor = [#, \"174.75\""));
    let ((low, _), (high, _)) = (ends(&answer, "lower"), ends(&answer, "upper"));
    // The machine is symmetric.
    assert!(low < 0.0 && (low + high).abs() < 0.02, "{low} {high}");
}

#[test]
fn from_a_refuted_design_the_way_to_a_certified_one_is_found() {
    let design = "orthoglide-310.toml";
    let edit = written("310", "leg_length = #");
    let answer = limits((design, "mechanism.leg_length"), &["--gap", "1e-4"], 0, edit);
    assert_eq!(answer["verdict"], "refuted");
    let (certified, refuted) = ends(&answer, "lower");
    assert!(310.0 < refuted && certified < 310.7, "{refuted} {certified}");
    let text = Folder::with(&[design]).run(&["limit", design, "mechanism.leg_length"]).exits(0);
    let text = text.says(&[
        "310, refuted",
        "lower limit",
        "downward",
        "no certified value was found below it",
    ]);
    // What was found comes first.
    assert!(text.stdout.find("lower limit") < text.stdout.find("downward"), "{}", text.stdout);
}

#[test]
fn a_tie_has_a_limit_about_it() {
    let design = "orthoglide-tie.toml";
    let folder = Folder::with(&[design]);
    let run = folder.run(&["limit", design, "mechanism.leg_length", "--format", "json"]).exits(0);
    let answer = answer(&run);
    assert_eq!(
        (&answer["verdict"], &answer["limits"][0]["searched"]),
        (&"undecided".into(), &"about".into())
    );
    let (certified, refuted) = ends(&answer, "lower");
    assert!(certified - refuted <= 1e-6 * certified, "{certified} {refuted}");
}

#[test]
fn without_a_budget_nothing_is_claimed() {
    let folder = Folder::with(&[BOX]);
    let run = folder.run(&["limit", BOX, "workspace.max.*", "--timeout", "0"]).exits(3);
    let text =
        run.says(&["undecided", "no value was decided", "the time was up", "a larger --max-boxes"]);
    assert!(!text.stdout.contains("limit\n"), "{}", text.stdout);
    assert_eq!(folder.names(), [BOX]);
}

#[test]
fn nothing_depends_on_the_threads() {
    let certificates = ["lower-certified", "lower-refuted", "upper-certified"];
    let run = |threads: &str| {
        let folder = Folder::with(&[BOX]);
        std::fs::create_dir(folder.path("out")).unwrap();
        let arguments = ["limit", BOX, "mechanism.leg_length", "-o", "out", "--threads", threads];
        let text = folder.run(&arguments).exits(0).stdout;
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert_eq!(folder.names(), ["orthoglide-312.toml", "out"]);
        certificates.map(|end| folder.read(&format!("out/orthoglide-312.limit-{end}.cert.json")))
    };
    assert_eq!(run("1"), run("3"));
}

#[test]
fn keys_without_a_number_are_refused_before_anything_is_written() {
    let folder = Folder::with(&[BOX, DELTA]);
    for (design, key, parts) in [
        (BOX, "leg_length", &["did you mean mechanism.leg_length?"][..]),
        (
            BOX,
            "mechanism.leg_lenght",
            &["there is mechanism.kind, mechanism.leg_length", "did you mean"],
        ),
        (BOX, "workspace.max", &["an array of 3 elements", "workspace.max.2"]),
        (BOX, "workspace.max.3", &["none at 3"]),
        (BOX, "mechanism.kind", &["\"orthoglide\"", "accepted: a number"]),
        (BOX, "a\nb", &["nothing: the key is missing"]),
        (DELTA, "mechanism.legs[1].length", &["did you mean mechanism.legs.1.length?"]),
        (DELTA, "mechanism.legs.*.anchor.1", &["the same number in every element"]),
    ] {
        folder.run(&["limit", design, key]).exits(2).complains(&[design]).complains(parts);
    }
    for gap in ["0", "1", "-1e-3", "1e-10", "sqrt(1/5)", "x"] {
        let run = folder.run(&["limit", BOX, "mechanism.leg_length", "--gap", gap]).exits(2);
        run.complains(&["--gap", "accepted"]);
    }
    folder.run(&["limit", BOX]).exits(2);
    folder.run(&["limit", "missing.toml", "x"]).exits(2).complains(&["missing.toml"]);
    folder.run(&["limit", BOX, "mechanism.leg_length", "-o", "none"]).exits(4);
    assert_eq!(folder.names(), [DELTA, BOX]);
}

#[cfg(unix)]
#[test]
fn where_no_value_fails_the_exit_code_is_explained() {
    let folder = Folder::with(&["tripteron.toml"]);
    let run = folder.run(&["limit", "tripteron.toml", "workspace.max.0"]).exits(3);
    run.says(&["No limit was found, for which the exit code is 3"]);
    let run = folder.run(&["largest-cube", "tripteron.toml"]).exits(3);
    run.says(&["gap missed", "the requirements seem to hold in cubes of any size"]);
}

#[test]
fn the_design_is_not_overwritten_through_a_link() {
    let folder = Folder::with(&[BOX]);
    let before = folder.read(BOX);
    let target = folder.path("orthoglide-312.limit-lower-certified.cert.json");
    std::os::unix::fs::symlink(folder.path(BOX), &target).unwrap();
    for options in [&[][..], &["--follow-links"]] {
        let all = [&["limit", BOX, "mechanism.leg_length"], options].concat();
        folder.run(&all).exits(2).complains(&["is a file that is read"]);
        assert!(folder.read(BOX) == before);
    }
}
