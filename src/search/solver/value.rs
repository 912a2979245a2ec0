//! Quantities at a place, in the claim's own unit; what bounds on them are called.

use super::refute::approximate;
use super::sample::{At, Place, Quality, Sampler};
use crate::exact::arithmetic::number;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_kernel::claim::{
    Bound, MachineClaim, Mechanism, Orientation, Requirement, Workspace,
};
use orthocert_kernel::formula::Op;
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, Test};
use serde::Serialize;

/// Steps of the search for a bound that is tight.
const STEPS: usize = 60;
/// Relative accuracy of such a bound.
const ACCURACY: f64 = 1e-13;

/// A bound on a quantity of one leg, or of the machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bounded {
    /// The requirement.
    pub requirement: Requirement,
    /// Of this leg, counted from zero.
    pub leg: Option<usize>,
    /// Of an accuracy, the angle that goes with it.
    pub angle: bool,
}

/// The unit of a quantity, where it has one; `angular` where joint coordinates are angles.
pub fn unit(quantity: &str, angular: bool) -> Option<&'static str> {
    match quantity {
        "transmission" => angular.then_some("length/rad"),
        "joint_range" => Some(if angular { "deg" } else { "length" }),
        "joint_speed" => Some(if angular { "deg/time" } else { "length/time" }),
        "leg_angle" | "base_joint" | "platform_joint" => Some("deg"),
        "accuracy" | "clearance" => Some("length"),
        "stiffness" => Some("force/length"),
        "joint_force" | "load" => Some(if angular { "torque" } else { "force" }),
        "joint_acceleration" => Some(if angular { "deg/time^2" } else { "length/time^2" }),
        _ => None,
    }
}

/// Whether a bound on a quantity depends on the unit of length: angles, determinants and quotients of lengths do
/// not, nor do joints along lengths to tool velocities and forces. `angular` joints to them do.
pub fn depends_on_length(quantity: &str, angular: bool) -> bool {
    match quantity {
        "conditioning" | "serial_margin" | "parallel_margin" | "constraint_margin"
        | "leg_angle" | "base_joint" | "platform_joint" | "one_to_one" => false,
        "transmission" | "joint_speed" | "joint_force" | "load" | "stiffness" => angular,
        _ => true,
    }
}

/// The name in texts of the quantity with this key.
pub fn name_of(quantity: &str) -> String {
    match quantity {
        "conditioning" => "condition number".to_owned(),
        other => other.replace('_', " "),
    }
}

/// A quantity's name with its unit in a table, where the unit has an angle in it.
pub fn with_unit(name: &str, unit: Option<&str>) -> String {
    match unit.filter(|unit| has_angle(unit)) {
        Some(unit) => format!("{name}, {unit}"),
        None => name.to_owned(),
    }
}

/// Names one after the other; of joints that follow each other the first and the last.
pub fn listed(names: &[&str]) -> String {
    let number = |name: &str| {
        let (stem, number) = name.rsplit_once('_')?;
        Some((stem.to_owned(), number.parse::<usize>().ok()?))
    };
    let follow = |pair: &[&str]| match (number(pair[0]), number(pair[1])) {
        (Some((stem, one)), Some((other, next))) => stem == other && next == one + 1,
        _ => false,
    };
    match names {
        [first, .., last] if names.len() > 2 && names.windows(2).all(follow) => {
            format!("{first} to {last}")
        }
        names => names.join(", "),
    }
}

fn has_angle(unit: &str) -> bool {
    !unit.starts_with("length") || unit.ends_with("rad")
}

/// A name that [`with_unit`] made of `unit`, with the unit of length that the design names in it.
pub fn in_length(name: &str, unit: Option<&str>, length: Option<&str>) -> String {
    match (unit.filter(|unit| unit.contains("length")), length) {
        (Some(unit), Some(length)) => {
            let bare = name.strip_suffix(&format!(", {unit}")).unwrap_or(name);
            format!("{bare}, {}", unit.replace("length", length))
        }
        _ => name.to_owned(),
    }
}

