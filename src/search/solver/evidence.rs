//! A problem in doubles, and what becomes of a box: the frame of the proposals in [`super::propose`].

use super::chords;
use super::doubles::{magnitude, middle, pair, Doubles, Pair};
use super::rows::{are_moderate, Form, Rows};
use super::search::{Boxes, Cell, Trial};
use nalgebra::{DMatrix, DVector};
use num_bigint::BigInt;
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::{Evidence, Failure, Node, Step};
use orthocert_kernel::formula::{Formula, Op, Values};
use orthocert_kernel::input::{ClaimError, Input};
use orthocert_kernel::problem::{Inside, Problem};
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::Slope;
use orthocert_kernel::step::Checker;
use orthocert_kernel::test::{self, Multiplier, Place, Row};
use orthocert_kernel::witness::fails_throughout;

/// Fractional bits in which a claim's numbers are enclosed for doubles.
pub const BITS: u32 = 96;
/// Halvings from a box to the one about its centre, or another point, that tells whether it is hopeless.
const FINER: i32 = 20;
/// What a relative change of `D` counts beside one of `A`, when a coordinate is chosen.
const WEIGHT_OF_D: f64 = 16.0;

/// A problem in doubles.
pub struct Prover<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The box of its workspace.
    pub root: Cell,
    /// The one `Y` of a machine that is to be one to one.
    pub chords: Option<Multiplier>,
    /// Whether all legs have scaled rows.
    pub is_scaled: bool,
    /// The machine's rows: plain, divided and, where legs have them, scaled.
    rows: [Vec<Row<Formula>>; 3],
    pub(super) checker: Checker<'a, Doubles>,
}

impl<'a> Prover<'a> {
    /// For a problem.
    ///
    /// # Errors
    /// If one of its numbers cannot be enclosed.
    pub fn new(problem: &'a Problem) -> Result<Self, ClaimError> {
        let parameters = problem.parameters::<BigInt>(BITS, &[])?;
        let parameters: Vec<Pair> = parameters.iter().map(|x| pair(x, BITS)).collect();
        let tight = problem.tight::<BigInt>(BITS).map(|q| q.map(|q| pair(&q, BITS)));
        let root: Cell = problem.root::<BigInt>(BITS)?.0.iter().map(|x| pair(x, BITS)).collect();
        let chords = chords::common(problem, &root, &parameters);
        let checker = Checker::new(problem, &Doubles, parameters, tight);
        let checker = checker.with_chords(chords.clone());
        let is_scaled = problem.legs.iter().all(|leg| leg.scaled.is_some());
        let legs = || problem.legs.iter();
        let rows = [
            legs().map(|leg| leg.row.clone()).collect(),
            legs().map(|leg| leg.divided.clone()).collect(),
            legs().filter(|_| is_scaled).filter_map(|leg| leg.scaled.clone()).collect(),
        ];
        Ok(Prover { problem, root, chords, is_scaled, rows, checker })
    }

    /// The machine's rows; none where they have no such form.
    pub(super) fn rows(&self, form: Form) -> &[Row<Formula>] {
        &self.rows[form as usize]
    }

    /// The claim's numbers, nearly.
    pub(crate) fn parameters(&self) -> &[Pair] {
        &self.checker.parameters
    }

    /// Whether machines differ by the scale of this number of a direction.
    pub(super) fn is_scale(&self, j: usize) -> bool {
        let [own, scaled] = [&self.checker.parameters, &self.checker.scaled_parameters];
        self.problem.inputs.get(j).is_some_and(Input::differs) && own.get(j) != scaled.get(j)
    }

    /// The same, where machines differ by the scale of a direction with it.
    pub(super) fn of_one_scale(&self) -> &[Pair] {
        &self.checker.scaled_parameters
    }

    /// Whether they do of some.
    pub(super) fn has_scales(&self) -> bool {
        (0..self.problem.inputs.len()).any(|j| self.is_scale(j))
    }

    /// The greatest absolute value of a formula on the whole workspace, where it has one.
    pub fn greatest(&self) -> f64 {
        let values = self.checker.evaluate(&edges(&self.root));
        let rows = |leg: &'a orthocert_kernel::machine::Leg| [Some(&leg.row), leg.scaled.as_ref()];
        let rows = self.problem.legs.iter().flat_map(rows).flatten();
        let formulas = rows.flat_map(|row| row.a.iter().chain([&row.d]));
        let of = |&f: &Formula| values.of(f).map_or(1.0, |slope| magnitude(&slope.range));
        let coordinates = self.root.iter().map(magnitude);
        formulas.map(of).chain(coordinates).fold(1.0, f64::max)
    }

