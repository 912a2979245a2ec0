//! The sections of a paving's page, in their order.

use super::super::{mechanism, recheck, theorem, words};
use super::PavingPage;
use crate::exact::decimal::{begun, grouped, percent, significant, Toward};
use crate::exact::Exact;
use crate::report::escape::xml;
use num_rational::BigRational;
use orthocert_kernel::paving::{Share, Summary, SHARE_BITS};
use orthocert_kernel::statement;
use std::fmt::Write;

/// Components that are listed.
const SHOWN: usize = 8;

impl PavingPage<'_> {
    /// Anchor, name and text of every section.
    pub(super) fn sections(&self) -> Vec<(&'static str, &'static str, String)> {
        let version = env!("CARGO_PKG_VERSION");
        let recheck = recheck::of_paving(self.file.name, self.file.bytes, version);
        vec![
            ("overview", "Overview", self.overview()),
            ("region", "Region", self.region_section()),
            ("slices", "Slices", self.slices_section()),
            ("components", "Components", self.components_section()),
            ("claim", "Claim", self.claim_section()),
            ("machine", "Machine", self.machine_section()),
            ("recheck", "Check it again", recheck),
        ]
    }

    fn overview(&self) -> String {
        let (summary, header) = (&self.accepted.summary, &self.accepted.header);
        let Summary { inner_share: Share(inner), boundary_share: Share(boundary), .. } =
            self.accepted.summary;
        let outer = Share((1 << SHARE_BITS) - inner - boundary);
        let [low, high] = self.volume();
        let gap = match (inner, boundary) {
            (_, 0) => "0".to_owned(),
            (0, _) => "none: no box is inner".to_owned(),
            _ => percent(&BigRational::new(boundary.into(), inner.into()), 3, Toward::Above),
        };
        let mut out = "<section id=\"overview\"><h2>Overview</h2><dl class=\"facts\">".to_owned();
        for (name, value) in [
            ("volume, at least", low),
            ("volume, at most", high),
            ("gap: undecided over inner", gap),
            ("halvings, at most", header.depth.to_string()),
            ("paving", self.file.name.to_owned()),
        ] {
            let class = if name == "paving" { " class=\"wide\"" } else { "" };
            let _ = write!(out, "<div{class}><dt>{name}</dt><dd>{}</dd></div>", xml(&value));
        }
        out.push_str(
            "</dl><div class=\"table\"><table><thead><tr><th>boxes</th><th class=\"number\">number</th>\
             <th class=\"number\">share of the box</th><th>what is proved of them</th></tr></thead><tbody>",
        );
        for (name, boxes, (share, toward), what) in [
            (
                "inner",
                summary.inner,
                (summary.inner_share, Toward::Below),
                "all requirements hold at every point, for every machine of the claim",
            ),
            (
                "outer",
                summary.outer,
                (outer, Toward::Below),
                "at every point some requirement fails",
            ),
            (
                "undecided",
                summary.boundary,
                (summary.boundary_share, Toward::Above),
                "nothing; of those that planes cut, it is what lies between these",
            ),
        ] {
            let _ = write!(
                out,
                "<tr><td>{name}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{what}</td></tr>",
                grouped(boxes),
                Self::percent(share, toward)
            );
        }
        out.push_str("</tbody></table></div>");
        if let Some(own) = &header.coordinates {
            let own = xml(&own.join(", "));
            let _ = write!(
                out,
                "<p class=\"note\">Paved are ({own}), for all values of the other coordinates in the workspace; \
                 angles are in degrees.</p>"
            );
        }
        if header.symmetry.is_some() {
            out.push_str(
                "<p class=\"note\">The machine looks the same from permuted axes: only points with x \u{2264} y \
                 \u{2264} z are paved, and the shares count all images.</p>",
            );
        }
        out + "</section>\n"
    }

    /// What is said of a picture that stops at a depth.
    fn stops(depth: Option<u32>) -> String {
        let Some(depth) = depth else {
            return "All boxes of the paving are shown.".to_owned();
        };
        format!(
            "Drawn with boxes of at least 2<sup>\u{2212}{depth}</sup> of the box that was searched: smaller ones \
             count as undecided here, unless all that such a box is cut into are inner, or all outer. The inner \
             part is larger than its picture."
        )
    }

    fn region_section(&self) -> String {
        let [view, picture, _] = self.depths;
        let named = self.axes.iter().enumerate().filter(|(_, name)| !name.is_empty());
        let option =
            |(k, name): (usize, &String)| format!("<option value=\"{k}\">{}</option>", xml(name));
        let options: String = named.map(option).collect();
        format!(
            "<section id=\"region\"><h2>The region in space</h2>\
             <p>The surface of the inner boxes: within it, all requirements are proved. Outside, up to the \
             undecided boxes, they may hold too.</p>{}<p class=\"note scripted\">{}</p>\
             <figure class=\"static\">{}<figcaption>{}</figcaption></figure>{LEGEND}</section>\n",
            VIEWER.join(&options),
            Self::stops(view),
            self.picture("region"),
            Self::stops(picture)
        )
    }

    fn slices_section(&self) -> String {
        format!(
            "<section id=\"slices\"><h2>Slices</h2><figure>{}<figcaption>{} White: outer, no point meets the \
             requirements.{} {}</figcaption></figure>{SLICE_LEGEND}</section>\n",
            self.picture("slices"),
            self.planes(),
            if self.marks.is_empty() { "" } else { " Dot: the best conditioned point found, near its plane." },
            Self::stops(self.depths[2])
        )
    }

    fn planes(&self) -> String {
        let [x, y, z] = self.axes.each_ref().map(|name| xml(name));
        let axes = format!("{x} to the right and {y} up.");
        match (y.is_empty(), z.is_empty()) {
            (true, _) => format!("{x} to the right."),
            (_, true) => axes,
            _ => format!("Planes {z} = const through the inner part, {axes}"),
        }
    }

    fn components_section(&self) -> String {
        let mut out = "<section id=\"components\"><h2>Connected components</h2>".to_owned();
        let Some(found) = self.components else {
            out.push_str("<p>No box is inner, or there are too many to tell components apart.</p></section>\n");
            return out;
        };
        let count: u64 = found.all.iter().map(|component| component.copies).sum();
        let _ = write!(
            out,
            "<p>The inner boxes make up <strong>{}</strong>, connected by shared faces; what is apart here may \
             join in undecided boxes. Parts of boxes that planes cut are in none of them.</p>",
            if count == 1 { "one component".to_owned() } else { format!("{} components", grouped(count)) }
        );
        out.push_str(
            "<div class=\"table\"><table><thead><tr><th class=\"number\">share of the box</th><th class=\"number\">boxes \
             paved</th><th class=\"number\">images, itself included</th><th>contains</th></tr></thead><tbody>",
        );
        for component in found.all.iter().take(SHOWN) {
            let share = Self::percent(Share(component.share), Toward::Below);
            let contains = if component.best_conditioned {
                let at = self
                    .marks
                    .iter()
                    .flat_map(|mark| mark.at.iter().take(self.dimension))
                    .map(|x| significant(*x, 3));
                let at = at.collect::<Vec<_>>().join(", ");
                format!(
                    "the {}, condition number {} at ({at})",
                    found.what_is_there(),
                    significant(found.conditioning, 4)
                )
            } else {
                String::new()
            };
            let _ = write!(
                out,
                "<tr><td class=\"number\">{share}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
                 <td>{contains}</td></tr>",
                grouped(component.boxes),
                component.copies
            );
        }
        out.push_str("</tbody></table></div>");
        if found.all.len() > SHOWN {
            let _ = write!(out, "<p class=\"note\">The {SHOWN} largest are listed.</p>");
        }
        out + "</section>\n"
    }

    fn claim_section(&self) -> String {
        let mut read = self.accepted.clone();
        theorem::in_decimals(&mut read.header.claim.machine);
        let [mut read, exact] = [&read, self.accepted].map(statement::paving);
        let Summary { inner_share, boundary_share, .. } = &self.accepted.summary;
        // With their lines, as one may begin the other.
        for share in [*inner_share, Share(inner_share.0.saturating_add(boundary_share.0))] {
            let decimals = begun(&Exact::Rational(share.fraction()), mechanism::LONGEST);
            for end in ["\n", ".\n"] {
                read = read.replace(&format!("  {share}{end}"), &format!("{decimals}{end}"));
            }
        }
        let mut out = format!(
            "<section id=\"claim\"><h2>What is proved</h2>{}<h3>In formulas</h3><p><var>R</var>: the points <var>P</var> of the box with:</p>\
             <ul class=\"formulas\">",
            theorem::shown(&read, &exact)
        );
        for requirement in &self.claim.require {
            let formula = words::symbols(&xml(&mechanism::formula(requirement)));
            let _ = write!(out, "<li>{formula}</li>");
        }
        out + "</ul></section>\n"
    }

    fn machine_section(&self) -> String {
        let figure = match self.picture("design") {
            none if none.is_empty() => {
                "<p>Its numbers are beyond what floating point can show.</p>".to_owned()
            }
            drawing => format!(
                "<figure>{drawing}<figcaption>The nominal machine (every parameter in the middle of its \
                 tolerance), and the box that is paved in colour.</figcaption></figure>"
            ),
        };
        let parameters = mechanism::parameters(self.claim);
        format!("<section id=\"machine\"><h2>The machine</h2>{figure}{parameters}</section>\n")
    }
}

