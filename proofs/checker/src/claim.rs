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
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Claim {
    /// One machine (or every machine within its tolerances) over one workspace.
    Machine(#[serde(deserialize_with = "strict::object")] MachineClaim),
    /// The Q1/Q2 postulate for one `psi_max`, a range, or every one.
    Postulate(#[serde(deserialize_with = "strict::object")] PostulateClaim),
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
    /// A cube without `psi_max`, or with `psi_max <= 1`.
    CubeNeedsPsiMax,
    /// A `psi_max` that is not provably greater than 1.
    PsiMaxNotAboveOne,
    /// A cube with a `psi_min` of its own.
    CubeFixesPsiMin,
    /// The numbers cannot be enclosed at the precision of the proof.
    Precision(String),
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
            ClaimError::CubeNeedsPsiMax => {
                write!(f, "a workspace \"cube\" needs transmission.max (psi_max) greater than 1")
            }
            ClaimError::PsiMaxNotAboveOne => {
                write!(f, "psi_max is not (provably) greater than 1")
            }
            ClaimError::CubeFixesPsiMin => {
                write!(f, "with a workspace \"cube\", psi_min = 1/psi_max is not free")
            }
            ClaimError::Precision(what) => {
                write!(f, "{what} cannot be enclosed at the precision of the proof")
            }
        }
    }
}

impl std::error::Error for ClaimError {}

impl MachineClaim {
    /// Proves the claim well formed: ordered ranges, positive lengths, admissible bounds.
    pub fn validate(&self) -> Result<(), ClaimError> {
        match (&self.mechanism, &self.workspace) {
            (Mechanism::Translational(legs), Workspace::Box { min, max }) => {
                for (i, leg) in legs.iter().enumerate() {
                    leg.validate(i)?;
                }
                for ((axis, min), max) in ["x", "y", "z"].iter().zip(min).zip(max) {
                    ordered(min, max, || format!("workspace along {axis}"))?;
                }
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
}

impl Leg {
    fn validate(&self, index: usize) -> Result<(), ClaimError> {
        let leg = index + 1;
        for (parameter, quantity) in self.parameters() {
            ordered(&quantity.min, &quantity.max, || format!("leg {leg}: {parameter}"))?;
            if parameter == Parameter::Length {
                positive(&quantity.min, || format!("leg {leg}: {parameter}"))?;
            }
        }
        Ok(())
    }

    /// Whether both legs have the same drive and working mode.
    pub fn same_kind(&self, other: &Leg) -> bool {
        match (self, other) {
            (Leg::Slider { mode, .. }, Leg::Slider { mode: other, .. }) => mode == other,
        }
    }

    /// Every parameter that may carry a tolerance, in the order of the format.
    pub fn parameters(&self) -> Vec<(Parameter, &Quantity)> {
        match self {
            Leg::Slider { direction, anchor, platform, length, .. } => {
                let mut all = Vec::with_capacity(10);
                all.extend(direction.iter().map(|q| (Parameter::Direction, q)));
                all.extend(anchor.iter().map(|q| (Parameter::Anchor, q)));
                all.extend(platform.iter().map(|q| (Parameter::Platform, q)));
                all.push((Parameter::Length, length));
                all
            }
        }
    }

    /// The same parameters, to be replaced.
    pub fn parameters_mut(&mut self) -> Vec<&mut Quantity> {
        match self {
            Leg::Slider { direction, anchor, platform, length, .. } => {
                let mut all = Vec::with_capacity(10);
                all.extend(direction.iter_mut());
                all.extend(anchor.iter_mut());
                all.extend(platform.iter_mut());
                all.push(length);
                all
            }
        }
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
    /// A length, which is positive.
    Length,
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Parameter::Direction => "direction",
            Parameter::Anchor => "anchor",
            Parameter::Platform => "platform",
            Parameter::Length => "length",
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
