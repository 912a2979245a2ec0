//! What a certificate has to be to be accepted.

mod corner;
mod inside;

use crate::arithmetic::{Arithmetic as _, Enclosure};
use crate::cell::{evaluate, Vertex};
use crate::certificate::{
    Certificate, Claim, Evidence, Node, Proof, Step, Tree, Verdict, PRECISIONS,
};
use crate::control::{Control, Controls};
use crate::fixed::{Fixed, Integer};
use crate::formula::{Formula, Op, Values};
use crate::input::ClaimError;
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::{
    at_least, at_least_there, full_rank, sigma_max, sigma_min, Multiplier, Over, Row, MOST_PLACES,
};
use crate::witness::{self, WitnessError};
use num_bigint::BigInt;
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
    let Claim::Machine(claim) = &certificate.claim;
    let problem = Problem::new(claim).map_err(Rejected::Claim)?;
    match (certificate.verdict, &certificate.proof) {
        (Verdict::Certified, Proof::Tree(tree)) => {
            if !PRECISIONS.contains(&tree.precision) {
                return Err(Rejected::Precision(tree.precision));
            }
            // Words give what integers of any size give, or nothing.
            if tree.precision < 60 && tree_holds::<i64>(&problem, tree).is_ok() {
                return Ok(());
            }
            tree_holds::<BigInt>(&problem, tree)
        }
        (Verdict::Refuted, Proof::Witness(witness)) => {
            witness::check(&problem, &claim.workspace, witness).map_err(Rejected::Witness)
        }
        _ => Err(Rejected::Verdict),
    }
}

