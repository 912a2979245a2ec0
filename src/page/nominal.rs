//! The nominal machine of a claim in doubles: every parameter in the middle of its tolerance. It is
//! what the figures show; nothing of it is a proof.

use super::isomap::{map, Map, Mark, Plane, Scale, NODES};
use super::legs::{across, unit, Numbers, Outline, Point, Shape};
use super::svg::Picture;
use crate::decimal::{approximate, significant};
use crate::exact::{Exact, MAX_DIGITS};
use crate::interval::Approx;
use crate::report::{exactly, Frame};
use nalgebra::Matrix3;
use orthocert_checker::claim::{
    self, MachineClaim, Mechanism, PostulateClaim, PsiMax, Quantity, Range, Requirements, Sign,
    Workspace,
};
use orthocert_checker::kinematics::Leg;
use orthocert_checker::linear::Vector;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_kernel::claim as kernel;
use orthocert_kernel::number::Expression;
use std::array::from_fn;

/// Fractional bits in which the claim's numbers are enclosed before they become doubles.
const PRECISION: u32 = 128;

/// Places along every axis from which the levels of maps are chosen.
const SAMPLES: usize = 9;

/// Lengths beyond this are not drawn: their powers would exceed the doubles.
const GREATEST: f64 = 1e60;

/// A leg: its numbers, its kinematics, and the vector `d_i - a_i`.
#[derive(Clone, Debug)]
pub struct NominalLeg {
    /// Its numbers.
    pub numbers: Numbers,
    kinematics: Leg<Approx>,
    offset: Point,
}

/// The nominal machine and its workspace.
#[derive(Clone, Debug)]
pub struct Nominal {
    /// The legs.
    pub legs: [NominalLeg; 3],
    /// The workspace's bounding box.
    pub frame: Frame,
    /// Whether the workspace is the cylinder inscribed in the box.
    pub is_cylinder: bool,
    /// Whether the workspace is the paper's cube, with the corners `Q_1` and `Q_2`.
    pub is_cube: bool,
    /// The place, in parts of the workspace, in whose plane the fixed maps are cut.
    pub slice: f64,
}

impl Nominal {
    /// The nominal machine of a claim; `None` where its numbers exceed what doubles can show.
    pub fn new(claim: &MachineClaim) -> Option<Self> {
        let model = Model::new(claim, PRECISION).ok()?;
        let frame = Frame::new(claim, &model)?;
        let legs = match &claim.mechanism {
            Mechanism::Translational([a, b, c]) => {
                [NominalLeg::middle(a)?, NominalLeg::middle(b)?, NominalLeg::middle(c)?]
            }
            Mechanism::Orthoglide { offset } => {
                let (e, length) = (approximate(offset)?, frame.unit);
                let base = frame.least[0] - e - length;
                [0, 1, 2].map(|i| NominalLeg::on_axis(i, base, e, length)).transposed()?
            }
        };
        let sizes = [frame.least, frame.width, [frame.unit; 3]];
        let offsets = legs.iter().map(|leg| leg.offset);
        if !sizes.into_iter().chain(offsets).flatten().all(|x| x.abs() < GREATEST) {
            return None;
        }
        Some(Nominal {
            legs,
            frame,
            is_cylinder: matches!(claim.workspace, Workspace::Cylinder { .. }),
            is_cube: matches!(claim.workspace, Workspace::Cube { .. }),
            slice: if matches!(claim.workspace, Workspace::Cube { .. }) { 0.0 } else { 0.5 },
        })
    }

    /// `P` for parts `u` of the workspace.
    pub fn point(&self, u: Point) -> Point {
        self.frame.point(&u)
    }

    /// The vector `w_i` of every leg.
    fn leg_vectors(&self, p: Point) -> [Vector<Approx>; 3] {
        from_fn(|i| from_fn(|k| Approx(p[k] + self.legs[i].offset[k])))
    }

