//! What becomes of one cell: proposed in doubles, confirmed in exact arithmetic.
//!
//! What a test bounds is looked at to first order: its value at the cell's centre, and by how much each
//! coordinate moves it. Where that decides the test, the exact judge is asked; where it does not, the
//! cell is split along the coordinate that moves most what is closest to failing.

use super::others::ForAll;
use crate::paving::spectrum::Spectrum;
use crate::solver::doubles::{magnitude, middle, Pair, Single};
use crate::solver::evidence::{Over, Prover};
use crate::solver::refute::directions;
use crate::solver::sample::{Place, Quality, Sampler};
use orthocert_kernel::certificate::Failure;
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::paving::{
    bit, discharged, is_mirrored, Axis, Cell, Item, Judge, Kind, Outer, Rejected, Step, Subject,
    MAX_AXIS_LEVEL,
};
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Row;

/// How much a test has to hold by on a cell that is split, for its step to be tried there: in what
/// the cell moves its value by.
const ROOM: f64 = 1.5;
/// Obligations of own steps, and of own failures, that have a byte.
const MOST_STEPS: usize = 16;
const MOST_FAILURES: usize = 64;

/// Decides cells of one claim.
pub struct Decider<'a> {
    subject: &'a Subject,
    judge: Judge<'a>,
    prover: Prover<'a>,
    sampler: Sampler<'a>,
    /// Of some coordinates, for all values of the others.
    for_all: Option<ForAll<'a>>,
    /// Of a claim about machines within tolerances, evidence may have to be given.
    has_tolerances: bool,
    /// So it may of that, and has to be where tests have none of their own.
    gives_evidence: bool,
}

/// What becomes of a cell.
#[derive(Clone, Debug)]
pub struct Decision {
    /// What is shown of all of it.
    pub steps: Vec<Step>,
    /// What it is.
    pub fate: Fate,
    /// The nodes of its parts, if it is in parts.
    pub parts: Vec<Item>,
}

impl Decision {
    pub(super) fn closed(kind: Kind) -> Self {
        Decision { steps: Vec::new(), fate: Fate::Closed(kind), parts: Vec::new() }
    }
}

/// What a cell is.
#[derive(Clone, Debug)]
pub enum Fate {
    /// Decided.
    Closed(Kind),
    /// Undecided; to be split along this axis, if it may be split.
    Open(Option<Axis>),
}

/// A value that is not negative where a test holds: at the centre, by how much each coordinate moves it to
/// first order, and, about, beyond that.
#[derive(Clone, Copy, Default)]
struct Margin {
    centre: f64,
    along: [f64; 3],
    beyond: [f64; 3],
}

impl Margin {
    fn reach(&self) -> f64 {
        self.along.iter().map(|x| x.abs()).sum()
    }

    /// How close it is to failing, relative to what the cell moves it by.
    fn room(&self) -> f64 {
        self.centre / self.reach().max(f64::MIN_POSITIVE)
    }

    /// What is gained by halving each coordinate.
    fn weights(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.along[k].abs() + self.beyond[k].abs())
    }

    fn times(self, factor: f64) -> Self {
        let times = |all: [f64; 3]| all.map(|x| x * factor);
        let Margin { centre, along, beyond } = self;
        Margin { centre: centre * factor, along: times(along), beyond: times(beyond) }
    }

    fn plus(self, other: Self) -> Self {
        let sum = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k] + b[k]);
        let (along, beyond) = (sum(self.along, other.along), sum(self.beyond, other.beyond));
        Margin { centre: self.centre + other.centre, along, beyond }
    }
}

/// `M` at a cell's centre, and what its rows are made of.
struct Local<'a> {
    rows: Vec<(&'a Row<Formula>, [f64; 3], f64)>,
    spectrum: Spectrum,
}

