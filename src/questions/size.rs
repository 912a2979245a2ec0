//! The smallest machine for a cube of a given side, with its edges along the axes.
//!
//! The unknown is the legs' length of an Orthoglide, or else the scale of the whole machine, with its
//! characteristic length; the set of orientations stays. The
//! admitted requirements do not depend on the unit of length, so `M(P)` of the machine of scale `s`
//! is that of the machine of scale 1 at `P/s`: a cube of side `a` with its centre at `s c` does for
//! scale `s` what one of side `a/s` with its centre at `c` does for scale 1. The latter are nested.
//! So for one `c` there is one threshold: certified for a scale means possible for every greater
//! one, and refuted for a scale means impossible, *for this placement*, for every smaller one.
//! [`Family::excluded`] shows the latter for every placement at once of a cube with its edges along
//! the axes: of turned cubes, which may fit a smaller machine, nothing is claimed.

use crate::exact::arithmetic::{apply, is_between, number};
use crate::questions::frontier::{
    approach, bracket, decimal, About, Approach, Approached, Bracket, NoAnswer, Succeeds,
};
use crate::questions::largest_cube::exclude;
use crate::questions::placement::{best_place, cube_about, is_endless, Centres, Placed};
use crate::questions::tolerance::parameters;
use crate::search::solver::approximate;
use crate::search::solver::value::depends_on_length;
use crate::search::{Budget, Control};
use num_rational::BigRational;
use num_traits::{FromPrimitive, ToPrimitive, Zero};
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::claim::{
    Bound, Leg, MachineClaim, Mechanism, Quantity, Requirement, Sign, Turning, Workspace,
};
use orthocert_kernel::number::{Expression, Operator};

const TRANSMISSION: &str = "transmission";
/// Share of the gap that is left between the size found and either end.
const SHARE: f64 = 0.4;
/// Significance of a placement, relative to the gap.
const PLACEMENT: f64 = 1e-4;

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
    pub centre: [BigRational; 3],
    /// Whether with more time a better place of the cube may have been found.
    pub out_of_time: bool,
    /// The size that the search in doubles expects.
    pub expected: f64,
    /// The machine of size one (for [`Unknown::LegLength`] up to the length).
    claim: MachineClaim,
    side: BigRational,
}

