//! `size`: both ends against the closed form, scales, and what is refused.

use crate::support::{number, Folder};
use orthocert::exact::Exact;
use serde_json::Value;

fn sized(folder: &Folder, arguments: &[&str]) -> Value {
    let all = [&["size"], arguments, &["--format", "json"]].concat();
    serde_json::from_str(&folder.run(&all).exits(0).stdout).unwrap()
}

#[test]
fn the_leg_length_of_the_paper_s_cube_is_enclosed() {
    let closed_form = 200.0 / (1.0 / 18f64.sqrt() + 1.0 / 6f64.sqrt());
    assert!((closed_form - 310.582854123025).abs() < 1e-9);
    let folder = Folder::with(&["orthoglide-312.toml"]);
    for (design, gaps) in [(&[][..], [1e-3, 1e-6]), (&["orthoglide-312.toml"], [1e-2, 1e-3])] {
        for gap in gaps {
            let gap_text = gap.to_string();
            let arguments = [design, &["--cube", "200", "--gap", &gap_text, "-o", "."]].concat();
            let value = sized(&folder, &arguments);
            let (low, high) = (number(&value["refuted"]), number(&value["certified"]));
            assert!(low < closed_form && closed_form < high, "{low} {high}");
            assert!(high / low - 1.0 <= gap * 1.000_001, "{low} {high}");
            assert_eq!(value["unknown"], "leg_length");
            assert_eq!(value["refuted_for"], "every axis-aligned placement");
            assert_eq!(value["excluded"], value["refuted"]);
            assert_eq!(value["gap_reached"], true);
            // The centre of the largest cube for legs of length 1.
            let centre = number(&value["centre_for_size_one"][0]);
            assert!((centre - 0.086_273_0).abs() < gap, "{centre}");
        }
    }
    folder.run(&["check", "size-certified.cert.json"]).exits(0).says(&["It is proved"]);
    folder.run(&["check", "size-refuted.cert.json"]).exits(1);
    let excluded = folder.run(&["check", "size-excluded.cert.json"]).exits(0);
    excluded.says(&["No axis-aligned cube of side 200"]);
    let certificate: Value =
        serde_json::from_slice(&folder.read("size-excluded.cert.json")).unwrap();
    // The box of the centres is that of the lemma: plus or minus the leg length.
    let machine = &certificate["claim"]["no_cube"]["machine"];
    let length = number(&machine["mechanism"]["translational"][0]["length"]);
    for k in 0..3 {
        assert_eq!(number(&machine["workspace"]["box"]["min"][k]), -length);
        assert_eq!(number(&machine["workspace"]["box"]["max"][k]), length);
    }
    assert!(length < closed_form);
}

#[test]
fn the_centre_shown_is_the_one_that_is_certified() {
    let folder = Folder::new();
    let run = folder.run(&["size", "--cube", "200", "--gap", "1e-4", "-o", "."]).exits(0);
    let certificate: Value =
        serde_json::from_slice(&folder.read("size-certified.cert.json")).unwrap();
    let workspace = &certificate["claim"]["machine"]["workspace"]["box"];
    let exact = |x: &Value| Exact::parse(x.as_str().unwrap(), 1000).unwrap();
    let (_, centre) = run.stdout.split_once("\n  centre ").unwrap();
    let centre = centre.trim_start().strip_prefix('(').unwrap().split_once(')').unwrap().0;
    for (k, (axis, shown)) in ["x", "y", "z"].iter().zip(centre.split(',')).enumerate() {
        let shown = Exact::parse(shown.trim(), 1000).unwrap();
        let sum = exact(&workspace["min"][k]).plus(exact(&workspace["max"][k])).unwrap();
        assert_eq!(shown.times(Exact::parse("2", 1000).unwrap()).unwrap(), sum, "{axis}");
    }
}

#[test]
fn what_is_not_proved_of_every_placement_is_said() {
    let folder = Folder::with(&["linear-delta-linuxcnc-box.toml"]);
    let design = String::from_utf8(folder.read("linear-delta-linuxcnc-box.toml")).unwrap();
    // The best place of a cube is far from this corner of the region.
    let corner = design.replace("min = [-50, -50, 0]", "min = [40, 40, 0]");
    folder.write("corner.toml", corner);
    let arguments = ["corner.toml", "--cube", "100", "--gap", "1e-2", "-o", "."];
    let value = sized(&folder, &arguments);
    assert_eq!(value["refuted_for"], "this placement");
    assert_eq!((&value["excluded"], &value["excluded_for"]), (&Value::Null, &Value::Null));
    assert!(!folder.path("size-excluded.cert.json").exists());
    let text = folder.run(&["size", "corner.toml", "--cube", "100", "--gap", "1e-2"]).exits(0);
    text.says(&[": at most ", "for this placement", "that no other place works is not proved"]);
}

