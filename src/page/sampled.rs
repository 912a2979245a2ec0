//! Values of a kernel claim's quantities in doubles, and the worst of them found by sampling: no
//! proof of anything.

use nalgebra::{Matrix6, SMatrix};
use num_bigint::BigInt;
use num_traits::ToPrimitive;
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism, Quantity, Requirement, Workspace};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{Formula, Op, Values};
use orthocert_kernel::input::Value;
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;

/// Fractional bits in which numbers are enclosed before they become doubles.
const BITS: u32 = 128;
/// Points at which values are taken first.
const POINTS: usize = 4096;
/// Most points along a coordinate.
const MOST_ALONG: usize = 33;
/// Operations for these points, where a claim has many formulas.
const OPERATIONS: usize = 200_000_000;
/// Most legs and coordinates of a claim.
const MOST_LEGS: usize = 12;
const MOST_COORDINATES: usize = orthocert_kernel::slope::MOST_COORDINATES;
/// Most rounds of that search.
const MOST_ROUNDS: usize = 200;
/// Least step of the search about the worst of them, as a part of the workspace.
const STEP: f64 = 1e-7;

/// Numbers that have no value are none, as where an exact formula is undefined.
struct Doubles;

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

impl Arithmetic for Doubles {
    type Number = f64;
    fn integer(&self, n: i64) -> Option<f64> {
        Some(n as f64)
    }
    fn add(&self, a: &f64, b: &f64) -> Option<f64> {
        finite(a + b)
    }
    fn sub(&self, a: &f64, b: &f64) -> Option<f64> {
        finite(a - b)
    }
    fn neg(&self, a: &f64) -> Option<f64> {
        Some(-a)
    }
    fn mul(&self, a: &f64, b: &f64) -> Option<f64> {
        finite(a * b)
    }
    fn div(&self, a: &f64, b: &f64) -> Option<f64> {
        finite(a / b)
    }
    fn sqr(&self, a: &f64) -> Option<f64> {
        finite(a * a)
    }
    fn sqrt(&self, a: &f64) -> Option<f64> {
        (*a > 0.0).then(|| a.sqrt())
    }
}

/// A number of a claim as a double.
pub fn double(x: &Expression) -> Option<f64> {
    x.enclose(&Fixed::new(BITS), &|_| None).and_then(|x| middle(&x))
}

fn ends(x: &Interval<BigInt>) -> Option<[f64; 2]> {
    let end = |x: &BigInt| finite(x.to_f64()? * (-f64::from(BITS)).exp2());
    Some([end(&x.lo)?, end(&x.hi)?])
}

fn middle(x: &Interval<BigInt>) -> Option<f64> {
    ends(x).map(|[lo, hi]| lo + (hi - lo) / 2.0)
}

/// What was found at a point.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// `psi_1 <= .. <= psi_m`, in the claim's unit; none at a parallel singularity.
    pub psi: Vec<f64>,
    /// Of each requirement, the leg with the least margin.
    pub of: Vec<Option<Found>>,
}

/// A requirement at a point.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The quantity, in the claim's unit; none of one whose tests alone are known here.
    pub value: Option<f64>,
    /// The distance to the bound on the side where it holds, as a part of the bound.
    pub margin: f64,
    /// The leg, counted from zero.
    pub leg: Option<usize>,
}

/// The worst of a requirement.
#[derive(Clone, Debug)]
pub struct Worst {
    /// What was found there.
    pub found: Found,
    /// The point, in the claim's unit.
    pub at: Vec<f64>,
    /// The machine: a value of every parameter of the tape.
    pub machine: Vec<f64>,
}

/// A requirement's numbers.
#[derive(Clone, Debug)]
struct Ends {
    key: String,
    min: Option<f64>,
    max: Option<f64>,
    /// What margins are parts of.
    scale: f64,
    /// The platform's speed, where one is given.
    tool: Option<f64>,
}

