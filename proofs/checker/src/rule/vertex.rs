//! The vertex rules: bounds on the singular values of `M` from the vertices of a cell.

use super::Failure;
use crate::cell::Cell;
use crate::claim::Sign;
use crate::definite::is_positive_definite;
use crate::enclosure::{Enclosure, Scalar};
use crate::expansion::{Expansion, ExpansionPoint};
use crate::hull::{Hull, Vertex};
use crate::linear::{add, product, Matrix, Symmetric, Vector};
use crate::model::Model;
use serde::{Deserialize, Serialize};
use std::array::from_fn;

/// Largest absolute value of a quaternion's component.
pub const MAX_QUATERNION: i64 = 1 << 20;

/// An orthogonal matrix `W = sign Rot(q) / |q|^2`, as evidence for [`lower`].
///
/// **Lemma.** For integers `q = (a, b, c, d)`, not all zero,
///
/// ```text
///          [ aa+bb-cc-dd   2(bc-ad)     2(bd+ac)   ]
/// Rot(q) = [ 2(bc+ad)      aa-bb+cc-dd  2(cd-ab)   ]     Rot(q) Rot(q)^T = |q|^4 I
///          [ 2(bd-ac)      2(cd+ab)     aa-bb-cc+dd ]
/// ```
///
/// so that `W` is orthogonal, exactly. *Proof.* Expand. ∎
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The quaternion `(a, b, c, d)`.
    pub q: [i64; 4],
    /// The sign.
    pub sign: Sign,
}

impl Rotation {
    /// `W = I`.
    pub const IDENTITY: Rotation = Rotation { q: [1, 0, 0, 0], sign: Sign::Plus };

    /// `sign Rot(q)` and `|q|^2`, both integers; `None` if `q` is zero or too large.
    pub(super) fn numerators(&self) -> Option<([[i64; 3]; 3], i64)> {
        let [a, b, c, d] = self.q;
        let norm = self.norm_squared()?;
        let s = self.sign.as_integer();
        // Every product is at most 2^40 and every entry at most 2^42.
        let rows = [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
        ];
        Some((rows.map(|row| row.map(|x| s * x)), norm))
    }

    fn norm_squared(&self) -> Option<i64> {
        let within = self.q.iter().all(|x| (-MAX_QUATERNION..=MAX_QUATERNION).contains(x));
        let norm = within.then(|| self.q.iter().map(|x| x * x).sum());
        norm.filter(|&n: &i64| n > 0)
    }
}

/// `B(c) + sum_k lambda_k slopes_k` at a vertex, over symmetric matrices.
pub(super) fn symmetric_at<S: Enclosure>(
    at_centre: &Symmetric<S>,
    [x, y, z]: &[Symmetric<S>; 3],
    vertex: &Vertex,
) -> Symmetric<S> {
    let sum = |a: &Vector<S>, b: [&Vector<S>; 3]| -> Vector<S> {
        from_fn(|i| vertex.affine(&a[i], b.map(|b| &b[i])))
    };
    Symmetric {
        diagonal: sum(&at_centre.diagonal, [&x.diagonal, &y.diagonal, &z.diagonal]),
        off: sum(&at_centre.off, [&x.off, &y.off, &z.off]),
    }
}

/// `|q|^2 (W A + (W A)^T)`, linear in `A`.
pub(super) fn twice_rotated<S: Scalar>(w: &[[i64; 3]; 3], a: &Matrix<S>) -> Symmetric<S> {
    let w: Matrix<S> = w.map(|row| row.map(|x| a[0][0].integer_like(x)));
    Symmetric::twice_part_of(&product(&w, a))
}

/// **Vertex rule, lower bound.** For `P = c + delta` in the cell let
/// `A(v) = M(c) + sum_k v_k E_k(P)`, so that `M(P) = A(delta)`. If `sym(W A(v)) - kappa I` is
/// positive definite at the vertices `v` of the cell's [`crate::hull`] (8 for a box), for one
/// orthogonal `W`, then `sigma_min(M(P)) > kappa`.
///
/// *Proof.* Fix `P`. `delta` is a convex combination of the vertices, `A` is affine, and positive
/// definite matrices are a convex set: `sym(W M(P)) - kappa I` is positive definite. For a unit
/// vector `x`, `kappa < x^T W M(P) x <= |W^T x| |M(P) x| = |M(P) x|`. ∎
///
/// `M_v^T M_v - kappa^2 I` at the vertices would be unsound: `sigma_min >= kappa` is not a convex
/// condition (`diag(t, 1, 1)` for `t` in `[-1, 1]`).
///
/// Everything is multiplied by `2 |q|^2 > 0`, which saves the divisions.
pub fn lower<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    rotation: &Rotation,
) -> Result<(), Failure> {
    let (w, norm) = rotation.numerators().ok_or(Failure::BadRotation)?;
    let kappa = model.bounds.kappa.mul(&model.bounds.kappa.integer_like(2 * norm));
    let at_centre = twice_rotated(&w, &expansion.matrix).minus_identity(&kappa);
    let slopes = from_fn(|k| twice_rotated(&w, &expansion.slopes[k]));
    all_positive_definite(expansion.hull.vertices(), &at_centre, &slopes)
}

