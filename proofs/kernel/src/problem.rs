//! A claim as formulas, a box, and obligations: what a proof is about.

use crate::cell::Cell;
use crate::certificate::{Evidence, Node, Step, Tree, MOST_WORK};
use crate::claim::{Bound, MachineClaim, Mechanism, Quantity, Workspace};
use crate::compile::{Builder, MOST_DERIVATIVES, MOST_LEGS};
use crate::control::Control;
use crate::cube::Cube;
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{coordinates, formula, Formula, Op, Tape, Term, Values};
use crate::input::{
    enclosed, malformed, narrowed, ordered, positive, ClaimError, Input, Value, SIGN_BITS,
};
use crate::machine;
use crate::number::Expression;
use crate::quantity::{self, Obligation, Test};
use crate::test::tolerances::{is_of_second_order, Derivatives, SecondDerivatives};
use crate::test::Row;
use num_bigint::BigInt;
use std::collections::{BTreeSet, HashMap};

/// A claim, compiled.
#[derive(Clone, Debug)]
pub struct Problem {
    /// All formulas.
    pub tape: Tape,
    /// What parameter `j` of the tape is.
    pub inputs: Vec<Input>,
    /// The legs.
    pub legs: Vec<machine::Leg>,
    /// What is to be shown at every point.
    pub obligations: Vec<Obligation>,
    /// The workspace's least and greatest coordinates, divided by `2^scale`.
    pub corners: [Vec<Expression>; 2],
    /// The least and the greatest value of each coordinate of orientation; these come after the others.
    pub orientation: Vec<[Input; 2]>,
    /// `g >= 0` at the orientations of the claim; none where these are a box.
    pub turned: Option<Formula>,
    /// `w >= 1`, by which [`machine::Leg::scaled`] rows are scaled.
    pub weight: Option<Formula>,
    /// The unit of coordinates is `2^scale`.
    pub scale: i64,
    /// `g(x) >= 0` in the workspace, concave; none of a box.
    pub inside: Option<Inside>,
    /// `kappa = 1/psi_max`, of the paper's cube.
    pub cube_kappa: Option<Formula>,
    /// Whether the least psi asked for is at most `kappa`: shown on the paper's cube by its lemma
    /// (upper bound), see `cube`.
    pub cube_has_least: bool,
    /// Not negative on the paper's cube by its lemma (joint coordinates), see `cube`.
    pub cube_reached: Vec<Formula>,
    /// The components of directions, of which all else is made by way of the unit vectors along them.
    pub directions: Vec<Vec<Formula>>,
    /// Quotients and roots of a user's formulas: defined where the claim is true.
    pub partial: Vec<Formula>,
    /// The derivatives of tests by tolerances, where they are asked for.
    pub derived: Option<Derived>,
    /// Of a claim that no cube fits, a part of half of the side: cells are moved by so many of these.
    pub(crate) offset: Option<Expression>,
    /// The most work that a proof may ask for.
    pub(crate) most_work: usize,
}

/// A problem's derivatives by what machines differ by: quantities with two ends, and an atlas's names.
#[derive(Clone, Debug)]
pub struct Derived {
    /// The problem's tape, and they.
    pub tape: Tape,
    /// Of each formula.
    pub of: Derivatives,
    /// For each obligation how many rows times quantities there are that change them.
    pub(crate) changes: Vec<usize>,
    /// Second derivatives, where they are asked for.
    pub second: Option<Second>,
}

/// The second derivatives of a problem by pairs of some quantities.
#[derive(Clone, Debug)]
pub struct Second {
    /// These quantities.
    pub by: BTreeSet<usize>,
    /// The tape with derivatives, and they.
    pub tape: Tape,
    /// Of each formula.
    pub of: SecondDerivatives,
    /// For each obligation how many rows times pairs of quantities there are that change them.
    pub(crate) changes: Vec<usize>,
}

