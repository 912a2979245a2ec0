//! Evidence with the workspace's and the orientations' own inequalities: how much of them is taken.

use super::doubles::{half_width, middle, Doubles, Pair};
use super::evidence::{At, Over};
use super::rows::{are_moderate, between, matrix, Form};
use nalgebra::{DMatrix, SymmetricEigen};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::definite::Triangle;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::tolerances::Tolerances;
use orthocert_kernel::test::{self, Multiplier, Row};
use std::cell::OnceCell;

/// Parts of the interval of multiples from which a short one is taken.
const MULTIPLES: [[f64; 2]; 3] = [[0.25, 0.75], [0.02, 0.25], [0.75, 0.98]];
/// Parts of the most that a multiple leaves, of which at least is left with others that are tried.
const LEFT: [f64; 2] = [0.5, 0.9];
/// Halvings to the most that is left.
const HALVINGS: usize = 30;
/// Points, at most, by which multiples are chosen first.
const FEW_POINTS: usize = 64;
/// Signs that are tried for the worst matrix.
const MOST_SIGNS: usize = 4;
/// Powers of two tried as multiples, where what a test leaves is not known.
const POWERS: std::ops::RangeInclusive<i32> = -8..=4;

/// Multiples `low < mu < high` with which `margin > mu g` at all points, given both; `None` where a margin is not known.
fn interval(points: impl IntoIterator<Item = (Option<f64>, f64)>) -> Option<Option<[f64; 2]>> {
    let (mut low, mut high) = (0f64, f64::INFINITY);
    for (margin, g) in points {
        let margin = margin?;
        if g > 0.0 {
            high = high.min(margin / g);
        } else if g < 0.0 {
            low = low.max(margin / g);
        }
        if low >= high || (g == 0.0 && margin <= 0.0) {
            return Some(None);
        }
    }
    let high = if high.is_finite() { high } else { 4.0 * low + 1.0 };
    Some(Some([low, high]))
}

/// The same of what is left, `margin - mu g`, where this is at least a part of the most there is; and the most.
pub fn best(margins: &[f64], g: &[f64], part: f64) -> Option<(f64, [f64; 2])> {
    let above =
        |least: f64| interval(margins.iter().zip(g).map(|(m, &g)| (Some(m - least), g))).flatten();
    let (mut low, mut high) =
        margins.iter().fold((f64::INFINITY, 0.0), |(low, high), &m| (m.min(low), m.max(high)));
    low = low.max(0.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if above(middle).is_some() { &mut low } else { &mut high }) = middle;
    }
    above(part * low).filter(|_| low > 0.0).map(|multiples| (low, multiples))
}

/// Short numbers of an interval.
fn short([low, high]: [f64; 2]) -> impl Iterator<Item = (i64, u32)> {
    let part = move |[a, b]: [f64; 2]| between(low + a * (high - low), low + b * (high - low));
    MULTIPLES.into_iter().filter_map(part)
}

/// What a test leaves at each vertex, or control point, which is computed once, and where it is wanted.
struct Left<'a> {
    margin: &'a dyn Fn(Vertex) -> Option<f64>,
    points: Vec<Vertex>,
    /// The point that is looked at first.
    first: usize,
    known: Vec<OnceCell<Option<f64>>>,
}

impl<'a> Left<'a> {
    fn new(over: &Over<'_>, margin: &'a dyn Fn(Vertex) -> Option<f64>) -> Self {
        let points: Vec<Vertex> = over.formulas.vertices().collect();
        let known = vec![OnceCell::new(); points.len()];
        Left { margin, points, first: over.formulas.first, known }
    }

    fn of(&self, k: usize) -> Option<f64> {
        *self.known[k].get_or_init(|| (self.margin)(self.points[k]))
    }

