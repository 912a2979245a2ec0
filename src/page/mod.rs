//! A certificate as one HTML file: to read, to print, to attach. A function of the certificate, the
//! checker's verdict on it, and the names it is given; of it, the verdict alone is proved.
//!
//! | module          | holds                                                          |
//! |-----------------|----------------------------------------------------------------|
//! | `words`         | the claim in words, formulas and tables                        |
//! | `nominal`       | the nominal machine in doubles                                 |
//! | `drawing`       | the machine and its workspace                                  |
//! | `isomap`        | lines of equal transmission factors                            |
//! | `contour`       | level sets on a grid                                           |
//! | `subdivision`   | the boxes of the proof                                         |
//! | `evidence`      | margins, the counterexample, where the proof worked hardest    |
//! | `recheck`       | how to check again, and the digests                            |
//! | `svg`           | views of space and parts of figures                            |
//! | [`raster`]      | figures as PNG                                                 |
//! | `escape`        | the only ways in which text gets into a page                   |
//!
//! `page.html`, `page.css`, `figure.css` and `script/` are the page's frame, its style, and what it
//! does in a browser. The script computes the factors again, from the nominal machine's numbers.

mod contour;
mod drawing;
mod escape;
mod evidence;
mod isomap;
mod nominal;
pub mod raster;
mod recheck;
mod subdivision;
mod svg;
mod words;

use crate::decimal::{approximate, grouped};
use crate::digest::policy_source;
use crate::report::{worst_found, Counterexample, Row};
use escape::html;
use isomap::{Mark, Scale};
use nominal::{Nominal, Numbers};
use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{Certificate, FacePart, Proof, Verdict, Violation, Witness};
use orthocert_checker::claim::Claim;
use orthocert_checker::number::Exact;
use orthocert_checker::postulate::{Face, Half};
use orthocert_checker::rule::Obligation;
use orthocert_checker::{parts_needed, Accepted};
use serde_json::{json, Value};
use std::fmt::Write;
use subdivision::{Subdivision, PATTERNS, RULES};

pub use recheck::{checker_sha256, CHECKER_COMMAND};
pub use svg::Picture;

const FRAME: &str = include_str!("page.html");
const SCRIPT: &str = concat!(
    "\"use strict\";\n",
    include_str!("script/kinematics.js"),
    include_str!("script/contour.js"),
    include_str!("script/maps.js"),
    include_str!("script/space.js"),
    include_str!("script/start.js"),
);

/// The certificate's file.
#[derive(Clone, Copy, Debug)]
pub struct File<'a> {
    /// Its name, without folders.
    pub name: &'a str,
    /// Its content.
    pub bytes: &'a [u8],
}

/// What is on a page.
#[derive(Debug)]
pub struct Page<'a> {
    certificate: &'a Certificate,
    accepted: &'a Accepted,
    file: File<'a>,
    title: String,
    /// The machine, and the scale of its maps; none where there is no single one, or where its
    /// numbers exceed what doubles can show.
    machine: Option<(Nominal, Option<Scale>)>,
    rows: Vec<Row>,
    marks: Vec<Mark>,
    trees: Vec<Subdivision>,
    figures: Figures,
}

/// The pictures on a page.
#[derive(Debug, Default)]
struct Figures {
    design: Option<Picture>,
    maps: Vec<Picture>,
    subdivisions: Vec<Picture>,
}

