//! Directions between two bodies over a cell: from the nearest points at the centre and at the middles
//! of its faces.

use crate::prover::PLACES;
use crate::rough::Rough;
use nalgebra::Vector3;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::test::apart::Apart;
use orthocert_kernel::test::{Multiplier, Over};

type V = Vector3<f64>;

/// The weights of the nearest points of two segments, and the vector from the second to the first.
pub fn nearest([p1, p2]: [V; 2], [q1, q2]: [V; 2]) -> ([f64; 2], V) {
    let (u, v, w) = (p2 - p1, q2 - q1, p1 - q1);
    let (a, b, c, d, e) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let at = |s: f64, t: f64| (s, t, (w + u * s - v * t).norm());
    let on_first = |t: f64| if a > 0.0 { ((b * t - d) / a).clamp(0.0, 1.0) } else { 0.0 };
    let on_second = |s: f64| if c > 0.0 { ((b * s + e) / c).clamp(0.0, 1.0) } else { 0.0 };
    let mut all = vec![
        at(0.0, on_second(0.0)),
        at(1.0, on_second(1.0)),
        at(on_first(0.0), 0.0),
        at(on_first(1.0), 1.0),
    ];
    let det = a * c - b * b;
    if det > 1e-12 * a * c {
        let (s, t) = ((b * e - c * d) / det, (a * e - b * d) / det);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            all.push(at(s, t));
        }
    }
    let best = all.into_iter().min_by(|x, y| x.2.total_cmp(&y.2)).expect("candidates");
    ([best.0, best.1], w + u * best.0 - v * best.1)
}

pub fn directions(over: &Over<'_, Rough>, test: &Apart) -> Vec<Multiplier> {
    let m = over.slopes.m;
    // The ends at the centre, moved along one coordinate to either face.
    let ends = |moved: Option<(usize, f64)>| -> Option<[[V; 2]; 2]> {
        let value = |f: Formula| {
            let slope = over.of(f)?;
            let middle = |x: (f64, f64)| (x.0 + x.1) / 2.0;
            let by = moved.map_or(0.0, |(k, sign)| sign * middle(slope.slopes[k]));
            Some(middle(slope.at_centre) + by)
        };
        let point = |p: &[Formula; 3]| Some(V::new(value(p[0])?, value(p[1])?, value(p[2])?));
        let segment = |ends: &[[Formula; 3]; 2]| Some([point(&ends[0])?, point(&ends[1])?]);
        Some([segment(&test.ends[0])?, segment(&test.ends[1])?])
    };
    let Some(centre) = ends(None) else { return Vec::new() };
    let ([s, t], _) = nearest(centre[0], centre[1]);
    let between = |[p1, p2]: [V; 2], s: f64| p1 + (p2 - p1) * s;
    let candidates: [&dyn Fn([[V; 2]; 2]) -> V; 4] = [
        &|[p, q]| nearest(p, q).1.normalize(),
        // Points of fixed weights.
        &|[p, q]| (between(p, s) - between(q, t)).normalize(),
        // The common normal.
        &|[p, q]| {
            let n = (p[1] - p[0]).cross(&(q[1] - q[0]));
            let sign = n.dot(&(p[0] - q[0])).signum();
            n.normalize() * sign
        },
        // Across the second segment.
        &|[p, q]| {
            let (along, w) = ((q[1] - q[0]).normalize(), between(p, s) - q[0]);
            (w - along * along.dot(&w)).normalize()
        },
    ];
    let mut all = Vec::new();
    for candidate in candidates {
        let centre = candidate(centre);
        let mut columns = vec![centre];
        for k in 0..m {
            let face = |sign| ends(Some((k, sign))).map_or(centre, candidate);
            columns.push((face(1.0) - face(-1.0)) / 2.0);
        }
        let scale = f64::from(PLACES).exp2();
        let row = |j: usize| columns.iter().map(|g| (g[j] * scale).round() as i64).collect();
        all.push(Multiplier { y: (0..3).map(row).collect(), places: PLACES });
        if all.len() == 1 {
            let constant = |j: usize| {
                let entry = |k: usize| if k == 0 { (centre[j] * scale).round() as i64 } else { 0 };
                (0..=m).map(entry).collect()
            };
            all.push(Multiplier { y: (0..3).map(constant).collect(), places: PLACES });
        }
    }
    all
}
