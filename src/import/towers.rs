//! Linear Deltas with three vertical towers, as most firmwares have them: tower `i` stands at
//! `radius_i (cos angle_i, sin angle_i)`, and its carriage is `sqrt(rod_i^2 - distance_i^2)` above
//! the platform.

use super::toml::{least, polar, quoted, slider, Number};
use crate::exact::decimal::terminating;
use crate::exact::Exact;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::cmp::Ordering;

/// A tower, its carriage and its rods.
pub(super) struct Tower {
    /// What the firmware calls it.
    pub label: &'static str,
    /// Where it stands, in degrees about z.
    pub degrees: Number,
    /// How far from z, less the platform's own radius.
    pub radius: Number,
    /// Length of its rods.
    pub rod: Number,
}

/// What a firmware calls its towers, and where they stand but for corrections.
pub(super) const TOWERS: [(&str, &str); 3] =
    [("front left", "210"), ("front right", "330"), ("back", "90")];

impl Tower {
    /// The leg's table; `None` if a length is not positive or an angle is beyond a turn.
    pub fn leg(&self) -> Option<String> {
        let foot = polar(&self.degrees, Some(&self.radius).filter(|r| r.is_positive()))?;
        let rod = Some(&self.rod).filter(|rod| rod.is_positive())?;
        let label = format!("{}, at {} degrees", self.label, self.degrees.text);
        self.radius.is_positive().then(|| slider(&label, &foot, "0", &quoted(&rod.text)))
    }

    /// The carriage's height above a platform that is over the centre, as an expression.
    pub fn centred(&self) -> String {
        let (rod, radius) = (&self.rod.text, &self.radius.text);
        format!("sqrt({rod}*{rod}-{radius}*{radius})")
    }
}

/// The legs' tables; `None` unless each tower is nearer than its rods are long.
pub(super) fn legs(towers: &[Tower]) -> Option<[String; 3]> {
    let leg = |tower: &Tower| {
        let short = tower.radius.value.compare(&tower.rod.value) == Some(Ordering::Less);
        tower.leg().filter(|_| short)
    };
    towers.iter().map(leg).collect::<Option<Vec<_>>>()?.try_into().ok()
}

/// `a + b`, exactly.
pub(super) fn sum(a: &Number, b: &Number) -> Option<Number> {
    written(&(a.value.as_rational()? + b.value.as_rational()?))
}

/// `a - b`, exactly.
pub(super) fn difference(a: &Number, b: &Number) -> Option<Number> {
    written(&(a.value.as_rational()? - b.value.as_rational()?))
}

/// The lesser of two; the first of those that cannot be told apart.
pub(super) fn lesser(a: Number, b: Number) -> Number {
    match b.value.compare(&a.value) {
        Some(Ordering::Less) => b,
        _ => a,
    }
}

/// A rational number as a design writes it: as a decimal if it is one.
pub(super) fn written(value: &BigRational) -> Option<Number> {
    let text = terminating(value, 100).unwrap_or_else(|| format!("({value})"));
    let value = Exact::parse(&text, 1000).ok()?;
    Some(Number { text, value })
}

/// The greatest height of a cylinder of `radius` in which no carriage is above its top, as an
/// expression; over the disc a carriage is highest where the platform is nearest to its tower.
pub(super) fn highest(towers: &[Tower], tops: &[String], radius: &Number) -> Option<String> {
    let height = |(tower, top): (&Tower, &String)| {
        let (rod, far) = (&tower.rod.text, &tower.radius.text);
        match radius.value.compare(&tower.radius.value)? {
            Ordering::Less => {
                let near = format!("({far}-({}))", radius.text);
                Some(format!("{top}-sqrt({rod}*{rod}-{near}*{near})"))
            }
            _ => Some(format!("{top}-{rod}")),
        }
    };
    let heights: Option<Vec<String>> = towers.iter().zip(tops).map(height).collect();
    least(&heights?).map(|(height, _)| height)
}

/// The number nearest to an expression, for a comment.
pub(super) fn about(expression: &str) -> Option<String> {
    let value = Exact::parse(expression, 1000).ok()?;
    let value = value.below(64)?.to_f64()?;
    Some(format!("{value:.3}"))
}
