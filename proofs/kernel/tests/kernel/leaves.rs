//! Leaves for both bounds, 1, 0.1 and 0.01 % beyond the extremes.

use crate::certificates::claim;
use crate::prover::Prover;
use orthocert_kernel::certificate::{Evidence, Step};
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;

pub fn slider(direction: [&str; 3], anchor: [&str; 3], length: &str, mode: &str) -> String {
    format!(
        r#"{{"drive":"slider","direction":{direction:?},"anchor":{anchor:?},"platform":["0","0","0"],"length":"{length}","mode":"{mode}"}}"#
    )
}

pub fn machine(legs: &[String], workspace: &str) -> MachineClaim {
    let legs = legs.join(",");
    claim(&format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{workspace},"require":[]}}"#
    ))
}

pub fn linear_delta(workspace: &str) -> MachineClaim {
    let leg = |x: &str, y: &str| slider(["0", "0", "1"], [x, y, "0"], "333", "-");
    let legs = [
        leg("-174.75*sqrt(3)/2", "-174.75/2"),
        leg("174.75*sqrt(3)/2", "-174.75/2"),
        leg("0", "174.75"),
    ];
    machine(&legs, workspace)
}

pub fn orthoglide() -> MachineClaim {
    let leg = |n: [&str; 3]| slider(n, ["0", "0", "0"], "310.7", "+");
    let legs = [leg(["1", "0", "0"]), leg(["0", "1", "0"]), leg(["0", "0", "1"])];
    machine(&legs, r#"{"box":{"min":["-72","-72","-72"],"max":["125","125","125"]}}"#)
}

pub fn struts() -> MachineClaim {
    let leg =
        |a: [&str; 3]| format!(r#"{{"drive":"strut","anchor":{a:?},"platform":["0","0","0"]}}"#);
    let legs = [leg(["-300", "-180", "0"]), leg(["310", "-170", "10"]), leg(["5", "340", "-5"])];
    machine(&legs, r#"{"box":{"min":["-60","-60","180"],"max":["60","60","260"]}}"#)
}

pub fn rotary() -> MachineClaim {
    let leg = |axis: [&str; 3], e: [&str; 3], a: [&str; 3]| {
        format!(
            r#"{{"drive":"arm","axis":{axis:?},"reference":{e:?},"anchor":{a:?},"platform":["0","0","0"],"arm":"10","length":"14","mode":"+"}}"#
        )
    };
    let legs = [
        leg(["1", "0", "0"], ["0", "1", "0"], ["0", "4", "0"]),
        leg(["-1/2", "sqrt(3)/2", "0"], ["-sqrt(3)/2", "-1/2", "0"], ["-2*sqrt(3)", "-2", "0"]),
        leg(["-1/2", "-sqrt(3)/2", "0"], ["sqrt(3)/2", "-1/2", "0"], ["2*sqrt(3)", "-2", "0"]),
    ];
    machine(&legs, r#"{"box":{"min":["-3","-3","-14"],"max":["3","3","-10"]}}"#)
}

#[test]
fn leaves() {
    let cylinder = r#"{"cylinder":{"center":["0","0"],"radius":"80","z":["0","1"]}}"#;
    let slab = r#"{"box":{"min":["-60","-60","0"],"max":["60","60","1"]}}"#;
    for (name, claim, most) in [
        ("linear Delta", linear_delta(slab), [22, 55, 95]),
        ("linear Delta, cylinder", linear_delta(cylinder), [49, 110, 167]),
        ("struts", struts(), [16, 38, 62]),
        ("Orthoglide", orthoglide(), [14, 17, 17]),
        ("rotary Delta", rotary(), [220, 440, 720]),
    ] {
        let problem = Problem::new(&claim).expect("a claim");
        let [least, greatest] = Prover::new(&problem).extremes();
        // Of arms, M is an angle per length.
        let scale = if problem.legs[0].is_angular() { (problem.scale as f64).exp2() } else { 1.0 };
        for (part, most) in [1e-2, 1e-3, 1e-4].into_iter().zip(most) {
            let bound = |x: f64| {
                Expression::try_from(format!("{:.9}", x).trim_end_matches('0').to_owned())
                    .expect("a number")
            };
            let require = |bound: Bound| Requirement {
                quantity: "transmission".to_owned(),
                leg: None,
                given: Default::default(),
                bound,
            };
            let mut claim = claim.clone();
            claim.require = vec![
                require(Bound::Min(bound(scale / greatest * (1.0 - part)))),
                require(Bound::Max(bound(scale / least * (1.0 + part)))),
            ];
            let certificate = crate::prover::certify(&claim, 4 * most).expect("a proof");
            orthocert_kernel::check::check(&certificate).expect("accepted");
            let orthocert_kernel::certificate::Proof::Tree(tree) = &certificate.proof else {
                panic!("a tree")
            };
            let leaves: Vec<_> = tree.nodes.iter().filter(|node| node.split.is_none()).collect();
            let outside = [Step(0, Evidence::Outside)];
            let outside = leaves.iter().filter(|node| node.by == outside).count();
            let bytes = certificate.to_text().expect("a text").len();
            println!("{name} {part}: {} leaves, {outside} outside, {bytes} bytes", leaves.len());
            assert!(leaves.len() <= most, "{name} {part}: {} leaves", leaves.len());
        }
    }
}
