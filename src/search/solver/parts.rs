//! Tolerances in parts: where they are too wide for boxes of any size, boxes of the workspace and of these.

use super::apart::{at_place, Stretched, LENGTHS};
use super::doubles::{magnitude, Pair};
use super::evidence::{centre, next_to, sums_of_shares, Over, Prover};
use super::rows::Rows;
use super::search::{halved, search, Boxes, Cell, Ends, Trial};
use crate::search::{Budget, Control};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use orthocert_kernel::certificate::{Node, Step};
use orthocert_kernel::formula::Formula;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use std::collections::BTreeMap;
use std::sync::Mutex;

/// What is left counts up to so much of what is lost.
const WORTH: f64 = 0.25;
/// The least that is lost, of what is left.
const LEAST_LOST: f64 = 1e-9;
/// The greatest gain of one half that counts, and the least gain that tells anything.
const MOST_GAIN: f64 = 1e3;
const LEAST_GAIN: f64 = 1e-3;
/// With directions apart so much of what is lost may lack.
const MOST_LACKING: f64 = 0.5;
/// Of so many halvings one is of that along which formulas vary most, whatever is gained: what is left of a test is
/// foreseen from its worst vertex and machine alone, and may be so wrongly on every box below.
const ONE_OF: u32 = 3;

/// What each number changes of a row.
type Changes = BTreeMap<usize, DVector<f64>>;

/// A problem whose boxes have, after the coordinates, the ranges of the numbers with two ends.
pub(super) struct Parts<'a> {
    problem: &'a Problem,
    root: Cell,
    coordinates: usize,
    /// Whether directions are apart, where that is foreseen to help.
    apart: bool,
    /// Those that no thread narrows at the moment.
    provers: Mutex<Vec<Prover<'a>>>,
}

/// Most numbers with two ends of which all are tried: each box is looked at once more for either half of each.
const MOST_NUMBERS: usize = 16;
/// Of more numbers, so many are tried, those to whose halves most is lost.
const TRIED: usize = 6;
/// Next to one point so much fewer boxes have to be enough, and of a level so many.
const NEXT_TO_POINT: usize = 4;
const ABREAST_NEXT_TO_POINT: usize = 256;
/// Tolerances, and coordinates, times boxes of a tree; a third of it for each coordinate of orientation, as each box takes
/// three times as long.
const MOST_TRIED: usize = 64_000;

impl<'a> Parts<'a> {
    /// Most boxes that are worth it.
    pub fn most(&self) -> usize {
        MOST_TRIED / self.root.len() / 3usize.pow(self.problem.orientation.len() as u32)
    }

    /// The parts of a problem with tolerances, with directions apart if it says so.
    pub fn new(prover: &Prover<'a>, apart: bool) -> Option<Self> {
        let problem = prover.problem;
        problem.derived.as_ref()?;
        let inputs = problem.inputs.iter().zip(prover.parameters());
        let ranges = inputs.filter(|(input, _)| input.has_two_ends()).map(|(_, range)| *range);
        let root: Cell = prover.root.iter().copied().chain(ranges).collect();
        let coordinates = prover.root.len();
        let numbers = root.len() - coordinates;
        // Many numbers of a platform that turns in space take longer than they gain.
        let most = if problem.orientation.len() > 1 { MOST_NUMBERS } else { usize::MAX };
        (1..=most).contains(&numbers).then(|| Parts {
            problem,
            root,
            coordinates,
            apart,
            provers: Mutex::default(),
        })
    }

    /// Whether all tests hold next to a point of the workspace, with tolerances in few parts, of so many boxes as a tree
    /// may have: where they do not, no tree is a proof of as few.
    pub fn hold_next_to(&self, point: &[f64], budget: Budget, control: &mut Control<'_>) -> bool {
        let (own, ranges) = self.root.split_at(self.coordinates);
        let own = point.iter().zip(own).map(|(&x, &range)| next_to(x, range));
        let root = own.chain(ranges.iter().copied()).collect();
        let there = Parts { root, provers: Mutex::default(), ..*self };
        let ends = Ends { hopeless: true, enough: Some(ABREAST_NEXT_TO_POINT) };
        let budget = Budget { max_boxes: budget.max_boxes / NEXT_TO_POINT, ..budget };
        search(&there, ends, budget, control).is_proof()
    }

