//! What the proof, or the refutation, consists of, in tables.

use super::subdivision::{parts, Subdivision, RULES};
use crate::decimal::{approximate, counted, exact, grouped, significant};
use crate::escape::xml;
use crate::report::{point_text, Counterexample, Row};
use orthocert_checker::number::Exact;
use orthocert_checker::rule::Obligation;
use std::fmt::Write;

/// Boxes listed among those where the proof worked hardest.
const HARDEST: usize = 8;

/// The table of the worst values found.
pub fn margins(rows: &[Row]) -> String {
    let mut out = "<section id=\"margins\"><h2>Margins</h2><p>How close each requirement comes to its \
         bound. The bounds are what is proved; the values here are the worst that <strong>sampling</strong> \
         found, in floating point, and no proof. <code>orthocert bounds</code> proves enclosures of the \
         extremes.</p><div class=\"table\"><table><thead><tr><th>requirement</th><th class=\"number\">bound</th>\
         <th class=\"number\">worst found</th><th class=\"number\">margin</th><th>at P = (x, y, z)</th></tr></thead><tbody>"
        .to_owned();
    for row in rows {
        let at = point_text(&row.at, 6);
        let found = row.worst_found.map_or("out of reach".to_owned(), |x| significant(x, 9));
        let class = if row.seems_violated { "number bad" } else { "number" };
        let _ = write!(
            out,
            "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"{class}\">{found}{}</td>\
             <td class=\"number\">{}</td><td>{at}{}</td></tr>",
            xml(&row.requirement),
            xml(&row.bound_text),
            if row.seems_violated { " (violated)" } else { "" },
            margin(row),
            machine(row)
        );
    }
    out + "</tbody></table></div></section>\n"
}

/// The distance to the bound, as a part of it where it is not zero.
fn margin(row: &Row) -> String {
    let number = |text: &str| approximate(&Exact::parse(text, 1000).ok()?);
    let Some((relation, bound)) = row.bound.split_once(' ') else {
        return String::new();
    };
    let (Some(found), Some(bound)) = (row.worst_found, number(bound)) else {
        return "\u{2013}".to_owned();
    };
    let slack = if relation == "<=" { bound - found } else { found - bound };
    if bound == 0.0 {
        return significant(slack, 4);
    }
    let share = 100.0 * slack / bound.abs();
    match share {
        s if s.abs() < 5e-8 => "0, tight".to_owned(),
        s if s.abs() < 1e-3 => format!("{} %", significant(s, 2)),
        s => format!("{} %", significant(s, 3)),
    }
}

fn machine(row: &Row) -> String {
    if row.machine.is_empty() {
        return String::new();
    }
    let settings: Vec<String> = row
        .machine
        .iter()
        .map(|p| {
            let leg = p.leg.map(|leg| format!("leg {leg} ")).unwrap_or_default();
            format!("{leg}{} {}", p.parameter, significant(p.value, 7))
        })
        .collect();
    format!("<details><summary>machine</summary>{}</details>", xml(&settings.join(", ")))
}

/// The counterexample of a refutation.
pub fn counterexample(found: &Counterexample) -> String {
    let point = |p: &Vec<Exact>| {
        let all: Vec<String> = p.iter().map(exact).collect();
        xml(&format!("({})", all.join(", ")))
    };
    let mut rows = vec![
        ("violated".to_owned(), xml(&found.violated)),
        ("value there".to_owned(), xml(&found.value)),
        ("at P".to_owned(), point(&found.point)),
    ];
    rows.extend(found.other_point.iter().map(|p| ("and at P'".to_owned(), point(p))));
    for setting in &found.machine {
        let leg = setting.leg.map(|leg| format!("leg {leg} ")).unwrap_or_default();
        let name = xml(&format!("{leg}{}", setting.parameter));
        rows.push((name, xml(&exact(&setting.value))));
    }
    for direction in &found.directions {
        let all: Vec<String> = direction.iter().map(i64::to_string).collect();
        rows.push(("moving along".to_owned(), format!("({})", all.join(", "))));
    }
    let mut out = "<section id=\"counterexample\"><h2>Counterexample</h2><p>One point (and machine) at \
         which a requirement provably fails. Coordinates are exact; digits of the value are certified.</p>\
         <div class=\"table\"><table><tbody>"
        .to_owned();
    for (name, value) in rows {
        let _ = write!(out, "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>");
    }
    out + "</tbody></table></div></section>\n"
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
        let inside = |i: &usize| !tree.leaves[*i].own.iter().any(|rule| is_outside(*rule));
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
    let axes = trees.first().map_or(["x", "y", "z"], |tree| tree.axes);
    for axis in axes {
        let _ = write!(out, "<th>{axis}</th>");
    }
    out.push_str("<th>closed by rule (obligation)</th></tr></thead><tbody>");
    for &(t, i) in all.iter().take(HARDEST) {
        let (tree, leaf) = (&trees[t], &trees[t].leaves[i]);
        let _ = write!(out, "<tr><td class=\"number\">{}</td>", leaf.depth);
        for k in 0..3 {
            let [low, high] = parts(leaf.cell.edges[k]).map(|u| tree.least[k] + u * tree.width[k]);
            let digits = if (high - low).abs() < 1e-4 * tree.width[k].abs() { 10 } else { 6 };
            let (low, high) = (significant(low, digits), significant(high, digits));
            let _ = write!(out, "<td class=\"place\">{low} \u{2026} {high}</td>");
        }
        let name = if trees.len() > 1 { format!("{}: ", tree.name) } else { String::new() };
        let _ = write!(out, "<td>{}{}</td></tr>", xml(&name), xml(&closed_by(leaf.by, &leaf.own)));
    }
    out.push_str("</tbody></table></div><p class=\"note\">The ends of the boxes are rounded.</p>");
    out.push_str(&histogram(&counts));
    out
}

fn is_outside(rule: u8) -> bool {
    RULES[usize::from(rule)].name == "outside"
}

/// `lower (sigma_min), range (joint_range)`: what was left to the leaf itself.
fn closed_by(by: [Option<u8>; Obligation::ALL.len()], own: &[u8]) -> String {
    let of_rule = |rule: &u8| {
        let shown: Vec<String> = Obligation::ALL
            .iter()
            .zip(by)
            .filter(|(_, by)| *by == Some(*rule))
            .map(|(obligation, _)| obligation.to_string())
            .collect();
        let name = RULES[usize::from(*rule)].name;
        if shown.is_empty() {
            name.to_owned()
        } else {
            format!("{name} ({})", shown.join(", "))
        }
    };
    own.iter().map(of_rule).collect::<Vec<_>>().join(", ")
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
