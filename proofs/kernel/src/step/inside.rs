//! Where the workspace is not the cell: what is known to be not negative there.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::formula::Formula;
use crate::problem::Inside;
use crate::test::Over;

impl<E: Enclosure> Checker<'_, E> {
    /// `mu t` at the vertices, for the tangent `t` of the workspace's own inequality at the cell's centre; at control
    /// points `mu g`, whose weighted sum is that of `g(x)`.
    ///
    /// **Lemma.** `g` is concave, so `g <= t`, and `t >= 0` at the cell's points in the workspace.
    /// (Taking `g` at the vertices instead of `t` would be unsound: a convex combination of these is
    /// below `g`. `f = -0.1` "holds" then on `|x| <= 0.7` in the cell `[-1, 1]` with `g = 1/2 - x^2`.)
    pub(super) fn inside(&self, over: &Over<'_, E>, mu: (i64, u32)) -> Option<Vec<E::Number>> {
        let Inside { g, gradient } = self.problem.inside.as_ref()?;
        if over.controls.is_some() {
            return self.multiples(over, *g, mu);
        }
        let e = self.arithmetic;
        let at_centre = |f: &Formula| Some(&over.of(*f)?.at_centre);
        let times = |x: &E::Number| e.dyadic(mu.0, mu.1, x);
        let mut tangent = over.slopes.constant(times(at_centre(g)?)?)?;
        let each = tangent.slopes.iter_mut().zip(gradient).zip(over.place.edges);
        for ((slope, f), [_, _, half]) in each {
            *slope = times(&e.mul(at_centre(f)?, half)?)?;
        }
        over.vertices().map(|v| over.slopes.at(&tangent, v)).collect()
    }

    /// `mu g` for the orientations' own inequality `g >= 0`. Its values at the vertices are those of its
    /// slopes, not of `g` itself: their weighted sum is `g(x)`, and `g` need not be concave.
    pub(super) fn turned(&self, over: &Over<'_, E>, mu: (i64, u32)) -> Option<Vec<E::Number>> {
        self.multiples(over, self.problem.turned?, mu)
    }

    /// `mu f`, for a dyadic number `mu >= 0`, at the vertices or control points.
    fn multiples(
        &self,
        over: &Over<'_, E>,
        f: Formula,
        (multiple, places): (i64, u32),
    ) -> Option<Vec<E::Number>> {
        let at = |v| self.arithmetic.dyadic(multiple, places, &over.at(f, v)?);
        over.vertices().map(at).collect()
    }

    /// Whether the cell has no point of the workspace: the tangent is negative at all vertices, or the
    /// orientations' own inequality nowhere holds.
    pub fn is_outside(&self, over: &Over<'_, E>) -> bool {
        let turned = self.problem.turned.and_then(|g| self.arithmetic.neg(&over.of(g)?.range));
        if turned.is_some_and(|less| self.arithmetic.is_positive(&less)) {
            return true;
        }
        let negative =
            |t: &E::Number| self.arithmetic.neg(t).is_some_and(|t| self.arithmetic.is_positive(&t));
        self.inside(over, (1, 0)).is_some_and(|t| t.iter().all(negative))
    }
}
