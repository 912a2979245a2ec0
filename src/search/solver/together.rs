//! What tolerances of a row change together, where each by itself takes off too much.
//!
//! Let `T_c` be what a test makes of a row where its quantities are at a corner `c` of their tolerances. What is wanted are matrices
//! `Q` of the rows, not greater than all `T_c` of each, with a sum beyond the bound: linear matrix inequalities, in `Q` and in the
//! multiplier too.

use super::apart::{at_place, in_integers, Stretched};
use super::doubles::{half_width, middle, Pair};
use super::evidence::Over;
use super::inequalities::{more_than, Affine};
use super::rows::{exponent, rounded};
use nalgebra::{DMatrix, DVector};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::definite::Vector;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::tolerances::{Quantities, MOST_TOGETHER};
use orthocert_kernel::test::{self, Multiplier, Row};
use std::collections::{BTreeMap, BTreeSet};

/// Bits of multipliers, and of what is taken off.
const BITS: i32 = 20;
/// Of each row so many quantities are looked at together, of those that change rows by this part of the most, or more.
const MOST: usize = 4;
const PART: f64 = 0.02;
/// Of so many quantities of a row all squares are looked at; of more all of them at once, and none.
const FEW: usize = 2;
/// So much of what is left goes to what is taken off.
const SLACK: f64 = 0.1;
/// Lengths of directions.
const LENGTHS: [f64; 2] = [1024.0, 64.0];

/// A row of one machine, and of those at corners of the tolerances that are looked at together.
struct Corners {
    own: Vec<f64>,
    /// At each vertex, the worst one first, and by how much that may differ.
    at: Vec<[Vec<f64>; 2]>,
    /// First those at the worst vertex.
    all: Vec<Vec<f64>>,
    first: usize,
    /// By how much each entry may differ from these.
    off: Vec<f64>,
}

