//! A test over a cell, as the exact judge sees it: how far from where it ends, to first order, it is shown to hold,
//! and to fail.

use super::margin::{Local, Margin, View};
use super::spectrum::{Spectrum, PAIRS};
use crate::search::solver::doubles::{half_width, middle, Doubles};
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::{Slope, Slopes};
use orthocert_kernel::test::Row;

/// A formula over a cell: at its centre, how each coordinate moves it, and by how much that varies.
#[derive(Clone, Copy, Default)]
struct Entry {
    centre: f64,
    moved: [f64; 3],
    varied: [f64; 3],
}

impl Entry {
    fn of(over: &dyn View, f: Formula) -> Option<Self> {
        let [moved, varied] = over.moved(f);
        Some(Entry { centre: over.centre(f)?, moved, varied })
    }

    fn margin(self) -> Margin {
        Margin { centre: self.centre, along: self.moved, beyond: self.varied, off: 0.0 }
    }

    /// At a place, and by how much it may differ there.
    fn at(&self, u: [f64; 3]) -> [f64; 2] {
        [self.centre + dot(self.moved, u), dot(self.varied, u.map(f64::abs))]
    }
}

/// A test over a cell, as the judge sees it, nearly.
pub(super) struct Seen {
    /// To first order.
    pub margin: Margin,
    m: usize,
    singular: Option<Singular>,
}

/// What is seen of an extreme singular value.
struct Singular {
    is_greatest: bool,
    /// Of its square.
    bound: f64,
    /// Its own direction at the centre, of length one.
    v: [f64; 3],
    /// `A_i` and `D_i`.
    rows: Vec<([Entry; 3], Entry)>,
    /// `|M v|^2`, as slopes have it.
    stretched: Entry,
}

impl Seen {
    /// Of a test with a margin over a cell.
    pub fn new(over: &dyn View, local: &Local<'_>, test: &Test, margin: Margin) -> Option<Self> {
        let singular = match test {
            Test::SigmaMin(bound) => Some(Singular::new(over, local, *bound, false)?),
            Test::SigmaMax(bound) => Some(Singular::new(over, local, *bound, true)?),
            Test::Least(rows, bound) | Test::Greatest(rows, bound) => {
                let local = Local::of(rows.iter(), |f| over.centre(f))?;
                let is_greatest = matches!(test, Test::Greatest(..));
                Some(Singular::new(over, &local, *bound, is_greatest)?)
            }
            _ => None,
        };
        let margin = match test {
            Test::AtLeast(f) => Entry::of(over, *f)?.margin(),
            Test::Beyond(f, bound) => {
                Entry::of(over, *f)?.margin().beyond(Entry::of(over, *bound)?.margin())
            }
            _ => margin,
        };
        Some(Seen { margin, m: over.m(), singular })
    }

    /// How far from the plane, in the margin, it is seen that the test holds, or, on the other side, that it fails.
    pub fn distance(&self, side: f64) -> f64 {
        let mut distance = self.margin.beyond.iter().map(|x| x.abs()).sum::<f64>();
        for _ in 0..2 {
            let lacks = |u| distance - if side > 0.0 { self.least(u) } else { -self.greatest(u) };
            let all = self.crossings(side * distance).into_iter().map(lacks);
            distance = all.reduce(f64::max).unwrap_or(distance);
        }
        distance
    }

    /// Where the margin is so much on the cell's edges.
    fn crossings(&self, margin: f64) -> Vec<[f64; 3]> {
        let Margin { centre, along, .. } = self.margin;
        let vertices = |k: usize| (0..1u32 << self.m).filter(move |v| v >> k & 1 == 1);
        let edges = (0..self.m).flat_map(|k| vertices(k).map(move |v| (k, v)));
        let crossing = |(k, v): (usize, u32)| {
            let end = |j: usize| if v >> j & 1 == 1 { 1.0 } else { -1.0 };
            let mut u = std::array::from_fn(|j| if j < self.m && j != k { end(j) } else { 0.0 });
            u[k] = (margin - centre - dot(along, u)) / along[k];
            (u[k].abs() <= 1.0).then_some(u)
        };
        edges.filter_map(crossing).collect()
    }

