//! The smallest machine for a cube of a given side, with its edges along the axes.
//!
//! The unknown is the legs' length of an Orthoglide, or else the scale of the whole machine. The
//! admitted requirements do not depend on the unit of length, so `M(P)` of the machine of scale `s`
//! is that of the machine of scale 1 at `P/s`: a cube of side `a` with its centre at `s c` does for
//! scale `s` what one of side `a/s` with its centre at `c` does for scale 1. The latter are nested.
//! So for one `c` there is one threshold: certified for a scale means possible for every greater
//! one, and refuted for a scale means impossible, *for this placement*, for every smaller one.
//! [`Family::excluded`] shows the latter for every placement at once of a cube with its edges along
//! the axes: of turned cubes, which may fit a smaller machine, nothing is claimed.

use crate::decimal::approximate;
use crate::frontier::{
    decimal, frontier, proof, refutation, Bracket, Certified, NoAnswer, Succeeds, Walk,
    LARGEST_FACTOR,
};
use crate::largest_cube::exclude;
use crate::placement::{best_place, cube_about, is_endless, Centres, Cube};
use crate::search::{Budget, Control};
use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed, ToPrimitive};
use orthocert_checker::claim::{
    Leg, MachineClaim, Mechanism, Quantity, Range, WorkingMode, Workspace,
};
use orthocert_checker::number::Exact;
use std::array::from_fn;

/// Share of the gap that is left between the size found and either end.
const SHARE: f64 = 0.4;
/// Significance of a placement, relative to the gap.
const PLACEMENT: f64 = 1e-4;
/// Sizes tried, relative to the one found.
const SPREAD: f64 = 100.0;
/// How far below the size found every axis-aligned placement is excluded first, and what this is divided by
/// while that succeeds.
const EXCLUDED: (f64, f64) = (0.1, 10.0);

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The leg length of an Orthoglide with three equal legs.
    LegLength,
    /// The factor of all lengths and coordinates of the machine.
    Scale,
}

/// Which placements of the cube, with its edges along the axes, it is proved about a size that they
/// are impossible for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Every axis-aligned one.
    Everywhere,
    /// Those with the centre in the workspace's bounding box, which is scaled with the machine.
    Workspace,
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
        let place = placed(&claim, orthoglide.is_some(), gap * PLACEMENT)?;
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
        let centre = scaled(&self.centre, &Exact::Rational(x.clone()))?;
        let workspace = cube_about(&centre, &Exact::Rational(self.side.clone())).ok()?;
        Some(MachineClaim { workspace, ..self.machine(x)? })
    }

    /// The machine of size `x`, in the workspace of size 1.
    fn machine(&self, x: &BigRational) -> Option<MachineClaim> {
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
        Some(claim)
    }

    /// The placements that [`Family::excluded`] is about; `None` if the one found is not among them.
    pub fn scope(&self) -> Option<Scope> {
        if self.unknown == Unknown::LegLength {
            return Some(Scope::Everywhere);
        }
        let (min, max) = self.claim.workspace.bounding_box().ok()?;
        let at_most = |x: &Exact, y: &Exact| x.compare(y).is_some_and(std::cmp::Ordering::is_le);
        let within =
            |k: usize| at_most(&min[k], &self.centre[k]) && at_most(&self.centre[k], &max[k]);
        (0..3).all(within).then_some(Scope::Workspace)
    }

    /// The machine of size `x`, whose workspace is the box of the centres of [`Scope`].
    ///
    /// For an Orthoglide of leg length `x` that is `[-x, x]^3`. **Lemma.** Then no cube with another
    /// centre fits. *Proof.* Leg `i` reaches `P` only if the squares of the two coordinates of `P`
    /// across its guide, which lies on axis `i`, sum to at most `x^2`. Every coordinate is across
    /// some guide: at a centre with a coordinate beyond `[-x, x]`, a point of the cube, some leg is
    /// out of reach. ∎
    fn centres(&self, x: &BigRational) -> Option<MachineClaim> {
        let factor = Exact::Rational(x.clone());
        let (min, max) = match self.scope()? {
            Scope::Everywhere => {
                (from_fn(|_| factor.clone().negated()), from_fn(|_| factor.clone()))
            }
            Scope::Workspace => {
                let (min, max) = self.claim.workspace.bounding_box().ok()?;
                (scaled(&min, &factor)?, scaled(&max, &factor)?)
            }
        };
        Some(MachineClaim { workspace: Workspace::Box { min, max }, ..self.machine(x)? })
    }

    /// The greatest size for which it is proved that none of the placements of [`Family::scope`] is
    /// possible, nor for any smaller size: as near to the size expected as `gap` and the budget
    /// allow. `None` where nothing of the kind is proved.
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn excluded(
        &self,
        gap: f64,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Option<Certified>, NoAnswer> {
        let side = Exact::Rational(self.side.clone());
        let (mut best, mut below) = (None, EXCLUDED.0);
        // A size far below is excluded by few boxes, and what fails costs most.
        loop {
            let share = f64::max(below, SHARE * gap);
            let Some(size) = decimal(self.expected * (1.0 - share), gap) else { break };
            let Some(claim) = self.centres(&size) else { break };
            match exclude(&claim, &side, budget, control)? {
                Some(certificate) => best = Some((size, certificate)),
                None => break,
            }
            if share > below {
                break;
            }
            below /= EXCLUDED.1;
        }
        Ok(best)
    }

    /// Encloses the smallest size whose cube can be certified at the place found, to a relative width
    /// of `gap`, or as near to it as the budget allows.
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
            most: LARGEST_FACTOR,
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

/// `x` times `factor`; `None` where the numbers become too large.
fn scaled(x: &[Exact; 3], factor: &Exact) -> Option<[Exact; 3]> {
    let [a, b, c] = x.each_ref().map(|x| x.clone().times(factor.clone()).ok());
    Some([a?, b?, c?])
}

/// The best place found for a cube, searched from a cube about the claim's workspace.
fn placed(claim: &MachineClaim, diagonal: bool, precision: f64) -> Result<Cube, NoAnswer> {
    let refused = |why: &str| NoAnswer::Claim(why.to_owned());
    let too_large = || refused("the design's numbers are too large");
    let (min, max) = claim.workspace.bounding_box()?;
    let ends = |k: usize| approximate(&min[k]).zip(approximate(&max[k]));
    let ends = [ends(0), ends(1), ends(2)].into_iter().collect::<Option<Vec<_>>>();
    let ends = ends.ok_or_else(too_large)?;
    let width = ends.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    let width = if width > 0.0 { width } else { 1.0 };
    let number = |x: f64| BigRational::from_f64(x).map(Exact::Rational).ok_or_else(too_large);
    let middle = |k: usize| number((ends[k].0 + ends[k].1) / 2.0);
    let workspace = cube_about(&[middle(0)?, middle(1)?, middle(2)?], &number(width)?);
    let workspace = workspace.map_err(|_| too_large())?;
    let centres = if diagonal { Centres::Diagonal } else { Centres::Anywhere };
    let place = best_place(&MachineClaim { workspace, ..claim.clone() }, centres, precision)?;
    let place = place.ok_or_else(|| {
        refused(
            "no point of the workspace was found at which every requirement holds, to put a cube \
             there; accepted: a design whose workspace holds such a point",
        )
    })?;
    match is_endless(&place, width) {
        true => {
            Err(refused("the requirements hold in cubes of any size: there is no smallest machine"))
        }
        false => Ok(place),
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
