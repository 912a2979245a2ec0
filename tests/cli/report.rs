//! `report`: a page for what the checker accepts, and for nothing else.

use crate::support::Folder;
use serde_json::Value;
use sha2::{Digest, Sha256};

fn committed(folder: &Folder, name: &str) -> String {
    let file = format!("{name}.cert.json");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let from = root.join("proofs/certificates").join(&file);
    std::fs::copy(from, folder.path(&file)).unwrap();
    file
}

#[test]
fn it_ends_with_the_verdict_and_stands_beside_the_certificate() {
    let folder = Folder::new();
    for (name, code, word) in
        [("orthoglide-prototype", 0, "CERTIFIED"), ("orthoglide-310", 1, "REFUTED")]
    {
        let file = committed(&folder, name);
        let run = folder.run(&["report", &file]).exits(code);
        assert_eq!(run.stderr, "");
        let page = format!("{name}.report.html");
        run.says(&["ACCEPTED", &page]);
        let page = String::from_utf8(folder.read(&page)).unwrap();
        assert!(page.contains(word) && page.contains(&format!("<h1>{name}</h1>")));
        let digest: String =
            Sha256::digest(folder.read(&file)).iter().map(|b| format!("{b:02x}")).collect();
        assert!(page.contains(&digest));
    }
}

#[test]
fn a_rejected_certificate_gets_no_page() {
    let folder = Folder::new();
    let file = committed(&folder, "orthoglide-prototype");
    let good = String::from_utf8(folder.read(&file)).unwrap();
    folder.write("bad.cert.json", good.replace("\"corner\":\"Q1\"", "\"corner\":\"Q2\""));
    let run = folder.run(&["report", "bad.cert.json", "--svg", "figures"]).exits(5);
    run.complains(&["bad.cert.json: REJECTED", "no report is written"]);
    assert_eq!(folder.names(), ["bad.cert.json", file.as_str()]);
    let run = folder.run(&["report", "bad.cert.json", "--format", "json"]).exits(5);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(answer["accepted"], false);
}

#[test]
fn what_cannot_be_read_or_written_is_said() {
    let folder = Folder::new();
    let file = committed(&folder, "orthoglide-prototype");
    folder.run(&["report", "missing.json"]).exits(2).complains(&["cannot be read"]);
    folder.run(&["report", &file, "-o", &file]).exits(2).complains(&["is a file that is read"]);
    folder.run(&["report", &file, "-o", "no/such/a.html"]).exits(4).complains(&["no folder"]);
    folder.run(&["report", &file, "-o", "."]).exits(4).complains(&["is a folder"]);
    folder.write("plain", "");
    let run = folder.run(&["report", &file, "--svg", "plain"]).exits(4);
    run.complains(&["plain: cannot be written: no folder"]);
}

#[test]
fn figures_are_written_as_svg() {
    let folder = Folder::new();
    let file = committed(&folder, "orthoglide-prototype");
    let options = ["report", &file, "-o", "a.html", "--svg", "x/figures", "--format", "json"];
    let run = folder.run(&options).exits(0);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&answer["accepted"], &answer["verdict"]), (&true.into(), &"certified".into()));
    let files: Vec<&str> =
        answer["files"].as_array().unwrap().iter().map(|f| f["path"].as_str().unwrap()).collect();
    let figures = ["design", "psi-1", "psi-2", "psi-3", "critical-1", "critical-2", "subdivision"];
    let expected = figures.map(|name| format!("x/figures/{name}.svg"));
    assert_eq!(files[0], "a.html");
    assert_eq!(files[1..], expected);
    for path in expected {
        let svg = String::from_utf8(folder.read(&path)).unwrap();
        assert!(svg.starts_with("<?xml") && svg.contains("<title>"), "{path}");
    }
}

/// Four legs, and formulas of a user: what is drawn of them, and what is not.
#[test]
fn any_mechanism_is_reported() {
    let folder = Folder::new();
    let maps = ["psi-1", "critical-1"];
    for (name, code, figures) in [
        (
            "four-struts",
            0,
            [&["design"], &maps[..], &["psi-2", "critical-2", "subdivision"]].concat(),
        ),
        ("four-struts-refuted", 1, vec!["design", "psi-1", "psi-2", "subdivision"]),
        ("biglide", 0, [&maps[..], &["subdivision"]].concat()),
    ] {
        let file = format!("{name}.cert.json");
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        std::fs::copy(root.join("tests/kernel").join(&file), folder.path(&file)).unwrap();
        let run = folder.run(&["report", &file, "--svg", name, "--format", "json"]).exits(code);
        assert_eq!(run.stderr, "");
        let answer: Value = serde_json::from_str(&run.stdout).unwrap();
        let files = answer["files"].as_array().unwrap().iter();
        let files: Vec<&str> = files.map(|f| f["path"].as_str().unwrap()).collect();
        let expected = figures.iter().map(|figure| format!("{name}/{figure}.svg"));
        assert_eq!(files[1..], expected.collect::<Vec<_>>());
        let page = String::from_utf8(folder.read(files[0])).unwrap();
        assert!(page.contains("<h2>Maps</h2>") && page.contains("<h2>Check it again</h2>"));
    }
    let bad = String::from_utf8(folder.read("four-struts.cert.json")).unwrap();
    folder.write(
        "bad.cert.json",
        bad.replace("\"max\",\"bound\":\"1.25\"", "\"max\",\"bound\":\"1.1\""),
    );
    folder.run(&["report", "bad.cert.json"]).exits(5).complains(&["REJECTED"]);
}

