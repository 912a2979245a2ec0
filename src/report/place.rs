//! Places of the workspace in the design's own units, and the parameters that a tolerance leaves
//! free.

use crate::decimal::significant;
use serde::Serialize;

/// A point as `(x, y, ..)` in so many significant digits.
pub fn point_text(point: &[f64], digits: u32) -> String {
    let all: Vec<String> = point.iter().map(|x| significant(*x, digits)).collect();
    format!("({})", all.join(", "))
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
