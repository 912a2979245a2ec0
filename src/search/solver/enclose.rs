//! Certified extremes.
//!
//! An extreme lies between a bound that is certified and one that is refuted.

use super::evidence::Prover;
use super::extremes::Extreme;
use super::refute::witness_at;
use super::sample::{Place, Quality, Sampler, Worst};
use super::search::{resume, Ends, Outcome};
use super::trees::{with_derivatives, InParts, Ways, FEW_APART};
use super::value::{alone, defining, of_sought, Bounded};
use super::{accepted, look_into, refuted, verify, Answer};
use crate::search::{Budget, Control, Steps, Stop};
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, ToPrimitive, Zero};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::problem::Problem;

/// Finest step of the search for an extreme.
const FINEST: i32 = 30;
/// The same where it need not be known better than to a tenth.
const ROUGH: i32 = 8;
/// Open boxes from whose centres a better inner end is looked for.
const OPEN_CENTRES: usize = 8;
/// Boxes after which a width is given up for a looser one. Of platforms that turn it is a third of the second number for
/// each coordinate of orientation, as each takes three times as long, and with tolerances a sixth of what is left.
const MOST_BOXES: [usize; 2] = [50_000, 20_000];
/// One of so many boxes of a width may be open where a looser one goes on.
const FEW_OPEN: usize = 8;
/// With tolerances in parts each width may take so many times the boxes that are worth it elsewhere.
const TIMES_IN_PARTS: usize = 4;
/// How often twice the loosest width that may be asked for is taken, where it has no proof.
const LOOSER: usize = 3;
/// How often a better inner end may turn up before the search is given up.
const ROUNDS: usize = 8;

/// An extreme, enclosed from both sides.
#[derive(Clone, Debug)]
pub struct Enclosed {
    /// The relative width.
    pub width: BigRational,
    /// The quantity goes beyond this (certified by a witness).
    pub inner: BigRational,
    /// The quantity never goes beyond this (certified by a tree).
    pub outer: BigRational,
    /// "Stays within `inner`" is refuted; `None` where that is no claim, as no condition number is less
    /// than 1.
    pub refuted: Option<Box<Certificate>>,
    /// "Stays within `outer`" is certified.
    pub certified: Box<Certificate>,
    /// Boxes tried for the outer end.
    pub boxes: usize,
}

/// Why an extreme is not enclosed.
#[derive(Clone, Debug, thiserror::Error)]
pub enum NotEnclosed {
    /// Some machine has a singularity, or a point out of reach, in the workspace.
    #[error("none: a singularity, or out of reach, inside")]
    Singular,
    /// No proof was found, however wide, or none of a bound that some point is known to be near.
    #[error("not enclosed: no proof that is near enough was found")]
    Undecided,
    /// The time was up before.
    #[error("not enclosed: the time was up")]
    Time,
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The claim is not well formed.
    #[error("{0}")]
    Claim(ClaimError),
}

impl From<ClaimError> for NotEnclosed {
    fn from(error: ClaimError) -> Self {
        NotEnclosed::Claim(error)
    }
}

/// Whether some machine of the claim has a singularity, or a point out of reach, in its workspace:
/// then quantities have no extremes there.
///
/// # Errors
/// If the claim is not well formed, or the search was cancelled.
pub fn is_singular(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<bool, NotEnclosed> {
    let regular = alone(claim, defining(claim).into_iter().collect());
    match verify(&regular, budget, control)?.answer {
        Answer::Decided { accepted, .. } => Ok(accepted.verdict == Verdict::Refuted),
        Answer::Undecided(_) => Ok(false),
        Answer::Cancelled => Err(NotEnclosed::Cancelled),
    }
}

/// Encloses an extreme: see [`Sought::enclose`]; of a claim that is certified as [`Sought::nearer`] says.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn enclose(
    (claim, is_certified): (&MachineClaim, bool),
    extreme: &Extreme,
    relative: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Enclosed, NotEnclosed> {
    if control.is_cancelled() {
        return Err(NotEnclosed::Cancelled);
    }
    let sought = Sought::new(claim, extreme)?;
    let sought = if is_certified { sought.nearer() } else { sought };
    sought.enclose(relative, budget, control)
}

/// An extreme of a claim, and where sampling finds it.
pub struct Sought<'a> {
    claim: &'a MachineClaim,
    extreme: &'a Extreme,
    /// With what it is enclosed first.
    near: Option<Extreme>,
    probe: Problem,
    known: Found,
}

