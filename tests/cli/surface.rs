//! `export vtk` and `export stl`.

use crate::paving::DESIGN;
use crate::support::Folder;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    folder.run(&["pave", "d.toml", "--volume-gap", "0.5"]).exits(0);
    folder
}

/// The number after `key="` in the text.
fn attribute(text: &str, key: &str) -> usize {
    let start = text.find(&format!("{key}=\"")).unwrap() + key.len() + 2;
    text[start..].split('"').next().unwrap().parse().unwrap()
}

#[test]
fn the_surface_is_written_in_both_formats_with_the_same_corners() {
    let folder = folder();
    let run = folder.run(&["export", "vtk", "d.paving", "-o", "s.vtu"]).exits(0);
    run.says(&["s.vtu:", "faces", "corners"]);
    folder.run(&["export", "stl", "d.paving", "-o", "s.stl"]).exits(0).says(&["s.stl:"]);
    let text = String::from_utf8(folder.read("s.vtu")).unwrap();
    let (faces, points) = (attribute(&text, "NumberOfCells"), attribute(&text, "NumberOfPoints"));
    assert!(faces > 500 && points > 300, "{faces} faces, {points} points");
    let bytes = folder.read("s.stl");
    let triangles = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    // On a closed surface of triangles 2 E = 3 F, and V - E + F is at most 2 where it is connected.
    assert!(triangles.is_multiple_of(2) && triangles >= 2 * points - 4, "{triangles} triangles");
    assert!((faces..2 * faces).contains(&triangles));
    assert_eq!(bytes.len(), 84 + 50 * triangles);
    assert!(!bytes.starts_with(b"solid"));
    // Either file says that its boxes are taken on trust.
    assert!(text.contains("evidence of its boxes is not checked"));
    assert!(String::from_utf8_lossy(&bytes[..80]).contains("evidence of boxes not checked"));
}

#[test]
fn what_is_no_paving_is_refused_and_what_is_broken_rejected() {
    let folder = folder();
    let export = |input: &str| folder.run(&["export", "stl", input, "-o", "s.stl"]);
    export("none.paving").exits(2).complains(&["none.paving: cannot be read"]);
    export("d.toml").exits(2).complains(&["does not begin like a paving"]);
    let bytes = folder.read("d.paving");
    folder.write("cut.paving", &bytes[..bytes.len() / 2]);
    export("cut.paving").exits(5).complains(&["REJECTED", "end within node"]);
    folder.write("o.toml", DESIGN.replace("min = [-0.7, -0.7, -0.7]", "min = [0.6, 0.6, 0.6]"));
    folder.run(&["pave", "o.toml", "--precision", "0.1"]);
    export("o.paving").exits(2).complains(&["no box is inner"]);
    folder.run(&["export", "stl", "d.paving"]).exits(2).complains(&["--output"]);
    folder.run(&["export", "vtk", "d.paving", "-o", "no/s.vtu"]).exits(4);
    assert!(!folder.names().iter().any(|name| name.starts_with("s.")));
}
