//! Drives and motions: the formulas of `A x' = B rho'`, leg by leg.
//!
//! A drive meets the platform through `w = P + d - a` alone, from the base end `a` of the leg to its
//! platform end `P + d`. Signs of working modes are constants: `m = 1` or `-1`.

use crate::formula::{Formula, Tape, Vector};
use crate::test::Row;

/// A leg's formulas.
#[derive(Clone, Debug)]
pub struct Leg {
    /// `A_i` in the velocity of the platform's joint, and `D_i = B_i^2`.
    pub row: Row<Formula>,
    /// The joint coordinate.
    pub rho: Joint,
}

/// A joint coordinate.
#[derive(Clone, Copy, Debug)]
pub enum Joint {
    /// A length.
    Length(Formula),
    /// An angle, by its cosine and sine.
    Angle {
        /// The cosine.
        cos: Formula,
        /// The sine.
        sin: Formula,
    },
}

/// A fixed-length leg on a linear guide of unit direction `n`.
///
/// ```text
/// r = w - (n . w) n     D = L^2 - |r|^2     eta = m sqrt(D)     A = r + eta n     rho = n . w - eta
/// ```
///
/// *Closure.* `A` is the leg: `|A|^2 = |r|^2 + D = L^2`, and its base end `w - A = rho n` is on the
/// guide. *Velocity.* `A . (P' - rho' n) = 0`, and `A . n = eta`.
pub fn slider(tape: &mut Tape, w: &Vector, n: &Vector, length: Formula, m: i64) -> Leg {
    let along = tape.dot(n, w);
    let axial = tape.scaled(along, n);
    let r = tape.minus(w, &axial);
    let (reach, off) = (tape.sqr(length), tape.norm_squared(&r));
    let d = tape.sub(reach, off);
    let root = tape.sqrt(d);
    let eta = signed(tape, m, root);
    let axial = tape.scaled(eta, n);
    let a = tape.plus(&r, &axial).to_vec();
    Leg { row: Row { a, d }, rho: Joint::Length(tape.sub(along, eta)) }
}

/// An extensible leg: `A = w`, `D = |w|^2`, `rho = |w|`. *Velocity.* `w . P' = |w| rho'`.
pub fn strut(tape: &mut Tape, w: &Vector) -> Leg {
    let d = tape.norm_squared(w);
    Leg { row: Row { a: w.to_vec(), d }, rho: Joint::Length(tape.sqrt(d)) }
}

/// A leg that holds the platform in a plane moved along its normal `n`: `A = n`, `D = 1`,
/// `rho = n . w`.
pub fn planar(tape: &mut Tape, w: &Vector, n: &Vector) -> Leg {
    let d = tape.integer(1);
    Leg { row: Row { a: n.to_vec(), d }, rho: Joint::Length(tape.dot(n, w)) }
}

/// A leg of length `L` on an arm of length `r` that turns about the unit axis `k`; `e` is the arm's
/// direction at angle 0, a unit vector orthogonal to `k`, and `f = k x e`.
///
/// ```text
/// h = (w . e) e + (w . f) f      N = |h|^2      g = (|w|^2 + r^2 - L^2)/(2r)
/// D = (L^2 - (k . w)^2) - (g - r)^2             eta = m r sqrt(D)
/// cos theta = (g (w . e) + m sqrt(D) (w . f))/N
/// sin theta = (g (w . f) - m sqrt(D) (w . e))/N
/// A = w - r (cos theta e + sin theta f)
/// ```
///
/// *Closure.* With `u = cos theta e + sin theta f`: `D = N - g^2`, so `|u| = 1`, and `u . w = g` gives
/// `|A|^2 = |w|^2 + r^2 - 2 r g = L^2`. *Velocity.* `A . (P' - r theta' k x u) = 0`, and
/// `A . (k x u) = w . (cos theta f - sin theta e) = m sqrt(D)`, so that `A . P' = eta theta'`.
pub fn arm(
    tape: &mut Tape,
    w: &Vector,
    [k, e]: [&Vector; 2],
    [r, length]: [Formula; 2],
    m: i64,
) -> Leg {
    let f = tape.cross(k, e);
    let (alpha, beta, along) = (tape.dot(w, e), tape.dot(w, &f), tape.dot(k, w));
    let (square_e, square_f, square_k) = (tape.sqr(alpha), tape.sqr(beta), tape.sqr(along));
    let n = tape.add(square_e, square_f);
    let (r_squared, reach) = (tape.sqr(r), tape.sqr(length));
    let w_squared = tape.add(n, square_k);
    let (excess, two) = (tape.sub(r_squared, reach), tape.integer(2));
    let (numerator, divisor) = (tape.add(w_squared, excess), tape.mul(two, r));
    let g = tape.div(numerator, divisor);
    let (across, shift) = (tape.sub(reach, square_k), tape.sub(g, r));
    let shift = tape.sqr(shift);
    let d = tape.sub(across, shift);
    let root = tape.sqrt(d);
    let root = signed(tape, m, root);
    let mut component = |p: Formula, q: Formula, add: bool| {
        let (p, q) = (tape.mul(g, p), tape.mul(root, q));
        let sum = if add { tape.add(p, q) } else { tape.sub(p, q) };
        tape.div(sum, n)
    };
    let (cos, sin) = (component(alpha, beta, true), component(beta, alpha, false));
    let (along_e, along_f) = (tape.scaled(cos, e), tape.scaled(sin, &f));
    let u = tape.plus(&along_e, &along_f);
    let elbow = tape.scaled(r, &u);
    let a = tape.minus(w, &elbow).to_vec();
    let d = tape.mul(r_squared, d);
    Leg { row: Row { a, d }, rho: Joint::Angle { cos, sin } }
}

fn signed(tape: &mut Tape, m: i64, formula: Formula) -> Formula {
    if m < 0 {
        tape.neg(formula)
    } else {
        formula
    }
}

/// A row from the joint coordinate alone: with `rho' = N/E` over the coordinates, `A = N`, `D = E^2`.
pub fn row_of(tape: &mut Tape, rho: Formula, m: usize) -> Row<Formula> {
    let gradient = tape.gradient(rho, m);
    let d = tape.square_without_roots(gradient.denominator);
    Row { a: gradient.numerators, d }
}
