//! Formulas over cells of up to three coordinates, in doubles: the slopes of [`Doubles`], with those of one
//! formula side by side, so that an operation on one is one on all.

use super::margin::View;
use crate::search::solver::doubles::{greatest, least, middle, Doubles, Pair, ROUNDING};
use crate::search::solver::evidence::Prover;
use crate::search::solver::program::{Input, Program, Slot, Step};
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::formula::{Formula, Op};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Row;
use std::cell::Cell;

/// A formula over a cell.
#[derive(Clone, Copy)]
struct Entry {
    centre: f64,
    range: Pair,
    /// The ends of its slopes; the last ones are zero.
    lo: Ends,
    hi: Ends,
}

type Ends = [f64; 4];

/// The formulas that a decision is made of.
pub(super) struct Flat {
    program: Program<Entry>,
    m: usize,
    /// What is undefined unless it is positive, and unless it has a sign.
    radicands: Vec<Slot>,
    divisors: Vec<Slot>,
}

thread_local! {
    /// Where entries are kept, from cell to cell.
    static SPARE: Cell<Vec<Entry>> = const { Cell::new(Vec::new()) };
}

/// Their values over a cell.
pub(super) struct Over<'a> {
    flat: &'a Flat,
    entries: Vec<Entry>,
}

impl Drop for Over<'_> {
    fn drop(&mut self) {
        SPARE.set(std::mem::take(&mut self.entries));
    }
}

/// The formulas of tests that have a margin.
fn formulas(problem: &Problem) -> Vec<Formula> {
    let row = |row: &Row<Formula>| row.a.iter().copied().chain([row.d]).collect::<Vec<_>>();
    let mut all: Vec<Formula> = problem.legs.iter().flat_map(|leg| row(&leg.row)).collect();
    for obligation in &problem.obligations {
        match &obligation.test {
            Test::SigmaMin(f) | Test::SigmaMax(f) | Test::AtLeast(f) => all.push(*f),
            Test::Beyond(f, b) => all.extend([*f, *b]),
            Test::Least(rows, f) | Test::Greatest(rows, f) => {
                all.extend(rows.iter().flat_map(row).chain([*f]));
            }
            _ => {}
        }
    }
    all.extend(&problem.partial);
    all
}

impl Flat {
    /// Of a claim whose numbers are known each.
    pub fn new(prover: &Prover<'_>) -> Option<Self> {
        let (problem, m) = (prover.problem, prover.root.len());
        let is_known = |&(lo, hi): &Pair| lo == hi;
        let is_plain = !prover.is_scaled && m <= 3;
        if !is_plain || !prover.parameters().iter().all(is_known) {
            return None;
        }
        let needed = problem.tape.parts(&formulas(problem));
        let program = Program::new(&problem.tape, Some(&needed), Doubles, |op| match op {
            Op::Coordinate(k) if k < m => Some(Input::Varying(k)),
            Op::Parameter(j) => Some(Input::Constant(*prover.parameters().get(j)?)),
            _ => None,
        });
        let (mut radicands, mut divisors) = (Vec::new(), Vec::new());
        for op in problem.tape.ops() {
            match *op {
                Op::Sqrt(f) => radicands.extend(program.slot(f)),
                Op::Div(_, f) => divisors.extend(program.slot(f)),
                _ => {}
            }
        }
        Some(Flat { program: program.map(constant), m, radicands, divisors })
    }

