//! A claim in words, formulas and tables.

use super::legs::Numbers;
use super::mechanism;
use super::nominal::Nominal;
use super::theorem::theorem;
use crate::exact::decimal::significant;
use crate::report::escape::xml;
use orthocert_checker::certificate::Verdict;
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim as kernel;
use orthocert_kernel::claim::{Every, Parameter, PsiMax};
use std::fmt::Write;

/// Digits of numbers that are computed for people.
const DIGITS: u32 = 9;

/// What the claim is about, on a line.
pub fn subject(claim: &Claim) -> String {
    match claim {
        Claim::Postulate(claim) => match &claim.psi_max {
            PsiMax::Every(Every::All) => "The Q1/Q2 postulate for every psi_max > 1".to_owned(),
            PsiMax::Of(kernel::Quantity::Exactly(psi)) => {
                format!("The Q1/Q2 postulate for psi_max = {psi}")
            }
            PsiMax::Of(kernel::Quantity::Between { min, max }) => {
                format!("The Q1/Q2 postulate for every psi_max from {min} to {max}")
            }
        },
        Claim::Atlas(claim) => {
            let names: Vec<&str> = claim.parameters.iter().map(|p| p.name.as_str()).collect();
            format!("A map of designs over {}", names.join(", "))
        }
        Claim::NoCube(claim) => format!(
            "No cube of side {} with its centre in {} for: {}",
            claim.side,
            mechanism::workspace(&claim.machine),
            mechanism::machine(&claim.machine)
        ),
        Claim::Machine(own) => {
            // Orientations alone follow the machine: "turned by at most ..".
            let turned = matches!(own.mechanism, kernel::Mechanism::Spherical(_));
            let over = if turned { ", " } else { " over " };
            machine_and_workspace(claim).unwrap_or_default().join(over)
        }
    }
}

/// The machine and the workspace of a claim about one machine, or the machines within its tolerances.
pub fn machine_and_workspace(claim: &Claim) -> Option<[String; 2]> {
    match claim {
        Claim::Machine(claim) => Some([mechanism::machine(claim), mechanism::workspace(claim)]),
        Claim::Postulate(_) | Claim::Atlas(_) | Claim::NoCube(_) => None,
    }
}

/// The claim in words, and the formulas of what it speaks of.
pub fn claim_section(claim: &Claim, verdict: Verdict) -> String {
    let mut out = format!(
        "<section id=\"claim\"><h2>What is {}</h2>{}",
        if verdict == Verdict::Certified { "proved" } else { "refuted" },
        theorem(claim, verdict)
    );
    out.push_str(&formulas(claim, &asserted(claim)));
    out + "</section>\n"
}

fn formulas(claim: &Claim, asserted: &[String]) -> String {
    let mut out = "<h3>In formulas</h3><ul class=\"formulas\">".to_owned();
    for formula in asserted {
        let _ = write!(out, "<li>{formula}</li>");
    }
    out.push_str("</ul><h3>Where</h3><ul class=\"formulas\">");
    for formula in definitions(claim) {
        let _ = write!(out, "<li>{formula}</li>");
    }
    out + "</ul>"
}

