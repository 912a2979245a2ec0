//! Fixed-point intervals against exact rationals: containment, exactness where it is promised,
//! and no more than one unit in the last place of rounding.

use super::random::Random;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::fixed::Fixed;

/// Endpoints in units of `2^-bits` at which rounding and signs go wrong if they ever do.
fn adversarial(bits: u32) -> Vec<BigInt> {
    let one = BigInt::one() << bits;
    let near = |x: &BigInt| [x - 1u8, x.clone(), x + 1u8];
    let mut positive: Vec<BigInt> = vec![1u8.into(), 2u8.into(), 3u8.into()];
    for x in [&one / 3u8, one.clone(), &one * 4u8, &one * 9u8, BigInt::one() << (bits + 90)] {
        positive.extend(near(&x));
    }
    let negative: Vec<BigInt> = positive.iter().map(|x| -x).collect();
    [negative, vec![BigInt::zero()], positive].concat()
}

/// Intervals between adversarial endpoints, points among them.
fn intervals(random: &mut Random, bits: u32, count: usize) -> Vec<Fixed> {
    let ends = adversarial(bits);
    let mut all: Vec<Fixed> =
        ends.iter().map(|x| Fixed::new(x.clone(), x.clone(), bits).unwrap()).collect();
    while all.len() < count {
        let (a, b) = (random.pick(&ends), random.pick(&ends));
        all.extend(Fixed::new(a, b, bits));
    }
    all
}

fn ulp(bits: u32) -> BigRational {
    BigRational::new(BigInt::one(), BigInt::one() << bits)
}

/// `found` is `[least, greatest]` rounded outward by less than one unit at either end, and not at
/// all where the end is a multiple of the unit.
fn assert_tightest(found: &Fixed, least: &BigRational, greatest: &BigRational, what: &str) {
    let unit = ulp(found.bits());
    let down = (least / &unit).floor() * &unit;
    let up = (greatest / &unit).ceil() * &unit;
    assert_eq!((found.inf(), found.sup()), (down, up), "{what}");
}

fn extremes(values: &[BigRational]) -> (&BigRational, &BigRational) {
    (values.iter().min().unwrap(), values.iter().max().unwrap())
}

#[test]
fn sums_differences_and_products_are_the_tightest_possible() {
    let mut random = Random::new(20);
    for bits in [0, 1, 32, 64] {
        let all = intervals(&mut random, bits, 64);
        for (x, y) in all.iter().flat_map(|x| all.iter().map(move |y| (x, y))) {
            let ends = |z: &Fixed| [z.inf(), z.sup()];
            let what = format!("{x:?} {y:?}");
            let pairs = ends(x).into_iter().flat_map(|a| ends(y).map(|b| (a.clone(), b)));
            let pairs: Vec<_> = pairs.collect();
            let over = |f: fn(&BigRational, &BigRational) -> BigRational| -> Vec<BigRational> {
                pairs.iter().map(|(a, b)| f(a, b)).collect()
            };
            // Each is monotone in either argument, so the extremes are at the ends.
            for (found, values) in [
                (x.add(y), over(|a, b| a + b)),
                (x.sub(y), over(|a, b| a - b)),
                (x.mul(y), over(|a, b| a * b)),
            ] {
                let (least, greatest) = extremes(&values);
                assert_tightest(&found, least, greatest, &what);
            }
        }
    }
}

#[test]
fn squares_and_opposites_are_the_tightest_possible() {
    let mut random = Random::new(21);
    for bits in [0, 1, 32, 64, 200] {
        for x in intervals(&mut random, bits, 400) {
            let (a, b) = (x.inf(), x.sup());
            let squares = [&a * &a, &b * &b];
            let straddles = a.is_negative() && b.is_positive();
            let least = if straddles { BigRational::zero() } else { extremes(&squares).0.clone() };
            assert_tightest(&x.sqr(), &least, extremes(&squares).1, &format!("{x:?}"));
            assert_tightest(&x.neg(), &-b, &-a, &format!("{x:?}"));
        }
    }
}