    /// Whether every test holds next to a point, with directions apart if they are: where one does not, no tree is a proof.
    pub fn holds_next_to(&self, point: &[f64], apart: bool) -> bool {
        let cell: Cell =
            point.iter().zip(&self.root).map(|(&x, &range)| next_to(x, range)).collect();
        let all: Vec<usize> = (0..self.problem.obligations.len()).collect();
        self.tried(&cell, (&all, false), apart).open.is_empty()
    }

    /// Whether a test fails next to the box's centre, if that is in the workspace: it fails there,
    /// holds with equality, or the tolerances are too wide.
    pub(super) fn is_hopeless(&self, cell: &Cell, open: &[usize], apart: bool) -> bool {
        self.on(&centre(cell), |over| {
            let fails =
                |&o: &usize| over.evidence_of(&self.problem.obligations[o].test, apart).is_none();
            over.has_centre_inside() && open.iter().any(fails)
        })
    }

    pub(crate) fn on<T>(&self, cell: &Cell, then: impl FnOnce(&Over<'_>) -> T) -> T {
        let edges = edges(cell);
        let values = self.checker.evaluate(&edges);
        self.with(cell, &edges, &values, then)
    }

    /// The same with the formulas alone that own evidence is made of.
    pub(crate) fn on_own<T>(&self, cell: &Cell, then: impl FnOnce(&Over<'_>) -> T) -> T {
        let edges = edges(cell);
        let values = self.checker.evaluate_own(&edges);
        self.with(cell, &edges, &values, then)
    }

    fn with<T>(
        &self,
        cell: &Cell,
        edges: &[[Pair; 3]],
        values: &Values<Slope<Pair>>,
        then: impl FnOnce(&Over<'_>) -> T,
    ) -> T {
        let touches = |end: fn(&Pair) -> f64| {
            cell.iter().zip(&self.root).all(|(own, root)| end(own) == end(root))
        };
        let place = Place::new(edges, [touches(|x| x.0), touches(|x| x.1)]);
        let slopes = self.checker.slopes(edges.len());
        let formulas = test::Over::new(&place, slopes, values);
        then(&Over { prover: self, formulas: &formulas })
    }
}

impl Prover<'_> {
    pub(super) fn tried(&self, cell: &Cell, (open, asked): (&[usize], bool), apart: bool) -> Trial {
        self.on(cell, |over| {
            if over.is_outside() {
                let by = vec![Step(0, Evidence::Outside)];
                let node = Node { by, ..Node::default() };
                return Trial { node, open: Vec::new(), weights: Vec::new(), hopeless: false };
            }
            let (mut by, mut left) = (Vec::new(), Vec::new());
            for &obligation in open {
                match over.evidence_of(&self.problem.obligations[obligation].test, apart) {
                    Some(evidence) => by.push(Step(obligation, evidence)),
                    None => left.push(obligation),
                }
            }
            let weights = if left.is_empty() { Vec::new() } else { over.weights(&left) };
            let hopeless = asked && !left.is_empty() && self.is_hopeless(cell, &left, apart);
            let node = Node { by, ..Node::default() };
            Trial { node, open: left, weights, hopeless }
        })
    }
}

impl Boxes for Prover<'_> {
    fn root(&self) -> &Cell {
        &self.root
    }

    fn obligations(&self) -> usize {
        self.problem.obligations.len()
    }

    fn trial(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial {
        self.tried(cell, (open, asked), false)
    }

    fn is_costly(&self) -> bool {
        self.root.len() > 3 || self.problem.tolerances().next().is_some()
    }
}

/// The same problem with directions apart, where nothing else helps.
pub struct Apart<'a>(pub &'a Prover<'a>);

impl Boxes for Apart<'_> {
    fn root(&self) -> &Cell {
        &self.0.root
    }

    fn obligations(&self) -> usize {
        self.0.obligations()
    }

    fn trial(&self, cell: &Cell, open: &[usize], asked: bool) -> Trial {
        self.0.tried(cell, (open, asked), true)
    }

    fn is_costly(&self) -> bool {
        self.0.is_costly()
    }
}

/// What of a box is next to its centre.
pub(super) fn centre(cell: &[Pair]) -> Cell {
    let next_to = |&(lo, hi): &Pair| {
        let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo) * f64::from(-FINER).exp2());
        (middle - half, middle + half)
    };
    cell.iter().map(next_to).collect()
}

