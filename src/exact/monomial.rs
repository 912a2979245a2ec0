//! Numbers `c sqrt(r)`, `c` and `r` rational, which products, quotients and their squares' roots stay.

use super::{Exact, Operand};
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// Factors of a radicand that are taken out of its root where their squares divide it.
const FACTORS: u32 = 1000;

/// `c sqrt(r)`, `r > 0`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Monomial {
    c: BigRational,
    r: BigRational,
}

impl Monomial {
    /// The monomial that a number is as it is written.
    pub fn of(x: &Exact) -> Option<Self> {
        let of = |x: &Operand| Monomial::of(x);
        match x {
            Exact::Rational(c) => Some(Monomial { c: c.clone(), r: BigRational::one() }),
            Exact::Neg(x) => of(x).map(|Monomial { c, r }| Monomial { c: -c, r }),
            Exact::Mul(x, y) => Some(of(x)?.times(&of(y)?)),
            Exact::Div(x, y) => Some(of(x)?.times(&of(y)?.inverse()?)),
            Exact::Sqrt(x) => match &**x {
                Exact::Rational(r) => Monomial::root(r.clone()),
                _ => None,
            },
            Exact::Add(..) | Exact::Sub(..) | Exact::Name(_) => None,
        }
    }

    /// `sqrt(r)`, of a number greater than 0.
    pub fn root(r: BigRational) -> Option<Self> {
        r.is_positive().then(|| Monomial { c: BigRational::one(), r })
    }

    /// The product.
    pub fn times(&self, other: &Self) -> Self {
        Monomial { c: &self.c * &other.c, r: &self.r * &other.r }
    }

    /// `1/(c sqrt(r)) = (1/(c r)) sqrt(r)`.
    pub fn inverse(&self) -> Option<Self> {
        let c = &self.c * &self.r;
        (!c.is_zero()).then(|| Monomial { c: c.recip(), r: self.r.clone() })
    }

    /// `c^2 r`.
    pub fn square(&self) -> BigRational {
        &self.c * &self.c * &self.r
    }

    /// The number, written `c sqrt(n)` with a whole `n` without small square factors.
    pub fn exact(&self) -> Option<Exact> {
        // sqrt(p/q) = sqrt(p q)/q.
        let mut n = self.r.numer() * self.r.denom();
        let mut c = &self.c / BigRational::from_integer(self.r.denom().clone());
        for factor in (2..=FACTORS).map(BigInt::from) {
            let square = &factor * &factor;
            if square > n {
                break;
            }
            while n.is_multiple_of(&square) {
                n /= &square;
                c *= BigRational::from_integer(factor.clone());
            }
        }
        let root = Exact::Rational(BigRational::from_integer(n)).root().ok()?;
        let whole = |x: &BigInt| Exact::Rational(BigRational::from_integer(x.clone()));
        let (p, q) = (c.numer(), c.denom());
        let product = match &root {
            _ if p.is_zero() => return Some(whole(p)),
            Exact::Rational(_) => return Exact::Rational(c).times(root).ok(),
            _ if p.is_one() => root,
            _ if (-p).is_one() => Exact::Neg(Operand::new(root)),
            _ => whole(p).times(root).ok()?,
        };
        if q.is_one() {
            Some(product)
        } else {
            product.over(whole(q)).ok()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_quotients_of_roots_are_one_root() {
        for (text, one) in [
            ("174.75*sqrt(3)/2", "699*sqrt(3)/8"),
            ("sqrt(3)*sqrt(3)", "3"),
            ("-40/sqrt(2)", "-20*sqrt(2)"),
            ("20/sqrt(12)", "10*sqrt(3)/3"),
            ("sqrt(2)/sqrt(8)", "1/2"),
            ("0*sqrt(2)", "0"),
            ("-sqrt(3)/2", "-sqrt(3)/2"),
            ("sqrt(3/4)", "sqrt(3)/2"),
        ] {
            let x = Exact::parse(text, 100).unwrap();
            let found = Monomial::of(&x).and_then(|x| x.exact()).unwrap();
            assert_eq!(found.to_string(), one, "{text}");
            let [low, high] = found.minus(x).unwrap().ends(128).unwrap();
            assert!(!low.is_positive() && !high.is_negative(), "{text}");
        }
        assert!(Monomial::of(&Exact::parse("1 + sqrt(2)", 100).unwrap()).is_none());
    }
}