/// The volume of the inner leaves of a page's tree, in parts of the box.
fn inner_volume(page: &str) -> f64 {
    let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: Value = serde_json::from_str(data).unwrap();
    let (mut volume, mut waiting) = (0.0, vec![1.0]);
    for kind in data["region"]["code"].as_str().unwrap().chars() {
        let size: f64 = waiting.pop().unwrap();
        match kind {
            'X' | 'Y' | 'Z' => waiting.extend([size / 2.0; 2]),
            '#' => volume += size,
            _ => assert!("?.".contains(kind), "{kind}"),
        }
    }
    assert!(waiting.is_empty());
    volume
}

#[test]
fn a_paving_gets_a_page_with_its_volume_and_region() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    let paved = folder.run(&["pave", "d.toml", "--precision", "0.1"]).exits(0).stdout;
    let volumes = paved.split(", gap").next().unwrap().strip_prefix("volume: ").unwrap();
    let run = folder.run(&["report", "d.paving", "--svg", "svg"]).exits(0);
    assert_eq!(run.stderr, "");
    run.says(&["ACCEPTED: paving", "d.paving.report.html", "svg/region.svg", "svg/slices.svg"]);
    let page = String::from_utf8(folder.read("d.paving.report.html")).unwrap();
    assert!(page.contains(&format!("CERTIFIED: volume {volumes}")), "{volumes}");
    assert!(page.contains("All boxes of the paving are shown.") && !page.contains("mm^3"));
    let digest: String =
        Sha256::digest(folder.read("d.paving")).iter().map(|b| format!("{b:02x}")).collect();
    assert!(page.contains(&digest) && page.contains("connected by shared faces"));
    let answer = folder.run(&["check", "d.paving", "--format", "json"]).exits(0).stdout;
    let answer: Value = serde_json::from_str(&answer).unwrap();
    let share = answer["inner_share"].as_str().unwrap();
    let (p, q) = share.split_once('/').unwrap();
    let share = p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap();
    assert!((inner_volume(&page) / share - 1.0).abs() < 1e-12, "{share}");
    for name in ["design", "region", "slices"] {
        let svg = String::from_utf8(folder.read(&format!("svg/{name}.svg"))).unwrap();
        assert!(
            svg.ends_with("</svg>\n") && !svg.contains("var(") && !svg.contains("NaN"),
            "{name}"
        );
    }
}

#[test]
fn volumes_have_the_unit_of_the_design_beside_the_paving() {
    let folder = Folder::new();
    let design = |unit: &str, length: &str| {
        let design = crate::paving::DESIGN.replace("leg_length = 1", length);
        folder.write("d.toml", format!("title = \"Mine\"\nunit = \"{unit}\"\n{design}"));
    };
    let page = || {
        folder.run(&["report", "d.paving"]).exits(0);
        String::from_utf8(folder.read("d.paving.report.html")).unwrap()
    };
    design("mm", "leg_length = 1");
    // Searched in another box than the workspace.
    let pave = ["pave", "d.toml", "--precision", "0.3", "--box", "-0.7,0.6,-0.7,0.7,-0.7,0.7"];
    let paved = folder.run(&pave).exits(0).stdout;
    let volumes = paved.split(", gap").next().unwrap().strip_prefix("volume: ").unwrap();
    assert!(volumes.ends_with(" mm^3"), "{volumes}");
    let volumes = volumes.replace("mm^3", "mm\u{b3}");
    let own = page();
    assert!(own.contains(&format!("CERTIFIED: volume {volumes}")) && own.contains("Mine"));
    design("mm", "leg_length = 2");
    let other = page();
    assert!(!other.contains("mm\u{b3}") && !other.contains("Mine"), "another design's");
}

/// A fine paving is drawn coarser than it is: the page says so, and claims no more than is proved.
#[test]
fn the_picture_of_a_fine_paving_stays_within_it() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    folder.run(&["pave", "d.toml", "--volume-gap", "0.04"]).exits(0);
    folder.run(&["report", "d.paving", "-o", "a.html"]).exits(0);
    let page = String::from_utf8(folder.read("a.html")).unwrap();
    assert!(page.len() < 5_000_000, "{}", page.len());
    assert!(page.contains("The inner part is larger than its picture"));
    let answer = folder.run(&["check", "d.paving", "--format", "json"]).exits(0).stdout;
    let answer: Value = serde_json::from_str(&answer).unwrap();
    let (p, q) = answer["inner_share"].as_str().unwrap().split_once('/').unwrap();
    let share = p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap();
    let drawn = inner_volume(&page);
    assert!(drawn < share && drawn > 0.9 * share, "{drawn} of {share}");
}

#[test]
fn a_rejected_paving_gets_no_page() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    folder.run(&["pave", "d.toml", "--precision", "0.2"]).exits(0);
    let bytes = folder.read("d.paving");
    folder.write("cut.paving", &bytes[..bytes.len() - 1]);
    folder.run(&["report", "cut.paving"]).exits(5).complains(&["REJECTED", "no report is written"]);
    // Legs of half the length: the boxes that were inner are not.
    let text = bytes.windows(12).position(|w| w == b"\"length\":\"1\"").unwrap();
    let mut other = bytes.clone();
    other[text + 10] = b'2';
    folder.write("other.paving", &other);
    folder.run(&["report", "other.paving"]).exits(5).complains(&["REJECTED"]);
    folder.run(&["report", "d.paving", "-o", "d.paving"]).exits(2);
    assert_eq!(folder.names(), ["cut.paving", "d.paving", "d.toml", "other.paving"]);
}
