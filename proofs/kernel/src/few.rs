//! A few numbers, on the stack: what is done at each vertex asks for no memory.

use std::ops::{Deref, DerefMut};

/// At most so many numbers.
#[derive(Clone, Debug)]
pub struct Few<N, const MOST: usize> {
    all: [N; MOST],
    len: usize,
}

impl<N, const MOST: usize> Few<N, MOST> {
    /// As many times the same.
    #[inline]
    pub fn filled(len: usize, number: impl Fn() -> N) -> Self {
        Few { all: std::array::from_fn(|_| number()), len }
    }

    /// One more.
    #[inline]
    pub fn push(&mut self, number: N) {
        self.all[self.len] = number;
        self.len += 1;
    }
}

impl<N: Default, const MOST: usize> FromIterator<N> for Few<N, MOST> {
    #[inline]
    fn from_iter<I: IntoIterator<Item = N>>(numbers: I) -> Self {
        let mut few = Few::filled(0, N::default);
        numbers.into_iter().for_each(|number| few.push(number));
        few
    }
}

impl<N, const MOST: usize> Deref for Few<N, MOST> {
    type Target = [N];

    #[inline]
    fn deref(&self) -> &[N] {
        &self.all[..self.len]
    }
}

impl<N, const MOST: usize> DerefMut for Few<N, MOST> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [N] {
        &mut self.all[..self.len]
    }
}
