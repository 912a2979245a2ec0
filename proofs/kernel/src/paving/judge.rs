//! What is shown of a cell, in exact arithmetic.

use super::cell::{Cell, Edge};
use super::code::{Item, Kind, Outer, Step};
use super::cut::SLACK_PLACES;
use super::reader::Visited;
use super::{symmetry, Header, Rejected, MOST_OBLIGATIONS, NOT_A_BOX};
use crate::arithmetic::{Arithmetic as _, Enclosure as _};
use crate::cell::Cell as Ranges;
use crate::certificate::PRECISIONS;
use crate::fixed::{Fixed, Integer, Interval};
use crate::input::{half_tangent, narrowed, Input, Value};
use crate::number::Expression;
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::Slopes;
use crate::step::Checker;
use crate::test::{Over, Place};
use crate::witness::fails_throughout;
use num_bigint::BigInt;
use num_rational::BigRational;
use std::collections::HashMap;

/// Where a cell fails, other coordinates are multiples of `2^-AT_BITS` of their range.
pub const AT_BITS: u32 = 16;
/// Most bits of the fractions between which an angle is paved.
const MOST_ANGLE: u64 = 256;
const ANGLES: Rejected =
    Rejected::Whole("an angle that is paved does not range between fractions of at most 256 bits");

/// What the nodes of a paving are about.
pub struct Subject {
    /// The first line.
    pub header: Header,
    /// Its claim, compiled.
    pub problem: Problem,
    /// The coordinates that are paved, and the others, by their places in the problem.
    pub order: [Vec<usize>; 2],
    /// The ends in degrees of each angle that is paved, by its place among the orientations.
    angles: HashMap<usize, [BigRational; 2]>,
    words: Fixed<i64>,
    any_size: Fixed<BigInt>,
}

impl Subject {
    /// Of the pavings that begin with this header, which is checked.
    ///
    /// # Errors
    /// If it is not admissible.
    pub fn new(header: &Header) -> Result<Self, Rejected> {
        let order = header.order()?;
        let bits = header.precision;
        if !PRECISIONS.contains(&bits) {
            return Err(Rejected::Precision(bits));
        }
        let is_whole = header.coordinates.is_none();
        if header.symmetry.is_some() && !(is_whole && symmetry::is_symmetric(&header.claim.machine))
        {
            let why = "the claim is not provably the same in every permutation of the coordinates";
            return Err(Rejected::Whole(why));
        }
        let problem = Problem::new(&header.claim.machine)?;
        let of_two_points = |test: &Test| matches!(test, Test::OneToOne(_));
        if problem.obligations.iter().any(|obligation| of_two_points(&obligation.test)) {
            let why = "the claim is about two points at a time: one_to_one has no region";
            return Err(Rejected::Whole(why));
        }
        if problem.obligations.len() > MOST_OBLIGATIONS {
            return Err(Rejected::Whole("the claim has more than 128 obligations"));
        }
        let (words, any_size) = (Fixed::new(bits), Fixed::new(bits));
        let places = problem.corners[0].len();
        let angle = |k: usize| {
            let ends = problem.orientation.get(k)?;
            Some((k, [degrees(&ends[0])?, degrees(&ends[1])?]))
        };
        let angles = order[0].iter().filter_map(|k| k.checked_sub(places)).map(angle);
        let angles = angles.collect::<Option<_>>().ok_or(ANGLES)?;
        let subject = Subject { header: header.clone(), problem, order, angles, words, any_size };
        let [min, max] = subject.corners::<BigInt>()?;
        let has_volume = |k: &usize| min.get(*k).zip(max.get(*k)).is_some_and(|(a, b)| a.hi < b.lo);
        let has_volume = subject.order[0].iter().all(has_volume);
        has_volume.then_some(subject).ok_or(NOT_A_BOX)
    }

    fn corners<Z: Integer>(&self) -> Result<[Vec<Interval<Z>>; 2], Rejected> {
        let bits = self.header.precision;
        let corner = |side: usize| self.problem.corner(side, bits);
        corner(0).zip(corner(1)).map(|(min, max)| [min, max]).ok_or(NOT_A_BOX)
    }

    /// What is shown on the path to a cell on which nothing is left to be shown.
    pub fn all(&self) -> u128 {
        (0..self.problem.obligations.len()).fold(0, |all, o| all | bit(o))
    }
}

/// The place of an obligation in sets of them.
pub fn bit(obligation: usize) -> u128 {
    u32::try_from(obligation).ok().and_then(|o| 1u128.checked_shl(o)).unwrap_or(0)
}

/// What is discharged once these steps are added.
pub fn discharged(before: u128, steps: &[Step]) -> u128 {
    steps.iter().fold(before, |done, Step(o, _)| done | bit(*o))
}

/// Checks the evidence of cells.
pub struct Judge<'a> {
    pub(crate) subject: &'a Subject,
    /// In machine words, as far as these do: they give what the others give, or nothing.
    pub(crate) words: Option<Side<'a, i64>>,
    pub(crate) any_size: Side<'a, BigInt>,
}

