//! The machine of a kernel claim as it is drawn: in the middle of its workspace and tolerances.

use super::legs::{across, unit, Numbers, Outline, Point, Shape};
use crate::search::solver::approximate;
use orthocert_kernel::claim::{
    Body, Leg, MachineClaim, Mechanism, Orientation, Quantity, Sign, Workspace,
};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::prover::written_out;
use std::array::from_fn;

/// Lengths beyond this are not drawn: their powers would exceed the doubles.
const GREATEST: f64 = 1e60;

/// The nominal machine in the middle of its workspace, or of the paper's cube at the origin; none of users' formulas, which say nothing of
/// where a leg is, and of numbers beyond what doubles can show.
pub fn shape(claim: &MachineClaim) -> Option<Shape> {
    let (least, width) = frame(claim)?;
    if let Mechanism::Formulas(_) = claim.mechanism {
        return None;
    }
    let written = written_out(claim).ok()?;
    let legs = written.mechanism.legs().iter().map(numbers).collect::<Option<_>>()?;
    let is_flat = matches!(claim.mechanism, Mechanism::Planar(_));
    let is_cube = matches!(claim.workspace, Workspace::Cube { .. });
    let is_round = matches!(claim.workspace, Workspace::Cylinder { .. });
    let mut outline = Outline::of(least, width, is_round);
    let turns_alone = matches!(claim.mechanism, Mechanism::Spherical(_));
    outline.rings.truncate(if turns_alone {
        0
    } else if is_flat {
        1
    } else {
        2
    });
    let grid = |n: u32| [n % 3, n / 3 % 3, n / 9].map(|i| f64::from(i) / 2.0);
    let place = |u: Point| -> Point { from_fn(|k| least[k] + u[k] * width[k]) };
    let ends = |from: &[Expression; 3], to: &[Expression; 3]| Some([point(from)?, point(to)?]);
    let mut bodies = [Vec::new(), Vec::new()];
    for body in &claim.bodies {
        match body {
            Body::Leg { .. } => {}
            Body::Base { from, to, .. } => bodies[0].extend(ends(from, to)),
            Body::Platform { from, to, .. } => bodies[1].extend(ends(from, to)),
        }
    }
    let shape = Shape {
        legs,
        position: if is_cube { [0.0; 3] } else { place([0.5; 3]) },
        rotation: rotation(claim.orientation.as_ref())?,
        outline,
        places: (0..27).map(|n| place(grid(n))).collect(),
        bodies,
        is_flat,
    };
    let poses = (0..shape.legs.len()).filter_map(|i| shape.pose(i, shape.position));
    let points = poses.flat_map(|pose| [pose.driven, pose.platform]).chain(shape.places.clone());
    let is_shown = points.flatten().all(|x| x.abs() < GREATEST);
    is_shown.then_some(shape)
}

/// The least corner and the edges of the box of positions; of less than three coordinates, with
/// zeros.
pub fn frame(claim: &MachineClaim) -> Option<(Point, Point)> {
    let (min, max) = match &claim.workspace {
        Workspace::Box { min, max } => (all(min)?, all(max)?),
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            let (x, y, r) = (approximate(x)?, approximate(y)?, approximate(radius)?);
            (vec![x - r, y - r, approximate(low)?], vec![x + r, y + r, approximate(high)?])
        }
        Workspace::Cube { side } => {
            let q1 = least_of_cube(claim)?;
            (vec![q1; 3], vec![q1 + approximate(side)?; 3])
        }
    };
    let coordinate = |all: &[f64], k: usize| all.get(k).copied().unwrap_or(0.0);
    let least: Point = from_fn(|k| coordinate(&min, k));
    Some((least, from_fn(|k| coordinate(&max, k) - least[k])))
}

/// `q_1 = a + e + L` of the paper's cube, from its legs.
fn least_of_cube(claim: &MachineClaim) -> Option<f64> {
    let Mechanism::Orthoglide { offset } = &claim.mechanism else { return None };
    let written = written_out(claim).ok()?;
    let Leg::Slider { anchor, length: Quantity::Exactly(length), .. } =
        written.mechanism.legs().first()?
    else {
        return None;
    };
    let Quantity::Exactly(base) = anchor.first()? else { return None };
    let add = |x: Expression, y: &Expression| {
        Expression::Binary(Operator::Add, x.into(), y.clone().into())
    };
    approximate(&add(add(base.clone(), offset), length))
}

