//! The requirement with the least margin.

use super::asked::Asked;
use super::{End, Found};
use crate::exact::Exact;
use crate::report::{Facts, FreeParameter};
use crate::search::solver::extremes::Extreme;
use crate::search::solver::sample::{Quality, Worst};
use crate::search::solver::value::Bounded;
use crate::search::solver::Verification;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use orthocert_kernel::claim::{Bound, MachineClaim};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use serde::Serialize;

/// Fractional bits of a bound that is not rational.
const BITS: u32 = 192;

/// A requirement, how far what it bounds stays from its limit, and where that was seen.
#[derive(Clone, Debug, Serialize)]
pub struct Nearest {
    /// The requirement's name.
    pub requirement: String,
    /// Its unit, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// A relation and a number.
    pub bound: String,
    /// The same, for people.
    #[serde(skip)]
    pub bound_text: String,
    /// The margin is at least this: of the certified end from the bound, relative to the greater of the two;
    /// of joint coordinates to the stroke. Negative where it may be violated.
    pub margin_at_least: Exact,
    /// The margin is certainly at most this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin_at_most: Option<Exact>,
    /// Requirements that may be as near.
    pub or: Vec<String>,
    /// Those of which it is not known how near they come.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unknown: Vec<String>,
    /// The worst value that sampling has seen.
    pub worst_seen: Option<f64>,
    /// Where: not certified.
    pub seen_at: Vec<f64>,
    /// Of which machine of the tolerances.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<FreeParameter>,
}

/// A margin between two certified bounds.
struct Margin {
    least: BigRational,
    greatest: Option<BigRational>,
    seen: Worst,
}

/// The nearest of the requirements of which an end is known.
pub fn nearest(
    claim: &MachineClaim,
    problem: &Problem,
    facts: &Facts<'_>,
    verification: &Verification,
    found: &[Found],
    certified: bool,
) -> Option<Nearest> {
    let mut all = Vec::new();
    for (number, own) in claim.require.iter().enumerate() {
        let legs: Vec<Option<usize>> = match (own.quantity.as_str(), own.leg) {
            ("joint_range", None) => (0..problem.legs.len()).map(Some).collect(),
            (_, leg) => vec![leg.map(|leg| leg - 1)],
        };
        // Of an accuracy, the distance and the angle, where there are both.
        let bounded = |leg: &Option<usize>| {
            let (leg, requirement) = (*leg, own.clone());
            [false, true].map(|angle| Bounded { requirement: requirement.clone(), leg, angle })
        };
        for bounded in legs.iter().flat_map(bounded) {
            let leg = bounded.leg;
            let seen = |worst: &&Worst| match worst.quality {
                Quality::Obligation(at) => {
                    let obligation = &problem.obligations[at];
                    let angle = Bounded::of(claim, problem, at).is_some_and(|own| own.angle);
                    obligation.requirement == Some(number)
                        && (leg.is_none() || obligation.leg == leg)
                        && angle == bounded.angle
                }
                Quality::Reach | Quality::Determinant => false,
            };
            let worst = verification.worst.iter().filter(seen);
            let seen = worst.min_by(|a, b| a.margin.total_cmp(&b.margin));
            let margin = margin(claim, &bounded, found);
            all.extend(margin.zip(seen).map(|((least, greatest), seen)| {
                let zero = BigRational::zero();
                let held = |x: BigRational| if certified { x.max(zero.clone()) } else { x };
                let (least, greatest) = (held(least), greatest.map(held));
                Margin { least, greatest, seen: seen.clone() }
            }));
        }
    }
    // Where nothing is known to be near, something may be.
    let key = |margin: &Margin| (margin.greatest.is_none(), margin.greatest.clone());
    all.sort_by(|a, b| key(a).cmp(&key(b)).then_with(|| a.least.cmp(&b.least)));
    let [first, others @ ..] = &all[..] else { return None };
    // Of what can be as near as the first certainly is.
    let as_near = others
        .iter()
        .filter(|other| first.greatest.as_ref().is_none_or(|most| other.least <= *most));
    let row = facts.rows(std::slice::from_ref(&first.seen)).pop()?;
    let (mut or, mut unknown): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    for other in as_near {
        let rows = facts.rows(std::slice::from_ref(&other.seen)).into_iter();
        let names = rows.map(|row| format!("{} {}", row.requirement, row.bound_text));
        let told = if other.greatest.is_some() { &mut or } else { &mut unknown };
        told.extend(names.filter(|name| !told.contains(name)).collect::<Vec<_>>());
    }
    Some(Nearest {
        requirement: row.requirement,
        unit: row.unit,
        bound: row.bound,
        bound_text: row.bound_text,
        margin_at_least: Exact::Rational(first.least.clone()),
        margin_at_most: first.greatest.clone().map(Exact::Rational),
        or,
        unknown,
        worst_seen: row.worst_found,
        seen_at: row.at,
        machine: row.machine,
    })
}

