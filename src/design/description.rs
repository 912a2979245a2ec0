//! What a design file says, before it is a claim: numbers as they are written, and demands one by one.
//!
//! [`Description::kernel`] makes it one.

use super::exactly::{between, written};
use super::leg;
use crate::exact::Exact;
use orthocert_kernel::claim::{self as kernel, Body, Formulas, Orientation, Turning};
use orthocert_kernel::number::Expression;
use orthocert_kernel::quantity::TABLE;

/// All of a design but its title.
pub(super) struct Description {
    pub mechanism: Mechanism,
    /// Where the platform turns, `l > 0`.
    pub characteristic_length: Option<Exact>,
    pub workspace: Workspace,
    pub orientation: Option<Orientation>,
    pub bodies: Vec<Body>,
    pub demands: Vec<Demand>,
}

/// A machine.
pub(super) enum Mechanism {
    /// The Orthoglide of a cube.
    OfCube { offset: Exact },
    /// Legs, each with its drive.
    Legs { motion: Motion, legs: Vec<Leg> },
    /// Inverse kinematics.
    Formulas(Formulas),
}

/// How legs move their platform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    /// Without turning it.
    Translational,
    /// In the plane; its vectors have 0 as their third component here, its arms turn about `+z`.
    Planar { turns: bool },
    /// In space, turning it.
    Spatial,
    /// About the origin.
    Spherical,
}

/// A leg.
pub(super) struct Leg {
    pub drive: leg::Leg,
    /// The axis of a strut's universal joint that is fixed to the base.
    pub base_axis: Option<[leg::Quantity; 3]>,
}

/// A closed set of points; empty corners where no coordinate is one of a point.
#[derive(Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "one value for each design")]
pub(super) enum Workspace {
    Box { min: Vec<Exact>, max: Vec<Exact> },
    Cylinder { center: [Exact; 2], radius: Exact, z: [Exact; 2] },
    Cube { side: Exact },
}

/// A bound on a quantity.
pub(super) struct Demand {
    pub quantity: &'static str,
    /// Counted from one; of every leg, or of the machine, where absent.
    pub leg: Option<usize>,
    pub given: Vec<(&'static str, Vec<Exact>)>,
    pub bound: Bound,
}

/// Which end is bounded, and by what.
pub(super) enum Bound {
    Min(Exact),
    Max(Exact),
    Within([Exact; 2]),
    Holds,
}

impl Motion {
    /// The name of the kind.
    pub fn kind(self) -> &'static str {
        match self {
            Motion::Translational => "translational",
            Motion::Planar { .. } => "planar",
            Motion::Spatial => "spatial",
            Motion::Spherical => "spherical",
        }
    }

    /// Coordinates of positions and of orientations.
    pub fn coordinates(self) -> [usize; 2] {
        match self {
            Motion::Translational => [3, 0],
            Motion::Planar { turns } => [2, usize::from(turns)],
            Motion::Spatial => [3, 3],
            Motion::Spherical => [0, 3],
        }
    }

    /// Whether the platform turns.
    pub fn turns(self) -> bool {
        self.coordinates()[1] > 0
    }
}

impl Mechanism {
    /// How many coordinates there are of positions, and of orientations.
    pub fn coordinates(&self) -> [usize; 2] {
        match self {
            Mechanism::OfCube { .. } => [3, 0],
            Mechanism::Legs { motion, .. } => motion.coordinates(),
            Mechanism::Formulas(formulas) => [formulas.coordinates.len(), 0],
        }
    }

    /// How many joints are driven.
    pub fn joints(&self) -> usize {
        match self {
            Mechanism::OfCube { .. } => 3,
            Mechanism::Legs { legs, .. } => legs.len(),
            Mechanism::Formulas(formulas) => formulas.joints.len(),
        }
    }

    /// Whether joint coordinates are angles.
    pub fn is_angular(&self) -> bool {
        match self {
            Mechanism::Legs { legs, .. } => legs.iter().any(|leg| leg.drive.is_angular()),
            Mechanism::OfCube { .. } | Mechanism::Formulas(_) => false,
        }
    }

    /// Whether it has legs, all of them such.
    pub fn all_legs(&self, are: fn(&Leg) -> bool) -> bool {
        match self {
            Mechanism::Legs { legs, .. } => legs.iter().all(are),
            Mechanism::OfCube { .. } | Mechanism::Formulas(_) => false,
        }
    }
}

