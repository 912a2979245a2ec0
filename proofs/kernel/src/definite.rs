//! Positive definiteness of symmetric interval matrices.

use crate::arithmetic::Enclosure;

/// The upper triangle of a symmetric matrix: row `i` holds the entries `(i, i)`, `(i, i + 1)`, ...
pub type Triangle<N> = Vec<Vec<N>>;

/// Whether every symmetric matrix with entries in `matrix` is certainly positive definite: if the
/// interval matrix is, or else if each of its sign vertices is, by elimination.
///
/// **Lemma (sign vertices).** For `z` in `{-1, 1}^m` let `T_z` have the lower end of entry `(i, j)`
/// where `z_i = z_j`, and the upper end elsewhere. If all `T_z` are positive definite, so is every
/// symmetric `X` in `matrix`. *Proof.* For `v != 0` let `z_i = -1` where `v_i < 0`, else 1. Then
/// `v_i X_ij v_j >= v_i (T_z)_ij v_j` for each `i`, `j`, so `v^T X v >= v^T T_z v > 0`. ∎ (Hertz.
/// `z` and `-z` give the same.)
pub fn is_positive_definite<E: Enclosure>(arithmetic: &E, matrix: Triangle<E::Number>) -> bool {
    let Some(signs) = matrix.len().checked_sub(1) else { return true };
    let vertex = |z: u32| {
        let negative = |i: usize| i > 0 && z >> (i - 1) & 1 == 1;
        let row = |(i, row): (usize, &Vec<E::Number>)| {
            let entry = |(x, j): (&E::Number, usize)| {
                let [lo, hi] = arithmetic.ends(x);
                if negative(i) == negative(j) {
                    lo
                } else {
                    hi
                }
            };
            row.iter().zip(i..).map(entry).collect()
        };
        matrix.iter().enumerate().map(row).collect::<Triangle<_>>()
    };
    eliminates(arithmetic, &mut matrix.clone())
        || (0..1u32 << signs).all(|z| eliminates(arithmetic, &mut vertex(z)))
}

/// The same of a `3 x 3` matrix.
pub(crate) fn is_positive_definite_three<E: Enclosure>(e: &E, t: &[E::Number; 6]) -> bool {
    eliminates(e, &mut rows_of_three(&mut t.clone()))
        || is_positive_definite(e, rows_of_three(&mut t.clone()).map(|row| row.to_vec()).to_vec())
}

/// The rows of a triangle of six entries.
pub(crate) fn rows_of_three<N>(t: &mut [N; 6]) -> [&mut [N]; 3] {
    let (first, rest) = t.split_at_mut(3);
    let (second, third) = rest.split_at_mut(2);
    [first, second, third]
}

/// Whether elimination shows every symmetric matrix with entries in `matrix` positive definite.
///
/// **Lemma.** A symmetric matrix `[[a, b^T], [b, C]]` is positive definite if and only if `a > 0` and
/// its Schur complement `C - b b^T/a` is. *Proof.* `a t^2 + 2 t b.w + w^T C w
/// = a (t + b.w/a)^2 + w^T (C - b b^T/a) w`. ∎ The first row is eliminated so, in intervals, as
/// `c_jk - b_j b_k/a`, until none is left: what is enclosed before is enclosed after. Where an entry
/// is undefined, the answer is no.
fn eliminates<E: Enclosure>(arithmetic: &E, mut rows: &mut [impl AsMut<[E::Number]>]) -> bool {
    while let Some((first, below)) = rows.split_first_mut() {
        if eliminate(arithmetic, first.as_mut(), below).is_none() {
            return false;
        }
        rows = below;
    }
    true
}

/// Makes `C` of `[[a, b^T], [b, C]]` its Schur complement, given `(a, b)`; `None` unless `a` is certainly
/// positive.
pub(crate) fn eliminate<E: Enclosure>(
    e: &E,
    row: &[E::Number],
    below: &mut [impl AsMut<[E::Number]>],
) -> Option<()> {
    let (a, mut b) = row.split_first()?;
    if !e.is_positive(a) {
        return None;
    }
    for entries in below {
        let from = b.first()?;
        for (c, b) in entries.as_mut().iter_mut().zip(b) {
            *c = e.sub(c, &e.ratio(from, b, a)?)?;
        }
        b = b.get(1..)?;
    }
    Some(())
}

/// Whether every `[[T, b], [b^T, c]]` is certainly positive definite, for each `b`: by one elimination of
/// `T`, in which the last column and corner of each go along, or else by itself.
pub(crate) fn are_positive_definite<E: Enclosure>(
    e: &E,
    t: &Triangle<E::Number>,
    mut columns: impl Iterator<Item = Vec<E::Number>>,
    corner: &E::Number,
) -> bool {
    let mut steps = t.clone();
    let mut rest = &mut steps[..];
    let mut eliminates = || {
        while let Some((first, below)) = std::mem::take(&mut rest).split_first_mut() {
            eliminate(e, first, below)?;
            rest = below;
        }
        Some(())
    };
    let is_eliminated = eliminates();
    let last = |mut b: Vec<E::Number>| {
        is_eliminated?;
        let mut corner = corner.clone();
        for (at, step) in steps.iter().enumerate() {
            let (a, row) = step.split_first()?;
            let own = b.get(at)?.clone();
            for (b, from) in b.iter_mut().skip(at + 1).zip(row) {
                *b = e.sub(b, &e.ratio(from, &own, a)?)?;
            }
            corner = e.sub(&corner, &e.ratio(&own, &own, a)?)?;
        }
        Some(e.is_positive(&corner))
    };
    let bordered = |b: Vec<E::Number>| {
        let mut t = t.clone();
        t.iter_mut().zip(b).for_each(|(row, b)| row.push(b));
        t.push(vec![corner.clone()]);
        t
    };
    columns.all(|b| last(b.clone()) == Some(true) || is_positive_definite(e, bordered(b)))
}
