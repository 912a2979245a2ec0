//! A refutation's witness in words, with certified digits of the value that violates the claim.

use crate::exact::decimal::readable;
use crate::exact::Exact;
use crate::report::place::point_text;
use serde::Serialize;
use std::fmt;

/// Digits of the places of bodies.
const PLACE_DIGITS: u32 = 6;

/// The point, the machine and the requirement that is provably violated there.
#[derive(Clone, Debug, Serialize)]
pub struct Counterexample {
    /// The rule that is broken ([`crate::report::requirement`]).
    #[serde(skip)]
    pub rule: &'static str,
    /// What is violated: `greatest psi <= 2`.
    pub violated: String,
    /// What ends there, in a few words: the requirement, and what it is where it is none of psi and its like.
    #[serde(skip)]
    pub limit: String,
    /// The value there, with certified digits: `greatest psi >= 2.0050`.
    pub value: String,
    /// `P`, exact.
    pub point: Vec<Exact>,
    /// `P` of a platform that turns, its angles in degrees, rounded.
    #[serde(skip)]
    pub pose: Option<String>,
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_point: Option<Vec<Exact>>,
    /// The parameters with a tolerance, exact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<Setting>,
    /// Of two bodies that are too near, both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Near>,
    /// The direction of motion that is transmitted too fast or too slowly, or both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<i64>>,
}

impl Counterexample {
    /// Where, in short.
    pub fn at(&self) -> String {
        let point: Vec<String> = self.point.iter().map(readable).collect();
        self.pose.clone().unwrap_or_else(|| format!("({})", point.join(", ")))
    }
}

/// One of two bodies that are too near.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Near {
    /// What it is: `a rod of leg 2`.
    pub body: String,
    /// Nearly the point of its axis that is nearest to the other; none of two rods along one leg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
}

impl fmt::Display for Near {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.body)?;
        match &self.point {
            Some(point) => write!(f, ", about at {}", point_text(point, PLACE_DIGITS)),
            None => Ok(()),
        }
    }
}

/// The value that a witness gives to a parameter with a tolerance.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// The leg, counted from one; none of a mechanism that its user gives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// The parameter's name.
    pub parameter: String,
    /// Its value, exact.
    pub value: Exact,
}
