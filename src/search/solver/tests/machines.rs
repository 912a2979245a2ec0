//! Machines of the tests, as claims without requirements.

use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;
use std::collections::BTreeMap;

/// A claim by its text.
pub fn claim(text: &str) -> MachineClaim {
    serde_json::from_str(text).expect("a claim")
}

pub fn decimal(x: f64) -> Expression {
    let text = format!("{x:.9}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    Expression::try_from(text.to_owned()).expect("a number")
}

pub fn require(quantity: &str, bound: Bound) -> Requirement {
    Requirement { quantity: quantity.to_owned(), leg: None, given: BTreeMap::new(), bound }
}

/// The claim with these bounds on psi.
pub fn with_psi(claim: &MachineClaim, least: f64, greatest: f64) -> MachineClaim {
    let mut claim = claim.clone();
    claim.require = vec![
        require("transmission", Bound::Min(decimal(least))),
        require("transmission", Bound::Max(decimal(greatest))),
    ];
    claim
}

fn machine(legs: &[String], workspace: &str) -> MachineClaim {
    let legs = legs.join(",");
    claim(&format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{workspace},"require":[]}}"#
    ))
}

fn slider(direction: [&str; 3], anchor: [&str; 3], length: &str, mode: &str) -> String {
    format!(
        r#"{{"drive":"slider","direction":{direction:?},"anchor":{anchor:?},"platform":["0","0","0"],"length":{length},"mode":"{mode}"}}"#
    )
}

pub fn linear_delta(workspace: &str) -> MachineClaim {
    let leg = |x: &str, y: &str| slider(["0", "0", "1"], [x, y, "0"], "\"333\"", "-");
    let legs = [
        leg("-174.75*sqrt(3)/2", "-174.75/2"),
        leg("174.75*sqrt(3)/2", "-174.75/2"),
        leg("0", "174.75"),
    ];
    machine(&legs, workspace)
}

pub const SLAB: &str = r#"{"box":{"min":["-60","-60","0"],"max":["60","60","1"]}}"#;
pub const CYLINDER: &str = r#"{"cylinder":{"center":["0","0"],"radius":"80","z":["0","1"]}}"#;

/// With legs of this length, in JSON.
pub fn orthoglide(length: &str, workspace: &str) -> MachineClaim {
    let leg = |n: [&str; 3]| slider(n, ["0", "0", "0"], length, "+");
    let legs = [leg(["1", "0", "0"]), leg(["0", "1", "0"]), leg(["0", "0", "1"])];
    machine(&legs, workspace)
}

pub const CUBE: &str = r#"{"box":{"min":["-72","-72","-72"],"max":["125","125","125"]}}"#;

pub fn struts() -> MachineClaim {
    let leg =
        |a: [&str; 3]| format!(r#"{{"drive":"strut","anchor":{a:?},"platform":["0","0","0"]}}"#);
    let legs = [leg(["-300", "-180", "0"]), leg(["310", "-170", "10"]), leg(["5", "340", "-5"])];
    machine(&legs, r#"{"box":{"min":["-60","-60","180"],"max":["60","60","260"]}}"#)
}

/// Four struts over a square.
pub fn four_struts() -> MachineClaim {
    let leg = |x: &str, y: &str| {
        format!(r#"{{"drive":"strut","anchor":["{x}","{y}","0"],"platform":["0","0","0"]}}"#)
    };
    let legs = [leg("300", "300"), leg("-300", "300"), leg("-300", "-300"), leg("300", "-300")];
    machine(&legs, r#"{"box":{"min":["-100","-100","200"],"max":["100","100","350"]}}"#)
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

/// Joints by their coordinates.
pub fn formulas(
    coordinates: &[&str],
    definitions: &[(&str, &str)],
    rho: &[&str],
    workspace: &str,
) -> MachineClaim {
    let definitions: Vec<_> = definitions.iter().map(|(a, b)| [a, b]).collect();
    let joints: Vec<String> = rho.iter().map(|rho| format!(r#"{{"rho":"{rho}"}}"#)).collect();
    claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":{coordinates:?},"parameters":[],"definitions":{definitions:?},"joints":[{}]}}}},"workspace":{workspace},"require":[]}}"#,
        joints.join(",")
    ))
}

pub fn orthoglide_by_formulas() -> MachineClaim {
    let rho = ["x-sqrt(310.7^2-y^2-z^2)", "y-sqrt(310.7^2-x^2-z^2)", "z-sqrt(310.7^2-x^2-y^2)"];
    formulas(&["x", "y", "z"], &[], &rho, CUBE)
}

pub fn linear_delta_by_formulas() -> MachineClaim {
    let anchors = [("a", "174.75*sqrt(3)/2"), ("b", "174.75/2"), ("c", "174.75")];
    let rho = [
        "z+sqrt(333^2-(x+a)^2-(y+b)^2)",
        "z+sqrt(333^2-(x-a)^2-(y+b)^2)",
        "z+sqrt(333^2-x^2-(y-c)^2)",
    ];
    formulas(&["x", "y", "z"], &anchors, &rho, SLAB)
}

/// Legs of variable length from (-400, 0) and (400, 0).
pub fn five_bar() -> MachineClaim {
    let rho = ["sqrt((x+400)^2+y^2)", "sqrt((x-400)^2+y^2)"];
    formulas(&["x", "y"], &[], &rho, r#"{"box":{"min":["-100","200"],"max":["100","400"]}}"#)
}
