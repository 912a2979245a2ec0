//! Atlases: certified maps of a box of parameters.
//!
//! An atlas claims that the designs of certain cells of a box of parameters all meet their
//! requirements, and that those of others all fail. The cells are those of a bisection tree; what
//! is to be proved of a cell is derived here from the design's expressions ([`instance`]), never
//! read from the proof.

mod instance;
mod role;

pub use instance::{instance, range, Ends, Side};
pub use role::Role;

use crate::cell::{Axis, Cell, Edge};
use crate::certificate::{Atlas, AtlasCell, MAX_NODES};
use crate::check::{check_tree, Rejected, TreeSize};
use crate::claim::{AtlasClaim, AtlasParameter, MachineClaim, Mechanism};
use crate::number::{Exact, NumberErrorKind, MAX_NAME};
use crate::witness;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;
use std::cmp::Ordering;
use std::fmt;

/// Most parameters of an atlas.
pub const MAX_PARAMETERS: usize = 3;
/// Most names of one number of its design.
pub const MAX_NAMES: usize = 6;
/// Most names of all its numbers together, a quantity being two: they are evaluated in every cell.
pub const MAX_ALL_NAMES: usize = 128;
/// Most bits of a numerator or denominator of the end of a parameter's range, and of a rational
/// number beside a name.
pub const MAX_BITS: u64 = 128;

/// Why an atlas's claim, or that of one of its cells, is not well formed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AtlasError {
    /// Not one to three parameters.
    Count(usize),
    /// A name that is not one, is taken, or is `sqrt`.
    BadName(String),
    /// A range that is not rational, or whose least value is not less than its greatest.
    BadRange(String),
    /// No number of the design depends on the parameter.
    Unused(String),
    /// A name that is no parameter's.
    Unknown(String),
    /// A number that may not depend on parameters.
    Varies(String),
    /// A number with too many names, or with rational numbers that are too long; or too many names
    /// in all.
    TooLong(String),
    /// The paper's cube, which has no numbers of its own to vary.
    Cube,
    /// The order of two numbers is not decided.
    Order,
    /// A number is not defined for all values of the parameters in the cell.
    Number(NumberErrorKind),
}

impl From<NumberErrorKind> for AtlasError {
    fn from(error: NumberErrorKind) -> Self {
        AtlasError::Number(error)
    }
}

impl fmt::Display for AtlasError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AtlasError::Count(count) => {
                write!(f, "{count} parameters; an atlas has one to {MAX_PARAMETERS}")
            }
            AtlasError::BadName(name) => write!(
                f,
                "the name {name:?}; a parameter's is a small letter, then small letters, digits \
                 and \"_\", not \"sqrt\", and not another one's"
            ),
            AtlasError::BadRange(name) => {
                write!(f, "the range of {name}; its min is a rational number less than its max")
            }
            AtlasError::Unused(name) => write!(f, "no number of the design depends on {name}"),
            AtlasError::Unknown(name) => write!(f, "{name} is not the name of a parameter"),
            AtlasError::Varies(number) => {
                write!(f, "{number} varies, but is a number that may not depend on parameters")
            }
            AtlasError::TooLong(number) => write!(
                f,
                "{number} is beyond what is evaluated in every cell: {MAX_NAMES} names in a number, \
                 {MAX_ALL_NAMES} in all, beside them numbers of {MAX_BITS} bits"
            ),
            AtlasError::Cube => {
                write!(
                    f,
                    "the design of an atlas is a machine with numbers of its own, no \"cube\""
                )
            }
            AtlasError::Order => write!(f, "the order of two numbers cannot be decided"),
            AtlasError::Number(NumberErrorKind::DivisorMayBeZero) => {
                write!(f, "a divisor is or may be zero for some values of the parameters")
            }
            AtlasError::Number(NumberErrorKind::RadicandMayBeNegative) => {
                write!(f, "a radicand is or may be negative for some values of the parameters")
            }
            AtlasError::Number(_) => write!(f, "a number is too large"),
        }
    }
}

impl std::error::Error for AtlasError {}

