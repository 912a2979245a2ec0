//! The tests at control points, of platforms that turn: rows and bounds times the weight `w`.
//!
//! With `w A_i`, `w D_i` for `A_i` and `D_i`, `M` becomes `sqrt(w) M`: bounds on its singular values are
//! to be taken times `w`, for squares, and `w >= 1` at every point.

use crate::arithmetic::Enclosure;
use crate::certificate::{Evidence, Step, Tree};
use crate::check::{Checker, Place};
use crate::control::{At, Control};
use crate::formula::Formula;
use crate::problem::Problem;
use crate::quantity::Test;
use crate::test::{is_lower, is_upper, without_d, Multiplier, Row, MOST_PLACES};

impl Problem {
    /// The scaled rows, if all legs have them.
    fn scaled(&self) -> Option<Vec<&Row<Formula>>> {
        self.legs.iter().map(|leg| leg.scaled.as_ref()).collect()
    }

    /// Of each test the formulas that it needs at control points.
    pub(crate) fn controls(&self) -> Vec<(Test, Control)> {
        let Some(weight) = self.weight else { return Vec::new() };
        let own = |test| {
            let rows = || self.scaled().unwrap_or_default().into_iter();
            let all = || rows().flat_map(|row| row.a.iter().copied().chain([row.d]));
            let mut wanted: Vec<Formula> = match test {
                Test::SigmaMin(f) | Test::SigmaMax(f) | Test::Conditioning(f) => {
                    all().chain([weight, f]).collect()
                }
                Test::AtLeast(f) => vec![f],
                Test::Beyond(..) => Vec::new(),
            };
            wanted.extend(self.turned);
            wanted.extend(self.inside.as_ref().map(|inside| inside.g));
            (test, Control::new(&self.tape, self.dimension(), &wanted))
        };
        self.obligations.iter().map(|obligation| own(obligation.test)).collect()
    }
}

/// A non-negative formula and its multiple over `2^places`.
type Less = (Formula, i64, u32);

