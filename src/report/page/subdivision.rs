//! The subdivision that a proof consists of: its boxes, by the rules that close them.

use super::isomap::{beside_axis, Mark};
use super::legend::{Legend, Rule, Ruled, PATTERNS};
use super::legs::Point;
use super::svg::{beside_edges, path_data, Elements, Fitted, Picture, View};
use crate::exact::decimal::significant;
use std::array::from_fn;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::rc::Rc;

/// Rectangles of a face that are drawn one by one; beyond, the face is drawn on a grid.
const MOST: usize = 2500;
/// Least breadth of a rectangle that is outlined.
const OUTLINED: f64 = 1.6;
/// Squares of that grid on either side.
const GRID: usize = 80;

/// The least and the greatest corner.
type Rectangle = ([f64; 2], [f64; 2]);

/// A box that is not split.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// For each coordinate, the part of the way from 0 to 1 at which the box begins and ends.
    pub parts: Vec<[f64; 2]>,
    /// How often it was halved.
    pub depth: usize,
    /// For each obligation, the position of the rule that discharged it on the path.
    pub by: Vec<Option<u8>>,
    /// The positions of the rules used on the leaf itself.
    pub own: Vec<u8>,
}

/// A tree to be shown.
#[derive(Clone, Debug)]
pub struct Subdivision {
    /// What it covers.
    pub name: String,
    /// Names of the coordinates.
    pub axes: Vec<String>,
    /// How many of them, the first, are of the position; others turn the platform.
    pub positions: usize,
    /// Whether the others are tangents of half angles, which are told in degrees.
    pub turns: bool,
    /// The root's least corner, in the units of the axes.
    pub least: Vec<f64>,
    /// Its edges.
    pub width: Vec<f64>,
    /// The boxes that cover it.
    pub leaves: Vec<Leaf>,
    /// The nodes in preorder: a letter for each rule, then `X`, `Y`, `Z` for a split, `T` for one of a tolerance, or `.`;
    /// of three coordinates.
    pub code: String,
    /// The position of the obligation by whose rules boxes are filled.
    pub filled_by: usize,
    /// How often each rule is used.
    pub uses: Vec<usize>,
    /// The rules.
    pub legend: Rc<Legend>,
}

/// The root of a tree.
#[derive(Clone, Debug)]
pub struct Root {
    /// Names of the coordinates.
    pub axes: Vec<String>,
    /// How many of them are of the position.
    pub positions: usize,
    /// Whether the others are tangents of half angles.
    pub turns: bool,
    /// Its least corner.
    pub least: Vec<f64>,
    /// Its edges.
    pub width: Vec<f64>,
}

impl Root {
    /// A root of three coordinates.
    pub fn new(axes: [&str; 3], least: Point, width: Point) -> Self {
        let axes = axes.map(str::to_owned).to_vec();
        Root { axes, positions: 3, turns: false, least: least.to_vec(), width: width.to_vec() }
    }
}

/// Pairs of coordinates in which all of them are seen: each against the first of its kind, and one
/// that is alone of its kind against the first of all.
pub fn pairs(coordinates: usize, positions: usize) -> Vec<[usize; 2]> {
    let of_kind = |first: usize, end: usize| match end.saturating_sub(first) {
        1 if first > 0 => vec![[0, first]],
        _ => (first + 1..end).map(|k| [first, k]).collect(),
    };
    [of_kind(0, positions), of_kind(positions, coordinates)].concat()
}

