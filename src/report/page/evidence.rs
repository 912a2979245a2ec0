//! What the proof, or the refutation, consists of, in tables.

use super::legend::OUTSIDE;
use super::mechanism::typeset;
use super::subdivision::{Leaf, Subdivision};
use crate::exact::decimal::{counted, grouped, significant};
use crate::report::escape::xml;
use crate::report::facts::RADICAND;
use std::fmt::Write;

/// Boxes listed among those where the proof worked hardest.
const HARDEST: usize = 8;

/// A requirement with the worst value that sampling found: what its row of the table says.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is bounded.
    pub requirement: String,
    /// By what.
    pub bound: String,
    /// The worst value found.
    pub found: String,
    /// Whether it is on the wrong side.
    pub is_violated: bool,
    /// How far it is from the bound.
    pub margin: String,
    /// Where it was found.
    pub at: String,
    /// For which machine; empty of a claim without tolerances.
    pub machine: String,
}

/// The table of the requirements and the worst values found.
pub fn margins(rows: &[Row]) -> String {
    let mut out = "<div class=\"table\" id=\"margins\"><table><thead><tr><th>requirement</th>\
         <th>bound</th><th class=\"number\">worst found</th><th class=\"number\">margin</th>\
         <th>at</th></tr></thead><tbody>"
        .to_owned();
    for row in rows {
        let class = if row.is_violated { "number bad" } else { "number" };
        let machine = if row.machine.is_empty() {
            String::new()
        } else {
            let machine = xml(&row.machine);
            format!("<details><summary>machine</summary>{machine}</details>")
        };
        let _ = write!(
            out,
            "<tr><td>{}</td><td class=\"place\">{}</td><td class=\"{class}\">{}{}</td>\
             <td class=\"number\">{}</td><td>{}{machine}</td></tr>",
            xml(&row.requirement),
            xml(&row.bound),
            xml(&row.found),
            if row.is_violated { " (violated)" } else { "" },
            xml(&row.margin),
            xml(&row.at),
        );
    }
    let of_radicands = match rows.iter().any(|row| row.requirement == RADICAND) {
        true => " The least radicand is 0 where reach ends, |det M| at a singularity.",
        false => "",
    };
    out + "</tbody></table></div><p class=\"note\">How close each requirement comes to its bound. The \
         bounds are what is claimed; the values are the worst that <strong>sampling</strong> found, in \
         floating point, and no proof. <code>orthocert bounds</code> proves enclosures of the extremes."
        + of_radicands
        + "</p>"
}

/// A margin in percent.
pub fn share(margin: f64) -> String {
    match 100.0 * margin {
        s if s.abs() < 5e-8 => "0, tight".to_owned(),
        s if s.abs() < 1e-3 => format!("{} %", significant(s, 2)),
        s => format!("{} %", significant(s, 3)),
    }
}

/// The counterexample of a refutation, and the table of its machine.
pub fn counterexample(rows: &[(String, String)], machine: &str) -> String {
    let mut out =
        "<section id=\"counterexample\"><h2>Counterexample</h2><p>One point (and machine) at \
         which a requirement provably fails. Its numbers are exact.</p>\
         <div class=\"table\"><table><tbody>"
            .to_owned();
    for (name, value) in rows {
        let (name, value) = (xml(&typeset(name)), xml(&typeset(value)));
        let _ = write!(out, "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>");
    }
    out + "</tbody></table></div>" + machine + "</section>\n"
}

