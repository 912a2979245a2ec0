//! The widest tolerances with which a design is still certified.
//!
//! Every parameter of the named kinds lies within `t` of its nominal value, independently of all
//! others, and everything else is as in the design. The claims are nested: a machine within a
//! tolerance is within every wider one. So what is certified for one `t` holds for every smaller
//! one, and what is refuted for one `t` is refuted for every greater one. Between the two remains
//! a band, where the tolerances are too wide to be proved in few parts.

use crate::exact::arithmetic::{apply, number};
use crate::exact::decimal::shortest;
use crate::exact::Exact;
use crate::questions::frontier::{
    approach, frontier, unless_cancelled, Approach, Approached, Bracket, Certified, NoAnswer,
    Succeeds, Walk, LARGEST_FACTOR,
};
use crate::search::solver;
use crate::search::solver::enclose::of_one_width;
use crate::search::solver::sample::Worst;
use crate::search::{Budget, Control, Stop};
use num_rational::BigRational;
use num_traits::{FromPrimitive as _, Signed, ToPrimitive, Zero};
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_kernel::certificate::{Claim, Witness};
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity, Vector};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;

/// The first tolerance tried, relative to the greatest number of its unit.
const START: f64 = 1e-3;
/// Limits of the tolerances tried, relative to the same.
const LIMITS: (f64, f64) = (1e-12, 10.0);
/// To such a share of the gap either end is found, where both are farther apart.
const SHARE: f64 = 0.25;
/// A tolerance that is not yet beyond all machines, relative to the same, and the factor of the
/// steps from there on.
const LAST: f64 = 0.1;
const SHORT: f64 = 1.25;
/// Most walks to a refuted tolerance, each from the worst places that are found where it begins.
const ROUNDS: usize = 4;
/// Parts of the refuted tolerance that are tried first where there is a deadline, or the best that can be hoped for
/// is not proved, less one.
const FAR: (f64, f64) = (10.0, 1e6);
/// To such a part the tolerance of a design is told in decimals.
const ROUNDED: f64 = 1e-9;
/// Where there is a deadline, the distance down to which each is a third of the one before: a greater step mostly
/// costs half of the time that is left, for nothing.
const BY_THIRDS: f64 = 0.1;

/// A kind of parameter, which all legs that have it share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// The legs' lengths.
    LegLength,
    /// The coordinates of the anchors.
    Anchor,
    /// The components of the guides' directions, as they are written.
    Direction,
    /// The coordinates of the platform's offsets.
    Platform,
    /// The components of the motors' axes, as they are written.
    Axis,
    /// The components of the arms' reference directions, as they are written.
    Reference,
    /// The arms' lengths.
    Arm,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 7] = [
        Kind::LegLength,
        Kind::Anchor,
        Kind::Direction,
        Kind::Platform,
        Kind::Axis,
        Kind::Reference,
        Kind::Arm,
    ];

    /// Those that a mechanism has.
    pub fn of(mechanism: &Mechanism) -> Vec<Kind> {
        let mut legs = mechanism.legs().to_vec();
        let there: Vec<Kind> = legs.iter_mut().flat_map(parameters).map(|(kind, _)| kind).collect();
        Kind::ALL.into_iter().filter(|kind| there.contains(kind)).collect()
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Kind::LegLength => "leg_length",
            Kind::Anchor => "anchor",
            Kind::Direction => "direction",
            Kind::Platform => "platform",
            Kind::Axis => "axis",
            Kind::Reference => "reference",
            Kind::Arm => "arm",
        }
    }

    /// Whether its tolerance is one of a direction's components, and not a length.
    pub fn is_direction(self) -> bool {
        matches!(self, Kind::Direction | Kind::Axis | Kind::Reference)
    }
}

/// Fractional bits of lengths of vectors, and of their squares, that are not rational.
pub const ROOT_BITS: u32 = 256;

/// The legs of a mechanism, to be changed; there are none where [`Mechanism::legs`] has none.
pub(crate) fn legs_mut(mechanism: &mut Mechanism) -> &mut [Leg] {
    match mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Planar(own) | Mechanism::Spatial(own) | Mechanism::Spherical(own) => {
            &mut own.legs
        }
        Mechanism::Orthoglide { .. } | Mechanism::Formulas(_) => &mut [],
    }
}

