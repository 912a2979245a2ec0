//! The facts about claims of the kernel: any number of coordinates, any quantity of its table.

use super::place::{pose_text, FreeParameter};
use super::remains::{reason, OpenRegion, OpenRequirement, Remains, WorstBox};
use super::share::sum_above;
use super::{Counterexample, Near, Row, Setting};
use crate::exact::decimal::{approximate, exact, readable, rounded, significant, Toward};
use crate::exact::{Exact, MAX_DIGITS};
use crate::report::requirement::{rule_of, SINGULARITY};
use crate::search::solver::sample::{At, Place, Quality, Sampler, Worst};
use crate::search::solver::search::Open;
use crate::search::solver::value::{coordinates, with_unit, Bounded};
use crate::search::solver::violation::nearest_points;
use crate::search::solver::{self, Undecided};
use crate::search::Stop;
use nalgebra::Vector3;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::claim::{Body, Bound, MachineClaim, Mechanism, Workspace};
use orthocert_kernel::machine::Leg;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, Test};
use orthocert_kernel::witness;
use std::collections::{BTreeMap, BTreeSet};

/// Relative violations below this are rounding errors of the sampling.
const NOISE: f64 = 1e-12;
/// Margins below this are ties, as far as doubles can tell.
const TIE: f64 = 1e-9;
/// Digits of a violating value: as few as show the violation.
const DIGITS: std::ops::RangeInclusive<u32> = 6..=17;
/// Parts of the way from the bound to the value that are tried, where the witness shows less.
const PARTS: [f64; 6] = [1.0, 0.99, 0.9, 0.5, 0.1, 0.01];
/// Digits of a pose.
const POSE_DIGITS: u32 = 6;
/// Regions that are described one by one.
const REGIONS: usize = 12;
/// Boxes that are brought together; more are left out of the regions.
const MOST_BOXES: usize = 2000;

/// A claim, and what its values are looked up in.
pub struct Facts<'a> {
    claim: &'a MachineClaim,
    problem: &'a Problem,
    sampler: Sampler<'a>,
    angular: bool,
}

/// Relative margin of an accuracy beyond which its bound is what makes it hard.
const AMPLE: f64 = 0.75;

/// The name of what is under the roots of a leg's closure.
pub const RADICAND: &str = "least radicand";
/// What a singularity has 0 of.
pub const DETERMINANT: &str = "least |det M|";

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

/// A number for people.
pub fn shown(x: &Expression) -> String {
    Exact::of(x).map_or_else(|| x.to_string(), |x| readable(&x))
}

impl<'a> Facts<'a> {
    /// About a claim; `None` where its numbers cannot be shown.
    pub fn new(claim: &'a MachineClaim, problem: &'a Problem) -> Option<Self> {
        let sampler = Sampler::new(claim, problem).ok()?;
        let angular = problem.legs.iter().any(Leg::is_angular);
        Some(Facts { claim, problem, sampler, angular })
    }

    fn bounded(&self, quality: Quality) -> Option<Bounded> {
        match quality {
            Quality::Obligation(number) => Bounded::of(self.claim, self.problem, number),
            Quality::Reach | Quality::Determinant => None,
        }
    }

    /// Name, unit, relation and other side of what is demanded.
    fn demanded(
        &self,
        quality: Quality,
    ) -> (String, Option<&'static str>, &'static str, Vec<Expression>) {
        let Some(bounded) = self.bounded(quality) else {
            let name = match quality {
                Quality::Reach => RADICAND,
                Quality::Determinant => DETERMINANT,
                Quality::Obligation(_) => "least sigma_min(M)",
            };
            return (name.to_owned(), None, ">", vec![Expression::integer(0)]);
        };
        let unit = bounded.unit(self.angular);
        let name = with_unit(&bounded.name(), unit);
        match bounded.relation() {
            Some((relation, sides)) => (name, unit, relation, sides.into_iter().cloned().collect()),
            None => (name, unit, "holds", Vec::new()),
        }
    }

    /// The name of what is demanded of one leg, without the leg.
    fn of_all(&self, quality: Quality) -> Option<String> {
        let bounded = self.bounded(quality)?;
        bounded.leg.map(|_| Bounded { leg: None, ..bounded }.name())
    }

