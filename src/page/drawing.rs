//! The machine and its workspace, in a parallel view: what the claim is about.

use super::isomap::Mark;
use super::nominal::{add, scaled, Nominal, Numbers, Point};
use super::svg::{Elements, Fitted, Picture, View};

const SIZE: [f64; 2] = [720.0, 470.0];
/// Corners of the polygon that stands for a circle.
const ROUND: usize = 72;

/// The drawing. The platform is at the origin if that is in the workspace, else in its middle.
pub fn drawing(machine: &Nominal, marks: &[Mark]) -> Picture {
    let p = platform(machine);
    let view = View::from(58.0, 24.0);
    let guides: Vec<Option<[Point; 2]>> = (0..3).map(|i| guide(machine, i)).collect();
    let solid = solid(machine);
    let mut extent: Vec<Point> = solid.iter().flatten().copied().collect();
    extent.extend(guides.iter().flatten().flatten());
    for i in 0..3 {
        extent.extend(machine.pose(i, p).iter().flat_map(|pose| [pose.driven, pose.platform]));
        extent.extend(anchor(machine, i));
    }
    extent.extend(marks.iter().map(|mark| mark.at));
    let fitted = Fitted::new(view, &extent, [46.0, 34.0], [SIZE[0] - 92.0, SIZE[1] - 68.0]);
    let mut out = Elements::default();
    workspace(&mut out, machine, &solid, &view, &fitted);
    axes(&mut out, &view);
    // Names last, so that nothing is drawn over them.
    let mut names = Elements::default();
    for (i, guide) in guides.iter().enumerate() {
        leg((&mut out, &mut names), machine, i, p, *guide, &fitted);
    }
    platform_body((&mut out, &mut names), machine, p, &fitted);
    out.raw(&names.0);
    for mark in marks {
        let at = fitted.at(mark.at);
        out.dot("mark", at, 4.5);
        out.text("mark-label start", [at[0] + 8.0, at[1] - 7.0], &mark.name);
    }
    Picture {
        name: "design".to_owned(),
        title: "The nominal machine: guides, legs, platform and workspace".to_owned(),
        size: SIZE,
        attributes: String::new(),
        content: out.0,
    }
}

/// Where the platform is drawn.
pub fn platform(machine: &Nominal) -> Point {
    let frame = &machine.frame;
    let inside = |k: usize| frame.least[k] <= 0.0 && 0.0 <= frame.least[k] + frame.width[k];
    if machine.is_cube && (0..3).all(inside) {
        return [0.0; 3];
    }
    machine.point([0.5; 3])
}

/// The outline of the workspace: lines that bound it from below, from above, and beside.
fn solid(machine: &Nominal) -> [Vec<Point>; 2] {
    let ring = |z: f64| -> Vec<Point> {
        if machine.is_cylinder {
            return (0..ROUND)
                .map(|i| {
                    let (s, c) = (i as f64 / ROUND as f64 * std::f64::consts::TAU).sin_cos();
                    machine.point([0.5 + c / 2.0, 0.5 + s / 2.0, z])
                })
                .collect();
        }
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[x, y]| machine.point([x, y, z]))
            .to_vec()
    };
    [ring(0.0), ring(1.0)]
}

