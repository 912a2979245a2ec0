//! `pave --coordinates`: some coordinates for all values of the others.

use crate::support::{number, Folder};
use serde_json::Value;

pub fn design(name: &str, changes: &[(&str, &str)]) -> String {
    let path = format!("{}/tests/designs/kernel/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text
}

const WIDE: (&str, &str) = ("[-50, -50]\nmax = [50, 50]", "[-250, -250]\nmax = [250, 250]");
const FLAT: (&str, &str) = ("[-4, -4, 16]\nmax = [4, 4, 24]", "[-12, -12, 18]\nmax = [12, 12, 22]");

fn answer(folder: &Folder, arguments: &[&str]) -> Value {
    let run = folder.run(&[arguments, &["--format", "json"]].concat()).exits(0);
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn positions_of_a_planar_platform_for_every_angle() {
    let folder = Folder::new();
    folder.write("d.toml", design("planar-3-rpr", &[WIDE]));
    let pave = ["pave", "d.toml", "--coordinates", "x,y", "--volume-gap", "0.2"];
    let run = folder.run(&pave).exits(0);
    run.says(&["volume: between ", "Of (x, y), for all values of the other coordinates"]);
    let whole = folder.read("d.paving");
    folder.run(&["check", "d.paving", "--design", "d.toml"]).exits(0).says(&[
        "the values of (x, y) at which, for all values of the other coordinates",
        "from -20 to 20 degrees",
        "The box of (x, y) is cut",
    ]);
    folder.run(&["check", "d.paving", "--sample", "9"]).exits(0).says(&["The evidence of 9 of"]);
    // The bytes depend on nothing else, and can be taken up.
    folder.run(&[&pave[..], &["--threads", "3"]].concat()).exits(0);
    assert!(folder.read("d.paving") == whole);
    folder.write("d.paving.part", &whole[..whole.len() / 2]);
    folder.run(&[&pave[..], &["--resume"]].concat()).exits(0);
    assert!(folder.read("d.paving") == whole);
    folder.write("d.paving.part", &whole);
    let other = ["pave", "d.toml", "--coordinates", "y,x", "--resume"];
    folder.run(&other).exits(2).complains(&["another design's paving"]);
    // The middles of inner boxes hold for every angle: those of a design about that position.
    let found = answer(&folder, &[&pave[..], &["-o", "again.paving"]].concat());
    assert_eq!(found["coordinates"], serde_json::json!(["x", "y"]));
    let area = 250_000.0 * number(&found["inner"]["share"]);
    assert!((20_000.0..24_700.0).contains(&area), "{area}");
    assert!(found["components"].get("best_conditioning").is_none());
    folder.run(&["report", "d.paving"]).exits(0);
    let page = String::from_utf8(folder.read("d.paving.report.html")).unwrap();
    assert!(page.contains("Paved are (x, y), for all values of the other coordinates"));
    assert!(page.contains("x to the right and y up."));
    folder.run(&["export", "stl", "d.paving", "-o", "d.stl"]).exits(0);
}

#[test]
fn positions_of_a_hexapod_for_every_orientation_and_height() {
    let folder = Folder::new();
    let small = ("angle = 15", "angle = 3");
    folder.write("d.toml", design("hexapod-linuxcnc", &[FLAT, small]));
    let found = answer(&folder, &["pave", "d.toml", "--coordinates", "x,y", "--volume-gap", "0.3"]);
    assert!((0.7..0.95).contains(&number(&found["inner"]["share"])), "{found}");
    folder.run(&["check", "d.paving"]).exits(0).says(&["|c| <= tan(3/2)"]);
    // What is inner is certified by itself: a position of the middle box.
    let there = design(
        "hexapod-linuxcnc",
        &[("[-4, -4, 16]\nmax = [4, 4, 24]", "[0, 0, 18]\nmax = [0, 0, 22]"), small],
    );
    folder.write("middle.toml", there);
    folder.run(&["verify", "middle.toml"]).exits(0);
    // And at a corner of the box, which is outer, some orientation fails.
    let corner = design(
        "hexapod-linuxcnc",
        &[("[-4, -4, 16]\nmax = [4, 4, 24]", "[12, -12, 18]\nmax = [12, -12, 22]"), small],
    );
    folder.write("corner.toml", corner);
    folder.run(&["verify", "corner.toml"]).exits(1);
}

#[test]
fn angles_are_named_as_people_say_them() {
    let folder = Folder::new();
    let ranges = "orientation = { roll = [-40, 40], pitch = [-40, 40], yaw = [-10, 10] }";
    let changes = [("orientation = { tilt = 25, torsion = 20 }", ranges)];
    folder.write("s.toml", design("spherical-3-ups", &changes));
    let pave = ["pave", "s.toml", "--coordinates", "roll,pitch", "--volume-gap"];
    let found = answer(&folder, &[&pave[..], &["0.3"]].concat());
    let share = number(&found["inner"]["share"]);
    assert!((0.45..0.64).contains(&share), "{share}");
    // Degrees times degrees are no volume.
    assert!(found["inner"].get("volume").is_none());
    folder.run(&[&pave[..], &["0.5"]].concat()).exits(0).says(&["of the box"]);
    folder.run(&["check", "s.paving"]).exits(0).says(&["the values of (roll, pitch)"]);
    let edge = ["pave", "s.toml", "--coordinates", "roll", "--precision", "1"];
    folder.run(&edge).exits(2).complains(&["--precision: found 1", "accepted: --volume-gap"]);
    folder.write("p.toml", design("planar-3-rpr", &[("[-20, 20]", "[-90, 90]")]));
    let found = answer(&folder, &["pave", "p.toml", "--coordinates", "angle"]);
    assert!(number(&found["outer"]["share"]) > 0.1, "{found}");
    // Formulas have names of their own.
    folder.write("f.toml", design("tricept", &[("one_to_one = true", "")]));
    let found = answer(&folder, &["pave", "f.toml", "--coordinates", "r"]);
    assert_eq!(found["inner"]["share"], "1", "{found}");
}

#[test]
fn coordinates_that_cannot_be_paved_are_refused_with_those_that_can() {
    let folder = Folder::new();
    folder.write("h.toml", design("hexapod-linuxcnc", &[]));
    folder.write("p.toml", design("planar-3-rpr", &[]));
    let cylinder = (
        "min = [-4, -4, 16]\nmax = [4, 4, 24]",
        "cylinder = { center = [0, 0], radius = 4, z = [16, 24] }",
    );
    folder.write("c.toml", design("hexapod-linuxcnc", &[cylinder]));
    let hexapod = "accepted: one to three different ones of x, y, z; of orientations by roll";
    for (file, names, complaint) in [
        ("h.toml", "q", hexapod),
        ("h.toml", "x,roll", hexapod),
        ("h.toml", "x,x", hexapod),
        ("h.toml", "x,,y", hexapod),
        ("h.toml", "", hexapod),
        ("h.toml", "X", hexapod),
        ("p.toml", "x,y,angle,x", "one to three different ones of x, y, angle"),
        ("p.toml", "z", "one to three different ones of x, y, angle"),
        ("c.toml", "x", "one to three different ones of z;"),
    ] {
        let run = folder.run(&["pave", file, "--coordinates", names]).exits(2);
        run.complains(&["--coordinates: found", complaint]);
    }
    for (file, complaints) in [
        ("h.toml", ["found 6 coordinates, with orientation", "--coordinates NAME,..", "x, y, z"]),
        ("p.toml", ["found 3 coordinates, with orientation", "--coordinates", "x, y, angle"]),
    ] {
        folder.run(&["pave", file]).exits(2).complains(&complaints);
    }
    // All coordinates of a machine that does not turn are paved as ever.
    folder.write("o.toml", crate::paving::DESIGN);
    folder.run(&["pave", "o.toml", "--precision", "0.2"]).exits(0);
    let whole = folder.read("o.paving");
    folder.run(&["pave", "o.toml", "--precision", "0.2", "--coordinates", "x, y, z"]).exits(0);
    assert!(folder.read("o.paving") == whole);
    let names = ["c.toml", "h.toml", "o.paving", "o.toml", "p.toml"];
    assert_eq!(folder.names(), names);
}
