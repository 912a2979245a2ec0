//! Looking around: approximate values of every requirement at single points and machines.
//!
//! Nothing here is a proof. A [`Sampler`] finds where requirements are met worst, which gives
//! candidates for refutations ([`crate::refute`]) and the table of worst values found.

use crate::exact::Exact;
use crate::interval::Approx;
use nalgebra::Matrix3;
use orthocert_checker::claim::{self, MachineClaim, Mechanism};
use orthocert_checker::kinematics::{JointCoordinate, Leg};
use orthocert_checker::linear::Vector;
use orthocert_checker::model::{Bounds, JointRange, Model};

/// A point of the workspace and a machine within the tolerances, each as parts in `[0, 1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// `P = least corner + width * u`.
    pub u: [f64; 3],
    /// The toleranced parameters, in the claim's order: 0 is the least value, 1 the greatest.
    pub t: Vec<f64>,
}

/// A requirement whose worst value is looked for. Legs are counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quality {
    /// Clearance at its least over the legs: zero at a serial singularity.
    Clearance,
    /// `|det M|`: zero at a parallel singularity.
    Determinant,
    /// `psi_max`: the greatest `psi_i`.
    GreatestPsi,
    /// `psi_min`: the least `psi_i`.
    LeastPsi,
    /// `rho_i` of this leg at its least.
    LeastRho(usize),
    /// `rho_i` of this leg at its greatest.
    GreatestRho(usize),
    /// `sigma_max / sigma_min` at its greatest.
    Conditioning,
    /// `|eta_i| / L_i` of this leg at its least, against the serial margin.
    SerialMargin(usize),
    /// `|det A| / (L_1 L_2 L_3)` at its least.
    ParallelMargin,
    /// The angle between this leg and its guide at its greatest.
    LegAngle(usize),
    /// `|row_i of M|` at its greatest.
    JointSpeed(usize),
}

impl Quality {
    /// The unit of its values in reports, where it has one; `angular` where joints are angles.
    pub fn unit(self, angular: bool) -> Option<&'static str> {
        match self {
            Quality::GreatestPsi | Quality::LeastPsi => angular.then_some("length/rad"),
            Quality::LeastRho(_) | Quality::GreatestRho(_) => {
                Some(if angular { "deg" } else { "length" })
            }
            Quality::LegAngle(_) => Some("deg"),
            Quality::JointSpeed(_) => Some(if angular { "deg/time" } else { "length/time" }),
            Quality::Clearance
            | Quality::Determinant
            | Quality::Conditioning
            | Quality::SerialMargin(_)
            | Quality::ParallelMargin => None,
        }
    }
}

/// What is found at a place.
#[derive(Clone, Debug)]
pub struct Values {
    /// The least of the legs' clearances, in the model's unit: negative out of reach.
    pub clearance: f64,
    /// At places that every leg reaches.
    pub reached: Option<Reached>,
}

/// What is found at a place that every leg reaches.
#[derive(Clone, Debug)]
pub struct Reached {
    /// `M = J^-1`.
    pub matrix: Matrix3<f64>,
    /// Singular values of `M`, ascending.
    pub xi: [f64; 3],
    /// Joint coordinates: lengths in the model's unit, angles in degrees.
    pub rho: [f64; 3],
    /// `|eta_i| / L_i`, for legs with a length.
    pub cosine: [Option<f64>; 3],
    /// `det A / (L_1 L_2 L_3)`.
    pub unit_determinant: f64,
}

/// Evaluates a claim's machines in floating point.
pub struct Sampler {
    model: Model<Approx>,
    legs: Option<Toleranced>,
}

/// A machine's legs, and their vectors `w_i` at a point.
type Placed = ([Leg<Approx>; 3], [Vector<Approx>; 3]);

/// The legs of a claim with tolerances.
struct Toleranced {
    legs: [claim::Leg; 3],
    /// For every leg, its parameters' ends in model units.
    ends: [Vec<(f64, f64)>; 3],
    /// The workspace's least corner in model units.
    least: [f64; 3],
    /// For every leg, which parameters are intervals.
    free: [Vec<bool>; 3],
}

impl Sampler {
    /// A sampler for a claim and its model.
    pub fn new(
        claim: &MachineClaim,
        model: &Model<orthocert_checker::fixed::Fixed>,
    ) -> Option<Self> {
        let legs = match &claim.mechanism {
            Mechanism::Translational(legs) if legs.iter().any(claim::Leg::has_tolerance) => {
                Some(Toleranced::new(claim, legs, model)?)
            }
            _ => None,
        };
        Some(Sampler { model: model.map(&Approx::from_fixed), legs })
    }

