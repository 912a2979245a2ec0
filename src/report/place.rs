//! Places of the workspace in the design's own units, and the parameters that a tolerance leaves
//! free.

use crate::decimal::{approximate, significant};
use crate::sample::Place;
use orthocert_checker::claim::{Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_checker::model::{CubeConstants, Model};
use serde::Serialize;
use std::array::from_fn;

/// How finely places are searched, as a part of the workspace.
const RESOLUTION: f64 = 1e-7;

/// The workspace's bounding box and the model's unit of length, in the design's unit: approximate,
/// to show where something is.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The least corner.
    pub least: [f64; 3],
    /// The edges.
    pub width: [f64; 3],
    /// The model's unit of length.
    pub unit: f64,
}

impl Frame {
    /// The frame of a claim; `None` where its numbers exceed what doubles can show.
    pub fn new<S>(claim: &MachineClaim, model: &Model<S>) -> Option<Self> {
        if let Some(scale) = model.unit_exponent {
            let (min, max) = claim.workspace.bounding_box().ok()?;
            let end = |x: &[_; 3]| -> Option<[f64; 3]> {
                Some([approximate(&x[0])?, approximate(&x[1])?, approximate(&x[2])?])
            };
            let (min, max) = (end(&min)?, end(&max)?);
            let unit = (scale as f64).exp2();
            return Some(Frame { least: min, width: from_fn(|k| max[k] - min[k]), unit });
        }
        let Workspace::Cube { side } = &claim.workspace else {
            return None;
        };
        let psi_max = claim.requirements.transmission.as_ref()?.max.as_ref()?;
        let cube = CubeConstants::new(psi_max, side).ok()?;
        let unit = approximate(&cube.inverse_length)?.recip();
        let least = approximate(&cube.q1)? * unit;
        Some(Frame { least: [least; 3], width: [approximate(side)?; 3], unit })
    }

    /// `P` for parts `u` of the workspace.
    pub fn point(&self, u: &[f64; 3]) -> [f64; 3] {
        from_fn(|k| self.least[k] + self.width[k] * u[k])
    }

    /// `P` for parts `u` that a search has found: what it has not told from zero is zero.
    pub fn place(&self, u: &[f64; 3]) -> [f64; 3] {
        let point = self.point(u);
        from_fn(|k| if point[k].abs() < RESOLUTION * self.width[k] { 0.0 } else { point[k] })
    }

    /// The volume of the bounding box.
    pub fn volume(&self) -> f64 {
        self.width.iter().product()
    }
}

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

/// The parameters of a claim's machine that have a tolerance, in the order of [`Place::t`].
pub fn toleranced(claim: &MachineClaim) -> Vec<(usize, String, Quantity)> {
    let mut all = Vec::new();
    if let Mechanism::Translational(legs) = &claim.mechanism {
        for (i, leg) in legs.iter().enumerate() {
            let free = named_parameters(leg).into_iter().filter(|(_, q)| !q.is_exact());
            all.extend(free.map(|(name, q)| (i + 1, name, q)));
        }
    }
    all
}

/// A leg's parameters by name; components of vectors carry their axis.
pub fn named_parameters(leg: &Leg) -> Vec<(String, Quantity)> {
    let parameters = leg.parameters();
    let mut seen = Vec::new();
    let mut named = Vec::with_capacity(parameters.len());
    for (parameter, quantity) in &parameters {
        let component = seen.iter().filter(|p| *p == parameter).count();
        let components = parameters.iter().filter(|(p, _)| p == parameter).count();
        let name = match ["x", "y", "z"].get(component) {
            Some(axis) if components == 3 => format!("{parameter} {axis}"),
            _ => parameter.to_string(),
        };
        seen.push(*parameter);
        named.push((name, (*quantity).clone()));
    }
    named
}

/// The machine at a place: the values of the parameters that have a tolerance.
pub fn machine_at(claim: &MachineClaim, place: &Place) -> Vec<FreeParameter> {
    let value = |q: &Quantity, part: f64| {
        let (min, max) = (approximate(&q.min)?, approximate(&q.max)?);
        Some(min + part * (max - min))
    };
    toleranced(claim)
        .into_iter()
        .zip(&place.t)
        .filter_map(|((leg, parameter, q), &part)| {
            Some(FreeParameter { leg: Some(leg), parameter, value: value(&q, part)? })
        })
        .collect()
}