impl<'a> Sought<'a> {
    /// By sampling.
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn new(claim: &'a MachineClaim, extreme: &'a Extreme) -> Result<Self, NotEnclosed> {
        let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
        let known = Found::worst(&probe, extreme, (ROUNDS, FINEST))?;
        Ok(Sought { claim, extreme, near: None, probe: Problem::new(&probe)?, known })
    }

    /// An accuracy's distance is enclosed with an angle, and its angle with a distance, that is not much more than what
    /// sampling finds of it: within the claim's own the machine may be curved by more than what is sought. What is shown so
    /// is another claim, of the same pose where the claim itself is certified.
    #[must_use]
    pub fn nearer(mut self) -> Self {
        self.near = nearer(self.claim, self.extreme);
        self
    }

    /// Encloses it to the relative width `relative`, or where that does not succeed to a looser one, up to eight times
    /// [`loosest`] (for joint coordinates: relative to the greatest size that they take).
    ///
    /// # Errors
    /// See [`NotEnclosed`].
    pub fn enclose(
        &self,
        relative: &BigRational,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let near = self.near.as_ref().map(|near| self.enclose_as(near, relative, budget, control));
        match near {
            None | Some(Err(NotEnclosed::Undecided)) => {
                self.enclose_as(self.extreme, relative, budget, control)
            }
            Some(found) => found,
        }
    }

    fn enclose_as(
        &self,
        extreme: &Extreme,
        relative: &BigRational,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let Sought { claim, probe, known, .. } = self;
        let (budget, mut known) = (of_one_width(budget, probe), known.clone());
        let (mut steps, mut begun) = (Steps::default(), None);
        let found = narrowest(relative, budget.deadline.is_some(), |width| {
            for _ in 0..ROUNDS {
                let step = width * known.size()?;
                let outer = end(extreme, known.value, &step, 2).ok_or(NotEnclosed::Undecided)?;
                // So far out there may be no bound: of an angle, 90 degrees.
                let Some(outer_claim) = extreme.well_formed(claim, &outer) else { break };
                let is_loosest = *width >= loosest();
                let found = steps.next(control, 2, |control| {
                    let how = (&mut begun, is_loosest);
                    certify(&outer_claim, &mut known, extreme, how, budget, control)
                });
                let (certified, boxes) = match found? {
                    Attempt::Certified(certified, boxes) => (certified, boxes),
                    Attempt::Worse => continue,
                    Attempt::Undecided(Stop::Time) => return Err(NotEnclosed::Time),
                    Attempt::Undecided(_) => break,
                };
                // What is too near to its bound to be refuted may not be at a looser width.
                let Some(found) = inner_end(claim, extreme, &known, [relative, width])? else {
                    break;
                };
                let width = (width + width + found.width) / BigRational::from_integer(3.into());
                let Inner { value: inner, refuted, .. } = found;
                return Ok(Some(Enclosed { width, inner, outer, refuted, certified, boxes }));
            }
            Ok(None)
        });
        found?.ok_or(NotEnclosed::Undecided)
    }

