//! Steps with tolerances apart.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::certificate::Evidence;
use crate::control::{Control, Controls};
use crate::quantity::Test;
use crate::slope::evaluate;
use crate::test::tolerances::Tolerances;
use crate::test::{width, Formulas, Over, Place};

/// Whether these are directions for a test, or half of one, of `m` coordinates, one for each matrix; of other rows, of as many entries.
pub(super) fn are_for(directions: &[Vec<i64>], (test, half): (&Test, bool), m: usize) -> bool {
    let expected = match test {
        Test::AtLeast(_) | Test::Beyond(..) => vec![],
        Test::Conditioning(_) if !half => vec![m, m],
        Test::Least(rows, _) | Test::Greatest(rows, _) => vec![width(rows)],
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
    pub fn derived<'p>(&self, place: &'p Place<'_, E::Number>) -> Option<&'p Formulas<E>> {
        let tape = &self.problem.derived.as_ref()?.tape;
        Some(place.derived.get_or_init(|| {
            evaluate(tape, &self.parameters, self.slopes(place.edges.len()), place.edges)
        }))
    }

    /// What is so with tolerances apart, by the lemma of [`Tolerances`]. The one machine has the least
    /// value of each quantity with two ends, or name, the greatest or one in the middle, as its character of
    /// `ends` says: `-`, `+` or `0`.
    pub fn apart<T>(
        &self,
        over: &Over<'_, E>,
        (ends, directions): (&str, &[Vec<i64>]),
        then: impl FnOnce(&Over<'_, E>) -> T,
    ) -> Option<T> {
        if !over.is_plain() {
            return None;
        }
        let values = self.derived(over.place)?;
        let derivatives = &self.problem.derived.as_ref()?.of;
        let mut named = ends.chars();
        let start = |(at, x): (usize, &E::Number)| match self.problem.inputs.get(at)?.differs() {
            true => start(self.arithmetic, x, named.next()?),
            false => Some((x.clone(), Vec::new())),
        };
        let all: Vec<_> = self.parameters.iter().enumerate().map(start).collect::<Option<_>>()?;
        let (starts, steps): (Vec<E::Number>, Vec<Vec<E::Number>>) = all.into_iter().unzip();
        let machine = evaluate(&self.problem.tape, &starts, over.slopes, over.place.edges);
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
    pub fn controls(&self, over: &Over<'_, E>, test: &Test) -> Option<Controls<E::Number>> {
        let all = if over.tolerances.is_some() { &self.derived } else { &self.controls };
        found(all, test)?.values(self.arithmetic, &self.parameters, over.place.edges)
    }

    /// What is so at control points, of formulas there.
    pub fn at_controls<T>(
        &self,
        over: &Over<'_, E>,
        test: &Test,
        then: impl FnOnce(&Over<'_, E>) -> T,
    ) -> Option<T> {
        if over.controls.is_some() || over.inside.is_some() {
            return None;
        }
        let all = self.controls(over, test)?;
        let Some(tolerances) = over.tolerances else {
            return Some(then(&Over { controls: Some(&all), inside: None, ..*over }));
        };
        let own = found(&self.controls, test)?;
        let own = own.values(self.arithmetic, tolerances.parameters, over.place.edges)?;
        let tolerances = Tolerances { controls: Some(&own), ..*tolerances };
        let over =
            Over { controls: Some(&all), inside: None, tolerances: Some(&tolerances), ..*over };
        own.is_like(&all).then(|| then(&over))
    }
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
