//! Imported designs against the firmwares' own kinematics, restated from their sources.
//!
//! At random points of the imported workspace the joint coordinates of the design are those of the
//! firmware, and the extremes of `rho` and `psi` over it, found from the firmware's kinematics alone,
//! lie inside `bounds` and no farther in than 1e-4.

use crate::support::{legs, Machine, Workspace};
use nalgebra::Matrix3;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert::exact::Exact;
use orthocert::search::solver::enclose::{enclose, singular, NotEnclosed};
use orthocert::search::solver::extremes::Extreme as Bounded;
use orthocert::search::solver::sample::Sampler;
use orthocert::search::{Budget, Control};
use orthocert_kernel::machine::Joint;
use orthocert_kernel::problem::Problem;
use std::sync::atomic::AtomicBool;

/// A firmware's kinematics; joint coordinates of arms are degrees.
pub trait Firmware {
    /// The joint coordinates at a point; `None` out of reach.
    fn joints(&self, point: [f64; 3]) -> Option<[f64; 3]>;

    /// The point of joint coordinates.
    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]>;

    /// Whether the firmware moves there.
    fn allows(&self, _point: [f64; 3]) -> bool {
        true
    }
}

/// Numbers in [0, 1), always the same.
pub struct Random(pub u64);

impl Random {
    /// The next one.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Three of them.
    pub fn three(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

fn float(x: &Exact) -> f64 {
    x.below(200).and_then(|x| x.to_f64()).expect("a number")
}

/// A claim's workspace as a map from the unit cube.
pub struct Region {
    low: [f64; 3],
    high: [f64; 3],
    round: bool,
}

impl Region {
    /// Of a claim.
    pub fn of(claim: &Machine) -> Region {
        match &claim.workspace {
            Workspace::Box { min, max } => Region {
                low: min.each_ref().map(float),
                high: max.each_ref().map(float),
                round: false,
            },
            Workspace::Cylinder { center, radius, z } => {
                let (c, r) = (center.each_ref().map(float), float(radius));
                Region {
                    low: [c[0] - r, c[1] - r, float(&z[0])],
                    high: [c[0] + r, c[1] + r, float(&z[1])],
                    round: true,
                }
            }
        }
    }

    /// The point of coordinates in [0, 1]; those outside a circle are drawn to it.
    pub fn at(&self, u: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let mut u = u.map(|u| u.clamp(0.0, 1.0));
        if self.round {
            let [x, y] = [2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0];
            let out = x.hypot(y).max(1.0);
            (u[0], u[1]) = ((x / out + 1.0) / 2.0, (y / out + 1.0) / 2.0);
        }
        (u, std::array::from_fn(|k| self.low[k] + (self.high[k] - self.low[k]) * u[k]))
    }

    /// The radius and the heights of a cylinder.
    pub fn cylinder(&self) -> (f64, [f64; 2]) {
        assert!(self.round);
        ((self.high[0] - self.low[0]) / 2.0, [self.low[2], self.high[2]])
    }
}

/// Compares the design's joint coordinates with the firmware's at `points` random points, and the
/// firmware's forward kinematics with its inverse; returns how many were within reach.
pub fn same_joints(name: &str, claim: &Machine, firmware: &dyn Firmware, points: usize) -> usize {
    let region = Region::of(claim);
    let problem = Problem::new(&claim.kernel).unwrap_or_else(|e| panic!("{name}: {e}"));
    let sampler = Sampler::new(&claim.kernel, &problem).expect("a sampler");
    let unit = sampler.unit();
    let size = (0..3).map(|k| region.high[k].abs().max(region.low[k].abs())).fold(1.0, f64::max);
    let mut random = Random(1);
    let mut reached = 0;
    for _ in 0..points {
        let (_, point) = region.at(random.three());
        let values = sampler.at_point(&point.map(|x| x / unit));
        let ours = sampler.matrix(&values).map(|_| {
            let rho = |i: usize| match problem.legs[i].rho.expect("a joint coordinate") {
                Joint::Length(rho) => values.of(rho).expect("within reach") * unit,
                Joint::Angle { cos, sin } => {
                    let [cos, sin] = [cos, sin].map(|x| values.of(x).expect("within reach"));
                    sin.atan2(cos).to_degrees()
                }
            };
            std::array::from_fn::<f64, 3, _>(rho)
        });
        let theirs = firmware.joints(point);
        let (Some(ours), Some(theirs)) = (ours, theirs) else {
            assert!(ours.is_none() == theirs.is_none(), "{name} {point:?} {ours:?} {theirs:?}");
            continue;
        };
        for (a, b) in ours.iter().zip(theirs) {
            assert!(
                (a - b).abs() < 1e-8 * size.max(b.abs()),
                "{name} {point:?} {ours:?} {theirs:?}"
            );
        }
        let back = firmware.point(theirs).unwrap_or_else(|| panic!("{name} {point:?}"));
        let off = (0..3).map(|k| (back[k] - point[k]).abs()).fold(0.0, f64::max);
        // Near a parallel singularity a firmware's forward kinematics loses digits.
        assert!(off < 1e-4 * size, "{name} {point:?} {back:?}");
        reached += 1;
    }
    reached
}

/// Holds that a restated kinematics computes what the compiled firmware computed: joint coordinates
/// at a point, and the point of those.
pub fn same_as_compiled(name: &str, firmware: &dyn Firmware, [point, joints, back]: [[f64; 3]; 3]) {
    let found = firmware.joints(point).unwrap_or_else(|| panic!("{name}"));
    let again = firmware.point(joints).unwrap_or_else(|| panic!("{name}"));
    for (a, b) in found.iter().chain(&again).zip(joints.iter().chain(&back)) {
        assert!((a - b).abs() < 1e-9 * b.abs().max(100.0), "{name} {found:?} {again:?}");
    }
}

/// What an extreme of the firmware's is, at a point; larger is worse. `None` out of reach.
fn quantity(firmware: &dyn Firmware, extreme: Extreme, point: [f64; 3], h: f64) -> Option<f64> {
    let joints = firmware.joints(point)?;
    match extreme {
        Extreme::LeastRho(leg) => return Some(-joints[leg]),
        Extreme::GreatestRho(leg) => return Some(joints[leg]),
        _ => {}
    }
    let mut m = Matrix3::zeros();
    for k in 0..3 {
        let moved = |by: f64| {
            let mut p = point;
            p[k] += by;
            firmware.joints(p)
        };
        let [a, b, c, d] = [moved(-2.0 * h)?, moved(-h)?, moved(h)?, moved(2.0 * h)?];
        for i in 0..3 {
            m[(i, k)] = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
        }
    }
    let sigma = m.singular_values();
    match extreme {
        Extreme::GreatestPsi => Some(1.0 / sigma.min()),
        _ => Some(-1.0 / sigma.max()),
    }
}

/// The extreme over the region, by a grid and a pattern search from its best places.
fn worst(region: &Region, firmware: &dyn Firmware, extreme: Extreme, h: f64) -> Option<f64> {
    let value = |u: [f64; 3]| quantity(firmware, extreme, region.at(u).1, h);
    let mut places = Vec::new();
    for i in 0..=16 {
        for j in 0..=16 {
            for k in [0.0, 0.5, 1.0] {
                let u = region.at([i as f64 / 16.0, j as f64 / 16.0, k]).0;
                places.push((value(u)?, u));
            }
        }
    }
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best = f64::NEG_INFINITY;
    for &(mut found, mut u) in places.iter().take(6) {
        let mut step = 1.0 / 16.0;
        for _ in 0..400 {
            let mut better = None;
            for d in 0..26 {
                let d = if d < 13 { d } else { d + 1 };
                let to = [d / 9, d / 3 % 3, d % 3].map(|d| (d as f64 - 1.0) * step);
                let (to, _) = region.at(std::array::from_fn(|k| u[k] + to[k]));
                let now = value(to)?;
                // Differences of rounding are no progress.
                if now > found + 1e-11 * found.abs() {
                    (found, better) = (now, Some(to));
                }
            }
            match better {
                Some(to) => u = to,
                None if step < 1e-8 => break,
                None => step /= 2.0,
            }
        }
        best = best.max(found);
    }
    Some(best)
}

/// An extreme that the firmware knows of.
#[derive(Clone, Copy, Debug)]
enum Extreme {
    LeastPsi,
    GreatestPsi,
    LeastRho(usize),
    GreatestRho(usize),
}

impl Extreme {
    fn of(bounded: &Bounded) -> Option<Self> {
        let greatest = bounded.is_greatest();
        let rho = |leg| if greatest { Extreme::GreatestRho(leg) } else { Extreme::LeastRho(leg) };
        match bounded.symbol().as_str() {
            "psi" if greatest => Some(Extreme::GreatestPsi),
            "psi" => Some(Extreme::LeastPsi),
            "rho_1" => Some(rho(0)),
            "rho_2" => Some(rho(1)),
            "rho_3" => Some(rho(2)),
            _ => None,
        }
    }

    fn is_greatest(self) -> bool {
        matches!(self, Extreme::GreatestPsi | Extreme::GreatestRho(_))
    }
}

/// What is known of a design's extremes.
#[derive(Debug, PartialEq, Eq)]
pub enum Extremes {
    /// All are as the firmware's.
    Agree,
    /// Refuted: a singularity or a point out of reach inside.
    Singular,
    /// Not enclosed within the budget.
    Undecided,
}

/// Holds that the extremes that the firmware's kinematics has over the imported workspace are
/// inside `bounds`, and the bounds at most 1e-4 outside them.
pub fn same_extremes(name: &str, claim: &Machine, firmware: &dyn Firmware) -> Extremes {
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let budget = Budget { max_boxes: 20_000, deadline: None };
    match singular(&claim.kernel, budget, &mut control) {
        Ok(None) => {}
        Ok(Some(_)) => return Extremes::Singular,
        Err(error) => panic!("{name}: {error}"),
    }
    let region = Region::of(claim);
    let span = (0..3).map(|k| region.high[k] - region.low[k]).fold(0.0, f64::max);
    let angular = legs(claim)[0].is_angular();
    let width = BigRational::new(5.into(), 100_000.into());
    for bounded in Bounded::of(&claim.kernel, 3) {
        let Some(extreme) = Extreme::of(&bounded) else { continue };
        let enclosed = match enclose((&claim.kernel, false), &bounded, &width, budget, &mut control)
        {
            Ok(enclosed) if enclosed.width <= &width * BigRational::from_integer(2.into()) => {
                enclosed
            }
            Ok(_) => return Extremes::Undecided,
            Err(NotEnclosed::Singular) => return Extremes::Singular,
            Err(_) => return Extremes::Undecided,
        };
        let sampled = worst(&region, firmware, extreme, span * 1e-4);
        let Some(sampled) = sampled else { return Extremes::Undecided };
        let sign = if extreme.is_greatest() { 1.0 } else { -1.0 };
        // Per radian, where the firmware has degrees.
        let per = match extreme {
            Extreme::LeastPsi | Extreme::GreatestPsi if angular => 1f64.to_degrees(),
            _ => 1.0,
        };
        let (sampled, outer) = (sign * sampled * per, enclosed.outer.to_f64().expect("a double"));
        let room = sign * (outer - sampled);
        // Joint coordinates may be zero: then a share of the workspace's size.
        let scale = match extreme {
            Extreme::LeastRho(_) | Extreme::GreatestRho(_) => outer.abs().max(span),
            _ => outer.abs(),
        };
        assert!(
            room > -1e-7 * scale && room < 1e-4 * scale,
            "{name}: {extreme:?}: sampled {sampled}, bound {outer}"
        );
    }
    Extremes::Agree
}
