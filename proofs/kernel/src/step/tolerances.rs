//! Steps with tolerances apart.

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::certificate::Evidence;
use crate::control::{Control, Controls};
use crate::formula::{Formula, Op, Tape, Values};
use crate::quantity::Test;
use crate::slope::evaluate;
use crate::test::tolerances::{is_of_second_order, OfSecondOrder, Tolerances};
use crate::test::{width, Formulas, Half, Over, Place};
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// Whether these are directions for a test, or half of one, of `m` coordinates, one for each matrix; of other rows, of as many entries.
pub(super) fn are_for(
    directions: &[Vec<i64>],
    (test, half): (&Test, Option<Half<'_>>),
    m: usize,
) -> bool {
    // Across, too, where `mu` depends on tolerances.
    let is_two = |half: Half<'_>| half.upper.is_none() && !half.weights.is_empty();
    let expected = match test {
        Test::AtLeast(_) | Test::Beyond(..) => vec![],
        Test::Conditioning(_) if half.is_none_or(is_two) => vec![m, m],
        Test::Least(rows, _) | Test::Greatest(rows, _) => vec![width(rows)],
        _ => vec![m],
    };
    directions.iter().map(Vec::len).eq(expected)
}

/// Whether the evidence for a test looks at nothing but formulas at vertices or control points, and at the
/// workspace's and the orientations' own inequalities, which no tolerance changes.
pub(super) fn is_of_vertices(test: &Test, evidence: &Evidence) -> bool {
    use Evidence::{Conditioning, Control, Inside, Lower, Negative, Rank, Together, Turned};
    match evidence {
        Control(inner) | Inside(inner, ..) | Turned(inner, ..) => is_of_vertices(test, inner),
        Evidence::Test => !matches!(test, Test::Apart(_) | Test::Curvature(_)),
        Together(inner, ..) => matches!(**inner, Lower(_) | Evidence::Test),
        other => matches!(other, Lower(_) | Rank(_) | Conditioning(..) | Negative),
    }
}

impl<E: Enclosure> Checker<'_, E> {
    /// The parameters with directions of one scale: of a component of one sign, where 0 is among the values of the
    /// others, the end next to 0.
    ///
    /// **Lemma (scale).** Every machine has all formulas in common with one within these. *Proof.* Formulas are made of
    /// the unit vector along a direction, which `s > 0` times the direction has too. With the `s` that puts the component at that end,
    /// `s <= 1`, and the others are, between 0 and what they were, in their ranges. Nothing else is made of them. ∎ Without 0
    /// among them it would be unsound: no direction within `{1} x {1}` is along `(2, 1)` of `[1, 2] x {1}`.
    pub(super) fn of_one_scale(&self) -> Vec<E::Number> {
        let (e, mut all) = (self.arithmetic, self.parameters.clone());
        let ends = |f: &Formula| Some(e.ends(&self.constant.of(*f)?.range));
        let is_not_positive = |x: &E::Number| e.neg(x).is_some_and(|x| e.is_nonnegative(&x));
        let has_zero = |[lo, hi]: [_; 2]| is_not_positive(&lo) && e.is_nonnegative(&hi);
        for direction in &self.problem.directions {
            let mut others = direction.iter().filter(|f| !ends(f).is_some_and(has_zero));
            let (Some(f), None) = (others.next(), others.next()) else { continue };
            if let (Op::Parameter(j), Some([lo, hi])) = (self.problem.tape.op(*f), ends(f)) {
                all[j] = if is_not_positive(&hi) { hi } else { lo };
            }
        }
        all
    }

    /// The formulas of all machines with their derivatives by tolerances, where there are some; of directions of one scale,
    /// where it says so.
    pub fn derived<'p>(
        &self,
        place: &'p Place<'_, E::Number>,
        of_one_scale: bool,
    ) -> Option<&'p Formulas<E>> {
        let tape = &self.problem.derived.as_ref()?.tape;
        Some(self.run_once(place, &place.derived, (tape, &Values::default()), of_one_scale))
    }

    /// The same with second derivatives, where these are known.
    pub fn second<'p>(
        &self,
        place: &'p Place<'_, E::Number>,
        of_one_scale: bool,
    ) -> Option<&'p Formulas<E>> {
        let tape = &self.problem.derived.as_ref()?.second.as_ref()?.tape;
        let known = self.derived(place, of_one_scale)?;
        Some(self.run_once(place, &place.second, (tape, known), of_one_scale))
    }

    /// A tape of all machines, or of those with directions of one scale, run once a cell.
    fn run_once<'p>(
        &self,
        place: &Place<'_, E::Number>,
        [ranges, scaled]: &'p [OnceCell<Formulas<E>>; 2],
        (tape, known): (&Tape, &Formulas<E>),
        of_one_scale: bool,
    ) -> &'p Formulas<E> {
        let (values, parameters) = match of_one_scale {
            true => (scaled, &self.scaled_parameters),
            false => (ranges, &self.parameters),
        };
        let slopes = self.slopes(place.edges.len());
        let coordinate = |k: usize| slopes.coordinate(k, place.edges.get(k)?.clone());
        let parameter = |j: usize| slopes.constant(parameters.get(j)?.clone());
        values.get_or_init(|| tape.run_parts(&slopes, (None, known), coordinate, parameter))
    }

    /// What is so with tolerances apart, by the lemmas of [`Tolerances`]. The one machine has the least
    /// value of each quantity with two ends, or name, the greatest or one in the middle, as its character of
    /// `ends` says: `-`, `+` or `0`, or `<`, `>` or `=` of second order. Where one is `1`, directions are of one scale, and
    /// that is what it has.
    pub fn apart<T>(
        &self,
        over: &Over<'_, E>,
        (ends, directions): (&str, &[Vec<i64>]),
        then: impl FnOnce(&Over<'_, E>) -> T,
    ) -> Option<T> {
        if !over.is_plain() {
            return None;
        }
        let of_one_scale = ends.contains('1');
        let all = if of_one_scale { &self.scaled_parameters } else { &self.parameters };
        let values = self.derived(over.place, of_one_scale)?;
        let derived = self.problem.derived.as_ref()?;
        let (mut named, mut by) = (ends.chars(), BTreeSet::new());
        let start = |(at, x): (usize, &E::Number)| {
            if !self.problem.inputs.get(at)?.differs() {
                return Some((x.clone(), Vec::new()));
            }
            let end = named.next()?;
            by.extend(is_of_second_order(end).then_some(at));
            start(self.arithmetic, x, end)
        };
        let own: Vec<_> = all.iter().enumerate().map(start).collect::<Option<_>>()?;
        let (starts, steps): (Vec<E::Number>, Vec<Vec<E::Number>>) = own.into_iter().unzip();
        let tape = if by.is_empty() { &self.problem.tape } else { &derived.tape };
        let machine = evaluate(tape, &starts, over.slopes, over.place.edges);
        let second = match by.is_empty() {
            true => None,
            false => {
                let known = derived.second.as_ref().filter(|known| by.is_subset(&known.by))?;
                let values = self.second(over.place, of_one_scale)?;
                Some(OfSecondOrder { by, values, of: &known.of })
            }
        };
        let tolerances = Tolerances {
            machine: &machine,
            all,
            parameters: &starts,
            controls: None,
            steps: &steps,
            derivatives: &derived.of,
            second,
            directions,
        };
        let over = Over { values, inside: None, tolerances: Some(&tolerances), ..*over };
        named.next().is_none().then(|| then(&over))
    }

    /// The formulas of a test at control points, where it has such: of all machines, with derivatives where
    /// tolerances are apart.
    pub fn controls(&self, over: &Over<'_, E>, test: &Test) -> Option<Controls<E::Number>> {
        let all = if over.tolerances.is_some() { &self.derived } else { &self.controls };
        let parameters = over.tolerances.map_or(&self.parameters[..], |tolerances| tolerances.all);
        found(all, test)?.values(self.arithmetic, parameters, over.place.edges)
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
        if tolerances.second.is_some() {
            return None;
        }
        let own = found(&self.controls, test)?;
        let own = own.values(self.arithmetic, tolerances.parameters, over.place.edges)?;
        let tolerances = Tolerances { controls: Some(&own), second: None, ..*tolerances };
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
        '-' | '<' => (lo.clone(), vec![up_from(&lo)?]),
        '+' | '>' => (hi.clone(), vec![e.neg(&up_from(&lo)?)?]),
        '0' | '=' => {
            let [middle, _] = e.ends(&e.halve(&e.add(&lo, &hi)?)?);
            let half = up_from(&middle)?;
            let back = e.neg(&half)?;
            (middle, vec![half, back])
        }
        // It does not differ.
        '1' => (!e.is_positive(&e.sub(&hi, &lo)?)).then(|| (lo, Vec::new()))?,
        _ => return None,
    })
}
