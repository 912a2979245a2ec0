//! What becomes of one cell: proposed in doubles, confirmed in exact arithmetic.

use crate::interval::Interval;
use crate::paving::spectrum::Spectrum;
use crate::rotation;
use crate::rough::Rough;
use nalgebra::Matrix3;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{Direction, LegNumber, Step, TwoDirections, Violation};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::expansion::{Expansion, ExpansionPoint, Region};
use orthocert_checker::kinematics::JointCoordinate;
use orthocert_checker::model::{JointRange, Model};
use orthocert_checker::paving::{is_mirrored, Header, Judge, Kind, Rejected, MAX_AXIS_LEVEL};
use orthocert_checker::rule::{self, Obligation, Rotation};

/// Half the bits of a direction's components: eight bits with a sign, or more where cells are small.
const DIRECTION: [f64; 2] = [127.0, 1_048_576.0];

/// Decides cells of one claim.
pub struct Decider {
    rough: Model<Rough>,
    judge: Judge,
    symmetric: bool,
    /// Whether every requirement is about singular values alone.
    plain: bool,
}

/// What becomes of a cell.
#[derive(Clone, Debug)]
pub struct Decision {
    /// What is shown of all of it.
    pub steps: Vec<Step>,
    /// What it is.
    pub fate: Fate,
}

/// What a cell is.
#[derive(Clone, Debug)]
pub enum Fate {
    /// Decided.
    Closed(Kind),
    /// Undecided; to be split along this axis, if it may be split.
    Open(Option<Axis>),
}

/// The claim seems to hold at the centre.
struct HoldsAtCentre;

/// The place of an obligation in sets of them, such as what a cell inherits.
pub(super) fn bit(obligation: Obligation) -> u32 {
    1 << obligation as u8
}

/// What is discharged once these steps are added.
pub(super) fn discharged(before: u32, steps: &[Step]) -> u32 {
    steps.iter().filter_map(|step| step.rule().1).fold(before, |done, o| done | bit(o))
}

impl Decider {
    /// For the pavings that begin with this header.
    ///
    /// # Errors
    /// If the header is not well formed.
    pub fn new(header: &Header) -> Result<Self, Rejected> {
        let judge = Judge::new(header)?;
        let model = Model::new(header.machine_claim()?, crate::verify::MODEL_PRECISION)?;
        let singular_values = [Obligation::SigmaMin, Obligation::SigmaMax];
        let plain = judge.obligations().iter().all(|o| singular_values.contains(o));
        let rough = model.map(&Rough::from_fixed);
        Ok(Decider { rough, judge, symmetric: header.symmetry.is_some(), plain })
    }

    /// The exact judge of every decision.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// Decides a cell on which `inherited` is discharged already.
    pub fn decide(&self, cell: &Cell, inherited: u32) -> Decision {
        let closed = |kind| Decision { steps: Vec::new(), fate: Fate::Closed(kind) };
        if self.symmetric && is_mirrored(cell) {
            return closed(Kind::Mirrored);
        }
        let model = &self.rough;
        let Ok(expansion) = Expansion::new(model, cell, ExpansionPoint::Centre) else {
            return match self.beyond_reach(cell) {
                Some(violation) => closed(Kind::Outer(violation)),
                None => self.open(cell, Vec::new(), &clearance_weights(model, cell)),
            };
        };
        let spectrum = Spectrum::of(&expansion.matrix);
        match self.failing(cell, &expansion, &spectrum) {
            Ok(Some(violation)) => return closed(Kind::Outer(violation)),
            Ok(None) => {
                let weights = self.weights(&expansion, &spectrum, inherited);
                return self.open(cell, Vec::new(), &weights);
            }
            Err(HoldsAtCentre) => {}
        }
        let open = self.judge.obligations().iter().filter(|&&o| inherited & bit(o) == 0);
        let wanted = open.clone().count();
        let mut steps: Vec<Step> =
            open.filter_map(|&o| self.step(cell, &expansion, &spectrum, o)).collect();
        if self.judge.steps(cell, &steps).is_err() {
            steps.retain(|step| self.judge.steps(cell, std::slice::from_ref(step)).is_ok());
        }
        if steps.len() == wanted {
            return Decision { steps, fate: Fate::Closed(Kind::Inner) };
        }
        let weights = self.weights(&expansion, &spectrum, discharged(inherited, &steps));
        self.open(cell, steps, &weights)
    }