impl Ends {
    fn all(require: &[Requirement]) -> Vec<Self> {
        let ends = |requirement: &Requirement| {
            let (min, max) = match &requirement.bound {
                Bound::Min(min) => (double(min), None),
                Bound::Max(max) => (None, double(max)),
                Bound::Within([min, max]) => (double(min), double(max)),
                Bound::Holds => (None, None),
            };
            let tool = requirement.given.get("tool").and_then(|all| double(all.first()?));
            Ends { key: requirement.quantity.clone(), min, max, scale: 0.0, tool }
        };
        let mut all: Vec<Ends> = require.iter().map(ends).collect();
        for i in 0..all.len() {
            let same = all.iter().filter(|other| other.key == all[i].key);
            let size = same.flat_map(|ends| [ends.min, ends.max]).flatten().map(f64::abs);
            let greatest = size.fold(0.0, f64::max);
            let own = match (all[i].min, all[i].max) {
                (Some(min), Some(max)) => max - min,
                (Some(bound), None) | (None, Some(bound)) => bound.abs(),
                (None, None) => 0.0,
            };
            let known = [own, greatest, 1.0].into_iter().find(|scale| *scale > 0.0);
            all[i].scale = known.unwrap_or(1.0);
        }
        all
    }

    /// How far a value is from its bound; none where nothing is bounded.
    fn margin(&self, value: f64) -> Option<f64> {
        let below = self.min.map(|min| (value - min) / self.scale);
        let above = self.max.map(|max| (max - value) / self.scale);
        below.into_iter().chain(above).min_by(f64::total_cmp)
    }

    /// The angle nearest to the middle of the range, of those that differ by whole turns.
    fn turned(&self, angle: f64) -> f64 {
        let Some((min, max)) = self.min.zip(self.max) else { return angle };
        angle - 360.0 * ((angle - (min + max) / 2.0) / 360.0).round()
    }
}

/// A claim in doubles.
#[derive(Debug)]
pub struct Sampler {
    problem: Problem,
    requirements: Vec<Ends>,
    /// Least and greatest value of each parameter of the tape.
    parameters: Vec<[f64; 2]>,
    /// Least and greatest value of each coordinate, in the claim's unit.
    pub root: Vec<[f64; 2]>,
    /// The claim's unit of each coordinate in that of the problem.
    units: Vec<f64>,
    /// The cylinder that the workspace is: its centre and radius.
    cylinder: Option<([f64; 2], f64)>,
}

impl Sampler {
    /// A claim in doubles; `None` if it is not well formed, or beyond them.
    pub fn new(claim: &MachineClaim) -> Option<Self> {
        let problem = Problem::new(claim).ok()?;
        let parameters = problem.parameters::<BigInt>(BITS, &[]).ok()?;
        let parameters = parameters.iter().map(ends).collect::<Option<_>>()?;
        let unit = (problem.scale as f64).exp2();
        let lengths = positions(claim).unwrap_or(problem.dimension());
        let unit_of = |k: usize| if k < lengths { unit } else { 1.0 };
        let units: Vec<f64> = (0..problem.dimension()).map(unit_of).collect();
        let root = problem.root::<BigInt>(BITS).ok()?;
        let edge = |(x, unit): (&Interval<BigInt>, &f64)| ends(x).map(|e| e.map(|x| x * unit));
        let root: Vec<[f64; 2]> = root.0.iter().zip(&units).map(edge).collect::<Option<_>>()?;
        let cylinder = match &claim.workspace {
            Workspace::Cylinder { center: [x, y], radius, .. } => {
                Some(([double(x)?, double(y)?], double(radius)?))
            }
            _ => None,
        };
        let requirements = Ends::all(&claim.require);
        Some(Sampler { problem, requirements, parameters, root, units, cylinder })
    }

    /// The machine with every parameter in the middle of its tolerance.
    pub fn nominal(&self) -> Vec<f64> {
        self.parameters.iter().map(|[lo, hi]| lo + (hi - lo) / 2.0).collect()
    }

    /// The machine of a counterexample.
    pub fn machine(&self, values: &[Expression]) -> Option<Vec<f64>> {
        let parameters = self.problem.parameters::<BigInt>(BITS, values).ok()?;
        parameters.iter().map(middle).collect()
    }

