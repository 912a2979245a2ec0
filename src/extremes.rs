//! Certified extremes: how small and how large each quantity gets over the workspace.
//!
//! An extreme is enclosed by two certificates. The outer end is a bound that is *proved*: the claim
//! "the quantity stays within it" is certified. The inner end is a bound that is *refuted*, by a
//! witness: the point, and the machine within the tolerances, at which the quantity goes beyond
//! it. The searches for both are those of [`crate::verify`]; only the claims are new.

use crate::interval::{Approx, Interval};
use crate::refute::witness_at;
use crate::sample::{Place, Quality, Sampler};
use crate::search::{prove, Budget, Control, Stop};
use crate::verify::{accepted, certificate, look_into, verify, Answer, Worst};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, Zero};
use orthocert_checker::certificate::{Certificate, Proof, Tree, Verdict};
use orthocert_checker::claim::{
    AtLeast, AtMost, Claim, ClaimError, JointSpeed, Leg, MachineClaim, Mechanism, Range,
    Requirements, Workspace,
};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::number::Exact;

/// Fractional bits in which the claim's numbers are enclosed for sampling.
const PRECISION: u32 = 192;
/// Finest step of the search for an extreme.
const FINEST: i32 = 30;
/// Open boxes from whose centres a better inner end is looked for.
const OPEN_CENTRES: usize = 8;
/// How often a better inner end may turn up before the search is given up.
const ROUNDS: usize = 8;

/// A quantity whose extremes are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Extreme {
    /// The least `psi_i`.
    LeastPsi,
    /// The greatest `psi_i`.
    GreatestPsi,
    /// The greatest `sigma_max / sigma_min`.
    Conditioning,
    /// The least `|eta_i| / L_i` of any leg.
    SerialMargin,
    /// The least `|det A| / (L_1 L_2 L_3)`.
    ParallelMargin,
    /// The least `rho_i` of this leg, from zero.
    LeastRho(usize),
    /// The greatest `rho_i` of this leg, from zero.
    GreatestRho(usize),
    /// The greatest angle between a leg and its guide, in degrees.
    LegAngle,
    /// The greatest joint speed per tool speed.
    JointSpeed,
}

/// An extreme, enclosed from both sides.
#[derive(Clone, Debug)]
pub struct Enclosed {
    /// Which one.
    pub extreme: Extreme,
    /// The relative width.
    pub width: BigRational,
    /// The quantity goes beyond this (certified by a witness).
    pub inner: Exact,
    /// The quantity never goes beyond this (certified by a tree).
    pub outer: Exact,
    /// The certificate of the inner end: "stays within `inner`" is refuted. `None` where the inner end
    /// holds by definition: no condition number is less than 1.
    pub refuted: Option<Box<Certificate>>,
    /// The certificate of the outer end: "stays within `outer`" is certified.
    pub certified: Box<Certificate>,
    /// Boxes tried for the outer end.
    pub boxes: usize,
}

/// Why an extreme is not enclosed.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NotEnclosed {
    /// Some machine has a singularity, or a point out of reach, in the workspace.
    #[error("none: a singularity, or out of reach, inside")]
    Singular,
    /// Neither a proof nor a refutation was found within the budget.
    #[error("not enclosed within the budget")]
    Undecided,
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// The claim is not well formed.
    #[error(transparent)]
    Claim(#[from] ClaimError),
}

