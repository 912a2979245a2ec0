//! How far a platform that turns in space is off, in position and angle at once: either bound is sharp only
//! where the other is of one size with what is so.

use super::End;
use crate::search::solver::enclose::{beyond, reached, seen, NotEnclosed};
use crate::search::solver::extremes::Extreme;
use crate::search::solver::{proof, value};
use crate::search::{Budget, Control, Steps, Stop};
use num_rational::BigRational;
use num_traits::Signed;
use orthocert_kernel::claim::{MachineClaim, Mechanism, Requirement};

/// What both bounds are tried at, in parts of a hundred of the worst that is seen: of one that fails, no
/// tighter one is tried.
const OF_WORST: [i64; 7] = [400, 200, 150, 125, 110, 105, 102];

/// Whether this is one of the two bounds of an accuracy.
pub fn is_one_of_two(claim: &MachineClaim, own: &Requirement) -> bool {
    matches!(claim.mechanism, Mechanism::Spatial(_))
        && own.quantity == "accuracy"
        && own.given.contains_key("max_angle")
}

/// The ends of the distance and of the angle that go with `own`, an accuracy of which
/// [`is_one_of_two`] holds: one claim with both bounds, certified; without a `gap`, not what is reached.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn deviation(
    claim: &MachineClaim,
    own: &Requirement,
    gap: Option<&BigRational>,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<[End; 2], NotEnclosed> {
    let claim = value::alone(claim, vec![own.clone()]);
    let distance = Extreme::on(own.clone(), None).ok_or(NotEnclosed::Undecided)?;
    let angle = Extreme::angle(&claim, own).ok_or(NotEnclosed::Undecided)?;
    let worst = |extreme: &Extreme| match gap {
        Some(gap) => reached(&claim, extreme, gap),
        None => Ok((seen(&claim, extreme)?, None)),
    };
    let worst = [worst(&distance)?, worst(&angle)?];
    let mut steps = Steps::default();
    let mut best = Err(NotEnclosed::Undecided);
    for (number, part) in OF_WORST.into_iter().enumerate() {
        let factor = BigRational::new(part.into(), 100.into());
        let bounds = worst.each_ref().map(|(seen, _)| beyond(*seen, &factor));
        let [Some(off), Some(turned)] = &bounds else { break };
        let both = distance.with_other_part(turned).and_then(|both| both.claim(&claim, off));
        let Some(both) = both else { break };
        match steps.next(control, OF_WORST.len() - number, |control| proof(&both, budget, control))
        {
            Ok(_) => best = Ok([off.clone(), turned.clone()]),
            Err(Stop::Cancelled) if best.is_err() => return Err(NotEnclosed::Cancelled),
            Err(Stop::Time) if best.is_err() => return Err(NotEnclosed::Time),
            Err(_) => break,
        }
    }
    let [off, turned] = worst;
    let end = |certified: BigRational, (_, reached): (f64, Option<BigRational>)| {
        let relative = reached.as_ref().filter(|_| certified.is_positive());
        let relative = relative.map(|reached| (&certified - reached) / &certified);
        End { certified, reached, relative, own_bound: false }
    };
    best.map(|[one, other]| [end(one, off), end(other, turned)])
}
