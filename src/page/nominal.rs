//! The nominal machine of a claim in doubles: every parameter in the middle of its tolerance. It is
//! what the figures show; nothing of it is a proof.

use crate::decimal::approximate;
use crate::interval::Approx;
use crate::report::Frame;
use nalgebra::Matrix3;
use orthocert_checker::claim::{
    self, MachineClaim, Mechanism, PostulateClaim, PsiMax, Quantity, Range, Requirements, Sign,
    Workspace,
};
use orthocert_checker::kinematics::Leg;
use orthocert_checker::linear::Vector;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::number::Exact;
use serde::Serialize;
use std::array::from_fn;

/// Fractional bits in which the claim's numbers are enclosed before they become doubles.
const PRECISION: u32 = 128;

/// Lengths beyond this are not drawn: their powers would exceed the doubles.
const GREATEST: f64 = 1e60;

/// A point or a vector.
pub type Point = [f64; 3];

/// A leg's numbers, in the claim's unit of length; directions are unit vectors.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "drive", rename_all = "snake_case")]
pub enum Numbers {
    /// Leg of fixed length on a guide.
    Slider { direction: Point, anchor: Point, platform: Point, length: f64, mode: f64 },
    /// Extensible leg.
    Strut { anchor: Point, platform: Point },
    /// Leg of fixed length on a rotating arm.
    Arm {
        axis: Point,
        reference: Point,
        anchor: Point,
        platform: Point,
        arm: f64,
        length: f64,
        mode: f64,
    },
    /// Leg that holds the platform in a plane.
    Planar { direction: Point },
}

/// A leg: its numbers, its kinematics, and the vector `d_i - a_i`.
#[derive(Clone, Debug)]
pub struct NominalLeg {
    /// Its numbers.
    pub numbers: Numbers,
    kinematics: Leg<Approx>,
    offset: Point,
}

/// Where a leg is.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// The end that is driven: `B_i` on the guide, the elbow, or the strut's joint on the base.
    pub driven: Point,
    /// The end on the platform, `C_i`.
    pub platform: Point,
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

    /// Where a leg is when the platform is at `P`; `None` out of reach. A planar leg has no place of
    /// its own: it is drawn from a guide beside the workspace.
    pub fn pose(&self, leg: usize, p: Point) -> Option<Pose> {
        let w = &self.leg_vectors(p)[leg];
        let NominalLeg { numbers, kinematics, .. } = &self.legs[leg];
        let unit = || kinematics.expand_unit(w, w).map(|(unit, _)| unit.map(|x| x.0));
        let ends = |platform: &Point, length: f64| -> Option<Pose> {
            let (unit, platform) = (unit()?, add(p, *platform));
            Some(Pose { driven: add(platform, scaled(-length, unit)), platform })
        };
        match numbers {
            Numbers::Slider { platform, length, .. } | Numbers::Arm { platform, length, .. } => {
                ends(platform, *length)
            }
            Numbers::Strut { anchor, platform } => {
                Some(Pose { driven: *anchor, platform: add(p, *platform) })
            }
            Numbers::Planar { direction } => {
                let beside = self.beside(*direction);
                let along = dot(*direction, add(p, scaled(-1.0, beside)));
                Some(Pose { driven: add(beside, scaled(along, *direction)), platform: p })
            }
        }
    }

    /// A point beside the workspace, for a guide in this direction.
    fn beside(&self, n: Point) -> Point {
        let centre = self.point([0.5; 3]);
        let away = [-1.0, -1.0, -1.0];
        let across = add(away, scaled(-dot(away, n), n));
        let size = self.frame.width.iter().copied().fold(0.0, f64::max);
        let norm = dot(across, across).sqrt();
        let across = if norm > 1e-6 { scaled(1.0 / norm, across) } else { [0.0, 0.0, -1.0] };
        add(centre, scaled(1.1 * size, across))
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
            let across = add(reference, scaled(-dot(reference, axis), axis));
            Numbers::Arm {
                axis,
                reference: unit(across)?,
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

/// The Orthoglide with `L = 1` that the postulate for a single `psi_max` is about.
pub fn of_postulate(claim: &PostulateClaim) -> Option<MachineClaim> {
    let PsiMax::Range(range) = &claim.psi_max else {
        return None;
    };
    if !range.is_exact() {
        return None;
    }
    let cube = CubeConstants::new(&range.min, &Exact::integer(1)).ok()?;
    let side = cube.q2.minus(cube.q1).ok()?;
    let transmission = Some(Range { min: None, max: Some(range.min.clone()) });
    Some(MachineClaim {
        mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
        workspace: Workspace::Cube { side },
        requirements: Requirements { transmission, ..Requirements::default() },
    })
}

/// `a + b`.
pub fn add(a: Point, b: Point) -> Point {
    from_fn(|k| a[k] + b[k])
}

/// `c a`.
pub fn scaled(c: f64, a: Point) -> Point {
    a.map(|x| c * x)
}

/// `a . b`.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: Point) -> Option<Point> {
    let norm = dot(a, a).sqrt();
    (norm > 0.0 && norm.is_finite()).then(|| scaled(1.0 / norm, a))
}
