//! A refutation's witness in words, with certified digits of the value that violates the claim.

use super::facts::{parameter, shown, Facts};
use super::place::{point_text, pose_text};
use super::requirement::{rule_of, SINGULARITY};
use crate::exact::decimal::{approximate, readable, rounded, significant, Toward};
use crate::exact::{Exact, MAX_DIGITS};
use crate::search::solver;
use crate::search::solver::sample::{Quality, Worst};
use crate::search::solver::value::coordinates;
use crate::search::solver::violation::nearest_points;
use nalgebra::Vector3;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::claim::{Body, Bound, Mechanism};
use orthocert_kernel::machine::Leg;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, Test};
use orthocert_kernel::witness;
use serde::Serialize;
use std::fmt;

/// Digits of the places of bodies.
const PLACE_DIGITS: u32 = 6;
/// Digits of a violating value: as few as show the violation.
const DIGITS: std::ops::RangeInclusive<u32> = 6..=17;
/// Parts of the way from the bound to the value that are tried, where the witness shows less.
const PARTS: [f64; 6] = [1.0, 0.99, 0.9, 0.5, 0.1, 0.01];
/// Digits of a pose.
const POSE_DIGITS: u32 = 6;

/// The point, the machine and the requirement that is provably violated there.
#[derive(Clone, Debug, Serialize)]
pub struct Counterexample {
    /// The rule that is broken ([`crate::report::requirement`]).
    #[serde(skip)]
    pub rule: &'static str,
    /// What is violated: `greatest psi <= 2`.
    pub violated: String,
    /// What ends there, in a few words: the requirement, and what it is where it is none of psi and its like.
    #[serde(skip)]
    pub limit: String,
    /// The value there, with certified digits: `greatest psi >= 2.0050`.
    pub value: String,
    /// `P`, exact.
    pub point: Vec<Exact>,
    /// `P` of a platform that turns, its angles in degrees, rounded.
    #[serde(skip)]
    pub pose: Option<String>,
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_point: Option<Vec<Exact>>,
    /// The parameters with a tolerance, exact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<Setting>,
    /// Of two bodies that are too near, both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Near>,
    /// The direction of motion that is transmitted too fast or too slowly, or both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<i64>>,
}

impl Counterexample {
    /// Where, in short.
    pub fn at(&self) -> String {
        let point: Vec<String> = self.point.iter().map(readable).collect();
        self.pose.clone().unwrap_or_else(|| format!("({})", point.join(", ")))
    }
}

/// One of two bodies that are too near.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Near {
    /// What it is: `a rod of leg 2`.
    pub body: String,
    /// Nearly the point of its axis that is nearest to the other; none of two rods along one leg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
}

impl fmt::Display for Near {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.body)?;
        match &self.point {
            Some(point) => write!(f, ", about at {}", point_text(point, PLACE_DIGITS)),
            None => Ok(()),
        }
    }
}

/// The value that a witness gives to a parameter with a tolerance.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// The leg, counted from one; none of a mechanism that its user gives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// The parameter's name.
    pub parameter: String,
    /// Its value, exact.
    pub value: Exact,
}