    /// Encloses it by the bound that the claim itself has for it: for where no narrower one is proved.
    ///
    /// # Errors
    /// See [`NotEnclosed`]; where the claim has none, it is not enclosed.
    pub fn as_required(
        &self,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Result<Enclosed, NotEnclosed> {
        let Sought { claim, extreme, probe, known, .. } = self;
        let own = extreme.required_bound(claim).ok_or(NotEnclosed::Undecided)?;
        let own_claim = extreme.well_formed(claim, &own).ok_or(NotEnclosed::Undecided)?;
        if budget.is_over() || own.to_f64().is_none_or(|own| !extreme.is_beyond(own, known.value)) {
            return Err(NotEnclosed::Undecided);
        }
        let (budget, mut known) = (of_one_width(budget, probe), known.clone());
        let (certified, boxes) =
            match certify(&own_claim, &mut known, extreme, (&mut None, true), budget, control)? {
                Attempt::Certified(certified, boxes) => (certified, boxes),
                Attempt::Undecided(Stop::Time) => return Err(NotEnclosed::Time),
                Attempt::Undecided(_) | Attempt::Worse => return Err(NotEnclosed::Undecided),
            };
        let [narrowest, widest] = [(1, 1000), (1 << LOOSER, 10)]
            .map(|(n, d): (i64, i64)| BigRational::new(n.into(), d.into()));
        let inner = inner_end(claim, extreme, &known, [&narrowest, &widest])?;
        let Inner { value: inner, refuted, .. } = inner.ok_or(NotEnclosed::Undecided)?;
        let width = (&own - &inner).abs() / known.size()?;
        Ok(Enclosed { width, inner, outer: own, refuted, certified, boxes })
    }
}

/// With a bound on the other part of an accuracy of half as much again as what sampling finds of it, if the claim's is more;
/// what is as small as nothing has some room all the same.
fn nearer(claim: &MachineClaim, extreme: &Extreme) -> Option<Extreme> {
    let (other, own) = extreme.other_part(claim)?;
    let ratio = |n: i64, d: i64| BigRational::new(n.into(), d.into());
    let seen = Found::worst(&other.probe(claim)?, &other, (1, ROUGH)).ok()?;
    let found = beyond(seen.value, &ratio(3, 2))?.max(&own * ratio(1, 1000));
    extreme.with_other_part(&found).filter(|_| found < own)
}

/// What is found at the width `relative`, or else at the narrowest of its doubles up to [`loosest`], by halves of
/// their exponents, or else at the first of the doubles beyond: a width is as easy as all narrower ones. Where time is
/// short the loosest is first, and one between.
/// Once something is found, it stays so whatever then goes wrong.
pub(super) fn narrowest<T>(
    relative: &BigRational,
    is_short: bool,
    mut at: impl FnMut(&BigRational) -> Result<Option<T>, NotEnclosed>,
) -> Result<Option<T>, NotEnclosed> {
    let mut wider = vec![relative.clone()];
    while let Some(last) = wider.last().filter(|last| **last < loosest()) {
        wider.push((last + last).min(loosest()));
    }
    let last = wider.len() - 1;
    for _ in 0..LOOSER {
        wider.extend(wider.last().map(|last| last + last));
    }
    let first = if is_short { &[last, last / 2, 0][..] } else { &[0, last] };
    // Found at `holds`, and nothing at and below `fails`.
    let (mut fails, mut holds) = (None, wider.len());
    let mut best = None;
    let mut next = first.iter().copied().chain(last + 1..wider.len());
    loop {
        let asked = next.find(|k| *k < holds && fails.is_none_or(|fails| *k > fails));
        let between = fails.filter(|fails| best.is_some() && holds - fails > 1);
        let middle = between.map(|fails| (fails + holds) / 2);
        let Some(k) = asked.or(middle) else { return Ok(best) };
        match at(&wider[k]) {
            Ok(Some(found)) => (best, holds) = (Some(found), k),
            Ok(None) => fails = Some(k),
            Err(error) => return best.map(Some).ok_or(error),
        }
    }
}

/// The worst that sampling finds of an extreme, and a bound near it, at a relative distance of `relative` or more
/// up to [`loosest`], that is refuted as a certificate says.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn reached(
    claim: &MachineClaim,
    extreme: &Extreme,
    relative: &BigRational,
) -> Result<(f64, Option<BigRational>), NotEnclosed> {
    let Sought { known, .. } = Sought::new(claim, extreme)?;
    let found = inner_end(claim, extreme, &known, [relative, &loosest()])?;
    Ok((known.value, found.filter(|found| found.refuted.is_some()).map(|found| found.value)))
}

