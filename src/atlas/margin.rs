//! The margin of a design: how much its bounds could be tightened.
//!
//! A claim *tightened* by a factor `f >= 1` has lower bounds `f` times and upper bounds `1/f` times
//! as great, and joint ranges `1/f` times as wide about their middles. The *margin* of a design is
//! the greatest `m` for which its claim tightened by `1 + m` is true.
//!
//! **Lemma.** A claim tightened by `f` implies the claim tightened by `g`, `1 <= g <= f`. *Proof.*
//! Lower bounds are positive or zero, upper bounds positive: `f b >= g b` and `b/f <= b/g`. The
//! ranges are nested. All else is the same. ∎ So what is certified of a tightened claim bounds the
//! margin from below, and what refutes it bounds the margin from above.

use super::decide::sampled;
use orthocert_checker::claim::{
    AtLeast, AtMost, JointSpeed, MachineClaim, Range, Requirements, Workspace,
};
use orthocert_checker::number::{Exact, NumberErrorKind};

/// Why a claim's margin is not defined; `None` if it is.
pub fn without_margin(claim: &MachineClaim) -> Option<&'static str> {
    if matches!(claim.workspace, Workspace::Cube { .. }) {
        return Some("the paper's cube is the claim of a tight design");
    }
    let half_open = |range: &Range| range.min.is_none() || range.max.is_none();
    let half_open = claim.requirements.joint_range.iter().flatten().any(half_open);
    half_open.then_some("a joint_range with one end has no middle about which to tighten it")
}

/// The claim tightened by a factor, for a claim that has a margin.
///
/// # Errors
/// If a number is too large.
pub fn tightened(claim: &MachineClaim, factor: &Exact) -> Result<MachineClaim, NumberErrorKind> {
    let least = |x: &Exact| x.clone().times(factor.clone());
    let greatest = |x: &Exact| x.clone().over(factor.clone());
    let at_least = |bound: &AtLeast| Ok(AtLeast { min: least(&bound.min)? });
    let at_most = |bound: &AtMost| Ok(AtMost { max: greatest(&bound.max)? });
    let all = &claim.requirements;
    let transmission = |range: &Range| {
        let min = range.min.as_ref().map(least).transpose()?;
        Ok(Range { min, max: range.max.as_ref().map(greatest).transpose()? })
    };
    let joint_range = |[a, b, c]: &[Range; 3]| {
        Ok([narrowed(a, factor)?, narrowed(b, factor)?, narrowed(c, factor)?])
    };
    let joint_speed = |speed: &JointSpeed| {
        Ok(JointSpeed { tool: speed.tool.clone(), max: greatest(&speed.max)? })
    };
    Ok(MachineClaim {
        requirements: Requirements {
            transmission: all.transmission.as_ref().map(transmission).transpose()?,
            joint_range: all.joint_range.as_ref().map(joint_range).transpose()?,
            conditioning: all.conditioning.as_ref().map(at_most).transpose()?,
            serial_margin: all.serial_margin.as_ref().map(at_least).transpose()?,
            parallel_margin: all.parallel_margin.as_ref().map(at_least).transpose()?,
            leg_angle: all.leg_angle.as_ref().map(at_most).transpose()?,
            joint_speed: all.joint_speed.as_ref().map(joint_speed).transpose()?,
        },
        ..claim.clone()
    })
}

/// A range `1/factor` times as wide about its middle.
fn narrowed(range: &Range, factor: &Exact) -> Result<Range, NumberErrorKind> {
    let (Some(min), Some(max)) = (&range.min, &range.max) else {
        return Ok(range.clone());
    };
    let two = || Exact::integer(2);
    let middle = min.clone().plus(max.clone())?.over(two())?;
    let half = max.clone().minus(min.clone())?.over(two())?.over(factor.clone())?;
    let (min, max) = (middle.clone().minus(half.clone())?, middle.plus(half)?);
    Ok(Range { min: Some(min), max: Some(max) })
}

/// The margin of a claim, nearly, by sampling: not much less than 0 where the claim does not hold,
/// -1 where a leg does not reach or there is no model, infinite without bounds.
pub fn margin(claim: &MachineClaim) -> f64 {
    let Some((sampler, worst)) = sampled(claim) else {
        return -1.0;
    };
    let rooms = worst.iter().filter_map(|w| sampler.room(w.quality, &sampler.at(&w.place)));
    rooms.fold(f64::INFINITY, f64::min).max(-1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    fn claim(requirements: &str) -> MachineClaim {
        let text = format!(
            "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\nbase = -1\n[workspace]\n\
             min = [-0.1, -0.1, -0.1]\nmax = [0.2, 0.2, 0.2]\n[requirements]\n{requirements}\n"
        );
        Design::parse(&text, "test").unwrap().rules.unwrap()
    }

    fn factor(text: &str) -> Exact {
        Exact::parse(text, 100).unwrap()
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
        assert_eq!(tightened(&claim(ALL), &factor("3/2")).unwrap(), expected);
        assert_eq!(tightened(&claim(ALL), &factor("1")).unwrap(), claim(ALL));
    }

    #[test]
    fn the_sampled_margin_is_where_the_tightened_claim_begins_to_fail() {
        for requirement in ALL.lines() {
            let claim = claim(requirement);
            let found = margin(&claim);
            assert!(found > 0.05 && found.is_finite(), "{requirement}: {found}");
            let of =
                |m: f64| margin(&tightened(&claim, &factor(&format!("{:.9}", 1.0 + m))).unwrap());
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
