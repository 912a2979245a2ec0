//! The Q1/Q2 postulate: for one `psi_max`, a range, or every `psi_max > 1`.
//!
//! `L = 1`, `kappa = 1/psi_max`, and `W(kappa) = [q_1, q_2]^3` is the paper's cube (see `cube`, whose
//! lemma (upper bound) gives `sigma_max(M) <= 1/kappa` on it). What trees prove is the lower bound.
//!
//! **Blow-up.** With `delta = 1 - kappa`, `M = I + delta N`, and for one of the corners `Q_1`, `Q_2`,
//! with its `t`, `tau = t/delta` and `|q| = t/sqrt(1 + 2 t^2)`, in the coordinates `eta = P/|q|`,
//!
//! ```text
//! N_ij = P_j/(delta s_i) = tau eta_j/S_i,  i != j      S_i = sqrt(1 + t^2 (2 - eta_j^2 - eta_k^2))
//! sym(M) - kappa I = (delta/2) (2 I + N + N^T) = (t/2) F
//! F = (2/tau) I + (eta_j/S_i + eta_i/S_j)_ij
//! ```
//!
//! so that `F >= 0` gives `sigma_min(M) >= kappa`; `F` is regular where `kappa = 1` and `kappa = 0` too:
//!
//! ```text
//!                       2/tau      t              eta_k, for u_k in [0, 1]
//! Q_1                   4          delta/2        -1 + u_k (1 + 1/p)
//! Q_2, kappa <= 1/2     2          delta           1 - (1 - u_k)(1 + p)
//! Q_2, kappa >= 1/2     4 kappa    delta/(2 kappa) 1 - (1 - u_k)(1 + p)
//!
//! p^2 = q_1^2/q_2^2 = (1 + 2 delta^2)/(4 + 2 delta^2)            for kappa <= 1/2
//!                   = (2 kappa^2 + delta^2)/(2 + delta^2)        for kappa >= 1/2
//! ```
//!
//! **Faces suffice.** If `sigma_min(M) >= kappa'` on the faces of `W(kappa')` for every `kappa'` in
//! `[kappa, 1)`, then `sigma_min(M) >= kappa` on `W(kappa)`. *Proof.* `t_1` and `t_2` are continuous in
//! `kappa` and decrease to 0 at 1, and `|q|` increases with `t`: the cubes are closed, nested, and
//! shrink to `O`. Let `P` be in `W(kappa)`. If `P = O`, `M = I`. Otherwise
//! `kappa' = max {k : P in W(k)}` exists, is less than 1, and `P` lies on a face of `W(kappa')`: an
//! inner point would be one for a slightly greater `k`. So `sigma_min(M(P)) >= kappa' >= kappa`. ∎ In
//! the same way `s_i > 0`, which goes with `F >= 0`. Since `M(pi P) = Pi M(P) Pi^T` for a permutation
//! `pi` of the coordinates, the faces `x = q_1` and `x = q_2` stand for all six. So a proof for one
//! `psi_max` is one for every lesser one.
//!
//! **One to one.** What is shown is `sym(M) >= kappa I`, on a cube, which is convex. Rows of `M` are the derivatives of
//! the joint coordinates `rho`: for two of its points `P` and `P + x`, by the mean value theorem,
//! `x . (rho(P + x) - rho(P)) = x . M x >= kappa |x|^2` with `M` somewhere between them, and so
//! `|rho(P + x) - rho(P)| >= kappa |x|`. ∎ At most `|x|/kappa` it is as `sigma_max(M) <= 1/kappa` (with the direction of the
//! difference in the place of `x`).
//!
//! **By hand.** The same, without trees and without computation. Let `max |P_i| <= c`,
//! `c = t/sqrt(1 + 2 t^2)`, `eta = P/c`, `S_i` with this `t`, `sigma_i = 1/S_i`, `g = (1 - kappa)/t`.
//! Then `|eta_i| <= 1`, `0 < sigma_i <= 1`, and
//!
//! ```text
//! (v^T M v - kappa |v|^2)/t = sum (g - eta_i sigma_i) v_i^2 + (eta . v)(sigma . v)
//!                          >= sum (g - eta_i sigma_i) v_i^2 - ((eta - sigma) . v)^2/4 >= 0
//! ```
//!
//! wherever `(eta_i - sigma_i)^2 <= K_i (g - eta_i sigma_i)` with `K_i > 0`, `sum K_i <= 4` (Cauchy).
//! If `|P_i| <= |q_1|` for all `i`: `t = t_1`, `g = 2`, `K_i = 4/3`, as `e^2 + s^2 - 2 e s/3 <= 8/3` at
//! the vertices of `[-1, 1] x [0, 1]`, and is convex. Else let `m = max P_j > |q_1|`,
//! `t_1 <= t <= t_2`, `g = 2 t_1/t >= 1`, `eta_i >= -p`, `p = |q_1|/m`, `p^2 <= g/2`, as
//! `(t - t_1)(2 t_1 t - 1) <= 0`. Where `eta_i = 1`, `K_i = 1/2`: `(1 - s)^2 <= (1 - s)/2`, as
//! `S_i^2 <= 1 + 2 t^2 <= 3` and so `s >= 1/2`; elsewhere `K_i = 7/4`, as `e^2 + s^2 - e s/4 <= 7 g/4`
//! at the vertices of `[-p, 1] x [0, 1]`. ∎