#[test]
fn reciprocals_are_the_tightest_possible_and_refuse_zero() {
    let mut random = Random::new(22);
    let mut refused = 0;
    for bits in [1, 32, 64, 200] {
        for x in intervals(&mut random, bits, 400) {
            let holds_zero = !x.inf().is_positive() && !x.sup().is_negative();
            assert_eq!(x.recip().is_none(), holds_zero, "{x:?}");
            refused += i32::from(holds_zero);
            if let Some(found) = x.recip() {
                let (least, greatest) = (x.sup().recip(), x.inf().recip());
                assert_tightest(&found, &least, &greatest, &format!("{x:?}"));
                // Division is multiplication with it.
                let y = x.integer_like(3);
                assert_eq!(y.div(&x), Some(y.mul(&found)));
            }
        }
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn square_roots_are_the_tightest_possible_also_beside_perfect_squares() {
    let mut random = Random::new(23);
    for bits in [0, 1, 2, 7, 32, 64, 201] {
        let mut ends: Vec<BigInt> = adversarial(bits);
        for _ in 0..60 {
            // n^2 2^-bits is a square of a multiple of the unit for even shifts.
            let n = BigInt::from(random.word() >> random.within(0, 60));
            let square: BigInt = (&n * &n) >> bits;
            ends.extend([&square - 1u8, square.clone(), square + 1u8]);
        }
        for lo in &ends {
            let hi = lo + random.pick(&[0u32, 1, 1000]);
            let x = Fixed::new(lo.clone(), hi, bits).unwrap();
            assert_eq!(x.sqrt().is_none(), !lo.is_positive(), "{x:?}");
            let Some(root) = x.sqrt() else { continue };
            let unit = ulp(bits);
            let square = |y: &BigRational| y * y;
            let (low, high) = (root.inf(), root.sup());
            // low <= sqrt(inf) < low + ulp and high - ulp < sqrt(sup) <= high.
            assert!(square(&low) <= x.inf() && x.inf() < square(&(&low + &unit)), "{x:?}");
            assert!(x.sup() <= square(&high) && square(&(&high - &unit)) < x.sup(), "{x:?}");
        }
    }
}

#[test]
fn conversions_are_the_tightest_possible_for_every_shift() {
    let mut random = Random::new(24);
    let two = BigRational::from_integer(2.into());
    for bits in [0u32, 1, 32, 64] {
        for scale in [-200i64, -65, -64, -1, 0, 1, 63, 64, 200] {
            let shift = two.pow(i32::try_from(scale).unwrap());
            for _ in 0..40 {
                let denominator = random.pick(&[1, 3, 7, 1 << 20, 999_983]);
                let x = random.rational(-1000, 1000, denominator);
                let what = format!("{x} / 2^{scale} at {bits}");
                let value = &x / &shift;
                assert_tightest(&Fixed::rational(&x, scale, bits), &value, &value, &what);
            }
            for x in intervals(&mut random, 32, 60) {
                let found = x.rescale(scale, bits);
                let what = format!("{x:?} / 2^{scale} at {bits}");
                assert_tightest(&found, &(x.inf() / &shift), &(x.sup() / &shift), &what);
            }
        }
    }
}

#[test]
fn dyadic_numbers_are_exact_where_they_fit() {
    let one = Fixed::integer(1, 64);
    for (index, level) in [(0u128, 0u32), (1, 1), (5, 3), ((1 << 64) - 1, 64), (1 << 120, 121)] {
        let x = one.dyadic_like(index, level);
        let value = BigRational::new(index.into(), BigInt::one() << level);
        assert_tightest(&x, &value, &value, &format!("{index} / 2^{level}"));
    }
    // Too deep for 64 bits: an enclosure of one unit, not a point.
    let x = one.dyadic_like((1 << 120) - 1, 120);
    assert_eq!(x.hi() - x.lo(), BigInt::one());
}

#[test]
fn hulls_and_intersections_are_those_of_sets() {
    let mut random = Random::new(25);
    let all = intervals(&mut random, 8, 90);
    let mut disjoint = 0;
    for (x, y) in all.iter().flat_map(|x| all.iter().map(move |y| (x, y))) {
        let (low, high) = (x.inf().min(y.inf()), x.sup().max(y.sup()));
        let hull = x.join(y);
        assert_eq!((hull.inf(), hull.sup()), (low, high));
        let (low, high) = (x.inf().max(y.inf()), x.sup().min(y.sup()));
        let both = x.meet(y);
        assert_eq!(both.map(|z| (z.inf(), z.sup())), (low <= high).then_some((low.clone(), high)));
        disjoint += i32::from(x.meet(y).is_none());
    }
    assert!(disjoint > 1000, "{disjoint}");
    assert!(Fixed::new(1.into(), 0.into(), 8).is_none());
}
