//! The outer end of an extreme: a bound that is certified.

use super::found::Found;
use super::NotEnclosed;
use crate::search::solver::evidence::Prover;
use crate::search::solver::extremes::Extreme;
use crate::search::solver::sample::{Sampler, Worst};
use crate::search::solver::search::{resume, Ends, Open, Outcome};
use crate::search::solver::trees::{with_derivatives, InParts, Ways, FEW_APART};
use crate::search::solver::value::of_sought;
use crate::search::solver::{accepted, look_into};
use crate::search::{Budget, Control, Stop};
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;

/// Open boxes from whose centres a better inner end is looked for.
const OPEN_CENTRES: usize = 8;
/// One of so many boxes of a width may be open where a looser one goes on.
const FEW_OPEN: usize = 8;
/// With tolerances in parts each width may take so many times the boxes that are worth it elsewhere.
const TIMES_IN_PARTS: usize = 4;

/// What became of the attempt to certify an outer end.
pub enum Attempt {
    /// It is certified, after so many boxes.
    Certified(Box<Certificate>, usize),
    /// The quantity goes beyond it, at the place that is now known.
    Worse,
    /// No proof was found.
    Undecided(Stop),
}

/// Attempts at the outer end of one extreme, each with what is known from those before.
pub struct Attempts<'a> {
    extreme: &'a Extreme,
    /// The most extreme place known.
    pub known: Found,
    /// The tree of a tighter bound, from which that of a looser one goes on.
    begun: Option<Outcome>,
    /// Whether tolerances in parts have directions apart: where without no width is shown.
    apart: bool,
    budget: Budget,
}

impl<'a> Attempts<'a> {
    /// None yet; each has this budget.
    pub fn new(extreme: &'a Extreme, known: Found, budget: Budget) -> Self {
        Attempts { extreme, known, begun: None, apart: false, budget }
    }

    /// Tries to certify a claim about the extreme alone.
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn certify(
        &mut self,
        claim: &MachineClaim,
        is_loosest: bool,
        control: &mut Control<'_>,
    ) -> Result<Attempt, NotEnclosed> {
        let problem = with_derivatives(Problem::new(claim)?);
        let prover = Prover::new(&problem)?;
        let sampler = Sampler::new(claim, &problem)?;
        let point = sampler.point(&self.known.place.u);
        let points = std::slice::from_ref(&point);
        let ways = Ways::new(&prover, (points, FEW_APART), self.budget);
        // Tolerances may be too wide at the worst place found already.
        let holds_there = prover.holds_next_to(&point, false);
        let mut found = None;
        if holds_there {
            if let Some(before) = &self.begun {
                let ends = Ends { hopeless: true, ..Ends::default() };
                found = resume(&prover, before, ends, self.budget, control);
            } else {
                let few = match ways.few(control) {
                    Ok(found) => match accepted(claim, &prover, found.nodes) {
                        Ok((certificate, _)) => {
                            return Ok(Attempt::Certified(certificate, found.boxes))
                        }
                        Err(_) => None,
                    },
                    Err(before) => before,
                };
                found = Some(ways.boxes_after(few, true, control));
            }
        }
        if is_hopeless(found.as_ref()) {
            found = ways.apart(FEW_APART, control).or(found);
        }
        if is_hopeless(found.as_ref()) && problem.orientation.len() <= 1 {
            found = self.in_parts(&ways, &point, is_loosest, control).or(found);
        }
        let Some(found) = found else { return Ok(Attempt::Undecided(Stop::Hopeless)) };
        if found.stop == Stop::Cancelled {
            return Err(NotEnclosed::Cancelled);
        }
        if found.is_proof() {
            return match accepted(claim, &prover, found.nodes) {
                Ok((certificate, _)) => Ok(Attempt::Certified(certificate, found.boxes)),
                // Without the tree that was begun.
                Err(_) if self.begun.take().is_some() => self.certify(claim, is_loosest, control),
                Err(_) => Ok(Attempt::Undecided(Stop::Hopeless)),
            };
        }
        if self.take_worse(claim, (&problem, &sampler), &found.open)? {
            return Ok(Attempt::Worse);
        }
        // Boxes of platforms that turn are costly each: looser bounds go on from the tree of this one, unless it has
        // so many open that a looser tree may lack most of them.
        let (stop, open) = (found.stop, found.open.len());
        let few = open <= self.budget.max_boxes / FEW_OPEN && open == found.waiting.len();
        if stop == Stop::Boxes && few && !problem.orientation.is_empty() {
            self.begun = Some(found);
        }
        Ok(Attempt::Undecided(stop))
    }

    /// With tolerances in parts.
    fn in_parts(
        &mut self,
        ways: &Ways<'_, '_>,
        point: &[f64],
        is_loosest: bool,
        control: &mut Control<'_>,
    ) -> Option<Outcome> {
        let mut parts = |apart: bool| {
            let all = InParts { about: Some(point), times: TIMES_IN_PARTS, apart };
            ways.in_parts(&all, if apart { FEW_APART } else { usize::MAX }, control)
        };
        let found = parts(self.apart);
        if found.is_some() || self.apart || !is_loosest {
            return found;
        }
        self.apart = true;
        parts(true)
    }

    /// Takes a centre of these boxes for the place known, if the quantity goes beyond the bound there, and farther
    /// than at that place; tells whether there is one.
    fn take_worse(
        &mut self,
        claim: &MachineClaim,
        (problem, sampler): (&Problem, &Sampler<'_>),
        open: &[Open],
    ) -> Result<bool, NotEnclosed> {
        let place = sampler.centre();
        let unknown = |quality| Worst { quality, place: place.clone(), margin: f64::MAX };
        let mut worst: Vec<Worst> = of_sought(problem).map(unknown).collect();
        look_into(sampler, open, OPEN_CENTRES, &mut worst);
        worst.retain(|found| found.margin < 0.0);
        worst.sort_by(|a, b| a.margin.total_cmp(&b.margin));
        for worst in worst {
            match self.extreme.value_at(claim, problem, sampler, &worst)? {
                Some(value) if self.extreme.is_beyond(value, self.known.value) => {
                    (self.known.value, self.known.place) = (value, worst.place);
                    return Ok(true);
                }
                _ => {}
            }
        }
        Ok(false)
    }
}

/// Whether more boxes would not help, or there are none.
fn is_hopeless(found: Option<&Outcome>) -> bool {
    found.is_none_or(|found| found.stop == Stop::Hopeless)
}
