//! The smallest machine for a cube of a given side.
//!
//! The unknown is the legs' length of an Orthoglide, or else the scale of the whole machine. The
//! admitted requirements do not depend on the unit of length, so `M(P)` of the machine of scale `s`
//! is that of the machine of scale 1 at `P/s`: a cube of side `a` with its centre at `s c` does for
//! scale `s` what one of side `a/s` with its centre at `c` does for scale 1. The latter are nested.
//! So for one `c` there is one threshold: certified for a scale means possible for every greater
//! one, and refuted for a scale means impossible, *for this placement*, for every smaller one.
//!
//! | module  | does                                      |
//! |---------|-------------------------------------------|
//! | `place` | looks for the best placement, in doubles  |

mod place;

use crate::decimal::approximate;
use crate::frontier::{decimal, frontier, proof, refutation, Bracket, NoAnswer, Succeeds, Walk};
use crate::search::{Budget, Control};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use orthocert_checker::claim::{
    Leg, MachineClaim, Mechanism, Quantity, Range, WorkingMode, Workspace,
};
use orthocert_checker::number::Exact;
use std::array::from_fn;

/// Share of the gap that is left between the size found and either end.
const SHARE: f64 = 0.4;
/// Significance of a placement, relative to the gap.
const PLACEMENT: f64 = 1e-3;
/// Sizes tried, relative to the one found.
const SPREAD: f64 = 100.0;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The leg length of an Orthoglide with three equal legs.
    LegLength,
    /// The factor of all lengths and coordinates of the machine.
    Scale,
}

/// A family of machines, one for every size, and where each has its cube.
#[derive(Clone, Debug)]
pub struct Family {
    /// What the size is.
    pub unknown: Unknown,
    /// The cube's centre for the size one; for size `x` it is `x` times this.
    pub centre: [Exact; 3],
    /// The size that the search in doubles expects.
    pub expected: f64,
    /// The machine of size one (for [`Unknown::LegLength`] up to the length).
    claim: MachineClaim,
    side: BigRational,
}

impl Family {
    /// The family of a claim, with the best placement found of a cube of this side; `gap` says how
    /// precisely it is looked for.
    ///
    /// # Errors
    /// If the requirements depend on the unit of length, or no placement is found.
    pub fn new(claim: &MachineClaim, side: &BigRational, gap: f64) -> Result<Self, NoAnswer> {
        let claim = as_box(claim)?;
        scale_free(&claim)?;
        let orthoglide = leg_length(&claim);
        let place = place::best_place(&claim, orthoglide.is_some(), gap * PLACEMENT)?;
        let (unknown, own) = match orthoglide {
            Some(length) => (Unknown::LegLength, length),
            None => (Unknown::Scale, 1.0),
        };
        let expected = side.to_f64().unwrap_or(f64::NAN) * own / place.side;
        let centre = place.centre.map(|x| signed(x / own, gap * PLACEMENT * place.side / own));
        Ok(Family { unknown, centre, expected, claim, side: side.clone() })
    }

    /// The claim about the machine of size `x`, and its cube. `None` where the numbers become too
    /// large.
    pub fn claim(&self, x: &BigRational) -> Option<MachineClaim> {
        let factor = Exact::Rational(x.clone());
        let mut claim = self.claim.clone();
        let Mechanism::Translational(legs) = &mut claim.mechanism else {
            return None;
        };
        for leg in legs {
            if let (Unknown::LegLength, Leg::Slider { length, .. }) = (self.unknown, &mut *leg) {
                *length = Quantity::exactly(factor.clone());
                continue;
            }
            let directions: Vec<bool> =
                leg.parameters().iter().map(|(name, _)| name.is_direction()).collect();
            for (_, quantity) in
                directions.into_iter().zip(leg.parameters_mut()).filter(|(direction, _)| !direction)
            {
                let end = |x: &Exact| x.clone().times(factor.clone()).ok();
                *quantity = Quantity { min: end(&quantity.min)?, max: end(&quantity.max)? };
            }
        }
        let half = Exact::Rational(&self.side / BigRational::from_integer(2.into()));
        let [centre_x, centre_y, centre_z] = self.centre.each_ref();
        let at = |centre: &Exact| centre.clone().times(factor.clone()).ok();
        let centre = [at(centre_x)?, at(centre_y)?, at(centre_z)?];
        let (mut min, mut max) = (centre.clone(), centre.clone());
        for k in 0..3 {
            min[k] = centre[k].clone().minus(half.clone()).ok()?;
            max[k] = centre[k].clone().plus(half.clone()).ok()?;
        }
        claim.workspace = Workspace::Box { min, max };
        Some(claim)
    }

