//! What a design file says, before it is a claim: numbers as they are written, and demands one by one.
//!
//! A machine with three legs that do not turn its platform, of which nothing is demanded but what the
//! rules know, becomes a [`Claim::Machine`](orthocert_checker::claim::Claim::Machine)
//! ([`Description::machine`]); every other one a claim of the kernel ([`Description::kernel`]).

use super::exactly::{between, written};
use super::leg::{self, WorkingMode};
use crate::exact::Exact;
use orthocert_checker::claim::{self as checker, AtLeast, AtMost, JointSpeed, Range};
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
    /// The claim that the rules take, if they do.
    pub fn machine(&self) -> Option<checker::MachineClaim> {
        if self.orientation.is_some() || !self.kept_apart().is_empty() {
            return None;
        }
        let mechanism = match &self.mechanism {
            Mechanism::OfCube { offset } => {
                checker::Mechanism::Orthoglide { offset: offset.clone() }
            }
            Mechanism::Legs { motion: Motion::Translational, legs } => {
                let plain = |leg: &Leg| leg.base_axis.is_none().then(|| leg.drive.clone());
                let legs: Vec<_> = legs.iter().map(plain).collect::<Option<_>>()?;
                checker::Mechanism::Translational(legs.try_into().ok()?)
            }
            Mechanism::Legs { .. } | Mechanism::Formulas(_) => return None,
        };
        let workspace = match &self.workspace {
            Workspace::Box { min, max } => checker::Workspace::Box {
                min: min.clone().try_into().ok()?,
                max: max.clone().try_into().ok()?,
            },
            Workspace::Cylinder { center, radius, z } => checker::Workspace::Cylinder {
                center: center.clone(),
                radius: radius.clone(),
                z: z.clone(),
            },
            Workspace::Cube { side } => checker::Workspace::Cube { side: side.clone() },
        };
        let mut requirements = checker::Requirements::default();
        for demand in &self.demands {
            demand.add_to(&mut requirements)?;
        }
        Some(checker::MachineClaim { mechanism, workspace, requirements })
    }

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
            // psi_min = 1/psi_max, which the rules' claim has by definition.
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

/// The claim of three legs that the rules take, in the kernel's vocabulary; `None` where a number is too
/// long for it.
pub fn in_the_kernel(claim: &checker::MachineClaim) -> Option<kernel::MachineClaim> {
    let mechanism = match &claim.mechanism {
        checker::Mechanism::Orthoglide { offset } => Mechanism::OfCube { offset: offset.clone() },
        checker::Mechanism::Translational(legs) => {
            let leg = |drive: &leg::Leg| Leg { drive: drive.clone(), base_axis: None };
            Mechanism::Legs { motion: Motion::Translational, legs: legs.iter().map(leg).collect() }
        }
    };
    let workspace = match claim.workspace.clone() {
        checker::Workspace::Box { min, max } => Workspace::Box { min: min.into(), max: max.into() },
        checker::Workspace::Cylinder { center, radius, z } => {
            Workspace::Cylinder { center, radius, z }
        }
        checker::Workspace::Cube { side } => Workspace::Cube { side },
    };
    let demands = demands(&claim.requirements, claim.mechanism.is_angular());
    let (orientation, bodies) = (None, Vec::new());
    let description = Description {
        mechanism,
        characteristic_length: None,
        workspace,
        orientation,
        bodies,
        demands,
    };
    description.kernel()
}

