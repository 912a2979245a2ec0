//! Matrices of rows at a point of a box, and multipliers of few bits.

use nalgebra::{DMatrix, DVector};
use orthocert_kernel::test::{Multiplier, MOST_PLACES};

/// Where singular values are cut off for starts between `kappa U` and `M`, in `kappa`.
const CLIPPED: [f64; 3] = [1.3, 1.1, 2.0];

/// Numbers below this are moderate.
const MODERATE: f64 = 1e50;

/// Whether products of a few of these numbers are numbers: of matrices with others, iterations for eigenvalues do not end.
pub fn are_moderate<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> bool {
    numbers.into_iter().all(|x| x.abs() < MODERATE)
}

/// Which rows of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `A_i` and `D_i`.
    Plain,
    /// Those of `M`, and 1.
    Divided,
    /// Polynomials, of platforms that turn.
    Scaled,
}

/// `A` and `D` of a machine at a point, or at a vertex.
pub struct Rows {
    /// `A`.
    pub a: DMatrix<f64>,
    /// The diagonal of `D`.
    pub d: DVector<f64>,
}

impl Rows {
    /// These, if `D > 0` and all are moderate, as are those of `M`.
    pub fn new(a: DMatrix<f64>, d: DVector<f64>) -> Option<Self> {
        let sound = d.iter().all(|&d| d > MODERATE.recip());
        (sound && are_moderate(a.iter().chain(d.iter()))).then_some(Rows { a, d })
    }

    /// `M = D^(-1/2) A`.
    pub fn m(&self) -> DMatrix<f64> {
        let mut m = self.a.clone();
        for (i, d) in self.d.iter().enumerate() {
            m.row_mut(i).scale_mut(d.sqrt().recip());
        }
        m
    }

    /// `M^T M`.
    pub fn square(&self) -> DMatrix<f64> {
        let m = self.m();
        m.transpose() * m
    }

    /// `Y^T A + A^T Y - Y^T D Y`.
    pub fn minorant(&self, y: &DMatrix<f64>) -> DMatrix<f64> {
        let t = y.transpose() * &self.a;
        &t + t.transpose() - y.transpose() * DMatrix::from_diagonal(&self.d) * y
    }

    /// Matrices `Y` to begin with: `kappa B^-1 U`, `B^-1 M`, where the minorant touches `M^T M`, and
    /// some between them; `U` is the polar factor of `M`.
    pub fn starts(&self, kappa: f64) -> Vec<DMatrix<f64>> {
        let svd = self.m().svd(true, true);
        let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return Vec::new() };
        let xi = svd.singular_values;
        let kappa = if kappa > 0.0 { kappa } else { 0.5 * xi.min() };
        let with = |of: &dyn Fn(f64) -> f64| {
            let mut y = &u * DMatrix::from_diagonal(&xi.map(of)) * &v_t;
            for (i, d) in self.d.iter().enumerate() {
                y.row_mut(i).scale_mut(d.sqrt().recip());
            }
            y
        };
        let clipped = CLIPPED.into_iter().map(|part| with(&|xi| xi.min(part * kappa)));
        [with(&|_| kappa)].into_iter().chain(clipped).chain([with(&|xi| xi)]).collect()
    }
}

/// A multiplier as a matrix.
pub fn matrix(y: &Multiplier) -> DMatrix<f64> {
    let scale = (-f64::from(y.places)).exp2();
    let columns = y.y.first().map_or(0, Vec::len);
    DMatrix::from_fn(y.y.len(), columns, |i, k| y.y[i][k] as f64 * scale)
}

/// `e` with `2^(e - 1) <= x < 2^e`.
pub fn exponent(x: f64) -> i32 {
    if x > 0.0 && x.is_finite() {
        x.log2().floor() as i32 + 1
    } else {
        0
    }
}

/// Places by which the greatest entry of a matrix is below one.
pub fn above(y: &DMatrix<f64>) -> i32 {
    -exponent(y.amax())
}

/// A matrix in integers over `2^places`; at least 0, and none where that is too many.
pub fn rounded(y: &DMatrix<f64>, places: i32) -> Option<Multiplier> {
    in_places(y, places).map(reduced)
}

/// The same, over `2^places` even where all entries have powers of two in common.
pub fn in_places(y: &DMatrix<f64>, places: i32) -> Option<Multiplier> {
    let places = u32::try_from(places.max(0)).ok().filter(|&places| places < MOST_PLACES)?;
    let scale = f64::from(places).exp2();
    let row = |i: usize| y.row(i).iter().map(|y| (y * scale).round() as i64).collect();
    Some(Multiplier { y: (0..y.nrows()).map(row).collect(), places })
}

/// Without the powers of two that all entries have in common.
fn reduced(mut y: Multiplier) -> Multiplier {
    while y.places > 0 && y.y.iter().flatten().all(|y| y % 2 == 0) {
        y.y.iter_mut().flatten().for_each(|y| *y /= 2);
        y.places -= 1;
    }
    y
}

/// The number `n / 2^places` of fewest places in an interval of positive numbers.
pub fn between(low: f64, high: f64) -> Option<(i64, u32)> {
    (0..MOST_PLACES).find_map(|places| {
        let scale = f64::from(places).exp2();
        let n = (low * scale).ceil();
        (n <= high * scale && n < 2f64.powi(62)).then_some((n as i64, places))
    })
}
