//! How far one number of a family of claims can go: a certified value and a refuted one beside each
//! other.
//!
//! A family has a claim for each value of a number, or none where the value is not admissible. Its
//! verdict need not change once only, so nothing is claimed but that one value is certified and
//! another refuted, each by its own certificate. From the number's own value the search goes outward
//! in steps of a growing width until the verdict changes, then halves. Every value that is tried is
//! a short decimal. What is undecided narrows nothing: it is kept between the two ends.
//!
//! | module   | holds                                                    |
//! |----------|----------------------------------------------------------|
//! | `design` | the family of a design file and one of its numbers       |
//! | `place`  | the requirement that a refuted value violates, and where |
//! | `search` | steps outward, then halves                               |

mod design;
mod place;
mod search;
#[cfg(test)]
mod tests;

pub use design::DesignFamily;
pub use place::Place;
pub use search::limits;

use crate::exact::decimal::shortest;
use crate::questions::frontier::NoAnswer;
use num_rational::BigRational;
use num_traits::Signed;
use orthocert_checker::certificate::Verdict;
use std::time::Instant;

/// Steps outward: `size * GROWTH^k / FINEST`, up to `size * FINEST`.
const STEPS: u32 = 11;
const GROWTH: u32 = 4;
const FINEST: i64 = 1024;

/// Claims that depend on one number.
pub trait Family {
    /// A claim.
    type Claim;
    /// What shows a verdict.
    type Proof: Clone;

    /// The claim for a value, or, in a sentence, why there is none.
    ///
    /// # Errors
    /// If the value is not admissible.
    fn claim(&self, value: &BigRational) -> Result<Self::Claim, String>;

    /// A claim's verdict, if one is found before `deadline`: these shares of all the work.
    ///
    /// # Errors
    /// If it was cancelled.
    fn decide(
        &mut self,
        claim: &Self::Claim,
        part: [f64; 2],
        deadline: Option<Instant>,
    ) -> Result<Option<(Verdict, Self::Proof)>, NoAnswer>;
}

/// Away from the number's own value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To greater values.
    Up,
    /// To smaller ones.
    Down,
}

/// Which end of a range of certified values a limit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Refuted below, certified above.
    Lower,
    /// Certified below, refuted above.
    Upper,
}

/// What is asked.
#[derive(Clone, Debug)]
pub struct Question {
    /// The number's own value, or one very near to it.
    pub own: BigRational,
    /// What changes are measured by; positive.
    pub size: BigRational,
    /// The relative distance of a certified and a refuted value to stop at.
    pub gap: BigRational,
    /// Where to look.
    pub directions: Vec<Direction>,
    /// The moment at which to stop.
    pub deadline: Option<Instant>,
}

/// A value with a verdict.
#[derive(Clone, Debug)]
pub struct Decided<P> {
    /// The value.
    pub value: BigRational,
    /// Its verdict.
    pub verdict: Verdict,
    /// What shows it.
    pub proof: P,
}

/// A value for which there is no claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct End {
    /// The value.
    pub value: BigRational,
    /// Why.
    pub reason: String,
}

/// What was found in one direction.
#[derive(Clone, Debug)]
pub struct Limit<P> {
    /// Where it was looked for; `None` of one about the number's own value, which is undecided.
    pub direction: Option<Direction>,
    /// Which end of the certified values it is, or would be.
    pub side: Side,
    /// The certified value nearest to the refuted one; the farthest, where none is refuted.
    pub certified: Option<Decided<P>>,
    /// The refuted value nearest to the certified one; the farthest, where none is certified.
    pub refuted: Option<Decided<P>>,
    /// The least and the greatest undecided value between the two, or beyond the one there is.
    pub undecided: Option<[BigRational; 2]>,
    /// Where the search ended for want of a claim.
    pub end: Option<End>,
    /// Whether the search ended for want of time, or was cancelled.
    pub out_of_time: bool,
}

impl Question {
    /// The relative distance of two values: to the greater in size, or, if zero is one of them or
    /// between them, to the size of the question.
    pub fn distance(&self, a: &BigRational, b: &BigRational) -> BigRational {
        let apart = (a - b).abs();
        if (a * b).is_positive() {
            apart / a.abs().max(b.abs())
        } else {
            apart / &self.size
        }
    }

    /// The distance of a limit's two values, where both are there.
    pub fn gap_of<P>(&self, limit: &Limit<P>) -> Option<BigRational> {
        let (certified, refuted) = (limit.certified.as_ref()?, limit.refuted.as_ref()?);
        Some(self.distance(&certified.value, &refuted.value))
    }

    /// Whether a limit is as near as was asked for.
    pub fn is_reached<P>(&self, limit: &Limit<P>) -> bool {
        self.gap_of(limit).is_some_and(|gap| gap <= self.gap)
    }

    /// Whether more effort might find a limit, or a nearer one.
    pub fn is_open<P>(&self, limit: &Limit<P>) -> bool {
        match self.gap_of(limit) {
            Some(gap) => gap > self.gap,
            None => limit.out_of_time || limit.undecided.is_some(),
        }
    }

    /// The value of a step.
    fn step(&self, direction: Direction, step: u32) -> BigRational {
        let factor = BigRational::new(GROWTH.pow(step).into(), FINEST.into());
        let offset = &self.size * factor;
        let quarter = &offset / BigRational::from_integer(4.into());
        let middle = match direction {
            Direction::Up => &self.own + offset,
            Direction::Down => &self.own - offset,
        };
        shortest(&(&middle - &quarter), &(&middle + &quarter))
    }
}