/// What the rules' requirements demand.
fn demands(requirements: &checker::Requirements, angular: bool) -> Vec<Demand> {
    let ends = |range: &Range| {
        let (min, max) = (range.min.clone(), range.max.clone());
        min.map(Bound::Min).into_iter().chain(max.map(Bound::Max)).collect::<Vec<_>>()
    };
    let mut all = Vec::new();
    let transmission = requirements.transmission.iter().flat_map(ends);
    all.extend(transmission.map(|bound| Demand::of(TRANSMISSION, bound)));
    for (i, range) in requirements.joint_range.iter().flatten().enumerate() {
        let bounds = match range.clone() {
            Range { min: Some(min), max: Some(max) } if angular => vec![Bound::Within([min, max])],
            _ => ends(range),
        };
        let of_leg = |bound| Demand { leg: Some(i + 1), ..Demand::of("joint_range", bound) };
        all.extend(bounds.into_iter().map(of_leg));
    }
    let greatest =
        [("conditioning", &requirements.conditioning), ("leg_angle", &requirements.leg_angle)];
    for (quantity, bound) in greatest {
        let bound = bound.iter().map(|bound| Bound::Max(bound.max.clone()));
        all.extend(bound.map(|bound| Demand::of(quantity, bound)));
    }
    let least = [
        ("serial_margin", &requirements.serial_margin),
        ("parallel_margin", &requirements.parallel_margin),
    ];
    for (quantity, bound) in least {
        let bound = bound.iter().map(|bound| Bound::Min(bound.min.clone()));
        all.extend(bound.map(|bound| Demand::of(quantity, bound)));
    }
    if let Some(JointSpeed { tool, max }) = &requirements.joint_speed {
        let given = vec![("tool", vec![tool.clone()])];
        all.push(Demand { given, ..Demand::of("joint_speed", Bound::Max(max.clone())) });
    }
    all
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

    /// Adds the demand to those that the rules know; `None` where it is not of these.
    fn add_to(&self, requirements: &mut checker::Requirements) -> Option<()> {
        let whole = |range: &mut Range| match &self.bound {
            Bound::Min(min) => range.min = Some(min.clone()),
            Bound::Max(max) => range.max = Some(max.clone()),
            Bound::Within([min, max]) => {
                *range = Range { min: Some(min.clone()), max: Some(max.clone()) };
            }
            Bound::Holds => {}
        };
        match (self.quantity, &self.bound, self.given.as_slice()) {
            (TRANSMISSION, ..) => {
                whole(requirements.transmission.get_or_insert(Range { min: None, max: None }));
            }
            ("joint_range", ..) => {
                let none = || std::array::from_fn(|_| Range { min: None, max: None });
                let ranges = requirements.joint_range.get_or_insert_with(none);
                match self.leg {
                    None => ranges.iter_mut().for_each(whole),
                    Some(leg) => whole(ranges.get_mut(leg.checked_sub(1)?)?),
                }
            }
            ("conditioning", Bound::Max(max), _) => {
                requirements.conditioning = Some(AtMost { max: max.clone() });
            }
            ("serial_margin", Bound::Min(min), _) => {
                requirements.serial_margin = Some(AtLeast { min: min.clone() });
            }
            ("parallel_margin", Bound::Min(min), _) => {
                requirements.parallel_margin = Some(AtLeast { min: min.clone() });
            }
            ("leg_angle", Bound::Max(max), _) => {
                requirements.leg_angle = Some(AtMost { max: max.clone() });
            }
            ("joint_speed", Bound::Max(max), [("tool", tool)]) => {
                let tool = tool.first()?.clone();
                requirements.joint_speed = Some(JointSpeed { tool, max: max.clone() });
            }
            _ => return None,
        }
        Some(())
    }
}

fn all(numbers: &[Exact]) -> Option<Vec<Expression>> {
    numbers.iter().map(written).collect()
}

fn leg(leg: &Leg, in_plane: bool) -> Option<kernel::Leg> {
    let vector = |vector: &[leg::Quantity; 3]| -> Option<kernel::Vector> {
        vector.iter().take(if in_plane { 2 } else { 3 }).map(between).collect()
    };
    let sign = |mode: WorkingMode| match mode {
        WorkingMode::Plus => kernel::Sign::Plus,
        WorkingMode::Minus => kernel::Sign::Minus,
    };
    Some(match &leg.drive {
        leg::Leg::Slider { direction, anchor, platform, length, mode } => kernel::Leg::Slider {
            direction: vector(direction)?,
            anchor: vector(anchor)?,
            platform: vector(platform)?,
            length: between(length)?,
            mode: sign(*mode),
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
                mode: sign(*mode),
            }
        }
        leg::Leg::Planar { direction } => kernel::Leg::Planar { direction: vector(direction)? },
    })
}
