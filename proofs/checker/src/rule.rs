//! The rules: each discharges one obligation on one cell.
//!
//! | step         | obligation   | rule                                                   |
//! |--------------|--------------|--------------------------------------------------------|
//! | `lower`      | `sigma_min`  | [`lower`]: vertex rule about the centre                |
//! | `corner`     | `sigma_min`  | [`corner`]: vertex rule about a tight corner           |
//! | `upper`      | `sigma_max`  | [`upper`]: vertex rule about the centre                |
//! | `cube`       | `sigma_max`  | [`cube`]: the paper's cube, by hand                    |
//! | `range`      | `joint_range`| [`range`]: enclosure of the joint coordinates          |
//!
//! A rule does not know where in the tree it is used; [`crate::check`] adds that. Every rule but
//! `cube` encloses `M` or `rho` over the cell and can do so only where every leg certainly reaches
//! every point of it with `s_i > 0`: so `sigma_min`, which is always to be discharged, excludes
//! serial singularities as well as parallel ones.
//!
//! All rules are statements about one fixed machine. Where parameters are intervals, the
//! enclosures hold every machine's `M(c)` and `E_k`, and the rule holds for each of them.

use crate::cell::Cell;
use crate::claim::Sign;
use crate::definite::is_positive_definite;
use crate::enclosure::{Enclosure, Scalar};
use crate::expansion::{natural_rho, Expansion, ExpansionPoint, OutOfReach};
use crate::linear::{add_matrix, product, sub_matrix, Matrix, Symmetric};
use crate::model::Model;
use serde::{Deserialize, Serialize};
use std::array::from_fn;
use std::fmt;

/// Largest absolute value of a quaternion's component.
pub const MAX_QUATERNION: i64 = 1 << 20;

/// What is to be shown of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Obligation {
    /// Every leg reaches every point with `s_i > 0` (no serial singularity), and
    /// `sigma_min(M) >= kappa` with `kappa = 1/psi_max`; where there is no `psi_max`,
    /// `sigma_min(M) > 0` (no parallel singularity).
    SigmaMin,
    /// `sigma_max(M) <= k` with `k = 1/psi_min`.
    SigmaMax,
    /// `rho_i` within its range, for every leg.
    JointRange,
}

impl Obligation {
    /// Every obligation there is, in the order of reports.
    pub const ALL: [Obligation; 3] =
        [Obligation::SigmaMin, Obligation::SigmaMax, Obligation::JointRange];
}

impl fmt::Display for Obligation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Obligation::SigmaMin => "sigma_min",
            Obligation::SigmaMax => "sigma_max",
            Obligation::JointRange => "joint_range",
        })
    }
}

/// Why a rule does not discharge its obligation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// A leg (from zero) is not certainly within reach and free of serial singularities.
    OutOfReach(usize),
    /// The matrix at this vertex of the cell is not certainly positive definite.
    NotDefinite {
        /// Bit `k` is set where `delta_k` is at its greater extent.
        vertex: u8,
    },
    /// A joint coordinate (leg from zero) is not certainly within its range.
    OutOfRange(usize),
    /// The quaternion is zero, or a component is too large.
    BadRotation,
    /// The cell does not touch the corner, or the claim has none.
    NotAtCorner,
    /// The claim is not about the paper's cube.
    NotTheCube,
    /// The claim asks for nothing that the rule could discharge.
    NoSuchBound,
    /// The rule's obligation is already discharged on the cell.
    Repeated,
    /// The rule belongs to another kind of tree.
    OtherKind,
    /// The numbers cannot be enclosed.
    NotEnclosed,
    /// The cell has points with `u_y < u_z`.
    NotMirrored,
}

