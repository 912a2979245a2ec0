//! Legs of fixed length on rotating arms: the rotary Delta.

use super::{
    map_matrix, map_vector, normalised, projector, JointCoordinate, LegExpansion, LegState,
    UnitExpansion,
};
use crate::claim::Sign;
use crate::enclosure::Scalar;
use crate::linear::{add, dot, norm_squared, scale, sub, Matrix, Vector};
use std::array::from_fn;

/// A leg of length `L` on an arm of length `r` that turns about the unit axis `k` through the
/// anchor; `e` is the arm's unit direction at angle 0, orthogonal to `k`, and `f = k x e`.
///
/// ```text
/// h = w - (k . w) k      N = |h|^2      g = (|w|^2 + r^2 - L^2) / (2 r)
/// D = N - g^2 = (L^2 - (k . w)^2) - (g - r)^2      D < 0: out of reach, D = 0: serially singular
/// q = w / r - (g / N) h
/// row of M  = (k x h) / N + m q / sqrt(D)                          angle per length
/// cos theta = (g (w . e) + m sqrt(D) (w . f)) / N
/// sin theta = (g (w . f) - m sqrt(D) (w . e)) / N
/// ```
///
/// *Why.* The elbow `u = r (cos theta e + sin theta f)` has `|w - u| = L`, that is `w . u = r g`, or
/// `h . (u/r) = g`; with `h` turned by a quarter, `k x h`, this gives the two solutions above. The
/// leg's component along the elbow's motion `k x u / r` is `m sqrt(D)` up to the sign that defines
/// the working mode `m`; differentiating `|w - u|^2 = L^2` gives the row.
#[derive(Clone, Debug)]
pub struct Arm<S> {
    k: Vector<S>,
    e: Vector<S>,
    f: Vector<S>,
    /// `I - k k^T`.
    projector: Matrix<S>,
    r: S,
    length: S,
    mode: S,
}

/// What depends on a point.
struct At<S> {
    h: Vector<S>,
    /// `k . w`.
    along: S,
    n: S,
    g: S,
    root_d: S,
    q: Vector<S>,
}

fn cross<S: Scalar>(a: &Vector<S>, b: &Vector<S>) -> Vector<S> {
    from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j].mul(&b[k]).sub(&a[k].mul(&b[j]))
    })
}

impl<S: Scalar> Arm<S> {
    /// The leg with this motor axis, reference, arm length and leg length; `None` if the axis, or
    /// the reference's part orthogonal to it, may be zero. The reference is made orthogonal to the
    /// axis: where it is so already, nothing changes.
    pub fn new(
        axis: &Vector<S>,
        reference: &Vector<S>,
        arm: &S,
        length: &S,
        mode: Sign,
    ) -> Option<Self> {
        let k = normalised(axis)?;
        let projector = projector(&k);
        let e = normalised(&crate::linear::apply(&projector, reference))?;
        let f = cross(&k, &e);
        let mode = length.integer_like(mode.as_integer());
        Some(Arm { k, e, f, projector, r: arm.clone(), length: length.clone(), mode })
    }

    /// `g = (|w|^2 + r^2 - L^2) / (2 r)`.
    fn g(&self, w: &Vector<S>) -> Option<S> {
        let two_r = self.r.add(&self.r);
        norm_squared(w).add(&self.r.sqr()).sub(&self.length.sqr()).div(&two_r)
    }

    /// `D` by its second form, which has the better range.
    fn d(&self, along: &S, g: &S) -> S {
        self.length.sqr().sub(&along.sqr()).sub(&g.sub(&self.r).sqr())
    }

    fn evaluate(&self, w: &Vector<S>) -> Option<At<S>> {
        let h = crate::linear::apply(&self.projector, w);
        let along = dot(&self.k, w);
        let n = norm_squared(&h);
        let g = self.g(w)?;
        let root_d = self.d(&along, &g).sqrt()?;
        let q = sub(&scale(&self.r.recip()?, w), &scale(&g.div(&n)?, &h));
        Some(At { h, along, n, g, root_d, q })
    }

    fn row(&self, at: &At<S>) -> Option<Vector<S>> {
        let turned = scale(&at.n.recip()?, &cross(&self.k, &at.h));
        Some(add(&turned, &scale(&self.mode.mul(&at.root_d.recip()?), &at.q)))
    }

    pub(super) fn at(&self, w: &Vector<S>) -> Option<LegState<S>> {
        let at = self.evaluate(w)?;
        let (alpha, beta) = (dot(w, &self.e), dot(w, &self.f));
        let eta = self.mode.mul(&at.root_d);
        let cos = at.g.mul(&alpha).add(&eta.mul(&beta)).div(&at.n)?;
        let sin = at.g.mul(&beta).sub(&eta.mul(&alpha)).div(&at.n)?;
        let rho = JointCoordinate::Angle { cos, sin };
        Some(LegState { row: self.row(&at)?, eta, rho })
    }

