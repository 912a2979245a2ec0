//! Whether one claim follows from another by comparing their numbers.

use orthocert_checker::claim::{
    AtLeast, AtMost, Claim, JointSpeed, Leg, MachineClaim, Mechanism, Quantity, Range,
    Requirements, Workspace,
};
use orthocert_checker::number::Exact;
use std::cmp::Ordering;

fn at_most(x: &Exact, y: &Exact) -> bool {
    matches!(x.compare(y), Some(Ordering::Less | Ordering::Equal))
}

/// `b` speaks of no more machines, points and bounds than `a`, so that `a` implies `b`.
pub fn follows(b: &Claim, a: &Claim) -> bool {
    match (b, a) {
        (Claim::Machine(b), Claim::Machine(a)) => {
            let same_cube = b.mechanism == a.mechanism
                && b.workspace == a.workspace
                && b.requirements.transmission == a.requirements.transmission;
            let within = fewer_machines(b, a) && smaller(&b.workspace, &a.workspace);
            (same_cube || within) && lesser(&b.requirements, &a.requirements)
        }
        _ => b == a,
    }
}

/// What proofs/README.md, section 3, proves by hand: claims on the paper's cube that ask for
/// `transmission` alone.
pub fn known(claim: &Claim) -> bool {
    let one = Exact::integer(1);
    let above_one = |x: &Exact| one.compare(x) == Some(Ordering::Less);
    match claim {
        Claim::Machine(claim) => {
            let Workspace::Cube { side } = &claim.workspace else { return false };
            let alone = Requirements {
                transmission: claim.requirements.transmission.clone(),
                ..Requirements::default()
            };
            let transmission = claim.requirements.transmission.as_ref();
            claim.requirements == alone
                && side.sign() == Some(1)
                && transmission
                    .is_some_and(|t| t.min.is_none() && t.max.as_ref().is_some_and(above_one))
        }
        Claim::Postulate(_) | Claim::NoCube(_) | Claim::Atlas(_) | Claim::Kernel(_) => false,
    }
}

fn fewer_machines(b: &MachineClaim, a: &MachineClaim) -> bool {
    let (Mechanism::Translational(b), Mechanism::Translational(a)) = (&b.mechanism, &a.mechanism)
    else {
        return false;
    };
    b.iter().zip(a).all(|(b, a)| fewer_legs(b, a))
}

fn fewer_legs(b: &Leg, a: &Leg) -> bool {
    let within = |b: &Quantity, a: &Quantity| at_most(&a.min, &b.min) && at_most(&b.max, &a.max);
    let (inner, outer) = (b.parameters(), a.parameters());
    b.same_kind(a) && inner.iter().zip(outer).all(|((_, b), (_, a))| within(b, a))
}

fn smaller(b: &Workspace, a: &Workspace) -> bool {
    match (b, a) {
        (Workspace::Box { min, max }, Workspace::Box { min: low, max: high }) => {
            (0..3).all(|k| at_most(&low[k], &min[k]) && at_most(&max[k], &high[k]))
        }
        (
            Workspace::Cylinder { center, radius, z },
            Workspace::Cylinder { center: about, radius: wide, z: long },
        ) => {
            let within = at_most(&long[0], &z[0]) && at_most(&z[1], &long[1]);
            center == about && at_most(radius, wide) && within
        }
        _ => false,
    }
}

/// Every bound of `b` is implied by one of `a`.
fn lesser(b: &Requirements, a: &Requirements) -> bool {
    let most = |b: &Option<AtMost>, a: &Option<AtMost>| {
        b.as_ref().is_none_or(|b| a.as_ref().is_some_and(|a| at_most(&a.max, &b.max)))
    };
    let least = |b: &Option<AtLeast>, a: &Option<AtLeast>| {
        b.as_ref().is_none_or(|b| a.as_ref().is_some_and(|a| at_most(&b.min, &a.min)))
    };
    let ranges = |b: &[Range; 3], a: &[Range; 3]| b.iter().zip(a).all(|(b, a)| wider(b, a));
    let transmission = b
        .transmission
        .as_ref()
        .is_none_or(|b| a.transmission.as_ref().is_some_and(|a| wider(b, a)));
    let joints =
        b.joint_range.as_ref().is_none_or(|b| a.joint_range.as_ref().is_some_and(|a| ranges(b, a)));
    let speed =
        b.joint_speed.as_ref().is_none_or(|b| a.joint_speed.as_ref().is_some_and(|a| slower(b, a)));
    transmission
        && joints
        && speed
        && most(&b.conditioning, &a.conditioning)
        && most(&b.leg_angle, &a.leg_angle)
        && least(&b.serial_margin, &a.serial_margin)
        && least(&b.parallel_margin, &a.parallel_margin)
}

fn wider(b: &Range, a: &Range) -> bool {
    let below = |b: &Option<Exact>, a: &Option<Exact>| {
        b.as_ref().is_none_or(|b| a.as_ref().is_some_and(|a| at_most(b, a)))
    };
    below(&b.min, &a.min)
        && b.max.as_ref().is_none_or(|b| a.max.as_ref().is_some_and(|a| at_most(a, b)))
}

/// `max/tool` of `a` is at most that of `b`.
fn slower(b: &JointSpeed, a: &JointSpeed) -> bool {
    let products = (a.max.clone().times(b.tool.clone()), b.max.clone().times(a.tool.clone()));
    matches!(products, (Ok(a), Ok(b)) if at_most(&a, &b))
}
