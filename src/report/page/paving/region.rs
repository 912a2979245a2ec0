//! The region of a paving in pictures: from its tree, down to some depth.

use super::super::isomap::{beside_axis, Mark};
use super::super::legs::Point;
use super::super::svg::{beside_edges, path_data, Elements, Fitted, Picture, View};
use crate::exact::decimal::significant;
use crate::search::paving::{Node, Tree, INNER, UNDECIDED};
use serde_json::{json, Value};
use std::array::from_fn;
use std::fmt::Write;

/// Side of a slice's panel, and what is between panels.
const PANEL: f64 = 200.0;
const GAP: f64 = 36.0;
/// Slices in a row.
const ROW: usize = 3;
/// Slices.
const SLICES: usize = 6;
/// Least width of a panel, relative to the greatest: axes may have different units.
const NARROWEST: f64 = 0.2;

/// The region: a tree of which lengths are parts of the box's edges, and where that box is.
pub struct Region<'a> {
    /// The tree.
    pub tree: &'a Tree,
    /// The box's least corner.
    pub least: Point,
    /// Its edges.
    pub width: Point,
    /// The names of the axes; empty of one that there is not.
    pub axes: &'a [String; 3],
}

/// The ends of a cell.
type Block = [[f64; 2]; 3];
const ROOT: Block = [[0.0, 1.0]; 3];

fn halves(block: &Block, axis: usize) -> [Block; 2] {
    let [low, high] = block[axis];
    let middle = (low + high) / 2.0; // Exact: dyadic, of few levels.
    [[low, middle], [middle, high]].map(|ends| {
        let mut half = *block;
        half[axis] = ends;
        half
    })
}

/// How many of a tree's leaves are inner or undecided.
pub fn leaves(tree: &Tree) -> usize {
    let (mut count, mut waiting) = (0, vec![tree.root]);
    while let Some(node) = waiting.pop() {
        match tree.split(node) {
            Some((_, lower, upper)) => waiting.extend([lower, upper]),
            None => count += usize::from(node == INNER || node == UNDECIDED),
        }
    }
    count
}

