//! Which quantities a summary is of: those that every design has, those that the design asks for, and
//! those that the command line asks for.

use super::Value;
use crate::exact::Exact;
use crate::report::shown;
use crate::search::solver::extremes::{of_cube, Extreme};
use crate::search::solver::value::{name_of, unit};
use num_rational::BigRational;
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism, Requirement, Workspace};
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use std::collections::BTreeMap;

/// What is asked beyond what every design is.
#[derive(Clone, Debug)]
pub struct Question {
    /// The tool's speed.
    pub speed: Option<Expression>,
    /// The force on the platform.
    pub force: Option<Expression>,
    /// The tool's acceleration.
    pub acceleration: Option<Expression>,
    /// Whether velocities of the platform have one unit: it does not turn, or the design gives its
    /// characteristic length.
    pub one_unit: bool,
    /// The relative width of enclosures.
    pub gap: BigRational,
}

/// A quantity, or both ends of one.
#[derive(Clone, Debug)]
pub enum Asked {
    /// One end.
    Extreme(Extreme),
    /// The angles of the joint of a leg, counted from zero.
    Angle(usize),
    /// The least or, if so, the greatest psi, which the paper's cube has by definition.
    Known(bool, Exact),
}

/// Whether joint coordinates are angles.
pub fn is_angular(problem: &Problem) -> bool {
    problem.legs.iter().any(Leg::is_angular)
}

fn requirement(quantity: &str, given: &[(&str, &Expression)], bound: Bound) -> Requirement {
    let given = given.iter().map(|&(name, x)| (name.to_owned(), vec![x.clone()])).collect();
    Requirement { quantity: quantity.to_owned(), leg: None, given, bound }
}

/// What is asked of a claim; with sentences about what it has not.
pub fn asked(
    claim: &MachineClaim,
    problem: &Problem,
    question: &Question,
) -> (Vec<Asked>, Vec<String>) {
    let two = || Expression::integer(2);
    let plain = |quantity, bound: fn(Expression) -> Bound| requirement(quantity, &[], bound(two()));
    let (mut all, mut left_out) = (Vec::new(), Vec::new());
    for (leg, joint) in problem.legs.iter().enumerate() {
        match joint.rho {
            Some(Joint::Length(_)) => {
                let ends = [Bound::Min as fn(_) -> _, Bound::Max];
                let ends = ends.map(|end| Extreme::on(plain("joint_range", end), Some(leg)));
                all.extend(ends.into_iter().flatten().map(Asked::Extreme));
            }
            Some(Joint::Angle { .. }) => all.push(Asked::Angle(leg)),
            None => {}
        }
    }
    let known = of_cube(claim);
    for (greatest, end) in [(false, Bound::Min as fn(_) -> _), (true, Bound::Max)] {
        match known.iter().find(|(known, _)| *known == greatest) {
            Some((_, value)) => all.push(Asked::Known(greatest, value.clone())),
            None if question.one_unit => {
                all.extend(Extreme::on(plain("transmission", end), None).map(Asked::Extreme));
            }
            None => {}
        }
    }
    let zero = Expression::integer(0);
    let one_more = |quantity: &str, given: &[(&str, &Expression)]| {
        Extreme::on(requirement(quantity, given, Bound::Max(two())), None)
    };
    let options = [
        question.speed.as_ref().map(|speed| one_more("joint_speed", &[("tool", speed)])),
        question.force.as_ref().map(|force| one_more("joint_force", &[("tool", force)])),
        question.acceleration.as_ref().map(|acceleration| {
            let speed = question.speed.as_ref().unwrap_or(&zero);
            let given = [("acceleration", acceleration), ("speed", speed)];
            one_more("joint_acceleration", &given)
        }),
    ];
    for extreme in options.into_iter().flatten().flatten() {
        let quantity = extreme.bounded().requirement.quantity.clone();
        let no_unit = quantity == "joint_speed" && !question.one_unit;
        if extreme.is_of(claim) && !no_unit {
            all.push(Asked::Extreme(extreme));
        } else {
            left_out.push(why_not(claim, problem, &quantity));
        }
    }
    for own in &claim.require {
        let leg = own.leg.map(|leg| leg - 1);
        let there = own.quantity == "joint_range"
            || own.quantity == "transmission" && matches!(claim.workspace, Workspace::Cube { .. });
        let angle = Extreme::angle(claim, own).map(Asked::Extreme);
        // About a point, no position is off.
        let still = angle.is_some() && matches!(claim.mechanism, Mechanism::Spherical(_));
        let extreme = Extreme::on(own.clone(), leg).filter(|_| !there && !still);
        let is_new = |one: &Extreme| {
            !all.iter().any(|known| matches!(known, Asked::Extreme(known) if known == one))
        };
        all.extend(extreme.filter(is_new).map(Asked::Extreme));
        all.extend(angle);
    }
    (all, left_out)
}