impl Subdivision {
    /// The subdivision of a tree that the checker has accepted.
    pub fn new(name: &str, root: Root, legend: &Rc<Legend>, nodes: &[Ruled]) -> Self {
        let mut uses = vec![0; legend.rules.len()];
        nodes.iter().flat_map(|node| &node.0).for_each(|rule| uses[usize::from(*rule)] += 1);
        // An obligation without a rule of its own is none of the claim's.
        let mut concerned = vec![0; legend.obligations.len()];
        for (rule, uses) in legend.rules.iter().zip(&uses) {
            if let Some(discharged) = rule.discharges {
                concerned[discharged] += uses;
            }
        }
        let (mut leaves, mut code) = (Vec::new(), String::with_capacity(2 * nodes.len()));
        let whole = vec![[0.0, 1.0]; root.axes.len()];
        let mut waiting = vec![(whole, vec![None; legend.obligations.len()], 0)];
        for (own, split) in nodes {
            let Some((parts, mut by, depth)) = waiting.pop() else {
                break;
            };
            for &rule in own {
                code.extend(char::from_u32(u32::from(b'a') + u32::from(rule)));
                let discharged = legend.rules[usize::from(rule)].discharges;
                for (o, known) in by.iter_mut().enumerate() {
                    let is_meant = discharged.map_or(concerned[o] > 0, |d| d == o);
                    if known.is_none() && is_meant {
                        *known = Some(rule);
                    }
                }
            }
            match *split {
                // The range of a tolerance: the halves are about the same box.
                Some(k) if k >= parts.len() => {
                    code.push('T');
                    waiting.push((parts.clone(), by.clone(), depth + 1));
                    waiting.push((parts, by, depth + 1));
                }
                Some(k) => {
                    code.push(*['X', 'Y', 'Z'].get(k).unwrap_or(&'?'));
                    let [low, high] = parts[k];
                    let middle = (low + high) / 2.0;
                    let with = |ends: [f64; 2]| {
                        let mut half = parts.clone();
                        half[k] = ends;
                        half
                    };
                    waiting.push((with([middle, high]), by.clone(), depth + 1));
                    waiting.push((with([low, middle]), by, depth + 1));
                }
                None => {
                    code.push('.');
                    leaves.push(Leaf { parts, depth, by, own: own.clone() });
                }
            }
        }
        let most = concerned.iter().max().copied().unwrap_or(0);
        let filled_by = concerned.iter().position(|uses| *uses == most).unwrap_or(0);
        let Root { axes, positions, turns, least, width } = root;
        let (name, legend) = (name.to_owned(), Rc::clone(legend));
        Subdivision {
            name,
            axes,
            positions,
            turns,
            least,
            width,
            leaves,
            code,
            filled_by,
            uses,
            legend,
        }
    }

    /// Whether it is a box in space, which a script can turn.
    pub fn is_spatial(&self) -> bool {
        self.axes.len() == 3
    }

    /// Whether it is one over a face of the cube and `kappa`.
    pub fn is_face(&self) -> bool {
        self.axes.last().is_some_and(|name| name == "kappa")
    }

    /// The position of the rule by which a leaf is filled.
    fn fill(&self, leaf: &Leaf) -> usize {
        usize::from(leaf.by.get(self.filled_by).copied().flatten().unwrap_or(0))
    }

    /// Where a part of the way along a coordinate is; of angles, in degrees.
    pub fn place(&self, k: usize, part: f64) -> f64 {
        let x = self.least[k] + part * self.width[k];
        if self.turns && k >= self.positions {
            2.0 * x.atan().to_degrees()
        } else {
            x
        }
    }

    /// The part of the way at which a coordinate is.
    fn part(&self, k: usize, x: f64) -> f64 {
        if self.width[k] > 0.0 {
            (x - self.least[k]) / self.width[k]
        } else {
            0.5
        }
    }

    /// The relative lengths of the edges, as they are drawn.
    pub fn proportions(&self) -> Point {
        let most = self.width.iter().copied().fold(0.0, f64::max);
        let edge = |k: usize| self.width.get(k).map_or(1.0, |w| (w / most).max(0.15));
        from_fn(|k| if self.is_face() { 1.0 } else { edge(k) })
    }

    /// The boxes: of three coordinates in space, of others in planes.
    pub fn picture(&self, number: usize, marks: &[Mark]) -> Picture {
        let name = if number == 0 {
            "subdivision".to_owned()
        } else {
            format!("subdivision-{}", number + 1)
        };
        if self.is_spatial() {
            self.in_space(name, marks)
        } else {
            self.in_planes(name, marks)
        }
    }

