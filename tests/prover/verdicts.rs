//! Verdicts: of the designs in `tests/designs`, and of the paper's cube for every `psi_max`.

use super::machines::cube;
use super::{verdict, verified};
use orthocert::design::Design;
use orthocert::verify::Answer;
use orthocert_checker::certificate::Verdict;
use orthocert_checker::{check, read};
use std::path::Path;

#[test]
fn designs_have_their_stated_verdicts() {
    let (certified, refuted) = (Verdict::Certified, Verdict::Refuted);
    for (name, expected, most_boxes) in [
        ("orthoglide-prototype", certified, 40),
        ("orthoglide-312", certified, 60),
        ("orthoglide-relaxed-10-percent", certified, 60),
        ("orthoglide-relaxed-1-percent", certified, 60),
        ("orthoglide-relaxed-0.1-percent", certified, 60),
        ("orthoglide-relaxed-1e-6", certified, 100),
        ("orthoglide-relaxed-1e-9", certified, 150),
        // A leg of 310.58 mm is what the cube of 200 mm needs: both are too short.
        ("orthoglide-310", refuted, 0),
        ("orthoglide-310.25-published", refuted, 0),
    ] {
        let file = format!("{}/tests/designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let design = Design::read(Path::new(&file)).unwrap();
        let claim = design.rules.as_ref().unwrap();
        let found = verified(claim, 20_000);
        assert_eq!(verdict(&found), Some(expected), "{name}");
        assert!(found.boxes <= most_boxes, "{name}: {} boxes", found.boxes);
    }
}

/// With the leaves of each tree and the boxes tried, as they are now: they may fall, and rise up to
/// 40 boxes where there is a reason.
#[test]
fn the_paper_s_cube_is_certified_for_every_psi_max() {
    for (psi_max, leaves, boxes) in [
        ("1.000001", 1, 1),
        ("1.0001", 1, 1),
        ("1.01", 1, 1),
        ("1.37", 1, 1),
        ("1.5", 1, 1),
        ("1.99", 5, 9),
        ("2", 5, 9),
        ("2.01", 5, 9),
        ("7/3", 5, 9),
        ("3", 7, 13),
        ("6", 8, 15),
        ("17", 9, 17),
        ("100", 9, 17),
        ("1000", 9, 17),
    ] {
        let found = verified(&cube(psi_max, "200"), 1000);
        assert_eq!(verdict(&found), Some(Verdict::Certified), "psi_max = {psi_max}");
        let Answer::Decided { certificate, accepted } = &found.answer else { unreachable!() };
        assert_eq!((accepted.size.leaves, found.boxes), (leaves, boxes), "psi_max = {psi_max}");
        assert!(found.boxes <= 40);
        // What is written is what was checked.
        let text = certificate.to_text().unwrap();
        assert!(text.len() <= 10_000, "psi_max = {psi_max}: {} bytes", text.len());
        assert_eq!(check(&read(text.as_bytes()).unwrap()).as_ref(), Ok(accepted));
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let nodes = |side: &str| match verified(&cube("2", side), 1000).answer {
        Answer::Decided { certificate, .. } => certificate.proof,
        other => panic!("{other:?}"),
    };
    let expected = nodes("200");
    for side in ["1", "1/3", "1e-30", "123456789", "200*sqrt(2)"] {
        assert_eq!(nodes(side), expected, "side {side}");
    }
}
