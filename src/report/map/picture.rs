//! The map as a picture (SVG): verdicts by colour and by pattern, lines of equal margin, axes with
//! ticks, marks.
//!
//! One parameter makes a strip, two a map, three a row of maps: the planes through the middles of
//! four equal parts of the third parameter's range.

use super::contours::Contour;
use crate::design::AtlasDesign;
use crate::exact::Exact;
use crate::report::escape::xml;
use crate::report::page::svg::path_data;
use num_traits::ToPrimitive;
use orthocert_kernel::atlas::{walk, Part};
use orthocert_kernel::certificate::AtlasCell;
use std::fmt::Write;

/// Side of a map, in pixels.
const SIDE: f64 = 420.0;
/// Height of a strip.
const STRIP: f64 = 90.0;
/// Room left, right, above and below a map.
const ROOM: [f64; 4] = [84.0, 24.0, 40.0, 66.0];
/// Half the width and half the height of a label, at most.
const LABEL: [f64; 2] = [24.0, 9.0];
/// Distance at which labels are far enough from each other.
const FAR: f64 = 40.0;
/// Distance of the entries of the legend.
const KEY: f64 = 112.0;
/// How far the first stands to the left of the map, that the last has room.
const KEY_LEFT: f64 = 40.0;
/// Height of the line that says where a plane is.
const PLANE_LABEL: f64 = 24.0;
/// Planes shown of three parameters.
const PLANES: u32 = 4;
/// Colours of certified, refuted and undecided cells: told apart by those who do not tell red from
/// green, and in grey by their patterns.
const STYLE: &str = r##"<style>
text { font: 13px sans-serif; fill: #222 }
.axis { stroke: #222; fill: none } .cell { stroke: #fff; stroke-width: .25 }
.c { fill: #4c9bd6 } .r { fill: url(#failing) } .u { fill: url(#unknown) }
.iso { fill: none; stroke: #082340; stroke-width: 1.3 }
.level { font-size: 11px; fill: #082340; paint-order: stroke; stroke: #a9d1ef; stroke-width: 5px; stroke-linejoin: round }
.mark { fill: #ffd400; stroke: #111; stroke-width: 1.5 }
.name { paint-order: stroke; stroke: #fff; stroke-width: 4px; fill: #222 }
@media (prefers-color-scheme: dark) {
text { fill: #e6eaf0 } .axis { stroke: #e6eaf0 } .key { stroke: #8fc7f2 }
.level { fill: #082340 } .name { fill: #222 }
}
</style>
<defs>
<pattern id="failing" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
<rect width="7" height="7" fill="#f3c9a8"/><rect width="2" height="7" fill="#b4511c"/></pattern>
<pattern id="unknown" width="4" height="4" patternUnits="userSpaceOnUse">
<rect width="4" height="4" fill="#fff"/><circle cx="2" cy="2" r="1" fill="#333"/></pattern>
</defs>
"##;

/// A design shown on the map.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name.
    pub label: String,
    /// Its parameters.
    pub at: Vec<Exact>,
}

/// A range of an axis, for drawing.
#[derive(Clone, Copy)]
struct Span {
    min: f64,
    max: f64,
}

impl Span {
    fn part(self, x: f64) -> f64 {
        (x - self.min) / (self.max - self.min)
    }
}

/// The picture of a map.
pub fn picture(
    design: &AtlasDesign,
    cells: &[AtlasCell],
    contours: &[Contour],
    points: &[Point],
) -> String {
    let spans: Vec<Span> = design
        .parameters
        .iter()
        .map(|p| Span { min: approximate(&p.min), max: approximate(&p.max) })
        .collect();
    let panels = if spans.len() > 2 { PLANES } else { 1 };
    let high = if spans.len() > 1 { SIDE } else { STRIP };
    let [left, right, mut above, below] = ROOM;
    if panels > 1 {
        above += PLANE_LABEL;
    }
    let pitch = left + SIDE + right;
    let (width, height) = (pitch * f64::from(panels), above + high + below);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" role=\"img\">\n<title>{}</title>\n{STYLE}",
        xml(design.title.as_deref().unwrap_or("Atlas"))
    );
    for panel in 0..panels {
        let plane = (panels > 1).then(|| (2 * panel + 1, 2 * PLANES));
        let x = left + pitch * f64::from(panel);
        let _ = writeln!(svg, "<g transform=\"translate({x} {above})\">");
        draw_cells(&mut svg, design, cells, high, plane);
        draw_contours(&mut svg, contours, &names(&spans, points, high), high);
        draw_axes(&mut svg, design, &spans, high);
        if panel == 0 {
            let higher = if panels > 1 { PLANE_LABEL } else { 0.0 };
            legend(&mut svg, higher, !contours.is_empty());
        }
        if let (Some((part, of)), Some(span)) = (plane, spans.get(2)) {
            let at = span.min + (span.max - span.min) * f64::from(part) / f64::from(of);
            let label = xml(design.labels.get(2).map_or("", String::as_str));
            let _ = writeln!(svg, "<text x=\"0\" y=\"-12\">{label} = {}</text>", short(at));
        }
        if plane.is_none() {
            draw_points(&mut svg, &spans, points, high);
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn approximate(x: &Exact) -> f64 {
    match x.as_rational() {
        Some(x) => x.to_f64().unwrap_or(0.0),
        None => x.below(64).and_then(|x| x.to_f64()).unwrap_or(0.0),
    }
}

/// Whether the plane at `part / of` of the third range passes through the edge.
fn meets((n, level): (u64, u32), (part, of): (u32, u32)) -> bool {
    let at = f64::from(part) / f64::from(of);
    let scale = (-f64::from(level)).exp2();
    let from = n as f64 * scale;
    from <= at && at < from + scale
}

fn draw_cells(
    svg: &mut String,
    design: &AtlasDesign,
    cells: &[AtlasCell],
    high: f64,
    plane: Option<(u32, u32)>,
) {
    let strip = design.parameters.len() == 1;
    let ends = |(n, level): (u64, u32), length: f64| {
        let scale = (-f64::from(level)).exp2() * length;
        (n as f64 * scale, scale)
    };
    // The tree's shape was checked with the certificate.
    let _ = walk(cells, design.parameters.len(), |_, cell: &Part, said| {
        if plane.is_some_and(|plane| !meets(cell[2], plane)) {
            return Ok(());
        }
        let class = match said {
            AtlasCell::Certified(_) => "c",
            AtlasCell::Refuted(_) => "r",
            AtlasCell::Undecided | AtlasCell::Split(_) => "u",
        };
        let (x, w) = ends(cell[0], SIDE);
        let (y, h) = if strip { (0.0, high) } else { ends(cell[1], high) };
        let _ = writeln!(
            svg,
            "<rect class=\"cell {class}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
            short(x),
            short(high - y - h),
            short(w),
            short(h)
        );
        Ok(())
    });
}

/// The lines of equal margin, with their margins where there is room.
fn draw_contours(svg: &mut String, contours: &[Contour], names: &[[f64; 2]], high: f64) {
    let mut taken = names.to_vec();
    // Over all lines.
    let mut labels = String::new();
    for Contour { percent, lines } in contours {
        let shown = |[x, y]: &[f64; 2]| [x * SIDE, high - y * high];
        let lines: Vec<Vec<[f64; 2]>> =
            lines.iter().map(|line| line.iter().map(shown).collect()).collect();
        let longest = lines.iter().max_by_key(|line| line.len());
        // A line in a corner that has no room for its margin says nothing.
        let Some([x, y]) = longest.and_then(|line| free(line, &taken, high)) else {
            continue;
        };
        for line in &lines {
            let _ = writeln!(svg, "<path class=\"iso\" d=\"{}\"/>", path_data(line, false));
        }
        taken.push([x, y]);
        let _ = writeln!(
            labels,
            "<text class=\"level\" x=\"{}\" y=\"{}\" dy=\".35em\" text-anchor=\"middle\">{} \
             %</text>",
            short(x),
            short(y),
            short(*percent)
        );
    }
    svg.push_str(&labels);
}

/// The point of a line next to its middle that is far enough from all that is taken, or the
/// farthest; of those around which a label is within the map.
fn free(line: &[[f64; 2]], taken: &[[f64; 2]], high: f64) -> Option<[f64; 2]> {
    let middle = line.len() as f64 / 2.0;
    let room = |[x, y]: &[f64; 2]| {
        let far = taken.iter().map(|t| (x - t[0]).hypot(2.0 * (y - t[1])));
        far.fold(FAR, f64::min)
    };
    let off = |i: usize| (i as f64 - middle).abs();
    let within = |[x, y]: &[f64; 2]| {
        let [across, up] = LABEL;
        (across..=SIDE - across).contains(x) && (up..=high - up).contains(y)
    };
    let best = line
        .iter()
        .enumerate()
        .filter(|(_, point)| within(point))
        .min_by(|(i, a), (j, b)| room(b).total_cmp(&room(a)).then(off(*i).total_cmp(&off(*j))));
    best.map(|(_, point)| *point)
}

fn draw_axes(svg: &mut String, design: &AtlasDesign, spans: &[Span], high: f64) {
    let _ = writeln!(svg, "<rect class=\"axis\" width=\"{SIDE}\" height=\"{high}\"/>");
    for tick in ticks(spans[0]) {
        let x = short(spans[0].part(tick) * SIDE);
        let _ = writeln!(
            svg,
            "<path class=\"axis\" d=\"M{x} {high}v6\"/><text x=\"{x}\" y=\"{}\" \
             text-anchor=\"middle\">{}</text>",
            high + 21.0,
            short(tick)
        );
    }
    let label = |i: usize| xml(design.labels.get(i).map_or("", String::as_str));
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        SIDE / 2.0,
        high + 46.0,
        label(0)
    );
    let Some(&span) = spans.get(1) else {
        return;
    };
    for tick in ticks(span) {
        let y = short(high - span.part(tick) * high);
        let _ = writeln!(
            svg,
            "<path class=\"axis\" d=\"M0 {y}h-6\"/><text x=\"-10\" y=\"{y}\" dy=\".35em\" \
             text-anchor=\"end\">{}</text>",
            short(tick)
        );
    }
    let _ = writeln!(
        svg,
        "<text transform=\"translate(-60 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        high / 2.0,
        label(1)
    );
}

/// What the colours, the patterns and the lines mean, `higher` than it stands over a single map.
fn legend(svg: &mut String, higher: f64, has_contours: bool) {
    let top = -28.0 - higher;
    let words = [("c", "certified"), ("r", "refuted"), ("u", "undecided")];
    for (i, (class, word)) in words.iter().enumerate() {
        let x = KEY * i as f64 - KEY_LEFT;
        let _ = writeln!(
            svg,
            "<rect class=\"axis {class}\" x=\"{x}\" y=\"{top}\" width=\"22\" height=\"16\"/>\
             <text x=\"{}\" y=\"{}\">{word}</text>",
            x + 29.0,
            top + 13.0
        );
    }
    if has_contours {
        let x = KEY * words.len() as f64 - KEY_LEFT;
        let _ = writeln!(
            svg,
            "<path class=\"iso key\" d=\"M{x} {}h22\"/><text x=\"{}\" y=\"{}\">margin, \
             sampled</text>",
            top + 8.0,
            x + 29.0,
            top + 13.0
        );
    }
}

/// Where a point is, and which way its name goes: where there is room.
fn seen(spans: &[Span], point: &Point, high: f64) -> Option<([f64; 2], f64)> {
    let mut parts = spans.iter().zip(&point.at).map(|(span, x)| span.part(approximate(x)));
    let x = parts.next().unwrap_or(0.0);
    let y = parts.next().unwrap_or(0.5);
    let within = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
    within.then_some(([x * SIDE, high - y * high], if x > 0.7 { -1.0 } else { 1.0 }))
}

/// The ends and the middles of what is drawn of points.
fn names(spans: &[Span], points: &[Point], high: f64) -> Vec<[f64; 2]> {
    let seen = points.iter().filter_map(|point| Some((point, seen(spans, point, high)?)));
    seen.flat_map(|(point, ([x, y], way))| {
        let long = 9.0 + 7.0 * point.label.chars().count() as f64;
        [0.0, 0.5, 1.0].map(|part| [x + way * part * long, y])
    })
    .collect()
}

fn draw_points(svg: &mut String, spans: &[Span], points: &[Point], high: f64) {
    for point in points {
        let Some(([x, y], way)) = seen(spans, point, high) else {
            continue;
        };
        let anchor = if way < 0.0 { "end" } else { "start" };
        let _ = writeln!(
            svg,
            "<circle class=\"mark\" cx=\"{}\" cy=\"{}\" r=\"5\"/><text class=\"name\" x=\"{}\" \
             y=\"{}\" dy=\".35em\" text-anchor=\"{anchor}\">{}</text>",
            short(x),
            short(y),
            short(x + 9.0 * way),
            short(y),
            xml(&point.label)
        );
    }
}

/// About five round numbers within a range.
fn ticks(span: Span) -> Vec<f64> {
    let rough = (span.max - span.min) / 5.0;
    if !rough.is_normal() {
        return Vec::new();
    }
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough);
    let step = step.unwrap_or(rough);
    let first = (span.min / step - 1e-9).ceil();
    (0..12)
        .map(|i| (first + f64::from(i)) * step)
        .filter(|x| *x <= span.max + 1e-9 * step)
        .collect()
}

/// A number with a few digits.
fn short(x: f64) -> String {
    let rounded = (x * 1e4).round() / 1e4;
    // No negative zero.
    format!("{}", rounded + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let near = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        let span = |min, max| Span { min, max };
        assert!(near(&ticks(span(0.2, 0.8)), &[0.2, 0.4, 0.6, 0.8]));
        assert!(near(&ticks(span(-1.0, 1.0)), &[-1.0, -0.5, 0.0, 0.5, 1.0]));
        assert!(near(&ticks(span(130.0, 330.0)), &[150.0, 200.0, 250.0, 300.0]));
        assert!(ticks(span(1.0, 1.0)).is_empty());
    }

    #[test]
    fn text_cannot_break_the_picture() {
        assert_eq!(xml("a<b & \"c\"\u{7}"), "a&lt;b &amp; &quot;c&quot;\\u{7}");
    }
}