/// **Entrywise rule, lower bound.** The vertex rule for wide tolerances. Let `[A_v]`, with centre `C`
/// and radius `R`, enclose `A(v)` at the vertex `v` for every machine, entry by entry. If
/// `sym(W X_ab) - kappa I` is positive definite for `X_ab = C - D_a R D_b` and all `a`, `b` in
/// `{-1, 1}^3`, at every vertex, then `sigma_min(M(P)) > kappa` on the cell. `D_a = diag(a)`.
///
/// *Proof.* Fix a machine, `P` and a vertex. For `x != 0` let `y = W^T x`, and let `a`, `b` be the
/// signs of the components of `y`, `x` (1 for zero), so that `|y_i| = a_i y_i`, `|x_j| = b_j x_j`:
///
/// ```text
/// x^T W A(v) x = sum_ij y_i A(v)_ij x_j >= sum_ij y_i C_ij x_j - |y_i| R_ij |x_j|
///              = y^T (C - D_a R D_b) x = x^T sym(W X_ab) x > kappa |x|^2
/// ```
///
/// So `sym(W A(v)) - kappa I` is positive definite at every vertex, and [`lower`]'s proof goes on. ∎
///
/// Entry `(i, j)` of `X_ab` is the lower end of that of `[A_v]` where `a_i b_j = 1` and the upper one
/// elsewhere; `(a, b)` and `(-a, -b)` give the same, so `b_1 = 1` is enough. [`lower`] encloses
/// `W A(v)` instead, where the widths of three entries of `[A_v]` meet in each.
pub fn entrywise<S: Enclosure>(
    model: &Model<S>,
    expansion: &Expansion<S>,
    rotation: &Rotation,
) -> Result<(), Failure> {
    let (w, norm) = rotation.numerators().ok_or(Failure::BadRotation)?;
    let kappa = model.bounds.kappa.mul(&model.bounds.kappa.integer_like(2 * norm));
    let fails = |vertex: &Vertex| {
        let a = expansion.matrix_at(vertex);
        // What either end of entry (i, j) adds to entry (k, j) of |q|^2 W X.
        let part = |i: usize, j: usize| {
            a[i][j].ends().map(|end| from_fn(|k| end.integer_like(w[k][i]).mul(&end)))
        };
        let parts: [[[Vector<S>; 2]; 3]; 3] = from_fn(|i| from_fn(|j| part(i, j)));
        (0..32).any(|signs| {
            let [x, y, z]: [Vector<S>; 3] = from_fn(|j| {
                let [x, y, z] = from_fn(|i| &parts[i][j][upper_end(signs, i, j)]);
                add(&add(x, y), z)
            });
            let product = from_fn(|k| [x[k].clone(), y[k].clone(), z[k].clone()]);
            !is_positive_definite(&Symmetric::twice_part_of(&product).minus_identity(&kappa))
        })
    };
    match expansion.hull.vertices().find(fails) {
        Some(Vertex { number, .. }) => Err(Failure::NotDefinite { vertex: number }),
        None => Ok(()),
    }
}

/// 1 where `a_i b_j = -1`, of the signs in five bits: of `a_1`, `a_2`, `a_3`, `b_2`, `b_3`.
fn upper_end(signs: usize, i: usize, j: usize) -> usize {
    let negative = |bit: usize| signs >> bit & 1;
    negative(i) ^ if j == 0 { 0 } else { negative(2 + j) }
}

fn all_positive_definite<S: Enclosure>(
    mut vertices: impl Iterator<Item = Vertex>,
    at_centre: &Symmetric<S>,
    slopes: &[Symmetric<S>; 3],
) -> Result<(), Failure> {
    let fails = |v: &Vertex| !is_positive_definite(&symmetric_at(at_centre, slopes, v));
    match vertices.find(fails) {
        Some(Vertex { number, .. }) => Err(Failure::NotDefinite { vertex: number }),
        None => Ok(()),
    }
}

/// A corner of the paper's cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TightCorner {
    /// `Q_1 = (q_1, q_1, q_1)`.
    Q1,
    /// `Q_2 = (q_2, q_2, q_2)`.
    Q2,
}

impl TightCorner {
    /// Where a cell that touches the corner is expanded about it.
    pub fn expansion_point(self) -> ExpansionPoint {
        match self {
            TightCorner::Q1 => ExpansionPoint::LowerCorner,
            TightCorner::Q2 => ExpansionPoint::UpperCorner,
        }
    }