    /// Which inputs the ranges are of.
    fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let inputs = self.problem.inputs.iter().enumerate();
        inputs.filter(|(_, input)| input.has_two_ends()).map(|(j, _)| j)
    }

    /// With a prover for a part of the tolerances.
    fn narrowed<T>(&self, ranges: &[Pair], then: impl FnOnce(&mut Prover<'a>) -> T) -> Option<T> {
        let waiting = self.provers.lock().ok()?.pop();
        let mut prover = waiting.or_else(|| Prover::new(self.problem).ok())?;
        prover.checker.narrow(ranges);
        let found = then(&mut prover);
        self.provers.lock().ok()?.push(prover);
        Some(found)
    }

    /// What is left of each of these tests on a box, about, and what is lost.
    fn margins(&self, cell: &Cell, open: &[usize]) -> Vec<Option<[f64; 2]>> {
        let (own, ranges) = cell.split_at(self.coordinates);
        let margin = |over: &Over<'_>, o: &usize| over.left_of(&self.problem.obligations[*o].test);
        let all = self.narrowed(ranges, |prover| {
            prover.on(&own.to_vec(), |over| open.iter().map(|o| margin(over, o)).collect())
        });
        all.unwrap_or_default()
    }

    /// How much is gained by halving the coordinate along which what is open varies most, and each range; where that tells
    /// nothing, and now and then, by how much it varies along each.
    fn weights(&self, cell: &Cell, open: &[usize], own: &[f64]) -> Vec<f64> {
        if self.halvings(cell) % ONE_OF != ONE_OF - 1 {
            let gains = self.gains(cell, open, own);
            if gains.iter().any(|gain| *gain > LEAST_GAIN) {
                return gains;
            }
        }
        self.variations(cell, open)
    }

    /// By how much, about, what is open varies along each coordinate, and with each range; where that is not known, as none
    /// of the derivatives is defined over so wide tolerances, how wide each is.
    fn variations(&self, cell: &Cell, open: &[usize]) -> Vec<f64> {
        let (own, ranges) = cell.split_at(self.coordinates);
        let numbers: Vec<usize> = self.numbers().collect();
        let of = |prover: &mut Prover<'a>| {
            let parts: Vec<Vec<f64>> = prover.on(&own.to_vec(), |over| {
                let tests = open.iter().map(|&o| &self.problem.obligations[o].test);
                tests.filter_map(|test| over.variation(test, &numbers)).collect()
            });
            let weights = sums_of_shares(&parts, cell.len());
            if weights.iter().any(|weight| *weight > 0.0) {
                return weights;
            }
            cell.iter().map(|own| own.1 - own.0).collect()
        };
        self.narrowed(ranges, of).unwrap_or_else(|| vec![0.0; cell.len()])
    }

    /// Tries with directions apart what does not lack too much of what is lost.
    fn with_directions_apart(&self, prover: &Prover<'a>, own: &Cell, trial: &mut Trial) {
        let lacks = |over: &Over<'_>, o: &usize| {
            let left = over.left_of(&self.problem.obligations[*o].test);
            left.is_none_or(|[left, lost]| left <= -MOST_LACKING * lost)
        };
        let (rest, tried): (Vec<usize>, Vec<usize>) =
            prover.on(own, |over| trial.open.iter().partition(|o| lacks(over, o)));
        if tried.is_empty() {
            return;
        }
        let found = prover.tried(own, (&tried, false), true);
        trial.node.by.extend(found.node.by);
        trial.node.by.sort_by_key(|Step(o, _)| *o);
        trial.open = [rest, found.open].concat();
        trial.open.sort_unstable();
    }

    /// How many halvings lead from the root to a box.
    fn halvings(&self, cell: &Cell) -> u32 {
        let each = cell.iter().zip(&self.root).filter(|(_, root)| root.0 < root.1);
        let each = each.map(|(own, root)| ((root.1 - root.0) / (own.1 - own.0)).log2().round());
        each.sum::<f64>() as u32
    }

    /// By how much the halves hold more nearly than the box, where they are tried.
    fn gains(&self, cell: &Cell, open: &[usize], own: &[f64]) -> Vec<f64> {
        let before = self.margins(cell, open);
        let greatest = |best: usize, k: usize| if own[k] > own[best] { k } else { best };
        let first = (0..self.coordinates).fold(0, greatest);
        let gain = |k: usize| {
            let Some(halves) = halved(cell, k) else { return f64::MIN };
            let halves = halves.map(|half| self.margins(&half, open));
            let gains = before.iter().enumerate().flat_map(|(o, before)| {
                halves.iter().map(move |half| match (before, half.get(o).copied().flatten()) {
                    (None, None) => 0.0,
                    (None, Some(_)) => 1.0,
                    (Some(_), None) => -1.0,
                    (Some([margin, lost]), Some([after, _])) => {
                        let least = LEAST_LOST * (margin.abs() + after.abs());
                        let short = |margin: f64| {
                            let x = -margin / (WORTH * lost.max(least));
                            x.max(0.0) + (-x.abs()).exp().ln_1p()
                        };
                        (short(*margin) - short(after)).clamp(-MOST_GAIN, MOST_GAIN)
                    }
                })
            });
            gains.sum()
        };
        let tried = self.tried(cell, open);
        let is_tried = |k: usize| k == first || tried.contains(&k);
        (0..cell.len()).map(|k| if is_tried(k) { gain(k) } else { f64::MIN }).collect()
    }

    /// The ranges whose halves are tried.
    fn tried(&self, cell: &Cell, open: &[usize]) -> Vec<usize> {
        let all = self.coordinates..cell.len();
        if all.len() <= MOST_NUMBERS {
            return all.collect();
        }
        let (own, ranges) = cell.split_at(self.coordinates);
        let of = |prover: &mut Prover<'a>| {
            prover.on(&own.to_vec(), |over| {
                let mut all: BTreeMap<usize, f64> = BTreeMap::new();
                for o in open {
                    over.lost_by(&self.problem.obligations[*o].test, &mut all);
                }
                all
            })
        };
        let lost = self.narrowed(ranges, of).unwrap_or_default();
        let lost: Vec<f64> =
            self.numbers().map(|j| lost.get(&j).copied().unwrap_or_default()).collect();
        let mut order: Vec<usize> = (0..lost.len()).filter(|&i| lost[i] > 0.0).collect();
        order.sort_by(|&a, &b| lost[b].total_cmp(&lost[a]));
        order.iter().take(TRIED).map(|i| self.coordinates + i).collect()
    }
}

