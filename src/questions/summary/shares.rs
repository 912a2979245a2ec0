//! What each tolerance adds to the inaccuracy: the bound on `accuracy` with one tolerance alone.

use super::deviation::{deviation, is_one_of_two};
use super::{End, Found};
use crate::exact::Exact;
use crate::questions::tolerance::{around, legs_mut, parameters};
use crate::report::parameter;
use crate::search::solver::enclose::{enclose, NotEnclosed};
use crate::search::solver::extremes::Extreme;
use crate::search::{at_once, Budget, Control};
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use serde::Serialize;

/// Boxes for both bounds of one deviation: one is mostly enough, and many that are not are many seconds.
const FEW: usize = 3;

/// Where the platform is with one deviation alone.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// The leg, counted from one; none of a mechanism that its user gives, and of the joints' errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// The parameter, or `joint_error`.
    pub parameter: String,
    /// With all else exact, the platform is nowhere farther off.
    pub certified: Exact,
    /// That in the sum of all rows; not known where a row is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
}

/// All of them, greatest first.
#[derive(Clone, Debug, Serialize)]
pub struct Shares {
    /// One for each deviation.
    pub alone: Vec<Share>,
    /// Their sum, if no row is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sum: Option<Exact>,
    /// All at once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub together: Option<Exact>,
    /// Deviations for which no bound was found.
    pub not_enclosed: Vec<String>,
}

/// The numbers of a mechanism.
fn quantities(mechanism: &mut Mechanism) -> Vec<&mut Quantity> {
    if let Mechanism::Formulas(formulas) = mechanism {
        return formulas.parameters.iter_mut().map(|(_, quantity)| quantity).collect();
    }
    legs_mut(mechanism).iter_mut().flat_map(parameters).map(|(_, quantity)| quantity).collect()
}

/// The same claim with the `kept`-th toleranced number as it is and all others in the middle of what
/// they may be.
fn alone(claim: &MachineClaim, kept: Option<usize>) -> MachineClaim {
    let mut claim = claim.clone();
    if let Mechanism::Translational(legs) = &mut claim.mechanism {
        // These have no part in where the platform is.
        for leg in legs {
            if let Leg::Strut { base_axis, .. } = leg {
                *base_axis = None;
            }
        }
    }
    let toleranced = |q: &&mut Quantity| matches!(q, Quantity::Between { .. });
    let all = quantities(&mut claim.mechanism).into_iter().filter(toleranced);
    for (at, quantity) in all.enumerate() {
        if Some(at) != kept {
            *quantity = around(quantity, &BigRational::zero());
        }
    }
    claim.bodies.clear();
    claim
}

/// The accuracy that is required; about a point, no position is off.
fn bounded(claim: &MachineClaim) -> Option<&Requirement> {
    let own = claim.require.iter().find(|own| own.quantity == "accuracy");
    own.filter(|_| !matches!(claim.mechanism, Mechanism::Spherical(_)))
}

/// How many tolerances [`shares`] takes alone.
pub fn deviations(claim: &MachineClaim) -> usize {
    let mut own = claim.clone();
    let all = quantities(&mut own.mechanism).into_iter();
    let count = all.filter(|q| matches!(q, Quantity::Between { .. })).count();
    bounded(claim).map_or(0, |_| count)
}

/// The shares of a claim that bounds its accuracy and has tolerances, and is certified or not.
///
/// # Errors
/// If a claim is not well formed.
pub fn shares(
    (claim, certified): (&MachineClaim, bool),
    gap: &BigRational,
    found: &[Found],
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Shares>, NotEnclosed> {
    let (Some(own), count @ 1..) = (bounded(claim), deviations(claim)) else {
        return Ok(None);
    };
    let exact_joints = {
        let mut given = own.given.clone();
        given.insert("joint_error".to_owned(), vec![Expression::integer(0)]);
        Requirement { given, ..own.clone() }
    };
    let has_error = own
        .given
        .get("joint_error")
        .is_some_and(|all| !all.iter().any(|x| x.rational().is_some_and(|x| x.is_zero())));
    let deviations = (0..count).map(Some).chain(has_error.then_some(None));
    let deviations: Vec<Option<usize>> = deviations.collect();
    let bound = |kept: Option<usize>, budget: Budget, control: &mut Control<'_>| {
        let requirement = if kept.is_some() { exact_joints.clone() } else { own.clone() };
        let Some(extreme) = Extreme::on(requirement, None) else { return Ok(None) };
        let mut one = alone(claim, kept);
        one.require = vec![extreme.bounded().requirement.clone()];
        let name = match kept {
            None => (None, "joint_error".to_owned()),
            Some(_) => {
                let problem = Problem::new(&one)?;
                let place = problem.tolerances().next().map(|(place, ..)| parameter(place));
                let Some(place) = place else { return Ok(None) };
                place
            }
        };
        let own = &one.require[0];
        let bound = match is_one_of_two(&one, own) {
            _ if budget.is_over() => Err(NotEnclosed::Time),
            true => deviation(&one, own, None, budget.at_most(FEW), control)
                .map(|[End { certified, .. }, _]| certified),
            // What one deviation does is among what all do: with the claim this is certified.
            false => {
                enclose((&one, certified), &extreme, gap, budget, control).map(|found| found.outer)
            }
        };
        Ok::<_, NotEnclosed>(Some((name, bound)))
    };
    let bounds = at_once(deviations.len(), 0, control, |number, turns, control| {
        bound(deviations[number], budget.shared(turns), control)
    });
    let whole = found.iter().find(|found| found.asked.of().0 == "accuracy");
    let together = whole.and_then(|found| match found.ends.as_deref() {
        Ok([End { certified, .. }]) => Some(certified.clone()),
        _ => None,
    });
    let (mut rows, mut not_enclosed) = (Vec::new(), Vec::new());
    for bound in bounds {
        match bound? {
            // It is one of the cases of all at once.
            Some((name, Ok(certified))) => {
                let less = together.clone().filter(|all| *all < certified);
                rows.push((name, less.unwrap_or(certified)));
            }
            Some((name, Err(_))) => not_enclosed.push(named(&name)),
            None => {}
        }
    }
    rows.sort_by(|a, b| b.1.cmp(&a.1));
    let sum: BigRational = rows.iter().map(|(_, bound)| bound).sum();
    let sum = not_enclosed.is_empty().then_some(sum);
    let share = |((leg, parameter), bound): ((Option<usize>, String), BigRational)| {
        let of_sum = |sum: &BigRational| match sum.is_zero() {
            true => Some(0.0),
            false => (&bound / sum).to_f64(),
        };
        let share = sum.as_ref().and_then(of_sum);
        Share { leg, parameter, certified: Exact::Rational(bound), share }
    };
    let alone = rows.into_iter().map(share).collect();
    let [sum, together] = [sum, together].map(|x| x.map(Exact::Rational));
    Ok(Some(Shares { alone, sum, together, not_enclosed }))
}

/// A deviation in words.
pub fn named((leg, parameter): &(Option<usize>, String)) -> String {
    match (leg, parameter.as_str()) {
        (_, "joint_error") => "joint errors".to_owned(),
        (Some(leg), parameter) => format!("{parameter} of leg {leg}"),
        (None, parameter) => parameter.to_owned(),
    }
}