    fn open(&self, cell: &Cell, steps: Vec<Step>, weights: &[f64; 3]) -> Decision {
        let splittable = |k: &usize| cell.edges[*k].level < MAX_AXIS_LEVEL;
        let axis = (0..3).filter(splittable).max_by(|&a, &b| {
            // The first of equals.
            weights[a].total_cmp(&weights[b]).then(b.cmp(&a))
        });
        Decision { steps, fate: Fate::Open(axis.map(|k| Axis::ALL[k])) }
    }

    /// The extreme singular values at a cell's centre, nearly; `None` out of reach.
    pub(super) fn spectrum_at_centre(&self, cell: &Cell) -> Option<Spectrum> {
        let at = Region::new(&self.rough, cell, ExpansionPoint::Centre).at;
        let row = |i: usize| self.rough.legs[i].at(&at[i]).map(|state| state.row);
        Some(Spectrum::of(&[row(0)?, row(1)?, row(2)?]))
    }

    /// A violation, confirmed in exact arithmetic, that holds on all of the cell.
    pub fn violated(&self, cell: &Cell) -> Option<Violation> {
        let Ok(expansion) = Expansion::new(&self.rough, cell, ExpansionPoint::Centre) else {
            return self.beyond_reach(cell);
        };
        self.failing(cell, &expansion, &Spectrum::of(&expansion.matrix)).ok()?
    }

    /// A violation that holds on all of the cell, if the claim fails at its centre and there is one;
    /// an error if the claim holds there.
    fn failing(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
    ) -> Result<Option<Violation>, HoldsAtCentre> {
        let failing = self.failing_at_centre(cell, expansion, spectrum);
        if failing.is_empty() {
            return Err(HoldsAtCentre);
        }
        Ok(failing.into_iter().find(|violation| {
            self.violated_roughly(cell, expansion, violation)
                && self.judge.violation(cell, violation).is_ok()
        }))
    }

    /// A violation by a leg that does not reach, or hardly reaches, any of the cell.
    fn beyond_reach(&self, cell: &Cell) -> Option<Violation> {
        let numbered = [1, 2, 3].map(|leg| LegNumber { leg });
        let rows = numbered.iter().cloned().map(Violation::Row);
        let reach = numbered.iter().cloned().map(Violation::Reach);
        let holds = |violation: &Violation| {
            rule::violated(&self.rough, cell, violation).is_ok()
                && self.judge.violation(cell, violation).is_ok()
        };
        rows.chain(reach).find(holds)
    }

    /// The violations, with evidence, that the centre suggests.
    fn failing_at_centre(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
    ) -> Vec<Violation> {
        let bounds = &self.rough.bounds;
        let mut found = Vec::new();
        let scales = if depth(cell) < 27 { &DIRECTION[..1] } else { &DIRECTION[..] };
        let kappa = bounds.kappa.mid();
        if spectrum.least < kappa * kappa {
            found.extend(scales.iter().map(|&s| {
                Violation::SigmaMin(Direction { vector: integers(spectrum.least_direction(), s) })
            }));
        }
        if bounds.k.is_some_and(|k| spectrum.greatest > k.mid() * k.mid()) {
            found.extend(scales.iter().map(|&s| {
                Violation::SigmaMax(Direction {
                    vector: integers(spectrum.greatest_direction(), s),
                })
            }));
        }
        if !self.plain {
            self.others_at_centre(cell, expansion, spectrum, &mut found);
        }
        found
    }

    fn others_at_centre(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
        found: &mut Vec<Violation>,
    ) {
        let model = &self.rough;
        let bounds = &model.bounds;
        let at = Region::new(model, cell, ExpansionPoint::Centre).at;
        for leg in 0..3 {
            let number = || LegNumber { leg: leg + 1 };
            let cosine = model.legs[leg].cosine_squared(&at[leg]).map(|c| c.mid());
            let oblique = |bound: Option<Rough>| {
                bound.zip(cosine).is_some_and(|(bound, cosine)| cosine < bound.mid())
            };
            if oblique(bounds.serial_margin) {
                found.push(Violation::SerialMargin(number()));
            }
            if oblique(bounds.leg_angle) {
                found.push(Violation::LegAngle(number()));
            }
            let row: f64 = expansion.matrix[leg].iter().map(|x| x.mid() * x.mid()).sum();
            if bounds.joint_speed.is_some_and(|v| row > v.mid() * v.mid()) {
                found.push(Violation::JointSpeed(number()));
            }
            let rho = model.legs[leg].at(&at[leg]).map(|state| state.rho);
            if let (Some(rho), Some(ranges)) = (rho, &bounds.joint_range) {
                if outside(&rho, &ranges[leg]) {
                    found.push(Violation::JointRange(number()));
                }
            }
        }
        let ratio = bounds.conditioning.map(|c| c.mid() * c.mid());
        if ratio.is_some_and(|c| spectrum.greatest > c * spectrum.least) {
            found.push(Violation::Conditioning(TwoDirections {
                u: integers(spectrum.greatest_direction(), DIRECTION[1]),
                v: integers(spectrum.least_direction(), DIRECTION[1]),
            }));
        }
        let small = |min: Rough| unit_determinant(model, &at).is_some_and(|det| det < min.mid());
        if bounds.parallel_margin.is_some_and(small) {
            found.push(Violation::ParallelMargin);
        }
    }

