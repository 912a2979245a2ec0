//! Random machines with what is true of them at a point, claims that hold or fail there by a given
//! margin, and evidence that might prove them.

use super::random::Random;
use super::truth::{self, determinant, dot, exact, scale, Leg, State, V};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{Direction, LegNumber, TwoDirections, Violation};
use orthocert_checker::claim::{
    AtLeast, AtMost, JointSpeed, MachineClaim, Mechanism, Quantity, Range, Requirements, Sign,
    Workspace,
};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::Model;
use orthocert_checker::rule::{self, Mu, Rotation};
use std::array::from_fn;
use std::collections::BTreeMap;

/// A machine and a point, and what is true there.
pub struct Case {
    pub legs: [Leg; 3],
    pub p: V,
    pub states: [State; 3],
    /// Ascending singular values of `M`.
    pub sigma: V,
    /// Right singular vectors.
    pub vectors: [V; 3],
    /// `|det U|`.
    pub det: f64,
    /// A factor that lengths were multiplied by.
    pub unit: f64,
}

impl Case {
    /// A random one, at a distance from singularities that leaves doubles eight good digits.
    pub fn random(random: &mut Random) -> Case {
        loop {
            let margin = if random.coin() { 0.1 } else { 1e-3 };
            let (legs, p) = truth::machine(random, margin);
            let unit = if random.coin() { 1.0 } else { (random.below(61) as f64 - 30.0).exp2() };
            let (legs, p) = (legs.map(|leg| leg.scaled(unit)), scale(unit, p));
            if let Some(case) = Case::at(legs, p, unit) {
                return case;
            }
        }
    }

    /// The machine at a point that it reaches; none too near a parallel singularity.
    pub fn at(legs: [Leg; 3], p: V, unit: f64) -> Option<Case> {
        let states = legs.map(|leg| leg.at(p));
        let (sigma, vectors) = truth::singular(&states.map(|s| s.row));
        let det = determinant(&states.map(|s| s.unit)).abs();
        let condition = sigma[2] / sigma[0];
        let regular = 1.001 < condition && condition < 1e3 && det > 1e-4;
        regular.then_some(Case { legs, p, states, sigma, vectors, det, unit })
    }

    /// Requirements that hold at the point with relative room `slack`, or are violated by
    /// `-slack`; of the joint ranges, the given end of the given leg.
    pub fn requirements(&self, slack: f64, leg: usize, at_min: bool) -> Requirements {
        let angular = matches!(self.legs[0], Leg::Arm { .. });
        let at_most = |x: f64| Some(AtMost { max: exact(x) });
        let at_least = |x: f64| Some(AtLeast { min: exact(x) });
        let size = if angular { 50.0 } else { self.unit };
        let joint_range = from_fn(|i| {
            let rho = self.states[i].rho;
            let tight = |end: bool| if (leg, at_min) == (i, end) { slack } else { 0.25 };
            let (min, max) = (rho - tight(true) * size, rho + tight(false) * size);
            // Of lengths, one end will do.
            let both = angular || leg != i;
            Range {
                min: (both || at_min).then(|| exact(min)),
                max: (both || !at_min).then(|| exact(max)),
            }
        });
        let cosines: Option<Vec<f64>> = self.states.iter().map(|s| s.cosine).collect();
        let least_cosine = cosines.map(|c| c.iter().copied().fold(1.0, f64::min));
        let guided = self.legs.iter().all(|leg| matches!(leg, Leg::Slider { .. }));
        let angle = least_cosine.filter(|_| guided).map(|c| c.acos().to_degrees() * (1.0 + slack));
        let speed = self.states.iter().map(|s| dot(s.row, s.row).sqrt()).fold(0.0, f64::max);
        let speed = if angular { speed.to_degrees() } else { speed };
        Requirements {
            transmission: Some(Range {
                min: Some(exact((1.0 - slack) / self.sigma[2])),
                max: Some(exact((1.0 + slack) / self.sigma[0])),
            }),
            joint_range: Some(joint_range),
            conditioning: at_most(self.sigma[2] / self.sigma[0] * (1.0 + slack)),
            serial_margin: least_cosine.and_then(|c| at_least(c * (1.0 - slack))),
            parallel_margin: at_least(self.det * (1.0 - slack)),
            leg_angle: angle.filter(|a| (0.1..=90.0).contains(a)).and_then(at_most),
            joint_speed: Some(JointSpeed { tool: exact(1.0), max: exact(speed * (1.0 + slack)) }),
        }
    }

    pub fn claim(&self, workspace: Workspace, requirements: Requirements) -> MachineClaim {
        let mechanism = Mechanism::Translational(self.legs.map(|leg| leg.claimed()));
        MachineClaim { mechanism, workspace, requirements }
    }

