//! Maps of functions of two coordinates: lines of equal value over a slice of the workspace.

use super::contour::{Field, LevelSet, Path};
use super::labels::{about, beside, Rectangle, Taken};
use super::legs::Point;
use super::svg::{path_data, Elements, Picture};
use crate::exact::decimal::significant;
use serde::Serialize;
use std::array::from_fn;
use std::fmt::Write;

/// Nodes of the grid on either side.
pub const NODES: usize = 61;
/// Levels aimed at.
const LEVELS: f64 = 12.0;
/// Where the greatest value exceeds the least this many times, levels are spaced by factors.
const WIDE: f64 = 30.0;
/// A map's width and height, and the margins on the left, above, on the right and below.
const SIZE: [f64; 2] = [300.0, 322.0];
const MARGIN: [f64; 4] = [44.0, 30.0, 10.0, 40.0];
/// A side is at most so many times the other, that the names of axes have room.
const NARROWEST: f64 = 2.6;
/// Longest name beside an axis; others run along it.
const SHORT_NAME: usize = 4;
/// Shortest line that carries its level.
const LABELLED: f64 = 34.0;
/// Half of what a letter of a level takes across, half of what a level takes up, and half the room between two.
const LETTER: f64 = 3.2;
const HIGH: f64 = 5.5;
const APART: f64 = 2.0;
/// Parts of a line at which its level may stand, the first that is free; neighbours begin elsewhere.
const PARTS: [f64; 9] = [0.5, 0.38, 0.62, 0.26, 0.74, 0.14, 0.86, 0.06, 0.94];
/// Size of the names of marks.
const NAME: f64 = 12.0;
/// Sequential, in order of lightness, for those who do not tell colours apart: ColorBrewer YlGnBu.
const COLOURS: [[f64; 3]; 7] = [
    [255.0, 255.0, 217.0],
    [214.0, 239.0, 179.0],
    [143.0, 212.0, 185.0],
    [75.0, 184.0, 196.0],
    [33.0, 140.0, 187.0],
    [35.0, 88.0, 163.0],
    [16.0, 40.0, 110.0],
];

/// The colours of some maps, each with its own, and the levels of its lines.
#[derive(Clone, Debug, Serialize)]
pub struct Scale {
    /// Of each map.
    pub maps: Vec<Levels>,
    /// Of each map, the values of the first and the last colour.
    #[serde(skip)]
    ends: Vec<[f64; 2]>,
}

/// The lines of a map.
#[derive(Clone, Debug, Serialize)]
pub struct Levels {
    /// Their levels, increasing.
    pub levels: Vec<f64>,
    /// The colours between them: one more.
    pub colours: Vec<String>,
    /// For each line, whether it lies on dark ground.
    pub dark: Vec<bool>,
}

