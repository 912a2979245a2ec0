//! Where joint errors and tolerances put the platform.

use super::solve::below_square;
use super::{Multiplier, Over};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{is_positive_definite, Triangle};
use crate::formula::Formula;

/// What the position error is at most `d`. All of it is in units of `d`.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// The rows of `M`, as many as coordinates.
    pub rows: Vec<Vec<Formula>>,
    /// Of each joint, its error over `d`, and for each toleranced parameter its half-width over `d` and
    /// the derivative of the joint coordinate.
    pub joints: Vec<(Formula, Vec<[Formula; 2]>)>,
    /// `d`.
    pub distance: Formula,
}

/// Of each coordinate the cell as expansion "point", the cell inflated by `d` on every side, and `d`.
///
/// **Lemma.** Over these edges, the slopes `S_k` of a formula `f` say
/// `f(P + u) = f(P) + sum_k S_k u_k/d` for every `P` of the cell and every `u` with `|u_k| <= d`.
/// *Proof.* The identities of [`crate::slope`] hold for each `P` as expansion point, with
/// `lambda_k = u_k/d`, if `f(P)` is in [`Slope::at_centre`](crate::slope::Slope::at_centre) and
/// `f(P + u)` in its range: so it is for the coordinates, and stays for what is made of them. ∎ The
/// inflated cell is clipped neither to the workspace nor to anything else.
pub fn inflated<E: Enclosure>(
    e: &E,
    edges: &[[E::Number; 3]],
    d: &E::Number,
) -> Option<Vec<[E::Number; 3]>> {
    let edge = |[_, range, _]: &[E::Number; 3]| {
        let wide = e.hull(&e.sub(range, d)?, &e.add(range, d)?);
        Some([range.clone(), wide, d.clone()])
    };
    edges.iter().map(edge).collect()
}

/// A bound on `d Gamma`, where `|M(P + u) - M(P)| <= Gamma |u|` for `0 < |u| <= d`, over edges that are
/// [`inflated`].
///
/// **Lemma.** With `S_i` the matrix of the slopes `S_ijk` of `M_ij`,
/// `d Gamma = sqrt(sum_i |S_i|_1 |S_i|_inf)` is one. *Proof.* Row `i` of `M(P + u) - M(P)` is
/// `S_i u/d`, of norm at most `|S_i| |u|/d`, and `|S_i|^2 <= |S_i|_1 |S_i|_inf` (Schur). A matrix has at
/// most the root of the sum of squares of its rows' norms. ∎ Absolute values are taken of each entry.
pub fn spread<E: Enclosure>(far: &Over<'_, E>, rows: &[Vec<Formula>]) -> Option<E::Number> {
    let (e, m) = (far.slopes.arithmetic, far.slopes.m);
    let zero = e.integer(0)?;
    let mut square = zero.clone();
    for row in rows {
        let entry = |f: &Formula| far.of(*f)?.slopes[..m].iter().map(|s| e.magnitude(s)).collect();
        let entries: Vec<Vec<E::Number>> = row.iter().map(entry).collect::<Option<_>>()?;
        let sum = |sum: E::Number, x: &E::Number| e.add(&sum, x);
        let mut greatest = [zero.clone(), zero.clone()];
        for k in 0..m {
            let column = entries.iter().filter_map(|own| own.get(k)).try_fold(zero.clone(), sum)?;
            let own = entries.get(k)?.iter().try_fold(zero.clone(), sum)?;
            for (greatest, x) in greatest.iter_mut().zip([own, column]) {
                *greatest = e.ends(&e.hull(greatest, &x))[1].clone();
            }
        }
        square = e.add(&square, &e.mul(&greatest[0], &greatest[1])?)?;
    }
    e.greatest_root(&square)
}

