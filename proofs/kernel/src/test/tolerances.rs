//! Tolerances apart: one machine of the tolerance, and how all others differ from it.
//!
//! Ranges over all machines take each entry of a row by itself, as if it had tolerances of its own.
//! Here a quantity changes all formulas at once, as it does.

use super::Over;
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::control::Controls;
use crate::definite::{is_positive_definite, Triangle, Vector};
use crate::formula::{Formula, Values};
use crate::slope::Slope;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Derivatives of a formula, each by the parameter of this number.
pub type Derivatives = HashMap<Formula, Vec<(usize, Formula)>>;

/// Second derivatives, each by two parameters, the first not after the other.
pub type SecondDerivatives = HashMap<Formula, Vec<([usize; 2], Formula)>>;

/// Whether this character says of a quantity that it is of second order.
pub fn is_of_second_order(end: char) -> bool {
    matches!(end, '<' | '=' | '>')
}

/// How machines differ from one of them.
///
/// **Lemma (tolerances).** Let `theta_0` be the one machine, and every other one
/// `theta = theta_0 + sum_k lambda_k r_k e_j(k)`, `lambda_k` in `[0, 1]`: step `k` is of one quantity, of which there
/// may be two, one each way. Let the formulas be defined on the cell for all machines of the tolerance, a box. At every
/// point `x` of the cell, for every machine and each formula `f`,
///
/// ```text
/// f(x, theta) = sum_v w_v (f_v + sum_k lambda_k s_vk)
/// ```
///
/// with the weights `w_v` of [`Vertex`], or of control points ([`crate::control`]), `f_v` of `theta_0`, and `s_vk` in `r_k`
/// times the value there of the derivative of `f` by its quantity, for some machine. *Proof.* By the mean value theorem
/// `f(x, theta) - f(x, theta_0) = sum_k lambda_k r_k d_j(k) f(x, theta')` with `theta'` between both.
/// It may be another for each formula; the `lambda_k` are not, and the weights depend on `x` alone. ∎
/// With derivatives of the one machine alone it would be unsound: `theta^2` has none at 0, and is 1 at
/// the end of `[-1, 1]`.
///
/// **Lemma (second order).** Let `S` be some of the quantities, and `delta_j` what `theta` differs by from `theta_0` in quantity
/// `j`. Then the same is so with these changes: of each `j` of `S`, `delta_j` times the derivative of the one machine; of each pair
/// of `S`, `delta_j delta_l` times the second derivative by both for some machine, half of it where `l = j`; of each
/// other `j` what it was. *Proof.* Let `theta_1` differ from `theta_0` in `S` alone, as `theta` does. By Taylor's theorem along the
/// segment between both, with Lagrange's remainder, `f(x, theta_1) - f(x, theta_0)` is the sum of the first two, each pair
/// once, as second derivatives are symmetric; from `theta_1` to `theta` the mean value theorem gives the rest. With
/// `delta_j = sum lambda_k r_k` over the steps of `j`, `delta_j delta_l = sum lambda_k lambda_k' r_k r_k'`, and
/// `lambda_k lambda_k'` is in `[0, 1]`; and `delta_j^2/2 = (delta_j/r)^2 r^2/2` with the first step `r`, as no step of `j` is longer. ∎
/// Without the pairs of two it would be unsound: `theta_1 theta_2` has no derivative at 0.
pub struct Tolerances<'a, E: Enclosure> {
    /// The formulas of the one machine.
    pub machine: &'a Values<Slope<E::Number>>,
    /// The parameters of all machines.
    pub all: &'a [E::Number],
    /// Its parameters.
    pub parameters: &'a [E::Number],
    /// Its formulas at control points, where these are used.
    pub controls: Option<&'a Controls<E::Number>>,
    /// For each parameter its steps `r_k`.
    pub steps: &'a [Vec<E::Number>],
    /// The derivatives of the formulas that tests are made of, all of them.
    pub derivatives: &'a Derivatives,
    /// Those of second order, where there are some.
    pub second: Option<OfSecondOrder<'a, E>>,
    /// Directions, in which what is lost is least; any will do.
    pub directions: &'a [Vec<i64>],
}

