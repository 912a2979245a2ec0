//! Bodies that keep their distance.

use super::{Multiplier, Over};
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::cell::Vertex;
use crate::formula::{Formula, Vector};
use crate::slope::Slope;

/// Two segments farther from each other than `distance > 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Apart {
    /// Which bodies they are of, counted from one.
    pub bodies: [usize; 2],
    /// Their ends.
    pub ends: [[Vector; 2]; 2],
    /// `R`.
    pub distance: Formula,
}

/// A direction, and what is along it.
type Along<N> = (Vec<Slope<N>>, Vec<Slope<N>>);

impl<E: Enclosure> Over<'_, E> {
    /// **Distance.** Let `g` be affine on the cell, `g = g_0 + sum_k lambda_k g_k`, in the evidence three
    /// rows `g_0j, g_1j, .., g_mj`. If at the vertices `v`, for each end `p` of the one segment and each end
    /// `q` of the other, `(g . (p - q))_v > R |g_v|`, the segments are farther from each other than `R` on
    /// the cell.
    ///
    /// *Proof.* With the weights of [`Vertex`], `g . (p - q) > sum_v w_v R |g_v| >= R |g|` at `x`: norms are
    /// convex. So `g != 0`. The difference of two points of the segments is a convex combination of the four
    /// `p - q`, and with each of these its product with `g` is greater than `R |g|`, so it is longer than
    /// `R`. ∎ With `>=`, `g = 0` would show anything.
    pub fn apart(&self, test: &Apart, evidence: &Multiplier) -> bool {
        let positive = |x: &E::Number| self.slopes.arithmetic.is_positive(x);
        let holds = |along: &Along<E::Number>, v: Vertex| {
            self.beyond(test, along, v).is_some_and(|all| all.iter().all(positive))
        };
        self.along(test, evidence).is_some_and(|along| self.vertices().all(|v| holds(&along, v)))
    }

    /// `g`, and its products with the four `p - q`.
    pub fn along(&self, test: &Apart, evidence: &Multiplier) -> Option<Along<E::Number>> {
        if !evidence.is_of(3, self.slopes.m + 1) {
            return None;
        }
        let rows = evidence.y.iter().map(|row| self.affine(row, evidence.places));
        let g: Vec<Slope<E::Number>> = rows.collect::<Option<_>>()?;
        let product = |(p, q): (&Vector, &Vector)| {
            let terms = g.iter().zip(p).zip(q).map(|((g, &p), &q)| {
                self.slopes.mul(g, &self.slopes.sub(self.of(p)?, self.of(q)?)?)
            });
            self.slopes.sum(terms)
        };
        let [first, second] = &test.ends;
        let pairs = first.iter().flat_map(|p| second.iter().map(move |q| (p, q)));
        let products = pairs.map(product).collect::<Option<_>>()?;
        Some((g, products))
    }

    /// These products at a vertex, less `R |g_v|`.
    pub fn beyond(
        &self,
        test: &Apart,
        (g, products): &Along<E::Number>,
        v: Vertex,
    ) -> Option<Vec<E::Number>> {
        let e = self.slopes.arithmetic;
        let square = e.sum(g.iter().map(|g| e.sqr(&self.slopes.at(g, v)?)))?;
        let least = e.mul(&self.of(test.distance)?.range, &e.greatest_root(&square)?)?;
        let rest = |f| self.less_inside(e.sub(&self.slopes.at(f, v)?, &least)?, v);
        products.iter().map(rest).collect()
    }

    /// `n_0 + sum_k lambda_k n_k`, over `2^places`.
    fn affine(&self, n: &[i64], places: u32) -> Option<Slope<E::Number>> {
        let e = self.slopes.arithmetic;
        let one = e.integer(1)?;
        let (first, rest) = n.split_first()?;
        let mut affine = self.slopes.constant(e.dyadic(*first, places, &one)?)?;
        for (slope, &n) in affine.slopes.iter_mut().zip(rest) {
            *slope = e.dyadic(n, places, &one)?;
            affine.range = e.add(&affine.range, &e.hull(slope, &e.neg(slope)?))?;
        }
        Some(affine)
    }
}