impl<'a> Page<'a> {
    /// The page of a certificate that the checker has accepted.
    pub fn new(
        certificate: &'a Certificate,
        accepted: &'a Accepted,
        file: File<'a>,
        title: Option<&str>,
    ) -> Self {
        let machine_claim = match &certificate.claim {
            Claim::Machine(claim) => Some(claim.clone()),
            Claim::Postulate(claim) => nominal::of_postulate(claim),
        };
        let rows = match &certificate.claim {
            Claim::Machine(claim) => worst_found(claim).unwrap_or_default(),
            Claim::Postulate(_) => Vec::new(),
        };
        let machine = machine_claim.as_ref().and_then(Nominal::new).map(|mut machine| {
            machine.slice = slice(&machine, certificate, &rows);
            let scale = Scale::of(&machine);
            (machine, scale)
        });
        let marks = marks(machine.as_ref().map(|(machine, _)| machine), certificate);
        let trees = trees(certificate, machine.as_ref().map(|(machine, _)| machine));
        let mut page = Page {
            certificate,
            accepted,
            file,
            title: title.unwrap_or(stem(file.name)).to_owned(),
            machine,
            rows,
            marks,
            trees,
            figures: Figures::default(),
        };
        page.figures = page.draw();
        page
    }

    fn draw(&self) -> Figures {
        let mut figures = Figures::default();
        if let Some((machine, scale)) = &self.machine {
            figures.design = Some(drawing::drawing(machine, &self.marks));
            if let Some(scale) = scale {
                let z = machine.point([0.0, 0.0, machine.slice])[2];
                figures.maps = isomap::maps(machine, scale, &self.marks, z).into();
            }
        }
        let marks = if self.is_machine() { &self.marks[..] } else { &[] };
        let trees = self.trees.iter().enumerate();
        figures.subdivisions = trees.map(|(i, tree)| tree.picture(i, marks)).collect();
        figures
    }

    fn is_machine(&self) -> bool {
        matches!(self.certificate.claim, Claim::Machine(_))
    }

