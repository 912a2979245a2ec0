//! Verdicts: of the paper's cube for every `psi_max`, in any unit of length.

use super::{cube, verdict, verified};
use orthocert::search::accepted::check;
use orthocert::search::solver::Answer;
use orthocert_checker::certificate::{Proof, Verdict};
use orthocert_checker::read;
use orthocert_kernel::certificate::{self as kernel, Step};

/// With the leaves of each tree and the boxes tried, as they are now: they may fall, and rise up to
/// 40 boxes where there is a reason.
#[test]
fn the_paper_s_cube_is_certified_for_every_psi_max() {
    let mut wrong = Vec::new();
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
        if (accepted.size.leaves, found.boxes) != (leaves, boxes) {
            wrong.push((psi_max, accepted.size.leaves, found.boxes));
        }
        // What is written is what was checked.
        let text = certificate.to_text().unwrap();
        assert!(text.len() <= 10_000, "psi_max = {psi_max}: {} bytes", text.len());
        assert_eq!(check(&read(text.as_bytes()).unwrap()).as_ref(), Ok(accepted));
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn the_unit_of_length_does_not_matter() {
    // Numbers of the evidence depend on the power of two that is the problem's unit.
    let tree = |side: &str| match verified(&cube("2", side), 1000).answer {
        Answer::Decided { certificate, .. } => match certificate.proof {
            Proof::Tree(tree) => {
                let name = |Step(obligation, evidence): &Step| (*obligation, evidence.name());
                let node = |node: &kernel::Node| {
                    (node.split, node.by.iter().map(name).collect::<Vec<_>>())
                };
                tree.nodes.iter().map(node).collect::<Vec<_>>()
            }
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    };
    let expected = tree("200");
    for side in ["1", "1/3", "1e-30", "123456789", "200*sqrt(2)"] {
        assert_eq!(tree(side), expected, "side {side}");
    }
}
