//! What a formula is evaluated in.
//!
//! An operation gives `None` where it is undefined (a divisor that may be zero, a radicand that may
//! be negative or zero) or beyond the numbers at hand. What depends on it is then undefined too, and
//! no test holds of it.

/// Numbers, or sets of numbers, with the operations of formulas.
pub trait Arithmetic {
    /// A number, or an enclosure of one.
    type Number: Clone;
    /// The integer `n`.
    fn integer(&self, n: i64) -> Option<Self::Number>;
    /// `a + b`.
    fn add(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number>;
    /// `a - b`.
    fn sub(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        self.add(a, &self.neg(b)?)
    }
    /// `-a`.
    fn neg(&self, a: &Self::Number) -> Option<Self::Number>;
    /// `a b`.
    fn mul(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number>;
    /// `n a`.
    fn times(&self, n: i64, a: &Self::Number) -> Option<Self::Number> {
        self.mul(a, &self.integer(n)?)
    }
    /// `a / b`.
    fn div(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number>;
    /// `a^2`.
    fn sqr(&self, a: &Self::Number) -> Option<Self::Number>;
    /// `sqrt(a)`, for `a > 0` only: at zero a root has no slope.
    fn sqrt(&self, a: &Self::Number) -> Option<Self::Number>;
    /// The sum of these, from the first on; 0 of none.
    fn sum(&self, mut terms: impl Iterator<Item = Option<Self::Number>>) -> Option<Self::Number> {
        let first = terms.next().unwrap_or_else(|| self.integer(0))?;
        terms.try_fold(first, |sum, term| self.add(&sum, &term?))
    }
    /// `u . v`.
    fn dot(&self, u: &[Self::Number], v: &[Self::Number]) -> Option<Self::Number> {
        self.sum(u.iter().zip(v).map(|(u, v)| self.mul(u, v)))
    }
    /// `|v|^2`.
    fn square(&self, v: &[Self::Number]) -> Option<Self::Number> {
        self.sum(v.iter().map(|v| self.sqr(v)))
    }
    /// [`elbow`].
    fn elbow(&self, of: [&Self::Number; 3]) -> Option<[Self::Number; 2]> {
        elbow(self, of)
    }
}

/// The unit vector `u = (c, s)` with `|w - u|^2 = t`, `w = (a, b)`, that has `w` on its left: `b c - a s > 0`.
///
/// ```text
/// n = a^2 + b^2    q = n + 1 - t    h = sqrt(4 n - q^2)    c = (q a + h b)/(2 n)    s = (q b - h a)/(2 n)
/// ```
///
/// *Proof.* `4 n^2 |u|^2 = (q^2 + h^2) n = 4 n^2`; `2 u . w = q`, so that `|w - u|^2 = n - q + 1 = t`; and
/// `b c - a s = h/2`. ∎ It is defined where `4 n > q^2`: where two circles cross.
pub fn elbow<A: Arithmetic + ?Sized>(e: &A, [a, b, t]: [&A::Number; 3]) -> Option<[A::Number; 2]> {
    let n = e.add(&e.sqr(a)?, &e.sqr(b)?)?;
    let q = e.sub(&e.add(&n, &e.integer(1)?)?, t)?;
    let h = e.sqrt(&e.sub(&e.times(4, &n)?, &e.sqr(&q)?)?)?;
    let over = e.times(2, &n)?;
    let c = e.add(&e.mul(&q, a)?, &e.mul(&h, b)?)?;
    let s = e.sub(&e.mul(&q, b)?, &e.mul(&h, a)?)?;
    Some([e.div(&c, &over)?, e.div(&s, &over)?])
}

/// Intervals: what an operation gives contains the result for all numbers in its operands.
pub trait Enclosure: Arithmetic<Number: Default> {
    /// Whether sums are not rounded, and everything else outward.
    const EXACT_SUMS: bool;
    /// `1 / a`.
    fn recip(&self, a: &Self::Number) -> Option<Self::Number>;
    /// `a / 2`.
    fn halve(&self, a: &Self::Number) -> Option<Self::Number>;
    /// `n a / 2^places`.
    fn dyadic(&self, n: i64, places: u32, a: &Self::Number) -> Option<Self::Number>;
    /// `a b / c`, for `c > 0`.
    fn ratio(&self, a: &Self::Number, b: &Self::Number, c: &Self::Number) -> Option<Self::Number>;
    /// The part of `range` no further from `centre` than the greatest absolute values of `slopes`
    /// together; `None` if there is none.
    fn within(
        &self,
        range: &Self::Number,
        centre: &Self::Number,
        slopes: &[Self::Number],
    ) -> Option<Self::Number>;
    /// Every number from one of `a` to one of `b`.
    fn hull(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// The least and the greatest number in `a`.
    fn ends(&self, a: &Self::Number) -> [Self::Number; 2];
    /// Whether every number in `a` is greater than zero.
    fn is_positive(&self, a: &Self::Number) -> bool;
    /// Whether no number in `a` is less than zero.
    fn is_nonnegative(&self, a: &Self::Number) -> bool;
    /// An integer near `2^places a`. Which one, nothing rests on.
    fn rounded(&self, a: &Self::Number, places: u32) -> Option<i64>;
    /// The greatest absolute value in `a`.
    fn magnitude(&self, a: &Self::Number) -> Option<Self::Number> {
        let [_, greatest] = self.ends(&self.hull(a, &self.neg(a)?));
        Some(greatest)
    }
    /// A number that is not less than the root of any in `a`, which is a sum of squares.
    fn greatest_root(&self, a: &Self::Number) -> Option<Self::Number> {
        let [_, greatest] = self.ends(a);
        if !self.is_positive(&greatest) {
            return Some(greatest);
        }
        let [_, root] = self.ends(&self.sqrt(&greatest)?);
        Some(root)
    }
}
