//! Control points: they contain every polynomial of their form, and nothing else is taken for one.

use crate::arithmetic::Random;
use num_bigint::BigInt;
use orthocert_kernel::cell::Cell;
use orthocert_kernel::control::Control;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{Formula, Tape};

const BITS: u32 = 40;
const M: usize = 3;

/// Random operations in three coordinates and a parameter, of any form.
fn tape(random: &mut Random) -> (Tape, Vec<Formula>) {
    let mut tape = Tape::default();
    let mut pool: Vec<Formula> = (0..M).map(|k| tape.coordinate(k)).collect();
    for k in 0..M {
        let square = tape.sqr(pool[k]);
        pool.push(square);
    }
    pool.push(tape.parameter(0));
    pool.push(tape.integer(3));
    for _ in 0..12 {
        let mut pick = || pool[random.below(pool.len() as u64) as usize];
        let (a, b) = (pick(), pick());
        let next = match random.below(8) {
            0 | 1 => tape.add(a, b),
            2 => tape.sub(a, b),
            3..=5 => tape.mul(a, b),
            6 => tape.div(a, pool[6]),
            _ => tape.neg(a),
        };
        pool.push(next);
    }
    (tape, pool)
}

fn scaled(x: f64) -> BigInt {
    BigInt::from((x * f64::from(BITS).exp2()).round() as i64)
}

/// The value at a point, enclosed with many bits.
fn value(tape: &Tape, f: Formula, x: &[BigInt], parameter: &BigInt) -> Interval<BigInt> {
    let values = tape.run(
        &Fixed::<BigInt>::new(BITS + 60),
        |k| Some(Interval::point(&x[k] << 60)),
        |_| Some(Interval::point(parameter << 60)),
    );
    values.of(f).expect("defined").clone()
}

#[test]
fn values_lie_between_those_of_control_points_with_the_same_weights() {
    let mut random = Random(21);
    let fixed = Fixed::<BigInt>::new(BITS);
    let (mut tested, mut without) = (0, 0);
    for _ in 0..300 {
        let (tape, pool) = tape(&mut random);
        let control = Control::new(&tape, M, &pool);
        let of_form: Vec<Formula> = pool.iter().copied().filter(|&f| control.has(f)).collect();
        without += pool.len() - of_form.len();
        let mut edge = || {
            let low = random.below(100) as f64 / 50.0 - 1.0;
            // Cells of width zero too.
            let width = if random.below(8) == 0 { 0.0 } else { random.below(64) as f64 / 32.0 };
            Interval { lo: scaled(low), hi: scaled(low + width) }
        };
        let cell = Cell(vec![edge(), edge(), edge()]);
        let parameter = Interval { lo: scaled(1.5), hi: scaled(1.5625) };
        let edges = cell.edges().expect("edges");
        // Any combination of the formulas lies between its values at the control points.
        let factors: Vec<i64> = of_form.iter().map(|_| random.below(7) as i64 - 3).collect();
        let mut range: Option<[BigInt; 2]> = None;
        let controls = control.values(&fixed, std::slice::from_ref(&parameter), &edges);
        let controls = controls.expect("values");
        for j in 0..controls.len() {
            let mut sum = [BigInt::from(0), BigInt::from(0)];
            for (&f, &factor) in of_form.iter().zip(&factors) {
                let x = controls.at(f, j).expect("defined");
                let (lo, hi) = if factor < 0 { (&x.hi, &x.lo) } else { (&x.lo, &x.hi) };
                sum = [&sum[0] + lo * factor, &sum[1] + hi * factor];
            }
            for (k, cell) in cell.0.iter().enumerate().filter(|(_, cell)| cell.lo < cell.hi) {
                let at = &controls.at(pool[k], j).expect("a coordinate").lo;
                let twice: BigInt = at * 2 - &cell.lo - &cell.hi;
                let place = BigInt::from(controls.place(k, j).expect("nodes"));
                assert_eq!(twice, place * (&cell.hi - &cell.lo));
            }
            range = Some(match range.take() {
                None => sum,
                Some([lo, hi]) => [lo.min(sum[0].clone()), hi.max(sum[1].clone())],
            });
        }
        let [lo, hi] = range.expect("a point").map(|x| x << 60);
        for _ in 0..12 {
            let x: Vec<BigInt> =
                cell.0.iter().map(|r| &r.lo + (&r.hi - &r.lo) * random.below(17) / 16).collect();
            let p = &parameter.lo + (&parameter.hi - &parameter.lo) * random.below(5) / 4;
            let mut sum = [BigInt::from(0), BigInt::from(0)];
            for (&f, &factor) in of_form.iter().zip(&factors) {
                let at = value(&tape, f, &x, &p);
                let (a, b) = (&at.lo * factor, &at.hi * factor);
                sum = [&sum[0] + a.clone().min(b.clone()), &sum[1] + a.max(b)];
            }
            assert!(lo <= sum[1] && sum[0] <= hi);
            tested += 1;
        }
    }
    assert!(tested == 3_600 && without > 100, "{tested} {without}");
}

#[test]
fn formulas_that_have_not_the_form() {
    let mut tape = Tape::default();
    let [x, y] = [0, 1].map(|k| tape.coordinate(k));
    let (p, one) = (tape.parameter(0), tape.integer(1));
    let square = tape.sqr(x);
    let sum = tape.add(x, y);
    let other = tape.add(x, one);
    let product = tape.mul(x, y);
    let rows = [
        ("cube", tape.mul(x, square), false),
        ("product of one coordinate", tape.mul(x, other), false),
        ("product that shares one", tape.mul(product, x), false),
        ("fourth power", tape.sqr(square), false),
        ("square of a sum", tape.sqr(sum), false),
        ("quotient", tape.div(one, x), false),
        ("root", tape.sqrt(x), false),
        ("another coordinate", tape.coordinate(2), false),
        ("square", square, true),
        ("product", product, true),
        (
            "product of squares",
            {
                let other = tape.sqr(y);
                tape.mul(square, other)
            },
            true,
        ),
        (
            "constants",
            {
                let root = tape.sqrt(p);
                let other = tape.div(root, p);
                tape.mul(other, product)
            },
            true,
        ),
    ];
    for (what, formula, has) in rows {
        assert_eq!(Control::new(&tape, 2, &[formula]).has(formula), has, "{what}");
    }
    // One that has it is not spoilt by one that has not.
    let control = Control::new(&tape, 2, &[rows[0].1, product]);
    assert!(control.has(product) && !control.has(rows[0].1));
}

#[test]
fn the_middle_of_a_square_is_not_on_the_parabola() {
    // (x - 1/4)^2 - 1/32 is positive at 0, 1/2 and 1, and not at 1/4.
    let fixed = Fixed::<i64>::new(BITS);
    let mut tape = Tape::default();
    let x = tape.coordinate(0);
    let (square, two, small) = (tape.sqr(x), tape.integer(2), tape.integer(32));
    let half = tape.div(x, two);
    let one = tape.integer(1);
    let constant = tape.div(one, small);
    let f = tape.sub(square, half);
    let f = tape.add(f, constant);
    let one = 1i64 << BITS;
    let cell = Cell(vec![Interval { lo: 0, hi: one }]);
    let control = Control::new(&tape, 1, &[f]);
    let controls = control.values(&fixed, &[], &cell.edges().expect("edges")).expect("values");
    assert_eq!(controls.len(), 3);
    let values = [0, 1, 2].map(|j| controls.at(f, j).expect("defined"));
    assert!(values[0].lo > 0 && values[1].hi < 0 && values[2].lo > 0, "{values:?}");
}