/// The least and the greatest margin that the ends found leave; none without an end.
fn margin(
    claim: &MachineClaim,
    bounded: &Bounded,
    found: &[Found],
) -> Option<(BigRational, Option<BigRational>)> {
    let (own, leg) = (&bounded.requirement, bounded.leg);
    let of = |wanted: &dyn Fn(&Asked) -> bool| {
        let one = found.iter().find(|found| wanted(&found.asked))?;
        one.ends.as_ref().ok()
    };
    let stroke = || {
        let mut ends = found.iter().filter(|found| {
            let (quantity, of, _) = found.asked.of();
            quantity == "joint_range" && of == leg
        });
        let (one, other) = (ends.next()?.ends.as_ref().ok()?, ends.next()?.ends.as_ref().ok()?);
        Some((&other.first()?.certified - &one.first()?.certified).abs())
    };
    let (bound, is_least) = match &bounded.bound() {
        Bound::Min(bound) => (bound.clone(), true),
        Bound::Max(bound) => (bound.clone(), false),
        Bound::Within(ends) => {
            let sector = of(&|asked| matches!(asked, Asked::Angle(of) if Some(*of) == leg))?;
            return within(ends, sector);
        }
        Bound::Holds => return None,
    };
    let ends = match own.quantity.as_str() {
        "transmission" => of(&|asked| match asked {
            Asked::Known(greatest, _) => *greatest != is_least,
            Asked::Extreme(one) => Extreme::on(own.clone(), leg).is_some_and(|own| own == *one),
            Asked::Angle(_) => false,
        }),
        _ => {
            let extreme = match bounded.angle {
                true => Extreme::angle(claim, own)?,
                false => Extreme::on(own.clone(), leg)?,
            };
            of(&|asked| matches!(asked, Asked::Extreme(one) if *one == extreme))
        }
    }?;
    let End { certified, reached, .. } = ends.first()?;
    let bound = enclosed(&bound)?;
    let side = |x: &BigRational, bound: &BigRational| {
        let left = if is_least { x - bound } else { bound - x };
        let size = match own.quantity.as_str() {
            "joint_range" => stroke()?,
            _ => x.abs().max(bound.abs()),
        };
        Some(if size.is_zero() { BigRational::zero() } else { left / size })
    };
    let [worse, better] = if is_least { [&bound[1], &bound[0]] } else { [&bound[0], &bound[1]] };
    let greatest = reached.as_ref().and_then(|reached| side(reached, better));
    Some((side(certified, worse)?, greatest))
}

/// Of a sector of angles, relative to it.
fn within(ends: &[Expression; 2], sector: &[End]) -> Option<(BigRational, Option<BigRational>)> {
    let [least, greatest] = sector else { return None };
    let [min, max] = [enclosed(&ends[0])?, enclosed(&ends[1])?];
    let two = BigRational::from_integer(2.into());
    let turn = BigRational::from_integer(360.into());
    let middle = (&least.certified + &greatest.certified - &min[0] - &max[1]) / &two;
    let turned = (middle / &turn).round() * &turn;
    let size = &greatest.certified - &least.certified;
    if !size.is_positive() {
        return None;
    }
    let left = [&least.certified - &min[1] - &turned, &max[0] + &turned - &greatest.certified];
    let reached = [
        least.reached.as_ref().map(|x| x - &min[0] - &turned),
        greatest.reached.as_ref().map(|x| &max[1] + &turned - x),
    ];
    let [one, other] = left;
    let most = reached.into_iter().flatten().min();
    Some((one.min(other) / &size, most.map(|most| most / &size)))
}

fn enclosed(x: &Expression) -> Option<[BigRational; 2]> {
    Exact::of(x)?.ends(BITS)
}