/// The colour at `t` in `[0, 1]`.
fn colour(t: f64) -> String {
    let x = t.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let i = (x as usize).min(COLOURS.len() - 2);
    let part = x - i as f64;
    let [r, g, b] =
        from_fn(|k| (COLOURS[i][k] + part * (COLOURS[i + 1][k] - COLOURS[i][k])).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

impl Scale {
    /// The scale for maps of which these values were sampled; `None` where one has none.
    pub fn over(mut found: Vec<Vec<f64>>) -> Option<Self> {
        found.iter_mut().for_each(|all| all.sort_by(f64::total_cmp));
        let ends: Vec<[f64; 2]> = found.iter().map(|all| typical(all)).collect::<Option<_>>()?;
        let maps = ends.iter().map(|ends| Levels::within(*ends)).collect();
        Some(Scale { maps, ends })
    }

    /// The colours of each map and some of their values, as a strip below it.
    pub fn legends(&self) -> Vec<String> {
        self.ends.iter().map(|ends| strip(*ends)).collect()
    }
}

/// The colours of a map, and some of their values.
fn strip([low, high]: [f64; 2]) -> String {
    const PIECES: usize = 40;
    const LENGTH: f64 = 250.0;
    const LABELS: usize = 6;
    let width = LENGTH / PIECES as f64;
    let mut out = Elements::default();
    for k in 0..PIECES {
        let (x, colour) = (25.0 + width * k as f64, colour((k as f64 + 0.5) / PIECES as f64));
        out.raw(&format!(
            "<rect x=\"{x:.2}\" y=\"4\" width=\"{:.2}\" height=\"10\" fill=\"{colour}\"/>",
            width + 0.3
        ));
    }
    let all = levels(low, high);
    for level in all.iter().step_by(all.len().div_ceil(LABELS).max(1)) {
        let x = 25.0 + LENGTH * position(*level, [low, high]);
        out.line("axis-line", [x, 14.0], [x, 17.0]);
        out.text("tick middle", [x, 28.0], &significant(*level, 6));
    }
    let svg = out.0;
    format!(
        "<svg class=\"figure scale\" viewBox=\"0 0 300 32\" role=\"img\"><title>Scale of the map above: \
         from {} to {}</title>{svg}</svg>",
        significant(low, 4),
        significant(high, 4)
    )
}

/// Where a value stands between the first and the last colour.
fn position(value: f64, [low, high]: [f64; 2]) -> f64 {
    if is_wide(low, high) {
        (value / low).ln() / (high / low).ln()
    } else if high > low {
        (value - low) / (high - low)
    } else {
        0.5
    }
}

/// Whether levels are spaced by factors.
fn is_wide(low: f64, high: f64) -> bool {
    low > 0.0 && high / low > WIDE
}

/// The range of sorted values. A few points next to a singularity must not set it for all others.
fn typical(sorted: &[f64]) -> Option<[f64; 2]> {
    let at = |share: f64| sorted.get((sorted.len().max(1) as f64 * share - share) as usize);
    let between = |low: f64, high: f64| Some([*at(low)?, *at(high)?]);
    let [low, high] = between(0.0, 1.0)?;
    if is_wide(low, high) {
        between(0.03, 0.97)
    } else {
        Some([low, high])
    }
}

impl Levels {
    /// The lines of a map whose values are within `ends`, and its colours.
    fn within(ends: [f64; 2]) -> Self {
        let [low, high] = ends;
        let levels = levels(low, high);
        let bounds: Vec<f64> = [&[low], &levels[..], &[high]].concat();
        let middle = |pair: &[f64]| colour(position((pair[0] + pair[1]) / 2.0, ends));
        let colours = bounds.windows(2).map(middle).collect();
        let dark = levels.iter().map(|level| position(*level, ends) >= 0.55).collect();
        Levels { levels, colours, dark }
    }
}

/// Round numbers between two values.
fn levels(low: f64, high: f64) -> Vec<f64> {
    if high - low <= 1e-9 * high.abs() {
        return Vec::new();
    }
    if is_wide(low, high) {
        let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let all = decades.flat_map(|e| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(e)));
        return all.filter(|x| (low..=high).contains(x)).take(24).collect();
    }
    let raw = (high - low) / LEVELS;
    let unit = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|m| m * unit).find(|s| *s >= raw);
    let step = step.unwrap_or(raw);
    let first = (low / step).ceil() as i64;
    let inner = (first..first + 24).map(|i| i as f64 * step);
    inner.filter(|x| *x > low + 1e-9 * step && *x < high - 1e-9 * step).collect()
}

/// A point that is marked.
#[derive(Clone, Debug, Serialize)]
pub struct Mark {
    /// Its name.
    pub name: String,
    /// Where it is: the coordinates of the workspace.
    pub at: Vec<f64>,
}

impl Mark {
    /// The first three coordinates.
    pub fn position(&self) -> Point {
        from_fn(|k| self.at.get(k).copied().unwrap_or(0.0))
    }
}

