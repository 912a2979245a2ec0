//! Proposals: evidence with which the kernel's tests hold on a box, in doubles.

use super::balance::Balance;
use super::directions::directions;
use super::doubles::middle;
use super::evidence::{At, Over};
use super::rows::{above, exponent, rounded, Form, Rows};
use super::violation;
use nalgebra::{DMatrix, DVector};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::{Corner, Evidence};
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::apart::Apart;
use orthocert_kernel::test::curvature::Curvature;
use orthocert_kernel::test::solve::Solve;
use orthocert_kernel::test::{Half, Multiplier, Row};

/// Bits of the greatest entry of a multiplier that is tried first.
pub(super) const FINE: i32 = 15;
/// The same, of what `mu` shares its places with: what it is rounded by is lost whole.
const FINER: i32 = 27;
/// Bits tried for a shorter one.
const SHORT: [i32; 9] = [1, 2, 3, 4, 5, 6, 8, 10, 12];
/// Parts of `b z^T/c^2` in what is tried for solutions.
const OWN: [f64; 3] = [0.0, 0.3, 0.6];

impl Over<'_> {
    /// Evidence with which a test holds; with directions apart, if they are.
    pub(super) fn evidence_of(&self, test: &Test, apart: bool) -> Option<Evidence> {
        let in_one = self.evidence(test);
        in_one.or_else(|| if apart { self.with_directions_apart(test) } else { None })
    }

    /// The same for all directions at once.
    pub fn evidence(&self, test: &Test) -> Option<Evidence> {
        let all_machines = self.at_controls(test).or_else(|| self.at_vertices(test));
        all_machines.or_else(|| self.with_tolerances_apart(test))
    }

    /// At control points, of platforms that turn.
    pub(super) fn at_controls(&self, test: &Test) -> Option<Evidence> {
        if !self.is_polynomial(test) {
            return None;
        }
        self.there(test, |there| {
            let found = match test {
                Test::SigmaMin(kappa) => there.lower(test, *kappa, Form::Scaled),
                Test::Conditioning(c) => there.conditioning(test, *c, Form::Scaled),
                Test::OneToOne(_) => there.shown(test, Evidence::Chords),
                Test::Solve(solve) => there.solution(test, solve),
                Test::Least(rows, kappa) => there.least(test, rows, *kappa),
                Test::Accuracy(accuracy) => there.accuracy(test, accuracy),
                _ => there.shown(test, Evidence::Test),
            };
            found.map(|inner| Evidence::Control(Box::new(inner)))
        })
    }

    /// Whether a test is of polynomials, which control points want.
    fn is_polynomial(&self, test: &Test) -> bool {
        match test {
            Test::Conditioning(_) if self.formulas.half.is_some() => false,
            Test::SigmaMin(_)
            | Test::SigmaMax(_)
            | Test::Conditioning(_)
            | Test::OneToOne(_)
            | Test::Solve(_)
            | Test::Least(..)
            | Test::Greatest(..) => self.prover.is_scaled,
            Test::Accuracy(test) => !test.scaled.is_empty(),
            Test::AtLeast(_) => self.problem().weight.is_some(),
            _ => false,
        }
    }

    /// At control points, where the test's formulas have the form for them.
    pub(super) fn there<T>(
        &self,
        test: &Test,
        then: impl FnOnce(&Over<'_>) -> Option<T>,
    ) -> Option<T> {
        self.prover.checker.at_controls(self.formulas, test, |formulas| {
            let first = Vertex::first(1).next()?;
            let lacks = matches!(test, Test::AtLeast(f) if formulas.own_at(*f, first).is_none());
            (!lacks).then(|| then(&Over { formulas, ..*self }))?
        })?
    }

    pub(super) fn at_vertices(&self, test: &Test) -> Option<Evidence> {
        match test {
            Test::SigmaMin(kappa) => self
                .lower(test, *kappa, Form::Plain)
                .or_else(|| self.lower(test, *kappa, Form::Divided))
                .or_else(|| self.corner(test)),
            Test::SigmaMax(_) => {
                self.first(test, [Evidence::Cube, Evidence::Test, Evidence::Divided])
            }
            Test::Conditioning(c) => match self.formulas.half {
                None => self.conditioning(test, *c, Form::Plain),
                Some(Half { upper: Some(_), .. }) => self.shown(test, Evidence::Test),
                Some(half) => {
                    let kappa = self.mu_at_centre(half)?.sqrt();
                    let starts = self.own(Form::Plain, At::Centre)?.starts(kappa);
                    self.shortest_of(test, starts, Evidence::Lower)
                }
            },
            Test::AtLeast(_) => self.first(test, [Evidence::Cube, Evidence::Test]),
            Test::Curvature(curvature) => self.curvature(test, curvature),
            Test::Beyond(..) => self.first(test, [Evidence::Test, Evidence::Negative]),
            Test::Least(rows, kappa) => self.least(test, rows, *kappa),
            Test::Greatest(..) => self.shown(test, Evidence::Test),
            Test::OneToOne(_) => self.shown(test, Evidence::Chords),
            Test::Solve(solve) => self.solution(test, solve),
            Test::Accuracy(accuracy) => self.accuracy(test, accuracy),
            Test::Apart(apart) => self.apart(test, apart),
        }
    }

    /// The `mu` of one bound, of the one machine.
    pub(super) fn mu_at_centre(
        &self,
        Half { mu: (mu, places), weights, .. }: Half<'_>,
    ) -> Option<f64> {
        let own = self.formulas.tolerances.map(|one| one.parameters);
        let parameters = own.unwrap_or(self.prover.parameters());
        let terms = weights.iter().flatten();
        let terms = terms.map(|(j, n)| Some(*n as f64 * middle(parameters.get(*j)?)));
        let more = terms.sum::<Option<f64>>()?;
        Some((*mu.first()? as f64 + more) * (-f64::from(places)).exp2())
    }

    fn first(&self, test: &Test, all: impl IntoIterator<Item = Evidence>) -> Option<Evidence> {
        all.into_iter().find_map(|evidence| self.shown(test, evidence))
    }

    /// Of the evidence with so many bits, the shortest with which the test holds.
    fn shortest(&self, test: &Test, with: impl Fn(i32) -> Option<Evidence>) -> Option<Evidence> {
        self.shortest_from(FINE, test, with)
    }

    fn shortest_from(
        &self,
        fine: i32,
        test: &Test,
        with: impl Fn(i32) -> Option<Evidence>,
    ) -> Option<Evidence> {
        let found = self.shown(test, with(fine)?)?;
        Some(self.shortened(test, found, with))
    }

    pub(super) fn shortened(
        &self,
        test: &Test,
        found: Evidence,
        with: impl Fn(i32) -> Option<Evidence>,
    ) -> Evidence {
        let shorter = SHORT.into_iter().find_map(|bits| {
            let evidence = around(&found, with(bits)?);
            self.shows(test, &evidence).then_some(evidence)
        });
        shorter.unwrap_or(found)
    }

    fn shortest_of(
        &self,
        test: &Test,
        all: impl IntoIterator<Item = DMatrix<f64>>,
        form: impl Fn(Multiplier) -> Evidence,
    ) -> Option<Evidence> {
        all.into_iter()
            .find_map(|y| self.shortest(test, |bits| Some(form(rounded(&y, bits + above(&y))?))))
    }

    /// The root of the weight by which rows of this form are scaled, at the centre.
    fn scale(&self, form: Form) -> f64 {
        let weight = self.problem().weight.filter(|_| form == Form::Scaled);
        weight.and_then(|weight| self.centre(weight)).unwrap_or(1.0).sqrt()
    }

    fn lower(&self, test: &Test, kappa_squared: Formula, form: Form) -> Option<Evidence> {
        let kappa = self.centre(kappa_squared)?.max(0.0).sqrt();
        let zero = self.problem().tape.op(kappa_squared) == Op::Integer(0);
        let with = match form {
            Form::Divided => Evidence::LowerDivided,
            _ if zero => Evidence::Rank,
            _ => Evidence::Lower,
        };
        let rows = self.own(form, At::Centre)?;
        self.shortest_of(test, rows.starts(kappa * self.scale(form)), with)
    }

    /// At a tight corner of the paper's cube.
    fn corner(&self, test: &Test) -> Option<Evidence> {
        let touched = [Corner::Q1, Corner::Q2].into_iter().zip(self.formulas.place.touches);
        let corners = touched.filter(|_| self.problem().cube_kappa.is_some());
        let corners = corners.filter_map(|(corner, touches)| touches.then_some(corner));
        self.first(test, corners.map(Evidence::Corner))
    }

    fn least(&self, test: &Test, rows: &[Row<Formula>], kappa: Formula) -> Option<Evidence> {
        let (kappa, own) = (self.centre(kappa)?, self.rows(rows.iter(), At::Centre)?);
        // What is less than no square, nothing shows as well as anything.
        let starts = match kappa < 0.0 {
            true => vec![&own.a * 0.0],
            false => own.starts(kappa.sqrt()),
        };
        self.shortest_of(test, starts, Evidence::Lower)
    }

    /// `mu` so far between what both bounds allow: at the centre, and, by differences, along each
    /// coordinate, of scaled rows times the weight there.
    pub(super) fn mu(&self, c_squared: f64, form: Form, part: f64) -> Option<Vec<f64>> {
        let weight = self.scale(form).powi(2);
        let bounds = |at| {
            let xi: DVector<f64> = self.own(Form::Plain, at)?.m().singular_values();
            Some([xi.min(), xi.max() / c_squared.sqrt()])
        };
        let ends = |k| Some([bounds(At::Face(k, -1.0))?, bounds(At::Face(k, 1.0))?]);
        let (centre, faces) = (bounds(At::Centre)?, (0..self.m()).map(ends));
        let faces: Vec<[[f64; 2]; 2]> = faces.collect::<Option<_>>()?;
        // A value at the centre, and half of what it changes by between faces.
        let along = |of: &dyn Fn([f64; 2]) -> f64| {
            let steps = faces.iter().map(|&[low, high]| 0.5 * (of(high) - of(low)));
            [of(centre)].into_iter().chain(steps).collect::<Vec<f64>>()
        };
        let mut mu = along(&|[low, high]| ((1.0 - part) * low + part * high).powi(2));
        // One multiple of what is not negative in the workspace is taken off both bounds, of which one is `c^2` times the
        // other: `mu` is half-way between what is left of them.
        let mut left = along(&|[low, high]| low * low - high * high);
        for g in self.inequalities() {
            let g: Vec<f64> = g.iter().map(|g| g / weight).collect();
            let multiple = multiple(&left, &g);
            let off = 0.5 * multiple * (c_squared - 1.0) / (c_squared + 1.0);
            mu.iter_mut().zip(&g).for_each(|(mu, g)| *mu -= off * g);
            left.iter_mut().zip(&g).for_each(|(left, g)| *left -= multiple * g);
        }
        mu.iter_mut().skip(1).for_each(|mu| *mu *= weight);
        Some(mu)
    }

    fn conditioning(&self, test: &Test, c_squared: Formula, form: Form) -> Option<Evidence> {
        let c_squared = self.centre(c_squared)?;
        let mu = self.mu(c_squared, form, 0.5)?;
        // As fine as what may stand between both bounds, `mu` and `c^2 mu`.
        let size = exponent(mu[0] * (1.0 - c_squared.recip()).clamp(f64::EPSILON, 0.5));
        let starts = self.own(form, At::Centre)?.starts(mu[0].sqrt() * self.scale(form));
        let with = |y: &DMatrix<f64>, mu: &[f64], bits: i32| {
            let places = (bits + above(y)).max(bits + 4 - size);
            let multiplier = rounded(y, places)?;
            let scale = f64::from(multiplier.places).exp2();
            let mu = mu.iter().map(|mu| (mu * scale).round() as i64).collect();
            Some(Evidence::Conditioning(multiplier, mu))
        };
        let mut starts = starts.into_iter();
        if form != Form::Scaled {
            return starts
                .find_map(|y| self.shortest_from(FINER, test, |bits| with(&y, &mu, bits)));
        }
        let balance = Balance::new(self, c_squared, mu[0])?;
        starts.find_map(|y| {
            let best = balance.best(self, &y)?;
            let found = best.less(with(&y, &best.mu, FINER)?)?;
            self.shows(test, &found)
                .then(|| self.shortened(test, found, |bits| with(&y, &best.mu, bits)))
        })
    }

    /// `Y` for the solution `z` of `A z = b`, `b = B_i e_i`: `A` at the centre, then between it and
    /// `k^2 b z^T`, which loses nothing along `b`.
    fn solution(&self, test: &Test, solve: &Solve) -> Option<Evidence> {
        let Rows { a, d } = self.own(Form::Plain, At::Centre)?;
        let mut b = DVector::zeros(a.nrows());
        b[solve.joint] = d[solve.joint].sqrt();
        let z = a.clone().lu().solve(&b)?;
        let own = &b * z.transpose() * self.centre(solve.square)?;
        let all = OWN.map(|part| &a * (1.0 - part) + &own * part);
        self.shortest_of(test, all, Evidence::Lower)
    }

    /// With the row's length at the vertices, or by its lever, with which more is left.
    fn curvature(&self, test: &Test, curvature: &Curvature) -> Option<Evidence> {
        let margins = |lever: Option<[Formula; 2]>| -> Option<Vec<f64>> {
            let at = |v| {
                let of = |f| self.at(f, At::Vertex(v));
                let (sum, _) = violation::curved(curvature, of)?;
                let Some([square, s]) = lever else { return Some(1.0 - sum) };
                let row = curvature
                    .row
                    .iter()
                    .map(|&f| Some(of(f)?.powi(2)))
                    .sum::<Option<f64>>()?
                    .sqrt();
                let (square, centre) = (self.centre(square)?, self.centre(s)?);
                let longest = (square - centre * of(s)?) / (square - centre * centre).sqrt();
                Some(1.0 - sum + self.centre(curvature.a)? * (row - longest))
            };
            self.formulas.vertices().map(at).collect()
        };
        let both = [None, curvature.lever].into_iter().filter_map(margins);
        let both = both.map(|margins| (self.most(&margins), margins));
        let (most, margins) = both.max_by(|a, b| a.0.total_cmp(&b.0))?;
        if most <= 0.0 {
            return None;
        }
        let margin = |v: Vertex| margins.get(v.index()).copied();
        self.shown_with(test, &Evidence::Test, &margin)
    }

    /// The first of the directions with which something is left.
    fn apart(&self, test: &Test, apart: &Apart) -> Option<Evidence> {
        let with = |g: &DMatrix<f64>, bits: i32| rounded(g, bits + above(g));
        directions(self.formulas, apart).into_iter().find_map(|g| {
            let along = self.formulas.along(apart, &with(&g, FINE)?)?;
            let margin = |v| {
                let all = self.formulas.beyond(apart, &along, v)?;
                Some(all.iter().fold(f64::INFINITY, |least, x| least.min(x.0)))
            };
            let with = |bits| Some(Evidence::Direction(with(&g, bits)?));
            let found = self.shown_with(test, &with(FINE)?, &margin)?;
            Some(self.shortened(test, found, with))
        })
    }
}

/// The multiple of one affine function that leaves most of another on `[-1, 1]^m`, if it is subtracted; both by their
/// values at the centre and their slopes.
fn multiple(f: &[f64], g: &[f64]) -> f64 {
    let least = |multiple: f64| {
        let mut parts = f.iter().zip(g).map(|(f, g)| f - multiple * g);
        parts.next().unwrap_or(0.0) - parts.map(f64::abs).sum::<f64>()
    };
    let kinks = f.iter().zip(g).skip(1).map(|(f, g)| f / g).filter(|x| *x > 0.0 && x.is_finite());
    kinks.fold(0.0, |best, other| if least(other) > least(best) { other } else { best })
}

/// Other evidence, less what is taken from some evidence.
fn around(found: &Evidence, own: Evidence) -> Evidence {
    match found {
        Evidence::Inside(inner, multiple, places) => {
            Evidence::Inside(Box::new(around(inner, own)), *multiple, *places)
        }
        Evidence::Turned(inner, multiple, places) => {
            Evidence::Turned(Box::new(around(inner, own)), *multiple, *places)
        }
        _ => own,
    }
}
