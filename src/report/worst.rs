//! The worst values found of every requirement, as rows of a table.

use super::place::FreeParameter;
use serde::Serialize;

/// A requirement, its bound, and the worst value that sampling has found of it: not a proof.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The requirement's name.
    pub requirement: String,
    /// The same of all legs together, where it is one leg's.
    #[serde(skip)]
    pub of_all: Option<String>,
    /// The margin of the value found, relative; negative where it is violated.
    #[serde(skip)]
    pub margin: f64,
    /// The unit of the bound and of the value, where they have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// `<=`, `>=` or another relation to the bound.
    #[serde(skip)]
    pub relation: &'static str,
    /// The bound, for people.
    #[serde(skip)]
    pub bound_text: String,
    /// The bound, exact: a relation and a number.
    pub bound: String,
    /// The worst value found; `None` where some leg does not reach the point.
    pub worst_found: Option<f64>,
    /// Where it was found, in the design's unit.
    pub at: Vec<f64>,
    /// The machine for which it was found: parameters with a tolerance.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<FreeParameter>,
    /// Whether the value found is on the wrong side of the bound.
    pub seems_violated: bool,
}

impl Row {
    /// Whether its value is worse than another's of the same bound. Margins of two tests need not be of one scale.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        match (self.relation, self.worst_found, other.worst_found) {
            ("<=", Some(own), Some(other)) if own != other => own > other,
            (">=", Some(own), Some(other)) if own != other => own < other,
            _ => self.margin < other.margin,
        }
    }
}