/// Two coordinates of a workspace, and where they are in a picture.
pub struct Plane {
    corner: [f64; 2],
    size: [f64; 2],
    least: [f64; 2],
    width: [f64; 2],
    names: [String; 2],
    /// Whether the slice of the workspace is the ellipse in the rectangle.
    is_round: bool,
}

impl Plane {
    /// The plane of a slice. It is true to scale where both coordinates are of a kind, unless that
    /// leaves a strip.
    pub fn new(
        least: [f64; 2],
        width: [f64; 2],
        names: [&str; 2],
        is_round: bool,
        same_kind: bool,
    ) -> Self {
        let [left, top, right, bottom] = MARGIN;
        let room = [SIZE[0] - left - right, SIZE[1] - top - bottom];
        let scales: [f64; 2] = from_fn(|k| room[k] / width[k].max(f64::MIN_POSITIVE));
        let scale = scales[0].min(scales[1]);
        let size = if same_kind {
            from_fn(|k| (scale * width[k]).max(room[k] / NARROWEST))
        } else {
            room.map(|side| side.min(room[0]))
        };
        let corner = [left + (room[0] - size[0]) / 2.0, top + (room[1] - size[1]) / 2.0];
        Plane { corner, size, least, width, names: names.map(str::to_owned), is_round }
    }

    fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let part = |k: usize, v: f64| {
            if self.width[k] > 0.0 {
                (v - self.least[k]) / self.width[k]
            } else {
                0.5
            }
        };
        [
            self.corner[0] + part(0, x) * self.size[0],
            self.corner[1] + (1.0 - part(1, y)) * self.size[1],
        ]
    }

    /// The rectangle that it takes.
    fn frame(&self) -> Rectangle {
        [self.corner, from_fn(|k| self.corner[k] + self.size[k])]
    }

    /// Whether a rectangle is in it, and in the ellipse, if the slice is one.
    fn has(&self, rectangle: &Rectangle) -> bool {
        let [least, greatest] = self.frame();
        if !self.is_round {
            return (0..2).all(|k| least[k] <= rectangle[0][k] && rectangle[1][k] <= greatest[k]);
        }
        let from = |k: usize, x: f64| 2.0 * (x - self.corner[k]) / self.size[k] - 1.0;
        let corner = |i: usize, j: usize| from(0, rectangle[i][0]).hypot(from(1, rectangle[j][1]));
        [(0, 0), (0, 1), (1, 0), (1, 1)].iter().all(|(i, j)| corner(*i, *j) <= 1.0)
    }

    /// A function at the nodes of a grid over the plane.
    pub fn field(&self, nodes: usize, f: impl FnMut(f64, f64) -> f64) -> Field {
        let along = |k: usize| -> Vec<f64> {
            let at = |i: usize| self.least[k] + self.width[k] * i as f64 / (nodes - 1) as f64;
            (0..nodes).map(at).collect()
        };
        Field::of(along(0), along(1), f)
    }
}

/// What a map shows.
pub struct Map<'a> {
    /// Name of its file.
    pub name: &'a str,
    /// Above it.
    pub heading: &'a str,
    /// For those who do not see it.
    pub title: String,
    /// The function's values; NaN where there is none.
    pub field: &'a Field,
    /// At least zero where a leg does not reach.
    pub out_of_reach: &'a Field,
    /// Its lines and colours.
    pub levels: &'a Levels,
    /// Names of points, and where they are in the plane.
    pub marks: &'a [(&'a str, [f64; 2])],
    /// Its number, where a script moves the slice.
    pub script: Option<usize>,
}

