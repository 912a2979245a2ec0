//! Lines of equal margin on a map of two parameters.

use crate::design::{without_margin, AtlasDesign};
use crate::exact::Exact;
use crate::report::page::contour::{Field, Path};
use crate::search::solver::margin::margin;
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_kernel::atlas::walk;
use orthocert_kernel::certificate::AtlasCell;
use rayon::prelude::*;

/// Parts of each range at whose ends margins are sampled.
const PARTS: u32 = 64;
/// Finest step of the search for worst values, `2^-FINEST` of the workspace.
const FINEST: i32 = 7;
/// Most lines.
const LINES: f64 = 8.0;

/// A line, or several, of one margin.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The margin, in per cent: a whole number of them, or a decimal of few digits.
    pub percent: f64,
    /// Its lines, in parts of both ranges.
    pub lines: Vec<Path>,
}

/// The lines of equal margin within the certified cells of a map of two parameters, by sampling;
/// none where margins are not defined.
pub fn contours(design: &AtlasDesign, cells: &[AtlasCell]) -> Vec<Contour> {
    if design.parameters.len() != 2 || without_margin(&design.machine).is_some() {
        return Vec::new();
    }
    let side = PARTS as usize + 1;
    let mut is_certified = vec![false; side * side];
    // The tree's shape was checked with the certificate.
    let _ = walk(cells, 2, |_, part, said| {
        if matches!(said, AtlasCell::Certified(_)) {
            for j in ends(part[1]) {
                for i in ends(part[0]) {
                    is_certified[j * side + i] = true;
                }
            }
        }
        Ok(())
    });
    let values: Vec<f64> = is_certified
        .into_par_iter()
        .enumerate()
        .map(|(n, is_certified)| {
            let at = [n % side, n / side];
            if is_certified {
                margin_at(design, at)
            } else {
                f64::NAN
            }
        })
        .collect();
    let parts = || (0..side).map(|i| i as f64 / f64::from(PARTS)).collect();
    let widest = values.iter().filter(|x| x.is_finite()).fold(0.0, |most: f64, x| most.max(*x));
    let field = Field { xs: parts(), ys: parts(), values };
    levels(100.0 * widest)
        .into_iter()
        .map(|percent| Contour { percent, lines: field.at_least(percent / 100.0).lines })
        .filter(|contour| !contour.lines.is_empty())
        .collect()
}

/// The numbers of the grid's lines that meet an edge.
fn ends((n, level): (u64, u32)) -> std::ops::RangeInclusive<usize> {
    let scale = (-f64::from(level)).exp2() * f64::from(PARTS);
    let (from, to) = (n as f64 * scale, (n as f64 + 1.0) * scale);
    // Exact: powers of two.
    from.ceil() as usize..=to.floor() as usize
}

fn margin_at(design: &AtlasDesign, at: [usize; 2]) -> f64 {
    let part = |i: usize| BigRational::new(BigInt::from(i), BigInt::from(PARTS));
    let values = design.parameters.iter().zip(at).map(|(parameter, i)| parameter.at(&part(i)));
    let values: Option<Vec<Exact>> = values.collect();
    values.map_or(f64::NAN, |values| margin(&design.at(&values), FINEST))
}

/// Round levels up to the widest margin: multiples of 1, 2 or 5 times a power of ten, above zero.
fn levels(widest: f64) -> Vec<f64> {
    let rough = widest / LINES;
    if !rough.is_normal() {
        return Vec::new();
    }
    let power = rough.log10().floor();
    let multiple = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * 10f64.powf(power) >= rough);
    let step = multiple.unwrap_or(10.0) * 10f64.powf(power);
    (1..).map(|i| f64::from(i) * step).take_while(|level| *level < widest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_below_the_widest() {
        assert_eq!(levels(11.3), [2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(levels(100.0), [20.0, 40.0, 60.0, 80.0]);
        assert_eq!(levels(300.0), [50.0, 100.0, 150.0, 200.0, 250.0]);
        assert_eq!(levels(0.0), [0.0; 0]);
        assert_eq!(levels(f64::INFINITY), [0.0; 0]);
    }

    #[test]
    fn the_lines_of_the_grid_that_meet_an_edge_are_those_within_and_at_its_ends() {
        assert_eq!(ends((0, 0)), 0..=64);
        assert_eq!(ends((3, 3)), 24..=32);
        assert_eq!(ends((2, 7)), 1..=1);
        assert!(ends((5, 9)).is_empty());
    }
}
