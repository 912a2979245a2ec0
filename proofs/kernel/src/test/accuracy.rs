//! Where joint errors and tolerances put the platform.

use super::solve::below_square;
use super::{Formulas, Multiplier, Over, Row};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{are_positive_definite, is_positive_definite, Vector};
use crate::formula::{Formula, Tape, Values};
use crate::slope::{Slope, Slopes};
use std::ops::Range;

/// Most binary places of a weight.
const MOST_WEIGHT: u32 = 16;

/// The error over `d`, and for each toleranced parameter its half-width over `d`, the derivative of the joint
/// coordinate, and that of `w D`.
pub type Joint = (Formula, Vec<[Formula; 3]>);

/// What the platform is off by is at most `d`, and where it turns, `tau`.
///
/// A pose is off by `u`: its position by `d` times the first components, and turned on from the one that
/// is meant by the rotation with the half-angle tangents `c`, `tau` times the last ones. `u_t` and `u_c` are
/// these two *parts*, one of which may be all.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// `W`, the derivatives of the joint coordinates by `u`, over `d`, at `u = 0`: as many rows as columns.
    pub rows: Vec<Vec<Formula>>,
    /// The same where `u` is not zero. There, coordinates from that of number `m` on are those of `c`.
    pub far: Vec<Vec<Formula>>,
    /// `w` times the rows of `A` in the same columns, and `w D`, where these are polynomials.
    pub scaled: Vec<Row<Formula>>,
    /// `w`.
    pub weight: Option<Formula>,
    /// The joints.
    pub joints: Vec<Joint>,
    /// `d`.
    pub distance: Formula,
    /// `tau`, where the platform turns, and the first of its columns.
    pub turn: Option<(Formula, usize)>,
    /// The columns of the part that this is about.
    pub part: Range<usize>,
}

impl Accuracy {
    /// Of all joints, the formulas that are wanted at control points beside scaled rows.
    pub fn changes(&self) -> impl Iterator<Item = Formula> + use<'_> {
        self.joints.iter().flat_map(|(_, all)| all.iter().map(|&[_, _, by]| by))
    }

    /// The columns of the parts that `u` has, of `m`.
    pub fn parts(&self, m: usize) -> Vec<Range<usize>> {
        let first = self.turn.map_or(m, |(_, first)| first.min(m));
        [0..first, first..m].into_iter().filter(|part| !part.is_empty()).collect()
    }
}

/// Formulas near a cell: its points as expansion "point", and all that is off by at most `u`. `edges` has
/// the cell's ranges second.
///
/// **Lemma.** The slopes `S_k` of a formula `f` say `f(u) = f(0) + sum_k S_k u_k` for every pose of the cell
/// and every `u` with `|u_k| <= 1`. *Proof.* The identities of [`crate::slope`] hold for each pose as
/// expansion point, with `lambda_k = u_k`, if `f(0)` is in [`Slope::at_centre`] and `f(u)` in its range: so
/// it is for positions, of which coordinate `k` is `P_k + d u_k`; for coordinates of orientation, which `u`
/// does not change; for `c = tau u_c`; and it stays for what is made of them. ∎ What is off is
/// clipped neither to the workspace nor to anything else.
pub fn near<E: Enclosure>(
    tape: &Tape,
    parameters: &[E::Number],
    slopes: Slopes<'_, E>,
    edges: &[[E::Number; 3]],
    test: &Accuracy,
    of: impl Fn(Formula) -> Option<E::Number>,
) -> Option<Values<Slope<E::Number>>> {
    let (e, m) = (slopes.arithmetic, slopes.m);
    let d = of(test.distance)?;
    let (tau, first) = match test.turn {
        Some((tau, first)) => (Some(of(tau)?), first),
        None => (None, m),
    };
    let about = |centre: &E::Number, by: &E::Number| {
        let wide = e.hull(&e.sub(centre, by)?, &e.add(centre, by)?);
        Some([centre.clone(), wide, by.clone()])
    };
    let coordinate = |k: usize| match k {
        _ if k < first => slopes.coordinate(k, about(&edges.get(k)?[1], &d)?),
        _ if k < m => slopes.constant(edges.get(k)?[1].clone()),
        _ => {
            let c = about(&e.integer(0)?, tau.as_ref()?)?;
            slopes.coordinate((k - m).checked_add(first).filter(|&k| k < m)?, c)
        }
    };
    Some(tape.run(&slopes, coordinate, |j| slopes.constant(parameters.get(j)?.clone())))
}

