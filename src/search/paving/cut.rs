//! Where a cell is cut that is neither inner nor outer.
//!
//! To first order, the nearest of what a claim asks for holds on one side of a plane. As far from it as the
//! exact judge demands, the cell is inner on this side and outer on the other: what is undecided between
//! them is thinner than the cell in proportion to its size. How far that is, is foreseen where planes meet
//! the cell's edges ([`Seen`]).

use super::decide::{Decider, MOST_FAILURES};
use super::margin::{Margin, View};
use super::seen::Seen;
use orthocert_kernel::paving::{Cell, Cut, Item, Kind};

/// The greatest component of a normal, at least and at most.
const NORMALS: [f64; 2] = [64.0, 524_288.0];
/// The same in the distance that is foreseen: what is rounded there is a small part of it.
const FINE: f64 = 64.0;
/// How much farther from the plane the first attempt is than what is foreseen, and each other one than that before.
const FARTHER: [f64; 2] = [1.08, 1.5];

impl Decider<'_> {
    /// Where an undecided cell is cut; `None` where nothing of it would be decided.
    pub fn cut(&self, cell: &Cell, inherited: u128) -> Option<Cut> {
        let may = self.cuts() && self.may_cut(cell);
        may.then(|| self.view(cell, |over| self.cut_over(over, cell, inherited)))?
    }

    fn cut_over(&self, over: &dyn View, cell: &Cell, inherited: u128) -> Option<Cut> {
        let local = self.local(over)?;
        let (fails, margin) = self.nearest(over, &local, inherited)?;
        let seen = Seen::new(over, &local, self.test(fails), margin)?;
        let Margin { centre, along, .. } = seen.margin;
        let along = &along[..self.dimension()];
        let most = along.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let [foreseen, of_outer] = [1.0, -1.0].map(|side| seen.distance(side));
        let scale = (FINE / foreseen.min(of_outer)).clamp(NORMALS[0] / most, NORMALS[1] / most);
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
        let with = |ends| Cut { normal: normal.clone(), ends, fails };
        let confirms = |ends: [i64; 2]| {
            let item = Item { steps: Vec::new(), kind: Kind::Cut(with(ends)) };
            self.judge().confirms(cell, inherited, &item)
        };
        let tried = |side: f64, foreseen: f64| {
            let first = (foreseen * scale * FARTHER[0]).max(1.0);
            let distances =
                std::iter::successors(Some(first), |distance| Some(distance * FARTHER[1]));
            let distances = distances.take_while(move |distance| *distance < all as f64);
            let end = move |distance: f64| (at - side * (distance + 1.0)).round() as i64;
            distances.map(end).filter(move |end| end.abs() < all / 2)
        };
        let (mut inner, mut outer) = (tried(1.0, foreseen), tried(-1.0, of_outer));
        let first = [inner.next().unwrap_or(-all), outer.next().unwrap_or(all)];
        let ends = match first != [-all, all] && confirms(first) {
            true => first,
            false => {
                let [own, other] = first;
                let inner = [own].into_iter().chain(inner).find(|&end| confirms([end, all]));
                let outer = [other].into_iter().chain(outer).find(|&end| confirms([-all, end]));
                [inner.unwrap_or(-all), outer.unwrap_or(all)]
            }
        };
        (ends != [-all, all]).then(|| with(ends))
    }
}

#[cfg(test)]
mod tests {
    use super::super::header;
    use super::super::tree::{Grower, Tally};
    use super::*;
    use crate::design::Design;
    use orthocert_kernel::paving::{Root, Subject};
    use std::sync::atomic::AtomicBool;

    /// How many cells of a depth two planes cut, and of how many of these neither plane holds a tenth nearer to the other.
    fn cut(text: &str, depth: u32) -> [usize; 2] {
        let claim = Design::parse(text, "test").unwrap().claim;
        let subject = Subject::new(&header(&claim, None, depth)).unwrap();
        let decider = Decider::new(&subject).unwrap().with_cuts(true);
        let cancel = AtomicBool::new(false);
        let grower = Grower { decider: &decider, depth: depth + 1, cancel: &cancel };
        let mut roots = vec![(Root::WHOLE, None)];
        for _ in 0..depth {
            let split = grower.level(&roots, &mut Tally::default()).unwrap();
            roots = split.into_iter().flat_map(|(_, halves)| halves).collect();
        }
        let mut counts = [0; 2];
        for (Root { cell, inherited, .. }, _) in
            grower.level(&roots, &mut Tally::default()).unwrap()
        {
            let Some(Cut { normal, ends: [inner, outer], fails }) = decider.cut(&cell, inherited)
            else {
                continue;
            };
            let all = 2 * normal.iter().map(|n| n.abs()).sum::<i64>();
            if inner == -all || outer == all {
                continue;
            }
            let holds = |ends| {
                let cut = Cut { normal: normal.clone(), ends, fails };
                let item = Item { steps: Vec::new(), kind: Kind::Cut(cut) };
                decider.judge().confirms(&cell, inherited, &item)
            };
            assert!(holds([inner, outer]));
            let nearer = (outer - inner) / 10;
            let is_tight = !holds([inner + nearer, all]) && !holds([-all, outer - nearer]);
            counts = [counts[0] + 1, counts[1] + usize::from(is_tight)];
        }
        counts
    }

    #[test]
    fn most_planes_are_as_near_as_the_judge_allows() {
        let transmission = |min, max| format!("transmission = {{ min = {min}, max = {max} }}");
        let margin = "serial_margin = { min = 0.5 }".to_owned();
        for (machine, [min, max], require, depth) in [
            (
                "orthoglide-310",
                ["[-220, -220, -220]", "[220, 220, 240]"],
                transmission(0.5, 2.0),
                15,
            ),
            (
                "linear-delta-klipper-box",
                ["[-150, -150, 0]", "[150, 150, 90]"],
                transmission(0.5, 2.0),
                11,
            ),
            ("linear-delta-klipper-box", ["[-150, -150, 0]", "[150, 150, 90]"], margin, 12),
            ("upu-struts", ["[-150, -150, 60]", "[150, 150, 260]"], transmission(0.7, 1.3), 14),
        ] {
            let path = format!("{}/tests/designs/{machine}.toml", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).unwrap();
            let (machine, _) = text.split_once("[workspace]").unwrap();
            let workspace = format!("[workspace]\nmin = {min}\nmax = {max}\n");
            let [all, tight] =
                cut(&format!("{machine}{workspace}[requirements]\n{require}\n"), depth);
            assert!(all > 20 && tight * 10 > all * 8, "{machine}{require}: {tight} of {all}");
        }
    }
}