    /// A requirement in words: `greatest psi <= 2`.
    fn words(&self, quality: Quality) -> String {
        let (name, _, relation, sides) = self.demanded(quality);
        let side = |x: &Expression| Exact::of(x).map_or_else(|| x.to_string(), |x| exact(&x));
        format!("{name} {}", bound_text(relation, sides.iter().map(side).collect()))
    }

    fn value(&self, quality: Quality, found: &Worst) -> Option<f64> {
        let values = self.sampler.at(&found.place);
        self.sampler.matrix(&values)?;
        let lengths = i32::try_from(self.problem.dimension()).ok()?;
        let unit = if self.angular { self.sampler.unit() } else { 1.0 };
        match self.bounded(quality) {
            // Of two points.
            Some(bounded) if bounded.requirement.bound == Bound::Holds => None,
            Some(bounded) => bounded.value(self.claim, self.problem, &self.sampler, &found.place),
            None => Some(match quality {
                // A square of a length.
                Quality::Reach => found.margin * self.sampler.unit().powi(2),
                // Of another sign than at the centre it is 0 on the way there, and not here.
                Quality::Determinant if found.margin < -NOISE => found.margin / unit.powi(lengths),
                Quality::Determinant => found.margin.max(0.0) / unit.powi(lengths),
                Quality::Obligation(_) => found.margin / unit,
            }),
        }
    }

    /// The rows of a verification's worst values.
    pub fn rows(&self, worst: &[Worst]) -> Vec<Row> {
        let mut rows: Vec<Row> = Vec::new();
        for found in worst {
            let (requirement, unit, relation, sides) = self.demanded(found.quality);
            let texts = |text: &dyn Fn(&Expression) -> String| sides.iter().map(text).collect();
            let row = Row {
                requirement,
                of_all: self.of_all(found.quality),
                margin: found.margin,
                unit,
                relation,
                bound_text: bound_text(relation, texts(&shown)),
                bound: bound_text(relation, texts(&Expression::to_string)),
                worst_found: self.value(found.quality, found),
                at: self.sampler.shown(&found.place.u),
                machine: self.machine(&found.place),
                seems_violated: found.margin < -NOISE,
            };
            // Both ends of a range of angles are one row, and so are the tests of one requirement.
            match rows.iter_mut().find(|known| known.requirement == row.requirement) {
                Some(known) => {
                    let seems_violated = known.seems_violated || row.seems_violated;
                    let margin = known.margin.min(row.margin);
                    if row.is_worse_than(known) {
                        *known = row;
                    }
                    (known.seems_violated, known.margin) = (seems_violated, margin);
                }
                None => rows.push(row),
            }
        }
        rows
    }

    fn machine(&self, place: &Place) -> Vec<FreeParameter> {
        let named = self.problem.tolerances().zip(self.sampler.machine(place));
        named
            .map(|((place, ..), value)| {
                let (leg, parameter) = parameter(place);
                FreeParameter { leg, parameter, value }
            })
            .collect()
    }

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

    /// What an undecided claim leaves open.
    pub fn remains(&self, undecided: &Undecided, worst: &[Worst], tried: usize) -> Remains {
        let open = &undecided.open;
        let [min, max] = &self.sampler.ends();
        let volume: f64 = min.iter().zip(max).map(|(min, max)| max - min).product();
        let total = self.of_workspace(open.iter().map(share).fold(0.0, sum_above));
        let all = regions(open);
        let region = |region: &Region| {
            let [min, max] = self.extent(&region.cell);
            OpenRegion { boxes: region.boxes, share: self.of_workspace(region.share), min, max }
        };
        Remains {
            reason: reason(undecided.objection.as_ref(), undecided.stop, tried),
            boxes: open.len(),
            volume: total * volume / self.box_of_workspace(),
            share: total,
            region_count: all.len(),
            regions: all.iter().take(REGIONS).map(region).collect(),
            worst_box: self.worst_box(open),
            open: self.open(undecided, worst),
        }
    }