impl Description {
    /// The claim in the kernel's vocabulary; `None` where a number is too long for it.
    pub fn kernel(&self) -> Option<kernel::MachineClaim> {
        let mechanism = match &self.mechanism {
            Mechanism::OfCube { offset } => {
                kernel::Mechanism::Orthoglide { offset: written(offset)? }
            }
            Mechanism::Formulas(formulas) => kernel::Mechanism::Formulas(formulas.clone()),
            Mechanism::Legs { motion, legs } => {
                let in_plane = matches!(motion, Motion::Planar { .. });
                let legs = legs.iter().map(|leg| self::leg(leg, in_plane));
                let legs = legs.collect::<Option<_>>()?;
                let length = self.characteristic_length.as_ref().map(written);
                let characteristic_length = match (motion.turns(), length) {
                    (false, _) => None,
                    (true, Some(length)) => Some(length?),
                    // The unit of M, where nothing that is claimed depends on it.
                    (true, None) => Some(Expression::integer(1)),
                };
                let turning = |legs| Turning { legs, characteristic_length };
                match motion {
                    Motion::Translational => kernel::Mechanism::Translational(legs),
                    Motion::Planar { .. } => kernel::Mechanism::Planar(turning(legs)),
                    Motion::Spatial => kernel::Mechanism::Spatial(turning(legs)),
                    Motion::Spherical => kernel::Mechanism::Spherical(turning(legs)),
                }
            }
        };
        let workspace = match &self.workspace {
            Workspace::Box { min, max } => {
                kernel::Workspace::Box { min: all(min)?, max: all(max)? }
            }
            Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
                kernel::Workspace::Cylinder {
                    center: [written(x)?, written(y)?],
                    radius: written(radius)?,
                    z: [written(low)?, written(high)?],
                }
            }
            Workspace::Cube { side } => kernel::Workspace::Cube { side: written(side)? },
        };
        Some(kernel::MachineClaim {
            mechanism,
            workspace,
            orientation: self.orientation.clone(),
            bodies: self.kept_apart().to_vec(),
            require: self.require()?,
        })
    }

    /// The bodies that are to keep a distance; without one, a claim has none.
    fn kept_apart(&self) -> &[Body] {
        match self.demands.iter().any(|demand| demand.quantity == CLEARANCE) {
            true => &self.bodies,
            false => &[],
        }
    }

    /// What is demanded, in the order of the kernel's table of quantities, of all legs before each,
    /// from below before from above: in one order, whatever that of the file.
    fn require(&self) -> Option<Vec<kernel::Requirement>> {
        let mut require: Vec<_> = self.demands.iter().map(Demand::kernel).collect::<Option<_>>()?;
        if let Mechanism::OfCube { .. } = &self.mechanism {
            // psi_min = 1/psi_max, by definition.
            let psi_max = self.demands.iter().find_map(|demand| match &demand.bound {
                Bound::Max(max) if demand.quantity == TRANSMISSION => Some(max.clone()),
                _ => None,
            })?;
            let psi_min = Exact::integer(1).over(psi_max).ok()?;
            require.push(Demand::of(TRANSMISSION, Bound::Min(psi_min)).kernel()?);
        }
        require.sort_by_key(|requirement| {
            let key = requirement.quantity.as_str();
            let known = TABLE.iter().position(|quantity| quantity.key == key);
            let named = super::requirements::position(key);
            let end = matches!(requirement.bound, kernel::Bound::Max(_));
            (known.unwrap_or(TABLE.len()), named, requirement.leg, end)
        });
        Some(require)
    }
}

const TRANSMISSION: &str = "transmission";
/// The key of the one demand that is about bodies.
const CLEARANCE: &str = "clearance";

impl Demand {
    /// A bound on a quantity of the machine, or of every leg, which is for nothing in particular.
    pub fn of(quantity: &'static str, bound: Bound) -> Self {
        Demand { quantity, leg: None, given: Vec::new(), bound }
    }

    fn kernel(&self) -> Option<kernel::Requirement> {
        let given =
            self.given.iter().map(|(name, numbers)| Some(((*name).to_owned(), all(numbers)?)));
        Some(kernel::Requirement {
            quantity: self.quantity.to_owned(),
            leg: self.leg,
            given: given.collect::<Option<_>>()?,
            bound: match &self.bound {
                Bound::Min(min) => kernel::Bound::Min(written(min)?),
                Bound::Max(max) => kernel::Bound::Max(written(max)?),
                Bound::Within([min, max]) => kernel::Bound::Within([written(min)?, written(max)?]),
                Bound::Holds => kernel::Bound::Holds,
            },
        })
    }
}

fn all(numbers: &[Exact]) -> Option<Vec<Expression>> {
    numbers.iter().map(written).collect()
}

fn leg(leg: &Leg, in_plane: bool) -> Option<kernel::Leg> {
    let vector = |vector: &[leg::Quantity; 3]| -> Option<kernel::Vector> {
        vector.iter().take(if in_plane { 2 } else { 3 }).map(between).collect()
    };
    Some(match &leg.drive {
        leg::Leg::Slider { direction, anchor, platform, length, mode } => kernel::Leg::Slider {
            direction: vector(direction)?,
            anchor: vector(anchor)?,
            platform: vector(platform)?,
            length: between(length)?,
            mode: *mode,
        },
        leg::Leg::Strut { anchor, platform } => kernel::Leg::Strut {
            anchor: vector(anchor)?,
            platform: vector(platform)?,
            base_axis: match &leg.base_axis {
                Some(axis) => Some(vector(axis)?),
                None => None,
            },
        },
        leg::Leg::Arm { axis, reference, anchor, platform, arm, length, mode } => {
            kernel::Leg::Arm {
                axis: if in_plane { Vec::new() } else { vector(axis)? },
                reference: vector(reference)?,
                anchor: vector(anchor)?,
                platform: vector(platform)?,
                arm: between(arm)?,
                length: between(length)?,
                mode: *mode,
            }
        }
        leg::Leg::Planar { direction } => kernel::Leg::Planar { direction: vector(direction)? },
    })
}