/// Why a quantity is left out.
fn why_not(claim: &MachineClaim, problem: &Problem, quantity: &str) -> String {
    let (joints, coordinates) = (problem.legs.len(), problem.dimension());
    let words = name_of(quantity);
    let turns = claim.orientation.is_some();
    let why = match quantity {
        "joint_speed" if turns => {
            "the platform turns, and mechanism.characteristic_length, by which angular \
                          speeds become speeds, is not given"
                .to_owned()
        }
        "joint_force" if joints != coordinates => format!(
            "static forces determine those of the joints where there are as many joints as \
             coordinates; here {joints} and {coordinates}"
        ),
        _ if matches!(claim.mechanism, Mechanism::Formulas(_)) => {
            "it is not decided of this mechanism of formulas".to_owned()
        }
        _ => "it is not decided of this machine".to_owned(),
    };
    format!("greatest {words}: left out; {why}")
}

impl Asked {
    /// "least", "greatest", or both.
    pub fn ends(&self) -> &'static [&'static str] {
        match self {
            Asked::Extreme(extreme) if extreme.is_greatest() => &["greatest"],
            Asked::Extreme(_) => &["least"],
            Asked::Angle(_) => &["least", "greatest"],
            Asked::Known(true, _) => &["greatest"],
            Asked::Known(false, _) => &["least"],
        }
    }

    /// The key of the quantity, the leg, counted from zero, and what it is for.
    pub fn of(&self) -> (&str, Option<usize>, BTreeMap<String, Vec<Expression>>) {
        match self {
            Asked::Extreme(extreme) => {
                let bounded = extreme.bounded();
                let Requirement { quantity, given, .. } = &bounded.requirement;
                (quantity, bounded.leg, given.clone())
            }
            Asked::Angle(leg) => ("joint_range", Some(*leg), BTreeMap::new()),
            Asked::Known(..) => ("transmission", None, BTreeMap::new()),
        }
    }

    /// An end of it, without its value.
    pub fn value(&self, end: &'static str, angular: bool) -> Value {
        let (quantity, leg, given) = self.of();
        let angle = matches!(self, Asked::Extreme(extreme) if extreme.bounded().angle);
        let numbers = |(name, x): (&String, &Vec<Expression>)| {
            (name.clone(), x.iter().map(Expression::to_string).collect())
        };
        Value {
            quantity: quantity.to_owned(),
            words: match angle {
                true => format!("angle {}", words(quantity, leg, &given, angular)),
                false => words(quantity, leg, &given, angular),
            },
            joint: leg.map(|leg| leg + 1),
            given: given.iter().map(numbers).collect(),
            unit: if angle { Some("deg") } else { unit(quantity, angular) },
            end,
            certified: None,
            reached: None,
            own_bound: false,
            relative: None,
            not_enclosed: None,
        }
    }
}

fn words(
    quantity: &str,
    leg: Option<usize>,
    given: &BTreeMap<String, Vec<Expression>>,
    angular: bool,
) -> String {
    let number = |name: &str| {
        let all = given.get(name).into_iter().flatten();
        all.map(shown).collect::<Vec<_>>().join(", ")
    };
    let leg = leg.map_or_else(String::new, |leg| format!(" {}", leg + 1));
    match quantity {
        "joint_range" => format!("stroke of joint{leg}"),
        "transmission" => "transmission factor psi".to_owned(),
        "joint_speed" => format!("joint speed{leg} for tool speed {}", number("tool")),
        "joint_force" if angular => format!("joint torque{leg} for a force of {}", number("tool")),
        "joint_force" => format!("joint force{leg} for a force of {}", number("tool")),
        "joint_acceleration" => format!(
            "joint acceleration{leg} for {} at speed {}",
            number("acceleration"),
            number("speed")
        ),
        "stiffness" => format!("stiffness, joints of {}", number("joint")),
        "accuracy" if angular => {
            format!("off by, joint errors up to {} deg", number("joint_error"))
        }
        "accuracy" => format!("off by, joint errors up to {}", number("joint_error")),
        other => format!("{}{leg}", name_of(other)),
    }
}