/// An inner end, of a width of its own.
struct Inner {
    width: BigRational,
    value: BigRational,
    /// As in [`Enclosed`].
    refuted: Option<Box<Certificate>>,
}

/// The inner end of the narrowest width, from the first to the second and by doubles, of which it is refuted, or is
/// no claim's bound.
fn inner_end(
    claim: &MachineClaim,
    extreme: &Extreme,
    known: &Found,
    [narrowest, widest]: [&BigRational; 2],
) -> Result<Option<Inner>, NotEnclosed> {
    let mut width = narrowest.clone();
    loop {
        let step = &width * known.size()?;
        let mut value = end(extreme, known.value, &step, -1).ok_or(NotEnclosed::Undecided)?;
        if extreme.bounded().requirement.quantity == "conditioning" {
            value = value.max(BigRational::one());
        }
        let own = extreme.well_formed(claim, &value);
        let refuted = own.as_ref().and_then(|claim| refute(claim, &known.place));
        if own.is_none() || refuted.is_some() {
            return Ok(Some(Inner { width, value, refuted }));
        }
        if width >= *widest {
            return Ok(None);
        }
        width = (&width + &width).min(widest.clone());
    }
}

/// What the first sampling finds of an extreme.
///
/// # Errors
/// See [`NotEnclosed`].
pub fn seen(claim: &MachineClaim, extreme: &Extreme) -> Result<f64, NotEnclosed> {
    let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
    Ok(Found::worst(&probe, extreme, (1, FINEST))?.value)
}

/// A decimal near a value times `factor`; none of zero.
pub fn beyond(value: f64, factor: &BigRational) -> Option<BigRational> {
    let value = BigRational::from_f64(value).filter(|value| !value.is_zero())? * factor;
    Some(rounded(&value, &(value.abs() / BigRational::from_integer(10.into()))))
}

/// The budget after which a width, or one of several bounds, is given up.
pub(crate) fn of_one_width(budget: Budget, problem: &Problem) -> Budget {
    let slower = if turns_with_tolerances(problem) { 6 } else { 1 };
    let own = MOST_BOXES[usize::from(!problem.orientation.is_empty())];
    let most = own / 3usize.pow(problem.orientation.len() as u32) / slower;
    budget.at_most(most)
}

/// Whether it is a platform that turns, of a machine with tolerances.
fn turns_with_tolerances(problem: &Problem) -> bool {
    !problem.orientation.is_empty() && problem.tolerances().next().is_some()
}

/// The most extreme place known.
#[derive(Clone)]
struct Found {
    place: Place,
    value: f64,
    /// What widths are relative to, beside the value.
    least_size: f64,
    /// Whether tolerances in parts have directions apart: where without no width is shown.
    apart: bool,
}

impl Found {
    /// By sampling: of a bound that is met with equality at the worst place found so far, the place at
    /// which it is violated most, until there is none.
    fn worst(
        probe: &MachineClaim,
        extreme: &Extreme,
        (rounds, finest): (usize, i32),
    ) -> Result<Self, NotEnclosed> {
        let mut claim = probe.clone();
        let mut best: Option<Found> = None;
        for _ in 0..rounds {
            let problem = Problem::new(&claim)?;
            let sampler = Sampler::new(&claim, &problem)?;
            let mut found: Option<(f64, Place)> = None;
            for Worst { quality, place, .. } in sampler.worst_values(finest) {
                let Quality::Obligation(number) = quality else { continue };
                let Some(bounded) = extreme.of_obligation(&claim, &problem, number) else {
                    continue;
                };
                let value = bounded.value(&claim, &problem, &sampler, &place);
                let value = value.ok_or(NotEnclosed::Singular)?;
                if found.as_ref().is_none_or(|(known, _)| extreme.is_beyond(value, *known)) {
                    found = Some((value, place));
                }
            }
            let (value, place) = found.ok_or(NotEnclosed::Undecided)?;
            let better = best.as_ref().is_none_or(|best| {
                extreme.is_beyond(value, best.value)
                    && (value - best.value).abs() > 1e-12 * value.abs()
            });
            if !better {
                break;
            }
            let least_size = extreme.size(&claim, &problem, &sampler, value);
            best = Some(Found { place, value, least_size, apart: false });
            let value = BigRational::from_f64(value);
            match value.and_then(|value| extreme.well_formed(probe, &value)) {
                Some(tight) => claim = tight,
                None => break,
            }
        }
        best.ok_or(NotEnclosed::Undecided)
    }

