//! Values of a claim's quantities in doubles over its workspace, and the worst of them found by sampling:
//! no proof of anything.

use crate::report::{self, Facts};
use crate::search::solver::sample::{At, Place, Quality, Sampler};
use crate::search::solver::value::{turns, Bounded};
use crate::search::solver::{approximate, FINEST};
use orthocert_kernel::certificate::Witness;
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism};
use orthocert_kernel::problem::Problem;

/// Ends of the workspace beyond this are not drawn: their powers would exceed the doubles.
const GREATEST: f64 = 1e60;
/// How far from the workspace's curved sides a point still is in it, as a part of its box.
const NEAR: f64 = 1e-9;

/// A claim in doubles.
pub struct Sampled<'a> {
    claim: &'a MachineClaim,
    problem: &'a Problem,
    sampler: Sampler<'a>,
    facts: Facts<'a>,
}

/// The worst found of a requirement.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The requirement's number.
    pub number: usize,
    /// The value, where, and for which machine.
    pub row: report::Row,
    /// What it is bounded by.
    pub bound: Bound,
    /// The leg, counted from one, of quantities that each leg has.
    pub leg: Option<usize>,
    /// What is left to the bound, as a part of the greater of the two, of joint coordinates of the
    /// stroke; none where nothing is bounded.
    pub left: Option<f64>,
}

impl<'a> Sampled<'a> {
    /// A claim in doubles; `None` where its numbers are beyond them.
    pub fn new(claim: &'a MachineClaim, problem: &'a Problem) -> Option<Self> {
        let sampler = Sampler::new(claim, problem).ok()?;
        let small = |x: &f64| x.abs() < GREATEST;
        let facts = Facts::new(claim, problem)?;
        let is_small = sampler.ends().iter().flatten().all(small);
        is_small.then_some(Sampled { claim, problem, sampler, facts })
    }

    /// Least and greatest value of each coordinate, in the claim's unit.
    pub fn root(&self) -> Vec<[f64; 2]> {
        let [least, greatest] = self.sampler.ends();
        least.into_iter().zip(greatest).map(|(least, greatest)| [least, greatest]).collect()
    }

    /// Operations that a point takes.
    pub fn operations(&self) -> usize {
        self.problem.tape.ops().len()
    }

    /// The requirement that an obligation belongs to.
    pub fn requirement(&self, obligation: usize) -> Option<usize> {
        self.problem.obligations.get(obligation)?.requirement
    }

    /// The words for a counterexample.
    pub fn counterexample(&self, witness: &Witness) -> Option<report::Counterexample> {
        self.facts.counterexample(witness)
    }

    /// The formulas of the nominal machine at a point in the claim's unit; `None` outside the workspace,
    /// out of reach, and at a serial singularity.
    pub fn at(&self, point: &[f64]) -> Option<At<'_>> {
        let units = (0..point.len()).map(|k| self.sampler.unit_of(k));
        let own: Vec<f64> = point.iter().zip(units).map(|(x, unit)| x / unit).collect();
        let parts = self.sampler.parts_of(&own);
        let within = self.sampler.parts(&parts);
        let is_within = parts.iter().zip(&within).all(|(a, b)| (a - b).abs() <= NEAR);
        let place = Place { u: parts, ..self.sampler.centre() };
        let values = is_within.then(|| self.sampler.at(&place))?;
        self.sampler.matrix(&values)?;
        Some(values)
    }

    /// The greatest transmission factor.
    pub fn psi(&self, at: &At) -> Option<f64> {
        let [least, _] = self.sampler.xi(at)?;
        let is_angular = self.problem.legs.iter().any(orthocert_kernel::machine::Leg::is_angular);
        let unit = if is_angular { self.sampler.unit() } else { 1.0 };
        Some(unit / least).filter(|psi| psi.is_finite())
    }

    /// Of a requirement, by its number, the value and the margin of the leg with the least margin: the
    /// margin in place of a value that takes a search.
    pub fn value(&self, number: usize, at: &At) -> Option<(f64, f64)> {
        let own = self.problem.obligations.iter().enumerate();
        let own = own.filter(|(_, own)| own.requirement == Some(number));
        let of = |(obligation, _)| {
            let margin = self.sampler.margin(Quality::Obligation(obligation), at);
            let bounded = Bounded::of(self.claim, self.problem, obligation)?;
            let value = bounded.known(self.problem, &self.sampler, at);
            Some((value.unwrap_or(margin), margin)).filter(|(value, _)| value.is_finite())
        };
        own.filter_map(of).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The worst of every requirement: of those of every leg, the leg with least left.
    pub fn worst(&self) -> Vec<Worst> {
        let found = self.sampler.worst_values(FINEST);
        let all: Vec<(usize, Option<usize>, Bound, report::Row)> = found
            .iter()
            .filter_map(|found| {
                let Quality::Obligation(obligation) = found.quality else { return None };
                let own = &self.problem.obligations[obligation];
                let row = self.facts.rows(std::slice::from_ref(found)).pop()?;
                let bound = Bounded::of(self.claim, self.problem, obligation)?.bound();
                Some((own.requirement?, own.leg.map(|leg| leg + 1), bound, row))
            })
            .collect();
        let left = |number: usize, leg: Option<usize>, bound: &Bound, row: &report::Row| {
            let own = &self.claim.require[number];
            let value = row.worst_found?;
            if !value.is_finite() {
                return Some(f64::NEG_INFINITY);
            }
            let (left, size) = match bound {
                Bound::Min(bound) => (value - approximate(bound)?, approximate(bound)?.abs()),
                Bound::Max(bound) => (approximate(bound)? - value, approximate(bound)?.abs()),
                Bound::Within([min, max]) => {
                    let (min, max) = (approximate(min)?, approximate(max)?);
                    let value = value + turns(value, (min + max) / 2.0);
                    ((value - min).min(max - value), max - min)
                }
                Bound::Holds => return None,
            };
            let same = all.iter().filter(|(other, of, ..)| {
                self.claim.require[*other].quantity == own.quantity && *of == leg
            });
            let values: Vec<f64> = same.filter_map(|(.., row)| row.worst_found).collect();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let stroke = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
            let size = match own.quantity.as_str() {
                "joint_range" if stroke > 0.0 => stroke,
                _ => size.max(value.abs()),
            };
            (size > 0.0).then_some(left / size)
        };
        let mut worst: Vec<Worst> = Vec::new();
        for (number, leg, bound, row) in &all {
            let (number, leg, row, bound) = (*number, *leg, row.clone(), bound.clone());
            let one = Worst { number, leg, left: left(number, leg, &bound, &row), row, bound };
            match worst.iter_mut().find(|other| other.number == number) {
                Some(other) if one.row.is_worse_than(&other.row) => *other = one,
                Some(_) => {}
                None => worst.push(one),
            }
        }
        worst
    }
}

