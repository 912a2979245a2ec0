//! How far a number of a claim goes before its verdict changes.
//!
//! A family of claims depends on one positive number, such that what is proved for one value holds
//! for all values on one side of it. [`frontier`] looks for the last value at which a test succeeds:
//! steps of a growing factor until the test changes, then halves by the geometric mean. [`approach`] comes
//! near to a value at which it is expected from afar, so that whenever it ends there is an answer. Every value
//! tried is a decimal, which is taken exactly. The tests are [`proof`] and [`refutation`], which
//! give certificates that the exact checker has accepted. Of claims that
//! are not so ordered, [`limit`](crate::questions::limit) looks for a value of each verdict.

use crate::exact::Exact;
use crate::search::solver;
use crate::search::{is_over, Budget, Control, Steps};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use std::time::Instant;

/// Largest factor between one value and the next that is of use.
pub const LARGEST_FACTOR: f64 = 10.0;
/// Values tried about one that is expected, relative to it.
const SPREAD: f64 = 100.0;
/// Where an approach begins, relative to the value that it comes near to.
const FAR: f64 = 0.1;
/// A distance is near enough to one that is too near if it is at most so many times as far, and the value so much less.
const NEXT: (f64, f64) = (1.1, 1.02);
/// Where a distance is too near, one this many times as far is tried; and from far away, one so much nearer.
const FARTHER: f64 = 3.2;

/// A value, and the certificate of the claim for it.
pub type Certified = (BigRational, Box<Certificate>);

/// Where the verdict changes, as far as it was found.
#[derive(Clone, Debug, Default)]
pub struct Bracket {
    /// The claim is certified for this value.
    pub certified: Option<Certified>,
    /// The claim is refuted for this value.
    pub refuted: Option<Certified>,
    /// Whether with more time the ends may have been nearer.
    pub out_of_time: bool,
}

impl Bracket {
    /// The relative distance of the two ends: greater over smaller, less one.
    pub fn gap(&self) -> Option<BigRational> {
        let ((a, _), (b, _)) = self.certified.as_ref().zip(self.refuted.as_ref())?;
        Some(a.max(b) / a.min(b) - BigRational::from_integer(1.into()))
    }

    /// Whether both ends are as near to each other as this.
    pub fn reaches(&self, gap: f64) -> bool {
        self.gap().and_then(|own| own.to_f64()).is_some_and(|own| own <= gap)
    }
}

/// Why there is no answer at all.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoAnswer {
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// The question does not fit the claim: a sentence that says what was found.
    #[error("{0}")]
    Claim(String),
    /// It does not fit what the design has at this key.
    #[error("{key}: found {found}; accepted: {accepted}")]
    Unfit {
        /// The key.
        key: String,
        /// What was found.
        found: String,
        /// What it would fit.
        accepted: &'static str,
    },
}

impl NoAnswer {
    /// It does not fit what the design has at `key`.
    pub fn unfit(key: &str, found: impl Into<String>, accepted: &'static str) -> Self {
        NoAnswer::Unfit { key: key.to_owned(), found: found.into(), accepted }
    }
}

impl From<ClaimError> for NoAnswer {
    fn from(error: ClaimError) -> Self {
        NoAnswer::Claim(error.to_string())
    }
}

/// On which side of a success all values succeed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Succeeds {
    /// Smaller values succeed too.
    Below,
    /// Greater values succeed too.
    Above,
}

/// How a frontier is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Where it begins.
    pub start: f64,
    /// Which side succeeds.
    pub succeeds: Succeeds,
    /// The first step's factor; every later one is the square of the one before.
    pub factor: f64,
    /// The greatest factor.
    pub most: f64,
    /// A success that is as far ends it.
    pub enough: Option<f64>,
    /// Values beyond these are not tried.
    pub limits: (f64, f64),
    /// Relative distance, from the last success to the first failure, at which to stop.
    pub gap: f64,
    /// The moment at which to stop.
    pub deadline: Option<Instant>,
}

impl Walk {
    fn step(&self, x: f64, factor: f64, success: bool) -> f64 {
        match (self.succeeds, success) {
            (Succeeds::Below, true) | (Succeeds::Above, false) => x * factor,
            (Succeeds::Below, false) | (Succeeds::Above, true) => x / factor,
        }
    }

    fn is_enough(&self, x: f64) -> bool {
        self.enough.is_some_and(|enough| match self.succeeds {
            Succeeds::Below => x >= enough,
            Succeeds::Above => x <= enough,
        })
    }

    fn is_over(&self) -> bool {
        is_over(self.deadline)
    }
}

