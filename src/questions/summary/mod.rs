//! What a designer reads first: how far the quantities of a machine go, and which requirement is nearest
//! to its limit.
//!
//! | module      | does                                                              |
//! |-------------|-------------------------------------------------------------------|
//! | `asked`     | which quantities                                                  |
//! | `deviation` | how far a platform that turns is off, in position and angle       |
//! | `nearest`   | the requirement with the least margin                             |
//! | `shares`    | what each tolerance adds to the inaccuracy                        |
//! | `signed`    | what a report says first                                          |
//! | [`text`]    | the answer for people                                             |
//!
//! Every value stands beside the certificates that the exact checker has accepted for it; what is only
//! sampled is named `seen`.

mod asked;
mod deviation;
mod nearest;
mod shares;
mod signed;
pub mod text;

pub use asked::Question;
pub use nearest::Nearest;
pub use shares::{Share, Shares};
pub use signed::signed;

use crate::exact::decimal::{rounded, Toward};
use crate::exact::Exact;
use crate::report::{Counterexample, Facts, Outcome, Report};
use crate::search::solver::enclose::{enclose, reached, singular, Enclosed, NotEnclosed};
use crate::search::solver::value::Coordinates;
use crate::search::solver::{sector, Verification};
use crate::search::{at_once, turns, Budget, Control, Steps};
use asked::{asked, Asked};
use num_rational::BigRational;
use orthocert_checker::certificate::Verdict;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The answer.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Of the design's own requirements.
    pub verdict: Outcome,
    /// The design's title.
    pub title: Option<String>,
    /// The design file, as it was named; `None` for the built-in prototype.
    pub design: Option<String>,
    /// The unit of all lengths, as the design names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_unit: Option<&'static str>,
    /// The names of the workspace's coordinates, in the order of places.
    pub coordinates: Coordinates,
    /// The counterexample of a refutation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counterexample: Option<Counterexample>,
    /// Why it is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<String>,
    /// The requirement that is nearest to its limit, or violated most.
    pub nearest: Option<Nearest>,
    /// How far quantities go.
    pub values: Vec<Value>,
    /// What each tolerance adds to the inaccuracy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Shares>,
    /// What was asked for, and why there is no value.
    pub left_out: Vec<String>,
    /// Whether it was interrupted: what was found before is told.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub interrupted: bool,
    /// Whether the machine has tolerances.
    #[serde(skip)]
    pub toleranced: bool,
    /// Seconds from the start.
    pub seconds: f64,
}

/// One end of a quantity.
#[derive(Clone, Debug, Serialize)]
pub struct Value {
    /// The quantity's key.
    pub quantity: String,
    /// In words.
    pub words: String,
    /// The joint, counted from one; of all joints together, none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<usize>,
    /// What it is for, in exact numbers.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub given: BTreeMap<String, Vec<String>>,
    /// Its unit, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// "least" or "greatest".
    pub end: &'static str,
    /// The quantity never goes beyond this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certified: Option<Exact>,
    /// The quantity somewhere goes as far as this, or farther; certified, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reached: Option<Exact>,
    /// Whether what is certified is the design's own bound, and nothing narrower.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub own_bound: bool,
    /// The distance of the two, relative to the quantity's size, rounded up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative: Option<String>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_enclosed: Option<String>,
}

/// Where a quantity ends: beyond the first nothing, beyond the second something, both certified.
#[derive(Clone, Debug)]
struct End {
    certified: BigRational,
    reached: Option<BigRational>,
    relative: Option<BigRational>,
    own_bound: bool,
}

impl From<Enclosed> for End {
    fn from(found: Enclosed) -> Self {
        let reached = found.refuted.is_some().then_some(found.inner);
        End { certified: found.outer, reached, relative: Some(found.width), own_bound: false }
    }
}

/// A question, and what became of it.
struct Found {
    asked: Asked,
    /// The ends of [`Asked::ends`].
    ends: Result<Vec<End>, NotEnclosed>,
}