impl Facts<'_> {
    /// The words for a witness that refutes the claim.
    pub fn counterexample(&self, witness: &Witness) -> Option<Counterexample> {
        let points = |point: &[Expression]| point.iter().map(Exact::of).collect::<Option<Vec<_>>>();
        let setting = |((place, ..), value): ((&str, &Expression, &Expression), &Expression)| {
            let (leg, parameter) = parameter(place);
            Some(Setting { leg, parameter, value: Exact::of(value)? })
        };
        let machine = self.problem.tolerances().zip(&witness.machine).map(setting);
        let (mut rule, mut other_point, mut directions) = (SINGULARITY, None, Vec::new());
        let mut bodies = Vec::new();
        let (violated, value) = match &witness.fails {
            Failure::Reach => (
                "every leg reaches P and is not serially singular there".to_owned(),
                format!("{} cannot reach P, or is serially singular there", self.short(witness)),
            ),
            Failure::Singular(other) => {
                other_point = Some(points(other)?);
                let value = "det M has opposite signs at P and P'";
                ("no parallel singularity".to_owned(), value.to_owned())
            }
            Failure::Dependent => {
                let value = "M is singular at P, exactly";
                ("no parallel singularity".to_owned(), value.to_owned())
            }
            Failure::Same { obligation, least, greatest, .. } => {
                let quality = Quality::Obligation(*obligation);
                rule = self.rule(quality);
                let ends = |k: usize| {
                    Some(format!("[{}, {}]", shown(least.get(k)?), shown(greatest.get(k)?)))
                };
                let ends: Option<Vec<String>> = (0..least.len()).map(ends).collect();
                let value =
                    format!("a point of {} has the same joint coordinates", ends?.join(" x "));
                (self.words(quality), value)
            }
            Failure::Row(number, leg) => {
                let quality = Quality::Obligation(*number);
                rule = self.rule(quality);
                (self.words(quality), format!("the row of M of leg {} is longer", leg + 1))
            }
            Failure::Obligation(number, along) => {
                let obligation = self.problem.obligations.get(*number);
                // Of others these are no directions of the platform.
                if obligation.is_some_and(|o| is_of_motions(&o.test)) {
                    directions.clone_from(along);
                }
                let quality = Quality::Obligation(*number);
                rule = self.rule(quality);
                bodies = self.too_near(*number, witness).unwrap_or_default();
                (self.words(quality), self.beyond(*number, witness)?)
            }
        };
        let limit = match &witness.fails {
            Failure::Reach => "reach: a leg ends here".to_owned(),
            _ if rule == "joint-range" => format!("{violated}, an end stop"),
            _ => violated.clone(),
        };
        let point = points(&witness.point)?;
        let pose = self.claim.orientation.as_ref().and_then(|_| {
            let at: Option<Vec<f64>> = point.iter().map(approximate).collect();
            Some(pose_text(&at?, &coordinates(self.claim), POSE_DIGITS))
        });
        Some(Counterexample {
            rule,
            violated,
            limit,
            value,
            point,
            pose,
            other_point,
            machine: machine.collect::<Option<_>>()?,
            bodies,
            directions,
        })
    }

    /// The legs that do not reach the point of a witness, as far as doubles tell.
    fn short(&self, witness: &Witness) -> String {
        let place = self.sampler.place_of(&witness.point, &witness.machine);
        let values = place.as_ref().map(|place| self.sampler.at(place));
        let is_short = |leg: &Leg| {
            let values = values.as_ref()?;
            let reaches = leg.row.a.iter().all(|&a| values.of(a).is_some());
            Some(!reaches || values.of(leg.row.d).is_none_or(|d| d <= 0.0))
        };
        let legs = self.problem.legs.iter().enumerate();
        let short = legs.filter(|(_, leg)| is_short(leg) == Some(true));
        let names: Vec<String> = short.map(|(at, _)| (at + 1).to_string()).collect();
        match (&self.claim.mechanism, &names[..]) {
            (Mechanism::Formulas(_), _) | (_, []) => "a leg".to_owned(),
            (_, [one]) => format!("leg {one}"),
            (_, all) => format!("one of legs {}", all.join(", ")),
        }
    }

    /// The rule that an obligation is part of.
    fn rule(&self, quality: Quality) -> &'static str {
        self.bounded(quality).map_or(SINGULARITY, |bounded| rule_of(&bounded.requirement.quantity))
    }

    /// The two bodies of an obligation of clearance, and their nearest points at a witness.
    fn too_near(&self, number: usize, witness: &Witness) -> Option<Vec<Near>> {
        let place = self.sampler.place_of(&witness.point, &witness.machine)?;
        let (bodies, points) = match &self.problem.obligations.get(number)?.test {
            Test::Apart(test) => {
                let points = nearest_points(&self.sampler.at(&place), test)?;
                let shown = |p: Vector3<f64>| Some((p * self.sampler.unit()).into());
                (test.bodies, points.map(shown))
            }
            // Those along one leg, in the order of their obligations.
            Test::AtLeast(_) if self.bounded(Quality::Obligation(number))?.is_clearance() => {
                let before = self.problem.obligations[..number].iter().enumerate();
                let before = before.filter(|(at, own)| {
                    let bounded = self.bounded(Quality::Obligation(*at));
                    matches!(own.test, Test::AtLeast(_))
                        && bounded.is_some_and(|b| b.is_clearance())
                });
                (along_one_leg(&self.claim.bodies).nth(before.count())?, [None; 2])
            }
            _ => return None,
        };
        let near = |(number, point): (usize, _)| {
            let body = match self.claim.bodies.get(number - 1)? {
                Body::Leg { leg, .. } => format!("a rod of leg {leg}"),
                Body::Base { .. } => "a body on the base".to_owned(),
                Body::Platform { .. } => "a body on the platform".to_owned(),
            };
            Some(Near { body, point })
        };
        bodies.into_iter().zip(points).map(near).collect()
    }

    /// The value at a witness, in certified digits: a bound in its place that the witness refutes too.
    fn beyond(&self, number: usize, witness: &Witness) -> Option<String> {
        let quality = Quality::Obligation(number);
        // What is shown is of both bounds together.
        if matches!(&self.problem.obligations[number].test, Test::Accuracy(test) if test.turn.is_some())
        {
            return Some("no pose within both bounds".to_owned());
        }
        let (name, _, relation, sides) = self.demanded(quality);
        let place = self.sampler.place_of(&witness.point, &witness.machine)?;
        let found = Worst { quality, place, margin: -1.0 };
        let value = self.value(quality, &found);
        let (towards, reverse) = match relation {
            "<=" => (Toward::Below, ">="),
            ">=" => (Toward::Above, "<="),
            "in" => {
                let angle = value.map_or_else(String::new, |x| significant(x, *DIGITS.start()));
                let name = name.split(',').next().unwrap_or(&name);
                return Some(format!("{name} is about {angle} degrees, up to full turns"));
            }
            _ => return Some(format!("{name} fails")),
        };
        let bound = Exact::of(sides.first()?)?.below(256)?;
        // No clearance less than none is claimed.
        let touch = self.bounded(quality).is_some_and(|bounded| bounded.is_clearance());
        let value = value.map(|value| if touch { value.max(0.0) } else { value });
        let Some(value) = value.and_then(BigRational::from_f64) else {
            let is_near = |x: &Expression| solver::approximate(x).is_some();
            let is_singular =
                value.is_some_and(f64::is_infinite) && witness.point.iter().all(is_near);
            // Beyond the doubles nothing is known of it but what is refuted.
            return Some(match is_singular {
                true => format!("{name} has no bound: M is singular there"),
                false => format!("{name} {} {}", &reverse[..1], shown(sides.first()?)),
            });
        };
        let texts = PARTS.into_iter().flat_map(|part| {
            let part = BigRational::from_f64(part).unwrap_or_else(|| bound.clone());
            let x = &bound + (&value - &bound) * part;
            DIGITS.map(move |digits| rounded(&x, digits, towards))
        });
        let mut shown = texts.filter(|text| self.refutes_with(number, witness, text));
        let text = shown.next();
        Some(match text {
            Some(text) => format!("{name} {reverse} {text}"),
            None => format!("{name} {} {}", &reverse[..1], sides[0]),
        })
    }

    /// Whether a witness also refutes the claim with another bound.
    fn refutes_with(&self, number: usize, witness: &Witness, text: &str) -> bool {
        let mut claim = self.claim.clone();
        let obligation: &Obligation = &self.problem.obligations[number];
        let requirement = obligation.requirement.and_then(|at| claim.require.get_mut(at));
        let (Some(requirement), Ok(x)) = (requirement, Exact::parse(text, MAX_DIGITS)) else {
            return false;
        };
        let x = x.as_rational().map(crate::exact::arithmetic::number);
        let (Bound::Min(bound) | Bound::Max(bound), Some(x)) = (&mut requirement.bound, x) else {
            return false;
        };
        if *bound == x {
            return false;
        }
        *bound = x;
        let problem = Problem::new(&claim);
        problem.is_ok_and(|problem| witness::check(&problem, &claim.workspace, witness).is_ok())
    }
}

/// Pairs of bodies along one leg of which one is beside it, counted from one, in the order of their obligations.
fn along_one_leg(bodies: &[Body]) -> impl Iterator<Item = [usize; 2]> + '_ {
    let leg = |body: &Body| match body {
        Body::Leg { leg, offset, .. } => Some((*leg, offset.is_some())),
        Body::Base { .. } | Body::Platform { .. } => None,
    };
    let pairs = (0..bodies.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
    let of_one = move |pair: &[usize; 2]| match pair.map(|at| leg(&bodies[at])) {
        [Some((one, beside)), Some((other, other_beside))] => {
            one == other && (beside || other_beside)
        }
        _ => false,
    };
    pairs.filter(of_one).map(|pair| pair.map(|at| at + 1))
}

/// Whether a test fails along directions in which the platform moves.
fn is_of_motions(test: &Test) -> bool {
    matches!(
        test,
        Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_) | Test::Curvature(_)
    )
}