/// What an accuracy is of where it is not the position's.
pub const OF_ANGLE: &str = "accuracy of the angle";

/// The names of coordinates that are `tan(theta/2)` times the axis of a rotation by `theta`.
const AXIS: [&str; 3] = ["c_x", "c_y", "c_z"];

/// The names of the coordinates of poses.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(transparent)]
pub struct Coordinates {
    names: Vec<String>,
    /// How many are of no orientation: before the others.
    #[serde(skip)]
    positions: usize,
    /// Whether orientations are told by their tilt and torsion.
    #[serde(skip)]
    pub by_tilt: bool,
}

impl Coordinates {
    /// Those that are lengths, or a user's own.
    pub fn positions(&self) -> &[String] {
        &self.names[..self.positions]
    }

    /// Those of orientation.
    pub fn turns(&self) -> &[String] {
        &self.names[self.positions..]
    }

    /// Whether these are the components of `tan(theta/2)` along the axis of a rotation by `theta`.
    pub fn are_of_axis(&self) -> bool {
        self.turns().first().is_some_and(|name| name == AXIS[0])
    }
}

impl std::ops::Deref for Coordinates {
    type Target = [String];

    fn deref(&self) -> &[String] {
        &self.names
    }
}

/// The names of the coordinates of a claim's workspace; of orientations half-angle tangents, about one
/// axis or as the vector `tan(theta/2)` along the axis of the rotation.
pub fn coordinates(claim: &MachineClaim) -> Coordinates {
    let by_tilt = matches!(claim.orientation, Some(Orientation::Tilt { .. }));
    let in_plane = matches!(claim.mechanism, Mechanism::Planar(_));
    let m = match (&claim.mechanism, &claim.workspace) {
        (Mechanism::Formulas(formulas), _) => {
            let names = formulas.coordinates.clone();
            return Coordinates { positions: names.len(), names, by_tilt };
        }
        (_, Workspace::Box { min, .. }) => min.len(),
        (_, Workspace::Cylinder { .. } | Workspace::Cube { .. }) => 3,
    };
    let turns: &[&str] = match &claim.orientation {
        None => &[],
        Some(Orientation::Range(_)) => &["tan(phi/2)"],
        Some(Orientation::RollPitchYaw { .. }) => &["tan(roll/2)", "tan(pitch/2)", "tan(yaw/2)"],
        Some(Orientation::Angle(_) | Orientation::Tilt { .. }) => &AXIS,
    };
    let places = &["x", "y", "z"][..if in_plane { m.min(2) } else { m.min(3) }];
    let names = [places, turns].concat().into_iter().map(str::to_owned).collect();
    Coordinates { names, positions: places.len(), by_tilt }
}

impl Bounded {
    /// What an obligation bounds; none of freedom from singularities.
    pub fn of(claim: &MachineClaim, problem: &Problem, obligation: usize) -> Option<Self> {
        let obligation = problem.obligations.get(obligation)?;
        let requirement = claim.require.get(obligation.requirement?)?.clone();
        Some(Bounded { requirement, leg: obligation.leg, angle: is_of_angle(obligation) })
    }

    /// Its name: `greatest psi`, `least rho_2`, `joint speed 1`.
    pub fn name(&self) -> String {
        let Requirement { quantity, bound, .. } = &self.requirement;
        let end = match bound {
            Bound::Min(_) => "least ",
            Bound::Max(_) => "greatest ",
            Bound::Within(_) | Bound::Holds => "",
        };
        let number = self.leg.map(|leg| leg + 1);
        match (quantity.as_str(), number) {
            ("accuracy", _) if self.angle => OF_ANGLE.to_owned(),
            ("transmission", _) => format!("{end}psi"),
            ("joint_range", Some(leg)) => format!("{end}rho_{leg}"),
            ("joint_range", None) => format!("{end}rho"),
            (quantity, Some(leg)) => format!("{} {leg}", name_of(quantity)),
            (quantity, None) => name_of(quantity),
        }
    }

