//! Arithmetic with the exact numbers of claims: what is rational is written as one number.

use num_bigint::BigInt;
use num_integer::Integer as _;
use num_rational::BigRational;
use num_traits::{One as _, Signed as _, Zero as _};
use orthocert_kernel::number::{Expression, Operator};

/// Most decimals of a literal; a number of more is written as a fraction.
const MOST_PLACES: u32 = 40;
/// Bits of a denominator by which the kernel divides: it takes the reciprocal, of which it knows few bits if it is small.
/// Of greater ones the decimals are left in the numerator, of so many places at most.
const MOST_BITS: u64 = 64;
const MOST_DECIMALS: u32 = 2100;

/// Fractional bits in which two numbers are compared.
const BITS: u32 = 256;

/// A rational as claims write it: a decimal of few places, or a fraction.
pub fn number(x: &BigRational) -> Expression {
    let literal = |digits: BigInt, places: u32| {
        let positive = Expression::Literal { digits: digits.abs(), places };
        if digits.is_negative() {
            Expression::Neg(positive.into())
        } else {
            positive
        }
    };
    let (mut places, mut rest) = decimal_places(x.denom());
    let most = if x.denom().bits() > MOST_BITS { MOST_DECIMALS } else { MOST_PLACES };
    if places > most || most == MOST_PLACES && !rest.is_one() {
        (places, rest) = (0, x.denom().clone());
    }
    // In lowest terms, with the fewest decimals: no last zero.
    let power = BigInt::from(10).pow(places);
    let decimal = literal(x.numer() * (power / (x.denom() / &rest)), places);
    match rest.is_one() {
        true => decimal,
        false => Expression::Binary(Operator::Div, decimal.into(), literal(rest, 0).into()),
    }
}

/// For a denominator `2^a 5^b r`, `r` with neither factor, the least `p` such that `2^a 5^b` divides `10^p`, and `r`.
pub(super) fn decimal_places(denominator: &BigInt) -> (u32, BigInt) {
    let mut rest = denominator.clone();
    let mut count = |prime: u32| {
        let (prime, mut times) = (BigInt::from(prime), 0);
        loop {
            let (quotient, remainder) = rest.div_rem(&prime);
            if !remainder.is_zero() {
                return times;
            }
            (rest, times) = (quotient, times + 1);
        }
    };
    (count(2).max(count(5)), rest)
}

/// `a + b`, `a - b`, `a b` or `a/b`.
pub fn apply(operator: Operator, a: &Expression, b: &Expression) -> Expression {
    let whole = Expression::Binary(operator, a.clone().into(), b.clone().into());
    whole.rational().map_or(whole, |value| number(&value))
}

/// Whether `a <= b`, certainly.
pub fn at_most(a: &Expression, b: &Expression) -> bool {
    match (a.rational(), b.rational()) {
        (Some(a), Some(b)) => a <= b,
        _ => apply(Operator::Sub, b, a).enclose(BITS).is_some_and(|x| x.lo >= 0.into()),
    }
}

/// Whether `min <= x <= max`, certainly.
pub fn is_between(x: &BigRational, [min, max]: [&Expression; 2]) -> bool {
    let x = number(x);
    at_most(min, &x) && at_most(&x, max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Expression {
        Expression::try_from(text.to_owned()).unwrap()
    }

    #[test]
    fn rational_numbers_are_shortened_and_others_kept() {
        let of = |operator, a: &str, b: &str| apply(operator, &read(a), &read(b));
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
