//! Threads that begin together, and a stopwatch that runs from the first beginning to the last end.

use crate::os::thread_seconds;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// How long threads took that began together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lap {
    /// From the first beginning to the last end.
    pub(super) seconds: f64,
    /// Whether every thread had a core to itself all the time, but for moments.
    pub(super) undisturbed: bool,
}

/// A thread that was on a core for less than this part of its time was disturbed.
const ON_CORE: f64 = 0.98;

/// Runs `work` on `threads` threads at once, this one among them. Starting the threads is not timed: each
/// waits until all are there.
pub(super) fn together(threads: usize, work: impl Fn() + Sync) -> Lap {
    let arrived = AtomicUsize::new(0);
    let clocked = || {
        arrived.fetch_add(1, Ordering::AcqRel);
        // They come within microseconds, unless there are more threads than cores.
        let mut turns = 0;
        while arrived.load(Ordering::Acquire) < threads {
            turns += 1;
            if turns % 1000 == 0 {
                std::thread::yield_now();
            }
            std::hint::spin_loop();
        }
        let (start, used) = (Instant::now(), thread_seconds());
        work();
        (start, Instant::now(), thread_seconds() - used)
    };
    let times: Vec<_> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(clocked)).collect();
        let own = clocked();
        // A thread ends without its times only by a panic, which the scope passes on.
        others.into_iter().filter_map(|other| other.join().ok()).chain([own]).collect()
    });
    let start = times.iter().map(|time| time.0).min();
    let end = times.iter().map(|time| time.1).max();
    Lap {
        seconds: start.zip(end).map_or(0.0, |(start, end)| (end - start).as_secs_f64()),
        undisturbed: times.iter().all(|(start, end, used)| {
            // A clock may be coarse: what is too short to tell is no disturbance.
            let off_core = (*end - *start).as_secs_f64() - used;
            off_core <= (1.0 - ON_CORE) * (*end - *start).as_secs_f64() + 20e-6
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_thread_works_and_the_slowest_counts() {
        let done = AtomicUsize::new(0);
        let lap = together(3, || {
            let place = done.fetch_add(1, Ordering::Relaxed);
            std::thread::sleep(std::time::Duration::from_millis(10 * place as u64));
        });
        assert_eq!(done.into_inner(), 3);
        // Asleep is off the core.
        assert!(lap.seconds >= 0.02 && !lap.undisturbed, "{lap:?}");
    }
}