    /// Over a cell between these ends; `None` unless all are defined.
    pub fn over(&self, ends: &[Pair; 3]) -> Option<Over<'_>> {
        let mut entries = SPARE.take();
        entries.clear();
        let mut second = None;
        for &step in &self.program.steps {
            let of = |slot| self.program.at(&entries, slot);
            let entry = match step {
                Step::Input(k) => coordinate(k, *ends.get(k)?),
                Step::Add(a, b) => of(a)?.plus(of(b)?)?,
                Step::Sub(a, b) => of(a)?.minus(of(b)?)?,
                Step::Neg(a) => of(a)?.negated(),
                Step::Mul(a, b) => of(a)?.times(of(b)?)?,
                Step::Div(a, b) => of(a)?.over(of(b)?)?,
                Step::Sqr(a) => of(a)?.squared()?,
                Step::Sqrt(a) => of(a)?.root()?,
                Step::Elbow([a, b, t]) => {
                    let [c, s] = elbow(of(a)?, of(b)?, of(t)?)?;
                    second = Some(s);
                    c
                }
                Step::ElbowToo => second?,
            };
            entries.push(entry);
        }
        let range = |&at: &Slot| self.program.at(&entries, at).map(|entry| entry.range);
        let is_positive = |at| range(at).is_some_and(|(lo, _)| lo > 0.0);
        let has_sign = |at| range(at).is_some_and(|(lo, hi)| lo > 0.0 || hi < 0.0);
        let is_defined =
            self.radicands.iter().all(is_positive) && self.divisors.iter().all(has_sign);
        is_defined.then_some(Over { flat: self, entries })
    }
}

impl Over<'_> {
    fn of(&self, f: Formula) -> Option<&Entry> {
        self.flat.program.at(&self.entries, self.flat.program.slot(f)?)
    }
}

impl View for Over<'_> {
    fn m(&self) -> usize {
        self.flat.m
    }

    fn centre(&self, f: Formula) -> Option<f64> {
        self.of(f).map(|entry| entry.centre)
    }

    fn range(&self, f: Formula) -> Option<Pair> {
        self.of(f).map(|entry| entry.range)
    }

    fn slopes(&self, f: Formula) -> Option<[Pair; 3]> {
        let Entry { lo, hi, .. } = self.of(f)?;
        Some([(lo[0], hi[0]), (lo[1], hi[1]), (lo[2], hi[2])])
    }

    fn moved(&self, f: Formula) -> [[f64; 3]; 2] {
        let Some(Entry { lo, hi, .. }) = self.of(f) else { return [[0.0; 3]; 2] };
        let middle = |k: usize| 0.5 * (lo[k] + hi[k]);
        let half = |k: usize| 0.5 * (hi[k] - lo[k]);
        [[middle(0), middle(1), middle(2)], [half(0), half(1), half(2)]]
    }
}

fn constant(range: Pair) -> Entry {
    Entry { centre: range.0, range, lo: [0.0; 4], hi: [0.0; 4] }
}

fn coordinate(k: usize, range: Pair) -> Entry {
    let centre = middle(&range);
    let half = std::array::from_fn(|j| if j == k { range.1 - centre } else { 0.0 });
    Entry { centre, range, lo: half, hi: half }
}

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> Ends {
    [f(0), f(1), f(2), f(3)]
}

/// What lies between a number's ends, times what lies between each of these.
#[inline(always)]
fn times((a, b): Pair, (lo, hi): (&Ends, &Ends)) -> (Ends, Ends) {
    let (p, q) = (each(|k| a * lo[k]), each(|k| a * hi[k]));
    let (r, s) = (each(|k| b * lo[k]), each(|k| b * hi[k]));
    let least = each(|k| least(least(p[k], q[k]), least(r[k], s[k])));
    (least, each(|k| greatest(greatest(p[k], q[k]), greatest(r[k], s[k]))))
}

impl Entry {
    /// With these slopes, the range cut to what they reach.
    #[inline(always)]
    fn new(centre: f64, range: Pair, (lo, hi): (Ends, Ends)) -> Option<Self> {
        let sizes = each(|k| greatest(lo[k].abs(), hi[k].abs()));
        let reach = sizes[0] + sizes[1] + sizes[2];
        let range = (greatest(range.0, centre - reach), least(range.1, centre + reach));
        let is = range.0 <= range.1 + ROUNDING * (1.0 + reach);
        is.then_some(Entry { centre, range, lo, hi })
    }

