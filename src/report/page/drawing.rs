//! The machine and its workspace, in a parallel view: what the claim is about.

use super::isomap::Mark;
use super::labels::{about, beside, Place, Rectangle, Taken};
use super::legs::{add, dot, scaled, Numbers, Point, Shape};
use super::mechanism::subscript;
use super::svg::{Elements, Fitted, Picture, View};
use crate::report::point_text;

const SIZE: [f64; 2] = [720.0, 470.0];
/// The viewer's angle above the horizon.
const ELEVATION: f64 = 24.0;

/// Size of names.
const NAME: f64 = 13.0;

/// The elements of a drawing, and its names: these last, so that nothing is drawn over them.
#[derive(Default)]
struct Layers {
    lines: Elements,
    names: Vec<Name>,
    taken: Taken,
}

/// A name, and where it may stand.
struct Name {
    class: &'static str,
    text: String,
    places: Vec<Place>,
}

impl Layers {
    fn name(&mut self, class: &'static str, text: String, places: Vec<Place>) {
        self.names.push(Name { class, text, places });
    }

    fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        self.lines.line(class, from, to);
        self.taken.lines.push([from, to]);
    }

    fn dot(&mut self, class: &str, at: [f64; 2], radius: f64) {
        self.lines.dot(class, at, radius);
        self.taken.names.push(about(at, [radius; 2]));
    }
}

/// The drawing of a machine, and marked points: from the side, or, of a machine in the plane, from
/// above.
pub fn drawing(machine: &Shape, marks: &[Mark]) -> Picture {
    let p = machine.position;
    let count = machine.legs.len();
    let view = if machine.is_flat { View::from(-90.0, 90.0) } else { apart(machine) };
    let guides: Vec<Option<[Point; 2]>> = (0..count).map(|i| guide(machine, i)).collect();
    let mut extent: Vec<Point> = machine.outline.rings.iter().flatten().copied().collect();
    extent.extend(guides.iter().flatten().flatten());
    for i in 0..count {
        extent.extend(machine.pose(i, p).iter().flat_map(|pose| [pose.driven, pose.platform]));
        extent.extend(anchor(machine, i));
    }
    let bodies = bodies(machine);
    extent.extend(bodies.iter().flatten());
    extent.extend(marks.iter().map(Mark::position));
    extent.push(p);
    let fitted = Fitted::new(view, &extent, [46.0, 34.0], [SIZE[0] - 92.0, SIZE[1] - 68.0]);
    let mut layers = Layers::default();
    workspace(&mut layers.lines, machine, &view, &fitted);
    axes(&mut layers.lines, &view, if machine.is_flat { 2 } else { 3 });
    for [from, to] in bodies {
        layers.line("body", fitted.at(from), fitted.at(to));
    }
    for (i, guide) in guides.iter().enumerate() {
        leg(&mut layers, machine, i, *guide, &fitted);
    }
    platform_body(&mut layers, machine, &fitted);
    joints(&mut layers, machine, &fitted);
    corners(&mut layers, machine, &fitted);
    for mark in marks {
        let at = fitted.at(mark.position());
        layers.dot("mark", at, 4.5);
        // First of all names, and so where there is most room.
        let name =
            Name { class: "mark-label", text: mark.name.clone(), places: beside(at, 9.0).into() };
        layers.names.insert(0, name);
    }
    let Layers { lines: mut out, names, mut taken } = layers;
    let frame: Rectangle = [[4.0, 4.0], [SIZE[0] - 4.0, SIZE[1] - 4.0]];
    for Name { class, text, places } in names {
        let (anchor, place) = taken.put(&text, &places, NAME, &frame);
        out.text(&format!("{class} {anchor}"), place, &text);
    }
    Picture {
        name: "design".to_owned(),
        title: "The nominal machine: legs, platform and workspace".to_owned(),
        size: SIZE,
        attributes: String::new(),
        content: out.0,
    }
}

/// The view from the side in which the legs are farthest apart: their middles and their driven ends.
fn apart(machine: &Shape) -> View {
    const USUAL: f64 = 58.0;
    const BETTER: f64 = 1.3;
    let poses = (0..machine.legs.len()).filter_map(|i| machine.pose(i, machine.position));
    let points: Vec<[Point; 2]> =
        poses.map(|pose| [scaled(0.5, add(pose.driven, pose.platform)), pose.driven]).collect();
    let least = |azimuth: f64| {
        let view = View::from(azimuth, ELEVATION);
        let seen: Vec<[[f64; 2]; 2]> = points.iter().map(|p| p.map(|p| view.seen(p))).collect();
        let mut least = f64::INFINITY;
        for (i, one) in seen.iter().enumerate() {
            for other in &seen[..i] {
                for k in 0..2 {
                    least = least.min((one[k][0] - other[k][0]).hypot(one[k][1] - other[k][1]));
                }
            }
        }
        least
    };
    // Not along an axis, which would be a point.
    let all =
        [-75.0, 15.0].into_iter().flat_map(|first| (0..13).map(move |k| first + f64::from(5 * k)));
    let best = all.max_by(|a, b| least(*a).total_cmp(&least(*b))).unwrap_or(USUAL);
    let azimuth = if least(best) > BETTER * least(USUAL) { best } else { USUAL };
    View::from(azimuth, ELEVATION)
}

