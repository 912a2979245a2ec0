//! `--format json`: the same facts, exact numbers as strings.

use crate::support::{Folder, Run};
use serde_json::Value;

fn object(run: &Run) -> Value {
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(value.is_object());
    value
}

#[test]
fn a_certified_design() {
    let folder = Folder::with(&["orthoglide-tolerance.toml"]);
    let arguments = ["verify", "orthoglide-tolerance.toml", "--format", "json"];
    let run = folder.run(&arguments).exits(0);
    assert_eq!(run.stderr, "");
    let value = object(&run);
    assert_eq!(value["verdict"], "certified");
    assert_eq!(value["title"], "Orthoglide, legs of 311.5 mm with tolerance");
    assert_eq!(value["design"], "orthoglide-tolerance.toml");
    let rows = value["requirements"].as_array().unwrap();
    let psi = rows.iter().find(|row| row["requirement"] == "greatest psi").unwrap();
    assert_eq!(psi["bound"], "<= 2");
    assert_eq!(psi["seems_violated"], false);
    assert!(psi["worst_found"].as_f64().unwrap() < 2.0);
    assert_eq!(psi["at"].as_array().unwrap().len(), 3);
    assert_eq!(psi["machine"].as_array().unwrap().len(), 3);
    assert_eq!(psi["machine"][0]["parameter"], "length");
    assert!(value["proof"]["leaves"].as_u64().unwrap() >= 1);
    let file = &value["certificate"];
    assert_eq!(file["path"], "orthoglide-tolerance.cert.json");
    let bytes = folder.read("orthoglide-tolerance.cert.json");
    assert_eq!(file["bytes"].as_u64(), Some(bytes.len() as u64));
    assert_eq!(file["sha256"].as_str().unwrap(), sha256(&bytes));
    let certificate: Value = serde_json::from_slice(&bytes).unwrap();
    assert_eq!(value["claim"], certificate["claim"]);
}

fn sha256(bytes: &[u8]) -> String {
    use sha2::{Digest, Sha256};
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn a_refuted_design() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    let run = folder.run(&["verify", "orthoglide-310.toml", "--format", "json"]).exits(1);
    let value = object(&run);
    assert_eq!(value["verdict"], "refuted");
    let found = &value["counterexample"];
    assert_eq!(found["violated"], "greatest psi <= 2");
    assert!(found["value"].as_str().unwrap().starts_with("greatest psi >= 2.00578"));
    assert_eq!(found["point"][0], "634/5");
    assert_eq!(found["directions"][0].as_array().unwrap().len(), 3);
}

#[test]
fn an_undecided_design() {
    let folder = Folder::with(&["orthoglide-tie.toml"]);
    let run = folder.run(&["verify", "orthoglide-tie.toml", "--format", "json"]).exits(3);
    let value = object(&run);
    assert_eq!(value["verdict"], "undecided");
    assert!(value["certificate"].is_null());
    let open = &value["undecided"];
    assert_eq!(open["boxes"], 1);
    assert_eq!(open["region_count"], 1);
    assert!(open["volume"].as_f64().unwrap() > 0.0);
    assert_eq!(open["regions"].as_array().unwrap().len(), 1);
    assert_eq!(open["open"][0]["obligation"], "transmission");
    assert!(open["open"][0]["help"].as_str().unwrap().contains("equality"));
    assert!(open["worst_box"]["margin"].as_f64().unwrap().abs() < 1e-9);
}

