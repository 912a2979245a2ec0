//! Proposals: evidence with which the kernel's tests hold on a box, in doubles.
//!
//! A test of the kernel meets its proposals in [`Over::evidence`] alone.

use super::doubles::{magnitude, middle, pair, Doubles, Pair};
use super::multiplier::{above, between, exponent, matrix, rounded, Rows};
use super::search::{Cell, Trial};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use num_bigint::BigInt;
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::{Corner, Evidence, Step};
use orthocert_kernel::check::{Checker, Place};
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::test::{self, Row};

/// Fractional bits in which a claim's numbers are enclosed for doubles.
pub const BITS: u32 = 96;
/// Bits of the greatest entry of a multiplier that is tried first.
const FINE: i32 = 15;
/// Bits tried for a shorter one.
const SHORT: [i32; 9] = [1, 2, 3, 4, 5, 6, 8, 10, 12];
/// Parts of the interval of multiples from which a short one is taken.
const MULTIPLES: [[f64; 2]; 3] = [[0.25, 0.75], [0.02, 0.25], [0.75, 0.98]];
/// Halvings from a box to the one about its centre that tells whether it is hopeless.
const FINER: i32 = 20;
/// What a relative change of `D` counts beside one of `A`, when a coordinate is chosen.
const WEIGHT_OF_D: f64 = 16.0;

/// A problem in doubles.
pub struct Prover<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The box of its workspace.
    pub root: Cell,
    checker: Checker<'a, Doubles>,
}

impl<'a> Prover<'a> {
    /// For a problem.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(problem: &'a Problem) -> Result<Self, ClaimError> {
        let parameters = problem.parameters::<BigInt>(BITS, &[])?;
        let parameters = parameters.iter().map(|x| pair(x, BITS)).collect();
        let tight = problem.tight::<BigInt>(BITS).map(|q| q.map(|q| pair(&q, BITS)));
        let root = problem.root::<BigInt>(BITS)?.0.iter().map(|x| pair(x, BITS)).collect();
        Ok(Prover { problem, root, checker: Checker::new(problem, &Doubles, parameters, tight) })
    }

    /// The greatest absolute value of a formula on the whole workspace, where it has one.
    pub fn greatest(&self) -> f64 {
        let values = self.checker.evaluate(&edges(&self.root));
        let formulas =
            self.problem.legs.iter().flat_map(|leg| leg.row.a.iter().chain([&leg.row.d]));
        let of = |&f: &Formula| values.of(f).map_or(1.0, |slope| magnitude(&slope.range));
        let coordinates = self.root.iter().map(magnitude);
        formulas.map(of).chain(coordinates).fold(1.0, f64::max)
    }

    /// What is shown of a box, and what not; where `asked`, whether it is hopeless.
    pub fn trial(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial {
        self.on(cell, |over| {
            if over.is_outside() {
                let steps = vec![Step(0, Evidence::Outside)];
                return Trial { steps, open: Vec::new(), weights: Vec::new(), hopeless: false };
            }
            let (mut steps, mut left) = (Vec::new(), Vec::new());
            for &obligation in open {
                match over.evidence(self.problem.obligations[obligation].test) {
                    Some(evidence) => steps.push(Step(obligation, evidence)),
                    None => left.push(obligation),
                }
            }
            let weights = if left.is_empty() { Vec::new() } else { over.weights(&left) };
            let hopeless = asked && !left.is_empty() && self.is_hopeless(cell, &left);
            Trial { steps, open: left, weights, hopeless }
        })
    }

    /// Whether a test fails next to the box's centre, if that is in the workspace: it fails there,
    /// holds with equality, or the tolerances are too wide.
    fn is_hopeless(&self, cell: &Cell, open: &[usize]) -> bool {
        let centre = |&(lo, hi): &Pair| {
            let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo) * f64::from(-FINER).exp2());
            (middle - half, middle + half)
        };
        let centre: Cell = cell.iter().map(centre).collect();
        self.on(&centre, |over| {
            let fails = |&o: &usize| over.evidence(self.problem.obligations[o].test).is_none();
            over.has_centre_inside() && open.iter().any(fails)
        })
    }

    fn on<T>(&self, cell: &Cell, then: impl FnOnce(&Over<'_>) -> T) -> T {
        let edges = edges(cell);
        let touches = |end: fn(&Pair) -> f64| {
            cell.iter().zip(&self.root).all(|(own, root)| end(own) == end(root))
        };
        let place = Place { edges: &edges, touches: [touches(|x| x.0), touches(|x| x.1)] };
        let values = self.checker.evaluate(&edges);
        let slopes = Slopes { arithmetic: &Doubles, m: edges.len() };
        let formulas = test::Over { slopes, values: &values, inside: None };
        then(&Over { prover: self, formulas: &formulas, place: &place })
    }
}