impl Boxes for Parts<'_> {
    fn root(&self) -> &Cell {
        &self.root
    }

    fn obligations(&self) -> usize {
        self.problem.obligations.len()
    }

    fn trial(&self, cell: &Cell, open: &[usize], _: bool) -> Trial {
        let (own, ranges) = cell.split_at(self.coordinates);
        let (own, whole) = (own.to_vec(), ranges == &self.root[self.coordinates..]);
        // What is of the whole tolerance is shown before that is halved.
        let of_whole = |&o: &usize| matches!(self.problem.obligations[o].test, Test::Accuracy(_));
        let (late, now): (Vec<usize>, Vec<usize>) =
            open.iter().partition(|&o| !whole && of_whole(o));
        let found = self.narrowed(ranges, |prover| {
            let mut trial = prover.tried(&own, (&now, false), false);
            if self.apart && !trial.open.is_empty() {
                self.with_directions_apart(prover, &own, &mut trial);
            }
            if !trial.open.is_empty() {
                prover.checker.narrow(&centre(ranges));
                trial.hopeless = prover.is_hopeless(&own, &trial.open, self.apart);
            }
            trial
        });
        let nothing = || Trial {
            node: Node::default(),
            open: now.clone(),
            weights: Vec::new(),
            hopeless: true,
        };
        let mut trial = found.unwrap_or_else(nothing);
        trial.hopeless |= !late.is_empty();
        trial.open.extend(late);
        if trial.open.is_empty() || trial.hopeless {
            trial.weights.resize(cell.len(), 0.0);
        } else if trial.open.iter().any(of_whole) {
            trial.weights.resize(cell.len(), f64::MIN);
        } else {
            trial.weights = self.weights(cell, &trial.open, &trial.weights);
        }
        trial
    }
}

