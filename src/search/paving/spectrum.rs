//! Least and greatest singular values of a matrix, and their directions, in a few operations.

/// The extreme eigenvalues of `G = M^T M`: the squares of the extreme singular values of `M`.
#[derive(Clone, Copy, Debug)]
pub struct Spectrum {
    /// The eigenvalues are `mean + 2 p cos(phi + 2 k pi/3)`, `phi` within `[0, pi/3]`.
    mean: f64,
    p: f64,
    phi: f64,
    /// `G_11, G_22, G_33, G_12, G_13, G_23`.
    gram: [f64; 6],
}

/// The entries of a symmetric matrix, in the order that is used here.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Spectrum {
    /// Of the first `m` rows and columns. The others take nothing away and add nothing: the mean of the eigenvalues
    /// is neither the least nor the greatest alone.
    pub(super) fn of_first(m: usize, mut gram: [f64; 6]) -> Self {
        let m = m.min(3);
        let mean = gram.iter().take(m).sum::<f64>() / m as f64;
        gram[m..3].fill(mean);
        Spectrum::of(gram)
    }

    /// Of `G_11, G_22, G_33, G_12, G_13, G_23`, by the closed formula for symmetric 3x3 matrices.
    pub fn of(gram: [f64; 6]) -> Self {
        let [a, b, c, x, y, z] = gram;
        let mean = (a + b + c) / 3.0;
        let (a, b, c) = (a - mean, b - mean, c - mean);
        let p = ((a * a + b * b + c * c + 2.0 * (x * x + y * y + z * z)) / 6.0).sqrt();
        if p < 1e-300 {
            return Spectrum { mean, p: 0.0, phi: 0.0, gram };
        }
        let det = a * (b * c - z * z) - x * (x * c - z * y) + y * (x * z - b * y);
        let phi = (det / (2.0 * p * p * p)).clamp(-1.0, 1.0).acos() / 3.0;
        Spectrum { mean, p, phi, gram }
    }

    /// The square of the least singular value.
    pub fn least(&self) -> f64 {
        self.mean + 2.0 * self.p * (self.phi + std::f64::consts::TAU / 3.0).cos()
    }

    /// The square of the greatest singular value.
    pub fn greatest(&self) -> f64 {
        self.mean + 2.0 * self.p * self.phi.cos()
    }

    /// A direction that `M` stretches least.
    pub fn least_direction(&self) -> [f64; 3] {
        self.direction(self.least())
    }

    /// A direction that `M` stretches most.
    pub fn greatest_direction(&self) -> [f64; 3] {
        self.direction(self.greatest())
    }

    /// A vector orthogonal to the rows of `G - value I`: the longest of the products of two of them,
    /// or, where they are all multiples of one, of that one and an axis.
    fn direction(&self, value: f64) -> [f64; 3] {
        let [a, b, c, x, y, z] = self.gram;
        let rows = [[a - value, x, y], [x, b - value, z], [y, z, c - value]];
        let products = [cross(rows[0], rows[1]), cross(rows[1], rows[2]), cross(rows[2], rows[0])];
        let best = longest(products);
        let row = longest(rows);
        let size = squared(row);
        if squared(best) > 1e-12 * size * size {
            return best;
        }
        if size < 1e-24 {
            return [1.0, 0.0, 0.0];
        }
        longest([
            cross(row, [1.0, 0.0, 0.0]),
            cross(row, [0.0, 1.0, 0.0]),
            cross(row, [0.0, 0.0, 1.0]),
        ])
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn squared(a: [f64; 3]) -> f64 {
    a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
}

fn longest(vectors: [[f64; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = vectors;
    let ab = if squared(a) >= squared(b) { a } else { b };
    if squared(ab) >= squared(c) {
        ab
    } else {
        c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gram(m: [[f64; 3]; 3]) -> [f64; 6] {
        let entry = |i: usize, j: usize| (0..3).map(|k| m[k][i] * m[k][j]).sum();
        [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| entry(i, j))
    }

    #[test]
    fn extremes_and_directions_agree_with_the_decomposition() {
        for m in [
            [[1.0, 0.2, -0.4], [0.3, 1.1, 0.5], [-0.7, 0.1, 0.9]],
            [[0.1, 0.9, 0.2], [-0.8, 0.3, 0.4], [0.5, -0.1, 1.1]],
            // Double singular values: least, greatest, all.
            [[1.0, 0.5, 0.5], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]],
            [[1.0, -0.2, -0.2], [-0.2, 1.0, -0.2], [-0.2, -0.2, 1.0]],
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ] {
            let spectrum = Spectrum::of(gram(m));
            let reference = nalgebra::Matrix3::from_fn(|i, j| m[i][j]).singular_values();
            assert!((spectrum.least().sqrt() - reference.min()).abs() < 1e-7, "{m:?}");
            assert!((spectrum.greatest().sqrt() - reference.max()).abs() < 1e-7, "{m:?}");
            for (v, value) in [
                (spectrum.least_direction(), spectrum.least()),
                (spectrum.greatest_direction(), spectrum.greatest()),
            ] {
                let image: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| m[i][j] * v[j]).sum());
                assert!((squared(image) / squared(v) - value).abs() < 1e-6, "{m:?}: {v:?}");
            }
        }
    }
}
