//! What a certificate has to be to be accepted.

use crate::arithmetic::{Arithmetic as _, Enclosure};
use crate::atlas;
use crate::cell::{evaluate, Cell, Vertex};
use crate::certificate::{
    Certificate, Claim, Corner, Evidence, Node, Proof, Step, Tree, Verdict, PRECISIONS,
};
use crate::claim::{MachineClaim, RegionClaim};
use crate::definite::is_positive_definite;
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::Formula;
use crate::formula::Values;
use crate::input::{shape_error, ClaimError};
use crate::no_cube;
use crate::number::Expression;
use crate::postulate;
use crate::problem::{Inside, Problem};
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::{at_least, sigma_max, sigma_min, Multiplier, Over, Row, MOST_PLACES};
use crate::witness::{self, fails_throughout, WitnessError};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::fmt;

/// Most nodes of a tree.
pub const MOST_NODES: usize = 500_000;
/// Most evaluations of a formula, each counted once for every 64 bits of the precision: a bound on
/// time, whatever the file.
pub const MOST_WORK: usize = 1 << 28;

/// Why a certificate is not accepted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rejected {
    /// The claim is not well formed.
    Claim(ClaimError),
    /// The verdict and the proof do not go together.
    Verdict,
    /// The precision is not admissible.
    Precision(u32),
    /// The tree has too many nodes, too few, or cannot be split as it says.
    Shape(usize),
    /// The tree has more nodes, or asks for more work, than is admissible.
    Work,
    /// A step does not show what it says.
    Step {
        /// The node, counted from zero.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// An obligation that is discharged already, or that there is not.
    Repeated {
        /// The node.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// A leaf on which an obligation is not discharged.
    Open {
        /// The node.
        node: usize,
        /// The obligation.
        obligation: usize,
    },
    /// A leaf on which the claim does not certainly fail as it says.
    Holds(usize),
    /// The leaves do not have the shares that are claimed.
    Shares,
    /// Of an atlas, a cell, counted from zero, and why it is not as it says.
    Cell(usize, Box<Rejected>),
    /// The witness shows nothing.
    Witness(WitnessError),
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::Claim(e) => write!(f, "the claim is not well formed: {e}"),
            Rejected::Verdict => write!(f, "verdict and proof do not go together"),
            Rejected::Precision(bits) => write!(f, "a precision of {bits} bits is not admissible"),
            Rejected::Shape(node) => write!(f, "node {node}: the tree is not complete there"),
            Rejected::Work => write!(f, "the proof is longer than is admissible"),
            Rejected::Step { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not certainly met on the cell")
            }
            Rejected::Repeated { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not open")
            }
            Rejected::Open { node, obligation } => {
                write!(f, "node {node}: obligation {obligation} is not discharged")
            }
            Rejected::Holds(node) => {
                write!(f, "node {node}: it does not certainly fail throughout")
            }
            Rejected::Shares => write!(f, "the leaves do not have the shares that are claimed"),
            Rejected::Cell(cell, why) => write!(f, "cell {cell}: {why}"),
            Rejected::Witness(e) => write!(f, "the witness shows nothing: {e}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// Accepts a certificate, or says why not.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<(), Rejected> {
    let compiled = |claim: &MachineClaim| Problem::new(claim).map_err(Rejected::Claim);
    match (&certificate.claim, certificate.verdict, &certificate.proof) {
        (Claim::Machine(claim), Verdict::Certified, Proof::Tree(tree)) => {
            let problem = compiled(claim)?;
            in_words_or_any_size(
                tree.precision,
                || tree_holds::<i64>(&problem, tree),
                || tree_holds::<BigInt>(&problem, tree),
            )
        }
        (Claim::Region(region), Verdict::Certified, Proof::Tree(tree)) => {
            let problem = compiled(&region.machine)?;
            in_words_or_any_size(
                tree.precision,
                || region_holds::<i64>(&problem, region, tree),
                || region_holds::<BigInt>(&problem, region, tree),
            )
        }
        (Claim::NoCube(claim), Verdict::Certified, Proof::Tree(tree)) => {
            let problem = compiled(&claim.machine)?;
            in_words_or_any_size(
                tree.precision,
                || no_cube::holds::<i64>(&problem, claim, tree),
                || no_cube::holds::<BigInt>(&problem, claim, tree),
            )
        }
        (Claim::Postulate(claim), Verdict::Certified, Proof::Tree(tree)) => {
            postulate::check(claim, tree)
        }
        (Claim::Atlas(claim), Verdict::Certified, Proof::Atlas(cells)) => {
            let bytes = certificate.to_text().map_or(0, |text| text.len());
            atlas::check(claim, cells, bytes)
        }
        (Claim::Machine(claim), Verdict::Refuted, Proof::Witness(witness)) => {
            witness::check(&compiled(claim)?, &claim.workspace, witness).map_err(Rejected::Witness)
        }
        _ => Err(Rejected::Verdict),
    }
}

/// A proof in machine words, or, where these do not do, in integers of any size: words give what
/// those give, or nothing.
pub(crate) fn in_words_or_any_size(
    bits: u32,
    words: impl Fn() -> Result<(), Rejected>,
    any_size: impl Fn() -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    if !PRECISIONS.contains(&bits) {
        return Err(Rejected::Precision(bits));
    }
    if bits < 60 && words().is_ok() {
        return Ok(());
    }
    any_size()
}

/// What is shown of a leaf's cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaf {
    /// The claim holds at each of its points.
    Holds,
    /// It fails at each of them.
    Fails,
    /// Neither: this obligation is not discharged.
    Open(usize),
}

/// Every leaf of a tree holds: so does the claim, by the lemma of [`walk`].
pub(crate) fn tree_holds<Z: Integer>(problem: &Problem, tree: &Tree) -> Result<(), Rejected> {
    walk::<Z>(problem, tree, None, |node, leaf, _| match leaf {
        Leaf::Holds => Ok(()),
        Leaf::Open(obligation) => Err(Rejected::Open { node, obligation }),
        Leaf::Fails => Err(Rejected::Open { node, obligation: 0 }),
    })
}

/// Whether the workspace is a box.
pub(crate) fn is_box(problem: &Problem) -> bool {
    problem.inside.is_none() && problem.cube_kappa.is_none()
}

/// **Lemma (region).** Let the least and greatest corners of the root, by a unit each, be moved
/// inward: what is left of the root is within the box, and the box within the root. So the share of
/// the box in cells that hold is at least the volume of what is left of these over that of the root;
/// so is the share of those that fail. *Proof.* Corners are rounded outward by less than a unit, and
/// cells overlap in faces only. ∎
fn region_holds<Z: Integer>(
    problem: &Problem,
    region: &RegionClaim,
    tree: &Tree,
) -> Result<(), Rejected> {
    let root: Cell<BigInt> = problem.root(tree.precision).map_err(Rejected::Claim)?;
    let whole = root.0.iter().map(|edge| &edge.hi - &edge.lo).product::<BigInt>();
    if !is_box(problem) || !whole.is_positive() {
        return Err(Rejected::Claim(shape_error("workspace", "a box that has a volume")));
    }
    let mut found = [BigInt::zero(), BigInt::zero()];
    walk::<Z>(problem, tree, None, |_, leaf, cell| {
        let left = |(edge, root): (&Interval<Z>, &Interval<BigInt>)| {
            let (lo, hi) = (edge.lo.to_big().max(&root.lo + 1), edge.hi.to_big().min(&root.hi - 1));
            (hi - lo).max(BigInt::zero())
        };
        let which = match leaf {
            Leaf::Holds => 0,
            Leaf::Fails => 1,
            Leaf::Open(_) => return Ok(()),
        };
        found[which] += cell.0.iter().zip(&root.0).map(left).product::<BigInt>();
        Ok(())
    })?;
    let whole = BigRational::from(whole);
    let reaches = |share: &Expression, found: BigInt| {
        let share = share.rational().filter(|share| !share.is_negative());
        share.is_some_and(|share| share * &whole <= BigRational::from(found))
    };
    let [inner, outer] = found;
    if reaches(&region.inner, inner) && reaches(&region.outer, outer) {
        Ok(())
    } else {
        Err(Rejected::Shares)
    }
}

/// Walks a tree, and says of each leaf what is shown of its cell.
///
/// **Lemma (tree).** If every step shows its obligation on its node's cell, and on the path to each
/// leaf every obligation is discharged, each holds at every point of the root's cell that is in the
/// workspace. *Proof.* The halves of a cell cover it, so the leaves cover the root; what is shown of
/// a cell holds on its parts. ∎ The root's cell holds the workspace's box, rounded outward.
///
/// With a unit of offsets, a leaf that fails does so at the points of its cell moved by its offset.
pub(crate) fn walk<Z: Integer>(
    problem: &Problem,
    tree: &Tree,
    unit: Option<&Interval<Z>>,
    mut at_leaf: impl FnMut(usize, Leaf, &Cell<Z>) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    let bits = tree.precision;
    let is_evaluated = |node: &&Node| !node.by.is_empty() || node.fails.is_some();
    let steps = tree.nodes.iter().filter(is_evaluated).count();
    let each = problem.tape.ops().len() * (1 + bits as usize / 64);
    if tree.nodes.len() > MOST_NODES || steps.saturating_mul(each) > MOST_WORK {
        return Err(Rejected::Work);
    }
    let arithmetic = Fixed::<Z>::new(bits);
    let parameters = problem.parameters(bits, &[]).map_err(Rejected::Claim)?;
    let checker = Checker::new(problem, &arithmetic, parameters, problem.tight(bits));
    let root = problem.root(bits).map_err(Rejected::Claim)?;
    let step = |at: usize, node: &Node, cell: &Cell<Z>, open: &mut [bool]| {
        let edges = cell.edges().ok_or(Rejected::Shape(at))?;
        if !node.by.is_empty() {
            let place = Place { edges: &edges, touches: cell.touches(&root) };
            checker.discharge(&place, (at, node), open)?;
        }
        if let Some(failure) = &node.fails {
            let edges = match unit {
                None => edges,
                Some(unit) => {
                    no_cube::moved(&arithmetic, edges, &node.at, unit).ok_or(Rejected::Holds(at))?
                }
            };
            let slopes = Slopes { arithmetic: &arithmetic, m: edges.len() };
            if !fails_throughout(problem, slopes, checker.evaluate(&edges), failure) {
                return Err(Rejected::Holds(at));
            }
        }
        let is_moved = unit.is_some() && node.fails.is_some();
        (is_moved || node.at.is_empty()).then_some(()).ok_or(Rejected::Shape(at))
    };
    let mut nodes = tree.nodes.iter().enumerate();
    bisected(&mut nodes, root.clone(), problem.obligations.len(), step, &mut at_leaf)?;
    nodes.next().map_or(Ok(()), |(at, _)| Err(Rejected::Shape(at)))
}

/// The tree of `nodes` over a cell, in preorder: `step` discharges obligations, or shows that a leaf
/// fails.
pub(crate) fn bisected<'a, Z: Integer>(
    nodes: &mut impl Iterator<Item = (usize, &'a Node)>,
    root: Cell<Z>,
    obligations: usize,
    step: impl Fn(usize, &Node, &Cell<Z>, &mut [bool]) -> Result<(), Rejected>,
    at_leaf: &mut impl FnMut(usize, Leaf, &Cell<Z>) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    let mut waiting = vec![(root, vec![true; obligations])];
    let mut last = 0;
    while let Some((cell, mut open)) = waiting.pop() {
        let (at, node) = nodes.next().ok_or(Rejected::Shape(last + 1))?;
        last = at;
        if node.split.is_some() && node.fails.is_some() {
            return Err(Rejected::Shape(at));
        }
        step(at, node, &cell, &mut open)?;
        match (node.split, &node.fails, open.iter().position(|&open| open)) {
            (Some(k), _, _) => {
                let [lower, upper] = cell.halves(k).ok_or(Rejected::Shape(at))?;
                waiting.push((upper, open.clone()));
                waiting.push((lower, open));
            }
            (None, Some(_), _) => at_leaf(at, Leaf::Fails, &cell)?,
            (None, None, Some(obligation)) => at_leaf(at, Leaf::Open(obligation), &cell)?,
            (None, None, None) => at_leaf(at, Leaf::Holds, &cell)?,
        }
    }
    Ok(())
}

/// Checks steps; in another arithmetic than [`Fixed`], proposes them.
pub struct Checker<'a, E: Enclosure> {
    problem: &'a Problem,
    arithmetic: &'a E,
    parameters: Vec<E::Number>,
    /// `q_1` and `q_2` of the paper's cube.
    tight: Option<[E::Number; 2]>,
    rows: Vec<Row<Formula>>,
    divided: Vec<Row<Formula>>,
}

