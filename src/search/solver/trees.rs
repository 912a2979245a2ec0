//! Trees on whose leaves every obligation is discharged, by several means, the cheapest first.
//!
//! | boxes of                                   | machines of the tolerance                     | worth it where                    |
//! |--------------------------------------------|-----------------------------------------------|-----------------------------------|
//! | the workspace                              | all at once, in ranges                        | always: certificates are shortest |
//! | the workspace, few                         | by what each differs from one                 | these are enough                  |
//! | the workspace, few                         | the same in directions apart, and together    | it holds so next to some points   |
//! | the workspace                              | by what each differs from one                 | it holds next to each centre      |
//! | the workspace, few                         | the same in directions apart, and together    | the last was hopeless             |
//! | the workspace and the tolerance            | all of them                                   | this was, too                     |
//!
//! Without tolerances there is one way, the fourth.

use super::evidence::{Apart, Prover};
use super::parts::Parts;
use super::search::{resume, search, Ends, Outcome};
use crate::search::{Budget, Control, Stop};
use orthocert_kernel::problem::Problem;
use std::cell::Cell;

/// Boxes after which tolerances are taken apart: certificates in ranges are shorter. The second number is of platforms that
/// turn.
const MOST_IN_RANGES: [usize; 2] = [2000, 8];
/// Boxes of one level with tolerances in parts.
const MOST_ABREAST: usize = 4096;
/// Boxes after which directions, and what quantities change together, are looked at.
const MOST_IN_ONE: usize = 500;
/// Boxes with directions apart: each takes long, and few are enough where they help.
pub(super) const FEW_APART: usize = 300;
/// The same where it is known that they do next to the worst points.
pub(super) const MOST_APART: usize = 2000;

/// With derivatives by what machines differ by, and second ones.
pub(super) fn with_derivatives(problem: Problem) -> Problem {
    with_second_derivatives(problem.with_derivatives())
}

/// With second derivatives too, of machines whose rows are tested at vertices.
fn with_second_derivatives(problem: Problem) -> Problem {
    if problem.legs.iter().all(|leg| leg.scaled.is_some()) {
        return problem;
    }
    let by = problem.differing().collect();
    problem.with_second_derivatives(&by)
}

/// A short tree of a problem with tolerances, in ranges; where there is none, the problem to search.
pub(super) fn in_ranges(
    problem: &Problem,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Outcome, Box<Problem>> {
    let derived = problem.clone().with_derivatives();
    if derived.derived.is_none() {
        return Err(Box::new(derived));
    }
    let most = MOST_IN_RANGES[usize::from(!problem.orientation.is_empty())];
    let found = Prover::new(problem)
        .map(|prover| Ways::new(&prover, (&[], 0), budget.at_most(most)).boxes(true, control));
    // Second derivatives are for what ranges do not show.
    let found = found.ok().filter(Outcome::is_proof);
    found.ok_or_else(|| Box::new(with_second_derivatives(derived)))
}

/// The ways to a tree of a problem.
pub(super) struct Ways<'a, 'p> {
    prover: &'a Prover<'p>,
    points: &'a [Vec<f64>],
    most_apart: usize,
    /// Of each way.
    budget: Budget,
    /// So many boxes with directions apart were tried, and were no proof.
    tried_apart: Cell<usize>,
}

/// How tolerances are taken in parts.
pub(super) struct InParts<'a> {
    /// A point next to which tests have to hold, with tolerances in few parts.
    pub about: Option<&'a [f64]>,
    /// The boxes, in those that are worth it.
    pub times: usize,
    /// Whether directions are apart.
    pub apart: bool,
}

