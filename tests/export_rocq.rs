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
        r#"{{"format":"orthocert/1","claim":{{"machine":{{"mechanism":{{"translational":[{legs}]}},"workspace":{workspace},"requirements":{requirements}}}}},"verdict":"certified","proof":{{"tree":{{"precision":64,"nodes":{nodes}}}}},"provenance":{{"tool":"orthocert","version":"0.1.0"}}}}"#
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
    for nodes in [r#"[{"split":"x"},{}]"#, "[{},{}]", r#"[{"split":"kappa"},{},{}]"#] {
        let refused = exported(&certificate(BOX, TRANSMISSION, nodes));
        assert_eq!(refused, Err(ExportError::NotATree), "{nodes}");
    }
    let speed = r#"[{"by":["speed"]}]"#;
    assert_eq!(exported(&certificate(BOX, TRANSMISSION, speed)), Err(ExportError::Rule("speed")));
}
