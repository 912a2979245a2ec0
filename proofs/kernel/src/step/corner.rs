//! The tight corners of the paper's cube.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::cell::{unit_corners, Vertex};
use crate::certificate::Corner;
use crate::definite::{is_positive_definite, Triangle};
use crate::slope::Slopes;
use crate::test::Place;

impl<E: Enclosure> Checker<'_, E> {
    /// **Tight corner.** The cell touches the corner `Q` of the paper's cube. With `x = Q + lambda H`,
    /// `lambda` in `[0, 1]^3`: if `sym(M_v) - kappa I` is positive definite at the vertices `v` other
    /// than `Q`, then `sigma_min(M) >= kappa` at the cell's points in the cube.
    ///
    /// *Proof.* At `Q` itself, with `m = M_12(Q)` and `V = [(1,1,1), (1,-1,0), (1,1,-2)]` as columns,
    ///
    /// ```text
    /// T(Q) = sym(M(Q)) - kappa I = (1 - m - kappa) I + m 11^T
    /// V^T T(Q) V = diag(3 (1 + 2m - kappa), 2 (1 - m - kappa), 6 (1 - m - kappa))
    /// Q_1, m = -(1 - kappa)/2:   1 + 2m - kappa = 0            1 - m - kappa = 3 (1 - kappa)/2
    /// Q_2, m = t_2, kappa <= 1/2: 1 + 2m - kappa = 3 (1-kappa)  1 - m - kappa = 0
    ///      kappa >= 1/2:         1 + 2m - kappa = 1/kappa - kappa
    ///                            1 - m - kappa = (1 - kappa)(2 kappa - 1)/(2 kappa)
    /// ```
    ///
    /// none of them negative for `0 < kappa < 1`, which the claim's well-formedness says. A convex
    /// combination of `T(Q)` with positive definite matrices is positive semidefinite, and for a unit
    /// vector `v`, `kappa <= v . M v <= |M v|`. ∎ The true corner is an enclosure here, one unit wide;
    /// a cell that does not reach it has no point in the cube.
    pub(super) fn corner(&self, place: &Place<'_, E::Number>, corner: Corner) -> Option<()> {
        let e = self.arithmetic;
        let (kappa, [q1, q2]) = (self.problem.cube_kappa?, self.tight.as_ref()?);
        let (touches, q) = match corner {
            Corner::Q1 => (place.touches[0], q1),
            Corner::Q2 => (place.touches[1], q2),
        };
        let edge = |[_, range, _]: &[E::Number; 3]| {
            let [low, high] = e.ends(range);
            let end = if corner == Corner::Q1 { high } else { low };
            Some([q.clone(), range.clone(), e.sub(&end, q)?])
        };
        let edges: Vec<_> = place.edges.iter().map(edge).collect::<Option<_>>()?;
        if !touches {
            return None;
        }
        let corners = unit_corners(edges.len());
        let slopes = Slopes { part: Some(&corners), ..Slopes::new(e, edges.len()) };
        let values = self.evaluate(&edges);
        let kappa = &values.of(kappa)?.range;
        let definite = |v: Vertex| {
            let entry = |i: usize, j: usize| {
                let at = |i: usize, j: usize| {
                    let f = *self.divided.get(i)?.a.get(j)?;
                    slopes.at(values.of(f)?, v)
                };
                let sum = e.add(&at(i, j)?, &at(j, i)?)?;
                if i == j {
                    e.sub(&sum, &e.add(kappa, kappa)?)
                } else {
                    Some(sum)
                }
            };
            Triangle::new(3, entry).is_some_and(|t| is_positive_definite(e, &t))
        };
        Vertex::all(3).skip(1).all(definite).then_some(())
    }
}
