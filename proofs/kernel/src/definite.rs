//! Positive definiteness of symmetric interval matrices.

use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::few::Few;
use crate::slope::MOST_COORDINATES;

/// Most rows: one a coordinate, and one that borders these.
pub const MOST_ROWS: usize = MOST_COORDINATES + 1;

/// A row of numbers.
pub type Vector<N> = Few<N, MOST_ROWS>;

/// The upper triangle of a symmetric matrix: row `i` holds the entries `(i, i)`, `(i, i + 1)`, ...
#[derive(Clone, Debug)]
pub struct Triangle<N> {
    n: usize,
    pub(crate) entries: Few<N, { MOST_ROWS * (MOST_ROWS + 1) / 2 }>,
}

impl<N: Clone + Default> Triangle<N> {
    /// The matrix of `n` rows with these entries `(i, j)`, `i <= j`.
    #[inline]
    pub fn new(n: usize, entry: impl Fn(usize, usize) -> Option<N>) -> Option<Self> {
        let pairs = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
        Some(Triangle { n, entries: pairs.map(|(i, j)| entry(i, j)).collect::<Option<_>>()? })
    }

    /// `c I`.
    #[inline]
    pub(crate) fn scalar<E: Enclosure<Number = N>>(e: &E, n: usize, c: &N) -> Option<Self> {
        let zero = e.integer(0)?;
        Triangle::new(n, |i, j| Some(if i == j { c.clone() } else { zero.clone() }))
    }

    fn start(&self, i: usize) -> usize {
        i * (2 * self.n + 1 - i) / 2
    }

    /// Row `i`, from its diagonal on.
    pub fn row(&self, i: usize) -> &[N] {
        &self.entries[self.start(i)..][..self.n - i]
    }

    /// Puts `of` the place and the value of each entry in its place.
    #[inline]
    pub(crate) fn change(&mut self, of: impl Fn(usize, usize, &N) -> Option<N>) -> Option<()> {
        let mut rest = &mut self.entries[..];
        for i in 0..self.n {
            let (row, below) = rest.split_at_mut(self.n - i);
            for (entry, j) in row.iter_mut().zip(i..) {
                *entry = of(i, j, entry)?;
            }
            rest = below;
        }
        Some(())
    }

    /// Adds the first of these, and each other one as the vertex has it, or subtracts it, and eliminates.
    pub(crate) fn eliminate_with<E: Enclosure<Number = N>>(
        mut self,
        e: &E,
        parts: &[Self],
        v: Vertex,
    ) -> Option<()> {
        for (k, part) in parts.iter().enumerate() {
            let is_added = k.checked_sub(1).is_none_or(|k| v.has(k));
            for (own, other) in self.entries.iter_mut().zip(part.entries.iter()) {
                *own = if is_added { e.add(own, other)? } else { e.sub(own, other)? };
            }
        }
        self.eliminate(e)
    }

    /// Eliminates each row from those below; `None` where one cannot be.
    ///
    /// **Lemma.** A symmetric matrix `[[a, b^T], [b, C]]` is positive definite if and only if `a > 0` and
    /// its Schur complement `C - b b^T/a` is. *Proof.* `a t^2 + 2 t b.w + w^T C w
    /// = a (t + b.w/a)^2 + w^T (C - b b^T/a) w`. ∎ The first row is eliminated so, in intervals, as
    /// `c_jk - (b_j/a) b_k`, until none is left: what is enclosed before is enclosed after. Where an entry
    /// is undefined, the answer is no.
    #[inline]
    fn eliminate<E: Enclosure<Number = N>>(&mut self, e: &E) -> Option<()> {
        let mut rest = &mut self.entries[..];
        for length in (1..=self.n).rev() {
            let (row, below) = rest.split_at_mut(length);
            eliminate(e, row, below)?;
            rest = below;
        }
        Some(())
    }
}