    /// Where the parameters that are intervals stand in the claim, and their values.
    pub fn settings(&self, machine: &[f64]) -> Vec<(&str, f64)> {
        let inputs = self.problem.inputs.iter().zip(machine);
        let toleranced = inputs.filter(|(input, _)| is_toleranced(&input.value));
        let unit = |scale: i64| (scale as f64).exp2();
        toleranced.map(|(input, x)| (input.place.as_str(), x * unit(input.scale))).collect()
    }

    /// The requirement that an obligation belongs to.
    pub fn requirement(&self, obligation: usize) -> Option<usize> {
        self.problem.obligations.get(obligation)?.requirement
    }

    /// The problem.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The values at a point, of a machine; `None` outside the workspace, out of reach, and at a
    /// serial singularity.
    pub fn values(&self, machine: &[f64], point: &[f64]) -> Option<Sampled> {
        let problem = &self.problem;
        let values = problem.tape.run(&Doubles, |op| match op {
            Op::Coordinate(k) => Some(point.get(k)? / self.units.get(k)?),
            Op::Parameter(j) => machine.get(j).copied(),
            _ => None,
        });
        let at = At { values, unit: (problem.scale as f64).exp2() };
        if let Some(inside) = &problem.inside {
            at.of(inside.g).filter(|g| *g > -1e-9)?;
        }
        let m = problem.dimension();
        // Rows and columns that there are not are zero, and add zeros to the singular values.
        let mut matrix = SMatrix::<f64, MOST_LEGS, MOST_COORDINATES>::zeros();
        for (i, leg) in problem.legs.iter().enumerate().take(MOST_LEGS) {
            at.of(leg.row.d).filter(|d| *d > 0.0)?;
            for (k, a) in leg.divided.a.iter().enumerate().take(m) {
                matrix[(i, k)] = at.of(*a)?;
            }
        }
        // Of arms, M is an angle per length of the problem.
        let is_angular = problem.legs.iter().any(Leg::is_angular);
        let unit = if is_angular { at.unit } else { 1.0 };
        let mut xi: Vec<f64> = matrix.singular_values().iter().copied().collect();
        xi.sort_by(|a, b| b.total_cmp(a));
        let psi: Vec<f64> = xi.iter().take(m).filter_map(|xi| finite(unit / xi)).collect();
        let is_regular = psi.len() == m;
        let greatest = psi.last().copied().filter(|_| is_regular);
        let mut of: Vec<Option<Found>> = vec![None; self.requirements.len()];
        for obligation in &problem.obligations {
            let Some(number) = obligation.requirement else { continue };
            let Some(ends) = self.requirements.get(number) else { continue };
            let value = match (ends.key.as_str(), obligation.leg) {
                ("transmission", _) if ends.max.is_none() => psi.first().copied(),
                ("transmission", _) => greatest,
                ("conditioning", _) => greatest.zip(psi.first()).map(|(most, least)| most / least),
                ("parallel_margin", _) => at.parallel_margin(&problem.legs),
                (_, leg) => {
                    problem.legs.get(leg.unwrap_or(usize::MAX)).and_then(|l| at.of_leg(ends, l))
                }
            };
            let margin = match (value, &obligation.test) {
                (Some(value), _) => ends.margin(value),
                (None, Test::AtLeast(f)) => at.of(*f),
                _ => None,
            };
            let known = &mut of[number];
            if let Some(margin) = margin.filter(|x| known.is_none_or(|k| *x < k.margin)) {
                *known = Some(Found { value, margin, leg: obligation.leg });
            }
        }
        Some(Sampled { psi, of })
    }

    /// The point of the workspace that is meant by one of its box.
    fn within(&self, mut point: Vec<f64>) -> Vec<f64> {
        for (x, [lo, hi]) in point.iter_mut().zip(&self.root) {
            *x = x.clamp(*lo, *hi);
        }
        if let (Some((centre, radius)), [x, y, ..]) = (self.cylinder, &mut point[..]) {
            let off = (*x - centre[0]).hypot(*y - centre[1]);
            if off > radius {
                let part = radius * (1.0 - 1e-12) / off;
                *x = centre[0] + part * (*x - centre[0]);
                *y = centre[1] + part * (*y - centre[1]);
            }
        }
        point
    }

