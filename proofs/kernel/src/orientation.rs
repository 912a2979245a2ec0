//! Orientations of a platform: rotations as polynomials of half-angle tangents, and the sets that
//! claims name.
//!
//! ```text
//! Rodrigues: c = tan(theta/2) axis     N = (1 - |c|^2) I + 2 c c^T + 2 [c]x         w = 1 + |c|^2
//! one axis:  t = tan(phi/2)            cos phi = (1 - t^2)/(1 + t^2)    sin phi = 2 t/(1 + t^2)
//! R_z(yaw) R_y(pitch) R_x(roll):       N = N_z N_y N_x                              w = w_x w_y w_z
//! ```
//!
//! `R = N/w`. Of degree two at most in each coordinate, and `w >= 1`.

use crate::claim::{MachineClaim, Mechanism, Orientation};
use crate::compile::Builder;
use crate::formula::{formula, Formula, Tape, Term, Vector};
use crate::input::{malformed, ordered, positive, ClaimError, Input, Value};
use crate::machine::motion::{Motion, Turn};
use crate::number::Expression;

const PLACE: &str = "orientation";

/// A set of rotations, in coordinates.
pub(crate) struct Chart {
    /// `N`, row by row.
    pub matrix: [Vector; 3],
    /// `w`.
    pub weight: Formula,
    /// Of each coordinate the least and the greatest value: the box contains the set.
    pub ends: Vec<[Input; 2]>,
    /// `g`: the set is where it is not negative in the box; none if that is all of it.
    pub g: Option<Formula>,
}

impl Builder {
    /// How a mechanism's platform moves; where it turns, with its orientations.
    pub fn motion(&mut self, claim: &MachineClaim) -> Result<(Motion, Option<Chart>), ClaimError> {
        type Components = &'static [usize];
        let (velocity, spin, turning): (Components, Components, _) = match &claim.mechanism {
            Mechanism::Planar(turning) => (&[0, 1], &[2], Some(turning)),
            Mechanism::Spatial(turning) => (&[0, 1, 2], &[0, 1, 2], Some(turning)),
            Mechanism::Spherical(turning) => (&[], &[0, 1, 2], Some(turning)),
            Mechanism::Translational(_) | Mechanism::Orthoglide { .. } => (&[0, 1, 2], &[], None),
            Mechanism::Formulas(_) => (&[], &[], None),
        };
        let tape = &mut self.tape;
        let position = std::array::from_fn(|k| match velocity.contains(&k) {
            true => tape.coordinate(k),
            false => tape.integer(0),
        });
        let point = turning.is_none() || velocity.len() == 2;
        let length = turning.and_then(|turning| turning.characteristic_length.as_ref());
        let (turn, chart) = match (&claim.orientation, length) {
            (None, None) if point => (None, None),
            (Some(orientation), Some(length)) => {
                let place = "mechanism.characteristic_length";
                positive(place, length)?;
                let length = self.number(place, length, self.scale);
                let chart = chart(self, orientation, velocity.len(), spin.len() == 1)?;
                let turn = Turn { matrix: chart.matrix, weight: chart.weight, length, spin };
                (Some(turn), Some(chart))
            }
            _ => {
                let expected =
                    "with a characteristic_length, where the platform turns, and only there";
                return Err(malformed("orientation", expected));
            }
        };
        Ok((Motion { position, velocity, turn, moved: None }, chart))
    }
}

