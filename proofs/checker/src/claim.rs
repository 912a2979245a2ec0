//! Claims: complete theorems about a machine, in exact numbers.
//!
//! A [`Claim`] says, without reference to any other file, what a certificate proves or refutes.
//! `FORMAT.md` gives the meaning of every field; the types here are its vocabulary.

use crate::number::Exact;
use crate::strict;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cmp::Ordering;
use std::fmt;

/// What a certificate is about.
#[allow(clippy::large_enum_variant, reason = "one value, or three, for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Claim {
    /// One machine (or every machine within its tolerances) over one workspace.
    Machine(#[serde(deserialize_with = "strict::object")] MachineClaim),
    /// The Q1/Q2 postulate for one `psi_max`, a range, or every one.
    Postulate(#[serde(deserialize_with = "strict::object")] PostulateClaim),
    /// No cube of some side fits, wherever its centre is in a box.
    NoCube(#[serde(deserialize_with = "strict::object")] NoCubeClaim),
    /// Every machine of a box of parameters, in part.
    Atlas(#[serde(deserialize_with = "strict::object")] AtlasClaim),
}

/// "For every machine described and every point `C` of the box, the closed cube of this side with
/// the centre `C` and edges along the axes has a point at which the claim of `machine` fails."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoCubeClaim {
    /// The machine, the requirements, and, as the workspace, the box of the centres.
    #[serde(deserialize_with = "strict::object")]
    pub machine: MachineClaim,
    /// The cube's side.
    pub side: Exact,
}

/// The parts that half a cube's side is divided in, for [`NoCubeClaim::moved`].
pub const OFFSET_PARTS: i64 = 8;

impl NoCubeClaim {
    /// Proves the claim well formed: a claim about a box of centres, and a positive side.
    pub fn validate(&self) -> Result<(), ClaimError> {
        self.machine.validate()?;
        if !matches!(self.machine.workspace, Workspace::Box { .. }) {
            return Err(ClaimError::NeedsCentres);
        }
        positive(&self.side, || "side".into())
    }

    /// The claim about the points `C + offset side / (2 OFFSET_PARTS)`, `C` in the box of centres;
    /// `None` if that is not a point of the cube, or beyond what numbers may be.
    pub fn moved(&self, offset: &[i64; 3]) -> Option<MachineClaim> {
        let Workspace::Box { min, max } = &self.machine.workspace else {
            return None;
        };
        if !offset.iter().all(|n| (-OFFSET_PARTS..=OFFSET_PARTS).contains(n)) {
            return None;
        }
        let part = self.side.clone().over(Exact::integer(2 * OFFSET_PARTS)).ok()?;
        let (mut min, mut max) = (min.clone(), max.clone());
        for (k, &n) in offset.iter().enumerate() {
            let by = part.clone().times(Exact::integer(n)).ok()?;
            min[k] = min[k].clone().plus(by.clone()).ok()?;
            max[k] = max[k].clone().plus(by).ok()?;
        }
        Some(MachineClaim { workspace: Workspace::Box { min, max }, ..self.machine.clone() })
    }
}

/// "Of the box of parameters, the cells that the proof names certified, which fill the share
/// `certified` of it, hold only designs that meet every requirement; the cells that it names
/// refuted, which fill the share `refuted`, hold only designs that do not."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasClaim {
    /// What is varied: one to three parameters, in the order of the axes of the map.
    #[serde(deserialize_with = "strict::parameters")]
    pub parameters: Vec<AtlasParameter>,
    /// A machine claim, some numbers of which are expressions with the parameters' names: one
    /// claim for each choice of their values.
    #[serde(deserialize_with = "strict::object")]
    pub design: MachineClaim,
    /// The share of the box in certified cells.
    pub certified: Exact,
    /// The share of the box in refuted cells.
    pub refuted: Exact,
}

/// A parameter of an atlas: every real value from `min` to `max`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasParameter {
    /// How expressions call it.
    #[serde(deserialize_with = "strict::label")]
    pub name: String,
    /// Least value, rational.
    pub min: Exact,
    /// Greatest value, rational and greater than the least.
    pub max: Exact,
}

/// "For every admissible `psi_max` and every point `P` of the paper's cube `[q_1, q_2]^3` for it
/// (`L = 1`): every `s_i > 0`, and `1/psi_max <= psi_i(P) <= psi_max`."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PostulateClaim {
    /// The `psi_max` that the claim is about.
    pub psi_max: PsiMax,
}

/// A set of `psi_max`, all greater than 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PsiMax {
    /// Every `psi_max > 1`; written `"all"`.
    All,
    /// Every one from `min` to `max`; written as one number where both are the same.
    Range(Quantity),
}