    /// The middle of the workspace.
    pub fn middle(&self) -> Vec<f64> {
        self.root.iter().map(|[lo, hi]| lo + (hi - lo) / 2.0).collect()
    }

    /// Points over the workspace, corners among them.
    pub fn grid(&self) -> Vec<Vec<f64>> {
        let m = self.root.len();
        let most = POINTS.min(OPERATIONS / self.problem.tape.ops().len().max(1)).max(2);
        let along = (2..=MOST_ALONG).take_while(|n| n.pow(m as u32) <= most).last().unwrap_or(2);
        let point = |i: usize| {
            let part = |k: usize| (i / along.pow(k as u32) % along) as f64 / (along - 1) as f64;
            let edges = self.root.iter().enumerate();
            edges.map(|(k, [lo, hi])| lo + part(k) * (hi - lo)).collect()
        };
        (0..along.pow(m as u32)).map(|i| self.within(point(i))).collect()
    }

    /// The worst of every requirement over a grid, then by steps that shrink, then at the ends of the
    /// tolerances.
    pub fn worst(&self, grid: &[Vec<f64>]) -> Vec<Option<Worst>> {
        let nominal = self.nominal();
        let sampled: Vec<(&Vec<f64>, Sampled)> =
            grid.iter().filter_map(|p| Some((p, self.values(&nominal, p)?))).collect();
        let least = |number: usize| {
            let all = sampled.iter().filter_map(|(p, s)| Some((s.of[number]?.margin, *p)));
            let (_, start) = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(self.refined(number, nominal.clone(), start.clone()))
        };
        (0..self.requirements.len()).map(|number| least(number)?).collect()
    }

    fn refined(&self, number: usize, mut machine: Vec<f64>, start: Vec<f64>) -> Option<Worst> {
        let found = |machine: &[f64], point: &[f64]| {
            self.values(machine, point)?.of.get(number).copied()?
        };
        let mut point = start;
        let mut best = found(&machine, &point)?;
        for _ in 0..2 {
            let mut step = 0.1;
            for _ in 0..MOST_ROUNDS {
                if step <= STEP {
                    break;
                }
                let mut moved = false;
                for k in 0..point.len() {
                    for sign in [-1.0, 1.0] {
                        let mut other = point.clone();
                        other[k] += sign * step * (self.root[k][1] - self.root[k][0]);
                        let other = self.within(other);
                        if let Some(f) = found(&machine, &other).filter(|f| f.margin < best.margin)
                        {
                            (best, point, moved) = (f, other, true);
                        }
                    }
                }
                if !moved {
                    step /= 2.0;
                }
            }
            let inputs = self.problem.inputs.iter().enumerate();
            for (j, _) in inputs.filter(|(_, input)| is_toleranced(&input.value)) {
                for end in self.parameters[j] {
                    let mut other = machine.clone();
                    other[j] = end;
                    if let Some(f) = found(&other, &point).filter(|f| f.margin < best.margin) {
                        (best, machine) = (f, other);
                    }
                }
            }
        }
        Some(Worst { found: best, at: point, machine })
    }
}

fn is_toleranced(value: &Value) -> bool {
    matches!(value, Value::Quantity(Quantity::Between { .. }))
}

/// How many coordinates, the first, are of the position; none where a user named them.
pub fn positions(claim: &MachineClaim) -> Option<usize> {
    match &claim.mechanism {
        Mechanism::Translational(_) | Mechanism::Orthoglide { .. } | Mechanism::Spatial(_) => {
            Some(3)
        }
        Mechanism::Planar(_) => Some(2),
        Mechanism::Spherical(_) => Some(0),
        Mechanism::Formulas(_) => None,
    }
}

/// A machine's formulas at a point.
struct At {
    values: Values<f64>,
    unit: f64,
}

impl At {
    fn of(&self, f: Formula) -> Option<f64> {
        self.values.of(f).copied()
    }

