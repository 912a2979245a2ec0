//! The seed paper's checkable claims, one by one: what it says, what is proved, and how.
//!
//! D. Chablat, Ph. Wenger, "Architecture Optimization of a 3-DOF Translational Parallel Mechanism
//! for Machining Applications, the Orthoglide", IEEE Transactions on Robotics and Automation. The
//! prototype has `psi_max = 2` and a cube of 200 mm.
//!
//! A finding rests on certificates that the exact checker has accepted in this very run, or on an
//! identity between exact numbers that is stated, and evaluated where it has numbers.

mod algebra;
mod certified;

use crate::exact::Exact;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use orthocert_checker::certificate::Certificate;

/// How a claim of the paper fares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Agreement {
    /// It is proved as it stands.
    Holds,
    /// It is proved once rounding, or a word, is put right.
    Corrected,
    /// It is false as it stands.
    Fails,
}

/// A number that a finding is about, enclosed.
#[derive(Clone, Debug)]
pub struct Value {
    /// Its symbol, with its unit.
    pub symbol: &'static str,
    /// The exact number.
    pub exact: Exact,
    /// Below it, or equal.
    pub least: BigRational,
    /// Above it, or equal.
    pub greatest: BigRational,
}

/// What a finding rests on.
#[derive(Clone, Debug)]
pub enum Basis {
    /// Accepted certificates, by file name.
    Certificates(Vec<(&'static str, Certificate)>),
    /// An identity, or an argument in words.
    Algebra(&'static str),
}

/// One claim of the paper.
#[derive(Clone, Debug)]
pub struct Finding {
    /// A short name, stable across versions.
    pub id: &'static str,
    /// Where the paper says it.
    pub place: &'static str,
    /// What the paper says.
    pub says: &'static str,
    /// What is proved.
    pub proved: &'static str,
    /// How the two compare.
    pub agreement: Agreement,
    /// The certified numbers.
    pub values: Vec<Value>,
    /// Why it is so.
    pub basis: Basis,
}

/// Why a finding could not be established in this run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{id}: {reason}")]
pub struct NotEstablished {
    /// The finding.
    pub id: &'static str,
    /// What failed.
    pub reason: String,
}

/// Every finding, in the order of the paper.
///
/// # Errors
/// If a certificate is not found or not accepted, or an identity does not hold.
pub fn findings() -> Result<Vec<Finding>, NotEstablished> {
    let mut all = certified::findings()?;
    all.extend(algebra::findings()?);
    all.sort_by_key(|finding| ORDER.iter().position(|id| *id == finding.id));
    Ok(all)
}

/// The order of the table.
const ORDER: [&str; 22] = [
    "leg-length",
    "corners",
    "base",
    "bounds",
    "equality",
    "postulate",
    "joint-range",
    "rho-min-place",
    "ratio",
    "serial-distance",
    "parallel-distance",
    "serial-surfaces",
    "isotropy",
    "rounded-machine",
    "published-corners",
    "motion",
    "collisions",
    "ellipsoid",
    "appendix-roots",
    "appendix-count",
    "appendix-inequations",
    "case-split",
];

/// Fractional bits of the enclosures of values.
const BITS: u32 = 128;

/// A value from its expression.
fn value(
    id: &'static str,
    symbol: &'static str,
    expression: &str,
) -> Result<Value, NotEstablished> {
    let fails = |reason: String| NotEstablished { id, reason };
    let exact = Exact::parse(expression, 100).map_err(|e| fails(format!("{expression}: {e}")))?;
    let ends = exact.enclose(BITS).ok_or_else(|| fails(format!("{expression}: no value")))?;
    let [least, greatest] = [ends.lo, ends.hi].map(|x| BigRational::new(x, BigInt::one() << BITS));
    Ok(Value { symbol, exact, least, greatest })
}

#[cfg(test)]
mod tests {
    use super::*;
    use orthocert_checker::check;

    #[test]
    fn every_finding_is_established_and_named_once() {
        let findings = findings().unwrap();
        let ids: Vec<&str> = findings.iter().map(|f| f.id).collect();
        assert_eq!(ids, ORDER);
    }

    #[test]
    fn certificates_of_findings_are_accepted_after_reading_them_back() {
        for finding in findings().unwrap() {
            if let Basis::Certificates(certificates) = &finding.basis {
                assert!(!certificates.is_empty());
                for (name, certificate) in certificates {
                    let text = certificate.to_text().unwrap();
                    let read = orthocert_checker::read(text.as_bytes()).unwrap();
                    assert!(check(&read).is_ok(), "{name}");
                }
            }
        }
    }

    #[test]
    fn values_have_the_digits_that_an_independent_evaluation_gives() {
        let findings = findings().unwrap();
        // Digits of an independent evaluation, truncated: the value is within one unit of the last.
        for (symbol, digits) in [
            ("L (mm)", "310.582854123025"),
            ("q1 (mm)", "-73.2050807568877"),
            ("q2 (mm)", "126.794919243112"),
            ("rho_max (mm)", "256.9930156368"),
            ("largest side for L = 310 (mm)", "199.624670766407"),
            ("largest side for L = 310.25 (mm)", "199.785658404122"),
        ] {
            let mut values = findings.iter().flat_map(|f| &f.values);
            let value = values.find(|v| v.symbol == symbol).expect(symbol);
            let expected = Exact::parse(digits, 100).unwrap();
            let expected = expected.as_rational().unwrap();
            let places = digits.split('.').next_back().map_or(0, str::len);
            let unit = BigRational::from_integer(10.into()).pow(-i32::try_from(places).unwrap());
            assert!(
                value.greatest > expected - &unit && value.least < expected + &unit,
                "{symbol}"
            );
        }
    }
}
