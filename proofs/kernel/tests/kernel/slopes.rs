//! Slopes: `f(x) = f(c) + sum_k S_k lambda_k` with the `S_k` enclosed, for random formulas; gradients.

use crate::arithmetic::Random;
use crate::rough::Rough;
use num_bigint::BigInt;
use orthocert_kernel::arithmetic::Arithmetic;
use orthocert_kernel::cell::{Cell, Vertex};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{coordinates, Formula, Op, Tape, Values};
use orthocert_kernel::machine::{arm, Joint};
use orthocert_kernel::slope::{evaluate, Slope, Slopes};

const BITS: u32 = 40;

/// A tape of random operations in three coordinates.
fn tape(random: &mut Random) -> (Tape, Formula) {
    let mut tape = Tape::default();
    let mut pool: Vec<Formula> = (0..3).map(|k| tape.coordinate(k)).collect();
    pool.push(tape.integer(2));
    for _ in 0..9 {
        let mut pick = || pool[random.below(pool.len() as u64) as usize];
        let (a, b) = (pick(), pick());
        let next = match random.below(9) {
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
            7 => {
                // An elbow: 2 |w| > 2 > q.
                let [one, squares] = [tape.integer(1), tape.sqr(b)];
                let weight = tape.add(squares, one);
                let (part, rest) = (tape.div(b, weight), tape.sqr(weight));
                let along = tape.sqr(a);
                let sum = tape.add(along, rest);
                let t = tape.add(sum, part);
                tape.elbow([a, weight, t])[random.below(2) as usize]
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

/// The values at a point, enclosed with many bits.
fn values(tape: &Tape, x: &[BigInt], parameters: &[BigInt]) -> Values<Interval<BigInt>> {
    let fine = Fixed::<BigInt>::new(BITS + 60);
    tape.run(
        &fine,
        |k| Some(Interval::point(&x[k] << 60)),
        |j| Some(Interval::point(&parameters[j] << 60)),
    )
}

/// A formula over a cell.
type Sloped<'a> = (Formula, &'a Slope<Interval<BigInt>>);

/// At some points of a cell, corners among them, these formulas are in their ranges, and `f(x)` is in
/// `f(c) + [S] lambda`. How many points that were.
fn hold(
    random: &mut Random,
    edges: &[[Interval<BigInt>; 3]],
    parameters: &[BigInt],
    (tape, formulas): (&Tape, &[Sloped<'_>]),
) -> usize {
    let fine = Fixed::<BigInt>::new(BITS + 60);
    let mut tested = 0;
    for _ in 0..10 {
        // lambda in multiples of 1/8.
        let x: Vec<BigInt> = edges
            .iter()
            .map(|[c, _, h]| &c.lo + (&h.lo * (random.below(17) as i64 - 8)) / 8)
            .collect();
        if !x.iter().zip(edges).all(|(x, [_, r, _])| r.lo <= *x && *x <= r.hi) {
            continue;
        }
        let at = values(tape, &x, parameters);
        for &(f, slope) in formulas {
            let at = at.of(f).expect("defined on the cell");
            let wide = |i: &Interval<BigInt>| Interval { lo: &i.lo << 60, hi: &i.hi << 60 };
            let range = wide(&slope.range);
            assert!(range.lo <= at.hi && at.lo <= range.hi, "range");
            let mut sum = wide(&slope.at_centre);
            for ((s, x), [c, _, h]) in slope.slopes.iter().zip(&x).zip(edges) {
                let part =
                    Interval::point(((x - &c.lo) << (BITS + 60)) / h.lo.clone().max(1.into()));
                let slack = Interval { lo: (-1).into(), hi: 1.into() };
                let part = fine.add(&part, &slack).expect("sum");
                sum = fine.add(&sum, &fine.mul(&wide(s), &part).expect("product")).expect("sum");
            }
            assert!(sum.lo <= at.hi && at.lo <= sum.hi, "slopes");
        }
        tested += 1;
    }
    tested
}

/// About a centre, this wide.
fn edge(centre: f64, half: f64) -> Interval<BigInt> {
    Interval { lo: scaled(centre - half), hi: scaled(centre + half) }
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
            edge(centre, 0.5 / (1u64 << random.below(8)) as f64)
        };
        let cell = Cell(vec![edge(), edge(), edge()]);
        let edges = cell.edges().expect("edges");
        let values = evaluate(&tape, &[], Slopes::new(&fixed, 3), &edges);
        let Some(slope) = values.of(f) else { continue };
        tested += hold(&mut random, &edges, &[], (&tape, &[(f, slope)]));
    }
    assert!(tested > 2_000, "{tested}");
}

/// Arms in every direction, of both modes, exact and within tolerances, folded, stretched or nearly so: the
/// leg's vector, `D` and the angle.
#[test]
fn slopes_of_arms_hold_up_to_the_stretched_pose() {
    let mut random = Random(13);
    let fixed = Fixed::<BigInt>::new(BITS);
    let (mut tested, mut beyond) = (0, 0);
    for n in 0..1_500 {
        let mut number =
            |lo: f64, hi: f64| lo + (hi - lo) * random.below(1 << 20) as f64 / 1048576.0;
        let mode = if n % 2 == 0 { 1 } else { -1 };
        // Of the arm's angle, and of the leg from there: nearly along the arm, one way or the other.
        let (angle, [r, length]) = (number(-3.2, 3.2), [number(0.3, 0.9), number(0.4, 0.9)]);
        let near = 1.0 / f64::from(1u32 << number(0.0, 6.0) as u32);
        let half = 0.05 * near * near;
        let turn =
            angle + mode as f64 * near * number(0.2, 1.0) + if n % 3 == 0 { 3.2 } else { 0.0 };
        let height = length * number(-0.6, 0.6);
        let flat = (length * length - height * height).sqrt();
        // About the axis z of the machine, turned about x.
        let tilt = number(-3.2, 3.2);
        let turned = |[x, y, z]: [f64; 3]| {
            [x, y * tilt.cos() - z * tilt.sin(), y * tilt.sin() + z * tilt.cos()]
        };
        let [k, e] = [turned([0.0, 0.0, 1.0]), turned([1.0, 0.0, 0.0])];
        let w = turned([
            r * angle.cos() + flat * turn.cos(),
            r * angle.sin() + flat * turn.sin(),
            height,
        ]);
        let mut tape = Tape::default();
        let position = [0, 1, 2].map(|k| tape.coordinate(k));
        let [axis, zero] = [0, 3].map(|at| [0, 1, 2].map(|j| tape.parameter(at + j)));
        let [axis, zero] = [axis, zero].map(|u| tape.normalised(&u));
        let lengths = [6, 7].map(|j| tape.parameter(j));
        let leg = arm(&mut tape, &position, [&axis, &zero], lengths, mode);
        let Some(Joint::Angle { cos, sin }) = leg.rho else { panic!("an angle") };
        // Directions are used as they are, whether they are orthogonal or not.
        let wide = if n % 4 == 0 { 1.0 / f64::from(1u32 << number(4.0, 16.0) as u32) } else { 0.0 };
        let of = [k[0], k[1], k[2], e[0], e[1], e[2], r, length];
        let enclosed = of.map(|x| edge(x, wide));
        let cell = Cell(w.iter().map(|&x| edge(x, half * number(0.0, 1.0))).collect());
        let theta = of.map(|x| scaled(x + wide * number(-1.0, 1.0)));
        let edges = cell.edges().expect("edges");
        let found = evaluate(&tape, &enclosed, Slopes::new(&fixed, 3), &edges);
        let formulas: Vec<_> = leg.row.a.iter().chain([&leg.row.d, &cos, &sin]).collect();
        let slopes: Option<Vec<_>> = formulas.iter().map(|&&f| Some((f, found.of(f)?))).collect();
        let Some(slopes) = slopes else {
            beyond += 1;
            continue;
        };
        tested += hold(&mut random, &edges, &theta, (&tape, &slopes));
    }
    assert!(tested > 4_000 && beyond > 50, "{tested} {beyond}");
}

#[test]
fn an_elbow_is_where_two_circles_cross() {
    let fixed = Fixed::<i64>::new(30);
    let of = |[a, b, t]: [i64; 3], half: i64| {
        let mut tape = Tape::default();
        let parts = [0, 1, 2].map(|k| tape.coordinate(k));
        let both = tape.elbow(parts);
        let about = |x: i64| Interval { lo: (x << 26) - half, hi: (x << 26) + half };
        let edges = Cell([a, b, t].map(about).to_vec()).edges().expect("edges");
        let values = evaluate(&tape, &[], Slopes::new(&fixed, 3), &edges);
        both.map(|f| values.of(f).map(|slope| slope.range.clone()))
    };
    // In sixteenths: (1, 1) and 1 cross in (1, 0), on the right of (1, 1), and in (0, 1).
    let [c, s] = of([16, 16, 16], 0).map(|x| x.expect("crosses"));
    assert!((c.lo - (1 << 30)).abs() < 16 && s.lo.abs() < 16, "{c:?} {s:?}");
    // (2, 0) and 1 touch; 2 and 1/4 do not meet; 2 and 10 neither; a centre at 0 has no direction.
    for none in [[32, 0, 16], [32, 0, 4], [32, 0, 160], [0, 0, 16]] {
        assert!(of(none, 0).iter().all(Option::is_none), "{none:?}");
    }
    // Some of a cell do not.
    assert!(of([31, 0, 16], 1 << 20).iter().all(Option::is_some));
    assert!(of([31, 0, 16], 1 << 27).iter().all(Option::is_none));
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
    let v = Vertex::all(2).nth(2).expect("(-1, 1)");
    let corner = slopes.at(slope, v).expect("value");
    assert!(corner.lo <= 3 * one && 3 * one <= corner.hi);
}

#[test]
fn gradients_are_derivatives() {
    let mut random = Random(11);
    for _ in 0..300 {
        let (mut tape, f) = tape(&mut random);
        let gradient = tape.gradient(f, &coordinates(3));
        let x = [0; 3].map(|_: i64| random.below(100) as f64 / 50.0 - 1.0);
        let at = |x: [f64; 3]| tape.run(&Rough, |k| Some((x[k], x[k])), |_| None);
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
