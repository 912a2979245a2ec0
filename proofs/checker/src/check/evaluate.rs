//! Evaluates the steps of a node on its cell.

use super::walk::{discharges, Discharged};
use crate::cell::Cell;
use crate::certificate::Step;
use crate::enclosure::Enclosure;
use crate::expansion::{Expansion, ExpansionPoint, OutOfReach};
use crate::fixed::Fixed;
use crate::model::Model;
use crate::rule::{self, Failure};
use crate::word::Word;
use std::cell::OnceCell;

/// A claim's model in big integers and, where that is worth having, in machine words, of as many
/// bits or fewer. Each test is evaluated in words first and, if it fails there, in big integers.
///
/// A rule holds of whatever its intervals enclose: what it admits in either, it admits.
pub(crate) struct Evaluator {
    fixed: Model<Fixed>,
    word: Option<Model<Word>>,
}

impl Evaluator {
    /// `word` has the numbers of the same claim as `fixed`.
    pub fn new(fixed: Model<Fixed>, word: Option<Model<Word>>) -> Self {
        Evaluator { fixed, word }
    }

    /// What the steps discharge on the cell; else the rule that does not apply, and why.
    pub fn steps(
        &self,
        cell: &Cell,
        steps: &[Step],
    ) -> Result<Discharged, (&'static str, Failure)> {
        let (centre, word_centre) = (OnceCell::new(), OnceCell::new());
        let mut discharged = 0;
        for step in steps {
            let admitted = |model| check_step(model, cell, step, &word_centre).is_ok();
            if !self.word.as_ref().is_some_and(admitted) {
                check_step(&self.fixed, cell, step, &centre).map_err(|why| (step.rule().0, why))?;
            }
            discharged |= discharges(step);
        }
        Ok(discharged)
    }
}

/// The expansion of a cell about its centre, made for the first step that needs it.
type CentreExpansion<S> = OnceCell<Result<Expansion<S>, OutOfReach>>;

fn check_step<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    step: &Step,
    centre: &CentreExpansion<S>,
) -> Result<(), Failure> {
    let about_centre = || {
        let expansion = centre.get_or_init(|| Expansion::new(model, cell, ExpansionPoint::Centre));
        expansion.as_ref().map_err(|&error| Failure::from(error))
    };
    match step {
        Step::Lower(rotation) => rule::lower(model, about_centre()?, rotation),
        Step::Entrywise(rotation) => rule::entrywise(model, about_centre()?, rotation),
        Step::Upper => rule::upper(model, about_centre()?),
        Step::Range => rule::range(model, cell, about_centre()?),
        Step::Cube => rule::cube(model),
        Step::Corner(corner) => {
            if !corner.touches(cell) {
                return Err(Failure::NotAtCorner);
            }
            rule::corner(model, &Expansion::new(model, cell, corner.expansion_point())?)
        }
        Step::Conditioning(evidence) => {
            rule::conditioning(model, about_centre()?, &evidence.rotation, &evidence.mu)
        }
        Step::SerialMargin => rule::serial_margin(model, cell),
        Step::ParallelMargin => rule::parallel_margin(model, cell),
        Step::LegAngle => rule::leg_angle(model, cell),
        Step::Speed => rule::speed(model, about_centre()?),
        Step::Outside => rule::outside(model, cell),
    }
}