    /// The sum of its ends and its centre.
    #[inline(always)]
    fn twice(&self) -> Pair {
        (self.range.0 + self.centre, self.range.1 + self.centre)
    }

    #[inline(always)]
    fn negated(&self) -> Self {
        let range = (-self.range.1, -self.range.0);
        Entry { centre: -self.centre, range, lo: each(|k| -self.hi[k]), hi: each(|k| -self.lo[k]) }
    }

    #[inline(always)]
    fn plus(&self, g: &Self) -> Option<Self> {
        let slopes = (each(|k| self.lo[k] + g.lo[k]), each(|k| self.hi[k] + g.hi[k]));
        let range = (self.range.0 + g.range.0, self.range.1 + g.range.1);
        Entry::new(self.centre + g.centre, range, slopes)
    }

    #[inline(always)]
    fn minus(&self, g: &Self) -> Option<Self> {
        let slopes = (each(|k| self.lo[k] - g.hi[k]), each(|k| self.hi[k] - g.lo[k]));
        let range = (self.range.0 - g.range.1, self.range.1 - g.range.0);
        Entry::new(self.centre - g.centre, range, slopes)
    }

    #[inline(always)]
    fn times(&self, g: &Self) -> Option<Self> {
        let (lo, hi) = times(g.twice(), (&self.lo, &self.hi));
        let (lo_g, hi_g) = times(self.twice(), (&g.lo, &g.hi));
        let slopes = (each(|k| 0.5 * (lo[k] + lo_g[k])), each(|k| 0.5 * (hi[k] + hi_g[k])));
        let range = Doubles.mul(&self.range, &g.range)?;
        Entry::new(self.centre * g.centre, range, slopes)
    }

    #[inline(always)]
    fn over(&self, g: &Self) -> Option<Self> {
        let (one, over) = (Doubles.recip(&(g.centre, g.centre))?, Doubles.recip(&g.range)?);
        let centre = self.centre * one.0;
        let (lo_g, hi_g) = times((centre, centre), (&g.lo, &g.hi));
        let rest = (each(|k| self.lo[k] - hi_g[k]), each(|k| self.hi[k] - lo_g[k]));
        let range = Doubles.mul(&self.range, &over)?;
        Entry::new(centre, range, times(over, (&rest.0, &rest.1)))
    }

    #[inline(always)]
    fn squared(&self) -> Option<Self> {
        let slopes = times(self.twice(), (&self.lo, &self.hi));
        Entry::new(self.centre * self.centre, Doubles.sqr(&self.range)?, slopes)
    }

    /// The mean of its value at the centre and its values.
    fn mean(&self) -> Option<Self> {
        let slopes = (each(|k| 0.5 * self.lo[k]), each(|k| 0.5 * self.hi[k]));
        let (lo, hi) = self.twice();
        Entry::new(self.centre, (0.5 * lo, 0.5 * hi), slopes)
    }

    #[inline(always)]
    fn root(&self) -> Option<Self> {
        let (centre, _) = Doubles.sqrt(&(self.centre, self.centre))?;
        let range = Doubles.sqrt(&self.range)?;
        let by = Doubles.recip(&(range.0 + centre, range.1 + centre))?;
        Entry::new(centre, range, times(by, (&self.lo, &self.hi)))
    }
}

