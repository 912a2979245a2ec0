//! Looking around: approximate values of every obligation at single points and machines.
//!
//! Nothing here is a proof: it gives candidates for refutations and the worst values of reports.

use super::doubles::{middle, pair, Pair, Single};
use super::evidence::BITS;
use super::refute::approximate;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use orthocert_kernel::claim::{MachineClaim, Quantity, Workspace};
use orthocert_kernel::formula::{Formula, Op, Values};
use orthocert_kernel::input::{ClaimError, Value};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;

/// Points of a grid along each coordinate, by their number; beyond, its corners, the middles of its
/// faces and its centre.
const GRID: [usize; 4] = [17, 9, 5, 3];
/// Halvings of the first, coarse descents.
const COARSE: i32 = 7;
/// Axes up to which descents go along diagonals at every step.
const MOST_AXES: usize = 3;
/// Starts of coarse descents.
const STARTS: usize = 3;
/// What starts differ by, at least, in some coordinate.
const APART: f64 = 0.3;
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
    fn part(&mut self, axis: usize) -> &mut f64 {
        let m = self.u.len();
        if axis < m {
            &mut self.u[axis]
        } else {
            &mut self.t[axis - m]
        }
    }
}

/// The greatest difference of coordinates.
fn distance(one: &Place, other: &Place) -> f64 {
    one.u.iter().zip(&other.u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
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

/// A claim's machines in doubles.
pub struct Sampler<'a> {
    problem: &'a Problem,
    claim: &'a MachineClaim,
    /// Of each coordinate its least value and its width, in the problem's unit.
    box_: Vec<(f64, f64)>,
    parameters: Vec<Pair>,
    /// The parameters that are intervals.
    free: Vec<usize>,
    /// Radicands that depend on the point.
    radicands: Vec<Formula>,
    sign: f64,
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
        let free = inputs
            .filter(|(_, input)| matches!(input.value, Value::Quantity(Quantity::Between { .. })));
        let constants: std::collections::HashSet<Formula> =
            problem.tape.constants().into_iter().collect();
        let radicand = |op: &Op| match *op {
            Op::Sqrt(f) if !constants.contains(&f) => Some(f),
            _ => None,
        };
        let mut sampler = Sampler {
            problem,
            claim,
            box_: root.iter().map(edge).collect(),
            parameters: parameters.iter().map(|x| pair(x, BITS)).collect(),
            free: free.map(|(j, _)| j).collect(),
            radicands: problem.tape.ops().iter().filter_map(radicand).collect(),
            sign: 1.0,
        };
        let centre = sampler.at(&sampler.centre());
        sampler.sign = sampler.determinant(&centre).unwrap_or(1.0).signum();
        Ok(sampler)
    }

    /// The middle of the workspace's box and of the tolerances.
    pub fn centre(&self) -> Place {
        Place { u: vec![0.5; self.box_.len()], t: vec![0.5; self.free.len()] }
    }

    /// The parts of the workspace's box that a place stands for: outside a cylinder, those of the point
    /// on its surface on the way to the axis.
    pub fn parts(&self, u: &[f64]) -> Vec<f64> {
        let mut u = u.to_vec();
        match (&self.claim.workspace, &mut u[..]) {
            (Workspace::Cylinder { .. }, [x, y, _]) => {
                let (a, b) = (2.0 * *x - 1.0, 2.0 * *y - 1.0);
                let radius = a.hypot(b);
                if radius > 1.0 {
                    let pull = (1.0 - 1e-12) / radius;
                    (*x, *y) = (0.5 * (a * pull + 1.0), 0.5 * (b * pull + 1.0));
                }
            }
            (Workspace::Box { .. } | Workspace::Cube { .. } | Workspace::Cylinder { .. }, _) => {}
        }
        u
    }

    /// The coordinates of a place in the problem's unit.
    pub fn point(&self, u: &[f64]) -> Vec<f64> {
        let u = self.parts(u);
        self.box_.iter().zip(&u).map(|((least, width), u)| least + width * u).collect()
    }

    /// The same in the claim's unit.
    pub fn shown(&self, u: &[f64]) -> Vec<f64> {
        let unit = self.unit();
        let told = |(x, (_, width)): (f64, &(f64, f64))| {
            // What the search has not told from zero is zero.
            if x.abs() < 1e-7 * width {
                0.0
            } else {
                x * unit
            }
        };
        self.point(u).into_iter().zip(&self.box_).map(told).collect()
    }

    /// The problem's unit of length in the claim's.
    pub fn unit(&self) -> f64 {
        (self.problem.scale as f64).exp2()
    }

    /// The ends of the workspace's box in the claim's unit.
    pub fn ends(&self) -> [Vec<f64>; 2] {
        let unit = self.unit();
        let end = |part: f64| {
            self.box_.iter().map(|(least, width)| (least + part * width) * unit).collect()
        };
        [end(0.0), end(1.0)]
    }

    /// The centre of a box in the problem's unit, with the middle machine.
    pub fn place_in(&self, cell: &[Pair]) -> Place {
        let centre: Vec<f64> = cell.iter().map(middle).collect();
        Place { u: self.parts_of(&centre), t: self.centre().t }
    }

    fn parts_of(&self, point: &[f64]) -> Vec<f64> {
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
        let unit = self.unit();
        let point = point.iter().map(|x| Some(approximate(x)? / unit));
        let u = self.parts_of(&point.collect::<Option<Vec<_>>>()?);
        let part = |(&j, x): (&usize, &Expression)| {
            let (lo, hi) = self.parameters[j];
            let x = approximate(x)? / (self.problem.inputs[j].scale as f64).exp2();
            Some(((x - lo) / (hi - lo)).clamp(0.0, 1.0))
        };
        let t = self.free.iter().zip(machine).map(part).collect::<Option<_>>()?;
        Some(Place { u, t })
    }

    /// The values of all formulas at a place.
    pub fn at(&self, place: &Place) -> Values<f64> {
        let mut parameters: Vec<f64> = self.parameters.iter().map(|x| 0.5 * (x.0 + x.1)).collect();
        for (&j, t) in self.free.iter().zip(&place.t) {
            let (lo, hi) = self.parameters[j];
            parameters[j] = lo + t * (hi - lo);
        }
        self.values(&self.point(&place.u), &parameters)
    }

    fn values(&self, point: &[f64], parameters: &[f64]) -> Values<f64> {
        self.problem.tape.run(&Single, |op| match op {
            Op::Coordinate(k) => point.get(k).copied(),
            Op::Parameter(j) => parameters.get(j).copied(),
            _ => None,
        })
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
    pub fn matrix(&self, values: &Values<f64>) -> Option<DMatrix<f64>> {
        let legs = &self.problem.legs;
        let mut m = DMatrix::zeros(legs.len(), self.box_.len());
        for (i, leg) in legs.iter().enumerate() {
            let d = values.of(leg.row.d).copied().filter(|&d| d > 0.0)?;
            for (k, &a) in leg.row.a.iter().enumerate() {
                m[(i, k)] = values.of(a)? / d.sqrt();
            }
        }
        m.iter().all(|x: &f64| x.is_finite()).then_some(m)
    }

    /// `det M`, of as many rows as coordinates.
    pub fn determinant(&self, values: &Values<f64>) -> Option<f64> {
        let legs = &self.problem.legs;
        if legs.len() != self.box_.len() {
            return None;
        }
        let mut m = DMatrix::zeros(legs.len(), legs.len());
        for (i, leg) in legs.iter().enumerate() {
            for (k, &a) in leg.divided.a.iter().enumerate() {
                m[(i, k)] = *values.of(a)?;
            }
        }
        Some(m.determinant())
    }

    /// The least and the greatest singular value of `M`.
    pub fn xi(&self, values: &Values<f64>) -> Option<[f64; 2]> {
        let xi = self.matrix(values)?.singular_values();
        Some([xi.min(), xi.max()])
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
    pub fn margin(&self, quality: Quality, values: &Values<f64>) -> f64 {
        let reach = || {
            let all = self.radicands.iter().filter_map(|&f| values.of(f));
            all.copied().fold(f64::INFINITY, f64::min)
        };
        let margin = match quality {
            Quality::Reach => Some(reach()),
            Quality::Determinant => self.determinant(values).map(|det| self.sign * det),
            Quality::Obligation(number) => {
                self.margin_of(self.problem.obligations[number].test, values)
            }
        };
        margin.filter(|x| !x.is_nan()).unwrap_or_else(|| reach().min(0.0) - UNDEFINED)
    }

    fn margin_of(&self, test: Test, values: &Values<f64>) -> Option<f64> {
        let root = |f: Formula| Some(values.of(f)?.max(0.0).sqrt());
        Some(match test {
            Test::SigmaMin(kappa) => {
                let ([xi, _], kappa) = (self.xi(values)?, root(kappa)?);
                if kappa > 0.0 {
                    xi / kappa - 1.0
                } else {
                    xi
                }
            }
            Test::SigmaMax(k) => 1.0 - self.xi(values)?[1] / root(k)?,
            Test::Conditioning(c) => {
                let [least, greatest] = self.xi(values)?;
                1.0 - greatest / least / root(c)?
            }
            Test::AtLeast(f) => *values.of(f)?,
            Test::Beyond(f, b) => values.of(f)?.abs() - values.of(b)?,
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

    /// The place near `start` at which a quality has its least margin, down to steps of `2^-finest` of
    /// the workspace: a compass search for the point, and for the machine first the tolerances' ends.
    pub fn descend(&self, quality: Quality, start: &Place, finest: i32) -> Worst {
        let (m, p) = (self.box_.len(), self.free.len());
        let margin = self.margin(quality, &self.at(start));
        let mut worst = Worst { quality, place: start.clone(), margin };
        self.to_ends(&mut worst);
        self.compass(&mut worst, 0..m, 1..=COARSE.min(finest));
        if p > 0 {
            self.to_ends(&mut worst);
            self.compass(&mut worst, m..m + p, 2..=COARSE.min(finest));
            self.compass(&mut worst, 0..m, 4..=COARSE.min(finest));
        }
        self.compass(&mut worst, 0..m, COARSE + 1..=finest);
        if p > 0 && self.to_ends(&mut worst) {
            self.compass(&mut worst, 0..m, 4..=finest);
        }
        worst
    }

    /// Takes the place at these parts if it is worse than the worst known.
    fn considered(&self, worst: &mut Worst, parts: &[(usize, f64)]) -> bool {
        let mut place = worst.place.clone();
        for &(axis, part) in parts {
            *place.part(axis) = part.clamp(0.0, 1.0);
        }
        if place == worst.place {
            return false;
        }
        let margin = self.margin(worst.quality, &self.at(&place));
        let worse = margin < worst.margin;
        if worse {
            (worst.place, worst.margin) = (place, margin);
        }
        worse
    }

    fn stepped(&self, worst: &mut Worst, steps: &[(usize, f64)]) -> bool {
        let parts: Vec<(usize, f64)> =
            steps.iter().map(|&(axis, step)| (axis, *worst.place.part(axis) + step)).collect();
        self.considered(worst, &parts)
    }

    fn to_ends(&self, worst: &mut Worst) -> bool {
        let m = self.box_.len();
        let axes = m..m + self.free.len();
        let ends = axes.flat_map(|axis| [(axis, 0.0), (axis, 1.0)]);
        ends.fold(false, |moved, (axis, end)| self.considered(worst, &[(axis, end)]) || moved)
    }

    /// Steps along the axes, and, where all of them are up, along the diagonals of pairs.
    fn compass(
        &self,
        worst: &mut Worst,
        axes: std::ops::Range<usize>,
        exponents: std::ops::RangeInclusive<i32>,
    ) {
        // Their number is the square of the axes'.
        let few = axes.len() <= MOST_AXES;
        let of_points = axes.start < self.box_.len();
        let diagonal = |exponent: i32| few || of_points && exponent <= COARSE;
        for exponent in exponents {
            let step = f64::from(-exponent).exp2();
            // A few rounds a step: the next, finer one takes over what is left.
            for _ in 0..4 {
                let mut moved = false;
                for axis in axes.clone() {
                    for signed in [step, -step] {
                        moved |= self.stepped(worst, &[(axis, signed)]);
                    }
                }
                let pairs = axes.clone().flat_map(|i| (axes.start..i).map(move |j| (i, j)));
                for (i, j) in pairs.filter(|_| diagonal(exponent)) {
                    for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                        moved = moved || self.stepped(worst, &[(i, a * step), (j, b * step)]);
                    }
                }
                if !moved {
                    break;
                }
            }
        }
    }

    /// The worst place found of every quality, from the worst points of the grid.
    pub fn worst_values(&self, finest: i32) -> Vec<Worst> {
        let grid: Vec<_> = self.grid().into_iter().map(|p| (self.at(&p), p)).collect();
        let worst = |quality| {
            let mut starts: Vec<(f64, &Place)> =
                grid.iter().map(|(values, p)| (self.margin(quality, values), p)).collect();
            starts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut apart: Vec<&Place> = Vec::new();
            for (_, start) in starts {
                if apart.len() < STARTS && apart.iter().all(|other| distance(other, start) > APART)
                {
                    apart.push(start);
                }
            }
            let coarse = apart.into_iter().map(|start| self.descend(quality, start, COARSE));
            let mut worst = coarse.min_by(|a, b| a.margin.total_cmp(&b.margin))?;
            self.compass(&mut worst, 0..self.box_.len(), COARSE + 1..=finest);
            Some(worst)
        };
        self.qualities().into_iter().filter_map(worst).collect()
    }
}