/// The numbers of leaves at each depth, and the smallest boxes.
pub fn hardest(trees: &[Subdivision]) -> String {
    let depth = trees.iter().flat_map(|t| &t.leaves).map(|leaf| leaf.depth).max().unwrap_or(0);
    let mut counts = vec![0usize; depth + 1];
    for leaf in trees.iter().flat_map(|t| &t.leaves) {
        counts[leaf.depth] += 1;
    }
    let mut all: Vec<(usize, usize)> = Vec::new();
    for (t, tree) in trees.iter().enumerate() {
        let inside = |i: &usize| !is_outside(tree, &tree.leaves[*i]);
        all.extend((0..tree.leaves.len()).filter(inside).map(|i| (t, i)));
    }
    // The smallest box is the deepest: every split halves it. Boxes outside a cylinder are no work.
    all.sort_by_key(|&(t, i)| (std::cmp::Reverse(trees[t].leaves[i].depth), t, i));
    let depth = all.first().map_or(0, |&(t, i)| trees[t].leaves[i].depth);
    let deepest = all.iter().filter(|&&(t, i)| trees[t].leaves[i].depth == depth).count();
    let mut out = format!(
        "<h3 id=\"hardest\">Where the proof worked hardest</h3><p>Smallest: {}, at depth {depth}, each \
         1/2<sup>{depth}</sup> of the volume.{}</p>",
        counted(deepest, "box", "boxes"),
        if all.len() > HARDEST { format!(" The first {HARDEST} of {}:", counted(all.len(), "leaf", "leaves")) } else { String::new() },
    );
    out.push_str("<div class=\"table\"><table><thead><tr><th class=\"number\">depth</th>");
    let axes = trees.first().map_or(&[][..], |tree| &tree.axes[..]);
    for axis in axes {
        let _ = write!(out, "<th>{}</th>", xml(axis));
    }
    out.push_str("<th>closed by rule (obligation)</th></tr></thead><tbody>");
    for &(t, i) in all.iter().take(HARDEST) {
        let (tree, leaf) = (&trees[t], &trees[t].leaves[i]);
        let _ = write!(out, "<tr><td class=\"number\">{}</td>", leaf.depth);
        for (k, parts) in leaf.parts.iter().enumerate() {
            let [low, high] = parts.map(|u| tree.place(k, u));
            let digits = if (high - low).abs() < 1e-4 * tree.width[k].abs() { 10 } else { 6 };
            let (low, high) = (significant(low, digits), significant(high, digits));
            let _ = write!(out, "<td class=\"place\">{low} \u{2026} {high}</td>");
        }
        let name = if trees.len() > 1 { format!("{}: ", tree.name) } else { String::new() };
        let _ = write!(out, "<td>{}{}</td></tr>", xml(&name), xml(&closed_by(tree, leaf)));
    }
    out.push_str("</tbody></table></div><p class=\"note\">The ends of the boxes are rounded.");
    if axes.iter().any(|axis| axis.starts_with("about ")) {
        out.push_str(
            " Angles about x, y, z are twice the arc tangents of the coordinates of c = tan(theta/2) axis, \
             where the platform is turned by theta about the axis.",
        );
    }
    out.push_str("</p>");
    out.push_str(&histogram(&counts));
    out
}

fn is_outside(tree: &Subdivision, leaf: &Leaf) -> bool {
    leaf.own.iter().any(|rule| tree.legend.rules[usize::from(*rule)].name == OUTSIDE)
}

/// `lower (sigma_min), range (joint_range)`: what was left to the leaf itself.
fn closed_by(tree: &Subdivision, leaf: &Leaf) -> String {
    let of_rule = |rule: &u8| {
        let obligations = tree.legend.obligations.iter().zip(&leaf.by);
        let shown: Vec<&str> = obligations
            .filter(|(_, by)| **by == Some(*rule))
            .map(|(obligation, _)| obligation.as_str())
            .collect();
        let name = &tree.legend.rules[usize::from(*rule)].name;
        if shown.is_empty() {
            name.clone()
        } else {
            format!("{name} ({})", shown.join(", "))
        }
    };
    let mut rules = leaf.own.clone();
    rules.dedup();
    rules.iter().map(of_rule).collect::<Vec<_>>().join(", ")
}

fn histogram(counts: &[usize]) -> String {
    let mut out =
        "<details><summary>Leaves at each depth</summary><div class=\"table\"><table><thead><tr>\
         <th class=\"number\">depth</th><th class=\"number\">leaves</th></tr></thead><tbody>"
            .to_owned();
    for (depth, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let count = grouped(*count as u64);
        let _ = write!(
            out,
            "<tr><td class=\"number\">{depth}</td><td class=\"number\">{count}</td></tr>"
        );
    }
    out + "</tbody></table></div></details>"
}
