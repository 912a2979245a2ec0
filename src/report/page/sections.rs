//! The sections of a page, in their order.

use super::legend::PATTERNS;
use super::legs::Numbers;
use super::scene::Slice;
use super::subdivision::Subdivision;
use super::{evidence, general, mechanism, recheck, words, Page, Picture};
use crate::exact::decimal::grouped;
use crate::report::escape::xml;
use orthocert_checker::certificate::{Proof, Verdict};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{Mechanism, NoCubeClaim};
use std::fmt::Write;

impl Page<'_> {
    /// Anchor, name and text of every section.
    pub(super) fn sections(&self) -> Vec<(&'static str, &'static str, String)> {
        let verdict = self.accepted.verdict;
        let mut all = vec![
            ("overview", "Overview", self.overview()),
            ("claim", "Claim", words::claim_section(&self.certificate.claim, verdict)),
        ];
        let counterexample = match (&self.certificate.claim, &self.certificate.proof) {
            (Claim::Machine(claim), Proof::Witness(witness)) => {
                Some(general::counterexample(claim, witness))
            }
            _ => None,
        };
        if let Some((rows, machine)) = counterexample {
            let section = evidence::counterexample(&rows, &machine);
            all.push(("counterexample", "Counterexample", section));
        }
        all.push(("machine", "Machine", self.machine_section()));
        if let Some(slice) = self.scene.slices.first() {
            let still = match self.machine {
                Some((_, Some(_))) => {
                    all.push(("maps", "Transmission factors", self.maps_section(slice)));
                    &self.scene.slices[1..]
                }
                _ => &self.scene.slices[..],
            };
            if !still.is_empty() {
                all.push(("still", "Maps", maps_of_slices(still)));
            }
        }
        all.push(("proof", "Proof", self.proof_section()));
        let version = env!("CARGO_PKG_VERSION");
        let recheck = recheck::section(self.file.name, self.file.bytes, version);
        all.push(("recheck", "Check it again", recheck));
        all
    }

    /// What a designer signs: the verdict, of which machine, where, and what is required, with the
    /// worst values found; then what the proof consists of.
    fn overview(&self) -> String {
        let mut signed = vec![("verdict", self.accepted.verdict.to_string())];
        if let Some([machine, workspace]) = words::machine_and_workspace(&self.certificate.claim) {
            signed.extend([("machine", machine), ("workspace", workspace)]);
        }
        let mut out = "<section id=\"overview\"><h2>Overview</h2><dl class=\"signed\">".to_owned();
        if let Some(nearest) = &self.scene.nearest {
            signed.push(nearest.clone());
        }
        let mut signed: Vec<(String, String)> =
            signed.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        signed.extend(
            self.signed.iter().map(|(name, ends)| (mechanism::typeset(name), ends.clone())),
        );
        signed.extend(self.unit.map(|unit| ("lengths in".to_owned(), unit.to_owned())));
        signed.extend(self.notes.iter().map(|note| ("note".to_owned(), note.clone())));
        for (name, value) in signed {
            let _ = write!(out, "<dt>{}</dt><dd>{}</dd>", xml(&name), xml(&value));
        }
        out.push_str("</dl>");
        if !self.signed.is_empty() {
            out.push_str(SIGNED);
        }
        if !self.scene.rows.is_empty() {
            out.push_str(&evidence::margins(&self.scene.rows));
        }
        out + "</section>\n"
    }

    /// The proof in numbers.
    fn facts(&self) -> String {
        let size = &self.accepted.size;
        let mut facts = Vec::new();
        match &self.certificate.proof {
            Proof::Witness(_) => {
                facts.push(("proof", "one counterexample".to_owned()));
            }
            Proof::Atlas(cells) => {
                facts.push(("cells and their halvings", grouped(cells.len() as u64)));
            }
            Proof::Tree(_) => {
                let cover = match self.certificate.claim {
                    Claim::NoCube(_) => "boxes that cover the centres",
                    _ => "boxes that cover the workspace",
                };
                facts.push((cover, grouped(size.leaves as u64)));
                facts.push(("boxes in all", grouped(size.nodes as u64)));
                facts.push(("halvings, at most", size.depth.to_string()));
                let of_tolerances = |tree: &Subdivision| tree.code.matches('T').count();
                let halved: usize = self.scene.trees.iter().map(of_tolerances).sum();
                if halved > 0 {
                    facts.push(("of them, of tolerances", halved.to_string()));
                }
            }
        }
        let bits = match &self.certificate.proof {
            Proof::Tree(tree) => Some(tree.precision),
            Proof::Witness(witness) => Some(witness.precision),
            // Each cell has its own.
            Proof::Atlas(_) => None,
        };
        facts.extend(bits.map(|bits| ("fractional bits", bits.to_string())));
        facts.push(("certificate", self.file.name.to_owned()));
        let mut out = "<dl class=\"facts\">".to_owned();
        for (name, value) in facts {
            let class = if name == "certificate" { " class=\"wide\"" } else { "" };
            let _ = write!(out, "<div{class}><dt>{name}</dt><dd>{}</dd></div>", xml(&value));
        }
        out + "</dl>"
    }

    fn machine_section(&self) -> String {
        let mut out = "<section id=\"machine\"><h2>The machine</h2>".to_owned();
        let (Some(shape), Some(design)) = (&self.scene.shape, &self.figures.design) else {
            if let Claim::Machine(claim) | Claim::NoCube(NoCubeClaim { machine: claim, .. }) =
                &self.certificate.claim
            {
                let reason = match claim.mechanism {
                    Mechanism::Formulas(_) => "formulas do not say where its parts are",
                    _ => "its numbers are beyond what floating point can show",
                };
                let parameters = mechanism::parameters(claim);
                let _ = write!(out, "<p>There is no drawing: {reason}.</p>{parameters}</section>");
                return out;
            }
            let reason = if self.is_machine() {
                "its numbers are beyond what floating point can show"
            } else {
                "the claim is about many machines"
            };
            let _ = write!(out, "<p>There is no drawing, and no map of transmission factors: {reason}.</p></section>");
            return out;
        };
        let planar = shape.legs.iter().any(|leg| matches!(leg, Numbers::Planar { .. }));
        let note = if planar {
            " Planar legs are drawn schematically, from a guide beside the workspace."
        } else {
            ""
        };
        let unit = if self.is_machine() { "" } else { " Its leg length L is 1." };
        let turned = match &self.certificate.claim {
            Claim::Machine(claim) if claim.orientation.is_some() => {
                " The platform is in the middle of its orientations."
            }
            _ => "",
        };
        let _ = write!(
            out,
            "<figure>{}<figcaption>The nominal machine (every parameter in the middle of its tolerance): {} to the \
             platform at P, the workspace in colour.{note}{unit}{turned}</figcaption></figure>",
            design.inline(),
            drawn(&shape.legs, self.in_plane())
        );
        match &self.certificate.claim {
            Claim::Machine(claim) if !matches!(claim.mechanism, Mechanism::Orthoglide { .. }) => {
                out.push_str(&mechanism::parameters(claim));
            }
            Claim::NoCube(NoCubeClaim { machine: claim, .. }) => {
                out.push_str(&mechanism::parameters(claim));
            }
            _ => {
                let machine = self.machine.as_ref().map(|(machine, _)| machine);
                out.extend(machine.and_then(words::parameters_of_cube));
            }
        }
        out + "</section>\n"
    }

    fn in_plane(&self) -> bool {
        matches!(&self.certificate.claim, Claim::Machine(claim) if matches!(claim.mechanism, Mechanism::Planar(_)))
    }

    fn maps_section(&self, Slice { maps, legends, fixed }: &Slice) -> String {
        let cube = self.machine.as_ref().map(|(machine, _)| machine).filter(|m| m.is_cube);
        let at = if cube.is_some() { " The first slice is the one through Q\u{2081}." } else { "" };
        let maps: String = maps.iter().map(Picture::inline).collect();
        format!(
            "<section id=\"maps\"><h2>Velocity transmission factors</h2>\
             <p>Lines of equal \u{3c8}<sub>1</sub> \u{2264} \u{3c8}<sub>2</sub> \u{2264} \u{3c8}<sub>3</sub> of the \
             nominal machine over a plane z = const, in floating point.{at} Hatched: out of reach of a leg.</p>\
             <div class=\"controls scripted\"><label for=\"slice\">z <input type=\"range\" id=\"slice\" min=\"0\" max=\"200\" step=\"1\"></label>\
             <output id=\"slice-value\" for=\"slice\"></output><button type=\"button\" id=\"slice-reset\">First slice</button></div>\
             <figure><div class=\"maps\">{maps}</div><div class=\"maps legends\">{legends}</div>\
             <output class=\"readout scripted\" id=\"map-readout\" aria-live=\"polite\">Point at a map, or focus one and \
             move the cross with the arrow keys, to read the values there.</output>\
             <figcaption class=\"scripted\">Keys on a map: <kbd>\u{2190}</kbd> <kbd>\u{2192}</kbd> <kbd>\u{2191}</kbd> <kbd>\u{2193}</kbd> move the \
             cross (with <kbd>Shift</kbd> in large steps), <kbd>Page Up</kbd> <kbd>Page Down</kbd> move the slice.</figcaption>\
             <figcaption class=\"static\">{fixed}</figcaption></figure>{corners}</section>\n",
            legends = legends.concat(),
            corners = cube.map(words::corners).unwrap_or_default(),
        )
    }

    fn proof_section(&self) -> String {
        let refuted = self.accepted.verdict == Verdict::Refuted;
        let mut out = "<section id=\"proof\"><h2>The proof</h2>".to_owned();
        if refuted {
            out.push_str("<p>A refutation needs one point and no subdivision; here it is in the workspace.</p>");
        } else if let Claim::NoCube(_) = self.certificate.claim {
            out.push_str(
                "<p>The box of the centres is halved until, for every box, one point of the cube is shown to \
                 violate a requirement whatever centre of the box the cube has.</p>",
            );
        } else {
            out.push_str(
                "<p>The workspace is halved until every requirement can be shown on every box by one of the \
                 checker's rules. A requirement shown on a box holds on all its parts.</p>",
            );
        }
        if self.scene.trees.iter().all(Subdivision::is_spatial) {
            out.push_str(VIEWER);
        }
        for (picture, tree) in self.figures.subdivisions.iter().zip(&self.scene.trees) {
            // What the viewer shows in a browser stands here for print.
            let class = if tree.is_spatial() { " class=\"static\"" } else { "" };
            let _ = write!(
                out,
                "<figure{class}>{}<figcaption>{}</figcaption></figure>",
                picture.inline(),
                xml(&match self.certificate.claim {
                    Claim::NoCube(_) => tree.name.clone(),
                    _ => caption(tree),
                })
            );
        }
        if !refuted {
            out.push_str(&self.legend());
            out.push_str(&evidence::hardest(&self.scene.trees));
        }
        out + &self.facts() + "</section>\n"
    }

    /// The rules that are used, with their colours, patterns and uses.
    fn legend(&self) -> String {
        let mut out = "<ul class=\"legend\" aria-label=\"Rules used\">".to_owned();
        let Some(legend) = self.scene.trees.first().map(|tree| &tree.legend) else {
            return String::new();
        };
        for (k, rule) in legend.rules.iter().enumerate() {
            let uses: usize = self.scene.trees.iter().filter_map(|tree| tree.uses.get(k)).sum();
            if uses == 0 {
                continue;
            }
            let used_for = rule.used_for.as_ref();
            let used_for = used_for.map_or(String::new(), |name| format!(" for {}", xml(name)));
            let d = PATTERNS[rule.pattern];
            let _ = write!(
                out,
                "<li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><defs><pattern id=\"legend-{k}\" \
                 width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\"><rect width=\"8\" height=\"8\" fill=\"{}\"/>\
                 <path class=\"pattern\" d=\"{d}\"/></pattern></defs><rect class=\"leaf\" width=\"26\" height=\"16\" \
                 fill=\"url(#legend-{k})\"/></svg><span><code>{}</code>{used_for} \u{d7} {}</span></li>",
                rule.colour,
                rule.name,
                grouped(uses as u64)
            );
        }
        out + "</ul>"
    }
}

