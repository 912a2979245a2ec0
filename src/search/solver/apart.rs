//! Tolerances apart: from which machine, and along which directions.

use super::doubles::{half_width, middle, Pair};
use super::evidence::{At, Over};
use super::rows::Rows;
use nalgebra::{DVector, SymmetricEigen};
use orthocert_kernel::cell::Vertex;
use orthocert_kernel::certificate::Evidence;
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::Leg;
use orthocert_kernel::problem::Derived;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::slope::{evaluate, Slope};
use orthocert_kernel::test::{self, Row};
use std::collections::{BTreeMap, BTreeSet};

/// Greatest components of directions that are tried: the longer, the less is lost along them, and the
/// more across them. Of length 0 all directions count alike, which is best where several are worst at once.
pub(super) const LENGTHS: [f64; 3] = [64.0, 8.0, 0.0];
/// The same of second order, where across them as little is lost.
pub(super) const LENGTHS_OF_SECOND_ORDER: [f64; 3] = [1024.0, 64.0, 0.0];

/// What part of all that is lost for ranges of derivatives makes a quantity one of second order.
const OF_SECOND_ORDER: f64 = 0.01;

/// Where a test is nearest to failing.
pub(super) struct Worst {
    /// At which vertex, or control point, and where that is between the ends of each coordinate's range.
    pub vertex: usize,
    pub place: Vec<f64>,
    /// What matrices are least, or greatest, along.
    pub directions: Vec<DVector<f64>>,
    /// What the test wants positive there, but for the bound.
    pub value: f64,
    /// Nearly the derivatives by formulas of what the test wants positive; none where no one machine is
    /// worse than all others.
    weights: Vec<(Formula, f64)>,
}

/// Where `M` stretches some direction least, or most.
pub(super) struct Stretched {
    pub rows: Vec<Row<Formula>>,
    pub values: Rows,
    value: f64,
    pub sign: f64,
    pub vertex: usize,
    pub place: Vec<f64>,
    /// All directions, from the one that is stretched least, or most, on.
    pub directions: Vec<DVector<f64>>,
}

impl Worst {
    /// Of the sum of both, with so much of the other one.
    pub fn and(&self, other: &Self, part: f64) -> Self {
        let more = other.weights.iter().map(|(f, weight)| (*f, part * weight));
        let weights = self.weights.iter().copied().chain(more).collect();
        Worst { weights, directions: Vec::new(), place: self.place.clone(), ..*self }
    }
}

impl Stretched {
    /// The same for any direction. Of `|M v|^2 = sum_i (A_i . v)^2/D_i`, the derivatives are `2 (A_i . v) v_k/D_i` by
    /// `A_ik`, and `-(A_i . v)^2/D_i^2` by `D_i`.
    pub fn along(&self, direction: DVector<f64>) -> Worst {
        let (along, mut weights) = (&self.values.a * &direction, Vec::new());
        for (i, row) in self.rows.iter().enumerate() {
            let part = along[i] / self.values.d[i];
            let entry = |(&f, v): (&Formula, &f64)| (f, 2.0 * self.sign * part * v);
            weights.extend(row.a.iter().zip(direction.iter()).map(entry));
            weights.push((row.d, -self.sign * part * part));
        }
        let (vertex, place, value) = (self.vertex, self.place.clone(), self.value);
        Worst { vertex, place, directions: vec![direction], value, weights }
    }
}