use crate::arithmetic::Enclosure;
use crate::cell::{unit_corners, Cell, Vertex};
use crate::certificate::{Corner, Evidence, Node, Tree, MOST_WORK};
use crate::claim::{Every, PostulateClaim, PsiMax, Quantity};
use crate::compile::{Builder, Names};
use crate::definite::{is_positive_definite, Triangle};
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{Formula, Tape};
use crate::input::{enclosed, malformed, narrowed, ordered, sign, ClaimError};
use crate::number::Expression;
use crate::rejected::Rejected;
use crate::slope::{evaluate, Slopes};
use crate::tree::{self, bisect, discharge, Of, Theorem};

/// A face of the cube, for a range of `kappa` on one side of 1/2: what one of the trees is about.
/// Coordinates are `u_y`, `u_z` and `kappa`.
#[derive(Clone, Debug)]
pub struct Part {
    /// The face `x = q_1` or `x = q_2`.
    pub face: Corner,
    /// The least `kappa`.
    pub least: Expression,
    /// The greatest `kappa`.
    pub greatest: Expression,
    tape: Tape,
    /// The diagonal entry of `F`, and those at (1, 2), (1, 3) and (2, 3).
    entries: [Formula; 4],
}

/// The trees of a proof, in their order: both faces, for `kappa` up to 1/2 and from there, as far as
/// there are any from the least one on.
///
/// # Errors
/// If the claim is not well formed.
pub fn parts(claim: &PostulateClaim) -> Result<Vec<Part>, ClaimError> {
    let (one, two) = (Expression::integer(1), Expression::integer(2));
    let half = &one / &two;
    let (least, is_low) = match &claim.psi_max {
        PsiMax::Every(Every::All) => (Expression::integer(0), true),
        PsiMax::Of(psi) => {
            let [min, max] = psi.ends();
            ordered("psi_max", &one, min, true)?;
            ordered("psi_max", min, max, matches!(psi, Quantity::Between { .. }))?;
            let is_low = match (sign(&(max - &two)), sign(&(&two - max))) {
                (Some([true, _]), _) => true,
                (_, Some([_, true])) => false,
                _ => return Err(malformed("psi_max", "told from 2")),
            };
            (&one / max, is_low)
        }
    };
    let ranges = match is_low {
        true => vec![([least, half.clone()], true), ([half, one], false)],
        false => vec![([least, one], false)],
    };
    let of_face =
        |face| ranges.iter().map(move |(kappa, low)| Part::new(face, *low, kappa.clone()));
    [Corner::Q1, Corner::Q2].into_iter().flat_map(of_face).collect()
}

