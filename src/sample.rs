//! Looking around: approximate values of every requirement at single points and machines.
//!
//! Nothing here is a proof. A [`Sampler`] finds where requirements are met worst, which gives
//! candidates for refutations ([`crate::refute`]) and the table of worst values found.

use crate::interval::Approx;
use nalgebra::Matrix3;
use orthocert_checker::claim::{self, MachineClaim, Mechanism, Parameter, Workspace};
use orthocert_checker::kinematics::Leg;
use orthocert_checker::linear::Vector;
use orthocert_checker::model::{Bounds, Model};
use orthocert_checker::number::Exact;

/// A point of the workspace and a machine within the tolerances, each as parts in `[0, 1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// `P = least corner + width * u`.
    pub u: [f64; 3],
    /// The toleranced parameters, in the claim's order: 0 is the least value, 1 the greatest.
    pub t: Vec<f64>,
}

/// A requirement whose worst value is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// `s_i / L_i` at its least over the legs: zero at a serial singularity.
    Clearance,
    /// `|det M|`: zero at a parallel singularity.
    Determinant,
    /// `psi_max`: the greatest `psi_i`.
    GreatestPsi,
    /// `psi_min`: the least `psi_i`.
    LeastPsi,
    /// `rho_i` of this leg (from zero) at its least.
    LeastRho(usize),
    /// `rho_i` of this leg (from zero) at its greatest.
    GreatestRho(usize),
}

/// What is found at a place; `None` where some leg does not reach it.
#[derive(Clone, Debug)]
pub struct Values {
    /// The least of `(s_i / L_i)^2`, negative out of reach (relative to the model's unit).
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
    /// Joint coordinates, in the model's unit.
    pub rho: [f64; 3],
}

/// Evaluates a claim's machines in floating point.
pub struct Sampler {
    model: Model<Approx>,
    legs: Option<Toleranced>,
}

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
        let displacement: Vector<Approx> =
            std::array::from_fn(|k| Approx(self.model.width[k].0 * place.u[k]));
        let Some(toleranced) = &self.legs else {
            return evaluate(&self.model.legs, &self.model.leg_vectors(&displacement));
        };
        match toleranced.machine(&place.t, &displacement) {
            Some((legs, w)) => evaluate(&legs, &w),
            None => Values { clearance: f64::NEG_INFINITY, reached: None },
        }
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
                bounds.joint_range.as_ref()?[leg].0.map(|min| reached.rho[leg] - min.0)
            }
            Quality::GreatestRho(leg) => {
                bounds.joint_range.as_ref()?[leg].1.map(|max| max.0 - reached.rho[leg])
            }
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
        for (leg, (min, max)) in bounds.joint_range.iter().flatten().enumerate() {
            all.extend(min.is_some().then_some(Quality::LeastRho(leg)));
            all.extend(max.is_some().then_some(Quality::GreatestRho(leg)));
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
        let mut best = start.clone();
        let worst = |place: &Place| self.margin(quality, &self.at(place)).unwrap_or(f64::MAX);
        let mut least = worst(&best);
        for exponent in 1..=finest {
            let step = f64::from(-exponent).exp2();
            // A few rounds a step: the next, finer step takes over what is left.
            for _ in 0..4 {
                let mut moved = false;
                for axis in 0..3 + best.t.len() {
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
    Values { clearance, reached: Some(Reached { matrix, xi, rho: [a.rho.0, b.rho.0, c.rho.0] }) }
}

impl Toleranced {
    fn new(
        claim: &MachineClaim,
        legs: &[claim::Leg; 3],
        model: &Model<orthocert_checker::fixed::Fixed>,
    ) -> Option<Self> {
        let Workspace::Box { min, .. } = &claim.workspace else {
            return None;
        };
        let scale = model.unit_exponent?;
        let value = |x: &Exact, scale: i64| Some(Approx::from_fixed(&x.enclose(scale, 128)?).0);
        let ends = |leg: &claim::Leg| -> Option<Vec<(f64, f64)>> {
            let end = |parameter: Parameter, x: &Exact| {
                value(x, if parameter == Parameter::Direction { 0 } else { scale })
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
    fn machine(
        &self,
        t: &[f64],
        displacement: &Vector<Approx>,
    ) -> Option<([Leg<Approx>; 3], [Vector<Approx>; 3])> {
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
