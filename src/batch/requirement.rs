//! What a design demands: one requirement a rule, with the line that demands it.

use crate::decimal::readable;
use crate::design::Design;
use orthocert_checker::certificate::Violation;
use orthocert_checker::claim::{Claim, Range, Requirements, Workspace};
use orthocert_checker::number::Exact;
use serde::Serialize;

/// A rule: its stable name, and what it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// The name, which is never given another meaning.
    pub id: &'static str,
    /// What holds where the rule is kept.
    pub says: &'static str,
}

/// Serial and parallel singularities.
pub const SINGULARITY: &str = "singularity";
/// A file that is no design.
pub const BAD_INPUT: &str = "bad-input";

/// Every rule, in the order of reports.
pub const RULES: [Rule; 9] = [
    Rule {
        id: SINGULARITY,
        says: "Every leg reaches every point of the workspace, without a serial or a parallel \
               singularity.",
    },
    Rule { id: "transmission", says: "The velocity transmission factors are within their bounds." },
    Rule { id: "joint-range", says: "The joint coordinates are within their ranges." },
    Rule { id: "conditioning", says: "The condition number of the Jacobian is within its bound." },
    Rule { id: "serial-margin", says: "The legs keep their distance from serial singularities." },
    Rule { id: "parallel-margin", says: "The legs' unit vectors span at least the volume." },
    Rule { id: "leg-angle", says: "The angles between legs and guides are within their bound." },
    Rule { id: "joint-speed", says: "The tool's speed demands no joint speed beyond the limit." },
    Rule { id: BAD_INPUT, says: "The file is a design." },
];

/// What is known of a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// The accepted certificate proves it on the whole workspace.
    Holds,
    /// The accepted certificate has a point where it fails.
    Fails,
    /// Neither is proved.
    Open,
}

/// A requirement of a design.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Requirement {
    /// The [`Rule`]'s name.
    pub rule: &'static str,
    /// The requirement with its bounds.
    pub demands: String,
    /// The line of the design that demands it.
    pub line: Option<usize>,
    /// What is known of it.
    pub standing: Standing,
}

/// What an accepted certificate says of a design as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// There is none.
    Nothing,
    /// It proves every requirement.
    Certified,
    /// It has a point at which the requirement of this [`Rule`] fails; of the others nothing is
    /// proved.
    Refuted(&'static str),
}

/// The requirements of a design, and what is known of each.
pub fn requirements(design: &Design, known: Known) -> Vec<Requirement> {
    let Claim::Machine(claim) = &design.claim else {
        return Vec::new();
    };
    let cube = matches!(claim.workspace, Workspace::Cube { .. });
    let demanded = demanded(&claim.requirements, cube, claim.mechanism.is_angular());
    let demanded = demanded.into_iter().map(|(rule, key, demands)| Requirement {
        rule,
        demands,
        line: design.sources.position(key).map(|at| at.line),
        standing: match known {
            Known::Certified => Standing::Holds,
            Known::Refuted(broken) if broken == rule => Standing::Fails,
            Known::Refuted(_) | Known::Nothing => Standing::Open,
        },
    });
    demanded.collect()
}