/// **Accuracy.** Let `Y` and `kappa > 0` be given, `far` the [`inflated`] cell, on which every formula is
/// defined for every machine, `g = d Gamma` its [`spread`], `z = 1 - g/(2 kappa)`. If `g < kappa` and at
/// the vertices, with `T_v = M_v Y^T + Y M_v^T - Y Y^T` and
/// `beta_vi = e_i/d + sum_j (r_j/d) |(d rho_i/d theta_j)_v|`,
///
/// ```text
/// T_v - kappa^2 I    and    [[T_v, b], [b^T, z^2]], b_i = s_i beta_vi, for all signs s_i
/// ```
///
/// are positive definite, the following holds. For every `P` of the cell, every machine `theta` of the
/// tolerance, and joint coordinates within `e_i` of those that the nominal machine `theta_0`, the middle
/// of the tolerance, has at `P`, there is exactly one `u` with `|u| <= d` for which the machine has these
/// at `P + u`.
///
/// *Proof.* Fix `P` and `theta`; `f` has the joint coordinates of that machine, `M` their derivatives.
/// Looked for is `f(P + u) - f(P) = b` with `b_i = rho_i(P, theta_0) - rho_i(P, theta) + eps_i`.
///
/// 1. *Data.* On the segment from `theta` to `theta_0`, which is in the tolerance,
///    `|b_i| <= e_i + sum_j r_j |(d rho_i/d theta_j)(P, theta')|` for some `theta'` (mean value theorem).
///    For that `theta'` too, the derivative at `P` is the combination of its vertex values with the
///    weights `w_v` of [`Vertex`], which depend on `P` alone. So `|b_i| <= d sum_v w_v beta_vi`.
/// 2. *First order.* The combination of the matrices with these weights has `M(P)` and
///    `b' = (s_i sum_v w_v beta_vi)` in it, and as `M M^T >= M Y^T + Y M^T - Y Y^T`,
///    `[[M M^T, b'], [b'^T, z^2]]` is positive definite, and with it `z^2 - |M(P)^-1 b'|^2`: for every
///    corner `b'` of a box that contains `b/d`, and by convexity for `b/d`, `|M(P)^-1 b| < z d`.
///    Likewise `M M^T > kappa^2 I`, so `psi = |M(P)^-1| < 1/kappa`.
/// 3. *Fixed point.* Let `F(u) = M(P)^-1 (b - (f(P + u) - f(P) - M(P) u))` on the ball `|u| <= d`, which
///    with all segments from `P` is in the inflated cell. `f(P + u) - f(P) - M(P) u =
///    int_0^1 (M(P + t u) - M(P)) u dt` is at most `Gamma |u|^2/2`, so
///    `|F(u)| <= z d + psi Gamma d^2/2 <= d (z + g/(2 kappa)) = d`. And
///    `|F(u) - F(u')| <= psi |int_0^1 (M(P + u' + t (u - u')) - M(P)) (u - u') dt|
///    <= psi Gamma d |u - u'|`, where `psi Gamma d < g/kappa < 1`. By Banach's theorem `F` has exactly one
///    fixed point, and its fixed points are what is looked for. ∎
///
/// The range of `rho_i(P, theta_0) - rho_i(P, theta)` over the cell, in place of that of the derivative,
/// would be as wide as the cell. With the rows of `A`, and derivatives multiplied by `B_i`, it would be
/// unsound: these are of the machine `theta'`, the row is of `theta`. So it would be with `Gamma` taken
/// on the cell alone, or on the part of the inflated cell in the workspace: `P + u` may leave either.
pub fn accuracy<E: Enclosure>(
    over: &Over<'_, E>,
    far: &Over<'_, E>,
    test: &Accuracy,
    (evidence, kappa): (&Multiplier, i64),
) -> bool {
    let n = test.rows.len();
    let shape = n == over.slopes.m && test.joints.len() == n && evidence.is_of(n, n) && kappa > 0;
    let shown = || {
        let e = over.slopes.arithmetic;
        let one = e.integer(1)?;
        let kappa = e.dyadic(kappa, evidence.places, &one)?;
        let g = spread(far, &test.rows)?;
        if !e.is_positive(&e.sub(&kappa, &g)?) {
            return None;
        }
        let z = e.sub(&one, &e.halve(&e.mul(&g, &e.recip(&kappa)?)?)?)?;
        let (square, kappa) = (e.sqr(&z)?, e.sqr(&kappa)?);
        let holds = |v| at_vertex(over, test, v, (evidence, &kappa, &square));
        Vertex::all(over.slopes.m).all(|v| holds(v) == Some(true)).then_some(())
    };
    shape && shown().is_some()
}

fn at_vertex<E: Enclosure>(
    over: &Over<'_, E>,
    test: &Accuracy,
    v: Vertex,
    (evidence, kappa_squared, square): (&Multiplier, &E::Number, &E::Number),
) -> Option<bool> {
    let e = over.slopes.arithmetic;
    let at = |row: &Vec<Formula>| row.iter().map(|&f| over.at(f, v)).collect();
    let rows: Vec<Vec<E::Number>> = test.rows.iter().map(at).collect::<Option<_>>()?;
    let rows: Vec<&[E::Number]> = rows.iter().map(Vec::as_slice).collect();
    let start = over.less_inside(e.integer(0)?, v)?;
    let below = below_square(e, &rows, (&e.integer(1)?, &start), evidence)?;
    let square = over.less_inside(square.clone(), v)?;
    let mut least = below.clone();
    for row in &mut least {
        let own = row.first_mut()?;
        *own = e.sub(own, kappa_squared)?;
    }
    let joint = |(error, all): &(Formula, Vec<[Formula; 2]>)| {
        let start = over.of(*error)?.range.clone();
        let sum = all.iter().try_fold(start, |sum, [half, by]| {
            let by = e.magnitude(&v.value(&over.slopes, over.of(*by)?)?)?;
            e.add(&sum, &e.mul(&over.of(*half)?.range, &by)?)
        })?;
        e.ends(&sum).into_iter().nth(1)
    };
    let beta: Vec<E::Number> = test.joints.iter().map(joint).collect::<Option<_>>()?;
    // b and -b give the same: the last sign is free.
    let definite = |signs: usize| {
        let signed = |(i, b): (usize, &E::Number)| {
            if signs >> i & 1 == 1 {
                e.neg(b)
            } else {
                Some(b.clone())
            }
        };
        let b: Option<Vec<_>> = beta.iter().enumerate().map(signed).collect();
        b.is_some_and(|b| is_positive_definite(e, bordered(below.clone(), &b, square.clone())))
    };
    Some(is_positive_definite(e, least) && (0..1usize << (beta.len() - 1)).all(definite))
}

/// `[[T, b], [b^T, c]]`.
fn bordered<N: Clone>(mut t: Triangle<N>, b: &[N], c: N) -> Triangle<N> {
    t.iter_mut().zip(b).for_each(|(row, b)| row.push(b.clone()));
    t.push(vec![c]);
    t
}
