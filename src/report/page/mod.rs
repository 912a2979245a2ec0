//! A certificate as one HTML file: to read, to print, to attach. A function of the certificate, the
//! checker's verdict on it, and the names it is given; of it, the verdict alone is proved.
//!
//! | module          | holds                                                          |
//! |-----------------|----------------------------------------------------------------|
//! | `sections`      | the sections, in their order                                   |
//! | `scene`         | what is drawn, mapped, marked and subdivided                   |
//! | `words`         | the claim in words, formulas and tables                        |
//! | `theorem`       | the statement as papers would have it                          |
//! | `nominal`       | three translating legs in doubles                              |
//! | `general`       | the scene of a kernel claim: any mechanism                     |
//! | `shape`         | its machine as it is drawn                                     |
//! | `mechanism`     | a kernel claim in words and tables                             |
//! | `sampled`       | values of its quantities in doubles                            |
//! | `legs`          | legs at places of their platform                               |
//! | `drawing`       | the machine and its workspace                                  |
//! | `isomap`        | lines of equal value over two coordinates                      |
//! | `contour`       | level sets on a grid                                           |
//! | `subdivision`   | the boxes of the proof                                         |
//! | `legend`        | their rules                                                    |
//! | `evidence`      | requirements, the counterexample, where the proof worked hardest |
//! | `recheck`       | how to check again, and the digests                            |
//! | `verified`      | the formally verified checker, with the certificate            |
//! | `svg`           | views of space and parts of figures                            |
//! | [`paving`]      | the page of a paving                                           |
//!
//! `page.html`, `page.css`, `figure.css` and `script/` are the page's frame, its style, and what it
//! does in a browser. The script computes the factors again, from the nominal machine's numbers.

pub(crate) mod contour;
mod drawing;
mod evidence;
mod general;
mod isomap;
mod labels;
mod legend;
mod legs;
mod mechanism;
mod nominal;
pub mod paving;
mod recheck;
mod sampled;
mod scene;
mod sections;
mod shape;
mod subdivision;
pub(crate) mod svg;
pub(crate) mod theorem;
mod verified;
mod words;

use crate::files::digest::policy_source;
use crate::report::escape::{self, xml};
use crate::search::accepted::Accepted;
pub use general::names as coordinates;
use isomap::Scale;
use legend::PATTERNS;
use nominal::Nominal;
use orthocert_checker::certificate::{Certificate, Proof, Provenance, Verdict};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::MachineClaim;
use scene::{corners_of_cube, first_slice, of_nothing, of_postulate, slice, Scene};
use serde_json::{json, Value};
use verified::{verified, Verified, PROGRAM};

pub use recheck::{checker_sha256, CHECKER_COMMAND};
pub use svg::Picture;

const FRAME: &str = include_str!("page.html");
const SCRIPT: &str = concat!(
    "\"use strict\";\n",
    include_str!("script/kinematics.js"),
    include_str!("script/contour.js"),
    include_str!("script/maps.js"),
    include_str!("script/leaves.js"),
    include_str!("script/view.js"),
    include_str!("script/space.js"),
    include_str!("script/region.js"),
    include_str!("script/reprove.js"),
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
    /// The unit of lengths.
    unit: Option<&'static str>,
    /// What the design has and the claim has not.
    notes: Vec<String>,
    /// Names of quantities, and between which ends they are certified to lie.
    signed: Vec<(String, String)>,
    /// Three translating legs, and the scale of their maps; none where there is no single machine of
    /// them, or where its numbers exceed what doubles can show.
    machine: Option<(Nominal, Option<Scale>)>,
    scene: Scene,
    figures: Figures,
}

/// The pictures on a page.
#[derive(Debug, Default)]
struct Figures {
    design: Option<Picture>,
    subdivisions: Vec<Picture>,
}

/// The drawing of a claim's machine, with the counterexample where the proof is one; none of formulas,
/// which do not say where the machine's parts are.
pub fn machine(claim: &MachineClaim, proof: Option<&Proof>) -> Option<Picture> {
    let marks = match proof {
        Some(Proof::Witness(witness)) => general::witnessed(witness),
        _ => Vec::new(),
    };
    Some(drawing::drawing(&shape::shape(claim)?, &marks))
}

