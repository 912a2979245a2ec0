//! The subdivision that a proof consists of: its boxes, by the rules that close them.

use super::isomap::Mark;
use super::nominal::Point;
use super::svg::{Elements, Fitted, Picture, View};
use orthocert_checker::cell::{Axis, Cell, Edge};
use orthocert_checker::certificate::{Node, Step};
use orthocert_checker::rule::Obligation;
use serde::Serialize;
use std::array::from_fn;
use std::fmt::Write;

/// A rule as figures show it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RuleStyle {
    /// The rule's name in certificates.
    pub name: &'static str,
    /// Its fill, distinct for those who do not tell colours apart (after Okabe and Ito).
    pub colour: &'static str,
    /// The number of its pattern: [`PATTERNS`].
    pub pattern: usize,
}

const fn style(name: &'static str, colour: &'static str, pattern: usize) -> RuleStyle {
    RuleStyle { name, colour, pattern }
}

/// Every rule; a letter of a tree's code is a position here.
pub const RULES: [RuleStyle; 16] = [
    style("lower", "#8ecae6", 0),
    style("corner", "#f4a340", 1),
    style("upper", "#74c69d", 2),
    style("cube", "#5aae8a", 3),
    style("range", "#f2e279", 1),
    style("conditioning", "#7da7d9", 3),
    style("serial_margin", "#e8936b", 2),
    style("parallel_margin", "#b9a3d9", 1),
    style("leg_angle", "#c9a66b", 3),
    style("speed", "#9fd3c7", 4),
    style("outside", "#eceff3", 5),
    style("blow_up", "#8ecae6", 0),
    style("edge", "#f4a340", 1),
    style("mirror", "#d3a4c8", 3),
    style("entrywise", "#6fa8dc", 1),
    style("violated", "#e5989b", 2),
];

/// Lines of the patterns, on squares of eight units.
pub const PATTERNS: [&str; 6] = [
    "",
    "M-2 10L10 -2M-2 2L2 -2M6 10L10 6",
    "M2 2h1.4M6 6h1.4",
    "M-2 -2L10 10M6 -2L10 2M-2 6L2 10",
    "M0 4H8M4 0V8",
    "M3 5L5 3",
];

/// Rectangles of a face that are drawn one by one; beyond, the face is drawn on a grid.
const MOST: usize = 2500;
/// Least breadth of a rectangle that is outlined.
const OUTLINED: f64 = 1.6;
/// Squares of that grid on either side.
const GRID: usize = 80;

/// A box that is not split.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The box.
    pub cell: Cell,
    /// How often it was halved.
    pub depth: usize,
    /// For each obligation, the position of the rule that discharged it on the path.
    pub by: [Option<u8>; Obligation::ALL.len()],
    /// The positions of the rules used on the leaf itself.
    pub own: Vec<u8>,
}