/// A number `g` with `|(J(u) - J(0)) w| <= g ||u|| ||w||` for the matrices `J` of the far rows and
/// `||u|| = max(|u_t|, |u_c|) <= 1`, over formulas [`near`] a cell.
///
/// **Lemma.** With `S_i` the matrix of the slopes `S_ijk` of `J_ij`, and `s_i` the sum of `sqrt(|B|_1 |B|_inf)`
/// over its blocks `B`, the parts of `j` and of `k`, `g = sqrt(sum_i s_i^2)` is one. *Proof.* Row `i` of
/// `J(u) - J(0)` times `w` is `w^T S_i u`, a sum of `w_a^T B u_b` over the blocks, each at most
/// `|B| ||w|| ||u||`, and `|B|^2 <= |B|_1 |B|_inf` (Schur). ∎ Absolute values are taken of each entry.
pub fn spread<E: Enclosure>(
    slopes: Slopes<'_, E>,
    far: &Formulas<E>,
    test: &Accuracy,
) -> Option<E::Number> {
    let (e, m) = (slopes.arithmetic, slopes.m);
    let zero = e.integer(0)?;
    let norm = |entries: &[Vec<E::Number>], a: &Range<usize>, b: &Range<usize>| {
        let rows = entries.get(a.clone())?;
        let mut greatest = [zero.clone(), zero.clone()];
        let along = |row: &Vec<E::Number>| e.sum(row.get(b.clone())?.iter().cloned().map(Some));
        let across = |k| e.sum(rows.iter().map(|row| row.get(k).cloned()));
        let sums = [rows.iter().map(along).collect(), b.clone().map(across).collect()];
        for (greatest, sums) in greatest.iter_mut().zip(sums) {
            let sums: Option<Vec<E::Number>> = sums;
            for x in sums? {
                *greatest = e.ends(&e.hull(greatest, &x))[1].clone();
            }
        }
        e.greatest_root(&e.mul(&greatest[0], &greatest[1])?)
    };
    let parts = test.parts(m);
    let mut square = zero.clone();
    for row in &test.far {
        let entry = |f: &Formula| far.of(*f)?.slopes[..m].iter().map(|s| e.magnitude(s)).collect();
        let entries: Vec<Vec<E::Number>> = row.iter().map(entry).collect::<Option<_>>()?;
        let blocks = parts.iter().flat_map(|a| parts.iter().map(move |b| (a, b)));
        let own = e.sum(blocks.map(|(a, b)| norm(&entries, a, b)))?;
        square = e.add(&square, &e.sqr(&own)?)?;
    }
    e.greatest_root(&square)
}

/// The entries of a row, those of the other part times `2^p`.
fn weighted<E: Enclosure>(
    e: &E,
    test: &Accuracy,
    p: u32,
    row: impl Iterator<Item = Option<E::Number>>,
) -> Option<Vector<E::Number>> {
    let own = |(k, x): (usize, Option<E::Number>)| match test.part.contains(&k) {
        true => x,
        false => e.dyadic(1 << p, 0, &x?),
    };
    row.enumerate().map(own).collect()
}

/// `b` for all signs but the last: `b` and `-b` give the same.
fn signed<'b, E: Enclosure>(
    e: &'b E,
    beta: &'b [E::Number],
) -> Option<impl Iterator<Item = Vector<E::Number>> + use<'b, E>> {
    let negative: Vec<E::Number> = beta.iter().map(|b| e.neg(b)).collect::<Option<_>>()?;
    let with = move |signs: usize| {
        let own = |(i, b): (usize, &E::Number)| match signs >> i & 1 {
            1 => negative[i].clone(),
            _ => b.clone(),
        };
        beta.iter().enumerate().map(own).collect()
    };
    Some((0..1usize << beta.len().checked_sub(1)?).map(with))
}

