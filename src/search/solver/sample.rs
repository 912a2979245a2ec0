//! Looking around: approximate values of every obligation at single points and machines.
//!
//! Nothing here is a proof: it gives candidates for refutations and the worst values of reports.

use super::doubles::{middle, pair, Pair, Single};
use super::evidence::BITS;
use super::needed::needed;
use super::program::{Input, Program};
use super::refute::approximate;
use super::violation;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use orthocert_kernel::claim::{MachineClaim, Orientation, Quantity, Workspace};
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::input::{self, ClaimError, Value};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, Test};
use orthocert_kernel::test::accuracy::Accuracy;

/// Points of a grid along each coordinate, by their number; beyond, its corners, the middles of its
/// faces and its centre.
const GRID: [usize; 4] = [17, 9, 5, 3];
/// What is left to the edge of a curved set by a place that is pulled back into it.
const PULL: f64 = 1.0 - 1e-12;
/// Added to margins where something is not defined: worse than wherever all is.
const UNDEFINED: f64 = 1e3;

/// A point of the workspace and a machine, each as parts in `[0, 1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Of the workspace's box.
    pub u: Vec<f64>,
    /// Of the tolerances, in the claim's order.
    pub t: Vec<f64>,
}

impl Place {
    pub(super) fn part(&mut self, axis: usize) -> &mut f64 {
        let m = self.u.len();
        if axis < m {
            &mut self.u[axis]
        } else {
            &mut self.t[axis - m]
        }
    }
}

/// What is looked for at its worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// The least radicand: legs reach where it is positive.
    Reach,
    /// `det M`, of the sign that it has at the centre.
    Determinant,
    /// An obligation, by its number.
    Obligation(usize),
}

/// The worst place found of a quality.
#[derive(Clone, Debug)]
pub struct Worst {
    /// Which one.
    pub quality: Quality,
    /// The place.
    pub place: Place,
    /// Negative where it is violated.
    pub margin: f64,
}

/// The formulas of a machine at a point.
pub struct At<'a> {
    program: &'a Program<f64>,
    own: Vec<f64>,
    /// Those of the machine in the middle of the tolerances, with the same names of an atlas, where they are needed.
    nominal: Option<Vec<f64>>,
}

impl At<'_> {
    /// The value of a formula; `None` where it is undefined.
    pub fn of(&self, formula: Formula) -> Option<f64> {
        self.among(&self.own, formula)
    }

    /// That of the machine in the middle of the tolerances, where obligations are about it.
    pub fn nominal(&self, formula: Formula) -> Option<f64> {
        self.among(self.nominal.as_ref()?, formula)
    }

    fn among(&self, values: &[f64], formula: Formula) -> Option<f64> {
        let value = self.program.at(values, self.program.slot(formula)?)?;
        Some(*value).filter(|x| !x.is_nan())
    }
}

/// A claim's machines in doubles.
pub struct Sampler<'a> {
    problem: &'a Problem,
    claim: &'a MachineClaim,
    /// Of each coordinate its least value and its width, in the problem's unit.
    pub(super) box_: Vec<(f64, f64)>,
    parameters: Vec<Pair>,
    /// All formulas.
    program: Program<f64>,
    /// The parameters that are intervals; over a cell of an atlas also those that vary by themselves.
    pub(super) free: Vec<usize>,
    /// The widths of their tolerances: 0 of what varies by itself.
    tolerances: Vec<f64>,
    /// Radicands that depend on the point.
    radicands: Vec<Formula>,
    /// The formulas that each quality needs.
    needed: Vec<(Quality, Program<f64>)>,
    sign: f64,
}

/// Moves parts in `[0, 1]` toward their middle to a distance of at most `radius`, of which 1 is that of
/// the ends.
fn pull_back<const N: usize>(parts: [&mut f64; N], radius: f64) {
    let norm = parts.iter().map(|x| (2.0 * **x - 1.0).powi(2)).sum::<f64>().sqrt();
    if norm > radius {
        let pull = PULL * radius / norm;
        parts.into_iter().for_each(|x| *x = 0.5 * ((2.0 * *x - 1.0) * pull + 1.0));
    }
}