/// How many coordinates, the first, are of the position; none where a user named them.
pub fn positions(claim: &MachineClaim) -> Option<usize> {
    match &claim.mechanism {
        Mechanism::Translational(_) | Mechanism::Orthoglide { .. } | Mechanism::Spatial(_) => {
            Some(3)
        }
        Mechanism::Planar(_) => Some(2),
        Mechanism::Spherical(_) => Some(0),
        Mechanism::Formulas(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    const ORTHOGLIDE: &str = r#"
        [mechanism]
        kind = "orthoglide"
        leg_length = "310 ± 0.1"
        base = 0
        [workspace]
        min = [-60, -60, -60]
        max = [120, 120, 120]
        [requirements]
        transmission = { max = 2 }
        joint_range = { min = -500, max = 0 }
    "#;

    fn with<T>(text: &str, look: impl Fn(&Sampled<'_>) -> T) -> T {
        let claim = Design::parse(text, "test.toml").unwrap().claim;
        let problem = Problem::new(&claim).unwrap();
        look(&Sampled::new(&claim, &problem).unwrap())
    }

    /// At `(c, c, c)`, `M = (1 - m) I + m 11^T` with `m = c/sqrt(L^2 - 2 c^2)`.
    #[test]
    fn values_are_those_of_the_definitions() {
        with(ORTHOGLIDE, |sampled| {
            let c = 100.0;
            let s = (310.0_f64 * 310.0 - 2.0 * c * c).sqrt();
            let at = sampled.at(&[c; 3]).unwrap();
            assert!((sampled.psi(&at).unwrap() - 1.0 / (1.0 - c / s)).abs() < 1e-9);
            let (rho, _) = sampled.value(1, &at).unwrap();
            assert!((rho - (c - s)).abs() < 1e-9);
        });
    }

    #[test]
    fn what_is_left_is_a_part_of_the_bound_or_of_the_stroke() {
        with(ORTHOGLIDE, |sampled| {
            let worst = sampled.worst();
            let [psi, least, greatest] = &worst[..] else { unreachable!("{worst:?}") };
            assert_eq!(psi.row.at, [120.0; 3]);
            let m = 120.0 / (309.9_f64 * 309.9 - 2.0 * 120.0 * 120.0).sqrt();
            assert!((psi.left.unwrap() - (2.0 - 1.0 / (1.0 - m)) / 2.0).abs() < 1e-6);
            // rho = x - sqrt(L^2 - y^2 - z^2), least at x = -60, y = z = 0 with the longest leg.
            let stroke = greatest.row.worst_found.unwrap() - (-60.0 - 310.1);
            assert!((least.left.unwrap() - (500.0 - 370.1) / stroke).abs() < 1e-3);
        });
    }

    /// Corners of the chart's box that are beyond the greatest angle are not in the workspace.
    #[test]
    fn the_corners_of_a_box_of_orientations_are_left_out() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs/kernel");
        let text = std::fs::read_to_string(folder.join("hexapod-linuxcnc.toml")).unwrap();
        with(&text, |sampled| {
            let corner: Vec<f64> = sampled.root().iter().map(|[_, greatest]| *greatest).collect();
            assert!(sampled.at(&corner).is_none());
            assert!(sampled.at(&[4.0, 4.0, 24.0, corner[3], 0.0, 0.0]).is_some());
            for worst in sampled.worst() {
                assert!(!worst.row.seems_violated, "{worst:?}");
                let turn: f64 = worst.row.at[3..].iter().map(|c| c * c).sum();
                assert!(turn.sqrt() <= corner[3] * (1.0 + 1e-9), "{worst:?}");
            }
        });
    }
}
