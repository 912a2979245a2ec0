//! Claims: the theorem of a certificate, complete in itself.

use crate::number::Expression;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// "Every machine described, at every point of the workspace, is free of serial and parallel
/// singularities and meets every requirement."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineClaim {
    /// The machine.
    pub mechanism: Mechanism,
    /// The points that the claim is about.
    pub workspace: Workspace,
    /// How the platform is turned there; of platforms that turn, and only of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// What must not collide.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
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
    /// Legs in the plane, whose platform is a point, or turns in the plane.
    Planar(Turning),
    /// Legs that move a platform in space and turn it.
    Spatial(Turning),
    /// Legs that turn a platform about the origin.
    Spherical(Turning),
    /// A mechanism by its inverse kinematics.
    Formulas(Formulas),
}

impl Mechanism {
    /// The legs that it is given by. Those of the paper follow from the claim; of formulas there are none.
    pub fn legs(&self) -> &[Leg] {
        match self {
            Mechanism::Translational(legs) => legs,
            Mechanism::Planar(own) | Mechanism::Spatial(own) | Mechanism::Spherical(own) => {
                &own.legs
            }
            Mechanism::Orthoglide { .. } | Mechanism::Formulas(_) => &[],
        }
    }
}

/// Legs of a platform that may turn.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turning {
    /// The legs.
    pub legs: Vec<Leg>,
    /// `l > 0`: `M` maps the velocity of `P` and `l` times the angular velocity to the joint rates. Of
    /// platforms that turn, and only of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub characteristic_length: Option<Expression>,
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

/// A vector of quantities: of three, in the plane of two.
pub type Vector = Vec<Quantity>;

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
        /// `d`: the platform's joint, from `P`; of platforms that turn, in their own frame.
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
        /// Of the universal joint in the base, the axis that is fixed to it; where the leg is to
        /// keep the platform from turning.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        base_axis: Option<Vector>,
    },
    /// Of fixed length, on an arm that turns.
    Arm {
        /// Of the motor; not zero. Empty in the plane, where motors turn about `+z`.
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

    /// Whether its ends have to differ: those of a range that varies may be one number for some values.
    pub(crate) fn has_width(&self) -> bool {
        let [min, max] = self.ends();
        matches!(self, Quantity::Between { .. }) && !min.varies() && !max.varies()
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
            Leg::Strut { anchor, platform, base_axis } => {
                let mut all: Vec<(&'static str, Kind, &[Quantity])> =
                    vec![("anchor", Place, anchor), ("platform", Place, platform)];
                all.extend(base_axis.as_ref().map(|axis| ("base_axis", Direction, &axis[..])));
                all
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
    Plus = 1,
    /// `-1`.
    #[serde(rename = "-")]
    Minus = -1,
}

impl Sign {
    /// `1` or `-1`.
    pub fn as_integer(self) -> i64 {
        self as i64
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

impl Formulas {
    /// Whatever has a name.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let parameters = self.parameters.iter().map(|(name, _)| name);
        let definitions = self.definitions.iter().map(|(name, _)| name);
        parameters.chain(definitions).chain(&self.coordinates).map(String::as_str)
    }
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

/// A set of orientations of the platform. Angles are in degrees.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Orientation {
    /// In space: every rotation by at most this, less than 180, about any axis.
    Angle(Expression),
    /// In space, by tilt and torsion angles: the platform's z axis tilted by up to `tilt` in any
    /// direction, with a torsion of up to `torsion` either way.
    Tilt {
        /// Less than 180.
        tilt: Expression,
        /// Less than 180.
        torsion: Expression,
    },
    /// In space, `R = R_z(yaw) R_y(pitch) R_x(roll)`, from the one to the other, between -180 and 180.
    RollPitchYaw {
        /// About x.
        roll: [Expression; 2],
        /// About y.
        pitch: [Expression; 2],
        /// About z.
        yaw: [Expression; 2],
    },
    /// In the plane, from the one to the other, between -180 and 180.
    Range([Expression; 2]),
}

/// A body: every point within `radius` of a segment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "on", rename_all = "snake_case", deny_unknown_fields)]
pub enum Body {
    /// Along a leg, which begins `trim_1` from the base joint and ends `trim_2` before the platform's.
    Leg {
        /// Counted from one.
        leg: usize,
        /// Positive.
        radius: Expression,
        /// Not negative.
        trim: [Expression; 2],
        /// By how much it is beside the leg: a bar of a parallelogram.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        offset: Option<[Expression; 3]>,
    },
    /// Fixed to the base.
    Base {
        /// One end of the segment.
        from: [Expression; 3],
        /// The other; may be the same.
        to: [Expression; 3],
        /// Positive.
        radius: Expression,
    },
    /// Fixed to the platform, in its frame.
    Platform {
        /// One end of the segment.
        from: [Expression; 3],
        /// The other; may be the same.
        to: [Expression; 3],
        /// Positive.
        radius: Expression,
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
    /// What the quantity is for, by name: a platform's speed, a joint's error.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub given: BTreeMap<String, Vec<Expression>>,
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
    /// Not a number: it holds.
    Holds,
}

impl Bound {
    /// The least value that it allows.
    pub fn least(&self) -> Option<&Expression> {
        if let Bound::Min(bound) = self {
            Some(bound)
        } else {
            None
        }
    }

    /// The greatest.
    pub fn greatest(&self) -> Option<&Expression> {
        if let Bound::Max(bound) = self {
            Some(bound)
        } else {
            None
        }
    }
}

/// "For every machine, and every point `C` of the box that is the workspace of `machine`, the closed
/// cube of this side with the centre `C` and edges along the axes has a point at which the claim of
/// `machine` fails."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoCubeClaim {
    /// The machine, the requirements, and the box of the centres.
    pub machine: MachineClaim,
    /// Positive.
    pub side: Expression,
}

/// "For every `psi_max` of the set and every Orthoglide with the paper's cube for it: at every point of
/// the cube, every leg reaches without a serial singularity, and `1/psi_max <= psi_i <= psi_max`."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PostulateClaim {
    /// The set.
    pub psi_max: PsiMax,
}

/// A set of `psi_max`, all greater than 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PsiMax {
    /// Every `psi_max > 1`.
    Every(Every),
    /// One, or every one from the one to the other.
    Of(Quantity),
}

/// `"all"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Every {
    /// Every one.
    #[serde(rename = "all")]
    All,
}

/// "Of the box of parameters, the cells that the proof says are certified have at least the share
/// `certified`, and those that it says are refuted at least `refuted`. For all values of the parameters
/// in a certified cell the claim that `machine` becomes with them is true; in a refuted one it is
/// false."
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasClaim {
    /// One to three.
    pub parameters: Vec<Parameter>,
    /// A claim, in whose numbers parameters may be named.
    pub machine: MachineClaim,
    /// Not negative.
    pub certified: Expression,
    /// Not negative.
    pub refuted: Expression,
}

/// A parameter of an atlas.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// By which numbers refer to it.
    pub name: String,
    /// Rational.
    pub min: Expression,
    /// Rational, and greater.
    pub max: Expression,
}
