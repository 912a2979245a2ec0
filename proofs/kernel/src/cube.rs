//! The paper's cube: its corners and leg length, from `psi_max` and its side.
//!
//! ```text
//! kappa = 1/psi_max    t_1 = (1 - kappa)/2    t_2 = 1 - kappa            for kappa <= 1/2
//! q_1 = -L t_1/sqrt(1 + 2 t_1^2)                  = (1/kappa - 1)/2      for kappa >= 1/2
//! q_2 =  L t_2/sqrt(1 + 2 t_2^2)              q_2 - q_1 = side
//! ```
//!
//! **Lemma (upper bound).** `sigma_max(M) <= 1/kappa` at every point of the cube `[q_1, q_2]^3`. *Proof.*
//! `M` has ones on its diagonal and `P_j/s_i` off it, `s_i^2 = L^2 - P_j^2 - P_k^2`. As `t_1 <= t_2` and
//! `t/sqrt(1 + 2 t^2)` increases, `|P_j| <= q_2`, and `s_i^2 >= L^2 - 2 q_2^2 = q_2^2/t_2^2`. So
//! `|M_ij| <= t_2` for `i != j`, and `|M|_2^2 <= |M|_1 |M|_inf <= (1 + 2 t_2)^2`. For `kappa >= 1/2` that
//! is `1/kappa^2`; for `kappa <= 1/2`, `1 + 2 t_2 = 3 - 2 kappa <= 1/kappa`, since
//! `1 - 3 kappa + 2 kappa^2 = (1 - kappa)(1 - 2 kappa) >= 0`. ∎ A claim with `psi_min <= kappa` asks for no
//! more; one with a greater `psi_min` has to be shown otherwise.
//!
//! **Lemma (joint coordinates).** `rho_i >= 0` at every point of the cube, so that `rho_i >= min` for every
//! `min <= 0`. *Proof.* With the anchor `a = q_1 - offset - L` and the joint at `P_i - offset`,
//! `rho_i = P_i - offset - a - s_i = (P_i - q_1) + (L - s_i)`, `P_i >= q_1` and `s_i <= L`. ∎ It is 0 where
//! `P_i = q_1` and the others are 0: a point that enclosures never settle.

use crate::claim::{Bound, Leg, MachineClaim, Quantity, Sign};
use crate::input::{malformed, ordered, positive, sign, ClaimError};
use crate::number::Expression;
use crate::quantity;

/// The paper's Steps 1 to 3.
pub(crate) struct Cube {
    /// `1/psi_max`.
    pub kappa: Expression,
    pub q1: Expression,
    pub q2: Expression,
    pub legs: Vec<Leg>,
}

impl Cube {
    pub fn new(
        claim: &MachineClaim,
        offset: &Expression,
        side: &Expression,
    ) -> Result<Self, ClaimError> {
        let place = "requirements.transmission";
        let psi = quantity::psi(claim, Bound::greatest)
            .ok_or_else(|| malformed(place, "a greatest psi, for the paper's cube"))?;
        let one = Expression::integer(1);
        positive("workspace.side", side)?;
        ordered(place, &one, psi, true)?;
        let two = Expression::integer(2);
        let kappa = &one / psi;
        let rest = &one - &kappa;
        let t1 = &rest / &two;
        let above = sign(&(psi - &two));
        let below = sign(&(&two - psi));
        let t2 = match (above, below) {
            (Some([_, true]), _) => rest,
            (_, Some([_, true])) => &(psi - &one) / &two,
            _ => return Err(malformed(place, "told from 2")),
        };
        // sin(beta) = t/sqrt(1 + 2 t^2).
        let sine = |t: &Expression| {
            let square = &two * &(t * t);
            t / &Expression::Sqrt((&one + &square).into())
        };
        let (s1, s2) = (sine(&t1), sine(&t2));
        let length = side / &(&s1 + &s2);
        let q1 = Expression::Neg((&length * &s1).into());
        let q2 = &length * &s2;
        let base = &(&q1 - offset) - &length;
        let zero = Expression::integer(0);
        let along = |i: usize, x: &Expression| {
            let entry = |k| Quantity::Exactly(if i == k { x.clone() } else { zero.clone() });
            (0..3).map(entry).collect()
        };
        let leg = |i: usize| Leg::Slider {
            direction: along(i, &one),
            anchor: along(i, &base),
            platform: along(i, &Expression::Neg(offset.clone().into())),
            length: Quantity::Exactly(length.clone()),
            mode: Sign::Plus,
        };
        Ok(Cube { kappa, legs: (0..3).map(leg).collect(), q1, q2 })
    }
}