/// The parameters of a leg.
pub(crate) fn parameters(leg: &mut Leg) -> Vec<(Kind, &mut Quantity)> {
    fn vector(kind: Kind, x: &mut Vector) -> impl Iterator<Item = (Kind, &mut Quantity)> {
        x.iter_mut().map(move |x| (kind, x))
    }
    match leg {
        Leg::Slider { direction, anchor, platform, length, .. } => {
            let mut all = vec![(Kind::LegLength, length)];
            all.extend(vector(Kind::Direction, direction));
            all.extend(vector(Kind::Anchor, anchor));
            all.extend(vector(Kind::Platform, platform));
            all
        }
        Leg::Strut { anchor, platform, .. } => {
            vector(Kind::Anchor, anchor).chain(vector(Kind::Platform, platform)).collect()
        }
        Leg::Arm { axis, reference, anchor, platform, arm, length, .. } => {
            let mut all = vec![(Kind::LegLength, length), (Kind::Arm, arm)];
            all.extend(vector(Kind::Axis, axis));
            all.extend(vector(Kind::Reference, reference));
            all.extend(vector(Kind::Anchor, anchor));
            all.extend(vector(Kind::Platform, platform));
            all
        }
        Leg::Planar { direction } => vector(Kind::Direction, direction).collect(),
    }
}

/// Between which two numbers the squares of the lengths are of the vectors whose components are of these
/// kinds, of one leg or of all, as they are written.
pub fn squares(
    mechanism: &Mechanism,
    kinds: &[&str],
    leg: Option<usize>,
) -> Option<[BigRational; 2]> {
    let mut all: Vec<[BigRational; 2]> = Vec::new();
    let legs = mechanism.legs().iter().enumerate().filter(|(i, _)| leg.is_none_or(|leg| leg == *i));
    for (_, leg) in legs {
        let vectors = leg.quantities().into_iter().filter(|(name, ..)| kinds.contains(name));
        for (.., components) in vectors.filter(|(.., components)| !components.is_empty()) {
            let mut square = Exact::integer(0);
            for quantity in components {
                let [min, max] = quantity.ends().map(Exact::of);
                let twice = min?.plus(max?).ok()?;
                square = square.plus(twice.clone().times(twice).ok()?).ok()?;
            }
            let four = BigRational::from_integer(4.into());
            all.push(square.ends(ROOT_BITS)?.map(|end| end / &four));
        }
    }
    let least = all.iter().map(|[least, _]| least).min()?.clone();
    let most = all.iter().map(|[_, most]| most).max()?.clone();
    least.is_positive().then_some([least, most])
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What is widened, and how: every parameter of a kind by its weight times `t`.
#[derive(Clone, Debug, PartialEq)]
pub struct Scheme {
    /// The kinds, and their weights.
    pub weights: Vec<(Kind, BigRational)>,
    /// Of this leg alone, counted from zero; else of all.
    pub leg: Option<usize>,
}

impl Scheme {
    /// Every one of these kinds by `t`.
    pub fn common(kinds: &[Kind]) -> Self {
        let one = BigRational::from_integer(1.into());
        Scheme { weights: kinds.iter().map(|&kind| (kind, one.clone())).collect(), leg: None }
    }

    /// The claim about every machine of which the named parameters lie within `t` times their
    /// weight of their nominal values: the middle of what the design admits.
    pub fn claim(&self, claim: &MachineClaim, t: &BigRational) -> MachineClaim {
        let mut widened = claim.clone();
        for (weight, quantity) in self.widened(&mut widened.mechanism) {
            *quantity = around(quantity, &(weight * t));
        }
        widened
    }

    /// The parameters that are widened, with their weights.
    fn widened<'a>(
        &'a self,
        mechanism: &'a mut Mechanism,
    ) -> impl Iterator<Item = (&'a BigRational, &'a mut Quantity)> {
        let legs = legs_mut(mechanism).iter_mut().enumerate();
        let legs = legs.filter(|(leg, _)| self.leg.is_none_or(|own| own == *leg));
        legs.flat_map(|(_, leg)| parameters(leg)).filter_map(|(kind, quantity)| {
            let (_, weight) = self.weights.iter().find(|(own, _)| *own == kind)?;
            Some((weight, quantity))
        })
    }

    /// The `t` of what the design itself admits, where it admits as much of all, about: most likely it holds.
    fn own(&self, claim: &MachineClaim) -> Option<BigRational> {
        let mut mechanism = claim.mechanism.clone();
        let own = self.widened(&mut mechanism).map(|(weight, quantity)| match quantity {
            Quantity::Exactly(_) => None,
            Quantity::Between { min, max } => Some(
                (solver::approximate(max)? - solver::approximate(min)?)
                    / (2.0 * weight.to_f64()?),
            ),
        });
        let least = own.collect::<Option<Vec<_>>>()?.into_iter().reduce(f64::min)?;
        let end = |part: f64| BigRational::from_f64(least * part);
        Some(shortest(&end(1.0 - ROUNDED)?, &end(1.0 + ROUNDED)?)).filter(Signed::is_positive)
    }

    /// The greatest number among the parameters that have the same unit as those named, which
    /// measures tolerances: directions with directions, lengths with lengths.
    fn scale(&self, claim: &MachineClaim) -> f64 {
        let directions = self.weights.iter().all(|(kind, _)| kind.is_direction());
        let mut legs = claim.mechanism.legs().to_vec();
        let all = legs.iter_mut().flat_map(parameters);
        let same = all.filter(|(kind, _)| kind.is_direction() == directions);
        let sizes = same.filter_map(|(_, q)| solver::approximate(q.ends()[1])).map(f64::abs);
        let greatest = sizes.fold(0.0, f64::max);
        if greatest > 0.0 {
            greatest
        } else {
            1.0
        }
    }
}

