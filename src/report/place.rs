//! Places of the workspace in the design's own units, and the parameters that a tolerance leaves
//! free.

use crate::exact::decimal::significant;
use crate::search::solver::value::Coordinates;
use serde::Serialize;

/// Significant digits of an axis.
const AXIS_DIGITS: u32 = 4;

/// A point as `(x, y, ..)` in so many significant digits.
pub fn point_text(point: &[f64], digits: u32) -> String {
    let all: Vec<String> = point.iter().map(|x| significant(*x, digits)).collect();
    format!("({})", all.join(", "))
}

/// A pose as `(x, y, z) = (1, 2, 3), turned by 15 deg about (0, 0, 1)`: angles in degrees, from the half-angle
/// tangents of the coordinates of orientation.
pub fn pose_text(point: &[f64], coordinates: &Coordinates, digits: u32) -> String {
    let names = coordinates.positions();
    let mut parts = match names.is_empty() {
        true => Vec::new(),
        false => {
            let at = point.get(..names.len()).unwrap_or(point);
            vec![format!("({}) = {}", names.join(", "), point_text(at, digits))]
        }
    };
    parts.extend(turn_text(point, coordinates, digits));
    parts.join(", ")
}

/// A place in a sentence: `at (1, 2, 3)`, `turned by 15 deg about (0, 0, 1)`.
pub fn placed(place: &str) -> String {
    let at = if place.starts_with('(') { "at " } else { "" };
    format!("{at}{place}")
}

/// The angle whose half-angle tangent a coordinate is.
pub fn angle_of(name: &str) -> Option<&str> {
    name.strip_prefix("tan(")?.strip_suffix("/2)")
}

/// The angle with this half-angle tangent.
pub fn in_degrees(half_angle_tangent: f64) -> f64 {
    2.0 * half_angle_tangent.atan().to_degrees()
}

/// How a pose is turned, in degrees; none where no coordinate says so.
pub fn turn_text(point: &[f64], coordinates: &Coordinates, digits: u32) -> Option<String> {
    let number = |x: f64| significant(x, digits);
    let turns = point.get(coordinates.positions().len()..).unwrap_or_default();
    let angles = coordinates.turns().iter().zip(turns).filter_map(|(name, x)| {
        Some(format!("{} = {} deg", angle_of(name)?, number(in_degrees(*x))))
    });
    let mut parts: Vec<String> = angles.collect();
    let axis = if coordinates.are_of_axis() { turns } else { &[] };
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if let ([x, y, z], true) = (axis, coordinates.by_tilt) {
        parts.push(tilt_text([*x, *y, *z], digits));
    } else if length > 0.0 {
        let unit: Vec<f64> = axis.iter().map(|x| x / length).collect();
        let angle = number(in_degrees(length));
        parts.push(format!("turned by {angle} deg about {}", point_text(&unit, AXIS_DIGITS)));
    } else if !axis.is_empty() {
        parts.push("not turned".to_owned());
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// The tilt, where it leans, and the torsion of a rotation by `theta` about an axis, `c = tan(theta/2) axis`.
///
/// `R_z(a) R_y(b) R_z(s - a)` is the torsion `s` about z, then a turn by `b` about `(-sin a, cos a, 0)`: the
/// product of `cos(s/2) + sin(s/2) k` and `cos(b/2) + sin(b/2) (-sin a, cos a, 0)` has the components
/// `cos(b/2) (cos(s/2), sin(s/2))` along one and `k`, hence `c_z = tan(s/2)`, and across them
/// `sin(b/2) (-sin(a - s/2), cos(a - s/2))`.
fn tilt_text([x, y, z]: [f64; 3], digits: u32) -> String {
    let degrees = |x: f64| significant(x.to_degrees(), digits);
    let half = z.atan();
    let tilt = 2.0 * (x.hypot(y) / z.hypot(1.0)).atan();
    let toward = match tilt > 0.0 {
        true => format!(" toward {} deg from x", degrees((-x).atan2(y) + half)),
        false => String::new(),
    };
    format!("tilt {} deg{toward}, torsion {} deg", degrees(tilt), degrees(2.0 * half))
}

/// A parameter of a machine that has a tolerance, and its value at some place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FreeParameter {
    /// The leg, counted from one; none of a mechanism that its user gives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// Its name: `length`, `anchor x`, ...
    pub parameter: String,
    /// Its value.
    pub value: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, UnitQuaternion, Vector3};

    #[test]
    fn tilt_and_torsion_are_those_of_the_rotation() {
        for (a, b, s) in
            [(40.0, 25.0, 10.0), (-100.0, 60.0, -20.0), (150.0, 5.0, 0.0), (0.0, 0.0, 7.0)]
        {
            let about =
                |axis: Vector3<f64>, angle: f64| Rotation3::new(axis * f64::to_radians(angle));
            let (y, z) = (Vector3::y(), Vector3::z());
            let rotation = about(z, a) * about(y, b) * about(z, s - a);
            let q = UnitQuaternion::from_rotation_matrix(&rotation);
            let toward = if b > 0.0 { format!(" toward {a} deg from x") } else { String::new() };
            let c = [q.i / q.w, q.j / q.w, q.k / q.w];
            assert_eq!(tilt_text(c, 6), format!("tilt {b} deg{toward}, torsion {s} deg"));
        }
    }
}
