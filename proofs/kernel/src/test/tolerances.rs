//! Tolerances apart: one machine of the tolerance, and how all others differ from it.
//!
//! Ranges over all machines take each entry of a row by itself, as if it had tolerances of its own.
//! Here a quantity changes all formulas at once, as it does.

use super::Over;
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::Triangle;
use crate::formula::{Formula, Values};
use crate::slope::Slope;
use std::collections::{BTreeMap, HashMap};

/// Derivatives of a formula, each by the parameter of this number.
pub type Derivatives = HashMap<Formula, Vec<(usize, Formula)>>;

/// How a quantity differs from that of the one machine: by `lambda` times `by`.
#[derive(Clone, Debug)]
pub struct Step<N> {
    /// The greatest difference.
    pub by: N,
    /// Whether `lambda` is in `[-1, 1]`; else in `[0, 1]`.
    pub both_ways: bool,
}

/// How machines differ from one of them.
///
/// **Lemma (tolerances).** Let `theta_0` be the one machine, and every other one
/// `theta_j = theta_0j + lambda_j r_j`, with `lambda_j` as [`Step`] says. Let the formulas be defined on
/// the cell for all of them. At every point `x` of the cell, for every machine and each formula `f`,
///
/// ```text
/// f(x, theta) = sum_v w_v (f_v + sum_j lambda_j s_vj)
/// ```
///
/// with the weights `w_v` of [`Vertex`], `f_v` of `theta_0`, and `s_vj` in `r_j` times the vertex value of
/// the derivative of `f` by `theta_j`, for some machine. *Proof.* By the mean value theorem
/// `f(x, theta) - f(x, theta_0) = sum_j (theta_j - theta_0j) d_j f(x, theta')` with `theta'` between both.
/// It may be another for each formula; the `lambda_j` are not, and the weights depend on `x` alone. ∎
/// With derivatives of the one machine alone it would be unsound: `theta^2` has none at 0, and is 1 at
/// the end of `[-1, 1]`.
pub struct Tolerances<'a, E: Enclosure> {
    /// The formulas of the one machine.
    pub machine: &'a Values<Slope<E::Number>>,
    /// For each parameter how it differs.
    pub steps: &'a [Step<E::Number>],
    /// The derivatives of the formulas that tests are made of, all of them.
    pub derivatives: &'a Derivatives,
    /// Directions, in which what is lost is least; any will do.
    pub directions: &'a [Vec<i64>],
}

/// What a quantity changes of some formulas, `s_vj` of each, and whether both ways.
#[derive(Clone)]
pub struct Change<T> {
    /// Of each formula.
    pub s: T,
    /// Whether `lambda_j` is in `[-1, 1]`; else in `[0, 1]`.
    pub both_ways: bool,
}

impl<T> Change<T> {
    /// The same, of what is made of these.
    pub(super) fn made<U>(self, make: impl FnOnce(T) -> Option<U>) -> Option<Change<U>> {
        Some(Change { s: make(self.s)?, both_ways: self.both_ways })
    }
}

impl<E: Enclosure> Over<'_, E> {
    /// At a vertex, for each quantity on which one of the formulas depends what it changes of them, in
    /// the order of parameters.
    pub(super) fn changes(
        &self,
        formulas: &[Formula],
        v: Vertex,
    ) -> Option<Vec<Change<Vec<E::Number>>>> {
        let e = self.slopes.arithmetic;
        let Some(tolerances) = self.tolerances else { return Some(Vec::new()) };
        let mut all: BTreeMap<usize, Change<Vec<E::Number>>> = BTreeMap::new();
        for (k, formula) in formulas.iter().enumerate() {
            // It is defined for all machines.
            self.of(*formula)?;
            for (j, derivative) in tolerances.derivatives.get(formula)? {
                let Step { by, both_ways } = tolerances.steps.get(*j)?;
                let change = e.mul(by, &v.value(&self.slopes, self.of(*derivative)?)?)?;
                let zero = e.integer(0)?;
                let none = || Change { s: vec![zero; formulas.len()], both_ways: *both_ways };
                *all.entry(*j).or_insert_with(none).s.get_mut(k)? = change;
            }
        }
        Some(all.into_values().collect())
    }

    /// At a vertex, the most by which tolerances lessen a sum of formulas, some subtracted.
    pub(super) fn greatest_loss(&self, parts: &[(Formula, bool)], v: Vertex) -> Option<E::Number> {
        let e = self.slopes.arithmetic;
        let formulas: Vec<Formula> = parts.iter().map(|&(f, _)| f).collect();
        let zero = e.integer(0)?;
        let changes = self.changes(&formulas, v)?;
        changes.iter().try_fold(zero.clone(), |sum, Change { s, both_ways }| {
            let mut terms = s.iter().zip(parts);
            let own =
                terms.try_fold(zero.clone(), |own, (s, &(_, subtracted))| match subtracted {
                    true => e.sub(&own, s),
                    false => e.add(&own, s),
                })?;
            let [_, less] = e.ends(&e.neg(&own)?);
            match both_ways {
                true => e.add(&sum, &e.magnitude(&own)?),
                false if e.is_positive(&less) => e.add(&sum, &less),
                false => Some(sum),
            }
        })
    }

    /// One of the directions, of `n` components.
    pub(super) fn direction(
        &self,
        which: fn(&[Vec<i64>]) -> Option<&Vec<i64>>,
        n: usize,
    ) -> Option<Vec<E::Number>> {
        let direction = which(self.tolerances?.directions).filter(|own| own.len() == n)?;
        direction.iter().map(|&x| self.slopes.arithmetic.integer(x)).collect()
    }
}

