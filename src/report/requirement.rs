//! What a design demands: one requirement a rule, with the line that demands it.

use crate::design::Design;
use crate::report::shown;
use crate::search::solver::value::name_of;
use orthocert_kernel::claim as kernel;
use orthocert_kernel::quantity::{Quantity, TABLE};
use serde::Serialize;
use std::sync::LazyLock;

/// A rule: its stable name, and what it says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rule {
    /// The name, which is never given another meaning.
    pub id: String,
    /// What holds where the rule is kept.
    pub says: String,
}

/// Serial and parallel singularities.
pub const SINGULARITY: &str = "singularity";
/// A file that is no design.
pub const BAD_INPUT: &str = "bad-input";

/// What holds where the rules of these quantities are kept; of others, the table's own words say it.
const SENTENCES: [(&str, &str); 7] = [
    ("transmission", "The velocity transmission factors are within their bounds."),
    ("joint_range", "The joint coordinates are within their ranges."),
    ("conditioning", "The condition number of the Jacobian is within its bound."),
    ("serial_margin", "The legs keep their distance from serial singularities."),
    ("parallel_margin", "The legs' unit vectors span at least the volume."),
    ("leg_angle", "The angles between legs and guides are within their bound."),
    ("joint_speed", "The tool's speed demands no joint speed beyond the limit."),
];

/// Every rule, in the order of reports: singularities, the kernel's table of quantities, designs.
pub static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let rule = |id: &str, says: &str| Rule { id: id.to_owned(), says: says.to_owned() };
    let of = |quantity: &&Quantity| {
        let own = SENTENCES.iter().find(|(key, _)| *key == quantity.key);
        let says = match own {
            Some((_, says)) => (*says).to_owned(),
            None => format!("Within its bound: {}.", quantity.words),
        };
        rule(&quantity.key.replace('_', "-"), &says)
    };
    let singularity =
        "Every leg reaches every point of the workspace, without a serial or a parallel \
                       singularity.";
    let mut all = vec![rule(SINGULARITY, singularity)];
    all.extend(TABLE.iter().map(of));
    all.push(rule(BAD_INPUT, "The file is a design."));
    all
});

/// The rule of a quantity, by its key.
pub fn rule_of(quantity: &str) -> &'static str {
    let id = quantity.replace('_', "-");
    RULES.iter().find(|rule| rule.id == id).map_or(SINGULARITY, |rule| &rule.id)
}

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
    let demanded = demanded(&design.claim).into_iter().map(|(rule, key, demands)| Requirement {
        rule,
        demands,
        // A requirement of one leg has its line there.
        line: design
            .sources
            .position(&key)
            .or_else(|| design.sources.position("requirements"))
            .map(|at| at.line),
        standing: match known {
            Known::Certified => Standing::Holds,
            Known::Refuted(broken) if broken == rule => Standing::Fails,
            Known::Refuted(_) | Known::Nothing => Standing::Open,
        },
    });
    demanded.collect()
}

/// Rule, key of the design and bounds of everything that a claim demands: one a quantity of the table.
fn demanded(claim: &kernel::MachineClaim) -> Vec<(&'static str, String, String)> {
    let mut found = vec![(SINGULARITY, "requirements".to_owned(), "no singularity".to_owned())];
    for quantity in TABLE {
        let own: Vec<_> = claim.require.iter().filter(|own| own.quantity == quantity.key).collect();
        let texts: Vec<String> = match own[..] {
            [least, greatest] => between(least, greatest)
                .map_or_else(|| own.iter().map(|own| demands(own)).collect(), |both| vec![both]),
            _ => own.iter().map(|own| demands(own)).collect(),
        };
        if !texts.is_empty() {
            let key = format!("requirements.{}", quantity.key);
            found.push((rule_of(quantity.key), key, texts.join(", ")));
        }
    }
    found
}

/// `1/2 <= psi <= 2`, of two ends of the same.
fn between(least: &kernel::Requirement, greatest: &kernel::Requirement) -> Option<String> {
    match (&least.bound, &greatest.bound) {
        (kernel::Bound::Min(min), kernel::Bound::Max(_)) if least.leg == greatest.leg => {
            Some(format!("{} <= {}", shown(min), demands(greatest)))
        }
        _ => None,
    }
}

/// `psi <= 2`, `leg 1: rho >= 0`.
fn demands(own: &kernel::Requirement) -> String {
    let name = match own.quantity.as_str() {
        "transmission" => "psi".to_owned(),
        "joint_range" => "rho".to_owned(),
        quantity => name_of(quantity),
    };
    let leg = own.leg.map(|leg| format!("leg {leg}: ")).unwrap_or_default();
    match &own.bound {
        kernel::Bound::Min(bound) => format!("{leg}{name} >= {}", shown(bound)),
        kernel::Bound::Max(bound) => format!("{leg}{name} <= {}", shown(bound)),
        kernel::Bound::Within([min, max]) => {
            format!("{leg}{name} from {} to {} degrees", shown(min), shown(max))
        }
        kernel::Bound::Holds => format!("{leg}{name}"),
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
        assert_eq!(one("orthoglide-prototype.toml"), "0.5 <= psi <= 2");
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
