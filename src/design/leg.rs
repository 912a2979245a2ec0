//! Legs as designs have them: quantities between exact ends.

use crate::exact::Exact;

pub use orthocert_kernel::claim::Sign as WorkingMode;

/// A parameter of a machine: every value with `min <= x <= max`, independently of all others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Least value.
    pub min: Exact,
    /// Greatest value; equal to `min` for a parameter without tolerance.
    pub max: Exact,
}

impl Quantity {
    /// The parameter that is exactly `x`.
    pub fn exactly(x: Exact) -> Self {
        Quantity { min: x.clone(), max: x }
    }

    /// Whether there is a single admissible value.
    pub fn is_exact(&self) -> bool {
        self.min == self.max
    }
}

/// One leg; the keys are those of design files.
#[allow(clippy::large_enum_variant, reason = "a few for each design")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Leg {
    /// Of fixed length, on a linear guide.
    Slider {
        /// Along the guide.
        direction: [Quantity; 3],
        /// The point of the guide where `rho = 0`.
        anchor: [Quantity; 3],
        /// From `P` to the leg's joint on the platform.
        platform: [Quantity; 3],
        /// `L`.
        length: Quantity,
        /// The sign of `eta`.
        mode: WorkingMode,
    },
    /// Extensible.
    Strut {
        /// The leg's joint on the base.
        anchor: [Quantity; 3],
        /// From `P` to the leg's joint on the platform.
        platform: [Quantity; 3],
    },
    /// Of fixed length, on an arm that a motor turns.
    Arm {
        /// Of the motor.
        axis: [Quantity; 3],
        /// Direction of the arm at angle 0.
        reference: [Quantity; 3],
        /// The arm's centre of rotation.
        anchor: [Quantity; 3],
        /// From `P` to the leg's joint on the platform.
        platform: [Quantity; 3],
        /// Length of the arm.
        arm: Quantity,
        /// `L`.
        length: Quantity,
        /// The sign of the leg's component along the elbow's motion.
        mode: WorkingMode,
    },
    /// Holds the platform in a plane that is moved along its normal.
    Planar {
        /// The normal.
        direction: [Quantity; 3],
    },
}

impl Leg {
    /// Whether the joint coordinate is an angle.
    pub fn is_angular(&self) -> bool {
        matches!(self, Leg::Arm { .. })
    }

    /// Whether the leg has a fixed length.
    pub fn has_length(&self) -> bool {
        matches!(self, Leg::Slider { .. } | Leg::Arm { .. })
    }

    /// Whether some parameter is an interval.
    pub fn has_tolerance(&self) -> bool {
        let (vectors, lengths) = match self {
            Leg::Slider { direction, anchor, platform, length, .. } => {
                (vec![direction, anchor, platform], vec![length])
            }
            Leg::Strut { anchor, platform } => (vec![anchor, platform], vec![]),
            Leg::Arm { axis, reference, anchor, platform, arm, length, .. } => {
                (vec![axis, reference, anchor, platform], vec![arm, length])
            }
            Leg::Planar { direction } => (vec![direction], vec![]),
        };
        vectors.into_iter().flatten().chain(lengths).any(|quantity| !quantity.is_exact())
    }
}
