//! The tests: what is shown of formulas over a cell, for every machine of the tolerance.
//!
//! A machine is given by the paper's own matrices, `A x' = B rho'`: `n` rows `A_i` of `m` formulas,
//! and `D_i = B_i^2`, so that `M = B^-1 A` has `|M v|^2 = sum_i (A_i . v)^2/D_i`. Both are simple
//! where `M` is not: neither divides. Where a test of singular values is passed, all `D_i > 0` on the
//! cell.
//!
//! | test | shows | evidence |
//! |---|---|---|
//! | [`at_least`](Over::at_least) | `f >= 0` | |
//! | [`sigma_min`](Over::sigma_min) | `sigma_min(M) >= kappa` | any `n x m` matrix `Y` |
//! | [`full_rank`](Over::full_rank) | `sigma_min(M) > 0`; one to one | any `n x m` matrix `Y`; one for all cells |
//! | [`sigma_max`](Over::sigma_max) | `sigma_max(M) <= k` | |
//! | [`solve`](Over::solve) | `\|M^-1 e_i\| <= 1/k` | any `n x n` matrix `Y` |
//! | [`accuracy`](Over::accuracy) | one solution within `d` | any `n x n` matrix `Y`, `kappa` |
//! | [`apart`](Over::apart) | segments farther apart than `R` | an affine direction |
//! | [`curvature`](Over::curvature) | `a \|row\| + b \|H\| <= 1` | |
//!
//! All are affine or concave in their formulas, so the vertices of the cell decide ([`Vertex`]), or, of
//! polynomials, its control points ([`crate::control`]); they are statements about one machine, and hold
//! for each whose formulas are in the enclosures.

pub mod accuracy;
pub mod apart;
pub mod curvature;
pub mod solve;
pub mod tolerances;

use self::tolerances::{less_changes, less_together, Change, Directions, Tolerances, Toward};
use crate::arithmetic::{Arithmetic, Enclosure};
use crate::cell::Vertex;
use crate::control::Controls;
use crate::definite::{eliminate, is_positive_definite, Triangle, Vector};
use crate::formula::{Formula, Values};
use crate::slope::{Slope, Slopes};
use serde::{Deserialize, Serialize};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// `A_i` and `D_i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row<F> {
    /// The row of `A`.
    pub a: Vec<F>,
    /// The square of the entry of `B`.
    pub d: F,
}

/// `Y = y / 2^places`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Multiplier {
    /// Row by row: as many as the machine has, each with one entry a coordinate.
    pub y: Vec<Vec<i64>>,
    /// Binary places.
    pub places: u32,
}

impl Multiplier {
    /// Whether it has `n` rows of `m` entries, over admissible places.
    pub(crate) fn is_of(&self, n: usize, m: usize) -> bool {
        let shape = self.y.len() == n && self.y.iter().all(|y| y.len() == m);
        shape && self.places < MOST_PLACES
    }
}

/// Binary places are fewer than this.
pub const MOST_PLACES: u32 = 64;

/// A cell.
pub struct Place<'a, N> {
    /// For each coordinate its centre, range and half-width.
    pub edges: &'a [[N; 3]],
    /// Whether it touches the root's least, and its greatest corner.
    pub touches: [bool; 2],
    /// The formulas of all machines, with their derivatives; and of those with directions of one scale.
    pub(crate) derived: [OnceCell<Values<Slope<N>>>; 2],
    /// The same with second derivatives.
    pub(crate) second: [OnceCell<Values<Slope<N>>>; 2],
}

impl<'a, N> Place<'a, N> {
    /// A cell with these edges.
    pub fn new(edges: &'a [[N; 3]], touches: [bool; 2]) -> Self {
        let [derived, second] = [const { [const { OnceCell::new() }; 2] }; 2];
        Place { edges, touches, derived, second }
    }
}

/// The values of formulas over a cell.
pub type Formulas<E> = Values<Slope<<E as Arithmetic>::Number>>;