    /// Encloses the smallest size whose cube can be certified, to a relative width of `gap`, or as
    /// near to it as the budget allows.
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn smallest(
        &self,
        gap: f64,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Bracket, NoAnswer> {
        let walk = Walk {
            start: self.expected * (1.0 + SHARE * gap),
            succeeds: Succeeds::Above,
            factor: 1.0 + gap,
            improve: false,
            limits: (self.expected / SPREAD, self.expected * SPREAD),
            gap,
            deadline: budget.deadline,
        };
        let certified = frontier(&walk, |x| match self.claim(x) {
            Some(claim) => proof(&claim, budget, control),
            None => Ok(None),
        })?;
        let start = self.expected * (1.0 - SHARE * gap);
        let walk = Walk { start, succeeds: Succeeds::Below, ..walk };
        let refuted = frontier(&walk, |x| match self.claim(x) {
            Some(claim) => refutation(&claim, control),
            None => Ok(None),
        })?;
        Ok(Bracket { certified, refuted })
    }
}

/// The decimal near `x` with an error of at most `error`.
fn signed(x: f64, error: f64) -> Exact {
    let size = x.abs();
    let value = if size <= error { None } else { decimal(size, error / size) };
    match value {
        Some(value) if x < 0.0 => Exact::Rational(-value),
        Some(value) => Exact::Rational(value),
        None => Exact::integer(0),
    }
}

/// The claim about three legs in a box: an Orthoglide that the paper's cube defines becomes one of
/// leg length 1 with the bounds `1/psi_max` and `psi_max`.
fn as_box(claim: &MachineClaim) -> Result<MachineClaim, NoAnswer> {
    let Mechanism::Orthoglide { .. } = &claim.mechanism else {
        return Ok(claim.clone());
    };
    let number = |n| Quantity::exactly(Exact::integer(n));
    let legs = from_fn(|axis| Leg::Slider {
        direction: from_fn(|k| number(i64::from(k == axis))),
        anchor: from_fn(|_| number(0)),
        platform: from_fn(|_| number(0)),
        length: number(1),
        mode: WorkingMode::Plus,
    });
    let mut requirements = claim.requirements.clone();
    let max = requirements.transmission.take().and_then(|range| range.max);
    let min = max.clone().and_then(|max| Exact::integer(1).over(max).ok());
    requirements.transmission = Some(Range { min, max });
    Ok(MachineClaim {
        mechanism: Mechanism::Translational(legs),
        workspace: Workspace::Box {
            min: from_fn(|_| Exact::integer(-1)),
            max: from_fn(|_| Exact::integer(1)),
        },
        requirements,
    })
}

/// Demands that what is required of a machine does not depend on the unit of length.
fn scale_free(claim: &MachineClaim) -> Result<(), NoAnswer> {
    let requirements = &claim.requirements;
    let angular = claim.mechanism.is_angular();
    let found = if requirements.joint_range.is_some() {
        "joint_range, which"
    } else if angular && requirements.transmission.is_some() {
        "transmission of arms, which"
    } else if angular && requirements.joint_speed.is_some() {
        "joint_speed of arms, which"
    } else {
        return Ok(());
    };
    Err(NoAnswer::Claim(format!(
        "requirements: found {found} does not scale with the machine; accepted: requirements that \
         no unit of length enters"
    )))
}

/// The leg length, if the machine is an Orthoglide with equal legs of exact length, whose anchors
/// and offsets lie along the guides and so do not enter `M`.
fn leg_length(claim: &MachineClaim) -> Option<f64> {
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return None;
    };
    let mut common = None;
    for (axis, leg) in legs.iter().enumerate() {
        let Leg::Slider { direction, anchor, platform, length, mode: WorkingMode::Plus } = leg
        else {
            return None;
        };
        let is = |q: &Quantity, n| *q == Quantity::exactly(Exact::integer(n));
        let along = (0..3).all(|k| {
            let off_guide = k == axis || is(&anchor[k], 0) && is(&platform[k], 0);
            is(&direction[k], i64::from(k == axis)) && off_guide
        });
        if !along || !length.is_exact() || common.is_some_and(|common| common != length) {
            return None;
        }
        common = Some(length);
    }
    approximate(&common?.min)
}

/// Whether a number can be the side of a cube.
pub fn is_side(side: &BigRational) -> bool {
    side.is_positive() && side.to_f64().is_some_and(|x| (1e-100..1e100).contains(&x))
}
