//! Certified extremes.
//!
//! An extreme lies between a bound that is certified and one that is refuted.

mod found;
mod outer;
mod width;

pub use width::{beyond, loosest, narrowest, of_one_width, rounded};

use super::extremes::Extreme;
use super::refute::witness_at;
use super::sample::{Place, Sampler, Worst};
use super::value::{alone, defining, of_sought};
use super::{refuted, verify, Answer};
use crate::search::{Budget, Control, Steps, Stop};
use found::{Found, FINEST, ROUGH};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::problem::Problem;
use outer::{Attempt, Attempts};
use width::{end, LOOSER};

/// How often a better inner end may turn up before the search is given up.
const ROUNDS: usize = 8;

/// An extreme, enclosed from both sides.
#[derive(Clone, Debug)]
pub struct Enclosed {
    /// The relative width.
    pub width: BigRational,
    /// The quantity goes beyond this (certified by a witness).
    pub inner: BigRational,
    /// The quantity never goes beyond this (certified by a tree).
    pub outer: BigRational,
    /// "Stays within `inner`" is refuted; `None` where that is no claim, as no condition number is less
    /// than 1.
    pub refuted: Option<Box<Certificate>>,
    /// "Stays within `outer`" is certified.
    pub certified: Box<Certificate>,
    /// Boxes tried for the outer end.
    pub boxes: usize,
}

/// Why an extreme is not enclosed.
#[derive(Clone, Debug, thiserror::Error)]
pub enum NotEnclosed {
    /// Some machine has a singularity, or a point out of reach, in the workspace.
    #[error("none: a singularity, or out of reach, inside")]
    Singular,
    /// No proof was found, however wide, or none of a bound that some point is known to be near.
    #[error("not enclosed: no proof that is near enough was found")]
    Undecided,
    /// The time was up before.
    #[error("not enclosed: the time was up")]
    Time,
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The claim is not well formed.
    #[error("{0}")]
    Claim(ClaimError),
}

impl From<ClaimError> for NotEnclosed {
    fn from(error: ClaimError) -> Self {
        NotEnclosed::Claim(error)
    }
}

/// The refutation that some machine of the claim has a singularity, or a point out of reach, in its
/// workspace: then quantities have no extremes there.
///
/// # Errors
/// If the claim is not well formed, or the search was cancelled.
pub fn singular(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Box<Certificate>>, NotEnclosed> {
    let regular = alone(claim, defining(claim).into_iter().collect());
    match verify(&regular, budget, control)?.answer {
        Answer::Decided { accepted, certificate } => {
            Ok(Some(certificate).filter(|_| accepted.verdict == Verdict::Refuted))
        }
        Answer::Undecided(_) => Ok(None),
        Answer::Cancelled => Err(NotEnclosed::Cancelled),
    }
}

/// Encloses an extreme: see [`Sought::enclose`]; of a claim that is certified as [`Sought::nearer`] says.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn enclose(
    (claim, is_certified): (&MachineClaim, bool),
    extreme: &Extreme,
    relative: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Enclosed, NotEnclosed> {
    if control.is_cancelled() {
        return Err(NotEnclosed::Cancelled);
    }
    let sought = Sought::new(claim, extreme)?;
    let sought = if is_certified { sought.nearer() } else { sought };
    sought.enclose(relative, budget, control)
}

/// An extreme of a claim, and where sampling finds it.
pub struct Sought<'a> {
    claim: &'a MachineClaim,
    extreme: &'a Extreme,
    /// With what it is enclosed first.
    near: Option<Extreme>,
    probe: Problem,
    known: Found,
}

impl<'a> Sought<'a> {
    /// By sampling.
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn new(claim: &'a MachineClaim, extreme: &'a Extreme) -> Result<Self, NotEnclosed> {
        let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
        let known = Found::worst(&probe, extreme, (ROUNDS, FINEST))?;
        Ok(Sought { claim, extreme, near: None, probe: Problem::new(&probe)?, known })
    }

    /// An accuracy's distance is enclosed with an angle, and its angle with a distance, that is not much more than what
    /// sampling finds of it: within the claim's own the machine may be curved by more than what is sought. What is shown so
    /// is another claim, of the same pose where the claim itself is certified.
    #[must_use]
    pub fn nearer(mut self) -> Self {
        self.near = nearer(self.claim, self.extreme);
        self
    }

    /// Encloses it to the relative width `relative`, or where that does not succeed to a looser one, up to eight times
    /// [`loosest`] (for joint coordinates: relative to the greatest size that they take).
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn enclose(
        &self,
        relative: &BigRational,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let near = self.near.as_ref().map(|near| self.enclose_as(near, relative, budget, control));
        match near {
            None | Some(Err(NotEnclosed::Undecided)) => {
                self.enclose_as(self.extreme, relative, budget, control)
            }
            Some(found) => found,
        }
    }

    fn enclose_as(
        &self,
        extreme: &Extreme,
        relative: &BigRational,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let Sought { claim, probe, known, .. } = self;
        let mut attempts = Attempts::new(extreme, known.clone(), of_one_width(budget, probe));
        let mut steps = Steps::default();
        let found = narrowest(relative, budget.deadline.is_some(), |width| {
            for _ in 0..ROUNDS {
                let step = width * attempts.known.size()?;
                let outer =
                    end(extreme, attempts.known.value, &step, 2).ok_or(NotEnclosed::Undecided)?;
                // So far out there may be no bound: of an angle, 90 degrees.
                let Some(outer_claim) = extreme.well_formed(claim, &outer) else { break };
                let is_loosest = *width >= loosest();
                let found = steps.next(control, 2, |control| {
                    attempts.certify(&outer_claim, is_loosest, control)
                });
                let (certified, boxes) = match found? {
                    Attempt::Certified(certified, boxes) => (certified, boxes),
                    Attempt::Worse => continue,
                    Attempt::Undecided(Stop::Time) => return Err(NotEnclosed::Time),
                    Attempt::Undecided(_) => break,
                };
                // What is too near to its bound to be refuted may not be at a looser width.
                let Some(found) = inner_end(claim, extreme, &attempts.known, [relative, width])?
                else {
                    break;
                };
                let width = (width + width + found.width) / BigRational::from_integer(3.into());
                let Inner { value: inner, refuted, .. } = found;
                return Ok(Some(Enclosed { width, inner, outer, refuted, certified, boxes }));
            }
            Ok(None)
        });
        found?.ok_or(NotEnclosed::Undecided)
    }

