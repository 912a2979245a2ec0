//! What is offered to continuous integration runs as it is written: the shell steps of `action.yml`,
//! the entries of `.pre-commit-hooks.yaml`, and the guide's GitLab job and signing commands.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const BINARY: &str = env!("CARGO_BIN_EXE_orthocert");

fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// A folder with `designs/proved.toml`, and `designs/false.toml` if wanted.
fn project(refuted: bool) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("designs")).unwrap();
    let copy = |from: &str, to: &str| {
        fs::copy(source("tests/designs").join(from), folder.path().join(to)).unwrap();
    };
    copy("tripteron.toml", "designs/proved.toml");
    if refuted {
        copy("orthoglide-310.toml", "designs/false.toml");
    }
    folder
}

/// A command in `folder` that finds only `tools` before what every machine has.
fn bash(folder: &Path, script: &str, tools: Option<&Path>) -> Command {
    let mut command = Command::new("bash");
    command.args(["-e", "-c", script]).current_dir(folder).env_remove("GITHUB_STEP_SUMMARY");
    if let Some(tools) = tools {
        let path = std::env::var("PATH").unwrap_or_default();
        command.env("PATH", format!("{}:{path}", tools.display()));
    }
    command
}

/// A folder with programs of these scripts.
fn tools(scripts: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, script) in scripts {
        let path = folder.path().join(name);
        fs::write(&path, format!("#!/bin/sh\nset -e\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

fn exits(output: &Output, code: i32) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(code), "{out}\n{err}");
}

/// A step of the action: its environment and its script, with expressions as they are written.
#[derive(Default)]
struct Step {
    environment: Vec<(String, String)>,
    script: String,
}

/// The steps of `action.yml`, as far as the YAML in it goes.
fn steps() -> Vec<Step> {
    let text = fs::read_to_string(source("action.yml")).unwrap();
    let (_, runs) = text.split_once("\n  steps:\n").unwrap();
    let mut steps: Vec<Step> = Vec::new();
    let mut within = "";
    for line in runs.lines() {
        let indent = line.len() - line.trim_start().len();
        match (indent, line.trim()) {
            (4, _) => {
                steps.push(Step::default());
                within = "";
            }
            (6, "env:") => within = "env",
            (6, "run: |") => within = "run",
            (6, _) => within = "",
            (8, entry) if within == "env" => {
                let (name, value) = entry.split_once(": ").unwrap();
                steps.last_mut().unwrap().environment.push((name.into(), value.into()));
            }
            _ if within == "run" => {
                let step = steps.last_mut().unwrap();
                step.script += line.get(8..).unwrap_or_default();
                step.script.push('\n');
            }
            _ => panic!("not understood: {line}"),
        }
    }
    steps
}

/// The defaults of the action's inputs.
fn defaults() -> BTreeMap<String, String> {
    let text = fs::read_to_string(source("action.yml")).unwrap();
    let (inputs, _) = text.split_once("\noutputs:\n").unwrap();
    let mut known = BTreeMap::new();
    let mut input = "";
    for line in inputs.lines() {
        if let Some(name) = line.strip_prefix("  ").and_then(|line| line.strip_suffix(':')) {
            input = name;
        }
        if let Some(value) = line.trim().strip_prefix("default: ") {
            known.insert(format!("inputs.{input}"), value.trim_matches('"').to_owned());
        }
    }
    known
}

/// Runs the action in `folder` as the runner does; returns the last step's end and the outputs.
fn action(folder: &Path, inputs: &[(&str, &str)], tools: &Path) -> (Output, String) {
    let temp = tempfile::tempdir().unwrap();
    let mut known = defaults();
    let mut set = |name: &str, value: &str| known.insert(name.to_owned(), value.to_owned());
    set("github.action_path", env!("CARGO_MANIFEST_DIR"));
    set("runner.temp", temp.path().to_str().unwrap());
    for (name, value) in inputs {
        set(&format!("inputs.{name}"), value);
    }
    let outputs = temp.path().join("outputs");
    fs::write(&outputs, "").unwrap();
    let mut last = None;
    for step in steps() {
        let mut command = bash(folder, &step.script, Some(tools));
        for (name, value) in &step.environment {
            command.env(name, resolved(value, &known));
        }
        command.env("GITHUB_OUTPUT", &outputs).env("GITHUB_ACTIONS", "true");
        command.env("GITHUB_WORKSPACE", folder).env("GITHUB_STEP_SUMMARY", temp.path().join("md"));
        let output = command.output().unwrap();
        let failed = !output.status.success();
        last = Some(output);
        if failed {
            break;
        }
        let written = fs::read_to_string(&outputs).unwrap();
        for (name, value) in written.lines().filter_map(|line| line.split_once('=')) {
            known.insert(format!("steps.build.outputs.{name}"), value.to_owned());
        }
    }
    (last.unwrap(), fs::read_to_string(&outputs).unwrap())
}

/// `value` with its expressions replaced.
fn resolved(value: &str, known: &BTreeMap<String, String>) -> String {
    let Some((before, rest)) = value.split_once("${{ ") else {
        return value.to_owned();
    };
    let (name, after) = rest.split_once(" }}").unwrap();
    let found = known.get(name).unwrap_or_else(|| panic!("{name} is unknown"));
    format!("{before}{found}{}", resolved(after, known))
}

#[test]
fn the_action_builds_proves_and_reports() {
    let project = project(false);
    let (folder, seen) = (project.path(), project.path().join("cargo-was-called"));
    // Stands in for the build, and holds what it is asked for and where.
    let cargo = tools(&[(
        "cargo",
        &format!(
            "test \"$*\" = 'build --release --locked --bin orthocert'\ntest -f action.yml\n\
             mkdir -p \"$CARGO_TARGET_DIR/release\"\n\
             ln -s {BINARY} \"$CARGO_TARGET_DIR/release/orthocert\"\ntouch {}",
            seen.display()
        ),
    )]);
    let (output, outputs) = action(folder, &[("designs", "designs")], cargo.path());
    exits(&output, 0);
    assert!(seen.exists());
    assert!(outputs.contains("exit-code=0\njunit=orthocert-reports/junit.xml\n"), "{outputs}");
    for name in ["junit.xml", "orthocert.sarif", "summary.md"] {
        assert!(folder.join("orthocert-reports").join(name).is_file(), "{name}");
    }
    assert!(folder.join("designs/proved.cert.json").is_file());
}

#[test]
fn the_action_fails_with_the_exit_code_and_annotates() {
    let project = project(true);
    let inputs = [
        ("designs", "designs/proved.toml\n\ndesigns/false.toml\n"),
        ("out", "my proofs"),
        ("arguments", "--max-boxes\n1000\n"),
        ("binary", BINARY),
    ];
    let none = tools(&[("cargo", "exit 1")]);
    let (output, outputs) = action(project.path(), &inputs, none.path());
    exits(&output, 1);
    assert!(outputs.contains("exit-code=1\n"), "{outputs}");
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("::error file=designs/false.toml,line="), "{told}");
    assert!(project.path().join("my proofs/designs/proved.cert.json").is_file());
}

