//! Cells that two parallel planes cut: inner before the first, outer beyond the second.
//!
//! `u` in `[-1, 1]^m` is where in the cell a point is, `n` a vector of integers: what is *before* `c` is the
//! set of the points with `n . u <= c`.

use crate::cell::CORNER_PLACES;
use num_bigint::BigInt;
use num_traits::ToPrimitive;

/// Most bits of the components of `n`, and of `c` two more.
const MOST_BITS: u32 = 20;
/// By so many binary places, at most, what is enclosed of a cell may differ from it, in its half-widths.
pub(super) const SLACK_PLACES: u32 = 14;

/// Binary places of a part of a cell's share.
const SHARE_PLACES: u32 = 20;

/// Where a cell is cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// `n`.
    pub normal: Vec<i64>,
    /// What is before the first is inner, what is not before the second outer.
    pub ends: [i64; 2],
    /// The obligation that fails there, in its own directions.
    pub fails: usize,
}

impl Cut {
    /// Whether it cuts cells of `m` coordinates, in this order.
    pub fn is_of(&self, m: usize) -> bool {
        let [inner, outer] = self.ends;
        let all = self.normal.iter().map(|n| (n, MOST_BITS));
        let mut all = all.chain(self.ends.iter().map(|c| (c, MOST_BITS + 2)));
        let fits = all.all(|(n, bits)| n.unsigned_abs() >> bits == 0);
        let is_plane = self.normal.len() == m && self.normal.iter().any(|n| *n != 0);
        is_plane && fits && inner <= outer
    }

    /// `n` and `c`, such that the inner points are those before `c`; and the same of the outer points.
    fn sides(&self) -> [(Vec<i64>, i64); 2] {
        let [inner, outer] = self.ends;
        let opposite = self.normal.iter().map(|n| -n).collect();
        [(self.normal.clone(), inner), (opposite, -outer)]
    }

    /// Corners of parts of the cell that hold all inner points, and all outer points, in units of
    /// `2^-CORNER_PLACES`.
    ///
    /// **Lemma (part).** The hull of the corners holds all points of `[-1, 1]^m` that are before
    /// `c + sum_k |n_k|/2^SLACK_PLACES`. *Proof.* These are a polytope, of which a vertex lies in `m - 1`
    /// facets of the cube at least, and so on one of its edges: it is a vertex of the cube that is before that, or
    /// where the plane meets an edge whose one end is before it. Both that end and a point that is not
    /// nearer to it are corners. ∎
    pub fn corners(&self) -> [Vec<Vec<i64>>; 2] {
        self.sides().map(|(n, c)| {
            let one = 1i64 << CORNER_PLACES;
            let slack = n.iter().map(|n| n.abs()).sum::<i64>() << (CORNER_PLACES - SLACK_PLACES);
            let most = (c << CORNER_PLACES) + slack;
            let dot = |u: &[i64]| n.iter().zip(u).map(|(n, u)| n * u).sum::<i64>();
            let vertices = (0..1 << n.len()).map(|v: u32| {
                (0..n.len()).map(|k| if v >> k & 1 == 1 { one } else { -one }).collect::<Vec<_>>()
            });
            let kept = vertices.filter(|u| dot(u) <= most);
            let of_vertex = |u: Vec<i64>| {
                let crossing = |k: usize| {
                    let mut beyond = u.clone();
                    beyond[k] = -u[k];
                    if dot(&beyond) <= most {
                        return None;
                    }
                    // The edge goes from u as n_k does: what is rounded up there is not nearer to u.
                    let rest = dot(&u) - n[k] * u[k] - most;
                    beyond[k] = -rest.div_euclid(n[k].abs()) * n[k].signum();
                    Some(beyond)
                };
                let crossings: Vec<_> = (0..n.len()).filter_map(crossing).collect();
                std::iter::once(u).chain(crossings)
            };
            kept.flat_map(of_vertex).collect()
        })
    }

    /// The shares of the inner and of the outer points, of a cell with this share: multiples of
    /// `2^-SHARE_PLACES` of it, rounded down.
    ///
    /// **Lemma.** `[0, 1]^r` has, before `z` along `b > 0`, the volume
    /// `sum_S (-1)^|S| max(0, z - sum_S b)^r / (r! prod b)`, over all sets `S` of coordinates. *Proof.* That is
    /// the `r`-fold integral of the `r`-fold difference, of steps `b`, of the step at 0. ∎ With `u = 2 t - 1`,
    /// `b = 2 |n|` and `z = c + sum |n|`, of the coordinates whose `n_k` is not 0.
    pub fn shares(&self, cell: u128) -> [u128; 2] {
        self.sides().map(|(n, c)| {
            let b: Vec<i64> = n.iter().map(|n| 2 * n.abs()).filter(|b| *b > 0).collect();
            let z = c + b.iter().sum::<i64>() / 2;
            let power = |x: i64| BigInt::from(x.max(0)).pow(b.len() as u32);
            let of_set = |s: u32| {
                let own = b.iter().enumerate().filter(|(k, _)| s >> k & 1 == 1);
                let term = power(z - own.map(|(_, b)| b).sum::<i64>());
                if s.count_ones() % 2 == 1 {
                    -term
                } else {
                    term
                }
            };
            let volume: BigInt = (0..1 << b.len()).map(of_set).sum();
            let whole: BigInt = b.iter().zip(1..).map(|(b, j)| BigInt::from(b * j)).product();
            let parts = (volume << SHARE_PLACES) / whole;
            parts.to_u128().unwrap_or(0) * (cell >> SHARE_PLACES)
        })
    }
}
