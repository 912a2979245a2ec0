//! Choices read from a fuzzer's bytes.

/// What is left of the bytes.
pub struct Reader<'a>(pub &'a [u8]);

impl Reader<'_> {
    /// The next byte; zero at the end.
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// One of `0..n`, `n > 0`.
    pub fn below(&mut self, n: usize) -> usize {
        let bytes = [self.byte(), if n > 256 { self.byte() } else { 0 }];
        usize::from(u16::from_le_bytes(bytes)) % n
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
