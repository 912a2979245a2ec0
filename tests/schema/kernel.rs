//! The schema: the instance of the format's document, every form of evidence, and
//! texts that are not of the shape.

use super::objection;
use orthocert_kernel::certificate::{
    Certificate, Claim, Corner, Evidence, Failure, Node, Part, Proof, Step, Tree, Verdict, Witness,
};
use orthocert_kernel::claim::NoCubeClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::test::Multiplier;
use serde_json::Value;

/// The certificate of the worked instance.
fn instance() -> Certificate {
    let document = include_str!("../../proofs/FORMAT.md");
    let (_, rest) = document.split_once("```json\n").expect("an instance");
    let (text, _) = rest.split_once("```").expect("its end");
    Certificate::read(text).expect("canonical")
}

fn holds(certificate: &Certificate) {
    let value = serde_json::to_value(certificate).expect("JSON");
    if let Some(objection) = objection(&value) {
        panic!("{objection}: {value}");
    }
}

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).expect("a number")
}

#[test]
fn it_describes_every_form_of_evidence_and_of_failure() {
    let good = instance();
    holds(&good);
    let y = Multiplier { y: vec![vec![1, -2], vec![i64::MIN, i64::MAX]], places: 63 };
    let about = |evidence: Evidence| Box::new(evidence);
    let evidence = vec![
        Evidence::Test,
        Evidence::Divided,
        Evidence::Lower(y.clone()),
        Evidence::LowerDivided(y.clone()),
        Evidence::Rank(y.clone()),
        Evidence::Chords,
        Evidence::Conditioning(y.clone(), vec![3, 0, -1]),
        Evidence::Accuracy(y.clone(), 1, 0),
        Evidence::Direction(y.clone()),
        Evidence::Negative,
        Evidence::Cube,
        Evidence::Mirror,
        Evidence::Corner(Corner::Q1),
        Evidence::Corner(Corner::Q2),
        Evidence::Outside,
        Evidence::Tolerances(about(Evidence::Test), "-0+1<=>".to_owned(), vec![vec![-3, i64::MAX]]),
        Evidence::Together(about(Evidence::Test), vec![vec![], vec![i64::MIN, 1, 2]], 63),
        Evidence::Fan(vec![Part(vec![i64::MIN, 1], 1, 63, Evidence::Test)]),
        Evidence::Between(
            vec![3, 0, -1],
            63,
            vec![vec![0, -7], vec![i64::MAX, 1]],
            about(Evidence::Test),
            about(Evidence::Test),
        ),
        Evidence::Inside(about(Evidence::Test), 1, 0),
        Evidence::Control(about(Evidence::Turned(about(Evidence::Test), 1, 63))),
    ];
    let by = evidence.into_iter().map(|evidence| Step(0, evidence)).collect();
    let node = Node { by, ..Node::default() };
    let tree = Tree { precision: 32, chords: Some(y.clone()), nodes: vec![node] };
    holds(&Certificate { proof: Proof::Tree(tree.clone()), ..good.clone() });
    let point = vec![number("-1/3"), number("sqrt(2)*1.5")];
    let failures = [
        Failure::Reach,
        Failure::Obligation(0, vec![vec![1, -1]]),
        Failure::Row(1, 0),
        Failure::Same {
            obligation: 1,
            least: point.clone(),
            greatest: point.clone(),
            inverse: y.clone(),
        },
        Failure::Singular(point.clone()),
        Failure::Dependent,
    ];
    for fails in failures {
        let Claim::Machine(machine) = good.claim.clone() else { panic!("a machine") };
        let no_cube = NoCubeClaim { machine, side: number("2") };
        let moved = Node { fails: Some(fails.clone()), at: vec![-8, 0, 8], ..Node::default() };
        let proof = Proof::Tree(Tree { nodes: vec![moved], ..tree.clone() });
        holds(&Certificate { claim: Claim::NoCube(no_cube), proof, ..good.clone() });
        let machine = vec![number("10")];
        let witness = Witness { precision: 64, point: point.clone(), machine, fails };
        let proof = Proof::Witness(witness);
        holds(&Certificate { verdict: Verdict::Refuted, proof, ..good.clone() });
    }
}

#[test]
fn it_objects_to_what_is_not_of_the_shape() {
    let good = instance().to_text().expect("a text");
    for (defect, from, to) in [
        ("verdict of the other kind", r#""certified""#, r#""refuted""#),
        ("requirements under another key", r#""require":["#, r#""requirements":["#),
        ("split by a name", r#""split":0"#, r#""split":"x""#),
        ("split of a coordinate before the first", r#""split":0"#, r#""split":-1"#),
        ("split and failure", r#""split":0"#, r#""split":0,"fails":"reach""#),
        ("unknown evidence", r#"{"lower":"#, r#"{"upper":"#),
        ("evidence that stands alone", r#"[1,"test"]"#, r#""test""#),
        ("places beyond 63", r#""places":14"#, r#""places":64"#),
        ("precision below 32", r#""precision":32"#, r#""precision":31"#),
        ("unknown quantity", r#""transmission""#, r#""transmissions""#),
        ("bound of another end", r#""end":"max","bound":"1.4""#, r#""end":"within","bound":"1.4""#),
        ("bound of none", r#""end":"max","bound":"1.4""#, r#""end":"holds","bound":"1.4""#),
        ("no bound", r#""end":"max","bound":"1.4""#, r#""end":"max""#),
        ("leg 0", r#""leg":2"#, r#""leg":0"#),
        ("unknown given", r#""leg":2"#, r#""leg":2,"given":{"speeds":["1"]}"#),
        ("nothing given", r#""leg":2"#, r#""leg":2,"given":{}"#),
        ("number with a needless zero", r#""9.9""#, r#""9.90""#),
        ("number that is a number", r#""10","mode""#, r#"10,"mode""#),
        ("mode", r#""mode":"+""#, r#""mode":"plus""#),
        ("vector of one entry", r#""anchor":["0","0"]"#, r#""anchor":["0"]"#),
        ("strut with a length", r#""drive":"slider""#, r#""drive":"strut""#),
        ("unknown workspace", r#"{"box":"#, r#"{"boxes":"#),
        ("unknown key", r#""precision":32"#, r#""precision":32,"bits":32"#),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{defect}");
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert!(objection(&value).is_some(), "{defect}");
    }
}
