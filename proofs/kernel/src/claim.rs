//! Claims: the theorem of a certificate, complete in itself.

use crate::number::Expression;
use serde::{Deserialize, Serialize};

/// "Every machine described, at every point of the workspace, is free of serial and parallel
/// singularities and meets every requirement."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineClaim {
    /// The machine.
    pub mechanism: Mechanism,
    /// The points that the claim is about.
    pub workspace: Workspace,
    /// What holds at each of them.
    pub require: Vec<Requirement>,
}

/// A mechanism.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Mechanism {
    /// Three legs or more that move a platform without turning it.
    Translational(Vec<Leg>),
    /// The Orthoglide of the paper's Steps 1 to 3: leg length and base follow from `psi_max` and the
    /// side of its cube.
    Orthoglide {
        /// Platform offset `e`.
        offset: Expression,
    },
    /// A mechanism by its inverse kinematics.
    Formulas(Formulas),
}

/// A number, or every number of an interval, independently of all other quantities.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Quantity {
    /// One number.
    Exactly(Expression),
    /// From the one to the other.
    Between {
        /// Least value.
        min: Expression,
        /// Greatest value.
        max: Expression,
    },
}

/// A vector of quantities.
pub type Vector = [Quantity; 3];

/// A leg; see [`crate::machine`].
#[allow(clippy::large_enum_variant, reason = "a few for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "drive", rename_all = "snake_case", deny_unknown_fields)]
pub enum Leg {
    /// Of fixed length, on a linear guide.
    Slider {
        /// Along the guide; not zero.
        direction: Vector,
        /// `a`: the point of the guide where `rho = 0`.
        anchor: Vector,
        /// `d`: the platform's joint, from `P`.
        platform: Vector,
        /// `L > 0`.
        length: Quantity,
        /// The sign of `eta`.
        mode: Sign,
    },
    /// Extensible.
    Strut {
        /// `a`.
        anchor: Vector,
        /// `d`.
        platform: Vector,
    },
    /// Of fixed length, on an arm that turns.
    Arm {
        /// Of the motor; not zero.
        axis: Vector,
        /// Direction of the arm at angle 0; its part orthogonal to the axis is not zero.
        reference: Vector,
        /// A point of the axis.
        anchor: Vector,
        /// `d`.
        platform: Vector,
        /// `r > 0`.
        arm: Quantity,
        /// `L > 0`.
        length: Quantity,
        /// The sign of `eta`.
        mode: Sign,
    },
    /// A plane that is moved along its normal.
    Planar {
        /// The normal; not zero.
        direction: Vector,
    },
}

/// What a quantity of a leg is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Component of a vector whose length does not matter.
    Direction,
    /// Coordinate of a point.
    Place,
    /// A positive length.
    Length,
}

impl Quantity {
    /// The least and the greatest value.
    pub fn ends(&self) -> [&Expression; 2] {
        match self {
            Quantity::Exactly(x) => [x, x],
            Quantity::Between { min, max } => [min, max],
        }
    }
}

impl Leg {
    /// The vectors and lengths of a leg, by their keys.
    pub fn quantities(&self) -> Vec<(&'static str, Kind, &[Quantity])> {
        use Kind::{Direction, Length, Place};
        let one = std::slice::from_ref;
        match self {
            Leg::Slider { direction, anchor, platform, length, .. } => vec![
                ("direction", Direction, direction),
                ("anchor", Place, anchor),
                ("platform", Place, platform),
                ("length", Length, one(length)),
            ],
            Leg::Strut { anchor, platform } => {
                vec![("anchor", Place, anchor), ("platform", Place, platform)]
            }
            Leg::Arm { axis, reference, anchor, platform, arm, length, .. } => vec![
                ("axis", Direction, axis),
                ("reference", Direction, reference),
                ("anchor", Place, anchor),
                ("platform", Place, platform),
                ("arm", Length, one(arm)),
                ("length", Length, one(length)),
            ],
            Leg::Planar { direction } => vec![("direction", Direction, direction)],
        }
    }
}

/// A sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// `1`.
    #[serde(rename = "+")]
    Plus,
    /// `-1`.
    #[serde(rename = "-")]
    Minus,
}

impl Sign {
    /// `1` or `-1`.
    pub fn as_integer(self) -> i64 {
        match self {
            Sign::Plus => 1,
            Sign::Minus => -1,
        }
    }
}

/// A mechanism by its inverse kinematics.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Formulas {
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// Names and values.
    pub parameters: Vec<(String, Quantity)>,
    /// Names and expressions, each in what stands before it.
    pub definitions: Vec<(String, Expression)>,
    /// As many as coordinates, or more.
    pub joints: Vec<JointFormula>,
}

/// A joint of [`Formulas`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JointFormula {
    /// The joint coordinate: its derivatives are the row of `M`.
    Rho(Expression),
    /// The row of `M`.
    Row(Vec<Expression>),
}

/// A closed set of points.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Workspace {
    /// `min_k <= x_k <= max_k`.
    Box {
        /// Least coordinates.
        min: Vec<Expression>,
        /// Greatest coordinates.
        max: Vec<Expression>,
    },
    /// `(x - center_1)^2 + (y - center_2)^2 <= radius^2`, `z_1 <= z <= z_2`.
    Cylinder {
        /// Of the axis, which is parallel to z.
        center: [Expression; 2],
        /// Positive.
        radius: Expression,
        /// Least and greatest z.
        z: [Expression; 2],
    },
    /// The paper's cube `[q_1, q_2]^3`, `q_2 - q_1` = `side`; with [`Mechanism::Orthoglide`] only.
    Cube {
        /// `L_workspace > 0`.
        side: Expression,
    },
}

/// A bound on a quantity; see [`crate::quantity`] for the table of those.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Requirement {
    /// The quantity's key.
    pub quantity: String,
    /// Of this leg alone, counted from one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// For a platform speed up to this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool: Option<Expression>,
    /// Which end is bounded, and by what.
    #[serde(flatten)]
    pub bound: Bound,
}

/// Which end of a quantity is bounded, and by what.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "end", content = "bound", rename_all = "snake_case")]
pub enum Bound {
    /// From below.
    Min(Expression),
    /// From above.
    Max(Expression),
    /// An angle, in degrees and up to whole turns.
    Within([Expression; 2]),
}