impl<'a> Local<'a> {
    /// `None` unless all is defined there.
    fn of(
        rows: impl Iterator<Item = &'a Row<Formula>>,
        centre: impl Fn(Formula) -> Option<f64>,
    ) -> Option<Self> {
        let mut own = Vec::with_capacity(6);
        let (mut gram, mut m) = ([0.0; 6], 0);
        for row in rows {
            let d = centre(row.d).filter(|d| *d > 0.0)?;
            let mut a = [0.0; 3];
            m = row.a.len();
            for (a, &f) in a.iter_mut().zip(&row.a) {
                *a = centre(f)?;
            }
            let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
            for (sum, (j, k)) in gram.iter_mut().zip(pairs) {
                *sum += a[j] * a[k] / d;
            }
            own.push((row, a, d));
        }
        // Of fewer than three coordinates, the others take nothing away and add nothing: the mean of
        // the eigenvalues is neither the least nor the greatest alone.
        let mean = gram.iter().take(m).sum::<f64>() / m as f64;
        gram[m.min(3)..3].fill(mean);
        gram.iter()
            .all(|x| x.is_finite())
            .then(|| Local { rows: own, spectrum: Spectrum::of(gram) })
    }

    /// `|M v|^2/|v|^2`.
    fn stretched(&self, over: &Over<'_>, v: [f64; 3]) -> Margin {
        let dot = |a: &[f64; 3]| a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
        // The middle of a slope, and by how much it varies over the cell.
        let slope = |f: Formula, k: usize| {
            let known = over.formulas.of(f).map_or((0.0, 0.0), |slope| slope.slopes[k]);
            (middle(&known), 0.5 * (known.1 - known.0))
        };
        let mut sum = Margin::default();
        for (row, a, d) in &self.rows {
            let product = dot(a);
            sum.centre += product * product / d;
            for k in 0..over.m() {
                let (mut moved, mut varied) = (0.0, 0.0);
                for (&f, v) in row.a.iter().zip(v) {
                    let (middle, varies) = slope(f, k);
                    moved += middle * v;
                    varied += varies * v.abs();
                }
                let (of_d, d_varies) = slope(row.d, k);
                let moved = moved - 0.5 * product * of_d / d;
                sum.along[k] += 2.0 * product * moved / d;
                let varied = 2.0 * varied + product.abs() * d_varies / d;
                sum.beyond[k] += (product.abs() * varied + moved * moved) / d;
            }
        }
        sum.times(dot(&v).recip())
    }
}