    /// The box around the workspace, in parts of it: boxes of a cylinder are parts of that box.
    fn box_of_workspace(&self) -> f64 {
        match self.claim.workspace {
            Workspace::Cylinder { .. } => std::f64::consts::FRAC_PI_4.recip().next_up(),
            Workspace::Box { .. } | Workspace::Cube { .. } => 1.0,
        }
    }

    /// The share of the workspace of a share of the box around it, or more.
    fn of_workspace(&self, share: f64) -> f64 {
        match self.box_of_workspace() {
            1.0 => share,
            part => (share * part).next_up().min(1.0),
        }
    }

    fn extent(&self, cell: &[(f64, f64)]) -> [Vec<f64>; 2] {
        let end = |of: fn(&(f64, f64)) -> f64| {
            let edges = cell.iter().enumerate();
            edges.map(|(k, edge)| of(edge) * self.sampler.unit_of(k)).collect()
        };
        [end(|x| x.0), end(|x| x.1)]
    }

    fn worst_box(&self, open: &[Open]) -> Option<WorstBox> {
        let stride = open.len().div_ceil(MOST_BOXES).max(1);
        let at_centre = |item: &Open| {
            let values = self.sampler.at(&self.sampler.place_in(&item.cell));
            let all = item.obligations.iter().map(|&number| Quality::Obligation(number));
            let margins = all.map(|quality| (self.relative_margin(quality, &values), quality));
            margins.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let boxes = open.iter().step_by(stride).filter_map(|item| Some((item, at_centre(item)?)));
        let (item, (margin, quality)) = boxes.min_by(|a, b| a.1 .0.total_cmp(&b.1 .0))?;
        let [min, max] = self.extent(&item.cell);
        Some(WorstBox { min, max, requirement: self.words(quality), margin })
    }

    /// Tests of one requirement that are told in the same words are one.
    fn open(&self, undecided: &Undecided, worst: &[Worst]) -> Vec<OpenRequirement> {
        let mut all = BTreeMap::new();
        let numbers: BTreeSet<usize> =
            undecided.open.iter().flat_map(|item| item.obligations.iter().copied()).collect();
        for number in numbers {
            let requirement = self.problem.obligations[number].requirement;
            let told = (requirement, self.words(Quality::Obligation(number)));
            all.entry(told).or_insert_with(Vec::new).push(number);
        }
        let of = |((_, requirement), numbers): ((_, _), Vec<usize>)| {
            let is_open =
                |item: &&Open| numbers.iter().any(|number| item.obligations.contains(number));
            let boxes = || undecided.open.iter().filter(is_open);
            let margins = numbers.iter().map(|&number| {
                let quality = Quality::Obligation(number);
                let found = worst.iter().find(|found| found.quality == quality);
                let at = |found: &Worst| self.sampler.at(&found.place);
                (found.map(|found| self.relative_margin(quality, &at(found))), quality)
            });
            let far = |margin: Option<f64>| margin.unwrap_or(f64::INFINITY);
            let (margin, quality) = margins.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
            let rule =
                self.bounded(quality).map_or("singularity".to_owned(), |b| b.requirement.quantity);
            let reason = match undecided.stop {
                Stop::Exhausted | Stop::Hopeless => "the test does not hold",
                Stop::Boxes | Stop::Time | Stop::Cancelled => "not shown within the budget",
            };
            Some(OpenRequirement {
                obligation: rule,
                requirement,
                boxes: boxes().count(),
                share: self.of_workspace(boxes().map(share).fold(0.0, sum_above)),
                reason,
                help: self.help((quality, worst), undecided.stop, margin),
            })
        };
        all.into_iter().filter_map(of).collect()
    }

    /// The margin relative to the bound, which that of a joint speed's test, a product of several quantities, is not.
    fn relative_margin(&self, quality: Quality, values: &At<'_>) -> f64 {
        let of_speed = || {
            let bounded = self.bounded(quality)?;
            match (bounded.requirement.quantity.as_str(), &bounded.requirement.bound) {
                ("joint_speed", Bound::Max(max)) => {
                    let value = bounded.known(self.problem, &self.sampler, values)?;
                    Some(1.0 - value / solver::approximate(max)?)
                }
                _ => None,
            }
        };
        let of_speed = of_speed().filter(|margin| margin.is_finite());
        of_speed.unwrap_or_else(|| self.sampler.margin(quality, values))
    }

    fn help(
        &self,
        (quality, worst): (Quality, &[Worst]),
        stop: Stop,
        margin: Option<f64>,
    ) -> &'static str {
        let is_accuracy = |quality| {
            self.bounded(quality).is_some_and(|own| own.requirement.quantity == "accuracy")
        };
        // Of the distance or of the angle.
        let is_ample = || {
            let mut parts = worst.iter().filter(|found| is_accuracy(found.quality));
            parts.any(|found| found.margin > AMPLE)
        };
        match (stop, margin) {
            (_, Some(margin)) if margin > TIE && is_accuracy(quality) && is_ample() => {
                "smaller bounds: within them there is to be no second pose, which is the harder to show \
                 the more room they leave; twice the worst found is enough"
            }
            (_, Some(margin)) if margin.abs() <= TIE => {
                "it holds with equality, or nearly, somewhere; no splitting decides a tie: give the \
                 bound or the workspace a little more room"
            }
            (Stop::Exhausted | Stop::Hopeless, _) if self.problem.tolerances().next().is_some() => {
                "narrower tolerances, or more room in the bounds: no test covers all machines within \
                 the tolerances at once"
            }
            (Stop::Exhausted | Stop::Hopeless, _) => {
                "more room in the bounds, or a smaller workspace: even the centres of the remaining \
                 boxes are too close to the bound for the tests"
            }
            (Stop::Boxes | Stop::Time | Stop::Cancelled, _) => {
                "a larger budget: --max-boxes, --timeout"
            }
        }
    }
}

