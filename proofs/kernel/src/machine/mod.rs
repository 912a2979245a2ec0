//! Drives and motions: the formulas of `A x' = B rho'`, leg by leg.
//!
//! A drive meets the platform through `w = P + R d - a` alone, from the base end `a` of the leg to its
//! platform end `P + R d`, where `R = I` unless the platform turns. Signs of working modes are
//! constants: `m = 1` or `-1`.

pub(crate) mod motion;

use crate::formula::{coordinates, formula, Formula, Tape, Term, Vector};
use crate::test::Row;

/// A leg's, or joint's, formulas.
#[derive(Clone, Debug)]
pub struct Leg {
    /// `A_i` in the platform's velocity or twist, and `D_i = B_i^2`.
    pub row: Row<Formula>,
    /// The same divided by `B_i`: the row of `M`, and 1.
    pub divided: Row<Formula>,
    /// `w A_i` and `w D_i` as polynomials, `w` the problem's weight; of struts of platforms that turn.
    pub scaled: Option<Row<Formula>>,
    /// The joint coordinate; none where a claim gives the row alone.
    pub rho: Option<Joint>,
    /// The vector `A_i` in space; none of joints that a claim gives.
    pub vector: Option<Vector>,
    /// Its length, where it is that of a leg.
    pub length: Option<Formula>,
    /// `eta_i^2`, of legs of fixed length: `eta_i` is the leg's component along the motion of its
    /// driven end.
    pub eta_squared: Option<Formula>,
    /// The platform end `P + d`, of a leg with two ends.
    pub tip: Option<Vector>,
    /// `d`, and `u = A/B` in space: the joint's rate is `u` times the velocity of that end.
    pub driven: Option<[Vector; 2]>,
    /// The base end of a strut, and its platform end in the platform's frame.
    pub ends: Option<[Vector; 2]>,
    /// The couple that the leg constrains, not normalised, and the square of its length; where one is
    /// claimed.
    pub couple: Option<Row<Formula>>,
}

impl Leg {
    /// Whether the joint coordinate is an angle: `M` is then in radians per length.
    pub fn is_angular(&self) -> bool {
        matches!(self.rho, Some(Joint::Angle { .. }))
    }

    /// The length of the leg itself, of which `A_i` is the vector; none of planes, whose normal has the
    /// length 1 and is `D_i` at once.
    pub fn rod(&self) -> Option<Formula> {
        self.length.filter(|&length| length != self.row.d)
    }
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
    let along = formula!(tape; n . w);
    let r = formula!(tape; w - (along * n));
    let d = formula!(tape; (length ^ 2) - (r . r));
    let root = tape.sqrt(d);
    let eta = signed(tape, m, root);
    let a = formula!(tape; r + (eta * n)).to_vec();
    // (r + eta n)/eta, with the guide's part left whole.
    let divided = formula!(tape; n + (r / eta)).to_vec();
    let rho = Joint::Length(tape.sub(along, eta));
    leg(tape, Row { a, d }, divided, rho, (Some(length), Some(d)))
}

/// An extensible leg: `A = w`, `D = |w|^2`, `rho = |w|`. *Velocity.* `w . P' = |w| rho'`.
pub fn strut(tape: &mut Tape, w: &Vector) -> Leg {
    let d = formula!(tape; w . w);
    let length = tape.sqrt(d);
    let divided = formula!(tape; w / length).to_vec();
    leg(tape, Row { a: w.to_vec(), d }, divided, Joint::Length(length), (Some(length), None))
}

/// A leg that holds the platform in a plane moved along its normal `n`: `A = n`, `D = 1`,
/// `rho = n . w`.
pub fn planar(tape: &mut Tape, w: &Vector, n: &Vector) -> Leg {
    let d = tape.integer(1);
    let rho = Joint::Length(tape.dot(n, w));
    leg(tape, Row { a: n.to_vec(), d }, n.to_vec(), rho, (Some(d), None))
}