pub(crate) struct Side<'a, Z: Integer> {
    arithmetic: &'a Fixed<Z>,
    checker: Checker<'a, Fixed<Z>>,
    corners: [Vec<Interval<Z>>; 2],
}

impl<'a> Judge<'a> {
    /// For the nodes about a subject.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(subject: &'a Subject) -> Result<Self, Rejected> {
        let words = Side::new(subject, &subject.words).ok();
        let words = words.filter(|_| subject.header.precision < 60);
        Ok(Judge { subject, words, any_size: Side::new(subject, &subject.any_size)? })
    }

    /// Checks the evidence of a node.
    ///
    /// # Errors
    /// If it does not hold.
    pub fn check(&self, visited: &Visited) -> Result<(), Rejected> {
        let Visited { cell, inherited, item, node, .. } = visited;
        match &item.kind {
            Kind::Boundary => return Ok(()),
            Kind::Split(_) | Kind::Part(_) if item.steps.is_empty() => return Ok(()),
            Kind::Mirrored => {
                let is = self.subject.header.symmetry.is_some() && symmetry::is_mirrored(cell);
                return is.then_some(()).ok_or(Rejected::Node(
                    *node,
                    " is left out by symmetry, but has points with u_x < u_y < u_z",
                ));
            }
            _ => {}
        }
        let (words, place) = (self.words.as_ref(), (*node, cell, *inherited));
        if words.is_some_and(|side| side.item(self.subject, place, item).is_ok()) {
            return Ok(());
        }
        self.any_size.item(self.subject, place, item)
    }
}

impl<'a, Z: Integer> Side<'a, Z> {
    fn new(subject: &'a Subject, arithmetic: &'a Fixed<Z>) -> Result<Self, Rejected> {
        let parameters = subject.problem.parameters(arithmetic.bits(), &[])?;
        let checker = Checker::new(&subject.problem, arithmetic, parameters, None);
        Ok(Side { arithmetic, checker, corners: subject.corners()? })
    }

    /// For each of the problem's coordinates its expansion point, range and half-width over a cell, the
    /// others at the values where it is said to fail.
    ///
    /// **Lemma.** All points of the cell are in the ranges, at these values of the others. *Proof.*
    /// [`Edge::range`], of the angles themselves where these are paved: the tangent of half of them
    /// increases. ∎
    fn edges(&self, subject: &Subject, cell: &Cell, kind: &Kind) -> Option<Edges<Z>> {
        let (e, [min, max], [paved, others]) = (self.arithmetic, &self.corners, &subject.order);
        let places = subject.problem.corners[0].len();
        let mut ranges = min.clone();
        for (edge, &k) in cell.edges.iter().zip(paved) {
            *ranges.get_mut(k)? = match k.checked_sub(places) {
                None => Edge::range(e, edge.level(), edge.ends(), [min.get(k)?, max.get(k)?])?,
                Some(angle) => turned(edge, subject.angles.get(&angle)?, e.bits())?,
            };
        }
        for (i, (edge, &k)) in cell.others.iter().zip(others).enumerate() {
            let (level, ends) = match kind {
                Kind::At(at, _) => (AT_BITS, [*at.get(i)?; 2]),
                _ => (edge.level(), edge.ends()),
            };
            *ranges.get_mut(k)? = Edge::range(e, level, ends, [min.get(k)?, max.get(k)?])?;
        }
        let is_more = matches!(kind, Kind::At(at, _) if at.len() > others.len());
        Ranges(ranges).edges().filter(|_| !is_more)
    }

