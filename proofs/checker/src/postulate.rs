//! The Q1/Q2 postulate: the rules for one `psi_max`, a range, or every `psi_max > 1`.
//!
//! `L = 1`, `kappa = 1/psi_max`, `W(kappa) = [q_1, q_2]^3` is the paper's cube. The upper bound
//! `sigma_max(M) <= 1/kappa` holds on it by hand, for every `kappa` ([`crate::rule::cube`]). What
//! the trees prove is the lower bound `sigma_min(M) >= kappa`.
//!
//! **Blow-up.** With `delta = 1 - kappa`, `M = I + delta N`, `N` with zero diagonal,
//!
//! ```text
//! sym(M) - kappa I = (delta / 2) (2 I + N + N^T)
//! ```
//!
//! Let `Q` be `Q_1` or `Q_2`, `t` its `t_1` or `t_2` and `tau = t / delta`. In the normalised
//! coordinates `eta = P / |q|`, with `|q| = t / sqrt(1 + 2 t^2)`,
//!
//! ```text
//! N_ij = P_j / (delta s_i) = tau eta_j / S_i     (i, j, k distinct)
//! S_i  = sqrt(1 + t^2 (2 - eta_j^2 - eta_k^2))
//! F    = (2 / tau) I + (eta_j / S_i + eta_i / S_j)_ij
//! ```
//!
//! so that, for `kappa < 1`, `sigma_min(M) >= kappa` follows from `F >= 0`, and `F` is regular
//! also where `kappa = 1`. The constants are
//!
//! ```text
//!                       2 / tau    t^2                     eta at u = 0    eta at u = 1
//! Q_1                   4          delta^2 / 4             -1              1/p
//! Q_2, kappa <= 1/2     2          delta^2                 -p              1
//! Q_2, kappa >= 1/2     4 kappa    delta^2 / (4 kappa^2)   -p              1
//!
//! p^2 = q_1^2 / q_2^2 = 1 - 3 / (2 (2 + delta^2))                  for kappa <= 1/2
//!                     = 1 - 2 delta (1 + kappa) / (2 + delta^2)    for kappa >= 1/2
//! ```
//!
//! and the cube is `eta = (1 - u) eta(0) + u eta(1)` for `u` in `[0, 1]^3`.
//!
//! **Faces suffice.** If `sigma_min(M) >= kappa'` on the faces of `W(kappa')` for every `kappa'` in
//! `[kappa, 1)`, then `sigma_min(M) >= kappa` on `W(kappa)`. *Proof.* `t_1` and `t_2` are
//! continuous in `kappa` and decrease to 0 at 1, and `|q|` increases with `t`: the cubes are
//! closed, nested, and shrink to `O`. Let `P` in `W(kappa)`. If `P = O`, `M = I`. Otherwise
//! `kappa' = max {k : P in W(k)}` exists, is less than 1, and `P` lies on a face of `W(kappa')`
//! (an inner point would be inner for a slightly greater `k`). So
//! `sigma_min(M(P)) >= kappa' >= kappa`. ∎ In the same way `s_i > 0` on the faces, which the rules
//! show with `F >= 0`, gives `s_i > 0` on `W(kappa)`. Since `M(pi P) = Pi M(P) Pi^T` for a
//! permutation `pi` of the coordinates, the faces `x = q_1` and `x = q_2` stand for all six.

use crate::cell::{Cell, Edge};
use crate::definite::is_positive_definite;
use crate::enclosure::Enclosure;
use crate::linear::{Symmetric, Vector};
use crate::rule::{Failure, TightCorner};
use serde::{Deserialize, Serialize};
use std::array::from_fn;

/// Which form of `t_2` holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Half {
    /// `kappa <= 1/2`: `t_2 = 1 - kappa`.
    Low,
    /// `kappa >= 1/2`: `t_2 = (1/kappa - 1) / 2`.
    High,
}

/// A face of the cube that stands for three.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Face {
    /// `x = q_1`.
    Q1,
    /// `x = q_2`.
    Q2,
}

/// The range of one coordinate `u_k`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// An edge of a cell.
    Edge(Edge),
    /// `u_k = 0`: the coordinate `q_1`.
    AtQ1,
    /// `u_k = 1`: the coordinate `q_2`.
    AtQ2,
}

/// `F` for an interval of `kappa` and a box of `u`.
#[derive(Clone, Debug)]
pub struct BlowUp<S> {
    normaliser: TightCorner,
    /// `2 / tau`.
    diagonal: S,
    t_squared: S,
    /// `eta` at `u = 0` and at `u = 1`.
    ends: [S; 2],
    parts: [Part; 3],
}