fn workspace(
    out: &mut Elements,
    machine: &Nominal,
    [below, above]: &[Vec<Point>; 2],
    view: &View,
    fitted: &Fitted,
) {
    let shown = |ring: &[Point]| -> Vec<[f64; 2]> { ring.iter().map(|p| fitted.at(*p)).collect() };
    out.path("solid", &hull([shown(below), shown(above)].concat()), true);
    if machine.is_cylinder {
        out.path("hidden", &shown(below), true);
        out.path("edge", &shown(above), true);
        out.path("edge outline-only", &hull([shown(below), shown(above)].concat()), true);
        return;
    }
    // The corner farthest from the viewer, and the three edges that meet there.
    let far: [f64; 3] = view.toward.map(|d| if d > 0.0 { 0.0 } else { 1.0 });
    for a in 0..8u8 {
        for k in 0..3 {
            if a >> k & 1 == 1 {
                continue;
            }
            let from: Point = std::array::from_fn(|j| f64::from(a >> j & 1));
            let mut to = from;
            to[k] = 1.0;
            let hidden = (0..3).all(|j| j == k || from[j] == far[j]);
            let class = if hidden { "hidden" } else { "edge" };
            out.line(class, fitted.at(machine.point(from)), fitted.at(machine.point(to)));
        }
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
fn guide(machine: &Nominal, i: usize) -> Option<[Point; 2]> {
    let direction = match &machine.legs[i].numbers {
        Numbers::Slider { direction, .. } | Numbers::Planar { direction } => *direction,
        Numbers::Strut { .. } | Numbers::Arm { .. } => return None,
    };
    let origin = machine.pose(i, platform(machine))?.driven;
    let along = |p: Point| super::nominal::dot(direction, add(p, scaled(-1.0, origin)));
    let mut ends = [0.0, 0.0];
    for n in 0..27 {
        let u = [n % 3, n / 3 % 3, n / 9].map(|i| f64::from(i) / 2.0);
        if let Some(pose) = machine.pose(i, machine.point(u)) {
            let rho = along(pose.driven);
            ends = [f64::min(ends[0], rho), f64::max(ends[1], rho)];
        }
    }
    let more = 0.08 * (ends[1] - ends[0]);
    Some([ends[0] - more, ends[1] + more].map(|rho| add(origin, scaled(rho, direction))))
}

/// The fixed point of an arm.
fn anchor(machine: &Nominal, i: usize) -> Option<Point> {
    match &machine.legs[i].numbers {
        Numbers::Arm { anchor, .. } => Some(*anchor),
        _ => None,
    }
}

fn leg(
    (out, names): (&mut Elements, &mut Elements),
    machine: &Nominal,
    i: usize,
    p: Point,
    guide: Option<[Point; 2]>,
    fitted: &Fitted,
) {
    if let Some(ends) = guide {
        let [a, b] = ends.map(|p| fitted.at(p));
        out.line("guide", a, b);
    }
    let Some(pose) = machine.pose(i, p) else {
        return;
    };
    let [driven, platform] = [pose.driven, pose.platform].map(|p| fitted.at(p));
    if let Numbers::Arm { anchor, axis, arm, .. } = &machine.legs[i].numbers {
        let reach = scaled(0.35 * arm, *axis);
        let [a, b] = [add(*anchor, reach), add(*anchor, scaled(-1.0, reach))].map(|p| fitted.at(p));
        out.line("guide", a, b);
        out.line("arm", fitted.at(*anchor), driven);
        out.dot("joint", fitted.at(*anchor), 4.0);
        let at = fitted.at(*anchor);
        names.text("label end", [at[0] - 8.0, at[1] - 8.0], &format!("A{}", subscript(i)));
    }
    out.line("leg", driven, platform);
    match &machine.legs[i].numbers {
        Numbers::Slider { .. } | Numbers::Planar { .. } => {
            let [x, y] = driven;
            let (x, y) = (x - 6.0, y - 6.0);
            out.raw(&format!(
                "<rect class=\"carriage\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"12\" height=\"12\"/>"
            ));
        }
        _ => out.dot("joint", driven, 4.0),
    }
    out.dot("joint", platform, 3.5);
    let middle = [0, 1].map(|k| driven[k] + 0.45 * (platform[k] - driven[k]));
    names.text(
        "label leg-label start",
        [middle[0] + 7.0, middle[1] - 5.0],
        &format!("leg {}", i + 1),
    );
    names.text("label start", [driven[0] + 10.0, driven[1] - 8.0], &format!("B{}", subscript(i)));
}

fn subscript(i: usize) -> char {
    ['\u{2081}', '\u{2082}', '\u{2083}'][i]
}

/// The platform's triangle, where its joints are apart, and `P`.
fn platform_body(
    (out, names): (&mut Elements, &mut Elements),
    machine: &Nominal,
    p: Point,
    fitted: &Fitted,
) {
    let joints: Option<Vec<Point>> =
        (0..3).map(|i| machine.pose(i, p).map(|pose| pose.platform)).collect();
    let at = fitted.at(p);
    if let Some(joints) = joints {
        let shown: Vec<[f64; 2]> = joints.iter().map(|p| fitted.at(*p)).collect();
        if shown.iter().any(|q| (q[0] - at[0]).hypot(q[1] - at[1]) > 5.0) {
            out.path("platform", &shown, true);
        }
    }
    out.dot("point", at, 4.0);
    names.text("label start", [at[0] + 9.0, at[1] + 16.0], "P");
}

/// The directions of the frame, in a corner of the picture.
fn axes(out: &mut Elements, view: &View) {
    const ORIGIN: [f64; 2] = [64.0, SIZE[1] - 64.0];
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
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