impl Extreme {
    /// The extremes that a machine has, in the order of reports; for the paper's cube without those
    /// of `psi`, which are `1/psi_max` and `psi_max` by the claim itself.
    pub fn of(claim: &MachineClaim) -> Vec<Extreme> {
        let mut all = vec![
            Extreme::LeastPsi,
            Extreme::GreatestPsi,
            Extreme::Conditioning,
            Extreme::SerialMargin,
            Extreme::ParallelMargin,
        ];
        for leg in 0..3 {
            all.extend([Extreme::LeastRho(leg), Extreme::GreatestRho(leg)]);
        }
        all.extend([Extreme::LegAngle, Extreme::JointSpeed]);
        if matches!(claim.workspace, Workspace::Cube { .. }) {
            all.retain(|extreme| !matches!(extreme, Extreme::LeastPsi | Extreme::GreatestPsi));
        }
        if let Mechanism::Translational(legs) = &claim.mechanism {
            let lengths = legs.iter().all(Leg::has_length);
            let guides = legs.iter().all(|leg| matches!(leg, Leg::Slider { .. }));
            let angular = claim.mechanism.is_angular();
            all.retain(|extreme| match extreme {
                Extreme::SerialMargin => lengths,
                Extreme::LegAngle => guides,
                // Ranges of angles need both ends, so one end alone is no claim.
                Extreme::LeastRho(_) | Extreme::GreatestRho(_) => !angular,
                _ => true,
            });
        }
        all
    }

    /// The extremes that the claim's requirements bound, but for those that the paper's cube has by
    /// definition.
    pub fn bounded(claim: &MachineClaim) -> Vec<Extreme> {
        let Requirements { transmission, joint_range, .. } = &claim.requirements;
        let psi = transmission.as_ref();
        let rho = |leg: usize| joint_range.as_ref().and_then(|ranges| ranges.get(leg));
        let mut all = Extreme::of(claim);
        all.retain(|extreme| match *extreme {
            Extreme::LeastPsi => psi.is_some_and(|range| range.min.is_some()),
            Extreme::GreatestPsi => psi.is_some_and(|range| range.max.is_some()),
            Extreme::LeastRho(leg) => rho(leg).is_some_and(|range| range.min.is_some()),
            Extreme::GreatestRho(leg) => rho(leg).is_some_and(|range| range.max.is_some()),
            Extreme::Conditioning => claim.requirements.conditioning.is_some(),
            Extreme::SerialMargin => claim.requirements.serial_margin.is_some(),
            Extreme::ParallelMargin => claim.requirements.parallel_margin.is_some(),
            Extreme::LegAngle => claim.requirements.leg_angle.is_some(),
            Extreme::JointSpeed => claim.requirements.joint_speed.is_some(),
        });
        all
    }

    /// The quantity's name in tables.
    pub fn quantity(self) -> String {
        match self {
            Extreme::LeastPsi | Extreme::GreatestPsi => "psi".into(),
            Extreme::Conditioning => "sigma_max/sigma_min".into(),
            Extreme::SerialMargin => "|eta_i|/L_i".into(),
            Extreme::ParallelMargin => "|det A|/(L1 L2 L3)".into(),
            Extreme::LegAngle => "leg angle".into(),
            Extreme::JointSpeed => "joint/tool speed".into(),
            Extreme::LeastRho(leg) | Extreme::GreatestRho(leg) => format!("rho_{}", leg + 1),
        }
    }