/// The axes of the bodies, where the platform is.
fn bodies(machine: &Shape) -> Vec<[Point; 2]> {
    let [base, platform] = &machine.bodies;
    let carried = platform.iter().map(|ends| ends.map(|b| machine.carried(machine.position, b)));
    base.iter().copied().chain(carried).collect()
}

fn workspace(out: &mut Elements, machine: &Shape, view: &View, fitted: &Fitted) {
    let rings = &machine.outline.rings;
    let shown: Vec<Vec<[f64; 2]>> =
        rings.iter().map(|ring| ring.iter().map(|p| fitted.at(*p)).collect()).collect();
    let around = hull(shown.concat());
    if around.len() > 1 {
        out.path("solid", &around, true);
    }
    let [below, above] = match (&shown[..], &rings[..]) {
        ([ring], _) => return out.path("edge", ring, true),
        ([below, above], [..]) => [below, above],
        _ => return,
    };
    if machine.outline.is_round {
        out.path("hidden", below, true);
        out.path("edge", above, true);
        out.path("edge outline-only", &around, true);
        return;
    }
    // The corner farthest from the viewer, and the edges that meet there.
    let corners = rings.concat();
    let depth = |i: &usize| dot(view.toward, corners[*i]);
    let far = (0..corners.len()).min_by(|i, j| depth(i).total_cmp(&depth(j)));
    let n = below.len();
    for i in 0..n {
        for (a, b) in [(i, (i + 1) % n), (n + i, n + (i + 1) % n), (i, n + i)] {
            let class = if Some(a) == far || Some(b) == far { "hidden" } else { "edge" };
            out.line(class, fitted.at(corners[a]), fitted.at(corners[b]));
        }
    }
}

/// The coordinates of two corners of a workspace with edges.
fn corners(layers: &mut Layers, machine: &Shape, fitted: &Fitted) {
    if machine.outline.is_round {
        return;
    }
    // The highest and the lowest in the picture, beside which nothing of the workspace is.
    let all = machine.outline.rings.concat();
    let height = |p: &&Point| fitted.at(**p)[1];
    let least = all.iter().max_by(|a, b| height(a).total_cmp(&height(b)));
    let greatest = all.iter().min_by(|a, b| height(a).total_cmp(&height(b)));
    let shown = if machine.is_flat { 2 } else { 3 };
    for (corner, below) in least.zip(Some(16.0)).into_iter().chain(greatest.zip(Some(-9.0))) {
        let [x, y] = fitted.at(*corner);
        let mut places = vec![("middle", [x, y + below])];
        places.extend(beside([x, y], 9.0));
        layers.name("label leg-label", point_text(&corner[..shown], 4), places);
    }
}

/// The convex hull, in order.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |o: &[f64; 2], a: &[f64; 2], b: &[f64; 2]| {
        (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
    };
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut out: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = out[..] {
                if turn(&a, &b, &p) > 0.0 {
                    break;
                }
                out.pop();
            }
            out.push(p);
        }
        out.pop();
        out
    };
    let mut out = half(&mut points.iter().copied());
    out.extend(half(&mut points.iter().rev().copied()));
    out
}

/// The part of a leg's guide that the workspace asks for, a little longer.
fn guide(machine: &Shape, i: usize) -> Option<[Point; 2]> {
    let direction = match &machine.legs[i] {
        Numbers::Slider { direction, .. } | Numbers::Planar { direction } => *direction,
        Numbers::Strut { .. } | Numbers::Arm { .. } => return None,
    };
    let origin = machine.pose(i, machine.position)?.driven;
    let along = |p: Point| dot(direction, add(p, scaled(-1.0, origin)));
    let mut ends = [0.0, 0.0];
    for pose in machine.places.iter().filter_map(|p| machine.pose(i, *p)) {
        let rho = along(pose.driven);
        ends = [f64::min(ends[0], rho), f64::max(ends[1], rho)];
    }
    let more = 0.08 * (ends[1] - ends[0]);
    Some([ends[0] - more, ends[1] + more].map(|rho| add(origin, scaled(rho, direction))))
}

