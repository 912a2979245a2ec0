//! A second point with the same joint coordinates.

use super::{contains, AtPoint, Number, WitnessError};
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::cell::Vertex;
use crate::claim::Workspace;
use crate::fixed::{Integer, Interval};
use crate::input::sign;
use crate::machine::Leg;
use crate::number::Expression;
use crate::problem::Problem;
use crate::slope::{evaluate, Slope, Slopes};
use crate::test::Multiplier;

/// Whether a box is in the workspace, which is convex, and the point is not in the box. Of orientations
/// that is decided with the formulas over it.
///
/// # Errors
/// If that is not certain.
pub(super) fn is_beside(
    problem: &Problem,
    workspace: &Workspace,
    point: &[Expression],
    [least, greatest]: [&[Expression]; 2],
) -> Result<(), WitnessError> {
    let m = problem.dimension();
    let less = |a: &Expression, b: &Expression| matches!(sign(&(b - a)), Some([true, _]));
    let corner = |v: Vertex| -> Vec<Expression> {
        let end = |k: usize| if v.has(k) { greatest[k].clone() } else { least[k].clone() };
        (0..m).map(end).collect()
    };
    // In a box if the least and the greatest corner are.
    let is_box = !matches!(workspace, Workspace::Cylinder { .. });
    let decides = |v: &Vertex| !is_box || v.index() == 0 || v.index() + 1 == 1 << m;
    let inside = least.len() == m
        && greatest.len() == m
        && Vertex::all(m).filter(decides).all(|v| contains(problem, workspace, &corner(v)));
    let mut each = point.iter().zip(least).zip(greatest);
    let beside = each.any(|((x, least), greatest)| less(x, least) || less(greatest, x));
    (inside && beside).then_some(()).ok_or(WitnessError::Outside)
}

impl AtPoint<'_> {
    /// Whether some point `x` of the box has the joint coordinates of this point.
    ///
    /// **Lemma (Krawczyk).** Let `F(x) = f(x) - f(P)` be of as many joints as coordinates, the box
    /// `c + (lambda_k h_k)` with `lambda` in `[-1, 1]^m`, `F(x) = F(c) + S lambda` on it, and `H` diagonal
    /// with the `h_k`. If for one matrix `Y`, in each row, `|Y F(c)|_j + sum_k |H - Y S|_jk < h_j`, then
    /// `F` is zero at some `x` of the box. *Proof.* `T(x) = x - Y F(x)` is
    /// `c - Y F(c) + (H - Y S) lambda`: continuous, and into the box, so it has a fixed point (Brouwer),
    /// where `Y F(x) = 0`. And `Y` is regular: `I - Y S H^-1`, of a norm less than one by the sums of its
    /// rows weighted by `h`, makes `Y S H^-1` regular. ∎
    ///
    /// It is a pose of the workspace, and another one than this point: each has its coordinates once.
    ///
    /// Of angles `F_i` is `sin(theta - theta_P)`, zero with a positive cosine only where they are equal up
    /// to whole turns.
    pub(super) fn has_the_joints_of(
        &self,
        [least, greatest]: [&[Expression]; 2],
        inverse: &Multiplier,
    ) -> Option<()> {
        let (e, m) = (self.slopes.arithmetic, self.point.len());
        let Multiplier { y, places } = inverse;
        let (least, greatest) =
            (self.problem.point(least, e.bits())?, self.problem.point(greatest, e.bits())?);
        // Rounded inward, and as far to either side of the centre.
        let edge = |(least, greatest): (&Number, &Number)| {
            let centre = least.hi.plus(&greatest.lo)?.half();
            let half =
                e.sub(&Interval::point(centre.clone()), &Interval::point(least.hi.clone()))?;
            let centre = Interval::point(centre);
            let range = e.hull(&e.sub(&centre, &half)?, &e.add(&centre, &half)?);
            e.is_positive(&half).then_some([centre, range, half])
        };
        let edges: Vec<_> = least.iter().zip(&greatest).map(edge).collect::<Option<_>>()?;
        let slopes = Slopes::new(e, m);
        let values = evaluate(&self.problem.tape, &self.parameters, slopes, &edges);
        let ranges: Vec<Number> = edges.iter().map(|[_, range, _]| range.clone()).collect();
        if !self.is_turned(&ranges, &values) {
            return None;
        }
        let off = |leg: &Leg| Some(AtPoint::off(slopes, leg.rho?, [&values, &self.values])?.0);
        let f: Vec<Slope<Number>> = self.problem.legs.iter().map(off).collect::<Option<_>>()?;
        let zero = e.integer(0)?;
        let holds = |(j, y): (usize, &Vec<i64>)| {
            let sum = |of: &dyn Fn(&Slope<Number>) -> Number, start: &Number| {
                y.iter().zip(&f).try_fold(start.clone(), |sum, (&y, f)| {
                    e.sub(&sum, &e.dyadic(y, *places, &of(f))?)
                })
            };
            let half = &edges.get(j)?[2];
            let mut reach = e.magnitude(&sum(&|f| f.at_centre.clone(), &zero)?)?;
            for k in 0..m {
                let start = if j == k { half } else { &zero };
                reach = e.add(&reach, &e.magnitude(&sum(&|f| f.slopes[k].clone(), start)?)?)?;
            }
            Some(e.is_positive(&e.sub(half, &reach)?))
        };
        let all = inverse.is_of(m, m)
            && f.len() == m
            && y.iter().enumerate().all(|row| holds(row) == Some(true));
        all.then_some(())
    }
}
