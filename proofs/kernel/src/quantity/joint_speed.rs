//! The joint speed that a platform speed asks for: `|row_i of M| tool`.

use super::{Context, Quantity, Test};
use crate::formula::{formula, Term};
use crate::input::{ClaimError, Value};
use crate::machine::{motion::Turn, Leg};
use crate::test::Row;

pub(super) const JOINT_SPEED: Quantity = Quantity {
    key: "joint_speed",
    symbol: "|row_i of M| tool",
    words: "joint speed; of arms, degrees per time",
    given: &["tool"],
    ..Quantity::of_legs(tests)
};

/// `|A_i|^2/D_i <= k^2` is `k^2 D_i - |A_i|^2 >= 0`, for `k = max/tool`; of arms in radians.
///
/// Of a strut of a platform that turns it bounds how near to a right angle the leg is to the lever `r = R b` of its joint.
/// **Lemma.** With the leg's vector `A`, `|A|^2 = D`, the row is `[A, (r x A)/ell]`, or the second part alone about a
/// point, and with `q = 1` or `0` for the first part, `|r x A|^2 + (r . A)^2 = |b|^2 D` gives
///
/// ```text
/// |row|^2/D <= k^2    if and only if    (r . A)^2/D >= |b|^2 - (k^2 - q) ell^2
/// ```
///
/// which is `sigma_min^2 >= w c` of the one row of one entry `w r . A`, with `w D`, all of them polynomials. ∎ In
/// `T = 2 y f - y^2 D - c` squares of positions are subtracted: nothing is lost to them at control points.
fn tests(context: &mut Context<'_>, (_, leg): (usize, &Leg)) -> Result<Vec<Test>, ClaimError> {
    let max = context.positive(context.greatest()?)?;
    let tool = context.positive(context.given("tool")?)?;
    let ratio = max / tool;
    let k = if leg.is_angular() {
        let scale = -context.builder.scale;
        context.builder.input(context.place, Value::Radians(ratio), scale)
    } else {
        context.number(&ratio, 0)
    };
    let motion = context.motion;
    let lever = leg.scaled.as_ref().zip(leg.ends).zip(motion.turn.as_ref());
    let tape = context.tape();
    if let Some(((scaled, ends), turn)) = lever {
        let [_, b] = ends;
        let u = motion.vector(tape, &ends, true);
        let q = tape.integer(i64::from(!motion.velocity.is_empty()));
        let a = vec![formula!(tape; u . b)];
        let Turn { weight, length, .. } = *turn;
        let most = formula!(tape; ((k ^ 2) - q) * (length ^ 2));
        let least = formula!(tape; weight * ((b . b) - most));
        return Ok(vec![Test::Least(vec![Row { a, d: scaled.d }], least)]);
    }
    let greatest = formula!(tape; (k ^ 2) * { leg.row.d });
    let squares: Vec<_> = leg.row.a.iter().map(|&a| tape.sqr(a)).collect();
    let rest = squares.into_iter().fold(greatest, |rest, a| tape.sub(rest, a));
    Ok(vec![Test::AtLeast(rest)])
}
