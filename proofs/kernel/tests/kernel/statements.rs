//! What certificates say in words.

use crate::certificates::claim;
use crate::prover::{certificate, certify};
use crate::turning::{hexapod_legs, spatial};
use orthocert_kernel::certificate::{
    Certificate, Claim, Failure, Proof, Provenance, Verdict, Witness, FORMAT,
};
use orthocert_kernel::check::check;
use orthocert_kernel::number::Expression;
use orthocert_kernel::statement::{counterexample, statement};

const FIVE_BAR: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[["l",{"min":"199.95","max":"200.05"}]],"definitions":[["s","sqrt(l^2-y^2)"]],"joints":[{"rho":"x-s"},{"rho":"x+s"}]}},"workspace":{"box":{"min":["-50","80"],"max":["50","160"]}},"require":[{"quantity":"transmission","end":"max","bound":"3"}]}"#;

pub fn words(certificate: &Certificate) -> String {
    let Claim::Machine(claim) = &certificate.claim else { panic!("a machine") };
    let words = statement(claim, certificate.verdict);
    match &certificate.proof {
        Proof::Tree(_) | Proof::Atlas(_) => words,
        Proof::Witness(witness) => words + &counterexample(claim, witness),
    }
}

fn says(text: &str, sentences: &[&str]) {
    for sentence in sentences {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
}

#[test]
fn of_a_users_mechanism() {
    let certificate = certify(&claim(FIVE_BAR), 500).expect("a proof");
    check(&certificate).expect("accepted");
    says(
        &words(&certificate),
        &[
            "It is proved:",
            "  l in [199.95, 200.05]",
            "  s = sqrt(l^2-y^2)",
            "  joint 2: rho_2 = x+s",
            "from (-50, 80) to (50, 160)",
            "every formula is defined",
            "psi_i <= 3 (velocity transmission factors)",
        ],
    );
}

#[test]
fn of_a_refutation_with_its_machine() {
    let leg = |n: &str, length: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{length},"mode":"+"}}"#
        )
    };
    let legs = [
        leg(r#""1","0","0""#, r#"{"min":"310","max":"311"}"#),
        leg(r#""0","1","0""#, "\"310\""),
        leg(r#""0","0","1""#, "\"310\""),
    ]
    .join(",");
    let text = format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-72","-72","-72"],"max":["125","125","125"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"1.96"}}]}}"#
    );
    let number = |text: &str| Expression::try_from(text.to_owned()).expect("a number");
    let certificate = Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(claim(&text)),
        verdict: Verdict::Refuted,
        proof: Proof::Witness(Witness {
            precision: 96,
            point: ["125", "125", "125"].map(number).to_vec(),
            machine: vec![number("310")],
            fails: Failure::Obligation(0, vec![vec![1, -1, 0]]),
        }),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    };
    check(&certificate).expect("accepted");
    says(
        &words(&certificate),
        &[
            "the following is FALSE",
            "leg 1: slider, direction (1, 0, 0), anchor (0, 0, 0), platform (0, 0, 0), length in [310, 311], eta > 0",
            "independently of all others, directions",
            "with rho' = M P'",
            "It fails at (125, 125, 125)",
            "of the machine with leg 1: length = 310",
            "where transmission is violated",
        ],
    );
}

#[test]
fn of_bodies_and_of_what_is_given() {
    let leg = |x: &str, y: &str| {
        format!(
            r#"{{"drive":"slider","direction":["0","0","1"],"anchor":["{x}","{y}","0"],"platform":["0","0","0"],"length":"333","mode":"-"}}"#
        )
    };
    let legs = [leg("-150", "-87"), leg("150", "-87"), leg("0", "174")].join(",");
    let rods = r#"{"on":"leg","leg":1,"radius":"4","trim":["20","30"]},{"on":"leg","leg":2,"radius":"4","trim":["20","0"]},{"on":"base","from":["0","0","-9"],"to":["1","0","-9"],"radius":"5"},{"on":"platform","from":["0","0","-9"],"to":["0","0","-40"],"radius":"5"}"#;
    let text = |gap: &str| {
        format!(
            r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-5","-5","0"],"max":["5","5","1"]}}}},"bodies":[{rods}],"require":[{{"quantity":"clearance","end":"min","bound":"{gap}"}},{{"quantity":"accuracy","given":{{"joint_error":["0.01"]}},"end":"max","bound":"0.05"}},{{"quantity":"one_to_one","end":"holds"}}]}}"#
        )
    };
    let claim = claim(&text("2"));
    let witness = |number| {
        Proof::Witness(Witness {
            precision: 96,
            point: ["0", "0", "0"]
                .map(|x| Expression::try_from(x.to_owned()).expect("a number"))
                .to_vec(),
            machine: vec![],
            fails: Failure::Obligation(number, vec![vec![0, 1, 1]]),
        })
    };
    let text = |number| words(&certificate(&claim, Verdict::Refuted, witness(number)));
    says(
        &text(6),
        &[
            "body 1: all within 4 of leg 1, from 20 after its base end to 30 before its platform end",
            "body 3: all within 5 of the segment from (0, 0, -9) to (1, 0, -9)",
            "body 4: all within 5 of the segment from P + (0, 0, -9) to P + (0, 0, -40)",
            "that are not fixed to each other >= 2",
            "|P' - P| <= 0.05, joint_error = 0.01",
            "exactly one position",
            "no two poses of the workspace have the same joint coordinates (",
            "where of body 4 and body 3 clearance is violated",
        ],
    );
    says(&text(8), &["where one_to_one is violated"]);
}

/// A body on a platform that turns is turned with it.
#[test]
fn of_bodies_on_a_platform_that_turns() {
    let rods = r#"{"on":"leg","leg":1,"radius":"1/20","trim":["0","0"]},{"on":"platform","from":["0","0","1"],"to":["0","0","2"],"radius":"1/20"}"#;
    let require = r#"{"quantity":"clearance","end":"min","bound":"1"},{"quantity":"accuracy","given":{"joint_error":["1"],"max_angle":["3"]},"end":"max","bound":"2"}"#;
    let text = spatial(&hexapod_legs(), r#"{"angle":"5"}"#, require);
    let text = text.replace(r#""workspace""#, &format!(r#""bodies":[{rods}],"workspace""#));
    let witness = Proof::Witness(Witness {
        precision: 96,
        point: vec![Expression::integer(0); 6],
        machine: vec![],
        fails: Failure::Reach,
    });
    says(
        &words(&certificate(&claim(&text), Verdict::Refuted, witness)),
        &[
            "body 2: all within 1/20 of the segment from P + R (0, 0, 1) to P + R (0, 0, 2)",
            "|P' - P| <= 2, joint_error = 1, max_angle = 3",
            "where the platform turns, exactly one pose so near",
        ],
    );
}
