//! Exact numbers as they are written: decimals, fractions and expressions with roots.

pub use orthocert_checker::number::*;
