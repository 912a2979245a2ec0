//! What is true of a machine at a point, in floating point, from the geometry of its legs: joints
//! are found by solving for them, and rows of `M` by differentiating the leg's constant length.
//! None of the checker's formulas is used.

use super::random::Random;
use num_rational::BigRational;
use orthocert_checker::claim::{self, Quantity, Sign};
use orthocert_checker::number::Exact;

pub type V = [f64; 3];

pub fn exact(x: f64) -> Exact {
    Exact::Rational(BigRational::from_float(x).expect("finite"))
}

pub fn add(a: V, b: V) -> V {
    std::array::from_fn(|k| a[k] + b[k])
}

pub fn scale(c: f64, a: V) -> V {
    a.map(|x| c * x)
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn unit(a: V) -> V {
    scale(1.0 / dot(a, a).sqrt(), a)
}

pub fn determinant(m: &[V; 3]) -> f64 {
    dot(m[0], cross(m[1], m[2]))
}

/// A leg in numbers.
#[derive(Clone, Copy, Debug)]
pub enum Leg {
    Slider { direction: V, anchor: V, platform: V, length: f64, mode: f64 },
    Strut { anchor: V, platform: V },
    Arm { axis: V, reference: V, anchor: V, platform: V, arm: f64, length: f64, mode: f64 },
    Planar { direction: V },
}

/// The truth about a leg at a point that it reaches.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub row: V,
    /// A length, or an angle in degrees.
    pub rho: f64,
    /// `|eta| / L`; none for legs without a length.
    pub cosine: Option<f64>,
    /// The unit leg vector.
    pub unit: V,
}

impl Leg {
    fn w(&self, p: V) -> V {
        match *self {
            Leg::Slider { anchor, platform, .. }
            | Leg::Strut { anchor, platform }
            | Leg::Arm { anchor, platform, .. } => add(p, add(platform, scale(-1.0, anchor))),
            Leg::Planar { .. } => p,
        }
    }

    /// How far within reach the point is: the distance from the boundary, relative to the leg.
    pub fn reach(&self, p: V) -> f64 {
        let w = self.w(p);
        match *self {
            Leg::Slider { direction, length, .. } => {
                let n = unit(direction);
                let off = cross(n, w);
                1.0 - dot(off, off) / (length * length)
            }
            Leg::Strut { .. } => dot(w, w).sqrt(),
            Leg::Arm { axis, arm, length, .. } => {
                // In the arm's plane: circles of radius r about the axis, and of radius
                // sqrt(L^2 - along^2) about h, that have to meet.
                let k = unit(axis);
                let along = dot(k, w);
                let off = cross(k, w);
                let (far, within) = (dot(off, off).sqrt(), length * length - along * along);
                if within <= 0.0 {
                    return within / (length * length);
                }
                let radius = within.sqrt();
                ((arm + radius) - far).min(far - (arm - radius).abs()) / length
            }
            Leg::Planar { .. } => 1.0,
        }
    }

    pub fn at(&self, p: V) -> State {
        let w = self.w(p);
        match *self {
            Leg::Slider { direction, length, mode, .. } => {
                let n = unit(direction);
                // |w - rho n|^2 = L^2, a quadratic equation for rho.
                let (half, rest) = (dot(n, w), dot(w, w) - length * length);
                let rho = half - mode * (half * half - rest).sqrt();
                let leg = add(w, scale(-rho, n));
                let eta = dot(leg, n);
                assert!(eta * mode > 0.0);
                State {
                    row: scale(1.0 / eta, leg),
                    rho,
                    cosine: Some(eta.abs() / length),
                    unit: scale(1.0 / length, leg),
                }
            }
            Leg::Strut { .. } => {
                State { row: unit(w), rho: dot(w, w).sqrt(), cosine: None, unit: unit(w) }
            }
            Leg::Arm { axis, reference, arm, length, mode, .. } => {
                let k = unit(axis);
                let e = unit(add(reference, scale(-dot(k, reference), k)));
                let f = cross(k, e);
                // |w - r (e cos + f sin)| = L: a phase and the angle about it.
                let phase = dot(w, f).atan2(dot(w, e));
                let g = (dot(w, w) + arm * arm - length * length) / (2.0 * arm);
                let about = (g / dot(w, e).hypot(dot(w, f))).acos();
                for theta in [phase + about, phase - about] {
                    let leg =
                        add(w, scale(-arm, add(scale(theta.cos(), e), scale(theta.sin(), f))));
                    let motion = scale(arm, add(scale(-theta.sin(), e), scale(theta.cos(), f)));
                    let driven = dot(leg, motion);
                    if driven * mode > 0.0 {
                        return State {
                            row: scale(1.0 / driven, leg),
                            rho: theta.to_degrees(),
                            cosine: Some(driven.abs() / (arm * length)),
                            unit: scale(1.0 / length, leg),
                        };
                    }
                }
                unreachable!("one of the two solutions has the working mode");
            }
            Leg::Planar { direction } => {
                let n = unit(direction);
                State { row: n, rho: dot(n, p), cosine: None, unit: n }
            }
        }
    }