    fn size(&self) -> Result<BigRational, NotEnclosed> {
        let size = BigRational::from_f64(self.value.abs().max(self.least_size));
        Ok(size.filter(|x| !x.is_zero()).unwrap_or_else(BigRational::one))
    }
}

impl Extreme {
    /// The bound of an obligation, if it is of this extreme's requirement.
    fn of_obligation(
        &self,
        claim: &MachineClaim,
        problem: &Problem,
        number: usize,
    ) -> Option<Bounded> {
        let is_sought = of_sought(problem).any(|own| own == Quality::Obligation(number));
        let own = |bounded: &Bounded| is_sought && bounded.angle == self.bounded().angle;
        Bounded::of(claim, problem, number).filter(own)
    }

    fn is_beyond(&self, value: f64, other: f64) -> bool {
        if self.is_greatest() {
            value > other
        } else {
            value < other
        }
    }

    /// The greatest size of a joint coordinate, which may be zero at its extreme; of others, zero.
    fn size(
        &self,
        claim: &MachineClaim,
        problem: &Problem,
        sampler: &Sampler<'_>,
        value: f64,
    ) -> f64 {
        if self.bounded().requirement.quantity != "joint_range" {
            return 0.0;
        }
        let at = |place: &Place| self.bounded().value(claim, problem, sampler, place);
        sampler.grid().iter().filter_map(at).map(f64::abs).fold(value.abs(), f64::max)
    }
}

/// The loosest relative width that may be asked for.
pub fn loosest() -> BigRational {
    BigRational::new(1.into(), 10.into())
}

/// A bound at so many thirds of a step beyond the value found. No value is expected to go beyond two, where the
/// proof needs room; the value itself goes beyond one on its inner side.
fn end(extreme: &Extreme, found: f64, step: &BigRational, thirds: i32) -> Option<BigRational> {
    let sign = if extreme.is_greatest() { 1 } else { -1 };
    let beyond = step * BigRational::new((sign * thirds).into(), 3.into());
    Some(rounded(&(BigRational::from_f64(found)? + beyond), step))
}

/// The decimal nearest to `x` on a grid of at most a hundredth of `step`.
pub(super) fn rounded(x: &BigRational, step: &BigRational) -> BigRational {
    let ten = BigRational::from_integer(10.into());
    let mut grid = BigRational::one();
    let wanted = step / BigRational::from_integer(100.into());
    while grid > wanted {
        grid /= &ten;
    }
    (x / &grid).round() * grid
}

/// What became of the attempt to certify an outer end.
enum Attempt {
    Certified(Box<Certificate>, usize),
    /// The quantity goes beyond it, at the place that is now known.
    Worse,
    Undecided(Stop),
}

