//! Positive definiteness of interval matrices.

use crate::enclosure::{Bound, Enclosure};
use crate::linear::Symmetric;

/// Whether every symmetric matrix within the interval matrix `T` is positive definite.
///
/// **Lemma** (Hertz 1992, Rohn 1994). Let `Tc` be the centre and `Tr >= 0` the radius of `T`. Every
/// symmetric matrix in `T` is positive definite if and only if `Tc - D_z Tr D_z` is, for every
/// `z` in `{-1, 1}^3`, where `D_z = diag(z)`.
///
/// *Proof of "if", the direction that is used.* For `X` in `T` and `x != 0` let `z_i = -1` where
/// `x_i < 0` and `1` elsewhere, so that `D_z |x| = x`. Then
/// `x^T X x >= x^T Tc x - |x|^T Tr |x| = x^T (Tc - D_z Tr D_z) x > 0`. ∎
///
/// `z` and `-z` give the same matrix, which leaves four. Entry `(i, j)` of each is the lower
/// endpoint of `T_ij` where `z_i z_j = 1` and the upper one where `z_i z_j = -1`; the diagonal is
/// always the lower one. Each is tested by its three leading principal minors (Sylvester).
pub fn is_positive_definite<S: Enclosure>(t: &Symmetric<S>) -> bool {
    let d = [t.diagonal[0].lower(), t.diagonal[1].lower(), t.diagonal[2].lower()];
    let lo = [t.off[0].lower(), t.off[1].lower(), t.off[2].lower()];
    let hi = [t.off[0].upper(), t.off[1].upper(), t.off[2].upper()];
    // The sign patterns of (z_1 z_2, z_1 z_3, z_2 z_3): an even number of them is negative.
    has_positive_minors(&d, [&lo[0], &lo[1], &lo[2]])
        && has_positive_minors(&d, [&lo[0], &hi[1], &hi[2]])
        && has_positive_minors(&d, [&hi[0], &lo[1], &hi[2]])
        && has_positive_minors(&d, [&hi[0], &hi[1], &lo[2]])
}

/// Sylvester's criterion for `[[a, x, y], [x, b, z], [y, z, c]]`: its leading principal minors
/// `a`, `ab - x^2` and `c (ab - x^2) - y (by - xz) - z (az - xy)` are positive. They are
/// homogeneous, so the endpoints' common unit does not matter.
fn has_positive_minors<B: Bound>([a, b, c]: &[B; 3], [x, y, z]: [&B; 3]) -> bool {
    if !a.is_positive() {
        return false;
    }
    let second = a.mul(b).sub(&x.mul(x));
    if !second.is_positive() {
        return false;
    }
    let third =
        c.mul(&second).sub(&y.mul(&b.mul(y).sub(&x.mul(z)))).sub(&z.mul(&a.mul(z).sub(&x.mul(y))));
    third.is_positive()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::Fixed;

    fn matrix(diagonal: [i64; 3], off: [(i64, i64); 3]) -> Symmetric<Fixed> {
        let interval = |(lo, hi): (i64, i64)| Fixed::new(lo.into(), hi.into(), 4).unwrap();
        Symmetric { diagonal: diagonal.map(|d| interval((d, d + 1))), off: off.map(interval) }
    }

    #[test]
    fn definite_matrices_are_accepted() {
        assert!(is_positive_definite(&matrix([1, 1, 1], [(0, 0); 3])));
        // [[4, -1..1, ..], ...] is diagonally dominant.
        assert!(is_positive_definite(&matrix([4, 4, 4], [(-1, 1); 3])));
        // Positive definite with all off-diagonal entries near +1: (1 - t) I + t 11^T.
        assert!(is_positive_definite(&matrix([10, 10, 10], [(8, 9); 3])));
    }

    #[test]
    fn each_sign_pattern_matters() {
        // With entries +-t the matrix is definite iff 1 - t > 0 and 1 + 2t > 0, where the sign of
        // the product of the off-diagonal entries decides; only one vertex of four is indefinite.
        for signs in [[-1, -1, -1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]] {
            let inside = signs.map(|s| if s < 0 { (-5, 0) } else { (0, 5) });
            assert!(!is_positive_definite(&matrix([9, 9, 9], inside)), "{signs:?}");
            let less = signs.map(|s| if s < 0 { (-4, 0) } else { (0, 4) });
            assert!(is_positive_definite(&matrix([9, 9, 9], less)), "{signs:?}");
        }
    }

    #[test]
    fn semidefinite_and_indefinite_matrices_are_rejected() {
        assert!(!is_positive_definite(&matrix([0, 1, 1], [(0, 0); 3])));
        assert!(!is_positive_definite(&matrix([1, 0, 1], [(0, 0); 3])));
        assert!(!is_positive_definite(&matrix([1, 1, 0], [(0, 0); 3])));
        assert!(!is_positive_definite(&matrix([-1, -1, -1], [(0, 0); 3])));
        // Singular: 11^T.
        assert!(!is_positive_definite(&matrix([1, 1, 1], [(1, 1); 3])));
        // Second minor positive, determinant negative.
        assert!(!is_positive_definite(&matrix([3, 3, 3], [(0, 0), (0, 0), (4, 4)])));
    }
}
