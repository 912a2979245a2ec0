//! Legs and their parameters.

use super::Quantity;
use crate::strict;
use serde::{Deserialize, Serialize};
use std::fmt;

/// One leg; `w = P + platform - anchor` is the vector that its kinematics start from.
#[allow(clippy::large_enum_variant, reason = "one value, or three, for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "drive", rename_all = "snake_case", deny_unknown_fields)]
pub enum Leg {
    /// Leg of fixed length on a linear guide.
    Slider {
        /// Guide direction, any non-zero vector; `n` is this vector normalised.
        direction: [Quantity; 3],
        /// `a_i`: the point of the guide where `rho_i = 0`.
        anchor: [Quantity; 3],
        /// `d_i`: from the platform's reference point to the leg's joint on it.
        platform: [Quantity; 3],
        /// `L_i > 0`.
        length: Quantity,
        /// The sign of `eta_i`.
        #[serde(deserialize_with = "strict::name")]
        mode: WorkingMode,
    },
    /// Extensible leg: `rho_i` is its length.
    Strut {
        /// The leg's joint on the base.
        anchor: [Quantity; 3],
        /// `d_i`.
        platform: [Quantity; 3],
    },
    /// Leg of fixed length on an arm that a motor turns: `rho_i` is the arm's angle.
    Arm {
        /// Direction of the motor's axis, of any length but zero.
        axis: [Quantity; 3],
        /// The arm's direction at angle 0: the part of this vector orthogonal to the axis,
        /// normalised. Angles count positive about the axis.
        reference: [Quantity; 3],
        /// A point on the motor's axis: the arm's centre of rotation.
        anchor: [Quantity; 3],
        /// `d_i`.
        platform: [Quantity; 3],
        /// Length of the arm, from the axis to the elbow.
        arm: Quantity,
        /// Length of the leg, from the elbow to the platform.
        length: Quantity,
        /// The sign of the leg's component along the elbow's motion.
        #[serde(deserialize_with = "strict::name")]
        mode: WorkingMode,
    },
    /// Leg that constrains the platform to a plane; row of `M` and `rho_i = n . P` are constant
    /// along it.
    Planar {
        /// Normal of the plane, any non-zero vector; `n` is this vector normalised.
        direction: [Quantity; 3],
    },
}

/// The sign of `eta_i`: whether the leg points along its guide's direction or against it.
pub type WorkingMode = Sign;

/// A sign, written `"+"` or `"-"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// `+1`.
    #[serde(rename = "+")]
    Plus,
    /// `-1`.
    #[serde(rename = "-")]
    Minus,
}

impl Sign {
    /// `+1` or `-1`.
    pub fn as_integer(self) -> i64 {
        match self {
            Sign::Plus => 1,
            Sign::Minus => -1,
        }
    }
}

impl Leg {
    /// Whether both legs have the same drive and working mode.
    pub fn same_kind(&self, other: &Leg) -> bool {
        match (self, other) {
            (Leg::Slider { mode, .. }, Leg::Slider { mode: other, .. })
            | (Leg::Arm { mode, .. }, Leg::Arm { mode: other, .. }) => mode == other,
            (Leg::Strut { .. }, Leg::Strut { .. }) | (Leg::Planar { .. }, Leg::Planar { .. }) => {
                true
            }
            _ => false,
        }
    }

    /// Whether the joint coordinate is an angle.
    pub fn is_angular(&self) -> bool {
        matches!(self, Leg::Arm { .. })
    }

    /// Whether the leg has a fixed length, so that `eta_i / L_i` is defined.
    pub fn has_length(&self) -> bool {
        matches!(self, Leg::Slider { .. } | Leg::Arm { .. })
    }

    /// Every parameter that may carry a tolerance, in the order of the format.
    pub fn parameters(&self) -> Vec<(Parameter, &Quantity)> {
        type Named<'a, T> = Vec<(Parameter, &'a T)>;
        let (vectors, lengths): (Named<'_, [Quantity; 3]>, Named<'_, Quantity>) = match self {
            Leg::Slider { direction, anchor, platform, length, .. } => (
                vec![
                    (Parameter::Direction, direction),
                    (Parameter::Anchor, anchor),
                    (Parameter::Platform, platform),
                ],
                vec![(Parameter::Length, length)],
            ),
            Leg::Strut { anchor, platform } => {
                (vec![(Parameter::Anchor, anchor), (Parameter::Platform, platform)], vec![])
            }
            Leg::Arm { axis, reference, anchor, platform, arm, length, .. } => (
                vec![
                    (Parameter::Axis, axis),
                    (Parameter::Reference, reference),
                    (Parameter::Anchor, anchor),
                    (Parameter::Platform, platform),
                ],
                vec![(Parameter::Arm, arm), (Parameter::Length, length)],
            ),
            Leg::Planar { direction } => (vec![(Parameter::Direction, direction)], vec![]),
        };
        let components = vectors.into_iter().flat_map(|(p, v)| v.iter().map(move |q| (p, q)));
        components.chain(lengths).collect()
    }

    /// The same parameters, to be replaced.
    pub fn parameters_mut(&mut self) -> Vec<&mut Quantity> {
        let (vectors, lengths): (Vec<&mut [Quantity; 3]>, Vec<&mut Quantity>) = match self {
            Leg::Slider { direction, anchor, platform, length, .. } => {
                (vec![direction, anchor, platform], vec![length])
            }
            Leg::Strut { anchor, platform } => (vec![anchor, platform], vec![]),
            Leg::Arm { axis, reference, anchor, platform, arm, length, .. } => {
                (vec![axis, reference, anchor, platform], vec![arm, length])
            }
            Leg::Planar { direction } => (vec![direction], vec![]),
        };
        vectors.into_iter().flatten().chain(lengths).collect()
    }

    /// Whether some parameter is an interval.
    pub fn has_tolerance(&self) -> bool {
        self.parameters().iter().any(|(_, q)| !q.is_exact())
    }
}

/// What a parameter of a leg is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// A component of a direction, whose own size does not matter.
    Direction,
    /// A coordinate of the anchor.
    Anchor,
    /// A coordinate of the platform's offset.
    Platform,
    /// The leg's length, which is positive.
    Length,
    /// A component of a motor's axis, whose own size does not matter.
    Axis,
    /// A component of an arm's reference direction, whose own size does not matter.
    Reference,
    /// The arm's length, which is positive.
    Arm,
}

impl Parameter {
    /// Whether the parameter is a component of a direction.
    pub fn is_direction(self) -> bool {
        matches!(self, Parameter::Direction | Parameter::Axis | Parameter::Reference)
    }

    /// Whether the parameter is a length, which is positive.
    pub fn is_length(self) -> bool {
        matches!(self, Parameter::Length | Parameter::Arm)
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Parameter::Direction => "direction",
            Parameter::Anchor => "anchor",
            Parameter::Platform => "platform",
            Parameter::Length => "length",
            Parameter::Axis => "axis",
            Parameter::Reference => "reference",
            Parameter::Arm => "arm",
        })
    }
}