/// The quantities of second order.
pub struct OfSecondOrder<'a, E: Enclosure> {
    /// Their parameters.
    pub by: BTreeSet<usize>,
    /// The second derivatives of all machines.
    pub values: &'a Values<Slope<E::Number>>,
    /// Of which formulas.
    pub of: &'a SecondDerivatives,
}

impl<E: Enclosure> Tolerances<'_, E> {
    /// Whether what a quantity changes may be looked at together with what others do: of second order, with two steps.
    fn is_together(&self, j: usize) -> bool {
        let is_second = self.second.as_ref().is_some_and(|second| second.by.contains(&j));
        is_second && self.steps.get(j).is_some_and(|steps| steps.len() == 2)
    }

    /// The steps of a quantity, or of two.
    fn steps_of(&self, e: &E, quantities: Quantities) -> Option<Vec<E::Number>> {
        let steps = |j: usize| self.steps.get(j);
        match quantities {
            (None, j) => steps(j).cloned(),
            (Some(j), l) if j == l => {
                steps(j)?.iter().take(1).map(|r| e.halve(&e.mul(r, r)?)).collect()
            }
            (Some(j), l) => {
                let others = steps(l)?;
                steps(j)?.iter().flat_map(|r| others.iter().map(|s| e.mul(r, s))).collect()
            }
        }
    }
}