/// `F` over a box: its value at the expansion point, and slopes times extents.
#[derive(Clone, Debug)]
pub struct BlowUpExpansion<S> {
    /// Off-diagonal entries of `F` at the expansion point: `(1,2)`, `(1,3)`, `(2,3)`.
    pub off: Vector<S>,
    /// For each coordinate, what its extent adds to them.
    pub slopes: [Vector<S>; 3],
    /// The coordinates that vary.
    free: [bool; 3],
}

impl<S: Enclosure> BlowUp<S> {
    /// `F` over `kappa`, which lies in `half` of `[0, 1]`, and `parts`, normalised by a corner;
    /// `None` where the constants cannot be enclosed.
    pub fn new(kappa: &S, half: Half, normaliser: TightCorner, parts: [Part; 3]) -> Option<Self> {
        let number = |n: i64| kappa.integer_like(n);
        let delta = number(1).sub(kappa);
        let delta_squared = delta.sqr();
        let sum = number(2).add(&delta_squared);
        let p_squared = number(1).sub(&match half {
            Half::Low => number(3).div(&number(2).mul(&sum))?,
            Half::High => number(2).mul(&delta).mul(&number(1).add(kappa)).div(&sum)?,
        });
        let p = p_squared.sqrt()?;
        let (diagonal, t_squared) = match (normaliser, half) {
            (TightCorner::Q1, _) => (number(4), delta_squared.div(&number(4))?),
            (TightCorner::Q2, Half::Low) => (number(2), delta_squared),
            (TightCorner::Q2, Half::High) => {
                let four = number(4);
                (four.mul(kappa), delta_squared.div(&four.mul(&kappa.sqr()))?)
            }
        };
        let ends = match normaliser {
            TightCorner::Q1 => [number(-1), p.recip()?],
            TightCorner::Q2 => [p.neg(), number(1)],
        };
        Some(BlowUp { normaliser, diagonal, t_squared, ends, parts })
    }

    /// `eta` at `u = index / 2^level`.
    fn at(&self, index: u128, level: u32) -> S {
        let u = self.t_squared.dyadic_like(index, level);
        let rest = u.integer_like(1).sub(&u);
        rest.mul(&self.ends[0]).add(&u.mul(&self.ends[1]))
    }

    /// `eta_k` over the box, at the expansion point, and its extent about that.
    fn coordinate(&self, part: Part, corner: Option<TightCorner>) -> (S, S, S) {
        let zero = self.t_squared.integer_like(0);
        match part {
            Part::AtQ1 => (self.at(0, 0), self.at(0, 0), zero),
            Part::AtQ2 => (self.at(1, 0), self.at(1, 0), zero),
            Part::Edge(Edge { index, level }) => {
                let over = self.at(index, level).join(&self.at(index + 1, level));
                let width = self.ends[1].sub(&self.ends[0]);
                let edge = width.mul(&width.dyadic_like(1, level));
                let (at, extent) = match corner {
                    None => {
                        let half = width.mul(&width.dyadic_like(1, level + 1));
                        (self.at(2 * index + 1, level + 1), half)
                    }
                    Some(TightCorner::Q1) => (self.at(0, 0), edge),
                    Some(TightCorner::Q2) => (self.at(1, 0), edge.neg()),
                };
                (over, at, extent)
            }
        }
    }