/// The picture of a map.
pub fn map(plane: &Plane, shown: &Map<'_>) -> Picture {
    let Map { name, heading, field, levels: Levels { levels, colours, dark }, .. } = shown;
    let on_plane = |path: &Path| -> Path { path.iter().map(|p| plane.at(p[0], p[1])).collect() };
    let area =
        |paths: &[Path]| paths.iter().map(|p| path_data(&on_plane(p), true)).collect::<String>();
    let sets: Vec<LevelSet> = levels.iter().map(|level| field.at_least(*level)).collect();
    let mut out = Elements::default();
    out.raw(&frame_definitions(name, plane));
    out.raw(&format!("<g class=\"field\" clip-path=\"url(#{name}-clip)\">"));
    let [x, y] = plane.corner;
    let [w, h] = plane.size;
    let rectangle = format!("x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\"");
    out.raw(&format!("<rect {rectangle} fill=\"{}\"/>", colours[0]));
    for (set, fill) in sets.iter().zip(&colours[1..]) {
        let d = area(&set.area);
        out.raw(&format!("<path class=\"band\" fill=\"{fill}\" d=\"{d}\"/>"));
    }
    let mut labels = Elements::default();
    let mut taken = Taken::default();
    let dots = shown.marks.iter().map(|(_, [x, y])| about(plane.at(*x, *y), [5.0, 5.0]));
    taken.names.extend(dots);
    let mut names = Elements::default();
    for (name, [x, y]) in shown.marks {
        let at = plane.at(*x, *y);
        let mut places = beside(at, 7.0);
        if 2.0 * (at[0] - plane.corner[0]) > plane.size[0] {
            places.swap(0, 2);
            places.swap(1, 3);
        }
        let (class, place) = taken.put(name, &places, NAME, &plane.frame());
        names.dot("mark", at, 3.5);
        names.text(&format!("mark-label {class}"), place, name);
    }
    for (k, set) in sets.iter().enumerate() {
        let class = if dark[k] { "level on-dark" } else { "level" };
        let d: String = set.lines.iter().map(|p| path_data(&on_plane(p), false)).collect();
        out.raw(&format!("<path class=\"{class}\" d=\"{d}\"/>"));
        let mut lines: Vec<Path> = set.lines.iter().map(on_plane).collect();
        lines.retain(|line| length(line) >= LABELLED);
        lines.sort_by(|a, b| length(b).total_cmp(&length(a)));
        let text = significant(levels[k], 6);
        let half = [LETTER * text.chars().count() as f64 + APART, HIGH + APART];
        let at = |line: &Path, i: usize| along(line, PARTS[(i + k % 3) % PARTS.len()]);
        let places = lines.iter().flat_map(|line| (0..PARTS.len()).map(move |i| at(line, i)));
        let is_free = |at: &[f64; 2]| {
            let own = about(*at, half);
            plane.has(&own) && taken.is_free(&own)
        };
        if let Some([x, y]) = places.into_iter().find(is_free) {
            taken.names.push(about([x, y], half));
            labels.text("level-label", [x, y + 3.5], &text);
        }
    }
    out.raw(&format!(
        "<path class=\"unreachable\" fill=\"url(#{name}-hatch)\" d=\"{}\"/>",
        area(&shown.out_of_reach.at_least(0.0).area)
    ));
    out.raw(&labels.0);
    out.raw("</g>");
    frame(&mut out, plane);
    out.raw(&names.0);
    out.text("map-title", [plane.corner[0], 18.0], heading);
    let attributes = match shown.script {
        Some(i) => {
            out.raw("<g class=\"crosshair\"></g>");
            format!(
                "data-map=\"{i}\" data-x=\"{x:.3}\" data-y=\"{y:.3}\" data-w=\"{w:.3}\" data-h=\"{h:.3}\""
            )
        }
        None => String::new(),
    };
    Picture {
        name: (*name).to_owned(),
        title: shown.title.clone(),
        size: SIZE,
        attributes,
        content: out.0,
    }
}

