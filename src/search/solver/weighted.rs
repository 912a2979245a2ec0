//! A condition number of machines with tolerances, of which each has a `mu` of its own.
//!
//! With one `mu` for all, what is shown is the greatest singular value of any machine over the least one of any other. Its
//! square over `c^2` is convex in the rows, that of the least one concave, and both are nearly so in the tolerances: an affine
//! `mu` is between them wherever the one is below the other.

use super::apart::{at_place, times, Stretched, LENGTHS_OF_SECOND_ORDER};
use super::evidence::Over;
use super::fan::BITS;
use super::rows::{exponent, Form};
use nalgebra::{DMatrix, DVector};
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::{self, Half};
use std::collections::{BTreeMap, BTreeSet};

/// Where what a step changes of `mu` is, from what it changes of the upper bound to what of the lower one.
const BETWEEN: f64 = 0.4;
/// Lengths of directions across which `mu` grows, in sixteenths.
const ACROSS: [f64; 4] = [96.0, 128.0, 64.0, 160.0];
/// Lengths of the direction of the upper bound, from the worst machine, and from that in the middle.
const LENGTHS: [&[f64]; 2] = [&[16384.0, 1024.0, 256.0, 64.0], &[256.0, 64.0]];
/// `mu` is tried at multiples of a part of the way between what both bounds allow.
const PARTS: usize = 8;

/// By the parameter and the row, what a step changes of `M^T M`.
type Changes = BTreeMap<(usize, usize), DMatrix<f64>>;

/// For each quantity by which machines differ where the one machine is, and the way to its other end.
type Steps = BTreeMap<usize, [f64; 2]>;

/// `mu_0, .., mu_m`, for each row its weights by parameters, and the binary places of all.
type Weighted = (Vec<i64>, Vec<BTreeMap<usize, i64>>, u32);

/// What is so of the worst machine.
struct Machine {
    /// `c^2`.
    bound: f64,
    least: Stretched,
    most: Stretched,
    /// Where `M` is least, and where it is greatest.
    changes: [Changes; 2],
    /// `mu_0, .., mu_m`, from the lower bound to the upper one.
    mus: [Vec<f64>; PARTS],
}

