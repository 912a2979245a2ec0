//! Evidence that is not given: a test's own, which follows from the cell.
//!
//! Nothing rests on how it is found: the multiplier of a lower bound may be any ([`sigma_min`]), and so
//! may the direction along which a bound fails. Both are computed in integers, so that all who find
//! them find the same.
//!
//! With `A`, `D` at the cell's centre:
//!
//! | test                  | own evidence                                                      |
//! |-----------------------|-------------------------------------------------------------------|
//! | `SigmaMin`, `Least`   | `Y_i = A_i/D_i`: to second order in the cell's size nothing is lost |
//! | `Solve`               | `Y = A`                                                           |
//! | `Beyond`              | the sign at the centre                                            |
//! | `Conditioning`, `OneToOne`, `Accuracy`, `Apart` | none                                    |
//! | others                | none is needed                                                    |
//!
//! [`sigma_min`]: crate::test::Over::sigma_min

use super::Checker;
use crate::arithmetic::Enclosure;
use crate::certificate::{Evidence, Failure};
use crate::definite::Triangle;
use crate::formula::{Formula, Op, Values};
use crate::problem::Problem;
use crate::quantity::Test;
use crate::slope::{Slope, Slopes};
use crate::test::{width, Multiplier, Over, Row};
use crate::witness::fails_throughout;

/// Binary places of an own multiplier.
const PLACES: u32 = 20;
/// Bits of the greatest entry of a matrix whose direction is found.
const BITS: u32 = 28;
/// Bits of the greatest component of an own direction.
const DIRECTION: u32 = 8;
/// Squarings of a matrix: its `2^SQUARINGS`-th power has the direction.
const SQUARINGS: u32 = 7;

type Square = [[i64; 3]; 3];

/// The entries of a tape of which own evidence is made, and own failures; none where that is all of them.
pub(super) fn needed(problem: &Problem) -> Option<Vec<bool>> {
    let mut formulas = problem.partial.clone();
    formulas.extend(problem.legs.iter().filter_map(|leg| leg.length));
    let own: Vec<Row<Formula>> = problem.legs.iter().map(|leg| leg.row.clone()).collect();
    for obligation in &problem.obligations {
        formulas.extend(match &obligation.test {
            Test::SigmaMin(f) | Test::SigmaMax(f) | Test::Conditioning(f) => Some(*f),
            Test::Solve(solve) => Some(solve.square),
            Test::OneToOne(_) | Test::Accuracy(_) | Test::Apart(_) | Test::Curvature(_) => {
                return None
            }
            Test::Least(..) | Test::Greatest(..) | Test::AtLeast(_) | Test::Beyond(..) => None,
        });
        formulas.extend(obligation.test.rows(&own).concat());
    }
    Some(problem.tape.parts(&formulas))
}

