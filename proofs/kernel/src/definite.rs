//! Positive definiteness of symmetric interval matrices.

use crate::arithmetic::Enclosure;

/// The upper triangle of a symmetric matrix: row `i` holds the entries `(i, i)`, `(i, i + 1)`, ...
pub type Triangle<N> = Vec<Vec<N>>;

/// Whether every symmetric matrix with entries in `matrix` is certainly positive definite.
///
/// **Lemma.** A symmetric matrix `[[a, b^T], [b, C]]` is positive definite if and only if `a > 0` and
/// its Schur complement `C - b b^T/a` is. *Proof.* `a t^2 + 2 t b.w + w^T C w
/// = a (t + b.w/a)^2 + w^T (C - b b^T/a) w`. ∎ The first row is eliminated so, in intervals, as
/// `c_jk - b_j b_k/a`, until none is left: what is enclosed before is enclosed after.
///
/// Where an entry is undefined, the answer is no.
pub fn is_positive_definite<E: Enclosure>(arithmetic: &E, matrix: Triangle<E::Number>) -> bool {
    if std::env::var("HERTZ").is_ok() {
        let n = matrix.len();
        return (0..1u32 << (n - 1)).all(|signs| {
            let sign = |i: usize| i > 0 && signs >> (i - 1) & 1 == 1;
            let point = matrix
                .iter()
                .enumerate()
                .map(|(i, row)| {
                    row.iter()
                        .zip(i..)
                        .map(|(x, j)| {
                            let [lo, hi] = arithmetic.ends(x);
                            if sign(i) == sign(j) {
                                lo
                            } else {
                                hi
                            }
                        })
                        .collect()
                })
                .collect();
            plain(arithmetic, point)
        });
    }
    plain(arithmetic, matrix)
}

fn plain<E: Enclosure>(arithmetic: &E, matrix: Triangle<E::Number>) -> bool {
    let mut rest = matrix;
    while !rest.is_empty() {
        match eliminated(arithmetic, rest) {
            Some(next) => rest = next,
            None => return false,
        }
    }
    true
}

/// The Schur complement of the first entry; `None` unless that is certainly positive.
pub(crate) fn eliminated<E: Enclosure>(
    arithmetic: &E,
    matrix: Triangle<E::Number>,
) -> Option<Triangle<E::Number>> {
    let mut rows = matrix.into_iter();
    let first = rows.next()?;
    let (a, b) = first.split_first()?;
    if !arithmetic.is_positive(a) {
        return None;
    }
    let row = |(j, row): (usize, Vec<E::Number>)| {
        let from = b.get(j)?;
        let entry =
            |(c, b): (&E::Number, &E::Number)| arithmetic.sub(c, &arithmetic.ratio(from, b, a)?);
        row.iter().zip(&b[j..]).map(entry).collect()
    };
    rows.enumerate().map(row).collect()
}
