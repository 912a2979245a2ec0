//! What a designer trips over: what is left out is said, and refusals name file, line and key.

use crate::support::{number, Folder, Run};
use serde_json::Value;
use std::collections::BTreeSet;
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
    run.says(&["; or smaller bounds: within them there is to be no second pose"]);
}

/// Both parts of an accuracy are enclosed however much room the design leaves in either, each with the bound on the other
/// that is told.
#[test]
fn an_accuracy_with_much_room_is_enclosed() {
    let folder = Folder::new();
    let leg = |anchor: &str, platform: &str| {
        format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = {anchor}\nplatform = {platform}\n")
    };
    let legs = [
        leg("[\"0 ± 0.05\", \"400 ± 0.05\"]", "[\"50*sqrt(3)\", 50]"),
        leg("[\"-200*sqrt(3)\", -200]", "[\"-50*sqrt(3)\", 50]"),
        leg("[\"200*sqrt(3)\", -200]", "[0, -100]"),
    ];
    let design = format!(
        "[mechanism]\nkind = \"planar\"\ncharacteristic_length = 100\n{}[workspace]\nmin = [-50, -50]\n\
         max = [50, 50]\norientation = {{ angle = [-20, 20] }}\n[requirements]\n\
         accuracy = {{ joint_error = 0.05, max = 5, max_angle = 3 }}\n",
        legs.concat()
    );
    folder.write("d.toml", &design);
    let json = folder.run(&["bounds", "d.toml", "--relative", "1e-2", "--format", "json"]).exits(0);
    let answer: Value = serde_json::from_str(&json.stdout).unwrap();
    let row = |unit: &str| {
        let rows = answer["bounds"].as_array().unwrap().iter();
        let mut rows = rows.filter(|row| row["quantity"].as_str().unwrap().starts_with("accuracy"));
        rows.find(|row| (row["unit"] == "deg") == (unit == "deg")).unwrap().clone()
    };
    // By Newton's method from the corners of errors and tolerances: 0.1220, and 0.0563 degrees.
    for (unit, value) in [("", 0.1220), ("deg", 0.0563)] {
        let row = row(unit);
        let [min, max] = ["min", "max"].map(|end| number(&row[end]));
        assert!(min < 1.001 * value && 0.999 * value < max && max < 1.02 * min, "{row}");
    }
    let given = number(&row("")["given"]["max_angle"][0]);
    assert!((0.0563..0.1).contains(&given), "{given}");
    let given = number(&row("deg")["given"]["max"][0]);
    assert!((0.122..0.2).contains(&given), "{given}");
    let told = folder.run(&["bounds", "d.toml", "--relative", "1e-2"]).exits(0);
    told.says(&[
        "With a tighter bound on the other part than the design has: accuracy is for",
        "joint_error 0.05, max_angle 0.08",
    ]);
    folder.write("d.toml", design.replace("max = 5", "max = 0.2"));
    // What is shown within a smaller angle is not said of a design that is not certified.
    let json = folder.run(&["summary", "d.toml", "--max-boxes", "50", "--format", "json"]).exits(3);
    let answer: Value = serde_json::from_str(&json.stdout).unwrap();
    let off = answer["values"].as_array().unwrap().iter().find(|row| row["quantity"] == "accuracy");
    assert!(off.unwrap().get("certified").is_none(), "{answer}");
    let run = folder.run(&["verify", "d.toml", "--max-boxes", "50"]).exits(3);
    run.says(&["; or smaller bounds: within them there is to be no second pose"]);
}

