//! A search in doubles: enough to have proofs to check.

use crate::rough::{Pair, Rough};
use nalgebra::{DMatrix, SymmetricEigen};
use num_bigint::BigInt;
use num_traits::ToPrimitive;
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::{
    Certificate, Claim, Corner, Evidence, Node, Proof, Provenance, Step, Tree, Verdict, FORMAT,
};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::fixed::Interval;
use orthocert_kernel::formula::{Formula, Values};
use orthocert_kernel::machine::Leg;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::step::Checker;
use orthocert_kernel::test::solve::Solve;
use orthocert_kernel::test::{Multiplier, Over, Place, Row};

pub const BITS: u32 = 52;
pub const PLACES: u32 = 14;

pub fn double(x: &Interval<BigInt>, bits: u32) -> Pair {
    let end = |x: &BigInt| x.to_f64().expect("finite") * (-f64::from(bits)).exp2();
    (end(&x.lo), end(&x.hi))
}

fn middle(x: Pair) -> f64 {
    (x.0 + x.1) / 2.0
}

/// Which rows.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Plain,
    Divided,
    Scaled,
}

/// The formulas at a point.
type Point<'p> = &'p dyn Fn(Formula) -> Option<f64>;

/// A problem in doubles.
pub struct Prover<'a> {
    pub problem: &'a Problem,
    pub checker: Checker<'a, Rough>,
    parameters: Vec<Pair>,
    root: Cell<i64>,
    pub chords: Option<Multiplier>,
}

impl<'a> Prover<'a> {
    pub fn new(problem: &'a Problem) -> Self {
        let parameters = problem.parameters::<BigInt>(96, &[]).expect("parameters");
        let parameters: Vec<Pair> = parameters.iter().map(|x| double(x, 96)).collect();
        let tight = problem.tight::<BigInt>(96).map(|q| q.map(|q| double(&q, 96)));
        let root = problem.root(BITS).expect("root");
        let checker = Checker::new(problem, &Rough, parameters.clone(), tight);
        let mut prover = Prover { problem, checker, parameters, root, chords: None };
        prover.chords = prover.common();
        prover.checker = prover.checker.with_chords(prover.chords.clone());
        prover
    }

    /// The machine's rows.
    fn legs(&self, form: Form) -> Option<Vec<Row<Formula>>> {
        let row = |leg: &Leg| match form {
            Form::Plain => Some(leg.row.clone()),
            Form::Divided => Some(leg.divided.clone()),
            Form::Scaled => leg.scaled.clone(),
        };
        self.problem.legs.iter().map(row).collect()
    }