    /// The leg in a claim.
    pub fn claimed(&self) -> claim::Leg {
        let number = |x: f64| Quantity::exactly(exact(x));
        let vector = |v: V| v.map(number);
        let sign = |mode: f64| if mode > 0.0 { Sign::Plus } else { Sign::Minus };
        match *self {
            Leg::Slider { direction, anchor, platform, length, mode } => claim::Leg::Slider {
                direction: vector(direction),
                anchor: vector(anchor),
                platform: vector(platform),
                length: number(length),
                mode: sign(mode),
            },
            Leg::Strut { anchor, platform } => {
                claim::Leg::Strut { anchor: vector(anchor), platform: vector(platform) }
            }
            Leg::Arm { axis, reference, anchor, platform, arm, length, mode } => claim::Leg::Arm {
                axis: vector(axis),
                reference: vector(reference),
                anchor: vector(anchor),
                platform: vector(platform),
                arm: number(arm),
                length: number(length),
                mode: sign(mode),
            },
            Leg::Planar { direction } => claim::Leg::Planar { direction: vector(direction) },
        }
    }

    /// The leg in a unit of length `2^-exponent` of the former.
    pub fn scaled(&self, by: f64) -> Leg {
        let mut leg = *self;
        match &mut leg {
            Leg::Slider { anchor, platform, length, .. } => {
                (*anchor, *platform) = (scale(by, *anchor), scale(by, *platform));
                *length *= by;
            }
            Leg::Strut { anchor, platform } => {
                (*anchor, *platform) = (scale(by, *anchor), scale(by, *platform));
            }
            Leg::Arm { anchor, platform, arm, length, .. } => {
                (*anchor, *platform) = (scale(by, *anchor), scale(by, *platform));
                *arm *= by;
                *length *= by;
            }
            Leg::Planar { .. } => {}
        }
        leg
    }

    fn random(random: &mut Random, kind: u64) -> Leg {
        let mode = if random.coin() { 1.0 } else { -1.0 };
        let (anchor, platform) = (random.vector(1.0), random.vector(0.25));
        match kind {
            0 => {
                let length = random.between(0.5, 2.0);
                Leg::Slider { direction: random.vector(3.0), anchor, platform, length, mode }
            }
            1 => Leg::Strut { anchor, platform },
            2 => Leg::Planar { direction: random.vector(3.0) },
            _ => {
                let (arm, length) = (random.between(0.2, 1.5), random.between(0.5, 2.0));
                let (axis, reference) = (random.vector(3.0), random.vector(3.0));
                Leg::Arm { axis, reference, anchor, platform, arm, length, mode }
            }
        }
    }
}

/// A random machine and a point that each of its legs reaches by more than `margin`.
pub fn machine(random: &mut Random, margin: f64) -> ([Leg; 3], V) {
    let family = random.below(4);
    loop {
        let legs: [Leg; 3] = std::array::from_fn(|_| {
            let kind = match family {
                0 => 0,
                1 => 3,
                2 => 1,
                _ => random.below(3),
            };
            Leg::random(random, kind)
        });
        let p = random.vector(0.5);
        if legs.iter().all(|leg| leg.reach(p) > margin) {
            return (legs, p);
        }
    }
}

/// Ascending singular values of `m` and its right singular vectors (Jacobi on `m^T m`).
pub fn singular(m: &[V; 3]) -> (V, [V; 3]) {
    let column = |j: usize| [m[0][j], m[1][j], m[2][j]];
    let mut t: [V; 3] = std::array::from_fn(|i| std::array::from_fn(|j| dot(column(i), column(j))));
    let mut v: [V; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..30 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if t[p][q] == 0.0 {
                continue;
            }
            let angle = (2.0 * t[p][q]).atan2(t[q][q] - t[p][p]) / 2.0;
            let (s, c) = angle.sin_cos();
            for row in t.iter_mut().chain(&mut v) {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (a, b) = (t[p], t[q]);
            for k in 0..3 {
                (t[p][k], t[q][k]) = (c * a[k] - s * b[k], s * a[k] + c * b[k]);
            }
        }
    }
    let vector = |j: usize| [v[0][j], v[1][j], v[2][j]];
    let image = |x: V| [dot(m[0], x), dot(m[1], x), dot(m[2], x)];
    let mut order: [(f64, V); 3] =
        [0, 1, 2].map(|j| (dot(image(vector(j)), image(vector(j))).sqrt(), vector(j)));
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    (order.map(|(x, _)| x), order.map(|(_, x)| x))
}

/// The transpose of the orthogonal polar factor, by Newton's iteration.
pub fn rotation(m: &[V; 3]) -> [V; 3] {
    let mut x = *m;
    for _ in 0..60 {
        let det = determinant(&x);
        // The inverse transpose has the rows (x_j x x_k) / det.
        let inverse: [V; 3] =
            std::array::from_fn(|i| scale(1.0 / det, cross(x[(i + 1) % 3], x[(i + 2) % 3])));
        x = std::array::from_fn(|i| scale(0.5, add(x[i], inverse[i])));
    }
    std::array::from_fn(|i| std::array::from_fn(|j| x[j][i]))
}
