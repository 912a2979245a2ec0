//! The most extreme place of a quantity that sampling finds.

use super::NotEnclosed;
use crate::search::solver::extremes::Extreme;
use crate::search::solver::sample::{Place, Quality, Sampler, Worst};
use crate::search::solver::value::{of_sought, Bounded};
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Zero};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;

/// Finest step of the search for an extreme.
pub const FINEST: i32 = 30;
/// The same where it need not be known better than to a tenth.
pub const ROUGH: i32 = 8;

/// The most extreme place known.
#[derive(Clone)]
pub struct Found {
    /// The place.
    pub place: Place,
    /// The value there.
    pub value: f64,
    /// What widths are relative to, beside the value.
    least_size: f64,
}

impl Found {
    /// By sampling: of a bound that is met with equality at the worst place found so far, the place at
    /// which it is violated most, until there is none.
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn worst(
        probe: &MachineClaim,
        extreme: &Extreme,
        (rounds, finest): (usize, i32),
    ) -> Result<Self, NotEnclosed> {
        let mut claim = probe.clone();
        let mut best: Option<Found> = None;
        for _ in 0..rounds {
            let problem = Problem::new(&claim)?;
            let sampler = Sampler::new(&claim, &problem)?;
            let mut found: Option<(f64, Place)> = None;
            for worst in sampler.worst_values(finest) {
                let value = extreme.value_at(&claim, &problem, &sampler, &worst)?;
                let known = found.as_ref().map(|(known, _)| *known);
                let is_worse =
                    |value: &f64| known.is_none_or(|known| extreme.is_beyond(*value, known));
                if let Some(value) = value.filter(is_worse) {
                    found = Some((value, worst.place));
                }
            }
            let (value, place) = found.ok_or(NotEnclosed::Undecided)?;
            let better = best.as_ref().is_none_or(|best| {
                extreme.is_beyond(value, best.value)
                    && (value - best.value).abs() > 1e-12 * value.abs()
            });
            if !better {
                break;
            }
            let least_size = extreme.size(&claim, &problem, &sampler, value);
            best = Some(Found { place, value, least_size });
            let value = BigRational::from_f64(value);
            match value.and_then(|value| extreme.well_formed(probe, &value)) {
                Some(tight) => claim = tight,
                None => break,
            }
        }
        best.ok_or(NotEnclosed::Undecided)
    }

    /// What widths are relative to.
    pub fn size(&self) -> Result<BigRational, NotEnclosed> {
        let size = BigRational::from_f64(self.value.abs().max(self.least_size));
        Ok(size.filter(|x| !x.is_zero()).unwrap_or_else(BigRational::one))
    }
}

impl Extreme {
    /// The value at a place of one of its own obligations; of others none.
    pub(super) fn value_at(
        &self,
        claim: &MachineClaim,
        problem: &Problem,
        sampler: &Sampler<'_>,
        at: &Worst,
    ) -> Result<Option<f64>, NotEnclosed> {
        let Quality::Obligation(number) = at.quality else { return Ok(None) };
        let is_sought = of_sought(problem).any(|own| own == at.quality);
        let own = |bounded: &Bounded| is_sought && bounded.angle == self.bounded().angle;
        let Some(bounded) = Bounded::of(claim, problem, number).filter(own) else {
            return Ok(None);
        };
        let value = bounded.value(claim, problem, sampler, &at.place);
        value.map(Some).ok_or(NotEnclosed::Singular)
    }

    pub(super) fn is_beyond(&self, value: f64, other: f64) -> bool {
        if self.is_greatest() {
            value > other
        } else {
            value < other
        }
    }

    /// The greatest size of a joint coordinate, which may be zero at its extreme; of others, zero.
    fn size(
        &self,
        claim: &MachineClaim,
        problem: &Problem,
        sampler: &Sampler<'_>,
        value: f64,
    ) -> f64 {
        if self.bounded().requirement.quantity != "joint_range" {
            return 0.0;
        }
        let at = |place: &Place| self.bounded().value(claim, problem, sampler, place);
        sampler.grid().iter().filter_map(at).map(f64::abs).fold(value.abs(), f64::max)
    }
}
