//! What a map says of single designs: the best one, and those that are marked.

use crate::design::{AtlasDesign, Mark, Parameter};
use crate::exact::Exact;
use crate::report::atlas::Standing;
use num_rational::BigRational;
use orthocert_kernel::atlas::walk;
use orthocert_kernel::certificate::AtlasCell;
use orthocert_kernel::number::Expression;
use std::cmp::Ordering;

/// The best design of the map's certified cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Its parameters.
    pub at: Vec<Exact>,
    /// The value of the objective there.
    pub value: Exact,
}

/// The vertex of a certified cell at which the value of an expression compares as `better` with all
/// others, the first in the order of the map among equals. Cells are closed, so that their vertices
/// are certified.
pub fn best(
    design: &AtlasDesign,
    expression: &Expression,
    better: Ordering,
    cells: &[AtlasCell],
) -> Option<Best> {
    let mut best: Option<Best> = None;
    // The tree's shape was checked with the certificate.
    let walked = walk(cells, design.parameters.len(), |_, part, said| {
        let (AtlasCell::Certified(_), Some(ends)) = (said, ends(design, part)) else {
            return Ok(());
        };
        for vertex in 0..1usize << ends.len() {
            let end = |(i, ends): (usize, &[Exact; 2])| ends[vertex >> i & 1].clone();
            let at: Vec<Exact> = ends.iter().enumerate().map(end).collect();
            let Some(value) = design.value(expression, &at) else {
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

/// The ends of each parameter's range in a cell.
pub fn ends(design: &AtlasDesign, part: &[(u64, u32)]) -> Option<Vec<[Exact; 2]>> {
    let of = |(parameter, &(n, level)): (&Parameter, &(u64, u32))| {
        let end = |n: u64| parameter.at(&BigRational::new(n.into(), (1u64 << level).into()));
        Some([end(n)?, end(n + 1)?])
    };
    design.parameters.iter().zip(part).map(of).collect()
}

/// What the map says of a marked design: the verdict of the first decided cell that holds it.
pub fn verdict_at(design: &AtlasDesign, mark: &Mark, cells: &[AtlasCell]) -> Standing {
    let within = |x: &Exact, [min, max]: &[Exact; 2]| {
        let at_most =
            |a: &Exact, b: &Exact| matches!(a.compare(b), Some(Ordering::Less | Ordering::Equal));
        at_most(min, x) && at_most(x, max)
    };
    let holds = |part: &[(u64, u32)]| {
        ends(design, part)
            .is_some_and(|ends| ends.iter().zip(&mark.at).all(|(ends, x)| within(x, ends)))
    };
    let mut standing = Standing::Outside;
    let walked = walk(cells, design.parameters.len(), |_, part, said| {
        if matches!(standing, Standing::Outside | Standing::Undecided) && holds(part) {
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
