//! Several searches at once, where a question has several answers.

use super::{Control, Progress};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;

/// Bytes of a thread's stack: as many as the first thread mostly has.
const STACK: usize = 8 << 20;

/// What became of so many tasks that do not depend on each other, of which as many are done at once as there are
/// threads, begun in their order; `after` them come so many more. `work` is told a task's number, and in how many
/// turns it, those that are not begun and those after them are done: for its share of the time. Once cancelled, each
/// task that is left is begun, to say so.
pub fn at_once<T: Send + Sync>(
    tasks: usize,
    after: usize,
    control: &mut Control<'_>,
    work: impl Fn(usize, usize, &mut Control<'_>) -> T + Sync,
) -> Vec<T> {
    let threads = rayon::current_num_threads().min(tasks);
    let done: Vec<OnceLock<T>> = (0..tasks).map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let cancel = control.cancel;
    let begun =
        Mutex::new((vec![Progress { boxes: 0, share: 0.0 }; tasks], &mut *control.progress));
    let worker = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = done.get(number) else { return };
            let turns = (tasks - number + after).div_ceil(threads);
            // Boxes of the searches of this task that ended.
            let mut ended = (0, 0);
            let mut note = |now: Progress| {
                if now.boxes < ended.1 {
                    ended.0 += ended.1;
                }
                ended.1 = now.boxes;
                let (all, whole) = &mut *begun.lock().unwrap_or_else(PoisonError::into_inner);
                all[number] = Progress { boxes: ended.0 + ended.1, ..now };
                let share = all.iter().map(|one| one.share).sum::<f64>() / tasks as f64;
                whole(Progress { boxes: all.iter().map(|one| one.boxes).sum(), share });
            };
            let control = &mut Control { cancel, progress: &mut note };
            let found = control.part([0.0, 1.0], |control| work(number, turns, control));
            // Each number is taken once.
            let _ = slot.set(found);
        }
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
        for threads in [1, 3] {
            let mut seen = Vec::new();
            let mut note = |now: Progress| seen.push((now.boxes, now.share));
            // Three tasks that wait for each other end where there are three threads.
            let together = Barrier::new(threads);
            let found = on(threads, || {
                let control = &mut Control { cancel: &cancel, progress: &mut note };
                at_once(6, 2, control, |number, turns, control| {
                    together.wait();
                    for boxes in [4, 7, 2] {
                        (control.progress)(Progress { boxes, share: 0.5 });
                    }
                    (number, turns)
                })
            });
            let turns = |number: usize| (8 - number).div_ceil(threads);
            let expected: Vec<_> = (0..6).map(|number| (number, turns(number))).collect();
            assert_eq!(found, expected, "{threads} threads");
            assert!(seen.is_sorted_by(|a, b| a.1 <= b.1), "{seen:?}");
            assert_eq!(seen.last().map(|last| last.1), Some(1.0));
            assert_eq!(seen.iter().map(|one| one.0).max(), Some(6 * (7 + 2)));
        }
    }
}