    /// The unit of its bounds, where it has one.
    pub fn unit(self, claim: &MachineClaim) -> Option<&'static str> {
        let angular = claim.mechanism.is_angular();
        match self {
            // Of a joint's speed by the tool's.
            Extreme::JointSpeed => angular.then_some("deg/length"),
            _ => self.qualities().first()?.unit(angular),
        }
    }

    /// Whether the quantity is bounded from above.
    pub fn is_greatest(self) -> bool {
        !matches!(
            self,
            Extreme::LeastPsi
                | Extreme::SerialMargin
                | Extreme::ParallelMargin
                | Extreme::LeastRho(_)
        )
    }

    fn qualities(self) -> Vec<Quality> {
        let every_leg = |quality: fn(usize) -> Quality| (0..3).map(quality).collect();
        match self {
            Extreme::LeastPsi => vec![Quality::LeastPsi],
            Extreme::GreatestPsi => vec![Quality::GreatestPsi],
            Extreme::Conditioning => vec![Quality::Conditioning],
            Extreme::SerialMargin => every_leg(Quality::SerialMargin),
            Extreme::ParallelMargin => vec![Quality::ParallelMargin],
            Extreme::LeastRho(leg) => vec![Quality::LeastRho(leg)],
            Extreme::GreatestRho(leg) => vec![Quality::GreatestRho(leg)],
            Extreme::LegAngle => every_leg(Quality::LegAngle),
            Extreme::JointSpeed => every_leg(Quality::JointSpeed),
        }
    }

    /// "The quantity stays within `bound`", and nothing else.
    fn requirement(self, bound: Exact) -> Requirements {
        let mut requirements = Requirements::default();
        let range = |min, max| Some(Range { min, max });
        match self {
            Extreme::LeastPsi => requirements.transmission = range(Some(bound), None),
            Extreme::GreatestPsi => requirements.transmission = range(None, Some(bound)),
            Extreme::Conditioning => requirements.conditioning = Some(AtMost { max: bound }),
            Extreme::SerialMargin => requirements.serial_margin = Some(AtLeast { min: bound }),
            Extreme::ParallelMargin => requirements.parallel_margin = Some(AtLeast { min: bound }),
            Extreme::LegAngle => requirements.leg_angle = Some(AtMost { max: bound }),
            Extreme::JointSpeed => {
                let tool = Exact::integer(1);
                requirements.joint_speed = Some(JointSpeed { tool, max: bound });
            }
            Extreme::LeastRho(leg) | Extreme::GreatestRho(leg) => {
                let own = match self {
                    Extreme::LeastRho(_) => Range { min: Some(bound), max: None },
                    _ => Range { min: None, max: Some(bound) },
                };
                let far = BigInt::from(10).pow(30);
                let free = || Range {
                    min: None,
                    max: Some(Exact::Rational(BigRational::from_integer(far.clone()))),
                };
                let mut ranges = [free(), free(), free()];
                if let Some(range) = ranges.get_mut(leg) {
                    *range = own;
                }
                requirements.joint_range = Some(ranges);
            }
        }
        requirements
    }
}

/// Encloses an extreme of the claim's machines over its workspace, to the relative width
/// `relative`, or where that does not succeed to a looser one, up to [`loosest`] (for joint
/// coordinates and angles: relative to the greatest size that the quantity takes).
///
/// The claim's requirements are not used, but for the `psi_max` that defines the paper's cube.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn enclose(
    claim: &MachineClaim,
    extreme: Extreme,
    relative: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Enclosed, NotEnclosed> {
    let claim_with = |bound: Exact| demanding(claim, extreme.requirement(bound));
    let any = claim_with(Exact::integer(2));
    let model = Model::new(&any, PRECISION)?;
    let sampler = Sampler::new(&any, &model).ok_or(NotEnclosed::Undecided)?;
    let unit = Unit::of(claim, &model).ok_or(NotEnclosed::Undecided)?;
    let mut known = worst_place(&sampler, extreme);
    let mut width = relative.clone();
    while width <= loosest() {
        let mut looser = 2;
        for _ in 0..ROUNDS {
            let (quality, place) = &known;
            let found =
                value(&sampler, extreme, *quality, place, unit).ok_or(NotEnclosed::Singular)?;
            let step = &width * scale_of(extreme, found, &sampler, unit);
            let (inner, outer) = ends(extreme, found, &step).ok_or(NotEnclosed::Undecided)?;
            match certify(&claim_with(Exact::Rational(outer.clone())), extreme, budget, control)? {
                Attempt::Certified(certificate, boxes) => {
                    let refuted = if extreme == Extreme::Conditioning && inner.is_one() {
                        None
                    } else {
                        let claim = claim_with(Exact::Rational(inner.clone()));
                        Some(refute(&claim, *quality, place).ok_or(NotEnclosed::Undecided)?)
                    };
                    return Ok(Enclosed {
                        extreme,
                        width,
                        inner: Exact::Rational(inner),
                        outer: Exact::Rational(outer),
                        refuted,
                        certified: certificate,
                        boxes,
                    });
                }
                // A worse place than the one known: go on from there.
                Attempt::Worse(quality, place) => known = (quality, place),
                Attempt::Undecided(stop) => {
                    // A hopeless width costs little, so the next one is tried soon.
                    looser = if stop == Stop::Hopeless { 2 } else { 10 };
                    break;
                }
            }
        }
        width *= BigRational::from_integer(looser.into());
    }
    Err(NotEnclosed::Undecided)
}

