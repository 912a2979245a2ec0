//! The margin of a design: how much its bounds could be tightened.
//!
//! A claim *tightened* by a margin `m >= 0` has lower bounds `1 + m` times and upper bounds `1/(1 + m)`
//! times as great, and joint ranges `1/(1 + m)` times as wide about their middles. The *margin* of a
//! design is the greatest `m` for which its claim, tightened by it, is true.
//!
//! **Lemma.** A claim tightened by `m` implies the claim tightened by `n`, `0 <= n <= m`. *Proof.*
//! Lower bounds are positive or zero, upper bounds positive: `(1 + m) b >= (1 + n) b` and
//! `b/(1 + m) <= b/(1 + n)`. The ranges are nested. All else is the same. ∎ So what is certified of a
//! tightened claim bounds the margin from below, and what refutes it bounds the margin from above.

use super::refute::approximate;
use super::sample::{Quality, Sampler};
use super::value::Bounded;
use crate::design::{joint_range, written, JOINT_RANGE};
use crate::exact::Exact;
use num_rational::BigRational;
use num_traits::One;
use orthocert_kernel::claim::{Bound, MachineClaim};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;

/// The claim tightened by a margin, for a claim that has one; `None` if a number is too long.
pub fn tightened(claim: &MachineClaim, margin: &BigRational) -> Option<MachineClaim> {
    let factor = written(&Exact::Rational(BigRational::one() + margin))?;
    let mut tightened = claim.clone();
    for (own, new) in claim.require.iter().zip(&mut tightened.require) {
        let narrowed = |end: usize| {
            let ends = joint_range(claim, own)?;
            let sum = over(Operator::Add, ends[0], ends[1])?;
            let middle = over(Operator::Div, &sum, &Expression::integer(2))?;
            let off = over(Operator::Sub, ends[end], &middle)?;
            over(Operator::Add, &middle, &over(Operator::Div, &off, &factor)?)
        };
        new.bound = match &own.bound {
            Bound::Holds => Bound::Holds,
            Bound::Within(_) => Bound::Within([narrowed(0)?, narrowed(1)?]),
            Bound::Min(_) if own.quantity == JOINT_RANGE => Bound::Min(narrowed(0)?),
            Bound::Max(_) if own.quantity == JOINT_RANGE => Bound::Max(narrowed(1)?),
            Bound::Min(bound) => Bound::Min(over(Operator::Mul, bound, &factor)?),
            Bound::Max(bound) => Bound::Max(over(Operator::Div, bound, &factor)?),
        };
    }
    Some(tightened)
}

/// The result of an operation, as one number where it is rational.
fn over(operator: Operator, left: &Expression, right: &Expression) -> Option<Expression> {
    let both = Expression::Binary(operator, left.clone().into(), right.clone().into());
    match both.rational() {
        Some(value) => written(&Exact::Rational(value)),
        None => Some(both),
    }
}

/// The margin of a claim, nearly, by sampling down to steps of `2^-finest` of the workspace: not much less
/// than 0 where the claim does not hold, -1 where a leg does not reach or the claim is not well formed,
/// infinite without bounds.
pub fn margin(claim: &MachineClaim, finest: i32) -> f64 {
    sampled(claim, finest).unwrap_or(-1.0)
}

fn sampled(claim: &MachineClaim, finest: i32) -> Option<f64> {
    let problem = Problem::new(claim).ok()?;
    let sampler = Sampler::new(claim, &problem).ok()?;
    let rooms = sampler.worst_on_grid().into_iter().map(|worst| {
        let Quality::Obligation(number) = worst.quality else {
            return if worst.margin > 0.0 { f64::INFINITY } else { -1.0 };
        };
        let worst = sampler.descend(worst.quality, &worst.place, finest);
        let Some(bounded) = Bounded::of(claim, &problem, number) else {
            return f64::INFINITY;
        };
        let value = bounded.value(claim, &problem, &sampler, &worst.place);
        let room = value.and_then(|value| room(claim, &bounded, value));
        room.unwrap_or(if worst.margin > 0.0 { f64::INFINITY } else { -1.0 })
    });
    Some(rooms.fold(f64::INFINITY, f64::min).max(-1.0))
}