#[test]
fn inputs_of_the_action_are_not_taken_for_commands() {
    let project = project(false);
    let inputs = [("designs", "$(touch evil)\n`touch evil`; touch evil"), ("binary", BINARY)];
    let (output, _) = action(project.path(), &inputs, project.path());
    exits(&output, 2);
    assert!(!project.path().join("evil").exists());
}

#[test]
fn pre_commit_entries_run() {
    let text = fs::read_to_string(source(".pre-commit-hooks.yaml")).unwrap();
    let entries: Vec<&str> =
        text.lines().filter_map(|line| line.trim().strip_prefix("entry: ")).collect();
    let [verify, check] = entries[..] else { panic!("{entries:?}") };
    let programs = Path::new(BINARY).parent().unwrap();
    for (refuted, code) in [(false, 0), (true, 1)] {
        let project = project(refuted);
        let files =
            if refuted { "designs/false.toml designs/proved.toml" } else { "designs/proved.toml" };
        let run = |script: &str| bash(project.path(), script, Some(programs)).output().unwrap();
        exits(&run(&format!("{verify} {files}")), code);
        exits(&run(check), code);
    }
}

/// The lines of the guide's fenced block that has `mark` in it.
fn block(mark: &str) -> String {
    let text = fs::read_to_string(source("GUIDE.md")).unwrap();
    let mut blocks = text.split("```").skip(1).step_by(2);
    let block = blocks.find(|block| block.contains(mark)).unwrap_or_else(|| panic!("no {mark}"));
    block.split_once('\n').unwrap().1.to_owned()
}

