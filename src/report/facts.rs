//! What answers tell of a claim: the names of what is demanded, and the worst values found.

use super::place::FreeParameter;
use super::Row;
use crate::exact::decimal::{exact, readable};
use crate::exact::Exact;
use crate::search::solver::sample::{Place, Quality, Sampler, Worst};
use crate::search::solver::value::{with_unit, Bounded};
use orthocert_kernel::claim::{Bound, MachineClaim};
use orthocert_kernel::machine::Leg;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;

/// Relative violations below this are rounding errors of the sampling.
const NOISE: f64 = 1e-12;

/// A claim, and what its values are looked up in.
pub struct Facts<'a> {
    pub(super) claim: &'a MachineClaim,
    pub(super) problem: &'a Problem,
    pub(super) sampler: Sampler<'a>,
    angular: bool,
}

/// The name of what is under the roots of a leg's closure.
pub const RADICAND: &str = "least radicand";
/// What a singularity has 0 of.
pub const DETERMINANT: &str = "least |det M|";

/// A number for people.
pub fn shown(x: &Expression) -> String {
    Exact::of(x).map_or_else(|| x.to_string(), |x| readable(&x))
}

impl<'a> Facts<'a> {
    /// About a claim; `None` where its numbers cannot be shown.
    pub fn new(claim: &'a MachineClaim, problem: &'a Problem) -> Option<Self> {
        let sampler = Sampler::new(claim, problem).ok()?;
        let angular = problem.legs.iter().any(Leg::is_angular);
        Some(Facts { claim, problem, sampler, angular })
    }

    pub(super) fn bounded(&self, quality: Quality) -> Option<Bounded> {
        match quality {
            Quality::Obligation(number) => Bounded::of(self.claim, self.problem, number),
            Quality::Reach | Quality::Determinant => None,
        }
    }

    /// Name, unit, relation and other side of what is demanded.
    pub(super) fn demanded(
        &self,
        quality: Quality,
    ) -> (String, Option<&'static str>, &'static str, Vec<Expression>) {
        let Some(bounded) = self.bounded(quality) else {
            let name = match quality {
                Quality::Reach => RADICAND,
                Quality::Determinant => DETERMINANT,
                Quality::Obligation(_) => "least sigma_min(M)",
            };
            return (name.to_owned(), None, ">", vec![Expression::integer(0)]);
        };
        let unit = bounded.unit(self.angular);
        let name = with_unit(&bounded.name(), unit);
        match bounded.relation() {
            Some((relation, sides)) => (name, unit, relation, sides.into_iter().cloned().collect()),
            None => (name, unit, "holds", Vec::new()),
        }
    }

    /// The name of what is demanded of one leg, without the leg.
    fn of_all(&self, quality: Quality) -> Option<String> {
        let bounded = self.bounded(quality)?;
        bounded.leg.map(|_| Bounded { leg: None, ..bounded }.name())
    }

    /// A requirement in words: `greatest psi <= 2`.
    pub(super) fn words(&self, quality: Quality) -> String {
        let (name, _, relation, sides) = self.demanded(quality);
        let side = |x: &Expression| Exact::of(x).map_or_else(|| x.to_string(), |x| exact(&x));
        format!("{name} {}", bound_text(relation, sides.iter().map(side).collect()))
    }

    pub(super) fn value(&self, quality: Quality, found: &Worst) -> Option<f64> {
        let values = self.sampler.at(&found.place);
        self.sampler.matrix(&values)?;
        let lengths = i32::try_from(self.problem.dimension()).ok()?;
        let unit = if self.angular { self.sampler.unit() } else { 1.0 };
        match self.bounded(quality) {
            // Of two points.
            Some(bounded) if bounded.requirement.bound == Bound::Holds => None,
            Some(bounded) => bounded.value(self.claim, self.problem, &self.sampler, &found.place),
            None => Some(match quality {
                // A square of a length.
                Quality::Reach => found.margin * self.sampler.unit().powi(2),
                // Of another sign than at the centre it is 0 on the way there, and not here.
                Quality::Determinant if found.margin < -NOISE => found.margin / unit.powi(lengths),
                Quality::Determinant => found.margin.max(0.0) / unit.powi(lengths),
                Quality::Obligation(_) => found.margin / unit,
            }),
        }
    }

    /// The rows of a verification's worst values.
    pub fn rows(&self, worst: &[Worst]) -> Vec<Row> {
        let mut rows: Vec<Row> = Vec::new();
        for found in worst {
            let (requirement, unit, relation, sides) = self.demanded(found.quality);
            let texts = |text: &dyn Fn(&Expression) -> String| sides.iter().map(text).collect();
            let row = Row {
                requirement,
                of_all: self.of_all(found.quality),
                margin: found.margin,
                unit,
                relation,
                bound_text: bound_text(relation, texts(&shown)),
                bound: bound_text(relation, texts(&Expression::to_string)),
                worst_found: self.value(found.quality, found),
                at: self.sampler.shown(&found.place.u),
                machine: self.machine(&found.place),
                seems_violated: found.margin < -NOISE,
            };
            // Both ends of a range of angles are one row, and so are the tests of one requirement.
            match rows.iter_mut().find(|known| known.requirement == row.requirement) {
                Some(known) => {
                    let seems_violated = known.seems_violated || row.seems_violated;
                    let margin = known.margin.min(row.margin);
                    if row.is_worse_than(known) {
                        *known = row;
                    }
                    (known.seems_violated, known.margin) = (seems_violated, margin);
                }
                None => rows.push(row),
            }
        }
        rows
    }

    fn machine(&self, place: &Place) -> Vec<FreeParameter> {
        let named = self.problem.tolerances().zip(self.sampler.machine(place));
        named
            .map(|((place, ..), value)| {
                let (leg, parameter) = parameter(place);
                FreeParameter { leg, parameter, value }
            })
            .collect()
    }
}

/// `>= 1/2`, `in [-30, 40]`, `holds`.
fn bound_text(relation: &str, sides: Vec<String>) -> String {
    match &sides[..] {
        [] => relation.to_owned(),
        [side] => format!("{relation} {side}"),
        sides => format!("{relation} [{}]", sides.join(", ")),
    }
}

/// The leg, counted from one, and the parameter that a place of the claim names: `leg 1: anchor.0`.
pub fn parameter(place: &str) -> (Option<usize>, String) {
    let split = place.strip_prefix("leg ").and_then(|rest| rest.split_once(": "));
    let (leg, name) = match split {
        Some((leg, name)) => (leg.parse().ok(), name),
        None => (None, place),
    };
    let component = name.split_once('.').and_then(|(name, k)| {
        let axis = ["x", "y", "z"].get(k.parse::<usize>().ok()?)?;
        Some(format!("{name} {axis}"))
    });
    (leg, component.unwrap_or_else(|| name.to_owned()))
}