impl<'a> Sampler<'a> {
    /// For a claim and its problem.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(claim: &'a MachineClaim, problem: &'a Problem) -> Result<Self, ClaimError> {
        let parameters = problem.parameters::<BigInt>(BITS, &[])?;
        let root = problem.root::<BigInt>(BITS)?.0;
        let edge = |x| {
            let (lo, hi) = pair(x, BITS);
            (lo, hi - lo)
        };
        let inputs = problem.inputs.iter().enumerate();
        let free = inputs.filter(|(_, input)| input.has_two_ends() || input.varies());
        let m = problem.dimension();
        let constants: std::collections::HashSet<Formula> =
            problem.tape.constants().into_iter().collect();
        let radicand = |op: &Op| match *op {
            Op::Sqrt(f) if !constants.contains(&f) => Some(f),
            _ => None,
        };
        let parameters: Vec<Pair> = parameters.iter().map(|x| pair(x, BITS)).collect();
        let free: Vec<usize> = free.map(|(j, _)| j).collect();
        let program = |needed: Option<&[bool]>| {
            Program::new(&problem.tape, needed, Single, |op| match op {
                Op::Coordinate(k) => Some(Input::Varying(k)),
                Op::Parameter(j) if free.contains(&j) => Some(Input::Varying(m + j)),
                Op::Parameter(j) => Some(Input::Constant(middle(parameters.get(j)?))),
                _ => None,
            })
        };
        let tolerance = |&j: &usize| {
            let input = &problem.inputs[j];
            let Some(width) = input.width() else { return 0.0 };
            let value = Value::Quantity(Quantity::Exactly(width));
            let width = input::Input { value, ..input.clone() }.enclose(BITS, None);
            width.map_or(parameters[j].1 - parameters[j].0, |width| middle(&pair(&width, BITS)))
        };
        let tolerances = free.iter().map(tolerance).collect();
        let radicands = problem.tape.ops().iter().filter_map(radicand).collect();
        let mut sampler = Sampler {
            problem,
            claim,
            box_: root.iter().map(edge).collect(),
            program: program(None),
            radicands,
            needed: Vec::new(),
            sign: 1.0,
            parameters: parameters.clone(),
            free: free.clone(),
            tolerances,
        };
        let needed = needed(problem, &sampler.radicands, &sampler.qualities()).into_iter();
        sampler.needed = needed.map(|(own, needed)| (own, program(Some(&needed)))).collect();
        let centre = sampler.at(&sampler.centre());
        sampler.sign = sampler.determinant(&centre).unwrap_or(1.0).signum();
        Ok(sampler)
    }

    /// The claim.
    pub fn claim(&self) -> &MachineClaim {
        self.claim
    }

    /// The middle of the workspace's box and of the tolerances.
    pub fn centre(&self) -> Place {
        Place { u: vec![0.5; self.box_.len()], t: vec![0.5; self.frees()] }
    }

    /// In how many ways machines differ.
    pub(super) fn frees(&self) -> usize {
        self.free.len()
    }

    /// What part of all values of a free parameter its tolerance is, of one design.
    pub(super) fn tolerance_of(&self, free: usize) -> f64 {
        let (lo, hi) = self.parameters[self.free[free]];
        let width = self.tolerances[free];
        if width < hi - lo {
            width / (hi - lo)
        } else {
            1.0
        }
    }

    /// The parts of the workspace's box that a place stands for: outside a cylinder, those of the point
    /// on its surface on the way to the axis.
    pub fn parts(&self, u: &[f64]) -> Vec<f64> {
        let mut u = u.to_vec();
        let (places, turns) = u.split_at_mut(self.lengths());
        match (&self.claim.workspace, places) {
            (Workspace::Cylinder { .. }, [x, y, _]) => pull_back([x, y], 1.0),
            (Workspace::Box { .. } | Workspace::Cube { .. } | Workspace::Cylinder { .. }, _) => {}
        }
        match (&self.claim.orientation, turns) {
            (Some(Orientation::Angle(_)), [x, y, z]) => pull_back([x, y, z], 1.0),
            // c_1^2 + c_2^2 <= t^2 (1 + c_3^2), in a box of half-widths t sqrt(1 + s^2) and s.
            (Some(Orientation::Tilt { .. }), [x, y, z]) => {
                let s = 0.5 * self.box_.last().map_or(0.0, |edge| edge.1);
                let c = s * (2.0 * *z - 1.0);
                pull_back([x, y], ((1.0 + c * c) / (1.0 + s * s)).sqrt());
            }
            _ => {}
        }
        u
    }

    /// How many coordinates are lengths; those of orientation come after them.
    pub fn lengths(&self) -> usize {
        self.problem.corners[0].len()
    }

    /// The coordinates of a place in the problem's unit.
    pub fn point(&self, u: &[f64]) -> Vec<f64> {
        let u = self.parts(u);
        self.box_.iter().zip(&u).map(|((least, width), u)| least + width * u).collect()
    }

    /// The same in the claim's unit.
    pub fn shown(&self, u: &[f64]) -> Vec<f64> {
        let told = |(k, (x, (_, width))): (usize, (f64, &(f64, f64)))| {
            // What the search has not told from zero is zero.
            if x.abs() < 1e-6 * width {
                0.0
            } else {
                x * self.unit_of(k)
            }
        };
        self.point(u).into_iter().zip(&self.box_).enumerate().map(told).collect()
    }

    /// The problem's unit of length in the claim's.
    pub fn unit(&self) -> f64 {
        (self.problem.scale as f64).exp2()
    }

    /// That of coordinate `k`; coordinates of orientation have none.
    pub fn unit_of(&self, k: usize) -> f64 {
        if k < self.lengths() {
            self.unit()
        } else {
            1.0
        }
    }

    /// The ends of the workspace's box in the claim's unit.
    pub fn ends(&self) -> [Vec<f64>; 2] {
        let end = |part: f64| {
            let edges = self.box_.iter().enumerate();
            edges.map(|(k, (least, width))| (least + part * width) * self.unit_of(k)).collect()
        };
        [end(0.0), end(1.0)]
    }

    /// The centre of a box in the problem's unit, with the middle machine.
    pub fn place_in(&self, cell: &[Pair]) -> Place {
        let centre: Vec<f64> = cell.iter().map(middle).collect();
        Place { u: self.parts_of(&centre), t: self.centre().t }
    }

    /// The parts of the workspace's box nearest to a point in the problem's unit.
    pub fn parts_of(&self, point: &[f64]) -> Vec<f64> {
        let part = |(x, &(least, width)): (&f64, &(f64, f64))| {
            if width > 0.0 {
                ((x - least) / width).clamp(0.0, 1.0)
            } else {
                0.5
            }
        };
        point.iter().zip(&self.box_).map(part).collect()
    }

    /// The place of a witness.
    pub fn place_of(&self, point: &[Expression], machine: &[Expression]) -> Option<Place> {
        let point = point.iter().enumerate();
        let point = point.map(|(k, x)| Some(approximate(x)? / self.unit_of(k)));
        let u = self.parts_of(&point.collect::<Option<Vec<_>>>()?);
        let part = |(&j, x): (&usize, &Expression)| {
            let (lo, hi) = self.parameters[j];
            let x = approximate(x)? / (self.problem.inputs[j].scale as f64).exp2();
            // Ends that are one double are one machine.
            Some(if lo < hi { ((x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.5 })
        };
        let t = self.free.iter().zip(machine).map(part).collect::<Option<_>>()?;
        Some(Place { u, t })
    }

    /// The values of all formulas at a place.
    pub fn at(&self, place: &Place) -> At<'_> {
        let is_accuracy = |o: &Obligation| matches!(o.test, Test::Accuracy(_));
        self.at_program(place, &self.program, self.problem.obligations.iter().any(is_accuracy))
    }

    /// The values of some at a place, also for the middle machine where that is asked for.
    fn at_program<'s>(&self, place: &Place, program: &'s Program<f64>, nominal: bool) -> At<'s> {
        let mut inputs = self.inputs(&self.point(&place.u));
        let m = self.box_.len();
        let mut less = |part: f64| {
            for ((&j, t), width) in self.free.iter().zip(&place.t).zip(&self.tolerances) {
                let (lo, hi) = self.parameters[j];
                inputs[m + j] = lo + t * (hi - lo) - part * (t - 0.5) * width;
            }
            program.run(|k| inputs[k])
        };
        let nominal = nominal.then(|| less(1.0));
        At { program, own: less(0.0), nominal }
    }

    /// The same at a point in the problem's unit, wherever it is, of the middle machine.
    pub fn at_point(&self, point: &[f64]) -> At<'_> {
        let inputs = self.inputs(point);
        let own = self.program.run(|k| inputs[k]);
        At { program: &self.program, nominal: Some(own.clone()), own }
    }

    /// What formulas are run with, of the middle machine.
    fn inputs(&self, point: &[f64]) -> Vec<f64> {
        point.iter().copied().chain(self.parameters.iter().map(middle)).collect()
    }

    /// The machine of a place: the values of the quantities that are intervals.
    pub fn machine(&self, place: &Place) -> Vec<f64> {
        let value = |(&j, t): (&usize, &f64)| {
            let (lo, hi) = self.parameters[j];
            (lo + t * (hi - lo)) * (self.problem.inputs[j].scale as f64).exp2()
        };
        self.free.iter().zip(&place.t).map(value).collect()
    }

    /// `M`, where all of it is defined.
    pub fn matrix(&self, values: &At) -> Option<DMatrix<f64>> {
        violation::divided(values, self.problem.legs.iter().map(|leg| &leg.row))
    }

    /// `det M`, of as many rows as coordinates.
    pub fn determinant(&self, values: &At) -> Option<f64> {
        self.jacobian(values).map(|m| m.determinant())
    }

    /// `M` with its signs, of as many rows as coordinates.
    pub fn jacobian(&self, values: &At) -> Option<DMatrix<f64>> {
        let legs = &self.problem.legs;
        if legs.len() != self.box_.len() {
            return None;
        }
        let mut m = DMatrix::zeros(legs.len(), legs.len());
        for (i, leg) in legs.iter().enumerate() {
            for (k, &a) in leg.divided.a.iter().enumerate() {
                m[(i, k)] = values.of(a)?;
            }
        }
        Some(m)
    }

    /// The least and the greatest singular value of `M`.
    pub fn xi(&self, values: &At) -> Option<[f64; 2]> {
        Some(violation::extremes(self.matrix(values)?))
    }

    /// What is asked for: reach and freedom from singularities, and every obligation.
    pub fn qualities(&self) -> Vec<Quality> {
        let square = self.problem.legs.len() == self.box_.len();
        let mut all = Vec::new();
        all.extend((!self.radicands.is_empty()).then_some(Quality::Reach));
        all.extend(square.then_some(Quality::Determinant));
        let obligations = self.problem.obligations.iter().enumerate();
        let asked = obligations.filter(|(_, o)| o.requirement.is_some() || !square);
        all.extend(asked.map(|(number, _)| Quality::Obligation(number)));
        all
    }

    /// How far a quality is from being violated: negative where it is.
    pub fn margin(&self, quality: Quality, values: &At) -> f64 {
        self.defined(quality, values)
            .unwrap_or_else(|| self.least_radicand(values).min(0.0) - UNDEFINED)
    }

    /// The test of an accuracy.
    pub(super) fn accuracy(&self, quality: Quality) -> Option<&'a Accuracy> {
        let Quality::Obligation(number) = quality else { return None };
        match &self.problem.obligations[number].test {
            Test::Accuracy(test) => Some(test),
            _ => None,
        }
    }

    /// The problem.
    pub(super) fn problem(&self) -> &'a Problem {
        self.problem
    }

    /// What a quality needs at a place.
    pub(super) fn at_machine(&self, quality: Quality, place: &Place) -> At<'_> {
        let needed = self.needed.iter().find(|(own, _)| *own == quality);
        let program = needed.map_or(&self.program, |(_, program)| program);
        self.at_program(place, program, self.accuracy(quality).is_some())
    }

    /// The same at a place, of what it needs alone.
    pub fn margin_at(&self, quality: Quality, place: &Place) -> f64 {
        let values = self.at_machine(quality, place);
        self.defined(quality, &values).unwrap_or_else(|| self.margin(quality, &self.at(place)))
    }

    fn least_radicand(&self, values: &At) -> f64 {
        let all = self.radicands.iter().filter_map(|&f| values.of(f));
        all.fold(f64::INFINITY, f64::min)
    }

    fn defined(&self, quality: Quality, values: &At) -> Option<f64> {
        let margin = match quality {
            Quality::Reach => Some(self.least_radicand(values)),
            Quality::Determinant => self.determinant(values).map(|det| self.sign * det),
            Quality::Obligation(number) => {
                self.margin_of(&self.problem.obligations[number].test, values)
            }
        };
        margin.filter(|x| !x.is_nan())
    }

    fn margin_of(&self, test: &Test, values: &At) -> Option<f64> {
        let root = |f: &Formula| Some(values.of(*f)?.max(0.0).sqrt());
        let beyond = |xi: f64, kappa: f64| if kappa > 0.0 { xi / kappa - 1.0 } else { xi };
        Some(match test {
            Test::SigmaMin(kappa) => beyond(self.xi(values)?[0], root(kappa)?),
            Test::SigmaMax(k) => 1.0 - self.xi(values)?[1] / root(k)?,
            Test::Conditioning(c) => {
                let [least, greatest] = self.xi(values)?;
                1.0 - greatest / least / root(c)?
            }
            Test::AtLeast(f) => values.of(*f)?,
            // Whatever both are multiples of, as determinants are.
            Test::Beyond(f, b) => {
                let (f, b) = (values.of(*f)?.abs(), values.of(*b)?);
                let size = f.max(b.abs());
                if size > 0.0 {
                    (f - b) / size
                } else {
                    0.0
                }
            }
            Test::Least(rows, kappa) => {
                let xi = violation::divided(values, rows.iter())?.singular_values();
                beyond(xi.min(), root(kappa)?)
            }
            Test::Greatest(rows, k) => {
                let xi = violation::divided(values, rows.iter())?.singular_values();
                1.0 - xi.max() / root(k)?
            }
            // Of two points; what is told of one is how far it is from a singularity.
            Test::OneToOne(_) => self.xi(values)?[0],
            Test::Solve(solve) => {
                let z = violation::solved(values, &self.problem.legs, solve)?;
                1.0 - z.norm() * root(&solve.square)?
            }
            Test::Accuracy(test) => {
                let u = violation::displaced(values, &self.problem.legs, test)?;
                1.0 - violation::part(&u, test).norm()
            }
            Test::Apart(test) => {
                let (_, between) = violation::between(values, test)?;
                between.norm() / values.of(test.distance)? - 1.0
            }
            Test::Curvature(test) => 1.0 - violation::curved(test, |f| values.of(f))?.0,
        })
    }

    /// Points spread over the workspace, with the middle machine.
    pub fn grid(&self) -> Vec<Place> {
        let m = self.box_.len();
        let centre = self.centre();
        let with = |u: Vec<f64>| Place { u, ..centre.clone() };
        if let Some(&points) = m.checked_sub(1).and_then(|m| GRID.get(m)) {
            let digit =
                |i: usize, k: u32| (i / points.pow(k) % points) as f64 / (points - 1) as f64;
            let all = 0..points.pow(m as u32);
            return all.map(|i| with((0..m as u32).map(|k| digit(i, k)).collect())).collect();
        }
        let corners = (0..1usize << m).map(|i| (0..m).map(|k| (i >> k & 1) as f64).collect());
        let faces = (0..2 * m)
            .map(|i| (0..m).map(|k| if k == i / 2 { (i % 2) as f64 } else { 0.5 }).collect());
        corners.chain(faces).map(with).chain([centre.clone()]).collect()
    }
}
