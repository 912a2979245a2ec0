//! Steps with tolerances apart.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::cell::evaluate;
use crate::certificate::{Evidence, Node, Step, Tree};
use crate::control::{Control, Controls};
use crate::formula::{Formula, Values};
use crate::quantity::Test;
use crate::slope::Slope;
use crate::test::tolerances::Tolerances;
use crate::test::{Over, Row};
use std::cell::OnceCell;

/// Where a step is made.
pub struct Place<'a, N> {
    /// For each coordinate the cell's centre, range and half-width.
    pub edges: &'a [[N; 3]],
    /// Whether the cell touches the root's least, and its greatest corner.
    pub touches: [bool; 2],
    /// The formulas of all machines, with their derivatives.
    derived: OnceCell<Values<Slope<N>>>,
}

impl<'a, N> Place<'a, N> {
    /// A cell with these edges.
    pub fn new(edges: &'a [[N; 3]], touches: [bool; 2]) -> Self {
        Place { edges, touches, derived: OnceCell::new() }
    }
}

/// Whether these are directions for a test, of `m` coordinates, one for each matrix.
pub(super) fn are_for(directions: &[Vec<i64>], test: &Test, m: usize) -> bool {
    let expected = match test {
        Test::AtLeast(_) | Test::Beyond(..) => vec![],
        Test::Conditioning(_) => vec![m, m],
        _ => vec![m],
    };
    directions.iter().map(Vec::len).eq(expected)
}

/// Whether the evidence for a test looks at nothing but formulas at vertices or control points, and at the
/// workspace's and the orientations' own inequalities, which no tolerance changes.
pub(super) fn is_of_vertices(test: &Test, evidence: &Evidence) -> bool {
    use Evidence::{Conditioning, Control, Inside, Lower, Negative, Rank, Turned};
    match evidence {
        Control(inner) | Inside(inner, ..) | Turned(inner, ..) => is_of_vertices(test, inner),
        Evidence::Test => !matches!(test, Test::Apart(_) | Test::Curvature(_)),
        other => matches!(other, Lower(_) | Rank(_) | Conditioning(..) | Negative),
    }
}