    /// `psi_1 <= psi_2 <= psi_3` at `P`; `None` out of reach.
    pub fn psi(&self, p: Point) -> Option<Point> {
        let w = self.leg_vectors(p);
        let row = |i: usize| self.legs[i].kinematics.at(&w[i]).map(|state| state.row);
        let rows = [row(0)?, row(1)?, row(2)?];
        let mut xi: Point = Matrix3::from_fn(|i, j| rows[i][j].0).singular_values().into();
        xi.sort_by(|a, b| b.total_cmp(a));
        Some(xi.map(f64::recip))
    }

    /// Positive exactly where every leg reaches `P`.
    pub fn clearance(&self, p: Point) -> f64 {
        let w = self.leg_vectors(p);
        let of = |i: usize| self.legs[i].kinematics.clearance(&w[i]).0;
        (0..3).map(of).fold(f64::INFINITY, f64::min)
    }

    /// The scale of the maps of `psi_1`, `psi_2`, `psi_3`; `None` where no sampled point is reached.
    pub fn scale(&self) -> Option<Scale> {
        let part = |i: usize| i as f64 / (SAMPLES - 1) as f64;
        let mut found = vec![Vec::new(); 3];
        for n in 0..SAMPLES.pow(3) {
            let u = [n % SAMPLES, n / SAMPLES % SAMPLES, n / SAMPLES / SAMPLES].map(part);
            if self.is_cylinder && (2.0 * u[0] - 1.0).hypot(2.0 * u[1] - 1.0) > 1.0 {
                continue;
            }
            let psi = self.psi(self.point(u)).filter(|psi| psi.iter().all(|x| x.is_normal()));
            for (all, x) in found.iter_mut().zip(psi.into_iter().flatten()) {
                all.push(x);
            }
        }
        Scale::over(found)
    }

    /// The maps of `psi_1`, `psi_2`, `psi_3` in the plane of the slice.
    pub fn maps(&self, scale: &Scale, marks: &[Mark]) -> Vec<Picture> {
        let Frame { least, width, .. } = &self.frame;
        let z = self.point([0.0, 0.0, self.slice])[2];
        let [least_xy, width_xy] = [least, width].map(|all| [all[0], all[1]]);
        let plane = Plane::new(least_xy, width_xy, ["x", "y"], self.is_cylinder, true);
        let out_of_reach = plane.field(NODES, |x, y| -self.clearance([x, y, z]));
        let marks: Vec<(&str, [f64; 2])> = marks
            .iter()
            .filter(|mark| (mark.position()[2] - z).abs() <= 1e-6 * width[2])
            .map(|mark| (mark.name.as_str(), [mark.at[0], mark.at[1]]))
            .collect();
        let names = [
            ("psi-1", "\u{3c8}\u{2081}", "least"),
            ("psi-2", "\u{3c8}\u{2082}", "middle"),
            ("psi-3", "\u{3c8}\u{2083}", "greatest"),
        ];
        let of = |(i, (name, symbol, which)): (usize, (&str, &str, &str))| {
            let psi = |x, y| self.psi([x, y, z]).map_or(f64::NAN, |psi| psi[i]);
            let z = significant(z, 6);
            let shown = Map {
                name,
                heading: &format!("{symbol}, the {which} factor"),
                title: format!(
                    "Lines of equal {symbol}, the {which} velocity transmission factor, at z = {z}"
                ),
                field: &plane.field(NODES, psi),
                out_of_reach: &out_of_reach,
                levels: &scale.maps[i],
                marks: &marks,
                script: Some(i),
            };
            map(&plane, &shown)
        };
        names.into_iter().enumerate().map(of).collect()
    }

    /// What a drawing shows. The platform is at the origin if that is in the workspace, else in its
    /// middle.
    pub fn shape(&self) -> Shape {
        let frame = &self.frame;
        let inside = |k: usize| frame.least[k] <= 0.0 && 0.0 <= frame.least[k] + frame.width[k];
        let at_origin = self.is_cube && (0..3).all(inside);
        let grid = |n: u32| [n % 3, n / 3 % 3, n / 9].map(|i| f64::from(i) / 2.0);
        Shape {
            legs: self.legs.iter().map(|leg| leg.numbers.clone()).collect(),
            position: if at_origin { [0.0; 3] } else { self.point([0.5; 3]) },
            rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            outline: Outline::of(frame.least, frame.width, self.is_cylinder),
            places: (0..27).map(|n| self.point(grid(n))).collect(),
            bodies: [Vec::new(), Vec::new()],
            is_flat: false,
        }
    }
}