    /// Every figure.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        let Figures { design, maps, subdivisions } = &self.figures;
        design.iter().chain(maps).chain(subdivisions)
    }

    /// The HTML file.
    pub fn html(&self) -> String {
        let style = format!("{}{}", include_str!("page.css"), include_str!("figure.css"));
        let verdict = self.accepted.verdict;
        let sections = self.sections();
        let provenance = &self.certificate.provenance;
        let headline = match verdict {
            Verdict::Certified => "\u{2713} CERTIFIED",
            Verdict::Refuted => "\u{2717} REFUTED",
        };
        let meaning = match (&self.certificate.claim, verdict) {
            (Claim::Machine(_), Verdict::Certified) => {
                "Every requirement holds, at every point of the workspace and for every machine that \
                 the claim describes. The exact checker accepted the proof."
            }
            (Claim::Postulate(_), Verdict::Certified) => {
                "The bounds on the transmission factors hold on the whole closed cube, for every \
                 psi_max of the claim. The exact checker accepted the proof."
            }
            (_, Verdict::Refuted) => {
                "A requirement fails. The exact checker accepted the counterexample."
            }
        };
        filled(
            FRAME,
            &[
                ("script-policy", &policy_source(SCRIPT)),
                ("style-policy", &policy_source(&style)),
                ("style", &style),
                ("script", SCRIPT),
                ("title", &html(&self.title)),
                ("subject", &html(&words::subject(&self.certificate.claim))),
                ("verdict", &verdict.to_string()),
                ("headline", headline),
                ("meaning", meaning),
                ("contents", &contents(&sections)),
                (
                    "sections",
                    &sections.iter().map(|(_, _, text)| text.as_str()).collect::<String>(),
                ),
                ("version", env!("CARGO_PKG_VERSION")),
                ("written-by", &html(&format!("{} {}", provenance.tool, provenance.version))),
                ("data", &escape::data(&self.data().to_string())),
            ],
        )
    }

    /// Anchor, name and text of every section.
    fn sections(&self) -> Vec<(&'static str, &'static str, String)> {
        let verdict = self.accepted.verdict;
        let mut all = vec![
            ("overview", "Overview", self.overview()),
            ("claim", "Claim", words::claim_section(&self.certificate.claim, verdict)),
        ];
        if let (Claim::Machine(claim), Proof::Witness(witness)) =
            (&self.certificate.claim, &self.certificate.proof)
        {
            let found = Counterexample::new(claim, witness);
            all.push(("counterexample", "Counterexample", evidence::counterexample(&found)));
        }
        all.push(("machine", "Machine", self.machine_section()));
        if !self.figures.maps.is_empty() {
            all.push(("maps", "Transmission factors", self.maps_section()));
        }
        if !self.rows.is_empty() {
            all.push(("margins", "Margins", evidence::margins(&self.rows)));
        }
        all.push(("proof", "Proof", self.proof_section()));
        let version = env!("CARGO_PKG_VERSION");
        let recheck = recheck::section(self.file.name, self.file.bytes, version);
        all.push(("recheck", "Check it again", recheck));
        all
    }

    fn overview(&self) -> String {
        let size = &self.accepted.size;
        let mut facts = Vec::new();
        match &self.certificate.proof {
            Proof::Witness(_) => facts.push(("proof", "one counterexample".to_owned())),
            Proof::Tree(_) | Proof::Faces(_) => {
                facts.push(("boxes that cover the workspace", grouped(size.leaves as u64)));
                facts.push(("boxes in all", grouped(size.nodes as u64)));
                facts.push(("halvings, at most", size.depth.to_string()));
            }
        }
        let bits = match &self.certificate.proof {
            Proof::Tree(tree) => tree.precision,
            Proof::Faces(faces) => faces.precision,
            Proof::Witness(witness) => witness.precision,
        };
        facts.push(("fractional bits", bits.to_string()));
        facts.push(("certificate", self.file.name.to_owned()));
        let mut out = "<section id=\"overview\"><h2>Overview</h2><dl class=\"facts\">".to_owned();
        for (name, value) in facts {
            let class = if name == "certificate" { " class=\"wide\"" } else { "" };
            let _ = write!(out, "<div{class}><dt>{name}</dt><dd>{}</dd></div>", html(&value));
        }
        out + "</dl></section>\n"
    }

    fn machine_section(&self) -> String {
        let mut out = "<section id=\"machine\"><h2>The machine</h2>".to_owned();
        let (Some((machine, _)), Some(design)) = (&self.machine, &self.figures.design) else {
            let reason = if self.is_machine() {
                "its numbers are beyond what floating point can show"
            } else {
                "the claim is about a machine for each psi_max"
            };
            let _ = write!(out, "<p>There is no drawing, and no map of transmission factors: {reason}.</p></section>");
            return out;
        };
        let planar = machine.legs.iter().any(|leg| matches!(leg.numbers, Numbers::Planar { .. }));
        let note = if planar {
            " Planar legs are drawn schematically, from a guide beside the workspace."
        } else {
            ""
        };
        let unit = if self.is_machine() { "" } else { " Its leg length L is 1." };
        let _ = write!(
            out,
            "<figure>{}<figcaption>The nominal machine (every parameter in the middle of its tolerance): guides \
             dash-dotted, legs from B<sub>i</sub> to the platform at P, the workspace in colour.{note}{unit}</figcaption></figure>",
            design.inline()
        );
        match &self.certificate.claim {
            Claim::Machine(claim) => out.push_str(&words::parameters(claim, machine)),
            Claim::Postulate(claim) => {
                if let Some(claim) = nominal::of_postulate(claim) {
                    out.push_str(&words::parameters(&claim, machine));
                }
            }
        }
        out + "</section>\n"
    }

    fn maps_section(&self) -> String {
        let cube = self.machine.as_ref().map(|(machine, _)| machine).filter(|m| m.is_cube);
        let at = if cube.is_some() { " The first slice is the one through Q\u{2081}." } else { "" };
        let maps: String = self.figures.maps.iter().map(Picture::inline).collect();
        let legend = self.machine.as_ref().and_then(|(_, scale)| scale.as_ref()).map(Scale::legend);
        format!(
            "<section id=\"maps\"><h2>Velocity transmission factors</h2>\
             <p>Lines of equal \u{3c8}<sub>1</sub> \u{2264} \u{3c8}<sub>2</sub> \u{2264} \u{3c8}<sub>3</sub> of the \
             nominal machine over a plane z = const, in floating point.{at} Hatched: out of reach of a leg.</p>\
             <div class=\"controls scripted\"><label for=\"slice\">z <input type=\"range\" id=\"slice\" min=\"0\" max=\"200\" step=\"1\"></label>\
             <output id=\"slice-value\" for=\"slice\"></output><button type=\"button\" id=\"slice-reset\">First slice</button></div>\
             <figure><div class=\"maps\">{maps}</div>{legend}\
             <output class=\"readout scripted\" id=\"map-readout\" aria-live=\"polite\">Point at a map, or focus one and \
             move the cross with the arrow keys, to read the values there.</output>\
             <figcaption class=\"scripted\">Keys on a map: <kbd>\u{2190}</kbd> <kbd>\u{2192}</kbd> <kbd>\u{2191}</kbd> <kbd>\u{2193}</kbd> move the \
             cross (with <kbd>Shift</kbd> in large steps), <kbd>Page Up</kbd> <kbd>Page Down</kbd> move the slice.</figcaption>\
             <figcaption class=\"static\">z = {z}</figcaption></figure>{corners}</section>\n",
            corners = cube.map(words::corners).unwrap_or_default(),
            legend = legend.unwrap_or_default(),
            z = self.machine.as_ref().map_or(String::new(), |(m, _)| crate::decimal::significant(m.point([0.0, 0.0, m.slice])[2], 6)),
        )
    }

    fn proof_section(&self) -> String {
        let refuted = self.accepted.verdict == Verdict::Refuted;
        let mut out = "<section id=\"proof\"><h2>The proof</h2>".to_owned();
        if refuted {
            out.push_str("<p>A refutation needs one point and no subdivision; here it is in the workspace.</p>");
        } else {
            out.push_str(
                "<p>The workspace is halved until every requirement can be shown on every box by one of the \
                 checker's rules. A requirement shown on a box holds on all its parts.</p>",
            );
        }
        out.push_str(VIEWER);
        for (picture, tree) in self.figures.subdivisions.iter().zip(&self.trees) {
            let _ = write!(
                out,
                "<figure class=\"static\">{}<figcaption>{}</figcaption></figure>",
                picture.inline(),
                html(&caption(tree))
            );
        }
        if !refuted {
            out.push_str(&self.legend());
            out.push_str(&evidence::hardest(&self.trees));
        }
        out + "</section>\n"
    }

    /// The rules that are used, with their colours, patterns and uses.
    fn legend(&self) -> String {
        let mut out = "<ul class=\"legend\" aria-label=\"Rules used\">".to_owned();
        for (k, rule) in RULES.iter().enumerate() {
            let Some(uses) = self.accepted.size.steps.get(rule.name) else {
                continue;
            };
            let d = PATTERNS[rule.pattern];
            let _ = write!(
                out,
                "<li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><defs><pattern id=\"legend-{k}\" \
                 width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\"><rect width=\"8\" height=\"8\" fill=\"{}\"/>\
                 <path class=\"pattern\" d=\"{d}\"/></pattern></defs><rect class=\"leaf\" width=\"26\" height=\"16\" \
                 fill=\"url(#legend-{k})\"/></svg><span><code>{}</code> \u{d7} {}</span></li>",
                rule.colour,
                rule.name,
                grouped(*uses as u64)
            );
        }
        out + "</ul>"
    }

    /// What the script works on.
    fn data(&self) -> Value {
        let machine = self.machine.as_ref().map(|(machine, scale)| {
            json!({
                "legs": machine.legs.each_ref().map(|leg| &leg.numbers),
                "least": machine.frame.least,
                "width": machine.frame.width,
                "cylinder": machine.is_cylinder,
                "slice": machine.slice,
                "scale": scale,
            })
        });
        let trees: Vec<Value> = self
            .trees
            .iter()
            .map(|tree| {
                json!({
                    "name": tree.name,
                    "axes": tree.axes,
                    "least": tree.least,
                    "width": tree.width,
                    "shape": tree.proportions(),
                    "code": tree.code,
                    "filledBy": tree.filled_by,
                })
            })
            .collect();
        let discharges: Vec<i64> = RULES.iter().map(|rule| discharged(rule.name)).collect();
        json!({
            "machine": machine,
            "trees": trees,
            "rules": RULES,
            "discharges": discharges,
            "obligations": Obligation::ALL.map(|o| o.to_string()),
            "patterns": PATTERNS,
            "marks": self.marks,
            "marksInTree": self.is_machine(),
        })
    }
}