    /// An inner node's cell has every obligation discharged: on its path, by its steps, or by the
    /// obligation's own evidence.
    pub(crate) fn item(
        &self,
        subject: &Subject,
        (node, cell, inherited): (u64, &Cell, u128),
        item: &Item,
    ) -> Result<(), Rejected> {
        let step = |o| Rejected::Step(node, o);
        let outer = || Rejected::Node(node, " is not outer: it does not certainly fail throughout");
        let edges = self.edges(subject, cell, &item.kind).ok_or_else(outer)?;
        let is_given = item.steps.iter().any(|step| step.1.is_some())
            || matches!(item.kind, Kind::Outer(Outer::Given(_)) | Kind::At(..) | Kind::Outside);
        let values = match is_given {
            true => self.checker.evaluate(&edges),
            false => self.checker.evaluate_own(&edges),
        };
        let slopes = self.checker.slopes(edges.len());
        let place = Place::new(&edges, [false; 2]);
        let over = Over::new(&place, slopes, &values);
        let shown = |over: &Over<'_, _>, obligation: usize, evidence: Option<&_>| {
            let obligations = &subject.problem.obligations;
            let test = &obligations.get(obligation).ok_or_else(|| step(obligation))?.test;
            let holds = match evidence {
                Some(evidence) => self.checker.shows(over, test, evidence),
                None => self.checker.shows_own(over, test),
            };
            holds.then_some(()).ok_or_else(|| step(obligation))
        };
        item.steps.iter().try_for_each(|Step(o, evidence)| shown(&over, *o, evidence.as_ref()))?;
        let rest_shown = |over: &Over<'_, _>| {
            let open = subject.all() & !discharged(inherited, &item.steps);
            let mut all = (0..subject.problem.obligations.len()).filter(|&o| open & bit(o) != 0);
            all.try_for_each(|o| shown(over, o, None))
        };
        // Points whose box is that of the workspace are certainly in it.
        let is_inside = |g| values.of(g).is_some_and(|g| self.arithmetic.is_nonnegative(&g.range));
        let bound =
            subject.problem.inside.iter().map(|inside| inside.g).chain(subject.problem.turned);
        let fails = match &item.kind {
            Kind::Inner => return rest_shown(&over),
            Kind::Cut(cut) => {
                let [before, beyond] = cut.corners();
                rest_shown(&Over { slopes: Slopes { part: Some(&before), ..slopes }, ..over })?;
                let beyond = Slopes { part: Some(&beyond), ..slopes };
                self.is_near(subject, cell, &edges) == Some(true)
                    && self.checker.fails_own(beyond, &values, cut.fails)
            }
            Kind::Outside => self.checker.is_outside(&over),
            Kind::At(..) if !bound.clone().all(is_inside) => false,
            Kind::Outer(outer) | Kind::At(_, outer) => match outer {
                Outer::Own(o) => self.checker.fails_own(slopes, &values, *o),
                Outer::Given(failure) => {
                    fails_throughout(&subject.problem, slopes, &values, failure)
                }
            },
            Kind::Split(_) | Kind::Part(_) | Kind::Boundary | Kind::Mirrored => true,
        };
        fails.then_some(()).ok_or_else(outer)
    }

    /// Whether what is enclosed of a cell differs from it by as little as cuts allow.
    ///
    /// **Lemma.** Let both ends of a coordinate, `l` and `r`, be enclosed up to `s`, in `[a, a + s]` and
    /// `[b - s, b]`, `h` the half-width of `[a, b]` from `c`, `t` one unit in the last place. Where a point is in
    /// the cell, from -1 at `l` to 1 at `r`, differs from `(x - c)/h` by at most `(s + t)/h`. *Proof.* Both are
    /// affine in `x`, and do so at both ends: `c - a` is `h`, or `h - t`. ∎ So what is before `c` in
    /// the cell is before `c + sum |n_k| (s_k + t)/h_k` in what is enclosed.
    fn is_near(&self, subject: &Subject, cell: &Cell, edges: &Edges<Z>) -> Option<bool> {
        let (e, [min, max]) = (self.arithmetic, &self.corners);
        let unit = e.dyadic(1, e.bits(), &e.integer(1)?)?;
        let mut all = cell.edges.iter().zip(&subject.order[0]).map(|(edge, &k)| {
            let near = |j: i64| {
                let Interval { lo, hi } =
                    Edge::range(e, edge.level(), [j, j], [min.get(k)?, max.get(k)?])?;
                let width = e.sub(&Interval::point(hi), &Interval::point(lo))?;
                let most = e.dyadic(1 << SLACK_PLACES, 0, &e.add(&width, &unit)?)?;
                Some(e.is_nonnegative(&e.sub(&edges.get(k)?[2], &most)?))
            };
            edge.ends().into_iter().try_fold(true, |holds, j| Some(holds && near(j)?))
        });
        all.try_fold(true, |holds, own| Some(holds && own?))
    }
}

/// Centre, range and half-width of coordinates.
type Edges<Z> = Vec<[Interval<Z>; 3]>;

/// The degrees of an angle, a fraction that is short: each node asks for multiples of it.
fn degrees(end: &Input) -> Option<BigRational> {
    let Value::HalfTangent(x) = &end.value else { return None };
    x.rational().filter(|x| x.numer().bits().max(x.denom().bits()) <= MOST_ANGLE)
}

/// The tangents of half of a range of angles, of which the edge is a part.
fn turned<Z: Integer>(
    edge: &Edge,
    [min, max]: &[BigRational; 2],
    bits: u32,
) -> Option<Interval<Z>> {
    let parts = 1i64.checked_shl(edge.level())?;
    let whole = |n: i64| BigRational::from_integer(n.into());
    let at = |j: i64| {
        let x = (min * whole(parts.checked_sub(j)?) + max * whole(j)) / whole(parts);
        let literal = |digits: &BigInt| Expression::Literal { digits: digits.clone(), places: 0 };
        half_tangent(&(&literal(x.numer()) / &literal(x.denom())), 0, bits)
    };
    let [from, to] = edge.ends();
    narrowed(&Interval { lo: at(from)?.lo, hi: at(to)?.hi })
}