impl Over<'_> {
    /// Both bounds of a condition number, where tolerances fail next to the worst vertex with one `mu`.
    pub(super) fn with_mu_of_each(&self, test: &Test, c_squared: Formula) -> Option<Evidence> {
        let bound = self.centre(c_squared)?;
        let along = |most| {
            let found = self.most_stretched(test, most)?;
            Some(found.along(found.directions.first()?.clone()))
        };
        let ends = self.worst_machine(&along(false)?.and(&along(true)?, bound.recip()), true)?;
        let by = self.of_second_order(test).unwrap_or_default();
        let middle = self.to_second_order(&self.middle_machine(true), &by);
        let ends = self.to_second_order(&ends, &by);
        let (steps, none) = (self.steps(&ends)?, vec![0; self.m()]);
        let machine =
            |formulas: &test::Over<'_, _>| Over { formulas, ..*self }.machine(test, bound, &steps);
        let both = [none.clone(), none];
        let machine = self.prover.checker.apart(self.formulas, (&ends, &both), machine)??;
        // First, all directions but that of the greatest may be worst.
        let several = BTreeSet::from([directions_of(&machine), self.m() - 1].map(|n| n.max(1)));
        let from = ([&ends[..], &middle], &steps);
        several.into_iter().rev().find_map(|n| self.weighted(test, &machine, from, n))
    }

    /// The same from this machine, where the `n` directions along which it is least may be worst.
    fn weighted(
        &self,
        test: &Test,
        Machine { bound, least, most, changes, mus }: &Machine,
        ([ends, middle], steps): ([&str; 2], &Steps),
        n: usize,
    ) -> Option<Evidence> {
        let Test::Conditioning(c_squared) = test else { return None };
        let plane = DMatrix::from_columns(least.directions.get(..n)?);
        let (v, w, none) = (most.directions.first()?, least.directions.first()?, vec![0; self.m()]);
        let changed = changed_between(changes, (&plane, v), *bound);
        let below: Vec<[Vec<i64>; 2]> = match least.directions.get(n) {
            Some(d) if n > 1 => ACROSS.map(|length| [none.clone(), times(d, length)]).into(),
            _ => LENGTHS_OF_SECOND_ORDER.map(|length| [times(w, length), none.clone()]).into(),
        };
        // The more `mu` is, the easier is the upper bound, and the harder the lower one.
        let (mut from, mut to) = (0, PARTS);
        while let Some(part) = Some((from + to) / 2).filter(|part| *part > from) {
            let (mu, weights, places) = self.in_integers(&mus[part], &changed, steps)?;
            let shown = |upper, (ends, directions): (&str, &[Vec<i64>]), vertex| {
                let half = Some(Half { mu: (&mu, places), weights: &weights, upper });
                let formulas = test::Over { half, inside: None, ..*self.formulas };
                Over { formulas: &formulas, ..*self }.apart_along(test, (ends, directions), vertex)
            };
            let above = |(ends, length): (&str, f64)| {
                shown(Some(*c_squared), (ends, &[times(v, length)]), most.vertex)
            };
            let machines = [ends, middle].into_iter().zip(LENGTHS);
            let mut all =
                machines.flat_map(|(ends, all)| all.iter().map(move |length| (ends, *length)));
            let upper = all.find_map(above);
            let lower = below.iter().find_map(|all| shown(None, (ends, all), least.vertex));
            match (lower, upper) {
                (Some(lower), Some(upper)) => {
                    let of_row = |row: &BTreeMap<usize, i64>| {
                        steps.keys().map(|j| row.get(j).copied().unwrap_or(0)).collect()
                    };
                    let weights = weights.iter().map(of_row).collect();
                    let [lower, upper] = [lower, upper].map(Box::new);
                    return Some(Evidence::Between(mu, places, weights, lower, upper));
                }
                (None, Some(_)) => from = part,
                (Some(_), None) => to = part,
                (None, None) => return None,
            }
        }
        None
    }

    /// Of the one machine.
    fn machine(&self, test: &Test, bound: f64, steps: &Steps) -> Option<Machine> {
        let (least, most) = (self.most_stretched(test, false)?, self.most_stretched(test, true)?);
        let changes = [self.changes(&least, steps)?, self.changes(&most, steps)?];
        let mut mus = [const { Vec::new() }; PARTS];
        for (part, mu) in mus.iter_mut().enumerate() {
            *mu = self.mu(bound, Form::Plain, part as f64 / PARTS as f64)?;
        }
        Some(Machine { bound, least, most, changes, mus })
    }

    /// From the machine that these characters name.
    fn steps(&self, ends: &str) -> Option<Steps> {
        let step = |(end, j): (char, usize)| {
            let (low, high) = *self.prover.of_one_scale().get(j)?;
            let step = match end {
                '-' | '<' => [low, high - low],
                '+' | '>' => [high, low - high],
                _ => [0.5 * (low + high), 0.5 * (high - low)],
            };
            Some((j, step))
        };
        ends.chars().zip(self.problem().differing()).map(step).collect()
    }

    /// What steps change of `M^T M = sum_i A_i^T A_i/D_i`.
    fn changes(&self, found: &Stretched, steps: &Steps) -> Option<Changes> {
        let values = self.prover.checker.derived(self.formulas.place, self.prover.has_scales())?;
        let of = &self.problem().derived.as_ref()?.of;
        let one = self.formulas.tolerances?;
        let is_second = |j| one.second.as_ref().is_some_and(|second| second.by.contains(&j));
        let mut all = Changes::new();
        for (i, row) in found.rows.iter().enumerate() {
            let (a, d) = (found.values.a.row(i).transpose(), found.values.d[i]);
            for (k, f) in row.a.iter().chain([&row.d]).enumerate() {
                for (j, derivative) in of.get(f)? {
                    let values = if is_second(*j) { one.machine } else { values };
                    let [_, step] = *steps.get(j)?;
                    let value = at_place(values.of(*derivative)?, &found.place) * step;
                    let change = match k == a.len() {
                        true => &a * a.transpose() * (-value / (d * d)),
                        false => {
                            let mut s = DVector::zeros(a.len());
                            s[k] = value / d;
                            &a * s.transpose() + &s * a.transpose()
                        }
                    };
                    let zero = || DMatrix::zeros(a.len(), a.len());
                    *all.entry((*j, i)).or_insert_with(zero) += change;
                }
            }
        }
        Some(all)
    }

    /// `mu` with what each step changes of it, in integers over `2^places`.
    fn in_integers(
        &self,
        mu: &[f64],
        changed: &BTreeMap<(usize, usize), f64>,
        steps: &Steps,
    ) -> Option<Weighted> {
        let places = u32::try_from(BITS - exponent(mu[0])).ok()?;
        let scale = f64::from(places).exp2();
        let mut weights = vec![BTreeMap::new(); self.problem().legs.len()];
        let mut at_zero = mu[0];
        for ((j, i), nu) in changed {
            let [start, step] = *steps.get(j)?;
            let n = (nu / step * scale).round();
            if step != 0.0 && n != 0.0 {
                at_zero -= n / scale * start;
                weights.get_mut(*i)?.insert(*j, n as i64);
            }
        }
        let all = [&at_zero].into_iter().chain(&mu[1..]);
        Some((all.map(|mu| (mu * scale).round() as i64).collect(), weights, places))
    }
}

/// Along how many directions `M` may be least of some machine.
fn directions_of(Machine { least, changes: [by, _], .. }: &Machine) -> usize {
    let square = least.values.square();
    let along = |w: &DVector<f64>| (&square * w).dot(w);
    let w = &least.directions[0];
    let changed: f64 = by.values().map(|form| (form * w).dot(w).abs()).sum();
    least.directions.iter().take_while(|v| along(v) - along(w) <= changed).count()
}

/// By how much each step changes `mu`: between what it changes of both bounds.
fn changed_between(
    [by_lower, by_upper]: &[Changes; 2],
    (plane, v): (&DMatrix<f64>, &DVector<f64>),
    bound: f64,
) -> BTreeMap<(usize, usize), f64> {
    let between = |(at, form): (&(usize, usize), &DMatrix<f64>)| {
        let upper = (form * v).dot(v) / bound;
        let lower = (plane.transpose() * by_lower.get(at)? * plane).symmetric_eigenvalues().min();
        let between = upper + BETWEEN * (lower - upper);
        let is_between = lower >= upper && !(upper < 0.0 && between > 0.0);
        let between = if is_between { between } else { 0.0 };
        // Where several directions are worst, what makes the lower bound harder is lost along all of them.
        Some((*at, if plane.ncols() > 1 { between.min(0.0) } else { between }))
    };
    by_upper.iter().filter_map(between).collect()
}