/// Most entries of a tape with these.
const MOST_DERIVED: usize = 1 << 14;
/// Inputs before one that are compared with it.
const NEAR: usize = 32;
/// Most rows times quantities that change them, of an obligation, and rows times pairs of these.
const MOST_CHANGES: usize = 1 << 8;
const MOST_SECOND_CHANGES: usize = 1 << 10;

/// The workspace's own inequality.
#[derive(Clone, Debug)]
pub struct Inside {
    /// `g`, concave.
    pub g: Formula,
    /// Its derivatives.
    pub gradient: Vec<Formula>,
}

impl Problem {
    /// The problem of a claim.
    ///
    /// # Errors
    /// If the claim is not well formed; that is decided here, before any proof, and at a precision of
    /// its own.
    pub fn new(claim: &MachineClaim) -> Result<Self, ClaimError> {
        let cube = match (&claim.mechanism, &claim.workspace) {
            (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
                Some(Cube::new(claim, offset, side)?)
            }
            (Mechanism::Orthoglide { .. }, _) | (_, Workspace::Cube { .. }) => {
                return Err(malformed("workspace", "a cube with kind orthoglide, and only then"));
            }
            (Mechanism::Formulas(_), Workspace::Cylinder { .. }) => {
                return Err(malformed("workspace", "a box of coordinates that are named"));
            }
            _ => None,
        };
        let corners = match (&cube, &claim.workspace) {
            (Some(cube), _) => [&cube.q1, &cube.q2].map(|q| vec![q.clone(); 3]),
            (None, workspace) => corners(workspace)?,
        };
        let mut builder = Builder::default();
        let legs = cube.as_ref().map_or(claim.mechanism.legs(), |cube| &cube.legs);
        builder.unit(legs)?;
        let (motion, chart) = builder.motion(claim)?;
        let (m, legs) = match &claim.mechanism {
            Mechanism::Formulas(formulas) => {
                (formulas.coordinates.len(), builder.by_formulas(formulas)?)
            }
            _ => (motion.velocity.len(), builder.built(&motion, legs)?),
        };
        let shape = corners.iter().all(|corner| corner.len() == m);
        let turns = chart.as_ref().map_or(0, |chart| chart.ends.len());
        if !shape || !(m + turns..=MOST_LEGS).contains(&legs.len()) {
            return Err(malformed("mechanism", "as many joints as coordinates, or more"));
        }
        let inside = inside(&mut builder, claim);
        let least = cube.as_ref().zip(quantity::psi(claim, Bound::least));
        let cube_has_least = least
            .is_some_and(|(cube, psi)| ordered("transmission", psi, &cube.kappa, false).is_ok());
        let cube_kappa = cube.map(|cube| builder.number("transmission", &cube.kappa, 0));
        let obligations = quantity::obligations(&mut builder, claim, (&legs, &motion))?;
        let problem = Problem {
            tape: builder.tape,
            inputs: builder.inputs,
            legs,
            obligations,
            corners,
            turned: chart.as_ref().and_then(|chart| chart.g),
            weight: chart.as_ref().map(|chart| chart.weight),
            orientation: chart.map_or_else(Vec::new, |chart| chart.ends),
            scale: builder.scale,
            inside,
            cube_kappa,
            cube_has_least,
            cube_reached: builder.reached,
            directions: builder.directions,
            partial: builder.partial,
            derived: None,
            offset: None,
            most_work: MOST_WORK,
        };
        problem.constants_are_defined()?;
        Ok(problem)
    }

    /// With the derivatives of tests by what machines differ by; as it is, where there is nothing of that, or
    /// where it takes too many operations.
    #[must_use]
    pub fn with_derivatives(self) -> Self {
        Problem { derived: self.derivatives(), ..self }
    }

