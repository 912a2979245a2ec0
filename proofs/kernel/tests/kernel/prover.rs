//! A search in doubles: enough to have proofs to check.

use crate::rough::{Pair, Rough};
use nalgebra::{DMatrix, SymmetricEigen};
use num_bigint::BigInt;
use num_traits::ToPrimitive;
use orthocert_kernel::cell::{Cell, Vertex};
use orthocert_kernel::certificate::{
    Certificate, Claim, Corner, Evidence, Node, Proof, Provenance, Step, Tree, Verdict, FORMAT,
};
use orthocert_kernel::check::{Checker, Place};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::fixed::Interval;
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::test::{Multiplier, Over, Row};

pub const BITS: u32 = 52;
const PLACES: u32 = 14;

pub fn double(x: &Interval<BigInt>, bits: u32) -> Pair {
    let end = |x: &BigInt| x.to_f64().expect("finite") * (-f64::from(bits)).exp2();
    (end(&x.lo), end(&x.hi))
}

/// A problem in doubles.
pub struct Prover<'a> {
    pub problem: &'a Problem,
    checker: Checker<'a, Rough>,
    root: Cell<i64>,
}

impl<'a> Prover<'a> {
    pub fn new(problem: &'a Problem) -> Self {
        let parameters = problem.parameters::<BigInt>(96, &[]).expect("parameters");
        let parameters = parameters.iter().map(|x| double(x, 96)).collect();
        let tight = problem.tight::<BigInt>(96).map(|q| q.map(|q| double(&q, 96)));
        let root = problem.root(BITS).expect("root");
        Prover { problem, checker: Checker::new(problem, &Rough, parameters, tight), root }
    }

