//! What becomes of one cell: proposed in doubles, confirmed in exact arithmetic.
//!
//! What a test bounds is looked at to first order: its value at the cell's centre, and by how much each
//! coordinate moves it. Where that decides the test, the exact judge is asked; where it does not, the
//! cell is split along the coordinate that moves most what is closest to failing.

use super::flat::Flat;
use super::margin::{is_general, Local, Margin, View};
use super::others::ForAll;
use crate::search::solver::doubles::{middle, Pair, Single};
use crate::search::solver::evidence::{Over, Prover};
use crate::search::solver::refute::directions;
use crate::search::solver::sample::{Place, Quality, Sampler};
use orthocert_kernel::certificate::Failure;
use orthocert_kernel::few::Few;
use orthocert_kernel::formula::Formula;
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
/// Most obligations whose margins are foreseen.
const MOST_FORESEEN: usize = 2;
pub(super) const MOST_FAILURES: usize = 64;

/// Decides cells of one claim.
pub struct Decider<'a> {
    subject: &'a Subject,
    judge: Judge<'a>,
    prover: Prover<'a>,
    sampler: Sampler<'a>,
    /// The formulas of cells whose tests all have a [`Margin`].
    flat: Option<Flat>,
    /// Of some coordinates, for all values of the others.
    for_all: Option<ForAll<'a>>,
    /// Of a claim about machines within tolerances, evidence may have to be given.
    has_tolerances: bool,
    /// So it may of that, and has to be where tests have none of their own.
    gives_evidence: bool,
    /// Undecided cells are cut.
    cuts: bool,
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
    /// The margins of its obligations, if it is open and all that are have one.
    pub margins: Option<Margins>,
}

/// Obligations with their margins.
pub type Margins = Few<(usize, Margin), MOST_FORESEEN>;

impl Decision {
    pub(super) fn closed(kind: Kind) -> Self {
        Decision { steps: Vec::new(), fate: Fate::Closed(kind), parts: Vec::new(), margins: None }
    }