/// Where a step is made.
pub struct Place<'a, N> {
    /// For each coordinate the cell's centre, range and half-width.
    pub edges: &'a [[N; 3]],
    /// Whether the cell touches the root's least, and its greatest corner.
    pub touches: [bool; 2],
}

impl<'a, E: Enclosure> Checker<'a, E> {
    /// For the steps of a problem, given its parameters and the coordinates of its tight corners.
    pub fn new(
        problem: &'a Problem,
        arithmetic: &'a E,
        parameters: Vec<E::Number>,
        tight: Option<[E::Number; 2]>,
    ) -> Self {
        let rows = problem.legs.iter().map(|leg| leg.row.clone()).collect();
        let divided = problem.legs.iter().map(|leg| leg.divided.clone()).collect();
        Checker { problem, arithmetic, parameters, tight, rows, divided }
    }

    /// The formulas over a cell.
    pub fn evaluate(&self, edges: &[[E::Number; 3]]) -> Values<Slope<E::Number>> {
        let slopes = Slopes { arithmetic: self.arithmetic, m: edges.len() };
        evaluate(&self.problem.tape, &self.parameters, slopes, edges)
    }

    fn discharge(
        &self,
        place: &Place<'_, E::Number>,
        (at, node): (usize, &Node),
        open: &mut [bool],
    ) -> Result<(), Rejected> {
        let values = self.evaluate(place.edges);
        let slopes = Slopes { arithmetic: self.arithmetic, m: place.edges.len() };
        let over = Over { slopes, values: &values, inside: None };
        for Step(obligation, evidence) in &node.by {
            let (node, obligation) = (at, *obligation);
            if *evidence == Evidence::Outside {
                if obligation != 0 || !self.is_outside(&over, place) {
                    return Err(Rejected::Step { node, obligation });
                }
                open.fill(false);
                continue;
            }
            match open.get_mut(obligation) {
                Some(is_open) if *is_open => *is_open = false,
                _ => return Err(Rejected::Repeated { node, obligation }),
            }
            let test = self.problem.obligations[obligation].test;
            if !self.shows(&over, place, test, evidence) {
                return Err(Rejected::Step { node, obligation });
            }
        }
        Ok(())
    }

