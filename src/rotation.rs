//! Evidence for the vertex rule: an orthogonal matrix near the polar factor of `M(c)`.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use orthocert_checker::claim::Sign;
use orthocert_checker::rule::Rotation;

/// Bits of a quaternion's components, shortest first; the last is as good as any.
const COMPONENT_BITS: [i32; 5] = [3, 5, 8, 12, 18];

/// Candidates for `W`, shortest first: the identity where it is near, then roundings of
/// `W = (U V^T)^T` where `M(c) = U S V^T`. `W M(c) = V S V^T` is symmetric with the singular values
/// of `M(c)` as eigenvalues, so nothing is lost at the centre. Empty where `M(c)` has no usable
/// singular value decomposition.
pub fn candidates(matrix: &Matrix3<f64>) -> Vec<Rotation> {
    if !matrix.iter().all(|x| x.is_finite()) {
        return Vec::new();
    }
    let svd = matrix.svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else {
        return Vec::new();
    };
    let w = (u * v_t).transpose();
    let (sign, proper) = if w.determinant() < 0.0 { (Sign::Minus, -w) } else { (Sign::Plus, w) };
    let rotation = Rotation3::from_matrix_unchecked(proper);
    let q = UnitQuaternion::from_rotation_matrix(&rotation);
    let mut found = Vec::with_capacity(COMPONENT_BITS.len() + 1);
    if sign == Sign::Plus && q.angle() < 0.5 {
        found.push(Rotation::IDENTITY);
    }
    for bits in COMPONENT_BITS {
        let scale = f64::from(bits).exp2();
        let q = reduced([q.w, q.i, q.j, q.k].map(|x| (x * scale).round() as i64));
        let candidate = Rotation { q, sign };
        if q != [0; 4] && !found.contains(&candidate) {
            found.push(candidate);
        }
    }
    found
}

/// The quaternion divided by the greatest common divisor of its components.
fn reduced(q: [i64; 4]) -> [i64; 4] {
    let gcd = q.iter().fold(0i64, |a, b| num_integer::gcd(a, *b));
    if gcd > 1 {
        q.map(|x| x / gcd)
    } else {
        q
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `W M` for the evidence's own matrix, by the formula of the rule's lemma.
    fn rotated(rotation: &Rotation, m: &Matrix3<f64>) -> Matrix3<f64> {
        let [w, i, j, k] = rotation.q.map(|x| x as f64);
        let q = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, i, j, k));
        q.to_rotation_matrix().matrix() * m * rotation.sign.as_integer() as f64
    }

    #[test]
    fn the_best_candidate_makes_any_matrix_nearly_symmetric_positive() {
        let m = Matrix3::new(0.1, 0.9, 0.2, -0.8, 0.3, 0.4, 0.5, -0.1, 1.1);
        for matrix in [m, -m, m.transpose(), m * m] {
            let best = *candidates(&matrix).last().unwrap();
            let w_m = rotated(&best, &matrix);
            assert!((w_m - w_m.transpose()).norm() < 1e-4);
            let least = (w_m + w_m.transpose()).symmetric_eigenvalues().min() / 2.0;
            let sigma_min = matrix.singular_values().min();
            assert!((least - sigma_min).abs() < 1e-4);
        }
    }

    #[test]
    fn a_matrix_without_direction_gives_no_evidence_or_harmless_evidence() {
        assert!(candidates(&Matrix3::from_element(f64::NAN)).is_empty());
        for candidate in candidates(&Matrix3::zeros()) {
            assert_ne!(candidate.q, [0; 4]);
        }
    }
}