impl PostulateClaim {
    /// Proves the claim well formed: `1 < min <= max`.
    pub fn validate(&self) -> Result<(), ClaimError> {
        let PsiMax::Range(range) = &self.psi_max else {
            return Ok(());
        };
        ordered(&range.min, &range.max, || "psi_max".into())?;
        match range.min.compare(&Exact::integer(1)) {
            Some(Ordering::Greater) => Ok(()),
            _ => Err(ClaimError::PsiMaxNotAboveOne),
        }
    }
}

impl Serialize for PsiMax {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            PsiMax::All => serializer.serialize_str("all"),
            PsiMax::Range(range) => range.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for PsiMax {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrTolerance { or_all: true })
    }
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
    #[serde(deserialize_with = "offset")]
    Orthoglide {
        /// Platform offset `e`: `C_i = P - e e_i`.
        offset: Exact,
    },
}

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

/// The set of points that a claim is about. It is closed.
#[allow(clippy::large_enum_variant, reason = "one value for each claim")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Workspace {
    /// `min_k <= P_k <= max_k`.
    #[serde(deserialize_with = "corners")]
    Box {
        /// Least coordinates.
        min: [Exact; 3],
        /// Greatest coordinates.
        max: [Exact; 3],
    },
    /// `(x - center_x)^2 + (y - center_y)^2 <= radius^2` and `z_0 <= z <= z_1`.
    #[serde(deserialize_with = "cylinder")]
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
    #[serde(deserialize_with = "side")]
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

/// `|row_i of M| tool <= max`, for every leg.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpeed {
    /// Magnitude of the tool's velocity, length per time.
    pub tool: Exact,
    /// Greatest joint speed, length per time (for arms: radians per time).
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

/// Why a claim is not well formed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ClaimError {
    /// A lower end is not provably at most its upper end.
    Reversed(String),
    /// A number that must be positive is not provably so.
    NotPositive(String),
    /// A direction that is not provably different from zero.
    ZeroDirection(String),
    /// `psi_min < psi_max` is not provable.
    EmptyTransmission,
    /// A range without a bound.
    NoBound(String),
    /// A cube without the Orthoglide that it defines, or the reverse.
    CubeNeedsOrthoglide,
    /// Centres of cubes that are not in a box.
    NeedsCentres,
    /// A cube without `psi_max`, or with `psi_max <= 1`.
    CubeNeedsPsiMax,
    /// A `psi_max` that is not provably greater than 1.
    PsiMaxNotAboveOne,
    /// A number that is not provably greater than this one.
    NotAbove(String, i64),
    /// Arms beside other drives: the transmission factors have no common unit.
    MixedUnits,
    /// A requirement on `eta_i / L_i` of legs without a length.
    NeedsLegLengths,
    /// A requirement on the angle between leg and guide of legs without a guide.
    NeedsGuides,
    /// A range of angles without both ends, beyond a turn, or of half a turn or more.
    AngleRange,
    /// A cube with a `psi_min` of its own.
    CubeFixesPsiMin,
    /// The numbers cannot be enclosed at the precision of the proof.
    Precision(String),
    /// A number with a name, which only the design of an atlas has.
    Open(String),
}

impl fmt::Display for ClaimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClaimError::Reversed(what) => write!(f, "{what}: min is not (provably) at most max"),
            ClaimError::NotPositive(what) => write!(f, "{what} is not (provably) positive"),
            ClaimError::ZeroDirection(what) => write!(f, "{what} is or may be the zero vector"),
            ClaimError::EmptyTransmission => {
                write!(f, "transmission: psi_min is not (provably) less than psi_max")
            }
            ClaimError::NoBound(what) => write!(f, "{what}: neither min nor max is given"),
            ClaimError::CubeNeedsOrthoglide => write!(
                f,
                "a workspace \"cube\" goes with the mechanism \"orthoglide\", and only with it"
            ),
            ClaimError::NeedsCentres => write!(f, "the centres of cubes are not given as a box"),
            ClaimError::CubeNeedsPsiMax => {
                write!(f, "a workspace \"cube\" needs transmission.max (psi_max) greater than 1")
            }
            ClaimError::NotAbove(what, least) => {
                write!(f, "{what} is not (provably) greater than {least}")
            }
            ClaimError::MixedUnits => write!(
                f,
                "arms beside other drives: the transmission factors have no common unit"
            ),
            ClaimError::NeedsLegLengths => {
                write!(f, "serial_margin needs legs with a length: sliders or arms")
            }
            ClaimError::NeedsGuides => write!(f, "leg_angle needs legs with a guide: sliders"),
            ClaimError::AngleRange => write!(
                f,
                "joint_range of arms, in degrees, needs min and max within ±360 and less than 180 apart"
            ),
            ClaimError::PsiMaxNotAboveOne => {
                write!(f, "psi_max is not (provably) greater than 1")
            }
            ClaimError::CubeFixesPsiMin => {
                write!(f, "with a workspace \"cube\", psi_min = 1/psi_max is not free")
            }
            ClaimError::Precision(what) => {
                write!(f, "{what} cannot be enclosed at the precision of the proof")
            }
            ClaimError::Open(number) => {
                write!(f, "{number:?} has a name; only the design of an atlas has names")
            }
        }
    }
}

