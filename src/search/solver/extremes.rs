//! Extremes: how small and how large each quantity of the kernel's table gets. Claims about one have its bound alone.

use super::value::{defining, name_of, sought, Bounded};
use crate::exact::arithmetic::number;
use crate::exact::Exact;
use num_rational::BigRational;
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism, Requirement, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::TABLE;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// One end of a quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extreme {
    bounded: Bounded,
}

/// What a quantity is for, where one unit of it is a choice without loss: it is linear in it.
fn unit_given(name: &str) -> Option<Expression> {
    matches!(name, "tool" | "joint").then(|| Expression::integer(1))
}

fn rational(x: &Expression) -> Option<BigRational> {
    Exact::of(x)?.as_rational().cloned()
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

    /// Of an accuracy's distance the angle, and of its angle the distance, where it has both; and the rational bound on that.
    pub(super) fn other_part(&self, claim: &MachineClaim) -> Option<(Self, BigRational)> {
        let Bounded { requirement, angle, .. } = &self.bounded;
        let (other, bound) = match (angle, &requirement.bound, &claim.mechanism) {
            (false, ..) => {
                (Self::angle(claim, requirement)?, requirement.given.get("max_angle")?.first()?)
            }
            (true, _, Mechanism::Spherical(_)) => return None,
            (true, Bound::Max(bound), _) => (Self::on(requirement.clone(), None)?, bound),
            (true, ..) => return None,
        };
        Some((other, rational(bound)?))
    }

    /// With this bound on that.
    pub fn with_other_part(&self, bound: &BigRational) -> Option<Self> {
        let own = self.bounded.clone();
        let other = Bounded { angle: !own.angle, ..own.clone() };
        let requirement = other.bounded_by(number(bound))?;
        Some(Extreme { bounded: Bounded { requirement, ..own } })
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

    /// The tightest bound that a claim itself has for it.
    fn required_of(&self, claim: &MachineClaim) -> Option<Exact> {
        let one = &self.bounded.requirement;
        let is_speed = one.quantity == "joint_speed";
        let is_it = |own: &&Requirement| {
            own.quantity == one.quantity
                && (own.given == one.given || is_speed)
                && (own.leg.is_none() || own.leg == one.leg)
        };
        let of = |own: &Requirement| {
            if self.bounded.angle {
                return Exact::of(own.given.get("max_angle")?.first()?);
            }
            let x = match (&own.bound, &one.bound) {
                (Bound::Min(x) | Bound::Within([x, _]), Bound::Min(_)) => Exact::of(x)?,
                (Bound::Max(x) | Bound::Within([_, x]), Bound::Max(_)) => Exact::of(x)?,
                _ => return None,
            };
            if own.given == one.given {
                return Some(x);
            }
            // It is linear in the tool's speed.
            let tool = |own: &Requirement| Exact::of(own.given.get("tool")?.first()?);
            x.times(tool(one)?).ok()?.over(tool(own)?).ok()
        };
        let all = claim.require.iter().filter(is_it).filter_map(of);
        all.reduce(|known, own| if self.is_tighter(&own, &known) { own } else { known })
    }

    fn is_tighter(&self, one: &Exact, other: &Exact) -> bool {
        let tighter = if self.is_greatest() { Ordering::Less } else { Ordering::Greater };
        one.compare(other) == Some(tighter)
    }

    /// The tightest bound that a claim itself has for it, if it is rational.
    pub fn required_bound(&self, claim: &MachineClaim) -> Option<BigRational> {
        self.required_of(claim)?.as_rational().cloned()
    }

    /// Whether a bound says more than what the claim itself demands.
    pub fn is_margin(&self, claim: &MachineClaim, bound: &BigRational) -> bool {
        let bound = Exact::Rational(bound.clone());
        self.required_of(claim).is_none_or(|own| self.is_tighter(&bound, &own))
    }

    /// A bound with which the claim is well formed.
    pub(super) fn probe(&self, claim: &MachineClaim) -> Option<MachineClaim> {
        let two = BigRational::from_integer(2.into());
        let half = two.recip();
        [two, half].iter().find_map(|bound| self.well_formed(claim, bound))
    }

    /// [`claim`](Self::claim), where it is well formed.
    pub(super) fn well_formed(
        &self,
        claim: &MachineClaim,
        bound: &BigRational,
    ) -> Option<MachineClaim> {
        self.claim(claim, bound).filter(|claim| Problem::new(claim).is_ok())
    }

    /// "The quantity stays within `bound`", and nothing else but what defines the paper's cube.
    pub fn claim(&self, claim: &MachineClaim, bound: &BigRational) -> Option<MachineClaim> {
        Some(sought(claim, self.bounded.bounded_by(number(bound))?))
    }

    /// The quantity's name in texts.
    pub fn name(&self) -> String {
        let Requirement { quantity, .. } = &self.bounded.requirement;
        match (quantity.as_str(), self.bounded.leg) {
            ("accuracy", _) if self.bounded.angle => self.bounded.name(),
            ("transmission", _) => "psi".to_owned(),
            ("joint_range", Some(leg)) => format!("rho_{}", leg + 1),
            ("joint_speed", _) => "joint/tool speed".to_owned(),
            (quantity, Some(leg)) => format!("{} {}", name_of(quantity), leg + 1),
            (quantity, None) => name_of(quantity),
        }
    }

    /// The same for scripts, which have symbols where there are some.
    pub fn symbol(&self) -> String {
        match self.bounded.requirement.quantity.as_str() {
            "conditioning" => "sigma_max/sigma_min".to_owned(),
            "serial_margin" => "|eta_i|/L_i".to_owned(),
            "parallel_margin" => "|det A|/(L_1 .. L_n)".to_owned(),
            _ => self.name(),
        }
    }

    /// What the files of its certificates begin with.
    pub fn file_stem(&self) -> String {
        let Requirement { quantity, .. } = &self.bounded.requirement;
        let end = self.end();
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

    /// "least" or "greatest".
    pub fn end(&self) -> &'static str {
        if self.is_greatest() {
            "greatest"
        } else {
            "least"
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
    let Some(psi_max) = Exact::of(&psi) else { return Vec::new() };
    let inverse = Exact::integer(1).over(psi_max.clone()).ok();
    // The least psi is 1/psi_max at Q2 for psi_max <= 2 only.
    let is_least = psi_max.compare(&Exact::integer(2)).is_some_and(Ordering::is_le);
    let least = inverse.filter(|_| is_least).map(|inverse| (false, inverse));
    least.into_iter().chain([(true, psi_max)]).collect()
}