    /// Rotations that may serve as evidence: the best one, and others.
    pub fn rotations(&self, random: &mut Random) -> Vec<Rotation> {
        let m = self.states.map(|s| scale(1.0 / self.sigma[2], s.row));
        let sign = if determinant(&m) > 0.0 { Sign::Plus } else { Sign::Minus };
        let factor = if sign == Sign::Plus { 1.0 } else { -1.0 };
        let w = truth::rotation(&m).map(|row| scale(factor, row));
        let any: [i64; 4] = from_fn(|_| random.below(2000) as i64 - 1000);
        vec![Rotation { q: quaternion(&w), sign }, Rotation { q: any, sign }]
    }

    /// Affine functions that may serve as evidence, near what `sigma_min` allows.
    pub fn mus(&self, random: &mut Random) -> Vec<Mu> {
        // In the model's unit: for arms, rates are per length.
        let model = self.model_sigma_min();
        let near = |x: f64| (x * 2f64.powi(40)) as i64;
        let mut tilted = [near(model * 0.999), 0, 0, 0];
        for m in &mut tilted[1..] {
            *m = near(model * random.between(-0.01, 0.01));
        }
        let constant = |part: f64| [near(model * part), 0, 0, 0];
        vec![constant(1.0), constant(1.0 - 1e-7), constant(0.999), tilted]
    }

    fn model_sigma_min(&self) -> f64 {
        let w = |i: usize| {
            let claim = self.claim(
                Workspace::Box { min: self.p.map(exact), max: self.p.map(exact) },
                Requirements::default(),
            );
            let model = Model::new(&claim, 128).ok()?;
            Some(model.legs[i].at(&model.origin[i])?.row.map(|x| middle(&x)))
        };
        let rows = [w(0), w(1), w(2)].map(|row| row.expect("within reach"));
        truth::singular(&rows).0[0]
    }

    /// What should refute a claim that is violated at the point.
    pub fn violations(&self, claim: &MachineClaim, leg: usize) -> Vec<Violation> {
        let vector = |v: V| v.map(|x| (x * 2f64.powi(30)).round() as i64);
        let number = |leg: usize| LegNumber { leg: leg + 1 };
        let worst = |value: &dyn Fn(&State) -> f64| {
            (0..3).max_by(|&a, &b| value(&self.states[a]).total_cmp(&value(&self.states[b])))
        };
        let oblique = worst(&|s| -s.cosine.unwrap_or(1.0)).unwrap_or(0);
        let fastest = worst(&|s| dot(s.row, s.row)).unwrap_or(0);
        let [least, _, greatest] = self.vectors.map(vector);
        let mut violations = vec![
            Violation::SigmaMin(Direction { vector: least }),
            Violation::SigmaMax(Direction { vector: greatest }),
            Violation::Conditioning(TwoDirections { u: greatest, v: least }),
            Violation::JointRange(number(leg)),
            Violation::ParallelMargin,
            Violation::JointSpeed(number(fastest)),
        ];
        if claim.requirements.serial_margin.is_some() {
            violations.push(Violation::SerialMargin(number(oblique)));
        }
        if claim.requirements.leg_angle.is_some() {
            violations.push(Violation::LegAngle(number(oblique)));
        }
        violations
    }
}

fn middle(x: &Fixed) -> f64 {
    let as_f64 = |x: BigRational| {
        let shifted: BigInt = (x * BigRational::from_integer(BigInt::from(1) << 80)).to_integer();
        shifted.to_string().parse::<f64>().expect("digits") * (-80f64).exp2()
    };
    (as_f64(x.inf()) + as_f64(x.sup())) / 2.0
}

/// The quaternion of a rotation, in integers.
fn quaternion(r: &[V; 3]) -> [i64; 4] {
    let four_squares = [
        1.0 + r[0][0] + r[1][1] + r[2][2],
        1.0 + r[0][0] - r[1][1] - r[2][2],
        1.0 - r[0][0] + r[1][1] - r[2][2],
        1.0 - r[0][0] - r[1][1] + r[2][2],
    ];
    let products = [
        [four_squares[0], r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]],
        [r[2][1] - r[1][2], four_squares[1], r[1][0] + r[0][1], r[0][2] + r[2][0]],
        [r[0][2] - r[2][0], r[1][0] + r[0][1], four_squares[2], r[2][1] + r[1][2]],
        [r[1][0] - r[0][1], r[0][2] + r[2][0], r[2][1] + r[1][2], four_squares[3]],
    ];
    let largest = (0..4).max_by(|&a, &b| four_squares[a].total_cmp(&four_squares[b])).unwrap_or(0);
    let q = products[largest];
    let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| (x / size * f64::from(1 << 19)).round() as i64)
}

