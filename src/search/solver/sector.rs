//! The angles that a joint takes: a certified sector in which all of them are, up to whole turns.

use super::enclose::{narrowest, of_one_width, rounded, Enclosed, NotEnclosed};
use super::sample::{Place, Sampler, Worst};
use super::value::{alone, middle as range_middle, of_sought, turns, Bounded};
use super::{proof, refutation};
use crate::exact::arithmetic::number;
use crate::search::{Budget, Control, Steps, Stop};
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::problem::Problem;
use std::collections::BTreeMap;

/// Finest step of the search for the ends.
const FINEST: i32 = 30;
/// How often a wider sector may turn up.
const ROUNDS: usize = 8;
/// Degrees by which a sector is at least wide, and short of half a turn.
const LEAST: f64 = 1e-6;

/// A sector of angles, in degrees.
#[derive(Clone, Debug)]
pub struct Sector {
    /// Every angle is within these, up to whole turns.
    pub certified: [BigRational; 2],
    /// The tree that shows it.
    pub certificate: Box<Certificate>,
    /// Some angle is beyond these, where one was found, and the witness that shows it.
    pub reached: [Option<(BigRational, Box<Certificate>)>; 2],
    /// The width of both enclosures relative to that of the sector.
    pub width: BigRational,
}

impl Sector {
    /// Its ends, each where it is reached.
    pub fn into_ends(self) -> [Result<Enclosed, NotEnclosed>; 2] {
        let Sector { certified: [lower, upper], certificate, reached: [least, greatest], width } =
            self;
        let end = |outer, reached: Option<(BigRational, Box<Certificate>)>| {
            let (inner, refuted) = reached.ok_or(NotEnclosed::Undecided)?;
            let (width, certified) = (width.clone(), certificate.clone());
            Ok(Enclosed { width, inner, outer, refuted: Some(refuted), certified, boxes: 0 })
        };
        [end(lower, least), end(upper, greatest)]
    }
}

/// Encloses the angles of the joint of a leg, counted from zero.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn enclose(
    claim: &MachineClaim,
    leg: usize,
    relative: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Sector, NotEnclosed> {
    let seen = seen(claim, leg)?;
    let [lo, hi] = seen.map(BigRational::from_f64);
    let (lo, hi) = lo.zip(hi).ok_or(NotEnclosed::Undecided)?;
    let third = BigRational::new(1.into(), 3.into());
    let mut steps = Steps::default();
    let found = narrowest(relative, budget.deadline.is_some(), |width| {
        let step = width * (&hi - &lo);
        let (inward, outward) = (&step * &third, &step * (&third + &third));
        let certified = [rounded(&(&lo - &outward), &step), rounded(&(&hi + &outward), &step)];
        let outer = within(claim, leg, &certified).ok_or(NotEnclosed::Undecided)?;
        // Of half a turn and more there is no such claim.
        let Ok(problem) = Problem::new(&outer) else { return Ok(None) };
        let budget = of_one_width(budget, &problem);
        let found = steps.next(control, 2, |control| proof(&outer, budget, control));
        let certificate = match found {
            Ok(certificate) => certificate,
            Err(Stop::Cancelled) => return Err(NotEnclosed::Cancelled),
            Err(Stop::Time) => return Err(NotEnclosed::Time),
            Err(_) => return Ok(None),
        };
        let [lower, upper] = &certified;
        let beyond = |ends: [&BigRational; 2]| {
            let claim = within(claim, leg, &ends.map(BigRational::clone))?;
            Problem::new(&claim).ok()?;
            refutation(&claim)
        };
        let inner = [rounded(&(&lo + &inward), &step), rounded(&(&hi - &inward), &step)];
        let ends = [[&inner[0], upper], [lower, &inner[1]]];
        let [one, other] = ends.map(beyond);
        let [least, greatest] = inner;
        let reached = [one.map(|one| (least, one)), other.map(|other| (greatest, other))];
        Ok(Some(Sector { certified, certificate, reached, width: width.clone() }))
    });
    found?.ok_or(NotEnclosed::Undecided)
}