    fn violated_roughly(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        violation: &Violation,
    ) -> bool {
        match violation {
            Violation::SigmaMin(v) => rule::shrunk(&self.rough, expansion, &v.vector),
            Violation::SigmaMax(v) => rule::stretched(&self.rough, expansion, &v.vector),
            other => rule::violated(&self.rough, cell, other),
        }
        .is_ok()
    }

    /// The step that seems to discharge an obligation.
    fn step(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
        obligation: Obligation,
    ) -> Option<Step> {
        let model = &self.rough;
        let (result, step) = match obligation {
            Obligation::SigmaMin => {
                let v = spectrum.least_direction();
                let least = spectrum.least.sqrt() - variation(expansion, v);
                let hopeless = least <= model.bounds.kappa.mid();
                return if hopeless { None } else { lower(model, expansion) };
            }
            Obligation::SigmaMax => {
                let v = spectrum.greatest_direction();
                let greatest = spectrum.greatest.sqrt() + variation(expansion, v);
                if greatest >= model.bounds.k?.mid() {
                    return None;
                }
                (rule::upper(model, expansion), Step::Upper)
            }
            Obligation::JointRange => (rule::range(model, cell, expansion), Step::Range),
            Obligation::SerialMargin => (rule::serial_margin(model, cell), Step::SerialMargin),
            Obligation::ParallelMargin => {
                (rule::parallel_margin(model, cell), Step::ParallelMargin)
            }
            Obligation::LegAngle => (rule::leg_angle(model, cell), Step::LegAngle),
            Obligation::JointSpeed => (rule::speed(model, expansion), Step::Speed),
            Obligation::Conditioning => {
                return crate::machine::conditioning_step(&intervals(model), &widened(expansion))
                    .ok()
            }
            _ => return None,
        };
        result.is_ok().then_some(step)
    }

    /// By how much each axis of the cell moves what is next to its bound: the squared length of
    /// `M v` for the singular vector in question. Where there are other requirements: by how much it
    /// moves `M`, and the joint coordinates, which a translation along a guide moves alone; each
    /// where something that depends on it is not `done`.
    fn weights(&self, expansion: &Expansion<Rough>, spectrum: &Spectrum, done: u32) -> [f64; 3] {
        if !self.plain {
            let open = |o: &&Obligation| done & bit(**o) == 0;
            let all = || self.judge.obligations().iter().filter(open);
            let joints = all().any(|&o| o == Obligation::JointRange);
            let of_m = all().any(|&o| o != Obligation::JointRange);
            return std::array::from_fn(|k| {
                let rho = expansion.rho.iter().flatten().map(|(_, along)| along[k].mag());
                let slopes = expansion.slopes[k].iter().flatten().map(Rough::mag);
                let part = |is_open: bool, sum: f64| if is_open { sum } else { 0.0 };
                part(joints, rho.sum()) + part(of_m, slopes.sum())
            });
        }
        let (kappa, k) = (self.rough.bounds.kappa.mid(), self.rough.bounds.k.map(|k| k.mid()));
        let margin_below = (spectrum.least / (kappa * kappa)).ln().abs();
        let margin_above = k.map_or(f64::INFINITY, |k| (spectrum.greatest / (k * k)).ln().abs());
        let v = if margin_below <= margin_above {
            spectrum.least_direction()
        } else {
            spectrum.greatest_direction()
        };
        let apply = |m: &[[Rough; 3]; 3]| -> [f64; 3] {
            std::array::from_fn(|i| (0..3).map(|j| m[i][j].mid() * v[j]).sum())
        };
        let y = apply(&expansion.matrix);
        expansion.slopes.each_ref().map(|slope| {
            let e = apply(slope);
            let along: f64 = (0..3).map(|i| y[i] * e[i]).sum();
            2.0 * along.abs() + e.iter().map(|x| x * x).sum::<f64>()
        })
    }
}

