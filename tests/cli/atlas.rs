//! `atlas`: maps, what is written of them, and what is refused.

use crate::support::{Folder, Run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The Orthoglides of `tests/atlases`, at a coarse resolution.
pub fn coarse() -> Folder {
    map(4)
}

/// The same at any resolution: 1 for what does not depend on what is in the map.
pub fn map(resolution: usize) -> Folder {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/atlases/orthoglide.toml");
    let text = fs::read_to_string(path).unwrap();
    let folder = Folder::new();
    folder.write("map.toml", text.replace("resolution = 8", &format!("resolution = {resolution}")));
    folder
}

/// The names in the folder of the map, sorted.
fn names(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(folder.path("map.atlas")).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn json(run: &Run) -> Value {
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn a_map_is_written_with_everything_and_accepted() {
    let folder = coarse();
    let report = json(&folder.run(&["atlas", "map.toml", "--format", "json"]).exits(0));
    let share = |part: &str| report[part]["share"].as_str().unwrap().to_owned();
    assert_eq!((share("certified"), share("refuted")), ("9/16".into(), "21/64".into()));
    assert_eq!(report["marks"][0]["verdict"], "undecided");
    assert_eq!(report["best"]["sense"], "maximise");
    let written = ["SHA256SUMS", "atlas.cert.json", "best.cert.json", "index.html", "map.svg"];
    assert_eq!(names(&folder), written);
    folder.run(&["check", "map.atlas/atlas.cert.json"]).exits(0).says(&[
        "ACCEPTED: certified",
        "<psi_max> in [1.2, 4]",
        "the share 9/16",
    ]);
    folder.run(&["check", "map.atlas/best.cert.json"]).exits(0);
    folder.run(&["show", "map.atlas/atlas.cert.json"]).exits(0).says(&["NOT CHECKED", "atlas of"]);
    let svg = String::from_utf8(folder.read("map.atlas/map.svg")).unwrap();
    for part in
        ["cell c\"", "cell r\"", "cell u\"", "prototype", "best", "margin, sampled", "100 %"]
    {
        assert!(svg.contains(part), "{part}");
    }
    let page = String::from_utf8(folder.read("map.atlas/index.html")).unwrap();
    assert!(
        page.contains("<svg")
            && page.contains("It is proved:")
            && !page.contains("http://www.w3.org/1999")
    );
}

#[test]
fn a_map_of_a_platform_that_turns_is_written_and_accepted() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/atlases/rpr.toml");
    let text = fs::read_to_string(path).unwrap();
    let text = text.replace("resolution = 6", "resolution = 3").replace("objective", "# objective");
    let folder = Folder::new();
    folder.write("map.toml", &text);
    let report = json(&folder.run(&["atlas", "map.toml", "--format", "json"]).exits(0));
    let share = |part: &str| report[part]["share"].as_str().unwrap().to_owned();
    assert!(share("certified") != "0" && share("refuted") != "0", "{report}");
    folder.run(&["check", "map.atlas/atlas.cert.json"]).exits(0).says(&[
        "ACCEPTED: certified",
        "<turn> in [5, 60]",
        "for every rotation R from -<turn> to <turn> degrees",
    ]);
    folder.run(&["show", "map.atlas/atlas.cert.json"]).exits(0).says(&["NOT CHECKED", "atlas of"]);
    let page = String::from_utf8(folder.read("map.atlas/index.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("It is proved:"));
}

/// A map with the widest margin as its objective.
pub fn widest(resolution: usize) -> Folder {
    let folder = map(resolution);
    let text = String::from_utf8(folder.read("map.toml")).unwrap();
    let objective = "objective = { maximise = \"side\" }";
    assert!(text.contains(objective));
    folder.write("map.toml", text.replace(objective, "objective = \"widest margin\""));
    folder
}

#[test]
fn the_widest_margin_has_a_certificate_and_a_bound() {
    let folder = widest(4);
    let report = json(&folder.run(&["atlas", "map.toml", "--format", "json"]).exits(0));
    let best = &report["best"];
    assert_eq!((&best["objective"], &best["at"]), (&"margin".into(), &["4", "1/10"].into()));
    folder.run(&["check", "map.atlas/best.cert.json"]).exits(0).says(&["psi_i >= "]);
    let bound = folder.run(&["check", "map.atlas/bound.cert.json"]).exits(0);
    bound.says(&["refuted, in which none is, at least the share 1."]);
    let says = ["maximise margin = ", "psi_max = 4, side = 0.1; no design of the box has"];
    folder.run(&["atlas", "map.toml"]).exits(0).says(&says);
    let page = String::from_utf8(folder.read("map.atlas/index.html")).unwrap();
    assert!(page.contains("class=\"iso\"") && page.contains("Lines of equal margin"));
    // Another objective leaves nothing of it.
    folder.write("map.toml", map(1).read("map.toml"));
    folder.run(&["atlas", "map.toml"]).exits(0);
    assert!(!folder.path("map.atlas/bound.cert.json").exists());
}

#[test]
fn margins_are_refused_where_there_are_none() {
    const OBJECTIVE: (&str, &str) = ("{ maximise = \"side\" }", "\"widest margin\"");
    refused("{ maximise = \"side\" }", "\"widest\"", &["atlas.objective", "or \"widest margin\""]);
    let half = ("max = \"psi_max\" }", "max = \"psi_max\" }\njoint_range = { min = -2 }");
    let base = ("leg_length = 1", "leg_length = 1\nbase = 0");
    refused_after(&[OBJECTIVE, half, base], &["atlas.objective", "one end"]);
}

#[test]
fn a_map_does_not_depend_on_the_threads() {
    let folder = map(3);
    for threads in ["1", "3"] {
        let run = ["atlas", "map.toml", "-o", threads, "--threads", threads, "--quiet"];
        folder.run(&run).exits(0).says(&["ATLAS", "certified", "refuted"]);
    }
    for name in ["atlas.cert.json", "best.cert.json", "map.svg", "index.html"] {
        assert!(folder.read(&format!("1/{name}")) == folder.read(&format!("3/{name}")), "{name}");
    }
}

#[test]
fn maps_of_one_and_of_three_parameters_are_drawn() {
    let folder = coarse();
    let two = String::from_utf8(folder.read("map.toml")).unwrap();
    let one = two
        .replace("psi_max = { min = \"1.2\", max = 4, label = \"psi_max = 1/psi_min\" }", "")
        .replace("{ min = \"1/psi_max\", max = \"psi_max\" }", "{ min = \"1/2\", max = 2 }")
        .replace("psi_max = 2, side", "side");
    folder.write("one.toml", &one);
    folder.run(&["atlas", "one.toml"]).exits(0).says(&["prototype"]);
    let three = two
        .replace("side = { min", "leg = { min = \"0.9\", max = \"1.1\" }\nside = { min")
        .replace("leg_length = 1", "leg_length = \"leg\"")
        .replace("psi_max = 2, side", "leg = 1, psi_max = 2, side")
        .replace("resolution = 4", "resolution = 2");
    folder.write("three.toml", &three);
    folder.run(&["atlas", "three.toml"]).exits(0);
    let svg = String::from_utf8(folder.read("three.atlas/map.svg")).unwrap();
    assert_eq!(svg.matches("<g transform").count(), 4);
    assert!(!svg.contains("class=\"iso"));
}

#[test]
fn nothing_decided_is_exit_3() {
    let folder = coarse();
    let text = String::from_utf8(folder.read("map.toml")).unwrap();
    let text = text
        .replace("min = \"1.2\", max = 4", "min = \"1.99\", max = \"2.2\"")
        .replace("min = \"0.1\", max = 1,", "min = \"0.63\", max = \"0.66\",")
        .replace("resolution = 4", "resolution = 1")
        .replace("boxes = 300", "boxes = 1");
    folder.write("map.toml", text);
    let run = folder.run(&["atlas", "map.toml"]);
    run.exits(3).says(&["0 % certified", "0 % refuted"]);
}

/// The atlas with one text replaced, refused with exit 2 and these words.
fn refused(from: &str, to: &str, words: &[&str]) {
    refused_after(&[(from, to)], words);
}

/// The same with several edits.
fn refused_after(edits: &[(&str, &str)], words: &[&str]) {
    let folder = coarse();
    let mut text = String::from_utf8(folder.read("map.toml")).unwrap();
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    folder.write("map.toml", text);
    folder.run(&["atlas", "map.toml"]).exits(2).complains(words);
    assert_eq!(folder.names().iter().filter(|name| *name != "map.toml").count(), 0);
}

#[test]
fn bad_parameters_are_refused_with_a_sentence() {
    const SIDE: &str = r#"side = { min = "0.1", max = 1,"#;
    let with = |range: &str| format!("side = {{ {range},");
    refused(SIDE, &with("min = 1, max = \"0.1\""), &["parameters.side.max", "below the lower end"]);
    refused(SIDE, &with("min = 1, max = 1"), &["a max greater than min"]);
    refused(SIDE, &with("min = 1"), &["parameters.side.max", "nothing: the key is missing"]);
    refused(SIDE, &with("min = \"sqrt(2)/9\", max = 1"), &["a rational number"]);
    refused(SIDE, &with("min = 0, max = 1, step = 2"), &["parameters.side.step", "unknown key"]);
    let more = "a = { min = 1, max = 2 }\nb = { min = 1, max = 2 }\n";
    refused("side = {", &format!("{more}side = {{"), &["4 parameters", "one to three"]);
    const NO_MARK: (&str, &str) = ("    { label", "    # {");
    refused_after(
        &[("side = {", "spare = { min = 1, max = 2 }\nside = {"), NO_MARK],
        &["no number of the design depends on spare"],
    );
    let capital = &["the name side", "did you mean Side?"];
    refused_after(&[("side = {", "Side = {"), NO_MARK], capital);
    let root = ("side = {", "sqrt = { min = 1, max = 2 }\nside = {");
    refused_after(&[root, NO_MARK], &["\"sqrt\""]);
}

#[test]
fn designs_that_are_none_somewhere_in_the_box_are_refused() {
    refused(
        "leg_length = 1",
        "leg_length = \"side - 1/10\"",
        &["leg_length", "a length greater than 0"],
    );
    // Zero in the inside of the range only.
    refused(
        "leg_length = 1",
        "leg_length = \"(side-1/2)*(side-1/2)\"",
        &["may have a length of zero"],
    );
    refused("max = \"psi_max\"", "max = \"psi_max + 0/(psi_max-4)\"", &["divisor"]);
    refused("max = \"psi_max\"", "max = \"psi_max + foo\"", &["the name foo", "psi_max, side"]);
    refused("resolution = 4", "resolution = 0", &["atlas.resolution", "from 1 to 20"]);
    refused("resolution = 4", "resolution = 4.5", &["atlas.resolution", "a whole number"]);
    refused("boxes = 300\n", "", &["atlas.boxes", "nothing: the key is missing"]);
    refused("{ maximise = \"side\" }", "{ maximise = \"size\" }", &["objective", "the name size"]);
    refused("side = \"1/sqrt", "size = \"1/sqrt", &["marks.0.size", "unknown key"]);
    refused("leg_length = 1", "", &["leg_length", "nothing: the key is missing"]);
}

#[test]
fn names_are_refused_in_ordinary_designs() {
    let folder = Folder::new();
    let design = "[mechanism]\nkind = \"orthoglide\"\nleg_length = \"side\"\n[workspace]\n\
                  min = [0,0,0]\nmax = [1,1,1]\n[requirements]\ntransmission = { max = 2 }\n";
    folder.write("a.toml", design);
    folder.run(&["verify", "a.toml"]).exits(2).complains(&["leg_length", "found \"side\""]);
}

#[test]
fn a_map_takes_the_place_of_a_map_only() {
    let folder = map(1);
    let refused = |name: &str| {
        let run = folder.run(&["atlas", "map.toml"]).exits(2);
        run.complains(&["map.atlas", &format!("found {name} in it"), "accepted: a new folder"]);
    };
    // A design of a name that is one of a map's, and nothing else.
    fs::create_dir(folder.path("map.atlas")).unwrap();
    folder.write("map.atlas/best.cert.json", "a design");
    refused("best.cert.json");
    assert_eq!(names(&folder), ["best.cert.json"]);
    assert_eq!(folder.read("map.atlas/best.cert.json"), b"a design");
    fs::remove_file(folder.path("map.atlas/best.cert.json")).unwrap();
    // Empty; with an earlier map.
    folder.run(&["atlas", "map.toml"]).exits(0);
    let before = fs::read(folder.path("map.atlas/map.svg")).unwrap();
    folder.run(&["atlas", "map.toml"]).exits(0);
    assert_eq!(folder.names(), ["map.atlas", "map.toml"]);
    // With something else; with something that was changed, or is not what it was.
    folder.write("map.atlas/notes.txt", "");
    refused("notes.txt");
    fs::remove_file(folder.path("map.atlas/notes.txt")).unwrap();
    folder.write("map.atlas/index.html", "annotated");
    refused("index.html");
    fs::remove_file(folder.path("map.atlas/index.html")).unwrap();
    fs::create_dir(folder.path("map.atlas/index.html")).unwrap();
    refused("index.html");
    assert_eq!(folder.read("map.atlas/map.svg"), before);
    assert_eq!(folder.names(), ["map.atlas", "map.toml"]);
    // What was taken away is not missed.
    fs::remove_dir(folder.path("map.atlas/index.html")).unwrap();
    folder.run(&["atlas", "map.toml"]).exits(0);
    assert_eq!(names(&folder).len(), 5);
    folder.run(&["atlas", "map.toml", "-o", "."]).exits(2).complains(&["the name of a folder"]);
}

#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_a_map_is_refused() {
    let folder = coarse();
    fs::create_dir(folder.path("elsewhere")).unwrap();
    std::os::unix::fs::symlink("elsewhere", folder.path("map.atlas")).unwrap();
    folder.run(&["atlas", "map.toml"]).exits(4).complains(&["map.atlas", "a symbolic link"]);
    assert_eq!(fs::read_dir(folder.path("elsewhere")).unwrap().count(), 0);
}

#[test]
fn the_sums_of_a_map_are_those_of_its_files() {
    let folder = map(1);
    folder.run(&["atlas", "map.toml"]).exits(0);
    let sums = String::from_utf8(folder.read("map.atlas/SHA256SUMS")).unwrap();
    let mut listed = vec!["SHA256SUMS".to_owned()];
    for line in sums.lines() {
        let (sum, name) = line.split_once("  ").unwrap();
        assert_eq!(
            sum,
            orthocert::files::digest::sha256(&folder.read(&format!("map.atlas/{name}")))
        );
        listed.push(name.to_owned());
    }
    listed.sort();
    assert_eq!(listed, names(&folder));
}

#[test]
fn a_folder_that_cannot_be_made_is_exit_4() {
    let folder = coarse();
    folder.write("file", "");
    folder.run(&["atlas", "map.toml", "-o", "file"]).exits(4).complains(&["file"]);
    assert_eq!(folder.read("file"), b"");
}
