//! Kinematics of one leg: its row of `M = J^-1`, joint coordinate and slopes.
//!
//! A leg is met through `w = P + d_i - a_i` alone. Every drive supplies
//!
//! * [`Leg::at`]: its [`LegState`] at a point, or over a set of points when `w` is an interval;
//! * [`Leg::expand`]: the same at an expansion point `c`, with a *slope matrix* `S` over a box:
//!   for every `P` of the box, `row(P) - row(c) = S(P) (P - c)` and
//!   `rho(P) - rho(c) = rho_slope(P) . (P - c)`, with `S(P)` and `rho_slope(P)` enclosed.
//!
//! Lengths are in the model's unit, see [`crate::model`].

use crate::claim::{self, WorkingMode};
use crate::enclosure::Scalar;
use crate::linear::{add, apply, dot, norm_squared, scale, Matrix, Vector};
use std::array::from_fn;

/// The kinematics of one leg, its parameters fixed or enclosed.
#[derive(Clone, Debug)]
pub enum Leg<S> {
    /// Leg of fixed length on a linear guide.
    Slider(Slider<S>),
}

/// What a leg contributes at a point.
#[derive(Clone, Debug)]
pub struct LegState<S> {
    /// Row of `M = J^-1`.
    pub row: Vector<S>,
    /// `eta_i = (c_i - b_i) . n_i`; zero exactly at a serial singularity.
    pub eta: S,
    /// Joint coordinate.
    pub rho: S,
}

/// What a leg contributes over a box, as an expansion about a point of it.
#[derive(Clone, Debug)]
pub struct LegExpansion<S> {
    /// Row of `M` at the expansion point.
    pub row: Vector<S>,
    /// Slope matrix of the row: `slope[j][k]` belongs to entry `j` of the row and coordinate `k`.
    pub slope: Matrix<S>,
    /// Joint coordinate at the expansion point.
    pub rho: S,
    /// Slope of the joint coordinate.
    pub rho_slope: Vector<S>,
}

impl<S: Scalar> Leg<S> {
    /// The kinematics of a leg of the claim, and the vector `d_i - a_i`, for these values of its
    /// [parameters](claim::Leg::parameters), in their order; `None` if a direction may be zero.
    pub fn new(leg: &claim::Leg, parameters: &[S]) -> Option<(Self, Vector<S>)> {
        match (leg, parameters) {
            (claim::Leg::Slider { mode, .. }, [nx, ny, nz, ax, ay, az, dx, dy, dz, length]) => {
                let direction = [nx.clone(), ny.clone(), nz.clone()];
                let slider = Slider::new(&direction, length, *mode)?;
                Some((Leg::Slider(slider), [dx.sub(ax), dy.sub(ay), dz.sub(az)]))
            }
            _ => None,
        }
    }

    /// The leg's state at `w`; `None` unless it certainly reaches `w` and is certainly not
    /// serially singular there.
    pub fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        match self {
            Leg::Slider(leg) => leg.at(w),
        }
    }

    /// The leg's expansion about `centre` over `over`, which must contain it; `None` unless the leg
    /// certainly reaches all of `over` without a serial singularity.
    pub fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        match self {
            Leg::Slider(leg) => leg.expand(centre, over),
        }
    }

    /// A quantity that is positive exactly where the leg reaches `w` and is not serially singular.
    pub fn clearance(&self, w: &Vector<S>) -> S {
        match self {
            Leg::Slider(leg) => leg.s_squared(&leg.r(w)),
        }
    }
}

/// A leg of fixed length `L` on a linear guide of unit direction `n` (the paper's equations (1) to
/// (3); theory: inverse kinematics of a `P-Pa` leg):
///
/// ```text
/// r   = w - (n . w) n          s = sqrt(L^2 - |r|^2)      eta = mode s
/// rho = n . w - eta            c - b = r + eta n           row of M = (c - b)^T / eta = n + r / eta
/// ```
#[derive(Clone, Debug)]
pub struct Slider<S> {
    /// Unit direction `n` of the guide.
    n: Vector<S>,
    /// `I - n n^T`.
    projector: Matrix<S>,
    /// `L^2`.
    length_squared: S,
    /// The sign of `eta`, +1 or -1.
    mode: S,
}