impl<E: Enclosure> Over<'_, E> {
    /// At a vertex, for each step of a quantity, and then of two of second order, on which one of the formulas depends the
    /// `s_vk` of all of them, in the order of parameters; and what it changes of the part of `mu` of this row ([`Half`]).
    ///
    /// [`Half`]: super::Half
    pub(super) fn changes<'f>(
        &self,
        formulas: impl Iterator<Item = &'f Formula> + Clone,
        row: Option<usize>,
        v: Vertex,
    ) -> Option<Vec<Change<E::Number>>> {
        let e = self.slopes.arithmetic;
        let Some(tolerances) = self.tolerances else { return Some(Vec::new()) };
        let mut all: BTreeMap<Quantities, Vector<E::Number>> = BTreeMap::new();
        let (zero, length) = (e.integer(0)?, formulas.clone().count());
        let mut add = |by, k: usize, derivative| {
            let zeros = || std::iter::repeat_n(zero.clone(), length).collect();
            let own: &mut Vector<E::Number> = all.entry(by).or_insert_with(zeros);
            *own.get_mut(k)? = derivative;
            Some(())
        };
        let second = tolerances.second.as_ref();
        for (k, formula) in formulas.enumerate() {
            // It is defined for all machines.
            self.of_all(*formula, v)?;
            for &(j, derivative) in tolerances.derivatives.get(formula)? {
                let is_second = second.is_some_and(|second| second.by.contains(&j));
                let value =
                    if is_second { self.own_at(derivative, v) } else { self.of_all(derivative, v) };
                add((None, j), k, value?)?;
            }
            let Some(OfSecondOrder { by, values, of }) = second else { continue };
            for &([j, l], derivative) in of.get(formula)? {
                if by.contains(&j) && by.contains(&l) {
                    add((Some(j), l), k, self.slopes.at(values.of(derivative)?, v)?)?;
                }
            }
        }
        let weights = self.half.and_then(|half| Some((half.weights.get(row?)?, half.mu.1)));
        let weight = |by| match (by, weights) {
            ((None, j), Some((all, places))) => all.get(&j).map(|n| (*n, places)),
            _ => None,
        };
        let mut weighted = 0;
        let mut changes = Vec::new();
        for (by, slopes) in all {
            weighted += usize::from(weight(by).is_some());
            for step in tolerances.steps_of(e, by)? {
                let s = slopes.iter().map(|s| e.mul(&step, s)).collect::<Option<_>>()?;
                let nu = match weight(by) {
                    None => None,
                    Some((n, places)) => Some(e.dyadic(n, places, &step)?),
                };
                let is_together = |j: &usize| tolerances.is_together(*j);
                let together = Some(by).filter(|(j, l)| j.iter().chain([l]).all(is_together));
                changes.push(Change { together, s, nu });
            }
        }
        // What `mu` depends on, its row does.
        weights.is_none_or(|(all, _)| all.len() == weighted).then_some(changes)
    }

    /// The value of a formula at a vertex, or control point, of all machines.
    fn of_all(&self, f: Formula, v: Vertex) -> Option<E::Number> {
        match self.controls {
            None => self.slopes.at(self.of(f)?, v),
            Some(controls) => controls.at(f, v.index()).cloned(),
        }
    }

    /// At a vertex, the most by which tolerances lessen a sum of formulas, some subtracted.
    pub(super) fn greatest_loss(&self, parts: &[(Formula, bool)], v: Vertex) -> Option<E::Number> {
        let e = self.slopes.arithmetic;
        let zero = e.integer(0)?;
        let changes = self.changes(parts.iter().map(|(f, _)| f), None, v)?;
        e.sum(changes.iter().map(|Change { s, .. }| {
            let terms = s.iter().zip(parts).map(|(s, &(_, subtracted))| match subtracted {
                true => Some(s.clone()),
                false => e.neg(s),
            });
            let [_, less] = e.ends(&e.sum(terms)?);
            Some(if e.is_positive(&less) { less } else { zero.clone() })
        }))
    }

    /// The least value of a formula at a vertex, or control point, of all machines.
    pub fn least_at(&self, f: Formula, v: Vertex) -> Option<E::Number> {
        self.slopes.arithmetic.sub(&self.own_at(f, v)?, &self.greatest_loss(&[(f, false)], v)?)
    }

    /// The greatest one.
    pub fn greatest_at(&self, f: Formula, v: Vertex) -> Option<E::Number> {
        self.slopes.arithmetic.add(&self.own_at(f, v)?, &self.greatest_loss(&[(f, true)], v)?)
    }

    /// The second direction of the lower bound of a condition number, if there is one and it is not 0: `2^-4` times the one
    /// that is named.
    pub(super) fn across(&self) -> Option<Option<Vec<E::Number>>> {
        let e = self.slopes.arithmetic;
        let named = self.half.and_then(|_| self.tolerances?.directions.get(1));
        let Some(named) = named.filter(|d| d.iter().any(|x| *x != 0)) else { return Some(None) };
        let one = e.integer(1)?;
        let all = named.iter().map(|&x| e.dyadic(x, 4, &one)).collect::<Option<_>>()?;
        Some(Some(all))
    }

    /// Toward one of the directions: of a wedge in coordinates in which it is `2^places` times a unit vector.
    pub(super) fn toward(
        &self,
        which: fn(&[Vec<i64>]) -> Option<&Vec<i64>>,
    ) -> Option<Toward<E::Number>> {
        let e = self.slopes.arithmetic;
        let Some(tolerances) = self.tolerances else {
            return Some(Toward { k: None, w: Vec::new(), direction: Vec::new() });
        };
        let own = which(tolerances.directions)?;
        let greatest = own.iter().map(|x| x.unsigned_abs()).max()?;
        let places = u64::BITS - greatest.leading_zeros();
        let k = own.iter().position(|x| x.unsigned_abs() == greatest && greatest > 0);
        let (k, one) = (k.filter(|_| self.wedge.is_some()), e.integer(1)?);
        let w = own.iter().map(|&x| e.dyadic(x, places, &one)).collect::<Option<_>>()?;
        let direction = own.iter().enumerate().map(|(i, &x)| match k {
            None => e.integer(x),
            Some(k) if i == k => e.integer(1i64.checked_shl(places).filter(|&x| x > 0)?),
            Some(_) => e.integer(0),
        });
        Some(Toward { k, w, direction: direction.collect::<Option<_>>()? })
    }
}