fn caption(tree: &Subdivision) -> String {
    let name = tree.name.as_str();
    if tree.leaves.is_empty() {
        return name.to_owned();
    }
    let parts = if tree.axes[0] == "kappa" { ", y and z as parts of [q1, q2]" } else { "" };
    format!("{name}{parts}; boxes are filled by the rule for {}", Obligation::ALL[tree.filled_by])
}

/// The controls of the view in space.
const VIEWER: &str = "<div class=\"scripted\" id=\"viewer\"><div class=\"controls\">\
    <label for=\"tree\" id=\"tree-label\">part <select id=\"tree\"></select></label>\
    <label for=\"obligation\">colour by <select id=\"obligation\"></select></label>\
    <label for=\"cut-axis\">cut along <select id=\"cut-axis\"></select></label>\
    <label for=\"cut\">at <input type=\"range\" id=\"cut\" min=\"0\" max=\"1000\" value=\"1000\"></label>\
    <output id=\"cut-value\" for=\"cut\"></output>\
    <label for=\"deep\">boxes of depth at least <input type=\"range\" id=\"deep\" min=\"0\" value=\"0\"></label>\
    <output id=\"deep-value\" for=\"deep\"></output>\
    <button type=\"button\" id=\"view-reset\">Reset view</button></div>\
    <canvas id=\"space\" width=\"900\" height=\"600\" tabindex=\"0\" role=\"img\" aria-label=\"The boxes of the proof in \
    space; arrow keys turn the view\"></canvas>\
    <output class=\"readout\" id=\"space-readout\" aria-live=\"polite\"></output>\
    <p class=\"note\">Drag, or use the arrow keys, to turn; <kbd>+</kbd> <kbd>\u{2212}</kbd> to scale; <kbd>[</kbd> \
    <kbd>]</kbd> move the cut; point at a box, or press <kbd>Enter</kbd> for the one in the middle, to read it.</p></div>";