impl<E: Enclosure> Checker<'_, E> {
    /// Whether something holds at all control points of the formulas of a test: the scaled rows and the
    /// weight, or the formula; and the workspace's and the orientations' own inequalities.
    pub fn at_controls(
        &self,
        place: &Place<'_, E::Number>,
        test: Test,
        holds: impl FnMut(&At<'_, E::Number>) -> bool,
    ) -> bool {
        let control = self.controls.iter().find(|(own, _)| *own == test);
        control.is_some_and(|(_, control)| {
            control.all(self.arithmetic, &self.parameters, place.edges, holds)
        })
    }

    /// Evaluations of formulas that a tree asks for at control points.
    pub(crate) fn work_at_controls(&self, tree: &Tree) -> usize {
        let steps = tree.nodes.iter().flat_map(|node| &node.by);
        let work = |Step(obligation, evidence): &Step| match evidence {
            Evidence::Control(_) => {
                self.controls.get(*obligation).map_or(0, |(_, control)| control.work())
            }
            _ => 0,
        };
        steps.map(work).fold(0, usize::saturating_add)
    }

    /// Whether the evidence shows a test at control points. A formula that is not negative in the
    /// workspace, and of their form, is subtracted by its own values there: their weighted sum is its
    /// value, so that it need not be concave.
    pub(crate) fn shows_at_controls(
        &self,
        place: &Place<'_, E::Number>,
        test: Test,
        evidence: &Evidence,
    ) -> bool {
        let Some((evidence, less)) = self.less(evidence) else { return false };
        let rows = self.problem.scaled();
        self.at_controls(place, test, |at| {
            let holds = match (test, evidence) {
                (Test::SigmaMin(kappa), Evidence::Lower(y)) => {
                    let kappa = at.constant(kappa);
                    kappa.and_then(|kappa| self.lower(at, &rows, (y, &less), Some(kappa)))
                }
                (Test::SigmaMin(kappa), Evidence::Rank(y)) if self.is_zero(kappa) => {
                    self.lower(at, &rows, (y, &less), None)
                }
                (Test::SigmaMax(k), Evidence::Test) => {
                    at.constant(k).and_then(|k| self.upper(at, &rows, &less, k))
                }
                (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                    self.conditioned(at, &rows, (y, mu, &less), c)
                }
                (Test::AtLeast(f), Evidence::Test) => {
                    let rest = at.of(f).and_then(|f| self.rest(at, f, &less));
                    rest.map(|rest| self.arithmetic.is_nonnegative(&rest))
                }
                _ => None,
            };
            holds.unwrap_or(false)
        })
    }

    /// The evidence proper, and what it is less.
    fn less<'e>(&self, mut evidence: &'e Evidence) -> Option<(&'e Evidence, Vec<Less>)> {
        let mut all = Vec::new();
        loop {
            let (inner, g, multiple, places) = match evidence {
                Evidence::Turned(inner, multiple, places) => {
                    (inner, self.problem.turned?, *multiple, *places)
                }
                Evidence::Inside(inner, multiple, places) => {
                    (inner, self.problem.inside.as_ref()?.g, *multiple, *places)
                }
                _ => return Some((evidence, all)),
            };
            if multiple < 0 || places >= MOST_PLACES || all.len() == 2 {
                return None;
            }
            all.push((g, multiple, places));
            evidence = inner;
        }
    }

    /// `x` less all of these.
    fn rest(&self, at: &At<'_, E::Number>, x: &E::Number, less: &[Less]) -> Option<E::Number> {
        let e = self.arithmetic;
        less.iter().try_fold(x.clone(), |rest, &(g, multiple, places)| {
            e.sub(&rest, &e.dyadic(multiple, places, at.of(g)?)?)
        })
    }

    /// The rows, all `D_i > 0`.
    fn rows_at(
        &self,
        at: &At<'_, E::Number>,
        rows: &Option<Vec<&Row<Formula>>>,
    ) -> Option<Vec<Row<E::Number>>> {
        let row = |row: &&Row<Formula>| {
            let a = row.a.iter().map(|&a| at.of(a).cloned()).collect::<Option<_>>()?;
            let d = at.of(row.d).filter(|d| self.arithmetic.is_positive(d))?;
            Some(Row { a, d: d.clone() })
        };
        rows.as_ref()?.iter().map(row).collect()
    }

    /// `Y^T A + A^T Y - Y^T D Y - kappa^2 w I`; without `kappa`, `Y^T A + A^T Y`.
    fn lower(
        &self,
        at: &At<'_, E::Number>,
        rows: &Option<Vec<&Row<Formula>>>,
        (y, less): (&Multiplier, &[Less]),
        kappa_squared: Option<&E::Number>,
    ) -> Option<bool> {
        let e = self.arithmetic;
        let rows = self.rows_at(at, rows)?;
        let (rows, bound) = match kappa_squared {
            Some(kappa) => (rows, e.neg(&e.mul(kappa, at.of(self.problem.weight?)?)?)?),
            None => (without_d(e, rows)?, e.integer(0)?),
        };
        Some(is_lower(e, self.problem.dimension(), &rows, &self.rest(at, &bound, less)?, y))
    }

    /// `[[D, A], [A^T, k^2 w I]]`.
    fn upper(
        &self,
        at: &At<'_, E::Number>,
        rows: &Option<Vec<&Row<Formula>>>,
        less: &[Less],
        k_squared: &E::Number,
    ) -> Option<bool> {
        let e = self.arithmetic;
        let bound = e.mul(k_squared, at.of(self.problem.weight?)?)?;
        let rows = self.rows_at(at, rows)?;
        Some(is_upper(e, self.problem.dimension(), &rows, &self.rest(at, &bound, less)?))
    }

    /// `sigma_min^2 >= mu` and `sigma_max^2 <= c^2 mu` for one `mu > 0`.
    fn conditioned(
        &self,
        at: &At<'_, E::Number>,
        rows: &Option<Vec<&Row<Formula>>>,
        (y, mu, less): (&Multiplier, &[i64], &[Less]),
        c_squared: Formula,
    ) -> Option<bool> {
        let e = self.arithmetic;
        let &[mu] = mu else { return None };
        let mu = e.dyadic(mu, Some(y.places).filter(|&p| p < MOST_PLACES)?, &e.integer(1)?)?;
        let greatest = e.mul(at.constant(c_squared)?, &mu)?;
        let holds = e.is_positive(&mu)
            && self.lower(at, rows, (y, less), Some(&mu))?
            && self.upper(at, rows, less, &greatest)?;
        Some(holds)
    }
}