    /// The expansion about the centre, or about a corner that the box touches.
    ///
    /// With `K = S S_c (S + S_c)`, subscript `c` at the expansion point, and `(i, j, k)` distinct:
    ///
    /// ```text
    /// eta_j/S - c_j/S_c = (eta_j - c_j) [1/S + c_j (eta_j + c_j) t^2 / K]
    ///                   + (eta_k - c_k) [      c_j (eta_k + c_k) t^2 / K]
    /// ```
    ///
    /// since `1/S - 1/S_c = (S_c^2 - S^2)/K` and
    /// `S_c^2 - S^2 = t^2 ((eta_j - c_j)(eta_j + c_j) + (eta_k - c_k)(eta_k + c_k))`.
    pub fn expand(&self, corner: Option<TightCorner>) -> Result<BlowUpExpansion<S>, Failure> {
        let coordinates: [(S, S, S); 3] = from_fn(|k| self.coordinate(self.parts[k], corner));
        let zero = self.t_squared.integer_like(0);
        let mut off = [zero.clone(), zero.clone(), zero.clone()];
        let mut slopes = [off.clone(), off.clone(), off.clone()];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let ((eta_j, c_j, h_j), (eta_k, c_k, h_k)) = (&coordinates[j], &coordinates[k]);
            let out_of_reach = Failure::OutOfReach(i);
            let s = self.root(eta_j, eta_k).ok_or(out_of_reach)?;
            let s_c = self.root(c_j, c_k).ok_or(out_of_reach)?;
            let inverse = s.recip().ok_or(out_of_reach)?;
            let inverse_c = s_c.recip().ok_or(out_of_reach)?;
            let t_over_k = s.mul(&s_c).mul(&s.add(&s_c)).recip().ok_or(out_of_reach)?;
            let t_over_k = self.t_squared.mul(&t_over_k);
            let by_j = eta_j.add(c_j).mul(&t_over_k);
            let by_k = eta_k.add(c_k).mul(&t_over_k);
            // Entries (i, j) and (j, i) of N meet in one entry of F: (1,2), (1,3), (2,3).
            let (with_j, with_k) = (i + j - 1, i + k - 1);
            off[with_j] = off[with_j].add(&c_j.mul(&inverse_c));
            off[with_k] = off[with_k].add(&c_k.mul(&inverse_c));
            let mut slope = |coordinate: usize, entry: usize, extent: &S, by: S| {
                slopes[coordinate][entry] = slopes[coordinate][entry].add(&extent.mul(&by));
            };
            slope(j, with_j, h_j, inverse.add(&c_j.mul(&by_j)));
            slope(k, with_j, h_k, c_j.mul(&by_k));
            slope(k, with_k, h_k, inverse.add(&c_k.mul(&by_k)));
            slope(j, with_k, h_j, c_k.mul(&by_j));
        }
        let free = self.parts.map(|part| matches!(part, Part::Edge(_)));
        Ok(BlowUpExpansion { off, slopes, free })
    }

    /// `S = sqrt(1 + t^2 (2 - eta_j^2 - eta_k^2))`, positive exactly where `s_i` is.
    fn root(&self, eta_j: &S, eta_k: &S) -> Option<S> {
        let rest = eta_j.integer_like(2).sub(&eta_j.sqr()).sub(&eta_k.sqr());
        eta_j.integer_like(1).add(&self.t_squared.mul(&rest)).sqrt()
    }
}

/// **Blow-up.** The vertex rule ([`crate::rule::lower`], `W = I`) for `F` about the centre, for
/// every fixed `kappa` of the interval: if `F` is positive definite at the vertices of the box,
/// `F > 0` on it.
pub fn blow_up<S: Enclosure>(blow_up: &BlowUp<S>) -> Result<(), Failure> {
    let expansion = blow_up.expand(None)?;
    definite_at_vertices(&blow_up.diagonal, &expansion, &expansion.off, false)
}

/// **Tight edge.** The vertex rule for `F` with `c = Q(kappa)`, for every fixed `kappa` of the
/// interval: if `F` is positive definite at the vertices other than `Q`, `F >= 0` on the box.
///
/// *Proof.* At `Q`, all off-diagonal entries of `F` are equal to one number `o`, so with the
/// diagonal `d = 2/tau`, `F(Q) = (d - o) I + o 11^T`, with eigenvalues `d + 2 o` and `d - o`
/// (twice). With `n = N_12(Q)`, `o = 2 n / tau = n d`:
///
/// ```text
/// Q_1   n = -t_1/delta = -1/2    o = -d/2         d + 2 o = 0    d - o = 3 d / 2 > 0
/// Q_2   n = tau                  o = 2            d + 2 o > 0    d - o = d - 2
/// ```
///
/// so `F(Q)` is positive semidefinite at `Q_1` always, and at `Q_2` where `d >= 2`, which is
/// tested: `d = 2` for `kappa <= 1/2`, `4 kappa` above. The convexity argument is that of
/// [`crate::rule::corner`]. ∎
pub fn edge<S: Enclosure>(blow_up: &BlowUp<S>, corner: TightCorner) -> Result<(), Failure> {
    let touches = blow_up.parts.iter().all(|part| match (part, corner) {
        (Part::AtQ1, TightCorner::Q1) | (Part::AtQ2, TightCorner::Q2) => true,
        (Part::Edge(e), TightCorner::Q1) => e.index == 0,
        (Part::Edge(e), TightCorner::Q2) => e.index + 1 == 1u128 << e.level,
        _ => false,
    });
    if !touches {
        return Err(Failure::NotAtCorner);
    }
    let d = &blow_up.diagonal;
    let o = match (corner, blow_up.normaliser) {
        (TightCorner::Q1, TightCorner::Q1) => d.integer_like(-2),
        (TightCorner::Q1, TightCorner::Q2) => {
            d.div(&d.integer_like(-2)).ok_or(Failure::NotEnclosed)?
        }
        (TightCorner::Q2, TightCorner::Q2) => d.integer_like(2),
        (TightCorner::Q2, TightCorner::Q1) => return Err(Failure::NotAtCorner),
    };
    if corner == TightCorner::Q2 && !d.sub(&o).is_nonnegative() {
        return Err(Failure::NotDefinite { vertex: 0 });
    }
    let expansion = blow_up.expand(Some(corner))?;
    definite_at_vertices(d, &expansion, &[o.clone(), o.clone(), o], true)
}

