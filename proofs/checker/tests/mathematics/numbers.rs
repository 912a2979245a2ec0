//! Exact numbers: random expressions, their values and their canonical texts.

use super::approximate::double;
use super::random::Random;
use num_bigint::BigInt;
use orthocert_checker::number::Exact;
use std::cmp::Ordering;

/// A random expression and its value in doubles; `NaN` where that is out of its domain.
fn expression(random: &mut Random, depth: u32) -> (String, f64) {
    if depth == 0 || random.once_in(6) {
        return literal(random);
    }
    let (a, x) = expression(random, depth - 1);
    let blank = random.pick(&["", "", " ", "  ", "\t"]);
    match random.within(0, 7) {
        0 => (format!("-{blank}({a})"), -x),
        1 => (format!("sqrt({blank}{a})"), x.sqrt()),
        2 => (format!("({a}{blank})"), x),
        operator => {
            let (b, y) = expression(random, depth - 1);
            let (sign, value) = match operator {
                3 => ("+", x + y),
                4 => ("-", x - y),
                5 => ("*", x * y),
                _ => ("/", x / y),
            };
            (format!("({a}){blank}{sign}{blank}({b})"), value)
        }
    }
}

fn literal(random: &mut Random) -> (String, f64) {
    let n = random.within(0, 9999);
    let text = match random.within(0, 4) {
        0 => format!("{}.{:02}", n / 100, n % 100),
        1 => format!("{n}e-3"),
        2 => format!("{}E+1", n % 100),
        _ => format!("{}", n % 20),
    };
    let value = text.parse().unwrap();
    (text, value)
}

#[test]
fn random_expressions_have_the_value_of_the_same_formula_in_doubles() {
    let mut random = Random::new(40);
    let (mut compared, mut refused, mut irrational) = (0, 0, 0);
    for _ in 0..4000 {
        let depth = u32::try_from(random.within(1, 4)).unwrap();
        let (text, value) = expression(&mut random, depth);
        let Ok(number) = Exact::parse(&text, 1000) else {
            // Refused are roots of negative numbers and quotients by zero (nearly zero, in
            // doubles, where roots cancel), and nothing else.
            assert!(!value.is_finite() || has_division_or_root(&text), "{text} = {value}");
            refused += 1;
            continue;
        };
        irrational += i32::from(number.as_rational().is_none());
        let enclosure = number.enclose(0, 80).unwrap();
        let slack = 1e-9 * (1.0 + value.abs());
        // Where doubles cancel badly their value says nothing.
        if value.is_finite() && value.abs() > 1e-3 && value.abs() < 1e9 {
            compared += 1;
            assert!((double(&enclosure) - value).abs() <= slack, "{text} = {value}");
        }
    }
    assert!(compared > 2000 && refused > 200 && irrational > 300, "{compared} {refused}");
}

fn has_division_or_root(text: &str) -> bool {
    text.contains('/') || text.contains("sqrt")
}

#[test]
fn canonical_texts_are_fixed_points_and_nothing_else_is_accepted_for_them() {
    let mut random = Random::new(41);
    let mut different = 0;
    for _ in 0..3000 {
        let (text, _) = expression(&mut random, 3);
        let Ok(number) = Exact::parse(&text, 1000) else { continue };
        let canonical = number.to_string();
        assert_eq!(Exact::parse_canonical(&canonical), Ok(number.clone()), "{text}");
        assert_eq!(Exact::parse(&canonical, 2100).unwrap().to_string(), canonical, "{text}");
        if text != canonical {
            assert!(Exact::parse_canonical(&text).is_err(), "{text} is not {canonical}");
            different += 1;
        }
    }
    assert!(different > 1000, "{different}");
}

#[test]
fn enclosures_are_nested_and_narrow() {
    let mut random = Random::new(42);
    for _ in 0..1500 {
        let (text, _) = expression(&mut random, 3);
        let Ok(number) = Exact::parse(&text, 1000) else { continue };
        for scale in [-100i64, 0, 9] {
            let coarse = number.enclose(scale, 64).unwrap();
            let fine = number.enclose(scale, 400).unwrap();
            let both = coarse.rescale(0, 400).intersection(&fine);
            assert!(both.is_some(), "{text}: enclosures at two precisions are disjoint");
            // 64 guard bits leave the nearest two multiples of the unit, or three.
            if double(&fine).abs() < 1e6 {
                assert!(coarse.hi() - coarse.lo() <= BigInt::from(2), "{text} at {scale}");
            }
        }
    }
}

#[test]
fn signs_and_orders_are_those_of_the_values() {
    let mut random = Random::new(43);
    let mut decided = 0;
    for _ in 0..1000 {
        let (a, x) = expression(&mut random, 2);
        let (b, y) = expression(&mut random, 2);
        let (Ok(a), Ok(b)) = (Exact::parse(&a, 1000), Exact::parse(&b, 1000)) else { continue };
        assert_eq!(a.compare(&a), Some(Ordering::Equal));
        // Closer together, doubles cannot tell the order.
        if (x - y).abs() > 1e-6 * (1.0 + x.abs()) {
            assert_eq!(a.compare(&b), x.partial_cmp(&y), "{a} {b}");
            assert_eq!(b.compare(&a), y.partial_cmp(&x), "{b} {a}");
            decided += 1;
        }
    }
    assert!(decided > 500, "{decided}");
    // Equal, but not by their form: undecided, never guessed.
    let (a, b) = ("sqrt(2)+sqrt(3)", "sqrt(5+2*sqrt(6))");
    let [a, b] = [a, b].map(|text| Exact::parse(text, 1000).unwrap());
    assert_eq!(a.compare(&b), None);
    // Different by 1e-200: decided.
    let c = Exact::parse("sqrt(2)+1e-200", 1000).unwrap();
    let d = Exact::parse("sqrt(2)", 1000).unwrap();
    assert_eq!(c.compare(&d), Some(Ordering::Greater));
}
