//! Places of the workspace in the design's own units, and the parameters that a tolerance leaves
//! free.

use crate::exact::decimal::significant;
use serde::Serialize;

/// Significant digits of an axis.
const AXIS_DIGITS: u32 = 4;

/// A point as `(x, y, ..)` in so many significant digits.
pub fn point_text(point: &[f64], digits: u32) -> String {
    let all: Vec<String> = point.iter().map(|x| significant(*x, digits)).collect();
    format!("({})", all.join(", "))
}

/// A pose as `(x, y, z) = (1, 2, 3), turned by 15 deg about (0, 0, 1)`: angles in degrees, from the half-angle
/// tangents of coordinates named `tan(../2)` and `c_x`, `c_y`, `c_z`.
pub fn pose_text(point: &[f64], coordinates: &[String], digits: u32) -> String {
    let names: Vec<&str> = positions(coordinates).collect();
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

/// The names of the coordinates that are lengths, or a user's own.
pub fn positions(coordinates: &[String]) -> impl Iterator<Item = &str> {
    let is_turn = |name: &&str| name.starts_with("tan(") || name.starts_with("c_");
    coordinates.iter().map(String::as_str).filter(move |name| !is_turn(name))
}

/// How a pose is turned, in degrees; none where no coordinate says so.
pub fn turn_text(point: &[f64], coordinates: &[String], digits: u32) -> Option<String> {
    let number = |x: f64| significant(x, digits);
    let of = |start: &'static str| {
        coordinates.iter().zip(point).filter(move |(name, _)| name.starts_with(start))
    };
    let angles = of("tan(").map(|(name, x)| {
        let angle = name.trim_start_matches("tan(").trim_end_matches("/2)");
        format!("{angle} = {} deg", number(2.0 * x.atan().to_degrees()))
    });
    let mut parts: Vec<String> = angles.collect();
    let axis: Vec<f64> = of("c_").map(|(_, x)| *x).collect();
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 {
        let unit: Vec<f64> = axis.iter().map(|x| x / length).collect();
        let angle = number(2.0 * length.atan().to_degrees());
        parts.push(format!("turned by {angle} deg about {}", point_text(&unit, AXIS_DIGITS)));
    } else if !axis.is_empty() {
        parts.push("not turned".to_owned());
    }
    (!parts.is_empty()).then(|| parts.join(", "))
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
