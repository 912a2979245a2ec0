//! Drawing: views of space, and the parts of SVG that the figures are made of.
//!
//! Figures are styled by classes (`figure.css`), so that a page can show them light or dark and a
//! file of its own can carry its style.

use super::legs::{dot, Point};
use crate::report::escape::xml;
use std::fmt::Write;

/// The style of all figures.
const STYLE: &str = include_str!("figure.css");
/// The colours by name, as on a light page; `page.css` has them too, and the dark ones.
const LIGHT: [(&str, &str); 8] = [
    ("--ink", "#1b2330"),
    ("--soft", "#5b6675"),
    ("--line", "#c4ccd6"),
    ("--paper", "#ffffff"),
    ("--accent", "#0b5cad"),
    ("--tint", "#dbe8f6"),
    ("--strong", "#b0390e"),
    ("--hatch", "#8b95a3"),
];

/// A parallel view.
#[derive(Clone, Copy, Debug)]
pub struct View {
    right: Point,
    up: Point,
    /// From the scene to the viewer.
    pub toward: Point,
}

impl View {
    /// The view from an azimuth (about z, from x) and an elevation, in degrees.
    pub fn from(azimuth: f64, elevation: f64) -> Self {
        let ((sa, ca), (se, ce)) =
            (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
        View { right: [-sa, ca, 0.0], up: [-ca * se, -sa * se, ce], toward: [ca * ce, sa * ce, se] }
    }

    /// Where a point is seen: to the right and down.
    pub fn seen(&self, p: Point) -> [f64; 2] {
        [dot(self.right, p), -dot(self.up, p)]
    }
}

/// A view scaled and moved into a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    view: View,
    scale: f64,
    shift: [f64; 2],
}

impl Fitted {
    /// The view in which all `points` are within a `width` by `height` rectangle at `corner`.
    pub fn new(view: View, points: &[Point], corner: [f64; 2], size: [f64; 2]) -> Self {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for p in points {
            let seen = view.seen(*p);
            for k in 0..2 {
                low[k] = low[k].min(seen[k]);
                high[k] = high[k].max(seen[k]);
            }
        }
        let room = |k: usize| size[k] / (high[k] - low[k]).max(f64::MIN_POSITIVE);
        let scale = room(0).min(room(1));
        let shift = [0, 1].map(|k| corner[k] + size[k] / 2.0 - scale * (low[k] + high[k]) / 2.0);
        Fitted { view, scale, shift }
    }

    /// Where a point is drawn.
    pub fn at(&self, p: Point) -> [f64; 2] {
        let seen = self.view.seen(p);
        [0, 1].map(|k| self.scale * seen[k] + self.shift[k])
    }
}

/// A picture: the content of an `svg` element.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of the file and of the element's class.
    pub name: String,
    /// What it shows, for those who do not see it.
    pub title: String,
    /// Width and height in its own units.
    pub size: [f64; 2],
    /// Attributes that scripts go by.
    pub attributes: String,
    /// The elements.
    pub content: String,
}

impl Picture {
    /// The element within a page.
    pub fn inline(&self) -> String {
        format!("<svg {}>{}</svg>\n", self.opening(), self.body())
    }

    /// A file of its own.
    pub fn file(&self) -> String {
        let opening = self.opening();
        let style = LIGHT.iter().fold(STYLE.to_owned(), |style, (name, colour)| {
            style.replace(&format!("var({name})"), colour)
        });
        let [width, height] = self.size;
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
             width=\"{width}\" height=\"{height}\" {opening}><style>\n{style}</style>\n\
             <rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>{}</svg>\n",
            self.body()
        )
    }

    fn opening(&self) -> String {
        let [width, height] = self.size;
        let Picture { name, attributes, .. } = self;
        format!(
            "class=\"figure {name}\" viewBox=\"0 0 {width} {height}\" role=\"img\" {attributes}"
        )
    }

    fn body(&self) -> String {
        format!("<title>{}</title>{}", xml(&self.title), self.content)
    }
}

/// A list of elements.
#[derive(Clone, Debug, Default)]
pub struct Elements(pub String);

impl Elements {
    /// An element as it is written.
    pub fn raw(&mut self, element: &str) {
        self.0.push_str(element);
    }

    /// A straight line.
    pub fn line(&mut self, class: &str, a: [f64; 2], b: [f64; 2]) {
        let ([x1, y1], [x2, y2]) = (a, b);
        let _ = write!(
            self.0,
            "<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>"
        );
    }

    /// Straight pieces through points; closed if `closed`.
    pub fn path(&mut self, class: &str, points: &[[f64; 2]], closed: bool) {
        let d = path_data(points, closed);
        let _ = write!(self.0, "<path class=\"{class}\" d=\"{d}\"/>");
    }

    /// A dot.
    pub fn dot(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        let _ = write!(
            self.0,
            "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"/>"
        );
    }

    /// Text at a point; `class` tells its anchor.
    pub fn text(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        let text = xml(text);
        let _ = write!(self.0, "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{text}</text>");
    }
}