/// A tree to be shown.
#[derive(Clone, Debug)]
pub struct Subdivision {
    /// What it covers.
    pub name: String,
    /// Names of the axes.
    pub axes: [&'static str; 3],
    /// The root's least corner and edges, in the units of the axes.
    pub least: Point,
    /// Its edges.
    pub width: Point,
    /// The boxes that cover it.
    pub leaves: Vec<Leaf>,
    /// The nodes in preorder: a letter for each rule, then `X`, `Y`, `Z` for a split or `.`.
    pub code: String,
    /// The position of the obligation by whose rules boxes are filled.
    pub filled_by: usize,
}

/// The part of the way from 0 to 1 at which an edge begins and ends.
pub fn parts(edge: Edge) -> [f64; 2] {
    let size = (-f64::from(edge.level)).exp2();
    [edge.index as f64 * size, (edge.index as f64 + 1.0) * size]
}

/// How many steps discharge each obligation by a rule of its own. An obligation without one is none
/// of the claim's.
fn uses(nodes: &[Node]) -> [usize; Obligation::ALL.len()] {
    let mut uses = [0; Obligation::ALL.len()];
    for discharged in nodes.iter().flat_map(|node| &node.by).filter_map(|step| step.rule().1) {
        uses[discharged as usize] += 1;
    }
    uses
}

fn position(step: &Step) -> u8 {
    let (name, _) = step.rule();
    RULES.iter().position(|rule| rule.name == name).unwrap_or(0) as u8
}

impl Subdivision {
    /// The subdivision of a tree that the checker has accepted.
    pub fn new(
        name: &str,
        axes: [&'static str; 3],
        least: Point,
        width: Point,
        nodes: &[Node],
    ) -> Self {
        let (mut leaves, mut code) = (Vec::new(), String::with_capacity(2 * nodes.len()));
        let uses = uses(nodes);
        let mut waiting = vec![(Cell::ROOT, [None; Obligation::ALL.len()], 0)];
        for node in nodes {
            let Some((cell, mut by, depth)) = waiting.pop() else {
                break;
            };
            let own: Vec<u8> = node.by.iter().map(position).collect();
            for (step, &rule) in node.by.iter().zip(&own) {
                code.push(char::from(b'a' + rule));
                let discharged = step.rule().1;
                for ((known, obligation), uses) in by.iter_mut().zip(Obligation::ALL).zip(uses) {
                    let concerned = discharged.map_or(uses > 0, |d| d == obligation);
                    if known.is_none() && concerned {
                        *known = Some(rule);
                    }
                }
            }
            let halves = node.split.and_then(|axis| Some((axis, cell.halves(axis)?)));
            match halves {
                Some((axis, (lower, upper))) => {
                    code.push(['X', 'Y', 'Z'][axis.index()]);
                    waiting.push((upper, by, depth + 1));
                    waiting.push((lower, by, depth + 1));
                }
                None => {
                    code.push('.');
                    leaves.push(Leaf { cell, depth, by, own });
                }
            }
        }
        let most = uses.iter().max().copied().unwrap_or(0);
        let filled_by = uses.iter().position(|uses| *uses == most).unwrap_or(0);
        Subdivision { name: name.to_owned(), axes, least, width, leaves, code, filled_by }
    }

    /// The position of the rule by which a leaf is filled.
    fn fill(&self, leaf: &Leaf) -> usize {
        usize::from(leaf.by[self.filled_by].unwrap_or(0))
    }

    /// The names of a tree's axes.
    pub fn axes_of(all: [Axis; 3]) -> [&'static str; 3] {
        all.map(|axis| match axis {
            Axis::X => "x",
            Axis::Y => "y",
            Axis::Z => "z",
            Axis::Kappa => "kappa",
        })
    }

    /// The relative lengths of the edges, as they are drawn.
    pub fn proportions(&self) -> Point {
        let most = self.width.iter().copied().fold(0.0, f64::max);
        self.width.map(|w| if self.axes[0] == "kappa" { 1.0 } else { (w / most).max(0.15) })
    }

    /// The box seen from the first and from the seventh octant, its faces divided as the leaves
    /// divide them and filled by the rules for one obligation.
    pub fn picture(&self, number: usize, marks: &[Mark]) -> Picture {
        let name = if number == 0 {
            "subdivision".to_owned()
        } else {
            format!("subdivision-{}", number + 1)
        };
        let mut out = Elements::default();
        out.raw(&self.definitions(&name));
        for (i, azimuth, elevation, caption) in [
            (0, 32.0, 24.0, "from the greatest corner"),
            (1, 212.0, -24.0, "from the least corner"),
        ] {
            self.side(&mut out, &name, View::from(azimuth, elevation), 355.0 * f64::from(i), marks);
            let at = [177.0 + 355.0 * f64::from(i), 318.0];
            out.text("tick middle", at, caption);
        }
        Picture {
            name,
            title: format!("The boxes of the proof over {}, seen from two sides", self.name),
            size: [710.0, 330.0],
            attributes: String::new(),
            content: out.0,
        }
    }

    fn definitions(&self, name: &str) -> String {
        let mut used = [false; RULES.len()];
        for leaf in &self.leaves {
            used[self.fill(leaf)] = true;
        }
        let mut out = "<defs>".to_owned();
        for (k, rule) in RULES.iter().enumerate().filter(|(k, _)| used[*k]) {
            let RuleStyle { colour, pattern, .. } = rule;
            let d = PATTERNS[*pattern];
            let _ = write!(
                out,
                "<pattern id=\"{name}-rule-{k}\" width=\"8\" height=\"8\" \
                 patternUnits=\"userSpaceOnUse\"><rect width=\"8\" height=\"8\" fill=\"{colour}\"/>\
                 <path class=\"pattern\" d=\"{d}\"/></pattern>"
            );
        }
        out + "</defs>"
    }

    fn side(&self, out: &mut Elements, name: &str, view: View, left: f64, marks: &[Mark]) {
        let proportions = self.proportions();
        let place = |u: Point| -> Point { from_fn(|k| u[k] * proportions[k]) };
        let corners: Vec<Point> =
            (0..8u8).map(|a| place(from_fn(|k| f64::from(a >> k & 1)))).collect();
        let fitted = Fitted::new(view, &corners, [left + 32.0, 14.0], [290.0, 276.0]);
        let at = |u: Point| fitted.at(place(u));
        for axis in (0..3).filter(|_| !self.leaves.is_empty()) {
            self.face(out, name, axis, if view.toward[axis] > 0.0 { 1.0 } else { 0.0 }, &at);
        }
        self.outline(out, &view, &at);
        for mark in marks {
            let u: Point = from_fn(|k| {
                if self.width[k] > 0.0 {
                    (mark.at[k] - self.least[k]) / self.width[k]
                } else {
                    0.5
                }
            });
            // A mark behind the faces is not seen.
            let seen = |k: usize| {
                let end = if view.toward[k] > 0.0 { 1.0 } else { 0.0 };
                f64::abs(u[k] - end) < 1e-9
            };
            if !self.leaves.is_empty() && !(0..3).any(seen) {
                continue;
            }
            let p = at(u);
            out.dot("mark", p, 4.0);
            out.text("mark-label start", [p[0] + 7.0, p[1] - 6.0], &mark.name);
        }
    }

    /// One face of the root, `u_axis = end`.
    fn face(
        &self,
        out: &mut Elements,
        name: &str,
        axis: usize,
        end: f64,
        at: &dyn Fn(Point) -> [f64; 2],
    ) {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let quad = |low: [f64; 2], high: [f64; 2]| {
            let corner = |x: f64, y: f64| {
                let mut u = [0.0; 3];
                (u[axis], u[b], u[c]) = (end, x, y);
                at(u)
            };
            [
                corner(low[0], low[1]),
                corner(high[0], low[1]),
                corner(high[0], high[1]),
                corner(low[0], high[1]),
            ]
        };
        let mut by_rule: [Vec<([f64; 2], [f64; 2])>; RULES.len()] = Default::default();
        let mut count = 0;
        for leaf in &self.leaves {
            let [of_axis, of_b, of_c] = [axis, b, c].map(|k| parts(leaf.cell.edges[k]));
            if of_axis.contains(&end) {
                let rule = self.fill(leaf);
                by_rule[rule].push(([of_b[0], of_c[0]], [of_b[1], of_c[1]]));
                count += 1;
            }
        }
        let thin = |[o, p, _, q]: [[f64; 2]; 4]| {
            let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
            side(o, p).min(side(o, q)) < OUTLINED
        };
        for (rule, all) in by_rule.iter().enumerate().filter(|(_, all)| !all.is_empty()) {
            let drawn = if count > MOST { on_grid(all) } else { all.clone() };
            let quads = drawn.iter().map(|(low, high)| quad(*low, *high));
            let (fine, outlined): (Vec<_>, Vec<_>) = quads.partition(|q| count > MOST || thin(*q));
            for (class, quads) in [("leaf fine", fine), ("leaf", outlined)] {
                let d: String = quads.iter().map(|q| super::svg::path_data(q, true)).collect();
                if !d.is_empty() {
                    let fill = format!("url(#{name}-rule-{rule})");
                    out.raw(&format!("<path class=\"{class}\" fill=\"{fill}\" d=\"{d}\"/>"));
                }
            }
        }
        let class = ["shade-0", "shade-1", "shade-2"][axis];
        out.path(class, &quad([0.0; 2], [1.0; 2]), true);
    }

    /// The root's edges and the names of its axes.
    fn outline(&self, out: &mut Elements, view: &View, at: &dyn Fn(Point) -> [f64; 2]) {
        let far = view.toward.map(|d| if d > 0.0 { 0.0 } else { 1.0 });
        for a in 0..8u8 {
            for k in (0..3).filter(|k| a >> k & 1 == 0) {
                let from: Point = from_fn(|j| f64::from(a >> j & 1));
                let mut to = from;
                to[k] = 1.0;
                let hidden = (0..3).all(|j| j == k || from[j] == far[j]);
                if !hidden {
                    out.line("edge", at(from), at(to));
                } else if self.leaves.is_empty() {
                    out.line("hidden", at(from), at(to));
                }
            }
        }
        // The name of an axis stands beside the silhouette edge along it.
        let centre = at([0.5; 3]);
        for (k, name) in self.axes.into_iter().enumerate() {
            let mut middle = [0.0; 3];
            let (b, c) = ((k + 1) % 3, (k + 2) % 3);
            let candidates = [[far[b], 1.0 - far[c]], [1.0 - far[b], far[c]]];
            let place = |[x, y]: [f64; 2]| {
                let mut u = [0.5; 3];
                (u[b], u[c]) = (x, y);
                at(u)
            };
            let lowest = candidates.map(place).into_iter().max_by(|p, q| p[1].total_cmp(&q[1]));
            if let Some([x, y]) = lowest {
                middle[0] = x + 16.0
                    * (x - centre[0]).signum()
                    * f64::from(u8::from((x - centre[0]).abs() > 20.0));
                middle[1] = y + 14.0;
                out.text("axis middle", [middle[0], middle[1]], name);
            }
        }
    }
}

/// The squares of a grid whose middle is in one of the rectangles, in rows.
fn on_grid(all: &[([f64; 2], [f64; 2])]) -> Vec<([f64; 2], [f64; 2])> {
    let mut filled = vec![false; GRID * GRID];
    let n = GRID as f64;
    for (low, high) in all {
        let range = |k: usize| {
            let first = (low[k] * n - 0.5).ceil().max(0.0) as usize;
            first..((high[k] * n - 0.5).ceil().max(0.0) as usize).min(GRID)
        };
        for row in range(1) {
            filled[row * GRID..][range(0)].fill(true);
        }
    }
    let mut out = Vec::new();
    for (row, cells) in filled.chunks(GRID).enumerate() {
        let (below, above) = (row as f64 / n, (row + 1) as f64 / n);
        let mut start = None;
        for column in 0..=GRID {
            let inside = cells.get(column).copied().unwrap_or(false);
            match (start, inside) {
                (None, true) => start = Some(column),
                (Some(first), false) => {
                    out.push(([first as f64 / n, below], [column as f64 / n, above]));
                    start = None;
                }
                _ => {}
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use orthocert_checker::rule::Rotation;

    fn tree() -> Vec<Node> {
        let lower =
            Step::Lower(Rotation { q: [1, 0, 0, 0], sign: orthocert_checker::claim::Sign::Plus });
        vec![
            Node { by: vec![Step::Cube], split: Some(Axis::X) },
            Node { by: vec![lower.clone()], split: None },
            Node { by: vec![], split: Some(Axis::Z) },
            Node { by: vec![lower], split: None },
            Node { by: vec![Step::Outside], split: None },
        ]
    }

    #[test]
    fn leaves_know_what_their_ancestors_have_discharged() {
        let found = Subdivision::new("box", ["x", "y", "z"], [0.0; 3], [1.0; 3], &tree());
        assert_eq!(found.code, "dXa.Za.k.");
        assert_eq!(found.leaves.len(), 3);
        assert_eq!(found.leaves[0].by[..3], [Some(0), Some(3), None]);
        // What is outside is discharged of what the claim asks and was open.
        assert_eq!(found.leaves[2].by[..3], [Some(10), Some(3), None]);
        assert_eq!(found.filled_by, 0);
        assert_eq!(found.leaves[2].depth, 2);
        assert_eq!(parts(found.leaves[2].cell.edges[2]), [0.5, 1.0]);
    }

    #[test]
    fn every_rule_has_a_style() {
        for step in tree().iter().flat_map(|node| &node.by) {
            assert_eq!(RULES[usize::from(position(step))].name, step.rule().0);
        }
        let names: std::collections::BTreeSet<_> = RULES.iter().map(|r| r.name).collect();
        assert_eq!(names.len(), RULES.len());
        assert!(RULES.iter().all(|rule| rule.pattern < PATTERNS.len()));
    }

    #[test]
    fn a_grid_stands_for_too_many_rectangles() {
        let all = [([0.0, 0.0], [0.5, 1.0]), ([0.5, 0.0], [1.0, 0.5])];
        let area: f64 = on_grid(&all).iter().map(|(l, h)| (h[0] - l[0]) * (h[1] - l[1])).sum();
        assert!((area - 0.75).abs() < 1e-12);
    }
}
