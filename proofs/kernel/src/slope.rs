//! A formula over a cell: its value at the centre, its range, its slopes.
//!
//! A point of the cell is `x = c + sum_k lambda_k h_k e_k` with `lambda_k` in `[-1, 1]`. For fixed
//! parameters a [`Slope`] of a formula `f` says that there are `S_1 .. S_m` in [`Slope::slopes`] with
//!
//! ```text
//! f(x) = f(c) + sum_k S_k lambda_k        f(c) in `at_centre`        f(x) in `range`
//! ```
//!
//! The `S_k` depend on `x`. Each operation rests on one identity, for the `S` of its operands:
//!
//! ```text
//! f +- g    S_f +- S_g                             f^2       (f_X + f_c) S_f
//! f g       ((g_X + g_c) S_f + (f_X + f_c) S_g)/2  sqrt(f)   S_f/(sqrt f_X + sqrt f_c)
//! f / g     (S_f - (f_c/g_c) S_g)/g_X
//! ```
//!
//! *Proof.* With `d = f(x) - f(c)`, `e = g(x) - g(c)`, `f_X = f(x)`, `f_c = f(c)`: the product's change
//! is `f_X g_X - f_c g_c = ((g_X + g_c) d + (f_X + f_c) e)/2`; a square is one; of the root,
//! `d = (sqrt f_X - sqrt f_c)(sqrt f_X + sqrt f_c)`; of the quotient,
//! `f_X/g_X - f_c/g_c = (f_X - (f_c/g_c) g_X)/g_X = (d - (f_c/g_c) e)/g_X`. ∎
//!
//! *Ranges* that are found in two ways may be intersected: every range is cut to what the slopes
//! reach. *Slopes* from two identities may not: the `S_k` of one point differ between them.
//! `uv - cd = (u - c) v + (v - d) c = (u - c) d + (v - d) u` has the slopes `(v, c)` and `(d, u)`,
//! and on `u, v` in `[1, 3]`, `c = d = 2`, cutting each to what both allow gives `(2, 2)`, which would
//! make the product affine.
//!
//! **Elbows** `u = (c, s)` of `w = (a, b)` and `t` ([`crate::arithmetic::elbow`]) have slopes by the equations
//! that they solve. With means `x_m = (x_X + x_c)/2` and `p = w_m - u_m`:
//!
//! ```text
//! S_c = -s_m z    S_s = c_m z    z = (p_1 S_a + p_2 S_b - S_t/2)/(b_m c_m - a_m s_m)
//! ```
//!
//! *Proof.* The difference of `|u|^2 = 1` at both points is `u_m . du = 0`, that of `|w - u|^2 = t` is
//! `2 p . (dw - du) = dt`. So `w_m . du = p . dw - dt/2`, and `(b_m c_m - a_m s_m) du = (-s_m, c_m) (w_m . du)`. ∎
//! Means are formulas over the cell, with half the slopes of their own, and so, for each `k`, is `z` with
//! any numbers in the enclosures of the three `S_k`, which is in its range. Slopes narrow the ranges that
//! they are found from: they are found twice.

use crate::arithmetic::{elbow, Arithmetic, Enclosure};
use crate::cell::{Vertex, CORNER_PLACES};
use crate::formula::{Tape, Values};

/// Most coordinates of a workspace.
pub const MOST_COORDINATES: usize = 6;

/// A formula over a cell.
#[derive(Clone, Debug)]
pub struct Slope<N> {
    /// Encloses its value at the centre.
    pub at_centre: N,
    /// Encloses its values on the cell.
    pub range: N,
    /// One a coordinate, times the cell's half-width.
    pub slopes: [N; MOST_COORDINATES],
}

/// The arithmetic of slopes in `m` coordinates.
#[derive(Debug)]
pub struct Slopes<'a, E> {
    /// What their parts are computed in.
    pub arithmetic: &'a E,
    /// The coordinates.
    pub m: usize,
    /// The corners of the part of the cell that is meant, where it is not all of it: `lambda`, in units of
    /// `2^-CORNER_PLACES`. Ranges are those of the cell.
    pub part: Option<&'a [Vec<i64>]>,
}

impl<E> Clone for Slopes<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Slopes<'_, E> {}

impl<'a, E> Slopes<'a, E> {
    /// Over all of a cell.
    pub fn new(arithmetic: &'a E, m: usize) -> Self {
        Slopes { arithmetic, m, part: None }
    }
}