/// `nominal - t` to `nominal + t`.
pub(crate) fn around(quantity: &Quantity, t: &BigRational) -> Quantity {
    let nominal = match quantity {
        Quantity::Exactly(x) => x.clone(),
        Quantity::Between { min, max } => {
            apply(Operator::Div, &apply(Operator::Add, min, max), &Expression::integer(2))
        }
    };
    if t.is_zero() {
        return Quantity::Exactly(nominal);
    }
    let end = |operator| apply(operator, &nominal, &number(t));
    Quantity::Between { min: end(Operator::Sub), max: end(Operator::Add) }
}

/// What is known of a widest tolerance before it is looked for.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Ends, which are gone on from.
    pub ends: Bracket,
    /// About where it is refuted.
    pub refuted: Option<f64>,
    /// Where a proof is found soon, most likely.
    pub certified: Option<f64>,
}

/// Encloses the widest `t` for which the claim widened by `scheme` holds, to `gap`. Where the proofs that the
/// search finds do not come so near to the refuted end, both are found to a part of `gap`. Where there is a
/// deadline, a third of the time is for the refuted end.
///
/// # Errors
/// If it was cancelled.
pub fn widest(
    claim: &MachineClaim,
    scheme: &Scheme,
    gap: f64,
    known: Known,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Bracket, NoAnswer> {
    let scale = scheme.scale(claim);
    let weight = scheme.weights.iter().filter_map(|(_, weight)| weight.to_f64());
    let scale = scale / weight.fold(f64::MIN_POSITIVE, f64::max);
    let walk = Walk {
        start: known.refuted.unwrap_or(START * scale).clamp(LIMITS.0 * scale, LIMITS.1 * scale),
        succeeds: Succeeds::Above,
        factor: if known.refuted.is_some() { 2.0 } else { 10.0 },
        most: LARGEST_FACTOR,
        enough: None,
        limits: (LIMITS.0 * scale, LIMITS.1 * scale),
        gap: gap * SHARE,
        deadline: budget.shared(3).deadline,
    };
    let refute =
        |walk: &Walk, control: &mut Control<'_>| refuted(walk, |t| scheme.claim(claim, t), control);
    let begun_before = known.ends.refuted.is_some();
    let begun = match known.ends.refuted {
        None => control.part([0.0, 0.4], |control| refute(&walk, control))?,
        Some(end) => {
            let nearer = below(&walk, end.0.to_f64().unwrap_or(walk.limits.1));
            control.part([0.0, 0.4], |control| refute(&nearer, control))?.or(Some(end))
        }
    };
    let refuted = match begun {
        // Beyond some tolerance there is no machine, a direction being zero: less far, then.
        None => {
            let short = Walk { start: LAST * scale, factor: SHORT, most: SHORT, ..walk };
            control.part([0.4, 0.6], |control| refute(&short, control))?
        }
        found => found,
    };
    let point = refuted.as_ref().and_then(|(_, certificate)| match &certificate.proof {
        Proof::Witness(witness) => Some(&witness.point[..]),
        _ => None,
    });
    // The best that can be hoped for, first; what is not proved may take all of the time there is, then from afar.
    let near = gap * (1.0 - SHARE);
    let end = refuted.as_ref().and_then(|(t, _)| t.to_f64());
    let to = end.unwrap_or(LAST * scale);
    let (first, by_thirds) = match (budget.deadline, known.certified) {
        (None, _) => (near, 1.0),
        (Some(_), None) => (FAR.0, BY_THIRDS),
        (Some(_), Some(likely)) => ((to / likely - 1.0).max(near), BY_THIRDS),
    };
    // Tried once, and not where it is refuted.
    let is_open = |own: &BigRational| refuted.as_ref().is_none_or(|(t, _)| own < t);
    let is_tried = budget.deadline.is_none() || begun_before;
    let own = if is_tried { None } else { scheme.own(claim).filter(is_open) };
    let known = match (known.ends.certified, own) {
        (None, Some(own)) => {
            let own_claim = scheme.claim(claim, &own);
            let found = solver::proof_about(&own_claim, point, budget.shared(2), control).ok();
            unless_cancelled(control, found)?.map(|certificate| (own, certificate))
        }
        (known, _) => known,
    };
    let to =
        Approach { first, far: FAR, by_thirds, ..Approach::from_afar(to, Succeeds::Below, near) };
    let to = Approach { known: known.as_ref().and_then(|(t, _)| to.distance(t)), ..to };
    let certified = control
        .part([0.6, 1.0], |control| certified(claim, scheme, (&to, point), budget, control))?;
    let out_of_time = certified.out_of_time || budget.is_over() || control.is_cancelled();
    Ok(Bracket { certified: certified.found.or(known), refuted, out_of_time })
}

/// The claim widened by `scheme` refuted by the machine that refutes it at the same `t` with some of its kinds alone;
/// `None` where that is not within these tolerances.
pub fn refuted_by(
    claim: &MachineClaim,
    scheme: &Scheme,
    (t, alone): &Certified,
) -> Option<Certified> {
    let (Claim::Machine(narrow), Proof::Witness(witness)) = (&alone.claim, &alone.proof) else {
        return None;
    };
    let wide = scheme.claim(claim, t);
    let [narrow, problem] = [narrow, &wide].map(|claim| Problem::new(claim).ok());
    let (narrow, problem) = (narrow?, problem?);
    let places = narrow.tolerances().map(|(place, ..)| place);
    let known: BTreeMap<&str, &Expression> = places.zip(&witness.machine).collect();
    let value = |(place, min, max): (&str, &Expression, &Expression)| match known.get(place) {
        Some(value) => (*value).clone(),
        None => apply(Operator::Div, &apply(Operator::Add, min, max), &Expression::integer(2)),
    };
    let machine = problem.tolerances().map(value).collect();
    let (certificate, _) = solver::refuted(&wide, Witness { machine, ..witness.clone() }).ok()?;
    Some((t.clone(), certificate))
}

/// From just below a tolerance that is refuted.
fn below(walk: &Walk, t: f64) -> Walk {
    let factor = 1.0 + walk.gap;
    Walk { start: t / factor, limits: (walk.limits.0, t / factor), factor, ..*walk }
}

/// The narrowest tolerance found for which the claim is refuted. Sampling finds one first. Narrower ones are tried
/// from the worst places found, which hardly move. As others may be worse of narrower ones, sampling begins anew just
/// below the last.
fn refuted(
    walk: &Walk,
    claim: impl Fn(&BigRational) -> MachineClaim,
    control: &mut Control<'_>,
) -> Result<Option<(BigRational, Box<Certificate>)>, NoAnswer> {
    let (mut walk, mut found) = (*walk, None);
    for _ in 0..ROUNDS {
        let mut known: Option<Vec<Worst>> = None;
        let next = frontier(&walk, control, |t, control| {
            unless_cancelled(control, ())?;
            let claim = claim(t);
            Ok(match &known {
                Some(worst) => solver::refutation_from(&claim, worst),
                None => solver::refutation_and_worst(&claim).and_then(|(found, worst)| {
                    known = found.is_some().then_some(worst);
                    found
                }),
            })
        })?;
        let Some(least) = next.as_ref().and_then(|(t, _)| t.to_f64()) else { break };
        found = next;
        walk = below(&walk, least);
    }
    Ok(found)
}

/// The widest `t` found for which the claim widened by `scheme` is certified; `point` is where it is nearest to failing.
/// Of platforms that turn a proof that is not found may take long: where no time is set, what few boxes prove is first.
fn certified(
    claim: &MachineClaim,
    scheme: &Scheme,
    (to, point): (&Approach, Option<&[Expression]>),
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Approached<Box<Certificate>>, NoAnswer> {
    let ran_out = Cell::new(false);
    let prove = |to: &Approach, budget: Budget, control: &mut Control<'_>| {
        approach(to, budget, control, |t, budget, control| {
            let claim = scheme.claim(claim, t);
            let found = solver::proof_about(&claim, point, budget, control);
            ran_out.set(ran_out.get() || matches!(found, Err(Stop::Boxes | Stop::Time)));
            unless_cancelled(control, found.ok())
        })
    };
    let first = to.at(to.first).map(|t| scheme.claim(claim, &t));
    let few = first.and_then(|claim| Some(of_one_width(budget, &Problem::new(&claim).ok()?)));
    let is_endless = claim.orientation.is_some() && budget.deadline.is_none();
    let few = few.filter(|few| is_endless && few.max_boxes < budget.max_boxes);
    let Some(few) = few else { return prove(to, budget, control) };
    let quick = control.part([0.0, 0.5], |control| prove(to, few, control))?;
    let distance = quick.found.as_ref().and_then(|(t, _)| to.distance(t));
    if !ran_out.get() {
        return Ok(quick);
    }
    let to = Approach { known: distance.or(to.known), ..*to };
    let found = control.part([0.5, 1.0], |control| prove(&to, budget, control))?;
    Ok(Approached { found: found.found.or(quick.found), ..found })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    #[test]
    fn the_tolerance_of_a_design_is_known_where_all_have_it() {
        let text = include_str!("../../tests/designs/orthoglide-as-built.toml");
        let claim = Design::parse(text, "test.toml").unwrap().claim;
        let own = |scheme: &Scheme| scheme.own(&claim).map(|t| t.to_string());
        let common = |kinds: &[Kind]| own(&Scheme::common(kinds));
        assert_eq!(common(&[Kind::LegLength]).as_deref(), Some("1/50"));
        assert_eq!(common(&[Kind::LegLength, Kind::Anchor]).as_deref(), Some("1/100"));
        assert_eq!(common(&[Kind::Direction]).as_deref(), Some("1/10000"));
        let of_leg = Scheme { leg: Some(1), ..Scheme::common(&[Kind::LegLength]) };
        assert_eq!(own(&of_leg).as_deref(), Some("1/50"));
        let double = vec![(Kind::LegLength, BigRational::from_integer(2.into()))];
        assert_eq!(own(&Scheme { weights: double, leg: None }).as_deref(), Some("1/100"));
        let exact = text.replace("\"310.7 ± 0.02\"", "310.7");
        let claim = Design::parse(&exact, "test.toml").unwrap().claim;
        assert_eq!(Scheme::common(&[Kind::LegLength]).own(&claim), None);
    }

    #[test]
    fn a_machine_that_fails_with_one_kind_fails_with_more() {
        let text = include_str!("../../tests/designs/orthoglide-312.toml");
        let claim = Design::parse(text, "test.toml").unwrap().claim;
        let [alone, both] = [&[Kind::LegLength][..], &[Kind::LegLength, Kind::Anchor]];
        let [alone, both] = [alone, both].map(Scheme::common);
        let t = BigRational::from_integer(10.into());
        let refuted = solver::refutation(&alone.claim(&claim, &t)).unwrap();
        let (own, found) = refuted_by(&claim, &both, &(t.clone(), refuted.clone())).unwrap();
        assert_eq!((own, &found.claim), (t.clone(), &Claim::Machine(both.claim(&claim, &t))));
        assert_ne!(found.claim, refuted.claim);
        // That machine is not within a narrower tolerance.
        assert!(refuted_by(&claim, &both, &(t / BigRational::from_integer(2.into()), refuted))
            .is_none());
    }
}