    /// The least margin that is seen at a place.
    fn least(&self, u: [f64; 3]) -> f64 {
        match &self.singular {
            None => self.plain(u)[0],
            Some(own) if own.is_greatest => own.bound - own.at(u, self.m),
            Some(own) => own.at(u, self.m) - own.bound,
        }
    }

    /// The greatest one.
    fn greatest(&self, u: [f64; 3]) -> f64 {
        match &self.singular {
            None => self.plain(u)[1],
            Some(own) => {
                let [stretched, varied] = own.stretched.at(u);
                varied + if own.is_greatest { own.bound - stretched } else { stretched - own.bound }
            }
        }
    }

    /// Both of a formula that is not negative.
    fn plain(&self, u: [f64; 3]) -> [f64; 2] {
        let Margin { centre, along, beyond, .. } = self.margin;
        let (own, off) = (centre + dot(along, u), dot(beyond, u.map(f64::abs)));
        [own - off, own + off]
    }
}

impl Singular {
    fn new(over: &dyn View, local: &Local<'_>, bound: Formula, is_greatest: bool) -> Option<Self> {
        let v = local.direction(is_greatest);
        let v = v.map(|x| x / dot(v, v).sqrt());
        let row = |row: &Row<Formula>| {
            let mut a = [Entry::default(); 3];
            for (own, &f) in a.iter_mut().zip(&row.a) {
                *own = Entry::of(over, f)?;
            }
            Some((a, Entry::of(over, row.d)?))
        };
        let e = Slopes::new(&Doubles, over.m());
        let slope = |f: Formula| {
            let (centre, slopes) = (over.centre(f)?, over.slopes(f)?);
            let slopes = std::array::from_fn(|k| slopes.get(k).copied().unwrap_or_default());
            Some(Slope { at_centre: (centre, centre), range: over.range(f)?, slopes })
        };
        let term = |row: &Row<Formula>| {
            let entry = |(&f, &v): (&Formula, &f64)| e.mul(&e.constant((v, v))?, &slope(f)?);
            let product = e.sum(row.a.iter().zip(&v).map(entry))?;
            e.div(&e.sqr(&product)?, &slope(row.d)?)
        };
        let sum = e.sum(local.rows().map(term))?;
        let part = |k: usize| sum.slopes[k];
        let stretched = Entry {
            centre: middle(&sum.at_centre),
            moved: std::array::from_fn(|k| middle(&part(k))),
            varied: std::array::from_fn(|k| half_width(&part(k))),
        };
        let rows = local.rows().map(row).collect::<Option<_>>()?;
        Some(Singular { is_greatest, bound: over.centre(bound)?, v, rows, stretched })
    }

    /// Its square at a place, where it is to be shown to be within its bound.
    fn at(&self, u: [f64; 3], m: usize) -> f64 {
        let (mut gram, mut off) = ([0.0; 6], 0.0);
        for (own, d) in &self.rows {
            let (a, [d_at, d_off]) = (own.each_ref().map(|a| a.at(u)), d.at(u));
            // Of the greatest one G = A^T A/D; of the least one sym(Y^T (2 A - D Y)), Y that of the centre.
            let (y, z) = match self.is_greatest {
                true => (a.map(|a| a[0] / d_at), a.map(|a| a[0])),
                false => {
                    let y = own.map(|a| a.centre / d.centre);
                    (y, std::array::from_fn(|k| 2.0 * a[k][0] - d_at * y[k]))
                }
            };
            for (sum, (j, k)) in gram.iter_mut().zip(PAIRS) {
                *sum += 0.5 * (y[j] * z[k] + y[k] * z[j]);
            }
            let size = self.v.map(f64::abs);
            off += 2.0 * dot(y.map(f64::abs), size) * dot(a.map(|a| a[1]), size);
            off += dot(y, self.v).powi(2) * d_off;
        }
        let spectrum = Spectrum::of_first(m, gram);
        if self.is_greatest {
            spectrum.greatest() + off
        } else {
            spectrum.least() - off
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
