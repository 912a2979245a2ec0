//! Machine words against big integers: the same intervals, or none.

use super::machines::{all, random_cell};
use super::random::Random;
use num_bigint::BigInt;
use orthocert_checker::enclosure::{Bound, Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::Model;
use orthocert_checker::rule::{self, Rotation};
use orthocert_checker::word::{Word, MAX_BITS};

const BITS: u32 = 36;

/// Ends of all sizes, often equal, zero or next to a power of two.
fn interval(random: &mut Random) -> Fixed {
    let size = random.within(0, 62);
    let mut end = || match random.within(0, 5) {
        0 => 0,
        1 => 1i64 << random.within(0, size),
        2 => -(1i64 << random.within(0, size)) + 1,
        _ => random.within(-(1 << size), 1 << size),
    };
    let (a, b) = (end(), end());
    let b = if random.once_in(4) { a } else { b };
    Fixed::new(a.min(b).into(), a.max(b).into(), BITS).unwrap()
}

/// The word is the interval, or is unknown; unknown only where the interval is large.
fn agrees(word: Word, fixed: &Fixed, what: &str) {
    let limit = BigInt::from(1) << 62;
    match word.to_fixed() {
        Some(found) => assert_eq!(found, *fixed, "{what}"),
        None => assert!(*fixed.lo() < -&limit || *fixed.hi() > limit, "{what}: {fixed:?}"),
    }
}

#[test]
fn every_operation_gives_the_interval_of_big_integers_or_none() {
    let mut random = Random::new(11);
    for _ in 0..20_000 {
        let (x, y) = (interval(&mut random), interval(&mut random));
        let (a, b) = (Word::from_fixed(&x), Word::from_fixed(&y));
        agrees(a, &x, "conversion");
        agrees(a.add(&b), &x.add(&y), "sum");
        agrees(a.sub(&b), &x.sub(&y), "difference");
        agrees(a.neg(), &x.neg(), "negation");
        agrees(a.mul(&b), &x.mul(&y), "product");
        agrees(a.sqr(), &x.sqr(), "square");
        agrees(a.join(&b), &x.join(&y), "hull");
        for (found, expected) in
            [(a.recip(), x.recip()), (a.sqrt(), x.sqrt()), (a.meet(&b), x.meet(&y))]
        {
            assert_eq!(found.is_some(), expected.is_some(), "{x:?} {y:?}");
            if let (Some(found), Some(expected)) = (found, expected) {
                agrees(found, &expected, "partial operation");
            }
        }
        assert_eq!(a.is_positive(), x.is_positive());
        assert_eq!(a.is_nonnegative(), x.is_nonnegative());
        let n = random.within(-1000, 1000);
        agrees(a.integer_like(n), &x.integer_like(n), "integer");
        let (index, level) = (random.word() as u128 >> random.within(3, 60), 41);
        agrees(a.dyadic_like(index, level), &x.dyadic_like(index, level), "dyadic");
    }
}

#[test]
fn the_unknown_stays_unknown_and_has_no_certain_sign() {
    let huge = Fixed::new(BigInt::from(1) << 62, (BigInt::from(1) << 62) + 1, BITS).unwrap();
    let unknown = Word::from_fixed(&huge);
    let one = unknown.integer_like(1);
    assert_eq!(one.to_fixed(), Some(huge.integer_like(1)));
    let all = [
        unknown,
        unknown.add(&one),
        one.sub(&unknown),
        unknown.mul(&one.integer_like(0)),
        unknown.sqr(),
        unknown.neg(),
        one.join(&unknown),
        one.meet(&unknown).unwrap(),
    ];
    for x in all {
        assert_eq!(x.to_fixed(), None);
        assert!(!x.is_positive() && !x.is_nonnegative());
        assert!(x.recip().is_none() && x.sqrt().is_none());
        assert!(!x.lower().is_positive() && !x.upper().is_positive());
    }
    // Too fine a precision has no words at all.
    let fine = Fixed::integer(1, MAX_BITS + 1);
    assert_eq!(Word::from_fixed(&fine).to_fixed(), None);
    assert_eq!(Word::from_fixed(&Fixed::integer(1, 1024)).sqr().to_fixed(), None);
}

#[test]
fn polynomials_of_ends_have_the_sign_of_big_integers() {
    let mut random = Random::new(5);
    let mut certain = 0;
    for _ in 0..20_000 {
        let x: [Fixed; 5] = std::array::from_fn(|_| interval(&mut random));
        let w: [Word; 5] = std::array::from_fn(|k| Word::from_fixed(&x[k]));
        // c (ab - d^2) - e (be - ac), near cancellation at times.
        fn minor<B: Bound>([a, b, c, d, e]: &[B; 5]) -> B {
            c.mul(&a.mul(b).sub(&d.mul(d))).sub(&e.mul(&b.mul(e).sub(&a.mul(c))))
        }
        let exact = minor(&x.each_ref().map(|x| x.lower()));
        let word = minor(&w.each_ref().map(|w| w.lower()));
        let known = w.iter().all(|w| w.to_fixed().is_some());
        assert!(!word.is_positive() || Bound::is_positive(&exact));
        assert!(!known || word.is_positive() == Bound::is_positive(&exact), "{x:?}");
        certain += usize::from(word.is_positive());
    }
    assert!(certain > 3000, "{certain}");
}

#[test]
fn what_a_rule_accepts_in_words_it_accepts_in_big_integers() {
    let mut random = Random::new(23);
    let mut accepted = 0;
    for (name, claim) in all() {
        let fixed = Model::new(&claim, BITS).unwrap();
        let mut fixed = fixed;
        let like = fixed.width[0].clone();
        fixed.bounds.kappa = like.dyadic_like(3, 2);
        fixed.bounds.k = Some(like.dyadic_like(3, 1));
        let word = fixed.map(&Word::from_fixed);
        for _ in 0..200 {
            let cell = random_cell(&mut random, 5);
            let (Ok(a), Ok(b)) = (
                Expansion::new(&word, &cell, ExpansionPoint::Centre),
                Expansion::new(&fixed, &cell, ExpansionPoint::Centre),
            ) else {
                continue;
            };
            let q = std::array::from_fn(|k| random.within(-9, 9) + if k == 0 { 100 } else { 0 });
            let rotation = Rotation { q, ..Rotation::IDENTITY };
            let v = std::array::from_fn(|_| random.within(-127, 127));
            for (here, there) in [
                (rule::lower(&word, &a, &rotation), rule::lower(&fixed, &b, &rotation)),
                (rule::entrywise(&word, &a, &rotation), rule::entrywise(&fixed, &b, &rotation)),
                (rule::upper(&word, &a), rule::upper(&fixed, &b)),
                (rule::shrunk(&word, &a, &v), rule::shrunk(&fixed, &b, &v)),
                (rule::stretched(&word, &a, &v), rule::stretched(&fixed, &b, &v)),
            ] {
                assert!(here.is_err() || there.is_ok(), "{name}: {cell}");
                accepted += usize::from(here.is_ok());
            }
        }
    }
    assert!(accepted > 300, "{accepted}");
}