    fn derivatives(&self) -> Option<Derived> {
        let differs = |j: usize| self.inputs.get(j).is_some_and(Input::differs);
        if !self.inputs.iter().any(Input::differs) {
            return None;
        }
        let rows = self.rows_of_tests();
        let others = self.weight.into_iter().chain(self.turned);
        let others = others.chain(self.inside.as_ref().map(|inside| inside.g));
        let formulas: BTreeSet<Formula> =
            rows.iter().flatten().flatten().copied().chain(others).collect();
        let (mut tape, mut of, mut spent) = (self.tape.clone(), HashMap::new(), 0);
        for formula in formulas {
            of.insert(formula, by_parameters(&mut tape, formula, differs, &mut spent)?);
        }
        let changes = changes(&rows, &of);
        let few = tape.ops().len() <= MOST_DERIVED && changes.iter().all(|&n| n <= MOST_CHANGES);
        few.then_some(Derived { tape, of, changes, second: None })
    }

    /// The rows of each obligation's test: polynomials, where there are such.
    fn rows_of_tests(&self) -> Vec<Vec<Vec<Formula>>> {
        let own = Some(self.scaled()).filter(|scaled| !scaled.is_empty());
        let own = own.unwrap_or_else(|| self.legs.iter().map(|leg| leg.row.clone()).collect());
        self.obligations.iter().map(|obligation| obligation.test.rows(&own)).collect()
    }

    /// With the second derivatives by these quantities too; as it is, where there are none, or where they take too many
    /// operations.
    #[must_use]
    pub fn with_second_derivatives(mut self, by: &BTreeSet<usize>) -> Self {
        let second = self.derived.as_ref().and_then(|own| self.second_derivatives(own, by));
        if let Some(derived) = &mut self.derived {
            derived.second = second;
        }
        self
    }

    fn second_derivatives(&self, own: &Derived, by: &BTreeSet<usize>) -> Option<Second> {
        if by.is_empty() {
            return None;
        }
        let (mut tape, mut of, mut spent) = (own.tape.clone(), HashMap::new(), 0);
        let formulas: BTreeSet<&Formula> = own.of.keys().collect();
        for formula in formulas {
            let mut all: Vec<([usize; 2], Formula)> = Vec::new();
            for &(j, derivative) in own.of.get(formula)?.iter().filter(|(j, _)| by.contains(j)) {
                let later = |l: usize| l >= j && by.contains(&l);
                let second = by_parameters(&mut tape, derivative, later, &mut spent)?;
                all.extend(second.into_iter().map(|(l, second)| ([j, l], second)));
            }
            of.insert(*formula, all);
        }
        let changes = changes(&self.rows_of_tests(), &of);
        let few = tape.ops().len() <= MOST_DERIVED;
        let few = few && changes.iter().all(|&n| n <= MOST_SECOND_CHANGES);
        few.then(|| Second { by: by.clone(), tape, of, changes })
    }

    /// With the derivatives that a tree's evidence is made of.
    pub(crate) fn with_derivatives_for(self, tree: &Tree) -> Self {
        if !tree.takes_tolerances_apart() {
            return self;
        }
        let by = self.of_second_order(&tree.nodes);
        self.with_derivatives().with_second_derivatives(&by)
    }

    /// The quantities that are of second order in some evidence.
    fn of_second_order(&self, nodes: &[Node]) -> BTreeSet<usize> {
        let differing: Vec<usize> = self.differing().collect();
        let parts = nodes.iter().flat_map(|node| &node.by).flat_map(|Step(_, by)| by.parts());
        let ends = parts.filter_map(|by| match by {
            Evidence::Tolerances(_, ends, _) => Some(ends),
            _ => None,
        });
        let second = |ends: &String| {
            let all = ends.chars().zip(&differing).filter(|(end, _)| is_of_second_order(*end));
            all.map(|(_, &j)| j).collect::<Vec<usize>>()
        };
        ends.flat_map(second).collect()
    }

    /// Whether what depends on no coordinate is defined, for every machine: directions are not zero,
    /// divisors not zero, radicands positive.
    fn constants_are_defined(&self) -> Result<(), ClaimError> {
        let parameters = self.parameters::<BigInt>(SIGN_BITS, &[])?;
        let values = self.tape.run(
            &Fixed::<BigInt>::new(SIGN_BITS),
            |_| None,
            |j| parameters.get(j).cloned(),
        );
        let undefined = self.tape.constants().into_iter().find(|&f| values.of(f).is_none());
        undefined.map_or(Ok(()), |f| {
            // Named after the first number that it is made of.
            let made_of = self.tape.parts(&[f]).into_iter().zip(self.tape.ops());
            let first = made_of.filter(|(is_part, _)| *is_part).find_map(|(_, op)| match op {
                Op::Parameter(j) => self.inputs.get(*j),
                _ => None,
            });
            let place = first.map_or("mechanism", |input| &input.place);
            Err(malformed(place, "such that all is defined for every machine"))
        })
    }