impl Over<'_> {
    /// By how much a test holds for the worst machine, about, less what is lost; and that.
    pub(super) fn left_of(&self, test: &Test) -> Option<[f64; 2]> {
        let own = |there: &Over<'_>| match test {
            Test::Conditioning(c) => {
                let least = there.left_along(&Test::SigmaMin(*c))?;
                let (most, c) = (there.left_along(&Test::SigmaMax(*c))?, there.centre(*c)?);
                Some([c * least[0] + most[0], c * least[1] + most[1]])
            }
            _ => {
                let [value, lost] = there.left_along(test)?;
                let bound = match test {
                    Test::SigmaMin(f) | Test::Least(_, f) => -there.centre(*f)?,
                    Test::SigmaMax(f) | Test::Greatest(_, f) => there.centre(*f)?,
                    Test::Solve(solve) => there.centre(solve.square)?.recip(),
                    _ => 0.0,
                };
                Some([value + bound, lost])
            }
        };
        self.there(test, own).or_else(|| own(self))
    }

    /// By how much a test's formulas vary along each coordinate, and with each of these numbers; endlessly where that is not
    /// known.
    fn variation(&self, test: &Test, numbers: &[usize]) -> Option<Vec<f64>> {
        let derived = self.prover.checker.derived(self.formulas.place, self.prover.has_scales())?;
        let derivatives = &self.problem().derived.as_ref()?.of;
        let by = |f: Formula, number: usize| {
            let own = derivatives.get(&f)?.iter().filter(|(j, _)| *j == number);
            let sizes = own.map(|(_, d)| Some(magnitude(&derived.of(*d)?.range)));
            let (low, high) = *self.prover.of_one_scale().get(number)?;
            Some(0.5 * (high - low) * sizes.sum::<Option<f64>>()?)
        };
        let along = (0..self.m()).map(|k| self.varies(test, &|f| self.along(f, k)));
        let with = |&j: &usize| self.varies(test, &|f| by(f, j).unwrap_or(f64::INFINITY));
        Some(along.chain(numbers.iter().map(with)).collect())
    }

    /// Adds what is lost of a test for the ranges of derivatives, by each number, as a share of all of it: about the sum of
    /// a row of second derivatives times both tolerances.
    pub(super) fn lost_by(&self, test: &Test, all: &mut BTreeMap<usize, f64>) {
        let own = |there: &Over<'_>| {
            let tests = match test {
                Test::Conditioning(c) => vec![Test::SigmaMin(*c), Test::SigmaMax(*c)],
                _ => vec![test.clone()],
            };
            let lost = |test: &Test| there.ranges_of_derivatives(&there.worst(test)?);
            tests.iter().map(lost).collect::<Option<Vec<_>>>()
        };
        for lost in self.there(test, own).or_else(|| own(self)).into_iter().flatten() {
            let total: f64 = lost.iter().map(|(_, lost)| lost).sum();
            for (j, lost) in lost.into_iter().filter(|_| total > 0.0 && total.is_finite()) {
                *all.entry(j).or_default() += lost / total;
            }
        }
    }

    fn left_along(&self, test: &Test) -> Option<[f64; 2]> {
        let worst = self.worst(test)?;
        let [changed, lost] = self.taken_off(&worst)?;
        let across = match test {
            Test::SigmaMin(_) | Test::Least(..) => {
                self.across(self.most_stretched(test, false)?)?
            }
            Test::SigmaMax(_) | Test::Greatest(..) => {
                self.across(self.most_stretched(test, true)?)?
            }
            _ => worst.value - changed,
        };
        let value = across.min(worst.value - changed);
        Some([value - lost, lost + worst.value - changed - value])
    }

    /// The least eigenvalue of `T` of the worst machine less what is taken off for the others, which is more across
    /// the worst direction than along it.
    fn across(&self, found: Stretched) -> Option<f64> {
        let Stretched { rows, values: Rows { a, d }, sign, place, directions, .. } = &found;
        let w = directions.first()?;
        let derived = self.prover.checker.derived(self.formulas.place, self.prover.has_scales())?;
        let derivatives = &self.problem().derived.as_ref()?.of;
        let at = |f: Formula| Some(at_place(derived.of(f)?, place));
        let mut t = DMatrix::zeros(a.ncols(), a.ncols());
        let mut changes: Vec<(DVector<f64>, Changes)> = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            let y = a.row(i).transpose() / d[i];
            t += &y * a.row(i) * *sign;
            let mut all = Changes::new();
            for (k, f) in row.a.iter().chain([&row.d]).enumerate() {
                for &(j, derivative) in derivatives.get(f)? {
                    let (low, high) = *self.prover.of_one_scale().get(j)?;
                    let change = *sign * at(derivative)? * (high - low);
                    let s = all.entry(j).or_insert_with(|| DVector::zeros(a.ncols()));
                    match k < a.ncols() {
                        true => s[k] += change,
                        false => *s -= &y * (0.5 * change),
                    }
                }
            }
            changes.push((y, all));
        }
        // From the end of each that is worst along the direction.
        let mut slopes: BTreeMap<usize, f64> = BTreeMap::new();
        for (y, all) in &changes {
            for (j, s) in all {
                *slopes.entry(*j).or_default() += y.dot(w) * s.dot(w);
            }
        }
        for (y, all) in &mut changes {
            for (j, s) in all {
                if slopes[j] < 0.0 {
                    *s *= -1.0;
                }
                t -= (&*y * s.transpose() + &*s * y.transpose()) * 0.5;
            }
        }
        let least = |length: &f64| {
            let w = w * (*length / w.amax());
            let size = |x: &DVector<f64>| x.dot(&w).abs() + x.iter().map(|x| x.abs()).sum::<f64>();
            let mut t = t.clone();
            for (e, all) in &changes {
                for s in all.values().filter(|s| s.amax() > 0.0) {
                    let tau = size(e) / size(s);
                    let p = s * tau - e;
                    t -= &p * p.transpose() / (2.0 * tau);
                }
            }
            let is_known = t.iter().all(|x| x.is_finite());
            is_known.then(|| SymmetricEigen::new(t).eigenvalues.min())
        };
        LENGTHS.iter().filter_map(least).reduce(f64::max)
    }
}
