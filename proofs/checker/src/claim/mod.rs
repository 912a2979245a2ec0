//! Claims: complete theorems about a machine, in exact numbers.
//!
//! A [`Claim`] says, without reference to any other file, what a certificate proves or refutes.
//! `FORMAT.md` gives the meaning of every field; the types here are its vocabulary.
//!
//! | module     | holds                                                                 |
//! |------------|-----------------------------------------------------------------------|
//! | `leg`      | legs and their parameters                                             |
//! | `validate` | which claims are well formed                                          |
//! | `form`     | how claims are written and read                                       |

mod form;
mod leg;
mod validate;

use crate::number::Exact;
use crate::strict;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

pub use leg::{Leg, Parameter, Sign, WorkingMode};
pub use orthocert_kernel::atlas::AtlasClaim;
pub use orthocert_kernel::no_cube::NoCubeClaim;
pub use orthocert_kernel::postulate::{Every, PostulateClaim, PsiMax};
pub use validate::ClaimError;

/// What a certificate is about.
#[allow(clippy::large_enum_variant, reason = "one value, or three, for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Claim {
    /// One machine (or every machine within its tolerances) over one workspace.
    Machine(#[serde(deserialize_with = "strict::object")] MachineClaim),
    /// The Q1/Q2 postulate for one `psi_max`, a range, or every one.
    #[serde(skip_deserializing)]
    Postulate(PostulateClaim),
    /// No cube of some side fits, wherever its centre is in a box.
    #[serde(skip_deserializing)]
    NoCube(NoCubeClaim),
    /// Every machine of a box of parameters, in part.
    #[serde(skip_deserializing)]
    Atlas(AtlasClaim),
    /// Any mechanism, in the kernel's vocabulary; read and written as the kernel does.
    #[serde(skip_deserializing, rename = "machine")]
    Kernel(orthocert_kernel::claim::MachineClaim),
}

/// "Every machine described, at every point of the workspace, is free of serial and parallel
/// singularities and meets every requirement."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineClaim {
    /// The machine.
    pub mechanism: Mechanism,
    /// The prescribed workspace, in the frame that the legs are described in.
    pub workspace: Workspace,
    /// What must hold everywhere in it.
    #[serde(deserialize_with = "strict::object")]
    pub requirements: Requirements,
}

/// A translational parallel mechanism.
#[allow(clippy::large_enum_variant, reason = "one value for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Mechanism {
    /// Three legs, each with its own numbers.
    Translational(#[serde(deserialize_with = "strict::three")] [Leg; 3]),
    /// The Orthoglide whose leg length `L`, corners `q_1`, `q_2` and base point follow from
    /// `psi_max` and the side of a cubic workspace (the paper's Steps 1 to 3).
    #[serde(deserialize_with = "form::offset")]
    Orthoglide {
        /// Platform offset `e`: `C_i = P - e e_i`.
        offset: Exact,
    },
}

/// The set of points that a claim is about. It is closed.
#[allow(clippy::large_enum_variant, reason = "one value for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Workspace {
    /// `min_k <= P_k <= max_k`.
    #[serde(deserialize_with = "form::corners")]
    Box {
        /// Least coordinates.
        min: [Exact; 3],
        /// Greatest coordinates.
        max: [Exact; 3],
    },
    /// `(x - center_x)^2 + (y - center_y)^2 <= radius^2` and `z_0 <= z <= z_1`.
    #[serde(deserialize_with = "form::cylinder")]
    Cylinder {
        /// Where the axis, which is parallel to z, crosses the plane `z = 0`.
        center: [Exact; 2],
        /// Positive.
        radius: Exact,
        /// Least and greatest z.
        z: [Exact; 2],
    },
    /// The paper's cube `[q_1, q_2]^3`, with `q_2 - q_1` = `side`; goes with
    /// [`Mechanism::Orthoglide`] only.
    #[serde(deserialize_with = "form::side")]
    Cube {
        /// `L_workspace > 0`.
        side: Exact,
    },
}

/// What must hold at every point of the workspace, besides freedom from singularities.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirements {
    /// Bounds on the velocity transmission factors `psi_1, psi_2, psi_3`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub transmission: Option<Range>,
    /// Bounds on the joint coordinates `rho_1, rho_2, rho_3`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional_three"
    )]
    pub joint_range: Option<[Range; 3]>,
    /// `sigma_max(M) / sigma_min(M) <= max`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub conditioning: Option<AtMost>,
    /// `|eta_i| / L_i >= min`, for every leg.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub serial_margin: Option<AtLeast>,
    /// `|det A| / (L_1 L_2 L_3) >= min`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub parallel_margin: Option<AtLeast>,
    /// The angle between leg and guide, in degrees, is at most `max`, for every leg.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub leg_angle: Option<AtMost>,
    /// No tool velocity of magnitude `tool` demands a joint speed beyond `max`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional"
    )]
    pub joint_speed: Option<JointSpeed>,
}

/// `x <= max`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtMost {
    /// Greatest admissible value.
    pub max: Exact,
}

/// `x >= min`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtLeast {
    /// Least admissible value.
    pub min: Exact,
}

/// `|row_i of M| tool <= max`, for every leg; of arms, whose `M` counts radians,
/// `|row_i of M| tool 180/pi <= max`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpeed {
    /// Magnitude of the tool's velocity, length per time.
    pub tool: Exact,
    /// Greatest joint speed, length per time (for arms: degrees per time).
    pub max: Exact,
}

/// `min <= x <= max`; an absent bound is no requirement, and one is present.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Least admissible value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<Exact>,
    /// Greatest admissible value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<Exact>,
}

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

    /// Whether `x` is provably admissible.
    pub fn admits(&self, x: &Exact) -> bool {
        let above = matches!(self.min.compare(x), Some(Ordering::Less | Ordering::Equal));
        above && matches!(x.compare(&self.max), Some(Ordering::Less | Ordering::Equal))
    }
}

impl Mechanism {
    /// Whether joint coordinates are angles; then `M` has the unit radian per length. (A well-formed
    /// claim has arms only, or none.)
    pub fn is_angular(&self) -> bool {
        match self {
            Mechanism::Translational(legs) => legs.iter().any(Leg::is_angular),
            Mechanism::Orthoglide { .. } => false,
        }
    }
}
