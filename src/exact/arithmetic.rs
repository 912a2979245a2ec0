//! Arithmetic with the exact numbers of claims: what is rational is written as one number.

use crate::search::solver::number;
use orthocert_kernel::number::{Expression, Operator};

/// Fractional bits in which two numbers are compared.
const BITS: u32 = 256;

/// `a + b`, `a - b`, `a b` or `a/b`; `None` where its text is too long for a claim.
pub fn apply(operator: Operator, a: &Expression, b: &Expression) -> Option<Expression> {
    let whole = Expression::Binary(operator, a.clone().into(), b.clone().into());
    match whole.rational() {
        Some(value) => number(&value),
        None => Some(whole),
    }
}

/// Whether `a <= b`, certainly.
pub fn at_most(a: &Expression, b: &Expression) -> bool {
    match (a.rational(), b.rational()) {
        (Some(a), Some(b)) => a <= b,
        _ => apply(Operator::Sub, b, a)
            .and_then(|x| x.enclose(BITS))
            .is_some_and(|x| x.lo >= 0.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Expression {
        Expression::try_from(text.to_owned()).unwrap()
    }

    #[test]
    fn rational_numbers_are_shortened_and_others_kept() {
        let of = |operator, a: &str, b: &str| apply(operator, &read(a), &read(b)).unwrap();
        assert_eq!(of(Operator::Sub, "1", "0.25"), read("0.75"));
        assert_eq!(of(Operator::Div, "1", "3"), read("1/3"));
        assert_eq!(of(Operator::Mul, "2", "sqrt(2)"), read("2*sqrt(2)"));
    }

    #[test]
    fn numbers_are_ordered() {
        for (a, b) in [("1/3", "0.34"), ("-1", "-1"), ("1.414", "sqrt(2)"), ("0", "sqrt(2)")] {
            assert!(at_most(&read(a), &read(b)), "{a} {b}");
        }
        for (a, b) in [("1/3", "0.33"), ("sqrt(2)", "1.414")] {
            assert!(!at_most(&read(a), &read(b)), "{a} {b}");
        }
    }
}