/// Whether some machine of the claim has a singularity, or a point out of reach, in its workspace:
/// then quantities have no extremes there.
///
/// # Errors
/// If the claim is not well formed, or the search was cancelled.
pub fn is_singular(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<bool, NotEnclosed> {
    let regular = demanding(claim, Requirements::default());
    match verify(&regular, budget, control)?.answer {
        Answer::Decided { accepted, .. } => Ok(accepted.verdict == Verdict::Refuted),
        Answer::Undecided(_) => Ok(false),
        Answer::Cancelled => Err(NotEnclosed::Cancelled),
    }
}

/// The claim with other requirements, but for the `psi_max` that defines the paper's cube.
fn demanding(claim: &MachineClaim, mut requirements: Requirements) -> MachineClaim {
    if let Workspace::Cube { .. } = claim.workspace {
        let defining = claim.requirements.transmission.clone();
        requirements.transmission = requirements.transmission.or(defining);
    }
    MachineClaim { requirements, ..claim.clone() }
}

/// The width up to which an enclosure is loosened before it is given up.
pub fn loosest() -> BigRational {
    BigRational::new(1.into(), 10.into())
}

/// A bound that the value found goes beyond, and one that no value is expected to go beyond.
fn ends(extreme: Extreme, found: f64, step: &BigRational) -> Option<(BigRational, BigRational)> {
    let sign = BigRational::from_integer(if extreme.is_greatest() { 1 } else { -1 }.into());
    // Two thirds of the width on the outer side, where the proof needs room.
    let third = step * &sign / BigRational::from_integer(3.into());
    let found = BigRational::from_f64(found)?;
    let mut inner = rounded(&(&found - &third), step);
    let outer = rounded(&(&found + &third + &third), step);
    if extreme == Extreme::Conditioning {
        inner = inner.max(BigRational::one());
    }
    Some((inner, outer))
}

/// What became of the attempt to certify an outer end.
enum Attempt {
    Certified(Box<Certificate>, usize),
    /// The quantity goes beyond it here.
    Worse(Quality, Place),
    Undecided(Stop),
}

fn certify(
    claim: &MachineClaim,
    extreme: Extreme,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Attempt, NotEnclosed> {
    let model = Model::new(claim, PRECISION)?;
    let found = prove(&model.map(&Interval::from_fixed), budget, control);
    if found.stop == Stop::Cancelled {
        return Err(NotEnclosed::Cancelled);
    }
    if found.stop == Stop::Exhausted && found.open.is_empty() {
        let proof = |precision| Proof::Tree(Tree { precision, nodes: found.nodes.clone() });
        return Ok(match accepted(Claim::Machine(claim.clone()), proof) {
            Answer::Decided { certificate, .. } => Attempt::Certified(certificate, found.boxes),
            _ => Attempt::Undecided(Stop::Hopeless),
        });
    }
    let sampler = Sampler::new(claim, &model).ok_or(NotEnclosed::Undecided)?;
    let qualities = extreme.qualities().into_iter();
    let mut worst: Vec<Worst> =
        qualities.map(|quality| Worst::unknown(quality, &sampler)).collect();
    look_into(&sampler, &found.open, OPEN_CENTRES, &mut worst);
    worst.retain(|found| found.margin < 0.0);
    worst.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    Ok(match worst.into_iter().next() {
        Some(found) => Attempt::Worse(found.quality, found.place),
        None => Attempt::Undecided(found.stop),
    })
}

/// The model's units in the claim's.
#[derive(Clone, Copy)]
struct Unit {
    /// Of lengths.
    length: f64,
    /// Of `1/M`: one, or a length where joint coordinates are angles.
    inverse_row: f64,
    /// Of joint coordinates: one, or degrees in a radian.
    angle: f64,
}

impl Unit {
    fn of(claim: &MachineClaim, model: &Model<Fixed>) -> Option<Self> {
        let length = match (&claim.workspace, model.unit_exponent) {
            (_, Some(scale)) => (scale as f64).exp2(),
            (Workspace::Cube { side }, None) => {
                let psi_max = claim.requirements.transmission.as_ref()?.max.as_ref()?;
                let inverse = CubeConstants::new(psi_max, side).ok()?.inverse_length;
                1.0 / Approx::from_fixed(&inverse.enclose(0, PRECISION)?).0
            }
            _ => return None,
        };
        let (inverse_row, angle) = match claim.mechanism.is_angular() {
            true => (length, 1f64.to_degrees()),
            false => (1.0, 1.0),
        };
        Some(Unit { length, inverse_row, angle })
    }
}

/// The place at which the quantity is found to be most extreme.
fn worst_place(sampler: &Sampler, extreme: Extreme) -> (Quality, Place) {
    let grid = sampler.grid();
    let mut best: Option<(f64, Quality, Place)> = None;
    for quality in extreme.qualities() {
        let margin = |p: &Place| sampler.margin(quality, &sampler.at(p)).unwrap_or(f64::MAX);
        let mut starts: Vec<(f64, &Place)> = grid.iter().map(|p| (margin(p), p)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, start) in starts.into_iter().take(3) {
            let (margin, place) = sampler.descend(quality, start, FINEST);
            if best.as_ref().is_none_or(|(least, ..)| margin < *least) {
                best = Some((margin, quality, place));
            }
        }
    }
    match best {
        Some((_, quality, place)) => (quality, place),
        None => (Quality::Clearance, Place { u: [0.5; 3], t: Vec::new() }),
    }
}

/// The quantity's value at a place, in the claim's unit.
fn value(
    sampler: &Sampler,
    extreme: Extreme,
    quality: Quality,
    place: &Place,
    unit: Unit,
) -> Option<f64> {
    let value = sampler.value(quality, &sampler.at(place))?;
    Some(match extreme {
        Extreme::LeastRho(_) | Extreme::GreatestRho(_) => value * unit.length,
        Extreme::LeastPsi | Extreme::GreatestPsi => value * unit.inverse_row,
        Extreme::JointSpeed => value / unit.inverse_row * unit.angle,
        _ => value,
    })
}

/// What the width is relative to: the value itself, or for joint coordinates, which may be zero,
/// the size of the workspace's joint motion.
fn scale_of(extreme: Extreme, found: f64, sampler: &Sampler, unit: Unit) -> BigRational {
    let size = match extreme {
        Extreme::LeastRho(leg) | Extreme::GreatestRho(leg) => {
            let rho = |place: &Place| sampler.value(Quality::LeastRho(leg), &sampler.at(place));
            let all = sampler.grid();
            let sizes = all.iter().filter_map(rho).map(f64::abs);
            sizes.fold(found.abs() / unit.length, f64::max) * unit.length
        }
        _ => found.abs(),
    };
    BigRational::from_f64(size)
        .filter(|x| !x.is_zero())
        .unwrap_or_else(|| BigRational::from_integer(1.into()))
}

/// The decimal nearest to `x` on a grid of at most a hundredth of `step`.
fn rounded(x: &BigRational, step: &BigRational) -> BigRational {
    let ten = BigRational::from_integer(10.into());
    let mut grid = BigRational::from_integer(1.into());
    let wanted = step.abs() / BigRational::from_integer(100.into());
    while grid > wanted {
        grid /= &ten;
    }
    (x / &grid).round() * grid
}

/// A refutation of `claim` at a known place.
fn refute(claim: &MachineClaim, quality: Quality, place: &Place) -> Option<Box<Certificate>> {
    let model = Model::new(claim, PRECISION).ok()?;
    let sampler = Sampler::new(claim, &model)?;
    let witness = witness_at(claim, &sampler, quality, place)?;
    let proof = Proof::Witness(Box::new(witness));
    Some(Box::new(certificate(Claim::Machine(claim.clone()), Verdict::Refuted, proof)))
}
