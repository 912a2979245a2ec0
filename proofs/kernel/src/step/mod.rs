//! Steps: what evidence shows of an obligation on a cell.

mod corner;
mod inside;
mod own;
mod tolerances;
mod work;

use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::certificate::{Evidence, Part};
use crate::control::Control;
use crate::formula::{Formula, Op, Values};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::Slopes;
use crate::test::accuracy::{near, Accuracy};
use crate::test::{width, Formulas, Half, Multiplier, Over, Row, Wedge, MOST_PLACES};
use std::collections::BTreeMap;
use tolerances::{are_for, is_of_vertices};

/// Checks steps; in another arithmetic than [`Fixed`](crate::fixed::Fixed), proposes them.
pub struct Checker<'a, E: Enclosure> {
    problem: &'a Problem,
    arithmetic: &'a E,
    /// What it was given, or narrowed to.
    pub parameters: Vec<E::Number>,
    /// The same with directions of one scale.
    pub scaled_parameters: Vec<E::Number>,
    /// `q_1` and `q_2` of the paper's cube.
    tight: Option<[E::Number; 2]>,
    rows: Vec<Row<Formula>>,
    divided: Vec<Row<Formula>>,
    /// Of platforms that turn, if all legs have them.
    scaled: Vec<Row<Formula>>,
    /// One for each obligation of platforms that turn.
    controls: Vec<(Test, Control)>,
    /// The same with derivatives by tolerances, where these are known.
    derived: Vec<(Test, Control)>,
    chords: Option<Multiplier>,
    /// What own evidence is made of; none where that is all.
    needed: Option<Vec<bool>>,
    /// The formulas without coordinates.
    constant: Formulas<E>,
}

impl<'a, E: Enclosure> Checker<'a, E> {
    /// For the steps of a problem, given its parameters and the coordinates of its tight corners.
    pub fn new(
        problem: &'a Problem,
        arithmetic: &'a E,
        parameters: Vec<E::Number>,
        tight: Option<[E::Number; 2]>,
    ) -> Self {
        let scaled = problem.scaled();
        let derived = problem.derived.as_ref().map(|own| problem.controls(&scaled, Some(own)));
        let mut checker = Checker {
            problem,
            arithmetic,
            scaled_parameters: Vec::new(),
            parameters,
            tight,
            rows: problem.legs.iter().map(|leg| leg.row.clone()).collect(),
            divided: problem.legs.iter().map(|leg| leg.divided.clone()).collect(),
            controls: problem.controls(&scaled, None),
            derived: derived.unwrap_or_default(),
            scaled,
            chords: None,
            needed: own::needed(problem),
            constant: Values::default(),
        };
        checker.narrow(&[]);
        checker
    }

    /// For machines with these ranges of the numbers with two ends, in their order; of those not given, with the same.
    pub fn narrow(&mut self, ranges: &[E::Number]) {
        let own = self.parameters.iter_mut().zip(&self.problem.inputs);
        let own = own.filter(|(_, input)| input.has_two_ends());
        own.zip(ranges).for_each(|((own, _), range)| own.clone_from(range));
        self.constant = Values::default();
        self.constant = self.values(None, &[]);
        self.scaled_parameters = self.of_one_scale();
    }

    /// With the one `Y` of a tree.
    #[must_use]
    pub fn with_chords(self, chords: Option<Multiplier>) -> Self {
        Checker { chords, ..self }
    }

