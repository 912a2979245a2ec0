//! How a claim fails at every point of a box, for every machine.

use super::doubles::{middle, Doubles, Pair};
use super::evidence::{edges, Prover};
use super::refute::directions;
use super::sample::{Quality, Sampler};
use super::search::Cell;
use orthocert_kernel::certificate::Failure;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::witness::fails_throughout;

/// Of the roundings of a direction, the one tried first, and the one tried then.
const ROUNDINGS: [usize; 2] = [1, 3];

/// A claim in doubles.
pub struct Failing<'a> {
    prover: Prover<'a>,
    sampler: Sampler<'a>,
    qualities: Vec<Quality>,
}

impl<'a> Failing<'a> {
    /// For a claim and its problem.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(claim: &'a MachineClaim, problem: &'a Problem) -> Result<Self, ClaimError> {
        let sampler = Sampler::new(claim, problem)?;
        let mut qualities = sampler.qualities();
        // Of two points.
        qualities.retain(|quality| *quality != Quality::Determinant);
        Ok(Failing { prover: Prover::new(problem)?, sampler, qualities })
    }

    /// The box of the workspace, in the problem's unit.
    pub fn root(&self) -> &Cell {
        &self.prover.root
    }

    /// The problem's unit of length in the claim's.
    pub fn unit(&self) -> f64 {
        self.sampler.unit()
    }

    /// The least margin at a point: negative where the claim seems to fail.
    pub fn margin(&self, point: &[f64]) -> f64 {
        let values = self.sampler.at_point(point);
        let margins = self.qualities.iter().map(|&quality| self.sampler.margin(quality, &values));
        margins.fold(f64::INFINITY, f64::min)
    }

    /// How the claim fails throughout a box, where that is found.
    pub fn throughout(&self, cell: &[Pair]) -> Option<Failure> {
        let problem = self.prover.problem;
        let formulas = self.prover.checker.evaluate(&edges(cell));
        let slopes = Slopes::new(&Doubles, cell.len());
        let fails = |failure: &Failure| fails_throughout(problem, slopes, &formulas, failure);
        let centre: Vec<f64> = cell.iter().map(middle).collect();
        let values = self.sampler.at_point(&centre);
        let mut failing: Vec<(f64, Quality)> = self
            .qualities
            .iter()
            .map(|&quality| (self.sampler.margin(quality, &values), quality))
            .filter(|(margin, _)| *margin < 0.0)
            .collect();
        failing.sort_by(|a, b| a.0.total_cmp(&b.0));
        let is_defined = self.sampler.matrix(&values).is_some();
        let of = |quality: Quality| -> Vec<Failure> {
            let Quality::Obligation(number) = quality else { return vec![Failure::Reach] };
            let test = &problem.obligations[number].test;
            let mut all = Vec::new();
            if is_defined {
                let roundings = directions(test, problem, &self.sampler, &values);
                let tried = match test {
                    Test::AtLeast(_) | Test::Beyond(..) => &[0][..],
                    _ => &ROUNDINGS,
                };
                let chosen = tried.iter().filter_map(|&i| roundings.get(i).cloned());
                all.extend(chosen.map(|directions| Failure::Obligation(number, directions)));
            }
            if matches!(test, Test::SigmaMax(_)) {
                all.extend((0..problem.legs.len()).map(|leg| Failure::Row(number, leg)));
            }
            all
        };
        failing.into_iter().flat_map(|(_, quality)| of(quality)).find(fails)
    }
}