impl<S: Scalar> Slider<S> {
    /// The leg with this guide direction (of any length but zero) and leg length; `None` if the
    /// direction may be zero.
    pub fn new(direction: &Vector<S>, length: &S, mode: WorkingMode) -> Option<Self> {
        let norm = norm_squared(direction).sqrt()?;
        let n: Vector<S> =
            [direction[0].div(&norm)?, direction[1].div(&norm)?, direction[2].div(&norm)?];
        let projector = from_fn(|i| {
            from_fn(|j| {
                let identity = length.integer_like(i64::from(i == j));
                identity.sub(&if i == j { n[i].sqr() } else { n[i].mul(&n[j]) })
            })
        });
        let mode = length.integer_like(mode.as_integer());
        Some(Slider { n, projector, length_squared: length.sqr(), mode })
    }

    fn r(&self, w: &Vector<S>) -> Vector<S> {
        apply(&self.projector, w)
    }

    fn s_squared(&self, r: &Vector<S>) -> S {
        self.length_squared.sub(&norm_squared(r))
    }

    fn state(&self, w: &Vector<S>, r: &Vector<S>, s: &S) -> Option<LegState<S>> {
        let eta = self.mode.mul(s);
        let row = add(&self.n, &scale(&eta.recip()?, r));
        Some(LegState { row, rho: dot(&self.n, w).sub(&eta), eta })
    }

    fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        let r = self.r(w);
        let s = self.s_squared(&r).sqrt()?;
        self.state(w, &r, &s)
    }

    /// With subscript `c` at the expansion point and `K = s s_c (s + s_c)`:
    ///
    /// ```text
    /// 1/s - 1/s_c = (s_c^2 - s^2) / K = (|r|^2 - |r_c|^2) / K = (r + r_c) . (P - c) / K
    /// r/s - r_c/s_c = (r - r_c)/s + r_c (1/s - 1/s_c)
    /// =>  S         = mode (Pi / s + r_c (r + r_c)^T / K)        Pi = I - n n^T
    ///     rho_slope = n + mode (r + r_c) / (s + s_c)
    /// ```
    ///
    /// since `r - r_c = Pi (P - c)` and `Pi (r + r_c) = r + r_c`. One identity per entry; none is
    /// intersected with another.
    fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        let (r_c, r) = (self.r(centre), self.r(over));
        let s_c = self.s_squared(&r_c).sqrt()?;
        let s = self.s_squared(&r).sqrt()?;
        let at_centre = self.state(centre, &r_c, &s_c)?;
        let s_sum = s.add(&s_c);
        let r_sum = add(&r, &r_c);
        let inverse_s = self.mode.mul(&s.recip()?);
        let inverse_k = self.mode.mul(&s.mul(&s_c).mul(&s_sum).recip()?);
        let slope = from_fn(|j| {
            let factor = r_c[j].mul(&inverse_k);
            from_fn(|k| self.projector[j][k].mul(&inverse_s).add(&factor.mul(&r_sum[k])))
        });
        let rho_slope = add(&self.n, &scale(&self.mode.mul(&s_sum.recip()?), &r_sum));
        Some(LegExpansion { row: at_centre.row, slope, rho: at_centre.rho, rho_slope })
    }
}

impl<S> Leg<S> {
    /// The same leg in another arithmetic; `convert` must enclose.
    pub fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Leg<T> {
        let vector = |v: &Vector<S>| from_fn(|k| convert(&v[k]));
        match self {
            Leg::Slider(leg) => Leg::Slider(Slider {
                n: vector(&leg.n),
                projector: from_fn(|j| vector(&leg.projector[j])),
                length_squared: convert(&leg.length_squared),
                mode: convert(&leg.mode),
            }),
        }
    }
}
