//! A pose at which `M` is singular, in fractions.

use crate::certificate::Witness;
use crate::formula::{Formula, Op};
use crate::input::Value;
use crate::problem::Problem;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// Most bits of a numerator or denominator.
const MOST_BITS: u64 = 1 << 10;

/// Whether the rows `A_i` have less than full column rank at a witness's point of its machine; `None` if
/// one of them is not made of fractions of so many bits there.
///
/// **Lemma.** If they have, the claim is false. *Proof.* Where a formula is not defined, or some `D_i <= 0`,
/// it is. Else `M = B^-1 A` with `B` regular has the rank of `A`: a parallel singularity. ∎
///
/// No fraction is rounded. Every formula of a drive is homogeneous in its lengths, and in each direction:
/// none is divided by its unit here, which multiplies each row by a number that is not 0.
///
/// Rows that were taken leave the others zero up to their pivots. If no row that is left has an entry in
/// column `k`, the rows' part up to it has a rank of at most `k`, with `k + 1` columns. A combination of
/// nearly dependent columns is a fraction, and not 0.
pub(super) fn is_singular(problem: &Problem, witness: &Witness) -> Option<bool> {
    let mut machine = witness.machine.iter();
    let inputs = problem.inputs.iter().map(|input| {
        let Value::Quantity(own) = &input.value else { return None };
        let number = if input.has_two_ends() { machine.next()? } else { own.ends()[0] };
        number.rational()
    });
    let inputs: Vec<Option<BigRational>> = inputs.collect();
    let mut values: Vec<Option<BigRational>> = Vec::new();
    for op in problem.tape.ops() {
        let at = |f: Formula| values.get(f.0)?.as_ref();
        let value = || match *op {
            Op::Coordinate(k) => witness.point.get(k)?.rational(),
            Op::Parameter(j) => inputs.get(j)?.clone(),
            Op::Integer(n) => Some(BigRational::from_integer(n.into())),
            Op::Add(a, b) => Some(at(a)? + at(b)?),
            Op::Sub(a, b) => Some(at(a)? - at(b)?),
            Op::Neg(a) => Some(-at(a)?),
            Op::Mul(a, b) => Some(at(a)? * at(b)?),
            Op::Div(a, b) => Some(at(a)? / at(b).filter(|b| !b.is_zero())?),
            Op::Sqr(a) => Some(at(a)? * at(a)?),
            Op::Sqrt(a) => {
                let x = at(a).filter(|x| x.is_positive())?;
                Some(BigRational::new(x.numer().sqrt(), x.denom().sqrt())).filter(|r| r * r == *x)
            }
            Op::Elbow(..) => None,
        };
        values.push(value().filter(|x| x.numer().bits().max(x.denom().bits()) <= MOST_BITS));
    }
    let row = |a: &Vec<Formula>| a.iter().map(|f| values.get(f.0)?.clone()).collect();
    let mut rows: Vec<Vec<BigRational>> =
        problem.legs.iter().map(|leg| row(&leg.row.a)).collect::<Option<_>>()?;
    for k in 0..problem.dimension() {
        let Some(own) = rows.iter().position(|row| !row[k].is_zero()) else { return Some(true) };
        let pivot = rows.swap_remove(own);
        for row in &mut rows {
            let by = &row[k] / &pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= &by * p);
        }
    }
    Some(false)
}