    /// Whether the evidence shows that a test holds on a cell.
    pub fn shows(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        test: Test,
        evidence: &Evidence,
    ) -> bool {
        let constant = |f: Formula| move |_| over.of(f).map(|f| f.range.clone());
        match (test, evidence) {
            (test, Evidence::Inside(evidence, multiple, places)) => {
                let plain = !matches!(**evidence, Evidence::Inside(..) | Evidence::Corner(_));
                let inside = self.tangent(over, place, (*multiple, *places));
                plain
                    && inside.is_some_and(|inside| {
                        let over = Over { inside: Some(inside), ..*over };
                        self.shows(&over, place, test, evidence)
                    })
            }
            (Test::SigmaMin(kappa), Evidence::Lower(y)) => {
                self.is_defined(over) && sigma_min(over, &self.rows, &constant(kappa), y)
            }
            (Test::SigmaMin(kappa), Evidence::LowerDivided(y)) => {
                self.is_defined(over) && sigma_min(over, &self.divided, &constant(kappa), y)
            }
            (Test::SigmaMin(_), Evidence::Corner(corner)) => self.corner(place, *corner).is_some(),
            (Test::SigmaMax(k), Evidence::Test) => sigma_max(over, &self.rows, &constant(k)),
            (Test::SigmaMax(k), Evidence::Divided) => sigma_max(over, &self.divided, &constant(k)),
            (Test::SigmaMax(_), Evidence::Cube) => self.problem.cube_has_least,
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                self.conditioning(over, c, (y, mu))
            }
            (Test::AtLeast(f), Evidence::Test) => over.of(f).is_some_and(|f| at_least(over, f)),
            (Test::Beyond(f, b), Evidence::Test | Evidence::Negative) => {
                let rest = || {
                    let (f, b) = (over.of(f)?, over.of(b)?);
                    match evidence {
                        Evidence::Negative => over.slopes.neg(&over.slopes.add(f, b)?),
                        _ => over.slopes.sub(f, b),
                    }
                };
                rest().is_some_and(|rest| at_least(over, &rest))
            }
            _ => false,
        }
    }

    /// Whether a user's formulas are defined on all of the cell, used or not.
    fn is_defined(&self, over: &Over<'_, E>) -> bool {
        self.problem.partial.iter().all(|&f| over.of(f).is_some())
    }

    /// **Conditioning.** `mu_v = mu_0 + sum_k v_k mu_k > 0` at the vertices, and with it both bounds:
    /// `sigma_min^2 >= mu`, `sigma_max^2 <= c^2 mu` for the same convex combination `mu` of the `mu_v`.
    fn conditioning(
        &self,
        over: &Over<'_, E>,
        c_squared: Formula,
        (y, mu): (&Multiplier, &[i64]),
    ) -> bool {
        let Some((first, rest)) = mu.split_first().filter(|(_, rest)| rest.len() == over.slopes.m)
        else {
            return false;
        };
        let mu = |v: Vertex| {
            let mut terms = rest.iter().enumerate();
            let n = terms.try_fold(*first, |sum, (k, &mu)| {
                sum.checked_add(if v.has(k) { mu } else { mu.checked_neg()? })
            });
            self.arithmetic.dyadic(n.filter(|&n| n > 0)?, y.places, &self.arithmetic.integer(1)?)
        };
        let greatest = |v| self.arithmetic.mul(&over.of(c_squared)?.range, &mu(v)?);
        y.places < MOST_PLACES
            && sigma_min(over, &self.rows, &mu, y)
            && sigma_max(over, &self.rows, &greatest)
    }

    /// `mu t` for the tangent `t` of the workspace's own inequality at the cell's centre.
    ///
    /// **Lemma.** `g` is concave, so `g <= t`, and `t >= 0` at the cell's points in the workspace.
    /// (Taking `g` at the vertices instead of `t` would be unsound: a convex combination of these is
    /// below `g`. `f = -0.1` "holds" then on `|x| <= 0.7` in the cell `[-1, 1]` with `g = 1/2 - x^2`.)
    fn tangent(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        (multiple, places): (i64, u32),
    ) -> Option<Slope<E::Number>> {
        if multiple < 0 || places >= MOST_PLACES {
            return None;
        }
        let Inside { g, gradient } = self.problem.inside.as_ref()?;
        let e = self.arithmetic;
        let mut tangent = over.slopes.constant(over.of(*g)?.at_centre.clone())?;
        for ((slope, &f), [_, _, half]) in tangent.slopes.iter_mut().zip(gradient).zip(place.edges)
        {
            *slope = e.dyadic(multiple, places, &e.mul(&over.of(f)?.at_centre, half)?)?;
        }
        tangent.at_centre = e.dyadic(multiple, places, &tangent.at_centre)?;
        Some(tangent)
    }

    /// Whether the cell has no point of the workspace: the tangent is negative at all vertices.
    pub fn is_outside(&self, over: &Over<'_, E>, place: &Place<'_, E::Number>) -> bool {
        self.tangent(over, place, (1, 0)).is_some_and(|tangent| {
            Vertex::all(over.slopes.m).all(|v| {
                let t = v.value(&over.slopes, &tangent).and_then(|t| self.arithmetic.neg(&t));
                t.is_some_and(|t| self.arithmetic.is_positive(&t))
            })
        })
    }

    /// **Tight corner.** The cell touches the corner `Q` of the paper's cube. With `x = Q + lambda H`,
    /// `lambda` in `[0, 1]^3`: if `sym(M_v) - kappa I` is positive definite at the vertices `v` other
    /// than `Q`, then `sigma_min(M) >= kappa` at the cell's points in the cube.
    ///
    /// *Proof.* At `Q` itself, with `m = M_12(Q)` and `V = [(1,1,1), (1,-1,0), (1,1,-2)]` as columns,
    ///
    /// ```text
    /// T(Q) = sym(M(Q)) - kappa I = (1 - m - kappa) I + m 11^T
    /// V^T T(Q) V = diag(3 (1 + 2m - kappa), 2 (1 - m - kappa), 6 (1 - m - kappa))
    /// Q_1, m = -(1 - kappa)/2:   1 + 2m - kappa = 0            1 - m - kappa = 3 (1 - kappa)/2
    /// Q_2, m = t_2, kappa <= 1/2: 1 + 2m - kappa = 3 (1-kappa)  1 - m - kappa = 0
    ///      kappa >= 1/2:         1 + 2m - kappa = 1/kappa - kappa
    ///                            1 - m - kappa = (1 - kappa)(2 kappa - 1)/(2 kappa)
    /// ```
    ///
    /// none of them negative for `0 < kappa < 1`, which the claim's well-formedness says. A convex
    /// combination of `T(Q)` with positive definite matrices is positive semidefinite, and for a unit
    /// vector `v`, `kappa <= v . M v <= |M v|`. ∎ The true corner is an enclosure here, one unit wide;
    /// a cell that does not reach it has no point in the cube.
    fn corner(&self, place: &Place<'_, E::Number>, corner: Corner) -> Option<()> {
        let e = self.arithmetic;
        let (kappa, [q1, q2]) = (self.problem.cube_kappa?, self.tight.as_ref()?);
        let (touches, q) = match corner {
            Corner::Q1 => (place.touches[0], q1),
            Corner::Q2 => (place.touches[1], q2),
        };
        let edge = |[_, range, _]: &[E::Number; 3]| {
            let [low, high] = e.ends(range);
            let end = if corner == Corner::Q1 { high } else { low };
            Some([q.clone(), range.clone(), e.sub(&end, q)?])
        };
        let edges: Vec<_> = place.edges.iter().map(edge).collect::<Option<_>>()?;
        if !touches {
            return None;
        }
        let slopes = Slopes { arithmetic: e, m: edges.len() };
        let values = self.evaluate(&edges);
        let kappa = &values.of(kappa)?.range;
        let definite = |v: Vertex| {
            let entry = |i: usize, j: usize| {
                let at = |i: usize, j: usize| {
                    let f = *self.divided.get(i)?.a.get(j)?;
                    v.value_about_corner(&slopes, values.of(f)?)
                };
                let sum = e.add(&at(i, j)?, &at(j, i)?)?;
                if i == j {
                    e.sub(&sum, &e.add(kappa, kappa)?)
                } else {
                    Some(sum)
                }
            };
            let row = |i: usize| (i..3).map(|j| entry(i, j)).collect();
            (0..3).map(row).collect::<Option<_>>().is_some_and(|t| is_positive_definite(e, t))
        };
        Vertex::all(3).skip(1).all(definite).then_some(())
    }
}
