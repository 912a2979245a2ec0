//! The flags that all commands with a search share: its budget, its threads, its answer's form.

use super::{input, Failure, Format};
use crate::cli::progress::Bar;
use crate::search::{cores, Budget, Control};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use orthocert_kernel::certificate::MOST_NODES;
use orthocert_kernel::claim::{MachineClaim, Orientation};
use std::time::{Duration, Instant};

/// Boxes tried by default.
const MAX_BOXES: u64 = 500_000;
/// Most threads that may be asked for.
pub const MAX_THREADS: u64 = 1024;

/// Threads for each core, beyond which more are not started.
const MOST_OF_A_CORE: usize = 16;

/// The flags.
#[derive(Clone, Debug, clap::Args)]
pub struct Effort {
    /// Boxes after which a search gives up [default: 500000; in bounds, largest-cube, limit, size,
    /// summary and tolerance, which search many times, less]; more than 500,000 count as 500,000, the most nodes of a certificate
    #[arg(long, value_name = "N", value_parser = input::whole(1..=u64::MAX), allow_hyphen_values = true)]
    max_boxes: Option<u64>,
    /// Time after which the search gives up: seconds, or a number with ms, s, min or h
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    timeout: Option<String>,
    /// Threads of the search [default: one for each core; at most 16 for each]; the certificate does not depend on it
    #[arg(long, value_name = "N", value_parser = input::whole(1..=MAX_THREADS), allow_hyphen_values = true)]
    threads: Option<u64>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print the verdict's line, or the answer's rows, only, and no progress
    #[arg(short, long)]
    pub quiet: bool,
}

impl Effort {
    /// The budget of a search that began at `started`.
    pub fn budget(&self, started: Instant) -> Result<Budget, Failure> {
        self.budget_or(MAX_BOXES, started)
    }

    /// As [`budget`](Self::budget), with a default number of boxes of the command's own.
    pub fn budget_or(&self, boxes: u64, started: Instant) -> Result<Budget, Failure> {
        let max_boxes = self.max_boxes.unwrap_or(boxes);
        Ok(Budget {
            max_boxes: usize::try_from(max_boxes).unwrap_or(MOST_NODES).min(MOST_NODES),
            deadline: deadline(self.timeout.as_deref(), started)?,
        })
    }

    /// Starts the threads that were asked for. Without a number they start when the search first
    /// has work for them.
    pub fn start_threads(&self) -> Result<(), Failure> {
        start_threads(self.threads)
    }

    /// Shows the progress of a command.
    pub fn bar(&self) -> Bar {
        Bar::new("boxes", self.quiet)
    }

    /// Runs a search that can be interrupted and shows its progress.
    pub fn run<T>(&self, search: impl FnOnce(&mut Control<'_>) -> T) -> T {
        self.bar().run("", 1, search)
    }
}

/// The flags of commands whose files say how much work is to be done.
#[derive(Debug, clap::Args)]
pub struct Work {
    /// Threads [default: one for each core; at most 16 for each]; what is written does not depend on it
    #[arg(long, value_name = "N", value_parser = input::whole(1..=MAX_THREADS), allow_hyphen_values = true)]
    threads: Option<u64>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print one line only, and no progress
    #[arg(short, long)]
    pub quiet: bool,
}

impl Work {
    /// Starts the threads that were asked for.
    pub fn start_threads(&self) -> Result<(), Failure> {
        start_threads(self.threads)
    }
}

/// Of so many boxes a third for each coordinate of orientation, where boxes take longer.
pub fn boxes_of(claim: &MachineClaim, boxes: u64) -> u64 {
    match &claim.orientation {
        None => boxes,
        Some(Orientation::Range(_)) => boxes / 3,
        Some(_) => boxes / 27,
    }
}

/// Starts so many threads, if a number is given; beyond [`MOST_OF_A_CORE`] they would mostly wait for each other.
pub fn start_threads(threads: Option<u64>) -> Result<(), Failure> {
    let Some(threads) = threads else {
        return Ok(());
    };
    let most = cores().saturating_mul(MOST_OF_A_CORE);
    let threads = usize::try_from(threads).unwrap_or(1).min(most);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global()
        .map_err(|error| Failure::Output(format!("{threads} threads cannot be started: {error}")))
}

/// The end of the time that `--timeout` gives to what began at `started`; none beyond what the clock can tell.
pub fn deadline(timeout: Option<&str>, started: Instant) -> Result<Option<Instant>, Failure> {
    let timeout = timeout.map(|text| time("--timeout", text)).transpose()?;
    Ok(timeout.and_then(|timeout| started.checked_add(timeout)))
}

/// The time that an option's value is: a number with a unit, in seconds without one.
pub fn time(option: &str, text: &str) -> Result<Duration, Failure> {
    const UNITS: [(&str, u64); 5] = [
        ("ms", 1_000_000),
        ("min", 60_000_000_000),
        ("h", 3_600_000_000_000),
        ("s", 1_000_000_000),
        ("", 1_000_000_000),
    ];
    let accepted = "seconds, such as 10 or 0.5, or a time such as 500ms, 10s, 2min or 1h";
    let refused = || input::refused(option, text, accepted);
    let with_unit = |&(unit, nanoseconds)| Some((text.strip_suffix(unit)?, nanoseconds));
    let (number, unit) = UNITS.iter().find_map(with_unit).ok_or_else(refused)?;
    let number = input::number(option, number.trim()).map_err(|_| refused())?;
    let number = number.as_rational().filter(|x| !x.is_negative()).ok_or_else(refused)?;
    let nanoseconds = (number * BigRational::from_integer(BigInt::from(unit))).to_integer();
    Ok(nanoseconds.to_u64().map_or(Duration::MAX, Duration::from_nanos))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_exact_and_carry_units() {
        for (text, nanoseconds) in [
            ("0", 0),
            ("10", 10_000_000_000),
            ("0.1", 100_000_000),
            ("1/3", 333_333_333),
            ("500ms", 500_000_000),
            ("2 s", 2_000_000_000),
            ("2min", 120_000_000_000),
            ("1h", 3_600_000_000_000),
        ] {
            assert_eq!(
                time("--timeout", text).unwrap(),
                Duration::from_nanos(nanoseconds),
                "{text}"
            );
        }
        assert_eq!(time("--timeout", "1e30").unwrap(), Duration::MAX);
        for text in ["", "-1", "s", "ten", "5 days", "nan", "inf", "sqrt(2)"] {
            assert!(matches!(time("--timeout", text), Err(Failure::Input(_))), "{text}");
        }
    }
}