/// Three optional values as one.
trait Transposed<T> {
    fn transposed(self) -> Option<[T; 3]>;
}

impl<T> Transposed<T> for [Option<T>; 3] {
    fn transposed(self) -> Option<[T; 3]> {
        let [a, b, c] = self;
        Some([a?, b?, c?])
    }
}

impl NominalLeg {
    /// The leg with every parameter in the middle of its tolerance.
    fn middle(leg: &claim::Leg) -> Option<Self> {
        let middle = |q: &Quantity| {
            let (min, max) = (approximate(&q.min)?, approximate(&q.max)?);
            Some(if q.is_exact() { min } else { min + (max - min) / 2.0 })
        };
        let values: Option<Vec<f64>> = leg.parameters().iter().map(|(_, q)| middle(q)).collect();
        NominalLeg::new(leg, &values?)
    }

    /// Leg `i` of the Orthoglide.
    fn on_axis(i: usize, base: f64, offset: f64, length: f64) -> Option<Self> {
        let zero = || Quantity::exactly(Exact::integer(0));
        let vector = || [zero(), zero(), zero()];
        let slider = claim::Leg::Slider {
            direction: vector(),
            anchor: vector(),
            platform: vector(),
            length: zero(),
            mode: Sign::Plus,
        };
        let mut values = vec![0.0; 10];
        (values[i], values[3 + i], values[6 + i], values[9]) = (1.0, base, -offset, length);
        NominalLeg::new(&slider, &values)
    }

    fn new(leg: &claim::Leg, values: &[f64]) -> Option<Self> {
        let approximate: Vec<Approx> = values.iter().map(|x| Approx(*x)).collect();
        let (kinematics, offset) = Leg::new(leg, &approximate)?;
        let numbers = numbers(leg, values)?;
        Some(NominalLeg { numbers, kinematics, offset: offset.map(|x| x.0) })
    }
}

/// The numbers of a leg from its parameters, in their order.
fn numbers(leg: &claim::Leg, values: &[f64]) -> Option<Numbers> {
    let sign = |mode: &Sign| if *mode == Sign::Plus { 1.0 } else { -1.0 };
    Some(match (leg, values) {
        (claim::Leg::Slider { mode, .. }, &[nx, ny, nz, ax, ay, az, dx, dy, dz, length]) => {
            Numbers::Slider {
                direction: unit([nx, ny, nz])?,
                anchor: [ax, ay, az],
                platform: [dx, dy, dz],
                length,
                mode: sign(mode),
            }
        }
        (claim::Leg::Strut { .. }, &[ax, ay, az, dx, dy, dz]) => {
            Numbers::Strut { anchor: [ax, ay, az], platform: [dx, dy, dz] }
        }
        (
            claim::Leg::Arm { mode, .. },
            &[kx, ky, kz, ex, ey, ez, ax, ay, az, dx, dy, dz, arm, length],
        ) => {
            let axis = unit([kx, ky, kz])?;
            let reference = [ex, ey, ez];
            Numbers::Arm {
                axis,
                reference: across(reference, axis)?,
                anchor: [ax, ay, az],
                platform: [dx, dy, dz],
                arm,
                length,
                mode: sign(mode),
            }
        }
        (claim::Leg::Planar { .. }, &[nx, ny, nz]) => {
            Numbers::Planar { direction: unit([nx, ny, nz])? }
        }
        _ => return None,
    })
}

