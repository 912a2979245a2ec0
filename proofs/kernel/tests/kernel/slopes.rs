//! Slopes: `f(x) = f(c) + sum_k S_k lambda_k` with the `S_k` enclosed, for random formulas; gradients.

use crate::arithmetic::Random;
use crate::rough::Rough;
use num_bigint::BigInt;
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::cell::{evaluate, Cell, Vertex};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{coordinates, Formula, Op, Tape};
use orthocert_kernel::slope::Slopes;

const BITS: u32 = 40;

/// A tape of random operations in three coordinates.
fn tape(random: &mut Random) -> (Tape, Formula) {
    let mut tape = Tape::default();
    let mut pool: Vec<Formula> = (0..3).map(|k| tape.coordinate(k)).collect();
    pool.push(tape.integer(2));
    for _ in 0..9 {
        let mut pick = || pool[random.below(pool.len() as u64) as usize];
        let (a, b) = (pick(), pick());
        let next = match random.below(8) {
            0 | 1 => tape.add(a, b),
            2 => tape.sub(a, b),
            3 => tape.mul(a, b),
            4 => tape.sqr(a),
            5 => {
                // A root and a quotient that are defined near the origin.
                let square = tape.sqr(a);
                let one = tape.integer(1);
                let sum = tape.add(square, one);
                tape.sqrt(sum)
            }
            6 => {
                let square = tape.sqr(b);
                let one = tape.integer(1);
                let sum = tape.add(square, one);
                tape.div(a, sum)
            }
            _ => tape.neg(a),
        };
        pool.push(next);
    }
    let last = pool[pool.len() - 1];
    (tape, last)
}

fn scaled(x: f64) -> BigInt {
    BigInt::from((x * f64::from(BITS).exp2()).round() as i64)
}

/// The value at a point, enclosed with many bits.
fn value(tape: &Tape, f: Formula, x: &[BigInt]) -> Option<Interval<BigInt>> {
    let fine = Fixed::<BigInt>::new(BITS + 60);
    let values = tape.run(&fine, |op| match op {
        Op::Coordinate(k) => Some(Interval::point(&x[k] << 60)),
        _ => None,
    });
    values.of(f).cloned()
}

#[test]
fn slopes_and_ranges_hold_at_random_points_of_random_formulas() {
    let mut random = Random(7);
    let fixed = Fixed::<BigInt>::new(BITS);
    let mut tested = 0;
    for _ in 0..400 {
        let (tape, f) = tape(&mut random);
        let mut edge = || {
            let centre = random.below(100) as f64 / 50.0 - 1.0;
            let half = 0.5 / (1u64 << random.below(8)) as f64;
            Interval { lo: scaled(centre - half), hi: scaled(centre + half) }
        };
        let cell = Cell(vec![edge(), edge(), edge()]);
        let edges = cell.edges().expect("edges");
        let slopes = Slopes::new(&fixed, 3);
        let values = evaluate(&tape, &[], slopes, &edges);
        let Some(slope) = values.of(f) else { continue };
        for _ in 0..10 {
            // lambda in multiples of 1/8, corners among them.
            let lambda = [0; 3].map(|_: i64| random.below(17) as i64 - 8);
            let x: Vec<BigInt> =
                edges.iter().zip(lambda).map(|([c, _, h], t)| &c.lo + (&h.lo * t) / 8).collect();
            let within = |x: &BigInt, r: &Interval<BigInt>| r.lo <= *x && *x <= r.hi;
            if !x.iter().zip(&cell.0).all(|(x, r)| within(x, r)) {
                continue;
            }
            let at = value(&tape, f, &x).expect("defined on the cell");
            let low = &slope.range.lo << 60;
            let high = &slope.range.hi << 60;
            assert!(low <= at.hi && at.lo <= high, "range");
            // f(x) is within f(c) + [S] lambda.
            let fine = Fixed::<BigInt>::new(BITS + 60);
            let wide = |i: &Interval<BigInt>| Interval { lo: &i.lo << 60, hi: &i.hi << 60 };
            let mut sum = wide(&slope.at_centre);
            for ((s, x), [c, _, h]) in slope.slopes.iter().zip(&x).zip(&edges) {
                let part =
                    Interval::point(((x - &c.lo) << (BITS + 60)) / h.lo.clone().max(1.into()));
                let slack = Interval { lo: (-1).into(), hi: 1.into() };
                let part = fine.add(&part, &slack).expect("sum");
                sum = fine.add(&sum, &fine.mul(&wide(s), &part).expect("product")).expect("sum");
            }
            assert!(sum.lo <= at.hi && at.lo <= sum.hi, "slopes");
            tested += 1;
        }
    }
    assert!(tested > 2_000, "{tested}");
}

