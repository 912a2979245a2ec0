//! Directions apart: where several are worst at once, evidence for those of each wedge.

use super::apart::{in_integers, times, Stretched};
use super::doubles::Pair;
use super::evidence::{next_to, Over};
use super::rows::{exponent, Form};
use nalgebra::DVector;
use orthocert_kernel::certificate::{Evidence, Part};
use orthocert_kernel::formula::Formula;
use orthocert_kernel::machine::Leg;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::{self, Half, Row, Wedge};
use std::f64::consts::PI;

/// Wedges to begin with, and how often one is halved where it fails.
const WEDGES: usize = 8;
const HALVINGS: u32 = 2;
/// Greatest components of the directions between wedges.
const FINE: f64 = 64.0;
/// Greatest components of directions of tolerances, within a wedge.
const LENGTHS: [f64; 2] = [8.0, 64.0];
/// Parts of what tolerances change, of which so much is taken of what says that a direction is in a wedge.
const TAKEN: [f64; 2] = [8.0, 2.0];
/// Bits of `mu`, and where it is tried between what both bounds allow.
pub(super) const BITS: i32 = 24;
const PARTS: [f64; 3] = [0.5, 0.3, 0.7];

impl Over<'_> {
    /// Evidence with directions apart, where tolerances fail next to the worst vertex already, so that
    /// no smaller cell is of use.
    pub(super) fn with_directions_apart(&self, test: &Test) -> Option<Evidence> {
        self.problem().derived.as_ref()?;
        let most = match test {
            Test::SigmaMin(_) | Test::Least(..) => false,
            Test::SigmaMax(_) | Test::Greatest(..) => true,
            Test::Conditioning(_) => self.formulas.half.is_some_and(|half| half.upper.is_some()),
            _ => return None,
        };
        let together = self.together(test, most);
        if together.is_some() {
            return together;
        }
        let found = self.there(test, |there| there.most_stretched(test, most));
        let found = found.or_else(|| self.most_stretched(test, most))?;
        if self.holds_next_to(test, &found.place) {
            return None;
        }
        match test {
            Test::Conditioning(c) if self.formulas.half.is_none() => {
                self.with_mu_of_each(test, *c).or_else(|| self.between(test, *c))
            }
            _ => self.fan(test, &found),
        }
    }

    /// Both bounds of a condition number by themselves; none where, to first order, no one `mu` is between those of all machines.
    fn between(&self, test: &Test, c_squared: Formula) -> Option<Evidence> {
        self.left_of(test).filter(|[left, lost]| left + lost > 0.0)?;
        PARTS.into_iter().find_map(|part| {
            let mu = self.mu(self.centre(c_squared)?, Form::Plain, part)?;
            let places = u32::try_from(BITS - exponent(mu[0])).ok()?;
            let scale = f64::from(places).exp2();
            let mu: Vec<i64> = mu.iter().map(|mu| (mu * scale).round() as i64).collect();
            let half = |upper| {
                let half = Some(Half { mu: (&mu, places), weights: &[], upper });
                let formulas = test::Over { half, inside: None, ..*self.formulas };
                Over { formulas: &formulas, ..*self }.evidence_of(test, true)
            };
            let (lower, upper) = (half(None)?, half(Some(c_squared))?);
            Some(Evidence::Between(mu, places, Vec::new(), Box::new(lower), Box::new(upper)))
        })
    }

    pub(super) fn most_stretched(&self, test: &Test, most: bool) -> Option<Stretched> {
        let legs = self.problem().legs.iter();
        let scaled = |leg: &Leg| leg.scaled.clone().filter(|_| self.formulas.controls.is_some());
        let own = |leg: &Leg| scaled(leg).unwrap_or_else(|| leg.row.clone());
        let rows: Vec<Row<Formula>> = match test {
            Test::Least(rows, _) | Test::Greatest(rows, _) => rows.clone(),
            _ => legs.map(own).collect(),
        };
        self.stretched_all(rows, most)
    }

    /// Whether a test holds so next to a place of the box without directions apart.
    fn holds_next_to(&self, test: &Test, place: &[f64]) -> bool {
        let edge = |(&[_, (lo, hi), _], at): (&[Pair; 3], &f64)| {
            next_to(0.5 * (lo + hi) + 0.5 * at * (hi - lo), (lo, hi))
        };
        let cell = self.formulas.place.edges.iter().zip(place).map(edge).collect();
        self.prover.on(&cell, |over| {
            let half = self.formulas.half;
            let formulas = test::Over { half, inside: None, ..*over.formulas };
            Over { formulas: &formulas, ..*over }.evidence(test).is_some()
        })
    }

    /// One wedge of all directions, in coordinates along the worst one, then as many as it takes in
    /// the plane of the two worst.
    fn fan(&self, test: &Test, found: &Stretched) -> Option<Evidence> {
        let worst = found.directions.first()?;
        let c = in_integers(worst, FINE);
        let one = self.wedge(test, found, worst.clone(), ([&c, &c], &[0.0]));
        if let Some((n, places, evidence)) = one {
            return Some(Evidence::Fan(vec![Part(c, n, places, evidence)]));
        }
        let plane = [worst, found.directions.get(1)?];
        let mut parts = Vec::new();
        let at = |i: usize| PI * i as f64 / WEDGES as f64;
        let first = across(plane, 0.0);
        let mut from = first.clone();
        for i in 0..WEDGES {
            let to = match i + 1 {
                WEDGES => first.iter().map(|x| -x).collect(),
                next => across(plane, at(next)),
            };
            self.wedges(test, found, plane, ([at(i), at(i + 1)], [from, to.clone()]), &mut parts)?;
            from = to;
        }
        Some(Evidence::Fan(parts))
    }

    /// The parts between two directions, by their angles.
    fn wedges(
        &self,
        test: &Test,
        found: &Stretched,
        plane: [&DVector<f64>; 2],
        ([low, high], [from, to]): ([f64; 2], [Vec<i64>; 2]),
        parts: &mut Vec<Part>,
    ) -> Option<()> {
        let middle = 0.5 * (low + high);
        let w = plane[0] * middle.cos() + plane[1] * middle.sin();
        if let Some((n, places, by)) = self.wedge(test, found, w, ([&from, &to], &TAKEN)) {
            parts.push(Part(from, n, places, by));
            return Some(());
        }
        let narrow = PI / WEDGES as f64 * f64::from(1 - HALVINGS as i32).exp2();
        if high - low < narrow {
            return None;
        }
        let between = across(plane, middle);
        self.wedges(test, found, plane, ([low, middle], [from, between.clone()]), parts)?;
        self.wedges(test, found, plane, ([middle, high], [between, to]), parts)
    }

    /// Evidence for one wedge, with as much of what says so as is wanted of it.
    fn wedge(
        &self,
        test: &Test,
        found: &Stretched,
        w: DVector<f64>,
        (between, taken): ([&[i64]; 2], &[f64]),
    ) -> Option<(i64, u32, Evidence)> {
        let worst = found.along(w);
        let changes: f64 = self.by_parameters(&worst, true)?.values().map(|x| x.abs()).sum();
        let ends = [self.worst_machine(&worst, true)?, self.middle_machine(true)];
        taken.iter().find_map(|taken| {
            let (n, places) = power(taken * changes / (FINE * FINE))?;
            let wedge = Some(Wedge { between, n, places });
            let formulas = test::Over { wedge, inside: None, ..*self.formulas };
            let over = Over { formulas: &formulas, ..*self };
            let from = |ends: &String| over.apart_from(test, &worst, (ends, &LENGTHS));
            let by = ends.iter().find_map(from).or_else(|| {
                let second = over.of_second_order(test)?;
                ends.iter().find_map(|ends| from(&over.to_second_order(ends, &second)))
            })?;
            Some((n, places, by))
        })
    }
}

/// Orthogonal to the direction at an angle of the plane, in it.
fn across([u, v]: [&DVector<f64>; 2], angle: f64) -> Vec<i64> {
    let c = v * angle.cos() - u * angle.sin();
    times(&c, FINE)
}

/// The power of two next to a number, or 0.
fn power(x: f64) -> Option<(i64, u32)> {
    if x <= 0.0 {
        return Some((0, 0));
    }
    let k = x.log2().round() as i32;
    let n = 1i64.checked_shl(k.max(0) as u32).filter(|n| *n > 0)?;
    let places = (-k).max(0) as u32;
    (places < test::MOST_PLACES).then_some((n, places))
}