fn certify(
    claim: &MachineClaim,
    known: &mut Found,
    extreme: &Extreme,
    (begun, is_loosest): (&mut Option<Outcome>, bool),
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Attempt, NotEnclosed> {
    let problem = with_derivatives(Problem::new(claim)?);
    let prover = Prover::new(&problem)?;
    // Tolerances may be too wide at the worst place found already.
    let sampler = Sampler::new(claim, &problem)?;
    let point = sampler.point(&known.place.u);
    let holds_there = prover.holds_next_to(&point, false);
    let points = std::slice::from_ref(&point);
    let ways = Ways::new(&prover, (points, FEW_APART), budget);
    let mut few = None;
    if begun.is_none() && holds_there {
        match ways.few(control) {
            Ok(found) => {
                if let Ok((certificate, _)) = accepted(claim, &prover, found.nodes) {
                    return Ok(Attempt::Certified(certificate, found.boxes));
                }
            }
            Err(before) => few = before,
        }
    }
    let mut found = match &*begun {
        _ if !holds_there => None,
        Some(before) => {
            let ends = Ends { hopeless: true, ..Ends::default() };
            resume(&prover, before, ends, budget, control)
        }
        None => Some(ways.boxes_after(few, true, control)),
    };
    let is_hopeless =
        |found: &Option<Outcome>| found.as_ref().is_none_or(|found| found.stop == Stop::Hopeless);
    if is_hopeless(&found) {
        found = ways.apart(FEW_APART, control).or(found);
    }
    if is_hopeless(&found) && problem.orientation.len() <= 1 {
        let mut in_parts = |apart: bool| {
            let all = InParts { about: Some(&point), times: TIMES_IN_PARTS, apart };
            ways.in_parts(&all, if apart { FEW_APART } else { usize::MAX }, control)
        };
        let mut parts = in_parts(known.apart);
        if parts.is_none() && is_loosest && !known.apart {
            known.apart = true;
            parts = in_parts(true);
        }
        found = parts.or(found);
    }
    let Some(found) = found else { return Ok(Attempt::Undecided(Stop::Hopeless)) };
    if found.stop == Stop::Cancelled {
        return Err(NotEnclosed::Cancelled);
    }
    if found.is_proof() {
        return Ok(match accepted(claim, &prover, found.nodes) {
            Ok((certificate, _)) => Attempt::Certified(certificate, found.boxes),
            Err(_) if begun.take().is_some() => {
                return certify(claim, known, extreme, (begun, is_loosest), budget, control);
            }
            Err(_) => Attempt::Undecided(Stop::Hopeless),
        });
    }
    let place = sampler.centre();
    let unknown = |quality| Worst { quality, place: place.clone(), margin: f64::MAX };
    let mut worst: Vec<Worst> = of_sought(&problem).map(unknown).collect();
    look_into(&sampler, &found.open, OPEN_CENTRES, &mut worst);
    worst.retain(|found| found.margin < 0.0);
    worst.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    for Worst { quality, place, .. } in worst {
        let Quality::Obligation(number) = quality else { continue };
        let Some(bounded) = extreme.of_obligation(claim, &problem, number) else { continue };
        let value =
            bounded.value(claim, &problem, &sampler, &place).ok_or(NotEnclosed::Singular)?;
        if extreme.is_beyond(value, known.value) {
            (known.value, known.place) = (value, place);
            return Ok(Attempt::Worse);
        }
    }
    // Boxes of platforms that turn are costly each: looser bounds go on from the tree of this one, unless it has
    // so many open that a looser tree may lack most of them.
    let (stop, open) = (found.stop, found.open.len());
    let waits =
        stop == Stop::Boxes && open <= budget.max_boxes / FEW_OPEN && open == found.waiting.len();
    if waits && !problem.orientation.is_empty() {
        *begun = Some(found);
    }
    Ok(Attempt::Undecided(stop))
}

/// A refutation at a known place.
fn refute(claim: &MachineClaim, place: &Place) -> Option<Box<Certificate>> {
    let problem = Problem::new(claim).ok()?;
    let sampler = Sampler::new(claim, &problem).ok()?;
    let values = sampler.at(place);
    let worst = of_sought(&problem)
        .map(|quality| (sampler.margin(quality, &values), quality))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let found = Worst { quality: worst.1, place: place.clone(), margin: worst.0 };
    let witness = witness_at(claim, &problem, &sampler, &found)?;
    refuted(claim, witness).ok().map(|(certificate, _)| certificate)
}