/// The controls of the view in space, between them the axes' names.
const VIEWER: [&str; 2] = ["<div class=\"scripted\" id=\"region-viewer\"><div class=\"controls\">\
    <label for=\"region-axis\">cut along <select id=\"region-axis\">", "</select></label>\
    <label for=\"region-cut\">at <input type=\"range\" id=\"region-cut\" min=\"0\" max=\"1000\" value=\"1000\"></label>\
    <output id=\"region-cut-value\" for=\"region-cut\"></output>\
    <button type=\"button\" id=\"region-reset\">Reset view</button></div>\
    <canvas id=\"region-space\" width=\"900\" height=\"600\" tabindex=\"0\" role=\"img\" aria-label=\"The inner boxes of \
    the paving in space; arrow keys turn the view\"></canvas>\
    <output class=\"readout\" id=\"region-readout\" aria-live=\"polite\"></output>\
    <p class=\"note\">Drag, or use the arrow keys, to turn; <kbd>+</kbd> <kbd>\u{2212}</kbd> to scale; <kbd>[</kbd> \
    <kbd>]</kbd> move the cut; point at a box, or press <kbd>Enter</kbd> for the one in the middle, to read it.</p></div>"];

const LEGEND: &str = "<ul class=\"legend\" aria-label=\"Colours\">\
    <li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"wall-1\" width=\"26\" height=\"16\"/></svg>\
    <span>faces beside undecided or outer boxes</span></li>\
    <li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"side-1\" width=\"26\" height=\"16\"/></svg>\
    <span>where the region reaches the side of the box that was searched</span></li>\
    <li class=\"scripted\"><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"slice-inner\" width=\"26\" \
    height=\"16\"/></svg><span>inner, on the cut</span></li>\
    <li class=\"scripted\"><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"slice-undecided\" width=\"26\" \
    height=\"16\"/></svg><span>undecided, on the cut</span></li></ul>";

const SLICE_LEGEND: &str = "<ul class=\"legend\" aria-label=\"Colours of slices\">\
    <li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"slice-inner\" width=\"26\" height=\"16\"/></svg>\
    <span>inner: all requirements hold</span></li>\
    <li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"slice-undecided\" width=\"26\" \
    height=\"16\"/></svg><span>undecided</span></li>\
    <li><svg class=\"figure\" viewBox=\"0 0 26 16\" aria-hidden=\"true\"><rect class=\"slice-outer\" width=\"26\" \
    height=\"16\"/></svg><span>outer: some requirement fails</span></li></ul>";
