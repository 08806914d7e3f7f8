//! The race: repetitions in which contestants take turns on the same rays.
//!
//! A turn is some ten milliseconds, so whatever the machine does meanwhile does to all alike. The order
//! rotates from turn to turn, and is reversed in every second repetition. A turn during which a thread lost its
//! core, or beside which the probe was slow, is repeated, within limits.

use super::Tell;
use super::field::{Checked, Event, Field, digest};
use super::probe::Probe;
use super::sample::Sample;
use std::time::{Duration, Instant};

/// An event and those who take part in it.
pub(super) struct Start<'a> {
    pub(super) event: Event<'a>,
    pub(super) entries: Vec<Entry>,
    /// Some of the rays on which all of them agree.
    pub(super) agreed: Sample,
}

/// A contestant in an event.
pub(super) struct Entry {
    pub(super) contestant: usize,
    pub(super) checked: Checked,
    /// Whether answers were right, and stayed what they were when they were checked.
    pub(super) right: bool,
    /// For each number of threads.
    pub(super) times: Vec<Times>,
}

/// What was measured of an entry with one number of threads.
#[derive(Clone, Default)]
pub(super) struct Times {
    /// Of each repetition.
    pub(super) rays_per_second: Vec<f64>,
    /// Turns that count though the machine was busy.
    pub(super) busy_turns: usize,
    /// Of the repetition that is running.
    seconds: f64,
}

/// How often, how long, and on how many threads.
pub(super) struct Plan<'p> {
    pub(super) threads: &'p [usize],
    /// Exactly so many repetitions, or as many as there is time for.
    pub(super) repetitions: Option<usize>,
    pub(super) time: Duration,
}

impl Plan<'_> {
    /// Whether to stop after so many repetitions, which took `spent` seconds.
    pub(super) fn is_over(&self, repetitions: usize, spent: f64) -> bool {
        let each = spent / repetitions.max(1) as f64;
        match self.repetitions {
            Some(wanted) => repetitions >= wanted,
            None => {
                let late = spent + each > self.time.as_secs_f64();
                repetitions >= FEWEST_REPETITIONS && late || repetitions >= MOST_REPETITIONS
            }
        }
    }

    /// How much is done of it, from 0 to 1, after so many repetitions (with parts of one) and `spent` seconds.
    pub(super) fn done(&self, repetitions: f64, spent: f64) -> f64 {
        // The fewest repetitions may take longer than the time there is.
        let by_time = || {
            (repetitions / FEWEST_REPETITIONS as f64).min(spent / self.time.as_secs_f64().max(1e-9))
        };
        self.repetitions.map_or_else(by_time, |wanted| repetitions / wanted as f64).min(1.0)
    }
}

/// What there is to tell of a race besides the times.
pub(super) struct Story {
    pub(super) repetitions: usize,
    pub(super) repeated_turns: usize,
    /// For each number of threads.
    pub(super) probes: Vec<Probe>,
}

/// However long they take.
const FEWEST_REPETITIONS: usize = 3;

/// However short they are.
const MOST_REPETITIONS: usize = 101;

/// A turn is repeated so often at most.
const MOST_ATTEMPTS: usize = 4;

impl Story {
    /// Whether a slow turn may be repeated: a machine that is always busy must not stop the race.
    fn has_patience(&self, turns: usize) -> bool {
        self.repeated_turns < 20 + turns / 3
    }
}

/// Runs it; times go into the entries.
pub(super) fn race(
    field: &mut Field<'_>,
    starts: &mut [Start<'_>],
    plan: &Plan<'_>,
    tell: Tell<'_>,
) -> Story {
    let begin = Instant::now();
    let probes = plan.threads.iter().map(|&threads| Probe::new(threads)).collect();
    let mut story = Story { repetitions: 0, repeated_turns: 0, probes };
    let turns_of = |start: &Start<'_>, field: &Field<'_>| {
        field.turns(start.event.set) * start.entries.len() * plan.threads.len()
    };
    let turns: usize = starts.iter().map(|start| turns_of(start, field)).sum();
    let mut turns_run = 0;
    while starts.iter().any(|start| !start.entries.is_empty()) {
        if plan.is_over(story.repetitions, begin.elapsed().as_secs_f64()) {
            break;
        }
        for start in starts.iter_mut() {
            for (slot, &threads) in plan.threads.iter().enumerate() {
                let place = Place { slot, threads };
                repetition(field, start, place, &mut story, turns_run, &mut |done| {
                    let repetitions = (turns_run + done) as f64 / turns as f64;
                    tell("racing", plan.done(repetitions, begin.elapsed().as_secs_f64()));
                });
                turns_run += field.turns(start.event.set) * start.entries.len();
            }
        }
        story.repetitions += 1;
    }
    story
}

/// One of the numbers of threads.
#[derive(Clone, Copy)]
struct Place {
    slot: usize,
    threads: usize,
}

/// Everyone traces all rays of an event once.
fn repetition(
    field: &mut Field<'_>,
    start: &mut Start<'_>,
    place: Place,
    story: &mut Story,
    turns_run: usize,
    done: &mut dyn FnMut(usize),
) {
    let set = start.event.set;
    let turns = field.turns(set);
    let mut turns_done = 0;
    for turn in 0..turns {
        let mut order: Vec<_> = (0..start.entries.len()).collect();
        let first = story.repetitions * turns + turn;
        order.rotate_left(first % start.entries.len().max(1));
        if story.repetitions % 2 == 1 {
            order.reverse();
        }
        for entry in order {
            done(turns_done);
            turns_done += 1;
            let entry = &mut start.entries[entry];
            if !entry.right {
                continue;
            }
            for attempt in 1.. {
                let probe = &mut story.probes[place.slot];
                if probe.was_slow() {
                    // It may be over.
                    probe.run();
                }
                let slow_before = probe.was_slow();
                let (lap, answers) = field.run(entry.contestant, set, turn, place.threads);
                // Every timed answer is one that has been checked.
                if digest(&answers) != entry.checked.digests[turn] {
                    entry.checked.compared.agreement.unsteady_turns += 1;
                    entry.right = false;
                }
                probe.run();
                let is_busy = slow_before || probe.was_slow() || !lap.undisturbed;
                let again = attempt < MOST_ATTEMPTS && story.has_patience(turns_run + turns_done);
                if is_busy && again {
                    story.repeated_turns += 1;
                    continue;
                }
                let times = &mut entry.times[place.slot];
                times.seconds += lap.seconds;
                times.busy_turns += usize::from(is_busy);
                break;
            }
        }
    }
    for entry in start.entries.iter_mut().filter(|entry| entry.right) {
        let times = &mut entry.times[place.slot];
        let seconds = std::mem::take(&mut times.seconds).max(1e-9);
        times.rays_per_second.push(set.rays.len() as f64 / seconds);
    }
}