impl Part {
    fn new(
        face: Corner,
        is_low: bool,
        [least, greatest]: [Expression; 2],
    ) -> Result<Self, ClaimError> {
        let p_squared = match is_low {
            true => "(1+2*delta^2)/(4+2*delta^2)",
            false => "(2*kappa^2+delta^2)/(2+delta^2)",
        };
        let [diagonal, t] = match (face, is_low) {
            (Corner::Q1, _) => ["4", "delta/2"],
            (Corner::Q2, true) => ["2", "delta"],
            (Corner::Q2, false) => ["4*kappa", "delta/(2*kappa)"],
        };
        let [x, y, z] = match face {
            Corner::Q1 => ["-1", "u_y*(1+1/p)-1", "u_z*(1+1/p)-1"],
            Corner::Q2 => ["1", "1-(1-u_y)*(1+p)", "1-(1-u_z)*(1+p)"],
        };
        let definitions = [
            ("delta", "1-kappa"),
            ("p_squared", p_squared),
            ("p", "sqrt(p_squared)"),
            ("t", t),
            ("x", x),
            ("y", y),
            ("z", z),
            ("s_x", "sqrt(1+t^2*(2-y^2-z^2))"),
            ("s_y", "sqrt(1+t^2*(2-z^2-x^2))"),
            ("s_z", "sqrt(1+t^2*(2-x^2-y^2))"),
            ("diagonal", diagonal),
            ("xy", "y/s_x+x/s_y"),
            ("xz", "z/s_x+x/s_z"),
            ("yz", "z/s_y+y/s_z"),
        ];
        let mut builder = Builder::default();
        let coordinates = ["u_y", "u_z", "kappa"].into_iter().enumerate();
        let coordinates = coordinates.map(|(k, name)| (name, builder.tape.coordinate(k)));
        let mut names: Names<'_> = coordinates.collect();
        for (name, text) in definitions {
            let expression = Expression::try_from(text.to_owned());
            let expression = expression.map_err(|_| malformed(name, "a number"))?;
            names.insert(name, builder.compiled(&names, &expression)?);
        }
        let entries = ["diagonal", "xy", "xz", "yz"].map(|name| names[name]);
        Ok(Part { face, least, greatest, tape: builder.tape, entries })
    }

    /// The cell of its tree, rounded outward.
    ///
    /// # Errors
    /// If the least `kappa` cannot be enclosed.
    pub fn root<Z: Integer>(&self, bits: u32) -> Result<Cell<Z>, ClaimError> {
        let kappa = || {
            let (least, greatest) =
                (enclosed(&self.least, 0, bits)?, enclosed(&self.greatest, 0, bits)?);
            let whole = Interval { lo: Z::scaled(0, bits)?, hi: Z::scaled(1, bits)? };
            let kappa = narrowed(&Interval { lo: least.lo, hi: greatest.hi })?;
            Some(Cell(vec![whole.clone(), whole, kappa]))
        };
        kappa().ok_or_else(|| malformed("psi_max", "a number"))
    }

    /// Whether the evidence shows that `F >= 0`, and `S_i > 0`, on a cell, given for each coordinate its
    /// centre, range and half-width.
    pub fn shows<E: Enclosure>(
        &self,
        e: &E,
        edges: &[[E::Number; 3]],
        evidence: &Evidence,
    ) -> bool {
        let [y, z, kappa] = edges else { return false };
        let shown = || match evidence {
            // If F is positive definite at the vertices of the cell, F > 0 on it.
            Evidence::Test => Some(self.is_definite(Slopes::new(e, 3), edges, Vertex::all(3))),
            Evidence::Corner(corner) if *corner == self.face => self.tight_edge(e, [y, z, kappa]),
            Evidence::Mirror => {
                let ([least, _], [_, greatest]) = (e.ends(&y[1]), e.ends(&z[1]));
                Some(e.is_nonnegative(&e.sub(&least, &greatest)?))
            }
            _ => None,
        };
        shown().unwrap_or(false)
    }

    /// **Tight edge.** For every `kappa`, let `Q` be the face's own corner, `u = 0` or `u = 1`, and
    /// `u = Q + lambda h`, `lambda` in `[0, 1]^2`: if `F` is positive definite at the vertices `lambda`
    /// other than `Q`, then `F >= 0` on the cell, as far as it is within `[0, 1]^2`.
    ///
    /// *Proof.* At `Q` all `eta_k` are -1, or all are 1, and `S_i = 1`: `F(Q) = (d - o) I + o 11^T` with
    /// `d = 2/tau`, `o = -2` or `2`, and the eigenvalues
    ///
    /// ```text
    /// Q_1   d + 2 o = 0        d - o = 6
    /// Q_2   d + 2 o = d + 4    d - o = d - 2 = 0 for kappa <= 1/2, 4 kappa - 2 >= 0 for kappa >= 1/2
    /// ```
    ///
    /// A convex combination of `F(Q) >= 0` with positive definite matrices is positive semidefinite. ∎
    /// The centre is `Q` for whichever `kappa` it is, all of which are enclosed at once: slopes in
    /// `kappa` would make `F(Q)`, which is singular, one of many matrices to be shown definite.
    fn tight_edge<E: Enclosure>(&self, e: &E, edges: [&[E::Number; 3]; 3]) -> Option<bool> {
        let [y, z, [_, kappa, _]] = edges;
        let from = e.integer(if self.face == Corner::Q1 { 0 } else { 1 })?;
        let about = |[_, range, _]: &[E::Number; 3]| {
            let [least, greatest] = e.ends(range);
            let end = if self.face == Corner::Q1 { greatest } else { least };
            Some([from.clone(), range.clone(), e.sub(&end, &from)?])
        };
        let edges = [about(y)?, about(z)?, [kappa.clone(), kappa.clone(), e.integer(0)?]];
        let corners = unit_corners(3);
        let slopes = Slopes { part: Some(&corners), ..Slopes::new(e, 3) };
        Some(self.is_definite(slopes, &edges, Vertex::all(2).skip(1)))
    }

