//! The search: what it may take, and how it ends.
//!
//! | module       | does                                                                  |
//! |--------------|-----------------------------------------------------------------------|
//! | [`accepted`] | accepted certificates, and the size of their proofs                   |
//! | `at_once`    | searches for several answers, side by side                            |
//! | [`paving`]   | the region of a box where a claim holds, from within and from without |
//! | [`solver`]   | decides claims about machines of every kind; encloses extremes        |

pub mod accepted;
mod at_once;
pub mod paving;
pub mod solver;

pub use at_once::{at_once, cores, turns};

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Most boxes to be tried.
    pub max_boxes: usize,
    /// The moment at which to give up.
    pub deadline: Option<Instant>,
}

impl Budget {
    /// The same, of at most so many boxes.
    pub fn at_most(self, boxes: usize) -> Self {
        Budget { max_boxes: self.max_boxes.min(boxes), ..self }
    }

    /// Until the deadline, the time of the first of so many tasks.
    pub fn shared(self, tasks: usize) -> Self {
        let tasks = u32::try_from(tasks).unwrap_or(u32::MAX).max(1);
        let share = |left: Duration| Instant::now() + left / tasks;
        Budget { deadline: self.left().map(share), ..self }
    }

    /// The time until the deadline.
    pub fn left(self) -> Option<Duration> {
        self.deadline.map(|end| end.saturating_duration_since(Instant::now()))
    }

    /// Whether the deadline has passed.
    pub fn is_over(self) -> bool {
        is_over(self.deadline)
    }
}

/// Whether a moment has passed, if there is one.
pub fn is_over(deadline: Option<Instant>) -> bool {
    deadline.is_some_and(|deadline| Instant::now() >= deadline)
}

/// How far work is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Boxes tried by the search under way.
    pub boxes: usize,
    /// The share of the work that is done, from 0 to 1, as far as it can be told.
    pub share: f64,
}

/// All boxes of searches one after the other: where fewer are told than before, the next one has begun.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counted {
    ended: usize,
    last: usize,
}

impl Counted {
    /// Those of all, with so many of the last.
    pub fn with(&mut self, boxes: usize) -> usize {
        if boxes < self.last {
            self.ended += self.last;
        }
        self.last = boxes;
        self.ended + boxes
    }
}

/// What a search tells of its progress, and how it is cancelled.
pub struct Control<'a> {
    /// Set to make the search end with [`Stop::Cancelled`].
    pub cancel: &'a AtomicBool,
    /// Called now and then, by one thread at a time.
    pub progress: &'a mut (dyn FnMut(Progress) + Send),
}

impl Control<'_> {
    /// Whether the work is to end.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Does a part of the work, which is these shares of all.
    pub fn part<T>(&mut self, [from, to]: [f64; 2], work: impl FnOnce(&mut Control<'_>) -> T) -> T {
        let whole = &mut *self.progress;
        let mut of_part = |now: Progress| {
            whole(Progress { share: from + (to - from) * now.share.clamp(0.0, 1.0), ..now });
        };
        of_part(Progress { boxes: 0, share: 0.0 });
        let done = work(&mut Control { cancel: self.cancel, progress: &mut of_part });
        of_part(Progress { boxes: 0, share: 1.0 });
        done
    }
}

/// The share that is done of work in steps, of which it is guessed before each how many are left.
#[derive(Clone, Copy, Debug, Default)]
pub struct Steps(f64);

impl Steps {
    /// The share of the next so many steps, of `left`.
    pub fn take(&mut self, steps: usize, left: usize) -> [f64; 2] {
        let from = self.0;
        self.0 += (1.0 - from) * steps as f64 / left.max(1) as f64;
        [from, self.0]
    }

    /// Does the next step, one of `left`.
    pub fn next<T>(
        &mut self,
        control: &mut Control<'_>,
        left: usize,
        work: impl FnOnce(&mut Control<'_>) -> T,
    ) -> T {
        control.part(self.take(1, left), work)
    }
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Every box was either closed or cannot be closed by splitting it further.
    Exhausted,
    /// A box cannot be closed by splitting it further, and that is all that was asked.
    Hopeless,
    /// [`Budget::max_boxes`] were tried.
    Boxes,
    /// The deadline passed.
    Time,
    /// It was cancelled.
    Cancelled,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_parts_make_up_the_whole_and_a_wrong_guess_never_goes_back() {
        let mut seen = Vec::new();
        let cancel = AtomicBool::new(false);
        let mut note = |now: Progress| seen.push(now.share);
        let control = &mut Control { cancel: &cancel, progress: &mut note };
        let mut steps = Steps::default();
        for left in [2, 5, 1] {
            steps.next(control, left, |control| {
                control.part([0.5, 1.0], |control| {
                    (control.progress)(Progress { boxes: 1, share: 0.3 });
                });
            });
        }
        assert!(seen.is_sorted(), "{seen:?}");
        assert_eq!((seen.first(), seen.last()), (Some(&0.0), Some(&1.0)));
    }
}
