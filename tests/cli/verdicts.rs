//! Every verdict of `verify`: exit code, report, certificate.

use crate::support::{Folder, Run, LONG};
use orthocert::search::accepted::check;
use orthocert_checker::certificate::Verdict;
use orthocert_checker::read;
use std::fs;
use std::path::Path;

#[test]
fn without_a_design_the_prototype_is_certified() {
    let folder = Folder::new();
    let run = folder.run(&["verify"]).exits(0);
    let run = run.says(&["greatest psi", "<= 2", ">= 0.5", "orthoglide-prototype.cert.json"]);
    assert!(run.stdout.starts_with("CERTIFIED  Orthoglide prototype\n"));
    assert_eq!(run.stderr, "");
    assert_eq!(folder.names(), ["orthoglide-prototype.cert.json"]);
    let bytes = folder.read("orthoglide-prototype.cert.json");
    assert!(bytes.len() <= 10_000);
    let accepted = check(&read(&bytes).unwrap()).unwrap();
    assert_eq!(accepted.verdict, Verdict::Certified);
    assert!(accepted.size.nodes <= 40);
}

#[test]
fn every_design_has_its_verdict() {
    for (name, code) in [
        ("orthoglide-prototype", 0),
        ("orthoglide-312", 0),
        ("orthoglide-joint-range", 0),
        ("orthoglide-relaxed-10-percent", 0),
        ("orthoglide-relaxed-1-percent", 0),
        ("orthoglide-relaxed-0.1-percent", 0),
        ("orthoglide-relaxed-1e-6", 0),
        ("orthoglide-tolerance", 0),
        ("linear-delta-klipper-cylinder", 0),
        ("rotary-delta-linuxcnc", 0),
        ("upu-struts", 0),
        ("tripteron", 0),
        ("delta-joint-speed", 0),
        ("delta-conditioning-refuted", 1),
        ("delta-joint-speed-refuted", 1),
        ("delta-leg-angle-refuted", 1),
        ("delta-out-of-reach", 1),
        ("delta-parallel-margin-refuted", 1),
        ("delta-serial-margin-refuted", 1),
        ("rotary-delta-angle-refuted", 1),
        ("star-singular", 1),
        ("orthoglide-310", 1),
        ("orthoglide-310.25-published", 1),
        ("orthoglide-tie", 3),
    ] {
        let design = format!("{name}.toml");
        let certificate = format!("{name}.cert.json");
        let folder = Folder::with(&[&design]);
        let run = folder.run(&["verify", &design]).exits(code);
        let word = ["CERTIFIED  ", "REFUTED  ", "", "UNDECIDED  "][code as usize];
        assert!(run.stdout.starts_with(word), "{name}: {}", run.stdout);
        if code == 3 {
            assert_eq!(folder.names(), [design]);
            continue;
        }
        // The words for the violation fit it, whatever the requirement.
        assert!(!run.stdout.contains("a requirement\n"), "{name}: {}", run.stdout);
        let accepted = check(&read(&folder.read(&certificate)).unwrap()).unwrap();
        let verdict = [Verdict::Certified, Verdict::Refuted][code as usize];
        assert_eq!(accepted.verdict, verdict, "{name}");
    }
}

/// Where it has another sign than at the centre, a determinant is not 0 there, but on the way.
#[test]
fn a_determinant_is_shown_with_its_sign() {
    let folder = Folder::with(&["star-singular.toml", "delta-out-of-reach.toml"]);
    let sign = "|det M|: negative where det M has another sign than at the centre";
    folder.run(&["verify", "star-singular.toml"]).exits(1).says(&["> 0      -0.130", sign]);
    let run = folder.run(&["verify", "delta-out-of-reach.toml"]).exits(1);
    assert!(!run.stdout.contains(sign), "{}", run.stdout);
}

