//! Joint errors and a machine with no position near enough.

use super::{AtPoint, Number};
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::machine::Leg;
use crate::number::Expression;
use crate::slope::{Slope, Slopes};
use crate::test::accuracy::{self, near, spread, Accuracy};

impl AtPoint<'_> {
    /// `v . b - |W_t^T v| - |W_c^T v| - (g/2) |v|` for the worst joint errors, at most; `b` is over `d`.
    ///
    /// **Lemma.** If it is positive, the machine has no pose with the joint coordinates that these errors
    /// give which is off by some `u` with `|u_t| <= 1` and `|u_c| <= 1`. *Proof.* For one,
    /// `b = f(u) - f(0) = W u + e` with `|e| <= g/2` (see [`accuracy`](crate::test::Over::accuracy)), so
    /// `v . b <= |W_t^T v| + |W_c^T v| + |v| g/2`. Of `b_i = (delta_i + eps_i)/d` the error may be `e_i` with
    /// the sign of `v_i`. ∎ A pose that is off by more would show nothing: there may be another one within.
    pub(super) fn far(&self, test: &Accuracy, v: &[i64]) -> Option<Number> {
        let (e, of) = (self.slopes.arithmetic, |f| self.of(f).cloned());
        let ranges = |all: Vec<Slope<Number>>| all.into_iter().map(|x| x.range).collect::<Vec<_>>();
        let along = self.formulas().direction(v, test.joints.len())?;
        let image = ranges(self.formulas().transposed(&test.rows, &along)?);
        let v = ranges(along);
        let d = of(test.distance)?;
        let mut rest = e.integer(0)?;
        for ((v, delta), (error, _)) in
            v.iter().zip(self.off_nominal(&test.joints)?).zip(&test.joints)
        {
            let size = if e.is_nonnegative(v) { v.clone() } else { e.neg(v)? };
            rest = e.add(&rest, &e.mul(v, &e.div(&delta, &d)?)?)?;
            rest = e.add(&rest, &e.mul(&size, &of(*error)?)?)?;
        }
        let edges: Vec<_> = self.point.iter().map(|x| [x.clone(), x.clone(), d.clone()]).collect();
        let slopes = Slopes::new(e, edges.len());
        let values = near(&self.problem.tape, &self.parameters, slopes, &edges, test, of)?;
        let g = spread(slopes, &values, test).filter(|_| self.problem.is_defined(&values))?;
        let norm = |v: &[Number]| e.greatest_root(&e.square(v)?);
        for part in test.parts(image.len()) {
            rest = e.sub(&rest, &norm(image.get(part)?)?)?;
        }
        e.sub(&rest, &e.mul(&e.halve(&g)?, &norm(&v)?)?)
    }

    /// `rho_i` of the machine in the middle of the tolerance, less `rho_i`, at this point. Of angles,
    /// which count their turns: if for all machines of the tolerance the cosine of the difference is
    /// positive, it is within a quarter of a turn on the way from one to the other, and between its sine
    /// and its tangent. It is 0 of a joint that is defined for all of the tolerance, with no derivative but 0 by a
    /// parameter of it: over a cell of an atlas, both would be enclosures for all of its names.
    fn off_nominal(&self, joints: &[accuracy::Joint]) -> Option<Vec<Number>> {
        let (e, problem) = (self.slopes.arithmetic, self.problem);
        let middle = |(_, min, max): (&str, &Expression, &Expression)| {
            &(min + max) / &Expression::integer(2)
        };
        let middle: Vec<Expression> = problem.tolerances().map(middle).collect();
        let with = |machine: &[Expression]| {
            let parameters = problem.parameters(e.bits(), machine).ok()?;
            Some(self.values_of(&problem.tape, &parameters))
        };
        let (nominal, all) = (with(&middle)?, with(&[])?);
        let off = |(leg, (_, by)): (&Leg, &accuracy::Joint)| {
            let of = |values| AtPoint::off(self.slopes, leg.rho?, [&nominal, values]);
            if by.is_empty() {
                return of(&all).and(e.integer(0));
            }
            let (off, cos) = of(&self.values)?;
            let Some(cos) = cos else { return Some(off.range) };
            of(&all)?;
            Some(e.hull(&off.range, &e.div(&off.range, &cos.range)?))
        };
        problem.legs.iter().zip(joints).map(off).collect()
    }
}