/// The chart of a set, in coordinates from `first` on; in the plane, or in space.
fn chart(
    builder: &mut Builder,
    orientation: &Orientation,
    first: usize,
    in_plane: bool,
) -> Result<Chart, ClaimError> {
    if matches!(orientation, Orientation::Range(_)) != in_plane {
        return Err(malformed(PLACE, "a range in the plane, and only there"));
    }
    let few = if in_plane { 1 } else { 3 };
    let c: Vec<Formula> = (first..first + few).map(|k| builder.tape.coordinate(k)).collect();
    let c: Vector = std::array::from_fn(|k| c[k % few]);
    match orientation {
        Orientation::Angle(angle) => {
            less_than_half_a_turn(angle)?;
            let t = builder.input(PLACE, Value::HalfTangent(angle.clone()), 0);
            let tape = &mut builder.tape;
            let g = formula!(tape; (t ^ 2) - (c . c));
            let ends = symmetric(angle, Value::HalfTangent);
            Ok(rodrigues(tape, &c, [ends.clone(), ends.clone(), ends], g))
        }
        // With the quaternion q, c = (q_1, q_2, q_3)/q_0: the tilt has q_1^2 + q_2^2 = sin^2(tilt/2) and
        // q_0^2 + q_3^2 = cos^2(tilt/2), the torsion q_3/q_0 = tan(torsion/2). So a tilt of at most
        // that with the tangent t is c_1^2 + c_2^2 <= t^2 (1 + c_3^2), and then, with |c_3| <= s,
        // |c_1| and |c_2| are at most t sqrt(1 + s^2): t alone would cut off orientations of the set.
        Orientation::Tilt { tilt, torsion } => {
            less_than_half_a_turn(tilt)?;
            less_than_half_a_turn(torsion)?;
            let t = builder.input(PLACE, Value::HalfTangent(tilt.clone()), 0);
            let tape = &mut builder.tape;
            let [x, y, z] = c.map(|c| tape.sqr(c));
            let g = formula!(tape; (((t ^ 2) * (1 + z)) - x) - y);
            let reach = symmetric(tilt, |tilt| Value::TiltReach(tilt, torsion.clone()));
            let ends = [reach.clone(), reach, symmetric(torsion, Value::HalfTangent)];
            Ok(rodrigues(tape, &c, ends, g))
        }
        Orientation::RollPitchYaw { roll, pitch, yaw } => {
            let ends = [roll, pitch, yaw].map(range).into_iter().collect::<Result<_, _>>()?;
            let tape = &mut builder.tape;
            let [(x, w_x), (y, w_y), (z, w_z)] =
                std::array::from_fn(|axis| about(tape, axis, c[axis]));
            let (matrix, weight) = (product(tape, &y, &x), tape.mul(w_y, w_x));
            let (matrix, weight) = (product(tape, &z, &matrix), tape.mul(w_z, weight));
            Ok(Chart { matrix, weight, ends, g: None })
        }
        Orientation::Range(ends) => {
            let ends = vec![range(ends)?];
            let (matrix, weight) = about(&mut builder.tape, 2, c[0]);
            Ok(Chart { matrix, weight, ends, g: None })
        }
    }
}

/// Whether it is certain that no two rotations of a set differ by half a turn, and that each has its
/// coordinates once.
///
/// **Lemma.** No two do if one of these holds: an angle is less than 90 degrees; tilt and torsion
/// together are; a range spans less than 180; pitch is between -90 and 90, and the spans of roll and yaw
/// together are less than 180. *Proof.* Let `d` be the angle of `R' R^T`, at most half a turn:
/// `d(R S, R' S') <= d(R, R') + d(S, S')`. It is at most twice the angle; the span; and, as a rotation
/// of the set of tilts is one by at most that about an axis in the plane, after one by the torsion about
/// z, twice their sum. Of the last set `R` has the unit quaternion `q_z q_y q_x`. With half the
/// differences of roll, pitch and yaw, `x`, `y`, `z`, and the mean `s` of both pitches,
///
/// ```text
/// +-cos(d/2) = q . q' = cos x cos y cos z + sin x sin s sin z
/// ```
///
/// `|s| + |y| < 90` is the greater pitch, so `|sin s| < cos y`; `|x| + |z| < 90`, so
/// `|sin x sin z| < cos x cos z`: the sum is positive. ∎ Half-angle tangents are those of one rotation each, and so
/// are roll, pitch and yaw there: `cos pitch > 0`.
pub(crate) fn is_less_than_half_a_turn(orientation: &Orientation) -> bool {
    let span = |[min, max]: &[Expression; 2]| max - min;
    let below = |angle: &Expression, degrees: i64| {
        ordered(PLACE, angle, &Expression::integer(degrees), true).is_ok()
    };
    match orientation {
        Orientation::Angle(angle) => below(angle, 90),
        Orientation::Tilt { tilt, torsion } => below(&(tilt + torsion), 90),
        Orientation::RollPitchYaw { roll, pitch: [min, max], yaw } => {
            below(&Expression::Neg(min.clone().into()), 90)
                && below(max, 90)
                && below(&(&span(roll) + &span(yaw)), 180)
        }
        Orientation::Range(ends) => below(&span(ends), 180),
    }
}

