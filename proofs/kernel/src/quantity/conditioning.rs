//! The condition number `sigma_max(M)/sigma_min(M)`.

use super::{Context, Quantity, Test};
use crate::input::{ordered, ClaimError};
use crate::number::Expression;

pub(super) const CONDITIONING: Quantity = Quantity {
    key: "conditioning",
    symbol: "sigma_max/sigma_min",
    words: "condition number",
    ..Quantity::of_machine(tests)
};

fn tests(context: &mut Context<'_>) -> Result<Vec<Test>, ClaimError> {
    let bound = context.greatest()?;
    ordered(context.place, &Expression::integer(1), bound, true)?;
    let c = context.number(bound, 0);
    Ok(vec![Test::Conditioning(context.tape().sqr(c))])
}