/// Coordinates in which `w` stands in the place of the unit vector `e_k`, if of one; and a direction there.
///
/// **Lemma.** If `C^T T C` is positive definite, for any square matrix `C`, so is `T`. *Proof.* `C v != 0` where
/// `v != 0`, so that `C` is regular, and every vector is some `C v`. ∎ `C` has the column `w` in the place of `e_k`, and
/// where `p` are intervals, `p p^T` loses nothing along `w` but what `p . w` does, an entry of `C^T p`.
pub(super) struct Toward<N> {
    k: Option<usize>,
    w: Vec<N>,
    pub direction: Vec<N>,
}

impl<N: Clone + Default> Toward<N> {
    /// `C^T x`; with more entries after those of `x`.
    pub fn vector<E: Enclosure<Number = N>>(&self, e: &E, mut x: Vector<N>) -> Option<Vector<N>> {
        if let Some(k) = self.k {
            let along = e.dot(&x, &self.w)?;
            *x.get_mut(k)? = along;
        }
        Some(x)
    }

    /// `C^T T C`.
    pub fn matrix<E: Enclosure<Number = N>>(&self, e: &E, t: Triangle<N>) -> Option<Triangle<N>> {
        let Some(k) = self.k else { return Some(t) };
        let n = self.w.len();
        let at = |i: usize, j: usize| t.row(i.min(j)).get(i.abs_diff(j)).cloned();
        let row = |i| (0..n).map(|j| at(i, j)).collect::<Option<Vec<N>>>();
        let along = (0..n).map(|i| e.dot(&row(i)?, &self.w));
        let along: Vec<N> = along.collect::<Option<_>>()?;
        Triangle::new(n, |i, j| match (i == k, j == k) {
            (false, false) => at(i, j),
            (true, true) => e.dot(&along, &self.w),
            _ => along.get(if i == k { j } else { i }).cloned(),
        })
    }

    /// The direction `(u, w)` in one coordinate more, `u = -A . w/D`, in coordinates in which it is along `e_k` too.
    pub fn bordered<E: Enclosure<Number = N>>(&self, e: &E, d: &N, a: &[N]) -> Option<Self> {
        let (zero, one) = (e.integer(0)?, e.integer(1)?);
        let u = e.neg(&e.ratio(&e.dot(a, &self.direction)?, &one, d)?)?;
        let all = |first: N, rest: Vec<N>| [first].into_iter().chain(rest).collect::<Vec<N>>();
        let Some(k) = self.k else {
            let direction = all(u, self.direction.clone());
            return Some(Toward { k: None, w: Vec::new(), direction });
        };
        let [u, _] = e.ends(&e.neg(&e.ratio(a.get(k)?, &one, d)?)?);
        let unit = (0..a.len()).map(|i| if i == k { one.clone() } else { zero.clone() });
        let direction = all(zero.clone(), self.direction.clone());
        Some(Toward { k: Some(k + 1), w: all(u, unit.collect()), direction })
    }
}

/// A quantity, or two, the first not after the other.
pub type Quantities = (Option<usize>, usize);

/// What a step changes of a row.
pub struct Change<N> {
    /// The quantity, or the two, if all are of second order and have two steps.
    pub together: Option<Quantities>,
    /// Of its entries.
    pub s: Vector<N>,
    /// Of `mu`, or what is more of the squares of coordinates.
    pub nu: Option<N>,
}

impl<N> Change<N> {
    /// Of what is made of the row.
    pub fn of(&self, s: Vector<N>, nu: impl FnOnce(&N) -> Option<N>) -> Option<Self> {
        let nu = match &self.nu {
            None => None,
            Some(own) => Some(nu(own)?),
        };
        Some(Change { together: self.together, s, nu })
    }
}