/// The obligation that a rule discharges, by its position; -1 for all.
fn discharged(rule: &str) -> i64 {
    let name = match rule {
        "lower" | "corner" | "blow_up" | "edge" | "mirror" => "sigma_min",
        "upper" | "cube" => "sigma_max",
        "range" => "joint_range",
        "speed" => "joint_speed",
        other => other,
    };
    let found = Obligation::ALL.iter().position(|o| o.to_string() == name);
    found.and_then(|i| i64::try_from(i).ok()).unwrap_or(-1)
}

fn contents(sections: &[(&str, &str, String)]) -> String {
    let link = |(id, name, _): &(&str, &str, String)| format!("<a href=\"#{id}\">{name}</a>");
    sections.iter().map(link).collect()
}

/// The frame with what stands for its `{{names}}`; what is put in is not looked at again.
fn filled(frame: &str, values: &[(&str, &str)]) -> String {
    let mut out =
        String::with_capacity(frame.len() + values.iter().map(|v| v.1.len()).sum::<usize>());
    let mut rest = frame;
    while let Some((before, after)) = rest.split_once("{{") {
        out.push_str(before);
        let Some((name, after)) = after.split_once("}}") else {
            break;
        };
        out.push_str(values.iter().find(|(known, _)| *known == name).map_or("", |v| v.1));
        rest = after;
    }
    out.push_str(rest);
    out
}