#[test]
fn check_show_design_and_postulate() {
    let folder = Folder::new();
    folder.run(&["verify", "-o", "c.json"]).exits(0);
    let value = object(&folder.run(&["check", "c.json", "--format", "json"]).exits(0));
    assert_eq!(value["accepted"], true);
    assert_eq!(value["verdict"], "certified");
    assert!(value["statement"].as_str().unwrap().contains("It is proved"));
    let value = object(&folder.run(&["show", "c.json", "--format", "json"]).exits(0));
    assert_eq!(value["checked"], false);
    assert_eq!(value["stated_verdict"], "certified");
    let arguments = ["design", "--psi-max", "2", "--cube", "200", "--format", "json"];
    let value = object(&folder.run(&arguments).exits(0));
    assert_eq!(value["dimensions"][0]["symbol"], "L");
    assert_eq!(value["dimensions"][0]["min"], "310.582854123024");
    assert_eq!(value["dimensions"][0]["max"], "310.582854123025");
    let value = object(&folder.run(&["postulate", "--all", "--format", "json"]).exits(0));
    assert_eq!(value["verdict"], "certified");
    assert_eq!(value["claim"]["postulate"]["psi_max"], "all");
}

#[test]
fn bounds_and_paper() {
    let folder = Folder::new();
    let arguments = ["bounds", "--relative", "0.01", "--format", "json"];
    let value = object(&folder.run(&arguments).exits(0));
    assert_eq!(value["bounds"][0]["quantity"], "psi");
    assert_eq!(value["bounds"][0]["min"], "1/2");
    let of = |quantity: &str| {
        value["bounds"].as_array().unwrap().iter().find(|row| row["quantity"] == quantity).unwrap()
    };
    // What the design does not name is one, and said.
    assert_eq!(of("stiffness")["given"]["joint"][0], "1");
    assert_eq!(of("joint force")["given"]["tool"][0], "1");
    folder
        .run(&arguments[..3])
        .exits(0)
        .says(&["stiffness is of joints with a stiffness of 1 each"]);
    let value = object(&folder.run(&["paper", "--format", "json"]).exits(0));
    assert_eq!(value["claims"][0]["id"], "leg-length");
}

#[test]
fn a_rejected_certificate() {
    let folder = Folder::new();
    folder.write("bad.json", "{}");
    let run = folder.run(&["check", "bad.json", "--format", "json"]).exits(5);
    let value = object(&run);
    assert_eq!(value["accepted"], false);
    assert!(!value["reason"].as_str().unwrap().is_empty());
}

#[test]
fn errors_leave_standard_output_empty() {
    let run = Folder::new().run(&["verify", "missing.toml", "--format", "json"]).exits(2);
    run.complains(&["missing.toml"]);
}

/// A joint that turns from 94 to 185 degrees: what is found of it is an angle of its range, not 360 degrees off.
#[test]
fn an_angle_beyond_half_a_turn_is_told_in_the_turn_of_its_bound() {
    let folder = Folder::new();
    let design = |max: i32| {
        let leg = |x: i32, mode: &str| {
            format!(
                "[[mechanism.legs]]\ndrive = \"arm\"\nanchor = [{x}, 0]\narm = 12\nlength = 18\n\
                 mode = \"{mode}\"\n"
            )
        };
        format!(
            "[mechanism]\nkind = \"planar\"\n{}{}[workspace]\nmin = [-8, 14]\nmax = [8, 22]\n\
             [requirements]\njoint_range = [{{ min = 60, max = {max} }}, {{ min = -10, max = 120 }}]\n",
            leg(-6, "-"),
            leg(6, "+")
        )
    };
    folder.write("wide.toml", design(190));
    folder.write("narrow.toml", design(184));
    let found = |name: &str, code: i32| {
        let run = folder.run(&["verify", name, "--format", "json"]).exits(code);
        let value = object(&run);
        let rows = value["requirements"].as_array().unwrap().clone();
        let own = rows.iter().find(|row| row["requirement"].as_str().unwrap().contains("rho_1"));
        own.unwrap_or_else(|| panic!("{value}"))["worst_found"].as_f64().unwrap()
    };
    for (name, code) in [("wide.toml", 0), ("narrow.toml", 1)] {
        let angle = found(name, code);
        assert!((184.0..186.0).contains(&angle), "{name}: {angle}");
    }
    let refuted = folder.run(&["verify", "narrow.toml"]).exits(1);
    assert!(refuted.stdout.contains("rho_1 is about 184."), "{}", refuted.stdout);
}