    /// With the margins that it rests on.
    fn with(self, margins: &[Own]) -> Self {
        let are_few = margins.len() <= MOST_FORESEEN;
        let all = || margins.iter().map(|(o, margin)| Some((*o, (*margin)?))).collect();
        Decision { margins: are_few.then(all).flatten(), ..self }
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

/// An obligation with its margin, if it has one.
type Own = (usize, Option<Margin>);

impl<'a> Decider<'a> {
    /// For the pavings about a subject.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(subject: &'a Subject) -> Result<Self, Rejected> {
        let (claim, problem) = (&subject.header.claim.machine, &subject.problem);
        let has_tolerances = problem.tolerances().next().is_some();
        let is_general = problem.obligations.iter().any(|own| is_general(&own.test));
        let (prover, gives_evidence) = (Prover::new(problem)?, has_tolerances || is_general);
        Ok(Decider {
            subject,
            judge: Judge::new(subject)?,
            flat: Some(&prover).filter(|_| !gives_evidence).and_then(Flat::new),
            prover,
            sampler: Sampler::new(claim, problem)?,
            for_all: ForAll::new(subject),
            has_tolerances,
            gives_evidence,
            cuts: false,
        })
    }

    /// The same that cuts undecided cells, or not.
    pub fn with_cuts(self, cuts: bool) -> Self {
        Decider { cuts, ..self }
    }

    /// Whether undecided cells are cut.
    pub fn cuts(&self) -> bool {
        self.cuts && self.for_all.is_none()
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

    pub(super) fn test(&self, obligation: usize) -> &'a Test {
        &self.subject.problem.obligations[obligation].test
    }

    /// Decides a cell on which `inherited` is discharged already.
    ///
    /// Where margins are `foreseen`, and none so nearly decides its test that it may be wrong about that, they are what
    /// is looked at.
    pub fn decide(&self, cell: &Cell, inherited: u128, foreseen: Option<&Margins>) -> Decision {
        if self.is_symmetric() && is_mirrored(cell) {
            return Decision::closed(Kind::Mirrored);
        }
        if let Some(for_all) = &self.for_all {
            return for_all.decide((&self.judge, &self.prover, &self.sampler), cell, inherited);
        }
        if let Some(sure) = foreseen.filter(|all| all.iter().all(|(_, own)| own.is_sure())) {
            let open = sure.iter().filter(|(o, _)| inherited & bit(*o) == 0);
            let open: Vec<Own> = open.map(|(o, own)| (*o, Some(*own))).collect();
            return self.with_margins(cell, inherited, &open, None);
        }
        let ends = self.ends(cell);
        let flat = self.flat.as_ref().and_then(|flat| flat.over(&ends));
        if let Some(decision) = flat.and_then(|over| self.decided_there(cell, inherited, &over)) {
            return decision;
        }
        let place = ends.into_iter().take(self.prover.root.len()).collect();
        let decided = |over: &Over<'_>| self.decided(cell, inherited, over);
        match self.gives_evidence {
            true => self.prover.on(&place, decided),
            false => self.prover.on_own(&place, decided),
        }
    }

    /// The ends of a cell along each axis.
    fn ends(&self, cell: &Cell) -> [Pair; 3] {
        let mut ends = [(0.0, 0.0); 3];
        for ((own, (lo, hi)), edge) in ends.iter_mut().zip(&self.prover.root).zip(&cell.edges) {
            let (index, size) = (edge.index() as f64, 1.0 / (1u64 << edge.level()) as f64);
            let at = |u: f64| lo * (1.0 - u) + hi * u;
            *own = (at(index * size), at((index + 1.0) * size));
        }
        ends
    }

    /// The coordinates.
    pub(super) fn dimension(&self) -> usize {
        self.prover.root.len()
    }

    /// Whether a cell may be cut.
    pub(super) fn may_cut(&self, cell: &Cell) -> bool {
        self.subject.header.may_cut(cell)
    }

    /// What is so of the formulas over a cell.
    pub(super) fn view<T>(&self, cell: &Cell, then: impl FnOnce(&dyn View) -> T) -> T {
        let ends = self.ends(cell);
        match self.flat.as_ref().and_then(|flat| flat.over(&ends)) {
            Some(over) => then(&over),
            None => {
                let place = ends.into_iter().take(self.dimension()).collect();
                self.prover.on_own(&place, |over| then(over))
            }
        }
    }

    /// The obligation that is nearest to failing over a cell on which `inherited` is discharged; `None` where
    /// not all that are open have margins.
    pub(super) fn nearest(
        &self,
        over: &dyn View,
        local: &Local<'_>,
        inherited: u128,
    ) -> Option<(usize, Margin)> {
        let margins = self.margins(over, local, inherited);
        let margins: Vec<(usize, Margin)> =
            margins.into_iter().map(|(o, own)| Some((o, own?))).collect::<Option<_>>()?;
        margins.into_iter().min_by(|(_, a), (_, b)| a.room().total_cmp(&b.room()))
    }

    /// Decides a cell on which all is defined and every open test has a margin; another is not.
    fn decided_there(
        &self,
        cell: &Cell,
        inherited: u128,
        over: &(impl View + ?Sized),
    ) -> Option<Decision> {
        let margins = self.margins(over, &self.local(over)?, inherited);
        let have = margins.iter().all(|(_, own)| own.is_some());
        have.then(|| self.with_margins(cell, inherited, &margins, None))
    }

    /// The obligations that are open, each with its margin, if it has one.
    fn margins(&self, over: &(impl View + ?Sized), local: &Local<'_>, inherited: u128) -> Vec<Own> {
        let mut margins = Vec::with_capacity(self.subject.problem.obligations.len());
        margins
            .extend(self.open(inherited).map(|o| (o, Margin::of_test(over, local, self.test(o)))));
        margins
    }

    fn decided(&self, cell: &Cell, inherited: u128, over: &Over<'_>) -> Decision {
        let undefined = over.undefined();
        match self.local(over) {
            Some(local) if undefined.is_empty() => {
                let margins = self.margins(over, &local, inherited);
                self.with_margins(cell, inherited, &margins, Some(over))
            }
            _ => {
                let open: Vec<usize> = self.open(inherited).collect();
                self.hardly_reached(cell, over, &open, undefined)
            }
        }
    }

    /// The obligations that are not discharged.
    fn open(&self, inherited: u128) -> impl Iterator<Item = usize> {
        (0..self.subject.problem.obligations.len()).filter(move |&o| inherited & bit(o) == 0)
    }

    /// `M` at the centre, if every leg certainly reaches the cell.
    pub(super) fn local(&self, over: &(impl View + ?Sized)) -> Option<Local<'a>> {
        let legs = || self.subject.problem.legs.iter().map(|leg| &leg.row);
        let reaches = |row: &Row<Formula>| over.range(row.d).is_some_and(|d| d.0 > 0.0);
        legs().all(reaches).then(|| Local::of(legs(), |f| over.centre(f)))?
    }

