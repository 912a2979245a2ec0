//! The document of the format: its instance, its limits, its tables.

use orthocert_kernel::certificate::MOST_WORK;
use orthocert_kernel::certificate::{
    Certificate, Claim, Evidence, MOST_BYTES, MOST_LABEL, MOST_NODES, PRECISIONS,
};
use orthocert_kernel::check::check;
use orthocert_kernel::number;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::TABLE;
use orthocert_kernel::slope::MOST_COORDINATES;

const DOCUMENT: &str = include_str!("../../../FORMAT.md");

/// The certificate of the worked instance.
fn instance() -> Certificate {
    let (_, rest) = DOCUMENT.split_once("```json\n").expect("an instance");
    let (text, _) = rest.split_once("```").expect("its end");
    Certificate::read(text).expect("canonical")
}

#[test]
fn the_instance_is_accepted_and_has_the_numbers_that_are_shown() {
    let certificate = instance();
    check(&certificate).expect("accepted");
    let Claim::Machine(claim) = &certificate.claim else { panic!("a machine") };
    let problem = Problem::new(claim).expect("well formed");
    for (j, x) in problem.parameters::<i64>(32, &[]).expect("words").iter().enumerate() {
        assert!(DOCUMENT.contains(&format!("[{}, {}]", x.lo, x.hi)), "parameter {j}");
    }
    let root = problem.root::<i64>(32).expect("words");
    for edge in &root.0 {
        assert!(DOCUMENT.contains(&format!("[{}, {}]", edge.lo, edge.hi)));
    }
    let [lower, _] = root.halves(0).expect("halves");
    assert!(DOCUMENT.contains(&format!("halved at {}.", lower.0[0].hi)));
}

#[test]
fn the_limits_are_those_of_the_checker() {
    let (least, greatest) = (PRECISIONS.start(), PRECISIONS.end());
    let (bytes, name) = (number::MOST_BYTES, number::MOST_NAME);
    for row in [
        format!(
            "| bytes of a file, of a number, of a name in it | {MOST_BYTES}, {bytes}, {name} |"
        ),
        format!("| binary operators of a number | {} |", number::MOST_OPERATIONS),
        format!("| nested parentheses, roots and signs of a number | {} |", number::MOST_DEPTH),
        format!("| bytes of a string of the provenance | {MOST_LABEL} |"),
        format!("| coordinates; legs or joints; bodies | {MOST_COORDINATES}, 12, 24 |"),
        format!("| precision, least and greatest | {least}, {greatest} |"),
        format!("| nodes of a tree | {MOST_NODES} |"),
        format!("| work | {MOST_WORK} |"),
    ] {
        assert!(DOCUMENT.contains(&row), "{row}");
    }
}

#[test]
fn every_quantity_and_the_names_of_evidence_are_described() {
    for quantity in TABLE {
        assert!(DOCUMENT.contains(&format!("`{}`", quantity.key)), "{}", quantity.key);
        for given in quantity.given {
            assert!(DOCUMENT.contains(&format!("`{given}`")), "{given}");
        }
    }
    for evidence in [
        Evidence::Test,
        Evidence::Divided,
        Evidence::Chords,
        Evidence::Negative,
        Evidence::Cube,
        Evidence::Outside,
    ] {
        assert!(DOCUMENT.contains(&format!("`\"{}\"`", evidence.name())), "{}", evidence.name());
    }
}