#[test]
fn the_stories_of_the_guide_run() {
    let text = fs::read_to_string(source("GUIDE.md")).unwrap();
    let stories = text.split("\n## ").find(|part| part.starts_with("Five stories")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(source("tests"), folder.path().join("tests")).unwrap();
    let programs = Path::new(BINARY).parent().unwrap();
    let blocks: Vec<&str> = stories.split("```").skip(1).step_by(2).collect();
    assert_eq!(blocks.len(), 5);
    for line in blocks.iter().flat_map(|block| block.lines().skip(1)) {
        let output = bash(folder.path(), line, Some(programs)).output().unwrap();
        exits(&output, i32::from(line.ends_with("# refuted")));
    }
    // The guide's figures are those that the commands write.
    for (figure, written) in [
        ("printer", "printer/design"),
        ("stroke", "printer/critical-1"),
        ("mill", "whole/design"),
        ("factor", "whole/psi-3"),
    ] {
        let kept = fs::read(source(&format!(".github/guide/{figure}.svg"))).unwrap();
        let made = fs::read(folder.path().join(format!("{written}.svg"))).unwrap();
        assert!(kept == made, "{figure}.svg is not {written}.svg");
    }
}

#[test]
fn the_gitlab_job_of_the_guide_runs() {
    let job = block("stage: test");
    let lines = job.lines().filter_map(|line| line.strip_prefix("    - "));
    let script: Vec<&str> = lines.take_while(|line| !line.contains(": ")).collect();
    assert_eq!(script.len(), 3, "{job}");
    // The clone and the build are stood in for.
    let stand_ins = tools(&[
        ("git", "test \"$1\" = clone\nfor last in \"$@\"; do :; done\nmkdir -p \"$last\""),
        (
            "cargo",
            &format!(
                "test \"$*\" = 'build --release --locked'\nmkdir -p target/release\n\
                 ln -sf {BINARY} target/release/orthocert"
            ),
        ),
    ]);
    for (refuted, code) in [(false, 0), (true, 1)] {
        let project = project(refuted);
        let script = script.join("\n");
        let output = bash(project.path(), &script, Some(stand_ins.path())).output().unwrap();
        exits(&output, code);
        for file in ["junit.xml", "proofs/proved.cert.json"] {
            assert!(project.path().join(file).is_file(), "{file}");
        }
    }
}

#[test]
fn the_signing_commands_of_the_guide_run() {
    if Command::new("ssh-keygen").arg("-?").output().is_err() {
        println!("ssh-keygen is not installed: the commands are not run");
        return;
    }
    let project = project(false);
    let folder = project.path();
    fs::rename(folder.join("designs/proved.toml"), folder.join("machine.toml")).unwrap();
    let programs = Path::new(BINARY).parent().unwrap();
    let run = |script: &str| bash(folder, script, Some(programs)).output().unwrap();
    exits(&run("orthocert verify machine.toml"), 0);
    exits(&run("ssh-keygen -q -t ed25519 -N '' -f key"), 0);
    let commands = block("ssh-keygen -Y sign");
    exits(&run(&commands), 0);
    let verify = commands.lines().skip_while(|line| !line.contains("-Y verify"));
    let verify: Vec<&str> = verify.collect();
    exits(&run(&verify.join("\n")), 0);
    // A statement that was changed is not the one that was signed.
    let statement = fs::read_to_string(folder.join("machine.intoto.json")).unwrap();
    assert!(statement.contains("PASSED"));
    fs::write(folder.join("machine.intoto.json"), statement.replace("PASSED", "FAILED")).unwrap();
    assert_ne!(run(&verify.join("\n")).status.code(), Some(0));
    // Neither is a file that the statement does not name.
    fs::write(folder.join("machine.intoto.json"), statement).unwrap();
    let design = fs::read_to_string(folder.join("machine.toml")).unwrap();
    fs::write(folder.join("machine.toml"), design + "\n").unwrap();
    assert_ne!(run(&verify.join("\n")).status.code(), Some(0));
}