    /// Encloses it by the bound that the claim itself has for it: for where no narrower one is proved.
    ///
    /// # Errors
    /// See [`NotEnclosed`]; where the claim has none, it is not enclosed.
    pub fn as_required(
        &self,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let Sought { claim, extreme, probe, known, .. } = self;
        let own = extreme.required_bound(claim).ok_or(NotEnclosed::Undecided)?;
        let own_claim = extreme.well_formed(claim, &own).ok_or(NotEnclosed::Undecided)?;
        if budget.is_over() || own.to_f64().is_none_or(|own| !extreme.is_beyond(own, known.value)) {
            return Err(NotEnclosed::Undecided);
        }
        let mut attempts = Attempts::new(extreme, known.clone(), of_one_width(budget, probe));
        let (certified, boxes) = match attempts.certify(&own_claim, true, control)? {
            Attempt::Certified(certified, boxes) => (certified, boxes),
            Attempt::Undecided(Stop::Time) => return Err(NotEnclosed::Time),
            Attempt::Undecided(_) | Attempt::Worse => return Err(NotEnclosed::Undecided),
        };
        let known = attempts.known;
        let [narrowest, widest] = [(1, 1000), (1 << LOOSER, 10)]
            .map(|(n, d): (i64, i64)| BigRational::new(n.into(), d.into()));
        let inner = inner_end(claim, extreme, &known, [&narrowest, &widest])?;
        let Inner { value: inner, refuted, .. } = inner.ok_or(NotEnclosed::Undecided)?;
        let width = (&own - &inner).abs() / known.size()?;
        Ok(Enclosed { width, inner, outer: own, refuted, certified, boxes })
    }
}

/// With a bound on the other part of an accuracy of half as much again as what sampling finds of it, if the claim's is more;
/// what is as small as nothing has some room all the same.
fn nearer(claim: &MachineClaim, extreme: &Extreme) -> Option<Extreme> {
    let (other, own) = extreme.other_part(claim)?;
    let ratio = |n: i64, d: i64| BigRational::new(n.into(), d.into());
    let seen = Found::worst(&other.probe(claim)?, &other, (1, ROUGH)).ok()?;
    let found = beyond(seen.value, &ratio(3, 2))?.max(&own * ratio(1, 1000));
    extreme.with_other_part(&found).filter(|_| found < own)
}

/// The worst that sampling finds of an extreme, and a bound near it, at a relative distance of `relative` or more
/// up to [`loosest`], that is refuted as a certificate says.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn reached(
    claim: &MachineClaim,
    extreme: &Extreme,
    relative: &BigRational,
) -> Result<(f64, Option<BigRational>), NotEnclosed> {
    let Sought { known, .. } = Sought::new(claim, extreme)?;
    let found = inner_end(claim, extreme, &known, [relative, &loosest()])?;
    Ok((known.value, found.filter(|found| found.refuted.is_some()).map(|found| found.value)))
}

/// An inner end, of a width of its own.
struct Inner {
    width: BigRational,
    value: BigRational,
    /// As in [`Enclosed`].
    refuted: Option<Box<Certificate>>,
}

/// The inner end of the narrowest width, from the first to the second and by doubles, of which it is refuted, or is
/// no claim's bound.
fn inner_end(
    claim: &MachineClaim,
    extreme: &Extreme,
    known: &Found,
    [narrowest, widest]: [&BigRational; 2],
) -> Result<Option<Inner>, NotEnclosed> {
    let mut width = narrowest.clone();
    loop {
        let step = &width * known.size()?;
        let mut value = end(extreme, known.value, &step, -1).ok_or(NotEnclosed::Undecided)?;
        if extreme.bounded().requirement.quantity == "conditioning" {
            value = value.max(BigRational::one());
        }
        let own = extreme.well_formed(claim, &value);
        let refuted = own.as_ref().and_then(|claim| refute(claim, &known.place));
        if own.is_none() || refuted.is_some() {
            return Ok(Some(Inner { width, value, refuted }));
        }
        if width >= *widest {
            return Ok(None);
        }
        width = (&width + &width).min(widest.clone());
    }
}

/// What the first sampling finds of an extreme.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn seen(claim: &MachineClaim, extreme: &Extreme) -> Result<f64, NotEnclosed> {
    let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
    Ok(Found::worst(&probe, extreme, (1, FINEST))?.value)
}

/// A refutation at a known place.
fn refute(claim: &MachineClaim, place: &Place) -> Option<Box<Certificate>> {
    let problem = Problem::new(claim).ok()?;
    let sampler = Sampler::new(claim, &problem).ok()?;
    let values = sampler.at(place);
    let worst = of_sought(&problem)
        .map(|quality| (sampler.margin(quality, &values), quality))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let found = Worst { quality: worst.1, place: place.clone(), margin: worst.0 };
    let witness = witness_at(claim, &problem, &sampler, &found)?;
    refuted(claim, witness).ok().map(|(certificate, _)| certificate)
}
