//! Motions: where coordinates put the platform, and a drive's row in the platform's twist.
//!
//! The platform's joint `b` is at `P + R b`. With the twist `(v, omega)`, velocity of `P` and angular
//! velocity, it moves at `v + omega x r`, `r = R b`, and
//!
//! ```text
//! A_i . (v + omega x r) = A_i . v + (r x A_i) . omega          row: [A_i, (r x A_i)/ell] in (v, ell omega)
//! ```
//!
//! for any drive: it meets the platform through `w = P + r - a` alone. In the plane the row has the
//! components x, y of the first part and z of the second, as the platform has no other; about a fixed
//! point, the second part alone.

use super::{Leg, Row};
use crate::formula::{Formula, Tape, Vector};

/// How a platform moves.
pub(crate) struct Motion {
    /// `P`.
    pub position: Vector,
    /// The components of `v` that there are.
    pub velocity: &'static [usize],
    /// How it turns, if it does.
    pub turn: Option<Turn>,
}

/// How a platform turns: `R = N/w`, `w >= 1`, of half-angle tangents.
pub(crate) struct Turn {
    /// `N`, row by row.
    pub matrix: [Vector; 3],
    /// `w`.
    pub weight: Formula,
    /// `ell`.
    pub length: Formula,
    /// The components of `omega` that there are.
    pub spin: &'static [usize],
}

impl Turn {
    /// `N b`.
    fn scaled(&self, tape: &mut Tape, b: &Vector) -> Vector {
        self.matrix.map(|row| tape.dot(&row, b))
    }

    /// `(r x u)/ell`, its components that there are.
    fn moment(&self, tape: &mut Tape, r: &Vector, u: &Vector) -> Vec<Formula> {
        let moment = tape.cross(r, u);
        self.spin.iter().map(|&k| tape.div(moment[k], self.length)).collect()
    }
}

impl Motion {
    /// `R b`.
    fn turned(&self, tape: &mut Tape, b: &Vector) -> Vector {
        match &self.turn {
            None => *b,
            Some(turn) => turn.scaled(tape, b).map(|x| tape.div(x, turn.weight)),
        }
    }

    /// The leg of a drive from `a` to the platform's joint `b`; `drive` makes it of `w`.
    pub fn leg(
        &self,
        tape: &mut Tape,
        [a, b]: [&Vector; 2],
        drive: impl FnOnce(&mut Tape, &Vector) -> Leg,
    ) -> Option<Leg> {
        let r = self.turned(tape, b);
        let joint = tape.plus(&self.position, &r);
        let w = tape.minus(&joint, a);
        let mut leg = drive(tape, &w);
        leg.tip = Some(joint);
        for row in [&mut leg.row, &mut leg.divided] {
            let u = Vector::try_from(row.a.as_slice()).ok()?;
            row.a = self.row(tape, &u, |tape, turn| turn.moment(tape, &r, &u));
        }
        Some(leg)
    }

    /// The components of `u` that there are, and then those of the moment.
    fn row(
        &self,
        tape: &mut Tape,
        u: &Vector,
        moment: impl FnOnce(&mut Tape, &Turn) -> Vec<Formula>,
    ) -> Vec<Formula> {
        let mut row: Vec<Formula> = self.velocity.iter().map(|&k| u[k]).collect();
        if let Some(turn) = &self.turn {
            row.extend(moment(tape, turn));
        }
        row
    }

    /// A strut. Its rows are simpler: `r x w = r x (P - a)`, as `w = P - a + r`.
    ///
    /// With `n = N b`, and since `|R b| = |b|`, both times `w` are polynomials, of degree two
    /// at most in each coordinate:
    ///
    /// ```text
    /// w A = [w (P - a) + n, (n x (P - a))/ell]      w D = w (|P - a|^2 + |b|^2) + 2 n . (P - a)
    /// ```
    pub fn strut(&self, tape: &mut Tape, [a, b]: [&Vector; 2]) -> Leg {
        let r = self.turned(tape, b);
        let joint = tape.plus(&self.position, &r);
        let w = tape.minus(&joint, a);
        let mut leg = super::strut(tape, &w);
        (leg.tip, leg.anchor) = (Some(joint), Some(*a));
        let from_base = match &self.turn {
            Some(_) => tape.minus(&self.position, a),
            None => w,
        };
        leg.row.a = self.row(tape, &w, |tape, turn| turn.moment(tape, &r, &from_base));
        let (unit, length) = (leg.divided.a.clone(), leg.length);
        if let (Ok(unit), Some(length)) = (Vector::try_from(unit.as_slice()), length) {
            leg.divided.a = self.row(tape, &unit, |tape, turn| {
                let from_base = from_base.map(|x| tape.div(x, length));
                turn.moment(tape, &r, &from_base)
            });
        }
        leg.scaled = self.turn.as_ref().map(|turn| self.scaled(tape, turn, [&from_base, a, b]));
        leg
    }

    /// `w A` and `w D` of a strut.
    fn scaled(
        &self,
        tape: &mut Tape,
        turn: &Turn,
        [from_base, a, b]: [&Vector; 3],
    ) -> Row<Formula> {
        let (n, two) = (turn.scaled(tape, b), tape.integer(2));
        // |P - a|^2 + |b|^2, in squares of coordinates alone.
        let mut square = tape.norm_squared(b);
        for (&p, &a) in self.position.iter().zip(a) {
            let part = tape.expanded(p, a);
            square = tape.add(square, part);
        }
        let (own, mixed) = (tape.mul(turn.weight, square), tape.dot(&n, from_base));
        let mixed = tape.mul(two, mixed);
        let along = tape.scaled(turn.weight, from_base);
        let along = tape.plus(&along, &n);
        let a = self.row(tape, &along, |tape, turn| turn.moment(tape, &n, from_base));
        Row { a, d: tape.add(own, mixed) }
    }
}