    /// Whether it is of bodies that do not collide.
    pub fn is_clearance(&self) -> bool {
        self.requirement.quantity == "clearance"
    }

    /// Its unit, where it has one.
    pub fn unit(&self, angular: bool) -> Option<&'static str> {
        match self.angle {
            true => Some("deg"),
            false => unit(&self.requirement.quantity, angular),
        }
    }

    /// The bound: of the angle of an accuracy, that on it.
    pub fn bound(&self) -> Bound {
        match self.requirement.given.get("max_angle").and_then(|all| all.first()) {
            Some(angle) if self.angle => Bound::Max(angle.clone()),
            _ => self.requirement.bound.clone(),
        }
    }

    /// `<=`, `>=` or `in`, and the other side; none of what is no number.
    pub fn relation(&self) -> Option<(&'static str, Vec<&Expression>)> {
        match &self.requirement.bound {
            _ if self.angle => {
                Some(("<=", self.requirement.given.get("max_angle")?.iter().collect()))
            }
            Bound::Min(bound) => Some((">=", vec![bound])),
            Bound::Max(bound) => Some(("<=", vec![bound])),
            Bound::Within([min, max]) => Some(("in", vec![min, max])),
            Bound::Holds => None,
        }
    }

    /// The requirement with another bound; a range has none.
    pub fn bounded_by(&self, bound: Expression) -> Option<Requirement> {
        let mut requirement = self.requirement.clone();
        match &mut requirement.bound {
            _ if self.angle => {
                requirement.given.insert("max_angle".to_owned(), vec![bound]);
            }
            Bound::Min(own) | Bound::Max(own) => *own = bound,
            Bound::Within(_) | Bound::Holds => return None,
        }
        Some(requirement)
    }

    /// The same, on this leg alone.
    fn with(&self, x: f64) -> Option<Requirement> {
        let requirement = self.bounded_by(number(&BigRational::from_f64(x)?))?;
        Some(Requirement { leg: self.leg.map(|leg| leg + 1), ..requirement })
    }

    /// The value at a place: of the quantities of velocities by their definition, of all others as the
    /// bound that is met with equality there.
    pub fn value(
        &self,
        claim: &MachineClaim,
        problem: &Problem,
        sampler: &Sampler<'_>,
        place: &Place,
    ) -> Option<f64> {
        let values = sampler.at(place);
        self.known(problem, sampler, &values).or_else(|| {
            sampler.matrix(&values)?;
            self.tight(claim, place)
        })
    }

    /// The same without a search for such a bound; `None` where there would be one.
    pub fn known(&self, problem: &Problem, sampler: &Sampler<'_>, values: &At) -> Option<f64> {
        let leg = self.leg.and_then(|leg| problem.legs.get(leg));
        let angular = problem.legs.iter().any(Leg::is_angular);
        match (self.requirement.quantity.as_str(), &self.requirement.bound) {
            ("transmission", bound) => {
                let [least, greatest] = sampler.xi(values)?;
                let unit = if angular { sampler.unit() } else { 1.0 };
                Some(unit / if matches!(bound, Bound::Min(_)) { greatest } else { least })
            }
            ("conditioning", _) => sampler.xi(values).map(|[least, greatest]| greatest / least),
            ("joint_range", _) => match leg?.rho? {
                Joint::Length(rho) => Some(values.of(rho)? * sampler.unit()),
                Joint::Angle { cos, sin } => {
                    let angle = values.of(sin)?.atan2(values.of(cos)?).to_degrees();
                    let range = middle(&self.requirement.bound);
                    Some(angle + range.map_or(0.0, |range| turns(angle, range)))
                }
            },
            ("serial_margin", _) => cosine(leg?, values),
            ("leg_angle", _) => Some(cosine(leg?, values)?.min(1.0).acos().to_degrees()),
            ("joint_speed", _) => {
                let tool = approximate(self.requirement.given.get("tool")?.first()?)?;
                let unit = if angular { 1f64.to_degrees() / sampler.unit() } else { 1.0 };
                let a = leg?.row.a.iter().map(|&a| values.of(a).map(|a| a * a));
                let square: f64 = a.sum::<Option<f64>>()?;
                Some((square / values.of(leg?.row.d)?).sqrt() * unit * tool)
            }
            (_, bound) => {
                sampler.matrix(values)?;
                let own = match bound {
                    Bound::Min(bound) | Bound::Max(bound) => approximate(bound),
                    Bound::Within(_) | Bound::Holds => None,
                };
                self.by_margin(own?, problem, sampler, values)
            }
        }
    }

    /// The value of a quantity that its margins tell: the worst of its tests.
    fn by_margin(
        &self,
        bound: f64,
        problem: &Problem,
        sampler: &Sampler<'_>,
        at: &At,
    ) -> Option<f64> {
        let own = problem.obligations.iter().enumerate().filter(|(_, own)| {
            let requirement = own.requirement.and_then(|r| sampler.claim().require.get(r));
            requirement == Some(&self.requirement)
                && own.leg == self.leg
                && is_of_angle(own) == self.angle
        });
        let value = |(number, own): (usize, &Obligation)| {
            let margin = sampler.margin(Quality::Obligation(number), at);
            match (self.requirement.quantity.as_str(), &own.test) {
                ("stiffness", _) => Some(bound * (1.0 + margin).powi(2)),
                ("constraint_margin", _) => Some(bound * (1.0 + margin)),
                ("accuracy", Test::Accuracy(test)) if self.angle => {
                    let (tau, _) = test.turn?;
                    Some(2.0 * (at.of(tau)? * (1.0 - margin)).atan().to_degrees())
                }
                ("joint_force" | "accuracy" | "joint_acceleration", _) => {
                    Some(bound * (1.0 - margin))
                }
                ("load", Test::Beyond(det, replaced)) => {
                    Some(bound * (at.of(*replaced)? / at.of(*det)?).abs())
                }
                // Of the cosine's multiple in the row.
                ("base_joint" | "platform_joint", Test::Greatest(rows, along)) => {
                    let a = rows.first()?.a.iter().map(|&a| Some(at.of(a)?.powi(2)));
                    let across = a.sum::<Option<f64>>()?.sqrt() / bound.to_radians().cos();
                    Some((at.of(*along)? / across).clamp(-1.0, 1.0).acos().to_degrees())
                }
                ("clearance", Test::Apart(test)) => {
                    Some(bound + margin * at.of(test.distance)? * sampler.unit())
                }
                // Of a difference of squares.
                ("clearance", Test::AtLeast(f)) => match problem.tape.op(*f) {
                    Op::Sub(square, least) => {
                        let room = at.of(square)?.max(0.0).sqrt() - at.of(least)?.sqrt();
                        Some(bound + room * sampler.unit())
                    }
                    _ => None,
                },
                _ => None,
            }
        };
        let least = matches!(self.requirement.bound, Bound::Min(_));
        let worst = |a: f64, b: f64| if least { a.min(b) } else { a.max(b) };
        // The sign that goes with an angle tells nothing of its own.
        let is_sign = |own: &Obligation| matches!(own.test, Test::AtLeast(_));
        let own: Vec<_> = own.collect();
        let angles = self.requirement.quantity.ends_with("_joint") && own.len() > 1;
        let own = own.into_iter().filter(|(_, own)| !(angles && is_sign(own)));
        own.map(value).collect::<Option<Vec<f64>>>()?.into_iter().reduce(worst)
    }

    /// How far a bound is from being violated at a place; `None` where it is none.
    fn margin_with(&self, claim: &MachineClaim, place: &Place, x: f64) -> Option<f64> {
        let claim = sought(claim, self.with(x)?);
        let problem = Problem::new(&claim).ok()?;
        let sampler = Sampler::new(&claim, &problem).ok()?;
        let values = sampler.at(place);
        let own = of_sought(&problem);
        own.map(|quality| sampler.margin(quality, &values)).reduce(f64::min)
    }

    /// The bound `x > 0` whose margin is zero: by secants, or, where they do not arrive, by halving.
    pub(super) fn tight(&self, claim: &MachineClaim, place: &Place) -> Option<f64> {
        let (_, sides) = self.relation()?;
        let start = approximate(sides.first()?)?;
        let margin = |x: f64| self.margin_with(claim, place, x);
        self.by_secants(start, margin).or_else(|| self.by_halving(start, margin))
    }

    fn by_secants(&self, start: f64, margin: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        let (mut a, mut at_a) = (start, margin(start)?);
        let mut b = start * if at_a > 0.0 { 0.99 } else { 1.01 };
        for _ in 0..STEPS {
            let at_b = margin(b)?;
            if at_b == 0.0 || (b - a).abs() <= ACCURACY * b.abs() {
                return Some(b);
            }
            let next = b - at_b * (b - a) / (at_b - at_a);
            (a, at_a, b) = (b, at_b, Some(next).filter(|next| *next > 0.0)?);
        }
        None
    }

    fn by_halving(&self, start: f64, margin: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        let first = margin(start)?;
        // Whether a greater bound holds rather than a less.
        let rising = matches!(self.requirement.bound, Bound::Max(_));
        let outward = if rising == (first < 0.0) { 2.0 } else { 0.5 };
        let holds = |x: f64| margin(x).map_or(first < 0.0, |margin| margin >= 0.0);
        let (mut a, mut b) = (start, start);
        for _ in 0..STEPS {
            if holds(b) != (first >= 0.0) {
                break;
            }
            (a, b) = (b, b * outward);
        }
        for _ in 0..STEPS {
            let middle = 0.5 * (a + b);
            if holds(middle) == (first >= 0.0) {
                a = middle;
            } else {
                b = middle;
            }
        }
        Some(a)
    }
}