/// A cell's formulas.
pub struct Over<'a, E: Enclosure> {
    /// The cell.
    pub place: &'a Place<'a, E::Number>,
    /// The arithmetic of their slopes.
    pub slopes: Slopes<'a, E>,
    /// Their values.
    pub values: &'a Formulas<E>,
    /// The formulas at control points, where these are used in place of vertices.
    pub controls: Option<&'a Controls<E::Number>>,
    /// The values at the vertices of a formula that is not negative at the cell's points in the
    /// workspace, where one is used: what is shown at the vertices is then shown less these (the
    /// S-procedure).
    ///
    /// **Lemma.** If `f_v - t_v` is positive (definite: `F_v - t_v I`) at the vertices, `f` is positive
    /// at the points of the workspace. *Proof.* With the weights of [`Vertex`], `f(x) - t(x)` is a convex
    /// combination of these, and `t(x) >= 0`. ∎
    pub inside: Option<Vec<E::Number>>,
    /// Where values at vertices are those of one machine: how the others differ. `values` and `controls` are of all.
    pub tolerances: Option<&'a Tolerances<'a, E>>,
    /// What is not less than what tolerances change of each row together, over so many binary places.
    pub together: Option<(&'a [Vec<i64>], u32)>,
    /// The directions for which something is shown of singular values, where it is not of all.
    pub wedge: Option<Wedge<'a>>,
    /// The bound of a condition number, where not both are shown.
    pub half: Option<Half<'a>>,
    /// The number of the vertex, or control point, at which matrices are looked at first: a search may know where they fail.
    pub first: usize,
}

/// The directions `v` with `(b . v)(c . v) <= 0`, and `lambda = n/2^places >= 0`.
///
/// **Lemma (fan).** Of `c_1, .., c_K` and `c_{K+1} = -c_1`, let each `T_j + lambda_j (c_j c_{j+1}^T + c_{j+1} c_j^T)/2` be positive
/// definite. Then every `v != 0` has a `j` with `v^T T_j v > 0`. *Proof.* Where `c_1 . v` is not zero, the numbers
/// `c_1 . v, .., c_K . v, -c_1 . v` change their sign; where it is, take `j = 1`. So `(c_j . v)(c_{j+1} . v) <= 0` for some `j`,
/// and `v^T T_j v` is not less than what is positive. ∎ With `lambda < 0` it would be unsound: with `c_1 = (0, 1)` and
/// `lambda_1 = -2` the identity is made of `T_1 = diag(1, -1)`. So it would be without the last wedge: with `c_1 = (1, 0)`, `c_2 = (0, 1)`
/// and `lambda_1 = 4` of `[[1, -2], [-2, 1]]`, which is negative for `(1, 1)`.
///
/// A test is about each direction by itself: what it shows of `v` at a point follows from any `T_j` with `v^T T_j v > 0` there,
/// whatever machine, multiplier or inequality of the workspace it was made with. At the vertices the same is added to all.
#[derive(Clone, Copy)]
pub struct Wedge<'a> {
    /// `b` and `c`.
    pub between: [&'a [i64]; 2],
    /// `n`.
    pub n: i64,
    /// Binary places.
    pub places: u32,
}

/// One bound of a condition number, with the `mu` of both, at the vertices: at control points `mu` is another function of
/// the point.
#[derive(Clone, Copy)]
pub struct Half<'a> {
    /// `mu_0, .., mu_m`, and the binary places of all.
    pub mu: (&'a [i64], u32),
    /// For each row its `n_ij`, by the parameters `j`, if it is not the same for all machines: `mu` is more by
    /// `sum_ij n_ij theta_j`.
    pub weights: &'a [BTreeMap<usize, i64>],
    /// `c^2`, of `sigma_max^2 <= c^2 mu`; else `sigma_min^2 >= mu`.
    pub upper: Option<Formula>,
}

/// A row at a vertex, `A_i` and then `D_i`, and what tolerances change of it.
pub type Varied<N> = (Vector<N>, Vec<Change<N>>);

/// What a bound is at a vertex.
pub type AtVertex<'a, N> = &'a dyn Fn(Vertex) -> Option<N>;

impl<'a, E: Enclosure> Over<'a, E> {
    /// Formulas at vertices, of all machines at once.
    pub fn new(
        place: &'a Place<'a, E::Number>,
        slopes: Slopes<'a, E>,
        values: &'a Formulas<E>,
    ) -> Self {
        Over {
            place,
            slopes,
            values,
            controls: None,
            inside: None,
            tolerances: None,
            together: None,
            wedge: None,
            half: None,
            first: 0,
        }
    }