    /// Whether a user's formulas are defined, used or not.
    pub(crate) fn is_defined<N>(&self, values: &Values<N>) -> bool {
        self.partial.iter().all(|&f| values.of(f).is_some())
    }

    /// The work of a step: the tape's entries, and what a test does for all signs, vertices and signs of
    /// the joint errors.
    pub(crate) fn work(&self) -> usize {
        let errors = self.obligations.iter().any(|o| matches!(o.test, quantity::Test::Accuracy(_)));
        let signs = if errors { 1 << (3 * self.dimension()) } else { 0 };
        // Formulas are evaluated a second time over the inflated cell.
        self.tape.ops().len() * if errors { 2 } else { 1 } + signs
    }

    /// The coordinates.
    pub fn dimension(&self) -> usize {
        self.corners[0].len() + self.orientation.len()
    }

    /// The parameters of the tape with `bits` fractional bits; `machine` has the values of those that
    /// are intervals, in their order, or is empty.
    ///
    /// # Errors
    /// If one cannot be enclosed, or `machine` has another length.
    pub fn parameters<Z: Integer>(
        &self,
        bits: u32,
        machine: &[Expression],
    ) -> Result<Vec<Interval<Z>>, ClaimError> {
        let mut machine = machine.iter();
        let mut enclose = |input: &Input| {
            let value = if input.has_two_ends() { machine.next() } else { None };
            let refused =
                || malformed(&input.place, "a number that is neither too small nor too large");
            input.enclose(bits, value).and_then(|x| narrowed(&x)).ok_or_else(refused)
        };
        let mut all: Vec<Interval<Z>> = Vec::with_capacity(self.inputs.len());
        for (at, input) in self.inputs.iter().enumerate() {
            // Equal legs have equal numbers: each is enclosed once.
            let is_same = |k: &usize| {
                let other = &self.inputs[*k];
                !input.has_two_ends() && other.scale == input.scale && other.value == input.value
            };
            all.push(match (at.saturating_sub(NEAR)..at).rev().find(is_same) {
                Some(k) => all[k].clone(),
                None => enclose(input)?,
            });
        }
        Ok(all)
    }