/// Slopes in the arithmetic of entries, of three coordinates at most.
fn elbow(a: &Entry, b: &Entry, t: &Entry) -> Option<[Entry; 2]> {
    let [one, two, four] = [1.0, 2.0, 4.0].map(|x| constant((x, x)));
    let n = a.squared()?.plus(&b.squared()?)?;
    let q = n.plus(&one)?.minus(t)?;
    let h = n.times(&four)?.minus(&q.squared()?)?.root()?;
    let over = n.times(&two)?;
    let mut c = q.times(a)?.plus(&h.times(b)?)?.over(&over)?;
    let mut s = q.times(b)?.minus(&h.times(a)?)?.over(&over)?;
    let [x, y] = [a.mean()?, b.mean()?];
    for _ in 0..2 {
        let [cos, sin] = [c.mean()?, s.mean()?];
        let across = y.times(&cos)?.minus(&x.times(&sin)?)?;
        let over = one.over(&across)?;
        let (p, q) = (x.minus(&cos)?.times(&over)?, y.minus(&sin)?.times(&over)?);
        let (mut lo, mut hi) = ([0.0; 4], [0.0; 4]);
        for k in 0..3 {
            let times = |f: &Entry, lo, hi| f.times(&Entry { centre: lo, ..constant((lo, hi)) });
            let along = times(&p, a.lo[k], a.hi[k])?.plus(&times(&q, b.lo[k], b.hi[k])?)?;
            let z = along.minus(&times(&over, 0.5 * t.lo[k], 0.5 * t.hi[k])?)?;
            (lo[k], hi[k]) = z.range;
        }
        let z = (&lo, &hi);
        (c, s) = (
            Entry::new(c.centre, c.range, times((-sin.range.1, -sin.range.0), z))?,
            Entry::new(s.centre, s.range, times(cos.range, z))?,
        );
    }
    Some([c, s])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::search::paving::header;
    use orthocert_kernel::paving::Subject;

    /// Every number over cells here and there, and whether there is one, is that of the slopes.
    fn agree(text: &str) -> usize {
        let claim = Design::parse(text, "test").unwrap().claim;
        let subject = Subject::new(&header(&claim, None, 9)).unwrap();
        let prover = Prover::new(&subject.problem).unwrap();
        let flat = Flat::new(&prover).unwrap();
        let mut defined = 0;
        for i in 0..512u32 {
            let parts = [f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64)];
            let mut ends = [(0.0, 0.0); 3];
            for ((own, (lo, hi)), part) in ends.iter_mut().zip(&prover.root).zip(parts) {
                let at = |u: f64| lo + (hi - lo) * u;
                *own = (at(part / 8.0), at((part + 0.6) / 8.0));
            }
            let cell = ends[..prover.root.len()].to_vec();
            let Some(found) = flat.over(&ends) else {
                prover.on_own(&cell, |over| {
                    let lacks =
                        formulas(&subject.problem).iter().any(|&f| over.centre(f).is_none());
                    assert!(lacks || !over.undefined().is_empty(), "{cell:?}");
                });
                continue;
            };
            prover.on_own(&cell, |over| {
                for f in formulas(&subject.problem) {
                    assert_eq!(found.centre(f), View::centre(over, f), "{cell:?}: {f:?}");
                    assert_eq!(found.range(f), over.range(f), "{cell:?}: {f:?}");
                    assert_eq!(found.slopes(f), over.slopes(f), "{cell:?}: {f:?}");
                }
            });
            defined += 1;
        }
        defined
    }

    #[test]
    fn the_numbers_are_those_of_the_slopes() {
        let workspace = "[workspace]\nmin = [-0.7, -0.6, -0.5]\nmax = [0.6, 0.7, 0.4]\n";
        let require = "[requirements]\ntransmission = { min = \"1/2\", max = 2 }\n\
                       serial_margin = { min = 0.1 }\nparallel_margin = { min = 0.1 }\n\
                       leg_angle = { max = 50 }\n";
        let orthoglide = "[mechanism]\nkind = \"orthoglide\"\nleg_length = \"sqrt(2)\"\n";
        assert_eq!(agree(&format!("{orthoglide}{workspace}{require}")), 512);
        let short = orthoglide.replace("sqrt(2)", "0.9");
        let found = agree(&format!("{short}{workspace}{require}"));
        assert!((200..512).contains(&found), "{found}");
    }
}