/// What the claim asserts at every point, as markup.
fn asserted(claim: &Claim) -> Vec<String> {
    const CUBE: &str = "<var>t</var><sub>1</sub> = (1 \u{2212} \u{3ba})/2, <var>t</var><sub>2</sub> = 1 \u{2212} \u{3ba} for \
         \u{3ba} \u{2264} \u{bd}, (1/\u{3ba} \u{2212} 1)/2 for \u{3ba} \u{2265} \u{bd}; \
         <var>q</var><sub>1</sub> = \u{2212}<var>L</var> <var>t</var><sub>1</sub>/\u{221a}(1 + 2<var>t</var><sub>1</sub>\u{b2}), \
         <var>q</var><sub>2</sub> = <var>L</var> <var>t</var><sub>2</sub>/\u{221a}(1 + 2<var>t</var><sub>2</sub>\u{b2})";
    const TIGHT: &str = "1/\u{3c8}<sub>max</sub> \u{2264} \u{3c8}<sub>i</sub>(<var>P</var>) \u{2264} \u{3c8}<sub>max</sub>";
    const FREE: &str = "every leg reaches <var>P</var> and is not serially singular there; det <var>M</var>(<var>P</var>) \u{2260} 0";
    let everywhere =
        |set: &str| format!("for every <var>P</var> \u{2208} {set}, <var>i</var> = 1, 2, 3:");
    let cube = everywhere("[<var>q</var><sub>1</sub>, <var>q</var><sub>2</sub>]\u{b3}");
    let of_cube = |psi_max: String| {
        let given = format!("\u{3c8}<sub>max</sub> {psi_max}, \u{3ba} = 1/\u{3c8}<sub>max</sub>");
        vec![format!("{given}; {CUBE}"), cube.clone(), FREE.to_owned(), TIGHT.to_owned()]
    };
    match claim {
        Claim::Postulate(claim) => of_cube(match &claim.psi_max {
            PsiMax::Every(Every::All) => "&gt; 1, any".to_owned(),
            PsiMax::Of(kernel::Quantity::Exactly(psi)) => format!("= {psi}"),
            PsiMax::Of(kernel::Quantity::Between { min, max }) => {
                format!("\u{2208} [{min}, {max}], any")
            }
        }),
        Claim::Atlas(claim) => {
            let range = |p: &Parameter| {
                let (min, max) = (mechanism::number(&p.min), mechanism::number(&p.max));
                format!("{min} \u{2264} {} \u{2264} {max}", xml(&p.name))
            };
            let ranges: Vec<String> = claim.parameters.iter().map(range).collect();
            let share = |share| format!("the share {} of the box", mechanism::number(share));
            vec![
                ranges.join(", "),
                format!("certified: {}", share(&claim.certified)),
                format!("refuted: {}", share(&claim.refuted)),
            ]
        }
        Claim::NoCube(claim) => {
            let side = &claim.side;
            let mut out = vec![format!(
                "for every <var>C</var> \u{2208} <var>W</var> there is a <var>P</var> with \
                 |<var>P</var> \u{2212} <var>C</var>|<sub>\u{221e}</sub> \u{2264} {side}/2 at which \
                 one of these fails:"
            )];
            let everywhere = asserted(&Claim::Machine(claim.machine.clone()));
            out.extend(everywhere.into_iter().skip(1));
            out
        }
        Claim::Machine(claim) => {
            let mut out = vec![
                everywhere("<var>W</var>, the workspace").replace(", <var>i</var> = 1, 2, 3", ""),
                "every formula is defined, every leg reaches <var>P</var> and is not serially singular \
                 there; <var>M</var>(<var>P</var>) has full column rank"
                    .to_owned(),
            ];
            out.extend(claim.require.iter().map(|own| symbols(&xml(&mechanism::formula(own)))));
            out
        }
    }
}

/// The table's symbols as the paper writes them.
pub(super) fn symbols(formula: &str) -> String {
    const WRITTEN: [(&str, &str); 14] = [
        ("sigma_max/sigma_min", "\u{3c3}<sub>max</sub>/\u{3c3}<sub>min</sub>"),
        ("M^-1", "<var>M</var><sup>\u{2212}1</sup>"),
        ("M^-T", "<var>M</var><sup>\u{2212}T</sup>"),
        ("M^T", "<var>M</var><sup>T</sup>"),
        (" M ", " <var>M</var> "),
        ("of M|", "of <var>M</var>|"),
        ("speed^2", "speed\u{b2}"),
        ("|det A|", "|det <var>A</var>|"),
        ("|P' - P|", "|<var>P\u{2032}</var> \u{2212} <var>P</var>|"),
        ("H_i", "<var>H</var><sub>i</sub>"),
        ("L_i", "<var>L</var><sub>i</sub>"),
        ("(L_1 .. L_n)", "(<var>L</var><sub>1</sub> \u{2026} <var>L</var><sub>n</sub>)"),
        ("column i", "column <var>i</var>"),
        ("_i", "<sub>i</sub>"),
    ];
    let greek = mechanism::greek(formula, "<sub>i</sub>");
    WRITTEN.iter().fold(greek, |text, (name, written)| text.replace(name, written))
}