    /// Whether it is at vertices, of all machines, with nothing subtracted.
    pub(crate) fn is_plain(&self) -> bool {
        self.controls.is_none() && self.inside.is_none() && self.tolerances.is_none()
    }

    /// The value of a formula over the cell.
    pub fn of(&self, formula: Formula) -> Option<&Slope<E::Number>> {
        self.values.of(formula)
    }

    /// Its range.
    pub fn range(&self, formula: Formula) -> Option<E::Number> {
        Some(self.of(formula)?.range.clone())
    }

    /// The value whose vertices are meant: where tolerances are apart, of the one machine.
    pub fn own(&self, formula: Formula) -> Option<&Slope<E::Number>> {
        self.tolerances.map_or(self.values, |tolerances| tolerances.machine).of(formula)
    }

    /// The vertices, or control points.
    pub fn vertices(&self) -> impl Iterator<Item = Vertex> {
        Vertex::first(self.controls.map_or(self.slopes.corners(), Controls::len))
    }

    /// The value of a formula at a vertex, or control point; with tolerances apart none of what they change.
    pub fn at(&self, formula: Formula, vertex: Vertex) -> Option<E::Number> {
        let changed =
            |of: &Tolerances<'_, E>| of.derivatives.get(&formula).is_none_or(|all| !all.is_empty());
        if self.tolerances.is_some_and(changed) {
            return None;
        }
        self.own_at(formula, vertex)
    }

    /// The same, where tolerances are apart of the one machine: what they change is yet to be taken off.
    #[inline(always)]
    pub fn own_at(&self, formula: Formula, vertex: Vertex) -> Option<E::Number> {
        match self.controls {
            None => self.slopes.at(self.own(formula)?, vertex),
            Some(all) => {
                let controls = self.tolerances.map_or(Some(all), |tolerances| tolerances.controls);
                controls?.at(formula, vertex.index()).cloned()
            }
        }
    }

    /// Where between the ends of its range, as -1, 0 and 1, a vertex, or control point, has a coordinate;
    /// `None` of one that no formula at control points has.
    pub fn place(&self, k: usize, vertex: Vertex) -> Option<i64> {
        match self.controls {
            None if self.slopes.part.is_some() => None,
            None => Some(if vertex.has(k) { 1 } else { -1 }),
            Some(controls) => controls.place(k, vertex.index()),
        }
    }

    /// `x - t_v`.
    fn less_inside(&self, x: E::Number, vertex: Vertex) -> Option<E::Number> {
        match &self.inside {
            None => Some(x),
            Some(t) => self.slopes.arithmetic.sub(&x, t.get(vertex.index())?),
        }
    }

    /// A row, of this number, at a vertex.
    pub fn row(&self, i: usize, row: &Row<Formula>, vertex: Vertex) -> Option<Varied<E::Number>> {
        let mut own = Vector::filled(0, Default::default);
        for f in &row.a {
            own.push(self.own_at(*f, vertex)?);
        }
        own.push(self.own_at(row.d, vertex)?);
        Some((own, self.changes(row.a.iter().chain([&row.d]), Some(i), vertex)?))
    }

    /// `c I`, with what a wedge adds.
    fn start(&self, m: usize, c: &E::Number) -> Option<Triangle<E::Number>> {
        let e = self.slopes.arithmetic;
        let mut t = Triangle::scalar(e, m, c)?;
        if let Some(Wedge { between: [b, c], n, places }) = self.wedge {
            let one = e.integer(1)?;
            t.change(|i, j, entry| {
                let product = |i: usize, j: usize| b.get(i)?.checked_mul(*c.get(j)?);
                let twice = product(i, j)?.checked_add(product(j, i)?)?.checked_mul(n)?;
                e.add(entry, &e.dyadic(twice, places + 1, &one)?)
            })?;
        }
        Some(t)
    }