/// The last value found at which `test` succeeds, and what it gave; `None` where none did. Cancelled, it
/// has what was found before.
///
/// # Errors
/// Those of `test`.
pub fn frontier<T>(
    walk: &Walk,
    control: &mut Control<'_>,
    mut test: impl FnMut(&BigRational, &mut Control<'_>) -> Result<Option<T>, NoAnswer>,
) -> Result<Option<(BigRational, T)>, NoAnswer> {
    let mut steps = Steps::default();
    let (mut best, mut failed) = (None, None);
    let (mut x, mut factor) = (walk.start, walk.factor);
    while !walk.is_over() && (walk.limits.0..=walk.limits.1).contains(&x) {
        let Some(value) = decimal(x, walk.gap) else { break };
        // A few more steps outward, then halves.
        let left = 2 + halves(factor, walk.gap);
        let found = match steps.next(control, left, |control| test(&value, control)) {
            Err(NoAnswer::Cancelled) => break,
            found => found?,
        };
        let success = found.is_some();
        match found {
            Some(found) => best = Some((x, value, found)),
            None => failed = Some(x),
        }
        let done = |(good, ..): &(f64, _, _)| failed.is_some() || walk.is_enough(*good);
        if best.as_ref().is_some_and(done) {
            break;
        }
        x = walk.step(x, factor, success);
        factor = (factor * factor).min(walk.most);
    }
    while let (Some((good, last, _)), Some(bad)) = (&best, failed) {
        if walk.is_over()
            || control.is_cancelled()
            || walk.is_enough(*good)
            || (good / bad).max(bad / good) <= 1.0 + walk.gap
        {
            break;
        }
        let middle = (good * bad).sqrt();
        let Some(value) = decimal(middle, walk.gap).filter(|value| value != last) else { break };
        let left = halves((good / bad).max(bad / good), walk.gap);
        let found = match steps.next(control, left, |control| test(&value, control)) {
            Err(NoAnswer::Cancelled) => break,
            found => found?,
        };
        match found {
            Some(found) => best = Some((middle, value, found)),
            None => failed = Some(middle),
        }
    }
    Ok(best.map(|(_, value, found)| (value, found)))
}

/// A value that is come near to, from where a test succeeds; distances are relative.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// The value.
    pub to: f64,
    /// Which side of it succeeds.
    pub succeeds: Succeeds,
    /// The distance that is near enough.
    pub near: f64,
    /// The distance that is tried first.
    pub first: f64,
    /// Where that is too near, the distances tried are about these and between them.
    pub far: (f64, f64),
    /// A distance at which it is known to succeed: less is tried.
    pub known: Option<f64>,
    /// Down to this distance, while tests succeed, each is a third of the one before.
    pub by_thirds: f64,
}

impl Approach {
    /// From a tenth of the value.
    pub fn from_afar(to: f64, succeeds: Succeeds, near: f64) -> Self {
        Approach {
            to,
            succeeds,
            near,
            first: near.max(FAR),
            far: (0.0, SPREAD),
            known: None,
            by_thirds: 1.0,
        }
    }

    /// The value at a distance.
    pub fn at(&self, distance: f64) -> Option<BigRational> {
        let value = match self.succeeds {
            Succeeds::Below => self.to / (1.0 + distance),
            Succeeds::Above => self.to * (1.0 + distance),
        };
        decimal(value, distance)
    }

    /// How far a value is.
    pub fn distance(&self, value: &BigRational) -> Option<f64> {
        let value = value.to_f64()?;
        Some(match self.succeeds {
            Succeeds::Below => self.to / value - 1.0,
            Succeeds::Above => value / self.to - 1.0,
        })
    }

    /// The distance to be tried after the nearest success and the farthest failure.
    fn next(&self, success: Option<f64>, failure: Option<f64>) -> Option<f64> {
        match (success, failure) {
            (None, None) => Some(self.first),
            (Some(far), None) if far > self.by_thirds.max(self.near) => {
                Some((far / FARTHER).max(self.near))
            }
            (Some(far), None) => (far > self.near).then(|| (far * far.min(FAR)).max(self.near)),
            (Some(far), Some(near)) => {
                let is_near = far <= near * NEXT.0 && 1.0 + far <= (1.0 + near) * NEXT.1;
                (!is_near).then(|| (far * near).sqrt().max(far / FARTHER))
            }
            (None, Some(near)) => (near < self.far.1).then(|| (near * FARTHER).max(self.far.0)),
        }
    }
}

/// What an approach has found.
#[derive(Clone, Debug)]
pub struct Approached<T> {
    /// The nearest value at which the test succeeded, and what it gave.
    pub found: Option<(BigRational, T)>,
    /// Whether with more time it may have been nearer.
    pub out_of_time: bool,
}