impl<E: Enclosure> Checker<'_, E> {
    /// The formulas of all machines with their derivatives by tolerances, where there are some.
    pub fn derived<'p>(
        &self,
        place: &'p Place<'_, E::Number>,
    ) -> Option<&'p Values<Slope<E::Number>>> {
        let tape = &self.problem.derived.as_ref()?.tape;
        Some(place.derived.get_or_init(|| {
            evaluate(tape, &self.parameters, self.slopes(place.edges.len()), place.edges)
        }))
    }

    /// What is so with tolerances apart, by the lemma of [`Tolerances`]. The one machine has the least
    /// value of each quantity with two ends, the greatest or one in the middle, as its character of
    /// `ends` says: `-`, `+` or `0`.
    pub fn apart<T>(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        (ends, directions): (&str, &[Vec<i64>]),
        then: impl FnOnce(&Over<'_, E>) -> T,
    ) -> Option<T> {
        if over.controls.is_some() || over.inside.is_some() || over.tolerances.is_some() {
            return None;
        }
        let values = self.derived(place)?;
        let derivatives = &self.problem.derived.as_ref()?.of;
        let mut named = ends.chars();
        let start = |(at, x): (usize, &E::Number)| match self.problem.inputs.get(at)?.has_two_ends()
        {
            true => start(self.arithmetic, x, named.next()?),
            false => Some((x.clone(), Vec::new())),
        };
        let all: Vec<_> = self.parameters.iter().enumerate().map(start).collect::<Option<_>>()?;
        let (starts, steps): (Vec<E::Number>, Vec<Vec<E::Number>>) = all.into_iter().unzip();
        let machine = evaluate(&self.problem.tape, &starts, over.slopes, place.edges);
        let tolerances = Tolerances {
            machine: &machine,
            parameters: &starts,
            controls: None,
            steps: &steps,
            derivatives,
            directions,
        };
        let over = Over { values, inside: None, tolerances: Some(&tolerances), ..*over };
        named.next().is_none().then(|| then(&over))
    }

    /// The formulas of a test at control points, where it has such: of all machines, with derivatives where
    /// tolerances are apart.
    pub fn controls(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        test: &Test,
    ) -> Option<Controls<E::Number>> {
        let all = if over.tolerances.is_some() { &self.derived } else { &self.controls };
        found(all, test)?.values(self.arithmetic, &self.parameters, place.edges)
    }

    /// What is so at control points, of formulas there.
    pub fn at_controls<T>(
        &self,
        over: &Over<'_, E>,
        place: &Place<'_, E::Number>,
        test: &Test,
        then: impl FnOnce(&Over<'_, E>) -> T,
    ) -> Option<T> {
        if over.controls.is_some() || over.inside.is_some() {
            return None;
        }
        let all = self.controls(over, place, test)?;
        let Some(tolerances) = over.tolerances else {
            return Some(then(&Over { controls: Some(&all), inside: None, ..*over }));
        };
        let own = found(&self.controls, test)?;
        let own = own.values(self.arithmetic, tolerances.parameters, place.edges)?;
        let tolerances = Tolerances { controls: Some(&own), ..*tolerances };
        let over =
            Over { controls: Some(&all), inside: None, tolerances: Some(&tolerances), ..*over };
        own.is_like(&all).then(|| then(&over))
    }

    /// The work of all steps, beside that of formulas over cells: at vertices a quarter of the operations on
    /// matrices, with all their sign vertices; at control points the formulas there; with tolerances apart all formulas with their derivatives once a node, and
    /// for each step those of one machine, and at each vertex or control point all changes.
    pub(super) fn work_of(&self, tree: &Tree) -> usize {
        let (m, signs) = (self.problem.dimension(), |test: &Test| match test {
            Test::Accuracy(test) => test.rows.len().pow(2) << test.rows.len(),
            _ => 0,
        });
        let at_controls = |(test, control): &(Test, Control)| {
            control.work().saturating_add(control.points().saturating_mul(signs(test)))
        };
        let derived = self.problem.derived.as_ref();
        let tests = self.problem.obligations.iter().map(|obligation| &obligation.test);
        let at_vertices: Vec<usize> = tests.map(|test| at_vertices(test, &self.rows, m)).collect();
        let of_step = |Step(obligation, evidence): &Step| match evidence {
            Evidence::Control(_) => self.controls.get(*obligation).map_or(0, at_controls),
            Evidence::Tolerances(inner, ends, _) => {
                let is_control = matches!(**inner, Evidence::Control(_));
                let controls = [&self.controls, &self.derived].map(|all| all.get(*obligation));
                let controls = || controls.into_iter().flatten();
                let changes = derived.and_then(|derived| derived.changes.get(*obligation));
                let points = match is_control {
                    true => controls().map(|(_, control)| control.points()).max().unwrap_or(0),
                    false => 1 << m,
                };
                // Two matrices of conditioning, two steps from the middle, values at vertices of m + 1 terms.
                let test = self.problem.obligations.get(*obligation).map(|o| &o.test);
                let matrices = if matches!(test, Some(Test::Conditioning(_))) { 2 } else { 1 };
                let steps = if ends.contains('0') { 2 } else { 1 };
                let values = if is_control { 0 } else { m * (m + 1) };
                let each = matrices * (steps * (m + 2) * (m + 2) + values);
                let changes = changes.map_or(0, |&changes| changes * each);
                let there = controls().filter(|_| is_control).map(at_controls);
                there
                    .fold(changes.saturating_mul(points), usize::saturating_add)
                    .saturating_add(self.problem.tape.ops().len())
            }
            _ => at_vertices.get(*obligation).copied().unwrap_or(0),
        };
        let of_node = |node: &Node| {
            let is_apart = |Step(_, evidence): &Step| matches!(evidence, Evidence::Tolerances(..));
            let all = derived.filter(|_| node.by.iter().any(is_apart));
            let all = all.map_or(0, |derived| derived.tape.ops().len());
            node.by.iter().map(of_step).fold(all, usize::saturating_add)
        };
        tree.nodes.iter().map(of_node).fold(0, usize::saturating_add)
    }
}

/// A quarter of the operations of a test on its matrices, at all vertices of `m` coordinates, and with all sign vertices of these.
fn at_vertices(test: &Test, rows: &[Row<Formula>], m: usize) -> usize {
    let n = test.rows(rows).len();
    let (k, matrices) = match test {
        Test::AtLeast(_) | Test::Beyond(..) | Test::Apart(_) | Test::Accuracy(_) => return 0,
        Test::Solve(_) => (n, 1),
        Test::Conditioning(_) | Test::Curvature(_) => (m, 2),
        _ => (m, 1),
    };
    let signs = (1usize << k) / 2;
    ((matrices * (n * k * k + signs * k * k * k / 6)) << m) / 4
}

/// Of a test.
fn found<'a>(all: &'a [(Test, Control)], test: &Test) -> Option<&'a Control> {
    all.iter().find_map(|(own, control)| (own == test).then_some(control))
}

/// Where a quantity of `[lo, hi]` begins, and its steps. In the middle from a `c <= (lo + hi)/2`,
/// so that `hi - c` is not less than `c - lo`.
fn start<E: Enclosure>(e: &E, x: &E::Number, end: char) -> Option<(E::Number, Vec<E::Number>)> {
    let [lo, hi] = e.ends(x);
    let up_from = |low: &E::Number| Some(e.ends(&e.sub(&hi, low)?)[1].clone());
    Some(match end {
        '-' => (lo.clone(), vec![up_from(&lo)?]),
        '+' => (hi.clone(), vec![e.neg(&up_from(&lo)?)?]),
        '0' => {
            let [middle, _] = e.ends(&e.halve(&e.add(&lo, &hi)?)?);
            let half = up_from(&middle)?;
            let back = e.neg(&half)?;
            (middle, vec![half, back])
        }
        _ => return None,
    })
}