impl Family {
    /// The family of a claim, with the best placement of a cube of this side that is found within the budget;
    /// `gap` says how precisely it is looked for.
    ///
    /// # Errors
    /// If the requirements depend on the unit of length, or no placement is found.
    pub fn new(
        claim: &MachineClaim,
        side: &BigRational,
        gap: f64,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Self, NoAnswer> {
        let claim = as_box(claim)?;
        scale_free(&claim)?;
        let orthoglide = leg_length(&claim);
        let placed = placed(&claim, orthoglide.is_some(), gap * PLACEMENT, budget, control)?;
        let Placed { cube: place, out_of_time } = placed;
        let (unknown, own) = match orthoglide {
            Some(length) => (Unknown::LegLength, length),
            None => (Unknown::Scale, 1.0),
        };
        let expected = side.to_f64().unwrap_or(f64::NAN) * own / place.side;
        let centre = place.centre.map(|x| signed(x / own, gap * PLACEMENT * place.side / own));
        Ok(Family { unknown, centre, out_of_time, expected, claim, side: side.clone() })
    }

    /// The claim about the machine of size `x`, and its cube.
    pub fn claim(&self, x: &BigRational) -> Option<MachineClaim> {
        let centre = self.centre.each_ref().map(|c| c * x);
        let workspace = cube_about(&centre, &number(&self.side));
        Some(MachineClaim { workspace, ..self.machine(x)? })
    }

    /// The machine of size `x`, in the workspace of size 1.
    fn machine(&self, x: &BigRational) -> Option<MachineClaim> {
        let factor = number(x);
        let mut claim = self.claim.clone();
        let (legs, characteristic) = match &mut claim.mechanism {
            Mechanism::Translational(legs) => (legs, None),
            Mechanism::Spatial(turning) => {
                (&mut turning.legs, turning.characteristic_length.as_mut())
            }
            _ => return None,
        };
        if let Some(length) = characteristic {
            *length = apply(Operator::Mul, length, &factor);
        }
        for leg in legs {
            if let (Unknown::LegLength, Leg::Slider { length, .. }) = (self.unknown, &mut *leg) {
                *length = Quantity::Exactly(factor.clone());
                continue;
            }
            for (kind, quantity) in parameters(leg) {
                match quantity {
                    _ if kind.is_direction() => {}
                    Quantity::Exactly(x) => *x = apply(Operator::Mul, x, &factor),
                    Quantity::Between { min, max } => {
                        *min = apply(Operator::Mul, min, &factor);
                        *max = apply(Operator::Mul, max, &factor);
                    }
                }
            }
        }
        Some(claim)
    }

    /// The placements that [`Family::excluded`] is about; `None` if the one found is not among them.
    pub fn scope(&self) -> Option<Scope> {
        if self.unknown == Unknown::LegLength {
            return Some(Scope::Everywhere);
        }
        // That no cube fits is a claim about machines that do not turn their platform.
        if self.claim.orientation.is_some() {
            return None;
        }
        let [min, max] = bounding_box(&self.claim.workspace)?;
        let within =
            |((min, max), x): ((&Expression, &Expression), &BigRational)| is_between(x, [min, max]);
        min.iter().zip(&max).zip(&self.centre).all(within).then_some(Scope::Workspace)
    }

    /// The machine of size `x`, whose workspace is the box of the centres of [`Scope`].
    ///
    /// For an Orthoglide of leg length `x` that is `[-x, x]^3`. **Lemma.** Then no cube with another
    /// centre fits. *Proof.* Leg `i` reaches `P` only if the squares of the two coordinates of `P`
    /// across its guide, which lies on axis `i`, sum to at most `x^2`. Every coordinate is across
    /// some guide: at a centre with a coordinate beyond `[-x, x]`, a point of the cube, some leg is
    /// out of reach. ∎
    fn centres(&self, x: &BigRational) -> Option<MachineClaim> {
        let [min, max] = match self.scope()? {
            Scope::Everywhere => [vec![number(&-x); 3], vec![number(x); 3]],
            Scope::Workspace => {
                let factor = number(x);
                let times = |x: &Expression| apply(Operator::Mul, x, &factor);
                bounding_box(&self.claim.workspace)?.map(|end| end.iter().map(times).collect())
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
    ) -> Result<Approached<Box<Certificate>>, NoAnswer> {
        let side = number(&self.side);
        let to = Approach::from_afar(self.expected, Succeeds::Below, SHARE * gap);
        approach(&to, budget, control, |size, budget, control| match self.centres(size) {
            Some(claim) => exclude(&claim, &side, budget, control),
            None => Ok(None),
        })
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
        let about = About {
            expected: self.expected,
            holds: Succeeds::Above,
            share: SHARE,
            // Sampling sees little of many orientations: the size expected may be too small.
            is_sure: self.claim.orientation.is_none(),
            gap,
        };
        bracket(&about, |x| self.claim(x), budget, control)
    }
}

/// The least and the greatest coordinates of a workspace that is given by them; none of a cube.
fn bounding_box(workspace: &Workspace) -> Option<[Vec<Expression>; 2]> {
    match workspace {
        Workspace::Box { min, max } => Some([min.clone(), max.clone()]),
        Workspace::Cylinder { center, radius, z: [low, high] } => {
            let end = |operator, z: &Expression| {
                let around = center.iter().map(|x| apply(operator, x, radius));
                around.chain([z.clone()]).collect()
            };
            Some([end(Operator::Sub, low), end(Operator::Add, high)])
        }
        Workspace::Cube { .. } => None,
    }
}

/// The best place found for a cube, searched from a cube about the claim's workspace.
fn placed(
    claim: &MachineClaim,
    diagonal: bool,
    precision: f64,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Placed, NoAnswer> {
    let refused = |why: &str| NoAnswer::Claim(why.to_owned());
    let too_large = || refused("the design's numbers are too large");
    let [min, max] = bounding_box(&claim.workspace).ok_or_else(too_large)?;
    let ends = min.iter().zip(&max).map(|(min, max)| approximate(min).zip(approximate(max)));
    let ends = ends.collect::<Option<Vec<_>>>().ok_or_else(too_large)?;
    let width = ends.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    let width = if width > 0.0 { width } else { 1.0 };
    let middles = ends.iter().map(|(low, high)| BigRational::from_f64((low + high) / 2.0));
    let centre = middles.collect::<Option<Vec<_>>>().and_then(|x| <[_; 3]>::try_from(x).ok());
    let side = BigRational::from_f64(width).map(|width| number(&width));
    let workspace = centre.zip(side).map(|(centre, side)| cube_about(&centre, &side));
    let workspace = workspace.ok_or_else(too_large)?;
    let centres = if diagonal { Centres::Diagonal } else { Centres::Anywhere };
    let claim = MachineClaim { workspace, ..claim.clone() };
    let place = best_place(&claim, centres, precision, budget, control)?;
    let place = place.ok_or_else(|| {
        NoAnswer::unfit(
            "workspace",
            "no point at which every requirement holds, to put a cube there",
            "of size, a workspace that holds such a point",
        )
    })?;
    match is_endless(&place.cube, width) {
        true => Err(NoAnswer::unfit(
            "requirements",
            "none that ends a cube: they hold in cubes of any size",
            "of size, requirements that a machine of some size does not meet",
        )),
        false => Ok(place),
    }
}

/// The decimal near `x` with an error of at most `error`.
fn signed(x: f64, error: f64) -> BigRational {
    let size = x.abs();
    let value = if size <= error { None } else { decimal(size, error / size) };
    match value {
        Some(value) if x < 0.0 => -value,
        Some(value) => value,
        None => BigRational::zero(),
    }
}

/// The claim about legs in a box or a cylinder: an Orthoglide that the paper's cube defines becomes
/// one of leg length 1 with the bounds `1/psi_max` and `psi_max`.
fn as_box(claim: &MachineClaim) -> Result<MachineClaim, NoAnswer> {
    match &claim.mechanism {
        Mechanism::Translational(_) | Mechanism::Spatial(_) => return Ok(claim.clone()),
        Mechanism::Orthoglide { .. } => {}
        Mechanism::Planar(_) | Mechanism::Spherical(_) | Mechanism::Formulas(_) => {
            return Err(NoAnswer::unfit(
                "mechanism.kind",
                "a machine that is not moved in space by legs, so that no cube is in its workspace",
                "of size, kind \"orthoglide\", \"translational\" or \"spatial\"; limit says how far \
                 any number of a design goes",
            ))
        }
    }
    let number = Expression::integer;
    let legs = (0..3).map(|axis| Leg::Slider {
        direction: (0..3).map(|k| Quantity::Exactly(number(i64::from(k == axis)))).collect(),
        anchor: vec![Quantity::Exactly(number(0)); 3],
        platform: vec![Quantity::Exactly(number(0)); 3],
        length: Quantity::Exactly(number(1)),
        mode: Sign::Plus,
    });
    let mut require = claim.require.clone();
    require.retain(|own| own.quantity != TRANSMISSION || matches!(own.bound, Bound::Max(_)));
    let of_psi = |own: &Requirement| match &own.bound {
        Bound::Max(max) if own.quantity == TRANSMISSION => {
            let bound = Bound::Min(apply(Operator::Div, &number(1), max));
            Some(Requirement { bound, ..own.clone() })
        }
        _ => None,
    };
    require.extend(require.iter().find_map(of_psi));
    Ok(MachineClaim {
        mechanism: Mechanism::Translational(legs.collect()),
        workspace: Workspace::Box { min: vec![number(-1); 3], max: vec![number(1); 3] },
        require,
        ..claim.clone()
    })
}

/// Demands that what is required of a machine does not depend on the unit of length.
fn scale_free(claim: &MachineClaim) -> Result<(), NoAnswer> {
    let angular = match &claim.mechanism {
        Mechanism::Translational(legs) | Mechanism::Spatial(Turning { legs, .. }) => {
            legs.iter().any(|leg| matches!(leg, Leg::Arm { .. }))
        }
        _ => false,
    };
    let depends = |own: &&Requirement| depends_on_length(&own.quantity, angular);
    let Some(found) = claim.require.iter().find(depends) else { return Ok(()) };
    let of_arms = if found.quantity == "joint_range" || !angular { "" } else { " of arms" };
    Err(NoAnswer::unfit(
        &format!("requirements.{}", found.quantity),
        format!("{}{of_arms}, which does not scale with the machine", found.quantity),
        "of size, requirements that no unit of length enters",
    ))
}

/// The leg length, if the machine is an Orthoglide with equal legs of exact length, whose anchors
/// and offsets lie along the guides and so do not enter `M`.
fn leg_length(claim: &MachineClaim) -> Option<f64> {
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return None;
    };
    let is = |q: &Quantity, n: i64| match q {
        Quantity::Exactly(x) => x.rational() == Some(BigRational::from_integer(n.into())),
        Quantity::Between { .. } => false,
    };
    let mut common = None;
    for (axis, leg) in legs.iter().enumerate() {
        let Leg::Slider { direction, anchor, platform, length, mode: Sign::Plus } = leg else {
            return None;
        };
        let along = (0..3).all(|k| {
            let off_guide = k == axis || is(&anchor[k], 0) && is(&platform[k], 0);
            is(&direction[k], i64::from(k == axis)) && off_guide
        });
        let (Quantity::Exactly(length), true) = (length, along) else { return None };
        if common.is_some_and(|common| common != length) {
            return None;
        }
        common = Some(length);
    }
    approximate(common.filter(|_| legs.len() == 3)?)
}