    /// The arithmetic of slopes in `m` coordinates.
    pub fn slopes(&self, m: usize) -> Slopes<'a, E> {
        Slopes::new(self.arithmetic, m)
    }

    /// The formulas over a cell.
    pub fn evaluate(&self, edges: &[[E::Number; 3]]) -> Formulas<E> {
        self.values(None, edges)
    }

    /// The same of the entries that are needed alone, where it is said which.
    fn values(&self, needed: Option<&[bool]>, edges: &[[E::Number; 3]]) -> Formulas<E> {
        let slopes = self.slopes(edges.len());
        let coordinate = |k: usize| slopes.coordinate(k, edges.get(k)?.clone());
        let parameter = |j: usize| slopes.constant(self.parameters.get(j)?.clone());
        let known = (needed, &self.constant);
        self.problem.tape.run_parts(&slopes, known, coordinate, parameter)
    }

    /// Whether the evidence shows that a test holds on a cell.
    pub fn shows(&self, over: &Over<'_, E>, test: &Test, evidence: &Evidence) -> bool {
        let rows = if over.controls.is_some() { &self.scaled } else { &self.rows };
        match (test, evidence) {
            (test, Evidence::Control(evidence)) => {
                let then = |over: &Over<'_, E>| self.shows(over, test, evidence);
                // Of a part, control points are not known.
                over.slopes.part.is_none()
                    && over.half.is_none()
                    && self.at_controls(over, test, then) == Some(true)
            }
            (test, Evidence::Turned(inner, n, p) | Evidence::Inside(inner, n, p)) => {
                use Evidence::{Control, Corner, Inside, Turned};
                let is_turned = matches!(evidence, Turned(..));
                let is_plain = match **inner {
                    Turned(..) | Control(_) | Corner(_) => false,
                    Inside(..) => is_turned,
                    _ => true,
                };
                let less = match is_turned {
                    _ if !is_plain || *n < 0 || *p >= MOST_PLACES => None,
                    true => self.turned(over, (*n, *p)),
                    false => self.inside(over, (*n, *p)),
                };
                let sum = less.and_then(|less| match &over.inside {
                    None => Some(less),
                    Some(other) => {
                        less.iter().zip(other).map(|(a, b)| self.arithmetic.add(a, b)).collect()
                    }
                });
                sum.is_some_and(|sum| self.shows(&Over { inside: Some(sum), ..*over }, test, inner))
            }
            (test, Evidence::Tolerances(evidence, ends, directions)) => {
                let plain = is_of_vertices(test, evidence)
                    && are_for(directions, (test, over.half), over.place.edges.len());
                let then = |over: &Over<'_, E>| self.shows(over, test, evidence);
                plain && self.apart(over, (ends, directions), then) == Some(true)
            }
            (test, Evidence::Together(evidence, all, places)) => {
                use Test::{Conditioning, Greatest, Least, SigmaMax, SigmaMin};
                let is_plain = matches!(**evidence, Evidence::Lower(_) | Evidence::Test)
                    && over.together.is_none()
                    && over.wedge.is_none()
                    && over.tolerances.is_some_and(|all| all.second.is_some())
                    && *places < MOST_PLACES;
                let rows = match test {
                    SigmaMin(_) | SigmaMax(_) | Conditioning(_) => rows.len(),
                    Least(rows, _) | Greatest(rows, _) => rows.len(),
                    _ => return false,
                };
                let (together, inside) = (Some((&all[..], *places)), over.inside.clone());
                let plain = is_plain && all.len() == rows;
                plain && self.shows(&Over { together, inside, ..*over }, test, evidence)
            }
            (Test::Conditioning(c), Evidence::Between(mu, places, weights, lower, upper)) => {
                let Some(weights) = self.by_parameters(weights) else { return false };
                let part = |evidence, upper| {
                    let half = Some(Half { mu: (mu, *places), weights: &weights, upper });
                    self.shows(&Over { half, inside: None, ..*over }, test, evidence)
                };
                let plain = over.is_plain() && over.half.is_none();
                plain && part(lower, None) && part(upper, Some(*c))
            }
            (test, Evidence::Fan(parts)) => self.fan(over, test, parts) == Some(true),
            (Test::SigmaMin(kappa), Evidence::Rank(y)) => {
                let zero = self.problem.tape.op(*kappa) == Op::Integer(0);
                zero && self.problem.is_defined(over.values) && over.full_rank(rows, y)
            }
            (Test::SigmaMin(kappa), Evidence::Lower(y)) => {
                self.problem.is_defined(over.values)
                    && over.sigma_min(rows, &|v| self.scaled(over, over.range(*kappa)?, v), y)
            }
            (Test::SigmaMax(k), Evidence::Test) => {
                over.sigma_max(rows, &|v| self.scaled(over, over.range(*k)?, v))
            }
            (Test::Conditioning(_), Evidence::Lower(y)) => {
                over.half.is_some_and(|half| self.bound(over, rows, half, Some(y)))
            }
            (Test::Conditioning(_), Evidence::Test) => {
                over.half.is_some_and(|half| self.bound(over, rows, half, None))
            }
            // It has a `mu` of its own.
            (Test::Conditioning(c), Evidence::Conditioning(y, mu)) => {
                let half = |upper| Half { mu: (mu, y.places), weights: &[], upper };
                over.half.is_none()
                    && self.bound(over, rows, half(None), Some(y))
                    && self.bound(over, rows, half(Some(*c)), None)
            }
            (Test::OneToOne(rows), Evidence::Chords) => {
                self.chords.as_ref().is_some_and(|y| over.full_rank(rows, y))
            }
            (Test::AtLeast(f), Evidence::Test) => over.at_least(&[(*f, false)]),
            (Test::Solve(test), Evidence::Lower(y)) => {
                let weight = |v| self.scaled(over, self.arithmetic.integer(1)?, v);
                over.solve(rows, test, &weight, y)
            }
            (Test::Least(rows, kappa), Evidence::Lower(y)) => {
                over.sigma_min(rows, &|v| over.greatest_at(*kappa, v), y)
            }
            (Test::Greatest(rows, k), Evidence::Test) => {
                over.sigma_max(rows, &|v| over.least_at(*k, v))
            }
            (Test::Accuracy(test), Evidence::Accuracy(y, kappa, p)) => {
                self.accuracy(over, test, (y, *kappa, *p)) == Some(true)
            }
            // What follows knows of vertices alone.
            _ if over.controls.is_some() => false,
            (Test::SigmaMin(kappa), Evidence::LowerDivided(y)) => {
                self.problem.is_defined(over.values)
                    && over.sigma_min(&self.divided, &|_| over.range(*kappa), y)
            }
            (Test::SigmaMin(_), Evidence::Corner(corner)) => {
                self.corner(over.place, *corner).is_some()
            }
            (Test::SigmaMax(k), Evidence::Divided) => {
                over.sigma_max(&self.divided, &|_| over.range(*k))
            }
            (Test::SigmaMax(_), Evidence::Cube) => self.problem.cube_has_least,
            (Test::Apart(test), Evidence::Direction(g)) => over.apart(test, g),
            (Test::Curvature(test), Evidence::Test) => over.curvature(test),
            (Test::AtLeast(f), Evidence::Cube) => self.problem.cube_reached.contains(f),
            (Test::Beyond(f, b), Evidence::Test | Evidence::Negative) => {
                over.at_least(&[(*f, *evidence == Evidence::Negative), (*b, true)])
            }
            _ => false,
        }
    }

    /// A bound on squares, of the scaled rows times their weight.
    fn scaled(&self, over: &Over<'_, E>, bound: E::Number, v: Vertex) -> Option<E::Number> {
        match over.controls {
            None => Some(bound),
            Some(_) => self.arithmetic.mul(&bound, &over.at(self.problem.weight?, v)?),
        }
    }

    /// The directions of each part ([`Wedge`]), of tests that are about each direction by itself.
    fn fan(&self, over: &Over<'_, E>, test: &Test, parts: &[Part]) -> Option<bool> {
        let m = match test {
            Test::SigmaMin(_) | Test::SigmaMax(_) => over.place.edges.len(),
            // Both bounds of a condition number have the same `mu`, whatever the direction.
            Test::Conditioning(_) if over.half.is_some() => over.place.edges.len(),
            Test::Least(rows, _) | Test::Greatest(rows, _) => width(rows),
            _ => return None,
        };
        let last = parts.first()?.0.iter().map(|x| x.checked_neg());
        let last: Vec<i64> = last.collect::<Option<_>>()?;
        let next = parts.iter().skip(1).map(|part| &part.0).chain([&last]);
        let plain = over.is_plain() && over.wedge.is_none();
        let plain = plain && over.half.is_none_or(|half| half.weights.is_empty());
        let mut all = parts.iter().zip(next);
        Some(
            plain
                && all.all(|(Part(b, n, places, evidence), c)| {
                    let wedge = Some(Wedge { between: [b, c], n: *n, places: *places });
                    let sound = b.len() == m && *n >= 0 && *places < MOST_PLACES;
                    sound && self.shows(&Over { wedge, inside: None, ..*over }, test, evidence)
                }),
        )
    }

    /// The test of accuracy, with the formulas near the cell.
    fn accuracy(
        &self,
        over: &Over<'_, E>,
        test: &Accuracy,
        evidence: (&Multiplier, i64, u32),
    ) -> Option<bool> {
        let (tape, slopes) = (&self.problem.tape, over.slopes);
        let far = near(tape, &self.parameters, slopes, over.place.edges, test, |f| over.range(f))?;
        Some(self.problem.is_defined(&far) && over.accuracy(&far, test, evidence))
    }

    /// **Conditioning.** `mu_v = mu_0 + sum_k v_k mu_k > 0` at the vertices, and with it both bounds:
    /// `sigma_min^2 >= mu`, `sigma_max^2 <= c^2 mu` for the same convex combination `mu` of the `mu_v`.
    /// At control points `mu_v = mu_0 w_v + sum_k t_vk mu_k`, where `t_vk` in `{-1, 0, 1}` is the place of the
    /// coordinate's node between the ends of its range, and `w sigma_min^2 >= mu`, `w sigma_max^2 <= c^2 mu`
    /// for the same convex combination: any other `mu_v` would do. Each bound may have evidence of its own, with the same
    /// `mu_v` ([`Half`]); with two of them it would be unsound.
    ///
    /// With `n_ij` it is `mu_v + sum_ij n_ij theta_j`, of each machine its own: what is shown of each is that of it. A step
    /// `r` of quantity `j` changes it by `n_ij r` with row `i`.
    fn bound(
        &self,
        over: &Over<'_, E>,
        rows: &[Row<Formula>],
        half: Half<'_>,
        y: Option<&Multiplier>,
    ) -> bool {
        let mu = |v| self.mu(over, half, v);
        let above = |v| self.arithmetic.mul(&over.range(half.upper?)?, &mu(v)?);
        match y {
            Some(y) => half.upper.is_none() && over.sigma_min(rows, &mu, y),
            None => half.upper.is_some() && over.sigma_max(rows, &above),
        }
    }

    /// By parameters, what is named for the quantities by which machines differ; for each row, or not at all.
    fn by_parameters(&self, weights: &[Vec<i64>]) -> Option<Vec<BTreeMap<usize, i64>>> {
        let differing: Vec<usize> = self.problem.differing().collect();
        let is_whole = weights.is_empty() || weights.len() == self.rows.len();
        let of_row = |row: &Vec<i64>| {
            let all = differing.iter().copied().zip(row.iter().copied());
            (row.len() == differing.len()).then(|| all.filter(|(_, n)| *n != 0).collect())
        };
        weights.iter().map(of_row).collect::<Option<_>>().filter(|_| is_whole)
    }

    /// `mu_v`, of the one machine; positive of all.
    fn mu(&self, over: &Over<'_, E>, half: Half<'_>, v: Vertex) -> Option<E::Number> {
        let (e, (mu, places)) = (self.arithmetic, half.mu);
        let (&first, rest) = mu.split_first()?;
        if rest.len() != self.problem.dimension() || places >= MOST_PLACES {
            return None;
        }
        let term = |sum: i64, (k, &mu): (usize, &i64)| match mu {
            0 => Some(sum),
            mu => sum.checked_add(mu.checked_mul(over.place(k, v)?)?),
        };
        let one = e.integer(1)?;
        let own = match over.controls {
            None => e.dyadic(rest.iter().enumerate().try_fold(first, term)?, places, &one)?,
            Some(_) => {
                let along = rest.iter().enumerate().try_fold(0, term)?;
                let own = self.scaled(over, e.dyadic(first, places, &one)?, v)?;
                e.add(&own, &e.dyadic(along, places, &one)?)?
            }
        };
        let of = |parameters: &[E::Number]| {
            let terms = half.weights.iter().flatten();
            let terms = terms.map(|(j, n)| e.dyadic(*n, places, parameters.get(*j)?));
            e.sum(std::iter::once(Some(own.clone())).chain(terms))
        };
        let is_positive = e.is_positive(&of(&self.parameters)?);
        let machine = over.tolerances.map_or(&self.parameters[..], |one| one.parameters);
        is_positive.then(|| of(machine))?
    }
}
