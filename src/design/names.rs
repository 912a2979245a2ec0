//! Names of parameters in numbers, and values for them.

use super::exactly::written;
use crate::exact::arithmetic;
use crate::exact::{Exact, NumberErrorKind};
use num_rational::BigRational;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::vary::Numbers as _;
use std::sync::Arc;

/// Why an expression has no value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum NoValue {
    /// A name that is no parameter's.
    #[error("{0} is not the name of a parameter")]
    Unknown(String),
    /// Something that is not defined.
    #[error("{}", number(.0))]
    Number(NumberErrorKind),
}

impl From<NumberErrorKind> for NoValue {
    fn from(error: NumberErrorKind) -> Self {
        NoValue::Number(error)
    }
}

fn number(error: &NumberErrorKind) -> &'static str {
    match error {
        NumberErrorKind::DivisorMayBeZero => "a divisor is or may be zero",
        NumberErrorKind::RadicandMayBeNegative => "a radicand is or may be negative",
        _ => "a number is too large",
    }
}

/// The value of an expression at values of the names.
pub(super) fn value(x: &Exact, known: &[(String, Exact)]) -> Result<Exact, NoValue> {
    let of = |x: &Exact| value(x, known);
    Ok(match x {
        Exact::Rational(_) => x.clone(),
        Exact::Name(name) => {
            let known = known.iter().find(|(known, _)| **known == **name);
            known.map(|(_, x)| x.clone()).ok_or_else(|| NoValue::Unknown(name.to_string()))?
        }
        Exact::Neg(x) => of(x)?.negated(),
        Exact::Add(x, y) => of(x)?.plus(of(y)?)?,
        Exact::Sub(x, y) => of(x)?.minus(of(y)?)?,
        Exact::Mul(x, y) => of(x)?.times(of(y)?)?,
        Exact::Div(x, y) => of(x)?.over(of(y)?)?,
        Exact::Sqrt(x) => of(x)?.root()?,
    })
}

/// Puts values in the place of names in all numbers of a claim; rational parts become one number.
pub(super) fn put(claim: &mut MachineClaim, known: &[(String, Exact)]) {
    let known: Vec<(&str, Expression)> =
        known.iter().filter_map(|(name, x)| Some((name.as_str(), written(x)?))).collect();
    for number in claim.numbers_mut() {
        if put_in(number, &known) {
            fold(number);
        }
    }
}

/// Whether there was a name.
pub(super) fn put_in(x: &mut Expression, known: &[(&str, Expression)]) -> bool {
    match x {
        Expression::Literal { .. } | Expression::Varying(_) => false,
        Expression::Name(name) => match known.iter().find(|(known, _)| known == name) {
            Some((_, value)) => {
                *x = value.clone();
                true
            }
            None => false,
        },
        Expression::Neg(inner) | Expression::Power(inner, _) | Expression::Sqrt(inner) => {
            put_in(Arc::make_mut(inner), known)
        }
        Expression::Binary(_, left, right) => {
            put_in(Arc::make_mut(left), known) | put_in(Arc::make_mut(right), known)
        }
    }
}

fn fold(x: &mut Expression) {
    if let Some(value) = x.rational().filter(is_short) {
        *x = arithmetic::number(&value);
        return;
    }
    match x {
        Expression::Literal { .. } | Expression::Varying(_) | Expression::Name(_) => {}
        Expression::Neg(inner) | Expression::Power(inner, _) | Expression::Sqrt(inner) => {
            fold(Arc::make_mut(inner));
        }
        Expression::Binary(_, left, right) => {
            fold(Arc::make_mut(left));
            fold(Arc::make_mut(right));
        }
    }
}

fn is_short(x: &BigRational) -> bool {
    x.numer().bits().max(x.denom().bits()) < 2048
}