/// Centre, range and half-width of each coordinate.
fn edges(cell: &Cell) -> Vec<[Pair; 3]> {
    let edge = |&(lo, hi): &Pair| {
        let centre = 0.5 * (lo + hi);
        [(centre, centre), (lo, hi), (hi - centre, hi - centre)]
    };
    cell.iter().map(edge).collect()
}

/// The formulas of a problem over a box.
struct Over<'a> {
    prover: &'a Prover<'a>,
    formulas: &'a test::Over<'a, Doubles>,
    place: &'a Place<'a, Pair>,
}

impl Over<'_> {
    fn problem(&self) -> &Problem {
        self.prover.problem
    }

    fn m(&self) -> usize {
        self.place.edges.len()
    }

    fn is_outside(&self) -> bool {
        self.problem().inside.is_some() && self.prover.checker.is_outside(self.formulas, self.place)
    }

    fn has_centre_inside(&self) -> bool {
        let g = |inside: &orthocert_kernel::problem::Inside| self.centre(inside.g);
        self.problem().inside.as_ref().is_none_or(|inside| g(inside).is_some_and(|g| g >= 0.0))
    }

    fn shows(&self, test: Test, evidence: &Evidence) -> bool {
        self.prover.checker.shows(self.formulas, self.place, test, evidence)
    }

    /// Evidence with which a test holds.
    fn evidence(&self, test: Test) -> Option<Evidence> {
        match test {
            Test::SigmaMin(kappa) => self.lower(test, kappa),
            Test::SigmaMax(_) => {
                self.first(test, [Evidence::Cube, Evidence::Test, Evidence::Divided])
            }
            Test::Conditioning(c) => self.conditioning(test, c),
            Test::AtLeast(_) => self.first(test, [Evidence::Test]),
            Test::Beyond(..) => self.first(test, [Evidence::Test, Evidence::Negative]),
        }
    }

    fn first(&self, test: Test, all: impl IntoIterator<Item = Evidence>) -> Option<Evidence> {
        all.into_iter().find_map(|evidence| self.shown(test, evidence))
    }

    /// The evidence, alone or with the workspace's own inequality, where the test holds with it.
    fn shown(&self, test: Test, evidence: Evidence) -> Option<Evidence> {
        if self.shows(test, &evidence) {
            return Some(evidence);
        }
        let all = self.multiples(test, &evidence)?.into_iter().map(|(multiple, places)| {
            Evidence::Inside(Box::new(evidence.clone()), multiple, places)
        });
        let mut all = all.filter(|evidence| self.shows(test, evidence));
        all.next()
    }

    fn lower(&self, test: Test, kappa_squared: Formula) -> Option<Evidence> {
        let kappa = self.centre(kappa_squared)?.sqrt();
        for divided in [false, true] {
            let form = if divided { Evidence::LowerDivided } else { Evidence::Lower };
            let found = self.starts(divided, kappa).into_iter().find_map(|y| {
                self.shortest(test, |bits| Some(form(rounded(&y, bits + above(&y))?)))
            });
            if found.is_some() {
                return found;
            }
        }
        let touched = [Corner::Q1, Corner::Q2].into_iter().zip(self.place.touches);
        let corners = touched.filter(|_| self.problem().cube_kappa.is_some());
        let corners = corners.filter_map(|(corner, touches)| touches.then_some(corner));
        self.first(test, corners.map(Evidence::Corner))
    }

    /// Matrices `Y` to begin with, of the rows at the centre ([`Rows::starts`]).
    fn starts(&self, divided: bool, kappa: f64) -> Vec<DMatrix<f64>> {
        let Some(rows) = self.rows(divided, None) else { return Vec::new() };
        rows.starts(kappa)
    }

    /// Of the evidence with so many bits, the shortest with which the test holds.
    fn shortest(&self, test: Test, with: impl Fn(i32) -> Option<Evidence>) -> Option<Evidence> {
        let found = self.shown(test, with(FINE)?)?;
        let shorter = SHORT.into_iter().find_map(|bits| {
            let evidence = match &found {
                Evidence::Inside(_, multiple, places) => {
                    Evidence::Inside(Box::new(with(bits)?), *multiple, *places)
                }
                _ => with(bits)?,
            };
            self.shows(test, &evidence).then_some(evidence)
        });
        shorter.or(Some(found))
    }

    /// `mu` half-way between what both bounds allow: at the centre, and, by differences, along each
    /// coordinate.
    fn conditioning(&self, test: Test, c_squared: Formula) -> Option<Evidence> {
        let c = self.centre(c_squared)?.sqrt();
        let middle = |rows: Rows| {
            let xi: DVector<f64> = rows.m().singular_values();
            (0.5 * (xi.min() + xi.max() / c)).powi(2)
        };
        let mut mu = vec![middle(self.rows(false, None)?)];
        for k in 0..self.m() {
            let at = |sign| self.rows(false, Some(Toward::Face(k, sign))).map(middle);
            mu.push(0.5 * (at(1.0)? - at(-1.0)?));
        }
        let size = exponent(mu[0]);
        self.starts(false, mu[0].sqrt()).into_iter().find_map(|y| {
            self.shortest(test, |bits| {
                let places = (bits + above(&y)).max(bits + 4 - size);
                let multiplier = rounded(&y, places)?;
                let scale = f64::from(multiplier.places).exp2();
                let mu = mu.iter().map(|mu| (mu * scale).round() as i64).collect();
                Some(Evidence::Conditioning(multiplier, mu))
            })
        })
    }

    /// Short multiples of the workspace's own inequality, `multiple / 2^places`, that leave what the
    /// test wants positive at each vertex so, less that of the tangent there.
    fn multiples(&self, test: Test, evidence: &Evidence) -> Option<Vec<(i64, u32)>> {
        let inside = self.problem().inside.as_ref()?;
        let g = self.centre(inside.g)?;
        let steps: Vec<f64> = inside
            .gradient
            .iter()
            .zip(self.place.edges)
            .map(|(&f, [_, _, half])| Some(self.centre(f)? * half.0))
            .collect::<Option<_>>()?;
        let (mut low, mut high) = (0f64, f64::INFINITY);
        for v in Vertex::all(self.m()) {
            let signed = steps.iter().enumerate().map(|(k, s)| if v.has(k) { *s } else { -s });
            let tangent = g + signed.sum::<f64>();
            let bound = self.margin(test, evidence, v)? / tangent;
            if tangent > 0.0 {
                high = high.min(bound);
            } else {
                low = low.max(bound);
            }
        }
        let high = if high.is_finite() { high } else { 4.0 * low + 1.0 };
        let part = |[a, b]: [f64; 2]| between(low + a * (high - low), low + b * (high - low));
        (low < high).then(|| MULTIPLES.into_iter().filter_map(part).collect())
    }

    /// The least eigenvalue, or value, of what a test wants positive, at a vertex.
    fn margin(&self, test: Test, evidence: &Evidence, v: Vertex) -> Option<f64> {
        let m = self.m();
        let least = |t: DMatrix<f64>| SymmetricEigen::new(t).eigenvalues.min();
        let unit = |c: f64| DMatrix::identity(m, m) * c;
        let value = |f: Formula| v.value(&self.formulas.slopes, self.formulas.of(f)?);
        match (test, evidence) {
            (Test::SigmaMin(kappa), Evidence::Lower(y) | Evidence::LowerDivided(y)) => {
                let divided = matches!(evidence, Evidence::LowerDivided(_));
                let rows = self.rows(divided, Some(Toward::Vertex(v)))?;
                Some(least(rows.minorant(&matrix(y)) - unit(self.centre(kappa)?)))
            }
            (Test::SigmaMax(k), Evidence::Test | Evidence::Divided) => {
                let divided = matches!(evidence, Evidence::Divided);
                let rows = self.rows(divided, Some(Toward::Vertex(v)))?;
                Some(least(unit(self.centre(k)?) - rows.square()))
            }
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                let rows = self.rows(false, Some(Toward::Vertex(v)))?;
                let scale = (-f64::from(y.places)).exp2();
                let signed = mu.iter().enumerate().map(|(k, mu)| match k.checked_sub(1) {
                    Some(k) if !v.has(k) => -*mu as f64,
                    _ => *mu as f64,
                });
                let mu = scale * signed.sum::<f64>();
                let lower = least(rows.minorant(&matrix(y)) - unit(mu));
                Some(lower.min(least(unit(self.centre(c)? * mu) - rows.square())))
            }
            (Test::AtLeast(f), _) => Some(value(f)?.0),
            (Test::Beyond(f, b), Evidence::Negative) => Some(-value(f)?.1 - value(b)?.1),
            (Test::Beyond(f, b), _) => Some(value(f)?.0 - value(b)?.1),
            (Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_), _) => None,
        }
    }

    /// How much is gained by halving each coordinate: by how much what is open varies along it.
    fn weights(&self, open: &[usize]) -> Vec<f64> {
        let coordinates = 0..self.m();
        let along = |f: Formula, k: usize| {
            self.formulas.of(f).map_or(f64::INFINITY, |slope| magnitude(&slope.slopes[k]))
        };
        // What is not defined comes first: the divisor, or radicand, that is not of one sign.
        let undefined: Vec<Formula> = self
            .problem()
            .tape
            .ops()
            .iter()
            .filter_map(|op| match *op {
                Op::Sqrt(f) => self.formulas.of(f).filter(|x| x.range.0 <= 0.0).map(|_| f),
                Op::Div(_, f) => {
                    let mixed = |x: &Pair| x.0 <= 0.0 && x.1 >= 0.0;
                    self.formulas.of(f).filter(|x| mixed(&x.range)).map(|_| f)
                }
                _ => None,
            })
            .collect();
        let of = |f: Formula| coordinates.clone().map(|k| along(f, k)).collect();
        let mut parts: Vec<Vec<f64>> = undefined.into_iter().map(of).collect();
        if parts.is_empty() {
            let tests = open.iter().map(|&o| self.problem().obligations[o].test);
            let weight = |test, k| match scalars(test) {
                Some(all) => all.into_iter().map(|f| along(f, k)).sum(),
                None => self.rows_along(k, along),
            };
            let part = |test| coordinates.clone().map(|k| weight(test, k)).collect();
            parts = tests.map(part).collect();
        }
        let mut weights = vec![0.0; self.m()];
        for part in parts {
            let total: f64 = part.iter().sum();
            if total.is_finite() && total > 0.0 {
                weights.iter_mut().zip(&part).for_each(|(weight, part)| *weight += part / total);
            }
        }
        if weights.iter().all(|&weight| weight == 0.0) {
            return self.place.edges.iter().map(|edge| edge[2].0).collect();
        }
        weights
    }

    /// `sum_i |S_k A_i|/sqrt(D_i) + 16 |S_k D_i|/D_i`.
    fn rows_along(&self, k: usize, along: impl Fn(Formula, usize) -> f64) -> f64 {
        self.problem().legs.iter().fold(0.0, |sum, leg| {
            let d = self.centre(leg.row.d).unwrap_or(1.0).max(f64::MIN_POSITIVE);
            let a: f64 = leg.row.a.iter().map(|&a| along(a, k)).sum();
            sum + a / d.sqrt() + WEIGHT_OF_D * along(leg.row.d, k) / d
        })
    }

    fn centre(&self, f: Formula) -> Option<f64> {
        self.formulas.of(f).map(|slope| middle(&slope.at_centre))
    }

    /// The rows at the centre, or away from it; `None` unless all `D_i` are positive there.
    fn rows(&self, divided: bool, toward: Option<Toward>) -> Option<Rows> {
        let legs = &self.problem().legs;
        let row = |i: usize| -> &Row<Formula> {
            if divided {
                &legs[i].divided
            } else {
                &legs[i].row
            }
        };
        let at = |f: Formula| {
            let slope = self.formulas.of(f)?;
            let along = |k: usize| middle(&slope.slopes[k]);
            let step = match toward {
                None => 0.0,
                Some(Toward::Face(k, sign)) => sign * along(k),
                Some(Toward::Vertex(v)) => {
                    (0..self.m()).map(|k| if v.has(k) { along(k) } else { -along(k) }).sum()
                }
            };
            Some(middle(&slope.at_centre) + step)
        };
        let mut a = DMatrix::zeros(legs.len(), self.m());
        let mut d = DVector::zeros(legs.len());
        for i in 0..legs.len() {
            d[i] = at(row(i).d)?;
            for (k, &f) in row(i).a.iter().enumerate() {
                a[(i, k)] = at(f)?;
            }
        }
        let sound = d.iter().all(|&d| d > 0.0) && a.iter().all(|a| a.is_finite());
        sound.then_some(Rows { a, d })
    }
}

/// Where rows are taken, from a box's centre.
#[derive(Clone, Copy)]
enum Toward {
    /// The middle of the face of this coordinate and sign.
    Face(usize, f64),
    /// A vertex.
    Vertex(Vertex),
}

/// The formulas of a test on signs; none of one on the rows.
fn scalars(test: Test) -> Option<Vec<Formula>> {
    match test {
        Test::AtLeast(f) => Some(vec![f]),
        Test::Beyond(f, b) => Some(vec![f, b]),
        Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_) => None,
    }
}