/// A box or cylinder around the point, at times with the point on its surface, and its bounding
/// box.
pub fn workspace(random: &mut Random, p: V, unit: f64) -> (Workspace, V, V) {
    let size = (-(random.below(12) as f64)).exp2();
    let mut side = || scale(unit, from_fn(|_| random.between(0.0, size)));
    let (below, above) = (side(), side());
    let mut min: V = from_fn(|k| p[k] - below[k]);
    let mut max: V = from_fn(|k| p[k] + above[k]);
    for k in 0..3 {
        match random.below(6) {
            0 => min[k] = p[k],
            1 => max[k] = p[k],
            _ => {}
        }
    }
    if random.coin() || below[0] + below[1] + above[0] == 0.0 {
        return (Workspace::Box { min: min.map(exact), max: max.map(exact) }, min, max);
    }
    // |below[0]| + |below[1]| is at least the distance from the axis.
    let center = [p[0] - below[0], p[1] - below[1]];
    let radius = below[0] + below[1] + above[0];
    let (min, max) = (
        [center[0] - radius, center[1] - radius, min[2]],
        [center[0] + radius, center[1] + radius, max[2]],
    );
    let z = [exact(min[2]), exact(max[2])];
    let (center, radius) = (center.map(exact), exact(radius));
    (Workspace::Cylinder { center, radius, z }, min, max)
}

/// A random path of cells that contain the point.
pub fn cells_around(random: &mut Random, p: V, min: V, max: V, depth: usize) -> Vec<Cell> {
    let rational = |x: f64| BigRational::from_float(x).expect("finite");
    let mut cells = vec![Cell::ROOT];
    for _ in 0..depth {
        let axis = Axis::ALL[random.below(3) as usize];
        let k = axis.index();
        let cell = cells[cells.len() - 1];
        let (lower, upper) = cell.halves(axis).expect("not too deep");
        let edge = upper.edges[k];
        let part = BigRational::new(BigInt::from(edge.index), BigInt::from(1) << edge.level);
        let middle = rational(min[k]) + (rational(max[k]) - rational(min[k])) * part;
        let in_upper = match rational(p[k]).cmp(&middle) {
            std::cmp::Ordering::Less => false,
            std::cmp::Ordering::Equal => random.coin(),
            std::cmp::Ordering::Greater => true,
        };
        cells.push(if in_upper { upper } else { lower });
    }
    cells
}

/// Every rule that may discharge an obligation of the claim, and whether one does on the cell.
pub fn discharged(
    model: &Model<Fixed>,
    cell: &Cell,
    rotations: &[Rotation],
    mus: &[Mu],
) -> BTreeMap<&'static str, bool> {
    let mut verdicts = BTreeMap::new();
    let bounds = &model.bounds;
    verdicts.insert("outside", rule::outside(model, cell).is_ok());
    if bounds.serial_margin.is_some() {
        verdicts.insert("serial_margin", rule::serial_margin(model, cell).is_ok());
    }
    if bounds.leg_angle.is_some() {
        verdicts.insert("leg_angle", rule::leg_angle(model, cell).is_ok());
    }
    verdicts.insert("parallel_margin", rule::parallel_margin(model, cell).is_ok());
    let expansion = Expansion::new(model, cell, ExpansionPoint::Centre);
    let with = |holds: &dyn Fn(&Expansion<Fixed>) -> bool| expansion.as_ref().is_ok_and(holds);
    let any = |holds: &dyn Fn(&Rotation) -> bool| rotations.iter().any(holds);
    verdicts.insert("lower", with(&|e| any(&|r| rule::lower(model, e, r).is_ok())));
    verdicts.insert("entrywise", with(&|e| any(&|r| rule::entrywise(model, e, r).is_ok())));
    verdicts.insert("upper", with(&|e| rule::upper(model, e).is_ok()));
    verdicts.insert("range", with(&|e| rule::range(model, cell, e).is_ok()));
    verdicts.insert("speed", with(&|e| rule::speed(model, e).is_ok()));
    let conditioning = |e: &Expansion<Fixed>, r: &Rotation| {
        mus.iter().any(|mu| rule::conditioning(model, e, r, mu).is_ok())
    };
    verdicts.insert("conditioning", with(&|e| any(&|r| conditioning(e, r))));
    verdicts
}

/// Widens some parameters; the machine stays within them.
pub fn with_tolerances(random: &mut Random, mut claim: MachineClaim, unit: f64) -> MachineClaim {
    let Mechanism::Translational(legs) = &mut claim.mechanism else { return claim };
    for quantity in legs.iter_mut().flat_map(|leg| leg.parameters_mut()) {
        let width = unit * (-(4.0 + random.below(30) as f64)).exp2();
        let x = quantity.min.clone();
        let mut end = |sign: i64| {
            let by = exact(if random.coin() { width } else { 0.0 });
            let by = if sign < 0 { by.negated() } else { by };
            x.clone().plus(by).expect("rational")
        };
        *quantity = Quantity { min: end(-1), max: end(1) };
    }
    claim
}
