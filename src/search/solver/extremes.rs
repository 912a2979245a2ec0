//! Certified extremes: how small and how large each quantity of the kernel's table gets.
//!
//! An extreme lies between a bound that is certified and one that is
//! refuted; the claims that say so have that bound alone.

use super::evidence::{Apart, Prover};
use super::parts::Parts;
use super::refute::{number, witness_at};
use super::sample::{Place, Quality, Sampler, Worst};
use super::search::{resume, search, Branch, Ends, Outcome};
use super::value::{alone, Bounded};
use super::{accepted, few, in_parts_of_tolerances, look_into, refuted, verify, Answer};
use crate::exact::Exact;
use crate::search::{Budget, Control, Steps, Stop};
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, Zero};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism, Requirement, Workspace};
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::TABLE;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Finest step of the search for an extreme.
const FINEST: i32 = 30;
/// Open boxes from whose centres a better inner end is looked for.
const OPEN_CENTRES: usize = 8;
/// Boxes after which a width is given up for a looser one. Of platforms that turn it is a third of the second number for
/// each coordinate of orientation, as each takes three times as long, and with tolerances a sixth of what is left.
const MOST_BOXES: [usize; 2] = [50_000, 20_000];
/// One of so many boxes of a width may be open where a looser one goes on.
const FEW_OPEN: usize = 8;
/// With tolerances in parts each width may take so many times the boxes that are worth it elsewhere.
const TIMES_IN_PARTS: usize = 4;
/// Longest text of an exact number.
const MOST_DIGITS: usize = 1000;
/// How often a better inner end may turn up before the search is given up.
const ROUNDS: usize = 8;

/// One end of a quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extreme {
    bounded: Bounded,
}

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
    /// Neither a proof nor a refutation was found within the budget.
    #[error("not enclosed within the budget")]
    Undecided,
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

/// What a quantity is for, where one unit of it is a choice without loss: it is linear in it.
fn unit_given(name: &str) -> Option<Expression> {
    matches!(name, "tool" | "joint").then(|| Expression::integer(1))
}

impl Extreme {
    /// The end of a quantity that a requirement bounds, whatever its bound: of the leg given, counted from
    /// zero, or of all together. `None` where that is no bound on a number.
    pub fn on(requirement: Requirement, leg: Option<usize>) -> Option<Self> {
        let two = Expression::integer(2);
        let bound = match requirement.bound {
            Bound::Min(_) => Bound::Min(two),
            Bound::Max(_) => Bound::Max(two),
            Bound::Within(_) | Bound::Holds => return None,
        };
        let leg_number = leg.map(|leg| leg + 1);
        let requirement = Requirement { bound, leg: leg_number, ..requirement };
        Some(Extreme { bounded: Bounded { requirement, leg, angle: false } })
    }

    /// The quantity, what it is for, and the leg; the bound's number has no meaning.
    pub fn bounded(&self) -> &Bounded {
        &self.bounded
    }

    /// Whether a claim's machines have it.
    pub fn is_of(&self, claim: &MachineClaim) -> bool {
        self.probe(claim).is_some()
    }

    /// The extremes that a claim's machines have, in the order of the table; for the paper's cube
    /// without those of psi, which the claim itself says.
    ///
    /// Joint coordinates have one a leg, all other quantities of legs the worst of all legs'.
    pub fn of(claim: &MachineClaim, legs: usize) -> Vec<Self> {
        let mut all = Extreme::of_the_table(claim, legs);
        all.retain(|extreme| extreme.is_of(claim));
        all
    }