#[test]
fn a_small_budget_leaves_a_looser_exclusion() {
    let folder = Folder::new();
    let value = sized(&folder, &["--cube", "200", "--max-boxes", "2000"]);
    assert_eq!(value["refuted_for"], "this placement");
    let (refuted, excluded) = (number(&value["refuted"]), number(&value["excluded"]));
    assert!(excluded < refuted, "{excluded} {refuted}");
    assert_eq!(value["excluded_for"], "every axis-aligned placement");
    let run = folder.run(&["size", "--cube", "200", "--max-boxes", "2000"]).exits(0);
    run.says(&[
        "smallest leg length for a cube of side 200 mm: between 309.6",
        "refuted       310.5827299 mm, for this placement",
        "excluded      309.6",
        "limited by    greatest psi <= 2",
        "for every axis-aligned placement",
        "what is proved",
        "The cube has its edges along the axes",
        "Nothing is claimed of turned",
    ]);
}

/// One line, which answers.
#[test]
fn a_quiet_size_is_one_line() {
    let folder = Folder::new();
    let run = folder.run(&["size", "--cube", "200", "--gap", "1e-2", "-q"]).exits(0);
    assert_eq!((run.stdout.lines().count(), run.stderr.as_str()), (1, ""), "{}", run.stdout);
    run.says(&["smallest leg length for a cube of side 200 mm: between 309"]);
}

#[test]
fn the_scale_of_a_machine_is_in_proportion_to_the_cube() {
    let folder = Folder::with(&["linear-delta-linuxcnc-box.toml"]);
    let scale = |side: &str| {
        let arguments = ["linear-delta-linuxcnc-box.toml", "--cube", side, "--gap", "1e-2"];
        let value = sized(&folder, &arguments);
        assert_eq!(value["unknown"], "scale");
        assert_eq!(
            value["refuted_for"],
            "every axis-aligned placement centred in the workspace, scaled"
        );
        (number(&value["refuted"]), number(&value["certified"]))
    };
    let ((low, high), (twice_low, twice_high)) = (scale("100"), scale("200"));
    assert!(low < high && high / low < 1.02);
    assert!((twice_low / low - 2.0).abs() < 0.05 && (twice_high / high - 2.0).abs() < 0.05);
    let arguments = ["size", "linear-delta-linuxcnc-box.toml", "--cube", "100", "--gap", "1e-2"];
    folder.run(&arguments).exits(0).says(&["leg length", "for the 269 of the design"]);
}

#[test]
fn questions_without_a_smallest_machine_are_refused() {
    let folder = Folder::with(&["linear-delta-klipper-box.toml", "tripteron.toml"]);
    let joints = folder.run(&["size", "linear-delta-klipper-box.toml", "--cube", "9"]).exits(2);
    joints.complains(&["joint_range", "accepted"]);
    let endless = folder.run(&["size", "tripteron.toml", "--cube", "9"]).exits(2);
    endless.complains(&["they hold in cubes of any size"]);
    for side in ["0", "-1", "sqrt(2)", "many"] {
        folder.run(&["size", "--cube", side]).exits(2).complains(&["--cube", "accepted"]);
    }
    for gap in ["0", "1", "1e-12", "x"] {
        let run = folder.run(&["size", "--cube", "200", "--gap", gap]).exits(2);
        run.complains(&["--gap", "accepted"]);
    }
}

#[test]
fn a_hexapod_is_scaled_with_its_characteristic_length() {
    let text = include_str!("../designs/kernel/hexapod-linuxcnc.toml");
    let folder = Folder::new();
    folder.write("d.toml", text);
    folder.run(&["size", "d.toml", "--cube", "8"]).exits(2).complains(&["joint_range"]);
    let (rest, _) = text.split_once("joint_range").unwrap();
    folder.write("d.toml", rest);
    let size = ["size", "d.toml", "--cube", "8", "--gap", "0.1", "--max-boxes", "100", "-o", "."];
    // Both ends are more than the gap apart: boxes are too few to certify what is between them.
    let run = folder.run(&[&size[..], &["--format", "json"]].concat()).exits(3);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["unknown"], "scale");
    assert_eq!(value["refuted_for"], "this placement");
    assert!(value["excluded_for"].is_null());
    let (low, high) = (number(&value["refuted"]), number(&value["certified"]));
    assert!(0.3 < low && low < high && high < 0.6, "{low} {high}");
    folder.run(&["check", "size-certified.cert.json"]).exits(0);
    folder.run(&["check", "size-refuted.cert.json"]).exits(1);
}
