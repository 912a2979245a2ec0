//! Evidence with the workspace's and the orientations' own inequalities: how much of them is taken.

use super::evidence::{At, Over};
use super::rows::{between, matrix, Form, Rows};
use nalgebra::DMatrix;
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::quantity::Test;
use std::cell::OnceCell;

/// Parts of the interval of multiples from which a short one is taken.
const MULTIPLES: [[f64; 2]; 3] = [[0.25, 0.75], [0.02, 0.25], [0.75, 0.98]];
/// Parts of the most that a multiple leaves, of which at least is left with others that are tried.
const LEFT: [f64; 2] = [0.5, 0.9];
/// Halvings to the most that is left.
const HALVINGS: usize = 30;
/// Powers of two tried as multiples, where what a test leaves is not known.
const POWERS: std::ops::RangeInclusive<i32> = -8..=4;

/// Multiples `low < mu < high` with which `margin > mu g` at all points; `None` where a margin is not known.
fn interval(margins: impl IntoIterator<Item = Option<f64>>, g: &[f64]) -> Option<Option<[f64; 2]>> {
    let (mut low, mut high) = (0f64, f64::INFINITY);
    for (margin, &g) in margins.into_iter().zip(g) {
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
    let above = |least: f64| interval(margins.iter().map(|m| Some(m - least)), g).flatten();
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
        let holds = |evidence: Evidence| self.shows(test, &evidence).then_some(evidence);
        let points: Vec<Vertex> = self.formulas.vertices().collect();
        let known = vec![OnceCell::new(); points.len()];
        let of = |(known, &v): (&OnceCell<Option<f64>>, &Vertex)| *known.get_or_init(|| margin(v));
        let margins = || known.iter().zip(&points).map(of);
        let with = |with: &With, (n, places)| with(Box::new(evidence.clone()), n, places);
        for (wrap, g) in &all {
            let Some(multiples) = interval(margins(), g) else {
                let mut tried = all.iter().flat_map(|(wrap, _)| POWERS.map(move |k| (wrap, k)));
                return tried.find_map(|(wrap, k)| {
                    holds(with(wrap, between(f64::from(k).exp2(), f64::from(k).exp2())?))
                });
            };
            let Some(multiples) = multiples else { continue };
            let known: Vec<f64> = margins().flatten().collect();
            let others = LEFT.iter().filter_map(|&part| best(&known, g, part));
            let others = others.filter_map(|(_, [low, high])| between(low, high));
            let found = short(multiples).chain(others).find_map(|n| holds(with(wrap, n)));
            if found.is_some() {
                return found;
            }
        }
        let [(inside, t), (turned, g)] = &all[..] else { return None };
        POWERS.into_iter().find_map(|k| {
            let mu = f64::from(k).exp2();
            let left = margins().zip(t).map(|(m, t)| Some(m? - mu * t));
            let inner = with(inside, between(mu, mu)?);
            let mut multiples = short(interval(left, g)??);
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

    /// The least eigenvalue, or value, of what a test wants positive, at a vertex or control point; of
    /// some tests it is not known.
    fn margin(&self, test: &Test, evidence: &Evidence, v: Vertex) -> Option<f64> {
        let least = |t: DMatrix<f64>| t.symmetric_eigenvalues().min();
        let at = At::Vertex(v);
        let greatest = |rows: Rows| rows.square().symmetric_eigenvalues().max();
        let form = match evidence {
            Evidence::LowerDivided(_) | Evidence::Divided => Form::Divided,
            _ if self.formulas.controls.is_some() => Form::Scaled,
            _ => Form::Plain,
        };
        let weight = self.problem().weight.filter(|_| form == Form::Scaled);
        let weight = weight.map_or(Some(1.0), |weight| self.at(weight, at))?;
        let own = || -> Option<Rows> { self.own(form, at) };
        match (test, evidence) {
            (Test::SigmaMin(_), Evidence::Rank(y)) => Some(least(own()?.symmetric(&matrix(y)))),
            (Test::SigmaMin(kappa), Evidence::Lower(y) | Evidence::LowerDivided(y)) => {
                let kappa = self.centre(*kappa)? * weight;
                Some(least(own()?.minorant(&matrix(y))) - kappa)
            }
            (Test::SigmaMax(k), Evidence::Test | Evidence::Divided) => {
                Some(self.centre(*k)? * weight - greatest(own()?))
            }
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                let scale = (-f64::from(y.places)).exp2();
                let signed = mu.iter().enumerate().map(|(k, &mu)| match k.checked_sub(1) {
                    None => Some(mu as f64 * weight),
                    Some(_) if mu == 0 => Some(0.0),
                    Some(k) => Some(self.formulas.place(k, v)? as f64 * mu as f64),
                });
                let (mu, rows) = (scale * signed.sum::<Option<f64>>()?, own()?);
                let lower = least(rows.minorant(&matrix(y))) - mu;
                Some(lower.min(self.centre(*c)? * mu - greatest(rows)))
            }
            (Test::Least(rows, kappa), Evidence::Lower(y)) => {
                let rows = self.rows(rows.iter(), at)?;
                Some(least(rows.minorant(&matrix(y))) - self.at(*kappa, at)?)
            }
            (Test::Greatest(rows, k), Evidence::Test) => {
                Some(self.at(*k, at)? - greatest(self.rows(rows.iter(), at)?))
            }
            (Test::OneToOne(rows), Evidence::Chords) => {
                let y = matrix(self.prover.chords.as_ref()?);
                Some(least(self.rows(rows.iter(), at)?.symmetric(&y)))
            }
            (Test::Solve(solve), Evidence::Lower(y)) => {
                let (rows, y) = (own()?, matrix(y));
                let t = &rows.a * y.transpose();
                let mut t = &t + t.transpose() - weight * &y * y.transpose();
                let i = solve.joint;
                t[(i, i)] -= self.centre(solve.square)? * rows.d[i];
                Some(least(t))
            }
            (Test::AtLeast(f), _) => {
                let low = self.formulas.own_at(*f, v)?;
                Some(low.0)
            }
            (Test::Beyond(f, b), Evidence::Negative) => {
                Some(-self.formulas.own_at(*f, v)?.1 - self.formulas.own_at(*b, v)?.1)
            }
            (Test::Beyond(f, b), _) => {
                Some(self.formulas.own_at(*f, v)?.0 - self.formulas.own_at(*b, v)?.1)
            }
            _ => None,
        }
    }
}
