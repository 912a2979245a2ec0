//! The best conditioned point of the inner part, and the inner box that it is in.

use super::Decider;
use orthocert_kernel::paving::{Cell, Edge};

/// Halvings of the box's edges that coordinates of points are multiples of.
const LEVEL: u32 = 40;
/// Halvings of the longest and of the shortest step.
const STEPS: std::ops::Range<u32> = 3..34;
/// Most steps of one length.
const MOST: usize = 32;

/// A point of the box: parts of its edges in units of `2^-LEVEL`.
pub(super) type Point = [u64; 3];

/// A cell's centre.
pub(super) fn centre_of(cell: &Cell) -> Point {
    cell.edges.map(middle)
}

fn middle(edge: Edge) -> u64 {
    (2 * edge.index() + 1) << LEVEL.saturating_sub(edge.level() + 1)
}

/// Parts of the box's edges.
pub(super) fn parts_of(point: &Point) -> [f64; 3] {
    point.map(|x| x as f64 * (-f64::from(LEVEL)).exp2())
}

/// Whether a point with this coordinate is in the lower half of a cell that is split along this edge, or in the
/// upper one, or in both.
pub(super) fn sides(edge: Edge, x: u64) -> [bool; 2] {
    [x <= middle(edge), x >= middle(edge)]
}

/// Goes from a point to better conditioned ones `that` accepts, by ever shorter steps along edges and
/// diagonals; returns the last and its `sigma_max / sigma_min`, nearly. At an isotropic point, that
/// is 1.
pub(super) fn best_conditioned(
    decider: &Decider<'_>,
    start: Point,
    that: impl Fn(&Point) -> bool,
) -> (Point, f64) {
    let value = |point: &Point| decider.conditioning(parts_of(point));
    let mut best = (start, value(&start));
    for step in STEPS {
        for _ in 0..MOST {
            let near = neighbours(&best.0, 1 << (LEVEL - step)).filter(&that);
            let next = near.map(|point| (point, value(&point)));
            match next.min_by(|a, b| a.1.total_cmp(&b.1)) {
                Some(next) if next.1 < best.1 => best = next,
                _ => break,
            }
        }
    }
    best
}

/// The points of the box that are a step or none away along each axis.
fn neighbours(point: &Point, step: u64) -> impl Iterator<Item = Point> + '_ {
    let moved = move |at: u64, way: usize| match way {
        0 => at.checked_sub(step),
        1 => Some(at),
        _ => Some(at + step).filter(|at| *at < 1 << LEVEL),
    };
    (0..27).filter_map(move |way| {
        let [x, y, z] = *point;
        Some([moved(x, way % 3)?, moved(y, way / 3 % 3)?, moved(z, way / 9)?])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::paving::header;
    use orthocert_kernel::paving::{Axis, Subject};

    fn subject(min: &str, max: &str) -> Subject {
        let text = format!(
            "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
             min = [{min}]\nmax = [{max}]\n[requirements]\n\
             transmission = {{ min = \"1/2\", max = 2 }}\n"
        );
        let design = crate::design::Design::parse(&text, "test").unwrap();
        Subject::new(&header(&design.claim, None, 9)).unwrap()
    }

    #[test]
    fn the_isotropic_point_of_the_orthoglide_is_found() {
        // It is the origin: 5/8, 3/8, 4/9 of the edges.
        let subject = subject("-0.5, -0.3, -0.4", "0.3, 0.5, 0.5");
        let decider = Decider::new(&subject).unwrap();
        let (point, conditioning) = best_conditioned(&decider, centre_of(&Cell::ROOT), |_| true);
        let expected = [5.0 / 8.0, 3.0 / 8.0, 4.0 / 9.0];
        for (found, expected) in parts_of(&point).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-8, "{:?}", parts_of(&point));
        }
        assert!((1.0..1.0 + 1e-7).contains(&conditioning), "{conditioning}");
        // Where it may not go there, it stops on the way.
        let quarter = 1 << (LEVEL - 2);
        let (point, conditioning) =
            best_conditioned(&decider, [quarter; 3], |point| point[0] <= 2 * quarter);
        assert!(parts_of(&point)[0] <= 0.5 && conditioning > 1.1, "{point:?} {conditioning}");
    }

    #[test]
    fn a_centre_is_in_both_halves_and_a_corner_in_one() {
        let (lower, upper) = Cell::ROOT.halves(Axis::Y).unwrap();
        assert_eq!(sides(Cell::ROOT.edges[1], centre_of(&Cell::ROOT)[1]), [true, true]);
        assert_eq!(sides(Cell::ROOT.edges[1], centre_of(&lower)[1]), [true, false]);
        assert_eq!(sides(Cell::ROOT.edges[1], centre_of(&upper)[1]), [false, true]);
        assert_eq!(parts_of(&centre_of(&upper)), [0.5, 0.75, 0.5]);
    }
}