impl Region<'_> {
    /// The relative lengths of the box's edges.
    fn shape(&self) -> Point {
        let most = self.width.iter().copied().fold(0.0, f64::max);
        self.width.map(|w| (w / most).max(0.05))
    }

    /// What the script works on: the nodes in preorder, `X`, `Y` and `Z` for a split, `#` for an inner
    /// leaf, `?` for an undecided one, `.` for an outer one.
    pub fn data(&self, marks: &[Mark]) -> Value {
        let (mut code, mut waiting) = (String::new(), vec![self.tree.root]);
        while let Some(node) = waiting.pop() {
            code.push(match self.tree.split(node) {
                Some((axis, lower, upper)) => {
                    waiting.extend([upper, lower]);
                    ['X', 'Y', 'Z'][axis.index()]
                }
                None if node == INNER => '#',
                None if node == UNDECIDED => '?',
                None => '.',
            });
        }
        json!({
            "code": code,
            "least": self.least,
            "width": self.width,
            "shape": self.shape(),
            "axes": self.axes,
            "marks": marks,
        })
    }

    /// The inner boxes from two sides.
    pub fn picture(&self) -> Picture {
        let mut out = Elements::default();
        for (i, azimuth, elevation, caption) in [
            (0.0, 32.0, 24.0, "from the greatest corner"),
            (1.0, 212.0, -24.0, "from the least corner"),
        ] {
            self.side(&mut out, View::from(azimuth, elevation), 355.0 * i);
            out.text("tick middle", [177.0 + 355.0 * i, 318.0], caption);
        }
        Picture {
            name: "region".to_owned(),
            title: "The inner boxes of the paving, seen from two sides".to_owned(),
            size: [710.0, 330.0],
            attributes: String::new(),
            content: out.0,
        }
    }

    /// Where a part of an axis is.
    fn number(&self, k: usize, part: f64) -> String {
        significant(self.least[k] + part * self.width[k], 4)
    }

    fn side(&self, out: &mut Elements, view: View, left: f64) {
        let shape = self.shape();
        let place = |u: Point| -> Point { from_fn(|k| u[k] * shape[k]) };
        let corners: Vec<Point> =
            (0..8u8).map(|a| place(from_fn(|k| f64::from(a >> k & 1)))).collect();
        let fitted = Fitted::new(view, &corners, [left + 32.0, 14.0], [290.0, 276.0]);
        let at = |u: Point| fitted.at(place(u));
        let far = view.toward.map(|d| if d > 0.0 { 0.0 } else { 1.0 });
        for k in 0..3 {
            let (mut from, mut to) = (far, far);
            (from[k], to[k]) = (0.0, 1.0);
            out.line("hidden", at(from), at(to));
        }
        self.behind_first(self.tree.root, ROOT, &view, &mut |block| {
            self.faces(out, &view, block, &at)
        });
        for a in 0..8u8 {
            for k in (0..3).filter(|k| a >> k & 1 == 0) {
                let from: Point = from_fn(|j| f64::from(a >> j & 1));
                let mut to = from;
                to[k] = 1.0;
                if !(0..3).all(|j| j == k || from[j] == far[j]) {
                    out.line("frame", at(from), at(to));
                }
            }
        }
        beside_edges(out, self.axes, (far, 0.0), &at, &|k, end| self.number(k, end));
    }

    /// Calls with every inner leaf, those behind first: of two halves none hides a part of the one
    /// on the viewer's side.
    fn behind_first(&self, node: Node, block: Block, view: &View, call: &mut dyn FnMut(&Block)) {
        let mut waiting = vec![(node, block)];
        while let Some((node, block)) = waiting.pop() {
            match self.tree.split(node) {
                Some((axis, lower, upper)) => {
                    let [below, above] = halves(&block, axis.index());
                    let (lower, upper) = ((lower, below), (upper, above));
                    // The last is taken first.
                    let forward = view.toward[axis.index()] > 0.0;
                    waiting.extend(if forward { [upper, lower] } else { [lower, upper] });
                }
                None if node == INNER => call(&block),
                None => {}
            }
        }
    }

    fn faces(
        &self,
        out: &mut Elements,
        view: &View,
        block: &Block,
        at: &dyn Fn(Point) -> [f64; 2],
    ) {
        for axis in 0..3 {
            let upward = view.toward[axis] > 0.0;
            let end = block[axis][usize::from(upward)];
            if self.is_covered(block, axis, upward) {
                continue;
            }
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| {
                let mut u = [end; 3];
                (u[b], u[c]) = (block[b][i], block[c][j]);
                at(u)
            });
            let of_box = if end == 0.0 || end == 1.0 { "side" } else { "wall" };
            let d = path_data(&corners, true);
            out.raw(&format!("<path class=\"{of_box}-{axis}\" d=\"{d}\"/>"));
        }
    }

    /// Whether all that is next to a side of a cell is inner.
    fn is_covered(&self, block: &Block, axis: usize, upward: bool) -> bool {
        let end = block[axis][usize::from(upward)];
        if end == 0.0 || end == 1.0 {
            return false;
        }
        let mut waiting = vec![(self.tree.root, ROOT)];
        while let Some((node, cell)) = waiting.pop() {
            let Some((along, lower, upper)) = self.tree.split(node) else {
                if node != INNER {
                    return false;
                }
                continue;
            };
            let k = along.index();
            let [below, above] = halves(&cell, k);
            let middle = below[k][1];
            let (into_lower, into_upper) = if k == axis {
                let up = middle < end || middle == end && upward;
                (!up, up)
            } else {
                (block[k][0] < middle, middle < block[k][1])
            };
            waiting.extend(into_lower.then_some((lower, below)));
            waiting.extend(into_upper.then_some((upper, above)));
        }
        true
    }

    /// Slices at constant values of the last coordinate, through the inner part; one where there is none.
    pub fn slices(&self, marks: &[Mark]) -> Picture {
        let [low, high] = self.inner_extent();
        let most = self.width[0].max(self.width[1]);
        let [w, h] = [0, 1].map(|k| self.width[k].max(NARROWEST * most));
        let (slices, side) =
            if self.axes[2].is_empty() { (1, 2.0 * PANEL) } else { (SLICES, PANEL) };
        let scale = side / w.max(h);
        let (panel, rows) = ([w * scale, h * scale], slices.div_ceil(ROW));
        let mut out = Elements::default();
        for i in 0..slices {
            let u = low + (high - low) * (i as f64 + 0.5) / slices as f64;
            let corner = [
                GAP + (i % ROW) as f64 * (PANEL + GAP),
                GAP + (i / ROW) as f64 * (panel[1] + 1.6 * GAP),
            ];
            self.slice(&mut out, u, corner, panel);
            let z = self.number(2, u);
            if slices > 1 {
                let title = format!("{} = {z}", self.axes[2]);
                out.text("map-title start", [corner[0], corner[1] - 8.0], &title);
            }
            for mark in marks.iter().filter(|_| self.width[2] > 0.0) {
                let at: Point = from_fn(|k| (mark.at[k] - self.least[k]) / self.width[k]);
                if (at[2] - u).abs() <= (high - low) / slices as f64 / 2.0 {
                    let p = [corner[0] + at[0] * panel[0], corner[1] + (1.0 - at[1]) * panel[1]];
                    out.dot("mark", p, 3.5);
                }
            }
        }
        let height = GAP + rows as f64 * (panel[1] + 1.6 * GAP);
        Picture {
            name: "slices".to_owned(),
            title: "Slices of the paving: inner, undecided and outer boxes".to_owned(),
            size: [GAP + slices.min(ROW) as f64 * (side + GAP), height],
            attributes: String::new(),
            content: out.0,
        }
    }

    fn slice(&self, out: &mut Elements, u: f64, corner: [f64; 2], size: [f64; 2]) {
        let (mut inner, mut undecided) = (String::new(), String::new());
        let mut waiting = vec![(self.tree.root, ROOT)];
        while let Some((node, block)) = waiting.pop() {
            if let Some((axis, lower, upper)) = self.tree.split(node) {
                let [below, above] = halves(&block, axis.index());
                let at_z = axis.index() == 2;
                waiting.extend((!at_z || u >= above[2][0]).then_some((upper, above)));
                waiting.extend((!at_z || u < above[2][0]).then_some((lower, below)));
                continue;
            }
            let path = match node {
                INNER => &mut inner,
                UNDECIDED => &mut undecided,
                _ => continue,
            };
            let [[x, to], [y, up], _] = block;
            let _ = write!(
                path,
                "M{:.2} {:.2}h{:.2}v{:.2}h{:.2}z",
                corner[0] + x * size[0],
                corner[1] + (1.0 - up) * size[1],
                (to - x) * size[0],
                (up - y) * size[1],
                (x - to) * size[0]
            );
        }
        let [x, y] = corner;
        let [w, h] = size;
        for (class, d) in [("slice-undecided", undecided), ("slice-inner", inner)] {
            out.raw(&format!("<path class=\"{class}\" d=\"{d}\"/>"));
        }
        out.raw(&format!(
            "<rect class=\"slice-frame\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\"/>"
        ));
        out.text("axis middle", [x + w / 2.0, y + h + 13.0], &self.axes[0]);
        beside_axis(out, [x, y + h / 2.0], &self.axes[1]);
        out.text("tick start", [x, y + h + 13.0], &self.number(0, 0.0));
        out.text("tick end", [x + w, y + h + 13.0], &self.number(0, 1.0));
        if !self.axes[1].is_empty() {
            out.text("tick end", [x - 4.0, y + h], &self.number(1, 0.0));
            out.text("tick end", [x - 4.0, y + 9.0], &self.number(1, 1.0));
        }
    }

    /// The least and the greatest z of inner cells, as parts of the box; of the box, without any.
    fn inner_extent(&self) -> [f64; 2] {
        let mut extent = [1.0, 0.0];
        let mut waiting = vec![(self.tree.root, ROOT)];
        while let Some((node, block)) = waiting.pop() {
            if let Some((axis, lower, upper)) = self.tree.split(node) {
                let [below, above] = halves(&block, axis.index());
                waiting.extend([(lower, below), (upper, above)]);
            } else if node == INNER {
                extent = [f64::min(extent[0], block[2][0]), f64::max(extent[1], block[2][1])];
            }
        }
        if extent[0] < extent[1] {
            extent
        } else {
            [0.0, 1.0]
        }
    }
}