impl std::error::Error for ClaimError {}

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

impl MachineClaim {
    /// Proves the claim well formed: ordered ranges, positive lengths, admissible bounds.
    pub fn validate(&self) -> Result<(), ClaimError> {
        self.try_map(&mut |x, _| match x.is_open() {
            true => Err(ClaimError::Open(x.to_string())),
            false => Ok(x.clone()),
        })?;
        match (&self.mechanism, &self.workspace) {
            (Mechanism::Translational(legs), Workspace::Box { min, max }) => {
                self.validate_legs(legs)?;
                for ((axis, min), max) in ["x", "y", "z"].iter().zip(min).zip(max) {
                    ordered(min, max, || format!("workspace along {axis}"))?;
                }
            }
            (Mechanism::Translational(legs), Workspace::Cylinder { radius, z, .. }) => {
                self.validate_legs(legs)?;
                positive(radius, || "workspace.cylinder.radius".into())?;
                ordered(&z[0], &z[1], || "workspace.cylinder.z".into())?;
            }
            (Mechanism::Orthoglide { .. }, Workspace::Cube { side }) => {
                positive(side, || "workspace.cube".into())?;
                let Some(range) = &self.requirements.transmission else {
                    return Err(ClaimError::CubeNeedsPsiMax);
                };
                if range.min.is_some() {
                    return Err(ClaimError::CubeFixesPsiMin);
                }
                let above_one = range.max.as_ref().and_then(|max| max.compare(&Exact::integer(1)));
                if above_one != Some(Ordering::Greater) {
                    return Err(ClaimError::CubeNeedsPsiMax);
                }
            }
            _ => return Err(ClaimError::CubeNeedsOrthoglide),
        }
        self.requirements.validate()
    }

    fn validate_legs(&self, legs: &[Leg; 3]) -> Result<(), ClaimError> {
        for (i, leg) in legs.iter().enumerate() {
            leg.validate(i)?;
        }
        let angular = legs.iter().filter(|leg| leg.is_angular()).count();
        if angular % 3 != 0 {
            return Err(ClaimError::MixedUnits);
        }
        let requirements = &self.requirements;
        if requirements.serial_margin.is_some() && !legs.iter().all(Leg::has_length) {
            return Err(ClaimError::NeedsLegLengths);
        }
        if requirements.leg_angle.is_some()
            && !legs.iter().all(|leg| matches!(leg, Leg::Slider { .. }))
        {
            return Err(ClaimError::NeedsGuides);
        }
        if angular > 0 {
            requirements.joint_range.iter().flatten().try_for_each(Range::validate_angle)?;
        }
        Ok(())
    }
}

impl Leg {
    fn validate(&self, index: usize) -> Result<(), ClaimError> {
        let leg = index + 1;
        for (parameter, quantity) in self.parameters() {
            ordered(&quantity.min, &quantity.max, || format!("leg {leg}: {parameter}"))?;
            if parameter.is_length() {
                positive(&quantity.min, || format!("leg {leg}: {parameter}"))?;
            }
        }
        Ok(())
    }

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

impl Requirements {
    fn validate(&self) -> Result<(), ClaimError> {
        if let Some(range) = &self.transmission {
            range.validate(|| "transmission".into())?;
            for (bound, name) in [(&range.min, "min"), (&range.max, "max")] {
                if let Some(psi) = bound {
                    positive(psi, || format!("transmission.{name}"))?;
                }
            }
            if let (Some(min), Some(max)) = (&range.min, &range.max) {
                if min.compare(max) != Some(Ordering::Less) {
                    return Err(ClaimError::EmptyTransmission);
                }
            }
        }
        for (i, range) in self.joint_range.iter().flatten().enumerate() {
            range.validate(|| format!("joint_range of leg {}", i + 1))?;
        }
        if let Some(AtMost { max }) = &self.conditioning {
            above(max, 1, "conditioning.max")?;
        }
        for (bound, name) in
            [(&self.serial_margin, "serial_margin"), (&self.parallel_margin, "parallel_margin")]
        {
            if let Some(AtLeast { min }) = bound {
                positive(min, || format!("{name}.min"))?;
            }
        }
        if let Some(AtMost { max }) = &self.leg_angle {
            positive(max, || "leg_angle.max".into())?;
            ordered(max, &Exact::integer(90), || "leg_angle up to 90 degrees".into())?;
        }
        if let Some(JointSpeed { tool, max }) = &self.joint_speed {
            positive(tool, || "joint_speed.tool".into())?;
            positive(max, || "joint_speed.max".into())?;
        }
        Ok(())
    }
}

impl Range {
    fn validate(&self, name: impl Fn() -> String) -> Result<(), ClaimError> {
        match (&self.min, &self.max) {
            (None, None) => Err(ClaimError::NoBound(name())),
            (Some(min), Some(max)) => ordered(min, max, name),
            _ => Ok(()),
        }
    }