/// Lengths of metres with tolerances of a tenth of a millimetre are beyond machine words: the proof, of 8 million changes by
/// tolerances, takes a third of a second to check, and 12 times as many are too many.
#[test]
fn a_proof_in_integers_of_any_size_is_not_too_long() {
    let folder = Folder::new();
    let name = "tests/designs/kernel/hexapod-rubin-camera-as-made.toml";
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap();
    let (machine, _) = text.split_once("[requirements]").unwrap();
    let of =
        |min: &str| format!("{machine}[requirements]\nstiffness = {{ min = {min}, joint = 1 }}\n");
    folder.write("d.toml", of("0.117"));
    folder.run(&["verify", "d.toml"]).exits(0).says(&["CERTIFIED"]);
    folder.write("e.toml", of("0.1215"));
    folder.run(&["verify", "e.toml"]).exits(3).says(&["the proof", "longer than is admissible"]);
}

#[test]
fn a_refutation_shows_the_point_the_value_and_the_bound() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    let run = folder.run(&["verify", "orthoglide-310.toml"]).exits(1);
    let run = run.says(&[
        "violated      greatest psi <= 2",
        "value there   greatest psi >= 2.00578",
        "at P          (126.8, 126.8, 126.8)",
        "! greatest psi",
        "! the value found is beyond its bound",
    ]);
    assert!(!run.stdout.contains("moving along"), "{}", run.stdout);
    let run = folder.run(&["verify", "orthoglide-310.toml", "--verbose"]).exits(1);
    run.says(&["moving along  (0, 1, -1)"]);
}

#[test]
fn a_refutation_within_tolerances_names_the_machine() {
    let folder = Folder::with(&["orthoglide-tolerance.toml"]);
    let design = String::from_utf8(folder.read("orthoglide-tolerance.toml")).unwrap();
    folder.write("loose.toml", design.replace("311.5 ± 0.2", "311 ± 1"));
    let run = folder.run(&["verify", "loose.toml"]).exits(1);
    let run = run.says(&[
        "machine         leg 1   leg 2   leg 3\n  length            310     310     310\n",
        "--verbose names it",
    ]);
    assert!(!run.stdout.contains("of legs 1, 2, 3"), "{}", run.stdout);
    let run = folder.run(&["verify", "loose.toml", "-v"]).exits(1);
    run.says(&["with length 3", "of legs 1, 2, 3"]);
}

#[test]
fn a_tie_is_undecided_with_its_place_and_reason() {
    let folder = Folder::with(&["orthoglide-tie.toml"]);
    let run = folder.run(&["verify", "orthoglide-tie.toml"]).exits(3);
    let run = run.says(&[
        "UNDECIDED",
        "1 box in 1 region",
        "x  126.7949192429 .. 126.7949192431",
        "what would help: it holds with equality, or nearly",
        "none is written without a verdict",
    ]);
    assert_eq!(run.stderr, "");
}

#[test]
fn an_exhausted_budget_is_undecided() {
    let folder = Folder::with(&[LONG]);
    let run = folder.run(&["verify", LONG, "--max-boxes", "500"]).exits(3);
    run.says(&["the budget of 500 boxes is used up", "not shown within the budget", "--max-boxes"]);
    let run = folder.run(&["verify", LONG, "--timeout", "0"]).exits(3);
    run.says(&["the time is used up"]);
    folder.run(&["verify", LONG, "--timeout", "50ms"]).exits(3).says(&["the time is used up"]);
    assert_eq!(folder.names(), [LONG]);
}

#[test]
fn a_budget_beyond_the_search_changes_nothing() {
    let folder = Folder::new();
    folder.run(&["verify", "--max-boxes", "18446744073709551615", "--timeout", "1e900"]).exits(0);
}

