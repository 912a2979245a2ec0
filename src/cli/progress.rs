//! Progress: on standard error, on a terminal, of what takes long enough to see it. It moves also while a
//! search has nothing to say: what turns, the time, and the estimate of what is left.

use super::interrupt;
use crate::exact::decimal::grouped;
use crate::report::text::duration;
use crate::search::{at_once, turns, Control, Counted, Progress, Steps};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::collections::BTreeSet;
use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_millis(150);
/// The time between two pictures of what turns.
const TICK: Duration = Duration::from_millis(120);
/// Steps of the bar.
const STEPS: u64 = 1_000_000;
/// From this share on, and after this time, what is left is estimated.
const ESTIMATED: (f64, Duration) = (0.01, Duration::from_secs(2));

/// What is drawn, of which there is at most one.
static DRAWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// The progress of a command, in one task or in several, after each other or at once.
pub struct Bar {
    task: String,
    /// What is counted.
    counted: &'static str,
    /// Shares of the tasks begun.
    steps: Steps,
    /// The share of the command that is done.
    share: f64,
    boxes: Counted,
    /// None where nobody looks.
    shown: Option<Drawn>,
}

/// What is drawn once the patience is over.
struct Drawn {
    bar: ProgressBar,
    over: Arc<(Mutex<bool>, Condvar)>,
}

impl Bar {
    /// Of a command that begins, which counts boxes, or cells.
    pub fn new(counted: &'static str, quiet: bool) -> Self {
        let wanted = !quiet && io::stderr().is_terminal();
        let (task, steps) = (String::new(), Steps::default());
        let shown = wanted.then(Drawn::new);
        Bar { task, counted, steps, share: 0.0, boxes: Counted::default(), shown }
    }

    /// Does a task, which can be interrupted, one of `left`: named in a few words, or in none where the
    /// command has but one.
    pub fn run<T>(
        &mut self,
        task: &str,
        left: usize,
        work: impl FnOnce(&mut Control<'_>) -> T,
    ) -> T {
        task.clone_into(&mut self.task);
        let part = self.steps.take(1, left);
        let mut show = |now| self.show(now);
        Control { cancel: interrupt::cancelled(), progress: &mut show }.part(part, work)
    }

    /// Does tasks that do not depend on each other, each named in a few words: see [`at_once`].
    pub fn at_once<T: Send + Sync>(
        &mut self,
        names: &[String],
        after: usize,
        work: impl Fn(usize, usize, &mut Control<'_>) -> T + Sync,
    ) -> Vec<T> {
        let own = turns(names.len());
        let part = self.steps.take(own, own + after);
        let under_way = Mutex::new(BTreeSet::new());
        let under_way = || under_way.lock().unwrap_or_else(PoisonError::into_inner);
        let mut show = |now| {
            if let Some(task) = together(&under_way(), names) {
                self.task = task;
            }
            self.show(now);
        };
        let mut control = Control { cancel: interrupt::cancelled(), progress: &mut show };
        control.part(part, |control| {
            at_once(names.len(), after, control, |number, turns, control| {
                under_way().insert(number);
                (control.progress)(Progress { boxes: 0, share: 0.0 });
                let done = work(number, turns, control);
                under_way().remove(&number);
                done
            })
        })
    }

    /// Shows how far the command is: never less than before.
    pub fn show(&mut self, now: Progress) {
        let boxes = self.boxes.with(now.boxes);
        self.share = self.share.max(now.share.min(1.0));
        let Some(Drawn { bar, .. }) = &self.shown else { return };
        bar.set_position((self.share * STEPS as f64) as u64);
        bar.set_message(message(&self.task, boxes, self.counted));
    }

    /// Shows that so much more is done.
    pub fn add(&mut self, share: f64) {
        self.show(Progress { boxes: 0, share: self.share + share });
    }

    /// Removes it.
    pub fn end(&mut self) {
        self.shown = None;
    }
}

/// The task that began first of those under way, and how many more there are.
fn together(under_way: &BTreeSet<usize>, names: &[String]) -> Option<String> {
    let first = names.get(*under_way.first()?)?;
    Some(match under_way.len() {
        1 => first.clone(),
        several => format!("{first} and {} more", several - 1),
    })
}

/// `: psi, 2,000 boxes`.
fn message(task: &str, boxes: usize, counted: &str) -> String {
    let boxes = (boxes > 0).then(|| format!("{} {counted}", grouped(boxes as u64)));
    let parts = (!task.is_empty()).then(|| task.to_owned()).into_iter().chain(boxes);
    let parts: Vec<String> = parts.collect();
    if parts.is_empty() {
        return String::new();
    }
    format!(": {}", parts.join(", "))
}

/// `, about 4 s left`, or nothing yet: `known` is the share that was there as soon as it was looked.
fn left(known: f64, share: f64, elapsed: Duration) -> String {
    if share < known + ESTIMATED.0 || share >= 1.0 || elapsed < ESTIMATED.1 {
        return String::new();
    }
    let left = elapsed.as_secs_f64() * (1.0 - share) / (share - known);
    format!(", about {} left", duration(left.ceil().max(1.0)))
}

/// Writes to standard error beside what is drawn.
pub fn beside(write: impl FnOnce()) {
    let drawn = DRAWN.lock().unwrap_or_else(PoisonError::into_inner);
    match &*drawn {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Removes what is drawn.
pub fn clear() {
    let drawn = DRAWN.lock().unwrap_or_else(PoisonError::into_inner).take();
    drawn.iter().for_each(ProgressBar::finish_and_clear);
}

impl Drawn {
    /// Nothing yet; drawn from a thread of its own when the patience is over.
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
        let share = |state: &ProgressState| f64::from(state.fraction());
        let known = Arc::new(AtomicU64::new(0));
        let at_first = Arc::clone(&known);
        let template = "{spinner} {elapsed} {bar:24} {share}{msg}{left}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let percent = move |state: &ProgressState, out: &mut dyn fmt::Write| {
                let _ = write!(out, "{:.0} %", (100.0 * share(state)).floor());
            };
            let rest = move |state: &ProgressState, out: &mut dyn fmt::Write| {
                let known = at_first.load(Ordering::Relaxed) as f64 / STEPS as f64;
                let _ = out.write_str(&left(known, share(state), state.elapsed()));
            };
            let style = style.progress_chars("=> ");
            bar.set_style(style.with_key("share", percent).with_key("left", rest));
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
                known.store(drawn.position(), Ordering::Relaxed);
                drawn.set_draw_target(ProgressDrawTarget::stderr());
                drawn.enable_steady_tick(TICK);
                *DRAWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(drawn);
            }
        });
        Drawn { bar, over }
    }
}

