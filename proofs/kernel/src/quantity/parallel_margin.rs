//! How far a machine is from a parallel singularity: `|det U|`, rows of `U` the unit leg vectors.

use super::{determinant, Context, Quantity, Test};
use crate::input::ClaimError;

pub(super) const PARALLEL_MARGIN: Quantity = Quantity {
    key: "parallel_margin",
    symbol: "|det A|/(L_1 .. L_n)",
    words: "distance from parallel singularities",
    ..Quantity::of_machine(tests)
};

/// `|det A| >= b L_1 .. L_n`, for `b > 0` and as many legs as coordinates.
fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    let bound = context.positive(context.least()?)?;
    context.without_rotation()?;
    let mut least = context.number(bound, 0);
    let mut rows = Vec::new();
    for leg in context.legs {
        let Some(length) = leg.length.filter(|_| leg.row.a.len() == context.legs.len()) else {
            return context.refused("of legs with a length, as many as coordinates");
        };
        least = context.builder.tape.mul(least, length);
        rows.push(leg.row.a.clone());
    }
    let det = determinant(context.tape(), &rows);
    Ok(vec![Test::Beyond(det, least)])
}
