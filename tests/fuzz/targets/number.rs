//! Any text as a number: what is read has one canonical text, and its enclosures, at two
//! precisions, meet what floating point makes of it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use num_rational::BigRational;
use num_traits::{zero, ToPrimitive};
use orthocert::exact::Exact;
use std::cmp::Ordering;

/// A value and a bound on its error in doubles; `None` where it cannot be told.
fn value(x: &Exact) -> Option<(f64, f64)> {
    const UNIT: f64 = 1e-15;
    let rounded = |x: f64, error: f64| {
        let moderate = x == 0.0 || (1e-250..1e250).contains(&x.abs());
        (moderate && error.is_finite()).then_some((x, error + x.abs() * UNIT + 1e-280))
    };
    match x {
        Exact::Rational(x) => rounded(x.to_f64()?, 0.0),
        Exact::Neg(x) => value(x).map(|(x, e)| (-x, e)),
        Exact::Add(x, y) => {
            let ((x, e), (y, f)) = (value(x)?, value(y)?);
            rounded(x + y, e + f)
        }
        Exact::Sub(x, y) => {
            let ((x, e), (y, f)) = (value(x)?, value(y)?);
            rounded(x - y, e + f)
        }
        Exact::Mul(x, y) => {
            let ((x, e), (y, f)) = (value(x)?, value(y)?);
            rounded(x * y, x.abs() * f + y.abs() * e + e * f)
        }
        Exact::Div(x, y) => {
            let ((x, e), (y, f)) = (value(x)?, value(y)?);
            (y.abs() > 2.0 * f).then_some(())?;
            rounded(x / y, (e + (x / y).abs() * f) / (y.abs() - f))
        }
        Exact::Sqrt(x) => {
            let (x, e) = value(x)?;
            (x > 2.0 * e).then_some(())?;
            rounded(x.sqrt(), e / (x - e).sqrt())
        }
        Exact::Name(_) => None,
    }
}

/// Whether the interval has a value within the error.
fn meets([low, high]: &[BigRational; 2], (x, error): (f64, f64)) -> bool {
    let (Some(low), Some(high)) = (low.to_f64(), high.to_f64()) else {
        return true;
    };
    let room = 2.0 * error + 1e-15 * x.abs() + 1e-15;
    low <= x + room && x - room <= high
}

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let number = match Exact::parse(text, 1000) {
        Ok(number) => number,
        Err(error) => {
            assert!(error.at <= text.len() && error.to_string().len() < 200);
            assert!(Exact::parse_canonical(text).is_err());
            return;
        }
    };
    let written = number.to_string();
    if let Ok(again) = Exact::parse_canonical(&written) {
        assert_eq!(again, number, "{written}");
    } else {
        // A literal longer than what a certificate may have, or a text longer than that.
        assert!(written.len() > 1000, "not canonical: {written}");
    }
    let (coarse, fine) = (number.ends(64), number.ends(256));
    let expected = value(&number);
    for ends @ [low, high] in [&coarse, &fine].into_iter().flatten() {
        assert!(expected.is_none_or(|x| meets(ends, x)), "{written}: {expected:?}");
        match number.sign() {
            Some(1) => assert!(*high >= zero()),
            Some(-1) => assert!(*low <= zero()),
            _ => {}
        }
    }
    if let (Some([low, high]), Some([from, to])) = (coarse, fine) {
        assert!(low <= to && from <= high, "{written}");
    }
    assert_eq!(number.compare(&number), Some(Ordering::Equal));
});