/// A claim about three translating legs, of which the bounds on `psi` alone are kept, in the form that
/// a nominal machine is made of.
pub fn of_kernel(claim: &kernel::MachineClaim) -> Option<MachineClaim> {
    let mechanism = match &claim.mechanism {
        kernel::Mechanism::Orthoglide { offset } => {
            Mechanism::Orthoglide { offset: exactly(offset)? }
        }
        kernel::Mechanism::Translational(legs) => {
            let legs: Vec<claim::Leg> = legs.iter().map(leg).collect::<Option<_>>()?;
            Mechanism::Translational(legs.try_into().ok()?)
        }
        _ => return None,
    };
    let point = |x: &[Expression]| -> Option<[Exact; 3]> {
        x.iter().map(exactly).collect::<Option<Vec<_>>>()?.try_into().ok()
    };
    let workspace = match &claim.workspace {
        kernel::Workspace::Box { min, max } => {
            Workspace::Box { min: point(min)?, max: point(max)? }
        }
        kernel::Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            Workspace::Cylinder {
                center: [exactly(x)?, exactly(y)?],
                radius: exactly(radius)?,
                z: [exactly(low)?, exactly(high)?],
            }
        }
        kernel::Workspace::Cube { side } => Workspace::Cube { side: exactly(side)? },
    };
    let mut transmission = Range { min: None, max: None };
    for requirement in claim.require.iter().filter(|own| own.quantity == "transmission") {
        match &requirement.bound {
            kernel::Bound::Max(max) => transmission.max = exactly(max),
            // The paper's cube has the other end by definition.
            kernel::Bound::Min(min) if !matches!(workspace, Workspace::Cube { .. }) => {
                transmission.min = exactly(min);
            }
            _ => {}
        }
    }
    let asked = transmission.min.is_some() || transmission.max.is_some();
    let transmission = asked.then_some(transmission);
    let requirements = Requirements { transmission, ..Requirements::default() };
    Some(MachineClaim { mechanism, workspace, requirements })
}

fn leg(leg: &kernel::Leg) -> Option<claim::Leg> {
    let number = |x: &kernel::Quantity| {
        let [min, max] = x.ends();
        Some(Quantity { min: exactly(min)?, max: exactly(max)? })
    };
    let vector = |x: &[kernel::Quantity]| -> Option<[Quantity; 3]> {
        x.iter().map(number).collect::<Option<Vec<_>>>()?.try_into().ok()
    };
    let mode = |sign: &kernel::Sign| match sign {
        kernel::Sign::Plus => Sign::Plus,
        kernel::Sign::Minus => Sign::Minus,
    };
    Some(match leg {
        kernel::Leg::Slider { direction, anchor, platform, length, mode: sign } => {
            claim::Leg::Slider {
                direction: vector(direction)?,
                anchor: vector(anchor)?,
                platform: vector(platform)?,
                length: number(length)?,
                mode: mode(sign),
            }
        }
        kernel::Leg::Strut { anchor, platform, .. } => {
            claim::Leg::Strut { anchor: vector(anchor)?, platform: vector(platform)? }
        }
        kernel::Leg::Arm { axis, reference, anchor, platform, arm, length, mode: sign } => {
            claim::Leg::Arm {
                axis: vector(axis)?,
                reference: vector(reference)?,
                anchor: vector(anchor)?,
                platform: vector(platform)?,
                arm: number(arm)?,
                length: number(length)?,
                mode: mode(sign),
            }
        }
        kernel::Leg::Planar { direction } => claim::Leg::Planar { direction: vector(direction)? },
    })
}

/// The Orthoglide with `L = 1` that the postulate for a single `psi_max` is about.
pub fn of_postulate(claim: &PostulateClaim) -> Option<MachineClaim> {
    let PsiMax::Of(kernel::Quantity::Exactly(psi)) = &claim.psi_max else {
        return None;
    };
    let psi = Exact::parse(&psi.to_string(), MAX_DIGITS).ok()?;
    let cube = CubeConstants::new(&psi, &Exact::integer(1)).ok()?;
    let side = cube.q2.minus(cube.q1).ok()?;
    let transmission = Some(Range { min: None, max: Some(psi) });
    Some(MachineClaim {
        mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
        workspace: Workspace::Cube { side },
        requirements: Requirements { transmission, ..Requirements::default() },
    })
}
