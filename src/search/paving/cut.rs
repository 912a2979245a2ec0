//! Where a cell is cut that is neither inner nor outer.
//!
//! To first order, the nearest of what a claim asks for holds on one side of a plane. As far from it as the
//! exact judge demands, the cell is inner on this side and outer on the other: what is undecided between
//! them is thinner than the cell in proportion to its size.

use super::decide::{Decider, Margin, MOST_FAILURES};
use orthocert_kernel::paving::{Cell, Cut, Item, Kind};

/// The greatest component of a normal.
const NORMAL: f64 = 1024.0;
/// How much farther from the plane each attempt is than the one before.
const FARTHER: f64 = 1.3;

impl Decider<'_> {
    /// Where an undecided cell is cut; `None` where nothing of it would be decided.
    pub fn cut(&self, cell: &Cell, inherited: u128) -> Option<Cut> {
        let (fails, margin) = self.nearest(cell, inherited)?;
        let Margin { centre, along, beyond } = margin;
        let along = &along[..self.dimension()];
        let most = along.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let scale = NORMAL / most;
        if fails >= MOST_FAILURES || !(scale.is_finite() && centre.is_finite()) {
            return None;
        }
        let normal: Vec<i64> = along.iter().map(|x| (-x * scale).round() as i64).collect();
        // Beyond all of the cell, on either side.
        let all = 2 * normal.iter().map(|n| n.abs()).sum::<i64>();
        let at = centre * scale;
        if at.abs() > all as f64 {
            return None;
        }
        let confirms = |ends: [i64; 2]| {
            let cut = Cut { normal: normal.clone(), ends, fails };
            let item = Item { steps: Vec::new(), kind: Kind::Cut(cut) };
            self.judge().confirms(cell, inherited, &item)
        };
        // What the first order leaves out, nearly.
        let first = (scale * beyond.iter().map(|x| x.abs()).sum::<f64>()).max(1.0);
        let tried = |sign: f64, ends: &dyn Fn(i64) -> [i64; 2]| {
            let mut distance = first;
            while distance < all as f64 {
                let end = (at + sign * distance).round() as i64;
                if end.abs() < all / 2 && confirms(ends(end)) {
                    return end;
                }
                distance *= FARTHER;
            }
            if sign < 0.0 {
                -all
            } else {
                all
            }
        };
        let inner = tried(-1.0, &|end| [end, all]);
        let outer = tried(1.0, &|end| [-all, end]);
        let ends = [inner, outer];
        (ends != [-all, all]).then_some(Cut { normal, ends, fails })
    }
}