/// By how much a bound can be tightened until it is met by a value.
fn room(claim: &MachineClaim, bounded: &Bounded, value: f64) -> Option<f64> {
    let own = &bounded.requirement;
    if own.quantity == JOINT_RANGE {
        let [least, greatest] = joint_range(claim, own)?;
        let (least, greatest) = (approximate(least)?, approximate(greatest)?);
        let off = value - (least + greatest) / 2.0;
        return Some((greatest - least) / 2.0 / off.abs() - 1.0);
    }
    match &bounded.bound() {
        Bound::Min(bound) => Some(value / approximate(bound)? - 1.0),
        Bound::Max(bound) => Some(approximate(bound)? / value - 1.0),
        Bound::Within(_) | Bound::Holds => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::without_margin;
    use crate::design::AtlasDesign;

    fn claim(requirements: &str) -> MachineClaim {
        let text = format!(
            "[parameters]\na = {{ min = 1, max = 2 }}\n[atlas]\nresolution = 1\nboxes = 1\n\
             [mechanism]\nkind = \"orthoglide\"\nleg_length = \"a\"\nbase = -1\n[workspace]\n\
             min = [-0.1, -0.1, -0.1]\nmax = [0.2, 0.2, 0.2]\n[requirements]\n{requirements}\n"
        );
        let design = AtlasDesign::parse(&text, "test").unwrap();
        design.at(&[Exact::integer(1)])
    }

    fn by(text: &str) -> BigRational {
        Exact::parse(text, 100).unwrap().as_rational().unwrap().clone()
    }

    /// Every requirement with a bound.
    const ALL: &str =
        "transmission = { min = \"1/2\", max = 2 }\njoint_range = { min = -1, max = 3 }\n\
                       conditioning = { max = 3 }\nserial_margin = { min = \"0.5\" }\n\
                       parallel_margin = { min = \"0.3\" }\nleg_angle = { max = 60 }\n\
                       joint_speed = { tool = 1, max = 4 }";

    #[test]
    fn every_bound_is_tightened_by_the_factor() {
        let expected = claim(
            "transmission = { min = \"3/4\", max = \"4/3\" }\njoint_range = { min = \"-1/3\", max = \"7/3\" }\n\
             conditioning = { max = 2 }\nserial_margin = { min = \"3/4\" }\n\
             parallel_margin = { min = \"9/20\" }\nleg_angle = { max = 40 }\n\
             joint_speed = { tool = 1, max = \"8/3\" }",
        );
        assert_eq!(tightened(&claim(ALL), &by("1/2")).unwrap(), expected);
        assert_eq!(tightened(&claim(ALL), &by("0")).unwrap(), claim(ALL));
    }

    #[test]
    fn the_sampled_margin_is_where_the_tightened_claim_begins_to_fail() {
        for requirement in ALL.lines() {
            let claim = claim(requirement);
            let found = margin(&claim, 14);
            assert!(found > 0.05 && found.is_finite(), "{requirement}: {found}");
            let of = |m: f64| margin(&tightened(&claim, &by(&format!("{m:.9}"))).unwrap(), 14);
            assert!(of(0.999 * found) > 0.0, "{requirement}: {found}");
            assert!(of(1.001 * found) < 0.0, "{requirement}: {found}");
        }
    }

    #[test]
    fn what_has_no_margin_is_told() {
        assert_eq!(without_margin(&claim(ALL)), None);
        let one_end = claim("transmission = { max = 2 }\njoint_range = { min = -1 }");
        assert!(without_margin(&one_end).is_some_and(|why| why.contains("one end")));
    }
}
