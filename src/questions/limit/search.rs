//! The search for limits: outward until the verdict changes, then by halves.

use super::{Decided, Direction, End, Family, Limit, Question, Side, STEPS};
use crate::exact::decimal::shortest;
use crate::questions::frontier::NoAnswer;
use crate::search::{is_over, Budget, Steps};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_checker::certificate::Verdict;
use std::time::Instant;

/// A short decimal well between two values.
pub(super) fn between(a: &BigRational, b: &BigRational) -> BigRational {
    let quarter = (b - a) / BigRational::from_integer(4.into());
    let (from, to) = (a + &quarter, b - &quarter);
    if from < to {
        shortest(&from, &to)
    } else {
        shortest(&to, &from)
    }
}

/// Looks for the limits about the own value, whose verdict is known unless it is undecided.
///
/// Cancelled, it has what was found before.
///
/// # Errors
/// Those of the family.
pub fn limits<F: Family>(
    question: &Question,
    own: Option<(Verdict, F::Proof)>,
    family: &mut F,
) -> Result<Vec<Limit<F::Proof>>, NoAnswer> {
    let directions = question.directions.len();
    let (steps, deadline) = (Steps::default(), question.deadline);
    let mut search = Search { question, family, steps, directions, deadline, cancelled: false };
    let starts = match own {
        Some((verdict, proof)) => {
            let own = Decided { value: question.own.clone(), verdict, proof };
            let walk = |d: &Direction| Walk::new(Some(*d), Some(own.clone()));
            question.directions.iter().map(walk).collect()
        }
        None => search.starts()?,
    };
    let mut walks = Vec::new();
    if let [Some(one), Some(other)] = starts.iter().map(|s| s.near.as_ref()).collect::<Vec<_>>()[..]
    {
        if one.verdict != other.verdict {
            walks.push(Walk::about(one.clone(), other.clone(), &question.own));
            search.directions += 1;
        }
    }
    // What is refuted beside an undecided value has its limit there.
    let about = !walks.is_empty();
    walks.extend(starts.into_iter().filter(|walk| !about || walk.is_certified()));
    // Each has its share of the time; what others leave is for those whose share was up.
    let count = walks.len();
    for (at, walk) in walks.iter_mut().enumerate() {
        search.along(walk, count - at)?;
    }
    let short = walks.iter().filter(|walk| walk.out_of_time).count();
    for (at, walk) in walks.iter_mut().filter(|walk| walk.out_of_time).enumerate() {
        search.along(walk, short - at)?;
    }
    let mut found: Vec<_> = walks.into_iter().map(Walk::limit).collect();
    found.sort_by_key(|limit| limit.side);
    Ok(found)
}

/// A verdict with what shows it, where there is one.
type Found<F> = Option<(Verdict, <F as Family>::Proof)>;

/// A search in one direction: what is known from the own value outward.
struct Walk<P> {
    /// None about the own value.
    direction: Option<Direction>,
    /// The last value of one verdict, or of any.
    near: Option<Decided<P>>,
    /// Undecided values beyond it: the first and the last.
    undecided: Option<[BigRational; 2]>,
    /// A value of the other verdict, beyond those.
    far: Option<Decided<P>>,
    end: Option<End>,
    out_of_time: bool,
    /// The next step.
    step: u32,
}

impl<P: Clone> Walk<P> {
    fn new(direction: Option<Direction>, near: Option<Decided<P>>) -> Self {
        let (undecided, far, end) = (None, None, None);
        Walk { direction, near, undecided, far, end, out_of_time: false, step: 0 }
    }

    /// Between two verdicts, about an undecided value.
    fn about(near: Decided<P>, far: Decided<P>, undecided: &BigRational) -> Self {
        let undecided = Some([undecided.clone(), undecided.clone()]);
        Walk { undecided, far: Some(far), ..Walk::new(None, Some(near)) }
    }

    fn is_certified(&self) -> bool {
        self.near.as_ref().is_some_and(|near| near.verdict == Verdict::Certified)
    }

    /// Takes in what is known of a value beyond all others.
    fn put(&mut self, value: BigRational, found: Option<(Verdict, P)>) {
        let Some((verdict, proof)) = found else {
            let first = self.undecided.take().map_or_else(|| value.clone(), |[first, _]| first);
            self.undecided = Some([first, value]);
            return;
        };
        let other = self.near.as_ref().is_some_and(|near| near.verdict != verdict);
        let decided = Some(Decided { value, verdict, proof });
        if other {
            self.far = decided;
        } else {
            (self.near, self.undecided) = (decided, None);
        }
    }

