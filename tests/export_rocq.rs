//! What is exported to Rocq, and what is refused. That the files prove what they state is for Rocq
//! to say: `proofs/rocq/instances`.

use orthocert::report::export::rocq::{postulate, rocq, ExportError};
use orthocert_checker::read;
use orthocert_kernel::certificate::{Certificate, Claim, Proof};

fn exported(text: &str) -> Result<String, ExportError> {
    rocq(&read(text.as_bytes()).expect("a certificate"))
}

/// That the instance is the committed one; with `ORTHOCERT_WRITE` set, it is written first.
fn committed(file: &str, text: &str) {
    if std::env::var_os("ORTHOCERT_WRITE").is_some() {
        std::fs::write(file, text).expect("written");
    }
    assert_eq!(text, std::fs::read_to_string(file).expect("committed"));
}

/// The statement of `certified`, without its proof.
fn statement(text: &str) -> &str {
    let (_, theorem) = text.split_once("Theorem certified").expect("a theorem");
    theorem.split_once("Proof.").expect("a proof").0
}

/// A certificate of the postulate, as the instance that it is exported to.
fn postulate_of(psi_max: &str, nodes: &str) -> Result<String, ExportError> {
    let claim = serde_json::from_str(&format!(r#"{{"psi_max":{psi_max}}}"#)).expect("a claim");
    let tree = format!(r#"{{"precision":52,"nodes":{nodes}}}"#);
    postulate(&claim, &serde_json::from_str(&tree).expect("a tree"))
}

#[test]
fn the_postulate_is_written_as_the_instances_of_the_formal_development() {
    for name in ["PostulateAll", "PostulateUpTo2"] {
        let file = |end: &str| format!("proofs/rocq/instances/{name}{end}");
        let text = std::fs::read_to_string(file(".cert.json")).expect("committed");
        let certificate = Certificate::read(&text).expect("canonical");
        let (Claim::Postulate(claim), Proof::Tree(tree)) = (&certificate.claim, &certificate.proof)
        else {
            panic!("{name} is about the postulate");
        };
        let text = postulate(claim, tree).expect("exported");
        committed(&file(".v"), &text);
        assert!(!statement(&text).contains("trees"));
    }
}

const LEAF: &str = r#"{"by":[[0,"test"]]}"#;

#[test]
fn a_range_of_the_postulate_is_stated_up_to_its_greatest_psi_max() {
    let two = format!("[{LEAF},{LEAF}]");
    let text = postulate_of(r#"{"min":"1.5","max":"2"}"#, &two).expect("exported");
    assert!(statement(&text).contains("forall psi, 1 < psi <= 2 -> forall P, in_cube L psi P"));
    assert!(text.contains("check_postulate_up_to 52 (2 // 1) trees = true"));
    assert!(text.contains("Definition trees : list tree := [q1_high; q2_high]."));
    assert!(text.contains("Corollary at_greatest : forall L a e, 0 < L -> forall P, in_cube L 2 P"));
    assert!(text.contains("forall v, (1 / 2) ^ 2 * norm2 v <="));
    assert_eq!(postulate_of(r#""2""#, &two).as_ref(), Ok(&text));

    let four = format!("[{LEAF},{LEAF},{LEAF},{LEAF}]");
    let text = postulate_of(r#""2+sqrt(1/3)-0.5""#, &four).expect("exported");
    assert!(statement(&text).contains("1 < psi <= ((2 + (sqrt (1 / 3))) - (1 / 2)) ->"), "{text}");
    let exact = "value (Minus (Plus (2 // 1) (Root (Over (1 // 1) (3 // 1)))) (1 // 2)) =";
    assert!(text.contains(exact), "{text}");
    assert!(text.contains(":= [q1_low; q1_high; q2_low; q2_high]."));
}

#[test]
fn trees_that_the_postulate_does_not_need_are_refused() {
    let node = r#"{"split":0}"#;
    for nodes in [
        String::new(),
        LEAF.to_owned(),
        format!("{LEAF},{LEAF},{LEAF}"),
        format!("{node},{LEAF},{LEAF}"),
    ] {
        let refused = postulate_of(r#""2""#, &format!("[{nodes}]"));
        assert_eq!(refused, Err(ExportError::NotATree), "{nodes}");
    }
    let cube = r#"[{"by":[[0,"cube"]]},{"by":[[0,"cube"]]}]"#;
    assert_eq!(postulate_of(r#""2""#, cube), Err(ExportError::Evidence("cube")));
    assert_eq!(postulate_of(r#""1""#, "[]"), Err(ExportError::NotWellFormed));
}

const FOUR: &str = include_str!("../proofs/rocq/instances/FourSliders.cert.json");

#[test]
fn machines_are_written_as_the_instances_of_the_formal_development() {
    let instances = "proofs/rocq/instances";
    for (name, from) in [
        ("FourSliders", format!("{instances}/FourSliders")),
        ("StrutsAndPlane", format!("{instances}/StrutsAndPlane")),
        ("OrthoglideTolerance", format!("{instances}/OrthoglideTolerance")),
        ("LinearDelta", format!("{instances}/LinearDelta")),
        ("DeltaSpeed", "proofs/certificates/delta-joint-speed".to_owned()),
        ("DeltaMargin", "proofs/certificates/delta-parallel-margin".to_owned()),
        ("UpuAxes", "proofs/certificates/upu-base-axes".to_owned()),
    ] {
        let certificate = std::fs::read_to_string(format!("{from}.cert.json")).expect("committed");
        let text = exported(&certificate).expect("exported");
        committed(&format!("{instances}/{name}.v"), &text);
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
    let angle = r#""quantity":"leg_angle""#;
    let range = r#""quantity":"joint_range","leg":1,"end":"min","bound":"200""#;
    let refused =
        replaced(range, &format!(r#"{angle},"end":"max","bound":"80""#)).expect_err("refused");
    assert_eq!(refused, ExportError::Quantity("leg_angle"));
    assert!(refused.to_string().contains("\"leg_angle\""));
    let cylinder = r#""cylinder":{"center":["0","0"],"radius":"60","z":["0","200"]}"#;
    let workspace = r#""box":{"min":["-60","-60","0"],"max":["60","60","200"]}"#;
    let text = replaced(workspace, cylinder).expect("exported");
    assert!(text.contains("Cylinder (0 // 1) (0 // 1) (60 // 1) (Within (0 // 1) (200 // 1))"));
    let step = r#"[2,"test"]"#;
    assert_eq!(replaced(step, r#"[2,"cube"]"#), Err(ExportError::Evidence("cube")));
    assert_eq!(replaced(r#","split":1}"#, "}"), Err(ExportError::NotATree));
}
