//! The progress bar: on standard error, on a terminal, and for what takes long enough to see it.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use orthocert::decimal::{grouped, significant};
use orthocert::search::Progress;
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

/// Runs shorter than this show no bar.
const PATIENCE: Duration = Duration::from_millis(150);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// The bar of one search.
pub struct Bar {
    started: Instant,
    wanted: bool,
    bar: Option<ProgressBar>,
}

impl Bar {
    /// A bar that appears when there is something to wait for.
    pub fn new(quiet: bool) -> Self {
        Bar { started: Instant::now(), wanted: !quiet && io::stderr().is_terminal(), bar: None }
    }

    /// Shows how far the search is.
    pub fn show(&mut self, now: Progress) {
        let elapsed = self.started.elapsed();
        if !self.wanted || elapsed < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("{bar:24} {msg}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar
        });
        bar.set_position((now.closed * STEPS as f64) as u64);
        let rate = now.boxes as f64 / elapsed.as_secs_f64();
        bar.set_message(format!(
            "{} % of volume, {} boxes, {} boxes/s",
            significant(100.0 * now.closed, 4),
            grouped(now.boxes as u64),
            grouped(rate as u64)
        ));
    }

    /// Removes the bar.
    pub fn clear(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}
