//! `verify` of many designs: exit codes, files, reports.

use crate::junit;
use crate::support::{Folder, Run, LONG};
use serde_json::Value;
use std::fs;

const PROVED: &str = "tripteron.toml";
const FALSE: &str = "orthoglide-310.toml";
const OPEN: &str = "orthoglide-tie.toml";
const BROKEN: &str = "title = 3\n";

/// A folder `designs` with one design of each verdict, one of them in a folder of its own, and a
/// file that is no design.
fn mixed() -> Folder {
    let folder = Folder::with(&[PROVED, FALSE, OPEN]);
    fs::create_dir_all(folder.path("designs/sub")).unwrap();
    for (from, to) in [(PROVED, "sub/a.toml"), (FALSE, "b.toml"), (OPEN, "c.toml")] {
        fs::rename(folder.path(from), folder.path("designs").join(to)).unwrap();
    }
    folder.write("designs/broken.toml", BROKEN);
    folder
}

fn json(run: &Run) -> Value {
    serde_json::from_str(&run.stdout).unwrap()
}

fn below(folder: &Folder, name: &str) -> Vec<String> {
    let mut waiting = vec![folder.path(name)];
    let mut found = Vec::new();
    while let Some(path) = waiting.pop() {
        match path.is_dir() {
            true => waiting.extend(fs::read_dir(path).unwrap().map(|e| e.unwrap().path())),
            false => {
                let below = path.strip_prefix(folder.path(name)).unwrap();
                found.push(below.to_str().unwrap().to_owned());
            }
        }
    }
    found.sort();
    found
}

#[test]
fn every_design_is_told_of_and_the_worst_exit_code_wins() {
    let folder = mixed();
    let run = folder.run(&["verify", "designs", "--out", "proofs"]).exits(2);
    let lines: Vec<&str> = run.stdout.lines().collect();
    for (line, (verdict, name)) in lines.iter().zip([
        ("REFUTED ", "designs/b.toml"),
        ("BAD INPUT ", "designs/broken.toml"),
        ("UNDECIDED ", "designs/c.toml"),
        ("CERTIFIED ", "designs/sub/a.toml"),
    ]) {
        assert!(line.starts_with(verdict) && line.contains(name), "{line}");
        assert!(run.stderr.lines().any(|l| l.starts_with(verdict) && l.contains(name)));
        // What is wrong names the place in the file, and not the file again.
        assert_eq!(line.matches(name).count(), 1, "{line}");
    }
    assert!(lines[1].contains("  line "), "{}", lines[1]);
    assert!(lines.last().unwrap().starts_with("4 designs: 1 certified, 1 undecided, 1 refuted, 1"));
    assert_eq!(below(&folder, "proofs"), ["b.cert.json", "sub/a.cert.json"]);
    folder.run(&["check", "proofs/sub/a.cert.json", "--design", "designs/sub/a.toml"]).exits(0);
    folder.run(&["check", "proofs/b.cert.json", "--design", "designs/b.toml"]).exits(1);
}

#[test]
fn exit_codes_in_their_order() {
    let folder = mixed();
    let (a, b, c) = ("designs/sub/a.toml", "designs/b.toml", "designs/c.toml");
    for (designs, code) in [
        (vec![a, a], 0),
        (vec![a, c], 3),
        (vec![c, b], 1),
        (vec![b, c, "designs/broken.toml"], 2),
        (vec![a, "missing.toml"], 2),
    ] {
        let arguments = [&["verify", "--jobs", "2"][..], &designs].concat();
        folder.run(&arguments).exits(code);
    }
    // A certificate that cannot be written is worse than anything else.
    fs::create_dir(folder.path("designs/c.cert.json")).unwrap();
    let run = folder.run(&["verify", "designs", "--reprove"]).exits(4).says(&["NOT FINISHED"]);
    assert!(run.stdout.contains("it is a folder"));
    assert!(run.stdout.contains("CERTIFIED"), "{}", run.stdout);
}