    /// `A_i` and `D_i`, in the middle.
    fn rows(&self, rows: &[Row<Formula>], at: Point<'_>) -> Option<(DMatrix<f64>, Vec<f64>)> {
        let mut a = DMatrix::zeros(rows.len(), rows.first()?.a.len());
        let mut d = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            d.push(at(row.d)?);
            for (k, &f) in row.a.iter().enumerate() {
                a[(i, k)] = at(f)?;
            }
        }
        d.iter().all(|&d| d > 0.0).then_some((a, d))
    }

    /// One `Y` for all of the workspace, by steps along the least eigenvector of `sym(Y^T A)` over a
    /// grid.
    fn common(&self) -> Option<Multiplier> {
        let rows = self.problem.obligations.iter().find_map(|o| match &o.test {
            Test::OneToOne(rows) => Some(rows),
            _ => None,
        })?;
        let m = self.problem.dimension();
        let matrix = |x: &[f64]| {
            let values = self.values(x);
            let mut a = DMatrix::zeros(rows.len(), m);
            for (i, row) in rows.iter().enumerate() {
                for (k, &f) in row.a.iter().enumerate() {
                    a[(i, k)] = values.of(f)?.0;
                }
            }
            Some(a)
        };
        let at: Vec<DMatrix<f64>> =
            self.grid(if m > 3 { 2 } else { 5 }).iter().filter_map(|x| matrix(x)).collect();
        let mean = at.iter().fold(DMatrix::zeros(rows.len(), m), |sum, a| sum + a);
        let mut y = mean.pseudo_inverse(1e-9).ok()?.transpose().normalize();
        let (mut best, mut value) = (y.clone(), f64::MIN);
        for step in 1..600 {
            let eigen = |a: &DMatrix<f64>| {
                let t = y.transpose() * a;
                SymmetricEigen::new(&t + t.transpose())
            };
            let all = at.iter().map(|a| (eigen(a).eigenvalues.min(), a));
            let (_, a) = all.min_by(|p, q| p.0.total_cmp(&q.0))?;
            let e = eigen(a);
            if e.eigenvalues.min() > value {
                (best, value) = (y.clone(), e.eigenvalues.min());
            }
            let v = e.eigenvectors.column(e.eigenvalues.imin());
            y += (a * v * v.transpose()).normalize() * (0.3 / f64::from(step));
            y = y.normalize();
        }
        let row = |i: usize| best.row(i).iter().map(|y| (y * 16384.0).round() as i64).collect();
        Some(Multiplier { y: (0..rows.len()).map(row).collect(), places: 14 })
    }

    /// `Y` for the solution `z` of `A z = b`, `b = B_i e_i`: `A` at the centre, then between it and
    /// `k^2 b z^T`, which loses nothing along `b`.
    fn solutions(&self, over: &Over<'_, Rough>, test: &Solve) -> Vec<Multiplier> {
        let middle = |f: &Formula| over.of(*f).map(|f| (f.at_centre.0 + f.at_centre.1) / 2.0);
        let rows = || self.problem.legs.iter().map(|leg| &leg.row);
        let n = rows().count();
        let all: Option<Vec<f64>> = rows().flat_map(|row| &row.a).map(middle).collect();
        let d = self.problem.legs.get(test.joint).and_then(|leg| middle(&leg.row.d));
        let (Some(a), Some(d), Some(square)) = (all, d, middle(&test.square)) else {
            return Vec::new();
        };
        let a = DMatrix::from_row_slice(n, n, &a);
        let mut b = nalgebra::DVector::zeros(n);
        b[test.joint] = d.sqrt();
        let Some(z) = a.clone().lu().solve(&b) else { return Vec::new() };
        let own = &b * z.transpose() * square;
        let with = |part: f64| {
            let y = (&a * (1.0 - part) + &own * part) * f64::from(PLACES).exp2();
            let row = |i| y.row(i).iter().map(|y: &f64| y.round() as i64).collect();
            Multiplier { y: (0..n).map(row).collect(), places: PLACES }
        };
        [0.0, 0.3, 0.6].map(with).to_vec()
    }

    /// Points of the workspace's box, so many along each coordinate.
    pub fn grid(&self, n: usize) -> Vec<Vec<f64>> {
        let scale = (-f64::from(BITS)).exp2();
        let ends = |range: &Interval<i64>| (range.lo as f64 * scale, range.hi as f64 * scale);
        let ends: Vec<Pair> = self.root.0.iter().map(ends).collect();
        let at = |i: usize| {
            let part = |k: usize| (i / n.pow(k as u32) % n) as f64 / (n - 1) as f64;
            ends.iter().enumerate().map(|(k, e)| e.0 + part(k) * (e.1 - e.0)).collect()
        };
        (0..n.pow(ends.len() as u32)).map(at).collect()
    }

    fn own_starts(&self, over: &Over<'_, Rough>, form: Form, kappa: f64) -> Vec<Multiplier> {
        let centre = |f: Formula| over.of(f).map(|f| middle(f.at_centre));
        let weight = self.problem.weight.filter(|_| form == Form::Scaled).and_then(centre);
        let kappa = kappa * weight.unwrap_or(1.0).sqrt();
        self.legs(form).map_or(Vec::new(), |rows| self.starts(over, &rows, kappa))
    }

    fn starts(&self, over: &Over<'_, Rough>, rows: &[Row<Formula>], kappa: f64) -> Vec<Multiplier> {
        let centre = |f: Formula| over.of(f).map(|f| middle(f.at_centre));
        let Some((a, d)) = self.rows(rows, &centre) else { return Vec::new() };
        let mut m = a;
        for (i, d) in d.iter().enumerate() {
            m.row_mut(i).scale_mut(1.0 / d.sqrt());
        }
        let svd = m.svd(true, true);
        let (Some(u), Some(vt)) = (svd.u, svd.v_t) else { return Vec::new() };
        let with = |f: &dyn Fn(f64) -> f64| {
            let mut y = &u * DMatrix::from_diagonal(&svd.singular_values.map(f)) * &vt;
            for (i, d) in d.iter().enumerate() {
                y.row_mut(i).scale_mut(f64::from(PLACES).exp2() / d.sqrt());
            }
            let row = |i| y.row(i).iter().map(|y| y.round() as i64).collect();
            Multiplier { y: (0..y.nrows()).map(row).collect(), places: PLACES }
        };
        let kappa = if kappa > 0.0 { kappa } else { svd.singular_values.min() / 2.0 };
        vec![with(&|_| kappa), with(&|s| s.min(1.3 * kappa)), with(&|s| s)]
    }

    /// The least eigenvalue, or value, of what a test wants positive, at a vertex or control point.
    fn margin(&self, test: &Test, evidence: &Evidence, form: Form, at: Point<'_>) -> Option<f64> {
        let least = |t: DMatrix<f64>| SymmetricEigen::new(t).eigenvalues.min();
        let m = self.problem.dimension();
        let weight = self.problem.weight.filter(|_| form == Form::Scaled);
        let weight = weight.map_or(Some(1.0), at)?;
        let form = match evidence {
            Evidence::LowerDivided(_) | Evidence::Divided => Form::Divided,
            _ => form,
        };
        let rows = match test {
            Test::Least(rows, _) | Test::Greatest(rows, _) => rows.clone(),
            _ => self.legs(form)?,
        };
        Some(match (test, evidence) {
            (Test::SigmaMin(_), Evidence::Rank(y)) => {
                let (a, _) = self.rows(&rows, at)?;
                let scale = (-f64::from(y.places)).exp2();
                let t = DMatrix::from_fn(m, a.nrows(), |k, i| y.y[i][k] as f64 * scale) * a;
                least(&t + t.transpose())
            }
            (
                Test::SigmaMin(kappa) | Test::Least(_, kappa),
                Evidence::Lower(y) | Evidence::LowerDivided(y),
            ) => {
                let (a, d) = self.rows(&rows, at)?;
                let scale = (-f64::from(y.places)).exp2();
                let (n, m) = a.shape();
                let y = DMatrix::from_fn(n, m, |i, k| y.y[i][k] as f64 * scale);
                let d = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(d));
                let t = y.transpose() * &a;
                let unit = DMatrix::identity(m, m) * at(*kappa)? * weight;
                least(&t + t.transpose() - y.transpose() * d * &y - unit)
            }
            (Test::SigmaMax(k), _) => {
                let (a, d) = self.rows(&rows, at)?;
                let mut m2 = a.clone();
                for (i, d) in d.iter().enumerate() {
                    m2.row_mut(i).scale_mut(1.0 / d);
                }
                least(DMatrix::identity(m, m) * at(*k)? * weight - a.transpose() * m2)
            }
            (Test::AtLeast(f), _) => at(*f)?,
            _ => return None,
        })
    }

    /// The evidence, alone or with the workspace's own inequality.
    fn shown(
        &self,
        over: &Over<'_, Rough>,
        place: &Place<'_, Pair>,
        test: &Test,
        evidence: Evidence,
    ) -> Option<Evidence> {
        if self.checker.shows(over, test, &evidence) {
            return Some(evidence);
        }
        let by_margin = matches!(
            test,
            Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Least(..) | Test::AtLeast(_)
        );
        if self.problem.inside.is_some() && over.controls.is_none() && !by_margin {
            let with = |k: i64| Evidence::Inside(Box::new(evidence.clone()), 1 << k, 12);
            let mut all = (0..16).map(with);
            return all.find(|evidence| self.checker.shows(over, test, evidence));
        }
        // Margins, and the inequality's values, point by point.
        let form = if over.controls.is_some() { Form::Scaled } else { Form::Plain };
        let mut points = Vec::new();
        for v in over.vertices() {
            // Bounds are not among the formulas at control points.
            let bound = |f: Formula| over.of(f).map(|f| f.range);
            let number = |f: Formula| over.own_at(f, v).or_else(|| bound(f)).map(middle);
            let margin = self.margin(test, &evidence, form, &number)?;
            let g = match (self.problem.turned, &self.problem.inside) {
                (Some(g), _) => over.own_at(g, v)?.1,
                (None, Some(inside)) if over.controls.is_some() => over.own_at(inside.g, v)?.1,
                (None, Some(inside)) => {
                    let mut t = over.of(inside.g)?.at_centre.0;
                    let gradient = inside.gradient.iter().zip(place.edges);
                    for (k, (&f, [_, _, half])) in gradient.enumerate() {
                        let by = over.of(f)?.at_centre.0 * half.0;
                        t += if v.has(k) { by } else { -by };
                    }
                    t
                }
                (None, None) => return None,
            };
            points.push((margin, g));
        }
        let (mut low, mut high) = (0f64, f64::MAX);
        for (margin, t) in points {
            if t > 0.0 {
                high = high.min(margin / t);
            } else {
                low = low.max(margin / t);
            }
        }
        if low >= high {
            return None;
        }
        let multiple = if high > 1e6 { low * 2.0 + 1e-3 } else { (low + high) / 2.0 };
        let multiple = (multiple * 65536.0).round() as i64;
        let evidence = match self.problem.turned {
            Some(_) => Evidence::Turned(Box::new(evidence), multiple, 16),
            None => Evidence::Inside(Box::new(evidence), multiple, 16),
        };
        self.checker.shows(over, test, &evidence).then_some(evidence)
    }

    fn find(
        &self,
        over: &Over<'_, Rough>,
        place: &Place<'_, Pair>,
        test: &Test,
    ) -> Option<Evidence> {
        let proposed = |over: &Over<'_, Rough>| {
            let found = self.checker.at_controls(over, test, |there| {
                let own = self.at_controls(there, test).unwrap_or_default().into_iter();
                let mut shown = own.filter_map(|own| self.shown(there, place, test, own));
                shown.next().map(|found| Evidence::Control(Box::new(found)))
            });
            let vertices = || {
                let all = self.proposals(over, test).unwrap_or_default().into_iter();
                all.filter_map(|evidence| self.shown(over, place, test, evidence)).next()
            };
            found.flatten().or_else(vertices)
        };
        proposed(over).or_else(|| self.apart(over, test, &proposed))
    }

    /// What shows a test with tolerances apart, from any machine at ends of the tolerance or in their
    /// middle, along axes and diagonals.
    fn apart(
        &self,
        over: &Over<'_, Rough>,
        test: &Test,
        proposed: &dyn Fn(&Over<'_, Rough>) -> Option<Evidence>,
    ) -> Option<Evidence> {
        let second = self.problem.derived.as_ref()?.second.is_some();
        let names = if second { ["<", ">", "="] } else { ["-", "+", "0"] };
        let quantities = self.problem.inputs.iter().filter(|x| x.differs()).count() as u32;
        let digits = |n: usize, size: u32| (0..size).map(move |k| n / 3usize.pow(k) % 3);
        let all = |size: u32| (0..3usize.pow(size)).map(move |n| digits(n, size));
        let machines = all(quantities).map(|ends| ends.map(|k| names[k]).collect());
        let along = |n| {
            vec![digits(n, self.problem.dimension() as u32).map(|k| 16 * (k as i64 - 1)).collect()]
        };
        let some = 0..3usize.pow(self.problem.dimension() as u32);
        let directions: Vec<Vec<Vec<i64>>> = some.map(along).chain([Vec::new()]).collect();
        for machine in machines.collect::<Vec<String>>() {
            for directions in &directions {
                let found = self.checker.apart(over, (&machine, directions), proposed);
                let Some(inner) = found.flatten() else { continue };
                let found =
                    Evidence::Tolerances(Box::new(inner), machine.clone(), directions.clone());
                if self.checker.shows(over, test, &found) {
                    return Some(found);
                }
            }
        }
        None
    }

    /// What may show a test at control points.
    fn at_controls(&self, over: &Over<'_, Rough>, test: &Test) -> Option<Vec<Evidence>> {
        let number = |f: &Formula| over.of(*f).map_or(0.0, |f| f.at_centre.0);
        let starts = |kappa: f64| self.own_starts(over, Form::Scaled, kappa).into_iter();
        Some(match test {
            Test::SigmaMin(kappa) if number(kappa) == 0.0 => {
                starts(0.0).map(Evidence::Rank).collect()
            }
            Test::SigmaMin(kappa) => starts(number(kappa).sqrt()).map(Evidence::Lower).collect(),
            Test::SigmaMax(_) | Test::AtLeast(_) => vec![Evidence::Test],
            Test::OneToOne(_) => vec![Evidence::Chords],
            Test::Conditioning(c) => {
                let mu = self.between(over, number(c))?;
                let mut terms = vec![0; self.problem.dimension() + 1];
                terms[0] = (mu * f64::from(PLACES).exp2()) as i64;
                let with = |y| Evidence::Conditioning(y, terms.clone());
                starts(mu.sqrt()).map(with).collect()
            }
            _ => Vec::new(),
        })
    }

    /// `mu` half-way between what both bounds of a condition number allow at the centre.
    fn between(&self, over: &Over<'_, Rough>, c_squared: f64) -> Option<f64> {
        let centre = |f: Formula| over.of(f).map(|f| middle(f.at_centre));
        let (mut m, d) = self.rows(&self.legs(Form::Plain)?, &centre)?;
        for (i, d) in d.iter().enumerate() {
            m.row_mut(i).scale_mut(1.0 / d.sqrt());
        }
        let s = m.singular_values();
        Some(((s.min() + s.max() / c_squared.sqrt()) / 2.0).powi(2))
    }

    /// What may show a test on a cell.
    pub fn proposals(&self, over: &Over<'_, Rough>, test: &Test) -> Option<Vec<Evidence>> {
        let number = |f: &Formula| over.of(*f).map_or(0.0, |f| f.at_centre.0);
        let mut tried: Vec<Evidence> = Vec::new();
        match test {
            Test::SigmaMin(kappa) => {
                let kappa = number(kappa).sqrt();
                let [plain, divided] =
                    [Form::Plain, Form::Divided].map(|form| self.own_starts(over, form, kappa));
                if kappa == 0.0 {
                    tried.extend(plain.iter().cloned().map(Evidence::Rank));
                }
                tried.extend(plain.into_iter().map(Evidence::Lower));
                tried.extend(divided.into_iter().map(Evidence::LowerDivided));
                if self.problem.cube_kappa.is_some() {
                    tried.extend([Corner::Q1, Corner::Q2].map(Evidence::Corner));
                }
            }
            Test::SigmaMax(_) => tried.extend([Evidence::Cube, Evidence::Test, Evidence::Divided]),
            Test::Solve(solve) => {
                tried.extend(self.solutions(over, solve).into_iter().map(Evidence::Lower));
            }
            Test::Accuracy(accuracy) => {
                let middle =
                    |f: &Formula| over.of(*f).map(|f| (f.at_centre.0 + f.at_centre.1) / 2.0);
                let all: Option<Vec<f64>> = accuracy.rows.iter().flatten().map(middle).collect();
                let n = accuracy.rows.len();
                let rows = DMatrix::from_row_slice(n, n, &all?);
                let scale = f64::from(PLACES).exp2();
                for p in if accuracy.parts(n).len() == 2 { 0..5 } else { 0..1 } {
                    let mut m: DMatrix<f64> = rows.clone();
                    for k in (0..n).filter(|k| !accuracy.part.contains(k)) {
                        m.column_mut(k).scale_mut(f64::from(p).exp2());
                    }
                    let row = |i| m.row(i).iter().map(|x| (x * scale).round() as i64).collect();
                    let y = Multiplier { y: (0..n).map(row).collect(), places: PLACES };
                    let kappa = m.singular_values().min() * scale;
                    let with = |part: f64| Evidence::Accuracy(y.clone(), (kappa * part) as i64, p);
                    tried.extend([0.95, 0.8, 0.5].map(with));
                    if accuracy.scaled.is_empty() {
                        continue;
                    }
                    for (i, leg) in self.problem.legs.iter().enumerate() {
                        m.row_mut(i).scale_mut(middle(&leg.row.d)?.sqrt());
                    }
                    let row = |i| m.row(i).iter().map(|x| (x * scale).round() as i64).collect();
                    let y = Multiplier { y: (0..n).map(row).collect(), places: PLACES };
                    let with = |part: f64| {
                        let plain = Evidence::Accuracy(y.clone(), (kappa * part) as i64, p);
                        Evidence::Control(Box::new(plain))
                    };
                    tried.extend([0.95, 0.8, 0.5].map(with));
                }
            }
            Test::Apart(apart) => tried.extend(
                crate::directions::directions(over, apart).into_iter().map(Evidence::Direction),
            ),
            Test::OneToOne(_) => tried.push(Evidence::Chords),
            Test::AtLeast(_) => tried.extend([Evidence::Test, Evidence::Cube]),
            Test::Curvature(_) | Test::Greatest(..) => tried.push(Evidence::Test),
            Test::Beyond(..) => tried.extend([Evidence::Test, Evidence::Negative]),
            // Less than zero: nothing need be known of the rows.
            Test::Least(rows, kappa) if number(kappa) < 0.0 => {
                let y = rows.iter().map(|row| vec![0; row.a.len()]).collect();
                tried.push(Evidence::Lower(Multiplier { y, places: 0 }));
            }
            Test::Least(rows, kappa) => {
                let starts = self.starts(over, rows, number(kappa).sqrt());
                tried.extend(starts.into_iter().map(Evidence::Lower));
            }
            Test::Conditioning(c) => {
                let mu = self.between(over, number(c))?;
                let mut terms = vec![0; self.problem.dimension() + 1];
                terms[0] = (mu * f64::from(PLACES).exp2()) as i64;
                let starts = self.own_starts(over, Form::Plain, mu.sqrt());
                tried.extend(starts.into_iter().map(|y| Evidence::Conditioning(y, terms.clone())));
            }
        }
        Some(tried)
    }

    /// A tree, if one of at most so many boxes is found.
    pub fn tree(&self, most: usize) -> Option<Tree> {
        let all: Vec<usize> = (0..self.problem.obligations.len()).collect();
        let mut waiting = vec![(self.root.clone(), all)];
        let mut nodes = Vec::new();
        while let Some((cell, open)) = waiting.pop() {
            if nodes.len() >= most {
                return None;
            }
            let scale = (-f64::from(BITS)).exp2();
            let pair = |x: &Interval<i64>| (x.lo as f64 * scale, x.hi as f64 * scale);
            let edges: Vec<[Pair; 3]> =
                cell.edges()?.iter().map(|e| [pair(&e[0]), pair(&e[1]), pair(&e[2])]).collect();
            let place = Place::new(&edges, cell.touches(&self.root));
            let values = self.checker.evaluate(&edges);
            let slopes = self.checker.slopes(edges.len());
            let over = Over::new(&place, slopes, &values);
            let cut = self.problem.inside.is_some() || self.problem.turned.is_some();
            if cut && self.checker.is_outside(&over) {
                nodes.push(Node { by: vec![Step(0, Evidence::Outside)], ..Node::default() });
                continue;
            }
            let mut node = Node::default();
            let mut left = Vec::new();
            for &obligation in &open {
                let test = &self.problem.obligations[obligation].test;
                match self.find(&over, &place, test) {
                    Some(evidence) => node.by.push(Step(obligation, evidence)),
                    None => left.push(obligation),
                }
            }
            if !left.is_empty() {
                let weights: Vec<f64> = (0..edges.len()).map(|k| self.weight(&over, k)).collect();
                let weights = if weights.iter().all(|w| w.is_finite()) {
                    weights
                } else {
                    edges.iter().map(|e| e[2].0).collect()
                };
                let k = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]))?;
                node.split = Some(k);
                let [lower, upper] = cell.halves(k)?;
                waiting.push((upper, left.clone()));
                waiting.push((lower, left));
            }
            nodes.push(node);
        }
        Some(Tree { precision: BITS, chords: self.chords.clone(), nodes })
    }

    /// How much the rows vary along a coordinate.
    fn weight(&self, over: &Over<'_, Rough>, k: usize) -> f64 {
        let of = |f: Formula| {
            over.of(f).map_or(f64::INFINITY, |s| s.slopes[k].0.abs().max(s.slopes[k].1.abs()))
        };
        self.problem.legs.iter().fold(0.0, |sum, leg| {
            let d = over.of(leg.row.d).map_or(1.0, |d| d.at_centre.0.max(1e-9));
            let a: f64 = leg.row.a.iter().map(|&a| of(a)).sum();
            sum + a / d.sqrt() + 16.0 * of(leg.row.d) / d
        })
    }

    /// The box of the problem.
    pub fn ranges(&self) -> Vec<(f64, f64)> {
        let scale = (-f64::from(BITS)).exp2();
        self.root.0.iter().map(|x| (x.lo as f64 * scale, x.hi as f64 * scale)).collect()
    }

    /// Whether a point of the box is in the workspace.
    pub fn is_inside(&self, x: &[f64]) -> bool {
        let values = self.values(x);
        let own = self.problem.inside.as_ref().map(|inside| inside.g);
        let own = own.into_iter().chain(self.problem.turned);
        own.into_iter().all(|g| values.of(g).is_some_and(|g| g.0 >= -1e-12))
    }

    /// Whether a cell is found to have no point of the workspace.
    pub fn drops(&self, cell: &[[f64; 2]]) -> bool {
        let edge = |&[low, high]: &[f64; 2]| {
            let (centre, half) = ((low + high) / 2.0, (high - low) / 2.0);
            [(centre, centre), (low, high), (half, half)]
        };
        let edges: Vec<[Pair; 3]> = cell.iter().map(edge).collect();
        let place = Place::new(&edges, [false; 2]);
        let values = self.checker.evaluate(&edges);
        let slopes = self.checker.slopes(edges.len());
        let over = Over::new(&place, slopes, &values);
        self.checker.is_outside(&over)
    }

    /// The formulas at a point in the unit of the problem.
    pub fn values(&self, x: &[f64]) -> Values<Pair> {
        self.problem.tape.run(&Rough, |k| x.get(k).map(|&x| (x, x)), |j| Some(self.parameters[j]))
    }

    /// `M` at a point in the unit of the problem.
    pub fn matrix(&self, x: &[f64]) -> Option<DMatrix<f64>> {
        let values = self.values(x);
        let mut m = DMatrix::zeros(self.problem.legs.len(), x.len());
        for (i, leg) in self.problem.legs.iter().enumerate() {
            for (k, a) in leg.divided.a.iter().enumerate() {
                m[(i, k)] = values.of(*a)?.0;
            }
        }
        Some(m)
    }

    /// `sigma_min` and `sigma_max` over the workspace.
    pub fn extremes(&self) -> [f64; 2] {
        let singular = |x: &[f64]| self.matrix(x).expect("within reach").singular_values();
        [-self.greatest(|x| -singular(x).min()).0, self.greatest(|x| singular(x).max()).0]
    }

    /// The greatest value of a function over the workspace, and where it is: a grid, then steps that
    /// shrink.
    pub fn greatest(&self, value: impl Fn(&[f64]) -> f64) -> (f64, Vec<f64>) {
        let scale = (-f64::from(BITS)).exp2();
        let low: Vec<f64> = self.root.0.iter().map(|i| i.lo as f64 * scale).collect();
        let high: Vec<f64> = self.root.0.iter().map(|i| i.hi as f64 * scale).collect();
        let m = low.len();
        let round = self.problem.inside.is_some();
        // Of a cylinder, the box's first two coordinates are polar ones.
        let place = |t: &[f64]| -> Vec<f64> {
            let mut t = t.to_vec();
            if round {
                let (r, angle) = (t[0], t[1] * std::f64::consts::TAU);
                t[0] = (1.0 + r * angle.cos()) / 2.0;
                t[1] = (1.0 + r * angle.sin()) / 2.0;
            }
            (0..m).map(|k| low[k] + t[k] * (high[k] - low[k])).collect()
        };
        let at = |t: &[f64]| -value(&place(t));
        const N: usize = 13;
        let points: Vec<Vec<f64>> = (0..N.pow(m as u32))
            .map(|i| (0..m).map(|k| (i / N.pow(k as u32) % N) as f64 / (N - 1) as f64).collect())
            .collect();
        let mut starts: Vec<(f64, &Vec<f64>)> = points.iter().map(|x| (at(x), x)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = starts.iter().take(4).map(|(value, x)| {
            let (mut best, mut x, mut step) = (*value, (*x).clone(), 0.1);
            while step > 1e-9 {
                let mut moved = false;
                for k in 0..m {
                    for sign in [-1.0, 1.0] {
                        let mut y = x.clone();
                        y[k] = (y[k] + sign * step).clamp(0.0, 1.0);
                        let value = at(&y);
                        if value < best {
                            (best, x, moved) = (value, y, true);
                        }
                    }
                }
                if !moved {
                    step /= 2.0;
                }
            }
            (-best, place(&x))
        });
        refined.max_by(|a, b| a.0.total_cmp(&b.0)).expect("points")
    }
}

/// The certificate of a claim, if a proof of at most so many boxes is found.
pub fn certify(claim: &MachineClaim, most: usize) -> Option<Certificate> {
    let problem = Problem::new(claim).expect("a claim");
    let tree = Prover::new(&problem).tree(most)?;
    Some(certificate(claim, Verdict::Certified, Proof::Tree(tree)))
}

/// A certificate of the claim.
pub fn certificate(claim: &MachineClaim, verdict: Verdict, proof: Proof) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(claim.clone()),
        verdict,
        proof,
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    }
}
