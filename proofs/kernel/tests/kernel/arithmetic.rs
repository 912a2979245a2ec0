//! Intervals contain what they should; words give what integers of any size give.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::definite::{is_positive_definite, Triangle};
use orthocert_kernel::fixed::{Fixed, Interval};

/// Numbers from a fixed seed (xorshift), biased to ends, zeros and ones.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// An integer of at most so many bits.
    pub fn integer(&mut self, bits: u64) -> i64 {
        match self.below(8) {
            0 => 0,
            1 => 1,
            2 => -1,
            _ => (self.next() as i64) >> (64 - bits + self.below(bits)),
        }
    }

    fn interval(&mut self, bits: u64) -> Interval<i64> {
        let (a, b) = (self.integer(bits), self.integer(bits));
        match self.below(4) {
            0 => Interval::point(a),
            _ => Interval { lo: a.min(b), hi: a.max(b) },
        }
    }
}

fn big(x: &Interval<i64>) -> Interval<BigInt> {
    Interval { lo: x.lo.into(), hi: x.hi.into() }
}

const BITS: u32 = 20;

fn rational(n: &BigInt) -> BigRational {
    BigRational::new(n.clone(), BigInt::from(1) << BITS)
}

fn contains(x: &Interval<BigInt>, value: &BigRational) -> bool {
    rational(&x.lo) <= *value && *value <= rational(&x.hi)
}

/// Some numbers of an interval: its ends, and one between.
fn samples(x: &Interval<BigInt>) -> [BigRational; 3] {
    let (lo, hi) = (rational(&x.lo), rational(&x.hi));
    let between =
        (&lo * BigRational::from_integer(2.into()) + &hi) / BigRational::from_integer(3.into());
    [lo, between, hi]
}

#[test]
fn every_operation_contains_and_words_agree() {
    let (words, integers) = (Fixed::<i64>::new(BITS), Fixed::<BigInt>::new(BITS));
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..20_000 {
        let bits = 8 + random.below(34);
        let (a, b) = (random.interval(bits), random.interval(bits));
        let (p, q) = (big(&a), big(&b));
        type Op<N> = (&'static str, Option<N>);
        let word: [Op<Interval<i64>>; 7] = [
            ("add", words.add(&a, &b)),
            ("sub", words.sub(&a, &b)),
            ("mul", words.mul(&a, &b)),
            ("div", words.div(&a, &b)),
            ("sqr", words.sqr(&a)),
            ("sqrt", words.sqrt(&a)),
            ("ratio", words.ratio(&a, &b, &Interval { lo: 3, hi: 77 })),
        ];
        let wide: [Op<Interval<BigInt>>; 7] = [
            ("add", integers.add(&p, &q)),
            ("sub", integers.sub(&p, &q)),
            ("mul", integers.mul(&p, &q)),
            ("div", integers.div(&p, &q)),
            ("sqr", integers.sqr(&p)),
            ("sqrt", integers.sqrt(&p)),
            ("ratio", integers.ratio(&p, &q, &Interval { lo: 3.into(), hi: 77.into() })),
        ];
        for ((name, word), (_, wide)) in word.iter().zip(&wide) {
            if let Some(word) = word {
                assert_eq!(Some(big(word)), *wide, "{name} {a:?} {b:?}");
            }
            let Some(wide) = wide else { continue };
            for x in samples(&p) {
                for y in samples(&q) {
                    let zero = BigRational::from_integer(0.into());
                    let value = match *name {
                        "add" => &x + &y,
                        "sub" => &x - &y,
                        "mul" => &x * &y,
                        "div" if y != zero => &x / &y,
                        "sqr" => &x * &x,
                        "ratio" => &x * &y / rational(&BigInt::from(3)),
                        "sqrt" => {
                            // The root's square brackets the number.
                            let (lo, hi) = (rational(&wide.lo), rational(&wide.hi));
                            assert!(&lo * &lo <= x || x < rational(&p.lo), "{a:?}");
                            assert!(x <= &hi * &hi, "{a:?}");
                            continue;
                        }
                        _ => continue,
                    };
                    assert!(contains(wide, &value), "{name} {a:?} {b:?}");
                }
            }
        }
    }
}

#[test]
fn what_is_undefined_has_no_value() {
    let fixed = Fixed::<i64>::new(BITS);
    let interval = |lo, hi| Interval { lo, hi };
    assert_eq!(fixed.recip(&interval(-1, 1)), None);
    assert_eq!(fixed.recip(&interval(0, 1)), None);
    assert_eq!(fixed.recip(&interval(-1, 0)), None);
    assert_eq!(fixed.sqrt(&interval(0, 5)), None, "no slope at zero");
    assert_eq!(fixed.sqrt(&interval(-1, 5)), None);
    assert_eq!(fixed.ratio(&interval(1, 1), &interval(1, 1), &interval(0, 1)), None);
    assert_eq!(fixed.add(&interval(i64::MAX, i64::MAX), &interval(1, 1)), None);
    assert_eq!(fixed.neg(&interval(i64::MIN, 0)), None);
    // An empty intersection is no value.
    let point = interval(0, 0);
    assert_eq!(fixed.within(&interval(5, 9), &point, &[interval(-1, 4)]), None);
    assert_eq!(fixed.within(&interval(4, 9), &point, &[interval(-1, 4)]), Some(interval(4, 4)));
}

/// The leading principal minors of a symmetric matrix of doubles are positive.
fn by_minors(t: &[[f64; 3]; 3]) -> bool {
    let second = t[0][0] * t[1][1] - t[0][1] * t[0][1];
    let third = t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[1][2])
        - t[0][1] * (t[0][1] * t[2][2] - t[1][2] * t[0][2])
        + t[0][2] * (t[0][1] * t[1][2] - t[1][1] * t[0][2]);
    t[0][0] > 0.0 && second > 0.0 && third > 0.0
}