#[test]
fn answers_do_not_depend_on_the_jobs() {
    let timeless = |mut value: Value| {
        value["seconds"] = Value::Null;
        for design in value["designs"].as_array_mut().unwrap() {
            design["seconds"] = Value::Null;
        }
        value
    };
    let folder = mixed();
    let answer = |jobs: &str| {
        let arguments =
            ["verify", "designs", "--format", "json", "--jobs", jobs, "--reprove", "--quiet"];
        let run = folder.run(&arguments).exits(2);
        assert!(run.stderr.starts_with("BAD INPUT") && run.stderr.lines().count() == 1);
        (timeless(json(&run)), folder.read("designs/b.cert.json"))
    };
    assert_eq!(answer("1"), answer("4"));
}

#[test]
fn the_json_answer_has_requirements_with_lines() {
    let folder = mixed();
    let value = json(&folder.run(&["verify", "designs", "--format", "json"]).exits(2));
    assert_eq!(value["exit_code"], 2);
    assert_eq!(value["interrupted"], false);
    let design = |i: usize| &value["designs"][i];
    assert_eq!(design(0)["verdict"], "refuted");
    assert_eq!(design(1)["verdict"], "bad_input");
    assert_eq!(design(1)["line"], 1);
    assert_eq!(design(2)["verdict"], "undecided");
    assert_eq!(design(3)["certificate"]["path"], "designs/sub/a.cert.json");
    let standing = |i: usize| -> Vec<(String, String)> {
        let rows = design(i)["requirements"].as_array().unwrap().iter();
        let text = |row: &Value, key: &str| row[key].as_str().unwrap().to_owned();
        rows.map(|row| (text(row, "rule"), text(row, "standing"))).collect()
    };
    let pair = |rule: &str, standing: &str| (rule.to_owned(), standing.to_owned());
    assert_eq!(standing(0), [pair("singularity", "open"), pair("transmission", "fails")]);
    assert!(standing(2).iter().all(|(_, standing)| standing == "open"));
    assert!(standing(3).iter().all(|(_, standing)| standing == "holds"));
    let text = String::from_utf8(folder.read("designs/b.toml")).unwrap();
    let line = 1 + text.lines().position(|line| line.starts_with("transmission")).unwrap();
    assert_eq!(design(0)["requirements"][1]["line"], line);
}

#[test]
fn clashes_empty_folders_and_misplaced_options_are_refused_before_the_work() {
    let folder = mixed();
    fs::create_dir_all(folder.path("empty/.hidden")).unwrap();
    folder.write("empty/.hidden/a.toml", BROKEN);
    fs::copy(folder.path("designs/b.toml"), folder.path("designs/sub/b")).unwrap();
    fs::copy(folder.path("designs/b.toml"), folder.path("designs/sub/b.toml")).unwrap();
    let absolute = |name: &str| folder.path(name).to_str().unwrap().to_owned();
    for (arguments, parts) in [
        (vec!["empty"], vec!["empty", "without designs", "*.toml"]),
        (vec!["designs", "-o", "x.json"], vec!["--output", "--out FOLDER"]),
        (vec!["--out", "proofs"], vec!["no design is given"]),
        (vec!["designs/sub/b.toml", "designs/sub/b"], vec!["both have the certificate"]),
        (
            vec![&absolute("designs/b.toml"), &absolute("designs/sub/b.toml"), "--out", "proofs"],
            vec!["both have the certificate proofs/b.cert.json"],
        ),
        (vec!["designs", "--junit", "designs/b.toml"], vec!["--junit", "a path of its own"]),
        (vec!["designs", "--junit", "x", "--sarif", "./x"], vec!["--sarif", "a path of its own"]),
    ] {
        let arguments = [&["verify"][..], &arguments].concat();
        folder.run(&arguments).exits(2).complains(&parts);
    }
    for report in ["missing/j.xml", "designs"] {
        let run = folder.run(&["verify", "designs", "--junit", report]).exits(4);
        run.complains(&["cannot be written"]);
    }
    assert!(!below(&folder, "designs").iter().any(|name| name.ends_with(".cert.json")));
    assert!(!folder.path("proofs").exists());
}