/// Directions along and across which changes are taken off.
pub(super) struct Directions<'a, N> {
    /// The direction `w`.
    pub along: &'a [N],
    /// The direction `d`, if there is one.
    pub across: Option<&'a [N]>,
    /// The first of the coordinates of whose squares there may be more.
    pub first: usize,
}

/// More quantities than these are not looked at together.
pub const MOST_TOGETHER: usize = 6;

/// `T` less `R`, where that is not less than what quantities change together; and the changes that are left.
///
/// **Lemma (together).** Let quantities `j` of a set change it by `lambda_j E_j`, two of them by `lambda_j lambda_l E_jl`, and one by
/// `lambda_j^2 E_jj`, `lambda_j` in `[-1, 1]`. If for all signs of the set and all parts `K` of it
///
/// ```text
/// R + sum_j +-E_j + sum_(j < l) +-E_jl + sum_(j in K) E_jj
/// ```
///
/// is positive definite, of two quantities with the product of their signs, and `T - R` too, so is `T` as it is changed. *Proof.* For any
/// `v != 0` the form of `R` and all changes is affine in each `lambda_j` and in each `lambda_j^2`, if these are numbers of `[0, 1]` by
/// themselves. So it is not less than at some vertex of the box in which these are, where it is positive. ∎ All changes of
/// a row are `e s^T + s e^T + nu J` with one `e`, so that `s` and `nu` are summed. With all of the set for `K` alone it would be
/// unsound: `R = 1/2`, `e = 1`, `s_1 = 1`, `s_11 = 1`, where the form is -1/2 at `lambda = -1/2`.
pub(super) fn less_together<E: Enclosure>(
    e: &E,
    t: &mut Triangle<E::Number>,
    fixed: &[E::Number],
    changes: Vec<Change<E::Number>>,
    (r, first): (&Triangle<E::Number>, usize),
) -> Option<Vec<Change<E::Number>>> {
    let (own, apart): (Vec<_>, Vec<_>) =
        changes.into_iter().partition(|change| change.together.is_some());
    // Of the two steps of a quantity one is minus the other.
    let own = own.iter().filter_map(|change| Some((change.together?, change)));
    let mut own: Vec<(Quantities, &Change<E::Number>)> = own.collect();
    own.dedup_by_key(|(by, _)| *by);
    let all = own.iter().flat_map(|((j, l), _)| j.iter().chain([l]));
    let all: BTreeSet<usize> = all.copied().collect();
    if all.len() > MOST_TOGETHER {
        return None;
    }
    let (squares, own): (Vec<_>, Vec<_>) = own.into_iter().partition(|((j, l), _)| *j == Some(*l));
    let subset = |n: usize| (0..1u32 << n).map(move |set| move |k: usize| set >> k & 1 == 1);
    let plus = |a: &[E::Number], b: &[E::Number]| {
        a.iter().zip(b).map(|(a, b)| e.add(a, b)).collect::<Option<Vector<_>>>()
    };
    let zero = e.integer(0)?;
    for positive in subset(all.len()) {
        let is_negative = |j: &usize| !all.iter().position(|k| k == j).is_some_and(&positive);
        let mut s: Vector<_> = std::iter::repeat_n(zero.clone(), fixed.len()).collect();
        let mut nu = zero.clone();
        for ((j, l), change) in &own {
            let is_negative = j.iter().chain([l]).filter(|j| is_negative(j)).count() == 1;
            let signed = |x: &E::Number| if is_negative { e.neg(x) } else { Some(x.clone()) };
            s = plus(&s, &change.s.iter().map(signed).collect::<Option<Vector<_>>>()?)?;
            if let Some(own) = &change.nu {
                nu = e.add(&nu, &signed(own)?)?;
            }
        }
        for in_k in subset(squares.len()) {
            let more = squares.iter().enumerate().filter(|(k, _)| in_k(*k));
            let mut more = more.map(|(_, (_, change))| change);
            let s = more.try_fold(s.clone(), |s, change| plus(&s, &change.s))?;
            let mut form = r.clone();
            form.change(|i, j, entry| {
                let both = e.add(&e.mul(&fixed[i], &s[j])?, &e.mul(&s[i], &fixed[j])?)?;
                let own = e.add(entry, &both)?;
                if i == j && i >= first {
                    e.add(&own, &nu)
                } else {
                    Some(own)
                }
            })?;
            if !is_positive_definite(e, &form) {
                return None;
            }
        }
    }
    t.change(|i, j, entry| e.sub(entry, r.row(i).get(j - i)?))?;
    Some(apart)
}

