//! What becomes of a cell of some coordinates, for all values of the others.
//!
//! The values of the others at which a requirement is worst at the cell's centre are looked for first. If
//! one fails there, the cell is outer if that value fails on all of it; else it is split. If none is
//! found, the cell is cut into parts along the others, until every requirement is shown on each, or until
//! a part varies more along what is paved: then the cell is split along that.

use super::decide::{Decision, Fate};
use crate::search::solver::doubles::Pair;
use crate::search::solver::evidence::Prover;
use crate::search::solver::refute::{approximate, failures};
use crate::search::solver::sample::{Place, Quality, Sampler, Worst};
use crate::search::solver::search::Boxes;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::input::Value;
use orthocert_kernel::paving::{
    bit, discharged, Axis, Cell, Edge, Item, Judge, Kind, Outer, Step, Subject, AT_BITS,
    MAX_AXIS_LEVEL, MOST_OTHERS,
};

/// Most parts that a cell is cut into.
const MOST_PARTS: usize = 64;
/// Values of the others that are tried for a failure throughout a cell.
const MOST_FAILURES: usize = 3;
/// Halvings of the steps by which the worst values of the others are looked for.
const STEPS: std::ops::RangeInclusive<i32> = 2..=5;
/// What is left to the edge of a curved set, so that a rounded value is in it.
const ROOM: f64 = 1e-4;
/// Digits of what shows a failure.
const DIGITS: i32 = 6;

/// Decides such cells.
pub struct ForAll<'a> {
    subject: &'a Subject,
    /// The ends of angles that are paved, in degrees.
    angles: Vec<Option<Pair>>,
    /// Values of the others at which all is looked at: parts of their ranges.
    poses: Vec<Vec<f64>>,
}

impl<'a> ForAll<'a> {
    /// For a subject; `None` if all of its coordinates are paved as they are.
    pub fn new(subject: &'a Subject) -> Option<Self> {
        subject.header.coordinates.as_ref()?;
        let [paved, others] = &subject.order;
        let places = subject.problem.corners[0].len();
        let degrees = |value: &Value| match value {
            Value::HalfTangent(angle) => approximate(angle),
            _ => None,
        };
        let angle = |&k: &usize| {
            let [min, max] = subject.problem.orientation.get(k.checked_sub(places)?)?;
            Some((degrees(&min.value)?, degrees(&max.value)?))
        };
        let n = others.len();
        let corners = (0..1usize << n).map(|i| (0..n).map(|k| (i >> k & 1) as f64).collect());
        let faces = (0..2 * n)
            .map(|i| (0..n).map(|k| if k == i / 2 { (i % 2) as f64 } else { 0.5 }).collect());
        let poses = corners.chain(faces).chain([vec![0.5; n]]).collect();
        Some(ForAll { subject, angles: paved.iter().map(angle).collect(), poses })
    }

    /// The ranges of a cell's coordinates, in the problem's order and unit.
    fn ranges(&self, prover: &Prover<'_>, cell: &Cell) -> Vec<Pair> {
        let between = |edge: &Edge, (lo, hi): Pair| {
            let at = |j: u64| {
                let part = (edge.index() + j) as f64 * (-f64::from(edge.level())).exp2();
                lo * (1.0 - part) + hi * part
            };
            (at(0), at(1))
        };
        let tangent = |degrees: f64| (degrees.to_radians() / 2.0).tan();
        let [paved, others] = &self.subject.order;
        let mut ranges = prover.root.clone();
        for ((&k, edge), angle) in paved.iter().zip(&cell.edges).zip(&self.angles) {
            ranges[k] = match angle {
                Some(ends) => {
                    let (lo, hi) = between(edge, *ends);
                    (tangent(lo), tangent(hi))
                }
                None => between(edge, ranges[k]),
            };
        }
        for (&k, edge) in others.iter().zip(cell.others) {
            ranges[k] = between(&edge, ranges[k]);
        }
        ranges
    }

    /// Decides a cell on which `inherited` is discharged already.
    pub fn decide(
        &self,
        (judge, prover, sampler): (&Judge<'_>, &Prover<'_>, &Sampler<'_>),
        cell: &Cell,
        inherited: u128,
    ) -> Decision {
        let attempt = Attempt { of: self, judge, prover, sampler, cell, inherited };
        attempt.decided()
    }
}

/// The decision of a cell.
struct Attempt<'a, 'b> {
    of: &'b ForAll<'a>,
    judge: &'b Judge<'a>,
    prover: &'b Prover<'a>,
    sampler: &'b Sampler<'a>,
    cell: &'b Cell,
    inherited: u128,
}

/// What has come of the parts of a cell.
enum Parts {
    /// All are inner, or outside.
    Shown(Vec<Item>),
    /// One is not; what each coordinate moves it by.
    Not { steps: Vec<Step>, weights: Vec<f64> },
}

impl Attempt<'_, '_> {
    fn order(&self) -> [&[usize]; 2] {
        let [paved, others] = &self.of.subject.order;
        [paved, others]
    }

