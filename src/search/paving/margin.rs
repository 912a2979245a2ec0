//! By how much tests hold at the centre of a cell, and what its coordinates move that by to first order.

use super::spectrum::{Spectrum, PAIRS};
use crate::search::solver::doubles::{half_width, magnitude, middle, Pair};
use crate::search::solver::evidence::Over;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Row;

/// A value that is not negative where a test holds: at the centre, by how much each coordinate moves it to
/// first order, and, about, beyond that.
#[derive(Clone, Copy, Debug, Default)]
pub struct Margin {
    pub centre: f64,
    pub along: [f64; 3],
    pub beyond: [f64; 3],
    /// By how much the value at the centre may be off, about, where it is foreseen.
    pub off: f64,
}

impl Margin {
    /// What is foreseen of it on the lower and the upper half along an axis.
    pub(super) fn halves(&self, axis: usize) -> [Self; 2] {
        let mut half = *self;
        half.along[axis] *= 0.5;
        half.beyond[axis] *= 0.5;
        half.off += half.beyond[axis];
        let moved = half.along[axis];
        let at = |centre: f64| Margin { centre, ..half };
        [at(self.centre - moved), at(self.centre + moved)]
    }

    /// Whether the test seems to hold on the cell, to second order.
    pub(super) fn holds(&self) -> bool {
        self.centre - self.reach() > self.bent()
    }

    /// Whether it seems to fail at all points.
    pub(super) fn fails(&self) -> bool {
        self.centre + self.reach() < -self.bent()
    }

    /// Whether what is foreseen is far enough from both, or from where one of them begins, not to be wrong about that.
    pub(super) fn is_sure(&self) -> bool {
        (self.centre.abs() - self.reach()).abs() > self.off + self.bent()
    }

    fn bent(&self) -> f64 {
        self.beyond.iter().sum()
    }

    pub(super) fn reach(&self) -> f64 {
        self.along.iter().map(|x| x.abs()).sum()
    }

    /// How close it is to failing, relative to what the cell moves it by.
    pub(super) fn room(&self) -> f64 {
        self.centre / self.reach().max(f64::MIN_POSITIVE)
    }

    /// What is gained by halving each coordinate.
    pub(super) fn weights(&self) -> [f64; 3] {
        let of = |k: usize| self.along[k].abs() + self.beyond[k].abs();
        [of(0), of(1), of(2)]
    }

    fn times(self, factor: f64) -> Self {
        let times = |[x, y, z]: [f64; 3]| [x * factor, y * factor, z * factor];
        let Margin { centre, along, beyond, off } = self;
        let [x, y, z] = times(beyond);
        let beyond = [x.abs(), y.abs(), z.abs()];
        let off = off * factor.abs();
        Margin { centre: centre * factor, along: times(along), beyond, off }
    }

    /// Of `|f| - b`, with the sign that `f` has at the centre.
    pub(super) fn beyond(self, b: Self) -> Self {
        let sign = if self.centre < 0.0 { -1.0 } else { 1.0 };
        self.times(sign).plus(b.times(-1.0))
    }

    fn plus(self, other: Self) -> Self {
        let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let (along, beyond) = (sum(self.along, other.along), sum(self.beyond, other.beyond));
        let off = self.off + other.off;
        Margin { centre: self.centre + other.centre, along, beyond, off }
    }

    /// Of `f >= 0`.
    pub(super) fn of(over: &(impl View + ?Sized), f: Formula) -> Option<Self> {
        let slopes = over.slopes(f)?;
        let of = |part: fn(&Pair) -> f64| {
            std::array::from_fn(|k| if k < over.m() { part(&slopes[k]) } else { 0.0 })
        };
        // To first order or not: where it may not be defined, all counts.
        let along = of(|slope| magnitude(slope).copysign(middle(slope)));
        let beyond = of(half_width);
        Some(Margin { centre: over.centre(f)?, along, beyond, off: 0.0 })
    }

    /// Of a test; `None` where it has none.
    pub(super) fn of_test(
        over: &(impl View + ?Sized),
        local: &Local<'_>,
        test: &Test,
    ) -> Option<Self> {
        let bound = |f: Formula| over.centre(f);
        let less = |stretched: Margin, bound: f64| Margin {
            centre: stretched.centre - bound,
            ..stretched
        };
        let least = |local: &Local<'_>| local.stretched(over, local.spectrum.least_direction());
        Some(match test {
            Test::SigmaMin(kappa) => less(least(local), bound(*kappa)?),
            Test::SigmaMax(k) => {
                let v = local.spectrum.greatest_direction();
                less(local.stretched(over, v), bound(*k)?).times(-1.0)
            }
            Test::Least(rows, kappa) => {
                let local = Local::of(rows.iter(), |f| over.centre(f))?;
                less(least(&local), bound(*kappa)?)
            }
            Test::Greatest(rows, k) => {
                let local = Local::of(rows.iter(), |f| over.centre(f))?;
                let v = local.spectrum.greatest_direction();
                less(local.stretched(over, v), bound(*k)?).times(-1.0)
            }
            Test::AtLeast(f) => Margin::of(over, *f)?,
            Test::Beyond(f, b) => Margin::of(over, *f)?.beyond(Margin::of(over, *b)?),
            Test::Conditioning(_)
            | Test::OneToOne(_)
            | Test::Solve(_)
            | Test::Accuracy(_)
            | Test::Apart(_)
            | Test::Curvature(_) => return None,
        })
    }
}

