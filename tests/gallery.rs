//! The gallery: every design of tests/designs, and every template, gives the verdict that its first
//! lines state, with a certificate that the checker accepts when it is read back.

use crate::schema;
use orthocert::design::{Design, TEMPLATES};
use orthocert::search::solver::{verify, Answer};
use orthocert::search::{Budget, Control, Progress};
use orthocert_checker::certificate::{Certificate, Verdict};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Undecided designs are to stay so for want of precision, not of boxes.
const MAX_BOXES: usize = 2_000;

/// What a design's comment says of it, and the name of the file.
struct Stated {
    name: String,
    verdict: Option<Verdict>,
    text: String,
}

fn gallery(folder: &str) -> Vec<Stated> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut designs: Vec<Stated> = fs::read_dir(folder)
        .expect("the folder of designs")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| {
            let text = fs::read_to_string(&path).expect("a text");
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            let verdict = stated(&text).unwrap_or_else(|| panic!("{name} states no verdict"));
            Stated { name, verdict, text }
        })
        .collect();
    designs.sort_by(|a, b| a.name.cmp(&b.name));
    designs
}

/// The verdict of the line `# Verdict: certified`, `refuted` or `undecided`, perhaps with a reason.
fn stated(text: &str) -> Option<Option<Verdict>> {
    let line = text.lines().find_map(|line| line.strip_prefix("# Verdict: "))?;
    match line.split([',', ' ', ':', ';']).next()? {
        "certified" => Some(Some(Verdict::Certified)),
        "refuted" => Some(Some(Verdict::Refuted)),
        "undecided" => Some(None),
        _ => None,
    }
}

/// The verdict that the checker accepts from the certificate's text, and the number of nodes.
fn checked(certificate: &Certificate, name: &str) -> Verdict {
    let text = certificate.to_text().expect("a text");
    let read = orthocert_checker::read(text.as_bytes()).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(&read, certificate, "{name}");
    orthocert_checker::check(&read).unwrap_or_else(|reason| panic!("{name}: {reason}"));
    read.verdict
}

fn verdict(text: &str, name: &str) -> (Option<Verdict>, String) {
    let design = Design::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
    let claim = design.claim;
    let cancel = AtomicBool::new(false);
    let mut progress = |_: Progress| {};
    let mut control = Control { cancel: &cancel, progress: &mut progress };
    let budget = Budget { max_boxes: MAX_BOXES, deadline: None };
    let found = verify(&claim, budget, &mut control);
    let found = found.unwrap_or_else(|error| panic!("{name}: {error}"));
    let told = format!("{name}: {} boxes, worst {:?}", found.boxes, found.worst);
    match found.answer {
        Answer::Decided { certificate, .. } => {
            schema::holds(&certificate.to_text().expect("a text"), name);
            (Some(checked(&certificate, name)), told)
        }
        Answer::Undecided(rest) => {
            let open = rest.open.iter().take(3).map(|item| format!("{item:?}"));
            let open = open.collect::<Vec<_>>().join("\n  ");
            (None, format!("{told}; {:?}, {:?}\n  {open}", rest.stop, rest.objection))
        }
        Answer::Cancelled => panic!("{name}: cancelled by nobody"),
    }
}

#[test]
fn every_design_gives_its_stated_verdict() {
    let mut wrong = Vec::new();
    for Stated { name, verdict: expected, text } in gallery("tests/designs") {
        let (found, told) = verdict(&text, &name);
        println!("{name}: {found:?}");
        if found != expected {
            wrong.push(format!("{told}\n  expected {expected:?}, found {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_design_of_another_kind_gives_its_stated_verdict() {
    let designs = gallery("tests/designs/kernel");
    assert!(designs.len() >= 16, "{}", designs.len());
    for Stated { name, verdict: expected, text } in designs {
        let (found, told) = verdict(&text, &name);
        assert_eq!(found, expected, "{told}");
    }
}

#[test]
fn every_template_is_certified() {
    for (kind, text) in TEMPLATES {
        let (found, told) = verdict(text, kind);
        assert_eq!(found, Some(Verdict::Certified), "{told}");
    }
}
