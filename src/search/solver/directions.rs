//! Directions between two bodies over a box: from the nearest points at the centre and at the middles
//! of its faces.

use super::doubles::{middle, Doubles};
use nalgebra::{DMatrix, Vector3};
use orthocert_kernel::formula::Formula;
use orthocert_kernel::test::apart::Apart;
use orthocert_kernel::test::Over;

type V = Vector3<f64>;

/// The weights of the nearest points of two segments, and the vector from the second to the first.
pub fn nearest([p1, p2]: [V; 2], [q1, q2]: [V; 2]) -> ([f64; 2], V) {
    let (u, v, w) = (p2 - p1, q2 - q1, p1 - q1);
    let (a, b, c, d, e) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let between = |[s, t]: [f64; 2]| w + u * s - v * t;
    let on_first = |t: f64| if a > 0.0 { ((b * t - d) / a).clamp(0.0, 1.0) } else { 0.0 };
    let on_second = |s: f64| if c > 0.0 { ((b * s + e) / c).clamp(0.0, 1.0) } else { 0.0 };
    let mut best = [0.0, on_second(0.0)];
    let others = [[1.0, on_second(1.0)], [on_first(0.0), 0.0], [on_first(1.0), 1.0]];
    let det = a * c - b * b;
    let inner =
        if det > 1e-12 * a * c { [(b * e - c * d) / det, (a * e - b * d) / det] } else { best };
    for other in others.into_iter().chain([inner]) {
        let on_both = other.iter().all(|x| (0.0..=1.0).contains(x));
        if on_both && between(other).norm() < between(best).norm() {
            best = other;
        }
    }
    (best, between(best))
}

/// The ends of both segments, by the values of formulas.
pub fn ends(test: &Apart, value: impl Fn(Formula) -> Option<f64>) -> Option<[[V; 2]; 2]> {
    let point = |p: &[Formula; 3]| Some(V::new(value(p[0])?, value(p[1])?, value(p[2])?));
    let segment = |ends: &[[Formula; 3]; 2]| Some([point(&ends[0])?, point(&ends[1])?]);
    Some([segment(&test.ends[0])?, segment(&test.ends[1])?])
}

/// Affine directions, three rows of `g_0, g_1, .., g_m` each.
pub fn directions(over: &Over<'_, Doubles>, test: &Apart) -> Vec<DMatrix<f64>> {
    let m = over.slopes.m;
    // The ends at the centre, moved along one coordinate to either face.
    let at = |moved: Option<(usize, f64)>| {
        ends(test, |f| {
            let slope = over.of(f)?;
            let by = moved.map_or(0.0, |(k, sign)| sign * middle(&slope.slopes[k]));
            Some(middle(&slope.at_centre) + by)
        })
    };
    let Some([p, q]) = at(None) else { return Vec::new() };
    let ([s, t], _) = nearest(p, q);
    let between = |[p1, p2]: [V; 2], s: f64| p1 + (p2 - p1) * s;
    let candidates: [&dyn Fn([[V; 2]; 2]) -> V; 4] = [
        &|[p, q]| nearest(p, q).1.normalize(),
        // Points of fixed weights.
        &|[p, q]| (between(p, s) - between(q, t)).normalize(),
        // The common normal.
        &|[p, q]| {
            let n = (p[1] - p[0]).cross(&(q[1] - q[0]));
            n.normalize() * n.dot(&(p[0] - q[0])).signum()
        },
        // Across the second segment.
        &|[p, q]| {
            let (along, w) = ((q[1] - q[0]).normalize(), between(p, s) - q[0]);
            (w - along * along.dot(&w)).normalize()
        },
    ];
    let constant = candidates[0]([p, q]);
    let mut all = vec![DMatrix::from_fn(3, m + 1, |j, k| if k == 0 { constant[j] } else { 0.0 })];
    for candidate in candidates {
        let centre = candidate([p, q]);
        let face = |k: usize, sign: f64| at(Some((k, sign))).map_or(centre, candidate);
        let steps = (0..m).map(|k| (face(k, 1.0) - face(k, -1.0)) / 2.0);
        let columns: Vec<V> = [centre].into_iter().chain(steps).collect();
        all.push(DMatrix::from_fn(3, m + 1, |j, k| columns[k][j]));
    }
    all.retain(|g| g.iter().all(|g| g.is_finite()));
    all
}