fn rodrigues(tape: &mut Tape, c: &Vector, ends: [[Input; 2]; 3], g: Formula) -> Chart {
    let squares = c.map(|c| tape.sqr(c));
    let [x, y, z] = squares;
    let sum = formula!(tape; (x + y) + z);
    let weight = formula!(tape; 1 + sum);
    let entry = |tape: &mut Tape, i: usize, j: usize| {
        if i == j {
            return formula!(tape; (1 - sum) + (2 * { squares[i] }));
        }
        // [c]x has -c_3, c_2, -c_1 above the diagonal.
        let (product, other) = (tape.mul(c[i.min(j)], c[i.max(j)]), c[3 - i - j]);
        match (j + 1) % 3 == i {
            true => formula!(tape; 2 * (product + other)),
            false => formula!(tape; 2 * (product - other)),
        }
    };
    let matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(tape, i, j)));
    Chart { matrix, weight, ends: ends.to_vec(), g: Some(g) }
}

/// `w` times the rotation about a coordinate axis, and `w`.
fn about(tape: &mut Tape, axis: usize, t: Formula) -> ([Vector; 3], Formula) {
    let (zero, weight) = (tape.integer(0), formula!(tape; 1 + (t ^ 2)));
    let (cos, sin) = (formula!(tape; 1 - (t ^ 2)), formula!(tape; 2 * t));
    let minus = tape.neg(sin);
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[zero; 3]; 3];
    matrix[axis][axis] = weight;
    (matrix[j][j], matrix[j][k]) = (cos, minus);
    (matrix[k][j], matrix[k][k]) = (sin, cos);
    (matrix, weight)
}

fn product(tape: &mut Tape, a: &[Vector; 3], b: &[Vector; 3]) -> [Vector; 3] {
    a.map(|row| std::array::from_fn(|k| tape.dot(&row, &[b[0][k], b[1][k], b[2][k]])))
}

fn less_than_half_a_turn(angle: &Expression) -> Result<(), ClaimError> {
    ordered(PLACE, &Expression::integer(0), angle, false)
        .and_then(|()| ordered(PLACE, angle, &Expression::integer(180), true))
        .map_err(|_| malformed(PLACE, "an angle from 0 to less than 180 degrees"))
}

fn end(value: Value) -> Input {
    Input { place: PLACE.to_owned(), value, scale: 0 }
}

/// What is made of `-angle`, and of `angle`: odd functions of it.
fn symmetric(angle: &Expression, of: impl Fn(Expression) -> Value) -> [Input; 2] {
    [Expression::Neg(angle.clone().into()), angle.clone()].map(|angle| end(of(angle)))
}

/// The half tangents of a range of angles, between which the tangent increases.
fn range([min, max]: &[Expression; 2]) -> Result<[Input; 2], ClaimError> {
    let half_turn = Expression::integer(180);
    ordered(PLACE, min, max, false)?;
    ordered(PLACE, &Expression::Neg(half_turn.clone().into()), min, true)
        .and_then(|()| ordered(PLACE, max, &half_turn, true))
        .map_err(|_| malformed(PLACE, "between -180 and 180 degrees"))?;
    Ok([min, max].map(|angle| end(Value::HalfTangent(angle.clone()))))
}