    /// `T` less what tolerances change of row `i`: together, if it says so, and each by itself.
    fn less(
        &self,
        i: usize,
        t: &mut Triangle<E::Number>,
        fixed: &[E::Number],
        mut changes: Vec<Change<E::Number>>,
        directions: &Directions<'_, E::Number>,
    ) -> Option<()> {
        let (e, n) = (self.slopes.arithmetic, fixed.len());
        if let Some((all, places)) = self.together {
            let own = all.get(i)?;
            if !own.is_empty() {
                let one = e.integer(1)?;
                let at = |i: usize, j: usize| i * (2 * n + 1 - i) / 2 + j - i;
                let entry = |i, j| e.dyadic(*own.get(at(i, j))?, places, &one);
                let r = Triangle::new(n, entry).filter(|_| own.len() == n * (n + 1) / 2)?;
                changes = less_together(e, t, fixed, changes, (&r, directions.first))?;
            }
        }
        less_changes(e, t, fixed, &changes, directions)
    }

    /// `c^2 mu`, of one bound of a condition number.
    fn above(&self, mu: &E::Number) -> Option<E::Number> {
        self.slopes.arithmetic.mul(&self.range(self.half?.upper?)?, mu)
    }

    /// Whether every `D_i` is positive on the cell.
    fn is_regular(&self, rows: &[Row<Formula>]) -> bool {
        let positive = |d: &E::Number| self.slopes.arithmetic.is_positive(d);
        rows.iter().all(|row| match self.controls {
            None => self.of(row.d).is_some_and(|d| positive(&d.range)),
            Some(all) => (0..all.len()).all(|j| all.at(row.d, j).is_some_and(positive)),
        })
    }

    /// Whether rows are regular, and something holds at all vertices.
    fn at_vertices(&self, rows: &[Row<Formula>], holds: impl Fn(Vertex) -> Option<bool>) -> bool {
        // No rows at all would have no singular value beyond any bound.
        let mut all = self.vertices().skip(self.first).chain(self.vertices().take(self.first));
        !rows.is_empty() && self.is_regular(rows) && all.all(|v| holds(v) == Some(true))
    }
}

/// The sum of `parts`, each added or, where this says so, subtracted.
pub(crate) fn signed<A: Arithmetic>(
    e: &A,
    parts: &[(Formula, bool)],
    of: impl Fn(Formula) -> Option<A::Number>,
) -> Option<A::Number> {
    e.sum(parts.iter().map(|&(f, subtracted)| if subtracted { e.neg(&of(f)?) } else { of(f) }))
}