/// `diagonal I + off + sum_k lambda_k slopes_k` is positive definite for all `lambda_k` in
/// `{-1, 1}` (about a centre), or in `{0, 1}` but not all zero (about a corner), of the free
/// coordinates.
fn definite_at_vertices<S: Enclosure>(
    diagonal: &S,
    expansion: &BlowUpExpansion<S>,
    off: &Vector<S>,
    about_corner: bool,
) -> Result<(), Failure> {
    let free = (0..3).filter(|&k| expansion.free[k]).fold(0u8, |mask, k| mask | 1 << k);
    for vertex in (u8::from(about_corner)..8).filter(|v| v & !free == 0) {
        let off = (0..3).fold(off.clone(), |sum, k| match (vertex >> k & 1 == 1, about_corner) {
            _ if !expansion.free[k] => sum,
            (true, _) => crate::linear::add(&sum, &expansion.slopes[k]),
            (false, false) => crate::linear::sub(&sum, &expansion.slopes[k]),
            (false, true) => sum,
        });
        let diagonal = [diagonal.clone(), diagonal.clone(), diagonal.clone()];
        if !is_positive_definite(&Symmetric { diagonal, off }) {
            return Err(Failure::NotDefinite { vertex });
        }
    }
    Ok(())
}

/// **Mirror.** On a face, a cell on which `u_y >= u_z` throughout needs no proof of its own.
///
/// *Proof.* Fix `kappa`. Exchanging `y` and `z` maps the face to itself, `F` to `Pi F Pi^T`, and
/// permutes the `S_i`. A point with `u_y < u_z` is in no such cell, so in a leaf on whose path
/// another rule has shown `S_i > 0` and `F >= 0`, on all of a closed cell. A point with `u_y > u_z`
/// is the image of one of those. A point with `u_y = u_z` is a limit of them: as there are finitely
/// many leaves, it lies in one of theirs. ∎
pub fn mirror(cell: &Cell) -> Result<(), Failure> {
    let [_, y, z] = cell.edges;
    // index_y / 2^level_y >= (index_z + 1) / 2^level_z; both sides times 2^(level_y + level_z),
    // compared without overflow: levels are at most 120 and indices less than 2^level.
    let (y_low, z_high) = (
        num_bigint::BigInt::from(y.index) << z.level,
        (num_bigint::BigInt::from(z.index) + 1) << y.level,
    );
    if y_low >= z_high {
        Ok(())
    } else {
        Err(Failure::NotMirrored)
    }
}

/// The blow-up on a cell of a face's tree, whose axes are `kappa`, `y` and `z`; `kappa` runs over
/// `[least, least + width]`.
pub fn on_face<S: Enclosure>(
    least: &S,
    width: &S,
    half: Half,
    face: Face,
    cell: &Cell,
) -> Option<BlowUp<S>> {
    let [kappa, y, z] = cell.edges;
    let end = |index| least.add(&width.mul(&width.dyadic_like(index, kappa.level)));
    let kappa = end(kappa.index).join(&end(kappa.index + 1));
    let (x, normaliser) = match face {
        Face::Q1 => (Part::AtQ1, TightCorner::Q1),
        Face::Q2 => (Part::AtQ2, TightCorner::Q2),
    };
    BlowUp::new(&kappa, half, normaliser, [x, Part::Edge(y), Part::Edge(z)])
}

/// The blow-up on a cell of the cube's tree, for one `kappa`.
pub fn on_cube<S: Enclosure>(kappa: &S, half: Half, cell: &Cell) -> Option<BlowUp<S>> {
    BlowUp::new(kappa, half, TightCorner::Q2, cell.edges.map(Part::Edge))
}