/// A leg of length `L` on an arm of length `r` that turns about the unit axis `k`; `e` is the arm's
/// direction at angle 0, a unit vector orthogonal to `k`, and `f = k x e`.
///
/// ```text
/// alpha = w . e    beta = w . f    kappa = k . w    n = alpha^2 + beta^2    x = L^2 - kappa^2
/// g = (n + r^2 - x)/(2 r)    d = n - g^2    eta = m sqrt(d)    D = r^2 d
/// (c, m s) = elbow(alpha/r, m beta/r, x/r^2)    A = w - r (c e + s f)    theta = (c, s)
/// ```
///
/// *Closure.* `u = c e + s f` is a unit vector, and
/// `|A|^2 = (alpha - r c)^2 + (beta - r s)^2 + kappa^2 = x + kappa^2 = L^2`.
/// *Velocity.* `A . P' = theta' A . (r k x u)`, and `A . (k x u) = beta c - alpha s = eta`, as
/// `(beta c - alpha s)^2 = n - (alpha c + beta s)^2 = n - g^2`, and `m (beta c - alpha s) > 0`.
pub fn arm(
    tape: &mut Tape,
    w: &Vector,
    [k, e]: [&Vector; 2],
    [r, length]: [Formula; 2],
    m: i64,
) -> Leg {
    let f = tape.cross(k, e);
    let [alpha, beta, kappa] = [(w, e), (w, &f), (k, w)].map(|(u, v)| tape.dot(u, v));
    let n = formula!(tape; (alpha ^ 2) + (beta ^ 2));
    let x = formula!(tape; (length ^ 2) - (kappa ^ 2));
    let g = formula!(tape; (n + ((r ^ 2) - x)) / (2 * r));
    let d = formula!(tape; n - (g ^ 2));
    let (root, b) = (formula!(tape; r * (sqrt d)), formula!(tape; beta / r));
    let (root, b) = (signed(tape, m, root), signed(tape, m, b));
    let (a, t) = (formula!(tape; alpha / r), formula!(tape; x / (r ^ 2)));
    let [cos, sin] = tape.elbow([a, b, t]);
    let sin = signed(tape, m, sin);
    let a = formula!(tape; w - (r * ((cos * e) + (sin * f))));
    let divided = formula!(tape; a / root).to_vec();
    let row = Row { a: a.to_vec(), d: formula!(tape; (r ^ 2) * d) };
    leg(tape, row, divided, Joint::Angle { cos, sin }, (Some(length), Some(d)))
}

fn leg(
    tape: &mut Tape,
    row: Row<Formula>,
    divided: Vec<Formula>,
    rho: impl Into<Option<Joint>>,
    (length, eta_squared): (Option<Formula>, Option<Formula>),
) -> Leg {
    let divided = Row { a: divided, d: tape.integer(1) };
    let (rho, vector) = (rho.into(), row.a.as_slice().try_into().ok());
    let vector = vector.filter(|_| length.is_some());
    let (tip, driven, ends, couple) = (None, None, None, None);
    let scaled = None;
    Leg { row, divided, scaled, rho, vector, length, eta_squared, tip, driven, ends, couple }
}

/// The couple that a strut with universal joints constrains whose axis in the base, and on the platform,
/// is along the unit vector `k`: `c = w - (k . w) k`, and `|c|^2`.
///
/// The other two axes are parallel to each other and orthogonal to `k` and to the leg, so along `k x w`.
/// A couple that does no work in rotations about `k` and `k x w` is along
/// `(k x w) x k = w - (k . w) k`.
pub fn couple(tape: &mut Tape, w: &Vector, k: &Vector) -> Row<Formula> {
    let c = formula!(tape; w - ((k . w) * k));
    Row { d: formula!(tape; c . c), a: c.to_vec() }
}

fn signed(tape: &mut Tape, m: i64, formula: Formula) -> Formula {
    if m < 0 {
        tape.neg(formula)
    } else {
        formula
    }
}

/// A joint by its coordinate alone: with `rho' = N/E` over the `m` coordinates, `A = N`, `D = E^2`.
///
/// Where `rho` is defined, `E` is not zero: a derivative `E/E` is 1.
pub fn joint(tape: &mut Tape, rho: Formula, m: usize) -> Leg {
    let gradient = tape.gradient(rho, &coordinates(m));
    let d = tape.square_without_roots(gradient.denominator);
    let root = gradient.denominator;
    let mut quotient = |a| if a == root { tape.integer(1) } else { tape.div(a, root) };
    let divided = gradient.numerators.iter().map(|&a| quotient(a)).collect();
    let row = Row { a: gradient.numerators, d };
    leg(tape, row, divided, Joint::Length(rho), (None, None))
}

/// A joint by its row of `M` alone.
pub fn row(tape: &mut Tape, a: Vec<Formula>) -> Leg {
    let row = Row { a, d: tape.integer(1) };
    let divided = row.a.clone();
    leg(tape, row, divided, None, (None, None))
}