impl Over<'_> {
    /// Evidence of which what is changed of each row is taken off together.
    pub(super) fn together(&self, test: &Test, most: bool) -> Option<Evidence> {
        let found = self.most_stretched(test, most)?;
        let worst = found.along(found.directions.first()?.clone());
        let by = self.changed_most(&found)?;
        let second = self.to_second_order(&self.worst_machine(&worst, true)?, &by);
        let second = second.replace(['<', '>'], "=");
        let formulas = test::Over { first: found.vertex, inside: None, ..*self.formulas };
        let apart = |directions: &[Vec<i64>], then: &dyn Fn(&Over<'_>) -> Option<Evidence>| {
            let then = |formulas: &test::Over<'_, _>| then(&Over { formulas, ..*self });
            self.prover.checker.apart(&formulas, (&second, directions), then)?
        };
        let foreseen = apart(&[vec![0; self.m()]], &|over| over.taken_together(test, &found))?;
        LENGTHS.into_iter().find_map(|length| {
            let directions = vec![in_integers(&found.directions[0], length)];
            let own = apart(&directions, &|over| over.shown(test, foreseen.clone()))?;
            Some(Evidence::Tolerances(Box::new(own), second.clone(), directions))
        })
    }

    /// The quantities that change rows most.
    fn changed_most(&self, found: &Stretched) -> Option<BTreeSet<usize>> {
        let values = self.prover.checker.derived(self.formulas.place, self.prover.has_scales())?;
        let of = &self.problem().derived.as_ref()?.of;
        let of_row = |(i, row): (usize, &Row<Formula>)| {
            let (mut all, d) = (BTreeMap::<usize, f64>::new(), found.values.d[i]);
            for (k, f) in row.a.iter().chain([&row.d]).enumerate() {
                // Of a row of M.
                let part = if k < row.a.len() { d.sqrt().recip() } else { 0.5 / d };
                for (j, derivative) in of.get(f)? {
                    let half = half_width(self.prover.of_one_scale().get(*j)?);
                    let value = at_place(values.of(*derivative)?, &found.place) * half * part;
                    *all.entry(*j).or_default() += value * value;
                }
            }
            let mut all: Vec<(usize, f64)> = all.into_iter().collect();
            all.sort_by(|a, b| b.1.total_cmp(&a.1));
            all.truncate(MOST);
            Some(all)
        };
        let rows: Vec<_> = found.rows.iter().enumerate().map(of_row).collect::<Option<_>>()?;
        let all = || rows.iter().flatten();
        let least = all().map(|(_, x)| *x).fold(0.0, f64::max) * PART * PART;
        let most = all().filter(|(_, x)| *x > least).map(|(j, _)| *j);
        Some(most.collect()).filter(|by: &BTreeSet<usize>| !by.is_empty())
    }

    /// Evidence that is foreseen to hold.
    fn taken_together(&self, test: &Test, found: &Stretched) -> Option<Evidence> {
        let vertex = self.formulas.vertices().nth(found.vertex)?;
        let rows = found.rows.iter().enumerate();
        let rows: Vec<Corners> =
            rows.map(|(i, row)| self.corners(i, row, vertex)).collect::<Option<_>>()?;
        let bound = self.bound_of(test)?;
        let (y, r) = match found.sign < 0.0 {
            false => lower(&rows, bound)?,
            true => (None, upper(&rows, bound)?),
        };
        let places = BITS - exponent(r.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs())));
        let places = u32::try_from(places).ok()?;
        let scale = f64::from(places).exp2();
        let r = r.iter().map(|r| r.iter().map(|x| (x * scale).round() as i64).collect()).collect();
        let inner = y.map_or(Evidence::Test, Evidence::Lower);
        Some(Evidence::Together(Box::new(inner), r, places))
    }

    /// The square of the bound.
    fn bound_of(&self, test: &Test) -> Option<f64> {
        match test {
            Test::SigmaMin(k) | Test::SigmaMax(k) => self.centre(*k),
            Test::Least(_, k) | Test::Greatest(_, k) => self.centre(*k),
            Test::Conditioning(_) => {
                let half = self.formulas.half?;
                let mu = self.mu_at_centre(half)?;
                half.upper.map_or(Some(mu), |c| Some(mu * self.centre(c)?))
            }
            _ => None,
        }
    }

    /// The corners at all vertices, each by what is changed there of the row at this one.
    fn corners(&self, i: usize, row: &Row<Formula>, vertex: Vertex) -> Option<Corners> {
        let (own, _) = self.formulas.row(i, row, vertex)?;
        let own: Vec<f64> = own.iter().map(middle).collect();
        let mut at = Vec::new();
        let (mut all, mut first, mut off) = (Vec::new(), 0, vec![0.0; own.len()]);
        for vertex in std::iter::once(vertex).chain(self.formulas.vertices()) {
            let (there, changes) = self.formulas.row(i, row, vertex)?;
            at.push([middle, half_width].map(|of| there.iter().map(of).collect()));
            let changes = changes.iter().filter_map(|change| Some((change.together?, &change.s)));
            let mut changes: Vec<(Quantities, &Vector<Pair>)> = changes.collect();
            // Of two steps one is minus the other.
            changes.dedup_by_key(|(by, _)| *by);
            let quantities = changes.iter().flat_map(|((j, l), _)| j.iter().chain([l]));
            let quantities: BTreeSet<usize> = quantities.copied().collect();
            let n = quantities.len();
            if n > MOST_TOGETHER {
                return None;
            }
            let has = |set: usize, j: usize| {
                quantities.iter().position(|k| *k == j).is_some_and(|k| set >> k & 1 == 1)
            };
            let squares: Vec<usize> = match n <= FEW {
                true => (0..1 << n).collect(),
                false => vec![0, (1 << n) - 1],
            };
            for set in 0..1 << n {
                for of_squares in &squares {
                    let mut corner = own.clone();
                    for ((j, l), s) in &changes {
                        let sign = |j: usize| if has(set, j) { 1.0 } else { -1.0 };
                        let part = match j {
                            Some(j) if j == l => f64::from(u8::from(has(*of_squares, *l))),
                            j => j.map_or(1.0, sign) * sign(*l),
                        };
                        corner.iter_mut().zip(s.iter()).for_each(|(x, s)| *x += part * middle(s));
                    }
                    all.push(corner);
                }
            }
            first = if first == 0 { all.len() } else { first };
            for (k, off) in off.iter_mut().enumerate() {
                let own = changes.iter().filter_map(|(_, s)| Some(half_width(s.get(k)?)));
                *off = own.sum::<f64>().max(*off);
            }
        }
        Some(Corners { own, at, all, first, off })
    }
}

/// The numbers of the entries `(i, j)`, `i <= j`, of a symmetric matrix.
fn triangle(m: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..m).flat_map(move |i| (i..m).map(move |j| (i, j)))
}