impl<'a, 'p> Ways<'a, 'p> {
    /// The ways to a tree of a problem that is nearest to failing at these points; where its tests hold there with directions
    /// apart, with so many boxes of these.
    pub fn new(
        prover: &'a Prover<'p>,
        (points, most_apart): (&'a [Vec<f64>], usize),
        budget: Budget,
    ) -> Self {
        Ways { prover, points, most_apart, budget, tried_apart: Cell::default() }
    }

    /// A proof by any of them, or what the boxes of the workspace leave open; these are given up where they are hopeless if
    /// `hopeless` says so.
    pub fn tree(&self, hopeless: bool, control: &mut Control<'_>) -> Outcome {
        self.few(control).unwrap_or_else(|before| {
            let found = self.boxes_after(before, hopeless, control);
            match found.stop {
                Stop::Hopeless => self.apart_or_in_parts(control).unwrap_or(found),
                _ => found,
            }
        })
    }

    /// Boxes of the workspace, from those on which [`Ways::few`] stopped; none where one of these was hopeless.
    pub fn boxes_after(
        &self,
        before: Option<Outcome>,
        hopeless: bool,
        control: &mut Control<'_>,
    ) -> Outcome {
        let Some(before) = before else { return self.boxes(hopeless, control) };
        match before.stop {
            Stop::Boxes | Stop::Exhausted if before.waiting.len() < before.open.len() => {
                Outcome { stop: Stop::Hopeless, ..before }
            }
            Stop::Boxes => {
                let most = self.budget.max_boxes.saturating_sub(before.boxes);
                let (ends, budget) =
                    (Ends { hopeless, ..Ends::default() }, self.budget.at_most(most));
                let found = resume(self.prover, &before, ends, budget, control);
                found.expect("it is of the same tree")
            }
            _ => before,
        }
    }

    /// Boxes of the workspace.
    pub fn boxes(&self, hopeless: bool, control: &mut Control<'_>) -> Outcome {
        self.at_most(usize::MAX, hopeless, control)
    }

    fn at_most(&self, most: usize, hopeless: bool, control: &mut Control<'_>) -> Outcome {
        let ends = Ends { hopeless, ..Ends::default() };
        search(self.prover, ends, self.budget.at_most(most), control)
    }

    /// A proof of few boxes of a problem with tolerances; with directions apart if the tests hold so next to the points.
    ///
    /// # Errors
    /// What the few boxes without left open.
    pub fn few(&self, control: &mut Control<'_>) -> Result<Outcome, Option<Outcome>> {
        let problem = self.prover.problem;
        let is_meant = problem.derived.is_some() && problem.orientation.is_empty();
        if !is_meant || self.budget.max_boxes <= MOST_IN_ONE {
            return Err(None);
        }
        let found = self.at_most(MOST_IN_ONE, false, control);
        if found.is_proof() {
            return Ok(found);
        }
        match self.apart(self.most_apart, control).filter(Outcome::is_proof) {
            Some(apart) => Ok(Outcome { boxes: found.boxes + apart.boxes, ..apart }),
            None => Err(Some(found)),
        }
    }

    /// Whether every test holds next to each of the points, with directions apart if they are; not where there is no time
    /// left to see it.
    pub fn holds(&self, apart: bool, control: &Control<'_>) -> bool {
        let goes_on = || !control.is_cancelled() && !self.budget.is_over();
        self.points.iter().all(|point| goes_on() && self.prover.holds_next_to(point, apart))
    }

    /// A proof of at most so many boxes of the workspace, with directions apart where one is hopeless without, or what was
    /// cancelled; none where tests fail so next to the points, and it is not looked for twice.
    pub fn apart(&self, most: usize, control: &mut Control<'_>) -> Option<Outcome> {
        self.prover.problem.derived.as_ref().filter(|_| most > self.tried_apart.get())?;
        if !self.holds(true, control) {
            return None;
        }
        let ends = Ends { hopeless: true, ..Ends::default() };
        let found = search(&Apart(self.prover), ends, self.budget.at_most(most), control);
        self.tried_apart.set(most);
        found.is_final().then_some(found)
    }

    /// A proof where boxes of the workspace are hopeless, or what was cancelled.
    pub fn apart_or_in_parts(&self, control: &mut Control<'_>) -> Option<Outcome> {
        self.apart(FEW_APART, control).or_else(|| {
            let all = InParts { about: None, times: 1, apart: true };
            self.in_parts(&all, usize::MAX, control)
        })
    }

    /// A proof with tolerances in parts, where no box of the workspace is small enough, or what was cancelled; of at most so
    /// many boxes.
    pub fn in_parts(
        &self,
        InParts { about, times, apart }: &InParts<'_>,
        most: usize,
        control: &mut Control<'_>,
    ) -> Option<Outcome> {
        let parts = Parts::new(self.prover, *apart)?;
        let ends = Ends { hopeless: true, enough: Some(MOST_ABREAST) };
        let budget = self.budget.at_most(most.min(times * parts.most()));
        if about.is_some_and(|point| !parts.hold_next_to(point, budget, control)) {
            return None;
        }
        Some(search(&parts, ends, budget, control)).filter(Outcome::is_final)
    }
}