/// Rule, key of the design and bounds of everything that is demanded.
fn demanded(
    all: &Requirements,
    cube: bool,
    angular: bool,
) -> Vec<(&'static str, &'static str, String)> {
    let mut found = vec![(SINGULARITY, "requirements", "no singularity".to_owned())];
    let mut add = |rule, key, demands| found.push((rule, key, demands));
    if let Some(Range { min, max }) = &all.transmission {
        let min = match (cube, min) {
            (true, _) => Some("1/psi_max".to_owned()),
            (false, min) => min.as_ref().map(readable),
        };
        let demands = between(min, "psi", max.as_ref());
        add("transmission", "requirements.transmission", demands);
    }
    if let Some(ranges) = &all.joint_range {
        let leg = |(i, range): (usize, &Range)| {
            let name = format!("rho_{}", i + 1);
            between(range.min.as_ref().map(readable), &name, range.max.as_ref())
        };
        let legs: Vec<String> = ranges.iter().enumerate().map(leg).collect();
        let degrees = if angular { ", in degrees" } else { "" };
        add("joint-range", "requirements.joint_range", legs.join(", ") + degrees);
    }
    let at_most = |name: &str, max: &Exact| format!("{name} <= {}", readable(max));
    let at_least = |name: &str, min: &Exact| format!("{name} >= {}", readable(min));
    if let Some(bound) = &all.conditioning {
        let demands = at_most("condition number", &bound.max);
        add("conditioning", "requirements.conditioning", demands);
    }
    if let Some(bound) = &all.serial_margin {
        let demands = at_least("serial margin", &bound.min);
        add("serial-margin", "requirements.serial_margin", demands);
    }
    if let Some(bound) = &all.parallel_margin {
        let demands = at_least("parallel margin", &bound.min);
        add("parallel-margin", "requirements.parallel_margin", demands);
    }
    if let Some(bound) = &all.leg_angle {
        let demands = at_most("leg angle in degrees", &bound.max);
        add("leg-angle", "requirements.leg_angle", demands);
    }
    if let Some(speed) = &all.joint_speed {
        let unit = if angular { "joint speed in degrees per time" } else { "joint speed" };
        let demands = at_most(unit, &speed.max);
        add("joint-speed", "requirements.joint_speed", demands);
    }
    found
}

/// `1/2 <= psi <= 2`, or one side of it.
fn between(min: Option<String>, name: &str, max: Option<&Exact>) -> String {
    let (min, max) = (min.map(|min| format!("{min} <= ")), max.map(readable));
    let max = max.map(|max| format!(" <= {max}"));
    format!("{}{name}{}", min.unwrap_or_default(), max.unwrap_or_default())
}

/// The rule that a counterexample breaks.
pub fn broken(violation: &Violation) -> &'static str {
    match violation {
        Violation::SigmaMin(_) | Violation::SigmaMax(_) | Violation::Row(_) => "transmission",
        Violation::Reach(_) | Violation::Singular(_) => SINGULARITY,
        Violation::JointRange(_) => "joint-range",
        Violation::Conditioning(_) => "conditioning",
        Violation::SerialMargin(_) => "serial-margin",
        Violation::ParallelMargin => "parallel-margin",
        Violation::LegAngle(_) => "leg-angle",
        Violation::JointSpeed(_) => "joint-speed",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(name: &str) -> Vec<(&'static str, String, Option<usize>)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs");
        let design = Design::read(&folder.join(name)).unwrap();
        let all = requirements(&design, Known::Nothing).into_iter();
        all.map(|one| (one.rule, one.demands, one.line)).collect()
    }

    #[test]
    fn requirements_have_the_lines_of_their_keys() {
        let text = std::fs::read_to_string(
            Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs/orthoglide-joint-range.toml"),
        )
        .unwrap();
        let line = |key: &str| text.lines().position(|l| l.starts_with(key)).map(|i| i + 1);
        let found = of("orthoglide-joint-range.toml");
        let rules: Vec<_> = found.iter().map(|(rule, _, _)| *rule).collect();
        assert_eq!(rules, ["singularity", "transmission", "joint-range"]);
        for ((_, _, found), key) in
            found.iter().zip(["[requirements]", "transmission", "joint_range"])
        {
            let expected = line(key);
            assert!(expected.is_some());
            assert_eq!(*found, expected, "{key}");
        }
    }

    #[test]
    fn bounds_are_written_out() {
        let one = |name: &str| of(name).into_iter().nth(1).unwrap().1;
        assert_eq!(one("orthoglide-prototype.toml"), "1/psi_max <= psi <= 2");
        assert_eq!(one("orthoglide-310.toml"), "0.5 <= psi <= 2");
        assert_eq!(one("delta-conditioning-refuted.toml"), "condition number <= 2.6");
    }

    #[test]
    fn every_rule_has_its_own_name() {
        for (i, rule) in RULES.iter().enumerate() {
            assert!(RULES.iter().skip(i + 1).all(|other| other.id != rule.id));
        }
    }
}