/// `Y`, and `R = T - Q` of each row, with `T_c = Y^T A_c + A_c^T Y - D_c Y^T Y >= Q` at each corner, and
/// `sum (T_v - R) > kappa^2 I` at each vertex `v`; for what `D_v` differs there, with `Y^T Y` to first order.
fn lower(rows: &[Corners], bound: f64) -> Option<(Option<Multiplier>, Vec<Vec<f64>>)> {
    let m = rows.first()?.own.len() - 1;
    let entries: Vec<(usize, usize)> = triangle(m).collect();
    let each = m + entries.len();
    let last = rows.len() * each;
    let mut x = DVector::zeros(last + 1);
    let (mut all, mut others, mut least) = (Vec::new(), Vec::new(), 0.0);
    let mut sums: Vec<Affine> = rows[0].at.iter().map(|_| Affine::new(m)).collect();
    for (i, row) in rows.iter().enumerate() {
        let (y, q) = (i * each, i * each + m);
        let (a, d) = row.own.split_at(m);
        let own: Vec<f64> = a.iter().map(|a| a / d[0]).collect();
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        // e s^T + s e^T <= |e| |s| (e e^T/|e|^2 + I), s = A - D Y/2.
        let lost = |off: &[f64]| {
            let s = off.iter().take(m).zip(&own).map(|(a, y)| a + 0.5 * off[m] * y.abs());
            size(&own) * size(&s.collect::<Vec<f64>>())
        };
        let unit = DMatrix::from_fn(m, m, |k, l| {
            let along = own[k] * own[l] / size(&own).powi(2);
            if k == l {
                1.0 + along
            } else {
                along
            }
        });
        let off = lost(&row.off);
        let mut greatest = 2.0 * off;
        for (number, corner) in row.all.iter().enumerate() {
            let (a, d) = corner.split_at(m);
            if d[0] <= 0.0 {
                return None;
            }
            let mut f = Affine::new(m + 1);
            f.constant[(m, m)] = 1.0;
            f.constant.view_mut((0, 0), (m, m)).copy_from(&(&unit * -off));
            (0..m).for_each(|k| f.add(y + k, (k, m), d[0].sqrt()));
            twice(&mut f, y, a);
            for (at, &entry) in entries.iter().enumerate() {
                f.add(q + at, entry, -1.0);
            }
            greatest =
                greatest.max(2.0 * off + 2.0 * size(a) * size(&own) + d[0] * size(&own).powi(2));
            if number < row.first {
                all.push(f);
            } else {
                others.push(f);
            }
        }
        for (sum, [there, off]) in sums.iter_mut().zip(&row.at) {
            sum.constant -= &unit * lost(off);
            let d = there[m] - row.own[m];
            let change = (0..m).map(|k| there[k] - row.own[k] - d * own[k]);
            twice(sum, y, &change.collect::<Vec<f64>>());
            sum.constant += DMatrix::from_fn(m, m, |k, l| d * own[k] * own[l]);
            for (at, &entry) in entries.iter().enumerate() {
                sum.add(q + at, entry, 1.0);
            }
        }
        x.rows_mut(y, m).copy_from_slice(&own);
        for (at, &(k, l)) in entries.iter().enumerate() {
            x[q + at] = if k == l { -1.5 * greatest } else { 0.0 };
        }
        least -= 1.5 * greatest;
    }
    for sum in &mut sums {
        (0..m).for_each(|k| sum.add(last, (k, k), -1.0));
    }
    x[last] = least - bound;
    x[last] -= sums.iter().map(|sum| (sum.at(&x) - sums[0].at(&x)).norm()).fold(0.0, f64::max);
    sums.append(&mut all);
    let x = more_than([&sums, &others], &x, bound)?;
    let y = DMatrix::from_fn(rows.len(), m, |i, k| x[i * each + k]);
    let y = rounded(&y, BITS - exponent(y.amax()))?;
    let scale = (-f64::from(y.places)).exp2();
    let slack = SLACK * (x[last] - bound) / rows.len() as f64;
    let of_row = |(i, row): (usize, &Corners)| {
        let own: Vec<f64> = y.y[i].iter().map(|y| *y as f64 * scale).collect();
        let (a, d) = row.own.split_at(m);
        let entry = |(at, &(k, l)): (usize, &(usize, usize))| {
            let t = own[k] * a[l] + own[l] * a[k] - d[0] * own[k] * own[l];
            t - x[i * each + m + at] + if k == l { slack } else { 0.0 }
        };
        entries.iter().enumerate().map(entry).collect()
    };
    let r = rows.iter().enumerate().map(of_row).collect();
    Some((Some(y), r))
}

/// Adds `Y^T a + a^T Y`.
fn twice(f: &mut Affine, y: usize, a: &[f64]) {
    for k in 0..a.len() {
        for (l, a) in a.iter().enumerate() {
            f.add(y + k, (k.min(l), k.max(l)), if k == l { 2.0 * a } else { *a });
        }
    }
}