impl<'a> Page<'a> {
    /// The page of a certificate that the checker has accepted; title and unit of lengths are the
    /// design's, which no certificate has.
    pub fn new(
        certificate: &'a Certificate,
        accepted: &'a Accepted,
        file: File<'a>,
        title: Option<&str>,
        unit: Option<&'static str>,
    ) -> Self {
        let of_cube;
        let machine_claim = match &certificate.claim {
            Claim::Machine(claim) => Some(claim),
            Claim::Postulate(claim) => {
                of_cube = nominal::of_postulate(claim);
                of_cube.as_ref()
            }
            Claim::Atlas(_) | Claim::NoCube(_) => None,
        };
        let mut machine = machine_claim.and_then(Nominal::new).map(|mut machine| {
            machine.slice = slice(&machine, &certificate.proof);
            let scale = machine.scale();
            (machine, scale)
        });
        let scene = match (&certificate.claim, &certificate.proof) {
            (Claim::Machine(claim), proof) => {
                let mut scene = general::scene(claim, proof, unit);
                if let Some((machine, scale)) = &mut machine {
                    // Where the machine is nearest to a limit, but through Q1 of the paper's cube.
                    let nearest = scene.marks.first().filter(|_| !machine.is_cube);
                    if let Some(z) = nearest.and_then(|mark| mark.at.get(2)) {
                        machine.slice = machine.part(2, *z);
                    }
                    scene.marks.extend(corners_of_cube(machine));
                    let first =
                        scale.as_ref().map(|scale| first_slice(machine, scale, &scene.marks));
                    if first.is_some() {
                        // Those over every plane z = const are there.
                        for slice in &mut scene.slices {
                            if slice.maps.first().is_some_and(|map| map.name.starts_with("psi-")) {
                                slice.maps.remove(0);
                                slice.legends.remove(0);
                            }
                        }
                        scene.slices.retain(|slice| !slice.maps.is_empty());
                    }
                    scene.slices.splice(0..0, first);
                }
                scene
            }
            (Claim::NoCube(claim), proof) => general::of_centres(claim, proof),
            (Claim::Postulate(claim), proof) => {
                let machine = machine.as_ref().map(|(machine, scale)| (machine, scale.as_ref()));
                of_postulate(claim, proof, machine_claim, machine)
            }
            _ => Scene { trees: vec![of_nothing()], ..Scene::default() },
        };
        let mut page = Page {
            certificate,
            accepted,
            file,
            title: title.unwrap_or(stem(file.name)).to_owned(),
            unit,
            notes: Vec::new(),
            signed: Vec::new(),
            machine,
            scene,
            figures: Figures::default(),
        };
        page.figures = page.draw();
        page
    }

    /// The page with what the design has and the claim has not.
    pub fn noting(self, notes: Vec<String>) -> Self {
        Page { notes, ..self }
    }

    /// The page of a certified claim with more that is certified: names of quantities and their ranges.
    pub fn signing(self, of: impl FnOnce(&MachineClaim) -> Vec<(String, String)>) -> Self {
        match (&self.certificate.claim, self.accepted.verdict) {
            (Claim::Machine(claim), Verdict::Certified) => Page { signed: of(claim), ..self },
            _ => self,
        }
    }

    fn draw(&self) -> Figures {
        let Scene { shape, marks, trees, .. } = &self.scene;
        let in_trees = if self.is_machine() { &marks[..] } else { &[] };
        let trees = trees.iter().enumerate();
        Figures {
            design: shape.as_ref().map(|shape| drawing::drawing(shape, marks)),
            subdivisions: trees.map(|(i, tree)| tree.picture(i, in_trees)).collect(),
        }
    }

    fn is_machine(&self) -> bool {
        matches!(self.certificate.claim, Claim::NoCube(_) | Claim::Machine(_))
    }

