//! What is exported to Rocq, and what is refused. That the files prove what they state is for Rocq
//! to say: `proofs/rocq/instances`.

use orthocert::export::rocq::{rocq, ExportError};
use orthocert_checker::read;

fn certificate(workspace: &str, requirements: &str, nodes: &str) -> String {
    let leg = |direction: &str| {
        format!(
            r#"{{"drive":"slider","direction":{direction},"anchor":["0","0","0"],"platform":["0","0","0"],"length":{{"min":"3113/10","max":"3117/10"}},"mode":"+"}}"#
        )
    };
    let legs = [r#"["1","0","0"]"#, r#"["0","1","0"]"#, r#"["0","0","1"]"#].map(leg).join(",");
    format!(
        r#"{{"format":"orthocert/2","claim":{{"machine":{{"mechanism":{{"translational":[{legs}]}},"workspace":{workspace},"requirements":{requirements}}}}},"verdict":"certified","proof":{{"tree":{{"precision":64,"nodes":{nodes}}}}},"provenance":{{"tool":"orthocert","version":"0.1.0"}}}}"#
    )
}

const BOX: &str = r#"{"box":{"min":["-1","-1","-1"],"max":["1","1","1/2"]}}"#;
const TRANSMISSION: &str = r#"{"transmission":{"min":"1/2","max":"2"}}"#;
const LOWER: &str = r#"{"lower":{"q":[1,0,0,-2],"sign":"-"}}"#;

fn exported(text: &str) -> Result<String, ExportError> {
    rocq(&read(text.as_bytes()).expect("a certificate"))
}

#[test]
fn the_claim_and_the_tree_are_written_and_the_theorem_has_no_tree_in_it() {
    let nodes =
        format!(r#"[{{"by":["upper"],"split":"y"}},{{"by":[{LOWER}]}},{{"by":[{LOWER}]}}]"#);
    let text = exported(&certificate(BOX, TRANSMISSION, &nodes)).expect("exported");
    assert!(text.contains("(Within (3113 // 10) (3117 // 10))"));
    assert!(text.contains("(Within ((-1) // 1) (1 // 2))"));
    assert!(text.contains("MachineClaim leg_1 leg_2 leg_3 box (Some (1 // 2)) (Some (2 // 1))"));
    assert!(text.contains("(Split [Upper] AlongY\n    (Leaf [Lower (1) (0) (0) (-2) false])"));
    let (_, theorem) = text.split_once("Theorem certified").expect("a theorem");
    let (statement, _) = theorem.split_once("Proof.").expect("a proof");
    assert!(!statement.contains("certificate"));
    assert!(statement.contains("sigma_at_least (1 / value (2 // 1)) (Jinv m P)"));
    assert!(statement.contains("sigma_at_most (1 / value (1 // 2)) (Jinv m P)"));
}

#[test]
fn other_claims_and_broken_trees_are_refused() {
    let leaf = format!(r#"[{{"by":[{LOWER}]}}]"#);
    let cylinder = r#"{"cylinder":{"center":["0","0"],"radius":"1","z":["0","1"]}}"#;
    assert_eq!(exported(&certificate(cylinder, TRANSMISSION, &leaf)), Err(ExportError::NotABox));
    let margin = r#"{"transmission":{"max":"2"},"serial_margin":{"min":"1/2"}}"#;
    assert_eq!(exported(&certificate(BOX, margin, &leaf)), Err(ExportError::NotTransmission));
    assert_eq!(exported(&certificate(BOX, "{}", &leaf)), Err(ExportError::NotTransmission));
    for nodes in [r#"[{"split":"x"},{}]"#, "[{},{}]"] {
        let refused = exported(&certificate(BOX, TRANSMISSION, nodes));
        assert_eq!(refused, Err(ExportError::NotATree), "{nodes}");
    }
    let speed = r#"[{"by":["speed"]}]"#;
    assert_eq!(exported(&certificate(BOX, TRANSMISSION, speed)), Err(ExportError::Rule("speed")));
}

/// The statement of `certified`, without its proof.
fn statement(text: &str) -> &str {
    let (_, theorem) = text.split_once("Theorem certified").expect("a theorem");
    theorem.split_once("Proof.").expect("a proof").0
}

#[test]
fn the_postulate_is_refused() {
    let text = include_str!("../proofs/certificates/postulate-all.cert.json");
    let refused = exported(text).expect_err("refused");
    assert_eq!(refused, ExportError::Postulate);
    assert!(refused.to_string().contains("Q1/Q2 postulate"));
}

const FOUR: &str = include_str!("../proofs/rocq/instances/FourSliders.cert.json");

#[test]
fn certificates_of_the_kernel_are_written_as_the_instances_of_the_formal_development() {
    for (certificate, instance) in [
        (FOUR, include_str!("../proofs/rocq/instances/FourSliders.v")),
        (
            include_str!("../proofs/rocq/instances/StrutsAndPlane.cert.json"),
            include_str!("../proofs/rocq/instances/StrutsAndPlane.v"),
        ),
    ] {
        let text = exported(certificate).expect("exported");
        assert_eq!(text, instance);
        assert!(!statement(&text).contains("certificate"));
    }
}

#[test]
fn claims_of_the_kernel_that_its_formal_side_lacks_are_refused_with_what_is_missing() {
    let replaced = |from: &str, to: &str| {
        let text = FOUR.replacen(from, to, 1);
        assert_ne!(text, FOUR, "{from}");
        exported(&text)
    };
    let margin = r#""quantity":"serial_margin""#;
    let refused = replaced(r#""quantity":"joint_range""#, margin).expect_err("refused");
    assert_eq!(refused, ExportError::Quantity("serial_margin"));
    assert!(refused.to_string().contains("\"serial_margin\""));
    let cylinder = r#""cylinder":{"center":["0","0"],"radius":"60","z":["0","200"]}"#;
    let workspace = r#""box":{"min":["-60","-60","0"],"max":["60","60","200"]}"#;
    assert_eq!(replaced(workspace, cylinder), Err(ExportError::KernelNotABox));
    let step = r#"[2,"test"]"#;
    assert_eq!(replaced(step, r#"[2,"cube"]"#), Err(ExportError::Rule("cube")));
    assert_eq!(replaced(r#","split":1}"#, "}"), Err(ExportError::NotATree));
}
