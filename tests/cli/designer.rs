//! What a designer trips over: what is left out is said, and refusals name file, line and key.

use crate::support::{Folder, Run};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

/// Three struts, one with a rod that nothing is asked of.
const RODS: &str = r#"
[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "strut"
anchor = [2, 0, 0]
rod = { radius = 0.1, trim = [0.2, 0] }
[[mechanism.legs]]
drive = "strut"
anchor = [0, 2, 0]
rod = { radius = 0.1, trim = [0.2, 0] }
[[mechanism.legs]]
drive = "strut"
anchor = [0, 0, 2]
[workspace]
min = [5, 5, 5]
max = [6, 6, 6]
[requirements]
conditioning = { max = 30 }
"#;
const NOTE: &str = "mechanism.legs.0.rod, line 7: nothing is claimed of rods and bodies";

#[test]
fn rods_that_no_requirement_is_about_are_noted() {
    let folder = Folder::new();
    folder.write("d.toml", RODS);
    let run = folder.run(&["verify", "d.toml"]).exits(0).says(&["note", NOTE]);
    assert_eq!(run.stderr, "");
    let quiet = folder.run(&["verify", "d.toml", "-q"]).exits(0);
    assert!(quiet.stderr.is_empty() && !quiet.stdout.contains("rod"), "{}", quiet.stdout);
    let json = folder.run(&["verify", "d.toml", "--format", "json"]).exits(0);
    let answer: Value = serde_json::from_str(&json.stdout).unwrap();
    assert!(answer["notes"][0].as_str().unwrap().starts_with(NOTE), "{answer}");
    folder
        .run(&["verify", "d.toml", "d.toml", "--out", "."])
        .exits(0)
        .says(&["re-checked; ", NOTE]);
    for command in [&["summary", "d.toml"][..], &["check", "d.cert.json", "--design", "d.toml"]] {
        let run = folder.run(command).exits(0);
        assert_eq!(run.stderr.matches(NOTE).count(), 1, "{}", run.stderr);
        assert!(run.stderr.starts_with("orthocert: d.toml: mechanism"), "{}", run.stderr);
        let quiet = folder.run(&[command, &["-q"]].concat()).exits(0);
        assert_eq!(quiet.stderr, "");
    }
    folder
        .write("d.toml", RODS.replace("conditioning = { max = 30 }", "clearance = { min = 0.1 }"));
    let run = folder.run(&["verify", "d.toml"]);
    assert!(!run.stdout.contains("note") && run.stderr.is_empty(), "{}", run.stdout);
}

#[test]
fn questions_that_do_not_fit_a_design_name_its_line() {
    let folder = Folder::with(&[
        "linear-delta-klipper-cylinder.toml",
        "orthoglide-prototype.toml",
        "linear-delta-klipper-box.toml",
    ]);
    let five_bar = "[mechanism]\nkind = \"planar\"\n\
        [[mechanism.legs]]\ndrive = \"strut\"\nanchor = [-9, 0]\n\
        [[mechanism.legs]]\ndrive = \"strut\"\nanchor = [9, 0]\n\
        [workspace]\nmin = [-2, 5]\nmax = [2, 6]\n[requirements]\none_to_one = true\n";
    folder.write("plane.toml", five_bar);
    let cylinder = "linear-delta-klipper-cylinder.toml";
    for (arguments, file, key, found) in [
        (&["pave", cylinder][..], cylinder, "workspace.cylinder", "found a cylinder"),
        (
            &["pave", "orthoglide-prototype.toml"],
            "orthoglide-prototype.toml",
            "workspace.cube",
            "found a cube",
        ),
        (&["pave", "plane.toml"], "plane.toml", "requirements.one_to_one", "two points at a time"),
        (&["largest-cube", cylinder], cylinder, "workspace.cylinder", "found a cylinder"),
        (&["largest-cube", "plane.toml"], "plane.toml", "workspace.min", "other coordinates"),
        (
            &["size", "plane.toml", "--cube", "1"],
            "plane.toml",
            "mechanism.kind",
            "not moved in space",
        ),
        (
            &["size", "linear-delta-klipper-box.toml", "--cube", "1"],
            "linear-delta-klipper-box.toml",
            "requirements.joint_range",
            "does not scale",
        ),
        (
            &["tolerance", "orthoglide-prototype.toml"],
            "orthoglide-prototype.toml",
            "workspace.cube",
            "no room for tolerances",
        ),
    ] {
        let run = folder.run(arguments).exits(2);
        let Run { stderr, .. } = &run;
        let text = String::from_utf8(folder.read(file)).unwrap();
        let name = key.rsplit('.').next().unwrap();
        let line = 1 + text.lines().position(|line| line.starts_with(name)).unwrap();
        assert!(
            stderr.starts_with(&format!("orthocert: {file}:{line}:1: {key}: found ")),
            "{stderr}"
        );
        run.complains(&[found, "; accepted: of ", &format!("  {line} | {name}")]);
    }
}

#[test]
fn a_design_is_read_from_standard_input() {
    let folder = Folder::new();
    let run = |arguments: &[&str], text: &str| -> Run {
        let mut command = folder.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        child.wait_with_output().unwrap().into()
    };
    run(&["verify", "-"], RODS).exits(0).says(&["CERTIFIED", "stdin.cert.json"]);
    assert_eq!(folder.names(), ["stdin.cert.json"]);
    run(&["check", "stdin.cert.json", "--design", "-"], RODS).exits(0).says(&["ACCEPTED"]);
    let wrong = run(&["verify", "-"], &RODS.replace("max = 30", "mx = 30")).exits(2);
    wrong.complains(&["-:19:", "requirements.conditioning.mx"]);
}

#[test]
fn numbers_of_options_carry_no_unit() {
    let folder = Folder::new();
    folder.write("d.toml", RODS);
    let run = folder.run(&["summary", "d.toml", "--speed", "100 mm/s"]).exits(2);
    run.complains(&["--speed: found \"100 mm/s\"", "numbers carry no unit"]);
}

#[test]
fn a_file_in_the_place_of_a_command_is_told_which() {
    let folder = Folder::new();
    for (file, command) in [("a.toml", "verify"), ("a.cert.json", "check"), ("a.paving", "check")] {
        folder.run(&[file]).exits(2).complains(&[&format!("orthocert {command} {file}")]);
    }
    let run = folder.run(&["prove"]).exits(2);
    assert!(!run.stderr.contains("comes first"), "{}", run.stderr);
}

#[test]
fn a_leg_that_does_not_reach_is_named() {
    let folder = Folder::with(&["delta-out-of-reach.toml"]);
    let run = folder.run(&["verify", "delta-out-of-reach.toml"]).exits(1);
    run.says(&["leg 3 cannot reach P, or is serially singular there"]);
}

#[test]
fn a_folder_to_check_lacks_certificates() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("empty")).unwrap();
    let run = folder.run(&["check", "empty"]).exits(2);
    run.complains(&["a folder without certificates", "*.cert.json"]);
    folder.run(&["verify", "empty"]).exits(2).complains(&["a folder without designs"]);
}

#[test]
fn a_report_names_what_is_drawn_and_left_out() {
    let folder = Folder::new();
    folder.write("d.toml", RODS);
    folder.run(&["verify", "d.toml"]).exits(0);
    folder.run(&["report", "d.cert.json"]).exits(0);
    let page = String::from_utf8(folder.read("d.report.html")).unwrap();
    assert!(page.contains(&format!("<dt>note</dt><dd>{NOTE}")));
}

#[test]
fn an_accuracy_with_too_much_room_says_so() {
    let folder = Folder::new();
    let text = include_str!("../designs/kernel/hexapod-accuracy.toml");
    folder.write("d.toml", text.replace("max = 0.01, max_angle = 0.05", "max = 5, max_angle = 1"));
    let run = folder.run(&["verify", "d.toml", "--max-boxes", "5"]).exits(3);
    run.says(&["what would help: smaller bounds: within them there is to be no second pose"]);
}