    /// Takes in what is known of a value between `near` and `far`, on this side of the undecided
    /// ones.
    fn put_between(&mut self, value: BigRational, part: Part, found: Option<(Verdict, P)>) {
        let Some((verdict, proof)) = found else {
            self.undecided = Some(match (self.undecided.take(), part) {
                (None, _) => [value.clone(), value],
                (Some([_, last]), Part::Near) => [value, last],
                (Some([first, _]), Part::Far) => [first, value],
            });
            return;
        };
        let same = self.near.as_ref().is_some_and(|near| near.verdict == verdict);
        // Undecided values that are not between the two any more do not matter.
        if (same, part) == (true, Part::Far) || (same, part) == (false, Part::Near) {
            self.undecided = None;
        }
        let decided = Some(Decided { value, verdict, proof });
        if same {
            self.near = decided;
        } else {
            self.far = decided;
        }
    }

    /// What was found.
    fn limit(self) -> Limit<P> {
        let above = |(near, far): (&Decided<P>, &Decided<P>)| far.value > near.value;
        // Whether `far` is, or would be, above `near`.
        let upward = match self.direction {
            Some(direction) => direction == Direction::Up,
            None => self.near.as_ref().zip(self.far.as_ref()).is_some_and(above),
        };
        let refuted_first = self.near.as_ref().is_some_and(|n| n.verdict == Verdict::Refuted);
        let side = if upward != refuted_first { Side::Upper } else { Side::Lower };
        let (certified, refuted) =
            if refuted_first { (self.far, self.near) } else { (self.near, self.far) };
        Limit {
            direction: self.direction,
            side,
            certified,
            refuted,
            undecided: self.undecided.map(|[a, b]| if a < b { [a, b] } else { [b, a] }),
            end: self.end,
            out_of_time: self.out_of_time,
        }
    }
}

/// Where a value lies about the undecided ones.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Near,
    Far,
}

struct Search<'a, F> {
    question: &'a Question,
    family: &'a mut F,
    /// What is done, and the directions in which it is not.
    steps: Steps,
    directions: usize,
    /// Of the direction that is looked in.
    deadline: Option<Instant>,
    /// Whether it is to end, with what was found.
    cancelled: bool,
}