impl<E: Enclosure> Slopes<'_, E> {
    /// How many vertices the cell has, or the part that is meant.
    pub fn corners(&self) -> usize {
        self.part.map_or(1 << self.m, <[_]>::len)
    }

    /// Encloses `f_v`.
    #[inline(always)]
    pub fn at(&self, f: &Slope<E::Number>, v: Vertex) -> Option<E::Number> {
        let e = self.arithmetic;
        let mut sum = f.at_centre.clone();
        for (k, term) in f.slopes.iter().take(self.m).enumerate() {
            sum = match self.part {
                None if v.has(k) => e.add(&sum, term)?,
                None => e.sub(&sum, term)?,
                Some(corners) => {
                    let lambda = *corners.get(v.index())?.get(k)?;
                    e.add(&sum, &e.dyadic(lambda, CORNER_PLACES, term)?)?
                }
            };
        }
        Some(sum)
    }

    /// Whether all values of a formula are such numbers; these are a convex set.
    pub fn all(&self, f: &Slope<E::Number>, are: impl Fn(&E::Number) -> bool) -> bool {
        match self.part {
            None => are(&f.range),
            Some(_) => {
                Vertex::first(self.corners()).all(|v| self.at(f, v).is_some_and(|x| are(&x)))
            }
        }
    }

    /// A number that is the same on the whole cell.
    pub fn constant(&self, number: E::Number) -> Option<Slope<E::Number>> {
        let zero = self.arithmetic.integer(0)?;
        let slopes = std::array::from_fn(|_| zero.clone());
        Some(Slope { at_centre: number.clone(), range: number, slopes })
    }

    /// Coordinate `k`, given its centre, range and half-width.
    pub fn coordinate(
        &self,
        k: usize,
        [centre, range, half]: [E::Number; 3],
    ) -> Option<Slope<E::Number>> {
        let mut slope = self.constant(centre)?;
        slope.range = range;
        *slope.slopes.get_mut(k)? = half;
        Some(slope)
    }

    /// The slope with these parts, its range cut to what the slopes reach.
    #[inline]
    fn cut(
        &self,
        at_centre: E::Number,
        range: &E::Number,
        slopes: [E::Number; MOST_COORDINATES],
    ) -> Option<Slope<E::Number>> {
        let range = self.arithmetic.within(range, &at_centre, &slopes[..self.m])?;
        Some(Slope { at_centre, range, slopes })
    }

    /// `change` applied to the slopes of the coordinates there are.
    #[inline]
    fn each(
        &self,
        mut slopes: [E::Number; MOST_COORDINATES],
        change: impl Fn(usize, &E::Number) -> Option<E::Number>,
    ) -> Option<[E::Number; MOST_COORDINATES]> {
        for (k, slope) in slopes.iter_mut().enumerate().take(self.m) {
            *slope = change(k, slope)?;
        }
        Some(slopes)
    }

    /// The mean of a formula's values at the centre and at a point of the cell.
    fn mean(&self, f: &Slope<E::Number>) -> Option<Slope<E::Number>> {
        let e = self.arithmetic;
        let slopes = self.each(f.slopes.clone(), |_, s| e.halve(s))?;
        self.cut(f.at_centre.clone(), &e.halve(&e.add(&f.range, &f.at_centre)?)?, slopes)
    }
}