/// Formulas over a cell of up to three coordinates, in doubles.
pub(super) trait View {
    /// The coordinates.
    fn m(&self) -> usize;
    /// At the centre.
    fn centre(&self, f: Formula) -> Option<f64>;
    /// On the cell.
    fn range(&self, f: Formula) -> Option<Pair>;
    /// The slopes, times the cell's half-widths.
    fn slopes(&self, f: Formula) -> Option<[Pair; 3]>;
    /// The middles of slopes, and by how much they vary over the cell.
    fn moved(&self, f: Formula) -> [[f64; 3]; 2] {
        let known = self.slopes(f).unwrap_or_default();
        [known.map(|x| middle(&x)), known.map(|x| half_width(&x))]
    }
}

impl View for Over<'_> {
    fn m(&self) -> usize {
        Over::m(self)
    }

    fn centre(&self, f: Formula) -> Option<f64> {
        Over::centre(self, f)
    }

    fn range(&self, f: Formula) -> Option<Pair> {
        self.formulas.of(f).map(|slope| slope.range)
    }

    fn slopes(&self, f: Formula) -> Option<[Pair; 3]> {
        self.formulas.of(f).map(|slope| std::array::from_fn(|k| slope.slopes[k]))
    }
}

/// `M` at a cell's centre, and what its rows are made of.
pub(super) struct Local<'a> {
    rows: Vec<(&'a Row<Formula>, [f64; 3], f64)>,
    spectrum: Spectrum,
}

impl<'a> Local<'a> {
    /// `None` unless all is defined there.
    pub(super) fn of(
        rows: impl Iterator<Item = &'a Row<Formula>>,
        centre: impl Fn(Formula) -> Option<f64>,
    ) -> Option<Self> {
        let mut own = Vec::with_capacity(6);
        let (mut gram, mut m) = ([0.0; 6], 0);
        for row in rows {
            let d = centre(row.d).filter(|d| *d > 0.0)?;
            let mut a = [0.0; 3];
            m = row.a.len();
            for (a, &f) in a.iter_mut().zip(&row.a) {
                *a = centre(f)?;
            }
            for (sum, (j, k)) in gram.iter_mut().zip(PAIRS) {
                *sum += a[j] * a[k] / d;
            }
            own.push((row, a, d));
        }
        let is_finite = gram.iter().all(|x| x.is_finite());
        is_finite.then(|| Local { rows: own, spectrum: Spectrum::of_first(m, gram) })
    }

    /// The rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = &'a Row<Formula>> + '_ {
        self.rows.iter().map(|(row, ..)| *row)
    }

    /// The direction that is stretched most, or least.
    pub(super) fn direction(&self, greatest: bool) -> [f64; 3] {
        match greatest {
            true => self.spectrum.greatest_direction(),
            false => self.spectrum.least_direction(),
        }
    }

    /// `|M v|^2/|v|^2`.
    fn stretched(&self, over: &(impl View + ?Sized), v: [f64; 3]) -> Margin {
        let dot = |a: &[f64; 3]| a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
        let mut sum = Margin::default();
        for (row, a, d) in &self.rows {
            let product = dot(a);
            sum.centre += product * product / d;
            let (mut moved, mut varied) = ([0.0; 3], [0.0; 3]);
            for (&f, v) in row.a.iter().zip(v) {
                let [middles, vary] = over.moved(f);
                for k in 0..3 {
                    moved[k] += middles[k] * v;
                    varied[k] += vary[k] * v.abs();
                }
            }
            let [of_d, d_varies] = over.moved(row.d);
            for k in 0..over.m() {
                let moved = moved[k] - 0.5 * product * of_d[k] / d;
                sum.along[k] += 2.0 * product * moved / d;
                let varied = 2.0 * varied[k] + product.abs() * d_varies[k] / d;
                sum.beyond[k] += (product.abs() * varied + moved * moved) / d;
            }
        }
        sum.times(dot(&v).recip())
    }

    /// `sigma_max / sigma_min`, nearly.
    pub(super) fn conditioning(&self) -> f64 {
        let least = self.spectrum.least().max(f64::MIN_POSITIVE);
        (self.spectrum.greatest() / least).sqrt()
    }
}

/// Whether a test has no [`Margin`].
pub(super) fn is_general(test: &Test) -> bool {
    use Test::{Accuracy, Apart, Conditioning, Curvature, OneToOne, Solve};
    matches!(test, OneToOne(_) | Solve(_) | Accuracy(_) | Apart(_) | Curvature(_) | Conditioning(_))
}
