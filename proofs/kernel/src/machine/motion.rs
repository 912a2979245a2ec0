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
use crate::formula::{formula, Formula, Op, Tape, Term, Vector};

/// How a platform moves.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// `P`.
    pub position: Vector,
    /// The components of `v` that there are.
    pub velocity: &'static [usize],
    /// How it turns, if it does.
    pub turn: Option<Turn>,
    /// `c`, of a platform turned on by the rotation with these half-angle tangents.
    pub moved: Option<Vector>,
}

/// How a platform turns: `R = N/w`, `w >= 1`, of half-angle tangents.
#[derive(Clone, Debug)]
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
    /// `R b`. Turned on by `C`, it is `C R b = r + 2 (c x r + c x (c x r))/(1 + |c|^2)`, `r = R b`.
    pub fn turned(&self, tape: &mut Tape, b: &Vector) -> Vector {
        let r = match &self.turn {
            None => *b,
            Some(turn) => {
                let n = turn.scaled(tape, b);
                formula!(tape; n / { turn.weight })
            }
        };
        let Some(c) = &self.moved else { return r };
        let across = tape.cross(c, &r);
        let twice = tape.cross(c, &across);
        let rate = Motion::rate(tape, c);
        formula!(tape; r + (rate * (across + twice)))
    }

    /// `2/(1 + |c|^2)`.
    fn rate(tape: &mut Tape, c: &Vector) -> Formula {
        formula!(tape; 2 / (1 + (c . c)))
    }

    /// The row of the derivatives of a joint by the components of `P` that there are, and by those of `c`,
    /// for a platform that is turned on by `c`:
    ///
    /// ```text
    /// [u, 2 (mu + mu x c)/(1 + |c|^2)]      mu = r x u
    /// ```
    ///
    /// *Proof.* The joint's rate is `u . v + mu . omega`, `r` and `u` those of the pose turned on, and
    /// `omega = 2 (c' + c x c')/(1 + |c|^2)`: rotations with tangents `a`, and `b` before it, have together
    /// `(a + b + a x b)/(1 - a . b)`, so that with `a = omega t/2`, to first order in `t`,
    /// `c' = (omega + omega x c + (omega . c) c)/2`, which is that. And `mu . (c x c') = (mu x c) . c'`. ∎
    pub fn onward(&self, tape: &mut Tape, [r, u]: &[Vector; 2]) -> Vec<Formula> {
        let mut row: Vec<Formula> = self.velocity.iter().map(|&k| u[k]).collect();
        if let Some((turn, c)) = self.turn.as_ref().zip(self.moved.as_ref()) {
            let moment = tape.cross(r, u);
            let across = tape.cross(&moment, c);
            let rate = Motion::rate(tape, c);
            let turned = formula!(tape; rate * (moment + across));
            row.extend(turn.spin.iter().map(|&k| turned[k]));
        }
        row
    }

    /// The leg of a drive from `a` to the platform's joint `b`; `drive` makes it of `w`.
    pub fn leg(
        &self,
        tape: &mut Tape,
        [a, b]: [&Vector; 2],
        drive: impl FnOnce(&mut Tape, &Vector) -> Leg,
    ) -> Option<Leg> {
        let r = self.turned(tape, b);
        let joint = formula!(tape; { self.position } + r);
        let w = formula!(tape; joint - a);
        let mut leg = drive(tape, &w);
        leg.tip = Some(joint);
        leg.driven = Vector::try_from(leg.divided.a.as_slice()).ok().map(|u| [r, u]);
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
        let joint = formula!(tape; { self.position } + r);
        let w = formula!(tape; joint - a);
        let mut leg = super::strut(tape, &w);
        (leg.tip, leg.ends) = (Some(joint), Some([*a, *b]));
        let from_base = match &self.turn {
            Some(_) => formula!(tape; { self.position } - a),
            None => w,
        };
        leg.row.a = self.row(tape, &w, |tape, turn| turn.moment(tape, &r, &from_base));
        let (unit, length) = (leg.divided.a.clone(), leg.length);
        if let (Ok(unit), Some(length)) = (Vector::try_from(unit.as_slice()), length) {
            leg.driven = Some([r, unit]);
            leg.divided.a = self.row(tape, &unit, |tape, turn| {
                let from_base = formula!(tape; from_base / length);
                turn.moment(tape, &r, &from_base)
            });
        }
        let turn = self.turn.as_ref().filter(|_| self.moved.is_none());
        leg.scaled = turn.map(|turn| self.scaled(tape, turn, [&from_base, a, b]));
        leg
    }

    /// `w` times the vector of a strut from `a` to the platform's joint `b`, in the base or in the
    /// platform's frame, where it is `R^T (P - a) + b`: polynomials, of degree two at most in each
    /// coordinate. `w` itself where the platform does not turn.
    pub fn vector(&self, tape: &mut Tape, [a, b]: &[Vector; 2], on_platform: bool) -> Vector {
        let from_base = formula!(tape; { self.position } - a);
        let Some(turn) = &self.turn else { return formula!(tape; from_base + b) };
        let (turned, still) = if on_platform { (&from_base, b) } else { (b, &from_base) };
        let still = formula!(tape; { turn.weight } * still);
        let turned = if on_platform {
            let n = &turn.matrix;
            [0, 1, 2].map(|k| tape.dot(&[n[0][k], n[1][k], n[2][k]], turned))
        } else {
            turn.scaled(tape, turned)
        };
        formula!(tape; still + turned)
    }

    /// The upper triangle of `2 H`, with which the joint's acceleration is
    /// `M_i . x' + x^T H x` for the twist `x = (v, ell omega)` and `x' = (a, ell alpha)`.
    ///
    /// ```text
    /// 2 H = J^T (U + U^T) J + K    J x = v + omega x r    U = du/dC
    /// K   = (u_k r_l + u_l r_k - 2 (u . r) [k = l])/ell^2 in components k, l of omega, 0 elsewhere
    /// ```
    ///
    /// *Proof.* The leg's joint on the platform is `C = P + r`, with `C' = J x` and
    /// `C'' = a + alpha x r + omega x (omega x r)`. The rate of the joint is `u . C'`
    /// ([`Leg::driven`](super::Leg::driven)), and `u` depends on the pose through `C` alone, as the drive
    /// does: its acceleration is `u . C'' + (U C') . C'`. Of that `u . (a + alpha x r)` is `M_i . x'`, and
    /// `u . (omega x (omega x r)) = (u . omega)(r . omega) - (u . r) |omega|^2`. ∎ `H` is not the second
    /// derivative by coordinates of orientation.
    ///
    /// `U` is derived by the entries of `C`, wherever they occur in `u`. An entry of `u` that is also that
    /// of `C_k` is `C_k` at every pose, and so along every motion, whatever it was built as. Two components
    /// that are one entry are those of a joint at the centre of rotations about a point, where `J = 0`.
    ///
    /// `None` of a platform that does not turn, and where an entry of `C` is a number.
    pub fn curved(
        &self,
        tape: &mut Tape,
        [r, u]: &[Vector; 2],
        tip: &Vector,
    ) -> Option<Vec<Vec<Formula>>> {
        let (zero, one) = (tape.integer(0), tape.integer(1));
        let turn = self.turn.as_ref()?;
        // In the plane nothing moves along z.
        let moves = if self.velocity.len() == 2 { 2 } else { 3 };
        let by: Vec<Op> = tip[..moves].iter().map(|&c| tape.op(c)).collect();
        if by.iter().any(|op| matches!(op, Op::Integer(_) | Op::Parameter(_))) {
            return None;
        }
        let unit = |k: usize| std::array::from_fn(|j| if j == k { one } else { zero });
        let mut columns: Vec<Vector> = self.velocity.iter().map(|&k| unit(k)).collect();
        for &k in turn.spin {
            let across = tape.cross(&unit(k), r);
            columns.push(formula!(tape; across / { turn.length }));
        }
        let gradient = |u: &Formula| tape.gradient(*u, &by).quotients(tape);
        let slopes: Vec<Vec<Formula>> = u[..moves].iter().map(gradient).collect();
        let mut images = vec![[zero; 3]; columns.len()];
        for (image, column) in images.iter_mut().zip(&columns) {
            for (j, k) in (0..moves).flat_map(|j| (0..moves).map(move |k| (j, k))) {
                let both = tape.add(slopes[j][k], slopes[k][j]);
                image[j] = formula!(tape; { image[j] } + (both * { column[k] }));
            }
        }
        let (twice, square) = (formula!(tape; 2 * (u . r)), tape.sqr(turn.length));
        let spin = |i: usize| turn.spin.get(i.checked_sub(self.velocity.len())?).copied();
        let mut entry = |i: usize, j: usize| {
            let own = tape.dot(&columns[i], &images[j]);
            let (Some(k), Some(l)) = (spin(i), spin(j)) else { return own };
            let both = formula!(tape; ({ u[k] } * { r[l] }) + ({ u[l] } * { r[k] }));
            let part = if k == l { tape.sub(both, twice) } else { both };
            formula!(tape; own + (part / square))
        };
        let n = columns.len();
        Some((0..n).map(|i| (i..n).map(|j| entry(i, j)).collect()).collect())
    }

    /// `w A` and `w D` of a strut.
    fn scaled(
        &self,
        tape: &mut Tape,
        turn: &Turn,
        [from_base, a, b]: [&Vector; 3],
    ) -> Row<Formula> {
        let n = turn.scaled(tape, b);
        // |P - a|^2 + |b|^2, in squares of coordinates alone.
        let mut square = formula!(tape; b . b);
        for (&p, &a) in self.position.iter().zip(a) {
            let part = tape.expanded(p, a);
            square = tape.add(square, part);
        }
        let d = formula!(tape; ({ turn.weight } * square) + (2 * (n . from_base)));
        let along = self.vector(tape, &[*a, *b], false);
        let a = self.row(tape, &along, |tape, turn| turn.moment(tape, &n, from_base));
        Row { a, d }
    }
}