impl<E: Enclosure> Arithmetic for Slopes<'_, E> {
    type Number = Slope<E::Number>;

    #[inline]
    fn integer(&self, n: i64) -> Option<Self::Number> {
        self.constant(self.arithmetic.integer(n)?)
    }

    #[inline]
    fn add(&self, f: &Self::Number, g: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let slopes = self.each(f.slopes.clone(), |k, s| e.add(s, &g.slopes[k]))?;
        self.cut(e.add(&f.at_centre, &g.at_centre)?, &e.add(&f.range, &g.range)?, slopes)
    }

    #[inline]
    fn sub(&self, f: &Self::Number, g: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let slopes = self.each(f.slopes.clone(), |k, s| e.sub(s, &g.slopes[k]))?;
        self.cut(e.sub(&f.at_centre, &g.at_centre)?, &e.sub(&f.range, &g.range)?, slopes)
    }

    #[inline]
    fn neg(&self, f: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let slopes = self.each(f.slopes.clone(), |_, s| e.neg(s))?;
        Some(Slope { at_centre: e.neg(&f.at_centre)?, range: e.neg(&f.range)?, slopes })
    }

    #[inline]
    fn mul(&self, f: &Self::Number, g: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let p = e.add(&g.range, &g.at_centre)?;
        let q = e.add(&f.range, &f.at_centre)?;
        let slopes = self.each(f.slopes.clone(), |k, s| {
            e.halve(&e.add(&e.mul(&p, s)?, &e.mul(&q, &g.slopes[k])?)?)
        })?;
        self.cut(e.mul(&f.at_centre, &g.at_centre)?, &e.mul(&f.range, &g.range)?, slopes)
    }

    #[inline]
    fn times(&self, n: i64, f: &Self::Number) -> Option<Self::Number> {
        let times = |x: &E::Number| self.arithmetic.dyadic(n, 0, x);
        let slopes = self.each(f.slopes.clone(), |_, s| times(s))?;
        self.cut(times(&f.at_centre)?, &times(&f.range)?, slopes)
    }

    #[inline]
    fn div(&self, f: &Self::Number, g: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let (at_centre, over) = (e.recip(&g.at_centre)?, e.recip(&g.range)?);
        let quotient = e.mul(&f.at_centre, &at_centre)?;
        let slopes = self.each(f.slopes.clone(), |k, s| {
            e.mul(&over, &e.sub(s, &e.mul(&quotient, &g.slopes[k])?)?)
        })?;
        self.cut(quotient, &e.mul(&f.range, &over)?, slopes)
    }

    #[inline]
    fn sqr(&self, f: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let sum = e.add(&f.range, &f.at_centre)?;
        let slopes = self.each(f.slopes.clone(), |_, s| e.mul(&sum, s))?;
        self.cut(e.sqr(&f.at_centre)?, &e.sqr(&f.range)?, slopes)
    }

    #[inline]
    fn sqrt(&self, f: &Self::Number) -> Option<Self::Number> {
        let e = self.arithmetic;
        let (at_centre, range) = (e.sqrt(&f.at_centre)?, e.sqrt(&f.range)?);
        let by = e.recip(&e.add(&range, &at_centre)?)?;
        let slopes = self.each(f.slopes.clone(), |_, s| e.mul(&by, s))?;
        self.cut(at_centre, &range, slopes)
    }

    fn elbow(&self, [a, b, t]: [&Self::Number; 3]) -> Option<[Self::Number; 2]> {
        let e = self.arithmetic;
        let [mut c, mut s] = elbow(self, [a, b, t])?;
        // At a point there are no slopes to narrow it by.
        if self.m == 0 {
            return Some([c, s]);
        }
        let [x, y] = [self.mean(a)?, self.mean(b)?];
        for _ in 0..2 {
            let [cos, sin] = [self.mean(&c)?, self.mean(&s)?];
            let across = self.sub(&self.mul(&y, &cos)?, &self.mul(&x, &sin)?)?;
            let over = self.div(&self.integer(1)?, &across)?;
            let p = self.mul(&self.sub(&x, &cos)?, &over)?;
            let q = self.mul(&self.sub(&y, &sin)?, &over)?;
            let times = |f, s: &E::Number| self.mul(f, &self.constant(s.clone())?);
            let z = self.each(t.slopes.clone(), |k, s| {
                let along = self.add(&times(&p, &a.slopes[k])?, &times(&q, &b.slopes[k])?)?;
                Some(self.sub(&along, &times(&over, &e.halve(s)?)?)?.range)
            })?;
            let by = |m: &E::Number| self.each(z.clone(), |_, z| e.mul(m, z));
            c = self.cut(c.at_centre, &c.range, by(&e.neg(&sin.range)?)?)?;
            s = self.cut(s.at_centre, &s.range, by(&cos.range)?)?;
        }
        Some([c, s])
    }
}

/// The values of a tape's entries over a cell, of which `edges` has, for each coordinate, the
/// expansion point, the range, and what `lambda_k` is multiplied by.
pub fn evaluate<E: Enclosure>(
    tape: &Tape,
    parameters: &[E::Number],
    slopes: Slopes<'_, E>,
    edges: &[[E::Number; 3]],
) -> Values<Slope<E::Number>> {
    tape.run(
        &slopes,
        |k| slopes.coordinate(k, edges.get(k)?.clone()),
        |j| slopes.constant(parameters.get(j)?.clone()),
    )
}