    /// A quantity of a leg, in the claim's unit.
    fn of_leg(&self, ends: &Ends, leg: &Leg) -> Option<f64> {
        let inclination = || {
            let (eta_squared, length) = leg.eta_squared.zip(leg.length)?;
            Some(self.of(eta_squared)?.max(0.0).sqrt() / self.of(length)?)
        };
        match ends.key.as_str() {
            "joint_range" => match leg.rho? {
                Joint::Length(rho) => Some(self.of(rho)? * self.unit),
                Joint::Angle { cos, sin } => {
                    Some(ends.turned(self.of(sin)?.atan2(self.of(cos)?).to_degrees()))
                }
            },
            "joint_speed" => {
                let squares = leg.divided.a.iter().map(|a| self.of(*a).map(|a| a * a));
                let speed = ends.tool? * squares.sum::<Option<f64>>()?.sqrt();
                Some(if leg.is_angular() { (speed / self.unit).to_degrees() } else { speed })
            }
            "serial_margin" => inclination(),
            "leg_angle" => Some(inclination()?.min(1.0).acos().to_degrees()),
            _ => None,
        }
    }

    fn parallel_margin(&self, legs: &[Leg]) -> Option<f64> {
        let n = legs.len();
        let mut unit = Matrix6::identity();
        for (i, leg) in legs.iter().enumerate().filter(|_| n <= MOST_COORDINATES) {
            let length = self.of(leg.length?)?;
            for (k, a) in leg.row.a.iter().enumerate().take(n) {
                unit[(i, k)] = self.of(*a)? / length;
            }
        }
        Some(unit.determinant().abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(mechanism: &str, workspace: &str, require: &[(&str, &str, &str)]) -> MachineClaim {
        let require: Vec<String> = require
            .iter()
            .map(|(key, end, bound)| {
                let given = if *key == "joint_speed" { r#""given":{"tool":["100"]},"# } else { "" };
                format!(r#"{{"quantity":"{key}",{given}"end":"{end}","bound":{bound}}}"#)
            })
            .collect();
        let require = require.join(",");
        let text =
            format!(r#"{{"mechanism":{mechanism},"workspace":{workspace},"require":[{require}]}}"#);
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"))
    }

    /// The Orthoglide with legs of this length, scaled by 8 from the unit of length.
    fn orthoglide(length: &str, require: &[(&str, &str, &str)]) -> MachineClaim {
        let leg = |n: &str| {
            format!(
                r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{length},"mode":"+"}}"#
            )
        };
        let legs = [r#""1","0","0""#, r#""0","1","0""#, r#""0","0","1""#].map(leg).join(",");
        let workspace = r#"{"box":{"min":["-60","-60","-60"],"max":["120","120","120"]}}"#;
        claim(&format!(r#"{{"translational":[{legs}]}}"#), workspace, require)
    }

    /// At `(c, c, c)`, `M = (1 - m) I + m 11^T` with `m = c/sqrt(L^2 - 2 c^2)`.
    #[test]
    fn every_quantity_has_the_value_of_its_definition() {
        let all = [
            ("transmission", "min", r#""0.1""#),
            ("transmission", "max", r#""9""#),
            ("joint_range", "max", r#""0""#),
            ("conditioning", "max", r#""9""#),
            ("serial_margin", "min", r#""0.1""#),
            ("parallel_margin", "min", r#""0.1""#),
            ("leg_angle", "max", r#""80""#),
            ("joint_speed", "max", r#""500""#),
        ];
        let sampler = Sampler::new(&orthoglide(r#""310""#, &all)).unwrap();
        let (c, length) = (100.0, 310.0_f64);
        let s = (length * length - 2.0 * c * c).sqrt();
        let m = c / s;
        let found = sampler.values(&sampler.nominal(), &[c; 3]).unwrap();
        let near = |value: Option<f64>, expected: f64| {
            let value = value.unwrap();
            assert!(
                (value - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                "{value}, {expected}"
            );
        };
        let determinant = (1.0 - m).powi(2) * (1.0 + 2.0 * m) * (s / length).powi(3);
        let expected = [
            1.0 / (1.0 + 2.0 * m),
            1.0 / (1.0 - m),
            c - s,
            (1.0 + 2.0 * m) / (1.0 - m),
            s / length,
            determinant,
            (s / length).acos().to_degrees(),
            100.0 * (1.0 + 2.0 * m * m).sqrt(),
        ];
        for (found, expected) in found.of.iter().zip(expected) {
            near(found.and_then(|found| found.value), expected);
        }
        assert_eq!(found.psi.len(), 3);
        // Out of reach.
        assert!(sampler.values(&sampler.nominal(), &[0.0, 220.0, 220.0]).is_none());
    }

    #[test]
    fn the_worst_is_found_at_its_corner_and_for_its_machine() {
        let tolerance = r#"{"min":"309.9","max":"310.1"}"#;
        let all = [("transmission", "max", r#""2""#), ("joint_range", "min", r#""-500""#)];
        let sampler = Sampler::new(&orthoglide(tolerance, &all)).unwrap();
        let worst = sampler.worst(&sampler.grid());
        let [psi, rho] = &worst[..] else { unreachable!() };
        let (psi, rho) = (psi.as_ref().unwrap(), rho.as_ref().unwrap());
        assert_eq!(psi.at, [120.0; 3]);
        let settings = sampler.settings(&psi.machine);
        assert_eq!(settings.len(), 3);
        assert!(settings.iter().all(|(_, length)| (length - 309.9).abs() < 1e-9), "{settings:?}");
        let m = 120.0 / (309.9_f64 * 309.9 - 2.0 * 120.0 * 120.0).sqrt();
        assert!((psi.found.value.unwrap() - 1.0 / (1.0 - m)).abs() < 1e-9);
        assert!((psi.found.margin - (2.0 - 1.0 / (1.0 - m)) / 2.0).abs() < 1e-9);
        // rho = x - sqrt(L^2 - y^2 - z^2) is least at x = -60, y = z = 0 with the longest leg.
        assert!((rho.found.value.unwrap() - (-60.0 - 310.1)).abs() < 1e-3);
    }

    #[test]
    fn angles_are_in_degrees_and_psi_in_lengths_per_radian() {
        let leg = |x: f64, y: f64| {
            format!(
                r#"{{"drive":"arm","axis":["{}","{x}","0"],"reference":["{x}","{y}","0"],"anchor":["{}","{}","0"],"platform":["{}","{}","0"],"arm":"100","length":"250","mode":"-"}}"#,
                -y,
                80.0 * x,
                80.0 * y,
                30.0 * x,
                30.0 * y
            )
        };
        let legs = [leg(1.0, 0.0), leg(-0.6, 0.8), leg(-0.6, -0.8)].map(|l| l.replace("--", ""));
        let mechanism = format!(r#"{{"translational":[{}]}}"#, legs.join(","));
        let workspace = r#"{"box":{"min":["-5","-5","-240"],"max":["5","5","-230"]}}"#;
        let all = [
            ("transmission", "max", r#""1000""#),
            ("joint_range", "within", r#"["0","170"]"#),
            ("joint_speed", "max", r#""1000""#),
        ];
        let text = claim(&mechanism, workspace, &all);
        let sampler = Sampler::new(&text).unwrap();
        let (machine, at, step) = (sampler.nominal(), [0.0, 0.0, -235.0], 1e-4);
        let value = |at: [f64; 3], i: usize| {
            sampler.values(&machine, &at).unwrap().of[i].unwrap().value.unwrap()
        };
        // By symmetry M maps the z axis to theta_z (1, 1, 1): one psi is 1/(sqrt(3) theta_z).
        let turned = (value([0.0, 0.0, -235.0 + step], 1) - value(at, 1)).abs() / step;
        let found = sampler.values(&machine, &at).unwrap();
        let along = |psi: f64| 180.0 / std::f64::consts::PI * 3f64.sqrt().recip() / psi;
        let nearest = found.psi.iter().map(|psi| (along(*psi) / turned - 1.0).abs());
        assert!(nearest.fold(f64::MAX, f64::min) < 1e-4, "{:?}, {turned}", found.psi);
        assert!(value(at, 2) >= 100.0 * turned * 0.9999);
    }
}