/// **Lemma (tree).** If every step shows its obligation on its node's cell, and on the path to each
/// leaf every obligation is discharged, each holds at every point of the root's cell that is in the
/// workspace. *Proof.* The halves of a cell cover it, so the leaves cover the root; what is shown of
/// a cell holds on its parts. ∎ The root's cell holds the workspace's box, rounded outward.
fn tree_holds<Z: Integer>(problem: &Problem, tree: &Tree) -> Result<(), Rejected> {
    let bits = tree.precision;
    let arithmetic = Fixed::<Z>::new(bits);
    let parameters = problem.parameters(bits, &[]).map_err(Rejected::Claim)?;
    let checker = Checker::new(problem, &arithmetic, parameters, problem.tight(bits));
    let steps = tree.nodes.iter().filter(|node| !node.by.is_empty()).count();
    let steps = steps.saturating_mul(problem.tape.ops().len());
    let work = steps.saturating_add(checker.work_at_controls(tree));
    if tree.nodes.len() > MOST_NODES || work.saturating_mul(1 + bits as usize / 64) > MOST_WORK {
        return Err(Rejected::Work);
    }
    let root = problem.root(bits).map_err(Rejected::Claim)?;
    let mut waiting = vec![(root.clone(), vec![true; problem.obligations.len()])];
    for (at, node) in tree.nodes.iter().enumerate() {
        let (cell, mut open) = waiting.pop().ok_or(Rejected::Shape(at))?;
        if !node.by.is_empty() {
            let edges = cell.edges().ok_or(Rejected::Shape(at))?;
            let place = Place { edges: &edges, touches: cell.touches(&root) };
            checker.discharge(&place, (at, node), &mut open)?;
        }
        if let Some(k) = node.split {
            let [lower, upper] = cell.halves(k).ok_or(Rejected::Shape(at))?;
            waiting.push((upper, open.clone()));
            waiting.push((lower, open));
        } else if let Some(obligation) = open.iter().position(|&open| open) {
            return Err(Rejected::Open { node: at, obligation });
        }
    }
    if waiting.is_empty() {
        Ok(())
    } else {
        Err(Rejected::Shape(tree.nodes.len()))
    }
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
    /// Of platforms that turn, if all legs have them.
    scaled: Vec<Row<Formula>>,
    /// One for each obligation of platforms that turn.
    controls: Vec<(Test, Control)>,
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
        let scaled = problem.scaled();
        let controls = problem.controls(&scaled);
        Checker { problem, arithmetic, parameters, tight, rows, divided, scaled, controls }
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
        let over = Over { slopes, values: &values, controls: None, inside: None };
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
        let scaled = |f: Formula| move |v| self.scaled(over, over.of(f)?.range.clone(), v);
        let rows = if over.controls.is_some() { &self.scaled } else { &self.rows };
        match (test, evidence) {
            (test, Evidence::Control(evidence)) => {
                over.controls.is_none()
                    && over.inside.is_none()
                    && self.controls(place, test).is_some_and(|controls| {
                        let over = Over { controls: Some(&controls), inside: None, ..*over };
                        self.shows(&over, place, test, evidence)
                    })
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
            (Test::SigmaMin(kappa), Evidence::Rank(y)) => {
                let zero = self.problem.tape.op(kappa) == Op::Integer(0);
                zero && self.is_defined(over) && full_rank(over, rows, y)
            }
            (Test::SigmaMin(kappa), Evidence::Lower(y)) => {
                self.is_defined(over) && sigma_min(over, rows, &scaled(kappa), y)
            }
            (Test::SigmaMax(k), Evidence::Test) => sigma_max(over, rows, &scaled(k)),
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                self.conditioning(over, rows, c, (y, mu))
            }
            (Test::AtLeast(f), Evidence::Test) if over.controls.is_some() => {
                at_least_there(over, f)
            }
            // What follows knows of vertices alone.
            _ if over.controls.is_some() => false,
            (Test::SigmaMin(kappa), Evidence::LowerDivided(y)) => {
                self.is_defined(over) && sigma_min(over, &self.divided, &constant(kappa), y)
            }
            (Test::SigmaMin(_), Evidence::Corner(corner)) => self.corner(place, *corner).is_some(),
            (Test::SigmaMax(k), Evidence::Divided) => sigma_max(over, &self.divided, &constant(k)),
            (Test::SigmaMax(_), Evidence::Cube) => self.problem.cube_has_least,
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

    /// A bound on squares, of the scaled rows times their weight.
    fn scaled(&self, over: &Over<'_, E>, bound: E::Number, v: Vertex) -> Option<E::Number> {
        match over.controls {
            None => Some(bound),
            Some(_) => self.arithmetic.mul(&bound, &over.at(self.problem.weight?, v)?),
        }
    }

    /// Whether a user's formulas are defined on all of the cell, used or not.
    fn is_defined(&self, over: &Over<'_, E>) -> bool {
        self.problem.partial.iter().all(|&f| over.of(f).is_some())
    }

    /// **Conditioning.** `mu_v = mu_0 + sum_k v_k mu_k > 0` at the vertices, and with it both bounds:
    /// `sigma_min^2 >= mu`, `sigma_max^2 <= c^2 mu` for the same convex combination `mu` of the `mu_v`.
    /// At control points `mu_0` alone: they have no `v`, and `mu` times the weight has not their form.
    fn conditioning(
        &self,
        over: &Over<'_, E>,
        rows: &[Row<Formula>],
        c_squared: Formula,
        (y, mu): (&Multiplier, &[i64]),
    ) -> bool {
        let terms = if over.controls.is_some() { 0 } else { over.slopes.m };
        let Some((first, rest)) = mu.split_first().filter(|(_, rest)| rest.len() == terms) else {
            return false;
        };
        let mu = |v: Vertex| {
            let mut terms = rest.iter().enumerate();
            let n = terms.try_fold(*first, |sum, (k, &mu)| {
                sum.checked_add(if v.has(k) { mu } else { mu.checked_neg()? })
            });
            self.arithmetic.dyadic(n.filter(|&n| n > 0)?, y.places, &self.arithmetic.integer(1)?)
        };
        let least = |v| self.scaled(over, mu(v)?, v);
        let greatest = |v| self.arithmetic.mul(&over.of(c_squared)?.range, &least(v)?);
        y.places < MOST_PLACES
            && sigma_min(over, rows, &least, y)
            && sigma_max(over, rows, &greatest)
    }

    /// The formulas of a test at control points, where it has such.
    pub fn controls(
        &self,
        place: &Place<'_, E::Number>,
        test: Test,
    ) -> Option<Controls<E::Number>> {
        let (_, control) = self.controls.iter().find(|(own, _)| *own == test)?;
        control.values(self.arithmetic, &self.parameters, place.edges)
    }

    /// Evaluations of formulas that a tree asks for at control points.
    fn work_at_controls(&self, tree: &Tree) -> usize {
        let steps = tree.nodes.iter().flat_map(|node| &node.by);
        let work = |Step(obligation, evidence): &Step| match evidence {
            Evidence::Control(_) => {
                self.controls.get(*obligation).map_or(0, |(_, control)| control.work())
            }
            _ => 0,
        };
        steps.map(work).fold(0, usize::saturating_add)
    }
}