/// `T` less, for each change `s`, `p p^T/(2 tau)` with `p = tau s - e` and some `tau > 0`.
///
/// **Lemma.** If this is positive definite for all `s_k` in their enclosures, so is
/// `T + sum_k lambda_k (e s_k^T + s_k e^T)`, for all `lambda_k` in `[0, 1]`. *Proof.*
/// `p p^T/(2 tau) + (e s^T + s e^T) = (tau s + e)(tau s + e)^T/(2 tau) >= 0`. ∎ At each vertex; a convex
/// combination is positive definite too. What several rows change is taken off one after the other. With half of
/// it, it would be unsound: `T = 3/2`, `e = 1`, `s = -1`, `tau = 1`.
///
/// Along `w` nothing is lost but what has to be if `tau = |e . w|/|s . w|`, and anything may be where one
/// of these is zero. So the 1-norms are added to both: the longer `w`, the less they count.
///
/// A change may be `e s^T + s e^T + nu J`, `J` the identity but for its first entries, which may be 0.
///
/// **Lemma (along).** Where `e . w` is not zero it is `e (s + nu z)^T + (s + nu z) e^T + nu K`, with `K >= 0` and
///
/// ```text
/// z = J w/(e . w) - e (w^T J w)/(2 (e . w)^2)    K = J - e z^T - z e^T
/// ```
///
/// *Proof.* `K = P^T J P`, `P = I - w e^T/(e . w)`. ∎ So nothing of `nu K` is taken off where `nu >= 0`, and all where it is
/// not; where `e . w` may be zero, all of `nu J`. Along `w`, `K` is zero. Without it it would be unsound: `T = diag(2, 1/2)`, `e = w = (1, 0)`,
/// `s = 0`, `nu = -1`.
///
/// **Lemma (across).** `(p . v)^2 <= (|p - a d|^2 + a^2) (v^T J v + (d . v)^2)` for any `a`, where `J` is the identity. *Proof.*
/// `p . v = (p - a d) . v + a (d . v)`, and the Cauchy-Schwarz inequality. ∎ So where `nu > 0`, `nu d d^T` is taken off, and of `p p^T` no
/// more than `1/(2 tau) - nu/(|p - a d|^2 + a^2)` times. This is for where no one direction `w` is worst, and `T` is great along `d`.
/// Without `nu d d^T` it would be unsound: `T = 1/2`, `e = 1`, `s = -1`, `nu = 1`, and a long `d`.
pub(super) fn less_changes<E: Enclosure>(
    e: &E,
    t: &mut Triangle<E::Number>,
    fixed: &[E::Number],
    changes: &[Change<E::Number>],
    Directions { along, across, first }: &Directions<'_, E::Number>,
) -> Option<()> {
    let one = e.integer(1)?;
    let size = |x: &[E::Number]| {
        let along = e.dot(x, along)?;
        e.sum([&along].into_iter().chain(x).map(|x| e.magnitude(x)))
    };
    let of_fixed = size(fixed)?;
    for Change { s, nu, .. } in changes {
        let mut s = s.clone();
        // `nu J` is not less than that of the least `nu`.
        let nu = nu.as_ref().map(|nu| e.ends(nu)[0].clone());
        let kept = nu.as_ref().zip(*across).filter(|(nu, _)| e.is_positive(nu));
        match (&nu, &kept) {
            (_, Some((nu, d))) => {
                t.change(|i, j, entry| e.sub(entry, &e.mul(&e.mul(nu, d.get(i)?)?, d.get(j)?)?))?
            }
            (Some(nu), None) => less_along(e, t, (fixed, &mut s), nu, (along, *first))?,
            (None, None) => (),
        }
        let of_change = size(&s)?;
        // One of the two is zero: nothing is changed.
        if !e.is_positive(&of_change) || !e.is_positive(&of_fixed) {
            continue;
        }
        let [tau, _] = e.ends(&e.ratio(&of_fixed, &one, &of_change)?);
        let mut half = e.halve(&e.recip(&tau)?)?;
        let p = |(s, x)| e.sub(&e.mul(&tau, s)?, x);
        let p: Vector<E::Number> = s.iter().zip(fixed).map(p).collect::<Option<_>>()?;
        if let Some((nu, d)) = kept {
            let [a, _] = e.ends(&e.ratio(&e.dot(&p, d)?, &one, &e.add(&one, &e.square(d)?)?)?);
            let rest = p.iter().zip(d).map(|(p, d)| e.sub(p, &e.mul(&a, d)?));
            let rest: Vector<E::Number> = rest.collect::<Option<_>>()?;
            let squares = e.add(&e.square(&rest)?, &e.sqr(&a)?)?;
            [_, half] = e.ends(&e.sub(&half, &e.ratio(nu, &one, &squares)?)?);
            if !e.is_positive(&half) {
                continue;
            }
        }
        let part = p.iter().map(|p| e.mul(&half, p)).collect::<Option<Vector<_>>>()?;
        t.change(|i, j, entry| e.sub(entry, &e.mul(&part[i], &p[j])?))?;
    }
    Some(())
}