#[test]
fn reports_fit_80_columns() {
    let folder = Folder::with(&[
        "orthoglide-joint-range.toml",
        "orthoglide-310.toml",
        "orthoglide-tie.toml",
    ]);
    for name in folder.names() {
        let run = folder.run(&["verify", &name]);
        for line in run.stdout.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }
    let certificates = Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs/certificates");
    for entry in fs::read_dir(certificates).unwrap() {
        let path = entry.unwrap().path();
        for command in ["show", "check"] {
            let run = folder.run(&[command, path.to_str().unwrap()]);
            for line in run.stdout.lines() {
                // A number may be longer than a line; a line breaks between two only.
                let short = line.chars().count() <= 80 || !line.trim_start().contains(", ");
                assert!(short, "{command} {}: {line}", path.display());
            }
        }
    }
}

#[test]
fn quiet_prints_the_verdict_alone() {
    let folder = Folder::new();
    let run = folder.run(&["verify", "--quiet"]).exits(0);
    assert_eq!(run.stdout, "CERTIFIED  Orthoglide prototype\n");
    assert_eq!(run.stderr, "");
}

#[test]
fn the_certificate_does_not_depend_on_the_number_of_threads() {
    let folder = Folder::with(&["linear-delta-klipper-cylinder.toml"]);
    let design = folder.names()[0].clone();
    for threads in ["1", "2", "4", "16"] {
        let name = format!("{threads}.json");
        folder.run(&["verify", &design, "--threads", threads, "-o", &name]).exits(0);
        assert_eq!(folder.read(&name), folder.read("1.json"), "{threads} threads");
    }
    folder.run(&["verify", &design]).exits(0);
    assert_eq!(folder.read("linear-delta-klipper-cylinder.cert.json"), folder.read("1.json"));
}

/// What a report encloses is searched for, side by side.
#[test]
fn the_report_does_not_depend_on_the_number_of_threads() {
    let folder = Folder::new();
    let committed =
        concat!(env!("CARGO_MANIFEST_DIR"), "/proofs/certificates/orthoglide-tolerance.cert.json");
    for threads in ["1", "2", "5"] {
        let name = format!("{threads}.html");
        let mut command = folder.command(&["report", committed, "-o", &name]);
        Run::from(command.env("RAYON_NUM_THREADS", threads).output().unwrap()).exits(0);
        assert_eq!(folder.read(&name), folder.read("1.html"), "{threads} threads");
    }
}

#[test]
fn a_title_cannot_disguise_a_verdict() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    let design = String::from_utf8(folder.read("orthoglide-310.toml")).unwrap();
    let title = "title = \"\\u001b[2K\\rCERTIFIED\\nCERTIFIED\"";
    let lines = design.lines().map(|l| if l.starts_with("title") { title } else { l });
    folder.write("a.toml", lines.collect::<Vec<_>>().join("\n"));
    let run = folder.run(&["verify", "a.toml"]).exits(1);
    assert!(run.stdout.starts_with("REFUTED  "));
    assert!(!run.stdout.contains('\u{1b}') && !run.stdout.contains('\r'));
    assert!(!run.stdout.contains("\nCERTIFIED"));
}

/// Of arms, joint coordinates are angles: both ends of the sector of each, with both certificates.
#[test]
fn bounds_enclose_the_angles_of_arms() {
    let folder = Folder::with(&["rotary-delta-linuxcnc.toml"]);
    let arguments = ["bounds", "rotary-delta-linuxcnc.toml", "--relative", "1e-2", "-o", "."];
    let run = folder.run(&[&arguments[..], &["--format", "json"]].concat()).exits(0);
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let rows = answer["bounds"].as_array().unwrap();
    let own: Vec<_> = rows.iter().filter(|row| row["unit"] == "deg").collect();
    assert_eq!(own.len(), 6);
    // The greatest angle is at (0, 4, -14), by a formula of its own: 60.3117 degrees.
    for (end, angle) in [("least", 6.524), ("greatest", 60.3117)] {
        let row = own.iter().find(|row| row["quantity"] == "rho_1" && row["end"] == end).unwrap();
        let [min, max] = ["min", "max"].map(|side| quotient(row[side].as_str().unwrap()));
        assert!(min < angle && angle < max && max - min < 0.6, "{min} {max}");
        for (side, code) in [("inner", 1), ("outer", 0)] {
            folder.run(&["check", &format!("rho-1-{end}-{side}.cert.json")]).exits(code);
        }
    }
}