    /// Every figure.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        let Figures { design, subdivisions } = &self.figures;
        let maps = self.scene.slices.iter().flat_map(|slice| &slice.maps);
        design.iter().chain(maps).chain(subdivisions)
    }

    /// The HTML of the section with this anchor.
    pub fn section(&self, anchor: &str) -> Option<String> {
        let found = self.sections().into_iter().find(|(own, ..)| *own == anchor);
        found.map(|(.., html)| html)
    }

    /// The HTML file.
    pub fn html(&self) -> String {
        let verdict = self.accepted.verdict;
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
            (Claim::Atlas(_), Verdict::Certified) => {
                "Every design of the cells that the map names certified meets the requirements, and \
                 none of those that it names refuted does. The exact checker accepted all proofs."
            }
            (Claim::NoCube(_), Verdict::Certified) => {
                "No cube of this side fits, wherever its centre is in the box. The exact checker \
                 accepted the proof."
            }
            (_, Verdict::Refuted) => {
                "A requirement fails. The exact checker accepted the counterexample."
            }
        };
        Framed {
            kind: "certificate",
            title: &self.title,
            subject: &words::subject(&self.certificate.claim),
            verdict: &verdict.to_string(),
            headline,
            meaning,
            sections: &self.sections(),
            provenance: &self.certificate.provenance,
            data: &self.data(),
            verified: Some(verified(self.certificate, self.file.bytes)),
        }
        .html()
    }

    /// What the script works on.
    fn data(&self) -> Value {
        let machine = self.machine.as_ref().map(|(machine, scale)| {
            json!({
                "legs": machine.legs,
                "least": machine.least,
                "width": machine.width,
                "cylinder": machine.is_cylinder,
                "slice": machine.slice,
                "scale": scale,
            })
        });
        // What the script turns has three coordinates.
        let spatial = self.scene.trees.iter().filter(|tree| tree.is_spatial());
        let trees: Vec<Value> = spatial
            .map(|tree| {
                json!({
                    "name": tree.name,
                    "axes": tree.axes,
                    "angles": if tree.turns { tree.positions } else { tree.axes.len() },
                    "least": tree.least,
                    "width": tree.width,
                    "shape": tree.proportions(),
                    "code": tree.code,
                    "filledBy": tree.filled_by,
                })
            })
            .collect();
        let legend = self.scene.trees.first().map(|tree| &tree.legend);
        let rules = legend.map(|legend| &legend.rules[..]).unwrap_or_default();
        // An obligation by its position; -1 for all.
        let position = |of: Option<usize>| of.and_then(|i| i64::try_from(i).ok()).unwrap_or(-1);
        let discharges: Vec<i64> = rules.iter().map(|rule| position(rule.discharges)).collect();
        json!({
            "machine": machine,
            "trees": trees,
            "rules": rules,
            "discharges": discharges,
            "obligations": legend.map(|legend| &legend.obligations[..]).unwrap_or_default(),
            "patterns": PATTERNS,
            "marks": self.scene.marks,
            "marksInTree": self.is_machine(),
        })
    }
}

/// What stands in the frame of a page.
struct Framed<'a> {
    /// What the page is about: a certificate or a paving.
    kind: &'static str,
    title: &'a str,
    subject: &'a str,
    verdict: &'a str,
    headline: &'a str,
    /// What the headline means; no text from outside.
    meaning: &'a str,
    /// Identifiers, names in the table of contents, and HTML.
    sections: &'a [(&'static str, &'static str, String)],
    provenance: &'a Provenance,
    /// What the script works on.
    data: &'a Value,
    /// How a certificate is proved again in the page.
    verified: Option<Verified>,
}

impl Framed<'_> {
    /// The HTML file.
    fn html(&self) -> String {
        let style = format!("{}{}", include_str!("page.css"), include_str!("figure.css"));
        let sections: String = self.sections.iter().map(|(_, _, text)| text.as_str()).collect();
        let Provenance { tool, version } = self.provenance;
        let none = Verified::NONE;
        let Verified { note, scripts } = self.verified.as_ref().unwrap_or(&none);
        let mut policy = policy_source(SCRIPT);
        if !scripts.is_empty() {
            policy = format!("{policy} {}", policy_source(PROGRAM));
        }
        filled(
            FRAME,
            &[
                ("script-policy", &policy),
                ("style-policy", &policy_source(&style)),
                ("style", &style),
                ("script", SCRIPT),
                ("title", &xml(self.title)),
                ("subject", &xml(self.subject)),
                ("verdict", self.verdict),
                ("headline", &xml(self.headline)),
                ("meaning", self.meaning),
                ("verified-note", note),
                ("verified-scripts", scripts),
                ("contents", &contents(self.sections)),
                ("sections", &sections),
                ("version", env!("CARGO_PKG_VERSION")),
                ("kind", self.kind),
                ("written-by", &xml(&format!("{tool} {version}"))),
                ("data", &escape::data(&self.data.to_string())),
            ],
        )
    }
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

/// `NAME` of `NAME.cert.json` or `NAME.paving`.
fn stem(name: &str) -> &str {
    let name = name.strip_suffix(".json").unwrap_or(name);
    let name = name.strip_suffix(".paving").unwrap_or(name);
    name.strip_suffix(".cert").unwrap_or(name)
}

#[cfg(test)]
mod tests;
