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
/// The attempts that mostly suffice, of the planes before which a cell is inner, and beyond which it is outer.
const INNER: usize = 3;
const OUTER: usize = 4;

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
        // What the first order leaves out, nearly, and farther.
        let least = (scale * beyond.iter().map(|x| x.abs()).sum::<f64>()).max(1.0);
        let tried = |sign: f64, guess: usize, ends: &dyn Fn(i64) -> [i64; 2]| {
            let distances = std::iter::successors(Some(least), |distance| Some(distance * FARTHER));
            let distances = distances.take_while(|distance| *distance < all as f64);
            let at = distances.map(|distance| (at + sign * distance).round() as i64);
            let at: Vec<i64> = at.filter(|end| end.abs() < all / 2).collect();
            first(&at, guess, |end| confirms(ends(end))).unwrap_or(all * sign as i64)
        };
        let inner = tried(-1.0, INNER, &|end| [end, all]);
        let outer = tried(1.0, OUTER, &|end| [-all, end]);
        let ends = [inner, outer];
        (ends != [-all, all]).then_some(Cut { normal, ends, fails })
    }
}

/// The first of `ends` that holds, where those beyond one that holds do; `None` where the last does not.
fn first(ends: &[i64], guess: usize, holds: impl Fn(i64) -> bool) -> Option<i64> {
    // None before `from` holds, and that at `to` does, if there is one.
    let (mut from, mut to) = (0, ends.len());
    let mut next = guess.min(to.saturating_sub(1));
    while from < to {
        match holds(ends[next]) {
            true => to = next,
            false => from = next + 1,
        }
        next = if to < ends.len() { (from + to) / 2 } else { to - 1 };
    }
    ends.get(to).copied()
}
