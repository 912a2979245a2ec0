//! The work that a tree asks for.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::certificate::{Evidence, Node, Step, Tree};
use crate::control::Control;
use crate::formula::Formula;
use crate::quantity::Test;
use crate::test::tolerances::{is_of_second_order, MOST_TOGETHER};
use crate::test::Row;
use std::collections::BTreeSet;

impl<E: Enclosure> Checker<'_, E> {
    /// The work of all steps, beside that of formulas over cells: at vertices, or control points, the operations on
    /// matrices, with all their sign vertices; at control points the formulas there, too; with tolerances apart all
    /// formulas with their derivatives once a node, twice where directions are of one scale in some of its steps and not in
    /// others, and for each step those of one machine; of second order with all second derivatives, and with the derivatives of
    /// the one machine; and how often, at each vertex or control point, a tolerance, or a pair of these, changes a number.
    pub(crate) fn work_of(&self, tree: &Tree) -> [usize; 2] {
        let m = self.problem.dimension();
        let signs = |test: &Test| match test {
            Test::Accuracy(test) => test.rows.len().pow(2) << test.rows.len(),
            _ => 0,
        };
        let at_controls = |(test, control): &(Test, Control)| {
            let points = control.points();
            (points, control.work().saturating_add(points.saturating_mul(signs(test))))
        };
        let [own, apart] = [&self.controls, &self.derived]
            .map(|all| all.iter().map(at_controls).collect::<Vec<(usize, usize)>>());
        let (entries, derived) = (self.problem.tape.ops().len(), self.problem.derived.as_ref());
        let second = derived.and_then(|derived| derived.second.as_ref());
        let all = derived.map_or(0, |derived| derived.tape.ops().len());
        let is_curved = |ends: &str| ends.chars().any(is_of_second_order);
        let tests = self.problem.obligations.iter().map(|obligation| &obligation.test);
        let at_vertices: Vec<usize> = tests.map(|test| at_vertices(test, &self.rows, m)).collect();
        let at_points = |obligation: &usize, points: usize| {
            at_vertices.get(*obligation).map_or(0, |work| work.saturating_mul(points))
        };
        let both = |a: [usize; 2], b: [usize; 2]| [0, 1].map(|k| a[k].saturating_add(b[k]));
        let of_part = |obligation: &usize, evidence: &Evidence| match evidence {
            Evidence::Control(_) => {
                let (points, work) = own.get(*obligation).copied().unwrap_or_default();
                [work.saturating_add(at_points(obligation, points)), 0]
            }
            Evidence::Tolerances(inner, ends, _) => {
                let is_control = matches!(**inner, Evidence::Control(_));
                let controls = [&own, &apart].map(|all| all.get(*obligation));
                let controls = || controls.into_iter().flatten().filter(|_| is_control);
                let points = match is_control {
                    true => controls().map(|(points, _)| *points).max().unwrap_or(0),
                    false => 1 << m,
                };
                // Two matrices of conditioning, two steps from the middle, values at vertices of m + 1 terms.
                let test = self.problem.obligations.get(*obligation).map(|o| &o.test);
                let matrices = if matches!(test, Some(Test::Conditioning(_))) { 2 } else { 1 };
                let steps = if ends.contains(['0', '=']) { 2 } else { 1 };
                let values = if is_control { 0 } else { m * (m + 1) };
                let each = |steps: usize| matrices * (steps * (m + 2) * (m + 2) + values);
                let of = |changes: Option<&Vec<usize>>, steps: usize| {
                    let changes = changes.and_then(|changes| changes.get(*obligation));
                    changes.map_or(0, |&changes| changes * each(steps)).saturating_mul(points)
                };
                let first = of(derived.map(|derived| &derived.changes), steps);
                let (entries, pairs) = match second.filter(|_| is_curved(ends)) {
                    None => (entries, 0),
                    Some(second) => (all, of(Some(&second.changes), steps * steps)),
                };
                let entries =
                    controls().map(|(_, work)| *work).fold(entries, usize::saturating_add);
                // A matrix of m + 1 rows at most is made, and eliminated with all its sign vertices.
                let each = (m + 2).pow(2) + ((m + 1).pow(3) << m) / 6;
                let together = self.together_of(test, inner, ends).saturating_mul(each);
                let together = together.saturating_mul(points);
                let eliminated = at_points(obligation, points);
                let all = [first, pairs, together, eliminated];
                [entries, all.into_iter().fold(0, usize::saturating_add)]
            }
            _ => [at_points(obligation, 1 << m), 0],
        };
        let of_step = |Step(obligation, evidence): &Step| {
            let parts = evidence.parts().into_iter();
            parts.map(|part| of_part(obligation, part)).fold([0; 2], both)
        };
        let of_node = |node: &Node| {
            let apart = node.by.iter().flat_map(|Step(_, by)| by.parts());
            let kinds = apart.filter_map(|by| match by {
                Evidence::Tolerances(_, ends, _) => Some((ends.contains('1'), is_curved(ends))),
                _ => None,
            });
            let kinds: BTreeSet<(bool, bool)> = kinds.collect();
            let second = second.map_or(0, |second| second.tape.ops().len());
            let entries = kinds.iter().map(|(_, curved)| if *curved { second } else { all }).sum();
            node.by.iter().map(of_step).fold([entries, 0], both)
        };
        tree.nodes.iter().map(of_node).fold([0; 2], both)
    }

    /// The matrices that are looked at for what quantities change of rows together, at one vertex.
    fn together_of(&self, test: Option<&Test>, by: &Evidence, ends: &str) -> usize {
        let (Some(test), Some(derived)) = (test, &self.problem.derived) else { return 0 };
        let all = match by {
            Evidence::Inside(by, ..) | Evidence::Turned(by, ..) => {
                return self.together_of(Some(test), by, ends)
            }
            Evidence::Together(_, all, _) => all,
            _ => return 0,
        };
        let named = self.problem.differing().zip(ends.chars());
        let together: BTreeSet<usize> =
            named.filter(|(_, end)| *end == '=').map(|(j, _)| j).collect();
        let of_row = |row: Vec<Formula>| {
            let by = row.iter().filter_map(|f| derived.of.get(f)).flatten().map(|(j, _)| *j);
            let own: BTreeSet<usize> = by.filter(|j| together.contains(j)).collect();
            1usize << (2 * own.len().min(MOST_TOGETHER))
        };
        let rows = all.iter().zip(test.rows(&self.rows));
        rows.filter(|(own, _)| !own.is_empty()).map(|(_, row)| of_row(row)).sum()
    }
}

/// The operations of a test on its matrices and on all their sign vertices, at one vertex of `m` coordinates.
fn at_vertices(test: &Test, rows: &[Row<Formula>], m: usize) -> usize {
    let n = test.rows(rows).len();
    let (k, matrices) = match test {
        Test::AtLeast(_) | Test::Beyond(..) | Test::Apart(_) | Test::Accuracy(_) => return 0,
        Test::Solve(_) => (n, 1),
        Test::Conditioning(_) | Test::Curvature(_) => (m, 2),
        _ => (m, 1),
    };
    let signs = (1usize << k) / 2;
    matrices * (n * k * k + signs * k * k * k / 6)
}