impl AtlasClaim {
    /// Proves the claim well formed: one to three parameters with names and rational ranges that
    /// are not empty, a design that depends on each of them and on nothing else.
    ///
    /// # Errors
    /// The first thing that is not so.
    pub fn validate(&self) -> Result<(), AtlasError> {
        if self.parameters.is_empty() || self.parameters.len() > MAX_PARAMETERS {
            return Err(AtlasError::Count(self.parameters.len()));
        }
        for (i, AtlasParameter { name, min, max }) in self.parameters.iter().enumerate() {
            let taken = self.parameters.iter().take(i).any(|other| other.name == *name);
            if taken || !is_name(name) {
                return Err(AtlasError::BadName(name.clone()));
            }
            if !is_short(min) || !is_short(max) || min.compare(max) != Some(Ordering::Less) {
                return Err(AtlasError::BadRange(name.clone()));
            }
        }
        if !matches!(self.design.mechanism, Mechanism::Translational(_)) {
            return Err(AtlasError::Cube);
        }
        let mut names = Vec::new();
        self.design.try_map(&mut |x, _| {
            let before = names.len();
            let short = names_of(x, &mut names);
            let count = names.len() - before;
            let bounded = short && count <= MAX_NAMES && names.len() <= MAX_ALL_NAMES;
            if count > 0 && !bounded {
                return Err(AtlasError::TooLong(x.to_string()));
            }
            Ok(x.clone())
        })?;
        if let Some(unknown) = names.iter().find(|name| self.position(name).is_none()) {
            return Err(AtlasError::Unknown(unknown.clone()));
        }
        let unused = self.parameters.iter().find(|parameter| !names.contains(&parameter.name));
        unused.map_or(Ok(()), |parameter| Err(AtlasError::Unused(parameter.name.clone())))
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name == name)
    }

    /// The ranges of the parameters in a cell: `min + (max - min) [index, index + 1] / 2^level`.
    ///
    /// # Errors
    /// If the numbers are too large.
    pub fn ranges(&self, cell: &Cell) -> Result<Vec<(&str, Ends)>, AtlasError> {
        let ranges = self.parameters.iter().zip(&cell.edges);
        ranges.map(|(p, edge)| Ok((p.name.as_str(), p.part(edge)?))).collect()
    }

    /// The strictest or loosest claim of a cell, see [`instance`].
    ///
    /// # Errors
    /// If the cell's numbers cannot be told.
    pub fn cell(&self, cell: &Cell, side: Side) -> Result<MachineClaim, AtlasError> {
        instance(&self.design, &self.ranges(cell)?, side)
    }
}

impl AtlasParameter {
    /// The part of the range that an edge is.
    fn part(&self, edge: &Edge) -> Result<Ends, NumberErrorKind> {
        let width = self.max.clone().minus(self.min.clone())?;
        let at = |index: u128| {
            let part = BigRational::new(index.into(), BigInt::from(1) << edge.level);
            self.min.clone().plus(width.clone().times(Exact::Rational(part))?)
        };
        Ok((at(edge.index)?, at(edge.index + 1)?))
    }
}

fn is_name(name: &str) -> bool {
    let parsed = Exact::parse_open(name, 1);
    name.len() <= MAX_NAME && parsed == Ok(Exact::Name(name.into()))
}

/// Whether `x` is a rational number of at most [`MAX_BITS`].
fn is_short(x: &Exact) -> bool {
    x.as_rational().is_some_and(|x| x.numer().bits().max(x.denom().bits()) <= MAX_BITS)
}

/// Adds the names of an expression to `names`; whether its rational numbers are short.
fn names_of(x: &Exact, names: &mut Vec<String>) -> bool {
    match x {
        Exact::Rational(_) => is_short(x),
        Exact::Name(name) => {
            names.push(name.to_string());
            true
        }
        Exact::Neg(x) | Exact::Sqrt(x) => names_of(x, names),
        Exact::Add(x, y) | Exact::Sub(x, y) | Exact::Mul(x, y) | Exact::Div(x, y) => {
            names_of(x, names) & names_of(y, names)
        }
    }
}

/// The shares of the box that are in certified and in refuted cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shares {
    /// Sum of `2^-depth` over the certified cells.
    pub certified: BigRational,
    /// The same over the refuted ones.
    pub refuted: BigRational,
}

