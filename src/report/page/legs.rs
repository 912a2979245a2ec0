//! Legs in doubles, at places of their platform: what a drawing of a machine is made of.

use serde::Serialize;
use std::array::from_fn;

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

/// Where a leg is.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// The end that is driven: `B_i` on the guide, the elbow, or the strut's joint on the base.
    pub driven: Point,
    /// The end on the platform, `C_i`.
    pub platform: Point,
}

impl Numbers {
    /// The base end of the leg whose platform joint is at `joint`; `None` out of reach, and of planar
    /// legs, which have none.
    ///
    /// With `w = joint - anchor` it is `joint - A`, `A` the leg:
    ///
    /// ```text
    /// slider   A = r + eta n            r = w - (n . w) n, eta = m sqrt(L^2 - |r|^2)
    /// arm      A = (p alpha - m q beta) e + (p beta + m q alpha) f + kappa k
    ///          alpha = w . e, beta = w . f, kappa = k . w, f = k x e, N = alpha^2 + beta^2,
    ///          c = kappa^2 + r^2 - L^2, p = (1 - c/N)/2, q^2 = r^2/N - (1 + c/N)^2/4
    /// ```
    pub fn base_end(&self, joint: Point) -> Option<Point> {
        let from = |anchor: &Point| add(joint, scaled(-1.0, *anchor));
        let root = |x: f64| (x >= 0.0).then(|| x.sqrt());
        let leg = match self {
            Numbers::Strut { anchor, .. } => return Some(*anchor),
            Numbers::Planar { .. } => return None,
            Numbers::Slider { direction, anchor, length, mode, .. } => {
                let w = from(anchor);
                let r = add(w, scaled(-dot(*direction, w), *direction));
                let eta = mode * root(length * length - dot(r, r))?;
                add(r, scaled(eta, *direction))
            }
            Numbers::Arm { axis, reference, anchor, arm, length, mode, .. } => {
                let (w, across) = (from(anchor), cross(*axis, *reference));
                let [alpha, beta, kappa] = [*reference, across, *axis].map(|e| dot(e, w));
                let n = alpha * alpha + beta * beta;
                let share = (kappa * kappa + arm * arm - length * length) / n;
                let p = (1.0 - share) / 2.0;
                let q = mode * root(arm * arm / n - (1.0 + share) * (1.0 + share) / 4.0)?;
                let turned = add(
                    scaled(p * alpha - q * beta, *reference),
                    scaled(p * beta + q * alpha, across),
                );
                add(turned, scaled(kappa, *axis))
            }
        };
        let end = add(joint, scaled(-1.0, leg));
        end.iter().all(|x| x.is_finite()).then_some(end)
    }

    /// The row of `M` of a platform at `p` that does not turn, joint rates per velocity; `None` out of
    /// reach and at a serial singularity. With the leg `A` from the driven end to the platform it is
    ///
    /// ```text
    /// slider   A^T / (A . n)       strut   A^T / |A|       arm   A^T / (A . (k x u))       planar   n^T
    /// ```
    ///
    /// where `u` is the arm: joint rates are those at which the leg keeps its length.
    pub fn row(&self, p: Point) -> Option<Point> {
        if let Numbers::Planar { direction } = self {
            return Some(*direction);
        }
        let joint = add(p, self.platform());
        let end = self.base_end(joint)?;
        let leg = add(joint, scaled(-1.0, end));
        let along = match self {
            Numbers::Slider { direction, .. } => dot(leg, *direction),
            Numbers::Arm { axis, anchor, .. } => {
                dot(leg, cross(*axis, add(end, scaled(-1.0, *anchor))))
            }
            Numbers::Strut { .. } | Numbers::Planar { .. } => dot(leg, leg).sqrt(),
        };
        let row = scaled(1.0 / along, leg);
        row.iter().all(|x| x.is_finite()).then_some(row)
    }

    /// Positive exactly where the leg of a platform at `p` that does not turn reaches, without a serial
    /// singularity:
    ///
    /// ```text
    /// slider   L^2 - |r|^2         arm   L^2 - kappa^2 - (g - r)^2,  g = (|w|^2 + r^2 - L^2)/2r
    /// ```
    pub fn clearance(&self, p: Point) -> f64 {
        let from = |anchor: &Point| add(add(p, self.platform()), scaled(-1.0, *anchor));
        match self {
            Numbers::Planar { .. } => 1.0,
            Numbers::Strut { anchor, .. } => {
                let w = from(anchor);
                dot(w, w).sqrt()
            }
            Numbers::Slider { direction, anchor, length, .. } => {
                let w = from(anchor);
                let r = add(w, scaled(-dot(*direction, w), *direction));
                length * length - dot(r, r)
            }
            Numbers::Arm { axis, anchor, arm, length, .. } => {
                let w = from(anchor);
                let g = (dot(w, w) + arm * arm - length * length) / (2.0 * arm);
                length * length - dot(*axis, w).powi(2) - (g - arm).powi(2)
            }
        }
    }

    /// The platform's joint, in the platform's frame.
    pub fn platform(&self) -> Point {
        match self {
            Numbers::Slider { platform, .. }
            | Numbers::Strut { platform, .. }
            | Numbers::Arm { platform, .. } => *platform,
            Numbers::Planar { .. } => [0.0; 3],
        }
    }
}

/// The outline of a set of positions: a ring of points below, one above; one alone in the plane;
/// none where the platform only turns.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The rings.
    pub rings: Vec<Vec<Point>>,
    /// Whether they stand for circles.
    pub is_round: bool,
}

/// Corners of the polygon that stands for a circle.
const ROUND: usize = 72;