/// A linear Delta as importers write it: an irrational coordinate lies between two decimals, which are one double.
const NARROW: &str = r#"
[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [{ min = "-113.6228544598511515088", max = "-113.6228544598511513772" }, -66.4, 0]
length = 270.5
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [113.74, -66.2, 0]
length = 270.4
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [0, 131.6, 0]
length = 270.5
mode = "-"
[workspace]
cylinder = { center = [0, 0], radius = "129.9", z = [0, 100] }
[requirements]
transmission = { min = "1/4", max = 4 }
"#;

#[test]
fn a_value_of_a_machine_within_one_double_is_told() {
    let folder = Folder::new();
    folder.write("d.toml", NARROW);
    let run = folder.run(&["verify", "d.toml"]).exits(1).says(&["least psi <= 0.249"]);
    assert!(!run.stdout.contains("no bound"), "{}", run.stdout);
}

#[test]
fn a_paving_of_a_box_of_a_cylinder_says_how_it_is_checked() {
    let folder = Folder::new();
    folder.write("d.toml", NARROW);
    let region = "-60,60,-60,60,0,100";
    folder.run(&["pave", "d.toml", "--box", region, "--volume-gap", "0.5", "-o", "p"]).exits(0);
    let hint = "--box gives the box that was searched";
    folder.run(&["check", "p", "--design", "d.toml"]).exits(5).complains(&[hint]);
    folder.run(&["check", "p", "--design", "d.toml", "--box", region]).exits(0);
}

#[test]
fn a_joint_force_is_not_said_to_be_of_another_tool_force() {
    let folder = Folder::new();
    let of_one = "joint force is that of a tool force of 1";
    let bounds = ["bounds", "d.toml", "--relative", "0.1"];
    let design = include_str!("../designs/rotary-delta-linuxcnc.toml");
    folder.write("d.toml", design);
    folder.run(&bounds).exits(0).says(&[of_one]);
    let with = "[requirements]\njoint_force = { tool = 50, max = 50000 }";
    folder.write("d.toml", design.replace("[requirements]", with));
    let own = folder.run(&bounds).exits(0).says(&["joint force"]);
    assert!(!own.stdout.contains(of_one), "{}", own.stdout);
}

/// One box of a design with tests of one requirement that have the same words, as those of a joint's two sides.
#[test]
fn what_is_open_is_told_once() {
    let folder = Folder::new();
    folder.write("d.toml", include_str!("../designs/kernel/hexapod-joints.toml"));
    let run = folder.run(&["verify", "d.toml", "--max-boxes", "1", "--format", "json"]).exits(3);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    let open = answer["undecided"]["open"].as_array().unwrap();
    let told: BTreeSet<String> = open.iter().map(|one| one["requirement"].to_string()).collect();
    assert!(told.iter().any(|words| words.contains("base joint")), "{told:?}");
    assert_eq!(told.len(), open.len(), "{open:?}");
    let text = folder.run(&["verify", "d.toml", "--max-boxes", "1"]).exits(3);
    let text = text.says(&["in 1 region: 100 % of the box around the workspace"]);
    assert!(!text.stdout.contains("volume"), "{}", text.stdout);
}

/// Boxes of a cylinder are parts of the box around it, of which it is less.
#[test]
fn what_is_open_is_a_share_of_the_cylinder() {
    let folder = Folder::new();
    let design = r#"
        [mechanism]
        kind = "orthoglide"
        leg_length = 310
        base = 0
        [workspace.cylinder]
        center = [0, 0]
        radius = 50
        z = [0, 100]
        [requirements]
        transmission = { max = 1.351 }
    "#;
    folder.write("c.toml", design);
    let run = folder.run(&["verify", "c.toml", "--max-boxes", "1", "--format", "json"]).exits(3);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    let (open, whole) = (&answer["undecided"], std::f64::consts::PI * 2500.0 * 100.0);
    assert_eq!(open["share"], 1.0);
    assert!((open["volume"].as_f64().unwrap() / whole - 1.0).abs() < 1e-9, "{open}");
}

/// Of a strut's speed the test is of a polynomial, of which the value at a place tells nothing.
#[test]
fn room_in_a_joint_speed_is_no_tie() {
    let folder = Folder::new();
    let design = include_str!("../designs/kernel/hexapod-mssm.toml");
    let with = "[requirements]\njoint_speed = { tool = 1, max = 1.8 }";
    folder.write("d.toml", design.replace("[requirements]", with));
    let run = folder.run(&["verify", "d.toml", "--timeout", "0.001", "--format", "json"]).exits(3);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    let open = answer["undecided"]["open"].as_array().unwrap();
    let of_speeds = open.iter().filter(|one| one["obligation"] == "joint_speed");
    let help: Vec<&str> = of_speeds.map(|one| one["help"].as_str().unwrap()).collect();
    assert!(help.len() == 6 && help.iter().all(|help| help.contains("budget")), "{help:?}");
    let margin = answer["undecided"]["worst_box"]["margin"].as_f64().unwrap();
    assert!(margin > 0.1, "{margin}");
}