/// `R = [[D - p, A - q], [.., Q]]` of each row, with `[[D_c - p, A_c - q], [.., Q]] >= 0` at each corner, and
/// `[[D_v - D + p, A_v - A + q], [.., k^2 I - sum Q]] > 0`, the first block diagonal, at each vertex `v`.
fn upper(rows: &[Corners], bound: f64) -> Option<Vec<Vec<f64>>> {
    let (n, m) = (rows.len(), rows.first()?.own.len() - 1);
    let entries: Vec<(usize, usize)> = triangle(m).collect();
    let each = 1 + m + entries.len();
    let last = n * each;
    let mut x = DVector::zeros(last + 1);
    let (mut all, mut others, mut greatest) = (Vec::new(), Vec::new(), 0.0);
    let mut sums: Vec<Affine> = rows[0].at.iter().map(|_| Affine::new(n + m)).collect();
    for (i, row) in rows.iter().enumerate() {
        let (p, q, own) = (i * each, i * each + 1, i * each + 1 + m);
        let size_of = |a: &[f64]| a.iter().take(m).map(|a| a * a).sum::<f64>().sqrt();
        // [[d, a], [a^T, 0]] is least about (u, v) with u = -A . v/D.
        let u = size_of(&row.own) / row.own[m];
        let lost = |off: &[f64]| (off[m] + size_of(off) / u, size_of(off) * u);
        let (off, off_rest) = lost(&row.off);
        let least = row.all.iter().map(|corner| corner[m]).fold(f64::INFINITY, f64::min) - off;
        let less = row.at.iter().map(|[there, off]| row.own[m] - there[m] + lost(off).0);
        let less = less.fold(0.0, f64::max);
        if least <= less {
            return None;
        }
        x[p] = 0.5 * (least + less);
        let mut size: f64 = off_rest;
        for (number, corner) in row.all.iter().enumerate() {
            let mut f = Affine::new(m + 1);
            f.constant[(0, 0)] = corner[m] - off;
            f.add(p, (0, 0), -1.0);
            for (k, a) in corner[..m].iter().enumerate() {
                f.constant[(k + 1, k + 1)] = -off_rest;
                f.constant[(0, k + 1)] = *a;
                f.constant[(k + 1, 0)] = *a;
                f.add(q + k, (0, k + 1), -1.0);
            }
            for (at, &(k, l)) in entries.iter().enumerate() {
                f.add(own + at, (k + 1, l + 1), 1.0);
            }
            size = size.max(off_rest + size_of(corner).powi(2) / (least - x[p]));
            if number < row.first {
                all.push(f);
            } else {
                others.push(f);
            }
        }
        for (sum, [there, off]) in sums.iter_mut().zip(&row.at) {
            let (off, off_rest) = lost(off);
            let change: Vec<f64> = there.iter().zip(&row.own).map(|(x, own)| x - own).collect();
            sum.constant[(i, i)] = change[m] - off;
            sum.add(p, (i, i), 1.0);
            for (k, a) in change[..m].iter().enumerate() {
                sum.constant[(n + k, n + k)] -= off_rest;
                sum.constant[(i, n + k)] = *a;
                sum.constant[(n + k, i)] = *a;
                sum.add(q + k, (i, n + k), 1.0);
            }
            for (at, &(k, l)) in entries.iter().enumerate() {
                sum.add(own + at, (n + k, n + l), -1.0);
            }
            size = size.max(off_rest + size_of(&change).powi(2) / (x[p] - less));
        }
        for (at, &(k, l)) in entries.iter().enumerate() {
            x[own + at] = if k == l { 2.0 * size } else { 0.0 };
        }
        greatest += 4.0 * size;
    }
    for sum in &mut sums {
        for k in 0..m {
            sum.constant[(n + k, n + k)] += bound;
            sum.add(last, (n + k, n + k), -1.0);
        }
    }
    x[last] = -greatest;
    sums.append(&mut all);
    let x = more_than([&sums, &others], &x, 0.0)?;
    let slack = SLACK * x[last] / n as f64;
    let of_row = |(i, row): (usize, &Corners)| {
        let (p, q) = (i * each, i * each + 1);
        let first = [row.own[m] - x[p]].into_iter();
        let first = first.chain((0..m).map(|k| row.own[k] - x[q + k]));
        let more = |(k, l): (usize, usize)| if k == l { slack } else { 0.0 };
        let rest = entries.iter().enumerate().map(|(at, &entry)| x[q + m + at] + more(entry));
        first.chain(rest).collect()
    };
    Some(rows.iter().enumerate().map(of_row).collect())
}