/// Makes the rows of `C` in `[[a, b^T], [b, C]]` those of its Schur complement, given `(a, b)`; `None` unless `a` is
/// certainly positive.
#[inline]
pub(crate) fn eliminate<E: Enclosure>(
    e: &E,
    row: &[E::Number],
    mut below: &mut [E::Number],
) -> Option<()> {
    let (a, mut b) = row.split_first()?;
    if !e.is_positive(a) {
        return None;
    }
    while let Some((from, next)) = b.split_first() {
        let (entries, rest) = below.split_at_mut_checked(b.len())?;
        let part = over(e, from, a)?;
        for (c, b) in entries.iter_mut().zip(b) {
            *c = e.sub(c, &e.mul(&part, b)?)?;
        }
        (b, below) = (next, rest);
    }
    Some(())
}

/// `x/a`.
#[inline]
fn over<E: Enclosure>(e: &E, x: &E::Number, a: &E::Number) -> Option<E::Number> {
    e.ratio(x, &e.integer(1)?, a)
}

/// Whether every symmetric matrix with entries in `matrix` is certainly positive definite: if the
/// interval matrix is, or else if each of its sign vertices is, by elimination.
///
/// **Lemma (sign vertices).** For `z` in `{-1, 1}^m` let `T_z` have the lower end of entry `(i, j)`
/// where `z_i = z_j`, and the upper end elsewhere. If all `T_z` are positive definite, so is every
/// symmetric `X` in `matrix`. *Proof.* For `v != 0` let `z_i = -1` where `v_i < 0`, else 1. Then
/// `v_i X_ij v_j >= v_i (T_z)_ij v_j` for each `i`, `j`, so `v^T X v >= v^T T_z v > 0`. ∎ (Hertz.
/// `z` and `-z` give the same.)
pub fn is_positive_definite<E: Enclosure>(e: &E, matrix: &Triangle<E::Number>) -> bool {
    let Some(signs) = matrix.n.checked_sub(1) else { return true };
    let vertex = |z: u32| {
        let negative = |i: usize| i > 0 && z >> (i - 1) & 1 == 1;
        let mut vertex = matrix.clone();
        vertex.change(|i, j, x| {
            let [lo, hi] = e.ends(x);
            Some(if negative(i) == negative(j) { lo } else { hi })
        })?;
        vertex.eliminate(e)
    };
    matrix.clone().eliminate(e).is_some() || (0..1u32 << signs).all(|z| vertex(z).is_some())
}

/// Whether every `[[T, b], [b^T, c]]` is certainly positive definite, for each `b`: by one elimination of
/// `T`, in which the last column and corner of each go along, or else by itself.
pub(crate) fn are_positive_definite<E: Enclosure>(
    e: &E,
    t: &Triangle<E::Number>,
    mut columns: impl Iterator<Item = Vector<E::Number>>,
    corner: &E::Number,
) -> bool {
    let (n, mut steps) = (t.n, t.clone());
    let mut eliminated = || {
        steps.eliminate(e)?;
        let row = |at: usize| steps.row(at).split_first();
        let parts = |(a, b): (&E::Number, &[E::Number])| {
            let parts = b.iter().map(|b| over(e, b, a)).collect::<Option<Vector<_>>>()?;
            Some((a.clone(), parts))
        };
        (0..n).map(|at| parts(row(at)?)).collect::<Option<Vec<_>>>()
    };
    let steps = eliminated();
    let last = |mut b: Vector<E::Number>| {
        let mut corner = corner.clone();
        for (at, (a, parts)) in steps.as_ref()?.iter().enumerate() {
            let own = b.get(at)?.clone();
            for (b, part) in b.iter_mut().skip(at + 1).zip(parts.iter()) {
                *b = e.sub(b, &e.mul(part, &own)?)?;
            }
            corner = e.sub(&corner, &e.mul(&over(e, &own, a)?, &own)?)?;
        }
        Some(e.is_positive(&corner))
    };
    let bordered = |b: &[E::Number]| {
        Triangle::new(n + 1, |i, j| match j < n {
            true => t.row(i).get(j - i).cloned(),
            false => b.get(i).or((i == n).then_some(corner)).cloned(),
        })
    };
    columns.all(|b| {
        last(b.clone()) == Some(true) || bordered(&b).is_some_and(|t| is_positive_definite(e, &t))
    })
}