    /// `A_i` and `D_i` at a vertex, in the middle.
    fn rows(
        &self,
        over: &Over<'_, Rough>,
        divided: bool,
        v: Option<Vertex>,
    ) -> Option<(DMatrix<f64>, Vec<f64>)> {
        let rows: Vec<&Row<Formula>> = self
            .problem
            .legs
            .iter()
            .map(|leg| if divided { &leg.divided } else { &leg.row })
            .collect();
        let at = |f: Formula| {
            let slope = over.of(f)?;
            let x = match v {
                Some(v) => v.value(&over.slopes, slope)?,
                None => slope.at_centre,
            };
            Some((x.0 + x.1) / 2.0)
        };
        let mut a = DMatrix::zeros(rows.len(), over.slopes.m);
        let mut d = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            d.push(at(row.d)?);
            for (k, &f) in row.a.iter().enumerate() {
                a[(i, k)] = at(f)?;
            }
        }
        d.iter().all(|&d| d > 0.0).then_some((a, d))
    }

    fn starts(&self, over: &Over<'_, Rough>, divided: bool, kappa: f64) -> Vec<Multiplier> {
        let Some((a, d)) = self.rows(over, divided, None) else { return Vec::new() };
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

    /// The least eigenvalue, or value, of what a test wants positive, at a vertex.
    fn margin(
        &self,
        over: &Over<'_, Rough>,
        test: Test,
        evidence: &Evidence,
        v: Vertex,
    ) -> Option<f64> {
        let least = |t: DMatrix<f64>| SymmetricEigen::new(t).eigenvalues.min();
        let m = over.slopes.m;
        let number = |f: Formula| over.of(f).map(|f| f.at_centre.0);
        Some(match (test, evidence) {
            (Test::SigmaMin(kappa), Evidence::Lower(y) | Evidence::LowerDivided(y)) => {
                let (a, d) =
                    self.rows(over, matches!(evidence, Evidence::LowerDivided(_)), Some(v))?;
                let scale = (-f64::from(y.places)).exp2();
                let y = DMatrix::from_fn(a.nrows(), m, |i, k| y.y[i][k] as f64 * scale);
                let d = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(d));
                let t = y.transpose() * &a;
                let unit = DMatrix::identity(m, m) * number(kappa)?;
                least(&t + t.transpose() - y.transpose() * d * &y - unit)
            }
            (Test::SigmaMax(k), _) => {
                let (a, d) = self.rows(over, *evidence == Evidence::Divided, Some(v))?;
                let mut m2 = a.clone();
                for (i, d) in d.iter().enumerate() {
                    m2.row_mut(i).scale_mut(1.0 / d);
                }
                least(DMatrix::identity(m, m) * number(k)? - a.transpose() * m2)
            }
            (Test::AtLeast(f), _) => v.value(&over.slopes, over.of(f)?)?.0,
            _ => return None,
        })
    }

    /// The evidence, alone or with the workspace's own inequality.
    fn shown(
        &self,
        over: &Over<'_, Rough>,
        place: &Place<'_, Pair>,
        test: Test,
        evidence: Evidence,
    ) -> Option<Evidence> {
        if self.checker.shows(over, place, test, &evidence) {
            return Some(evidence);
        }
        let inside = self.problem.inside.as_ref()?;
        let (mut low, mut high) = (0f64, f64::MAX);
        for v in Vertex::all(over.slopes.m) {
            let margin = self.margin(over, test, &evidence, v)?;
            let mut t = over.of(inside.g)?.at_centre.0;
            for (k, (&f, [_, _, half])) in inside.gradient.iter().zip(place.edges).enumerate() {
                let by = over.of(f)?.at_centre.0 * half.0;
                t += if v.has(k) { by } else { -by };
            }
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
        let evidence =
            Evidence::Inside(Box::new(evidence), (multiple * 65536.0).round() as i64, 16);
        self.checker.shows(over, place, test, &evidence).then_some(evidence)
    }

    fn find(
        &self,
        over: &Over<'_, Rough>,
        place: &Place<'_, Pair>,
        test: Test,
    ) -> Option<Evidence> {
        let number = |f: Formula| over.of(f).map_or(0.0, |f| f.at_centre.0);
        let mut tried: Vec<Evidence> = Vec::new();
        match test {
            Test::SigmaMin(kappa) => {
                let kappa = number(kappa).sqrt();
                tried.extend(self.starts(over, false, kappa).into_iter().map(Evidence::Lower));
                tried
                    .extend(self.starts(over, true, kappa).into_iter().map(Evidence::LowerDivided));
                if self.problem.cube_kappa.is_some() {
                    tried.extend([Corner::Q1, Corner::Q2].map(Evidence::Corner));
                }
            }
            Test::SigmaMax(_) => tried.extend([Evidence::Cube, Evidence::Test, Evidence::Divided]),
            Test::AtLeast(_) => tried.push(Evidence::Test),
            Test::Beyond(..) => tried.extend([Evidence::Test, Evidence::Negative]),
            Test::Conditioning(c) => {
                let (a, d) = self.rows(over, false, None)?;
                let mut m = a;
                for (i, d) in d.iter().enumerate() {
                    m.row_mut(i).scale_mut(1.0 / d.sqrt());
                }
                let s = m.singular_values();
                let mu = ((s.min() + s.max() / number(c).sqrt()) / 2.0).powi(2);
                let mut terms = vec![0; over.slopes.m + 1];
                terms[0] = (mu * f64::from(PLACES).exp2()) as i64;
                let starts = self.starts(over, false, mu.sqrt());
                tried.extend(starts.into_iter().map(|y| Evidence::Conditioning(y, terms.clone())));
            }
        }
        tried.into_iter().find_map(|evidence| self.shown(over, place, test, evidence))
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
            let place = Place { edges: &edges, touches: cell.touches(&self.root) };
            let values = self.checker.evaluate(&edges);
            let slopes = Slopes { arithmetic: &Rough, m: edges.len() };
            let over = Over { slopes, values: &values, inside: None };
            if self.problem.inside.is_some() && self.checker.is_outside(&over, &place) {
                nodes.push(Node { by: vec![Step(0, Evidence::Outside)], ..Node::default() });
                continue;
            }
            let mut node = Node::default();
            let mut left = Vec::new();
            for &obligation in &open {
                let test = self.problem.obligations[obligation].test;
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
        Some(Tree { precision: BITS, nodes })
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

    /// `M` at a point in the unit of the problem.
    pub fn matrix(&self, x: &[f64]) -> Option<DMatrix<f64>> {
        let parameters = self.problem.parameters::<BigInt>(96, &[]).expect("parameters");
        let values = self.problem.tape.run(&Rough, |op| match op {
            Op::Coordinate(k) => Some((x[k], x[k])),
            Op::Parameter(j) => Some(double(&parameters[j], 96)),
            _ => None,
        });
        let mut m = DMatrix::zeros(self.problem.legs.len(), x.len());
        for (i, leg) in self.problem.legs.iter().enumerate() {
            for (k, a) in leg.divided.a.iter().enumerate() {
                m[(i, k)] = values.of(*a)?.0;
            }
        }
        Some(m)
    }

    /// `sigma_min` and `sigma_max` over the workspace: a grid, then steps that shrink.
    pub fn extremes(&self) -> [f64; 2] {
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
        let at = |t: &[f64]| {
            let s = self.matrix(&place(t)).expect("within reach").singular_values();
            [s.min(), -s.max()]
        };
        const N: usize = 13;
        let points: Vec<Vec<f64>> = (0..N.pow(m as u32))
            .map(|i| (0..m).map(|k| (i / N.pow(k as u32) % N) as f64 / (N - 1) as f64).collect())
            .collect();
        [0, 1].map(|which| {
            let mut starts: Vec<(f64, &Vec<f64>)> =
                points.iter().map(|x| (at(x)[which], x)).collect();
            starts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let refined = starts.iter().take(4).map(|(value, x)| {
                let (mut best, mut x, mut step) = (*value, (*x).clone(), 0.1);
                while step > 1e-9 {
                    let mut moved = false;
                    for k in 0..m {
                        for sign in [-1.0, 1.0] {
                            let mut y = x.clone();
                            y[k] = (y[k] + sign * step).clamp(0.0, 1.0);
                            let value = at(&y)[which];
                            if value < best {
                                (best, x, moved) = (value, y, true);
                            }
                        }
                    }
                    if !moved {
                        step /= 2.0;
                    }
                }
                best
            });
            refined.fold(f64::MAX, f64::min).abs()
        })
    }
}

/// The certificate of a claim, if a proof of at most so many boxes is found.
pub fn certify(claim: &MachineClaim, most: usize) -> Option<Certificate> {
    let problem = Problem::new(claim).expect("a claim");
    let tree = Prover::new(&problem).tree(most)?;
    Some(Certificate {
        format: FORMAT.to_owned(),
        claim: Claim::Machine(claim.clone()),
        verdict: Verdict::Certified,
        proof: Proof::Tree(tree),
        provenance: Provenance { tool: "test".to_owned(), version: "0".to_owned() },
    })
}