    /// The same, whether the claim's machines have them or not.
    fn of_the_table(claim: &MachineClaim, legs: usize) -> Vec<Self> {
        let cube = matches!(claim.workspace, Workspace::Cube { .. });
        let table = TABLE.iter().filter(|q| !(cube && q.key == "transmission"));
        let mut all = Vec::new();
        for quantity in table {
            let own = claim.require.iter().find(|own| own.quantity == quantity.key);
            let given = |name: &&'static str| {
                let given = own.and_then(|own| own.given.get(*name).cloned());
                let one = unit_given(name).map(|one| vec![one]);
                // The joint speed of a unit of tool speed has a name of its own.
                let numbers = match quantity.key {
                    "joint_speed" => one.or(given),
                    _ => given.or(one),
                }?;
                Some(((*name).to_owned(), numbers))
            };
            let turning = claim.orientation.is_some();
            let more = if turning { quantity.given_turning } else { &[] };
            let names = quantity.given.iter().chain(more);
            let given: Option<BTreeMap<_, _>> = names.map(given).collect();
            let Some(given) = given else { continue };
            // The axes of joints are of their legs.
            let on_legs = claim.require.iter().filter(|own| own.quantity == quantity.key);
            let on_legs = on_legs.filter(|own| own.leg.is_some() && own.given.contains_key("axis"));
            let mut each: Vec<(Option<usize>, BTreeMap<_, _>)> =
                on_legs.map(|own| (own.leg.map(|leg| leg - 1), own.given.clone())).collect();
            if each.is_empty() {
                each = match quantity.key {
                    "joint_range" => (0..legs).map(|leg| (Some(leg), given.clone())).collect(),
                    _ => vec![(None, given)],
                };
            }
            let ends = [Bound::Min as fn(_) -> _, Bound::Max];
            for ((leg, given), end) in each.iter().flat_map(|each| ends.map(|end| (each, end))) {
                let (leg, given) = (*leg, given.clone());
                let bound = end(Expression::integer(2));
                let number = leg.map(|leg| leg + 1);
                let quantity = quantity.key.to_owned();
                let requirement = Requirement { quantity, leg: number, given, bound };
                let angle = Self::angle(claim, &requirement);
                let still = matches!(claim.mechanism, Mechanism::Spherical(_));
                let own = Extreme { bounded: Bounded { requirement, leg, angle: false } };
                // About a point, no position is off.
                all.extend((angle.is_none() || !still).then_some(own));
                all.extend(angle);
            }
        }
        all
    }

    /// Of an accuracy of a platform that turns, the angle, with the distance that the claim has.
    pub fn angle(claim: &MachineClaim, requirement: &Requirement) -> Option<Self> {
        let own = claim.require.iter().find(|own| own.quantity == "accuracy")?;
        let is_it =
            requirement.quantity == "accuracy" && requirement.given.contains_key("max_angle");
        let greatest = matches!(requirement.bound, Bound::Max(_));
        let bounded = Bounded { requirement: own.clone(), leg: None, angle: true };
        (is_it && greatest).then_some(Extreme { bounded })
    }

    /// The extremes that a claim's requirements bound.
    pub fn required(claim: &MachineClaim, legs: usize) -> Vec<Self> {
        let bounds = |own: &Requirement, one: &Requirement| {
            own.quantity == one.quantity
                && (own.leg.is_none() || own.leg == one.leg)
                && std::mem::discriminant(&own.bound) == std::mem::discriminant(&one.bound)
        };
        let is_bounded =
            |one: &Self| claim.require.iter().any(|own| bounds(own, &one.bounded.requirement));
        let mut all = Extreme::of_the_table(claim, legs);
        all.retain(|one| is_bounded(one) && one.is_of(claim));
        all
    }

    /// A bound with which the claim is well formed.
    fn probe(&self, claim: &MachineClaim) -> Option<MachineClaim> {
        let two = BigRational::from_integer(2.into());
        let half = two.recip();
        [two, half].iter().find_map(|bound| self.well_formed(claim, bound))
    }

    /// [`claim`](Self::claim), where it is well formed.
    fn well_formed(&self, claim: &MachineClaim, bound: &BigRational) -> Option<MachineClaim> {
        self.claim(claim, bound).filter(|claim| Problem::new(claim).is_ok())
    }

    /// "The quantity stays within `bound`", and nothing else but what defines the paper's cube.
    fn claim(&self, claim: &MachineClaim, bound: &BigRational) -> Option<MachineClaim> {
        let mut require = vec![self.bounded.bounded_by(number(bound)?)?];
        require.extend(defining(claim));
        Some(alone(claim, require))
    }

    /// The quantity's name in tables.
    pub fn quantity(&self) -> String {
        let Requirement { quantity, .. } = &self.bounded.requirement;
        match (quantity.as_str(), self.bounded.leg) {
            ("accuracy", _) if self.bounded.angle => self.bounded.name(),
            ("transmission", _) => "psi".to_owned(),
            ("joint_range", Some(leg)) => format!("rho_{}", leg + 1),
            ("conditioning", _) => "sigma_max/sigma_min".to_owned(),
            ("serial_margin", _) => "|eta_i|/L_i".to_owned(),
            ("parallel_margin", _) => "|det A|/(L_1 .. L_n)".to_owned(),
            ("joint_speed", _) => "joint/tool speed".to_owned(),
            (_, Some(leg)) => format!("{} {}", quantity.replace('_', " "), leg + 1),
            (_, None) => quantity.replace('_', " "),
        }
    }

    /// What the files of its certificates begin with.
    pub fn file_stem(&self) -> String {
        let Requirement { quantity, .. } = &self.bounded.requirement;
        let end = if self.is_greatest() { "greatest" } else { "least" };
        match (quantity.as_str(), self.bounded.leg) {
            ("accuracy", _) if self.bounded.angle => "accuracy-angle".to_owned(),
            ("transmission", _) => format!("psi-{end}"),
            ("joint_range", Some(leg)) => format!("rho-{}-{end}", leg + 1),
            (_, Some(leg)) => format!("{}-{}", quantity.replace('_', "-"), leg + 1),
            (_, None) => quantity.replace('_', "-"),
        }
    }

    /// The unit of its bounds, where it has one.
    pub fn unit(&self, angular: bool) -> Option<&'static str> {
        match self.bounded.requirement.quantity.as_str() {
            "joint_speed" => angular.then_some("deg/length"),
            _ => self.bounded.unit(angular),
        }
    }

    /// Whether the quantity is bounded from above.
    pub fn is_greatest(&self) -> bool {
        matches!(self.bounded.requirement.bound, Bound::Max(_))
    }
}