    /// The number of toleranced parameters.
    pub fn parameters(&self) -> usize {
        self.legs.as_ref().map_or(0, |legs| legs.free.iter().flatten().filter(|f| **f).count())
    }

    /// The bounds, in model units.
    pub fn bounds(&self) -> &Bounds<Approx> {
        &self.model.bounds
    }

    /// The values at a place.
    pub fn at(&self, place: &Place) -> Values {
        let u = self.within(place.u);
        let displacement: Vector<Approx> =
            std::array::from_fn(|k| Approx(self.model.width[k].0 * u[k]));
        let Some(toleranced) = &self.legs else {
            return evaluate(&self.model.legs, &self.model.leg_vectors(&displacement));
        };
        match toleranced.machine(&place.t, &displacement) {
            Some((legs, w)) => evaluate(&legs, &w),
            None => Values { clearance: f64::NEG_INFINITY, reached: None },
        }
    }

    /// The parts of the workspace's box that a place stands for: in a cylinder, points outside it
    /// are pulled to its surface along the radius.
    pub fn within(&self, u: [f64; 3]) -> [f64; 3] {
        let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
        let radius = x.hypot(y);
        if !self.model.is_cylinder || radius <= 1.0 {
            return u;
        }
        // A little inward, so that rounding to a short number stays inside.
        let pull = (1.0 - 1e-12) / radius;
        [(x * pull + 1.0) / 2.0, (y * pull + 1.0) / 2.0, u[2]]
    }

    /// How far a quality is from being violated at a place, relative to its bound: negative where
    /// it is violated, `None` where the claim has no such bound.
    pub fn margin(&self, quality: Quality, values: &Values) -> Option<f64> {
        let bounds = &self.model.bounds;
        let Some(reached) = &values.reached else {
            // Out of reach: the further, the worse, and worse than any point within reach.
            return Some(values.clearance.min(0.0) - 1e3);
        };
        match quality {
            Quality::Clearance => Some(values.clearance),
            Quality::Determinant => Some(reached.matrix.determinant().abs()),
            Quality::GreatestPsi => {
                (bounds.kappa.0 > 0.0).then(|| reached.xi[0] / bounds.kappa.0 - 1.0)
            }
            Quality::LeastPsi => bounds.k.map(|k| 1.0 - reached.xi[2] / k.0),
            Quality::LeastRho(leg) => {
                bounds.joint_range.as_ref()?[leg].least().map(|min| reached.rho[leg] - min)
            }
            Quality::GreatestRho(leg) => {
                bounds.joint_range.as_ref()?[leg].greatest().map(|max| max - reached.rho[leg])
            }
            Quality::Conditioning => {
                bounds.conditioning.map(|c| 1.0 - reached.xi[2] / reached.xi[0] / c.0)
            }
            Quality::SerialMargin(leg) => {
                let least = bounds.serial_margin?.0.sqrt();
                Some(reached.cosine[leg]? / least - 1.0)
            }
            Quality::LegAngle(leg) => {
                let least = bounds.leg_angle?.0.max(0.0).sqrt();
                Some(reached.cosine[leg]? - least)
            }
            Quality::ParallelMargin => {
                bounds.parallel_margin.map(|min| reached.unit_determinant.abs() / min.0 - 1.0)
            }
            Quality::JointSpeed(leg) => {
                bounds.joint_speed.map(|max| 1.0 - reached.matrix.row(leg).norm() / max.0)
            }
        }
    }

    /// By what factor, less one, the bound of a quality is tightened until it is met with equality
    /// at a place ([`crate::atlas::tightened`]): negative where it is violated, -1 where a leg does
    /// not reach. `None` where there is no bound, or a joint's range has one end only.
    pub fn room(&self, quality: Quality, values: &Values) -> Option<f64> {
        let margin = self.margin(quality, values)?;
        let Some(reached) = &values.reached else {
            return Some(-1.0);
        };
        match quality {
            Quality::Clearance | Quality::Determinant => (margin <= 0.0).then_some(-1.0),
            // The value over the bound, less one.
            Quality::GreatestPsi | Quality::SerialMargin(_) | Quality::ParallelMargin => {
                Some(margin)
            }
            // One less the value over the bound.
            Quality::LeastPsi | Quality::Conditioning | Quality::JointSpeed(_) => {
                Some(1.0 / (1.0 - margin) - 1.0)
            }
            Quality::LegAngle(_) => {
                let greatest = self.model.bounds.leg_angle?.0.clamp(0.0, 1.0).sqrt().acos();
                Some(greatest.to_degrees() / self.value(quality, values)? - 1.0)
            }
            Quality::LeastRho(leg) | Quality::GreatestRho(leg) => {
                let range = &self.model.bounds.joint_range.as_ref()?[leg];
                let (least, greatest) = (range.least()?, range.greatest()?);
                let off = (reached.rho[leg] - (least + greatest) / 2.0).abs();
                Some((greatest - least) / 2.0 / off - 1.0)
            }
        }
    }