    /// The numbers of the inputs by which machines differ.
    pub fn differing(&self) -> impl Iterator<Item = usize> + '_ {
        let inputs = self.inputs.iter().enumerate();
        inputs.filter(|(_, input)| input.differs()).map(|(j, _)| j)
    }

    /// The toleranced inputs, in their order.
    pub fn tolerances(&self) -> impl Iterator<Item = (&str, &Expression, &Expression)> {
        self.inputs.iter().filter_map(|input| match &input.value {
            Value::Quantity(Quantity::Between { min, max }) => Some((&*input.place, min, max)),
            _ => None,
        })
    }

    /// The least or the greatest coordinates, of the workspace and then of the orientations.
    pub(crate) fn corner<Z: Integer>(&self, side: usize, bits: u32) -> Option<Vec<Interval<Z>>> {
        let mut corner = self.point(&self.corners[side], bits)?;
        for ends in &self.orientation {
            corner.push(narrowed(&ends[side].enclose(bits, None)?)?);
        }
        Some(corner)
    }

    /// The box of the workspace and of the orientations, rounded outward to `bits` fractional bits.
    ///
    /// # Errors
    /// If a corner cannot be enclosed.
    pub fn root<Z: Integer>(&self, bits: u32) -> Result<Cell<Z>, ClaimError> {
        let both = self.corner(0, bits).zip(self.corner(1, bits));
        let (min, max) = both.ok_or_else(|| malformed("workspace", "numbers"))?;
        let edges = min.into_iter().zip(max);
        Ok(Cell(edges.map(|(min, max)| Interval { lo: min.lo, hi: max.hi }).collect()))
    }

    /// `q_1` and `q_2` of the paper's cube.
    pub fn tight<Z: Integer>(&self, bits: u32) -> Option<[Interval<Z>; 2]> {
        self.cube_kappa?;
        let of = |side| self.corner(side, bits)?.into_iter().next();
        Some([of(0)?, of(1)?])
    }

    /// The scaled rows; none unless all legs have them.
    pub(crate) fn scaled(&self) -> Vec<Row<Formula>> {
        let rows = self.legs.iter().map(|leg| leg.scaled.clone());
        rows.collect::<Option<_>>().unwrap_or_default()
    }

    /// Of each obligation of a platform that turns, the formulas that it needs at control points; with their
    /// derivatives, where these are given.
    pub(crate) fn controls(
        &self,
        rows: &[Row<Formula>],
        derived: Option<&Derived>,
    ) -> Vec<(Test, Control)> {
        let Some(weight) = self.weight else { return Vec::new() };
        let entries = |rows: &[Row<Formula>]| -> Vec<Formula> {
            rows.iter().flat_map(|row| row.a.iter().chain([&row.d]).copied()).collect()
        };
        let own = |Obligation { test, .. }: &Obligation| {
            use Test::{Accuracy, Conditioning, SigmaMax, SigmaMin, Solve};
            let mut wanted = match test {
                Test::OneToOne(rows) => entries(rows),
                Accuracy(test) => entries(&test.scaled).into_iter().chain(test.changes()).collect(),
                // It has no form for control points.
                Test::Beyond(..) => Vec::new(),
                _ => test.rows(rows).concat(),
            };
            if let SigmaMin(_) | SigmaMax(_) | Conditioning(_) | Solve(_) | Accuracy(_) = test {
                wanted.push(weight);
            }
            wanted.extend(self.turned);
            wanted.extend(self.inside.as_ref().map(|inside| inside.g));
            if let Some(Derived { of, .. }) = derived {
                let all = wanted.iter().filter_map(|f| of.get(f)).flatten();
                let derivatives: Vec<Formula> = all.map(|&(_, derivative)| derivative).collect();
                wanted.extend(derivatives);
            }
            let tape = derived.map_or(&self.tape, |derived| &derived.tape);
            let control = Control::new(tape, self.dimension(), &wanted);
            let ends = if self.is_easier_with_less(test) { self.corners[0].len() } else { 0 };
            (test.clone(), control.at_ends(ends))
        };
        self.obligations.iter().map(own).collect()
    }

    /// Whether a test on scaled rows is the easier the less squares of positions are ([`Control::at_ends`]).
    ///
    /// **Lemma.** It is, of these three tests and as many struts as coordinates. *Proof.* Of all formulas in them
    /// only the `w D_i` have squares of positions, with the factor `w > 0`: `w A`, `w` and the inequality of
    /// orientations have none. The matrices of singular values and solutions decrease with the `w D_i`, and so
    /// does `T - kappa^2 w D` of an accuracy; its other one shows `|A^-1 y| < z` for all `|y_i| <= b_i`, and the `b_i` grow
    /// with them. That all `D_i > 0` is harder the less they are; but `T > 0` shows `A` regular by itself, and a
    /// strut of length zero, `D_i = 0`, has a row `A_i` of zeros. Nor have derivatives by tolerances squares of
    /// positions: of the `w D_i` they are subtracted, for their factor `w` is of orientations alone. ∎ The inequality of a
    /// cylinder has the squares with another sign.
    fn is_easier_with_less(&self, test: &Test) -> bool {
        let decreases = matches!(test, Test::SigmaMin(_) | Test::Solve(_) | Test::Accuracy(_));
        decreases && self.inside.is_none() && self.legs.len() == self.dimension()
    }

    /// The unit of coordinate `k` is two to the power of this.
    pub(crate) fn scale_of(&self, k: usize) -> i64 {
        if k < self.corners[0].len() {
            self.scale
        } else {
            0
        }
    }

    /// A point of the workspace in the problem's unit, and coordinates of orientation.
    pub(crate) fn point<Z: Integer>(
        &self,
        point: &[Expression],
        bits: u32,
    ) -> Option<Vec<Interval<Z>>> {
        let enclose = |(k, x)| narrowed(&enclosed(x, self.scale_of(k), bits)?);
        point.iter().enumerate().map(enclose).collect()
    }
}