/// The rows of `R` in the middle of a set of orientations.
fn rotation(orientation: Option<&Orientation>) -> Option<[Point; 3]> {
    let middle = |[min, max]: &[Expression; 2]| {
        let degrees = (approximate(min)? + approximate(max)?) / 2.0;
        Some(degrees.to_radians().sin_cos())
    };
    let still = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    match orientation {
        None | Some(Orientation::Angle(_) | Orientation::Tilt { .. }) => Some(still),
        Some(Orientation::Range(range)) => {
            let (s, c) = middle(range)?;
            Some([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        }
        Some(Orientation::RollPitchYaw { roll, pitch, yaw }) => {
            let ((sr, cr), (sp, cp), (sy, cy)) = (middle(roll)?, middle(pitch)?, middle(yaw)?);
            Some([
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ])
        }
    }
}

/// Numbers of a claim as doubles.
pub fn all(numbers: &[Expression]) -> Option<Vec<f64>> {
    numbers.iter().map(approximate).collect()
}

fn point(numbers: &[Expression; 3]) -> Option<Point> {
    let [x, y, z] = numbers;
    Some([approximate(x)?, approximate(y)?, approximate(z)?])
}

/// A leg with every quantity in the middle of its tolerance; in the plane with `z = 0`, and motors
/// about `+z` whose arms at angle 0 lie along x where nothing else is said.
fn numbers(leg: &Leg) -> Option<Numbers> {
    let middle = |q: &Quantity| {
        let [min, max] = q.ends();
        let (min, max) = (approximate(min)?, approximate(max)?);
        Some(min + (max - min) / 2.0)
    };
    let vector = |q: &[Quantity], absent: Point| -> Option<Point> {
        if q.is_empty() {
            return Some(absent);
        }
        let all: Vec<f64> = q.iter().map(middle).collect::<Option<_>>()?;
        Some(from_fn(|k| all.get(k).copied().unwrap_or(0.0)))
    };
    let sign = |mode: &Sign| mode.as_integer() as f64;
    let zero = [0.0; 3];
    Some(match leg {
        Leg::Slider { direction, anchor, platform, length, mode } => Numbers::Slider {
            direction: unit(vector(direction, zero)?)?,
            anchor: vector(anchor, zero)?,
            platform: vector(platform, zero)?,
            length: middle(length)?,
            mode: sign(mode),
        },
        Leg::Strut { anchor, platform, .. } => {
            Numbers::Strut { anchor: vector(anchor, zero)?, platform: vector(platform, zero)? }
        }
        Leg::Arm { axis, reference, anchor, platform, arm, length, mode } => {
            let axis = unit(vector(axis, [0.0, 0.0, 1.0])?)?;
            Numbers::Arm {
                axis,
                reference: across(vector(reference, [1.0, 0.0, 0.0])?, axis)?,
                anchor: vector(anchor, zero)?,
                platform: vector(platform, zero)?,
                arm: middle(arm)?,
                length: middle(length)?,
                mode: sign(mode),
            }
        }
        Leg::Planar { direction } => Numbers::Planar { direction: unit(vector(direction, zero)?)? },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::page::drawing::drawing;
    use crate::report::page::general::{names, scene};
    use crate::report::page::legs::{add, scaled};
    use orthocert_kernel::certificate as kernel;

    fn claim(mechanism: &str, workspace: &str, orientation: &str) -> MachineClaim {
        let text = format!(
            r#"{{"mechanism":{mechanism},"workspace":{{"box":{workspace}}},{orientation}"require":[]}}"#
        );
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"))
    }

    fn strut(anchor: &str, platform: &str) -> String {
        format!(r#"{{"drive":"strut","anchor":[{anchor}],"platform":[{platform}]}}"#)
    }

    fn length(shape: &Shape, leg: usize) -> f64 {
        let pose = shape.pose(leg, shape.position).unwrap();
        let d = add(pose.platform, scaled(-1.0, pose.driven));
        crate::report::page::legs::dot(d, d).sqrt()
    }

    fn drawn(shape: &Shape) -> String {
        let picture = drawing(shape, &[]);
        assert!(!picture.content.contains("NaN") && !picture.content.contains("inf"));
        picture.content
    }

    #[test]
    fn machines_in_the_plane_are_seen_from_above() {
        let legs = [
            strut(r#""0","0""#, r#""-1","0""#),
            r#"{"drive":"arm","axis":[],"reference":[],"anchor":["6","0"],"platform":["1","0"],"arm":"3","length":"4","mode":"+"}"#
                .to_owned(),
            r#"{"drive":"slider","direction":["1","0"],"anchor":["0","7"],"platform":["0","1"],"length":"5","mode":"-"}"#
                .to_owned(),
        ];
        let legs = legs.join(",");
        let mechanism = format!(r#"{{"planar":{{"legs":[{legs}],"characteristic_length":"1"}}}}"#);
        let workspace = r#"{"min":["2","2"],"max":["4","4"]}"#;
        let turned = r#""orientation":{"range":["80","100"]},"#;
        let shape = shape(&claim(&mechanism, workspace, turned)).unwrap();
        assert_eq!(shape.position, [3.0, 3.0, 0.0]);
        // Turned by a right angle, (-1, 0) of the platform is at (0, -1) from P.
        let platform = shape.pose(0, shape.position).unwrap().platform;
        assert!((platform[0] - 3.0).abs() < 1e-12 && (platform[1] - 2.0).abs() < 1e-12);
        assert!((length(&shape, 1) - 4.0).abs() < 1e-12);
        assert!((length(&shape, 2) - 5.0).abs() < 1e-12);
        let content = drawn(&shape);
        assert_eq!(content.matches("class=\"leg\"").count(), 3);
        assert_eq!(content.matches("class=\"arm\"").count(), 1);
        assert!(content.contains("class=\"platform\"") && !content.contains(">z<"));
        // The names of the two coordinates and of the angle.
        assert_eq!(names(&claim(&mechanism, workspace, turned)), ["x", "y", "t"]);
    }

    #[test]
    fn hexapods_have_six_legs_and_their_platform_turned() {
        let joint = |i: usize, r: f64, z: &str| {
            let (s, c) = (i as f64 * std::f64::consts::FRAC_PI_3).sin_cos();
            format!(r#""{}","{}","{z}""#, (100.0 * r * c).round(), (100.0 * r * s).round())
        };
        let legs: Vec<String> =
            (0..6).map(|i| strut(&joint(i, 2.0, "0"), &joint(i, 1.0, "0"))).collect();
        let mechanism = format!(
            r#"{{"spatial":{{"legs":[{}],"characteristic_length":"100"}}}}"#,
            legs.join(",")
        );
        let workspace = r#"{"min":["-10","-10","300"],"max":["10","10","300"]}"#;
        let level = claim(&mechanism, workspace, r#""orientation":{"angle":"15"},"#);
        let of_level = shape(&level).unwrap();
        assert!((length(&of_level, 0) - 300f64.hypot(100.0)).abs() < 1e-9);
        let content = drawn(&of_level);
        assert_eq!(content.matches("class=\"leg\"").count(), 6);
        assert!(content.contains("B\u{2086}") && content.contains(">z<"));
        let yaw = r#""orientation":{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["-90","-90"],"yaw":["0","0"]}},"#;
        let turned = shape(&claim(&mechanism, workspace, yaw)).unwrap();
        // R_y(-90) carries x to z: R e_x = (cos p, 0, -sin p).
        let platform = turned.pose(0, turned.position).unwrap().platform;
        assert!((platform[2] - 400.0).abs() < 1e-9 && platform[0].abs() < 1e-9, "{platform:?}");
        // Nothing is sampled of what the kernel does not compile, and everything else is there.
        let scene = scene(
            &level,
            &kernel::Proof::Tree(kernel::Tree { precision: 52, chords: None, nodes: Vec::new() }),
            None,
        );
        assert_eq!(scene.trees[0].axes.len(), scene.trees[0].least.len());
    }

    #[test]
    fn a_platform_that_only_turns_has_no_workspace_of_positions() {
        let legs = [
            strut(r#""200","0","0""#, r#""100","0","50""#),
            strut(r#""-100","173","0""#, r#""-50","87","50""#),
            strut(r#""-100","-173","0""#, r#""-50","-87","50""#),
        ];
        let mechanism = format!(
            r#"{{"spherical":{{"legs":[{}],"characteristic_length":"100"}}}}"#,
            legs.join(",")
        );
        let orientation = r#""orientation":{"tilt":{"tilt":"20","torsion":"40"}},"#;
        let claim = claim(&mechanism, r#"{"min":[],"max":[]}"#, orientation);
        let shape = shape(&claim).unwrap();
        assert_eq!(shape.position, [0.0; 3]);
        let content = drawn(&shape);
        assert_eq!(content.matches("class=\"leg\"").count(), 3);
        assert!(!content.contains("class=\"solid\"") && content.contains("class=\"platform\""));
        assert!(
            super::super::mechanism::workspace(&claim).starts_with("tilted by at most 20\u{b0}")
        );
    }

    /// The paper's cube: `L = 310.58`, and the platform at the origin is where all legs are along the
    /// axes.
    #[test]
    fn the_legs_of_the_paper_follow_from_the_claim() {
        let text = r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
            "require":[{"quantity":"transmission","end":"max","bound":"2"}]}"#;
        let claim: MachineClaim = serde_json::from_str(text).unwrap();
        let (least, width) = frame(&claim).unwrap();
        assert!((least[1] + 73.2050807568877).abs() < 1e-9 && width == [200.0; 3]);
        let shape = shape(&claim).unwrap();
        assert!((length(&shape, 2) - 310.582854123025).abs() < 1e-9);
        assert_eq!(shape.position, [0.0; 3]);
    }
}
