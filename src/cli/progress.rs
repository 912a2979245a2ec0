//! Progress: on standard error, on a terminal, of what takes long enough to see it. It moves also while a
//! search has nothing to say.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use orthocert::decimal::{grouped, significant};
use orthocert::report::text::duration;
use orthocert::search::Progress;
use std::io::{self, IsTerminal};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_millis(150);
/// The time between two pictures of what turns.
const TICK: Duration = Duration::from_millis(120);
/// Steps of the bar.
const STEPS: u64 = 1000;
/// From this share on, and after this time, what is left is estimated.
const ESTIMATED: (f64, Duration) = (0.02, Duration::from_secs(2));

/// The progress of a task: of one search, or of several after each other.
pub struct Bar {
    task: String,
    /// Searches begun, and when the last was.
    searches: usize,
    started: Instant,
    /// Boxes of that search, as it last said.
    boxes: usize,
    /// None where nobody looks.
    shown: Option<Shown>,
}

/// What is drawn once the patience is over.
struct Shown {
    bar: ProgressBar,
    over: Arc<(Mutex<bool>, Condvar)>,
}

impl Bar {
    /// For a task, named in a few words, or in none where the command has but one.
    pub fn new(task: &str, quiet: bool) -> Self {
        let wanted = !quiet && io::stderr().is_terminal();
        let shown = wanted.then(Shown::new);
        Bar { task: task.to_owned(), searches: 1, started: Instant::now(), boxes: 0, shown }
    }

    /// Shows how far a search is; one that has tried fewer boxes than before is another.
    pub fn show(&mut self, now: Progress) {
        if now.boxes < self.boxes {
            self.searches += 1;
            self.started = Instant::now();
        }
        self.boxes = now.boxes;
        let Some(Shown { bar, .. }) = &self.shown else { return };
        bar.set_position((now.closed * STEPS as f64) as u64);
        bar.set_message(message(&self.task, self.searches, now, self.started.elapsed()));
    }

    /// Removes it.
    pub fn clear(&mut self) {
        self.shown = None;
    }
}

/// `psi, search 3: 43 % of volume, 2,000 boxes, 100,000 boxes/s, about 4 s left`.
fn message(task: &str, searches: usize, now: Progress, elapsed: Duration) -> String {
    let name = match (task, searches) {
        ("", 1) => String::new(),
        (task, 1) => format!("{task}: "),
        ("", number) => format!("search {number}: "),
        (task, number) => format!("{task}, search {number}: "),
    };
    let rate = now.boxes as f64 / elapsed.as_secs_f64().max(1e-3);
    let mut out = format!(
        "{name}{} % of volume, {} boxes, {} boxes/s",
        significant(100.0 * now.closed, 4),
        grouped(now.boxes as u64),
        grouped(rate as u64)
    );
    if now.closed >= ESTIMATED.0 && elapsed >= ESTIMATED.1 {
        let left = elapsed.as_secs_f64() * (1.0 - now.closed) / now.closed;
        out += &format!(", about {} left", duration(left.ceil().max(1.0)));
    }
    out
}

impl Shown {
    /// Nothing yet; drawn from a thread of its own when the patience is over.
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {bar:24} {msg}") {
            bar.set_style(style.progress_chars("=> "));
        }
        let over = Arc::new((Mutex::new(false), Condvar::new()));
        let (of_thread, drawn) = (Arc::clone(&over), bar.clone());
        // Without a thread there is no bar: the work goes on.
        let _ = thread::Builder::new().spawn(move || {
            let (over, changed) = &*of_thread;
            let over = over.lock().unwrap_or_else(PoisonError::into_inner);
            let waited = changed.wait_timeout_while(over, PATIENCE, |over| !*over);
            let (over, _) = waited.unwrap_or_else(PoisonError::into_inner);
            // The lock is held: it is not removed meanwhile.
            if !*over {
                drawn.set_draw_target(ProgressDrawTarget::stderr());
                drawn.enable_steady_tick(TICK);
            }
        });
        Shown { bar, over }
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        let (over, changed) = &*self.over;
        *over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        changed.notify_all();
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn searches_are_counted_and_what_is_left_is_estimated() {
        let mut bar = Bar::new("psi", true);
        let at = |boxes, closed| Progress { boxes, closed };
        for (now, searches) in
            [(at(10, 0.1), 1), (at(20, 0.2), 1), (at(5, 0.0), 2), (at(9, 0.5), 2)]
        {
            bar.show(now);
            assert_eq!(bar.searches, searches);
        }
        let second = Duration::from_secs(1);
        assert_eq!(
            message("", 1, at(2000, 0.4375), second),
            "43.75 % of volume, 2,000 boxes, 2,000 boxes/s"
        );
        assert_eq!(
            message("psi", 2, at(2000, 0.25), 10 * second),
            "psi, search 2: 25 % of volume, 2,000 boxes, 200 boxes/s, about 30 s left"
        );
    }
}