#[test]
fn interval_matrices_are_definite_only_if_all_their_matrices_are() {
    let fixed = Fixed::<i64>::new(BITS);
    let mut random = Random(42);
    let (mut accepted, mut points) = (0, 0);
    for _ in 0..20_000 {
        let spread = 1i64 << random.below(20);
        let mut entry = |diagonal: bool| {
            let middle = random.integer(22) / 2 + if diagonal { 1 << 21 } else { 0 };
            Interval { lo: middle - spread, hi: middle + spread }
        };
        let t = vec![
            vec![entry(true), entry(false), entry(false)],
            vec![entry(true), entry(false)],
            vec![entry(true)],
        ];
        let matrix = Triangle::new(3, |i, j| Some(t[i][j - i].clone())).unwrap();
        let claimed = is_positive_definite(&fixed, &matrix);
        accepted += usize::from(claimed);
        for _ in 0..20 {
            let mut of = |x: &Interval<i64>| {
                let t = random.below(5) as f64 / 4.0;
                (x.lo as f64 + t * (x.hi - x.lo) as f64) / f64::from(BITS).exp2()
            };
            let mut m = [[0.0; 3]; 3];
            for (i, row) in t.iter().enumerate() {
                for (j, x) in (i..).zip(row) {
                    m[i][j] = of(x);
                    m[j][i] = m[i][j];
                }
            }
            assert!(!claimed || by_minors(&m), "{t:?}");
            points += usize::from(!claimed && spread == 1 && by_minors(&m));
        }
    }
    assert!(accepted > 2_000, "{accepted}");
    // Nearly every matrix that is a point, and definite, is accepted.
    assert!(points < 200, "{points}");
}

#[test]
fn dyadic_multiples_round_outward() {
    let fixed = Fixed::<i64>::new(BITS);
    let x = Interval { lo: -5, hi: 7 };
    assert_eq!(fixed.dyadic(3, 2, &x), Some(Interval { lo: -4, hi: 6 }));
    assert_eq!(fixed.dyadic(-3, 2, &x), Some(Interval { lo: -6, hi: 4 }));
    assert_eq!(fixed.halve(&x), Some(Interval { lo: -3, hi: 4 }));
    assert_eq!(BigInt::from(5).to_i64(), Some(5));
}