/// The nearest value found at which `test` succeeds: while it does, at distances of a tenth, a square of it
/// and so on, those above [`Approach::by_thirds`] by thirds; past the first that fails, between, from the side that
/// succeeds. A test has half of the time that is left, and a quarter where one failed and none succeeded: what is far
/// costs little, and what fails costs most. Cancelled, it has what was found before.
///
/// # Errors
/// Those of `test`.
pub fn approach<T>(
    approach: &Approach,
    budget: Budget,
    control: &mut Control<'_>,
    mut test: impl FnMut(&BigRational, Budget, &mut Control<'_>) -> Result<Option<T>, NoAnswer>,
) -> Result<Approached<T>, NoAnswer> {
    let mut steps = Steps::default();
    let (mut best, mut out_of_time) = (None, false);
    let (mut success, mut failure) = (approach.known, None);
    while let Some(distance) = approach.next(success, failure) {
        if (best.is_some() || failure.is_some()) && budget.is_over() {
            out_of_time = true;
            break;
        }
        let Some(value) = approach.at(distance) else { break };
        let own = budget.shared(if success.is_none() && failure.is_some() { 4 } else { 2 });
        let found = match steps.next(control, 3, |control| test(&value, own, control)) {
            Err(NoAnswer::Cancelled) => break,
            found => found?,
        };
        match found {
            Some(found) => (best, success) = (Some((value, found)), Some(distance)),
            None => {
                failure = Some(distance);
                // What is nearer is expected to fail, too, whatever the time.
                out_of_time = own.is_over();
            }
        }
    }
    Ok(Approached { found: best, out_of_time })
}

/// Where both ends are looked for.
pub struct About {
    /// The value at which the verdict is expected to change.
    pub expected: f64,
    /// Whether it is for smaller or for greater values that the claim holds.
    pub holds: Succeeds,
    /// Either end is to be by this share of the gap to its own side of the value expected; below a half.
    pub share: f64,
    /// Whether the value expected is one about which both ends are; not where it is found from few samples.
    pub is_sure: bool,
    /// The relative distance of the ends that is wanted.
    pub gap: f64,
}

/// A value for which the claim is certified, and one for which it is refuted, about the value expected. Where
/// that is not sure, the certified end comes near to the refuted one.
///
/// # Errors
/// If it was cancelled.
pub fn bracket(
    about: &About,
    claim: impl Fn(&BigRational) -> Option<MachineClaim>,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Bracket, NoAnswer> {
    let &About { expected, holds, share, is_sure, gap } = about;
    let (start, fails) = match holds {
        Succeeds::Below => (expected * (1.0 + share * gap), Succeeds::Above),
        Succeeds::Above => (expected / (1.0 + share * gap), Succeeds::Below),
    };
    let walk = Walk {
        start,
        succeeds: fails,
        factor: 1.0 + gap,
        most: LARGEST_FACTOR,
        enough: is_sure.then_some(start),
        limits: (expected / SPREAD, expected * SPREAD),
        gap: share * gap,
        deadline: budget.shared(3).deadline,
    };
    let refuted = control.part([0.0, 0.1], |control| {
        frontier(&walk, control, |x, control| {
            claim(x).map_or(Ok(None), |claim| refutation(&claim, control))
        })
    })?;
    let end = refuted.as_ref().and_then(|(x, _)| x.to_f64()).filter(|_| !is_sure);
    let near = end.map_or(share, |_| 2.0 * share) * gap;
    let to = Approach::from_afar(end.unwrap_or(expected), holds, near);
    let Approached { found: certified, out_of_time } = control.part([0.1, 1.0], |control| {
        approach(&to, budget, control, |x, budget, control| {
            claim(x).map_or(Ok(None), |claim| proof(&claim, budget, control))
        })
    })?;
    Ok(Bracket { certified, refuted, out_of_time })
}

/// How often a factor is to be halved until it is one of `1 + gap`.
fn halves(factor: f64, gap: f64) -> usize {
    (factor.ln() / gap.ln_1p()).log2().ceil().clamp(1.0, 64.0) as usize
}

/// The decimal nearest to `x > 0` with three digits more than a relative distance of `gap` needs.
pub fn decimal(x: f64, gap: f64) -> Option<BigRational> {
    let digits = (3.0 - gap.log10()).ceil().clamp(3.0, 17.0) as usize;
    let text = format!("{x:.*e}", digits - 1);
    let value = Exact::parse(&text, 64).ok()?.as_rational()?.clone();
    value.to_f64().filter(|x| *x > 0.0).map(|_| value)
}

/// A certificate that `claim` holds, if the search finds one within the budget. A claim that is not
/// well formed has none.
///
/// # Errors
/// If it was cancelled.
pub fn proof(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Box<Certificate>>, NoAnswer> {
    let found = solver::proof(claim, budget, control).ok();
    unless_cancelled(control, found)
}

/// A certificate that `claim` does not hold, if sampling finds a witness. A claim that is not well
/// formed has none.
///
/// # Errors
/// If it was cancelled.
pub fn refutation(
    claim: &MachineClaim,
    control: &mut Control<'_>,
) -> Result<Option<Box<Certificate>>, NoAnswer> {
    unless_cancelled(control, None::<()>)?;
    Ok(solver::refutation(claim))
}

pub(super) fn unless_cancelled<T>(control: &Control<'_>, found: T) -> Result<T, NoAnswer> {
    match control.is_cancelled() {
        true => Err(NoAnswer::Cancelled),
        false => Ok(found),
    }
}

#[cfg(test)]
mod tests;