    /// Angles, in degrees: both ends are given, within a turn and less than half a turn apart, so
    /// that two signs decide membership.
    fn validate_angle(&self) -> Result<(), ClaimError> {
        let (Some(min), Some(max)) = (&self.min, &self.max) else {
            return Err(ClaimError::AngleRange);
        };
        let at_most =
            |x: &Exact, y: &Exact| matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal));
        let span = max.clone().minus(min.clone()).map_err(|_| ClaimError::AngleRange)?;
        let within = span.compare(&Exact::integer(180)) == Some(Ordering::Less)
            && at_most(&Exact::integer(-360), min)
            && at_most(max, &Exact::integer(360));
        within.then_some(()).ok_or(ClaimError::AngleRange)
    }
}

fn above(x: &Exact, least: i64, name: &str) -> Result<(), ClaimError> {
    match x.compare(&Exact::integer(least)) {
        Some(Ordering::Greater) => Ok(()),
        _ => Err(ClaimError::NotAbove(name.into(), least)),
    }
}

fn ordered(min: &Exact, max: &Exact, name: impl Fn() -> String) -> Result<(), ClaimError> {
    match min.compare(max) {
        Some(Ordering::Less | Ordering::Equal) => Ok(()),
        _ => Err(ClaimError::Reversed(name())),
    }
}

fn positive(x: &Exact, name: impl Fn() -> String) -> Result<(), ClaimError> {
    match x.sign() {
        Some(1) => Ok(()),
        _ => Err(ClaimError::NotPositive(name())),
    }
}

// The fields of variants, read strictly: see `crate::strict`.

type Corners = ([Exact; 3], [Exact; 3]);

fn corners<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Corners, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        min: [Exact; 3],
        max: [Exact; 3],
    }
    strict::object(deserializer).map(|Fields { min, max }| (min, max))
}

type CylinderFields = ([Exact; 2], Exact, [Exact; 2]);

fn cylinder<'de, D: Deserializer<'de>>(deserializer: D) -> Result<CylinderFields, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        center: [Exact; 2],
        radius: Exact,
        z: [Exact; 2],
    }
    strict::object(deserializer).map(|Fields { center, radius, z }| (center, radius, z))
}

fn side<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Exact, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        side: Exact,
    }
    strict::object(deserializer).map(|Fields { side }| side)
}

fn offset<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Exact, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        offset: Exact,
    }
    strict::object(deserializer).map(|Fields { offset }| offset)
}

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = std::borrow::Cow::<'de, str>::deserialize(deserializer)?;
        Exact::parse_canonical(&text).map_err(|e| D::Error::custom(format!("not a number: {e}")))
    }
}

impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.is_exact() {
            return self.min.serialize(serializer);
        }
        Tolerance { min: self.min.clone(), max: self.max.clone() }.serialize(serializer)
    }
}

/// The form of a [`Quantity`] that is not a single number.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tolerance {
    min: Exact,
    max: Exact,
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match deserializer.deserialize_any(NumberOrTolerance { or_all: false })? {
            PsiMax::Range(quantity) => Ok(quantity),
            PsiMax::All => Err(D::Error::custom("not a number: \"all\"")),
        }
    }
}

/// Reads a number or an object with `min` and `max`; or, where it may be, the word `all`.
struct NumberOrTolerance {
    or_all: bool,
}

impl<'de> Visitor<'de> for NumberOrTolerance {
    type Value = PsiMax;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number as a string, or an object with min and max")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<PsiMax, E> {
        if self.or_all && text == "all" {
            return Ok(PsiMax::All);
        }
        Exact::parse_canonical(text)
            .map(|x| PsiMax::Range(Quantity::exactly(x)))
            .map_err(|e| E::custom(format!("not a number: {e}")))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<PsiMax, M::Error> {
        let form = serde::de::value::MapAccessDeserializer::new(map);
        let Tolerance { min, max } = Tolerance::deserialize(form)?;
        if min == max {
            return Err(M::Error::custom("equal min and max are written as one number"));
        }
        Ok(PsiMax::Range(Quantity { min, max }))
    }
}