/// Whether a test fails along directions in which the platform moves.
fn is_of_motions(test: &Test) -> bool {
    matches!(
        test,
        Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_) | Test::Curvature(_)
    )
}

/// `>= 1/2`, `in [-30, 40]`, `holds`.
fn bound_text(relation: &str, sides: Vec<String>) -> String {
    match &sides[..] {
        [] => relation.to_owned(),
        [side] => format!("{relation} {side}"),
        sides => format!("{relation} [{}]", sides.join(", ")),
    }
}

/// The leg, counted from one, and the parameter that a place of the claim names: `leg 1: anchor.0`.
pub fn parameter(place: &str) -> (Option<usize>, String) {
    let split = place.strip_prefix("leg ").and_then(|rest| rest.split_once(": "));
    let (leg, name) = match split {
        Some((leg, name)) => (leg.parse().ok(), name),
        None => (None, place),
    };
    let component = name.split_once('.').and_then(|(name, k)| {
        let axis = ["x", "y", "z"].get(k.parse::<usize>().ok()?)?;
        Some(format!("{name} {axis}"))
    });
    (leg, component.unwrap_or_else(|| name.to_owned()))
}

/// Open boxes that touch.
struct Region {
    boxes: usize,
    share: f64,
    cell: Vec<(f64, f64)>,
}

fn share(item: &Open) -> f64 {
    (-f64::from(item.depth)).exp2()
}

/// The regions of the largest boxes, greatest share first.
fn regions(open: &[Open]) -> Vec<Region> {
    let mut largest: Vec<&Open> = open.iter().collect();
    largest.sort_by_key(|item| item.depth);
    let mut all: Vec<Region> = Vec::new();
    let mut members: Vec<Vec<&Open>> = Vec::new();
    for item in largest.into_iter().take(MOST_BOXES) {
        let touch = |other: &&Open| {
            let mut both = item.cell.iter().zip(&other.cell);
            both.all(|(a, b)| a.0 <= b.1 && b.0 <= a.1)
        };
        let (near, far) =
            members.into_iter().partition(|region: &Vec<&Open>| region.iter().any(touch));
        let near: Vec<Vec<&Open>> = near;
        members = far;
        members.push(near.into_iter().flatten().chain([item]).collect());
    }
    for region in members {
        let mut cell = region[0].cell.clone();
        for other in &region {
            for (hull, edge) in cell.iter_mut().zip(&other.cell) {
                *hull = (hull.0.min(edge.0), hull.1.max(edge.1));
            }
        }
        let share = region.iter().map(|item| share(item)).fold(0.0, sum_above);
        all.push(Region { boxes: region.len(), share, cell });
    }
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}
