//! The rules: each discharges one obligation on one cell.
//!
//! | step         | obligation   | rule                                                   |
//! |--------------|--------------|--------------------------------------------------------|
//! | `lower`      | `sigma_min`  | [`lower`]: vertex rule about the centre                |
//! | `corner`     | `sigma_min`  | [`corner`]: vertex rule about a tight corner           |
//! | `upper`      | `sigma_max`  | [`upper`]: vertex rule about the centre                |
//! | `cube`       | `sigma_max`  | [`cube`]: the paper's cube, by hand                    |
//! | `range`      | `joint_range`| [`range`]: enclosure of the joint coordinates          |
//! | `conditioning` | `conditioning` | [`conditioning`]: both vertex rules with one `mu`  |
//! | `serial_margin` | `serial_margin` | [`serial_margin`]: enclosure of `eta_i / L_i`    |
//! | `leg_angle`  | `leg_angle`  | [`leg_angle`]: enclosure of `eta_i / L_i`              |
//! | `parallel_margin` | `parallel_margin` | [`parallel_margin`]: slope form of `det A` |
//! | `speed`      | `joint_speed`| [`speed`]: vertices of the rows of `M`                 |
//! | `outside`    | all          | [`outside`]: no point of the cylinder                  |
//!
//! [`violated`] shows the opposite: that a requirement fails at every point of a cell.
//!
//! A rule does not know where in the tree it is used; [`crate::check`] adds that. The rules for
//! `sigma_min` enclose `M` over the cell and can do so only where every leg certainly reaches every
//! point of it with `s_i > 0`: so `sigma_min`, which is always to be discharged, excludes serial
//! singularities as well as parallel ones, and the other rules need not. `cube` and `outside`
//! enclose nothing; `leg_angle`, up to 90 degrees, does not exclude `s_i = 0`.
//!
//! All rules are statements about one fixed machine. Where parameters are intervals, the
//! enclosures hold every machine's `M(c)` and `E_k`, and the rule holds for each of them.

mod conditioning;
mod joints;
mod margin;
mod outside;
mod vertex;
mod violated;

use crate::expansion::OutOfReach;
use serde::{Deserialize, Serialize};
use std::fmt;

pub use conditioning::{conditioning, Mu, MU_BITS};
pub use joints::{range, speed};
pub use margin::{leg_angle, parallel_margin, serial_margin};
pub use outside::outside;
pub use vertex::{corner, cube, entrywise, lower, upper, Rotation, TightCorner, MAX_QUATERNION};
pub use violated::{shrunk, stretched, violated};

/// What is to be shown of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Obligation {
    /// Every leg reaches every point with `s_i > 0` (no serial singularity), and
    /// `sigma_min(M) >= kappa` with `kappa = 1/psi_max`; where there is no `psi_max`,
    /// `sigma_min(M) > 0` (no parallel singularity).
    SigmaMin,
    /// `sigma_max(M) <= k` with `k = 1/psi_min`.
    SigmaMax,
    /// `rho_i` within its range, for every leg.
    JointRange,
    /// `sigma_max(M) / sigma_min(M)` within its bound.
    Conditioning,
    /// `|eta_i| / L_i` within its bound, for every leg.
    SerialMargin,
    /// `|det A| / (L_1 L_2 L_3)` within its bound.
    ParallelMargin,
    /// The angle between leg and guide within its bound, for every leg.
    LegAngle,
    /// `|row_i of M|` within its bound, for every leg.
    JointSpeed,
}

impl Obligation {
    /// Every obligation there is, in the order of reports.
    pub const ALL: [Obligation; 8] = [
        Obligation::SigmaMin,
        Obligation::SigmaMax,
        Obligation::JointRange,
        Obligation::Conditioning,
        Obligation::SerialMargin,
        Obligation::ParallelMargin,
        Obligation::LegAngle,
        Obligation::JointSpeed,
    ];
}

impl fmt::Display for Obligation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Obligation::SigmaMin => "sigma_min",
            Obligation::SigmaMax => "sigma_max",
            Obligation::JointRange => "joint_range",
            Obligation::Conditioning => "conditioning",
            Obligation::SerialMargin => "serial_margin",
            Obligation::ParallelMargin => "parallel_margin",
            Obligation::LegAngle => "leg_angle",
            Obligation::JointSpeed => "joint_speed",
        })
    }
}

/// Why a rule does not discharge its obligation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// A leg (from zero) is not certainly within reach and free of serial singularities.
    OutOfReach(usize),
    /// The matrix at this vertex of the cell is not certainly positive definite.
    NotDefinite {
        /// Bit `k` is set where `delta_k` is at its greater extent.
        vertex: u8,
    },
    /// `mu` is not positive at a vertex, or too large.
    BadMu,
    /// `det A` is not certainly beyond its bound.
    NearSingular,
    /// The cell may have points of the cylinder, or there is no cylinder.
    NotOutside,
    /// A joint coordinate or leg quantity (leg from zero) is not certainly within its range.
    OutOfRange(usize),
    /// The quaternion is zero, or a component is too large.
    BadRotation,
    /// The cell does not touch the corner, or the claim has none.
    NotAtCorner,
    /// The claim is not about the paper's cube.
    NotTheCube,
    /// The claim asks for nothing that the rule could discharge.
    NoSuchBound,
    /// The rule's obligation is already discharged on the cell.
    Repeated,
    /// The rule belongs to another kind of tree.
    OtherKind,
    /// The numbers cannot be enclosed.
    NotEnclosed,
    /// The requirement is not certainly violated on the whole cell.
    NotViolated,
    /// A leg number that is not 1, 2 or 3.
    NoSuchLeg(usize),
    /// A direction that is zero.
    ZeroVector,
}

impl From<OutOfReach> for Failure {
    fn from(error: OutOfReach) -> Self {
        Failure::OutOfReach(error.leg)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::OutOfReach(leg) => write!(
                f,
                "leg {} is not certainly within reach with s > 0 on the whole box",
                leg + 1
            ),
            Failure::NotDefinite { vertex } => {
                write!(f, "the matrix at vertex {vertex} is not certainly positive definite")
            }
            Failure::BadMu => write!(f, "mu is not positive at a vertex, or too large"),
            Failure::NearSingular => {
                write!(f, "det A is not certainly beyond its bound on the whole box")
            }
            Failure::NotOutside => write!(f, "the box may have points of the workspace"),
            Failure::OutOfRange(leg) => {
                write!(f, "leg {} is not certainly within its bound on the whole box", leg + 1)
            }
            Failure::BadRotation => {
                write!(f, "the quaternion is zero or has a component beyond ±{MAX_QUATERNION}")
            }
            Failure::NotAtCorner => write!(f, "the box does not touch that corner of the cube"),
            Failure::NotTheCube => write!(f, "the rule is for the paper's cube only"),
            Failure::NoSuchBound => write!(f, "the claim has no such requirement"),
            Failure::Repeated => {
                write!(f, "what the rule discharges is already discharged on the box")
            }
            Failure::OtherKind => write!(f, "the rule belongs to another kind of tree"),
            Failure::NotEnclosed => write!(f, "the numbers cannot be enclosed"),
            Failure::NotViolated => {
                write!(f, "the requirement is not provably violated on the whole box")
            }
            Failure::NoSuchLeg(leg) => write!(f, "there is no leg {leg}"),
            Failure::ZeroVector => write!(f, "the vector is zero"),
        }
    }
}