/// "The angle is within these degrees", and nothing else.
fn within(claim: &MachineClaim, leg: usize, ends: &[BigRational; 2]) -> Option<MachineClaim> {
    let bound = Bound::Within([number(&ends[0]), number(&ends[1])]);
    let (quantity, given) = ("joint_range".to_owned(), BTreeMap::new());
    Some(alone(claim, vec![Requirement { quantity, leg: Some(leg + 1), given, bound }]))
}

/// The least and the greatest angle found, in degrees: in the turn that the claim's own range is in, or else
/// in the one about 0.
fn seen(claim: &MachineClaim, leg: usize) -> Result<[f64; 2], NotEnclosed> {
    let ends = [0, 90].map(|degrees| BigRational::from_integer(degrees.into()));
    let mut asked = within(claim, leg, &ends).ok_or(NotEnclosed::Undecided)?;
    let (mut middle, mut lo, mut hi) = (None, f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..ROUNDS {
        let problem = Problem::new(&asked)?;
        let sampler = Sampler::new(&asked, &problem)?;
        let bounded =
            Bounded { requirement: asked.require[0].clone(), leg: Some(leg), angle: false };
        let angle = |place: &Place| bounded.value(&asked, &problem, &sampler, place);
        let mut places = Vec::new();
        let about = match middle {
            Some(angle) => {
                let worst = sampler.worst_values(FINEST).into_iter();
                let own = |found: &Worst| of_sought(&problem).any(|own| own == found.quality);
                places.extend(worst.filter(own).map(|found| found.place));
                angle
            }
            None => {
                places = sampler.grid();
                angle(&sampler.centre()).ok_or(NotEnclosed::Singular)?
            }
        };
        middle = Some(about);
        let before = (lo, hi);
        for place in &places {
            let turned = angle(place).ok_or(NotEnclosed::Singular)?;
            let turned = turned + turns(turned, about);
            (lo, hi) = (lo.min(turned), hi.max(turned));
        }
        if hi - lo < LEAST {
            (lo, hi) = (lo - LEAST, hi + LEAST);
        }
        if hi - lo > 180.0 - LEAST {
            return Err(NotEnclosed::Undecided);
        }
        if before.0 - lo <= 1e-9 * (hi - lo) && hi - before.1 <= 1e-9 * (hi - lo) {
            break;
        }
        let ends = [lo, hi].map(|x| BigRational::from_f64(x).map(|x| number(&x)));
        let [Some(min), Some(max)] = ends else { return Err(NotEnclosed::Undecided) };
        asked.require[0].bound = Bound::Within([min, max]);
    }
    let own = claim.require.iter().find(|own| {
        own.quantity == "joint_range" && own.leg.is_none_or(|number| number == leg + 1)
    });
    let own = own.and_then(|own| range_middle(&own.bound)).unwrap_or(0.0);
    let turns = turns(0.5 * (lo + hi), own);
    Ok([lo + turns, hi + turns])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    /// Of a joint at -169 to -117 degrees the range [-175, -110] is met, and its stroke is told so; without
    /// one, in the turn about 0.
    #[test]
    fn angles_are_told_in_the_turn_of_their_range() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs/kernel");
        let text = std::fs::read_to_string(folder.join("planar-3-rrr.toml")).unwrap();
        let mut claim = Design::parse(&text, "planar-3-rrr.toml").unwrap().claim;
        let about = |claim: &MachineClaim, turned: f64| {
            let [lo, hi] = seen(claim, 0).unwrap();
            assert!(lo - turned > -169.5 && hi - turned < -116.5, "{lo} to {hi}");
        };
        about(&claim, 0.0);
        for own in &mut claim.require {
            if let Bound::Within(ends) = &mut own.bound {
                *ends = [185, 250].map(|x| number(&BigRational::from_integer(x.into())));
            }
        }
        about(&claim, 360.0);
        claim.require.retain(|own| own.quantity != "joint_range");
        about(&claim, 0.0);
    }
}
