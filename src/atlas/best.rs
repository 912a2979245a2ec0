//! What a map says of single designs: the best one, and those that are marked.

use crate::design::{AtlasDesign, Mark};
use orthocert_checker::atlas::{range, walk, Ends};
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::AtlasCell;
use orthocert_checker::number::Exact;
use serde::Serialize;
use std::cmp::Ordering;

/// The best design of the map's certified cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Its parameters.
    pub at: Vec<Exact>,
    /// The value of the objective there.
    pub value: Exact,
}

/// What a map says of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// It is in a certified cell.
    Certified,
    /// It is in a refuted cell.
    Refuted,
    /// It is in an undecided cell.
    Undecided,
    /// It is not in the box of parameters.
    Outside,
}

/// The vertex of a certified cell at which the value of an expression compares as `better` with all
/// others, the first in the order of the map among equals. Cells are closed, so that their vertices
/// are certified.
pub fn best(
    design: &AtlasDesign,
    expression: &Exact,
    better: Ordering,
    cells: &[AtlasCell],
) -> Option<Best> {
    let claim = design.claim();
    let mut best: Option<Best> = None;
    // The tree's shape was checked with the certificate.
    let walked = walk(cells, design.parameters.len(), |_, cell, said| {
        let (AtlasCell::Certified(_), Ok(ranges)) = (said, claim.ranges(cell)) else {
            return Ok(());
        };
        for vertex in 0..1usize << ranges.len() {
            let end = |(i, (_, ends)): (usize, &(&str, Ends))| match vertex >> i & 1 {
                0 => ends.0.clone(),
                _ => ends.1.clone(),
            };
            let at: Vec<Exact> = ranges.iter().enumerate().map(end).collect();
            let Some(value) = value(design, expression, &at) else {
                continue;
            };
            if best.as_ref().is_none_or(|best| value.compare(&best.value) == Some(better)) {
                best = Some(Best { at, value });
            }
        }
        Ok(())
    });
    walked.ok().and(best)
}

/// The value of an expression at values of the parameters.
fn value(design: &AtlasDesign, expression: &Exact, at: &[Exact]) -> Option<Exact> {
    let names = design.parameters.iter().map(|parameter| parameter.name.as_str());
    let points: Vec<(&str, Ends)> =
        names.zip(at).map(|(name, x)| (name, (x.clone(), x.clone()))).collect();
    range(expression, &points).ok().map(|(value, _)| value)
}

/// What the map says of a marked design: the verdict of the first decided cell that holds it.
pub fn verdict_at(design: &AtlasDesign, mark: &Mark, cells: &[AtlasCell]) -> Standing {
    let claim = design.claim();
    let within = |x: &Exact, (min, max): &Ends| {
        let at_most =
            |a: &Exact, b: &Exact| matches!(a.compare(b), Some(Ordering::Less | Ordering::Equal));
        at_most(min, x) && at_most(x, max)
    };
    let holds = |cell: &Cell| {
        claim
            .ranges(cell)
            .is_ok_and(|ranges| ranges.iter().zip(&mark.at).all(|((_, ends), x)| within(x, ends)))
    };
    let mut standing = Standing::Outside;
    let walked = walk(cells, design.parameters.len(), |_, cell, said| {
        if matches!(standing, Standing::Outside | Standing::Undecided) && holds(cell) {
            standing = match said {
                AtlasCell::Certified(_) => Standing::Certified,
                AtlasCell::Refuted(_) => Standing::Refuted,
                AtlasCell::Undecided | AtlasCell::Split(_) => Standing::Undecided,
            };
        }
        Ok(())
    });
    walked.map_or(Standing::Outside, |_| standing)
}
