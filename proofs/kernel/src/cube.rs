//! The paper's cube: its corners and leg length, from `psi_max` and its side.

use crate::claim::{Leg, MachineClaim, Quantity, Sign};
use crate::input::{binary, number_error, ordered, positive, shape_error, sign, ClaimError};
use crate::number::{Expression, Operator};
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
        use Operator::{Add, Div, Mul, Sub};
        let place = "requirements.transmission";
        let psi = quantity::psi_max(claim)
            .ok_or_else(|| shape_error(place, "a greatest psi, for the paper's cube"))?;
        let one = Expression::integer(1);
        positive("workspace.side", side)?;
        ordered(place, &one, psi, true)?;
        let two = Expression::integer(2);
        let kappa = binary(Div, &one, psi);
        let rest = binary(Sub, &one, &kappa);
        let t1 = binary(Div, &rest, &two);
        let above = sign(&binary(Sub, psi, &two));
        let below = sign(&binary(Sub, &two, psi));
        let t2 = match (above, below) {
            (Some([_, true]), _) => rest,
            (_, Some([_, true])) => binary(Div, &binary(Sub, psi, &one), &two),
            _ => return Err(number_error(place, "told from 2")),
        };
        // sin(beta) = t/sqrt(1 + 2 t^2).
        let sine = |t: &Expression| {
            let square = binary(Mul, &two, &binary(Mul, t, t));
            binary(Div, t, &Expression::Sqrt(Box::new(binary(Add, &one, &square))))
        };
        let (s1, s2) = (sine(&t1), sine(&t2));
        let length = binary(Div, side, &binary(Add, &s1, &s2));
        let q1 = Expression::Neg(Box::new(binary(Mul, &length, &s1)));
        let q2 = binary(Mul, &length, &s2);
        let base = binary(Sub, &binary(Sub, &q1, offset), &length);
        let zero = Expression::integer(0);
        let along = |i: usize, x: &Expression| {
            let entry = |k| Quantity::Exactly(if i == k { x.clone() } else { zero.clone() });
            (0..3).map(entry).collect()
        };
        let leg = |i: usize| Leg::Slider {
            direction: along(i, &one),
            anchor: along(i, &base),
            platform: along(i, &Expression::Neg(Box::new(offset.clone()))),
            length: Quantity::Exactly(length.clone()),
            mode: Sign::Plus,
        };
        Ok(Cube { kappa, legs: (0..3).map(leg).collect(), q1, q2 })
    }
}
