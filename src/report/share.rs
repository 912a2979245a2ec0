//! Sums of shares.

/// The least double, or the next, that is at least `a + b`, of shares.
///
/// **Lemma.** With `s` the double nearest to `a + b`, `a >= b >= 0`, the double `b - (s - a)` is exactly
/// `a + b - s` (Dekker's Fast2Sum): where it is not positive `s` is at least the sum. Else the sum is
/// less than the double after `s`, which is nearer than it. ∎
pub fn sum_above(a: f64, b: f64) -> f64 {
    let (a, b) = (a.max(b), a.min(b));
    let sum = a + b;
    if b - (sum - a) > 0.0 {
        return sum.next_up();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::sum_above;

    #[test]
    fn sums_of_shares_are_not_below_them() {
        let (large, small) = (0.125, (-80f64).exp2());
        assert_eq!(large + small, large);
        assert!(sum_above(large, small) > large && sum_above(small, large) > large);
        assert_eq!(sum_above(0.125, 0.25), 0.375);
        assert_eq!(sum_above(0.0, small), small);
    }
}
