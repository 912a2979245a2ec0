//! Kinematics of one leg: its row of `M = J^-1`, joint coordinate and slopes.
//!
//! A leg is met through `w = P + d_i - a_i` alone. Every drive supplies
//!
//! * [`Leg::at`]: its [`LegState`] at a point, or over a set of points when `w` is an interval;
//! * [`Leg::expand`]: its row and joint coordinate at an expansion point `c`, with a *slope matrix*
//!   `S` over a box: for every `P` of the box, `row(P) - row(c) = S(P) (P - c)`, `S(P)` enclosed;
//! * [`Leg::clearance`] and [`Leg::cosine_squared`]: how far it is from its serial singularity;
//! * [`Leg::expand_unit`]: its unit vector in the same way as its row.
//!
//! A drive has a file of its own; a new one adds an arm to the matches of this file. Lengths are in
//! the model's unit, see [`crate::model`].

mod arm;
mod planar;
mod slider;
mod strut;

use crate::claim;
use crate::enclosure::Scalar;
use crate::linear::{Matrix, Vector};
use std::array::from_fn;

pub use arm::Arm;
pub use planar::Planar;
pub use slider::Slider;
pub use strut::Strut;

/// The kinematics of one leg, its parameters fixed or enclosed.
#[derive(Clone, Debug)]
pub enum Leg<S> {
    /// Leg of fixed length on a linear guide.
    Slider(Slider<S>),
    /// Extensible leg.
    Strut(Strut<S>),
    /// Leg of fixed length on a rotating arm.
    Arm(Arm<S>),
    /// Leg that constrains the platform to a plane.
    Planar(Planar<S>),
}

/// A joint coordinate.
#[derive(Clone, Debug)]
pub enum JointCoordinate<S> {
    /// A length.
    Length(S),
    /// An angle, by its cosine and sine.
    Angle {
        /// `cos(theta)`.
        cos: S,
        /// `sin(theta)`.
        sin: S,
    },
}

impl<S> JointCoordinate<S> {
    /// The length, if it is one.
    pub fn length(&self) -> Option<&S> {
        match self {
            JointCoordinate::Length(rho) => Some(rho),
            JointCoordinate::Angle { .. } => None,
        }
    }
}

/// What a leg contributes at a point.
#[derive(Clone, Debug)]
pub struct LegState<S> {
    /// Row of `M = J^-1`.
    pub row: Vector<S>,
    /// Component of the leg vector along the motion of its driven end; zero exactly at a serial
    /// singularity. For struts, whose driven motion is along the leg, its length.
    pub eta: S,
    /// Joint coordinate.
    pub rho: JointCoordinate<S>,
}

/// What a leg contributes over a box, as an expansion about a point of it.
#[derive(Clone, Debug)]
pub struct LegExpansion<S> {
    /// Row of `M` at the expansion point.
    pub row: Vector<S>,
    /// Slope matrix of the row: `slope[j][k]` belongs to entry `j` of the row and coordinate `k`.
    pub slope: Matrix<S>,
    /// Joint coordinate at the expansion point and its slope; none for an angle.
    pub rho: Option<(S, Vector<S>)>,
}