impl Outline {
    /// The outline of a box, or of the cylinder inscribed in it.
    pub fn of(least: Point, width: Point, is_round: bool) -> Self {
        let corners: Vec<[f64; 2]> = if is_round {
            let angle = |i: usize| (i as f64 / ROUND as f64 * std::f64::consts::TAU).sin_cos();
            let corner = |i| (0.5 + angle(i).1 / 2.0, 0.5 + angle(i).0 / 2.0);
            (0..ROUND).map(corner).map(<[f64; 2]>::from).collect()
        } else {
            vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        };
        let ring = |z: f64| {
            let place = |[x, y]: &[f64; 2]| from_fn(|k| least[k] + width[k] * [*x, *y, z][k]);
            corners.iter().map(place).collect()
        };
        Outline { rings: vec![ring(0.0), ring(1.0)], is_round }
    }
}

/// A machine as it is drawn.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its legs.
    pub legs: Vec<Numbers>,
    /// `P`.
    pub position: Point,
    /// The rows of `R`.
    pub rotation: [Point; 3],
    /// The positions of its workspace.
    pub outline: Outline,
    /// Positions that tell how long its guides are.
    pub places: Vec<Point>,
    /// Axes of its bodies on the base, and, in the platform's frame, on the platform.
    pub bodies: [Vec<[Point; 2]>; 2],
    /// Whether all of it is in the plane `z = 0`.
    pub is_flat: bool,
}

impl Shape {
    /// A point of the platform, in the base, when the platform is at `p`.
    pub fn carried(&self, p: Point, b: Point) -> Point {
        add(p, self.rotation.map(|row| dot(row, b)))
    }

    /// Where a leg is when the platform is at `p`; `None` out of reach. A planar leg has no place of
    /// its own: it is drawn from a guide beside the workspace.
    pub fn pose(&self, leg: usize, p: Point) -> Option<Pose> {
        let numbers = self.legs.get(leg)?;
        let platform = self.carried(p, numbers.platform());
        let driven = match numbers {
            Numbers::Planar { direction } => {
                let beside = self.beside(*direction);
                let along = dot(*direction, add(p, scaled(-1.0, beside)));
                add(beside, scaled(along, *direction))
            }
            _ => numbers.base_end(platform)?,
        };
        Some(Pose { driven, platform })
    }

    /// A point beside the workspace, for a guide in this direction.
    fn beside(&self, n: Point) -> Point {
        let ends = |f: fn(f64, f64) -> f64, start: f64| -> Point {
            from_fn(|k| self.places.iter().map(|p| p[k]).fold(start, f))
        };
        let (low, high) = (ends(f64::min, f64::MAX), ends(f64::max, f64::MIN));
        let centre: Point = from_fn(|k| low[k] + (high[k] - low[k]) * 0.5);
        let away = [-1.0, -1.0, -1.0];
        let across = add(away, scaled(-dot(away, n), n));
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let across = unit(across).unwrap_or([0.0, 0.0, -1.0]);
        add(centre, scaled(1.1 * size, across))
    }
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

/// `a x b`.
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a / |a|`; of zero, none.
pub fn unit(a: Point) -> Option<Point> {
    let norm = dot(a, a).sqrt();
    (norm > 1e-9 && norm.is_finite()).then(|| scaled(1.0 / norm, a))
}

/// The direction of a reference across an axis.
pub fn across(reference: Point, axis: Point) -> Option<Point> {
    unit(add(reference, scaled(-dot(reference, axis), axis)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: Point, b: Point) -> f64 {
        let d = add(a, scaled(-1.0, b));
        dot(d, d).sqrt()
    }

    /// The leg has its length; its base end is on the guide, or on the arm's circle; and it is on the
    /// side that its mode names.
    #[test]
    fn base_ends_close_the_legs() {
        let anchor = [0.3, -0.2, 0.1];
        for mode in [1.0, -1.0] {
            for joint in [[0.9, 0.4, -0.2], [-0.3, 0.8, 0.5], [0.1, -0.9, -0.6]] {
                let direction = unit([1.0, 2.0, -0.5]).unwrap();
                let platform = [0.0; 3];
                let slider = Numbers::Slider { direction, anchor, platform, length: 2.0, mode };
                let end = slider.base_end(joint).unwrap();
                assert!((distance(end, joint) - 2.0).abs() < 1e-12);
                let along = add(end, scaled(-1.0, anchor));
                assert!(cross(along, direction).iter().all(|x| x.abs() < 1e-12));
                let leg = add(joint, scaled(-1.0, end));
                assert!(mode * dot(leg, direction) > 0.0);

                let axis = unit([0.2, -0.4, 1.0]).unwrap();
                let reference = across([1.0, 0.0, 0.0], axis).unwrap();
                let (arm, length) = (1.0, 1.5);
                let rotary = Numbers::Arm { axis, reference, anchor, platform, arm, length, mode };
                let elbow = rotary.base_end(joint).unwrap();
                let radius = add(elbow, scaled(-1.0, anchor));
                assert!((distance(elbow, joint) - 1.5).abs() < 1e-12);
                assert!((dot(radius, radius) - 1.0).abs() < 1e-12);
                assert!(dot(radius, axis).abs() < 1e-12);
                let leg = add(joint, scaled(-1.0, elbow));
                assert!(mode * dot(leg, cross(axis, radius)) > 0.0, "the sign of eta");
            }
        }
        let strut = Numbers::Strut { anchor, platform: [0.0; 3] };
        assert_eq!(strut.base_end([1.0; 3]), Some(anchor));
        let far = Numbers::Slider {
            direction: [1.0, 0.0, 0.0],
            anchor,
            platform: [0.0; 3],
            length: 0.5,
            mode: 1.0,
        };
        assert_eq!(far.base_end([0.0, 5.0, 0.0]), None);
    }
}