    /// The value of a quality at a place, whatever the claim's bounds: lengths in the model's unit,
    /// angles in degrees, speeds per unit of tool speed. `None` out of reach, or where the legs
    /// have no such quality.
    pub fn value(&self, quality: Quality, values: &Values) -> Option<f64> {
        let reached = values.reached.as_ref()?;
        match quality {
            Quality::Clearance => Some(values.clearance),
            Quality::Determinant => Some(reached.matrix.determinant().abs()),
            Quality::GreatestPsi => Some(1.0 / reached.xi[0]),
            Quality::LeastPsi => Some(1.0 / reached.xi[2]),
            Quality::LeastRho(leg) | Quality::GreatestRho(leg) => Some(reached.rho[leg]),
            Quality::Conditioning => Some(reached.xi[2] / reached.xi[0]),
            Quality::SerialMargin(leg) => reached.cosine[leg],
            Quality::LegAngle(leg) => reached.cosine[leg].map(|c| c.min(1.0).acos().to_degrees()),
            Quality::ParallelMargin => Some(reached.unit_determinant.abs()),
            Quality::JointSpeed(leg) => Some(reached.matrix.row(leg).norm()),
        }
    }

    /// Every quality that the claim bounds, with those of singularities.
    pub fn qualities(&self) -> Vec<Quality> {
        let bounds = &self.model.bounds;
        let mut all = vec![Quality::Clearance, Quality::Determinant];
        if bounds.kappa.0 > 0.0 {
            all.push(Quality::GreatestPsi);
        }
        if bounds.k.is_some() {
            all.push(Quality::LeastPsi);
        }
        for (leg, range) in bounds.joint_range.iter().flatten().enumerate() {
            all.extend(range.least().map(|_| Quality::LeastRho(leg)));
            all.extend(range.greatest().map(|_| Quality::GreatestRho(leg)));
        }
        all.extend(bounds.conditioning.map(|_| Quality::Conditioning));
        all.extend(bounds.parallel_margin.map(|_| Quality::ParallelMargin));
        for leg in 0..3 {
            all.extend(bounds.serial_margin.map(|_| Quality::SerialMargin(leg)));
            all.extend(bounds.leg_angle.map(|_| Quality::LegAngle(leg)));
            all.extend(bounds.joint_speed.map(|_| Quality::JointSpeed(leg)));
        }
        all
    }

    /// The 27 points at the ends and the middle of every axis, with the middle machine.
    pub fn grid(&self) -> Vec<Place> {
        let ends = [0.0, 0.5, 1.0];
        let t = vec![0.5; self.parameters()];
        let mut places = Vec::with_capacity(27);
        for x in ends {
            for y in ends {
                places.extend(ends.map(|z| Place { u: [x, y, z], t: t.clone() }));
            }
        }
        places
    }

    /// The place near `start` at which `quality` has its least margin: a compass search over the
    /// point and the machine, from steps of one half down to `2^-finest`.
    pub fn descend(&self, quality: Quality, start: &Place, finest: i32) -> (f64, Place) {
        self.compass(quality, start, finest, 3 + start.t.len())
    }

    /// As [`Sampler::descend`], for the machine of `start`.
    pub fn descend_to_point(&self, quality: Quality, start: &Place, finest: i32) -> (f64, Place) {
        self.compass(quality, start, finest, 3)
    }

    /// A compass search along the first so many axes of points and machines.
    fn compass(&self, quality: Quality, start: &Place, finest: i32, axes: usize) -> (f64, Place) {
        let mut best = start.clone();
        let worst = |place: &Place| self.margin(quality, &self.at(place)).unwrap_or(f64::MAX);
        let mut least = worst(&best);
        for exponent in 1..=finest {
            let step = f64::from(-exponent).exp2();
            // A few rounds a step: the next, finer step takes over what is left.
            for _ in 0..4 {
                let mut moved = false;
                for axis in 0..axes {
                    for signed in [step, -step] {
                        let candidate = best.moved(axis, signed);
                        let margin = if candidate == best { f64::MAX } else { worst(&candidate) };
                        if margin < least {
                            (least, best, moved) = (margin, candidate, true);
                        }
                    }
                }
                if !moved {
                    break;
                }
            }
        }
        (least, best)
    }
}

impl Place {
    fn moved(&self, axis: usize, step: f64) -> Place {
        let mut place = self.clone();
        let part = match axis {
            0..3 => &mut place.u[axis],
            _ => &mut place.t[axis - 3],
        };
        *part = (*part + step).clamp(0.0, 1.0);
        place
    }
}