/// A unit leg vector at the expansion point, and its slope matrix over a box.
pub type UnitExpansion<S> = (Vector<S>, Matrix<S>);

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
            (claim::Leg::Strut { .. }, [ax, ay, az, dx, dy, dz]) => {
                Some((Leg::Strut(Strut::new(ax)), [dx.sub(ax), dy.sub(ay), dz.sub(az)]))
            }
            (
                claim::Leg::Arm { mode, .. },
                [kx, ky, kz, ex, ey, ez, ax, ay, az, dx, dy, dz, arm, length],
            ) => {
                let axis = [kx.clone(), ky.clone(), kz.clone()];
                let reference = [ex.clone(), ey.clone(), ez.clone()];
                let arm = Arm::new(&axis, &reference, arm, length, *mode)?;
                Some((Leg::Arm(arm), [dx.sub(ax), dy.sub(ay), dz.sub(az)]))
            }
            (claim::Leg::Planar { .. }, [nx, ny, nz]) => {
                let direction = [nx.clone(), ny.clone(), nz.clone()];
                let zero = nx.integer_like(0);
                Some((Leg::Planar(Planar::new(&direction)?), [zero.clone(), zero.clone(), zero]))
            }
            _ => None,
        }
    }

    /// The leg's state at `w`; `None` unless it certainly reaches `w` and is certainly not
    /// serially singular there.
    pub fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        match self {
            Leg::Slider(leg) => leg.at(w),
            Leg::Strut(leg) => leg.at(w),
            Leg::Arm(leg) => leg.at(w),
            Leg::Planar(leg) => Some(leg.at(w)),
        }
    }

    /// The leg's expansion about `centre` over `over`, which must contain it; `None` unless the leg
    /// certainly reaches all of `over` without a serial singularity.
    pub fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        match self {
            Leg::Slider(leg) => leg.expand(centre, over),
            Leg::Strut(leg) => leg.expand(centre, over),
            Leg::Arm(leg) => leg.expand(centre, over),
            Leg::Planar(leg) => Some(leg.expand(centre)),
        }
    }

    /// A quantity that is positive exactly where the leg reaches `w` and is not serially singular.
    pub fn clearance(&self, w: &Vector<S>) -> S {
        match self {
            Leg::Slider(leg) => leg.clearance(w),
            Leg::Strut(leg) => leg.clearance(w),
            Leg::Arm(leg) => leg.clearance(w),
            Leg::Planar(leg) => leg.clearance(),
        }
    }

    /// `(eta / L)^2`, the square of the cosine of the angle between the leg and the motion of its
    /// driven end; `None` for legs without a length, or out of reach.
    pub fn cosine_squared(&self, w: &Vector<S>) -> Option<S> {
        match self {
            Leg::Slider(leg) => leg.cosine_squared(w),
            Leg::Arm(leg) => leg.cosine_squared(w),
            Leg::Strut(_) | Leg::Planar(_) => None,
        }
    }

    /// [`Leg::cosine_squared`] of an arm at `centre`, and its slope over `over`; `None` for other
    /// legs (of a slider it is concave, which is better than a slope), or where it is not enclosed.
    pub fn expand_cosine_squared(
        &self,
        centre: &Vector<S>,
        over: &Vector<S>,
    ) -> Option<(S, Vector<S>)> {
        match self {
            Leg::Arm(leg) => leg.expand_cosine_squared(centre, over),
            Leg::Slider(_) | Leg::Strut(_) | Leg::Planar(_) => None,
        }
    }

    /// `c_i = 1 / |row_i of M|^2` where the leg reaches `w` and is not serially singular, and not
    /// positive elsewhere; `None` for legs whose row is a unit vector.
    ///
    /// *Why.* The row of a slider is its leg vector over `eta`, `|row| = L/s`; that of an arm is
    /// its leg vector over the component `r eta` along the elbow's motion, `|row| = L/(r sqrt(D))`.
    /// So `c_i` is [`Leg::cosine_squared`], times `r^2` for an arm: `1 - |r|^2/L^2` and `r^2 D/L^2`,
    /// defined everywhere.
    pub fn inverse_row_squared(&self, w: &Vector<S>) -> Option<S> {
        match self {
            Leg::Slider(leg) => leg.cosine_squared(w),
            Leg::Arm(leg) => leg.inverse_row_squared(w),
            Leg::Strut(_) | Leg::Planar(_) => None,
        }
    }

    /// The unit leg vector `(c_i - b_i) / L_i`, a row of `A` divided by the leg's length, about
    /// `centre` over `over`; for a planar leg, its direction.
    pub fn expand_unit(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<UnitExpansion<S>> {
        match self {
            Leg::Slider(leg) => leg.expand_unit(centre, over),
            Leg::Arm(leg) => leg.expand_unit(centre, over),
            // The row of a strut or of a planar leg is its unit vector.
            Leg::Strut(leg) => leg.expand(centre, over).map(|e| (e.row, e.slope)),
            Leg::Planar(leg) => {
                let expansion = leg.expand(centre);
                Some((expansion.row, expansion.slope))
            }
        }
    }
}

impl<S> Leg<S> {
    /// The same leg in another arithmetic; `convert` must enclose.
    pub fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Leg<T> {
        match self {
            Leg::Slider(leg) => Leg::Slider(leg.map(convert)),
            Leg::Strut(leg) => Leg::Strut(leg.map(convert)),
            Leg::Arm(leg) => Leg::Arm(leg.map(convert)),
            Leg::Planar(leg) => Leg::Planar(leg.map(convert)),
        }
    }
}

/// A vector in another arithmetic.
fn map_vector<S, T>(v: &Vector<S>, convert: &impl Fn(&S) -> T) -> Vector<T> {
    from_fn(|k| convert(&v[k]))
}

/// A matrix in another arithmetic.
fn map_matrix<S, T>(m: &Matrix<S>, convert: &impl Fn(&S) -> T) -> Matrix<T> {
    from_fn(|i| map_vector(&m[i], convert))
}

/// `v / |v|`; `None` if `v` may be zero.
fn normalised<S: Scalar>(v: &Vector<S>) -> Option<Vector<S>> {
    let norm = crate::linear::norm_squared(v).sqrt()?;
    Some([v[0].div(&norm)?, v[1].div(&norm)?, v[2].div(&norm)?])
}

/// `I - n n^T` for a unit vector `n`.
fn projector<S: Scalar>(n: &Vector<S>) -> Matrix<S> {
    from_fn(|i| {
        from_fn(|j| {
            let identity = n[0].integer_like(i64::from(i == j));
            identity.sub(&if i == j { n[i].sqr() } else { n[i].mul(&n[j]) })
        })
    })
}