/// Definitions, as markup.
fn definitions(claim: &Claim) -> Vec<&'static str> {
    if let Claim::NoCube(claim) = claim {
        return definitions(&Claim::Machine(claim.machine.clone()));
    }
    const SLIDER: &str = "slider: <var>r</var> = <var>w</var> \u{2212} (<var>n</var>\u{b7}<var>w</var>)<var>n</var>, \
         <var>s</var> = \u{221a}(<var>L</var>\u{b2} \u{2212} |<var>r</var>|\u{b2}), \u{3b7} = \u{b1}<var>s</var>; \
         row of <var>M</var>: <var>n</var><sup>T</sup> + <var>r</var><sup>T</sup>/\u{3b7}; \
         \u{3c1} = <var>n</var>\u{b7}<var>w</var> \u{2212} \u{3b7}; serially singular where <var>s</var> = 0";
    const STRUT: &str = "strut: row of <var>M</var>: <var>w</var><sup>T</sup>/|<var>w</var>|; \u{3c1} = |<var>w</var>|";
    const ARM: &str = "arm: <var>h</var> = <var>w</var> \u{2212} (<var>k</var>\u{b7}<var>w</var>)<var>k</var>, \
         <var>N</var> = |<var>h</var>|\u{b2}, <var>g</var> = (|<var>w</var>|\u{b2} + <var>r</var>\u{b2} \u{2212} <var>L</var>\u{b2})/2<var>r</var>, \
         <var>D</var> = <var>N</var> \u{2212} <var>g</var>\u{b2}, <var>q</var> = <var>w</var>/<var>r</var> \u{2212} (<var>g</var>/<var>N</var>)<var>h</var>; \
         row of <var>M</var>: (<var>k</var>\u{d7}<var>h</var>)<sup>T</sup>/<var>N</var> \u{b1} <var>q</var><sup>T</sup>/\u{221a}<var>D</var>; \
         serially singular where <var>D</var> = 0";
    const PLANAR: &str = "planar leg: row of <var>M</var>: <var>n</var><sup>T</sup>; \u{3c1} = <var>n</var>\u{b7}<var>P</var>";
    const OF_THREE: &str = "<var>w</var> = <var>P</var> + <var>d</var> \u{2212} <var>a</var> for each leg, with its platform offset <var>d</var> and its anchor <var>a</var>";
    const TURNED: &str = "<var>w</var> = <var>P</var> + <var>R</var><var>d</var> \u{2212} <var>a</var> for each leg, with its platform's joint <var>d</var> and its anchor <var>a</var>; \
         of a platform that turns, rows of <var>M</var> have the moments of the leg about <var>P</var> beside them";
    let (vectors, drives) = match claim {
        Claim::Machine(kernel::MachineClaim {
            mechanism: kernel::Mechanism::Formulas(_), ..
        }) => (None, Vec::new()),
        Claim::Machine(claim) if claim.orientation.is_some() => {
            (Some(TURNED), mechanism::drives(claim))
        }
        Claim::Machine(claim) => (Some(OF_THREE), mechanism::drives(claim)),
        _ => (Some(OF_THREE), vec!["slider"]),
    };
    let mut out: Vec<&str> = vectors.into_iter().collect();
    let mut seen = Vec::new();
    for name in drives {
        let formula = match name {
            "slider" => SLIDER,
            "strut" => STRUT,
            "arm" => ARM,
            _ => PLANAR,
        };
        if !seen.contains(&formula) {
            seen.push(formula);
        }
    }
    out.extend(seen);
    let of_kernel = matches!(claim, Claim::Machine(_));
    out.push(if of_kernel {
        "<var>M</var>: joint velocities are <var>M</var> times the velocity of the coordinates; \
         \u{3c8}<sub>i</sub> are the inverses of its singular values"
    } else {
        "<var>M</var> = <var>J</var><sup>\u{2212}1</sup>: joint velocities are <var>M</var> times the platform's velocity; \
         \u{3be}<sub>1</sub>, \u{3be}<sub>2</sub>, \u{3be}<sub>3</sub> are its singular values, \u{3c8}<sub>i</sub> = 1/\u{3be}<sub>i</sub> the velocity transmission factors"
    });
    out.push(if of_kernel {
        "parallel singularity: <var>M</var> has not full column rank"
    } else {
        "parallel singularity: det <var>M</var> = 0"
    });
    out
}

/// The numbers of the paper's cube and its machine, which follow from the claim.
pub fn parameters_of_cube(machine: &Nominal) -> Option<String> {
    let Numbers::Slider { anchor, platform, length, .. } = &machine.legs[0] else {
        return None;
    };
    let q1 = machine.least[0];
    let rows = [
        ("leg length L", *length),
        ("corner Q\u{2081}, every coordinate", q1),
        ("corner Q\u{2082}, every coordinate", q1 + machine.width[0]),
        ("base a, where \u{3c1} = 0", anchor[0]),
        ("offset e", 0.0 - platform[0]),
    ];
    let mut out = "<div class=\"table\"><table><thead><tr><th>follows from the claim</th>\
                   <th class=\"number\">about</th></tr></thead><tbody>"
        .to_owned();
    for (name, value) in rows {
        let value = significant(value, DIGITS);
        let _ = write!(out, "<tr><td>{name}</td><td class=\"number\">{value}</td></tr>");
    }
    Some(out + "</tbody></table></div>")
}

/// The factors at the corners and at the origin of the paper's cube.
pub fn corners(machine: &Nominal) -> String {
    let [q1, q2] = [0.0, 1.0].map(|u| machine.point([u; 3]));
    let mut out = "<div class=\"table\"><table><thead><tr><th>at</th><th class=\"number\">\u{3c8}<sub>1</sub></th>\
                   <th class=\"number\">\u{3c8}<sub>2</sub></th><th class=\"number\">\u{3c8}<sub>3</sub></th></tr></thead><tbody>"
        .to_owned();
    for (name, p) in [("Q\u{2081}", q1), ("O, the origin", [0.0; 3]), ("Q\u{2082}", q2)] {
        let _ = write!(out, "<tr><td>{name}</td>");
        for psi in machine.psi(p).unwrap_or([f64::NAN; 3]) {
            let _ = write!(out, "<td class=\"number\">{}</td>", significant(psi, DIGITS));
        }
        out.push_str("</tr>");
    }
    out + "</tbody></table></div>"
}