    /// Whether `cell` touches the corner.
    pub fn touches(self, cell: &Cell) -> bool {
        match self {
            TightCorner::Q1 => cell.touches_lower_corner(),
            TightCorner::Q2 => cell.touches_upper_corner(),
        }
    }
}

/// **Tight corner.** The vertex rule with `c = Q`, `Q` one of the corners `Q_1`, `Q_2` of the
/// paper's cube, and `W = I`: if `sym(A(v)) - kappa I` is positive definite at the 7 vertices of
/// the cell other than `Q`, then `sigma_min(M) >= kappa` on the cell.
///
/// *Proof.* At the vertex `Q` itself `A = M(Q)`, whatever `P` is, and with `m = M_12(Q)` and
/// `V = [(1,1,1), (1,-1,0), (1,1,-2)]` as columns,
///
/// ```text
/// T(Q) = sym(M(Q)) - kappa I = (1 - m - kappa) I + m 11^T
/// V^T T(Q) V = diag(3 (1 + 2m - kappa), 2 (1 - m - kappa), 6 (1 - m - kappa)).
/// ```
///
/// The cube is defined by `m(Q_1) = -t_1 = -(1 - kappa)/2` and `m(Q_2) = t_2`. For
/// `0 < kappa < 1`, which [`crate::claim::MachineClaim::validate`] has proved:
///
/// ```text
/// Q_1:               1 + 2m - kappa = 0           1 - m - kappa = 3 (1 - kappa)/2
/// Q_2, kappa <= 1/2: 1 + 2m - kappa = 3 (1-kappa) 1 - m - kappa = 0
/// Q_2, kappa >= 1/2: 1 + 2m - kappa = 1/kappa - kappa
///                    1 - m - kappa = (1 - kappa)(2 kappa - 1)/(2 kappa)
/// ```
///
/// none of them negative, so `T(Q)` is positive semidefinite. A convex combination of it with positive definite matrices
/// is positive semidefinite, and `sigma_min(M(P)) >= kappa` as in [`lower`]. ∎
///
/// `expansion` is about that corner.
pub fn corner<S: Enclosure>(model: &Model<S>, expansion: &Expansion<S>) -> Result<(), Failure> {
    if !model.is_cube {
        return Err(Failure::NotTheCube);
    }
    let two = model.bounds.kappa.integer_like(2);
    let kappa = model.bounds.kappa.mul(&two);
    let at_corner = Symmetric::twice_part_of(&expansion.matrix).minus_identity(&kappa);
    let slopes = from_fn(|k| Symmetric::twice_part_of(&expansion.slopes[k]));
    // The first vertex is the corner itself.
    all_positive_definite(Hull::ABOUT_CORNER.vertices().skip(1), &at_corner, &slopes)
}

/// **Vertex rule, upper bound.** If `k^2 I - A(v)^T A(v)` is positive definite at the 8 vertices,
/// then `sigma_max(M) < k` on the cell.
///
/// *Proof.* Fix `P`. `||A(v)||_2 < k` at the vertices; a norm is convex and `A` affine, so
/// `||M(P)||_2 < k`. ∎
pub fn upper<S: Enclosure>(model: &Model<S>, expansion: &Expansion<S>) -> Result<(), Failure> {
    let k_squared = model.bounds.k.as_ref().ok_or(Failure::NoSuchBound)?.sqr();
    let exceeds = |vertex: &Vertex| {
        let gram = Symmetric::gram_of(&expansion.matrix_at(vertex));
        !is_positive_definite(&gram.subtracted_from(&k_squared))
    };
    match expansion.hull.vertices().find(exceeds) {
        Some(Vertex { number, .. }) => Err(Failure::NotDefinite { vertex: number }),
        None => Ok(()),
    }
}

/// **Upper bound on the paper's cube**, for every `psi_max > 1`: `sigma_max(M) <= 1/kappa`.
///
/// *Proof.* `L = 1`. On the cube `|P_j| <= q_2` for all `j` (`|q_1| <= q_2`, as `t_1 <= t_2` and
/// `t -> t / sqrt(1 + 2t^2)` is increasing), so `s_i >= sqrt(1 - 2 q_2^2) = s(Q_2) > 0` and every
/// off-diagonal entry has `|M_ij| = |P_j| / s_i <= q_2 / s(Q_2) = t_2`. By Schur's test
/// `||M||_2^2 <= ||M||_1 ||M||_inf <= (1 + 2 t_2)^2`. For `kappa >= 1/2`, `1 + 2 t_2 = 1/kappa`;
/// for `kappa <= 1/2`, `1 + 2 t_2 = 3 - 2 kappa <= 1/kappa`, as
/// `1 - 3 kappa + 2 kappa^2 = (1 - kappa)(1 - 2 kappa) >= 0`. ∎
pub fn cube<S>(model: &Model<S>) -> Result<(), Failure> {
    if model.is_cube {
        Ok(())
    } else {
        Err(Failure::NotTheCube)
    }
}