impl<'a> Decider<'a> {
    /// For the pavings about a subject.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(subject: &'a Subject) -> Result<Self, Rejected> {
        let (claim, problem) = (&subject.header.claim, &subject.problem);
        let has_tolerances = problem.tolerances().next().is_some();
        let is_general = problem.obligations.iter().any(|own| is_general(&own.test));
        Ok(Decider {
            subject,
            judge: Judge::new(subject)?,
            prover: Prover::new(problem)?,
            sampler: Sampler::new(claim, problem)?,
            for_all: ForAll::new(subject),
            has_tolerances,
            gives_evidence: has_tolerances || is_general,
        })
    }

    /// The exact judge of every decision.
    pub fn judge(&self) -> &Judge<'a> {
        &self.judge
    }

    /// Whether cells stand for their images under permutations.
    pub fn is_symmetric(&self) -> bool {
        self.subject.header.symmetry.is_some()
    }

    /// Whether some coordinates are paved, for all values of the others.
    pub fn is_for_all(&self) -> bool {
        self.for_all.is_some()
    }

    /// The share of the box that a cell stands for.
    pub fn share(&self, cell: &Cell) -> u128 {
        self.subject.header.share(cell)
    }

    fn test(&self, obligation: usize) -> &'a Test {
        &self.subject.problem.obligations[obligation].test
    }

    /// Decides a cell on which `inherited` is discharged already.
    pub fn decide(&self, cell: &Cell, inherited: u128) -> Decision {
        if self.is_symmetric() && is_mirrored(cell) {
            return Decision::closed(Kind::Mirrored);
        }
        if let Some(for_all) = &self.for_all {
            return for_all.decide((&self.judge, &self.prover, &self.sampler), cell, inherited);
        }
        let part = |edge: &orthocert_kernel::paving::Edge, end: u64| {
            (edge.index + end) as f64 * (-f64::from(edge.level)).exp2()
        };
        let edge = |(&(lo, hi), edge): (&Pair, &_)| {
            let at = |u: f64| lo * (1.0 - u) + hi * u;
            (at(part(edge, 0)), at(part(edge, 1)))
        };
        let place = self.prover.root.iter().zip(&cell.edges).map(edge).collect();
        let decided = |over: &Over<'_>| self.decided(cell, inherited, over);
        match self.gives_evidence {
            true => self.prover.on(&place, decided),
            false => self.prover.on_own(&place, decided),
        }
    }

    fn decided(&self, cell: &Cell, inherited: u128, over: &Over<'_>) -> Decision {
        let problem = &self.subject.problem;
        let open = |o: &usize| inherited & bit(*o) == 0;
        let open: Vec<usize> = (0..problem.obligations.len()).filter(open).collect();
        let legs = || problem.legs.iter().map(|leg| &leg.row);
        let centre = |f| over.centre(f);
        let reaches = |d: Formula| over.formulas.of(d).is_some_and(|d| d.range.0 > 0.0);
        let undefined = over.undefined();
        let local = match Local::of(legs(), centre) {
            Some(local) if undefined.is_empty() && legs().all(|row| reaches(row.d)) => local,
            _ => return self.hardly_reached(cell, over, &open, undefined),
        };
        let margins: Vec<Option<Margin>> =
            open.iter().map(|&o| self.margin(over, &local, self.test(o))).collect();
        for (&o, margin) in open.iter().zip(&margins) {
            let outer = match margin {
                Some(margin) if margin.centre + margin.reach() < 0.0 => self.fails(cell, o),
                Some(_) => None,
                None => self.fails_elsewise(cell, o),
            };
            if let Some(outer) = outer {
                return Decision::closed(Kind::Outer(outer));
            }
        }
        // What is closest to failing, or fails at the centre.
        let worst = margins.iter().flatten().min_by(|a, b| a.room().total_cmp(&b.room())).copied();
        if let Some(worst) = worst.filter(|worst| worst.centre < 0.0) {
            return self.split(cell, Vec::new(), worst.weights());
        }
        let (mut steps, mut left, mut own) = (Vec::new(), Vec::new(), Vec::new());
        for (&o, margin) in open.iter().zip(&margins) {
            match margin {
                Some(margin) if margin.room() > 1.0 => own.push((o, margin.room())),
                Some(_) => left.push(o),
                None => match over.evidence(self.test(o)) {
                    Some(evidence) => steps.push(Step(o, Some(evidence))),
                    None => left.push(o),
                },
            }
        }
        let confirms = |steps: &[Step], kind: Kind| {
            self.judge.confirms(cell, inherited, &Item { steps: steps.to_vec(), kind })
        };
        if left.is_empty() && confirms(&steps, Kind::Inner) {
            return Decision { steps, fate: Fate::Closed(Kind::Inner), parts: Vec::new() };
        }
        let is_split = || Kind::Split(Axis::X);
        steps.retain(|step| confirms(std::slice::from_ref(step), is_split()));
        if self.has_tolerances {
            for &(o, _) in &own {
                let given = over.evidence(self.test(o)).map(|evidence| Step(o, Some(evidence)));
                let step = [Some(Step(o, None)).filter(|_| o < MOST_STEPS), given];
                let mut step = step.into_iter().flatten();
                steps.extend(step.find(|step| confirms(std::slice::from_ref(step), is_split())));
            }
        } else {
            let roomy = own.iter().filter(|(o, room)| *o < MOST_STEPS && *room > ROOM);
            let own = roomy.map(|&(o, _)| Step(o, None));
            steps.extend(own.filter(|step| confirms(std::slice::from_ref(step), is_split())));
        }
        let done = discharged(inherited, &steps);
        if done == self.subject.all() {
            return Decision { steps, fate: Fate::Closed(Kind::Inner), parts: Vec::new() };
        }
        let along = match worst {
            Some(worst) if !left.iter().any(|o| is_general(self.test(*o))) => worst.weights(),
            _ => padded(over.weights(&left)),
        };
        self.split(cell, steps, along)
    }

    fn split(&self, cell: &Cell, steps: Vec<Step>, along: [f64; 3]) -> Decision {
        let axes = Axis::ALL.into_iter().take(self.prover.root.len());
        let axis = axes.filter(|axis| cell.edges[axis.index()].level < MAX_AXIS_LEVEL);
        let axis = axis.max_by(|&a, &b| {
            let weight = |axis: Axis| along[axis.index()].abs();
            // The first of equals.
            weight(a).total_cmp(&weight(b)).then(b.cmp(&a))
        });
        Decision { steps, fate: Fate::Open(axis), parts: Vec::new() }
    }

    /// The failure of an obligation in its own directions, where the judge confirms it.
    fn fails(&self, cell: &Cell, obligation: usize) -> Option<Outer> {
        let outer = Outer::Own(obligation);
        let item = Item { steps: Vec::new(), kind: Kind::Outer(outer.clone()) };
        (obligation < MOST_FAILURES && self.judge.confirms(cell, 0, &item)).then_some(outer)
    }

    /// The same of a test that has no directions of its own, by those of the cell's centre.
    fn fails_elsewise(&self, cell: &Cell, obligation: usize) -> Option<Outer> {
        let at = self.sampler.at(&self.centre(cell));
        if self.sampler.margin(Quality::Obligation(obligation), &at) >= 0.0 {
            return None;
        }
        if let Test::Conditioning(_) = self.test(obligation) {
            return self.fails(cell, obligation);
        }
        let test = self.test(obligation);
        let all = directions(test, &self.subject.problem, &self.sampler, &at);
        let of = |directions| Outer::Given(Failure::Obligation(obligation, directions));
        all.into_iter().map(of).find(|outer| {
            let item = Item { steps: Vec::new(), kind: Kind::Outer(outer.clone()) };
            self.judge.confirms(cell, 0, &item)
        })
    }

    fn centre(&self, cell: &Cell) -> Place {
        let u = cell.edges.iter().take(self.prover.root.len());
        let u = u.map(|edge| (edge.index as f64 + 0.5) * (-f64::from(edge.level)).exp2());
        Place { u: u.collect(), ..self.sampler.centre() }
    }

    /// A cell on which some leg may not reach, or a formula is not defined: off the region if that is
    /// so on all of it, or if a row of `M` is too long there; else split where that is closest.
    fn hardly_reached(
        &self,
        cell: &Cell,
        over: &Over<'_>,
        open: &[usize],
        undefined: Vec<Formula>,
    ) -> Decision {
        let problem = &self.subject.problem;
        let item = |kind| Item { steps: Vec::new(), kind };
        let seems = |failure: &Failure| over.fails(failure);
        if seems(&Failure::Reach) {
            let kind = Kind::Outer(Outer::Given(Failure::Reach));
            if self.judge.confirms(cell, 0, &item(kind.clone())) {
                return Decision::closed(kind);
            }
        }
        for &o in open {
            let is_of_values = match self.test(o) {
                Test::SigmaMax(_) => {
                    (0..problem.legs.len()).any(|leg| seems(&Failure::Row(o, leg)))
                }
                Test::AtLeast(_) | Test::Beyond(..) => seems(&Failure::Obligation(o, Vec::new())),
                _ => false,
            };
            if let Some(outer) = is_of_values.then(|| self.fails(cell, o)).flatten() {
                return Decision::closed(Kind::Outer(outer));
            }
        }
        let divisors = problem.legs.iter().map(|leg| leg.row.d);
        let known = undefined.into_iter().chain(divisors);
        let margin = |f: Formula| over.formulas.of(f).map(|slope| Margin::of(over, slope));
        let worst = known.filter_map(margin).min_by(|a, b| a.room().total_cmp(&b.room()));
        let along = worst.map_or_else(|| padded(over.weights(open)), |worst| worst.along);
        self.split(cell, Vec::new(), along)
    }

    fn margin(&self, over: &Over<'_>, local: &Local<'_>, test: &Test) -> Option<Margin> {
        let bound = |f: Formula| over.centre(f);
        let less = |stretched: Margin, bound: f64| Margin {
            centre: stretched.centre - bound,
            ..stretched
        };
        let least = |local: &Local<'_>| local.stretched(over, local.spectrum.least_direction());
        Some(match test {
            Test::SigmaMin(kappa) => less(least(local), bound(*kappa)?),
            Test::SigmaMax(k) => {
                let v = local.spectrum.greatest_direction();
                less(local.stretched(over, v), bound(*k)?).times(-1.0)
            }
            Test::Least(rows, kappa) => {
                let local = Local::of(rows.iter(), |f| over.centre(f))?;
                less(least(&local), bound(*kappa)?)
            }
            Test::Greatest(rows, k) => {
                let local = Local::of(rows.iter(), |f| over.centre(f))?;
                let v = local.spectrum.greatest_direction();
                less(local.stretched(over, v), bound(*k)?).times(-1.0)
            }
            Test::AtLeast(f) => Margin::of(over, over.formulas.of(*f)?),
            Test::Beyond(f, b) => {
                let (f, b) = (over.formulas.of(*f)?, over.formulas.of(*b)?);
                let f = Margin::of(over, f);
                let sign = if f.centre < 0.0 { -1.0 } else { 1.0 };
                f.times(sign).plus(Margin::of(over, b).times(-1.0))
            }
            Test::Conditioning(_)
            | Test::OneToOne(_)
            | Test::Solve(_)
            | Test::Accuracy(_)
            | Test::Apart(_)
            | Test::Curvature(_) => return None,
        })
    }

    /// `sigma_max / sigma_min` at the point with these parts of the box, nearly; infinite out of reach,
    /// and of some coordinates alone.
    pub(super) fn conditioning(&self, u: [f64; 3]) -> f64 {
        if self.for_all.is_some() {
            return f64::INFINITY;
        }
        let point: Vec<f64> =
            self.prover.root.iter().zip(u).map(|((lo, hi), u)| lo * (1.0 - u) + hi * u).collect();
        let problem = &self.subject.problem;
        let parameters = self.prover.parameters();
        let values = problem.tape.run(&Single, |op| match op {
            Op::Coordinate(k) => point.get(k).copied(),
            Op::Parameter(j) => parameters.get(j).map(middle),
            _ => None,
        });
        let rows = problem.legs.iter().map(|leg| &leg.row);
        Local::of(rows, |f| values.of(f).copied()).map_or(f64::INFINITY, |local| {
            let Spectrum { least, greatest, .. } = local.spectrum;
            (greatest / least.max(f64::MIN_POSITIVE)).sqrt()
        })
    }
}

impl Margin {
    fn of(over: &Over<'_>, slope: &orthocert_kernel::slope::Slope<Pair>) -> Self {
        let along = |k: usize| if k < over.m() { magnitude(&slope.slopes[k]) } else { 0.0 };
        let (centre, along) = (middle(&slope.at_centre), std::array::from_fn(along));
        Margin { centre, along, ..Margin::default() }
    }
}

/// Whether a test has no [`Margin`].
fn is_general(test: &Test) -> bool {
    use Test::{Accuracy, Apart, Conditioning, Curvature, OneToOne, Solve};
    matches!(test, OneToOne(_) | Solve(_) | Accuracy(_) | Apart(_) | Curvature(_) | Conditioning(_))
}

fn padded(weights: Vec<f64>) -> [f64; 3] {
    std::array::from_fn(|k| weights.get(k).copied().unwrap_or(0.0))
}
