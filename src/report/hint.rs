//! What may have gone wrong in the design of a claim that is refuted.

use super::Counterexample;
use crate::exact::decimal::significant;
use crate::report::requirement::SINGULARITY;
use crate::search::solver::approximate;
use nalgebra::{Complex, Vector3};
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity, Workspace};
use orthocert_kernel::number::Expression;

/// A workspace that is so many times as long as a leg is not meant.
const OUT_OF_PROPORTION: f64 = 20.0;

/// What is to be told beside a counterexample.
pub fn hint(claim: &MachineClaim, found: &Counterexample) -> Option<String> {
    too_short(claim, found)
        .or_else(|| singular_everywhere(claim).map(|why| format!("{why}: singular at every pose")))
}

/// Legs that are far too short for the workspace: a number in another unit.
fn too_short(claim: &MachineClaim, found: &Counterexample) -> Option<String> {
    let legs = match &claim.mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Planar(machine) | Mechanism::Spatial(machine) => &machine.legs,
        Mechanism::Orthoglide { .. } | Mechanism::Spherical(_) | Mechanism::Formulas(_) => {
            return None;
        }
    };
    let across = across(&claim.workspace)?;
    let lengths = legs.iter().map(reach).enumerate();
    let (leg, length) = lengths
        .filter_map(|(leg, length)| Some((leg + 1, length?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (found.rule == SINGULARITY && across > OUT_OF_PROPORTION * length).then(|| {
        format!(
            "leg {leg} reaches {} from its joint, and the workspace is {} across: are all lengths in \
             one unit?",
            significant(length, 4),
            significant(across, 4)
        )
    })
}

/// How far a leg of fixed length reaches.
fn reach(leg: &Leg) -> Option<f64> {
    let greatest = |x: &Quantity| match x {
        Quantity::Exactly(x) | Quantity::Between { max: x, .. } => approximate(x),
    };
    match leg {
        Leg::Slider { length, .. } => greatest(length),
        Leg::Arm { arm, length, .. } => Some(greatest(arm)? + greatest(length)?),
        _ => None,
    }
}

/// The diagonal of the box around a workspace.
fn across(workspace: &Workspace) -> Option<f64> {
    let edges: Vec<f64> = match workspace {
        Workspace::Box { min, max } => {
            let edge = |(min, max): (&Expression, &Expression)| {
                Some(approximate(max)? - approximate(min)?)
            };
            min.iter().zip(max).map(edge).collect::<Option<_>>()?
        }
        Workspace::Cylinder { radius, z, .. } => {
            let across = 2.0 * approximate(radius)?;
            vec![across, across, approximate(&z[1])? - approximate(&z[0])?]
        }
        Workspace::Cube { .. } => return None,
    };
    Some(edges.iter().map(|edge| edge * edge).sum::<f64>().sqrt())
}

/// Why a platform that turns has no pose at which it is regular, where that is seen from its joints.
fn singular_everywhere(claim: &MachineClaim) -> Option<String> {
    let (legs, freedoms) = match &claim.mechanism {
        Mechanism::Spatial(machine) => (&machine.legs, 6),
        Mechanism::Planar(machine) if claim.orientation.is_some() => (&machine.legs, 3),
        _ => return None,
    };
    let joints = |on| legs.iter().map(|leg| joint(leg, on)).collect::<Option<Vec<Joint>>>();
    let platform = joints(true)?;
    let struts = legs.iter().all(|leg| matches!(leg, Leg::Strut { .. }));
    let base = joints(false).filter(|_| struts);
    // About the joints of a platform it turns freely; with legs that are struts, about those of the base.
    let all = [("platform", Some(&platform)), ("base", base.as_ref())];
    for (body, joints) in all.into_iter().filter_map(|(body, joints)| Some((body, joints?))) {
        match spread(joints) {
            0 => return Some(format!("all joints on the {body} are one point")),
            1 if freedoms == 6 => return Some(format!("all joints on the {body} are on one line")),
            _ => {}
        }
    }
    let similar = freedoms == 6 && is_similar(&base?, &platform);
    similar.then(|| "the joints on the platform are a scaled copy of those on the base".to_owned())
}

type Joint = Vector3<f64>;

/// A leg's joint on the platform or on the base, where it has no tolerance.
fn joint(leg: &Leg, on_platform: bool) -> Option<Joint> {
    let point = match leg {
        Leg::Planar { .. } => return None,
        Leg::Strut { anchor, platform, .. }
        | Leg::Slider { anchor, platform, .. }
        | Leg::Arm { anchor, platform, .. } => [anchor, platform][usize::from(on_platform)],
    };
    let mut joint = Joint::zeros();
    for (x, quantity) in joint.iter_mut().zip(point) {
        let Quantity::Exactly(number) = quantity else { return None };
        *x = approximate(number)?;
    }
    Some(joint)
}

/// Of a coordinate beside the greatest, what is taken for rounding.
const ROUNDING: f64 = 1e-12;

/// The dimension of the least point, line or plane that has all these joints; 2 of space also.
fn spread(joints: &[Joint]) -> usize {
    let off: Vec<Joint> = joints.iter().map(|x| x - joints[0]).collect();
    let size = joints.iter().map(Joint::amax).fold(0.0, f64::max);
    let Some(far) = off.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())) else { return 0 };
    if far.norm() <= ROUNDING * size {
        0
    } else if off.iter().all(|x| x.cross(far).norm() <= ROUNDING * size * far.norm()) {
        1
    } else {
        2
    }
}

/// Whether the platform's joints are the base's, scaled, turned and moved in their plane.
fn is_similar(base: &[Joint], platform: &[Joint]) -> bool {
    let is_flat = |joints: &[Joint]| joints.iter().all(|x| x.z == joints[0].z);
    let off = |joints: &[Joint]| -> Vec<Complex<f64>> {
        joints.iter().map(|x| Complex::new(x.x - joints[0].x, x.y - joints[0].y)).collect()
    };
    let (a, b) = (off(base), off(platform));
    let far = (0..a.len()).max_by(|&i, &j| a[i].norm_sqr().total_cmp(&a[j].norm_sqr()));
    let Some(far) = far.filter(|_| is_flat(base) && is_flat(platform)) else { return false };
    let (scale, size) = (b[far] / a[far], b[far].norm_sqr());
    a.iter().zip(&b).all(|(a, b)| (a * scale - b).norm_sqr() <= ROUNDING * ROUNDING * size)
}