/// The least box about a workspace.
fn corners(workspace: &Workspace) -> Result<[Vec<Expression>; 2], ClaimError> {
    let (min, max) = match workspace {
        Workspace::Box { min, max } => (min.clone(), max.clone()),
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            positive("workspace.radius", radius)?;
            let min = vec![x - radius, y - radius, low.clone()];
            (min, vec![x + radius, y + radius, high.clone()])
        }
        Workspace::Cube { .. } => return Err(malformed("workspace", "a box or a cylinder")),
    };
    if min.len() != max.len() {
        return Err(malformed("workspace", "as many least as greatest coordinates"));
    }
    let mut last = None;
    for (min, max) in min.iter().zip(&max) {
        // A cube's are the same thrice.
        if last.replace((min, max)) != Some((min, max)) {
            ordered("workspace", min, max, false)?;
        }
    }
    Ok([min, max])
}

/// `radius^2 - (x - center_1)^2 - (y - center_2)^2`.
fn inside(builder: &mut Builder, claim: &MachineClaim) -> Option<Inside> {
    let Workspace::Cylinder { center, radius, .. } = &claim.workspace else { return None };
    let scale = builder.scale;
    let radius = builder.number("workspace.radius", radius, scale);
    let mut g = builder.tape.sqr(radius);
    for (k, center) in center.iter().enumerate() {
        let center = builder.number("workspace.center", center, scale);
        let x = builder.tape.coordinate(k);
        let (turns, tape) = (claim.orientation.is_some(), &mut builder.tape);
        // Control points want squares of coordinates alone.
        let off = if turns { tape.expanded(x, center) } else { formula!(tape; (x - center) ^ 2) };
        g = tape.sub(g, off);
    }
    let gradient = builder.tape.gradient(g, &coordinates(3)).numerators;
    Some(Inside { g, gradient })
}

/// The derivatives of a formula by these parameters, but those that are zero; none where, with what is spent, they take too
/// many operations.
fn by_parameters(
    tape: &mut Tape,
    formula: Formula,
    is_by: impl Fn(usize) -> bool,
    spent: &mut usize,
) -> Option<Vec<(usize, Formula)>> {
    let zero = tape.integer(0);
    let parts = tape.parts(&[formula]);
    let ops = || parts.iter().zip(tape.ops()).filter(|(&part, _)| part).map(|(_, &op)| op);
    let by: Vec<Op> = ops().filter(|op| matches!(*op, Op::Parameter(j) if is_by(j))).collect();
    *spent = spent.saturating_add(by.len().saturating_mul(ops().count()));
    if *spent > MOST_DERIVATIVES {
        return None;
    }
    let each = by.iter().zip(tape.derivatives(formula, &by));
    let known = each.filter_map(|(op, derivative)| match *op {
        Op::Parameter(j) if derivative != zero => Some((j, derivative)),
        _ => None,
    });
    Some(known.collect())
}

/// For each obligation how many of its rows times what they differ by there are.
fn changes<K: Copy + Ord>(
    rows: &[Vec<Vec<Formula>>],
    of: &HashMap<Formula, Vec<(K, Formula)>>,
) -> Vec<usize> {
    let each = |row: &Vec<Formula>| {
        let all = row.iter().filter_map(|f| of.get(f)).flatten().map(|&(k, _)| k);
        all.collect::<BTreeSet<K>>().len()
    };
    rows.iter().map(|rows| rows.iter().map(each).sum()).collect()
}