/// Rods, and a tool, so thick that they touch: both bodies are named, with their nearest points where these are few.
#[test]
fn bodies_that_are_too_near_are_named() {
    let folder = Folder::with(&["orthoglide-prototype-whole.toml"]);
    let whole = String::from_utf8(folder.read("orthoglide-prototype-whole.toml")).unwrap();
    for (name, from, to, told) in [
        (
            "rods",
            "radius = 10,",
            "radius = 60,",
            &["<= 0", "a rod of leg 3, about at (1", "a rod of leg 2, about at (1"][..],
        ),
        (
            "tool",
            "radius = 15",
            "radius = 70",
            &["<= 0", "a body on the platform, about at (-73, 126, 76.3)", "a rod of leg 1, about"],
        ),
        (
            "bars",
            "spread = 80",
            "spread = 20",
            &["<= ", "of a rod of leg 1 and a rod of leg 1 at P"],
        ),
    ] {
        assert!(whole.contains(from), "{name}");
        let design = format!("{name}.toml");
        folder.write(&design, whole.replace(from, to));
        folder.run(&["verify", &design]).exits(1).says(&["clearance >= 2"]).says(told);
        let run = folder.run(&["verify", &design, "--format", "json"]).exits(1);
        let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let bodies = answer["counterexample"]["bodies"].as_array().unwrap();
        assert_eq!(bodies.len(), 2, "{name}");
        assert!(
            bodies.iter().all(|near| near.get("point").is_some() == (name != "bars")),
            "{name}"
        );
    }
}

/// The value of `p/q`, or of a decimal.
fn quotient(text: &str) -> f64 {
    let (p, q) = text.split_once('/').unwrap_or((text, "1"));
    p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap()
}

/// Beyond 90 degrees there is no bound of an angle: what is looked for so far out does not end the rest.
#[test]
fn bounds_of_an_angle_that_are_looked_for_beyond_a_right_one_are_not_found() {
    let folder = Folder::new();
    let design = include_str!("../designs/delta-leg-angle.toml");
    let wide = design.replace("radius = 80", "radius = 120").replace("max = 50.1", "max = 89");
    folder.write("d.toml", &wide);
    for boxes in ["2", "10"] {
        let run = folder.run(&["bounds", "d.toml", "--max-boxes", boxes]).exits(3);
        run.says(&["leg angle", "not enclosed"]);
        folder.run(&["summary", "d.toml", "--max-boxes", boxes]).exits(3);
    }
}

#[test]
fn bounds_say_where_they_are_wider_than_asked_for() {
    let folder = Folder::with(&["orthoglide-prototype-whole.toml", "orthoglide-tolerance.toml"]);
    let wide = "orthoglide-prototype-whole.toml";
    let run = folder.run(&["bounds", wide, "--relative", "1e-4", "--max-boxes", "200"]).exits(0);
    let row = run.stdout.lines().find(|line| line.contains("  accuracy ")).unwrap().to_owned();
    assert!(row.contains(" * width "), "{row}");
    run.says(&["* wider than asked for", "rho_1 to rho_3"]);
    let design = "orthoglide-tolerance.toml";
    let quiet = folder.run(&["bounds", design, "--relative", "0.1", "-q"]).exits(0);
    assert!(
        quiet.stdout.starts_with("  psi ") && !quiet.stdout.contains("every"),
        "{}",
        quiet.stdout
    );
    let run = folder.run(&["bounds", "--relative", "0.01"]).exits(0);
    assert!(!run.stdout.contains('*'), "{}", run.stdout);
}
