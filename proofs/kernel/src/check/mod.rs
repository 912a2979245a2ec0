//! What a certificate has to be to be accepted.

mod corner;
mod inside;
mod own;
mod tolerances;
mod work;

use crate::arithmetic::{Arithmetic as _, Enclosure};
use crate::atlas;
use crate::cell::{Cell, Vertex};
use crate::certificate::{
    Certificate, Claim, Evidence, Node, Proof, Step, Tree, Verdict, PRECISIONS,
};
use crate::claim::MachineClaim;
use crate::control::Control;
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{Formula, Op, Values};
use crate::input::ClaimError;
use crate::no_cube::{self, NoCubeClaim};
use crate::postulate::{self, PostulateClaim};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::accuracy::{accuracy, near, Accuracy};
use crate::test::apart::apart;
use crate::test::curvature::curvature;
use crate::test::solve::solve;
use crate::test::{
    at_least, at_least_there, full_rank, sigma_max, sigma_min, Multiplier, Over, Row, MOST_PLACES,
};
use crate::witness::{self, fails_throughout, WitnessError};
use num_bigint::BigInt;
use std::fmt;
use tolerances::{are_for, is_of_vertices};

pub use tolerances::Place;

/// Most nodes of a tree.
pub const MOST_NODES: usize = 500_000;
/// Most work of all steps, each counted once for every 64 bits of the precision, and as that of the
/// integers it is in: a bound on time, whatever the file.
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
    /// The shares of an atlas are not those of its cells.
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
            Rejected::Shares => write!(f, "the cells do not have the shares that are claimed"),
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
    match (&certificate.claim, certificate.verdict, &certificate.proof) {
        (Claim::Machine(claim), verdict, proof) => check_machine(claim, verdict, proof),
        (Claim::NoCube(claim), verdict, proof) => check_no_cube(claim, verdict, proof),
        (Claim::Postulate(claim), verdict, proof) => check_postulate(claim, verdict, proof),
        (Claim::Atlas(claim), Verdict::Certified, Proof::Atlas(cells)) => {
            atlas::check_part(claim, cells, |_| true)
        }
        _ => Err(Rejected::Verdict),
    }
}

/// Accepts the proof of a claim about a machine, or says why not.
///
/// # Errors
/// As [`check`].
pub fn check_machine(
    claim: &MachineClaim,
    verdict: Verdict,
    proof: &Proof,
) -> Result<(), Rejected> {
    match (verdict, proof) {
        (Verdict::Certified, Proof::Tree(tree)) => {
            let problem = compiled(claim)?;
            let problem =
                if tree.takes_tolerances_apart() { problem.with_derivatives() } else { problem };
            in_words_or_any_size(
                tree.precision,
                || tree_holds::<i64>(&problem, tree),
                || tree_holds::<BigInt>(&problem, tree),
            )
        }
        (Verdict::Refuted, Proof::Witness(witness)) => {
            witness::check(&compiled(claim)?, &claim.workspace, witness).map_err(Rejected::Witness)
        }
        _ => Err(Rejected::Verdict),
    }
}

/// Accepts the proof of a claim that no cube fits, or says why not.
///
/// # Errors
/// As [`check`].
pub fn check_no_cube(claim: &NoCubeClaim, verdict: Verdict, proof: &Proof) -> Result<(), Rejected> {
    let (Verdict::Certified, Proof::Tree(tree)) = (verdict, proof) else {
        return Err(Rejected::Verdict);
    };
    let problem = compiled(&claim.machine)?;
    in_words_or_any_size(
        tree.precision,
        || no_cube::holds::<i64>(&problem, claim, tree),
        || no_cube::holds::<BigInt>(&problem, claim, tree),
    )
}

/// Accepts a proof of the postulate, or says why not.
///
/// # Errors
/// As [`check`].
pub fn check_postulate(
    claim: &PostulateClaim,
    verdict: Verdict,
    proof: &Proof,
) -> Result<(), Rejected> {
    let (Verdict::Certified, Proof::Tree(tree)) = (verdict, proof) else {
        return Err(Rejected::Verdict);
    };
    let parts = postulate::parts(claim).map_err(Rejected::Claim)?;
    in_words_or_any_size(
        tree.precision,
        || postulate::holds::<i64>(&parts, tree),
        || postulate::holds::<BigInt>(&parts, tree),
    )
}

fn compiled(claim: &MachineClaim) -> Result<Problem, Rejected> {
    Problem::new(claim).map_err(Rejected::Claim)
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
    problem.inside.is_none() && problem.cube_kappa.is_none() && problem.turned.is_none()
}

