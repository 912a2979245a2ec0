//! The shares of a box at whose points a claim holds, and fails.

use super::{is_box, walk, Leaf, Rejected};
use crate::cell::Cell;
use crate::certificate::Tree;
use crate::claim::RegionClaim;
use crate::fixed::{Integer, Interval};
use crate::input::shape_error;
use crate::number::Expression;
use crate::problem::Problem;
use crate::quantity::{Obligation, Test};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// **Lemma (region).** Let each corner of the box be moved inward to the other end of its enclosure:
/// what is left is within the box, and the box within the root. So the share of the box in cells that
/// hold is at least the volume of what is left of these over that of the root; so is the share of those
/// that fail. *Proof.* Cells overlap in faces only. ∎
///
/// To move the root's corners by a unit would be unsound: an enclosure may be as wide as it likes, as of
/// `1 + (sqrt(2)^2 - 2) 10^40`. Refused are claims with orientations, as what is good for some of these
/// at a point is not good there, and those of two points: unique direct kinematics.
pub(super) fn region_holds<Z: Integer>(
    problem: &Problem,
    region: &RegionClaim,
    tree: &Tree,
) -> Result<(), Rejected> {
    let refused = |expected| Err(Rejected::Claim(shape_error("workspace", expected)));
    let of_points = |obligation: &Obligation| !matches!(obligation.test, Test::OneToOne(_));
    if !problem.orientation.is_empty() || !problem.obligations.iter().all(of_points) {
        return refused("one of points alone");
    }
    let root: Cell<BigInt> = problem.root(tree.precision).map_err(Rejected::Claim)?;
    let whole = root.0.iter().map(|edge| &edge.hi - &edge.lo).product::<BigInt>();
    if !is_box(problem) || !whole.is_positive() {
        return refused("a box that has a volume");
    }
    let corner = |x: &Vec<Expression>| problem.point::<BigInt>(x, tree.precision);
    let [Some(min), Some(max)] = problem.corners.each_ref().map(corner) else {
        return refused("numbers");
    };
    let mut found = [BigInt::zero(), BigInt::zero()];
    walk::<Z>(problem, tree, None, |_, leaf, cell| {
        let left = |(edge, (min, max)): (&Interval<Z>, (&Interval<BigInt>, &Interval<BigInt>))| {
            let lo = edge.lo.to_big().max(min.hi.clone());
            let hi = edge.hi.to_big().min(max.lo.clone());
            (hi - lo).max(BigInt::zero())
        };
        let which = match leaf {
            Leaf::Holds => 0,
            Leaf::Fails => 1,
            Leaf::Open(_) => return Ok(()),
        };
        found[which] += cell.0.iter().zip(min.iter().zip(&max)).map(left).product::<BigInt>();
        Ok(())
    })?;
    let whole = BigRational::from(whole);
    let reaches = |share: &Expression, found: BigInt| {
        let share = share.rational().filter(|share| !share.is_negative());
        share.is_some_and(|share| share * &whole <= BigRational::from(found))
    };
    let [inner, outer] = found;
    if reaches(&region.inner, inner) && reaches(&region.outer, outer) {
        Ok(())
    } else {
        Err(Rejected::Shares)
    }
}
