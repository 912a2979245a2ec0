//! Deterministic random numbers, so that a failure is the same on every machine.

use num_rational::BigRational;

/// SplitMix64 (Steele, Lea, Flood 2014): one 64-bit word of state, no dependency.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer of `[least, greatest]`.
    pub fn within(&mut self, least: i64, greatest: i64) -> i64 {
        let count = least.abs_diff(greatest) + 1;
        least + i64::try_from(self.word() % count).unwrap()
    }

    /// `true` once in `n` times.
    pub fn once_in(&mut self, n: i64) -> bool {
        self.within(1, n) == 1
    }

    pub fn pick<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[usize::try_from(self.word() % choices.len() as u64).unwrap()].clone()
    }

    /// A rational number of `[least, greatest] / denominator`.
    pub fn rational(&mut self, least: i64, greatest: i64, denominator: i64) -> BigRational {
        BigRational::new(self.within(least, greatest).into(), denominator.into())
    }
}