/// The claim of one requirement, the first, and of nothing else but what defines the paper's cube.
pub(super) fn sought(claim: &MachineClaim, requirement: Requirement) -> MachineClaim {
    alone(claim, std::iter::once(requirement).chain(defining(claim)).collect())
}

/// The obligations of that one requirement.
pub(super) fn of_sought(problem: &Problem) -> impl Iterator<Item = Quality> + '_ {
    let numbered = problem.obligations.iter().enumerate();
    let own = numbered.filter(|(_, own)| own.requirement == Some(0));
    own.map(|(number, _)| Quality::Obligation(number))
}

/// What defines the paper's cube.
pub(super) fn defining(claim: &MachineClaim) -> Option<Requirement> {
    let is_it =
        |own: &&Requirement| own.quantity == "transmission" && matches!(own.bound, Bound::Max(_));
    let cube = matches!(claim.workspace, Workspace::Cube { .. });
    claim.require.iter().find(is_it).filter(|_| cube).cloned()
}

/// The claim of these requirements alone; its bodies are claimed where their clearance is.
pub(crate) fn alone(claim: &MachineClaim, require: Vec<Requirement>) -> MachineClaim {
    let mut claim = MachineClaim { require, ..claim.clone() };
    if claim.require.iter().all(|own| own.quantity != "clearance") {
        claim.bodies.clear();
    }
    claim
}

/// The middle of a range.
pub fn middle(range: &Bound) -> Option<f64> {
    let Bound::Within([min, max]) = range else { return None };
    Some(0.5 * (approximate(min)? + approximate(max)?))
}

/// The whole turns, in degrees, with which an angle is nearest to another.
pub fn turns(angle: f64, other: f64) -> f64 {
    360.0 * ((other - angle) / 360.0).round()
}

/// Whether it is about the angle of an accuracy.
fn is_of_angle(own: &Obligation) -> bool {
    matches!(&own.test, Test::Accuracy(test) if test.is_of_angle())
}

/// `|eta_i|/L_i`.
fn cosine(leg: &Leg, values: &At) -> Option<f64> {
    let (eta_squared, length) = (values.of(leg.eta_squared?)?, values.of(leg.length?)?);
    Some(eta_squared.max(0.0).sqrt() / length)
}