/// What a drawing shows of legs: those of arms in the plane have axes that are seen as points.
fn drawn(legs: &[Numbers], in_plane: bool) -> String {
    let any = |is: fn(&Numbers) -> bool| legs.iter().any(is);
    let guides = any(|leg| matches!(leg, Numbers::Slider { .. } | Numbers::Planar { .. }));
    let arms = any(|leg| matches!(leg, Numbers::Arm { .. }));
    let parts = [
        (guides, "guides dash-dotted, "),
        (arms && !in_plane, "axes of the motors dash-dotted, "),
        (arms, "arms from A<sub>i</sub> to B<sub>i</sub>, "),
        (true, "legs from B<sub>i</sub>"),
    ];
    parts.into_iter().filter_map(|(is_there, words)| is_there.then_some(words)).collect()
}

fn caption(tree: &Subdivision) -> String {
    let name = tree.name.as_str();
    if tree.leaves.is_empty() {
        return name.to_owned();
    }
    if tree.axes.len() > 3 {
        return format!("{name}, by pairs of coordinates: the deeper a box, the darker");
    }
    let is_face = tree.is_face();
    let parts = if is_face { ", y and z as parts of [q1, q2]" } else { "" };
    let obligation = &tree.legend.obligations[tree.filled_by];
    format!("{name}{parts}; boxes are filled by the rule for {obligation}")
}