    fn confirms(&self, cell: &Cell, done: u128, item: &Item) -> bool {
        self.judge.confirms(cell, done, item)
    }

    fn decided(&self) -> Decision {
        let ranges = self.of.ranges(self.prover, self.cell);
        let worst = self.worst(&ranges);
        if let Some(outer) = self.outer(&worst) {
            return Decision::closed(outer);
        }
        let least = worst.first();
        if let Some(least) = least.filter(|worst| worst.margin < 0.0) {
            return self.open(Vec::new(), &self.moved(&ranges, least));
        }
        // Where it fails at a corner, it is not inner.
        let fails = |worst: &&Worst| self.corners(&ranges, worst).any(|margin| margin < 0.0);
        let crossing = worst.iter().find(fails);
        let most = if crossing.is_some() { 1 } else { MOST_PARTS };
        match self.parts(most) {
            Parts::Shown(mut items) => {
                let first = items.remove(0);
                Decision { steps: first.steps, parts: items, ..Decision::closed(first.kind) }
            }
            Parts::Not { steps, weights } => match crossing {
                Some(worst) => self.open(steps, &self.moved(&ranges, worst)),
                None => self.open(steps, &weights),
            },
        }
    }

    fn open(&self, steps: Vec<Step>, weights: &[f64]) -> Decision {
        let [paved, _] = self.order();
        let axes = Axis::ALL.into_iter().zip(paved);
        let axes = axes.filter(|(axis, _)| self.cell.edges[axis.index()].level() < MAX_AXIS_LEVEL);
        let axis = axes.max_by(|(a, i), (b, j)| {
            // The first of equals.
            weights[**i].total_cmp(&weights[**j]).then(b.index().cmp(&a.index()))
        });
        Decision {
            steps,
            fate: Fate::Open(axis.map(|(axis, _)| axis)),
            parts: Vec::new(),
            margins: None,
        }
    }

    /// A place: the cell's centre or what `at` says of its ranges, with these values of the others.
    fn place(&self, ranges: &[Pair], at: impl Fn(usize) -> f64, pose: &[f64]) -> Place {
        let [paved, others] = self.order();
        let point = |(lo, hi): &Pair| 0.5 * (lo + hi);
        let mut point: Vec<f64> = ranges.iter().map(point).collect();
        for (i, &k) in paved.iter().enumerate() {
            let (lo, hi) = ranges[k];
            point[k] = lo + at(i) * (hi - lo);
        }
        let mut u = self.sampler.parts_of(&point);
        for (&k, part) in others.iter().zip(pose) {
            u[k] = *part;
        }
        Place { u, t: self.sampler.centre().t }
    }

    fn pose(&self, place: &Place) -> Vec<f64> {
        let [_, others] = self.order();
        others.iter().map(|&k| place.u[k]).collect()
    }

    /// The worst values of the others that are found at the cell's centre, for what is not discharged:
    /// the worst first.
    fn worst(&self, ranges: &[Pair]) -> Vec<Worst> {
        let places = self.of.poses.iter().map(|pose| self.place(ranges, |_| 0.5, pose));
        let grid: Vec<_> = places.map(|place| (self.sampler.at(&place), place)).collect();
        let is_open = |quality: &Quality| match quality {
            Quality::Obligation(o) => self.inherited & bit(*o) == 0,
            Quality::Determinant => self.inherited & bit(0) == 0,
            Quality::Reach => true,
        };
        let worst = |quality: Quality| {
            let margins = grid.iter().map(|(at, place)| (self.sampler.margin(quality, at), place));
            let (margin, place) = margins.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(Worst { quality, place: place.clone(), margin })
        };
        let qualities = self.sampler.qualities().into_iter().filter(is_open);
        let mut all: Vec<Worst> = qualities.filter_map(worst).collect();
        let by_margin = |a: &Worst, b: &Worst| a.margin.total_cmp(&b.margin);
        all.sort_by(by_margin);
        if all.first().is_some_and(|worst| worst.margin >= 0.0) {
            all.iter_mut().take(MOST_FAILURES).for_each(|worst| self.descend(worst));
            all.sort_by(by_margin);
        }
        all
    }

    /// Goes to worse values of the others.
    fn descend(&self, worst: &mut Worst) {
        let [_, others] = self.order();
        for step in STEPS.map(|step| f64::from(-step).exp2()) {
            for (&k, step) in others.iter().flat_map(|k| [(k, step), (k, -step)]) {
                let mut place = worst.place.clone();
                place.u[k] = (place.u[k] + step).clamp(0.0, 1.0);
                let margin = self.sampler.margin_at(worst.quality, &place);
                if margin < worst.margin {
                    (worst.place, worst.margin) = (place, margin);
                }
            }
        }
    }

