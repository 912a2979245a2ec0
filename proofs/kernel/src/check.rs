//! What a certificate has to be to be accepted.

use crate::arithmetic::{Arithmetic as _, Enclosure};
use crate::cell::{evaluate, Vertex};
use crate::certificate::{
    Certificate, Claim, Corner, Evidence, Node, Proof, Step, Tree, Verdict, PRECISIONS,
};
use crate::definite::is_positive_definite;
use crate::fixed::{Fixed, Integer};
use crate::formula::Formula;
use crate::formula::Values;
use crate::input::ClaimError;
use crate::problem::{Inside, Problem};
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::accuracy::{accuracy, inflated, Accuracy};
use crate::test::apart::apart;
use crate::test::curvature::curvature;
use crate::test::solve::solve;
use crate::test::{at_least, one_to_one, sigma_max, sigma_min, Multiplier, Over, Row, MOST_PLACES};
use crate::witness::{self, WitnessError};
use num_bigint::BigInt;
use std::fmt;

/// Most nodes of a tree.
pub const MOST_NODES: usize = 500_000;
/// Most work of all steps, each counted once for every 64 bits of the precision: a bound on time,
/// whatever the file.
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
/// a cell holds on its parts. ∎ The root's cell holds the workspace's box, rounded outward. Steps by
/// [`Evidence::Chords`] have one matrix, the tree's: what they show of two points is of both with it.
fn tree_holds<Z: Integer>(problem: &Problem, tree: &Tree) -> Result<(), Rejected> {
    let bits = tree.precision;
    let steps = tree.nodes.iter().filter(|node| !node.by.is_empty()).count();
    let each = problem.work() * (1 + bits as usize / 64);
    if tree.nodes.len() > MOST_NODES || steps.saturating_mul(each) > MOST_WORK {
        return Err(Rejected::Work);
    }
    let arithmetic = Fixed::<Z>::new(bits);
    let parameters = problem.parameters(bits, &[]).map_err(Rejected::Claim)?;
    let checker = Checker::new(problem, &arithmetic, parameters, problem.tight(bits))
        .with_chords(tree.chords.clone());
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
    chords: Option<Multiplier>,
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
        Checker { problem, arithmetic, parameters, tight, rows, divided, chords: None }
    }

    /// With the one `Y` of a tree.
    #[must_use]
    pub fn with_chords(self, chords: Option<Multiplier>) -> Self {
        Checker { chords, ..self }
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
                self.conditioning(over, *c, (y, mu))
            }
            (Test::Least(rows, kappa), Evidence::Lower(y)) => {
                sigma_min(over, rows, &constant(kappa), y)
            }
            (Test::OneToOne(rows), Evidence::Chords) => {
                self.chords.as_ref().is_some_and(|y| one_to_one(over, rows, y))
            }
            (Test::Solve(test), Evidence::Lower(y)) => solve(over, test, y),
            (Test::Accuracy(test), Evidence::Accuracy(y, kappa)) => {
                self.accuracy(over, place, test, (y, *kappa)).unwrap_or(false)
            }
            (Test::Apart(test), Evidence::Direction(g)) => apart(over, test, g),
            (Test::Curvature(test), Evidence::Test) => curvature(over, test),
            (Test::AtLeast(f), Evidence::Test) => over.of(*f).is_some_and(|f| at_least(over, f)),
            (Test::Beyond(f, b), Evidence::Test | Evidence::Negative) => {
                let rest = || {
                    let (f, b) = (over.of(*f)?, over.of(*b)?);
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

    /// The test of accuracy, with the formulas over the inflated cell.
    fn accuracy(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        test: &Accuracy,
        evidence: (&Multiplier, i64),
    ) -> Option<bool> {
        let d = &over.of(test.distance)?.range;
        let values = self.evaluate(&inflated(self.arithmetic, place.edges, d)?);
        let far = Over { slopes: over.slopes, values: &values, inside: None };
        Some(self.is_defined(&far) && accuracy(over, &far, test, evidence))
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