impl<F: Family> Search<'_, F> {
    /// A claim's verdict, where so many are still to be found in this direction.
    fn decide(&mut self, claim: &F::Claim, here: usize) -> Result<Found<F>, NoAnswer> {
        let others = self.directions.saturating_sub(1) * (STEPS as usize / 2 + self.halves(1.0));
        let part = self.steps.take(1, here + others);
        match self.family.decide(claim, part, self.deadline) {
            Err(NoAnswer::Cancelled) => {
                self.cancelled = true;
                Ok(None)
            }
            found => found,
        }
    }

    fn is_over(&self) -> bool {
        self.cancelled || is_over(self.deadline)
    }

    /// How often a relative distance is to be halved.
    fn halves(&self, distance: f64) -> usize {
        let gap = self.question.gap.to_f64().unwrap_or(f64::MIN_POSITIVE);
        (distance / gap).log2().ceil().clamp(1.0, 64.0) as usize
    }

    /// From an undecided own value: the first verdict in each direction.
    fn starts(&mut self) -> Result<Vec<Walk<F::Proof>>, NoAnswer> {
        let question = self.question;
        let start = |(at, direction): (usize, &Direction)| {
            self.begin(question.directions.len() - at);
            let mut walk = Walk::new(Some(*direction), None);
            walk.undecided = Some([question.own.clone(), question.own.clone()]);
            while walk.near.is_none() && self.stepped(&mut walk)? {}
            Ok(walk)
        };
        question.directions.iter().enumerate().map(start).collect()
    }

    /// From now on there is one of so many shares of the time left.
    fn begin(&mut self, shares: usize) {
        let whole = Budget { max_boxes: 0, deadline: self.question.deadline };
        self.deadline = whole.shared(shares).deadline;
    }

    /// Whether a value may be undecided for want of a greater share only: it is asked for again then.
    fn wants_more(&self) -> bool {
        self.is_over() && !is_over(self.question.deadline)
    }

    /// Steps until the verdict changes, or as far as steps go, and narrows, in one of so many shares of the time left.
    fn along(&mut self, walk: &mut Walk<F::Proof>, shares: usize) -> Result<(), NoAnswer> {
        self.begin(shares);
        walk.out_of_time = false;
        while walk.far.is_none() && self.stepped(walk)? {}
        self.narrowed(walk)
    }

    /// Takes the next step; whether there may be another.
    fn stepped(&mut self, walk: &mut Walk<F::Proof>) -> Result<bool, NoAnswer> {
        let Some(direction) = walk.direction else { return Ok(false) };
        if walk.step == STEPS || walk.end.is_some() {
            return Ok(false);
        }
        if self.is_over() {
            walk.out_of_time = true;
            return Ok(false);
        }
        let value = self.question.step(direction, walk.step);
        match self.family.claim(&value) {
            Ok(claim) => {
                // As likely now as later.
                let outward = (STEPS - walk.step) as usize / 2 + 1;
                let found = self.decide(&claim, outward + self.halves(1.0))?;
                if found.is_none() && self.wants_more() {
                    walk.out_of_time = true;
                    return Ok(false);
                }
                if !self.cancelled {
                    walk.put(value, found);
                }
            }
            Err(reason) => {
                let last = match walk.step.checked_sub(1) {
                    Some(step) => self.question.step(direction, step),
                    None => self.question.own.clone(),
                };
                let (inside, end) = self.end(last.clone(), End { value, reason });
                walk.end = Some(end);
                if inside != last {
                    if let Ok(claim) = self.family.claim(&inside) {
                        let found = self.decide(&claim, 1)?;
                        if !self.cancelled {
                            walk.put(inside, found);
                        }
                    }
                }
            }
        }
        walk.step += 1;
        Ok(true)
    }

    /// The last value of a claim, and the first without one, as near as the gap.
    fn end(&self, mut inside: BigRational, mut end: End) -> (BigRational, End) {
        while self.question.distance(&inside, &end.value) > self.question.gap {
            let value = between(&inside, &end.value);
            match self.family.claim(&value) {
                Ok(_) => inside = value,
                Err(reason) => end = End { value, reason },
            }
        }
        (inside, end)
    }

    /// Halves what is between two verdicts. Each half is at most 3/4 of what was halved, so that
    /// this ends.
    fn narrowed(&mut self, walk: &mut Walk<F::Proof>) -> Result<(), NoAnswer> {
        while let Some((value, part)) = self.next(walk) {
            if self.is_over() {
                walk.out_of_time = true;
                break;
            }
            let ends = [&walk.near, &walk.far].map(|end| end.as_ref().map(|end| &end.value));
            let distance = match ends {
                [Some(near), Some(far)] => self.question.distance(near, far).to_f64(),
                _ => None,
            };
            let found = match self.family.claim(&value) {
                Ok(claim) => self.decide(&claim, self.halves(distance.unwrap_or(1.0)))?,
                Err(_) => None,
            };
            if found.is_none() && self.wants_more() {
                walk.out_of_time = true;
                break;
            }
            if !self.cancelled {
                walk.put_between(value, part, found);
            }
        }
        self.directions = self.directions.saturating_sub(1);
        Ok(())
    }

    /// The value to try next, unless the two ends, or each of them and what is undecided, are near
    /// enough.
    fn next(&self, walk: &Walk<F::Proof>) -> Option<(BigRational, Part)> {
        let (near, far) = (&walk.near.as_ref()?.value, &walk.far.as_ref()?.value);
        if self.question.distance(near, far) <= self.question.gap {
            return None;
        }
        let Some([first, last]) = &walk.undecided else {
            return Some((between(near, far), Part::Near));
        };
        // About a single undecided value the two ends are to come as near as the gap.
        let half = &self.question.gap / BigRational::from_integer(2.into());
        let wide = |a: &BigRational, b: &BigRational| {
            let distance = self.question.distance(a, b);
            (distance > half).then(|| (distance, between(a, b)))
        };
        match (wide(near, first), wide(last, far)) {
            (Some((n, value)), Some((f, _))) if n >= f => Some((value, Part::Near)),
            (Some((_, value)), None) => Some((value, Part::Near)),
            (_, Some((_, value))) => Some((value, Part::Far)),
            (None, None) => None,
        }
    }
}