    /// The margins of a quality at the cell's corners, at its worst values of the others.
    fn corners<'w>(
        &'w self,
        ranges: &'w [Pair],
        worst: &'w Worst,
    ) -> impl Iterator<Item = f64> + 'w {
        let pose = self.pose(&worst.place);
        let [paved, _] = self.order();
        (0..1usize << paved.len()).map(move |corner| {
            let place = self.place(ranges, |i| (corner >> i & 1) as f64, &pose);
            self.sampler.margin_at(worst.quality, &place)
        })
    }

    /// By how much a quality differs between the ends of each coordinate that is paved.
    fn moved(&self, ranges: &[Pair], worst: &Worst) -> Vec<f64> {
        let pose = self.pose(&worst.place);
        let [paved, _] = self.order();
        let mut weights = vec![0.0; ranges.len()];
        for (i, &k) in paved.iter().enumerate() {
            let margin = |end: f64| {
                let place = self.place(ranges, |j| if i == j { end } else { 0.5 }, &pose);
                self.sampler.margin_at(worst.quality, &place)
            };
            let (low, middle, high) = (margin(0.0), margin(0.5), margin(1.0));
            weights[k] = (high - middle).abs().max((low - middle).abs());
        }
        weights
    }

    /// The failure on all of the cell at one of the worst values of the others.
    fn outer(&self, worst: &[Worst]) -> Option<Kind> {
        let failing = worst.iter().filter(|worst| worst.margin < 0.0);
        failing.take(MOST_FAILURES).find_map(|worst| self.failure(worst))
    }

    fn failure(&self, worst: &Worst) -> Option<Kind> {
        let problem = &self.of.subject.problem;
        let scale = f64::from(AT_BITS).exp2();
        let is_cut = problem.turned.is_some() || problem.inside.is_some();
        let parts = self.sampler.parts(&worst.place.u);
        let [_, others] = self.order();
        let at: Vec<i64> = others
            .iter()
            .map(|&k| {
                let part = parts[k].clamp(0.0, 1.0);
                let part = if is_cut { 0.5 + (part - 0.5) * (1.0 - ROOM) } else { part };
                (part * scale).round() as i64
            })
            .collect();
        let claim = self.sampler.claim();
        let all = failures(claim, problem, self.sampler, worst, DIGITS);
        let kinds = all.into_iter().take(3).map(|failure| match others.is_empty() {
            true => Kind::Outer(Outer::Given(failure.into())),
            false => Kind::At(at.clone(), Outer::Given(failure.into())),
        });
        let item = |kind| Item { steps: Vec::new(), kind };
        kinds.map(item).find(|item| self.confirms(self.cell, 0, item)).map(|item| item.kind)
    }

    /// Cuts the cell into parts along the others until all is shown on each.
    fn parts(&self, most: usize) -> Parts {
        let problem = &self.of.subject.problem;
        let [paved, others] = self.order();
        let mut items = Vec::new();
        let mut waiting = vec![(*self.cell, self.inherited)];
        let mut above = Vec::new();
        let mut tried = 0;
        while let Some((cell, done)) = waiting.pop() {
            tried += 1;
            let open = (0..problem.obligations.len()).filter(|&o| done & bit(o) == 0);
            let open: Vec<usize> = open.collect();
            let ranges = self.of.ranges(self.prover, &cell);
            let trial = self.prover.trial(&ranges, &open, false);
            let item = |steps: Vec<Step>, kind| Item { steps, kind };
            let is_outside = trial.node.by.iter().any(|step| step.1 == Evidence::Outside);
            if is_outside && cell.is_part() {
                let outside = item(Vec::new(), Kind::Outside);
                if self.confirms(&cell, done, &outside) {
                    items.push(outside);
                    continue;
                }
            }
            let steps = trial.node.by.into_iter();
            let steps = steps.filter(|step| step.1 != Evidence::Outside);
            let steps: Vec<Step> = steps.map(|step| Step(step.0, Some(step.1))).collect();
            let inner = item(steps, Kind::Inner);
            if !is_outside && trial.open.is_empty() && self.confirms(&cell, done, &inner) {
                items.push(inner);
                continue;
            }
            let mut steps = inner.steps;
            let split = |step: &Step| item(vec![step.clone()], Kind::Split(Axis::X));
            steps.retain(|step| self.confirms(&cell, done, &split(step)));
            if tried == 1 {
                above.clone_from(&steps);
            }
            let weights = match trial.weights.is_empty() {
                true => ranges.iter().map(|(lo, hi)| hi - lo).collect(),
                false => trial.weights,
            };
            let along = |all: &[usize]| all.iter().map(|&k| weights[k]).fold(0.0, f64::max);
            let other = (0..others.len().min(MOST_OTHERS))
                .max_by(|&a, &b| weights[others[a]].total_cmp(&weights[others[b]]).then(b.cmp(&a)));
            let parts = other.and_then(|k| Some((k, cell.parts(k)?)));
            let is_along_others = along(others) > 0.0 && along(others) >= along(paved);
            match parts.filter(|_| tried < most && is_along_others) {
                Some((k, (lower, upper))) => {
                    let done = discharged(done, &steps);
                    waiting.extend([(upper, done), (lower, done)]);
                    items.push(item(steps, Kind::Part(k)));
                }
                None => return Parts::Not { steps: above, weights },
            }
        }
        Parts::Shown(items)
    }
}