/// The fixed point of an arm.
fn anchor(machine: &Shape, i: usize) -> Option<Point> {
    match &machine.legs[i] {
        Numbers::Arm { anchor, .. } => Some(*anchor),
        _ => None,
    }
}

fn leg(layers: &mut Layers, machine: &Shape, i: usize, guide: Option<[Point; 2]>, fitted: &Fitted) {
    if let Some(ends) = guide {
        let [a, b] = ends.map(|p| fitted.at(p));
        layers.line("guide", a, b);
    }
    let Some(pose) = machine.pose(i, machine.position) else {
        return;
    };
    let [driven, platform] = [pose.driven, pose.platform].map(|p| fitted.at(p));
    if let Numbers::Arm { anchor, axis, arm, .. } = &machine.legs[i] {
        let reach = scaled(0.35 * arm, *axis);
        let ends = [*anchor, add(*anchor, reach), add(*anchor, scaled(-1.0, reach))];
        let [at, a, b] = ends.map(|p| fitted.at(p));
        layers.line("guide", a, b);
        layers.line("arm", at, driven);
        layers.dot("joint", at, 4.0);
    }
    layers.line("leg", driven, platform);
    match &machine.legs[i] {
        Numbers::Slider { .. } | Numbers::Planar { .. } => {
            let [x, y] = driven;
            let (x, y) = (x - 6.0, y - 6.0);
            layers.lines.raw(&format!(
                "<rect class=\"carriage\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"12\" height=\"12\"/>"
            ));
            layers.taken.names.push(about(driven, [6.0; 2]));
        }
        _ => layers.dot("joint", driven, 4.0),
    }
    layers.dot("joint", platform, 3.5);
    let along = [0.45, 0.3, 0.6, 0.2, 0.75]
        .map(|t| [0, 1].map(|k| driven[k] + t * (platform[k] - driven[k])));
    let places = along.iter().flat_map(|at| beside(*at, 7.0)).collect();
    layers.name("label leg-label", format!("leg {}", i + 1), places);
}

/// Names of the driven joints, and of the fixed points of arms; of several at one place, on a line.
fn joints(layers: &mut Layers, machine: &Shape, fitted: &Fitted) {
    let mut all: Vec<(String, [f64; 2])> = Vec::new();
    for i in 0..machine.legs.len() {
        let Some(pose) = machine.pose(i, machine.position) else { continue };
        for (letter, p) in [('A', anchor(machine, i)), ('B', Some(pose.driven))] {
            let Some(at) = p.map(|p| fitted.at(p)) else { continue };
            let name = format!("{letter}{}", subscript(&(i + 1).to_string()));
            let is_there = |known: &[f64; 2]| (known[0] - at[0]).hypot(known[1] - at[1]) < 1.0;
            match all.iter_mut().find(|(_, known)| is_there(known)) {
                Some((names, _)) => names.push_str(&format!(", {name}")),
                None => all.push((name, at)),
            }
        }
    }
    for (names, at) in all {
        layers.name("label", names, beside(at, 9.0).into());
    }
}

/// The platform between its joints, where they are apart, and `P`.
fn platform_body(layers: &mut Layers, machine: &Shape, fitted: &Fitted) {
    let p = machine.position;
    let at = fitted.at(p);
    let joints = machine.legs.iter().map(|leg| fitted.at(machine.carried(p, leg.platform())));
    let shown = hull(joints.collect());
    if shown.iter().any(|q| (q[0] - at[0]).hypot(q[1] - at[1]) > 5.0) {
        layers.lines.path("platform", &shown, true);
    }
    layers.dot("point", at, 4.0);
    let mut places = beside(at, 9.0);
    places.swap(0, 1);
    layers.name("label", "P".to_owned(), places.into());
}

/// The directions of the frame, in a corner of the picture.
fn axes(out: &mut Elements, view: &View, count: usize) {
    const ORIGIN: [f64; 2] = [64.0, SIZE[1] - 64.0];
    for (k, name) in ["x", "y", "z"].into_iter().enumerate().take(count) {
        let mut unit = [0.0; 3];
        unit[k] = 1.0;
        let seen = view.seen(unit);
        let at = |length: f64| [ORIGIN[0] + length * seen[0], ORIGIN[1] + length * seen[1]];
        out.line("axis-line", ORIGIN, at(40.0));
        let norm = seen[0].hypot(seen[1]).max(0.3);
        let [x, y] = at(40.0 + 11.0 / norm);
        out.text("axis middle", [x, y + 4.0], name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_has_the_corners_and_nothing_inside() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let mut points = square.to_vec();
        points.extend([[1.0, 1.0], [0.5, 1.5], [1.0, 0.0]]);
        let mut found = hull(points);
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(found, [[0.0, 0.0], [0.0, 2.0], [2.0, 0.0], [2.0, 2.0]]);
    }
}