#[test]
fn reports_are_valid_and_say_the_same() {
    let folder = mixed();
    let arguments = [
        &["verify", "designs", "missing.toml", "--quiet"][..],
        &["--junit", "j.xml", "--sarif", "s.sarif", "--summary", "s.md"],
    ];
    let run = folder.run(&arguments.concat()).exits(2);
    assert_eq!(run.stdout.lines().count(), 1);
    let suite = junit::read(&String::from_utf8(folder.read("j.xml")).unwrap());
    junit::valid(&suite);
    let kinds: Vec<_> = suite
        .children
        .iter()
        .map(|case| {
            let kind = ["failure", "error"].into_iter().find_map(|kind| case.child(kind));
            (case.attribute("name"), kind.map(|kind| (kind.name.as_str(), kind.attribute("type"))))
        })
        .collect();
    let expected = [
        ("b.toml", Some(("failure", "refuted"))),
        ("broken.toml", Some(("error", "bad-input"))),
        ("c.toml", Some(("error", "undecided"))),
        ("a.toml", None),
        ("missing.toml", Some(("error", "bad-input"))),
    ];
    assert_eq!(kinds, expected);
    let log: Value = serde_json::from_slice(&folder.read("s.sarif")).unwrap();
    sarif_is_valid(&log);
    let results = log["runs"][0]["results"].as_array().unwrap();
    let of = |rule: &str, kind: &str| -> Vec<&str> {
        let found = results.iter().filter(|r| r["ruleId"] == rule && r["kind"] == kind);
        found.map(|r| place(r)["artifactLocation"]["uri"].as_str().unwrap()).collect()
    };
    assert_eq!(of("transmission", "fail"), ["designs/b.toml"]);
    assert_eq!(of("transmission", "open"), ["designs/c.toml"]);
    assert_eq!(of("singularity", "pass"), ["designs/sub/a.toml"]);
    assert_eq!(of("bad-input", "fail"), ["designs/broken.toml", "missing.toml"]);
    let markdown = String::from_utf8(folder.read("s.md")).unwrap();
    assert!(markdown.contains("| `designs/b.toml` | **refuted** |"), "{markdown}");
}

fn place(result: &Value) -> &Value {
    &result["locations"][0]["physicalLocation"]
}

/// Holds the published schema, and what the specification says beyond it.
fn sarif_is_valid(log: &Value) {
    let schema = include_str!("../schema/sarif-2.1.0.json");
    // One of its patterns has a bracket that not every dialect takes literally.
    let schema = schema.replace("{2}]?$", r"{2}\\]?$");
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator = jsonschema::draft4::new(&schema).unwrap();
    let objections: Vec<String> =
        validator.iter_errors(log).map(|e| format!("{}: {e}", e.instance_path())).collect();
    assert!(objections.is_empty(), "{objections:?}");
    let mut broken = log.clone();
    broken["runs"][0]["results"][0]["kind"] = "passed".into();
    assert!(validator.iter_errors(&broken).next().is_some(), "the schema refuses nothing");
    let run = &log["runs"][0];
    for result in run["results"].as_array().unwrap() {
        let index = usize::try_from(result["ruleIndex"].as_u64().unwrap()).unwrap();
        assert_eq!(run["tool"]["driver"]["rules"][index]["id"], result["ruleId"]);
        assert_eq!(result["kind"] == "fail", result["level"] != "none");
    }
}