/// `nu J` along `w`: `s` more by `nu z`, and `T` less what is taken off.
fn less_along<E: Enclosure>(
    e: &E,
    t: &mut Triangle<E::Number>,
    (fixed, s): (&[E::Number], &mut Vector<E::Number>),
    nu: &E::Number,
    (w, first): (&[E::Number], usize),
) -> Option<()> {
    let (zero, one, along) = (e.integer(0)?, e.integer(1)?, e.dot(fixed, w)?);
    let of_squares = |i: usize, x: &E::Number| if i < first { zero.clone() } else { x.clone() };
    let known = e.is_positive(&along) || e.is_positive(&e.neg(&along)?);
    let z: Option<Vector<E::Number>> = match known {
        false => None,
        true => {
            let inverse = e.recip(&along)?;
            let w: Vector<E::Number> =
                w.iter().enumerate().map(|(i, w)| of_squares(i, w)).collect();
            let half = e.halve(&e.square(&w)?)?;
            let own = e.mul(&e.mul(&half, &inverse)?, &inverse)?;
            let z = |(w, x)| e.sub(&e.mul(w, &inverse)?, &e.mul(&own, x)?);
            Some(w.iter().zip(fixed).map(z).collect::<Option<_>>()?)
        }
    };
    if let Some(z) = &z {
        *s =
            s.iter().zip(z.iter()).map(|(s, z)| e.add(s, &e.mul(nu, z)?)).collect::<Option<_>>()?;
    }
    if e.is_nonnegative(nu) {
        return Some(());
    }
    t.change(|i, j, entry| {
        let own = if i == j { of_squares(i, &one) } else { zero.clone() };
        let rest = match &z {
            None => own,
            Some(z) => {
                let both = e.add(&e.mul(&fixed[i], &z[j])?, &e.mul(&z[i], &fixed[j])?)?;
                e.sub(&own, &both)?
            }
        };
        e.add(entry, &e.mul(nu, &rest)?)
    })
}