/// Summarises a claim of which it is known whether it holds; `None` where its numbers exceed what can be
/// shown.
///
/// Cancelled, it has what was found before.
///
/// # Errors
/// If it is not well formed.
pub fn summary(
    claim: &MachineClaim,
    verification: &Verification,
    question: &Question,
    budget: Budget,
    started: Instant,
    control: &mut Control<'_>,
) -> Result<Option<Summary>, NotEnclosed> {
    let problem = Problem::new(claim)?;
    let Some(report) = Report::new(claim, verification, Duration::ZERO) else { return Ok(None) };
    let certified = report.verdict == Outcome::Decided(Verdict::Certified);
    let mut steps = Steps::default();
    let (all, left_out) = asked(claim, &problem, question);
    let shares = shares::deviations(claim);
    let left = 1 + turns(all.len()) + turns(shares);
    let singular = match certified {
        true => Ok(false),
        false => {
            let own = budget.shared(left);
            let found = steps.next(control, left, |control| singular(claim, own, control));
            found.map(|found| found.is_some())
        }
    };
    let singular = match singular {
        Err(NotEnclosed::Cancelled) => false,
        known => known?,
    };
    // Distance and angle are found together.
    let off: OnceLock<Result<[End; 2], NotEnclosed>> = OnceLock::new();
    let find = |asked: &Asked, budget: Budget, control: &mut Control<'_>| match asked {
        _ if singular => Err(NotEnclosed::Singular),
        _ if control.is_cancelled() => Err(NotEnclosed::Cancelled),
        _ if budget.is_over() => Err(NotEnclosed::Time),
        Asked::Extreme(extreme)
            if deviation::is_one_of_two(claim, &extreme.bounded().requirement) =>
        {
            // The distance has its bound as a question, the angle the claim's own requirement.
            let own = claim.require.iter().find(|own| own.quantity == "accuracy");
            let both = off.get_or_init(|| {
                let own = own.ok_or(NotEnclosed::Undecided)?;
                deviation::deviation(claim, own, Some(&question.gap), budget, control)
            });
            let at = usize::from(extreme.bounded().angle);
            both.clone().map(|both| vec![both[at].clone()])
        }
        asked => ends(claim, asked, certified, &question.gap, budget, control),
    };
    let (own, after) = (turns(all.len()), turns(shares));
    let part = steps.take(own, own + after);
    let ends = control.part(part, |control| {
        at_once(all.len(), after, control, |number, turns, control| {
            let ends = find(&all[number], budget.shared(turns), control);
            match certified {
                true => tightened(claim, &all[number], ends, &question.gap),
                false => ends,
            }
        })
    });
    let mut found = Vec::new();
    for (asked, ends) in all.into_iter().zip(ends) {
        if let Err(error @ NotEnclosed::Claim(_)) = ends {
            return Err(error);
        }
        found.push(Found { asked, ends });
    }
    let facts = Facts::new(claim, &problem);
    let nearest = facts.filter(|_| !singular).and_then(|facts| {
        nearest::nearest(claim, &problem, &facts, verification, &found, certified)
    });
    let accuracy = match singular || control.is_cancelled() {
        true => None,
        false => steps.next(control, 1, |control| {
            shares::shares((claim, certified), &question.gap, &found, budget, control)
        })?,
    };
    let angular = asked::is_angular(&problem);
    let toleranced = problem.tolerances().next().is_some();
    Ok(Some(Summary {
        verdict: report.verdict,
        title: None,
        design: None,
        length_unit: None,
        coordinates: report.coordinates,
        counterexample: report.counterexample,
        undecided: report.undecided.map(|remains| remains.reason),
        nearest,
        values: found.iter().flat_map(|found| found.values(angular)).collect(),
        accuracy,
        left_out,
        interrupted: control.is_cancelled(),
        toleranced,
        seconds: started.elapsed().as_secs_f64(),
    }))
}

/// Fractional bits in which what is known exactly is told where it is not rational.
const KNOWN_BITS: u32 = 192;

/// Where a quantity ends.
fn ends(
    claim: &MachineClaim,
    asked: &Asked,
    certified: bool,
    gap: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Vec<End>, NotEnclosed> {
    match asked {
        Asked::Known(greatest, value) => {
            // Which the design's own certificate says.
            let ends = value.ends(KNOWN_BITS).filter(|_| certified);
            let [least, most] = ends.ok_or(NotEnclosed::Undecided)?;
            let relative = Some((&most - &least) / &least);
            let (certified, reached) = if *greatest { (most, least) } else { (least, most) };
            Ok(vec![End { certified, reached: Some(reached), relative, own_bound: false }])
        }
        Asked::Extreme(extreme) => {
            Ok(vec![End::from(enclose((claim, certified), extreme, gap, budget, control)?)])
        }
        Asked::Angle(leg) => {
            let found = sector::enclose(claim, *leg, gap, budget, control)?;
            let end = |(certified, reached): (_, Option<(_, _)>)| {
                let relative = Some(found.width.clone());
                End {
                    certified,
                    reached: reached.map(|(angle, _)| angle),
                    relative,
                    own_bound: false,
                }
            };
            Ok(found.certified.into_iter().zip(found.reached).map(end).collect())
        }
    }
}

/// With what the certificate of the design says where that is more.
fn tightened(
    claim: &MachineClaim,
    asked: &Asked,
    mut ends: Result<Vec<End>, NotEnclosed>,
    gap: &BigRational,
) -> Result<Vec<End>, NotEnclosed> {
    let Asked::Extreme(extreme) = asked else { return ends };
    let Some(bound) = extreme.required_bound(claim) else { return ends };
    match &mut ends {
        Ok(ends) => {
            for End { certified, own_bound, .. } in ends {
                if extreme.is_greatest() == (bound < *certified) {
                    (*certified, *own_bound) = (bound.clone(), true);
                }
            }
        }
        Err(NotEnclosed::Undecided | NotEnclosed::Time) => {
            let reached = reached(claim, extreme, gap).ok().and_then(|(_, reached)| reached);
            ends = Ok(vec![End { certified: bound, reached, relative: None, own_bound: true }]);
        }
        Err(_) => {}
    }
    ends
}

impl Found {
    fn values(&self, angular: bool) -> Vec<Value> {
        let ends = self.asked.ends();
        let value = |(at, &end): (usize, &&'static str)| {
            let empty = self.asked.value(end, angular);
            match &self.ends {
                Ok(found) => Value {
                    certified: found.get(at).map(|end| Exact::Rational(end.certified.clone())),
                    reached: found.get(at).and_then(|end| end.reached.clone()).map(Exact::Rational),
                    own_bound: found.get(at).is_some_and(|end| end.own_bound),
                    relative: found
                        .get(at)
                        .and_then(|end| Some(rounded(end.relative.as_ref()?, 2, Toward::Above))),
                    ..empty
                },
                Err(error) => Value { not_enclosed: Some(error.to_string()), ..empty },
            }
        };
        ends.iter().enumerate().map(value).collect()
    }
}
