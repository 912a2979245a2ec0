//! The rules by which a proof's boxes are closed, as figures show them.

use orthocert_kernel::certificate as kernel;
use serde::Serialize;

/// A rule as figures show it.
#[derive(Clone, Debug, Serialize)]
pub struct Rule {
    /// The rule's name in certificates.
    pub name: String,
    /// What it is used for, where that has to be said.
    #[serde(skip)]
    pub used_for: Option<String>,
    /// Its fill, distinct for those who do not tell colours apart (after Okabe and Ito).
    pub colour: &'static str,
    /// The number of its pattern: [`PATTERNS`].
    pub pattern: usize,
    /// The position of the obligation that it discharges; `None`: every one.
    #[serde(skip)]
    pub discharges: Option<usize>,
}

/// The rules by which boxes are closed, and the obligations that they discharge.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    /// A letter of a tree's code is a position here.
    pub rules: Vec<Rule>,
    /// Their names.
    pub obligations: Vec<String>,
}

/// A node of a tree: the positions of its rules, and the coordinate along which it is halved.
pub type Ruled = (Vec<u8>, Option<usize>);

/// The rule that a box is outside the workspace.
pub const OUTSIDE: &str = "outside";

/// Colours of a kernel proof's rules, in the order of their first use.
const COLOURS: [&str; 10] = [
    "#8ecae6", "#74c69d", "#f2e279", "#f4a340", "#b9a3d9", "#e8936b", "#9fd3c7", "#c9a66b",
    "#7da7d9", "#e5989b",
];

/// Most rules of a legend: letters of the code, and positions in the script's signed bytes.
const MOST_RULES: usize = 100;

impl Legend {
    /// The rules of a kernel proof: a kind of evidence for a requirement each. `of` has the position
    /// of the requirement that an obligation of this number belongs to.
    pub fn of_kernel(
        tree: &kernel::Tree,
        requirements: Vec<String>,
        of: &dyn Fn(usize) -> usize,
    ) -> (Self, Vec<Ruled>) {
        let mut legend = Legend { rules: Vec::new(), obligations: requirements };
        let mut position = |kernel::Step(number, evidence): &kernel::Step| {
            let is_outside = matches!(evidence, kernel::Evidence::Outside);
            let requirement = (!is_outside).then(|| of(*number));
            let name = evidence.name();
            let Legend { rules, obligations } = &mut legend;
            let known =
                rules.iter().position(|rule| rule.name == name && rule.discharges == requirement);
            let at = known.unwrap_or_else(|| {
                if rules.len() >= MOST_RULES {
                    return 0;
                }
                let used = rules.len();
                rules.push(Rule {
                    name: name.to_owned(),
                    used_for: requirement.and_then(|of| obligations.get(of).cloned()),
                    colour: if is_outside { "#eceff3" } else { COLOURS[used % COLOURS.len()] },
                    pattern: if is_outside { 5 } else { used % 5 },
                    discharges: requirement,
                });
                used
            });
            at as u8
        };
        let nodes = tree.nodes.iter();
        let mut ruled: Vec<Ruled> =
            nodes.map(|node| (node.by.iter().map(&mut position).collect(), node.split)).collect();
        let fails = legend.rules.len();
        if tree.nodes.iter().any(|node| node.fails.is_some()) {
            let (colour, pattern) = ("#e5989b", 2);
            let (name, used_for, discharges) = ("fails".to_owned(), None, None);
            legend.rules.push(Rule { name, used_for, colour, pattern, discharges });
        }
        for (ruled, _) in ruled.iter_mut().zip(&tree.nodes).filter(|(_, node)| node.fails.is_some())
        {
            ruled.0.push(fails as u8);
        }
        (legend, ruled)
    }
}

/// Lines of the patterns, on squares of eight units.
pub const PATTERNS: [&str; 6] = [
    "",
    "M-2 10L10 -2M-2 2L2 -2M6 10L10 6",
    "M2 2h1.4M6 6h1.4",
    "M-2 -2L10 10M6 -2L10 2M-2 6L2 10",
    "M0 4H8M4 0V8",
    "M3 5L5 3",
];
