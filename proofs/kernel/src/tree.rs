//! Trees: a cell is halved until all is shown of each of its leaves.

use crate::arithmetic::Arithmetic as _;
use crate::cell::Cell;
use crate::certificate::{Evidence, Node, Step, Tree, MOST_NODES, PRECISIONS};
use crate::fixed::{Fixed, Integer, Interval};
use crate::input::{enclosed, malformed, narrowed};
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::step::Checker;
use crate::test::{Over, Place};
use crate::witness::fails_throughout;
use num_bigint::BigInt;

/// What a tree may be a proof of.
pub(crate) trait Theorem {
    /// Says that the tree proves it, in these integers, or why not.
    fn is_proved<Z: Integer>(&self, tree: &Tree) -> Result<(), Rejected>;
}

/// Accepts a proof in machine words, or, where these do not do, in integers of any size: words give what
/// those give, or nothing.
pub(crate) fn check(theorem: &impl Theorem, tree: &Tree) -> Result<(), Rejected> {
    if !PRECISIONS.contains(&tree.precision) {
        return Err(Rejected::Precision(tree.precision));
    }
    if tree.nodes.len() > MOST_NODES {
        return Err(Rejected::Work);
    }
    if tree.precision < 60 && theorem.is_proved::<i64>(tree).is_ok() {
        return Ok(());
    }
    theorem.is_proved::<BigInt>(tree)
}

/// Half of the side of a cube is divided in so many parts, in which offsets are counted.
pub const OFFSET_PARTS: i64 = 8;

/// Checks that on each leaf every obligation is discharged; or, of a claim that no cube fits, that the
/// claim of the machine fails at each leaf's points moved by its offset.
///
/// **Lemma (tree).** If every step shows its obligation on its node's cell, and on the path to each
/// leaf every obligation is discharged, each holds at every point of the root's cell that is in the
/// workspace. *Proof.* The halves of a cell cover it, so the leaves cover the root; what is shown of
/// a cell holds on its parts. ∎ The root's cell holds the workspace's box, rounded outward. Steps by
/// [`Evidence::Chords`] have one matrix, the tree's: what they show of two points is of both with it.
impl Theorem for Problem {
    fn is_proved<Z: Integer>(&self, tree: &Tree) -> Result<(), Rejected> {
        let bits = tree.precision;
        let arithmetic = Fixed::<Z>::new(bits);
        let parameters = self.parameters(bits, &[])?;
        let checker = Checker::new(self, &arithmetic, parameters, self.tight(bits))
            .with_chords(tree.chords.clone());
        let is_evaluated = |node: &&Node| !node.by.is_empty() || node.fails.is_some();
        let steps = tree.nodes.iter().filter(is_evaluated).count();
        let work = steps.saturating_mul(self.work()).saturating_add(checker.work_of(tree));
        if work.saturating_mul(Z::WORK * (1 + bits as usize / 64)) > self.most_work {
            return Err(Rejected::Work);
        }
        let unit = self.offset.as_ref().map(|part| {
            let part = enclosed(part, self.scale, bits).and_then(|part| narrowed::<Z>(&part));
            part.ok_or_else(|| malformed("side", "a number"))
        });
        let (root, unit) = (self.root(bits)?, unit.transpose()?);
        let step = |at: usize, node: &Node, cell: &Cell<Z>, open: &mut [bool]| {
            let edges = cell.edges().ok_or(Rejected::Shape(at))?;
            let slopes = checker.slopes(edges.len());
            if !node.by.is_empty() {
                let place = Place::new(&edges, cell.touches(&root));
                let values = checker.evaluate(&edges);
                let over = Over::new(&place, slopes, &values);
                discharge(at, node, open, |obligation, evidence| match evidence {
                    Evidence::Outside => checker.is_outside(&over),
                    _ => {
                        let test = &self.obligations[obligation].test;
                        checker.shows(&over, test, evidence)
                    }
                })?;
            }
            if let Some(failure) = &node.fails {
                let edges = match &unit {
                    None => Some(edges),
                    Some(unit) => moved(&arithmetic, edges, &node.at, unit),
                };
                let fails = |edges: Vec<_>| {
                    fails_throughout(self, slopes, &checker.evaluate(&edges), failure)
                };
                if !edges.is_some_and(fails) {
                    return Err(Rejected::Holds(at));
                }
            }
            let is_moved = unit.is_some() && node.fails.is_some();
            (is_moved || node.at.is_empty()).then_some(()).ok_or(Rejected::Shape(at))
        };
        let mut nodes = tree.nodes.iter().enumerate();
        bisect(&mut nodes, root.clone(), self.obligations.len(), unit.is_some(), step)?;
        nodes.next().map_or(Ok(()), |(at, _)| Err(Rejected::Shape(at)))
    }
}