impl Over<'_> {
    /// Evidence with tolerances apart, where there are some: from the worst machine, as it seems, then
    /// from that in the middle, with the longest directions.
    pub(super) fn with_tolerances_apart(&self, test: &Test) -> Option<Evidence> {
        self.problem().derived.as_ref()?;
        let worst = self.there(test, |there| there.worst(test)).or_else(|| self.worst(test))?;
        let most = if worst.directions.is_empty() { 1 } else { LENGTHS.len() };
        // Of one scale are what no other evidence shows: fewer checkers know of it.
        let scales = [false, true].into_iter().take(1 + usize::from(self.prover.has_scales()));
        let machines = scales.flat_map(|scaled| {
            let worst = self.worst_machine(&worst, scaled).map(|ends| (ends, &LENGTHS[..most]));
            // What shorter directions show of the machine in the middle, they mostly do of the worst one.
            let few = if worst.is_some() { 1 } else { most };
            [worst, Some((self.middle_machine(scaled), &LENGTHS[..few]))]
        });
        let machines: Vec<(String, &[f64])> = machines.flatten().collect();
        let from = |ends: &str, all: &[f64]| self.apart_from(test, &worst, (ends, all));
        machines.iter().find_map(|(ends, all)| from(ends, all)).or_else(|| {
            let by = self.of_second_order(test)?;
            // Of one scale, where directions are so: nothing is lost by that.
            let mut last = machines[machines.len().saturating_sub(2)..].iter();
            let second = |ends: &str| self.to_second_order(ends, &by);
            last.find_map(|(ends, _)| from(&second(ends), &LENGTHS_OF_SECOND_ORDER[..most]))
        })
    }

    /// The quantities for the ranges of whose derivatives most is lost, where second derivatives are known.
    pub(super) fn of_second_order(&self, test: &Test) -> Option<BTreeSet<usize>> {
        self.problem().derived.as_ref()?.second.as_ref()?;
        let mut lost = BTreeMap::new();
        self.lost_by(test, &mut lost);
        let total: f64 = lost.values().sum();
        let most = lost.into_iter().filter(|(_, lost)| *lost > OF_SECOND_ORDER * total);
        Some(most.map(|(j, _)| j).collect()).filter(|by: &BTreeSet<usize>| !by.is_empty())
    }

    /// Where the one machine is, with these quantities of second order.
    pub(super) fn to_second_order(&self, ends: &str, by: &BTreeSet<usize>) -> String {
        let second = |(end, j): (char, usize)| match end {
            '-' if by.contains(&j) => '<',
            '0' if by.contains(&j) => '=',
            '+' if by.contains(&j) => '>',
            end => end,
        };
        ends.chars().zip(self.problem().differing()).map(second).collect()
    }

    /// The machine in the middle; with directions of one scale, where it says so.
    pub(super) fn middle_machine(&self, scaled: bool) -> String {
        self.ends(scaled, |_| '0')
    }

    /// Where each quantity by which machines differ is.
    fn ends(&self, scaled: bool, end: impl Fn(usize) -> char) -> String {
        let is_scale = |j| scaled && self.prover.is_scale(j);
        self.problem().differing().map(|j| if is_scale(j) { '1' } else { end(j) }).collect()
    }

    /// From one machine.
    pub(super) fn apart_from(
        &self,
        test: &Test,
        worst: &Worst,
        (ends, lengths): (&str, &[f64]),
    ) -> Option<Evidence> {
        lengths.iter().find_map(|length| {
            let directions: Vec<Vec<i64>> =
                worst.directions.iter().map(|w| in_integers(w, *length)).collect();
            self.apart_along(test, (ends, &directions), worst.vertex)
        })
    }

    /// The same along directions, where what fails mostly fails at a vertex.
    pub(super) fn apart_along(
        &self,
        test: &Test,
        (ends, directions): (&str, &[Vec<i64>]),
        vertex: usize,
    ) -> Option<Evidence> {
        let formulas = test::Over { first: vertex, inside: None, ..*self.formulas };
        let found = self.prover.checker.apart(&formulas, (ends, directions), |formulas| {
            let apart = Over { formulas, ..*self };
            apart.at_controls(test).or_else(|| apart.at_vertices(test))
        })??;
        Some(Evidence::Tolerances(Box::new(found), ends.to_owned(), directions.to_owned()))
    }

    pub(super) fn worst<'r>(&'r self, test: &Test) -> Option<Worst> {
        let row = |leg: &'r Leg| match self.formulas.controls {
            None => &leg.row,
            Some(_) => leg.scaled.as_ref().unwrap_or(&leg.row),
        };
        let own: Vec<&Row<Formula>> = self.problem().legs.iter().map(row).collect();
        match test {
            Test::SigmaMin(_) => self.stretched(&own, false),
            Test::SigmaMax(_) => self.stretched(&own, true),
            Test::Conditioning(_) if self.formulas.half.is_some() => {
                self.stretched(&own, self.formulas.half?.upper.is_some())
            }
            Test::Conditioning(_) => {
                let (least, most) = (self.stretched(&own, false)?, self.stretched(&own, true)?);
                let directions = [least.directions, most.directions].concat();
                Some(Worst { directions, weights: Vec::new(), ..least })
            }
            Test::Least(rows, _) | Test::Greatest(rows, _) => {
                let most = matches!(test, Test::Greatest(..));
                self.stretched(&rows.iter().collect::<Vec<_>>(), most)
            }
            Test::Solve(solve) => self.of_solution(&own, solve.joint),
            Test::AtLeast(f) => self.of_sum(vec![(*f, 1.0)]),
            Test::Beyond(f, b) => {
                let sign = if self.centre(*f)? < 0.0 { -1.0 } else { 1.0 };
                self.of_sum(vec![(*f, sign), (*b, -1.0)])
            }
            Test::OneToOne(_) | Test::Accuracy(_) | Test::Apart(_) | Test::Curvature(_) => None,
        }
    }

    /// The vertex at which `M` stretches a direction least, or most, and that.
    fn stretched(&self, rows: &[&Row<Formula>], most: bool) -> Option<Worst> {
        let rows = rows.iter().map(|&row| row.clone()).collect();
        let mut found = self.stretched_all(rows, most)?;
        let direction = found.directions.swap_remove(0);
        (direction.amax() > 0.0).then(|| found.along(direction))
    }

    /// The same with all directions there.
    pub(super) fn stretched_all(&self, rows: Vec<Row<Formula>>, most: bool) -> Option<Stretched> {
        let sign = if most { -1.0 } else { 1.0 };
        let least = |vertex| {
            let all: Rows = self.rows(rows.iter(), At::Vertex(vertex))?;
            let eigen = SymmetricEigen::new(all.square() * sign);
            Some((eigen.eigenvalues.min() / self.weight(vertex)?, vertex, eigen, all))
        };
        let found = self.formulas.vertices().filter_map(least);
        let (value, vertex, eigen, values) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let directions = order.iter().map(|&k| eigen.eigenvectors.column(k).into_owned()).collect();
        let (place, vertex) = (self.place_of(vertex), vertex.index());
        Some(Stretched { rows, values, value, sign, vertex, place, directions })
    }

    /// `z = A^-1 b`, `b = B_i e_i`, is longest, along `y = A^-T z`. The derivatives of `-|z|^2` are
    /// `2 y_j z_k` by `A_jk`, and `-y_i/B_i` by `D_i`.
    fn of_solution(&self, rows: &[&Row<Formula>], joint: usize) -> Option<Worst> {
        let longest = |vertex| {
            let Rows { a, d } = self.rows(rows.iter().copied(), At::Vertex(vertex))?;
            let mut b = DVector::zeros(rows.len());
            b[joint] = d[joint].sqrt();
            let z = a.clone().lu().solve(&b)?;
            let y = a.transpose().lu().solve(&z)?;
            // Of scaled rows b is longer by the root of the weight, and A by the weight.
            Some((z.norm() * self.weight(vertex)?.sqrt(), vertex, (y, b[joint]), z))
        };
        let found = self.formulas.vertices().filter_map(longest);
        let (length, vertex, (y, root), z) = found.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut weights = vec![(rows.get(joint)?.d, -y[joint] / root)];
        for (row, y) in rows.iter().zip(y.iter()) {
            weights.extend(row.a.iter().zip(z.iter()).map(|(&f, z)| (f, 2.0 * y * z)));
        }
        let finite = root > 0.0 && y.iter().all(|x| x.is_finite()) && y.amax() > 0.0;
        finite.then(|| self.worst_at((-length * length, vertex), vec![y], weights))
    }

    /// The vertex at which a sum is least.
    fn of_sum(&self, weights: Vec<(Formula, f64)>) -> Option<Worst> {
        let value = |v| {
            let term = |&(f, weight): &(Formula, f64)| Some(weight * self.at(f, At::Vertex(v))?);
            Some((weights.iter().map(term).sum::<Option<f64>>()?, v))
        };
        let least = self.formulas.vertices().filter_map(value).min_by(|a, b| a.0.total_cmp(&b.0));
        Some(self.worst_at(least?, Vec::new(), weights))
    }

    /// The weight by which rows are scaled there.
    fn weight(&self, vertex: Vertex) -> Option<f64> {
        let weight = self.problem().weight.filter(|_| self.formulas.controls.is_some());
        weight.map_or(Some(1.0), |weight| self.at(weight, At::Vertex(vertex)))
    }

    fn worst_at(
        &self,
        (value, vertex): (f64, Vertex),
        directions: Vec<DVector<f64>>,
        weights: Vec<(Formula, f64)>,
    ) -> Worst {
        Worst { vertex: vertex.index(), place: self.place_of(vertex), directions, value, weights }
    }

    /// Where a vertex, or control point, is between the ends of each coordinate's range.
    fn place_of(&self, vertex: Vertex) -> Vec<f64> {
        let place = |k| self.formulas.place(k, vertex).unwrap_or(0) as f64;
        (0..self.formulas.slopes.m).map(place).collect()
    }

    /// The derivative by each parameter there, about, and half of its range.
    fn by_derivatives(
        &self,
        Worst { place, weights, .. }: &Worst,
    ) -> Option<BTreeMap<usize, [f64; 2]>> {
        let values = self.prover.checker.derived(self.formulas.place, self.prover.has_scales())?;
        let Derived { of, .. } = self.problem().derived.as_ref()?;
        let mut by: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (f, weight) in weights {
            for (j, derivative) in of.get(f)? {
                let [value, half] = there(values.of(*derivative)?, place);
                let own = by.entry(*j).or_default();
                own[0] += weight * value;
                own[1] += weight.abs() * half;
            }
        }
        Some(by)
    }

    /// What each tolerance times half of the range of the derivative by it is there.
    pub(super) fn ranges_of_derivatives(&self, found: &Worst) -> Option<Vec<(usize, f64)>> {
        let all = self.by_derivatives(found)?.into_iter().map(|(j, [_, half])| {
            let (low, high) = *self.prover.of_one_scale().get(j)?;
            Some((j, (high - low) * half))
        });
        all.collect()
    }

    /// What is lost there, about, for each quantity of second order: for pairs of two, which may be of either sign, and for the
    /// ranges of second derivatives.
    fn lost_to_second_order(
        &self,
        Worst { place, weights, .. }: &Worst,
    ) -> Option<BTreeMap<usize, f64>> {
        let of = &self.problem().derived.as_ref()?.second.as_ref()?.of;
        let values = self.prover.checker.second(self.formulas.place, self.prover.has_scales())?;
        let mut by: BTreeMap<[usize; 2], [f64; 2]> = BTreeMap::new();
        for (f, weight) in weights {
            for (pair, second) in of.get(f)? {
                let [value, half] = there(values.of(*second)?, place);
                let own = by.entry(*pair).or_default();
                own[0] += weight * value;
                own[1] += weight.abs() * half;
            }
        }
        let mut lost = BTreeMap::new();
        for ([j, l], [value, half]) in by {
            let width = |j: usize| self.prover.of_one_scale().get(j).map(half_width);
            let both = width(j)? * width(l)?;
            let own = both * if j == l { half } else { value.abs() + half };
            *lost.entry(j).or_default() += 0.5 * own;
            *lost.entry(l).or_default() += 0.5 * own;
        }
        Some(lost)
    }

    /// What tolerances take off the value there, about, and the part of it that is lost for the ranges of derivatives; and what
    /// is lost for those of slopes.
    pub(super) fn taken_off(&self, found: &Worst) -> Option<[f64; 2]> {
        let parameters = self.prover.of_one_scale();
        let by = self.by_derivatives(found)?;
        let second = self.lost_to_second_order(found);
        let (mut changed, mut lost) = (0.0, 0.0);
        for (j, [slope, half]) in by {
            let (low, high) = *parameters.get(j)?;
            changed += 0.5 * (high - low) * slope.abs();
            let first = (high - low) * (half - slope.abs()).max(0.0);
            let second = second.as_ref().and_then(|lost| lost.get(&j));
            lost += second.map_or(first, |second| first.min(*second));
        }
        let machine: Vec<Pair> = parameters.iter().map(middle).map(|x| (x, x)).collect();
        let (slopes, edges) = (self.formulas.slopes, self.formulas.place.edges);
        let machine = evaluate(&self.problem().tape, &machine, slopes, edges);
        for (f, weight) in &found.weights {
            let all: f64 = machine.of(*f)?.slopes[..self.m()].iter().map(half_width).sum();
            lost += weight.abs() * all;
        }
        Some([changed, lost])
    }

    /// The ends of all tolerances that make it worst.
    pub(super) fn worst_machine(&self, worst: &Worst, scaled: bool) -> Option<String> {
        let slopes = self.by_parameters(worst, scaled)?;
        let end = |j| match slopes.get(&j) {
            Some(slope) if *slope > 0.0 => '-',
            Some(slope) if *slope < 0.0 => '+',
            _ => '0',
        };
        (!slopes.is_empty()).then(|| self.ends(scaled, end))
    }

    /// By how much it changes there, about, from one end of each parameter's tolerance to the other.
    pub(super) fn by_parameters(
        &self,
        Worst { place, weights, .. }: &Worst,
        scaled: bool,
    ) -> Option<BTreeMap<usize, f64>> {
        let values = self.prover.checker.derived(self.formulas.place, scaled)?;
        let derivatives = &self.problem().derived.as_ref()?.of;
        let mut slopes: BTreeMap<usize, f64> = BTreeMap::new();
        for (f, weight) in weights {
            for (j, derivative) in derivatives.get(f)? {
                let slope = at_place(values.of(*derivative)?, place);
                let (low, high) = *self.prover.parameters().get(*j)?;
                *slopes.entry(*j).or_default() += weight * slope * (high - low);
            }
        }
        Some(slopes)
    }
}

/// The middle and half the width of a formula's range at a place between the ends of each coordinate's range.
fn there(formula: &Slope<Pair>, place: &[f64]) -> [f64; 2] {
    let along = formula.slopes.iter().zip(place);
    let parts = along.map(|(s, at)| [middle(s) * at, half_width(s) * at.abs()]);
    let start = [middle(&formula.at_centre), half_width(&formula.at_centre)];
    parts.fold(start, |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// A formula at a place between the ends of each coordinate's range, about.
pub(super) fn at_place(formula: &Slope<Pair>, place: &[f64]) -> f64 {
    let along = formula.slopes.iter().zip(place).map(|(s, at)| middle(s) * at);
    middle(&formula.at_centre) + along.sum::<f64>()
}

/// A direction with this greatest component, in integers.
pub(super) fn in_integers(w: &DVector<f64>, length: f64) -> Vec<i64> {
    times(w, length / w.amax())
}

/// So many times a direction, in integers.
pub(super) fn times(w: &DVector<f64>, scale: f64) -> Vec<i64> {
    w.iter().map(|x| (x * scale).round() as i64).collect()
}