#[test]
fn hostile_titles_and_names_break_no_report() {
    let folder = Folder::with(&[FALSE]);
    let design = String::from_utf8(folder.read(FALSE)).unwrap();
    let (_, rest) = design.split_once("[mechanism]").unwrap();
    let title = r#"title = "</system-out> & <b>\u0001\u001b[31m|` ]]> \uffff %0A::error::""#;
    let name = "a & <b> %|`:,\u{1b}\u{e4}.toml";
    folder.write(name, format!("{title}\n[mechanism]{rest}"));
    let arguments = [
        &["verify", name, FALSE, "--jobs", "1"][..],
        &["--junit", "j.xml", "--sarif", "s.sarif", "--summary", "s.md"],
    ];
    let mut command = folder.command(&arguments.concat());
    command.env("GITHUB_ACTIONS", "true").env_remove("GITHUB_STEP_SUMMARY");
    let run = Run::from(command.output().unwrap()).exits(1);
    for text in [&run.stdout, &run.stderr] {
        assert!(!text.contains('\u{1b}') && !text.contains('\u{1}'));
    }
    assert_eq!(run.stderr.lines().filter(|line| line.starts_with("::error ")).count(), 2);
    let suite = junit::read(&String::from_utf8(folder.read("j.xml")).unwrap());
    junit::valid(&suite);
    let told = &suite.children[0].child("system-out").unwrap().text;
    assert!(told.contains("</system-out> & <b>\\u{1}\\u{1b}[31m|` ]]>"), "{told}");
    sarif_is_valid(&serde_json::from_slice(&folder.read("s.sarif")).unwrap());
    let markdown = String::from_utf8(folder.read("s.md")).unwrap();
    let row = markdown.lines().find(|line| line.starts_with("| ``a ")).unwrap();
    assert_eq!(row.replace("\\|", "").matches('|').count(), 6, "{row}");
}

#[test]
fn annotations_and_the_step_summary_where_github_runs_it() {
    let folder = mixed();
    let mut command = folder.command(&["verify", "designs", "--format", "json"]);
    command.env("GITHUB_ACTIONS", "true").env("GITHUB_STEP_SUMMARY", folder.path("step.md"));
    command.env("GITHUB_WORKSPACE", folder.path("designs"));
    folder.write("step.md", "earlier\n");
    let run = Run::from(command.output().unwrap()).exits(2);
    json(&run);
    let line = |start: &str| run.stderr.lines().any(|line| line.starts_with(start));
    assert!(line("::error file=b.toml,line="), "{}", run.stderr);
    assert!(line("::error file=broken.toml,line=1,title=orthocert%3A bad input::"));
    assert!(line("::warning file=c.toml,line="));
    assert!(!run.stderr.contains("file=sub/a.toml"));
    let step = String::from_utf8(folder.read("step.md")).unwrap();
    assert!(step.starts_with("earlier\n") && step.contains("**refuted**"));
    let quiet = folder.run(&["verify", "designs"]).exits(2);
    assert!(!quiet.stderr.contains("::"));
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_batch_writes_what_it_knows() {
    use std::process::{Command, Stdio};
    let folder = Folder::with(&[LONG, PROVED, FALSE]);
    fs::rename(folder.path(PROVED), folder.path("a.toml")).unwrap();
    fs::rename(folder.path(FALSE), folder.path("z.toml")).unwrap();
    let arguments = [
        &["verify", "a.toml", LONG, "z.toml", "--jobs", "1", "--threads", "1"][..],
        &["--max-boxes", "2000000", "--junit", "j.xml", "--format", "json"],
    ];
    let mut command = folder.command(&arguments.concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !folder.path("a.cert.json").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    std::thread::sleep(std::time::Duration::from_millis(50));
    let kill = format!("kill -2 {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let run = Run::from(child.wait_with_output().unwrap()).exits(4);
    assert!(run.stderr.contains("interrupted"));
    let value = json(&run);
    assert_eq!(value["interrupted"], true);
    let verdicts: Vec<_> =
        value["designs"].as_array().unwrap().iter().map(|d| d["verdict"].clone()).collect();
    assert_eq!(verdicts, ["certified", "not_finished", "not_run"]);
    let suite = junit::read(&String::from_utf8(folder.read("j.xml")).unwrap());
    junit::valid(&suite);
    assert!(suite.children[2].child("skipped").is_some());
    assert_eq!(folder.names(), ["a.cert.json", "a.toml", "j.xml", LONG, "z.toml"]);
}
