//! Vectors and 3x3 matrices over a [`Scalar`].
//!
//! `Matrix[i][j]` is row `i`, column `j`, both counted from zero.

use crate::enclosure::Scalar;
use std::array::from_fn;

/// A vector of `R^3`.
pub type Vector<S> = [S; 3];
/// A matrix of `R^(3x3)`, by rows.
pub type Matrix<S> = [[S; 3]; 3];

/// `a + b`.
pub fn add<S: Scalar>(a: &Vector<S>, b: &Vector<S>) -> Vector<S> {
    from_fn(|k| a[k].add(&b[k]))
}

/// `a - b`.
pub fn sub<S: Scalar>(a: &Vector<S>, b: &Vector<S>) -> Vector<S> {
    from_fn(|k| a[k].sub(&b[k]))
}

/// `c a`.
pub fn scale<S: Scalar>(c: &S, a: &Vector<S>) -> Vector<S> {
    from_fn(|k| c.mul(&a[k]))
}

/// `a . b`.
pub fn dot<S: Scalar>(a: &Vector<S>, b: &Vector<S>) -> S {
    a[0].mul(&b[0]).add(&a[1].mul(&b[1])).add(&a[2].mul(&b[2]))
}

/// `|a|^2`, as a sum of squares.
pub fn norm_squared<S: Scalar>(a: &Vector<S>) -> S {
    a[0].sqr().add(&a[1].sqr()).add(&a[2].sqr())
}

/// `A x`.
pub fn apply<S: Scalar>(a: &Matrix<S>, x: &Vector<S>) -> Vector<S> {
    from_fn(|i| dot(&a[i], x))
}

/// `c A`.
pub fn scale_matrix<S: Scalar>(c: &S, a: &Matrix<S>) -> Matrix<S> {
    from_fn(|i| scale(c, &a[i]))
}

/// `A B`.
pub fn product<S: Scalar>(a: &Matrix<S>, b: &Matrix<S>) -> Matrix<S> {
    from_fn(|i| {
        from_fn(|j| a[i][0].mul(&b[0][j]).add(&a[i][1].mul(&b[1][j])).add(&a[i][2].mul(&b[2][j])))
    })
}

/// `det A`, expanded along the first row.
pub fn determinant<S: Scalar>(a: &Matrix<S>) -> S {
    let minor = |j: usize, k: usize| a[1][j].mul(&a[2][k]).sub(&a[1][k].mul(&a[2][j]));
    a[0][0].mul(&minor(1, 2)).sub(&a[0][1].mul(&minor(0, 2))).add(&a[0][2].mul(&minor(0, 1)))
}

/// A symmetric 3x3 matrix: `diagonal` is `(T_11, T_22, T_33)`, `off` is `(T_12, T_13, T_23)`.
#[derive(Clone, Debug)]
pub struct Symmetric<S> {
    /// `T_11, T_22, T_33`.
    pub diagonal: Vector<S>,
    /// `T_12, T_13, T_23`.
    pub off: Vector<S>,
}

impl<S: Scalar> Symmetric<S> {
    /// `A + A^T`: twice the symmetric part of `A`.
    pub fn twice_part_of(a: &Matrix<S>) -> Self {
        let two = a[0][0].integer_like(2);
        Symmetric {
            diagonal: from_fn(|i| two.mul(&a[i][i])),
            off: [a[0][1].add(&a[1][0]), a[0][2].add(&a[2][0]), a[1][2].add(&a[2][1])],
        }
    }

    /// `A^T A`.
    pub fn gram_of(a: &Matrix<S>) -> Self {
        let entry = |i: usize, j: usize| {
            a[0][i].mul(&a[0][j]).add(&a[1][i].mul(&a[1][j])).add(&a[2][i].mul(&a[2][j]))
        };
        Symmetric {
            diagonal: from_fn(|i| a[0][i].sqr().add(&a[1][i].sqr()).add(&a[2][i].sqr())),
            off: [entry(0, 1), entry(0, 2), entry(1, 2)],
        }
    }

    /// `T + U`.
    pub fn add(&self, other: &Self) -> Self {
        Symmetric {
            diagonal: add(&self.diagonal, &other.diagonal),
            off: add(&self.off, &other.off),
        }
    }

    /// `T - U`.
    pub fn sub(&self, other: &Self) -> Self {
        Symmetric {
            diagonal: sub(&self.diagonal, &other.diagonal),
            off: sub(&self.off, &other.off),
        }
    }

    /// `c I - T`.
    pub fn subtracted_from(&self, c: &S) -> Self {
        Symmetric {
            diagonal: from_fn(|i| c.sub(&self.diagonal[i])),
            off: from_fn(|i| self.off[i].neg()),
        }
    }

    /// `T - c I`.
    pub fn minus_identity(&self, c: &S) -> Self {
        Symmetric { diagonal: from_fn(|i| self.diagonal[i].sub(c)), off: self.off.clone() }
    }
}
