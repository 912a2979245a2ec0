//! Intervals of doubles without rounding: what the search proposes with.

use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};

#[derive(Clone, Copy, Debug)]
pub struct Rough;
pub type Pair = (f64, f64);

impl Arithmetic for Rough {
    type Number = Pair;
    fn integer(&self, n: i64) -> Option<Pair> {
        Some((n as f64, n as f64))
    }
    fn add(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        Some((a.0 + b.0, a.1 + b.1))
    }
    fn sub(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        Some((a.0 - b.1, a.1 - b.0))
    }
    fn neg(&self, a: &Pair) -> Option<Pair> {
        Some((-a.1, -a.0))
    }
    fn mul(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        let p = [a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1];
        Some((p.into_iter().fold(f64::MAX, f64::min), p.into_iter().fold(f64::MIN, f64::max)))
    }
    fn div(&self, a: &Pair, b: &Pair) -> Option<Pair> {
        self.mul(a, &self.recip(b)?)
    }
    fn sqr(&self, a: &Pair) -> Option<Pair> {
        let (p, q) = (a.0 * a.0, a.1 * a.1);
        Some((if a.0 < 0.0 && a.1 > 0.0 { 0.0 } else { p.min(q) }, p.max(q)))
    }
    fn sqrt(&self, a: &Pair) -> Option<Pair> {
        (a.0 > 0.0).then(|| (a.0.sqrt(), a.1.sqrt()))
    }
}

impl Enclosure for Rough {
    const EXACT_SUMS: bool = false;

    fn recip(&self, a: &Pair) -> Option<Pair> {
        (a.0 > 0.0 || a.1 < 0.0).then(|| (1.0 / a.1, 1.0 / a.0))
    }
    fn halve(&self, a: &Pair) -> Option<Pair> {
        Some((a.0 / 2.0, a.1 / 2.0))
    }
    fn dyadic(&self, n: i64, places: u32, a: &Pair) -> Option<Pair> {
        let n = n as f64 * (-f64::from(places)).exp2();
        self.mul(&(n, n), a)
    }
    fn ratio(&self, a: &Pair, b: &Pair, c: &Pair) -> Option<Pair> {
        self.div(&self.mul(a, b)?, c)
    }
    fn within(&self, range: &Pair, centre: &Pair, slopes: &[Pair]) -> Option<Pair> {
        let reach: f64 = slopes.iter().map(|s| s.0.abs().max(s.1.abs())).sum();
        let cut = (range.0.max(centre.0 - reach), range.1.min(centre.1 + reach));
        (cut.0 <= cut.1 + 1e-12).then_some(cut)
    }
    fn hull(&self, a: &Pair, b: &Pair) -> Pair {
        (a.0.min(b.0), a.1.max(b.1))
    }
    fn ends(&self, a: &Pair) -> [Pair; 2] {
        [(a.0, a.0), (a.1, a.1)]
    }
    fn is_positive(&self, a: &Pair) -> bool {
        a.0 > 0.0
    }
    fn is_nonnegative(&self, a: &Pair) -> bool {
        a.0 >= 0.0
    }

    fn rounded(&self, a: &Pair, places: u32) -> Option<i64> {
        Some((0.5 * (a.0 + a.1) * f64::from(places).exp2()).round() as i64)
    }
}