    /// Whether `F` is positive definite at these vertices of a cell.
    fn is_definite<E: Enclosure>(
        &self,
        slopes: Slopes<'_, E>,
        edges: &[[E::Number; 3]],
        mut vertices: impl Iterator<Item = Vertex>,
    ) -> bool {
        let values = evaluate(&self.tape, &[], slopes, edges);
        let [d, off @ ..] = self.entries;
        let of = |i, j| values.of(if i == j { d } else { off[i + j - 1] });
        vertices.all(|v| {
            Triangle::new(3, |i, j| slopes.at(of(i, j)?, v))
                .is_some_and(|f| is_positive_definite(slopes.arithmetic, &f))
        })
    }
}

/// The trees of all parts, one after the other.
///
/// **Mirror.** On a face, a cell on which `u_y >= u_z` throughout needs no proof of its own. *Proof.*
/// Fix `kappa`. Exchanging `y` and `z` maps the face to itself, `F` to `Pi F Pi^T`, and permutes the
/// `S_i`. A point with `u_y < u_z` is in no such cell, so in a leaf on whose path `S_i > 0` and
/// `F >= 0` are shown otherwise, on all of a closed cell. A point with `u_y > u_z` is the image of one
/// of those. A point with `u_y = u_z` is a limit of them: as there are finitely many leaves, it lies in
/// one of theirs. ∎
impl Theorem for Vec<Part> {
    fn is_proved<Z: Integer>(&self, tree: &Tree) -> Result<(), Rejected> {
        let bits = tree.precision;
        let longest = self.iter().map(|part| part.tape.ops().len()).max().unwrap_or_default();
        if tree.nodes.len().saturating_mul(2 * longest * (1 + bits as usize / 64)) > MOST_WORK {
            return Err(Rejected::Work);
        }
        let arithmetic = Fixed::<Z>::new(bits);
        let mut nodes = tree.nodes.iter().enumerate();
        for part in self {
            let step = |at: usize, node: &Node, (cell, _): Of<'_, Z>, open: &mut [bool]| {
                if node.fails.is_some() || !node.at.is_empty() {
                    return Err(Rejected::Shape(at));
                }
                let edges = cell.edges().ok_or(Rejected::Shape(at))?;
                discharge(at, node, open, |_, evidence| part.shows(&arithmetic, &edges, evidence))
            };
            bisect(&mut nodes, (&part.root(bits)?, &[]), 1, false, step)?;
        }
        nodes.next().map_or(Ok(()), |(at, _)| Err(Rejected::Shape(at)))
    }
}

/// Accepts a proof, or says why not.
pub(crate) fn check(claim: &PostulateClaim, tree: &Tree) -> Result<(), Rejected> {
    tree::check(&parts(claim)?, tree)
}

/// What an accepted claim establishes.
pub fn statement(claim: &PostulateClaim) -> String {
    let psi_max = match &claim.psi_max {
        PsiMax::Every(Every::All) => "every psi_max > 1".to_owned(),
        PsiMax::Of(Quantity::Exactly(psi)) => format!("psi_max = {psi}"),
        PsiMax::Of(Quantity::Between { min, max }) => format!("every psi_max from {min} to {max}"),
    };
    format!(
        "\
It is proved:
For {psi_max},
for every Orthoglide of leg length L > 0, guides along the axes and P measured
from the point where they meet, with kappa = 1/psi_max, t1 = (1 - kappa)/2,
t2 = 1 - kappa if kappa <= 1/2 and (1/kappa - 1)/2 otherwise,
q1 = -L t1/sqrt(1 + 2 t1^2) and q2 = L t2/sqrt(1 + 2 t2^2):
at every point P of the cube [q1, q2]^3, every leg reaches P without a serial
singularity, P is no parallel singularity, and the velocity transmission factors
psi_i satisfy 1/psi_max <= psi_i <= psi_max. The joint coordinates at two points
of the cube that are d apart are from d/psi_max to psi_max d apart, so that no
two points have the same.
"
    )
}