    /// With subscript `c` at the expansion point, from the identities
    ///
    /// ```text
    /// g - g_c               = (w + w_c) . (P - c) / (2 r)
    /// N - N_c               = (h + h_c) . (P - c)
    /// D - D_c               = dD . (P - c)
    ///   dD = -((k . w) + (k . w_c)) k - (g + g_c - 2 r) (w + w_c) / (2 r)
    /// g/N - g_c/N_c         = [(w + w_c)/(2 r N) - g_c (h + h_c)/(N N_c)] . (P - c)
    /// 1/sqrt(D) - 1/sqrt(D_c) = -dD . (P - c) / (sqrt(D) sqrt(D_c) (sqrt(D) + sqrt(D_c)))
    /// ```
    ///
    /// and products split as `x y - x_c y_c = (x - x_c) y + x_c (y - y_c)`, or the other way round:
    ///
    /// ```text
    /// S = [k]x / N - (k x h_c)(h + h_c)^T / (N N_c)
    ///   + m { [I/r - (g/N)(I - k k^T) - h_c (slope of g/N)^T] / sqrt(D)
    ///         - q_c dD^T / (sqrt(D) sqrt(D_c) (sqrt(D) + sqrt(D_c))) }
    /// ```
    pub(super) fn expand(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<LegExpansion<S>> {
        let (c, o) = (self.evaluate(centre)?, self.evaluate(over)?);
        let (inverse_n, inverse_root) = (o.n.recip()?, o.root_d.recip()?);
        let inverse_nn = inverse_n.mul(&c.n.recip()?);
        let inverse_r = self.r.recip()?;
        let g_slope = self.g_slope(centre, over)?;
        let h_sum = add(&o.h, &c.h);
        let ratio_slope = sub(&scale(&inverse_n, &g_slope), &scale(&c.g.mul(&inverse_nn), &h_sum));
        let by_d = inverse_root.mul(&c.root_d.recip()?).mul(&o.root_d.add(&c.root_d).recip()?);
        let d_slope = scale(&by_d, &self.d_slope(&o.along.add(&c.along), &o.g.add(&c.g), &g_slope));
        let turned = scale(&inverse_nn, &cross(&self.k, &c.h));
        let k_cross = self.cross_matrix();
        let ratio = o.g.mul(&inverse_n);
        let slope = from_fn(|i| {
            from_fn(|j| {
                let identity = if i == j { inverse_r.clone() } else { ratio.integer_like(0) };
                let q_slope = identity
                    .sub(&ratio.mul(&self.projector[i][j]))
                    .sub(&c.h[i].mul(&ratio_slope[j]));
                let driven = q_slope.mul(&inverse_root).sub(&c.q[i].mul(&d_slope[j]));
                k_cross[i][j]
                    .mul(&inverse_n)
                    .sub(&turned[i].mul(&h_sum[j]))
                    .add(&self.mode.mul(&driven))
            })
        });
        Some(LegExpansion { row: self.row(&c)?, slope, rho: None })
    }

    /// Slope of `g`: `(w + w_c) / (2 r)`.
    fn g_slope(&self, centre: &Vector<S>, over: &Vector<S>) -> Option<Vector<S>> {
        Some(scale(&self.r.add(&self.r).recip()?, &add(over, centre)))
    }

    /// Slope of `D`: `-((k . w) + (k . w_c)) k - (g + g_c - 2 r) (slope of g)`.
    /// Given `(k . w) + (k . w_c)` and `g + g_c`.
    fn d_slope(&self, along: &S, g: &S, g_slope: &Vector<S>) -> Vector<S> {
        let excess = g.sub(&self.r).sub(&self.r);
        sub(&scale(&along.neg(), &self.k), &scale(&excess, g_slope))
    }

    /// `[k]x`, with `[k]x v = k x v`.
    fn cross_matrix(&self) -> Matrix<S> {
        let zero = self.r.integer_like(0);
        let [x, y, z] = self.k.clone();
        [[zero.clone(), z.neg(), y.clone()], [z, zero.clone(), x.neg()], [y.neg(), x, zero]]
    }

    /// `4 r^2 D = 4 r^2 (L^2 - (k . w)^2) - (|w|^2 - r^2 - L^2)^2`, as
    /// `2 r (g - r) = |w|^2 - r^2 - L^2`. It has the sign of `D` and needs no division: it is
    /// enclosed at every precision, also where `r` cannot be told from zero.
    pub(super) fn clearance(&self, w: &Vector<S>) -> S {
        let (r_squared, length_squared) = (self.r.sqr(), self.length.sqr());
        let across = length_squared.sub(&dot(&self.k, w).sqr());
        let excess = norm_squared(w).sub(&r_squared).sub(&length_squared);
        r_squared.integer_like(4).mul(&r_squared).mul(&across).sub(&excess.sqr())
    }

    /// `D / L^2` at `centre`, and its slope over `over`: `dD / L^2`, see [`Arm::expand`].
    pub(super) fn expand_cosine_squared(
        &self,
        centre: &Vector<S>,
        over: &Vector<S>,
    ) -> Option<(S, Vector<S>)> {
        let along = dot(&self.k, over).add(&dot(&self.k, centre));
        let (g, g_c) = (self.g(over)?, self.g(centre)?);
        let slope = self.d_slope(&along, &g.add(&g_c), &self.g_slope(centre, over)?);
        let by_length = self.length.sqr().recip()?;
        Some((self.cosine_squared(centre)?, scale(&by_length, &slope)))
    }

    /// `D / L^2`.
    pub(super) fn cosine_squared(&self, w: &Vector<S>) -> Option<S> {
        self.d(&dot(&self.k, w), &self.g(w)?).div(&self.length.sqr())
    }

    /// `r^2 D / L^2`.
    pub(super) fn inverse_row_squared(&self, w: &Vector<S>) -> Option<S> {
        Some(self.r.sqr().mul(&self.cosine_squared(w)?))
    }

    /// The leg is `w - u` with the elbow `u = (r/N) (g h - m sqrt(D) k x h)`: substituting
    /// `alpha e + beta f = h` and `beta e - alpha f = -(k x h)` in `cos theta e + sin theta f`. Its
    /// unit vector `(w - u)/L` has the slope `(I - slope of u)/L`, with
    ///
    /// ```text
    /// u/r = (g/N) h - m (sqrt(D)/N) k x h
    /// slope of (g/N) h          = (g/N) (I - k k^T) + h_c (slope of g/N)^T
    /// slope of (sqrt(D)/N) k x h = (sqrt(D)/N) [k]x + (k x h_c) (slope of sqrt(D)/N)^T
    /// slope of sqrt(D)/N        = dD / ((sqrt(D) + sqrt(D_c)) N) - sqrt(D_c) (h + h_c) / (N N_c)
    /// ```
    pub(super) fn expand_unit(
        &self,
        centre: &Vector<S>,
        over: &Vector<S>,
    ) -> Option<UnitExpansion<S>> {
        let (c, o) = (self.evaluate(centre)?, self.evaluate(over)?);
        let inverse_n = o.n.recip()?;
        let inverse_nn = inverse_n.mul(&c.n.recip()?);
        let g_slope = self.g_slope(centre, over)?;
        let h_sum = add(&o.h, &c.h);
        let ratio_slope = sub(&scale(&inverse_n, &g_slope), &scale(&c.g.mul(&inverse_nn), &h_sum));
        let by_d = o.root_d.add(&c.root_d).recip()?.mul(&inverse_n);
        let root_slope = sub(
            &scale(&by_d, &self.d_slope(&o.along.add(&c.along), &o.g.add(&c.g), &g_slope)),
            &scale(&c.root_d.mul(&inverse_nn), &h_sum),
        );
        let (ratio, root_ratio) = (o.g.mul(&inverse_n), o.root_d.mul(&inverse_n));
        let (k_cross, turned_c) = (self.cross_matrix(), cross(&self.k, &c.h));
        let inverse_length = self.length.recip()?;
        let slope = from_fn(|i| {
            from_fn(|j| {
                let along = ratio.mul(&self.projector[i][j]).add(&c.h[i].mul(&ratio_slope[j]));
                let across = root_ratio.mul(&k_cross[i][j]).add(&turned_c[i].mul(&root_slope[j]));
                let elbow = self.r.mul(&along.sub(&self.mode.mul(&across)));
                inverse_length.mul(&elbow.integer_like(i64::from(i == j)).sub(&elbow))
            })
        });
        let inverse_nc = c.n.recip()?;
        let elbow = sub(
            &scale(&c.g.mul(&inverse_nc), &c.h),
            &scale(&self.mode.mul(&c.root_d).mul(&inverse_nc), &turned_c),
        );
        Some((scale(&inverse_length, &sub(centre, &scale(&self.r, &elbow))), slope))
    }
}

impl<S> Arm<S> {
    pub(super) fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Arm<T> {
        Arm {
            k: map_vector(&self.k, convert),
            e: map_vector(&self.e, convert),
            f: map_vector(&self.f, convert),
            projector: map_matrix(&self.projector, convert),
            r: convert(&self.r),
            length: convert(&self.length),
            mode: convert(&self.mode),
        }
    }
}