/// By how much the singular value with the direction `v` varies over the cell, to first order:
/// `sum_k |u . E_k v|`, `u = M v / |M v|`. At one of the vertices it is lower, at one higher by that
/// much: a vertex rule that has less room than this cannot hold.
fn variation(expansion: &Expansion<Rough>, v: [f64; 3]) -> f64 {
    let apply = |m: &[[Rough; 3]; 3]| -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| m[i][j].mid() * v[j]).sum())
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let y = apply(&expansion.matrix);
    let sum: f64 = expansion.slopes.iter().map(|slope| dot(y, apply(slope)).abs()).sum();
    sum / (dot(y, y) * dot(v, v)).sqrt()
}

/// The number of splits above a cell.
fn depth(cell: &Cell) -> u32 {
    cell.edges.iter().map(|e| e.level).sum()
}

/// The shortest evidence with which the lower vertex rule seems to hold.
fn lower(model: &Model<Rough>, expansion: &Expansion<Rough>) -> Option<Step> {
    if rule::lower(model, expansion, &Rotation::IDENTITY).is_ok() {
        return Some(Step::Lower(Rotation::IDENTITY));
    }
    let centre = Matrix3::from_fn(|i, j| expansion.matrix[i][j].mid());
    let candidates = rotation::candidates(&centre);
    // Beyond 18 bits nothing is gained; the longest decides whether any may hold.
    let holds = |r: &&Rotation| rule::lower(model, expansion, r).is_ok();
    candidates.last().filter(holds)?;
    candidates.iter().find(holds).map(|rotation| Step::Lower(*rotation))
}

/// A unit vector as integers of this size.
fn integers(v: [f64; 3], scale: f64) -> [i64; 3] {
    let most = v.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let rounded = v.map(|x| (x / most * scale).round() as i64);
    if rounded == [0; 3] {
        [1, 0, 0]
    } else {
        rounded
    }
}

fn outside(rho: &JointCoordinate<Rough>, range: &JointRange<Rough>) -> bool {
    match (rho, range) {
        (JointCoordinate::Length(rho), JointRange::Length { min, max }) => {
            min.is_some_and(|min| rho.mid() < min.mid())
                || max.is_some_and(|max| rho.mid() > max.mid())
        }
        (JointCoordinate::Angle { cos, sin }, JointRange::Angle { min, max }) => {
            let sine = |a: (f64, f64), b: (f64, f64)| a.1 * b.0 - a.0 * b.1;
            let pair = |p: &(Rough, Rough)| (p.0.mid(), p.1.mid());
            let theta = (cos.mid(), sin.mid());
            sine(theta, pair(min)) < 0.0 || sine(pair(max), theta) < 0.0
        }
        _ => false,
    }
}

fn unit_determinant(model: &Model<Rough>, at: &[[Rough; 3]; 3]) -> Option<f64> {
    let unit = |i: usize| model.legs[i].expand_unit(&at[i], &at[i]).map(|(unit, _)| unit);
    let units = [unit(0)?, unit(1)?, unit(2)?];
    Some(Matrix3::from_fn(|i, j| units[i][j].mid()).determinant().abs())
}

fn widened(expansion: &Expansion<Rough>) -> Expansion<Interval> {
    let interval = |x: Rough| Interval::new(x.lo, x.hi);
    Expansion {
        matrix: expansion.matrix.map(|row| row.map(interval)),
        slopes: expansion.slopes.map(|m| m.map(|row| row.map(interval))),
        rho: [None, None, None],
        hull: expansion.hull,
    }
}

fn intervals(model: &Model<Rough>) -> Model<Interval> {
    model.map(&|x: &Rough| Interval::new(x.lo, x.hi))
}

/// The axes by how much the legs' clearances gain in width from them.
fn clearance_weights(model: &Model<Rough>, cell: &Cell) -> [f64; 3] {
    let region = Region::new(model, cell, ExpansionPoint::Centre);
    std::array::from_fn(|k| {
        let widths = (0..3).map(|leg| {
            let mut along = region.at[leg];
            along[k] = region.over[leg][k];
            let clearance = model.legs[leg].clearance(&along);
            clearance.hi - clearance.lo
        });
        widths.sum()
    })
}
