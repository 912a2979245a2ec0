//! Several searches at once, where a question has several answers.

use super::{Control, Counted, Progress};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;

/// Bytes of a thread's stack: as many as the first thread mostly has.
const STACK: usize = 8 << 20;

/// The machine's cores; one where it does not tell.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// How many of so many tasks are done at once: one for each thread, but no more than cores.
fn workers(tasks: usize) -> usize {
    tasks.min(rayon::current_num_threads()).min(cores())
}

/// In how many turns so many tasks are done.
pub fn turns(tasks: usize) -> usize {
    tasks.div_ceil(workers(tasks).max(1))
}

/// What becomes of tasks that do not depend on each other, in their order: of as many at once as there are threads, but
/// no more than cores. What a task gives to the pool of threads may wait for what another did.
///
/// `work` is told a task's number, and how many turns are left, its own among them and the `after` that come after these
/// tasks: its share of the time is one of them. Once cancelled, the tasks that are left are begun, too, to say so.
pub fn at_once<T: Send + Sync>(
    tasks: usize,
    after: usize,
    control: &mut Control<'_>,
    work: impl Fn(usize, usize, &mut Control<'_>) -> T + Sync,
) -> Vec<T> {
    let threads = workers(tasks);
    let done: Vec<OnceLock<T>> = (0..tasks).map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let cancel = control.cancel;
    let nothing = Progress { boxes: 0, share: 0.0 };
    let all = Mutex::new((vec![nothing; tasks], &mut *control.progress));
    let worker = || loop {
        let number = next.fetch_add(1, Ordering::Relaxed);
        let Some(slot) = done.get(number) else { return };
        let turns = (tasks - number).div_ceil(threads) + after;
        let mut counted = Counted::default();
        let mut note = |now: Progress| {
            let (all, whole) = &mut *all.lock().unwrap_or_else(PoisonError::into_inner);
            all[number] = Progress { boxes: counted.with(now.boxes), ..now };
            let share = all.iter().map(|one| one.share).sum::<f64>() / tasks as f64;
            whole(Progress { boxes: all.iter().map(|one| one.boxes).sum(), share });
        };
        let control = &mut Control { cancel, progress: &mut note };
        let found = control.part([0.0, 1.0], |control| work(number, turns, control));
        // Each number is taken once.
        let _ = slot.set(found);
    };
    thread::scope(|scope| {
        for _ in 1..threads {
            // Without a thread the others do its work.
            let _ = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, worker);
        }
        worker();
    });
    done.into_iter().filter_map(OnceLock::into_inner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::sync::Barrier;

    /// In a pool of so many threads.
    fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
    }

    #[test]
    fn tasks_are_done_at_once_and_told_in_their_order() {
        let cancel = AtomicBool::new(false);
        for threads in [1, 2] {
            let mut seen = Vec::new();
            let mut note = |now: Progress| seen.push((now.boxes, now.share));
            let found = on(threads, || {
                // Tasks that wait for each other end where so many are done at once.
                let together = Barrier::new(workers(6));
                let control = &mut Control { cancel: &cancel, progress: &mut note };
                at_once(6, 2, control, |number, _, control| {
                    together.wait();
                    for boxes in [4, 7, 2] {
                        (control.progress)(Progress { boxes, share: 0.5 });
                    }
                    number
                })
            });
            assert_eq!(found, [0, 1, 2, 3, 4, 5], "{threads} threads");
            assert!(seen.is_sorted_by(|a, b| a.1 <= b.1), "{seen:?}");
            assert_eq!(seen.last().map(|last| last.1), Some(1.0));
            assert_eq!(seen.iter().map(|one| one.0).max(), Some(6 * (7 + 2)));
        }
    }

    /// Every task has its share of the time, and so have the turns after the last.
    #[test]
    fn turns_are_those_that_are_left() {
        let cancel = AtomicBool::new(false);
        let left = |threads: usize, tasks, after| {
            let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
            on(threads, || at_once(tasks, after, control, |_, turns, _| turns))
        };
        assert_eq!(left(1, 4, 2), [6, 5, 4, 3]);
        assert_eq!(left(3, 0, 2).len(), 0);
        for threads in 1..5 {
            for (tasks, after) in [(1, 1), (2, 1), (5, 3), (4, 0)] {
                let left = left(threads, tasks, after);
                assert!(left.is_sorted_by(|a, b| a >= b), "{left:?}");
                let first = on(threads, || turns(tasks)) + after;
                assert_eq!((left[0], left[tasks - 1]), (first, 1 + after), "{threads} threads");
            }
        }
    }
}