/// Walks a tree, and says of each leaf what is shown of its cell.
///
/// **Lemma (tree).** If every step shows its obligation on its node's cell, and on the path to each
/// leaf every obligation is discharged, each holds at every point of the root's cell that is in the
/// workspace. *Proof.* The halves of a cell cover it, so the leaves cover the root; what is shown of
/// a cell holds on its parts. ∎ The root's cell holds the workspace's box, rounded outward. Steps by
/// [`Evidence::Chords`] have one matrix, the tree's: what they show of two points is of both with it.
///
/// With a unit of offsets, a leaf that fails does so at the points of its cell moved by its offset.
pub(crate) fn walk<Z: Integer>(
    problem: &Problem,
    tree: &Tree,
    unit: Option<&Interval<Z>>,
    mut at_leaf: impl FnMut(usize, Leaf, &Cell<Z>) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    let bits = tree.precision;
    let arithmetic = Fixed::<Z>::new(bits);
    let parameters = problem.parameters(bits, &[]).map_err(Rejected::Claim)?;
    let checker = Checker::new(problem, &arithmetic, parameters, problem.tight(bits))
        .with_chords(tree.chords.clone())
        .with_varying(problem.varying(bits));
    let is_evaluated = |node: &&Node| !node.by.is_empty() || node.fails.is_some();
    let steps = tree.nodes.iter().filter(is_evaluated).count();
    let work = steps.saturating_mul(problem.work()).saturating_add(checker.work_of(tree));
    let work = work.saturating_mul(Z::WORK * (1 + bits as usize / 64));
    if tree.nodes.len() > MOST_NODES || work > MOST_WORK {
        return Err(Rejected::Work);
    }
    let root = problem.root(bits).map_err(Rejected::Claim)?;
    let step = |at: usize, node: &Node, cell: &Cell<Z>, open: &mut [bool]| {
        let edges = cell.edges().ok_or(Rejected::Shape(at))?;
        if !node.by.is_empty() {
            let place = Place::new(&edges, cell.touches(&root));
            checker.discharge(&place, (at, node), open)?;
        }
        if let Some(failure) = &node.fails {
            let edges = match unit {
                None => edges,
                Some(unit) => {
                    no_cube::moved(&arithmetic, edges, &node.at, unit).ok_or(Rejected::Holds(at))?
                }
            };
            let slopes = checker.slopes(edges.len());
            if !fails_throughout(problem, slopes, &checker.evaluate(&edges), failure) {
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
    /// What it was given.
    pub parameters: Vec<E::Number>,
    /// Of an atlas, the parameters that have slopes in its names.
    varying: Vec<Option<Slope<E::Number>>>,
    /// `q_1` and `q_2` of the paper's cube.
    tight: Option<[E::Number; 2]>,
    rows: Vec<Row<Formula>>,
    divided: Vec<Row<Formula>>,
    /// Of platforms that turn, if all legs have them.
    scaled: Vec<Row<Formula>>,
    /// One for each obligation of platforms that turn.
    controls: Vec<(Test, Control)>,
    /// The same with derivatives by tolerances, where these are known.
    derived: Vec<(Test, Control)>,
    chords: Option<Multiplier>,
    /// What own evidence is made of; none where that is all.
    needed: Option<Vec<bool>>,
    /// The formulas without coordinates, if no parameter has slopes.
    constant: Values<Slope<E::Number>>,
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
        let scaled = problem.scaled();
        let controls = problem.controls(&scaled, None);
        let derived = problem.derived.as_ref();
        let derived = derived.map_or_else(Vec::new, |own| problem.controls(&scaled, Some(own)));
        let needed = own::needed(problem);
        let chords = None;
        let mut checker = Checker {
            problem,
            arithmetic,
            parameters,
            varying: Vec::new(),
            tight,
            rows,
            divided,
            scaled,
            controls,
            derived,
            chords,
            needed,
            constant: Values::default(),
        };
        checker.constant = checker.values(None, &[]);
        checker
    }

    /// With the one `Y` of a tree.
    #[must_use]
    pub fn with_chords(self, chords: Option<Multiplier>) -> Self {
        Checker { chords, ..self }
    }

    /// With parameters whose slopes in the names of an atlas are known.
    ///
    /// **Lemma (names).** Let names be coordinates as those of the workspace are: a cell is then one of
    /// points and values, and the lemmas of slopes and vertices hold of it. What a test shows at the
    /// vertices holds at each point for the machine of each value, so of each machine at all points: no
    /// test compares machines, and what is of a whole tree (`Y` of chords) is the same for all values. ∎
    /// The workspace's own inequality is concave for each machine, not in names (`radius^2`): see the
    /// tangent.
    #[must_use]
    pub fn with_varying(self, varying: Vec<Option<Slope<E::Number>>>) -> Self {
        let is_varied = varying.iter().any(Option::is_some);
        let constant = if is_varied { Values::default() } else { self.constant };
        Checker { varying, constant, ..self }
    }

    /// The arithmetic of slopes in `m` coordinates, and in names.
    pub fn slopes(&self, m: usize) -> Slopes<'a, E> {
        Slopes::new(self.arithmetic, m + self.problem.names.len())
    }

    /// The formulas over a cell.
    pub fn evaluate(&self, edges: &[[E::Number; 3]]) -> Values<Slope<E::Number>> {
        self.values(None, edges)
    }

    /// The same of the entries that are needed alone, where it is said which.
    fn values(
        &self,
        needed: Option<&[bool]>,
        edges: &[[E::Number; 3]],
    ) -> Values<Slope<E::Number>> {
        let slopes = self.slopes(edges.len());
        self.problem.tape.run_parts(&slopes, needed, &self.constant, |op| match op {
            Op::Coordinate(k) => slopes.coordinate(k, edges.get(k)?.clone()),
            Op::Parameter(j) => match self.varying.get(j) {
                Some(Some(slope)) => Some(slope.clone()),
                _ => slopes.constant(self.parameters.get(j)?.clone()),
            },
            _ => None,
        })
    }

    fn discharge(
        &self,
        place: &Place<'_, E::Number>,
        (at, node): (usize, &Node),
        open: &mut [bool],
    ) -> Result<(), Rejected> {
        let values = self.evaluate(place.edges);
        let slopes = self.slopes(place.edges.len());
        let over = Over::new(slopes, &values);
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
            let test = &self.problem.obligations[obligation].test;
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
        test: &Test,
        evidence: &Evidence,
    ) -> bool {
        let constant = |f: &Formula| {
            let f = *f;
            move |_| over.of(f).map(|f| f.range.clone())
        };
        let scaled = |f: &Formula| {
            let f = *f;
            move |v| self.scaled(over, over.of(f)?.range.clone(), v)
        };
        let rows = if over.controls.is_some() { &self.scaled } else { &self.rows };
        match (test, evidence) {
            (test, Evidence::Control(evidence)) => {
                let then = |over: &Over<'_, E>| self.shows(over, place, test, evidence);
                // Of a part, control points are not known.
                over.slopes.part.is_none()
                    && self.at_controls(over, place, test, then) == Some(true)
            }
            (test, Evidence::Turned(evidence, multiple, places)) => {
                use Evidence::{Control, Corner, Turned};
                let plain = !matches!(**evidence, Turned(..) | Control(_) | Corner(_));
                let turned = self.turned(over, (*multiple, *places));
                plain && self.shows_less(over, place, test, evidence, turned)
            }
            (test, Evidence::Inside(evidence, multiple, places)) => {
                use Evidence::{Control, Corner, Inside, Turned};
                let plain = !matches!(**evidence, Inside(..) | Turned(..) | Control(_) | Corner(_));
                let inside = self.inside(over, place, (*multiple, *places));
                plain && self.shows_less(over, place, test, evidence, inside)
            }
            (test, Evidence::Tolerances(evidence, ends, directions)) => {
                let plain =
                    is_of_vertices(test, evidence) && are_for(directions, test, place.edges.len());
                let then = |over: &Over<'_, E>| self.shows(over, place, test, evidence);
                plain && self.apart(over, place, (ends, directions), then) == Some(true)
            }
            (Test::SigmaMin(kappa), Evidence::Rank(y)) => {
                let zero = self.problem.tape.op(*kappa) == Op::Integer(0);
                zero && self.is_defined(over) && full_rank(over, rows, y)
            }
            (Test::SigmaMin(kappa), Evidence::Lower(y)) => {
                self.is_defined(over) && sigma_min(over, rows, &scaled(kappa), y)
            }
            (Test::SigmaMax(k), Evidence::Test) => sigma_max(over, rows, &scaled(k)),
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                self.conditioning(over, rows, *c, (y, mu))
            }
            (Test::OneToOne(rows), Evidence::Chords) => {
                self.chords.as_ref().is_some_and(|y| full_rank(over, rows, y))
            }
            (Test::AtLeast(f), Evidence::Test) if over.controls.is_some() => {
                at_least_there(over, *f)
            }
            (Test::Solve(test), Evidence::Lower(y)) => {
                let weight = |v| self.scaled(over, self.arithmetic.integer(1)?, v);
                solve(over, rows, test, &weight, y)
            }
            (Test::Least(rows, kappa), Evidence::Lower(y)) => {
                sigma_min(over, rows, &|v| over.at(*kappa, v), y)
            }
            (Test::Greatest(rows, k), Evidence::Test) => {
                sigma_max(over, rows, &|v| over.least_at(*k, v))
            }
            (Test::Accuracy(test), Evidence::Accuracy(y, kappa, p)) => {
                self.accuracy(over, place, test, (y, *kappa, *p)).unwrap_or(false)
            }
            // What follows knows of vertices alone.
            _ if over.controls.is_some() => false,
            (Test::SigmaMin(kappa), Evidence::LowerDivided(y)) => {
                self.is_defined(over) && sigma_min(over, &self.divided, &constant(kappa), y)
            }
            (Test::SigmaMin(_), Evidence::Corner(corner)) => self.corner(place, *corner).is_some(),
            (Test::SigmaMax(k), Evidence::Divided) => sigma_max(over, &self.divided, &constant(k)),
            (Test::SigmaMax(_), Evidence::Cube) => self.problem.cube_has_least,
            (Test::Apart(test), Evidence::Direction(g)) => apart(over, test, g),
            (Test::Curvature(test), Evidence::Test) => curvature(over, test),
            (Test::AtLeast(f), Evidence::Cube) => self.problem.cube_reached.contains(f),
            (Test::AtLeast(f), Evidence::Test) => {
                over.own(*f).is_some_and(|own| at_least(over, own, &[(*f, false)]))
            }
            (Test::Beyond(f, b), Evidence::Test | Evidence::Negative) => {
                let negative = *evidence == Evidence::Negative;
                let rest = || {
                    let (f, b) = (over.own(*f)?, over.own(*b)?);
                    match negative {
                        true => over.slopes.neg(&over.slopes.add(f, b)?),
                        false => over.slopes.sub(f, b),
                    }
                };
                let parts = [(*f, negative), (*b, true)];
                rest().is_some_and(|rest| at_least(over, &rest, &parts))
            }
            _ => false,
        }
    }

    /// A bound on squares, of the scaled rows times their weight.
    fn scaled(&self, over: &Over<'_, E>, bound: E::Number, v: Vertex) -> Option<E::Number> {
        match over.controls {
            None => Some(bound),
            Some(_) => self.arithmetic.mul(&bound, &over.at(self.problem.weight?, v)?),
        }
    }

    /// The test of accuracy, with the formulas near the cell.
    fn accuracy(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        test: &Accuracy,
        evidence: (&Multiplier, i64, u32),
    ) -> Option<bool> {
        let (tape, slopes) = (&self.problem.tape, over.slopes);
        let of = |f| over.of(f).map(|f| f.range.clone());
        let values = near(tape, &self.parameters, slopes, place.edges, test, of)?;
        let far = Over::new(slopes, &values);
        Some(self.is_defined(&far) && accuracy(over, &far, test, evidence))
    }

    /// Whether a user's formulas are defined on all of the cell, used or not.
    fn is_defined(&self, over: &Over<'_, E>) -> bool {
        self.problem.partial.iter().all(|&f| over.of(f).is_some())
    }

    /// **Conditioning.** `mu_v = mu_0 + sum_k v_k mu_k > 0` at the vertices, and with it both bounds:
    /// `sigma_min^2 >= mu`, `sigma_max^2 <= c^2 mu` for the same convex combination `mu` of the `mu_v`.
    /// At control points `mu_v = mu_0 w_v + sum_k t_vk mu_k`, where `t_vk` in `{-1, 0, 1}` is the place of the
    /// coordinate's node between the ends of its range, and `w sigma_min^2 >= mu`, `w sigma_max^2 <= c^2 mu`
    /// for the same convex combination: any other `mu_v` would do.
    fn conditioning(
        &self,
        over: &Over<'_, E>,
        rows: &[Row<Formula>],
        c_squared: Formula,
        (y, mu): (&Multiplier, &[i64]),
    ) -> bool {
        let (e, terms) = (self.arithmetic, self.problem.dimension());
        let Some((&first, rest)) = mu.split_first().filter(|(_, rest)| rest.len() == terms) else {
            return false;
        };
        let least = |v: Vertex| {
            let term = |sum: i64, (k, &mu): (usize, &i64)| match mu {
                0 => Some(sum),
                mu => sum.checked_add(mu.checked_mul(over.place(k, v)?)?),
            };
            let number = |n| e.dyadic(n, y.places, &e.integer(1)?);
            match over.controls {
                None => number(rest.iter().enumerate().try_fold(first, term).filter(|&n| n > 0)?),
                Some(_) => {
                    let own = self.scaled(over, number(first)?, v)?;
                    let mu = e.add(&own, &number(rest.iter().enumerate().try_fold(0, term)?)?)?;
                    e.is_positive(&mu).then_some(mu)
                }
            }
        };
        let greatest = |v| e.mul(&over.of(c_squared)?.range, &least(v)?);
        y.places < MOST_PLACES
            && sigma_min(over, rows, &least, y)
            && sigma_max(over, rows, &greatest)
    }
}