#[test]
fn slopes_of_two_identities_are_not_to_be_mixed() {
    // On u, v in [1, 3] about (2, 2): slopes (v, c) and (d, u) of uv; their intersection (2, 2) would
    // make the product affine, and 1 at (1, 3) instead of 3. The slopes here are the symmetric ones.
    let fixed = Fixed::<i64>::new(20);
    let one = 1i64 << 20;
    let cell = Cell(vec![Interval { lo: one, hi: 3 * one }; 2]);
    let mut tape = Tape::default();
    let (u, v) = (tape.coordinate(0), tape.coordinate(1));
    let product = tape.mul(u, v);
    let slopes = Slopes::new(&fixed, 2);
    let values = evaluate(&tape, &[], slopes, &cell.edges().expect("edges"));
    let slope = values.of(product).expect("defined");
    for s in &slope.slopes[..2] {
        assert!(s.lo < 2 * one && 2 * one < s.hi, "{s:?}");
    }
    let corner = Vertex::all(2).nth(2).expect("(-1, 1)").value(&slopes, slope).expect("value");
    assert!(corner.lo <= 3 * one && 3 * one <= corner.hi);
}

#[test]
fn gradients_are_derivatives() {
    let mut random = Random(11);
    for _ in 0..300 {
        let (mut tape, f) = tape(&mut random);
        let gradient = tape.gradient(f, &coordinates(3));
        let x = [0; 3].map(|_: i64| random.below(100) as f64 / 50.0 - 1.0);
        let at = |x: [f64; 3]| {
            tape.run(&Rough, |op| match op {
                Op::Coordinate(k) => Some((x[k], x[k])),
                _ => None,
            })
        };
        let values = at(x);
        let of = |f: Formula| values.of(f).expect("defined").0;
        let denominator = of(gradient.denominator);
        assert!(denominator != 0.0);
        for (k, &numerator) in gradient.numerators.iter().enumerate() {
            let step = |h: f64| {
                let mut y = x;
                y[k] += h;
                at(y).of(f).expect("defined").0
            };
            let h = 1e-5;
            let (found, expected) = (of(numerator) / denominator, (step(h) - step(-h)) / (2.0 * h));
            let size = 1.0 + expected.abs() + of(f).abs();
            assert!((found - expected).abs() < 1e-4 * size, "{found} {expected}");
        }
    }
}

#[test]
fn halves_cover_and_their_points_are_the_cells() {
    let mut cell = Cell(vec![Interval { lo: -7i64, hi: 8 }]);
    for step in 0..10 {
        let Some([lower, upper]) = cell.halves(0) else { break };
        assert_eq!((lower.0[0].lo, upper.0[0].hi), (cell.0[0].lo, cell.0[0].hi));
        assert_eq!(lower.0[0].hi, upper.0[0].lo);
        let [centre, _, half] = &lower.edges().expect("edges")[0];
        assert!(centre.lo - half.lo <= lower.0[0].lo && centre.lo + half.lo == lower.0[0].hi);
        cell = if step % 2 == 0 { upper } else { lower };
    }
    assert_eq!(Cell(vec![Interval { lo: 3i64, hi: 4 }]).halves(0), None);
    assert_eq!(cell.halves(1), None);
    let _ = Fixed::<i64>::new(3).integer(1);
}

#[test]
fn only_what_is_defined_everywhere_cancels() {
    let mut tape = Tape::default();
    let (x, y, zero) = (tape.coordinate(0), tape.coordinate(1), tape.integer(0));
    assert_eq!(tape.sub(x, x), zero);
    assert_ne!(tape.sub(x, y), zero);
    let one = tape.integer(1);
    let inverse = tape.div(one, x);
    let rest = tape.sub(inverse, inverse);
    assert_eq!(tape.op(rest), Op::Sub(inverse, inverse));
}