/// The clip of the workspace and the hatching of what is out of reach.
fn frame_definitions(name: &str, plane: &Plane) -> String {
    let ([x, y], [w, h]) = (plane.corner, plane.size);
    let mut out = format!("<defs><clipPath id=\"{name}-clip\">");
    let _ = if plane.is_round {
        let (rx, ry) = (w / 2.0, h / 2.0);
        let (cx, cy) = (x + rx, y + ry);
        write!(out, "<ellipse cx=\"{cx:.1}\" cy=\"{cy:.1}\" rx=\"{rx:.1}\" ry=\"{ry:.1}\"/>")
    } else {
        write!(out, "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\"/>")
    };
    out.push_str("</clipPath>");
    let _ = write!(
        out,
        "<pattern id=\"{name}-hatch\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">\
         <rect class=\"hatch-ground\" width=\"6\" height=\"6\"/>\
         <path class=\"hatch\" d=\"M-1 7L7 -1M-1 1L1 -1M5 7L7 5\"/></pattern></defs>"
    );
    out
}

/// The workspace's outline and the axes.
fn frame(out: &mut Elements, plane: &Plane) {
    let ([x, y], [w, h]) = (plane.corner, plane.size);
    if plane.is_round {
        let (rx, ry) = (w / 2.0, h / 2.0);
        let (cx, cy) = (x + rx, y + ry);
        out.raw(&format!(
            "<ellipse class=\"outline\" cx=\"{cx:.1}\" cy=\"{cy:.1}\" rx=\"{rx:.1}\" ry=\"{ry:.1}\"/>"
        ));
    } else {
        let (r, b) = (x + w, y + h);
        out.path("outline", &[[x, y], [r, y], [r, b], [x, b]], true);
    }
    let (bottom, far) = (y + h, [plane.least[0] + plane.width[0], plane.least[1] + plane.width[1]]);
    out.text("tick start", [x, bottom + 15.0], &significant(plane.least[0], 4));
    out.text("tick end", [x + w, bottom + 15.0], &significant(far[0], 4));
    out.text("axis middle", [x + w / 2.0, bottom + 15.0], &plane.names[0]);
    out.text("tick end", [x - 5.0, bottom], &significant(plane.least[1], 4));
    out.text("tick end", [x - 5.0, y + 9.0], &significant(far[1], 4));
    beside_axis(out, [x, y + h / 2.0], &plane.names[1]);
}

/// The name of an upright axis, to the left of its middle.
pub fn beside_axis(out: &mut Elements, [x, y]: [f64; 2], name: &str) {
    if name.chars().count() <= SHORT_NAME {
        out.text("axis end", [x - 9.0, y + 4.0], name);
    } else {
        out.upright("axis middle", [x - 12.0, y], name);
    }
}

fn length(line: &[[f64; 2]]) -> f64 {
    line.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum()
}

/// The point at a part of a line's length.
fn along(line: &[[f64; 2]], part: f64) -> [f64; 2] {
    let mut rest = part * length(line);
    for pair in line.windows(2) {
        let piece = length(pair);
        if piece >= rest {
            let t = if piece > 0.0 { rest / piece } else { 0.0 };
            return from_fn(|k| pair[0][k] + t * (pair[1][k] - pair[0][k]));
        }
        rest -= piece;
    }
    line[line.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_inside() {
        let found = levels(0.5, 2.0);
        assert_eq!(found.len(), 7, "{found:?}");
        assert!(
            found.iter().all(|x| *x > 0.5 && *x < 2.0)
                && found.iter().all(|x| (5.0 * x - (5.0 * x).round()).abs() < 1e-9)
        );
        assert!(levels(1.0, 1.0).is_empty());
        assert_eq!(levels(0.01, 1.0), [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0]);
    }

    #[test]
    fn colours_darken_with_the_value() {
        let light = |t: f64| {
            let c = u32::from_str_radix(&colour(t)[1..], 16).unwrap();
            2126 * (c >> 16) + 7152 * (c >> 8 & 255) + 722 * (c & 255)
        };
        let all: Vec<u32> = (0..=20).map(|i| light(f64::from(i) / 20.0)).collect();
        assert!(all.windows(2).all(|w| w[1] < w[0]), "{all:?}");
    }
}
