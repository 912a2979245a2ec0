//! Trees: a cell is halved until all is shown of each of its leaves.

use crate::arithmetic::Arithmetic as _;
use crate::cell::Cell;
use crate::certificate::{Evidence, Node, Step, Tree, MOST_NODES, PRECISIONS};
use crate::fixed::{Fixed, Integer, Interval};
use crate::input::{enclosed, malformed, narrowed};
use crate::problem::Problem;
use crate::quantity::Test;
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

/// As the work of so many nodes counts the halving of a range: formulas without coordinates are evaluated again of both
/// halves, and of what follows.
const WORK_OF_HALVES: usize = 8;

/// Half of the side of a cube is divided in so many parts, in which offsets are counted.
pub const OFFSET_PARTS: i64 = 8;

/// Checks that on each leaf every obligation is discharged; or, of a claim that no cube fits, that the
/// claim of the machine fails at each leaf's points moved by its offset.
///
/// **Lemma (tree).** If every step shows its obligation on its node's cell, and on the path to each
/// leaf every obligation is discharged, each holds at every point of the root's cell that is in the
/// workspace, for every machine. *Proof.* A node is about the points of its cell and the machines whose numbers with two
/// ends are in its ranges. The halves of a cell, or of a range, cover it, so every point with every machine is
/// in a leaf; what is shown of a node holds in its halves. ∎ The root's cell holds the workspace's box, rounded
/// outward, and its ranges hold the tolerances. Steps by [`Evidence::Chords`] have one matrix, the tree's: what they show
/// of two points is of both with it, and with one machine, that of both.
///
/// An accuracy is shown for the whole tolerance alone: between a machine and the one in the middle of it, of which the
/// joint errors are, lie machines of other halves. By its derivative over `[7/8, 1]`, `(theta - 1)^2` would change by at most
/// `1/8` from `1/2` to 1, and does by `1/4`.
impl Theorem for Problem {
    fn is_proved<Z: Integer>(&self, tree: &Tree) -> Result<(), Rejected> {
        let bits = tree.precision;
        let arithmetic = Fixed::<Z>::new(bits);
        let parameters = self.parameters(bits, &[])?;
        let with_ends = parameters.iter().zip(&self.inputs).filter(|(_, x)| x.has_two_ends());
        let whole: Vec<Interval<Z>> = with_ends.map(|(range, _)| range.clone()).collect();
        let mut checker = Checker::new(self, &arithmetic, parameters, self.tight(bits))
            .with_chords(tree.chords.clone());
        let is_evaluated = |node: &&Node| !node.by.is_empty() || node.fails.is_some();
        let halves_a_range = |node: &&Node| node.split.is_some_and(|k| k >= self.dimension());
        let halves = tree.nodes.iter().filter(halves_a_range).count();
        let steps = tree.nodes.iter().filter(is_evaluated).count() + WORK_OF_HALVES * halves;
        let [work, changes] = checker.work_of(tree);
        let work = steps.saturating_mul(self.work()).saturating_add(work).saturating_mul(Z::WORK);
        let all = work.saturating_add(changes.saturating_mul(Z::CHANGE));
        if all.saturating_mul(1 + bits as usize / 64) > self.most_work {
            return Err(Rejected::Work);
        }
        let unit = self.offset.as_ref().map(|part| {
            let part = enclosed(part, self.scale, bits).and_then(|part| narrowed::<Z>(&part));
            part.ok_or_else(|| malformed("side", "a number"))
        });
        let (root, unit) = (self.root(bits)?, unit.transpose()?);
        let mut is_whole = true;
        let step = |at: usize, node: &Node, (cell, machines): Of<'_, Z>, open: &mut [bool]| {
            if let Some(ranges) = machines {
                is_whole = *ranges == whole;
                checker.narrow(ranges);
            }
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
                        (is_whole || !matches!(test, Test::Accuracy(_)))
                            && checker.shows(&over, test, evidence)
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
        bisect(&mut nodes, (&root, &whole), self.obligations.len(), unit.is_some(), step)?;
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

/// A node's cell, and the ranges of numbers with two ends, if they are not those of the node before.
pub(crate) type Of<'a, Z> = (&'a Cell<Z>, Option<&'a [Interval<Z>]>);

/// The tree of `nodes` over a cell, in preorder: `step` discharges obligations, or shows that a leaf
/// fails. Every leaf has to fail, or every one to have all obligations discharged. After the cell's coordinates
/// those halved are the ranges.
pub(crate) fn bisect<'a, Z: Integer>(
    nodes: &mut impl Iterator<Item = (usize, &'a Node)>,
    (root, ranges): (&Cell<Z>, &[Interval<Z>]),
    obligations: usize,
    fails: bool,
    mut step: impl FnMut(usize, &Node, Of<'_, Z>, &mut [bool]) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    let (m, mut all) = (root.0.len(), [&root.0, ranges].concat());
    // What a range is from then on, and what is open at the node that comes next, if one does.
    let mut waiting = vec![(None, Some(vec![true; obligations]))];
    let (mut last, mut are_others) = (0, false);
    while let Some((halved, open)) = waiting.pop() {
        if let Some((k, range)) = halved {
            (all[k], are_others) = (range, are_others || k >= m);
        }
        let Some(mut open) = open else { continue };
        let (at, node) = nodes.next().ok_or(Rejected::Shape(last + 1))?;
        last = at;
        let cell = Cell(all[..m].to_vec());
        step(at, node, (&cell, are_others.then_some(&all[m..])), &mut open)?;
        are_others = false;
        match (node.split, &node.fails, open.iter().position(|&open| open)) {
            (Some(_), Some(_), _) => return Err(Rejected::Shape(at)),
            (Some(k), None, _) => {
                let own = all.get(k).cloned().ok_or(Rejected::Shape(at))?;
                let [lower, upper] = own.halves().ok_or(Rejected::Shape(at))?;
                waiting.push((Some((k, own)), None));
                waiting.push((Some((k, upper)), Some(open.clone())));
                waiting.push((Some((k, lower)), Some(open)));
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
