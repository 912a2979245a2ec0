//! Atlases: maps of a box of parameters, which say where in it a claim holds, and where it fails.

use crate::certificate::AtlasCell;
use crate::claim::{AtlasClaim, MachineClaim, Mechanism, Parameter, Workspace};
use crate::input::{malformed, ClaimError};
use crate::number::{Expression, Range};
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::statement::{holds, workspace};
use crate::tree;
use crate::vary::{vary, Numbers, MOST_PARAMETERS};
use crate::witness;
use crate::work::{self, spend};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// Most bits of an end of a parameter's range.
pub const MOST_END: u64 = 128;
/// Most halvings of a parameter on a path.
pub const MOST_LEVEL: u32 = 60;

/// A part `[n, n + 1]/2^level` of each parameter's range.
pub type Part = Vec<(u64, u32)>;

impl AtlasClaim {
    /// The claim over a cell: what is decided of it is decided for every value of the parameters there.
    ///
    /// # Errors
    /// If the parameters are not well formed.
    pub fn over(&self, part: &[(u64, u32)]) -> Result<MachineClaim, ClaimError> {
        self.varied(part, &self.machine)
    }

    /// What may name parameters, over a cell.
    ///
    /// # Errors
    /// As [`AtlasClaim::over`].
    pub fn varied<T: Numbers + Clone>(&self, part: &[(u64, u32)], of: &T) -> Result<T, ClaimError> {
        let (ranges, mut over) = (self.ranges(part)?, of.clone());
        over.numbers_mut().into_iter().for_each(|number| vary(number, &ranges));
        Ok(over)
    }

    /// The parameters' ranges in a cell.
    ///
    /// # Errors
    /// If the parameters are not well formed.
    pub fn ranges(&self, part: &[(u64, u32)]) -> Result<Vec<Range>, ClaimError> {
        let named = |(k, (parameter, &(n, level))): (usize, (&Parameter, &(u64, u32)))| {
            let [min, max] = parameter.ends()?;
            let width = (&max - &min) / BigRational::from(BigInt::from(1) << level);
            let least = min + &width * BigRational::from(BigInt::from(n));
            let ends = [least.clone(), least + width];
            Ok(Range { parameter: k, name: parameter.name.clone(), ends })
        };
        self.parameters.iter().zip(part).enumerate().map(named).collect()
    }

    /// Parameters have names that differ from each other and from those of the mechanism, and ranges that
    /// are not empty; the machine has numbers of its own.
    ///
    /// # Errors
    /// What is not so.
    pub fn validate(&self) -> Result<(), ClaimError> {
        let refused = |expected| Err(malformed("parameters", expected));
        if !(1..=MOST_PARAMETERS).contains(&self.parameters.len()) {
            return refused("one to three");
        }
        if matches!(self.machine.mechanism, Mechanism::Orthoglide { .. })
            || matches!(self.machine.workspace, Workspace::Cube { .. })
        {
            return refused("of a machine with numbers of its own, without a cube");
        }
        let mut names: Vec<&str> = match &self.machine.mechanism {
            Mechanism::Formulas(formulas) => formulas.names().collect(),
            _ => Vec::new(),
        };
        for parameter in &self.parameters {
            if !Expression::is_name(&parameter.name) || names.contains(&&*parameter.name) {
                return refused("given names that differ");
            }
            names.push(&parameter.name);
            parameter.ends()?;
        }
        Ok(())
    }
}

impl Parameter {
    fn ends(&self) -> Result<[BigRational; 2], ClaimError> {
        let expected = "with rational ends of up to 128 bits, the least one first";
        let end = |x: &Expression| {
            let x = x.rational()?;
            (x.numer().bits().max(x.denom().bits()) <= MOST_END).then_some(x)
        };
        let ends = end(&self.min).zip(end(&self.max)).map(<[_; 2]>::from);
        let ends = ends.filter(|[min, max]| min < max);
        ends.ok_or_else(|| malformed(&self.name, expected))
    }
}

/// Both halves of a cell along a parameter; `None` where there are none.
pub fn halves(part: &[(u64, u32)], k: usize) -> Option<[Part; 2]> {
    let &(n, level) = part.get(k).filter(|(_, level)| *level < MOST_LEVEL)?;
    Some([2 * n, 2 * n + 1].map(|n| {
        let mut half = part.to_vec();
        half[k] = (n, level + 1);
        half
    }))
}

/// The shares of the box that are in certified and in refuted cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shares {
    /// The sum over the certified cells.
    pub certified: BigRational,
    /// The same over the refuted ones.
    pub refuted: BigRational,
}

/// Gives every cell that is not split to `visit`, with its number; the sums of shares. The tree alone is
/// checked here.
///
/// The leaves of the tree of cells cover the box and overlap in faces only; a leaf below `d` halvings has
/// the share `2^-d`.
///
/// # Errors
/// If the cells are no tree of so many parameters, or `visit` fails.
pub fn walk(
    cells: &[AtlasCell],
    parameters: usize,
    mut visit: impl FnMut(usize, &Part, &AtlasCell) -> Result<(), Rejected>,
) -> Result<Shares, Rejected> {
    let mut waiting: Vec<Part> = vec![vec![(0, 0); parameters]];
    let (certified, refuted) = (BigRational::zero(), BigRational::zero());
    let mut shares = Shares { certified, refuted };
    for (at, cell) in cells.iter().enumerate() {
        let part = waiting.pop().ok_or(Rejected::Shape(at))?;
        let depth: u32 = part.iter().map(|(_, level)| level).sum();
        let share = || BigRational::new(1.into(), BigInt::from(1) << depth);
        match cell {
            AtlasCell::Split(k) => {
                let [lower, upper] = halves(&part, *k).ok_or(Rejected::Shape(at))?;
                waiting.extend([upper, lower]);
                continue;
            }
            AtlasCell::Certified(_) => shares.certified += share(),
            AtlasCell::Refuted(_) => shares.refuted += share(),
            AtlasCell::Undecided => {}
        }
        visit(at, &part, cell)?;
    }
    waiting.is_empty().then_some(shares).ok_or(Rejected::Shape(cells.len()))
}