/// The extremes of psi that the paper's cube has by definition, with whether each is the greatest.
pub fn of_cube(claim: &MachineClaim) -> Vec<(bool, Exact)> {
    let Some(Bound::Max(psi)) = defining(claim).map(|own| own.bound) else { return Vec::new() };
    let Ok(psi_max) = Exact::parse(&psi.to_string(), MOST_DIGITS) else { return Vec::new() };
    let inverse = Exact::integer(1).over(psi_max.clone()).ok();
    // The least psi is 1/psi_max at Q2 for psi_max <= 2 only.
    let is_least = psi_max.compare(&Exact::integer(2)).is_some_and(Ordering::is_le);
    let least = inverse.filter(|_| is_least).map(|inverse| (false, inverse));
    least.into_iter().chain([(true, psi_max)]).collect()
}

/// What defines the paper's cube.
fn defining(claim: &MachineClaim) -> Option<Requirement> {
    let is_it =
        |own: &&Requirement| own.quantity == "transmission" && matches!(own.bound, Bound::Max(_));
    let cube = matches!(claim.workspace, Workspace::Cube { .. });
    claim.require.iter().find(is_it).filter(|_| cube).cloned()
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

/// Encloses an extreme to the relative width `relative`, or where that does not succeed to a looser
/// one, up to [`loosest`] (for joint coordinates: relative to the greatest size that they take).
///
/// # Errors
/// See [`NotEnclosed`].
pub fn enclose(
    claim: &MachineClaim,
    extreme: &Extreme,
    relative: &BigRational,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Enclosed, NotEnclosed> {
    if control.is_cancelled() {
        return Err(NotEnclosed::Cancelled);
    }
    let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
    let budget = of_one_width(budget, &Problem::new(&probe)?);
    let mut known = Found::worst(&probe, extreme, ROUNDS)?;
    let (mut steps, mut begun) = (Steps::default(), None);
    let found = narrowest(relative, |width| {
        for _ in 0..ROUNDS {
            let step = width * known.size()?;
            let outer = end(extreme, known.value, &step, 2).ok_or(NotEnclosed::Undecided)?;
            let outer_claim = extreme.claim(claim, &outer).ok_or(NotEnclosed::Undecided)?;
            let found = steps.next(control, 2, |control| {
                certify(&outer_claim, &mut known, extreme, &mut begun, budget, control)
            });
            let (certified, boxes) = match found? {
                Attempt::Certified(certified, boxes) => (certified, boxes),
                Attempt::Worse => continue,
                Attempt::Undecided(Stop::Time) => return Err(NotEnclosed::Undecided),
                Attempt::Undecided(_) => break,
            };
            // What is too near to its bound to be refuted may not be at a looser width.
            let Some(found) = inner_end(claim, extreme, &known, [relative, width])? else { break };
            let width = (width + width + found.width) / BigRational::from_integer(3.into());
            let Inner { value: inner, refuted, .. } = found;
            return Ok(Some(Enclosed { width, inner, outer, refuted, certified, boxes }));
        }
        Ok(None)
    });
    found?.ok_or(NotEnclosed::Undecided)
}

/// What is found at the width `relative`, or else at the narrowest of its doubles up to [`loosest`], by halves of
/// their exponents: a width is as easy as all narrower ones. Once something is found, it stays so whatever then
/// goes wrong.
pub(super) fn narrowest<T>(
    relative: &BigRational,
    mut at: impl FnMut(&BigRational) -> Result<Option<T>, NotEnclosed>,
) -> Result<Option<T>, NotEnclosed> {
    let mut wider = vec![relative.clone()];
    while let Some(last) = wider.last().filter(|last| **last < loosest()) {
        wider.push((last + last).min(loosest()));
    }
    let (mut fails, mut best) = (0, at(relative)?);
    if best.is_some() || wider.len() == 1 {
        return Ok(best);
    }
    let mut holds = wider.len() - 1;
    best = at(&wider[holds])?;
    while best.is_some() && holds - fails > 1 {
        let middle = (fails + holds) / 2;
        match at(&wider[middle]) {
            Ok(None) => fails = middle,
            Ok(found) => (best, holds) = (found, middle),
            Err(_) => break,
        }
    }
    Ok(best)
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
    let probe = extreme.probe(claim).ok_or(NotEnclosed::Undecided)?;
    let known = Found::worst(&probe, extreme, ROUNDS)?;
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
        if extreme.bounded.requirement.quantity == "conditioning" {
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
    Ok(Found::worst(&probe, extreme, 1)?.value)
}

/// A decimal near a value times `factor`; none of zero.
pub fn beyond(value: f64, factor: &BigRational) -> Option<BigRational> {
    let value = BigRational::from_f64(value).filter(|value| !value.is_zero())? * factor;
    Some(rounded(&value, &(value.abs() / BigRational::from_integer(10.into()))))
}

/// The budget after which a width is given up.
pub(super) fn of_one_width(budget: Budget, problem: &Problem) -> Budget {
    let slower = if turns_with_tolerances(problem) { 6 } else { 1 };
    let own = MOST_BOXES[usize::from(!problem.orientation.is_empty())];
    let most = own / 3usize.pow(problem.orientation.len() as u32) / slower;
    Budget { max_boxes: budget.max_boxes.min(most), ..budget }
}

/// Whether it is a platform that turns, of a machine with tolerances.
fn turns_with_tolerances(problem: &Problem) -> bool {
    !problem.orientation.is_empty() && problem.tolerances().next().is_some()
}

/// The most extreme place known.
struct Found {
    place: Place,
    value: f64,
    /// What widths are relative to, beside the value.
    least_size: f64,
}

impl Found {
    /// By sampling: of a bound that is met with equality at the worst place found so far, the place at
    /// which it is violated most, until there is none.
    fn worst(probe: &MachineClaim, extreme: &Extreme, rounds: usize) -> Result<Self, NotEnclosed> {
        let mut claim = probe.clone();
        let mut best: Option<Found> = None;
        for _ in 0..rounds {
            let problem = Problem::new(&claim)?;
            let sampler = Sampler::new(&claim, &problem)?;
            let mut found: Option<(f64, Place)> = None;
            for Worst { quality, place, .. } in sampler.worst_values(FINEST) {
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
            best = Some(Found { place, value, least_size });
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
        let first = problem.obligations[number].requirement == Some(0);
        let own = |bounded: &Bounded| first && bounded.angle == self.bounded.angle;
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
        if self.bounded.requirement.quantity != "joint_range" {
            return 0.0;
        }
        let at = |place: &Place| self.bounded.value(claim, problem, sampler, place);
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
    begun: &mut Option<Outcome>,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Attempt, NotEnclosed> {
    let problem = Problem::new(claim)?.with_derivatives();
    let prover = Prover::new(&problem)?;
    // Tolerances may be too wide at the worst place found already.
    let sampler = Sampler::new(claim, &problem)?;
    let point = sampler.point(&known.place.u);
    let (whole, ends) = (Branch::whole(&prover), Ends { hopeless: true, ..Ends::default() });
    let mut found = None;
    if prover.holds_next_to(&point, false) {
        found = match &*begun {
            Some(before) => resume(&prover, before, ends, budget, control),
            None => search(&prover, &whole, ends, budget, control),
        };
    }
    if found.as_ref().is_none_or(|found| found.stop == Stop::Hopeless)
        && problem.derived.is_some()
        && prover.holds_next_to(&point, true)
    {
        let apart = search(&Apart(&prover), &whole, ends, few(budget), control);
        found = apart.filter(|apart| apart.is_proof() || apart.stop == Stop::Cancelled).or(found);
    }
    if found.as_ref().is_none_or(|found| found.stop == Stop::Hopeless)
        && problem.orientation.len() <= 1
    {
        let holds = Parts::new(&prover).is_some_and(|parts| {
            let max_boxes = budget.max_boxes.min(TIMES_IN_PARTS * parts.most());
            parts.hold_next_to(&point, Budget { max_boxes, ..budget }, control)
        });
        let parts = holds.then(|| in_parts_of_tolerances(&prover, TIMES_IN_PARTS, budget, control));
        let ended = |parts: &Outcome| parts.is_proof() || parts.stop == Stop::Cancelled;
        found = parts.flatten().filter(ended).or(found);
    }
    let Some(found) = found else { return Ok(Attempt::Undecided(Stop::Hopeless)) };
    if found.stop == Stop::Cancelled {
        return Err(NotEnclosed::Cancelled);
    }
    if found.is_proof() {
        return Ok(match accepted(claim, &prover, found.nodes) {
            Answer::Decided { certificate, .. } => Attempt::Certified(certificate, found.boxes),
            Answer::Undecided(_) | Answer::Cancelled if begun.take().is_some() => {
                return certify(claim, known, extreme, begun, budget, control);
            }
            Answer::Undecided(_) | Answer::Cancelled => Attempt::Undecided(Stop::Hopeless),
        });
    }
    let own = sampler.qualities().into_iter().filter(|quality| {
        matches!(quality, Quality::Obligation(at) if problem.obligations[*at].requirement == Some(0))
    });
    let place = sampler.centre();
    let unknown = |quality| Worst { quality, place: place.clone(), margin: f64::MAX };
    let mut worst: Vec<Worst> = own.map(unknown).collect();
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
    let own = (0..problem.obligations.len())
        .filter(|&at| problem.obligations[at].requirement == Some(0))
        .map(Quality::Obligation);
    let worst = own
        .map(|quality| (sampler.margin(quality, &values), quality))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let found = Worst { quality: worst.1, place: place.clone(), margin: worst.0 };
    match refuted(claim, witness_at(claim, &problem, &sampler, &found)?) {
        Answer::Decided { certificate, .. } => Some(certificate),
        Answer::Undecided(_) | Answer::Cancelled => None,
    }
}
