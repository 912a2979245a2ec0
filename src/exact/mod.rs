//! Exact numbers as they are written: decimals, fractions and expressions with roots.

pub use orthocert_checker::number::*;

use num_bigint::BigInt;
use orthocert_kernel::fixed::Interval;

/// An enclosure of a number with `bits` fractional bits; `None` where it is too large, or not known to
/// exist.
pub fn enclosed(x: &Exact, bits: u32) -> Option<Interval<BigInt>> {
    let x = x.enclose(0, bits)?;
    Some(Interval { lo: x.lo().clone(), hi: x.hi().clone() })
}