impl From<OutOfReach> for Failure {
    fn from(error: OutOfReach) -> Self {
        Failure::OutOfReach(error.leg)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::OutOfReach(leg) => write!(
                f,
                "leg {} is not certainly within reach with s > 0 on the whole box",
                leg + 1
            ),
            Failure::NotDefinite { vertex } => {
                write!(f, "the matrix at vertex {vertex} is not certainly positive definite")
            }
            Failure::OutOfRange(leg) => {
                write!(f, "rho_{} is not certainly within its range on the whole box", leg + 1)
            }
            Failure::BadRotation => {
                write!(f, "the quaternion is zero or has a component beyond ±{MAX_QUATERNION}")
            }
            Failure::NotAtCorner => write!(f, "the box does not touch that corner of the cube"),
            Failure::NotTheCube => write!(f, "the rule is for the paper's cube only"),
            Failure::NoSuchBound => write!(f, "the claim has no such requirement"),
            Failure::Repeated => write!(f, "its obligation is already discharged on the path"),
            Failure::OtherKind => write!(f, "the rule belongs to another kind of tree"),
            Failure::NotEnclosed => write!(f, "the numbers cannot be enclosed"),
            Failure::NotMirrored => write!(f, "the box has points with u_y < u_z"),
        }
    }
}

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
    fn numerators(&self) -> Option<([[i64; 3]; 3], i64)> {
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

/// `M(c) + sum_k lambda_k slopes_k` for `lambda_k = high` where bit `k` of `vertex` is set, `low`
/// elsewhere, over symmetric matrices.
fn symmetric_at_vertex<S: Scalar>(
    at_centre: &Symmetric<S>,
    slopes: &[Symmetric<S>; 3],
    vertex: u8,
    kind: VertexKind,
) -> Symmetric<S> {
    (0..3).fold(at_centre.clone(), |sum, k| match (vertex >> k & 1 == 1, kind) {
        (true, _) => sum.add(&slopes[k]),
        (false, VertexKind::AboutCentre) => sum.sub(&slopes[k]),
        (false, VertexKind::AboutCorner) => sum,
    })
}

/// The range of the `lambda_k`: `[-1, 1]` about a centre, `[0, 1]` about a corner.
#[derive(Clone, Copy)]
enum VertexKind {
    AboutCentre,
    AboutCorner,
}

/// `W A + (W A)^T - 2 kappa I`, times `|q|^2`, for `A` at a vertex is affine in `A`; this is its
/// linear part.
fn twice_rotated<S: Scalar>(w: &[[i64; 3]; 3], a: &Matrix<S>) -> Symmetric<S> {
    let w: Matrix<S> = w.map(|row| row.map(|x| a[0][0].integer_like(x)));
    Symmetric::twice_part_of(&product(&w, a))
}

/// **Vertex rule, lower bound.** For `P = c + delta` in the cell let
/// `A(v) = M(c) + sum_k v_k E_k(P)`, so that `M(P) = A(delta)`. If `sym(W A(v)) - kappa I` is
/// positive definite at the 8 vertices `v` of the cell, for one orthogonal `W`, then
/// `sigma_min(M(P)) > kappa`.
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
    all_vertices(0, &at_centre, &slopes, VertexKind::AboutCentre)
}

fn all_vertices<S: Enclosure>(
    first: u8,
    at_centre: &Symmetric<S>,
    slopes: &[Symmetric<S>; 3],
    kind: VertexKind,
) -> Result<(), Failure> {
    match (first..8).find(|&vertex| {
        !is_positive_definite(&symmetric_at_vertex(at_centre, slopes, vertex, kind))
    }) {
        Some(vertex) => Err(Failure::NotDefinite { vertex }),
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
    all_vertices(1, &at_corner, &slopes, VertexKind::AboutCorner)
}

/// **Vertex rule, upper bound.** If `k^2 I - A(v)^T A(v)` is positive definite at the 8 vertices,
/// then `sigma_max(M) < k` on the cell.
///
/// *Proof.* Fix `P`. `||A(v)||_2 < k` at the vertices; a norm is convex and `A` affine, so
/// `||M(P)||_2 < k`. ∎
pub fn upper<S: Enclosure>(model: &Model<S>, expansion: &Expansion<S>) -> Result<(), Failure> {
    let k_squared = model.bounds.k.as_ref().ok_or(Failure::NoSuchBound)?.sqr();
    let exceeds = |vertex: &u8| {
        let at_vertex = (0..3).fold(expansion.matrix.clone(), |sum, k| {
            if vertex >> k & 1 == 1 {
                add_matrix(&sum, &expansion.slopes[k])
            } else {
                sub_matrix(&sum, &expansion.slopes[k])
            }
        });
        !is_positive_definite(&Symmetric::gram_of(&at_vertex).subtracted_from(&k_squared))
    };
    match (0..8).find(exceeds) {
        Some(vertex) => Err(Failure::NotDefinite { vertex }),
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

/// **Joint range.** Each `rho_i` lies in its range on the cell.
///
/// *Proof.* `rho_i` on the cell is in the value of its formula over the cell, and in
/// `rho_i(c) + sum_k [-1, 1] h_k g_k` by the slope identity; both enclose the same numbers, so
/// their intersection does. It is compared with the range, ends included. ∎
pub fn range<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    expansion: &Expansion<S>,
) -> Result<(), Failure> {
    let ranges = model.bounds.joint_range.as_ref().ok_or(Failure::NoSuchBound)?;
    for (leg, (min, max)) in ranges.iter().enumerate() {
        let centred = expansion.rho_slopes[leg]
            .iter()
            .fold(expansion.rho[leg].clone(), |sum, slope| sum.add(&slope.join(&slope.neg())));
        let rho = natural_rho(model, cell, leg)
            .and_then(|natural| natural.meet(&centred))
            .ok_or(Failure::OutOfReach(leg))?;
        let above = min.as_ref().is_none_or(|min| rho.sub(min).is_nonnegative());
        let below = max.as_ref().is_none_or(|max| max.sub(&rho).is_nonnegative());
        if !(above && below) {
            return Err(Failure::OutOfRange(leg));
        }
    }
    Ok(())
}