    /// The first multiple of `g` with which a test holds, if there is one; `None` where it is not known what the test leaves
    /// at the points looked at first.
    fn first_with<T>(
        &self,
        g: &[f64],
        holds: impl Fn((i64, u32)) -> Option<T>,
    ) -> Option<Option<T>> {
        // First those of which a margin that is not positive tells that no multiple is of use.
        let mut order: Vec<usize> = (0..g.len()).collect();
        order.sort_by(|&i, &j| g[j].total_cmp(&g[i]));
        order.sort_by_key(|&k| k != self.first);
        let multiples = |step| interval(order.iter().step_by(step).map(|&k| (self.of(k), g[k])));
        // Multiples that are right for some points mostly are so for all.
        let few = g.len().div_ceil(FEW_POINTS);
        let some = multiples(few)?;
        let first = some.filter(|_| few > 1).and_then(|some| short(some).next());
        if let Some(found) = first.and_then(&holds) {
            return Some(Some(found));
        }
        let Some(multiples) = some.and_then(|_| multiples(1)?) else { return Some(None) };
        let known: Vec<f64> = (0..g.len()).filter_map(|k| self.of(k)).collect();
        let others = LEFT.iter().filter_map(|&part| best(&known, g, part));
        let others = others.filter_map(|(_, [low, high])| between(low, high));
        Some(short(multiples).chain(others).find_map(holds))
    }
}

/// Wraps evidence.
pub type With = fn(Box<Evidence>, i64, u32) -> Evidence;