/// The maps of a kernel claim.
fn maps_of_slices(slices: &[Slice]) -> String {
    let mut out = "<section id=\"still\"><h2>Maps</h2><p>Lines of equal value of the nominal machine over \
         two coordinates, the others where the workspace is nearest to a limit, or at the counterexample, in \
         floating point: of the greatest \u{3c8}, and of the requirement, other than that on the greatest \
         \u{3c8}, of which least is left. Marked: that point, and the worst of each map. Hatched: outside the \
         workspace, or out of reach.</p>"
        .to_owned();
    for Slice { maps, legends, fixed } in slices {
        let maps: String = maps.iter().map(Picture::inline).collect();
        let at = if fixed.is_empty() { String::new() } else { format!("at {}", xml(fixed)) };
        let _ = write!(
            out,
            "<figure><div class=\"maps still\">{maps}</div><div class=\"maps still legends\">{}</div>\
             <figcaption>{at}</figcaption></figure>",
            legends.concat()
        );
    }
    out + "</section>\n"
}

/// What is said of ranges.
const SIGNED: &str = "<p class=\"note\">Strokes, factors, speeds and the like never leave these ranges, at no point \
    and for no machine of the claim: the exact checker has accepted a proof of each end when this page was made. An end with a * is what the claim \
    requires, and may be far from what the machine reaches. \
    <code>orthocert bounds -o</code> keeps such proofs.</p>";

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
