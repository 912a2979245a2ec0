//! The joint speed that a platform speed asks for: `|row_i of M| tool`.

use super::{Context, Quantity, Test};
use crate::input::{ClaimError, Value};
use crate::machine::Leg;

pub(super) const JOINT_SPEED: Quantity = Quantity {
    key: "joint_speed",
    symbol: "|row_i of M| tool",
    words: "joint speed; of arms, degrees per time",
    given: &["tool"],
    ..Quantity::of_legs(tests)
};

/// `|A_i|^2/D_i <= k^2` is `k^2 D_i - |A_i|^2 >= 0`, for `k = max/tool`; of arms in radians. Of scaled rows
/// it is `sigma_max^2 <= w k^2` of that row alone, which, unlike the square, has a form for control points.
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
    let scaled = leg.scaled.clone().zip(context.weight);
    let tape = context.tape();
    let square = tape.sqr(k);
    if let Some((row, weight)) = scaled {
        let square = tape.mul(square, weight);
        return Ok(vec![Test::Greatest(vec![row], square)]);
    }
    let greatest = tape.mul(square, leg.row.d);
    let squares: Vec<_> = leg.row.a.iter().map(|&a| tape.sqr(a)).collect();
    let rest = squares.into_iter().fold(greatest, |rest, a| tape.sub(rest, a));
    Ok(vec![Test::AtLeast(rest)])
}
