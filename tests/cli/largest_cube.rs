//! `largest-cube`.

use crate::paving::DESIGN;
use crate::support::{number, Folder};
use serde_json::Value;

#[test]
fn the_bounds_enclose_the_closed_form() {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    let run = folder.run(&["largest-cube", "d.toml", "--format", "json"]).exits(0);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    // The paper's cube: q_2 - q_1 = 1/sqrt(6) + 1/sqrt(18), for every leg length one.
    let side = 6f64.sqrt().recip() + 18f64.sqrt().recip();
    let (min, max) = (number(&answer["min"]), number(&answer["max"]));
    assert!(min <= side && side <= max && max - min <= 1e-6 * min, "{min} {side} {max}");
    let centre = (6f64.sqrt().recip() - 18f64.sqrt().recip()) / 2.0;
    for k in 0..3 {
        assert!((number(&answer["centre"][k]) - centre).abs() < 1e-6);
    }
    for file in ["d.cube.cert.json", "d.no-cube.cert.json"] {
        folder.run(&["check", file]).exits(0).says(&["ACCEPTED: certified"]);
        folder.run(&["show", file]).exits(0);
    }
    folder.run(&["check", "d.no-cube.cert.json"]).says(&["No axis-aligned cube of side"]);
}

#[test]
fn legs_of_310_have_a_cube_of_199_and_none_of_200() {
    let folder = Folder::new();
    let design = DESIGN.replace("leg_length = 1", "leg_length = 310");
    folder.write("d.toml", design.replace("0.7", "217"));
    let fits = ["largest-cube", "d.toml", "--side"];
    folder.run(&[&fits[..], &["200"]].concat()).exits(1).says(&["no cube of side 200 fits"]);
    folder.run(&[&fits[..], &["199"]].concat()).exits(0).says(&["a cube of side 199 fits"]);
    for (file, text) in [("d.cube.cert.json", "certified"), ("d.no-cube.cert.json", "side 200")] {
        folder.run(&["check", file]).exits(0).says(&[text]);
    }
    // The same proof does not do for a smaller cube.
    let certificate = String::from_utf8(folder.read("d.no-cube.cert.json")).unwrap();
    folder.write("edited.json", certificate.replace("\"side\":\"200\"", "\"side\":\"199\""));
    folder
        .run(&["check", "edited.json"])
        .exits(5)
        .complains(&["REJECTED", "certainly fail throughout"]);
}

#[test]
fn a_small_budget_leaves_looser_bounds() {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    let few = ["largest-cube", "d.toml", "--max-boxes", "5"];
    folder.run(&few).exits(3).says(&["side between 0.59593 and 1.72"]);
    assert_eq!(folder.names(), ["d.cube.cert.json", "d.no-cube.cert.json", "d.toml"]);
    folder.run(&["check", "d.cube.cert.json"]).exits(0);
    folder.run(&["check", "d.no-cube.cert.json"]).exits(0);
}

#[test]
fn bad_usage_is_refused() {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    for (arguments, code, complaint) in [
        (&["--gap", "0"][..], 2, "from 1e-9 to 0.5"),
        (&["--gap", "many"], 2, "not a number"),
        (&["--side", "-1"], 2, "from 1e-100 to 1e100"),
        (&["--side", "1e-310"], 2, "from 1e-100 to 1e100"),
        (&["--side", "1e-400"], 2, "from 1e-100 to 1e100"),
        (&["--side", "1e309"], 2, "from 1e-100 to 1e100"),
        (&["--side", "1", "--gap", "0.1"], 2, "cannot be used with"),
        (&["-o", "missing"], 4, "there is no folder"),
    ] {
        let arguments = [&["largest-cube", "d.toml"], arguments].concat();
        folder.run(&arguments).exits(code).complains(&[complaint]);
    }
    folder.run(&["largest-cube", "missing.toml"]).exits(2).complains(&["missing.toml"]);
}

#[test]
fn of_a_platform_that_turns_the_cube_is_one_of_positions() {
    let folder = Folder::new();
    let file = "hexapod-linuxcnc.toml";
    folder.write(file, include_str!("../designs/kernel/hexapod-linuxcnc.toml"));
    let run = folder.run(&["largest-cube", file, "--gap", "0.1", "--format", "json"]).exits(0);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    let (min, beyond) = (number(&answer["min"]), number(&answer["refuted_here"]));
    assert!(8.0 < min && min < beyond && beyond <= 1.1001 * min, "{min} {beyond}");
    assert!(answer.get("max").is_none());
    let cube = "hexapod-linuxcnc.cube.cert.json";
    folder.run(&["check", cube]).exits(0).says(&["R the rotation of the platform"]);
    folder.run(&["check", "hexapod-linuxcnc.refuted-cube.cert.json"]).exits(1);
    let text = folder.run(&["largest-cube", file, "--gap", "0.1"]).exits(0);
    text.says(&[
        "largest cube: side of at least",
        "at            (x, y, z) = (",
        "about that centre; elsewhere may do",
    ]);
    folder.run(&["largest-cube", file, "--side", "4"]).exits(0).says(&["a cube of side 4 fits"]);
    let run = folder.run(&["largest-cube", file, "--side", "40"]).exits(3);
    run.says(&["no cube can be excluded everywhere"]);
}