    /// The box seen from the first and from the seventh octant, its faces divided as the leaves
    /// divide them and filled by the rules for one obligation.
    fn in_space(&self, name: String, marks: &[Mark]) -> Picture {
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
        let mut used = vec![false; self.legend.rules.len()];
        for leaf in &self.leaves {
            if let Some(used) = used.get_mut(self.fill(leaf)) {
                *used = true;
            }
        }
        let mut out = "<defs>".to_owned();
        for (k, rule) in self.legend.rules.iter().enumerate().filter(|(k, _)| used[*k]) {
            let Rule { colour, pattern, .. } = rule;
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
            let u: Point = from_fn(|k| self.part(k, mark.at[k]));
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
        let mut by_rule: BTreeMap<usize, Vec<Rectangle>> = BTreeMap::new();
        let mut count = 0;
        for leaf in &self.leaves {
            let [of_axis, of_b, of_c] = [axis, b, c].map(|k| leaf.parts[k]);
            if of_axis.contains(&end) {
                let of_rule = by_rule.entry(self.fill(leaf)).or_default();
                of_rule.push(([of_b[0], of_c[0]], [of_b[1], of_c[1]]));
                count += 1;
            }
        }
        let thin = |[o, p, _, q]: [[f64; 2]; 4]| {
            let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
            side(o, p).min(side(o, q)) < OUTLINED
        };
        for (rule, all) in &by_rule {
            let drawn = if count > MOST { on_grid(all) } else { all.clone() };
            let quads = drawn.iter().map(|(low, high)| quad(*low, *high));
            let (fine, outlined): (Vec<_>, Vec<_>) = quads.partition(|q| count > MOST || thin(*q));
            for (class, quads) in [("leaf fine", fine), ("leaf", outlined)] {
                let d: String = quads.iter().map(|q| path_data(q, true)).collect();
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
        let number = |k: usize, end: f64| significant(self.place(k, end), 4);
        beside_edges(out, &self.axes, (far, 20.0), at, &number);
    }

    /// The boxes projected onto pairs of coordinates. In a plane they are filled by the rules for one
    /// obligation; where boxes lie above each other, by depth, the deepest on top.
    fn in_planes(&self, name: String, marks: &[Mark]) -> Picture {
        const PANEL: [f64; 2] = [236.0, 236.0];
        let m = self.axes.len();
        let all = if m == 1 { vec![[0, 0]] } else { pairs(m, self.positions) };
        let mut out = Elements::default();
        out.raw(&self.definitions(&name));
        for (i, pair) in all.iter().enumerate() {
            let corner = [PANEL[0] * (i % 3) as f64, PANEL[1] * (i / 3) as f64];
            self.panel(&mut out, &name, *pair, corner, marks);
        }
        let rows = all.len().div_ceil(3).max(1) as f64;
        Picture {
            name,
            title: format!("The boxes of the proof over {}, by pairs of coordinates", self.name),
            size: [PANEL[0] * 3.0, PANEL[1] * rows],
            attributes: String::new(),
            content: out.0,
        }
    }

    /// One pair of coordinates; the same one twice stands for one coordinate alone.
    fn panel(
        &self,
        out: &mut Elements,
        name: &str,
        [a, b]: [usize; 2],
        [left, top]: [f64; 2],
        marks: &[Mark],
    ) {
        const SIDE: f64 = 176.0;
        let at = |u: f64, v: f64| [left + 50.0 + SIDE * u, top + 14.0 + SIDE * (1.0 - v)];
        let mut rectangles: BTreeMap<[u64; 4], &Leaf> = BTreeMap::new();
        for leaf in &self.leaves {
            let of_b = if a == b { [0.4, 0.6] } else { leaf.parts[b] };
            let key = [leaf.parts[a], of_b].concat();
            let key: [u64; 4] = from_fn(|i| key[i].to_bits());
            let known = rectangles.entry(key).or_insert(leaf);
            if leaf.depth > known.depth {
                *known = leaf;
            }
        }
        let mut drawn: Vec<([u64; 4], &Leaf)> = rectangles.into_iter().collect();
        drawn.sort_by_key(|(_, leaf)| leaf.depth);
        let [least, most] = [drawn.first(), drawn.last()].map(|d| d.map_or(0, |(_, l)| l.depth));
        // The deepest are what is worth seeing, should there be too many.
        for (ends, leaf) in drawn.iter().skip(drawn.len().saturating_sub(MOST)) {
            let [u, v, x, y] = ends.map(f64::from_bits);
            let quad = [at(u, x), at(v, x), at(v, y), at(u, y)];
            let fill = if self.axes.len() <= 2 {
                format!("url(#{name}-rule-{})", self.fill(leaf))
            } else {
                shade(leaf.depth, least, most)
            };
            let d = path_data(&quad, true);
            out.raw(&format!("<path class=\"leaf\" fill=\"{fill}\" d=\"{d}\"/>"));
        }
        out.path("outline", &[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)], true);
        let number = |k: usize, part: f64| significant(self.place(k, part), 4);
        let [[x0, y0], [x1, y1]] = [at(0.0, 0.0), at(1.0, 1.0)];
        out.text("tick start", [x0, y0 + 14.0], &number(a, 0.0));
        out.text("tick end", [x1, y0 + 14.0], &number(a, 1.0));
        out.text("axis middle", [(x0 + x1) / 2.0, y0 + 14.0], &self.axes[a]);
        if a != b {
            out.text("tick end", [x0 - 5.0, y0], &number(b, 0.0));
            out.text("tick end", [x0 - 5.0, y1 + 9.0], &number(b, 1.0));
            beside_axis(out, [x0, (y0 + y1) / 2.0], &self.axes[b]);
        }
        for mark in marks {
            let part = |k: usize| mark.at.get(k).map_or(0.5, |x| self.part(k, *x));
            let p = at(part(a), if a == b { 0.5 } else { part(b) });
            out.dot("mark", p, 3.5);
            let (class, beside) = if part(a) > 0.5 { ("end", -7.0) } else { ("start", 7.0) };
            let above = if p[1] < top + 30.0 { 15.0 } else { -6.0 };
            out.text(&format!("mark-label {class}"), [p[0] + beside, p[1] + above], &mark.name);
        }
    }
}

/// The fill of a depth: the deeper, the darker.
fn shade(depth: usize, least: usize, most: usize) -> String {
    let part = if most > least { (depth - least) as f64 / (most - least) as f64 } else { 0.3 };
    let channel = |light: f64, dark: f64| (light + part * (dark - light)).round() as u8;
    format!(
        "#{:02x}{:02x}{:02x}",
        channel(220.0, 33.0),
        channel(236.0, 102.0),
        channel(247.0, 172.0)
    )
}

/// The squares of a grid whose middle is in one of the rectangles, in rows.
fn on_grid(all: &[Rectangle]) -> Vec<Rectangle> {
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
    use kernel::{Evidence, Node, Step};
    use orthocert_kernel::certificate as kernel;

    fn node(by: Vec<Step>, split: Option<usize>) -> Node {
        Node { by, split, ..Node::default() }
    }

    fn legend(nodes: Vec<Node>, names: &[&str]) -> (Rc<Legend>, Vec<Ruled>) {
        let tree = kernel::Tree { precision: 52, chords: None, nodes };
        let names = names.iter().map(ToString::to_string).collect();
        let (legend, ruled) = Legend::of_kernel(&tree, names, &|obligation| obligation);
        (Rc::new(legend), ruled)
    }

    #[test]
    fn leaves_know_what_their_ancestors_have_discharged() {
        let nodes = vec![
            node(vec![Step(1, Evidence::Test)], Some(0)),
            node(vec![Step(0, Evidence::Divided)], None),
            node(vec![], Some(2)),
            node(vec![Step(0, Evidence::Divided)], None),
            node(vec![Step(0, Evidence::Outside)], None),
        ];
        let (legend, ruled) = legend(nodes, &["det", "psi", "rho"]);
        let root = Root::new(["x", "y", "z"], [0.0; 3], [1.0; 3]);
        let found = Subdivision::new("box", root, &legend, &ruled);
        assert_eq!(found.code, "aXb.Zb.c.");
        assert_eq!(found.leaves.len(), 3);
        assert_eq!(found.leaves[0].by, [Some(1), Some(0), None]);
        // What is outside is discharged of what the claim asks and was open.
        assert_eq!(found.leaves[2].by, [Some(2), Some(0), None]);
        assert_eq!(found.filled_by, 0);
        assert_eq!(found.leaves[2].depth, 2);
        assert_eq!(found.leaves[2].parts[2], [0.5, 1.0]);
        assert_eq!(found.uses, [1, 2, 1]);
        assert!(legend.rules.iter().all(|rule| rule.pattern < PATTERNS.len()));
    }

    #[test]
    fn halves_of_a_tolerance_are_about_the_same_box() {
        let leaf = || node(vec![Step(0, Evidence::Test)], None);
        let nodes = vec![node(vec![], Some(5)), node(vec![], Some(0)), leaf(), leaf(), leaf()];
        let (legend, ruled) = legend(nodes, &["psi"]);
        let root = Root::new(["x", "y", "z"], [0.0; 3], [1.0; 3]);
        let found = Subdivision::new("box", root, &legend, &ruled);
        assert_eq!(found.code, "TXa.a.a.");
        let first: Vec<[f64; 2]> = found.leaves.iter().map(|leaf| leaf.parts[0]).collect();
        assert_eq!(first, [[0.0, 0.5], [0.5, 1.0], [0.0, 1.0]]);
        assert_eq!(found.leaves.iter().map(|leaf| leaf.depth).collect::<Vec<_>>(), [2, 2, 1]);
    }

    #[test]
    fn every_coordinate_is_in_a_pair() {
        assert_eq!(pairs(2, 2), [[0, 1]]);
        assert_eq!(pairs(3, 2), [[0, 1], [0, 2]]);
        assert_eq!(pairs(3, 0), [[0, 1], [0, 2]]);
        assert_eq!(pairs(6, 3), [[0, 1], [0, 2], [3, 4], [3, 5]]);
        assert_eq!(pairs(1, 1), <[[usize; 2]; 0]>::default());
    }

    #[test]
    fn the_rules_of_the_kernel_are_told_apart_by_what_they_are_used_for() {
        let nodes = vec![
            node(vec![Step(1, Evidence::Test), Step(2, Evidence::Test)], Some(3)),
            node(vec![Step(0, Evidence::Divided)], None),
            node(vec![Step(0, Evidence::Outside)], None),
        ];
        let tree = kernel::Tree { precision: 52, chords: None, nodes };
        let names = vec!["psi".to_owned(), "rho".to_owned()];
        let (legend, nodes) = Legend::of_kernel(&tree, names, &|o| usize::from(o > 0));
        let shown: Vec<_> = legend.rules.iter().map(|r| (r.name.as_str(), r.discharges)).collect();
        assert_eq!(shown, [("test", Some(1)), ("divided", Some(0)), ("outside", None)]);
        let axes: Vec<String> = ["x", "y", "z", "c"].map(str::to_owned).to_vec();
        let (least, width) = (vec![0.0; 4], vec![2.0; 4]);
        let root = Root { axes, positions: 3, turns: true, least, width };
        let found = Subdivision::new("box", root, &Rc::new(legend), &nodes);
        assert_eq!(found.uses, [2, 1, 1]);
        assert_eq!(found.leaves[0].parts[3], [0.0, 0.5]);
        // Half the way is 1, the tangent of half a right angle.
        assert_eq!([found.place(0, 0.5), found.place(3, 0.5)], [1.0, 90.0]);
        assert_eq!(found.leaves[1].by, [Some(2), Some(0)]);
        let picture = found.picture(0, &[Mark { name: "worst".to_owned(), at: vec![1.0; 4] }]);
        assert_eq!(picture.content.matches("class=\"outline\"").count(), 3);
        assert!(picture.content.contains("worst") && !picture.content.contains("NaN"));
    }

    #[test]
    fn a_grid_stands_for_too_many_rectangles() {
        let all = [([0.0, 0.0], [0.5, 1.0]), ([0.5, 0.0], [1.0, 0.5])];
        let area: f64 = on_grid(&all).iter().map(|(l, h)| (h[0] - l[0]) * (h[1] - l[1])).sum();
        assert!((area - 0.75).abs() < 1e-12);
    }
}
