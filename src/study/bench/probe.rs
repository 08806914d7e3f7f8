//! Notices a machine that is busy with other things: a fixed piece of arithmetic that then takes longer.
//!
//! (That another program took the core away, the system says itself; see `crew`. What it does not say is
//! who shares the core's arithmetic units, or how fast the core is allowed to run.) It runs between all timed turns, on as many threads as they. Four independent chains of
//! multiplications fill the units, so that a neighbour shows.

use super::crew::together;
use super::result::ProbeSpread;
use std::hint::black_box;

/// Rounds of the loop: about a third of a millisecond.
const ROUNDS: u64 = 250_000;

/// A probe this much slower than the fastest shows a busy machine.
pub const SLOW: f64 = 1.15;

/// The probes of one bench with one number of threads.
pub(super) struct Probe {
    threads: usize,
    seconds: Vec<f64>,
}

impl Probe {
    /// Runs a few times to know how fast the machine can be.
    pub(super) fn new(threads: usize) -> Self {
        let mut probe = Self { threads, seconds: Vec::new() };
        (0..20).for_each(|_| probe.run());
        probe
    }

    /// Runs once.
    pub(super) fn run(&mut self) {
        let seconds = together(self.threads, || {
            let mut chains = black_box([1_u64, 2, 3, 4]);
            for round in 0..ROUNDS {
                for chain in &mut chains {
                    *chain = chain.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(round);
                }
            }
            black_box(chains);
        })
        .seconds;
        self.seconds.push(seconds);
    }

    /// Whether the machine was slower than it can be, when this ran last.
    pub(super) fn was_slow(&self) -> bool {
        self.seconds.last().is_some_and(|last| *last > SLOW * self.fastest())
    }

    fn fastest(&self) -> f64 {
        self.seconds.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// How evenly it ran.
    pub(super) fn spread(&self) -> ProbeSpread {
        let fastest = self.fastest();
        let mut slowness: Vec<_> = self.seconds.iter().map(|seconds| seconds / fastest).collect();
        slowness.sort_by(f64::total_cmp);
        let quantile = |q: f64| slowness[((slowness.len() - 1) as f64 * q) as usize];
        let threads = self.threads;
        ProbeSpread { threads, median: quantile(0.5), p95: quantile(0.95), max: quantile(1.0) }
    }
}