impl Over<'_> {
    /// The evidence, alone or with one of the inequalities, or both, where the test holds with it.
    pub fn shown(&self, test: &Test, evidence: Evidence) -> Option<Evidence> {
        let margin = |v| self.margin(test, &evidence, v);
        self.shown_with(test, &evidence, &margin)
    }

    /// The same, of which this is left at a vertex, or control point.
    pub fn shown_with(
        &self,
        test: &Test,
        evidence: &Evidence,
        margin: &dyn Fn(Vertex) -> Option<f64>,
    ) -> Option<Evidence> {
        if self.shows(test, evidence) {
            return Some(evidence.clone());
        }
        let all = self.less();
        if all.is_empty() {
            return None;
        }
        let left = Left::new(self, margin);
        let holds = |evidence: Evidence| self.shows(test, &evidence).then_some(evidence);
        let with = |wrap: &With, (n, places)| wrap(Box::new(evidence.clone()), n, places);
        for (wrap, g) in &all {
            match left.first_with(g, |n| holds(with(wrap, n))) {
                Some(Some(found)) => return Some(found),
                Some(None) => {}
                None => {
                    let mut tried = all.iter().flat_map(|(wrap, _)| POWERS.map(move |k| (wrap, k)));
                    let power = |k| between(f64::from(k).exp2(), f64::from(k).exp2());
                    return tried.find_map(|(wrap, k)| holds(with(wrap, power(k)?)));
                }
            }
        }
        let [(inside, t), (turned, g)] = &all[..] else { return None };
        POWERS.into_iter().find_map(|k| {
            let mu = f64::from(k).exp2();
            let inner = with(inside, between(mu, mu)?);
            let less = |k: usize| (left.of(k).map(|m| m - mu * t[k]), g[k]);
            let mut multiples = short(interval((0..g.len()).map(less))??);
            multiples.find_map(|(n, places)| holds(turned(Box::new(inner.clone()), n, places)))
        })
    }

    /// The most that is left of these, alone or less a multiple of one of the inequalities.
    pub fn most(&self, margins: &[f64]) -> f64 {
        let own = margins.iter().fold(f64::INFINITY, |least, m| m.min(least));
        let with = self.less().into_iter().filter_map(|(_, g)| Some(best(margins, &g, 0.5)?.0));
        with.fold(own, f64::max)
    }

    /// The inequalities of the workspace and the orientations at the vertices, or control points; none that is nowhere
    /// negative there, of which nothing is gained.
    pub fn less(&self) -> Vec<(With, Vec<f64>)> {
        let inside = self.inside().map(|g| (Evidence::Inside as With, g));
        let turned = self.turned().map(|g| (Evidence::Turned as With, g));
        let all = inside.into_iter().chain(turned);
        all.filter(|(_, g)| g.iter().any(|g| *g < 0.0)).collect()
    }

    /// The same, by their values at the centre and half of what they change by
    /// along each coordinate.
    pub fn inequalities(&self) -> Vec<Vec<f64>> {
        let inside = self.problem().inside.as_ref().map(|inside| inside.g);
        let all = inside.into_iter().chain(self.problem().turned);
        let affine = |g| {
            let centre = self.centre(g)?;
            let steps = (0..self.m()).map(|k| Some(self.at(g, At::Face(k, 1.0))? - centre));
            [Some(centre)].into_iter().chain(steps).collect()
        };
        all.filter_map(affine).collect()
    }

    /// The workspace's inequality: its tangent at the vertices, itself at control points.
    fn inside(&self) -> Option<Vec<f64>> {
        let inside = self.problem().inside.as_ref()?;
        if self.formulas.controls.is_some() {
            return self.formulas.vertices().map(|v| self.at(inside.g, At::Vertex(v))).collect();
        }
        let g = self.centre(inside.g)?;
        let gradient = inside.gradient.iter().zip(self.formulas.place.edges);
        let steps = gradient.map(|(&f, [_, _, half])| Some(self.centre(f)? * half.0));
        let steps: Vec<f64> = steps.collect::<Option<_>>()?;
        let at = |v: Vertex| {
            let signed = steps.iter().enumerate().map(|(k, s)| if v.has(k) { *s } else { -s });
            g + signed.sum::<f64>()
        };
        Some(self.formulas.vertices().map(at).collect())
    }

    fn turned(&self) -> Option<Vec<f64>> {
        let g = self.problem().turned?;
        self.formulas.vertices().map(|v| self.at(g, At::Vertex(v))).collect()
    }

    /// The least eigenvalue, or value, of what a test wants positive, at a vertex or control point, less what tolerances
    /// change, or somewhat more; of some tests it is not known.
    fn margin(&self, test: &Test, evidence: &Evidence, v: Vertex) -> Option<f64> {
        let at = At::Vertex(v);
        let form = match evidence {
            Evidence::LowerDivided(_) | Evidence::Divided => Form::Divided,
            _ if self.formulas.controls.is_some() => Form::Scaled,
            _ => Form::Plain,
        };
        let weight = self.problem().weight.filter(|_| form == Form::Scaled);
        let weight = weight.map_or(Some(1.0), |weight| self.at(weight, at))?;
        let own = self.prover.rows(form);
        let lower = |rows: &[Row<Formula>], square: f64, y: (&Multiplier, bool)| {
            self.least_of(rows, |formulas| formulas.lower(rows, v, &(-square, -square), y))
        };
        let upper = |rows: &[Row<Formula>], square: f64| {
            self.least_of(rows, |formulas| formulas.upper(rows, v, &(square, square)))
        };
        match (test, evidence) {
            (Test::SigmaMin(_), Evidence::Rank(y)) => lower(own, 0.0, (y, false)),
            (Test::SigmaMin(kappa), Evidence::Lower(y) | Evidence::LowerDivided(y)) => {
                lower(own, self.centre(*kappa)? * weight, (y, true))
            }
            (Test::SigmaMax(k), Evidence::Test | Evidence::Divided) => {
                upper(own, self.centre(*k)? * weight)
            }
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                let first = *mu.first()? as f64 * (-f64::from(y.places)).exp2();
                let mu = first * weight + self.mu_along((mu, y.places), v)?;
                let least = upper(own, self.centre(*c)? * mu)?;
                Some(lower(own, mu, (y, true))?.min(least))
            }
            (Test::Conditioning(c), Evidence::Lower(_) | Evidence::Test) => {
                let half = self.formulas.half?;
                let mu = self.mu_at_centre(half)? + self.mu_along(half.mu, v)?;
                match evidence {
                    Evidence::Lower(y) => lower(own, mu, (y, true)),
                    _ => upper(own, self.centre(*c)? * mu),
                }
            }
            (Test::Least(rows, kappa), Evidence::Lower(y)) => {
                lower(rows, self.formulas.greatest_at(*kappa, v)?.1, (y, true))
            }
            (Test::Greatest(rows, k), Evidence::Test) => {
                upper(rows, self.formulas.least_at(*k, v)?.0)
            }
            (Test::OneToOne(rows), Evidence::Chords) => {
                lower(rows, 0.0, (self.prover.chords.as_ref()?, false))
            }
            // Of the one machine, as below.
            (Test::Solve(solve), Evidence::Lower(y)) => {
                let (rows, y) = (self.own(form, at)?, matrix(y));
                let t = &rows.a * y.transpose();
                let mut t = &t + t.transpose() - weight * &y * y.transpose();
                let i = solve.joint;
                t[(i, i)] -= self.centre(solve.square)? * rows.d[i];
                Some(t.symmetric_eigenvalues().min())
            }
            (Test::AtLeast(f), _) => Some(self.formulas.least_at(*f, v)?.0),
            (Test::Beyond(f, b), _) => {
                let [f, b] = [self.formulas.own_at(*f, v)?, self.formulas.own_at(*b, v)?];
                let least = if *evidence == Evidence::Negative { -f.1 } else { f.0 };
                Some(least - b.1)
            }
            (_, Evidence::Together(inner, all, places)) => {
                let together = Some((&all[..], *places));
                let formulas = test::Over { together, inside: None, ..*self.formulas };
                Over { formulas: &formulas, ..*self }.margin(test, inner, v)
            }
            _ => None,
        }
    }

    /// What `mu_1, .., mu_m`, of these with `mu_0` over binary places, are at a vertex or control point.
    fn mu_along(&self, (mu, places): (&[i64], u32), v: Vertex) -> Option<f64> {
        let signed = mu.iter().skip(1).enumerate().map(|(k, &mu)| match mu {
            0 => Some(0.0),
            mu => Some(self.formulas.place(k, v)? as f64 * mu as f64),
        });
        Some((-f64::from(places)).exp2() * signed.sum::<Option<f64>>()?)
    }

    /// What is least of a matrix, with nothing taken off where it is about the directions of a wedge, in whose coordinates that
    /// is; without end where there is no such matrix, whatever the multiple.
    fn least_of(
        &self,
        rows: &[Row<Formula>],
        matrix: impl Fn(&test::Over<'_, Doubles>) -> Option<Triangle<Pair>>,
    ) -> Option<f64> {
        let all = match (self.formulas.wedge, self.formulas.tolerances) {
            (Some(_), Some(all)) => {
                let none = vec![Vec::new(); all.steps.len()];
                let directions = [vec![0; rows.first()?.a.len()]];
                let machine =
                    Tolerances { steps: &none, second: None, directions: &directions, ..*all };
                matrix(&test::Over { tolerances: Some(&machine), inside: None, ..*self.formulas })
            }
            _ => matrix(self.formulas),
        };
        let Some(all) = all else { return Some(f64::NEG_INFINITY) };
        let n = rows.first()?.a.len();
        let at = |i: usize, j: usize| all.row(i.min(j))[i.abs_diff(j)];
        let own = DMatrix::from_fn(n, n, |i, j| middle(&at(i, j)));
        let off = DMatrix::from_fn(n, n, |i, j| half_width(&at(i, j)));
        let is_moderate = n > 0 && are_moderate(own.iter().chain(off.iter()));
        is_moderate.then(|| least_eigenvalue(&own, &off))
    }
}

