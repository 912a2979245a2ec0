//! Several jobs at a time.

use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// How long jobs that are under way may take to end when everything is cancelled.
const PATIENCE: Duration = Duration::from_millis(200);
/// How often it is looked whether everything is cancelled.
const GLANCE: Duration = Duration::from_millis(20);

/// What became of one job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome<R> {
    /// It ended, with this.
    Ended(R),
    /// It panicked: the work is wrong, and nothing of its result is known.
    Defect,
    /// It was under way when everything was cancelled.
    Abandoned,
    /// It was not begun.
    NotRun,
}

/// Does `work` for every job, on `workers` threads, and calls `ended` on this thread for each as it
/// ends. The outcomes are in the order of the jobs. When `cancel` is set no job is begun any more,
/// and those under way are given a moment to end; a thread that does not is left behind.
pub fn run<J, R>(
    jobs: Arc<[J]>,
    workers: usize,
    cancel: &'static AtomicBool,
    work: impl Fn(&J) -> R + Send + Sync + 'static,
    mut ended: impl FnMut(usize, &Outcome<R>),
) -> Vec<Outcome<R>>
where
    J: Send + Sync + 'static,
    R: Send + 'static,
{
    let count = jobs.len();
    let (sender, receiver) = mpsc::channel();
    let worker = {
        let next = AtomicUsize::new(0);
        move || {
            while !cancel.load(Ordering::Relaxed) {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(job) = jobs.get(index) else { break };
                let begun = sender.send((index, Outcome::Abandoned));
                let result = panic::catch_unwind(AssertUnwindSafe(|| work(job)));
                let outcome = result.map_or(Outcome::Defect, Outcome::Ended);
                if begun.and(sender.send((index, outcome))).is_err() {
                    break;
                }
            }
        }
    };
    let worker = Arc::new(worker);
    let start = |_| {
        let worker = Arc::clone(&worker);
        thread::Builder::new().spawn(move || worker()).is_ok()
    };
    let started = (0..workers.clamp(1, count.max(1))).take_while(|index| start(*index)).count();
    if started == 0 {
        // Where not even one thread can be started, this one does the work.
        worker();
    }
    drop(worker);
    let mut outcomes: Vec<Outcome<R>> = (0..count).map(|_| Outcome::NotRun).collect();
    let mut cancelled_at: Option<Instant> = None;
    loop {
        match receiver.recv_timeout(GLANCE) {
            Ok((index, outcome)) => {
                if !matches!(outcome, Outcome::Abandoned) {
                    ended(index, &outcome);
                }
                if let Some(slot) = outcomes.get_mut(index) {
                    *slot = outcome;
                }
            }
            Err(RecvTimeoutError::Disconnected) => return outcomes,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if cancel.load(Ordering::Relaxed) {
            let since = *cancelled_at.get_or_insert_with(Instant::now);
            if since.elapsed() > PATIENCE {
                return outcomes;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static NEVER: AtomicBool = AtomicBool::new(false);

    #[test]
    fn outcomes_are_in_the_order_of_the_jobs() {
        for workers in [1, 3, 100] {
            let jobs: Arc<[u64]> = (0..50).collect();
            let mut told = Vec::new();
            let work = |n: &u64| {
                thread::sleep(Duration::from_micros(50 * (7 * n % 5)));
                n * n
            };
            let outcomes = run(jobs, workers, &NEVER, work, |index, _| told.push(index));
            let expected: Vec<_> = (0..50).map(|n| Outcome::Ended(n * n)).collect();
            assert_eq!(outcomes, expected);
            told.sort_unstable();
            assert_eq!(told, (0..50).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_job_that_panics_stops_no_other() {
        let jobs: Arc<[u64]> = (0..5).collect();
        let outcomes = run(jobs, 2, &NEVER, |n| assert_ne!(*n, 2), |_, _| {});
        let defects = outcomes.iter().filter(|outcome| **outcome == Outcome::Defect).count();
        assert_eq!((defects, &outcomes[2]), (1, &Outcome::Defect));
    }

    #[test]
    fn nothing_is_begun_after_a_cancellation_and_nobody_is_waited_for() {
        static CANCEL: AtomicBool = AtomicBool::new(false);
        let jobs: Arc<[u64]> = (0..3).collect();
        let work = |n: &u64| match n {
            0 => CANCEL.store(true, Ordering::Relaxed),
            _ => thread::sleep(Duration::from_secs(60)),
        };
        let started = Instant::now();
        let outcomes = run(jobs, 1, &CANCEL, work, |_, _| {});
        assert_eq!(outcomes, [Outcome::Ended(()), Outcome::NotRun, Outcome::NotRun]);
        let jobs: Arc<[u64]> = (1..3).collect();
        CANCEL.store(false, Ordering::Relaxed);
        thread::spawn(|| {
            thread::sleep(Duration::from_millis(100));
            CANCEL.store(true, Ordering::Relaxed);
        });
        let outcomes = run(jobs, 1, &CANCEL, work, |_, _| {});
        assert_eq!(outcomes, [Outcome::Abandoned, Outcome::NotRun]);
        assert!(started.elapsed() < Duration::from_secs(30));
    }
}