/// `T` less, for each change `s` with some `tau > 0`, `tau s s^T + e e^T/tau` if both ways, else
/// `p p^T/(2 tau)`, `p = tau s - e`.
///
/// **Lemma.** If this is positive definite for all `s` in their enclosures, so is
/// `T + sum_j lambda_j (e s_j^T + s_j e^T)`. *Proof.* `tau s s^T + e e^T/tau +- (e s^T + s e^T)` is
/// `z z^T`, `z = tau^(1/2) s +- tau^(-1/2) e`, so not negative; and neither is
/// `p p^T/(2 tau) + (e s^T + s e^T) = (tau s + e)(tau s + e)^T/(2 tau)`. ∎ At each vertex; a convex
/// combination is positive definite too. With half of the second it would be unsound: `T = 1`, `e = 1`,
/// `s = -1`, `tau = 1`.
///
/// Along `w` nothing is lost but what has to be if `tau = |e . w|/|s . w|`, and anything may be where one
/// of these is zero. So the 1-norms are added to both: the longer `w`, the less they count.
pub(super) fn less_changes<E: Enclosure>(
    e: &E,
    mut t: Triangle<E::Number>,
    fixed: &[E::Number],
    changes: &[Change<Vec<E::Number>>],
    direction: &[E::Number],
) -> Option<Triangle<E::Number>> {
    let (zero, one) = (e.integer(0)?, e.integer(1)?);
    let size = |x: &[E::Number]| {
        let mut terms = x.iter().zip(direction);
        let along = terms.try_fold(zero.clone(), |sum, (x, w)| e.add(&sum, &e.mul(x, w)?))?;
        x.iter().try_fold(e.magnitude(&along)?, |sum, x| e.add(&sum, &e.magnitude(x)?))
    };
    let of_fixed = size(fixed)?;
    for Change { s, both_ways } in changes {
        let of_change = size(s)?;
        // One of the two is zero: nothing is changed.
        if !e.is_positive(&of_change) || !e.is_positive(&of_fixed) {
            continue;
        }
        let [tau, _] = e.ends(&e.ratio(&of_fixed, &one, &of_change)?);
        let inverse = e.recip(&tau)?;
        let grown: Vec<E::Number> = s.iter().map(|s| e.mul(&tau, s)).collect::<Option<_>>()?;
        let p = grown.iter().zip(fixed).map(|(s, x)| e.sub(s, x)).collect::<Option<Vec<_>>>()?;
        for (i, row) in t.iter_mut().enumerate() {
            for (entry, j) in row.iter_mut().zip(i..) {
                let lost = if *both_ways {
                    let of_fixed = e.mul(&inverse, &e.mul(fixed.get(i)?, fixed.get(j)?)?)?;
                    e.add(&e.mul(grown.get(i)?, s.get(j)?)?, &of_fixed)?
                } else {
                    e.halve(&e.mul(&inverse, &e.mul(p.get(i)?, p.get(j)?)?)?)?
                };
                *entry = e.sub(entry, &lost)?;
            }
        }
    }
    Some(t)
}