/// `NAME` of `NAME.cert.json`.
fn stem(name: &str) -> &str {
    let name = name.strip_suffix(".json").unwrap_or(name);
    name.strip_suffix(".cert").unwrap_or(name)
}

/// The plane of the first maps, as a part of the workspace's height: through `Q_1`, through the
/// counterexample, or through the place where the greatest factor was found.
fn slice(machine: &Nominal, certificate: &Certificate, rows: &[Row]) -> f64 {
    let (least, width) = (machine.frame.least[2], machine.frame.width[2]);
    let z = match &certificate.proof {
        Proof::Witness(witness) => approximate(&witness.point[2]),
        _ if machine.is_cube => Some(least),
        _ => rows.iter().find(|row| row.requirement == "greatest psi").map(|row| row.at[2]),
    };
    match z {
        Some(z) if width > 0.0 => ((z - least) / width).clamp(0.0, 1.0),
        _ => machine.slice,
    }
}

/// `Q_1` and `Q_2` of the cube, and the points of a counterexample.
fn marks(machine: Option<&Nominal>, certificate: &Certificate) -> Vec<Mark> {
    let mut all = Vec::new();
    if let Some(machine) = machine.filter(|machine| machine.is_cube) {
        for (name, u) in [("Q\u{2081}", 0.0), ("Q\u{2082}", 1.0)] {
            all.push(Mark { name: name.to_owned(), at: machine.point([u; 3]) });
        }
    }
    if let Proof::Witness(witness) = &certificate.proof {
        let at =
            |p: &[Exact; 3]| Some([approximate(&p[0])?, approximate(&p[1])?, approximate(&p[2])?]);
        let name = |name: &str| name.to_owned();
        let Witness { point, violates, .. } = &**witness;
        all.extend(at(point).map(|at| Mark { name: name("counterexample"), at }));
        if let Violation::Singular(second) = violates {
            all.extend(at(&second.other).map(|at| Mark { name: name("P'"), at }));
        }
    }
    all
}

/// The trees of a proof; for a counterexample, the workspace alone.
fn trees(certificate: &Certificate, machine: Option<&Nominal>) -> Vec<Subdivision> {
    let (least, width) = match machine {
        Some(machine) => (machine.frame.least, machine.frame.width),
        None => ([0.0; 3], [1.0; 3]),
    };
    let axes = Subdivision::axes_of(Axis::ALL);
    match (&certificate.proof, &certificate.claim) {
        (Proof::Tree(tree), _) => {
            let name = match machine {
                Some(_) => "the workspace",
                None => "the workspace, x, y and z as parts of it",
            };
            vec![Subdivision::new(name, axes, least, width, &tree.nodes)]
        }
        (Proof::Faces(faces), Claim::Postulate(claim)) => {
            let needed = parts_needed(claim).unwrap_or_default();
            let part = |(part, needed): (&FacePart, &orthocert_checker::PartNeeded)| {
                let face = match part.face {
                    Face::Q1 => "x = q1",
                    Face::Q2 => "x = q2",
                };
                let half = match part.half {
                    Half::Low => "kappa <= 1/2",
                    Half::High => "kappa >= 1/2",
                };
                let ends = [&needed.least, &needed.greatest].map(|x| approximate(x).unwrap_or(0.0));
                let name = format!("face {face}, {half}");
                let axes = Subdivision::axes_of(Axis::FACE);
                let (least, width) = ([ends[0], 0.0, 0.0], [ends[1] - ends[0], 1.0, 1.0]);
                Subdivision::new(&name, axes, least, width, &part.nodes)
            };
            faces.parts.iter().zip(&needed).map(part).collect()
        }
        _ => vec![Subdivision::new("the workspace", axes, least, width, &[])],
    }
}

#[cfg(test)]
mod tests;
