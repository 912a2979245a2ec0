//! Machines whose three rows of `M` are dependent wherever the platform is: their descriptions are
//! refused, since no workspace could be free of parallel singularities.

use super::document::Value;
use super::error::{Defect, DesignError};
use super::leg::{Leg, Quantity};
use crate::exact::{Exact, NumberErrorKind};
use num_traits::Signed;
use orthocert_kernel::fixed::Interval;

/// Fractional bits in which the sign of a number that is not tiny shows.
const PLAIN: u32 = 128;

/// Demands that no leg is there twice, of as many as there are coordinates.
pub(super) fn different(values: &[Value<'_>], legs: &[&Leg]) -> Result<(), DesignError> {
    for (j, (value, leg)) in values.iter().zip(legs).enumerate() {
        let same = |other: &&Leg| other == leg && !leg.has_tolerance();
        if let Some(i) = legs.iter().take(j).position(same).filter(|_| value.document.demands()) {
            let found = format!("the leg {} once more", values[i].key);
            let accepted = "legs with independent rows: this one constrains nothing further";
            return Err(value.error(Defect::OutOfDomain, found, accepted));
        }
    }
    Ok(())
}

/// Demands that the rows of three legs that do not turn their platform can be independent somewhere,
/// as far as their description shows.
pub(super) fn independent(values: &[Value<'_>], legs: [&Leg; 3]) -> Result<(), DesignError> {
    if values.iter().any(|value| !value.document.demands()) {
        return Ok(());
    }
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if let (Leg::Planar { direction: u }, Leg::Planar { direction: v }) = (legs[i], legs[j]) {
            if !not_parallel(u, v) {
                let found = format!(
                    "a direction that is, or may be, parallel to that of {}",
                    values[i].key
                );
                return dependent(&values[j], "direction", found);
            }
        }
    }
    match legs {
        [Leg::Planar { direction: u }, Leg::Planar { direction: v }, Leg::Planar { direction: w }] =>
        {
            let numbers: Vec<&Quantity> = [u, v, w].into_iter().flatten().collect();
            if !constant_sign(&numbers, determinant, Exact::sign) {
                let found = "three directions that are, or may be, dependent";
                return dependent(&values[2], "direction", found.into());
            }
        }
        [Leg::Strut { .. }, Leg::Strut { .. }, Leg::Strut { .. }] if on_one_line(legs) => {
            let found = "anchors that, less their platform offsets, are on one line";
            return dependent(&values[2], "anchor", found.into());
        }
        _ => {}
    }
    Ok(())
}

fn dependent(leg: &Value<'_>, key: &str, found: String) -> Result<(), DesignError> {
    let accepted =
        "three legs with independent rows: otherwise every point is a parallel singularity";
    let value = leg.table("a table")?.require(key, accepted)?;
    Err(value.error(Defect::OutOfDomain, found, accepted))
}

/// Whether two directions are provably not parallel, whatever their admissible values: a component
/// of their cross product is of one strict sign.
pub(super) fn not_parallel(u: &[Quantity; 3], v: &[Quantity; 3]) -> bool {
    let shown = |sign: fn(&Exact) -> Option<i32>| {
        [(1, 2), (2, 0), (0, 1)].into_iter().any(|(i, j)| {
            let minor = |x: &[&Exact]| product(x[0], x[3])?.minus(product(x[1], x[2])?);
            constant_sign(&[&u[i], &u[j], &v[i], &v[j]], minor, sign)
        })
    };
    // One component is mostly plain, and another a zero made of roots, which is dear to look at.
    shown(|x| sign_within(x, PLAIN)) || shown(Exact::sign)
}

/// The sign of a number, if it is rational, or shows with so many fractional bits.
pub(super) fn sign_within(x: &Exact, bits: u32) -> Option<i32> {
    if x.as_rational().is_some() {
        return x.sign().filter(|sign| *sign != 0);
    }
    let Interval { lo, hi } = x.enclose(bits)?;
    match (lo.is_positive(), hi.is_negative()) {
        (true, _) => Some(1),
        (_, true) => Some(-1),
        _ => None,
    }
}

pub(super) fn product(x: &Exact, y: &Exact) -> Result<Exact, NumberErrorKind> {
    x.clone().times(y.clone())
}

/// Whether `f`, which is affine in each number, is provably of one strict sign for all admissible
/// values: it is between its values at their ends.
fn constant_sign(
    numbers: &[&Quantity],
    f: impl Fn(&[&Exact]) -> Result<Exact, NumberErrorKind>,
    sign: impl Fn(&Exact) -> Option<i32>,
) -> bool {
    let free: Vec<usize> = (0..numbers.len()).filter(|&k| !numbers[k].is_exact()).collect();
    let mut signs = (0..1usize << free.len()).map(|ends| {
        let mut at: Vec<&Exact> = numbers.iter().map(|q| &q.min).collect();
        for (bit, &k) in free.iter().enumerate() {
            if ends >> bit & 1 == 1 {
                at[k] = &numbers[k].max;
            }
        }
        f(&at).ok().and_then(|value| sign(&value)).filter(|sign| *sign != 0)
    });
    let first = signs.next().flatten();
    first.is_some() && signs.all(|sign| sign == first)
}

/// The determinant of the matrix with these nine entries, by rows: affine in each.
fn determinant(m: &[&Exact]) -> Result<Exact, NumberErrorKind> {
    let minor =
        |j: usize, k: usize| product(m[3 + j], m[6 + k])?.minus(product(m[3 + k], m[6 + j])?);
    let first = product(m[0], &minor(1, 2)?)?;
    let second = product(m[1], &minor(0, 2)?)?;
    first.minus(second)?.plus(product(m[2], &minor(0, 1)?)?)
}

/// Whether `a_i - d_i`, all exact, are not provably off one line: then so are the three `w_i` off
/// one plane.
fn on_one_line(legs: [&Leg; 3]) -> bool {
    if legs.iter().any(|leg| leg.has_tolerance()) {
        return false;
    }
    let base = |leg: &Leg, k: usize| match leg {
        Leg::Strut { anchor, platform } => anchor[k].min.clone().minus(platform[k].min.clone()),
        _ => Err(NumberErrorKind::TooLarge),
    };
    let span = |j: usize| -> Result<[Quantity; 3], NumberErrorKind> {
        let along = |k: usize| base(legs[j], k)?.minus(base(legs[0], k)?).map(Quantity::exactly);
        Ok([along(0)?, along(1)?, along(2)?])
    };
    match (span(1), span(2)) {
        (Ok(u), Ok(v)) => !not_parallel(&u, &v),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> Exact {
        Exact::parse(text, 1000).unwrap()
    }

    #[test]
    fn a_sign_shows_where_the_bits_suffice_and_a_zero_shows_none() {
        let sign = |text: &str| sign_within(&number(text), 128);
        assert_eq!(sign("1e-900"), Some(1));
        assert_eq!(sign("0"), None);
        assert_eq!(sign("sqrt(2)-sqrt(3)"), Some(-1));
        assert_eq!(sign("sqrt(3)*sqrt(2)-sqrt(6)"), None);
        assert_eq!(sign("1e-500*sqrt(2)"), None);
    }

    #[test]
    fn directions_that_differ_by_little_are_not_parallel() {
        let vector = |texts: [&str; 3]| texts.map(|text| Quantity::exactly(number(text)));
        let u = vector(["1", "sqrt(2)", "0"]);
        assert!(not_parallel(&u, &vector(["1", "sqrt(2)", "1e-500*sqrt(2)"])));
        assert!(not_parallel(&u, &vector(["1", "sqrt(3)", "0"])));
        assert!(!not_parallel(&u, &vector(["sqrt(2)", "2", "0"])));
    }
}
