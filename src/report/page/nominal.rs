//! Three translating legs in doubles, every parameter in the middle of its tolerance: their
//! transmission factors, as the page's script computes them. Nothing of it is a proof.

use super::isomap::{map, Map, Mark, Plane, Scale, NODES};
use super::legs::{Numbers, Point};
use super::shape::{frame, shape};
use super::svg::Picture;
use crate::exact::decimal::significant;
use nalgebra::Matrix3;
use orthocert_kernel::claim::{
    Bound, Leg, MachineClaim, Mechanism, PostulateClaim, PsiMax, Quantity, Requirement, Workspace,
};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::prover::written_out;
use std::array::from_fn;
use std::collections::BTreeMap;

/// Places along every axis from which the levels of maps are chosen.
const SAMPLES: usize = 9;

/// The nominal machine and its workspace.
#[derive(Clone, Debug)]
pub struct Nominal {
    /// The legs.
    pub legs: [Numbers; 3],
    /// The least corner of the workspace's bounding box.
    pub least: Point,
    /// Its edges.
    pub width: Point,
    /// Whether the workspace is the cylinder inscribed in the box.
    pub is_cylinder: bool,
    /// Whether the workspace is the paper's cube, with the corners `Q_1` and `Q_2`.
    pub is_cube: bool,
    /// The place, in parts of the workspace, in whose plane the fixed maps are cut.
    pub slice: f64,
}

impl Nominal {
    /// The nominal machine of a claim about three translating legs; `None` of others, and where its
    /// numbers exceed what doubles can show.
    pub fn new(claim: &MachineClaim) -> Option<Self> {
        let (Mechanism::Translational(_) | Mechanism::Orthoglide { .. }) = claim.mechanism else {
            return None;
        };
        let legs = shape(claim)?.legs.try_into().ok()?;
        let (least, width) = frame(claim)?;
        let is_cube = matches!(claim.workspace, Workspace::Cube { .. });
        Some(Nominal {
            legs,
            least,
            width,
            is_cylinder: matches!(claim.workspace, Workspace::Cylinder { .. }),
            is_cube,
            slice: if is_cube { 0.0 } else { 0.5 },
        })
    }

    /// `P` for parts `u` of the workspace.
    pub fn point(&self, u: Point) -> Point {
        from_fn(|k| self.least[k] + self.width[k] * u[k])
    }

    /// `psi_1 <= psi_2 <= psi_3` at `P`; `None` out of reach.
    pub fn psi(&self, p: Point) -> Option<Point> {
        let [a, b, c] = self.legs.each_ref().map(|leg| leg.row(p));
        let rows = [a?, b?, c?];
        let mut xi: Point = Matrix3::from_fn(|i, j| rows[i][j]).singular_values().into();
        xi.sort_by(|a, b| b.total_cmp(a));
        Some(xi.map(f64::recip))
    }

    /// Positive exactly where every leg reaches `P`.
    pub fn clearance(&self, p: Point) -> f64 {
        self.legs.iter().map(|leg| leg.clearance(p)).fold(f64::INFINITY, f64::min)
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

    /// The part of the workspace's edge at which a coordinate is.
    pub fn part(&self, axis: usize, x: f64) -> f64 {
        match self.width[axis] {
            width if width > 0.0 => ((x - self.least[axis]) / width).clamp(0.0, 1.0),
            _ => self.slice,
        }
    }

    /// The maps of `psi_1`, `psi_2`, `psi_3` in the plane of the slice.
    pub fn maps(&self, scale: &Scale, marks: &[Mark]) -> Vec<Picture> {
        let Nominal { least, width, .. } = self;
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
}

/// The Orthoglide with `L = 1` that the postulate for a single `psi_max` is about.
pub fn of_postulate(claim: &PostulateClaim) -> Option<MachineClaim> {
    let PsiMax::Of(Quantity::Exactly(psi)) = &claim.psi_max else {
        return None;
    };
    let of_side = |side| MachineClaim {
        mechanism: Mechanism::Orthoglide { offset: Expression::integer(0) },
        workspace: Workspace::Cube { side },
        orientation: None,
        bodies: Vec::new(),
        require: vec![Requirement {
            quantity: "transmission".to_owned(),
            leg: None,
            given: BTreeMap::new(),
            bound: Bound::Max(psi.clone()),
        }],
    };
    let one = Expression::integer(1);
    // The length for the side 1: lengths are proportional to sides.
    let written = written_out(&of_side(one.clone())).ok()?;
    let Some(Leg::Slider { length: Quantity::Exactly(length), .. }) =
        written.mechanism.legs().first()
    else {
        return None;
    };
    Some(of_side(Expression::Binary(Operator::Div, one.into(), length.clone().into())))
}