impl Drop for Drawn {
    fn drop(&mut self) {
        let (over, changed) = &*self.over;
        *over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        changed.notify_all();
        self.bar.finish_and_clear();
        clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_s_share_never_falls_and_its_boxes_add_up() {
        let mut bar = Bar::new("boxes", true);
        let tasks = [("one", 4), ("another", 3), ("the last", 1)];
        for ((task, left), (share, boxes)) in
            tasks.into_iter().zip([(0.25, 20), (0.5, 40), (1.0, 60)])
        {
            bar.run(task, left, |control| {
                for (boxes, share) in [(10, 0.5), (20, 0.2)] {
                    (control.progress)(Progress { boxes, share });
                }
            });
            assert_eq!((bar.share, bar.boxes.with(0)), (share, boxes));
        }
    }

    #[test]
    fn what_is_left_is_estimated_once_there_is_something_to_judge_by() {
        let second = Duration::from_secs(1);
        assert_eq!(message("psi", 2000, "boxes"), ": psi, 2,000 boxes");
        assert_eq!(message("", 0, "cells"), "");
        assert_eq!(message("psi", 0, "boxes"), ": psi");
        let names = ["psi", "rho", "load"].map(str::to_owned);
        let under_way = |numbers: &[usize]| numbers.iter().copied().collect();
        assert_eq!(together(&under_way(&[2, 0, 1]), &names).unwrap(), "psi and 2 more");
        assert_eq!(together(&under_way(&[1]), &names).unwrap(), "rho");
        assert_eq!(together(&under_way(&[]), &names), None);
        assert_eq!(left(0.0, 0.25, 10 * second), ", about 30 s left");
        assert_eq!(left(0.5, 0.75, 10 * second), ", about 10 s left");
        assert_eq!(left(0.0, 0.999, 10 * second), ", about 1 s left");
        for (share, elapsed) in [(0.5, second), (0.0, 10 * second), (1.0, 10 * second)] {
            assert_eq!(left(0.0, share, elapsed), "");
        }
    }
}