impl Elements {
    /// A text from below upward, its middle at a point.
    pub fn upright(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        let text = xml(text);
        let turn = format!("translate({x:.1} {y:.1}) rotate(-90)");
        let _ = write!(self.0, "<text class=\"{class}\" transform=\"{turn}\">{text}</text>");
    }
}

/// The names of the axes of the unit cube, and the numbers at their ends: beside the silhouette's lower edge along each, or
/// below it where that is nearer than `clear` to the centre. An axis without a name has no numbers.
pub fn beside_edges(
    out: &mut Elements,
    names: &[String],
    (far, clear): (Point, f64),
    at: &dyn Fn(Point) -> [f64; 2],
    number: &dyn Fn(usize, f64) -> String,
) {
    for (k, name) in names.iter().enumerate() {
        let (b, c) = ((k + 1) % 3, (k + 2) % 3);
        let place = |[x, y]: [f64; 2], part: f64| {
            let mut u = [part; 3];
            (u[b], u[c]) = (x, y);
            at(u)
        };
        let edges = [[far[b], 1.0 - far[c]], [1.0 - far[b], far[c]]];
        let [one, other] = edges.map(|edge| place(edge, 0.5)[1]);
        let edge = edges[usize::from(one <= other)];
        let off = place(edge, 0.5)[0] - at([0.5; 3])[0];
        let aside = if off.abs() >= clear { 16.0 * off.signum() } else { 0.0 };
        let mut beside = |class, part, text: &str| {
            let [x, y] = place(edge, part);
            out.text(class, [x + aside, y + 14.0], text);
        };
        beside("axis middle", 0.5, name);
        // A little inward, where those of two axes do not meet.
        for (end, part) in [(0.0, 0.09), (1.0, 0.91)].into_iter().filter(|_| !name.is_empty()) {
            beside("tick middle", part, &number(k, end));
        }
    }
}

/// The `d` of a path through points, to a tenth; those on a line between their neighbours are left out, and each but
/// the first is told from the one before.
pub fn path_data(points: &[[f64; 2]], closed: bool) -> String {
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    for next in points.iter().map(|point| point.map(|x| (10.0 * x).round())) {
        while let [.., last, own] = kept[..] {
            if !is_between(last, own, next) {
                break;
            }
            kept.pop();
        }
        kept.push(next);
    }
    let mut d = String::with_capacity(kept.len() * 8);
    let mut before = [0.0; 2];
    for (i, point) in kept.into_iter().enumerate() {
        // Differences of integers are exact.
        let [x, y] = [0, 1].map(|k| tenths(point[k] - before[k]));
        let between = if y.starts_with('-') { "" } else { " " };
        d += &match (i, &*x, &*y) {
            (0, ..) => format!("M{x}{between}{y}"),
            (_, x, "0") => format!("h{x}"),
            (_, "0", y) => format!("v{y}"),
            _ => format!("l{x}{between}{y}"),
        };
        before = point;
    }
    if closed {
        d.push('Z');
    }
    d
}

/// So many tenths, as short as can be.
fn tenths(n: f64) -> String {
    let text = format!("{}", n / 10.0);
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(size) => format!("-{}", size.strip_prefix('0').unwrap_or(size)),
        None => text.strip_prefix('0').filter(|rest| !rest.is_empty()).unwrap_or(&text).to_owned(),
    }
}

/// Whether a way goes straight on at `b`, or has not left `a`.
fn is_between(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    u[0] * v[1] == u[1] * v[0] && u[0] * v[0] + u[1] * v[1] >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_have_their_corners_alone() {
        let square =
            [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        assert_eq!(path_data(&square, true), "M0 0h1v2h-1Z");
        // A way that turns back, and one that bends by less than is drawn.
        assert_eq!(path_data(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], false), "M0 0h2h-1");
        assert_eq!(path_data(&[[0.0, 0.0], [1.0, 0.1], [2.0, 0.0]], false), "M0 0l1 .1l1-.1");
    }

    #[test]
    fn every_colour_of_the_figures_is_known_on_their_own_and_on_the_page() {
        let page = include_str!("page.css");
        let mut rest = STYLE;
        while let Some((_, after)) = rest.split_once("var(") {
            let (name, after) = after.split_once(')').unwrap();
            assert!(LIGHT.iter().any(|(known, _)| *known == name), "{name}");
            rest = after;
        }
        for (name, colour) in LIGHT {
            assert!(page.contains(&format!("{name}: {colour};")), "{name}");
            assert_eq!(page.matches(&format!("{name}: ")).count(), 3, "{name}: light, dark, dark");
        }
    }

    #[test]
    fn x_is_seen_to_the_left_and_z_up_from_the_first_octant() {
        let view = View::from(45.0, 30.0);
        let [[x, _], [y, _], [_, z]] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|p| view.seen(p));
        assert!(x < 0.0 && y > 0.0 && z < 0.0);
        assert!((dot(view.toward, view.toward) - 1.0).abs() < 1e-12);
    }
}