    fn with_margins(
        &self,
        cell: &Cell,
        inherited: u128,
        margins: &[Own],
        over: Option<&Over<'_>>,
    ) -> Decision {
        let evidence = |o: usize| over.and_then(|over| over.evidence(self.test(o)));
        for &(o, margin) in margins {
            let outer = match margin {
                Some(margin) if margin.fails() => self.fails(cell, o),
                Some(_) => None,
                None => self.fails_elsewise(cell, o),
            };
            if let Some(outer) = outer {
                return Decision::closed(Kind::Outer(outer));
            }
        }
        // What is closest to failing, or fails at the centre.
        let known = || margins.iter().filter_map(|(o, margin)| Some((*o, (*margin)?)));
        let worst = known().map(|(_, own)| own).min_by(|a, b| a.room().total_cmp(&b.room()));
        if let Some(worst) = worst.filter(|worst| worst.centre < 0.0) {
            return self.split(cell, Vec::new(), self.weights(cell, &worst, margins)).with(margins);
        }
        let (mut steps, mut left) = (Vec::new(), 0);
        for &(o, margin) in margins {
            match margin {
                Some(margin) if margin.holds() => {}
                Some(_) => left |= bit(o),
                None => match evidence(o) {
                    Some(evidence) => steps.push(Step(o, Some(evidence))),
                    None => left |= bit(o),
                },
            }
        }
        let confirms = |steps: &[Step], kind: Kind| {
            self.judge.confirms(cell, inherited, &Item { steps: steps.to_vec(), kind })
        };
        if left == 0 && confirms(&steps, Kind::Inner) {
            return Decision { steps, ..Decision::closed(Kind::Inner) };
        }
        let is_split = || Kind::Split(Axis::X);
        steps.retain(|step| confirms(std::slice::from_ref(step), is_split()));
        let own = known().map(|(o, own)| (o, own.room())).filter(|(_, room)| *room > 1.0);
        if self.has_tolerances {
            for (o, _) in own {
                let given = evidence(o).map(|evidence| Step(o, Some(evidence)));
                let step = [Some(Step(o, None)).filter(|_| o < MOST_STEPS), given];
                let mut step = step.into_iter().flatten();
                steps.extend(step.find(|step| confirms(std::slice::from_ref(step), is_split())));
            }
        } else {
            let roomy = own.filter(|(o, room)| *o < MOST_STEPS && *room > ROOM);
            let own = roomy.map(|(o, _)| Step(o, None));
            steps.extend(own.filter(|step| confirms(std::slice::from_ref(step), is_split())));
        }
        let done = discharged(inherited, &steps);
        if done == self.subject.all() {
            return Decision { steps, ..Decision::closed(Kind::Inner) };
        }
        let along = match worst {
            Some(worst) if !self.open(!left).any(|o| is_general(self.test(o))) => {
                self.weights(cell, &worst, margins)
            }
            _ => {
                let left: Vec<usize> = self.open(!left).collect();
                padded(over.map_or_else(Vec::new, |over| over.weights(&left)))
            }
        };
        self.split(cell, steps, along).with(margins)
    }

    /// What is gained by halving each coordinate of a cell: in what is left between two planes where cells are
    /// cut, the first order has no part. Where more than one obligation ends in the cell, or it is its own image, it is not cut.
    fn weights(&self, cell: &Cell, worst: &Margin, margins: &[Own]) -> [f64; 3] {
        let ends = |(_, own): &&Own| own.is_some_and(|margin| margin.room().abs() < 1.0);
        let is_cut = self.cuts() && self.may_cut(cell) && margins.iter().filter(ends).count() == 1;
        match is_cut && worst.beyond.iter().any(|x| *x > 0.0) {
            true => worst.beyond,
            false => worst.weights(),
        }
    }

    fn split(&self, cell: &Cell, steps: Vec<Step>, along: [f64; 3]) -> Decision {
        let axes = Axis::ALL.into_iter().take(self.prover.root.len());
        let axis = axes.filter(|axis| cell.edges[axis.index()].level() < MAX_AXIS_LEVEL);
        let axis = axis.max_by(|&a, &b| {
            let weight = |axis: Axis| along[axis.index()].abs();
            // The first of equals.
            weight(a).total_cmp(&weight(b)).then(b.cmp(&a))
        });
        Decision { steps, fate: Fate::Open(axis), parts: Vec::new(), margins: None }
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
        let of = |directions| Outer::Given(Failure::Obligation(obligation, directions).into());
        all.into_iter().map(of).find(|outer| {
            let item = Item { steps: Vec::new(), kind: Kind::Outer(outer.clone()) };
            self.judge.confirms(cell, 0, &item)
        })
    }

    fn centre(&self, cell: &Cell) -> Place {
        let u = cell.edges.iter().take(self.prover.root.len());
        let u = u.map(|edge| (edge.index() as f64 + 0.5) * (-f64::from(edge.level())).exp2());
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
            let kind = Kind::Outer(Outer::Given(Failure::Reach.into()));
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
        let margin = |f: Formula| Margin::of(over, f);
        let worst = known.filter_map(margin).min_by(|a, b| a.room().total_cmp(&b.room()));
        let along = worst.map_or_else(|| padded(over.weights(open)), |worst| worst.along);
        self.split(cell, Vec::new(), along)
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
        let values =
            problem.tape.run(&Single, |k| point.get(k).copied(), |j| parameters.get(j).map(middle));
        let rows = problem.legs.iter().map(|leg| &leg.row);
        let local = Local::of(rows, |f| values.of(f).copied());
        local.map_or(f64::INFINITY, |local| local.conditioning())
    }
}

fn padded(weights: Vec<f64>) -> [f64; 3] {
    std::array::from_fn(|k| weights.get(k).copied().unwrap_or(0.0))
}