fn evaluate(legs: &[Leg<Approx>; 3], w: &[Vector<Approx>; 3]) -> Values {
    let clearance = (0..3).map(|i| legs[i].clearance(&w[i]).0).fold(f64::INFINITY, f64::min);
    let states = [legs[0].at(&w[0]), legs[1].at(&w[1]), legs[2].at(&w[2])];
    let [Some(a), Some(b), Some(c)] = states else {
        return Values { clearance, reached: None };
    };
    let rows = [&a.row, &b.row, &c.row];
    let matrix = Matrix3::from_fn(|i, j| rows[i][j].0);
    let mut xi: [f64; 3] = matrix.singular_values().into();
    xi.sort_by(f64::total_cmp);
    let unit = |i: usize| legs[i].expand_unit(&w[i], &w[i]).map(|(unit, _)| unit.map(|x| x.0));
    let units = [unit(0), unit(1), unit(2)].map(|u| u.unwrap_or([f64::NAN; 3]));
    let reached = Reached {
        matrix,
        xi,
        rho: [a.rho, b.rho, c.rho].map(joint_value),
        cosine: std::array::from_fn(|i| legs[i].cosine_squared(&w[i]).map(|x| x.0.max(0.0).sqrt())),
        unit_determinant: Matrix3::from_fn(|i, j| units[i][j]).determinant(),
    };
    Values { clearance, reached: Some(reached) }
}

/// A length in the model's unit, or an angle in degrees.
fn joint_value(rho: JointCoordinate<Approx>) -> f64 {
    match rho {
        JointCoordinate::Length(rho) => rho.0,
        JointCoordinate::Angle { cos, sin } => sin.0.atan2(cos.0).to_degrees(),
    }
}

/// The ends of a joint range, in the terms of [`joint_value`].
trait Ends {
    fn least(&self) -> Option<f64>;
    fn greatest(&self) -> Option<f64>;
}

impl Ends for JointRange<Approx> {
    fn least(&self) -> Option<f64> {
        match self {
            JointRange::Length { min, .. } => min.map(|x| x.0),
            JointRange::Angle { min, .. } => Some(min.1 .0.atan2(min.0 .0).to_degrees()),
        }
    }

    fn greatest(&self) -> Option<f64> {
        match self {
            JointRange::Length { max, .. } => max.map(|x| x.0),
            JointRange::Angle { max, .. } => Some(max.1 .0.atan2(max.0 .0).to_degrees()),
        }
    }
}

impl Toleranced {
    fn new(
        claim: &MachineClaim,
        legs: &[claim::Leg; 3],
        model: &Model<orthocert_checker::fixed::Fixed>,
    ) -> Option<Self> {
        let (min, _) = claim.workspace.bounding_box().ok()?;
        let scale = model.unit_exponent?;
        let value = |x: &Exact, scale: i64| Some(Approx::from_fixed(&x.enclose(scale, 128)?).0);
        let ends = |leg: &claim::Leg| -> Option<Vec<(f64, f64)>> {
            let end = |parameter: claim::Parameter, x: &Exact| {
                value(x, if parameter.is_direction() { 0 } else { scale })
            };
            leg.parameters()
                .iter()
                .map(|(p, q)| Some((end(*p, &q.min)?, end(*p, &q.max)?)))
                .collect()
        };
        let free = |leg: &claim::Leg| leg.parameters().iter().map(|(_, q)| !q.is_exact()).collect();
        Some(Toleranced {
            legs: legs.clone(),
            ends: [ends(&legs[0])?, ends(&legs[1])?, ends(&legs[2])?],
            least: [value(&min[0], scale)?, value(&min[1], scale)?, value(&min[2], scale)?],
            free: [free(&legs[0]), free(&legs[1]), free(&legs[2])],
        })
    }

    /// The machine with these parts of its tolerances, and its leg vectors.
    fn machine(&self, t: &[f64], displacement: &Vector<Approx>) -> Option<Placed> {
        let mut parts = t.iter();
        let mut leg = |i: usize| {
            let values: Vec<Approx> = self.ends[i]
                .iter()
                .zip(&self.free[i])
                .map(|(&(lo, hi), &free)| {
                    let part = if free { parts.next().copied().unwrap_or(0.5) } else { 0.0 };
                    Approx(lo + part * (hi - lo))
                })
                .collect();
            let (leg, offset) = Leg::new(&self.legs[i], &values)?;
            let w =
                std::array::from_fn(|k| Approx(self.least[k] + displacement[k].0 + offset[k].0));
            Some((leg, w))
        };
        let [a, b, c] = [leg(0)?, leg(1)?, leg(2)?];
        Some(([a.0, b.0, c.0], [a.1, b.1, c.1]))
    }
}
