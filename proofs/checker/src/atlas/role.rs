//! Every number of a claim, and how the claim depends on it.

use crate::claim::{
    AtLeast, AtMost, JointSpeed, Leg, MachineClaim, Mechanism, Range, Requirements, Workspace,
};
use crate::number::Exact;
use std::array::from_fn;

/// How a claim depends on one of its numbers, the others being fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The least value of a parameter of the machine, all values of which are meant.
    Least,
    /// The greatest value of a parameter of the machine.
    Greatest,
    /// The greater the number, the more is claimed: a claim with a greater one implies it with a
    /// lesser one. Greatest coordinates and the radius of the workspace; lower bounds; the tool's
    /// speed.
    Strengthens,
    /// The greater the number, the less is claimed. Least coordinates; upper bounds.
    Weakens,
    /// Neither.
    Neutral,
}

impl MachineClaim {
    /// The claim with every number `x` replaced by `f(x, role)`.
    ///
    /// # Errors
    /// The first of `f`.
    pub fn try_map<E>(
        &self,
        f: &mut dyn FnMut(&Exact, Role) -> Result<Exact, E>,
    ) -> Result<MachineClaim, E> {
        Ok(MachineClaim {
            mechanism: mechanism(&self.mechanism, f)?,
            workspace: workspace(&self.workspace, f)?,
            requirements: requirements(&self.requirements, f)?,
        })
    }
}

type Mapping<'a, E> = &'a mut dyn FnMut(&Exact, Role) -> Result<Exact, E>;

fn mechanism<E>(mechanism: &Mechanism, f: Mapping<'_, E>) -> Result<Mechanism, E> {
    Ok(match mechanism {
        Mechanism::Translational(legs) => {
            let mut legs = legs.clone();
            for quantity in legs.iter_mut().flat_map(Leg::parameters_mut) {
                quantity.min = f(&quantity.min, Role::Least)?;
                quantity.max = f(&quantity.max, Role::Greatest)?;
            }
            Mechanism::Translational(legs)
        }
        Mechanism::Orthoglide { offset } => {
            Mechanism::Orthoglide { offset: f(offset, Role::Neutral)? }
        }
    })
}

fn workspace<E>(workspace: &Workspace, f: Mapping<'_, E>) -> Result<Workspace, E> {
    Ok(match workspace {
        Workspace::Box { min, max } => {
            let (mut min, mut max) = (min.clone(), max.clone());
            for x in &mut min {
                *x = f(x, Role::Weakens)?;
            }
            for x in &mut max {
                *x = f(x, Role::Strengthens)?;
            }
            Workspace::Box { min, max }
        }
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => Workspace::Cylinder {
            center: [f(x, Role::Neutral)?, f(y, Role::Neutral)?],
            radius: f(radius, Role::Strengthens)?,
            z: [f(low, Role::Weakens)?, f(high, Role::Strengthens)?],
        },
        Workspace::Cube { side } => Workspace::Cube { side: f(side, Role::Neutral)? },
    })
}

fn requirements<E>(all: &Requirements, f: Mapping<'_, E>) -> Result<Requirements, E> {
    let joint_range = match &all.joint_range {
        Some(ranges) => {
            let mut mapped: [Range; 3] = from_fn(|i| ranges[i].clone());
            for bounds in &mut mapped {
                *bounds = range(bounds, f)?;
            }
            Some(mapped)
        }
        None => None,
    };
    let transmission = match &all.transmission {
        Some(bounds) => Some(range(bounds, f)?),
        None => None,
    };
    Ok(Requirements {
        transmission,
        joint_range,
        conditioning: at_most(all.conditioning.as_ref(), f)?,
        serial_margin: at_least(all.serial_margin.as_ref(), f)?,
        parallel_margin: at_least(all.parallel_margin.as_ref(), f)?,
        leg_angle: at_most(all.leg_angle.as_ref(), f)?,
        joint_speed: match &all.joint_speed {
            Some(JointSpeed { tool, max }) => {
                Some(JointSpeed { tool: f(tool, Role::Strengthens)?, max: f(max, Role::Weakens)? })
            }
            None => None,
        },
    })
}

fn range<E>(range: &Range, f: Mapping<'_, E>) -> Result<Range, E> {
    let min = match &range.min {
        Some(min) => Some(f(min, Role::Strengthens)?),
        None => None,
    };
    let max = match &range.max {
        Some(max) => Some(f(max, Role::Weakens)?),
        None => None,
    };
    Ok(Range { min, max })
}

fn at_most<E>(bound: Option<&AtMost>, f: Mapping<'_, E>) -> Result<Option<AtMost>, E> {
    match bound {
        Some(AtMost { max }) => Ok(Some(AtMost { max: f(max, Role::Weakens)? })),
        None => Ok(None),
    }
}

fn at_least<E>(bound: Option<&AtLeast>, f: Mapping<'_, E>) -> Result<Option<AtLeast>, E> {
    match bound {
        Some(AtLeast { min }) => Ok(Some(AtLeast { min: f(min, Role::Strengthens)? })),
        None => Ok(None),
    }
}