impl<E: Enclosure> Over<'_, E> {
    /// **A sign.** The sum of the `parts`, some subtracted, is not negative on the cell if its range is not, or if it is not at
    /// the vertices, or control points.
    pub fn at_least(&self, parts: &[(Formula, bool)]) -> bool {
        let e = self.slopes.arithmetic;
        if self.controls.is_none() && self.inside.is_none() && self.tolerances.is_none() {
            let sum = signed(&self.slopes, parts, |f| self.of(f).cloned());
            return sum.is_some_and(|sum| self.slopes.all(&sum, |x| e.is_nonnegative(x)));
        }
        let holds = |v: Vertex| {
            let own = signed(e, parts, |f| self.own_at(f, v))?;
            self.less_inside(e.sub(&own, &self.greatest_loss(parts, v)?)?, v)
        };
        self.vertices().all(|v| holds(v).is_some_and(|x| e.is_nonnegative(&x)))
    }

    /// **Least singular value.** If `T = Y^T A + A^T Y - Y^T D Y - kappa^2 I` is positive definite at the
    /// vertices, for any one matrix `Y`, then `sigma_min(M) > kappa` on the cell.
    ///
    /// *Proof.* `T` is affine in `(A, D)`, so it is positive definite at `x`. For every `v`, with
    /// `t_i = A_i . v` and `s_i = Y_i . v`,
    ///
    /// ```text
    /// 0 <= sum_i (t_i - D_i s_i)^2/D_i = |M v|^2 - v^T (Y^T A + A^T Y - Y^T D Y) v
    /// ```
    ///
    /// and so `|M v|^2 >= kappa^2 |v|^2 + v^T T v`. ∎ It needs `D_i > 0`: without that, a leg of length
    /// zero with `Y_i = 0` would pass where `n > m`. `T` decreases with `D`, which is taken at its upper
    /// end. `M^T M - kappa^2 I` at the vertices would be
    /// unsound: `sigma_min >= kappa` is not convex (`diag(t, 1, 1)`, `t` in `[-1, 1]`).
    ///
    /// `kappa_squared` may differ from vertex to vertex: what is shown is then of its convex combination.
    pub fn sigma_min(
        &self,
        rows: &[Row<Formula>],
        kappa_squared: AtVertex<'_, E::Number>,
        evidence: &Multiplier,
    ) -> bool {
        let (e, parts) = (self.slopes.arithmetic, self.lower_parts(rows, evidence));
        self.at_vertices(rows, |v| {
            let rest = self.less_inside(e.neg(&kappa_squared(v)?)?, v)?;
            self.is_lower(rows, v, &rest, (evidence, true), parts.as_deref())
        })
    }

    /// **Full rank.** If `T = Y^T A + A^T Y` is positive definite at the vertices, and all `D_i > 0`, then
    /// `sigma_min(M) > 0` on the cell. *Proof.* `T` is affine in `A`, so it is positive definite at `x`, and
    /// `0 < v^T T v = 2 (Y v) . (A v)`, so that `A v != 0`, for every `v != 0`. ∎ It is [`Over::sigma_min`] for
    /// `kappa = 0` with `D = 0` in `T`, and as good: what `T` loses to `D` there, a small multiple of `Y`
    /// makes as small as is wanted. With one `Y` for all leaves it is what [`crate::quantity`] concludes
    /// from that a machine is one to one.
    pub fn full_rank(&self, rows: &[Row<Formula>], evidence: &Multiplier) -> bool {
        self.at_vertices(rows, |v| {
            let rest = self.less_inside(self.slopes.arithmetic.integer(0)?, v)?;
            self.is_lower(rows, v, &rest, (evidence, false), None)
        })
    }

    /// `Y^T A + A^T Y - Y^T D Y` at a cell's centre, and along each coordinate. What is shown at a vertex of their sum, some
    /// subtracted, [`Over::is_lower`] shows, in twice the time.
    ///
    /// **Lemma.** The sum encloses what is made at the vertex itself. *Proof.* Of `D`, enclosed in
    /// `[c, c'] + sum_k v_k [l_k, h_k]`, `v_k = +-1`, twice the upper end is `2 c' + sum_k (h_k - l_k) + sum_k v_k (h_k + l_k)`:
    /// what stands in the parts. For the rest, sums of lower ends are not greater than the lower end of the sum, as
    /// `floor(x) + floor(y) <= floor(x + y)`, and upper ends are the other way round. ∎ What is eliminated in larger
    /// intervals is so in smaller ones.
    fn lower_parts(
        &self,
        rows: &[Row<Formula>],
        evidence: &Multiplier,
    ) -> Option<Vec<Triangle<E::Number>>> {
        let (e, m) = (self.slopes.arithmetic, width(rows));
        let is_meant = E::EXACT_SUMS && self.controls.is_none() && self.tolerances.is_none();
        if !is_meant || self.slopes.part.is_some() || !evidence.is_of(rows.len(), m) {
            return None;
        }
        let mut parts = vec![Triangle::scalar(e, m, &e.integer(0)?)?; 1 + self.slopes.m];
        let (at_centre, along) = parts.split_first_mut()?;
        for (row, y) in rows.iter().zip(&evidence.y) {
            let y = (&y[..], evidence.places);
            let (a, d) = (row.a.iter().map(|f| self.of(*f)), self.of(row.d)?);
            let a: Vec<_> = a.collect::<Option<_>>()?;
            let [_, most] = e.ends(&d.at_centre);
            let mut twice = e.add(&most, &most)?;
            for (k, t) in along.iter_mut().enumerate() {
                let [low, high] = e.ends(&d.slopes[k]);
                twice = e.add(&twice, &e.sub(&high, &low)?)?;
                let a: Vector<E::Number> = a.iter().map(|a| a.slopes[k].clone()).collect();
                self.add_lower(t, (&a, &e.add(&high, &low)?), y)?;
            }
            let a: Vector<E::Number> = a.iter().map(|a| a.at_centre.clone()).collect();
            self.add_lower(at_centre, (&a, &twice), y)?;
        }
        Some(parts)
    }

    /// Adds `Y_i^T A_i + A_i^T Y_i - D_i Y_i^T Y_i`, given `2 D_i`: half is `Y_i^T z`, and half `z^T Y_i`, `z = 2 A_i - D_i Y_i`.
    fn add_lower(
        &self,
        t: &mut Triangle<E::Number>,
        row: (&[E::Number], &E::Number),
        (y, places): (&[i64], u32),
    ) -> Option<()> {
        let e = self.slopes.arithmetic;
        let z = residual(e, row, (y, places))?;
        let half = |i: usize, j: usize| e.dyadic(y[i], places + 1, &z[j]);
        t.change(|i, j, entry| {
            let own = half(i, j)?;
            let both = if i == j { e.add(&own, &own) } else { e.add(&own, &half(j, i)?) };
            e.add(entry, &both?)
        })
    }

    /// Whether [`Over::lower`] is positive definite at a vertex; by its parts, where these are given and enough.
    fn is_lower(
        &self,
        rows: &[Row<Formula>],
        v: Vertex,
        rest: &E::Number,
        evidence: (&Multiplier, bool),
        parts: Option<&[Triangle<E::Number>]>,
    ) -> Option<bool> {
        let e = self.slopes.arithmetic;
        if let Some(parts) = parts {
            if self.start(width(rows), rest)?.eliminate_with(e, parts, v).is_some() {
                return Some(true);
            }
        }
        Some(is_positive_definite(e, &self.lower(rows, v, rest, evidence)?))
    }

    /// `Y^T A + A^T Y - Y^T D Y + rest I`, if it is said so with `D`, at a vertex: where tolerances are apart, less what they
    /// change. Row `i` changes it by `Y_i s^T + s^T Y_i`, `2 s` the change of `2 A_i - D_i Y_i`.
    pub fn lower(
        &self,
        rows: &[Row<Formula>],
        v: Vertex,
        rest: &E::Number,
        (evidence, with_d): (&Multiplier, bool),
    ) -> Option<Triangle<E::Number>> {
        let (e, m, places) = (self.slopes.arithmetic, width(rows), evidence.places);
        if !evidence.is_of(rows.len(), m) {
            return None;
        }
        let mut t = self.start(m, rest)?;
        let (zero, one) = (e.integer(0)?, e.integer(1)?);
        let toward = self.toward(<[_]>::first)?;
        let mut all = Vec::new();
        for (i, (row, y)) in rows.iter().zip(&evidence.y).enumerate() {
            let (row, changes) = self.row(i, row, v)?;
            let (d, a) = row.split_last()?;
            let twice = |d: &E::Number| if with_d { e.add(d, d) } else { Some(zero.clone()) };
            let [_, greatest] = e.ends(d);
            self.add_lower(&mut t, (a, &twice(&greatest)?), (y, places))?;
            if !changes.is_empty() || self.together.is_some() {
                let fixed = y.iter().map(|&y| e.dyadic(y, places, &one));
                let fixed: Vector<E::Number> = fixed.collect::<Option<_>>()?;
                let half = |change: &Change<E::Number>| {
                    let (d, a) = change.s.split_last()?;
                    let z = residual(e, (a, &twice(d)?), (y, places))?;
                    let half = z.iter().map(|z| e.halve(z)).collect::<Option<_>>()?;
                    change.of(toward.vector(e, half)?, |nu| e.neg(nu))
                };
                let changes: Vec<_> = changes.iter().map(half).collect::<Option<_>>()?;
                all.push((i, toward.vector(e, fixed)?, changes));
            }
        }
        t = toward.matrix(e, t)?;
        let across = self.across()?;
        let across = across.as_deref();
        let directions = Directions { along: &toward.direction, across, first: 0 };
        for (i, fixed, changes) in all {
            self.less(i, &mut t, &fixed, changes, &directions)?;
        }
        Some(t)
    }

    /// **Greatest singular value.** If `[[D, A], [A^T, k^2 I]]` is positive definite at the vertices, then
    /// `sigma_max(M) < k` on the cell.
    ///
    /// *Proof.* The matrix is affine in `(A, D)`, so it is positive definite at `x`, and with it its Schur
    /// complement `k^2 I - A^T D^-1 A = k^2 I - M^T M`. ∎ The `D_i` are eliminated first, each at its lower
    /// end: the complement increases with them. Where tolerances are apart, row `i` changes the matrix by
    /// `e_i s^T + s e_i^T`, `s = (D_i/2, A_i)` of the change.
    pub fn sigma_max(&self, rows: &[Row<Formula>], k_squared: AtVertex<'_, E::Number>) -> bool {
        self.at_vertices(rows, |v| {
            let rest = self.upper(rows, v, &self.less_inside(k_squared(v)?, v)?)?;
            Some(is_positive_definite(self.slopes.arithmetic, &rest))
        })
    }

    /// `k^2 I - A^T D^-1 A` at a vertex, where all `D_i` are positive: where tolerances are apart, less what they change.
    pub fn upper(
        &self,
        rows: &[Row<Formula>],
        v: Vertex,
        k_squared: &E::Number,
    ) -> Option<Triangle<E::Number>> {
        let (e, toward) = (self.slopes.arithmetic, self.toward(<[_]>::last)?);
        let mut rest = toward.matrix(e, self.start(width(rows), k_squared)?)?;
        // Each D_i with its row of A alone: the other D_j are not touched by its elimination.
        for (i, row) in rows.iter().enumerate() {
            let (row, changes) = self.row(i, row, v)?;
            let row = toward.vector(e, row)?;
            let (d, a) = row.split_last()?;
            let [least, _] = e.ends(d);
            let mut first = std::iter::once(least).chain(a.iter().cloned()).collect();
            if !changes.is_empty() || self.together.is_some() {
                (first, rest) = self.less_row((i, d, a), (first, rest), &changes, &toward)?;
            }
            eliminate(e, &first, &mut rest.entries)?;
        }
        Some(rest)
    }

    /// `[[D_i, A_i], [A_i^T, ..]]`, by its first row and the rest, less what tolerances change of the row. The direction is
    /// `(u, v)`, where `u = -A_i . v/D_i` makes the form least.
    fn less_row(
        &self,
        (i, d, a): (usize, &E::Number, &[E::Number]),
        (first, rest): Bordered<E::Number>,
        changes: &[Change<E::Number>],
        toward: &Toward<E::Number>,
    ) -> Option<Bordered<E::Number>> {
        let e = self.slopes.arithmetic;
        let (zero, m, own) = (e.integer(0)?, a.len(), toward.bordered(e, d, a)?);
        let fixed = (0..=m).map(|i| if i == 0 { e.integer(1) } else { Some(zero.clone()) });
        let change = |change: &Change<E::Number>| {
            let row = toward.vector(e, change.s.clone())?;
            let (d, a) = row.split_last()?;
            let s = std::iter::once(e.halve(d)).chain(a.iter().cloned().map(Some));
            change.of(own.vector(e, s.collect::<Option<_>>()?)?, |nu| self.above(nu))
        };
        let changes: Vec<_> = changes.iter().map(change).collect::<Option<_>>()?;
        let bordered = Triangle::new(m + 1, |i, j| match i.checked_sub(1) {
            None => first.get(j).cloned(),
            Some(i) => rest.row(i).get(j - i - 1).cloned(),
        })?;
        let mut bordered = own.matrix(e, bordered)?;
        let fixed = own.vector(e, fixed.collect::<Option<_>>()?)?;
        let directions = Directions { along: &own.direction, across: None, first: 1 };
        self.less(i, &mut bordered, &fixed, changes, &directions)?;
        let rest = Triangle::new(m, |i, j| bordered.row(i + 1).get(j - i).cloned())?;
        Some((bordered.row(0).iter().cloned().collect(), rest))
    }
}

/// `2 A_i - D_i Y_i`, given `2 D_i`.
fn residual<E: Enclosure>(
    e: &E,
    (a, twice): (&[E::Number], &E::Number),
    (y, places): (&[i64], u32),
) -> Option<Vector<E::Number>> {
    let mut all = Vector::filled(0, Default::default);
    for (a, &y) in a.iter().zip(y) {
        all.push(e.sub(&e.add(a, a)?, &e.dyadic(y, places + 1, twice)?)?);
    }
    Some(all)
}

/// The columns of `A`.
pub(crate) fn width(rows: &[Row<Formula>]) -> usize {
    rows.first().map_or(0, |row| row.a.len())
}

/// A matrix by its first row and the rest.
type Bordered<N> = (Vector<N>, Triangle<N>);