/// What of a range is next to a point of it.
pub(super) fn next_to(x: f64, (lo, hi): Pair) -> Pair {
    let off = (hi - lo) * f64::from(-FINER).exp2();
    ((x - off).max(lo), (x + off).min(hi))
}

/// Centre, range and half-width of each coordinate.
pub(super) fn edges(cell: &[Pair]) -> Vec<[Pair; 3]> {
    let edge = |&(lo, hi): &Pair| {
        let centre = 0.5 * (lo + hi);
        [(centre, centre), (lo, hi), (hi - centre, hi - centre)]
    };
    cell.iter().map(edge).collect()
}

/// The formulas of a problem over a box, at its vertices or control points.
pub(crate) struct Over<'a> {
    pub prover: &'a Prover<'a>,
    pub formulas: &'a test::Over<'a, Doubles>,
}

/// Where rows are taken.
#[derive(Clone, Copy)]
pub(crate) enum At {
    /// The box's centre.
    Centre,
    /// The middle of the face of this coordinate and sign.
    Face(usize, f64),
    /// A vertex, or control point.
    Vertex(Vertex),
}

impl Over<'_> {
    pub fn problem(&self) -> &Problem {
        self.prover.problem
    }

    pub fn m(&self) -> usize {
        self.formulas.place.edges.len()
    }

    /// Whether the claim seems to fail so at every point of the box.
    pub(crate) fn fails(&self, failure: &Failure) -> bool {
        fails_throughout(self.problem(), self.formulas.slopes, self.formulas.values, failure)
    }

    fn is_outside(&self) -> bool {
        let cut = self.problem().inside.is_some() || self.problem().turned.is_some();
        cut && self.prover.checker.is_outside(self.formulas)
    }

    fn has_centre_inside(&self) -> bool {
        let inside = self.problem().inside.as_ref().map(|inside: &Inside| inside.g);
        let mut all = inside.into_iter().chain(self.problem().turned);
        all.all(|g| self.centre(g).is_some_and(|g| g >= 0.0))
    }

    pub fn shows(&self, test: &Test, evidence: &Evidence) -> bool {
        self.prover.checker.shows(self.formulas, test, evidence)
    }

    /// A formula at the centre.
    pub fn centre(&self, f: Formula) -> Option<f64> {
        self.formulas.own(f).map(|slope| middle(&slope.at_centre))
    }

    /// A formula somewhere. Bounds are not among the formulas at control points.
    pub fn at(&self, f: Formula, at: At) -> Option<f64> {
        match at {
            At::Centre => self.centre(f),
            At::Face(k, sign) => {
                let slope = self.formulas.own(f)?;
                Some(middle(&slope.at_centre) + sign * middle(&slope.slopes[k]))
            }
            At::Vertex(v) => {
                let own = self.formulas.own_at(f, v);
                let value = own.or_else(|| self.formulas.of(f).map(|f| f.range))?;
                Some(middle(&value))
            }
        }
    }

    /// A matrix of formulas.
    pub fn matrix(&self, rows: &[Vec<Formula>], at: At) -> Option<DMatrix<f64>> {
        let all: Option<Vec<f64>> = rows.iter().flatten().map(|&f| self.at(f, at)).collect();
        let columns = rows.first().map_or(0, Vec::len);
        let all = all.filter(|all| are_moderate(all))?;
        Some(DMatrix::from_row_slice(rows.len(), columns, &all))
    }

    /// The machine's rows.
    pub fn own(&self, form: Form, at: At) -> Option<Rows> {
        self.rows(self.prover.rows(form).iter(), at)
    }

    /// Rows somewhere; `None` unless all `D_i` are positive there.
    pub fn rows<'r>(
        &self,
        rows: impl ExactSizeIterator<Item = &'r Row<Formula>> + Clone,
        at: At,
    ) -> Option<Rows> {
        let mut a = DMatrix::zeros(rows.len(), rows.clone().next()?.a.len());
        let mut d = DVector::zeros(rows.len());
        for (i, row) in rows.enumerate() {
            d[i] = self.at(row.d, at)?;
            for (k, &f) in row.a.iter().enumerate() {
                a[(i, k)] = self.at(f, at)?;
            }
        }
        Rows::new(a, d)
    }

    /// How much is gained by halving each coordinate: by how much what is open varies along it.
    pub(crate) fn weights(&self, open: &[usize]) -> Vec<f64> {
        let coordinates = 0..self.m();
        let of = |f: Formula| coordinates.clone().map(|k| self.along(f, k)).collect();
        let mut parts: Vec<Vec<f64>> = self.undefined().into_iter().map(of).collect();
        if parts.is_empty() {
            let tests = open.iter().map(|&o| &self.problem().obligations[o].test);
            let part = |test: &Test| {
                let along = |k| self.varies(test, &|f| self.along(f, k));
                let own = coordinates.clone().map(along).collect::<Vec<_>>();
                match test {
                    Test::Accuracy(accuracy) => self.with_spread(accuracy, &own).unwrap_or(own),
                    _ => own,
                }
            };
            parts = tests.map(part).collect();
        }
        let weights = sums_of_shares(&parts, self.m());
        if weights.iter().all(|&weight| weight == 0.0) {
            return self.formulas.place.edges.iter().map(|edge| edge[2].0).collect();
        }
        weights
    }

    pub(super) fn along(&self, f: Formula, k: usize) -> f64 {
        self.formulas.of(f).map_or(f64::INFINITY, |slope| magnitude(&slope.slopes[k]))
    }

    /// What is not defined comes first: the divisor, or radicand, that is not of one sign. Scaled rows
    /// need neither.
    pub(crate) fn undefined(&self) -> Vec<Formula> {
        if self.prover.is_scaled {
            return Vec::new();
        }
        let ops = self.problem().tape.ops().iter();
        ops.filter_map(|op| match *op {
            Op::Sqrt(f) => self.formulas.of(f).filter(|x| x.range.0 <= 0.0).map(|_| f),
            Op::Div(_, f) => {
                let mixed = |x: &Pair| x.0 <= 0.0 && x.1 >= 0.0;
                self.formulas.of(f).filter(|x| mixed(&x.range)).map(|_| f)
            }
            _ => None,
        })
        .collect()
    }

    /// By how much a test's formulas vary, where it is known of each.
    pub(super) fn varies(&self, test: &Test, of: &dyn Fn(Formula) -> f64) -> f64 {
        let sum = |all: &mut dyn Iterator<Item = &Formula>| -> f64 { all.map(|&f| of(f)).sum() };
        match test {
            Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_) | Test::Solve(_) => {
                self.rows_vary(self.problem().legs.iter().map(|leg| &leg.row), of)
            }
            Test::Least(rows, _) | Test::Greatest(rows, _) | Test::OneToOne(rows) => {
                self.rows_vary(rows.iter(), of)
            }
            Test::AtLeast(f) => of(*f),
            Test::Beyond(f, b) => of(*f) + of(*b),
            Test::Accuracy(accuracy) => sum(&mut accuracy.rows.iter().flatten()),
            Test::Apart(apart) => sum(&mut apart.ends.iter().flatten().flatten()),
            Test::Curvature(test) => {
                let [a, b] = [test.a, test.b].map(|f| self.centre(f).unwrap_or(1.0));
                a * sum(&mut test.row.iter()) + b * sum(&mut test.twice.iter().flatten())
            }
        }
    }

    /// `sum_i |dA_i|/sqrt(D_i) + 16 |dD_i|/D_i`.
    fn rows_vary<'r>(
        &self,
        rows: impl Iterator<Item = &'r Row<Formula>>,
        of: &dyn Fn(Formula) -> f64,
    ) -> f64 {
        rows.fold(0.0, |sum, row| {
            let d = self.centre(row.d).unwrap_or(1.0).max(f64::MIN_POSITIVE);
            let a: f64 = row.a.iter().map(|&a| of(a)).sum();
            sum + a / d.sqrt() + WEIGHT_OF_D * of(row.d) / d
        })
    }
}

/// The sums of the parts, each divided by its total; without those whose total is none.
pub(super) fn sums_of_shares(parts: &[Vec<f64>], length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; length];
    for part in parts {
        let total: f64 = part.iter().sum();
        if total.is_finite() && total > 0.0 {
            sums.iter_mut().zip(part).for_each(|(sum, part)| *sum += part / total);
        }
    }
    sums
}
