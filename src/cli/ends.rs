//! What commands share that look for a certified and a refuted value next to each other.

use super::{input, Failure};
use crate::design::Design;
use crate::exact::decimal::{approximate, rounded, Toward};
use crate::questions::frontier::NoAnswer;
use num_rational::BigRational;

/// What is missed where both ends are near.
pub const NOT_BEST: &str = "not, but the time was up before the best place of a cube was found";

/// The relative width that an option `--gap` asks for.
pub fn gap(text: &str, ends: [&str; 2]) -> Result<f64, Failure> {
    let found = input::within("--gap", text, ends)?;
    approximate(&found).ok_or(Failure::Defect)
}

/// The failure that there is no answer.
pub fn explain(error: NoAnswer, design: &Design) -> Failure {
    match error {
        NoAnswer::Cancelled => Failure::Interrupted,
        NoAnswer::Unfit { key, found, accepted } => {
            Failure::Input(design.refused(&key, &found, accepted))
        }
        error => Failure::input(error),
    }
}

/// Why an answer is wider than the gap that was asked for, if neither was interrupted nor endless.
pub fn missed(out_of_time: bool) -> &'static str {
    match out_of_time {
        true => "the time was up",
        false => "no nearer proof was found within the boxes of a search; --max-boxes sets them",
    }
}

/// A relative width, two digits, rounded up.
pub fn gap_text(gap: &BigRational) -> String {
    rounded(gap, 2, Toward::Above)
}