/// Walks a tree of cells in preorder and gives every one that is not split to `visit`, with its
/// number; returns the sums of shares. The tree alone is checked here, not what it says of its
/// cells.
///
/// **Lemma.** The leaves cover the box, and no two have an inner point in common; the share of a
/// leaf below `d` splits is `2^-d`. *Proof.* By induction: the halves of a cell cover it, share no
/// inner point, and each has half its share. ∎
///
/// # Errors
/// If the cells are not a tree over `parameters` axes, or `visit` fails.
pub fn walk(
    cells: &[AtlasCell],
    parameters: usize,
    mut visit: impl FnMut(usize, &Cell, &AtlasCell) -> Result<(), Rejected>,
) -> Result<Shares, Rejected> {
    let mut shares = Shares { certified: BigRational::zero(), refuted: BigRational::zero() };
    let mut waiting = vec![Cell::ROOT];
    for (number, node) in cells.iter().enumerate() {
        let cell = waiting.pop().ok_or(Rejected::TrailingNodes(cells.len() - number))?;
        if let AtlasCell::Split(parameter) = node {
            let axis = parameter.checked_sub(1).filter(|&i| i < parameters);
            let axis = axis.and_then(|i| Axis::ALL.get(i)).ok_or(Rejected::NoSuchAxis(number))?;
            let (lower, upper) = cell.halves(*axis).ok_or(Rejected::TooDeep(number))?;
            waiting.extend([upper, lower]);
            continue;
        }
        visit(number, &cell, node)?;
        let depth: u32 = cell.edges.iter().map(|edge| edge.level).sum();
        let share = BigRational::new(1.into(), BigInt::from(1) << depth);
        match node {
            AtlasCell::Certified(_) => shares.certified += share,
            AtlasCell::Refuted(_) => shares.refuted += share,
            AtlasCell::Split(_) | AtlasCell::Undecided => {}
        }
    }
    if waiting.is_empty() {
        Ok(shares)
    } else {
        Err(Rejected::MissingNode)
    }
}

/// Checks what is said of one cell.
///
/// # Errors
/// If it is not proved.
pub fn check_cell(
    claim: &AtlasClaim,
    cell: &Cell,
    said: &AtlasCell,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    let instance = |side| claim.cell(cell, side).map_err(Rejected::AtlasClaim);
    match said {
        AtlasCell::Split(_) | AtlasCell::Undecided => Ok(()),
        AtlasCell::Certified(tree) => {
            // No design of the cell has an empty workspace or no machine: what is certified of it
            // says something.
            instance(Side::Loosest)?.validate()?;
            check_tree(&instance(Side::Strictest)?, tree, size)
        }
        AtlasCell::Refuted(witness) => {
            let claim = instance(Side::Loosest)?;
            witness::check_every_machine(&claim, witness).map_err(Rejected::Witness)
        }
    }
}

/// Checks an atlas: every cell whose number `is_wanted`, and the shares that the claim states.
pub(crate) fn check(
    claim: &AtlasClaim,
    atlas: &Atlas,
    is_wanted: impl Fn(usize) -> bool,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    claim.validate().map_err(Rejected::AtlasClaim)?;
    let nodes = atlas.cells.iter().map(|cell| match cell {
        AtlasCell::Certified(tree) => tree.nodes.len(),
        _ => 0,
    });
    let nodes: usize = nodes.sum();
    if nodes > MAX_NODES {
        return Err(Rejected::TooManyNodes(nodes));
    }
    let shares = walk(&atlas.cells, claim.parameters.len(), |number, cell, said| {
        if !is_wanted(number) {
            return Ok(());
        }
        check_cell(claim, cell, said, size)
            .map_err(|reason| Rejected::Cell { cell: number, reason: Box::new(reason) })
    })?;
    let stated = [(&claim.certified, shares.certified), (&claim.refuted, shares.refuted)];
    if stated.iter().any(|(stated, sum)| stated.as_rational() != Some(sum)) {
        return Err(Rejected::Shares);
    }
    Ok(())
}