/// At a vertex or control point the rows, their weight, what `kappa^2` is multiplied by in each row, and `b`.
pub type Shown<N> = (Vec<Vector<N>>, N, Vec<N>, Vec<N>);

impl<E: Enclosure> Over<'_, E> {
    /// **Accuracy.** Let `Y`, `kappa > 0` and `p >= 0` be given, every formula be defined [`near`] the cell for
    /// every machine, `g` the [`spread`] of the far rows there, `z = 1 - g/(2 kappa)`, and `V` the matrix `W`
    /// with `2^p` times the columns that are not of the test's part. If `g < kappa` and at the vertices, with
    /// `T_v = V_v Y^T + Y V_v^T - Y Y^T` and
    /// `beta_vi = e_i/d + sum_j (r_j/d) |(d rho_i/d theta_j)_v|`,
    ///
    /// ```text
    /// T_v - kappa^2 I    and    [[T_v, b], [b^T, z^2]], b_i = s_i beta_vi, for all signs s_i
    /// ```
    ///
    /// are positive definite, this part is *met* on the cell. Where each part is met, the following holds for every
    /// machine `theta` of the tolerance, and joint coordinates within `e_i` of those that the nominal machine
    /// `theta_0`, the middle of the tolerance, has at the pose: there is exactly one `u` with `|u_t| <= 1` and
    /// `|u_c| <= 1` for which the machine has these where it is off by `u`.
    ///
    /// *Proof.* Fix the pose and `theta`; `d f(u)` are the joint coordinates of that machine, `J` the
    /// derivatives of `f`. Looked for is `f(u) - f(0) = b` with `d b_i = rho_i(theta_0) - rho_i(theta) + eps_i`.
    /// `||u|| = max(|u_t|, |u_c|)`.
    ///
    /// 1. *Data.* On the segment from `theta` to `theta_0`, which is in the tolerance,
    ///    `d |b_i| <= e_i + sum_j r_j |(d rho_i/d theta_j)(theta')|` for some `theta'` (mean value theorem).
    ///    For that `theta'` too, the derivative at the pose is the combination of its vertex values with the
    ///    weights `w_v` of [`Vertex`], which depend on the pose alone. So `|b_i| <= sum_v w_v beta_vi`.
    /// 2. *First order.* The combination of the matrices with these weights has `V` and
    ///    `b' = (s_i sum_v w_v beta_vi)` in it, and as `V V^T >= V Y^T + Y V^T - Y Y^T`,
    ///    `[[V V^T, b'], [b'^T, z^2]]` is positive definite, and with it `z^2 - |V^-1 b'|^2`: for every
    ///    corner `b'` of a box that contains `b`, and by convexity for `b`, `|V^-1 b| < z`.
    ///    Likewise `V V^T > kappa^2 I`, so `|V^-1| < 1/kappa`. Of this part, `V^-1 x` has the components of
    ///    `W^-1 x`.
    /// 3. *Fixed point.* Let `F(u) = W^-1 (b - (f(u) - f(0) - W u))` where `||u|| <= 1`, a convex set.
    ///    `f(u) - f(0) - W u = int_0^1 (J(t u) - J(0)) u dt` is at most `g ||u||^2/2 <= g/2`, so this part of
    ///    `F(u)` is at most `z + g/(2 kappa) = 1`. And with
    ///    `|f(u) - f(u') - W (u - u')| <= g max(||u||, ||u'||) ||u - u'|| <= g ||u - u'||`, this part of
    ///    `F(u) - F(u')` is at most `(g/kappa) ||u - u'||`, `g < kappa`. If each part is met, with
    ///    numbers of its own, `F` maps that set into itself and contracts it: by Banach's theorem `F` has
    ///    exactly one fixed point, and its fixed points are what is looked for. ∎
    ///
    /// `c` with `|c| <= tau = tan(a/2)` are the rotations by at most `a < 180` degrees, each once.
    ///
    /// The range of `rho_i(theta_0) - rho_i(theta)` over the cell, in place of that of the derivative,
    /// would be as wide as the cell. With the rows of `A`, and derivatives multiplied by `B_i`, it would be
    /// unsound: these are of the machine `theta'`, the row is of `theta`. So it would be with `g` taken
    /// on the cell alone, or on the part of what is near it in the workspace: `u` may lead out of either. With a
    /// large `p` nothing is lost to the other part, and more to the size of the cell.
    ///
    /// *At control points.* Let `A`, `D` be polynomials after multiplication by `w > 0`, `A` in the columns of `V` and
    /// `D_i = rho_i^2` in all lengths, `q_i > 0` any numbers, and `delta_i` at least the sum of
    /// `(r_j/d) |d rho_i/d theta_j|` on all of the cell. The same follows of
    ///
    /// ```text
    /// T_v - kappa^2 w D    and    [[T_v, b], [b^T, w z^2]], for all signs s_i
    ///
    /// b_i = s_i (sum_j (r_j/d) |d(w D_i)/d theta_j|/2 + w d delta_i^2/2 + (e_i/d) (w D_i + q_i^2 w)/(2 q_i))
    /// ```
    ///
    /// with `T_v = w (A Y^T + Y A^T - Y Y^T)`, for in place of 2: all is affine in `w A`, `w D`, the derivatives of `w D`
    /// and `w`, and absolute values are convex, so with `T`, `b'` at the pose over `w`, `A A^T >= T > kappa^2 D`,
    /// which is `V V^T > kappa^2 I`; and `|A^-1 y| < z` for `|y_i| <= |b'_i|`, among which is `y_i = rho_i b_i`,
    /// `rho_i = rho_i(theta)`. For `d y_i = rho_i (x - rho_i) + rho_i eps_i`, `x = rho_i(theta_0)`, where
    /// `rho_i (x - rho_i) = (x^2 - rho_i^2)/2 - (x - rho_i)^2/2`; the first of these is by the mean value theorem
    /// at most the sum of `r_j |d D_i/d theta_j|/2` at some `theta'`, of the second `|x - rho_i| <= d delta_i`,
    /// and `2 q_i rho_i <= D_i + q_i^2`. ∎ With `b_i = sqrt(D_i) beta_vi` of derivatives of `rho_i` the proof would
    /// fail: `D_i` is of `theta`, `beta_vi` of `theta'`.
    pub fn accuracy(
        &self,
        far: &Formulas<E>,
        test: &Accuracy,
        (evidence, kappa, p): (&Multiplier, i64, u32),
    ) -> bool {
        let n = test.rows.len();
        let shape =
            n == self.slopes.m && test.joints.len() == n && evidence.is_of(n, n) && kappa > 0;
        let weighted = p == 0 || (p <= MOST_WEIGHT && test.parts(n).len() == 2);
        let shown = || {
            let e = self.slopes.arithmetic;
            let one = e.integer(1)?;
            let kappa = e.dyadic(kappa, evidence.places, &one)?;
            let g = spread(self.slopes, far, test)?;
            if !e.is_positive(&e.sub(&kappa, &g)?) {
                return None;
            }
            let z = e.sub(&one, &e.halve(&e.mul(&g, &e.recip(&kappa)?)?)?)?;
            let (square, kappa) = (e.sqr(&z)?, e.sqr(&kappa)?);
            let slopes = self.greatest(test)?;
            let holds = |v| {
                let (rows, weight, d, b) = self.shown(test, (v, p), slopes.as_ref())?;
                let rows: Vec<&[E::Number]> = rows.iter().map(|row| &row[..]).collect();
                let start = self.less_inside(e.integer(0)?, v)?;
                let below = below_square(e, &rows, (&weight, &start), evidence)?;
                let corner = self.less_inside(e.mul(&weight, &square)?, v)?;
                let mut least = below.clone();
                least.change(|i, j, entry| match i == j {
                    true => e.sub(entry, &e.mul(&kappa, d.get(i)?)?),
                    false => Some(entry.clone()),
                })?;
                Some(
                    is_positive_definite(e, &least)
                        && are_positive_definite(e, &below, signed(e, &b)?, &corner),
                )
            };
            self.vertices().all(|v| holds(v) == Some(true)).then_some(())
        };
        shape && weighted && shown().is_some()
    }

    /// At control points `d delta_i^2/2` and `q_i`; at vertices nothing.
    pub fn greatest(&self, test: &Accuracy) -> Option<Option<[Vec<E::Number>; 2]>> {
        let e = self.slopes.arithmetic;
        let all = || {
            let d = &self.of(test.distance)?.range;
            let joint = |(_, all): &Joint| {
                let delta = self.sum(all, |[_, by, _]| Some(self.of(by)?.range.clone()))?;
                e.ends(&e.halve(&e.mul(d, &e.sqr(&delta)?)?)?).into_iter().nth(1)
            };
            let squares = test.joints.iter().map(joint).collect::<Option<_>>()?;
            Some([squares, self.roots(test)?])
        };
        match self.controls {
            None => Some(None),
            Some(_) if test.scaled.len() == test.rows.len() => all().map(Some),
            Some(_) => None,
        }
    }

    /// The sum of half-widths times the magnitudes of these derivatives.
    fn sum(
        &self,
        all: &[[Formula; 3]],
        derivative: impl Fn([Formula; 3]) -> Option<E::Number>,
    ) -> Option<E::Number> {
        let e = self.slopes.arithmetic;
        e.sum(
            all.iter().map(|&own| e.mul(&self.of(own[0])?.range, &e.magnitude(&derivative(own)?)?)),
        )
    }

    /// `q_i`: `sqrt(D_i)` at the first control point and the last, in the middle of both.
    fn roots(&self, test: &Accuracy) -> Option<Vec<E::Number>> {
        let e = self.slopes.arithmetic;
        let root = |row: &Row<Formula>| {
            let at = |v| {
                let (d, weight) = (self.at(row.d, v)?, self.at(test.weight?, v)?);
                let [least, _] = e.ends(&e.ratio(&d, &e.integer(1)?, &weight)?);
                e.sqrt(&least)
            };
            let ends = [self.vertices().next()?, self.vertices().last()?];
            let [a, b] = ends.map(at);
            let q = e.ends(&e.halve(&e.add(&a?, &b?)?)?).into_iter().next()?;
            e.is_positive(&q).then_some(q)
        };
        test.scaled.iter().map(root).collect()
    }

    /// With what is the same at all control points.
    pub fn shown(
        &self,
        test: &Accuracy,
        (v, p): (Vertex, u32),
        greatest: Option<&[Vec<E::Number>; 2]>,
    ) -> Option<Shown<E::Number>> {
        let e = self.slopes.arithmetic;
        let row = |row: &Vec<Formula>| weighted(e, test, p, row.iter().map(|&f| self.at(f, v)));
        let one = e.integer(1)?;
        let upper = |x: E::Number| e.ends(&x).into_iter().nth(1);
        let Some([squares, q]) = greatest else {
            let rows: Vec<_> = test.rows.iter().map(row).collect::<Option<_>>()?;
            let entry = |(error, all): &Joint| {
                let sum = self.sum(all, |[_, by, _]| self.slopes.at(self.of(by)?, v))?;
                upper(e.add(&self.of(*error)?.range, &sum)?)
            };
            let b: Vec<E::Number> = test.joints.iter().map(entry).collect::<Option<_>>()?;
            return Some((rows, one.clone(), vec![one; b.len()], b));
        };
        let weight = self.at(test.weight?, v)?;
        let rows = test.scaled.iter().map(|own| row(&own.a)).collect::<Option<_>>()?;
        let d = test.scaled.iter().map(|row| self.at(row.d, v));
        let d: Vec<E::Number> = d.collect::<Option<_>>()?;
        let entry = |(i, (error, all)): (usize, &Joint)| {
            let (square, q) = (squares.get(i)?, q.get(i)?);
            let changes = e.halve(&self.sum(all, |[.., by]| self.at(by, v))?)?;
            let changes = e.add(&changes, &e.mul(square, &weight)?)?;
            let root = e.halve(&e.ratio(d.get(i)?, &one, q)?)?;
            let root = e.add(&root, &e.halve(&e.mul(q, &weight)?)?)?;
            upper(e.add(&changes, &e.mul(&self.of(*error)?.range, &root)?)?)
        };
        let b = test.joints.iter().enumerate().map(entry).collect::<Option<_>>()?;
        Some((rows, weight, d, b))
    }
}