/// Discharges what a node's steps show: each one obligation that is open; or, said of the first, all of
/// them on a cell outside the workspace.
pub(crate) fn discharge(
    at: usize,
    node: &Node,
    open: &mut [bool],
    shows: impl Fn(usize, &Evidence) -> bool,
) -> Result<(), Rejected> {
    for Step(obligation, evidence) in &node.by {
        let (node, obligation) = (at, *obligation);
        let is_outside = *evidence == Evidence::Outside;
        match open.get_mut(obligation) {
            _ if is_outside => open.fill(false),
            Some(is_open) if *is_open => *is_open = false,
            _ => return Err(Rejected::Repeated(node, obligation)),
        }
        if is_outside && obligation != 0 || !shows(obligation, evidence) {
            return Err(Rejected::Step(node, obligation));
        }
    }
    Ok(())
}

/// The tree of `nodes` over a cell, in preorder: `step` discharges obligations, or shows that a leaf
/// fails. Every leaf has to fail, or every one to have all obligations discharged.
pub(crate) fn bisect<'a, Z: Integer>(
    nodes: &mut impl Iterator<Item = (usize, &'a Node)>,
    root: Cell<Z>,
    obligations: usize,
    fails: bool,
    step: impl Fn(usize, &Node, &Cell<Z>, &mut [bool]) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    let mut waiting = vec![(root, vec![true; obligations])];
    let mut last = 0;
    while let Some((cell, mut open)) = waiting.pop() {
        let (at, node) = nodes.next().ok_or(Rejected::Shape(last + 1))?;
        last = at;
        step(at, node, &cell, &mut open)?;
        match (node.split, &node.fails, open.iter().position(|&open| open)) {
            (Some(_), Some(_), _) => return Err(Rejected::Shape(at)),
            (Some(k), None, _) => {
                let [lower, upper] = cell.halves(k).ok_or(Rejected::Shape(at))?;
                waiting.push((upper, open.clone()));
                waiting.push((lower, open));
            }
            (None, None, _) if fails => return Err(Rejected::Holds(at)),
            (None, Some(_), _) if !fails => return Err(Rejected::Open(at, 0)),
            (None, None, Some(obligation)) => return Err(Rejected::Open(at, obligation)),
            (None, ..) => {}
        }
    }
    Ok(())
}

/// A cell's edges moved by an offset in parts of half the side: for each value of the part, every
/// point `c + lambda h` of the cell is moved to `(c + o) + lambda h`.
fn moved<Z: Integer>(
    arithmetic: &Fixed<Z>,
    edges: Vec<[Interval<Z>; 3]>,
    offset: &[i64],
    part: &Interval<Z>,
) -> Option<Vec<[Interval<Z>; 3]>> {
    let within = offset.iter().all(|n| (-OFFSET_PARTS..=OFFSET_PARTS).contains(n));
    let edge = |([centre, range, half], &n): ([Interval<Z>; 3], &i64)| {
        let by = arithmetic.mul(&arithmetic.integer(n)?, part)?;
        Some([arithmetic.add(&centre, &by)?, arithmetic.add(&range, &by)?, half])
    };
    let shape = within && offset.len() == edges.len();
    shape.then(|| edges.into_iter().zip(offset).map(edge).collect())?
}
