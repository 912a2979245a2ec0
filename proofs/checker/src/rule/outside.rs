//! Cells without a point of the workspace.

use super::Failure;
use crate::cell::Cell;
use crate::model::Model;
use num_bigint::BigInt;

/// **Outside.** A cell that has no inner point of the cylinder discharges everything.
///
/// *Proof.* `x = center_x + radius (2 u_x - 1)` and likewise `y`, so the open cylinder is
/// `(2 u_x - 1)^2 + (2 u_y - 1)^2 < 1`. The least value on the cell is taken at the points of its
/// edges nearest to 1/2, and computed exactly. A point of the cylinder's surface that lies in such
/// cells only is a limit of inner points, which lie in other leaves: finitely many closed cells, so
/// one of them contains it, and every requirement is a closed condition there (or is proved with
/// `s_i > 0` on the closed cell). ∎
pub fn outside<S>(model: &Model<S>, cell: &Cell) -> Result<(), Failure> {
    if !model.is_cylinder {
        return Err(Failure::NotOutside);
    }
    let [x, y, _] = cell.edges;
    // |2 u - 1| 2^level at the nearest point: 2 index - 2^level and 2 index + 2 - 2^level are its
    // values at both ends; zero lies between them where their signs differ.
    let nearest = |index: u128, level: u32| {
        let one = BigInt::from(1) << level;
        let low: BigInt = BigInt::from(index) * 2 - &one;
        let high: BigInt = (BigInt::from(index) + 1) * 2 - &one;
        let zero = BigInt::from(0);
        if low > zero {
            low
        } else if high < zero {
            -high
        } else {
            zero
        }
    };
    let (a, b) = (nearest(x.index, x.level) << y.level, nearest(y.index, y.level) << x.level);
    let one = BigInt::from(1) << (2 * (x.level + y.level));
    if &a * &a + &b * &b >= one {
        Ok(())
    } else {
        Err(Failure::NotOutside)
    }
}