impl<E: Enclosure> Checker<'_, E> {
    /// The formulas over a cell that own evidence, and own failures, are made of.
    pub fn evaluate_own(&self, edges: &[[E::Number; 3]]) -> Values<Slope<E::Number>> {
        self.values(self.needed.as_deref(), edges)
    }

    /// Whether a test holds on a cell by its own evidence.
    pub fn shows_own(&self, over: &Over<'_, E>, test: &Test) -> bool {
        let own = || {
            Some(match test {
                Test::SigmaMin(kappa) => {
                    let y = self.own_multiplier(over, &self.rows)?;
                    match self.problem.tape.op(*kappa) {
                        Op::Integer(0) => Evidence::Rank(y),
                        _ => Evidence::Lower(y),
                    }
                }
                Test::Least(rows, _) => Evidence::Lower(self.own_multiplier(over, rows)?),
                Test::Solve(_) => {
                    let entry =
                        |f: &Formula| self.arithmetic.rounded(&over.of(*f)?.at_centre, PLACES);
                    let rows = self.rows.iter().map(|row| row.a.iter().map(entry).collect());
                    let y = rows.collect::<Option<_>>()?;
                    Evidence::Lower(Multiplier { y, places: PLACES })
                }
                Test::Beyond(f, _) => {
                    match self.arithmetic.is_nonnegative(&over.of(*f)?.at_centre) {
                        true => Evidence::Test,
                        false => Evidence::Negative,
                    }
                }
                Test::Conditioning(_) | Test::OneToOne(_) | Test::Accuracy(_) | Test::Apart(_) => {
                    return None
                }
                Test::SigmaMax(_) | Test::Greatest(..) | Test::AtLeast(_) | Test::Curvature(_) => {
                    Evidence::Test
                }
            })
        };
        own().is_some_and(|evidence| self.shows(over, test, &evidence))
    }

    fn own_multiplier(&self, over: &Over<'_, E>, rows: &[Row<Formula>]) -> Option<Multiplier> {
        let e = self.arithmetic;
        let one = e.integer(1)?;
        let row = |row: &Row<Formula>| {
            let d = &over.of(row.d)?.at_centre;
            if !e.is_positive(d) {
                return None;
            }
            let entry =
                |f: &Formula| e.rounded(&e.ratio(&over.of(*f)?.at_centre, &one, d)?, PLACES);
            row.a.iter().map(entry).collect()
        };
        let y = rows.iter().map(row).collect::<Option<_>>()?;
        Some(Multiplier { y, places: PLACES })
    }

    /// Whether an obligation fails so in its own directions: of singular values those of the centre; or,
    /// of the greatest one, in the row of a leg.
    pub fn fails_own(
        &self,
        slopes: Slopes<'_, E>,
        values: &Values<Slope<E::Number>>,
        number: usize,
    ) -> bool {
        let Some(obligation) = self.problem.obligations.get(number) else { return false };
        let rows = obligation.test.others().unwrap_or(&self.rows);
        let direction = |greatest| self.direction(values, rows, greatest);
        let directions = || {
            Some(match &obligation.test {
                Test::SigmaMin(_) | Test::Least(..) => vec![direction(false)?],
                Test::SigmaMax(_) | Test::Greatest(..) => vec![direction(true)?],
                Test::Conditioning(_) => vec![direction(true)?, direction(false)?],
                Test::AtLeast(_) | Test::Beyond(..) => Vec::new(),
                Test::OneToOne(_)
                | Test::Solve(_)
                | Test::Accuracy(_)
                | Test::Apart(_)
                | Test::Curvature(_) => return None,
            })
        };
        let fails = |failure| fails_throughout(self.problem, slopes, values, &failure);
        let mut legs = match obligation.test {
            Test::SigmaMax(_) => 0..self.rows.len(),
            _ => 0..0,
        };
        directions().is_some_and(|directions| fails(Failure::Obligation(number, directions)))
            || legs.any(|leg| fails(Failure::Row(number, leg)))
    }

    /// Nearly the direction that `M` at the centre stretches most, or least: of `G = M^T M`, or of its
    /// adjugate, a high power, of which every column is nearly an eigenvector.
    fn direction(
        &self,
        values: &Values<Slope<E::Number>>,
        rows: &[Row<Formula>],
        greatest: bool,
    ) -> Option<Vec<i64>> {
        let (e, m) = (self.arithmetic, width(rows));
        let at = |f: &Formula| values.of(*f).map(|slope| &slope.at_centre);
        let entry = |j: usize, k: usize| {
            e.sum(rows.iter().map(|row| {
                let d = at(&row.d).filter(|d| e.is_positive(d))?;
                e.ratio(at(row.a.get(j)?)?, at(row.a.get(k)?)?, d)
            }))
        };
        let whole = Triangle::new(m, entry)?;
        let [_, most] = e.ends(&e.sum((0..m).map(|j| whole.row(j).first().cloned()))?);
        let unit = e.recip(&most)?;
        let mut g: Square = [[0; 3]; 3];
        for j in 0..m {
            for (entry, k) in whole.row(j).iter().zip(j..) {
                let x = e.rounded(&e.mul(entry, &unit)?, BITS)?;
                (*g.get_mut(j)?.get_mut(k)?, *g.get_mut(k)?.get_mut(j)?) = (x, x);
            }
        }
        let g = if greatest { g } else { adjugate(g, m) };
        dominant(g, m)
    }
}

/// The adjugate of the first `m` rows and columns, which is that of the matrix with 1 on the rest of the diagonal.
fn adjugate(mut g: Square, m: usize) -> Square {
    (m..3).for_each(|k| g[k][k] = 1);
    let entry = |i: usize, j: usize| {
        let [a, b, c, d] = [(j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3];
        g[a][c] * g[b][d] - g[a][d] * g[b][c]
    };
    let mut of: Square = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    (m..3).for_each(|k| of[k][k] = 0);
    of
}

/// The matrix times a power of two such that its greatest entry has so many bits.
fn sized(mut g: Square, bits: u32) -> Option<Square> {
    let most = g.iter().flatten().map(|x| x.unsigned_abs()).max().filter(|&most| most > 0)?;
    let own = u64::BITS - most.leading_zeros();
    let fit = |x: i64| if own > bits { x >> (own - bits) } else { x << (bits - own) };
    g.iter_mut().flatten().for_each(|x| *x = fit(*x));
    Some(g)
}

/// The longest column of a high power of a matrix with entries of at most `2^BITS`, or `2^57`: sums of
/// three products of entries of `BITS` bits are below `2^(2 BITS + 2) = 2^58`.
fn dominant(g: Square, m: usize) -> Option<Vec<i64>> {
    let mut g = sized(g, BITS)?;
    for _ in 0..SQUARINGS {
        let entry = |i: usize, j: usize| (0..3).map(|k| g[i][k] * g[k][j]).sum();
        g = sized(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))), BITS)?;
    }
    let column = (0..3).max_by_key(|&k| g[k][k])?;
    let half = 1 << (BITS - DIRECTION - 1);
    Some(g.iter().take(m).map(|row| (row[column] + half) >> (BITS - DIRECTION)).collect())
}