/// The least eigenvalue of all symmetric matrices that differ from this one by so much at most in each entry, or somewhat more.
///
/// Of these, the least along `v` is that with the signs of `v`, `T - S R S`: its direction is the next.
fn least_eigenvalue(own: &DMatrix<f64>, off: &DMatrix<f64>) -> f64 {
    let (mut least, mut worst) = (f64::INFINITY, own.clone());
    for _ in 0..MOST_SIGNS {
        let eigen = SymmetricEigen::new(worst);
        let k = eigen.eigenvalues.imin();
        if eigen.eigenvalues[k] >= least {
            break;
        }
        let v = eigen.eigenvectors.column(k);
        let signed = |i: usize, j: usize| off[(i, j)] * (v[i] * v[j]).signum();
        worst = own - DMatrix::from_fn(own.nrows(), own.ncols(), signed);
        least = v.dot(&(&worst * v));
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of all signs the worst is found, and without any it is an eigenvalue.
    #[test]
    fn the_least_eigenvalue_of_a_box_of_matrices_is_that_of_the_worst_signs() {
        let own = DMatrix::from_row_slice(3, 3, &[2.0, 0.1, -0.2, 0.1, 2.2, 0.3, -0.2, 0.3, 2.1]);
        let off = DMatrix::from_row_slice(3, 3, &[0.1, 0.3, 0.2, 0.3, 0.2, 0.4, 0.2, 0.4, 0.1]);
        let of_signs = |signs: usize| {
            let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
            let worst =
                DMatrix::from_fn(3, 3, |i, j| own[(i, j)] - off[(i, j)] * sign(i) * sign(j));
            worst.symmetric_eigenvalues().min()
        };
        let least = (0..4).map(of_signs).fold(f64::INFINITY, f64::min);
        let found = least_eigenvalue(&own, &off);
        assert!((found - least).abs() < 1e-12, "{found} {least}");
        let alone = least_eigenvalue(&own, &(&off * 0.0));
        assert!((alone - own.symmetric_eigenvalues().min()).abs() < 1e-12, "{alone}");
    }
}