/// Accepts an atlas but for the cells that are not wanted, by their number, or says why not. Where each
/// cell is wanted by one of several checks, and none refuses, the atlas is accepted.
///
/// **Work.** What is to be done is estimated before it is done, but for the formulas of one cell. A cell
/// may ask for what [`work::WORK_A_BYTE`] allows its own bytes and its part of all bytes together: so the
/// work of all cells is within that of twice the bytes, and no cell's depends on another's.
///
/// # Errors
/// If the proof does not show what is claimed.
pub fn check_part(
    claim: &AtlasClaim,
    cells: &[AtlasCell],
    is_wanted: impl Fn(usize) -> bool,
) -> Result<(), Rejected> {
    claim.validate()?;
    let says = |cell: &&AtlasCell| matches!(cell, AtlasCell::Certified(_) | AtlasCell::Refuted(_));
    let of_cells: usize = cells.iter().map(work::bytes).sum();
    let all = work::bytes(claim).saturating_add(of_cells).max(work::LEAST_BYTES);
    let each = all / cells.iter().filter(says).count().max(1);
    let found = walk(cells, claim.parameters.len(), |at, part, cell| {
        if !is_wanted(at) {
            return Ok(());
        }
        let shown = shown(claim, part, cell, each.saturating_add(work::bytes(cell)));
        shown.map_err(|why| Rejected::Cell(at, Box::new(why)))
    })?;
    let reaches = |share: &Expression, found: &BigRational| {
        let share = share.rational().filter(|share| !share.is_negative());
        share.is_some_and(|share| share <= *found)
    };
    let reached =
        reaches(&claim.certified, &found.certified) && reaches(&claim.refuted, &found.refuted);
    reached.then_some(()).ok_or(Rejected::Shares)
}

/// Whether what is said of a cell holds for all values of the parameters there.
///
/// **Lemma (atlas).** Let names stand for their ranges over the cell. *Certified*: if the claim is then
/// well formed, and its tree holds, for all values of the parameters the claim with these values is
/// well formed and true. *Proof.* Every condition of well-formedness is one of signs of numbers, and of
/// formulas without coordinates, which are certain of enclosures; the root's cell, from the least of
/// the least coordinates to the greatest of the greatest, holds each workspace; the formulas are
/// enclosed for every machine of every value. ∎ *Refuted*: if the witness is accepted, the claim is
/// false for all values. *Proof.* For each, the witness's point is in the workspace, its machine is one
/// of the claim's, and what it names is violated there. ∎ The point may be another for every value.
///
/// Where a tolerance varies, it may be none for some values: its ends are the same number there. A name
/// is an input of which numbers are formulas, and machines differ by it as by a tolerance
/// ([`Tolerances`](crate::test::tolerances::Tolerances)): each of its values is between the ends of the cell's
/// range, and what else varies is in its enclosure for all of them.
pub(crate) fn shown(
    claim: &AtlasClaim,
    part: &[(u64, u32)],
    cell: &AtlasCell,
    bytes: usize,
) -> Result<(), Rejected> {
    if matches!(cell, AtlasCell::Undecided | AtlasCell::Split(_)) {
        return Ok(());
    }
    let mut left = bytes.saturating_mul(work::WORK_A_BYTE);
    let mut over = claim.over(part)?;
    spend(&mut left, work::of_each(&mut over))?;
    let problem = Problem::new(&over)?;
    spend(&mut left, work::of_problem(&problem))?;
    match cell {
        AtlasCell::Certified(tree) => {
            spend(&mut left, work::of_numbers(&problem, tree))?;
            let problem = problem.with_derivatives_for(tree);
            let most_work = problem.most_work.min(left.saturating_mul(work::OF_TREES));
            tree::check(&Problem { most_work, ..problem }, tree)
        }
        AtlasCell::Refuted(witness) => {
            let mut witness = claim.varied(part, witness)?;
            let at_point = work::of_witness(&problem, witness.precision);
            spend(&mut left, work::of_each(&mut witness).saturating_add(at_point))?;
            Ok(witness::check(&problem, &over.workspace, &witness)?)
        }
        AtlasCell::Undecided | AtlasCell::Split(_) => Ok(()),
    }
}

/// What an accepted claim establishes. A parameter is told from a coordinate of its name.
pub fn statement(claim: &AtlasClaim) -> String {
    let AtlasClaim { parameters, machine, certified, refuted } = claim;
    let range =
        |Parameter { name, min, max }: &Parameter| format!("  <{name}> in [{min}, {max}]\n");
    let ranges: String = parameters.iter().map(range).collect();
    let machine = claim.over(&vec![(0, 0); parameters.len()]).unwrap_or_else(|_| machine.clone());
    let all = holds(&machine, &workspace(&machine));
    format!(
        "\
It is proved:
Let a design be good if all of the following holds, with the numbers that it has for
{ranges}{all}Of the box of these parameters, the cells that the proof names certified, in which
every design is good, have at least the share {certified}; the cells that it names
refuted, in which none is, at least the share {refuted}.
"
    )
}
