//! How long a thread has really run, whatever the wall clock says.

/// Seconds of processor time that the calling thread has used; 0 where the system does not say.
pub fn thread_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a valid timespec, which the call fills in.
    let status = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    if status == 0 { time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    #[test]
    fn runs_only_while_the_thread_does() {
        let (start, wall) = (thread_seconds(), Instant::now());
        while thread_seconds() - start < 0.02 {
            std::hint::spin_loop();
        }
        std::thread::sleep(Duration::from_millis(30));
        let (used, passed) = (thread_seconds() - start, wall.elapsed().as_secs_f64());
        assert!(used >= 0.02 && passed >= used + 0.02, "{used} of {passed} s");
    }
}
